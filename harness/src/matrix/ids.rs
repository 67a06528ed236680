//! The ids of requirements in a text.

use std::collections::BTreeSet;

/// The requirements that a text names, each by its id, `PREFIX-AREA-123` with a prefix of the catalogues and exactly three
/// digits, or by one of its sentences, `PREFIX-AREA-123/a`.
pub(super) fn ids(text: &str, prefixes: &BTreeSet<String>) -> Vec<String> {
    let part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '/');
    let mut out = Vec::new();
    for word in text.split(|c: char| !part(c)) {
        let mut pieces = word.split('/').peekable();
        while let Some(piece) = pieces.next() {
            if !is_id(piece, prefixes) {
                continue;
            }
            if pieces.peek().is_none_or(|next| !is_sentence(next)) {
                out.push(piece.to_owned());
            }
            while let Some(sentence) = pieces.next_if(|next| is_sentence(next)) {
                out.push(format!("{piece}/{sentence}"));
            }
        }
    }
    out
}

/// The name of a sentence: a small letter, then small letters and digits.
pub(super) fn is_sentence(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
}

fn is_id(word: &str, prefixes: &BTreeSet<String>) -> bool {
    let parts: Vec<&str> = word.split('-').collect();
    let [prefix, area, number] = parts.as_slice() else {
        return false;
    };
    prefixes.contains(*prefix)
        && area.starts_with(|c: char| c.is_ascii_uppercase())
        && area
            .chars()
            .all(|c| c.is_ascii_uppercase() || c.is_ascii_digit())
        && number.len() == 3
        && number.chars().all(|c| c.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_whole_words_of_known_prefixes() {
        let prefixes = BTreeSet::from(["F".to_owned()]);
        let text = "(F-STOP-001), `F-A2-123`: F-P-05 F-STOP-0012 X-STOP-001 F-STOP-001-X aF-STOP-001 F-STOP-002.";
        assert_eq!(
            ids(text, &prefixes),
            ["F-STOP-001", "F-A2-123", "F-STOP-002"]
        );
    }

    #[test]
    fn a_sentence_is_named_behind_a_slash() {
        let prefixes = BTreeSet::from(["F".to_owned()]);
        assert_eq!(
            ids(
                "F-A-001/b, F-A-002/c2/d; F-A-003/F-A-004 F-A-005/B",
                &prefixes
            ),
            [
                "F-A-001/b",
                "F-A-002/c2",
                "F-A-002/d",
                "F-A-003",
                "F-A-004",
                "F-A-005"
            ]
        );
    }
}
