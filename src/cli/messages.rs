//! Messages to standard error.

use std::io::{IsTerminal, Write};

use super::args::{Cli, Color};
use crate::diag::codes::{self, command};
use crate::diag::render::{Format, render};
use crate::diag::{Diagnostic, Severity};
use crate::source::SourceMap;

/// How this run writes messages.
#[derive(Debug, Clone, Copy)]
pub struct Messages {
    format: Format,
    color: bool,
}

impl Messages {
    /// As the command line and the environment say.
    #[must_use]
    pub fn of(cli: &Cli) -> Self {
        let color = match cli.color {
            Color::Always => true,
            Color::Never => false,
            Color::Auto => {
                std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
                    && std::env::var_os("TERM").is_none_or(|t| t != "dumb")
                    && std::io::stderr().is_terminal()
            }
        };
        Messages { format: cli.message_format.into(), color }
    }

    /// Whether people read it.
    #[must_use]
    pub fn for_people(self) -> bool {
        self.format == Format::Human
    }

    /// Writes diagnostics, and for people how many errors there are.
    pub fn show(self, diagnostics: &[Diagnostic], sources: &SourceMap) {
        let mut text: String = diagnostics.iter().map(|d| self.one(d, sources)).collect();
        let count = |severity| diagnostics.iter().filter(|d| d.severity == severity).count();
        if self.for_people() && count(Severity::Error) > 0 {
            text.push_str(&summary(count(Severity::Error), count(Severity::Warning)));
        }
        to_stderr(&text);
    }

    fn one(self, diagnostic: &Diagnostic, sources: &SourceMap) -> String {
        let mut text = render(diagnostic, sources, self.format, self.color);
        if self.for_people() && !text.ends_with("\n\n") {
            text.push('\n');
        }
        text
    }

    /// Writes one diagnostic that has no place in a source file.
    pub fn global(self, diagnostic: &Diagnostic) {
        to_stderr(&render(diagnostic, &SourceMap::default(), self.format, self.color));
    }
}

fn summary(errors: usize, warnings: usize) -> String {
    let plural = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    let warnings =
        if warnings == 0 { String::new() } else { format!(" and {}", plural(warnings, "warning")) };
    format!("{}{warnings}; nothing was written\n", plural(errors, "error"))
}

/// Writes to standard error; when that is closed there is nobody to tell.
pub fn to_stderr(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// Checks the `--deny` arguments.
pub fn check_deny(deny: &[String]) -> Result<(), Diagnostic> {
    let unknown = deny.iter().find(|d| !d.eq_ignore_ascii_case("warnings") && codes::find(d).is_none());
    unknown.map_or(Ok(()), |id| Err(unknown_code(id)))
}

/// The message for a code that does not exist.
pub fn unknown_code(id: &str) -> Diagnostic {
    let diagnostic = Diagnostic::global(&command::UNKNOWN_CODE, format!("there is no diagnostic {id}"));
    match crate::diag::did_you_mean(id, codes::all().map(|c| c.id)) {
        Some(near) => diagnostic.help(format!("did you mean {near}?")),
        None => diagnostic.help("`partwright explain` lists all codes"),
    }
}

/// Makes the denied warnings errors.
pub fn deny(diagnostics: &mut [Diagnostic], deny: &[String]) {
    let denied = |d: &Diagnostic| {
        deny.iter().any(|id| match d.severity {
            Severity::Warning => id.eq_ignore_ascii_case("warnings") || id.eq_ignore_ascii_case(d.code.id),
            Severity::Note => id.eq_ignore_ascii_case(d.code.id),
            Severity::Error => false,
        })
    };
    for diagnostic in diagnostics.iter_mut().filter(|d| denied(d)) {
        diagnostic.severity = Severity::Error;
        diagnostic.notes.push("an error because of --deny".to_owned());
    }
}
