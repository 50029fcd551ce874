//! A run of tests as JUnit XML, as build servers read it: a suite for each program, no times, no machine names.

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};

use super::report::{Run, reason, word};
use super::{Outcome, Verdict};

/// The XML text.
#[must_use]
pub fn junit(run: &Run) -> String {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    // Writing to a vector cannot fail.
    let _ = document(&mut writer, run);
    let mut text = String::from_utf8(writer.into_inner()).unwrap_or_default();
    text.push('\n');
    text
}

fn document(writer: &mut Writer<Vec<u8>>, run: &Run) -> io::Result<()> {
    writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let counts = Counts::of(&run.outcomes);
    let root = counts.on(writer.create_element("testsuites").with_attribute(("name", "partwright test")));
    root.write_inner_content(|writer| {
        let mut rest = run.outcomes.as_slice();
        while let Some(first) = rest.first() {
            let end = rest.iter().position(|o| o.program != first.program).unwrap_or(rest.len());
            let (suite, others) = rest.split_at(end);
            write_suite(writer, run, &first.program, suite)?;
            rest = others;
        }
        run.skipped.iter().try_for_each(|(program, why)| write_skipped(writer, program, why))
    })?;
    Ok(())
}

/// Numbers that suites carry.
struct Counts {
    tests: usize,
    failures: usize,
    errors: usize,
}

impl Counts {
    fn of(outcomes: &[Outcome]) -> Counts {
        let errors = outcomes.iter().filter(|o| matches!(o.verdict, Verdict::Errors)).count();
        let bad = outcomes.iter().filter(|o| !o.passed()).count();
        Counts { tests: outcomes.len(), failures: bad - errors, errors }
    }
    fn on<'w>(
        &self,
        element: quick_xml::writer::ElementWriter<'w, Vec<u8>>,
    ) -> quick_xml::writer::ElementWriter<'w, Vec<u8>> {
        element
            .with_attribute(("tests", self.tests.to_string().as_str()))
            .with_attribute(("failures", self.failures.to_string().as_str()))
            .with_attribute(("errors", self.errors.to_string().as_str()))
    }
}

fn write_suite(writer: &mut Writer<Vec<u8>>, run: &Run, program: &str, suite: &[Outcome]) -> io::Result<()> {
    let program = clean(program);
    let element = writer.create_element("testsuite").with_attribute(("name", program.as_str()));
    Counts::of(suite).on(element).write_inner_content(|writer| {
        suite.iter().try_for_each(|outcome| write_case(writer, run, outcome))
    })?;
    Ok(())
}

fn write_case(writer: &mut Writer<Vec<u8>>, run: &Run, outcome: &Outcome) -> io::Result<()> {
    let (name, class) =
        (clean(&super::names::test("", &outcome.variant, &outcome.post)), clean(&outcome.program));
    let case = writer
        .create_element("testcase")
        .with_attribute(("name", name.trim()))
        .with_attribute(("classname", class.as_str()));
    if outcome.passed() {
        case.write_empty()?;
        return Ok(());
    }
    let kind = if matches!(outcome.verdict, Verdict::Errors) { "error" } else { "failure" };
    let text = clean(&reason(run, outcome));
    case.write_inner_content(|writer| {
        let failure = writer.create_element(kind).with_attribute(("message", word(&outcome.verdict)));
        failure.write_text_content(BytesText::new(&text))?;
        Ok(())
    })?;
    Ok(())
}

fn write_skipped(writer: &mut Writer<Vec<u8>>, program: &str, why: &str) -> io::Result<()> {
    let (program, why) = (clean(program), clean(why));
    let suite = writer.create_element("testsuite").with_attribute(("name", program.as_str()));
    suite.with_attribute(("tests", "1")).with_attribute(("skipped", "1")).write_inner_content(|writer| {
        writer.create_element("testcase").with_attribute(("name", "skipped")).write_inner_content(
            |writer| {
                writer.create_element("skipped").with_attribute(("message", why.as_str())).write_empty()?;
                Ok(())
            },
        )?;
        Ok(())
    })?;
    Ok(())
}

/// Without the characters that XML 1.0 cannot hold, however they are escaped.
fn clean(text: &str) -> String {
    let allowed = |c: char| matches!(c, '\t' | '\n') || (c >= ' ' && !matches!(c, '\u{fffe}' | '\u{ffff}'));
    text.chars().map(|c| if allowed(c) { c } else { '\u{fffd}' }).collect()
}
