//! Safe software limit switches (SE) of one channel: two pairs of end positions, one of them selected.
//!
//! A pair is watched while the function is enabled and active: with a user agreement, see
//! [`crate::sinumerik::agreement::Outputs::se_active`]. A position beyond an end raises the configured STOP C, D or E once the end has
//! been passed; nothing is predicted. The change to the other pair has no delay.

pub use crate::contract::Stateless as State;
use crate::kernel::{ConfigError, Position};
use crate::sinumerik::level::InternalStop;

fields! {
    /// The two ends of one pair.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    struct Ends {
        plus: Position,
        minus: Position,
    }
}

impl Ends {
    const fn new(plus: Position, minus: Position) -> Result<Self, ConfigError> {
        if plus.0 > minus.0 {
            Ok(Self { plus, minus })
        } else {
            Err(ConfigError::LimitsCrossed)
        }
    }
}

config! {
    /// The end positions and the reaction.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        enabled: bool,
        se1: Ends,
        se2: Ends,
        stop: InternalStop,
    }
    accepted |config| {
        [config.se1, config.se2].iter().all(|ends| Ends::new(ends.plus, ends.minus).is_ok())
            && matches!(config.stop, InternalStop::C | InternalStop::D | InternalStop::E)
    }
}

impl Config {
    /// `enabled`: bit 1 of the enable word. `plus`, `minus`: the ends of SE1 and SE2 (`SAFE_POS_LIMIT_PLUS`, 36934 / 1334,
    /// rounded down; `SAFE_POS_LIMIT_MINUS`, 36935 / 1335, rounded up). `stop_mode`: the reaction (`SAFE_POS_STOP_MODE`,
    /// 36962 / 1362): 2, 3, 4 for STOP C, D, E.
    ///
    /// # Errors
    /// [`ConfigError::LimitsCrossed`] when a plus end is not above its minus end, on a disabled function as well;
    /// [`ConfigError::StopNotAllowed`] when `stop_mode` is none of the three.
    pub fn new(
        enabled: bool,
        plus: [Position; 2],
        minus: [Position; 2],
        stop_mode: u8,
    ) -> Result<Self, ConfigError> {
        let ([plus_1, plus_2], [minus_1, minus_2]) = (plus, minus);
        Ok(Self {
            enabled,
            se1: Ends::new(plus_1, minus_1)?,
            se2: Ends::new(plus_2, minus_2)?,
            stop: match stop_mode {
                2 => InternalStop::C,
                3 => InternalStop::D,
                4 => InternalStop::E,
                _ => return Err(ConfigError::StopNotAllowed),
            },
        })
    }

    /// The plus end of the pair that the signal selects.
    pub const fn plus(&self, second: bool) -> Position {
        self.ends(second).plus
    }

    /// The minus end of the pair that the signal selects.
    pub const fn minus(&self, second: bool) -> Position {
        self.ends(second).minus
    }

    const fn ends(&self, second: bool) -> Ends {
        if second { self.se2 } else { self.se1 }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The limit switches may act: the user has agreed to the position.
        pub active: bool,
        /// SGE "SE selection": 0 selects SE1, 1 selects SE2.
        pub select: bool,
        /// The actual position.
        pub position: Position,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The selected pair is watched.
        pub watched: bool,
        /// The position is beyond the plus end (alarms 27012, 300915).
        pub upper: bool,
        /// The position is beyond the minus end (the same alarms).
        pub lower: bool,
        /// The configured stop when beyond an end.
        pub demand: InternalStop,
    }
}

monitor! { sinumerik::limit_switch;
    /// Beyond an end of the selected pair the configured stop is demanded in the same cycle.
    beyond_an_end_demands_the_stop ["S840D-P-49", "S840D-SE-001", "S840D-SE-004", "S840D-TIMING-507", "S840D-PARAM-013",
        "S840D-PARAM-026", "S840D-SIGNAL-006", "S840D-RETRACT-702", "S840D-ALARM-715"]:
        when |s| s.config.enabled && s.inputs.active
            && (s.inputs.position > s.config.plus(s.inputs.select) || s.inputs.position < s.config.minus(s.inputs.select))
            => s.outputs.demand == s.config.stop && s.outputs.demand.level().ends_in_standstill();

    /// Between the ends of the selected pair, or on one of them, nothing is demanded: the way out of the other pair.
    between_the_ends_is_no_violation ["S840D-SE-001", "S840D-SE-002", "S840D-SE-005", "S840D-ARCH-509",
        "S840D-SIGNAL-006", "S840D-RETRACT-702", "S840D-RETRACT-705",
        "S840D-ALARM-715"]:
        when |s| s.inputs.position <= s.config.plus(s.inputs.select) && s.inputs.position >= s.config.minus(s.inputs.select)
            => s.outputs.demand == InternalStop::None && !s.outputs.upper && !s.outputs.lower;

    /// Without enable or without agreement no position raises a stop.
    needs_enable_and_agreement ["S840D-P-12", "S840D-SE-003", "S840D-SE-005", "S840D-ALARM-715"]:
        when |s| !s.config.enabled || !s.inputs.active
            => s.outputs == Outputs::default();

    /// The side shown is the end that was passed, never both.
    violation_has_one_side ["S840D-KDV-515"]:
        when |s| s.outputs.demand != InternalStop::None || s.outputs.upper || s.outputs.lower
            => s.outputs.upper != s.outputs.lower && s.outputs.demand != InternalStop::None
                && s.outputs.upper == (s.inputs.position > s.config.plus(s.inputs.select));

    /// The monitor stays active beyond the end: the stop is demanded as long as the position is there.
    watched_while_active ["S840D-P-52", "S840D-SE-003", "S840D-SE-009", "S840D-RETRACT-705"]:
        when |s| s.config.enabled && s.inputs.active
            => s.outputs.watched;
}

pub(crate) fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let watched = config.enabled && inputs.active;
    let upper = watched && inputs.position > config.plus(inputs.select);
    let lower = watched && inputs.position < config.minus(inputs.select);
    let outputs = Outputs {
        watched,
        upper,
        lower,
        demand: if upper || lower {
            config.stop
        } else {
            InternalStop::None
        },
    };
    (State, outputs)
}
