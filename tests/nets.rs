//! Properties of nets, through the whole pipeline: what does not change the surface, or moves it as a whole, does the same to the
//! proven program.

use std::fmt::Write as _;

use partwright::driver::{self, Build, Options};
use partwright::source::MemoryFiles;
use partwright::verify::SurfaceProof;
use proptest::prelude::*;

type Pole = [f64; 3];

/// A net by rows.
#[derive(Debug, Clone)]
struct Net {
    rows: usize,
    columns: usize,
    poles: Vec<Pole>,
}

impl Net {
    fn map(&self, image: impl Fn(Pole) -> Pole) -> Net {
        Net { poles: self.poles.iter().map(|p| image(*p)).collect(), ..self.clone() }
    }

    fn row(&self, i: usize) -> &[Pole] {
        &self.poles[i * self.columns..(i + 1) * self.columns]
    }

    fn of_rows(rows: &[Vec<Pole>]) -> Net {
        Net { rows: rows.len(), columns: rows[0].len(), poles: rows.concat() }
    }

    fn text(&self) -> String {
        let mut text = format!("NET/ {}, {}", self.rows, self.columns);
        for [x, y, z] in &self.poles {
            let _ = write!(text, ", $\n  ({x}, {y}, {z})");
        }
        text
    }
}

fn mix(a: &[Pole], b: &[Pole], t: f64) -> Vec<Pole> {
    a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * t)).collect()
}

/// The same surface with one more row of poles.
fn elevated(net: &Net) -> Net {
    let n = net.rows;
    let rows: Vec<Vec<Pole>> = (0..=n)
        .map(|i| {
            let t = i as f64 / n as f64;
            let (before, own) = (net.row(i.saturating_sub(1)), net.row(i.min(n - 1)));
            mix(own, before, t)
        })
        .collect();
    Net::of_rows(&rows)
}

/// The same surface as a chain of two patches along u (de Casteljau).
fn split(net: &Net) -> Net {
    let mut level: Vec<Vec<Pole>> = (0..net.rows).map(|i| net.row(i).to_vec()).collect();
    let (mut first, mut last) = (vec![level[0].clone()], vec![level[level.len() - 1].clone()]);
    while level.len() > 1 {
        level = level.windows(2).map(|w| mix(&w[0], &w[1], 0.5)).collect();
        first.push(level[0].clone());
        last.push(level[level.len() - 1].clone());
    }
    last.reverse();
    first.extend(last.into_iter().skip(1));
    Net::of_rows(&first)
}

/// A bicubic net with heights in tenths.
fn nets() -> impl Strategy<Value = Net> {
    proptest::collection::vec(-30..30i32, 16).prop_map(|heights| {
        let pole = |k: usize| [10.0 * (k / 4) as f64, 8.0 * (k % 4) as f64, f64::from(heights[k]) / 10.0];
        Net { rows: 4, columns: 4, poles: (0..16).map(pole).collect() }
    })
}

fn built(definitions: &str, operation: &str) -> Build {
    built_by("BALL, 6", definitions, operation)
}

fn built_by(cutter: &str, definitions: &str, operation: &str) -> Build {
    let text = format!(
        "UNITS/ MM\nMACHIN/ LINUXCNC\n{definitions}\nT1 = CUTTER/ {cutter}, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 8000\n\
         FEDRAT/ 800\nINTOL/ 0\nOUTTOL/ 0.02\nCLEARP/ 30\nS1 = SURFAC/ N1, ZIGZAG, {operation}\nFINI\n"
    );
    let files = MemoryFiles([("part.apt".to_owned(), text)].into());
    driver::build("part.apt", &files, &Options::default())
}

fn finished(net: &Net, operation: &str) -> Build {
    built(&format!("N1 = {}", net.text()), operation)
}

/// The proof, or the codes of what stands against it: they are to be the same, too.
fn outcome(build: &Build) -> Result<SurfaceProof, Vec<&'static str>> {
    match build.outputs.first().and_then(|o| o.proven.as_ref()) {
        Some(proven) => Ok(proven.certificate().operations[0].surface.clone().expect("a surface")),
        None => Err(build.diagnostics.iter().map(|d| d.code.id).collect()),
    }
}

