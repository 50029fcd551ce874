//! Random programs of lines, arcs, holes and dwells, for every post: what is lowered and written must be proven.

use proptest::prelude::*;

use crate::cl::{Circle, Cl, Cycle, CycleKind, Record, RecordKind, RetractTo};
use crate::diag::Sink;
use crate::geom::{Point3, Vec3};
use crate::ir::{Coolant, Feed, Origin, Spindle, Tool};
use crate::math::{TAU, sin_cos};
use crate::post::{builtin_names, load, write};
use crate::source::{FileId, MemoryFiles, SourceMap, Span};
use crate::units::LengthUnit;

use super::{Emitted, prove};

/// One thing that a random program does.
#[derive(Debug, Clone)]
enum Act {
    Rapid([i32; 3]),
    Linear([i32; 3]),
    Round { axis: usize, radius: u32, start: u32, sweep: u32, rise: i32, clockwise: bool },
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
        RecordKind::Spindle(Spindle::On { rpm: 1200.0, clockwise: true }),
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

/// Lowers, writes and proves; the messages when the proof fails, nothing when lowering refuses the program.
fn trouble(post: &str, cl: &Cl) -> Option<String> {
    let dialect = load(post, &MemoryFiles::default(), &mut SourceMap::default()).expect("a built-in post");
    let capabilities = dialect.capabilities(cl.units, None).expect("capabilities");
    let mut sink = Sink::default();
    let target = crate::lower::lower(cl, &capabilities, &mut sink)?;
    let written = write(&dialect, &target, &cl.origins).expect("a text");
    let emitted = Emitted { text: written.text.clone(), lines: written.lines };
    let mut sink = Sink::default();
    let proven = prove(cl, &target, emitted, dialect.control(), &mut sink);
    proven.is_none().then(|| {
        let said: String = sink.items().iter().map(|d| format!("{} {}\n", d.code.id, d.message)).collect();
        format!("{post}:\n{said}\n{}", written.text)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_for_any_post_reads_back_as_asked(acts in acts(), inch in any::<bool>()) {
        let cl = cl(&acts, if inch { LengthUnit::Inch } else { LengthUnit::Millimetre });
        for post in builtin_names() {
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
    for post in builtin_names() {
        assert_eq!(trouble(post, &cl), None);
    }
}
