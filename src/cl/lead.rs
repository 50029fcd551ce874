//! Geometry of leads: how a cutter comes onto a contour and leaves it.

use super::Lead;
use crate::geom::curve::Frenet;
use crate::geom::{Point2, Side};

/// The path of a lead in the plane, in the order it is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LeadPath {
    /// No motion in the plane.
    Point(Point2),
    /// Straight.
    Line {
        /// First point.
        from: Point2,
        /// Last point.
        to: Point2,
    },
    /// Quarter circle.
    Arc {
        /// First point.
        from: Point2,
        /// Last point.
        to: Point2,
        /// Centre.
        centre: Point2,
        /// Radius, mm.
        radius: f64,
        /// Counter-clockwise.
        ccw: bool,
    },
}

impl LeadPath {
    /// First point.
    #[must_use]
    pub fn from(&self) -> Point2 {
        match *self {
            LeadPath::Point(p) => p,
            LeadPath::Line { from, .. } | LeadPath::Arc { from, .. } => from,
        }
    }
    /// Last point.
    #[must_use]
    pub fn to(&self) -> Point2 {
        match *self {
            LeadPath::Point(p) => p,
            LeadPath::Line { to, .. } | LeadPath::Arc { to, .. } => to,
        }
    }
}

/// The lead that ends at `at`, the contour's first point; the part lies on side `part` of travel.
#[must_use]
pub fn entry(lead: Lead, at: &Frenet, part: Side) -> LeadPath {
    match lead {
        Lead::None | Lead::Plunge => LeadPath::Point(at.p),
        Lead::Line(length) => LeadPath::Line { from: at.p - at.t * length, to: at.p },
        Lead::Arc(radius) => {
            let centre = arc_centre(at, part, radius);
            let from = centre - at.t * radius;
            LeadPath::Arc { from, to: at.p, centre, radius, ccw: part == Side::Right }
        }
    }
}

/// The lead that starts at `at`, the contour's last point; the part lies on side `part` of travel.
#[must_use]
pub fn exit(lead: Lead, at: &Frenet, part: Side) -> LeadPath {
    match lead {
        Lead::None | Lead::Plunge => LeadPath::Point(at.p),
        Lead::Line(length) => LeadPath::Line { from: at.p, to: at.p + at.t * length },
        Lead::Arc(radius) => {
            let centre = arc_centre(at, part, radius);
            let to = centre + at.t * radius;
            LeadPath::Arc { from: at.p, to, centre, radius, ccw: part == Side::Right }
        }
    }
}

/// The arc bends away from the part: its centre lies on the other side.
fn arc_centre(at: &Frenet, part: Side, radius: f64) -> Point2 {
    at.p + at.n() * (part.opposite().sign() * radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Vec2, cross};

    fn along_x() -> Frenet {
        Frenet { p: Point2::new(3.0, 2.0), t: Vec2::new(1.0, 0.0), speed: 1.0, k: 0.0 }
    }

    #[test]
    fn an_entry_arc_ends_on_the_contour_with_its_tangent_and_comes_from_the_clear_side() {
        for (part, start) in [(Side::Right, Point2::new(-2.0, 7.0)), (Side::Left, Point2::new(-2.0, -3.0))] {
            let LeadPath::Arc { from, to, centre, ccw, .. } = entry(Lead::Arc(5.0), &along_x(), part) else {
                panic!("an arc")
            };
            assert_eq!((from, to), (start, along_x().p));
            assert_eq!((from - centre).norm(), 5.0);
            let turns_left = cross(from - centre, to - centre) > 0.0;
            assert_eq!(turns_left, ccw);
        }
    }

    #[test]
    fn an_exit_arc_mirrors_the_entry() {
        let LeadPath::Arc { from, to, ccw, .. } = exit(Lead::Arc(5.0), &along_x(), Side::Right) else {
            panic!("an arc")
        };
        assert_eq!((from, to, ccw), (along_x().p, Point2::new(8.0, 7.0), true));
    }
}
