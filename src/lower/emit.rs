//! CL records to target blocks.

use std::sync::Arc;

use super::compensation::Compensating;
use super::contour::Fitted;
use super::cycle::Active;
use super::feed::{self, FeedTrouble};
use super::pass::Form;
use super::rotary;
use super::spline::Told;
use super::tools::Tools;
use crate::arena::Handle;
use crate::cl::{Cl, Contour, Lead, Record, RecordKind};
use crate::diag::{Code, Diagnostic, Sink, codes};
use crate::geom::Point3;
use crate::ir::at_origin;
use crate::ir::{Band, Coolant, Feed, Origin, Spindle};
use crate::target::number;
use crate::target::{
    Block, BlockKind, Capabilities, Cycle, FeedWord, Motion, Nurbs, Piece, PieceId, Position, TargetProgram,
    axes,
};

/// Chain of every record that is a pass.
type Passes = [Option<Arc<super::pass::Chain>>];

/// Emits all records. `fitted` is what [`super::contour::fit_all`] gave, `passes` what [`super::pass::fit_all`] gave.
pub(super) fn program(
    cl: &Cl,
    capabilities: &Capabilities,
    (fitted, passes): (&[Option<Arc<Fitted>>], &Passes),
    sink: &mut Sink,
) -> Option<TargetProgram> {
    let first = cl.records.first()?.origin;
    let mut emitter = Emitter::new(cl, capabilities, sink, first, Tools::of(cl));
    emitter.event(BlockKind::Begin);
    emitter.records(fitted, passes);
    emitter.end();
    Some(emitter.finish().0)
}

/// What one chunk of a program leaves to the next.
#[derive(Debug)]
pub(super) struct Carry {
    tools: Tools,
    at: [Option<i64>; 4],
    stale: [i64; 4],
    feed: Option<Feed>,
    rpm: f64,
    coolant: Coolant,
    standing: bool,
    dry: bool,
    operation: u32,
    told: usize,
    cycle: Option<Active>,
    exact: Option<Point3>,
    spinning: Option<Spindle>,
    parked: bool,
    changes: usize,
    pecks_told: Option<(f64, f64)>,
    curves_told: Vec<Told>,
    compensating: Compensating,
}

/// Emits a chunk: the first one begins the program, the last one ends it.
pub(super) fn chunk(
    cl: &Cl,
    capabilities: &Capabilities,
    carry: Result<Carry, Tools>,
    last: bool,
    sink: &mut Sink,
) -> (TargetProgram, Carry) {
    let origin = cl.records.first().map(|r| r.origin).or_else(|| cl.origins.iter().next().map(|(h, _)| h));
    let (tools, before) = match carry {
        Ok(mut carry) => (core::mem::take(&mut carry.tools), Some(carry)),
        Err(tools) => (tools, None),
    };
    let Some(origin) = origin else {
        let carry = before.unwrap_or_else(|| Carry::empty(capabilities));
        return (TargetProgram::empty(cl, capabilities, tools.list.clone()), Carry { tools, ..carry });
    };
    let mut emitter = Emitter::new(cl, capabilities, sink, origin, tools);
    match before {
        Some(carry) => emitter.resume(carry),
        None => emitter.event(BlockKind::Begin),
    }
    emitter.records(&[], &[]);
    if last {
        emitter.end();
    }
    emitter.finish()
}

impl Carry {
    fn empty(capabilities: &Capabilities) -> Carry {
        Carry {
            tools: Tools::default(),
            at: [None, None, None, capabilities.rotary.is_none().then_some(0)],
            stale: [0; 4],
            feed: None,
            rpm: 0.0,
            coolant: Coolant::Off,
            standing: false,
            dry: false,
            operation: 0,
            told: 0,
            cycle: None,
            exact: None,
            spinning: None,
            parked: false,
            changes: 0,
            pecks_told: None,
            curves_told: Vec::new(),
            compensating: Compensating::default(),
        }
    }
}

/// The largest number of messages about numbers that do not fit: one is enough for each statement.
const MAX_COMPLAINTS: usize = 50;

/// Moves of an approach at most.
const MOST_APPROACH: usize = 64;

