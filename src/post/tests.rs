//! The writer on hand-made target programs, dialect by dialect.

use super::*;
use crate::source::{MemoryFiles, SourceMap};

/// A built-in dialect; panics in tests only.
fn builtin(name: &str) -> Dialect {
    let mut sources = SourceMap::default();
    load(name, &MemoryFiles::default(), &mut sources).unwrap_or_else(|errors| panic!("{name}: {errors:#?}"))
}

#[test]
fn every_built_in_post_is_correct_and_compiles_all_its_templates() {
    for name in builtin_names() {
        let dialect = builtin(name);
        assert_eq!(dialect.name(), name);
        let errors = check::check(&dialect, true);
        assert!(errors.is_empty(), "{name}: {errors:#?}");
    }
}
