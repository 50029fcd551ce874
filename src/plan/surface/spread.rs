//! How passes are spread: as far apart as the height of cusps (or the step) allows, measured on the exact tracks.
//!
//! No formula of the curvature decides: the passes are laid down, the ridge between neighbours is measured at every
//! *column* (a place along), and the passes are moved until each distance is used up to the same share. Ridges grow with
//! the square of the distance, so that a few rounds do; Jeong and Jeong's equation (23) is what the first round would
//! give on a surface of constant curvature.

use rayon::prelude::*;

use super::family::Family;
use super::ridge::{Row, Target};
use crate::math::count;

/// Places along a pass at which distances are measured.
pub(super) const COLUMNS: usize = 257;
/// Passes of the first round at least.
const FIRST: usize = 24;
/// … and no farther apart than this share of the ball's radius.
const APART: f64 = 0.4;
/// More passes than this are a mistake in the tolerance.
pub(super) const MOST: usize = 50_000;
/// Rounds of measuring and moving.
const ROUNDS: u32 = 8;
/// Distances may be used up to this share: the target itself is a little below what was asked for.
const FULL: f64 = 1.002;
/// Distances of passes that are measured at once: their contacts are kept in memory.
const BLOCK: usize = 512;
/// What curved passes use is smooth over so many columns.
pub(super) const SMOOTH: usize = 4;

/// *Across* of a pass at every column; no number where there is no pass.
pub(super) type Line = Vec<f64>;

/// Passes and what their distances use of what is allowed.
#[derive(Debug)]
pub(super) struct Spread {
    pub lines: Vec<Line>,
    /// For each gap, from the surface's border before the first pass to that behind the last, and each column: the share
    /// used, and the distance of the centres, mm.
    pub gaps: Vec<Vec<(f64, f64)>>,
    /// Paths may be to the side of their tracks by this share of the distance of passes at least.
    pub aside: f64,
}

/// Where the first and the last pass lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ends {
    /// On the border.
    On,
    /// Inside of it by as much as half a ridge: beyond the border nothing stays.
    Inside,
}

impl Ends {
    /// Places of passes as shares of the whole need, where the distances are as many as `whole`.
    fn marks(self, whole: usize) -> Vec<f64> {
        match self {
            Ends::On => (0..=whole).map(|j| count(j) / count(whole)).collect(),
            Ends::Inside => (0..whole).map(|j| (count(j) + 0.5) / count(whole)).collect(),
        }
    }

    /// How many whole distances so many passes make.
    fn whole(self, passes: usize) -> usize {
        match self {
            Ends::On => passes.saturating_sub(1),
            Ends::Inside => passes,
        }
    }

    /// What a border takes of a whole distance where it uses its own up.
    fn half(self) -> f64 {
        match self {
            Ends::On => 0.0,
            Ends::Inside => 0.5,
        }
    }
}

/// The fewest straight passes from end to end whose distances are nowhere used up more than the target allows.
pub(super) fn spread(family: &Family, target: Target) -> Result<Spread, String> {
    let edges = family.across();
    let ends = if matches!(target, Target::Cusp(_)) { Ends::Inside } else { Ends::On };
    let start = ((family.width() / (APART * family.ball)).ceil() as usize).clamp(FIRST, MOST);
    let straight = |mark: f64| vec![edges.0 + (edges.1 - edges.0) * mark; COLUMNS];
    let mut lines: Vec<Line> = ends.marks(start).into_iter().map(straight).collect();
    let mut found = measure(family, target, &lines, (edges, ends));
    for round in 0..ROUNDS {
        let mut needs: Vec<Line> = found.iter().map(|gap| gap.iter().map(|g| g.0).collect()).collect();
        let worst = needs.iter().flatten().copied().fold(0.0, f64::max);
        level(&mut needs);
        let columns = transposed(&needs, ends);
        let most = columns.iter().map(|c| c.iter().sum::<f64>()).fold(0.0, f64::max);
        if most.is_nan() || most > count(MOST) {
            return Err(format!("{} asks for more than {MOST} passes", target.name()));
        }
        // The last rounds may only add passes: they end in any case.
        let now = ends.whole(lines.len());
        let fewest = if round + 3 < ROUNDS { 1 } else { now + usize::from(worst > FULL) };
        let whole = ((most - 1e-3).ceil() as usize).max(fewest);
        if round > 0 && worst <= FULL && whole >= now {
            break;
        }
        lines = moved(&lines, &columns, edges, &ends.marks(whole));
        found = measure(family, target, &lines, (edges, ends));
    }
    Ok(Spread { lines, gaps: found, aside: STRAIGHT })
}

