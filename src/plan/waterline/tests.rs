use super::*;
use crate::geom::Point2;
use crate::geom::surface::{Cutter, Net};

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

#[test]
fn levels_of_a_cavity_have_their_areas() {
    let ground = made(cavity(), 0.5, 0.0);
    let low = ground.lowest().expect("a height");
    let levels = heights((0.5, low), 2.0);
    assert_eq!(levels.len(), 14);
    let known =
        [2027.1, 1783.4, 1578.5, 1389.0, 1212.0, 1045.0, 886.6, 735.7, 592.0, 455.5, 326.2, 204.6, 92.2];
    for (z, area) in levels.iter().zip(known) {
        let slice = slice::slice(&ground, *z, (3.0, 6.5)).expect("a level");
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
    let slice = slice::slice(&ground, -4.0, (2.0, 6.5)).expect("a level");
    assert_eq!(slice.outer.len(), 2);
    let ground = made(dome(), 0.5, 0.0);
    let slice = slice::slice(&ground, 8.0, (3.0, 6.5)).expect("a level");
    let walls = slice.pockets.last().expect("a pocket");
    assert!(slice.outer.len() == 1 && walls.airy && walls.rings.len() == 1 && walls.rings[0].closed);
    let middle = Point2::new(30.0, 30.0);
    assert!(walls.rings[0].points.iter().all(|p| (p - middle).norm() > 8.0));
}

#[test]
fn waterlines_lie_on_the_raised_surface() {
    let ground = made(cavity(), 0.5, 0.0);
    let slice = slice::slice(&ground, -10.0, (3.0, 6.5)).expect("a level");
    let walls = &slice.pockets.last().expect("a pocket").rings;
    for p in walls.iter().flat_map(|r| &r.points) {
        let tip = ground.rest.tip(*p, &mut None);
        assert!(tip <= -10.0 + 1e-9 && tip > -10.0 - 1e-4, "{p} {tip}");
    }
}

#[test]
fn rings_keep_their_distance_from_the_walls() {
    let ground = made(cavity(), 0.5, 0.0);
    let slice = slice::slice(&ground, -6.0, (3.0, 6.5)).expect("a level");
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
