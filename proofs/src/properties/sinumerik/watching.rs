//! Runs of the monitors of position and speed, alone and together with the selection and the arbitration.

use stillpoint_monitors::kernel::{Cycles, Distance, Position, Speed};

use stillpoint_monitors::sinumerik::level::{InternalStop, Level};
use stillpoint_monitors::sinumerik::results::{Field, List1, List2};
use stillpoint_monitors::sinumerik::selection::{self, FactorIndex, Monitored, Stage};
use stillpoint_monitors::sinumerik::{cam, limit_switch, motion, ramp, speed, standstill, stop};
use stillpoint_monitors::units::ModuloRange;

use super::Subject;
use crate::arbitrary::sinumerik as arbitrary;
use crate::source::{Source, Verdict};

/// The initial states of the monitors of position and speed satisfy their invariants under every accepted configuration:
/// the base of the induction. The monitors without a state have but one.
///
/// Cover 0: an accepted configuration.
pub fn watching_initial_states<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let law = match source.any_in(0, 2) {
        0 => arbitrary::cam_config(source).map(|config| cam::State::INITIAL.invariant(&config)),
        1 => {
            let (velo_x, tol) = (source.any_u32(2, u32::MAX), source.any_u32(2, u32::MAX));
            ramp::Config::new(Speed(velo_x), Speed(tol))
                .ok()
                .map(|config| ramp::State::INITIAL.invariant(&config))
        }
        _ => Some(motion::State::INITIAL.invariant(&motion::Config)),
    };
    source.cover(0, law == Some(true));
    match law {
        None => Verdict::Discarded,
        Some(true) => Verdict::Held,
        Some(false) => Verdict::Broken("initial_state_satisfies_the_invariant"),
    }
}

/// A braking of four cycles: the limit starts at the speed of the cycle before, or at n_x, plus the tolerance, never rises,
/// stays once it has reached its lowest value, and a speed beyond the limit of the cycle before cancels the pulses in the
/// same cycle.
///
/// Cover 0: the axis becomes faster than the limit, cover 1: the limit is frozen and stays, cover 2: a change from STOP C
/// to STOP B while braking.
pub fn braking_ramp<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let (velo_x, tol) = (
        Speed(source.any_u32(2, u32::MAX)),
        Speed(source.any_u32(1, u32::MAX)),
    );
    let Ok(config) = ramp::Config::new(velo_x, tol) else {
        return Verdict::Discarded;
    };
    let ten = Cycles::new(10);
    let Ok(times) = stop::Config::new(ten, ten, ten, ten) else {
        return Verdict::Discarded;
    };
    let start = Speed(source.any_u32(3, u32::MAX));
    let first = source.any_of(&[InternalStop::C, InternalStop::B]);
    // The cycle in which STOP B is demanded; with 4 it never is.
    let becomes_b = match source.any_part(5) {
        0 => source.any_in(0, 4),
        part => part - 1,
    };
    // The cycle in which the stop becomes effective.
    let off = ramp::Inputs {
        speed: start,
        ..ramp::Inputs::default()
    };
    let (mut state, shown) = subject.ramp(ramp::State::INITIAL, &config, &off);
    let demanded = stop::Inputs {
        demand: first,
        ..stop::Inputs::default()
    };
    let (mut stopping, mut stopped) = subject.stop(stop::State::INITIAL, &times, &demanded);
    let mut limit = shown.limit;
    if limit.0 != start.0.max(velo_x.0).saturating_add(tol.0) {
        return Verdict::Broken("ramp_starts_at_the_speed");
    }
    let lowest = Speed(velo_x.0.saturating_add(tol.0));
    let mut frozen = 0;
    for cycle in 0..4 {
        let actual = Speed(source.any_u32(4, u32::MAX));
        let to_b = if cycle == becomes_b {
            InternalStop::B
        } else {
            InternalStop::None
        };
        let before = Braking {
            state,
            stopping,
            on: stopped.sbr_on,
            limit,
        };
        match before.cycle(subject, (&config, &times, lowest), actual, to_b) {
            Ok(after) => {
                (state, stopping, stopped.sbr_on) = (after.state, after.stopping, after.on);
                frozen += u32::from(limit == lowest);
                limit = after.limit;
            }
            Err(verdict) => {
                source.cover(0, verdict == Verdict::Held);
                return verdict;
            }
        }
    }
    source.cover(1, frozen > 1);
    source.cover(2, first == InternalStop::C && becomes_b < 4);
    Verdict::Held
}

