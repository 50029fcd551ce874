//! Differences of texts, for people.

use similar::TextDiff;

/// Lines of a difference that are shown.
const MOST_LINES: usize = 40;
/// Lines about a change that are shown with it.
const CONTEXT: usize = 2;
/// Lines that are compared at most; of longer programs only the first line that differs is shown.
const MOST_COMPARED: usize = 20_000;

/// How `new` differs from `old`, in the form of a unified diff without its head.
#[must_use]
pub fn difference(old: &str, new: &str) -> String {
    if unix(old) == unix(new) {
        return format!(
            "only the line ends differ: {} in the golden file, {} in the new program; \
             `*.golden.* -text` in .gitattributes keeps git from changing them\n",
            line_ends(old),
            line_ends(new)
        );
    }
    if old.lines().count().max(new.lines().count()) > MOST_COMPARED {
        return first_line(old, new);
    }
    let diff = TextDiff::from_lines(old, new);
    let text = diff.unified_diff().context_radius(CONTEXT).missing_newline_hint(false).to_string();
    let lines: Vec<&str> = text.lines().collect();
    let mut out: String = lines.iter().take(MOST_LINES).map(|line| format!("{}\n", visible(line))).collect();
    if lines.len() > MOST_LINES {
        out.push_str(&format!("… {} more lines of differences\n", lines.len() - MOST_LINES));
    }
    out
}

fn unix(text: &str) -> String {
    text.replace("\r\n", "\n")
}

fn line_ends(text: &str) -> &'static str {
    match (text.contains("\r\n"), text.replace("\r\n", "").contains('\n')) {
        (true, true) => "CR LF and LF",
        (true, false) => "CR LF",
        (false, _) => "LF",
    }
}

fn first_line(old: &str, new: &str) -> String {
    let mut pairs = old.lines().map(Some).chain([None]).zip(new.lines().map(Some).chain([None])).enumerate();
    let Some((index, (a, b))) = pairs.find(|(_, (a, b))| a != b) else {
        return "only the end of the last line differs\n".to_owned();
    };
    let (a, b) = (visible(a.unwrap_or("")), visible(b.unwrap_or("")));
    format!("@@ line {} @@\n-{a}\n+{b}\n", index + 1)
}

/// Control characters are shown, not obeyed.
fn visible(line: &str) -> String {
    line.chars()
        .flat_map(|c| if c.is_control() && c != '\t' { c.escape_default().collect() } else { vec![c] })
        .collect()
}
