//! The stop that the requests of the safe PLC, the machine operating mode and the permissive demand for one axis group.
//!
//! A request is never trusted: a code that does not exist, a mode entered without SOM_1 between, a stricter state asked for
//! in motion, or a spindle without its permissive is answered by a stop, whatever the safe PLC asks for itself.
//!
//! Recommended readings of the manual implemented here: AMB-08 SKERN and AMB-67 SS2_THEN_SS1 (the kernel itself stops the
//! spindle, after the axes), AMB-28 (a program goes on without permissive unless the safe PLC stops it), AMB-72 SS1.

use crate::heidenhain::types::{GroupState, Kind, Stop, Unit};
use crate::kernel::ConfigError;

mod laws;

pub use laws::*;

config! {
    /// What is judged.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        kind: Kind,
        som_4: bool,
    }
}

impl Config {
    /// `kind`: what the group consists of. `som_4`: SMP560 bit 0, SOM_4 is enabled.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(kind: Kind, som_4: bool) -> Result<Self, ConfigError> {
        Ok(Self { kind, som_4 })
    }

    /// What the group consists of.
    pub const fn kind(&self) -> Kind {
        self.kind
    }

    /// SOM_4 is enabled.
    pub const fn som_4(&self) -> bool {
        self.som_4
    }
}

fields! {
    /// The modes with limited speed between which SOM_1 must come.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Modes {
        /// None requested since SOS or AUTO.
        #[default]
        None,
        /// SOM_2 or SOM_3.
        Low,
        /// SOM_4.
        High,
    }
}

fields! {
    /// Where the machine is operated: a change of it stops the groups.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Place {
        /// At the operating panel, by hand or by program.
        #[default]
        Panel,
        /// At the handwheel.
        Handwheel,
        /// Homing and testing of axes.
        Reference,
    }
}

impl Place {
    /// Where the machine is operated in a machine operating mode.
    pub const fn of(unit: Unit) -> Self {
        match unit {
            Unit::Panel | Unit::Program => Self::Panel,
            Unit::Handwheel => Self::Handwheel,
            Unit::Reference => Self::Reference,
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The last mode requested since SOS or AUTO.
        pub modes: Modes,
        /// Where the machine was operated in the cycle before.
        pub place: Place,
    }
}

impl State {
    /// No mode yet, at the operating panel.
    pub const INITIAL: Self = Self {
        modes: Modes::None,
        place: Place::Panel,
    };

    /// Every state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub main_switch: bool,
        /// The requested monitoring state (`PP_AxGrpStateReq`).
        pub request: GroupState,
        /// The requested stop (`PP_AxGrpStopReq`).
        pub stop_request: Stop,
        /// One of the two is no code of the interface.
        pub bad_code: bool,
        /// The monitoring state at the start of the cycle.
        pub state: GroupState,
        /// An axis of the group moves (`NN_AxGrpInMotion`).
        pub moving: bool,
        /// The machine operating mode.
        pub unit: Unit,
        /// A permissive is valid for the group (`PP_AxGrpPB`).
        pub permissive: bool,
        /// The protection against unexpected start-up responds.
        pub idle: bool,
        /// `NN_GenSafe`: the self-test has passed and is not overdue.
        pub gen_safe: bool,
        /// An axis moves that must not: outside the reference mode not homed, or not checked with the door open.
        pub untested: bool,
    }
}

fields! {
    /// The outputs of one cycle: which causes there are, and the highest of them. In the cycle of the main switch nothing
    /// follows from the causes.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// A fault of the request: SS1F.
        pub asks_ss1f: bool,
        /// Found by the kernel: SS1.
        pub asks_ss1: bool,
        /// SS1 of the spindle after the SS2 of the axes.
        pub asks_ss1d: bool,
        /// SS2 of the group.
        pub asks_ss2: bool,
        /// SS2 of the axis groups of the working space.
        pub stops_axes: bool,
        /// The highest of the causes and of the requested stop.
        pub demand: Stop,
    }
}

impl Outputs {
    /// The stop for the highest of the causes.
    const fn highest(&self) -> Stop {
        if self.asks_ss1f {
            Stop::Ss1F
        } else if self.asks_ss1 {
            Stop::Ss1
        } else if self.asks_ss1d {
            Stop::Ss1D
        } else if self.asks_ss2 {
            Stop::Ss2
        } else {
            Stop::None
        }
    }
}

impl Inputs {
    /// The stop that the safe PLC asks for; there is no code for SS0, so it would be a wrong one.
    const fn requested_stop(&self) -> Stop {
        match self.stop_request {
            Stop::Ss0 => Stop::Ss1F,
            stop => stop,
        }
    }

    /// The request makes the group stricter than its state by taking the release away.
    const fn ends_release(&self) -> bool {
        match self.request {
            GroupState::Sos => self.state.is_released(),
            GroupState::StoO | GroupState::Sto => !matches!(self.state, GroupState::Sto),
            _ => false,
        }
    }

    /// A spindle in this situation needs its permissive to go on: as the door opens, and then in all but SOM_4 at the panel
    /// and restricted operation, which it has to be started for.
    const fn needs_permissive(&self) -> bool {
        match self.state {
            GroupState::Sls2 | GroupState::Sls3 => true,
            GroupState::Sls4 => matches!(self.unit, Unit::Handwheel),
            GroupState::Auto => matches!(
                self.request,
                GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4 | GroupState::SlsS
            ),
            _ => false,
        }
    }
}

/// The mode that a request belongs to; none for one that belongs to no mode and changes nothing.
const fn modes(before: Modes, request: GroupState) -> Modes {
    match request {
        GroupState::Auto | GroupState::Sos => Modes::None,
        GroupState::Sls2 | GroupState::Sls3 => Modes::Low,
        GroupState::Sls4 => Modes::High,
        GroupState::SlsS | GroupState::StoO | GroupState::Sto => before,
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let place = Place::of(inputs.unit);
    let modes = modes(state.modes, inputs.request);
    let spindle = config.kind == Kind::Spindle;
    let released = inputs.state.is_released();
    let lost = inputs.moving && !inputs.permissive;
    let crossed = state.modes != Modes::None && modes != Modes::None && modes != state.modes;
    // Axes by the handwheel; the magazine and other auxiliary axes however they are operated.
    let by_hand = (inputs.unit == Unit::Handwheel || config.kind == Kind::Auxiliary)
        && matches!(
            inputs.state,
            GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4
        );
    let asks_ss1f = inputs.bad_code || crossed || (inputs.request == GroupState::SlsS && !spindle);
    let asks_ss1 = (inputs.moving && inputs.ends_release())
        || (inputs.request == GroupState::Sls4 && !config.som_4);
    let asks_ss1d = spindle && lost && inputs.needs_permissive();
    // The door is open where anything but AUTO is requested.
    let overdue = inputs.request != GroupState::Auto && !inputs.gen_safe;
    let asks_ss2 = (!spindle && lost && by_hand)
        || (released && (place != state.place || overdue || inputs.idle || inputs.untested));
    let after = if inputs.main_switch {
        State {
            modes: Modes::None,
            place,
        }
    } else {
        State { modes, place }
    };
    let outputs = Outputs {
        asks_ss1f,
        asks_ss1,
        asks_ss1d,
        asks_ss2,
        stops_axes: asks_ss1d,
        demand: Stop::None,
    };
    let demand = if inputs.main_switch {
        Stop::None
    } else {
        outputs.highest().max(inputs.requested_stop())
    };
    (after, Outputs { demand, ..outputs })
}
