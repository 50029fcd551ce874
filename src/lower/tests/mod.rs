//! Lowering of hand-made CL data; everything emitted is written, read back and proven.

mod changes;
mod circles;
mod cl;
mod compensation;
mod plate;

use crate::cl::Cl;
use crate::diag::Sink;
use crate::ir::{Machine, Rotary};
use crate::post;
use crate::source::{MemoryFiles, SourceMap};
use crate::target::TargetProgram;
use crate::units::LengthUnit;
use crate::verify::{self, Certificate, Emitted};

/// What came of a program.
pub struct Made {
    pub target: TargetProgram,
    pub text: String,
    pub certificate: Certificate,
    pub notes: Vec<&'static str>,
}

/// A post, in a file when it is not built in.
pub fn dialect(name: &str, text: Option<&str>) -> post::Dialect {
    let files = MemoryFiles(text.iter().map(|t| (name.to_owned(), (*t).to_owned())).collect());
    post::load(name, &files, &mut SourceMap::default()).unwrap_or_else(|e| panic!("{e:#?}"))
}

/// Lowers; the codes of the messages come too.
pub fn lowered(
    cl: &Cl,
    dialect: &post::Dialect,
    rotary: Option<Rotary>,
) -> (Option<TargetProgram>, Vec<crate::diag::Diagnostic>) {
    let origin = cl.records[0].origin;
    let machine = Machine { post: dialect.name().into(), rotary, options: Vec::new(), origin };
    let capabilities = dialect.capabilities(cl.units, Some(&machine)).unwrap();
    let mut sink = Sink::default();
    let target = super::lower(cl, &capabilities, &mut sink);
    (target, sink.into_items())
}

/// Lowers, writes and proves.
pub fn made_with(cl: &Cl, dialect: &post::Dialect, rotary: Option<Rotary>) -> Made {
    let (target, messages) = lowered(cl, dialect, rotary);
    let target = target.unwrap_or_else(|| panic!("{messages:#?}"));
    let written = post::write(dialect, &target, &cl.origins).unwrap_or_else(|e| panic!("{e:#?}"));
    let mut sink = Sink::default();
    let text = written.text.clone();
    let emitted = Emitted { text: written.text, lines: written.lines };
    let proven = verify::prove(cl, &target, emitted, dialect.control(), &mut sink);
    let proven = proven.unwrap_or_else(|| panic!("{:#?}\n{text}", sink.items()));
    let certificate = proven.certificate().clone();
    Made { target, text, certificate, notes: messages.iter().map(|m| m.code.id).collect() }
}

pub fn made(cl: &Cl, name: &str, letter: Option<char>) -> Made {
    made_with(cl, &dialect(name, None), letter.map(|l| Rotary { letter: Some(l), reversed: false }))
}

/// The unit of inch programs.
pub const INCH: LengthUnit = LengthUnit::Inch;
