//! What belongs together: source lines, CL records and NC lines of one program (`--source-map`).

use serde::Serialize;

use crate::cl::{self, Cl, RecordKind};
use crate::driver::{Build, Output};
use crate::source::{SourceMap, Span};
use crate::target::TargetProgram;

/// Version of the source map's form; minor steps only add members.
pub const VERSION: &str = "1.0";

/// The links of one NC program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Links {
    /// Files that statements stand in, the main file first.
    pub sources: Vec<String>,
    /// The CL records in order.
    pub records: Vec<Record>,
}

/// A CL record with where it comes from and what became of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Record {
    /// APT CL text, without the last line end.
    pub text: String,
    /// The operation it belongs to.
    pub operation: Option<String>,
    /// The statement.
    pub source: Lines,
    /// `CALL` statements that led to it, the outermost first.
    pub calls: Vec<Lines>,
    /// NC lines that express it, from 1, both ends included, in order.
    pub nc: Vec<(u32, u32)>,
}

/// Lines of a source file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Lines {
    /// Index into [`Links::sources`].
    pub file: usize,
    /// First line, from 1.
    pub first: usize,
    /// Last line.
    pub last: usize,
}

/// The links of one output; `None` when the program was not made.
#[must_use]
pub fn of(build: &Build, output: &Output) -> Option<Links> {
    let (cl, target) = (build.cl.as_ref()?, output.target.as_ref()?);
    Some(Links {
        sources: build.sources.iter().map(|(_, file)| file.name.clone()).collect(),
        records: records(cl, target, &output.lines, &build.sources),
    })
}

fn records(cl: &Cl, target: &TargetProgram, lines: &[(u32, u32)], sources: &SourceMap) -> Vec<Record> {
    let mut nc = nc_lines(cl.records.len(), target, lines);
    let mut operation = None;
    let texts = cl::print::records(cl);
    let one = |((index, record), text): ((usize, &cl::Record), String)| {
        if let RecordKind::BeginOperation(number) = record.kind {
            operation = cl.operations.get(number as usize).map(|o| o.name.clone());
        }
        let origin = &cl.origins[record.origin];
        let made = Record {
            text: text.trim_end().to_owned(),
            operation: operation.clone(),
            source: lines_of(origin.span, sources),
            calls: origin.calls.iter().map(|span| lines_of(*span, sources)).collect(),
            nc: nc.get_mut(index).map(core::mem::take).unwrap_or_default(),
        };
        if matches!(record.kind, RecordKind::EndOperation(_)) {
            operation = None;
        }
        made
    };
    cl.records.iter().enumerate().zip(texts).map(one).collect()
}

/// The NC lines of every record; neighbouring blocks are joined.
fn nc_lines(records: usize, target: &TargetProgram, lines: &[(u32, u32)]) -> Vec<Vec<(u32, u32)>> {
    let mut found: Vec<Vec<(u32, u32)>> = vec![Vec::new(); records];
    for (block, &(first, end)) in target.blocks.iter().zip(lines) {
        let Some(ranges) = block.record.and_then(|r| found.get_mut(r as usize)) else { continue };
        match ranges.last_mut() {
            _ if end <= first => {}
            Some(last) if last.1 + 1 == first => last.1 = end - 1,
            _ => ranges.push((first, end - 1)),
        }
    }
    found
}

fn lines_of(span: Span, sources: &SourceMap) -> Lines {
    let file = sources.file(span.file);
    let first = file.line_column(span.start).0;
    let last = file.line_column(span.end.saturating_sub(1).max(span.start)).0;
    Lines { file: span.file.0 as usize, first, last }
}

#[cfg(test)]
mod tests {
    use crate::driver::{self, Options};
    use crate::source::MemoryFiles;

    const PROGRAM: &str = "\
UP = MACRO/ H
RAPID
GOTO/ 0, 0, H
TERMAC
T1 = CUTTER/ FLAT, 16, NUMBER, 1
LOADTL/ T1
SPINDL/ 1200, CLW
FEDRAT/ 300
CALL/ UP, H = 5
GOTO/ 10, 0, 5
GOTO/ 10, $
  20, 5
FINI
";

    fn links() -> (super::Links, String) {
        let files = MemoryFiles([("a.apt".to_owned(), PROGRAM.to_owned())].into());
        let options = Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() };
        let build = driver::build("a.apt", &files, &options);
        assert!(!build.has_errors(), "{:#?}", build.diagnostics);
        let output = build.outputs.first().expect("an output");
        let text = output.proven.as_ref().expect("a proven program").text().to_owned();
        (super::of(&build, output).expect("links"), text)
    }

    /// The NC lines of the record with this CL text.
    fn nc(links: &super::Links, text: &str, cl: &str) -> (super::Record, Vec<String>) {
        let record =
            links.records.iter().find(|r| r.text == cl).unwrap_or_else(|| panic!("no {cl} in {links:#?}"));
        let lines: Vec<&str> = text.lines().collect();
        let range = |&(first, last): &(u32, u32)| lines[first as usize - 1..last as usize].join("|");
        (record.clone(), record.nc.iter().map(range).collect())
    }

    #[test]
    fn every_record_knows_its_statement_and_its_blocks() {
        let (links, text) = links();
        let (record, blocks) = nc(&links, &text, "GOTO/ 10, 0, 5");
        assert_eq!((record.source.first, record.source.last), (10, 10));
        assert_eq!(blocks, ["G1 X10 F300"]);
        let (record, blocks) = nc(&links, &text, "GOTO/ 10, 20, 5");
        assert_eq!((record.source.first, record.source.last), (11, 12));
        assert_eq!(blocks, ["Y20"]);
        let (_, blocks) = nc(&links, &text, "SPINDL/ 1200, CLW");
        assert_eq!(blocks, ["S1200 M3"]);
    }

    #[test]
    fn calls_lead_from_the_statement_in_a_macro_to_the_call() {
        let (links, text) = links();
        let (record, blocks) = nc(&links, &text, "RAPID\nGOTO/ 0, 0, 5");
        assert_eq!(record.source.first, 3);
        assert_eq!(record.calls.iter().map(|c| c.first).collect::<Vec<_>>(), [9]);
        assert!(blocks.concat().contains("X0 Y0"), "{blocks:?}\n{text}");
    }

    #[test]
    fn no_line_belongs_to_two_records() {
        let (links, _) = links();
        let mut lines: Vec<u32> =
            links.records.iter().flat_map(|r| &r.nc).flat_map(|&(a, b)| a..=b).collect();
        let all = lines.len();
        lines.sort_unstable();
        lines.dedup();
        assert_eq!(lines.len(), all);
    }
}
