//! Faults of encoders, signals and the drive.

use stillpoint_machine::AxisKind;
use toml::Spanned;

use super::{BOTH, Resolver};
use crate::plant::{ENCODERS, Fault};
use crate::recording::Kind;
use crate::simulate::file::{self, Scalar};
use crate::simulate::scenario::{Event, What};

/// The kinds of faults; the last one for a family with a telegram.
static KINDS: [&str; 7] = [
    "encoder freeze",
    "encoder offset",
    "no braking",
    "slip",
    "stuck",
    "lost",
    "telegram freeze",
];

impl Resolver<'_> {
    pub(super) fn faults(&mut self, list: &[file::Fault], events: &mut Vec<Event>) {
        for fault in list {
            let cycle = self.at(&fault.at);
            let until = self.until(fault.until.as_ref(), cycle);
            let kind = fault.kind.get_ref().as_str();
            self.fault_keys(fault, kind);
            if matches!(kind, "stuck" | "lost") {
                self.stuck(fault, (cycle, until), events);
                continue;
            }
            let telegram = self.drive.words().telegram.is_some();
            let known = match telegram {
                true => &KINDS[..],
                false => &KINDS[..KINDS.len() - 1],
            };
            if !known.contains(&kind) {
                self.no_such(&fault.kind, "kind of fault", known);
                return;
            }
            let encoders = self.encoders(fault, kind);
            for axis in self.axes(Some(&fault.axis)) {
                let what = match kind {
                    "encoder freeze" => Some(Fault::Freeze),
                    "no braking" => Some(Fault::NoBraking),
                    "encoder offset" => self.offset(fault, axis),
                    "slip" => self.slip(fault, axis),
                    _ => Some(Fault::Telegram),
                };
                let (Some(what), Some(cycle)) = (what, cycle) else {
                    continue;
                };
                let mut push = |cycle, fault| {
                    events.push(Event {
                        cycle,
                        axes: vec![axis],
                        sides: BOTH,
                        what: What::Fault { fault, encoders },
                    });
                };
                push(cycle, what);
                if let Some(until) = until {
                    push(until, Fault::None);
                }
            }
        }
    }

    /// A signal that keeps a value, or is lost: 0.
    fn stuck(
        &mut self,
        fault: &file::Fault,
        time: (Option<u32>, Option<u32>),
        events: &mut Vec<Event>,
    ) {
        let sides = self.sides(fault.channel.as_ref());
        let Some(signal) = &fault.signal else {
            let kind = fault.kind.get_ref();
            let help = format!("name it: signal = \"{}\"", self.drive.words().example);
            self.add(
                fault.kind.span(),
                format!("which signal is {kind}?"),
                "no signal named",
                help,
            );
            return;
        };
        let inputs = self.inputs(signal, Some(&fault.axis));
        let first = inputs.first();
        let first = first.map(|(k, input)| self.owners[*k].inputs[*input].kind);
        let zero = match first {
            Some(Kind::Int) => Scalar::Int(0),
            _ => Scalar::Bool(false),
        };
        let zero = Spanned::new(signal.span(), zero);
        let value = fault.value.as_ref().unwrap_or(&zero);
        self.forced(&inputs, time, sides, value, events);
    }

    /// The encoders meant: those of the channels named, the one named, or that with a telegram.
    fn encoders(&mut self, fault: &file::Fault, kind: &str) -> [bool; ENCODERS] {
        let words = self.drive.words();
        let known = words.encoders;
        let mut meant = [false; ENCODERS];
        if known == words.channels && fault.encoder.is_none() {
            let sides = self.sides(fault.channel.as_ref());
            meant[..sides.len()].copy_from_slice(&sides);
            return meant;
        }
        if let Some(channel) = &fault.channel {
            let message = "a fault of an encoder is in no channel here".to_owned();
            let help = format!("write encoder = \"{}\"", known[0]);
            self.add(channel.span(), message, "not used", help);
        }
        let named = fault.encoder.as_ref();
        let place = match (kind, named) {
            // Of the drive: told to all of them.
            ("no braking", _) => return [true; ENCODERS],
            ("telegram freeze", None) => words.telegram,
            (_, Some(name)) => known.iter().position(|one| one == name.get_ref()),
            (_, None) => {
                let help = format!("add encoder = \"{}\"", known.join("\", or \""));
                let message = "which encoder?".to_owned();
                self.add(fault.kind.span(), message, "no encoder named", help);
                return meant;
            }
        };
        match (place, named) {
            (Some(place), Some(name))
                if kind == "telegram freeze" && words.telegram != Some(place) =>
            {
                let message = format!("{} comes by no telegram", name.get_ref());
                let help = "remove encoder".to_owned();
                self.add(name.span(), message, "without one", help);
            }
            (Some(place), _) => meant[place] = true,
            (None, Some(name)) => self.no_such(name, "encoder", known),
            (None, None) => {}
        }
        meant
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
            (
                fault.speed.as_ref().map(Spanned::span),
                "speed",
                kind == "slip",
            ),
            (
                fault.encoder.as_ref().map(Spanned::span),
                "encoder",
                !stuck && kind != "no braking",
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
        Some(Fault::Offset(thousandths / 1_000 * 1_000))
    }

    fn slip(&mut self, fault: &file::Fault, axis: usize) -> Option<Fault> {
        let Some(speed) = &fault.speed else {
            let help = match self.machine.axes[axis].kind {
                AxisKind::Linear => "write for example speed = \"5 mm/min\"",
                AxisKind::Rotary => "write for example speed = \"5 rev/min\"",
            };
            self.add(
                fault.kind.span(),
                "how fast?".to_owned(),
                "no speed given",
                help.to_owned(),
            );
            return None;
        };
        self.speed(speed, axis).map(Fault::Slip)
    }
}
