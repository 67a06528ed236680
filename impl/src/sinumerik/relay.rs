//! Safety software relay: an EMERGENCY STOP function of the safe logic (machine `relay`).
//!
//! SIRELAY in SAFE.SPF, FB10 in the PLC. One call is one cycle of the safe logic; the call of the run-up has `power_on` set
//! (`FirstRun` of FB10). The direct output needs all shutdown inputs, and after each shutdown an acknowledgement; the delayed
//! outputs fall later and rise with it. The second acknowledgement input is for the forced checking procedure: it is heard
//! only while no shutdown since the relay was last on has used up its window.
//!
//! Durations are whole cycles: a shutdown counts with the cycles in which it was seen, so one that was accepted may have
//! lasted up to a cycle longer than the window. FB10 of the manual has no window; this block has it on both sides.
//!
//! Readings: B-07 Q_EDGE (an acknowledgement is an input that becomes 1), B-08 FB10_Q2_TM1.

use crate::kernel::{ConfigError, Cycles};

/// One second in cycles of 31.25 us, the shortest possible ones: the longest window (S840D-RELAY-007).
pub const ONE_SECOND: Cycles = Cycles::new(32_000);

config! {
    /// The times of a relay.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        window: Cycles,
        delay_1: Cycles,
        delay_2: Cycles,
        delay_3: Cycles,
    }
}

impl Config {
    /// `window`: TM1, which a shutdown must stay below for Q2 to acknowledge it; with 0 none does. `delay_1` to `delay_3`:
    /// TI1 to TI3, how much later A1 to A3 fall than A0.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] for a window above [`ONE_SECOND`]: the comparison with the PLC would tell an error
    /// before it ends (S840D-RELAY-007).
    pub fn new(
        window: Cycles,
        delay_1: Cycles,
        delay_2: Cycles,
        delay_3: Cycles,
    ) -> Result<Self, ConfigError> {
        Ok(Self {
            window: window.at_most(ONE_SECOND)?,
            delay_1,
            delay_2,
            delay_3,
        })
    }

    /// TM1.
    pub const fn window(&self) -> Cycles {
        self.window
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// Q1 has acknowledged since the run-up.
        pub armed: bool,
        /// A0.
        pub on: bool,
        /// What is left of the window in the shutdown that runs; all of it while none does.
        pub left: Cycles,
        /// The least that a shutdown has left of the window since A0 was on: at 0 only Q1 acknowledges.
        pub least: Cycles,
        /// Q1 in the cycle before.
        pub held_1: bool,
        /// Q2 in the cycle before.
        pub held_2: bool,
        /// How long A1 still stays on without A0.
        pub off_1: Cycles,
        /// How long A2 still stays on without A0.
        pub off_2: Cycles,
        /// How long A3 still stays on without A0.
        pub off_3: Cycles,
    }
}

impl State {
    /// Before the run-up. A button that is pressed already does not acknowledge.
    pub const INITIAL: Self = Self {
        armed: false,
        on: false,
        left: Cycles::ZERO,
        least: Cycles::ZERO,
        held_1: true,
        held_2: true,
        off_1: Cycles::ZERO,
        off_2: Cycles::ZERO,
        off_3: Cycles::ZERO,
    };

    /// Nothing runs before the first acknowledgement; no delay runs and the window is whole while the relay is on.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let window = if self.armed {
            config.window
        } else {
            Cycles::ZERO
        };
        let still = self.off_1.is_zero() && self.off_2.is_zero() && self.off_3.is_zero();
        (self.armed || !self.on)
            && self.left <= window
            && self.least <= self.left
            && (!self.on || self.least == window)
            && (still || self.armed && !self.on)
            && self.off_1 <= config.delay_1
            && self.off_2 <= config.delay_2
            && self.off_3 <= config.delay_3
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Run-up of the control; `FirstRun` of FB10.
        pub power_on: bool,
        /// The acknowledgement button.
        pub q1: bool,
        /// The acknowledgement of the forced checking procedure.
        pub q2: bool,
        /// Shutdown input, 0 shuts down; 1 where it is not used.
        pub e1: bool,
        /// Shutdown input.
        pub e2: bool,
        /// Shutdown input.
        pub e3: bool,
    }
}

