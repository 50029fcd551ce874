//! What the swept ball leaves on the surface, everywhere.
//!
//! The surface is cut into cells, rectangles of its parameters. What stands on a cell is bounded from its corners: where
//! all four corners, raised by T along their normals, lie in one capsule (the ball swept along one move, a convex body),
//! the whole raised cell does but for its own sagitta ε, so that no more than T + ε/cos stays on it. Cells whose bound
//! is above what is known to be left somewhere are cut in four.

use rayon::prelude::*;

use super::Swept;
use super::moves::Worst;
use crate::cl::{Finish, Operation};
use crate::diag::codes::verification as codes;
use crate::geom::surface::{Foot, Patch, SurfaceTree};
use crate::geom::{Point3, Vec3};
use crate::verify::ACCURACY;
use crate::verify::finding::{Finding, Text};

/// What was found.
#[derive(Debug)]
pub(super) struct Cover {
    /// Most material left where the ball can reach.
    pub left: Worst,
    /// Proven bound of the same, mm.
    pub bound: f64,
    /// Highest ridge above the path's own deviation beside it, where a height of cusps was asked for.
    pub cusp: Option<Worst>,
    /// Most material left where the ball does not reach for its size.
    pub unreachable: Option<Worst>,
}

/// Tiles of a patch in each direction, checked in parallel.
const TILES: u32 = 16;
/// Moves that leave more than this times what is allowed are not looked for: what is then reported is more than allowed,
/// too.
const INTEREST: f64 = 1.5;
/// Cells of one tile at most.
const MOST_CELLS: u32 = 400_000;
/// Cells are not cut below this size, mm.
const SMALLEST: f64 = 2e-3;

/// Checks the whole surface; findings are appended.
pub(super) fn check(
    operation: &Operation,
    finish: &Finish,
    passes: &[Swept],
    findings: &mut Vec<Finding>,
) -> Cover {
    // On a convex surface the chords of a path that is off by OUTTOL leave more at their ends, by the radii' ratio.
    let bulge = (1.0 + (finish.radius + finish.leave) * most_convex(finish)).max(1.0);
    let allowed = finish.cusp.map(|h| h + operation.band.out * bulge + ACCURACY);
    let field = Field::new(operation, finish, passes, (allowed.unwrap_or(0.5), bulge));
    let tiles: Vec<(usize, u32)> = (0..finish.tree.net().patches().len())
        .flat_map(|patch| (0..TILES * TILES).map(move |tile| (patch, tile)))
        .collect();
    let found: Vec<Tile<'_>> = tiles.par_iter().map(|(patch, tile)| field.tile(*patch, *tile)).collect();
    let mut cover = Cover { left: Worst::NONE, bound: 0.0, cusp: None, unreachable: None };
    for tile in found {
        cover.left.take(tile.left);
        cover.bound = cover.bound.max(tile.bound);
        if tile.unreachable.value > 0.0 {
            cover.unreachable.get_or_insert(Worst::NONE).take(tile.unreachable);
        }
        if finish.cusp.is_some() {
            cover.cusp.get_or_insert(Worst::NONE).take(tile.cusp);
        }
    }
    cover.bound = cover.bound.max(cover.left.value);
    if let Some(allowed) = allowed.filter(|a| !(cover.bound <= *a)) {
        findings.push(too_much(operation, &cover, allowed - ACCURACY));
    }
    if let Some((cusp, h)) = cover.cusp.zip(finish.cusp).filter(|(c, h)| !(c.value <= h * (1.0 + CUSP_SLACK)))
    {
        findings.push(too_high(operation, &cusp, h));
    }
    cover
}

