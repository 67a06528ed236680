//! How results are shown: timing diagrams as text and SVG, graphs as pictures, documents as HTML and Markdown.
//!
//! Knows nothing of specifications, exploration or drives; others fill in these types. Equal values give equal bytes.

pub mod diagram;
pub mod document;
mod escape;
pub mod graph;
mod number;
mod svg;
