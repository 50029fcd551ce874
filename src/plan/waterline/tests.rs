use super::*;
use crate::geom::Point2;
use crate::geom::surface::Net;

fn net(x: [f64; 4], y: [f64; 4], z: [[f64; 4]; 4]) -> Net {
    let poles: Vec<Point3> = (0..16).map(|k| Point3::new(x[k / 4], y[k % 4], z[k / 4][k % 4])).collect();
    Net::new(4, 4, &poles, None).expect("a net")
}

fn cavity() -> Net {
    let z = [[0.0; 4], [0.0, -52.0, -46.0, 0.0], [0.0, -44.0, -56.0, 0.0], [0.0; 4]];
    net([0.0, 20.0, 40.0, 60.0], [0.0, 16.0, 32.0, 48.0], z)
}

fn dome() -> Net {
    let z = [[0.0, 4.0, 4.0, 0.0], [4.0, 16.0, 16.0, 4.0], [4.0, 16.0, 16.0, 4.0], [0.0, 4.0, 4.0, 0.0]];
    net([0.0, 20.0, 40.0, 60.0], [0.0, 20.0, 40.0, 60.0], z)
}

/// Ball of radius 5 with `leave` on the net, in a block about it.
fn made(net: Net, leave: f64, beyond: f64) -> Ground {
    let tree = Arc::new(SurfaceTree::new(net, 8.0));
    let (low, high) = tree.bounds();
    let out = crate::geom::Vec2::new(beyond, beyond);
    let blank = Blank::Block { low: low.xy() - out, high: high.xy() + out };
    Ground::new(Rest::new(tree, Cutter::ball(5.0), leave), blank, 0.5, 6.5)
}

/// Rings so far apart, of the ball at a depth of 2.
fn spread(width: f64) -> Spread {
    Spread { width, reach: 4.0, air: 6.5 }
}

#[test]
fn levels_of_a_cavity_have_their_areas() {
    let ground = made(cavity(), 0.5, 0.0);
    let low = ground.lowest().expect("a height");
    let levels = heights((0.5, low), 2.0);
    assert_eq!(levels.len(), 14);
    let known =
        [2027.1, 1783.4, 1578.5, 1389.0, 1212.0, 1045.0, 886.6, 735.7, 592.0, 455.5, 326.2, 204.6, 92.2];
    for (z, area) in levels.iter().zip(known) {
        let slice = slice::slice(&ground, *z, spread(3.0)).expect("a level");
        assert!((slice.area - area).abs() < 1.0, "{z}: {} {area}", slice.area);
    }
}

#[test]
fn a_crown_in_a_tight_block_is_open_and_in_a_large_one_closed() {
    assert!(made(dome(), 0.5, 2.0).open);
    assert!(!made(dome(), 0.5, 12.0).open);
}

#[test]
fn two_pits_are_two_pockets_and_a_boss_is_an_island() {
    let mut poles = Vec::new();
    for i in 0..7u32 {
        for j in 0..4u32 {
            let pit = [0.0, -20.0, -20.0, 0.0, -20.0, -20.0, 0.0][i as usize]
                * f64::from(u32::from(j == 1 || j == 2));
            poles.push(Point3::new(f64::from(i) * 10.0, f64::from(j) * 10.0, pit));
        }
    }
    let ground = made(Net::new(7, 4, &poles, None).expect("a net"), 0.3, 0.0);
    let slice = slice::slice(&ground, -4.0, spread(2.0)).expect("a level");
    assert_eq!(slice.outer.len(), 2);
    let ground = made(dome(), 0.5, 0.0);
    let slice = slice::slice(&ground, 8.0, spread(3.0)).expect("a level");
    let walls = slice.pockets.last().expect("a pocket");
    assert!(slice.outer.len() == 1 && walls.airy && walls.rings.len() == 1 && walls.rings[0].closed);
    let middle = Point2::new(30.0, 30.0);
    assert!(walls.rings[0].points.iter().all(|p| (p - middle).norm() > 8.0));
}

#[test]
fn waterlines_lie_on_the_raised_surface() {
    let ground = made(cavity(), 0.5, 0.0);
    let slice = slice::slice(&ground, -10.0, spread(3.0)).expect("a level");
    let walls = &slice.pockets.last().expect("a pocket").rings;
    for p in walls.iter().flat_map(|r| &r.points) {
        let tip = ground.rest.tip(*p, &mut None);
        assert!(tip <= -10.0 + 1e-9 && tip > -10.0 - 1e-4, "{p} {tip}");
    }
}

