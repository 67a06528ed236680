//! Brake test: the sequence of FB11 in the PLC (machine `brake_test`).
//!
//! One call is one cycle of the PLC. The test asks the NC for the reduced torque, closes the brake, has the axis pressed
//! against it, waits until it stands and holds it there; each feedback has a time of its own. What the NC does is
//! [`crate::sinumerik::brake_load`], how much torque it allows [`crate::sinumerik::brake_torque`].
//!
//! Not in the manual, and so chosen here: only the rise of Start begins a test, and a Start that falls ends none; a feedback
//! in the last cycle of its time still counts; a test that the NC ends before the fixed stop is fault 7 in each step; the
//! result stands until Start is withdrawn. Fault 10 (internal) does not occur.
//!
//! Reading: AX-10 BT_FAULT_CLOSED, a brake that was asked to close stays so after a fault until it is acknowledged.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The times of the test.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        tv_active: Cycles,
        tv_close: Cycles,
        tv_command: Cycles,
        tv_reached: Cycles,
        tv_hold: Cycles,
    }
}

impl Config {
    /// The times of FB11, in cycles of the PLC: `tv_active` until the NC confirms the selection and its end (TV_BTactiv),
    /// `tv_close` until the brake is closed, `tv_command` until the traversing command is there, `tv_reached` until the axis
    /// stands against the brake, `tv_hold` as long as the brake must hold.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when one is 0: no feedback could come in time, no brake would be tested.
    pub fn new(
        tv_active: Cycles,
        tv_close: Cycles,
        tv_command: Cycles,
        tv_reached: Cycles,
        tv_hold: Cycles,
    ) -> Result<Self, ConfigError> {
        let times = [tv_active, tv_close, tv_command, tv_reached, tv_hold];
        if times.iter().any(|time| time.is_zero()) {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            tv_active,
            tv_close,
            tv_command,
            tv_reached,
            tv_hold,
        })
    }

    /// How long a step may take; 0 for one that has no time.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn time(&self, step: BrakeStep) -> Cycles {
        match step {
            BrakeStep::Select | BrakeStep::Release => self.tv_active,
            BrakeStep::Close => self.tv_close,
            BrakeStep::Move => self.tv_command,
            BrakeStep::Reach => self.tv_reached,
            BrakeStep::Hold => self.tv_hold,
            BrakeStep::Idle | BrakeStep::Done | BrakeStep::Fault => Cycles::ZERO,
        }
    }
}

fields! {
    /// The steps of the test (S840D-BRAKE-708).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum BrakeStep {
        /// No test.
        #[default]
        Idle,
        /// The test is asked of the NC.
        Select,
        /// The brake is asked to close.
        Close,
        /// The axis is asked to move.
        Move,
        /// It moves until it stands against the brake.
        Reach,
        /// The brake is loaded.
        Hold,
        /// The test is deselected, the brake opens.
        Release,
        /// The brake has held.
        Done,
        /// The test has failed.
        Fault,
    }
}

/// Why a test has failed: `State` of FB11 (S840D-BRAKE-709).
pub mod fault {
    /// The start conditions do not hold.
    pub const START_CONDITIONS: u8 = 1;
    /// The NC does not confirm the selection.
    pub const NOT_SELECTED: u8 = 2;
    /// The brake does not say that it is closed.
    pub const NOT_CLOSED: u8 = 3;
    /// No traversing command.
    pub const NO_COMMAND: u8 = 4;
    /// The fixed stop is not reached, an axis RESET was initiated.
    pub const AXIS_RESET: u8 = 5;
    /// The fixed stop is not reached in time.
    pub const TOO_SLOW: u8 = 6;
    /// The brake does not hold, or the axis was too fast.
    pub const DOES_NOT_HOLD: u8 = 7;
    /// The brake gives way while it is loaded.
    pub const GIVES_WAY: u8 = 8;
    /// The test is not deselected.
    pub const NOT_DESELECTED: u8 = 9;
    /// The axis is not controlled by the PLC.
    pub const NOT_PLC_CONTROLLED: u8 = 11;
}

fields! {
    /// `State` of FB11: 0 for no fault, else one of [`fault`].
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct FaultId(u8) in 0..=11;
}

