//! The machine's state while planning, and the records that change it.

use super::Planner;
use super::holes::Drilling;
use crate::arena::Handle;
use crate::cl::{Record, RecordKind};
use crate::diag::Diagnostic;
use crate::diag::codes::planning::{NO_FEED, NO_FLUTES, NO_START, NO_TOOL, SPINDLE_OFF};
use crate::geom::Point3;
use crate::ir::{Feed, Origin, Spindle, Tool};

/// What has been commanded so far.
#[derive(Debug)]
pub(super) struct State {
    pub tool: Option<Handle<Tool>>,
    pub spindle: Spindle,
    /// As programmed.
    pub feed: Option<Feed>,
    /// As last recorded.
    pub recorded_feed: Option<Feed>,
    /// The cutter is at a known place: not before the first `FROM` or rapid, nor after a tool change.
    pub placed: bool,
    /// `FROM` since the last move.
    from: Option<From>,
    /// The drilling cycle in force.
    pub drilling: Option<Drilling>,
    /// Where the last move ended, if it was one of the program's own.
    pub at: Option<Point3>,
    /// Its height.
    pub height: Option<f64>,
}

/// Where `FROM` says that the cutter is.
#[derive(Debug, Clone, Copy)]
struct From {
    point: Point3,
    origin: Handle<Origin>,
}

impl Default for State {
    fn default() -> State {
        State {
            tool: None,
            spindle: Spindle::Off,
            feed: None,
            recorded_feed: None,
            placed: false,
            from: None,
            drilling: None,
            at: None,
            height: None,
        }
    }
}

/// What a cut needs, found to be there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ready {
    /// Feed as recorded.
    pub feed: Feed,
    pub clockwise: bool,
}

impl Ready {
    /// mm/min, when the feed is one.
    pub fn per_minute(&self) -> Option<f64> {
        match self.feed {
            Feed::PerMinute(v) => Some(v),
            Feed::PerRevolution(_) | Feed::PerTooth(_) => None,
        }
    }
}

