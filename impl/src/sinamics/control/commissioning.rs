//! Commissioning mode: parameters change only with the pulses off, and count only with the right checksum after POWER ON.

config! {
    /// Whether a safety function is enabled.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config {
        pub(crate) enabled: bool,
    } accepted |_config| true
}

impl Config {
    /// `enabled`: p9601 is not 0; without any function the mode is left unchecked.
    pub const fn new(enabled: bool) -> Self {
        Self { enabled }
    }
}

fields! {
    /// Where commissioning is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Operation.
        #[default]
        Operate,
        /// Parameters may be changed.
        Commission,
        /// The mode is left; POWER ON is needed.
        WaitPowerOn,
    }
}

fields! {
    /// F01650 or F30650, acceptance test required: its fault value.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Fault {
        /// None.
        #[default]
        None,
        /// 130: no parameters are there yet.
        NoParameters,
        /// 2000: the checksum of the Control Unit is wrong.
        ChecksumControlUnit,
        /// 2001: the checksum of the Motor Module is wrong.
        ChecksumMotorModule,
        /// 2003: a parameter was changed.
        Changed,
    }
}

impl Fault {
    /// The fault value; 0 without a fault.
    pub const fn value(self) -> u16 {
        match self {
            Self::None => 0,
            Self::NoParameters => 130,
            Self::ChecksumControlUnit => 2000,
            Self::ChecksumMotorModule => 2001,
            Self::Changed => 2003,
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where commissioning is.
        pub phase: Phase,
        /// A parameter was changed since the mode was entered.
        pub changed: bool,
        /// The parameters of the channels are the same: copied since the last change.
        pub copied: bool,
        /// F01650.
        pub fault: Fault,
    }
}

impl State {
    /// Operation.
    pub const INITIAL: Self = Self {
        phase: Phase::Operate,
        changed: false,
        copied: true,
        fault: Fault::None,
    };

    /// In the mode a change is told. p9601 is one of the parameters that may change in it, so nothing is said of it here.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        self.phase != Phase::Commission || !self.changed || self.fault >= Fault::ChecksumControlUnit
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// p0010 = 95 is written.
        pub enter: bool,
        /// The password is right, or none is set.
        pub password: bool,
        /// No safety parameters have been set before.
        pub first: bool,
        /// A safety parameter is written.
        pub write: bool,
        /// p9700 = 57 hex and p9701 = DC hex: the parameters are copied.
        pub copy: bool,
        /// p0010 = 0 is written.
        pub leave: bool,
        /// The reference checksum of the Control Unit is right.
        pub checksum_control_unit: bool,
        /// The reference checksum of the Motor Module is right.
        pub checksum_motor_module: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Pulses off, brake closed; the selection of STO has no effect.
        pub pulses_off: bool,
        /// A01698: the mode is on.
        pub active: bool,
        /// A01693: POWER ON is required.
        pub power_on_required: bool,
        /// The parameter that is written is taken.
        pub accepted: bool,
        /// F01650.
        pub fault: Fault,
    }
}