/// The largest convex curvature found at many places, 1/mm.
fn most_convex(finish: &Finish) -> f64 {
    const PLACES: u32 = 24;
    let patches = finish.tree.net().patches().iter();
    let at = |patch: &Patch, k: u32| {
        let [u, v] = [k / (PLACES + 1), k % (PLACES + 1)].map(|i| f64::from(i) / f64::from(PLACES));
        patch.jet(u, v).principal().map_or(0.0, |p| -p.min)
    };
    patches.flat_map(|p| (0..(PLACES + 1) * (PLACES + 1)).map(move |k| at(p, k))).fold(0.0, f64::max)
}

/// Ridges may be higher than asked for by this share: the accuracy to which the path's own deviation beside them is told.
const CUSP_SLACK: f64 = 0.005;

fn too_much(operation: &Operation, cover: &Cover, allowed: f64) -> Finding {
    let w = &cover.left;
    let text = Text::default()
        .words("up to ")
        .length(cover.bound)
        .words(" is left on the surface at ")
        .place(w.at)
        .words(format!("; cusps and OUTTOL of {} allow ", operation.name))
        .length(allowed);
    Finding::new(&codes::SURFACE_LEFT, w.line, w.block, text)
}

fn too_high(operation: &Operation, cusp: &Worst, allowed: f64) -> Finding {
    let text = Text::default()
        .words("a cusp of ")
        .length(cusp.value)
        .words(" is left at ")
        .place(cusp.at)
        .words(format!("; {} allows ", operation.name))
        .length(allowed);
    Finding::new(&codes::SURFACE_LEFT, cusp.line, cusp.block, text)
}

/// The moves by place.
struct Field<'a> {
    tree: &'a SurfaceTree,
    /// Radius of the ball, and of the ball with what it leaves, mm.
    radius: f64,
    ball: f64,
    /// Heights of no interest: half of what may be left.
    floor: f64,
    /// Heights looked at at most.
    ceiling: f64,
    /// How far the path may be off the surface.
    out: f64,
    passes: &'a [Swept],
    /// Moves whose centres pass farther beside a point leave more there than is of interest, mm.
    around: f64,
    low: [f64; 2],
    cell: f64,
    counts: [usize; 2],
    buckets: Vec<Vec<u32>>,
}

struct Tile<'a> {
    field: &'a Field<'a>,
    left: Worst,
    bound: f64,
    cusp: Worst,
    unreachable: Worst,
    cells: u32,
    near: Vec<u32>,
    patch: usize,
}

/// Parameter rectangle with its raised corners.
#[derive(Clone, Copy)]
struct Cell {
    u: (f64, f64),
    v: (f64, f64),
    depth: u32,
}

#[derive(Clone, Copy)]
struct Corner {
    p: Point3,
    n: Vec3,
    uv: [f64; 2],
}

