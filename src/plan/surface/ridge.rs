//! The ridge between two neighbouring passes of a ball, measured on their exact tracks.
//!
//! A point of the surface between two passes stands out by the way along its normal to where the ball, swept along either
//! pass, comes by. That is the smallest over the pass of the height at which the normal enters the ball there; the pass
//! is known at its columns, and cubic between them.

use std::ops::Range;

use rayon::prelude::*;

use super::family::Family;
use super::spread::{COLUMNS, Line};
use crate::geom::extremum::Section;
use crate::geom::surface::Contact;
use crate::geom::{Point3, Vec3, nearest_on_way};
use crate::math::count;

/// Steps of the search between columns.
const ROUNDS: usize = 12;

/// What decides about the distance of passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Target {
    /// Height of cusps, mm.
    Cusp(f64),
    /// Distance on the surface, mm.
    Step(f64),
}

impl Target {
    pub(super) fn name(self) -> String {
        match self {
            Target::Cusp(h) => format!("a height of cusps of {h} mm"),
            Target::Step(_) => "this step".into(),
        }
    }

    /// About how many passes a family takes: those of a plane as wide.
    pub(super) fn passes(self, family: &Family) -> f64 {
        let step = match self {
            Target::Cusp(h) => 2.0 * (h * (2.0 * family.radius() - h)).max(0.0).sqrt(),
            Target::Step(s) => s,
        };
        family.width() / step
    }

    /// The same, for passes that are `factor` times as far apart.
    pub(super) fn coarser(self, factor: f64) -> Target {
        match self {
            Target::Cusp(h) => Target::Cusp(h * factor * factor),
            Target::Step(s) => Target::Step(s * factor),
        }
    }
}

/// Part of the height of cusps that passes are spread for: the rest is for places between columns, and for paths
/// beside their tracks.
const AIM: f64 = 0.993;
/// The same beside a border: what goes aside there counts twice.
const AIM_BORDER: f64 = 0.975;
/// Where the ball cannot reach, its point of contact leaps and what stays is no cusp: passes need not be closer there than
/// this times closer than on a plane.
const CLOSEST: f64 = 4.0;

/// Columns that one task measures.
const CHUNK: usize = 32;

/// The contacts of a pass at its columns.
#[derive(Debug)]
pub(super) struct Row {
    contacts: Vec<Option<Contact>>,
}

impl Row {
    pub(super) fn new(family: &Family, line: &Line) -> Row {
        // A pass in a plane is one line, and has its own range.
        let range = family.along(line.iter().copied().find(|a| !a.is_nan()).unwrap_or(f64::NAN));
        let part = |from: usize| {
            let mut hint: Option<Contact> = None;
            let contact = |k: usize| {
                let across = line.get(k).copied().filter(|a| !a.is_nan())?;
                let found = family.contact(across, place(range?, k), hint.as_ref());
                hint = found.or(hint);
                found
            };
            (from..(from + CHUNK).min(COLUMNS)).map(contact).collect::<Vec<Option<Contact>>>()
        };
        Row { contacts: (0..COLUMNS).into_par_iter().step_by(CHUNK).flat_map_iter(part).collect() }
    }

    pub(super) fn contact(&self, k: usize) -> Option<&Contact> {
        self.contacts.get(k)?.as_ref()
    }

    pub(super) fn centre(&self, k: usize) -> Option<Point3> {
        self.contact(k).map(|c| c.centre)
    }

    /// Distance of a point from the points of contact, mm; column `k` is near it.
    fn beside(&self, p: Point3, k: usize) -> f64 {
        let foot = |k: usize| self.contacts.get(k).copied().flatten().map(|c| c.foot.point);
        let Some(k) = self.descend(k, &|k| foot(k).map_or(f64::INFINITY, |q| (q - p).norm_squared())) else {
            return f64::INFINITY;
        };
        let Some(q) = foot(k) else { return f64::INFINITY };
        let chord = |end: Option<Point3>| (p - nearest_on_way(q, end.unwrap_or(q), p)).norm();
        chord(k.checked_sub(1).and_then(foot)).min(chord(foot(k + 1)))
    }

