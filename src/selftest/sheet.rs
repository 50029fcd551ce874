//! Small programs as CL data.

use std::sync::Arc;

use crate::arena::Handle;
use crate::cl::CycleKind;
use crate::cl::{Circle, Cl, Contour, Cycle, Guard, Lead, Operation, Record, RecordKind, RetractTo, Wall};
use crate::geom::curve::{CircularArc, CurveRef};
use crate::geom::{Point2, Point3, Side, Vec3};
use crate::ir::{Band, Feed, Interpolation, Origin, Spindle, Tool};
use crate::source::{FileId, Span};
use crate::units::LengthUnit;

/// A program under construction. It starts with a tool, the spindle on, 300 mm/min, and the cutter at 0, 0, 5.
pub(super) struct Sheet {
    pub cl: Cl,
    origin: Handle<Origin>,
    /// The first record of the row.
    pub watched: usize,
    /// Whether the machine has a rotary table.
    pub rotary: bool,
}

/// Height that is clear, mm.
pub(super) const CLEAR: f64 = 5.0;

impl Sheet {
    pub fn new(units: LengthUnit) -> Sheet {
        let mut cl = Cl { units, ..Cl::default() };
        let origin = cl.origins.push(Origin { span: Span::new(FileId(0), 0, 0), calls: Vec::new() });
        let sheet = Sheet { cl, origin, watched: 0, rotary: false };
        sheet.tool(1).spindle(1000.0).feed(Feed::PerMinute(300.0)).rapid(0.0, 0.0, CLEAR).watch()
    }
    pub fn mm() -> Sheet {
        Sheet::new(LengthUnit::Millimetre)
    }
    /// On a machine with a rotary table.
    pub fn with_rotary(mut self) -> Sheet {
        self.rotary = true;
        self
    }
    /// The row's own records begin here.
    pub fn watch(mut self) -> Sheet {
        self.watched = self.cl.records.len();
        self
    }
    pub fn watch_from(mut self, record: usize) -> Sheet {
        self.watched = record;
        self
    }
    pub fn title(mut self, title: &str) -> Sheet {
        self.cl.title = Some(title.to_owned());
        self
    }
    pub fn add(mut self, kind: RecordKind) -> Sheet {
        self.cl.records.push(Record { kind, origin: self.origin });
        self
    }
    pub fn tool(mut self, number: u32) -> Sheet {
        let tool = self.cl.tools.push(Tool::flat(format!("T{number}"), 10.0, Some(number), self.origin));
        self.add(RecordKind::LoadTool(tool))
    }
    pub fn spindle(self, rpm: f64) -> Sheet {
        self.add(RecordKind::Spindle(Spindle::on(rpm, true)))
    }
    pub fn feed(self, feed: Feed) -> Sheet {
        self.add(RecordKind::Feed(feed))
    }
    pub fn rapid(self, x: f64, y: f64, z: f64) -> Sheet {
        self.add(RecordKind::Rapid(Point3::new(x, y, z)))
    }
    pub fn line(self, x: f64, y: f64, z: f64) -> Sheet {
        self.add(RecordKind::Linear(Point3::new(x, y, z)))
    }
    /// About an axis through `centre` along `axis`, by the right-hand rule.
    pub fn circle(self, to: [f64; 3], centre: [f64; 3], axis: [f64; 3], turns: u32) -> Sheet {
        let circle = Circle {
            to: Point3::from(to),
            centre: Point3::from(centre),
            axis: Vec3::from(axis),
            turns,
            tolerance: 0.01,
        };
        self.add(RecordKind::Circle(Box::new(circle)))
    }
    /// One hole at 10, 0 and one at 20, 0, 6 mm deep from 0, with the clearance level at 2.
    pub fn cycle(self, kind: CycleKind, retract: RetractTo) -> Sheet {
        let dwell = matches!(kind, CycleKind::Dwell | CycleKind::BoreDwell).then_some(0.25);
        let feed = Feed::PerMinute(120.0);
        let cycle = Cycle {
            kind,
            depth: 6.0,
            clearance: 2.0,
            retract,
            peck: Some(2.5),
            first_peck: None,
            dwell,
            feed,
        };
        self.add(RecordKind::BeginCycle(Box::new(cycle)))
            .add(RecordKind::Hole(Point3::new(10.0, 0.0, 0.0)))
            .add(RecordKind::Hole(Point3::new(20.0, 0.0, 0.0)))
            .add(RecordKind::EndCycle)
    }
    /// Round a part whose cutter centre goes on a circle of 30 mm about 5, 0.
    pub fn contour(mut self, interpolation: Interpolation, levels: &[f64]) -> Sheet {
        let Some(circle) = CircularArc::circle(Point2::new(5.0, 0.0), 30.0, 0.0, true) else { return self };
        let curve: CurveRef = Arc::new(circle);
        let band = Band { into: 0.01, out: 0.01 };
        let bottom = levels.iter().copied().fold(0.0, f64::min);
        let wall = Wall { centre: curve.clone(), part: Side::Left };
        let guard = Guard { walls: vec![wall], bottom, ..Guard::default() };
        let (kind, name, origin) = ("PROFIL", "SELFTEST".to_owned(), self.origin);
        self.cl.operations.push(Operation { name, kind, origin, band, guard, effort: None });
        let contour = Contour {
            curve,
            part: Side::Left,
            band,
            interpolation,
            exact_dwells: false,
            levels: levels.to_vec(),
            entry: Lead::Plunge,
            exit: Lead::Plunge,
            clearance: CLEAR,
            approach: 2.0,
            plunge_feed: None,
            start: None,
        };
        self.add(RecordKind::BeginOperation(0))
            .add(RecordKind::Contour(Box::new(contour)))
            .add(RecordKind::EndOperation(0))
    }
}
