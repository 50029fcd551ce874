//! Forward search over grid vertices: from layer to layer the few vertices whose next link reaches farthest.
//!
//! From a vertex the visible part of the tube ends at a window; the farthest line from anywhere on that window (the
//! *aim*) shows where the next vertex should be. Grid points of the visible part are ranked by their distance from the
//! aim on its harmless side: at the tip of the view on convex stretches, anywhere along the window at inflections.

use super::tube::Gates;
use super::window::{Bank, Course, Exit, Stab, View, look};
use crate::geom::{Vec2, cross};

/// How much is tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Vertices kept in a layer.
    pub beam: usize,
    /// Grid points tried for each of them.
    pub tries: usize,
    /// Grid columns looked at in either direction once there are points enough: few will do on a grid that is much finer than
    /// what is asked for.
    pub columns: u32,
    /// Also those that cannot see as far as the best do: where the grid is coarse they may be the only way on.
    pub all: bool,
}

/// Grid columns looked at for one vertex when nothing has been found yet.
const COLUMNS: u32 = 20_000;
/// Grid columns looked at when something has been found, on the grid of a control.
pub const WIDE: u32 = 256;
/// Columns next to the first that are looked at one by one; farther out they are skipped in proportion to the distance.
const DENSE: f64 = 128.0;
/// Grid points of one vertex's view that are tried where nothing leads on: in corners few of them do.
const THOROUGH: usize = 2048;
/// Of these in one column.
const ACROSS: f64 = 16.0;
/// Columns of these looked at one by one.
const CLOSE: f64 = 16.0;
/// Vertices kept of those.
const KEPT: usize = 16;
/// Layers without progress before the search gives up.
const PATIENCE: u32 = 3;

/// A vertex and its next gate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Grid coordinates.
    pub at: [i64; 2],
    /// First gate after it.
    pub next: usize,
}

impl Vertex {
    /// As real coordinates.
    #[must_use]
    pub fn point(&self) -> Vec2 {
        Vec2::new(self.at[0] as f64, self.at[1] as f64)
    }
}

/// Where the search could not go on: near this gate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stuck {
    /// Gate that no vertex could pass.
    pub gate: usize,
}

struct Node {
    vertex: Vertex,
    view: View,
    parent: usize,
}

/// When the search is over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// A vertex sees the course's target: the answer is the chain up to that vertex.
    Target,
    /// All vertices of a layer lie beyond this gate: the answers are those vertices, best first.
    Beyond(usize),
}

/// The search.
#[derive(Debug, Default)]
pub struct Search {
    stab: Stab,
    found: Vec<(f64, [i64; 2])>,
    /// Layers after which a search has lost its way.
    most: usize,
    /// The aim from the best vertex of the layer; vertices whose view stops at the same gate have it too, nearly.
    aim: Option<(Exit, usize, View)>,
    /// Gates looked at so far: the measure of the work done.
    pub work: usize,
}

impl Search {
    /// A search in a tube where about `links` links are needed.
    #[must_use]
    pub fn new(links: u32) -> Search {
        Search { most: 2 * links as usize + 32, ..Search::default() }
    }

    /// Runs from the roots to the goal.
    ///
    /// # Errors
    /// [`Stuck`] when no grid vertex leads on.
    pub fn run(
        &mut self,
        course: &Course,
        roots: &[Vertex],
        goal: Goal,
        effort: Effort,
    ) -> Result<Vec<Vertex>, Stuck> {
        let mut nodes: Vec<Node> = roots.iter().map(|v| node(course, *v, usize::MAX)).collect();
        let mut layer: Vec<usize> = (0..nodes.len()).collect();
        let (mut best, mut idle, mut lost) = (-1.0_f64, 0, false);
        for _ in 0..self.most {
            layer.sort_by(|a, b| nodes[*b].view.reach.total_cmp(&nodes[*a].view.reach).then(a.cmp(b)));
            layer.truncate(if lost { KEPT } else { effort.beam });
            let Some(first) = layer.first().map(|i| &nodes[*i]) else {
                return Err(Stuck { gate: best.max(0.0) as usize });
            };
            if let Some(answer) = finished(&nodes, &layer, goal) {
                return Ok(answer);
            }
            idle = if first.view.reach > best { 0 } else { idle + 1 };
            best = best.max(first.view.reach);
            if idle >= PATIENCE {
                return Err(Stuck { gate: best.max(0.0) as usize });
            }
            let next = self.expand(course, &mut nodes, &layer, effort);
            lost = next.is_empty() || idle > 0;
            layer = if lost { self.thorough(course, &mut nodes, &layer) } else { next };
        }
        Err(Stuck { gate: best.max(0.0) as usize })
    }

