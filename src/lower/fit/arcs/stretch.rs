//! A tangent-continuous stretch of the curve, sampled once for all deviations that fitting asks for.

use std::sync::{Arc, Mutex, PoisonError};

use super::start::Density;
use crate::geom::curve::{Frenet, PlanarCurve};
use crate::geom::{Point2, Vec2, cross, left};
use crate::lower::fit::FitError;
use crate::math;

/// Tangent jumps up to this many radians are not corners (a fifth of what a joint may have).
pub(in crate::lower::fit) const CORNER: f64 = 0.01 * math::DEG;
/// Largest turning between two samples, radians.
const SAMPLE_TURN: f64 = 0.16;
/// Samples per optimal arc, about: bounds |Δk| Δs² by 72√3 δ / SAMPLES³.
const SAMPLES: f64 = 22.0;
/// Smoothing windows of densities in one octave.
const WINDOWS_PER_OCTAVE: f64 = 4.0;
/// Deepest bisection of a smooth span while sampling.
const SAMPLE_DEPTH: u32 = 24;

/// One sample of the exact curve.
#[derive(Debug, Clone, Copy)]
pub(in crate::lower::fit) struct Sample {
    /// Curve parameter.
    pub u: f64,
    /// Arc length from the start of the stretch, mm.
    pub s: f64,
    /// Position, mm.
    pub p: Point2,
    /// Left unit normal.
    pub n: Vec2,
    /// Curvature, 1/mm.
    pub k: f64,
    /// Arc length per parameter, mm.
    pub speed: f64,
    /// Index of the curve's span it was taken in.
    pub span: usize,
}

/// A smooth span of the curve as part of a stretch.
#[derive(Debug, Clone, Copy)]
pub(in crate::lower::fit) struct Span {
    /// Index among the curve's spans.
    pub index: usize,
    /// Index of its first and last sample.
    pub samples: (usize, usize),
}

/// A stretch of a curve without corners inside.
#[derive(Debug)]
pub(in crate::lower::fit) struct Stretch<'a> {
    /// The exact curve.
    pub curve: &'a dyn PlanarCurve,
    /// Samples; the last of a span and the first of the next have the same `s`.
    pub samples: Vec<Sample>,
    /// Its smooth spans.
    pub spans: Vec<Span>,
    /// Whether the stretch is the whole of a closed curve without corners.
    pub closed: bool,
    /// Densities of joints that have been asked for.
    densities: Mutex<Vec<(u32, Arc<Density>)>>,
}

impl<'a> Stretch<'a> {
    /// Density of joints, smoothed to either side over about a share 1 / `windows` of the length.
    pub fn density(&self, windows: usize) -> Arc<Density> {
        // A few windows an octave serve all counts.
        let key = (WINDOWS_PER_OCTAVE * math::ln(windows.max(1) as f64) / core::f64::consts::LN_2).round();
        let densities = || self.densities.lock().unwrap_or_else(PoisonError::into_inner);
        let known = densities().iter().find(|(k, _)| *k == key as u32).map(|(_, d)| Arc::clone(d));
        known.unwrap_or_else(|| {
            let window = self.length() / math::pow(2.0, key / WINDOWS_PER_OCTAVE);
            let density = Arc::new(Density::new(self, window));
            densities().push((key as u32, Arc::clone(&density)));
            density
        })
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.samples.last().map_or(0.0, |q| q.s)
    }

    /// `s` brought into the stretch: modulo the length when closed, clamped otherwise.
    pub fn wrap(&self, s: f64) -> f64 {
        let length = self.length();
        if self.closed {
            let r = s - length * (s / length).floor();
            if r >= length { 0.0 } else { r }
        } else {
            s.clamp(0.0, length)
        }
    }

    /// Index j of the sample interval [j, j+1] that holds wrapped `s`, never one of zero length.
    pub fn interval(&self, s: f64) -> usize {
        let after = self.samples.partition_point(|q| q.s <= s);
        let mut j = after.clamp(1, self.samples.len() - 1) - 1;
        while j > 0 && self.samples[j + 1].s <= self.samples[j].s {
            j -= 1;
        }
        j
    }

    /// Curve parameter at arc length `s`, and its derivative by s: cubic Hermite between samples.
    pub fn parameter(&self, s: f64) -> (f64, f64) {
        let w = self.wrap(s);
        let j = self.interval(w);
        let (a, b) = (&self.samples[j], &self.samples[j + 1]);
        let h = b.s - a.s;
        let x = (w - a.s) / h;
        let (da, db) = (h / a.speed, h / b.speed);
        let d = b.u - a.u;
        let c2 = 3.0 * d - 2.0 * da - db;
        let c3 = da + db - 2.0 * d;
        (a.u + x * (da + x * (c2 + x * c3)), (da + x * (2.0 * c2 + 3.0 * x * c3)) / h)
    }

    /// Frenet data at arc length `s`, `speed` being mm per mm of `s` (about 1).
    pub fn at(&self, s: f64) -> Frenet {
        let (u, du) = self.parameter(s);
        let f = self.curve.at_in(self.samples[self.interval(self.wrap(s))].span, u);
        Frenet { speed: f.speed * du, ..f }
    }

    /// Frenet data at the very start or end of an open stretch, from inside.
    pub fn end(&self, last: bool) -> Frenet {
        let span = if last { self.spans[self.spans.len() - 1] } else { self.spans[0] };
        let q = if last { self.samples[span.samples.1] } else { self.samples[span.samples.0] };
        let f = self.curve.at_in(span.index, q.u);
        Frenet { speed: 1.0, ..f }
    }

