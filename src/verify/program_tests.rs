//! Whole programs: lowered, written, read back and proven; and the same texts damaged.

use std::sync::Arc;

use crate::arena::Arena;
use crate::cl::{Cl, Contour, Guard, Lead, Operation, Record, RecordKind, Wall};
use crate::diag::{Code, Sink};
use crate::geom::curve::{CurveRef, Ends, Offset, Reversed, Spline};
use crate::geom::{Point2, Point3, Side};
use crate::ir::{Band, Feed, Interpolation, Machine, Origin, Rotary, Spindle, Tool};
use crate::math::{TAU, sin_cos};
use crate::post::{Dialect, examples, write};
use crate::readback::{self, EventKind, TraceMove, TracePath};
use crate::source::{FileId, Span};
use crate::target::{BlockKind, Motion, TargetProgram};

use crate::units::LengthUnit;

use super::{Emitted, Proven, prove};

/// An egg of about 40 by 50 mm, counter-clockwise: the finished part.
fn egg() -> CurveRef {
    let points: Vec<Point2> = (0..24)
        .map(|i| {
            let t = TAU * f64::from(i) / 24.0;
            let (s, c) = sin_cos(t);
            let r = 22.0 + 3.0 * c + sin_cos(2.0 * t).1;
            Point2::new(r * c, r * s)
        })
        .collect();
    Arc::new(Spline::new(&points, Ends::Periodic).expect("a spline"))
}

fn origin(arena: &mut Arena<Origin>, at: usize) -> crate::arena::Handle<Origin> {
    arena.push(Origin { span: Span::new(FileId(0), at, at + 5), calls: Vec::new() })
}

fn tool(origin: crate::arena::Handle<Origin>) -> Tool {
    Tool { flutes: Some(2), ..Tool::flat("T1", 10.0, Some(1), origin) }
}

/// The egg's wall cut in two levels.
pub(super) fn cl(interpolation: Interpolation, band: Band) -> Cl {
    let mut cl = Cl::default();
    let at = origin(&mut cl.origins, 10);
    let tool = cl.tools.push(tool(at));
    let centre: CurveRef = Arc::new(Offset::new(egg(), -5.0));
    let curve: CurveRef = Arc::new(Reversed::new(centre.clone()));
    let guard = Guard {
        walls: vec![Wall { centre, part: Side::Left }],
        blank_radius: Some(40.0),
        bottom: -4.0,
        ..Guard::default()
    };
    cl.operations.push(Operation {
        name: "FINISH".to_owned(),
        kind: "PROFIL",
        origin: at,
        band,
        guard,
        effort: None,
    });
    let contour = Contour {
        curve,
        part: Side::Right,
        band,
        interpolation,
        exact_dwells: false,
        levels: vec![-2.0, -4.0],
        entry: Lead::Arc(4.0),
        exit: Lead::Arc(4.0),
        clearance: 5.0,
        approach: 1.0,
        plunge_feed: Some(120.0),
        start: None,
    };
    let kinds = [
        RecordKind::LoadTool(tool),
        RecordKind::Spindle(Spindle::on(1200.0, true)),
        RecordKind::Feed(Feed::PerMinute(300.0)),
        RecordKind::BeginOperation(0),
        RecordKind::Contour(Box::new(contour)),
        RecordKind::EndOperation(0),
        RecordKind::Rapid(Point3::new(0.0, 0.0, 20.0)),
    ];
    cl.records = kinds.into_iter().map(|kind| Record { kind, origin: at }).collect();
    cl
}

pub(super) struct Built {
    pub cl: Cl,
    pub target: TargetProgram,
    pub emitted: Emitted,
    pub control: String,
}

fn dialect(name: &str) -> Dialect {
    examples::any(name)
}

pub(super) fn built(post: &str, interpolation: Interpolation, band: Band, unit: LengthUnit) -> Built {
    let mut cl = cl(interpolation, band);
    cl.units = unit;
    let dialect = dialect(post);
    let machine = (interpolation == Interpolation::RTheta).then(|| Machine {
        post: post.to_owned(),
        rotary: Some(Rotary { letter: None, reversed: false }),
        options: Vec::new(),
        origin: cl.operations[0].origin,
    });
    let capabilities = dialect.capabilities(unit, machine.as_ref()).expect("capabilities");
    let mut sink = Sink::default();
    let target = crate::lower::lower(&cl, &capabilities, &mut sink);
    let target = target.unwrap_or_else(|| panic!("{post}: {:#?}", sink.items()));
    let written = write(&dialect, &target, &cl.origins).expect("a text");
    let emitted = Emitted { text: written.text, lines: written.lines };
    Built { cl, target, emitted, control: dialect.control().to_owned() }
}

