//! Safe referencing of one channel: not referenced, referenced, safely referenced (machine B9).
//!
//! A position that the control declares is safe once the operator has agreed to it in both channels. The agreement and the position
//! of the last standstill are kept over POWER ON and parking: a position declared afterwards is safe if it is where the axis was left.
//!
//! Reading AF-5 is a choice of the configuration, the recommended one first. The values of the agreement are parameters that may stay
//! as they are written: what counts is that both are AC hex at the same time, and that they were not so already as the position was
//! declared. Nobody can have compared that position with the real one before (3545).

use crate::kernel::{ConfigError, Cycles, Distance, Position};

fields! {
    /// Reading AF-5: what the 2 s of the agreement count from.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Ua {
        /// From the referencing: both channels must agree before they are over.
        #[default]
        Both,
        /// From the first of both values: the other must follow.
        Pair,
    }
}

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        window: Cycles,
        tolerance: Distance,
        agreement: Ua,
    }
}

impl Config {
    /// `window`: 2 s. `tolerance`: p9544, by how far the axis may have moved while it was off.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] without a window.
    pub const fn new(
        window: Cycles,
        tolerance: Distance,
        agreement: Ua,
    ) -> Result<Self, ConfigError> {
        if window.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            window,
            tolerance,
            agreement,
        })
    }
}

fields! {
    /// What is known of the position.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing.
        #[default]
        Not,
        /// The control has declared it.
        Referenced,
        /// It is safe.
        Safe,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is known of the position.
        pub phase: Phase,
        /// What is left of the window for the agreement.
        pub left: Cycles,
        /// The window is over without an agreement: a new one must be begun first.
        pub missed: bool,
        /// Both values have stood since before the position was declared: they are no agreement to it.
        pub stale: bool,
        /// The agreement is buffered (non-volatile).
        pub agreed: bool,
        /// The last position while it was safe (non-volatile); 0 without an agreement.
        pub stored: Position,
    }
}

impl State {
    /// Never referenced.
    pub const INITIAL: Self = Self {
        phase: Phase::Not,
        left: Cycles::ZERO,
        missed: false,
        stale: false,
        agreed: false,
        stored: Position(0),
    };

    /// A safe position has its agreement, a referenced one waits for it; window and miss belong to the latter.
    pub fn invariant(&self, config: &Config) -> bool {
        let agreement = match self.phase {
            Phase::Not => true,
            Phase::Referenced => !self.agreed,
            Phase::Safe => self.agreed,
        };
        let waits = self.phase == Phase::Referenced && !self.missed;
        let must = waits && config.agreement == Ua::Both;
        agreement
            && (self.agreed || self.stored == Position(0))
            && self.left <= config.window
            && (self.left.is_zero() || waits)
            && (!must || !self.left.is_zero())
            && (!self.missed || self.phase == Phase::Referenced)
            && (!self.stale || self.phase == Phase::Referenced)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// The axis is parked.
        pub parking: bool,
        /// The gear stage changes.
        pub gear_change: bool,
        /// The control declares the position: p9573 is written with 89.
        pub declared: bool,
        /// EPOS transfers a position.
        pub epos: bool,
        /// The axis stands.
        pub standstill: bool,
        /// p9726 is AC hex.
        pub agrees: bool,
        /// p9740 is AC hex: the other channel.
        pub other_agrees: bool,
        /// The actual position of this channel.
        pub position: Position,
    }
}

impl Inputs {
    /// The reference is lost.
    fn lost(&self) -> bool {
        self.power_on || self.parking || self.gear_change
    }

    /// A position is declared: by the control at standstill only.
    fn references(&self) -> bool {
        !self.lost() && (self.epos || self.declared && self.standstill)
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The axis is referenced (r9723.17).
        pub referenced: bool,
        /// It is safely referenced (r9722.23).
        pub safe: bool,
        /// The agreement was missed: C01711 with value 1002.
        pub missed: bool,
        /// The axis is not where it was left: fault, and an initial referencing is needed.
        pub moved: bool,
    }
}

/// Both channels agree in this cycle.
fn both_agree(s: &Step) -> bool {
    s.inputs.agrees && s.inputs.other_agrees
}

