//! Smallest largest deviation of a chain with a given number of arcs: sequential linear minimax programming with a
//! trust region.

use super::chain::{Chain, Goal, Hold, Member, kink_rows, measure, rows};
use super::minimax::{BLOCK, Problem, Row, WIDTH};
use super::stretch::Stretch;

/// When to stop improving.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stop {
    /// Good enough, mm from the middle of the band.
    pub target: f64,
    /// Iterations at most.
    pub iterations: usize,
    /// Relative gain of an iteration that is not worth another.
    pub gain: f64,
    /// Make joints tangent-continuous after every step.
    pub smooth: bool,
}

/// A linear problem whose optimum is beyond one of these multiples of the target gives as little hope to reach it …
const HOPE: [f64; 3] = [1.04, 1.3, 2.5];
/// … as this many of them in a row.
const PATIENCE: usize = 6;
/// Accuracy of each linear problem, relative.
const LINEAR: f64 = 3e-3;
/// Largest move of a joint along the curve in one iteration, as a share of the shorter arc beside it.
const SLIDE: f64 = 0.35;
/// Damping of a restoration, relative to the largest squared coefficient.
const DAMPING: f64 = 1e-9;
/// Newton steps that make a chain tangent-continuous.
const RESTORATIONS: usize = 3;
/// Least room to either side of a bounded variable, in units of its scale.
const INSIDE: f64 = 1e-4;
/// Deviations beyond this many half widths of the band, or none at all, move a chain no farther.
const WORST: f64 = 1e3;
/// Trust region below which nothing can be gained.
const SMALLEST_TRUST: f64 = 1e-3;

/// Improves `chain`; returns it with its largest distance from the middle of the band, mm (tangent errors weighted in).
pub(super) fn improve(mut chain: Chain, stretch: &Stretch<'_>, goal: &Goal, stop: &Stop) -> (Chain, f64) {
    if stop.smooth {
        restore(&mut chain, stretch, goal);
    }
    let mut worst = measure(&chain, stretch, goal);
    let mut trust = 1.0;
    let (mut stalls, mut hopeless) = (0, 0);
    for _ in 0..stop.iterations {
        if worst <= stop.target || trust < SMALLEST_TRUST {
            break;
        }
        let scales = scales(&chain, stretch, trust, worst.min(WORST * goal.band.half));
        let mut problem = Problem { blocks: chain.joints.len(), cyclic: chain.closed, rows: Vec::new() };
        rows(&chain, stretch, goal, &mut problem.rows);
        scale_rows(&mut problem.rows, &scales);
        boxes(&chain, &mut problem.rows, &scales);
        let Some(solution) = problem.solve(LINEAR) else { break };
        let step: Vec<f64> = solution.x.iter().zip(&scales).map(|(x, s)| x * s).collect();
        let mut next = chain.moved(stretch, &step);
        if stop.smooth {
            restore(&mut next, stretch, goal);
        }
        let found = measure(&next, stretch, goal);
        let (expected, gained) = (worst - solution.t, worst - found);
        if gained > 0.0 {
            stalls = if gained < stop.gain * worst { stalls + 1 } else { 0 };
            chain = next;
            worst = found;
        }
        match gained / expected.max(1e-300) {
            r if r > 0.6 => trust = (2.0_f64 * trust).min(1.0),
            r if r < 0.2 => trust *= 0.35,
            _ => {}
        }
        let doubts = HOPE.iter().filter(|h| solution.t > **h * stop.target && worst > stop.target).count();
        hopeless = if doubts > 0 { hopeless + doubts } else { 0 };
        let given_up = stop.target > 0.0 && hopeless >= PATIENCE;
        if expected < stop.gain * worst || stalls > 1 || given_up {
            break;
        }
    }
    (chain, worst)
}

/// Makes the joints tangent-continuous by the least change of deviations and half sweeps.
fn restore(chain: &mut Chain, stretch: &Stretch<'_>, goal: &Goal) {
    for _ in 0..RESTORATIONS {
        let rows = kink_rows(chain);
        if rows.iter().all(|r| r.value.abs() <= 0.2 * goal.tangent) {
            return;
        }
        let mut scales = vec![1.0; chain.joints.len() * BLOCK];
        for i in 0..chain.len() {
            scales[i * BLOCK + 2] = 4.0 / chain.drawn(i).length.max(1e-9);
        }
        let mut problem = Problem { blocks: chain.joints.len(), cyclic: chain.closed, rows };
        scale_rows(&mut problem.rows, &scales);
        let Some(x) = problem.least_change(DAMPING) else { return };
        let step: Vec<f64> = x.iter().zip(&scales).map(|(x, s)| x * s).collect();
        *chain = chain.moved(stretch, &step);
    }
}

/// Largest move of every variable.
fn scales(chain: &Chain, stretch: &Stretch<'_>, trust: f64, worst: f64) -> Vec<f64> {
    let mut out = vec![0.0; chain.joints.len() * BLOCK];
    let lengths: Vec<f64> =
        (0..chain.len()).map(|i| chain.station_after(stretch, i) - chain.joints[i].s).collect();
    for j in 0..chain.joints.len() {
        let before = chain.before(j).map_or(f64::INFINITY, |i| lengths[i]);
        let after = lengths.get(j).copied().unwrap_or(f64::INFINITY);
        out[j * BLOCK] = SLIDE * trust * before.min(after);
        out[j * BLOCK + 1] = 4.0 * trust * worst;
        out[j * BLOCK + 2] = if after.is_finite() { 32.0 * trust * worst / after } else { 1.0 };
    }
    out
}

fn scale_rows(rows: &mut [Row], scales: &[f64]) {
    for row in rows {
        for (k, c) in row.coefficients.iter_mut().enumerate() {
            *c *= scales[(row.block * BLOCK + k) % scales.len()];
        }
    }
}

/// The trust region: every scaled variable within one, and stations within what their joint allows.
fn boxes(chain: &Chain, rows: &mut Vec<Row>, scales: &[f64]) {
    for (v, scale) in scales.iter().enumerate() {
        let (mut low, mut high) = (-1.0_f64, 1.0_f64);
        let joint = &chain.joints[v / BLOCK];
        if let (0, Hold::Circle { from, to, .. }) = (v % BLOCK, joint.hold) {
            // The interior-point method starts at zero, which must be inside.
            low = low.max(((from - joint.s) / scale).min(-INSIDE));
            high = high.min(((to - joint.s) / scale).max(INSIDE));
        }
        let mut coefficients = [0.0; WIDTH];
        coefficients[v % BLOCK] = 1.0;
        let (value, limit) = (-0.5 * (low + high), 0.5 * (high - low));
        rows.push(Row { block: v / BLOCK, coefficients, value, limit, slope: 0.0 });
    }
}

/// Makes the half sweeps those of the curve's turning, corrected for the joints' positions.
pub(super) fn natural_halves(chain: &mut Chain) {
    for i in 0..chain.len() {
        let end = chain.end(i);
        if let Member::Arc(_) = chain.members[i] {
            let (a, b) = (chain.joints[i], chain.joints[end]);
            let d = super::chain::Drawn::new(a.p, b.p, 0.0);
            let before = super::stretch::turn(a.frame.t, d.chord);
            let after = super::stretch::turn(d.chord, b.frame.t);
            chain.members[i] = Member::Arc(0.5 * (before + after));
        }
    }
}
