//! The moves of an operation by their place in plan.

use super::Swept;

/// Squares of the plan, each with the moves whose own rectangle touches it.
pub(super) struct Buckets {
    low: [f64; 2],
    cell: f64,
    counts: [usize; 2],
    lists: Vec<Vec<u32>>,
}

impl Buckets {
    /// Squares of `cell` mm, larger where there would be more than `most` in a row.
    pub(super) fn new(passes: &[Swept], cell: f64, most: f64) -> Buckets {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for p in passes.iter().flat_map(|s| [s.from, s.to]) {
            for i in 0..2 {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
            }
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(1e-3);
        let cell = cell.max(extent / most);
        let empty = passes.is_empty();
        let counts = [0, 1].map(|i| if empty { 1 } else { ((high[i] - low[i]) / cell).floor() as usize + 1 });
        let mut buckets = Buckets { low, cell, counts, lists: vec![Vec::new(); counts[0] * counts[1]] };
        for (i, swept) in passes.iter().enumerate() {
            let range = |k: usize| (swept.from[k].min(swept.to[k]), swept.from[k].max(swept.to[k]));
            for place in buckets.places([range(0), range(1)]) {
                buckets.lists[place].push(u32::try_from(i).unwrap_or(u32::MAX));
            }
        }
        buckets
    }

    /// The moves that may touch a rectangle, each once, in their order.
    pub(super) fn gather(&self, ranges: [(f64, f64); 2], near: &mut Vec<u32>) {
        near.clear();
        for place in self.places(ranges) {
            near.extend(&self.lists[place]);
        }
        near.sort_unstable();
        near.dedup();
    }

    /// The squares of a rectangle; what lies outside counts to the border.
    fn places(&self, ranges: [(f64, f64); 2]) -> impl Iterator<Item = usize> + use<> {
        let [x, y] = [0, 1].map(|axis| {
            // Floats saturate.
            let of = |x: f64| {
                (((x - self.low[axis]) / self.cell).floor().max(0.0) as usize).min(self.counts[axis] - 1)
            };
            of(ranges[axis].0)..=of(ranges[axis].1)
        });
        let columns = self.counts[1];
        x.flat_map(move |a| y.clone().map(move |b| a * columns + b))
    }
}
