//! What one straight link can do in a tube of gates: how far it sees from a point, and from a window.
//!
//! A link passes the gates in order, right of all left ends and left of all right ends. From a point this is a wedge
//! of directions; from a window (a segment across the tube) it is the set of lines between two convex hulls, kept by
//! its two extremal lines (O'Rourke 1981; Imai & Iri 1986; the windows are those of Suri 1986). Each gate is looked at
//! a constant number of times, amortised.

use super::tube::Gates;
use crate::geom::{Vec2, cross};

/// The gates a search may use: those of a tube up to an end, which may be a point that the path must hit.
#[derive(Debug, Clone, Copy)]
pub struct Course<'a> {
    /// The tube.
    pub gates: &'a Gates,
    /// Index of the final gate.
    pub end: usize,
    /// The final gate is this point.
    pub target: Option<Vec2>,
}

impl Course<'_> {
    /// Left end of gate `i`.
    #[inline]
    #[must_use]
    pub fn left(&self, i: usize) -> Vec2 {
        match self.target {
            Some(p) if i >= self.end => p,
            _ => self.gates.left(i),
        }
    }
    /// Right end of gate `i`.
    #[inline]
    #[must_use]
    pub fn right(&self, i: usize) -> Vec2 {
        match self.target {
            Some(p) if i >= self.end => p,
            _ => self.gates.right(i),
        }
    }
    /// End of gate `i` on a side.
    #[inline]
    #[must_use]
    pub fn on(&self, side: Bank, i: usize) -> Vec2 {
        match side {
            Bank::Left => self.left(i),
            Bank::Right => self.right(i),
        }
    }
    /// The last gate that is passed at or before `p`, found by walking back from `from`; `None` when there is none.
    #[must_use]
    pub fn locate(&self, p: Vec2, from: usize, floor: usize) -> Option<usize> {
        let mut i = from;
        loop {
            let (r, l) = (self.gates.right(i), self.gates.left(i));
            if cross(l - r, p - r) <= 0.0 {
                return Some(i);
            }
            if i <= floor {
                return None;
            }
            i -= 1;
        }
    }
    /// Whether the straight way from `p`, whose next gate is `next`, to `q` passes the gates up to `last`.
    #[must_use]
    pub fn sees(&self, p: Vec2, next: usize, q: Vec2, last: usize) -> bool {
        let d = q - p;
        (next..=last).all(|i| cross(d, self.left(i) - p) >= 0.0 && cross(d, self.right(i) - p) <= 0.0)
    }
}

/// A boundary of the tube.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bank {
    /// To the left of travel.
    Left,
    /// To the right.
    Right,
}

/// Why a view ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// The farthest link leaves the tube through this bank, after touching the other.
    Through(Bank),
    /// It passes the final gate.
    End,
}

/// A segment across the tube that separates what can be seen from what cannot.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    /// Left end.
    pub l: Vec2,
    /// Right end.
    pub r: Vec2,
    /// Bank of the last contact; on it the gates from `after` on lie beyond the window, on the other those from `next` on.
    pub contact: Bank,
    /// First gate beyond the last contact.
    pub after: usize,
    /// First gate that lies beyond the window altogether.
    pub next: usize,
}

/// How far a link sees: the farthest line and where it ends.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// Why it ends.
    pub exit: Exit,
    /// Most clockwise line: a point and a direction.
    pub lo: (Vec2, Vec2),
    /// Most counter-clockwise line.
    pub hi: (Vec2, Vec2),
    /// Bounds of the directions to points beyond the last contact: that line, and on the other side the bound as it
    /// was there (what lies before the last gate is seen past fewer gates).
    pub wedge: (Vec2, Vec2),
    /// Gate of the last contact of the farthest line.
    pub contact: usize,
    /// The gate that it cannot pass (the final gate's successor at the end).
    pub stop: usize,
    /// Where it leaves the tube.
    pub tip: Vec2,
    /// Position of `tip` in gates.
    pub reach: f64,
}

