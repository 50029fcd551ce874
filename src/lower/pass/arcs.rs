//! Passes in a plane of Z and X or of Y and Z by arcs and lines.
//!
//! Of the arcs between two places those that pass through the band at a station between have a curvature in an interval:
//! its ends belong to the arcs through the ends of the station's gate. So whether any arc from one place to another stays in
//! the band is told by the intervals of all stations between, and the arcs that reach farthest, from every one of a few
//! distances off the track to every other, layer by layer, make a chain of few blocks. Arcs on the grid are checked by
//! their true distance from the surface; where one fails, a narrower band is tried.

use super::vertex::Vertex;
use super::{Chain, Chart, Form, Step, Task};
use crate::cl::Circle;
use crate::geom::surface::cutter::bent::Way;
use crate::geom::surface::{Contact, Guide};
use crate::geom::{Point2, Point3, Vec2, Vec3, cross};
use crate::lower::arc::{Legal, centre_per_linear, legalise};
use crate::lower::circle::{self, Helix};
use crate::target::{Capabilities, GridArc, Plane};

/// Parts of the band, on either side, that are left to rounding: tried in this order, steps of the grid.
const MARGINS: [f64; 4] = [0.4, 0.8, 1.6, 3.2];
/// Margins are no more than this share of the band.
const WIDEST: f64 = 0.3;
/// Places across the band where arcs may end, as shares of it.
const LEVELS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Stations nearer to an end than this say nothing, steps of the grid.
const BLIND: f64 = 4.0;
/// Places tried before the farthest one, where rounding spoils that.
const BACK: usize = 6;

/// The plane of a pass that keeps x or y, if it does.
pub(super) fn plane_of(guide: &Guide) -> Option<Plane> {
    super::axis_of(guide).map(|axis| if axis == 0 { Plane::Zx } else { Plane::Yz })
}

/// The chain of lines and arcs of a pass with the fewest blocks that was found.
pub(super) fn chain(
    task: &Task<'_>,
    chart: &Chart,
    (head, tail): (Vertex, Vertex),
    capabilities: &Capabilities,
) -> Option<Chain> {
    let plane = plane_of(&task.track.guide)?;
    MARGINS.iter().find_map(|steps| {
        let margin = (steps * task.lattice.step).min(WIDEST * (task.high - task.low));
        Fitter::new(task, chart, (plane, capabilities), margin).chain(head, tail)
    })
}

struct Fitter<'a> {
    task: &'a Task<'a>,
    chart: &'a Chart,
    plane: Plane,
    capabilities: &'a Capabilities,
    /// Range of the distance from the track that vertices may have, mm.
    range: (f64, f64),
    /// Ends of the gates at the stations: place along the pass, and height.
    gates: Vec<[Point2; 2]>,
}

/// A place that a chain of arcs reaches.
struct Node {
    station: usize,
    vertex: Vertex,
    parent: usize,
}

/// An interval of curvatures, 1/mm; positive where the arc lies to the left of its chord.
type Curvatures = (f64, f64);

impl<'a> Fitter<'a> {
    fn new(
        task: &'a Task<'a>,
        chart: &'a Chart,
        (plane, capabilities): (Plane, &'a Capabilities),
        margin: f64,
    ) -> Fitter<'a> {
        let range = (task.low + margin, task.high - margin);
        let mut fitter = Fitter { task, chart, plane, capabilities, range, gates: Vec::new() };
        fitter.gates = (0..chart.len())
            .map(|i| {
                let contact = chart.contact(i);
                let (low, high) = chart.gate(i, range);
                [low, high].map(|off| fitter.flat(fitter.off(&contact, off)))
            })
            .collect();
        fitter
    }

    /// The centre in the pass's plane that is so far off the surface.
    fn off(&self, contact: &Contact, off: f64) -> Point3 {
        let n = self.task.lattice.sideways(contact.normal);
        contact.centre + n * (off / n.dot(&contact.normal).max(0.05))
    }

    /// A centre as place along the pass and height.
    fn flat(&self, p: Point3) -> Point2 {
        Point2::new(p[self.along()], p.z)
    }

    /// The axis along which the pass runs.
    fn along(&self) -> usize {
        if self.plane == Plane::Zx { 0 } else { 1 }
    }

    fn chain(&self, head: Vertex, tail: Vertex) -> Option<Chain> {
        let mut out = vec![Step { to: head.steps, form: Form::Line }];
        let mut start = head;
        let pieces = self.chart.pieces();
        for (k, piece) in pieces.iter().enumerate() {
            let end = match k + 1 == pieces.len() {
                true => tail,
                false => self.vertex(piece.1, 0.5 * (self.range.0 + self.range.1))?,
            };
            self.piece(*piece, (start, end), &mut out)?;
            start = end;
        }
        Some(out)
    }

