//! The largest concave curvature of a patch or net, by branch and bound.
//!
//! Over a parameter box the principal curvature κ₁ is enclosed twice: by interval arithmetic on the Bernstein
//! hulls of the derivatives, and by the mean-value form κ₁(centre) + ∇κ₁(box)·(box − centre), which converges
//! quadratically. Maxima on edges and in corners are met because box corners are sampled, too.

use std::collections::BinaryHeap;

use super::interval::{Dual, Interval};
use super::net::Net;
use super::patch::Patch;
use crate::geom::Point3;

/// The most concave place of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Concavity {
    /// κ₁ found there, 1/mm (negative or zero where nothing is concave).
    pub curvature: f64,
    /// Proven upper bound of κ₁ over the whole surface, 1/mm.
    pub bound: f64,
    /// Net parameters of the place.
    pub at: [f64; 2],
    /// The place, mm.
    pub point: Point3,
}

impl Concavity {
    /// The smallest concave radius found, mm; `None` where nothing is concave.
    #[must_use]
    pub fn radius(&self) -> Option<f64> {
        (self.curvature > 0.0).then(|| 1.0 / self.curvature)
    }
    /// A radius that is proven to fit everywhere, mm; infinite where the surface is proven nowhere concave.
    #[must_use]
    pub fn proven_radius(&self) -> f64 {
        if self.bound > 0.0 { 1.0 / self.bound } else { f64::INFINITY }
    }
}

/// Boxes that may be examined before the search ends with the bound reached so far.
const MOST_BOXES: usize = 400_000;

#[derive(Debug, Clone, Copy, PartialEq)]
struct ParameterBox {
    bound: f64,
    patch: usize,
    u: (f64, f64),
    v: (f64, f64),
}
impl Eq for ParameterBox {}
impl PartialOrd for ParameterBox {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for ParameterBox {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        let place = |b: &Self| (b.patch, b.u.0.to_bits(), b.v.0.to_bits());
        self.bound.total_cmp(&other.bound).then_with(|| place(other).cmp(&place(self)))
    }
}

/// The most concave place of `net`: the smallest concave radius lies within `accuracy` mm of the proven one
/// (unless the search needs more than its limit of boxes, which the gap between `curvature` and `bound` then
/// shows).
#[must_use]
pub fn most_concave(net: &Net, accuracy: f64) -> Concavity {
    let mut search = Search::new(net);
    for patch in 0..net.patches().len() {
        search.examine(patch, (0.0, 1.0), (0.0, 1.0), f64::INFINITY);
    }
    while let Some(top) = search.queue.pop() {
        search.best.bound = top.bound.max(search.best.curvature);
        if close_enough(&search.best, accuracy) || search.examined > MOST_BOXES {
            return search.best;
        }
        let middle = |t: (f64, f64)| 0.5 * (t.0 + t.1);
        let (mu, mv) = (middle(top.u), middle(top.v));
        for u in [(top.u.0, mu), (mu, top.u.1)] {
            for v in [(top.v.0, mv), (mv, top.v.1)] {
                search.examine(top.patch, u, v, top.bound);
            }
        }
    }
    search.best.bound = search.best.curvature;
    search.best
}

/// Whether found and proven radius agree to `accuracy` (or the bound says that nothing is concave).
fn close_enough(best: &Concavity, accuracy: f64) -> bool {
    // Radii above 1 km are flat for every purpose here.
    const FLAT: f64 = 1e-6;
    if best.bound <= FLAT {
        return true;
    }
    best.curvature > 0.0 && 1.0 / best.curvature - 1.0 / best.bound <= accuracy
}

struct Search<'a> {
    net: &'a Net,
    derivatives: Vec<Derivatives>,
    queue: BinaryHeap<ParameterBox>,
    best: Concavity,
    examined: usize,
}

