//! CL splines: the control's own curves where it has them, else lines within the tolerance.
//!
//! Control points are rounded to the grid; since the basis functions are positive and sum to one, the curve moves by no
//! more than its points do. A control that makes its knots by itself gets the whole curve when its knots are equidistant,
//! else its Bézier segments one by one: a clamped curve of four points has no inner knots, so nothing is left to the control.

use super::emit::Emitter;
use super::pieces;
use crate::cl::spline::{ORDER, Spline, segments};
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::geom::Point3;
use crate::source::Span;
use crate::target::{FeedWord, Motion, Nurbs, NurbsForm, Position, power_of_ten};

/// Halvings of one segment at most.
const DEEPEST: u32 = 16;
/// Steps of the grid that a curve may always be off, however small its tolerance.
const LEAST_STEPS: f64 = 2.0;
/// Share of the tolerance that chords of a control may take; the rest is for the bounds of the proof.
const CHORDS: f64 = 0.9;
/// Relative difference of knot intervals that may be taken for equidistant; what that does to the curve is measured.
const EQUIDISTANT: f64 = 1e-3;

/// Why curves are not cut as such.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Reason {
    NoCurves,
    Climbs,
    Feed,
    Rounding,
}

impl Reason {
    fn text(self, name: &str) -> String {
        match self {
            Reason::NoCurves => format!("`{name}` has no such curves"),
            Reason::Climbs => format!("`{name}` has curves in the XY plane only, and their height changes"),
            Reason::Feed => "their feed is per revolution".to_owned(),
            Reason::Rounding => "with rounded points and knots they would be further off".to_owned(),
        }
    }
}

/// Curves that became lines for one reason.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    reason: Reason,
    first: Span,
    curves: usize,
    lines: usize,
    /// Upper bound of the distance, mm.
    deviation: f64,
}

