//! Point-to-point motion.

use crate::diag::Diagnostic;
use crate::diag::codes::{planning, semantics as codes};
use crate::geom::Point3;
use crate::ir::{Spindle, StepKind};
use crate::source::Span;
use crate::units::Dim;

use super::Analyser;
use super::matched::{Matched, Typed};
use super::process::Setting;

/// How far the image of the axis of a hole may be off Z.
const UPRIGHT: f64 = 1e-9;

impl Analyser<'_> {
    /// The point of `FROM` or `GOTO`, mm.
    fn target(m: &Matched) -> Option<[f64; 3]> {
        match m.vector("point") {
            Some(v) => Some(v.v),
            None => Some([m.number("x")?, m.number("y")?, m.number("z").unwrap_or(0.0)]),
        }
    }

    pub(super) fn from(&mut self, m: &Matched) {
        let Some(p) = Self::target(m) else { return };
        self.state.position = Some(p);
        self.state.at_from = true;
        let p = self.transformed(p);
        self.step(StepKind::From(p));
    }

    pub(super) fn goto(&mut self, m: &Matched, span: Span) {
        if m.form == "pattern" {
            return self.goto_pattern(m);
        }
        let Some(p) = Self::target(m) else { return };
        if m.form == "axis" {
            self.tool_axis(m);
        }
        self.feed_of_move(m, span);
        self.move_to(p, m.word);
    }

    /// To every point of a pattern; `RAPID` before it counts for the first.
    fn goto_pattern(&mut self, m: &Matched) {
        let Some(stops) = self.stops(m) else { return self.state.forget() };
        let mut raise = None;
        for stop in stops {
            if let (Some(height), Some(from)) = (raise, self.state.position) {
                self.move_to([from[0], from[1], from[2] + height], m.word);
                self.move_to([stop.point[0], stop.point[1], stop.point[2] + height], m.word);
            }
            self.move_to(stop.point, m.word);
            raise = stop.raised;
        }
    }

    pub(super) fn godlta(&mut self, m: &Matched, span: Span) {
        let by = match m.vector("vector") {
            Some(v) => {
                let Some(landed) = v.land(Dim::LENGTH, self.unit()) else {
                    let message = format!(
                        "GODLTA moves by lengths, and this is a vector of another dimension: {}",
                        v.show(self.unit())
                    );
                    return self.report(Diagnostic::new(&codes::WRONG_DIMENSION, m.span("vector"), message));
                };
                self.note_bare(v, m.span("vector"));
                landed.v
            }
            None => {
                [m.number("dx").unwrap_or(0.0), m.number("dy").unwrap_or(0.0), m.number("dz").unwrap_or(0.0)]
            }
        };
        let Some(p) = self.state.position else {
            if !self.state.lost {
                let problem = Diagnostic::new(
                    &codes::NO_POSITION,
                    m.word,
                    "GODLTA counts from where the cutter is, and that is not known yet",
                )
                .help("write FROM or GOTO before it");
                self.report(problem);
            }
            return;
        };
        self.feed_of_move(m, span);
        self.move_to([p[0] + by[0], p[1] + by[1], p[2] + by[2]], m.word);
    }

    /// The feed written behind the coordinates.
    fn feed_of_move(&mut self, m: &Matched, span: Span) {
        let found = m.get("feed").map(|f| (f.typed.clone(), f.span));
        if let Some((Typed::Quantity(q), at)) = found
            && let Some(feed) = self.feed(q, None, at)
        {
            self.set_feed(feed, span);
        }
    }

    fn move_to(&mut self, p: [f64; 3], at: Span) {
        let rapid = core::mem::take(&mut self.state.rapid);
        if !rapid {
            self.needs_tool("a move at feed", at);
            self.needs_spindle("a move at feed", at);
            if !(self.state.cycle && self.state.cycle_feeds) {
                self.needs_feed("a move at feed", at);
            }
        }
        self.state.position = Some(p);
        self.state.at_from = false;
        let to = self.transformed(p);
        if self.state.cycle && !rapid {
            self.hole_stands_upright(at);
        }
        self.step(if self.state.cycle && !rapid { StepKind::Hole(to) } else { StepKind::Goto { to, rapid } });
    }

    /// A hole's axis is Z, and its depth counts along it: what `TRACUT` does to them is not carried out.
    fn hole_stands_upright(&mut self, at: Span) {
        let Some((map, since)) = self.state.transform.as_ref() else { return };
        let axis = [map.0[0][2], map.0[1][2], map.0[2][2]];
        let since = *since;
        let off = axis.iter().zip([0.0, 0.0, 1.0]).map(|(a, z)| (a - z).abs()).fold(0.0, f64::max);
        if off <= UPRIGHT || self.state.tilt_told == Some(since) {
            return;
        }
        self.state.tilt_told = Some(since);
        let message = "a hole under a TRACUT that tilts or scales its axis cannot be carried out yet";
        self.report(
            Diagnostic::new(&codes::NOT_YET, at, message)
                .label(since, "the transformation begins here")
                .help("write `TRACUT/ NOMORE` before it"),
        );
    }

    /// A point of motion after `TRACUT`.
    fn transformed(&self, p: [f64; 3]) -> Point3 {
        Point3::from(self.state.transform.as_ref().map_or(p, |(map, _)| map.point(p)))
    }

    /// Reports that a cut has no cutter.
    pub(super) fn needs_tool(&mut self, what: &str, at: Span) {
        if matches!(self.state.tool, Setting::Unset) {
            let message = format!("{what} cuts, and no cutter is loaded");
            self.report(
                Diagnostic::new(&planning::NO_TOOL, at, message).help("write `LOADTL/ T1` before it"),
            );
            self.state.tool = Setting::Unknown;
        }
    }

    /// Reports that a cut has no feed.
    pub(super) fn needs_feed(&mut self, what: &str, at: Span) {
        if matches!(self.state.feed, Setting::Unset) {
            let message = format!("{what} needs a feed, and none is given");
            self.report(
                Diagnostic::new(&planning::NO_FEED, at, message)
                    .help("write `FEDRAT/ 300` before it, or RAPID for a rapid move"),
            );
            self.state.feed = Setting::Unknown;
        }
    }

    /// Reports that a cut has no running spindle.
    pub(super) fn needs_spindle(&mut self, what: &str, at: Span) {
        let problem = match self.state.spindle {
            Setting::Unset => Diagnostic::new(
                &planning::SPINDLE_OFF,
                at,
                format!("{what} cuts, and the spindle does not run"),
            ),
            Setting::Set(Spindle::Off, off) => {
                let by_change = matches!(self.state.tool, Setting::Set(_, change) if change == off);
                Diagnostic::new(&planning::SPINDLE_OFF, at, format!("{what} cuts, and the spindle is off"))
                    .label(off, if by_change { "the tool change stops it" } else { "switched off here" })
            }
            _ => return,
        };
        self.report(problem.help("write `SPINDL/ 1200` before it"));
        self.state.spindle = Setting::Unknown;
    }
}
