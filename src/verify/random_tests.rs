//! Random programs of lines, arcs, holes and dwells, for every post: what is lowered and written must be proven.

use proptest::prelude::*;

use crate::cl::{Circle, Cl, Cycle, CycleKind, Record, RecordKind, RetractTo, Spline};
use crate::diag::Sink;
use crate::geom::{Point3, Vec3};
use crate::ir::{Coolant, Feed, Origin, Spindle, Tool};
use crate::math::{TAU, sin_cos};
use crate::post::{builtin_names, examples, write};
use crate::source::{FileId, Span};
use crate::target::{BlockKind, Motion, TargetProgram};
use crate::units::LengthUnit;

use super::{Emitted, prove};

/// One thing that a random program does.
#[derive(Debug, Clone)]
enum Act {
    Rapid([i32; 3]),
    Linear([i32; 3]),
    Round { axis: usize, radius: u32, start: u32, sweep: u32, rise: i32, clockwise: bool },
    Curve { points: Vec<[i32; 3]>, inner: Vec<u32>, level: bool },
    Holes { kind: u8, depth: i32, initial: bool, at: Vec<[i32; 2]> },
    Dwell(u32),
    Feed(u32),
    Coolant(u8),
}

fn acts() -> impl Strategy<Value = Vec<Act>> {
    let place = || [-9000..9000_i32, -9000..9000_i32, -2000..2000_i32];
    let act = prop_oneof![
        4 => place().prop_map(Act::Linear),
        1 => place().prop_map(Act::Rapid),
        4 => (0..3_usize, 60..4000_u32, 0..360_u32, 5..=360_u32, prop_oneof![Just(0), -300..300_i32], any::<bool>())
            .prop_map(|(axis, radius, start, sweep, rise, clockwise)| Act::Round { axis, radius, start, sweep, rise, clockwise }),
        3 => (prop::collection::vec(place(), 4..9), prop::collection::vec(1..50_u32, 9), any::<bool>())
            .prop_map(|(points, inner, level)| Act::Curve { points, inner, level }),
        2 => (0..8_u8, 100..3000_i32, any::<bool>(), prop::collection::vec([-9000..9000_i32, -9000..9000_i32], 1..4))
            .prop_map(|(kind, depth, initial, at)| Act::Holes { kind, depth, initial, at }),
        1 => (1..400_u32).prop_map(Act::Dwell),
        1 => (20..3000_u32).prop_map(Act::Feed),
        1 => (0..3_u8).prop_map(Act::Coolant),
    ];
    prop::collection::vec(act, 1..14)
}

fn mm(hundredths: i32) -> f64 {
    f64::from(hundredths) / 100.0
}

/// CL data of the acts.
fn cl(acts: &[Act], units: LengthUnit) -> Cl {
    let mut cl = Cl { units, ..Cl::default() };
    let origin = cl.origins.push(Origin { span: Span::new(FileId(0), 0, 5), calls: Vec::new() });
    let tool = cl.tools.push(Tool { flutes: Some(2), ..Tool::flat("T1", 10.0, Some(1), origin) });
    let mut kinds = vec![
        RecordKind::LoadTool(tool),
        RecordKind::Spindle(Spindle::on(1200.0, true)),
        RecordKind::Feed(Feed::PerMinute(300.0)),
        RecordKind::Rapid(Point3::new(0.0, 0.0, 30.0)),
    ];
    let mut at = Point3::new(0.0, 0.0, 30.0);
    for act in acts {
        at = add(act, at, &mut kinds);
    }
    kinds.push(RecordKind::Rapid(Point3::new(at.x, at.y, 60.0)));
    cl.records = kinds.into_iter().map(|kind| Record { kind, origin }).collect();
    cl
}

fn add(act: &Act, at: Point3, kinds: &mut Vec<RecordKind>) -> Point3 {
    match act {
        Act::Rapid(p) | Act::Linear(p) => {
            let to = Point3::new(mm(p[0]), mm(p[1]), mm(p[2]));
            let rapid = matches!(act, Act::Rapid(_));
            kinds.push(if rapid { RecordKind::Rapid(to) } else { RecordKind::Linear(to) });
            to
        }
        Act::Round { axis, radius, start, sweep, rise, clockwise } => {
            let mut along = Vec3::zeros();
            along[*axis] = if *clockwise { -1.0 } else { 1.0 };
            let (mut u, r) = (Vec3::zeros(), f64::from(*radius) / 100.0);
            let (s, c) = sin_cos(f64::from(*start) * TAU / 360.0);
            u[(*axis + 1) % 3] = c;
            u[(*axis + 2) % 3] = s;
            let v = along.cross(&u);
            let centre = at - u * r;
            let (s, c) = sin_cos(f64::from(*sweep) * TAU / 360.0);
            let whole = *sweep == 360;
            let flat = if whole { at } else { centre + (u * c + v * s) * r };
            let to = flat + along * mm(*rise);
            kinds.push(RecordKind::Circle(Box::new(Circle {
                to,
                centre,
                axis: along,
                turns: 0,
                tolerance: 0.01,
            })));
            to
        }
        Act::Curve { points, inner, level } => curve(points, inner, *level, at, kinds),
        Act::Holes { kind, depth, initial, at: places } => {
            holes(*kind, mm(*depth), *initial, places, at, kinds)
        }
        Act::Dwell(tenths) => {
            kinds.push(RecordKind::Dwell(f64::from(*tenths) / 10.0));
            at
        }
        Act::Feed(feed) => {
            kinds.push(RecordKind::Feed(Feed::PerMinute(f64::from(*feed))));
            at
        }
        Act::Coolant(which) => {
            kinds.push(RecordKind::Coolant(
                [Coolant::Off, Coolant::Flood, Coolant::Mist][usize::from(*which % 3)],
            ));
            at
        }
    }
}

