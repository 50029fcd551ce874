//! Frame and structure of a program.

use super::{
    Form, Group, Item, Kind, Range, Statement, Usage, choices, form, optional, slot, value, with, word,
};
use crate::units::Dim;

/// Words of the structure that are no major words of their own.
pub const STRUCTURE_WORDS: [&str; 9] = ["AND", "OR", "NOT", "ALL", "THRU", "INCR", "DECR", "INVERS", "CANON"];

const fn row(
    group: Group,
    usage: Usage,
    word: &'static str,
    help: &'static str,
    example: &'static str,
) -> Statement {
    Statement { word, aliases: &[], group, usage, help, example, forms: &[], members: &[] }
}

const fn text(word: &'static str, help: &'static str, example: &'static str) -> Statement {
    row(Group::Program, Usage::Text, word, help, example)
}

const fn structure(word: &'static str, help: &'static str, example: &'static str) -> Statement {
    row(Group::Structure, Usage::Structure, word, help, example)
}

const fn ignored(word: &'static str, help: &'static str) -> Statement {
    row(Group::Program, Usage::Ignored, word, help, "")
}

const UNITS: &[Form] = &[form(
    "units",
    "unit of bare lengths",
    &[Item::Word("unit", &[word("MM", "millimetres"), word("INCH", "inches"), word("INCHES", "inches")])],
    &[],
)];

const MACHIN: &[Form] = &[form(
    "machine",
    "target of the build",
    &[value("post", Kind::Name, "name of the post")],
    &[
        with(
            "rotary",
            &[word("ROTABL", "rotary axis for R-theta output")],
            &[optional("letter", Kind::Name, "axis letter")],
            false,
            "the post's own",
        ),
        choices("sense", &[word("REVERS", "the rotary table turns against ISO 841")], "as ISO 841"),
    ],
)];

const PARAM: &[Form] = &[form(
    "parameter",
    "typed input",
    &[value("default", Kind::Binding, "name and default; the default gives the dimension")],
    &[
        with("min", &[word("MIN", "smallest value")], &[value("min", Kind::Any, "limit")], false, "no limit"),
        with("max", &[word("MAX", "largest value")], &[value("max", Kind::Any, "limit")], false, "no limit"),
        with("text", &[], &[value("text", Kind::Text, "what it is")], false, "no text"),
    ],
)];

const INCLUD: &[Form] = &[form(
    "include",
    "another source file",
    &[value("file", Kind::Text, "path, relative to this file")],
    &[],
)];

const RESERV: &[Form] = &[form(
    "reserve",
    "subscripted names",
    &[Item::Repeat(slot("name and size", Kind::Name, "name, then its largest subscript, in pairs"), 2, 200)],
    &[],
)];

/// Rows of the table.
pub const ROWS: &[Statement] = &[
    text("PARTNO", "title of the program", "PARTNO PLATE CAM 4711"),
    Statement {
        forms: UNITS,
        ..row(
            Group::Program,
            Usage::Command,
            "UNITS",
            "unit of bare lengths in the whole program; before the first of them; millimetres without it",
            "UNITS/ MM",
        )
    },
    Statement {
        forms: MACHIN,
        ..row(
            Group::Program,
            Usage::Command,
            "MACHIN",
            "target of the build when the command line names none; several give several outputs",
            "MACHIN/ LINUXCNC, ROTABL, C",
        )
    },
    text("REMARK", "comment that is kept in listings", "REMARK FIRST SIDE"),
    text("PPRINT", "comment in the NC program", "PPRINT CHECK THE CLAMPS"),
    text("INSERT", "block copied into the NC program as it stands", "INSERT M60"),
    text("TITLES", "heading of a listing; kept as a comment of the source", "TITLES REVISION B"),
    Statement {
        forms: PARAM,
        ..row(
            Group::Program,
            Usage::Command,
            "PARAM",
            "typed input of the program; `-D NAME=VALUE` on the command line overrides it",
            "PARAM/ STROKE = 20mm, MIN, 5mm, MAX, 40mm, 'lift of the follower'",
        )
    },
    Statement {
        forms: INCLUD,
        ..row(
            Group::Program,
            Usage::Command,
            "INCLUD",
            "reads another source file at this place; each file once",
            "INCLUD/ 'library.apt'",
        )
    },
    row(Group::Program, Usage::Command, "FINI", "end of the program", "FINI"),
    ignored("NOPOST", "no post-processing; the build decides"),
    ignored("CLPRNT", "prints CL data; use `--emit cl`"),
    ignored("PRINT", "prints definitions; use `--emit ir`"),
    ignored("PUNCH", "punches definitions; use `--emit ir`"),
    ignored("NOPLOT", "no plot; use the `plot` command"),
    ignored("DISPLY", "shows geometry; use the `plot` command"),
    ignored("NUMPTS", "limit of points in one motion; paths have no such limit here"),
    ignored("MAXDP", "largest step of the motion solver; curves are exact here"),
    ignored("SYN", "abbreviations; words are written out here"),
    ignored("SEQNO", "sequence numbers; the post decides"),
    ignored("LEADER", "blank tape"),
    ignored("REWIND", "tape rewind"),
    ignored("MCHTOL", "tolerance of the post; the certificate covers the emitted text"),
    ignored("2DCALC", "chooses a solver"),
    ignored("3DCALC", "chooses a solver"),
    ignored("AUTOPS", "part surface through the cutter's end"),
    ignored("NOPS", "no part surface"),
    ignored("PSIS", "part surface of APT motion; points stand where they are given"),
    structure(
        "IF",
        "carries out what follows when the condition holds",
        "IF/ N > 3\nELSEIF/ N == 3\nELSE\nENDIF",
    ),
    structure("ELSEIF", "other condition of an `IF`", "ELSEIF/ N == 3"),
    structure("ELSE", "what to do when no condition held", "ELSE"),
    structure("ENDIF", "end of `IF`", "ENDIF"),
    structure("DO", "counts a variable from, to[, step], ends included", "DO/ I = 1, 10\nENDDO"),
    structure("ENDDO", "end of `DO`", "ENDDO"),
    structure("WHILE", "repeats as long as the condition holds", "WHILE/ R < 40\nENDWHILE"),
    structure("ENDWHILE", "end of `WHILE`", "ENDWHILE"),
    structure("UNTIL", "repeats as long as the condition does not hold", "UNTIL/ R >= 40\nENDUNTIL"),
    structure("ENDUNTIL", "end of `UNTIL`", "ENDUNTIL"),
    structure(
        "MACRO",
        "statements to be called by name; parameters may have defaults",
        "HOLE = MACRO/ AT, D = 3mm\nTERMAC",
    ),
    structure("TERMAC", "end of `MACRO`", "TERMAC"),
    structure(
        "CALL",
        "carries out a macro; arguments by name or by place, a word included",
        "CALL/ HOLE, AT = P1, D = 5mm",
    ),
    structure(
        "LOOPST",
        "start of a stretch with jump labels",
        "LOOPST\nA1) N = N + 1\nIF (N - 5) A1, A2, A2\nA2) LOOPND",
    ),
    structure("LOOPND", "end of `LOOPST`", "LOOPND"),
    structure("JUMPTO", "goes on at a label of the same loop or macro", "JUMPTO/ A1"),
    Statement {
        forms: RESERV,
        ..row(
            Group::Structure,
            Usage::Command,
            "RESERV",
            "makes names subscripted, with their largest subscript",
            "RESERV/ P, 6, A, 10",
        )
    },
];

/// A spindle speed above zero.
pub(super) const SPEED: Kind = Kind::Number(Dim::SPEED, Range::Positive);
