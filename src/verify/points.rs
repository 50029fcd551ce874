//! Points: travel limits, ends of blocks, and the points of the CL data.

use super::finding::{Finding, Text};
use super::{ACCURACY, Case, Placed};
use crate::cl::RecordKind;
use crate::diag::codes::verification as codes;
use crate::geom::{Point2, Point3, Vec2};
use crate::math::{DEG, TAU};
use crate::readback::TracePath;
use crate::target::{BlockKind, GridArc, Motion, Plane, Position};

/// The move against the declared travel of X, Y and Z.
pub(super) fn travel(case: &Case<'_>, placed: &Placed<'_>) -> Vec<Finding> {
    let limits = &case.target.capabilities.travel;
    if limits.iter().all(Option::is_none) {
        return Vec::new();
    }
    let (x, y) = extent(&placed.cut.path);
    let ranges = [("X", x), ("Y", y), ("Z", placed.cut.heights())];
    ranges
        .into_iter()
        .zip(limits)
        .zip(placed.cut.known)
        .filter_map(|(((axis, range), limit), known)| {
            let (least, most) = (*limit)?;
            let low = known && range.0 < least - ACCURACY;
            (low || range.1 > most + ACCURACY).then(|| {
                let reached = if low { range.0 } else { range.1 };
                let text = Text::default().words(format!("{axis} goes to ")).length(reached);
                let text = text.words(", its travel is ").length(least).words(" to ").length(most);
                Finding::new(&codes::BEYOND_TRAVEL, placed.line, placed.block, text)
            })
        })
        .collect()
}

type Range = (f64, f64);

/// Range of the machine's X and Y over a path.
fn extent(path: &TracePath) -> (Range, Range) {
    let of = |points: &[Point2]| {
        let fold = |f: fn(&Point2) -> f64| {
            points.iter().map(f).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
        };
        (fold(|p| p.x), fold(|p| p.y))
    };
    match path {
        TracePath::Line { from, to } => of(&[*from, *to]),
        TracePath::Spiral { radius, .. } => ((radius.0.min(radius.1), radius.0.max(radius.1)), (0.0, 0.0)),
        TracePath::Nurbs { points, .. } => of(points),
        TracePath::Tilted(arc) => (arc.extent(0), arc.extent(1)),
        TracePath::Space(curve) => (curve.extent(0), curve.extent(1)),
        TracePath::Arc { from, to, centre, sweep } => {
            let mut points = vec![*from, *to];
            let start = crate::math::atan2(from.y - centre.y, from.x - centre.x);
            let quarter = TAU / 4.0;
            let r = (from - centre).norm().max((to - centre).norm());
            for i in 0..4u8 {
                let angle = f64::from(i) * quarter;
                let ahead = if *sweep > 0.0 { angle - start } else { start - angle };
                let ahead = ahead - (ahead / TAU).floor() * TAU;
                if ahead <= sweep.abs() {
                    let (s, c) = crate::math::sin_cos(angle);
                    points.push(centre + Vec2::new(c, s) * r);
                }
            }
            of(&points)
        }
    }
}

/// Every motion block that was printed moves, and its last move ends where the lowered program says.
pub(super) fn block_ends(case: &Case<'_>, lines: &[(u32, u32)]) -> Vec<Finding> {
    let mut findings = still(case, lines);
    let turns = turns(case);
    let set = axes_set(case);
    for (i, placed) in case.moves.iter().enumerate() {
        let last_of_block = case.moves.get(i + 1).is_none_or(|next| next.block != placed.block);
        let text = match placed.block.and_then(|b| case.target.blocks.get(b)).map(|b| &b.kind) {
            Some(BlockKind::Motion(motion)) if last_of_block => {
                let turn = placed.block.and_then(|b| turns.get(b)).copied().flatten();
                let set = placed.block.and_then(|b| set.get(b)).copied().unwrap_or(0);
                let inherited = placed.block.is_some_and(|b| keeps_plane(case, b, motion));
                wrong_end(case, (motion, set, inherited), placed).or_else(|| wrong_turn(turn, placed))
            }
            Some(BlockKind::Motion(_)) => None,
            Some(BlockKind::Insert(_) | BlockKind::Hole(_)) => None,
            Some(BlockKind::Begin | BlockKind::End | BlockKind::ToolChange(_) | BlockKind::EndCycle) => {
                dives(placed)
            }
            _ => Some(Text::default().words("a motion that the lowered program does not have")),
        };
        findings.extend(text.map(|t| Finding::new(&codes::NOT_AS_LOWERED, placed.line, placed.block, t)));
    }
    findings
}

