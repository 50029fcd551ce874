//! What becomes of a fault of partwright's own: exit status 101 and a request to report it.
//!
//! No input is known that makes partwright panic, so the work that does is the test's; what guards it is the command
//! line's own.

use std::process::Command;

use partwright::cli::{Status, guarded};

/// Set in the process that fails.
const FAILS: &str = "PARTWRIGHT_TEST_FAULT";

/// Does nothing unless the test below runs it in a process of its own.
#[test]
fn a_process_that_fails() {
    if std::env::var_os(FAILS).is_some() {
        let empty: Vec<u32> = Vec::new();
        let status =
            guarded(|| if empty[std::hint::black_box(3)] == 0 { Status::Done } else { Status::Errors });
        std::process::exit(status as i32);
    }
}

#[test]
fn a_fault_of_our_own_is_said_so_and_ends_with_101() {
    let this = std::env::current_exe().expect("this test");
    let mut child = Command::new(this);
    child.args(["--exact", "a_process_that_fails", "--nocapture"]).env(FAILS, "1");
    let ended = child.output().expect("the test runs");
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(101), "{said}");
    for part in
        ["this is a fault of partwright, not of your program", "index out of bounds", "Please report it"]
    {
        assert!(said.contains(part), "no `{part}` in {said}");
    }
    assert!(!said.contains("RUST_BACKTRACE"), "{said}");
}

#[test]
fn work_that_ends_keeps_its_status() {
    for status in [Status::Done, Status::Errors, Status::NotProven] {
        assert_eq!(guarded(move || status), status);
    }
}
