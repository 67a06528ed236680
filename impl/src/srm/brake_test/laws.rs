//! The contract of F_BRAKE_TEST.

use super::{
    Config, Control, Inputs, Outputs, Phase, SbtFresh, State, TEST_BITS, Unproven, transition,
};
use crate::srm::common::{ErrReact, remainder};

/// ACK has become 1.
fn acknowledges(s: &Step) -> bool {
    s.inputs.ack && !s.before.ack_held
}

/// EXECUTE has become 1.
fn executes(s: &Step) -> bool {
    s.inputs.execute && !s.before.execute_held
}

/// The velocity is valid and slow.
fn slow(s: &Step) -> bool {
    s.inputs.v_valid && i64::from(s.inputs.safe_v).abs() <= i64::from(s.config.vmax_release.max(1))
}

/// Nothing takes all enables away.
fn free(s: &Step) -> bool {
    s.config.err_react == ErrReact::Report || s.config.parameter_bits() == 0 && !s.after.overflowed
}

/// The brake of the state before is an external one.
fn external(s: &Step) -> bool {
    s.config.external(s.before.second)
}

/// The brake of the state before reads back as closed.
fn closed(s: &Step) -> bool {
    if s.before.second {
        s.inputs.fdback_br_2
    } else {
        s.inputs.fdback_br_1
    }
}

/// The axis has left its tolerance.
fn moved(s: &Step) -> bool {
    (i64::from(s.inputs.safe_pos) - i64::from(s.before.start)).abs()
        > i64::from(s.config.pos_tolerance)
}

/// Position, velocity, enable and standstill are as a running sequence needs them, and the test is selected.
fn undisturbed(s: &Step) -> bool {
    s.inputs.pos_valid
        && slow(s)
        && (s.inputs.fdback_drive || !external(s))
        && !moved(s)
        && s.inputs.sbt.selected
}

/// The drive tells the brake that the block has selected, or none.
fn agrees(s: &Step) -> bool {
    s.inputs.sbt.active_br == s.before.second
}

/// The order of a sequence: 0 to 7.
fn place(second: bool, sequence: u8) -> u8 {
    sequence.saturating_add(if second { 4 } else { 0 })
}

/// No configured sequence lies from one place up to another, the second one not included.
fn none_between(config: &Config, from: u8, to: u8) -> bool {
    let mut none = true;
    let mut place = 0;
    while place < 8 {
        let between = from <= place && place < to;
        none &= !between || !config.has(place >= 4, place % 4);
        place += 1;
    }
    none
}

/// The state before is that of a sequence which ends now.
fn finishes(s: &Step) -> bool {
    let waits = if external(s) {
        s.before.phase == Phase::Result
    } else {
        s.before.phase == Phase::Torque
    };
    waits
        && s.inputs.sbt.finished
        && s.inputs.sbt.result
        && (s.before.ran || s.config.sbt_fresh == SbtFresh::Level)
}

