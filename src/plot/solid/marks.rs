//! Extremes of a surface's proof, to be marked.

use super::scene::Scene;
use crate::geom::Point3;
use crate::verify::Deviation;

/// A place worth looking at.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::plot) struct Mark {
    /// `A`, `B` …
    pub(in crate::plot) letter: char,
    pub(in crate::plot) name: &'static str,
    /// mm.
    pub(in crate::plot) value: f64,
    pub(in crate::plot) at: Point3,
    /// Line of the text.
    pub(in crate::plot) line: u32,
}

/// The extremes that were proven of an operation, those that are nothing left out.
pub(in crate::plot) fn marks(scene: &Scene<'_>, operation: usize) -> Vec<Mark> {
    let Some(proof) = scene.certificate.operations.get(operation).and_then(|o| o.surface.as_ref()) else {
        return Vec::new();
    };
    let all: [(&'static str, Option<&Deviation>); 5] = [
        ("highest cusp", proof.cusp.as_ref()),
        ("most left, cusp and deviation together", Some(&proof.left)),
        ("pass farthest off the surface", Some(&proof.out)),
        ("deepest into the part", Some(&proof.into)),
        ("most left where the cutter does not fit", proof.unreachable.as_ref()),
    ];
    // Below the certified accuracy there is nothing to show.
    let found = all.into_iter().filter_map(|(name, d)| Some((name, d?)));
    let found = found.filter(|(_, d)| d.value > crate::verify::ACCURACY && d.line > 0);
    // Some are told with the cutter's centre.
    let surface = scene.cl.operations.get(operation).and_then(|o| o.guard.surface.as_ref());
    let on_surface = |p: Point3| surface.map_or(p, |f| f.tree.nearest(p, None).point);
    found
        .zip('A'..)
        .map(|((name, d), letter)| {
            let at = on_surface(Point3::new(d.x, d.y, d.z));
            Mark { letter, name, value: d.value, at, line: d.line }
        })
        .collect()
}
