//! Roughing plans against an independent simulation: the stock as cells of a square grid, the cutter as a disc
//! that walks along what was planned. Nothing of the planner's own geometry is used to judge it.

use std::sync::Arc;

use super::moves::{Move, Plan};
use super::{Job, best_plan, circles, rings};
use crate::geom::cam::{Cam, CamDefinition};
use crate::geom::curve::{CurveRef, Ends, PlanarCurve, Reversed, Spline};
use crate::geom::follower::Follower;
use crate::geom::motion::{Law, Motion, Segment, SegmentLaw};
use crate::geom::{Point2, Side, Vec2, cross};
use crate::ir::{Band, Flank};
use crate::math::{PI, TAU, sin_cos};
use crate::plan::room::Samples;
use crate::units::Angle;

/// Edge of a cell, mm.
const CELL: f64 = 0.1;
/// Step of the disc along the path, mm.
const STRIDE: f64 = 0.2;

/// Profile of a cam whose flat follower rises `lift` mm over the base radius, `lobes` times a turn: the
/// envelope P = (base + s) u + s' n.
fn flat_faced(base: f64, lift: f64, lobes: u32) -> CurveRef {
    let points: Vec<Point2> = (0..720)
        .map(|i| {
            let t = TAU * f64::from(i) / 720.0;
            let m = f64::from(lobes);
            let (s, v) =
                (0.5 * lift * (1.0 - crate::math::cos(m * t)), 0.5 * lift * m * crate::math::sin(m * t));
            let (sin, cos) = sin_cos(t);
            Point2::from(Vec2::new(cos, sin) * (base + s) + Vec2::new(-sin, cos) * v)
        })
        .collect();
    Arc::new(Spline::new(&points, Ends::Periodic).expect("points differ"))
}

/// The cam of Kim & Yang: base circle 20, roller 8, lift 20, modified sine.
fn paper_cam() -> CurveRef {
    crate::plan::tests::paper_cam(false).flank(Flank::Inner)
}

/// A cam whose roller rises three times a turn, with hollows between the lobes.
fn hollow_cam() -> CurveRef {
    let law = SegmentLaw::Law(Law::by_name("MODSIN").expect("a law"));
    let sixty = Angle::degrees(60.0);
    let segments = (0..6)
        .map(|i| if i % 2 == 0 { Segment::rise(sixty, 24.0, law) } else { Segment::fall(sixty, 24.0, law) });
    let motion = Motion::from_segments(segments.collect()).expect("closes");
    let follower = Follower::TranslatingRoller { radius: 6.0, offset: 0.0 };
    Cam::new(CamDefinition::new(24.0, follower, motion)).expect("a cam").flank(Flank::Inner)
}

fn job(profile: CurveRef, blank: f64, cutter: f64, step: f64, leave: f64, part: Side) -> Job {
    let profile: CurveRef = if part == Side::Left { profile } else { Arc::new(Reversed::new(profile)) };
    Job {
        samples: Samples::new(profile.as_ref()),
        profile,
        part,
        blank,
        outside: blank + cutter + 1.0,
        cutter,
        step,
        leave,
        band: Band { into: 0.01, out: 0.01 },
    }
}

/// The stock in cells.
struct Field {
    size: i32,
    solid: Vec<bool>,
}

impl Field {
    fn round(radius: f64) -> Field {
        let size = (radius / CELL) as i32 + 2;
        let width = (2 * size + 1) as usize;
        let mut solid = vec![false; width * width];
        for (i, cell) in solid.iter_mut().enumerate() {
            let (x, y) = ((i % width) as f64 - f64::from(size), (i / width) as f64 - f64::from(size));
            *cell = (x * x + y * y) * CELL * CELL < radius * radius;
        }
        Field { size, solid }
    }
    fn index(&self, x: i32, y: i32) -> Option<usize> {
        let inside = x.abs() <= self.size && y.abs() <= self.size;
        inside.then(|| ((y + self.size) * (2 * self.size + 1) + x + self.size) as usize)
    }
    fn is_solid(&self, p: Point2) -> bool {
        self.index((p.x / CELL).round() as i32, (p.y / CELL).round() as i32).is_some_and(|i| self.solid[i])
    }
    fn cut(&mut self, c: Point2, radius: f64) {
        let reach = (radius / CELL) as i32 + 1;
        let (cx, cy) = ((c.x / CELL).round() as i32, (c.y / CELL).round() as i32);
        for y in cy - reach..=cy + reach {
            for x in cx - reach..=cx + reach {
                let (dx, dy) = (f64::from(x) * CELL - c.x, f64::from(y) * CELL - c.y);
                if dx * dx + dy * dy < radius * radius
                    && let Some(i) = self.index(x, y)
                {
                    self.solid[i] = false;
                }
            }
        }
    }
    /// Width, across the feed, of the stock that the leading half of the cutter meets at `c`.
    fn engagement(&self, c: Point2, way: Vec2, radius: f64) -> f64 {
        let across = Vec2::new(-way.y, way.x);
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        for i in 1..360 {
            let (s, k) = sin_cos(PI * f64::from(i) / 360.0);
            if self.is_solid(c + (way * s + across * k) * radius) {
                range = (range.0.min(k * radius), range.1.max(k * radius));
            }
        }
        (range.1 - range.0).max(0.0)
    }
    fn walk(&mut self, from: Point2, to: Point2, radius: f64) -> f64 {
        let d = to - from;
        let length = d.norm();
        if length < 1e-9 {
            return 0.0;
        }
        let pieces = (length / STRIDE).ceil();
        let mut most: f64 = 0.0;
        for i in 1..=pieces as i32 {
            let c = from + d * (f64::from(i) / pieces);
            most = most.max(self.engagement(c, d / length, radius));
            self.cut(c, radius);
        }
        most
    }
}

