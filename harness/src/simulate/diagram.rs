//! A simulation as timing diagram, as text and as tables.

use std::fmt::Write;

use stillpoint_machine::AxisKind;
use stillpoint_show::diagram::{Curve, Diagram, Lane, Mark, Panel, Role};

use super::resolve::time;
use super::summary::{Shown, Simulation, numbers};
use crate::recording::{Kind, Value, vocabulary};
use crate::report::counted;

impl Simulation {
    /// Whether everything expected holds.
    pub fn holds(&self) -> bool {
        self.judged.iter().all(|judged| judged.holds)
    }

    /// Speed and position of the axes that move or stop, against what is monitored, and the signals that change.
    pub fn diagram(&self) -> Diagram {
        let mut panels = Vec::new();
        let mut lanes = Vec::new();
        for door in self
            .recording
            .signals
            .iter()
            .filter(|s| s.name.starts_with("door."))
        {
            let name = door.name.clone();
            lanes.extend(self.lane("machine", &door.name, &[name]));
        }
        for (owner, signals) in &self.others {
            for name in signals {
                lanes.extend(self.lane(owner, name, &self.names(owner, name)));
            }
        }
        for axis in self.axes.iter().filter(|axis| self.is_concerned(axis)) {
            panels.push(self.speed(axis));
            panels.push(self.position(axis));
            self.lanes(axis, &mut lanes);
        }
        let mut marks: Vec<Mark> = Vec::new();
        let shown = |name: &str| {
            panels
                .iter()
                .any(|p: &Panel| p.name == format!("speed of {name}"))
        };
        for stop in self.stops.iter().filter(|stop| shown(&stop.axis)) {
            let text = format!("{}: {}, {}", stop.axis, stop.name, stop.reason);
            let column = usize::try_from(stop.cycle).unwrap_or(usize::MAX);
            marks.push(Mark {
                column,
                text,
                fault: false,
            });
        }
        for judged in self.judged.iter().filter(|j| !j.holds) {
            // What did not happen in time is marked at the end, what must not happen where it happened.
            let last = self.recording.rows.len().saturating_sub(1);
            let column = judged
                .cycle
                .and_then(|c| usize::try_from(c).ok())
                .unwrap_or(last);
            let text = format!("expected: {}", judged.text);
            marks.push(Mark {
                column,
                text,
                fault: true,
            });
        }
        Diagram {
            title: self.title.clone(),
            columns: self.recording.rows.len(),
            cycle: Some(self.recording.cycle_us),
            panels,
            lanes,
            marks,
            loop_start: None,
        }
    }

    /// The diagram for a terminal: without the curves, which change in every cycle and would leave nothing to gather.
    pub fn text(&self) -> String {
        let mut diagram = self.diagram();
        diagram.panels.clear();
        diagram.text()
    }

    /// Whether the axis moves, or stops in a simulation in which none moves: another one says nothing here.
    fn is_concerned(&self, axis: &Shown) -> bool {
        let moves = |name: &str| {
            let speeds = numbers(&self.recording, &format!("{name}.{}", vocabulary::VELOCITY));
            speeds.iter().any(|s| *s != 0)
        };
        let stops = || self.stops.iter().any(|s| s.axis == axis.name);
        moves(&axis.name) || (stops() && !self.axes.iter().any(|a| moves(&a.name)))
    }

    /// The values of `axis.name`, scaled.
    fn curve(&self, axis: &Shown, name: &str, factor: f64) -> Vec<Option<f64>> {
        let values = numbers(&self.recording, &format!("{}.{name}", axis.name));
        values
            .into_iter()
            .map(|v| Some(v as f64 * factor))
            .collect()
    }

    /// Whether a signal of the axis has this value in the first channel, by cycle.
    fn whether(&self, axis: &Shown, name: &str, test: impl Fn(&str) -> bool) -> Vec<bool> {
        let signal = self.recording.find(&self.first(axis, name));
        let rows = self.recording.rows.iter();
        rows.map(|row| match signal.and_then(|s| row.get(s)) {
            Some(Some(Value::Text(text))) => test(text),
            _ => false,
        })
        .collect()
    }

    /// The full names of a signal in all channels.
    fn names(&self, owner: &str, name: &str) -> Vec<String> {
        let channels = self.words.channels.iter();
        channels.map(|c| format!("{owner}.{c}.{name}")).collect()
    }

    /// The full name of a signal in the first channel.
    fn first(&self, axis: &Shown, name: &str) -> String {
        format!("{}.{}.{name}", axis.name, self.words.channels[0])
    }