    /// The next layer.
    fn expand(
        &mut self,
        course: &Course,
        nodes: &mut Vec<Node>,
        layer: &[usize],
        effort: Effort,
    ) -> Vec<usize> {
        let mut next: Vec<usize> = Vec::new();
        self.aim = None;
        for &parent in layer {
            let (vertex, view) = (nodes[parent].vertex, nodes[parent].view);
            self.candidates(course, &vertex, &view, effort);
            for k in 0..self.found.len() {
                let at = self.found[k].1;
                if next.iter().any(|i| nodes[*i].vertex.at == at) {
                    continue;
                }
                if let Some(vertex) = place(course, at, &vertex, &view) {
                    next.push(nodes.len());
                    nodes.push(node(course, vertex, parent));
                    self.work += nodes[nodes.len() - 1].view.stop - vertex.next;
                }
            }
        }
        next
    }

    /// The next layer when nothing else leads on: those of all grid points in view that see farthest themselves.
    fn thorough(&mut self, course: &Course, nodes: &mut Vec<Node>, layer: &[usize]) -> Vec<usize> {
        let mut next: Vec<Node> = Vec::new();
        for &parent in layer {
            let (vertex, view) = (nodes[parent].vertex, nodes[parent].view);
            let points = Scan::new(course, &vertex, &view, &view).all();
            let legal = points.into_iter().filter_map(|at| place(course, at, &vertex, &view));
            let fresh: Vec<Node> = legal.filter(|v| *v != vertex).map(|v| node(course, v, parent)).collect();
            self.work += fresh.iter().map(|n| n.view.stop - n.vertex.next).sum::<usize>();
            next.extend(fresh);
            next.sort_by(|a, b| b.view.reach.total_cmp(&a.view.reach).then(a.vertex.at.cmp(&b.vertex.at)));
            next.dedup_by_key(|n| n.vertex.at);
            next.truncate(KEPT);
        }
        let first = nodes.len();
        nodes.extend(next);
        (first..nodes.len()).collect()
    }

    /// Grid points of the view, best first, into `self.found`.
    fn candidates(&mut self, course: &Course, from: &Vertex, view: &View, effort: Effort) {
        self.found.clear();
        let Some(window) = view.window(course) else { return };
        let aim = match self.aim {
            Some((exit, stop, aim)) if exit == view.exit && stop == view.stop && !effort.all => aim,
            _ => {
                let aim = self.stab.view(course, &window);
                self.work += aim.stop - window.after.min(aim.stop);
                aim
            }
        };
        self.aim.get_or_insert((view.exit, view.stop, aim));
        let scan = Scan::new(course, from, view, &aim);
        scan.run(effort, &mut self.found);
        if self.found.is_empty() || effort.all {
            let mut either = Vec::new();
            Scan { either: true, ..scan }.run(effort, &mut either);
            self.found.extend(either);
        }
    }
}

fn node(course: &Course, vertex: Vertex, parent: usize) -> Node {
    Node { vertex, view: look(course, vertex.point(), vertex.next), parent }
}