/// A spline from `at`; the intervals between its knots are as `inner` says, all the same where that is 25 or more.
fn curve(points: &[[i32; 3]], inner: &[u32], level: bool, at: Point3, kinds: &mut Vec<RecordKind>) -> Point3 {
    let mut control = vec![at];
    // As curves of CAM systems do, they go on in one direction and do not turn back on themselves.
    let mut x = at.x;
    for p in points {
        x += 5.0 + mm(p[0]).abs() / 10.0;
        control.push(Point3::new(x, mm(p[1]) / 2.0, if level { at.z } else { mm(p[2]) }));
    }
    let even = inner.first().is_some_and(|i| *i >= 25);
    let mut knots = vec![0.0; 3];
    let mut knot = 0.0;
    for interval in inner.iter().cycle().take(control.len() - 2) {
        knots.push(knot);
        knot += if even { 1.0 } else { f64::from(*interval) };
    }
    let last = knots.last().copied().unwrap_or(0.0);
    knots.extend([last; 3]);
    let spline = Spline::new(control, knots, 0.01).expect("a spline");
    let end = spline.end();
    kinds.push(RecordKind::Spline(Box::new(spline)));
    end
}

fn holes(
    kind: u8,
    depth: f64,
    initial: bool,
    places: &[[i32; 2]],
    at: Point3,
    kinds: &mut Vec<RecordKind>,
) -> Point3 {
    let kind = match kind {
        0 => CycleKind::Drill,
        1 => CycleKind::Dwell,
        2 => CycleKind::Deep,
        3 => CycleKind::ChipBreak,
        4 => CycleKind::Bore,
        5 => CycleKind::BoreDwell,
        6 => CycleKind::BoreStop,
        _ => CycleKind::Tap { pitch: 1.5, left: false },
    };
    let pecks = matches!(kind, CycleKind::Deep | CycleKind::ChipBreak);
    let dwells = matches!(kind, CycleKind::Dwell | CycleKind::BoreDwell);
    let cycle = Cycle {
        kind,
        depth,
        clearance: 2.0,
        retract: if initial { RetractTo::Initial } else { RetractTo::Clearance },
        peck: pecks.then_some(4.5),
        first_peck: None,
        dwell: dwells.then_some(0.5),
        feed: Feed::PerMinute(150.0),
    };
    kinds.push(RecordKind::Rapid(Point3::new(at.x, at.y, 30.0)));
    kinds.push(RecordKind::BeginCycle(Box::new(cycle)));
    let mut last = at;
    for place in places {
        last = Point3::new(mm(place[0]), mm(place[1]), 0.0);
        kinds.push(RecordKind::Hole(last));
    }
    kinds.push(RecordKind::EndCycle);
    let up = Point3::new(last.x, last.y, 30.0);
    kinds.push(RecordKind::Rapid(up));
    up
}

/// All posts that random programs are made for.
fn posts() -> impl Iterator<Item = &'static str> {
    builtin_names().chain(examples::names())
}

/// What a post makes of CL data.
struct Written {
    target: TargetProgram,
    emitted: Emitted,
    control: String,
}

/// Lowers and writes; nothing when lowering refuses the program.
fn written(post: &str, cl: &Cl) -> Option<Written> {
    let dialect = examples::any(post);
    let capabilities = dialect.capabilities(cl.units, None).expect("capabilities");
    let target = crate::lower::lower(cl, &capabilities, &mut Sink::default())?;
    let written = write(&dialect, &target, &cl.origins).expect("a text");
    let emitted = Emitted { text: written.text, lines: written.lines };
    Some(Written { target, emitted, control: dialect.control().to_owned() })
}

