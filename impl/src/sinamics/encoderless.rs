//! A drive without encoder after the suppression of its pulses: it keeps itself in STO until it may start again (machine B15).
//!
//! Without pulses there is no speed to be monitored. Where a function goes on monitoring, STO is selected internally; it is left by
//! selecting and deselecting STO, or by deselecting the function and selecting it again, and then the drive has to be switched on
//! within 5 s. A function without selection lets the ON command itself start the drive, which must draw its current in time.
//! With nothing to be monitored ON starts an unmonitored drive.
//!
//! At POWER ON the pulses are suppressed: the drive begins as after their suppression. ON enables them later: until they have come,
//! or ON is withdrawn, they are not suppressed. Reading AF-4: both values of p9509.0 are parameters here.

use crate::kernel::{ConfigError, Cycles};
use crate::sinamics::types::rises;

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        window: Cycles,
        current: Cycles,
        ssm_keeps: bool,
        sdi_keeps: bool,
        unselected: bool,
    }
}

impl Config {
    /// `window`: 5 s for switching on. `current`: 5 s for the minimum current p9588. `ssm_keeps`: SSM is on and p9509.0 is 0.
    /// `sdi_keeps`: p9509.8 is 0. `unselected`: SLS or SDI without selection (p9512); then there is no function with one (5.7).
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when a time is 0.
    pub const fn new(
        window: Cycles,
        current: Cycles,
        ssm_keeps: bool,
        sdi_keeps: bool,
        unselected: bool,
    ) -> Result<Self, ConfigError> {
        if window.is_zero() || current.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            window,
            current,
            ssm_keeps,
            sdi_keeps,
            unselected,
        })
    }

    /// SDI goes on monitoring without pulses: p9509.8 is 0.
    pub const fn sdi_keeps(&self) -> bool {
        self.sdi_keeps
    }
}

fields! {
    /// Where the drive is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// STO is selected from outside.
        Selected,
        /// Internal STO.
        #[default]
        Off,
        /// The drive may be switched on.
        Window,
        /// The pulses are suppressed and nothing keeps them so.
        Free,
        /// ON has cancelled the suppression; the current is waited for.
        Start,
        /// The drive runs, or has been switched on, or coasts.
        Run,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where the drive is.
        pub phase: Phase,
        /// What is left of the time to switch on, or for the current.
        pub left: Cycles,
        /// The drive was switched on in the cycle before.
        pub on_held: bool,
        /// The pulses have come since it was switched on.
        pub came: bool,
    }
}

impl State {
    /// POWER ON.
    pub const INITIAL: Self = Self {
        phase: Phase::Off,
        left: Cycles::ZERO,
        on_held: true,
        came: false,
    };

