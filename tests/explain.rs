//! Every diagnostic code has its page, and the examples on the pages do what the pages say.

mod common;

use std::collections::BTreeMap;

use partwright::diag::{Code, Severity, codes};
use partwright::driver::{self, Build};
use partwright::source::MemoryFiles;

/// A fenced block: its language, the extras behind the comma, its text.
#[derive(Debug, Clone)]
struct Block {
    language: String,
    extras: BTreeMap<String, String>,
    text: String,
}

#[test]
fn every_page_explains_its_code_and_its_examples_compile() {
    let filter = std::env::var("CODES").unwrap_or_default();
    let failures: Vec<String> = codes::all()
        .filter(|c| c.id.starts_with(&filter))
        .filter_map(|c| check(c).err().map(|e| format!("{}: {e}", c.id)))
        .collect();
    assert!(failures.is_empty(), "{} pages are not right:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn codes_are_unique_and_numbered_by_area() {
    let mut ids: Vec<&str> = codes::all().map(|c| c.id).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "two diagnostics share a code");
    for code in codes::all() {
        let (letter, digits) = code.id.split_at(1);
        assert!(matches!(letter, "E" | "W" | "N"), "{}", code.id);
        assert!(digits.len() == 4 && digits.bytes().all(|b| b.is_ascii_digit()), "{}", code.id);
    }
}

fn check(code: &Code) -> Result<(), String> {
    let first = code.page.lines().next().unwrap_or("");
    if first != format!("# {}: {}", code.id, code.title) {
        return Err(format!("the first line is not `# {}: {}`", code.id, code.title));
    }
    let parts = sections(code.page);
    let prose = parts.get("").map_or("", String::as_str);
    if prose.lines().skip(1).all(|l| l.trim().is_empty()) {
        return Err("the page has no prose".to_owned());
    }
    let wrong = parts.get("Wrong").ok_or("there is no section `## Wrong`")?;
    let right = parts.get("Right").ok_or("there is no section `## Right`")?;
    let (wrong, right) = (blocks(wrong), blocks(right));
    if wrong.is_empty() || right.is_empty() {
        return Err("an example is missing".to_owned());
    }
    compile_wrong(code, &wrong)?;
    compile_right(code, &right)
}

fn sections(page: &str) -> BTreeMap<String, String> {
    let mut parts = BTreeMap::new();
    let mut title = String::new();
    for line in page.lines() {
        match line.strip_prefix("## ") {
            Some(next) => title = next.trim().to_owned(),
            None => {
                let part: &mut String = parts.entry(title.clone()).or_default();
                part.push_str(line);
                part.push('\n');
            }
        }
    }
    parts
}

fn blocks(section: &str) -> Vec<Block> {
    let mut found = Vec::new();
    let mut open: Option<Block> = None;
    for line in section.lines() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(_), Some(_)) => found.extend(open.take()),
            (Some(info), None) => open = Some(start(info)),
            (None, Some(block)) => {
                block.text.push_str(line);
                block.text.push('\n');
            }
            (None, None) => {}
        }
    }
    found
}

fn start(info: &str) -> Block {
    let mut words = info.split(',');
    let language = words.next().unwrap_or("").trim().to_owned();
    let extras =
        words.filter_map(|w| w.split_once('=')).map(|(k, v)| (k.trim().to_owned(), v.trim().to_owned()));
    Block { language, extras: extras.collect(), text: String::new() }
}

/// Compiles a section's program; `None` when it has only text.
fn compile(blocks: &[Block]) -> Result<Option<Build>, String> {
    let mut files = MemoryFiles::default();
    for block in blocks {
        if let Some(name) = block.extras.get("file") {
            files.0.insert(name.clone(), block.text.clone());
        }
    }
    let Some(program) = blocks.iter().find(|b| b.language == "apt" && !b.extras.contains_key("file")) else {
        let text = blocks.iter().any(|b| b.language == "text");
        return if text { Ok(None) } else { Err("a block is neither `apt` nor `text`".to_owned()) };
    };
    files.0.insert("page.apt".to_owned(), program.text.clone());
    let mut options = driver::Options { check_only: true, ..driver::Options::default() };
    if let Some(post) = program.extras.get("post") {
        options.posts.push(post.clone());
        options.check_only = false;
    }
    if let Some((name, value)) = program.extras.get("define").and_then(|d| d.split_once('=')) {
        options.defines.push((name.to_owned(), value.to_owned()));
    }
    Ok(Some(driver::build("page.apt", &files, &options)))
}

