//! Trigger of the extended stop and retract (machine `esr_trigger`): two synchronous actions of the manual's example in one.
//!
//! The retraction itself belongs to the control and is no safety function; a STOP E or STOP F goes on whatever becomes of it.

pub use crate::contract::Stateless as State;

config! {
    /// Nothing is to be configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The program has released the retraction.
        pub released: bool,
        /// STOP E on an axis ($A_STOPESI).
        pub stop_e: bool,
        /// The comparison has found an actual-value fault ($A_XFAULTSI bit 0).
        pub actual_value: bool,
        /// The delay from STOP F to STOP B runs or has expired ($A_XFAULTSI bit 1).
        pub stop_f: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// $AC_ESR_TRIGGER.
        pub trigger: bool,
    }
}

monitor! { sinumerik::esr_trigger;
    /// STOP E, an actual-value fault and a STOP F on its way to STOP B trigger the retraction.
    each_cause_triggers ["S840D-ESR-705"]:
        when |s| s.inputs.released && (s.inputs.stop_e || s.inputs.actual_value || s.inputs.stop_f)
            => s.outputs.trigger;

    /// Not before it is released.
    release_is_needed ["S840D-ESR-705"]:
        when |s| !s.inputs.released
            => !s.outputs.trigger;

    /// Nor without cause.
    no_trigger_without_cause ["S840D-ESR-705"]:
        when |s| !s.inputs.stop_e && !s.inputs.actual_value && !s.inputs.stop_f
            => !s.outputs.trigger;
}

pub(crate) const fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let faults = inputs.actual_value as u8 | ((inputs.stop_f as u8) << 1);
    let trigger = inputs.released && (inputs.stop_e || faults != 0);
    (state, Outputs { trigger })
}
