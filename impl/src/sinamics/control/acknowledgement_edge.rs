//! The edge detector of one source of safe acknowledgement.
//!
//! Only the falling edge after a seen rising one acknowledges. The source has to be seen at rest first, after POWER ON and after every
//! interruption: neither a 1 that was there before nor the substitute 0 of a failure is an edge.
//!
//! The source is an F-DI (level 1 = HIGH, 0 = LOW, unsettled else), the bit Internal Event ACK of PROFIsafe, or, for the extended
//! acknowledgement, the selection of STO or SS1 (level 1 = selected).
//!
//! Readings: AC-25 ACK_EDGE_STABLE.

config! {
    /// Nothing is set.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// What was seen of the source.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing since POWER ON or an interruption.
        #[default]
        Unknown,
        /// It rests at 0.
        Idle,
        /// It rose to 1.
        Armed,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What was seen of the source.
        pub phase: Phase,
    }
}

impl State {
    /// Nothing was seen.
    pub const INITIAL: Self = Self {
        phase: Phase::Unknown,
    };

    /// Every phase is possible.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// The source can be read: its values are no substitutes.
        pub valid: bool,
        /// Its two inputs agree and nothing is frozen; always so for a bit of PROFIsafe.
        pub stable: bool,
        /// Its level.
        pub level: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// It acknowledges, in this cycle only.
        pub acknowledge: bool,
        /// It does not rest at 0: an alarm (S120-ACK-501).
        pub not_idle: bool,
    }
}

monitor! { sinamics::acknowledgement_edge;
    /// Nothing but the falling edge after a seen rising one acknowledges.
    only_the_falling_edge ["S120-ACK-501", "S120-ACK-503", "S120-ACK-514", "S120-PC-09"]:
        when |s| s.outputs.acknowledge
            => s.before.phase == Phase::Armed && !s.inputs.level && s.inputs.stable && s.inputs.valid && !s.inputs.power_on
                && s.after.phase == Phase::Idle;

    /// That edge does.
    falling_edge_acknowledges ["S120-ACK-501", "S120-ACK-503"]:
        when |s| s.before.phase == Phase::Armed && !s.inputs.level && s.inputs.stable && s.inputs.valid && !s.inputs.power_on
            => s.outputs.acknowledge;

    /// Failures, their end, and POWER ON acknowledge nothing and forget what was seen.
    interruption_forgets ["S120-ACK-515", "S120-PC-29", "S120-PSAFE-526"]:
        when |s| !s.inputs.valid || (s.inputs.power_on && (s.inputs.level || !s.inputs.stable))
            => !s.outputs.acknowledge && s.after.phase == Phase::Unknown;

    /// A 1 that was there before does not arm: the rest at 0 must be seen.
    rest_is_seen_first ["S120-ACK-515", "S120-ACK-501"]:
        when |s| s.after.phase == Phase::Armed && s.before.phase != Phase::Armed
            => s.before.phase == Phase::Idle && s.inputs.level && s.inputs.stable && !s.inputs.power_on;

    /// Inputs that do not agree change nothing.
    unsettled_level_changes_nothing ["S120-ACK-514", "S120-PC-28"]:
        when |s| !s.inputs.stable && s.inputs.valid && !s.inputs.power_on
            => s.after == s.before && !s.outputs.acknowledge;

    /// The alarm is there while the rest has not been seen and the level is 1.
    missing_rest_is_told ["S120-ACK-501"]:
        when |s| s.outputs.not_idle
            => s.after.phase == Phase::Unknown && s.inputs.level && s.inputs.valid;

    /// A rest is seen.
    rest_is_seen ["S120-ACK-501"]:
        when |s| s.inputs.valid && s.inputs.stable && !s.inputs.level
            => s.after.phase == Phase::Idle;
}

pub(crate) fn transition(state: State, _config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let phase = match (inputs.valid, inputs.stable, inputs.level, before.phase) {
        (false, _, _, _) => Phase::Unknown,
        (true, false, _, phase) => phase,
        (true, true, false, _) => Phase::Idle,
        (true, true, true, Phase::Unknown) => Phase::Unknown,
        (true, true, true, Phase::Idle | Phase::Armed) => Phase::Armed,
    };
    let outputs = Outputs {
        acknowledge: before.phase == Phase::Armed && phase == Phase::Idle,
        not_idle: phase == Phase::Unknown && inputs.valid && inputs.stable && inputs.level,
    };
    (State { phase }, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-ACK-501, S120-ACK-515: 0, 1, 0 acknowledges; a failure in between does not.
    #[test]
    fn a_pulse_acknowledges_and_a_failure_does_not() {
        let mut edge = Monitor::new(Config);
        let mut step = |valid, level| {
            let inputs = Inputs {
                valid,
                level,
                stable: true,
                power_on: false,
            };
            edge.step(&inputs).acknowledge
        };
        let pulses = [true, false, true, false].map(|level| step(true, level));
        assert_eq!(pulses, [false, false, false, true]);
        step(true, true);
        assert!(!step(false, false) && !step(true, false));
    }
}