/// Passes that do not bend use at every column what they use at the worst.
fn level(needs: &mut [Line]) {
    for gap in needs {
        let worst = gap.iter().copied().fold(0.0, f64::max);
        gap.fill(worst);
    }
}

/// The mean, over `reach` columns to either side, of the largest value of as many: never below the value itself.
pub(super) fn smooth(values: &[f64], reach: usize) -> Line {
    let around = |k: usize| k.saturating_sub(reach)..(k + reach + 1).min(values.len());
    let upper: Line =
        (0..values.len()).map(|k| values[around(k)].iter().copied().fold(0.0, f64::max)).collect();
    let mean = |k: usize| {
        let part = &upper[around(k)];
        part.iter().sum::<f64>() / count(part.len())
    };
    (0..values.len()).map(mean).collect()
}

/// The needs of every column; those at the borders in parts of a whole distance.
fn transposed(needs: &[Line], ends: Ends) -> Vec<Line> {
    let share = |j: usize| if j == 0 || j + 1 == needs.len() { ends.half() } else { 1.0 };
    (0..COLUMNS).map(|k| needs.iter().enumerate().map(|(j, gap)| gap[k] * share(j)).collect()).collect()
}

/// Passes at these shares of every column's needs.
fn moved(lines: &[Line], columns: &[Line], edges: (f64, f64), marks: &[f64]) -> Vec<Line> {
    let placed: Vec<Line> = columns
        .iter()
        .enumerate()
        .map(|(k, needs)| {
            let inner = lines.iter().map(|line| line[k]);
            let at: Line = core::iter::once(edges.0).chain(inner).chain([edges.1]).collect();
            shared_out(&at, needs, marks)
        })
        .collect();
    (0..marks.len()).map(|j| placed.iter().map(|column| column[j]).collect()).collect()
}

/// Places at shares of the whole need, in rising order; `needs` lie between the places `at`.
fn shared_out(at: &[f64], needs: &[f64], marks: &[f64]) -> Line {
    let whole: f64 = needs.iter().sum();
    let (first, last) = (at[0], at[at.len() - 1]);
    if whole.is_nan() || whole <= 0.0 {
        return marks.iter().map(|mark| first + (last - first) * mark).collect();
    }
    let (mut i, mut before) = (0, 0.0);
    let place = |mark: &f64| {
        if *mark <= 0.0 || *mark >= 1.0 {
            return if *mark <= 0.0 { first } else { last };
        }
        let wanted = whole * mark;
        while i + 1 < needs.len() && before + needs[i] < wanted {
            before += needs[i];
            i += 1;
        }
        let share = if needs[i] > 0.0 { ((wanted - before) / needs[i]).clamp(0.0, 1.0) } else { 0.0 };
        at[i] + (at[i + 1] - at[i]) * share
    };
    marks.iter().map(place).collect()
}

