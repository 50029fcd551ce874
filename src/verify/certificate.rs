//! The certificate: what was measured on the emitted text.

use serde::Serialize;

use crate::geom::Point2;
use crate::ir::{Band, Interpolation};
use crate::source::Span;

/// Version of the certificate's shape; a field that changes its meaning or goes away raises it.
pub const VERSION: u32 = 1;

/// What was proven of one NC program.
#[derive(Debug, Clone, Serialize)]
pub struct Certificate {
    /// Shape of this record, [`VERSION`].
    pub version: u32,
    /// Post that made the text.
    pub post: String,
    /// Control whose interpreter read it back.
    pub control: String,
    /// SHA-256 of the text, hexadecimal.
    pub digest: String,
    /// Bytes of the text.
    pub bytes: u64,
    /// Lines of the text.
    pub lines: u32,
    /// Moves by kind.
    pub moves: Moves,
    /// Time.
    pub time: Time,
    /// No reported deviation falls short of the true one by more than this, mm.
    pub accuracy: f64,
    /// Operations in order.
    pub operations: Vec<OperationProof>,
}

/// Moves of a program by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Moves {
    /// Rapids.
    pub rapids: u64,
    /// Lines at feed.
    pub lines: u64,
    /// Arcs and circles.
    pub arcs: u64,
    /// Archimedean spirals of a rotary table.
    pub spirals: u64,
    /// NURBS curves.
    pub nurbs: u64,
}

/// Estimated time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Time {
    /// Cutting at feed, s.
    pub cutting: f64,
    /// Rapids at [`RAPID_RATE`], s.
    pub rapid: f64,
    /// Dwells, s.
    pub dwell: f64,
    /// What the estimate leaves out.
    pub model: &'static str,
}

/// Speed that the time estimate gives to rapids, mm/min.
pub const RAPID_RATE: f64 = 5000.0;

/// [`Time::model`].
pub const TIME_MODEL: &str =
    "every move at its feed, rapids at 5000 mm/min; no acceleration, no tool changes";

/// Where a statement stands, for people.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Place {
    /// File as the user named it.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
}

/// What was proven of one operation.
#[derive(Debug, Clone, Serialize)]
pub struct OperationProof {
    /// Its label.
    pub name: String,
    /// `PROFIL`, `ROUGH` …
    pub kind: &'static str,
    /// Its statement.
    #[serde(skip)]
    pub span: Option<Span>,
    /// The same for people; set by [`Certificate::locate`].
    pub source: Option<Place>,
    /// Tolerance asked for, mm.
    pub tolerance: Band,
    /// Largest deviation into the part over all pieces, if any was measured.
    pub into: Option<Deviation>,
    /// Largest deviation out of the part.
    pub out: Option<Deviation>,
    /// Blocks of all pieces.
    pub blocks: u32,
    /// Contours in the order they are cut.
    pub pieces: Vec<PieceProof>,
    /// The finished surface, where the operation finishes one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface: Option<SurfaceProof>,
    /// The blank that is cleared, where the operation clears one down to a surface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearing: Option<ClearingProof>,
}

/// What was measured of a blank that is cleared in levels.
#[derive(Debug, Clone, Serialize)]
pub struct ClearingProof {
    /// The levels, from above.
    pub levels: Vec<ClearedLevel>,
    /// Length of the tip's path at feed, mm.
    pub cut: f64,
    /// Part of it on which nothing is cut, mm; an estimate.
    pub air: f64,
    /// Volume that is cut, mm³; an estimate.
    pub volume: f64,
    /// Volume over the section of a full cut as deep as a level, mm: shorter paths exist only where stairs deeper than that are
    /// cut at once.
    pub bound: f64,
    /// At least this stays on the surface everywhere, mm.
    pub left: f64,
}

