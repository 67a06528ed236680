//! STOP F and STOP A of the Basic Functions.
//!
//! A failed cross-check (F01611) is STOP A after p9658; every other fault of the Basic Functions (F01600) is STOP A at once. The
//! internal acknowledgement, STO or SS1 deselected in both channels once the cause is gone, ends the stop; the message stays until
//! the general acknowledgement that follows. The edge of Internal Event ACK over PROFIsafe does both.
//!
//! Readings: AC-24 F_BF_ALWAYS.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The time from STOP F to STOP A (p9658); 0: at once, which is the factory setting.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) delay: Cycles,
    }
}

impl Config {
    /// `delay`: p9658 in cycles of r9780.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] above [`Cycles::SIXTY_SECONDS`].
    pub fn new(delay: Cycles) -> Result<Self, ConfigError> {
        Ok(Self {
            delay: delay.at_most(Cycles::SIXTY_SECONDS)?,
        })
    }
}

fields! {
    /// The latched stop.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Latched {
        /// None.
        #[default]
        None,
        /// STOP F.
        F,
        /// STOP A.
        A,
        /// STOP A that POWER ON alone acknowledges (S120-STOP-001).
        Locked,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The latched stop.
        pub stop: Latched,
        /// What is left until STOP F is STOP A.
        pub timer: Cycles,
        /// A fault is in the fault buffer.
        pub entered: bool,
        /// STO or SS1 was selected in the last cycle.
        pub selected: bool,
    }
}

impl State {
    /// No stop; selected, so that a deselection can come.
    pub const INITIAL: Self = Self {
        stop: Latched::None,
        timer: Cycles::ZERO,
        entered: false,
        selected: true,
    };

    /// The timer runs exactly with STOP F; no stop is without its message.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.delay
            && (self.stop == Latched::F) != self.timer.is_zero()
            && (self.stop == Latched::None || self.entered)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// The cross-check finds a difference: also terminals that differ too long, or switch too often.
        pub difference: bool,
        /// A fault with STOP A is present.
        pub fault: bool,
        /// A fault that may not be acknowledged is present.
        pub locking: bool,
        /// STO or SS1 is selected in one of the channels.
        pub selected: bool,
        /// The general acknowledgement of faults (p2103).
        pub acknowledge: bool,
        /// The edge of Internal Event ACK over PROFIsafe.
        pub internal_event_ack: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The latched stop.
        pub stop: Latched,
        /// Pulses off.
        pub pulses_off: bool,
        /// A fault is in the fault buffer: no start before it is acknowledged.
        pub entered: bool,
    }
}

/// Whether the cause of a fault is present.
const fn caused(inputs: &Inputs) -> bool {
    inputs.difference || inputs.fault || inputs.locking
}

