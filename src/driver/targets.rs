//! From cutter location data to proven programs, one for every post, in parallel and in order.

use std::path::Path;

use rayon::prelude::*;

use super::{Keep, Options, Output, shelve};
use crate::arena::Arena;
use crate::cl::Cl;
use crate::diag::codes::command as codes;
use crate::diag::{Diagnostic, Label, Severity, Sink};
use crate::ir::{Machine, Origin, Program};
use crate::post::{self, Dialect};
use crate::source::{FileProvider, SourceMap, Span};
use crate::target::Capabilities;
use crate::units::LengthUnit;
use crate::verify::{self, Emitted, Place, Proven, Shortfall};
use crate::{lower, target};

/// The machines that a program names, with the places of their statements.
#[derive(Default)]
pub(super) struct Machines<'a> {
    units: LengthUnit,
    named: Vec<(&'a Machine, Span)>,
}

impl<'a> Machines<'a> {
    pub fn of(program: &'a Program) -> Machines<'a> {
        let place = |m: &'a Machine| (m, program.origins[m.origin].span);
        Machines { units: program.units, named: program.machines.iter().map(place).collect() }
    }
}

/// A post that is wanted, and the `MACHIN` statement that describes its machine.
pub(super) struct Wanted<'a> {
    name: String,
    machine: Option<(&'a Machine, Span)>,
}

/// The posts of the command line, or else those of the program.
pub(super) fn wanted<'a>(options: &Options, machines: &Machines<'a>, sink: &mut Sink) -> Vec<Wanted<'a>> {
    let machines = &machines.named;
    let of_machine =
        |name: &str| machines.iter().find(|(m, _)| m.post.eq_ignore_ascii_case(&short_name(name))).copied();
    let default = options.default_post.iter().filter(|_| machines.is_empty() && options.posts.is_empty());
    let named: Vec<&String> = options.posts.iter().chain(default).collect();
    if !named.is_empty() {
        return named.into_iter().map(|n| Wanted { name: n.clone(), machine: of_machine(n) }).collect();
    }
    if machines.is_empty() {
        sink.push(Diagnostic::global(&codes::NO_POST, "no post is named").help(
            "name one with --post, or in the program with `MACHIN/ LINUXCNC`; `partwright check` needs none",
        ));
    }
    machines.iter().map(|m| Wanted { name: m.0.post.clone(), machine: Some(*m) }).collect()
}

/// Reports what is wrong with posts that will not be used, because the program has errors or is only checked.
pub(super) fn check(
    options: &Options,
    machines: &Machines<'_>,
    files: &dyn FileProvider,
    sources: &mut SourceMap,
    sink: &mut Sink,
) {
    if options.posts.is_empty() && machines.named.is_empty() {
        return;
    }
    for one in wanted(options, machines, sink) {
        prepare(machines.units, &one, options, files, sources, sink);
    }
}

/// `shop/mill.post.toml` is called `mill`.
fn short_name(name: &str) -> String {
    let file = Path::new(name).file_name().map_or_else(|| name.into(), |f| f.to_string_lossy());
    file.strip_suffix(".post.toml").unwrap_or(&file).to_owned()
}

/// A post with what its control can do.
pub(super) struct Ready {
    pub dialect: Dialect,
    pub capabilities: Capabilities,
}

impl Ready {
    /// The output of this post, without a program.
    pub fn output(&self, units: LengthUnit) -> Output {
        Output {
            post: short_name(self.dialect.name()),
            extension: self.dialect.extension().to_owned(),
            units,
            target: None,
            lines: Vec::new(),
            proven: None,
        }
    }
}

