//! The Extended Functions of an axis in one channel, with the arbiter of their stops.
//!
//! The functions run by their selections; what is latched is carried out by the arbiter, which also says when SAM or SBR watch and when the
//! operating stop holds.

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::sls::Level;
use stillpoint_monitors::sinamics::types::Stop as Demand;
use stillpoint_monitors::sinamics::{
    actual_value, sam, sbr, sdi, setpoint_limit, slp, sls, sos, ss1, ss2, ssm, stop_arbiter,
};

use super::messages::{Message, Messages};
use super::signals::{Flag, Number, Read};
use super::values::{BrakingMonitor, Extended};

/// For so many cycles the results of the channels may differ: one hears of the other a cycle later.
const APART: u32 = 3;

/// What the channels compare with each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Results {
    stop: Stop,
    function: Function,
    sos: bool,
    sls: bool,
    sls_level: u8,
    sdi: [bool; 2],
    slp: bool,
}

/// What the functions of an axis read beside the bits.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub position: Position,
    pub speed: Speed,
    /// STO is selected, and SS1 of the Extended Functions.
    pub sto: bool,
    pub ss1: bool,
    /// SS1 of the Basic Functions brakes, and has ended in STO.
    pub basic_ss1: bool,
    pub basic_sto: bool,
    /// The pulses are enabled.
    pub drive_on: bool,
    /// The stop of the communication.
    pub communication: Stop,
    /// Position and results of both channels, this one first, in the cycle before.
    pub positions: [Position; 2],
    pub results: [Results; 2],
}

/// What raises stops in a cycle.
#[derive(Clone, Copy)]
pub(super) struct Raised {
    pub request: Stop,
    pub difference: bool,
    pub messages: Messages,
    cause: &'static str,
    monitored: bool,
}

/// What the functions tell.
#[derive(Clone, Copy, Default)]
pub(super) struct Told {
    pub ss1: ss1::Outputs,
    pub ss2: ss2::Outputs,
    pub sos: sos::Outputs,
    pub sos_reference: Position,
    pub sls: sls::Outputs,
    pub sdi: [sdi::Outputs; 2],
    pub slp: slp::Outputs,
    pub slp_second: bool,
    pub ssm: ssm::Outputs,
    /// What SAM or SBR compares the speed with.
    pub braking_limit: Speed,
    pub arbiter: stop_arbiter::Outputs,
    pub function: Function,
    pub setpoint: Option<setpoint_limit::Outputs>,
    pub results: Results,
    /// Of what is latched.
    pub cause: &'static str,
    pub messages: Messages,
    /// A function is active whose stop does not wait for ESR.
    pub undelayed: bool,
}

enum Ramp {
    Sam(sam::Monitor),
    Sbr(sbr::Monitor),
}

/// The monitors.
pub(super) struct Functions {
    config: Extended,
    arbiter: stop_arbiter::Monitor,
    ss1: ss1::Monitor,
    ss2: ss2::Monitor,
    sos: sos::Monitor,
    sls: sls::Monitor,
    sdi: Option<[sdi::Monitor; 2]>,
    slp: Option<slp::Monitor>,
    ssm: ssm::Monitor,
    ramp: Ramp,
    actual: actual_value::Monitor,
    setpoint: Option<setpoint_limit::Monitor>,
    /// Cycles for which the results have differed.
    differ: u32,
    /// SAM or SBR was violated in the cycle before.
    violated: bool,
    told: Told,
}

/// The stop that a function raises as the arbiter hears it.
const fn level(demand: Demand) -> Stop {
    match demand {
        Demand::None => Stop::None,
        Demand::E => Stop::E,
        Demand::D => Stop::D,
        Demand::C => Stop::C,
        Demand::B => Stop::B,
        Demand::A => Stop::A,
    }
}

const fn stop_a(raised: bool) -> Stop {
    match raised {
        true => Stop::A,
        false => Stop::None,
    }
}

impl Functions {
    /// At POWER ON.
    pub(super) fn new(config: &Extended) -> Self {
        Self {
            arbiter: stop_arbiter::Monitor::new(config.arbiter),
            ss1: ss1::Monitor::new(config.ss1),
            ss2: ss2::Monitor::new(config.ss2),
            sos: sos::Monitor::new(config.sos),
            sls: sls::Monitor::new(config.sls),
            sdi: config.sdi.map(|both| both.map(sdi::Monitor::new)),
            slp: config.slp.map(slp::Monitor::new),
            ssm: ssm::Monitor::new(config.ssm),
            ramp: match config.braking {
                BrakingMonitor::Sam(config) => Ramp::Sam(sam::Monitor::new(config)),
                BrakingMonitor::Sbr(config) => Ramp::Sbr(sbr::Monitor::new(config)),
            },
            actual: actual_value::Monitor::new(config.actual),
            setpoint: config.setpoint.map(setpoint_limit::Monitor::new),
            differ: 0,
            violated: false,
            told: Told::default(),
            config: config.clone(),
        }
    }