    fn speed(&self, axis: &Shown) -> Panel {
        let cycle = self.recording.cycle_us as f64;
        // From thousandths of an increment per cycle to mm/min or rev/min.
        let (unit, per_minute) = match axis.kind {
            AxisKind::Linear => ("mm/min", 1e-6),
            AxisKind::Rotary => ("rev/min", 1e-6 / 360.0),
        };
        let factor = per_minute * 60e6 / cycle;
        let actual = self.curve(axis, vocabulary::VELOCITY, factor);
        let backwards = actual.iter().flatten().any(|v| *v < 0.0);
        let forwards = actual.iter().flatten().any(|v| *v > 0.0) || !backwards;
        let watched = self.whether(axis, "Safety.SLS.ActivationState", |s| s != "NONE");
        let first = self.words.channels[0];
        let limit = self.curve(axis, &format!("{first}.Safety.SLS.Limit"), factor * 1e3);
        let limited = |sign: f64| -> Vec<Option<f64>> {
            let both = limit.iter().zip(&watched);
            both.map(|(v, on)| v.filter(|_| *on).map(|v| v * sign))
                .collect()
        };
        let mut curves = vec![
            Curve {
                name: "setpoint".to_owned(),
                role: Role::Wanted,
                values: self.curve(axis, vocabulary::SETPOINT, factor),
            },
            Curve {
                name: "speed".to_owned(),
                role: Role::Actual,
                values: actual,
            },
        ];
        let mut add = |name, role, values| add(&mut curves, name, role, values);
        if forwards {
            add(self.words.curves[0], Role::Upper, limited(1.0));
        }
        if backwards {
            add(self.words.curves[1], Role::Lower, limited(-1.0));
        }
        Panel {
            name: format!("speed of {}", axis.name),
            unit: unit.to_owned(),
            curves,
        }
    }

    fn position(&self, axis: &Shown) -> Panel {
        let unit = match axis.kind {
            AxisKind::Linear => "mm",
            AxisKind::Rotary => "deg",
        };
        let actual = self.curve(axis, vocabulary::POSITION, 1e-6);
        let mut curves = vec![Curve {
            name: "position".to_owned(),
            role: Role::Actual,
            values: actual.clone(),
        }];
        // What a channel sees is shown where it is another position: a fault of an encoder.
        for channel in self.words.channels {
            let seen = self.curve(axis, &format!("{channel}.{}", vocabulary::POSITION), 1e-3);
            let fine = 0.0015 * self.words.resolution as f64;
            let differs = seen.iter().zip(&actual).any(|(a, b)| match (a, b) {
                (Some(a), Some(b)) => (a - b).abs() > fine,
                _ => false,
            });
            if differs {
                let name = format!("seen by {channel}");
                curves.push(Curve {
                    name,
                    role: Role::Wanted,
                    values: seen,
                });
            }
        }
        let first = self.words.channels[0];
        let standing = self.whether(axis, "Safety.SOS.ActivationState", |s| s != "NONE");
        let reference = self.curve(axis, &format!("{first}.standstill_reference"), 1e-3);
        let window = |sign: f64| -> Vec<Option<f64>> {
            let tolerance = axis.windows.standstill as f64 * 1e-3 * sign;
            let both = reference.iter().zip(&standing);
            both.map(|(v, on)| v.filter(|_| *on).map(|v| v + tolerance))
                .collect()
        };
        let mut add = |name, role, values| add(&mut curves, name, role, values);
        let [.., still, limits] = self.words.curves;
        let ends = |name: &str| ["upper", "lower"].map(|end| format!("{name} {end} end"));
        let [upper, lower] = ends(still);
        add(&upper, Role::Upper, window(1.0));
        add(&lower, Role::Lower, window(-1.0));
        let [upper, lower] = ends(limits);
        let limit = |pair| self.limit(axis, pair, &actual);
        add(&upper, Role::Upper, limit(axis.windows.plus));
        add(&lower, Role::Lower, limit(axis.windows.minus));
        Panel {
            name: format!("position of {}", axis.name),
            unit: unit.to_owned(),
            curves,
        }
    }

    /// The limit position in force, where the way of the axis comes near it; far away it would only flatten the picture.
    fn limit(&self, axis: &Shown, pair: [i32; 2], actual: &[Option<f64>]) -> Vec<Option<f64>> {
        let first = self.whether(axis, "Safety.SLP.SelectionState", |s| {
            s == "SELECTED_LIMIT_1"
        });
        let second = self.whether(axis, "Safety.SLP.SelectionState", |s| {
            s == "SELECTED_LIMIT_2"
        });
        let (least, most) = actual
            .iter()
            .flatten()
            .fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
        let near = (most - least).max(1.0);
        let values = first.iter().zip(&second).map(|(first, second)| {
            let limit = match (first, second) {
                (true, _) => f64::from(pair[0]) * 1e-3,
                (_, true) => f64::from(pair[1]) * 1e-3,
                _ => return None,
            };
            (limit > least - near && limit < most + near).then_some(limit)
        });
        values.collect()
    }

