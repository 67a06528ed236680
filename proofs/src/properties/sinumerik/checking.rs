//! Runs of the monitors that check the monitoring.

use stillpoint_monitors::kernel::{Cycles, Position};
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::compare::list::{
    self, CLASSES, ITEMS, Kind, Limits, Rule, Snapshot, Tolerance,
};
use stillpoint_monitors::sinumerik::level::InternalStop;
use stillpoint_monitors::sinumerik::{compare, forced_check, history, path_test, pulses, slip};

use super::Subject;
use crate::arbitrary::sinumerik as arbitrary;
use crate::draw;
use crate::source::{Source, Verdict};

/// One cycle of either test of a shutdown path, as far as both are alike.
struct Tested {
    state: path_test::State,
    demand: InternalStop,
    code: Code,
    passed: bool,
}

/// Steps the test of the shutdown path, or that of the external shutdown.
fn test_step(
    subject: &Subject,
    external: bool,
    state: path_test::State,
    config: &path_test::Config,
    inputs: &path_test::Inputs,
) -> Tested {
    if external {
        let (state, outputs) = subject.shutdown_test(state, config, inputs);
        Tested {
            state,
            demand: outputs.demand,
            code: outputs.code,
            passed: outputs.passed,
        }
    } else {
        let (state, outputs) = subject.test_stop(state, config, inputs);
        Tested {
            state,
            demand: outputs.demand,
            code: outputs.code,
            passed: outputs.passed,
        }
    }
}

/// With the feedback stuck no test ever passes: stuck at 0 it ends in STOP A after exactly t_chk, stuck at 1 it is refused
/// or, in the external test, not made.
///
/// Cover 0: stuck at 0 in either test, cover 1: a test of the shutdown path refused, cover 2: the selection is withdrawn
/// early.
pub fn stuck_feedback_never_passes<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let t_chk = source.any_in(0, 3);
    let Ok(config) = path_test::Config::new(Cycles::new(t_chk)) else {
        return Verdict::Discarded;
    };
    let external = source.any_bool();
    let stuck = source.any_bool();
    let mut state = path_test::State::INITIAL;
    let mut withdrawn = false;
    for cycle in 0..=t_chk {
        let inputs = path_test::Inputs {
            select: cycle == 0 || source.any_bool(),
            pulses_cancelled: stuck,
            ..path_test::Inputs::default()
        };
        withdrawn |= !inputs.select && state.active();
        let seen = test_step(subject, external, state, &config, &inputs);
        state = seen.state;
        if seen.passed {
            return Verdict::Broken("no_test_passes_with_a_stuck_feedback");
        }
        let stops = seen.demand == InternalStop::A;
        if stops != (!stuck && cycle == t_chk) {
            return Verdict::Broken("stop_a_exactly_at_the_end_of_t_chk");
        }
        let refused = seen.code == Code::ALREADY_CANCELLED;
        if stuck && !external && cycle == 0 && !refused {
            return Verdict::Broken("cancelled_pulses_refuse_the_test");
        }
    }
    source.cover(0, !stuck && t_chk > 1);
    source.cover(1, stuck && !external);
    source.cover(2, withdrawn);
    Verdict::Held
}

/// A test that runs ends: within t_chk it has failed or its feedback has come, and then the withdrawal of the selection
/// ends it.
///
/// Cover 0: a test passes, cover 1: one fails.
pub fn every_test_ends<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let t_chk = source.any_in(1, 3);
    let Ok(config) = path_test::Config::new(Cycles::new(t_chk)) else {
        return Verdict::Discarded;
    };
    let external = source.any_bool();
    let mut state = path_test::State::INITIAL;
    let (mut failed, mut passed) = (false, false);
    for cycle in 0..=t_chk + 1 {
        let inputs = path_test::Inputs {
            // The last cycle withdraws the selection.
            select: cycle == 0 || (cycle <= t_chk && source.any_bool()),
            pulses_cancelled: cycle > 0 && source.any_bool(),
            ..path_test::Inputs::default()
        };
        let seen = test_step(subject, external, state, &config, &inputs);
        state = seen.state;
        failed |= seen.demand == InternalStop::A;
        passed |= seen.passed;
        if failed || passed {
            break;
        }
    }
    source.cover(0, passed);
    source.cover(1, failed);
    if !state.active() && failed != passed {
        Verdict::Held
    } else {
        Verdict::Broken("a_test_ends_with_a_result")
    }
}

