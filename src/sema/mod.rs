//! Syntax tree to [`ir`]: names, dimensions, evaluation of macros and loops, and all checks that need no tool
//! path. Every mistake of a program comes out of one run; what failed is *poisoned*, and its uses stay silent.

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::arena::Handle;
use crate::diag::{Diagnostic, Sink};
use crate::ir;
use crate::source::{FileId, FileProvider, SourceMap, Span};
use crate::syntax::{self, ast};
use crate::units::{Dim, LengthUnit, Quantity};

mod arguments;
mod arithmetic;
mod blocks;
mod cad;
mod cam;
mod circles;
mod control;
mod curves;
mod cutter;
mod cycle;
mod declare;
mod elements;
mod expression;
mod forms;
mod functions;
mod geometry;
mod include;
mod limits;
mod macros;
mod matched;
mod members;
mod misfits;
mod motion;
mod moves;
mod operation;
mod parameter;
mod patterns;
mod planes;
mod process;
mod report;
mod run;
mod scope;
mod slots;
mod surface;
mod table;
mod tokens;
mod transform;
mod value;

use report::{Call, Report};
use scope::Scope;

/// What the command line says to the program.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// `-D NAME=VALUE`, as given.
    pub defines: Vec<(String, String)>,
    /// What stands behind column 72 of a line is no part of the program.
    pub card_columns: bool,
}

/// Evaluates the program in file `main`. `None` after errors, all of which are in `sink`. Included files and
/// tables are read through `files` and added to `sources`.
pub fn analyse(
    main: FileId,
    sources: &mut SourceMap,
    files: &dyn FileProvider,
    options: &Options,
    sink: &mut Sink,
) -> Option<ir::Program> {
    let text = sources.file(main).text.clone();
    let tree = syntax::parse_columns(main, &text, options.card_columns, sink);
    analyse_tree(tree, sources, files, options, sink).ok()
}

/// As [`analyse`], of a main file that has been parsed.
///
/// # Errors
/// After errors, the program as far as it was understood.
pub fn analyse_tree(
    tree: ast::Program,
    sources: &mut SourceMap,
    files: &dyn FileProvider,
    options: &Options,
    sink: &mut Sink,
) -> Result<ir::Program, Box<ir::Program>> {
    let mut analyser = Analyser::new(tree.file, sources, files, options);
    analyser.main(tree);
    let Analyser { program, report, syntax, .. } = analyser;
    let failed = report.errors() > 0 || syntax.has_errors();
    sink.append(syntax);
    report.finish(sink);
    if failed || sink.has_errors() { Err(Box::new(program)) } else { Ok(program) }
}

/// Why the rest of the program is not carried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// `FINI`.
    Fini,
    /// A limit was met.
    Limit,
}

struct Analyser<'a> {
    sources: &'a mut SourceMap,
    files: &'a dyn FileProvider,
    defines: Vec<parameter::Define>,
    program: ir::Program,
    report: Report,
    /// Messages of the parser about included files.
    syntax: Sink,
    scope: Scope,
    calls: Vec<Call>,
    /// The call chain as the IR's origins hold it, innermost last.
    call_spans: Vec<Span>,
    origins: BTreeMap<(Span, Vec<Span>), Handle<ir::Origin>>,
    state: process::State,
    /// First bare number that was read in the program's unit.
    unit_used: Option<Span>,
    /// The `UNITS` statement.
    unit_stated: Option<Span>,
    include: include::Includes,
    cad: cad::CadFiles,
    /// Nets under `TRACUT`, that each is made once: the net, the map, the image.
    images: Vec<(Handle<ir::NetEntity>, transform::Transform, Handle<ir::NetEntity>)>,
    card_columns: bool,
    executed: u64,
    ended: Option<End>,
    /// The statement being carried out.
    here: Span,
}

