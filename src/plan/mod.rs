//! IR to CL: how an operation becomes moves: passes, linking, entry, clearance.
//!
//! Invariant: a step is planned from itself and the machine's state ([`state`]) alone; modal settings come
//! inside the operation. What is reported here is about the cut (no spindle, a cutter that does not fit), never
//! about words or names.

mod checks;
pub mod closer;
mod holes;
mod levels;
mod profile;
mod room;
mod rough;
mod state;
mod surface;
#[cfg(test)]
mod tests;
mod track;
mod waterline;

use crate::arena::Handle;
use crate::cl::{Cl, RecordKind};
use crate::diag::{Diagnostic, Sink};
use crate::ir::{Origin, Program, Step, StepKind};
use crate::source::Span;
use closer::Closer;
use state::State;

/// Cutter location data of a program; `None` after an error.
pub fn plan(program: &Program, sink: &mut Sink) -> Option<Cl> {
    plan_closer(program, &Closer::default(), sink)
}

/// The same, with passes that lie closer at some places.
pub fn plan_closer(program: &Program, closer: &Closer, sink: &mut Sink) -> Option<Cl> {
    let mut planner = Planner::new(program, closer);
    for step in &program.steps {
        planner.step(step);
    }
    let failed = planner.sink.has_errors();
    sink.append(planner.sink);
    (!failed).then_some(planner.cl)
}

/// What the planning of one program carries along.
struct Planner<'a> {
    program: &'a Program,
    closer: &'a Closer,
    cl: Cl,
    state: State,
    sink: Sink,
}

impl<'a> Planner<'a> {
    fn new(program: &'a Program, closer: &'a Closer) -> Planner<'a> {
        let cl = Cl {
            title: program.title.clone(),
            units: program.units,
            tools: program.tools.clone(),
            origins: program.origins.clone(),
            operations: Vec::new(),
            records: Vec::new(),
        };
        Planner { program, closer, cl, state: State::default(), sink: Sink::default() }
    }

    fn step(&mut self, step: &Step) {
        let origin = step.origin;
        if !matches!(step.kind, StepKind::Hole(_) | StepKind::Feed(_)) {
            self.close_cycle(origin);
        }
        match &step.kind {
            StepKind::LoadTool(tool) => self.load(*tool, origin),
            StepKind::Spindle(spindle) => self.spindle(*spindle, origin),
            StepKind::Feed(feed) => self.feed(*feed, origin),
            StepKind::Coolant(coolant) => self.emit(RecordKind::Coolant(*coolant), origin),
            StepKind::Compensation(on) => self.emit(RecordKind::Compensation(*on), origin),
            StepKind::Dwell(seconds) => self.emit(RecordKind::Dwell(*seconds), origin),
            StepKind::Stop => self.emit(RecordKind::Stop, origin),
            StepKind::OptionalStop => self.emit(RecordKind::OptionalStop, origin),
            StepKind::Comment(text) => self.emit(RecordKind::Comment(text.clone()), origin),
            StepKind::Insert(text) => self.emit(RecordKind::Insert(text.clone()), origin),
            StepKind::From(point) => self.from(*point, origin),
            StepKind::Goto { to, rapid: true } => self.rapid(*to, origin),
            StepKind::Goto { to, rapid: false } => self.goto(*to, origin),
            StepKind::BeginCycle(asked) => self.begin_cycle(asked),
            StepKind::Hole(point) => self.hole(*point, origin),
            StepKind::EndCycle => self.end_cycle(origin),
            StepKind::Profile(profile) => self.profile(profile, origin),
            StepKind::RoughCam(rough) => self.rough(rough, origin),
            StepKind::Surface(surface) => self.surface(surface, origin),
            StepKind::RoughNet(rough) => self.rough_net(rough, origin),
        }
    }

    /// The span of a statement.
    fn span(&self, origin: Handle<Origin>) -> Span {
        self.program.origins[origin].span
    }

    /// Reports; a mistake inside a macro also shows the calls that led there.
    fn report(&mut self, mut diagnostic: Diagnostic, origin: Handle<Origin>) {
        for call in self.program.origins[origin].calls.iter().rev() {
            diagnostic = diagnostic.label(*call, "called from here");
        }
        self.sink.push(diagnostic);
    }

    /// A length in the program's unit, with the unit, to a tenth of a micron.
    fn show(&self, mm: f64) -> String {
        crate::plan::show_length(mm, self.program.units)
    }
}

/// A length in `unit`, with its symbol, to about a tenth of a micron.
fn show_length(mm: f64, unit: crate::units::LengthUnit) -> String {
    let digits = match unit {
        crate::units::LengthUnit::Millimetre => 1e4,
        crate::units::LengthUnit::Inch => 1e5,
    };
    let value = (mm / unit.in_mm() * digits).round() / digits;
    format!("{} {}", crate::cl::print::number(value), unit.symbol())
}