impl View {
    /// The farthest line: for a view that reaches the end, the middle of the possible ones.
    #[must_use]
    pub fn line(&self) -> (Vec2, Vec2) {
        match self.exit {
            Exit::Through(Bank::Right) => self.hi,
            Exit::Through(Bank::Left) => self.lo,
            Exit::End => {
                let unit = |v: Vec2| v / v.norm().max(f64::MIN_POSITIVE);
                (self.tip, unit(self.lo.1) + unit(self.hi.1))
            }
        }
    }
    /// The window at the end of the view; `None` at the end of the course.
    #[must_use]
    pub fn window(&self, course: &Course) -> Option<Window> {
        let (after, next) = (self.contact + 1, self.stop);
        match self.exit {
            Exit::End => None,
            Exit::Through(Bank::Right) => {
                Some(Window { l: course.left(self.contact), r: self.tip, contact: Bank::Left, after, next })
            }
            Exit::Through(Bank::Left) => {
                Some(Window { l: self.tip, r: course.right(self.contact), contact: Bank::Right, after, next })
            }
        }
    }
}

/// Where the line through `p` along `d` meets the bank's piece from `a` (at gate `i`) to `b`, and its position in gates.
fn leave(p: Vec2, d: Vec2, a: Vec2, b: Vec2, i: f64) -> (Vec2, f64) {
    let (ca, cb) = (cross(d, a - p), cross(d, b - p));
    let share = if ca == cb { 0.0 } else { (ca / (ca - cb)).clamp(0.0, 1.0) };
    (a + (b - a) * share, i + share)
}

/// The view from the point `p`, whose next gate is `next`.
#[must_use]
pub fn look(course: &Course, p: Vec2, next: usize) -> View {
    let (mut lo, mut hi) = (course.right(next) - p, course.left(next) - p);
    let (mut lo_at, mut hi_at) = (next, next);
    let (mut lo_then, mut hi_then) = (lo, hi);
    let mut i = next;
    let (mut before_l, mut before_r) = (p + hi, p + lo);
    while i < course.end {
        i += 1;
        let (l, r) = (course.left(i), course.right(i));
        let (dl, dr) = (l - p, r - p);
        if cross(hi, dr) > 0.0 {
            let (tip, reach) = leave(p, hi, before_r, r, (i - 1) as f64);
            let exit = Exit::Through(Bank::Right);
            return View {
                exit,
                lo: (p, lo),
                hi: (p, hi),
                wedge: (lo_then, hi),
                contact: hi_at,
                stop: i,
                tip,
                reach,
            };
        }
        if cross(lo, dl) < 0.0 {
            let (tip, reach) = leave(p, lo, before_l, l, (i - 1) as f64);
            let exit = Exit::Through(Bank::Left);
            return View {
                exit,
                lo: (p, lo),
                hi: (p, hi),
                wedge: (lo, hi_then),
                contact: lo_at,
                stop: i,
                tip,
                reach,
            };
        }
        let before = (lo, hi);
        if cross(hi, dl) <= 0.0 {
            (hi, hi_at, lo_then) = (dl, i, before.0);
        }
        if cross(lo, dr) >= 0.0 {
            (lo, lo_at, hi_then) = (dr, i, before.1);
        }
        (before_l, before_r) = (l, r);
    }
    let tip = p + (lo + hi) / 2.0;
    let (contact, stop, reach) = (course.end, course.end + 1, course.end as f64);
    View { exit: Exit::End, lo: (p, lo), hi: (p, hi), wedge: (lo, hi), contact, stop, tip, reach }
}

/// Working memory of [`Stab::view`].
#[derive(Debug, Default)]
pub struct Stab {
    /// Right hull of the left ends: turns left.
    l: Vec<Vec2>,
    /// Left hull of the right ends: turns right.
    r: Vec<Vec2>,
    /// Where the extremal lines touch the hulls first.
    l_at: usize,
    r_at: usize,
    hi: (Vec2, Vec2),
    lo: (Vec2, Vec2),
    hi_contact: usize,
    lo_contact: usize,
}

