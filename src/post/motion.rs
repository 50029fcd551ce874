//! Motion blocks: straight moves, arcs, helices and holes, on the tables compiled from the patterns.

use super::dialect::FullCircleWords;
use super::pattern::{Item, Slot};
use super::table::{
    ARC_CCW, ARC_CW, ARC_PATTERN, HELIX_PATTERN, HOLE_PATTERN, INVERSE_TIME, LINE, LINE_PATTERN, PER_MINUTE,
    RAPID, RAPID_PATTERN,
};
use super::writer::{Writer, split_feed};
use crate::target::number;
use crate::target::{GridArc, Motion, Plane, Position, axes};

const ALL_AXES: u8 = axes::X | axes::Y | axes::Z | axes::ROTARY;

/// First, second and third axis of the planes: XY, ZX, YZ.
const PLANE_AXES: [[usize; 3]; 3] = [[0, 1, 2], [2, 0, 1], [1, 2, 0]];

/// A motion in the form that patterns read.
pub(super) struct MotionBlock {
    pattern: usize,
    code: usize,
    pub to: Position,
    pub axes: u8,
    plane: usize,
    centre: [i64; 2],
    feed: Option<(usize, i64)>,
    /// The arc is a full circle.
    circle: bool,
}

impl Writer<'_> {
    /// A straight move or an arc.
    pub fn motion(&mut self, motion: &Motion) {
        let block = match *motion {
            Motion::Rapid { to, axes } => self.rapid(to, axes),
            Motion::Line { to, feed } => MotionBlock {
                pattern: LINE_PATTERN,
                code: LINE,
                to,
                axes: ALL_AXES,
                plane: 0,
                centre: [0, 0],
                feed: Some(split_feed(feed)),
                circle: false,
            },
            Motion::Arc { to, plane, centre, clockwise, feed } => {
                let code = if clockwise { ARC_CW } else { ARC_CCW };
                self.arc(to, plane_index(plane), centre, code, split_feed(feed))
            }
            Motion::Nurbs { .. } => return,
        };
        if self.has_something_to_do(&block) {
            self.state.curve = false;
            self.print(&block);
            self.arrive(&block);
        }
    }

    fn rapid(&self, to: Position, axes: u8) -> MotionBlock {
        MotionBlock {
            pattern: RAPID_PATTERN,
            code: RAPID,
            to,
            axes: axes | self.table.rapid_axes,
            plane: 0,
            centre: [0, 0],
            feed: self.table.rapid_feed.map(|steps| (PER_MINUTE, steps)),
            circle: false,
        }
    }

    fn arc(
        &self,
        to: Position,
        plane: usize,
        centre: [i64; 2],
        code: usize,
        feed: (usize, i64),
    ) -> MotionBlock {
        let (ends, starts) = (linear(to), linear(self.position));
        let [first, second, third] = PLANE_AXES[plane];
        MotionBlock {
            pattern: if ends[third] == starts[third] { ARC_PATTERN + plane } else { HELIX_PATTERN },
            code,
            to,
            axes: ALL_AXES,
            plane,
            centre,
            feed: Some(feed),
            circle: ends[first] == starts[first] && ends[second] == starts[second],
        }
    }

    /// A hole of a drilling cycle, at its surface; `after` is where the tool is after it.
    pub fn hole(&mut self, at: Position, after: i64) {
        let block = MotionBlock { pattern: HOLE_PATTERN, ..self.rapid(at, axes::X | axes::Y | axes::Z) };
        // A hole where the last one was says where it is.
        if self.state.axes[0] == Some(at.x) && self.state.axes[1] == Some(at.y) {
            self.state.axes[0] = None;
            self.state.axes[1] = None;
        }
        self.state.axes[2] = None;
        self.print(&block);
        self.arrive(&block);
        self.position.z = after;
        self.state.axes[2] = Some(after);
        self.state.feed = None;
    }

    fn print(&mut self, block: &MotionBlock) {
        self.begin_line(true);
        if !self.with_first_z.is_empty() && block.axes & axes::Z != 0 {
            let words = core::mem::take(&mut self.with_first_z);
            self.text(&words);
        }
        self.items(block);
        self.end_line();
    }

    /// A straight move to where the machine is prints nothing.
    #[inline]
    fn has_something_to_do(&self, block: &MotionBlock) -> bool {
        block.circle
            || [block.to.x, block.to.y, block.to.z, block.to.r]
                .iter()
                .enumerate()
                .any(|(i, &value)| block.axes & (1 << i) != 0 && self.state.axes[i] != Some(value))
    }

    fn items(&mut self, block: &MotionBlock) {
        // The pattern is taken out of the table so that items can be printed while it is read.
        let pattern = core::mem::take(&mut self.table.patterns[block.pattern]);
        for item in &pattern {
            match item {
                Item::Motion => self.motion_code(block.code),
                Item::FeedMode => self.feed_mode(block),
                Item::Direction => self.direction(block),
                Item::Plane => self.plane(block.plane),
                Item::Compensation => self.compensation(block),
                Item::NewLine => {
                    self.end_line();
                    self.begin_line(true);
                }
                Item::Text(text) => self.text(text),
                Item::Word(slot) => self.word(*slot, block),
                Item::Cycle => self.cycle_text(0),
                Item::CycleWords => self.cycle_text(1),
                Item::Named(_) => self.turning_axis(block),
                // No pattern of motion holds it.
                Item::Code | Item::Coefficient(_) => {}
            }
        }
        // Text in the place of a motion code leaves another one in force.
        if block.pattern >= ARC_PATTERN && !pattern.contains(&Item::Motion) {
            self.state.motion = None;
        }
        self.table.patterns[block.pattern] = pattern;
    }

    /// The axis that an arc turns about by the right hand, as three numbers.
    fn turning_axis(&mut self, block: &MotionBlock) {
        let third = PLANE_AXES[block.plane][2];
        let sense = if block.code == ARC_CCW { 1 } else { -1 };
        for axis in 0..3 {
            self.separate();
            self.out.extend_from_slice(&self.table.axis.prefix);
            number::push(&mut self.out, if axis == third { sense } else { 0 }, &self.table.axis.style);
        }
    }

    #[inline]
    fn slot(&mut self, slot: Slot, value: i64) {
        let format = &self.table.words[slot as usize];
        let lead = if self.out.len() > self.words_start { &format.spaced } else { &format.prefix };
        number::push_word(&mut self.out, lead, value, &format.style);
        if !format.suffix.is_empty() {
            self.out.extend_from_slice(&format.suffix);
        }
    }

    #[inline]
    fn motion_code(&mut self, code: usize) {
        if self.table.modal_motion && self.state.motion == Some(code) {
            return;
        }
        if self.out.len() > self.words_start {
            self.out.extend_from_slice(&self.table.separator);
        }
        self.out.extend_from_slice(&self.table.codes[code]);
        self.state.motion = Some(code);
    }

    /// After a change of feed mode no control keeps F.
    #[inline]
    fn feed_mode(&mut self, block: &MotionBlock) {
        let Some((mode, _)) = block.feed else { return };
        if self.state.mode == Some(mode) {
            return;
        }
        let code = core::mem::take(&mut self.table.modes[mode]);
        self.text(&code);
        self.table.modes[mode] = code;
        self.state.mode = Some(mode);
        self.state.feed = None;
    }

    /// The code of a plane, when it changes.
    pub fn plane(&mut self, plane: usize) {
        if self.state.plane == Some(plane) {
            return;
        }
        let code = core::mem::take(&mut self.table.planes[plane]);
        self.text(&code);
        self.table.planes[plane] = code;
        self.state.plane = Some(plane);
    }

    fn direction(&mut self, block: &MotionBlock) {
        let index = usize::from(block.code == ARC_CCW);
        let text = core::mem::take(&mut self.table.directions[index]);
        self.text(&text);
        self.table.directions[index] = text;
    }

    fn cycle_text(&mut self, index: usize) {
        let text = core::mem::take(&mut self.cycle[index]);
        self.text(&text);
    }

    #[inline]
    fn word(&mut self, slot: Slot, block: &MotionBlock) {
        match slot {
            Slot::X => self.axis(slot, 0, block.to.x, block),
            Slot::Y => self.axis(slot, 1, block.to.y, block),
            Slot::Z => self.axis(slot, 2, block.to.z, block),
            Slot::Rotary => self.axis(slot, 3, block.to.r, block),
            Slot::I => self.offset(slot, 0, block),
            Slot::J => self.offset(slot, 1, block),
            Slot::K => self.offset(slot, 2, block),
            Slot::Cx => self.centre(slot, 0, block),
            Slot::Cy => self.centre(slot, 1, block),
            Slot::Cz => self.centre(slot, 2, block),
            Slot::Mx => self.middle(slot, 0, block),
            Slot::My => self.middle(slot, 1, block),
            Slot::Mz => self.middle(slot, 2, block),
            Slot::Radius => self.radius(block),
            Slot::Sweep => self.sweep(block),
            Slot::Feed => self.feed(block),
        }
    }

    #[inline]
    fn axis(&mut self, slot: Slot, index: usize, value: i64, block: &MotionBlock) {
        let in_plane = block.pattern >= ARC_PATTERN && index != PLANE_AXES[block.plane][2] && index < 3;
        let print = if block.circle && in_plane {
            match self.table.full_circle {
                FullCircleWords::Bare | FullCircleWords::Split => false,
                FullCircleWords::OneEndWord => index == PLANE_AXES[block.plane][0],
                FullCircleWords::EndWords => true,
            }
        } else {
            let modal = self.table.words[slot as usize].modal && (!in_plane || self.table.modal_arc_ends);
            block.axes & (1 << index) != 0 && !(modal && self.state.axes[index] == Some(value))
        };
        // The rotary word of a machine without one has no letter and never moves.
        if print && !(index == 3 && self.table.words[slot as usize].prefix.is_empty()) {
            self.slot(slot, value);
        }
    }

    /// Centre from the start along an axis of the plane; the third axis has none.
    #[inline]
    fn offset(&mut self, slot: Slot, axis: usize, block: &MotionBlock) {
        let [first, second, _] = PLANE_AXES[block.plane];
        let (value, other) = if axis == first {
            (block.centre[0], block.centre[1])
        } else if axis == second {
            (block.centre[1], block.centre[0])
        } else {
            return;
        };
        if !(self.table.drop_zero && value == 0 && other != 0) {
            self.slot(slot, value);
        }
    }

    /// Centre in program coordinates; along the third axis, where the arc starts.
    fn centre(&mut self, slot: Slot, axis: usize, block: &MotionBlock) {
        let [first, second, _] = PLANE_AXES[block.plane];
        let start = linear(self.position)[axis] * self.table.centre_per_linear;
        let offset = if axis == first {
            block.centre[0]
        } else if axis == second {
            block.centre[1]
        } else {
            0
        };
        self.slot(slot, start + offset);
    }

    /// The place halfway in program coordinates; along the third axis, where the arc starts.
    fn middle(&mut self, slot: Slot, axis: usize, block: &MotionBlock) {
        let [first, second, _] = PLANE_AXES[block.plane];
        let (ends, starts) = (linear(block.to), linear(self.position));
        let flat = |p: [i64; 3]| [p[first], p[second]];
        let (centre, clockwise) = (block.centre, block.code == ARC_CW);
        let arc = GridArc { start: flat(starts), to: flat(ends), centre, clockwise };
        let between = arc.middle(self.table.centre_per_linear);
        let value = if axis == first {
            between[0]
        } else if axis == second {
            between[1]
        } else {
            starts[axis]
        };
        self.slot(slot, value);
    }

    /// End minus start in the plane, in centre steps.
    fn chord(&self, block: &MotionBlock) -> [i64; 2] {
        let [first, second, _] = PLANE_AXES[block.plane];
        let (ends, starts) = (linear(block.to), linear(self.position));
        [first, second].map(|axis| (ends[axis] - starts[axis]) * self.table.centre_per_linear)
    }

    /// R; where the control wants a sign, negative for more than half a turn.
    fn radius(&mut self, block: &MotionBlock) {
        // Steps of any machine are far below 2^53.
        let [cx, cy] = block.centre.map(|v| v as f64);
        let radius = crate::math::hypot(cx, cy).round() as i64;
        let end = self.chord(block);
        let cross = end[0] as f64 * cy - end[1] as f64 * cx;
        let large = if block.code == ARC_CW { cross > 0.0 } else { cross < 0.0 };
        self.slot(Slot::Radius, if large && self.table.signed_radius { -radius } else { radius });
    }

    /// Degrees that an arc turns, counter-clockwise positive.
    fn sweep(&mut self, block: &MotionBlock) {
        let [cx, cy] = block.centre.map(|v| v as f64);
        let end = self.chord(block).map(|v| v as f64);
        let to = [end[0] - cx, end[1] - cy];
        let turned = crate::math::atan2(cy * to[0] - cx * to[1], -cx * to[0] - cy * to[1]).to_degrees();
        let turned = match (block.code, block.circle) {
            (ARC_CW, true) => -360.0,
            (ARC_CW, false) if turned > 0.0 => turned - 360.0,
            (ARC_CCW, true) => 360.0,
            (ARC_CCW, false) if turned < 0.0 => turned + 360.0,
            _ => turned,
        };
        let decimals = self.table.words[Slot::Sweep as usize].style.decimals;
        // At most 360 degrees in at most nine decimals.
        self.slot(Slot::Sweep, number::steps(turned, decimals).unwrap_or(0));
    }

    #[inline]
    fn feed(&mut self, block: &MotionBlock) {
        let Some((mode, value)) = block.feed else { return };
        let same = self.state.feed == Some(value) && self.state.mode == Some(mode);
        if same && mode != INVERSE_TIME && self.table.feeds[mode].modal {
            return;
        }
        let format = &self.table.feeds[mode];
        let lead = if self.out.len() > self.words_start { &format.spaced } else { &format.prefix };
        number::push_word(&mut self.out, lead, value, &format.style);
        self.out.extend_from_slice(&format.suffix);
        self.state.feed = Some(value);
        self.state.mode = Some(mode);
    }

    #[inline]
    fn arrive(&mut self, block: &MotionBlock) {
        let ends = [block.to.x, block.to.y, block.to.z, block.to.r];
        for (index, value) in ends.into_iter().enumerate() {
            if block.axes & (1 << index) != 0 {
                self.state.axes[index] = Some(value);
            }
        }
        if !self.table.says_end[block.pattern] {
            let [first, second, _] = PLANE_AXES[block.plane];
            self.state.axes[first] = None;
            self.state.axes[second] = None;
        }
        let old = self.position;
        let pick = |bit: u8, new: i64, old: i64| if block.axes & bit != 0 { new } else { old };
        self.position = Position {
            x: pick(axes::X, block.to.x, old.x),
            y: pick(axes::Y, block.to.y, old.y),
            z: pick(axes::Z, block.to.z, old.z),
            r: pick(axes::ROTARY, block.to.r, old.r),
        };
    }
}

const fn plane_index(plane: Plane) -> usize {
    match plane {
        Plane::Xy => 0,
        Plane::Zx => 1,
        Plane::Yz => 2,
    }
}

const fn linear(at: Position) -> [i64; 3] {
    [at.x, at.y, at.z]
}