    /// Along a smooth piece.
    fn piece(
        &self,
        (first, last): (usize, usize),
        (start, end): (Vertex, Vertex),
        out: &mut Chain,
    ) -> Option<()> {
        let mut nodes = vec![Node { station: first, vertex: start, parent: usize::MAX }];
        let mut layer = vec![0];
        let found = loop {
            let done = layer.iter().copied().find(|n: &usize| {
                let node = &nodes[*n];
                self.curvatures((node.station, &node.vertex), (last, &end)).is_some()
            });
            if let Some(done) = done {
                break done;
            }
            layer = self.next(&mut nodes, &layer, last);
            if layer.is_empty() {
                return None;
            }
        };
        let mut path = vec![(last, end)];
        let mut at = found;
        while at != usize::MAX {
            path.push((nodes[at].station, nodes[at].vertex));
            at = nodes[at].parent;
        }
        path.reverse();
        for ends in path.windows(2) {
            let [(i, from), (j, to)] = ends else { return None };
            if from.steps == to.steps {
                continue;
            }
            let curvatures = self.curvatures((*i, from), (*j, to))?;
            self.primitive(from, to, curvatures, out)?;
        }
        Some(())
    }

    /// The places that are reached by one more arc: of those at the same distance off the track the farthest.
    fn next(&self, nodes: &mut Vec<Node>, layer: &[usize], last: usize) -> Vec<usize> {
        let mut best: [Option<Node>; LEVELS.len()] = core::array::from_fn(|_| None);
        for &parent in layer {
            let mut stride = 8;
            for (level, best) in LEVELS.iter().zip(&mut best) {
                let off = self.range.0 + (self.range.1 - self.range.0) * level;
                let node = &nodes[parent];
                let Some((station, vertex)) = self.farthest(node, off, last, &mut stride) else { continue };
                if best.as_ref().is_none_or(|b| station > b.station) {
                    *best = Some(Node { station, vertex, parent });
                }
            }
        }
        let first = nodes.len();
        nodes.extend(best.into_iter().flatten());
        (first..nodes.len()).collect()
    }

    /// The farthest station before `last` that an arc reaches so far off the track; `stride`: how far it is about.
    fn farthest(&self, from: &Node, off: f64, last: usize, stride: &mut usize) -> Option<(usize, Vertex)> {
        let reaches = |j: usize| {
            let to = self.flat(self.off(&self.chart.contact(j), off));
            self.interval((from.station, self.flat(from.vertex.centre)), (j, to)).is_some()
        };
        if from.station + 1 >= last {
            return None;
        }
        let near = super::reached((from.station, last), *stride, reaches);
        *stride = (near - from.station) * 3 / 4;
        let back = ((near - from.station) / 50).max(1);
        (0..BACK).map_while(|k| near.checked_sub(k * back).filter(|j| *j > from.station)).find_map(|j| {
            let vertex = self.vertex(j, off)?;
            let held = vertex.steps != from.vertex.steps
                && self.curvatures((from.station, &from.vertex), (j, &vertex)).is_some();
            held.then_some((j, vertex))
        })
    }

    fn vertex(&self, station: usize, off: f64) -> Option<Vertex> {
        let range = (self.task.low, self.task.high);
        let (contact, lattice) = (self.chart.contact(station), &self.task.lattice);
        lattice.vertex(&contact, off, range, lattice.sideways(contact.normal))
    }

    fn curvatures(&self, (i, p): (usize, &Vertex), (j, q): (usize, &Vertex)) -> Option<Curvatures> {
        self.interval((i, self.flat(p.centre)), (j, self.flat(q.centre)))
    }

    /// The curvatures of the arcs from `p`, at station `i`, to `q`, at station `j`, that stay in the band at all stations
    /// between; `None` where there is none.
    fn interval(&self, (i, p): (usize, Point2), (j, q): (usize, Point2)) -> Option<Curvatures> {
        let blind = BLIND * self.task.lattice.step;
        let mut all = (f64::NEG_INFINITY, f64::INFINITY);
        for gate in self.gates.get(i + 1..j).unwrap_or_default() {
            let near = (gate[0] - p).norm_squared().min((gate[0] - q).norm_squared());
            if near < blind * blind {
                continue;
            }
            let [a, b] = [curvature(p, q, gate[0])?, curvature(p, q, gate[1])?];
            all = (all.0.max(a.min(b)), all.1.min(a.max(b)));
            if all.0 > all.1 {
                return None;
            }
        }
        Some(all)
    }

