//! Integrity of the program SAFE.SPF (machine `spl_file`).
//!
//! At run-up length and checksum of the file become the reference; afterwards they are formed again and again and compared with
//! it. How the checksum is formed is not the matter of this module: it takes the results. In the commissioning state
//! a change has no consequence. A deviation is an alarm until power-on; it stops nothing by itself.
//!
//! The control writes the checksum into the file as a comment. A protected program whose comment is not its checksum has been
//! changed since then; it is not started.
//!
//! Reading B-37: RUNUP_CHECK_COMMENT.

config! {
    /// There is nothing to configure.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// What has been found of the file, the parameter of alarm 27093.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Deviation {
        /// It is as it was at run-up.
        #[default]
        None,
        /// FILE_LENGTH.
        Length,
        /// FILE_CONTENT.
        Content,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Reference: the length at run-up.
        pub length: u32,
        /// Reference: the checksum at run-up.
        pub sum: u32,
        /// Alarm 27093.
        pub deviation: Deviation,
        /// It is not the program of the last run-up: no start (S840D-SPLPROT-009).
        pub changed: bool,
    }
}

impl State {
    /// Before the first run-up.
    pub const INITIAL: Self = Self {
        length: 0,
        sum: 0,
        deviation: Deviation::None,
        changed: false,
    };

    /// Every state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Run-up of the control.
        pub power_on: bool,
        /// Commissioning of the NCK-SPL is completed.
        pub protected: bool,
        /// A pass of the cyclic check is finished in this cycle.
        pub check: bool,
        /// The length of the file as it is.
        pub length: u32,
        /// The checksum over its content as it is.
        pub sum: u32,
        /// The checksum in its comment, where it has one.
        pub mark: Option<u32>,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Alarm 27093.
        pub alarm_27093: bool,
    }
}

monitor! { sinumerik::spl_file;
    /// Run-up forms the reference and ends the alarm.
    run_up_forms_the_reference ["S840D-SPLPROT-001", "S840D-SPLPROT-009"]:
        when |s| s.inputs.power_on
            => s.after.length == s.inputs.length && s.after.sum == s.inputs.sum && !s.outputs.alarm_27093;

    /// Between two run-ups the reference stays.
    reference_stays ["S840D-SPLPROT-001"]:
        when |s| !s.inputs.power_on
            => s.after.length == s.before.length && s.after.sum == s.before.sum && s.after.changed == s.before.changed;

    /// A check finds every deviation of a protected file, its length first.
    deviation_is_found ["S840D-SPLPROT-001", "S840D-SPLPROT-002", "S840D-ALARM-723"]:
        when |s| s.inputs.check && s.inputs.protected && !s.inputs.power_on && s.before.deviation == Deviation::None
            => s.after.deviation == if s.inputs.length != s.before.length {
                Deviation::Length
            } else if s.inputs.sum != s.before.sum {
                Deviation::Content
            } else {
                Deviation::None
            };

    /// In the commissioning state, and without a check, nothing is found.
    nothing_found_while_commissioning ["S840D-SPLPROT-002"]:
        when |s| (!s.inputs.protected || !s.inputs.check) && s.before.deviation == Deviation::None
            => !s.outputs.alarm_27093;

    /// What was found stays until power-on.
    alarm_until_power_on ["S840D-SPLPROT-002", "S840D-ALARM-723"]:
        when |s| s.before.deviation != Deviation::None && !s.inputs.power_on
            => s.outputs.alarm_27093 && s.after.deviation == s.before.deviation;

    /// A protected program must have its own checksum in it at run-up.
    own_checksum_at_run_up ["S840D-SPLPROT-009"]:
        when |s| s.inputs.power_on
            => s.after.changed == (s.inputs.protected && s.inputs.mark != Some(s.inputs.sum));

    /// The alarm shows the state.
    alarm_is_the_state ["S840D-SPLPROT-002"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.alarm_27093 == (s.after.deviation != Deviation::None);
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = if inputs.power_on {
        State {
            length: inputs.length,
            sum: inputs.sum,
            deviation: Deviation::None,
            changed: inputs.protected && inputs.mark.is_none_or(|mark| mark != inputs.sum),
        }
    } else if inputs.check && inputs.protected && state.deviation == Deviation::None {
        State {
            deviation: match (inputs.length == state.length, inputs.sum == state.sum) {
                (false, _) => Deviation::Length,
                (true, false) => Deviation::Content,
                (true, true) => Deviation::None,
            },
            ..state
        }
    } else {
        state
    };
    let outputs = Outputs {
        alarm_27093: after.deviation != Deviation::None,
    };
    (after, outputs)
}
