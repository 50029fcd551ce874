use super::*;
use crate::arena::Handle;
use crate::diag::Sink;
use crate::geom::cam::{Cam, CamDefinition, Flank};
use crate::geom::follower::{ArmSide, Follower};
use crate::geom::motion::{Law, Motion, Segment, SegmentLaw};
use crate::ir::{
    Band, CamEntity, Cut, Entry, Feed, Interpolation, Machine, Origin, Profile, ProfileTarget, Program,
    Rotary, RoughCam, Spindle, Step, StepKind, Stock, StockShape, Tool,
};
use crate::source::{FileId, MemoryFiles, SourceMap, Span};
use crate::units::{Angle, LengthUnit};

fn motion(lift: f64, law: &str) -> Motion {
    let law = SegmentLaw::Law(Law::by_name(law).expect("in the table"));
    let deg = Angle::degrees;
    Motion::from_segments(vec![
        Segment::dwell(deg(30.0)),
        Segment::rise(deg(120.0), lift, law),
        Segment::dwell(deg(60.0)),
        Segment::fall(deg(120.0), lift, law),
        Segment::dwell(deg(30.0)),
    ])
    .expect("a motion")
}

fn cams() -> Vec<(&'static str, Cam)> {
    let build = |base, follower, lift, law, groove| {
        let definition = CamDefinition { groove, ..CamDefinition::new(base, follower, motion(lift, law)) };
        Cam::new(definition).expect("a cam")
    };
    let side = ArmSide::Right;
    vec![
        (
            "roller",
            build(20.0, Follower::TranslatingRoller { radius: 8.0, offset: 0.0 }, 20.0, "MODSIN", false),
        ),
        (
            "groove",
            build(25.0, Follower::TranslatingRoller { radius: 8.0, offset: 5.0 }, 15.0, "CYCLO", true),
        ),
        ("flat", build(40.0, Follower::TranslatingFlat { offset: 4.0 }, 15.0, "P345", false)),
        (
            "arm",
            build(
                30.0,
                Follower::OscillatingRoller { radius: 8.0, arm: 70.0, pivot: 80.0, side },
                0.349,
                "MODSIN",
                false,
            ),
        ),
        (
            "face",
            build(
                50.0,
                Follower::OscillatingFlat { pivot: 110.0, offset: 6.0, side },
                0.1745,
                "CYCLO",
                false,
            ),
        ),
    ]
}

/// The paper's cam, roughed and profiled.
fn program(interpolation: Interpolation) -> Program {
    let mut program = Program { title: Some("KIM AND YANG 1991".into()), ..Program::default() };
    let origin = program.origins.push(Origin { span: Span::new(FileId(0), 0, 1), calls: Vec::new() });
    if interpolation == Interpolation::RTheta {
        let rotary = Some(Rotary { letter: None, reversed: false });
        program.machines.push(Machine { post: "linuxcnc".into(), rotary, options: Vec::new(), origin });
    }
    let (_, cam) = cams().swap_remove(0);
    let cam = program.cams.push(CamEntity { name: "C1".into(), cam, origin });
    let tool = program.tools.push(tool(origin));
    let shape = StockShape::Round { radius: 42.0, height: Some(10.0) };
    let stock = program.stocks.push(Stock { name: "B1".into(), shape, origin });
    let band = Band { into: 0.01, out: 0.01 };
    let cut = Cut::Climb;
    let kinds = [
        StepKind::LoadTool(tool),
        StepKind::Spindle(Spindle::on(1200.0, true)),
        StepKind::Feed(Feed::PerMinute(300.0)),
        StepKind::RoughCam(RoughCam {
            name: None,
            cam,
            stock,
            radial_step: 2.0,
            leave: 0.3,
            depth: 10.0,
            axial_step: None,
            cut,
            tool,
            band,
            clearance: 5.0,
        }),
        StepKind::Profile(Profile {
            name: None,
            target: ProfileTarget::Cam(cam, Flank::Inner),
            interpolation,
            exact_dwells: false,
            cut,
            tool,
            depth: 10.0,
            step: None,
            leave: 0.0,
            entry: Entry::TangentArc(None),
            band,
            clearance: 5.0,
        }),
    ];
    program.steps.extend(kinds.map(|kind| Step { kind, origin }));
    program
}