/// The posts that are wanted; none where something is wrong with one of them.
pub(super) fn ready(
    units: LengthUnit,
    wanted: &[Wanted<'_>],
    options: &Options,
    files: &dyn FileProvider,
    sources: &mut SourceMap,
    sink: &mut Sink,
) -> Vec<Ready> {
    let ready = wanted.iter().filter_map(|w| prepare(units, w, options, files, sources, sink)).collect();
    if sink.has_errors() { Vec::new() } else { ready }
}

/// What came of all posts.
pub(super) struct Made {
    pub outputs: Vec<Output>,
    pub messages: Sink,
    /// Where passes must lie closer; none unless that alone is wrong.
    pub short: Vec<Shortfall>,
}

/// Makes the program of every post; its text goes to the shelf as soon as it is proven.
pub(super) fn make(cl: &Cl, ready: &[Ready], sources: &SourceMap, keep: Keep<'_>) -> Made {
    let one = |(index, ready): (usize, &Ready)| {
        let mut made = one(cl, ready, sources);
        if keep.only_nc {
            (made.output.target, made.output.lines) = (None, Vec::new());
        }
        shelve(index, &mut made.output, keep.shelf);
        made
    };
    let made: Vec<One> = match ready {
        [only] => vec![one((0, only))],
        several => several.par_iter().enumerate().map(one).collect(),
    };
    let mut all = Made { outputs: Vec::new(), messages: Sink::default(), short: Vec::new() };
    let curable = made.iter().all(|one| one.output.proven.is_some() || !one.short.is_empty());
    for one in made {
        all.outputs.push(one.output);
        all.messages.append(one.messages);
        all.short.extend(one.short.into_iter().filter(|_| curable));
    }
    all
}

/// What came of one post.
struct One {
    output: Output,
    messages: Sink,
    short: Vec<Shortfall>,
}

pub(super) fn prepare(
    units: LengthUnit,
    wanted: &Wanted<'_>,
    options: &Options,
    files: &dyn FileProvider,
    sources: &mut SourceMap,
    sink: &mut Sink,
) -> Option<Ready> {
    let place = wanted.machine.map(|(_, span)| span);
    let mut report = |mut diagnostic: Diagnostic| {
        if diagnostic.primary.is_none() {
            diagnostic.primary = place.map(|span| Label { span, message: String::new() });
        }
        sink.push(diagnostic);
    };
    let dialect = match post::load_with(&wanted.name, &options.post_set, files, sources) {
        Ok(dialect) => dialect,
        Err(errors) => {
            errors.into_iter().for_each(report);
            return None;
        }
    };
    match dialect.capabilities(units, wanted.machine.map(|(m, _)| m)) {
        Ok(capabilities) => Some(Ready { dialect, capabilities }),
        Err(error) => {
            report(error);
            None
        }
    }
}

/// Lowers, writes and proves one program.
fn one(cl: &Cl, ready: &Ready, sources: &SourceMap) -> One {
    let (mut sink, mut short) = (Sink::default(), Vec::new());
    let target = lower::lower(cl, &ready.capabilities, &mut sink);
    let emitted = target.as_ref().and_then(|t| written(&ready.dialect, t, &cl.origins, &mut sink));
    let lines = emitted.as_ref().map(|e| e.lines.clone()).unwrap_or_default();
    let mut proven = None;
    if let Some((target, emitted)) = target.as_ref().zip(emitted) {
        let control = ready.dialect.control_with(&ready.capabilities.options);
        match verify::prove_or_tell(cl, target, emitted, control, &mut sink) {
            Ok(mut found) => {
                locate(&mut found, sources);
                proven = Some(found);
            }
            Err(places) => short = places,
        }
    }
    let output = Output { target, lines, proven, ..ready.output(cl.units) };
    One { output, messages: sink, short }
}

/// Says in the certificate where the operations stand.
pub(super) fn locate(proven: &mut Proven, sources: &SourceMap) {
    proven.locate(|span| {
        let file = sources.file(span.file);
        let (line, column) = file.line_column(span.start);
        Place { file: file.name.clone(), line, column }
    });
}

fn written(
    dialect: &Dialect,
    target: &target::TargetProgram,
    origins: &Arena<Origin>,
    sink: &mut Sink,
) -> Option<Emitted> {
    match post::write(dialect, target, origins) {
        Ok(written) => Some(Emitted { text: written.text, lines: written.lines }),
        Err(errors) => {
            debug_assert!(errors.iter().any(|e| e.severity == Severity::Error));
            errors.into_iter().for_each(|e| sink.push(e));
            None
        }
    }
}