impl Inputs {
    /// No shutdown is asked for.
    pub const fn closed(&self) -> bool {
        self.e1 && self.e2 && self.e3
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The direct output.
        pub a0: bool,
        /// The output that falls TI1 later.
        pub a1: bool,
        /// The output that falls TI2 later.
        pub a2: bool,
        /// The output that falls TI3 later.
        pub a3: bool,
    }
}

monitor! { sinumerik::relay;
    /// A shutdown input at 0 takes the direct output away in the same cycle, whoever acknowledges.
    shutdown_acts_at_once ["S840D-RELAY-001", "S840D-RELAY-002", "S840D-RELAY-018"]:
        when |s| !s.inputs.closed()
            => !s.outputs.a0 && !s.after.on;

    /// The run-up ends everything, and no button pressed in it counts.
    run_up_ends_everything ["S840D-RELAY-003", "S840D-RELAY-014", "S840D-RELAY-017"]:
        when |s| s.inputs.power_on
            => s.after == (State { held_1: s.inputs.q1, held_2: s.inputs.q2, ..State::INITIAL })
                && !s.outputs.a0 && !s.outputs.a1 && !s.outputs.a2 && !s.outputs.a3;

    /// Until the button has acknowledged nothing is on.
    button_is_the_first ["S840D-RELAY-003", "S840D-RELAY-017"]:
        when |s| !s.before.armed && (!s.inputs.q1 || s.before.held_1)
            => !s.after.armed && !s.outputs.a0 && !s.outputs.a1 && !s.outputs.a2 && !s.outputs.a3;

    /// Inputs that return do not switch on: that takes an acknowledgement that becomes 1.
    start_wants_an_acknowledgement ["S840D-RELAY-003", "S840D-RELAY-004"]:
        when |s| !s.before.on && s.outputs.a0
            => s.inputs.closed() && !s.inputs.power_on
                && ((s.inputs.q1 && !s.before.held_1) || (s.inputs.q2 && !s.before.held_2));

    /// The button acknowledges a shutdown of any length once it is over.
    button_acknowledges ["S840D-RELAY-004"]:
        when |s| s.inputs.q1 && !s.before.held_1 && s.inputs.closed() && !s.inputs.power_on
            => s.outputs.a0 && s.after.armed;

    /// The forced checking procedure may acknowledge while the window is open.
    window_lets_the_test_acknowledge ["S840D-RELAY-005", "S840D-RELAY-006"]:
        when |s| s.inputs.q2 && !s.before.held_2 && s.inputs.closed() && !s.inputs.power_on && !s.before.least.is_zero()
            => s.outputs.a0;

    /// Once a shutdown has used the window up, only the button acknowledges.
    long_shutdown_wants_the_button ["S840D-RELAY-005", "S840D-RELAY-006", "S840D-RELAY-008"]:
        when |s| !s.before.on && s.before.least.is_zero() && (!s.inputs.q1 || s.before.held_1)
            => !s.outputs.a0;

    /// A shutdown takes a cycle from the window in each of its cycles, the first one included.
    shutdown_uses_the_window_up ["S840D-RELAY-006"]:
        when |s| s.before.armed && !s.inputs.closed() && !s.inputs.power_on
            => s.after.left == s.before.left.tick() && s.after.least <= s.after.left;

    /// Further shutdowns give nothing back of the window while the relay is off.
    queued_shutdowns_count ["S840D-RELAY-006"]:
        when |s| !s.before.on && !s.after.on
            => s.after.least <= s.before.least;

    /// Each shutdown is measured by itself: its window is whole when it begins.
    each_shutdown_is_measured ["S840D-RELAY-006"]:
        when |s| s.after.armed && s.inputs.closed() && !s.inputs.power_on
            => s.after.left == s.config.window && (!s.after.on || s.after.least == s.config.window);

    /// What is on stays on while nothing asks for a shutdown.
    on_without_interruption ["S840D-RELAY-001"]:
        when |s| s.before.on && s.inputs.closed() && !s.inputs.power_on
            => s.outputs.a0;

    /// The delayed outputs rise with the direct one and have no gap; their delays are over.
    rise_is_not_delayed ["S840D-RELAY-003", "S840D-RELAY-015"]:
        when |s| s.outputs.a0
            => s.outputs.a1 && s.outputs.a2 && s.outputs.a3
                && s.after.off_1.is_zero() && s.after.off_2.is_zero() && s.after.off_3.is_zero();

    /// When the direct output falls, each delay begins anew with its whole time.
    delays_begin_whole ["S840D-RELAY-002", "S840D-RELAY-015"]:
        when |s| s.before.on && !s.after.on && !s.inputs.power_on
            => s.after.off_1 == s.config.delay_1 && s.after.off_2 == s.config.delay_2 && s.after.off_3 == s.config.delay_3;

    /// A delayed output is on for what is left of its delay, and a cycle of it passes with each cycle.
    delays_run_down ["S840D-RELAY-002"]:
        when |s| !s.before.on && !s.after.on && !s.inputs.power_on
            => s.after.off_1 == s.before.off_1.tick() && s.after.off_2 == s.before.off_2.tick()
                && s.after.off_3 == s.before.off_3.tick();

    /// Without the direct output a delayed one is on exactly while its delay runs.
    delays_are_shown ["S840D-RELAY-002"]:
        when |s| !s.outputs.a0
            => s.outputs.a1 != s.after.off_1.is_zero() && s.outputs.a2 != s.after.off_2.is_zero()
                && s.outputs.a3 != s.after.off_3.is_zero();

    /// The step keeps the invariant, shows its state and remembers the buttons.
    state_stays_consistent ["S840D-RELAY-001", "S840D-RELAY-004"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.a0 == s.after.on
                && s.after.held_1 == s.inputs.q1 && s.after.held_2 == s.inputs.q2;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let button = inputs.q1 && !before.held_1;
    // Before the first acknowledgement nothing is left of a window.
    let test = inputs.q2 && !before.held_2 && !before.least.is_zero();
    let on = inputs.closed() && (before.on || button || test);
    let armed = before.armed || on;
    let left = match (armed, inputs.closed()) {
        (false, _) => Cycles::ZERO,
        (true, true) => config.window,
        (true, false) => before.left.tick(),
    };
    let off = |delay: Cycles, rest: Cycles| match (on, before.on) {
        (true, _) => Cycles::ZERO,
        (false, true) => delay,
        (false, false) => rest.tick(),
    };
    let after = State {
        armed,
        on,
        left,
        least: if on {
            config.window
        } else {
            before.least.min(left)
        },
        held_1: inputs.q1,
        held_2: inputs.q2,
        off_1: off(config.delay_1, before.off_1),
        off_2: off(config.delay_2, before.off_2),
        off_3: off(config.delay_3, before.off_3),
    };
    let outputs = Outputs {
        a0: on,
        a1: on || !after.off_1.is_zero(),
        a2: on || !after.off_2.is_zero(),
        a3: on || !after.off_3.is_zero(),
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-RELAY-007.
    #[test]
    fn a_window_is_a_second_at_most() {
        let none = Cycles::ZERO;
        let longer = Cycles::new(ONE_SECOND.count() + 1);
        assert_eq!(
            Config::new(longer, none, none, none),
            Err(ConfigError::DelayTooLong)
        );
        let longest = Config::new(ONE_SECOND, none, none, none).expect("allowed");
        assert_eq!(longest.window(), ONE_SECOND);
    }
}
