//! Mastercam's NCI: pairs of lines, a code and its numbers.
//!
//! Codes and the order of their numbers are known from descriptions and from how PostWorks reads them; no file of the
//! system itself was at hand. Drilling is [`super::nci_drill`].

use super::reader::Reader;
use super::scan;
use crate::cl::RecordKind;
use crate::diag::codes::foreign as codes;
use crate::geom::{Point3, Side, Vec3};
use crate::ir::{Compensation, Coolant};

/// A turn of the tool plane that is none.
const NO_TURN: f64 = 1e-9;
/// Characters of a bad number that a message shows.
const LONGEST_SAID: usize = 24;
/// Codes that do nothing a program must say.
const HARMLESS: &[i64] = &[
    1004, 1009, 1010, 1011, 1012, 1013, 1016, 1017, 1019, 1020, 1026, 1027, 1050, 10000, 20000, 20001, 20002,
    20003, 20004, 20005, 20006, 20007, 20008, 20009, 20010, 20100,
];

impl<'t> Reader<'t> {
    /// A physical line: the first of a pair is kept until the second comes.
    pub(super) fn pair_line(&mut self, line: &'t str, start: usize) {
        let trimmed = line.trim();
        match self.state.pair.take() {
            Some((code, _)) => self.pair(code, trimmed),
            None if trimmed.is_empty() => {}
            None => match trimmed.parse::<i64>() {
                Ok(code) => self.state.pair = Some((code, start)),
                Err(_) => {
                    let message = "a pair of lines starts with a code, which is a whole number";
                    self.complain(&codes::BAD_RECORD, message.to_owned());
                }
            },
        }
    }

    fn pair(&mut self, code: i64, text: &str) {
        if let 1005..=1008 = code {
            if !text.is_empty() {
                self.emit(RecordKind::Comment(text.to_owned()));
            }
            return;
        }
        if HARMLESS.contains(&code) {
            return;
        }
        match text.split_whitespace().map(|t| scan::number(t).ok_or(t)).collect::<Result<Vec<f64>, _>>() {
            Ok(numbers) => self.nci_record(code, &numbers),
            Err(text) => {
                let text: String = text.chars().take(LONGEST_SAID).collect();
                self.complain(&codes::BAD_RECORD, format!("the record {code} has `{text}` for a number"));
            }
        }
    }

    fn nci_record(&mut self, code: i64, numbers: &[f64]) {
        if !matches!(code, 81 | 100) {
            self.leave_cycle();
        }
        match code {
            0 | 1 => self.nci_line(code, numbers),
            2 | 3 => self.nci_arc(code, numbers),
            4 => self.nci_dwell(numbers),
            11 => self.nci_axis(numbers),
            80 => {}
            81 => self.nci_first_hole(numbers),
            100 => self.nci_next_hole(numbers),
            1000..=1002 => self.nci_tool(code, numbers),
            1003 => {
                self.state.ended = true;
                self.state.complete = true;
            }
            1014 => self.nci_plane(numbers),
            1018 => self.nci_not(1018, "starts a subprogram, and its calls are not followed"),
            1025 if numbers.iter().all(|v| *v == 0.0) => {}
            1025 => self.nci_not(1025, "holds canned text: stops or optional blocks"),
            _ => self.soften(&codes::UNKNOWN_RECORD, format!("the record {code} is not known"), None),
        }
    }

    /// The matrix of the tool plane, row by row.
    fn nci_plane(&mut self, n: &[f64]) {
        let turned = n.iter().take(9).enumerate().any(|(k, v)| (v - f64::from(k % 4 == 0)).abs() > NO_TURN);
        if turned && n.iter().any(|v| *v != 0.0) {
            self.nci_not(1014, "turns the tool plane, and the posts are for three axes");
        }
    }

    fn nci_not(&mut self, code: i64, what: &str) {
        self.soften(&codes::NOT_CARRIED_OUT, format!("the record {code} {what}"), None);
    }

