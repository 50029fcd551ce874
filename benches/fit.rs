//! Time and block counts of the line and spiral fits: the plate cam of Kim & Yang (1991), and a growing number of blocks.
//!
//! `cargo bench --bench fit [-- NAME]`: the rows whose name contains NAME.

use std::time::{Duration, Instant};

use partwright::geom::cam::{Cam, CamDefinition, Flank};
use partwright::geom::curve::CurveRef;
use partwright::geom::follower::Follower;
use partwright::geom::motion::{Law, Motion, Segment, SegmentLaw};
use partwright::lower::fit::{self, Fit, FitError, Grid, Tube};
use partwright::units::Angle;

type Fitter = fn(&Tube, &Grid, Option<f64>) -> Result<Fit, FitError>;

/// Centre path of a cutter of radius 8 about the cam of the paper.
fn plate_cam() -> Option<CurveRef> {
    let degrees = Angle::degrees;
    let law = SegmentLaw::Law(Law::MODSIN);
    let motion = Motion::from_segments(vec![
        Segment::dwell(degrees(30.0)),
        Segment::rise(degrees(120.0), 20.0, law),
        Segment::dwell(degrees(60.0)),
        Segment::fall(degrees(120.0), 20.0, law),
        Segment::dwell(degrees(30.0)),
    ])
    .ok()?;
    let follower = Follower::TranslatingRoller { radius: 8.0, offset: 0.0 };
    let cam = Cam::new(CamDefinition::new(20.0, follower, motion)).ok()?;
    Some(cam.centre(Flank::Inner, 8.0))
}

/// Shortest of some runs.
fn time(runs: u32, tube: &Tube, grid: &Grid, fitter: Fitter) -> (Duration, Result<Fit, FitError>) {
    let mut best = Duration::MAX;
    let mut answer = fitter(tube, grid, None);
    for _ in 0..runs {
        let start = Instant::now();
        answer = fitter(tube, grid, None);
        best = best.min(start.elapsed());
    }
    (best, answer)
}

fn row(name: &str, runs: u32, tube: &Tube, grid: &Grid, fitter: Fitter) {
    if std::env::args().skip(1).any(|a| !a.starts_with('-') && !name.contains(&a)) {
        return;
    }
    let (time, answer) = time(runs, tube, grid, fitter);
    let band = format!("-{} +{}", tube.right, tube.left);
    match answer {
        Ok(f) => {
            let bound = f.lower_bound.unwrap_or(0);
            let (l, r) = f.deviation;
            println!(
                "{name:<14} {band:<16} {:>8} {bound:>8}  {l:.7} {r:.7}  {time:>10.2?}",
                f.primitives.len()
            );
        }
        Err(e) => println!("{name:<14} {band:<16} {e}  {time:.2?}"),
    }
}

fn main() {
    let Some(curve) = plate_cam() else { return };
    let mm = |decimals: u32, angle_step: f64| {
        let step = 1.0 / f64::from(10_u32.pow(decimals));
        Grid { step, centre_step: step, angle_step }
    };
    let inch = Grid { step: 0.00254, centre_step: 0.00254, angle_step: 0.001 };
    let grids = [("mm 3", mm(3, 1e-3)), ("mm 4", mm(4, 1e-3)), ("mm 5", mm(5, 1e-5)), ("inch 4", inch)];
    println!(
        "{:<14} {:<16} {:>8} {:>8}  {:<20}  {:>9}",
        "fit", "band", "blocks", "bound", "left, right", "time"
    );
    for (left, right) in [(0.01, 0.01), (0.0, 0.01), (0.01, 0.0)] {
        let tube = Tube { curve: &*curve, left, right };
        for (name, grid) in grids {
            row(&format!("lines {name}"), 20, &tube, &grid, fit::lines);
            row(&format!("spirals {name}"), 20, &tube, &grid, fit::spirals);
        }
    }
    for (band, decimals) in [(1e-4, 4), (1e-5, 5), (1e-6, 6), (1e-7, 7), (1e-8, 8)] {
        let tube = Tube { curve: &*curve, left: band, right: band };
        row(&format!("lines mm {decimals}"), 1, &tube, &mm(decimals, 1e-3), fit::lines);
    }
}
