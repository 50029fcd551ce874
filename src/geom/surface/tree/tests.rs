use super::*;

fn graph(x: [f64; 4], y: [f64; 4], z: [[f64; 4]; 4]) -> Net {
    let poles: Vec<Point3> = (0..16).map(|k| Point3::new(x[k / 4], y[k % 4], z[k / 4][k % 4])).collect();
    Net::new(4, 4, &poles, None).expect("a net")
}

fn cavity() -> Net {
    let z = [[0.0; 4], [0.0, -52.0, -46.0, 0.0], [0.0, -44.0, -56.0, 0.0], [0.0; 4]];
    graph([0.0, 20.0, 40.0, 60.0], [0.0, 16.0, 32.0, 48.0], z)
}

/// Smallest distance over a grid of parameters, refined by the tree's own descent from each grid point's best.
fn brute(net: &Net, x: Point3) -> f64 {
    let mut best = f64::INFINITY;
    let mut at = [0.0, 0.0];
    for i in 0..=200 {
        for j in 0..=200 {
            let uv = [f64::from(i) / 200.0, f64::from(j) / 200.0];
            let d = (net.patches()[0].point(uv[0], uv[1]) - x).norm();
            if d < best {
                (best, at) = (d, uv);
            }
        }
    }
    descend(&net.patches()[0], x, at, &Area::WHOLE).square.sqrt()
}

#[test]
fn the_nearest_point_is_that_of_a_brute_search() {
    let tree = SurfaceTree::new(cavity(), 5.0);
    for k in 0..60u32 {
        let t = f64::from(k);
        let x = Point3::new((t * 7.3) % 64.0 - 2.0, (t * 11.9) % 52.0 - 2.0, (t * 3.7) % 30.0 - 22.0);
        let foot = tree.nearest(x, None);
        let brute = brute(tree.net(), x);
        assert!((foot.distance - brute).abs() < 1e-9 || foot.distance < brute, "{x}: {foot:?}, {brute}");
        assert!(foot.distance - foot.certain < 1e-8, "{foot:?}");
    }
}

#[test]
fn a_hint_from_anywhere_gives_the_same_foot() {
    let tree = SurfaceTree::new(cavity(), 5.0);
    let x = Point3::new(20.0, 14.0, -12.0);
    let plain = tree.nearest(x, None);
    let far = tree.nearest(Point3::new(59.0, 47.0, 0.0), None);
    let hinted = tree.nearest(x, Some(&far));
    assert!((plain.distance - hinted.distance).abs() < 1e-10);
}
