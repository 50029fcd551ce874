//! One HTML page with three linked panes: source lines, CL records, NC lines. No server, no other file.
//!
//! All text is escaped; links are data that the page's script reads as JSON. The page may load nothing.

use core::fmt::Write as _;

use serde::Serialize;

use crate::driver::{Build, Output};
use crate::links::{self, Links, Record};

/// Lines of one CL record that are shown; a curve can have thousands.
const RECORD_LINES: usize = 12;

/// What the script needs of a record.
#[derive(Serialize)]
struct Link<'a> {
    /// Source lines, the statement first, then the calls: file, first, last.
    s: Vec<(usize, usize, usize)>,
    /// NC lines: first, last.
    n: &'a [(u32, u32)],
}

impl Link<'_> {
    fn of(record: &Record) -> Link<'_> {
        let lines = core::iter::once(&record.source).chain(&record.calls);
        Link { s: lines.map(|l| (l.file, l.first, l.last)).collect(), n: &record.nc }
    }
}

/// The page of one output; `None` when it was not proven.
#[must_use]
pub fn page(build: &Build, output: &Output) -> Option<String> {
    let links = links::of(build, output)?;
    let nc = output.proven.as_ref()?.text();
    let title = format!("{} for {}", links.sources.first().map_or("", String::as_str), output.post);
    let filled = include_str!("page.html")
        .split("<!--")
        .map(|part| match part.split_once("-->") {
            Some(("TITLE", rest)) => escape(&title) + rest,
            Some(("SOURCE", rest)) => source_pane(build) + rest,
            Some(("CL", rest)) => record_pane(&links) + rest,
            Some(("NC", rest)) => nc_pane(nc) + rest,
            Some(("LINKS", rest)) => data(&links) + rest,
            _ => part.to_owned(),
        })
        .collect();
    Some(filled)
}

fn source_pane(build: &Build) -> String {
    let mut out = String::new();
    for (id, file) in build.sources.iter() {
        let _ = writeln!(out, "<h2>{}</h2>", escape(&file.name));
        for (index, line) in file.text.lines().enumerate() {
            row(&mut out, &format!("s{}-{}", id.0, index + 1), &(index + 1).to_string(), line);
        }
    }
    out
}

fn record_pane(links: &Links) -> String {
    let mut out = String::new();
    for (index, record) in links.records.iter().enumerate() {
        row(&mut out, &format!("r{index}"), &(index + 1).to_string(), &shortened(&record.text));
    }
    out
}

fn nc_pane(nc: &str) -> String {
    let mut out = String::new();
    for (index, line) in nc.lines().enumerate() {
        row(&mut out, &format!("n{}", index + 1), &(index + 1).to_string(), line);
    }
    out
}

fn row(out: &mut String, id: &str, number: &str, text: &str) {
    // Writing to a String cannot fail.
    let _ = writeln!(out, "<div id=\"{id}\"><b>{number}</b><code>{}</code></div>", escape(text));
}

/// The first lines of a long record.
fn shortened(text: &str) -> String {
    let lines = text.lines().count();
    if lines <= RECORD_LINES {
        return text.to_owned();
    }
    let head: Vec<&str> = text.lines().take(RECORD_LINES).collect();
    format!("{}\n\u{2026} {} more lines", head.join("\n"), lines - RECORD_LINES)
}

/// The links as JSON that cannot end its script element.
fn data(links: &Links) -> String {
    let links: Vec<Link<'_>> = links.records.iter().map(Link::of).collect();
    serde_json::to_string(&links).unwrap_or_default().replace('<', "\\u003c")
}

/// Text as HTML.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // Not allowed in HTML, whatever their spelling.
            c if c.is_control() && c != '\n' && c != '\t' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use crate::driver::{self, Options};
    use crate::source::MemoryFiles;

    fn page(program: &str) -> String {
        let files = MemoryFiles([("a<b>.apt".to_owned(), program.to_owned())].into());
        let options = Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() };
        let build = driver::build("a<b>.apt", &files, &options);
        assert!(!build.has_errors(), "{:#?}", build.diagnostics);
        super::page(&build, &build.outputs[0]).expect("a page")
    }

    const MOVES: &str = "T1 = CUTTER/ FLAT, 16, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 1200, CLW\nFEDRAT/ 300\nRAPID\nGOTO/ 0, 0, 5\nGOTO/ 10, 0, 5\nFINI\n";

    #[test]
    fn every_line_of_all_three_has_its_row_and_its_links() {
        let page = page(MOVES);
        for row in ["<div id=\"s0-7\"><b>7</b><code>GOTO/ 10, 0, 5</code>", "<code>G1 X10 F300</code>"] {
            assert!(page.contains(row), "{row} is not in\n{page}");
        }
        let json =
            page.split("id=\"links\">").nth(1).and_then(|r| r.split("</script>").next()).expect("data");
        let links: serde_json::Value = serde_json::from_str(json).expect("JSON");
        let last = links.as_array().and_then(|a| a.last()).expect("records");
        assert_eq!(last["s"][0], serde_json::json!([0, 7, 7]));
        let line = last["n"][0][0].as_u64().expect("a line");
        assert!(
            page.contains(&format!("<div id=\"n{line}\"><b>{line}</b><code>G1 X10 F300</code>")),
            "{last}"
        );
        assert!(!page.contains("<!--"), "a place was not filled");
    }

    #[test]
    fn no_text_of_the_program_becomes_markup() {
        let page = page(&format!(
            "PARTNO </script><script>alert(1)</script> <!--NC--> & \"x\"\nPPRINT <img src=x onerror=alert(2)>\n{MOVES}"
        ));
        assert_eq!(page.matches("<script").count(), 2, "the page's own two");
        assert!(!page.contains("<img") && !page.contains("<!--NC"), "{page}");
        assert!(page.contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
    }

    #[test]
    fn the_page_is_alone() {
        let page = page(MOVES);
        assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("src="), "{page}");
        assert!(page.contains("default-src 'none'"));
    }
}
