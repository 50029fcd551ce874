//! One Bezier patch of any degree, polynomial or rational.

use wide::f64x4;

use crate::geom::{Point3, Vec3};

/// Largest degree of a patch in either direction.
pub const MAX_DEGREE: usize = 15;

type Basis = [f64; MAX_DEGREE + 1];
type Homogeneous = nalgebra::Vector4<f64>;

/// Point of a surface with its partial derivatives, mm per unit of u and v.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceJet {
    /// r, mm.
    pub p: Point3,
    /// ∂r/∂u.
    pub u: Vec3,
    /// ∂r/∂v.
    pub v: Vec3,
    /// ∂²r/∂u².
    pub uu: Vec3,
    /// ∂²r/∂u∂v.
    pub uv: Vec3,
    /// ∂²r/∂v².
    pub vv: Vec3,
}

/// Principal curvatures, 1/mm, concave positive, the larger first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principal {
    /// κ₁, the most concave.
    pub max: f64,
    /// κ₂.
    pub min: f64,
}

impl SurfaceJet {
    /// r_u × r_v turned towards +z; its length is the area element.
    #[must_use]
    pub fn area_vector(&self) -> Vec3 {
        let w = self.u.cross(&self.v);
        if w.z < 0.0 { -w } else { w }
    }
    /// Unit normal towards +z; `None` where r_u × r_v vanishes (a collapsed edge or corner).
    #[must_use]
    pub fn normal(&self) -> Option<Vec3> {
        let w = self.area_vector();
        let length = w.norm();
        (length > f64::MIN_POSITIVE && length.is_finite()).then(|| w / length)
    }
    /// First fundamental matrix (g₁₁, g₁₂, g₂₂), Jeong & Jeong eq. (13).
    #[must_use]
    pub fn first(&self) -> [f64; 3] {
        [self.u.dot(&self.u), self.u.dot(&self.v), self.v.dot(&self.v)]
    }
    /// Second fundamental matrix (d₁₁, d₁₂, d₂₂) about the normal `n`, eq. (14).
    #[must_use]
    pub fn second(&self, n: Vec3) -> [f64; 3] {
        [self.uu.dot(&n), self.uv.dot(&n), self.vv.dot(&n)]
    }
    /// Principal curvatures, eq. (17) as corrected: κ = (b ± √(b² − ac))/a with a = det G, c = det D,
    /// b = (g₁₁d₂₂ + g₂₂d₁₁)/2 − g₁₂d₁₂. `None` where there is no normal.
    #[must_use]
    pub fn principal(&self) -> Option<Principal> {
        let n = self.normal()?;
        let [g11, g12, g22] = self.first();
        let [d11, d12, d22] = self.second(n);
        let a = g11 * g22 - g12 * g12;
        let b = 0.5 * (g11 * d22 + g22 * d11) - g12 * d12;
        let c = d11 * d22 - d12 * d12;
        let root = (b * b - a * c).max(0.0).sqrt();
        Some(Principal { max: (b + root) / a, min: (b - root) / a })
    }
    /// Normal curvature in the parameter direction (du, dv), eq. (16). `None` where there is no normal.
    #[must_use]
    pub fn normal_curvature(&self, du: f64, dv: f64) -> Option<f64> {
        let n = self.normal()?;
        let [g11, g12, g22] = self.first();
        let [d11, d12, d22] = self.second(n);
        let g = g11 * du * du + 2.0 * g12 * du * dv + g22 * dv * dv;
        let d = d11 * du * du + 2.0 * d12 * du * dv + d22 * dv * dv;
        (g > 0.0).then(|| d / g)
    }
}

/// A Bezier patch of degree (m, n): (m+1) × (n+1) poles, row by row (rows run in u).
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    degree: [usize; 2],
    poles: Vec<Homogeneous>,
    rational: bool,
    /// Coefficients of (u - c)ⁱ (v - c)ʲ, row by row, of a patch of a net: points of these are asked for by the million;
    /// c is 0 for a bicubic patch, [`CENTRE`] for others. None for parts of patches, and where the degree is so high that
    /// powers lose too many digits.
    powers: Vec<f64x4>,
}