    /// The line, or the arc of middling curvature, between two vertices.
    fn primitive(&self, from: &Vertex, to: &Vertex, (low, high): Curvatures, out: &mut Chain) -> Option<()> {
        let straight = low <= 0.0 && high >= 0.0 && self.task.holds(from, to.steps);
        if straight {
            out.push(Step { to: to.steps, form: Form::Line });
            return Some(());
        }
        let curvature = 0.5 * (low + high);
        if !(curvature.is_finite() && curvature != 0.0) {
            return None;
        }
        let arc = self.grid_arc(from, to, curvature)?;
        let mut at = *from;
        for part in legalise(arc, self.plane, self.capabilities).ok()? {
            let (step, held) = match part {
                Legal::Line(end) => {
                    let to = self.placed(end, from);
                    (Step { to, form: Form::Line }, self.task.holds(&at, to))
                }
                Legal::Arc(arc) => {
                    let to = self.placed(arc.to, from);
                    let step = Step { to, form: Form::Arc(self.plane, arc.centre, arc.clockwise) };
                    (step, self.follows(&at, &arc, to))
                }
            };
            if !held {
                return None;
            }
            at = Vertex { steps: step.to, centre: self.task.lattice.centre(step.to), ..at };
            out.push(step);
        }
        Some(())
    }

    /// The arc on the grid.
    fn grid_arc(&self, from: &Vertex, to: &Vertex, curvature: f64) -> Option<GridArc> {
        let grid = &self.capabilities.grid;
        let [first, second, _] = self.plane.axes();
        let (p, q) = (self.flat(from.centre), self.flat(to.centre));
        let chord = q - p;
        let (half, radius) = (0.5 * chord.norm(), 1.0 / curvature.abs());
        let height = (radius * radius - half * half).max(0.0).sqrt() * curvature.signum();
        let across = Vec2::new(chord.y, -chord.x) / chord.norm();
        let hub = p + chord * 0.5 + across * height;
        // As the plane sees it, with the tip for the centre.
        let tip = hub.y - (from.centre.z - from.steps[2] as f64 * self.task.lattice.step);
        let swapped = self.plane == Plane::Zx;
        let hub = if swapped { Point2::new(tip, hub.x) } else { Point2::new(hub.x, tip) };
        let flat = |v: &Vertex| [v.steps[first], v.steps[second]];
        let scale = centre_per_linear(self.capabilities);
        let (start, to) = (flat(from), flat(to));
        let centre = circle::centre(start, to, hub / grid.centre_step(), scale)?;
        let arc = GridArc { start, to, centre, clockwise: (curvature > 0.0) != swapped };
        let (r0, r1) = arc.radii(scale);
        ((r0 - r1).abs() * grid.centre_step() <= self.capabilities.radius_tolerance).then_some(arc)
    }

    /// A place of the plane, as vertices of the pass have it.
    fn placed(&self, end: [i64; 2], like: &Vertex) -> [i64; 3] {
        let [first, second, _] = self.plane.axes();
        let mut steps = like.steps;
        (steps[first], steps[second]) = (end[0], end[1]);
        steps
    }

    /// Whether an arc, as a control draws it, stays in the band.
    fn follows(&self, from: &Vertex, arc: &GridArc, to: [i64; 3]) -> bool {
        let step = self.capabilities.grid.centre_step();
        let [first, second, third] = self.plane.axes();
        let (mut centre, mut axis) = (from.centre, Vec3::zeros());
        let scale = centre_per_linear(self.capabilities);
        let hub = if self.capabilities.by_middle(self.plane) {
            let Some(hub) = arc.centre_by_middle(scale) else { return false };
            hub.map(|c| c * self.task.lattice.step)
        } else {
            arc.centre.map(|c| c as f64 * step)
        };
        centre[first] += hub[0];
        centre[second] += hub[1];
        axis[third] = if arc.clockwise { -1.0 } else { 1.0 };
        let circle = Circle { to: self.task.lattice.centre(to), centre, axis, turns: 0, tolerance: 0.0 };
        Helix::new(from.centre, &circle).is_some_and(|helix| {
            let way = Way { at: &|x| helix.at(x), bend: helix.bend() };
            self.task.follows(&way, &from.foot)
        })
    }
}

/// Signed curvature of the arc from `p` to `q` through `x`: positive where `x` is to the left of the chord; `None` where it
/// is more than half a circle.
fn curvature(p: Point2, q: Point2, x: Point2) -> Option<f64> {
    let (a, b, chord) = (x - p, q - x, q - p);
    let size = a.norm() * b.norm() * chord.norm();
    (size > 0.0 && a.dot(&b) > 0.0).then(|| 2.0 * cross(chord, a) / size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curvatures_are_those_of_circles() {
        let (p, q) = (Point2::new(-3.0, 4.0), Point2::new(3.0, 4.0));
        let top = curvature(p, q, Point2::new(0.0, 5.0)).expect("an arc");
        assert!((top - 0.2).abs() < 1e-15, "{top}");
        let below = curvature(p, q, Point2::new(0.0, 3.0)).expect("an arc");
        assert!((below + 0.2).abs() < 1e-15, "{below}");
        assert_eq!(curvature(p, q, Point2::new(0.0, -5.0)), None);
    }
}
