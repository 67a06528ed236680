//! Monitoring of the operating stop (SBH) in one channel: the position stays in a window around the reference.
//!
//! What is monitored, and the reference, come from [`crate::sinumerik::selection`]. Leaving the window raises STOP B, which is not
//! configurable. There is neither a dead time nor a filter.

pub use crate::contract::Stateless as State;
use crate::kernel::{ConfigError, Distance, Position};
use crate::sinumerik::level::InternalStop;
use crate::sinumerik::selection::Monitored;

config! {
    /// The window.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        tol: Distance,
    }
}

impl Config {
    /// The largest tolerance the machine data allow: 100 mm or 100 degrees.
    pub const LARGEST: Distance = Distance(100_000);

    /// `tol`: half the width of the window (`SAFE_STANDSTILL_TOL`, 36930 / 1330).
    ///
    /// # Errors
    /// [`ConfigError::ToleranceTooLarge`] when `tol` is above [`Config::LARGEST`].
    pub const fn new(tol: Distance) -> Result<Self, ConfigError> {
        if tol.0 <= Self::LARGEST.0 {
            Ok(Self { tol })
        } else {
            Err(ConfigError::ToleranceTooLarge)
        }
    }

    /// Half the width of the window.
    pub const fn tolerance(&self) -> Distance {
        self.tol
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// What is monitored in this cycle.
        pub monitored: Monitored,
        /// The actual position.
        pub position: Position,
        /// The position captured when the operating stop became active.
        pub reference: Position,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The position is outside the window (alarms 27010, 300907).
        pub violated: bool,
        /// It is beyond the upper limit of the window, for the result list.
        pub upper: bool,
        /// It is beyond the lower limit of the window, for the result list.
        pub lower: bool,
        /// STOP B when violated.
        pub demand: InternalStop,
    }
}

monitor! { sinumerik::standstill;
    /// Outside the window STOP B is demanded in the same cycle.
    leaving_the_window_demands_stop_b ["S840D-P-04", "S840D-SBH-001", "S840D-SBH-005", "S840D-SBH-012", "S840D-TIMING-505",
        "S840D-PARAM-009", "S840D-ALARM-716", "S840D-ALARM-731", "S840D-ACCEPT-735"]:
        when |s| s.inputs.monitored == Monitored::Standstill
            && s.inputs.position.distance(s.inputs.reference) > s.config.tol
            => s.outputs.violated && s.outputs.demand == InternalStop::B;

    /// Inside the window, its limits included, nothing is demanded.
    inside_the_window_is_no_violation ["S840D-SBH-001", "S840D-KDV-516", "S840D-ARCH-509"]:
        when |s| s.inputs.position.distance(s.inputs.reference) <= s.config.tol
            => !s.outputs.violated && s.outputs.demand == InternalStop::None;

    /// Without the operating stop the position is free.
    watched_only_in_the_operating_stop ["S840D-SBH-002/b", "S840D-SBH-006"]:
        when |s| s.inputs.monitored != Monitored::Standstill
            => s.outputs == Outputs::default();

    /// A violation is on exactly one side, the side of the position.
    violation_has_one_side ["S840D-KDV-515"]:
        when |s| s.outputs.violated || s.outputs.upper || s.outputs.lower
            => s.outputs.violated
                && s.outputs.upper == (s.inputs.position > s.inputs.reference)
                && s.outputs.lower == (s.inputs.position < s.inputs.reference);
}

pub(crate) fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let outside = inputs.position.distance(inputs.reference) > config.tol;
    let violated = inputs.monitored == Monitored::Standstill && outside;
    let outputs = Outputs {
        violated,
        upper: violated && inputs.position > inputs.reference,
        lower: violated && inputs.position < inputs.reference,
        demand: if violated {
            InternalStop::B
        } else {
            InternalStop::None
        },
    };
    (State, outputs)
}
