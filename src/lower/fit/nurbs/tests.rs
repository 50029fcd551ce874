//! Tests of the NURBS fit.

use super::{Knots, nurbs};
use crate::lower::fit::arcs::tests::paper;
use crate::lower::fit::{Grid, Primitive, Tube};

#[test]
fn probe() {
    let curve = paper();
    for (left, right) in [(0.01, 0.01), (0.01, 0.0), (0.001, 0.001)] {
        for (step, knots) in [(0.001, Knots::Printed { decimals: 4 }), (0.001, Knots::Uniform)] {
            let tube = Tube { curve: curve.as_ref(), left, right };
            let grid = Grid { step, centre_step: step, angle_step: 0.001 };
            let clock = std::time::Instant::now();
            match nurbs(&tube, &grid, knots, None) {
                Ok(fit) => {
                    let Primitive::Nurbs { points, .. } = &fit.primitives[0] else { panic!() };
                    println!(
                        "{left} {right} {step} {knots:?} points {} {:?} {:?}",
                        points.len(),
                        fit.deviation,
                        clock.elapsed()
                    );
                }
                Err(e) => panic!("{left} {right} {step} {knots:?}: {e}"),
            }
        }
    }
}