    /// Samples with s strictly inside (a, b), unwrapped: `s` of what is yielded is on the same turn as a.
    pub fn between(&self, a: f64, b: f64) -> impl Iterator<Item = (f64, &Sample)> + '_ {
        let length = self.length();
        let turn = if self.closed { length * (a / length).floor() } else { 0.0 };
        let from = self.samples.partition_point(|q| q.s <= a - turn);
        let first = self.samples[from..].iter().map(move |q| (q.s + turn, q));
        let rest = self.closed.then_some(()).into_iter().flat_map(move |()| {
            (1..3).flat_map(move |lap| {
                let shift = turn + length * f64::from(lap);
                self.samples[1..].iter().map(move |q| (q.s + shift, q))
            })
        });
        first.chain(rest).take_while(move |(s, _)| *s < b)
    }
}

/// Angle from `a` to `b`, radians, in (-π, π].
pub(in crate::lower::fit) fn turn(a: Vec2, b: Vec2) -> f64 {
    math::atan2(cross(a, b), a.dot(&b))
}

/// Cuts the curve at its corners and samples the stretches. `half` is the half width of the band, mm;
/// `start` a preferred start parameter for a closed curve without corners.
pub(in crate::lower::fit) fn stretches(
    curve: &dyn PlanarCurve,
    half: f64,
) -> Result<Vec<Stretch<'_>>, FitError> {
    let breaks = curve.breaks();
    let spans = breaks.len().saturating_sub(1);
    if spans == 0 {
        return Err(FitError::BadCurve { u: curve.domain().0 });
    }
    let corner = |i: usize| {
        let (a, b) = (curve.at_in(i, breaks[i + 1]), curve.at_in((i + 1) % spans, breaks[(i + 1) % spans]));
        turn(a.t, b.t).abs() > CORNER
    };
    let cuts: Vec<usize> =
        (0..spans).filter(|&i| (i + 1 < spans || curve.is_closed()) && corner(i)).collect();
    if curve.is_closed() && cuts.is_empty() {
        return Ok(vec![sample_stretch(curve, (0..spans).collect(), true, half)?]);
    }
    let mut list: Vec<Vec<usize>> = vec![Vec::new()];
    let first = if curve.is_closed() { (cuts[cuts.len() - 1] + 1) % spans } else { 0 };
    for j in 0..spans {
        let i = (first + j) % spans;
        if let Some(last) = list.last_mut() {
            last.push(i);
        }
        if cuts.contains(&i) && j + 1 < spans {
            list.push(Vec::new());
        }
    }
    list.into_iter().map(|spans| sample_stretch(curve, spans, false, half)).collect()
}

fn sample_stretch(
    curve: &dyn PlanarCurve,
    indices: Vec<usize>,
    closed: bool,
    half: f64,
) -> Result<Stretch<'_>, FitError> {
    let mut samples: Vec<Sample> = Vec::new();
    let mut spans = Vec::new();
    let mut s = 0.0;
    for index in indices {
        let (u0, u1) = (curve.breaks()[index], curve.breaks()[index + 1]);
        let start = samples.len();
        let sampler =
            Sampler { curve, index, bend: 72.0 * 1.732_050_8 * half / (SAMPLES * SAMPLES * SAMPLES) };
        let a = sampler.sample(u0)?;
        samples.push(Sample { s, ..a });
        const FIRST: u32 = 4;
        let mut from = a;
        for i in 1..=FIRST {
            let u = if i == FIRST { u1 } else { u0 + (u1 - u0) * f64::from(i) / f64::from(FIRST) };
            let to = sampler.sample(u)?;
            s = sampler.refine(&from, &to, s, SAMPLE_DEPTH, &mut samples)?;
            from = to;
        }
        spans.push(Span { index, samples: (start, samples.len() - 1) });
    }
    Ok(Stretch { curve, samples, spans, closed, densities: Mutex::default() })
}

/// Adaptive sampling of one smooth span.
struct Sampler<'a> {
    curve: &'a dyn PlanarCurve,
    index: usize,
    /// Largest |Δk| Δs² between samples, mm.
    bend: f64,
}

impl Sampler<'_> {
    fn sample(&self, u: f64) -> Result<Sample, FitError> {
        let f = self.curve.at_in(self.index, u);
        let bad = !(f.p.x.is_finite() && f.p.y.is_finite() && f.k.is_finite() && f.t.x.is_finite());
        if bad || f.speed <= 0.0 || !f.speed.is_finite() {
            return Err(FitError::BadCurve { u });
        }
        Ok(Sample { u, s: 0.0, p: f.p, n: left(f.t), k: f.k, speed: f.speed, span: self.index })
    }

    /// Pushes the samples after `a` up to `b`; returns the arc length at `b`.
    fn refine(
        &self,
        a: &Sample,
        b: &Sample,
        s: f64,
        depth: u32,
        out: &mut Vec<Sample>,
    ) -> Result<f64, FitError> {
        let m = self.sample(0.5 * (a.u + b.u))?;
        // Simpson's rule; it only defines the stations, so its error is of no consequence.
        let ds = (b.u - a.u) * (a.speed + 4.0 * m.speed + b.speed) / 6.0;
        let dk = (m.k - a.k).abs().max((b.k - m.k).abs()) * 2.0;
        let turns = ds * (a.k.abs().max(m.k.abs()).max(b.k.abs()));
        let steady = (a.speed - b.speed).abs() <= 0.5 * a.speed.min(b.speed);
        if depth == 0 || (dk * ds * ds <= self.bend && turns <= SAMPLE_TURN && steady) {
            out.push(Sample { s: s + ds, ..*b });
            return Ok(s + ds);
        }
        let middle = self.refine(a, &m, s, depth - 1, out)?;
        self.refine(&m, b, middle, depth - 1, out)
    }
}