/// What a post adds at the start, the end and a tool change may retract, not cut and not go down.
fn dives(placed: &Placed<'_>) -> Option<Text> {
    let (from, to) = placed.cut.z;
    let down = placed.cut.known[2] && to < from - ACCURACY;
    (down || !placed.cut.rapid).then(|| {
        let text = Text::default()
            .words("a motion of the post's own goes from Z ")
            .length(from)
            .words(" to ")
            .length(to);
        text.words(if placed.cut.rapid { "" } else { " at feed" })
    })
}

/// Motion blocks whose lines move nothing.
fn still(case: &Case<'_>, lines: &[(u32, u32)]) -> Vec<Finding> {
    let mut moves = vec![false; case.target.blocks.len()];
    for placed in case.moves {
        if let Some(slot) = placed.block.and_then(|b| moves.get_mut(b)) {
            *slot = true;
        }
    }
    let blocks = case.target.blocks.iter().zip(lines).zip(moves).enumerate();
    blocks
        .filter(|(_, ((block, (from, to)), moves))| {
            matches!(block.kind, BlockKind::Motion(_)) && to > from && !moves
        })
        .map(|(i, ((_, (from, _)), _))| {
            let text = Text::default().words("a motion block that moves nothing");
            Finding::new(&codes::NOT_AS_LOWERED, *from, Some(i), text)
        })
        .collect()
}

/// The axes that have been moved up to every block since the last tool change (or the start): only their values mean
/// something, as bits of [`crate::target::axes`].
fn axes_set(case: &Case<'_>) -> Vec<u8> {
    let mut set = 0;
    let after = |block: &crate::target::Block| {
        match &block.kind {
            BlockKind::ToolChange(_) => set = 0,
            BlockKind::Motion(Motion::Rapid { axes, .. }) => set |= axes,
            BlockKind::Motion(_) | BlockKind::Hole(_) => set = u8::MAX,
            _ => {}
        }
        set
    };
    case.target.blocks.iter().map(after).collect()
}

/// Where a motion ends, if it has an end of its own.
fn end_of(motion: &Motion) -> Option<Position> {
    match motion {
        Motion::Rapid { to, .. } | Motion::Line { to, .. } | Motion::Arc { to, .. } => Some(*to),
        Motion::Nurbs { .. } => None,
    }
}

/// Whether a block leaves X and Y where the block before it came to.
fn keeps_plane(case: &Case<'_>, block: usize, motion: &Motion) -> bool {
    let before = case.target.blocks.iter().take(block).rev().find_map(|b| match &b.kind {
        BlockKind::Motion(motion) => Some(end_of(motion)),
        BlockKind::Hole(_) | BlockKind::Insert(_) | BlockKind::ToolChange(_) => Some(None),
        _ => None,
    });
    let here = end_of(motion);
    before.flatten().zip(here).is_some_and(|(a, b)| (a.x, a.y) == (b.x, b.y))
}

fn wrong_end(
    case: &Case<'_>,
    (motion, set, inherited): (&Motion, u8, bool),
    placed: &Placed<'_>,
) -> Option<Text> {
    let (to, rapid) = match motion {
        Motion::Rapid { to, .. } => (*to, true),
        Motion::Line { to, .. } | Motion::Arc { to, .. } => (*to, false),
        Motion::Nurbs { curve, .. } => {
            let last = case.target.nurbs.get(*curve as usize).and_then(crate::target::Nurbs::end);
            (last?, false)
        }
    };
    let wanted = in_part(case, to);
    let got = placed.cut.end();
    if rapid != placed.cut.rapid {
        return Some(Text::default().words(if rapid {
            "a cut in place of a rapid"
        } else {
            "a rapid in place of a cut"
        }));
    }
    if let Some(text) = wrong_arc(case, motion, placed) {
        return Some(text);
    }
    let meant = |axis: usize| set & (1 << axis) != 0;
    // A table that is not known turns X and Y of the part.
    let plane = meant(0) && meant(1);
    let off = got - wanted;
    // An end that follows from a printed angle lies on the start's circle, the one wanted on the grid: they are less than a
    // step apart, as a wrong last digit would not be. Blocks that do not move in the plane stay there.
    let share = if inherited || matches!(motion, Motion::Arc { .. }) { 0.75 } else { 0.25 };
    let near = share * case.target.capabilities.grid.linear_step() + ACCURACY;
    let wrong = plane && !(off.xy().norm() <= near) || meant(2) && !(off.z.abs() <= near);
    wrong.then(|| Text::default().words("the block ends at ").place(got).words(" in place of ").place(wanted))
}

