//! An interpreter for emitted programs.
//!
//! # Contract
//! Written from the controllers' manuals; shares no code and no tables with `post`, `lower` or `target`. It
//! takes bytes and a controller family, executes them as that control would, applies the control's own
//! checks (arc radius, illegal in mode, missing feed, unknown or repeated word, line too long …) and gives
//! the [`Trace`]: what the machine does, in mm, radians and seconds.
//!
//! A control is a row of `word::rules::Rules` and its two code tables for the word-address family; another family is
//! another interpreter beside this one, behind the same [`run`]. Blocks are executed one by one and handed to a
//! [`Follow`]er as they come, so that the length of a program is no bound on memory.

mod apt;
mod curve;
mod klartext;
mod number;
mod out;
mod polynomial;
mod trace;
mod word;

#[cfg(test)]
mod tests;

pub use word::{Statement, statements};

pub(crate) use curve::point as nurbs_point;
pub use trace::{
    Compensated, EventKind, Fault, FeedMode, MOST_FAULTS, SpaceCurve, Tilted, Trace, TraceEvent, TraceMove,
    TracePath, Washing,
};

/// The machine about the control, as far as a program's meaning depends on it.
#[derive(Debug, Clone, Default)]
pub struct MachineSetup {
    /// Rotary table under the spindle, if there is one.
    pub rotary: Option<Rotary>,
    /// Tool numbers in the tool table; `None`: any.
    pub tools: Option<Vec<u32>>,
    /// Names in the tool table and their numbers, for controls that call tools by name.
    pub tool_names: Vec<(String, u32)>,
}

/// A rotary table whose axis is the part's Z axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rotary {
    /// Address letter, upper case.
    pub letter: char,
    /// Against ISO 841: programmed + moves the tool clockwise relative to the work.
    pub reversed: bool,
}

impl MachineSetup {
    fn rotary_letter(&self) -> Option<u8> {
        self.rotary
            .and_then(|r| u8::try_from(r.letter).ok())
            .filter(|l| matches!(l, b'A'..=b'C' | b'U'..=b'W'))
    }
}

/// Takes what the machine does, as it does it.
pub trait Follow {
    /// A move or an event.
    fn event(&mut self, event: TraceEvent);
    /// A complaint of the control.
    fn fault(&mut self, fault: Fault);
    /// Something the program leaves to the control's settings.
    fn assumed(&mut self, what: Fault);
}

/// No control can be read as this text describes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownControl {
    control: String,
    why: Option<String>,
}

impl UnknownControl {
    /// The name that is unknown; `None` where a statement behind a known one is wrong.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.control.split_whitespace().next().filter(|_| self.why.is_none())
    }
}

impl core::fmt::Display for UnknownControl {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let control = self.control.split_whitespace().next().unwrap_or_default();
        match &self.why {
            Some(why) => write!(f, "what is said of the control '{control}' means nothing: {why}"),
            None => {
                let known = controls().collect::<Vec<_>>().join(", ");
                write!(f, "no interpreter for the control '{control}'; there are {known}")
            }
        }
    }
}

impl core::error::Error for UnknownControl {}

/// Names of the controls that can be read.
pub fn controls() -> impl Iterator<Item = &'static str> {
    word::CONTROLS.into_iter().map(|rules| rules.name).chain([klartext::NAME, apt::NAME])
}

/// What a cut on this control needs, as facts of the control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Needs {
    /// A tool must have been changed in by the program.
    pub tool_change: bool,
    /// Tool length must have been taken in by the program (G43).
    pub length_offset: bool,
}

/// What a cut on `control` needs.
///
/// # Errors
/// When no control can be read as the text says.
pub fn needs(control: &str) -> Result<Needs, UnknownControl> {
    match find(control)? {
        Found::Word(stated) => {
            Ok(Needs { tool_change: stated.rules.tool_change, length_offset: stated.rules.length_offset })
        }
        Found::Klartext | Found::Apt => Ok(Needs { tool_change: true, length_offset: false }),
    }
}

/// A control by its family.
enum Found {
    Word(Box<word::Stated>),
    Klartext,
    Apt,
}

fn find(control: &str) -> Result<Found, UnknownControl> {
    let refused = |why: Option<String>| UnknownControl { control: control.to_owned(), why };
    match word::find(control) {
        Some(Ok(stated)) => Ok(Found::Word(Box::new(stated))),
        Some(Err(why)) => Err(refused(Some(why))),
        None => {
            let mut words = control.split_whitespace();
            let found = match words.next() {
                Some(klartext::NAME) => Found::Klartext,
                Some(apt::NAME) => Found::Apt,
                _ => return Err(refused(None)),
            };
            let more =
                words.next().map(|word| format!("`{word}`: only word-address controls take statements"));
            more.map_or(Ok(found), |why| Err(refused(Some(why))))
        }
    }
}

/// Executes a program and gathers what the machine does.
///
/// # Errors
/// When no control has this name.
pub fn run(text: &[u8], control: &str, machine: &MachineSetup) -> Result<Trace, UnknownControl> {
    let mut trace = Trace::default();
    run_with(text, control, machine, &mut trace)?;
    Ok(trace)
}

/// Executes a program and hands on what the machine does while it does it. Memory is bounded by the longest line (and
/// the longest NURBS curve).
///
/// # Errors
/// When no control has this name.
pub fn run_with<S: Follow>(
    text: &[u8],
    control: &str,
    machine: &MachineSetup,
    sink: &mut S,
) -> Result<(), UnknownControl> {
    let mut interpreter = Interpreter::new(control, machine)?;
    for line in text.split_inclusive(|&c| c == b'\n') {
        interpreter.line(line, sink);
    }
    interpreter.finish(sink);
    Ok(())
}

/// An interpreter that is fed line by line.
#[derive(Debug)]
pub struct Interpreter<'a> {
    reader: Reader<'a>,
    line: u32,
}

/// One interpreter for each family of languages.
#[derive(Debug)]
enum Reader<'a> {
    Word(Box<word::Reader<'a>>),
    Klartext(Box<klartext::Reader<'a>>),
    Apt(Box<apt::Reader<'a>>),
}

impl<'a> Interpreter<'a> {
    /// A control as it stands after power-on.
    ///
    /// # Errors
    /// When no control has this name.
    pub fn new(control: &str, setup: &'a MachineSetup) -> Result<Self, UnknownControl> {
        let reader = match find(control)? {
            Found::Word(stated) => Reader::Word(Box::new(word::Reader::new(*stated, setup))),
            Found::Klartext => Reader::Klartext(Box::new(klartext::Reader::new(setup))),
            Found::Apt => Reader::Apt(Box::new(apt::Reader::new(setup))),
        };
        Ok(Interpreter { reader, line: 0 })
    }

    /// Executes a line, with or without its line end.
    pub fn line<S: Follow>(&mut self, line: &[u8], sink: &mut S) {
        self.line = self.line.saturating_add(1);
        let line = line.strip_suffix(b"\n").unwrap_or(line);
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        let mut out = out::Out { sink, line: self.line };
        match &mut self.reader {
            Reader::Word(reader) => reader.line(line, &mut out),
            Reader::Klartext(reader) => reader.line(line, &mut out),
            Reader::Apt(reader) => reader.line(line, &mut out),
        }
    }

    /// The text is over.
    pub fn finish<S: Follow>(&mut self, sink: &mut S) {
        let mut out = out::Out { sink, line: self.line };
        match &mut self.reader {
            Reader::Word(reader) => reader.finish(&mut out),
            Reader::Klartext(reader) => reader.finish(&mut out),
            Reader::Apt(reader) => reader.finish(&mut out),
        }
    }
}
