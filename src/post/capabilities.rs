//! What a dialect tells lowering.

use std::collections::{BTreeMap, BTreeSet};

use super::dialect::{Cycle, Dialect, DwellUnit, FullCircleWords, Spec};
use super::options::SHARE;
use crate::diag::{Diagnostic, codes};
use crate::ir::CycleName;
use crate::ir::{Machine, Rotary};
use crate::target::{
    Capabilities, FullCircle, Grid, NurbsForm, PathTolerance, Plane, PlaneArcs, Ranges, Register, RotaryAxis,
    RotaryFeed,
};
use crate::units::{Angle, LengthUnit};

/// Words of a place between the ends of an arc.
pub(super) const BETWEEN: [&str; 3] = ["mx", "my", "mz"];
/// The group of the work offsets.
const WORK_OFFSET: &str = "work-offset";

impl Dialect {
    /// What the control can do for a program in `unit`, on the machine that `MACHIN` describes.
    ///
    /// # Errors
    /// A rotary axis that the control does not have, or an option that cannot be understood.
    pub fn capabilities(
        &self,
        unit: LengthUnit,
        machine: Option<&Machine>,
    ) -> Result<Capabilities, Diagnostic> {
        let spec = &self.spec;
        let rotary = match machine.and_then(|m| m.rotary) {
            Some(rotary) => Some(self.rotary(rotary, unit)?),
            None => None,
        };
        let options = self.options(machine, unit)?;
        self.check_options(&options)?;
        self.check_dwell(&options)?;
        self.check_groups(&options, unit)?;
        Ok(Capabilities {
            name: self.name.clone(),
            grid: self.grid(unit),
            arcs: spec.arcs.enabled,
            planes: self.planes(),
            cycles: self.cycles(|_| true),
            dwelling_cycles: self.cycles(|cycle| cycle.dwell),
            parks: spec.tool_change.parks_with(&options),
            whole_points: spec.modal.whole_points,
            max_sweep: Angle::degrees(spec.arcs.max_sweep).rad(),
            full_circle: match spec.arcs.full_circle {
                FullCircleWords::Split => FullCircle::Split(spec.arcs.split),
                _ => FullCircle::Whole,
            },
            radius_range: (spec.arcs.min_radius, spec.arcs.max_radius),
            radius_tolerance: spec.arcs.radius_tolerance,
            nurbs: match spec.nurbs.knots.as_str() {
                "printed" => Some(NurbsForm::G062 { knot_decimals: spec.nurbs.knot_decimals }),
                "uniform" => Some(NurbsForm::G052),
                "pieces" => Some(NurbsForm::Pieces { finer: self.finer(unit), chord: spec.nurbs.chord }),
                _ => None,
            },
            nurbs_in_space: spec.nurbs.point.iter().any(|item| item == "z" || item.ends_with("-z")),
            rotary,
            feed_per_revolution: spec.feed.per_revolution,
            inverse_time: spec.feed.inverse_time,
            rotary_feed: match spec.rotary.feed.as_str() {
                "linear-axes" => RotaryFeed::LinearAxes,
                _ => RotaryFeed::UnitsAsDegrees,
            },
            path_tolerance: self.path_tolerance(machine)?,
            travel: [spec.limits.x, spec.limits.y, spec.limits.z].map(|r| r.map(|[low, high]| (low, high))),
            ranges: self.ranges(unit),
            mist: !spec.coolant.mist.is_empty(),
            flood: !spec.coolant.flood.is_empty(),
            through: !spec.coolant.through.is_empty(),
            work_offset: self.work_offset(&options, unit),
            options,
            compensation: self.compensation(),
            optional_stop: !spec.stops.optional.is_empty(),
            restart: spec.stops.restart,
            spindle: spec.limits.spindle.map(|[low, high]| (low, high)),
        })
    }

