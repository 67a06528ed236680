//! Numbers and lines as readers want them.

use std::fmt::Write;

/// Texts are wrapped at this width.
const WIDTH: usize = 100;

/// So many of a thing: `1 cycle`, `2 cycles`, `2 properties`.
pub fn counted(n: u64, thing: &str) -> String {
    match thing.strip_suffix('y') {
        _ if n == 1 => format!("1 {thing}"),
        Some(stem) => format!("{n} {stem}ies"),
        None => format!("{n} {thing}s"),
    }
}

/// A number with thin groups of three: `4 024 036`.
pub fn grouped(n: u128) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (k, d) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k) % 3 == 0 {
            out.push(' ');
        }
        out.push(d);
    }
    out
}

/// Words after a head, in lines of readable length, indented below the first word.
pub(crate) fn wrapped(out: &mut String, head: &str, text: &str) {
    let indent = head.chars().count().min(48);
    let mut line = head.to_owned();
    let mut used = line.chars().count();
    for word in text.split_whitespace() {
        let n = word.chars().count();
        if used + n + 1 > WIDTH && used > indent {
            let _ = writeln!(out, "{}", line.trim_end());
            line = " ".repeat(indent);
            used = indent;
        }
        if !line.ends_with(' ') {
            line.push(' ');
            used += 1;
        }
        line.push_str(word);
        used += n;
    }
    let _ = writeln!(out, "{}", line.trim_end());
}