impl<'a> Field<'a> {
    fn new(
        operation: &Operation,
        finish: &'a Finish,
        passes: &'a [Swept],
        (allowed, bulge): (f64, f64),
    ) -> Field<'a> {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for swept in passes {
            for p in [swept.from, swept.to] {
                for i in 0..2 {
                    low[i] = low[i].min(p[i]);
                    high[i] = high[i].max(p[i]);
                }
            }
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(1e-3);
        let cell = (finish.radius / 6.0).max(extent / 2000.0);
        let empty = passes.is_empty();
        let counts = [0, 1].map(|i| if empty { 1 } else { ((high[i] - low[i]) / cell).floor() as usize + 1 });
        let mut field = Field {
            tree: &finish.tree,
            radius: finish.radius,
            ball: finish.radius + finish.leave,
            floor: 0.5 * allowed,
            ceiling: 4.0 * allowed + finish.radius * 0.5,
            out: operation.band.out,
            passes,
            around: (2.0 * finish.radius * INTEREST * allowed * bulge).sqrt().min(finish.radius),
            low,
            cell,
            counts,
            buckets: vec![Vec::new(); counts[0] * counts[1]],
        };
        for (i, swept) in passes.iter().enumerate() {
            let range = |k: usize| (swept.from[k].min(swept.to[k]), swept.from[k].max(swept.to[k]));
            let (x, y) = (field.index(0, range(0)), field.index(1, range(1)));
            for a in x.0..=x.1 {
                for b in y.0..=y.1 {
                    field.buckets[a * counts[1] + b].push(u32::try_from(i).unwrap_or(u32::MAX));
                }
            }
        }
        field
    }

    /// Bucket numbers of a range of a coordinate.
    fn index(&self, axis: usize, range: (f64, f64)) -> (usize, usize) {
        let most = self.counts[axis] - 1;
        // Floats saturate: what lies outside counts to the border.
        let of = |x: f64| (((x - self.low[axis]) / self.cell).floor().max(0.0) as usize).min(most);
        (of(range.0), of(range.1))
    }

    /// Moves that may reach the corners of a cell.
    fn gather(&self, corners: &[Corner; 4], near: &mut Vec<u32>) {
        near.clear();
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for c in corners {
            let centre = c.p + c.n * self.ball;
            for i in 0..2 {
                low[i] = low[i].min(centre[i]);
                high[i] = high[i].max(centre[i]);
            }
        }
        let around = self.around;
        let (x, y) = (
            self.index(0, (low[0] - around, high[0] + around)),
            self.index(1, (low[1] - around, high[1] + around)),
        );
        for a in x.0..=x.1 {
            for b in y.0..=y.1 {
                near.extend(&self.buckets[a * self.counts[1] + b]);
            }
        }
        near.sort_unstable();
        near.dedup();
    }

    fn tile(&'a self, patch: usize, tile: u32) -> Tile<'a> {
        let part = |k: u32| (f64::from(k) / f64::from(TILES), f64::from(k + 1) / f64::from(TILES));
        let first = Cell { u: part(tile / TILES), v: part(tile % TILES), depth: 0 };
        let mut found = Tile {
            field: self,
            left: Worst::NONE,
            bound: 0.0,
            cusp: Worst::NONE,
            unreachable: Worst::NONE,
            cells: 0,
            near: Vec::new(),
            patch,
        };
        let whole = &self.tree.net().patches()[patch];
        let piece = whole.restrict(first.u, first.v);
        let bend = Bend::new(&piece, TILES);
        let mut stack = vec![first];
        while let Some(cell) = stack.pop() {
            if let Some(axis) = found.cell(whole, &bend, &cell) {
                stack.extend(cell.halves(axis));
            }
        }
        found
    }

    /// What a move leaves along the normal at a point: the height at which the ray enters the capsule.
    fn height(&self, swept: &Swept, at: &Corner) -> f64 {
        let axis = swept.to - swept.from;
        let length = axis.norm();
        let offset = at.p - swept.from;
        if length > 0.0 {
            let a = axis / length;
            let (o, n) = (offset - a * offset.dot(&a), at.n - a * at.n.dot(&a));
            if let Some(t) = enters(o, n, self.radius) {
                let along = (offset + at.n * t).dot(&a);
                if (0.0..=length).contains(&along) {
                    return t;
                }
            }
        }
        let ends =
            [swept.from, swept.to].map(|p| enters(at.p - p, at.n, self.radius).unwrap_or(f64::INFINITY));
        ends[0].min(ends[1])
    }
}

/// The first parameter at which o + t n comes within `radius` of the origin; `None` where it never does.
fn enters(o: Vec3, n: Vec3, radius: f64) -> Option<f64> {
    let (a, b, c) = (n.norm_squared(), o.dot(&n), o.norm_squared() - radius * radius);
    let root = b * b - a * c;
    if a < 1e-12 || root < 0.0 {
        return None;
    }
    Some((-b - root.sqrt()) / a)
}

/// Bounds of the second derivatives of a piece, mm per square of the whole patch's parameters.
struct Bend {
    uu: f64,
    uv: f64,
    vv: f64,
    u: f64,
    v: f64,
}

