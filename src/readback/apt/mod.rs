//! APT CL text, after ISO 4343 and what NX, NCL and SolidWorks CAM write: points, circles, cycles and post words.
//!
//! A post processor would read it, not a control; it is executed as any of them would: RAPID holds for the next point,
//! CIRCLE says how the next point is reached, every point after CYCLE is a hole.

use super::out::Out;
use super::{Compensated, EventKind, FeedMode, Follow, MachineSetup, Tilted, TraceMove, TracePath, Washing};
use crate::geom::{Point3, Side, Vec3};
use crate::math::{TAU, atan2};

mod cycle;

#[cfg(test)]
mod tests;

/// Name of the control.
pub(super) const NAME: &str = "apt-cl";

/// How far a circle's end points may be off its radius, mm.
const OFF_CIRCLE: f64 = 0.01;
/// Sweep below which a circle is whole, radians.
const WHOLE: f64 = 1e-9;

/// What leads to the next point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Way {
    #[default]
    Feed,
    Rapid,
    Circle {
        centre: Point3,
        axis: Vec3,
        radius: f64,
    },
}

/// Executes CL text line by line.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    setup: &'a MachineSetup,
    at: Point3,
    known: bool,
    way: Way,
    inch: bool,
    /// mm/min, or mm/rev.
    feed: Option<f64>,
    per_revolution: bool,
    speed: f64,
    direction: f64,
    tool: u32,
    coolant: Washing,
    compensation: Option<Compensated>,
    cycle: Option<cycle::Cycle>,
    in_cycle: bool,
    over: bool,
}

impl<'a> Reader<'a> {
    /// Nothing has been read.
    pub(super) fn new(setup: &'a MachineSetup) -> Self {
        Reader {
            setup,
            at: Point3::origin(),
            known: false,
            way: Way::Feed,
            inch: false,
            feed: None,
            per_revolution: false,
            speed: 0.0,
            direction: 0.0,
            tool: 0,
            coolant: Washing::default(),
            compensation: None,
            cycle: None,
            in_cycle: false,
            over: false,
        }
    }

    fn unit(&self) -> f64 {
        if self.inch { 25.4 } else { 1.0 }
    }

    /// Executes a line without its end.
    pub(super) fn line<S: Follow>(&mut self, line: &[u8], out: &mut Out<'_, S>) {
        if let Some(&c) = line.iter().find(|c| !(c.is_ascii_graphic() || matches!(c, b' ' | b'\t'))) {
            out.fault(format!("bad character: byte 0x{c:02X}"));
        }
        let text = String::from_utf8_lossy(line);
        let free = |word: &str| {
            text.trim_start().strip_prefix(word).is_some_and(|r| r.is_empty() || r.starts_with(['/', ' ']))
        };
        if ["PARTNO", "PPRINT", "INSERT"].into_iter().any(free) {
            return;
        }
        let text = text.split("$$").next().unwrap_or_default().trim();
        if text.is_empty() {
            return;
        }
        if self.over {
            return out.fault("a record after FINI");
        }
        if text.ends_with('$') {
            return out.fault("a record that goes on in the next line");
        }
        let (word, rest) = text.split_once('/').map_or((text, None), |(w, r)| (w.trim(), Some(r)));
        let arguments: Vec<&str> = rest.map_or_else(Vec::new, |r| r.split(',').map(str::trim).collect());
        self.record(word, &arguments, out);
    }

