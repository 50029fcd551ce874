//! Fewer arcs than a chain has: from new starts over the whole stretch, and by taking an arc out of short windows.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::chain::{Chain, Goal, Hold, Joint, Member, measure};
use super::optimise::{Stop, improve};
use super::search::{
    SEARCH_ITERATIONS, WINDOW as OUT, Wish, measures, respread, rotate, settle, slack, with_ends,
};
use super::start::{least, spread};
use super::stretch::Stretch;

/// Shifts of the joints that are tried over the whole stretch, in arcs; the first finds most of what the others find.
const PHASES: [f64; 4] = [0.5, 0.25, 0.0, 0.75];
/// Windows per arc in which the density of joints is smoothed for these starts.
const WINDOWS: usize = 8;
/// Places where an arc is taken out of a whole chain.
const PLACES: usize = 3;
/// Chains up to this length are searched as a whole.
const WHOLE: usize = 40;
/// How many arcs fewer are tried from new starts.
const DEEP: usize = 4;
/// Chains up to this length are tried to the depth; longer ones as long as there is hope:
const SMALL: usize = 10;
/// a count may be better by this factor than the one above it and the third power say.
const LUCK: f64 = 0.85;
/// Chains longer than this are searched by windows.
const LONG: usize = 24;
/// Arcs of a window.
const WINDOW: usize = 7;
/// Arcs between neighbouring windows.
const STRIDE: usize = 3;
/// Arcs flatter than this are not slid along, 1/mm.
const FLAT: f64 = 1e-7;

fn stop(limit: f64) -> Stop {
    Stop { target: limit, iterations: SEARCH_ITERATIONS, gain: 5e-3, smooth: true }
}

/// The shortest chain found from a chain that keeps `limit`, with its largest distance from the middle.
pub(super) fn descend(
    mut chain: Chain,
    mut worst: f64,
    stretch: &Stretch<'_>,
    wish: &Wish,
    limit: f64,
) -> (Chain, f64) {
    let floor = least(stretch).max(if stretch.closed { 2 } else { 1 });
    let mut tried = Vec::new();
    while chain.len() > floor {
        let Some(next) = fewer(&chain, stretch, wish, limit, floor, &mut tried) else { break };
        (chain, worst) = next;
    }
    if chain.len() > LONG {
        chain = windows(chain, stretch, &wish.goal, limit);
        worst = measure(&chain, stretch, &wish.goal);
    }
    (chain, worst)
}

/// A chain of one or a few arcs fewer; `tried` are the counts that have been tried with the least found for them.
fn fewer(
    chain: &Chain,
    stretch: &Stretch<'_>,
    wish: &Wish,
    limit: f64,
    floor: usize,
    tried: &mut Vec<(usize, f64)>,
) -> Option<(Chain, f64)> {
    let n = chain.len();
    let candidates = without_one(chain, stretch, &wish.goal);
    let shorter = first_within(limit, candidates, |c| improve(c, stretch, &wish.goal, &stop(limit)));
    let mut least = match shorter {
        Ok(found) => return Some(found),
        Err(least) => least,
    };
    if n > WHOLE || wish.exact {
        return None;
    }
    for count in (floor.max(n.saturating_sub(DEEP))..n).rev() {
        if !tried.iter().any(|(c, _)| *c == count) {
            match anew(stretch, wish, limit, count) {
                Ok(found) => return Some(found),
                Err(worst) => tried.push((count, worst.min(least))),
            }
        }
        let found = tried.iter().find(|(c, _)| *c == count).map_or(least, |(_, w)| *w);
        let ratio = count as f64 / (count as f64 - 1.0).max(0.5);
        if n > SMALL && LUCK * found * ratio * ratio * ratio > limit {
            break;
        }
        least = f64::INFINITY;
    }
    None
}

/// A chain of `count` arcs from one of several starts, or the least deviation from the middle of the band found.
fn anew(stretch: &Stretch<'_>, wish: &Wish, limit: f64, count: usize) -> Result<(Chain, f64), f64> {
    let density = stretch.density(WINDOWS * count);
    first_within(limit, PHASES.to_vec(), |phase| {
        let start = with_ends(spread(stretch, &density, count, phase, wish.goal.band.middle), wish);
        settle(start, stretch, &wish.goal, limit)
    })
}

