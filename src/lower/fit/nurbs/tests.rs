//! Tests of the NURBS fit.

use super::{Knots, nurbs, nurbs_of};
use crate::lower::fit::arcs::tests::paper;
use crate::lower::fit::{Grid, Primitive, Tube};

#[test]
fn the_cam_of_the_paper_takes_few_points_in_any_band() {
    let curve = paper();
    let bands = [((0.01, 0.01), [18, 17]), ((0.01, 0.0), [18, 27]), ((0.001, 0.001), [31, 70])];
    for ((left, right), most) in bands {
        for (knots, most) in [Knots::Printed { decimals: 4 }, Knots::Uniform].into_iter().zip(most) {
            let tube = Tube { curve: curve.as_ref(), left, right };
            let grid = Grid { step: 0.001, centre_step: 0.001, angle_step: 0.001 };
            let fit = nurbs(&tube, &grid, knots, None).expect("a curve");
            let [Primitive::Nurbs { points, .. }] = fit.primitives.as_slice() else { panic!("{fit:?}") };
            assert!(points.len() <= most, "{left} {right} {knots:?}: {} points", points.len());
            assert!(fit.deviation.0 <= left && fit.deviation.1 <= right, "{knots:?}: {:?}", fit.deviation);
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
