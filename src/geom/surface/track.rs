//! Tracks: the exact curve of a cutter's reference point (a ball's centre) along a pass over a surface.
//!
//! A track is never sampled beforehand: it answers where the cutter touches at any parameter. Where the ball set down on
//! its guide would gouge elsewhere, it is lifted until it rests.

use std::sync::Arc;

use super::cutter::Cutter;
use super::drop::{Contact, TOUCHES, drop_ball};
use super::net::Net;
use super::rim::Rim;
use super::tree::{Foot, SurfaceTree};
use crate::geom::{Point2, Point3};

/// What a track follows.
#[derive(Debug, Clone, PartialEq)]
pub enum Guide {
    /// A parameter line of the net: the point of contact runs along it.
    Parameter {
        /// 0: along u at constant v; 1: along v at constant u.
        axis: usize,
        /// The constant parameter.
        value: f64,
        /// First and last value of the other, in the direction of travel.
        range: (f64, f64),
    },
    /// A straight line in plan: the axis of the cutter runs along it.
    Line {
        /// First point, mm.
        from: Point2,
        /// Last point, mm.
        to: Point2,
    },
    /// A parameter line of the net and its rim in plan: the axis of the cutter runs over it.
    Over {
        /// 0: along u at constant v; 1: along v at constant u.
        axis: usize,
        /// The constant parameter.
        value: f64,
        /// First and last value of the other, in the direction of travel.
        range: (f64, f64),
        /// What the plan goes on by beyond the net.
        rim: Rim,
    },
    /// A curve in the net's parameters, along which the point of contact runs: cubic through these places.
    Curve(Arc<Vec<[f64; 2]>>),
    /// A curve in plan, over which the axis of the cutter runs: cubic through these places, mm.
    Plan(Arc<Vec<Point2>>),
}

impl Guide {
    /// The place of the cutter's axis in plan at `t` in 0..=1, where a bent guide tells it without the surface.
    #[must_use]
    pub fn plan(&self, net: &Net, t: f64) -> Option<Point2> {
        match self {
            Guide::Over { axis, value, range, rim } => Some(over(net, (*axis, *value, *range, rim), t)),
            Guide::Plan(places) => Some(through(places, t)),
            _ => None,
        }
    }
}

/// The place over a parameter line and the rim.
fn over(net: &Net, (axis, value, range, rim): (usize, f64, (f64, f64), &Rim), t: f64) -> Point2 {
    let along = range.0 + (range.1 - range.0) * t;
    rim.place(net, if axis == 0 { [along, value] } else { [value, along] })
}

/// The curve of a cutter's reference point over a surface.
#[derive(Debug, Clone)]
pub struct Track {
    /// The surface.
    pub tree: Arc<SurfaceTree>,
    /// Radius of the ball that rounds the cutter, with what is to be left on the surface, mm.
    pub radius: f64,
    /// The cutter, with the same hull.
    pub cutter: Cutter,
    /// What is followed; the parameter runs from 0 to 1.
    pub guide: Guide,
}

impl Track {
    /// The contact at `t` in 0..=1; `hint`: the contact at a place near by. `None` where the ball touches nothing, or
    /// where the surface has no normal towards the tool.
    #[must_use]
    pub fn at(&self, t: f64, hint: Option<&Contact>) -> Option<Contact> {
        match &self.guide {
            Guide::Parameter { axis, value, range } => {
                let along = range.0 + (range.1 - range.0) * t;
                let uv = if *axis == 0 { [along, *value] } else { [*value, along] };
                self.over(uv)
            }
            Guide::Line { from, to } => {
                let p = from + (to - from) * t;
                self.cutter.drop(&self.tree, p.x, p.y, hint)
            }
            Guide::Over { axis, value, range, rim } => {
                let p = over(self.tree.net(), (*axis, *value, *range, rim), t);
                self.cutter.drop(&self.tree, p.x, p.y, hint)
            }
            Guide::Curve(places) => self.over(cubic(places, t)),
            Guide::Plan(places) => {
                let p = through(places, t);
                self.cutter.drop(&self.tree, p.x, p.y, hint)
            }
        }
    }

    /// The ball set on the surface at net parameters, lifted if it would gouge.
    fn over(&self, uv: [f64; 2]) -> Option<Contact> {
        let stand = self.tree.creases().stand(self.tree.net(), uv).filter(|s| s.normal.z > 1e-6)?;
        let normal = stand.normal;
        let centre = stand.point + normal * self.radius;
        let (distance, certain) = (self.radius, self.radius);
        let own = Foot { patch: stand.patch, uv: stand.uv, point: stand.point, distance, certain };
        let nearest = self.tree.nearest(centre, Some(&own));
        if nearest.distance >= self.radius - TOUCHES {
            return Some(Contact { centre, normal, foot: own });
        }
        self.lifted(centre, nearest)
    }

    fn lifted(&self, centre: Point3, nearest: Foot) -> Option<Contact> {
        let normal = (centre - nearest.point) / nearest.distance.max(1e-9);
        let hint = Contact { centre, normal, foot: nearest };
        drop_ball(&self.tree, self.radius, centre.x, centre.y, Some(&hint))
    }

    /// The same track the other way.
    #[must_use]
    pub fn reversed(&self) -> Track {
        let guide = match &self.guide {
            Guide::Parameter { axis, value, range } => {
                Guide::Parameter { axis: *axis, value: *value, range: (range.1, range.0) }
            }
            Guide::Line { from, to } => Guide::Line { from: *to, to: *from },
            Guide::Over { axis, value, range, rim } => {
                Guide::Over { axis: *axis, value: *value, range: (range.1, range.0), rim: *rim }
            }
            Guide::Curve(places) => Guide::Curve(Arc::new(places.iter().rev().copied().collect())),
            Guide::Plan(places) => Guide::Plan(Arc::new(places.iter().rev().copied().collect())),
        };
        Track { tree: Arc::clone(&self.tree), guide, ..*self }
    }
}

/// Catmull and Rom's cubic through places in plan.
fn through(places: &[Point2], t: f64) -> Point2 {
    cubic_of(places.len(), &|j| [places[j].x, places[j].y], t).into()
}

/// Catmull and Rom's cubic through equidistant places.
fn cubic(places: &[[f64; 2]], t: f64) -> [f64; 2] {
    cubic_of(places.len(), &|j| places[j], t)
}

/// The same through so many places.
fn cubic_of(places: usize, place: &dyn Fn(usize) -> [f64; 2], t: f64) -> [f64; 2] {
    let Some(last) = places.checked_sub(1).filter(|n| *n > 0) else {
        return if places == 1 { place(0) } else { [0.0, 0.0] };
    };
    let x = t.clamp(0.0, 1.0) * crate::math::count(last);
    // x lies in 0..=last, and floats saturate.
    let i = (x.floor() as usize).min(last - 1);
    let f = x - crate::math::count(i);
    core::array::from_fn(|k| {
        let at = |j: usize| place(j.min(last))[k];
        let (b, c) = (at(i), at(i + 1));
        let a = if i == 0 { 2.0 * b - c } else { at(i - 1) };
        let d = if i + 2 > last { 2.0 * c - b } else { at(i + 2) };
        let (m, n) = (0.5 * (c - a), 0.5 * (d - b));
        let (f2, f3) = (f * f, f * f * f);
        b * (2.0 * f3 - 3.0 * f2 + 1.0) + m * (f3 - 2.0 * f2 + f) + c * (3.0 * f2 - 2.0 * f3) + n * (f3 - f2)
    })
}
