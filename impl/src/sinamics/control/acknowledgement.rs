//! The internal event of a drive, and which acknowledgement is effective for what.
//!
//! Messages of the Extended Functions are cleared by a safe acknowledgement: the F-DI of p10006, Internal Event ACK of PROFIsafe,
//! or, with p9507.0 = 1, the selection and deselection of STO or SS1. Each is an edge
//! ([`crate::sinamics::acknowledgement_edge`]). Faults of TM54F and CU310-2 need the safe acknowledgement and then one at the
//! Control Unit.
//!
//! One drive is one monitor: the edge of PROFIsafe belongs to this drive's own telegram, that of the F-DI goes to all drives.

config! {
    /// The sources that are enabled.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config {
        pub(crate) input: bool,
        pub(crate) profisafe: bool,
        pub(crate) extended: bool,
    } accepted |_config| true
}

impl Config {
    /// `input`: an F-DI is assigned by p10006. `profisafe`: the drive has a PROFIsafe telegram. `extended`: p9507.0, the extended
    /// acknowledgement. With none of them POWER ON alone acknowledges (S120-ACK-505).
    pub const fn new(input: bool, profisafe: bool, extended: bool) -> Self {
        Self {
            input,
            profisafe,
            extended,
        }
    }

    /// Whether a way remains when the F-DI of p10006 itself is frozen by a discrepancy (S120-ACK-516).
    pub const fn has_another_way(&self) -> bool {
        self.profisafe || self.extended
    }
}

fields! {
    /// What a fault of TM54F or CU310-2 still waits for.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Module {
        /// There is none.
        #[default]
        Fine,
        /// The safe acknowledgement, or the end of the cause.
        Faulty,
        /// The acknowledgement at the Control Unit.
        Waiting,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The internal event.
        pub event: bool,
        /// Faults of TM54F or CU310-2.
        pub module: Module,
    }
}

impl State {
    /// No event, no fault.
    pub const INITIAL: Self = Self {
        event: false,
        module: Module::Fine,
    };

    /// Every state is possible.
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
        /// The edge at the F-DI.
        pub input_edge: bool,
        /// The edge of this drive's Internal Event ACK.
        pub profisafe_edge: bool,
        /// STO or SS1 was selected and is deselected.
        pub reselected: bool,
        /// A safety message comes in this cycle.
        pub message: bool,
        /// The cause of a message is present.
        pub cause: bool,
        /// The cause of a fault of TM54F or CU310-2 is present.
        pub module_cause: bool,
        /// The acknowledgement at the Control Unit.
        pub standard: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Effective for the safety messages and the stops of this drive.
        pub acknowledge: bool,
        /// The internal event: bit 7 of S_ZSW1, S_ZSW2 and S_ZSW1B, r2139.5.
        pub event: bool,
        /// r9722.7, which is 0 at an event (S120-PSAFE-515).
        pub no_event: bool,
        /// Faults of TM54F or CU310-2 are present.
        pub module_fault: bool,
    }
}

impl Inputs {
    /// Whether these edges acknowledge, whatever messages there are: [`Outputs::acknowledge`] of the cycle.
    pub const fn acknowledge(&self, config: &Config) -> bool {
        !self.power_on && (safely(config, self) || (config.extended && self.reselected))
    }
}

/// Whether a safe acknowledgement comes from an enabled source: from the F-DI or PROFIsafe.
const fn safely(config: &Config, inputs: &Inputs) -> bool {
    (config.input && inputs.input_edge) || (config.profisafe && inputs.profisafe_edge)
}

