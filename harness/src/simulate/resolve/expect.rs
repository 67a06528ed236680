//! What has to come of a scenario.

use stillpoint_spec::machine::Machine;
use toml::Spanned;

use super::{Resolver, Round, time};
use crate::recording::{Value, vocabulary};
use crate::simulate::file::{self, Scalar, Text};
use crate::simulate::scenario::{Condition, Expect};

impl Resolver<'_> {
    pub(super) fn expect(&mut self, expect: &file::Expect) -> Option<Expect> {
        let after = expect
            .after
            .as_ref()
            .map(|t| self.span_of_time(t, "after", Round::Up));
        let by = expect
            .by
            .as_ref()
            .map(|t| self.span_of_time(t, "by", Round::Down));
        let (after, by) = (
            after.unwrap_or(Some(0))?,
            by.unwrap_or(Some(self.last))?.min(self.last),
        );
        if after > by {
            let place = expect
                .by
                .as_ref()
                .or(expect.after.as_ref())
                .map(Spanned::span)
                .unwrap_or_default();
            let help = "make `by` later than `after` by a cycle at least, both within the duration"
                .to_owned();
            self.add(
                place,
                "no cycle lies in this time".to_owned(),
                "empty",
                help,
            );
            return None;
        }
        let condition = self.condition(expect)?;
        let text = describe(&condition, self.machine);
        let window = format!(
            "from {} to {}",
            time(u64::from(after) * self.cycle_us()),
            time(u64::from(by) * self.cycle_us())
        );
        let text = match expect.never {
            true => format!("never {text}, {window}"),
            false => format!("{text} in a cycle {window}"),
        };
        Some(Expect {
            text,
            condition,
            after,
            by,
            never: expect.never,
        })
    }

    fn condition(&mut self, expect: &file::Expect) -> Option<Condition> {
        let axis = expect
            .axis
            .as_ref()
            .map(|a| self.axis_named(a.get_ref(), a.span()));
        let sides = self.sides(expect.channel.as_ref());
        match (
            axis,
            &expect.stop,
            &expect.standstill,
            &expect.signal,
            &expect.value,
        ) {
            (Some(axis), Some(stop), None, None, None) => {
                let axis = axis?;
                let letters = ["A", "B", "C", "D", "E", "F", "TEST", "NONE"];
                let Some(letter) = letters.iter().find(|l| **l == stop.get_ref().as_str()) else {
                    self.no_such(stop, "stop", &letters);
                    return None;
                };
                let axis = &self.machine.axes[axis].name;
                let channels = vocabulary::CHANNELS
                    .iter()
                    .zip(sides)
                    .filter(|(_, used)| *used);
                Some(Condition::Signals {
                    names: channels
                        .map(|(channel, _)| format!("{axis}.{channel}.stop"))
                        .collect(),
                    value: Value::Text((*letter).into()),
                })
            }
            (Some(axis), None, Some(stands), None, None) => Some(Condition::Standstill {
                axis: axis?,
                stands: *stands.get_ref(),
            }),
            (None, None, None, Some(signal), Some(value)) => self.signal_condition(signal, value),
            _ => {
                let place = [
                    &expect.stop,
                    &expect.signal,
                    &expect.axis,
                    &expect.by,
                    &expect.after,
                ];
                let place = place.into_iter().flatten().next().map(Spanned::span);
                let help =
                    "write axis and stop, axis and standstill, or signal and value".to_owned();
                self.add(
                    place.unwrap_or_default(),
                    "it is not clear what is expected".to_owned(),
                    "this",
                    help,
                );
                None
            }
        }
    }

    fn signal_condition(&mut self, signal: &Text, value: &Spanned<Scalar>) -> Option<Condition> {
        let value_given = match value.get_ref() {
            Scalar::Bool(b) => Value::Bool(*b),
            Scalar::Int(n) => Value::Int(*n),
            Scalar::Text(text) => Value::Text(text.clone().into()),
        };
        let signals = crate::simulate::signals(self.machine);
        let Some(found) = signals.iter().find(|s| s.name == *signal.get_ref()) else {
            let names: Vec<&str> = signals.iter().map(|s| s.name.as_str()).collect();
            self.no_such(signal, "signal of this machine", &names);
            return None;
        };
        if !found.kind.admits(&value_given) {
            let message = format!("{} is {}; got {value_given}", found.name, found.kind.noun());
            self.add(
                value.span(),
                message,
                "another kind of value",
                "correct the value or the name".to_owned(),
            );
            return None;
        }
        Some(Condition::Signals {
            names: vec![found.name.clone()],
            value: value_given,
        })
    }
}

fn describe(condition: &Condition, machine: &Machine) -> String {
    match condition {
        Condition::Signals { names, value } => format!("{} = {value}", names.join(" and ")),
        Condition::Standstill { axis, stands } => {
            let verb = if *stands { "stands" } else { "moves" };
            format!("{} {verb}", machine.axes[*axis].name)
        }
    }
}