/// Degrees up to which powers are used: they lose three digits at most (about the centre a factor of 2ⁿ, about 0 of 3ⁿ).
const FEW: usize = 8;
/// The place about which powers are taken where the patch is not bicubic.
const CENTRE: f64 = 0.5;

impl Patch {
    /// A patch from its poles, row by row, and their weights (1 when `None`).
    /// `None` when the counts do not fit, a degree is 0 or above [`MAX_DEGREE`], a number is not finite or
    /// a weight is not positive.
    #[must_use]
    pub fn new(rows: usize, columns: usize, poles: &[Point3], weights: Option<&[f64]>) -> Option<Patch> {
        let fits = (2..=MAX_DEGREE + 1).contains(&rows) && (2..=MAX_DEGREE + 1).contains(&columns);
        let counts = poles.len() == rows * columns && weights.is_none_or(|w| w.len() == poles.len());
        if !fits || !counts {
            return None;
        }
        let weight = |i: usize| weights.and_then(|w| w.get(i)).copied().unwrap_or(1.0);
        let sound = |(i, p): (usize, &Point3)| {
            p.coords.iter().all(|c| c.is_finite()) && weight(i).is_finite() && weight(i) > 0.0
        };
        if !poles.iter().enumerate().all(sound) {
            return None;
        }
        let rational = (1..poles.len()).any(|i| weight(i) != weight(0));
        let lift = |(i, p): (usize, &Point3)| {
            let w = if rational { weight(i) } else { 1.0 };
            Homogeneous::new(p.x * w, p.y * w, p.z * w, w)
        };
        let poles: Vec<Homogeneous> = poles.iter().enumerate().map(lift).collect();
        let about = if rows == 4 && columns == 4 { 0.0 } else { CENTRE };
        let powers = if rows.max(columns) <= FEW + 1 { powers(&poles, columns, about) } else { Vec::new() };
        Some(Patch { degree: [rows - 1, columns - 1], poles, rational, powers })
    }
    /// Degree in u and v.
    #[must_use]
    pub fn degree(&self) -> [usize; 2] {
        self.degree
    }
    /// Whether weights differ.
    #[must_use]
    pub fn is_rational(&self) -> bool {
        self.rational
    }
    /// Homogeneous poles (x w, y w, z w, w), row by row.
    #[must_use]
    pub fn homogeneous(&self) -> &[Homogeneous] {
        &self.poles
    }
    /// The pole in row `i`, column `j`.
    #[must_use]
    pub fn pole(&self, i: usize, j: usize) -> Point3 {
        let h = self.poles[i * (self.degree[1] + 1) + j];
        Point3::new(h.x / h.w, h.y / h.w, h.z / h.w)
    }
    /// Weight of that pole.
    #[must_use]
    pub fn weight(&self, i: usize, j: usize) -> f64 {
        self.poles[i * (self.degree[1] + 1) + j].w
    }
    /// r(u, v).
    #[must_use]
    pub fn point(&self, u: f64, v: f64) -> Point3 {
        let h = self.sum(&bernstein(self.degree[0], u), &bernstein(self.degree[1], v));
        Point3::new(h.x / h.w, h.y / h.w, h.z / h.w)
    }
    /// r and its derivatives to second order, eq. (8) ff.
    #[must_use]
    pub fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        if let (Ok(powers), 3, false) = (self.powers.as_slice().try_into(), self.degree[0], self.rational) {
            let [p, u, v, uu, uv, vv] = bicubic(powers, u, v).map(vector);
            return SurfaceJet { p: Point3::from(p), u, v, uu, uv, vv };
        }
        let [h, hu, hv, huu, huv, hvv] = self.sums(u, v);
        if self.rational {
            return quotient(h, hu, hv, huu, huv, hvv);
        }
        SurfaceJet {
            p: Point3::from(h.xyz()),
            u: hu.xyz(),
            v: hv.xyz(),
            uu: huu.xyz(),
            uv: huv.xyz(),
            vv: hvv.xyz(),
        }
    }
    fn sum(&self, b: &Basis, c: &Basis) -> Homogeneous {
        let n = self.degree[1] + 1;
        let row = |poles: &[Homogeneous]| {
            poles.iter().zip(c).fold(Homogeneous::zeros(), |acc, (p, w)| acc + p * *w)
        };
        self.poles.chunks_exact(n).zip(b).fold(Homogeneous::zeros(), |acc, (r, w)| acc + row(r) * *w)
    }
    /// The homogeneous point and its derivatives, in the order of [`SurfaceJet`].
    fn sums(&self, u: f64, v: f64) -> [Homogeneous; 6] {
        let [m, n] = self.degree;
        if let (Ok(powers), 3) = (self.powers.as_slice().try_into(), m) {
            return bicubic(powers, u, v).map(homogeneous);
        }
        if !self.powers.is_empty() {
            return horner(&self.powers, n + 1, u - CENTRE, v - CENTRE).map(homogeneous);
        }
        let (b, c) = (bernstein_jet(m, u), bernstein_jet(n, v));
        let mut out = [Homogeneous::zeros(); 6];
        for (i, row) in self.poles.chunks_exact(n + 1).enumerate() {
            let mut r = [Homogeneous::zeros(); 3];
            for (j, pole) in row.iter().enumerate() {
                for (acc, basis) in r.iter_mut().zip(&c) {
                    *acc += pole * basis[j];
                }
            }
            gather(&mut out, &r, [b[0][i], b[1][i], b[2][i]]);
        }
        out
    }
    /// The part of the patch over `[u0, u1] × [v0, v1]`, as a patch of its own over the unit square.
    #[must_use]
    pub fn restrict(&self, u: (f64, f64), v: (f64, f64)) -> Patch {
        let [m, n] = self.degree;
        let mut poles = self.poles.clone();
        for j in 0..=n {
            blossom_line(&mut poles, j, n + 1, m, u);
        }
        for i in 0..=m {
            blossom_line(&mut poles, i * (n + 1), 1, n, v);
        }
        Patch { degree: self.degree, poles, rational: self.rational, powers: Vec::new() }
    }
    /// Homogeneous poles of ∂/∂u (`axis` 0) or ∂/∂v (`axis` 1) of the homogeneous patch.
    #[must_use]
    pub fn hodograph(&self, axis: usize) -> Patch {
        let [m, n] = self.degree;
        let columns = n + 1;
        let at = |i: usize, j: usize| self.poles[i * columns + j];
        let (rows_out, columns_out) = if axis == 0 { (m.max(1), n + 1) } else { (m + 1, n.max(1)) };
        let mut poles = Vec::with_capacity(rows_out * columns_out);
        for i in 0..rows_out {
            for j in 0..columns_out {
                poles.push(match (axis, m, n) {
                    (0, 0, _) | (1, _, 0) => Homogeneous::zeros(),
                    (0, ..) => (at(i + 1, j) - at(i, j)) * crate::math::count(m),
                    _ => (at(i, j + 1) - at(i, j)) * crate::math::count(n),
                });
            }
        }
        Patch { degree: [rows_out - 1, columns_out - 1], poles, rational: self.rational, powers: Vec::new() }
    }
}

