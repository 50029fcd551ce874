//! Dwells, stops and tool changes: where they were asked for, and nowhere else.

use super::finding::{Finding, Text};
use super::holes::DWELL_TOLERANCE;
use super::{Case, Happening};
use crate::cl::RecordKind;
use crate::diag::codes::verification as codes;
use crate::readback::EventKind;
use crate::target::BlockKind;

/// Checks everything that happens beside moves.
pub(super) fn all(case: &Case<'_>) -> Vec<Finding> {
    let mut findings = asked(case);
    findings.extend(case.happenings.iter().filter_map(|h| unasked(case, h)));
    findings
}

/// What the CL data asks for happens.
fn asked(case: &Case<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (index, record) in case.cl.records.iter().enumerate() {
        let happenings = case.of_record(index);
        let text = match &record.kind {
            RecordKind::Dwell(seconds) => dwell(*seconds, happenings),
            RecordKind::Stop => stop(false, happenings),
            RecordKind::OptionalStop => {
                // The end of a cycle may stand before it.
                let mut lowered = case.blocks_of_record(index);
                stop(lowered.any(|(_, b)| matches!(b.kind, BlockKind::OptionalStop)), happenings)
            }
            _ => None,
        };
        if let Some(text) = text {
            let line = happenings.first().map_or(0, |h| h.line);
            findings.push(Finding::new(&codes::NOT_AS_LOWERED, line, case.block_of_record(index), text));
        }
    }
    findings
}

fn dwell(wanted: f64, happenings: &[Happening<'_>]) -> Option<Text> {
    let seconds = |h: &Happening<'_>| if let EventKind::Dwell(s) = h.kind { Some(*s) } else { None };
    let got: f64 = happenings.iter().filter_map(seconds).sum();
    let fits = (got - wanted).abs() <= DWELL_TOLERANCE;
    (!fits).then(|| Text::default().words(format!("a dwell of {got:.3} s in place of {wanted:.3} s")))
}

fn stop(optional: bool, happenings: &[Happening<'_>]) -> Option<Text> {
    let fits = |h: &Happening<'_>| matches!(h.kind, EventKind::Stop { optional: got } if *got == optional);
    let name = if optional { "an optional stop" } else { "a stop" };
    (!happenings.iter().any(fits)).then(|| Text::default().words(format!("{name} that does not happen")))
}

/// What happens in a block that has nothing to do with it.
fn unasked(case: &Case<'_>, happening: &Happening<'_>) -> Option<Finding> {
    let block = happening.block.and_then(|b| case.target.blocks.get(b)).map(|b| &b.kind);
    if let Some(BlockKind::Insert(_)) = block {
        return None;
    }
    let text = match (happening.kind, block) {
        (EventKind::Dwell(_), Some(BlockKind::Dwell(_) | BlockKind::Hole(_))) => return None,
        // A spindle may be given time to reach its speed.
        (EventKind::Dwell(_), Some(BlockKind::Spindle(_) | BlockKind::Begin | BlockKind::ToolChange(_))) => {
            return None;
        }
        (EventKind::Dwell(s), _) => format!("a dwell of {s:.3} s that nothing asks for"),
        (EventKind::ToolChange(got), Some(BlockKind::ToolChange(tool))) => {
            let number = case.target.tools.get(*tool as usize).and_then(|t| t.number)?;
            if number == *got {
                return None;
            }
            format!("tool {got} is changed in, in place of {number}")
        }
        (EventKind::ToolChange(got), _) => format!("a change to tool {got} that nothing asks for"),
        (
            EventKind::Stop { .. },
            Some(BlockKind::Stop | BlockKind::OptionalStop | BlockKind::ToolChange(_)),
        ) => {
            return None;
        }
        (EventKind::Stop { .. }, _) => "a stop that nothing asks for".to_owned(),
        (EventKind::End, Some(BlockKind::End)) | (EventKind::Move(_), _) => return None,
        (EventKind::End, _) => "the program ends before its last block".to_owned(),
    };
    let text = Text::default().words(text);
    Some(Finding::new(&codes::NOT_AS_LOWERED, happening.line, happening.block, text))
}
