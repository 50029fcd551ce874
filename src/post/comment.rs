//! Comments: texts of the user made harmless.
//!
//! Whatever the text is, what is printed between the delimiters holds only characters that the control allows
//! in a comment, never a delimiter, `%` or a line end, and does not start with a word that the control obeys.

use serde::Deserialize;

/// How a control writes comments.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Comments {
    /// Before the text; empty: the control has no comments.
    pub open: String,
    /// After the text.
    pub close: String,
    /// Characters besides ASCII letters, digits and space.
    pub allowed: String,
    /// Letters in upper case.
    pub upper_case: bool,
    /// Stands for a character that is not allowed.
    pub replace: String,
    /// Longest text in one comment, 0 without limit.
    pub max_length: usize,
    /// Words that the control obeys at the start of a comment.
    pub active_words: Vec<String>,
}

impl Comments {
    /// The text with only allowed characters, on one line, whatever its length.
    #[must_use]
    pub fn clean(&self, text: &str) -> String {
        let mut out = String::with_capacity(text.len());
        for c in text.chars() {
            self.push_clean(&mut out, c);
        }
        let out = out.trim();
        if self.is_active(out) { format!("- {out}") } else { out.to_owned() }
    }

    fn push_clean(&self, out: &mut String, c: char) {
        let plain = transliterate(c);
        if !plain.is_empty() {
            plain.chars().for_each(|p| self.push_clean(out, p));
        } else if c.is_ascii_alphanumeric() {
            out.push(if self.upper_case { c.to_ascii_uppercase() } else { c });
        } else if c == ' ' || c == '\t' {
            out.push(' ');
        } else if c.is_control() {
            // A line end parts words, `\r\n` only once.
            if !out.ends_with(' ') {
                out.push(' ');
            }
        } else if self.is_allowed(c) {
            out.push(c);
        } else {
            out.push_str(&self.replace);
        }
    }

    /// Whether a comment may hold the character without ending there.
    #[must_use]
    pub fn may_hold(&self, c: char) -> bool {
        c.is_ascii_alphanumeric()
            || c == ' '
            || (c.is_ascii_graphic() && c != '%' && !self.open.contains(c) && !self.close.contains(c))
    }

    /// A delimiter, `%` or a control character is never allowed, whatever a post file says.
    fn is_allowed(&self, c: char) -> bool {
        self.allowed.contains(c) && self.may_hold(c)
    }

    fn is_active(&self, text: &str) -> bool {
        self.active_words
            .iter()
            .any(|word| text.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word)))
    }

    /// The text as comments, each within `max-length`, without line ends; none when there is no text or the
    /// control has no comments.
    #[must_use]
    pub fn lines(&self, text: &str) -> Vec<String> {
        let text = self.clean(text);
        if self.open.is_empty() || text.is_empty() {
            return Vec::new();
        }
        let limit = if self.max_length == 0 { usize::MAX } else { self.max_length };
        // Continuation lines are cleaned again: a word that was harmless inside may be active at the start.
        wrap(&text, limit.saturating_sub(2).max(1))
            .into_iter()
            .map(|part| format!("{}{}{}", self.open, self.clean(part), self.close))
            .collect()
    }
}

/// Cuts at spaces where possible, so that no part is longer than `limit` characters; the text is ASCII.
fn wrap(mut text: &str, limit: usize) -> Vec<&str> {
    let mut parts = Vec::new();
    while text.len() > limit {
        let cut = match text[..=limit].rfind(' ') {
            Some(space) if space > 0 => space,
            _ => limit,
        };
        parts.push(text[..cut].trim_end());
        text = text[cut..].trim_start();
    }
    if !text.is_empty() {
        parts.push(text);
    }
    parts
}

/// ASCII spelling of common letters outside ASCII; empty where there is none.
fn transliterate(c: char) -> &'static str {
    match c {
        'ä' | 'æ' => "ae",
        'ö' | 'ø' | 'œ' => "oe",
        'ü' => "ue",
        'Ä' | 'Æ' => "AE",
        'Ö' | 'Ø' | 'Œ' => "OE",
        'Ü' => "UE",
        'ß' => "ss",
        'à' | 'á' | 'â' | 'ã' | 'å' => "a",
        'ç' => "c",
        'è' | 'é' | 'ê' | 'ë' => "e",
        'ì' | 'í' | 'î' | 'ï' => "i",
        'ñ' => "n",
        'ò' | 'ó' | 'ô' | 'õ' => "o",
        'ù' | 'ú' | 'û' => "u",
        '–' | '—' | '−' => "-",
        '×' => "x",
        '°' => "deg",
        'µ' | 'μ' => "u",
        '‘' | '’' => "'",
        '“' | '”' => "\"",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rules() -> Comments {
        Comments {
            open: "(".into(),
            close: ")".into(),
            allowed: ".,=_-+/:()%".into(),
            upper_case: false,
            replace: "_".into(),
            max_length: 40,
            active_words: ["MSG", "DEBUG"].map(String::from).to_vec(),
        }
    }

    #[test]
    fn text_cannot_leave_its_comment() {
        assert_eq!(rules().lines("a) G0 X0 (b\n%\r\0M30"), ["(a_ G0 X0 _b _ M30)"]);
    }
    #[test]
    fn active_words_are_disarmed_also_where_a_long_text_is_wrapped() {
        assert_eq!(rules().lines(" msg, hello"), ["(- msg, hello)"]);
        let long = "this text is long enough to be cut here DEBUG, 1";
        assert_eq!(rules().lines(long), ["(this text is long enough to be cut)", "(here DEBUG, 1)"]);
        let unlucky = "this text is long enough to be cutX DEBUG, 1";
        assert_eq!(rules().lines(unlucky), ["(this text is long enough to be cutX)", "(- DEBUG, 1)"]);
    }
    #[test]
    fn letters_outside_ascii_keep_a_reading() {
        assert_eq!(rules().lines("Nocken Ø40 für Öl, 0°"), ["(Nocken OE40 fuer OEl, 0deg)"]);
        assert_eq!(rules().clean("凸轮"), "__");
    }
    #[test]
    fn a_word_longer_than_a_comment_is_cut() {
        let parts = rules().lines(&"x".repeat(100));
        assert_eq!(parts.iter().map(String::len).collect::<Vec<_>>(), [40, 40, 26]);
    }
    proptest! {
        #[test]
        fn no_text_escapes(text in "\\PC*|[()%;\n\r A-Z]*") {
            for line in rules().lines(&text) {
                let inner = line.strip_prefix('(').and_then(|l| l.strip_suffix(')')).unwrap();
                prop_assert!(inner.len() <= 40);
                prop_assert!(inner.bytes().all(|b| (b' '..=b'~').contains(&b) && !b"()%".contains(&b)));
                prop_assert!(!inner.to_uppercase().starts_with("MSG") && !inner.to_uppercase().starts_with("DEBUG"));
            }
        }
    }
}