/// Restricts one line of poles (start, stride, degree) to the parameter interval by two de Casteljau cuts.
fn blossom_line(poles: &mut [Homogeneous], start: usize, stride: usize, degree: usize, t: (f64, f64)) {
    let mut line = [Homogeneous::zeros(); MAX_DEGREE + 1];
    for (k, value) in line.iter_mut().enumerate().take(degree + 1) {
        *value = poles[start + k * stride];
    }
    // Keep [t0, 1] of the line, then the first (t1 - t0)/(1 - t0) of what is left.
    for round in 0..degree {
        for k in 0..degree - round {
            line[k] = line[k] * (1.0 - t.0) + line[k + 1] * t.0;
        }
    }
    let rest = if t.0 < 1.0 { (t.1 - t.0) / (1.0 - t.0) } else { 0.0 };
    for round in 1..=degree {
        for k in (round..=degree).rev() {
            line[k] = line[k - 1] * (1.0 - rest) + line[k] * rest;
        }
    }
    for (k, value) in line.into_iter().enumerate().take(degree + 1) {
        poles[start + k * stride] = value;
    }
}

/// Bernstein polynomials of degree `n` at `t`.
fn bernstein(n: usize, t: f64) -> Basis {
    let mut b = [0.0; MAX_DEGREE + 1];
    b[0] = 1.0;
    let s = 1.0 - t;
    for k in 1..=n {
        let mut carry = 0.0;
        for value in b.iter_mut().take(k) {
            let old = *value;
            *value = carry + s * old;
            carry = t * old;
        }
        b[k] = carry;
    }
    b
}

