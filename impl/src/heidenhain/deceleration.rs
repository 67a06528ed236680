//! dv/dt monitoring of one drive while the emergency ramp of SS1 or SS1F brakes it.
//!
//! After a waiting time an axis must not become faster any more, and a turning spindle must become slower in every cycle.
//! Else the drive does not brake: SS0. A drive without torque coasts; that is no fault.
//!
//! Recommended readings of the manual implemented here: AMB-20 (settled), AMB-21, the waiting time of spindles is a
//! constant that the manual does not print.

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Cycles, Speed};

config! {
    /// The kind of drive and the waiting time.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        spindle: bool,
        wait: Cycles,
        off: bool,
    }
}

impl Config {
    /// `spindle`: a spindle, else an axis. `wait`: how long the emergency ramp may take to begin (SMP530.x of an axis; fixed
    /// for spindles). `off`: the spindle is not watched (SMP560 bit 11, for commissioning).
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(spindle: bool, wait: Cycles, off: bool) -> Result<Self, ConfigError> {
        Ok(Self { spindle, wait, off })
    }

    /// Whether this drive is watched at all.
    const fn watches(&self) -> bool {
        !(self.spindle && self.off)
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The emergency ramp braked in the last cycle.
        pub on: bool,
        /// What is left of the waiting time; 0 without braking.
        pub timer: Cycles,
        /// The speed of the last cycle; 0 without braking.
        pub last: Speed,
    }
}

impl State {
    /// No braking.
    pub const INITIAL: Self = Self {
        on: false,
        timer: Cycles::ZERO,
        last: Speed(0),
    };

    /// Time and speed are kept only while the drive brakes.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.wait && (self.on || *self == Self::INITIAL)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The emergency ramp of SS1 or SS1F brakes the drive.
        pub braking: bool,
        /// The magnitude of the actual speed.
        pub speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::deceleration;
    /// After the waiting time an axis that becomes faster loses its torque in the same cycle.
    faster_axis_loses_its_torque ["HFS-DVDT-001", "HFS-SS1-008"]:
        when |s| !s.config.spindle && s.inputs.braking && s.before.on && s.before.timer.is_zero()
            && s.inputs.speed > s.before.last
            => s.outputs.demand == Stop::Ss0;

    /// An axis that does not become faster is left alone.
    axis_at_the_same_speed_is_left_alone ["HFS-DVDT-001"]:
        when |s| !s.config.spindle && s.inputs.speed <= s.before.last
            => s.outputs.demand == Stop::None;

    /// After the waiting time a turning spindle that does not become slower loses its torque.
    spindle_must_become_slower ["HFS-DVDT-002", "HFS-SS1-008"]:
        when |s| s.config.spindle && !s.config.off && s.inputs.braking && s.before.on
            && s.before.timer.is_zero() && s.inputs.speed >= s.before.last && s.inputs.speed > Speed(0)
            => s.outputs.demand == Stop::Ss0;

    /// A spindle that becomes slower, or stands, is left alone.
    slower_spindle_is_left_alone ["HFS-DVDT-002"]:
        when |s| s.config.spindle && (s.inputs.speed < s.before.last || s.inputs.speed == Speed(0))
            => s.outputs.demand == Stop::None;

    /// SMP560 bit 11 takes the spindle out, never an axis.
    spindle_can_be_taken_out ["HFS-DVDT-003"]:
        when |s| s.config.spindle && s.config.off
            => s.outputs.demand == Stop::None;

    /// Nothing is raised before the waiting time is over, nor in the first cycle, which has no speed to compare with.
    nothing_while_waiting ["HFS-DVDT-001", "HFS-DVDT-005"]:
        when |s| !s.before.on || !s.before.timer.is_zero()
            => s.outputs.demand == Stop::None;

    /// The waiting time starts with the braking and runs to its end.
    waiting_time_runs ["HFS-DVDT-001"]:
        when |s| s.inputs.braking
            => s.after == State {
                on: true,
                timer: if s.before.on { s.before.timer.tick() } else { s.config.wait },
                last: s.inputs.speed,
            };

    /// A drive that coasts without torque is not watched.
    coasting_is_no_fault ["HFS-DVDT-004", "HFS-P-38"]:
        when |s| !s.inputs.braking
            => s.outputs.demand == Stop::None && s.after == State::INITIAL;

    /// The state stays consistent.
    state_stays_consistent ["HFS-DVDT-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.braking {
        return (State::INITIAL, Outputs::default());
    }
    let timer = if state.on {
        state.timer.tick()
    } else {
        config.wait
    };
    let speed = inputs.speed;
    let wrong = if config.spindle {
        speed >= state.last && speed > Speed(0)
    } else {
        speed > state.last
    };
    // What happened before the end of the waiting time is not compared.
    let demand = if config.watches() && state.on && state.timer.is_zero() && wrong {
        Stop::Ss0
    } else {
        Stop::None
    };
    let after = State {
        on: true,
        timer,
        last: speed,
    };
    (after, Outputs { demand })
}