/// Pulses that are to be cancelled and are not reported so lose the external enable after exactly t_chk.
///
/// Cover 0: the whole time passes, cover 1: the feedback comes in time and is lost again.
pub fn failed_cancellation_falls_back<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let t_chk = source.any_in(0, 3);
    let Ok(config) = pulses::Config::new(true, true, Cycles::new(t_chk)) else {
        return Verdict::Discarded;
    };
    let enabled = pulses::Inputs {
        run_up: true,
        ..pulses::Inputs::default()
    };
    let (mut state, _) = subject.pulses(pulses::State::INITIAL, &config, &enabled);
    let (mut reported, mut lost) = (false, false);
    for cycle in 0..=t_chk {
        let inputs = pulses::Inputs {
            cancel: true,
            feedback: cycle > 0 && source.any_bool(),
            ..enabled
        };
        let (after, outputs) = subject.pulses(state, &config, &inputs);
        state = after;
        lost |= reported && !inputs.feedback;
        reported |= inputs.feedback;
        let wanted = if reported { !lost } else { cycle < t_chk };
        if outputs.enable || outputs.enable_external != wanted {
            return Verdict::Broken("external_enable_falls_with_the_failure");
        }
    }
    source.cover(0, t_chk > 0 && !reported);
    source.cover(1, lost);
    Verdict::Held
}

/// A lasting difference of an item is found within one pass of the list: of a static item at once, whatever changes, of a
/// dynamic one after the change timer has ended, and not while it runs.
///
/// Cover 0: a static item while signals change, cover 1: a dynamic item after a change, cover 2: without change.
pub fn lasting_difference_is_found<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let t_chg = source.any_in(0, 2);
    let items = CLASSES.get(1..4).unwrap_or(&CLASSES);
    let Ok(config) = compare::Config::new(Cycles::new(t_chg), items) else {
        return Verdict::Discarded;
    };
    let item = source.any_of(items);
    let is_static = item.kind() == Kind::Static;
    let mut state = compare::State {
        item: source.any_in(0, 2) as u8,
        ..compare::State::INITIAL
    };
    let changed = source.any_bool();
    // A dynamic item may be skipped in the cycle of the change and while the timer runs.
    let masked = if changed && !is_static { t_chg } else { 0 };
    let mut found = None;
    for cycle in 0..masked + 3 {
        let due = state.due(&config, false);
        let inputs = compare::Inputs {
            change: changed && (cycle == 0 || is_static && source.any_bool()),
            other_changing: is_static && source.any_bool(),
            differs: due == item || source.any_bool(),
            ..compare::Inputs::default()
        };
        let (after, outputs) = subject.compare(state, &config, &inputs);
        state = after;
        if outputs.code == item.code() {
            found = Some(cycle);
            break;
        }
        if outputs.discrepancy && cycle < masked && outputs.code != Code::FUNCTION_ENABLE {
            return Verdict::Broken("no_dynamic_finding_while_the_change_timer_runs");
        }
    }
    source.cover(0, is_static && changed && t_chg > 0);
    source.cover(1, !is_static && changed && t_chg > 0);
    source.cover(2, !is_static && !changed);
    match found {
        Some(cycle) if cycle >= masked => Verdict::Held,
        Some(_) => Verdict::Broken("no_dynamic_finding_while_the_change_timer_runs"),
        None => Verdict::Broken("lasting_difference_is_found_within_a_pass"),
    }
}

/// A change timer kept running by changes of the signals is found by the other channel after 10 t_chg, with code 1000, and
/// not earlier; one that ends before is not.
///
/// Cover 0: code 1000, cover 1: the changes end before.
pub fn endless_changes_are_found<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let t_chg = source.any_in(1, 2);
    let Ok(config) = compare::Config::new(Cycles::new(t_chg), &CLASSES) else {
        return Verdict::Discarded;
    };
    let (mut changing, mut checking) = (compare::State::INITIAL, compare::State::INITIAL);
    let mut told = false;
    let mut cycles = 0;
    // The first cycle starts the change timer; the other channel learns of it one cycle later.
    for cycle in 0..=10 * t_chg + 1 {
        let own = compare::Inputs {
            change: cycle == 0 || source.any_bool(),
            ..compare::Inputs::default()
        };
        let other = compare::Inputs {
            other_changing: told,
            ..compare::Inputs::default()
        };
        let (after, outputs) = subject.compare(checking, &config, &other);
        checking = after;
        // The first told cycle starts the checking timer; each later one counts.
        let found = outputs.code == Code::TOO_MANY_CHANGES;
        if found != (told && cycles == 10 * t_chg) {
            return Verdict::Broken("code_1000_after_ten_change_timers");
        }
        cycles = if told { cycles + 1 } else { 0 };
        let (after, outputs) = subject.compare(changing, &config, &own);
        changing = after;
        told = outputs.changing;
        source.cover(0, found);
        if !told {
            // The end of the change timer ends the run of the other channel too, without finding.
            source.cover(1, true);
            let ended = compare::Inputs::default();
            let (after, outputs) = subject.compare(checking, &config, &ended);
            return if outputs.discrepancy || after.checking {
                Verdict::Broken("end_of_the_changes_ends_the_checking")
            } else {
                Verdict::Held
            };
        }
    }
    Verdict::Held
}

