//! How much an operation would be, told before it begins.

use crate::geom::surface::Net;
use crate::ir::Spacing;
use crate::math::count;
use crate::plan::show_length;
use crate::units::LengthUnit;

/// Squares with the distance of passes as their side, over the whole surface, at most: what is measured, fitted and proven
/// grows with their number.
const MOST: f64 = 1e7;
/// Places of a patch in each direction at which its area is measured.
const PLACES: u32 = 4;

/// Why no passes of a ball are laid at all, if so.
pub(super) fn refused(net: &Net, spacing: Spacing, radius: f64, units: LengthUnit) -> Option<String> {
    let show = |mm: f64| show_length(mm, units);
    let step = match spacing {
        Spacing::Cusp(h) if h >= radius => {
            let (h, radius) = (show(h), show(radius));
            return Some(format!(
                "cusps of {h} are as high as a ball with a radius of {radius} reaches, or higher"
            ));
        }
        Spacing::Cusp(h) => 2.0 * (h * (2.0 * radius - h)).sqrt(),
        Spacing::Step(step) => step,
    };
    let area = area(net);
    let squares = area / (step * step);
    if squares <= MOST {
        return None;
    }
    let least = (area / MOST).sqrt();
    let instead = match spacing {
        Spacing::Cusp(_) if least < radius => {
            let h = 0.25 * least * least / (radius + (radius * radius - 0.25 * least * least).sqrt());
            let h = (h * 1.001 / units.in_mm() * 1e6).ceil() / 1e6;
            format!(
                "a height of cusps of {} {} is the least here",
                crate::cl::print::number(h),
                units.symbol()
            )
        }
        _ => format!("{} apart is the least here", show(least * 1.001)),
    };
    let (side, way) = (area.sqrt() / step, area / step / 1e3);
    Some(format!(
        "passes {} {} apart over this surface are about {side:.0} passes, {way:.0} m of path, more than can be made and \
         proven; {instead}",
        crate::cl::print::number((step / units.in_mm() * 1e6).round() / 1e6),
        units.symbol()
    ))
}

/// The area of a net, roughly, mm².
fn area(net: &Net) -> f64 {
    let place = |k: u32| (f64::from(k) + 0.5) / f64::from(PLACES);
    let places = || (0..PLACES * PLACES).map(move |k| (place(k / PLACES), place(k % PLACES)));
    let of_patch = |patch: &crate::geom::surface::Patch| -> f64 {
        let sizes = places().map(|(u, v)| {
            let jet = patch.jet(u, v);
            jet.u.cross(&jet.v).norm()
        });
        sizes.sum::<f64>() / count(places().count())
    };
    net.patches().iter().map(of_patch).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Point3;

    #[test]
    fn the_work_is_told_beforehand() {
        let p = |x: f64, y: f64| Point3::new(x, y, 0.0);
        let poles = [p(0.0, 0.0), p(0.0, 60.0), p(100.0, 0.0), p(100.0, 60.0)];
        let net = Net::new(2, 2, &poles, None).expect("a net");
        assert!((area(&net) - 6000.0).abs() < 1e-9);
        let asked = |spacing| refused(&net, spacing, 5.0, LengthUnit::Millimetre);
        assert_eq!(asked(Spacing::Cusp(0.01)), None);
        assert_eq!(asked(Spacing::Step(0.03)), None);
        assert!(asked(Spacing::Cusp(5.0)).is_some_and(|why| why.contains("5 mm are as high as")));
        assert!(asked(Spacing::Step(0.01)).is_some_and(|why| why.contains("7746 passes")));
        let why = asked(Spacing::Cusp(1e-7)).expect("too many");
        assert!(why.contains("0.000016 mm is the least"), "{why}");
    }
}
