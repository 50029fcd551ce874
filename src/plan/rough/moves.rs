//! A roughing plan of one level, as moves in the plane.

use std::sync::Arc;

use crate::geom::curve::{Chain, CurveRef, Part, ends};
use crate::geom::{Point2, Side, measure};
use crate::ir::Band;

/// One move of a plan.
#[derive(Debug, Clone)]
pub(in crate::plan) enum Move {
    /// From above down to the level at a place clear of the blank.
    Down(Point2),
    /// From above onto the level before, and down along these places: each with its share of the way down.
    Ramp(Vec<(Point2, f64)>),
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
    pub fn ramp(&mut self, points: Vec<(Point2, f64)>) {
        let Some((first, _)) = points.first() else { return };
        self.position = Some(*first);
        for (p, _) in &points {
            self.go(*p);
        }
        self.moves.push(Move::Ramp(points));
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
    /// Along `curve` through the stock; straight to its start first, if the cutter is elsewhere.
    pub fn cut(&mut self, curve: CurveRef, part: Side, band: Band) {
        self.engaged += self.follow(curve, part, band);
    }
    /// Once round the closed `curve` from its start, and a little over it. What is cut is open, so that its
    /// start stays where the way to it leads.
    pub fn round(&mut self, curve: &CurveRef, part: Side, band: Band) {
        self.cut(overlapping(curve), part, band);
    }
    /// Along `curve` where nothing is left to cut.
    pub fn run(&mut self, curve: CurveRef, part: Side, band: Band) {
        self.links += self.follow(curve, part, band);
    }
    /// Returns the curve's length, mm.
    fn follow(&mut self, curve: CurveRef, part: Side, band: Band) -> f64 {
        /// Accuracy of a length in a report, mm.
        const ACCURACY: f64 = 1e-6;
        let (first, last) = ends(curve.as_ref());
        self.go(first);
        self.position = Some(last);
        let length = measure::length(curve.as_ref(), ACCURACY);
        self.moves.push(Move::Cut { curve, part, band });
        length
    }
}

/// A closed curve with its first millimetre once more at its end.
fn overlapping(curve: &CurveRef) -> CurveRef {
    const OVERLAP: f64 = 1.0;
    const JOIN: f64 = 1e-6;
    let (first, last) = curve.domain();
    let speed = curve.at(first).speed.abs().max(f64::MIN_POSITIVE);
    let more = (OVERLAP / speed).min(0.25 * (last - first));
    let again = Part::new(curve.clone(), first, first + more).map(|p| Arc::new(p) as CurveRef);
    let pieces = [Some(curve.clone()), again].into_iter().flatten().collect();
    Chain::new(pieces, JOIN).map_or_else(|_| curve.clone(), |chain| Arc::new(chain))
}
