//! The Extended Functions of an axis in one channel, with the arbiter of their stops.
//!
//! The functions run by their selections; what is latched is carried out by the arbiter, which also says when SAM or SBR watch and when the
//! operating stop holds.

mod told;

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinamics::cross_check::Results;
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::sls::Level;
use stillpoint_monitors::sinamics::types::Stop as Demand;
use stillpoint_monitors::sinamics::{
    acceptance_mode, actual_value, cross_check, gear, reference, safe_position, sam, sbr, sdi,
    setpoint_limit, slp, sls, sls_ramp, sos, ss1, ss2, ssm, stop_arbiter,
};

use self::told::texts;
pub(super) use self::told::{Raised, Told};
use super::messages::{Message, Messages};
use super::signals::{Flag, Number, Read};
use super::values::{BrakingMonitor, Extended};

/// What the functions of an axis read beside the bits.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub position: Position,
    pub speed: Speed,
    /// The speed is not known: it counts as one that no standstill is.
    pub unknown: bool,
    /// The terminals may differ.
    pub tolerated: bool,
    /// The encoder has failed.
    pub encoder_fault: bool,
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
    /// The user agreement of the other channel in the cycle before.
    pub other_agrees: bool,
    /// This is channel 2.
    pub second: bool,
    /// Without encoder: its actual value is not plausible.
    pub wrong: bool,
    /// The stops of this drive are acknowledged in this cycle.
    pub acknowledges: bool,
}

enum Ramp {
    Sam(sam::Monitor),
    Sbr(sbr::Monitor),
}

enum Limit {
    Delayed(sls::Monitor),
    Ramp(sls_ramp::Monitor),
}

/// The monitors.
pub(super) struct Functions {
    config: Extended,
    arbiter: stop_arbiter::Monitor,
    ss1: ss1::Monitor,
    ss2: Option<ss2::Monitor>,
    sos: sos::Monitor,
    mode: Option<acceptance_mode::Monitor>,
    sls: Limit,
    sdi: Option<[sdi::Monitor; 2]>,
    slp: Option<slp::Monitor>,
    reference: Option<reference::Monitor>,
    gear: Option<gear::Monitor>,
    transferred: Option<safe_position::Monitor>,
    ssm: ssm::Monitor,
    ramp: Ramp,
    actual: actual_value::Monitor,
    setpoint: Option<setpoint_limit::Monitor>,
    check: cross_check::Monitor,
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
    /// At POWER ON, never referenced; or running, safely referenced at the position that is read, in the acceptance test mode where that
    /// is asked for.
    pub(super) fn new(config: &Extended, running: Option<&Read>) -> Self {
        let referenced = |config: reference::Config| {
            let state = running.map_or(reference::State::INITIAL, |read| reference::State {
                phase: reference::Phase::Safe,
                agreed: true,
                stored: Position(read.of(Number::Position)),
                ..reference::State::INITIAL
            });
            resumed!(reference, config, state)
        };
        let mut mode = config.acceptance.map(acceptance_mode::Monitor::new);
        if let (Some(mode), Some(_)) = (&mut mode, running) {
            // It was not asked for before: it begins in the first cycle.
            let _ = mode.step(&acceptance_mode::Inputs::default());
        }
        Self {
            arbiter: stop_arbiter::Monitor::new(config.arbiter),
            ss1: ss1::Monitor::new(config.ss1),
            ss2: config.ss2.map(ss2::Monitor::new),
            sos: sos::Monitor::new(config.sos),
            mode,
            sls: match config.sls_ramp {
                Some(ramp) => Limit::Ramp(sls_ramp::Monitor::new(ramp)),
                None => Limit::Delayed(sls::Monitor::new(config.sls)),
            },
            sdi: config.sdi.map(|both| both.map(sdi::Monitor::new)),
            slp: config.slp.map(slp::Monitor::new),
            reference: config.reference.map(referenced),
            gear: config.gear.map(gear::Monitor::new),
            transferred: config.position.map(safe_position::Monitor::new),
            ssm: ssm::Monitor::new(config.ssm),
            ramp: match config.braking {
                BrakingMonitor::Sam(config) => Ramp::Sam(sam::Monitor::new(config)),
                BrakingMonitor::Sbr(config) => Ramp::Sbr(sbr::Monitor::new(config)),
            },
            actual: actual_value::Monitor::new(config.actual),
            setpoint: config.setpoint.map(setpoint_limit::Monitor::new),
            check: cross_check::Monitor::new(config.check),
            violated: false,
            told: Told::default(),
            config: config.clone(),
        }
    }

