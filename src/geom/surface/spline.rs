//! B-spline surfaces and curves as CAD systems give them, and their exact Bezier form.
//!
//! The pole k of the Bezier form over a span [a, b] is the blossom at (a … a, b … b) with k times b (Ramshaw); it is a
//! combination of the span's control points with factors in [0, 1], whatever the knots beyond the span are: clamped,
//! free and periodic knots are alike.

use super::net::{Net, NetIssue};
use super::patch::MAX_DEGREE;
use crate::geom::{Point3, Vec3};

/// Most Bezier poles of a net that is made of a surface.
pub const LARGEST_NET: usize = 250_000;
/// Knots nearer to one another than this, relative to the range of the knots, are one.
const SAME_KNOT: f64 = 1e-12;

/// A tensor-product B-spline surface.
#[derive(Debug, Clone, PartialEq)]
pub struct SplineSurface {
    /// Degrees in u and v.
    pub degree: [usize; 2],
    /// Knots in u and v, each as often as its multiplicity says.
    pub knots: [Vec<f64>; 2],
    /// Control points, row by row; u runs from row to row. mm.
    pub poles: Vec<Point3>,
    /// Their weights; all 1 when `None`.
    pub weights: Option<Vec<f64>>,
}

/// A B-spline curve.
#[derive(Debug, Clone, PartialEq)]
pub struct SplineCurve {
    /// Degree.
    pub degree: usize,
    /// Knots, each as often as its multiplicity says.
    pub knots: Vec<f64>,
    /// Control points, mm.
    pub poles: Vec<Point3>,
    /// Their weights; all 1 when `None`.
    pub weights: Option<Vec<f64>>,
}

/// Why a B-spline surface cannot be a net. Axis 0 is u, 1 is v.
#[derive(Debug, Clone, PartialEq)]
pub enum SplineIssue {
    /// A degree of 0 or above the largest.
    Degree {
        /// Direction.
        axis: usize,
        /// The degree.
        degree: usize,
    },
    /// Control points, weights and knots do not fit one another.
    Counts {
        /// Direction.
        axis: usize,
        /// Knots wanted for the control points.
        wanted: usize,
        /// Knots given.
        given: usize,
    },
    /// Knots that fall, or are not finite, or enclose nothing.
    Knots {
        /// Direction.
        axis: usize,
    },
    /// A knot inside at which the surface may come apart.
    Broken {
        /// Direction.
        axis: usize,
        /// The knot.
        knot: f64,
    },
    /// More Bezier poles than [`LARGEST_NET`].
    TooLarge {
        /// Poles of the net.
        poles: usize,
    },
    /// What the net itself finds wrong: poles and weights.
    Net(NetIssue),
}

/// One Bezier pole as a combination of control points.
struct Combination {
    first: usize,
    factors: Vec<f64>,
}

/// The combinations that make Bezier poles of control points: degree times spans, and one more.
fn extraction(
    axis: usize,
    degree: usize,
    knots: &[f64],
    poles: usize,
) -> Result<Vec<Combination>, SplineIssue> {
    if !(1..=MAX_DEGREE).contains(&degree) {
        return Err(SplineIssue::Degree { axis, degree });
    }
    let wanted = poles.saturating_add(degree + 1);
    if knots.len() != wanted || poles <= degree {
        return Err(SplineIssue::Counts { axis, wanted, given: knots.len() });
    }
    let knots = tidy(axis, knots)?;
    let mut out: Vec<Combination> = Vec::new();
    for span in degree..poles {
        let (a, b) = (knots[span], knots[span + 1]);
        if a >= b {
            continue;
        }
        if !out.is_empty() && knots[span - degree] == a {
            return Err(SplineIssue::Broken { axis, knot: a });
        }
        // The last pole of the span before is the first of this one.
        out.pop();
        for k in 0..=degree {
            out.push(Combination { first: span - degree, factors: blossom(&knots, span, degree, k) });
        }
    }
    if out.is_empty() { Err(SplineIssue::Knots { axis }) } else { Ok(out) }
}

/// The knots, checked; those that differ by rounding only are made equal.
fn tidy(axis: usize, knots: &[f64]) -> Result<Vec<f64>, SplineIssue> {
    let (Some(&first), Some(&last)) = (knots.first(), knots.last()) else {
        return Err(SplineIssue::Knots { axis });
    };
    let same = SAME_KNOT * (last - first);
    if !knots.iter().all(|k| k.is_finite()) || !same.is_finite() || same <= 0.0 {
        return Err(SplineIssue::Knots { axis });
    }
    let mut out: Vec<f64> = Vec::with_capacity(knots.len());
    let mut before = first;
    for &knot in knots {
        if knot < before - same {
            return Err(SplineIssue::Knots { axis });
        }
        if knot > before + same {
            before = knot;
        }
        out.push(before);
    }
    Ok(out)
}

