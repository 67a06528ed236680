//! What the machine and its user do.

use super::{BOTH, Resolver, Round};
use toml::Spanned;

use crate::families::Owner;
use crate::plant::Setpoint;
use crate::recording::{Allowed, Value};
use crate::simulate::file::{self, File, Names, Scalar, Text};
use crate::simulate::scenario::{DoorChange, Event, What};

impl Resolver<'_> {
    pub(super) fn motions(&mut self, list: &[file::Motion], events: &mut Vec<Event>) {
        for motion in list {
            let cycle = self.at(&motion.at);
            for axis in self.axes(motion.axis.as_ref()) {
                let kind = self.machine.axes[axis].kind;
                let speed = self.speed(&motion.speed, axis);
                let target = motion.to.as_ref().map(|to| self.length(to, kind));
                if let (Some(cycle), Some(speed)) = (cycle, speed) {
                    let what = What::Motion(Setpoint {
                        speed,
                        target: target.flatten(),
                    });
                    events.push(Event {
                        cycle,
                        axes: vec![axis],
                        sides: BOTH,
                        what,
                    });
                }
            }
        }
    }

    pub(super) fn selects(&mut self, list: &[file::Select], events: &mut Vec<Event>) {
        for select in list {
            let cycle = self.at(&select.at);
            let named = select.axis.as_ref();
            let (selections, selects) = self.drive.words().selections;
            let (pairs, limited) = self.drive.words().limits;
            if let (Some(axis), true) = (named, self.drive.words().of_machine) {
                let message = "a mode is selected for the whole machine".to_owned();
                self.add(axis.span(), message, "not used", "remove axis".to_owned());
            }
            let axes = match (&select.function, &select.limits) {
                (Some(_), None) => self.axes_with(named, selects),
                (None, Some(_)) => self.axes_with(named, limited),
                _ => self.axes(named),
            };
            let mut whats = Vec::new();
            if let Some(function) = &select.function {
                let found = self.one_of(function, selections, "function to select");
                whats.extend(found.map(What::Select));
            }
            if let Some(limits) = &select.limits {
                match pairs.iter().position(|name| name == limits.get_ref()) {
                    Some(pair) => whats.push(What::Limits(pair)),
                    None => self.no_such(limits, "pair of limit switches", pairs),
                }
            }
            if select.function.is_none() && select.limits.is_none() {
                let last = |list: &[&'static str]| list.last().copied().unwrap_or("");
                let help = match last(pairs) {
                    "" => format!("add function = \"{}\"", selections[1]),
                    pair => format!(
                        "add function = \"{}\" or limits = \"{pair}\"",
                        selections[1]
                    ),
                };
                let message = "nothing is selected here".to_owned();
                self.add(select.at.span(), message, "this selection", help);
            }
            let Some(cycle) = cycle else { continue };
            events.extend(whats.into_iter().map(|what| Event {
                cycle,
                axes: axes.clone(),
                sides: BOTH,
                what,
            }));
        }
    }

    pub(super) fn doors(&mut self, list: &[file::Door], events: &mut Vec<Event>) {
        let machine = self.machine;
        for given in list {
            let cycle = self.at(&given.at);
            let found = machine
                .doors
                .iter()
                .position(|d| d.name == *given.door.get_ref());
            let Some(door) = found else {
                let known: Vec<&str> = machine.doors.iter().map(|d| d.name.as_str()).collect();
                self.no_such(&given.door, "door of this machine", &known);
                continue;
            };
            let changes = [
                given.ask.map(DoorChange::Asked),
                given.open.map(DoorChange::Open),
            ];
            if changes == [None, None] {
                let help = "add ask = true (somebody asks for the door) or open = true".to_owned();
                let message = "nothing happens to the door here".to_owned();
                self.add(given.at.span(), message, "this entry", help);
            }
            let Some(cycle) = cycle else { continue };
            for change in changes.into_iter().flatten() {
                events.push(Event {
                    cycle,
                    axes: Vec::new(),
                    sides: BOTH,
                    what: What::Door { door, change },
                });
            }
        }
    }

    /// The place of a name in a list, or `none`.
    fn one_of(&mut self, text: &Text, list: &[&str], noun: &str) -> Option<Option<usize>> {
        let place = list.iter().position(|name| name == text.get_ref());
        if place.is_some() || text.get_ref() == "none" {
            return Some(place);
        }
        let known: Vec<&str> = list.iter().copied().chain(["none"]).collect();
        self.no_such(text, noun, &known);
        None
    }

    /// The inputs of this name, each with its owner: those of the axes named, of every axis that has one where none is, or of what
    /// else has it.
    pub(super) fn inputs(
        &mut self,
        text: &Text,
        axes: Option<&Spanned<Names>>,
    ) -> Vec<(usize, usize)> {
        let place = |owner: &Owner| {
            let mut inputs = owner.inputs.iter();
            inputs.position(|i| i.name == text.get_ref())
        };
        let owners = self.owners.iter().enumerate();
        let having: Vec<(usize, usize)> = owners
            .filter_map(|(k, owner)| place(owner).map(|input| (k, input)))
            .collect();
        let Some((first, _)) = having.first().copied() else {
            let mut known: Vec<&str> = Vec::new();
            for owner in &self.owners {
                let names = owner.inputs.iter().map(|i| i.name);
                let new: Vec<&str> = names.filter(|n| !known.contains(n)).collect();
                known.extend(new);
            }
            self.no_such(text, "signal that a channel reads", &known);
            return Vec::new();
        };
        let Some(axes) = axes else {
            return having;
        };
        if self.owners[first].axis.is_none() {
            let message = format!("{} is no signal of an axis", text.get_ref());
            self.add(axes.span(), message, "not used", "remove axis".to_owned());
            return having;
        }
        let mut found = Vec::new();
        for axis in self.axes(Some(axes)) {
            match having.iter().find(|(owner, _)| *owner == axis) {
                Some(one) => found.push(*one),
                None => {
                    let name = &self.machine.axes[axis].name;
                    let message = format!("axis {name} has no signal {}", text.get_ref());
                    let having = having.iter().map(|(k, _)| self.owners[*k].name.as_str());
                    let having: Vec<&str> = having.collect();
                    let help = format!("axes that have it: {}", having.join(", "));
                    self.add(axes.span(), message, "without it", help);
                }
            }
        }
        found
    }

    /// Gives inputs a value for a time.
    pub(super) fn forced(
        &mut self,
        inputs: &[(usize, usize)],
        (cycle, until): (Option<u32>, Option<u32>),
        sides: [bool; 2],
        value: &Spanned<Scalar>,
        events: &mut Vec<Event>,
    ) {
        for (owner, input) in inputs.iter().copied() {
            let port = self.owners[owner].inputs[input];
            let given = value.get_ref().value();
            if !port.admits(&given) {
                let message = format!("{} is {}; got {given}", port.name, port.kind.noun());
                let help = match port.allowed {
                    Allowed::All => "correct the value or the name".to_owned(),
                    allowed => format!("allowed: {allowed}"),
                };
                self.add(value.span(), message, "not such a value", help);
                return;
            }
            if let Some(cycle) = cycle {
                force(events, (cycle, until), (owner, sides), (input, given));
            }
        }
    }

    pub(super) fn signals(&mut self, list: &[file::Signal], events: &mut Vec<Event>) {
        for signal in list {
            let cycle = self.at(&signal.at);
            let until = self.until(signal.until.as_ref(), cycle);
            let sides = self.sides(signal.channel.as_ref());
            let inputs = self.inputs(&signal.signal, signal.axis.as_ref());
            self.forced(&inputs, (cycle, until), sides, &signal.value, events);
        }
    }

    /// The cycle from which something is over again; it begins in `cycle`.
    pub(super) fn until(&mut self, text: Option<&Text>, cycle: Option<u32>) -> Option<u32> {
        let text = text?;
        let until = self.span_of_time(text, "until", Round::Up)?;
        if cycle.is_some_and(|cycle| until <= cycle) {
            let message = format!("\"{}\" is not after the beginning", text.get_ref());
            let help = "make `until` later than `at` by a cycle at least".to_owned();
            self.add(text.span(), message, "too early", help);
        }
        Some(until)
    }

    pub(super) fn stops(&mut self, list: &[file::Stop], events: &mut Vec<Event>) {
        let known = self.drive.words().asked;
        let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        for stop in list {
            let asked = known.iter().find(|(name, _)| name == stop.stop.get_ref());
            let function = asked.or(known.first()).and_then(|(_, function)| *function);
            let cycle = self.at(&stop.at);
            let axes = self.axes_with(stop.axis.as_ref(), function);
            let sides = self.sides(stop.channel.as_ref());
            let found = self.one_of(&stop.stop, &names, "stop that the safety logic can ask for");
            if let (Some(asked), Some(cycle)) = (found, cycle) {
                events.push(Event {
                    cycle,
                    axes,
                    sides,
                    what: What::Stop(asked),
                });
            }
        }
    }

    /// What the user does: acknowledgements, power, agreements, referencing.
    pub(super) fn user(&mut self, file: &File, events: &mut Vec<Event>) {
        let all: Vec<usize> = (0..self.machine.axes.len()).collect();
        let mut push = |cycle: Option<u32>, axes: Vec<usize>, what: What| {
            if let Some(cycle) = cycle {
                events.push(Event {
                    cycle,
                    axes,
                    sides: BOTH,
                    what,
                });
            }
        };
        // Before power-on in the same cycle: nobody has seen it.
        for moved in &file.moved {
            let cycle = self.at(&moved.at);
            for axis in self.axes(Some(&moved.axis)) {
                if let Some(by) = self.length(&moved.by, self.machine.axes[axis].kind) {
                    push(cycle, vec![axis], What::Moved(by));
                }
            }
        }
        for power in &file.power {
            let delay = power.run_up.as_ref();
            let delay = delay
                .and_then(|t| self.span_of_time(t, "run_up", Round::Up))
                .unwrap_or(0);
            push(self.at(&power.at), all.clone(), What::Power(delay));
        }
        for reset in &file.reset {
            push(self.at(&reset.at), all.clone(), What::Reset);
        }
        for agreement in &file.agreement {
            let axes = self.axes(agreement.axis.as_ref());
            push(
                self.at(&agreement.at),
                axes,
                What::Agreement {
                    give: agreement.give,
                    key: agreement.key,
                },
            );
        }
        for reference in &file.reference {
            let axes = self.axes(reference.axis.as_ref());
            push(self.at(&reference.at), axes, What::Reference);
        }
    }
}

/// An input keeps a value from `cycle` on, perhaps not for ever.
fn force(
    events: &mut Vec<Event>,
    (cycle, until): (u32, Option<u32>),
    (owner, sides): (usize, [bool; 2]),
    (input, value): (usize, Value),
) {
    let mut push = |cycle, value| {
        events.push(Event {
            cycle,
            axes: vec![owner],
            sides,
            what: What::Force { input, value },
        });
    };
    push(cycle, Some(value));
    if let Some(until) = until {
        push(until, None);
    }
}
