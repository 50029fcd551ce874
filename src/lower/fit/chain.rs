//! A chain of links through a tube: where it starts and ends, how it closes, and its certified deviation.

use super::certify::Certificate;
use super::ends::Ends;
use super::measure::Range;
use super::search::{Effort, Goal, Search, Stuck, Vertex, WIDE, seed};
use super::tube::{Gates, Guard, Plane, ROUNDING, Stations};
use super::turns::turned;
use super::window::Course;
use super::{Fit, FitError, Primitive, Tube, bound};
use crate::geom::Vec2;
use crate::math;

/// Deviations are accepted this far beyond the band, mm: the rounding that the gates allow, and that of measuring.
const ACCEPTED: f64 = 4.0 * ROUNDING;
/// Parts of the band that are tried when the certified deviation of a chain leaves it.
const RETRIES: [f64; 4] = [1.0, 0.998, 0.99, 0.96];

/// Chains of no more links than this that miss the bound are searched for once more, widely: there the grid decides.
const FEW: usize = 16;

/// Chains of more links are not searched for widely: their grid is fine enough for a narrow search.
const MANY: u32 = 3_000;

/// Starts over the length of a link that are tried when a chain has too many links.
const STARTS: usize = 16;

/// Chains of more links do not depend on the start.
const FINE: usize = 400;

/// Another start is worth trying when no more than this part of a link is missing.
const WORTH: f64 = 0.25;

/// A chain of grid vertices; the last one closes it or ends it.
#[derive(Debug, Clone)]
struct Chain {
    vertices: Vec<Vertex>,
    /// Links that would do if fractions of a link existed, about.
    fraction: f64,
    range: Range,
}

impl Chain {
    fn links(&self) -> usize {
        self.vertices.len() - 1
    }
}

/// Fits the fewest links of a plane.
///
/// # Errors
/// See [`FitError`].
pub fn fit(tube: &Tube, plane: Plane, start: Option<f64>) -> Result<Fit, FitError> {
    counted(tube, plane, start).map(|(fit, _)| fit)
}

/// The fit, and how many gates the search looked at for it.
///
/// # Errors
/// See [`FitError`].
pub fn counted(tube: &Tube, plane: Plane, start: Option<f64>) -> Result<(Fit, usize), FitError> {
    let stations = Stations::new(tube, plane, None)?;
    let bound = bound::links(&stations, tube);
    let mut solver = Solver { tube, stations: &stations, search: Search::new(bound), bound };
    let from = solver.start_station(start);
    let chain = solver.best(from)?;
    let link = |v: &Vertex| match plane {
        Plane::Xy { .. } => Primitive::Line { to: v.at },
        Plane::Polar { .. } => Primitive::Spiral { to: v.at },
    };
    let fit = Fit {
        start: chain.vertices[0].at,
        primitives: chain.vertices[1..].iter().map(link).collect(),
        lower_bound: Some(bound),
        deviation: chain.range.sides(),
    };
    Ok((fit, solver.search.work))
}

/// How hard to try, by the number of links.
fn effort(links: f64) -> (Effort, u32) {
    match links {
        n if n < 12.0 => (Effort { beam: 8, tries: 8, columns: WIDE, all: false }, 8),
        n if n < 300.0 => (Effort { beam: 4, tries: 5, columns: WIDE, all: false }, 3),
        n if n < 3_000.0 => (Effort { beam: 3, tries: 4, columns: WIDE, all: false }, 3),
        n if n < 30_000.0 => (Effort { beam: 2, tries: 3, columns: WIDE, all: false }, 1),
        _ => (Effort { beam: 2, tries: 2, columns: WIDE, all: false }, 0),
    }
}

/// Links that may be left without trying many starts: one more than the bound, or the bound and 3 %.
fn allowed(bound: u32) -> u32 {
    bound + (bound * 3 / 100).max(1)
}

struct Solver<'a> {
    tube: &'a Tube<'a>,
    stations: &'a Stations,
    search: Search,
    bound: u32,
}

