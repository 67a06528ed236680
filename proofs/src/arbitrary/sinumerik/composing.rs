//! The channel: the state of every monitor at once.
//!
//! The whole product of all states, parameters and inputs is what random tests draw from, and Kani but for the override. It is too
//! large to enumerate; the enumeration takes parts of it, each free in what one group of laws is about.

use stillpoint_monitors::fields::{Fields, Kind, Visitor};
use stillpoint_monitors::kernel::{Cycles, Distance, Position, Speed};

use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop, Level};
use stillpoint_monitors::sinumerik::selection::{FactorIndex, Stage};
use stillpoint_monitors::sinumerik::{
    channel, external, fault, limit_switch, motion, pulses, ramp, selection, speed, standstill,
    stop, test_stop, threshold,
};

use crate::source::Source;

type Step = (channel::State, channel::Config, channel::Inputs);

/// Any step of a channel.
pub fn channel<S: Source>(source: &mut S) -> Option<Step> {
    if source.leaves_out() {
        return without_override(source);
    }
    match source.any_part(5) {
        1 => stops(source),
        2 => selected(source),
        3 => moving(source),
        4 => tested(source),
        5 => limited(source),
        _ => whole(source),
    }
}

fn velocity<S: Source>(source: &mut S) -> Speed {
    Speed(source.any_u32(3, u32::MAX))
}

fn position<S: Source>(source: &mut S) -> Position {
    Position(source.any_i32(3))
}

/// Two ends in order; none when they are equal.
fn ends<S: Source>(source: &mut S) -> (Position, Position) {
    let (one, other) = (position(source), position(source));
    (one.max(other), one.min(other))
}

/// Any parameters of a channel with this delay from STOP F to STOP B.
fn config<S: Source>(source: &mut S, t_f: Cycles) -> Option<channel::Config> {
    let (plus_1, minus_1) = ends(source);
    let (plus_2, minus_2) = ends(source);
    let (enable_ext, enable_e) = (source.any_bool(), source.any_bool());
    let spl_stop_e = source.any_bool() && enable_ext && enable_e;
    let velo_x = velocity(source);
    let ramp_tol = Speed(source.any_u32(3, u32::MAX - velo_x.0));
    let internal = source.any_bool();
    let external_path = internal || source.any_bool();
    let mode = source.any_of(&[5, 0, 1, 2, 3, 4, 10, 11, 12, 13, 14]);
    let mut reactions = [0; 4];
    if mode == 5 {
        for reaction in &mut reactions {
            *reaction = source.any_of(&[0, 1, 2, 3, 4, 10, 11, 12, 13, 14]);
        }
    }
    let encoder_max = source.any_bool().then(|| velocity(source));
    let t_chk = source.any_delay(Cycles::TEN_SECONDS);
    Some(channel::Config {
        external: external::Config::new(enable_ext, enable_e, spl_stop_e).ok()?,
        test: test_stop::Config::new(t_chk).ok()?,
        selection: super::selection_config(source)?.0,
        standstill: standstill::Config::new(Distance(
            source.any_u32(3, standstill::Config::LARGEST.0),
        ))
        .ok()?,
        speed: speed::Config::new(mode, reactions, encoder_max).ok()?,
        limit_switch: limit_switch::Config::new(
            source.any_bool(),
            [plus_1, plus_2],
            [minus_1, minus_2],
            source.any_in(2, 4) as u8,
        )
        .ok()?,
        ramp: ramp::Config::new(velo_x, ramp_tol).ok()?,
        threshold: threshold::Config::new(velo_x).ok()?,
        fault: fault::Config::new(t_f).ok()?,
        stop: super::stop_config(source)?,
        pulses: pulses::Config::new(internal, external_path, t_chk).ok()?,
        standstill_speed: velocity(source),
        se_sn_enabled: source.any_bool(),
    })
}

/// Any of the values of a list that `fits`; the default where none does.
fn any_fitting<S: Source, T: Copy + Default>(
    source: &mut S,
    values: &[T],
    fits: impl Fn(T) -> bool,
) -> T {
    let count = values.iter().filter(|value| fits(**value)).count() as u32;
    let place = source.any_in(0, count.saturating_sub(1)) as usize;
    let fitting = values.iter().filter(|value| fits(**value)).nth(place);
    fitting.copied().unwrap_or_default()
}

