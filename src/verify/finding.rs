//! What verification can find, and how it is said.

use crate::arena::Handle;
use crate::cl::Cl;
use crate::diag::codes::verification as codes;
use crate::diag::{Code, Diagnostic, Sink};
use crate::geom::Point3;
use crate::ir::Origin;
use crate::readback::Trace;
use crate::target::TargetProgram;
use crate::units::LengthUnit;

use super::Shortfall;
use super::plan::Lines;

/// Findings of one code that are shown one by one; the rest are counted.
const SHOWN: usize = 10;

/// One finding.
#[derive(Debug, Clone)]
pub(super) struct Finding {
    code: &'static Code,
    line: u32,
    block: Option<usize>,
    text: Text,
    notes: Vec<Text>,
    help: Option<String>,
    /// Where passes that lie closer would help; all of it, where there are any.
    short: Vec<Shortfall>,
}

/// A sentence whose lengths are printed in the program's unit when it is known.
#[derive(Debug, Clone, Default)]
pub(super) struct Text(Vec<Part>);

#[derive(Debug, Clone)]
enum Part {
    Words(String),
    Length(f64),
    Feed(f64),
}

impl Text {
    pub(super) fn words(mut self, words: impl Into<String>) -> Self {
        self.0.push(Part::Words(words.into()));
        self
    }
    /// A length in mm.
    pub(super) fn length(mut self, mm: f64) -> Self {
        self.0.push(Part::Length(mm));
        self
    }
    /// A feed in mm/min.
    pub(super) fn feed(mut self, mm_per_minute: f64) -> Self {
        self.0.push(Part::Feed(mm_per_minute));
        self
    }
    /// A point in mm.
    pub(super) fn point(self, x: f64, y: f64) -> Self {
        self.words("X ").length(x).words(", Y ").length(y)
    }
    /// A place in space, mm.
    pub(super) fn place(self, p: Point3) -> Self {
        self.point(p.x, p.y).words(", Z ").length(p.z)
    }

    fn render(&self, unit: LengthUnit) -> String {
        let mut text = String::new();
        for part in &self.0 {
            match part {
                Part::Words(words) => text.push_str(words),
                Part::Length(mm) => text.push_str(&length(*mm, unit)),
                Part::Feed(f) => {
                    text.push_str(&format!("{} {}/min", decimals(f / unit.in_mm(), 3), unit.symbol()))
                }
            }
        }
        text
    }
}

/// A length with six decimals of a millimetre, seven of an inch, trailing zeros dropped.
fn length(mm: f64, unit: LengthUnit) -> String {
    let places = if unit == LengthUnit::Inch { 7 } else { 6 };
    format!("{} {}", decimals(mm / unit.in_mm(), places), unit.symbol())
}