monitor! { sinamics::acknowledgement;
    /// Only an enabled source acknowledges, and not in the cycle of POWER ON.
    enabled_sources_acknowledge ["S120-ACK-501", "S120-ACK-503", "S120-ACK-504", "S120-ACK-505", "S120-PC-09", "S120-PC-11"]:
        when |s| s.outputs.acknowledge || (safely(&s.config, &s.inputs) && !s.inputs.power_on)
            => s.outputs.acknowledge && !s.inputs.power_on && (safely(&s.config, &s.inputs)
                || (s.config.extended && s.inputs.reselected));

    /// STO or SS1 selected and deselected acknowledges with p9507.0 = 1 and only then.
    extended_acknowledgement_is_enabled ["S120-ACK-504", "S120-PC-09"]:
        when |s| s.inputs.reselected && !s.inputs.power_on && !safely(&s.config, &s.inputs)
            => s.outputs.acknowledge == s.config.extended;

    /// A message is an event, whatever is acknowledged in the same cycle.
    message_is_an_event ["S120-ACK-513", "S120-PC-08", "S120-PC-10"]:
        when |s| s.inputs.message
            => s.outputs.event;

    /// The event ends by an effective acknowledgement without a cause, or by POWER ON.
    event_needs_an_acknowledgement ["S120-ACK-513", "S120-PC-09", "S120-PC-10", "S120-ACK-500"]:
        when |s| s.before.event && !s.outputs.event
            => s.inputs.power_on || (s.outputs.acknowledge && !s.inputs.cause);

    /// Without a cause the acknowledgement ends it.
    acknowledgement_ends_the_event ["S120-ACK-501", "S120-ACK-503", "S120-ACK-504"]:
        when |s| s.outputs.acknowledge && !s.inputs.cause && !s.inputs.message
            => !s.outputs.event;

    /// The event is the same on every interface; r9722.7 shows it inverted.
    event_is_shown_everywhere ["S120-PC-08", "S120-PSAFE-515", "S120-PSAFE-512"]:
        when |s| s.outputs.event
            => !s.outputs.no_event && s.after.event;

    /// Without one r9722.7 is 1.
    no_event_is_shown ["S120-PC-08", "S120-PSAFE-515"]:
        when |s| !s.outputs.event
            => s.outputs.no_event && !s.after.event;

    /// Faults of TM54F and CU310-2 end by the acknowledgement at the Control Unit after the safe one, or by POWER ON.
    module_faults_need_both ["S120-TM54F-507", "S120-ACK-502"]:
        when |s| s.before.module != Module::Fine && !s.outputs.module_fault
            => s.inputs.power_on || (s.before.module == Module::Waiting && s.inputs.standard && !s.inputs.module_cause);

    /// The first of the two is a safe one without a cause.
    safe_acknowledgement_comes_first ["S120-TM54F-507", "S120-ACK-502"]:
        when |s| s.before.module == Module::Faulty && s.after.module == Module::Waiting
            => s.outputs.acknowledge && !s.inputs.module_cause;

    /// A cause of such a fault is one.
    module_cause_is_a_fault ["S120-TM54F-507"]:
        when |s| s.inputs.module_cause
            => s.after.module == Module::Faulty && s.outputs.module_fault;

    /// POWER ON acknowledges; what has a cause comes back.
    power_on_acknowledges ["S120-ACK-500"]:
        when |s| s.inputs.power_on
            => s.outputs.event == s.inputs.message && s.outputs.module_fault == s.inputs.module_cause;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let acknowledge = inputs.acknowledge(config);
    let ended = acknowledge && !inputs.cause;
    let event = inputs.message || (before.event && !ended);
    let module = match before.module {
        _ if inputs.module_cause => Module::Faulty,
        Module::Faulty if acknowledge => Module::Waiting,
        Module::Waiting if inputs.standard => Module::Fine,
        module => module,
    };
    let outputs = Outputs {
        acknowledge,
        event,
        no_event: !event,
        module_fault: module != Module::Fine,
    };
    (State { event, module }, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-ACK-505: p9601 = 24 hex, no source: POWER ON alone; with 25 hex the extended acknowledgement too.
    #[test]
    fn without_selection_power_on_acknowledges() {
        let message = Inputs {
            message: true,
            ..Inputs::default()
        };
        let everything = Inputs {
            input_edge: true,
            profisafe_edge: true,
            reselected: true,
            standard: true,
            ..Inputs::default()
        };
        for (extended, event) in [(false, true), (true, false)] {
            let mut drive = Monitor::new(Config::new(false, false, extended));
            assert!(drive.step(&message).event);
            assert_eq!(drive.step(&everything).event, event);
        }
        assert!(!Config::new(true, false, false).has_another_way());
    }
}