/// Factors of the control points `span - degree ..= span` in the pole `k` of the Bezier form over the span.
fn blossom(knots: &[f64], span: usize, degree: usize, k: usize) -> Vec<f64> {
    let n = degree + 1;
    // Row j of the table: the combination that stands for the j-th point of the scheme.
    let mut table: Vec<Vec<f64>> =
        (0..n).map(|j| (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect()).collect();
    for round in 1..=degree {
        let at = if round <= degree - k { knots[span] } else { knots[span + 1] };
        for j in (round..=degree).rev() {
            let (low, high) = (knots[span - degree + j], knots[span + 1 + j - round]);
            let share = (at - low) / (high - low);
            let before = table[j - 1].clone();
            for (own, before) in table[j].iter_mut().zip(before) {
                *own = before * (1.0 - share) + *own * share;
            }
        }
    }
    table.swap_remove(degree)
}

/// A control point as (x w, y w, z w, w).
type Lifted = [f64; 4];

fn lift(poles: &[Point3], weights: Option<&[f64]>) -> Vec<Lifted> {
    let weight = |i: usize| weights.and_then(|w| w.get(i)).copied().unwrap_or(1.0);
    poles
        .iter()
        .enumerate()
        .map(|(i, p)| (p, weight(i)))
        .map(|(p, w)| [p.x * w, p.y * w, p.z * w, w])
        .collect()
}

/// The combination of the points that `place` picks.
fn combine(c: &Combination, points: &[Lifted], place: impl Fn(usize) -> usize) -> Lifted {
    let mut sum = [0.0; 4];
    for (i, factor) in c.factors.iter().enumerate() {
        if let Some(point) = points.get(place(c.first + i)).filter(|_| *factor != 0.0) {
            for (s, x) in sum.iter_mut().zip(point) {
                *s += x * factor;
            }
        }
    }
    sum
}

impl SplineSurface {
    /// The whole surface as a net of one Bezier patch per span: the same points, within rounding.
    ///
    /// # Errors
    /// [`SplineIssue`].
    pub fn net(&self) -> Result<Net, SplineIssue> {
        let [p, q] = self.degree;
        let rows = self.knots[0].len().saturating_sub(p.saturating_add(1));
        let columns = self.poles.len().checked_div(rows).unwrap_or(0);
        let counts = rows * columns == self.poles.len()
            && self.weights.as_ref().is_none_or(|w| w.len() == self.poles.len());
        if !counts {
            let given = self.weights.as_ref().map_or(self.poles.len(), |w| w.len().min(self.poles.len()));
            return Err(SplineIssue::Net(NetIssue::Count { wanted: rows.saturating_mul(columns), given }));
        }
        self.sound()?;
        let along_u = extraction(0, p, &self.knots[0], rows)?;
        let along_v = extraction(1, q, &self.knots[1], columns)?;
        let poles = along_u.len().saturating_mul(along_v.len());
        if poles > LARGEST_NET || along_u.len().saturating_mul(columns) > LARGEST_NET {
            return Err(SplineIssue::TooLarge { poles });
        }
        let given = lift(&self.poles, self.weights.as_deref());
        let mut half = Vec::with_capacity(along_u.len() * columns);
        for c in &along_u {
            half.extend((0..columns).map(|j| combine(c, &given, |i| i * columns + j)));
        }
        let mut whole = Vec::with_capacity(poles);
        for i in 0..along_u.len() {
            whole.extend(along_v.iter().map(|c| combine(c, &half, |j| i * columns + j)));
        }
        let size = [(along_u.len() - 1) / p, (along_v.len() - 1) / q];
        let points: Vec<Point3> = whole.iter().map(projected).collect();
        let weights: Option<Vec<f64>> = self.weights.as_ref().map(|_| whole.iter().map(|h| h[3]).collect());
        Net::chain(self.degree, size, &points, weights.as_deref()).map_err(SplineIssue::Net)
    }

    /// Whether all numbers are finite and all weights positive.
    fn sound(&self) -> Result<(), SplineIssue> {
        let points = self.poles.iter().all(|p| p.coords.iter().all(|c| c.is_finite()));
        let weights = self.weights.iter().flatten().all(|w| w.is_finite() && *w > 0.0);
        if points && weights { Ok(()) } else { Err(SplineIssue::Net(NetIssue::NotFinite)) }
    }
}

fn projected(h: &Lifted) -> Point3 {
    Point3::new(h[0] / h[3], h[1] / h[3], h[2] / h[3])
}

impl SplineCurve {
    /// Points of the curve: both ends of every span and `inside` places between; `None` when it is not sound.
    #[must_use]
    pub fn samples(&self, inside: u32) -> Option<Vec<Point3>> {
        let combinations = extraction(0, self.degree, &self.knots, self.poles.len()).ok()?;
        if self.weights.as_ref().is_some_and(|w| w.len() != self.poles.len()) {
            return None;
        }
        let given = lift(&self.poles, self.weights.as_deref());
        let bezier: Vec<Lifted> = combinations.iter().map(|c| combine(c, &given, |i| i)).collect();
        let mut out = Vec::new();
        for span in bezier.windows(self.degree + 1).step_by(self.degree) {
            for k in 0..=inside + 1 {
                out.push(casteljau(span, f64::from(k) / f64::from(inside + 1)));
            }
        }
        let finite = out.iter().all(|p: &Point3| p.coords.iter().all(|c| c.is_finite()));
        finite.then_some(out)
    }
}

fn casteljau(poles: &[Lifted], t: f64) -> Point3 {
    let mut line = poles.to_vec();
    for round in 1..line.len() {
        for k in 0..line.len() - round {
            let next = line[k + 1];
            for (own, next) in line[k].iter_mut().zip(next) {
                *own = *own * (1.0 - t) + next * t;
            }
        }
    }
    line.first().map_or_else(|| Point3::from(Vec3::zeros()), projected)
}

#[cfg(test)]
mod tests;
