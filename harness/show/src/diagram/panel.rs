//! Quantities against their limits as curves.

use std::fmt::Write;

use super::svg::Row;
use super::{Curve, Panel, Role};
use crate::escape::cut;
use crate::number::ticks;
use crate::svg::{path, rect, text};

/// Height of a panel with the space below it.
pub(super) const HEIGHT: i32 = 118;
/// Height of the area with the curves.
const AREA: i32 = 96;

/// Width of the numbers of the axis, left of it.
pub(super) const NUMBERS: i32 = 56;

/// Whether a value has a place on an axis: what is larger is no quantity of a machine.
fn drawable(value: &f64) -> bool {
    value.abs() <= 1e12
}

/// The range of values of a panel.
pub(super) struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    /// The range that holds all values with some room, and zero if it is near; none without values.
    pub(super) fn of(panel: &Panel) -> Option<Self> {
        let values = panel.curves.iter().flat_map(|c| c.values.iter().flatten());
        let values = values.copied().filter(drawable);
        let (mut low, mut high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        });
        if low > high {
            return None;
        }
        if low > 0.0 && low < high / 2.0 {
            low = 0.0;
        }
        if high < 0.0 && high > low / 2.0 {
            high = 0.0;
        }
        let room = match high - low {
            span if span > 0.0 => span * 0.1,
            _ => high.abs().max(1.0) * 0.1,
        };
        Some(Self {
            low: low - room,
            high: high + room,
        })
    }

    /// Pixels below the top of the area.
    fn y(&self, value: f64) -> f64 {
        f64::from(AREA) * (self.high - value) / (self.high - self.low)
    }
}

impl Panel {
    pub(super) fn heading(&self) -> String {
        match self.unit.as_str() {
            "" => self.name.clone(),
            unit => format!("{} ({unit})", self.name),
        }
    }

    /// Draws the panel in a row, from `top` on.
    pub(super) fn draw(&self, out: &mut String, row: &Row, scale: Option<&Scale>, top: i32) {
        let top = top + 8;
        let most = usize::try_from((row.left() - NUMBERS) * 10 / 67).unwrap_or(8);
        text(out, 4, top + 6, "head", &cut(&self.heading(), most));
        let Some(scale) = scale else {
            return;
        };
        let mut grid = String::new();
        for (value, name) in ticks(scale.low, scale.high) {
            let y = pixel(scale.y(value)) + top;
            let _ = write!(grid, "M{} {y}H{}", row.left(), row.right());
            text(out, row.left() - 5, y + 4, "end dim", &name);
        }
        path(out, "grid", &grid);
        let mut actual = 0;
        for (n, curve) in self.curves.iter().enumerate() {
            let class = match curve.role {
                Role::Actual => {
                    actual += 1;
                    ["actual", "actual c1", "actual c2", "actual c3"][(actual - 1) % 4]
                }
                Role::Wanted => "wanted",
                Role::Upper | Role::Lower => "limit",
            };
            match curve.role {
                Role::Actual | Role::Wanted => curve.line(out, row, scale, top, class),
                Role::Upper => curve.limit(out, row, scale, top, true),
                Role::Lower => curve.limit(out, row, scale, top, false),
            }
            let y = top + 22 + 14 * i32::try_from(n).unwrap_or(0);
            if y < top + AREA {
                path(out, class, &format!("M4 {}H20", y - 4));
                let most = usize::try_from((row.left() - NUMBERS - 27) * 10 / 67).unwrap_or(8);
                text(out, 25, y, "dim", &cut(&curve.name, most.max(6)));
            }
        }
        path(
            out,
            "axis",
            &format!("M{} {top}V{}H{}", row.left(), top + AREA, row.right()),
        );
    }
}

fn pixel(y: f64) -> i32 {
    y.round() as i32
}

impl Curve {
    fn at(&self, k: usize) -> Option<f64> {
        let value = self.values.get(k).copied().flatten();
        value.filter(drawable)
    }

    /// Straight lines between the middles of the columns.
    fn line(&self, out: &mut String, row: &Row, scale: &Scale, top: i32, class: &str) {
        let mut d = String::new();
        let mut open = false;
        for (n, column) in row.columns.iter().enumerate() {
            let ends = [column.first(), column.first() + column.count() - 1];
            let xs = match column.count() {
                1 => vec![row.middle(n)],
                _ => vec![row.edges[n], row.edges[n + 1]],
            };
            for (x, k) in xs.into_iter().zip(ends) {
                let Some(value) = self.at(k) else {
                    open = false;
                    continue;
                };
                let to = if open { 'L' } else { 'M' };
                open = true;
                let _ = write!(d, "{to}{x} {:.1}", scale.y(value) + f64::from(top));
            }
        }
        path(out, class, &d);
    }

    /// Steps over the columns, with the side behind them shaded.
    fn limit(&self, out: &mut String, row: &Row, scale: &Scale, top: i32, upper: bool) {
        let mut d = String::new();
        let mut n = 0;
        let mut before = None;
        while n < row.columns.len() {
            let value = self.at(row.columns[n].first());
            let same = |m: &usize| self.at(row.columns[*m].first()) == value;
            let end = (n..row.columns.len()).take_while(same).count() + n;
            let (left, right) = (row.edges[n], row.edges[end]);
            if let Some(y) = value.map(|v| pixel(scale.y(v)) + top) {
                let (from, to) = if upper { (top, y) } else { (y, top + AREA) };
                if to > from {
                    rect(out, (left, from), (right - left, to - from), "forbidden");
                }
                let begin = match before {
                    Some(_) => format!("V{y}"),
                    None => format!("M{left} {y}"),
                };
                let _ = write!(d, "{begin}H{right}");
                before = Some(y);
            } else {
                before = None;
            }
            n = end;
        }
        path(out, "limit", &d);
    }
}