impl Built {
    /// Proves this program with another text in its place.
    pub fn prove(&self, text: &str) -> (Option<Proven>, Vec<&'static Code>, String) {
        let mut sink = Sink::default();
        let emitted = Emitted { text: text.to_owned(), lines: self.emitted.lines.clone() };
        let proven = prove(&self.cl, &self.target, emitted, &self.control, &mut sink);
        let said = sink.items().iter().map(|d| format!("{} {}\n", d.code.id, d.message)).collect();
        (proven, sink.items().iter().map(|d| d.code).collect(), said)
    }
}

const BAND: Band = Band { into: 0.01, out: 0.01 };

fn proven(post: &str, interpolation: Interpolation, band: Band, unit: LengthUnit) -> Proven {
    let built = built(post, interpolation, band, unit);
    let (proven, _, said) = built.prove(&built.emitted.text);
    proven.unwrap_or_else(|| panic!("{post} {interpolation:?} {unit:?}:\n{said}\n{}", built.emitted.text))
}

#[test]
fn good_programs_are_proven() {
    use Interpolation::{Circular, Linear, RTheta};
    for (post, interpolation) in [
        ("linuxcnc", Linear),
        ("linuxcnc", Circular),
        ("linuxcnc", RTheta),
        ("fanuc", Linear),
        ("fanuc", Circular),
        ("fanuc", RTheta),
        ("grbl", Linear),
        ("grbl", Circular),
    ] {
        for unit in [LengthUnit::Millimetre, LengthUnit::Inch] {
            let proven = proven(post, interpolation, BAND, unit);
            let operation = &proven.certificate().operations[0];
            let (into, out) = (operation.into.expect("measured"), operation.out.expect("measured"));
            assert_eq!(operation.pieces.len(), 2);
            assert!(into.value <= 0.01 + 1e-6 && out.value <= 0.01 + 1e-6, "{operation:?}");
            assert!(into.value + out.value > 0.001, "a fit that uses the band: {operation:?}");
        }
    }
}

#[test]
fn spline_programs_are_proven() {
    for post in ["linuxcnc", "fanuc", "sinumerik"].into_iter().chain(examples::exact()) {
        for unit in [LengthUnit::Millimetre, LengthUnit::Inch] {
            let proven = proven(post, Interpolation::Nurbs, BAND, unit);
            assert!(proven.certificate().moves.nurbs > 0);
        }
    }
}

/// Whether two texts make the machine do the same, within what verification promises.
fn same_motion(a: &str, b: &str, built: &Built) -> bool {
    let setup = super::setup(&built.target);
    let moves = |text: &str| {
        let trace = readback::run(text.as_bytes(), &built.control, &setup).expect("a control");
        let faultless = trace.faults.is_empty() && trace.assumed.is_empty();
        let moves: Vec<_> = trace
            .events
            .into_iter()
            .filter_map(|e| if let EventKind::Move(m) = e.kind { Some(m) } else { None })
            .filter(|m| m.length() > 0.0)
            .collect();
        faultless.then_some(moves)
    };
    let (Some(a), Some(b)) = (moves(a), moves(b)) else { return false };
    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| same_move(a, b))
}

fn same_move(a: &TraceMove, b: &TraceMove) -> bool {
    let near = |p: Point3, q: Point3| (p - q).norm() <= 1e-6;
    let shape = match (&a.path, &b.path) {
        (TracePath::Arc { centre: c, sweep: s, .. }, TracePath::Arc { centre: d, sweep: t, .. }) => {
            (c - d).norm() <= 0.02 && (s - t).abs() < 0.01
        }
        (TracePath::Nurbs { points: p, .. }, TracePath::Nurbs { points: q, .. }) => p.len() == q.len(),
        (p, q) => core::mem::discriminant(p) == core::mem::discriminant(q),
    };
    let feed = match (a.feed, b.feed) {
        (Some(f), Some(g)) => (f - g).abs() <= 0.025 * f,
        (f, g) => f == g,
    };
    let state = a.rapid == b.rapid && (a.spindle - b.spindle).abs() < 1.1 && a.tool == b.tool;
    near(a.end(), b.end()) && near(a.start(), b.start()) && shape && feed && state
}

