//! Planning of programs built by hand: no source text is involved.

use super::plan;
use crate::arena::Handle;
use crate::cl::print::print;
use crate::cl::{Cl, Contour, Lead, RecordKind};
use crate::diag::Sink;
use crate::geom::Side;
use crate::geom::cam::{Cam, CamDefinition};
use crate::geom::follower::Follower;
use crate::geom::motion::{Law, Motion, Segment, SegmentLaw};
use crate::ir::{
    Band, CamEntity, Cut, CutterKind, Entry, Feed, Flank, Interpolation, Origin, Profile, ProfileTarget,
    Program, RoughCam, Spindle, Step, StepKind, Stock, StockShape, Tool,
};
use crate::source::{FileId, Span};
use crate::units::Angle;

/// A program with the paper's cam, a 16 mm cutter and a round blank, to which steps are added.
pub(super) struct Bench {
    pub program: Program,
    pub origin: Handle<Origin>,
    pub cam: Handle<CamEntity>,
    pub tool: Handle<Tool>,
    pub stock: Handle<Stock>,
}

pub(super) fn paper_motion(lift: f64) -> Motion {
    let law = SegmentLaw::Law(Law::by_name("MODSIN").expect("a law"));
    let deg = Angle::degrees;
    Motion::from_segments(vec![
        Segment::dwell(deg(30.0)),
        Segment::rise(deg(120.0), lift, law),
        Segment::dwell(deg(60.0)),
        Segment::fall(deg(120.0), lift, law),
        Segment::dwell(deg(30.0)),
    ])
    .expect("closes")
}

pub(super) fn paper_cam(groove: bool) -> Cam {
    let follower = Follower::TranslatingRoller { radius: 8.0, offset: 0.0 };
    let definition = CamDefinition { groove, ..CamDefinition::new(20.0, follower, paper_motion(20.0)) };
    Cam::new(definition).expect("the paper's cam exists")
}

impl Bench {
    pub fn new(cam: Cam, diameter: f64) -> Bench {
        let mut program = Program { title: Some("TEST".to_owned()), ..Program::default() };
        let span = Span::new(FileId(0), 0, 1);
        let origin = program.origins.push(Origin { span, calls: Vec::new() });
        let cam = program.cams.push(CamEntity { name: "C1".to_owned(), cam, origin });
        let tool = program.tools.push(tool(diameter, origin));
        let shape = StockShape::Round { radius: 42.0, height: Some(10.0) };
        let stock = program.stocks.push(Stock { name: "B1".to_owned(), shape, origin });
        Bench { program, origin, cam, tool, stock }
    }
    /// Tool, spindle and feed.
    pub fn ready(cam: Cam, diameter: f64) -> Bench {
        let mut bench = Bench::new(cam, diameter);
        let tool = bench.tool;
        bench
            .add(StepKind::LoadTool(tool))
            .add(StepKind::Spindle(Spindle::on(1200.0, true)))
            .add(StepKind::Feed(Feed::PerMinute(300.0)));
        bench
    }
    pub fn add(&mut self, kind: StepKind) -> &mut Bench {
        self.program.steps.push(Step { kind, origin: self.origin });
        self
    }
    pub fn profile(&self, flank: Flank) -> Profile {
        Profile {
            name: None,
            target: ProfileTarget::Cam(self.cam, flank),
            interpolation: Interpolation::Auto,
            exact_dwells: false,
            cut: Cut::Climb,
            tool: self.tool,
            depth: 10.0,
            step: None,
            leave: 0.0,
            entry: Entry::TangentArc(None),
            band: Band { into: 0.01, out: 0.01 },
            clearance: 5.0,
        }
    }
    pub fn rough(&self) -> RoughCam {
        RoughCam {
            name: None,
            cam: self.cam,
            stock: self.stock,
            radial_step: 2.0,
            leave: 0.3,
            depth: 10.0,
            axial_step: None,
            cut: Cut::Climb,
            tool: self.tool,
            band: Band { into: 0.01, out: 0.01 },
            clearance: 5.0,
        }
    }
    pub fn plan(&self) -> (Option<Cl>, Vec<&'static str>) {
        let mut sink = Sink::default();
        let cl = plan(&self.program, &mut sink);
        (cl, sink.items().iter().map(|d| d.code.id).collect())
    }
}

fn tool(diameter: f64, origin: Handle<Origin>) -> Tool {
    Tool::flat("T1", diameter, Some(1), origin)
}

fn contours(cl: &Cl) -> Vec<&Contour> {
    let contour = |kind: &'_ RecordKind| matches!(kind, RecordKind::Contour(_));
    cl.records
        .iter()
        .filter(|r| contour(&r.kind))
        .filter_map(|r| if let RecordKind::Contour(c) = &r.kind { Some(c.as_ref()) } else { None })
        .collect()
}

#[test]
fn a_cam_is_profiled_on_the_parallel_curve_with_the_part_on_the_right() {
    let mut bench = Bench::ready(paper_cam(false), 16.0);
    bench.add(StepKind::Profile(bench.profile(Flank::Inner)));
    let (cl, codes) = bench.plan();
    assert_eq!(codes, [""; 0]);
    let cl = cl.expect("planned");
    let all = contours(&cl);
    assert_eq!(all.len(), 1);
    assert_eq!((all[0].part, all[0].entry), (Side::Right, Lead::Arc(8.0)));
    assert!((crate::geom::measure::length(all[0].curve.as_ref(), 1e-9) - 245.488_424).abs() < 1e-5);
    insta::assert_snapshot!(print(&cl));
}