    /// The control's compensation, which is a number of lines and arcs: 40 none, 41 left, 42 right.
    fn nci_compensated(&mut self, value: f64) {
        match value {
            41.0 => self.compensate(Compensation { side: Side::Left, register: None }),
            42.0 => self.compensate(Compensation { side: Side::Right, register: None }),
            40.0 => self.end_compensation(),
            _ => {}
        }
    }

    /// Compensation, x, y, z, feed (-2: rapid), flags.
    fn nci_line(&mut self, code: i64, n: &[f64]) {
        let [compensation, x, y, z, feed, ..] = *n else { return self.nci_short(code, 5, n.len()) };
        self.nci_compensated(compensation);
        if code == 0 || feed == -2.0 {
            self.state.rapid = true;
        } else if feed > 0.0 {
            self.set_feed_number(feed);
        }
        self.goto(&[x, y, z, 0.0, 0.0, 1.0], 6);
    }

    /// Plane (0 XY, 1 YZ, 2 XZ), compensation, end, centre, feed, flags.
    fn nci_arc(&mut self, code: i64, n: &[f64]) {
        let [plane, compensation, x, y, z, cx, cy, cz, feed, ..] = *n else {
            return self.nci_short(code, 9, n.len());
        };
        self.nci_compensated(compensation);
        if feed > 0.0 {
            self.set_feed_number(feed);
        }
        let axis = match plane as i64 {
            0 => Vec3::z(),
            1 => Vec3::x(),
            _ => Vec3::y(),
        };
        let axis = if code == 2 { -axis } else { axis };
        let (Some(to), Some(centre)) = (self.point([x, y, z]), self.point([cx, cy, cz])) else { return };
        let radius = self.state.at.map_or(0.0, |at| {
            let v: Vec3 = at - centre;
            (v - axis * v.dot(&axis)).norm()
        });
        self.known_arc(centre, axis, radius, 0, Point3::from(to));
    }

    fn nci_dwell(&mut self, n: &[f64]) {
        match n.first() {
            Some(seconds) if *seconds > 0.0 && *seconds < 1e6 => self.emit(RecordKind::Dwell(*seconds)),
            _ => {}
        }
    }

    /// Tool tip, then a point up the tool's axis.
    fn nci_axis(&mut self, n: &[f64]) {
        let [x, y, z, u, v, w, feed, ..] = *n else { return self.nci_short(11, 7, n.len()) };
        if feed == -2.0 {
            self.state.rapid = true;
        } else if feed > 0.0 {
            self.set_feed_number(feed);
        }
        self.goto(&[x, y, z, u - x, v - y, w - z], 6);
    }

    /// Program, block numbers, tool, offsets, plane, speed (negative: counter-clockwise), feed, coolant. The start of the
    /// file (1001) has the first tool; 1000 keeps the tool and may change the rest.
    fn nci_tool(&mut self, code: i64, n: &[f64]) {
        let [_, _, _, tool, _, _, _, speed, feed, coolant, ..] = *n else {
            return self.nci_short(code, 10, n.len());
        };
        self.leave_cycle();
        self.end_operation();
        let number = (tool >= 0.0 && tool.fract() == 0.0 && tool < 1e8).then_some(tool as u32);
        self.load(number);
        if speed != 0.0 {
            self.turn_at(speed.abs(), speed > 0.0);
        }
        if feed > 0.0 {
            self.set_feed_number(feed);
        }
        if coolant > 0.0 {
            self.switch_coolant(if coolant == 2.0 { Coolant::Mist } else { Coolant::Flood });
        }
    }

    pub(super) fn nci_short(&mut self, code: i64, wanted: usize, found: usize) {
        self.complain(
            &codes::BAD_RECORD,
            format!("the record {code} takes {wanted} numbers or more, not {found}"),
        );
    }
}
