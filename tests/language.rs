//! Snapshots of the evaluated program, and of the messages, of every program in `tests/programs/language`.

use std::path::{Path, PathBuf};

use partwright::diag::Sink;
use partwright::ir::print;
use partwright::sema::{self, Options};
use partwright::source::{FileError, FileProvider, SourceMap};

/// The files beside the program.
struct Beside(PathBuf);

impl FileProvider for Beside {
    fn read(&self, _from: Option<&str>, path: &str) -> Result<(String, String), FileError> {
        let text = std::fs::read_to_string(self.0.join(path)).map_err(|_| FileError::NotFound)?;
        Ok((path.to_owned(), text))
    }
}

fn evaluated(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("a readable test program");
    let files = Beside(path.parent().expect("a directory").to_owned());
    let mut sources = SourceMap::default();
    let main = sources.add("program.apt", text.as_str());
    let mut sink = Sink::default();
    let program = sema::analyse(main, &mut sources, &files, &Options::default(), &mut sink);
    let messages: Vec<_> = sink.items().iter().map(|d| format!("{}: {}", d.code.id, d.message)).collect();
    let printed = program.map(|p| print::print(&p, &sources)).unwrap_or_default();
    format!("{printed}--\n{}", messages.join("\n"))
}

#[test]
fn the_evaluated_program_of_every_language_program() {
    insta::glob!("programs/language/[a-z]*.apt", |path| insta::assert_snapshot!(evaluated(path)));
}