/// The words X, Y, Z of the moves of a program, in micrometres.
fn places(build: &Build) -> Vec<[i64; 3]> {
    let proven = build.outputs[0].proven.as_ref().expect("a proven program");
    let mut at = [0; 3];
    let mut places = Vec::new();
    for line in proven.text().lines().filter(|l| !l.starts_with(['(', '%', ';'])) {
        let mut moved = false;
        for word in line.split_whitespace().take_while(|w| !w.starts_with('(')) {
            if let Some(axis) = ["X", "Y", "Z"].iter().position(|a| word.starts_with(a))
                && let Ok(value) = word[1..].parse::<f64>()
            {
                at[axis] = (value * 10_000.0).round() as i64;
                moved = true;
            }
        }
        if moved {
            places.push(at);
        }
    }
    places
}

/// With a height of cusps the places where passes come closer depend on how the surface is cut into parts.
const CUSPS: f64 = 0.05;

/// Lengths agree to this share, and counts to this share or one for a pass: rounding, or the other direction, may end a block
/// a step earlier.
fn alike(a: &SurfaceProof, b: &SurfaceProof, share: f64) -> Result<(), TestCaseError> {
    let near = |a: f64, b: f64| (a - b).abs() <= share * a.abs().max(b.abs()).max(1.0);
    prop_assert!(near(a.length, b.length), "{} {}", a.length, b.length);
    prop_assert!(a.passes.abs_diff(b.passes) <= u32::from(share >= CUSPS), "{} {}", a.passes, b.passes);
    let off = a.blocks.abs_diff(b.blocks);
    prop_assert!(
        off <= 2.max(a.passes) || f64::from(off) <= share * f64::from(a.blocks),
        "{} {}",
        a.blocks,
        b.blocks
    );
    Ok(())
}

/// Both are proven alike, or neither is.
fn same(a: &Build, b: &Build, share: f64) -> Result<(), TestCaseError> {
    match (outcome(a), outcome(b)) {
        (Ok(a), Ok(b)) => alike(&a, &b, share),
        (Err(a), Err(b)) => {
            prop_assert_eq!(a, b);
            Ok(())
        }
        (a, b) => Err(TestCaseError::fail(format!("{a:?} {b:?}"))),
    }
}

const PASSES: [&str; 4] = ["U, STEP, 3", "V, STEP, 3", "X, STEP, 3", "Y, CUSP, 0.2"];

/// A net that bends both ways, and less at one end than at the other.
fn uneven() -> Net {
    let heights = [0.0, 3.0, 2.0, 0.0, 1.0, 6.0, 4.0, 1.0, 1.0, 4.0, 5.0, 2.0, 0.0, 1.0, 2.0, 1.0];
    let pole = |k: usize| [10.0 * (k / 4) as f64, 8.0 * (k % 4) as f64, heights[k]];
    Net { rows: 4, columns: 4, poles: (0..16).map(pole).collect() }
}

const CUTTERS: [&str; 4] = ["FLAT, 6", "BULL, 8, 2", "BULL, 6, 1", "TAPER, 5, 1, ANGLE, 5"];

/// Bent passes of every cutter are proven, and those that use the height of cusps up are no longer than others.
#[test]
fn bent_passes_of_every_cutter_are_proven_and_no_longer_than_straight_ones() {
    let net = format!("N1 = {}", uneven().text());
    for cutter in CUTTERS {
        let proof = |operation: &str| {
            let build = built_by(cutter, &net, operation);
            outcome(&build).unwrap_or_else(|codes| panic!("{cutter} {operation}: {codes:?}"))
        };
        let bent = proof("ISOCSP, CUSP, 0.2");
        assert!(bent.into.value <= 1e-6 && bent.out.value <= 0.02 + 1e-6, "{cutter}");
        assert!(bent.left_bound <= 0.22 + 1e-4, "{cutter} {}", bent.left_bound);
        for straight in ["V, CUSP, 0.2", "Y, CUSP, 0.2"] {
            let other = proof(straight);
            assert!(
                bent.length <= 1.03 * other.length,
                "{cutter} {straight}: {} {}",
                bent.length,
                other.length
            );
        }
    }
}

