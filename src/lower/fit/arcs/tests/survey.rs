//! Counts on many cams and curves.

use std::sync::Arc;

use super::super::arcs;
use super::super::search::{Wish, fewest};
use super::super::start::Density;
use super::super::stretch::stretches;
use super::trace::{Measured, measure};
use crate::geom::cam::{Cam, CamDefinition, Flank};
use crate::geom::curve::{CurveRef, Frenet, PlanarCurve};
use crate::geom::follower::{ArmSide, Follower};
use crate::geom::motion::{Law, Motion, Segment, SegmentKind, SegmentLaw};
use crate::geom::{Point2, Vec2};
use crate::lower::fit::{Fit, Grid, Tube};
use crate::math;
use crate::units::Angle;

/// Closed curve in polar form r(θ) = Σ aₖ cos(kθ + φₖ).
#[derive(Debug)]
pub(in crate::lower::fit) struct Harmonic {
    pub terms: Vec<(f64, f64, f64)>,
    breaks: Vec<f64>,
}

impl Harmonic {
    pub fn new(terms: Vec<(f64, f64, f64)>) -> Harmonic {
        Harmonic { terms, breaks: vec![0.0, math::TAU] }
    }
}

impl PlanarCurve for Harmonic {
    fn domain(&self) -> (f64, f64) {
        (0.0, math::TAU)
    }
    fn at(&self, t: f64) -> Frenet {
        let (mut r, mut v, mut a) = (0.0, 0.0, 0.0);
        for (k, size, phase) in &self.terms {
            let (s, c) = math::sin_cos(k * t + phase);
            r += size * c;
            v -= size * k * s;
            a -= size * k * k * c;
        }
        let (sin, cos) = math::sin_cos(t);
        let (u, n) = (Vec2::new(cos, sin), Vec2::new(-sin, cos));
        let speed = math::hypot(v, r);
        let k = (r * r + 2.0 * v * v - r * a) / (speed * speed * speed);
        Frenet { p: Point2::from(u * r), t: (u * v + n * r) / speed, speed, k }
    }
    fn at_in(&self, _span: usize, u: f64) -> Frenet {
        self.at(u)
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn is_closed(&self) -> bool {
        true
    }
}

fn motion(parts: &[(SegmentKind, f64, f64, &str)]) -> Motion {
    let segments = parts
        .iter()
        .filter(|p| p.1 > 0.0)
        .map(|&(kind, angle, lift, law)| Segment {
            kind,
            angle: Angle::degrees(angle),
            lift,
            law: SegmentLaw::Law(Law::by_name(if law.is_empty() { "MODSIN" } else { law }).unwrap()),
        })
        .collect();
    Motion::from_segments(segments).unwrap()
}

fn drdr(d1: f64, rise: f64, d2: f64, fall: f64, lift: f64, laws: (&str, &str)) -> Motion {
    use SegmentKind::{Dwell, Return, Rise};
    motion(&[
        (Dwell, d1, 0.0, ""),
        (Rise, rise, lift, laws.0),
        (Dwell, d2, 0.0, ""),
        (Return, fall, lift, laws.1),
        (Dwell, 360.0 - d1 - rise - d2 - fall, 0.0, ""),
    ])
}

fn roller(radius: f64, offset: f64) -> Follower {
    Follower::TranslatingRoller { radius, offset }
}

/// Cutter centre paths of various cams.
pub(in crate::lower::fit) fn cams() -> Vec<(String, CurveRef)> {
    let mut out: Vec<(String, CurveRef)> = Vec::new();
    let mut add = |name: &str, base: f64, follower: Follower, motion: Motion, cutter: f64| match Cam::new(
        CamDefinition::new(base, follower, motion),
    ) {
        Ok(cam) => out.push((name.to_string(), cam.centre(Flank::Inner, cutter))),
        Err(issues) => println!("{name}: {issues:?}"),
    };
    for law in Law::all() {
        if ["CV"].contains(&law.name()) {
            continue;
        }
        let m = drdr(30.0, 120.0, 60.0, 120.0, 20.0, (law.name(), law.name()));
        add(&format!("paper {}", law.name()), 20.0, roller(8.0, 0.0), m, 8.0);
    }
    add("general 1", 31.7, roller(6.35, 4.0), drdr(17.0, 98.0, 41.0, 133.0, 13.3, ("CYCLO", "P345")), 5.0);
    add("general 2", 44.0, roller(10.0, -3.0), drdr(0.0, 141.0, 12.0, 97.0, 27.0, ("P4567", "MODTRAP")), 8.0);
    add("general 3", 25.0, roller(5.0, 0.0), drdr(55.0, 71.0, 99.0, 83.0, 7.7, ("MODSIN", "CYCLO")), 3.0);
    add("big", 150.0, roller(20.0, 10.0), drdr(40.0, 100.0, 30.0, 120.0, 60.0, ("P345", "MODSIN")), 10.0);
    add("small", 6.0, roller(2.0, 0.0), drdr(40.0, 100.0, 30.0, 120.0, 1.5, ("P345", "MODSIN")), 1.0);
    let arm = Follower::OscillatingRoller { radius: 8.0, arm: 70.0, pivot: 80.0, side: ArmSide::Right };
    add("arm", 30.0, arm, drdr(30.0, 120.0, 60.0, 120.0, 20.0 * math::DEG, ("MODSIN", "MODSIN")), 8.0);
    let face = Follower::OscillatingFlat { pivot: 110.0, offset: 0.0, side: ArmSide::Left };
    add("face", 50.0, face, drdr(30.0, 120.0, 60.0, 120.0, 10.0 * math::DEG, ("CYCLO", "CYCLO")), 6.0);
    let flat = Follower::TranslatingFlat { offset: 0.0 };
    add("flat", 60.0, flat, drdr(25.0, 120.0, 45.0, 140.0, 15.0, ("P345", "MODSIN")), 6.0);
    out
}

/// Smooth closed curves that are no cams.
fn harmonics() -> Vec<(String, CurveRef)> {
    type Harmonics = (&'static str, &'static [(f64, f64, f64)]);
    let list: [Harmonics; 5] = [
        ("eccentric", &[(0.0, 40.0, 0.0), (1.0, 6.0, 0.3)]),
        ("oval", &[(0.0, 40.0, 0.0), (2.0, 5.0, 0.9)]),
        ("trefoil", &[(0.0, 40.0, 0.0), (3.0, 6.0, 0.1)]),
        ("five", &[(0.0, 60.0, 0.0), (5.0, 5.0, 0.1), (2.0, 4.0, 1.0)]),
        ("rough", &[(0.0, 60.0, 0.0), (3.0, 3.0, 0.1), (7.0, 1.5, 1.0), (11.0, 0.7, 2.0)]),
    ];
    list.into_iter()
        .map(|(name, terms)| (name.to_string(), Arc::new(Harmonic::new(terms.to_vec())) as CurveRef))
        .collect()
}

pub(in crate::lower::fit) fn curves() -> Vec<(String, CurveRef)> {
    let mut all = cams();
    all.extend(harmonics());
    all
}

/// Everything a printed chain must satisfy.
pub(in crate::lower::fit) fn check(name: &str, tube: &Tube<'_>, grid: &Grid, fit: &Fit) -> Measured {
    let m = measure(fit, tube.curve, grid);
    assert!(m.left <= tube.left + 1e-7 && m.right <= tube.right + 1e-7, "{name}: {m:?}");
    assert!(m.left <= fit.deviation.0 + 1e-6 && m.right <= fit.deviation.1 + 1e-6, "{name}: {m:?} {fit:?}");
    let bound = fit.lower_bound.unwrap_or(0) as usize;
    assert!(bound <= fit.primitives.len(), "{name}: {bound} > {}", fit.primitives.len());
    assert!(m.kink <= 0.05 && m.mismatch <= 0.002 && m.gap == 0, "{name}: {m:?}");
    m
}

#[test]
#[ignore = "prints a table; run with --ignored --nocapture in release"]
fn survey() {
    let (mut total, mut better) = (0, 0);
    for (left, right, step) in [(0.01, 0.01, 0.001), (0.01, 0.0, 0.001), (0.003, 0.003, 0.00254)] {
        println!("band -{right} +{left} step {step}");
        for (name, curve) in curves() {
            let tube = Tube { curve: curve.as_ref(), left, right };
            let grid = Grid { step, centre_step: step, angle_step: 0.001 };
            let mut time = f64::INFINITY;
            let mut fit = arcs(&tube, &grid, false, None);
            for _ in 0..2 {
                let clock = cpu_ms();
                fit = arcs(&tube, &grid, false, None);
                time = time.min(cpu_ms() - clock);
            }
            let list = stretches(curve.as_ref(), 0.5 * (left + right)).unwrap();
            let asymptotic: f64 = list
                .iter()
                .map(|s| {
                    Density::new(s, s.length() / 100.0).total()
                        / math::cbrt(36.0 * 3.0_f64.sqrt() * (left + right))
                })
                .sum();
            match fit {
                Ok(fit) => {
                    let m = check(&name, &tube, &grid, &fit);
                    let best = exhaustive(&tube, fit.primitives.len());
                    total += fit.primitives.len();
                    better += fit.primitives.len().min(best);
                    println!(
                        "{name:18} n {:3} (best {best:3}) asymptotic {asymptotic:6.2} bound {:?} dev {:.5} {:.5} kink {:.4} mis {:.5} {time:.1} ms",
                        fit.primitives.len(),
                        fit.lower_bound,
                        m.left,
                        m.right,
                        m.kink,
                        m.mismatch
                    );
                }
                Err(e) => println!("{name:18} {e}"),
            }
        }
    }
    println!("total {total}, best known {better}");
}

/// Time this thread has run, ms.
fn cpu_ms() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|t| t.parse::<f64>().ok()).unwrap_or(0.0) * 1e-6
}

