//! One cycle of an axis in one channel.

use super::told;
use super::{Config, Exchange, Inputs, Outputs, Side, State, TestResult, Told};
use crate::kernel::Position;
use crate::sinumerik::alarm::{self, Alarm, Alarms};
use crate::sinumerik::code::Code;
use crate::sinumerik::compare::list::Rule;
use crate::sinumerik::gear::GearIndex;
use crate::sinumerik::interface::{Sga, Sge};
use crate::sinumerik::level::{ExternalStop, InternalStop};
use crate::sinumerik::reference::AxisState;
use crate::sinumerik::selection::{FactorIndex, Mode, Stage};
use crate::sinumerik::stop::Phase;
use crate::sinumerik::{
    agreement, cam, channel, compare, forced_check, gear, history, reference, results,
    shutdown_test, slip, stop,
};

/// The user's side of the axis: gear stage, stored position, agreement and referencing.
struct Referenced {
    gear: (gear::State, gear::Outputs),
    history: history::State,
    agreement: (agreement::State, agreement::Outputs),
    reference: (reference::State, reference::Outputs),
}

/// The cross comparison with the synchronisation of the actual values.
struct Compared {
    compare: (compare::State, compare::Outputs),
    slip: slip::State,
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let (local, other, monitors) = (&inputs.local, &inputs.other, &config.monitors);
    let sge = &local.sge;
    let referenced = reference_axis(&state, config, inputs);
    let reset_taken = local.reset && joint(&state, local.power_on, other);
    let (shutdown, shutdown_out) = test_external_path(&state, config, inputs);
    let testing = present(shutdown);
    let begins_or_ends = testing != present(state.shutdown_test);
    let compared = compare_channels(&state, config, inputs, begins_or_ends);

    let codes = [
        compared.compare.1.code,
        Code::from(referenced.agreement.1.code),
    ];
    let found = codes.into_iter().find(|code| !code.is_none());
    let (channel, channel_out) = channel::next(
        state.channel,
        &monitors.channel,
        &channel::Inputs {
            power_on: local.power_on,
            run_up: local.run_up,
            reset: reset_taken,
            spl_started: local.spl_started,
            spl_error: local.spl_error,
            sge_a: sge.stop_a_off,
            sge_c: sge.stop_c_off,
            sge_d: sge.stop_d_off,
            sge_e: sge.stop_e_off,
            sge_sbh_sg: sge.sbh_sg_off,
            sge_sbh: sge.sbh_off,
            sg_select: Stage::from_bits(sge.sg_1, sge.sg_0),
            over: factor(sge),
            se_active: referenced.agreement.1.se_active,
            se_select: sge.se,
            position: local.position,
            encoder_speed: local.encoder_speed,
            parking: local.parking,
            // The axis has been referenced in this cycle: its position counts from the new zero.
            set_anew: referenced.reference.0.fresh,
            test_select: sge.test_stop,
            feedback: local.feedback,
            external_test: shutdown_out.active,
            demand: shutdown_out.demand,
            discrepancy: found.is_some(),
            rx_fault: other.fault,
            rx_internal: other.internal,
            rx_external: other.external,
        },
    );
    let (cams, own_cams, sga_cams) = step_cams(&state, config, inputs, channel_out.motion.position);
    let lists = result_lists(config, sge, &channel_out, own_cams);

