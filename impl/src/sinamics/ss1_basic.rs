//! Safe stop 1 of the Basic Functions: time controlled, in one channel.
//!
//! The time p9652 starts with the first selection and runs to its end, whatever the selection and the speed do; then STO. Braking
//! along OFF3 is the drive's business and done by one channel (S120-ARCH-003); with an external stop the control brakes.

use crate::kernel::Cycles;

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// p9652, in cycles of r9780. 0: SS1 is not enabled, its terminals select STO.
        pub time: Cycles,
        /// p9653: the control brakes (SS1E).
        pub external: bool,
    }
    accepted |_config| true
}

impl Config {
    /// Whether a drive that only one channel has told to brake still does so for the whole p9652: its pulses are suppressed at
    /// p9652 by this channel, and p9650 + p9658 after the selection by STOP A (S120-SS1-006).
    pub fn brakes_on_one_channel(&self, discrepancy: Cycles, stop_f_to_a: Cycles) -> bool {
        u64::from(self.time.count())
            < u64::from(discrepancy.count()) + u64::from(stop_f_to_a.count())
    }
}

fields! {
    /// What SS1 does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing.
        #[default]
        Idle,
        /// The time runs.
        Delay,
        /// It has ended in STO.
        Sto,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What SS1 does.
        pub phase: Phase,
        /// What is left of the time.
        pub left: Cycles,
    }
}

impl State {
    /// Not selected.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        left: Cycles::ZERO,
    };

    /// The time runs exactly in its phase, and is never longer than p9652.
    pub fn invariant(&self, config: &Config) -> bool {
        (self.phase == Phase::Delay) != self.left.is_zero() && self.left <= config.time
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SS1 is selected in this channel.
        pub selected: bool,
        /// STO is selected, or STOP A acts.
        pub sto: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The drive brakes along OFF3.
        pub off3: bool,
        /// SS1 is active (r9773.5, r9773.6): the time runs, or it has ended in STO and is still selected.
        pub active: bool,
        /// SS1 has ended: STO, and SBC where it is enabled.
        pub sto: bool,
    }
}

monitor! { sinamics::ss1_basic;
    /// A selection starts the whole time and OFF3; with an external stop the time only.
    selection_starts_the_time ["S120-SS1-002", "S120-SS1-003", "S120-SS1-009", "S120-SS1-021"]:
        when |s| s.before.phase == Phase::Idle && s.inputs.selected && !s.inputs.sto && !s.config.time.is_zero()
            => s.after.left == s.config.time && s.outputs.active && !s.outputs.sto && s.outputs.off3 != s.config.external;

    /// Each cycle takes one off, selected or not: nothing restarts, stretches or cancels it.
    time_runs_down ["S120-SS1-002", "S120-SS1-004", "S120-SS1-021", "S120-PF-04", "S120-PF-37"]:
        when |s| s.before.phase == Phase::Delay && !s.inputs.sto && s.before.left > Cycles::new(1)
            => s.after.phase == Phase::Delay && s.after.left.count() + 1 == s.before.left.count() && s.outputs.active
                && s.outputs.off3 != s.config.external;

    /// In its last cycle STO acts, for at least this one cycle.
    time_ends_in_sto ["S120-SS1-002", "S120-SS1-003", "S120-SS1-004", "S120-SS1-009", "S120-PF-04"]:
        when |s| s.before.left == Cycles::new(1)
            => s.outputs.sto && s.outputs.active && !s.outputs.off3;

    /// STO and STOP A end a running SS1 at once: nothing of it goes on.
    sto_ends_it ["S120-STO-010", "S120-SS1-021"]:
        when |s| s.inputs.sto
            => !s.outputs.off3 && s.after.left.is_zero();

    /// What is still selected at the end stays off; a deselected one lets go in the cycle after.
    deselection_after_the_end ["S120-SS1-004"]:
        when |s| s.before.phase == Phase::Sto && !s.inputs.sto
            => s.outputs.sto == s.inputs.selected && !s.outputs.off3;

    /// Without a time the terminals mean STO.
    no_time_means_sto ["S120-SS1-001"]:
        when |s| s.config.time.is_zero() && !s.inputs.sto
            => s.outputs.sto == s.inputs.selected && !s.outputs.off3;

    /// STO is reached only by the end of the time, by STO itself, or without a time.
    sto_has_its_reason ["S120-SS1-002", "S120-SS1-003"]:
        when |s| s.outputs.sto && s.before.phase != Phase::Sto && !s.config.time.is_zero()
            => s.inputs.sto || s.before.left == Cycles::new(1);

    /// The status is that of SS1 from its selection to its end, STO included.
    status_lasts_to_the_end ["S120-SS1-008"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.active == (s.after.phase != Phase::Idle) && (s.outputs.active || !s.inputs.selected);

    /// Unselected nothing begins.
    idle_stays_idle ["S120-SS1-001"]:
        when |s| s.before.phase == Phase::Idle && !s.inputs.selected
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// The state stays consistent.
    state_stays_consistent ["S120-SS1-002"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let left = match state.phase {
        Phase::Idle if inputs.selected => config.time,
        Phase::Delay => state.left.tick(),
        _ => Cycles::ZERO,
    };
    let begun = inputs.selected || state.phase == Phase::Delay;
    let phase = if !begun {
        Phase::Idle
    } else if inputs.sto || left.is_zero() {
        Phase::Sto
    } else {
        Phase::Delay
    };
    let runs = phase == Phase::Delay;
    let outputs = Outputs {
        off3: runs && !config.external,
        active: phase != Phase::Idle,
        sto: phase == Phase::Sto,
    };
    let left = if runs { left } else { Cycles::ZERO };
    (State { phase, left }, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(time: u32) -> Config {
        Config {
            time: Cycles::new(time),
            external: false,
        }
    }

    /// S120-SS1-004: deselected on the way it still ends in STO, for one cycle.
    #[test]
    fn a_deselected_stop_ends_in_one_cycle_of_sto() {
        let mut monitor = Monitor::new(config(3));
        let mut inputs = Inputs {
            selected: true,
            sto: false,
        };
        assert!(monitor.step(&inputs).off3);
        inputs.selected = false;
        assert!(monitor.step(&inputs).active);
        assert!(monitor.step(&inputs).active);
        assert!(monitor.step(&inputs).sto);
        assert_eq!(monitor.step(&inputs), Outputs::default());
    }

    /// S120-SS1-006: with p9650 = 500 ms and p9658 = 0 (Table A-5) a ramp of 500 ms is cut short, one of 499 ms is not.
    #[test]
    fn braking_on_one_channel() {
        let discrepancy = Cycles::new(500);
        assert!(config(499).brakes_on_one_channel(discrepancy, Cycles::ZERO));
        assert!(!config(500).brakes_on_one_channel(discrepancy, Cycles::ZERO));
        assert!(config(500).brakes_on_one_channel(discrepancy, Cycles::new(1)));
        assert!(config(1).brakes_on_one_channel(Cycles::new(u32::MAX), Cycles::new(u32::MAX)));
    }
}
