//! Post words that the reader does not carry out.

/// What a word does to the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    /// Nothing that a program must say: drawing, listing, hints, data for a magazine.
    Harmless,
    /// Something that cannot be left out.
    Matters(&'static str),
}

const HARMLESS: &[&str] = &[
    "PAINT",
    "CLPRNT",
    "NOPOST",
    "PRINT",
    "PUNCH",
    "MACHIN",
    "SEQNO",
    "SELECT",
    "SELCTL",
    "SETUP",
    "CHECK",
    "CLEARP",
    "CLRSRF",
    "MCHTOL",
    "MCHFIN",
    "MAXVEL",
    "MAXDPM",
    "LINTOL",
    "ARCSLP",
    "REGBRK",
    "INTCOD",
    "DISPLY",
    "REWIND",
    "SEQUNC",
    "AUTOPS",
    "NOPS",
    "TLOFPS",
    "TLONPS",
    "CONTUR",
    "REFSYS",
    "NUMPTS",
    "MAXDP",
    "THICK",
    "DNTCUT",
    "CUT",
    "2DCALC",
    "3DCALC",
    "NDTEST",
    "STOCK",
    "FIXTUR",
    "VIEW",
    "CAMERA",
    "COLOR",
    "LINTYP",
    "LAYER",
    "PROGRAM",
    "DATE",
    "TIME",
    "MFGNO",
    "FEATNO",
    "END-OF-PATH-DATA",
    "OPTYPE",
    "RANGE",
    "MODSYS",
    "LOADPT",
    "HEADER",
    "LIBRY",
    "TMARK",
    "PLABEL",
    "PLOT",
    "VERIFY",
    "START",
    "OPERATION",
    "MCS2",
    "CSI_TOOL_PATH",
    "CSI_PATH_TOLERANCE",
];

const MATTERS: &[(&str, &str)] = &[
    ("ZERO", "it chooses a work offset"),
    ("ORIGIN", "it moves the program's origin"),
    ("TRANS", "it shifts the coordinates"),
    ("TRACUT", "it transforms the path"),
    ("COPY", "it repeats the path"),
    ("INDEX", "it repeats the path"),
    ("ROTABL", "it turns a table"),
    ("ROTHED", "it turns the head"),
    ("ROTATE", "it turns an axis"),
    ("HEAD", "it chooses a head"),
    ("MODE", "it changes how the control reads the program"),
    ("SET", "it changes how the control reads the program"),
    ("COUPLE", "it couples spindle and feed"),
    ("THREAD", "it cuts a thread"),
    ("PITCH", "it sets a thread's pitch"),
    ("PREFUN", "it is a G code of one control"),
    ("AUXFUN", "it is an M code of one machine"),
    ("OPSKIP", "it makes blocks optional"),
    ("POSTN", "it sets the control's position"),
    ("CLAMP", "it clamps or frees something"),
    ("SLOWDN", "it changes the feed in corners"),
    ("RETRCT", "it retracts to a plane that the file does not give"),
    ("SWITCH", "it does what the machine's builder says"),
    ("DRESS", "it dresses a wheel"),
    ("PICKUP", "it picks something up"),
    ("UNLOAD", "it unloads the tool"),
    ("LOCKX", "it locks an axis"),
    ("RESET", "it resets the control"),
    ("TURRET", "it turns a turret"),
    ("CORNFD", "it changes the feed in corners"),
    ("PIVOTZ", "it sets a pivot length"),
    ("PROBE", "it probes"),
    ("SAFETY", "it moves to a safe place that the file does not give"),
    ("AIR", "it switches an air blast"),
    ("LINEAR", "it changes the interpolation"),
    ("CIRCUL", "it changes the interpolation"),
    ("POLYAX", "it changes the interpolation"),
    ("GOFWD", "it follows surfaces that are not there"),
    ("GOLFT", "it follows surfaces that are not there"),
    ("GORGT", "it follows surfaces that are not there"),
    ("GOBACK", "it follows surfaces that are not there"),
    ("GOUP", "it follows surfaces that are not there"),
    ("GODOWN", "it follows surfaces that are not there"),
];