/// How far every motion block turns the table, radians in the part; `None` without a table, or where it is not known
/// from where.
#[allow(clippy::cast_precision_loss)]
fn turns(case: &Case<'_>) -> Vec<Option<f64>> {
    let capabilities = &case.target.capabilities;
    let Some(rotary) = capabilities.rotary else { return Vec::new() };
    let step = capabilities.grid.rotary_step() * DEG * if rotary.reversed { -1.0 } else { 1.0 };
    let mut last: Option<i64> = None;
    let to = |block: &crate::target::Block| match &block.kind {
        BlockKind::Motion(Motion::Rapid { to, axes }) => Some((to.r, axes & 8 != 0)),
        BlockKind::Motion(Motion::Line { to, .. } | Motion::Arc { to, .. }) => Some((to.r, true)),
        _ => None,
    };
    let mut turn = |block| {
        let (r, moves) = to(block)?;
        let before = last;
        last = if moves { Some(r) } else { last };
        before.map(|b| if moves { (r - b) as f64 * step } else { 0.0 })
    };
    case.target.blocks.iter().map(&mut turn).collect()
}

fn wrong_turn(wanted: Option<f64>, placed: &Placed<'_>) -> Option<Text> {
    let wanted = wanted?;
    let got = if let TracePath::Spiral { angle, .. } = placed.cut.path { angle.1 - angle.0 } else { 0.0 };
    ((got - wanted).abs() > 1e-9).then(|| {
        Text::default().words(format!(
            "the table turns by {:.4} deg in place of {:.4} deg",
            got / DEG,
            wanted / DEG
        ))
    })
}

/// An arc as the control draws it.
struct Drawn {
    plane: Plane,
    /// In the plane, mm.
    start: Point2,
    /// Centre minus start, mm.
    offset: Vec2,
    clockwise: bool,
}

fn drawn(path: &TracePath) -> Option<Drawn> {
    match path {
        TracePath::Arc { from, centre, sweep, .. } => {
            Some(Drawn { plane: Plane::Xy, start: *from, offset: centre - from, clockwise: *sweep < 0.0 })
        }
        TracePath::Tilted(arc) => {
            let offset = arc.centre - arc.from;
            let along = |axis: usize| arc.axis[axis].abs() > 0.5;
            let plane = [Plane::Zx, Plane::Yz, Plane::Xy].into_iter().find(|p| along(p.axes()[2]))?;
            let [first, second, third] = plane.axes();
            Some(Drawn {
                plane,
                start: Point2::new(arc.from[first], arc.from[second]),
                offset: Vec2::new(offset[first], offset[second]),
                clockwise: (arc.sweep < 0.0) == (arc.axis[third] > 0.0),
            })
        }
        _ => None,
    }
}

/// An arc with another plane, centre or sense than lowered, or none. A control that goes by the end's angle adds a line
/// to the arc.
#[allow(clippy::cast_precision_loss)]
fn wrong_arc(case: &Case<'_>, motion: &Motion, placed: &Placed<'_>) -> Option<Text> {
    let before = case.moves.get(..=placed.index).unwrap_or_default();
    let of_block = before.iter().rev().take_while(|p| p.block == placed.block);
    let drawn = of_block.filter_map(|p| drawn(&p.cut.path)).last();
    let Motion::Arc { to, centre, plane, clockwise, .. } = motion else {
        return drawn.map(|_| Text::default().words("an arc in place of a line or curve"));
    };
    let Some(as_drawn) = drawn else {
        return Some(Text::default().words("no arc where the lowered program has one"));
    };
    let Drawn { plane: own, offset, clockwise: sense, .. } = as_drawn;
    if own != *plane {
        return Some(Text::default().words("an arc in another plane than lowered"));
    }
    if sense != *clockwise {
        let name = |clockwise: bool| if clockwise { "clockwise" } else { "counter-clockwise" };
        let text = format!("an arc that runs {} in place of {}", name(sense), name(*clockwise));
        return Some(Text::default().words(text));
    }
    let step = case.target.capabilities.grid.centre_step();
    let wanted = centre_offset(case, &as_drawn, *to, (*centre, *clockwise));
    // With a table the offsets may be turned; their length stays.
    let off = if case.target.capabilities.rotary.is_some() {
        (offset.norm() - wanted.norm()).abs()
    } else {
        (offset - wanted).norm()
    };
    // Where a block starts may follow from an angle that the block before has.
    let most = 0.25 * step + ACCURACY;
    (!(off <= most)).then(|| Text::default().words("an arc whose centre is off by ").length(off))
}

