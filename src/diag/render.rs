//! The one place that renders diagnostics: for people, short, and as JSON.

use codespan_reporting::diagnostic as codespan;
use codespan_reporting::term::{self, StylesWriter, termcolor};
use serde::Serialize;

use super::excerpt::{Excerpts, controls, snapped};
use super::{Diagnostic, Label, Severity};
use crate::source::{SourceFile, SourceMap, Span};

/// How messages are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Format {
    /// With the source lines, labels, notes and help.
    #[default]
    Human,
    /// `file:line:column: error[E0101]: message`.
    Short,
    /// One JSON object a line, see `docs/diagnostics-json.md`.
    Json,
}

/// Renders one diagnostic, line end included. `color` matters to [`Format::Human`] only.
#[must_use]
pub fn render(diagnostic: &Diagnostic, sources: &SourceMap, format: Format, color: bool) -> String {
    match format {
        Format::Human => human(diagnostic, sources, color).unwrap_or_else(|| short(diagnostic, sources)),
        Format::Short => short(diagnostic, sources),
        Format::Json => json(diagnostic, sources),
    }
}

/// `error`, `warning`, `note`.
#[must_use]
pub const fn severity_word(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    }
}

fn human(diagnostic: &Diagnostic, sources: &SourceMap, color: bool) -> Option<String> {
    let excerpts = Excerpts::of(diagnostic, sources);
    let primary = diagnostic.primary.iter().map(|l| (codespan::LabelStyle::Primary, l));
    let secondary = diagnostic.labels.iter().map(|l| (codespan::LabelStyle::Secondary, l));
    let labels = primary.chain(secondary).filter_map(|(style, label)| {
        let range = excerpts.range(label.span)?;
        Some(codespan::Label::new(style, label.span.file.0, range).with_message(printable(&label.message)))
    });
    let notes = diagnostic.notes.iter().map(|n| hanging("note: ", &printable(n)));
    let help = diagnostic.help.iter().map(|h| hanging("help: ", &printable(h)));
    let message = codespan::Diagnostic::new(codespan_severity(diagnostic.severity))
        .with_code(diagnostic.code.id)
        .with_message(printable(&diagnostic.message))
        .with_labels(labels.collect())
        .with_notes(notes.chain(help).collect());
    let config = term::Config::default();
    if !color {
        return term::emit_into_string(&config, &excerpts, &message).ok();
    }
    let styles = term::Styles::default();
    let mut ansi = termcolor::Ansi::new(Vec::new());
    let mut writer = StylesWriter::new(&mut ansi, &styles);
    term::emit_to_write_style(&mut writer, &config, &excerpts, &message).ok()?;
    String::from_utf8(ansi.into_inner()).ok()
}

/// A text as a terminal may have it: what a file holds must not control it.
fn printable(text: &str) -> String {
    let shown = |c: char| if controls(c) && c != '\n' { char::REPLACEMENT_CHARACTER } else { c };
    text.chars().map(shown).collect()
}

/// A text of several lines, the later ones indented below the first.
fn hanging(head: &str, text: &str) -> String {
    format!("{head}{}", text.replace('\n', &format!("\n{}", " ".repeat(head.len()))))
}

fn codespan_severity(severity: Severity) -> codespan::Severity {
    match severity {
        Severity::Error => codespan::Severity::Error,
        Severity::Warning => codespan::Severity::Warning,
        Severity::Note => codespan::Severity::Note,
    }
}

fn short(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    let place = diagnostic.primary.as_ref().map_or_else(String::new, |label| {
        let file = sources.file(label.span.file);
        let (line, column) = file.line_column(label.span.start);
        format!("{}:{line}:{column}: ", file.name)
    });
    let word = severity_word(diagnostic.severity);
    let message = printable(&diagnostic.message.replace('\n', " "));
    format!("{place}{word}[{}]: {message}\n", diagnostic.code.id)
}

/// An LSP Diagnostic, plus `file`, `help` and `notes`.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct JsonDiagnostic<'a> {
    file: Option<&'a str>,
    range: JsonRange,
    severity: u8,
    code: &'a str,
    source: &'static str,
    message: &'a str,
    related_information: Vec<JsonRelated<'a>>,
    notes: &'a [String],
    help: &'a [String],
}

#[derive(Serialize)]
struct JsonRelated<'a> {
    location: JsonLocation<'a>,
    message: &'a str,
}

#[derive(Serialize)]
struct JsonLocation<'a> {
    uri: &'a str,
    range: JsonRange,
}

#[derive(Serialize, Default)]
struct JsonRange {
    start: JsonPosition,
    end: JsonPosition,
}

#[derive(Serialize, Default)]
struct JsonPosition {
    line: usize,
    character: usize,
}

