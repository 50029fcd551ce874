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
    if out.is_empty() { "only line ends differ\n".to_owned() } else { out }
}

fn first_line(old: &str, new: &str) -> String {
    let mut pairs = old.lines().map(Some).chain([None]).zip(new.lines().map(Some).chain([None])).enumerate();
    match pairs.find(|(_, (a, b))| a != b) {
        Some((index, (a, b))) => format!(
            "@@ line {} @@\n-{}\n+{}\n",
            index + 1,
            visible(a.unwrap_or("")),
            visible(b.unwrap_or(""))
        ),
        None => "only line ends differ\n".to_owned(),
    }
}

/// Control characters are shown, not obeyed.
fn visible(line: &str) -> String {
    line.chars()
        .flat_map(|c| if c.is_control() && c != '\t' { c.escape_default().collect() } else { vec![c] })
        .collect()
}
