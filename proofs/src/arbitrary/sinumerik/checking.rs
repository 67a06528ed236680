//! The monitors that check the monitoring: tests of the shutdown paths, pulses, comparison, synchronisation, history.

use stillpoint_monitors::kernel::{Cycles, Distance, Position};
use stillpoint_monitors::sinumerik::compare::list::{CLASSES, ITEMS, Item};
use stillpoint_monitors::sinumerik::{compare, forced_check, history, path_test, pulses};
use stillpoint_monitors::sinumerik::{shutdown_test, slip, test_stop};

use crate::source::Source;

/// Any tolerance; the enumeration takes 0 to 3 and the greatest.
pub fn tolerance<S: Source>(source: &mut S) -> Distance {
    Distance(source.any_u32(3, u32::MAX))
}

/// Any position; the enumeration takes -`reach` to `reach` and both ends of the range.
pub fn position_near<S: Source>(source: &mut S, reach: u32) -> Position {
    Position(source.any_i32(reach))
}

/// Any inputs of a test of a shutdown path.
pub fn path_test_inputs<S: Source>(source: &mut S) -> path_test::Inputs {
    path_test::Inputs {
        power_on: source.any_bool(),
        select: source.any_bool(),
        pulses_cancelled: source.any_bool(),
        internal_ab: source.any_bool(),
    }
}

/// Any step of a test of a shutdown path.
fn path_test<S: Source>(
    source: &mut S,
) -> Option<(path_test::State, path_test::Config, path_test::Inputs)> {
    use path_test::Phase;
    let t_chk = source.any_delay(Cycles::TEN_SECONDS);
    let config = path_test::Config::new(t_chk).ok()?;
    let phase = source.any_of(&[Phase::Idle, Phase::Run, Phase::RunOk]);
    let timer = match phase {
        Phase::Idle => Cycles::ZERO,
        Phase::Run | Phase::RunOk => source.any_cycles(t_chk),
    };
    let state = path_test::State {
        phase,
        timer,
        selected: source.any_bool(),
    };
    state
        .invariant(&config)
        .then(|| (state, config, path_test_inputs(source)))
}

/// Any step of the test of the shutdown path.
pub fn test_stop<S: Source>(
    source: &mut S,
) -> Option<(test_stop::State, test_stop::Config, test_stop::Inputs)> {
    path_test(source)
}

/// Any step of the test of the external shutdown.
pub fn shutdown_test<S: Source>(
    source: &mut S,
) -> Option<(
    shutdown_test::State,
    shutdown_test::Config,
    shutdown_test::Inputs,
)> {
    path_test(source)
}

/// Any step of the pulse cancellation.
pub fn pulses<S: Source>(
    source: &mut S,
) -> Option<(pulses::State, pulses::Config, pulses::Inputs)> {
    use pulses::Phase;
    let t_chk = source.any_delay(Cycles::TEN_SECONDS);
    let config = pulses::Config::new(source.any_bool(), source.any_bool(), t_chk).ok()?;
    let phase = source.any_of(&[
        Phase::Enabled,
        Phase::CancelInt,
        Phase::Cancelled,
        Phase::CancelExt,
    ]);
    let timer = if phase == Phase::CancelInt {
        source.any_cycles(t_chk)
    } else {
        Cycles::ZERO
    };
    let state = pulses::State { phase, timer };
    state.invariant(&config).then(|| {
        let inputs = pulses::Inputs {
            power_on: source.any_bool(),
            run_up: source.any_bool(),
            cancel: source.any_bool(),
            external_test: source.any_bool(),
            feedback: source.any_bool(),
        };
        (state, config, inputs)
    })
}

/// The longest list that is accepted.
const LONGEST: usize = 256;

/// All items again and again. A step reads one item; with the lists of this that begin anywhere in the first round, every item
/// stands at every place of lists of every length.
static ROUNDS: [Item; ITEMS.len() + LONGEST] = {
    let mut all = [ITEMS[0]; ITEMS.len() + LONGEST];
    let mut place = 0;
    while place < all.len() {
        all[place] = ITEMS[place % ITEMS.len()];
        place += 1;
    }
    all
};

