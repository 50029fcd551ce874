//! Passes that follow one another, each as far from the one before as the target allows at every place.
//!
//! Marching begins on a border or in the middle. A pass runs on only where the surface between the one before it and the
//! border is not yet done: it ends where it reaches the border, and those that follow are shorter. Which parameter the
//! passes run along, and where they begin, is tried out with passes that lie farther apart; the shortest way wins.

use rayon::prelude::*;

use super::family::Family;
use super::ridge::{Row, Target, border, gap, hidden};
use super::spread::{COLUMNS, Ends, Line, MOST, SMOOTH, Spread, measure, smooth};
use crate::cl::{Contacts, March, Start};

/// Rounds of measuring and moving one pass.
const ROUNDS: u32 = 30;
/// The same where a way is tried out.
const TRIAL_ROUNDS: u32 = 6;
/// Rounds after which a pass only comes closer.
const FREE: u32 = 10;
/// A pass is near enough when it uses so much wherever it may.
const NEAR: f64 = 0.995;
/// Part of the height of cusps that bent passes are spread for, and how far their paths may be aside, as a share of the
/// distance of passes: blocks are straight. Passes that bend much are closer, and have more room.
const BENT: [(f64, f64); 2] = [(0.993, 0.006), (0.985, 0.012)];
/// They do where they take less than this share of the blocks for it.
const WORTH: f64 = 0.87;
/// … and what may be used beyond that.
const SPENT: f64 = 0.002;
/// Ways are tried out with about so many passes.
const TRIAL: f64 = 48.0;

/// The shortest way over the surface of passes that lie as far apart as the target allows; `even`: everywhere at the
/// same distance. The families are those along u and along v. What is not known is tried out.
pub(super) fn shortest(
    families: [Family; 2],
    target: Target,
    even: bool,
    known: &mut Option<March>,
) -> Result<(Family, Spread), String> {
    let march = match *known {
        Some(March::Contacts(march)) => march,
        _ => tried(&families, target, even)?,
    };
    *known = Some(March::Contacts(march));
    let [along_u, along_v] = families;
    let family = if march.axis == 0 { along_u } else { along_v };
    let bent = BENT[usize::from(march.roomy)];
    let spread = spread(&family, (target, bent), even, march.start, ROUNDS)?;
    Ok((family, Spread { aside: bent.1, ..spread }))
}

/// The shortest way, told from passes that lie farther apart.
fn tried(families: &[Family; 2], target: Target, even: bool) -> Result<Contacts, String> {
    let starts = [Start::First, Start::Last, Start::Middle];
    let ways: Vec<(usize, Start)> =
        (0..families.len()).flat_map(|axis| starts.map(|start| (axis, start))).collect();
    let trials: Vec<Result<Trial, String>> = ways
        .par_iter()
        .map(|(axis, start)| {
            let family = &families[*axis];
            let factor = (target.passes(family) / TRIAL).max(1.0);
            let spread = spread(family, (target.coarser(factor), BENT[0]), even, *start, TRIAL_ROUNDS)?;
            Ok(Trial::new(family, &spread, factor))
        })
        .collect();
    let mut best: Option<(Trial, (usize, Start))> = None;
    for (way, trial) in ways.iter().zip(trials) {
        let trial = trial?;
        // Ways of the same length: the first of them.
        if best.as_ref().is_none_or(|b| trial.length < b.0.length * (1.0 - 1e-6)) {
            best = Some((trial, *way));
        }
    }
    let (axis, start) = best.as_ref().map_or((0, Start::First), |b| b.1);
    let roomy =
        matches!(target, Target::Cusp(_)) && best.is_some_and(|b| b.0.blocks[1] < WORTH * b.0.blocks[0]);
    Ok(Contacts { axis, start, roomy })
}

fn spread(
    family: &Family,
    (target, (part, _)): (Target, (f64, f64)),
    even: bool,
    start: Start,
    rounds: u32,
) -> Result<Spread, String> {
    match target {
        Target::Cusp(h) if even => constant(family, h * part, start, rounds),
        Target::Cusp(h) => marched(family, Target::Cusp(h * part), start, rounds),
        Target::Step(_) => marched(family, target, start, rounds),
    }
}

/// What passes that lie farther apart tell of a way.
struct Trial {
    /// Length of the passes, mm.
    length: f64,
    /// About how many blocks they take, for each room of [`BENT`].
    blocks: [f64; 2],
}

