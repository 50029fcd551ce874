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
const MOST: usize = 50_000;
/// Rounds of measuring and moving.
const ROUNDS: u32 = 8;
/// Distances may be used up to this share: the target itself is a little below what was asked for.
const FULL: f64 = 1.004;
/// Distances of passes that are measured at once: their contacts are kept in memory.
const BLOCK: usize = 512;
/// Curved passes are smooth over so many columns.
const SMOOTH: usize = 4;

/// *Across* of a pass at every column.
pub(super) type Line = Vec<f64>;

/// Passes and what their distances use of what is allowed.
#[derive(Debug)]
pub(super) struct Spread {
    pub lines: Vec<Line>,
    /// For each gap between neighbours and each column: the share used, and the distance of the centres, mm.
    pub gaps: Vec<Vec<(f64, f64)>>,
}

/// The fewest passes whose distances are nowhere used up more than the target allows. `curved`: passes may bend, so that
/// each column uses its distances up by itself; all of them run from end to end, and the column that takes the most
/// passes decides about their number.
pub(super) fn spread(family: &Family, target: Target, curved: bool) -> Result<Spread, String> {
    let (first, last) = family.across();
    let start = ((family.width() / (APART * family.ball)).ceil() as usize).clamp(FIRST, MOST);
    let straight = |k: usize| vec![first + (last - first) * count(k) / count(start); COLUMNS];
    let mut lines: Vec<Line> = (0..=start).map(straight).collect();
    let mut found = measure(family, target, &lines);
    for round in 0..ROUNDS {
        let mut needs: Vec<Line> = found.iter().map(|gap| gap.iter().map(|g| g.0).collect()).collect();
        let worst = needs.iter().flatten().copied().fold(0.0, f64::max);
        level(&mut needs, curved);
        let columns = transposed(&needs);
        let most = columns.iter().map(|c| c.iter().sum::<f64>()).fold(0.0, f64::max);
        if most.is_nan() || most > count(MOST) {
            return Err(format!("{} asks for more than {MOST} passes", target.name()));
        }
        // The last rounds may only add passes: they end in any case.
        let fewest = if round + 3 < ROUNDS { 1 } else { lines.len() - 1 + usize::from(worst > FULL) };
        let passes = ((most - 1e-3).ceil() as usize).max(fewest);
        if round > 0 && worst <= FULL && passes + 1 >= lines.len() {
            break;
        }
        lines = moved(&lines, &columns, passes);
        found = measure(family, target, &lines);
    }
    Ok(Spread { lines, gaps: found })
}

/// What passes use at each column. Passes that do not bend use at every column what they use at the worst; bent ones stay
/// smooth, and nowhere use less than they did.
fn level(needs: &mut [Line], curved: bool) {
    for gap in needs {
        if curved {
            *gap = smooth(gap);
        } else {
            let worst = gap.iter().copied().fold(0.0, f64::max);
            gap.fill(worst);
        }
    }
}

/// The mean, over a few columns, of the largest value of a few columns: never below the value itself.
fn smooth(values: &[f64]) -> Line {
    let around = |k: usize| k.saturating_sub(SMOOTH)..(k + SMOOTH + 1).min(values.len());
    let upper: Line =
        (0..values.len()).map(|k| values[around(k)].iter().copied().fold(0.0, f64::max)).collect();
    let mean = |k: usize| {
        let part = &upper[around(k)];
        part.iter().sum::<f64>() / count(part.len())
    };
    (0..values.len()).map(mean).collect()
}

fn transposed(needs: &[Line]) -> Vec<Line> {
    (0..COLUMNS).map(|k| needs.iter().map(|gap| gap[k]).collect()).collect()
}

/// As many passes, so that each of their distances takes the same part of every column's needs.
fn moved(lines: &[Line], columns: &[Line], passes: usize) -> Vec<Line> {
    let placed: Vec<Line> = columns
        .iter()
        .enumerate()
        .map(|(k, needs)| {
            let at: Line = lines.iter().map(|line| line[k]).collect();
            shared_out(&at, needs, passes)
        })
        .collect();
    (0..=passes).map(|j| placed.iter().map(|column| column[j]).collect()).collect()
}

/// Places that divide the whole need equally; `needs` lie between the places `at`.
fn shared_out(at: &[f64], needs: &[f64], passes: usize) -> Line {
    let whole: f64 = needs.iter().sum();
    let (first, last) = (at[0], at[at.len() - 1]);
    if whole.is_nan() || whole <= 0.0 {
        return (0..=passes).map(|j| first + (last - first) * count(j) / count(passes)).collect();
    }
    let (mut i, mut before) = (0, 0.0);
    let mut out = vec![first];
    for j in 1..passes {
        let wanted = whole * count(j) / count(passes);
        while i + 1 < needs.len() && before + needs[i] < wanted {
            before += needs[i];
            i += 1;
        }
        let share = if needs[i] > 0.0 { ((wanted - before) / needs[i]).clamp(0.0, 1.0) } else { 0.0 };
        out.push(at[i] + (at[i + 1] - at[i]) * share);
    }
    out.push(last);
    out
}

/// The share of what is allowed, and the distance, between neighbours at every column.
fn measure(family: &Family, target: Target, lines: &[Line]) -> Vec<Vec<(f64, f64)>> {
    let mut out = Vec::with_capacity(lines.len());
    let mut from = 0;
    while from + 1 < lines.len() {
        let to = (from + BLOCK).min(lines.len() - 1);
        let rows: Vec<Row> = lines[from..=to].par_iter().map(|line| Row::new(family, line)).collect();
        let pairs: Vec<usize> = (from..to).collect();
        let block: Vec<Vec<(f64, f64)>> = pairs
            .par_iter()
            .map(|&j| {
                let (a, b) = (&rows[j - from], &rows[j + 1 - from]);
                super::ridge::gap(family, target, (a, b), (&lines[j], &lines[j + 1]))
            })
            .collect();
        out.extend(block);
        from = to;
    }
    out
}

/// Passes may be to the side of their track by this share of the distance of passes, at least and at most.
const ASIDE: (f64, f64) = (0.0015, 0.05);

impl Spread {
    /// How far the path of each pass may be to the side of its track, mm, at every column: half of what the distance
    /// from both neighbours leaves.
    pub(super) fn rooms(&self, target: Target) -> Vec<Vec<f64>> {
        let spare = |(used, apart): (f64, f64)| {
            let share = match target {
                Target::Cusp(_) => 0.5 * (1.0 / used.max(1e-3) - 1.0),
                Target::Step(_) => ASIDE.1,
            };
            apart * share.clamp(ASIDE.0, ASIDE.1)
        };
        let own = |j: usize, k: usize| {
            let sides = [j.checked_sub(1), Some(j)].into_iter().flatten();
            sides.filter_map(|i| self.gaps.get(i)?.get(k)).map(|g| spare(*g)).fold(f64::INFINITY, f64::min)
        };
        (0..self.lines.len()).map(|j| (0..COLUMNS).map(|k| own(j, k)).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn needs_are_shared_out_equally() {
        let places = shared_out(&[0.0, 1.0, 2.0, 4.0], &[1.0, 3.0, 2.0], 4);
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
        let smoothed = smooth(&values);
        assert!(values.iter().zip(&smoothed).all(|(v, s)| s >= v));
        assert!(smoothed[60] == 1.0);
    }
}