    let passed = if local.power_on {
        ExternalStop::None
    } else {
        other.external
    };
    let position = compared.slip.correct(channel_out.motion.position);
    let told = Told {
        results_1: lists.list_1.bits(),
        results_2: lists.list_2.bits(),
        position,
        speed: channel_out.motion.speed,
        reference: standstill_reference(&state, inputs, &channel, compared.slip),
        // Under the test the NCK presents no stop of its own, so that one at the drive is found (code 58).
        external: if testing {
            ExternalStop::None
        } else {
            channel_out.external.request.max(passed)
        },
        over: monitors
            .channel
            .selection
            .choice(Stage::Sg2, factor(sge))
            .factor,
        // Power-on begins anew: what it ends is no change for the comparison.
        turned: !local.power_on
            && (channel.selection.mode == Mode::SbhForced)
                != (state.channel.selection.mode == Mode::SbhForced),
        set: referenced.reference.1.compare_due || unparked(&state, local.power_on, &channel),
    };
    let test = if channel_out.test.passed {
        TestResult::Passed
    } else if channel_out.test.demand != InternalStop::None {
        TestResult::Failed
    } else {
        TestResult::None
    };
    let (forced_check, forced_check_out) = check_tests(&state, config, inputs, test);
    let after = State {
        channel,
        cams,
        gear: referenced.gear.0,
        agreement: referenced.agreement.0,
        reference: referenced.reference.0,
        history: referenced.history,
        slip: compared.slip,
        compare: compared.compare.0,
        shutdown_test: shutdown,
        forced_check,
        told,
        sge: *sge,
    };
    let exchange = Exchange {
        internal: channel.stop.internal,
        external: channel_out.external.request,
        fault: channel_out.fault.interlock,
        braking: channel.stop.phase == Phase::Braking,
        agreed: referenced.agreement.1.agreed,
        set: told.set,
        confirmed: referenced.reference.1.confirmed,
        // Without a tolerance time nothing is suspended, and no signal has changed too often (code 1000).
        changing: compared.compare.1.changing
            || (told.turned && !monitors.compare.t_chg().is_zero()),
        cams: own_cams,
        test,
        speed: channel_out.motion.speed,
        snapshot: told.snapshot(monitors),
    };
    let code = found
        .or_else(|| Some(channel_out.test.code).filter(|code| !code.is_none()))
        .unwrap_or(shutdown_out.code);
    let mut outputs = Outputs {
        exchange,
        sga: output_signals(
            &channel_out,
            &referenced.reference.1,
            sga_cams,
            local.feedback,
        ),
        channel: channel_out,
        gear: referenced.gear.1,
        agreement: referenced.agreement.1,
        reference: referenced.reference.1,
        compare: compared.compare.1,
        position,
        shutdown_test: shutdown_out,
        forced_check: forced_check_out,
        code,
        reset_taken,
        alarms: Alarms::NONE,
    };
    outputs.alarms = alarms(&state, config, inputs, &outputs);
    (after, outputs)
}

/// The reference of the operating stop, captured with the correction of that cycle, so that the limits made of it agree in
/// both channels also where their measured positions have drifted apart before. The monitor keeps to the measured one.
fn standstill_reference(
    state: &State,
    inputs: &Inputs,
    channel: &channel::State,
    slip: slip::State,
) -> Position {
    let standstill = |mode| matches!(mode, Mode::Sbh | Mode::SbhForced);
    let (before, after) = (state.channel.selection.mode, channel.selection.mode);
    let forced = before == Mode::Sbh && after == Mode::SbhForced;
    if !standstill(after) {
        channel.selection.reference
    } else if standstill(before)
        && !forced
        && !inputs.local.power_on
        && channel.selection.reference == state.channel.selection.reference
    {
        state.told.reference
    } else {
        slip.correct(channel.selection.reference)
    }
}

/// The first position after parking was read in this cycle.
const fn unparked(state: &State, power_on: bool, channel: &channel::State) -> bool {
    !power_on && !state.channel.motion.known && channel.motion.known
}

/// The test of the external shutdown is selected, or runs on although its selection has been withdrawn.
const fn present(test: shutdown_test::State) -> bool {
    test.selected || test.active()
}

/// RESET may be taken: neither channel brakes, and both have latched the same.
fn joint(state: &State, power_on: bool, other: &Exchange) -> bool {
    let own = &state.channel;
    power_on
        || (own.stop.phase != Phase::Braking
            && !other.braking
            && own.stop.internal == other.internal
            && (own.fault.fault != crate::sinumerik::fault::FaultState::None) == other.fault)
}

/// The override factor of the signals.
const fn factor(sge: &Sge) -> FactorIndex {
    FactorIndex::from_bits(
        sge.override_3,
        sge.override_2,
        sge.override_1,
        sge.override_0,
    )
}

fn reference_axis(state: &State, config: &Config, inputs: &Inputs) -> Referenced {
    let (local, monitors) = (&inputs.local, &config.monitors);
    let power_on = local.power_on;
    let sge = &local.sge;
    let before = state.reference;
    let (gear, gear_out) = gear::next(
        state.gear,
        &monitors.gear,
        &gear::Inputs {
            power_on,
            index: GearIndex::from_bits(sge.gear_2, sge.gear_1, sge.gear_0),
        },
    );
    let known = matches!(before.axis, AxisState::Ref | AxisState::SafeRef) && !local.parking;
    let standstill = matches!(state.channel.selection.mode, Mode::Sbh | Mode::SbhForced);
    let (history, history_out) = history::next(
        state.history,
        &monitors.history,
        &history::Inputs {
            power_on,
            save: known && (standstill || monitors.channel.se_sn_enabled),
            position: local.position,
            // The axis is referenced out of a state in which nothing is saved.
            reached: false,
            refpos: local.refpos,
            travelled: local.travelled,
        },
    );
    let (agreement, agreement_out) = agreement::next(
        state.agreement,
        &monitors.agreement,
        &agreement::Inputs {
            power_on,
            set: local.set_agreement,
            cancel: local.cancel_agreement,
            key: local.key,
            axis_ref: !power_on && before.axis == AxisState::Ref,
            compare_due: !power_on && before.fresh,
            history_ok: history_out.history_ok,
            stored: history_out.stored,
            gear_changed: gear_out.changed,
            altered: local.altered,
            other_agreed: inputs.other.agreed,
        },
    );
    let (reference, reference_out) = reference::next(
        before,
        &monitors.reference,
        &reference::Inputs {
            power_on,
            run_up: local.run_up,
            referenced: local.referenced,
            reference_lost: local.reference_lost,
            parking: local.parking,
            agreed_1: agreement_out.agreed,
            agreed_2: inputs.other.confirmed,
        },
    );
    Referenced {
        gear: (gear, gear_out),
        history,
        agreement: (agreement, agreement_out),
        reference: (reference, reference_out),
    }
}