impl Bend {
    fn new(piece: &Patch, tiles: u32) -> Bend {
        let scale = f64::from(tiles);
        let [u, v] = [piece.hodograph(0), piece.hodograph(1)];
        let most =
            |p: &Patch| p.homogeneous().iter().map(|h| Vec3::new(h.x, h.y, h.z).norm()).fold(0.0, f64::max);
        // A rational patch bends with its weights as well: a generous factor that refinement makes harmless.
        let rational = if piece.is_rational() { 4.0 } else { 1.0 };
        Bend {
            uu: most(&u.hodograph(0)) * scale * scale * rational,
            uv: most(&u.hodograph(1)) * scale * scale * rational,
            vv: most(&v.hodograph(1)) * scale * scale * rational,
            u: most(&u) * scale * rational,
            v: most(&v) * scale * rational,
        }
    }
    /// How far the cell may lie from the hull of its corners, mm.
    fn sagitta(&self, du: f64, dv: f64) -> f64 {
        (self.uu * du * du + 2.0 * self.uv * du * dv + self.vv * dv * dv) / 8.0
    }
}

impl Cell {
    fn halves(&self, axis: usize) -> [Cell; 2] {
        let middle = |t: (f64, f64)| 0.5 * (t.0 + t.1);
        let depth = self.depth + 1;
        if axis == 0 {
            let m = middle(self.u);
            [Cell { u: (self.u.0, m), depth, ..*self }, Cell { u: (m, self.u.1), depth, ..*self }]
        } else {
            let m = middle(self.v);
            [Cell { v: (self.v.0, m), depth, ..*self }, Cell { v: (m, self.v.1), depth, ..*self }]
        }
    }
}

