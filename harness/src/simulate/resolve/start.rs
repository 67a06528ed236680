//! Where the axes start and how they move.

use stillpoint_machine::AxisKind;
use stillpoint_machine::units::{self, Dimension};

use super::{Resolver, Round};
use crate::families::Windows;
use crate::plant::Mechanics;
use crate::simulate::file::{self, File, Text};
use crate::simulate::scenario::Start;

/// Where an axis stands that no scenario places, in thousandths of an increment: at 0, or in the middle of its safe limit
/// positions where these exclude 0.
fn within_limits(windows: &Windows) -> i64 {
    let low = windows.minus.map(i64::from).into_iter().max().unwrap_or(0);
    let high = windows.plus.map(i64::from).into_iter().min().unwrap_or(0);
    match windows.limited && !(low < 0 && 0 < high) {
        true => (low + high) / 2 * 1_000,
        false => 0,
    }
}

/// The longest delay that a drive is given, in microseconds: a slip of the pen beyond.
const MOST_LAG_US: u64 = 1_000_000;

impl Resolver<'_> {
    pub(super) fn starts(&mut self, file: &File) -> Vec<Start> {
        for name in file.axis.keys() {
            let _ = self.axis_named(name.get_ref(), name.span());
        }
        let machine = self.machine;
        let mut out = Vec::new();
        for axis in &machine.axes {
            let given = file
                .axis
                .iter()
                .find(|(name, _)| *name.get_ref() == axis.name);
            let none = file::Axis::default();
            let given = given.map_or(&none, |(_, given)| given);
            let kind = axis.kind;
            let known = self.drive.ramps(axis);
            let position = given
                .position
                .as_ref()
                .and_then(|t| self.length(t, kind))
                .unwrap_or_else(|| within_limits(&self.drive.windows(axis)));
            let mut rate = |text: &Option<Text>, default: &str| match text {
                Some(text) => self.acceleration(text, kind).unwrap_or(1),
                None => rate_of(default, kind, self.cycle_us()).unwrap_or(1),
            };
            // Usual ones of machine tools; the book names them.
            let mut defaults = match kind {
                AxisKind::Linear => ["2000 mm/s2", "5000 mm/s2", "2000 mm/s2", "500 mm/s2"],
                AxisKind::Rotary => [
                    "10000 deg/s2",
                    "20000 deg/s2",
                    "10000 deg/s2",
                    "1000 deg/s2",
                ],
            };
            if let Some([acceleration, path]) = &known {
                (defaults[0], defaults[2]) = (acceleration.as_str(), path.as_str());
            }
            let mechanics = Mechanics {
                acceleration: rate(&given.acceleration, defaults[0]),
                braking: rate(&given.braking, defaults[1]),
                path_braking: rate(&given.path_braking, defaults[2]),
                friction: rate(&given.friction, defaults[3]),
                sag: given
                    .sag
                    .as_ref()
                    .map_or(0, |sag| rate(&Some(sag.clone()), "")),
                brake_time: given
                    .brake_time
                    .as_ref()
                    .and_then(|t| self.span_of_time(t, "brake_time", Round::Up)),
                dead_time: self.lag(&given.dead_time, "dead_time"),
                following: self.lag(&given.following, "following"),
            };
            out.push(Start {
                position,
                mechanics,
            });
        }
        out
    }

    /// A delay of the drive in cycles, rounded up; none without a text.
    fn lag(&mut self, text: &Option<Text>, key: &str) -> u32 {
        let Some(text) = text else {
            return 0;
        };
        let cycles = self.span_of_time(text, key, Round::Up).unwrap_or(0);
        let most = u32::try_from(MOST_LAG_US / self.cycle_us()).unwrap_or(u32::MAX);
        if cycles > most {
            self.add(
                text.span(),
                format!("\"{}\" is too long for a drive", text.get_ref()),
                "too long",
                format!("allowed: 0 s to {}", super::time(MOST_LAG_US)),
            );
        }
        cycles.min(most)
    }

    /// A position in thousandths of an increment.
    pub(super) fn length(&mut self, text: &Text, kind: AxisKind) -> Option<i64> {
        let (dimension, example) = match kind {
            AxisKind::Linear => (Dimension::Length, "120 mm"),
            AxisKind::Rotary => (Dimension::Angle, "90 deg"),
        };
        let value = self.value(text, dimension, example)?;
        let limit = i64::from(i32::MAX);
        if value.abs() > limit {
            let message = format!("\"{}\" is too far away", text.get_ref());
            let most = dimension.show(limit);
            self.add(
                text.span(),
                message,
                "too large",
                format!("allowed: -{most} to {most}"),
            );
            return None;
        }
        Some(value * 1_000)
    }

    /// A speed of an axis in thousandths of an increment per cycle, rounded towards 0; a share of the limit of a stage, too:
    /// `120 % of STAGE`.
    pub(super) fn speed(&mut self, text: &Text, axis: usize) -> Option<i64> {
        let (dimension, example) = match self.machine.axes[axis].kind {
            AxisKind::Linear => (Dimension::Speed, "5000 mm/min"),
            AxisKind::Rotary => (Dimension::Rotation, "100 rev/min"),
        };
        let per_minute = match text.get_ref().split_once(" of ") {
            Some((share, stage)) => self.share(text, share, stage, axis)?,
            None => self.value(text, dimension, example)?,
        };
        // Increments per minute, times 1000, times us, by 60 s in us.
        let product = i128::from(per_minute) * i128::from(self.cycle_us()) / 60_000;
        let limit = i128::from(i32::MAX);
        if product.abs() > limit * 1_000 {
            let message = format!(
                "\"{}\" is more than the range of positions in a cycle",
                text.get_ref()
            );
            self.add(
                text.span(),
                message,
                "too fast",
                format!("write for example \"{example}\""),
            );
            return None;
        }
        i64::try_from(product).ok()
    }

    /// A share of the limit of a stage, per minute.
    fn share(&mut self, text: &Text, share: &str, stage: &str, axis: usize) -> Option<i64> {
        let percent = share.trim().strip_suffix('%');
        let percent = percent.and_then(|number| number.trim().parse::<i64>().ok());
        let percent = percent.filter(|n| n.abs() <= 1_000);
        let stages = self.drive.words().stages;
        let stage = stages.iter().position(|name| *name == stage.trim());
        let limit = stage.and_then(|k| {
            let axis = &self.machine.axes[axis];
            self.drive.stage(self.machine, axis, k)
        });
        if let (Some(percent), Some(limit)) = (percent, limit) {
            return Some(limit.saturating_mul(percent) / 100);
        }
        let first = stages.first().unwrap_or(&"");
        let range = match stages {
            [_, .., last] => format!(", {first} to {last}"),
            _ => String::new(),
        };
        self.add(
            text.span(),
            format!("\"{}\" is no share of a speed limit", text.get_ref()),
            "not such a value",
            format!("write for example \"120 % of {first}\": -1000 % to 1000 %{range}"),
        );
        None
    }

    fn acceleration(&mut self, text: &Text, kind: AxisKind) -> Option<i64> {
        let found = rate_of(text.get_ref(), kind, self.cycle_us());
        if found.is_none() {
            let units = match kind {
                AxisKind::Linear => "mm/s2 or m/s2, for example \"2000 mm/s2\"",
                AxisKind::Rotary => "deg/s2 or rev/s2, for example \"3600 deg/s2\"",
            };
            self.add(
                text.span(),
                format!(
                    "an acceleration above 0 is needed; got \"{}\"",
                    text.get_ref()
                ),
                "not such a value",
                format!("write a number with {units}"),
            );
        }
        found
    }
}