monitor! { sinamics::reference;
    /// A position gets safe by both channels' agreement after a referencing, or by lying where the axis was left; by nothing else.
    safe_has_its_reason ["S120-REF-001", "S120-REF-004", "S120-REF-005", "S120-PF-13"]:
        when |s| s.outputs.safe && s.before.phase != Phase::Safe
            => if s.before.agreed {
                s.inputs.references() && s.inputs.position.distance(s.before.stored) <= s.config.tolerance
            } else {
                s.before.phase == Phase::Referenced && s.inputs.agrees && s.inputs.other_agrees && !s.before.stale
            };

    /// Values that have stood since before the position was declared agree to nothing, until one of them is withdrawn.
    standing_values_are_no_agreement ["S120-REF-004", "S120-REF-008"]:
        when |s| s.inputs.references() && !s.before.agreed
            => s.after.stale == (s.inputs.agrees && s.inputs.other_agrees);

    /// One channel alone is never enough.
    one_channel_is_not_enough ["S120-REF-004", "S120-PF-13"]:
        when |s| s.before.phase == Phase::Referenced && s.inputs.agrees != s.inputs.other_agrees
            => !s.outputs.safe;

    /// POWER ON and parking lose the reference and keep the agreement.
    power_on_keeps_the_agreement ["S120-REF-006", "S120-SLP-001"]:
        when |s| (s.inputs.power_on || s.inputs.parking) && !s.inputs.gear_change
            => !s.outputs.referenced && !s.outputs.safe && s.after.agreed == s.before.agreed
                && s.after.stored == s.before.stored;

    /// A change of the gear stage loses both.
    gear_change_loses_both ["S120-REF-006", "S120-GEAR-005"]:
        when |s| s.inputs.gear_change
            => s.after == State::INITIAL && !s.outputs.referenced && !s.outputs.moved;

    /// A position is declared at standstill, or by EPOS in motion too.
    declaration_references ["S120-REF-002", "S120-REF-003", "S120-REF-009"]:
        when |s| s.inputs.references() && !s.before.agreed
            => s.outputs.referenced && !s.outputs.safe && !s.outputs.missed
                && (s.config.agreement == Ua::Pair || s.after.left == s.config.window);

    /// A declaration in motion is refused.
    declaration_in_motion_is_refused ["S120-REF-002", "S120-REF-009"]:
        when |s| s.before.phase == Phase::Not && !s.inputs.references()
            => !s.outputs.referenced && !s.outputs.moved;

    /// Where the axis was left, it is safe without a new agreement.
    place_is_remembered ["S120-REF-005"]:
        when |s| s.before.phase == Phase::Not && s.before.agreed && s.inputs.references()
            && s.inputs.position.distance(s.before.stored) <= s.config.tolerance
            => s.outputs.safe && s.outputs.referenced && !s.outputs.moved;

    /// Elsewhere it is a fault, and the agreement is gone.
    other_place_is_a_fault ["S120-REF-005", "S120-REF-008"]:
        when |s| s.before.phase == Phase::Not && s.before.agreed && s.inputs.references()
            && s.inputs.position.distance(s.before.stored) > s.config.tolerance
            => s.outputs.moved && !s.outputs.safe && s.after == State::INITIAL;

    /// Both values within their time make the position safe, and the agreement is kept.
    agreement_makes_it_safe ["S120-REF-004"]:
        when |s| s.before.phase == Phase::Referenced && !s.before.missed && !s.before.stale && s.inputs.agrees
            && s.inputs.other_agrees && !s.inputs.power_on && !s.inputs.parking && !s.inputs.gear_change && !s.inputs.epos && !s.inputs.declared
            => s.outputs.safe && s.after.agreed && s.after.stored == s.inputs.position;

    /// After a miss they count for nothing, until a new referencing, or until both have been withdrawn (AF-5).
    miss_is_not_made_good ["S120-REF-004", "S120-REF-008"]:
        when |s| s.before.missed
            => !s.outputs.safe;

    /// A window that ends without them is told once; the axis stays referenced.
    miss_is_told ["S120-REF-004"]:
        when |s| s.before.left == Cycles::new(1) && (!both_agree(&s) || s.before.stale) && !s.inputs.references()
            && !s.inputs.power_on && !s.inputs.parking && !s.inputs.gear_change
            && (s.inputs.agrees || s.inputs.other_agrees || s.config.agreement == Ua::Both)
            => s.outputs.missed && s.after.missed && s.outputs.referenced && !s.outputs.safe;

    /// Nothing else is told.
    nothing_else_is_told ["S120-REF-004", "S120-REF-008"]:
        when |s| s.before.left != Cycles::new(1)
            => !s.outputs.missed;

    /// While it is safe the position is remembered.
    safe_position_is_stored ["S120-REF-005"]:
        when |s| s.outputs.safe
            => s.after.agreed && s.after.stored == s.inputs.position && s.outputs.referenced;

    /// A safe reference lasts until it is lost or declared anew.
    safe_lasts ["S120-REF-001"]:
        when |s| s.before.phase == Phase::Safe && !s.inputs.power_on && !s.inputs.parking && !s.inputs.gear_change
            && !s.inputs.epos && !s.inputs.declared
            => s.outputs.safe;

    /// The state stays consistent.
    state_stays_consistent ["S120-REF-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.safe == (s.after.phase == Phase::Safe);
}

/// A declared position: safe where the axis was left, referenced where there is no agreement, else a fault.
fn declared(state: &State, config: &Config, inputs: &Inputs) -> State {
    if !state.agreed {
        let waits = config.agreement == Ua::Both;
        return State {
            phase: Phase::Referenced,
            left: if waits { config.window } else { Cycles::ZERO },
            stale: inputs.agrees && inputs.other_agrees,
            ..State::INITIAL
        };
    }
    if inputs.position.distance(state.stored) > config.tolerance {
        return State::INITIAL;
    }
    safe(inputs)
}

/// A safe position.
fn safe(inputs: &Inputs) -> State {
    State {
        phase: Phase::Safe,
        left: Cycles::ZERO,
        missed: false,
        stale: false,
        agreed: true,
        stored: inputs.position,
    }
}

/// A referenced position one cycle later, while nothing new is declared.
fn agreeing(state: &State, config: &Config, inputs: &Inputs) -> State {
    let (one, both) = (
        inputs.agrees || inputs.other_agrees,
        inputs.agrees && inputs.other_agrees,
    );
    let stale = state.stale && both;
    if state.missed {
        let again = config.agreement == Ua::Pair && !one;
        return State {
            missed: !again,
            stale,
            ..*state
        };
    }
    if both && !stale {
        return safe(inputs);
    }
    let left = match config.agreement {
        Ua::Both => state.left.tick(),
        // Nobody has agreed: no window runs.
        Ua::Pair if !one => {
            return State {
                left: Cycles::ZERO,
                stale,
                ..*state
            };
        }
        Ua::Pair if state.left.is_zero() => config.window,
        Ua::Pair => state.left.tick(),
    };
    State {
        left,
        missed: left.is_zero(),
        stale,
        ..*state
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = if inputs.gear_change {
        State::INITIAL
    } else if inputs.lost() {
        State {
            agreed: state.agreed,
            stored: state.stored,
            ..State::INITIAL
        }
    } else if inputs.references() {
        declared(&state, config, inputs)
    } else {
        match state.phase {
            Phase::Not => state,
            Phase::Referenced => agreeing(&state, config, inputs),
            Phase::Safe => safe(inputs),
        }
    };
    let outputs = Outputs {
        referenced: after.phase != Phase::Not,
        safe: after.phase == Phase::Safe,
        missed: after.missed && !state.missed,
        moved: inputs.references() && state.agreed && after.phase == Phase::Not,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn monitor(agreement: Ua) -> Monitor {
        let config = Config::new(Cycles::new(3), Distance(10), agreement);
        Monitor::new(config.expect("accepted"))
    }

    /// S120-REF-002, S120-REF-004, S120-REF-005, S120-REF-008: initial referencing, POWER ON, the axis where it was left, and elsewhere.
    #[test]
    fn initial_and_subsequent_referencing() {
        let mut monitor = monitor(Ua::Both);
        let mut inputs = Inputs {
            declared: true,
            standstill: true,
            position: Position(500),
            ..Inputs::default()
        };
        assert!(monitor.step(&inputs).referenced);
        inputs.declared = false;
        inputs.agrees = true;
        assert!(!monitor.step(&inputs).safe);
        inputs.other_agrees = true;
        assert!(monitor.step(&inputs).safe);
        let power_on = Inputs {
            power_on: true,
            ..Inputs::default()
        };
        for (position, safe) in [(510, true), (499, false), (510, false)] {
            monitor.step(&power_on);
            let outputs = monitor.step(&Inputs {
                declared: true,
                standstill: true,
                position: Position(position),
                ..Inputs::default()
            });
            assert_eq!(outputs.safe, safe);
            assert_eq!(outputs.moved, position == 499);
        }
    }

    /// S120-REF-004, S120-REF-008 (3545): values that nobody has withdrawn agree to no new position.
    #[test]
    fn an_agreement_that_stands_is_none() {
        let mut monitor = monitor(Ua::Both);
        let mut inputs = Inputs {
            declared: true,
            standstill: true,
            agrees: true,
            other_agrees: true,
            ..Inputs::default()
        };
        monitor.step(&inputs);
        inputs.declared = false;
        assert!(!monitor.step(&inputs).safe);
        inputs.agrees = false;
        assert!(!monitor.step(&inputs).safe);
        inputs.agrees = true;
        assert!(monitor.step(&inputs).safe, "withdrawn and given again");
    }

    /// S120-REF-004: without an agreement in time the message comes once (AF-5, both readings).
    #[test]
    fn the_agreement_has_its_time() {
        for agreement in Ua::ALL {
            let mut monitor = monitor(agreement);
            let mut inputs = Inputs {
                declared: true,
                standstill: true,
                ..Inputs::default()
            };
            monitor.step(&inputs);
            inputs.declared = false;
            inputs.agrees = true;
            let told: [bool; 6] = core::array::from_fn(|_| monitor.step(&inputs).missed);
            let expected = match agreement {
                Ua::Both => [false, false, true, false, false, false],
                Ua::Pair => [false, false, false, true, false, false],
            };
            assert_eq!(told, expected);
            inputs.other_agrees = true;
            assert!(!monitor.step(&inputs).safe);
        }
    }
}
