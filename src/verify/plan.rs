//! What the program was asked to do, beside what the text does: which lines belong to which block, which operation
//! and which piece, and what feed, spindle and tool were in force for each contour.

use std::collections::BTreeMap;

use crate::arena::Handle;
use crate::cl::{Cl, RecordKind};
use crate::ir::{Compensation, Coolant, Feed, Origin, Spindle};
use crate::target::{BlockKind, TargetProgram};

/// State that the CL data puts in force.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Asked {
    /// Feed along the path, mm/min; 0 when none was given.
    pub feed: f64,
    /// Spindle, rev/min, negative counter-clockwise.
    pub spindle: f64,
    /// Coolant.
    pub coolant: Coolant,
    /// Cutter compensation.
    pub compensation: Option<Compensation>,
}

/// What a part of a program leaves in force for the next.
#[derive(Debug, Clone)]
pub(super) struct InForce {
    asked: Asked,
    operation: Option<usize>,
    feed: Feed,
    /// Feeds of the operation so far.
    feeds: Vec<f64>,
}

impl Default for InForce {
    fn default() -> Self {
        InForce { asked: Asked::default(), operation: None, feed: Feed::PerMinute(0.0), feeds: Vec::new() }
    }
}

/// Where a block stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Context {
    /// Operation, if one has begun.
    pub operation: Option<usize>,
    /// Index into the target program's tools, if one is loaded.
    pub tool: Option<u32>,
}

impl Context {
    /// Before the first block.
    pub(super) const START: Context = Context { operation: None, tool: None };
}

/// Context of every block.
pub(super) fn contexts(target: &TargetProgram) -> Vec<Context> {
    contexts_from(target, &mut (Context::START, 0))
}

/// The same for a part of a program, where `before` is the context before it and the number of operations begun.
pub(super) fn contexts_from(target: &TargetProgram, before: &mut (Context, usize)) -> Vec<Context> {
    let (now, begun) = before;
    target
        .blocks
        .iter()
        .map(|block| {
            match &block.kind {
                BlockKind::BeginOperation(_) => {
                    now.operation = Some(*begun);
                    *begun += 1;
                }
                BlockKind::ToolChange(tool) => now.tool = Some(*tool),
                _ => {}
            }
            *now
        })
        .collect()
}

/// Statements that are moves themselves and no part of an operation, in order.
pub(super) fn written(cl: &Cl) -> Vec<Handle<Origin>> {
    let mut inside = false;
    let (mut written, mut operations) = (Vec::new(), Vec::new());
    for record in &cl.records {
        match record.kind {
            RecordKind::BeginOperation(_) => inside = true,
            RecordKind::EndOperation(_) => inside = false,
            // Passes and contours are parts of operations.
            _ if !inside && record.kind.moves() => written.push(record.origin),
            _ => {}
        }
        if inside && operations.last() != Some(&record.origin) {
            operations.push(record.origin);
        }
    }
    written.sort_unstable();
    written.dedup();
    operations.sort_unstable();
    written.retain(|origin| operations.binary_search(origin).is_err());
    written
}

/// The block of every line: lines are given block by block, in order.
pub(super) struct Lines {
    first: u32,
    /// Block of each line from `first` on, plus one; 0 where none has printed it.
    blocks: Vec<u32>,
}

impl Lines {
    pub(super) fn new(lines: &[(u32, u32)]) -> Self {
        let printed = || lines.iter().filter(|(from, to)| to > from);
        let first = printed().map(|(from, _)| *from).min().unwrap_or(0);
        let after = printed().map(|(_, to)| *to).max().unwrap_or(0);
        let mut blocks = vec![0; (after - first) as usize];
        for (number, &(from, to)) in (1..).zip(lines).filter(|(_, (from, to))| to > from) {
            let own = blocks.get_mut((from - first) as usize..(to - first) as usize);
            own.into_iter().flatten().for_each(|block| *block = number);
        }
        Lines { first, blocks }
    }

