//! A roughing plan of one level, as moves in the plane.

use crate::geom::curve::{CurveRef, PlanarCurve};
use crate::geom::{Point2, Side};
use crate::ir::Band;

/// One move of a plan.
#[derive(Debug, Clone)]
pub(in crate::plan) enum Move {
    /// From above down to the level at a place clear of the blank.
    Down(Point2),
    /// To this place at feed, then up; clear of part and stock.
    Up(Point2),
    /// Straight at feed.
    Link(Point2),
    /// Along a curve.
    Cut {
        /// Cutter-centre curve.
        curve: CurveRef,
        /// The part's side of travel.
        part: Side,
        /// Band.
        band: Band,
    },
}

/// A plan with its figures.
#[derive(Debug, Clone, Default)]
pub(in crate::plan) struct Plan {
    pub moves: Vec<Move>,
    /// Length of the cuts, mm.
    pub engaged: f64,
    /// Length at feed between them, mm.
    pub links: f64,
    /// Largest radial depth of cut, mm.
    pub engagement: f64,
    position: Option<Point2>,
}

impl Plan {
    /// Path at feed, mm.
    pub fn length(&self) -> f64 {
        self.engaged + self.links
    }
    /// Where the cutter is.
    pub fn position(&self) -> Option<Point2> {
        self.position
    }
    pub fn down(&mut self, p: Point2) {
        self.position = Some(p);
        self.moves.push(Move::Down(p));
    }
    pub fn up(&mut self, p: Point2) {
        self.go(p);
        self.position = None;
        self.moves.push(Move::Up(p));
    }
    pub fn link(&mut self, p: Point2) {
        if self.position != Some(p) {
            self.go(p);
            self.moves.push(Move::Link(p));
        }
    }
    /// Counts the way from where the cutter is to `p`.
    fn go(&mut self, p: Point2) {
        if let Some(from) = self.position {
            self.links += (p - from).norm();
        }
        self.position = Some(p);
    }
    /// Along `curve`, which starts where the cutter is, or straight to its start first.
    pub fn cut(&mut self, curve: CurveRef, part: Side, band: Band) {
        let (first, last) = crate::geom::curve::ends(curve.as_ref());
        self.go(first);
        self.engaged += length(curve.as_ref());
        self.position = Some(last);
        self.moves.push(Move::Cut { curve, part, band });
    }
}

/// Arc length of a curve, mm, by Simpson's rule on every smooth span.
pub(in crate::plan) fn length(curve: &dyn PlanarCurve) -> f64 {
    const PANELS: usize = 64;
    let mut sum = 0.0;
    for (span, pair) in curve.breaks().windows(2).enumerate() {
        let h = (pair[1] - pair[0]) / PANELS as f64;
        let speed = |i: usize| curve.at_in(span, pair[0] + h * i as f64).speed.abs();
        let inner: f64 = (1..PANELS).map(|i| speed(i) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
        sum += (speed(0) + inner + speed(PANELS)) * h / 3.0;
    }
    sum
}
