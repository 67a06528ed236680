//! Faults of encoders, signals and the drive.

use stillpoint_machine::AxisKind;
use toml::Spanned;

use super::Resolver;
use super::events::force;
use crate::plant::Fault;
use crate::simulate::file;
use crate::simulate::scenario::{Event, What};

impl Resolver<'_> {
    pub(super) fn faults(&mut self, list: &[file::Fault], events: &mut Vec<Event>) {
        for fault in list {
            let cycle = self.at(&fault.at);
            let until = self.until(fault.until.as_ref(), cycle);
            let sides = self.sides(fault.channel.as_ref());
            let kind = fault.kind.get_ref().as_str();
            let stuck = matches!(kind, "stuck" | "lost");
            self.fault_keys(fault, kind);
            if stuck {
                let Some(signal) = &fault.signal else {
                    let help = format!("name it: signal = \"{}\"", self.drive.words().example);
                    self.add(
                        fault.kind.span(),
                        format!("which signal is {kind}?"),
                        "no signal named",
                        help,
                    );
                    continue;
                };
                let value = fault.value.as_ref().is_some_and(|v| *v.get_ref());
                if let (Some((owners, input)), Some(cycle)) =
                    (self.input(signal, Some(&fault.axis)), cycle)
                {
                    force(events, cycle, until, (&owners, sides), (input, value));
                }
                continue;
            }
            for axis in self.axes(Some(&fault.axis)) {
                let what = match kind {
                    "encoder freeze" => Some(Fault::Freeze),
                    "no braking" => Some(Fault::NoBraking),
                    "encoder offset" => self.offset(fault, axis),
                    "slip" => self.slip(fault, axis),
                    _ => {
                        self.no_such(
                            &fault.kind,
                            "kind of fault",
                            &[
                                "encoder freeze",
                                "encoder offset",
                                "no braking",
                                "slip",
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
            (
                fault.speed.as_ref().map(Spanned::span),
                "speed",
                kind == "slip",
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