    /// What they told in the cycle before.
    pub(super) fn told(&self) -> &Told {
        &self.told
    }

    /// The functions, and what they raise.
    pub(super) fn watch(&mut self, bits: &Read, seen: &Seen) -> Raised {
        let before = self.told.arbiter;
        let selected = |flag| !bits.is(flag);
        let speed = seen.speed;
        let told = &mut self.told;
        told.ss1 = self.ss1.step(&ss1::Inputs {
            selected: seen.ss1,
            stop_b: false,
            sto: seen.sto || seen.basic_sto || before.stop >= Stop::A,
            drive_on: seen.drive_on,
            ramp_violated: self.violated,
            speed,
        });
        told.ss2 = self.ss2.step(&ss2::Inputs {
            ss2: selected(Flag::Ss2),
            ss2e: selected(Flag::Ss2e),
            // Only what it gives way to; the arbiter carries out the others.
            stop: match before.stop >= Stop::B {
                true => Demand::B,
                false => Demand::None,
            },
            ss1_or_sto: seen.sto || seen.ss1 || seen.basic_ss1 || seen.basic_sto,
            sos_active: false,
            ramp_violated: self.violated,
        });
        told.sos = self.sos.step(&sos::Inputs {
            selected: selected(Flag::Sos),
            held: told.ss2.sos || before.sos,
            position: seen.position,
            renew: false,
        });
        told.sos_reference = self.sos.state().reference;
        let bit = |k: u32| bits.of(Number::Level) >> k & 1 == 1;
        told.sls = self.sls.step(&sls::Inputs {
            selected: selected(Flag::Sls),
            level: Level::from_bits(bit(1), bit(0)),
            telegram: i16::try_from(bits.of(Number::Limit)).unwrap_or(0),
            drive_on: seen.drive_on,
            sos_after_stop: before.sos,
            speed,
        });
        told.slp_second = bits.is(Flag::SlpRange);
        if let Some(slp) = &mut self.slp {
            told.slp = slp.step(&slp::Inputs {
                selected: selected(Flag::Slp),
                second: told.slp_second,
                safe: bits.is(Flag::Referenced),
                position: seen.position,
                retract: bits.is(Flag::Retract),
            });
        }
        let retracts = [told.slp.sdi_positive, told.slp.sdi_negative];
        let flags = [Flag::SdiPositive, Flag::SdiNegative];
        if let Some(sdi) = &mut self.sdi {
            for (k, sdi) in sdi.iter_mut().enumerate() {
                told.sdi[k] = sdi.step(&sdi::Inputs {
                    selected: selected(flags[k]) || retracts[k],
                    position: seen.position,
                    pulses: seen.drive_on,
                });
            }
        }
        told.ssm = self.ssm.step(&ssm::Inputs {
            speed,
            pulses: seen.drive_on,
        });
        let braking = told.ss1.monitored || told.ss2.off3 || before.ramp_watched;
        let (violated, ramp) = match &mut self.ramp {
            Ramp::Sam(sam) => {
                let said = sam.step(&sam::Inputs {
                    braking,
                    speed,
                    encoder_fault: false,
                });
                told.braking_limit = said.limit;
                (said.violated, level(said.demand))
            }
            Ramp::Sbr(sbr) => {
                let said = sbr.step(&sbr::Inputs { braking, speed });
                told.braking_limit = said.limit;
                (said.violated, stop_a(said.violated))
            }
        };
        self.violated = violated;
        self.raised(seen, violated, ramp)
    }

