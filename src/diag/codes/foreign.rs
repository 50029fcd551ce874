//! Codes of CL files and foreign input; none so far.

use crate::diag::Code;

/// All codes of this area.
pub const ALL: &[&Code] = &[];
