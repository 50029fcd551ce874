//! Passes of cutters with a flat or a cone that bend: each follows the one before it in plan, everywhere as far from it as the
//! ridge between the two allows, or at the same distance.
//!
//! A pass is told by how far it lies across the net at some places along it, its *columns*. Between two passes the cutter is let
//! down as between straight ones ([`super::apart`]), and each column is moved by what its own ridge asks for. Passes run on
//! only where the one before them leaves too much up to the border.

use std::sync::Arc;

use super::apart::{AIM, Apart, CLOSEST, Course, Lane, MOST, Station};
use super::march::faired;
use super::scale::Scale;
use super::spread::{Line, smooth};
use rayon::prelude::*;

use crate::geom::surface::{Contact, Cutter, Rim, SurfaceTree};
use crate::geom::{Point2, Point3, nearest_on_way};
use crate::math::{self, count};

/// Places along a pass that tell its shape.
pub(super) const COLUMNS: usize = 129;
/// More passes than this are a mistake in the step.
const MOST_PASSES: usize = 20_000;
/// Attempts at one pass …
const TRIES: u32 = 14;
/// … of which so many move every column by itself.
const FREE: u32 = 8;
/// Columns are moved so that they use this share of what they may.
const GOAL: f64 = 0.93;
/// A pass is near enough if so much of what it may use is used somewhere.
const NEAR: f64 = 0.85;
/// Ridges on a slope grow with the distance, round ones with its square: steps follow by this power.
const POWER: f64 = 0.6;
/// A pass turns out of the way along the net by no more than this (as a tangent).
const SLOPE: f64 = 0.4;
/// How often steps, and passes, are made fair …
const FAIRINGS: (u32, u32) = (40, 12);
/// … passes in the first attempts only: where one lags behind that would lift it.
const FAIR: u32 = 3;
/// Columns about one whose steps it does not exceed.
const LEAST: usize = 4;
/// Columns about a place that its ridge counts for.
const AROUND: usize = 2;
/// Ways are tried out with ridges so much higher …
pub(super) const TRIAL: f64 = 3.0;
/// … and distances so much larger.
const TRIAL_STEP: f64 = 3.0;
/// Where a distance on the surface leaps, it counts as no more than so many times that in plan.
const LEAP: f64 = 4.0;

/// What the distance of passes is found by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Rule {
    /// The height of ridges.
    Ridge,
    /// One distance everywhere, mm.
    Step(f64),
}

/// What passes use is smooth over so many columns.
const SMOOTH: usize = 2;

/// Bent passes over a net.
pub(super) struct Bends<'a> {
    frame: Frame,
    apart: &'a Apart,
    rule: Rule,
}

/// Where columns are in plan.
struct Frame {
    tree: Arc<SurfaceTree>,
    cutter: Cutter,
    rim: Rim,
    /// Passes run along u (0) or v (1).
    axis: usize,
    /// The parameter along of each column.
    along: Vec<f64>,
    /// Distance of columns, mm.
    apart: f64,
    across: Scale,
}

impl Frame {
    fn new(tree: &Arc<SurfaceTree>, cutter: Cutter, rim: Rim, axis: usize) -> Frame {
        let net = tree.net();
        let (along, across) = (Scale::new(net, &rim, axis), Scale::new(net, &rim, 1 - axis));
        let apart = along.width() / count(COLUMNS - 1);
        let along = (0..COLUMNS).map(|k| along.value(apart * count(k))).collect();
        Frame { tree: Arc::clone(tree), cutter, rim, axis, along, apart, across }
    }

    fn width(&self) -> f64 {
        self.across.width()
    }

    /// The place in plan of a column, so far across.
    fn place(&self, k: usize, at: f64) -> Point2 {
        let across = self.across.value(at);
        let along = self.along[k];
        self.rim.place(self.tree.net(), if self.axis == 0 { [along, across] } else { [across, along] })
    }

