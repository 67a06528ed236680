//! Timing diagrams: signals over cycles.

mod columns;
mod panel;
mod svg;
mod text;

/// Signals over cycles. Column 0 is the initial state, column k the k-th cycle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Diagram {
    /// What it shows; may be empty.
    pub title: String,
    /// Number of columns.
    pub columns: usize,
    /// The length of a cycle in microseconds, if it is known.
    pub cycle: Option<u64>,
    /// Quantities against their limits.
    pub panels: Vec<Panel>,
    /// Booleans and values.
    pub lanes: Vec<Lane>,
    /// Remarks at columns.
    pub marks: Vec<Mark>,
    /// Column from which the run repeats for ever.
    pub loop_start: Option<usize>,
}

/// A signal over the cycles of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lane {
    /// Heading under which it stands.
    pub group: String,
    /// Name.
    pub name: String,
    /// Drawn as a level (`TRUE`, `FALSE`) instead of a value.
    pub level: bool,
    /// The value in each column; none where nothing read it, so that it may have any.
    pub values: Vec<Option<String>>,
}

/// Quantities of one unit on common axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Name, such as `speed of X`.
    pub name: String,
    /// Unit, such as `mm/min`.
    pub unit: String,
    /// Its curves.
    pub curves: Vec<Curve>,
}

/// A quantity over the cycles of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name.
    pub name: String,
    /// How it is drawn.
    pub role: Role,
    /// The value in each column; none where there is none, as for a limit that is not monitored.
    pub values: Vec<Option<f64>>,
}

/// What a curve stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// What is measured: a line.
    Actual,
    /// What is wanted: a thin line.
    Wanted,
    /// What is monitored: a dashed line in steps, with the forbidden side shaded where there is room.
    Upper,
    /// Like `Upper`, for a least value.
    Lower,
}

/// A remark at a column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mark {
    /// The column.
    pub column: usize,
    /// What happens there.
    pub text: String,
    /// A property breaks or two sides part here, not just a remark.
    pub fault: bool,
}