/// The largest even distance of passes that keeps a height of cusps keeps it, and much of it is used.
#[test]
fn even_passes_of_every_cutter_keep_the_height_of_cusps() {
    let net = format!("N1 = {}", uneven().text());
    for cutter in CUTTERS {
        let build = built_by(cutter, &net, "CONST, CUSP, 0.3");
        let proof = outcome(&build).unwrap_or_else(|codes| panic!("{cutter}: {codes:?}"));
        assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.02 + 1e-6, "{cutter}");
        assert!(proof.left_bound <= 0.32 + 1e-4, "{cutter} {}", proof.left_bound);
        assert!(proof.left.value > 0.15, "{cutter} {}", proof.left.value);
    }
}

/// Passes at half the distance are twice as long in all, and as long as the net is wide by the distance at least.
#[test]
fn passes_at_one_distance_lie_at_that_distance() {
    let net = uneven();
    for cutter in CUTTERS {
        let [near, far] = ["CONST, STEP, 1.5", "CONST, STEP, 3"].map(|operation| {
            let build = built_by(cutter, &format!("N1 = {}", net.text()), operation);
            outcome(&build).unwrap_or_else(|codes| panic!("{cutter} {operation}: {codes:?}"))
        });
        let ratio = near.length / far.length;
        assert!((1.75..2.1).contains(&ratio), "{cutter}: {} {}", near.length, far.length);
        assert!(near.length > 30.0 * 24.0 / 1.5, "{cutter}: {}", near.length);
    }
}

/// Slopes that fall off at their edges, one with its sides aslant to each other: every cutter goes so far beyond them that no
/// more is left there than elsewhere.
#[test]
fn slopes_are_cut_to_their_edges_and_corners_by_every_cutter() {
    let slope = "N1 = NET/ 2, 2, (0, 0, 0), (0, 6, -12), (8, 0, 0), (8, 6, -12)";
    let skew = "N1 = NET/ 2, 2, (0, 0, 0), (5, 6, -8), (9, 1, 2), (14, 7, -7)";
    for (net, operation) in
        [(slope, "X, CUSP, 0.2"), (slope, "U, CUSP, 0.2"), (skew, "V, CUSP, 0.2"), (skew, "Y, CUSP, 0.2")]
    {
        for cutter in CUTTERS {
            let build = built_by(cutter, net, operation);
            let proof = outcome(&build).unwrap_or_else(|codes| panic!("{cutter} {operation}: {codes:?}"));
            assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.02 + 1e-6, "{cutter} {operation}");
            assert!(proof.left_bound <= 0.22 + 1e-4, "{cutter} {operation} {}", proof.left_bound);
            assert!(proof.unreachable.is_none(), "{cutter} {operation} {proof:?}");
        }
    }
}

/// A bull-nose whose flat does not fit the bottom of a valley: what stays there is told apart, along all of it.
#[test]
fn the_bottom_of_a_valley_that_a_flat_does_not_fit_is_told_apart() {
    let net = "N1 = NET/ 3, 3, (0, 0, 9), (1, 4, 10), (2, 8, 9), (10, 0, -5), (11, 4, -4), (12, 8, -5), \
               (20, 0, 9), (21, 4, 10), (22, 8, 9), WEIGHT, 1, 1, 1, 0.8, 0.7, 0.8, 1, 1, 1";
    let build = built_by("BULL, 8, 1.5", net, "X, CUSP, 0.2");
    let proof = outcome(&build).unwrap_or_else(|codes| panic!("{codes:?}"));
    assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.02 + 1e-6, "{proof:?}");
    assert!(proof.left_bound <= 0.22 + 1e-4, "{}", proof.left_bound);
    assert!(proof.unreachable.is_some_and(|w| w.value > 0.33), "{proof:?}");
    let (stays, beside) = (proof.unreachable_area.expect("an area"), proof.beside_area.expect("an area"));
    assert!(stays > 0.5 && stays + beside < 0.1 * proof.area, "{stays} {beside} {}", proof.area);
}

