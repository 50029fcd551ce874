//! Sources that were punched on cards: statements end at column 72.

/// The last column of a card that belongs to the statement.
const LAST_COLUMN: usize = 72;

/// The text with everything behind column 72 blank; no byte changes its place.
#[must_use]
pub(super) fn blank_card_columns(text: &str) -> String {
    let mut blanked = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let body = line.trim_end_matches(['\n', '\r']);
        let cut = body.char_indices().nth(LAST_COLUMN).map_or(body.len(), |(i, _)| i);
        let (kept, behind) = line.split_at(cut);
        let (behind, end) = behind.split_at(body.len() - cut);
        blanked.push_str(kept);
        blanked.extend(core::iter::repeat_n(' ', behind.len()));
        blanked.push_str(end);
    }
    blanked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_behind_column_72_is_blank_and_nothing_moves() {
        let statement = format!("{:<72}", "GOTO/ 1, 2, 3");
        let card = format!("{statement}00010\r\nFINI\n{statement}é");
        let blanked = blank_card_columns(&card);
        assert_eq!(blanked, format!("{statement}     \r\nFINI\n{statement}  "));
        assert_eq!(blanked.len(), card.len());
    }
}