impl FaultId {
    /// No fault.
    pub const NONE: Self = Self(0);

    /// The number.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn get(self) -> u8 {
        self.0
    }

    /// Whether the brake had been asked to close when the fault came.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn with_brake(self) -> bool {
        self.0 >= fault::NOT_CLOSED && self.0 <= fault::NOT_DESELECTED
    }
}

fields! {
    /// The state between two calls.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// The step.
        pub step: BrakeStep,
        /// Calls since the step began.
        pub waited: Cycles,
        /// Why the test has failed.
        pub fault: FaultId,
        /// Start in the call before.
        pub held: bool,
    }
}

impl State {
    /// No test; a Start that is there in the first call begins none.
    pub const INITIAL: Self = Self {
        step: BrakeStep::Idle,
        waited: Cycles::ZERO,
        fault: FaultId::NONE,
        held: true,
    };

    /// A step has lasted less than its time, and only a failed test has a fault.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let time = config.time(self.step);
        (self.waited < time || (time.is_zero() && self.waited.is_zero()))
            && (self.step == BrakeStep::Fault) != (self.fault == FaultId::NONE)
            && self.fault.get() != 10
    }
}

fields! {
    /// The inputs of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Start: its rise begins a test.
        pub start: bool,
        /// Quit: acknowledges a fault.
        pub quit: bool,
        /// The axis is in closed loop, its brake open, nothing inhibits it.
        pub ready: bool,
        /// DBX63.1: the axis is controlled by the PLC.
        pub plc_axis: bool,
        /// DBX71.0: brake test active.
        pub active: bool,
        /// Bclosed: the brake is closed.
        pub closed: bool,
        /// DBX64.6 or DBX64.7: traversing command.
        pub command: bool,
        /// DBX62.5: fixed stop reached.
        pub fixed_stop: bool,
        /// An axis RESET was initiated.
        pub axis_reset: bool,
        /// The end position of the traversing motion is reached.
        pub end_reached: bool,
    }
}

fields! {
    /// The outputs of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The brake test is asked of the NC.
        pub select: bool,
        /// CloseBrake.
        pub close_brake: bool,
        /// MoveAxis.
        pub move_axis: bool,
        /// Done: the brake has held.
        pub done: bool,
        /// Error: the test has failed; `fault` of the state says why.
        pub error: bool,
    }
}

