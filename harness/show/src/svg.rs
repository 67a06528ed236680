//! What diagrams and graphs share as SVG.

use std::fmt::Write;

use crate::escape::html;

/// The rules of all pictures; a page states them once, a picture that stands alone carries them.
pub(crate) const STYLE: &str = include_str!("svg.css");

/// A picture of a size, in pixels, named for those who cannot see it.
pub(crate) fn picture(size: (i32, i32), name: &str, standalone: bool, body: &str) -> String {
    let (width, height) = size;
    let mut out = String::new();
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"sp\" role=\"img\" aria-label=\"{}\" width=\"{width}\" \
         height=\"{height}\" viewBox=\"0 0 {width} {height}\" style=\"--width: {width}px\">",
        html(name)
    );
    if standalone {
        let _ = writeln!(out, "<style>\n{STYLE}</style>");
        let _ = writeln!(
            out,
            "<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>"
        );
    }
    out.push_str(body);
    out.push_str("</svg>\n");
    out
}

/// A line of text at its left end, middle (`mid`) or right end (`end`), by its class.
pub(crate) fn text(out: &mut String, x: i32, y: i32, class: &str, words: &str) {
    let _ = writeln!(
        out,
        "<text x=\"{x}\" y=\"{y}\" class=\"{class}\">{}</text>",
        html(words)
    );
}

/// A rectangle.
pub(crate) fn rect(out: &mut String, (x, y): (i32, i32), (width, height): (i32, i32), class: &str) {
    let _ = writeln!(
        out,
        "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" class=\"{class}\"/>"
    );
}

/// A path.
pub(crate) fn path(out: &mut String, class: &str, d: &str) {
    if !d.is_empty() {
        let _ = writeln!(out, "<path class=\"{class}\" d=\"{}\"/>", d.trim_end());
    }
}
