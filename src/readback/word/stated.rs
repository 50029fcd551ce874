//! What a machine says of itself behind the name of the control that it resembles: `fanuc G70=G20 dwell=K:0.01s`.
//!
//! Each statement is a fact of the machine's own manual. It changes a row of [`Rules`], so that a control with other
//! letters or codes is read by the interpreter of its family.

use super::CONTROLS;
use super::block::bit;
use super::cubic::Cubic;
use super::renamed::{self, Renamed};
use super::rules::{ADDRESS, ADDRESSES, Cycles, Dwell, Frame, LETTERS, Language, Rules, Unpointed};

/// What a statement may say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Statement {
    /// What stands before `=`.
    pub name: &'static str,
    /// What may stand after it.
    pub values: &'static str,
    /// What it says.
    pub doc: &'static str,
}

type Set = fn(&mut Rules, &str) -> Result<(), String>;

const fn row(name: &'static str, values: &'static str, doc: &'static str, set: Set) -> (Statement, Set) {
    (Statement { name, values, doc }, set)
}

const WORD: &str = "an address";

/// All statements but those of codes.
const STATEMENTS: [(Statement, Set); 28] = [
    row(
        "frame",
        "`number`, `percent-number`, `percent-name`, `percent`, `name`, `end`, `free`",
        "an O number may come first and M2 or M30 comes last; `%` and an O number first and `%` last; `%` with a number first; a pair of `%` or an end; O with four characters first; an end; nothing",
        frame,
    ),
    row("comments", "`()`, `;`, `();`, `none`", "what starts a comment", comments),
    row(
        "numbers",
        "`whole`, `least`, `setting`",
        "a length without a point: whole units, least increments, or one of them by a setting",
        |r, v| {
            put(
                v,
                &mut r.unpointed,
                &[("whole", Unpointed::Whole), ("least", Unpointed::Least), ("setting", Unpointed::Setting)],
            )
        },
    ),
    row("line-end", "a character", "ends every line but a lone `%`, and stands nowhere else in it", line_end),
    row("line", "a number", "longest line in characters, 0 without limit", line),
    row("most-m", "a number", "M codes in a block", most_m),
    row("motion", "`modal`, `repeated`", "whether motion codes stay in force", |r, v| {
        put(v, &mut r.repeat_motion, &[("modal", false), ("repeated", true)])
    }),
    row("feed-mode", "`said`, `per-minute`", "whether programs choose between feed modes", |r, v| {
        put(v, &mut r.feed_modes, &[("said", true), ("per-minute", false)])
    }),
    row("corners", "`exact`, `said`", "whether the path is exact without G61 or G64", |r, v| {
        put(v, &mut r.blends, &[("exact", false), ("said", true)])
    }),
    row("offsets", "`said`, `none`", "whether programs choose a work offset", |r, v| {
        put(v, &mut r.work_offset, &[("said", true), ("none", false)])
    }),
    row("tool", "`M6`, `T`", "what changes tools", |r, v| {
        put(v, &mut r.tool_change, &[("M6", true), ("T", false)])
    }),
    row(
        "length",
        "`G43`, `word`, `none`",
        "what takes the tool's length in: G43 with its word, the word alone (0 takes it out), or the tool change",
        length,
    ),
    row("length-word", WORD, "word of the tool's length", length_word),
    row(
        "dwell",
        "ADDRESS:UNIT, or two with a comma; units: `s`, `ms`, `0.01s`, `point` (s with a point, ms without), `turns`",
        "words of G4",
        dwell,
    ),
    row(
        "arc-centre",
        "`start`, `program`, `said`",
        "what centre words count from: the arc's start, the program's zero, or as G90.1 and G91.1 say",
        arc_centre,
    ),
    row("arc-words", "three addresses with commas", "words of an arc's centre along X, Y and Z", arc_words),
    row("arc-radius", WORD, "word of an arc's radius", arc_radius),
    row("arc-tolerance", "mm", "how far the radii at an arc's start and end may differ", arc_tolerance),
    row("arc-end", "`needed`, `bare`", "whether every arc needs an end word in its plane", |r, v| {
        put(v, &mut r.arc_needs_end, &[("needed", true), ("bare", false)])
    }),
    row(
        "splines",
        "`none`, `exact`, `chords`",
        "whether G5 with I J P Q is a cubic piece, and what is cut of it: the piece, or chords as Marlin's BEZIER_CURVE_SUPPORT makes them",
        |r, v| {
            put(v, &mut r.cubic, &[("none", Cubic::None), ("exact", Cubic::Exact), ("chords", Cubic::Chords)])
        },
    ),
    row("cycle-level", WORD, "word of the height where feed begins in drilling cycles", |r, v| {
        cycle_word(r, v, |c| &mut c.level)
    }),
    row("cycle-bottom", WORD, "word of the bottom of a hole", |r, v| cycle_word(r, v, |c| &mut c.bottom)),
    row(
        "cycle-after",
        WORD,
        "word of the height to which the tool goes after a hole; without it, it goes to that where feed begins",
        cycle_after,
    ),
    row("cycle-peck", WORD, "word of the depth of a peck", |r, v| cycle_word(r, v, |c| &mut c.peck)),
    row(
        "cycle-pecks",
        WORD,
        "word of the number of equal pecks, from the height where feed begins to the bottom, in place of their depth",
        |r, v| {
            cycle_word(r, v, |c| &mut c.peck)?;
            cycles(r).map(|c| c.pecks_counted = true)
        },
    ),
    row("cycle-dwell", "ADDRESS:UNIT", "word of the dwell in drilling cycles", cycle_dwell),
    row("cycle-repeat", "an address, `none`", "word that repeats a hole", cycle_repeat),
    row(
        "cycle-return",
        "`said`, `level`, `initial`",
        "where the tool goes after a hole: as G98 and G99 say, or always there",
        cycle_return,
    ),
];

