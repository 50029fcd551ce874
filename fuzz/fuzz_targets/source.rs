//! Any text through the whole pipeline: no panic, no hang, bounded memory, every message renders, and what
//! has errors has no output.
//!
//! How to run it stands in `fuzz/README.md`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use partwright::diag::render::{Format, render};
use partwright::driver::{Options, build};
use partwright::source::MemoryFiles;

fuzz_target!(|data: &[u8]| {
    let Ok(text) = core::str::from_utf8(data) else { return };
    let mut files = MemoryFiles::default();
    files.0.insert("fuzz.apt".to_owned(), text.to_owned());
    files.0.insert("table.csv".to_owned(), "angle deg,lift mm\n0,0\n180,10\n360,0\n".to_owned());
    let options = Options { posts: vec!["linuxcnc".to_owned(), "grbl".to_owned()], keep_ast: true, ..Options::default() };
    let result = build("fuzz.apt", &files, &options);
    for diagnostic in &result.diagnostics {
        for format in [Format::Human, Format::Short, Format::Json] {
            assert!(render(diagnostic, &result.sources, format, false).ends_with('\n'));
        }
    }
    if result.has_errors() {
        assert!(result.outputs.iter().all(|o| o.proven.is_none()) || result.outputs.len() > 1);
    }
});
