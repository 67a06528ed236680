//! Change of the drive data set: the encoder data that safety reads must be the same in all of them.
//!
//! A difference is no stop that can be acknowledged: STOP A until POWER ON (F01670 with value 10).

config! {
    /// There is nothing to be set.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// A difference was found since POWER ON.
        pub locked: bool,
    }
}

impl State {
    /// Nothing was found.
    pub const INITIAL: Self = Self { locked: false };

    /// Every state is consistent.
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
        /// The data set changes.
        pub changes: bool,
        /// The encoder data of the new set are those of the old one.
        pub same: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// F01670 with value 10 is raised.
        pub fault: bool,
        /// STOP A that cannot be acknowledged.
        pub stop_a: bool,
    }
}

monitor! { sinamics::data_set;
    /// A change to other encoder data is a fault and a STOP A in the same cycle.
    other_data_are_stop_a ["S120-ENC-001"]:
        when |s| s.inputs.changes && !s.inputs.same
            => s.outputs.fault && s.outputs.stop_a && s.after.locked;

    /// A change to the same data, and no change, raise nothing.
    same_data_are_none ["S120-ENC-001"]:
        when |s| !s.inputs.changes || s.inputs.same
            => !s.outputs.fault;

    /// Nothing but POWER ON ends the stop, and it does not where the cause is there again.
    power_on_ends_it ["S120-ENC-001", "S120-PF-06"]:
        when |s| s.before.locked
            => s.outputs.stop_a == (!s.inputs.power_on || s.outputs.fault);

    /// There is none without its cause.
    stop_has_its_cause ["S120-ENC-001"]:
        when |s| !s.before.locked
            => s.outputs.stop_a == s.outputs.fault && s.after.locked == s.outputs.stop_a;
}

pub(crate) fn transition(state: State, _config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let fault = inputs.changes && !inputs.same;
    let locked = fault || state.locked && !inputs.power_on;
    let outputs = Outputs {
        fault,
        stop_a: locked,
    };
    (State { locked }, outputs)
}