/// Fewest arcs that many starts find, before rounding.
fn exhaustive(tube: &Tube<'_>, n: usize) -> usize {
    use super::super::chain::{Band, Goal};
    use super::super::optimise::{Stop, improve};
    use super::super::start::spread;
    let half = 0.5 * (tube.left + tube.right);
    let mut best = n;
    for stretch in stretches(tube.curve, half).unwrap() {
        if !stretch.closed {
            continue;
        }
        let goal = Goal { band: Band { middle: 0.5 * (tube.left - tube.right), half }, tangent: 2e-6 };
        let wish = Wish { goal, ends: None, exact: false, radius: 1e5 };
        let _ = fewest(&stretch, &wish);
        while best > 3 {
            let mut found = false;
            'all: for window in [1.0, 2.0, 4.0, 8.0] {
                for i in 0..8 {
                    let d = Density::new(&stretch, stretch.length() / (window * best as f64));
                    let chain = spread(&stretch, &d, best - 1, f64::from(i) / 8.0, goal.band.middle);
                    let stop = Stop { target: 0.97 * half, iterations: 60, gain: 1e-3, smooth: true };
                    if improve(chain, &stretch, &goal, &stop).1 <= 0.97 * half {
                        found = true;
                        break 'all;
                    }
                }
            }
            if !found {
                break;
            }
            best -= 1;
        }
    }
    best
}

#[test]
#[ignore = "prints times; run with --ignored --nocapture in release"]
fn speed() {
    for (left, right, exact) in
        [(0.01, 0.01, false), (0.01, 0.01, true), (0.01, 0.0, false), (0.0001, 0.0001, false)]
    {
        let curve = super::paper();
        let tube = Tube { curve: curve.as_ref(), left, right };
        let grid = Grid { step: 1e-5, centre_step: 1e-5, angle_step: 0.001 };
        let mut time = f64::INFINITY;
        let mut n = 0;
        for _ in 0..15 {
            let clock = cpu_ms();
            n = arcs(&tube, &grid, exact, None).unwrap().primitives.len();
            time = time.min(cpu_ms() - clock);
        }
        println!("speed {left} {right} {exact} n {n} {time:.2} ms");
    }
}
