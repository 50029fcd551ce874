//! Files of CAD systems: surfaces out of STEP and IGES files, nets into STEP and STL files.
//!
//! A file is indexed once, in one pass that keeps only where its records lie; what a surface is made of is read when it is
//! asked for. No recursion depends on the file: nesting, chains of references and sizes are bounded. Coordinates are
//! turned into mm here. A surface is taken whole: where a face uses less of it, a [`Notice`] says so.

use std::sync::Arc;

use crate::geom::surface::net::uneven;
use crate::geom::surface::{Net, NetIssue, SplineIssue, SplineSurface};

mod bounds;
pub mod iges;
pub mod step;
pub mod stl;

/// Faces that one message lists.
const LISTED: usize = 12;

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// ISO 10303-21.
    Step,
    /// IGES, in the fixed format.
    Iges,
}

impl Format {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Format::Step => "STEP",
            Format::Iges => "IGES",
        }
    }
}

/// Why there is no net.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Trouble {
    /// What kind of trouble it is.
    pub kind: TroubleKind,
    /// The line of the file, from 1, where one can be named.
    pub line: Option<usize>,
    /// One sentence.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

/// Kinds of trouble.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TroubleKind {
    /// The file is not what it should be, or is broken.
    File,
    /// There is no such face, or it does not lie on a B-spline surface, or none is named.
    Face,
    /// The surface cannot be a net.
    Surface,
}

impl Trouble {
    fn new(kind: TroubleKind, message: impl Into<String>) -> Trouble {
        Trouble { kind, line: None, message: message.into(), help: None }
    }
    fn file(line: usize, message: impl Into<String>) -> Trouble {
        Trouble { line: Some(line), ..Trouble::new(TroubleKind::File, message) }
    }
    fn help(self, help: impl Into<String>) -> Trouble {
        Trouble { help: Some(help.into()), ..self }
    }
}

/// What a user should know of a net that came out of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Notice {
    /// The face does not reach the edges of its surface everywhere.
    Trimmed,
    /// Whether the face reaches them cannot be told.
    EdgesUnknown,
    /// The file names no unit of length; mm were taken.
    NoUnit,
    /// The file places parts in assemblies; the surface lies where its own part has it.
    Placed,
}

/// A net out of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Import {
    /// The whole surface of the face, mm.
    pub net: Net,
    /// Which face it is, from 1.
    pub face: usize,
    /// What to know about it.
    pub notices: Vec<Notice>,
}

/// A face (or a surface without faces) as it stands in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Face {
    /// Name of its surface's type in the format.
    kind: String,
    /// Whether that is a B-spline surface.
    is_spline: bool,
}

/// A file that has been indexed.
#[derive(Debug)]
pub enum Document {
    /// A STEP file.
    Step(step::Exchange),
    /// An IGES file.
    Iges(iges::Drawing),
}

impl Document {
    /// Indexes the text of a file.
    ///
    /// # Errors
    /// [`Trouble`] of kind [`TroubleKind::File`].
    pub fn open(format: Format, text: &Arc<str>) -> Result<Document, Trouble> {
        match format {
            Format::Step => step::Exchange::open(text.clone()).map(Document::Step),
            Format::Iges => iges::Drawing::open(text.clone()).map(Document::Iges),
        }
    }

    /// The net of face `face` (from 1, in the order of the file), or of the only one that lies on a B-spline surface.
    /// Where a file has no faces, its B-spline surfaces count.
    ///
    /// # Errors
    /// [`Trouble`].
    pub fn net(&self, face: Option<usize>) -> Result<Import, Trouble> {
        match self {
            Document::Step(file) => step::net(file, face),
            Document::Iges(file) => iges::net(file, face),
        }
    }
}

