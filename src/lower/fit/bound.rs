//! Proven lower bounds on the number of links of a chain in a tube, wherever its vertices lie.
//!
//! The tube is widened by the sampling error first. A chain that follows the whole of an open curve passes from the
//! grid point nearest to the curve's start to the one nearest to its end; the farthest windows from the first count its
//! links (greedy is optimal: what more can be seen from a farther window contains what can be seen from a nearer one). A closed chain has a vertex in any
//! stretch that one link cannot pass, and cut at the gate through that vertex it is an open chain of as many links
//! from that gate to the same gate one lap on. Gates `a < b` around it bound all cuts between them: a chain from
//! within to one lap on also leads from `b` to `a` plus a lap.

use super::ends::Ends;
use super::tube::{Gates, Guard, Plane, Stations};
use super::window::{Bank, Course, Exit, Stab, Window, look};
use super::{FitError, Grid, Tube};

/// Laps that a closed curve's bound may cost, by the number of links.
fn laps_allowed(links: u32) -> u32 {
    match links {
        0..=100 => 45,
        101..=400 => 15,
        401..=4_000 => 8,
        _ => 3,
    }
}

/// Fewest straight lines that stay in the tube, wherever their ends lie.
///
/// # Errors
/// Those of [`Stations::new`].
pub fn lines(tube: &Tube, grid: &Grid) -> Result<u32, FitError> {
    let stations = Stations::new(tube, Plane::xy(grid), None)?;
    Ok(links(&stations, tube))
}

/// Fewest Archimedean spirals about the origin that stay in the tube, wherever their ends lie.
///
/// # Errors
/// Those of [`Stations::new`].
pub fn spirals(tube: &Tube, grid: &Grid) -> Result<u32, FitError> {
    let stations = Stations::new(tube, Plane::polar(grid), None)?;
    Ok(links(&stations, tube))
}

/// Whether a chain of at most `most` straight lines is not ruled out; much less work than [`lines`].
///
/// # Errors
/// Those of [`Stations::new`].
pub fn lines_may_be(tube: &Tube, grid: &Grid, most: usize) -> Result<bool, FitError> {
    Ok(may_be(&Stations::new(tube, Plane::xy(grid), None)?, tube, most))
}

/// Whether a chain of at most `most` Archimedean spirals is not ruled out.
///
/// # Errors
/// Those of [`Stations::new`].
pub fn spirals_may_be(tube: &Tube, grid: &Grid, most: usize) -> Result<bool, FitError> {
    Ok(may_be(&Stations::new(tube, Plane::polar(grid), None)?, tube, most))
}

/// A closed chain cut at any gate is an open one of at most one link more.
fn may_be(stations: &Stations, tube: &Tube, most: usize) -> bool {
    let gates = stations.gates(tube, 1.0, Guard::Outside);
    if gates.len() < 2 {
        return true;
    }
    let most = u32::try_from(most).unwrap_or(u32::MAX);
    let mut stab = Stab::default();
    if stations.closed {
        let limit = most.saturating_add(1);
        return count_to(&gates, &mut stab, (0, gates.len()), limit) <= limit;
    }
    open(stations, tube, &gates, &mut stab, most) <= most
}

/// The bound for stations at hand.
#[must_use]
pub fn links(stations: &Stations, tube: &Tube) -> u32 {
    let gates = stations.gates(tube, 1.0, Guard::Outside);
    let mut stab = Stab::default();
    if gates.len() < 2 {
        return 1;
    }
    if stations.closed {
        closed(&gates, &mut stab)
    } else {
        open(stations, tube, &gates, &mut stab, u32::MAX)
    }
}

/// The bound of an open tube, given up when it is more than `limit`.
fn open(stations: &Stations, tube: &Tube, gates: &Gates, stab: &mut Stab, limit: u32) -> u32 {
    match Ends::of(stations, tube, gates) {
        Ok(ends) => {
            let course = ends.course(gates);
            let first = look(&course, ends.head.point(), ends.head.next);
            1 + first.window(&course).map_or(0, |window| windows(&course, stab, window, first.reach, limit))
        }
        Err(_) => count_to(gates, stab, (0, gates.len() - 1), limit),
    }
}

/// Links of the shortest chain from gate `from` to gate `to`.
fn count(gates: &Gates, stab: &mut Stab, from: usize, to: usize) -> u32 {
    count_to(gates, stab, (from, to), u32::MAX)
}

/// The same, given up when there are more than `limit`.
fn count_to(gates: &Gates, stab: &mut Stab, (from, to): (usize, usize), limit: u32) -> u32 {
    if to <= from {
        return 1;
    }
    let course = Course { gates, end: to, target: None };
    windows(&course, stab, gate_window(gates, from), from as f64, limit)
}

/// Links from a window to the end of the course, given up when there are more than `limit`.
fn windows(course: &Course, stab: &mut Stab, mut window: Window, mut reach: f64, limit: u32) -> u32 {
    let mut links = 0;
    loop {
        links += 1;
        let view = stab.view(course, &window);
        let stuck = view.reach <= reach && links > 1;
        match view.window(course) {
            Some(next) if view.exit != Exit::End && !stuck && links <= limit => window = next,
            _ => return links,
        }
        reach = view.reach;
    }
}

/// A whole gate as a window.
pub(super) fn gate_window(gates: &Gates, i: usize) -> Window {
    Window { l: gates.left(i), r: gates.right(i), contact: Bank::Left, after: i + 1, next: i + 1 }
}

/// The bound of a closed tube.
fn closed(gates: &Gates, stab: &mut Stab) -> u32 {
    let n = gates.len();
    let whole = Course { gates, end: n, target: None };
    let first = stab.view(&whole, &gate_window(gates, 0));
    let link = if first.exit == Exit::End { n } else { first.stop };
    // intervals of gates [a, b] with their bound; the answer is the smallest
    let mut upper = count(gates, stab, 0, n);
    let mut laps = laps_allowed(upper);
    let mut open = vec![(0, link, count(gates, stab, link, n))];
    loop {
        let Some(lowest) = (0..open.len()).min_by_key(|i| (open[*i].2, open[*i].0)) else { return upper };
        let (a, b, bound) = open[lowest];
        if bound >= upper || b - a <= 1 || laps < 3 {
            return bound.min(upper);
        }
        laps -= 3;
        let middle = usize::midpoint(a, b);
        upper = upper.min(count(gates, stab, middle, middle + n));
        open[lowest] = (a, middle, count(gates, stab, middle, a + n));
        open.push((middle, b, count(gates, stab, b, middle + n)));
    }
}