monitor! { sinumerik::brake_test;
    /// A test begins with the rise of Start, out of rest, on an axis that is ready and controlled by the PLC.
    start_is_a_rise ["S840D-BRAKE-708", "S840D-BRAKE-710"]:
        when |s| s.outputs.select && !matches!(s.before.step, BrakeStep::Select | BrakeStep::Close | BrakeStep::Move
            | BrakeStep::Reach | BrakeStep::Hold)
            => s.before.step == BrakeStep::Idle && s.inputs.start && !s.before.held && s.inputs.ready && s.inputs.plc_axis;

    /// The start conditions that do not hold are told: fault 1, then 11.
    start_conditions_are_told ["S840D-BRAKE-709", "S840D-BRAKE-710"]:
        when |s| s.before.step == BrakeStep::Idle && s.inputs.start && !s.before.held && !(s.inputs.ready && s.inputs.plc_axis)
            => s.after.fault.get() == if s.inputs.ready { fault::NOT_PLC_CONTROLLED } else { fault::START_CONDITIONS };

    /// Only with the confirmation of the NC the brake is closed.
    selection_is_confirmed ["S840D-BRAKE-708"]:
        when |s| s.before.step == BrakeStep::Select
            => (s.after.step == BrakeStep::Close) == s.inputs.active;

    /// Only a brake that says that it is closed is loaded.
    brake_is_closed_first ["S840D-BRAKE-708"]:
        when |s| s.outputs.move_axis && s.before.step < BrakeStep::Move
            => s.before.step == BrakeStep::Close && s.inputs.closed && s.inputs.active;

    /// With the traversing command the time to the fixed stop begins.
    command_is_awaited ["S840D-BRAKE-708"]:
        when |s| s.before.step == BrakeStep::Move && s.inputs.active
            => (s.after.step == BrakeStep::Reach) == s.inputs.command;

    /// The holding time begins with the fixed stop.
    fixed_stop_is_awaited ["S840D-BRAKE-708"]:
        when |s| s.after.step == BrakeStep::Hold && s.before.step != BrakeStep::Hold
            => s.before.step == BrakeStep::Reach && s.inputs.fixed_stop && s.inputs.active;

    /// A brake that gives way while it is loaded fails at once.
    brake_must_hold ["S840D-BRAKE-708", "S840D-BRAKE-709"]:
        when |s| s.before.step == BrakeStep::Hold && !s.inputs.fixed_stop
            => s.after.fault.get() == fault::GIVES_WAY;

    /// It is loaded for the whole holding time.
    holding_time_is_kept ["S840D-BRAKE-708"]:
        when |s| s.after.step == BrakeStep::Release && s.before.step != BrakeStep::Release
            => s.before.step == BrakeStep::Hold && s.before.waited.count() + 1 == s.config.tv_hold.count()
                && s.inputs.fixed_stop && s.inputs.active;

    /// A test is passed when the NC no longer reports it, after the holding time.
    passed_when_deselected ["S840D-BRAKE-708"]:
        when |s| s.outputs.done && s.before.step != BrakeStep::Done
            => s.before.step == BrakeStep::Release && !s.inputs.active;

    /// Every step that waits has an end: it goes on, or the time is up and the fault is the one of the step.
    time_runs_out ["S840D-BRAKE-708", "S840D-BRAKE-709"]:
        when |s| s.before.waited.count().saturating_add(1) == s.config.time(s.before.step).count()
            => s.after.step != s.before.step;

    /// The faults belong to their steps.
    faults_of_the_steps ["S840D-BRAKE-709"]:
        when |s| s.before.step != BrakeStep::Fault && s.after.step == BrakeStep::Fault
            => match s.before.step {
                BrakeStep::Idle => matches!(s.after.fault.get(), fault::START_CONDITIONS | fault::NOT_PLC_CONTROLLED),
                BrakeStep::Select => s.after.fault.get() == fault::NOT_SELECTED,
                BrakeStep::Close => s.after.fault.get() == if s.inputs.active { fault::NOT_CLOSED } else { fault::DOES_NOT_HOLD },
                BrakeStep::Move => s.after.fault.get() == if s.inputs.active { fault::NO_COMMAND } else { fault::DOES_NOT_HOLD },
                BrakeStep::Reach => matches!(s.after.fault.get(), fault::AXIS_RESET | fault::TOO_SLOW | fault::DOES_NOT_HOLD),
                BrakeStep::Hold => s.after.fault.get() == fault::GIVES_WAY,
                BrakeStep::Release => s.after.fault.get() == fault::NOT_DESELECTED,
                BrakeStep::Done | BrakeStep::Fault => false,
            };

    /// Before the fixed stop, an axis that runs out of its window or to its end position is a brake that does not hold.
    movement_is_found ["S840D-BRAKE-706", "S840D-BRAKE-709"]:
        when |s| s.before.step == BrakeStep::Reach && !s.inputs.axis_reset && (s.inputs.end_reached || !s.inputs.active)
            => s.after.fault.get() == fault::DOES_NOT_HOLD;

    /// So is one that loses the test in the steps before it.
    abort_is_found ["S840D-BRAKE-706"]:
        when |s| matches!(s.before.step, BrakeStep::Close | BrakeStep::Move) && !s.inputs.active
            => s.after.fault.get() == fault::DOES_NOT_HOLD;

    /// The brake is asked to be closed as long as the axis is pressed against it.
    brake_is_closed_while_loaded ["S840D-BRAKE-708"]:
        when |s| s.outputs.move_axis
            => s.outputs.close_brake && s.outputs.select;

    /// A fault ends motion and test, and leaves a brake closed that was asked to be (reading AX-10).
    fault_leaves_the_brake_closed ["S840D-BRAKE-709"]:
        when |s| s.outputs.error
            => !s.outputs.move_axis && !s.outputs.select && !s.outputs.done && s.after.fault != FaultId::NONE
                && s.outputs.close_brake == s.after.fault.with_brake();

    /// A fault stands until it is acknowledged, and its acknowledgement starts nothing.
    fault_until_acknowledged ["S840D-BRAKE-709"]:
        when |s| s.before.step == BrakeStep::Fault
            => !s.outputs.select && if s.inputs.quit { s.after.step == BrakeStep::Idle && s.after.fault == FaultId::NONE }
                else { s.outputs.error && s.after.fault == s.before.fault };

    /// The result stands until Start is withdrawn.
    result_stands ["S840D-BRAKE-708"]:
        when |s| s.before.step == BrakeStep::Done
            => s.outputs.done == s.inputs.start && !s.outputs.select;

    /// The step keeps the invariant, and shows the step it is in.
    state_stays_consistent ["S840D-BRAKE-708"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.held == s.inputs.start
                && s.outputs.done == (s.after.step == BrakeStep::Done) && s.outputs.error == (s.after.step == BrakeStep::Fault);
}

/// What a call makes of the step.
enum Turn {
    /// It goes on.
    Stay,
    /// The next one begins.
    To(BrakeStep),
    /// The test has failed.
    Fail(u8),
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let waited = Cycles::new(state.waited.count().saturating_add(1));
    let up = waited >= config.time(state.step);
    // The feedback of the step, else the fault once its time is up.
    let feedback = |there: bool, next: BrakeStep, fault: u8| match (there, up) {
        (true, _) => Turn::To(next),
        (false, true) => Turn::Fail(fault),
        (false, false) => Turn::Stay,
    };
    let turn = match state.step {
        BrakeStep::Idle if !inputs.start || state.held => Turn::Stay,
        BrakeStep::Idle if !inputs.ready => Turn::Fail(fault::START_CONDITIONS),
        BrakeStep::Idle if !inputs.plc_axis => Turn::Fail(fault::NOT_PLC_CONTROLLED),
        BrakeStep::Idle => Turn::To(BrakeStep::Select),
        BrakeStep::Select => feedback(inputs.active, BrakeStep::Close, fault::NOT_SELECTED),
        BrakeStep::Reach if inputs.axis_reset => Turn::Fail(fault::AXIS_RESET),
        BrakeStep::Reach if inputs.end_reached => Turn::Fail(fault::DOES_NOT_HOLD),
        BrakeStep::Close | BrakeStep::Move | BrakeStep::Reach if !inputs.active => {
            Turn::Fail(fault::DOES_NOT_HOLD)
        }
        BrakeStep::Close => feedback(inputs.closed, BrakeStep::Move, fault::NOT_CLOSED),
        BrakeStep::Move => feedback(inputs.command, BrakeStep::Reach, fault::NO_COMMAND),
        BrakeStep::Reach => feedback(inputs.fixed_stop, BrakeStep::Hold, fault::TOO_SLOW),
        BrakeStep::Hold if !inputs.fixed_stop || !inputs.active => Turn::Fail(fault::GIVES_WAY),
        BrakeStep::Hold if up => Turn::To(BrakeStep::Release),
        BrakeStep::Hold => Turn::Stay,
        BrakeStep::Release => feedback(!inputs.active, BrakeStep::Done, fault::NOT_DESELECTED),
        BrakeStep::Done if inputs.start => Turn::Stay,
        BrakeStep::Fault if !inputs.quit => Turn::Stay,
        BrakeStep::Done | BrakeStep::Fault => Turn::To(BrakeStep::Idle),
    };
    let (step, begun, fault) = match turn {
        Turn::Stay => (state.step, false, state.fault),
        Turn::To(next) => (next, true, FaultId::NONE),
        Turn::Fail(id) => (BrakeStep::Fault, true, FaultId(id)),
    };
    let counts = !begun && !config.time(step).is_zero();
    let after = State {
        step,
        waited: if counts { waited } else { Cycles::ZERO },
        fault,
        held: inputs.start,
    };
    let pressed = matches!(step, BrakeStep::Move | BrakeStep::Reach | BrakeStep::Hold);
    let outputs = Outputs {
        select: pressed || matches!(step, BrakeStep::Select | BrakeStep::Close),
        close_brake: pressed || step == BrakeStep::Close || fault.with_brake(),
        move_axis: pressed,
        done: step == BrakeStep::Done,
        error: step == BrakeStep::Fault,
    };
    (after, outputs)
}
