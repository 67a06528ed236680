//! Two-channel control of a holding brake (machine `brake_control`).
//!
//! An output of the NCK switches the positive line, one of the PLC the negative one; the brake is released by both. What the
//! PLC adds behind the compared variable only closes the brake sooner.

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
        /// NCK: STOP A or B is active.
        pub stop_ab_nck: bool,
        /// NCK: power is enabled on the axis ($VA_DPE).
        pub power_enabled: bool,
        /// NCK: no EMERGENCY STOP.
        pub no_halt_nck: bool,
        /// PLC: STOP A or B is active (DBX111.4).
        pub stop_ab_plc: bool,
        /// PLC: the pulses are safely cancelled (DBX108.2).
        pub pulses_cancelled: bool,
        /// PLC: the pulses are enabled (DBX93.7).
        pub pulses_enabled: bool,
        /// PLC: the speed controller is active (DBX61.6).
        pub speed_control: bool,
        /// PLC: no EMERGENCY STOP.
        pub no_halt_plc: bool,
        /// PLC: the position controller is active (DBX61.5).
        pub position_control: bool,
        /// PLC: the NCK is ready (DB10.DBX104.7).
        pub nck_ready: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// $A_OUTSE: the output of the NCK.
        pub outse: bool,
        /// $A_OUTSEP: what the comparison holds against it.
        pub outsep: bool,
        /// The output of the PLC.
        pub plc: bool,
        /// Both lines are switched: the brake is released.
        pub released: bool,
    }
}

monitor! { sinumerik::brake_control;
    /// The output of the NCK needs the absence of STOP A and B and of an EMERGENCY STOP, and the power.
    nck_output ["S840D-BRAKE-714"]:
        when |s| s.outputs.outse
            => !s.inputs.stop_ab_nck && s.inputs.power_enabled && s.inputs.no_halt_nck;

    /// The compared variable of the PLC needs what is the same on its side.
    plc_variable ["S840D-BRAKE-715"]:
        when |s| s.outputs.outsep
            => !s.inputs.stop_ab_plc && !s.inputs.pulses_cancelled && s.inputs.pulses_enabled && s.inputs.no_halt_plc;

    /// With a speed controller that is off the brake is closed, in the compared variable already.
    speed_controller_counts ["S840D-BRAKE-715", "S840D-BRAKE-716"]:
        when |s| !s.inputs.speed_control
            => !s.outputs.outsep && !s.outputs.released;

    /// The position controller and the readiness of the NCK close the brake sooner, and leave the compared variables alone.
    later_conditions_only_close ["S840D-BRAKE-715", "S840D-BRAKE-716"]:
        when |s| !s.inputs.position_control || !s.inputs.nck_ready
            => !s.outputs.plc && {
                let inputs = Inputs { position_control: true, nck_ready: true, ..s.inputs };
                let (_, other) = transition(State, &s.config, &inputs);
                other.outse == s.outputs.outse && other.outsep == s.outputs.outsep
            };

    /// Either channel closes the brake.
    both_release ["S840D-BRAKE-714", "S840D-BRAKE-715"]:
        when |s| s.outputs.released
            => s.outputs.outse && s.outputs.outsep && s.outputs.plc;

    /// Where nothing speaks against it the brake is released.
    releases ["S840D-BRAKE-714", "S840D-BRAKE-715"]:
        when |s| s.inputs == (Inputs { stop_ab_nck: false, power_enabled: true, no_halt_nck: true, stop_ab_plc: false,
            pulses_cancelled: false, pulses_enabled: true, speed_control: true, no_halt_plc: true, position_control: true,
            nck_ready: true })
            => s.outputs.released;
}

pub(crate) fn transition(state: State, _config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let closed_by_nck = inputs.stop_ab_nck || !inputs.power_enabled || !inputs.no_halt_nck;
    let powered = inputs.pulses_enabled && !inputs.pulses_cancelled && inputs.speed_control;
    let outsep = powered && inputs.no_halt_plc && !inputs.stop_ab_plc;
    let plc = outsep && inputs.position_control && inputs.nck_ready;
    let outputs = Outputs {
        outse: !closed_by_nck,
        outsep,
        plc,
        released: plc && !closed_by_nck,
    };
    (state, outputs)
}