#[test]
fn rings_keep_their_distance_from_the_walls() {
    let ground = made(cavity(), 0.5, 0.0);
    let slice = slice::slice(&ground, -6.0, spread(3.0)).expect("a level");
    let count = slice.pockets.len();
    let walls: Vec<Point2> = slice.pockets[count - 1].rings[0].points.clone();
    let off = |p: Point2| walls.iter().map(|w| (w - p).norm()).fold(f64::INFINITY, f64::min);
    for (k, pocket) in slice.pockets.iter().rev().enumerate() {
        for p in pocket.rings.iter().flat_map(|r| &r.points) {
            let wanted = 3.0 * count_of(k);
            // Corners are cut by less than a cell.
            assert!((off(*p) - wanted).abs() < 0.15, "{p}: {} {wanted}", off(*p));
        }
    }
}

fn count_of(k: usize) -> f64 {
    crate::math::count(k)
}

#[test]
fn levels_end_at_the_lowest_height() {
    assert_eq!(heights((0.0, -5.0), 2.0), [-2.0, -4.0, -5.0]);
    assert_eq!(heights((0.0, -4.0), 2.0), [-2.0, -4.0]);
    assert_eq!(heights((10.0, 9.5), 2.0), [9.5]);
}

/// What stands at a level after its rings, and after the ways into what they leave.
fn standing((net, z): (Net, f64), width: f64, spurs: bool) -> f64 {
    let ground = made(net, 0.5, 0.0);
    let slice = slice::slice(&ground, z, spread(width)).expect("a level");
    let rings = slice.pockets.iter().flat_map(|p| &p.rings);
    let mut ways: Vec<(Point2, Point2)> = rings.flat_map(|r| slice::pieces(&r.points, r.closed)).collect();
    ways.extend(slice.spurs.iter().filter(|_| spurs));
    let mut standing = Standing::new(&ground.rest.tree, (Cutter::ball(5.0), 0.5), ground.blank, 0.5);
    // The ball is a little wider than it is counted on.
    standing.after(z, &ways, 4.02).iter().map(|island| island.area).sum()
}

#[test]
fn rings_as_near_as_they_reach_leave_nothing() {
    for width in [2.0, 3.0, 4.0] {
        assert_eq!(standing((cavity(), -7.5), width, false), 0.0, "{width}");
        assert_eq!(standing((dome(), 5.5), width, false), 0.0, "{width}");
    }
}

#[test]
fn what_stands_between_wider_rings_is_cut() {
    for width in [5.0, 6.0, 7.0, between::widest(4.0, 0.5)] {
        assert_eq!(standing((cavity(), -7.5), width, true), 0.0, "{width}");
        assert_eq!(standing((dome(), 5.5), width, true), 0.0, "{width}");
    }
    // There is something to cut.
    let rings_only = |z: f64| standing((cavity(), z), between::widest(4.0, 0.5), false);
    let most = [-3.5, -5.5, -7.5, -9.5, -11.5].map(rings_only).into_iter().fold(0.0, f64::max);
    assert!(most > 0.1, "{most}");
}

/// Direction of a move at its start or its end.
fn heading(from: Point3, step: &Move, end: bool) -> Option<crate::geom::Vec2> {
    let to = step.end();
    match *step {
        Move::Rapid(_) => None,
        Move::Line(_) => (to - from).xy().try_normalize(1e-6),
        Move::Arc { centre, ccw, .. } => {
            let arm = if end { to.xy() - centre } else { from.xy() - centre };
            (crate::geom::left(arm) * if ccw { 1.0 } else { -1.0 }).try_normalize(1e-6)
        }
    }
}

#[test]
fn inwards_the_way_to_the_next_ring_leaves_the_last_slowly() {
    let ground = made(cavity(), 0.5, 0.0);
    let stock = HeightField::new(&ground.blank, 0.5, 0.25);
    let manner = Manner {
        width: 3.0,
        reach: 4.0,
        air: 6.5,
        safe: 2.5,
        ramp: 0.05,
        tolerance: 0.02,
        wall_left: true,
        inward: Some(true),
    };
    let z = -1.5;
    let mut path = Path::new(&ground, manner, stock);
    let slice = slice::slice(&ground, z, spread(3.0)).expect("a level");
    path.level(&slice);
    let flat: Vec<(Point3, &Move)> = path.moves.windows(2).map(|w| (w[0].end(), &w[1])).collect();
    let down = flat.iter().position(|(from, step)| from.z == z && step.end().z == z).expect("a cut");
    let mut turns = Vec::new();
    for pair in flat[down..].windows(2) {
        let before = heading(pair[0].0, pair[0].1, true);
        if let (Some(a), Some(b)) = (before, heading(pair[1].0, pair[1].1, false)) {
            turns.push(a.dot(&b));
        }
    }
    let rings = slice.pockets.len();
    assert!(rings > 4 && turns.len() > 10 * rings, "{rings} {}", turns.len());
    // Only the pointed ends of inner rings are turns of more than 45 degrees: straight across there were two per ring.
    let sharp = turns.iter().filter(|turn| **turn < 0.7).count();
    assert!(sharp < rings, "{sharp} of {rings}: {turns:?}");
}
