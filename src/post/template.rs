//! Templates of cold events: start, end, tool change, operations. Motion never comes here.
//!
//! Undefined variables are errors. Numbers are printed by [`crate::target::number`], texts of the user come in cleaned
//! for comments already, so that a template cannot let them out.

use std::collections::BTreeSet;
use std::sync::Arc;

use minijinja::value::Value;
use minijinja::{Environment, ErrorKind, UndefinedBehavior};

use super::comment::Comments;
use crate::target::number;

/// Steps a template may take.
const FUEL: u64 = 100_000;

/// Renders templates of one dialect.
pub struct Renderer {
    environment: Environment<'static>,
}

/// A template that cannot be rendered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TemplateError {
    /// Line in the template, from 1.
    pub line: Option<usize>,
    /// What is wrong.
    pub message: String,
}

impl Renderer {
    /// For a dialect with these comments.
    #[must_use]
    pub fn new(comments: &Comments) -> Renderer {
        let mut environment = Environment::new();
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        environment.set_fuel(Some(FUEL));
        environment.set_auto_escape_callback(|_| minijinja::AutoEscape::None);
        let rules = Arc::new(comments.clone());
        let all = Arc::clone(&rules);
        environment.add_filter("comment", move |text: &str| all.lines(text).join("\n"));
        environment.add_filter("comment_cut", move |text: &str| {
            rules.lines(text).into_iter().next().unwrap_or_default()
        });
        environment.add_filter("pad", pad);
        environment.add_filter("num", fixed);
        Renderer { environment }
    }

    /// The non-empty lines that `template` gives with `context`, without trailing blanks.
    ///
    /// # Errors
    /// A syntax error, an undefined variable, or a template that runs too long.
    pub fn lines(&self, template: &str, context: &Value) -> Result<Vec<String>, TemplateError> {
        let text = self.environment.render_str(template, context).map_err(|e| describe(&e))?;
        Ok(text.lines().map(str::trim_end).filter(|line| !line.is_empty()).map(str::to_owned).collect())
    }

    /// The variables that a template reads and does not set itself, members with a point, by name; none when
    /// it cannot be compiled.
    #[must_use]
    pub fn variables(&self, template: &str) -> BTreeSet<String> {
        let compiled = self.environment.template_from_str(template);
        let names = compiled.map(|t| t.undeclared_variables(true)).unwrap_or_default();
        let globals: BTreeSet<&str> = self.environment.globals().map(|(name, _)| name).collect();
        names.into_iter().filter(|name| !globals.contains(name.as_str())).collect()
    }

    /// Checks the syntax only.
    ///
    /// # Errors
    /// A syntax error, or an unknown filter.
    pub fn check(&self, template: &str) -> Result<(), TemplateError> {
        self.environment.template_from_str(template).map(|_| ()).map_err(|e| describe(&e))
    }
}

fn describe(error: &minijinja::Error) -> TemplateError {
    let message = match (error.kind(), error.detail()) {
        (ErrorKind::UndefinedError, detail) => {
            format!("undefined variable{}", detail.map(|d| format!(": {d}")).unwrap_or_default())
        }
        (kind, Some(detail)) => format!("{kind}: {detail}"),
        (kind, None) => kind.to_string(),
    };
    TemplateError { line: error.line(), message }
}

/// `7 | pad(4)` → `0007`.
fn pad(value: u64, width: usize) -> String {
    format!("{value:0width$}", width = width.min(16))
}

/// `1.25 | num(3)` → `1.25`; at most so many decimals.
fn fixed(value: f64, decimals: u8) -> Result<String, minijinja::Error> {
    number::steps(value, decimals.min(9)).map(|steps| number::plain(steps, decimals.min(9))).ok_or_else(
        || {
            minijinja::Error::new(
                ErrorKind::InvalidOperation,
                format!("{value} is not a number that can be printed"),
            )
        },
    )
}
