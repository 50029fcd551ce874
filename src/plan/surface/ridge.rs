//! The ridge between two neighbouring passes of a ball, measured on their exact tracks.
//!
//! A point of the surface between two passes stands out by the way along its normal to where the ball, swept along either
//! pass, comes by. That is the smallest over the pass of the height at which the normal enters the ball there; the pass
//! is known at its columns, and cubic between them.

use super::family::Family;
use super::spread::{COLUMNS, Line};
use crate::geom::surface::Contact;
use crate::geom::{Point3, Vec3};
use crate::math::count;

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
}

/// Part of the height of cusps that passes are spread for: the rest is for places between columns, and for paths
/// beside their tracks.
const AIM: f64 = 0.985;
/// Where the ball cannot reach, its point of contact leaps and what stays is no cusp: passes need not be closer there than
/// this times closer than on a plane.
const CLOSEST: f64 = 4.0;

/// The contacts of a pass at its columns.
#[derive(Debug)]
pub(super) struct Row {
    contacts: Vec<Option<Contact>>,
}

impl Row {
    pub(super) fn new(family: &Family, line: &Line) -> Row {
        let range = line.first().and_then(|across| family.along(*across));
        let mut hint: Option<Contact> = None;
        let contact = |(k, across): (usize, &f64)| {
            let found = family.contact(*across, place(range?, k), hint.as_ref());
            hint = found.or(hint);
            found
        };
        Row { contacts: line.iter().enumerate().map(contact).collect() }
    }

    fn centre(&self, k: usize) -> Option<Point3> {
        self.contacts.get(k)?.as_ref().map(|c| c.centre)
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
        let mut k = k;
        if at(k) == f64::INFINITY {
            k = (0..COLUMNS).min_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap_or(k);
        }
        let mut best = at(k);
        loop {
            let (left, right) = (k.checked_sub(1).map_or(f64::INFINITY, at), at(k + 1));
            if left < best && left <= right {
                (k, best) = (k - 1, left);
            } else if right < best {
                (k, best) = (k + 1, right);
            } else {
                break;
            }
        }
        let between = |s: f64| self.between(s).map_or(f64::INFINITY, cost);
        best.min(golden(&between, (count(k) - 1.0).max(0.0), (count(k) + 1.0).min(count(COLUMNS - 1))))
    }
}

/// The least of a function with one valley.
fn golden(f: &dyn Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    const SHARE: f64 = 0.618_033_988_749_894_9;
    const ROUNDS: u32 = 12;
    let (mut x, mut y) = (b - SHARE * (b - a), a + SHARE * (b - a));
    let (mut fx, mut fy) = (f(x), f(y));
    for _ in 0..ROUNDS {
        if fx < fy {
            (b, y, fy) = (y, x, fx);
            x = b - SHARE * (b - a);
            fx = f(x);
        } else {
            (a, x, fx) = (x, y, fy);
            y = a + SHARE * (b - a);
            fy = f(y);
        }
    }
    fx.min(fy)
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
    let mut hint: Option<Contact> = None;
    (0..COLUMNS)
        .map(|k| {
            let apart = rows.0.centre(k).zip(rows.1.centre(k)).map_or(0.0, |(a, b)| (b - a).norm());
            let used = match target {
                Target::Step(step) => feet(rows, k).min(CLOSEST * apart) / step,
                Target::Cusp(h) => {
                    let between = Between { family, rows, ends: (lines.0[k], lines.1[k]), k };
                    let flat = apart / (2.0 * (h * (2.0 * (family.ball - family.leave) - h)).max(0.0).sqrt());
                    between.ridge(&mut hint).map_or(0.0, |root| (root / (AIM * h).sqrt()).min(CLOSEST * flat))
                }
            };
            (used, apart)
        })
        .collect()
}

/// Distance on the surface of one pass's place from the other, mm.
fn feet((a, b): (&Row, &Row), k: usize) -> f64 {
    let Some(Some(own)) = a.contacts.get(k) else { return 0.0 };
    let foot = |k: usize| b.contacts.get(k).copied().flatten().map(|c| c.foot.point);
    let mut least = f64::INFINITY;
    for i in 0..COLUMNS {
        let Some(p) = foot(i) else { continue };
        let next = foot(i + 1).unwrap_or(p);
        let way = next - p;
        let t = ((own.foot.point - p).dot(&way) / way.norm_squared().max(1e-300)).clamp(0.0, 1.0);
        least = least.min((own.foot.point - p - way * t).norm());
    }
    if least.is_finite() { least } else { 0.0 }
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
    /// Square root of the ridge's height, mm; `None` where the ball touches nothing. Roots grow evenly from each pass,
    /// so that the ridge, where they meet, is found in two steps.
    fn ridge(&self, hint: &mut Option<Contact>) -> Option<f64> {
        let (a, b) = self.roots(0.5, hint)?;
        if !(a.is_finite() && b.is_finite()) {
            return Some(f64::INFINITY);
        }
        let share = if a + b > 0.0 { b / (a + b) } else { 0.5 };
        let Some((c, d)) = self.roots(share.clamp(0.1, 0.9), hint) else { return Some(a.min(b)) };
        let (before, after) = (a - b, c - d);
        let rest = after / (before - after);
        let root = if rest.abs() < 1.0 { c + (c - a) * rest } else { 0.5 * (c + d) };
        Some(root.max(c.min(d)))
    }

    /// Square roots of the heights that either pass leaves at a share of the way from one to the other.
    fn roots(&self, share: f64, hint: &mut Option<Contact>) -> Option<(f64, f64)> {
        let across = self.ends.0 + (self.ends.1 - self.ends.0) * share;
        let along = place(self.family.along(across)?, self.k);
        let contact = self.family.contact(across, along, hint.as_ref())?;
        *hint = Some(contact);
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