/// One level of a clearing.
#[derive(Debug, Clone, Serialize)]
pub struct ClearedLevel {
    /// Height of the tip, mm.
    pub z: f64,
    /// Area in which the tip may be, mm².
    pub area: f64,
    /// Path at feed at this height, mm.
    pub length: f64,
    /// Area of it in which nothing is taken away over the whole depth of a level, mm².
    pub standing: f64,
}

/// What was proven of a finished surface.
#[derive(Debug, Clone, Serialize)]
pub struct SurfaceProof {
    /// Radius of the ball, mm.
    pub radius: f64,
    /// Stock that was to be left, mm.
    pub leave: f64,
    /// Largest height of cusps asked for, mm, if one was.
    pub cusp_asked: Option<f64>,
    /// Passes, and ways along the surface from one to the next.
    pub passes: u32,
    /// NC blocks of all of them.
    pub blocks: u32,
    /// Length of the tip's path along them, mm.
    pub length: f64,
    /// Deepest gouge of any move of the operation.
    pub into: Deviation,
    /// Farthest that a pass leaves the surface, as the ball sees it.
    pub out: Deviation,
    /// Highest ridge between passes above the path's own deviation beside it, as measured at the corners of all cells.
    pub cusp: Option<Deviation>,
    /// Most material found anywhere the ball can reach; 0 where it is less than half of what is allowed.
    pub left: Deviation,
    /// No more than this is left anywhere the ball can reach, mm; likewise.
    pub left_bound: f64,
    /// Most material found where the ball does not reach for its size.
    pub unreachable: Option<Deviation>,
    /// Area of the surface, mm².
    pub area: f64,
    /// Where the height of cusps was asked for, with a cutter that is no ball: area on which the cutter, let down anywhere, leaves more than may be left, mm².
    pub unreachable_area: Option<f64>,
    /// Likewise: area beside that, on which more is left since the cutter touches the surface only nearly, mm².
    pub beside_area: Option<f64>,
}

/// What was proven of one contour at one height.
#[derive(Debug, Clone, Serialize)]
pub struct PieceProof {
    /// Interpolation used.
    pub interpolation: Interpolation,
    /// Tip height, mm.
    pub z: f64,
    /// NC blocks that stand for the curve.
    pub blocks: u32,
    /// Proven lower bound on that number, where one is known.
    pub lower_bound: Option<u32>,
    /// Length of the exact curve, mm.
    pub length: f64,
    /// Largest deviation into the part.
    pub into: Deviation,
    /// Largest deviation out of the part.
    pub out: Deviation,
}

/// A measured extreme.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Deviation {
    /// mm, in the direction of its name; 0 when the path never goes that way.
    pub value: f64,
    /// Line of the text, from 1.
    pub line: u32,
    /// Where, mm.
    pub x: f64,
    /// Where, mm.
    pub y: f64,
    /// Where, mm.
    pub z: f64,
}

impl Deviation {
    pub(super) fn new(value: f64, line: u32, at: Point2, z: f64) -> Self {
        Deviation { value: value.max(0.0), line, x: at.x, y: at.y, z }
    }

    /// The larger of two.
    #[must_use]
    pub(super) fn or_larger(self, other: Option<Deviation>) -> Deviation {
        other.filter(|o| o.value >= self.value).unwrap_or(self)
    }
}

impl OperationProof {
    /// An operation of points: nothing is measured against an exact curve.
    #[must_use]
    pub fn unmeasured(operation: &crate::cl::Operation, span: Option<Span>) -> OperationProof {
        OperationProof {
            name: operation.name.clone(),
            kind: operation.kind,
            span,
            source: None,
            tolerance: operation.band,
            into: None,
            out: None,
            blocks: 0,
            pieces: Vec::new(),
            surface: None,
            clearing: None,
        }
    }
}

impl Certificate {
    /// Fills in [`OperationProof::source`].
    pub fn locate(&mut self, place: impl Fn(Span) -> Place) {
        for operation in &mut self.operations {
            operation.source = operation.span.map(&place);
        }
    }
}

impl Time {
    /// All of it, s.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.cutting + self.rapid + self.dwell
    }
}
