//! Values of expressions and named things.

use std::rc::Rc;

use crate::arena::Handle;
use crate::geom::motion::Law;
use crate::ir::{CamEntity, CurveEntity, NetEntity, Stock, Tool};
use crate::source::Span;
use crate::units::{Dim, LengthUnit, Quantity, number};
use crate::vocab::EntityKind;

use super::transform::Transform;

/// Three components of one dimension: points and vectors. A point is the vector from the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vector {
    /// Components in base units.
    pub v: [f64; 3],
    /// Their dimension; bare when it was written with bare numbers.
    pub dim: Dim,
}

impl Vector {
    /// The vector as a value of dimension `dim`; see [`Quantity::land`].
    #[must_use]
    pub fn land(self, dim: Dim, unit: LengthUnit) -> Option<Vector> {
        let mut v = [0.0; 3];
        for (out, x) in v.iter_mut().zip(self.v) {
            *out = Quantity::new(x, self.dim).land(dim, unit)?.value;
        }
        Some(Vector { v, dim })
    }
    /// For messages.
    #[must_use]
    pub fn show(self, unit: LengthUnit) -> String {
        let parts = self.v.map(|x| number(Quantity::new(x, self.dim).in_unit(unit)));
        let symbol = self.dim.symbol(unit);
        let blank = if symbol.is_empty() { "" } else { " " };
        format!("({}, {}, {}){blank}{symbol}", parts[0], parts[1], parts[2])
    }
}

/// A value.
#[derive(Debug, Clone)]
pub enum Value {
    /// A number with its dimension.
    Number(Quantity),
    /// A point or vector.
    Vector(Vector),
    /// A condition.
    Truth(bool),
    /// A text.
    Text(Rc<str>),
    /// A word of the language handed to a macro, upper case.
    Word(Rc<str>),
    /// A named thing that is neither a number nor a point.
    Entity(Entity),
    /// Several things in parentheses: a chain of curves.
    List(Rc<[(Value, Span)]>),
    /// The value of something that failed; its use is not a mistake of its own.
    Poison,
}

impl Value {
    /// A number without dimension.
    #[must_use]
    pub fn bare(value: f64) -> Value {
        Value::Number(Quantity::bare(value))
    }
    /// A number in base units.
    #[must_use]
    pub fn number(value: f64, dim: Dim) -> Value {
        Value::Number(Quantity::new(value, dim))
    }
    /// With its article, for messages.
    #[must_use]
    pub fn kind_name(&self) -> String {
        match self {
            Value::Number(q) if q.is_bare() => "a number".into(),
            Value::Number(q) => format!("a {}", q.dim.name()).replace("a a", "an a"),
            Value::Vector(_) => "a point".into(),
            Value::Truth(_) => "a condition".into(),
            Value::Text(_) => "a text".into(),
            Value::Word(word) => format!("the word {word}"),
            Value::Entity(entity) => entity.kind().name().into(),
            Value::List(_) => "a list".into(),
            Value::Poison => "nothing".into(),
        }
    }
}

/// A named thing.
#[derive(Debug, Clone)]
pub enum Entity {
    /// A line through two points, mm, directed from the first to the second.
    Line(Rc<LineValue>),
    /// A circle.
    Circle(Rc<CircleValue>),
    /// Another curve.
    Curve(Handle<CurveEntity>),
    /// A plane.
    Plane(Rc<PlaneValue>),
    /// A transformation.
    Matrix(Rc<Transform>),
    /// Points in order, mm.
    Pattern(Rc<[[f64; 3]]>),
    /// A follower.
    Follower(Rc<FollowerValue>),
    /// A motion.
    Motion(Rc<MotionValue>),
    /// A cam.
    Cam(Handle<CamEntity>),
    /// A cutter.
    Cutter(Handle<Tool>),
    /// A stock.
    Stock(Handle<Stock>),
    /// A surface.
    Net(Handle<NetEntity>),
    /// A labelled operation.
    Operation,
}

impl Entity {
    /// Its kind.
    #[must_use]
    pub const fn kind(&self) -> EntityKind {
        match self {
            Entity::Line(_) => EntityKind::Line,
            Entity::Circle(_) => EntityKind::Circle,
            Entity::Curve(_) => EntityKind::Curve,
            Entity::Plane(_) => EntityKind::Plane,
            Entity::Matrix(_) => EntityKind::Matrix,
            Entity::Pattern(_) => EntityKind::Pattern,
            Entity::Follower(_) => EntityKind::Follower,
            Entity::Motion(_) => EntityKind::Motion,
            Entity::Cam(_) => EntityKind::Cam,
            Entity::Cutter(_) => EntityKind::Cutter,
            Entity::Stock(_) => EntityKind::Stock,
            Entity::Net(_) => EntityKind::Net,
            Entity::Operation => EntityKind::Operation,
        }
    }
}

/// A line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineValue {
    /// First point, mm.
    pub from: [f64; 2],
    /// Second point, mm.
    pub to: [f64; 2],
    /// Its curve in the IR.
    pub curve: Handle<CurveEntity>,
}

/// A circle, counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CircleValue {
    /// Centre, mm.
    pub centre: [f64; 3],
    /// Radius, mm.
    pub radius: f64,
    /// Its curve in the IR.
    pub curve: Handle<CurveEntity>,
}

/// A plane: the points p with normal · p = distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneValue {
    /// Unit normal.
    pub normal: [f64; 3],
    /// Distance from the origin along the normal, mm.
    pub distance: f64,
}

/// A follower as declared; lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowerValue {
    /// Moves on a line; otherwise it swings about a pivot.
    pub translating: bool,
    /// Radius of the roller; `None` for a flat face.
    pub roller: Option<f64>,
    /// Offset.
    pub offset: f64,
    /// Pivot to roller centre; 0 where it has none.
    pub arm: f64,
    /// Cam centre to pivot; 0 where it has none.
    pub pivot: f64,
    /// The arm swings to the left.
    pub left: bool,
    /// Its statement.
    pub span: Span,
}

/// A motion as declared: lifts keep their dimension until a follower says what they are.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionValue {
    /// What it is made of.
    pub source: MotionSource,
    /// Its statement.
    pub span: Span,
}

/// What a motion is made of.
#[derive(Debug, Clone, PartialEq)]
pub enum MotionSource {
    /// Segments.
    Segments(Vec<SegmentValue>),
    /// A table of cam angle in degrees and lift.
    Table {
        /// Rows.
        rows: Vec<(f64, f64)>,
        /// Dimension of the lift; bare when the heading has no unit.
        dim: Dim,
        /// The last row meets the first.
        periodic: bool,
    },
}

/// Kinds of segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SegmentShape {
    /// Rest.
    Dwell,
    /// Lift grows.
    Rise,
    /// Lift shrinks.
    Return,
}

/// A segment of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct SegmentValue {
    /// Rest, rise, return.
    pub shape: SegmentShape,
    /// Cam angle in degrees.
    pub angle: f64,
    /// Lift of this segment, positive; bare zero for a dwell.
    pub lift: Quantity,
    /// The law; `None` for a dwell or POLY.
    pub law: Option<Law>,
    /// Boundary values of POLY: derivative order 1..=3, at its end, value in lift per degreeⁿ, where.
    pub boundary: Vec<(u8, bool, Quantity, Span)>,
    /// From its word to its last value.
    pub span: Span,
}