impl<'a> Analyser<'a> {
    fn new(main: FileId, sources: &'a mut SourceMap, files: &'a dyn FileProvider, options: &Options) -> Self {
        let here = Span::new(main, 0, 0);
        let include = include::Includes::new(sources, main);
        Analyser {
            defines: parameter::defines(options),
            sources,
            files,
            program: ir::Program::default(),
            report: Report::default(),
            syntax: Sink::default(),
            scope: Scope::default(),
            calls: Vec::new(),
            call_spans: Vec::new(),
            origins: BTreeMap::new(),
            state: process::State::default(),
            unit_used: None,
            unit_stated: None,
            include,
            cad: cad::CadFiles::default(),
            images: Vec::new(),
            card_columns: options.card_columns,
            executed: 0,
            ended: None,
            here,
        }
    }

    fn main(&mut self, tree: ast::Program) {
        let code = self.load(tree);
        self.run(&code, 0..code.program.statements.len());
        self.unused_defines();
    }

    /// Matches the blocks of a parsed file.
    fn load(&mut self, tree: ast::Program) -> Rc<blocks::Code> {
        let text = self.sources.file(tree.file).text.clone();
        let (code, problems) = blocks::match_blocks(tree, &text);
        for problem in problems {
            self.report(problem);
        }
        Rc::new(code)
    }

    /// Adds a message, with the calls that led here.
    fn report(&mut self, diagnostic: Diagnostic) {
        self.report.push(diagnostic, &self.calls, self.executed);
    }

    /// The program's unit of length.
    fn unit(&self) -> LengthUnit {
        self.program.units
    }

    /// A quantity for messages.
    fn show(&self, quantity: Quantity) -> String {
        quantity.show(self.unit())
    }

    /// A length in mm for messages.
    fn show_length(&self, mm: f64) -> String {
        self.show(Quantity::new(mm, Dim::LENGTH))
    }

    /// The quantity as one of dimension `dim`; a bare number at `span` takes the program's unit.
    fn land(&mut self, quantity: Quantity, dim: Dim, span: Span) -> Option<Quantity> {
        if quantity.is_bare() && dim.length != 0 && quantity.value != 0.0 && self.unit_used.is_none() {
            self.unit_used = Some(span);
        }
        quantity.land(dim, self.unit())
    }

    /// The origin of what the statement at `span` makes.
    fn origin(&mut self, span: Span) -> Handle<ir::Origin> {
        let key = (span, self.calls_of_origins());
        if let Some(&known) = self.origins.get(&key) {
            return known;
        }
        let handle = self.program.origins.push(ir::Origin { span, calls: key.1.clone() });
        self.origins.insert(key, handle);
        handle
    }

    /// The calls that led here; of very many, the outermost and the innermost.
    fn calls_of_origins(&self) -> Vec<Span> {
        let half = limits::ORIGIN_CALLS / 2;
        let calls = &self.call_spans;
        match (calls.get(..half), calls.len().checked_sub(half).and_then(|i| calls.get(i..))) {
            (Some(outer), Some(inner)) if calls.len() > limits::ORIGIN_CALLS => [outer, inner].concat(),
            _ => calls.clone(),
        }
    }

    /// Adds a step made by the statement being carried out.
    fn step(&mut self, kind: ir::StepKind) {
        if self.program.steps.len() >= limits::STEPS {
            self.limit(format!("the program makes more than {} steps", limits::STEPS));
            return;
        }
        let origin = self.origin(self.here);
        self.program.steps.push(ir::Step { kind, origin });
    }

    /// Reports that a size limit is met, and ends the program.
    fn limit(&mut self, message: String) {
        if self.ended.is_none() {
            let diagnostic = Diagnostic::new(&crate::diag::codes::semantics::SIZE_LIMIT, self.here, message);
            self.report(diagnostic);
            self.ended = Some(End::Limit);
        }
    }
}

#[cfg(test)]
mod definitions_tests;
#[cfg(test)]
mod tests;
