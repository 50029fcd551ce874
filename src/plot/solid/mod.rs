//! Pictures of what happens in space: the read-back moves over the surfaces they finish.

use super::{Figure, PlotError, What};
use crate::driver::{Build, Output};

mod camera;
pub(super) mod colour;
pub(super) mod cutter;
mod deviation;
pub(super) mod marks;
pub(super) mod mesh;
mod path;
mod raster;
pub(super) mod scene;
mod sheet;

/// Draws an output of a build: in space where it finishes surfaces or moves in space, otherwise as [`super::draw`] does.
///
/// # Errors
/// [`PlotError`] when there is nothing of the kind.
pub fn draw_output(what: &What, build: &Build, output: Option<&Output>) -> Result<Figure, PlotError> {
    if let Some(figure) = in_space(what, build, output) {
        return figure;
    }
    let target = output.and_then(|o| o.target.as_ref());
    let program = build.ir.as_ref().ok_or(PlotError::NoPath)?;
    super::draw(what, program, build.cl.as_ref(), target)
}

/// The figure of what a plan view alone does not show: a CL file, moves up and down on the way, surfaces.
fn in_space(what: &What, build: &Build, output: Option<&Output>) -> Option<Result<Figure, PlotError>> {
    if matches!(what, What::Cam(_)) {
        return None;
    }
    let scene = match scene::Scene::new(build.ir.as_ref(), build.cl.as_ref(), output?) {
        Ok(scene) => scene,
        Err(error) => return build.ir.is_none().then_some(Err(error)),
    };
    if build.ir.is_some() && !scene.is_solid() {
        return None;
    }
    match what {
        What::Deviation if scene.finished().next().is_some() => Some(deviation::deviation(&scene)),
        What::Deviation if build.ir.is_none() => Some(Err(PlotError::NoSurface)),
        What::Cam(_) | What::Deviation => None,
        What::Path => Some(Ok(path::path(&scene))),
    }
}

/// One HTML page of an output: its path in space, with what is left on the surfaces when [`What::Deviation`] is asked for.
///
/// # Errors
/// [`PlotError`] when there is nothing of the kind.
pub fn page(what: &What, build: &Build, output: Option<&Output>) -> Result<String, PlotError> {
    let measured = match what {
        What::Cam(_) => return Err(PlotError::FlatOnly),
        What::Path => false,
        What::Deviation => true,
    };
    let output = output.ok_or(PlotError::NoPath)?;
    let scene = scene::Scene::new(build.ir.as_ref(), build.cl.as_ref(), output)?;
    super::page::page(&scene, measured)
}

#[cfg(test)]
mod tests;
