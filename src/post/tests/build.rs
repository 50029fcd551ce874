//! Hand-made target programs.

use crate::arena::{Arena, Handle};
use crate::ir::{Machine, Origin, Rotary, Tool};
use crate::post::{Dialect, Written, write};
use crate::source::{FileId, Span};
use crate::target::{Block, BlockKind, FeedWord, Motion, Nurbs, Position, TargetProgram, axes};
use crate::units::LengthUnit;

/// A built-in dialect, or an example.
pub fn builtin(name: &str) -> Dialect {
    crate::post::examples::any(name)
}

/// A program under construction; positions are in steps.
pub struct Sheet {
    pub dialect: Dialect,
    pub program: TargetProgram,
    origins: Arena<Origin>,
    origin: Handle<Origin>,
    at: Position,
}

impl Sheet {
    pub fn new(dialect: Dialect, unit: LengthUnit, rotary: Option<char>) -> Sheet {
        let mut origins = Arena::default();
        let origin = origins.push(Origin { span: Span::new(FileId(0), 0, 1), calls: Vec::new() });
        let machine = Machine {
            post: dialect.name().into(),
            rotary: rotary.map(|letter| Rotary { letter: Some(letter), reversed: false }),
            options: Vec::new(),
            origin,
        };
        let capabilities = dialect.capabilities(unit, Some(&machine)).unwrap();
        let program = TargetProgram {
            title: None,
            capabilities,
            tools: vec![tool(origin)],
            pieces: Vec::new(),
            nurbs: Vec::new(),
            cycles: Vec::new(),
            blocks: Vec::new(),
        };
        let sheet = Sheet { dialect, program, origins, origin, at: Position::default() };
        sheet.event(BlockKind::Begin)
    }
    pub fn mm(name: &str) -> Sheet {
        Sheet::new(builtin(name), LengthUnit::Millimetre, None)
    }
    /// A program whose machine is at a known point.
    pub fn at(name: &str, x: i64, y: i64) -> Sheet {
        Sheet::mm(name).rapid(x, y, 0, axes::X | axes::Y | axes::Z)
    }
    pub fn title(mut self, title: &str) -> Sheet {
        self.program.title = Some(title.into());
        self
    }
    pub fn event(mut self, kind: BlockKind) -> Sheet {
        self.program.blocks.push(Block { kind, origin: self.origin, piece: None, record: None });
        self
    }
    pub fn rapid(mut self, x: i64, y: i64, z: i64, moved: u8) -> Sheet {
        self.at = Position { x, y, z, ..self.at };
        let to = self.at;
        self.event(BlockKind::Motion(Motion::Rapid { to, axes: moved }))
    }
    pub fn line_at(mut self, x: i64, y: i64, z: i64, r: i64, feed: FeedWord) -> Sheet {
        self.at = Position { x, y, z, r };
        let to = self.at;
        self.event(BlockKind::Motion(Motion::Line { to, feed }))
    }
    /// 300 units a minute.
    pub fn minute(&self) -> FeedWord {
        FeedWord::PerMinute(300 * 10i64.pow(u32::from(self.program.capabilities.grid.feed_decimals)))
    }
    pub fn line(self, x: i64, y: i64) -> Sheet {
        let (feed, at) = (self.minute(), self.at);
        self.line_at(x, y, at.z, at.r, feed)
    }
    pub fn line_z(self, z: i64) -> Sheet {
        let (feed, at) = (self.minute(), self.at);
        self.line_at(at.x, at.y, z, at.r, feed)
    }
    pub fn arc(mut self, x: i64, y: i64, centre: [i64; 2], clockwise: bool) -> Sheet {
        self.at = Position { x, y, ..self.at };
        let (to, feed) = (self.at, self.minute());
        self.event(BlockKind::Motion(Motion::Arc {
            to,
            plane: crate::target::Plane::Xy,
            centre,
            clockwise,
            feed,
        }))
    }
    pub fn position(&self) -> Position {
        self.at
    }
    /// The machine is here after the last block.
    pub fn at_position(mut self, at: Position) -> Sheet {
        self.at = at;
        self
    }
    pub fn nurbs(mut self, nurbs: Nurbs) -> Sheet {
        self.at = nurbs.end().unwrap_or(self.at);
        let curve = u32::try_from(self.program.nurbs.len()).unwrap();
        self.program.nurbs.push(nurbs);
        let feed = self.minute();
        self.event(BlockKind::Motion(Motion::Nurbs { curve, feed }))
    }
    /// A cycle over these holes, its surface at 0: 10 deep, clearance 2, from 50, in pecks of 4, with a dwell of
    /// half a second, to the clearance level.
    pub fn drill(mut self, kind: crate::cl::CycleKind, holes: &[(i64, i64)]) -> Sheet {
        let step = 10i64.pow(u32::from(self.program.capabilities.grid.linear_decimals));
        let index = u32::try_from(self.program.cycles.len()).unwrap();
        self.program.cycles.push(crate::target::Cycle {
            kind,
            surface: 0,
            bottom: -10 * step,
            clearance: 2 * step,
            initial: 50 * step,
            retract: crate::cl::RetractTo::Clearance,
            peck: Some(4 * step),
            dwell: Some(0.5),
            feed: self.minute(),
        });
        let mut sheet = self.event(BlockKind::BeginCycle(index));
        for &(x, y) in holes {
            sheet = sheet.event(BlockKind::Hole(Position { x: x * step, y: y * step, z: 0, r: 0 }));
        }
        sheet.event(BlockKind::EndCycle)
    }
    pub fn written(&self) -> Result<Written, Vec<crate::diag::Diagnostic>> {
        write(&self.dialect, &self.program, &self.origins)
    }
    pub fn text(&self) -> String {
        self.written().unwrap_or_else(|errors| panic!("{errors:#?}")).text
    }
    /// The lines after the header.
    pub fn body(&self) -> Vec<String> {
        self.after(0)
    }
    /// The lines after the first block that follows the header and brings the machine to its start.
    pub fn rest(&self) -> Vec<String> {
        self.after(1)
    }
    fn after(&self, block: usize) -> Vec<String> {
        let written = self.written().unwrap_or_else(|errors| panic!("{errors:#?}"));
        written.text.lines().skip(written.lines[block].1 as usize - 1).map(str::to_owned).collect()
    }
    /// The codes of the errors.
    pub fn codes(&self) -> Vec<&'static str> {
        self.written().err().unwrap_or_default().iter().map(|d| d.code.id).collect()
    }
}

fn tool(origin: Handle<Origin>) -> Tool {
    Tool::flat("T1", 16.0, Some(1), origin)
}
