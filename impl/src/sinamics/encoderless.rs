//! A drive without encoder after the suppression of its pulses: it keeps itself in STO until it may start again (machine B15).
//!
//! Without pulses there is no speed to be monitored. Where a function goes on monitoring, STO is selected internally; it is left by
//! selecting and deselecting STO, or by deselecting the function and selecting it again, and then the drive has to be switched on
//! within 5 s. A function without selection lets the ON command itself start the drive, which must draw its current in time.
//! With nothing to be monitored ON starts an unmonitored drive.
//!
//! At POWER ON the pulses are suppressed: the drive begins as after their suppression. Reading AF-4: both values of p9509.0 are
//! parameters here.

use crate::kernel::{ConfigError, Cycles};
use crate::sinamics::types::{falls, rises};

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        window: Cycles,
        current: Cycles,
        ssm_keeps: bool,
        sdi_keeps: bool,
        sls_unselected: bool,
        sdi_unselected: bool,
    }
}

impl Config {
    /// `window`: 5 s for switching on. `current`: 5 s for the minimum current p9588. `ssm_keeps`: p9509.0 is 0. `sdi_keeps`: p9509.8
    /// is 0. `sls_unselected`, `sdi_unselected`: functions without selection (p9512).
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when a time is 0.
    pub const fn new(
        window: Cycles,
        current: Cycles,
        ssm_keeps: bool,
        sdi_keeps: bool,
        sls_unselected: bool,
        sdi_unselected: bool,
    ) -> Result<Self, ConfigError> {
        if window.is_zero() || current.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            window,
            current,
            ssm_keeps,
            sdi_keeps,
            sls_unselected,
            sdi_unselected,
        })
    }

    /// SDI goes on monitoring without pulses: p9509.8 is 0.
    pub const fn sdi_keeps(&self) -> bool {
        self.sdi_keeps
    }

    /// A function without selection goes on monitoring.
    pub const fn unselected(&self) -> bool {
        self.sls_unselected || self.sdi_unselected && self.sdi_keeps
    }
}

fields! {
    /// Where the drive is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Internal STO.
        #[default]
        Off,
        /// The pulses are suppressed and nothing keeps them so.
        Free,
        /// The drive may be switched on.
        Window,
        /// ON has cancelled the suppression; the current is waited for.
        Start,
        /// The drive runs, or has been switched on.
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
        /// STO was selected in the cycle before.
        pub sto_held: bool,
        /// A function was selected that keeps the drive off.
        pub function_held: bool,
        /// The drive was switched on in the cycle before.
        pub on_held: bool,
        /// The pulses were enabled.
        pub pulses_held: bool,
    }
}

impl State {
    /// POWER ON.
    pub const INITIAL: Self = Self {
        phase: Phase::Off,
        left: Cycles::ZERO,
        sto_held: false,
        function_held: false,
        on_held: true,
        pulses_held: false,
    };

