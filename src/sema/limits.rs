//! Limits that keep any program from taking long or much memory.

/// Passes of one loop.
pub const LOOP_PASSES: u64 = 300_000;
/// Passes of one loop in which mistakes of earlier passes come again: then the loop is left.
pub const LOOP_REPEATS: u64 = 100;
/// Repetitions of mistakes in all.
pub const REPEATS: u64 = 10_000;
/// Statements carried out in all; points of patterns and curves and elements of runs count as one each.
pub const STATEMENTS: u64 = 2_000_000;
/// Macros that call one another.
pub const CALL_DEPTH: usize = 64;
/// Calls that the origin of a step names.
pub const ORIGIN_CALLS: usize = 8;
/// Files that include one another.
pub const INCLUDE_DEPTH: usize = 32;
/// Steps of the evaluated program.
pub const STEPS: usize = 1_000_000;
/// Cams, tools, stocks and curves.
pub const ENTITIES: usize = 100_000;
/// Names, subscripted ones counted singly.
pub const NAMES: usize = 1_000_000;
/// Bytes of source text, included files counted.
pub const SOURCE_BYTES: usize = 64 * 1024 * 1024;
/// Bytes of CAD files.
pub const CAD_BYTES: usize = 512 * 1024 * 1024;
/// Different messages about one program.
pub const MESSAGES: usize = 500;
/// Cams: each takes milliseconds.
pub const CAMS: usize = 1000;
/// Rows of a table of lifts.
pub const TABLE_ROWS: usize = 100_000;
/// Points of a pattern.
pub const PATTERN_POINTS: usize = 100_000;
/// Elements of a subscripted name in one argument.
pub const SUBSCRIPT_RUN: i64 = 100_000;