/// What may be said behind the name of a word-address control, besides codes.
pub fn statements() -> impl Iterator<Item = Statement> {
    STATEMENTS.iter().map(|(statement, _)| *statement)
}

/// A control with what a machine says of itself.
#[derive(Debug)]
pub(in crate::readback) struct Stated {
    pub rules: Rules,
    pub renamed: Vec<Renamed>,
}

/// The control that `text` describes; `None` where its name is none of this family.
///
/// # Errors
/// The first statement that means nothing, and why.
pub(super) fn read(text: &str) -> Option<Result<Stated, String>> {
    let mut words = text.split_whitespace();
    let name = words.next()?;
    let rules = CONTROLS.into_iter().find(|c| c.name == name)?;
    let mut stated = Stated { rules: *rules, renamed: Vec::new() };
    let read =
        words.try_for_each(|word| statement(&mut stated, word).map_err(|why| format!("`{word}`: {why}")));
    let read = read.and_then(|()| one_meaning_each(&stated.rules));
    Some(read.map(|()| stated))
}

/// A word has one meaning in a cycle, and one in an arc.
fn one_meaning_each(rules: &Rules) -> Result<(), String> {
    let [i, j, k] = rules.arc_offsets;
    let arcs = [("X", b'X'), ("Y", b'Y'), ("Z", b'Z'), ("arc-words", i), ("arc-words", j), ("arc-words", k)];
    let mut words = vec![arcs.to_vec()];
    words[0].push(("arc-radius", rules.arc_radius));
    if let Some(c) = rules.cycles {
        let always = [("cycle-level", c.level), ("cycle-bottom", c.bottom), ("cycle-peck", c.peck)];
        let more =
            [("cycle-repeat", c.repeats), ("cycle-after", c.after), ("cycle-dwell", Some(c.dwell_word))];
        let more = more.into_iter().filter_map(|(name, word)| word.map(|word| (name, word)));
        words.push(always.into_iter().chain(more).collect());
    }
    for words in &words {
        for (at, (name, word)) in words.iter().enumerate() {
            if let Some((other, _)) = words.iter().skip(at + 1).find(|(_, other)| other == word) {
                let word = rules.address(*word);
                return Err(format!(
                    "`{name}` and `{other}` are both {word}; say another word for one of them"
                ));
            }
        }
    }
    Ok(())
}

fn statement(stated: &mut Stated, word: &str) -> Result<(), String> {
    let (name, value) = word.split_once('=').ok_or("a statement is NAME=VALUE or a code, as in `G71=G21`")?;
    if let Some((_, set)) = STATEMENTS.iter().find(|(s, _)| s.name == name) {
        return set(&mut stated.rules, value);
    }
    if name.starts_with(|c: char| c.is_ascii_lowercase()) {
        let names: Vec<&str> = statements().map(|s| s.name).collect();
        return Err(format!("nothing is called `{name}`; there are codes and {}", names.join(", ")));
    }
    let code = renamed::read(name, value)?;
    if stated.renamed.iter().any(|other| other.is_about(&code)) {
        return Err(format!("{name} is said twice"));
    }
    stated.renamed.push(code);
    Ok(())
}

