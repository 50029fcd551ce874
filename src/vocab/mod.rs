//! The one table of statements, words, slots, dimensions, defaults and help texts.

/// Whether `word` (in any case) starts a statement: `CIRCLE`, `CAM`, `GOTO` … The parser asks this to tell
/// `C = CIRCLE/ 2` from `R = D/2`.
#[must_use]
pub fn is_statement_word(word: &str) -> bool {
    const WORDS: &[&str] = &[
        "POINT", "VECTOR", "LINE", "CIRCLE", "PLANE", "MATRIX", "PATERN", "TABCYL", "SPLINE", "CURVE",
        "BEZIER", "NET", "FOLLOW", "MOTION", "CAM", "CUTTER", "STOCK", "ROUGH", "PROFIL", "GOTO", "GODLTA",
        "FROM",
    ];
    WORDS.iter().any(|w| w.eq_ignore_ascii_case(word))
}