    /// The text is over.
    pub(super) fn finish<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        if !self.over {
            out.fault("the text has no FINI");
        }
        if self.way != Way::Feed {
            out.fault("RAPID or CIRCLE without a point after it");
        }
    }

    fn record<S: Follow>(&mut self, word: &str, arguments: &[&str], out: &mut Out<'_, S>) {
        match word {
            "GOTO" => self.goto(arguments, out),
            "FROM" => {
                if let Some(p) = self.point(arguments, out) {
                    self.at = p;
                    self.known = true;
                }
            }
            "RAPID" if arguments.is_empty() => self.way = Way::Rapid,
            "CIRCLE" => self.circle(arguments, out),
            "CYCLE" => self.define(arguments, out),
            "UNITS" => match arguments {
                ["MM"] => self.inch = false,
                ["INCH"] | ["INCHES"] => self.inch = true,
                _ => out.fault("UNITS is MM or INCH"),
            },
            "FEDRAT" => self.feed_rate(arguments, out),
            "SPINDL" => self.spindle(arguments, out),
            "COOLNT" => match arguments {
                ["FLOOD" | "ON"] => self.coolant.flood = true,
                ["MIST"] => self.coolant.mist = true,
                ["THRU"] => self.coolant.through = true,
                ["OFF"] => self.coolant = Washing::default(),
                _ => out.fault("COOLNT is ON, FLOOD, MIST, THRU or OFF"),
            },
            "CUTCOM" => self.compensate(arguments, out),
            "LOADTL" => self.load(arguments.first().copied(), out),
            "LOAD" if arguments.first() == Some(&"TOOL") => self.load(arguments.get(1).copied(), out),
            "DELAY" => match arguments {
                [seconds] if value(seconds).is_some_and(|s| s >= 0.0) => {
                    out.event(EventKind::Dwell(value(seconds).unwrap_or_default()));
                }
                _ => out.fault("DELAY without its seconds"),
            },
            "STOP" => out.event(EventKind::Stop { optional: false }),
            "OPSTOP" => out.event(EventKind::Stop { optional: true }),
            "FINI" => {
                self.over = true;
                if self.direction != 0.0 {
                    out.fault("the program ends with the spindle turning");
                }
                out.event(EventKind::End);
            }
            "CUTTER" | "TLDATA" | "TOOL PATH" | "END-OF-PATH" | "END" | "PAINT" | "TOOLNO" | "MACHIN" => {}
            "MSYS" => self.system(arguments, out),
            _ => out.fault(format!("{word} is not followed by this reader")),
        }
    }

    /// Only the coordinate system in which X, Y and Z are themselves.
    fn system<S: Follow>(&self, arguments: &[&str], out: &mut Out<'_, S>) {
        let values: Vec<f64> = arguments.iter().filter_map(|a| value(a)).collect();
        let plain = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        if values.len() != 9 || values.iter().zip(plain).any(|(v, p)| (v - p).abs() > 1e-12) {
            out.fault("MSYS: another coordinate system, which this reader does not follow");
        }
    }

    fn point<S: Follow>(&self, arguments: &[&str], out: &mut Out<'_, S>) -> Option<Point3> {
        let values: Vec<f64> = arguments.iter().filter_map(|a| value(a)).collect();
        let [x, y, z] = values.as_slice() else {
            out.fault("a point has three coordinates here");
            return None;
        };
        if arguments.len() != 3 {
            out.fault("a point has three coordinates here");
            return None;
        }
        Some(Point3::new(*x, *y, *z) * self.unit())
    }

    fn circle<S: Follow>(&mut self, arguments: &[&str], out: &mut Out<'_, S>) {
        let values: Vec<f64> = arguments.iter().filter_map(|a| value(a)).collect();
        let [x, y, z, i, j, k, r] = values.as_slice() else {
            return out.fault("CIRCLE has centre, axis and radius: seven numbers");
        };
        let Some(axis) = Vec3::new(*i, *j, *k).try_normalize(0.5) else {
            return out.fault("the axis of CIRCLE is no unit vector");
        };
        let u = self.unit();
        self.way = Way::Circle { centre: Point3::new(*x, *y, *z) * u, axis, radius: r * u };
    }

    fn feed_rate<S: Follow>(&mut self, arguments: &[&str], out: &mut Out<'_, S>) {
        let (number, unit) = match arguments {
            [number] => (value(number), None),
            [number, unit] => match value(number) {
                Some(v) => (Some(v), Some(*unit)),
                None => (value(unit), Some(*number)),
            },
            _ => (None, None),
        };
        let Some(number) = number.filter(|v| *v > 0.0) else { return out.fault("FEDRAT without a feed") };
        self.per_revolution = matches!(unit, Some("PERREV" | "MMPR" | "IPR"));
        self.feed = match unit {
            Some("MMPM" | "MMPR") => Some(number),
            Some("IPM" | "IPR") => Some(number * 25.4),
            Some("PERMIN" | "PERREV") | None => Some(number * self.unit()),
            Some(other) => return out.fault(format!("{other} is no unit of feed")),
        };
    }

    fn spindle<S: Follow>(&mut self, arguments: &[&str], out: &mut Out<'_, S>) {
        if arguments == ["OFF"] {
            self.direction = 0.0;
            return;
        }
        let mut sense = 1.0;
        let mut rest = arguments.iter();
        while let Some(argument) = rest.next() {
            match *argument {
                // A gear changes neither speed nor sense.
                "RANGE" => match rest.next() {
                    Some(gear) if matches!(*gear, "LOW" | "MEDIUM" | "HIGH") || value(gear).is_some() => {}
                    _ => out.fault("RANGE without a gear in SPINDL"),
                },
                "CLW" => sense = 1.0,
                "CCLW" => sense = -1.0,
                "RPM" => {}
                other => match value(other) {
                    Some(speed) if speed > 0.0 => self.speed = speed,
                    _ => out.fault(format!("{other} in SPINDL")),
                },
            }
        }
        self.direction = sense;
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn compensate<S: Follow>(&mut self, arguments: &[&str], out: &mut Out<'_, S>) {
        let side = match arguments.first() {
            Some(&"LEFT") => Side::Left,
            Some(&"RIGHT") => Side::Right,
            Some(&"OFF") if arguments.len() == 1 => return self.compensation = None,
            _ => return out.fault("CUTCOM is LEFT, RIGHT or OFF"),
        };
        let register = match arguments.get(1..).unwrap_or_default() {
            [] => None,
            [number] => match value(number).filter(|n| n.fract() == 0.0 && (0.0..1e9).contains(n)) {
                Some(number) => Some(number as u32),
                None => return out.fault(format!("{number} in CUTCOM")),
            },
            _ => return out.fault("CUTCOM has at most a register behind the side"),
        };
        self.compensation = Some(Compensated { side, register });
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn load<S: Follow>(&mut self, number: Option<&str>, out: &mut Out<'_, S>) {
        let Some(number) = number.and_then(value).filter(|n| n.fract() == 0.0 && (0.0..1e9).contains(n))
        else {
            return out.fault("a tool change without the tool's number");
        };
        self.tool = number as u32;
        self.direction = 0.0;
        self.known = false;
        if self.setup.tools.as_ref().is_some_and(|known| !known.contains(&self.tool)) {
            out.fault(format!("tool {} is not in the tool table", self.tool));
        }
        out.event(EventKind::ToolChange(self.tool));
    }

    fn goto<S: Follow>(&mut self, arguments: &[&str], out: &mut Out<'_, S>) {
        let Some(to) = self.point(arguments, out) else { return };
        let way = core::mem::take(&mut self.way);
        if self.cycle.is_some() {
            if way != Way::Feed {
                out.fault("RAPID or CIRCLE inside a cycle");
            }
            return self.hole(to, out);
        }
        match way {
            Way::Rapid => self.straight(to, true, out),
            Way::Feed => self.straight(to, false, out),
            Way::Circle { centre, axis, radius } => self.round(to, centre, axis, radius, out),
        }
    }

    /// A straight move to a point.
    fn straight<S: Follow>(&mut self, to: Point3, rapid: bool, out: &mut Out<'_, S>) {
        let from = if self.known { self.at } else { to };
        self.emit(TracePath::Line { from: from.xy(), to: to.xy() }, from, to, rapid, out);
    }

    fn round<S: Follow>(
        &mut self,
        to: Point3,
        centre: Point3,
        axis: Vec3,
        radius: f64,
        out: &mut Out<'_, S>,
    ) {
        if !self.known {
            out.fault("CIRCLE from a position that is not known");
            return self.straight(to, false, out);
        }
        let from = self.at;
        let level = |p: Point3| p - centre - axis * (p - centre).dot(&axis);
        let (a, b) = (level(from), level(to));
        if a.norm() <= WHOLE
            || (a.norm() - radius).abs() > OFF_CIRCLE
            || (b.norm() - radius).abs() > OFF_CIRCLE
        {
            let u = self.unit();
            out.fault(format!(
                "the points are {:.6} and {:.6} from the axis, the radius is {:.6}",
                a.norm() / u,
                b.norm() / u,
                radius / u
            ));
            return self.straight(to, false, out);
        }
        let angle = atan2(a.cross(&b).dot(&axis), a.dot(&b));
        let sweep = if angle <= WHOLE { angle + TAU } else { angle };
        let middle = centre + axis * (from - centre).dot(&axis);
        let path = if axis.x == 0.0 && axis.y == 0.0 {
            let sweep = if axis.z < 0.0 { -sweep } else { sweep };
            TracePath::Arc { from: from.xy(), to: to.xy(), centre: middle.xy(), sweep }
        } else {
            TracePath::Tilted(Tilted { from, to, centre: middle, axis, sweep })
        };
        self.emit(path, from, to, false, out);
    }

    fn emit<S: Follow>(
        &mut self,
        path: TracePath,
        from: Point3,
        to: Point3,
        rapid: bool,
        out: &mut Out<'_, S>,
    ) {
        if !rapid && self.feed.is_none() {
            out.fault("a cut without FEDRAT before it");
        }
        let feed = self.feed.map(|f| if self.per_revolution { f * self.speed } else { f });
        let cut = TraceMove {
            path,
            z: (from.z, to.z),
            rapid,
            feed: feed.filter(|_| !rapid),
            feed_mode: if self.per_revolution { FeedMode::PerRevolution } else { FeedMode::PerMinute },
            spindle: self.direction * self.speed,
            tool: self.tool,
            known: [self.known; 3],
            parked: false,
            length_offset: self.tool != 0,
            coolant: self.coolant,
            compensation: self.compensation,
            work_offset: None,
            in_cycle: self.in_cycle,
            path_tolerance: 0.0,
        };
        self.at = to;
        self.known = true;
        out.event(EventKind::Move(cut));
    }
}

/// A whole decimal number.
fn value(text: &str) -> Option<f64> {
    let bytes = text.as_bytes();
    let (read, end) = super::number::number(bytes, 0).ok()?;
    (end == bytes.len()).then_some(read.value)
}
