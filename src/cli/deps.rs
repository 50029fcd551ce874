//! The dependency file: what was read, what is made. It is written for failed builds too.

use std::path::Path;

use serde::Serialize;

use super::args::DepsFormat;
use super::build::{Compiled, Planned};
use super::output::{Product, is_stdout};

#[derive(Serialize)]
struct Dependencies {
    version: u32,
    inputs: Vec<String>,
    outputs: Vec<String>,
}

/// The dependency file of a run.
pub fn product(path: &Path, format: DepsFormat, compiled: &[Compiled], planned: &[Planned]) -> Product {
    let mut inputs: Vec<String> = compiled.iter().flat_map(|c| c.build.inputs.iter().cloned()).collect();
    inputs.sort();
    inputs.dedup();
    let outputs: Vec<String> = planned
        .iter()
        .filter(|p| !is_stdout(&p.path))
        .map(|p| p.path.to_string_lossy().into_owned())
        .collect();
    let text = match format {
        DepsFormat::Make => make(&inputs, &outputs),
        DepsFormat::Json => json(Dependencies { version: 1, inputs, outputs }),
    };
    Product { path: path.to_path_buf(), bytes: text.into_bytes() }
}

fn json(dependencies: Dependencies) -> String {
    let mut text = serde_json::to_string_pretty(&dependencies).unwrap_or_default();
    text.push('\n');
    text
}

fn make(inputs: &[String], outputs: &[String]) -> String {
    let list = |names: &[String]| names.iter().map(|n| escape(n)).collect::<Vec<_>>().join(" ");
    format!("{}: {}\n", list(outputs), list(inputs))
}

/// As make reads names: blanks and `#` with a backslash, `$` doubled.
fn escape(name: &str) -> String {
    name.replace('$', "$$").replace(' ', "\\ ").replace('#', "\\#")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_escaped_for_make() {
        let made = make(&["a b.apt".to_owned(), "c$.apt".to_owned()], &["x#.nc".to_owned()]);
        assert_eq!(made, "x\\#.nc: a\\ b.apt c$$.apt\n");
    }
}