    fn strip(&self, line: &Line) -> Strip {
        let place = |(k, at): (usize, &f64)| (!at.is_nan()).then(|| self.place(k, *at));
        let places = line.iter().enumerate().map(place).collect();
        Strip { tree: Arc::clone(&self.tree), cutter: self.cutter, places }
    }
}

/// A way in plan through its columns; open where there are none.
pub(super) struct Strip {
    tree: Arc<SurfaceTree>,
    cutter: Cutter,
    places: Vec<Option<Point2>>,
}

impl Strip {
    fn place(&self, share: f64) -> Option<Point2> {
        let x = share.clamp(0.0, 1.0) * count(COLUMNS - 1);
        // x lies in 0..COLUMNS, and floats saturate.
        let i = (x.floor() as usize).min(COLUMNS - 2);
        let f = x - count(i);
        let at = |k: Option<usize>| self.places.get(k?).copied().flatten().map(|p| p.coords);
        let (b, c) = match (at(Some(i)), at(Some(i + 1))) {
            (Some(b), Some(c)) => (b, c),
            (Some(b), None) if f <= 1e-12 => return Some(b.into()),
            (None, Some(c)) if f >= 1.0 - 1e-12 => return Some(c.into()),
            _ => return None,
        };
        let a = at(i.checked_sub(1)).unwrap_or(b * 2.0 - c);
        let d = at(Some(i + 2)).unwrap_or(c * 2.0 - b);
        let (m, n) = ((c - a) * 0.5, (d - b) * 0.5);
        let (f2, f3) = (f * f, f * f * f);
        let p = b * (2.0 * f3 - 3.0 * f2 + 1.0)
            + m * (f3 - 2.0 * f2 + f)
            + c * (3.0 * f2 - 2.0 * f3)
            + n * (f3 - f2);
        Some(p.into())
    }
}

impl Course for Strip {
    fn at(&self, share: f64, hint: Option<&Contact>) -> Option<Contact> {
        let p = self.place(share)?;
        self.cutter.drop(&self.tree, p.x, p.y, hint)
    }
    fn length(&self) -> f64 {
        let chord = |w: &[Option<Point2>]| w[0].zip(w[1]).map_or(0.0, |(a, b)| (b - a).norm());
        let open = self.places.iter().flatten().count();
        // Stations are spread over all columns.
        let length: f64 = self.places.windows(2).map(chord).sum();
        length * count(COLUMNS) / count(open.max(1))
    }
    fn bends(&self) -> bool {
        true
    }
    fn tree(&self) -> &SurfaceTree {
        &self.tree
    }
}

/// The last pass so far.
struct Front {
    line: Line,
    lane: Lane<Strip>,
    /// How far the next one would go, mm.
    step: Line,
}

/// Passes, each with its plan in columns and its room.
pub(super) struct Passes {
    /// The places of every pass.
    pub places: Vec<Vec<Option<Point2>>>,
    /// The distance to the nearer neighbour, mm.
    pub room: Vec<Line>,
    /// Length of all, mm.
    pub length: f64,
}

/// How passes are found: over a net in this making, with their ridges.
pub(super) struct Making<'a> {
    pub tree: &'a Arc<SurfaceTree>,
    pub cutter: Cutter,
    pub rim: Rim,
    pub apart: &'a Apart,
    pub step: Option<f64>,
    /// One distance everywhere.
    pub even: bool,
}

impl Making<'_> {
    /// The passes along a parameter (0: u).
    fn fronts(&self, axis: usize) -> Result<Vec<Front>, String> {
        let rule = self.step.map_or(Rule::Ridge, Rule::Step);
        let bends =
            Bends { frame: Frame::new(self.tree, self.cutter, self.rim, axis), apart: self.apart, rule };
        if self.even && self.step.is_none() { bends.constant() } else { bends.march() }
    }

    /// The same, as they are laid.
    pub(super) fn passes(&self, axis: usize) -> Result<Passes, String> {
        Ok(Passes::of(&self.fronts(axis)?))
    }

    /// Their length with ridges or steps so much coarser, mm.
    pub(super) fn tried(&self, axis: usize, coarse: &Apart) -> Result<f64, String> {
        let step = self.step.map(|s| TRIAL_STEP * s);
        let fronts = Making { apart: coarse, step, ..*self }.fronts(axis)?;
        Ok(fronts.iter().map(|front| front.lane.length()).sum())
    }
}