/// A braking between two cycles.
struct Braking {
    state: ramp::State,
    stopping: stop::State,
    /// The ramp is on in the next cycle.
    on: bool,
    /// Its limit then.
    limit: Speed,
}

impl Braking {
    /// One cycle, in which STOP B may be demanded: the braking after it, or the verdict where it ends there. A function of its own, so that
    /// a symbolic checker does not carry what the cycle calculates through every later one.
    fn cycle(
        self,
        subject: &Subject,
        (config, times, lowest): (&ramp::Config, &stop::Config, Speed),
        actual: Speed,
        to_b: InternalStop,
    ) -> Result<Self, Verdict> {
        if !self.on {
            return Err(Verdict::Broken("ramp_is_on_while_braking"));
        }
        let inputs = ramp::Inputs {
            on: self.on,
            speed: actual,
            ..ramp::Inputs::default()
        };
        let (state, shown) = subject.ramp(self.state, config, &inputs);
        let demanded = stop::Inputs {
            demand: shown.demand.max(to_b),
            ..stop::Inputs::default()
        };
        let (stopping, stopped) = subject.stop(self.stopping, times, &demanded);
        if actual > self.limit {
            return Err(if stopped.level == Level::A && stopped.cancel_pulses {
                Verdict::Held
            } else {
                Verdict::Broken("faster_than_the_ramp_cancels_the_pulses")
            });
        }
        if stopped.level == Level::A {
            return Err(Verdict::Broken("stop_a_needs_a_violation"));
        }
        if shown.limit > self.limit || (self.limit == lowest && shown.limit != lowest) {
            return Err(Verdict::Broken("limit_never_rises_and_stays_frozen"));
        }
        Ok(Self {
            state,
            stopping,
            on: stopped.sbr_on,
            limit: shown.limit,
        })
    }
}

/// One synchronised cam in two channels at rest, each at its own position: two cycles later both show the same, the own
/// results reaching the other channel one cycle late.
///
/// Cover 0: the positions are on different sides of the cam, cover 1: both show 1, cover 2: a signal changed on the way.
pub fn synchronised_cams_agree<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let cam_at = Position(source.any_i32(1));
    let tol = Distance(source.any_u32(2, u32::MAX));
    let Ok(config) = cam::Config::new(true, cam_at, tol, true, ModuloRange::LINEAR, Distance(0))
    else {
        return Verdict::Discarded;
    };
    let positions = [Position(source.any_i32(4)), Position(source.any_i32(4))];
    let mut states = [(); 2].map(|()| cam::State {
        own: source.any_bool(),
    });
    let mut told = [source.any_bool(), source.any_bool()];
    let mut shown = [false; 2];
    let mut first = [false; 2];
    for cycle in 0..3 {
        let owns = states.map(|state| state.own);
        for (channel, other) in [(0, 1), (1, 0)] {
            let inputs = cam::Inputs {
                power_on: false,
                position: positions[channel],
                other: told[other],
            };
            let (after, outputs) = subject.cam(states[channel], &config, &inputs);
            states[channel] = after;
            shown[channel] = outputs.sga;
        }
        if cycle == 0 {
            first = shown;
        } else if owns != states.map(|state| state.own) {
            return Verdict::Broken("cam_at_rest_does_not_change");
        }
        told = states.map(|state| state.own);
    }
    source.cover(0, (positions[0] > cam_at) != (positions[1] > cam_at));
    source.cover(1, shown == [true; 2]);
    source.cover(2, first != shown);
    if shown[0] == shown[1] {
        Verdict::Held
    } else {
        Verdict::Broken("synchronised_cams_agree")
    }
}

