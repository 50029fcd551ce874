//! Fewer arcs than a chain has: from new starts over the whole stretch, and by taking an arc out of short windows.

use super::chain::{Chain, Goal, Hold, Joint, Member, measure};
use super::optimise::{Stop, improve};
use super::search::{
    SEARCH_ITERATIONS, WINDOW as OUT, Wish, density, measures, respread, rotate, settle, slack, with_ends,
};
use super::start::{least, spread};
use super::stretch::Stretch;
use crate::math;

/// Shifts of the joints that are tried over the whole stretch, in arcs.
const PHASES: [f64; 2] = [0.5, 0.0];
/// Places where an arc is taken out of a whole chain.
const PLACES: usize = 3;
/// Chains up to this length are searched as a whole.
const WHOLE: usize = 40;
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
    while chain.len() > floor {
        let Some(next) = fewer(&chain, stretch, wish, limit, floor) else { break };
        (chain, worst) = next;
    }
    if chain.len() > WINDOW + 2 {
        chain = windows(chain, stretch, &wish.goal, limit);
        worst = measure(&chain, stretch, &wish.goal);
    }
    (chain, worst)
}

/// A chain of one or a few arcs fewer.
fn fewer(
    chain: &Chain,
    stretch: &Stretch<'_>,
    wish: &Wish,
    limit: f64,
    floor: usize,
) -> Option<(Chain, f64)> {
    let n = chain.len();
    for candidate in without_one(chain, stretch, &wish.goal) {
        let (next, found) = improve(candidate, stretch, &wish.goal, &stop(limit));
        if found <= limit {
            return Some((next, found));
        }
    }
    if n > WHOLE || wish.exact {
        return None;
    }
    for count in expected(chain, stretch, wish, limit).max(floor)..n {
        if let Some(found) = anew(stretch, wish, limit, count) {
            return Some(found);
        }
    }
    None
}

/// Fewest arcs worth a trial: the deviation falls with the third power of the count.
fn expected(chain: &Chain, stretch: &Stretch<'_>, wish: &Wish, limit: f64) -> usize {
    let polish = Stop { target: 0.0, iterations: 6, gain: 2e-2, smooth: true };
    let (_, worst) = improve(chain.clone(), stretch, &wish.goal, &polish);
    let n = chain.len() as f64;
    let expected = (n * math::cbrt((worst / limit).min(1.0)) - 0.5).ceil() as usize;
    let least = chain.len().saturating_sub(if chain.len() <= 10 { 4 } else { 3 });
    if chain.len() <= 10 { least } else { expected.saturating_sub(1).clamp(least, chain.len() - 2) }
}

/// A chain of `count` arcs from one of several starts.
fn anew(stretch: &Stretch<'_>, wish: &Wish, limit: f64, count: usize) -> Option<(Chain, f64)> {
    let middle = wish.goal.band.middle;
    let density = density(stretch, count);
    for phase in PHASES {
        let start = with_ends(spread(stretch, &density, count, phase, middle), wish);
        let (next, found) = settle(start, stretch, &wish.goal, limit);
        if found <= limit {
            return Some((next, found));
        }
    }
    None
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
