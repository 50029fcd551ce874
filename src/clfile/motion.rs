//! Points.

use super::grammar::Statement;
use super::reader::{AxisTrouble, Reader};
use crate::cl::RecordKind;
use crate::diag::Diagnostic;
use crate::diag::codes::{foreign as codes, planning};
use crate::geom::{Point3, Vec3};

/// Sine of the largest angle between tool axis and Z that is none.
const ALONG_Z: f64 = 1e-6;
/// Coordinates beyond this, in mm, are no coordinates.
const LARGEST: f64 = 1e9;

impl Reader<'_> {
    /// `GOTO` with three numbers, or six with a tool axis.
    #[inline]
    pub(super) fn goto(&mut self, values: &[f64; 6], count: usize) {
        if self.state.nurbs.is_some() {
            self.flush_nurbs();
        }
        self.state.continues = true;
        if count == 6 {
            self.set_axis(Vec3::new(values[3], values[4], values[5]));
        }
        let Some(to) = self.point([values[0], values[1], values[2]]) else { return };
        self.point_to(to);
    }

    fn point_to(&mut self, to: Point3) {
        if self.off_axis() || self.state.cycle_failed {
            self.state.circle = None;
            self.state.at = Some(to);
            self.state.rapid = false;
        } else if self.state.circle.is_some() {
            self.on_circle(to);
        } else {
            self.move_to(to);
        }
    }

    /// A point in mm.
    pub(super) fn point(&mut self, values: [f64; 3]) -> Option<Point3> {
        let p = values.map(|v| v * self.state.scale);
        if p.iter().all(|v| v.abs() <= LARGEST) {
            return Some(Point3::from(p));
        }
        self.complain(&codes::BAD_RECORD, format!("a coordinate is beyond {LARGEST} mm"));
        None
    }

    fn set_axis(&mut self, axis: Vec3) {
        let length = axis.norm();
        if length > 0.0 && length.is_finite() {
            self.state.axis = axis / length;
        } else {
            self.complain(&codes::BAD_RECORD, "the tool axis has no length".to_owned());
        }
    }

    /// Whether the tool axis is off Z; counted, and reported once.
    pub(super) fn off_axis(&mut self) -> bool {
        let a = self.state.axis;
        if a.z > 0.0 && a.x.abs() <= ALONG_Z && a.y.abs() <= ALONG_Z {
            return false;
        }
        let axis = [a.x, a.y, a.z];
        match &mut self.axis_trouble {
            Some(trouble) => {
                trouble.count += 1;
                trouble.same &= (Vec3::from(trouble.axis) - a).norm() <= ALONG_Z;
            }
            None => self.axis_trouble = Some(AxisTrouble { first: self.span, axis, count: 1, same: true }),
        }
        true
    }

    pub(super) fn report_axis(&mut self, trouble: &AxisTrouble) {
        let [i, j, k] = trouble.axis.map(|v| (v * 1e7).round() / 1e7 + 0.0);
        let kind = if trouble.same { "all with this tool axis" } else { "with changing tool axes" };
        let message = format!(
            "the tool axis is ({i}, {j}, {k}), off Z: {} points, {kind}, need rotary axes, and the posts are for three",
            trouble.count
        );
        let diagnostic = Diagnostic::new(&codes::TOOL_AXIS, trouble.first, message);
        let help = if trouble.same {
            "set up the part so that the tool axis is Z, and write the CL file in that coordinate system"
        } else {
            "write the operation with a fixed tool axis"
        };
        self.tell(diagnostic.help(help));
    }

    /// Straight to a point: at rapid, as a hole of the cycle, or at feed.
    #[inline]
    pub(super) fn move_to(&mut self, to: Point3) {
        self.state.moved = true;
        if self.state.load.is_some() {
            // Where a new tool is nobody knows.
            self.flush_tool();
            self.begin_operation();
        } else if self.state.tool.unseen && self.state.loaded.is_some() {
            self.see_cutter();
        }
        if self.state.rapid {
            self.state.cycle_cut = None;
            self.rapid_in_cycle(to);
            self.rapid_to(to);
        } else if self.state.cycle.is_some() {
            self.hole(to);
        } else {
            if self.state.cycle_cut.is_some() {
                self.behind_cycle();
            }
            self.cut_to(to);
        }
    }

    fn rapid_to(&mut self, to: Point3) {
        self.pause_cycle();
        if self.before_first_tool() {
            self.state.rapid = false;
            self.state.first = Some((to, self.span));
            self.state.at = Some(to);
            return;
        }
        self.flush_tool();
        self.begin_operation();
        self.start_spindle();
        if !self.state.rapid {
            let message = "the first move after a tool change starts nobody knows where: it is made at rapid";
            self.complain(&codes::FIRST_AT_RAPID, message.to_owned());
        }
        self.state.rapid = false;
        self.record_compensation();
        self.emit(RecordKind::Rapid(to));
        self.state.at = Some(to);
        self.state.hole = None;
        self.state.sure = true;
    }

    /// No tool is there and none has been called: nothing can be moved to a point yet.
    pub(super) fn before_first_tool(&self) -> bool {
        self.state.loaded.is_none() && self.state.load.is_none()
    }

    /// Where a cut starts the control must have been told; after `FROM` it has not.
    pub(super) fn make_sure(&mut self) {
        if let (false, Some(at)) = (self.state.sure, self.state.at) {
            self.rapid_to(at);
        }
    }

    /// At feed.
    #[inline]
    pub(super) fn cut_to(&mut self, to: Point3) {
        if self.state.at.is_none() {
            // Nobody knows where the tool is: not at feed.
            return self.rapid_to(to);
        }
        self.make_sure();
        if self.ready() {
            self.emit(RecordKind::Linear(to));
        }
        self.state.at = Some(to);
        self.state.hole = None;
    }

    /// What a cut needs is there and in the CL data; what is missing is reported once.
    #[inline]
    pub(super) fn ready(&mut self) -> bool {
        if self.state.operation.is_none() || self.state.load.is_some() {
            self.flush_tool();
            self.begin_operation();
        }
        if !self.state.spindle_recorded {
            self.record_spindle();
        }
        if self.state.recorded_feed.is_none() || self.state.recorded_feed != self.state.feed {
            self.record_feed();
        }
        self.record_compensation();
        true
    }

    /// Once for each cause.
    pub(super) fn lacks(&mut self, what: &'static str) {
        if self.missing.contains(&what) {
            return;
        }
        self.missing.push(what);
        let (code, message, help) = match what {
            "SPINDL" => (
                &planning::SPINDLE_OFF,
                "the file cuts before it starts the spindle",
                "give the speed in the CAM system, or with -D SPINDL=1200",
            ),
            "SPINDL/ OFF" => (
                &planning::SPINDLE_OFF,
                "the file cuts while the spindle stands",
                "start it before these moves, or make them RAPID",
            ),
            "FEDRAT" => (
                &planning::NO_FEED,
                "the file cuts before it gives a feed",
                "give the feed in the CAM system, or with -D FEDRAT=300",
            ),
            _ => (
                &planning::NO_TOOL,
                "the file cuts and names no tool",
                "give the tool in the CAM system, or with -D LOADTL=1",
            ),
        };
        self.tell(Diagnostic::new(code, self.span, message).help(help));
    }

    /// Motion words.
    pub(super) fn motion(&mut self, s: &Statement) {
        let numbers = s.numbers();
        match s.major() {
            "RAPID" => {
                self.state.rapid = true;
                // A point may stand behind it.
                if numbers.len() >= 3 {
                    self.goto_numbers(&numbers);
                }
            }
            "GOTO" if s.only_numbers() => self.goto_numbers(&numbers),
            "GODLTA" if s.only_numbers() => self.delta(&numbers),
            "FROM" if s.only_numbers() => self.from(&numbers),
            "GOHOME" if numbers.len() >= 3 => {
                self.state.rapid = true;
                self.goto_numbers(&numbers);
            }
            "GOHOME" => self.go_home(),
            "TLAXIS" if numbers.len() == 3 => self.set_axis(Vec3::new(numbers[0], numbers[1], numbers[2])),
            "MULTAX" => {}
            word => self.complain(&codes::BAD_RECORD, format!("{word} takes numbers only")),
        }
    }

    fn goto_numbers(&mut self, numbers: &[f64]) {
        match *numbers {
            [x, y, z] => self.goto(&[x, y, z, 0.0, 0.0, 0.0], 3),
            [x, y, z, i, j, k] => self.goto(&[x, y, z, i, j, k], 6),
            // A feed behind the point.
            [x, y, z, feed] => {
                self.set_feed_number(feed);
                self.goto(&[x, y, z, 0.0, 0.0, 0.0], 3);
            }
            _ => {
                let message = format!("a point has 3 numbers, or 6 with a tool axis, not {}", numbers.len());
                self.complain(&codes::BAD_RECORD, message);
            }
        }
    }

    fn delta(&mut self, numbers: &[f64]) {
        let by = match *numbers {
            [x, y, z] => [x, y, z],
            // A feed behind it, as behind a point.
            [x, y, z, feed] => {
                self.set_feed_number(feed);
                [x, y, z]
            }
            [z] => [0.0, 0.0, z],
            _ => return self.complain(&codes::BAD_RECORD, "GODLTA takes 3 numbers".to_owned()),
        };
        // Over a hole it counts from the hole's point.
        match self.state.hole.or(self.state.at) {
            Some(p) => {
                let scale = self.state.scale;
                self.point_to(Point3::new(p.x + by[0] * scale, p.y + by[1] * scale, p.z + by[2] * scale));
            }
            None => {
                let message = "GODLTA counts from where the tool is, and that is not known yet";
                self.complain(&codes::BAD_RECORD, message.to_owned());
            }
        }
    }

    fn from(&mut self, numbers: &[f64]) {
        let [x, y, z, ..] = *numbers else {
            return self.complain(&codes::BAD_RECORD, "FROM takes 3 or 6 numbers".to_owned());
        };
        if let [_, _, _, i, j, k] = *numbers {
            self.set_axis(Vec3::new(i, j, k));
        }
        let Some(p) = self.point([x, y, z]) else { return };
        self.state.from = Some(p);
        if self.before_first_tool() {
            self.state.first = Some((p, self.span));
            self.state.at = Some(p);
            return;
        }
        self.flush_tool();
        self.begin_operation();
        self.start_spindle();
        // It is approached at rapid.
        self.emit(RecordKind::From(p));
        self.state.sure = true;
        self.state.at = Some(p);
        self.state.moved = true;
    }

    fn go_home(&mut self) {
        match self.state.from {
            Some(p) => {
                self.state.rapid = true;
                self.move_to(p);
            }
            // As the last move it is what the end of every post's program says.
            None => self.state.home = Some(self.span),
        }
    }

    /// The tool went home, nobody knows where, and moves on.
    pub(super) fn move_from_home(&mut self) {
        let Some(home) = self.state.home.take() else { return };
        self.as_of(home, |reader| {
            reader.soften(
                &codes::NOT_CARRIED_OUT,
                "GOHOME cannot be carried out: the file does not say where home is, and moves on from there"
                    .to_owned(),
                Some("give it a point, or put FROM at the start".to_owned()),
            );
        });
    }
}
