//! Monitoring of the selected speed stage (SG) and of the encoder limit frequency in one channel.
//!
//! The limit in force comes from [`crate::sinumerik::selection`], override included. A higher speed raises the stop configured for the
//! stage. With one encoder for both channels the speed at the encoder is watched as well, whenever the operating stop or a
//! stage is active: above its limit frequency the encoder no longer checks its own signals.

pub use crate::contract::Stateless as State;
use crate::kernel::{ConfigError, Speed};
use crate::sinumerik::level::InternalStop;
use crate::sinumerik::selection::{Monitored, Stage};

config! {
    /// The reactions and the limits of the encoder.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        stops: [InternalStop; 4],
        encoder_max: Option<Speed>,
    }
    accepted |config| config.stops.iter().all(|stop| *stop != InternalStop::None)
}

impl Config {
    /// `stop_mode`: the stop of every stage (`SAFE_VELO_STOP_MODE`, 36961 / 1361): 0 to 4 for A to E, or 5 for one per stage,
    /// which `reactions` then gives for SG1 to SG4 (`SAFE_VELO_STOP_REACTION`, 36963 / 1363, 0 to 4). 10 to 14 mean the same
    /// as 0 to 4 with another reaction to a failure of the drive bus ([`crate::sinumerik::bus_failure`]).
    /// `encoder_max`: on an axis with one encoder the highest permitted speed at the encoder (see
    /// [`crate::sinumerik::encoder::Encoder::highest_speed`]), in the unit of [`Inputs::encoder_speed`]; `None` with two encoders.
    ///
    /// # Errors
    /// [`ConfigError::StopNotAllowed`] when a stop is none of these values, also one of `reactions` that is not used.
    pub fn new(
        stop_mode: u8,
        reactions: [u8; 4],
        encoder_max: Option<Speed>,
    ) -> Result<Self, ConfigError> {
        let [sg1, sg2, sg3, sg4] = reactions;
        let reactions = [stop(sg1)?, stop(sg2)?, stop(sg3)?, stop(sg4)?];
        Ok(Self {
            stops: if stop_mode == 5 {
                reactions
            } else {
                [stop(stop_mode)?; 4]
            },
            encoder_max,
        })
    }

    /// The stop configured for a stage.
    pub const fn stop(&self, stage: Stage) -> InternalStop {
        let [sg1, sg2, sg3, sg4] = self.stops;
        match stage {
            Stage::Sg1 => sg1,
            Stage::Sg2 => sg2,
            Stage::Sg3 => sg3,
            Stage::Sg4 => sg4,
        }
    }

    /// Whether a speed at the encoder is above the one its limit frequency permits.
    fn too_fast_for_the_encoder(&self, speed: Speed) -> bool {
        self.encoder_max.is_some_and(|highest| speed > highest)
    }
}

/// The stop of one value of the machine data.
const fn stop(value: u8) -> Result<InternalStop, ConfigError> {
    match value {
        0 | 10 => Ok(InternalStop::A),
        1 | 11 => Ok(InternalStop::B),
        2 | 12 => Ok(InternalStop::C),
        3 | 13 => Ok(InternalStop::D),
        4 | 14 => Ok(InternalStop::E),
        _ => Err(ConfigError::StopNotAllowed),
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// What is monitored in this cycle.
        pub monitored: Monitored,
        /// The magnitude of the actual speed, load side.
        pub speed: Speed,
        /// The limit in force (see [`crate::sinumerik::selection::Outputs::limit`]).
        pub limit: Speed,
        /// The stage in force (see [`crate::sinumerik::selection::Outputs::sga_sg`]).
        pub stage: Stage,
        /// The magnitude of the speed the encoder limit frequency is about. Ignored with two encoders.
        pub encoder_speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The speed is above the limit of the stage (alarms 27011, 300914).
        pub violated: bool,
        /// The speed is above the limit of the encoder (the same alarms).
        pub encoder_violated: bool,
        /// The stop to be raised.
        pub demand: InternalStop,
    }
}

monitor! { sinumerik::speed;
    /// Faster than the limit in force: the stop of the stage is demanded in the same cycle.
    faster_than_the_limit_demands_the_stop ["S840D-P-49", "S840D-SG-001", "S840D-SG-006", "S840D-TIMING-506",
        "S840D-TIMING-512", "S840D-PARAM-010", "S840D-ALARM-734", "S840D-ACCEPT-734"]:
        when |s| s.inputs.monitored == Monitored::Speed && s.inputs.speed > s.inputs.limit
            => s.outputs.violated && s.outputs.demand == s.config.stop(s.inputs.stage)
                && s.outputs.demand != InternalStop::None;

    /// At the limit and below the stage is not violated.
    at_the_limit_is_no_violation ["S840D-SG-001", "S840D-KDV-516", "S840D-ARCH-509"]:
        when |s| s.inputs.speed <= s.inputs.limit
            => !s.outputs.violated;

    /// Without a violation nothing is demanded.
    demand_needs_a_violation ["S840D-SG-001", "S840D-STOP-001"]:
        when |s| !s.outputs.violated && !s.outputs.encoder_violated
            => s.outputs.demand == InternalStop::None;

    /// Outside a speed stage the speed of the load is free.
    stage_watched_only_when_selected ["S840D-SG-005", "S840D-SG-012"]:
        when |s| s.inputs.monitored != Monitored::Speed
            => !s.outputs.violated;

    /// One encoder, faster than its limit: the stop of the active monitor, STOP B of the operating stop.
    encoder_too_fast_demands_the_stop ["S840D-FREQ-001", "S840D-PARAM-008", "S840D-ALARM-714"]:
        when |s| s.inputs.monitored != Monitored::Nothing
            && s.config.encoder_max.is_some_and(|highest| s.inputs.encoder_speed > highest)
            => s.outputs.encoder_violated
                && s.outputs.demand == if s.inputs.monitored == Monitored::Speed {
                    s.config.stop(s.inputs.stage)
                } else {
                    InternalStop::B
                };

    /// Neither with two encoders nor with nothing selected, nor at the limit, is the encoder's speed a violation.
    encoder_watched_only_with_one ["S840D-FREQ-001", "S840D-SG-012"]:
        when |s| s.inputs.monitored == Monitored::Nothing
            || s.config.encoder_max.is_none_or(|highest| s.inputs.encoder_speed <= highest)
            => !s.outputs.encoder_violated;
}

pub(crate) fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let active = inputs.monitored != Monitored::Nothing;
    let stage = inputs.monitored == Monitored::Speed;
    let violated = stage && inputs.speed > inputs.limit;
    let encoder_violated = active && config.too_fast_for_the_encoder(inputs.encoder_speed);
    let outputs = Outputs {
        violated,
        encoder_violated,
        demand: if !violated && !encoder_violated {
            InternalStop::None
        } else if stage {
            config.stop(inputs.stage)
        } else {
            InternalStop::B
        },
    };
    (State, outputs)
}