/// An axis that moves to and fro inside the hysteresis of a synchronised cam does not make its signal flicker.
///
/// Cover 0: it moves and the signal is 1, cover 1: it moves and the signal is 0.
pub fn hysteresis_does_not_flicker<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let cam_at = Position(source.any_i32(1));
    let tol = source.any_in(1, 3);
    let Ok(config) = cam::Config::new(
        true,
        cam_at,
        Distance(tol),
        true,
        ModuloRange::LINEAR,
        Distance(0),
    ) else {
        return Verdict::Discarded;
    };
    let start = cam::State {
        own: source.any_bool(),
    };
    let (mut state, mut moved, mut last) = (start, false, None);
    for _ in 0..4 {
        let inside = i64::from(cam_at.0) + i64::from(source.any_in(1, tol));
        let Ok(inside) = i32::try_from(inside) else {
            return Verdict::Discarded;
        };
        let inputs = cam::Inputs {
            power_on: false,
            position: Position(inside),
            other: true,
        };
        let (after, outputs) = subject.cam(state, &config, &inputs);
        state = after;
        moved |= last.is_some_and(|last| last != inside);
        last = Some(inside);
        if outputs.sga != start.own {
            return Verdict::Broken("hysteresis_does_not_flicker");
        }
    }
    source.cover(0, moved && start.own);
    source.cover(1, moved && !start.own);
    Verdict::Held
}

/// Two runs from the same state, with SG1 or SG3 selected, that differ in the override signals only are the same.
///
/// Cover 0: the override signals differ where an override exists.
pub fn override_means_nothing_in_sg1_and_sg3<S: Source>(
    source: &mut S,
    subject: &Subject,
) -> Verdict {
    let Some((state, config, first)) = arbitrary::selection_overridden(source) else {
        return Verdict::Discarded;
    };
    if !matches!(first.sg_select, Stage::Sg1 | Stage::Sg3) {
        return Verdict::Discarded;
    }
    let second = selection::Inputs {
        over: arbitrary::factor_index(source),
        ..first
    };
    let differ = first.over != second.over;
    let exists = config.choice(Stage::Sg2, second.over).factor != FactorIndex::NONE
        || config.choice(Stage::Sg2, first.over).factor != FactorIndex::NONE;
    source.cover(0, differ && exists);
    if subject.selection(state, &config, &first) == subject.selection(state, &config, &second) {
        Verdict::Held
    } else {
        Verdict::Broken("override_means_nothing_in_sg1_and_sg3")
    }
}