    fn raised(&mut self, seen: &Seen, violated: bool, ramp: Stop) -> Raised {
        let told = &self.told;
        let [own, other] = seen.positions;
        let apart = self.actual.step(&actual_value::Inputs {
            own,
            other,
            raised: false,
            synchronise: false,
        });
        self.differ = match seen.results[0] == seen.results[1] {
            true => 0,
            false => (self.differ + 1).min(APART),
        };
        let difference = self.differ >= APART || apart.exceeded;
        let sdi = told.sdi[0].demand.max(told.sdi[1].demand);
        // The end of STOP B is the arbiter's: SS1 raises none of its own.
        let raised = [
            (seen.communication, "no valid telegram"),
            (
                ramp.max(stop_a(told.ss2.violated || told.ss1.violated)),
                "braking is not as SAM or SBR allows",
            ),
            (level(told.sos.demand), "outside the window of SOS"),
            (level(told.slp.demand), "outside the range of SLP"),
            (level(sdi), "against the direction of SDI"),
            (level(told.sls.demand), "faster than SLS allows"),
        ];
        let highest = raised.iter().rev().max_by_key(|(stop, _)| *stop);
        let (request, cause) = *highest.unwrap_or(&(Stop::None, ""));
        let watching = told.sls.active || told.slp.active || told.sdi.iter().any(|s| s.active);
        Raised {
            request,
            difference,
            cause: match (request, difference) {
                (Stop::None, true) => "the channels differ",
                (Stop::None, false) => "",
                _ => cause,
            },
            messages: Messages::default()
                .with(Message::Ramp, violated)
                .with(Message::Sos, told.sos.violated)
                .with(Message::Sls, told.sls.violated || told.sls.wrong_value)
                .with(Message::Slp, told.slp.below || told.slp.above)
                .with(Message::Sdi, told.sdi.iter().any(|s| s.violated))
                .with(Message::Crosscheck, difference),
            monitored: watching,
        }
    }

    /// The arbiter, and what the setpoint may be.
    pub(super) fn arbitrate(
        &mut self,
        bits: &Read,
        seen: &Seen,
        raised: &Raised,
        acknowledge: bool,
    ) -> &Told {
        let told = &mut self.told;
        let selected = |flag| !bits.is(flag);
        let (ss1, ss2) = (&told.ss1, &told.ss2);
        told.function = if seen.sto || seen.basic_sto || ss1.sto {
            Function::Sto
        } else if ss1.active || seen.basic_ss1 {
            Function::Ss1
        } else if ss2.off3 {
            Function::Ss2
        } else if ss2.ss2e_active && !ss2.sos {
            Function::Ss2e
        } else if told.sos.active && (selected(Flag::Sos) || ss2.sos) {
            Function::Sos
        } else if raised.monitored {
            Function::Watching
        } else {
            Function::None
        };
        let before = told.arbiter.stop;
        let arbiter = self.arbiter.step(&stop_arbiter::Inputs {
            power_on: false,
            request: raised.request,
            remaining: raised.request,
            difference: raised.difference,
            function: told.function,
            standstill: seen.speed < self.config.shutdown,
            acknowledge,
        });
        told.cause = match (arbiter.initiated, raised.request) {
            _ if arbiter.stop == Stop::None && !arbiter.fault => "",
            (Stop::None, Stop::None) if told.cause.is_empty() => raised.cause,
            (Stop::None, _) => told.cause,
            (Stop::A, request) if request < Stop::A && before == Stop::B => "STOP B has ended",
            (Stop::B, request) if request < Stop::B => "STOP F: the channels differ",
            _ => raised.cause,
        };
        let initiated = |stop| arbiter.initiated == stop;
        told.messages = raised
            .messages
            .with(Message::A, initiated(Stop::A))
            .with(Message::B, initiated(Stop::B))
            .with(Message::C, initiated(Stop::C))
            .with(Message::D, initiated(Stop::D))
            .with(Message::E, initiated(Stop::E));
        told.arbiter = arbiter;
        told.results = Results {
            stop: arbiter.stop,
            function: told.function,
            sos: told.sos.active,
            sls: told.sls.active,
            sls_level: told.sls.level.index(),
            sdi: [told.sdi[0].active, told.sdi[1].active],
            slp: told.slp.active,
        };
        let low = |code: i64| code < 10;
        let level = usize::from(told.sls.level.index());
        let config = &self.config;
        told.undelayed = told.sls.active && low(config.sls_codes[level])
            || told.sdi.iter().any(|s| s.active) && low(config.sdi_code)
            || told.slp.active && low(config.slp_codes[usize::from(told.slp_second)]);
        let level = usize::try_from(bits.of(Number::Level)).unwrap_or(0);
        told.setpoint = self.setpoint.as_mut().map(|setpoint| {
            setpoint.step(&setpoint_limit::Inputs {
                sls: selected(Flag::Sls),
                limit: config.limits[level.min(3)],
                sdi_positive: config.sdi.is_some() && selected(Flag::SdiPositive),
                sdi_negative: config.sdi.is_some() && selected(Flag::SdiNegative),
                acceptance: bits.is(Flag::Acceptance),
                stop_f: arbiter.fault,
            })
        });
        &self.told
    }
}