/// The goal's answer, if the layer has reached it.
fn finished(nodes: &[Node], layer: &[usize], goal: Goal) -> Option<Vec<Vertex>> {
    match goal {
        Goal::Target => {
            let mut at = *layer.iter().find(|i| nodes[**i].view.exit == Exit::End)?;
            let mut chain = vec![nodes[at].vertex];
            while nodes[at].parent != usize::MAX {
                at = nodes[at].parent;
                chain.push(nodes[at].vertex);
            }
            chain.reverse();
            Some(chain)
        }
        Goal::Beyond(gate) => {
            // a vertex that sees the end of the course is as good as one beyond the gate
            let beyond = |i: &&usize| nodes[**i].vertex.next > gate || nodes[**i].view.exit == Exit::End;
            let answer: Vec<Vertex> = layer.iter().filter(beyond).map(|i| nodes[*i].vertex).collect();
            (!answer.is_empty()).then_some(answer)
        }
    }
}

/// The next gate of a grid point seen in a view, if it lies in the tube.
fn place(course: &Course, at: [i64; 2], from: &Vertex, view: &View) -> Option<Vertex> {
    let p = Vec2::new(at[0] as f64, at[1] as f64);
    let last = (view.stop - 1).min(course.end - 1);
    let floor = from.next.saturating_sub(1);
    let gate = course.locate(p, last, floor)?;
    let (origin, d) = (from.point(), p - from.point());
    let ahead = d.dot(&(view.tip - origin)) > 0.0;
    let seen =
        cross(view.lo.1, d) >= 0.0 && cross(d, view.hi.1) >= 0.0 || course.sees(origin, from.next, p, gate);
    // what is seen past a gate and lies before the next is in the tube, but for the gate that stops the view
    let inside = gate + 1 < view.stop || {
        let (r, l) = (course.right(gate), course.left(gate));
        cross(course.right(gate + 1) - r, p - r) >= 0.0 && cross(course.left(gate + 1) - l, p - l) <= 0.0
    };
    (seen && inside && ahead).then_some(Vertex { at, next: gate + 1 })
}

/// n·p >= c.
#[derive(Debug, Clone, Copy)]
struct HalfPlane {
    n: Vec2,
    c: f64,
}

impl HalfPlane {
    fn left_of(p: Vec2, d: Vec2) -> HalfPlane {
        let d = d / d.norm().max(f64::MIN_POSITIVE);
        let n = Vec2::new(-d.y, d.x);
        HalfPlane { n, c: n.dot(&p) }
    }
    fn right_of(p: Vec2, d: Vec2) -> HalfPlane {
        HalfPlane::left_of(p, -d)
    }
    fn distance(&self, p: Vec2) -> f64 {
        self.n.dot(&p) - self.c
    }
}

/// The grid points of a view, column by column from the aim outwards.
struct Scan<'a> {
    course: &'a Course<'a>,
    from: &'a Vertex,
    view: &'a View,
    /// Bank on which the view's farthest line leaves.
    outer: Bank,
    /// Coordinate that numbers the columns.
    axis: usize,
    /// Direction of travel along it.
    sign: f64,
    wedge: [HalfPlane; 2],
    aim: HalfPlane,
    /// Points on either side of the aim will do.
    either: bool,
    /// First column: where the aim meets the window.
    start: f64,
}