/// An acceleration in thousandths of an increment per cycle and cycle, at least 1; none for a text that is none.
fn rate_of(text: &str, kind: AxisKind, cycle_us: u64) -> Option<i64> {
    let text = text.trim();
    let (dimension, units) = match kind {
        AxisKind::Linear => (
            Dimension::Length,
            [("mm/s2", "mm", 1), ("m/s2", "mm", 1_000)],
        ),
        AxisKind::Rotary => (
            Dimension::Angle,
            [("deg/s2", "deg", 1), ("rev/s2", "deg", 360)],
        ),
    };
    let (number, unit, factor) = units.iter().find_map(|(suffix, unit, factor)| {
        let number = text.strip_suffix(suffix)?;
        Some((number.trim_end(), unit, factor))
    })?;
    if number.ends_with(|c: char| c.is_ascii_alphabetic()) {
        return None;
    }
    // Increments per second squared; times 1000 for thousandths, by 10^12 for microseconds squared.
    let value = units::parse(&format!("{number} {unit}"), dimension).ok()?;
    let square = i128::from(cycle_us) * i128::from(cycle_us);
    let rate = i128::from(value) * factor * square / 1_000_000_000;
    i64::try_from(rate)
        .ok()
        .filter(|_| value > 0)
        .map(|rate| rate.clamp(1, 1 << 40))
}