/// What the simulation saw.
struct Seen {
    field: Field,
    most: f64,
    length: f64,
}

fn simulate(job: &Job, plan: &Plan) -> Seen {
    let mut field = Field::round(job.blank);
    let (mut most, mut length) = (0.0_f64, 0.0);
    let mut at: Option<Point2> = None;
    let mut go = |field: &mut Field, from: Option<Point2>, to: Point2| {
        if let Some(from) = from {
            most = most.max(field.walk(from, to, job.cutter));
            length += (to - from).norm();
        }
    };
    for step in &plan.moves {
        match step {
            Move::Down(p) => at = Some(*p),
            Move::Up(p) => {
                go(&mut field, at, *p);
                at = None;
            }
            Move::Ramp(_) => at = None,
            Move::Link(p) => {
                go(&mut field, at, *p);
                at = Some(*p);
            }
            Move::Cut { curve, .. } => {
                for p in polyline(curve.as_ref()) {
                    go(&mut field, at, p);
                    at = Some(p);
                }
            }
        }
    }
    Seen { field, most, length }
}

fn polyline(curve: &dyn PlanarCurve) -> Vec<Point2> {
    let (a, b) = curve.domain();
    let count = (crate::geom::measure::length(curve, 1e-6) / STRIDE).ceil().max(1.0);
    (0..=count as i32).map(|i| curve.at(a + (b - a) * f64::from(i) / count).p).collect()
}

/// Distance of a point outside the profile (negative inside), by the profile's polygon.
fn outside(profile: &[Point2], p: Point2) -> f64 {
    let mut best = f64::INFINITY;
    let mut inside = false;
    for (i, &a) in profile.iter().enumerate() {
        let b = profile[(i + 1) % profile.len()];
        let x = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        best = best.min((p - (a + (b - a) * x)).norm());
        if (a.y > p.y) != (b.y > p.y) && (cross(b - a, p - a) > 0.0) == (b.y > a.y) {
            inside = !inside;
        }
    }
    if inside { -best } else { best }
}

fn check(job: &Job, plan: &Plan) {
    let seen = simulate(job, plan);
    let profile = polyline_of_profile(job);
    assert!(seen.most <= plan.engagement + 2.0 * CELL, "{} over {}", seen.most, plan.engagement);
    assert!((seen.length - plan.length()).abs() < 0.01 * plan.length(), "{} {}", seen.length, plan.length());
    for y in -seen.field.size..=seen.field.size {
        for x in -seen.field.size..=seen.field.size {
            if (x + 3 * y) % 7 != 0 {
                continue;
            }
            let p = Point2::new(f64::from(x) * CELL, f64::from(y) * CELL);
            let was = p.coords.norm() < job.blank - CELL;
            let distance = outside(&profile, p);
            let solid = seen.field.is_solid(p);
            let margin = 2.0 * CELL + job.band.out;
            assert!(!(was && distance > job.leave + margin && solid), "left at {p}, {distance} outside");
            assert!(!(was && distance < job.leave - margin && !solid), "cut at {p}, {distance} outside");
        }
    }
}

fn polyline_of_profile(job: &Job) -> Vec<Point2> {
    let (a, b) = job.profile.domain();
    (0..720).map(|i| job.profile.at(a + (b - a) * f64::from(i) / 720.0).p).collect()
}

#[test]
fn the_papers_cam_takes_less_path_than_the_papers_plan() {
    let job = job(paper_cam(), 42.0, 8.0, 2.0, 0.0, Side::Right);
    let plan = best_plan(&job).expect("a plan");
    assert!(plan.length() < 1704.8, "{}", plan.length());
    assert!(plan.engagement <= job.step + 1e-9, "{}", plan.engagement);
    check(&job, &plan);
}

#[test]
fn an_allowance_stays_on_the_part() {
    for part in [Side::Left, Side::Right] {
        let job = job(paper_cam(), 42.0, 6.0, 2.5, 0.3, part);
        let plan = best_plan(&job).expect("a plan");
        check(&job, &plan);
    }
}

#[test]
fn a_large_blank_is_cleared_by_full_circles_first() {
    let job = job(paper_cam(), 50.0, 8.0, 3.0, 0.5, Side::Right);
    let plan = best_plan(&job).expect("a plan");
    check(&job, &plan);
}

#[test]
fn valleys_between_lobes_are_cut_one_after_the_other() {
    let job = job(flat_faced(30.0, 8.0, 2), 39.0, 6.0, 1.5, 0.2, Side::Left);
    let plan = best_plan(&job).expect("a plan");
    check(&job, &plan);
}

#[test]
fn circles_clear_the_papers_cam_too() {
    for (blank, leave, part) in [(42.0, 0.0, Side::Right), (46.0, 0.4, Side::Left)] {
        let job = job(paper_cam(), blank, 8.0, 2.0, leave, part);
        let plan = circles::plan(&job).expect("seen whole from the centre");
        check(&job, &plan);
    }
}

#[test]
fn a_cam_with_hollows_narrower_than_the_rings_is_cleared_by_circles() {
    let job = job(hollow_cam(), 50.0, 6.0, 2.0, 0.2, Side::Left);
    assert!(rings::plan(&job).is_none(), "the rings have room after all");
    let plan = best_plan(&job).expect("a plan");
    check(&job, &plan);
    // Against the steep walls of these hollows the cutter meets more than the step.
    assert!(plan.engagement > job.step && plan.engagement < 1.5 * job.step, "{}", plan.engagement);
}