monitor! { sinamics::commissioning;
    /// Pulses are off from the mode until POWER ON.
    pulses_are_off ["S120-PARAM-007"]:
        when |s| s.after.phase != Phase::Operate
            => s.outputs.pulses_off;

    /// The mode needs the password.
    mode_needs_the_password ["S120-PARAM-006"]:
        when |s| s.after.phase == Phase::Commission && s.before.phase != Phase::Commission
            => s.inputs.enter && s.inputs.password && s.outputs.active;

    /// A parameter is taken in the mode only.
    parameters_change_in_the_mode_only ["S120-PARAM-006"]:
        when |s| s.outputs.accepted
            => s.before.phase == Phase::Commission && s.inputs.write && !s.inputs.power_on && s.outputs.pulses_off;

    /// A change is told until POWER ON, and the channels differ until they are copied.
    change_is_told ["S120-PARAM-007", "S120-PARAM-500"]:
        when |s| s.outputs.accepted && s.after.phase == Phase::Commission
            => s.after.changed && s.outputs.fault >= Fault::ChecksumControlUnit && (s.after.copied == s.inputs.copy);

    /// With a function enabled the mode is left with right checksums and copied parameters only.
    checksums_are_checked ["S120-PARAM-007", "S120-PARAM-500"]:
        when |s| s.before.phase == Phase::Commission && s.after.phase == Phase::WaitPowerOn
            => s.inputs.leave && (!s.config.enabled || (s.inputs.checksum_control_unit && s.inputs.checksum_motor_module
                && s.after.copied));

    /// A wrong checksum keeps the mode, and tells whose it is.
    wrong_checksum_stays ["S120-PARAM-007"]:
        when |s| s.before.phase == Phase::Commission && s.inputs.leave && s.config.enabled && !s.inputs.power_on
            && !(s.inputs.checksum_control_unit && s.inputs.checksum_motor_module)
            => s.after.phase == Phase::Commission
                && s.outputs.fault == if s.inputs.checksum_control_unit {
                    Fault::ChecksumMotorModule
                } else {
                    Fault::ChecksumControlUnit
                };

    /// After the mode POWER ON is required, and nothing else leads back.
    power_on_leads_back ["S120-PARAM-007"]:
        when |s| s.before.phase == Phase::WaitPowerOn && !s.inputs.power_on
            => s.after.phase != Phase::Operate && s.outputs.pulses_off;

    /// POWER ON ends the mode; what was not left rightly is a fault again.
    power_on_ends_the_mode ["S120-PARAM-007"]:
        when |s| s.inputs.power_on
            => s.after.phase == Phase::Operate && !s.outputs.active
                && (s.config.enabled && !(s.inputs.checksum_control_unit && s.inputs.checksum_motor_module))
                    == (s.outputs.fault != Fault::None);

    /// A wrong checksum at POWER ON keeps the pulses off.
    wrong_checksum_gives_no_torque ["S120-PARAM-003"]:
        when |s| s.after.phase == Phase::Operate && s.outputs.fault != Fault::None
            => s.outputs.pulses_off;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S120-PARAM-007"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.fault == s.after.fault
                && s.outputs.active == (s.after.phase == Phase::Commission)
                && s.outputs.power_on_required == (s.after.phase == Phase::WaitPowerOn);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let mut after = state;
    let wrong = match (inputs.checksum_control_unit, inputs.checksum_motor_module) {
        _ if !config.enabled => Fault::None,
        (false, _) => Fault::ChecksumControlUnit,
        (true, false) => Fault::ChecksumMotorModule,
        (true, true) => Fault::None,
    };
    let mut accepted = false;
    if inputs.power_on {
        after = State {
            fault: wrong,
            ..State::INITIAL
        };
    } else if state.phase == Phase::Commission {
        accepted = inputs.write;
        if accepted {
            if !after.changed {
                after.fault = Fault::Changed;
            }
            after.changed = true;
            after.copied = false;
        }
        after.copied |= inputs.copy;
        if inputs.leave {
            if wrong != Fault::None {
                after.fault = wrong;
            } else if after.copied || !config.enabled {
                after.phase = Phase::WaitPowerOn;
            }
        }
    } else if inputs.enter && inputs.password {
        after.phase = Phase::Commission;
        after.changed = false;
        if inputs.first {
            after.fault = Fault::NoParameters;
        }
    }
    let outputs = Outputs {
        pulses_off: after.phase != Phase::Operate || after.fault != Fault::None,
        active: after.phase == Phase::Commission,
        power_on_required: after.phase == Phase::WaitPowerOn,
        accepted,
        fault: after.fault,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-PARAM-007: the fault values as printed.
    #[test]
    fn the_printed_fault_values() {
        assert_eq!(Fault::ALL.map(Fault::value), [0, 130, 2000, 2001, 2003]);
    }
}
