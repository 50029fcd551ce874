//! Members of named things: `C1.MAXPA`, `P1.X`.

use crate::arena::Handle;
use crate::diag::codes::semantics as codes;
use crate::diag::{Diagnostic, did_you_mean};
use crate::geom::motion::SegmentKind;
use crate::ir::{CamEntity, Stock, StockShape, Tool};
use crate::math::{self, DEG, TAU};
use crate::syntax::ast::Name;
use crate::units::{Dim, Quantity, tidy};
use crate::vocab::{self, EntityKind, Statement};

use super::Analyser;
use super::arithmetic::Placed;
use super::value::{Entity, MotionSource, MotionValue, SegmentShape, Value, Vector};

impl Analyser<'_> {
    /// `value.member`.
    pub(super) fn member(&mut self, (value, span): &Placed, member: &Name) -> Value {
        let kind = match value {
            Value::Poison => return Value::Poison,
            Value::Vector(_) => EntityKind::Point,
            Value::Entity(entity) => entity.kind(),
            other => {
                let message = format!("{} has no members", other.kind_name());
                self.report(
                    Diagnostic::new(&codes::UNKNOWN_MEMBER, member.span, message)
                        .label(*span, other.kind_name()),
                );
                return Value::Poison;
            }
        };
        let Some(row) = vocab::find(kind.word()) else { return Value::Poison };
        let Some(known) = row.member(&member.text) else {
            let problem = unknown_member(kind, row, member);
            self.report(problem);
            return Value::Poison;
        };
        match self.member_value(value, known.name) {
            Some(found) => found,
            None => {
                let message = format!("this {} has no {}", kind.name().trim_start_matches("a "), known.name);
                self.report(Diagnostic::new(&codes::UNKNOWN_MEMBER, member.span, message));
                Value::Poison
            }
        }
    }

    fn member_value(&self, value: &Value, name: &str) -> Option<Value> {
        match value {
            Value::Vector(v) => component(*v, name),
            Value::Entity(Entity::Line(line)) => {
                let (dx, dy) = (line.to[0] - line.from[0], line.to[1] - line.from[1]);
                Some(match name {
                    "ANGLE" => Value::number(math::atan2(dy, dx) / DEG, Dim::ANGLE),
                    _ => length(math::hypot(dx, dy)),
                })
            }
            Value::Entity(Entity::Circle(circle)) => match name {
                "RADIUS" => Some(length(circle.radius)),
                "DIAMETER" => Some(length(2.0 * circle.radius)),
                "CENTER" => Some(Value::Vector(Vector { v: circle.centre, dim: Dim::LENGTH })),
                "LENGTH" => Some(length(TAU * circle.radius)),
                _ => component(Vector { v: circle.centre, dim: Dim::LENGTH }, name),
            },
            Value::Entity(Entity::Plane(plane)) => Some(match name {
                "NORMAL" => Value::Vector(Vector { v: plane.normal, dim: Dim::NONE }),
                _ => length(plane.distance),
            }),
            Value::Entity(Entity::Pattern(points)) => Some(Value::bare(math::count(points.len()))),
            Value::Entity(Entity::Follower(f)) => match name {
                "RADIUS" => Some(length(f.roller.unwrap_or(0.0))),
                "OFFSET" => Some(length(f.offset)),
                "ARM" => (!f.translating && f.roller.is_some()).then(|| length(f.arm)),
                _ => (!f.translating).then(|| length(f.pivot)),
            },
            Value::Entity(Entity::Motion(motion)) => Some(motion_member(motion, name)),
            Value::Entity(Entity::Cam(cam)) => self.cam_member(*cam, name),
            Value::Entity(Entity::Cutter(tool)) => cutter_member(&self.program.tools[*tool], name),
            Value::Entity(Entity::Stock(stock)) => self.stock_member(*stock, name),
            Value::Entity(Entity::Net(net)) => self.net_member(*net, name),
            _ => None,
        }
    }

    fn cam_member(&self, cam: Handle<CamEntity>, name: &str) -> Option<Value> {
        let cam = &self.program.cams[cam].cam;
        let figures = cam.figures();
        let degrees = |radians: f64| Value::number(tidy(radians / DEG), Dim::ANGLE);
        Some(match name {
            "MAXPA" => degrees(figures.pressure_angle.value),
            "MAXPAAT" => degrees(figures.pressure_angle.at.rad()),
            "MINRAD" => length(figures.inner.convex?.value),
            "MINCONCAVE" => length(figures.inner.concave?.value),
            "LENGTH" => length(figures.inner.length),
            "FACEWIDTH" => length(figures.face?.width()),
            "AREA" => Value::number(figures.inner.area, Dim::AREA),
            "BASE" => length(cam.definition().base),
            "MAXRADIUS" => length(figures.inner.farthest.value),
            "LIFT" if cam.definition().follower.oscillates() => degrees(figures.lift.value),
            "LIFT" => length(figures.lift.value),
            _ => return None,
        })
    }

    fn stock_member(&self, stock: Handle<Stock>, name: &str) -> Option<Value> {
        match (self.program.stocks[stock].shape.clone(), name) {
            (StockShape::Round { radius, .. }, "RADIUS") => Some(length(radius)),
            (StockShape::Round { radius, .. }, "DIAMETER") => Some(length(2.0 * radius)),
            (StockShape::Round { height, .. }, _) => height.map(length),
            (StockShape::Block { min, max }, "HEIGHT") => Some(length(max.z - min.z)),
            (StockShape::Block { .. }, _) => None,
        }
    }
}

