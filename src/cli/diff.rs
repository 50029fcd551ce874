//! `partwright diff`.

use std::collections::BTreeSet;
use std::path::Path;

use super::args::golden::DiffArgs;
use super::args::post::TextOrJson;
use super::disk::{Disk, LARGEST, reason};
use super::messages::Messages;
use super::{Status, build, print};
use crate::diag::Diagnostic;
use crate::diag::codes::{command, tools as codes};
use crate::golden::names;
use crate::motion_diff::{self, Comparison, Complaint, Tolerance, print as motion_print};
use crate::post;
use crate::readback::{MachineSetup, Rotary};
use crate::source::SourceMap;

/// Complaints of a control that are shown of each program.
const MOST_COMPLAINTS: usize = 10;

/// Compares two programs and prints how they differ.
pub fn diff(args: &DiffArgs, messages: Messages) -> Result<Status, Diagnostic> {
    let control = match control(args, messages)? {
        Ok(control) => control,
        Err(status) => return Ok(status),
    };
    let (a, b) = (read(&args.a)?, read(&args.b)?);
    let tolerance = Tolerance { distance: args.tolerance, rate: args.rate_tolerance / 100.0 };
    let rotary = args.rotary.map(|letter| Rotary { letter: letter.to_ascii_uppercase(), reversed: false });
    let setup = MachineSetup { rotary, tool_names: tool_names([&a, &b]), ..MachineSetup::default() };
    let compared = motion_diff::compare([&a, &b], &control, &setup, tolerance);
    let comparison =
        compared.map_err(|unknown| Diagnostic::global(&codes::NOT_EXECUTABLE, unknown.to_string()))?;
    complain(&comparison, args, messages);
    print(&match args.format {
        TextOrJson::Json => serde_json::to_string_pretty(&comparison).unwrap_or_default() + "\n",
        TextOrJson::Text => text(&comparison, [&a, &b], args),
    })?;
    Ok(match (comparison.is_executable(), comparison.is_same()) {
        (false, _) => Status::NotProven,
        (true, false) => Status::Differs,
        (true, true) => Status::Done,
    })
}

/// The control of the post that was named, or that the first file's name says.
fn control(args: &DiffArgs, messages: Messages) -> Result<Result<String, Status>, Diagnostic> {
    let of_file = |path: &Path| {
        let name = path.file_name()?.to_string_lossy().into_owned();
        names::post(&name).filter(|p| post::builtin_text(p).is_some()).map(str::to_owned)
    };
    let named = args.post.clone().or_else(|| of_file(&args.a)).or_else(|| of_file(&args.b));
    let Some(name) = named else {
        let message = format!("no post is named, and {} does not say it in its name", args.a.display());
        return Err(Diagnostic::global(&command::NO_POST, message).help("name the post with --post"));
    };
    let mut sources = SourceMap::default();
    match post::load(&name, &Disk::for_main(Path::new(&name)), &mut sources) {
        Ok(dialect) => Ok(Ok(dialect.control_with(&dialect.spec().options).to_owned())),
        Err(errors) => {
            messages.show(&errors, &sources);
            Ok(Err(build::status_of(&errors)))
        }
    }
}

fn read(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    let trouble = |why: String| {
        Diagnostic::global(&command::CANNOT_READ, format!("{} cannot be read: {why}", path.display()))
    };
    let size = std::fs::metadata(path).map_err(|e| trouble(reason(&e)))?.len();
    if size > LARGEST {
        let message = format!("{} has more than {LARGEST} bytes", path.display());
        return Err(Diagnostic::global(&command::TOO_LARGE, message));
    }
    std::fs::read(path).map_err(|e| trouble(reason(&e)))
}

fn complain(comparison: &Comparison, args: &DiffArgs, messages: Messages) {
    for (path, faults) in [&args.a, &args.b].into_iter().zip(&comparison.faults) {
        for fault in faults.iter().take(MOST_COMPLAINTS) {
            let message = format!("{}, line {}: {}", path.display(), fault.line, fault.message);
            messages.global(&Diagnostic::global(&codes::NOT_EXECUTABLE, message));
        }
    }
}