/// One of several values.
fn choice<T: Copy>(value: &str, table: &[(&str, T)]) -> Result<T, String> {
    let found = table.iter().find(|(name, _)| *name == value).map(|(_, meaning)| *meaning);
    found.ok_or_else(|| {
        let names: Vec<&str> = table.iter().map(|(name, _)| *name).collect();
        format!("it takes {}", names.join(", "))
    })
}

/// Sets what one of several values means.
fn put<T: Copy>(value: &str, place: &mut T, table: &[(&str, T)]) -> Result<(), String> {
    *place = choice(value, table)?;
    Ok(())
}

fn count(value: &str) -> Result<usize, String> {
    value.parse().ok().filter(|n| *n <= 65_535).ok_or_else(|| "it takes a number up to 65535".to_owned())
}

/// What an address counts as: its letter, or a place for a longer one.
fn address(rules: &mut Rules, text: &str) -> Result<u8, String> {
    let bytes = text.as_bytes();
    let (last, stem) = bytes.split_last().ok_or("it takes an address")?;
    let stem = if *last == b'=' { stem } else { bytes };
    if stem.is_empty() || bytes.len() > ADDRESS || !stem.iter().all(u8::is_ascii_uppercase) {
        return Err(format!(
            "`{text}` is no address: capital letters, {ADDRESS} characters at most, `=` may be the last"
        ));
    }
    if let [letter] = bytes {
        let taken = matches!(letter, b'G' | b'M' | b'N' | b'O' | b'X' | b'Y');
        return if taken { Err(format!("{text} means something else already")) } else { Ok(*letter) };
    }
    let known = rules.longer_addresses().find(|(name, _)| *name == bytes).map(|(_, letter)| letter);
    known.map_or_else(|| new_address(rules, bytes), Ok)
}

fn new_address(rules: &mut Rules, bytes: &[u8]) -> Result<u8, String> {
    let free = (LETTERS..).zip(&mut rules.addresses).find(|(_, name)| name[0] == 0);
    let (letter, place) =
        free.ok_or_else(|| format!("{ADDRESSES} addresses of more than one letter is all there may be"))?;
    for (to, from) in place.iter_mut().zip(bytes) {
        *to = *from;
    }
    Ok(letter)
}

/// An address whose number may carry a point.
fn number_address(rules: &mut Rules, text: &str) -> Result<u8, String> {
    let letter = address(rules, text)?;
    rules.whole_numbers &= !bit(letter);
    Ok(letter)
}

fn frame(rules: &mut Rules, value: &str) -> Result<(), String> {
    rules.frame = choice(
        value,
        &[
            ("number", Frame::OptionalNumber),
            ("percent-number", Frame::PercentAndNumber),
            ("percent-name", Frame::PercentName),
            ("percent", Frame::PercentPairOrEnd),
            ("name", Frame::Name),
            ("end", Frame::End),
            ("free", Frame::Free),
        ],
    )?;
    rules.percent_allowed = !matches!(rules.frame, Frame::End | Frame::Free);
    Ok(())
}

fn comments(rules: &mut Rules, value: &str) -> Result<(), String> {
    let table =
        [("()", (true, false)), (";", (false, true)), ("();", (true, true)), ("none", (false, false))];
    (rules.parentheses, rules.semicolon_comment) = choice(value, &table)?;
    Ok(())
}

fn line_end(rules: &mut Rules, value: &str) -> Result<(), String> {
    match *value.as_bytes() {
        [end] if end.is_ascii_punctuation() && !b"%+-.=()".contains(&end) => {
            rules.line_end = end;
            Ok(())
        }
        _ => Err("it takes one character that no word holds, as `*` or `;`".to_owned()),
    }
}

fn line(rules: &mut Rules, value: &str) -> Result<(), String> {
    rules.line_limit = Some(count(value)?).filter(|limit| *limit > 0);
    rules.limit_counts_all = true;
    Ok(())
}

fn most_m(rules: &mut Rules, value: &str) -> Result<(), String> {
    rules.most_m = count(value)?;
    Ok(())
}

fn length(rules: &mut Rules, value: &str) -> Result<(), String> {
    (rules.length_offset, rules.length_by_d) =
        choice(value, &[("G43", (true, false)), ("word", (true, true)), ("none", (false, false))])?;
    Ok(())
}

