//! Safely limited position (SLP) of one channel: two ranges, and the retraction from outside (machine B9).
//!
//! A range is monitored while SLP is selected and the axis safely referenced. A rising edge at the retract input makes SLP inactive
//! and one direction safe, toward the range; a falling edge brings SLP back. Only edges act, and an edge that finds nothing to
//! retract from is lost; an input that is at 1 in the first cycle is no edge.

use crate::kernel::{ConfigError, Position};
use crate::sinamics::types::{Stop, falls, rises};

fields! {
    /// A range of positions, both ends inside.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Range {
        /// p9535.
        pub lower: Position,
        /// p9534.
        pub upper: Position,
        /// p9562: the stop of this range.
        pub response: Stop,
    }
}

impl Range {
    /// The range can be left on both sides, and says what then happens.
    const fn fits(&self) -> bool {
        self.lower.0 < self.upper.0 && self.response.allowed(true)
    }
}

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        first: Range,
        second: Range,
    }
}

impl Config {
    /// `first`: range 1, index 0. `second`: range 2, index 1; with telegram 30 never selected (S120-SLP-006).
    ///
    /// # Errors
    /// [`ConfigError::LimitsCrossed`] when an upper limit is not above its lower one, [`ConfigError::StopNotAllowed`] for a response
    /// that is none.
    pub const fn new(first: Range, second: Range) -> Result<Self, ConfigError> {
        if first.lower.0 >= first.upper.0 || second.lower.0 >= second.upper.0 {
            return Err(ConfigError::LimitsCrossed);
        }
        if !(first.fits() && second.fits()) {
            return Err(ConfigError::StopNotAllowed);
        }
        Ok(Self { first, second })
    }

    /// The selected range.
    pub const fn range(&self, second: bool) -> &Range {
        if second { &self.second } else { &self.first }
    }
}

fields! {
    /// The retraction.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Retract {
        /// None.
        #[default]
        Off,
        /// From below the lower limit: SDI positive.
        Up,
        /// From above the upper limit: SDI negative.
        Down,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The retraction.
        pub retract: Retract,
        /// The retract input in the cycle before.
        pub input_held: bool,
    }
}

impl State {
    /// No retraction; the input counts once it has been 0.
    pub const INITIAL: Self = Self {
        retract: Retract::Off,
        input_held: true,
    };

    /// A retraction lasts as long as its input.
    pub fn invariant(&self, _config: &Config) -> bool {
        self.input_held || self.retract == Retract::Off
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SLP is selected.
        pub selected: bool,
        /// Range 2 is selected.
        pub second: bool,
        /// The axis is safely referenced (r9722.23).
        pub safe: bool,
        /// The actual position of this channel.
        pub position: Position,
        /// The retract input (p10009).
        pub retract: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// SLP is selected and enabled (r9722.6); says nothing of the reference.
        pub enabled: bool,
        /// SLP is active (S_ZSW.6): a range is monitored.
        pub active: bool,
        /// The position is below the lower limit of the monitored range: C01715, with 10 for range 1 and 20 for range 2.
        pub below: bool,
        /// It is above the upper one: the same message.
        pub above: bool,
        /// The stop that is raised.
        pub demand: Stop,
        /// SDI positive is selected by the retraction.
        pub sdi_positive: bool,
        /// SDI negative is selected by the retraction.
        pub sdi_negative: bool,
    }
}

/// The position is outside the selected range: below, above.
fn outside(config: &Config, inputs: &Inputs) -> (bool, bool) {
    let range = config.range(inputs.second);
    (inputs.position < range.lower, inputs.position > range.upper)
}

/// The retract input has become 1 and finds an axis that is monitored, and outside.
fn starts(s: &Step) -> bool {
    let edge = s.inputs.retract && !s.before.input_held;
    let (below, above) = outside(&s.config, &s.inputs);
    edge && s.inputs.selected && s.inputs.safe && (below || above)
}