/// `test_changes`: the test of the external shutdown has begun or ended in this cycle.
fn compare_channels(
    state: &State,
    config: &Config,
    inputs: &Inputs,
    test_changes: bool,
) -> Compared {
    let (power_on, monitors) = (inputs.local.power_on, &config.monitors);
    let due = state.compare.due(&monitors.compare, power_on);
    let (slip, differs) = match &monitors.slip {
        None => (
            state.slip,
            told::differs(due, &state.told, &inputs.other, monitors),
        ),
        Some(config) => {
            let due_now = !power_on && due.code() == Code::POSITION;
            // What referencing and parking leave between the channels is corrected, and is no slip (S840D-SLIP-502). Both
            // channels do it in the same cycle, also where only one of them has been set anew.
            let set = !power_on && (state.told.set || inputs.other.set);
            let (slip, out) = slip::next(
                state.slip,
                config,
                &slip::Inputs {
                    power_on,
                    due: due_now || set,
                    own: state.channel.motion.last,
                    other: inputs.other.snapshot.position,
                },
            );
            let differs = if due_now {
                out.error
            } else {
                told::differs(due, &state.told, &inputs.other, monitors)
            };
            let differs = differs && !(set && due.rule() == Rule::Tolerance);
            (slip, differs)
        }
    };
    let compare = compare::next(
        state.compare,
        &monitors.compare,
        &compare::Inputs {
            power_on,
            change: !power_on
                && (changed(&inputs.local.sge, &state.sge) || state.told.turned || test_changes),
            other_changing: !power_on && inputs.other.changing,
            // In the cycle of power-on the channels have told nothing yet.
            differs: !power_on && differs,
        },
    );
    Compared { compare, slip }
}

/// Whether a signal has changed whose change suspends the comparison. That of the gear stage does not: the actual values are
/// compared during the changeover, too, and must stay within their tolerance (S840D-GEAR-504).
fn changed(now: &Sge, before: &Sge) -> bool {
    let gear = Sge {
        gear_0: before.gear_0,
        gear_1: before.gear_1,
        gear_2: before.gear_2,
        ..*now
    };
    gear != *before
}

/// The test of the external shutdown, in the NCK only.
fn test_external_path(
    state: &State,
    config: &Config,
    inputs: &Inputs,
) -> (shutdown_test::State, shutdown_test::Outputs) {
    let local = &inputs.local;
    let stop_before = if local.power_on {
        stop::State::INITIAL
    } else {
        state.channel.stop
    };
    shutdown_test::next(
        state.shutdown_test,
        &config.monitors.shutdown_test,
        &shutdown_test::Inputs {
            power_on: local.power_on,
            select: config.side == Side::Nck && local.shutdown_test_select,
            pulses_cancelled: local.feedback,
            internal_ab: stop_before.internal >= InternalStop::B,
        },
    )
}

/// The eight cams: states, own results, signals.
fn step_cams(
    state: &State,
    config: &Config,
    inputs: &Inputs,
    position: Position,
) -> ([cam::State; 8], [bool; 8], [bool; 8]) {
    let (mut states, mut own, mut signals) = (state.cams, [false; 8], [false; 8]);
    let cams = states.iter_mut().zip(&config.monitors.cams);
    let results = own.iter_mut().zip(&mut signals);
    for (((cam, config), (own, signal)), other) in cams.zip(results).zip(inputs.other.cams) {
        let (after, out) = cam::next(
            *cam,
            config,
            &cam::Inputs {
                power_on: inputs.local.power_on,
                position,
                other,
            },
        );
        *cam = after;
        *own = out.own;
        *signal = out.sga;
    }
    (states, own, signals)
}

