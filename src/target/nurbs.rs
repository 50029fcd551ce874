//! Curves, in the forms that controls take them.

use super::Position;

/// NURBS output of a control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NurbsForm {
    /// Fanuc `G06.2 P K X Y Z R`.
    G062 {
        /// Decimals of printed knots.
        knot_decimals: u8,
    },
    /// LinuxCNC `G5.2 … G5.3`; its knots are 0, 0, 0, 0, 1, 2, … and not printed.
    G052,
    /// Cubic pieces, one a block, by the coefficients of their polynomials or by their inner control points
    /// (Heidenhain `SPL`, SINUMERIK `POLY`, `G5`).
    Pieces {
        /// Decimals of coefficients beyond those of linear words.
        finer: u8,
        /// Largest step in the parameter (0…1) of the chords that are cut in the place of a piece; 0: the piece itself is.
        chord: f64,
    },
}

impl NurbsForm {
    /// Blocks of a curve beyond one for each of its control points (or pieces): closing knots, or a closing word.
    #[must_use]
    pub fn more_blocks(self) -> usize {
        match self {
            NurbsForm::G062 { .. } => crate::cl::spline::ORDER,
            NurbsForm::G052 => 1,
            NurbsForm::Pieces { .. } => 0,
        }
    }

    /// [`Nurbs::finer`] of curves of this form.
    #[must_use]
    pub fn finer(self) -> u8 {
        match self {
            NurbsForm::Pieces { finer, .. } => finer,
            NurbsForm::G062 { .. } | NurbsForm::G052 => 0,
        }
    }
}

/// A NURBS curve; its first control point is the position before it. Where the control takes [`NurbsForm::Pieces`],
/// it is one cubic Bézier piece.
#[derive(Debug, Clone, PartialEq)]
pub struct Nurbs {
    /// Order (degree + 1).
    pub order: u8,
    /// Control points with their weights, the first included; X, Y and Z in steps of the grid divided by 10^`finer`.
    pub points: Vec<(Position, f64)>,
    /// Knots, points + order of them.
    pub knots: Vec<f64>,
    /// Decimals that control points have beyond the grid's. The first and the last point are on the grid all the same.
    pub finer: u8,
}

impl Nurbs {
    /// Steps of control points in one step of the grid.
    #[must_use]
    pub fn fine_steps(&self) -> i64 {
        (0..self.finer).fold(1, |factor: i64, _| factor.saturating_mul(10))
    }

    /// Where it ends, in grid steps.
    #[must_use]
    pub fn end(&self) -> Option<Position> {
        let fine = self.fine_steps();
        self.points.last().map(|(p, _)| Position { x: p.x / fine, y: p.y / fine, z: p.z / fine, r: p.r })
    }

    /// Its control points in grid steps, rounded.
    pub fn places(&self) -> impl Iterator<Item = Position> {
        let fine = self.fine_steps();
        let near = move |v: i64| v.saturating_add(v.signum() * (fine / 2)) / fine;
        self.points.iter().map(move |(p, _)| Position { x: near(p.x), y: near(p.y), z: near(p.z), r: p.r })
    }

    /// Whether the height of its control points changes.
    #[must_use]
    pub fn climbs(&self) -> bool {
        self.points.windows(2).any(|pair| pair[0].0.z != pair[1].0.z)
    }
}
