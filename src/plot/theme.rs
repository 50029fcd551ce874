//! Colours and type of all pictures.

use super::canvas::{Anchor, Pen, Type};

pub(super) const INK: &str = "#1b2733";
pub(super) const MUTED: &str = "#5f6f7e";
pub(super) const HAIR: &str = "#e3e8ed";
pub(super) const FRAME: &str = "#b4bfca";
pub(super) const PART: &str = "#dfe9f5";
pub(super) const PROFILE: &str = "#0b4a8f";
pub(super) const PITCH: &str = "#7d8b99";
pub(super) const FOLLOWER: &str = "#c2570c";
pub(super) const PATH: &str = "#1f7a4d";
pub(super) const ROUGH: &str = "#6f97c4";
pub(super) const RAPID: &str = "#c92a2a";
pub(super) const LEAD: &str = "#d9820a";
pub(super) const LIMIT: &str = "#c92a2a";
pub(super) const ENTRY: &str = "#8250c4";
pub(super) const STOCK: &str = "#9a7b4f";

pub(super) const GRID: Pen = Pen::solid(HAIR, 1.0);
pub(super) const AXIS: Pen = Pen::solid(FRAME, 1.0);

pub(super) const fn text(size: f64, color: &'static str, anchor: Anchor) -> Type {
    Type { size, color, anchor }
}

pub(super) const TITLE: Type = text(26.0, INK, Anchor::Start);
pub(super) const SUBTITLE: Type = text(15.0, MUTED, Anchor::Start);
pub(super) const TICK: Type = text(12.0, MUTED, Anchor::End);