    /// Inputs that the channels see differently, what the channels say where it changes, and what the drive does.
    fn lanes(&self, axis: &Shown, lanes: &mut Vec<Lane>) {
        for event in self.words.events {
            let name = self.first(axis, event);
            // Power-on in the first cycle only is where every recording begins.
            let later = self.recording.find(&name).is_some_and(|signal| {
                let mut values = self.recording.column(signal).skip(1);
                values.any(|v| v == Some(&Value::Bool(true)))
            });
            if later {
                lanes.extend(self.lane(&axis.name, event, &[name]));
            }
        }
        for input in &axis.flags {
            let names = self.names(&axis.name, input);
            if matches!(&names[..], [first, second] if self.differ(first, second)) {
                for (channel, name) in self.words.channels.iter().zip(names) {
                    let shown = format!("{input} {channel}");
                    lanes.extend(self.lane(&axis.name, &shown, &[name]));
                }
            }
        }
        for name in self.words.lanes {
            let names = self.names(&axis.name, name);
            let short = name
                .trim_start_matches("Safety.")
                .replace(".SelectionState", "")
                .replace(".ActivationState", "");
            lanes.extend(self.lane(&axis.name, &short, &names));
        }
        let name = format!("{}.drive", axis.name);
        lanes.extend(self.lane(&axis.name, "drive does", &[name]));
    }

    fn differ(&self, a: &str, b: &str) -> bool {
        let (a, b) = (self.recording.find(a), self.recording.find(b));
        match (a, b) {
            (Some(a), Some(b)) => self.recording.rows.iter().any(|row| row[a] != row[b]),
            _ => false,
        }
    }

    /// A lane of the signals `names`, `a/b` where they differ; none if nothing changes.
    fn lane(&self, group: &str, shown: &str, names: &[String]) -> Option<Lane> {
        let signals: Vec<usize> = names
            .iter()
            .filter_map(|n| self.recording.find(n))
            .collect();
        let first = *signals.first()?;
        let level = self.recording.signals[first].kind == Kind::Bool;
        let mut values = Vec::new();
        for row in &self.recording.rows {
            let mut parts: Vec<String> = signals
                .iter()
                .filter_map(|s| row[*s].as_ref().map(short))
                .collect();
            parts.dedup();
            values.push(Some(parts.join("/")));
        }
        let changes = values.iter().any(|v| *v != values[0]);
        let both = values.iter().flatten().any(|v| v.contains('/'));
        changes.then(|| Lane {
            group: group.to_owned(),
            name: shown.to_owned(),
            level: level && !both,
            values,
        })
    }

    /// Stops, expectations and roundings in words; the roundings one by one if `all` asks for it.
    pub fn summary(&self, all: bool) -> String {
        let mut out = String::new();
        let cycles = self.recording.rows.len() as u64;
        let cycle = self.recording.cycle_us;
        let _ = writeln!(
            out,
            "{} cycles of {}, {}",
            cycles,
            time(cycle),
            time(cycles * cycle)
        );
        if self.stops.is_empty() {
            out.push_str("no stop\n");
        }
        for stop in &self.stops {
            let stands = match stop.stands {
                Some(at) if at == stop.cycle => "stands already".to_owned(),
                Some(at) => format!(
                    "stands {} later ({}) after {}",
                    time((at - stop.cycle) * cycle),
                    counted(at - stop.cycle, "cycle"),
                    stop.travel_shown
                ),
                None => format!("does not stand yet, {} on", stop.travel_shown),
            };
            let _ = writeln!(
                out,
                "{} {} in cycle {} ({}), {}: {}; {stands}",
                stop.axis,
                stop.name,
                stop.cycle,
                time(stop.cycle * cycle),
                stop.channels,
                stop.reason,
            );
        }
        for judged in &self.judged {
            let (verdict, found) = match (judged.holds, judged.cycle) {
                (true, Some(at)) => ("holds", format!(": cycle {at}, {}", time(at * cycle))),
                (true, None) => ("holds", String::new()),
                (false, Some(at)) => ("FAILS", format!(": cycle {at}, {}", time(at * cycle))),
                (false, None) => ("FAILS", ": not in any cycle".to_owned()),
            };
            let _ = writeln!(out, "{verdict}  {}{found}", judged.text);
        }
        if !self.roundings.is_empty() {
            let times = match self.roundings.len() {
                1 => "1 time of the scenario is".to_owned(),
                n => format!("{n} times of the scenario are"),
            };
            let listed = if all {
                ":"
            } else {
                "; -v lists what became of them"
            };
            let _ = writeln!(out, "{times} no whole number of cycles{listed}");
            for rounding in self.roundings.iter().filter(|_| all) {
                let _ = writeln!(out, "  {rounding}");
            }
        }
        out
    }
}

/// Adds a curve, where it has any value.
fn add(curves: &mut Vec<Curve>, name: &str, role: Role, values: Vec<Option<f64>>) {
    if values.iter().any(Option::is_some) {
        curves.push(Curve {
            name: name.to_owned(),
            role,
            values,
        });
    }
}

/// A value as it stands in a lane.
fn short(value: &Value) -> String {
    match value {
        Value::Text(text) => {
            let short = text
                .trim_start_matches("SELECTED_")
                .trim_start_matches("SLP_");
            short.to_owned()
        }
        other => other.to_string(),
    }
}
