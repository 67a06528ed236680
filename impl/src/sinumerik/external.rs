//! Stops requested by signals, and the reaction to errors of the safe programmable logic, of one channel (machine M2).
//!
//! Four signals request STOP A, C, D and E; 0 requests. External stops work only together with the safe logic (SPL): until
//! its cross comparison has been started a STOP A is held. An error of the safe logic or of PROFIsafe is latched and
//! requests STOP D or E until RESET with the cause gone.

use crate::kernel::ConfigError;

use crate::sinumerik::level::ExternalStop;

config! {
    /// Which external stops exist.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        enable_ext: bool,
        enable_e: bool,
        spl_stop_e: bool,
    }
}

impl Config {
    /// `enable_ext`: external stops exist (bit 6 of the enable word). `enable_e`: external STOP E exists too (bit 4; it
    /// has no effect without bit 6, S840D-EXT-003). `spl_stop_e`: errors of the safe logic request STOP E instead of D
    /// (MD10097 = 4).
    ///
    /// # Errors
    /// [`ConfigError::StopENotEnabled`] when `spl_stop_e` is set without both enables (S840D-PARAM-505).
    pub fn new(enable_ext: bool, enable_e: bool, spl_stop_e: bool) -> Result<Self, ConfigError> {
        if spl_stop_e && !(enable_ext && enable_e) {
            return Err(ConfigError::StopENotEnabled);
        }
        Ok(Self {
            enable_ext,
            enable_e,
            spl_stop_e,
        })
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The cross comparison of the safe logic has been started since power-on.
        pub started: bool,
        /// An error of the safe logic waits for its acknowledgement.
        pub spl_latched: bool,
    }
}

impl State {
    /// The safe logic is not compared yet.
    pub const INITIAL: Self = Self {
        started: false,
        spl_latched: false,
    };

    /// Every state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// NC-RESET.
        pub reset: bool,
        /// The cross comparison of the safe logic has been started.
        pub spl_started: bool,
        /// SGE "de-select ext. STOP A": 0 requests pulse cancellation.
        pub sge_a: bool,
        /// SGE "de-select ext. STOP C": 0 requests braking with speed setpoint 0.
        pub sge_c: bool,
        /// SGE "de-select ext. STOP D": 0 requests braking along the path.
        pub sge_d: bool,
        /// SGE "de-select ext. STOP E": 0 requests extended stop and retract.
        pub sge_e: bool,
        /// An error of the safe logic or of PROFIsafe is present.
        pub spl_error: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stop requested from the arbitration.
        pub request: ExternalStop,
        /// The stop selected by the signals alone; none while external stops are not enabled.
        pub selected: ExternalStop,
        /// An error of the safe logic waits for its acknowledgement.
        pub spl_stop: bool,
    }
}

monitor! { sinumerik::external;
    /// Until the comparison of the safe logic has been started, STOP A is held.
    stop_a_until_comparison_runs ["S840D-P-19", "S840D-EXT-002"]:
        when |s| s.config.enable_ext && !s.after.started
            => s.outputs.request == ExternalStop::A;

    /// External STOP A selected: the other signals change nothing.
    stop_a_comes_first ["S840D-SH-002/b", "S840D-STOP-013/e", "S840D-P-18", "S840D-EXT-005", "S840D-EXT-001"]:
        when |s| s.config.enable_ext && !s.inputs.sge_a
            => s.outputs.request == ExternalStop::A && s.outputs.selected == ExternalStop::A;

    /// Of several requests the highest acts, in the order A, C, D, E.
    highest_request_acts ["S840D-P-18", "S840D-EXT-005", "S840D-EXT-013/b", "S840D-EXT-014", "S840D-EXT-001"]:
        when |s| s.config.enable_ext && s.after.started && s.inputs.sge_a
            && (!s.inputs.sge_c || !s.inputs.sge_d)
            => s.outputs.request == if s.inputs.sge_c { ExternalStop::D } else { ExternalStop::C };

    /// STOP E is requested by its signal when it is enabled and nothing higher is.
    stop_e_needs_its_enable ["S840D-EXT-003", "S840D-EXT-005", "S840D-EXT-001"]:
        when |s| s.config.enable_ext && s.inputs.sge_a && s.inputs.sge_c && s.inputs.sge_d && !s.inputs.sge_e
            => s.outputs.selected == if s.config.enable_e { ExternalStop::E } else { ExternalStop::None };

    /// All signals at 1 and no error of the safe logic: no request; external stops are not latched.
    withdrawal_ends_the_request ["S840D-EXT-008", "S840D-EXT-013/a", "S840D-EXT-019", "S840D-SIGNAL-026"]:
        when |s| s.after.started && s.inputs.sge_a && s.inputs.sge_c && s.inputs.sge_d && s.inputs.sge_e
            && !s.after.spl_latched
            => s.outputs.request == ExternalStop::None;

    /// Where external stops are not enabled the signals request nothing.
    no_request_without_enable ["S840D-EXT-003"]:
        when |s| !s.config.enable_ext
            => s.outputs.selected == ExternalStop::None
                && s.outputs.request == if s.after.spl_latched { ExternalStop::D } else { ExternalStop::None };

    /// An error of the safe logic requests at least STOP D, or E where so configured.
    spl_error_stops ["S840D-EXT-015"]:
        when |s| s.inputs.spl_error
            => s.after.spl_latched && s.outputs.spl_stop
                && s.outputs.request >= if s.config.spl_stop_e { ExternalStop::E } else { ExternalStop::D };

    /// The stop by the safe logic lasts until RESET or power-on with the cause gone.
    spl_stop_is_latched ["S840D-P-43", "S840D-EXT-015"]:
        when |s| s.before.spl_latched && !s.inputs.power_on
            => s.after.spl_latched == (s.inputs.spl_error || !s.inputs.reset)
                && s.outputs.spl_stop == s.after.spl_latched;

    /// Power-on clears the stop by the safe logic, unless its cause is present.
    power_on_clears_the_spl_stop ["S840D-EXT-015"]:
        when |s| s.inputs.power_on
            => s.after.spl_latched == s.inputs.spl_error;

    /// The start of the comparison is remembered until power-on.
    start_is_remembered ["S840D-EXT-002"]:
        when |s| s.before.started || s.inputs.spl_started
            => s.after.started == (s.inputs.spl_started || !s.inputs.power_on);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let after = State {
        started: before.started || inputs.spl_started,
        spl_latched: inputs.spl_error || (before.spl_latched && !inputs.reset),
    };
    let selected = if config.enable_ext {
        decode(config, inputs)
    } else {
        ExternalStop::None
    };
    let by_signals = if config.enable_ext && !after.started {
        ExternalStop::A
    } else {
        selected
    };
    let by_logic = match (after.spl_latched, config.spl_stop_e) {
        (false, _) => ExternalStop::None,
        (true, false) => ExternalStop::D,
        (true, true) => ExternalStop::E,
    };
    let outputs = Outputs {
        request: by_signals.max(by_logic),
        selected,
        spl_stop: after.spl_latched,
    };
    (after, outputs)
}

/// Table 5-12 of the manual: the highest requested stop, 0 requests.
fn decode(config: &Config, inputs: &Inputs) -> ExternalStop {
    let off_e = inputs.sge_e || !config.enable_e;
    match (inputs.sge_a, inputs.sge_c, inputs.sge_d, off_e) {
        (false, _, _, _) => ExternalStop::A,
        (true, false, _, _) => ExternalStop::C,
        (true, true, false, _) => ExternalStop::D,
        (true, true, true, false) => ExternalStop::E,
        (true, true, true, true) => ExternalStop::None,
    }
}