impl Passes {
    fn of(fronts: &[Front]) -> Passes {
        const NEAR: usize = 12;
        let places: Vec<Vec<Option<Point2>>> = fronts.iter().map(|f| f.lane.track.places.clone()).collect();
        let room = |j: usize| {
            let beside = [j.checked_sub(1), Some(j + 1)].into_iter().flatten().filter_map(|i| places.get(i));
            let beside: Vec<&Vec<Option<Point2>>> = beside.collect();
            let own = |k: usize| {
                let Some(p) = places[j][k] else { return f64::NAN };
                let near = k.saturating_sub(NEAR)..(k + NEAR).min(COLUMNS - 1);
                let gaps = beside
                    .iter()
                    .flat_map(|line| near.clone().filter_map(|i| Some(away(line[i]?, line[i + 1]?, p))));
                gaps.fold(f64::INFINITY, f64::min)
            };
            (0..COLUMNS).map(own).collect()
        };
        let room = (0..places.len()).map(room).collect();
        Passes { places, room, length: fronts.iter().map(|f| f.lane.length()).sum() }
    }
}

/// Distance of a point from a straight way in plan.
fn away(a: Point2, b: Point2, p: Point2) -> f64 {
    let flat = |p: Point2| Point3::new(p.x, p.y, 0.0);
    (flat(p) - nearest_on_way(flat(a), flat(b), flat(p))).norm()
}

