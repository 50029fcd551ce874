//! How many arcs: insert where the band is missed, take away where there is slack, keep the fewest.

use std::sync::Arc;

use super::chain::{Chain, Drawn, Goal, Hold, Joint, Member, arc_measure};
use super::descend::descend;
use super::exact::{self, Keep};
use super::optimise::{Stop, improve};
use super::start::{Density, least, spread};
use super::stretch::{Stretch, turn};

/// Share of the band's half width that the arcs before rounding may use.
const SHARE: f64 = 0.97;
/// Iterations while looking for the count.
pub(super) const SEARCH_ITERATIONS: usize = 24;
/// Iterations of the last polish.
const POLISH_ITERATIONS: usize = 16;
/// Windows per arc in which the density of joints is smoothed.
const WINDOWS: usize = 4;
/// Arcs in which one is taken away.
pub(super) const WINDOW: usize = 4;
/// Exchanges of arcs between places for one number of arcs.
const EXCHANGES: usize = 3;
/// Arcs whose deviation is at least this share of the worst are active.
const ACTIVE: f64 = 0.9;

/// What the search is asked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wish {
    /// Band and tangents.
    pub goal: Goal,
    /// Fixed ends of an open stretch.
    pub ends: Option<[Joint; 2]>,
    /// Circular spans stay as they are.
    pub exact: bool,
    /// Flatter arcs become lines, mm.
    pub radius: f64,
}

/// Fewest arcs found for a stretch, polished; with the largest distance from the middle of the band, mm.
pub(super) fn fewest(stretch: &Stretch<'_>, wish: &Wish) -> Option<(Chain, f64)> {
    let goal = &wish.goal;
    let limit = SHARE * goal.band.half;
    let n = first_count(stretch, goal);
    let density = density(stretch, n);
    let keep = |keep: Keep| {
        let unit = cube_unit(goal);
        exact::chain(stretch, &density, unit, &goal.band, keep).map(|c| with_ends(c, wish))
    };
    let mut best: Option<(Chain, f64)> = None;
    let mut try_from = |chain: Chain| {
        let most = best.as_ref().map_or(4 * chain.len() + 40, |(c, _)| c.len());
        if chain.len() >= most && best.as_ref().is_some_and(|(_, w)| *w > 1e-3 * limit) {
            return;
        }
        let Some((chain, worst)) = grow(chain, stretch, goal, limit, most) else { return };
        let (chain, worst) = descend(chain, worst, stretch, wish, limit);
        let better = |(c, w): &(Chain, f64)| (chain.len(), worst) < (c.len(), *w);
        if best.as_ref().is_none_or(better) {
            best = Some((chain, worst));
        }
    };
    if wish.exact && exact::kept(stretch, Keep::Arcs).0 {
        keep(Keep::Arcs).into_iter().for_each(&mut try_from);
    } else {
        try_from(with_ends(spread(stretch, &density, n, 0.0, goal.band.middle), wish));
        if exact::kept(stretch, Keep::ArcsAndLines).0
            && let Some(chain) = keep(Keep::ArcsAndLines)
        {
            try_from(chain);
        }
    }
    let (chain, _) = best?;
    let stop = Stop { target: 0.0, iterations: POLISH_ITERATIONS, gain: 2e-3, smooth: true };
    let (chain, worst) = improve(chain, stretch, goal, &stop);
    Some(straightened(chain, worst, stretch, wish, &stop))
}

pub(super) fn with_ends(mut chain: Chain, wish: &Wish) -> Chain {
    if let Some([a, b]) = wish.ends {
        let last = chain.joints.len() - 1;
        chain.joints[0] = a;
        chain.joints[last] = b;
    }
    chain
}

