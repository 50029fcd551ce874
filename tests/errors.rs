//! Faulty programs whose mistakes are annotated in comments; the format is in `tests/README.md`.

mod common;

use std::path::Path;

use partwright::diag::Diagnostic;
use partwright::driver;
use partwright::source::SourceMap;

/// An annotation, or a diagnostic reduced to what annotations say.
#[derive(Debug, Clone, PartialEq)]
struct Expected {
    file: String,
    /// Line and column from 1; `None` for a message without a place.
    place: Option<(usize, usize)>,
    code: String,
    text: String,
}

#[test]
fn every_faulty_program_gives_exactly_the_annotated_messages() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/errors");
    let filter = std::env::var("ERRORS").unwrap_or_default();
    let programs = common::find(&root, "apt");
    assert!(programs.len() >= 3, "the faulty programs are missing");
    let failures: Vec<String> = programs
        .iter()
        .filter(|p| p.to_string_lossy().contains(&filter))
        .filter_map(|p| check(p).err())
        .collect();
    assert!(failures.is_empty(), "{} programs differ:\n{}", failures.len(), failures.join("\n"));
}

fn check(path: &Path) -> Result<(), String> {
    let text = std::fs::read_to_string(path).map_err(|e| e.to_string())?;
    let folder = path.parent().ok_or("no folder")?.to_path_buf();
    let name = path.file_name().ok_or("no name")?.to_string_lossy().into_owned();
    let build = driver::build(&name, &common::Directory(folder), &options(&text));
    let mut wanted: Vec<Expected> =
        build.sources.iter().flat_map(|(_, f)| annotations(&f.name, &f.text)).collect();
    let mut surplus = Vec::new();
    for diagnostic in &build.diagnostics {
        let found = reduce(diagnostic, &build.sources);
        match wanted.iter().position(|w| matches(w, &found)) {
            Some(i) => drop(wanted.remove(i)),
            None => surplus.push(found),
        }
    }
    if wanted.is_empty() && surplus.is_empty() {
        return Ok(());
    }
    let list = |items: &[Expected]| items.iter().map(|e| format!("    {}\n", show(e))).collect::<String>();
    Err(format!(
        "{}\n  annotated but not reported:\n{}  reported but not annotated:\n{}",
        path.display(),
        list(&wanted),
        list(&surplus)
    ))
}

fn show(e: &Expected) -> String {
    let place = e.place.map_or("no place".to_owned(), |(l, c)| format!("{l}:{c}"));
    format!("{}:{place} {} {}", e.file, e.code, e.text.replace('\n', " | "))
}

fn matches(wanted: &Expected, found: &Expected) -> bool {
    wanted.file == found.file
        && wanted.place == found.place
        && wanted.code == found.code
        && found.text.contains(&wanted.text)
}

/// The options in `$$: key=value` lines.
fn options(text: &str) -> driver::Options {
    let mut options = driver::Options { check_only: true, ..driver::Options::default() };
    for line in text.lines().filter_map(|l| l.strip_prefix("$$: ")) {
        match line.split_once('=') {
            Some(("post", name)) => {
                options.check_only = false;
                options.posts.push(name.trim().to_owned());
            }
            Some(("define", define)) => {
                let (name, value) = define.split_once('=').expect("define=NAME=VALUE");
                options.defines.push((name.trim().to_owned(), value.trim().to_owned()));
            }
            _ => panic!("unknown option line `{line}`"),
        }
    }
    options
}

fn annotations(file: &str, text: &str) -> Vec<Expected> {
    let mut found = Vec::new();
    let mut last_line = 0;
    for (index, line) in text.lines().enumerate() {
        match annotation(line) {
            Some((column, rest)) => {
                let (code, text) = rest.split_once(' ').unwrap_or((rest, ""));
                found.push(Expected {
                    file: if column.is_some() { file.to_owned() } else { String::new() },
                    place: column.map(|c| (last_line, c)),
                    code: code.to_owned(),
                    text: text.trim().to_owned(),
                });
            }
            None => last_line = index + 1,
        }
    }
    found
}

/// The column that an annotation line points at (`None` for «no place»), and what it says.
fn annotation(line: &str) -> Option<(Option<usize>, &str)> {
    let rest = line.strip_prefix("$$")?;
    if let Some(rest) = rest.strip_prefix('@') {
        let (column, rest) = rest.split_once(' ')?;
        let column = if column == "global" { None } else { Some(column.parse().ok()?) };
        return Some((column, rest.trim_start()));
    }
    let before = rest.find('^')?;
    if !rest[..before].trim().is_empty() {
        return None;
    }
    Some((Some(before + 3), rest.trim_start().trim_start_matches('^').trim_start()))
}

fn reduce(diagnostic: &Diagnostic, sources: &SourceMap) -> Expected {
    let labels = diagnostic.primary.iter().chain(&diagnostic.labels).map(|l| &l.message);
    let parts =
        core::iter::once(&diagnostic.message).chain(labels).chain(&diagnostic.notes).chain(&diagnostic.help);
    let place = diagnostic.primary.as_ref().map(|l| (sources.file(l.span.file), l.span.start));
    Expected {
        file: place.map_or(String::new(), |(file, _)| file.name.clone()),
        place: place.map(|(file, start)| file.line_column(start)),
        code: diagnostic.code.id.to_owned(),
        text: parts.cloned().collect::<Vec<_>>().join("\n"),
    }
}