/// The monitors of position and speed together with selection and arbitration: a violation is the effective stop in the
/// cycle in which it is seen.
///
/// Cover 0: operating stop left, cover 1: stage exceeded, cover 2: limit switch passed.
pub fn violation_stops_in_the_same_cycle<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let two = Cycles::new(2);
    let (Ok(times), Ok(stages), Ok(window), Ok(ends)) = (
        stop::Config::new(two, two, two, two),
        selection::Config::new(true, two, [Speed(1), Speed(2), Speed(3), Speed(4)]),
        standstill::Config::new(Distance(1)),
        limit_switch::Config::new(
            true,
            [Position(2), Position(3)],
            [Position(-2), Position(-3)],
            2,
        ),
    ) else {
        return Verdict::Discarded;
    };
    // One stop for the stage in question, STOP E for the others, so that a stop of the wrong stage would show.
    let stage = source.any_of(&Stage::ALL);
    let mut reactions = [4; 4];
    if let Some(reaction) = reactions.get_mut(usize::from(stage.index())) {
        *reaction = source.any_in(0, 4) as u8;
    }
    let Ok(stops) = speed::Config::new(5, reactions, None) else {
        return Verdict::Discarded;
    };
    let at = Position(source.any_i32(1));
    let to = Position(source.any_i32(4));
    let selects_speed = source.any_bool();
    let (active, select) = (source.any_bool(), source.any_bool());
    let latched = source.any_of(&[InternalStop::None, InternalStop::E, InternalStop::B]);
    let chosen = |position| selection::Inputs {
        sge_sbh: selects_speed,
        sg_select: stage,
        position,
        ..selection::Inputs::default()
    };
    let demanded = |demand| stop::Inputs {
        demand,
        ..stop::Inputs::default()
    };
    let moved = |position| motion::Inputs {
        position,
        ..motion::Inputs::default()
    };
    // One cycle to begin with, without a violation, perhaps with a stop of another cause.
    let (motion, _) = subject.motion(motion::State::INITIAL, &motion::Config, &moved(at));
    let (selected, _) = subject.selection(selection::State::INITIAL, &stages, &chosen(at));
    let (stopping, _) = subject.stop(stop::State::INITIAL, &times, &demanded(latched));

    let (_, actual) = subject.motion(motion, &motion::Config, &moved(to));
    let (_, wanted) = subject.selection(selected, &stages, &chosen(actual.position));
    let (_, window) = subject.standstill(
        standstill::State,
        &window,
        &standstill::Inputs {
            monitored: wanted.monitored,
            position: actual.position,
            reference: wanted.reference,
        },
    );
    let (_, limit) = subject.speed(
        speed::State,
        &stops,
        &speed::Inputs {
            monitored: wanted.monitored,
            speed: actual.speed,
            limit: wanted.limit,
            stage: wanted.sga_sg,
            encoder_speed: Speed(0),
        },
    );
    let (_, end) = subject.limit_switch(
        limit_switch::State,
        &ends,
        &limit_switch::Inputs {
            active,
            select,
            position: actual.position,
        },
    );
    let demand = window.demand.max(limit.demand).max(end.demand);
    let (_, effective) = subject.stop(stopping, &times, &demanded(demand));

    let distance = to.distance(at).0;
    let left = wanted.monitored == Monitored::Standstill && distance > 1;
    let stage_number = u32::from(stage.index());
    let exceeded = wanted.monitored == Monitored::Speed && distance > stage_number + 1;
    let bound: u32 = if select { 3 } else { 2 };
    let passed = active && to.0.unsigned_abs() > bound;
    source.cover(0, left);
    source.cover(1, exceeded);
    source.cover(2, passed);
    let at_least = |stop: InternalStop| effective.level >= stop.level();
    if (left && !at_least(InternalStop::B))
        || (exceeded && !at_least(stops.stop(stage)))
        || (passed && !at_least(InternalStop::C))
    {
        return Verdict::Broken("violation_stops_in_the_same_cycle");
    }
    if !left && !exceeded && !passed && effective.internal > latched {
        return Verdict::Broken("no_stop_without_a_violation");
    }
    Verdict::Held
}

/// The bits of the result lists hold every field at its place, so that two different lists never have the same bits.
///
/// Cover 0: list 1 is not empty, cover 1: list 2 is not empty.
pub fn result_bits_keep_every_field<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let mut field = || {
        source.any_of(&[
            Field::NotSelected,
            Field::Within,
            Field::Below,
            Field::Above,
        ])
    };
    // Seven fields of list 1; the first seven cams have the same values, the eighth and the other fields of list 2 others.
    let seven: [Field; 7] = std::array::from_fn(|_| field());
    let [sbh, se1, se2, sg1, sg2, sg3, sg4] = seven;
    let [a, b] = [field(), field()];
    let list_1 = List1 {
        sbh,
        se: [se1, se2],
        sg: [sg1, sg2, sg3, sg4],
    };
    let list_2 = List2 {
        cams: [sbh, se1, se2, sg1, sg2, sg3, sg4, a],
        n_x_upper: b,
        n_x_lower: sbh,
        modulo: a,
    };
    let holds = |bits: u32, fields: &[Field]| {
        fields
            .iter()
            .enumerate()
            .all(|(place, field)| (bits >> (2 * place)) & 0b11 == u32::from(field.bits()))
            && bits.checked_shr(2 * fields.len() as u32) == Some(0)
    };
    source.cover(0, list_1 != List1::default());
    source.cover(1, list_2 != List2::default());
    let second = [sbh, se1, se2, sg1, sg2, sg3, sg4, a, b, sbh, a];
    if holds(u32::from(list_1.bits()), &seven) && holds(list_2.bits(), &second) {
        Verdict::Held
    } else {
        Verdict::Broken("bits_keep_every_field")
    }
}