impl Stab {
    /// The farthest line from anywhere on the window.
    pub fn view(&mut self, course: &Course, window: &Window) -> View {
        self.start(window);
        for i in window.after..window.next.min(course.end + 1) {
            match window.contact {
                Bank::Left => self.add_left(course.left(i), i),
                Bank::Right => self.add_right(course.right(i), i),
            }
        }
        let (mut before_l, mut before_r) = (window.l, window.r);
        let mut i = window.next;
        while i <= course.end {
            let (l, r) = (course.left(i), course.right(i));
            if cross(self.hi.1, r - self.hi.0) > 0.0 {
                let (tip, reach) = leave(self.hi.0, self.hi.1, before_r, r, i as f64 - 1.0);
                return self.result(Exit::Through(Bank::Right), i, tip, reach);
            }
            if cross(self.lo.1, l - self.lo.0) < 0.0 {
                let (tip, reach) = leave(self.lo.0, self.lo.1, before_l, l, i as f64 - 1.0);
                return self.result(Exit::Through(Bank::Left), i, tip, reach);
            }
            self.add_left(l, i);
            self.add_right(r, i);
            (before_l, before_r) = (l, r);
            i += 1;
        }
        let tip = (before_l + before_r) / 2.0;
        self.result(Exit::End, course.end + 1, tip, course.end as f64)
    }

    fn start(&mut self, window: &Window) {
        self.l.clear();
        self.r.clear();
        self.l.push(window.l);
        self.r.push(window.r);
        (self.l_at, self.r_at) = (0, 0);
        self.hi = (window.r, window.l - window.r);
        self.lo = (window.l, window.r - window.l);
        (self.hi_contact, self.lo_contact) = (window.after, window.after);
        match window.contact {
            Bank::Left => self.lo_contact = window.next,
            Bank::Right => self.hi_contact = window.next,
        }
    }

    fn result(&self, exit: Exit, stop: usize, tip: Vec2, reach: f64) -> View {
        let contact = match exit {
            Exit::Through(Bank::Right) => self.hi_contact,
            Exit::Through(Bank::Left) => self.lo_contact,
            Exit::End => stop,
        };
        let wedge = (self.lo.1, self.hi.1);
        View { exit, lo: self.lo, hi: self.hi, wedge, contact: contact.min(stop - 1), stop, tip, reach }
    }

    /// A left end: the counter-clockwise line may have to sink to it.
    fn add_left(&mut self, p: Vec2, i: usize) {
        let turn = cross(self.hi.1, p - self.hi.0);
        if turn < 0.0 || self.hi.1 == Vec2::zeros() {
            while self.r_at + 1 < self.r.len()
                && cross(p - self.r[self.r_at], self.r[self.r_at + 1] - self.r[self.r_at]) > 0.0
            {
                self.r_at += 1;
            }
            self.hi = (self.r[self.r_at], p - self.r[self.r_at]);
        }
        if turn <= 0.0 {
            self.hi_contact = i;
        }
        while self.l.len() > self.l_at + 1 {
            let n = self.l.len();
            if cross(self.l[n - 1] - self.l[n - 2], p - self.l[n - 1]) > 0.0 {
                break;
            }
            self.l.pop();
        }
        self.l.push(p);
    }

    /// A right end: the clockwise line may have to rise to it.
    fn add_right(&mut self, p: Vec2, i: usize) {
        let turn = cross(self.lo.1, p - self.lo.0);
        if turn > 0.0 || self.lo.1 == Vec2::zeros() {
            while self.l_at + 1 < self.l.len()
                && cross(p - self.l[self.l_at], self.l[self.l_at + 1] - self.l[self.l_at]) < 0.0
            {
                self.l_at += 1;
            }
            self.lo = (self.l[self.l_at], p - self.l[self.l_at]);
        }
        if turn >= 0.0 {
            self.lo_contact = i;
        }
        while self.r.len() > self.r_at + 1 {
            let n = self.r.len();
            if cross(self.r[n - 1] - self.r[n - 2], p - self.r[n - 1]) < 0.0 {
                break;
            }
            self.r.pop();
        }
        self.r.push(p);
    }
}
