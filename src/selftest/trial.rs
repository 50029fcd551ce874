//! A program on its way through a post: as far as it comes.

use super::sheet::Sheet;
use crate::diag::{Diagnostic, Severity, Sink};
use crate::ir::{Machine, Rotary};
use crate::lower;
use crate::post::{self, Dialect};
use crate::readback::{self, EventKind, FeedMode, MachineSetup, Trace, TraceEvent, TraceMove};
use crate::target::{Grid, TargetProgram, power_of_ten};
use crate::verify::{self, Emitted};

/// What the arithmetic of the reader may add to the rounding of printed numbers.
const ROUNDING: f64 = 1e-6;

/// What came of a program.
pub(super) struct Trial {
    /// Lines of the text, when there is one.
    pub text: Vec<String>,
    /// NC lines of the watched records, from 1.
    watched: Vec<u32>,
    /// What the control does with the text.
    pub trace: Trace,
    /// The text is CL data: a post that reads it makes the machine's moves.
    pub cl_data: bool,
    /// Whether the program was proven.
    pub proven: bool,
    /// All messages.
    pub messages: Vec<Diagnostic>,
    /// What numbers are rounded to.
    steps: Steps,
}

/// Half a step of printed numbers.
#[derive(Debug, Clone, Copy, Default)]
struct Steps {
    /// Of a linear axis, mm.
    linear: f64,
    /// Of a feed per minute, mm/min.
    feed: f64,
    /// Of a feed per revolution, mm.
    per_revolution: f64,
}

impl Steps {
    fn of(grid: &Grid) -> Steps {
        let half = |decimals: u8| 0.5 * grid.unit.in_mm() / power_of_ten(decimals);
        Steps {
            linear: 0.5 * grid.linear_step(),
            feed: half(grid.feed_decimals) / grid.feed_scale,
            per_revolution: half(grid.feed_per_revolution_decimals),
        }
    }
}

impl Trial {
    pub fn of(sheet: &Sheet, dialect: &Dialect) -> Trial {
        let mut sink = Sink::default();
        let made = make(sheet, dialect, &mut sink);
        let Some((target, emitted, rotary)) = made else {
            let (text, watched, trace) = (Vec::new(), Vec::new(), Trace::default());
            return Trial {
                text,
                watched,
                trace,
                cl_data: false,
                proven: false,
                messages: sink.into_items(),
                steps: Steps::default(),
            };
        };
        let control = dialect.control_with(&target.capabilities.options);
        let setup = MachineSetup { rotary, ..MachineSetup::default() };
        let trace = readback::run(emitted.text.as_bytes(), control, &setup).unwrap_or_default();
        let text = emitted.text.lines().map(str::to_owned).collect();
        let watched = watched_lines(&target, &emitted, sheet.watched);
        let proven = verify::prove(&sheet.cl, &target, emitted, control, &mut sink).is_some();
        let cl_data = target.capabilities.whole_points;
        let steps = Steps::of(&target.capabilities.grid);
        Trial { text, watched, trace, cl_data, proven, messages: sink.into_items(), steps }
    }

    /// Whether a length is the one that was asked for, mm, as far as printed numbers tell.
    pub fn is_at(&self, got: f64, wanted: f64) -> bool {
        (got - wanted).abs() <= self.steps.linear + ROUNDING
    }
    /// The same for the feed of a move, mm/min.
    pub fn feeds_at(&self, cut: &TraceMove, wanted: f64) -> bool {
        let step = match cut.feed_mode {
            FeedMode::PerRevolution => self.steps.per_revolution * cut.spindle.abs(),
            FeedMode::PerMinute | FeedMode::InverseTime => self.steps.feed,
        };
        cut.feed.is_some_and(|feed| (feed - wanted).abs() <= step + ROUNDING * wanted)
    }
    /// The watched lines.
    pub fn lines(&self) -> Vec<String> {
        let line = |n: &u32| self.text.get((*n as usize).checked_sub(1)?).cloned();
        self.watched.iter().filter_map(line).collect()
    }
    /// What the machine does in the watched lines.
    pub fn events(&self) -> impl Iterator<Item = &TraceEvent> {
        self.trace.events.iter().filter(|e| self.watched.binary_search(&e.line).is_ok())
    }
    /// Moves in the watched lines.
    pub fn moves(&self) -> impl Iterator<Item = &TraceMove> {
        self.events().filter_map(|e| if let EventKind::Move(cut) = &e.kind { Some(cut) } else { None })
    }
    /// Moves at feed in the watched lines.
    pub fn cuts(&self) -> impl Iterator<Item = &TraceMove> {
        self.moves().filter(|m| !m.rapid)
    }
    /// Dwells in the watched lines, s.
    pub fn dwells(&self) -> Vec<f64> {
        let dwell = |e: &TraceEvent| if let EventKind::Dwell(s) = e.kind { Some(s) } else { None };
        self.events().filter_map(dwell).collect()
    }
    /// The errors.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.messages.iter().filter(|d| d.severity == Severity::Error)
    }
}

fn make(
    sheet: &Sheet,
    dialect: &Dialect,
    sink: &mut Sink,
) -> Option<(TargetProgram, Emitted, Option<readback::Rotary>)> {
    let machine = Machine {
        post: dialect.name().to_owned(),
        rotary: sheet.rotary.then_some(Rotary { letter: None, reversed: false }),
        options: Vec::new(),
        origin: sheet.cl.records.first()?.origin,
    };
    let capabilities = match dialect.capabilities(sheet.cl.units, Some(&machine)) {
        Ok(capabilities) => capabilities,
        Err(error) => {
            sink.push(error);
            return None;
        }
    };
    let target = lower::lower(&sheet.cl, &capabilities, sink)?;
    match post::write(dialect, &target, &sheet.cl.origins) {
        Ok(written) => {
            let rotary = target.capabilities.rotary;
            let rotary = rotary.map(|r| readback::Rotary { letter: r.letter, reversed: r.reversed });
            Some((target, Emitted { text: written.text, lines: written.lines }, rotary))
        }
        Err(errors) => {
            errors.into_iter().for_each(|e| sink.push(e));
            None
        }
    }
}

/// The lines of all records from `first` on, in order.
fn watched_lines(target: &TargetProgram, emitted: &Emitted, first: usize) -> Vec<u32> {
    let blocks = target.blocks.iter().zip(&emitted.lines);
    let watched = blocks.filter(|(b, _)| b.record.is_some_and(|r| r as usize >= first));
    let mut lines: Vec<u32> = watched.flat_map(|(_, &(from, to))| from..to).collect();
    lines.sort_unstable();
    lines.dedup();
    lines
}
