//! Follower motions: the classic laws, polynomials and tables.

/// Lift and its derivatives with respect to the cam angle: s, ds/dθ, d²s/dθ², d³s/dθ³ with θ in radians;
/// s in mm (translating) or radians (oscillating).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lift {
    /// Lift.
    pub s: f64,
    /// Velocity per radian.
    pub v: f64,
    /// Acceleration per radian².
    pub a: f64,
    /// Jerk per radian³.
    pub j: f64,
}