/// Characters that are shown of a block.
const SHOWN: usize = 60;

/// Numbers of tools that are called by name stand above those that have one.
const NAMED: u32 = 100_000_001;

/// A tool table with every name in quotes.
fn tool_names(programs: [&[u8]; 2]) -> Vec<(String, u32)> {
    let quoted = |text: &[u8]| -> Vec<String> {
        let lines = text.split(|b| *b == b'\n').filter(|line| line.contains(&b'"'));
        let names = lines.filter_map(|line| line.split(|b| *b == b'"').nth(1));
        let names = names.map(|name| String::from_utf8_lossy(name).into_owned());
        // Some controls take capitals for small letters, others do not.
        names.flat_map(|name| [name.to_uppercase(), name]).collect()
    };
    let names: BTreeSet<String> = programs.into_iter().flat_map(quoted).collect();
    names.into_iter().zip(NAMED..).collect()
}

/// The lines that the control complains of.
fn lines(faults: &[Complaint]) -> BTreeSet<u32> {
    faults.iter().map(|fault| fault.line).collect()
}

/// The blocks that the control complains of, as they are written, with their lines.
fn not_followed(program: &[u8], faults: &[Complaint]) -> Vec<(u32, String)> {
    let lines = lines(faults);
    let texts = (1u32..).zip(program.split(|b| *b == b'\n')).filter(|(line, _)| lines.contains(line));
    texts.map(|(line, text)| (line, String::from_utf8_lossy(text).trim().to_owned())).collect()
}

/// Blocks that cannot be followed differ where their texts do: the first that does.
fn written_otherwise(comparison: &Comparison, programs: [&[u8]; 2], names: [&str; 2]) -> Option<String> {
    let [of_a, of_b] = &comparison.faults;
    let (a, b) = (not_followed(programs[0], of_a), not_followed(programs[1], of_b));
    let longest = a.len().max(b.len());
    let (a, b) =
        (0..longest).map(|i| (a.get(i), b.get(i))).find(|(a, b)| a.map(|a| &a.1) != b.map(|b| &b.1))?;
    let shown = |block: Option<&(u32, String)>, name: &str| match block {
        Some((line, text)) => {
            let text: String = text.chars().filter(|c| !c.is_control()).take(SHOWN).collect();
            format!("line {line} of {name} is `{text}`")
        }
        None => format!("{name} has none"),
    };
    Some(format!("of what cannot be followed, {}, and {}\n", shown(a, names[0]), shown(b, names[1])))
}

fn text(comparison: &Comparison, programs: [&[u8]; 2], args: &DiffArgs) -> String {
    let (a, b) = (args.a.to_string_lossy(), args.b.to_string_lossy());
    if !comparison.is_executable() {
        // One block can have several complaints.
        let [of_a, of_b] = comparison.faults.each_ref().map(|faults| lines(faults).len());
        let blocks = if of_a == 1 { "block" } else { "blocks" };
        let rest = motion_print::text(comparison, motion_print::Names { a: &a, b: &b });
        let rest = if rest.is_empty() { "what can be followed is the same\n".to_owned() } else { rest };
        let otherwise = written_otherwise(comparison, programs, [&a, &b]);
        let otherwise =
            otherwise.unwrap_or_else(|| "what cannot be followed is written the same\n".to_owned());
        return format!(
            "not compared as a whole: the control complains of {of_a} {blocks} of {a} and {of_b} of {b}\n{rest}{otherwise}"
        );
    }
    if comparison.is_same() {
        let [of_a, of_b] = comparison.moves;
        return format!(
            "same motion: {:.1} mm of path, {of_a} and {of_b} moves, within {} mm\n",
            comparison.lengths[0], args.tolerance
        );
    }
    motion_print::text(comparison, motion_print::Names { a: &a, b: &b })
}