fn decimals(value: f64, places: usize) -> String {
    let text = format!("{value:.places$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

impl Finding {
    pub(super) fn new(code: &'static Code, line: u32, block: Option<usize>, text: Text) -> Self {
        Finding { code, line, block, text, notes: Vec::new(), help: None, short: Vec::new() }
    }
    pub(super) fn note(mut self, text: Text) -> Self {
        self.notes.push(text);
        self
    }
    /// The same, where passes that lie closer would help.
    pub(super) fn with_short(mut self, short: Vec<Shortfall>) -> Self {
        self.short = short;
        self
    }
    /// Where passes that lie closer would help.
    pub(super) fn short(&self) -> &[Shortfall] {
        &self.short
    }
    fn help(self, help: String) -> Self {
        Finding { help: Some(help), ..self }
    }
    pub(super) fn line(&self) -> u32 {
        self.line
    }
    /// The same, put down to the `INSERT` block with this index and line.
    pub(super) fn due_to_insert(&self, (block, line): (usize, u32)) -> Self {
        let text = Text::default().words("after this block the control does not do what the program says");
        let place = if self.line == 0 { String::new() } else { format!("line {}: ", self.line) };
        let mut said = Text::default().words(place);
        said.0.extend(self.text.0.iter().cloned());
        let code = &crate::diag::codes::planning::INSERT_SPOILS;
        let finding = Finding::new(code, line, Some(block), text)
            .note(said)
            .note(Text::default().words("without the inserted blocks the program is proven"));
        Finding { help: self.help.clone(), ..finding }
    }
}

/// Complaints of the control, and what the program leaves to its settings.
pub(super) fn of_control(trace: &Trace, lines: &Lines) -> Vec<Finding> {
    let faults = trace.faults.iter().map(|f| (&codes::REFUSED_BY_CONTROL, f));
    let assumed = trace.assumed.iter().map(|f| (&codes::LEFT_TO_SETTINGS, f));
    faults
        .chain(assumed)
        .map(|(code, f)| {
            let text = Text::default().words(f.message.clone());
            let finding = Finding::new(code, f.line, lines.block(f.line), text);
            match f.unknown_code() {
                Some(name) => finding.help(format!(
                    "where the machine has it and it neither moves nor stops anything, its post says `{name}=nothing` behind \
                     `control` in `[post]` (docs/readers.md)"
                )),
                None => finding,
            }
        })
        .collect()
}

/// Turns findings into diagnostics.
pub(super) struct Reporter<'a> {
    cl: &'a Cl,
    target: &'a TargetProgram,
    sink: &'a mut Sink,
    counts: Vec<(&'static Code, usize)>,
}

impl<'a> Reporter<'a> {
    pub(super) fn new(cl: &'a Cl, target: &'a TargetProgram, sink: &'a mut Sink) -> Self {
        Reporter { cl, target, sink, counts: Vec::new() }
    }

    pub(super) fn report(&mut self, finding: &Finding) {
        if self.count(finding.code) > SHOWN {
            return;
        }
        let unit = self.cl.units;
        let post = &self.target.capabilities.name;
        let text = finding.text.render(unit);
        let message = match finding.line {
            // What is missing stands in no line.
            0 => format!("in the {post} program: {text}"),
            line => format!("line {line} of the {post} program: {text}"),
        };
        let mut diagnostic = match self.origin(finding) {
            Some(origin) => with_calls(Diagnostic::new(finding.code, origin.span, message), origin),
            None => Diagnostic::global(finding.code, message),
        };
        for note in &finding.notes {
            diagnostic = diagnostic.note(note.render(unit));
        }
        if let Some(help) = &finding.help {
            diagnostic = diagnostic.help(help);
        }
        self.sink.push(diagnostic);
    }

    /// `true` when nothing was found.
    pub(super) fn finish(self) -> bool {
        let post = &self.target.capabilities.name;
        for (code, count) in &self.counts {
            if *count > SHOWN {
                let more = count - SHOWN;
                self.sink.push(Diagnostic::global(
                    code,
                    format!("{more} more of this kind in the {post} program ({})", code.title),
                ));
            }
        }
        self.counts.is_empty()
    }

    fn count(&mut self, code: &'static Code) -> usize {
        if let Some((_, count)) = self.counts.iter_mut().find(|(c, _)| *c == code) {
            *count += 1;
            return *count;
        }
        self.counts.push((code, 1));
        1
    }

    fn origin(&self, finding: &Finding) -> Option<&Origin> {
        let handle: Handle<Origin> = self.target.blocks.get(finding.block?)?.origin;
        Some(&self.cl.origins[handle])
    }
}

fn with_calls(mut diagnostic: Diagnostic, origin: &Origin) -> Diagnostic {
    for call in &origin.calls {
        diagnostic = diagnostic.label(*call, "called from here");
    }
    diagnostic
}

/// The dialect names a control that no interpreter knows.
pub(super) fn unknown_control(message: &str, sink: &mut Sink) {
    sink.push(
        Diagnostic::global(&codes::CANNOT_PROVE, message)
            .help("name the nearest of the controls listed as `control` in the post file"),
    );
}