impl Emitter<'_> {
    /// A spline from where the cutter is.
    pub(super) fn spline(&mut self, spline: &Spline) {
        self.face_front();
        let feed = self.linear_feed();
        let points: Vec<Position> = spline.points().iter().map(|p| self.grid_point(*p)).collect();
        match self.curves(spline, &points, feed) {
            Ok(curves) => curves.into_iter().for_each(|curve| self.draw(curve, feed)),
            Err(reason) => self.chords(spline, feed, reason),
        }
        self.exact = Some(spline.end());
    }

    fn grid_point(&mut self, point: Point3) -> Position {
        let [x, y, z] = self.round(point);
        Position { x, y, z, r: self.here().r }
    }

    /// The curves of the control that stand for a spline.
    fn curves(&mut self, spline: &Spline, points: &[Position], feed: FeedWord) -> Result<Vec<Nurbs>, Reason> {
        let form = self.capabilities.nurbs.ok_or(Reason::NoCurves)?;
        if !matches!(feed, FeedWord::PerMinute(_)) {
            return Err(Reason::Feed);
        }
        if !self.capabilities.nurbs_in_space && points.windows(2).any(|pair| pair[0].z != pair[1].z) {
            return Err(Reason::Climbs);
        }
        let whole = match form {
            NurbsForm::G062 { knot_decimals } => printed(spline.knots(), length(spline), knot_decimals),
            NurbsForm::G052 => equidistant(spline.knots()),
            NurbsForm::Pieces { finer, chord } => return self.pieces(spline, points, finer, chord),
        };
        if let Some(knots) = whole {
            let curve = nurbs(points, knots);
            if self.off(spline.segments(), &curve).is_some_and(|off| off <= self.for_curve(spline)) {
                return Ok(vec![curve]);
            }
        }
        self.bezier_curves(spline, points)
    }

    /// One curve for each Bézier segment.
    fn bezier_curves(&mut self, spline: &Spline, points: &[Position]) -> Result<Vec<Nurbs>, Reason> {
        let limit = self.for_curve(spline);
        let mut curves = Vec::new();
        let mut from = points.first().copied().unwrap_or_default();
        for segment in spline.segments() {
            let [_, b, c, d] = segment.map(|p| self.grid_point(p));
            let curve = nurbs(&[from, b, c, d], [[0.0; ORDER], [1.0; ORDER]].concat());
            if self.off(core::iter::once(segment), &curve).is_none_or(|off| off > limit) {
                return Err(Reason::Rounding);
            }
            from = d;
            curves.push(curve);
        }
        Ok(curves)
    }

    /// One piece for each Bézier segment, or more where its coefficients would be too large for their words, or chords of it
    /// too far off.
    fn pieces(
        &mut self,
        spline: &Spline,
        points: &[Position],
        finer: u8,
        chord: f64,
    ) -> Result<Vec<Nurbs>, Reason> {
        let limit = self.for_curve(spline);
        let mut curves = Vec::new();
        let mut from = points.first().copied().unwrap_or_default();
        // The next part lies on top.
        let mut parts: Vec<([Point3; ORDER], u32)> = spline.segments().map(|s| (s, 0)).collect();
        parts.reverse();
        while let Some((segment, depth)) = parts.pop() {
            let to = self.grid_point(segment[ORDER - 1]);
            let ends = [from, to].map(|p| [p.x, p.y, p.z]);
            let step = self.capabilities.grid.linear_step();
            let points = pieces::rounded(&segment, ends, step, finer).ok_or(Reason::Rounding)?;
            let curve = pieces::nurbs(points, to.r, finer);
            let off = self.off(core::iter::once(segment), &curve).ok_or(Reason::Rounding)?;
            let cut = off + pieces::sagitta(&segment, chord);
            let fits = pieces::fits(&curve, self.capabilities.ranges.coefficient);
            if off > limit || depth >= DEEPEST {
                return Err(Reason::Rounding);
            }
            if !fits || cut > CHORDS * limit {
                let [left, right] = pieces::halves(segment);
                parts.extend([(right, depth + 1), (left, depth + 1)]);
                continue;
            }
            from = to;
            curves.push(curve);
        }
        Ok(curves)
    }

    /// Upper bound of the distance of a lowered curve from Bézier segments with the same ends, mm: their control points'.
    fn off(&self, exact: impl Iterator<Item = [Point3; ORDER]>, curve: &Nurbs) -> Option<f64> {
        let step = self.capabilities.grid.linear_step() / curve.fine_steps() as f64;
        let place = |p: &Position| Point3::new(p.x as f64 * step, p.y as f64 * step, p.z as f64 * step);
        let points: Vec<Point3> = curve.points.iter().map(|(p, _)| place(p)).collect();
        let (exact, drawn): (Vec<_>, Vec<_>) = (exact.collect(), segments(&points, &curve.knots).collect());
        let apart = |(a, b): (&[Point3; ORDER], &[Point3; ORDER])| {
            a.iter().zip(b).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max)
        };
        (exact.len() == drawn.len()).then(|| exact.iter().zip(&drawn).map(apart).fold(0.0, f64::max))
    }

    /// How far the path may be off a spline, mm, the control's own smoothing apart.
    fn for_curve(&self, spline: &Spline) -> f64 {
        let share = self.capabilities.path_tolerance.map_or(0.0, |p| p.share);
        let least = LEAST_STEPS * self.capabilities.grid.linear_step();
        spline.tolerance().max(least) * (1.0 - share)
    }

    pub(super) fn draw(&mut self, curve: Nurbs, feed: FeedWord) {
        let Some(to) = curve.end() else { return };
        let places: Vec<Position> = curve.places().collect();
        // Less than a step of the grid.
        if places.iter().all(|p| *p == to) {
            return;
        }
        self.check_place(&places);
        self.at = [to.x, to.y, to.z, to.r].map(Some);
        let index = u32::try_from(self.nurbs.len()).unwrap_or(u32::MAX);
        self.nurbs.push(curve);
        self.push(Motion::Nurbs { curve: index, feed });
    }

    /// Chords within the tolerance; their corners lie on the curve, rounded to the grid.
    fn chords(&mut self, spline: &Spline, feed: FeedWord, reason: Reason) {
        let step = self.capabilities.grid.linear_step();
        // Half the diagonal of a grid cell is lost by rounding.
        let rounding = 0.5 * step * 3.0_f64.sqrt();
        // A little is left for the bounds of the proof.
        let sagitta = 0.95 * self.for_curve(spline) - rounding;
        if sagitta < 0.1 * rounding {
            let message = format!(
                "lines on a grid of {step} mm cannot follow a curve within {} mm; {}",
                self.for_curve(spline),
                reason.text(&self.capabilities.name)
            );
            return self.complain(&codes::lowering::CANNOT_FIT, message);
        }
        let mut ends = Vec::new();
        let mut worst = 0.0_f64;
        for segment in spline.segments() {
            worst = worst.max(flatten(segment, sagitta, 0, &mut ends));
        }
        let before = self.blocks.len();
        for end in &ends {
            let to = self.grid_point(*end);
            self.line(to, feed);
        }
        self.told_of_curve(reason, self.blocks.len() - before, worst + rounding);
    }

    fn told_of_curve(&mut self, reason: Reason, lines: usize, deviation: f64) {
        if let Some(told) = self.curves_told.iter_mut().find(|told| told.reason == reason) {
            told.curves += 1;
            told.lines += lines;
            told.deviation = told.deviation.max(deviation);
        } else {
            let first = self.cl.origins[self.origin].span;
            self.curves_told.push(Told { reason, first, curves: 1, lines, deviation });
        }
    }

    /// Says once for each reason what became of all curves.
    pub(super) fn report_curves(&mut self) {
        let mut all = core::mem::take(&mut self.curves_told);
        all.sort_by_key(|told| told.reason);
        let unit = self.cl.units;
        for told in all {
            let Told { reason, first, curves, lines, deviation } = told;
            let message = format!(
                "{curves} curve{} (NURBS) {} cut by {lines} lines, at most {:.4} {} off: {}",
                if curves == 1 { "" } else { "s" },
                if curves == 1 { "is" } else { "are" },
                deviation / unit.in_mm(),
                unit.symbol(),
                reason.text(&self.capabilities.name)
            );
            self.sink.push(Diagnostic::new(&codes::foreign::CURVE_AS_LINES, first, message));
        }
    }
}

