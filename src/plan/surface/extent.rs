//! How much an operation would be, told before it begins.

use crate::geom::Vec3;
use crate::geom::surface::{Cutter, Net};
use crate::ir::Spacing;
use crate::math::count;
use crate::plan::show_length;
use crate::units::LengthUnit;

/// Squares with the distance of passes as their side, over the whole surface, at most: what is measured, fitted and proven
/// grows with their number. For balls, and for other cutters, whose places take longer to find.
const MOST: [f64; 2] = [1e7, 5e5];
/// Places of a patch in each direction at which its area is measured.
const PLACES: u32 = 4;

/// Why no passes are laid at all, if so.
pub(super) fn refused(net: &Net, spacing: Spacing, cutter: &Cutter, units: LengthUnit) -> Option<String> {
    let show = |mm: f64| show_length(mm, units);
    let (radius, most) = (cutter.radius(), MOST[usize::from(!cutter.is_ball())]);
    if let Spacing::Cusp(h) = spacing
        && h >= radius
    {
        let (h, radius) = (show(h), show(radius));
        let kind = if cutter.is_ball() { "ball" } else { "cutter" };
        return Some(format!(
            "cusps of {h} are as high as a {kind} with a radius of {radius} reaches, or higher"
        ));
    }
    let squares = squares(net, cutter, spacing);
    if squares <= most {
        return None;
    }
    let in_units = |mm: f64| crate::cl::print::number((mm / units.in_mm() * 1e6).ceil() / 1e6);
    let instead = match (spacing, least(net, cutter, most)) {
        (Spacing::Cusp(_), Some(h)) => {
            format!("a height of cusps of {} {} is the least here", in_units(h), units.symbol())
        }
        _ => format!("{} apart is the least here", show((area(net) / most).sqrt() * 1.001)),
    };
    let area = area(net);
    let step = (area / squares).sqrt();
    let (side, way) = (area.sqrt() / step, area / step / 1e3);
    Some(format!(
        "passes {} {} apart over this surface are about {side:.0} passes, {way:.0} m of path, more than can be made and \
         proven; {instead}",
        crate::cl::print::number((step / units.in_mm() * 1e6).round() / 1e6),
        units.symbol()
    ))
}

/// The least height of cusps, mm, for which there are so few squares, to 0.1 %; `None` where even the highest asks for more.
fn least(net: &Net, cutter: &Cutter, most: f64) -> Option<f64> {
    const ROUNDS: u32 = 50;
    let few = |h: f64| squares(net, cutter, Spacing::Cusp(h)) <= most;
    let (mut low, mut high) = (1e-12, 0.999 * cutter.radius());
    if !few(high) {
        return None;
    }
    for _ in 0..ROUNDS {
        let middle = (low * high).sqrt();
        if few(middle) { high = middle } else { low = middle }
    }
    Some(high * 1.001)
}

/// How many squares with the distance of passes as their side a net has, roughly.
fn squares(net: &Net, cutter: &Cutter, spacing: Spacing) -> f64 {
    over(net, &|n| {
        let step = match spacing {
            Spacing::Step(step) => step,
            Spacing::Cusp(h) => apart(cutter, h, n),
        };
        1.0 / (step * step)
    })
}

/// How far apart passes lie on a plane with this normal, mm, at the most: between them a corner leaves ridges, and beside a flat
/// steps as high as the slope has it.
fn apart(cutter: &Cutter, cusp: f64, n: Vec3) -> f64 {
    let round = |r: f64| 2.0 * (cusp * (2.0 * r - cusp)).max(0.0).sqrt();
    if cutter.is_ball() {
        return round(cutter.corner());
    }
    let slope = (n.x * n.x + n.y * n.y).sqrt();
    (round(cutter.corner()) + cusp / slope.max(1e-9)).min(2.0 * cutter.radius())
}

/// The area of a net, roughly, mm².
fn area(net: &Net) -> f64 {
    over(net, &|_| 1.0)
}

/// What is so dense where the normal is such, over a net.
fn over(net: &Net, dense: &dyn Fn(Vec3) -> f64) -> f64 {
    let place = |k: u32| (f64::from(k) + 0.5) / f64::from(PLACES);
    let places = || (0..PLACES * PLACES).map(move |k| (place(k / PLACES), place(k % PLACES)));
    let of_patch = |patch: &crate::geom::surface::Patch| -> f64 {
        let sizes = places().map(|(u, v)| {
            let jet = patch.jet(u, v);
            jet.area_vector().norm() * dense(jet.normal().unwrap_or_else(Vec3::z))
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
        let ball = Cutter::ball(5.0);
        let asked = |spacing| refused(&net, spacing, &ball, LengthUnit::Millimetre);
        assert_eq!(asked(Spacing::Cusp(0.01)), None);
        assert_eq!(asked(Spacing::Step(0.03)), None);
        assert!(asked(Spacing::Cusp(5.0)).is_some_and(|why| why.contains("5 mm are as high as")));
        assert!(asked(Spacing::Step(0.01)).is_some_and(|why| why.contains("7746 passes")));
        let why = asked(Spacing::Cusp(1e-7)).expect("too many");
        assert!(why.contains("0.000016 mm is the least"), "{why}");
    }

    #[test]
    fn a_flat_end_asks_for_more_passes_on_a_slope() {
        let net = |rise: f64| {
            let poles = [(0.0, 0.0), (0.0, 60.0), (100.0, 0.0), (100.0, 60.0)]
                .map(|(x, y)| Point3::new(x, y, rise * y));
            Net::new(2, 2, &poles, None).expect("a net")
        };
        let flat = Cutter::bull(5.0, 0.0);
        let asked = |rise, h| refused(&net(rise), Spacing::Cusp(h), &flat, LengthUnit::Millimetre);
        assert_eq!(asked(0.0, 0.001), None);
        assert_eq!(asked(0.5, 0.1), None);
        let why = asked(0.5, 0.001).expect("too many");
        // Steps of 0.001 mm at 26.6 degrees are 0.00224 mm long; 6708 mm² have 5e5 squares with sides of 0.1158 mm.
        assert!(why.contains("passes 0.002236 mm apart"), "{why}");
        assert!(why.contains("a height of cusps of 0.0518"), "{why}");
        let within = squares(&net(0.5), &flat, Spacing::Cusp(0.0519));
        assert!((0.99 * MOST[1]..MOST[1]).contains(&within), "{within}");
    }
}
