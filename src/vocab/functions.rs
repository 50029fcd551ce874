//! Functions of expressions.

/// One function.
#[derive(Debug)]
pub struct Function {
    /// Which.
    pub id: FunctionId,
    /// Name.
    pub name: &'static str,
    /// APT's and other spellings.
    pub aliases: &'static [&'static str],
    /// Arguments, for messages and the reference.
    pub signature: &'static str,
    /// Fewest arguments.
    pub min: usize,
    /// Most arguments.
    pub max: usize,
    /// One line.
    pub help: &'static str,
}

/// The functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum FunctionId {
    Abs,
    Sqrt,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Exp,
    Log,
    Log10,
    Min,
    Max,
    Mod,
    Int,
    Round,
    Dist,
    Angle,
    Dot,
    Cross,
    Unit,
    Norm,
    Num,
}

const fn function(
    id: FunctionId,
    name: &'static str,
    aliases: &'static [&'static str],
    signature: &'static str,
    (min, max): (usize, usize),
    help: &'static str,
) -> Function {
    Function { id, name, aliases, signature, min, max, help }
}

/// The largest number of arguments of `MIN` and `MAX`.
const MANY: usize = 100;

/// All functions.
pub const FUNCTIONS: &[Function] = &[
    function(FunctionId::Abs, "ABS", &["ABSF"], "x", (1, 1), "absolute value"),
    function(FunctionId::Sqrt, "SQRT", &["SQRTF"], "x", (1, 1), "square root; of an area, a length"),
    function(FunctionId::Sin, "SIN", &["SINF"], "angle", (1, 1), "sine"),
    function(FunctionId::Cos, "COS", &["COSF"], "angle", (1, 1), "cosine"),
    function(FunctionId::Tan, "TAN", &["TANF"], "angle", (1, 1), "tangent"),
    function(FunctionId::Asin, "ASIN", &["ASINF"], "x", (1, 1), "angle from -90 to 90 deg with this sine"),
    function(FunctionId::Acos, "ACOS", &["ACOSF"], "x", (1, 1), "angle from 0 to 180 deg with this cosine"),
    function(FunctionId::Atan, "ATAN", &["ATANF"], "x", (1, 1), "angle from -90 to 90 deg with this tangent"),
    function(
        FunctionId::Atan2,
        "ATAN2",
        &["ATAN2F"],
        "y, x",
        (2, 2),
        "angle of the vector (x, y), -180 to 180 deg",
    ),
    function(FunctionId::Exp, "EXP", &["EXPF"], "x", (1, 1), "e to the power x"),
    function(FunctionId::Log, "LOG", &["LOGF"], "x", (1, 1), "natural logarithm"),
    function(FunctionId::Log10, "LOG10", &["LOG10F"], "x", (1, 1), "logarithm to base 10"),
    function(FunctionId::Min, "MIN", &["MINF"], "a, b, …", (1, MANY), "smallest"),
    function(FunctionId::Max, "MAX", &["MAXF"], "a, b, …", (1, MANY), "largest"),
    function(FunctionId::Mod, "MOD", &["MODF"], "a, b", (2, 2), "remainder of a / b, with the sign of b"),
    function(FunctionId::Int, "INT", &["INTF"], "x", (1, 1), "whole part, towards zero"),
    function(FunctionId::Round, "ROUND", &[], "x", (1, 1), "nearest whole number, halves away from zero"),
    function(FunctionId::Dist, "DIST", &["DISTF"], "p, q", (2, 2), "distance of two points"),
    function(
        FunctionId::Angle,
        "ANGLE",
        &["ANGLF"],
        "a[, b]",
        (1, 2),
        "angle of a vector or line to the X axis, or between two vectors",
    ),
    function(FunctionId::Dot, "DOT", &["DOTF"], "a, b", (2, 2), "scalar product of two vectors"),
    function(FunctionId::Cross, "CROSS", &["CROSSF"], "a, b", (2, 2), "vector product of two vectors"),
    function(FunctionId::Unit, "UNIT", &["UNITF"], "v", (1, 1), "the vector scaled to length 1"),
    function(FunctionId::Norm, "NORM", &["LNTHF"], "v", (1, 1), "length of a vector"),
    function(FunctionId::Num, "NUM", &["NUMF"], "a", (1, 1), "largest subscript of a subscripted name"),
];
