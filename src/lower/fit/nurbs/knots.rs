//! The knots of curves, as controls take them.

use super::spline::ORDER;

/// How a control takes the knots of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knots {
    /// Printed with this many decimals (Fanuc `G06.2`).
    Printed {
        /// Decimals.
        decimals: u32,
    },
    /// Not printed: the control uses 0, 0, 0, 0, 1, 2, … (LinuxCNC `G5.2`).
    Uniform,
    /// None: the control takes cubic pieces one by one.
    Pieces {
        /// Decimals of a piece's inner control points beyond the grid's.
        finer: u8,
    },
}

impl Knots {
    /// Control points (or pieces) of a spline of `n` knot intervals.
    pub(in crate::lower) fn blocks(self, n: usize) -> usize {
        n + self.more_blocks()
    }

    /// Blocks of a spline, beyond one for every knot interval.
    pub(super) fn more_blocks(self) -> usize {
        match self {
            Knots::Printed { .. } | Knots::Uniform => ORDER - 1,
            Knots::Pieces { .. } => 0,
        }
    }
}