/// Turns arcs flatter than allowed into lines and improves what is left; the chain as it was when that fails.
fn straightened(chain: Chain, worst: f64, stretch: &Stretch<'_>, wish: &Wish, stop: &Stop) -> (Chain, f64) {
    let mut straight = chain.clone();
    for i in 0..straight.len() {
        if !straight.is_exact(i) && straight.drawn(i).curvature().abs() * wish.radius < 1.0 {
            straight.members[i] = Member::Line;
        }
    }
    if straight.members == chain.members {
        return (chain, worst);
    }
    let (straight, found) = improve(straight, stretch, &wish.goal, stop);
    if found <= wish.goal.band.half { (straight, found) } else { (chain, worst) }
}

/// Integral of the density over one optimal arc: (72√3 δ)^(1/3).
fn cube_unit(goal: &Goal) -> f64 {
    crate::math::cbrt(72.0 * 1.732_050_8 * goal.band.half)
}

fn density(stretch: &Stretch<'_>, n: usize) -> Arc<Density> {
    stretch.density(WINDOWS * n)
}

/// Asymptotic count: ∫|k'|^(1/3) ds / (72√3 δ)^(1/3).
fn first_count(stretch: &Stretch<'_>, goal: &Goal) -> usize {
    let unit = cube_unit(goal);
    let mut n = least(stretch);
    for _ in 0..3 {
        n = ((density(stretch, n).total() / unit).floor() as usize).max(least(stretch));
    }
    n
}

/// Adds arcs until the band is kept.
fn grow(
    mut chain: Chain,
    stretch: &Stretch<'_>,
    goal: &Goal,
    limit: f64,
    most: usize,
) -> Option<(Chain, f64)> {
    loop {
        let (next, worst) = settle(chain, stretch, goal, limit);
        if worst <= limit {
            return Some((next, worst));
        }
        if next.len() >= most {
            return None;
        }
        chain = insert(&next, stretch, goal);
    }
}

/// One more arc in the run of active arcs about the worst one.
fn insert(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal) -> Chain {
    let (first, count) = active_run(chain, &measures(chain, stretch, goal));
    respread(chain, stretch, first, count, count + 1)
}

/// First and number of the arcs about the worst one that are nearly as bad.
fn active_run(chain: &Chain, measures: &[f64]) -> (usize, usize) {
    let n = chain.len();
    let (worst_arc, worst) =
        measures.iter().enumerate().fold((0, 0.0), |(i, m), (j, &v)| if v > m { (j, v) } else { (i, m) });
    let active = |i: usize| measures[i] >= ACTIVE * worst && !chain.is_exact(i);
    let (mut first, mut count) = (worst_arc, 1);
    while count < n && (chain.closed || first + count < n) && active((first + count) % n) {
        count += 1;
    }
    while count < n && (chain.closed || first > 0) && active((first + n - 1) % n) {
        first = (first + n - 1) % n;
        count += 1;
    }
    (first, count)
}

/// The windows of `width` arcs by ascending deviation.
pub(super) fn slack(chain: &Chain, measures: &[f64], width: usize) -> Vec<usize> {
    let n = chain.len();
    let starts = if chain.closed { n } else { (n + 1).saturating_sub(width) };
    let mut places: Vec<(usize, f64)> = (0..starts)
        .filter(|&i| (0..width).all(|j| !chain.is_exact((i + j) % n)))
        .map(|i| (i, (0..width).map(|j| measures[(i + j) % n] * measures[(i + j) % n]).sum()))
        .collect();
    places.sort_by(|a, b| a.1.total_cmp(&b.1));
    places.into_iter().map(|(i, _)| i).collect()
}

/// The same number of arcs, one more where the deviation is worst and one fewer where it is least.
fn exchanged(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal) -> Option<Chain> {
    let n = chain.len();
    let measures = measures(chain, stretch, goal);
    let (first, count) = active_run(chain, &measures);
    let width = WINDOW.min(n);
    let apart = |i: usize| (0..width).all(|j| ((i + j) % n + n - first) % n >= count);
    let from = slack(chain, &measures, width).into_iter().find(|&i| width > 1 && apart(i))?;
    let grown = respread(chain, stretch, first, count, count + 1);
    // A closed chain is counted from arc `first` now.
    let moved = match (chain.closed, from > first) {
        (true, _) => (from + n - first) % n + 1,
        (false, true) => from + 1,
        (false, false) => from,
    };
    Some(respread(&grown, stretch, moved, width, width - 1))
}