/// Any consistent state of the arbitration, without many choices outside the domain.
fn stop_state<S: Source>(source: &mut S, config: &stop::Config) -> Option<stop::State> {
    use stop::Phase;
    let level = any_fitting(source, &Level::ALL, |level| level != Level::F);
    let longest = config
        .time(Level::C)
        .max(config.time(Level::D))
        .max(config.time(Level::E));
    let (phase, timer) = match level {
        Level::None | Level::F => (Phase::Idle, Cycles::ZERO),
        Level::Test => (Phase::Testing, Cycles::ZERO),
        Level::A => (Phase::PulsesOff, Cycles::ZERO),
        Level::B => (Phase::BBraking, source.any_cycles(config.time(Level::B))),
        Level::E | Level::D | Level::C => match source.any_cycles(longest) {
            Cycles::ZERO => (Phase::SbhInt, Cycles::ZERO),
            left => (Phase::Braking, left),
        },
    };
    let internal = if level == Level::B {
        InternalStop::B
    } else {
        any_fitting(source, &InternalStop::ALL, |stop| stop.level() <= level)
    };
    let external = any_fitting(source, &ExternalStop::ALL, |stop| stop.level() <= level);
    let state = stop::State {
        internal,
        external,
        level,
        phase,
        timer,
    };
    state.invariant(config).then_some(state)
}

fn fault_state<S: Source>(source: &mut S, t_f: Cycles) -> fault::State {
    use fault::FaultState::{Delay, Expired, Latched, None};
    let fault = source.any_of(&[None, Latched, Delay, Expired]);
    let timer = if fault == Delay {
        source.any_cycles(t_f)
    } else {
        Cycles::ZERO
    };
    fault::State { fault, timer }
}

fn test_state<S: Source>(source: &mut S, t_chk: Cycles) -> test_stop::State {
    use test_stop::Phase;
    let phase = source.any_of(&[Phase::Idle, Phase::Run, Phase::RunOk]);
    test_stop::State {
        phase,
        timer: if phase == Phase::Idle {
            Cycles::ZERO
        } else {
            source.any_cycles(t_chk)
        },
        selected: source.any_bool(),
    }
}

fn pulses_state<S: Source>(source: &mut S, t_chk: Cycles) -> pulses::State {
    use pulses::Phase;
    let phase = source.any_of(&[
        Phase::Enabled,
        Phase::CancelInt,
        Phase::Cancelled,
        Phase::CancelExt,
    ]);
    pulses::State {
        phase,
        timer: if phase == Phase::CancelInt {
            source.any_cycles(t_chk)
        } else {
            Cycles::ZERO
        },
    }
}

fn external_state<S: Source>(source: &mut S) -> external::State {
    external::State {
        started: source.any_bool(),
        spl_latched: source.any_bool(),
    }
}

fn motion_state<S: Source>(source: &mut S) -> motion::State {
    let known = source.any_bool();
    motion::State {
        last: source.any_position(),
        known,
        speed: if known { velocity(source) } else { Speed(0) },
    }
}

/// The highest of the numbers that stand for wide ones where the wiring alone is in question.
const NARROW: u32 = 15;

/// Draws each number that it is shown; those of more than eight bits from [`NARROW`] and one around 0 or the least.
struct Narrow<'a, S>(&'a mut S);

impl<S: Source> Visitor for Narrow<'_, S> {
    fn number(&mut self, _: &'static str, kind: Kind, _: i64) -> i64 {
        match kind {
            Kind::Truth => i64::from(self.0.any_bool()),
            Kind::Choice(variants) => self.0.any_choice(variants),
            Kind::Whole(low, high) if high.saturating_sub(low) > 255 => {
                let number = i64::from(self.0.any_in(0, NARROW));
                low.max(-i64::from(NARROW / 2)) + number
            }
            Kind::Whole(low, high) => self.0.any_whole(low, high),
        }
    }
}

fn narrow<T: Fields, S: Source>(source: &mut S) -> T {
    let mut value = T::ANY;
    value.visit("", &mut Narrow(source));
    value
}

/// Everything free, number by number, but for the override, and with few positions, speeds and times. Not by the draws above: what
/// they look up in lists alone takes Kani longer than it has.
fn without_override<S: Source>(source: &mut S) -> Option<Step> {
    let mut config: channel::Config = narrow(source);
    let t_vel = Cycles::new(source.any_in(0, NARROW));
    let limits = [(); 4].map(|()| Speed(source.any_in(0, NARROW)));
    config.selection = selection::Config::new(source.any_bool(), t_vel, limits).ok()?;
    if !config.accepted() {
        return None;
    }
    let state = narrow(source);
    consistent((state, config, narrow(source)))
}

