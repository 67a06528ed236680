//! From a scenario file to a [`Scenario`]: units, cycles, names of axes, doors and signals.

use std::path::Path;
use std::sync::Arc;

use stillpoint_spec::diag::{Diagnostic, Diagnostics, Result, nearest};
use stillpoint_spec::machine::units::{self, Dimension};
use stillpoint_spec::machine::{AxisKind, Machine};
use stillpoint_spec::read_text;
use toml::Spanned;

use super::file::{self, File, Names, Scalar, Text};
use super::plant::{Mechanics, Setpoint};
use super::scenario::{
    Condition, Event, Expect, ExternalLetter, Fault, Scenario, Selection, Start, What,
};
use crate::recording::{Kind, Value, vocabulary};

/// Cycles that a scenario may last: a million of 12 ms are more than three hours.
const MOST_CYCLES: u32 = 1_000_000;

impl Scenario {
    /// Reads the scenario file at `path` for this machine.
    ///
    /// # Errors
    /// Everything that is wrong with the file, each with its place and a fix.
    pub fn load(path: &Path, machine: &Machine) -> Result<Self> {
        let text = read_text(path, "scenario file")?;
        Self::from_text(&path.display().to_string(), &text, machine)
    }

    /// The scenario of a text; `name` names it in messages.
    ///
    /// # Errors
    /// As [`Scenario::load`].
    pub fn from_text(name: &str, text: &Arc<str>, machine: &Machine) -> Result<Self> {
        let file: File = toml::from_str(text).map_err(|error| {
            let message = error.message().trim_end();
            Diagnostics::from(
                Diagnostic::new(name, text, error.span(), format!("not a scenario: {message}"))
                    .label("here")
                    .help("the tables of a scenario and their keys stand in `stillpoint simulate --help` and in the book"),
            )
        })?;
        let mut resolver = Resolver {
            name,
            text,
            machine,
            findings: Vec::new(),
            roundings: Vec::new(),
            last: 0,
        };
        let scenario = resolver.scenario(file);
        match (scenario, resolver.findings.is_empty()) {
            (Some(scenario), true) => Ok(scenario),
            _ => {
                resolver
                    .findings
                    .sort_by_key(|d| d.span.as_ref().map_or(usize::MAX, |s| s.start));
                Err(Diagnostics(resolver.findings))
            }
        }
    }
}

struct Resolver<'a> {
    name: &'a str,
    text: &'a Arc<str>,
    machine: &'a Machine,
    findings: Vec<Diagnostic>,
    roundings: Vec<String>,
    /// The last cycle.
    last: u32,
}

/// Which way a time becomes a cycle.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Round {
    Up,
    Down,
}

const BOTH: [bool; 2] = [true, true];

