use super::*;
use crate::geom::surface::Net;
use crate::geom::surface::swept::Question;

fn graph(x: [f64; 4], y: [f64; 4], z: [[f64; 4]; 4]) -> SurfaceTree {
    let poles: Vec<Point3> = (0..16).map(|k| Point3::new(x[k / 4], y[k % 4], z[k / 4][k % 4])).collect();
    SurfaceTree::new(Net::new(4, 4, &poles, None).expect("a net"), 6.0)
}

/// A hollow with level edges, on which a flat end may lie.
fn hollow() -> SurfaceTree {
    let z = [[0.0; 4], [0.0, -40.0, -35.0, 0.0], [0.0, -30.0, -42.0, 0.0], [0.0; 4]];
    graph([0.0, 18.0, 36.0, 54.0], [0.0, 15.0, 30.0, 45.0], z)
}

/// Hills and hollows.
fn hills() -> SurfaceTree {
    let z =
        [[0.0, 9.0, -7.0, 2.0], [8.0, -20.0, 24.0, -6.0], [-7.0, 25.0, -18.0, 10.0], [3.0, -6.0, 9.0, 0.0]];
    graph([0.0, 17.0, 40.0, 58.0], [0.0, 16.0, 33.0, 50.0], z)
}

fn cutters() -> [Cutter; 5] {
    let tapered = |disc, corner| Cutter::taper(disc, corner, corner, 0.12);
    [
        Cutter::bull(4.0, 0.0),
        Cutter::bull(5.0, 1.2),
        tapered(0.0, 1.5),
        tapered(2.0, 0.0),
        Cutter::bull(4.0, 0.0).grown(0.005),
    ]
}

/// A grid of points finds rims and edges to a step of it only: by how much the height found is below what the grid asks for, and above.
fn against_samples(tree: &SurfaceTree, cutter: &Cutter, at: Point3) -> (f64, f64) {
    let mut best = f64::NEG_INFINITY;
    for k in 0..=200 * 201 {
        let [u, v] = [k / 201, k % 201].map(|i| f64::from(i) / 200.0);
        let q = tree.net().patches()[0].point(u, v);
        if let Some(p) = cutter.profile(math::hypot(q.x - at.x, q.y - at.y)) {
            best = best.max(q.z - p.height);
        }
    }
    (best - at.z, at.z - best)
}

#[test]
fn cutters_rest_on_the_highest_point_that_holds_them() {
    for tree in [hollow(), hills()] {
        for cutter in cutters() {
            for k in 0..7u32 {
                let (x, y) = (f64::from(k * 13 % 60) - 1.7, f64::from(k * 29 % 50) - 0.4);
                let Some(rest) = cutter.drop(&tree, x, y, None) else { continue };
                let (below, above) = against_samples(&tree, &cutter, rest.centre);
                assert!(below < 2e-9 && above < 0.6, "{cutter:?} {x} {y}: {below:e} {above:e} {rest:?}");
            }
        }
    }
}

#[test]
fn a_ball_rests_where_newton_puts_it() {
    let (tree, ball) = (hollow(), Cutter::ball(4.0));
    for k in 0..40u32 {
        let (x, y) = (f64::from(k * 7 % 54), f64::from(k * 11 % 45));
        let newton = ball.drop(&tree, x, y, None).expect("a contact").centre.z;
        let planes = tree.rest(&ball, [x, y], None).expect("a contact").centre.z;
        assert!((newton - planes).abs() < 2e-9, "{x} {y}: {newton} {planes}");
    }
}

#[test]
fn hints_and_hulls_do_not_change_where_a_cutter_rests() {
    let tree = hills();
    for cutter in cutters() {
        let mut hint = None;
        for k in 0..30u32 {
            let (x, y) = (10.0 + f64::from(k) * 0.9, 12.0 + f64::from(k) * 0.7);
            let plain = cutter.drop(&tree, x, y, None).expect("a contact");
            let hinted = cutter.drop(&tree, x, y, hint.as_ref()).expect("a contact");
            let grown = cutter.grown(1e-3).drop(&tree, x, y, None).expect("a contact");
            assert!((plain.centre.z - hinted.centre.z).abs() < 2e-9, "{cutter:?} {x} {y}");
            assert!(grown.centre.z >= plain.centre.z + 1e-3 - 2e-9, "{cutter:?} {x} {y}");
            hint = Some(hinted);
        }
    }
}

#[test]
fn nothing_holds_a_cutter_beside_the_surface() {
    for cutter in [Cutter::bull(4.0, 0.0), Cutter::bull(5.0, 1.2)] {
        assert_eq!(cutter.drop(&hollow(), -5.1, 20.0, None), None);
    }
}

/// Smallest signed distance of the core over a fine grid of the surface.
fn core_distance(tree: &SurfaceTree, cutter: &Cutter, reference: Point3) -> f64 {
    let mut best = f64::INFINITY;
    for k in 0..=150 * 151 {
        let [u, v] = [k / 151, k % 151].map(|i| f64::from(i) / 150.0);
        let q = tree.net().patches()[0].point(u, v);
        best = best.min(cutter.outside_core(q - reference).0);
    }
    best
}