    /// The column, downhill from `k`, where a cost is least; where it is infinite at `k`, downhill from the best.
    fn descend(&self, mut k: usize, at: &dyn Fn(usize) -> f64) -> Option<usize> {
        if at(k) == f64::INFINITY {
            k = (0..self.contacts.len()).min_by(|a, b| at(*a).total_cmp(&at(*b)))?;
        }
        let mut best = at(k);
        loop {
            let (left, right) = (k.checked_sub(1).map_or(f64::INFINITY, at), at(k + 1));
            if left < best && left <= right {
                (k, best) = (k - 1, left);
            } else if right < best {
                (k, best) = (k + 1, right);
            } else {
                return Some(k);
            }
        }
    }

    /// How far the path may be beside the pass at a column, mm.
    fn aside(&self, family: &Family, k: usize) -> f64 {
        self.contacts.get(k).copied().flatten().map_or(0.0, |c| family.aside(c.normal))
    }

    /// The share of the height of cusps that may be used beside the pass at a column.
    fn share(&self, family: &Family, k: usize) -> f64 {
        self.contacts.get(k).copied().flatten().map_or(1.0, |c| family.share(c.foot.point))
    }

    /// The centre between columns.
    fn between(&self, s: f64) -> Option<Point3> {
        // s lies in 0..=COLUMNS - 1, and floats saturate.
        let i = (s.floor() as usize).min(COLUMNS - 2);
        let f = s - count(i);
        let (b, c) = (self.centre(i)?, self.centre(i + 1)?);
        let a = i.checked_sub(1).and_then(|j| self.centre(j)).unwrap_or(b + (b - c));
        let d = self.centre(i + 2).unwrap_or(c + (c - b));
        let (m, n) = ((c - a) * 0.5, (d - b) * 0.5);
        let (f2, f3) = (f * f, f * f * f);
        Some(b + (c - b) * (3.0 * f2 - 2.0 * f3) + m * (f3 - 2.0 * f2 + f) + n * (f3 - f2))
    }

    /// The least of a function of the centre over the pass, looked for from column `k`.
    fn least(&self, k: usize, cost: &dyn Fn(Point3) -> f64) -> f64 {
        let at = |k: usize| self.centre(k).map_or(f64::INFINITY, cost);
        let Some(k) = self.descend(k, &at) else { return f64::INFINITY };
        let best = at(k);
        let between = |s: f64| -self.between(s).map_or(f64::INFINITY, cost);
        let near = ((count(k) - 1.0).max(0.0), (count(k) + 1.0).min(count(COLUMNS - 1)));
        best.min(-Section::about_maximum(between, near, ROUNDS).best().1)
    }
}

/// Column `k` of a range of places along.
fn place((from, to): (f64, f64), k: usize) -> f64 {
    from + (to - from) * count(k) / count(COLUMNS - 1)
}

/// The share of what is allowed, and the distance of the centres, between two passes at every column.
pub(super) fn gap(
    family: &Family,
    target: Target,
    rows: (&Row, &Row),
    lines: (&Line, &Line),
) -> Vec<(f64, f64)> {
    let chunk = |from: usize| chunk(family, target, rows, lines, from..(from + CHUNK).min(COLUMNS));
    (0..COLUMNS).into_par_iter().step_by(CHUNK).flat_map_iter(chunk).collect()
}

/// The same for a few columns.
fn chunk(
    family: &Family,
    target: Target,
    rows: (&Row, &Row),
    lines: (&Line, &Line),
    columns: Range<usize>,
) -> Vec<(f64, f64)> {
    let mut hint: Option<Contact> = None;
    columns
        .map(|k| {
            let apart = rows.0.centre(k).zip(rows.1.centre(k)).map_or(0.0, |(a, b)| (b - a).norm());
            if apart <= 0.0 {
                return (0.0, 0.0);
            }
            let used = match target {
                Target::Step(step) => {
                    let between = Between { family, rows, ends: (lines.0[k], lines.1[k]), k };
                    let far = if family.is_plane() { between.nearer(&mut hint) } else { feet(rows, k) };
                    far.min(CLOSEST * apart) / step
                }
                Target::Cusp(h) => {
                    let between = Between { family, rows, ends: (lines.0[k], lines.1[k]), k };
                    let flat = apart / (2.0 * (h * (2.0 * (family.ball - family.leave) - h)).max(0.0).sqrt());
                    let share = rows.0.share(family, k).min(rows.1.share(family, k));
                    let whole = (AIM * share * h).sqrt();
                    between.ridge(&mut hint).map_or(0.0, |root| (root / whole).min(CLOSEST * flat))
                }
            };
            let aside = rows.0.aside(family, k).max(rows.1.aside(family, k));
            (wider(used, aside, apart), apart)
        })
        .collect()
}

