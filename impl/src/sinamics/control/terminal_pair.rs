//! One request over the two terminals of the Basic Functions, as one of the two channels sees it.
//!
//! A channel acts on its own terminal at once. If the two differ for the tolerance time p9650, that is a fault, F01611 or F30611,
//! and STOP F of the Basic Functions ([`crate::sinamics::basic_stop`]). A skew that ends in time, in whichever state, is no
//! message.
//!
//! Levels are filtered ([`crate::sinamics::input_filter`]); 1 deselects, 0 selects.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The tolerance time p9650.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) tolerance: Cycles,
    }
}

impl Config {
    /// `tolerance`: how long the terminals may differ, in cycles.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when it is 0: no two terminals switch in the same cycle for certain.
    pub const fn new(tolerance: Cycles) -> Result<Self, ConfigError> {
        if tolerance.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self { tolerance })
    }
}

fields! {
    /// What is known of the terminals.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// They agree.
        #[default]
        Agreed,
        /// They differ; the tolerance time runs.
        Skew,
        /// They differed for longer.
        Fault,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is known of the terminals.
        pub phase: Phase,
        /// What is left of the tolerance time.
        pub timer: Cycles,
    }
}

impl State {
    /// No difference.
    pub const INITIAL: Self = Self {
        phase: Phase::Agreed,
        timer: Cycles::ZERO,
    };

    /// The timer runs exactly while the terminals differ without a fault.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.tolerance && (self.phase == Phase::Skew) != self.timer.is_zero()
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// The level of this channel's terminal.
        pub own: bool,
        /// The level of the other channel's terminal, as received.
        pub other: bool,
        /// The Extended Functions hold STO: nothing is compared (S120-TEST-005).
        pub held: bool,
        /// The fault is acknowledged.
        pub acknowledge: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// This channel selects the function.
        pub selected: bool,
        /// Both channels select it: what r9773 shows as active.
        pub both: bool,
        /// The fault is raised in this cycle: STOP F.
        pub raised: bool,
        /// The fault is present.
        pub fault: bool,
    }
}

monitor! { sinamics::terminal_pair;
    /// The own terminal alone selects, in the same cycle; nothing else ever deselects it.
    own_terminal_selects_at_once ["S120-CTRL-504", "S120-CTRL-510", "S120-CTRL-503", "S120-PC-13", "S120-PC-28"]:
        when |s| !s.inputs.own || !s.outputs.selected
            => s.outputs.selected != s.inputs.own;

    /// Active is what both channels select.
    both_must_agree ["S120-DIAG-503", "S120-CTRL-503"]:
        when |s| s.outputs.both
            => !s.inputs.own && !s.inputs.other;

    /// Terminals that differ for the tolerance time are a fault.
    lasting_difference_is_a_fault ["S120-CTRL-507", "S120-PC-28"]:
        when |s| s.before.phase == Phase::Skew && s.before.timer <= Cycles::new(1) && s.inputs.own != s.inputs.other
            && !s.inputs.held && !s.inputs.power_on
            => s.after.phase == Phase::Fault && s.outputs.raised;

    /// A fault comes from a difference that has lasted, and from nothing else.
    short_difference_is_no_fault ["S120-CTRL-507", "S120-CTRL-510"]:
        when |s| s.outputs.raised
            => s.before.phase == Phase::Skew && s.before.timer <= Cycles::new(1) && s.inputs.own != s.inputs.other
                && !s.inputs.held && !s.inputs.power_on && s.outputs.fault;

    /// The tolerance time begins with the difference, is not begun again while it lasts, and not waited out when it ends.
    tolerance_is_counted_once ["S120-CTRL-507"]:
        when |s| s.after.phase == Phase::Skew
            => s.inputs.own != s.inputs.other && s.after.timer == if s.before.phase == Phase::Skew && !s.inputs.power_on {
                s.before.timer.tick()
            } else {
                s.config.tolerance
            };

    /// A difference is always watched, unless the Extended Functions hold STO.
    difference_is_watched ["S120-CTRL-507", "S120-TEST-005"]:
        when |s| s.inputs.own != s.inputs.other
            => (s.after.phase == Phase::Agreed) == (s.inputs.held && (s.before.phase != Phase::Fault || s.inputs.power_on));

    /// The fault stays until both terminals deselect and it is acknowledged, or POWER ON.
    fault_needs_deselection_and_acknowledgement ["S120-CTRL-507", "S120-ACK-506", "S120-PC-09"]:
        when |s| s.before.phase == Phase::Fault && s.after.phase != Phase::Fault
            => s.inputs.power_on || (s.inputs.acknowledge && s.inputs.own && s.inputs.other);

    /// Once both deselect the acknowledgement is heard.
    acknowledgement_is_heard ["S120-ACK-506"]:
        when |s| s.before.phase == Phase::Fault && s.inputs.acknowledge && s.inputs.own && s.inputs.other
            => s.after == State::INITIAL && !s.outputs.fault;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S120-CTRL-507"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.fault == (s.after.phase == Phase::Fault);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let differ = inputs.own != inputs.other;
    let cleared = inputs.acknowledge && inputs.own && inputs.other;
    let after = match before.phase {
        Phase::Fault if cleared => State::INITIAL,
        Phase::Fault => before,
        Phase::Agreed | Phase::Skew if !differ || inputs.held => State::INITIAL,
        Phase::Agreed => State {
            phase: Phase::Skew,
            timer: config.tolerance,
        },
        Phase::Skew => {
            let timer = before.timer.tick();
            let phase = if timer.is_zero() {
                Phase::Fault
            } else {
                Phase::Skew
            };
            State { phase, timer }
        }
    };
    let fault = after.phase == Phase::Fault;
    let outputs = Outputs {
        selected: !inputs.own,
        both: !inputs.own && !inputs.other,
        raised: fault && before.phase != Phase::Fault,
        fault,
    };
    (after, outputs)
}

/// Whether parallel power units deselect: all inputs that are used are 1 (S120-CTRL-513). `used`: the inputs p9620\[0..7\] that
/// are connected, by bit; of none connected nothing is deselected.
pub const fn all_deselect(levels: u8, used: u8) -> bool {
    used != 0 && levels & used == used
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-CTRL-507, S120-CTRL-510: p9650 = 500 ms (table A-5) in a cycle of 4 ms.
    #[test]
    fn terminals_may_differ_for_half_a_second() {
        let cycle = core::num::NonZeroU32::new(4_000).expect("not zero");
        let tolerance = Cycles::from_millis_up(500, cycle).expect("short");
        let mut pair = Monitor::new(Config::new(tolerance).expect("some"));
        let mut step = |own, other| {
            pair.step(&Inputs {
                own,
                other,
                ..Inputs::default()
            })
        };
        for _ in 0..125 {
            let outputs = step(false, true);
            assert!(outputs.selected && !outputs.both && !outputs.fault);
        }
        assert!(step(false, true).raised);
        assert!(step(true, true).fault, "nobody has acknowledged it");
    }

    /// S120-CTRL-513.
    #[test]
    fn parallel_power_units_deselect_together() {
        assert!(all_deselect(0b111, 0b111) && all_deselect(0b1111, 0b111));
        assert!(!all_deselect(0b101, 0b111) && !all_deselect(0xff, 0));
    }
}