    /// Index of the block that printed `line`.
    pub(super) fn block(&self, line: u32) -> Option<usize> {
        let number = *self.blocks.get(line.checked_sub(self.first)? as usize)?;
        (number as usize).checked_sub(1)
    }
}

/// What was asked for every record, and the feeds of everything beside the contours, per operation.
#[derive(Debug, Default)]
pub(super) struct Orders {
    records: Vec<Asked>,
    feeds: BTreeMap<Option<usize>, Vec<f64>>,
    plunges: BTreeMap<Option<usize>, Vec<Option<f64>>>,
}

impl Orders {
    pub(super) fn new(cl: &Cl) -> Self {
        Orders::after(cl, &mut InForce::default())
    }

    /// The same for a part of a program, before which this was in force.
    pub(super) fn after(cl: &Cl, before: &mut InForce) -> Self {
        let mut orders = Orders::default();
        let InForce { asked, operation, feed, feeds } = before;
        if operation.is_some() {
            orders.feeds.insert(*operation, core::mem::take(feeds));
        }
        let mut orders = orders.with(cl, asked, operation, feed);
        *feeds = orders.feeds.get(operation).cloned().unwrap_or_default();
        orders.feeds.retain(|_, f| !f.is_empty());
        orders
    }

    fn with(mut self, cl: &Cl, asked: &mut Asked, operation: &mut Option<usize>, feed: &mut Feed) -> Self {
        let orders = &mut self;
        for record in &cl.records {
            match &record.kind {
                RecordKind::BeginOperation(index) => *operation = Some(*index as usize),
                RecordKind::Spindle(spindle) => asked.spindle = signed(*spindle),
                RecordKind::Coolant(c) => asked.coolant = *c,
                RecordKind::Compensation(on) => asked.compensation = *on,
                RecordKind::Feed(f) => *feed = *f,
                RecordKind::BeginCycle(cycle) => {
                    let into = per_minute(cycle.feed, asked.spindle);
                    orders.feeds.entry(*operation).or_default().extend((into > 0.0).then_some(into));
                }
                RecordKind::Contour(contour) => {
                    orders.feeds.entry(*operation).or_default().extend(contour.plunge_feed);
                    orders.plunges.entry(*operation).or_default().push(contour.plunge_feed);
                }
                _ => {}
            }
            asked.feed = per_minute(*feed, asked.spindle);
            orders.records.push(*asked);
            if matches!(record.kind, RecordKind::Linear(_) | RecordKind::Rapid(_)) {
                continue;
            }
            let feeds = orders.feeds.entry(*operation).or_default();
            if feeds.last() != Some(&asked.feed) && asked.feed > 0.0 {
                feeds.push(asked.feed);
            }
        }
        self
    }

    /// What was in force at the CL record with this index.
    pub(super) fn record(&self, index: u32) -> Option<Asked> {
        self.records.get(index as usize).copied()
    }

    /// The feed for plunging, where all contours of the operation have the same.
    pub(super) fn plunge(&self, operation: Option<usize>) -> Option<f64> {
        let feeds = self.plunges.get(&operation)?;
        let first = *feeds.first()?;
        first.filter(|_| feeds.iter().all(|f| *f == first))
    }

    /// Feeds that were in force at some time in the operation.
    pub(super) fn feeds(&self, operation: Option<usize>) -> &[f64] {
        self.feeds.get(&operation).map_or(&[], Vec::as_slice)
    }
}

fn per_minute(feed: Feed, spindle: f64) -> f64 {
    match feed {
        Feed::PerMinute(f) => f,
        Feed::PerRevolution(f) => f * spindle.abs(),
        // Never in CL data, by its contract.
        Feed::PerTooth(_) => 0.0,
    }
}

fn signed(spindle: Spindle) -> f64 {
    match spindle {
        Spindle::Off => 0.0,
        Spindle::On { rpm, clockwise, .. } => {
            if clockwise {
                rpm
            } else {
                -rpm
            }
        }
    }
}