/// Everything free.
fn whole<S: Source>(source: &mut S) -> Option<Step> {
    let t_f = source.any_delay(Cycles::SIXTY_SECONDS);
    let config = config(source, t_f)?;
    let t_chk = config.test.t_chk();
    let state = channel::State {
        external: external_state(source),
        motion: motion_state(source),
        test: test_state(source, t_chk),
        selection: super::selection_state(source, &config.selection)?,
        ramp: ramp::State {
            lowest: velocity(source),
        },
        fault: fault_state(source, t_f),
        stop: stop_state(source, &config.stop)?,
        pulses: pulses_state(source, t_chk),
    };
    let inputs = channel::Inputs {
        power_on: source.any_bool(),
        run_up: source.any_bool(),
        reset: source.any_bool(),
        spl_started: source.any_bool(),
        spl_error: source.any_bool(),
        sge_a: source.any_bool(),
        sge_c: source.any_bool(),
        sge_d: source.any_bool(),
        sge_e: source.any_bool(),
        sge_sbh_sg: source.any_bool(),
        sge_sbh: source.any_bool(),
        sg_select: source.any_of(&Stage::ALL),
        over: super::factor_index(source),
        se_active: source.any_bool(),
        se_select: source.any_bool(),
        position: position(source),
        encoder_speed: velocity(source),
        parking: source.any_bool(),
        set_anew: source.any_bool(),
        test_select: source.any_bool(),
        feedback: source.any_bool(),
        external_test: source.any_bool(),
        demand: source.any_of(&InternalStop::ALL),
        discrepancy: source.any_bool(),
        rx_fault: source.any_bool(),
        rx_internal: source.any_of(&InternalStop::ALL),
        rx_external: source.any_of(&ExternalStop::ALL),
    };
    consistent((state, config, inputs))
}

fn consistent(step: Step) -> Option<Step> {
    step.0.invariant(&step.1).then_some(step)
}

/// The parameters of the enumerated parts: every time is `delay`; the two positions of the enumeration, 0 and -7, are 7
/// apart, so that the axis stands or moves at 7, inside or outside every limit: SG1 permits 7, SG2 6, SG3 8, SG4 0.
fn sample(delay: Cycles) -> Option<channel::Config> {
    let limits = [Speed(7), Speed(6), Speed(8), Speed(0)];
    Some(channel::Config {
        external: external::Config::new(true, true, false).ok()?,
        test: test_stop::Config::new(delay).ok()?,
        selection: selection::Config::new(true, delay, limits).ok()?,
        standstill: standstill::Config::new(Distance(6)).ok()?,
        speed: speed::Config::new(5, [2, 3, 0, 1], None).ok()?,
        limit_switch: limit_switch::Config::new(
            true,
            [Position(0), Position(-7)],
            [Position(-6), Position(-8)],
            3,
        )
        .ok()?,
        ramp: ramp::Config::new(Speed(1), Speed(1)).ok()?,
        threshold: threshold::Config::new(Speed(1)).ok()?,
        fault: fault::Config::new(delay).ok()?,
        stop: stop::Config::new(delay, delay, delay, delay).ok()?,
        pulses: pulses::Config::new(true, true, delay).ok()?,
        standstill_speed: Speed(1),
        se_sn_enabled: false,
    })
}

/// A running axis on which nothing is selected and nothing requested.
const QUIET: channel::Inputs = channel::Inputs {
    power_on: false,
    run_up: true,
    reset: false,
    spl_started: true,
    spl_error: false,
    sge_a: true,
    sge_c: true,
    sge_d: true,
    sge_e: true,
    sge_sbh_sg: true,
    sge_sbh: true,
    sg_select: Stage::Sg1,
    over: FactorIndex::NONE,
    se_active: false,
    se_select: false,
    position: Position(0),
    encoder_speed: Speed(0),
    parking: false,
    set_anew: false,
    test_select: false,
    feedback: false,
    external_test: false,
    demand: InternalStop::None,
    discrepancy: false,
    rx_fault: false,
    rx_internal: InternalStop::None,
    rx_external: ExternalStop::None,
};

/// A channel in operation.
const RUNNING: channel::State = channel::State {
    external: external::State {
        started: true,
        spl_latched: false,
    },
    motion: motion::State {
        last: Position(0),
        known: true,
        speed: Speed(0),
    },
    pulses: pulses::State {
        phase: pulses::Phase::Enabled,
        timer: Cycles::ZERO,
    },
    ..channel::State::INITIAL
};