monitor! { sinamics::slp;
    /// Monitored, a position beyond a limit is its stop, in the same cycle; the limit belongs to the range.
    limits_are_monitored ["S120-SLP-003", "S120-SLP-004", "S120-SLP-012", "S120-SLP-011"]:
        when |s| s.outputs.active
            => {
                let range = s.config.range(s.inputs.second);
                s.outputs.below == (s.inputs.position < range.lower)
                    && s.outputs.above == (s.inputs.position > range.upper)
                    && s.outputs.demand == if s.outputs.below || s.outputs.above {
                        range.response
                    } else {
                        Stop::None
                    }
            };

    /// Without selection or reference nothing is monitored.
    nothing_without_reference ["S120-SLP-001", "S120-SLP-003", "S120-SLP-011"]:
        when |s| !s.inputs.selected || !s.inputs.safe
            => !s.outputs.active && !s.outputs.below && !s.outputs.above && s.outputs.demand == Stop::None;

    /// With both it is, but for a retraction.
    reference_is_monitored ["S120-SLP-003", "S120-SLP-005", "S120-SLP-011"]:
        when |s| s.inputs.selected && s.inputs.safe && s.after.retract == Retract::Off
            => s.outputs.active;

    /// The safe signal says what is monitored, the diagnostic bit only what is selected.
    active_has_two_meanings ["S120-SLP-007", "S120-SLP-011", "S120-PF-12"]:
        when |s| s.after.retract == Retract::Off
            => s.outputs.enabled == s.inputs.selected && s.outputs.active == (s.outputs.enabled && s.inputs.safe);

    /// An edge at the retract input outside the range frees the way back, and only it.
    retraction_begins ["S120-SLP-009", "S120-PF-14"]:
        when |s| starts(&s)
            => {
                let (below, above) = outside(&s.config, &s.inputs);
                s.outputs.sdi_positive == below && s.outputs.sdi_negative == above && !s.outputs.active
                    && !s.outputs.enabled && s.outputs.demand == Stop::None
            };

    /// An edge that finds an axis inside, unselected or not safely referenced is lost.
    other_edges_are_lost ["S120-SLP-009", "S120-PF-14"]:
        when |s| s.before.retract == Retract::Off && !starts(&s)
            => s.after.retract == Retract::Off && !s.outputs.sdi_positive && !s.outputs.sdi_negative;

    /// A retraction has exactly one direction and no SLP, and goes on as long as the input is 1.
    retraction_goes_on ["S120-SLP-009", "S120-PF-14"]:
        when |s| s.before.retract != Retract::Off && s.inputs.retract
            => s.after.retract == s.before.retract && s.outputs.sdi_positive != s.outputs.sdi_negative
                && !s.outputs.active && !s.outputs.enabled;

    /// With the input it ends: SDI is deselected, SLP back; outside it trips again.
    retraction_ends ["S120-SLP-009", "S120-SLP-005"]:
        when |s| !s.inputs.retract
            => s.after.retract == Retract::Off && !s.outputs.sdi_positive && !s.outputs.sdi_negative
                && s.outputs.enabled == s.inputs.selected;

    /// The state stays consistent.
    state_stays_consistent ["S120-SLP-009"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.input_held == s.inputs.retract;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let (below, above) = outside(config, inputs);
    let monitorable = inputs.selected && inputs.safe;
    let retract = if falls(inputs.retract, state.input_held) {
        Retract::Off
    } else if rises(inputs.retract, state.input_held) && monitorable && below {
        Retract::Up
    } else if rises(inputs.retract, state.input_held) && monitorable && above {
        Retract::Down
    } else {
        state.retract
    };
    let enabled = inputs.selected && retract == Retract::Off;
    let active = enabled && inputs.safe;
    let outputs = Outputs {
        enabled,
        active,
        below: active && below,
        above: active && above,
        demand: if active && (below || above) {
            config.range(inputs.second).response
        } else {
            Stop::None
        },
        sdi_positive: retract == Retract::Up,
        sdi_negative: retract == Retract::Down,
    };
    let after = State {
        retract,
        input_held: inputs.retract,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(lower: i32, upper: i32) -> Range {
        Range {
            lower: Position(lower),
            upper: Position(upper),
            response: Stop::C,
        }
    }

    /// S120-SLP-003, S120-SLP-005, S120-SLP-012 with the ranges of Table A-5: 3000 to 10000 and 12000 to 20000.
    #[test]
    fn ranges_and_the_way_out() {
        let config = Config::new(range(3000, 10_000), range(12_000, 20_000)).expect("accepted");
        let mut monitor = Monitor::new(config);
        let mut step = |position, second, retract| {
            monitor.step(&Inputs {
                selected: true,
                second,
                safe: true,
                position: Position(position),
                retract,
            })
        };
        for position in [3000, 10_000] {
            assert_eq!(step(position, false, false).demand, Stop::None);
        }
        assert!(step(2999, false, false).below && step(10_001, false, false).above);
        assert_eq!(step(12_000, false, false).demand, Stop::C);
        assert_eq!(step(12_000, true, false).demand, Stop::None);
        let outputs = step(12_000, false, true);
        assert!(outputs.sdi_negative && !outputs.sdi_positive && !outputs.active);
        assert!(step(9_000, false, true).sdi_negative);
        assert!(step(9_000, false, false).active);
    }

    #[test]
    fn crossed_limits_are_refused() {
        let crossed = Config::new(range(1, 1), range(0, 1));
        assert_eq!(crossed, Err(ConfigError::LimitsCrossed));
    }
}
