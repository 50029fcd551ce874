//! Whether a face takes its whole surface: the ends and samples of its edges against the edges of the net.

use crate::geom::Point3;
use crate::geom::surface::Net;

use super::Notice;

/// Edges of a face this near to the net's are the net's, mm: CAD systems trim with tolerances up to this.
const NEAR: f64 = 0.01;
/// Places at which a side of a patch is searched for a nearest point, before the search is refined.
const PLACES: u32 = 24;
/// Halvings of the step of the search.
const REFINED: u32 = 24;
/// Points of edges that are compared, at most.
const MOST: usize = 2000;

/// Bytes of edges that are read for one face, at most.
const WORK: usize = 64 * 1024 * 1024;

/// The outer boundary of a face.
#[derive(Debug, Default)]
pub(super) struct Boundary {
    /// Ends of its edges, mm.
    pub corners: Vec<Point3>,
    /// Points inside its edges, mm.
    pub inner: Vec<Point3>,
    /// More loops than one.
    pub holes: bool,
    /// An edge whose points could not be had.
    pub unknown: bool,
    /// Bytes that have been read for it.
    pub work: usize,
}

impl Boundary {
    /// Whether an edge of so many bytes may still be read; if not, the edges are unknown.
    pub fn may_read(&mut self, bytes: usize) -> bool {
        self.work = self.work.saturating_add(bytes);
        self.unknown |= self.work > WORK;
        !self.unknown
    }
    /// What to say of a face of this boundary on the surface of `net`.
    pub fn notice(&self, net: &Net) -> Option<Notice> {
        let near = |p: &Point3, q: &Point3| (p - q).norm() <= NEAR;
        let [m, n] = net.size().map(crate::math::count);
        let corners = [(0.0, 0.0), (m, 0.0), (0.0, n), (m, n)].map(|(u, v)| net.jet(u, v).p);
        if self.corners.is_empty() {
            return Some(Notice::EdgesUnknown);
        }
        let reached = corners.iter().all(|c| self.corners.iter().any(|p| near(p, c)));
        let every = self.inner.len() / MOST + 1;
        let points = self.corners.iter().take(MOST).chain(self.inner.iter().step_by(every));
        let mut points = points;
        if self.holes || !reached || !points.all(|p| on_edge(net, p)) {
            return Some(Notice::Trimmed);
        }
        self.unknown.then_some(Notice::EdgesUnknown)
    }
}

/// Whether a point lies on one of the four edges of the net.
fn on_edge(net: &Net, p: &Point3) -> bool {
    let [m, n] = net.size();
    let [last_u, last_v] = [m, n].map(crate::math::count);
    let along_u = |v: f64| move |t: f64| net.jet(t, v).p;
    let along_v = |u: f64| move |t: f64| net.jet(u, t).p;
    distance(&along_u(0.0), m, p) <= NEAR
        || distance(&along_u(last_v), m, p) <= NEAR
        || distance(&along_v(0.0), n, p) <= NEAR
        || distance(&along_v(last_u), n, p) <= NEAR
}

/// Distance of a point from a curve over `0..=patches`: from the nearest of many places, then by halving steps. It may be
/// too large, never too small.
fn distance(curve: &impl Fn(f64) -> Point3, patches: usize, p: &Point3) -> f64 {
    let count = crate::math::count;
    let places = patches * PLACES as usize;
    let far = |t: f64| (curve(t) - p).norm();
    let at = |k: usize| count(k) / f64::from(PLACES);
    let (mut best, mut t) = (0..=places)
        .map(|k| (far(at(k)), at(k)))
        .fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
    let mut step = 0.5 / f64::from(PLACES);
    for _ in 0..REFINED {
        for s in [(t - step).max(0.0), (t + step).min(count(patches))] {
            if far(s) < best {
                (best, t) = (far(s), s);
            }
        }
        step *= 0.5;
    }
    best
}
