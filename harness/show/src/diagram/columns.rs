//! Which columns are drawn: stretches in which nothing new happens are gathered into one.

use super::{Diagram, Lane};

/// A column as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Column {
    /// A column of the diagram.
    Cycle(usize),
    /// So many columns from the first one on, in which every signal stays or goes on counting.
    Idle { first: usize, count: usize },
    /// So many columns that are left out because there would be too many.
    Cut { first: usize, count: usize },
}

impl Column {
    /// How many columns of the diagram it stands for.
    pub(super) fn count(self) -> usize {
        match self {
            Column::Cycle(_) => 1,
            Column::Idle { count, .. } | Column::Cut { count, .. } => count,
        }
    }

    /// Whether it stands for this column of the diagram.
    pub(super) fn holds(self, k: usize) -> bool {
        (self.first()..self.first() + self.count()).contains(&k)
    }

    /// The first column of the diagram that it stands for.
    pub(super) fn first(self) -> usize {
        match self {
            Column::Cycle(k) => k,
            Column::Idle { first, .. } | Column::Cut { first, .. } => first,
        }
    }
}

impl Diagram {
    /// The columns drawn. A stretch is gathered from `least` columns on; beyond `most` columns the middle is cut out.
    pub(super) fn drawn(&self, least: usize, most: usize) -> Vec<Column> {
        let counts: Vec<Vec<Option<i64>>> = self.lanes.iter().map(Lane::numbers).collect();
        let steady = |k: usize| {
            let lanes = self.lanes.iter().zip(&counts);
            let mut curves = self.panels.iter().flat_map(|p| &p.curves);
            let same = |a: usize, b: usize, values: &[Option<f64>]| values.get(a) == values.get(b);
            lanes.into_iter().all(|(lane, counts)| {
                lane.same(k - 1, k) && lane.same(k, k + 1) || counting(counts, k)
            }) && curves.all(|c| same(k - 1, k, &c.values) && same(k, k + 1, &c.values))
        };
        let marked =
            |k: usize| self.marks.iter().any(|m| m.column == k) || self.loop_start == Some(k);
        let mut out: Vec<Column> = Vec::new();
        let mut k = 0;
        while k < self.columns {
            let idle = |k: usize| k > 1 && k + 1 < self.columns && !marked(k) && steady(k);
            let count = (k..self.columns).take_while(|k| idle(*k)).count();
            if count >= least.max(1) {
                out.push(Column::Idle { first: k, count });
                k += count;
            } else {
                let count = count.max(1);
                out.extend((k..k + count).map(Column::Cycle));
                k += count;
            }
        }
        if out.len() > most {
            let half = most / 2;
            let gone = half..half + out.len() - most + 1;
            let first = out[half].first();
            let count = out[gone.clone()].iter().map(|c| c.count()).sum();
            out.splice(gone, [Column::Cut { first, count }]);
        }
        out
    }
}

/// Whether a number goes on counting by the same step before and after a column.
fn counting(values: &[Option<i64>], k: usize) -> bool {
    let at = |k: usize| values.get(k).copied().flatten();
    match (at(k - 1), at(k), at(k + 1)) {
        (Some(a), Some(b), Some(c)) => b.checked_sub(a) == c.checked_sub(b),
        _ => false,
    }
}

impl Lane {
    /// Whether two columns show the same.
    pub(super) fn same(&self, a: usize, b: usize) -> bool {
        self.values.get(a) == self.values.get(b)
    }

    /// What a column shows.
    pub(super) fn at(&self, k: usize) -> Option<&str> {
        self.values.get(k).and_then(Option::as_deref)
    }

    fn numbers(&self) -> Vec<Option<i64>> {
        let number = |v: &Option<String>| v.as_ref().and_then(|v| v.parse().ok());
        self.values.iter().map(number).collect()
    }
}
