//! What has to come of a scenario.

use toml::Spanned;

use super::{Resolver, Round, time};
use crate::recording::{Value, vocabulary};
use crate::simulate::file::{self, Scalar, Text};
use crate::simulate::scenario::{Condition, Expect, Is};

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
        let text = describe(&condition, expect.never);
        let with = |cycle: u32, text: Option<&Text>| {
            let at = time(u64::from(cycle) * self.cycle_us());
            match text.and_then(|t| self.formula(t)) {
                Some(formula) => format!("{at} ({formula})"),
                None => at,
            }
        };
        let window = format!(
            "from {} to {}",
            with(after, expect.after.as_ref()),
            with(by, expect.by.as_ref())
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

    /// What a comment behind a value says of it: in the scenarios of acceptance tests the formula it was computed from.
    fn formula(&self, value: &Text) -> Option<&str> {
        let line = self.text.get(value.span().end..)?.lines().next()?;
        let comment = line.trim_start().strip_prefix('#')?.trim();
        (!comment.is_empty()).then_some(comment)
    }

    fn condition(&mut self, expect: &file::Expect) -> Option<Condition> {
        let sides = self.sides(expect.channel.as_ref());
        let axes = self.axes(expect.axis.as_ref());
        let machine = self.machine;
        let channels = self.drive.words().channels;
        let of_channels = |sides: [bool; 2], signal: &str| -> Vec<String> {
            let names = axes.iter().flat_map(|k| {
                let channels = channels.iter().zip(sides);
                let used = channels.filter(|(_, used)| *used);
                used.map(|(channel, _)| format!("{}.{channel}.{signal}", machine.axes[*k].name))
            });
            names.collect()
        };
        let condition = match (
            &expect.stop,
            &expect.standstill,
            &expect.alarm,
            &expect.signal,
            &expect.value,
        ) {
            (Some(stop), None, None, None, None) => {
                let letters = self.drive.words().stops_listed;
                let Some(letter) = letters.iter().find(|l| **l == stop.get_ref().as_str()) else {
                    self.no_such(stop, "stop", letters);
                    return None;
                };
                Condition {
                    names: of_channels(sides, vocabulary::STOP),
                    is: Is::Value(Value::Text((*letter).into())),
                }
            }
            (None, Some(stands), None, None, None) => {
                let names = axes.iter().map(|k| &machine.axes[*k].name);
                Condition {
                    names: names
                        .map(|name| format!("{name}.{}", vocabulary::VELOCITY))
                        .collect(),
                    is: Is::Standing(*stands.get_ref()),
                }
            }
            (None, None, Some(alarm), None, None) => {
                let channel = self.channel_of(alarm)?;
                Condition {
                    names: of_channels(channel, vocabulary::ALARMS),
                    is: Is::Listing(alarm.get_ref().clone()),
                }
            }
            (None, None, None, Some(signal), Some(value)) => {
                let names = match expect.axis {
                    Some(_) => of_channels(sides, signal.get_ref()),
                    None => vec![signal.get_ref().clone()],
                };
                self.signal_condition(signal, names, value)?
            }
            _ => {
                let place = [
                    &expect.stop,
                    &expect.alarm,
                    &expect.signal,
                    &expect.by,
                    &expect.after,
                ];
                let place = place.into_iter().flatten().next().map(Spanned::span);
                let place = place.or(expect.axis.as_ref().map(Spanned::span));
                let help = "write one of stop, standstill and alarm, perhaps with axis, or signal and value";
                self.add(
                    place.unwrap_or_default(),
                    "it is not clear what is expected".to_owned(),
                    "this",
                    help.to_owned(),
                );
                return None;
            }
        };
        // An axis that the machine does not have is a finding already.
        (!condition.names.is_empty()).then_some(condition)
    }

    /// The channel that an alarm is one of.
    fn channel_of(&mut self, alarm: &Text) -> Option<[bool; 2]> {
        let known = self.drive.alarms();
        if let Some((_, side)) = known.iter().find(|(number, _)| number == alarm.get_ref()) {
            return Some([*side == 0, *side == 1]);
        }
        let names: Vec<&str> = known.iter().map(|(number, _)| number.as_str()).collect();
        self.no_such(alarm, "alarm of the monitors", &names);
        None
    }

    fn signal_condition(
        &mut self,
        signal: &Text,
        names: Vec<String>,
        value: &Spanned<Scalar>,
    ) -> Option<Condition> {
        let value_given = value.get_ref().value();
        let signals = crate::simulate::signals(self.machine);
        for name in &names {
            let Some(found) = signals.iter().find(|s| s.name == *name) else {
                let known = signals.iter().map(|s| s.name.as_str());
                // With an axis only the last part was written.
                let prefix = &name[..name.len() - signal.get_ref().len()];
                let known: Vec<&str> = known.filter_map(|n| n.strip_prefix(prefix)).collect();
                self.no_such(signal, "signal of this machine", &known);
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
        }
        Some(Condition {
            names,
            is: Is::Value(value_given),
        })
    }
}

fn describe(condition: &Condition, never: bool) -> String {
    let joint = if never { " or " } else { " and " };
    let names = &condition.names;
    match &condition.is {
        Is::Value(value) => format!("{} = {value}", names.join(joint)),
        Is::Listing(alarm) => format!("alarm {alarm} in {}", names.join(joint)),
        Is::Standing(stands) => {
            let axes = names
                .iter()
                .map(|name| name.split('.').next().unwrap_or(""));
            let axes: Vec<&str> = axes.collect();
            let one = axes.len() == 1 || never;
            let verb = match (stands, one) {
                (true, true) => "stands",
                (true, false) => "stand",
                (false, true) => "moves",
                (false, false) => "move",
            };
            format!("{} {verb}", axes.join(joint))
        }
    }
}
