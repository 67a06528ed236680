//! Safely-limited increment (SLI): one increment a start, rest between.
//!
//! Under a demand nothing is watched: the acknowledgement begins a rest at the place where it comes. Readings: a start in the cycle
//! in which an increment ends does nothing, and one in the cycle of the acknowledgement neither (IEC-SLI-003, IEC-SLI-006); the cycle
//! of a start is still judged by the rest before it, the one in which an increment ends by the increment (IEC-SLI-002, IEC-SLI-004); a
//! start that rises in the cycle of the selection counts (IEC-SLI-001).

use crate::iec::common::{latch, rises};
use crate::kernel::{ConfigError, Cycles, Distance, Position};

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) increment: Distance,
        pub(crate) window: Distance,
        pub(crate) time: Cycles,
    }
}

impl Config {
    /// `increment`: so far the shaft may move from the place of a start, in either direction. `window`: so far from the place of a
    /// rest. `time`: of an increment.
    ///
    /// # Errors
    /// [`ConfigError::ToleranceTooLarge`] when the window is above the increment, [`ConfigError::NoDelay`] when the time is 0
    /// (IEC-SLI-009).
    pub const fn new(
        increment: Distance,
        window: Distance,
        time: Cycles,
    ) -> Result<Self, ConfigError> {
        if window.0 > increment.0 {
            return Err(ConfigError::ToleranceTooLarge);
        }
        if time.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            increment,
            window,
            time,
        })
    }

    /// How far the shaft may be from its place.
    const fn room(&self, phase: Phase) -> Distance {
        match phase {
            Phase::Moving => self.increment,
            Phase::Rest | Phase::Idle => self.window,
        }
    }
}

fields! {
    /// What is watched.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing: the function is not selected, or demands a stop.
        #[default]
        Idle,
        /// The rest.
        Rest,
        /// An increment.
        Moving,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is watched.
        pub phase: Phase,
        /// The place of the rest, or of the start; 0 while nothing is watched.
        pub from: Position,
        /// What is left of the time of the increment.
        pub left: Cycles,
        /// A stop is demanded.
        pub demand: bool,
        /// The acknowledgement was 1.
        pub ack_held: bool,
        /// The start was 1.
        pub start_held: bool,
    }
}

impl State {
    /// Nothing is watched, nothing demanded; signals that are 1 are no edges.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        from: Position(0),
        left: Cycles::ZERO,
        demand: false,
        ack_held: true,
        start_held: true,
    };

    /// An increment has time left; a function that demands a stop watches nothing.
    pub fn invariant(&self, config: &Config) -> bool {
        self.left <= config.time
            && (self.phase == Phase::Moving) != self.left.is_zero()
            && (self.phase != Phase::Idle || self.from == Position(0))
            && (self.phase == Phase::Idle || !self.demand)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The power has returned.
        pub power_on: bool,
        /// The function is selected.
        pub selected: bool,
        /// The position.
        pub position: Position,
        /// It is valid.
        pub valid: bool,
        /// Start of an increment.
        pub start: bool,
        /// Acknowledgement.
        pub ack: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The function demands a stop.
        pub stop: bool,
        /// An increment is permitted.
        pub permitted: bool,
    }
}

/// A stop was demanded when the cycle began.
fn demanded(s: &Step) -> bool {
    s.before.demand && !s.inputs.power_on
}

/// The acknowledgement has become 1.
fn acknowledges(s: &Step) -> bool {
    s.inputs.ack && !s.before.ack_held && !s.inputs.power_on
}

/// The start has become 1.
fn starts(s: &Step) -> bool {
    s.inputs.start && !s.before.start_held && !s.inputs.power_on
}

/// A selected function sees the shaft in a cycle that began in this phase.
fn watches(s: &Step, phase: Phase) -> bool {
    s.inputs.selected && s.inputs.valid && !s.inputs.power_on && s.before.phase == phase
}