/// Damages of one word: another digit, another sign, the word gone, the word of the other sense.
fn damaged(word: &str) -> Vec<String> {
    let mut out = vec![String::new()];
    let (letter, number) = word.split_at(1);
    for (i, c) in number.char_indices().filter(|(_, c)| c.is_ascii_digit()) {
        let other = char::from(b'0' + (c as u8 - b'0' + 1) % 10);
        out.push(format!("{letter}{}{other}{}", &number[..i], &number[i + 1..]));
    }
    out.push(number.strip_prefix('-').map_or(format!("{letter}-{number}"), |n| format!("{letter}{n}")));
    out.push(format!("{letter}{}", number.replace('.', "")));
    out
}

fn damage_every_word(post: &str, interpolation: Interpolation) {
    let built = built(post, interpolation, BAND, LengthUnit::Millimetre);
    let text = &built.emitted.text;
    let mut tried = 0;
    let comment = |line: &str| line.starts_with('(') || line.starts_with('%');
    for (n, line) in text.lines().enumerate().filter(|(_, line)| !comment(line)) {
        for word in line.split(' ') {
            for other in damaged(word) {
                let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
                lines[n] = line
                    .split(' ')
                    .map(|w| if w == word { other.clone() } else { w.to_owned() })
                    .collect::<Vec<_>>()
                    .join(" ");
                let damaged = lines.join("\n") + "\n";
                let (proven, ..) = built.prove(&damaged);
                tried += 1;
                // A retract that goes up a little before it goes home is still a retract.
                let retract = line.contains("G28") && word.starts_with('Z');
                assert!(
                    proven.is_none() || retract || same_motion(text, &damaged, &built),
                    "{post} {interpolation:?}: line {}: {line}: {word} became '{other}' and was proven",
                    n + 1
                );
            }
        }
    }
    assert!(tried > 300, "{tried}");
}

#[test]
fn every_damaged_word_is_found() {
    damage_every_word("linuxcnc", Interpolation::Circular);
    damage_every_word("fanuc", Interpolation::Circular);
    damage_every_word("linuxcnc", Interpolation::RTheta);
    damage_every_word("grbl", Interpolation::Circular);
}

#[test]
fn every_missing_doubled_or_swapped_line_is_found() {
    for (post, interpolation) in [
        ("linuxcnc", Interpolation::Linear),
        ("fanuc", Interpolation::RTheta),
        ("grbl", Interpolation::Circular),
    ] {
        let built = built(post, interpolation, BAND, LengthUnit::Millimetre);
        let text = &built.emitted.text;
        let lines: Vec<&str> = text.lines().collect();
        for n in 0..lines.len() {
            let mut missing = lines.clone();
            missing.remove(n);
            let mut doubled = lines.clone();
            doubled.insert(n, lines[n]);
            let mut swapped = lines.clone();
            swapped.swap(n, (n + 1) % lines.len());
            for damaged in [missing, doubled, swapped] {
                let damaged = damaged.join("\n") + "\n";
                let (proven, ..) = built.prove(&damaged);
                assert!(
                    proven.is_none() || same_motion(text, &damaged, &built),
                    "{post} {interpolation:?}: line {}: {} was proven",
                    n + 1,
                    lines[n]
                );
            }
        }
    }
}

/// A lowered program whose fit is wrong, written faithfully: only the geometry can tell.
fn prove_bent(built: &Built, post: &str, bend: impl Fn(&mut TargetProgram)) -> (bool, Vec<&'static str>) {
    let mut target = built.target.clone();
    bend(&mut target);
    let written = write(&dialect(post), &target, &built.cl.origins).expect("a text");
    let mut sink = Sink::default();
    let emitted = Emitted { text: written.text, lines: written.lines };
    let proven = prove(&built.cl, &target, emitted, &built.control, &mut sink).is_some();
    let mut codes: Vec<&str> = sink.items().iter().map(|d| d.code.id).collect();
    codes.sort_unstable();
    codes.dedup();
    (proven, codes)
}