/// The lowered arc's centre minus its start, mm; where a place between tells it, as that draws it.
#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)]
fn centre_offset(
    case: &Case<'_>,
    drawn: &Drawn,
    to: Position,
    (centre, clockwise): ([i64; 2], bool),
) -> Vec2 {
    let grid = &case.target.capabilities.grid;
    let (linear, step) = (grid.linear_step(), grid.centre_step());
    if !case.target.capabilities.by_middle(drawn.plane) {
        return Vec2::new(centre[0] as f64, centre[1] as f64) * step;
    }
    let [first, second, _] = drawn.plane.axes();
    let ends = [to.x, to.y, to.z];
    let start = [drawn.start.x, drawn.start.y].map(|v| (v / linear).round() as i64);
    let arc = GridArc { start, to: [ends[first], ends[second]], centre, clockwise };
    let offset = arc.centre_by_middle((linear / step).round() as i64);
    offset.map(|c| Vec2::new(c[0], c[1]) * linear).unwrap_or_default()
}

#[allow(clippy::cast_precision_loss)]
fn in_part(case: &Case<'_>, p: Position) -> Point3 {
    let capabilities = &case.target.capabilities;
    let (step, turn) = (capabilities.grid.linear_step(), capabilities.grid.rotary_step());
    let (x, y, z) = (p.x as f64 * step, p.y as f64 * step, p.z as f64 * step);
    let Some(rotary) = capabilities.rotary else { return Point3::new(x, y, z) };
    let angle = p.r as f64 * turn * DEG * if rotary.reversed { -1.0 } else { 1.0 };
    let (s, c) = crate::math::sin_cos(angle);
    Point3::new(c * x - s * y, s * x + c * y, z)
}

/// The points of the CL data (`GOTO`, rapid or at feed) are reached in their order, contours apart.
///
/// `before` is where the tool was before the first of them, in a part of a program.
pub(super) fn cl_points(case: &Case<'_>, before: Option<Point3>) -> Vec<Finding> {
    let step = case.target.capabilities.grid.linear_step();
    let mut at = 0;
    let mut depth = 0.0;
    let mut findings = Vec::new();
    for (index, record) in case.cl.records.iter().enumerate() {
        // The start of a contour may slide along it by a step or two.
        let starts = case.cl.records[index..].get(1).is_some_and(
            |next| matches!(&next.kind, RecordKind::Contour(c) if c.entry == crate::cl::Lead::None),
        );
        let most = if starts { 2.0 * step } else { 0.5 * step * 3.0_f64.sqrt() } + ACCURACY;
        let point = match record.kind {
            RecordKind::From(p) | RecordKind::Rapid(p) | RecordKind::Linear(p) => p,
            RecordKind::Circle(ref circle) => circle.to,
            RecordKind::Spline(ref spline) => spline.end(),
            RecordKind::BeginCycle(ref cycle) => {
                depth = cycle.depth;
                continue;
            }
            // The bottom of the hole.
            RecordKind::Hole(p) => Point3::new(p.x, p.y, p.z - depth),
            _ => continue,
        };
        let rest = case.moves.get(at..).unwrap_or_default();
        let here = at
            .checked_sub(1)
            .and_then(|i| case.moves.get(i))
            .map(|p| p.cut.end())
            .or(before.filter(|_| at == 0))
            .is_some_and(|p| (p - point).norm() <= most);
        if here {
            continue;
        }
        if let Some(i) = rest.iter().position(|p| (p.cut.end() - point).norm() <= most) {
            at += i + 1;
            continue;
        }
        let block = case.target.blocks.iter().position(|b| b.origin == record.origin);
        let line = case.moves.iter().find(|p| p.block == block).map_or(0, |p| p.line);
        let text = Text::default().words("the point ").place(point);
        findings.push(Finding::new(&codes::NOT_FOLLOWED, line, block, text.words(" is not reached")));
    }
    findings
}
