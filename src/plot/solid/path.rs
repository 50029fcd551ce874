//! The path over the surfaces it finishes, from above and from the side.

use super::mesh::{Mesh, meshes};
use super::scene::Scene;
use super::sheet::{self, Sheet};
use crate::plot::Figure;

/// Places of a surface, over all its patches; the light on it needs no more.
const PLACES: usize = 12_000;
/// Steps of grey.
const GREYS: f64 = 40.0;

/// Draws the path of a scene.
pub(super) fn path(scene: &Scene<'_>) -> Figure {
    let meshes = meshes(scene, PLACES, false);
    let shown = last_of_each(scene, &meshes);
    let mut sheet = Sheet::new(scene, &shown);
    sheet.subtitle(&sheet::summary(scene));
    sheet.views(|canvas, panel| {
        panel.raster.draw(canvas, |_, light| {
            let grey = 118.0 + 127.0 * (light * GREYS).round() / GREYS;
            [0.9 * grey, 0.96 * grey, 1.02 * grey].map(|c| c.min(255.0).round() as u8)
        });
        sheet::edges(canvas, panel, &shown);
        sheet::blanks(canvas, panel, scene);
        sheet::paths(canvas, panel, scene);
    });
    sheet.compass();
    let end = sheet::table(&mut sheet);
    sheet.finish(end + 34.0)
}

/// Of surfaces that several operations finish, the last one's.
fn last_of_each<'m>(scene: &Scene<'_>, meshes: &'m [Mesh]) -> Vec<&'m Mesh> {
    let net = |m: &Mesh| {
        let operation = scene.cl.operations.get(m.operation);
        operation.and_then(|o| o.guard.surface.as_ref()).map(|f| f.tree.net())
    };
    let again = |k: usize| meshes.iter().skip(k + 1).any(|later| net(later) == meshes.get(k).and_then(net));
    meshes.iter().enumerate().filter(|(k, _)| !again(*k)).map(|(_, m)| m).collect()
}