/// Equal snapshots never differ; positions and limits differ exactly beyond the tolerance, in either direction.
///
/// Cover 0: at the tolerance, cover 1: just beyond it, cover 2: a limit.
pub fn tolerance_is_exact<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let at = arbitrary::position_near(source, 3);
    let other_at = arbitrary::position_near(source, 3);
    let tolerance = Tolerance::Position(arbitrary::tolerance(source));
    let place = source.any_in(0, ITEMS.len() as u32 - 1) as usize;
    let Some(item) = ITEMS.get(place).copied() else {
        return Verdict::Discarded;
    };
    let snapshot = |position| Snapshot {
        position,
        limits: Limits([position; 14]),
        ..Snapshot::default()
    };
    let (own, other) = (snapshot(at), snapshot(other_at));
    let apart = i64::from(at.0) - i64::from(other_at.0);
    let beyond = apart.unsigned_abs() > u64::from(tolerance.distance().0);
    let differs = list::differs(item, &own, &other, tolerance);
    let with_tolerance = item.rule() == Rule::Tolerance;
    source.cover(
        0,
        with_tolerance && apart != 0 && apart.unsigned_abs() == u64::from(tolerance.distance().0),
    );
    source.cover(
        1,
        with_tolerance && apart.unsigned_abs() == u64::from(tolerance.distance().0) + 1,
    );
    source.cover(2, differs && item.code() >= Code::LIMITS);
    if list::differs(item, &own, &own, tolerance) {
        Verdict::Broken("equal_channels_do_not_differ")
    } else if differs != (with_tolerance && beyond) {
        Verdict::Broken("difference_exactly_beyond_the_tolerance")
    } else {
        Verdict::Held
    }
}

/// Two channels that correct towards each other meet in one comparison, up to a rest of one increment, and stay there; one
/// channel alone comes closer in every comparison.
///
/// Cover 0: the channels meet, cover 1: they are within the dead band from the beginning, cover 2: one channel is alone.
pub fn synchronised_channels_meet<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let Some(config) = arbitrary::slip_config(source) else {
        return Verdict::Discarded;
    };
    let own = [(); 2].map(|()| Position(source.any_cut_i32(9, 12)));
    let alone = match source.any_part(2) {
        0 => source.any_bool(),
        part => part == 2,
    };
    let mut states = [slip::State::INITIAL; 2];
    let comparisons = if source.leaves_out() {
        // One comparison from any corrections: of any sequence each one is such a comparison.
        states = states.map(|_| slip::State {
            offset: i64::from(source.any_cut_i32(0, 12)),
        });
        1
    } else {
        3
    };
    let mut shown = [0, 1].map(|channel: usize| states[channel].correct(own[channel]));
    let apart = |shown: [Position; 2]| i64::from(shown[0].0) - i64::from(shown[1].0);
    let first = apart(shown);
    for _ in 0..comparisons {
        let before = apart(shown);
        let sent = shown;
        for (channel, other) in [(0, 1), (1, 0)] {
            let inputs = slip::Inputs {
                due: !(alone && channel == 1),
                own: own[channel],
                other: sent[other],
                ..slip::Inputs::default()
            };
            let outputs;
            (states[channel], outputs) = subject.slip(states[channel], &config, &inputs);
            shown[channel] = outputs.position;
        }
        let after = apart(shown);
        let corrected = before.unsigned_abs() >= u64::from(config.dead().0.max(2));
        let closer = if before >= 0 {
            (0..=before).contains(&after)
        } else {
            (before..=0).contains(&after)
        };
        if !closer || (corrected && after == before) {
            return Verdict::Broken("each_comparison_brings_them_closer");
        }
        if !alone && corrected && after.unsigned_abs() > 1 {
            return Verdict::Broken("both_channels_meet_at_once");
        }
    }
    source.cover(
        0,
        !alone && first.unsigned_abs() > 5 && apart(shown).unsigned_abs() <= 1,
    );
    source.cover(
        1,
        first != 0 && first.unsigned_abs() < u64::from(config.dead().0),
    );
    source.cover(2, alone && first.unsigned_abs() > 5);
    Verdict::Held
}

