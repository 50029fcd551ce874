//! Triangles against the surface.

use std::collections::BTreeMap;

use super::*;

fn net(rational: bool) -> Net {
    let place = |k: usize| (count(k / 7), count(k % 7));
    let height = |x: f64, y: f64| 6.0 * crate::math::sin(1.3 * x) + 4.0 * crate::math::cos(0.9 * y * x);
    let poles: Vec<Point3> =
        (0..49).map(place).map(|(x, y)| Point3::new(10.0 * x, 8.0 * y, height(x, y))).collect();
    let weights: Vec<f64> = (0..49).map(|k| 1.0 + count(k % 4) / 3.0).collect();
    Net::new(7, 7, &poles, rational.then_some(&weights)).expect("a net")
}

/// Edges that belong to one triangle only.
fn open_edges(triangles: &[[Vec3; 3]]) -> usize {
    let key = |v: &Vec3| [v.x, v.y, v.z].map(f64::to_bits);
    let mut edges: BTreeMap<[[u64; 3]; 2], i32> = BTreeMap::new();
    for t in triangles {
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let (a, b) = (key(&t[a]), key(&t[b]));
            let (edge, sense) = if a < b { ([a, b], 1) } else { ([b, a], -1) };
            *edges.entry(edge).or_default() += sense;
        }
    }
    edges.values().filter(|n| **n != 0).count()
}

#[test]
fn triangles_have_no_cracks_and_keep_the_tolerance() {
    for (rational, tolerance) in [(false, 0.1), (false, 0.01), (true, 0.05)] {
        let net = net(rational);
        let found = triangles(&net, tolerance).expect("not too fine");
        // Only the four sides of the net are open: as many edges as there are corners on them.
        let sides: usize = {
            let all: BTreeSet<Place> =
                cells(&net, tolerance).expect("cells").iter().flat_map(corners).collect();
            let end = 2 * LATTICE;
            all.iter().filter(|p| p.0 == 0 || p.1 == 0 || p.0 == end || p.1 == end).count()
        };
        assert_eq!(open_edges(&found), sides);
        for t in found.iter().step_by(found.len() / 200 + 1) {
            let middle = Point3::from((t[0] + t[1] + t[2]) / 3.0);
            let far = nearest(&net, middle);
            assert!(far <= tolerance + 1e-5, "{far} > {tolerance}");
        }
    }
}

fn corners(c: &Cell) -> [Place; 4] {
    [c.from, c.to, (c.from.0, c.to.1), (c.to.0, c.from.1)]
}

/// Distance from the surface, by a search from a fine grid.
fn nearest(net: &Net, p: Point3) -> f64 {
    let far = |u: f64, v: f64| (net.jet(u, v).p - p).norm();
    let mut best = (f64::INFINITY, 0.0, 0.0);
    for i in 0..=80 {
        for j in 0..=80 {
            let (u, v) = (f64::from(i) / 40.0, f64::from(j) / 40.0);
            if far(u, v) < best.0 {
                best = (far(u, v), u, v);
            }
        }
    }
    let mut step = 1.0 / 40.0;
    while step > 1e-7 {
        let around = [
            (step, 0.0),
            (-step, 0.0),
            (0.0, step),
            (0.0, -step),
            (step, step),
            (step, -step),
            (-step, step),
            (-step, -step),
        ];
        let better = around
            .iter()
            .map(|(a, b)| ((best.1 + a).clamp(0.0, 2.0), (best.2 + b).clamp(0.0, 2.0)))
            .map(|(u, v)| (far(u, v), u, v))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match better {
            Some(b) if b.0 < best.0 => best = b,
            _ => step *= 0.5,
        }
    }
    best.0
}

#[test]
fn a_file_is_as_long_as_its_triangles_and_looks_up() {
    let flat: Vec<Point3> =
        [(0.0, 0.0), (0.0, 5.0), (9.0, 0.0), (9.0, 5.0)].map(|(x, y)| Point3::new(x, y, 1.0)).to_vec();
    let flipped: Vec<Point3> = flat.iter().map(|p| Point3::new(9.0 - p.x, p.y, p.z)).collect();
    for poles in [flat, flipped] {
        let bytes = write(&Net::new(2, 2, &poles, None).expect("a net"), 0.01).expect("a file");
        assert_eq!((bytes.len(), &bytes[80..84]), (84 + 2 * 50, &[2, 0, 0, 0][..]));
        for triangle in bytes[84..].chunks(50) {
            assert_eq!(triangle[8..12], 1.0_f32.to_le_bytes());
        }
    }
}

#[test]
fn what_would_take_too_many_triangles_is_refused() {
    assert_eq!(write(&net(true), 1e-12), Err(TooFine));
}