/// The share of what is allowed, and the distance, between neighbours and to the borders, at every column.
pub(super) fn measure(
    family: &Family,
    target: Target,
    lines: &[Line],
    (edges, ends): ((f64, f64), Ends),
) -> Vec<Vec<(f64, f64)>> {
    let mut out = Vec::with_capacity(lines.len() + 1);
    let border = |line: Option<&Line>, edge: f64| match line.filter(|_| ends == Ends::Inside) {
        Some(line) => super::ridge::border(family, target, &Row::new(family, line), line, edge),
        None => vec![(0.0, f64::INFINITY); COLUMNS],
    };
    out.push(border(lines.first(), edges.0));
    let mut from = 0;
    while from + 1 < lines.len() {
        let to = (from + BLOCK).min(lines.len() - 1);
        let rows: Vec<Row> = lines[from..=to].par_iter().map(|line| Row::new(family, line)).collect();
        let pairs: Vec<usize> = (from..to).collect();
        let block: Vec<Vec<(f64, f64)>> = pairs
            .par_iter()
            .map(|&j| {
                let pair =
                    Pair { rows: (&rows[j - from], &rows[j + 1 - from]), lines: (&lines[j], &lines[j + 1]) };
                pair.shares(family, target, edges)
            })
            .collect();
        out.extend(block);
        from = to;
    }
    out.push(border(lines.last(), edges.1));
    out
}

/// Two neighbouring passes.
struct Pair<'a> {
    rows: (&'a Row, &'a Row),
    lines: (&'a Line, &'a Line),
}

impl Pair<'_> {
    /// What lies between them; where one of them has ended, what lies between the other and the border.
    fn shares(&self, family: &Family, target: Target, edges: (f64, f64)) -> Vec<(f64, f64)> {
        let mut out = super::ridge::gap(family, target, self.rows, self.lines);
        let ((a, b), (p, q)) = (self.rows, self.lines);
        for (row, line, other, edge) in [(a, p, q, edges.1), (b, q, p, edges.0)] {
            let alone = |k: usize| other[k].is_nan() && !line[k].is_nan();
            if (0..COLUMNS).any(alone) {
                let border = super::ridge::border(family, target, row, line, edge);
                (0..COLUMNS).filter(|k| alone(*k)).for_each(|k| out[k] = border[k]);
            }
        }
        out
    }
}

/// Paths may be to the side of straight tracks by this share of the distance of passes at least …
const STRAIGHT: f64 = 0.0035;
/// … and by this at most.
const ASIDE: f64 = 0.05;

impl Spread {
    /// How far the path of each pass may be to the side of its track, mm, at every column: half of what the distance
    /// from both neighbours leaves.
    pub(super) fn rooms(&self, target: Target) -> Vec<Vec<f64>> {
        let spare = |(used, apart): (f64, f64)| {
            let share = match target {
                Target::Cusp(_) => 0.5 * (1.0 - used),
                Target::Step(_) => ASIDE,
            };
            // The distance that would use everything up; a pass on the border is free to leave it.
            let whole = if used > 1e-3 { apart / used } else { f64::INFINITY };
            whole * share.clamp(self.aside, ASIDE)
        };
        let own = |j: usize, k: usize| {
            let sides = [j, j + 1].into_iter().filter_map(|i| self.gaps.get(i)?.get(k));
            sides.map(|g| spare(*g)).fold(f64::INFINITY, f64::min)
        };
        (0..self.lines.len()).map(|j| (0..COLUMNS).map(|k| own(j, k)).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn needs_are_shared_out_equally() {
        let places = shared_out(&[0.0, 1.0, 2.0, 4.0], &[1.0, 3.0, 2.0], &Ends::On.marks(4));
        assert_eq!(places.len(), 5);
        for (place, wanted) in places.iter().zip([0.0, 7.0 / 6.0, 5.0 / 3.0, 2.5, 4.0]) {
            assert!((place - wanted).abs() < 1e-12, "{places:?}");
        }
    }

    #[test]
    fn smoothing_never_lowers_a_need() {
        let mut values = vec![1.0; COLUMNS];
        values[40] = 3.0;
        values[0] = 2.0;
        let smoothed = smooth(&values, SMOOTH);
        assert!(values.iter().zip(&smoothed).all(|(v, s)| s >= v));
        assert!(smoothed[60] == 1.0);
    }
}
