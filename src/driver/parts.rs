//! CL files to proven programs in parts, so that memory does not grow with their length beyond the texts themselves.
//!
//! The file is read twice: once for what a program says at its start (its tools) and for all messages, then part by part
//! through lowering, writing and proof. Writing runs ahead of the proof by a few parts at most; parts keep their order.

use std::sync::mpsc::{Receiver, sync_channel};

use super::targets::{self, Machines, Ready};
use super::{Options, Output, Shelf, shelve};
use crate::cl::Cl;
use crate::clfile::{self, Reader};
use crate::diag::Sink;
use crate::lower::stream::{Changes, Stream as Lowering};
use crate::post::Parts;
use crate::readback::MachineSetup;
use crate::source::{FileId, FileProvider, SourceMap, Span};
use crate::target::TargetProgram;
use crate::verify::stream::{self, Stream as Proof};
use crate::verify::{Emitted, OperationProof, Proven};

/// Records of one part.
const PART: usize = 1 << 12;
/// Parts that writing may be ahead of the proof.
const AHEAD: usize = 2;

/// A CL file and how it is to be read.
pub(super) struct ClFile<'a> {
    pub file: FileId,
    pub name: &'a str,
    pub text: &'a str,
    pub how: &'a clfile::Options,
}

impl<'a> ClFile<'a> {
    fn reader(&self) -> Reader<'a> {
        Reader::new(self.file, self.name, self.text, self.how)
    }
}

/// What the first reading finds.
struct Survey {
    /// The last chunk, with the tools and operations of the whole file and no records.
    cl: Cl,
    changes: Changes,
    places: Vec<Span>,
}

/// The programs of all wanted posts.
pub(super) fn make(
    file: &ClFile<'_>,
    options: &Options,
    (files, shelf): (&dyn FileProvider, &dyn Shelf),
    sources: &mut SourceMap,
    sink: &mut Sink,
) -> Vec<Output> {
    let survey = survey(file, sink);
    if sink.has_errors() {
        targets::check(options, &Machines::default(), files, sources, sink);
        return Vec::new();
    }
    let wanted = targets::wanted(options, &Machines::default(), sink);
    let ready: Vec<Ready> = wanted
        .iter()
        .filter_map(|w| targets::prepare(survey.cl.units, w, options, files, sources, sink))
        .collect();
    if sink.has_errors() {
        return Vec::new();
    }
    let sources = &*sources;
    ready
        .iter()
        .enumerate()
        .map(|(index, ready)| {
            let mut output = ready.output(survey.cl.units);
            output.proven = one(file, &survey, ready, sink);
            if let Some(proven) = &mut output.proven {
                targets::locate(proven, sources);
            }
            shelve(index, &mut output, shelf);
            output
        })
        .collect()
}

fn survey(file: &ClFile<'_>, sink: &mut Sink) -> Survey {
    let mut reader = file.reader();
    let mut survey = Survey { cl: Cl::default(), changes: Changes::default(), places: Vec::new() };
    while let Some(mut cl) = reader.chunk(PART) {
        for record in cl.records.drain(..) {
            survey.changes.record(&record);
        }
        survey.cl = cl;
    }
    survey.places = reader.operation_places().to_vec();
    sink.append(reader.messages());
    survey
}

/// A written part on its way to the proof.
struct Part {
    cl: Cl,
    target: TargetProgram,
    emitted: Emitted,
    last: bool,
}

/// One program: written on this thread, proven on another; on this one too where it is a worker of the pool, because the
/// proof asks the pool and a worker that waits for it does not work.
fn one(file: &ClFile<'_>, survey: &Survey, ready: &Ready, sink: &mut Sink) -> Option<Proven> {
    let mut lowering = Lowering::new(ready.capabilities.clone(), &survey.changes, &survey.cl.tools);
    // The machine is the same for all parts; a program without blocks tells it.
    let setup = stream::setup(&lowering.chunk(&Cl::default(), false, &mut Sink::default()));
    let mut lowering = Lowering::new(ready.capabilities.clone(), &survey.changes, &survey.cl.tools);
    let mut prover = Prover::new(ready, &setup);
    let written = if rayon::current_thread_index().is_some() {
        write(file, survey, ready, &mut lowering, &mut |part| prover.part(&part), sink)
    } else {
        let (sender, receiver) = sync_channel(AHEAD);
        std::thread::scope(|scope| {
            let proof = scope.spawn(|| prover.listen(receiver));
            // The proof has failed when nobody listens; its messages say why.
            let mut send = |part| sender.send(part).is_ok();
            let written = write(file, survey, ready, &mut lowering, &mut send, sink);
            drop(sender);
            // A panic of the proof is our own fault and goes on.
            proof.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            written
        })
    };
    prover.finish(survey, sink).filter(|_| written)
}

/// Whether all of it could be written, and `prove` took every part.
fn write(
    file: &ClFile<'_>,
    survey: &Survey,
    ready: &Ready,
    lowering: &mut Lowering,
    prove: &mut dyn FnMut(Part) -> bool,
    sink: &mut Sink,
) -> bool {
    let mut reader = file.reader();
    let mut parts = Parts::new(&ready.dialect);
    while let Some(mut cl) = reader.chunk(PART) {
        let last = reader.is_over();
        cl.title.clone_from(&survey.cl.title);
        let mut messages = Sink::default();
        let target = lowering.chunk(&cl, last, &mut messages);
        let failed = messages.has_errors();
        sink.append(messages);
        if failed {
            return false;
        }
        let emitted = match parts.part(&target, &cl.origins) {
            Ok(written) => Emitted { text: written.text, lines: written.lines },
            Err(errors) => {
                errors.into_iter().for_each(|e| sink.push(e));
                return false;
            }
        };
        if !prove(Part { cl, target, emitted, last }) {
            return false;
        }
    }
    true
}

/// The proof of one program, part by part.
struct Prover<'a> {
    /// None once it has failed.
    proof: Option<Proof<'a>>,
    ended: bool,
    sink: Sink,
}

impl<'a> Prover<'a> {
    fn new(ready: &Ready, setup: &'a MachineSetup) -> Prover<'a> {
        let control = ready.dialect.control_with(&ready.capabilities.options);
        let mut sink = Sink::default();
        let proof = Proof::new(control, ready.dialect.name(), setup)
            .map_err(|unknown| stream::unknown_control(&unknown, &mut sink))
            .ok();
        Prover { proof, ended: false, sink }
    }

    fn listen(&mut self, receiver: Receiver<Part>) {
        for part in receiver {
            if !self.part(&part) {
                return;
            }
        }
    }

    /// Whether it is as it should be so far.
    fn part(&mut self, part: &Part) -> bool {
        let Some(proof) = &mut self.proof else { return false };
        if !proof.part(&part.cl, &part.target, &part.emitted, part.last, &mut self.sink) {
            self.proof = None;
        }
        self.ended = part.last;
        self.proof.is_some()
    }

    fn finish(self, survey: &Survey, sink: &mut Sink) -> Option<Proven> {
        sink.append(self.sink);
        let proof = self.proof.filter(|_| self.ended)?;
        proof.finish(operations(survey))
    }
}

fn operations(survey: &Survey) -> Vec<OperationProof> {
    let places = survey.places.iter().map(Some).chain(std::iter::repeat(None));
    let operations = survey.cl.operations.iter().zip(places);
    operations.map(|(operation, place)| OperationProof::unmeasured(operation, place.copied())).collect()
}
