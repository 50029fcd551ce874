//! Proof: the read-back trace against the exact geometry.
//!
//! Deviation is exact per primitive (bounded and refined, no sampling error above 1e-6 mm). What passes
//! becomes [`Proven`], the only thing that may be written to a file.