monitor! { srm::brake_test;
    /// A passed test is one whose last sequence has ended well just now, in a drive that has run for it.
    passed_is_earned ["SRM-BRAKETEST-023", "SRM-BRAKETEST-025", "SRM-BRAKETEST-047", "SRM-P-50", "SRM-P-58"]:
        when |s| s.outputs.test_ok && s.before.phase != Phase::Passed
            => finishes(&s) && none_between(&s.config, place(s.before.second, s.before.sequence) + 1, 8)
                && s.outputs.diag & TEST_BITS == 0 && !s.outputs.busy;

    /// Undisturbed the last sequence that ends well passes the test.
    last_sequence_passes ["SRM-BRAKETEST-025", "SRM-P-59"]:
        when |s| undisturbed(&s) && finishes(&s) && none_between(&s.config, place(s.before.second, s.before.sequence) + 1, 8)
            => s.outputs.test_ok && s.outputs.br_1_ok == s.config.tests(false) && s.outputs.br_2_ok == s.config.tests(true);

    /// That the drive has run is seen: torque, and no result yet, in the sequence at hand.
    running_is_seen ["SRM-BRAKETEST-047", "SRM-P-50", "SRM-P-58"]:
        when |s| s.after.ran && !s.before.ran
            => s.before.phase.tests() && s.inputs.sbt.active && !s.inputs.sbt.finished
                && s.after.second == s.before.second && s.after.sequence == s.before.sequence;

    /// A new sequence has not been run for.
    each_sequence_is_run_for ["SRM-BRAKETEST-047", "SRM-P-50"]:
        when |s| s.after.phase == Phase::Start && s.before.phase != Phase::Start
            => !s.after.ran;

    /// Sequences are started in their order, brake 1 first, and none is left out.
    sequences_in_order ["SRM-BRAKETEST-003", "SRM-BRAKETEST-013", "SRM-BRAKETEST-014", "SRM-P-50"]:
        when |s| s.after.phase == Phase::Start && s.before.phase != Phase::Start
            => s.config.has(s.after.second, s.after.sequence)
                && none_between(
                    &s.config,
                    if s.before.phase == Phase::Select { 0 } else { place(s.before.second, s.before.sequence) + 1 },
                    place(s.after.second, s.after.sequence),
                )
                && (s.before.phase == Phase::Select || finishes(&s));

    /// Between two sequences SBT_START is 0 for a call; while a sequence runs it is 1.
    start_is_new_for_each ["SRM-BRAKETEST-013", "SRM-BRAKETEST-047"]:
        when |s| s.after.phase.tests()
            => s.outputs.stw.start != (s.after.phase == Phase::Start && s.before.phase.tests()
                && s.before.phase != Phase::Start);

    /// The control word says which sequence of which brake.
    control_word_names_the_sequence ["SRM-BRAKETEST-007", "SRM-BRAKETEST-013"]:
        when |s| s.after.phase.tests()
            => s.outputs.stw.select && s.outputs.stw.br_select == s.after.second
                && s.outputs.stw.torque_dir == (s.after.sequence == 1 || s.after.sequence == 3)
                && s.outputs.stw.sequence == (s.after.sequence > 1);

    /// A test begins with an edge at EXECUTE beside valid signals, right parameters, a configured sequence and nothing to
    /// acknowledge.
    begin_has_its_conditions ["SRM-BRAKETEST-011", "SRM-BRAKETEST-032", "SRM-BRAKETEST-035", "SRM-BRAKETEST-051", "SRM-P-54", "SRM-P-59"]:
        when |s| s.outputs.busy && !s.before.phase.busy()
            => executes(&s) && s.inputs.pos_valid && s.inputs.v_valid && s.config.parameter_bits() == 0
                && (s.config.tests(false) || s.config.tests(true)) && s.before.phase != Phase::Failed
                && !s.before.fast && !s.before.overflowed;

    /// An edge that finds them begins one; nothing is passed any more.
    begin_is_heard ["SRM-BRAKETEST-011", "SRM-BRAKETEST-052"]:
        when |s| executes(&s) && (s.before.phase == Phase::Unproven || s.before.phase == Phase::Passed) && s.inputs.pos_valid
            && slow(&s) && s.config.parameter_bits() == 0 && (s.config.tests(false) || s.config.tests(true))
            && !s.before.fast && !s.before.overflowed
            => s.outputs.busy && s.outputs.stw.select && !s.outputs.test_ok && !s.outputs.br_1_ok && !s.outputs.br_2_ok
                && s.after.start == s.inputs.safe_pos;

    /// Without a passed test the axis is slow and one direction locked, whoever acknowledges.
    unproven_is_restricted ["SRM-BRAKETEST-027", "SRM-BRAKETEST-052", "SRM-INTEG-006", "SRM-P-51"]:
        when |s| !s.outputs.test_ok && (s.config.unproven == Unproven::Restricted || s.after.tried)
            => s.outputs.sls_threshold == s.config.vmax_release.max(1) && !s.outputs.release_dir;

    /// A passed test lifts the restriction.
    passed_is_free ["SRM-BRAKETEST-025", "SRM-BRAKETEST-027"]:
        when |s| s.outputs.test_ok && free(&s)
            => s.outputs.sls_threshold == i32::MAX && s.outputs.release_dir && s.outputs.sls_ok;

    /// While no test runs the drive is told nothing.
    idle_word_is_zero ["SRM-BRAKETEST-026", "SRM-BRAKETEST-040", "SRM-BRAKETEST-043", "SRM-P-52"]:
        when |s| !s.outputs.busy
            => s.outputs.stw == Control::default() && s.outputs.stw.word() == 0;

    /// The brakes follow normal operation but for the external one that is tested, while it is to be closed.
    brakes_follow_the_drive ["SRM-BRAKETEST-022", "SRM-BRAKETEST-034", "SRM-BRAKETEST-044", "SRM-P-53"]:
        when |s| s.outputs.open_br_1 != s.inputs.fdback_drive || s.outputs.open_br_2 != s.inputs.fdback_drive
            => s.inputs.fdback_drive && (s.config.parameter_bits() != 0
                || (s.after.phase == Phase::Close || s.after.phase == Phase::Torque) && s.config.external(s.after.second)
                    && s.outputs.open_br_1 == s.after.second && s.outputs.open_br_2 != s.after.second);

    /// Brake 2 is tested only after every sequence of brake 1.
    brake_1_comes_first ["SRM-BRAKETEST-013", "SRM-BRAKETEST-024", "SRM-P-55"]:
        when |s| s.outputs.stw.br_select
            => s.outputs.br_1_ok == s.config.tests(false) && !s.outputs.br_2_ok && !s.outputs.test_ok;

    /// An external brake is told to be closed when its time is over and it reads back so.
    closed_is_read_back ["SRM-BRAKETEST-016", "SRM-BRAKETEST-018", "SRM-BRAKETEST-045", "SRM-P-56"]:
        when |s| s.outputs.stw.fdback_br && s.before.phase != Phase::Torque && s.before.phase != Phase::Open
            => s.before.phase == Phase::Close && s.before.timer.count() <= 1 && closed(&s);

    /// It is not waited for less than its time: what reads back before does not count.
    brake_has_its_time ["SRM-BRAKETEST-018", "SRM-BRAKETEST-045"]:
        when |s| (s.before.phase == Phase::Close || s.before.phase == Phase::Open) && s.before.timer.count() > 1
            => !s.outputs.busy || s.after.phase == s.before.phase && s.after.timer.count() + 1 == s.before.timer.count();

    /// A brake that does not read back in time fails the test by its bit.
    brake_out_of_time_fails ["SRM-BRAKETEST-017", "SRM-BRAKETEST-020"]:
        when |s| undisturbed(&s) && s.before.timer.count() <= 1
            && (s.before.phase == Phase::Close && !closed(&s) && (agrees(&s) || !s.inputs.sbt.active && !s.inputs.sbt.close_br)
                || s.before.phase == Phase::Open && closed(&s) && agrees(&s))
            && (!s.inputs.sbt.finished || s.inputs.sbt.result)
            => !s.outputs.busy && s.outputs.error
                && if s.before.second { s.outputs.diag & 2 == 2 } else { s.outputs.diag & 1 == 1 };

    /// The drive asks for an external brake: the one that is tested closes.
    request_closes_the_brake ["SRM-BRAKETEST-016"]:
        when |s| s.before.phase == Phase::Start && external(&s) && undisturbed(&s) && agrees(&s) && s.inputs.sbt.close_br
            && !s.inputs.sbt.finished
            => s.after.phase == Phase::Close
                && if s.before.second { !s.outputs.open_br_2 } else { !s.outputs.open_br_1 };

    /// When the drive lets it go it opens again.
    end_opens_the_brake ["SRM-BRAKETEST-020"]:
        when |s| s.before.phase == Phase::Torque && external(&s) && undisturbed(&s) && agrees(&s) && !s.inputs.sbt.close_br
            && (!s.inputs.sbt.finished || s.inputs.sbt.result)
            => s.after.phase == Phase::Open && s.outputs.open_br_1 && s.outputs.open_br_2 && s.outputs.stw.fdback_br;

    /// A lost position, an invalid or too high velocity ends a running test in the same call.
    test_needs_its_signals ["SRM-BRAKETEST-028", "SRM-BRAKETEST-031", "SRM-BRAKETEST-051", "SRM-P-57", "SRM-P-76"]:
        when |s| s.before.phase.busy() && (!s.inputs.pos_valid || !slow(&s))
            => s.after.phase == Phase::Failed && s.outputs.error
                && (s.inputs.pos_valid || s.outputs.diag & 0x100 == 0x100)
                && (slow(&s) || s.outputs.diag & 4 == 4 && !s.outputs.sls_ok);

    /// A test that would begin too fast has failed.
    no_busy_beside_a_velocity_fault ["SRM-BRAKETEST-051", "SRM-P-57"]:
        when |s| !slow(&s)
            => !s.outputs.busy;

    /// An axis that leaves its tolerance while a sequence runs ends the test by bit 3.
    moving_axis_fails ["SRM-BRAKETEST-019"]:
        when |s| s.before.phase.tests() && moved(&s)
            => s.after.phase == Phase::Failed && s.outputs.error
                && (!s.inputs.pos_valid || !slow(&s) || external(&s) && !s.inputs.fdback_drive || s.outputs.diag & 8 == 8);

    /// Without the enable of the drive an external brake is not tested: bit 7.
    enable_is_needed ["SRM-BRAKETEST-033"]:
        when |s| s.before.phase.tests() && external(&s) && !s.inputs.fdback_drive
            => s.after.phase == Phase::Failed && s.outputs.error
                && (!s.inputs.pos_valid || !slow(&s) || s.outputs.diag & 0x80 == 0x80);

    /// A selection that is lost, and another brake than the selected one, end the test by bit 6.
    contradiction_fails ["SRM-BRAKETEST-015", "SRM-BRAKETEST-048", "SRM-BRAKETEST-050"]:
        when |s| s.before.phase.tests() && (!s.inputs.sbt.selected
            || !agrees(&s) && s.inputs.sbt.active && !s.inputs.sbt.finished)
            => s.after.phase == Phase::Failed && s.outputs.error
                && (s.outputs.diag & 0x1C8 != 0 || s.outputs.diag & 4 == 4);

    /// The brake that the drive names at the request is never another one.
    wrong_brake_is_never_closed ["SRM-BRAKETEST-044", "SRM-BRAKETEST-050"]:
        when |s| s.after.phase == Phase::Close
            => agrees(&s) || s.before.phase == Phase::Close && !s.inputs.sbt.close_br;

    /// A negative result ends the test.
    negative_result_fails ["SRM-BRAKETEST-023", "SRM-BRAKETEST-049"]:
        when |s| s.before.phase.tests() && s.before.phase != Phase::Start && s.inputs.sbt.finished && !s.inputs.sbt.result
            => s.after.phase == Phase::Failed && s.outputs.error && !s.outputs.test_ok
                && (s.after.second || !s.outputs.br_2_ok);

    /// A drive that does not report its selection in time ends the test by bit 9.
    selection_has_its_time ["SRM-BRAKETEST-012"]:
        when |s| s.before.phase == Phase::Select && s.inputs.pos_valid && slow(&s)
            => s.after.phase == if s.inputs.sbt.selected {
                Phase::Start
            } else if s.before.timer.count() <= 1 {
                Phase::Failed
            } else {
                Phase::Select
            } && (s.after.phase != Phase::Failed || s.outputs.diag & 0x200 == 0x200);

    /// One that does not begin in time ends it by bit 10, with a motor holding brake by bit 6.
    request_has_its_time ["SRM-BRAKETEST-021"]:
        when |s| s.before.phase == Phase::Start && undisturbed(&s) && !s.inputs.sbt.close_br && !s.inputs.sbt.active
            && s.before.timer.count() <= 1
            => s.after.phase == Phase::Failed
                && if external(&s) { s.outputs.diag & 0x400 == 0x400 } else { s.outputs.diag & 0x40 == 0x40 };

    /// A failed test is told until it is acknowledged; nothing of it goes on.
    failure_waits ["SRM-BRAKETEST-026", "SRM-BRAKETEST-035"]:
        when |s| s.after.phase == Phase::Failed
            => s.outputs.error && s.outputs.ack_req && !s.outputs.busy && !s.outputs.test_ok && !s.outputs.br_2_ok;

    /// It ends by an edge at ACK.
    failure_is_acknowledged ["SRM-BRAKETEST-035", "SRM-ACK-001", "SRM-P-75"]:
        when |s| s.before.phase == Phase::Failed
            => s.after.phase == if acknowledges(&s) { Phase::Unproven } else { Phase::Failed };

    /// The bits of a test stay until one is passed.
    bits_of_a_test_stay ["SRM-BRAKETEST-036"]:
        when |s| s.before.faults & !s.after.faults != 0
            => s.outputs.test_ok;

    /// Without a passed test a velocity that is too high or invalid is latched, and there is no SLS enable.
    velocity_acts_at_once ["SRM-BRAKETEST-028", "SRM-BRAKETEST-029", "SRM-BRAKETEST-042", "SRM-P-76"]:
        when |s| !s.outputs.test_ok && (s.config.unproven == Unproven::Restricted || s.after.tried) && !slow(&s)
            => !s.outputs.sls_ok && s.outputs.error && s.outputs.diag & 4 == 4;

    /// That is acknowledged with a valid, slow velocity.
    velocity_is_acknowledged ["SRM-BRAKETEST-028", "SRM-BRAKETEST-042", "SRM-P-75"]:
        when |s| s.before.fast && (acknowledges(&s) || !s.after.fast)
            => s.after.fast != (acknowledges(&s) && slow(&s));

    /// Invalid signals are told, and nothing more while no test runs.
    warnings_are_no_faults ["SRM-BRAKETEST-030", "SRM-ACK-004"]:
        when |s| s.before.phase == Phase::Unproven && !s.before.fast && !s.before.overflowed && slow(&s)
            && s.config.parameter_bits() == 0 && !s.inputs.pos_valid
            => !s.outputs.error && s.outputs.diag & 0x4000 == 0x4000 && !s.outputs.busy;

    /// A test is asked for after the restart, and when the interval since the last passed one is over.
    interval_asks ["SRM-BRAKETEST-010", "SRM-BRAKETEST-040"]:
        when |s| !(s.outputs.test_ok && s.before.phase != Phase::Passed)
            => s.outputs.test_req == (s.before.due || s.before.left.count() <= 1)
                && s.after.left.count() == s.before.left.count().saturating_sub(1);

    /// A passed test begins the interval anew.
    interval_restarts ["SRM-BRAKETEST-010", "SRM-BRAKETEST-025"]:
        when |s| s.outputs.test_ok && s.before.phase != Phase::Passed
            => !s.outputs.test_req && s.after.left == s.config.t_interval;

    /// A way that is no DInt is a calculation fault and ends the test.
    overflow_is_a_fault ["SRM-BRAKETEST-046", "SRM-LFMATH-003", "SRM-DIAG-003", "SRM-P-70"]:
        when |s| s.before.phase.tests()
            && (i64::from(s.inputs.safe_pos) - i64::from(s.before.start)).abs() > i64::from(i32::MAX)
            => s.after.phase == Phase::Failed && s.outputs.diag & 0x800 == 0x800 && s.outputs.error
                && (s.config.err_react == ErrReact::Report || !s.outputs.sls_ok && !s.outputs.release_dir);

    /// Which parameters are right; wrong ones are told as long as the block runs: no enable, closed brakes (AMB-17 SAFE).
    parameters_are_right ["SRM-BRAKETEST-005", "SRM-BRAKETEST-006", "SRM-PARAM-003", "SRM-P-71"]:
        when |s| s.before.invariant(&s.config)
            => (s.outputs.diag & 0x10 == 0) == (s.config.t_sample >= 1 && s.config.t_open_br_1 >= 1
                    && s.config.t_close_br_1 >= 1 && s.config.t_open_br_2 >= 1 && s.config.t_close_br_2 >= 1
                    && s.config.pos_tolerance >= 0 && s.config.vmax_release >= 1)
                && (s.config.t_sample < 1 || (s.outputs.diag & 0x20 == 0) == (remainder(s.config.t_open_br_1, s.config.t_sample) == 0
                    && remainder(s.config.t_close_br_1, s.config.t_sample) == 0
                    && remainder(s.config.t_open_br_2, s.config.t_sample) == 0
                    && remainder(s.config.t_close_br_2, s.config.t_sample) == 0))
                && (s.outputs.diag & 0x30 == 0 || s.outputs.error && !s.outputs.busy
                    && (s.config.err_react == ErrReact::Report || !s.outputs.sls_ok && !s.outputs.release_dir
                        && !s.outputs.open_br_1 && !s.outputs.open_br_2));

    /// Reports are what is latched; the other bits are 0.
    reports_are_exact ["SRM-ACK-003", "SRM-ACK-004", "SRM-DIAG-001", "SRM-BRAKETEST-038"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.diag & !0x30 == s.after.faults | u16::from(s.after.fast) << 2 | u16::from(s.after.overflowed) << 11
                    | u16::from(!s.inputs.pos_valid) << 14 | u16::from(!s.inputs.v_valid) << 15
                && s.outputs.error == (s.after.phase == Phase::Failed || s.outputs.diag & 0x834 != 0)
                && s.outputs.ack_req == (s.after.phase == Phase::Failed || s.after.fast && slow(&s)
                    || s.after.overflowed && !(s.before.phase.tests()
                        && (i64::from(s.inputs.safe_pos) - i64::from(s.before.start)).abs() > i64::from(i32::MAX)))
                && s.outputs.busy == s.after.phase.busy();

    /// The step keeps the invariant and remembers the commands.
    state_stays_consistent ["SRM-BRAKETEST-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.ack_held == s.inputs.ack && s.after.execute_held == s.inputs.execute;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Cycles;
    use crate::srm::brake_test::Status;

    fn config() -> Config {
        Config {
            t_interval: Cycles::new(5),
            t_sample: 20,
            sequence_br_1: 0b0_0001,
            t_open_br_1: 20,
            t_close_br_1: 40,
            sequence_br_2: 0b1_0010,
            t_open_br_2: 20,
            t_close_br_2: 20,
            pos_tolerance: 1,
            vmax_release: 600,
            t_mon_sel: Cycles::new(3),
            t_mon_req: Cycles::new(3),
            unproven: Unproven::Restricted,
            sbt_fresh: SbtFresh::Fresh,
            err_react: ErrReact::Safe,
        }
    }

    fn inputs(word: u16, closed: bool) -> Inputs {
        Inputs {
            v_valid: true,
            pos_valid: true,
            fdback_drive: true,
            fdback_br_1: closed,
            sbt: Status::from_word(word),
            execute: true,
            ..Inputs::default()
        }
    }

    /// SRM-BRAKETEST-007 to SRM-BRAKETEST-025: an external brake, then a motor holding brake.
    #[test]
    fn both_brakes_pass() {
        let mut monitor = Monitor::new(config());
        let outputs = monitor.step(&Inputs {
            execute: false,
            ..inputs(0, false)
        });
        assert!(outputs.test_req && !outputs.release_dir && outputs.sls_threshold == 600);
        for (word, closed, stw, open) in [
            (0b000_0000, false, 0b00_0001, true),
            (0b000_0001, false, 0b00_0011, true),
            (0b100_0001, false, 0b00_0011, false),
            (0b100_0001, true, 0b00_0011, false),
            (0b100_0001, true, 0b10_0011, false),
            (0b100_1001, true, 0b10_0011, false),
            (0b000_0001, true, 0b10_0011, true),
            (0b000_0001, false, 0b00_0011, true),
            (0b011_0001, false, 0b00_1101, true),
            (0b011_0101, false, 0b00_1111, true),
            (0b000_1101, false, 0b00_1111, true),
            (0b000_1101, false, 0b00_1111, true),
        ] {
            let outputs = monitor.step(&inputs(word, closed));
            assert_eq!(
                (outputs.stw.word(), outputs.open_br_1),
                (stw, open),
                "{word:b} {:?}",
                monitor.state()
            );
            assert!(outputs.busy && !outputs.error && outputs.open_br_2);
        }
        let outputs = monitor.step(&inputs(0b011_0101, false));
        assert!(
            outputs.test_ok
                && outputs.br_1_ok
                && outputs.br_2_ok
                && !outputs.busy
                && !outputs.test_req
        );
        assert_eq!(
            (outputs.sls_threshold, outputs.stw.word()),
            (2_147_483_647, 0)
        );
    }

    /// SRM-BRAKETEST-047: a frozen word passes nothing; under LEVEL it passes a motor holding brake.
    #[test]
    fn a_frozen_word_passes_nothing() {
        for (sbt_fresh, passed) in [(SbtFresh::Fresh, false), (SbtFresh::Level, true)] {
            let config = Config {
                sequence_br_1: 0b1_0001,
                sequence_br_2: 0,
                sbt_fresh,
                ..config()
            };
            let mut monitor = Monitor::new(config);
            monitor.step(&Inputs {
                execute: false,
                ..inputs(0b11_1001, false)
            });
            let mut ever = false;
            for _ in 0..20 {
                ever |= monitor.step(&inputs(0b11_1001, false)).test_ok;
            }
            assert_eq!(ever, passed);
        }
    }

    /// SRM-BRAKETEST-005, SRM-BRAKETEST-006.
    #[test]
    fn parameters_have_their_bits() {
        let right = config();
        for (wrong, bits) in [
            (right, 0),
            (
                Config {
                    t_open_br_1: 0,
                    ..right
                },
                0x10,
            ),
            (
                Config {
                    pos_tolerance: -1,
                    ..right
                },
                0x10,
            ),
            (
                Config {
                    vmax_release: 0,
                    ..right
                },
                0x10,
            ),
            (
                Config {
                    t_sample: 0,
                    ..right
                },
                0x30,
            ),
            (
                Config {
                    t_close_br_2: 30,
                    ..right
                },
                0x20,
            ),
        ] {
            assert_eq!(wrong.parameter_bits(), bits);
            let outputs = Monitor::new(wrong).step(&inputs(0, false));
            assert_eq!((outputs.diag, outputs.error), (bits, bits != 0));
        }
    }
}