    /// A time runs in its phase only; ON starts by itself only a drive with functions without selection, which is never free nor
    /// waits for a selection; pulses have come only where they are permitted.
    pub fn invariant(&self, config: &Config) -> bool {
        let runs = |time: Cycles| !self.left.is_zero() && self.left <= time;
        match self.phase {
            Phase::Window => runs(config.window) && !config.unselected && !self.came,
            Phase::Start => runs(config.current) && config.unselected,
            Phase::Free => {
                self.left.is_zero() && !config.unselected && !config.ssm_keeps && !self.came
            }
            Phase::Selected | Phase::Off => self.left.is_zero() && !self.came,
            Phase::Run => self.left.is_zero(),
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// STO is selected.
        pub sto: bool,
        /// SLS is selected.
        pub sls: bool,
        /// SDI is selected, in whichever direction.
        pub sdi: bool,
        /// The speed is below the detection of zero speed.
        pub still: bool,
        /// The ON/OFF1 command.
        pub on: bool,
        /// The pulses are enabled.
        pub pulses: bool,
        /// The minimum current flows.
        pub current: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// STO is selected internally.
        pub sto: bool,
        /// The drive may be switched on, for as long as the window lasts.
        pub window: bool,
        /// The current was not reached in time: C01711 with value 1041.
        pub no_current: bool,
    }
}

/// A selected function goes on monitoring: SLS whatever p9509 says, SDI as its bit does.
fn selected(config: &Config, inputs: &Inputs) -> bool {
    inputs.sls || inputs.sdi && config.sdi_keeps
}

/// Anything keeps a drive without pulses off.
fn keeps(config: &Config, inputs: &Inputs) -> bool {
    config.unselected || config.ssm_keeps || selected(config, inputs)
}

/// ON was given in this cycle.
fn switched_on(s: &Step) -> bool {
    s.inputs.on && !s.before.on_held
}

/// SLS or SDI goes on monitoring by its selection.
fn by_selection(s: &Step) -> bool {
    !s.config.unselected && (s.inputs.sls || s.inputs.sdi && s.config.sdi_keeps)
}

/// Nothing goes on monitoring.
fn unmonitored(s: &Step) -> bool {
    !(s.config.unselected
        || s.config.ssm_keeps
        || s.inputs.sls
        || s.inputs.sdi && s.config.sdi_keeps)
}

/// The drive ran, and its pulses were suppressed.
fn suppressed(s: &Step) -> bool {
    s.before.phase == Phase::Run && !s.inputs.pulses && s.before.came && !s.inputs.sto
}

/// ON was withdrawn before the pulses came.
fn withdrawn(s: &Step) -> bool {
    s.before.phase == Phase::Run && !s.inputs.pulses && !s.inputs.on && !s.inputs.sto
}

monitor! { sinamics::encoderless;
    /// When the pulses are suppressed SLS keeps the drive off always, SDI as p9509 says.
    suppression_keeps_off ["S120-ENC-016", "S120-SDI-007", "S120-SLS-016"]:
        when |s| (suppressed(&s) || withdrawn(&s)) && by_selection(&s)
            => s.outputs.sto && s.after.phase == Phase::Off;

    /// SSM does so below the detection of zero speed, and so does a function without selection; until then the drive coasts.
    standstill_keeps_off ["S120-SSM-008", "S120-SSM-009", "S120-ENC-016", "S120-SLS-020", "S120-SDI-011"]:
        when |s| (suppressed(&s) || withdrawn(&s)) && !by_selection(&s) && (s.config.ssm_keeps || s.config.unselected)
            => s.outputs.sto == s.inputs.still && (s.inputs.still || s.after.phase == Phase::Run);

    /// Nothing monitored keeps nothing off: p9509 at 1, no selection.
    nothing_monitored_is_free ["S120-SSM-010", "S120-SLS-018", "S120-SDI-007", "S120-SDI-008"]:
        when |s| unmonitored(&s)
            => !s.outputs.sto && !s.outputs.window;

    /// ON alone never leaves it while a selected function or SSM keeps it.
    on_is_not_enough ["S120-ENC-016", "S120-SLS-016", "S120-SSM-009", "S120-PF-26"]:
        when |s| s.before.phase == Phase::Off && !s.inputs.sto && !s.config.unselected && !unmonitored(&s)
            => s.outputs.sto && s.after.phase == Phase::Off;

    /// A deselection of STO opens the window, for its whole time.
    deselected_sto_opens_the_window ["S120-SLS-015", "S120-SLS-016", "S120-SSM-011", "S120-SDI-008", "S120-ENC-016"]:
        when |s| s.before.phase == Phase::Selected && !s.inputs.sto && !s.config.unselected && !unmonitored(&s)
            => s.outputs.window && !s.outputs.sto && s.after.left == s.config.window;

    /// So does a function that is selected again after it was deselected.
    selected_function_opens_the_window ["S120-SLS-017", "S120-SDI-008"]:
        when |s| s.before.phase == Phase::Free && !s.inputs.sto && by_selection(&s)
            => s.outputs.window && s.after.left == s.config.window;

    /// Deselecting every function undoes the internal STO.
    deselection_undoes_it ["S120-SLS-017", "S120-SDI-008"]:
        when |s| s.before.phase == Phase::Off && unmonitored(&s) && !s.inputs.sto
            => !s.outputs.sto && s.after.phase == Phase::Free;

    /// In the window ON starts the drive; without it the internal STO comes back when the window ends.
    window_has_an_end ["S120-SLS-015", "S120-SLS-016", "S120-SLS-017", "S120-SSM-009", "S120-SSM-011", "S120-SDI-008", "S120-PF-26"]:
        when |s| s.before.phase == Phase::Window && !s.inputs.sto && !unmonitored(&s)
            => if switched_on(&s) {
                s.after.phase == Phase::Run && !s.outputs.sto
            } else if s.before.left == Cycles::new(1) {
                s.outputs.sto
            } else {
                s.outputs.window && s.after.left.count() + 1 == s.before.left.count()
            };

    /// STO that is selected meanwhile closes the window.
    sto_closes_the_window ["S120-SLS-015", "S120-SSM-011"]:
        when |s| s.inputs.sto
            => s.after.phase == Phase::Selected && s.outputs == Outputs::default();

    /// Unmonitored, ON starts the drive.
    unmonitored_start ["S120-SLS-018", "S120-SDI-008", "S120-ENC-016"]:
        when |s| s.before.phase == Phase::Free && switched_on(&s) && !s.inputs.sto && unmonitored(&s)
            => s.after.phase == Phase::Run && !s.outputs.sto;

    /// A function without selection lets ON cancel the suppression, and SSM does not hinder it.
    on_starts_without_selection ["S120-ENC-017", "S120-SLS-020", "S120-SDI-011"]:
        when |s| s.before.phase == Phase::Off && !s.inputs.sto && s.config.unselected
            => if switched_on(&s) {
                !s.outputs.sto && s.after.phase == Phase::Start && s.after.left == s.config.current
            } else {
                s.outputs.sto
            };

    /// The current ends the start; without it the suppression returns, with its message.
    current_is_waited_for ["S120-ENC-015", "S120-ENC-017", "S120-SLS-020", "S120-SDI-011"]:
        when |s| s.before.phase == Phase::Start && !s.inputs.sto && s.inputs.on && (s.inputs.pulses || !s.before.came)
            => if s.inputs.current {
                s.after.phase == Phase::Run && !s.outputs.no_current
            } else {
                s.outputs.no_current == (s.before.left == Cycles::new(1)) && s.outputs.sto == s.outputs.no_current
            };

    /// Nothing else is told.
    nothing_else_is_told ["S120-ENC-015"]:
        when |s| s.before.phase != Phase::Start || s.before.left != Cycles::new(1) || s.inputs.current
            => !s.outputs.no_current;

    /// Switched off, a function without selection suppresses the pulses below the standstill limit.
    standstill_suppresses ["S120-SLS-020", "S120-SDI-011"]:
        when |s| (s.before.phase == Phase::Run || s.before.phase == Phase::Start) && s.config.unselected
            && !s.inputs.on && s.inputs.still && !s.inputs.sto
            => s.outputs.sto && !s.outputs.no_current;

    /// A drive that runs and keeps its pulses, or waits for them, is left alone.
    running_drive_is_left_alone ["S120-ENC-016", "S120-SLS-020"]:
        when |s| s.before.phase == Phase::Run && !s.inputs.sto && (s.inputs.on || !s.inputs.still || !s.config.unselected)
            && (s.inputs.pulses || s.inputs.on && !s.before.came)
            => s.after.phase == Phase::Run && s.outputs == Outputs::default()
                && s.after.came == (s.before.came || s.inputs.pulses);

    /// The state stays consistent.
    state_stays_consistent ["S120-ENC-016"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.sto == (s.after.phase == Phase::Off);
}

/// The drive has its pulses no longer: they were suppressed, or it was switched off before they came.
fn without_pulses(state: &State, inputs: &Inputs) -> bool {
    !inputs.pulses && (state.came || !inputs.on)
}

/// Where a drive that runs or starts goes in this cycle, if it goes.
fn stopped(state: &State, config: &Config, inputs: &Inputs) -> Option<Phase> {
    let gone = without_pulses(state, inputs);
    if config.unselected {
        (inputs.still && (gone || !inputs.on)).then_some(Phase::Off)
    } else if !gone {
        None
    } else if !keeps(config, inputs) {
        Some(Phase::Free)
    } else {
        (inputs.still || selected(config, inputs)).then_some(Phase::Off)
    }
}

/// The next phase while STO is not selected, with what is left of its time; and whether the current was missed.
fn proceed(state: &State, config: &Config, inputs: &Inputs) -> (Phase, Cycles, bool) {
    let on = rises(inputs.on, state.on_held);
    let timeless = |phase| (phase, Cycles::ZERO, false);
    let window = (Phase::Window, config.window, false);
    match state.phase {
        Phase::Start | Phase::Run => {
            if let Some(phase) = stopped(state, config, inputs) {
                timeless(phase)
            } else if state.phase == Phase::Run || inputs.current {
                timeless(Phase::Run)
            } else if state.left.tick().is_zero() {
                (Phase::Off, Cycles::ZERO, true)
            } else {
                (Phase::Start, state.left.tick(), false)
            }
        }
        Phase::Off if config.unselected && on => (Phase::Start, config.current, false),
        _ if config.unselected => timeless(Phase::Off),
        Phase::Free if on && !keeps(config, inputs) => timeless(Phase::Run),
        _ if !keeps(config, inputs) => timeless(Phase::Free),
        Phase::Selected | Phase::Free => window,
        Phase::Window if on => timeless(Phase::Run),
        Phase::Window if !state.left.tick().is_zero() => (Phase::Window, state.left.tick(), false),
        Phase::Window | Phase::Off => timeless(Phase::Off),
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let (phase, left, no_current) = if inputs.sto {
        (Phase::Selected, Cycles::ZERO, false)
    } else {
        proceed(&state, config, inputs)
    };
    let powered = |phase| phase == Phase::Start || phase == Phase::Run;
    let after = State {
        phase,
        left,
        on_held: inputs.on,
        came: powered(state.phase) && powered(phase) && (state.came || inputs.pulses),
    };
    let outputs = Outputs {
        sto: phase == Phase::Off,
        window: phase == Phase::Window,
        no_current,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn monitor(unselected: bool) -> Monitor {
        let time = Cycles::new(3);
        let config = Config::new(time, time, false, true, unselected);
        Monitor::new(config.expect("accepted"))
    }

    /// S120-SLS-016, S120-SLS-017: stopped with SLS; ON alone, then the second and the third case of the manual.
    #[test]
    fn restart_cases() {
        for third in [false, true] {
            let mut monitor = monitor(false);
            let mut inputs = Inputs {
                sls: true,
                ..Inputs::default()
            };
            assert!(monitor.step(&inputs).sto);
            inputs.on = true;
            assert!(monitor.step(&inputs).sto);
            inputs.on = false;
            if third {
                inputs.sls = false;
                assert!(!monitor.step(&inputs).sto);
                inputs.sls = true;
            } else {
                inputs.sto = true;
                assert!(!monitor.step(&inputs).sto);
                inputs.sto = false;
            }
            assert!(monitor.step(&inputs).window);
            let mut late = monitor;
            late.step(&inputs);
            late.step(&inputs);
            assert!(late.step(&inputs).sto);
            inputs.on = true;
            assert_eq!(monitor.step(&inputs), Outputs::default());
            inputs.pulses = true;
            monitor.step(&inputs);
            inputs.pulses = false;
            assert!(monitor.step(&inputs).sto);
        }
    }

    /// S120-SLS-020, S120-ENC-015: without selection ON starts, and the current must come.
    #[test]
    fn start_without_selection() {
        let mut monitor = monitor(true);
        let mut inputs = Inputs::default();
        assert!(monitor.step(&inputs).sto);
        inputs.on = true;
        let told: [bool; 4] = core::array::from_fn(|_| monitor.step(&inputs).no_current);
        assert_eq!(told, [false, false, false, true]);
    }
}
