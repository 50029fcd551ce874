//! Where the path of an open curve starts and ends: at the grid points of the band nearest to the curve's ends.

use super::Tube;
use super::search::Vertex;
use super::tube::{Gates, ROUNDING, Stations};
use super::window::Course;
use crate::geom::Vec2;

/// Grid steps about an end of the curve in which its vertex is looked for.
const AROUND: i64 = 3;
/// Gates about an end among which its vertex lies.
const NEAR: usize = 8;

/// First and last vertex of an open chain.
#[derive(Debug, Clone, Copy)]
pub struct Ends {
    /// First vertex.
    pub head: Vertex,
    /// Last vertex; its next gate is where the course ends.
    pub tail: Vertex,
}

impl Ends {
    /// Those of the tube's curve; the gate at which there is none otherwise.
    ///
    /// # Errors
    /// The first or the last gate, when no grid point near it lies in the band.
    pub fn of(stations: &Stations, tube: &Tube, gates: &Gates) -> Result<Ends, usize> {
        let last = gates.len() - 1;
        let tail = nearest(stations, tube, last).ok_or(last)?;
        let head = nearest(stations, tube, 0).ok_or(0_usize)?;
        let course = Course { gates, end: last + 1, target: None };
        let next = course.locate(point(head), NEAR.min(last), 0).map_or(0, |g| g + 1).clamp(1, last.max(1));
        let end = course.locate(point(tail), last, next - 1).map_or(next, |g| g + 1).min(last).max(next);
        Ok(Ends { head: Vertex { at: head, next }, tail: Vertex { at: tail, next: end } })
    }

    /// The course to the last vertex.
    #[must_use]
    pub fn course<'a>(&self, gates: &'a Gates) -> Course<'a> {
        Course { gates, end: self.tail.next, target: Some(self.tail.point()) }
    }
}

fn point(at: [i64; 2]) -> Vec2 {
    Vec2::new(at[0] as f64, at[1] as f64)
}

/// The grid point nearest to the curve's end at station `i` that lies in the band.
fn nearest(stations: &Stations, tube: &Tube, i: usize) -> Option<[i64; 2]> {
    let f = stations.stations[i].frenet;
    let plane = stations.plane;
    // angles are counted on from the first station
    let centre =
        stations.stations[..=i].iter().fold(Vec2::zeros(), |near, s| plane.to_grid(s.frenet.p, near));
    let mut best: Option<(f64, [i64; 2])> = None;
    for dx in -AROUND..=AROUND {
        for dy in -AROUND..=AROUND {
            let at = [centre.x.round() as i64 + dx, centre.y.round() as i64 + dy];
            let w = plane.to_part(point(at)) - f.p;
            let d = w.dot(&f.n());
            let inside = d <= tube.left + ROUNDING && d >= -tube.right - ROUNDING;
            if inside && best.is_none_or(|b| w.norm() < b.0) {
                best = Some((w.norm(), at));
            }
        }
    }
    best.map(|b| b.1)
}