#[test]
fn conventional_and_a_counter_clockwise_spindle_each_turn_the_path_round() {
    for (cut, clockwise, part) in [
        (Cut::Climb, true, Side::Right),
        (Cut::Climb, false, Side::Left),
        (Cut::Conventional, true, Side::Left),
        (Cut::Conventional, false, Side::Right),
    ] {
        let mut bench = Bench::ready(paper_cam(false), 16.0);
        bench.add(StepKind::Spindle(Spindle::on(900.0, clockwise)));
        bench.add(StepKind::Profile(Profile { cut, ..bench.profile(Flank::Inner) }));
        let cl = bench.plan().0.expect("planned");
        assert_eq!(contours(&cl)[0].part, part);
    }
}

#[test]
fn a_groove_is_cut_on_both_flanks_with_leads_that_fit_between_them() {
    let mut bench = Bench::ready(paper_cam(true), 12.0);
    bench.add(StepKind::Profile(bench.profile(Flank::Inner)));
    bench.add(StepKind::Profile(bench.profile(Flank::Outer)));
    let (cl, codes) = bench.plan();
    assert_eq!(codes, [""; 0]);
    let cl = cl.expect("planned");
    for contour in contours(&cl) {
        let Lead::Arc(radius) = contour.entry else { panic!("{:?}", contour.entry) };
        assert!(radius > 2.0 && radius < 4.1, "{radius}");
    }
    assert_eq!(cl.operations[0].guard.walls.len(), 2);
}

#[test]
fn what_a_cut_lacks_is_reported_all_at_once() {
    let mut bench = Bench::new(paper_cam(false), 16.0);
    bench.add(StepKind::Profile(bench.profile(Flank::Inner)));
    let (cl, codes) = bench.plan();
    assert!(cl.is_none());
    assert_eq!(codes, ["E0502", "E0503"]);
}

#[test]
fn a_feed_per_tooth_becomes_one_per_minute_when_the_flutes_are_known() {
    let mut bench = Bench::ready(paper_cam(false), 16.0);
    bench.add(StepKind::Feed(Feed::PerTooth(0.05)));
    bench.add(StepKind::Profile(bench.profile(Flank::Inner)));
    assert_eq!(bench.plan().1, ["E0504"]);
    let mut fluted = tool(16.0, bench.origin);
    fluted.flutes = Some(4);
    let fluted = bench.program.tools.push(fluted);
    let profile = Profile { tool: fluted, ..bench.profile(Flank::Inner) };
    bench.program.steps.pop();
    bench.add(StepKind::Profile(profile));
    let cl = bench.plan().0.expect("planned");
    assert!(cl.records.iter().any(|r| matches!(r.kind, RecordKind::Feed(Feed::PerMinute(f)) if f == 240.0)));
}

#[test]
fn a_cutter_as_wide_as_the_groove_plunges_and_a_wider_one_is_refused() {
    let mut bench = Bench::ready(paper_cam(true), 16.0);
    bench.add(StepKind::Profile(bench.profile(Flank::Inner)));
    let (cl, codes) = bench.plan();
    assert_eq!(codes, ["N0522"]);
    assert_eq!(contours(&cl.expect("planned"))[0].entry, Lead::Plunge);
    let mut bench = Bench::ready(paper_cam(true), 16.2);
    bench.add(StepKind::Profile(bench.profile(Flank::Inner)));
    assert_eq!(bench.plan().1, ["E0506"]);
}

#[test]
fn reach_holder_and_rounded_end_are_told() {
    let mut bench = Bench::ready(paper_cam(false), 16.0);
    let mut short = tool(16.0, bench.origin);
    (short.kind, short.length, short.stick_out) = (CutterKind::Ball, Some(8.0), Some(9.0));
    let short = bench.program.tools.push(short);
    bench.add(StepKind::Profile(Profile { tool: short, ..bench.profile(Flank::Inner) }));
    assert_eq!(bench.plan().1, ["N0521", "W0531", "E0507"]);
}

#[test]
fn a_blank_smaller_than_the_cam_and_a_square_one_are_refused() {
    let mut bench = Bench::ready(paper_cam(false), 16.0);
    let origin = bench.origin;
    let shape = StockShape::Round { radius: 40.0, height: None };
    let small = bench.program.stocks.push(Stock { name: "B2".to_owned(), shape, origin });
    bench.add(StepKind::RoughCam(RoughCam { stock: small, ..bench.rough() }));
    let corner = crate::geom::Point3::new(50.0, 50.0, 0.0);
    let shape = StockShape::Block { min: -corner, max: corner };
    let square = bench.program.stocks.push(Stock { name: "B3".to_owned(), shape, origin });
    bench.add(StepKind::RoughCam(RoughCam { stock: square, ..bench.rough() }));
    assert_eq!(bench.plan().1, ["E0508", "E0509"]);
}

#[test]
fn roughing_repeats_its_passes_on_every_level_and_tells_its_path() {
    let mut bench = Bench::ready(paper_cam(false), 16.0);
    bench.add(StepKind::RoughCam(RoughCam { axial_step: Some(4.0), ..bench.rough() }));
    let (cl, codes) = bench.plan();
    assert_eq!(codes, ["N0520"]);
    let cl = cl.expect("planned");
    let effort = cl.operations[0].effort.expect("figures");
    assert_eq!(effort.levels, 3);
    assert!(effort.bound < effort.engaged && effort.links < 0.1 * effort.engaged, "{effort:?}");
    let heights: Vec<f64> = contours(&cl).iter().map(|c| c.levels[0]).collect();
    assert_eq!(heights.len() % 3, 0);
    assert_eq!((heights[0], heights[heights.len() - 1]), (-10.0 / 3.0, -10.0));
    // A closed curve might be started elsewhere, and the way to it would cut the part.
    assert!(contours(&cl).iter().all(|c| !c.curve.is_closed()));
}
