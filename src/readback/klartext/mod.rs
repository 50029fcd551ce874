//! Heidenhain Klartext (TNC 640, iTNC 530), from its user's manuals and published posts.
//!
//! Blocks are numbered from 0 without a gap, `BEGIN PGM` and `END PGM` name the program and its unit, FMAX holds for its
//! block only, tool lengths come with the tool, and cycles are defined first and called at positions. Path tolerance: the
//! machine's own one is not counted, that of cycle 32 is.

use super::curve::Plane;
use super::out::Out;
use super::{Compensated, EventKind, FeedMode, Follow, MachineSetup, Washing};
use crate::geom::Point2;

mod blocks;
mod cycle;
mod motion;
mod spline;
mod words;

#[cfg(test)]
mod tests;

/// Name of the control.
pub(super) const NAME: &str = "heidenhain";

/// Largest position, mm or inch, feed and speed of a word.
const LARGEST: f64 = 99_999.999_9;
/// Longest block with its continuation lines, characters.
const LONGEST: usize = 10_000;

/// Executes a program line by line.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    setup: &'a MachineSetup,
    frame: Frame,
    /// A block whose lines end in `~` so far.
    pending: String,
    pending_line: u32,
    state: State,
}

/// What of the program's frame has been seen.
#[derive(Debug, Default)]
struct Frame {
    next: u64,
    name: Option<(String, bool)>,
    over: bool,
}

/// Modal state.
#[derive(Debug)]
struct State {
    /// X, Y, Z in mm, the rotary axis in degrees.
    position: [f64; 4],
    known: [bool; 4],
    parked: bool,
    inch: bool,
    /// The pole: its plane, and where it is there.
    pole: Option<(Plane, Point2)>,
    /// mm/min, or mm/rev under M136.
    feed: Option<f64>,
    per_revolution: bool,
    speed: f64,
    direction: f64,
    tool: u32,
    tool_axis: bool,
    coolant: Washing,
    compensation: Option<Compensated>,
    /// The next line in X or Y begins or ends it.
    compensation_due: bool,
    work_offset: Option<u16>,
    path_tolerance: f64,
    cycle: Option<cycle::Defined>,
    in_cycle: bool,
    ended: bool,
    /// Motion that a cycle's own lines (`CYCL DEF 9.1`) complete: number of the cycle whose title came.
    titled: Option<u32>,
}

impl<'a> Reader<'a> {
    /// A control with no program running.
    pub(super) fn new(setup: &'a MachineSetup) -> Self {
        let state = State {
            position: [0.0; 4],
            known: [false; 4],
            parked: false,
            inch: false,
            pole: None,
            feed: None,
            per_revolution: false,
            speed: 0.0,
            direction: 0.0,
            tool: 0,
            tool_axis: false,
            coolant: Washing::default(),
            compensation: None,
            compensation_due: false,
            work_offset: None,
            path_tolerance: 0.0,
            cycle: None,
            in_cycle: false,
            ended: false,
            titled: None,
        };
        Reader { setup, frame: Frame::default(), pending: String::new(), pending_line: 0, state }
    }

    /// mm in the unit of the program.
    fn unit(&self) -> f64 {
        if self.state.inch { 25.4 } else { 1.0 }
    }

    /// Executes a line without its end, or keeps it if the next one goes on with it.
    pub(super) fn line<S: Follow>(&mut self, line: &[u8], out: &mut Out<'_, S>) {
        if let Some(&c) = line.iter().find(|c| !(c.is_ascii_graphic() || matches!(c, b' ' | b'\t'))) {
            out.fault(format!("bad character: byte 0x{c:02X}"));
        }
        let text = String::from_utf8_lossy(line);
        // A block goes on after `~` at the line's end, behind a comment too.
        let (text, more) = match text.trim_end().strip_suffix('~') {
            Some(text) => (text, true),
            None => (text.as_ref(), false),
        };
        let text = text.split(';').next().unwrap_or_default().trim_end();
        let first = self.pending.is_empty();
        if first {
            self.pending_line = out.line;
        }
        if self.pending.len() + text.len() > LONGEST {
            out.fault(format!("a block of more than {LONGEST} characters"));
            self.pending.clear();
            return;
        }
        self.pending.push_str(text);
        self.pending.push(' ');
        if more {
            return;
        }
        let block = core::mem::take(&mut self.pending);
        let line = core::mem::replace(&mut out.line, self.pending_line);
        self.numbered(&block, line, out);
        out.line = line;
    }

    /// The text is over.
    pub(super) fn finish<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        if !self.pending.is_empty() {
            out.fault("the last block goes on with '~' and does not");
        }
        if !self.frame.over {
            out.fault("the program has no END PGM");
        }
    }

    /// Takes the number off a block and executes the rest.
    fn numbered<S: Follow>(&mut self, block: &str, last_line: u32, out: &mut Out<'_, S>) {
        let text = block.trim();
        if text.is_empty() && last_line == out.line && self.frame.over {
            return;
        }
        let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
        let (number, rest) = text.split_at(end);
        match number.parse::<u64>() {
            Ok(n) if n == self.frame.next && (rest.is_empty() || rest.starts_with(' ')) => {
                self.frame.next += 1
            }
            Ok(n) => {
                out.fault(format!("block number {n} where {} is next", self.frame.next));
                self.frame.next = n.saturating_add(1);
            }
            Err(_) => out.fault("a block without a number"),
        }
        if self.frame.over {
            return out.fault("a block after END PGM");
        }
        let rest = rest.trim();
        // Structure comments.
        if rest.is_empty() || rest.starts_with('*') {
            return;
        }
        if self.frame.name.is_none() {
            return self.begin(rest, out);
        }
        let words = words::words(rest, &mut |message| out.fault(message));
        self.block(&words, out);
    }

    fn begin<S: Follow>(&mut self, text: &str, out: &mut Out<'_, S>) {
        let parts: Vec<&str> = text.split_whitespace().collect();
        match parts.as_slice() {
            ["BEGIN", "PGM", name, unit @ ("MM" | "INCH")] => {
                self.state.inch = *unit == "INCH";
                self.frame.name = Some(((*name).to_owned(), self.state.inch));
            }
            _ => {
                out.fault("the program does not start with BEGIN PGM, its name and MM or INCH");
                self.frame.name = Some((String::new(), false));
            }
        }
    }

    fn end<S: Follow>(&mut self, words: &[words::Word], out: &mut Out<'_, S>) {
        let names: Vec<&str> =
            words.iter().map(|w| if let words::Word::Name(n) = w { n.as_str() } else { "" }).collect();
        let inch = self.state.inch;
        let same = |name: &str, unit: &str| {
            self.frame.name.as_ref().is_some_and(|(n, _)| n == name) && (unit == "INCH") == inch
        };
        let fits =
            matches!(names.as_slice(), ["END", "PGM", name, unit @ ("MM" | "INCH")] if same(name, unit));
        // A name that looks like an address is no name to the lexer.
        let looks = words.len() == 4 && !fits && matches!(words.get(2), Some(words::Word::Address(..)));
        if !fits && !looks {
            out.fault("END PGM does not name the program and the unit of BEGIN PGM");
        }
        if !self.state.ended && self.state.direction != 0.0 {
            out.fault("the program ends with the spindle turning");
        }
        self.frame.over = true;
        self.state.ended = true;
        self.state.direction = 0.0;
        out.event(EventKind::End);
    }

    fn feed_mode(&self) -> FeedMode {
        if self.state.per_revolution { FeedMode::PerRevolution } else { FeedMode::PerMinute }
    }
}