/// The first trial, in their order, that keeps the limit, or the least deviation of all; on all threads.
fn first_within<T: Send>(
    limit: f64,
    trials: Vec<T>,
    run: impl Fn(T) -> (Chain, f64) + Sync,
) -> Result<(Chain, f64), f64> {
    let tried = trials.into_par_iter().map(|trial| {
        let (chain, found) = run(trial);
        if found <= limit { Ok((chain, found)) } else { Err(found) }
    });
    let least = Mutex::new(f64::INFINITY);
    let kept = tried.find_map_first(|result| match result {
        Ok(found) => Some(found),
        Err(found) => {
            let mut least = least.lock().unwrap_or_else(PoisonError::into_inner);
            *least = least.min(found);
            None
        }
    });
    kept.ok_or_else(|| least.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// The chain with an arc taken out, at the places with the most slack.
fn without_one(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal) -> Vec<Chain> {
    let n = chain.len();
    let width = OUT.min(n);
    let measures = measures(chain, stretch, goal);
    let mut chosen: Vec<usize> = Vec::new();
    for i in slack(chain, &measures, width) {
        let apart = |&j: &usize| (i + n - j) % n >= width / 2 && (j + n - i) % n >= width / 2;
        if chosen.len() < PLACES && chosen.iter().all(apart) {
            chosen.push(i);
        }
    }
    chosen.into_iter().filter(|_| width > 1).map(|i| respread(chain, stretch, i, width, width - 1)).collect()
}

/// Takes arcs out of short windows, the arcs beside a window sliding along themselves.
fn windows(mut chain: Chain, stretch: &Stretch<'_>, goal: &Goal, limit: f64) -> Chain {
    let mut at = 0;
    let mut tried = 0;
    while tried < chain.len() + STRIDE && chain.len() > WINDOW + 2 {
        let n = chain.len();
        if !chain.closed && at + WINDOW + 2 > n {
            break;
        }
        match window(&chain, stretch, goal, limit, at % n) {
            Some(shorter) => {
                chain = shorter;
                tried = 0;
                at = (at + chain.len() - STRIDE.min(chain.len())) % chain.len();
                if !chain.closed {
                    at = 0;
                }
            }
            None => {
                at += STRIDE;
                tried += STRIDE;
            }
        }
    }
    chain
}

/// The chain with one arc fewer among the [`WINDOW`] arcs after arc `first`, when that keeps the limit.
fn window(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal, limit: f64, first: usize) -> Option<Chain> {
    let whole = rotate(chain, stretch, first);
    let first = if chain.closed { 0 } else { first };
    let last = first + WINDOW + 1;
    let free = |i: usize| matches!(whole.members[i], Member::Arc(_));
    if last >= whole.len() || !(first..=last).all(free) {
        return None;
    }
    let (before, after) = (held(&whole, first)?, held(&whole, last)?);
    let mut joints: Vec<Joint> = whole.joints[first..=last].to_vec();
    joints.push(end_of(&whole, stretch, last));
    let count = joints.len();
    let mut members = whole.members[first..=last].to_vec();
    (members[0], members[count - 2]) = (before, after);
    joints[0].hold = Hold::Vertex;
    joints[count - 1].hold = Hold::Vertex;
    for (member, joint) in [(before, 1), (after, count - 2)] {
        if let Member::Exact { centre, .. } = member {
            let (from, to) = (joints[0].s, joints[count - 1].s);
            let room = 0.02 * (to - from) / count as f64;
            joints[joint].hold = Hold::Circle { centre, from: from + room, to: to - room };
        }
    }
    let part = Chain { joints, members, closed: false };
    let start = respread(&part, stretch, 1, WINDOW, WINDOW - 1);
    let (part, found) = improve(start, stretch, goal, &stop(limit));
    if found > limit {
        return None;
    }
    let shorter = spliced(&whole, first, last, &part)?;
    (measure(&shorter, stretch, goal) <= limit).then_some(shorter)
}

/// The member that keeps arc i on its circle.
fn held(chain: &Chain, i: usize) -> Option<Member> {
    let d = chain.drawn(i);
    let k = d.curvature();
    (k.abs() > FLAT).then(|| {
        let circle = d.circle();
        Member::Exact { centre: circle.p + circle.n / k, ccw: k > 0.0 }
    })
}

/// The joint at the end of arc i, its station unwrapped.
fn end_of(chain: &Chain, stretch: &Stretch<'_>, i: usize) -> Joint {
    Joint { s: chain.station_after(stretch, i), ..chain.joints[chain.end(i)] }
}

/// The chain with arcs first..=last replaced by those of `part`.
fn spliced(whole: &Chain, first: usize, last: usize, part: &Chain) -> Option<Chain> {
    let mut out = whole.clone();
    let inner = part.joints.get(1..part.joints.len() - 1)?;
    out.joints.splice(first + 1..=last, inner.iter().map(|q| Joint { hold: Hold::Free, ..*q }));
    let members = part.members.iter().enumerate().map(|(i, m)| match m {
        Member::Exact { .. } => Member::Arc(part.drawn(i).half),
        other => *other,
    });
    out.members.splice(first..=last, members);
    Some(out)
}