impl Resolver<'_> {
    fn add(&mut self, at: std::ops::Range<usize>, message: String, label: &str, help: String) {
        let one = Diagnostic::new(self.name, self.text, Some(at), message);
        self.findings.push(one.label(label).help(help));
    }

    fn scenario(&mut self, file: File) -> Option<Scenario> {
        let cycles = self.span_of_time(&file.duration, "duration", Round::Up)?;
        if cycles == 0 || cycles > MOST_CYCLES {
            let most = u64::from(MOST_CYCLES) * self.cycle_us();
            self.add(
                file.duration.span(),
                format!(
                    "a scenario of \"{}\" cannot be run",
                    file.duration.get_ref()
                ),
                "too short or too long",
                format!(
                    "allowed: one cycle of {} up to {}",
                    time(self.cycle_us()),
                    time(most)
                ),
            );
            return None;
        }
        self.last = cycles - 1;
        let running = match file.start.as_ref().map(|s| (s, s.get_ref().as_str())) {
            None | Some((_, "on")) => true,
            Some((_, "off")) => false,
            Some((text, other)) => {
                self.add(
                    text.span(),
                    format!("\"{other}\" is no way to start"),
                    "no such start",
                    "write start = \"on\" (running, safely referenced) or \"off\" (not run up, then a table [[power]])".to_owned(),
                );
                true
            }
        };
        let axes = self.starts(&file);
        let mut events = Vec::new();
        self.motions(&file.motion, &mut events);
        self.selects(&file.select, &mut events);
        self.doors(&file.door, &mut events);
        self.signals(&file.signal, &mut events);
        self.stops(&file.stop, &mut events);
        self.user(&file, &mut events);
        self.faults(&file.fault, &mut events);
        // The sort keeps the order of what happens in the same cycle.
        events.sort_by_key(|e: &Event| e.cycle);
        let expects = file.expect.iter().filter_map(|e| self.expect(e)).collect();
        Some(Scenario {
            title: file.title.unwrap_or_default(),
            cycles,
            running,
            axes,
            events,
            expects,
            roundings: std::mem::take(&mut self.roundings),
        })
    }

    fn cycle_us(&self) -> u64 {
        u64::try_from(self.machine.monitoring_cycle)
            .unwrap_or(1)
            .max(1)
    }

    /// A value with a unit, or a finding.
    fn value(&mut self, text: &Text, dimension: Dimension, example: &str) -> Option<i64> {
        let error = match units::parse(text.get_ref(), dimension) {
            Ok(value) => return Some(value),
            Err(error) => error,
        };
        self.add(
            text.span(),
            format!(
                "{} is needed; \"{}\" has {error}",
                dimension.noun(),
                text.get_ref()
            ),
            "not such a value",
            format!(
                "write a number with {}, for example \"{example}\"",
                dimension.unit_list()
            ),
        );
        None
    }

    /// A time in cycles.
    fn span_of_time(&mut self, text: &Text, key: &str, round: Round) -> Option<u32> {
        let us = self.value(text, Dimension::Time, "0.5 s")?;
        let cycle = self.cycle_us();
        let Ok(us) = u64::try_from(us) else {
            self.add(
                text.span(),
                format!("a time cannot be negative; got \"{}\"", text.get_ref()),
                "before the start",
                "times count from the start of the scenario, 0 s".to_owned(),
            );
            return None;
        };
        let cycles = match round {
            Round::Up => us.div_ceil(cycle),
            Round::Down => us / cycle,
        };
        if cycles * cycle != us {
            let way = if round == Round::Up { "up" } else { "down" };
            let shown = time(cycles.saturating_mul(cycle));
            let note = format!("{key} {} {way} to {shown} (cycle {cycles})", text.get_ref());
            if !self.roundings.contains(&note) {
                self.roundings.push(note);
            }
        }
        Some(u32::try_from(cycles).unwrap_or(u32::MAX))
    }

    /// The cycle in which something happens: the first one not before the time.
    fn at(&mut self, text: &Text) -> Option<u32> {
        let cycle = self.span_of_time(text, "at", Round::Up)?;
        if cycle > self.last {
            self.add(
                text.span(),
                format!("\"{}\" is after the end of the scenario", text.get_ref()),
                "too late",
                format!(
                    "make it at most {}, or duration longer",
                    time(u64::from(self.last) * self.cycle_us())
                ),
            );
            return None;
        }
        Some(cycle)
    }

    fn axis_named(&mut self, name: &str, at: std::ops::Range<usize>) -> Option<usize> {
        let found = self.machine.axes.iter().position(|a| a.name == name);
        if found.is_none() {
            let known: Vec<&str> = self.machine.axes.iter().map(|a| a.name.as_str()).collect();
            let help = match nearest(name, known.iter().copied()) {
                Some(near) if known.len() > 3 => {
                    format!("did you mean '{near}'? Axes: {}", known.join(", "))
                }
                _ => format!("axes of {}: {}", self.machine.name, known.join(", ")),
            };
            self.add(
                at,
                format!("the machine has no axis '{name}'"),
                "no such axis",
                help,
            );
        }
        found
    }

    /// The axes named; all of the machine where none is.
    fn axes(&mut self, names: Option<&Spanned<Names>>) -> Vec<usize> {
        let Some(names) = names else {
            return (0..self.machine.axes.len()).collect();
        };
        let list: Vec<String> = match names.get_ref() {
            Names::One(name) => vec![name.clone()],
            Names::Many(list) => list.clone(),
        };
        list.iter()
            .filter_map(|name| self.axis_named(name, names.span()))
            .collect()
    }

    /// The channels named; both where none is.
    fn sides(&mut self, channel: Option<&Text>) -> [bool; 2] {
        match channel.map(|c| c.get_ref().as_str()) {
            None | Some("both") => BOTH,
            Some("nck") => [true, false],
            Some("drive") => [false, true],
            Some(other) => {
                let message = format!("\"{other}\" is no channel");
                let at = channel.map(Spanned::span).unwrap_or_default();
                self.add(
                    at,
                    message,
                    "no such channel",
                    "write \"nck\", \"drive\" or \"both\"".to_owned(),
                );
                BOTH
            }
        }
    }

    fn starts(&mut self, file: &File) -> Vec<Start> {
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
            let position = given
                .position
                .as_ref()
                .and_then(|t| self.length(t, kind))
                .unwrap_or(0);
            let mut rate = |text: &Option<Text>, default: &str| match text {
                Some(text) => self.acceleration(text, kind).unwrap_or(1),
                None => rate_of(default, kind, self.cycle_us()).unwrap_or(1),
            };
            // Usual ones of machine tools; the book names them.
            let defaults = match kind {
                AxisKind::Linear => ["2000 mm/s2", "5000 mm/s2", "2000 mm/s2", "500 mm/s2"],
                AxisKind::Rotary => [
                    "10000 deg/s2",
                    "20000 deg/s2",
                    "10000 deg/s2",
                    "1000 deg/s2",
                ],
            };
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
            };
            out.push(Start {
                position,
                mechanics,
            });
        }
        out
    }

    /// A position in thousandths of an increment.
    fn length(&mut self, text: &Text, kind: AxisKind) -> Option<i64> {
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

    /// A speed in thousandths of an increment per cycle, rounded towards 0.
    fn speed(&mut self, text: &Text, kind: AxisKind) -> Option<i64> {
        let (dimension, example) = match kind {
            AxisKind::Linear => (Dimension::Speed, "5000 mm/min"),
            AxisKind::Rotary => (Dimension::Rotation, "100 rev/min"),
        };
        let per_minute = self.value(text, dimension, example)?;
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

    fn motions(&mut self, list: &[file::Motion], events: &mut Vec<Event>) {
        for motion in list {
            let cycle = self.at(&motion.at);
            for axis in self.axes(Some(&motion.axis)) {
                let kind = self.machine.axes[axis].kind;
                let speed = self.speed(&motion.speed, kind);
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

    fn selects(&mut self, list: &[file::Select], events: &mut Vec<Event>) {
        for select in list {
            let (cycle, axes) = (self.at(&select.at), self.axes(select.axis.as_ref()));
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
            let Some(cycle) = cycle else { continue };
            events.extend(whats.into_iter().map(|what| Event {
                cycle,
                axes: axes.clone(),
                sides: BOTH,
                what,
            }));
        }
    }

    fn no_such(&mut self, text: &Text, what: &str, known: &[&str]) {
        let help = match nearest(text.get_ref(), known.iter().copied()) {
            Some(near) if known.len() > 8 => format!("did you mean \"{near}\"?"),
            _ => format!("write one of: {}", known.join(", ")),
        };
        self.add(
            text.span(),
            format!("\"{}\" is no {what}", text.get_ref()),
            "no such name",
            help,
        );
    }

    fn doors(&mut self, list: &[file::Door], events: &mut Vec<Event>) {
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
            let behind = |name: &str| machine.doors[door].axes.iter().any(|a| a.get_ref() == name);
            let axes = (0..machine.axes.len())
                .filter(|k| behind(&machine.axes[*k].name))
                .collect();
            if let Some(cycle) = cycle {
                let what = What::Door {
                    door,
                    open: given.open,
                };
                events.push(Event {
                    cycle,
                    axes,
                    sides: BOTH,
                    what,
                });
            }
        }
    }

    /// An input of a channel that is true or false.
    fn input(&mut self, text: &Text) -> Option<usize> {
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

    fn signals(&mut self, list: &[file::Signal], events: &mut Vec<Event>) {
        for signal in list {
            let (cycle, until) = (self.at(&signal.at), self.until(signal.until.as_ref()));
            let (axes, sides) = (
                self.axes(signal.axis.as_ref()),
                self.sides(signal.channel.as_ref()),
            );
            if let (Some(input), Some(cycle)) = (self.input(&signal.signal), cycle) {
                force(events, cycle, until, (&axes, sides), (input, signal.value));
            }
        }
    }

    fn until(&mut self, text: Option<&Text>) -> Option<u32> {
        text.and_then(|t| self.span_of_time(t, "until", Round::Up))
    }

    fn stops(&mut self, list: &[file::Stop], events: &mut Vec<Event>) {
        for stop in list {
            let (cycle, axes) = (self.at(&stop.at), self.axes(stop.axis.as_ref()));
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
    fn user(&mut self, file: &File, events: &mut Vec<Event>) {
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
                What::Agreement(agreement.give),
            );
        }
        for reference in &file.reference {
            let axes = self.axes(reference.axis.as_ref());
            push(self.at(&reference.at), axes, What::Reference);
        }
    }

    fn faults(&mut self, list: &[file::Fault], events: &mut Vec<Event>) {
        for fault in list {
            let (cycle, until) = (self.at(&fault.at), self.until(fault.until.as_ref()));
            let (axes, sides) = (
                self.axes(Some(&fault.axis)),
                self.sides(fault.channel.as_ref()),
            );
            let kind = fault.kind.get_ref().as_str();
            let stuck = matches!(kind, "stuck" | "lost");
            self.fault_keys(fault, kind);
            if stuck {
                let Some(signal) = &fault.signal else {
                    let help = "name it: signal = \"SGE_SS_DISABLE\"".to_owned();
                    self.add(
                        fault.kind.span(),
                        format!("which signal is {kind}?"),
                        "no signal named",
                        help,
                    );
                    continue;
                };
                let value = fault.value.as_ref().is_some_and(|v| *v.get_ref());
                if let (Some(input), Some(cycle)) = (self.input(signal), cycle) {
                    force(events, cycle, until, (&axes, sides), (input, value));
                }
                continue;
            }
            for axis in axes {
                let what = match kind {
                    "encoder freeze" => Some(Fault::Freeze),
                    "no braking" => Some(Fault::NoBraking),
                    "encoder offset" => self.offset(fault, axis),
                    _ => {
                        self.no_such(
                            &fault.kind,
                            "kind of fault",
                            &[
                                "encoder freeze",
                                "encoder offset",
                                "no braking",
                                "stuck",
                                "lost",
                            ],
                        );
                        return;
                    }
                };
                let (Some(what), Some(cycle)) = (what, cycle) else {
                    continue;
                };
                let mut push = |cycle, fault| {
                    events.push(Event {
                        cycle,
                        axes: vec![axis],
                        sides,
                        what: What::Fault(fault),
                    });
                };
                push(cycle, what);
                if let Some(until) = until {
                    push(until, Fault::None);
                }
            }
        }
    }

    /// Keys that mean nothing with this kind of fault.
    fn fault_keys(&mut self, fault: &file::Fault, kind: &str) {
        let stuck = matches!(kind, "stuck" | "lost");
        let needless = [
            (
                fault.offset.as_ref().map(Spanned::span),
                "offset",
                kind == "encoder offset",
            ),
            (fault.signal.as_ref().map(Spanned::span), "signal", stuck),
            (
                fault.value.as_ref().map(Spanned::span),
                "value",
                kind == "stuck",
            ),
        ];
        for (place, key, used) in needless {
            if let (Some(place), false) = (place, used) {
                let message = format!("a fault of kind \"{kind}\" has no {key}");
                self.add(
                    place,
                    message,
                    "not used",
                    format!("remove {key}, or choose the kind that it belongs to"),
                );
            }
        }
    }

    fn offset(&mut self, fault: &file::Fault, axis: usize) -> Option<Fault> {
        let Some(offset) = &fault.offset else {
            let help = "write for example offset = \"0.3 mm\"".to_owned();
            self.add(
                fault.kind.span(),
                "by how much?".to_owned(),
                "no offset given",
                help,
            );
            return None;
        };
        let thousandths = self.length(offset, self.machine.axes[axis].kind)?;
        i32::try_from(thousandths / 1_000).ok().map(Fault::Offset)
    }

    fn expect(&mut self, expect: &file::Expect) -> Option<Expect> {
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
        let signals = super::signals(self.machine);
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

/// An input keeps a value from `cycle` on, perhaps not for ever.
fn force(
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

fn describe(condition: &Condition, machine: &Machine) -> String {
    match condition {
        Condition::Signals { names, value } => format!("{} = {value}", names.join(" and ")),
        Condition::Standstill { axis, stands } => {
            let verb = if *stands { "stands" } else { "moves" };
            format!("{} {verb}", machine.axes[*axis].name)
        }
    }
}

/// A time as a user writes it.
pub(super) fn time(us: u64) -> String {
    Dimension::Time.show(i64::try_from(us).unwrap_or(i64::MAX))
}