impl Bends<'_> {
    /// All passes.
    fn march(&self) -> Result<Vec<Front>, String> {
        let mut spent = 0;
        let mut fronts = vec![self.first(&mut spent)?];
        while let Some(next) = self.next(&fronts[fronts.len() - 1], &mut spent)? {
            fronts.push(next);
            if fronts.len() > MOST_PASSES || spent > MOST {
                return Err("this asks for too many passes".into());
            }
        }
        Ok(fronts)
    }

    /// The largest constant distance whose ridges are nowhere higher than asked for.
    fn constant(&self) -> Result<Vec<Front>, String> {
        const ROUNDS: u32 = 10;
        const ENOUGH: f64 = 0.9;
        let mut step = 0.7 * self.apart.widest();
        let (mut good, mut bad): (Option<(f64, Vec<Front>)>, f64) = (None, f64::INFINITY);
        for _ in 0..ROUNDS {
            let bends = Bends { frame: self.frame.again(), apart: self.apart, rule: Rule::Step(step) };
            let fronts = bends.march()?;
            let worst = bends.highest(&fronts);
            if worst <= 1.0 {
                if worst >= ENOUGH || bad < 1.05 * step {
                    return Ok(fronts);
                }
                good = Some((step, fronts));
            } else {
                bad = step;
            }
            let low = good.as_ref().map_or(0.0, |g| g.0);
            let wanted = step * math::pow(GOAL / worst.max(1e-9), POWER).clamp(0.2, 2.0);
            step = if bad.is_finite() {
                wanted.clamp(low + 0.1 * (bad - low), bad - 0.1 * (bad - low))
            } else {
                wanted
            };
            step = step.min(self.apart.widest());
            if step < CLOSEST || good.is_some() && step <= low {
                break;
            }
        }
        good.map(|g| g.1).ok_or_else(|| "no constant distance of passes keeps this height of cusps".into())
    }

    /// The highest ridge between passes and before the first of them, as a share of what is allowed.
    fn highest(&self, fronts: &[Front]) -> f64 {
        let none = vec![0.0; COLUMNS];
        let gap = |k: usize| {
            let (own, before) = (&fronts[k], k.checked_sub(1).map(|j| &fronts[j]));
            let open: Vec<bool> = own.line.iter().map(|at| !at.is_nan()).collect();
            let from = before.map_or(&none, |f| &f.line);
            let before = before.map(|f| &f.lane);
            let gap = Gap { before, own: &own.lane, from, line: &own.line, open: &open };
            self.ridges(&gap, true, &mut 0).into_iter().fold(0.0, f64::max)
        };
        (0..fronts.len()).into_par_iter().map(gap).reduce(|| 0.0, f64::max)
    }

    /// A first distance of passes, mm.
    fn guess(&self) -> f64 {
        match self.rule {
            Rule::Ridge => 2.0 * (2.0 * self.apart.hull.radius() * self.apart.cusp).sqrt(),
            Rule::Step(step) => step,
        }
    }

    /// The first pass: between it and the border no more is left than between two.
    fn first(&self, spent: &mut usize) -> Result<Front, String> {
        let from = vec![0.0; COLUMNS];
        let step = vec![0.5 * self.guess(); COLUMNS];
        let mut front = match self.rule {
            Rule::Ridge => self.moved(None, (&[true; COLUMNS], &from), step, spent),
            Rule::Step(_) => None,
        };
        if front.is_none() {
            let lane = self.apart.lane(0.0, self.frame.strip(&from), None);
            front = Some(Front { line: from, lane, step: vec![self.guess(); COLUMNS] });
        }
        let mut front = front.ok_or("no pass meets the surface")?;
        front.step = vec![self.guess(); COLUMNS];
        Ok(front)
    }

    /// The pass after one; `None` where nothing is left up to the border.
    fn next(&self, front: &Front, spent: &mut usize) -> Result<Option<Front>, String> {
        let done = self.done(front, spent);
        let left = |k: usize| done.get(k).is_some_and(|d| !d);
        let open: [bool; COLUMNS] = core::array::from_fn(|k| {
            // A column more on either side: the pass covers what is left to its very end.
            let near = k.checked_sub(1).is_some_and(left) || left(k) || left(k + 1);
            near && !front.line[k].is_nan()
        });
        if !open.contains(&true) {
            return Ok(None);
        }
        match self.moved(Some(&front.lane), (&open, &front.line), front.step.clone(), spent) {
            Some(next) => Ok(Some(next)),
            None => Err(format!(
                "no distance of passes keeps this height of cusps: {}",
                self.apart.place(&front.lane)
            )),
        }
    }

    /// The columns at which a pass leaves nothing to do up to the border, or has ended.
    fn done(&self, front: &Front, spent: &mut usize) -> Vec<bool> {
        let width = self.frame.width();
        let rest = |k: usize| width - front.line[k];
        let ended = |k: usize| front.line[k].is_nan() || rest(k) <= CLOSEST;
        let Rule::Ridge = self.rule else {
            return (0..COLUMNS).map(|k| ended(k) || rest(k) <= 1e-3 * front.step[k]).collect();
        };
        let near: Vec<bool> = (0..COLUMNS).map(|k| !ended(k) && rest(k) < 0.8 * front.step[k]).collect();
        let mut used = vec![f64::INFINITY; COLUMNS];
        if near.contains(&true) {
            let widest = (0..COLUMNS).filter(|k| near[*k]).map(rest).fold(0.0, f64::max);
            let places = self.apart.places(widest);
            let mut found = vec![0.0; COLUMNS];
            for i in 1..=places {
                let share = count(i) / count(places);
                let at = |k: usize| if near[k] { front.line[k] + rest(k) * share } else { f64::NAN };
                let strip = self.frame.strip(&(0..COLUMNS).map(at).collect());
                pool(&self.apart.left_along(&strip, [Some(&front.lane), None], 0.0, spent), &mut found);
            }
            (0..COLUMNS).filter(|k| near[*k]).for_each(|k| used[k] = found[k] / (AIM * self.apart.cusp));
        }
        (0..COLUMNS).map(|k| ended(k) || used[k] <= 1.0).collect()
    }

    /// A pass so far from another that what it may use is used up, or at the border.
    fn moved(
        &self,
        before: Option<&Lane<Strip>>,
        (open, from): (&[bool; COLUMNS], &Line),
        mut step: Line,
        spent: &mut usize,
    ) -> Option<Front> {
        let (width, widest) = (self.frame.width(), self.apart.widest());
        let limit = if matches!(self.rule, Rule::Ridge) { widest } else { width };
        let mut best: Option<(f64, Front)> = None;
        // At first half way between the passes only, where ridges are high.
        let mut full = false;
        for round in 0..TRIES {
            step.iter_mut().for_each(|s| *s = s.clamp(CLOSEST, limit));
            let line = self.placed(open, from, &step, if round < FAIR { FAIRINGS.1 } else { 0 });
            let lane = self.apart.lane(0.0, self.frame.strip(&line), before);
            *spent += lane.stations.len();
            let between = |full: bool, spent: &mut usize| {
                self.used(&Gap { before, own: &lane, from, line: &line, open }, full, spent)
            };
            let mut used = between(full, spent);
            let columns = || (0..COLUMNS).filter(|k| open[*k]);
            let highest = |used: &Line| columns().map(|k| used[k]).fold(0.0, f64::max);
            let mut worst = highest(&used);
            if worst <= 1.0 && !full {
                full = true;
                used = between(full, spent);
                worst = highest(&used);
            }
            let gone = |k: usize| line[k] - from[k];
            let at_last = columns().all(|k| line[k] >= width || gone(k) >= 0.99 * limit);
            let needs = smooth(&used, SMOOTH);
            let next = |range: (f64, f64), need: &dyn Fn(usize) -> f64| -> Line {
                let at = |k: usize| match open[k] {
                    false => step[k],
                    // What lies on the border cannot go on.
                    true if line[k] >= width && need(k) < 1.0 => step[k].max(gone(k)),
                    true => {
                        gone(k).max(CLOSEST)
                            * math::pow(GOAL / need(k).max(1e-6), POWER).clamp(range.0, range.1)
                    }
                };
                (0..COLUMNS).map(at).collect()
            };
            let own = |k: usize| if round < FREE { needs[k] } else { worst };
            let moved = next((0.4, 1.7), &own);
            if worst <= 1.0 {
                let way = columns().map(gone).sum::<f64>();
                let stop = at_last || worst >= NEAR || best.is_some();
                if best.as_ref().is_none_or(|b| way > b.0) {
                    let step = next((0.8, 1.25), &|k| needs[k]);
                    best = Some((way, Front { line: line.clone(), lane, step }));
                }
                if stop {
                    break;
                }
            } else if best.is_some() {
                break;
            }
            step = moved;
        }
        best.map(|b| b.1)
    }

    /// A line so many steps from another, where it is open: fair, not too steep, and no farther than the border.
    fn placed(&self, open: &[bool; COLUMNS], from: &Line, step: &Line, fairings: u32) -> Line {
        let wanted: Line = (0..COLUMNS).map(|k| if open[k] { step[k] } else { f64::NAN }).collect();
        // The least of the steps about a column: made fair, they are no larger than what they are made of.
        let least = |k: usize| {
            let near = &wanted[k.saturating_sub(LEAST)..(k + LEAST + 1).min(COLUMNS)];
            if open[k] { near.iter().copied().fold(f64::INFINITY, f64::min) } else { f64::NAN }
        };
        let mut line: Line = (0..COLUMNS).map(least).collect();
        (0..FAIRINGS.0).for_each(|_| faired(&mut line));
        line.iter_mut().zip(from).for_each(|(own, from)| *own += from);
        let rise = SLOPE * self.frame.apart;
        let lower = |own: f64, beside: f64| {
            if own.is_nan() || beside.is_nan() { own } else { own.min(beside + rise) }
        };
        for k in 1..COLUMNS {
            line[k] = lower(line[k], line[k - 1]);
        }
        for k in (1..COLUMNS).rev() {
            line[k - 1] = lower(line[k - 1], line[k]);
        }
        (0..fairings).for_each(|_| faired(&mut line));
        let width = self.frame.width();
        for k in (0..COLUMNS).filter(|k| open[*k]) {
            line[k] = line[k].clamp(from[k], width);
        }
        line
    }

    /// What is used of what is allowed between two passes, or before the first, at every column.
    fn used(&self, gap: &Gap<'_>, full: bool, spent: &mut usize) -> Line {
        match self.rule {
            Rule::Ridge => self.ridges(gap, full, spent),
            Rule::Step(step) => distances(gap, step),
        }
    }

    /// The ridges; half way between the passes only unless all of it is asked for.
    fn ridges(&self, gap: &Gap<'_>, full: bool, spent: &mut usize) -> Line {
        let mut used = vec![0.0; COLUMNS];
        let wide = |k: usize| if gap.open[k] { gap.line[k] - gap.from[k] } else { 0.0 };
        let places = self.apart.places((0..COLUMNS).map(wide).fold(0.0, f64::max));
        // Before the first pass the border itself counts.
        let (first, middle) = (usize::from(gap.before.is_some()), places.div_ceil(2));
        for i in if full { first..=places } else { middle..=middle } {
            let share = count(i) / count(places + 1);
            let at = |k: usize| if gap.open[k] { gap.from[k] + wide(k) * share } else { f64::NAN };
            let strip = self.frame.strip(&(0..COLUMNS).map(at).collect());
            pool(&self.apart.left_along(&strip, [gap.before, Some(gap.own)], 0.0, spent), &mut used);
        }
        if let Some(before) = gap.before {
            pool(&self.apart.inside(before, gap.own), &mut used);
        }
        used.iter_mut().for_each(|u| *u /= AIM * self.apart.cusp);
        used
    }
}