/// Steep nets with valleys in which the ball touches two walls, and with corners that no neighbouring pass cuts.
#[test]
fn steep_nets_are_finished_in_planes() {
    type Steep = (f64, [i32; 16], &'static str, &'static str);
    let steep: [Steep; 2] = [
        (3.0, [-1, -6, -5, 3, 0, -10, -8, -10, 10, 4, -11, 6, 5, -10, 4, 11], "BALL, 3", "Y, CUSP, 0.1"),
        (4.0, [-14, 9, 6, 2, 1, -10, -4, 15, -12, 0, -2, 10, 4, 10, -16, 8], "BALL, 3", "X, CUSP, 0.1"),
    ];
    for (side, heights, cutter, operation) in steep {
        let pole = |k: usize| [side * (k / 4) as f64, side * (k % 4) as f64, f64::from(heights[k])];
        let net = Net { rows: 4, columns: 4, poles: (0..16).map(pole).collect() };
        let build = built_by(cutter, &format!("N1 = {}", net.text()), operation);
        let proof = outcome(&build).unwrap_or_else(|codes| panic!("{operation}: {codes:?}"));
        assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.02 + 1e-6, "{operation}");
        assert!(proof.left_bound <= 0.12 + 1e-4, "{operation} {}", proof.left_bound);
    }
}

/// Bent passes of a ball that does not fit: at a border where it is lifted it touches elsewhere, perhaps on what is cut.
#[test]
fn bent_passes_of_a_large_ball_leave_nothing_out_before_a_border() {
    let waves = [
        [-12, 16, -16, -4, -13, 11, 8, 10, 4, -7, -14, 11, -19, 4],
        [-6, 3, 4, -12, -8, -18, -15, -12, -5, 12, -7, 5, -19, 9],
    ];
    for heights in waves {
        let pole = |k: usize| [27.0 * (k / 7) as f64, 2.5 * (k % 7) as f64, f64::from(heights[k]) / 10.0];
        let net = Net { rows: 2, columns: 7, poles: (0..14).map(pole).collect() };
        let build = built_by("BALL, 16", &format!("N1 = {}", net.text()), "ISOCSP, CUSP, 0.05");
        let proof = outcome(&build).unwrap_or_else(|codes| panic!("{heights:?}: {codes:?}"));
        assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.02 + 1e-6, "{heights:?}");
    }
}

