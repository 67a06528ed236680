//! The contract of SLS.

use super::{Config, Inputs, Level, Outputs, Phase, Request, Slsd, State, WHOLE, transition};
use crate::kernel::{Cycles, Speed};
use crate::sinamics::types::Stop;

/// SLS is on: selected, or for ever.
fn on(s: &Step) -> bool {
    if s.config.unselected {
        s.config.encoder || s.inputs.drive_on
    } else {
        s.inputs.selected
    }
}

/// A limit was monitored before the cycle.
fn monitored(state: &State) -> bool {
    matches!(state.phase, Phase::Active | Phase::Lower)
}

/// The limit of the telegram counts.
fn telegram(s: &Step) -> bool {
    s.config.by_telegram && !s.config.unselected && s.inputs.level == Level::FIRST
}

/// The limit that is asked for is one of the parameters: this one.
fn asked(s: &Step) -> Option<Speed> {
    (!s.config.unselected && !telegram(s)).then(|| s.config.limit(s.inputs.level))
}

/// A lower limit than the monitored one is asked for.
fn lower(s: &Step) -> bool {
    monitored(&s.before) && asked(s).is_some_and(|limit| limit < s.before.now.limit)
}

monitor! { sinamics::sls;
    /// A speed above the monitored limit is a violation with the stop of its level, in the same cycle, whatever else is asked for.
    fast_axis_is_stopped ["S120-SLS-002", "S120-SLS-003", "S120-SLS-004", "S120-PF-08"]:
        when |s| s.outputs.active && s.inputs.speed > s.after.now.limit
            => s.outputs.violated && s.outputs.demand >= s.config.response(s.after.now.level)
                && s.outputs.demand != Stop::None;

    /// The limit itself is no violation, and without monitoring there is none.
    limit_is_kept ["S120-SLS-002", "S120-SLS-001"]:
        when |s| !s.outputs.active || s.inputs.speed <= s.after.now.limit
            => !s.outputs.violated && (s.outputs.demand == Stop::None || s.outputs.wrong_value);

    /// A selection starts the delay; nothing is monitored before its end.
    selection_starts_the_delay ["S120-SLS-001", "S120-SLS-012"]:
        when |s| s.before.phase == Phase::Idle && on(&s) && !s.config.unselected && !s.config.delay.is_zero()
            => s.after.left == s.config.delay && !s.outputs.active && !s.outputs.violated;

    /// The delay runs down, whatever level is asked for, and ends in the monitoring of the level at that time.
    delay_ends_in_monitoring ["S120-SLS-001", "S120-SLS-006", "S120-PF-34"]:
        when |s| s.before.phase == Phase::Delay && s.inputs.selected
            => s.after.left == s.before.left.tick() && monitored(&s.after) == (s.before.left == Cycles::new(1))
                && (!monitored(&s.after) || s.after.now.level == s.inputs.level);

    /// A deselection ends everything at once.
    deselection_is_at_once ["S120-SLS-001", "S120-PF-10"]:
        when |s| !s.inputs.selected && !s.config.unselected
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// A higher limit takes effect at once, and ends the waiting of a lower one.
    higher_limit_is_at_once ["S120-SLS-005", "S120-SLS-025", "S120-PF-09"]:
        when |s| monitored(&s.before) && on(&s) && asked(&s).is_some_and(|limit| limit >= s.before.now.limit)
            => s.after.phase == Phase::Active && s.after.now.level == s.inputs.level
                && Some(s.after.now.limit) == asked(&s);

    /// A lower one waits for the delay, while the old one stays monitored.
    lower_limit_waits ["S120-SLS-004", "S120-PF-09"]:
        when |s| s.before.phase == Phase::Active && lower(&s) && on(&s) && !s.config.delay.is_zero()
            => s.after.phase == Phase::Lower && s.after.left == s.config.delay && s.after.now == s.before.now;

    /// The delay of a lower one runs down to its effect.
    lower_limit_takes_effect ["S120-SLS-004", "S120-SLS-025", "S120-PF-34"]:
        when |s| s.before.phase == Phase::Lower && lower(&s) && on(&s)
            && asked(&s).is_some_and(|limit| limit >= s.before.next.limit)
            => if s.before.left == Cycles::new(1) {
                Some(s.after.now.limit) == asked(&s) && s.after.phase == Phase::Active
            } else {
                s.after.now == s.before.now && s.after.left == s.before.left.tick() && Some(s.after.next.limit) == asked(&s)
            };

    /// A still lower one restarts it (AF-30), or takes its place.
    still_lower_limit ["S120-SLS-025"]:
        when |s| s.before.phase == Phase::Lower && on(&s) && asked(&s).is_some_and(|limit| limit < s.before.next.limit)
            && s.before.left > Cycles::new(1)
            => s.after.now == s.before.now && Some(s.after.next.limit) == asked(&s)
                && s.after.left == match s.config.slsd {
                    Slsd::Restart => s.config.delay,
                    Slsd::Keep => s.before.left.tick(),
                };

    /// What is monitored rises only to what is asked for.
    limit_rises_by_selection_only ["S120-SLS-005", "S120-SLS-025", "S120-PF-09"]:
        when |s| monitored(&s.before) && monitored(&s.after) && s.after.now.limit > s.before.now.limit
            && !s.config.unselected
            => s.after.now.level == s.inputs.level && (telegram(&s) || Some(s.after.now.limit) == asked(&s));

    /// The telegram gives a part of the limit of level 1, never more than it.
    telegram_gives_a_part ["S120-SLS-009", "S120-PF-18"]:
        when |s| telegram(&s) && s.inputs.selected && s.inputs.telegram >= 1 && s.after.phase == Phase::Active
            => {
                let exact = u64::from(s.config.limit(Level::FIRST).0) * s.inputs.telegram as u64;
                let taken = u64::from(s.after.now.limit.0) * WHOLE;
                taken <= exact && exact < taken + WHOLE
            };

    /// A value that is none raises the stop of level 1, with its message; what is monitored does not rise, and a new limit is 0.
    wrong_value_is_a_stop ["S120-SLS-009", "S120-PF-18"]:
        when |s| telegram(&s) && s.inputs.selected && s.inputs.telegram < 1
            => s.outputs.wrong_value && s.outputs.demand >= s.config.response(Level::FIRST)
                && (!monitored(&s.after) || s.after.now.limit == Speed(0)
                    || monitored(&s.before) && s.after.now == s.before.now && s.after.next.limit == Speed(0));

    /// Without p9501.24, at another level and without selection the word has no effect.
    telegram_is_ignored ["S120-SLS-009", "S120-SLS-019"]:
        when |s| !telegram(&s)
            => !s.outputs.wrong_value
                && (s.after.phase != Phase::Active || s.after.now.limit == s.config.limit(s.after.now.level));

    /// Without selection the first level is monitored from the first cycle on: with encoder always, without one while the drive is on.
    unselected_is_for_ever ["S120-SLS-019"]:
        when |s| s.config.unselected
            => monitored(&s.after) == on(&s)
                && (!on(&s) || s.after.now == Request { level: Level::FIRST, limit: s.config.limit(Level::FIRST) });

    /// The operating stop after a stop switches the status off; all else keeps it on.
    sos_takes_over ["S120-SLS-024", "S120-ARCH-006"]:
        when |s| monitored(&s.after)
            => s.outputs.active != s.inputs.sos_after_stop && (!s.inputs.sos_after_stop || !s.outputs.violated);

    /// Level and limit are shown while a limit is monitored.
    shown_is_monitored ["S120-SLS-006", "S120-SLS-010", "S120-SLS-011"]:
        when |s| s.outputs.active
            => s.outputs.limit == s.after.now.limit && s.outputs.level == s.after.now.level && monitored(&s.after);

    /// A function without encoder raises STOP A or B only.
    bare_function_raises_a_or_b ["S120-SLS-014"]:
        when |s| !s.config.encoder && s.outputs.demand != Stop::None
            => s.outputs.demand >= Stop::B;

    /// The state stays consistent.
    state_stays_consistent ["S120-SLS-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}