/// A patch in powers of u and v about a place.
fn powers(poles: &[Homogeneous], columns: usize, about: f64) -> Vec<f64x4> {
    let mut out = poles.to_vec();
    let rows = poles.len() / columns;
    (0..rows).for_each(|i| line_in_powers(&mut out, i * columns, 1, columns - 1, about));
    (0..columns).for_each(|j| line_in_powers(&mut out, j, columns, rows - 1, about));
    out.iter().map(|h| f64x4::from([h.x, h.y, h.z, h.w])).collect()
}

/// One line of poles (start, stride, degree): the k-th coefficient is the k-th difference at the place, (n over k) times.
fn line_in_powers(poles: &mut [Homogeneous], start: usize, stride: usize, degree: usize, about: f64) {
    let mut choose = 1.0;
    let mut differences = [Homogeneous::zeros(); MAX_DEGREE + 1];
    for (k, value) in differences.iter_mut().enumerate().take(degree + 1) {
        *value = poles[start + k * stride];
    }
    for k in 0..=degree {
        let mut line = differences;
        for left in (1..=degree - k).rev() {
            for i in 0..left {
                line[i] = line[i] * (1.0 - about) + line[i + 1] * about;
            }
        }
        poles[start + k * stride] = line[0] * choose;
        for i in 0..degree - k {
            differences[i] = differences[i + 1] - differences[i];
        }
        choose *= crate::math::count(degree - k) / crate::math::count(k + 1);
    }
}

/// The homogeneous point of a patch and its derivatives, by Horner's rule.
fn horner(powers: &[f64x4], columns: usize, u: f64, v: f64) -> [f64x4; 6] {
    let (u, v) = (f64x4::splat(u), f64x4::splat(v));
    let mut out = [f64x4::ZERO; 6];
    for row in powers.chunks_exact(columns).rev() {
        let mut r = [f64x4::ZERO; 3];
        for a in row.iter().rev() {
            r = [r[0] * v + *a, r[1] * v + r[0], r[2] * v + r[1]];
        }
        let [p, pu, pv, puu, puv, pvv] = out;
        out = [p * u + r[0], pu * u + p, pv * u + r[1], puu * u + pu, puv * u + pv, pvv * u + r[2]];
    }
    // Horner's scheme gives half of a second derivative.
    let [p, pu, pv, puu, puv, pvv] = out;
    [p, pu, pv, puu + puu, puv, pvv + pvv]
}