/// A share, when a distance may grow by `aside`.
fn wider(used: f64, aside: f64, apart: f64) -> f64 {
    if apart > 0.0 { used * (1.0 + (aside / apart).min(1.0)) } else { used }
}

/// Distance on the surface of one pass's place from the other, mm.
fn feet((a, b): (&Row, &Row), k: usize) -> f64 {
    let Some(Some(own)) = a.contacts.get(k) else { return 0.0 };
    let least = b.beside(own.foot.point, k);
    if least.is_finite() { least } else { 0.0 }
}

/// The share of half a distance that lies between the border of the surface, at *across* `edge`, and the pass next to
/// it; and twice the distance of the centres, at every column.
pub(super) fn border(family: &Family, target: Target, row: &Row, line: &Line, edge: f64) -> Vec<(f64, f64)> {
    let half = Half { family, target, row };
    let Some(rim) = family.rim() else {
        let mut hint: Option<Contact> = None;
        let at = |(k, across): (usize, &f64)| {
            let along = family.along(*across).map(|range| place(range, k)).filter(|_| !across.is_nan())?;
            let contact = family.contact(edge, along, hint.as_ref())?;
            hint = Some(contact);
            let apart = (contact.centre - row.centre(k)?).norm();
            Some((half.used((contact.foot.point, contact.normal), k, apart), 2.0 * apart))
        };
        return line.iter().enumerate().map(at).map(|found| found.unwrap_or((0.0, 0.0))).collect();
    };
    // Points of the edge that lie outside of the pass count to it as a whole.
    let across = line.first().copied().unwrap_or(edge);
    let (axis, range) = (rim.axis, family.along(across).unwrap_or((0.0, 1.0)));
    let worst =
        rim.places.iter().filter(|p| (p.centre[1 - axis] - across) * (edge - across) > 0.0).map(|p| {
            let share = (p.centre[axis] - range.0) / (range.1 - range.0);
            // Floats saturate.
            let k = ((share * count(COLUMNS - 1)).round().max(0.0) as usize).min(COLUMNS - 1);
            half.used((p.point, p.normal), k, (p.centre[1 - axis] - across).abs())
        });
    vec![(worst.fold(0.0, f64::max), 2.0 * (across - edge).abs()); line.len()]
}

/// Whether, at every column, something stays between a pass and the border that the border itself does not tell: where
/// the ball cannot reach the border it touches elsewhere, perhaps on what the pass has cut already.
pub(super) fn hidden(family: &Family, target: Target, row: &Row, line: &Line, edge: f64) -> Vec<bool> {
    const PARTS: usize = 8;
    /// So much of half a distance stays nowhere but where passes are missing.
    const MISSING: f64 = 2.0;
    let half = Half { family, target, row };
    let hidden = |k: usize| {
        let (across, own) = (line.get(k).copied().filter(|a| !a.is_nan())?, row.centre(k)?);
        let along = place(family.along(across)?, k);
        let on_border = family.contact(edge, along, None)?;
        if !family.is_lifted(&on_border, (edge, along)) {
            return None;
        }
        let mut hint = Some(on_border);
        let stays = |part: usize| {
            let at = across + (edge - across) * count(part) / count(PARTS);
            let contact = family.contact(at, along, hint.as_ref())?;
            hint = Some(contact);
            let apart = (contact.centre - own).norm();
            Some(half.used((contact.foot.point, contact.normal), k, apart) > MISSING)
        };
        Some((1..PARTS).rev().filter_map(stays).any(|s| s))
    };
    (0..line.len()).into_par_iter().map(|k| hidden(k).unwrap_or(false)).collect()
}

/// One pass, and what it leaves beside it.
struct Half<'a> {
    family: &'a Family,
    target: Target,
    row: &'a Row,
}

