//! Pictures: cam, path and diagrams as SVG and PNG, and pages that show them in space.
//!
//! A [`Figure`] is an SVG text: white background, fixed decimals, no script, no file or font of the machine, so the
//! same program gives the same bytes everywhere. [`draw`] makes one from a compiled program; [`cam`], [`path`] and
//! [`deviation`] draw what they are given.

mod blocks;
mod cam;
mod canvas;
mod chart;
mod deviation;
mod diagrams;
mod follower;
mod page;
mod path;
mod png;
mod solid;
#[cfg(test)]
mod tests;
mod theme;
mod views;
mod world;

pub use cam::{CamView, Track, cam};
pub use deviation::{DeviationView, PieceDeviation, deviation};
pub use path::{PathView, path};
pub use solid::{draw_output, page};
pub use views::{What, draw};

/// A picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    svg: String,
}

impl Figure {
    /// The picture as an SVG document.
    #[must_use]
    pub fn svg(&self) -> &str {
        &self.svg
    }
    /// The picture as a PNG file, `scale` pixels for every unit of the SVG (0.1 to 8).
    ///
    /// # Errors
    /// [`PlotError::Render`] when it cannot be drawn.
    pub fn png(&self, scale: f32) -> Result<Vec<u8>, PlotError> {
        png::render(&self.svg, scale.clamp(0.1, 8.0))
    }
}

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PlotError {
    /// The program has no cam.
    NoCam,
    /// The program has no cam of this name; those it has.
    UnknownCam {
        /// The name asked for.
        name: String,
        /// Names of its cams.
        have: Vec<String>,
    },
    /// Nothing is cut.
    NoPath,
    /// No contour is cut along an exact curve, or nothing has been lowered.
    NoContour,
    /// No surface is finished.
    NoSurface,
    /// This picture is a drawing, not a page.
    FlatOnly,
    /// The drawing program failed.
    Render(String),
}

impl core::fmt::Display for PlotError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            PlotError::NoCam => f.write_str("the program has no cam to draw"),
            PlotError::UnknownCam { name, have } => {
                write!(f, "the program has no cam {name}; it has {}", have.join(", "))
            }
            PlotError::NoPath => f.write_str("the program moves no cutter"),
            PlotError::NoContour => f.write_str("the program cuts no contour whose deviation could be drawn"),
            PlotError::NoSurface => {
                f.write_str("the program finishes no surface: there is no deviation to show in space")
            }
            PlotError::FlatOnly => f.write_str(
                "the picture of a cam is a .svg or a .png; its path and blank are in `--what path`",
            ),
            PlotError::Render(reason) => write!(f, "the picture cannot be rendered: {reason}"),
        }
    }
}

impl core::error::Error for PlotError {}
