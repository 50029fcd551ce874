//! Nets out to STEP and in again.

use std::sync::Arc;

use super::*;
use crate::geom::Point3;
use crate::geom::surface::grid::Grid;
use crate::math::count;

fn wavy(degree: [usize; 2], size: [usize; 2], rational: bool) -> Net {
    let counts = [degree[0] * size[0] + 1, degree[1] * size[1] + 1];
    let place = |k: usize| (count(k / counts[1]), count(k % counts[1]));
    let height = |x: f64, y: f64| crate::math::sin(x) + y / 3.0 - x * y / 70.0;
    let poles: Vec<Point3> = (0..counts[0] * counts[1])
        .map(place)
        .map(|(x, y)| Point3::new(x / 0.3, -y / 0.7, height(x, y)))
        .collect();
    let weights: Vec<f64> = (0..poles.len()).map(|k| 1.0 + count(k % 5) / 7.0).collect();
    Net::chain(degree, size, &poles, rational.then_some(&weights)).expect("a net")
}

fn back(net: &Net) -> Import {
    let text: Arc<str> = step::write("N1", &Grid::of(net)).into();
    Document::open(Format::Step, &text).and_then(|d| d.net(None)).expect("what was written can be read")
}

#[test]
fn what_goes_out_comes_back_the_same() {
    for (degree, size) in
        [([3, 3], [1, 1]), ([3, 3], [3, 2]), ([1, 2], [2, 3]), ([7, 4], [1, 1]), ([5, 3], [2, 2])]
    {
        for rational in [false, true] {
            let net = wavy(degree, size, rational);
            let import = back(&net);
            assert_eq!(import.notices, []);
            assert_eq!((import.net.size(), import.face), (size, 1));
            for (a, b) in net.patches().iter().zip(import.net.patches()) {
                for (i, j) in (0..=degree[0]).flat_map(|i| (0..=degree[1]).map(move |j| (i, j))) {
                    assert!((a.pole(i, j) - b.pole(i, j)).norm() <= 1e-12);
                    assert!((a.weight(i, j) - b.weight(i, j)).abs() <= 1e-12);
                }
            }
        }
    }
}

#[test]
fn collapsed_and_closed_sides_have_the_edges_that_there_are() {
    let edges = |net: &Net| {
        let text = step::write("N1", &Grid::of(net));
        [
            text.matches("=EDGE_CURVE(").count(),
            text.matches("=ORIENTED_EDGE(").count(),
            text.matches("=VERTEX_POINT(").count(),
        ]
    };
    assert_eq!(edges(&wavy([3, 3], [2, 1], false)), [4, 4, 4]);
    // A cone's point is no edge; a ring's two ends are one edge.
    let point = |k: usize, f: &dyn Fn(f64, f64) -> [f64; 3]| Point3::from(f(count(k / 4), count(k % 4)));
    let fan: Vec<Point3> = (0..16).map(|k| point(k, &|x, y| [x * y, x * (3.0 - y), x])).collect();
    assert_eq!(edges(&Net::new(4, 4, &fan, None).expect("a net")), [3, 3, 3]);
    let at = |x: f64| if x == 3.0 { 0.0 } else { x };
    let ring: Vec<Point3> =
        (0..16).map(|k| point(k, &|x, y| [at(x) * (1.0 + y), at(x) * at(x), y])).collect();
    let ring = Net::new(4, 4, &ring, None).expect("a net");
    assert_eq!(edges(&ring), [3, 4, 2]);
    assert_eq!(back(&ring).notices, []);
}