fn length_word(rules: &mut Rules, value: &str) -> Result<(), String> {
    rules.length_word = address(rules, value)?;
    Ok(())
}

/// `K:0.01s`.
fn timed(rules: &mut Rules, text: &str) -> Result<(u8, Dwell), String> {
    let (word, unit) = text.split_once(':').ok_or("it takes ADDRESS:UNIT, as in `K:0.01s`")?;
    let table = [
        ("s", Dwell::Seconds),
        ("ms", Dwell::Milliseconds),
        ("0.01s", Dwell::Hundredths),
        ("point", Dwell::ByPoint),
        ("turns", Dwell::Revolutions),
    ];
    let unit = choice(unit, &table)?;
    // X is an axis everywhere but in a dwell.
    let letter = if word == "X" { b'X' } else { address(rules, word)? };
    if matches!(unit, Dwell::Seconds | Dwell::ByPoint) {
        rules.whole_numbers &= !bit(letter);
    }
    Ok((letter, unit))
}

fn dwell(rules: &mut Rules, value: &str) -> Result<(), String> {
    let mut words = [None, None];
    let mut given = value.split(',');
    for place in &mut words {
        *place = given.next().map(|text| timed(rules, text)).transpose()?;
    }
    rules.dwell = words;
    if given.next().is_some() { Err("it takes two words at most".to_owned()) } else { Ok(()) }
}

fn arc_centre(rules: &mut Rules, value: &str) -> Result<(), String> {
    (rules.arc_absolute, rules.arc_mode_stated) =
        choice(value, &[("start", (false, false)), ("program", (true, false)), ("said", (false, true))])?;
    Ok(())
}

fn arc_words(rules: &mut Rules, value: &str) -> Result<(), String> {
    let words: Vec<&str> = value.split(',').collect();
    let [x, y, z] = *words else { return Err("it takes three addresses, as in `I,J,K`".to_owned()) };
    let mut place = |text| number_address(rules, text);
    rules.arc_offsets = [place(x)?, place(y)?, place(z)?];
    rules.arc_turns &= !rules.arc_offsets.contains(&b'P');
    Ok(())
}

fn arc_radius(rules: &mut Rules, value: &str) -> Result<(), String> {
    rules.arc_radius = number_address(rules, value)?;
    rules.arc_turns &= rules.arc_radius != b'P';
    Ok(())
}

fn arc_tolerance(rules: &mut Rules, value: &str) -> Result<(), String> {
    let mm = value.parse().ok().filter(|mm: &f64| (1e-6..=1.0).contains(mm));
    rules.stated_difference = Some(mm.ok_or("it takes mm, from 0.000001 to 1")?);
    Ok(())
}

/// The control's drilling cycles.
fn cycles(rules: &mut Rules) -> Result<&mut Cycles, String> {
    let name = rules.name;
    let own_words = rules.language == Language::Sinumerik;
    let cycles = rules.cycles.as_mut().filter(|_| !own_words);
    cycles.ok_or_else(|| format!("the control {name} has no drilling cycles of such words"))
}

fn cycle_word(rules: &mut Rules, value: &str, word: fn(&mut Cycles) -> &mut u8) -> Result<(), String> {
    let letter = number_address(rules, value)?;
    *word(cycles(rules)?) = letter;
    Ok(())
}

fn cycle_after(rules: &mut Rules, value: &str) -> Result<(), String> {
    let letter = number_address(rules, value)?;
    let cycles = cycles(rules)?;
    (cycles.after, cycles.returns_to_level) = (Some(letter), Some(true));
    Ok(())
}

fn cycle_dwell(rules: &mut Rules, value: &str) -> Result<(), String> {
    let (letter, unit) = timed(rules, value)?;
    let cycles = cycles(rules)?;
    (cycles.dwell_word, cycles.dwell) = (letter, unit);
    Ok(())
}

fn cycle_repeat(rules: &mut Rules, value: &str) -> Result<(), String> {
    let letter = if value == "none" { None } else { Some(address(rules, value)?) };
    cycles(rules)?.repeats = letter;
    Ok(())
}

fn cycle_return(rules: &mut Rules, value: &str) -> Result<(), String> {
    let table = [("said", None), ("level", Some(true)), ("initial", Some(false))];
    let to_level = choice(value, &table)?;
    cycles(rules)?.returns_to_level = to_level;
    Ok(())
}