/// The shaft is further from its place.
fn beyond(s: &Step, room: Distance) -> bool {
    let way = i64::from(s.inputs.position.0) - i64::from(s.before.from.0);
    way.unsigned_abs() > u64::from(room.0)
}

/// The rest is at the place of this cycle, and no stop demanded.
fn rests_here(s: &Step) -> bool {
    s.after.phase == Phase::Rest && s.after.from == s.inputs.position && !s.outputs.stop
}

/// An increment begins at the place of this cycle, and no stop is demanded.
fn moves_from_here(s: &Step) -> bool {
    s.after.phase == Phase::Moving
        && s.after.from == s.inputs.position
        && s.after.left == s.config.time
        && s.outputs.permitted
        && !s.outputs.stop
}

monitor! { iec::increment;
    /// At rest a shaft beyond the window is a violation in the same cycle, also where a start comes in it.
    rest_is_watched ["IEC-SLI-002", "IEC-SLI-004", "IEC-MON-006"]:
        when |s| watches(&s, Phase::Rest) && beyond(&s, s.config.window)
            => s.outputs.stop && !s.outputs.permitted;

    /// Within the window, its end included, the rest goes on around its place.
    rest_goes_on ["IEC-SLI-002", "IEC-MON-003"]:
        when |s| watches(&s, Phase::Rest) && !beyond(&s, s.config.window) && !starts(&s)
            => s.after.phase == Phase::Rest && s.after.from == s.before.from && !s.outputs.stop;

    /// A rising edge of the start permits an increment from the place where it comes.
    start_permits_an_increment ["IEC-SLI-001"]:
        when |s| watches(&s, Phase::Rest) && !beyond(&s, s.config.window) && starts(&s)
            => moves_from_here(&s);

    /// The rest begins in the cycle of the selection, at the place where the shaft is; a start that rises in it counts.
    selection_begins_the_rest ["IEC-SLI-008", "IEC-SLI-002", "IEC-SLI-001"]:
        when |s| s.inputs.selected && s.inputs.valid && !demanded(&s) && (s.inputs.power_on || s.before.phase == Phase::Idle)
            => if starts(&s) { moves_from_here(&s) } else { rests_here(&s) };

    /// In an increment a shaft further away than the increment is a violation in the same cycle, which ends it.
    increment_is_watched ["IEC-SLI-001", "IEC-SLI-004", "IEC-MON-006"]:
        when |s| watches(&s, Phase::Moving) && beyond(&s, s.config.increment)
            => s.outputs.stop && !s.outputs.permitted;

    /// Within the increment, its end included, in either direction, it goes on from the same place until its time has passed, whatever
    /// the start does.
    increment_goes_on ["IEC-SLI-001", "IEC-SLI-003", "IEC-MON-003"]:
        when |s| watches(&s, Phase::Moving) && !beyond(&s, s.config.increment) && s.before.left > Cycles::new(1)
            => s.after.phase == Phase::Moving && s.after.from == s.before.from && s.after.left == s.before.left.tick()
                && !s.outputs.stop;

    /// When its time has passed, the rest begins at the place of that cycle, whatever the start does.
    increment_ends ["IEC-SLI-003"]:
        when |s| watches(&s, Phase::Moving) && !beyond(&s, s.config.increment) && s.before.left == Cycles::new(1)
            => rests_here(&s) && !s.outputs.permitted;

    /// No increment begins without its own edge of the start, selection, a valid position and the end of every demand before it.
    one_increment_a_start ["IEC-SLI-001", "IEC-SLI-006"]:
        when |s| s.outputs.permitted && (s.before.phase != Phase::Moving || s.inputs.power_on)
            => starts(&s) && s.inputs.selected && s.inputs.valid && !demanded(&s);

    /// While a stop is demanded no start permits an increment, nor does one that comes with the acknowledgement.
    no_start_under_a_demand ["IEC-SLI-006"]:
        when |s| demanded(&s) || s.outputs.stop
            => !s.outputs.permitted;

    /// Without a valid position a selected function demands a stop in the same cycle, and watches nothing any more.
    invalid_is_a_violation ["IEC-SLI-005", "IEC-MON-005", "IEC-MON-006"]:
        when |s| s.inputs.selected && !s.inputs.valid
            => s.outputs.stop && s.after.phase == Phase::Idle;

    /// No stop is demanded without a violation.
    demand_has_a_cause ["IEC-SLI-004", "IEC-SLI-005"]:
        when |s| s.outputs.stop && !demanded(&s)
            => s.inputs.selected && (!s.inputs.valid
                || watches(&s, Phase::Rest) && beyond(&s, s.config.window)
                || watches(&s, Phase::Moving) && beyond(&s, s.config.increment));

    /// A demand stays without an edge of this channel's acknowledgement.
    demand_stays ["IEC-SLI-007", "IEC-MON-006", "IEC-MON-007", "IEC-MON-012"]:
        when |s| demanded(&s) && !acknowledges(&s)
            => s.outputs.stop;

    /// It ends only with a valid position, or without selection.
    acknowledged_with_a_position ["IEC-SLI-007", "IEC-SLI-005", "IEC-MON-012"]:
        when |s| demanded(&s) && !s.outputs.stop
            => acknowledges(&s) && (!s.inputs.selected || s.inputs.valid);

    /// There an edge ends it, and the rest begins at the place of that cycle.
    acknowledgement_begins_a_rest ["IEC-SLI-007"]:
        when |s| demanded(&s) && acknowledges(&s) && (!s.inputs.selected || s.inputs.valid)
            => if s.inputs.selected { rests_here(&s) } else { s.after.phase == Phase::Idle && !s.outputs.stop };

    /// The deselection ends everything but a demand, in the same cycle.
    deselection_is_no_acknowledgement ["IEC-SLI-008", "IEC-MON-002", "IEC-MON-008"]:
        when |s| !s.inputs.selected
            => s.after.phase == Phase::Idle && !s.outputs.permitted
                && s.outputs.stop == (demanded(&s) && !acknowledges(&s));

    /// Nowhere may the shaft be further from its place than an increment, and every increment has an end.
    increment_bounds_all ["IEC-SLI-009"]:
        when |s| s.inputs.selected && !s.outputs.stop && !s.inputs.power_on && s.before.phase != Phase::Idle
            => !beyond(&s, s.config.increment) && s.outputs.permitted != s.after.left.is_zero();

    /// When the power returns nothing is permitted, and nothing demanded but for a position that is not valid in that cycle.
    power_on_begins ["IEC-MON-010"]:
        when |s| s.inputs.power_on
            => !s.outputs.permitted && s.outputs.stop == (s.inputs.selected && !s.inputs.valid);

    /// The state stays consistent and remembers the signals.
    state_stays_consistent ["IEC-SLI-006", "IEC-MON-007"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.demand == s.outputs.stop
                && s.outputs.permitted == (s.after.phase == Phase::Moving)
                && s.after.ack_held == s.inputs.ack && s.after.start_held == s.inputs.start;
}

/// What is watched after a cycle that ends without a demand, of a function that is selected: phase, place, time left.
fn watched(
    state: &State,
    config: &Config,
    position: Position,
    started: bool,
) -> (Phase, Position, Cycles) {
    let left = state.left.tick();
    match state.phase {
        Phase::Moving if !left.is_zero() => (Phase::Moving, state.from, left),
        Phase::Moving => (Phase::Rest, position, Cycles::ZERO),
        Phase::Rest | Phase::Idle if started => (Phase::Moving, position, config.time),
        Phase::Rest => (Phase::Rest, state.from, Cycles::ZERO),
        Phase::Idle => (Phase::Rest, position, Cycles::ZERO),
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let state = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let moved = state.phase != Phase::Idle
        && inputs.position.distance(state.from) > config.room(state.phase);
    let violated = inputs.selected && (!inputs.valid || moved);
    let ready = !inputs.selected || inputs.valid;
    let edge = rises(inputs.ack, state.ack_held);
    let demand = latch(state.demand, violated, edge, ready);
    let started = rises(inputs.start, state.start_held) && !state.demand;
    let (phase, from, left) = if inputs.selected && !demand {
        watched(&state, config, inputs.position, started)
    } else {
        (Phase::Idle, Position(0), Cycles::ZERO)
    };
    let after = State {
        phase,
        from,
        left,
        demand,
        ack_held: inputs.ack,
        start_held: inputs.start,
    };
    let outputs = Outputs {
        stop: demand,
        permitted: phase == Phase::Moving,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(position: i32) -> Inputs {
        Inputs {
            selected: true,
            position: Position(position),
            valid: true,
            ..Inputs::default()
        }
    }

    fn start(position: i32) -> Inputs {
        Inputs {
            start: true,
            ..at(position)
        }
    }

    /// An increment of 100, a window of 5, 3 cycles.
    fn monitor() -> Monitor {
        let config = Config::new(Distance(100), Distance(5), Cycles::new(3));
        Monitor::new(config.expect("accepted"))
    }

    /// IEC-SLI-009; equal ones are accepted.
    #[test]
    fn parameters_have_their_rules() {
        let new = |window, time| Config::new(Distance(10), Distance(window), Cycles::new(time));
        assert_eq!(new(11, 1), Err(ConfigError::ToleranceTooLarge));
        assert_eq!(new(10, 0), Err(ConfigError::NoDelay));
        assert!(new(10, 1).is_ok());
    }

    /// IEC-SLI-001 to IEC-SLI-003: started in cycle k, over in cycle k + 3, the rest where the shaft is then; a start in between does
    /// nothing.
    #[test]
    fn an_increment() {
        let mut monitor = monitor();
        let run = [
            at(0),
            start(5),
            at(105),
            start(-95),
            at(-90),
            at(-95),
            at(-85),
            at(-96),
        ];
        let told = run.map(|inputs| {
            let outputs = monitor.step(&inputs);
            (outputs.permitted, outputs.stop)
        });
        let rest = (false, false);
        let moves = (true, false);
        let stop = (false, true);
        assert_eq!(told, [rest, moves, moves, moves, rest, rest, rest, stop]);
    }

    /// IEC-SLI-004: one further than the increment, in either direction.
    #[test]
    fn the_increment_is_limited() {
        for place in [106, -96] {
            let mut monitor = monitor();
            monitor.step(&at(0));
            assert!(monitor.step(&start(5)).permitted);
            let outputs = monitor.step(&at(place));
            assert!(outputs.stop && !outputs.permitted);
        }
    }

    /// IEC-SLI-006, IEC-SLI-007: a start held over the acknowledgement is none; the rest begins where that comes.
    #[test]
    fn a_held_start_is_none() {
        let mut monitor = monitor();
        monitor.step(&at(0));
        assert!(monitor.step(&at(6)).stop);
        let both = Inputs {
            ack: true,
            ..start(50)
        };
        let outputs = monitor.step(&both);
        assert!(!outputs.stop && !outputs.permitted);
        let outputs = monitor.step(&start(55));
        assert!(!outputs.stop && !outputs.permitted);
        assert!(!monitor.step(&at(45)).stop);
        assert!(monitor.step(&start(45)).permitted);
    }

    /// The ends of the numbers: nothing wraps.
    #[test]
    fn the_widest_way() {
        let widest = Distance(u32::MAX);
        let config = |window| Config::new(widest, window, Cycles::new(1)).expect("accepted");
        for (window, stop) in [(widest, false), (Distance(u32::MAX - 1), true)] {
            let mut monitor = Monitor::new(config(window));
            monitor.step(&at(i32::MIN));
            assert_eq!(monitor.step(&at(i32::MAX)).stop, stop);
        }
    }
}
