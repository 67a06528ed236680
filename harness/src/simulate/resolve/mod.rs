//! From a scenario file to a [`Scenario`]: units, cycles, names of axes, doors and signals.

mod events;
mod expect;
mod faults;
mod hoist;
mod start;

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result, nearest};
use stillpoint_lang::read_text;
use stillpoint_machine::Machine;
use stillpoint_machine::units::{self, Dimension};
use toml::Spanned;

use super::file::{File, Names, Text};
use super::scenario::{Event, Scenario};
use crate::families::{self, Drive, Owner};
use crate::recording;

impl Scenario {
    /// Reads the scenario file at `path` for this machine.
    ///
    /// # Errors
    /// Everything that is wrong with the file, each with its place and a fix; a family that runs no scenario.
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
        let drive = families::of(machine)
            .map_err(|message| Diagnostics::from(Diagnostic::new(name, text, None, message)))?;
        let mut resolver = Resolver {
            name,
            text,
            machine,
            drive,
            owners: drive.owners(machine),
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
    drive: &'static dyn Drive,
    owners: Vec<Owner>,
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
    fn add(&mut self, at: Range<usize>, message: String, label: &str, help: String) {
        let one = Diagnostic::new(self.name, self.text, Some(at), message);
        self.findings.push(one.label(label).help(help));
    }

    fn scenario(&mut self, file: File) -> Option<Scenario> {
        let cycles = self.span_of_time(&file.duration, "duration", Round::Up)?;
        let most = recording::most_cycles(super::signals(self.machine).len());
        if cycles == 0 || u64::from(cycles) > most {
            let most = most.saturating_mul(self.cycle_us());
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
        self.brakes(&file.brake, &mut events);
        self.loads(&file.load, &mut events);
        // The sort keeps the order of what happens in the same cycle.
        events.sort_by_key(|e: &Event| e.cycle);
        let expects = file.expect.iter().filter_map(|e| self.expect(e)).collect();
        Some(Scenario {
            title: file.title.unwrap_or_default(),
            cycles,
            running,
            acceptance_mode: file.acceptance_mode,
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

    fn axis_named(&mut self, name: &str, at: Range<usize>) -> Option<usize> {
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
        let list: Vec<&str> = match names.get_ref() {
            Names::One(text) => text.split(',').map(str::trim).collect(),
            Names::Many(list) => list.iter().map(String::as_str).collect(),
        };
        let list: Vec<&str> = list.into_iter().filter(|name| !name.is_empty()).collect();
        if list.is_empty() {
            let help = "name an axis, or leave the key out for all of them".to_owned();
            self.add(names.span(), "no axis is named".to_owned(), "empty", help);
        }
        list.iter()
            .filter_map(|name| self.axis_named(name, names.span()))
            .collect()
    }

    /// The axes named, which must have a function enabled if one is needed; all of the machine where none is named.
    fn axes_with(&mut self, names: Option<&Spanned<Names>>, function: Option<&str>) -> Vec<usize> {
        let axes = self.axes(names);
        let Some(function) = function else {
            return axes;
        };
        let machine = self.machine;
        for axis in axes.iter().map(|k| &machine.axes[*k]) {
            if let (Some(names), false) = (names, axis.has(function)) {
                let message = format!("axis {} has no function \"{function}\"", axis.name);
                let help = format!(
                    "add \"{function}\" to its functions in the machine file, or name another axis"
                );
                self.add(names.span(), message, "not enabled", help);
            }
        }
        axes
    }

    /// The channels named; both where none is.
    fn sides(&mut self, channel: Option<&Text>) -> [bool; 2] {
        let known = self.drive.words().channels;
        match channel.map(|c| c.get_ref().as_str()) {
            None | Some("both") => BOTH,
            Some(one) if known.contains(&one) => [0, 1].map(|k| known.get(k) == Some(&one)),
            Some(other) => {
                let message = format!("\"{other}\" is no channel");
                let at = channel.map(Spanned::span).unwrap_or_default();
                let help = match known {
                    [first, second] => format!("write \"{first}\", \"{second}\" or \"both\""),
                    _ => "remove channel: there is one only".to_owned(),
                };
                self.add(at, message, "no such channel", help);
                BOTH
            }
        }
    }

    fn no_such(&mut self, text: &Text, what: &str, known: &[&str]) {
        let help = match nearest(text.get_ref(), known.iter().copied()) {
            _ if known.is_empty() => "the machine has none".to_owned(),
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
}

/// A time as a user writes it.
pub(in crate::simulate) fn time(us: u64) -> String {
    Dimension::Time.show(i64::try_from(us).unwrap_or(i64::MAX))
}