fn unknown_member(kind: EntityKind, row: &Statement, member: &Name) -> Diagnostic {
    let message = format!("{} has no member {}", kind.name(), member.text);
    let problem = Diagnostic::new(&codes::UNKNOWN_MEMBER, member.span, message);
    let names: Vec<&str> =
        row.members.iter().flat_map(|m| core::iter::once(m.name).chain(m.aliases.iter().copied())).collect();
    match did_you_mean(&member.text, names.iter().copied()) {
        Some(near) => problem.help(format!("did you mean `{near}`?")),
        None if names.is_empty() => problem,
        None => problem.note(format!("its members are {}", names.join(", "))),
    }
}

fn length(mm: f64) -> Value {
    Value::number(mm, Dim::LENGTH)
}

fn component(v: Vector, name: &str) -> Option<Value> {
    let index = ["X", "Y", "Z"].iter().position(|n| *n == name)?;
    Some(Value::Number(Quantity::new(*v.v.get(index)?, v.dim)))
}

fn motion_member(motion: &MotionValue, name: &str) -> Value {
    match (&motion.source, name) {
        (MotionSource::Segments(segments), "LIFT") => {
            let (mut lift, mut largest) = (0.0f64, Quantity::bare(0.0));
            for s in segments {
                lift += match s.shape {
                    SegmentShape::Dwell => 0.0,
                    SegmentShape::Rise => s.lift.value,
                    SegmentShape::Return => -s.lift.value,
                };
                if s.shape != SegmentShape::Dwell {
                    largest = Quantity::new(largest.value.max(lift), s.lift.dim);
                }
            }
            Value::Number(largest)
        }
        (MotionSource::Segments(segments), _) => {
            Value::number(segments.iter().map(|s| s.angle).sum(), Dim::ANGLE)
        }
        (MotionSource::Table { rows, dim, .. }, "LIFT") => {
            Value::number(rows.iter().map(|r| r.1).fold(0.0, f64::max), *dim)
        }
        (MotionSource::Table { .. }, _) => Value::number(360.0, Dim::ANGLE),
    }
}

fn cutter_member(tool: &Tool, name: &str) -> Option<Value> {
    match name {
        "DIAMETER" => Some(length(tool.diameter)),
        "RADIUS" => Some(length(tool.diameter / 2.0)),
        "CORNER" => Some(length(tool.corner)),
        "NUMBER" => tool.number.map(|n| Value::bare(f64::from(n))),
        "FLUTES" => tool.flutes.map(|n| Value::bare(f64::from(n))),
        _ => tool.length.map(length),
    }
}

/// The kind of a segment in the geometry's terms.
pub(super) const fn segment_kind(shape: SegmentShape) -> SegmentKind {
    match shape {
        SegmentShape::Dwell => SegmentKind::Dwell,
        SegmentShape::Rise => SegmentKind::Rise,
        SegmentShape::Return => SegmentKind::Return,
    }
}
