//! Brakes and loads of hoists.

use stillpoint_machine::AxisKind;
use toml::Spanned;

use super::{BOTH, Resolver};
use crate::plant::Load;
use crate::simulate::file::{self, Names};
use crate::simulate::scenario::{Event, What};

/// The greatest torque of a brake, in percent.
const MOST_TORQUE: u32 = 1_000;
/// The greatest load; 10000 is full load.
const MOST_LOAD: i64 = 20_000;

impl Resolver<'_> {
    /// The axes named, which must have what is simulated of a hoist.
    fn hoists(&mut self, names: &Spanned<Names>, needs: Option<&'static str>) -> Vec<usize> {
        if needs.is_none() {
            let message = format!(
                "nothing of the kind is simulated for {}",
                self.machine.family
            );
            self.add(
                names.span(),
                message,
                "not used",
                "remove this table".to_owned(),
            );
            return Vec::new();
        }
        self.axes_with(Some(names), needs)
    }

    pub(super) fn brakes(&mut self, list: &[file::Brake], events: &mut Vec<Event>) {
        for given in list {
            let cycle = self.at(&given.at);
            let axes = self.hoists(&given.axis, self.drive.words().brakes);
            let number = *given.brake.get_ref();
            if !(1..=2).contains(&number) {
                let message = format!("{number} is no brake");
                self.add(
                    given.brake.span(),
                    message,
                    "no such brake",
                    "allowed: 1 and 2".to_owned(),
                );
                continue;
            }
            let torque = given.torque.as_ref().map_or(Some(100), |text| {
                let percent = text.get_ref().strip_suffix('%');
                let percent = percent.and_then(|number| number.trim().parse::<u32>().ok());
                percent.filter(|n| *n <= MOST_TORQUE)
            });
            if let (Some(text), None) = (&given.torque, torque) {
                let message = format!("\"{}\" is no share of a torque", text.get_ref());
                let help = format!("write for example \"60 %\": 0 % to {MOST_TORQUE} %");
                self.add(text.span(), message, "not such a value", help);
            }
            let (Some(cycle), Some(torque)) = (cycle, torque) else {
                continue;
            };
            events.push(Event {
                cycle,
                axes,
                sides: BOTH,
                what: What::Brake {
                    brake: usize::from(number == 2),
                    torque,
                    stuck: given.stuck,
                },
            });
        }
    }

    pub(super) fn loads(&mut self, list: &[file::Load], events: &mut Vec<Event>) {
        for given in list {
            let cycle = self.at(&given.at);
            let axes = self.hoists(&given.axis, self.drive.words().load);
            let load = *given.load.get_ref();
            if !(0..=MOST_LOAD).contains(&load) {
                let message = format!("a load of {load} is none");
                let help = format!("allowed: 0 to {MOST_LOAD}; 10000 is full load");
                self.add(given.load.span(), message, "out of range", help);
                continue;
            }
            let rests = given.rests.as_ref();
            let rests = rests.and_then(|text| self.length(text, AxisKind::Linear));
            if let Some(cycle) = cycle {
                events.push(Event {
                    cycle,
                    axes,
                    sides: BOTH,
                    what: What::Load(Load { load, rests }),
                });
            }
        }
    }
}