impl Half<'_> {
    /// The share of half a distance at a point with its normal, whose centre is so far from the pass's own; column `k` is
    /// near it.
    fn used(&self, (q, n): (Point3, Vec3), k: usize, apart: f64) -> f64 {
        let aside = self.row.aside(self.family, k).max(self.family.aside(n));
        let used = match self.target {
            Target::Step(step) => 2.0 * self.row.beside(q, k).min(CLOSEST * apart) / step,
            Target::Cusp(h) => {
                let (radius, leave) = (self.family.radius(), self.family.leave);
                let flat = apart / (h * (2.0 * radius - h)).max(0.0).sqrt();
                let height = |centre| enters(q - centre, n, radius) - leave;
                let root = self.row.least(k, &height).max(0.0).sqrt();
                (root / (AIM_BORDER * self.family.share(q) * h).sqrt()).min(CLOSEST * flat)
            }
        };
        wider(used, aside, apart)
    }
}

/// A column between two passes.
struct Between<'a> {
    family: &'a Family,
    rows: (&'a Row, &'a Row),
    /// *Across* of both passes.
    ends: (f64, f64),
    k: usize,
}

impl Between<'_> {
    /// Twice the distance on the surface, mm, of the place half way from the pass that is nearer: where one pass ends
    /// before the other, that counts.
    fn nearer(&self, hint: &mut Option<Contact>) -> f64 {
        let Some(contact) = self.within(0.5, hint) else { return 0.0 };
        let beside = |row: &Row| row.beside(contact.foot.point, self.k);
        let nearer = beside(self.rows.0).min(beside(self.rows.1));
        if nearer.is_finite() { 2.0 * nearer } else { 0.0 }
    }

    /// The contact at a share of the way from one pass to the other.
    fn within(&self, share: f64, hint: &mut Option<Contact>) -> Option<Contact> {
        let across = self.ends.0 + (self.ends.1 - self.ends.0) * share;
        let along = place(self.family.along(across)?, self.k);
        let contact = self.family.contact(across, along, hint.as_ref())?;
        *hint = Some(contact);
        Some(contact)
    }

    /// Square root of the ridge's height, mm; `None` where the ball touches nothing. Roots grow evenly from each pass,
    /// so that the place of the ridge, where they meet, is found in a few steps.
    fn ridge(&self, hint: &mut Option<Contact>) -> Option<f64> {
        let (a, b) = self.roots(0.5, hint)?;
        if !(a.is_finite() && b.is_finite()) {
            return Some(f64::INFINITY);
        }
        const ROUNDS: u32 = 4;
        const EVEN: f64 = 0.02;
        let (mut before, mut now, mut share) = ((a, b), (a, b), 0.5);
        for _ in 0..ROUNDS {
            let (rise, fall) = (now.0 / share, now.1 / (1.0 - share));
            share = if rise + fall > 0.0 { fall / (rise + fall) } else { 0.5 };
            share = share.clamp(0.05, 0.95);
            let Some(found) = self.roots(share, hint) else { break };
            (before, now) = (now, found);
            if (now.0 - now.1).abs() <= EVEN * (now.0 + now.1) {
                break;
            }
        }
        let ((a, b), (c, d)) = (before, now);
        let rest = (c - d) / (a - b - c + d);
        let root = if rest.abs() < 1.0 { c + (c - a) * rest } else { 0.5 * (c + d) };
        Some(root.max(c.min(d)))
    }

    /// Square roots of the heights that either pass leaves at a share of the way from one to the other.
    fn roots(&self, share: f64, hint: &mut Option<Contact>) -> Option<(f64, f64)> {
        let contact = self.within(share, hint)?;
        let (q, n, leave) = (contact.foot.point, contact.normal, self.family.leave);
        let radius = self.family.ball - leave;
        // Cusps stand on what is left.
        let height = |centre: Point3| enters(q - centre, n, radius) - leave;
        let root = |row: &Row| row.least(self.k, &height).max(0.0).sqrt();
        Some((root(self.rows.0), root(self.rows.1)))
    }
}

/// Height along `n` at which a ray from o enters a ball about the origin; where it passes by, more than the radius.
fn enters(o: Vec3, n: Vec3, radius: f64) -> f64 {
    let along = o.dot(&n);
    let square = along * along - o.norm_squared() + radius * radius;
    if square < 0.0 { radius + (-square).sqrt() } else { -along - square.sqrt() }
}