fn json(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    let primary = diagnostic.primary.as_ref();
    let at_primary = primary.filter(|l| !l.message.is_empty());
    let related = at_primary.into_iter().chain(&diagnostic.labels).map(|l| related(l, sources));
    let object = JsonDiagnostic {
        file: primary.map(|l| sources.file(l.span.file).name.as_str()),
        range: primary.map(|l| range(l.span, sources)).unwrap_or_default(),
        severity: match diagnostic.severity {
            Severity::Error => 1,
            Severity::Warning => 2,
            Severity::Note => 3,
        },
        code: diagnostic.code.id,
        source: "partwright",
        message: &diagnostic.message,
        related_information: related.collect(),
        notes: &diagnostic.notes,
        help: &diagnostic.help,
    };
    let mut line = serde_json::to_string(&object).unwrap_or_default();
    line.push('\n');
    line
}

fn related<'a>(label: &'a Label, sources: &'a SourceMap) -> JsonRelated<'a> {
    let uri = sources.file(label.span.file).name.as_str();
    JsonRelated { location: JsonLocation { uri, range: range(label.span, sources) }, message: &label.message }
}

fn range(span: Span, sources: &SourceMap) -> JsonRange {
    let file = sources.file(span.file);
    let bytes = snapped(&file.text, span);
    JsonRange { start: position(file, bytes.start), end: position(file, bytes.end) }
}

/// Line and character from zero, the character in UTF-16 units as LSP wants it.
fn position(file: &SourceFile, byte: usize) -> JsonPosition {
    let (line, _) = file.line_column(u32::try_from(byte).unwrap_or(u32::MAX));
    let start = file.line_start(line).map_or(0, |s| s as usize);
    let character = file.text.get(start..byte).map_or(0, |t| t.encode_utf16().count());
    JsonPosition { line: line - 1, character }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::codes::syntax as codes;

    fn sample(text: &str, start: usize, end: usize) -> (SourceMap, Diagnostic) {
        let mut sources = SourceMap::default();
        let file = sources.add("a.apt", text);
        let diagnostic = Diagnostic::new(&codes::UNEXPECTED, Span::new(file, start, end), "expected a comma")
            .at("here")
            .label(Span::new(file, 0, 4), "the statement")
            .note("a fact")
            .help("write it\nlike this");
        (sources, diagnostic)
    }

    #[test]
    fn human_shows_source_labels_notes_and_help() {
        let (sources, diagnostic) = sample("GOTO/ 1 2\n", 8, 9);
        let text = render(&diagnostic, &sources, Format::Human, false);
        insta::assert_snapshot!(text);
        assert!(render(&diagnostic, &sources, Format::Human, true).contains("\u{1b}["));
    }

    #[test]
    fn short_is_one_line() {
        let (sources, diagnostic) = sample("\nGOTO/ 1 2\n", 9, 10);
        assert_eq!(
            render(&diagnostic, &sources, Format::Short, true),
            "a.apt:2:9: error[E0101]: expected a comma\n"
        );
    }

    #[test]
    fn what_a_file_holds_does_not_control_the_terminal() {
        let (sources, mut diagnostic) = sample("GOTO/ 1\u{1b}[31m\u{9b}31m\0 2\n", 18, 19);
        diagnostic.message = "no record from `\u{1b}[31m` on".to_owned();
        for format in [Format::Human, Format::Short] {
            let text = render(&diagnostic, &sources, format, false);
            assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}");
            assert!(text.contains("a.apt:1:"), "{text}");
        }
        let colored = render(&diagnostic, &sources, Format::Human, true);
        assert!(!colored.contains("1\u{1b}[31m") && !colored.contains('\u{9b}'), "{colored:?}");
    }

    #[test]
    fn json_counts_utf16_units_from_zero() {
        let (sources, diagnostic) = sample("PPRINT 𝛼é 2\n", 14, 15);
        let value: serde_json::Value =
            serde_json::from_str(&render(&diagnostic, &sources, Format::Json, false)).expect("valid JSON");
        assert_eq!(value["range"]["start"]["character"], 11);
        assert_eq!(value["severity"], 1);
        assert_eq!(value["relatedInformation"][1]["message"], "the statement");
    }

    #[test]
    fn a_line_of_a_megabyte_is_shown_in_part() {
        let text = format!("{}X{}\n", "1,".repeat(500_000), ",2".repeat(500_000));
        let (sources, diagnostic) = sample(&text, 1_000_000, 1_000_001);
        let shown = render(&diagnostic, &sources, Format::Human, false);
        assert!(shown.len() < 2_000, "{} bytes", shown.len());
        assert!(shown.contains("a.apt:1:1000001"), "{shown}");
        assert!(shown.contains('X'), "{shown}");
    }
}
