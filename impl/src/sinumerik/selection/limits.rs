//! The speed stages with their limits and the override factors: the parameters of the selection.

use crate::kernel::{ConfigError, Cycles, Percent, Speed};

fields! {
    /// A speed stage, selected by two signals.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Stage {
        /// SG1, bits (0,0).
        #[default]
        Sg1,
        /// SG2, bits (0,1).
        Sg2,
        /// SG3, bits (1,0).
        Sg3,
        /// SG4, bits (1,1).
        Sg4,
    }
}

impl Stage {
    /// The stage of the signals "SG selection bit 1, bit 0" (S840D-SG-002, S840D-SIGNAL-004).
    pub const fn from_bits(bit1: bool, bit0: bool) -> Self {
        match (bit1, bit0) {
            (false, false) => Self::Sg1,
            (false, true) => Self::Sg2,
            (true, false) => Self::Sg3,
            (true, true) => Self::Sg4,
        }
    }

    /// The number of the signals, 0 for SG1 to 3 for SG4.
    pub const fn index(self) -> u8 {
        match self {
            Self::Sg1 => 0,
            Self::Sg2 => 1,
            Self::Sg3 => 2,
            Self::Sg4 => 3,
        }
    }
}

fields! {
    /// The index of an override factor as four signals give it: 0 to 15.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct FactorIndex(u8) in 0..=15;
}

impl FactorIndex {
    /// Index 0: no signal set, or no factor in force.
    pub const NONE: Self = Self(0);

    /// The index of a number; `None` above 15.
    pub const fn new(index: u8) -> Option<Self> {
        if index <= 15 { Some(Self(index)) } else { None }
    }

    /// The index of the signals "SG override selection bit 3, 2, 1, 0"; a signal that is not configured counts as 0
    /// (S840D-OVR-001, S840D-OVR-002, S840D-SIGNAL-007).
    pub const fn from_bits(bit3: bool, bit2: bool, bit1: bool, bit0: bool) -> Self {
        Self(((bit3 as u8) << 3) | ((bit2 as u8) << 2) | ((bit1 as u8) << 1) | bit0 as u8)
    }

    /// The number, 0 to 15.
    pub const fn get(self) -> u8 {
        self.0
    }
}

fields! {
    /// A stage with the factor in force: what a limit is chosen by.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Choice {
        /// The stage.
        pub stage: Stage,
        /// The index of its factor; [`FactorIndex::NONE`] where none is in force.
        pub factor: FactorIndex,
    }
}

config! {
    /// Limits and delay of the changeover.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(super) enable: bool,
        pub(super) t_vel: Cycles,
        limits: [Speed; 4],
        pub(super) factors: Option<[Percent; 16]>,
    }
    accepted |config| {
        let Config { enable, t_vel, limits, factors } = *config;
        Config::new(enable, t_vel, limits).is_ok()
            && factors.is_none_or(|factors| factors.iter().all(|factor| factor.get() != 0))
    }
}

impl Config {
    /// `enable`: SBH and SG exist on the axis (bit 0 of the enable word). `t_vel`: delay to a lower limit or to SBH
    /// (`SAFE_VELO_SWITCH_DELAY`), 0 means at once. `limits`: SG1 to SG4, in any order of size.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] when `t_vel` is above [`Cycles::SIXTY_SECONDS`].
    pub fn new(enable: bool, t_vel: Cycles, limits: [Speed; 4]) -> Result<Self, ConfigError> {
        Ok(Self {
            enable,
            t_vel: t_vel.at_most(Cycles::SIXTY_SECONDS)?,
            limits,
            factors: None,
        })
    }

    /// The same with the override (bit 5 of the enable word): `factors` in percent (`SAFE_VELO_OVR_FACTOR`, 36932 / 1332),
    /// by the index of the override signals.
    ///
    /// # Errors
    /// [`ConfigError::FactorOutOfRange`] when a factor is not 1 to 100.
    pub fn with_override(self, factors: [u8; 16]) -> Result<Self, ConfigError> {
        let mut checked = [Percent::WHOLE; 16];
        for (place, factor) in checked.iter_mut().zip(factors) {
            if factor == 0 {
                return Err(ConfigError::FactorOutOfRange);
            }
            *place = Percent::new(factor)?;
        }
        Ok(Self {
            factors: Some(checked),
            ..self
        })
    }

    /// Whether the operating stop and the speed stages exist on the axis.
    pub const fn enabled(&self) -> bool {
        self.enable
    }

    /// The delay to a lower limit or to the operating stop.
    pub const fn t_vel(&self) -> Cycles {
        self.t_vel
    }

    /// What the signals choose: the factor counts in SG2 and SG4 only, and only where the override is enabled.
    pub const fn choice(&self, stage: Stage, over: FactorIndex) -> Choice {
        let factor = match (self.factors, stage) {
            (Some(_), Stage::Sg2 | Stage::Sg4) => over,
            _ => FactorIndex::NONE,
        };
        Choice { stage, factor }
    }

    /// The factor of a choice; the whole where none is in force.
    pub fn factor(&self, choice: Choice) -> Percent {
        match (self.factors, choice.stage) {
            (Some(factors), Stage::Sg2 | Stage::Sg4) => {
                let factor = factors.get(usize::from(choice.factor.get()));
                // Every index has a factor; if one had none, the limit would be 0.
                factor.copied().unwrap_or_default()
            }
            _ => Percent::WHOLE,
        }
    }

    /// The limit of a choice: that of the stage, reduced by the factor where one is in force, rounded down, so never above
    /// the exact one.
    pub fn effective(&self, choice: Choice) -> Speed {
        self.limit(choice.stage).reduced(self.factor(choice))
    }

    /// The limit of a stage without override.
    pub const fn limit(&self, stage: Stage) -> Speed {
        let [sg1, sg2, sg3, sg4] = self.limits;
        match stage {
            Stage::Sg1 => sg1,
            Stage::Sg2 => sg2,
            Stage::Sg3 => sg3,
            Stage::Sg4 => sg4,
        }
    }
}