fn nurbs(points: &[Position], knots: Vec<f64>) -> Nurbs {
    Nurbs { order: ORDER as u8, points: points.iter().map(|p| (*p, 1.0)).collect(), knots, finer: 0 }
}

/// Length of the control polygon, mm.
fn length(spline: &Spline) -> f64 {
    spline.points().windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

/// Knots from 0 to about `length`, rounded to what is printed; `None` when different ones become the same.
#[allow(clippy::float_cmp)]
fn printed(knots: &[f64], length: f64, decimals: u8) -> Option<Vec<f64>> {
    let (first, last) = (knots.first()?, knots.last()?);
    let scale = power_of_ten(decimals);
    let end = (length.clamp(1.0, 1e4) * scale).round();
    let print = |knot: &f64| ((knot - first) / (last - first) * end).round() / scale;
    let rounded: Vec<f64> = knots.iter().map(print).collect();
    let parted = knots.windows(2).zip(rounded.windows(2)).all(|(k, r)| (k[0] == k[1]) == (r[0] == r[1]));
    // A control takes an inner knot three times at most.
    let inner = rounded.get(ORDER..rounded.len() - ORDER)?;
    let crowded = inner.windows(ORDER).any(|run| run[0] == run[ORDER - 1]);
    let touches = inner.iter().any(|k| *k == rounded[0] || Some(k) == rounded.last());
    (parted && !crowded && !touches).then_some(rounded)
}

/// The knots 0, 0, 0, 0, 1, 2, … when these are equidistant.
fn equidistant(knots: &[f64]) -> Option<Vec<f64>> {
    let inner = knots.get(ORDER - 1..=knots.len() - ORDER)?;
    let whole = inner.last()? - inner.first()?;
    let count = crate::math::count(inner.len() - 1);
    let even = |pair: &[f64]| ((pair[1] - pair[0]) * count / whole - 1.0).abs() <= EQUIDISTANT;
    let last = inner.len() - 1;
    let knot = |i: usize| crate::math::count((i + 1).saturating_sub(ORDER).min(last));
    inner.windows(2).all(even).then(|| (0..knots.len()).map(knot).collect())
}

/// Ends of the chords of a Bézier segment; gives an upper bound of its distance from them.
fn flatten(b: [Point3; ORDER], tolerance: f64, depth: u32, ends: &mut Vec<Point3>) -> f64 {
    // A cubic comes to three quarters of its inner control points' distance at most.
    let off = 0.75 * distance(b[1], b[0], b[3]).max(distance(b[2], b[0], b[3]));
    if off <= tolerance || depth >= DEEPEST {
        ends.push(b[3]);
        return off;
    }
    let [left, right] = pieces::halves(b).map(|half| flatten(half, tolerance, depth + 1, ends));
    left.max(right)
}

/// Distance of a point from the segment between two others.
fn distance(p: Point3, a: Point3, b: Point3) -> f64 {
    let (v, d) = (p - a, b - a);
    let length = d.norm_squared();
    let x = if length > 0.0 { (v.dot(&d) / length).clamp(0.0, 1.0) } else { 0.0 };
    (v - d * x).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_that_rounding_would_merge_are_not_printed() {
        let knots = |inner: &[f64]| [&[0.0; 4], inner, &[1.0; 4]].concat();
        assert_eq!(
            printed(&knots(&[0.25, 0.25, 0.5]), 10.0, 2).map(|k| k[3..8].to_vec()),
            Some(vec![0.0, 2.5, 2.5, 5.0, 10.0])
        );
        for inner in [&[0.25, 0.250_01][..], &[1e-7], &[0.5; 4], &[0.999_999]] {
            assert_eq!(printed(&knots(inner), 10.0, 2), None, "{inner:?}");
        }
    }

    #[test]
    fn equidistant_knots_are_counted() {
        let third = 1.0 / 3.0;
        let knots = [&[0.0; 4][..], &[third, 2.0 * third], &[1.0; 4]].concat();
        assert_eq!(
            equidistant(&knots).map(|k| k[3..].to_vec()),
            Some(vec![0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0])
        );
        assert_eq!(equidistant(&[0.0, 0.0, 0.0, 0.0, 0.3, 1.0, 1.0, 1.0, 1.0]), None);
        assert!(equidistant(&[0.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 2.0]).is_some());
    }
}