/// A position stored at standstill, power-off, a movement while off, the way to the reference point: the history is
/// accepted exactly if the movement is within the tolerance.
///
/// Cover 0: at the tolerance, cover 1: just beyond it.
pub fn moved_while_off_is_seen<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let tol = arbitrary::tolerance(source);
    let Ok(config) = history::Config::new(tol) else {
        return Verdict::Discarded;
    };
    let standstill = arbitrary::position_near(source, 1);
    let travelled = source.any_i32(1);
    let moved = source.any_i32(5);
    let Some(refpos) = standstill
        .0
        .checked_add(travelled)
        .and_then(|expected| expected.checked_add(moved))
    else {
        return Verdict::Discarded;
    };
    let save = history::Inputs {
        save: true,
        position: standstill,
        ..history::Inputs::default()
    };
    let (state, _) = subject.history(history::State::INITIAL, &config, &save);
    let on = history::Inputs {
        power_on: true,
        save: source.any_bool(),
        position: arbitrary::position_near(source, 1),
        ..history::Inputs::default()
    };
    let (state, _) = subject.history(state, &config, &on);
    let reached = history::Inputs {
        reached: true,
        refpos: Position(refpos),
        position: Position(refpos),
        travelled,
        save: source.any_bool(),
        ..history::Inputs::default()
    };
    let (state, _) = subject.history(state, &config, &reached);
    // The comparison is due one cycle after the axis has been referenced.
    let due = history::Inputs {
        reached: false,
        ..reached
    };
    let (_, outputs) = subject.history(state, &config, &due);
    source.cover(0, moved != 0 && moved.unsigned_abs() == tol.0);
    source.cover(1, moved.unsigned_abs().checked_sub(tol.0) == Some(1));
    if outputs.history_ok == (moved.unsigned_abs() <= tol.0) {
        Verdict::Held
    } else {
        Verdict::Broken("history_accepted_exactly_within_the_tolerance")
    }
}

/// A test is due exactly when a path has not passed one within the interval since power-on and the last failure.
///
/// Cover 0: both paths are tested, cover 1: a test has grown too old.
pub fn test_becomes_due<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let interval = source.any_in(1, 3);
    let Ok(config) = forced_check::Config::new(Cycles::new(interval)) else {
        return Verdict::Discarded;
    };
    let mut state = forced_check::State::INITIAL;
    // The ages of the last tests of both paths in cycles, counted apart from the monitor.
    let mut ages: [Option<u32>; 2] = [None; 2];
    for _ in 0..4 {
        let inputs: forced_check::Inputs = draw::any(source);
        let (after, outputs) = subject.forced_check(state, &config, &inputs);
        state = after;
        for (age, passed) in ages
            .iter_mut()
            .zip([inputs.passed_drive, inputs.passed_nck])
        {
            *age = if inputs.power_on || inputs.failed {
                None
            } else if passed {
                Some(0)
            } else {
                age.map(|age| age + 1)
            };
        }
        let counts = |age: Option<u32>| age.is_some_and(|age| age < interval);
        source.cover(0, ages.into_iter().all(counts));
        source.cover(1, ages.contains(&Some(interval)));
        if outputs.due == ages.into_iter().all(counts) {
            return Verdict::Broken("due_exactly_when_a_path_is_untested");
        }
    }
    Verdict::Held
}

/// The initial states satisfy the invariants: the base of the induction.
///
/// Cover 0: an accepted configuration.
pub fn checking_initial_states<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let law = match source.any_in(1, 6) {
        1 => path_test::Config::new(source.any_delay(Cycles::TEN_SECONDS))
            .ok()
            .map(|config| path_test::State::INITIAL.invariant(&config)),
        2 => {
            let t_chk = source.any_delay(Cycles::TEN_SECONDS);
            pulses::Config::new(source.any_bool(), source.any_bool(), t_chk)
                .ok()
                .map(|config| pulses::State::INITIAL.invariant(&config))
        }
        3 => arbitrary::compare(source)
            .map(|(_, config, _)| compare::State::INITIAL.invariant(&config)),
        4 => arbitrary::slip_config(source).map(|config| slip::State::INITIAL.invariant(&config)),
        5 => {
            let stored = (source.any_bool()).then(|| arbitrary::position_near(source, 2));
            history::Config::new(arbitrary::tolerance(source))
                .ok()
                .map(|config| history::State::restored(stored).invariant(&config))
        }
        _ => forced_check::Config::new(source.any_delay(forced_check::EIGHT_HOURS))
            .ok()
            .map(|config| forced_check::State::INITIAL.invariant(&config)),
    };
    source.cover(0, law == Some(true));
    match law {
        None => Verdict::Discarded,
        Some(true) => Verdict::Held,
        Some(false) => Verdict::Broken("initial_state_satisfies_the_invariant"),
    }
}