impl Solver<'_> {
    /// The station at which a closed chain should start.
    fn start_station(&self, start: Option<f64>) -> usize {
        let u = start.unwrap_or(self.tube.curve.domain().0);
        self.stations.stations.partition_point(|s| s.u < u).min(self.stations.stations.len() - 1)
    }

    /// The chain with the fewest links, and among those found the one with the smallest deviation.
    fn best(&mut self, from: usize) -> Result<Chain, FitError> {
        let (effort, rounds) = effort(f64::from(self.bound));
        let mut best = None;
        let retries = if self.bound < MANY { RETRIES.len() } else { 1 };
        for scale in &RETRIES[..retries] {
            let scale = *scale;
            best = self.attempt(scale, from, effort).ok();
            if best.is_some() {
                break;
            }
        }
        let mut best = match best {
            Some(chain) => chain,
            None => self.harder(from)?,
        };
        self.fewer(&mut best, from, effort, rounds);
        let few = best.links() <= FEW && best.links() > self.bound as usize;
        if few
            && let Ok(chain) =
                self.attempt(1.0, from, Effort { beam: 32, tries: 16, columns: WIDE, all: true })
            && chain.links() < best.links()
        {
            best = chain;
        }
        self.shrink(&mut best, from, effort, rounds);
        Ok(best)
    }

    /// A wide search where the narrow one died; then the question how wide the band should be.
    fn harder(&mut self, from: usize) -> Result<Chain, FitError> {
        let few = self.bound < MANY;
        let wide = if few {
            Effort { beam: 32, tries: 12, columns: WIDE, all: true }
        } else {
            effort(f64::from(MANY) / 2.0).0
        };
        let stuck = match self.attempt(1.0, from, wide) {
            Ok(chain) => return Ok(chain),
            Err(stuck) => stuck,
        };
        let n = self.stations.stations.len();
        let at = self.stations.stations[stuck.gate % n].frenet.p;
        let have = self.tube.left + self.tube.right;
        let unit = match self.stations.plane {
            Plane::Xy { step } => step,
            Plane::Polar { step, angle_step } => step.max(at.coords.norm() * angle_step * math::DEG),
        };
        if !few {
            // to search again for the width would take as long as the fit itself, many times
            return Err(FitError::BandTooNarrow { needed: 1.5 * have.max(unit), have, at });
        }
        let mut needed = have.max(unit / 16.0);
        for _ in 0..24 {
            needed *= 1.5;
            let (left, right) = self.widened(needed - have);
            let tube = Tube { curve: self.tube.curve, left, right };
            let mut wider = Solver {
                tube: &tube,
                stations: self.stations,
                search: Search::new(self.bound),
                bound: self.bound,
            };
            if wider.attempt(1.0, from, Effort { beam: 4, tries: 6, columns: WIDE, all: false }).is_ok() {
                break;
            }
        }
        Err(FitError::BandTooNarrow { needed, have, at })
    }

    /// The band widened by `by` in its own proportion.
    fn widened(&self, by: f64) -> (f64, f64) {
        let have = self.tube.left + self.tube.right;
        let share = if have > 0.0 { self.tube.left / have } else { 0.5 };
        (self.tube.left + by * share, self.tube.right + by * (1.0 - share))
    }

    /// Other starts on a closed curve, while the bound leaves hope for fewer links.
    fn fewer(&mut self, best: &mut Chain, from: usize, effort: Effort, rounds: u32) {
        if !self.stations.closed {
            return;
        }
        let n = self.stations.stations.len();
        let link = (n / best.links().max(1)).max(1);
        for round in 1..=rounds.min(3) {
            let missing = best.fraction - (best.links() - 1) as f64;
            if best.links() <= self.bound as usize || missing > WORTH {
                break;
            }
            self.restart(best, from + link * round as usize / 4, effort);
        }
        let wider = Effort { beam: 2 * effort.beam, tries: 2 * effort.tries, all: false, ..effort };
        for round in 0..STARTS {
            if best.links() as u32 <= allowed(self.bound) || best.links() > FINE {
                return;
            }
            self.restart(best, from + link * round / STARTS, wider);
        }
    }

    /// Takes the chain from another start when it is better.
    fn restart(&mut self, best: &mut Chain, from: usize, effort: Effort) {
        let n = self.stations.stations.len();
        if let Ok(chain) = self.attempt(1.0, from % n, effort)
            && (chain.links(), self.excess(&chain.range)) < (best.links(), self.excess(&best.range))
        {
            *best = chain;
        }
    }

    /// Narrower bands, as long as the number of links stays.
    fn shrink(&mut self, best: &mut Chain, from: usize, effort: Effort, rounds: u32) {
        let half = (self.tube.left + self.tube.right) / 2.0;
        if half <= 0.0 {
            return;
        }
        let links = best.links();
        let mut fails = 0.0_f64;
        for _ in 0..rounds {
            let reached = self.excess(&best.range) / half;
            let ratio = best.fraction / links as f64;
            let hope = reached * (ratio * ratio * 1.004).clamp(0.02, 0.99);
            let scale = if fails > 0.0 { f64::midpoint(fails, reached) } else { hope };
            if scale > 0.997 * reached || scale * half < 1e-7 {
                return;
            }
            match self.attempt(scale, from, effort) {
                Ok(chain) if chain.links() <= links => {
                    if self.excess(&chain.range) < self.excess(&best.range) {
                        *best = chain;
                    }
                }
                _ => fails = scale,
            }
        }
    }

    /// Largest deviation from the middle of the band, mm.
    fn excess(&self, range: &Range) -> f64 {
        let middle = (self.tube.left - self.tube.right) / 2.0;
        (range.high - middle).max(middle - range.low)
    }

    /// A chain in a part of the band; only one that is certified to lie in the whole band.
    fn attempt(&mut self, scale: f64, from: usize, effort: Effort) -> Result<Chain, Stuck> {
        let gates = self.stations.gates(self.tube, scale, Guard::Inside);
        if gates.len() < 2 {
            return Err(Stuck { gate: 0 });
        }
        let vertices = if self.stations.closed {
            self.closed(&gates, from, effort)?
        } else {
            self.open(&gates, effort)?
        };
        let vertices = turned(&gates, self.stations.plane, vertices);
        let fraction = fraction(&vertices);
        let range = Certificate { tube: self.tube, stations: self.stations }.chain(&vertices);
        let inside = range.high <= self.tube.left + ACCEPTED && range.low >= -self.tube.right - ACCEPTED;
        if inside { Ok(Chain { vertices, fraction, range }) } else { Err(Stuck { gate: from }) }
    }

    /// A closed chain: a run-up finds a good first vertex, from which the lap is made.
    fn closed(&mut self, gates: &Gates, from: usize, effort: Effort) -> Result<Vec<Vertex>, Stuck> {
        let n = gates.len();
        let link = n as f64 / f64::from(self.bound.max(1));
        let back = ((3.0 * link).ceil() as usize).clamp(1, n);
        let begin = from + n - back;
        let endless = Course { gates, end: from + 3 * n, target: None };
        let first =
            (begin..begin + back.min(64)).find_map(|g| seed(gates, g)).ok_or(Stuck { gate: begin % n })?;
        let narrow = Effort { beam: effort.beam.min(3), ..effort };
        let heads = self.search.run(&endless, &[first], Goal::Beyond(from + n - 1), narrow)?;
        let mut best: Option<Vec<Vertex>> = None;
        let mut error = Stuck { gate: from };
        for head in heads.into_iter().take(if link * 24.0 > n as f64 { 2 } else { 1 }) {
            let head = unwind(head, gates);
            match self.lap(gates, head, effort) {
                Ok(chain) if best.as_ref().is_none_or(|b| better(&chain, b)) => best = Some(chain),
                Ok(_) => {}
                Err(stuck) => error = stuck,
            }
        }
        best.ok_or(error)
    }

    fn lap(&mut self, gates: &Gates, head: Vertex, effort: Effort) -> Result<Vec<Vertex>, Stuck> {
        let end = head.next + gates.len();
        let target = head.point() + gates.lap;
        let course = Course { gates, end, target: Some(target) };
        let mut chain = self.search.run(&course, &[head], Goal::Target, effort)?;
        chain.push(Vertex { at: rounded(target), next: end });
        Ok(chain)
    }

    /// An open chain between the grid points nearest to the curve's ends.
    fn open(&mut self, gates: &Gates, effort: Effort) -> Result<Vec<Vertex>, Stuck> {
        let ends = Ends::of(self.stations, self.tube, gates).map_err(|gate| Stuck { gate })?;
        let mut chain = self.search.run(&ends.course(gates), &[ends.head], Goal::Target, effort)?;
        chain.push(ends.tail);
        Ok(chain)
    }
}

/// Of two closed chains the one with fewer links, then with the shorter last link.
fn better(a: &[Vertex], b: &[Vertex]) -> bool {
    (a.len() as f64, fraction(a)) < (b.len() as f64, fraction(b))
}

/// Links a chain would need if its last link, which is shorter than it could be, counted as a part.
fn fraction(vertices: &[Vertex]) -> f64 {
    let links = vertices.len() - 1;
    let (first, last) = (vertices[0].next as f64, vertices[links].next as f64);
    if links < 2 {
        return links as f64;
    }
    let whole = (links - 1) as f64;
    let before = vertices[links - 1].next as f64;
    let average = (before - first) / whole;
    if average > 0.0 { whole + ((last - before) / average).clamp(0.05, 1.0) } else { links as f64 }
}

/// A vertex of a later lap on the first lap.
fn unwind(mut v: Vertex, gates: &Gates) -> Vertex {
    let lap = rounded(gates.lap);
    while v.next >= gates.len() {
        v.next -= gates.len();
        v.at = [v.at[0] - lap[0], v.at[1] - lap[1]];
    }
    v
}

fn rounded(v: Vec2) -> [i64; 2] {
    [v.x.round() as i64, v.y.round() as i64]
}