    fn grid(&self, unit: LengthUnit) -> Grid {
        let spec = &self.spec;
        let linear = spec.decimals("x", unit);
        Grid {
            unit,
            linear_decimals: linear,
            rotary_decimals: spec.decimals("rotary", unit),
            centre_decimals: spec.decimals("i", unit).max(linear),
            feed_decimals: spec.decimals("feed", unit),
            feed_per_revolution_decimals: spec.decimals("feed-per-revolution", unit),
            inverse_time_decimals: spec.decimals("feed-inverse-time", unit),
            feed_scale: spec.feed.scale.of(unit),
        }
    }

    fn ranges(&self, unit: LengthUnit) -> Ranges {
        let spec = &self.spec;
        let least = |names: &[&str]| names.iter().map(|n| spec.range(n, unit)).min().unwrap_or(i64::MAX);
        Ranges {
            linear: least(&["x", "y", "z"]),
            rotary: least(&["rotary"]),
            centre: least(&["i", "j", "k"]),
            feed_per_minute: least(&["feed"]),
            feed_per_revolution: least(&["feed-per-revolution"]),
            inverse_time: least(&["feed-inverse-time"]),
            coefficient: spec.coefficients().map(|c| spec.range(c.name, unit)).min().unwrap_or(i64::MAX),
        }
    }

    /// Decimals of coefficients of cubic pieces, beyond those of linear words.
    fn finer(&self, unit: LengthUnit) -> u8 {
        let spec = &self.spec;
        let most = spec.coefficients().map(|c| spec.decimals(c.name, unit)).max();
        most.unwrap_or(0).saturating_sub(spec.decimals("x", unit))
    }

    /// Planes of arcs; those that are spelled in a way of their own are no helices.
    fn planes(&self) -> BTreeMap<Plane, PlaneArcs> {
        let patterns = &self.spec.patterns;
        let arcs = |name: &String| {
            let (plane, own) = match name.as_str() {
                "xy" => (Plane::Xy, None),
                "zx" => (Plane::Zx, Some(&patterns.arc_zx)),
                _ => (Plane::Yz, Some(&patterns.arc_yz)),
            };
            let own = own.filter(|p| !p.is_empty());
            let between = |items: &Vec<String>| items.iter().any(|i| BETWEEN.contains(&i.as_str()));
            let helix = own.is_none() && self.spec.arcs.helix;
            (plane, PlaneArcs { helix, by_middle: own.is_some_and(between) })
        };
        self.spec.arcs.planes.iter().filter(|_| self.spec.arcs.enabled).map(arcs).collect()
    }

    /// Drilling cycles that are kept.
    fn cycles(&self, wanted: impl Fn(&Cycle) -> bool) -> BTreeSet<CycleName> {
        let kept = self.spec.cycles.iter().filter(|(_, cycle)| cycle.enabled && wanted(cycle));
        kept.filter_map(|(name, _)| CycleName::by_text(name)).collect()
    }

    /// Templates print options among words: they are printable and stay on their line.
    fn check_options(&self, options: &BTreeMap<String, String>) -> Result<(), Diagnostic> {
        let printable = |text: &str| text.bytes().all(|b| b.is_ascii_graphic() || b == b' ');
        match options.iter().find(|(_, value)| !printable(value)) {
            None => Ok(()),
            Some((key, value)) => Err(Diagnostic::global(
                &codes::post::MACHINE_OPTION,
                format!("the option `{key}` is {value:?}; options are printable ASCII on one line"),
            )),
        }
    }

    fn compensation(&self) -> Option<Register> {
        let rules = &self.spec.compensation;
        let register = match rules.register.as_str() {
            "always" => Register::Always,
            "as-named" => Register::AsNamed,
            _ => Register::OfTool,
        };
        (!rules.left.is_empty() && rules.register != "none").then_some(register)
    }

