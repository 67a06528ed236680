//! Brake test in the NC: reduced torque, position window, fixed stop (machine `brake_load`).
//!
//! While the test is active the torque of the drive is limited, which [`crate::sinumerik::brake_torque`] computes, and the
//! position is watched from the start of the test on. What ends the test gives the axis back to its position control.
//!
//! A traversing motion in the wrong direction is told and ends nothing (S840D-BRAKE-705).

use crate::kernel::{Distance, Position};

config! {
    /// The test as configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        enabled: bool,
        window: Distance,
        threshold: Distance,
    }
    accepted |config| *config == Config::new(config.enabled, config.window, config.threshold)
}

impl Config {
    /// `enabled`: bit 1 of FIXED_STOP_MODE. `window`: how far the axis may move in the test (SAFE_BRAKETEST_POS_TOL).
    /// `threshold`: the contour deviation beyond which it stands against the brake (FIXED_STOP_THRESHOLD).
    pub const fn new(enabled: bool, window: Distance, threshold: Distance) -> Self {
        Self {
            enabled,
            window,
            threshold,
        }
    }
}

/// Why a test was aborted or not begun: the additional information of alarm 20096.
pub mod info {
    /// The axis is neither a PLC axis nor a command axis.
    pub const NO_PLC_AXIS: u8 = 1;
    /// Limit position reached, motion stopped.
    pub const END_REACHED: u8 = 2;
    /// NC-RESET.
    pub const RESET: u8 = 3;
    /// The position has left the window.
    pub const WINDOW_LEFT: u8 = 4;
    /// The drive rejects the torque reduction.
    pub const REJECTED: u8 = 5;
    /// The PLC has withdrawn an enable.
    pub const ENABLE_WITHDRAWN: u8 = 6;
}

fields! {
    /// Additional information of alarm 20096: 0 for no alarm, else one of [`info`].
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Info(u8) in 0..=6;
}

impl Info {
    /// No alarm.
    pub const NONE: Self = Self(0);

    /// The number.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn get(self) -> u8 {
        self.0
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// DBX71.0: the test is active; the torque is reduced.
        pub active: bool,
        /// DBX62.5: the axis stands against the brake.
        pub reached: bool,
        /// The PLC has traversed the axis in this test.
        pub moved: bool,
        /// Where the test began.
        pub begun: Position,
        /// The selection in the cycle before.
        pub held: bool,
    }
}

impl State {
    /// No test.
    pub const INITIAL: Self = Self {
        active: false,
        reached: false,
        moved: false,
        begun: Position(0),
        held: false,
    };

    /// Without test there is nothing of one; the fixed stop is reached by moving only.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        (!self.reached || self.moved)
            && if self.active {
                self.held
            } else {
                !self.moved && self.begun == Position(0)
            }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The PLC asks for the test.
        pub select: bool,
        /// The torque cannot be had.
        pub unattainable: bool,
        /// The test must go in the direction of the load.
        pub along: bool,
        /// Travel to fixed stop or with limited torque is active on the axis.
        pub fixed_active: bool,
        /// The axis is a PLC or command axis.
        pub plc_axis: bool,
        /// Limit position reached, motion stopped.
        pub end_reached: bool,
        /// NC-RESET.
        pub reset: bool,
        /// The position.
        pub position: Position,
        /// The drive rejects the torque reduction.
        pub rejected: bool,
        /// The PLC gives the enables of the axis.
        pub enables: bool,
        /// The PLC traverses the axis.
        pub travel: bool,
        /// It does so in the direction of the load.
        pub towards_load: bool,
        /// Contour deviation.
        pub deviation: Distance,
        /// The drive gives all the torque that it may.
        pub at_limit: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Alarm 20096 with its additional information.
        pub info: Info,
        /// Alarm 20092: travel to fixed stop is still active.
        pub still_active: bool,
        /// Alarm 20097: the brake is loaded in the wrong direction.
        pub wrong_direction: bool,
        /// Contour monitoring is suspended.
        pub contour_off: bool,
        /// Standstill monitoring is suspended.
        pub standstill_off: bool,
    }
}