/// Lowers, writes and proves; the messages when the proof fails, nothing when lowering refuses the program.
fn trouble(post: &str, cl: &Cl) -> Option<String> {
    let Written { target, emitted, control } = written(post, cl)?;
    let text = emitted.text.clone();
    let mut sink = Sink::default();
    let proven = prove(cl, &target, emitted, &control, &mut sink);
    proven.is_none().then(|| {
        let said: String = sink.items().iter().map(|d| format!("{} {}\n", d.code.id, d.message)).collect();
        format!("{post}:\n{said}\n{text}")
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_for_any_post_reads_back_as_asked(acts in acts(), inch in any::<bool>()) {
        let cl = cl(&acts, if inch { LengthUnit::Inch } else { LengthUnit::Millimetre });
        for post in posts() {
            if let Some(trouble) = trouble(post, &cl) {
                prop_assert!(false, "{}", trouble);
            }
        }
    }
}

/// Programs that were found at random and went wrong once.
#[test]
fn what_went_wrong_once_reads_back_as_asked() {
    let helix = Act::Round { axis: 2, radius: 543, start: 213, sweep: 62, rise: -1, clockwise: true };
    let cl = cl(&[helix], LengthUnit::Inch);
    for post in posts() {
        assert_eq!(trouble(post, &cl), None);
    }
}

/// Curves that nearly turn back on themselves, found at random.
#[test]
fn curves_that_turn_back_are_proven_for_every_post() {
    let narrow = [[-27.97, 82.17], [21.96, -64.28], [24.1, -58.6], [0.0, 0.0]];
    let hairpin = [[-22.57, 64.54], [22.32, -53.05], [0.0, -13.03], [0.0, 0.0]];
    for (points, inner) in [(narrow, 9.0), (hairpin, 5.0)] {
        let mut cl = cl(&[], LengthUnit::Millimetre);
        let mut control = vec![Point3::new(0.0, 0.0, 30.0)];
        control.extend(points.map(|[x, y]| Point3::new(x, y, 30.0)));
        let knots = vec![0.0, 0.0, 0.0, 0.0, inner, inner + 7.0, inner + 7.0, inner + 7.0, inner + 7.0];
        let spline = Spline::new(control, knots, 0.01).expect("a spline");
        let origin = cl.records[0].origin;
        let kind = RecordKind::Spline(Box::new(spline));
        cl.records.insert(cl.records.len() - 1, Record { kind, origin });
        for post in posts() {
            assert_eq!(trouble(post, &cl), None);
        }
    }
}

/// The words of curves, each changed by 0.05.
fn damaged(text: &str, lines: core::ops::Range<usize>) -> Vec<String> {
    let mut all = Vec::new();
    for n in lines {
        let line = text.lines().nth(n).expect("a line");
        let told = |w: &&str| w.starts_with(['X', 'Y', 'Z', 'K', 'R', 'I', 'J', 'P', 'Q', ',']);
        // POLY has three numbers in brackets.
        let split = line.replace(',', " ,");
        let line = split.as_str();
        for word in line.split(' ').filter(told).filter(|w| *w != "POLY") {
            let name = if word.starts_with('K') && word.get(2..3).is_some_and(|c| "XYZ".contains(c)) {
                3
            } else {
                0
            };
            let digits =
                name + word[name..].find(|c: char| c.is_ascii_digit() || "+-".contains(c)).expect("a number");
            let end = word.find([')', 'E']).unwrap_or(word.len());
            let value: f64 = word[digits..end].parse().expect("a number");
            let other = format!("{}{:+.4}{}", &word[..digits], value + 0.05, &word[end..]);
            let other = line.replacen(word, &other, 1);
            let lines = text.lines().enumerate().map(|(i, l)| if i == n { other.as_str() } else { l });
            all.push(lines.collect::<Vec<_>>().join("\n") + "\n");
        }
    }
    all
}

#[test]
fn a_curve_with_a_wrong_word_is_found() {
    let level = [[1000, 0, 0], [2000, 1500, 0], [3000, 0, 0], [4000, 0, 0], [5000, 500, 0]];
    let climbing = [[1000, 0, 100], [2000, 1500, 0], [3000, 0, -200], [4000, 0, -300], [5000, 500, -500]];
    let cases = [("linuxcnc", level), ("fanuc", level), ("sinumerik", level), ("fanuc", climbing)];
    let climb = ["mitsubishi", "sinumerik", "itnc530", "sinumerik_poly"].map(|post| (post, climbing));
    let flat = ["itnc530", "sinumerik_poly", "linuxcnc_g5"].map(|post| (post, level));
    for (post, points) in cases.into_iter().chain(climb).chain(flat) {
        for inner in [vec![25; 9], vec![3, 7, 5, 2, 9]] {
            let act = Act::Curve { points: points.to_vec(), inner, level: points == level };
            let cl = cl(&[Act::Linear([0, 0, 500]), act], LengthUnit::Millimetre);
            let Written { target, emitted, control } = written(post, &cl).expect("a program");
            let curves = target.blocks.iter().zip(&emitted.lines);
            let curves = curves.filter(|(b, _)| matches!(b.kind, BlockKind::Motion(Motion::Nurbs { .. })));
            let mut tried = 0;
            for (_, (from, to)) in curves {
                for text in damaged(&emitted.text, *from as usize - 1..*to as usize - 1) {
                    let other = Emitted { text: text.clone(), lines: emitted.lines.clone() };
                    let proven = prove(&cl, &target, other, &control, &mut Sink::default());
                    assert!(proven.is_none(), "{post}: {text}");
                    tried += 1;
                }
            }
            assert!(tried >= 10, "{post}: {tried}");
        }
    }
}
