//! Mastercam's NCI: pairs of lines, a code and its numbers.
//!
//! Codes and counts are known from descriptions; no file of the system itself was at hand. Drilling records are refused:
//! the order of their 19 numbers is not known well enough to drill by.

use super::reader::Reader;
use super::scan;
use crate::cl::RecordKind;
use crate::diag::codes::foreign as codes;
use crate::geom::{Point3, Vec3};
use crate::ir::Coolant;

/// Codes that do nothing a program must say.
const HARMLESS: &[i64] = &[
    1000, 1001, 1004, 1009, 1010, 1011, 1012, 1013, 1014, 1016, 1017, 1018, 1019, 1020, 1025, 1026, 1027,
    1050, 20000, 20001, 20002, 20003, 20004, 20005, 20006, 20007, 20008, 20009, 20010, 20100, 2,
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
        let numbers: Option<Vec<f64>> = text.split_whitespace().map(scan::number).collect();
        let numbers = numbers.unwrap_or_default();
        match code {
            0 | 1 => self.nci_line(code, &numbers),
            2 | 3 => self.nci_arc(code, &numbers),
            4 => self.nci_dwell(&numbers),
            11 => self.nci_axis(&numbers),
            1002 => self.nci_tool(&numbers),
            1003 => self.state.ended = true,
            80 => {}
            // Further holes of a cycle that was refused.
            100 | 101 => {}
            81..=89 => {
                let message = format!(
                    "the drilling record {code} of NCI is not read: the order of its numbers is not known"
                );
                self.soften(&codes::NOT_CARRIED_OUT, message, Some("write drilling as moves".to_owned()));
            }
            _ if HARMLESS.contains(&code) => {}
            _ => self.soften(&codes::UNKNOWN_RECORD, format!("the record {code} is not known"), None),
        }
    }

    /// Compensation, x, y, z, feed (-2: rapid), flags.
    fn nci_line(&mut self, code: i64, n: &[f64]) {
        let [_, x, y, z, feed, ..] = *n else { return self.nci_short(code, 5, n.len()) };
        if code == 0 || feed == -2.0 {
            self.state.rapid = true;
        } else if feed > 0.0 {
            self.set_feed_number(feed);
        }
        self.goto(&[x, y, z, 0.0, 0.0, 0.0], 3);
    }

    /// Plane (0 XY, 1 YZ, 2 XZ), compensation, end, centre, feed, flags.
    fn nci_arc(&mut self, code: i64, n: &[f64]) {
        let [plane, _, x, y, z, cx, cy, cz, feed, ..] = *n else { return self.nci_short(code, 9, n.len()) };
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

    /// Program, block numbers, tool, offsets, plane, speed (negative: counter-clockwise), feed, coolant.
    fn nci_tool(&mut self, n: &[f64]) {
        let [_, _, _, tool, _, _, _, speed, feed, coolant, ..] = *n else {
            return self.nci_short(1002, 10, n.len());
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

    fn nci_short(&mut self, code: i64, wanted: usize, found: usize) {
        self.complain(
            &codes::BAD_RECORD,
            format!("the record {code} takes {wanted} numbers or more, not {found}"),
        );
    }
}
