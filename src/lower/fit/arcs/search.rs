//! How many arcs: insert where the band is missed, take away where there is slack, keep the fewest.

use super::chain::{Chain, Drawn, Goal, Hold, Joint, Member, arc_measure};
use super::optimise::{Stop, improve};
use super::start::{Density, least, spread};
use super::stretch::{Stretch, turn};

/// Share of the band's half width that the arcs before rounding may use.
const SHARE: f64 = 0.97;
/// Iterations while looking for the count.
const SEARCH_ITERATIONS: usize = 24;
/// Iterations of the last polish.
const POLISH_ITERATIONS: usize = 16;
/// Arcs whose deviation is at least this share of the worst are active.
const ACTIVE: f64 = 0.9;

/// Fewest arcs found for a stretch, polished; with the largest distance from the middle of the band, mm.
pub(super) fn fewest(stretch: &Stretch<'_>, goal: &Goal, ends: Option<[Joint; 2]>) -> Option<(Chain, f64)> {
    let n = first_count(stretch, goal);
    let limit = SHARE * goal.band.half;
    let mut best: Option<(Chain, f64)> = None;
    for phase in [0.5, 0.0] {
        let density = density(stretch, n);
        let mut chain = spread(stretch, &density, n, phase, goal.band.middle);
        if let Some([a, b]) = ends {
            let last = chain.joints.len() - 1;
            chain.joints[0] = a;
            chain.joints[last] = b;
        }
        let most = best.as_ref().map_or(4 * n + 40, |(c, _)| c.len());
        let Some((chain, worst)) = grow(chain, stretch, goal, limit, most) else { continue };
        let (chain, worst) = shrink(chain, worst, stretch, goal, limit);
        if best.as_ref().is_none_or(|(c, _)| chain.len() < c.len()) {
            best = Some((chain, worst));
        }
    }
    let (chain, _) = best?;
    let stop = Stop { target: 0.0, iterations: POLISH_ITERATIONS, gain: 2e-3 };
    Some(improve(chain, stretch, goal, &stop))
}

fn density(stretch: &Stretch<'_>, n: usize) -> Density {
    Density::new(stretch, stretch.length() / (4.0 * n as f64))
}

/// Asymptotic count: ∫|k'|^(1/3) ds / (72√3 δ)^(1/3).
fn first_count(stretch: &Stretch<'_>, goal: &Goal) -> usize {
    let unit = crate::math::cbrt(72.0 * 1.732_050_8 * goal.band.half);
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
    let stop = Stop { target: limit, iterations: SEARCH_ITERATIONS, gain: 5e-3 };
    loop {
        let (next, worst) = improve(chain, stretch, goal, &stop);
        if worst <= limit {
            return Some((next, worst));
        }
        if next.len() >= most {
            return None;
        }
        chain = insert(next, stretch, goal, worst);
    }
}

/// Takes arcs away where there is slack, as long as the band can be kept.
fn shrink(mut chain: Chain, mut worst: f64, stretch: &Stretch<'_>, goal: &Goal, limit: f64) -> (Chain, f64) {
    let stop = Stop { target: limit, iterations: SEARCH_ITERATIONS, gain: 5e-3 };
    let floor = least(stretch);
    loop {
        if chain.len() <= floor.max(3) {
            return (chain, worst);
        }
        let Some(fewer) = remove(&chain, stretch, goal) else { return (chain, worst) };
        let (next, found) = improve(fewer, stretch, goal, &stop);
        if found > limit {
            return (chain, worst);
        }
        (chain, worst) = (next, found);
    }
}

/// One more arc in the run of active arcs about the worst one.
fn insert(chain: Chain, stretch: &Stretch<'_>, goal: &Goal, _worst: f64) -> Chain {
    let n = chain.len();
    let measures: Vec<f64> = (0..n).map(|i| arc_measure(&chain, stretch, goal, i)).collect();
    let (worst_arc, worst) =
        measures.iter().enumerate().fold((0, 0.0), |(i, m), (j, &v)| if v > m { (j, v) } else { (i, m) });
    let active = |i: usize| measures[i] >= ACTIVE * worst;
    let (mut first, mut count) = (worst_arc, 1);
    while count < n && (chain.closed || first + count < n) && active((first + count) % n) {
        count += 1;
    }
    while count < n && (chain.closed || first > 0) && active((first + n - 1) % n) {
        first = (first + n - 1) % n;
        count += 1;
    }
    respread(&chain, stretch, first, count, count + 1)
}

/// One arc fewer in the window with the most slack.
fn remove(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal) -> Option<Chain> {
    let n = chain.len();
    let width = 4.min(n);
    let measures: Vec<f64> = (0..n).map(|i| arc_measure(chain, stretch, goal, i)).collect();
    let starts = if chain.closed { n } else { n + 1 - width };
    let (first, _) = (0..starts)
        .map(|i| {
            (
                i,
                (0..width)
                    .map(|j| {
                        let m = measures[(i + j) % n];
                        m * m
                    })
                    .sum::<f64>(),
            )
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(respread(chain, stretch, first, width, width - 1))
}

/// Replaces `count` arcs from arc `first` on by `new` arcs at equal shares of the density.
fn respread(chain: &Chain, stretch: &Stretch<'_>, first: usize, count: usize, new: usize) -> Chain {
    let n = chain.len();
    let mut rotated = rotate(chain, stretch, first);
    let first = if chain.closed { 0 } else { first };
    let d = density(stretch, n);
    let total = d.total();
    let share = |s: f64| {
        let laps = if stretch.closed { (s / stretch.length()).floor() } else { 0.0 };
        let w = s - laps * stretch.length();
        let j = stretch.interval(stretch.wrap(w));
        let (a, b) = (&stretch.samples[j], &stretch.samples[j + 1]);
        let f = (w - a.s) / (b.s - a.s);
        laps + (d.sums[j] + f * (d.sums[j + 1] - d.sums[j])) / total
    };
    let from = share(rotated.joints[first].s);
    let to = share(rotated.station_after(stretch, first + count - 1));
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
    for joint in &mut out.joints[n - first..] {
        joint.s += stretch.length();
    }
    out
}
