//! Plate cams: profile, pitch curve, checks and figures.

/// A plate cam, checked and ready for use.
#[derive(Debug, Clone)]
pub struct Cam;