    /// An option that picks the start of a modal group counts codes that there are.
    fn check_groups(&self, options: &BTreeMap<String, String>, unit: LengthUnit) -> Result<(), Diagnostic> {
        let Some(group) = self.spec.groups.values().find(|g| g.chosen(unit, options).is_none()) else {
            return Ok(());
        };
        let (key, value) = (&group.option, Spec::option(options, &group.option).unwrap_or_default());
        let most = group.codes.len() + group.more_count as usize;
        let message = if group.start.of(unit).is_empty() {
            format!("`{key} = {value}` asks for what {} does not have", self.title())
        } else {
            format!("{key} is a number from 1 to {most} for {}, not `{value}`", self.title())
        };
        Err(Diagnostic::global(&codes::post::MACHINE_OPTION, message))
    }

    /// The work offset that the header selects: by a code of its group, or by the option alone.
    fn work_offset(&self, options: &BTreeMap<String, String>, unit: LengthUnit) -> Option<u16> {
        let group = self.spec.groups.get(WORK_OFFSET)?;
        let printed = self.spec.safe_start.iter().flatten().any(|name| name == WORK_OFFSET);
        match group.chosen(unit, options).filter(|code| printed && !code.is_empty()) {
            Some(code) => group.count(&code),
            None => Spec::option(options, "WCS")?.parse().ok(),
        }
    }

    /// A declared unit of dwells is one that is known.
    fn check_dwell(&self, options: &BTreeMap<String, String>) -> Result<(), Diagnostic> {
        let declared = [self.spec.dwell.unit, self.spec.cycle_dwell.unit].contains(&DwellUnit::Declared);
        let value = Spec::option(options, "DWELL").unwrap_or_default();
        if !declared || ["s", "ms"].iter().any(|unit| value.eq_ignore_ascii_case(unit)) {
            return Ok(());
        }
        Err(Diagnostic::global(
            &codes::post::MACHINE_OPTION,
            format!("DWELL is the unit of this machine's dwells, `s` or `ms`, not `{value}`"),
        ))
    }

    fn rotary(&self, wanted: Rotary, unit: LengthUnit) -> Result<RotaryAxis, Diagnostic> {
        let rules = &self.spec.rotary;
        let default = rules.letter.chars().next().unwrap_or('C');
        let letter = wanted.letter.unwrap_or(default).to_ascii_uppercase();
        if !rules.enabled.of(unit) {
            let other = match unit {
                LengthUnit::Millimetre => LengthUnit::Inch,
                LengthUnit::Inch => LengthUnit::Millimetre,
            };
            let message = if rules.enabled.of(other) {
                format!("{} takes a rotary axis in {} programs only", self.title(), other.symbol())
            } else {
                format!("{} has no rotary axis", self.title())
            };
            return Err(Diagnostic::global(&codes::post::MACHINE_OPTION, message));
        }
        if !rules.letters.contains(letter) {
            return Err(Diagnostic::global(
                &codes::post::MACHINE_OPTION,
                format!(
                    "`{letter}` is no rotary axis of {}; its rotary axes are {}",
                    self.title(),
                    rules.letters
                ),
            ));
        }
        Ok(RotaryAxis { letter, reversed: wanted.reversed })
    }

    fn path_tolerance(&self, machine: Option<&Machine>) -> Result<Option<PathTolerance>, Diagnostic> {
        let mut share = self.spec.path_control.share;
        for (key, value) in machine.iter().flat_map(|m| &m.options) {
            if key.eq_ignore_ascii_case(SHARE) {
                share = self.share(value.as_deref().unwrap_or_default())?;
            }
        }
        let possible = !self.spec.path_control.tolerance.is_empty();
        Ok((possible && share > 0.0).then_some(PathTolerance { share }))
    }

    fn share(&self, text: &str) -> Result<f64, Diagnostic> {
        text.trim().parse().ok().filter(|v| (0.0..=0.9).contains(v)).ok_or_else(|| {
            Diagnostic::global(
                &codes::post::MACHINE_OPTION,
                format!(
                    "SHARE is the part of the tolerance that the control may use, from 0 to 0.9, not `{text}`"
                ),
            )
        })
    }
}
