//! Machines that say what they do otherwise than the control they resemble.

use super::*;

/// The cuts and dwells of a body under what a machine says.
fn said(statements: &str, body: &str) -> Trace {
    trace(&format!("linuxcnc {statements}"), &linuxcnc(body))
}

fn events(statements: &str, body: &str) -> Vec<TraceEvent> {
    let trace = said(statements, body);
    assert!(trace.faults.is_empty(), "{statements}: {body}: {:?}", trace.faults);
    trace.events
}

fn same(statements: &str, body: &str, plain: &str) {
    let kinds = |events: Vec<TraceEvent>| events.iter().map(|e| format!("{:?}", e.kind)).collect::<Vec<_>>();
    assert_eq!(kinds(events(statements, body)), kinds(events("", plain)), "{statements}");
}

fn refused(statements: &str, body: &str, words: &str) {
    let faults = said(statements, body).faults;
    assert!(faults.iter().any(|f| f.message.contains(words)), "{statements}: {body}: {faults:?}");
}

#[test]
fn dwells_have_the_word_and_the_unit_that_is_said() {
    for (statement, body) in [
        ("dwell=K:0.01s", "G4 K125"),
        ("dwell=X:s", "G4 X1.25"),
        ("dwell=F:ms", "G4 F1250"),
        ("dwell=X:s,P:ms", "G4 P1250"),
        ("dwell=P:point", "G4 P1250"),
        ("dwell=DW:s", "G4 DW1.25"),
        ("dwell=T=:s", "G4 T=1.25"),
    ] {
        same(statement, body, "G4 P1.25");
    }
    refused("dwell=K:0.01s", "G4 P1", "G4 without the dwell's time");
    refused("dwell=K:0.01s", "G4 K1 P1", "P1: no code in the block uses it");
    refused("dwell=K:0.01s", "G4 K-1", "the negative time K-1");
}

#[test]
fn cycles_have_the_words_that_are_said() {
    let plain = "G0 X0 Y0 Z20\nG98 G82 X5 Y5 Z-4 R2 P0.5 F50\nX9\nG80";
    let other = "G0 X0 Y0 Z20\nG98 G82 X5 Y5 I-4 Z2 K50 F50\nX9\nG80";
    let words = "cycle-level=Z cycle-bottom=I cycle-dwell=K:0.01s";
    same(words, other, plain);
    refused(words, plain, "R2: no code in the block uses it");
    refused(words, &other.replace("I-4 ", ""), "a drilling cycle without I");
    let plain = "G0 X0 Y0 Z20\nG98 G83 X5 Y5 Z-4 R2 Q1 F50\nX9\nG80";
    let other = "G0 X0 Y0 Z20\nG85 X5 Y5 Z-4 EH2 ER20 EP1 F50\nX9\nG80";
    let words = "cycle-level=EH cycle-after=ER cycle-peck=EP G85=G83";
    same(words, other, plain);
    refused(words, &other.replace("ER20", "ER1"), "ER1 is below the height 2");
    refused(words, &other.replace("EP1", "EP0"), "a peck of EP0 mm");
    refused(words, &other.replace("EH2", "E2"), "E2: no code in the block uses it");
    refused(words, &other.replace("EH2", "EH"), "EH in column 15 is not followed by a number");
    refused(words, &other.replace("EH2", "EH2 EH2"), "multiple EH words in one block");
    let level = "cycle-return=level";
    same(level, "G0 X0 Y0 Z20\nG81 X5 Z-4 R2 F50\nG80", "G0 X0 Y0 Z20\nG99 G81 X5 Z-4 R2 F50\nG80");
    let initial = "cycle-return=initial";
    same(initial, "G0 X0 Y0 Z20\nG81 X5 Z-4 R2 F50\nG80", "G0 X0 Y0 Z20\nG98 G81 X5 Z-4 R2 F50\nG80");
}

#[test]
fn arcs_have_the_words_and_the_centre_that_are_said() {
    let start = "G0 X10 Y0\nG1 Z-1\n";
    let arc = |words: &str| format!("{start}{words}");
    same("arc-centre=program", &arc("G3 X0 Y10 I0 J0"), &arc("G3 X0 Y10 I-10 J0"));
    same("arc-words=P,Q,D", &arc("G3 X0 Y10 P-10 Q0"), &arc("G3 X0 Y10 I-10 J0"));
    same("arc-radius=CR=", &arc("G3 X0 Y10 CR=10"), &arc("G3 X0 Y10 R10"));
    refused("arc-centre=program", &arc("G3 X0 Y10 I0"), "I and J must both stand");
    refused("arc-centre=program", &arc("G91 G3 X-10 Y10 I0 J0"), "an arc under G91");
    refused("arc-centre=said", &arc("G3 X0 Y10"), "an arc without R");
    refused("arc-tolerance=0.0001", &arc("G3 X0 Y10.001 I-10 J0"), "differs from radius to start");
    refused("arc-end=needed", &arc("G3 I-10 J0"), "an arc needs X or Y");
}