fn result_lists(
    config: &Config,
    sge: &Sge,
    channel: &channel::Outputs,
    cams: [bool; 8],
) -> results::Outputs {
    let (_, lists) = results::next(
        results::State::INITIAL,
        &config.monitors.results,
        &results::Inputs {
            monitored: channel.selection.monitored,
            stage: channel.selection.sga_sg,
            speed_violated: channel.speed.violated,
            standstill_upper: channel.standstill.upper,
            standstill_lower: channel.standstill.lower,
            se_watched: channel.limit_switch.watched,
            se_select: sge.se,
            se_upper: channel.limit_switch.upper,
            se_lower: channel.limit_switch.lower,
            cams,
            below: channel.threshold.below,
        },
    );
    lists
}

/// The tests of both channels, each once it is known here.
fn check_tests(
    state: &State,
    config: &Config,
    inputs: &Inputs,
    own: TestResult,
) -> (forced_check::State, forced_check::Outputs) {
    let power_on = inputs.local.power_on;
    let other = if power_on {
        TestResult::None
    } else {
        inputs.other.test
    };
    let (nck, drive) = match config.side {
        Side::Nck => (own, other),
        Side::Drive => (other, own),
    };
    forced_check::next(
        state.forced_check,
        &config.monitors.forced_check,
        &forced_check::Inputs {
            power_on,
            passed_drive: drive == TestResult::Passed,
            passed_nck: nck == TestResult::Passed,
            failed: nck == TestResult::Failed || drive == TestResult::Failed,
        },
    )
}

fn output_signals(
    channel: &channel::Outputs,
    reference: &reference::Outputs,
    cams: [bool; 8],
    feedback: bool,
) -> Sga {
    let [p1, m1, p2, m2, p3, m3, p4, m4] = cams;
    let stage = channel.sg_active.index();
    Sga {
        sbh_sg_active: channel.sbh_sg_active,
        pulses_cancelled: feedback,
        safely_referenced: reference.safely_referenced,
        sn_1_plus: p1,
        sn_1_minus: m1,
        sn_2_plus: p2,
        sn_2_minus: m2,
        sn_3_plus: p3,
        sn_3_minus: m3,
        sn_4_plus: p4,
        sn_4_minus: m4,
        sbh_active: channel.sbh_active,
        sg_active_0: stage & 1 == 1,
        sg_active_1: stage & 2 == 2,
        below_n_x: channel.threshold.below,
        stop_ab: channel.stop.sga_stop_ab,
        stop_c: channel.stop.sga_stop_c,
        stop_d: channel.stop.sga_stop_d,
        stop_e: channel.stop.sga_stop_e,
    }
}

/// The alarms whose cause is present in this cycle.
fn alarms(state: &State, config: &Config, inputs: &Inputs, out: &Outputs) -> Alarms {
    let (local, monitors, channel) = (&inputs.local, &config.monitors, &out.channel);
    let nck = config.side == Side::Nck;
    let suppressed = local.parking && monitors.park_alarm_suppress;
    let before = if local.power_on {
        InternalStop::None
    } else {
        state.channel.stop.internal
    };
    let raised = if channel.stop.internal > before {
        Alarm::of_stop(channel.stop.internal)
    } else {
        None
    };
    let differs = alarm::static_difference(
        monitors.channel.se_sn_enabled,
        out.agreement.agreed,
        state.told.position,
        inputs.other.snapshot.position,
        monitors.words.pos_tol,
    );
    let failed =
        channel.test.demand != InternalStop::None || out.shutdown_test.demand != InternalStop::None;
    let alarms = Alarms::NONE
        .with(
            Alarm::NotSafelyReferenced,
            out.reference.message && !suppressed,
        )
        .with(Alarm::TestStop, channel.test.active)
        .with(
            Alarm::StaticDifference,
            nck && !local.power_on && !local.parking && differs,
        )
        .with(Alarm::ExternalTest, out.shutdown_test.active)
        .with(Alarm::Standstill, channel.standstill.violated)
        .with(
            Alarm::SpeedLimit,
            channel.speed.violated || channel.speed.encoder_violated,
        )
        .with(
            Alarm::EndStop,
            channel.limit_switch.upper || channel.limit_switch.lower,
        )
        .with(Alarm::BrakingRamp, channel.ramp.violated);
    let alarms = match raised {
        Some(stop) => alarms.with(stop, true),
        None => alarms,
    };
    // A finding of its own names its code; without one the other channel has found it (S840D-STOP-093).
    if channel.fault.alarm || failed {
        alarms.with_fault(out.code)
    } else {
        alarms
    }
}
