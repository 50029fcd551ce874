//! `CYCLE/…`: every point after it is a hole.

use super::{Reader, value};
use crate::geom::Point3;
use crate::readback::out::Out;
use crate::readback::{EventKind, Follow};

/// Most pecks of a hole.
const MOST_PECKS: f64 = 10_000.0;
/// How far a peck is backed out to break the chip, and where the rapid down stops before the last depth, mm.
const GAP: f64 = 0.5;

/// What the words of a cycle say; lengths in mm.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cycle {
    kind: Kind,
    depth: f64,
    clearance: f64,
    step: Option<f64>,
    pitch: Option<f64>,
    left: bool,
    feed: Option<CycleFeed>,
    dwell: f64,
    orient: bool,
    /// Back to the height where the cycle began.
    initial: Option<f64>,
}

/// Feed into the hole, mm/min or mm per revolution.
#[derive(Debug, Clone, Copy)]
struct CycleFeed {
    value: f64,
    per_revolution: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Kind {
    #[default]
    Drill,
    Face,
    Deep,
    BreakChip,
    Tap,
    Ream,
    Bore,
}

impl Reader<'_> {
    /// `CYCLE/kind, words` and `CYCLE/OFF`.
    pub(super) fn define<S: Follow>(&mut self, arguments: &[&str], out: &mut Out<'_, S>) {
        let Some((name, words)) = arguments.split_first() else { return out.fault("CYCLE without its kind") };
        let kind = match *name {
            "OFF" => {
                self.cycle = None;
                return;
            }
            "DRILL" => Kind::Drill,
            "FACE" => Kind::Face,
            "DEEP" => Kind::Deep,
            "BRKCHP" => Kind::BreakChip,
            "TAP" => Kind::Tap,
            "REAM" => Kind::Ream,
            // The tool is dragged out with the spindle stopped, or moved off the wall first; else out at feed.
            "BORE" if words.iter().any(|w| ["DRAG", "ORIENT"].contains(w)) => Kind::Bore,
            "BORE" => Kind::Ream,
            other => return out.fault(format!("CYCLE/{other} is not followed by this reader")),
        };
        let mut cycle = Cycle { kind, ..Cycle::default() };
        let mut words = words.iter().copied();
        while let Some(word) = words.next() {
            self.word(&mut cycle, word, &mut words, out);
        }
        if cycle.depth.is_nan() || cycle.depth <= 0.0 {
            return out.fault("CYCLE without FEDTO, the depth");
        }
        let pecks = matches!(kind, Kind::Deep | Kind::BreakChip);
        if pecks && !cycle.step.is_some_and(|s| s > 0.0 && (cycle.depth + cycle.clearance) / s <= MOST_PECKS)
        {
            return out.fault("CYCLE in pecks without a STEP");
        }
        if kind == Kind::Tap && cycle.pitch.is_none() {
            return out.fault("CYCLE/TAP without PITCH");
        }
        self.cycle = Some(cycle);
    }

    fn word<'w, S: Follow>(
        &self,
        cycle: &mut Cycle,
        word: &str,
        rest: &mut impl Iterator<Item = &'w str>,
        out: &mut Out<'_, S>,
    ) {
        let u = self.unit();
        match word {
            "CLW" => return cycle.left = false,
            "CCLW" => return cycle.left = true,
            "DRAG" => return,
            "RETURN" => {
                cycle.initial = (rest.next() != Some("OFF")).then_some(self.at.z);
                return;
            }
            _ => {}
        }
        let Some(number) = rest.next().and_then(value) else {
            return out.fault(format!("{word} of CYCLE without its number"));
        };
        match word {
            "FEDTO" => cycle.depth = number * u,
            "CLEAR" => cycle.clearance = number * u,
            "STEP" => cycle.step = Some(number * u),
            "PITCH" => cycle.pitch = Some(number * u),
            "MMPM" => cycle.feed = Some(CycleFeed { value: number, per_revolution: false }),
            "IPM" => cycle.feed = Some(CycleFeed { value: number * 25.4, per_revolution: false }),
            "PERREV" => cycle.feed = Some(CycleFeed { value: number * u, per_revolution: true }),
            "DWELL" => cycle.dwell = number,
            "ORIENT" => cycle.orient = true,
            other => out.fault(format!("{other} in CYCLE is not followed by this reader")),
        }
    }

    /// A hole at its point on the surface.
    pub(super) fn hole<S: Follow>(&mut self, point: Point3, out: &mut Out<'_, S>) {
        let Some(cycle) = self.cycle else { return };
        let kept = (self.feed, self.direction, self.per_revolution);
        let (r, bottom) = (point.z + cycle.clearance, point.z - cycle.depth);
        self.in_cycle = true;
        (self.feed, self.per_revolution) = match (cycle.pitch, cycle.feed) {
            (Some(pitch), _) if cycle.kind == Kind::Tap => (Some(pitch * self.speed), false),
            (_, Some(feed)) => (Some(feed.value), feed.per_revolution),
            (_, None) => (kept.0, kept.2),
        };
        if cycle.kind == Kind::Tap && (self.direction < 0.0) != cycle.left {
            self.direction = if cycle.left { -1.0 } else { 1.0 };
        }
        let over = if self.known { self.at.z.max(r) } else { r };
        if self.known && self.at.z < r {
            self.vertical(r, true, out);
        }
        self.leg(Point3::new(point.x, point.y, over), true, out);
        self.vertical(r, true, out);
        self.down(&cycle, r, bottom, out);
        if cycle.dwell > 0.0 {
            out.event(EventKind::Dwell(cycle.dwell));
        }
        match cycle.kind {
            Kind::Tap => {
                self.direction = -self.direction;
                self.vertical(r, false, out);
            }
            Kind::Ream => self.vertical(r, false, out),
            Kind::Bore => self.direction = 0.0,
            Kind::Drill | Kind::Face | Kind::Deep | Kind::BreakChip => {}
        }
        self.vertical(cycle.initial.map_or(r, |z| z.max(r)), true, out);
        (self.feed, self.direction, self.per_revolution) = kept;
        self.in_cycle = false;
    }

    fn down<S: Follow>(&mut self, cycle: &Cycle, r: f64, bottom: f64, out: &mut Out<'_, S>) {
        let pecked = matches!(cycle.kind, Kind::Deep | Kind::BreakChip);
        let step = cycle.step.filter(|_| pecked).unwrap_or(f64::INFINITY);
        let mut depth = r;
        loop {
            depth -= step;
            if depth <= bottom + 1e-9 {
                return self.vertical(bottom, false, out);
            }
            self.vertical(depth, false, out);
            if cycle.kind == Kind::Deep {
                self.vertical(r, true, out);
            }
            self.vertical((depth + GAP).min(r), true, out);
        }
    }

    fn vertical<S: Follow>(&mut self, z: f64, rapid: bool, out: &mut Out<'_, S>) {
        self.leg(Point3::new(self.at.x, self.at.y, z), rapid, out);
    }

    fn leg<S: Follow>(&mut self, to: Point3, rapid: bool, out: &mut Out<'_, S>) {
        if !self.known || to != self.at {
            self.straight(to, rapid, out);
        }
    }
}