/// Builds the program block by block.
pub(super) struct Emitter<'a> {
    pub(super) cl: &'a Cl,
    pub(super) capabilities: &'a Capabilities,
    pub(super) sink: &'a mut Sink,
    tools: Tools,
    pub(super) origin: Handle<Origin>,
    /// The record that is being expressed.
    of_record: Option<u32>,
    pub(super) piece: Option<PieceId>,
    /// Printed positions of X, Y, Z and the rotary axis, where known.
    pub(super) at: [Option<i64>; 4],
    /// Where they were last, for those that are not known now.
    stale: [i64; 4],
    pub(super) feed: Option<Feed>,
    pub(super) rpm: f64,
    pub(super) coolant: Coolant,
    /// The spindle stands since a stop of the program, perhaps.
    pub(super) standing: bool,
    /// The coolant is off since then, perhaps.
    pub(super) dry: bool,
    pub(super) operation: u32,
    complaints: Vec<(&'static str, Handle<Origin>)>,
    /// Messages of the chunks before.
    told: usize,
    pub(super) blocks: Vec<Block>,
    pub(super) pieces: Vec<Piece>,
    pub(super) nurbs: Vec<Nurbs>,
    pub(super) cycles: Vec<Cycle>,
    /// The drilling cycle in force.
    pub(super) cycle: Option<Active>,
    /// Where the CL data say the cutter is, before rounding.
    pub(super) exact: Option<Point3>,
    /// The spindle as last switched on.
    pub(super) spinning: Option<Spindle>,
    /// Z stands at its upper end since the last tool change.
    parked: bool,
    /// Tool changes so far.
    changes: usize,
    /// First and further peck that a message has told about.
    pub(super) pecks_told: Option<(f64, f64)>,
    /// Curves that became lines.
    pub(super) curves_told: Vec<Told>,
    pub(super) compensating: Compensating,
}

