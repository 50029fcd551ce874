//! Rendering of diagnostics: human (codespan-reporting), short and JSON.