impl<'a> Scan<'a> {
    fn new(course: &'a Course<'a>, from: &'a Vertex, view: &'a View, aim: &View) -> Scan<'a> {
        let p = from.point();
        let (_, far) = view.line();
        let axis = usize::from(far.x.abs() < far.y.abs());
        let outer = if view.exit == Exit::Through(Bank::Left) { Bank::Left } else { Bank::Right };
        let (q, d) = aim.line();
        let plane = match aim.exit {
            Exit::Through(Bank::Left) => HalfPlane::right_of(q, d),
            _ => HalfPlane::left_of(q, d),
        };
        let wedge = [HalfPlane::left_of(p, view.wedge.0), HalfPlane::right_of(p, view.wedge.1)];
        let start = meet(p, far, plane, view.tip)[axis];
        let either = aim.exit == Exit::End;
        Scan { course, from, view, outer, axis, sign: far[axis].signum(), wedge, aim: plane, either, start }
    }

    fn run(&self, effort: Effort, found: &mut Vec<(f64, [i64; 2])>) {
        let (back, front) = (self.from.point()[self.axis], self.view.tip[self.axis]);
        let first = self.start.clamp(back.min(front), back.max(front)).round();
        self.pass((first, -self.sign, back), effort, found);
        self.pass((first + self.sign, self.sign, front), effort, found);
    }

    /// Columns from `column` on in one direction up to `last`.
    fn pass(
        &self,
        (mut column, step, last): (f64, f64, f64),
        Effort { tries, columns, .. }: Effort,
        found: &mut Vec<(f64, [i64; 2])>,
    ) {
        let mut edge = (self.view.stop - 1).min(self.course.end - 1);
        let mut looked = 0;
        let near = column;
        while (last - column) * step >= 0.0 {
            looked += 1;
            let full = found.len() >= tries;
            if looked > if full { columns } else { COLUMNS } {
                return;
            }
            edge = self.edge(self.outer, edge, column);
            if let Some((span, ideal)) = self.column(column, edge) {
                if full && self.cost(column, ideal) > found[found.len() - 1].0 {
                    return;
                }
                self.grid_points(column, span, ideal, tries, found);
            }
            column += step * floor((column - near).abs() / DENSE).max(1.0);
        }
    }

    /// Grid points between the banks from the tip back, all of a column where there are few.
    fn all(&self) -> Vec<[i64; 2]> {
        let (back, front) = (self.from.point()[self.axis], self.view.tip[self.axis].round());
        let (mut column, mut points) = (front + self.sign, Vec::new());
        let last = (self.view.stop - 1).min(self.course.end - 1);
        let mut edges = [(Bank::Left, last), (Bank::Right, last)];
        while (column - back) * self.sign >= 0.0 && points.len() < THOROUGH {
            let mut span = (f64::NEG_INFINITY, f64::INFINITY);
            for (bank, edge) in &mut edges {
                *edge = self.edge(*bank, *edge, column);
                self.clip(&self.inside(*bank, *edge), column, &mut span);
            }
            if span.0 <= span.1 && span.0.is_finite() && span.1.is_finite() {
                let stride = floor((span.1 - span.0) / ACROSS) + 1.0;
                let mut y = -floor(-span.0);
                while y <= span.1 {
                    points.push(self.point(column, y));
                    y += stride;
                }
            }
            column -= self.sign * floor((column - front).abs() / CLOSE).max(1.0);
        }
        points
    }

    /// The inner side of a bank's edge.
    fn inside(&self, bank: Bank, edge: usize) -> HalfPlane {
        let (a, b) = (self.course.on(bank, edge), self.course.on(bank, edge + 1));
        match bank {
            Bank::Right => HalfPlane::left_of(a, b - a),
            Bank::Left => HalfPlane::right_of(a, b - a),
        }
    }

    /// The edge of a bank at a column.
    fn edge(&self, bank: Bank, mut edge: usize, column: f64) -> usize {
        let top = (self.view.stop - 1).min(self.course.end - 1);
        let floor = self.from.next.saturating_sub(1);
        let behind = |i: usize| (column - self.course.on(bank, i)[self.axis]) * self.sign < 0.0;
        while edge > floor && behind(edge) {
            edge -= 1;
        }
        while edge < top && !behind(edge + 1) {
            edge += 1;
        }
        edge
    }

    /// The part of a column that may be used, and its best point.
    fn column(&self, column: f64, edge: usize) -> Option<((f64, f64), f64)> {
        let bank = self.inside(self.outer, edge);
        let mut span = (f64::NEG_INFINITY, f64::INFINITY);
        for plane in [self.wedge[0], self.wedge[1], bank] {
            self.clip(&plane, column, &mut span);
        }
        if !self.either {
            self.clip(&self.aim, column, &mut span);
        }
        if !(span.0 <= span.1 && span.0.is_finite() && span.1.is_finite()) {
            return None;
        }
        let other = 1 - self.axis;
        let rise = self.aim.n[other];
        let zero = (self.aim.c - self.aim.n[self.axis] * column) / rise;
        let ideal = if zero.is_finite() { zero.clamp(span.0, span.1) } else { span.0 };
        Some((span, ideal))
    }

    /// The grid points of a column next to its best point.
    fn grid_points(
        &self,
        column: f64,
        span: (f64, f64),
        ideal: f64,
        tries: usize,
        found: &mut Vec<(f64, [i64; 2])>,
    ) {
        let rings = if self.either { 4 } else { 1 };
        let below = floor(ideal);
        for ring in 0..rings {
            for y in [below - f64::from(ring), below + 1.0 + f64::from(ring)] {
                if y >= span.0 && y <= span.1 {
                    insert(found, tries, self.cost(column, y), self.point(column, y));
                }
            }
        }
    }

    fn clip(&self, plane: &HalfPlane, column: f64, span: &mut (f64, f64)) {
        let other = 1 - self.axis;
        let rest = plane.c - plane.n[self.axis] * column;
        let rise = plane.n[other];
        if rise > 0.0 {
            span.0 = span.0.max(rest / rise);
        } else if rise < 0.0 {
            span.1 = span.1.min(rest / rise);
        } else if rest > 0.0 {
            span.1 = f64::NEG_INFINITY;
        }
    }

    fn cost(&self, column: f64, y: f64) -> f64 {
        let p = if self.axis == 0 { Vec2::new(column, y) } else { Vec2::new(y, column) };
        self.aim.distance(p).abs()
    }

    fn point(&self, column: f64, y: f64) -> [i64; 2] {
        if self.axis == 0 { [column as i64, y as i64] } else { [y as i64, column as i64] }
    }
}

