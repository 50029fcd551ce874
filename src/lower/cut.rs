//! Contours: approach, lead in, the fitted chain, lead out, retract.

use super::arc::{Legal, centre_per_linear, legalise};
use super::contour::Fitted;
use super::emit::Emitter;
use super::fit::{Fit, Primitive};
use super::lead::{self, End, LeadPath, Ways};
use super::{feed, path, rotary};
use crate::cl::{Contour, Lead};
use crate::diag::codes;
use crate::geom::Vec2;
use crate::ir::Interpolation;
use crate::target::{FeedWord, GridArc, Motion, Nurbs, Piece, PieceId, Plane, Position, axes};

impl Emitter<'_> {
    /// All levels of a contour.
    pub(super) fn contour(&mut self, contour: &Contour, fitted: &Fitted) {
        for &z in &contour.levels {
            let level = self.linear(z);
            if fitted.interpolation == Interpolation::RTheta {
                self.polar_level(contour, fitted, z, level);
            } else {
                self.level(contour, fitted, z, level);
            }
        }
    }

    fn level(&mut self, contour: &Contour, fitted: &Fitted, z: f64, level: i64) {
        let fit = &fitted.fit;
        let (entry, exit) = self.leads(contour, fit);
        let turn = self.cartesian_turn();
        let [x, y] = entry.map_or(fit.start, |l| l.far);
        let above = Position { x, y, z: level, r: turn };
        if contour.entry == Lead::None {
            let feed = self.linear_feed();
            self.line(above, feed);
        } else {
            self.compensating.held = entry.as_ref().is_some_and(|lead| lead.arc.is_none());
            self.descend(contour, above);
            self.compensating.held = false;
        }
        let feed = self.linear_feed();
        if let Some(entry) = entry {
            self.lead(&entry, Position { x: fit.start[0], y: fit.start[1], z: level, r: turn }, feed);
        }
        self.chain(
            contour,
            fitted,
            z,
            Position { x: fit.start[0], y: fit.start[1], z: level, r: turn },
            feed,
        );
        if let Some(exit) = exit {
            self.lead(&exit, Position { x: exit.far[0], y: exit.far[1], z: level, r: turn }, feed);
        }
        self.retract(contour);
    }

    /// Over the point at rapid, down to the approach height at rapid, down to the level at feed.
    fn descend(&mut self, contour: &Contour, point: Position) {
        let clearance = self.linear(contour.clearance);
        let approach = self.linear(contour.approach.min(contour.clearance));
        self.rapid(Position { z: clearance.max(point.z), ..point });
        self.rapid_axes(Position { z: approach.max(point.z), ..point }, axes::Z);
        let plunge = self.plunge_feed(contour);
        self.line(point, plunge);
    }

    fn retract(&mut self, contour: &Contour) {
        if contour.exit != Lead::None {
            let to = Position { z: self.linear(contour.clearance), ..self.here() };
            self.rapid_axes(to, axes::Z);
        }
    }

    fn lead(&mut self, path: &LeadPath, to: Position, feed: FeedWord) {
        let here = self.here();
        let from = [here.x, here.y];
        let Some((centre, clockwise)) = path.arc else { return self.line(to, feed) };
        if !self.capabilities.arcs {
            for [x, y] in lead::chords(path, from, [to.x, to.y]) {
                self.line(Position { x, y, ..to }, feed);
            }
            return;
        }
        let scale = centre_per_linear(self.capabilities);
        let arc = GridArc { start: from, to: [to.x, to.y], centre: centre.map(|v| v * scale), clockwise };
        self.arc(arc, to, feed);
    }

    /// The leads at both ends of a fitted chain.
    fn leads(&mut self, contour: &Contour, fit: &Fit) -> (Option<LeadPath>, Option<LeadPath>) {
        let asked = |lead: Lead| !matches!(lead, Lead::None | Lead::Plunge);
        if !asked(contour.entry) && !asked(contour.exit) {
            return (None, None);
        }
        let scale = centre_per_linear(self.capabilities);
        let ways = Ways::new(contour, self.capabilities.grid.linear_step());
        // The corner between a chord and the next is no tangent to follow.
        let smooth = |p: Option<&Primitive>| p.is_some_and(|p| !matches!(p, Primitive::Line { .. }));
        let first = path::start_tangent(fit, scale).filter(|_| smooth(fit.primitives.first()));
        let last = path::end_tangent(fit, scale).filter(|_| smooth(fit.primitives.last()));
        let entry = ways.lead(End::Entry, fit.start, first);
        let exit = ways.lead(End::Exit, path::last_end(fit), last);
        if asked(contour.entry) && entry.is_none() || asked(contour.exit) && exit.is_none() {
            let message = "every tangent lead touches the part: the cutter goes straight down or up there";
            self.complain(&codes::planning::NO_ROOM_FOR_LEAD, message.into());
        }
        (entry, exit)
    }

    fn arrive(&mut self, to: Position) {
        self.at = [to.x, to.y, to.z, to.r].map(Some);
    }

    /// The exact piece that the next motions stand for.
    fn begin_piece(&mut self, contour: &Contour, fitted: &Fitted, z: f64) -> usize {
        let index = self.pieces.len();
        self.pieces.push(Piece {
            operation: self.operation,
            curve: contour.curve.clone(),
            part: contour.part,
            band: contour.band,
            lower_bound: fitted.fit.lower_bound,
            blocks: 0,
            interpolation: fitted.interpolation,
            z,
            reserved: fitted.reserved,
        });
        self.piece = Some(PieceId(u32::try_from(index).unwrap_or(u32::MAX)));
        self.blocks.len()
    }

    fn end_piece(&mut self, first_block: usize) {
        self.piece = None;
        let blocks = u32::try_from(self.blocks.len() - first_block).unwrap_or(u32::MAX);
        if let Some(piece) = self.pieces.last_mut() {
            piece.blocks = blocks;
        }
    }

    /// The fitted chain at the height and table position of `start`.
    fn chain(&mut self, contour: &Contour, fitted: &Fitted, z: f64, start: Position, feed: FeedWord) {
        let first = self.begin_piece(contour, fitted, z);
        let mut from = start;
        for primitive in &fitted.fit.primitives {
            let Some([x, y]) = path::end(primitive) else { continue };
            let to = Position { x, y, ..from };
            match primitive {
                Primitive::Line { .. } | Primitive::Spiral { .. } => self.line(to, feed),
                Primitive::Arc { centre, clockwise, .. } => {
                    let arc = GridArc {
                        start: [from.x, from.y],
                        to: [x, y],
                        centre: *centre,
                        clockwise: *clockwise,
                    };
                    self.arc(arc, from, feed);
                }
                Primitive::Nurbs { points, pieces: Some(finer), .. } => {
                    let pieces = super::pieces::of_fitted(points, from, *finer);
                    pieces.into_iter().for_each(|piece| self.curve(piece, feed));
                }
                Primitive::Nurbs { order, points, knots, pieces: None } => {
                    let points = points.iter().map(|&([x, y], w)| (Position { x, y, ..from }, w)).collect();
                    self.curve(Nurbs { order: *order, points, knots: knots.clone(), finer: 0 }, feed);
                }
            }
            self.arrive(to);
            from = to;
        }
        self.end_piece(first);
    }

    fn arc(&mut self, arc: GridArc, from: Position, feed: FeedWord) {
        match legalise(arc, Plane::Xy, self.capabilities) {
            Ok(parts) => parts.into_iter().for_each(|part| self.legal(part, from, feed)),
            Err(mismatch) => {
                let (r0, r1) = mismatch.radii;
                let message = format!(
                    "an arc's radius is {r0:.4} mm at its start and {r1:.4} mm at its end in printed numbers; controls accept {} mm",
                    self.capabilities.radius_tolerance
                );
                self.complain(&codes::lowering::CANNOT_FIT, message);
            }
        }
    }

    fn legal(&mut self, part: Legal, from: Position, feed: FeedWord) {
        match part {
            Legal::Line([x, y]) => self.line(Position { x, y, ..from }, feed),
            Legal::Arc(arc @ GridArc { to: [x, y], centre, clockwise, .. }) => {
                self.check_bulge(&arc);
                let to = Position { x, y, ..from };
                self.arrive(to);
                self.push(Motion::Arc { to, plane: Plane::Xy, centre, clockwise, feed });
            }
        }
    }

    fn curve(&mut self, nurbs: Nurbs, feed: FeedWord) {
        let curve = u32::try_from(self.nurbs.len()).unwrap_or(u32::MAX);
        nurbs.places().for_each(|p| self.check_plane([p.x as f64, p.y as f64]));
        if !super::pieces::fits(&nurbs, self.capabilities.ranges.coefficient) {
            let message = "the coefficients of a curve have more digits than their words take";
            self.complain(&codes::lowering::TOO_LARGE, message.into());
        }
        self.nurbs.push(nurbs);
        self.push(Motion::Nurbs { curve, feed });
    }

    /// One level in polar coordinates: X the radius, Y 0, the table the angle.
    fn polar_level(&mut self, contour: &Contour, fitted: &Fitted, z: f64, level: i64) {
        let grid = self.capabilities.grid;
        let fit = &fitted.fit;
        let sense = if self.capabilities.rotary.is_some_and(|r| r.reversed) { -1 } else { 1 };
        let here = self.at[3].unwrap_or(0) * sense;
        let angles = fit.primitives.iter().filter_map(path::end).map(|end| end[1]);
        let ends = angles.fold((fit.start[1], fit.start[1]), |(a, b), v| (a.min(v), b.max(v)));
        let shift = rotary::shift(fit.start[1], ends, here, self.capabilities.ranges.rotary, &grid);
        let place =
            |[radius, angle]: [i64; 2]| Position { x: radius, y: 0, z: level, r: (angle + shift) * sense };
        let start = place(fit.start);
        let end = place(path::last_end(fit));
        let entry = self.radial(contour.entry, contour, contour.curve.domain().0);
        let exit = self.radial(contour.exit, contour, contour.curve.domain().1);
        self.descend(contour, Position { x: start.x + entry, ..start });
        let feed = self.linear_feed();
        self.line(start, feed);
        let first = self.begin_piece(contour, fitted, z);
        let mut from = fit.start;
        for to in fit.primitives.iter().filter_map(path::end) {
            let step = rotary::spiral(from, to, &grid);
            let feed = self.polar_feed(&step);
            self.line(place(to), feed);
            from = to;
        }
        self.end_piece(first);
        let feed = self.linear_feed();
        self.line(Position { x: end.x + exit, ..end }, feed);
        self.retract(contour);
    }

    fn polar_feed(&mut self, step: &feed::PolarMove) -> FeedWord {
        let word =
            feed::per_minute(self.feed, self.rpm).and_then(|f| feed::polar(f, step, self.capabilities));
        match word {
            Ok(word) => word,
            Err(trouble) => self.feed_trouble(&trouble),
        }
    }

    /// Radial length of a lead in linear steps, away from the part; leads with the table still are radial.
    fn radial(&mut self, lead: Lead, contour: &Contour, u: f64) -> i64 {
        let length = match lead {
            Lead::None | Lead::Plunge => return 0,
            Lead::Arc(length) | Lead::Line(length) => length,
        };
        let message = "with the rotary axis a lead is radial: the table stands while the cutter moves in X";
        self.complain(&codes::lowering::RADIAL_LEAD, message.into());
        let frame = contour.curve.at(u);
        let away = frame.n() * -contour.part.sign();
        let outwards = away.dot(&Vec2::new(frame.p.x, frame.p.y)) > 0.0;
        let steps = self.linear(length);
        if outwards { steps } else { -steps }
    }
}
