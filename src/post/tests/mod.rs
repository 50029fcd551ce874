//! The writer on hand-made target programs, dialect by dialect.

mod build;
mod docs;
mod files;
mod frame;
mod lint;
mod moves;
mod random;
mod rows;

use super::*;
use build::builtin;

#[test]
fn every_built_in_post_is_correct_and_compiles_all_its_templates() {
    for name in builtin_names() {
        let dialect = builtin(name);
        assert_eq!(dialect.name(), name);
        let errors = check::check(&dialect, &crate::source::SourceMap::default(), true);
        assert!(errors.is_empty(), "{name}: {errors:#?}");
    }
}

#[test]
fn names_are_case_blind_and_slips_are_answered() {
    assert_eq!(builtin("LinuxCNC").control(), "linuxcnc");
    let mut sources = crate::source::SourceMap::default();
    let errors = load("linuxcmc", &crate::source::MemoryFiles::default(), &mut sources).unwrap_err();
    assert_eq!(errors[0].code.id, "E0701");
    assert_eq!(errors[0].help, ["did you mean `linuxcnc`?"]);
}