fn tool(origin: Handle<Origin>) -> Tool {
    Tool::flat("T1", 16.0, Some(1), origin)
}

/// All three pictures of the lowered program.
fn pictures(interpolation: Interpolation, post: &str) -> Vec<(String, Figure)> {
    let program = program(interpolation);
    let mut sink = Sink::default();
    let cl = crate::plan::plan(&program, &mut sink).expect("planned");
    let dialect =
        crate::post::load(post, &MemoryFiles::default(), &mut SourceMap::default()).expect("built in");
    let capabilities =
        dialect.capabilities(LengthUnit::Millimetre, program.machines.first()).expect("complete");
    let target = crate::lower::lower(&cl, &capabilities, &mut sink).expect("lowered");
    [("cam", What::Cam(None)), ("path", What::Path), ("deviation", What::Deviation)]
        .into_iter()
        .map(|(name, what)| {
            (name.to_owned(), draw(&what, &program, Some(&cl), Some(&target)).expect("drawn"))
        })
        .collect()
}

fn parses(figure: &Figure) {
    let options = resvg::usvg::Options::default();
    let tree = resvg::usvg::Tree::from_str(figure.svg(), &options).expect("an SVG document");
    assert!(tree.size().width() > 100.0);
    assert!(
        !figure.svg().contains("NaN") && !figure.svg().contains("inf\"") && !figure.svg().contains("inf ")
    );
}

#[test]
fn every_kind_of_cam_gives_the_same_document_twice() {
    for (name, cam) in cams() {
        for units in [LengthUnit::Millimetre, LengthUnit::Inch] {
            let view = CamView { name, cam: &cam, units, blank: None, tracks: Vec::new() };
            let figure = super::cam(&view);
            parses(&figure);
            assert_eq!(figure, super::cam(&view));
            assert!(figure.svg().contains(if units == LengthUnit::Inch { "lift" } else { "mm" }));
        }
    }
}

#[test]
fn a_lowered_program_has_all_three_pictures() {
    let cases = [
        (Interpolation::Linear, "grbl"),
        (Interpolation::Circular, "linuxcnc"),
        (Interpolation::RTheta, "linuxcnc"),
    ];
    for (interpolation, post) in cases {
        for (_, figure) in pictures(interpolation, post) {
            parses(&figure);
        }
    }
}

#[test]
fn the_deviation_stays_in_the_band_of_the_picture() {
    for interpolation in [Interpolation::Linear, Interpolation::Circular, Interpolation::RTheta] {
        let svg = pictures(interpolation, "linuxcnc").swap_remove(2).1;
        assert!(svg.svg().contains("deviation, µm"));
        let numbers = svg.svg().split("left on the part ").nth(1).expect("a caption");
        let largest: f64 = numbers.split(' ').next().and_then(|n| n.parse().ok()).expect("a number");
        assert!(largest > 5.0 && largest <= 10.0, "{interpolation:?} {largest}");
    }
}

#[test]
fn a_png_has_the_documents_size() {
    let (_, cam) = cams().swap_remove(0);
    let view = CamView {
        name: "C1",
        cam: &cam,
        units: LengthUnit::Millimetre,
        blank: Some(42.0),
        tracks: Vec::new(),
    };
    let png = super::cam(&view).png(0.5).expect("rendered");
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!(u32::from_be_bytes([png[16], png[17], png[18], png[19]]), 740);
}

#[test]
fn what_is_not_there_is_said() {
    let empty = Program::default();
    assert_eq!(draw(&What::Cam(None), &empty, None, None), Err(PlotError::NoCam));
    assert_eq!(draw(&What::Path, &empty, None, None), Err(PlotError::NoPath));
    assert_eq!(draw(&What::Deviation, &empty, None, None), Err(PlotError::NoContour));
    let wrong = draw(&What::Cam(Some("C9".into())), &program(Interpolation::Linear), None, None);
    assert_eq!(wrong.map_err(|e| e.to_string()), Err("the program has no cam C9; it has C1".into()));
}