fn compile_wrong(code: &Code, blocks: &[Block]) -> Result<(), String> {
    let Some(build) = compile(blocks)? else { return Ok(()) };
    let found: Vec<&str> = build.diagnostics.iter().map(|d| d.code.id).collect();
    if found.contains(&code.id) { Ok(()) } else { Err(format!("the wrong example gives {found:?}")) }
}

fn compile_right(code: &Code, blocks: &[Block]) -> Result<(), String> {
    let Some(build) = compile(blocks)? else { return Ok(()) };
    let bad = build.diagnostics.iter().find(|d| d.severity == Severity::Error || d.code.id == code.id);
    match bad {
        Some(d) => Err(format!("the right example gives {}: {}", d.code.id, d.message)),
        None => Ok(()),
    }
}

/// Codes that no program text alone can trigger: what does, and the tests that do.
const NOT_BY_A_PROGRAM: [(&str, &[&str]); 9] = [
    (
        "the command line, or a file that cannot be read or written: tests/cli*.rs",
        &[
            "E0901", "E0902", "E0903", "E0904", "E0905", "E0906", "E0907", "E0908", "E0909", "E0910",
            "E0911", "E0912", "E0913", "E0917", "E0918", "E0951", "E0952", "E0953", "E0954", "E0955",
            "E0956",
        ],
    ),
    ("a faulty post: src/post/tests, tests/cli_post.rs", &["E0751", "E0752", "W0753", "E0754"]),
    (
        "an emitted text that is not what it should be: src/verify/program_tests.rs, src/verify/surface/tests.rs",
        &[
            "E0801", "E0802", "E0803", "E0804", "E0805", "E0806", "E0807", "E0808", "E0809", "E0810",
            "E0811", "E0812", "E0820", "E0821",
        ],
    ),
    (
        "a target program of a kind that sources do not make yet: src/lower/tests",
        &["E0606", "E0608", "N0609", "N0610"],
    ),
    (
        "a CL file, which is no program of the language: src/clfile/tests, tests/cl",
        &[
            "E1001", "E1002", "E1005", "E1006", "E1007", "E1008", "N0611", "N1013", "N1014", "W1011",
            "W1012", "W1015", "E1016", "W1017", "W1018", "W1019", "W1020", "W1021",
        ],
    ),
    ("a producer on the command line, without a test so far", &["E1009"]),
    ("a level with a place that no way leads to, which no program has shown so far", &["W0533"]),
    ("a control character, which these files should not hold: src/syntax/tests.rs", &["E0107"]),
    ("a groove that sema has let through: src/plan/tests.rs", &["E0506"]),
];

#[test]
fn every_code_is_triggered_by_a_program() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/errors");
    let annotated: String =
        common::find(&folder, "apt").iter().map(|p| std::fs::read_to_string(p).unwrap_or_default()).collect();
    let on_page = |page: &str| {
        sections(page).get("Wrong").is_some_and(|wrong| blocks(wrong).iter().any(|b| b.language == "apt"))
    };
    let excused = |id: &str| NOT_BY_A_PROGRAM.iter().any(|(_, ids)| ids.contains(&id));
    let (mut missing, mut needless) = (Vec::new(), Vec::new());
    for code in codes::all() {
        let shown = on_page(code.page) || annotated.contains(&format!(" {}", code.id));
        match (shown, excused(code.id)) {
            (false, false) => missing.push(code.id),
            (true, true) => needless.push(code.id),
            _ => {}
        }
    }
    assert!(missing.is_empty(), "no program triggers {missing:?}");
    assert!(needless.is_empty(), "a program triggers {needless:?}: take them off the list");
}