fn motions(target: &mut TargetProgram) -> impl Iterator<Item = &mut Motion> {
    target.blocks.iter_mut().filter(|b| b.piece.is_some()).filter_map(|b| match &mut b.kind {
        BlockKind::Motion(motion) => Some(motion),
        _ => None,
    })
}

#[test]
fn every_vertex_bent_out_of_the_band_is_found() {
    let built = built("grbl", Interpolation::Linear, BAND, LengthUnit::Millimetre);
    let count = motions(&mut built.target.clone()).count();
    assert!(count > 100);
    for n in 0..count {
        let bend = |target: &mut TargetProgram| {
            if let Some(Motion::Line { to, .. }) = motions(target).nth(n) {
                // 30 µm radially, three times the band.
                #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]
                let radial =
                    |v: i64, w: i64| (v as f64 * 0.03e3 / ((v * v + w * w) as f64).sqrt()).round() as i64;
                let by = [radial(to.x, to.y), radial(to.y, to.x)];
                to.x += by[0];
                to.y += by[1];
            }
        };
        let (proven, codes) = prove_bent(&built, "grbl", bend);
        assert!(!proven && codes.contains(&"E0801"), "vertex {n}: {codes:?}");
    }
}

#[test]
fn a_contour_left_out_in_part_is_found() {
    let built = built("fanuc", Interpolation::Circular, BAND, LengthUnit::Millimetre);
    let (proven, codes) = prove_bent(&built, "fanuc", |target| {
        let last = target.blocks.iter().rposition(|b| b.piece.is_some()).expect("a piece");
        target.blocks.remove(last);
    });
    assert!(!proven && codes.contains(&"E0803"), "{codes:?}");
}

#[test]
fn rapids_through_stock_and_leads_into_the_wall_are_found() {
    let built = built("fanuc", Interpolation::Circular, BAND, LengthUnit::Millimetre);
    let (proven, codes) = prove_bent(&built, "fanuc", |target| {
        for block in &mut target.blocks {
            if let BlockKind::Motion(Motion::Rapid { to, .. }) = &mut block.kind
                && to.z == 5000
            {
                to.z = -1000;
            }
        }
    });
    assert!(!proven && codes.contains(&"E0804"), "{codes:?}");
    let (proven, codes) = prove_bent(&built, "fanuc", |target| {
        let first = target.blocks.iter().position(|b| b.piece.is_some()).expect("a piece");
        for block in &mut target.blocks[first - 4..first] {
            if let BlockKind::Motion(Motion::Rapid { to, .. } | Motion::Line { to, .. }) = &mut block.kind {
                (to.x, to.y) = (0, 0);
            }
        }
    });
    assert!(!proven && codes.contains(&"E0805"), "{codes:?}");
}

#[test]
fn travel_limits_hold() {
    let built = built("grbl", Interpolation::Circular, BAND, LengthUnit::Millimetre);
    let (proven, codes) = prove_bent(&built, "grbl", |target| {
        target.capabilities.travel = [Some((-30.0, 100.0)), None, None];
    });
    assert!(proven, "{codes:?}");
    let (proven, codes) = prove_bent(&built, "grbl", |target| {
        target.capabilities.travel = [Some((-20.0, 100.0)), None, None];
    });
    assert!(!proven && codes == ["E0808"], "{codes:?}");
}

#[test]
fn a_cut_in_another_work_offset_is_found() {
    for (post, asked, other) in [
        ("fanuc", "G54", "G55"),
        ("linuxcnc", "G54", "G59.1"),
        ("grbl", "G54", "G56"),
        ("haas", "G54", "G154 P1"),
        ("okuma", "G15 H1", "G15 H2"),
    ] {
        let built = built(post, Interpolation::Circular, BAND, LengthUnit::Millimetre);
        let text = built.emitted.text.replacen(asked, other, 1);
        assert_ne!(text, built.emitted.text, "{post}");
        let (proven, codes, said) = built.prove(&text);
        assert!(proven.is_none() && codes.iter().any(|code| code.id == "E0812"), "{post}: {said}");
    }
}
