//! Hand-made CL data of the plate cam of Kim & Yang (1991).

use crate::arena::Handle;
use crate::cl::{Cl, Contour, Guard, Lead, Operation, Record, RecordKind, Wall};
use crate::geom::cam::{Cam, CamDefinition, Flank};
use crate::geom::curve::CurveRef;
use crate::geom::follower::Follower;
use crate::geom::motion::{Law, Motion, Segment, SegmentLaw};
use crate::geom::{Point3, Side};
use crate::ir::{Band, Feed, Interpolation, Origin, Spindle, Tool};
use crate::source::{FileId, Span};
use crate::units::Angle;

pub struct Draft {
    pub cl: Cl,
    pub origin: Handle<Origin>,
}

impl Draft {
    /// Tool loaded, spindle on, feed 300 mm/min.
    pub fn new() -> Draft {
        let mut cl = Cl::default();
        let origin = cl.origins.push(Origin { span: Span::new(FileId(0), 0, 1), calls: Vec::new() });
        let tool = cl.tools.push(Tool::flat("T1", 16.0, None, origin));
        Draft { cl, origin }
            .add(RecordKind::LoadTool(tool))
            .add(RecordKind::Spindle(Spindle::on(1200.0, true)))
            .add(RecordKind::Feed(Feed::PerMinute(300.0)))
    }
    pub fn add(mut self, kind: RecordKind) -> Draft {
        self.cl.records.push(Record { kind, origin: self.origin });
        self
    }
    pub fn rapid(self, x: f64, y: f64, z: f64) -> Draft {
        self.add(RecordKind::Rapid(Point3::new(x, y, z)))
    }
    pub fn linear(self, x: f64, y: f64, z: f64) -> Draft {
        self.add(RecordKind::Linear(Point3::new(x, y, z)))
    }
    /// An operation with one contour.
    pub fn contour(mut self, contour: Contour) -> Draft {
        let wall = Wall { centre: contour.curve.clone(), part: contour.part };
        self.cl.operations.push(Operation {
            name: "FINISH".into(),
            kind: "PROFIL",
            origin: self.origin,
            band: contour.band,
            effort: None,
            guard: Guard { walls: vec![wall], bottom: -5.0, ..Guard::default() },
        });
        let index = u32::try_from(self.cl.operations.len()).unwrap() - 1;
        self.add(RecordKind::BeginOperation(index))
            .add(RecordKind::Contour(Box::new(contour)))
            .add(RecordKind::EndOperation(index))
    }
}

/// The paper's cam.
pub fn plate_cam() -> Cam {
    let ms = SegmentLaw::Law(Law::MODSIN);
    let motion = Motion::from_segments(vec![
        Segment::dwell(Angle::degrees(30.0)),
        Segment::rise(Angle::degrees(120.0), 20.0, ms),
        Segment::dwell(Angle::degrees(60.0)),
        Segment::fall(Angle::degrees(120.0), 20.0, ms),
        Segment::dwell(Angle::degrees(30.0)),
    ])
    .unwrap();
    Cam::new(CamDefinition::new(20.0, Follower::TranslatingRoller { radius: 8.0, offset: 0.0 }, motion))
        .unwrap()
}

/// The contour of the paper's cam for an 8 mm cutter radius, counter-clockwise, part on the left.
pub fn plate(interpolation: Interpolation, lead: Lead) -> Contour {
    contour(plate_cam().centre(Flank::Inner, 8.0), Side::Left, interpolation, lead)
}

pub fn contour(curve: CurveRef, part: Side, interpolation: Interpolation, lead: Lead) -> Contour {
    Contour {
        curve,
        part,
        band: Band { into: 0.01, out: 0.01 },
        interpolation,
        exact_dwells: false,
        levels: vec![-5.0],
        entry: lead,
        exit: lead,
        clearance: 5.0,
        approach: 2.0,
        plunge_feed: None,
        start: None,
    }
}
