//! Safe gearbox switchover in one channel: the stage, the increased tolerance while it changes, the synchronisation after it
//! (machine B14).

use crate::kernel::{ConfigError, Cycles};

fields! {
    /// A gear stage: bits 24 to 26 of S_STW2, 0 to 7.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub struct Stage(u8) in 0..=7;
}

impl Stage {
    /// The stage of the three bits, the highest first (S120-GEAR-001).
    pub const fn from_bits(bit2: bool, bit1: bool, bit0: bool) -> Self {
        Self((bit2 as u8) << 2 | (bit1 as u8) << 1 | bit0 as u8)
    }

    /// The number, 0 to 7: the index of p9521 and p9522.
    pub const fn get(self) -> u8 {
        self.0
    }
}

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        longest: Cycles,
    }
}

impl Config {
    /// `longest`: how long the increased tolerance may last: 2 min (S120-GEAR-004).
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] for no time at all.
    pub const fn new(longest: Cycles) -> Result<Self, ConfigError> {
        if longest.is_zero() {
            Err(ConfigError::NoDelay)
        } else {
            Ok(Self { longest })
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The stage in the cycle before.
        pub stage: Stage,
        /// A stage has been taken since POWER ON.
        pub known: bool,
        /// The tolerance was increased.
        pub raised: bool,
        /// What is left of its time.
        pub left: Cycles,
    }
}

impl State {
    /// No stage is known.
    pub const INITIAL: Self = Self {
        stage: Stage(0),
        known: false,
        raised: false,
        left: Cycles::ZERO,
    };

    /// The time belongs to the increased tolerance; nothing is kept before the first stage.
    pub fn invariant(&self, config: &Config) -> bool {
        self.left <= config.longest
            && (self.raised || self.left.is_zero())
            && (self.known || *self == Self::INITIAL)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The selected stage.
        pub stage: Stage,
        /// The increased tolerance is selected: bit 27 of S_STW2.
        pub raise: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stage (r9720.24 to r9720.26).
        pub stage: Stage,
        /// The tolerance of the comparison is multiplied by p9543 (r9720.27).
        pub raised: bool,
        /// The actual values of both channels are synchronised, once.
        pub synchronise: bool,
        /// The stage has changed: reference and user agreement are lost.
        pub changed: bool,
        /// The tolerance has been increased for too long: C01711 with value 1015, STOP F.
        pub too_long: bool,
    }
}

/// The stage is another one than before.
fn changes(s: &Step) -> bool {
    s.before.known && s.inputs.stage != s.before.stage
}

monitor! { sinamics::gear;
    /// The stage is the selected one.
    stage_follows ["S120-GEAR-001", "S120-GEAR-005"]:
        when |s| s.inputs.stage.get() <= 7
            => s.outputs.stage == s.inputs.stage && s.after.stage == s.inputs.stage && s.after.known;

    /// A change loses the reference and the agreement, with and without increased tolerance; nothing else does.
    change_loses_the_reference ["S120-GEAR-005", "S120-REF-006"]:
        when |s| s.before.known
            => s.outputs.changed == (s.inputs.stage != s.before.stage);

    /// The first stage after POWER ON is no change.
    first_stage_is_no_change ["S120-GEAR-005"]:
        when |s| !s.before.known
            => !s.outputs.changed && !s.outputs.synchronise && !s.outputs.too_long;

    /// A change without increased tolerance is synchronised at once, in this cycle only.
    change_is_synchronised ["S120-GEAR-002"]:
        when |s| s.before.known && !s.before.raised && !s.inputs.raise
            => s.outputs.synchronise == changes(&s);

    /// With it nothing is synchronised, whatever the stage does.
    raised_is_not_synchronised ["S120-GEAR-003"]:
        when |s| s.inputs.raise
            => s.outputs.raised && !s.outputs.synchronise;

    /// Its end is synchronised.
    end_is_synchronised ["S120-GEAR-003"]:
        when |s| s.before.raised && !s.inputs.raise
            => s.outputs.synchronise && !s.outputs.raised && !s.outputs.too_long;

    /// It has its time from its first cycle on.
    time_begins ["S120-GEAR-004"]:
        when |s| s.inputs.raise && !s.before.raised
            => s.after.left == s.config.longest && !s.outputs.too_long;

    /// Longer than that is told, and for as long as it lasts; not sooner.
    too_long_is_told ["S120-GEAR-004", "S120-PF-28"]:
        when |s| s.inputs.raise && s.before.raised
            => s.outputs.too_long == s.before.left.is_zero() && s.after.left == s.before.left.tick();

    /// The state stays consistent.
    state_stays_consistent ["S120-GEAR-003"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.raised == s.inputs.raise;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let changed = state.known && inputs.stage != state.stage;
    let begins = inputs.raise && !state.raised;
    let left = if begins {
        config.longest
    } else if inputs.raise {
        state.left.tick()
    } else {
        Cycles::ZERO
    };
    let outputs = Outputs {
        stage: inputs.stage,
        raised: inputs.raise,
        synchronise: !inputs.raise && (changed || state.raised),
        changed,
        too_long: inputs.raise && !begins && state.left.is_zero(),
    };
    let after = State {
        stage: inputs.stage,
        known: true,
        raised: inputs.raise,
        left,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-GEAR-003, S120-GEAR-004, Image 4-21: stage 0 to 1 with increased tolerance; 120 s in cycles of 12 ms are permitted.
    #[test]
    fn increased_tolerance() {
        let longest = Cycles::new(10_000);
        let mut monitor = Monitor::new(Config::new(longest).expect("accepted"));
        let first = Stage::from_bits(false, false, true);
        let mut step = |stage, raise| monitor.step(&Inputs { stage, raise });
        step(Stage(0), false);
        assert!(step(Stage(0), true).raised);
        let outputs = step(first, true);
        assert!(outputs.changed && !outputs.synchronise);
        for _ in 2..=10_000 {
            assert!(!step(first, true).too_long);
        }
        assert!(step(first, true).too_long);
        let outputs = step(first, false);
        assert!(outputs.synchronise && !outputs.changed && outputs.stage.get() == 1);
        assert!(!step(first, false).synchronise);
        assert_eq!(Stage::from_bits(true, true, false), Stage(6));
    }
}
