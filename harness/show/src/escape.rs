//! Text inside markup.

/// Text as it stands in HTML and SVG, between tags and inside quoted attributes. Control characters, which XML does not
/// allow, become the replacement character.
pub(crate) fn html(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if c.is_control() && c != '\n' && c != '\t' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// At most so many characters; what is cut away ends in an ellipsis.
pub(crate) fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let kept: String = text.chars().take(most.saturating_sub(1)).collect();
    format!("{}…", kept.trim_end())
}

/// Words in lines of at most so many characters; a longer word stands alone in its line.
pub(crate) fn lines(text: &str, most: usize) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    let mut used = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        match out.last_mut() {
            Some(line) if used + 1 + length <= most => {
                line.push(' ');
                line.push_str(word);
                used += 1 + length;
            }
            _ => {
                out.push(word.to_owned());
                used = length;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_escaped() {
        assert_eq!(
            html("a<b>&\"'|\u{1b}\n"),
            "a&lt;b&gt;&amp;&quot;&#39;|\u{fffd}\n"
        );
    }

    #[test]
    fn words_are_cut_and_wrapped() {
        assert_eq!(cut("abcdef", 6), "abcdef");
        assert_eq!(cut("abcdefg", 6), "abcde…");
        assert_eq!(lines("one two  three", 7), ["one two", "three"]);
    }
}
