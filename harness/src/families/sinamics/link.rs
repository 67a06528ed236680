//! What selects the functions of a channel bit by bit, PROFIsafe or the TM54F: the last telegram, its supervision, and which bits count.

use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinamics::communication;
use stillpoint_monitors::sinamics::level::Stop;

use super::signals::{Flag, Number, Read};
use super::values::Values;

/// The link of a channel; without one every bit counts as it is read.
pub(super) struct Link {
    communication: Option<communication::Monitor>,
    /// The last safety telegram.
    received: Read,
    valid: bool,
}

/// What it sees beside the telegram.
pub(super) struct Seen {
    /// A telegram has come in this cycle.
    pub fresh: bool,
    /// The drive has torque.
    pub torque: bool,
    /// A function is active whose stop does not wait for ESR.
    pub undelayed: bool,
    pub acknowledge: bool,
}

impl Link {
    /// At POWER ON, or running, with the telegram that has come before.
    pub(super) fn new(values: &Values, running: bool, read: &Read) -> Self {
        let mut communication = values.communication.map(communication::Monitor::new);
        if let (Some(monitor), true) = (&mut communication, running) {
            let _ = monitor.step(&communication::Inputs {
                telegram: true,
                ..Default::default()
            });
        }
        Self {
            communication,
            received: match running {
                true => *read,
                false => Read::default().number(Number::Limit, i16::MAX.into()),
            },
            valid: running,
        }
    }

    /// What the telegram says counts.
    pub(super) const fn valid(&self) -> bool {
        self.valid
    }

    /// What was sent last, whether it counts or not.
    pub(super) fn sent(&mut self, read: &Read) -> Read {
        if self.communication.is_none() {
            return *read;
        }
        if read.is(Flag::Telegram) {
            self.received = *read;
        }
        read.with_bits_of(&self.received)
    }

    /// The bits that count: of the last telegram, or substitute values; and what the communication asks for.
    ///
    /// A failure that stops the drive along the ramp, or only after ESR, leaves what was selected until the pulses are off: a substitute
    /// value would select STO at once, and there would be no ramp and no retraction (5.5.1, 5.5.2; reading).
    pub(super) fn bits(
        &mut self,
        values: &Values,
        sent: Read,
        seen: &Seen,
    ) -> (Read, communication::Outputs) {
        let Some(communication) = &mut self.communication else {
            self.valid = true;
            return (sent, communication::Outputs::default());
        };
        let said = communication.step(&communication::Inputs {
            power_on: false,
            telegram: seen.fresh && sent.is(Flag::PoweredUp),
            disturbed: false,
            undelayed: seen.undelayed,
            acknowledge: seen.acknowledge,
        });
        self.valid = said.valid;
        // Without SS1 the Basic Functions have no ramp.
        let ramp = values.extended.is_some() || values.ss1_basic.time > Cycles::ZERO;
        let stop_b = said.request == Stop::B && ramp;
        let mut bits = match said.valid || said.esr || stop_b && seen.torque {
            true => sent,
            // No limit of SLS is transferred: the last one stays (the manual has no substitute value for it).
            false => {
                let limit = sent.of(Number::Limit);
                sent.with_bits_of(&Read::default().number(Number::Limit, limit))
            }
        };
        // The Basic Functions have no STOP B: their ramp is that of SS1, which stays selected until the failure is acknowledged.
        if stop_b && values.extended.is_none() {
            bits = bits.flags(&[(Flag::Ss1, false)]);
        }
        (bits, said)
    }
}