impl Trial {
    /// From passes that are `factor` times as far apart as they will be.
    fn new(family: &Family, spread: &Spread, factor: f64) -> Trial {
        let mut trial = Trial { length: 0.0, blocks: [0.0; 2] };
        for (line, gaps) in spread.lines.iter().zip(&spread.gaps) {
            let row = Row::new(family, line);
            for (k, (_, apart)) in gaps.iter().enumerate().skip(1) {
                let (Some(before), Some(own)) = (row.contact(k - 1), row.contact(k)) else { continue };
                let step = (own.centre - before.centre).norm();
                trial.length += step;
                let Some(after) = row.contact(k + 1) else { continue };
                let (along, bend) = (
                    after.centre - before.centre,
                    (after.centre - own.centre) - (own.centre - before.centre),
                );
                if !apart.is_finite() || *apart <= 0.0 {
                    continue;
                }
                let apart = apart / factor;
                let sideways = own.normal.cross(&along).try_normalize(0.0).unwrap_or_default();
                // A chord of the length s leaves a bow of the curvature k by k s²/8: the bow has the band to lie in.
                let chord = |band: f64, bend: f64| step * (8.0 * band / bend.abs().max(1e-12)).sqrt();
                let upright = chord(family.band(), bend.dot(&own.normal));
                for (blocks, (_, aside)) in trial.blocks.iter_mut().zip(BENT) {
                    *blocks += step / upright.min(chord(2.0 * aside * apart, bend.dot(&sideways)));
                }
            }
        }
        trial
    }
}

/// The largest constant distance whose ridges are nowhere higher than asked for.
fn constant(family: &Family, h: f64, start: Start, rounds: u32) -> Result<Spread, String> {
    const TRIES: u32 = 8;
    const SPARE: f64 = 0.98;
    let mut step = 2.0 * (h * (2.0 * family.radius() - h)).max(0.0).sqrt();
    let mut found = None;
    for _ in 0..TRIES {
        let passes = marched(family, Target::Step(step), start, rounds)?;
        let gaps = measure(family, Target::Cusp(h), &passes.lines, (family.across(), Ends::Inside));
        let worst = gaps.iter().flatten().map(|g| g.0).fold(0.0, f64::max);
        if worst <= 1.0 + SPENT {
            found = Some(Spread { lines: passes.lines, gaps, ..passes });
        }
        if worst.is_nan() || worst <= 0.0 || (SPARE..=1.0 + SPENT).contains(&worst) {
            break;
        }
        step /= worst;
    }
    found.ok_or_else(|| "no constant distance of passes keeps the height of cusps".into())
}

fn marched(family: &Family, target: Target, start: Start, rounds: u32) -> Result<Spread, String> {
    let edges = family.across();
    let march = Marching { family, target, rounds };
    let lines = match start {
        Start::First => march.all(march.begun(edges.0, edges.1), edges.1)?,
        Start::Last => {
            let mut lines = march.all(march.begun(edges.1, edges.0), edges.0)?;
            lines.reverse();
            lines
        }
        Start::Middle => {
            let (middle, step) = (vec![0.5 * (edges.0 + edges.1); COLUMNS], vec![march.guess(); COLUMNS]);
            let front = || Front { row: Row::new(family, &middle), line: middle.clone(), step: step.clone() };
            let mut lines = march.all(front(), edges.0)?;
            lines.reverse();
            lines.extend(march.all(front(), edges.1)?.into_iter().skip(1));
            lines
        }
    };
    let gaps = measure(family, target, &lines, (edges, Ends::Inside));
    Ok(Spread { lines, gaps, aside: BENT[0].1 })
}

struct Marching<'a> {
    family: &'a Family,
    target: Target,
    /// Rounds of measuring and moving one pass, at most.
    rounds: u32,
}

/// The last pass so far.
struct Front {
    line: Line,
    row: Row,
    /// How far it is from the one before it, in *across*.
    step: Line,
}