impl<'a> Search<'a> {
    fn new(net: &'a Net) -> Self {
        let start = net.jet(0.0, 0.0).p;
        let best =
            Concavity { curvature: f64::NEG_INFINITY, bound: f64::INFINITY, at: [0.0, 0.0], point: start };
        let derivatives = net.patches().iter().map(Derivatives::new).collect();
        Search { net, derivatives, queue: BinaryHeap::new(), best, examined: 0 }
    }
    fn examine(&mut self, index: usize, u: (f64, f64), v: (f64, f64), parent: f64) {
        self.examined += 1;
        let patch = &self.net.patches()[index];
        let centre = (0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1));
        for (s, t) in [centre, (u.0, v.0), (u.0, v.1), (u.1, v.0), (u.1, v.1)] {
            self.sample(index, patch, s, t);
        }
        match enclose(&self.derivatives[index], patch, u, v) {
            Enclosure::Below(bound) => {
                let bound = bound.min(parent);
                if bound > self.best.curvature {
                    self.queue.push(ParameterBox { bound, patch: index, u, v });
                }
            }
            Enclosure::Elsewhere => {}
            Enclosure::OnEdge(u, v) => self.examine(index, u, v, parent),
        }
    }
    fn sample(&mut self, index: usize, patch: &Patch, u: f64, v: f64) {
        let jet = patch.jet(u, v);
        let Some(principal) = jet.principal() else { return };
        if principal.max > self.best.curvature {
            let columns = self.net.size()[1];
            let (row, column) = (index / columns, index % columns);
            self.best.curvature = principal.max;
            self.best.at = [crate::math::count(row) + u, crate::math::count(column) + v];
            self.best.point = jet.p;
        }
    }
}

/// What is known of κ₁ over a box.
enum Enclosure {
    /// It is at most this; infinite where the normal may vanish.
    Below(f64),
    /// It is larger in a neighbouring box of the same patch.
    Elsewhere,
    /// Its maximum over the box lies on the edge of the patch that this smaller box is.
    OnEdge((f64, f64), (f64, f64)),
}

fn enclose(derivatives: &Derivatives, patch: &Patch, u: (f64, f64), v: (f64, f64)) -> Enclosure {
    let Some(k) = curvature(derivatives, u, v) else { return Enclosure::Below(f64::INFINITY) };
    match (uphill(k.u, u), uphill(k.v, v)) {
        (Uphill::Inside, _) | (_, Uphill::Inside) => return Enclosure::Elsewhere,
        (Uphill::Edge(t), _) => return Enclosure::OnEdge((t, t), v),
        (_, Uphill::Edge(t)) => return Enclosure::OnEdge(u, (t, t)),
        (Uphill::Unknown, Uphill::Unknown) => {}
    }
    let half = |t: (f64, f64)| Interval { lo: -0.5 * (t.1 - t.0), hi: 0.5 * (t.1 - t.0) };
    let centre = patch.jet(0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1)).principal();
    let centre = Interval::point(centre.map_or(f64::INFINITY, |p| p.max));
    let mean_value = centre + k.u * half(u) + k.v * half(v);
    let bound = k.value.hi.min(mean_value.hi);
    Enclosure::Below(if bound.is_nan() { f64::INFINITY } else { bound })
}

/// Where a function of known slope grows over a parameter interval.
enum Uphill {
    /// The slope's sign is not settled (or the interval is a point).
    Unknown,
    /// Towards a neighbouring box.
    Inside,
    /// Towards the patch's edge at this parameter.
    Edge(f64),
}

fn uphill(slope: Interval, t: (f64, f64)) -> Uphill {
    let end = match slope {
        _ if t.0 >= t.1 => return Uphill::Unknown,
        s if s.lo > 0.0 => t.1,
        s if s.hi < 0.0 => t.0,
        _ => return Uphill::Unknown,
    };
    if end <= 0.0 || end >= 1.0 { Uphill::Edge(end) } else { Uphill::Inside }
}

type Triple = [Dual; 3];

