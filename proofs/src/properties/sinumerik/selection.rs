//! Runs and comparisons of two runs of the selection.

use stillpoint_monitors::kernel::{Cycles, Position, Speed};
use stillpoint_monitors::sinumerik::selection::{Config, Inputs, Mode, Monitored, Stage, State};

use super::Subject;
use crate::arbitrary::sinumerik as arbitrary;
use crate::source::{Source, Verdict};

/// After a change to a lower limit, and with no further change, the old limit is compared for exactly t_vel cycles and the
/// new one from then on; the same for a change to the operating stop.
///
/// Cover 0: to a lower limit with a delay, cover 1: to the operating stop with a delay, cover 2: without delay.
pub fn old_limit_for_exactly_the_delay<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let t_vel = source.any_in(0, 4);
    let limits = [Speed(10), Speed(20), Speed(30), Speed(40)];
    let Ok(config) = Config::new(true, Cycles::new(t_vel), limits) else {
        return Verdict::Discarded;
    };
    let (old, new) = (source.any_of(&Stage::ALL), source.any_of(&Stage::ALL));
    let to_standstill = source.any_bool();
    if !to_standstill && config.limit(new) >= config.limit(old) {
        return Verdict::Discarded;
    }
    let select = |stage| Inputs {
        sge_sbh: true,
        sg_select: stage,
        ..Inputs::default()
    };
    let (mut state, outputs) = subject.selection(State::INITIAL, &config, &select(old));
    if outputs.limit != config.limit(old) {
        return Verdict::Broken("first_selection_acts_at_once");
    }
    for cycle in 0..=t_vel {
        let position = source.any_position();
        let wanted = Inputs {
            sge_sbh: !to_standstill,
            position,
            ..select(new)
        };
        let (after, outputs) = subject.selection(state, &config, &wanted);
        state = after;
        let waits = cycle < t_vel;
        let as_it_should = if waits {
            outputs.monitored == Monitored::Speed
                && outputs.limit == config.limit(old)
                && outputs.sga_sg == old
        } else if to_standstill {
            outputs.monitored == Monitored::Standstill && outputs.reference == position
        } else {
            outputs.monitored == Monitored::Speed
                && outputs.limit == config.limit(new)
                && outputs.sga_sg == new
        };
        if !as_it_should {
            return Verdict::Broken("old_limit_for_exactly_the_delay");
        }
    }
    source.cover(0, t_vel > 0 && !to_standstill);
    source.cover(1, t_vel > 0 && to_standstill);
    source.cover(2, t_vel == 0);
    Verdict::Held
}

/// Two channels in the same forced operating stop that see different signals, and different positions after the first
/// cycle, monitor the same: neither function nor reference depends on the signals.
///
/// Cover 0: the signals differ, and one of them de-selects.
pub fn forced_standstill_does_not_depend_on_signals<S: Source>(
    source: &mut S,
    subject: &Subject,
) -> Verdict {
    let Some((state, config, first)) = arbitrary::selection_overridden(source) else {
        return Verdict::Discarded;
    };
    let second = Inputs {
        sge_sbh_sg: source.any_bool(),
        sge_sbh: source.any_bool(),
        sg_select: source.any_of(&Stage::ALL),
        ..first
    };
    if !first.sbh_internal {
        return Verdict::Discarded;
    }
    let (after_first, shown_first) = subject.selection(state, &config, &first);
    let (after_second, shown_second) = subject.selection(state, &config, &second);
    source.cover(
        0,
        first.sge_sbh_sg != second.sge_sbh_sg && after_first.mode == Mode::SbhForced,
    );
    if after_first == after_second && shown_first == shown_second {
        Verdict::Held
    } else {
        Verdict::Broken("forced_standstill_does_not_depend_on_signals")
    }
}

/// The operating stop can be acknowledged and forced again as often as one likes: while it is selected by the signals and
/// not acknowledged, the reference does not follow a creeping axis.
///
/// Cover 0: the axis moves.
pub fn reference_does_not_creep<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let Ok(config) = Config::new(true, Cycles::new(2), [Speed(1); 4]) else {
        return Verdict::Discarded;
    };
    let at = |position, sbh_internal| Inputs {
        sbh_internal,
        position,
        ended_at: position,
        ..Inputs::default()
    };
    let start = source.any_position();
    let (mut state, _) = subject.selection(State::INITIAL, &config, &at(start, true));
    let mut moved = false;
    for _ in 0..3 {
        let position = source.any_position();
        moved |= position != start;
        // Acknowledged into the selected operating stop.
        let (after, outputs) = subject.selection(state, &config, &at(position, false));
        state = after;
        if outputs.reference != start || outputs.monitored != Monitored::Standstill {
            return Verdict::Broken("reference_does_not_creep");
        }
    }
    source.cover(0, moved && start != Position(0));
    Verdict::Held
}