impl Marching<'_> {
    /// A first distance of passes, in *across*.
    fn guess(&self) -> f64 {
        let (a, b) = self.family.across();
        (b - a) / self.target.passes(self.family).max(2.0)
    }

    /// The first pass beside the border at `from`.
    fn begun(&self, from: f64, to: f64) -> Front {
        let open = [true; COLUMNS];
        let line = vec![from; COLUMNS];
        let step = vec![0.5 * self.guess(); COLUMNS];
        let mut front =
            self.moved(&open, &line, step, to, |line, row| border(self.family, self.target, row, line, from));
        front.step.iter_mut().for_each(|s| *s *= 2.0);
        front
    }

    /// All passes from the first to the border at `edge`.
    fn all(&self, first: Front, edge: f64) -> Result<Vec<Line>, String> {
        let mut lines = Vec::new();
        let mut front = first;
        while let Some(next) = self.next(&front, edge) {
            lines.push(front.line);
            front = next;
            if lines.len() > MOST {
                return Err(format!("{} asks for more than {MOST} passes", self.target.name()));
            }
        }
        lines.push(front.line);
        Ok(lines)
    }

    /// The pass after this one; `None` where nothing stays up to the border.
    fn next(&self, front: &Front, edge: f64) -> Option<Front> {
        let rest = border(self.family, self.target, &front.row, &front.line, edge);
        let hidden = match rest.iter().all(|r| r.0 > 1.0) {
            true => Vec::new(),
            false => hidden(self.family, self.target, &front.row, &front.line, edge),
        };
        let left =
            |k: usize| rest.get(k).is_some_and(|r| r.0 > 1.0) || hidden.get(k).copied().unwrap_or(false);
        let open: [bool; COLUMNS] = core::array::from_fn(|k| {
            // One column more on either side: the pass covers what is left to its very end.
            let near = k.checked_sub(1).is_some_and(left) || left(k) || left(k + 1);
            near && !front.line[k].is_nan()
        });
        open.contains(&true).then(|| {
            self.moved(&open, &front.line, front.step.clone(), edge, |line, row| {
                gap(self.family, self.target, (&front.row, row), (&front.line, line))
            })
        })
    }

    /// A pass, where it is open, so far from a line that what it `uses` is used up, or at the border.
    fn moved(
        &self,
        open: &[bool; COLUMNS],
        from: &Line,
        mut step: Line,
        edge: f64,
        uses: impl Fn(&Line, &Row) -> Vec<(f64, f64)>,
    ) -> Front {
        let mut round = 0;
        loop {
            let line = placed(open, from, &step, edge);
            let row = Row::new(self.family, &line);
            let used: Line = uses(&line, &row).into_iter().map(|u| u.0).collect();
            let worst = used.iter().copied().fold(0.0, f64::max);
            let idle =
                (0..COLUMNS).filter(|k| open[*k] && line[*k] != edge).map(|k| used[k] < NEAR * SMOOTHED);
            let idle = idle.filter(|i| *i).count();
            round += 1;
            if worst <= 1.0 + SPENT && round > 1 && (idle == 0 || round > 4)
                || round >= self.rounds
                || worst.is_nan()
            {
                return Front { line, row, step };
            }
            // What does not come to rest is moved in wider and wider parts, at last as a whole.
            let mut needs = smooth(&used, (SMOOTH << (round / 3)).min(COLUMNS));
            if round >= FREE {
                needs.iter_mut().for_each(|n| *n = n.max(1.0));
            }
            for k in (0..COLUMNS).filter(|k| open[*k]) {
                // What lies on the border cannot go on, and comes back from there.
                let on_border = line[k] == edge;
                let now = if on_border && needs[k] > 1.0 {
                    (line[k] - from[k]).abs().min(step[k])
                } else {
                    step[k]
                };
                step[k] = if on_border && needs[k] < 1.0 { now } else { now / needs[k].clamp(0.5, 2.0) };
            }
        }
    }
}

/// A line so many steps from another, where it is open; made smooth, and no farther than the border.
fn placed(open: &[bool; COLUMNS], from: &Line, step: &Line, edge: f64) -> Line {
    let mut line: Line = (0..COLUMNS)
        .map(|k| match (open[k], from[k] < edge) {
            (false, _) => f64::NAN,
            (true, true) => from[k] + step[k],
            (true, false) => from[k] - step[k],
        })
        .collect();
    for _ in 0..FAIRINGS {
        faired(&mut line);
    }
    for k in (0..COLUMNS).filter(|k| open[*k]) {
        line[k] = if from[k] < edge { line[k].clamp(from[k], edge) } else { line[k].clamp(edge, from[k]) };
    }
    line
}

/// Each inner value half way to the mean of its neighbours.
pub(super) fn faired(line: &mut Line) {
    let mut before = f64::NAN;
    for k in 0..line.len() {
        let (own, after) = (line[k], line.get(k + 1).copied().unwrap_or(f64::NAN));
        let mean = 0.25 * before + 0.5 * own + 0.25 * after;
        if !mean.is_nan() {
            line[k] = mean;
        }
        before = own;
    }
}

/// How often a pass is faired: ripples shorter than about fifteen columns, which would grow from pass to pass, go.
const FAIRINGS: u32 = 24;
/// Smoothing takes so much off where needs differ.
const SMOOTHED: f64 = 0.98;