impl Planner<'_> {
    pub(super) fn emit(&mut self, kind: RecordKind, origin: Handle<Origin>) {
        self.cl.records.push(Record { kind, origin });
    }

    pub(super) fn load(&mut self, tool: Handle<Tool>, origin: Handle<Origin>) {
        self.state.tool = Some(tool);
        self.state.at = None;
        self.state.height = None;
        // A tool change stops the spindle, and moves the machine to where it changes.
        self.state.spindle = Spindle::Off;
        self.state.placed = false;
        self.emit(RecordKind::LoadTool(tool), origin);
        if let Some(from) = self.state.from {
            self.go_from(from);
        }
    }

    pub(super) fn spindle(&mut self, spindle: Spindle, origin: Handle<Origin>) {
        self.state.spindle = spindle;
        self.emit(RecordKind::Spindle(spindle), origin);
    }

    /// A feed per tooth waits for the cut that uses it: speed and flutes may still change.
    pub(super) fn feed(&mut self, feed: Feed, origin: Handle<Origin>) {
        self.state.feed = Some(feed);
        if !matches!(feed, Feed::PerTooth(_)) {
            self.record_feed(feed, origin);
        }
    }

    fn record_feed(&mut self, feed: Feed, origin: Handle<Origin>) {
        if self.state.recorded_feed != Some(feed) {
            self.state.recorded_feed = Some(feed);
            self.emit(RecordKind::Feed(feed), origin);
        }
    }

    /// `FROM` before the first tool change waits for it; else the cutter goes there. Another tool change before
    /// the next move brings it back there.
    pub(super) fn from(&mut self, point: Point3, origin: Handle<Origin>) {
        let from = From { point, origin };
        self.state.from = Some(from);
        if self.state.tool.is_some() {
            self.go_from(from);
        }
    }

    fn go_from(&mut self, from: From) {
        self.state.placed = true;
        self.arrive(from.point);
        self.emit(RecordKind::From(from.point), from.origin);
    }

    /// An operation comes to its first point by itself, from wherever the machine is.
    pub(super) fn start_operation(&mut self) {
        self.leave_from();
        self.state.placed = true;
        self.state.at = None;
        self.state.height = None;
    }

    /// Before a move: a `FROM` that no tool change has carried out is carried out.
    fn leave_from(&mut self) {
        if let Some(from) = self.state.from.take().filter(|_| !self.state.placed) {
            self.go_from(from);
        }
    }

    pub(super) fn rapid(&mut self, to: Point3, origin: Handle<Origin>) {
        self.leave_from();
        self.state.placed = true;
        self.arrive(to);
        self.emit(RecordKind::Rapid(to), origin);
    }

    pub(super) fn linear(&mut self, to: Point3, origin: Handle<Origin>) {
        self.leave_from();
        self.state.placed = true;
        self.arrive(to);
        self.emit(RecordKind::Linear(to), origin);
    }

    /// A `GOTO` at feed.
    pub(super) fn goto(&mut self, to: Point3, origin: Handle<Origin>) {
        let ready = self.ready("GOTO", None, origin).is_some();
        let placed = self.state.placed || self.state.from.is_some();
        if !placed {
            self.report_no_start(origin);
        }
        if ready && placed {
            self.linear(to, origin);
        }
        // One message is enough.
        self.state.placed = true;
    }

    fn report_no_start(&mut self, origin: Handle<Origin>) {
        let message =
            if self.cl.records.iter().any(|r| matches!(r.kind, RecordKind::Rapid(_) | RecordKind::Linear(_)))
            {
                "GOTO cuts from where the tool change left the machine, and nobody knows where that is"
            } else {
                "GOTO cuts from where the machine happens to stand, and nobody knows where that is"
            };
        let diagnostic = Diagnostic::new(&NO_START, self.span(origin), message).help(
            "say where the cutter is before it, `FROM/ 0, 0, 50`, or go to the first point at rapid: `RAPID` and `GOTO/ …`",
        );
        self.report(diagnostic, origin);
    }

    /// Tool, spindle and feed for a cut; what is missing is reported, all of it at once.
    pub(super) fn ready(
        &mut self,
        what: &str,
        tool: Option<Handle<Tool>>,
        origin: Handle<Origin>,
    ) -> Option<Ready> {
        let tool = self.need_tool(what, tool, origin);
        let spindle = self.need_spindle(what, origin);
        let feed = self.need_feed(what, tool, spindle, origin);
        let (rpm_sense, feed) = (spindle?, feed?);
        self.record_feed(feed, origin);
        tool?;
        Some(Ready { feed, clockwise: rpm_sense.1 })
    }

    /// What a hole needs whose cycle has its own feed.
    pub(super) fn turns(&mut self, what: &str, origin: Handle<Origin>) -> bool {
        let tool = self.need_tool(what, None, origin);
        self.need_spindle(what, origin).is_some() && tool.is_some()
    }

    fn need_tool(
        &mut self,
        what: &str,
        tool: Option<Handle<Tool>>,
        origin: Handle<Origin>,
    ) -> Option<Handle<Tool>> {
        let tool = tool.or(self.state.tool);
        if tool.is_none() {
            let message = format!("{what} cuts, but no tool has been loaded");
            let diagnostic = Diagnostic::new(&NO_TOOL, self.span(origin), message)
                .help("declare a cutter and load it first: `T1 = CUTTER/ 16, FLUTES, 4` and `LOADTL/ T1`");
            self.report(diagnostic, origin);
        }
        tool
    }

    /// Speed in rev/min and whether clockwise.
    fn need_spindle(&mut self, what: &str, origin: Handle<Origin>) -> Option<(f64, bool)> {
        match self.state.spindle {
            Spindle::On { rpm, clockwise, .. } => Some((rpm, clockwise)),
            Spindle::Off => {
                let message = format!("{what} cuts, but the spindle is off");
                let diagnostic = Diagnostic::new(&SPINDLE_OFF, self.span(origin), message)
                    .help("start it first: `SPINDL/ 1200, CLW`");
                self.report(diagnostic, origin);
                None
            }
        }
    }

    fn need_feed(
        &mut self,
        what: &str,
        tool: Option<Handle<Tool>>,
        spindle: Option<(f64, bool)>,
        origin: Handle<Origin>,
    ) -> Option<Feed> {
        match self.state.feed {
            Some(Feed::PerTooth(feed)) => self.feed_of_teeth(feed, tool?, spindle?.0, origin),
            Some(feed) => Some(feed),
            None => {
                let message = format!("{what} cuts, but no feed has been set");
                let diagnostic = Diagnostic::new(&NO_FEED, self.span(origin), message)
                    .help("set it first: `FEDRAT/ 300, MMPM`");
                self.report(diagnostic, origin);
                None
            }
        }
    }

    /// mm/tooth into mm/min: feed × flutes × speed.
    fn feed_of_teeth(
        &mut self,
        feed: f64,
        tool: Handle<Tool>,
        rpm: f64,
        origin: Handle<Origin>,
    ) -> Option<Feed> {
        let cutter = &self.program.tools[tool];
        let Some(flutes) = cutter.flutes.filter(|n| *n > 0) else {
            let message = format!(
                "the feed is {} per tooth, but cutter {} does not say how many flutes it has",
                self.show(feed),
                cutter.name
            );
            let declared = self.span(cutter.origin);
            let diagnostic = Diagnostic::new(&NO_FLUTES, self.span(origin), message)
                .label(declared, "the cutter is declared here")
                .help(format!("add its flutes: `{} = CUTTER/ …, FLUTES, 4`", cutter.name));
            self.report(diagnostic, origin);
            return None;
        };
        Some(Feed::PerMinute(feed * f64::from(flutes) * rpm))
    }
}