    /// A time runs in its phase only; ON starts by itself only a drive with functions without selection.
    pub fn invariant(&self, config: &Config) -> bool {
        let runs = |time: Cycles| !self.left.is_zero() && self.left <= time;
        match self.phase {
            Phase::Window => runs(config.window),
            Phase::Start => runs(config.current) && config.unselected(),
            Phase::Off | Phase::Free | Phase::Run => self.left.is_zero(),
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
        /// SSM is switched on.
        pub ssm: bool,
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
    !config.sls_unselected && inputs.sls || !config.sdi_unselected && inputs.sdi && config.sdi_keeps
}

/// SSM goes on monitoring.
fn by_ssm(config: &Config, inputs: &Inputs) -> bool {
    config.ssm_keeps && inputs.ssm && inputs.still
}

/// Anything keeps a drive without pulses off.
fn keeps(config: &Config, inputs: &Inputs) -> bool {
    selected(config, inputs) || by_ssm(config, inputs) || config.unselected()
}

/// ON was given in this cycle.
fn switched_on(s: &Step) -> bool {
    s.inputs.on && !s.before.on_held
}

/// The pulses were suppressed in this cycle.
fn suppressed(s: &Step) -> bool {
    s.before.pulses_held && !s.inputs.pulses
}

/// A function goes on monitoring, or would at standstill.
fn monitored(s: &Step) -> bool {
    s.config.sls_unselected
        || s.config.sdi_unselected
        || s.inputs.sls
        || s.inputs.sdi && s.config.sdi_keeps
        || s.inputs.ssm && s.config.ssm_keeps
}

monitor! { sinamics::encoderless;
    /// When the pulses are suppressed a monitored drive keeps itself off: by SLS always, by SDI and SSM as p9509 says.
    suppression_keeps_off ["S120-ENC-016", "S120-SSM-008", "S120-SDI-007", "S120-SLS-016"]:
        when |s| s.before.phase == Phase::Run && suppressed(&s) && !s.inputs.sto && (
            s.inputs.sls && !s.config.sls_unselected
            || s.inputs.sdi && !s.config.sdi_unselected && s.config.sdi_keeps
            || s.inputs.ssm && s.config.ssm_keeps && s.inputs.still)
            => s.outputs.sto;

    /// SSM does so once the speed is below the detection of zero speed, if it was above it at the suppression.
    ssm_keeps_off_at_standstill ["S120-SSM-009", "S120-ENC-016"]:
        when |s| s.before.phase == Phase::Free && s.inputs.ssm && s.config.ssm_keeps && s.inputs.still
            && !s.inputs.sto
            => s.outputs.sto;

    /// Nothing monitored keeps nothing off: p9509 at 1, no selection.
    nothing_monitored_is_free ["S120-SSM-010", "S120-SLS-018", "S120-SDI-007", "S120-SDI-008"]:
        when |s| !monitored(&s)
            => !s.outputs.sto && !s.outputs.window;

    /// ON alone never leaves it while a selected function or SSM keeps it.
    on_is_not_enough ["S120-ENC-016", "S120-SLS-016", "S120-PF-26"]:
        when |s| s.before.phase == Phase::Off && !s.before.sto_held && (
            s.inputs.sls && !s.config.sls_unselected
            || s.inputs.sdi && !s.config.sdi_unselected && s.config.sdi_keeps
            || s.inputs.ssm && s.config.ssm_keeps && s.inputs.still)
            => s.outputs.sto && s.after.phase == Phase::Off;

    /// A deselection of STO opens the window, for its whole time.
    deselected_sto_opens_the_window ["S120-SLS-015", "S120-SLS-016", "S120-SSM-011", "S120-SDI-008", "S120-ENC-016"]:
        when |s| s.before.phase == Phase::Off && s.before.sto_held && !s.inputs.sto && (
            s.inputs.sls && !s.config.sls_unselected
            || s.inputs.ssm && s.config.ssm_keeps && s.inputs.still)
            => s.outputs.window && !s.outputs.sto && s.after.left == s.config.window;

    /// So does a function that is selected again after it was deselected.
    selected_function_opens_the_window ["S120-SLS-017", "S120-SDI-008"]:
        when |s| s.before.phase == Phase::Free && !s.before.function_held && !s.inputs.sto && !s.config.ssm_keeps
            && !s.config.sls_unselected && s.inputs.sls && !s.inputs.pulses
            => s.outputs.window && s.after.left == s.config.window;

    /// Deselecting every function undoes the internal STO.
    deselection_undoes_it ["S120-SLS-017", "S120-SDI-008"]:
        when |s| s.before.phase == Phase::Off && !s.inputs.sls && !s.inputs.sdi && !s.inputs.ssm
            && !s.config.sls_unselected && !s.config.sdi_unselected
            => !s.outputs.sto && s.after.phase == Phase::Free;

    /// In the window ON starts the drive; without it the internal STO comes back when the window ends.
    window_has_an_end ["S120-SLS-015", "S120-SLS-016", "S120-SLS-017", "S120-SSM-009", "S120-SSM-011", "S120-SDI-008", "S120-PF-26"]:
        when |s| s.before.phase == Phase::Window && !s.inputs.sto && s.inputs.sls && !s.config.sls_unselected
            => if s.before.left == Cycles::new(1) {
                s.outputs.sto
            } else if switched_on(&s) {
                s.after.phase == Phase::Run && !s.outputs.sto
            } else {
                s.outputs.window && s.after.left.count() + 1 == s.before.left.count()
            };

    /// STO that is selected meanwhile closes the window.
    sto_closes_the_window ["S120-SLS-015", "S120-SSM-011"]:
        when |s| s.inputs.sto
            => !s.outputs.window && s.after.phase != Phase::Run && s.after.phase != Phase::Start;

    /// Unmonitored, ON starts the drive.
    unmonitored_start ["S120-SLS-018", "S120-SDI-008", "S120-ENC-016"]:
        when |s| s.before.phase == Phase::Free && switched_on(&s) && !s.inputs.sto && !s.inputs.sls && !s.inputs.sdi
            && !s.inputs.ssm && !s.config.sls_unselected && !s.config.sdi_unselected
            => s.after.phase == Phase::Run && !s.outputs.sto;

    /// A function without selection lets ON cancel the suppression.
    on_starts_without_selection ["S120-ENC-017", "S120-SLS-020", "S120-SDI-011"]:
        when |s| s.before.phase == Phase::Off && !s.before.sto_held && !s.inputs.sto && switched_on(&s)
            && s.config.sls_unselected && !s.inputs.sdi && !s.inputs.ssm
            => !s.outputs.sto && s.after.phase == Phase::Start && s.after.left == s.config.current;

    /// The current ends the start; without it the suppression returns, with its message.
    current_is_waited_for ["S120-ENC-015", "S120-ENC-017", "S120-SLS-020", "S120-SDI-011"]:
        when |s| s.before.phase == Phase::Start && !s.inputs.sto && s.inputs.on
            => if s.inputs.current {
                s.after.phase == Phase::Run && !s.outputs.no_current
            } else {
                s.outputs.no_current == (s.before.left == Cycles::new(1)) && s.outputs.sto == s.outputs.no_current
            };

    /// Nothing else is told.
    nothing_else_is_told ["S120-ENC-015"]:
        when |s| s.before.phase != Phase::Start
            => !s.outputs.no_current;

    /// Switched off, a function without selection suppresses the pulses below the standstill limit.
    standstill_suppresses ["S120-SLS-020", "S120-SDI-011"]:
        when |s| s.before.phase == Phase::Run && s.config.unselected() && !s.inputs.on && s.inputs.still
            => s.outputs.sto;

    /// A drive that runs and keeps its pulses is left alone.
    running_drive_is_left_alone ["S120-ENC-016", "S120-SLS-020"]:
        when |s| s.before.phase == Phase::Run && s.inputs.pulses && !s.inputs.sto && (s.inputs.on || !s.inputs.still)
            => s.after.phase == Phase::Run && s.outputs == Outputs::default();

    /// The state stays consistent.
    state_stays_consistent ["S120-ENC-016"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.sto == (s.after.phase == Phase::Off);
}

/// Where a drive without pulses is that nothing has let go.
fn without_pulses(config: &Config, inputs: &Inputs) -> Phase {
    if keeps(config, inputs) {
        Phase::Off
    } else {
        Phase::Free
    }
}

/// The next phase while STO is not selected, with what is left of its time; and whether the current was missed.
fn proceed(state: &State, config: &Config, inputs: &Inputs) -> (Phase, Cycles, bool) {
    let on = rises(inputs.on, state.on_held);
    let only_unselected = !selected(config, inputs) && !by_ssm(config, inputs);
    let resting = without_pulses(config, inputs);
    let window = (Phase::Window, config.window, false);
    let timeless = |phase| (phase, Cycles::ZERO, false);
    match state.phase {
        Phase::Off if resting == Phase::Free => timeless(Phase::Free),
        Phase::Off if only_unselected && on => (Phase::Start, config.current, false),
        Phase::Off if !only_unselected && falls(inputs.sto, state.sto_held) => window,
        Phase::Off => timeless(Phase::Off),
        Phase::Free if by_ssm(config, inputs) => timeless(Phase::Off),
        Phase::Free if selected(config, inputs) && !state.function_held => window,
        Phase::Free if resting == Phase::Off => timeless(Phase::Off),
        Phase::Free if on => timeless(Phase::Run),
        Phase::Free => timeless(Phase::Free),
        Phase::Window if resting == Phase::Free => timeless(Phase::Free),
        Phase::Window if state.left.tick().is_zero() => timeless(Phase::Off),
        Phase::Window if on => timeless(Phase::Run),
        Phase::Window => (Phase::Window, state.left.tick(), false),
        Phase::Start if inputs.current => timeless(Phase::Run),
        Phase::Start if !inputs.on => timeless(resting),
        Phase::Start if state.left.tick().is_zero() => (Phase::Off, Cycles::ZERO, true),
        Phase::Start => (Phase::Start, state.left.tick(), false),
        Phase::Run => {
            let suppressed = !inputs.pulses && (state.pulses_held || !inputs.on);
            let stands = config.unselected() && !inputs.on && inputs.still;
            if suppressed || stands {
                timeless(resting)
            } else {
                timeless(Phase::Run)
            }
        }
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let (phase, left, no_current) = if inputs.sto {
        (without_pulses(config, inputs), Cycles::ZERO, false)
    } else {
        proceed(&state, config, inputs)
    };
    let after = State {
        phase,
        left,
        sto_held: inputs.sto,
        function_held: selected(config, inputs),
        on_held: inputs.on,
        pulses_held: inputs.pulses,
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

    fn monitor(sls_unselected: bool) -> Monitor {
        let time = Cycles::new(3);
        let config = Config::new(time, time, true, true, sls_unselected, false);
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
                assert!(monitor.step(&inputs).sto);
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