impl Tile<'_> {
    /// Looks at a cell; the axis in which to halve it, if that is needed.
    fn cell(&mut self, patch: &Patch, bend: &Bend, cell: &Cell) -> Option<usize> {
        self.cells += 1;
        let (du, dv) = (cell.u.1 - cell.u.0, cell.v.1 - cell.v.0);
        let size = [bend.u * du, bend.v * dv];
        let axis = usize::from(size[1] > size[0]);
        if size[0].max(size[1]) > 0.25 * self.field.radius {
            return Some(axis);
        }
        let corner = |u: f64, v: f64| {
            let jet = patch.jet(u, v);
            jet.normal().map(|n| Corner { p: jet.p, n, uv: [u, v] })
        };
        let corners =
            [(cell.u.0, cell.v.0), (cell.u.0, cell.v.1), (cell.u.1, cell.v.0), (cell.u.1, cell.v.1)]
                .map(|(u, v)| corner(u, v));
        let [Some(a), Some(b), Some(c), Some(d)] = corners else {
            // No normal: a collapsed corner is met by its neighbours.
            return (size[axis] > SMALLEST).then_some(axis);
        };
        let corners = [a, b, c, d];
        let mut near = core::mem::take(&mut self.near);
        self.field.gather(&corners, &mut near);
        let result = self.judge(&corners, bend.sagitta(du, dv), size[axis], &near);
        self.near = near;
        result.then_some(axis)
    }

    /// Whether the cell must be halved.
    fn judge(&mut self, corners: &[Corner; 4], sagitta: f64, size: f64, near: &[u32]) -> bool {
        let field = self.field;
        let leave = field.ball - field.radius;
        let mut bound = f64::INFINITY;
        let mut least = [f64::INFINITY; 4];
        let mut by = [0u32; 4];
        for &i in near {
            let Some(swept) = field.passes.get(i as usize) else { continue };
            let mut most = f64::NEG_INFINITY;
            for k in 0..4 {
                let height = field.height(swept, &corners[k]) - leave;
                most = most.max(height);
                if height < least[k] {
                    (least[k], by[k]) = (height, i);
                }
            }
            bound = bound.min(most);
        }
        // Raising a point by dT along its normal moves it into the capsule by more than half of that.
        let bound = bound + 2.0 * sagitta;
        for k in 0..4 {
            self.note(&corners[k], least[k], by[k], near);
        }
        let known = self.left.value.max(field.floor);
        let settled = bound <= known + 0.02 * field.floor;
        if settled || size < SMALLEST || self.cells >= MOST_CELLS {
            let over = bound > known && self.reaches(&corners[0]);
            if over {
                self.bound = self.bound.max(bound.min(field.ceiling));
            }
            return false;
        }
        // Where the ball cannot reach there is nothing to refine.
        bound < f64::INFINITY && least.iter().any(|h| *h < field.ceiling) && self.worth(corners, size)
    }

    /// Whether some corner of a larger cell can be reached; small ones are looked at in any case until they settle.
    fn worth(&self, corners: &[Corner; 4], size: f64) -> bool {
        size > 0.3 || corners.iter().any(|c| self.reaches(c))
    }

    /// Whether the ball can be set on this point without gouging elsewhere.
    fn reaches(&self, at: &Corner) -> bool {
        let (centre, ball) = (at.p + at.n * self.field.ball, self.field.ball);
        let foot = Foot { patch: self.patch, uv: at.uv, point: at.p, distance: ball, certain: 0.0 };
        !self.field.tree.comes_within(centre, &foot, ball - 1e-7)
    }

    fn note(&mut self, at: &Corner, height: f64, by: u32, near: &[u32]) {
        let field = self.field;
        let value = height.min(field.ceiling);
        if value <= self.left.value.max(field.floor) && value <= self.cusp.value {
            return;
        }
        let swept = field.passes.get(by as usize);
        let worst = |value: f64| Worst {
            value,
            line: swept.map_or(0, |s| s.line),
            block: swept.and_then(|s| s.block),
            at: at.p,
        };
        if !self.reaches(at) {
            self.unreachable.take(worst(value));
            return;
        }
        if value > field.floor {
            self.left.take(worst(value));
        }
        let cusp = self.cusp_at(at, near);
        self.cusp.take(worst(cusp));
    }

    /// What would be left at a point if the path had no deviation of its own.
    fn cusp_at(&self, at: &Corner, near: &[u32]) -> f64 {
        let leave = self.field.ball - self.field.radius;
        let mut found: Vec<(f64, &Swept)> = near
            .iter()
            .filter_map(|i| self.field.passes.get(*i as usize))
            .map(|swept| (self.field.height(swept, at) - leave, swept))
            .filter(|(height, _)| height.is_finite())
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = f64::INFINITY;
        for (height, swept) in found {
            if height - self.field.out >= best {
                break;
            }
            best = best.min(height - self.deviation(swept, at, height));
        }
        if best.is_finite() { best } else { 0.0 }
    }

    /// How far the path itself is off the surface where it cuts nearest to a point, mm.
    fn deviation(&self, swept: &Swept, at: &Corner, height: f64) -> f64 {
        let q = at.p + at.n * height;
        let axis = swept.to - swept.from;
        let t = if axis.norm_squared() > 0.0 {
            ((q - swept.from).dot(&axis) / axis.norm_squared()).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let centre = swept.from + axis * t;
        let along = axis.try_normalize(0.0).unwrap_or_default();
        let foot =
            Foot { patch: self.patch, uv: at.uv, point: at.p, distance: self.field.ball, certain: 0.0 };
        // Where the move is not parallel to the surface, it cuts beside the foot: at right angles to the move.
        let foot = self.field.tree.nearby(centre, &foot);
        let offset = foot.point - centre;
        let (tilt, level) =
            (offset.dot(&along), along - offset * (offset.dot(&along) / offset.norm_squared()));
        let beside = foot.point - level * (tilt / level.dot(&along).max(0.1));
        let beside = self.field.tree.nearby(beside, &foot).point - centre;
        let across = (beside - along * beside.dot(&along)).norm();
        (across - self.field.ball).max(0.0)
    }
}