/// Those of them without which what follows is cut in another place.
pub(super) const PLACES: &[&str] =
    &["ZERO", "ORIGIN", "TRANS", "TRACUT", "COPY", "INDEX", "ROTABL", "ROTHED", "ROTATE", "POSTN"];

/// The class of a word; `None`: nobody knows it.
pub(super) fn class(word: &str) -> Option<Class> {
    if HARMLESS.contains(&word) || word.starts_with("CSI_SET") {
        return Some(Class::Harmless);
    }
    MATTERS.iter().find(|(w, _)| *w == word).map(|(_, why)| Class::Matters(why))
}

/// Whether a word asks for what is so anyway, because nothing else has been carried out: absolute coordinates, or
/// that something ends which never began.
pub(super) fn already_so(word: &str, args: &[&str]) -> bool {
    const ENDED: &[&str] =
        &["OPSKIP", "SLOWDN", "CORNFD", "COUPLE", "POLYAX", "AIR", "TRACUT", "COPY", "INDEX", "PROBE"];
    match word {
        "MODE" if args == ["MILL"] => true,
        "MODE" | "SET" => {
            matches!(args, ["MODE", "ABSOL"] | ["ABSOL"] | ["INCR", "OFF"] | ["MODE", "INCR", "OFF"])
        }
        _ => ENDED.contains(&word) && matches!(args, ["OFF" | "NOMORE"]),
    }
}

/// The minor words that are understood, by major word.
#[cfg(test)]
pub(super) fn minor_words() -> Vec<(&'static str, Vec<&'static str>)> {
    use super::{cycle, process, tool};
    let feeds = process::PER_MINUTE.iter().chain(process::PER_REVOLUTION).map(|(w, _)| *w);
    let cycles = [
        cycle::DEPTH,
        cycle::CLEARANCE,
        cycle::RETURN,
        cycle::PECK,
        cycle::FIRST_PECK,
        cycle::NEXT_PECKS,
        cycle::FEEDS,
        cycle::SILENT,
        cycle::OTHER,
        cycle::FINER,
    ];
    let kinds = cycle::KINDS.iter().flat_map(|(words, _)| *words);
    vec![
        ("FEDRAT", feeds.chain(process::FEED_SILENT.iter().copied()).chain(["RAPID"]).collect()),
        ("SPINDL", process::SPEED_WORDS.iter().chain(process::SPINDLE_OFF).copied().collect()),
        ("COOLNT", process::COOLANTS.iter().map(|(w, _)| *w).collect()),
        (
            "CUTCOM",
            process::COMPENSATION
                .0
                .iter()
                .chain(process::COMPENSATION.1)
                .chain(process::OF_COMPENSATION)
                .copied()
                .collect(),
        ),
        ("LOADTL", tool::OFFSETS.to_vec()),
        ("CYCLE", cycles.into_iter().flatten().chain(kinds).copied().collect()),
    ]
}

/// Words that the reader carries out, for "did you mean".
pub(super) const CARRIED_OUT: &[&str] = &[
    "GOTO",
    "GODLTA",
    "FROM",
    "GOHOME",
    "RAPID",
    "FEDRAT",
    "SPINDL",
    "COOLNT",
    "CYCLE",
    "CIRCLE",
    "MOVARC",
    "CUTTER",
    "TLDATA",
    "LOADTL",
    "LOAD",
    "TOOLNO",
    "DELAY",
    "DWELL",
    "STOP",
    "OPSTOP",
    "END",
    "FINI",
    "UNITS",
    "UNIT",
    "INTOL",
    "OUTTOL",
    "TOLER",
    "MULTAX",
    "TLAXIS",
    "CUTCOM",
    "MSYS",
    "CSYS",
    "TRNTYP",
    "NURBS",
    "KNOT",
    "CNTRL",
    "INDIRV",
    "PSIS",
    "TLON",
    "HELICAL",
    "END-OF-PATH",
    "PARTNO",
    "PPRINT",
    "TPRINT",
    "INSERT",
    "REMARK",
];
