//! How the point of contact goes over joints of a net whose patches meet at an angle.
//!
//! The normal leaps there, and with it a ball that is set on the surface. So within a small width of such a joint the point
//! of contact stays on it, while the normal turns from one patch's to the other's: the ball rolls around a ridge. In a
//! valley it is lifted from there, as everywhere, and its centre leaps no more than over a ridge.

use super::net::Net;
use crate::geom::{Point3, Vec3};
use crate::math::count;

/// Normals that differ by less, rad, do not make a crease: the leap of a ball of 10 mm is below a tenth of a micron.
const ANGLE: f64 = 1e-5;
/// The point of contact stays on a crease over so much of the parameter to both sides; it makes up for it over as much again.
const WIDTH: f64 = 5e-4;

/// The parameter lines of a net along which patches meet at an angle somewhere.
#[derive(Debug, Clone, Default)]
pub(super) struct Creases {
    /// By axis and line; line k lies at parameter k + 1.
    lines: [Vec<bool>; 2],
}

/// A place of a patch, from which it is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stand {
    pub patch: usize,
    pub uv: [f64; 2],
    pub point: Point3,
    pub normal: Vec3,
}

/// A parameter as index of the patch, parameter inside it, and weight: one or two of them.
type Sides = ([(usize, f64, f64); 2], usize);

impl Creases {
    pub(super) fn new(net: &Net) -> Creases {
        let size = net.size();
        let line =
            |axis: usize, k: usize| (0..size[1 - axis]).any(|across| is_creased(net, axis, (k, across)));
        let lines = [0, 1].map(|axis| (0..size[axis].saturating_sub(1)).map(|k| line(axis, k)).collect());
        Creases { lines }
    }

    /// The place at net parameters with its normal; `None` where there is none.
    pub(super) fn stand(&self, net: &Net, uv: [f64; 2]) -> Option<Stand> {
        let size = net.size();
        let [(us, m), (vs, n)] = [0, 1].map(|axis| self.sides(axis, uv[axis], size[axis]));
        let mut first: Option<Stand> = None;
        let mut sum = Vec3::zeros();
        for (i, s, a) in &us[..m] {
            for (j, t, b) in &vs[..n] {
                let patch = i * size[1] + j;
                let jet = net.patches().get(patch)?.jet(*s, *t);
                let normal = jet.normal()?;
                sum += normal * (a * b);
                first.get_or_insert(Stand { patch, uv: [*s, *t], point: jet.p, normal });
            }
        }
        let stand = first?;
        if m * n == 1 {
            return Some(stand);
        }
        Some(Stand { normal: sum.try_normalize(1e-9)?, ..stand })
    }

    fn sides(&self, axis: usize, x: f64, size: usize) -> Sides {
        let x = x.clamp(0.0, count(size));
        let joint = x.round();
        // x lies in 0..=size.
        let k = joint as usize;
        let creased = k > 0 && self.lines[axis].get(k - 1).copied().unwrap_or(false);
        let off = x - joint;
        if creased && off.abs() <= WIDTH {
            let share = (off + WIDTH) / (2.0 * WIDTH);
            return ([(k - 1, 1.0, 1.0 - share), (k, 0.0, share)], 2);
        }
        let x = if creased && off.abs() < 2.0 * WIDTH { x + off - off.signum() * 2.0 * WIDTH } else { x };
        let i = (x.floor() as usize).min(size - 1);
        ([(i, x - count(i), 1.0); 2], 1)
    }
}

/// Whether a patch and the next along an axis meet at an angle somewhere; the patch by its indices along and across.
fn is_creased(net: &Net, axis: usize, (k, across): (usize, usize)) -> bool {
    const PLACES: u32 = 6;
    let columns = net.size()[1];
    let index = |k: usize| if axis == 0 { k * columns + across } else { across * columns + k };
    let (Some(first), Some(second)) = (net.patches().get(index(k)), net.patches().get(index(k + 1))) else {
        return false;
    };
    (0..=PLACES).any(|i| {
        let t = f64::from(i) / f64::from(PLACES);
        let (a, b) = match axis {
            0 => (first.jet(1.0, t), second.jet(0.0, t)),
            _ => (first.jet(t, 1.0), second.jet(t, 0.0)),
        };
        a.normal().zip(b.normal()).is_some_and(|(m, n)| (m - n).norm() > ANGLE)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roof(rise: f64) -> Net {
        let z = |j: usize| if j <= 3 { rise * count(j) } else { rise * (6.0 - count(j)) };
        let poles: Vec<Point3> = (0..28).map(|k| Point3::new(count(k / 7), count(k % 7), z(k % 7))).collect();
        Net::new(4, 7, &poles, None).expect("a net")
    }

    #[test]
    fn the_normal_turns_on_a_crease_without_a_leap() {
        let net = roof(0.8);
        let creases = Creases::new(&net);
        let at = |v: f64| creases.stand(&net, [0.4, v]).expect("a place");
        assert!((at(0.9).normal.y + at(1.1).normal.y).abs() < 1e-12 && at(0.9).normal.y < -0.6);
        assert!((at(1.0).normal - Vec3::z()).norm() < 1e-12);
        let mut before = at(0.998);
        for k in 1..=400 {
            let now = at(0.998 + 1e-5 * f64::from(k));
            assert!((now.normal - before.normal).norm() < 0.03 && (now.point - before.point).norm() < 1e-3);
            before = now;
        }
        assert!(before.point == net.jet(0.4, 1.002).p);
    }

    #[test]
    fn smooth_joints_are_left_alone() {
        let net = roof(0.0);
        let creases = Creases::new(&net);
        for v in [0.0, 0.4, 0.9996, 1.0, 1.3, 2.0] {
            let stand = creases.stand(&net, [0.4, v]).expect("a place");
            assert!((stand.point - net.jet(0.4, v).p).norm() < 1e-12);
        }
    }
}
