//! How near a cutter on a bent way comes to a surface, and how far it leaves it, with proven bounds.
//!
//! The way is cut into parts until each is so near to its chord that the chord's distances, more or less by what the part
//! leaves it, answer the question.

use super::{Cutter, extremes};
use crate::geom::Point3;
use crate::geom::surface::swept::{Extremes, Question};
use crate::geom::surface::tree::{Foot, SurfaceTree};

/// A way of a cutter's reference point over 0..=1.
pub struct Way<'a> {
    /// The place at a parameter.
    pub at: &'a dyn Fn(f64) -> Point3,
    /// No second derivative is larger, mm.
    pub bend: f64,
}

/// Parts of one way at most.
const MOST: u32 = 1 << 16;

impl Way<'_> {
    /// Parts whose chords leave them by no more than `sagitta` mm, or as many as are bearable.
    #[must_use]
    pub fn parts(&self, sagitta: f64) -> u32 {
        // A part of parameter length h leaves its chord by no more than bend h²/8.
        (self.bend / (8.0 * sagitta)).sqrt().ceil().clamp(1.0, f64::from(MOST)) as u32
    }

    /// How far parts of this number leave their chords at most, mm.
    #[must_use]
    pub fn sagitta(&self, parts: u32) -> f64 {
        self.bend / (8.0 * f64::from(parts) * f64::from(parts))
    }
}

/// Extremes of the distance along a bent way, as [`extremes`] tells them: `least` is a lower bound of the distance and
/// `most` an upper one, both of them within twice the accuracy wherever they go beyond what is enough and little.
#[must_use]
pub fn along(
    tree: &SurfaceTree,
    cutter: &Cutter,
    way: &Way<'_>,
    question: &Question,
    hint: Option<&Foot>,
) -> Option<Extremes> {
    let coarse = 0.1 * (question.little - question.enough).clamp(question.accuracy, 1e-2);
    let first = way.parts(coarse);
    let mut stack: Vec<(u32, u32)> = (0..first).rev().map(|k| (k, first)).collect();
    let mut total: Option<Extremes> = None;
    while let Some((k, parts)) = stack.pop() {
        let off = way.sagitta(parts);
        let place = |i: u32| (way.at)(f64::from(i) / f64::from(parts));
        let asked = Question { enough: question.enough + off, little: question.little - off, ..*question };
        let near = total.as_ref().map(|t| t.foot);
        let mut found = extremes(tree, cutter, place(k), place(k + 1), &asked, near.as_ref().or(hint));
        let short = found.least.distance < asked.enough - asked.accuracy;
        let long = found.most.distance > asked.little + asked.accuracy;
        if (short || long) && off > question.accuracy && parts < MOST {
            stack.push((2 * k + 1, 2 * parts));
            stack.push((2 * k, 2 * parts));
            continue;
        }
        found.least.distance -= off;
        found.most.distance += off;
        total = Some(total.map_or(found, |t| t.with(&found)));
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::surface::swept::tests::bowl;
    use crate::math::sin_cos;

    #[test]
    fn extremes_along_an_arc_are_those_of_dense_samples() {
        let tree = bowl();
        let (radius, sweep) = (60.0, 0.5);
        let at = |x: f64| {
            let (s, c) = sin_cos(sweep * (x - 0.5));
            Point3::new(30.0 + radius * s, 31.0, 17.6 - radius * (1.0 - c))
        };
        let way = Way { at: &at, bend: radius * sweep * sweep };
        let samples: Vec<f64> =
            (0..=4000u32).map(|k| tree.nearest(at(f64::from(k) / 4000.0), None).distance).collect();
        let least = samples.iter().copied().fold(f64::INFINITY, f64::min);
        let most = samples.iter().copied().fold(0.0, f64::max);
        let question = Question { enough: most, little: least, accuracy: 1e-6 };
        let found = along(&tree, &Cutter::ball(5.0), &way, &question, None).expect("extremes");
        let (low, high) = (found.least.distance, found.most.distance);
        assert!(low <= least + 1e-9 && low > least - 3e-6, "{low} {least}");
        assert!(high >= most - 1e-9 && high < most + 3e-6, "{high} {most}");
    }
}