#[test]
fn extremes_of_a_way_are_those_of_samples() {
    for (tree, lift) in [(hollow(), 0.004), (hills(), 0.3)] {
        for cutter in cutters() {
            let rest = |x: f64, y: f64| {
                let mut p = cutter.drop(&tree, x, y, None).expect("a contact").centre;
                p.z += lift;
                p
            };
            let (from, to) = (rest(20.0, 17.0), rest(21.5, 17.6));
            let enough = Question { enough: f64::INFINITY, little: 0.0, accuracy: 1e-7 };
            let found = extremes(&tree, &cutter, from, to, &enough, None);
            let samples =
                (0..=12).map(|k| core_distance(&tree, &cutter, from + (to - from) * (f64::from(k) / 12.0)));
            let (least, most) =
                samples.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), d| (a.min(d), b.max(d)));
            let gap = |x: f64| (-2e-7..0.3).contains(&x);
            assert!(gap(least - found.least.distance), "{cutter:?} {least} {found:?}");
            // The grid tells too much of every distance, and the most of few places too little.
            assert!((found.most.distance - most).abs() < 0.3, "{cutter:?} {most} {found:?}");
            let exact = (0..=40).map(|k| {
                let x = from + (to - from) * (f64::from(k) / 40.0);
                tree.near(&cutter, (x, x), f64::INFINITY, 1e-9, None).distance
            });
            let (low, high) =
                exact.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), d| (a.min(d), b.max(d)));
            assert!((-2e-7..2e-4).contains(&(low - found.least.distance)), "{cutter:?} {low} {found:?}");
            assert!((-2e-7..2e-4).contains(&(found.most.distance - high)), "{cutter:?} {high} {found:?}");
        }
    }
}

/// A saddle whose last row stands up.
fn saddle() -> SurfaceTree {
    let z = [[7.0, 0.0, 1.0, 8.0], [0.0, -5.0, -4.0, 0.0], [-1.0, -6.0, -5.0, 1.0], [16.0, 12.0, 14.0, 18.0]];
    graph([0.0, 14.0, 28.0, 36.0], [0.0, 13.0, 26.0, 39.0], z)
}

/// Links that end with a sharp rim's side at the surface, or with a point of it inside the core: where the point goes on through
/// the rim nothing is known of the distance but that it is not inside.
#[test]
fn chords_of_a_sharp_rim_are_told_to_leave_the_surface() {
    let (tree, cutter) = (saddle(), Cutter::bull(3.0, 0.0).grown(0.005));
    let links = [
        ([10.5235, 2.5261, 3.4548], [8.7742, 2.5261, 3.996]),
        ([14.9269, 23.9025, -0.4347], [13.7993, 23.9025, -0.3379]),
        ([22.1402, 3.3194, 3.1875], [23.1421, 3.3194, 3.6639]),
        ([18.0959, 3.6635, 2.0296], [19.1265, 3.6635, 2.1629]),
    ];
    for (from, to) in links {
        let (from, to) = (Point3::from(from), Point3::from(to));
        let near = |x: Point3| tree.near(&cutter, (x, x), f64::INFINITY, 1e-9, None);
        let exact = (0..=60).map(|k| near(from + (to - from) * (f64::from(k) / 60.0)).distance);
        let most = exact.fold(f64::NEG_INFINITY, f64::max);
        let question = Question { enough: 0.0, little: 0.01, accuracy: 4e-7 };
        assert!(most > 0.01001 && near(from).distance < 0.01);
        assert!(!stays(&tree, &cutter, (from, to), &question, &near(from)));
        let found = extremes(&tree, &cutter, from, to, &question, None).most.distance;
        assert!((-1e-7..1e-4).contains(&(found - most)), "{from} {to}: {most} {found}");
        let wide = Question { little: most + 1e-4, enough: -1.0, ..question };
        assert!(stays(&tree, &cutter, (from, to), &wide, &near(from)));
        let high = Question { enough: 0.005, ..wide };
        assert!(!stays(&tree, &cutter, (from, to), &high, &near(from)));
    }
}

/// At an edge a search may end a hair inside of it: the normal is the cutter's there as well.
#[test]
fn the_normal_at_a_corner_of_a_net_is_that_of_the_cutter() {
    let (tree, cutter) = (saddle(), Cutter::bull(5.0, 2.0).grown(0.005));
    let mut hint = cutter.drop(&tree, 3.3, 36.3, None);
    for k in 0..200u32 {
        let x = 3.3 - f64::from(k) * 1e-3;
        let rest = cutter.drop(&tree, x, 36.573, hint.as_ref()).expect("a contact");
        let (_, out) = cutter.outside_core(rest.foot.point - rest.centre);
        assert!((out + rest.normal).norm() < 1e-3, "{x}: {out} {rest:?}");
        let foot = crate::geom::surface::Foot { uv: [1e-8, 1.0 - 1e-9], ..rest.foot };
        hint = Some(Contact { foot, ..rest });
    }
}

