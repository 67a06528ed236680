//! Documents: blocks of text, tables and figures, to be written as one HTML page or as Markdown.

mod html;
mod make;
mod markdown;

use crate::diagram::Diagram;
use crate::graph::Graph;

/// A document.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    /// Its title.
    pub title: String,
    /// One line under the title; may be empty.
    pub subtitle: String,
    /// Its blocks.
    pub blocks: Vec<Block>,
}

/// A piece of a document.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A part with a heading.
    Section {
        /// The heading.
        title: String,
        /// What a link names; unique in the document.
        anchor: String,
        /// What the part consists of.
        blocks: Vec<Block>,
    },
    /// Running text.
    Paragraph(Vec<Inline>),
    /// Points.
    List(Vec<Vec<Inline>>),
    /// The result, large.
    Verdict {
        /// Good, bad or open.
        tone: Tone,
        /// The result in a few words.
        head: String,
        /// One or two sentences about it.
        text: Vec<Inline>,
    },
    /// Few large figures side by side: (value, what it counts).
    Figures(Vec<(String, String)>),
    /// A table.
    Table(Table),
    /// A timing diagram.
    Timing(Box<Diagram>),
    /// A picture of a graph.
    Graph(Box<Graph>),
    /// Text with its line breaks.
    Preformatted(String),
    /// Shown only when it is opened; printed open.
    Details {
        /// What is always shown.
        summary: Vec<Inline>,
        /// What is folded away.
        blocks: Vec<Block>,
    },
}

/// A piece of running text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Inline {
    /// Words.
    Text(String),
    /// A name or an expression as it stands in a file.
    Code(String),
    /// A name that is never broken at the end of a line.
    Name(String),
    /// Words that matter.
    Strong(String),
    /// A word on a coloured ground.
    Badge(Tone, String),
    /// A reference to an anchor (`#...`) of the document or to an address.
    Link {
        /// The words.
        text: String,
        /// Where it leads.
        to: String,
    },
    /// A place to be filled in by hand on paper, so many characters wide.
    Blank(u16),
}

/// How something is to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// As it should be.
    Good,
    /// A fault.
    Bad,
    /// Not decided, or to be looked at.
    Open,
    /// Neither.
    Plain,
}

/// A table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Table {
    /// What it shows; may be empty.
    pub caption: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows, each with a cell for each column.
    pub rows: Vec<Vec<Vec<Inline>>>,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Its heading.
    pub title: String,
    /// Numbers: set to the right.
    pub number: bool,
}