/// Improves a chain to the limit, exchanging arcs between places while that helps.
pub(super) fn settle(chain: Chain, stretch: &Stretch<'_>, goal: &Goal, limit: f64) -> (Chain, f64) {
    let stop = Stop { target: limit, iterations: SEARCH_ITERATIONS, gain: 5e-3, smooth: true };
    let (mut chain, mut worst) = improve(chain, stretch, goal, &stop);
    for _ in 0..EXCHANGES {
        if worst <= limit {
            break;
        }
        let Some(other) = exchanged(&chain, stretch, goal) else { break };
        let (other, found) = improve(other, stretch, goal, &stop);
        if found >= worst {
            break;
        }
        (chain, worst) = (other, found);
    }
    (chain, worst)
}

/// How bad every arc is: its distance from the middle of the band and the tangent errors at its ends.
pub(super) fn measures(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal) -> Vec<f64> {
    let weight = goal.band.half / goal.tangent;
    (0..chain.len())
        .map(|i| {
            let kinks = chain.kink(i).abs().max(chain.kink(chain.end(i)).abs());
            if chain.is_exact(i) { 0.0 } else { arc_measure(chain, stretch, goal, i).max(weight * kinks) }
        })
        .collect()
}

/// Replaces `count` arcs from arc `first` on by `new` arcs at equal shares of the density.
pub(super) fn respread(
    chain: &Chain,
    stretch: &Stretch<'_>,
    first: usize,
    count: usize,
    new: usize,
) -> Chain {
    let n = chain.len();
    let mut rotated = rotate(chain, stretch, first);
    let first = if chain.closed { 0 } else { first };
    let d = density(stretch, n);
    let from = d.share(stretch, rotated.joints[first].s);
    let to = d.share(stretch, rotated.station_after(stretch, first + count - 1));
    let inside: Vec<Joint> = (1..new)
        .map(|i| {
            let x = from + (to - from) * i as f64 / new as f64;
            let s = d.station(stretch, x);
            Joint::on(stretch, s, offset_at(&rotated, stretch, s), Hold::Free)
        })
        .collect();
    let last_joint = first + count;
    let end = last_joint.min(rotated.joints.len());
    rotated.joints.splice(first + 1..end, inside);
    rotated.members.splice(first..first + count, std::iter::repeat_n(Member::Arc(0.0), new));
    for i in first..first + new {
        let (a, b) = (rotated.joints[i], rotated.joints[rotated.end(i)]);
        let d = Drawn::new(a.p, b.p, 0.0);
        rotated.members[i] = Member::Arc(0.5 * (turn(a.frame.t, d.chord) + turn(d.chord, b.frame.t)));
    }
    rotated
}

/// Deviation of the chain at station s.
fn offset_at(chain: &Chain, stretch: &Stretch<'_>, s: f64) -> f64 {
    let frame = stretch.at(s);
    let i = (0..chain.len()).rev().find(|&i| chain.joints[i].s <= s).unwrap_or(0);
    let e = chain.drawn(i).circle().deviation(frame.p, frame.n());
    if e.is_finite() { e.clamp(-1.0, 1.0) } else { 0.0 }
}

/// The same closed chain counted from joint `first`; an open chain as it is.
pub(super) fn rotate(chain: &Chain, stretch: &Stretch<'_>, first: usize) -> Chain {
    let mut out = chain.clone();
    if !chain.closed || first == 0 {
        return out;
    }
    out.joints.rotate_left(first);
    out.members.rotate_left(first);
    let n = out.joints.len();
    let lap = stretch.length();
    for joint in &mut out.joints[n - first..] {
        joint.s += lap;
        if let Hold::Circle { from, to, .. } = &mut joint.hold {
            *from += lap;
            *to += lap;
        }
    }
    out
}
