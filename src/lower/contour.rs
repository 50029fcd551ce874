//! Choosing how a contour is expressed, and fitting it.

use std::sync::Arc;

use rayon::prelude::*;

use super::compensation;
use super::fit::{self, Fit, FitError, Tube};
use super::path;
use crate::arena::Handle;
use crate::cl::{Cl, Contour, Lead, Record, RecordKind};
use crate::diag::{Code, Diagnostic, Sink, codes};
use crate::geom::Side;
use crate::geom::curve::Shape;
use crate::ir::{Band, Interpolation, Origin, at_origin};
use crate::target::{Capabilities, NurbsForm};

/// A contour's fit.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// The chain, on the grid.
    pub fit: Fit,
    /// What it is made of; never [`Interpolation::Auto`].
    pub interpolation: Interpolation,
    /// Part of the band left to the control, mm.
    pub reserved: f64,
}

/// What the target cannot do and what was done instead.
type Demotion = (&'static Code, String);

/// A fitted contour with what had to be demoted for it.
type Fitting = Result<(Arc<Fitted>, Vec<Demotion>), FitError>;

/// Fits all contours of a program, in parallel; one entry a record, `None` where it is no contour. Contours
/// that ask the same share a fit.
pub fn fit_all(cl: &Cl, capabilities: &Capabilities, sink: &mut Sink) -> Vec<Option<Arc<Fitted>>> {
    let contours: Vec<(usize, &Contour)> = cl
        .records
        .iter()
        .enumerate()
        .filter_map(|(i, r)| if let RecordKind::Contour(c) = &r.kind { Some((i, &**c)) } else { None })
        .collect();
    // Controls refuse curves under their cutter compensation.
    let (compensated, plain) =
        (compensation::wanted(cl), Capabilities { nurbs: None, ..capabilities.clone() });
    let under = |i: usize| contours.get(i).is_some_and(|(r, _)| compensated.get(*r) == Some(&true));
    let leaders: Vec<usize> = (0..contours.len())
        .map(|i| {
            (0..i).find(|&j| same_task(contours[i].1, contours[j].1) && under(i) == under(j)).unwrap_or(i)
        })
        .collect();
    let results: Vec<Option<Fitting>> = contours
        .par_iter()
        .enumerate()
        .map(|(i, (_, contour))| {
            (leaders[i] == i).then(|| fit_one(contour, if under(i) { &plain } else { capabilities }))
        })
        .collect();
    let mut fitted = vec![None; cl.records.len()];
    let mut told: Vec<(&'static str, crate::source::Span)> = Vec::new();
    for (i, (record, contour)) in contours.iter().enumerate() {
        match &results[leaders[i]] {
            Some(Ok((fit, demotions))) => {
                fitted[*record] = Some(Arc::clone(fit));
                tell(cl, &cl.records[*record], demotions, fit, &mut told, sink);
            }
            Some(Err(error)) if leaders[i] == i => {
                sink.push(cannot_fit(
                    cl,
                    cl.records[*record].origin,
                    contour.band,
                    error.to_string(),
                    capabilities,
                ));
            }
            _ => {}
        }
    }
    fitted
}

fn same_task(a: &Contour, b: &Contour) -> bool {
    Arc::ptr_eq(&a.curve, &b.curve)
        && a.part == b.part
        && a.band == b.band
        && a.interpolation == b.interpolation
        && a.exact_dwells == b.exact_dwells
        && a.start == b.start
        && (a.entry == Lead::None) == (b.entry == Lead::None)
}

/// One note for each code and statement: a roughing operation has many contours.
fn tell(
    cl: &Cl,
    record: &Record,
    demotions: &[Demotion],
    fitted: &Fitted,
    told: &mut Vec<(&'static str, crate::source::Span)>,
    sink: &mut Sink,
) {
    for (code, message) in demotions {
        let key = (code.id, cl.origins[record.origin].span);
        if !told.contains(&key) {
            told.push(key);
            let (left, right) = fitted.fit.deviation;
            sink.push(at_origin(code, &cl.origins, record.origin, message.as_str()).note(format!(
                "{} blocks; largest deviation {:.4} mm",
                path::blocks(&fitted.fit),
                left.max(right)
            )));
        }
    }
}

/// That a path cannot be had in its band on the control's grid.
pub(super) fn cannot_fit(
    cl: &Cl,
    origin: Handle<Origin>,
    Band { into, out }: Band,
    message: String,
    capabilities: &Capabilities,
) -> Diagnostic {
    at_origin(&codes::lowering::CANNOT_FIT, &cl.origins, origin, message)
        .note(format!(
            "the band is INTOL {into} mm, OUTTOL {out} mm; {} takes {} decimals in {}",
            capabilities.name,
            capabilities.grid.linear_decimals,
            capabilities.grid.unit.symbol()
        ))
        .help("give a larger INTOL or OUTTOL, or use a post with more decimals")
}

fn fit_one(contour: &Contour, capabilities: &Capabilities) -> Result<(Arc<Fitted>, Vec<Demotion>), FitError> {
    let mut demotions = Vec::new();
    let reserved = reserve(contour.band, capabilities, &mut demotions);
    let wanted = legal(contour, capabilities, &mut demotions);
    let (mut left, mut right) = match contour.part {
        Side::Left => (contour.band.into, contour.band.out),
        Side::Right => (contour.band.out, contour.band.into),
    };
    left = (left - reserved).max(0.0);
    right = (right - reserved).max(0.0);
    let tube = Tube { curve: &*contour.curve, left, right };
    let (fit, interpolation) = fit_as(&tube, contour, wanted, capabilities)?;
    Ok((Arc::new(Fitted { fit, interpolation, reserved }), demotions))
}

/// The control's part of the band.
fn reserve(band: Band, capabilities: &Capabilities, demotions: &mut Vec<Demotion>) -> f64 {
    let Some(path) = capabilities.path_tolerance else { return 0.0 };
    let least = band.into.min(band.out);
    if least <= 0.0 {
        demotions.push((
            &codes::lowering::PATH_TOLERANCE,
            "one side of the tolerance is zero: nothing is left for the control's own smoothing, it follows the exact path"
                .into(),
        ));
    }
    least * path.share
}

/// The interpolation asked for, or what the target has instead.
fn legal(contour: &Contour, capabilities: &Capabilities, demotions: &mut Vec<Demotion>) -> Interpolation {
    let name = &capabilities.name;
    let round = if capabilities.arcs { "arcs" } else { "lines" };
    match contour.interpolation {
        Interpolation::RTheta if !polar_possible(contour, capabilities) => {
            let why = if capabilities.rotary.is_some() {
                "this cut is entered from the side"
            } else {
                "it has no rotary axis"
            };
            demotions.push((
                &codes::lowering::NO_ROTARY,
                format!("RTHETA is not possible on `{name}`: {why}; the path is made of {round}"),
            ));
            Interpolation::Auto
        }
        Interpolation::Nurbs if !capabilities.fits_curves() => {
            demotions.push((
                &codes::lowering::NO_NURBS,
                match capabilities.nurbs {
                    None => format!("`{name}` has no NURBS; the path is made of {round}"),
                    Some(_) => format!("`{name}` cuts chords of curves; the path is made of {round}"),
                },
            ));
            Interpolation::Auto
        }
        Interpolation::Circular if !capabilities.arcs => {
            demotions.push((
                &codes::lowering::NO_ARCS,
                format!("`{name}` has no circular interpolation; the path is made of lines"),
            ));
            Interpolation::Linear
        }
        other => other,
    }
}

/// R-theta output needs a rotary axis, and an entry from above, where the table can turn.
fn polar_possible(contour: &Contour, capabilities: &Capabilities) -> bool {
    capabilities.rotary.is_some() && contour.entry != Lead::None && contour.exit != Lead::None
}

fn fit_as(
    tube: &Tube,
    contour: &Contour,
    wanted: Interpolation,
    capabilities: &Capabilities,
) -> Result<(Fit, Interpolation), FitError> {
    let grid = fit::Grid::from(&capabilities.grid);
    let start = contour.start;
    match wanted {
        Interpolation::Linear => fit::lines(tube, &grid, start).map(|f| (f, Interpolation::Linear)),
        Interpolation::Circular => {
            fit::arcs(tube, &grid, contour.exact_dwells, start).map(|f| (f, Interpolation::Circular))
        }
        Interpolation::RTheta => fit::spirals(tube, &grid, start).map(|f| (f, Interpolation::RTheta)),
        Interpolation::Nurbs => {
            fit::nurbs(tube, &grid, knots(capabilities), start).map(|f| (f, Interpolation::Nurbs))
        }
        Interpolation::Auto => fewest(tube, contour, capabilities),
    }
}

/// How the control takes knots.
fn knots(capabilities: &Capabilities) -> fit::Knots {
    match capabilities.nurbs {
        Some(NurbsForm::G062 { knot_decimals }) => fit::Knots::Printed { decimals: u32::from(knot_decimals) },
        Some(NurbsForm::Pieces { finer, .. }) => fit::Knots::Pieces { finer },
        Some(NurbsForm::G052) | None => fit::Knots::Uniform,
    }
}

/// The fewest blocks that the target can do; among equals the smaller deviation, then the simpler motion.
///
/// Arcs come first; what cannot have fewer blocks than the best so far is not fitted.
fn fewest(
    tube: &Tube,
    contour: &Contour,
    capabilities: &Capabilities,
) -> Result<(Fit, Interpolation), FitError> {
    let mut best: Option<(Fit, Interpolation)> = None;
    let mut failure = None;
    for kind in candidates(contour, capabilities) {
        let most = best.as_ref().map(|b| path::blocks(&b.0));
        match challenge(tube, contour, kind, capabilities, most) {
            Ok(Some(found)) => best = Some(best.filter(|b| !better(&found.0, &b.0)).unwrap_or(found)),
            Ok(None) => {}
            Err(error) => failure = failure.or(Some(error)),
        }
    }
    match (best, failure) {
        (Some(best), _) => Ok(best),
        // Lines are the last resort; when they fail too, that is the reason.
        (None, _) => fit_as(tube, contour, Interpolation::Linear, capabilities),
    }
}

/// What AUTO may choose from. Dwells do not become chords where there are arcs, and only arcs keep them exactly.
fn candidates(contour: &Contour, capabilities: &Capabilities) -> Vec<Interpolation> {
    let spans = contour.curve.breaks().len().saturating_sub(1);
    let round = (0..spans).any(|i| matches!(contour.curve.shape(i), Shape::Arc { .. }));
    let exact = capabilities.arcs && contour.exact_dwells && round;
    [
        (Interpolation::Circular, capabilities.arcs),
        (Interpolation::Linear, !(capabilities.arcs && round)),
        (Interpolation::RTheta, !exact && polar_possible(contour, capabilities)),
        (Interpolation::Nurbs, !exact && capabilities.fits_curves()),
    ]
    .into_iter()
    .filter_map(|(kind, possible)| possible.then_some(kind))
    .collect()
}

/// A fit of this kind, unless it cannot have as few blocks as `most` (fewer, for a NURBS curve).
fn challenge(
    tube: &Tube,
    contour: &Contour,
    kind: Interpolation,
    capabilities: &Capabilities,
    most: Option<usize>,
) -> Result<Option<(Fit, Interpolation)>, FitError> {
    let grid = fit::Grid::from(&capabilities.grid);
    let hopeless = match (kind, most) {
        (_, None) => false,
        (Interpolation::Linear, Some(most)) => !fit::bound::lines_may_be(tube, &grid, most)?,
        (Interpolation::RTheta, Some(most)) => !fit::bound::spirals_may_be(tube, &grid, most)?,
        (Interpolation::Nurbs, Some(most)) => {
            let more = 1 + capabilities.nurbs.map_or(0, NurbsForm::more_blocks);
            let most = most.saturating_sub(more);
            let fit = fit::nurbs_of(tube, &grid, knots(capabilities), contour.start, most)?;
            return Ok(fit.map(|f| (f, kind)));
        }
        _ => false,
    };
    if hopeless { Ok(None) } else { fit_as(tube, contour, kind, capabilities).map(Some) }
}

fn better(a: &Fit, b: &Fit) -> bool {
    let worst = |f: &Fit| f.deviation.0.max(f.deviation.1);
    (path::blocks(a), worst(a)) < (path::blocks(b), worst(b))
}