/// A list of any length; the enumeration takes a short one, the list of models and the whole one.
pub fn items<S: Source>(source: &mut S) -> &'static [Item] {
    if !source.enumerates() {
        let first = source.any_in(0, ITEMS.len() as u32 - 1) as usize;
        let length = source.any_in(1, LONGEST as u32) as usize;
        return ROUNDS.get(first..first + length).unwrap_or(&ITEMS);
    }
    match source.any_in(0, 2) {
        0 => CLASSES.get(..1).unwrap_or(&CLASSES),
        1 => &CLASSES,
        _ => &ITEMS,
    }
}

/// Any step of the comparison.
pub fn compare<S: Source>(
    source: &mut S,
) -> Option<(compare::State, compare::Config, compare::Inputs)> {
    let t_chg = source.any_delay(Cycles::TEN_SECONDS);
    let config = compare::Config::new(t_chg, items(source)).ok()?;
    let last = u32::try_from(config.pass()).ok()?.saturating_sub(1);
    let checking = source.any_bool();
    let check_timer = if checking {
        source.any_cycles(config.checking_time())
    } else {
        Cycles::ZERO
    };
    let state = compare::State {
        item: u8::try_from(source.any_in(0, last)).ok()?,
        change_timer: source.any_cycles(t_chg),
        check_timer,
        checking,
    };
    state.invariant(&config).then(|| {
        let inputs = compare::Inputs {
            power_on: source.any_bool(),
            change: source.any_bool(),
            other_changing: source.any_bool(),
            differs: source.any_bool(),
        };
        (state, config, inputs)
    })
}

/// Any accepted configuration of the synchronisation.
pub fn slip_config<S: Source>(source: &mut S) -> Option<slip::Config> {
    let (dead, tol) = (tolerance(source), tolerance(source));
    slip::Config::new(dead, tol, source.any_bool(), source.any_bool()).ok()
}

/// Any step of the synchronisation.
pub fn slip<S: Source>(source: &mut S) -> Option<(slip::State, slip::Config, slip::Inputs)> {
    let config = slip_config(source)?;
    // Three numbers reach every offset that the invariant allows.
    let mut part = |reach| i64::from(source.any_i32(reach));
    let state = slip::State {
        offset: part(2) + part(0) - part(0),
    };
    state.invariant(&config).then(|| {
        let inputs = slip::Inputs {
            power_on: source.any_bool(),
            due: source.any_bool(),
            own: position_near(source, 3),
            other: position_near(source, 3),
        };
        (state, config, inputs)
    })
}

/// Any step of the history.
pub fn history<S: Source>(
    source: &mut S,
) -> Option<(history::State, history::Config, history::Inputs)> {
    let config = history::Config::new(tolerance(source)).ok()?;
    let stored = source.any_bool().then(|| position_near(source, 2));
    let state = history::State::restored(stored);
    let inputs = history::Inputs {
        power_on: source.any_bool(),
        save: source.any_bool(),
        position: source.any_position(),
        reached: source.any_bool(),
        refpos: position_near(source, 3),
        travelled: source.any_i32(1),
    };
    Some((state, config, inputs))
}

/// Any step of the forced checking.
pub fn forced_check<S: Source>(
    source: &mut S,
) -> Option<(
    forced_check::State,
    forced_check::Config,
    forced_check::Inputs,
)> {
    let interval = source.any_delay(forced_check::EIGHT_HOURS);
    let config = forced_check::Config::new(interval).ok()?;
    let state = forced_check::State {
        drive: source.any_cycles(interval),
        nck: source.any_cycles(interval),
    };
    Some((state, config, forced_check_inputs(source)))
}

/// Any inputs of the forced checking.
pub fn forced_check_inputs<S: Source>(source: &mut S) -> forced_check::Inputs {
    forced_check::Inputs {
        power_on: source.any_bool(),
        passed_drive: source.any_bool(),
        passed_nck: source.any_bool(),
        failed: source.any_bool(),
    }
}