/// The integer at or below a coordinate; coordinates fit 64 bits ([`super::tube`] sees to it).
fn floor(x: f64) -> f64 {
    let whole = x as i64 as f64;
    if whole > x { whole - 1.0 } else { whole }
}

/// Where the ray from `p` along `d` meets the line of `plane`; `or` when they do not meet.
fn meet(p: Vec2, d: Vec2, plane: HalfPlane, or: Vec2) -> Vec2 {
    let rate = plane.n.dot(&d);
    let share = -plane.distance(p) / rate;
    if share.is_finite() { p + d * share } else { or }
}

/// Keeps the `tries` cheapest.
fn insert(found: &mut Vec<(f64, [i64; 2])>, tries: usize, cost: f64, at: [i64; 2]) {
    let place = found.partition_point(|f| f.0 <= cost);
    if place < tries {
        found.truncate(tries - 1);
        found.insert(place, (cost, at));
    }
}

/// The grid point in the tube nearest to the middle of a gate, for a search to start from.
#[must_use]
pub fn seed(gates: &Gates, gate: usize) -> Option<Vertex> {
    let (l, r) = (gates.left(gate), gates.right(gate));
    let forward = gates.right(gate + 1) - r;
    let unit = forward / forward.norm().max(f64::MIN_POSITIVE);
    let course = Course { gates, end: usize::MAX, target: None };
    for along in 0..64 {
        for share in [0.5, 0.3, 0.7, 0.1, 0.9, 0.0, 1.0] {
            let p = r + (l - r) * share + unit * f64::from(along) * 0.7;
            let at = [p.x.round() as i64, p.y.round() as i64];
            let q = Vec2::new(at[0] as f64, at[1] as f64);
            let Some(g) = course.locate(q, gate + 8, gate) else { continue };
            let (r, l) = (gates.right(g), gates.left(g));
            if g < gate + 8
                && cross(gates.right(g + 1) - r, q - r) >= 0.0
                && cross(gates.left(g + 1) - l, q - l) <= 0.0
            {
                return Some(Vertex { at, next: g + 1 });
            }
        }
    }
    None
}
