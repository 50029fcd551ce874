//! Who wrote a CL file.

use crate::geom::Vec3;

/// Systems whose CL text is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Producer {
    /// Siemens NX, CLSF.
    Nx,
    /// CATIA V4 and V5, APTSOURCE.
    Catia,
    /// Creo, `.ncl`.
    Creo,
    /// SolidWorks CAM and CAMWorks, `.apt`.
    SolidWorks,
    /// NCL and PTED, APT source.
    Ncl,
    /// Mastercam, `.nci`.
    Mastercam,
    /// Plain APT CL text, also our own.
    Plain,
}

/// Bytes at the start of a file that tell its producer.
const LOOK: usize = 256 * 1024;

/// What gives a producer away, at the start of a line; case-blind.
const SIGNS: &[(&str, Producer)] = &[
    ("TOOL PATH/", Producer::Nx),
    ("TLDATA/", Producer::Nx),
    ("END-OF-PATH", Producer::Nx),
    ("$$*CATIA", Producer::Catia),
    ("$$ CATIA APT", Producer::Catia),
    ("$$*", Producer::Creo),
    ("$$->", Producer::Creo),
    ("TRNTYP/", Producer::SolidWorks),
    ("CSI_SET", Producer::SolidWorks),
    ("CYCLE/INIT", Producer::SolidWorks),
    ("UNIT/", Producer::SolidWorks),
    ("$$ OPERATION NAME", Producer::Catia),
    ("AUTOPS", Producer::Catia),
    ("INDIRV/", Producer::Catia),
    ("TLON,GOFWD/", Producer::Catia),
    ("TPRINT/", Producer::Catia),
    ("HELICAL/", Producer::Catia),
    ("MOVARC/", Producer::Plain),
    ("CSI_TOOL_PATH", Producer::Plain),
];

impl Producer {
    /// All of them.
    pub const ALL: [Producer; 7] = [
        Producer::Nx,
        Producer::Catia,
        Producer::Creo,
        Producer::SolidWorks,
        Producer::Ncl,
        Producer::Mastercam,
        Producer::Plain,
    ];

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Producer::Nx => "nx",
            Producer::Catia => "catia",
            Producer::Creo => "creo",
            Producer::SolidWorks => "solidworks",
            Producer::Ncl => "ncl",
            Producer::Mastercam => "mastercam",
            Producer::Plain => "plain",
        }
    }

    /// What its files end with, where they always do.
    pub(super) fn end(self) -> Option<&'static str> {
        match self {
            Producer::Nx => Some("END-OF-PATH"),
            Producer::Mastercam => Some("1003"),
            Producer::Catia | Producer::Creo | Producer::SolidWorks | Producer::Ncl => Some("FINI"),
            Producer::Plain => None,
        }
    }

    /// Whether an arc may be followed by several points on it.
    pub(super) fn many_points(self) -> bool {
        matches!(self, Producer::Creo | Producer::Ncl)
    }

    /// Whether `INSERT` holds a text for people and not a block.
    pub(super) fn inserts_are_comments(self) -> bool {
        self == Producer::SolidWorks
    }
}

/// By extension, then by the signs of the first lines; a program of the language has neither.
pub(super) fn recognise(name: &str, text: &str) -> Option<Producer> {
    let extension = name.rsplit_once('.').map(|(_, e)| e.to_ascii_lowercase()).unwrap_or_default();
    let by_signs = || signs(text);
    match extension.as_str() {
        "cls" | "clsf" => Some(by_signs().unwrap_or(Producer::Nx)),
        "nci" => Some(Producer::Mastercam),
        "ncl" => Some(by_signs().unwrap_or(Producer::Creo)),
        "as" => Some(by_signs().unwrap_or(Producer::Ncl)),
        "aptsource" | "catnc" => Some(by_signs().unwrap_or(Producer::Catia)),
        "cl" => {
            Some(by_signs().or_else(|| prefixed(text)).or_else(|| round(text)).unwrap_or(Producer::Plain))
        }
        _ => by_signs()
            .or_else(|| prefixed(text))
            .or_else(|| round(text))
            .or_else(|| modes(text))
            .or_else(|| bare(text)),
    }
}

fn head(text: &str) -> &str {
    let mut end = text.len().min(LOOK);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    &text[..end]
}

fn signs(text: &str) -> Option<Producer> {
    head(text)
        .lines()
        .map(str::trim_start)
        .find_map(|line| SIGNS.iter().find(|(sign, _)| starts(line, sign)).map(|(_, producer)| *producer))
}

fn starts(line: &str, sign: &str) -> bool {
    line.get(..sign.len()).is_some_and(|l| l.eq_ignore_ascii_case(sign))
}