/// Two passes, or the border and the first one.
struct Gap<'a> {
    before: Option<&'a Lane<Strip>>,
    own: &'a Lane<Strip>,
    from: &'a Line,
    line: &'a Line,
    open: &'a [bool],
}

/// How far one pass is from the other, as a share of a step.
fn distances(gap: &Gap<'_>, step: f64) -> Line {
    let mut used = vec![0.0; COLUMNS];
    let Some(before) = gap.before else { return used };
    let far = |s: &Station| {
        let centre = s.contact?.centre;
        let chords = before.way.windows(2).filter_map(|w| Some((w[0].1?, w[1].1?)));
        let gaps = chords.map(|(a, b)| {
            let foot = nearest_on_way(a, b, centre) - centre;
            (foot.norm(), foot.xy().norm())
        });
        let least = |(a, b): (f64, f64), (c, d): (f64, f64)| (a.min(c), b.min(d));
        let (space, plan) = gaps.fold((f64::INFINITY, f64::INFINITY), least);
        Some((s.share, space.min(LEAP * plan) / step))
    };
    let found: Vec<(f64, f64)> = gap.own.stations.iter().filter_map(far).collect();
    pool(&found, &mut used);
    used
}

impl Frame {
    fn again(&self) -> Frame {
        Frame::new(&self.tree, self.cutter, self.rim, self.axis)
    }
}

/// The largest of values at shares, at each of the columns about them.
fn pool(found: &[(f64, f64)], columns: &mut [f64]) {
    for (share, value) in found {
        // Shares lie in 0..=1, and floats saturate.
        let k = (share * count(COLUMNS - 1)).round() as usize;
        for own in &mut columns[k.saturating_sub(AROUND)..(k + AROUND + 1).min(COLUMNS)] {
            *own = own.max(*value);
        }
    }
}
