//! Tests of the NURBS fit.

use super::{Knots, nurbs, nurbs_of};
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

#[test]
fn a_limit_of_points_is_kept_or_answered_with_nothing() {
    let curve = paper();
    let tube = Tube { curve: curve.as_ref(), left: 0.01, right: 0.01 };
    let grid = Grid { step: 0.001, centre_step: 0.001, angle_step: 0.001 };
    assert_eq!(nurbs_of(&tube, &grid, Knots::Uniform, None, 9), Ok(None));
    let fit = nurbs_of(&tube, &grid, Knots::Uniform, None, 30).unwrap().unwrap();
    let Primitive::Nurbs { points, .. } = &fit.primitives[0] else { panic!("{fit:?}") };
    assert!(points.len() <= 30);
}