/// `MODE/ MILL`, which no program of the language has.
fn modes(text: &str) -> Option<Producer> {
    let mode = |line: &str| starts(line, "MODE/MILL") || starts(line, "MODE/ MILL");
    head(text).lines().map(str::trim_start).any(mode).then_some(Producer::Plain)
}

/// Points of an arc in a row that tell that all of them stand behind `CIRCLE/`.
const IN_A_ROW: usize = 3;
/// How far they may be off the circle, in radii.
const OFF_CIRCLE: f64 = 1e-3;
/// How far apart they are at most, in radii: about 40 degrees.
const APART: f64 = 0.7;

/// `CIRCLE/` with all points of the arc behind it, as NCL writes it without numbers before its records. Lines between points
/// so close to each other on one circle are not meant.
fn round(text: &str) -> Option<Producer> {
    let (mut circle, mut last, mut points) = (None, None, 0);
    let mut lines = head(text).lines().map(str::trim);
    while let Some(line) = lines.next() {
        if let Some(numbers) = numbers_behind(line, "CIRCLE/", &mut lines) {
            let numbers: Option<[f64; 7]> = numbers.try_into().ok();
            circle = numbers.map(|[x, y, z, i, j, k, r]| (Vec3::new(x, y, z), Vec3::new(i, j, k), r));
            (last, points) = (None, 0);
        } else if let (Some((centre, axis, radius)), Some(numbers)) =
            (circle, numbers_behind(line, "GOTO/", &mut lines))
        {
            let [x, y, z, ..] = *numbers.as_slice() else { return None };
            let point = Vec3::new(x, y, z);
            let from = point - centre;
            let off = ((from - axis * from.dot(&axis)).norm() - radius).abs();
            let close = last.is_none_or(|last: Vec3| (point - last).norm() <= APART * radius);
            if off > OFF_CIRCLE * radius || !close {
                circle = None;
            }
            (last, points) = (Some(point), points + 1);
            if circle.is_some() && points >= IN_A_ROW {
                return Some(Producer::Ncl);
            }
        } else if !line.is_empty() && !line.starts_with("$$") {
            circle = None;
        }
    }
    None
}

/// The numbers of a record of this word, which may go on in further lines.
fn numbers_behind<'t>(line: &str, word: &str, more: &mut impl Iterator<Item = &'t str>) -> Option<Vec<f64>> {
    let mut text = line.replace([' ', '\t'], "");
    if !starts(&text, word) {
        return None;
    }
    while let Some(begun) = text.strip_suffix(['$', '~']) {
        text = begun.to_owned() + &more.next()?.replace([' ', '\t'], "");
    }
    text.get(word.len()..)?.split(',').map(super::scan::number).collect()
}

/// A tool by its number and points in figures where nothing is defined: a program of the language has no such tool.
fn bare(text: &str) -> Option<Producer> {
    let (mut tool, mut point) = (false, false);
    for line in head(text).lines().map(str::trim_start).filter(|line| !line.starts_with("$$")) {
        if RAW.iter().any(|word| starts(line, word)) {
            continue;
        }
        if line.contains('=') || starts(line, "INCLUD") {
            return None;
        }
        tool |= TOOLS.iter().any(|word| figure_behind(line, word));
        point |= figure_behind(line, "GOTO/");
    }
    (tool && point).then_some(Producer::Plain)
}

/// Words whose text may hold anything.
const RAW: &[&str] = &["PARTNO", "PPRINT", "INSERT", "REMARK"];
/// Words of a tool change.
const TOOLS: &[&str] = &["LOADTL/", "LOAD/TOOL,", "TOOLNO/"];

/// Whether the line is `word` and a number, blanks aside.
fn figure_behind(line: &str, word: &str) -> bool {
    let mut rest = line.chars().filter(|c| !c.is_whitespace());
    word.chars().all(|w| rest.next().is_some_and(|c| c.eq_ignore_ascii_case(&w)))
        && rest.next().is_some_and(|c| c.is_ascii_digit() || "+-.".contains(c))
}

/// Records with the number of the input line before them, `N12 , GOTO/ …`.
fn prefixed(text: &str) -> Option<Producer> {
    let prefixed = |line: &&str| {
        let rest = line.trim_start().strip_prefix(['N', 'n']);
        rest.is_some_and(|r| {
            let after = r.trim_start_matches(|c: char| c.is_ascii_digit());
            after.len() < r.len() && after.trim_start().starts_with(',')
        })
    };
    head(text).lines().take(200).find(prefixed).map(|_| Producer::Ncl)
}
