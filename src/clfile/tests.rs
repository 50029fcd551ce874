//! Reading CL files, each producer in its own style.

mod cycles;
mod fast;
mod producers;
mod vocabulary;
mod whole;
mod words;

use super::{Options, Producer, Reader};
use crate::cl::{Cl, RecordKind};
use crate::source::FileId;

/// What came of a text: its CL data and the codes of the messages, without doubts about the whole file ([`whole`] has those).
fn read_as(text: &str, producer: Option<Producer>, lenient: bool) -> (Cl, Vec<&'static str>) {
    let options = Options { producer, lenient, ..Options::default() };
    let (cl, sink) = Reader::new(FileId(0), "part.cl", text, &options).whole();
    let codes =
        sink.into_items().iter().map(|d| d.code.id).filter(|id| !matches!(*id, "W1017" | "W1019")).collect();
    (cl, codes)
}

fn read(text: &str) -> (Cl, Vec<&'static str>) {
    read_as(text, None, false)
}

/// A frame about records of motion: tool, spindle and feed are there.
fn framed(body: &str) -> String {
    format!("LOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/200,MMPM\nRAPID\nGOTO/10,0,5\n{body}\nFINI\n")
}

/// Kinds of the motion records, in order, by letter: R rapid, L line, C circle, S spline, H hole, B and E a cycle.
fn kinds(cl: &Cl) -> String {
    cl.records
        .iter()
        .filter_map(|r| match r.kind {
            RecordKind::Rapid(_) => Some('R'),
            RecordKind::Linear(_) => Some('L'),
            RecordKind::Circle(_) => Some('C'),
            RecordKind::Spline(_) => Some('S'),
            RecordKind::Hole(_) => Some('H'),
            RecordKind::BeginCycle(_) => Some('B'),
            RecordKind::EndCycle => Some('E'),
            _ => None,
        })
        .collect()
}
