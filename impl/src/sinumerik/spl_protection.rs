//! Whether the safe logic of one channel is protected or being commissioned (machine `spl_protection`).
//!
//! Each channel has a setting of its own: the NCK the machine datum with the protected actions, the PLC a bit of DB18. Both are
//! read at power-on and never again. Only a protected channel stops for an error of its comparison.

config! {
    /// There is nothing to configure: the settings are inputs.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Commissioning is completed (S840D-SPLKDV-005, S840D-SPLKDV-006).
        pub protected: bool,
        /// An error asks for STOP E instead of STOP D (S840D-SPLKDV-004).
        pub stop_e: bool,
        /// That the channel is not protected has been shown since power-on.
        pub shown: bool,
    }
}

impl State {
    /// Before the first power-on.
    pub const INITIAL: Self = Self {
        protected: false,
        stop_e: false,
        shown: false,
    };

    /// What is protected has nothing to show.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        !(self.protected && self.shown)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of the control.
        pub power_on: bool,
        /// The comparison runs.
        pub running: bool,
        /// NCK: an element of MD 11500 is not 0 ([`lock`]). PLC: DB18.DBX36.0.
        pub lock: bool,
        /// NCK: MD 10097 is 4. PLC: DB18.DBX36.1.
        pub choice: bool,
    }
}

/// Whether the elements of MD 11500 complete the commissioning: one of them is not 0 (S840D-SPLKDV-005).
pub const fn lock(prevent_synact_lock: [u32; 2]) -> bool {
    prevent_synact_lock[0] != 0 || prevent_synact_lock[1] != 0
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Commissioning is completed.
        pub protected: bool,
        /// An error asks for STOP E.
        pub stop_e: bool,
        /// Alarm 27095 is raised in this cycle: the comparison has started without protection (S840D-SPLKDV-008).
        pub alarm_27095: bool,
    }
}

monitor! { sinumerik::spl_protection;
    /// The settings are those of power-on.
    settings_of_power_on ["S840D-SPLKDV-005", "S840D-SPLKDV-006", "S840D-SPLPROT-007"]:
        when |s| s.inputs.power_on
            => s.outputs.protected == s.inputs.lock && s.outputs.stop_e == s.inputs.choice;

    /// A setting that is changed later changes nothing.
    settings_keep_until_power_on ["S840D-SPLPROT-007"]:
        when |s| !s.inputs.power_on
            => s.outputs.protected == s.before.protected && s.outputs.stop_e == s.before.stop_e;

    /// That the protection is missing is shown when the comparison runs for the first time.
    missing_protection_is_shown ["S840D-SPLKDV-008", "S840D-ALARM-725/a"]:
        when |s| s.inputs.running && !s.outputs.protected && (s.inputs.power_on || !s.before.shown)
            => s.outputs.alarm_27095 && s.after.shown;

    /// It is shown once until power-on, and never of a protected channel or without a comparison.
    shown_once ["S840D-SPLKDV-008", "S840D-ALARM-725/a"]:
        when |s| !s.inputs.running || s.outputs.protected || (s.before.shown && !s.inputs.power_on)
            => !s.outputs.alarm_27095 && (s.inputs.power_on || s.after.shown == s.before.shown);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-SPLPROT-007"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.protected == s.after.protected && s.outputs.stop_e == s.after.stop_e;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let settled = if inputs.power_on {
        State {
            protected: inputs.lock,
            stop_e: inputs.choice,
            shown: false,
        }
    } else {
        state
    };
    let alarm_27095 = inputs.running && !settled.protected && !settled.shown;
    let after = State {
        shown: settled.shown || alarm_27095,
        ..settled
    };
    let outputs = Outputs {
        protected: after.protected,
        stop_e: after.stop_e,
        alarm_27095,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-SPLKDV-005.
    #[test]
    fn one_element_protects() {
        assert!(!lock([0, 0]));
        assert!(lock([1, 0]) && lock([0, 1]) && lock([3, 17]));
    }
}