monitor! { sinamics::basic_stop;
    /// A fault with STOP A takes the pulses at once, whatever is acknowledged.
    fault_takes_the_pulses_at_once ["S120-STOP-500", "S120-PC-02", "S120-PC-10"]:
        when |s| s.inputs.fault || s.inputs.locking
            => s.outputs.pulses_off && s.after.stop >= Latched::A;

    /// STOP F is STOP A when p9658 is over; at once where it is 0. Whether anything is selected makes no difference.
    stop_f_becomes_a_in_time ["S120-STOP-505", "S120-STOP-506", "S120-CTRL-507"]:
        when |s| s.inputs.difference || s.before.stop == Latched::F
            => s.after.stop >= Latched::A || s.after.stop == Latched::None
                || (s.after.timer == if s.before.stop == Latched::F && !s.inputs.power_on {
                    s.before.timer.tick()
                } else {
                    s.config.delay
                });

    /// A difference is latched, also in a cycle in which something is acknowledged.
    difference_is_latched ["S120-STOP-505", "S120-PC-10", "S120-CTRL-507"]:
        when |s| s.inputs.difference
            => s.after.stop >= Latched::F && s.outputs.entered;

    /// The stop ends by a deselection, or by the edge over PROFIsafe, and never with a cause.
    stop_ends_without_cause_only ["S120-ACK-506", "S120-STO-004", "S120-PC-01", "S120-PC-09"]:
        when |s| s.before.stop != Latched::None && s.after.stop < s.before.stop
            => s.inputs.power_on || (!caused(&s.inputs) && s.before.stop != Latched::Locked
                && (s.inputs.internal_event_ack || (s.before.selected && !s.inputs.selected)));

    /// A stop that may not be acknowledged stays until POWER ON.
    locked_stop_stays ["S120-ACK-506", "S120-PC-01"]:
        when |s| s.before.stop == Latched::Locked && !s.inputs.power_on
            => s.after.stop == Latched::Locked && s.outputs.pulses_off && s.outputs.entered;

    /// The deselection ends the stop, not the message.
    deselection_acknowledges_internally ["S120-STO-004", "S120-ACK-506"]:
        when |s| s.before.selected && !s.inputs.selected && !caused(&s.inputs) && !s.inputs.power_on
            && s.before.stop != Latched::None && s.before.stop != Latched::Locked && !s.inputs.internal_event_ack
            => s.after.stop == Latched::None && !s.outputs.pulses_off && s.outputs.entered;

    /// The general acknowledgement alone does not clear a stop or the message of one: it has to follow.
    general_acknowledgement_comes_second ["S120-ACK-506"]:
        when |s| s.before.entered && !s.outputs.entered && !s.inputs.power_on
            => s.after.stop == Latched::None
                && (s.inputs.internal_event_ack || (s.inputs.acknowledge && s.before.stop == Latched::None));

    /// Once the stop has gone it clears the message, whatever is selected.
    general_acknowledgement_clears ["S120-ACK-506", "S120-STO-004"]:
        when |s| s.inputs.acknowledge && s.before.stop == Latched::None && !caused(&s.inputs)
            => !s.outputs.entered;

    /// The edge over PROFIsafe clears both.
    edge_clears_both ["S120-ACK-503", "S120-ACK-506"]:
        when |s| s.inputs.internal_event_ack && !caused(&s.inputs) && s.before.stop != Latched::Locked
            => s.after.stop == Latched::None && !s.outputs.entered;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S120-STOP-500"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.stop == s.after.stop && s.outputs.entered == s.after.entered
                && s.outputs.pulses_off == (s.after.stop >= Latched::A);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let mut after = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let none = after.stop == Latched::None;
    let deselected = after.selected && !inputs.selected;
    after.selected = inputs.selected;
    if after.stop == Latched::F {
        after.timer = after.timer.tick();
        if after.timer.is_zero() {
            after.stop = Latched::A;
        }
    }
    if caused(inputs) {
        after.entered = true;
    } else if after.stop != Latched::Locked {
        if deselected || inputs.internal_event_ack {
            after.stop = Latched::None;
            after.timer = Cycles::ZERO;
        }
        after.entered &= !((inputs.acknowledge && none) || inputs.internal_event_ack);
    }
    if inputs.difference && after.stop == Latched::None {
        after.timer = config.delay;
        after.stop = if config.delay.is_zero() {
            Latched::A
        } else {
            Latched::F
        };
    }
    let demanded = if inputs.locking {
        Latched::Locked
    } else if inputs.fault {
        Latched::A
    } else {
        Latched::None
    };
    if demanded > after.stop {
        after.stop = demanded;
        after.timer = Cycles::ZERO;
    }
    let outputs = Outputs {
        stop: after.stop,
        pulses_off: after.stop >= Latched::A,
        entered: after.entered,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-STOP-505, S120-CTRL-507: p9658 = 0 is the factory setting, STOP A at once.
    #[test]
    fn stop_f_is_stop_a_at_once_by_default() {
        let mut stop = Monitor::new(Config::new(Cycles::ZERO).expect("short"));
        let difference = Inputs {
            difference: true,
            ..Inputs::default()
        };
        assert!(stop.step(&difference).pulses_off);
        let acknowledge = Inputs {
            acknowledge: true,
            ..Inputs::default()
        };
        assert!(stop.step(&acknowledge).pulses_off, "it is not deselected");
        let selected = Inputs {
            selected: true,
            ..Inputs::default()
        };
        stop.step(&selected);
        let deselected = stop.step(&Inputs::default());
        assert!(!deselected.pulses_off && deselected.entered);
        assert!(!stop.step(&acknowledge).entered);
    }
}