/// The index of the face that is meant.
fn choose(faces: &[Face], what: &str, wanted: Option<usize>) -> Result<usize, Trouble> {
    let fail = |message: String| Trouble::new(TroubleKind::Face, message);
    let splines: Vec<usize> = (0..faces.len()).filter(|&i| faces[i].is_spline).map(|i| i + 1).collect();
    let which = match splines.as_slice() {
        [] => "none of its faces lies on a B-spline surface".to_owned(),
        [only] => format!("{what} {only} lies on one"),
        more => format!("{what}s {} lie on one", listed(more)),
    };
    match (wanted, splines.as_slice()) {
        (_, []) if faces.is_empty() => Err(fail("the file has neither faces nor B-spline surfaces".into())),
        (_, []) => {
            let message =
                format!("the file has no B-spline surface: its {} {what}s lie on others", faces.len());
            Err(fail(message)
                .help("planes, cylinders and the like are no nets; export the face as a B-spline surface"))
        }
        (None, [only]) => Ok(only - 1),
        (None, more) => {
            let message = format!("{} {what}s of the file lie on B-spline surfaces; which one?", more.len());
            Err(fail(message).help(format!("write `FACE, n`: {which}")))
        }
        (Some(n), _) => match n.checked_sub(1).and_then(|i| faces.get(i)) {
            None => {
                let message = format!("there is no {what} {n}: the file has {} {what}s", faces.len());
                Err(fail(message).help(which))
            }
            Some(face) if !face.is_spline => {
                let message = format!("{what} {n} lies on a {}, which is no B-spline surface", face.kind);
                Err(fail(message).help(which))
            }
            Some(_) => Ok(n - 1),
        },
    }
}

/// «3, 5 to 9 and 12».
fn listed(numbers: &[usize]) -> String {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for &n in numbers {
        match runs.last_mut() {
            Some(run) if run.1 + 1 == n => run.1 = n,
            _ => runs.push((n, n)),
        }
    }
    let more = runs.len() > LISTED;
    let mut parts: Vec<String> = Vec::new();
    for (from, to) in runs.into_iter().take(LISTED) {
        if to - from > 1 {
            parts.push(format!("{from} to {to}"));
        } else {
            parts.extend((from..=to).map(|n| n.to_string()));
        }
    }
    if more {
        return format!("{} and more", parts.join(", "));
    }
    match parts.as_slice() {
        [rest @ .., last] if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => parts.concat(),
    }
}

/// The net of a surface, or why there is none.
fn net_of(surface: &SplineSurface, line: usize) -> Result<Net, Trouble> {
    surface.net().map_err(|issue| {
        let at = |axis: usize| if axis == 0 { "u" } else { "v" };
        let message = match issue {
            SplineIssue::Degree { axis, degree } => {
                format!("the surface has degree {degree} in {}; a net has 1 to 15", at(axis))
            }
            SplineIssue::Counts { axis, wanted, given } => {
                format!("the surface has {given} knots in {}, and its poles want {wanted}", at(axis))
            }
            SplineIssue::Knots { axis } => {
                format!("the surface's knots in {} do not rise, or one is no number", at(axis))
            }
            SplineIssue::Broken { axis, knot } => {
                format!(
                    "the surface comes apart at {} = {knot}: the knot is repeated more often than the degree",
                    at(axis)
                )
            }
            SplineIssue::TooLarge { poles } => format!(
                "the surface has {poles} Bezier poles; a net has at most {}",
                crate::geom::surface::spline::LARGEST_NET
            ),
            SplineIssue::Net(NetIssue::NotFinite) => {
                "a pole or weight of the surface is not a finite number, or a weight is not positive".into()
            }
            SplineIssue::Net(NetIssue::Uneven { least, most }) => uneven(least, most),
            SplineIssue::Net(NetIssue::Count { wanted, given }) => {
                format!("the surface wants {wanted} poles, each with its weight, and has {given}")
            }
            SplineIssue::Net(NetIssue::Size { rows, columns }) => {
                format!("{rows} x {columns} poles are no net")
            }
        };
        Trouble { line: Some(line), ..Trouble::new(TroubleKind::Surface, message) }
    })
}

#[cfg(test)]
mod export_tests;
#[cfg(test)]
mod iges_tests;
#[cfg(test)]
mod tests;