impl<'a> Emitter<'a> {
    fn new(
        cl: &'a Cl,
        capabilities: &'a Capabilities,
        sink: &'a mut Sink,
        origin: Handle<Origin>,
        tools: Tools,
    ) -> Emitter<'a> {
        let mut emitter = Emitter {
            cl,
            capabilities,
            sink,
            tools,
            origin,
            of_record: None,
            piece: None,
            at: [None; 4],
            stale: [0; 4],
            feed: None,
            rpm: 0.0,
            coolant: Coolant::Off,
            standing: false,
            dry: false,
            operation: 0,
            complaints: Vec::new(),
            told: 0,
            blocks: Vec::new(),
            pieces: Vec::new(),
            nurbs: Vec::new(),
            cycles: Vec::new(),
            cycle: None,
            exact: None,
            spinning: None,
            parked: false,
            changes: 0,
            pecks_told: None,
            curves_told: Vec::new(),
            compensating: Compensating::default(),
        };
        emitter.forget();
        emitter
    }

    /// Goes on where the chunk before ended.
    fn resume(&mut self, carry: Carry) {
        self.at = carry.at;
        self.stale = carry.stale;
        self.feed = carry.feed;
        self.rpm = carry.rpm;
        self.coolant = carry.coolant;
        self.standing = carry.standing;
        self.dry = carry.dry;
        self.operation = carry.operation;
        self.told = carry.told;
        self.cycle = carry.cycle;
        self.exact = carry.exact;
        self.spinning = carry.spinning;
        self.parked = carry.parked;
        self.changes = carry.changes;
        self.pecks_told = carry.pecks_told;
        self.curves_told = carry.curves_told;
        self.compensating = carry.compensating;
    }

    fn records(&mut self, fitted: &[Option<Arc<Fitted>>], passes: &Passes) {
        let cl = self.cl;
        for (index, record) in cl.records.iter().enumerate() {
            self.origin = record.origin;
            self.of_record = u32::try_from(index).ok();
            if let Some(Some(chain)) = passes.get(index) {
                self.close_cycle();
                self.restart(&record.kind);
                self.pass(chain);
                continue;
            }
            self.record(index, record, fitted);
        }
    }

    fn end(&mut self) {
        self.ends_compensation("the end");
        self.of_record = None;
        self.event(BlockKind::End);
        self.report_curves();
    }

    fn finish(self) -> (TargetProgram, Carry) {
        let program = TargetProgram {
            title: self.cl.title.clone(),
            capabilities: self.capabilities.clone(),
            tools: self.tools.list.clone(),
            pieces: self.pieces,
            nurbs: self.nurbs,
            cycles: self.cycles,
            blocks: self.blocks,
        };
        let carry = Carry {
            tools: self.tools,
            at: self.at,
            stale: self.stale,
            feed: self.feed,
            rpm: self.rpm,
            coolant: self.coolant,
            standing: self.standing,
            dry: self.dry,
            operation: self.operation,
            told: self.told + self.complaints.len(),
            cycle: self.cycle,
            exact: self.exact,
            spinning: self.spinning,
            parked: self.parked,
            changes: self.changes,
            pecks_told: self.pecks_told,
            curves_told: self.curves_told,
            compensating: self.compensating,
        };
        (program, carry)
    }

    /// Positions are unknown; a machine without a rotary axis has it at 0 for ever.
    fn forget(&mut self) {
        let here = self.here();
        self.stale = [here.x, here.y, here.z, here.r];
        self.at = [None, None, None, self.capabilities.rotary.is_none().then_some(0)];
    }

    pub(super) fn event(&mut self, kind: BlockKind) {
        self.blocks.push(Block { kind, origin: self.origin, piece: None, record: self.of_record });
    }

    /// One message a code and statement.
    pub(super) fn complain(&mut self, code: &'static Code, message: String) {
        self.complain_of(at_origin(code, &self.cl.origins, self.origin, message));
    }

    pub(super) fn complain_of(&mut self, diagnostic: Diagnostic) {
        let key = (diagnostic.code.id, self.origin);
        if !self.complaints.contains(&key) && self.told + self.complaints.len() < MAX_COMPLAINTS {
            self.complaints.push(key);
            self.sink.push(diagnostic);
        }
    }

    pub(super) fn feed_trouble(&mut self, trouble: &FeedTrouble) -> FeedWord {
        self.complain_of(trouble.diagnostic(&self.cl.origins, self.origin));
        FeedWord::PerMinute(1)
    }

    fn record(&mut self, index: usize, record: &Record, fitted: &[Option<Arc<Fitted>>]) {
        if !matches!(record.kind, RecordKind::Hole(_) | RecordKind::Feed(_)) {
            self.close_cycle();
        }
        self.restart(&record.kind);
        match &record.kind {
            RecordKind::BeginOperation(operation) => self.begin_operation(*operation),
            RecordKind::EndOperation(_) => {}
            RecordKind::LoadTool(tool) => self.load_tool(*tool),
            RecordKind::Spindle(spindle) => self.spindle(*spindle),
            RecordKind::Feed(feed) => self.set_feed(*feed),
            RecordKind::Coolant(coolant) => self.coolant(*coolant),
            RecordKind::Compensation(wanted) => self.compensation(*wanted),
            RecordKind::Dwell(seconds) => self.event(BlockKind::Dwell(*seconds)),
            RecordKind::Stop => self.stop(false),
            RecordKind::OptionalStop => self.stop(true),
            RecordKind::Comment(text) => self.event(BlockKind::Comment(text.clone())),
            RecordKind::Insert(text) => self.event(BlockKind::Insert(text.clone())),
            RecordKind::From(point) | RecordKind::Rapid(point) => {
                let end = self.aim(index, *point, fitted);
                self.rapid_record(end);
                self.exact = Some(*point);
            }
            RecordKind::Linear(point) => {
                let end = self.aim(index, *point, fitted);
                self.linear_record(end);
                self.exact = Some(*point);
            }
            RecordKind::Circle(circle) => self.circle(circle),
            RecordKind::Spline(spline) => self.spline(spline),
            // Fitted passes are emitted by themselves, and without a fit there is no program.
            RecordKind::Pass(_) => {}
            RecordKind::BeginCycle(cycle) => self.begin_cycle(cycle),
            RecordKind::Hole(point) => self.hole(*point),
            RecordKind::EndCycle => self.end_cycle(),
            RecordKind::Contour(contour) => {
                self.compensates_beside(contour);
                if let Some(Some(fitted)) = fitted.get(index) {
                    self.contour(contour, fitted);
                    let step = self.capabilities.grid.linear_step();
                    let [x, y, z, _] = self.at.map(|v| v.map(|v| v as f64 * step));
                    self.exact = x.zip(y).zip(z).map(|((x, y), z)| Point3::new(x, y, z));
                }
            }
        }
    }

    fn begin_operation(&mut self, index: u32) {
        self.operation = index;
        let Some(operation) = self.cl.operations.get(index as usize) else { return };
        self.event(BlockKind::BeginOperation(operation.name.clone()));
        let Band { into, out } = operation.band;
        let given = self.capabilities.path_tolerance.map(|p| p.share * into.min(out)).filter(|p| *p > 0.0);
        self.event(BlockKind::PathTolerance(given));
    }

    fn load_tool(&mut self, tool: Handle<crate::ir::Tool>) {
        self.ends_compensation("a tool change");
        self.rise();
        self.changes += 1;
        let index = self.tools.index(tool);
        let number = self.tools.list.get(index as usize).and_then(|tool| tool.number);
        self.compensating.changes_to(number);
        self.event(BlockKind::ToolChange(index));
        // A post may stop the coolant for the change: it is said again when the new tool moves.
        (self.standing, self.dry) = (false, self.coolant != Coolant::Off);
        self.forget();
        self.parked = self.capabilities.parks;
        self.exact = None;
        self.rpm = 0.0;
    }

    /// How high the program goes with the tool in the spindle, Z steps: clear of everything that it goes over.
    fn height(&self) -> Option<i64> {
        let height = self.tools.heights.get(self.changes.checked_sub(1)?)?;
        let grid = &self.capabilities.grid;
        number::steps(height / grid.unit.in_mm(), grid.linear_decimals)
    }

    /// Where a change does not take Z to its upper end, the cutter is taken as high as it has been before.
    fn rise(&mut self) {
        let (Some(z), Some(height)) = (self.at[2], self.height()) else { return };
        if z < height && !self.capabilities.parks && !self.capabilities.whole_points {
            self.rapid_axes(Position { z: height, ..self.here() }, axes::Z);
        }
    }

    fn set_feed(&mut self, feed: Feed) {
        if matches!(feed, Feed::PerRevolution(_)) && !self.capabilities.feed_per_revolution {
            let message = format!(
                "`{}` has no feed per revolution: it is given per minute, for the spindle speed of each cut",
                self.capabilities.name
            );
            self.complain(&codes::lowering::NO_FEED_PER_REVOLUTION, message);
        }
        self.feed = Some(feed);
    }

    /// A point in linear steps.
    pub(super) fn round(&mut self, point: Point3) -> [i64; 3] {
        [point.x, point.y, point.z].map(|mm| self.linear(mm))
    }

    pub(super) fn linear(&mut self, mm: f64) -> i64 {
        let grid = &self.capabilities.grid;
        match number::steps(mm / grid.unit.in_mm(), grid.linear_decimals) {
            Some(steps) => steps,
            None => {
                self.complain(&codes::lowering::TOO_LARGE, format!("{mm} mm is beyond any axis word"));
                0
            }
        }
    }

    /// Where a straight move ends: on the first vertex of the contour it leads to, where the contour starts
    /// right there.
    fn aim(&mut self, index: usize, point: Point3, fitted: &[Option<Arc<Fitted>>]) -> [i64; 3] {
        let [x, y, z] = self.round(point);
        let next = self.cl.records.get(index + 1..).unwrap_or_default().iter().zip(index + 1..);
        // A contour is approached by a few moves; points in one place may be many.
        let next = next.take(MOST_APPROACH).find_map(|(r, i)| match &r.kind {
            RecordKind::Linear(p) | RecordKind::Rapid(p) if (p.xy() - point.xy()).norm() == 0.0 => None,
            RecordKind::Contour(c) if c.entry == Lead::None => Some(Some((i, c))),
            _ => Some(None),
        });
        let Some(Some((target, contour))) = next else { return [x, y, z] };
        let (start, _) = contour.curve.domain();
        let near = (contour.curve.at(start).p - point.xy()).norm() < self.capabilities.grid.linear_step();
        match fitted.get(target) {
            Some(Some(fit)) if near => [fit.fit.start[0], fit.fit.start[1], z],
            _ => [x, y, z],
        }
    }

    fn rapid_record(&mut self, [x, y, z]: [i64; 3]) {
        let turn = self.cartesian_turn();
        self.rapid(Position { x, y, z, r: turn });
    }

    /// Rotary position of a Cartesian move.
    pub(super) fn cartesian_turn(&self) -> i64 {
        if self.capabilities.rotary.is_none() {
            return 0;
        }
        let most = self.capabilities.ranges.rotary;
        rotary::nearest_turn_within(self.at[3].unwrap_or(0), most, &self.capabilities.grid)
    }

    /// Z first when it rises or is not known, last when it falls or comes from its upper end. Where it is not known it goes as
    /// high as the program goes with this tool before X and Y move.
    pub(super) fn rapid(&mut self, to: Position) {
        if self.capabilities.whole_points {
            return self.rapid_axes(to, axes::X | axes::Y | axes::Z | axes::ROTARY);
        }
        let rises = self.at[2].map_or(!self.parked, |z| to.z > z);
        if rises {
            let first = if self.at[2].is_none() { self.height().map_or(to.z, |h| h.max(to.z)) } else { to.z };
            self.rapid_axes(Position { z: first, ..to }, axes::Z);
        }
        self.rapid_plane(to);
        self.rapid_axes(to, axes::Z);
        self.parked = false;
    }

    /// X, Y and the table. The table turns only while the cutter is on its X axis: elsewhere a move of Y and a
    /// turn have no common path that everybody draws alike.
    fn rapid_plane(&mut self, to: Position) {
        let turns = self.at[3] != Some(to.r);
        let on_axis = self.at[1] == Some(0);
        if !turns || (on_axis && to.y == 0) {
            self.rapid_axes(to, axes::X | axes::Y | axes::ROTARY);
        } else if self.at[1].is_some_and(|y| y != 0) {
            self.rapid_axes(to, axes::X | axes::Y);
            self.rapid_axes(to, axes::ROTARY);
        } else {
            self.rapid_axes(to, axes::ROTARY);
            self.rapid_axes(to, axes::X | axes::Y);
        }
    }

    /// Moves those of these axes that are not there yet.
    pub(super) fn rapid_axes(&mut self, to: Position, wanted: u8) {
        let ends = [to.x, to.y, to.z, to.r];
        let mut moved = 0;
        for (i, end) in ends.into_iter().enumerate() {
            if wanted & (1 << i) != 0 && self.at[i] != Some(end) {
                moved |= 1 << i;
                self.at[i] = Some(end);
            }
        }
        if self.capabilities.whole_points && moved != 0 {
            // A height alone is no point: it is reached with the first one that is known.
            moved = if self.at.iter().all(Option::is_some) { moved | axes::X | axes::Y | axes::Z } else { 0 };
        }
        if moved != 0 {
            let to = self.here();
            self.push(Motion::Rapid { to, axes: moved });
        }
    }

    /// Known position; what is not known is where it was last, or 0.
    pub(super) fn here(&self) -> Position {
        let mut here = self.stale;
        for (slot, known) in here.iter_mut().zip(self.at) {
            *slot = known.unwrap_or(*slot);
        }
        let [x, y, z, r] = here;
        Position { x, y, z, r }
    }

    /// Block by block, the first one to where the pass starts.
    fn pass(&mut self, chain: &[super::pass::Step]) {
        for block in chain {
            let [x, y, z] = block.to;
            let (r, feed) = (self.face_front(), self.linear_feed());
            let to = Position { x, y, z, r };
            match &block.form {
                Form::Line => self.line(to, feed),
                Form::Arc(plane, centre, clockwise) => {
                    self.part((to, Some((*plane, *centre, *clockwise))), feed);
                }
                Form::Curve(curve) => {
                    let turned = |(p, weight): &(Position, f64)| (Position { r, ..*p }, *weight);
                    let points = curve.points.iter().map(turned).collect();
                    self.draw(Nurbs { points, ..(**curve).clone() }, feed);
                }
            }
        }
        let step = self.capabilities.grid.linear_step();
        self.exact = chain.last().map(|block| Point3::from(block.to.map(|s| s as f64 * step)));
    }

    fn linear_record(&mut self, [x, y, z]: [i64; 3]) {
        let turn = self.face_front();
        let feed = self.linear_feed();
        self.line(Position { x, y, z, r: turn }, feed);
    }

    /// Before a Cartesian cut: the place must be known, and the table, if there is one, where such moves are made.
    pub(super) fn face_front(&mut self) -> i64 {
        if self.at[..3].contains(&None) {
            let message = "a cut from where the machine happens to stand, and nobody knows where that is";
            self.complain(&codes::planning::NO_START, message.into());
        }
        let turn = self.cartesian_turn();
        if self.at[3] != Some(turn) {
            self.rapid_axes(Position { r: turn, ..self.here() }, axes::ROTARY);
        }
        turn
    }

    /// A straight cut; nothing when it has no length.
    pub(super) fn line(&mut self, to: Position, feed: FeedWord) {
        let end = [to.x, to.y, to.z, to.r].map(Some);
        if self.at != end {
            self.at = end;
            self.push(Motion::Line { to, feed });
        }
    }

    pub(super) fn linear_feed(&mut self) -> FeedWord {
        match feed::linear(self.feed, self.rpm, self.capabilities) {
            Ok(word) => word,
            Err(trouble) => self.feed_trouble(&trouble),
        }
    }

    pub(super) fn plunge_feed(&mut self, contour: &Contour) -> FeedWord {
        match contour.plunge_feed {
            None => self.linear_feed(),
            Some(value) => match feed::minute_word(value, self.capabilities) {
                Ok(word) => word,
                Err(trouble) => self.feed_trouble(&trouble),
            },
        }
    }

    /// Pushes a motion and checks it.
    pub(super) fn push(&mut self, motion: Motion) {
        self.check(&motion);
        self.compensates(&motion);
        self.blocks.push(Block {
            kind: BlockKind::Motion(motion),
            origin: self.origin,
            piece: self.piece,
            record: self.of_record,
        });
    }

    fn check(&mut self, motion: &Motion) {
        let (to, moved) = match motion {
            Motion::Rapid { to, axes } => (*to, *axes),
            Motion::Line { to, .. } | Motion::Arc { to, .. } => {
                (*to, axes::X | axes::Y | axes::Z | axes::ROTARY)
            }
            Motion::Nurbs { .. } => return,
        };
        self.check_position(to, moved);
        let ranges = self.capabilities.ranges;
        if let Motion::Arc { centre, .. } = motion
            && centre.iter().any(|c| c.abs() > ranges.centre)
        {
            self.complain(
                &codes::lowering::TOO_LARGE,
                "an arc centre is beyond the range of its words".into(),
            );
        }
    }

    /// Positions that a cycle reaches.
    pub(super) fn check_place(&mut self, places: &[Position]) {
        for place in places {
            self.check_position(*place, axes::X | axes::Y | axes::Z | axes::ROTARY);
        }
    }

    fn check_position(&mut self, to: Position, moved: u8) {
        let ranges = self.capabilities.ranges;
        let values = [to.x, to.y, to.z, to.r];
        for (i, value) in values.into_iter().enumerate().filter(|(i, _)| moved & (1 << i) != 0) {
            let limit = if i == 3 { ranges.rotary } else { ranges.linear };
            if value.abs() > limit {
                self.too_large(i, value, limit);
            } else if let Some(Some(range)) = self.capabilities.travel.get(i) {
                self.check_travel(i, value as f64, *range);
            }
        }
    }

    fn too_large(&mut self, axis: usize, value: i64, limit: i64) {
        let decimals = if axis == 3 {
            self.capabilities.grid.rotary_decimals
        } else {
            self.capabilities.grid.linear_decimals
        };
        let message = format!(
            "{} = {} is larger than the word takes ({})",
            AXIS_NAMES[axis],
            number::plain(value, decimals),
            number::plain(limit, decimals)
        );
        self.complain(&codes::lowering::TOO_LARGE, message);
    }

    /// The furthest points of an arc in X and Y against the travel.
    pub(super) fn check_bulge(&mut self, arc: &crate::target::GridArc) {
        if self.capabilities.travel.iter().any(Option::is_some) {
            let scale = super::arc::centre_per_linear(self.capabilities);
            arc.extremes(scale).into_iter().for_each(|p| self.check_plane(p));
        }
    }

    /// X and Y in linear steps against the travel.
    pub(super) fn check_plane(&mut self, point: [f64; 2]) {
        for (i, value) in point.into_iter().enumerate() {
            if let Some(Some(range)) = self.capabilities.travel.get(i) {
                self.check_travel(i, value, *range);
            }
        }
    }

    fn check_travel(&mut self, axis: usize, value: f64, (low, high): (f64, f64)) {
        let mm = value * self.capabilities.grid.linear_step();
        if !(low..=high).contains(&mm) {
            let message =
                format!("{} = {mm:.4} mm is outside the travel of {low} to {high} mm", AXIS_NAMES[axis]);
            self.complain(&codes::lowering::OUT_OF_TRAVEL, message);
        }
    }
}

const AXIS_NAMES: [&str; 4] = ["X", "Y", "Z", "the rotary axis"];
