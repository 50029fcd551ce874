//! Names of golden files and tests.

/// What marks a golden file, before its extension.
const MARK: &str = "golden";
/// What a test file's name ends with.
pub const SIDECAR: &str = ".test.toml";

/// The golden file of a program: `plate.apt` → `plate.fanuc.golden.nc`, with a variant `plate.long.fanuc.golden.nc`.
#[must_use]
pub fn golden(program: &str, variant: &str, post: &str, extension: &str) -> String {
    let stem = stem(program);
    let variant = if variant.is_empty() { String::new() } else { format!(".{variant}") };
    format!("{stem}{variant}.{post}.{MARK}.{extension}")
}

/// The test file of a program: `plate.apt` → `plate.test.toml`.
#[must_use]
pub fn sidecar(program: &str) -> String {
    format!("{}{SIDECAR}", stem(program))
}

/// Whether a file's name is that of a golden file.
#[must_use]
pub fn is_golden(name: &str) -> bool {
    let mut parts = name.rsplit('.');
    // Extension, mark, post, and a stem.
    parts.next().is_some() && parts.next() == Some(MARK) && parts.count() >= 2
}

/// Whether a golden file could belong to a program: it begins with its stem.
#[must_use]
pub fn may_belong(golden: &str, program: &str) -> bool {
    golden.strip_prefix(stem(program)).is_some_and(|rest| rest.starts_with('.'))
}

/// The post in the name of an NC file: `plate.fanuc.nc`, `plate.fanuc.golden.nc`.
#[must_use]
pub fn post(file: &str) -> Option<&str> {
    let (_, name) = file.rsplit_once(['/', '\\']).unwrap_or(("", file));
    let mut parts = name.rsplit('.').skip(1);
    let found = match parts.next() {
        Some(MARK) => parts.next(),
        other => other,
    };
    // What is left is the stem.
    parts.next().and(found)
}

/// A post as the test file of a program names it, seen from where the program's own path is: built-in names stay,
/// `../posts/mill.post.toml` beside `parts/plate.apt` is `posts/mill.post.toml`.
#[must_use]
pub fn beside(program: &str, post: &str) -> String {
    if !post.ends_with(".toml") || std::path::Path::new(post).is_absolute() {
        return post.to_owned();
    }
    let folder = program.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(post.split('/')) {
        match part {
            "." => {}
            "" if !parts.is_empty() || !program.starts_with('/') => {}
            ".." if parts.last().is_some_and(|p| !p.is_empty() && *p != "..") => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// `parts/plate.apt [long] fanuc`
#[must_use]
pub fn test(program: &str, variant: &str, post: &str) -> String {
    let variant = if variant.is_empty() { String::new() } else { format!(" [{variant}]") };
    format!("{program}{variant} {post}")
}

/// The path without the extension of its last part.
fn stem(program: &str) -> &str {
    let name = program.rfind(['/', '\\']).map_or(0, |slash| slash + 1);
    match program.rfind('.') {
        Some(point) if point > name => program.get(..point).unwrap_or(program),
        _ => program,
    }
}