/// The homogeneous point of a bicubic patch and its derivatives, by Horner's rule.
fn bicubic(powers: &[f64x4; 16], u: f64, v: f64) -> [f64x4; 6] {
    let (u, v, three) = (f64x4::splat(u), f64x4::splat(v), f64x4::splat(3.0));
    // With the cubic's last term at the place: value, slope, half of the second derivative.
    let line = |a: f64x4, b: f64x4, c: f64x4, d: f64x4, t: f64x4| {
        let (high, thrice) = (d * t, d * t * three);
        (a + (b + (c + high) * t) * t, b + (c + c + thrice) * t, c + thrice)
    };
    let row = |i: usize| line(powers[4 * i], powers[4 * i + 1], powers[4 * i + 2], powers[4 * i + 3], v);
    let [a, b, c, d] = [row(0), row(1), row(2), row(3)];
    let (p, pu, puu) = line(a.0, b.0, c.0, d.0, u);
    let slope = |a: f64x4, b: f64x4, c: f64x4, d: f64x4| {
        let high = d * u;
        (a + (b + (c + high) * u) * u, b + (c + c + high * three) * u)
    };
    let (pv, puv) = slope(a.1, b.1, c.1, d.1);
    let pvv = a.2 + (b.2 + (c.2 + d.2 * u) * u) * u;
    [p, pu, pv, puu + puu, puv, pvv + pvv]
}

fn vector(x: f64x4) -> Vec3 {
    let [x, y, z, _] = x.to_array();
    Vec3::new(x, y, z)
}

fn homogeneous(x: f64x4) -> Homogeneous {
    Homogeneous::from(x.to_array())
}

/// Adds what a row of poles gives: its sums with the basis in v and that basis's derivatives, times those in u.
fn gather(out: &mut [Homogeneous; 6], r: &[Homogeneous; 3], b: [f64; 3]) {
    out[0] += r[0] * b[0];
    out[1] += r[0] * b[1];
    out[2] += r[1] * b[0];
    out[3] += r[0] * b[2];
    out[4] += r[1] * b[1];
    out[5] += r[2] * b[0];
}

/// Bernstein polynomials of degree `n` with first and second derivatives.
fn bernstein_jet(n: usize, t: f64) -> [Basis; 3] {
    let down = |lower: &Basis, degree: usize| {
        let mut d = [0.0; MAX_DEGREE + 1];
        for (k, value) in d.iter_mut().enumerate().take(degree + 1) {
            let left = if k > 0 { lower[k - 1] } else { 0.0 };
            let right = if k < degree { lower[k] } else { 0.0 };
            *value = crate::math::count(degree) * (left - right);
        }
        d
    };
    let b = bernstein(n, t);
    let b1 = if n >= 1 { bernstein(n - 1, t) } else { [0.0; MAX_DEGREE + 1] };
    let first = down(&b1, n);
    let second = if n >= 2 { down(&down(&bernstein(n - 2, t), n - 1), n) } else { [0.0; MAX_DEGREE + 1] };
    [b, first, second]
}

