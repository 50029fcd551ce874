//! Proven programs on their way to their files: each is written under a temporary name as soon as it is proven, so that
//! not all texts are in memory until the last one is proven. They get their names together, or none does.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::output::{self, Staged};
use crate::driver::{Output, Shelf};

/// Where the program of an output is to go.
pub type Destination<'a> = &'a (dyn Fn(&Output) -> PathBuf + Sync);

/// The staged programs of one source file, by output. What is still here when this is dropped is removed.
pub struct Staging<'a> {
    destination: Option<Destination<'a>>,
    staged: Mutex<BTreeMap<usize, Staged>>,
}

impl<'a> Staging<'a> {
    /// Stages what goes to files; nothing without a destination.
    pub fn new(destination: Option<Destination<'a>>) -> Staging<'a> {
        Staging { destination, staged: Mutex::default() }
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<usize, Staged>> {
        self.staged.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What has been staged.
    pub fn into_staged(self) -> BTreeMap<usize, Staged> {
        self.staged.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Shelf for Staging<'_> {
    /// What cannot be staged stays where it is: that it cannot be written is told when all has been proven.
    fn put(&self, index: usize, output: &Output, text: &str) -> bool {
        let Some(destination) = self.destination else { return false };
        // An earlier text of this output no longer holds.
        drop(self.lock().remove(&index));
        let Some(staged) = output::stage_early(&destination(output), text.as_bytes()) else { return false };
        self.lock().insert(index, staged);
        true
    }
}