/// The ball's rolling over a straight border of a ruled net takes long moves beside that border.
#[test]
fn long_moves_beside_a_border_are_proven() {
    let z = [5.6, 1.0, -4.7, -0.4];
    let pole = |k: usize| [11.0 * (k / 4) as f64, 16.0 * (k % 4) as f64, z[k / 4]];
    let net = Net { rows: 4, columns: 4, poles: (0..16).map(pole).collect() };
    let build = built_by("BALL, 1", &format!("N1 = {}", net.text()), "Y, STEP, 4");
    let proof = outcome(&build).unwrap_or_else(|codes| panic!("{codes:?}"));
    assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.02 + 1e-6);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    /// The weights of a point sum up to one: poles of one height are a plane of that height, rational or not.
    #[test]
    fn poles_of_one_height_are_a_plane(
        height in -50..50i32,
        weights in proptest::collection::vec(8..12u32, 16),
        passes in 0..3usize,
    ) {
        let z = f64::from(height) / 10.0;
        let poles = (0..16).map(|k| [10.0 * (k / 4) as f64, 8.0 * (k % 4) as f64, z]).collect();
        let net = Net { rows: 4, columns: 4, poles };
        let weights: Vec<String> = weights.iter().map(|w| format!("{}", f64::from(*w) / 10.0)).collect();
        let definition = format!("N1 = {}, WEIGHT, {}", net.text(), weights.join(", $\n  "));
        let build = built(&definition, PASSES[passes]);
        let proof = outcome(&build).expect("a proof");
        prop_assert!(proof.passes > 2);
        let lowest = places(&build).iter().map(|p| p[2]).min().expect("a move");
        let level = (z * 10_000.0).round() as i64;
        prop_assert!((level..=level + 200).contains(&lowest), "{lowest} {level}");
    }

    /// The image of a surface is the surface of the images of its poles, under a shear and another scale of each axis.
    #[test]
    fn the_image_of_a_net_is_that_of_its_poles(
        net in nets(),
        elements in proptest::collection::vec(-3..4i32, 6),
        passes in 0..4usize,
    ) {
        let tenth = |i: usize| f64::from(elements[i]) / 10.0;
        let rows = [
            [1.2, tenth(0), 0.0, f64::from(elements[1])],
            [tenth(2), 0.9, 0.0, f64::from(elements[3])],
            [tenth(4), tenth(5), 0.8, 1.5],
        ];
        let image = net.map(|p| rows.map(|r| r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3]));
        let numbers: Vec<String> = rows.iter().flatten().map(f64::to_string).collect();
        let moved = format!(
            "N0 = {}\nM1 = MATRIX/ {}\nN1 = NET/ N0, TRFORM, M1", net.text(), numbers.join(", ")
        );
        same(&built(&moved, PASSES[passes]), &finished(&image, PASSES[passes]), 1e-3)?;
    }

    /// Turned by a right angle, passes along X are passes along Y.
    #[test]
    fn a_job_turned_by_a_right_angle_has_the_same_lengths_and_blocks(net in nets(), passes in 0..3usize) {
        let turned = net.map(|[x, y, z]| [-y, x, z]);
        let (own, other) = [("U, STEP, 3", "U, STEP, 3"), ("X, STEP, 3", "Y, STEP, 3"), ("Y, CUSP, 0.2", "X, CUSP, 0.2")][passes];
        let share = if passes == 2 { CUSPS } else { 5e-3 };
        same(&finished(&net, own), &finished(&turned, other), share)?;
    }

    /// Moved by whole millimetres, which are steps of the control's grid, the program is moved.
    #[test]
    fn a_job_moved_by_steps_of_the_grid_is_the_same_program_moved(
        net in nets(),
        by in (-40..40i32, -40..40i32),
        passes in 0..4usize,
    ) {
        let (dx, dy) = (f64::from(by.0), f64::from(by.1));
        let moved = net.map(|[x, y, z]| [x + dx, y + dy, z]);
        let builds = [finished(&net, PASSES[passes]), finished(&moved, PASSES[passes])];
        same(&builds[0], &builds[1], 1e-3)?;
        if outcome(&builds[0]).is_ok() {
            let [a, b] = builds.each_ref().map(places);
            // The first move has X and Y; before it nothing is known.
            prop_assert_eq!(a.len(), b.len());
            for (p, q) in a.iter().zip(&b).skip(3) {
                let off = [q[0] - p[0] - i64::from(by.0) * 10_000, q[1] - p[1] - i64::from(by.1) * 10_000, q[2] - p[2]];
                prop_assert!(off.iter().all(|o| o.abs() <= 10), "{p:?} {q:?}");
            }
        }
    }

    /// One more row of poles does not change the surface.
    #[test]
    fn a_net_of_a_higher_degree_gives_the_same_program(net in nets(), passes in 0..4usize) {
        same(&finished(&net, PASSES[passes]), &finished(&elevated(&net), PASSES[passes]), 1e-3)?;
    }

    /// Two patches that are one give the same proof.
    #[test]
    fn a_patch_split_into_a_chain_gives_the_same_proof(net in nets(), passes in 0..4usize) {
        let builds = [finished(&net, PASSES[passes]), finished(&split(&net), PASSES[passes])];
        let [a, b] = builds.each_ref().map(outcome);
        prop_assert_eq!(a.is_ok(), b.is_ok(), "{:?} {:?}", a, b);
        if let (Ok(a), Ok(b)) = (a, b) {
            // Along U a pass has a joint to go over now.
            let by_cusps = passes == 3;
            let share = if by_cusps { 2.0 * CUSPS } else { 0.02 };
            prop_assert!((a.length / b.length - 1.0).abs() < share, "{} {}", a.length, b.length);
            prop_assert!(a.passes.abs_diff(b.passes) <= 2 * u32::from(by_cusps), "{} {}", a.passes, b.passes);
            let more = a.blocks.abs_diff(b.blocks);
            prop_assert!(more <= (2 + 4 * u32::from(by_cusps)) * a.passes, "{} {}", a.blocks, b.blocks);
            for proof in [&a, &b] {
                prop_assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.02 + 1e-6);
            }
        }
    }
}
