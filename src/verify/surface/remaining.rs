//! What moves leave on a surface, place by place, for pictures: the same measure as the proof's.

use super::Swept;
use super::field::Field;
use super::moves::{chords, raised};
use super::remains;
use crate::cl::{Finish, Operation};
use crate::readback::TraceMove;
use crate::verify::Placed;

/// Moves of an operation's cutter, made ready to be swept.
#[derive(Debug)]
pub struct Sweep {
    finish: Finish,
    moves: Vec<Swept>,
}

/// What is left at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Left {
    /// Along the surface's normal, above what is to be left, mm; negative where the cutter has gone deeper.
    pub height: f64,
    /// Line of the NC text whose move decides it.
    pub line: u32,
}

/// All moves of an operation over its surface.
pub struct Remaining<'a> {
    /// Heights up to here are found among the moves close by.
    little: f64,
    field: Swath<'a>,
}

/// Moves by place, of a ball or of another cutter.
enum Swath<'a> {
    Ball(Field<'a>),
    Other(remains::Field<'a>),
}

/// Cutters that are no balls may have gone so deep, mm; deeper is told as this.
const DEEPEST: f64 = 1.0;

impl Sweep {
    /// Moves of the read-back text, each with its line.
    #[must_use]
    pub fn new(finish: &Finish, moves: &[(u32, &TraceMove)]) -> Sweep {
        let of = |&(line, cut): &(u32, &TraceMove)| {
            let ways = chords(&Placed { line, block: None, index: 0, cut });
            ways.into_iter().map(move |(from, to)| Swept {
                from: raised(finish, from),
                to: raised(finish, to),
                off: 0.0,
                line,
                block: None,
            })
        };
        // The height of cusps is not asked for.
        let finish = Finish { cusp: None, ..finish.clone() };
        Sweep { moves: moves.iter().flat_map(of).collect(), finish }
    }
}

impl<'a> Remaining<'a> {
    /// Heights of up to `little` (mm) are told quickly; more is told up to where no move comes near.
    #[must_use]
    pub fn new(operation: &Operation, sweep: &'a Sweep, little: f64) -> Remaining<'a> {
        let (finish, moves) = (&sweep.finish, &sweep.moves);
        let field = if finish.cutter.is_ball() {
            Swath::Ball(Field::new(operation, finish, moves, (little, 1.0)))
        } else {
            Swath::Other(remains::Field::new(finish, moves, None))
        };
        Remaining { little, field }
    }
    /// What is told quickly, mm.
    #[must_use]
    pub fn little(&self) -> f64 {
        self.little
    }
    /// What is left at a place of a patch; `None` where the surface has no normal or no move comes near.
    #[must_use]
    pub fn at(&self, patch: usize, uv: [f64; 2], near: &mut Vec<u32>) -> Option<Left> {
        let (height, swept) = match &self.field {
            Swath::Ball(field) => {
                let close = field.lowest(patch, uv, self.little, near).filter(|(h, _)| *h <= self.little);
                close.or_else(|| field.lowest(patch, uv, field.radius, near))
            }
            Swath::Other(field) => field.lowest(patch, uv, DEEPEST, near),
        }?;
        Some(Left { height, line: swept.line })
    }
}
