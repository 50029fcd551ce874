//! Motions interpolated from discrete data.

use super::form::{Form, Piece};
use super::{ANGLE_CLOSURE, LARGEST_LIFT, LIFT_JUMP, MotionIssue, Span};
use crate::geom::tridiagonal::{End, slopes};
use crate::math::TAU;
use crate::units::Angle;

/// A checked table: one turn, last row a turn after the first.
pub(super) struct Table {
    angles: Vec<f64>,
    lifts: Vec<f64>,
    slopes: Vec<f64>,
}

impl Table {
    pub(super) fn new(rows: &[(Angle, f64)], periodic: bool) -> Result<Table, Vec<MotionIssue>> {
        let mut issues = row_issues(rows);
        let need = if periodic { 3 } else { 2 };
        let (Some(first), Some(last), true) = (rows.first(), rows.last(), rows.len() >= need) else {
            issues.push(MotionIssue::TableTooShort { rows: rows.len(), need });
            return Err(issues);
        };
        let span = last.0.rad() - first.0.rad();
        let full = (span - TAU).abs() <= ANGLE_CLOSURE;
        if !full && (!periodic || span > TAU) {
            issues.push(MotionIssue::TableSpan { span: Angle::radians(span) });
        }
        let largest = rows.iter().map(|r| r.1.abs()).fold(0.0, f64::max);
        if full && (first.1 - last.1).abs() > LIFT_JUMP * largest {
            issues.push(MotionIssue::TableEnds { first: first.1, last: last.1 });
        }
        if full && periodic && rows.len() < 4 {
            issues.push(MotionIssue::TableTooShort { rows: rows.len() - 1, need });
        }
        if issues.is_empty() { Ok(Table::build(rows, periodic, full)) } else { Err(issues) }
    }
    fn build(rows: &[(Angle, f64)], periodic: bool, full: bool) -> Table {
        let mut angles: Vec<f64> = rows.iter().map(|r| r.0.rad()).collect();
        let mut lifts: Vec<f64> = rows.iter().map(|r| r.1).collect();
        if full {
            angles.pop();
            lifts.pop();
        }
        angles.push(angles[0] + TAU);
        lifts.push(lifts[0]);
        let end = if periodic { End::Periodic } else { End::Clamped(Some(0.0), Some(0.0)) };
        let slopes = slopes(&angles, &lifts, end);
        Table { angles, lifts, slopes }
    }
    /// The spans in order of the reduced cam angle, the one that holds angle 0 cut there.
    pub(super) fn spans(&self) -> Vec<Span> {
        self.cuts().iter().map(|&(_, index, start)| self.span(index, start)).collect()
    }
    pub(super) fn breaks(&self) -> Vec<f64> {
        self.cuts().iter().map(|c| c.0).chain([TAU]).collect()
    }
    /// (cam angle where it starts within the turn, row, cam angle of the row's start shifted by whole turns).
    fn cuts(&self) -> Vec<(f64, usize, f64)> {
        let mut cuts = Vec::new();
        for i in 0..self.angles.len() - 1 {
            let turns = (self.angles[i] / TAU).floor();
            let start = self.angles[i] - turns * TAU;
            let end = self.angles[i + 1] - turns * TAU;
            let start_in = if start >= TAU - ANGLE_CLOSURE { 0.0 } else { start };
            cuts.push((start_in, i, if start_in == 0.0 && start > 1.0 { start - TAU } else { start }));
            if start_in > 0.0 && end > TAU + ANGLE_CLOSURE {
                cuts.push((0.0, i, start - TAU));
            }
        }
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(first) = cuts.first_mut().filter(|c| c.0 <= ANGLE_CLOSURE) {
            first.0 = 0.0;
        }
        cuts
    }
    /// The cubic between rows i and i + 1, as a polynomial of the angle past `start`.
    fn span(&self, i: usize, start: f64) -> Span {
        let h = self.angles[i + 1] - self.angles[i];
        let rise = (self.lifts[i + 1] - self.lifts[i]) / h;
        let (m, n) = (self.slopes[i], self.slopes[i + 1]);
        let c = [
            self.lifts[i],
            m,
            (3.0 * rise - 2.0 * m - n) / h,
            (m + n - 2.0 * rise) / (h * h),
            0.0,
            0.0,
            0.0,
            0.0,
        ];
        let rests = c[1..].iter().all(|v| *v == 0.0);
        let form = if rests { Form::Rest } else { Form::Polynomial(c) };
        let base = if rests { c[0] } else { 0.0 };
        Span {
            piece: Piece { from: 0.0, to: h, form },
            start,
            per_angle: 1.0,
            base,
            lift: 1.0,
            backwards: false,
        }
    }
}

fn row_issues(rows: &[(Angle, f64)]) -> Vec<MotionIssue> {
    let bad = |(row, r): (usize, &(Angle, f64))| {
        let good = r.0.rad().is_finite() && r.1.abs() <= LARGEST_LIFT;
        (!good).then_some(MotionIssue::TableValue { row })
    };
    let mut issues: Vec<MotionIssue> = rows.iter().enumerate().filter_map(bad).collect();
    let not_ascending = |(i, w): (usize, &[(Angle, f64)])| {
        let ascends = w[1].0.rad() - w[0].0.rad() > ANGLE_CLOSURE;
        (!ascends).then_some(MotionIssue::TableNotAscending { row: i + 1, angle: w[1].0, before: w[0].0 })
    };
    issues.extend(rows.windows(2).enumerate().filter_map(not_ascending));
    issues
}
