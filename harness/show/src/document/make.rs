//! Short ways to write down what documents are made of.

use super::{Block, Column, Inline, Table};

impl Inline {
    /// Words.
    pub fn text(words: impl Into<String>) -> Self {
        Self::Text(words.into())
    }

    /// A name or an expression as it stands in a file.
    pub fn code(name: impl Into<String>) -> Self {
        Self::Code(name.into())
    }

    fn is_empty(&self) -> bool {
        matches!(self, Self::Text(t) | Self::Code(t) if t.is_empty())
    }
}

impl Column {
    /// A column with this heading; one that begins with `#` stands over numbers.
    pub fn new(heading: &str) -> Self {
        Self {
            title: heading.trim_start_matches('#').to_owned(),
            number: heading.starts_with('#'),
        }
    }
}

impl Table {
    /// A table without a caption; the headings as in [`Column::new`].
    pub fn new(
        headings: &[impl AsRef<str>],
        rows: impl IntoIterator<Item = Vec<Vec<Inline>>>,
    ) -> Self {
        Self {
            caption: String::new(),
            columns: headings.iter().map(|h| Column::new(h.as_ref())).collect(),
            rows: rows.into_iter().collect(),
        }
    }

    /// The same with a caption.
    #[must_use]
    pub fn captioned(mut self, caption: &str) -> Self {
        caption.clone_into(&mut self.caption);
        self
    }

    /// The same without the columns that have nothing in any row.
    #[must_use]
    pub fn without_empty_columns(self) -> Self {
        let empty = |cell: &Vec<Inline>| cell.iter().all(Inline::is_empty);
        let used: Vec<bool> = (0..self.columns.len())
            .map(|k| {
                let mut rows = self.rows.iter();
                rows.any(|row| row.get(k).is_some_and(|cell| !empty(cell)))
            })
            .collect();
        Self {
            caption: self.caption,
            columns: kept(self.columns, &used),
            rows: self.rows.into_iter().map(|r| kept(r, &used)).collect(),
        }
    }
}

fn kept<T>(all: Vec<T>, used: &[bool]) -> Vec<T> {
    let with = all.into_iter().zip(used);
    with.filter(|(_, used)| **used)
        .map(|(one, _)| one)
        .collect()
}

impl Block {
    /// A table without a caption: see [`Table::new`].
    pub fn table(
        headings: &[impl AsRef<str>],
        rows: impl IntoIterator<Item = Vec<Vec<Inline>>>,
    ) -> Self {
        Table::new(headings, rows).into()
    }
}

impl From<Table> for Block {
    fn from(table: Table) -> Self {
        Self::Table(table)
    }
}