monitor! { sinumerik::brake_load;
    /// An axis that leaves the window ends the test in the same cycle.
    window_ends_the_test ["S840D-BRAKE-706", "S840D-PARAM-036/a", "S840D-PARAM-036/c"]:
        when |s| s.before.active && s.inputs.position.distance(s.before.begun) > s.config.window
            => !s.after.active && !s.after.reached && !s.outputs.contour_off && !s.outputs.standstill_off;

    /// That it did so is told, unless a cause with a lower number is.
    window_is_told ["S840D-BRAKE-706"]:
        when |s| s.before.active && s.inputs.select && s.inputs.position.distance(s.before.begun) > s.config.window
            && s.inputs.plc_axis && !s.inputs.end_reached && !s.inputs.reset
            => s.outputs.info.get() == info::WINDOW_LEFT;

    /// The window lies where the axis was when the test began.
    window_stays_in_its_place ["S840D-BRAKE-706"]:
        when |s| s.after.active
            => s.after.begun == if s.before.active { s.before.begun } else { s.inputs.position };

    /// A test needs its function, no other travel to fixed stop, an attainable torque, a PLC axis and its enables.
    begins_only_if_possible ["S840D-BRAKE-701", "S840D-BRAKE-703", "S840D-BRAKE-710", "S840D-BRAKE-711", "S840D-PARAM-036/a"]:
        when |s| s.after.active && !s.before.active
            => s.inputs.select && !s.before.held && s.config.enabled && !s.inputs.fixed_active && !s.inputs.unattainable
                && s.inputs.plc_axis && s.inputs.enables;

    /// And begins then, at the rise of its selection.
    begins_if_possible ["S840D-BRAKE-701", "S840D-BRAKE-708"]:
        when |s| s.inputs.select && !s.before.held && s.config.enabled && !s.inputs.fixed_active && !s.inputs.unattainable
            && s.inputs.plc_axis && s.inputs.enables
            => s.after.active && s.outputs.info == Info::NONE;

    /// The axis stays one of the PLC, and enabled, for the whole test.
    conditions_hold_throughout ["S840D-BRAKE-710"]:
        when |s| s.after.active
            => s.inputs.select && s.inputs.plc_axis && s.inputs.enables
                && (!s.before.active || !(s.inputs.reset || s.inputs.end_reached || s.inputs.rejected));

    /// What aborts a test is told by its number, the least of several.
    abort_is_told ["S840D-BRAKE-706", "S840D-BRAKE-710"]:
        when |s| s.before.active && s.inputs.select && !s.after.active
            => match s.outputs.info.get() {
                info::NO_PLC_AXIS => !s.inputs.plc_axis,
                info::END_REACHED => s.inputs.end_reached && s.inputs.plc_axis,
                info::RESET => s.inputs.reset && !s.inputs.end_reached,
                info::WINDOW_LEFT => s.inputs.position.distance(s.before.begun) > s.config.window && !s.inputs.reset,
                info::REJECTED => s.inputs.rejected && s.inputs.position.distance(s.before.begun) <= s.config.window,
                info::ENABLE_WITHDRAWN => !s.inputs.enables && !s.inputs.rejected,
                _ => false,
            };

    /// A refused or aborted test does not begin again by itself.
    begins_by_a_new_selection ["S840D-BRAKE-708"]:
        when |s| s.before.held && !s.before.active
            => !s.after.active;

    /// The axis stands against the brake when it was moved there, the deviation is beyond the threshold and the torque at its limit.
    fixed_stop_is_found ["S840D-BRAKE-707"]:
        when |s| s.after.active && s.before.active
            => s.after.reached == (s.before.reached
                || (s.inputs.travel && s.inputs.deviation > s.config.threshold && s.inputs.at_limit));

    /// Not in the cycle in which the test begins.
    fixed_stop_comes_later ["S840D-BRAKE-707"]:
        when |s| !s.before.active
            => !s.after.reached;

    /// A load that is not the parameterised one, pressed the other way, is told.
    wrong_direction_is_told ["S840D-BRAKE-705"]:
        when |s| s.after.active && s.inputs.along && s.inputs.travel
            => s.outputs.wrong_direction != s.inputs.towards_load;

    /// And nothing else is.
    direction_matters_to_the_test_only ["S840D-BRAKE-705"]:
        when |s| !s.after.active || !s.inputs.along || !s.inputs.travel
            => !s.outputs.wrong_direction;

    /// Contour monitoring is off exactly in the test, standstill monitoring from the first motion in it on.
    monitoring_is_suspended ["S840D-BRAKE-711"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.contour_off == s.after.active && s.outputs.standstill_off == s.after.moved
                && (!s.after.moved || s.before.moved || s.inputs.travel);

    /// Travel to fixed stop that is still active is told, and has the test refused.
    other_travel_is_told ["S840D-BRAKE-701", "S840D-BRAKE-711"]:
        when |s| s.inputs.select && !s.before.held && s.config.enabled && s.inputs.fixed_active
            => s.outputs.still_active && !s.after.active;

    /// The step keeps the invariant.
    state_stays_consistent ["S840D-BRAKE-706"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.held == s.inputs.select;
}

/// What ends an active test, or 0.
fn abort(state: &State, config: &Config, inputs: &Inputs) -> u8 {
    let causes = [
        (!inputs.plc_axis, info::NO_PLC_AXIS),
        (inputs.end_reached, info::END_REACHED),
        (inputs.reset, info::RESET),
        (
            inputs.position.distance(state.begun) > config.window,
            info::WINDOW_LEFT,
        ),
        (inputs.rejected, info::REJECTED),
        (!inputs.enables, info::ENABLE_WITHDRAWN),
    ];
    let first = causes.iter().find(|(present, _)| *present);
    first.map_or(0, |(_, number)| *number)
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let mut outputs = Outputs::default();
    let idle = State {
        held: inputs.select,
        ..State::INITIAL
    };
    let mut after = idle;
    if state.active && inputs.select {
        let cause = abort(&state, config, inputs);
        outputs.info = Info(cause);
        if cause == 0 {
            let stands = inputs.travel && inputs.at_limit && inputs.deviation > config.threshold;
            after = State {
                reached: state.reached || stands,
                moved: state.moved || inputs.travel,
                ..state
            };
        }
    } else if inputs.select && !state.held && config.enabled {
        outputs.still_active = inputs.fixed_active;
        if !inputs.fixed_active && !inputs.unattainable {
            if !inputs.plc_axis {
                outputs.info = Info(info::NO_PLC_AXIS);
            } else if !inputs.enables {
                outputs.info = Info(info::ENABLE_WITHDRAWN);
            } else {
                after.active = true;
                after.begun = inputs.position;
            }
        }
    }
    outputs.wrong_direction = after.active && inputs.along && inputs.travel && !inputs.towards_load;
    outputs.contour_off = after.active;
    outputs.standstill_off = after.moved;
    (after, outputs)
}
