//! What the machine and its user do.

use super::{BOTH, Resolver, Round};
use crate::recording::{Kind, vocabulary};
use crate::simulate::file::{self, File, Text};
use crate::simulate::plant::Setpoint;
use crate::simulate::scenario::{DoorChange, Event, ExternalLetter, Selection, What};

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
            let axes = match (&select.function, &select.limits) {
                (Some(_), None) => self.axes_with(named, "SBH/SG"),
                (None, Some(_)) => self.axes_with(named, "SE"),
                _ => self.axes(named),
            };
            let mut whats = Vec::new();
            if let Some(function) = &select.function {
                let found = match function.get_ref().as_str() {
                    "none" => Some(Selection::Nothing),
                    "SBH" => Some(Selection::Standstill),
                    "SG1" => Some(Selection::Stage(0)),
                    "SG2" => Some(Selection::Stage(1)),
                    "SG3" => Some(Selection::Stage(2)),
                    "SG4" => Some(Selection::Stage(3)),
                    _ => None,
                };
                match found {
                    Some(selection) => whats.push(What::Select(selection)),
                    None => self.no_such(
                        function,
                        "function to select",
                        &["SBH", "SG1", "SG2", "SG3", "SG4", "none"],
                    ),
                }
            }
            if let Some(limits) = &select.limits {
                match limits.get_ref().as_str() {
                    "SE1" => whats.push(What::Limits(false)),
                    "SE2" => whats.push(What::Limits(true)),
                    _ => self.no_such(limits, "pair of limit switches", &["SE1", "SE2"]),
                }
            }
            if select.function.is_none() && select.limits.is_none() {
                let help = "add function = \"SG1\" or limits = \"SE2\"".to_owned();
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

    /// An input of a channel that is true or false.
    pub(super) fn input(&mut self, text: &Text) -> Option<usize> {
        let all = vocabulary::inputs();
        let found = all
            .iter()
            .position(|i| i.name == text.get_ref() && i.kind == Kind::Bool);
        if found.is_none() {
            let known: Vec<&str> = all
                .iter()
                .filter(|i| i.kind == Kind::Bool)
                .map(|i| i.name)
                .collect();
            self.no_such(text, "signal that a channel reads", &known);
        }
        found
    }

    pub(super) fn signals(&mut self, list: &[file::Signal], events: &mut Vec<Event>) {
        for signal in list {
            let cycle = self.at(&signal.at);
            let until = self.until(signal.until.as_ref(), cycle);
            let (axes, sides) = (
                self.axes(signal.axis.as_ref()),
                self.sides(signal.channel.as_ref()),
            );
            if let (Some(input), Some(cycle)) = (self.input(&signal.signal), cycle) {
                force(events, cycle, until, (&axes, sides), (input, signal.value));
            }
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
        for stop in list {
            let function = match stop.stop.get_ref().as_str() {
                "E" => "STOP E",
                _ => "external stops",
            };
            let cycle = self.at(&stop.at);
            let axes = self.axes_with(stop.axis.as_ref(), function);
            let sides = self.sides(stop.channel.as_ref());
            let letter = match stop.stop.get_ref().as_str() {
                "none" => None,
                "A" => Some(ExternalLetter::A),
                "C" => Some(ExternalLetter::C),
                "D" => Some(ExternalLetter::D),
                "E" => Some(ExternalLetter::E),
                _ => {
                    self.no_such(
                        &stop.stop,
                        "stop that the safety logic can ask for",
                        &["A", "C", "D", "E", "none"],
                    );
                    continue;
                }
            };
            if let Some(cycle) = cycle {
                events.push(Event {
                    cycle,
                    axes,
                    sides,
                    what: What::Stop(letter),
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
pub(super) fn force(
    events: &mut Vec<Event>,
    cycle: u32,
    until: Option<u32>,
    (axes, sides): (&[usize], [bool; 2]),
    (input, value): (usize, bool),
) {
    let mut push = |cycle, value| {
        let what = What::Force { input, value };
        events.push(Event {
            cycle,
            axes: axes.to_vec(),
            sides,
            what,
        });
    };
    push(cycle, Some(value));
    if let Some(until) = until {
        push(until, None);
    }
}
