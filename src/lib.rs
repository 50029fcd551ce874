//! Partwright: a compiler for part programs.
//!
//! ```text
//! source ─syntax─▶ ast ─sema─▶ ir ─plan─▶ cl ─lower─▶ target ─post─▶ text
//!                               │                                │
//!                               └──── geom ◀── verify ◀─ readback
//! ```
//!
//! Data goes one way; every stage has one type in and one type out and can be printed. See ARCHITECTURE.md.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod arena;
pub mod cad;
pub mod cl;
pub mod clfile;
pub mod cli;
pub mod diag;
pub mod driver;
pub mod geom;
pub mod golden;
pub mod ir;
pub mod links;
pub mod lower;
pub mod math;
pub mod motion_diff;
pub mod plan;
pub mod plot;
pub mod post;
pub mod readback;
pub mod selftest;
pub mod sema;
pub mod source;
pub mod syntax;
pub mod target;
pub mod trace_page;
pub mod units;
pub mod verify;
pub mod vocab;