#[test]
fn codes_may_be_unknown_or_mean_nothing() {
    same("M77=nothing", "M77\nG1 X1", "G1 X1");
    refused("M77=nothing", "M77 P3", "P3: no code in the block uses it");
    refused("G64=unknown", "G64 P0.1", "unknown code G64");
    refused("", "M77", "unknown code M77");
}

#[test]
fn frames_comments_and_lines_are_as_it_is_said() {
    let body = "G21 G90 G94 G17 G40 G49 G61 G54\nT1 M6\nG43 H1\nS1000 M3\nG0 X0 Y0 Z5\nG1 X1 F100\n";
    let whole = |first: &str, last: &str| format!("{first}{body}M2\n{last}");
    for (statement, first, last) in [
        ("frame=percent-name", "%1234 (TITLE)\n", ""),
        ("frame=percent-number", "%\nO12\n", "%\n"),
        ("frame=name", "OABC\n", ""),
        ("frame=end comments=;", "; TITLE\n", ""),
        ("frame=number length=none", "O7\n", ""),
    ] {
        let trace = trace(&format!("linuxcnc {statement}"), &whole(first, last));
        assert!(trace.faults.is_empty(), "{statement}: {:?}", trace.faults);
    }
    for (statement, first, words) in [
        ("frame=percent-name", "%\n", "does not start with '%' and its number"),
        ("frame=percent-name", "%12 X1\n", "words behind the program's name"),
        ("comments=;", "(TITLE)\n", "bad character '('"),
        ("comments=none", "; TITLE\n", "bad character ';'"),
        ("line=10", "", "the control takes 10"),
        ("most-m=0", "", "M codes in one block, the control takes 0"),
    ] {
        let faults = trace(&format!("linuxcnc {statement}"), &whole(first, "")).faults;
        assert!(faults.iter().any(|f| f.message.contains(words)), "{statement}: {faults:?}");
    }
}

#[test]
fn what_means_nothing_is_refused_with_its_reason() {
    for (statement, words) in [
        ("dwell", "NAME=VALUE"),
        ("dwel=K:s", "nothing is called `dwel`"),
        ("dwell=K", "it takes ADDRESS:UNIT"),
        ("dwell=K:hours", "it takes s, ms"),
        ("dwell=K:s,P:s,X:s", "two words at most"),
        ("dwell=G:s", "means something else"),
        ("dwell=k:s", "is no address"),
        ("arc-radius=TOOLONG", "is no address"),
        ("arc-radius==", "is no address"),
        ("arc-words=I,J", "three addresses"),
        ("arc-radius=I", "`arc-words` and `arc-radius` are both I"),
        ("arc-tolerance=5", "it takes mm"),
        ("cycle-dwell=Q:s", "are both Q"),
        ("line=-1", "it takes a number"),
        ("frame=fanuc", "it takes number,"),
        ("G1=G1", "another code"),
        ("G1=M1", "another code"),
        ("G1=", "is no code"),
        ("G1=G2 G1=G3", "G1 is said twice"),
        (
            "cycle-level=AB cycle-peck=CD cycle-bottom=EF cycle-after=GH arc-words=IJ,KL,MN",
            "all there may be",
        ),
    ] {
        let error = run(b"", &format!("linuxcnc {statement}"), &setup()).expect_err(statement).to_string();
        assert!(error.contains("'linuxcnc' means nothing") && error.contains(words), "{statement}: {error}");
    }
    let error = run(b"", "grbl cycle-level=Z", &setup()).expect_err("no cycles").to_string();
    assert!(error.contains("the control grbl has no drilling cycles"), "{error}");
    assert!(run(b"", "heidenhain dwell=K:s", &setup()).is_err());
}

#[test]
fn pecks_may_be_counted() {
    let holes = |peck: &str| format!("G0 X0 Y0 Z20\nG98 G83 X5 Y5 Z-4 R2 {peck} F50\nX9\nG80");
    same("cycle-pecks=J", &holes("J6"), &holes("Q1"));
    refused("cycle-pecks=J", &holes("J0.5"), "0.5 pecks of J");
    refused("cycle-pecks=J", &holes("J0"), "0 pecks of J");
    refused("cycle-pecks=J", &holes("Q1"), "a peck drilling cycle without J");
}

#[test]
fn a_character_may_end_every_line() {
    let text =
        "%\nO12\nG21 G90 G94 G17 G40 G49 G61 G54\nT1 M6\nG43 H1\nS1000 M3\nG0 X0 Y0 Z5\nG1 X1 F100\nM2\n%\n";
    let ended = text.replace('\n', "*\n").replace("%*", "%");
    let faults = |text: &str| {
        let trace = trace("linuxcnc frame=percent-number line-end=*", text);
        trace.faults.into_iter().map(|f| f.message).collect::<Vec<_>>()
    };
    assert_eq!(faults(&ended), [""; 0]);
    assert!(faults(&ended.replace("M6*", "M6")).iter().any(|f| f.contains("does not end with `*`")));
    assert!(faults(&ended.replace("T1 M6", "T1*M6")).iter().any(|f| f.contains("ends the block before")));
    for wrong in ["line-end=%", "line-end=**", "line-end=A", "line-end="] {
        assert!(crate::readback::needs(&format!("linuxcnc {wrong}")).is_err(), "{wrong}");
    }
}