    /// At POWER ON: what is not volatile is that of the user agreement.
    pub(super) fn again(&self) -> Self {
        let mut functions = Self::new(&self.config, None);
        functions.reference = self.reference;
        functions
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
        // What ends at standstill does not end where nobody knows the speed.
        let braked = match seen.unknown {
            true => speed.max(self.config.shutdown),
            false => speed,
        };
        let told = &mut self.told;
        told.ss1 = self.ss1.step(&ss1::Inputs {
            selected: seen.ss1,
            stop_b: false,
            sto: seen.sto || seen.basic_sto || before.stop >= Stop::A,
            drive_on: seen.drive_on,
            ramp_violated: self.violated,
            speed: braked,
        });
        if let Some(ss2) = &mut self.ss2 {
            told.ss2 = ss2.step(&ss2::Inputs {
                ss2: selected(Flag::Ss2),
                ss2e: selected(Flag::Ss2e),
                // The arbiter carries out the stops. What SS2 gives way to is no reason for its operating stop: a stop that holds that would be the
                // cause of its own violation, and nothing could acknowledge it.
                stop: Demand::None,
                ss1_or_sto: seen.sto
                    || seen.ss1
                    || seen.basic_ss1
                    || seen.basic_sto
                    || before.stop >= Stop::B,
                sos_active: false,
                ramp_violated: self.violated,
            });
        }
        if let Some(mode) = &mut self.mode {
            told.mode = mode.step(&acceptance_mode::Inputs {
                power_on: false,
                request: bits.is(Flag::Acceptance),
                position_test: false,
                standing: told.sos.active,
                sos_acknowledged: seen.acknowledges && told.sos.active,
            });
        }
        told.sos = self.sos.step(&sos::Inputs {
            selected: selected(Flag::Sos),
            held: told.ss2.sos || before.sos,
            position: seen.position,
            renew: told.mode.new_reference,
        });
        told.sos_reference = self.sos.state().reference;
        let bit = |k: u32| bits.of(Number::Level) >> k & 1 == 1;
        let limited = sls::Inputs {
            selected: selected(Flag::Sls),
            level: Level::from_bits(bit(1), bit(0)),
            telegram: i16::try_from(bits.of(Number::Limit)).unwrap_or(0),
            drive_on: seen.drive_on,
            sos_after_stop: before.sos,
            speed,
        };
        let mut sls_braking = false;
        told.sls_asked = self.config.sls.asked(&limited);
        told.sls = match &mut self.sls {
            Limit::Delayed(sls) => sls.step(&limited),
            Limit::Ramp(sls) => {
                let said = sls.step(&sls_ramp::Inputs {
                    selected: limited.selected,
                    level: limited.level,
                    telegram: limited.telegram,
                    speed,
                });
                sls_braking = said.ramp_violated;
                sls::Outputs {
                    active: said.active,
                    level: said.level,
                    limit: said.limit,
                    violated: said.violated,
                    wrong_value: said.wrong_value,
                    demand: said.demand,
                }
            }
        };
        self.refer(bits, seen);
        let told = &mut self.told;
        told.slp_second = bits.is(Flag::SlpRange);
        if let Some(slp) = &mut self.slp {
            told.slp = slp.step(&slp::Inputs {
                selected: selected(Flag::Slp),
                second: told.slp_second,
                safe: told.reference.safe,
                position: seen.position,
                retract: bits.is(Flag::Retract),
            });
            told.slp_kept =
                [told.slp.above, told.slp.below].map(|beyond| told.slp.active && !beyond);
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
            // Nobody may take the axis of a failed encoder for a slow one.
            speed: match seen.encoder_fault {
                true => Speed(u32::MAX),
                false => speed,
            },
            pulses: seen.drive_on && !seen.unknown,
        });
        let braking = told.ss1.monitored || told.ss2.off3 || before.ramp_watched;
        let (violated, ramp) = match &mut self.ramp {
            Ramp::Sam(sam) => {
                let said = sam.step(&sam::Inputs {
                    braking,
                    speed,
                    encoder_fault: seen.encoder_fault,
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
        let ramp = ramp.max(stop_a(sls_braking));
        self.raised(seen, violated || sls_braking, ramp)
    }

    /// Gear stage and reference.
    fn refer(&mut self, bits: &Read, seen: &Seen) {
        let told = &mut self.told;
        if let Some(gear) = &mut self.gear {
            let bit = |k: u32| bits.of(Number::Stage) >> k & 1 == 1;
            told.gear = gear.step(&gear::Inputs {
                stage: gear::Stage::from_bits(bit(2), bit(1), bit(0)),
                raise: bits.is(Flag::GearTolerance),
            });
        }
        if let Some(reference) = &mut self.reference {
            told.reference = reference.step(&reference::Inputs {
                power_on: bits.is(Flag::PowerOn),
                parking: false,
                gear_change: told.gear.changed,
                declared: bits.is(Flag::Declared),
                epos: false,
                standstill: seen.speed == Speed(0),
                agrees: bits.is(Flag::Agrees),
                other_agrees: seen.other_agrees,
                position: seen.position,
            });
        }
    }

    fn raised(&mut self, seen: &Seen, violated: bool, ramp: Stop) -> Raised {
        let [own, other] = seen.positions;
        let apart = self.actual.step(&actual_value::Inputs {
            own,
            other,
            raised: self.told.gear.raised,
            synchronise: self.told.gear.synchronise,
        });
        if let Some(transferred) = &mut self.transferred {
            // r9708[0] and r9708[1].
            let [first, second] = match seen.second {
                false => [own, other],
                true => [other, own],
            };
            self.told.transferred = transferred.step(&safe_position::Inputs {
                first,
                second,
                valid: !apart.exceeded,
                referenced: self.told.reference.safe,
            });
        }
        let told = &self.told;
        let check = self.check.step(&cross_check::Inputs {
            power_on: false,
            tolerated: seen.tolerated,
            own: seen.results[0],
            other: seen.results[1],
            values_apart: apart.exceeded,
            gear_too_long: told.gear.too_long,
            too_wide: told.transferred.too_wide,
            implausible: seen.wrong,
        });
        let difference = check.found;
        let sdi = told.sdi[0].demand.max(told.sdi[1].demand);
        // The end of STOP B is the arbiter's: SS1 raises none of its own.
        let raised = [
            (seen.communication, "no valid telegram"),
            (
                match seen.encoder_fault {
                    true => level(self.config.encoder_stop),
                    false => Stop::None,
                },
                "the encoder has failed",
            ),
            (
                ramp.max(stop_a(told.ss2.violated || told.ss1.violated)),
                "braking is not as SAM or SBR allows",
            ),
            (level(told.sos.demand), "outside the window of SOS"),
            (level(told.slp.demand), "outside the range of SLP"),
            (level(sdi), "against the direction of SDI"),
            (
                level(told.sls.demand),
                match told.sls.wrong_value && !told.sls.violated {
                    true => "the limit of SLS by telegram is none",
                    false => "faster than SLS allows",
                },
            ),
        ];
        let highest = raised.iter().rev().max_by_key(|(stop, _)| *stop);
        let (request, cause) = *highest.unwrap_or(&(Stop::None, ""));
        let watching = told.sls.active || told.slp.active || told.sdi.iter().any(|s| s.active);
        Raised {
            request,
            difference,
            notice: told.reference.missed,
            value: match difference {
                true => check.value,
                false if told.reference.missed => 1_002,
                false if told.sls.wrong_value => 1_041,
                false => 0,
            },
            cause: match (request, difference) {
                (Stop::None, true) => texts(check.defect)[0],
                (Stop::None, false) => "",
                _ => cause,
            },
            messages: Messages::default()
                .with(Message::Ramp, violated)
                .with(Message::Sos, told.sos.violated)
                .with(Message::Sls, told.sls.violated)
                .with(Message::Slp, told.slp.below || told.slp.above)
                .with(Message::Sdi, told.sdi.iter().any(|s| s.violated))
                .with(
                    Message::Crosscheck,
                    difference || told.reference.missed || told.sls.wrong_value,
                ),
            monitored: watching,
        }
    }

    /// Whether the reaction of a stop runs, which an acknowledgement does not end.
    pub fn reacts(&self) -> bool {
        self.arbiter.state().phase == stop_arbiter::Phase::Running
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
            standstill: seen.speed < self.config.shutdown && !seen.unknown,
            acknowledge,
        });
        told.cause = match (arbiter.initiated, raised.request) {
            _ if arbiter.stop == Stop::None && !arbiter.fault => "",
            (Stop::None, Stop::None) if told.cause.is_empty() => raised.cause,
            (Stop::None, _) => told.cause,
            (Stop::A, request) if request < Stop::A && before == Stop::B => "STOP B has ended",
            (Stop::B, request) if request < Stop::B => texts(self.check.state().defect)[1],
            _ => raised.cause,
        };
        let initiated = |stop| arbiter.initiated == stop;
        told.messages = raised
            .messages
            .with(Message::A, initiated(Stop::A))
            // Where the axis stands, STOP B ends in A in the cycle in which it begins.
            .with(
                Message::B,
                initiated(Stop::B)
                    || initiated(Stop::A) && raised.request < Stop::A && before < Stop::B,
            )
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
            stage: told.gear.stage.get(),
        };
        let low = |code: i64| code < 10;
        let level = usize::from(told.sls.level.index());
        let config = &self.config;
        told.undelayed = told.sls.active && low(config.sls_codes[level])
            || told.sdi.iter().any(|s| s.active) && low(config.sdi_code)
            || told.slp.active && low(config.slp_codes[usize::from(told.slp_second)]);
        // A function without selection limits like one that is selected, and so does the direction of a retraction.
        let [sls, positive, negative] = config.unselected;
        let blocks = |unselected, flag, retracts: bool| {
            config.sdi.is_some() && (unselected || selected(flag) || retracts)
        };
        let slp = &told.slp;
        told.setpoint = self.setpoint.as_mut().map(|setpoint| {
            setpoint.step(&setpoint_limit::Inputs {
                sls: sls || selected(Flag::Sls),
                limit: told.sls_asked,
                sdi_positive: blocks(positive, Flag::SdiPositive, slp.sdi_positive),
                sdi_negative: blocks(negative, Flag::SdiNegative, slp.sdi_negative),
                acceptance: told.mode.active,
                stop_f: arbiter.fault,
            })
        });
        &self.told
    }
}