/// Derivatives of the projection of a homogeneous surface.
fn quotient(
    h: Homogeneous,
    hu: Homogeneous,
    hv: Homogeneous,
    huu: Homogeneous,
    huv: Homogeneous,
    hvv: Homogeneous,
) -> SurfaceJet {
    let p = h.xyz() / h.w;
    let u = (hu.xyz() - p * hu.w) / h.w;
    let v = (hv.xyz() - p * hv.w) / h.w;
    let uu = (huu.xyz() - u * (2.0 * hu.w) - p * huu.w) / h.w;
    let uv = (huv.xyz() - u * hv.w - v * hu.w - p * huv.w) / h.w;
    let vv = (hvv.xyz() - v * (2.0 * hv.w) - p * hvv.w) / h.w;
    SurfaceJet { p: Point3::from(p), u, v, uu, uv, vv }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wavy(weights: Option<&[f64]>) -> Patch {
        let poles: Vec<Point3> = (0..16)
            .map(|k| {
                let (i, j) = (f64::from(k / 4), f64::from(k % 4));
                Point3::new(20.0 * i + j, 15.0 * j - i, 5.0 * ((i * 7.0 + j * 3.0) % 4.0))
            })
            .collect();
        Patch::new(4, 4, &poles, weights).expect("a sound patch")
    }

    fn differences_agree(patch: &Patch) {
        let (u, v, h) = (0.37, 0.61, 1e-4);
        let jet = patch.jet(u, v);
        let at = |du: f64, dv: f64| patch.point(u + du * h, v + dv * h).coords;
        let near = |a: Vec3, b: Vec3| assert!((a - b).norm() < 1e-4, "{a} {b}");
        near(jet.u, (at(1.0, 0.0) - at(-1.0, 0.0)) / (2.0 * h));
        near(jet.v, (at(0.0, 1.0) - at(0.0, -1.0)) / (2.0 * h));
        near(jet.uu, (at(1.0, 0.0) - at(0.0, 0.0) * 2.0 + at(-1.0, 0.0)) / (h * h));
        near(jet.vv, (at(0.0, 1.0) - at(0.0, 0.0) * 2.0 + at(0.0, -1.0)) / (h * h));
        near(jet.uv, (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * h * h));
    }

    #[test]
    fn derivatives_agree_with_differences() {
        differences_agree(&wavy(None));
        let weights: Vec<f64> = (0..16).map(|k| 1.0 + 0.3 * f64::from(k % 5)).collect();
        differences_agree(&wavy(Some(&weights)));
    }

    #[test]
    fn powers_and_bernstein_polynomials_agree() {
        for (rows, columns) in
            [(2, 2), (2, 6), (3, 5), (4, 4), (6, 3), (6, 6), (7, 4), (8, 3), (9, 9), (10, 2)]
        {
            let at = |k: usize| crate::math::count(k * k % 7) - crate::math::count(k % 3);
            let poles: Vec<Point3> = (0..rows * columns)
                .map(|k| {
                    Point3::new(20.0 * crate::math::count(k / columns) + at(k), 15.0 * at(k + 1), at(3 * k))
                })
                .collect();
            let weights: Vec<f64> =
                (0..poles.len()).map(|k| 1.0 + 0.25 * crate::math::count(k % 4)).collect();
            for weights in [None, Some(weights.as_slice())] {
                let patch = Patch::new(rows, columns, &poles, weights).expect("a sound patch");
                // A part of a patch has no powers.
                let whole = patch.restrict((0.0, 1.0), (0.0, 1.0));
                for (u, v) in [(0.0, 0.0), (1.0, 1.0), (0.3, 0.8), (0.55, 0.0), (1.0, 0.21)] {
                    let (a, b) = (patch.jet(u, v), whole.jet(u, v));
                    let pairs = [
                        (a.p.coords, b.p.coords),
                        (a.u, b.u),
                        (a.v, b.v),
                        (a.uu, b.uu),
                        (a.uv, b.uv),
                        (a.vv, b.vv),
                    ];
                    for (a, b) in pairs {
                        assert!(
                            (a - b).norm() < 1e-11 * (1.0 + b.norm()),
                            "{rows} x {columns} at {u}, {v}: {a} {b}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_restricted_patch_is_the_same_surface() {
        let weights: Vec<f64> = (0..16).map(|k| 1.0 + 0.3 * f64::from(k % 5)).collect();
        for patch in [wavy(None), wavy(Some(&weights))] {
            let part = patch.restrict((0.2, 0.7), (0.5, 0.9));
            for (s, t) in [(0.0, 0.0), (1.0, 1.0), (0.3, 0.8), (1.0, 0.0)] {
                let d = part.point(s, t) - patch.point(0.2 + 0.5 * s, 0.5 + 0.4 * t);
                assert!(d.norm() < 1e-12);
            }
        }
    }

    #[test]
    fn unsound_patches_are_refused() {
        let p = Point3::new(0.0, 0.0, 0.0);
        assert!(Patch::new(2, 2, &[p; 3], None).is_none());
        assert!(Patch::new(1, 4, &[p; 4], None).is_none());
        assert!(Patch::new(2, 2, &[p; 4], Some(&[1.0, 1.0, 0.0, 1.0])).is_none());
        assert!(Patch::new(2, 2, &[p, p, p, Point3::new(f64::NAN, 0.0, 0.0)], None).is_none());
    }
}
