//! What of a surface no path of the cutter reaches.
//!
//! Where more is left than may be, since the cutter is too wide, it is found out whether it would take that wherever it is let
//! down ([`Reacher`]), in the middle of small cells.

use rayon::prelude::*;

use super::capsule::Corner;
use super::field::TILES;
use crate::cl::Finish;
use crate::geom::surface::Patch;
use crate::geom::surface::cutter::reach::{Reach, Reacher};

/// Areas where more is left than may be, mm².
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Areas {
    /// Where the cutter leaves that, wherever it is let down.
    pub unreachable: f64,
    /// Where it comes nearer somewhere, but does not touch the surface, or where that was not found out.
    pub beside: f64,
}

/// The areas of these cells, each told by its middle; `allowed` mm may be left.
pub(super) fn areas(finish: &Finish, tiles: &[&[(Corner, f64)]], allowed: f64) -> Areas {
    let of = |cells: &&[(Corner, f64)]| {
        let mut reacher = Reacher::new(&finish.tree, &finish.cutter, finish.leave);
        let mut own = Areas::default();
        for (at, area) in *cells {
            match reacher.comes_to(at.p + at.n * (allowed + finish.leave)) {
                Reach::Nowhere => own.unreachable += area,
                Reach::Somewhere | Reach::Unknown => own.beside += area,
            }
        }
        own
    };
    let found: Vec<Areas> = tiles.par_iter().map(of).collect();
    found.iter().fold(Areas::default(), |sum, own| Areas {
        unreachable: sum.unreachable + own.unreachable,
        beside: sum.beside + own.beside,
    })
}

/// Area of a part of a patch, mm².
pub(super) fn area(patch: &Patch, u: (f64, f64), v: (f64, f64)) -> f64 {
    // Gauss and Legendre's three places.
    const AT: [(f64, f64); 3] =
        [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
    let place = |(a, b): (f64, f64), t: f64| a + (b - a) * t;
    let along = |(t, weight): (f64, f64)| {
        let jet = |s: f64| patch.jet(place(u, t), place(v, s));
        let size = |s: f64| {
            let jet = jet(s);
            jet.u.cross(&jet.v).norm()
        };
        weight * AT.iter().map(|(s, w)| w * size(*s)).sum::<f64>()
    };
    AT.into_iter().map(along).sum::<f64>() * (u.1 - u.0) * (v.1 - v.0)
}

/// Area of a whole surface, mm².
pub(super) fn whole(finish: &Finish) -> f64 {
    let part = |k: u32| (f64::from(k) / f64::from(TILES), f64::from(k + 1) / f64::from(TILES));
    let tile = |(patch, tile): (usize, u32)| {
        let whole = finish.tree.net().patches().get(patch);
        whole.map_or(0.0, |p| area(p, part(tile / TILES), part(tile % TILES)))
    };
    super::field::tiles(&finish.tree).into_iter().map(tile).sum()
}