/// A stop from inside the channel at its beginning or at its end.
fn some_stop<S: Source>(source: &mut S, delay: Cycles) -> stop::State {
    use stop::Phase;
    let stop = |internal: InternalStop, phase, timer| stop::State {
        internal,
        external: ExternalStop::None,
        level: internal.level(),
        phase,
        timer,
    };
    match source.any_in(0, 4) {
        0 => stop::State::INITIAL,
        1 => stop(InternalStop::C, Phase::Braking, delay),
        2 => stop(InternalStop::C, Phase::SbhInt, Cycles::ZERO),
        3 => stop(InternalStop::B, Phase::BBraking, delay),
        _ => stop(InternalStop::A, Phase::PulsesOff, Cycles::ZERO),
    }
}

/// Part 1: stops, STOP F and what the other channel tells.
fn stops<S: Source>(source: &mut S) -> Option<Step> {
    let delay = source.any_delay(Cycles::TEN_SECONDS);
    let config = sample(delay)?;
    let state = channel::State {
        stop: stop_state(source, &config.stop)?,
        fault: fault_state(source, delay),
        ..RUNNING
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = channel::Inputs {
        power_on: source.any_bool(),
        reset: source.any_bool(),
        sge_sbh_sg: source.any_bool(),
        position: source.any_position(),
        demand: source.any_of(&[InternalStop::None, InternalStop::D, InternalStop::A]),
        discrepancy: source.any_bool(),
        rx_fault: source.any_bool(),
        rx_internal: source.any_of(&[InternalStop::None, InternalStop::D, InternalStop::B]),
        rx_external: source.any_of(&[ExternalStop::None, ExternalStop::C, ExternalStop::A]),
        ..QUIET
    };
    Some((state, config, inputs))
}

/// Part 2: selection, from every state of it, under stops.
fn selected<S: Source>(source: &mut S) -> Option<Step> {
    let delay = source.any_delay(Cycles::TEN_SECONDS);
    let config = sample(delay)?;
    let state = channel::State {
        selection: super::selection_state(source, &config.selection)?,
        stop: some_stop(source, delay),
        motion: motion_state(source),
        ..RUNNING
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = channel::Inputs {
        power_on: source.any_bool(),
        reset: source.any_bool(),
        sge_sbh_sg: source.any_bool(),
        sge_sbh: source.any_bool(),
        sg_select: source.any_of(&Stage::ALL),
        position: source.any_position(),
        set_anew: source.any_bool(),
        ..QUIET
    };
    Some((state, config, inputs))
}

/// Part 3: the braking ramp at every speed, and parking.
fn moving<S: Source>(source: &mut S) -> Option<Step> {
    let delay = source.any_delay(Cycles::TEN_SECONDS);
    let config = sample(delay)?;
    let state = channel::State {
        ramp: ramp::State {
            lowest: Speed(source.any_u32(8, u32::MAX)),
        },
        stop: stop_state(source, &config.stop)?,
        motion: motion_state(source),
        ..RUNNING
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = channel::Inputs {
        power_on: source.any_bool(),
        sge_sbh_sg: source.any_bool(),
        sge_sbh: source.any_bool(),
        position: source.any_position(),
        parking: source.any_bool(),
        set_anew: source.any_bool(),
        ..QUIET
    };
    Some((state, config, inputs))
}

/// Part 4: the test of the shutdown path, the pulses and the external stops.
fn tested<S: Source>(source: &mut S) -> Option<Step> {
    let delay = source.any_delay(Cycles::TEN_SECONDS);
    let config = sample(delay)?;
    let state = channel::State {
        external: external_state(source),
        test: test_state(source, delay),
        pulses: pulses_state(source, delay),
        stop: some_stop(source, delay),
        ..RUNNING
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = channel::Inputs {
        power_on: source.any_bool(),
        run_up: source.any_bool(),
        spl_started: source.any_bool(),
        spl_error: source.any_bool(),
        sge_a: source.any_bool(),
        sge_sbh_sg: source.any_bool(),
        test_select: source.any_bool(),
        feedback: source.any_bool(),
        external_test: source.any_bool(),
        ..QUIET
    };
    Some((state, config, inputs))
}

/// Part 5: the limit switches under stops.
fn limited<S: Source>(source: &mut S) -> Option<Step> {
    let delay = source.any_delay(Cycles::TEN_SECONDS);
    let config = channel::Config {
        se_sn_enabled: true,
        ..sample(delay)?
    };
    let state = channel::State {
        stop: some_stop(source, delay),
        fault: fault_state(source, delay),
        ..RUNNING
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = channel::Inputs {
        power_on: source.any_bool(),
        reset: source.any_bool(),
        se_active: source.any_bool(),
        se_select: source.any_bool(),
        position: source.any_position(),
        discrepancy: source.any_bool(),
        ..QUIET
    };
    Some((state, config, inputs))
}
