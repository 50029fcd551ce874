//! Snapshots of the syntax tree of every program in `tests/programs/syntax`.

use partwright::diag::Sink;
use partwright::source::SourceMap;
use partwright::syntax;

#[test]
fn the_tree_of_every_syntax_program() {
    insta::glob!("programs/syntax/*.apt", |path| {
        let text = std::fs::read_to_string(path).expect("a readable test program");
        let mut sources = SourceMap::default();
        let file = sources.add("program.apt", text.as_str());
        let mut sink = Sink::default();
        let program = syntax::parse(file, &text, &mut sink);
        let messages: Vec<_> = sink.items().iter().map(|d| format!("{}: {}", d.code.id, d.message)).collect();
        let printed = syntax::print::print(&program, &sources);
        insta::assert_snapshot!(format!("{printed}--\n{}", messages.join("\n")));
    });
}