fn dot(a: &Triple, b: &Triple) -> Dual {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &Triple, b: &Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// κ₁ with its gradient over a box. `None` when the direction of the normal is not settled.
fn curvature(derivatives: &Derivatives, u: (f64, f64), v: (f64, f64)) -> Option<Dual> {
    let [ru, rv, ruu, ruv, rvv] = derivatives.over(u, v);
    let w = cross(&ru, &rv);
    let up = match w[2].value {
        z if z.lo > 0.0 => 1.0,
        z if z.hi < 0.0 => -1.0,
        _ => return None,
    };
    let [g11, g12, g22] = [dot(&ru, &ru), dot(&ru, &rv), dot(&rv, &rv)];
    let second = |r: &Triple| dot(r, &w).scale(up);
    let [d11, d12, d22] = [second(&ruu), second(&ruv), second(&rvv)];
    let a = w[0].square() + w[1].square() + w[2].square();
    let b = (g11 * d22 + g22 * d11).scale(0.5) - g12 * d12;
    let c = d11 * d22 - d12 * d12;
    let root = (b.square() - a * c).sqrt();
    Some((b + root) * (a * a.sqrt()).recip())
}

/// A patch's homogeneous derivatives to third order.
#[derive(Debug, Clone)]
pub(super) struct Derivatives {
    /// h, h_u, h_v, h_uu, h_uv, h_vv, h_uuu, h_uuv, h_uvv, h_vvv.
    orders: [Patch; 10],
    rational: bool,
}

impl Derivatives {
    pub(super) fn new(patch: &Patch) -> Self {
        let [hu, hv] = [patch.hodograph(0), patch.hodograph(1)];
        let [huu, huv, hvv] = [hu.hodograph(0), hu.hodograph(1), hv.hodograph(1)];
        let third = [huu.hodograph(0), huu.hodograph(1), hvv.hodograph(0), hvv.hodograph(1)];
        let [huuu, huuv, huvv, hvvv] = third;
        let orders = [patch.clone(), hu, hv, huu, huv, hvv, huuu, huuv, huvv, hvvv];
        Derivatives { orders, rational: patch.is_rational() }
    }
    /// Enclosures of r_u, r_v, r_uu, r_uv, r_vv over a box.
    pub(super) fn boxes(&self, u: (f64, f64), v: (f64, f64)) -> [[Interval; 3]; 5] {
        if self.rational {
            return self.over(u, v).map(|triple| triple.map(|d| d.value));
        }
        core::array::from_fn(|d| {
            let [x, y, z, _] = hulls(&self.orders[d + 1].restrict(u, v));
            [x, y, z]
        })
    }
    /// r_u, r_v, r_uu, r_uv, r_vv with their gradients over a box.
    fn over(&self, u: (f64, f64), v: (f64, f64)) -> [Triple; 5] {
        // Each derivative's own u and v derivatives, by index into `orders`.
        const CHAIN: [[usize; 3]; 6] = [[0, 1, 2], [1, 3, 4], [2, 4, 5], [3, 6, 7], [4, 7, 8], [5, 8, 9]];
        let hulls: [[Interval; 4]; 10] = core::array::from_fn(|d| hulls(&self.orders[d].restrict(u, v)));
        let at =
            |i: usize| CHAIN.map(|[d, du, dv]| Dual { value: hulls[d][i], u: hulls[du][i], v: hulls[dv][i] });
        let parts = [at(0), at(1), at(2)];
        if self.rational {
            return project(&parts, &at(3));
        }
        core::array::from_fn(|d| [parts[0][d + 1], parts[1][d + 1], parts[2][d + 1]])
    }
}

/// Derivatives of the projection, as in the rational quotient rule.
fn project(parts: &[[Dual; 6]; 3], w: &[Dual; 6]) -> [Triple; 5] {
    let inverse = w[0].recip();
    let of = |h: &[Dual; 6]| {
        let p = h[0] * inverse;
        let u = (h[1] - p * w[1]) * inverse;
        let v = (h[2] - p * w[2]) * inverse;
        let uu = (h[3] - (u * w[1]).scale(2.0) - p * w[3]) * inverse;
        let uv = (h[4] - u * w[2] - v * w[1] - p * w[4]) * inverse;
        let vv = (h[5] - (v * w[2]).scale(2.0) - p * w[5]) * inverse;
        [u, v, uu, uv, vv]
    };
    let [x, y, z] = [of(&parts[0]), of(&parts[1]), of(&parts[2])];
    core::array::from_fn(|d| [x[d], y[d], z[d]])
}

/// The hulls of the four homogeneous coordinates of the poles.
pub(super) fn hulls(patch: &Patch) -> [Interval; 4] {
    let mut poles = patch.homogeneous().iter();
    let first = poles.next().map_or([0.0; 4], |h| [h.x, h.y, h.z, h.w]);
    let hull = poles.fold(first.map(Interval::point), |acc, h| {
        core::array::from_fn(|i| acc[i].union(Interval::point(h[i])))
    });
    // Subdivision is a few convex combinations a degree, each good to one unit in the last place.
    hull.map(|i| i.slackened(64.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn net(points: &[[f64; 3]]) -> Net {
        let poles: Vec<Point3> = points.iter().map(|p| Point3::new(p[0], p[1], p[2])).collect();
        Net::new(4, 4, &poles, None).expect("a net")
    }
    fn graph(x: [f64; 4], y: [f64; 4], z: [[f64; 4]; 4]) -> Net {
        let points: Vec<[f64; 3]> = (0..16).map(|k| [x[k / 4], y[k % 4], z[k / 4][k % 4]]).collect();
        net(&points)
    }

    #[test]
    fn a_corner_maximum_of_pure_twist_is_exact() {
        let z = [[0.0; 4], [0.0, -52.0, -46.0, 0.0], [0.0, -44.0, -56.0, 0.0], [0.0; 4]];
        let cavity = graph([0.0, 20.0, 40.0, 60.0], [0.0, 16.0, 32.0, 48.0], z);
        let found = most_concave(&cavity, 1e-9);
        // At the corner (1, 1) the surface is a pure twist: κ₁ = 9·56/(60·48).
        assert!((found.curvature - 0.175).abs() < 1e-12, "{found:?}");
        assert!(found.radius().expect("concave") - found.proven_radius() <= 1e-9, "{found:?}");
    }

    #[test]
    fn an_edge_maximum_is_found_and_proven() {
        let wave = net(&[
            [0.0, 0.0, 0.0],
            [3.0, 18.0, 12.0],
            [5.0, 33.0, -8.0],
            [2.0, 48.0, 3.0],
            [20.0, -2.0, 10.0],
            [24.0, 17.0, -24.0],
            [18.0, 35.0, 26.0],
            [21.0, 49.0, -8.0],
            [42.0, 2.0, -8.0],
            [37.0, 15.0, 28.0],
            [43.0, 34.0, -22.0],
            [40.0, 46.0, 12.0],
            [60.0, 0.0, 3.0],
            [62.0, 18.0, -8.0],
            [64.0, 31.0, 12.0],
            [59.0, 49.0, 0.0],
        ]);
        let found = most_concave(&wave, 1e-9);
        assert!((found.curvature - 0.111_746_587_560_5).abs() < 1e-12, "{found:?}");
        assert!((found.at[1] - 0.913_986).abs() < 1e-5 && found.at[0].abs() < 1e-9, "{found:?}");
        assert!(found.radius().expect("concave") - found.proven_radius() <= 1e-9, "{found:?}");
    }

    #[test]
    fn a_tighter_accuracy_gives_a_tighter_bound() {
        let z = [[0.0, 4.0, 4.0, 0.0], [4.0, 16.0, 16.0, 4.0], [4.0, 16.0, 16.0, 4.0], [0.0, 4.0, 4.0, 0.0]];
        let dome = graph([0.0, 20.0, 40.0, 60.0], [0.0, 20.0, 40.0, 60.0], z);
        let gap = |accuracy: f64| {
            let found = most_concave(&dome, accuracy);
            found.radius().expect("concave") - found.proven_radius()
        };
        assert!(gap(1e-9) <= 1e-9 && gap(1e-3) <= 1e-3);
        let found = most_concave(&dome, 1e-9);
        assert!((found.curvature - 0.011_879_635_168_5).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_plane_is_nowhere_concave() {
        let flat = graph([0.0, 20.0, 40.0, 60.0], [0.0, 20.0, 40.0, 60.0], [[3.0; 4]; 4]);
        let found = most_concave(&flat, 1e-9);
        assert!(found.bound <= 1e-6, "{found:?}");
    }
}