#[test]
fn what_rests_touches_and_what_is_lower_enters() {
    let tree = hills();
    for cutter in cutters() {
        for k in 0..12u32 {
            let (x, y) = (4.0 + f64::from(k) * 4.0, 9.0 + f64::from(k * 7 % 31));
            let p = cutter.drop(&tree, x, y, None).expect("a contact").centre;
            let apart = |up: f64| {
                let p = p + Vec3::z() * up;
                tree.near(&cutter, (p, p), f64::INFINITY, 1e-9, None).distance - cutter.corner()
            };
            assert!(apart(0.0).abs() < 1e-8, "{cutter:?} {x} {y}: {}", apart(0.0));
            assert!(apart(0.01) > 1e-3 && apart(-0.01) < -1e-3, "{cutter:?} {x} {y}");
        }
    }
}

#[test]
fn a_turned_and_moved_surface_holds_cutters_as_high() {
    let tree = hills();
    let patch = &tree.net().patches()[0];
    let (sin, cos) = math::sin_cos(0.7);
    let moved = |p: Point3| Point3::new(cos * p.x - sin * p.y + 11.0, sin * p.x + cos * p.y - 7.0, p.z + 3.0);
    let poles: Vec<Point3> = (0..16).map(|k| moved(patch.pole(k / 4, k % 4))).collect();
    let turned = SurfaceTree::new(Net::new(4, 4, &poles, None).expect("a net"), 6.0);
    for cutter in cutters() {
        for k in 0..10u32 {
            let p = Point3::new(f64::from(k * 17 % 58), f64::from(k * 23 % 50), 0.0);
            let Some(rest) = cutter.drop(&tree, p.x, p.y, None) else { continue };
            let q = moved(p);
            let other = cutter.drop(&turned, q.x, q.y, None).expect("a contact");
            assert!((rest.centre.z + 3.0 - other.centre.z).abs() < 3e-9, "{cutter:?} {p} {rest:?} {other:?}");
        }
    }
}

#[test]
fn what_is_shrunk_stays_inside_by_that_much() {
    for cutter in cutters() {
        for by in [0.002, 0.4, 1.3] {
            let Some((inner, up)) = cutter.shrunk(by) else { continue };
            for k in 0..=60u32 {
                let angle = f64::from(k) / 60.0 * math::PI / 2.0 * 0.92;
                let n = Vec3::new(math::sin(angle), 0.0, -math::cos(angle));
                assert!(
                    inner.support(n) + up * n.z <= cutter.support(n) - by + 1e-9,
                    "{cutter:?} {by} {angle}"
                );
            }
        }
    }
}

/// Least height above `q` of a cutter let down at places of a grid, mm.
fn lowest_over(tree: &SurfaceTree, cutter: &Cutter, q: Point3) -> f64 {
    const PARTS: i32 = 24;
    let mut best = f64::INFINITY;
    for k in 0..(2 * PARTS + 1) * (2 * PARTS + 1) {
        let [i, j] =
            [k / (2 * PARTS + 1), k % (2 * PARTS + 1)].map(|i| f64::from(i - PARTS) / f64::from(PARTS));
        let (x, y) = (q.x + i * cutter.radius(), q.y + j * cutter.radius());
        let (rest, profile) = (cutter.drop(tree, x, y, None), cutter.profile(math::hypot(q.x - x, q.y - y)));
        if let (Some(rest), Some(p)) = (rest, profile) {
            best = best.min(rest.centre.z + p.height - q.z);
        }
    }
    best
}

#[test]
fn what_a_cutter_comes_to_is_what_some_place_lets_it_take() {
    use super::reach::{Reach, Reacher};
    let mut told = [0, 0, 0];
    for tree in [hollow(), hills()] {
        for cutter in [Cutter::bull(5.0, 0.0), Cutter::bull(5.0, 1.2), Cutter::ball(9.0)] {
            let mut reacher = Reacher::new(&tree, &cutter, 0.0);
            for k in 0..6u32 {
                let [u, v] = [k * 5 % 7, k * 3 % 8].map(|i| 0.08 + 0.12 * f64::from(i));
                let jet = tree.net().patches()[0].jet(u, v);
                let p = jet.p + jet.normal().expect("a normal") * 0.05;
                let found = reacher.comes_to(p);
                let lowest = lowest_over(&tree, &cutter, p);
                match found {
                    // No place takes it, so none of the grid does.
                    Reach::Nowhere => assert!(lowest > 0.0, "{cutter:?} {p:?} {lowest}"),
                    // The grid is coarse: it comes near.
                    Reach::Somewhere => assert!(lowest < 0.25, "{cutter:?} {p:?} {lowest}"),
                    Reach::Unknown => assert!(lowest.abs() < 0.05, "{cutter:?} {p:?} {lowest}"),
                }
                told[found as usize] += 1;
            }
        }
    }
    assert!(told[0] > 4 && told[1] > 1 && told[2] < 3, "{told:?}");
}
