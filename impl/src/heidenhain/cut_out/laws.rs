//! The contract of the test of the cut-out channels.

use super::{Config, Inputs, Outputs, Phase, State, transition};
use crate::heidenhain::types::Stop;

monitor! { heidenhain::cut_out;
    /// Every part is tested in its order: brake control, chain, each channel alone, safe outputs.
    parts_follow_each_other ["HFS-TEST-002", "HFS-TEST-015", "HFS-TEST-023", "HFS-BCT-001"]:
        when |s| s.after.step != s.before.step && !matches!(s.after.step, Phase::Idle | Phase::Fault)
            => match s.after.step {
                Phase::BrakesOn => s.before.step == Phase::Idle && s.inputs.start && !s.inputs.moved
                    && !s.config.no_control,
                Phase::BrakeAOff => s.before.step == Phase::BrakesOn,
                Phase::BrakesAgain => s.before.step == Phase::BrakeAOff,
                Phase::BrakeBOff => s.before.step == Phase::BrakesAgain,
                Phase::ChainClosed => s.before.step == Phase::BrakeBOff
                    || (s.before.step == Phase::Idle && s.inputs.start && s.config.no_control),
                Phase::ChainOpens => s.before.step == Phase::ChainClosed,
                Phase::ModulesOn => s.before.step == Phase::ChainOpens,
                Phase::CcOff => s.before.step == Phase::ModulesOn,
                Phase::ModulesAgain => s.before.step == Phase::CcOff,
                Phase::McOff => s.before.step == Phase::ModulesAgain,
                Phase::OutputsOff => s.before.step == Phase::McOff && !s.config.no_outputs,
                Phase::Done => s.before.step == Phase::OutputsOff
                    || (s.before.step == Phase::McOff && s.config.no_outputs),
                Phase::Idle | Phase::Fault => true,
            };

    /// The brake control passes only if T.BRK is there with both channels and falls from there with each alone; it does not matter
    /// which output carries channel B.
    each_channel_closes_the_brakes ["HFS-BCT-002", "HFS-BCT-005", "HFS-BCT-006", "HFS-BCT-007"]:
        when |s| s.before.step.is_brake_control() && s.after.step != s.before.step
            && !matches!(s.after.step, Phase::Idle | Phase::Fault)
            => s.inputs.t_brk == matches!(s.before.step, Phase::BrakesOn | Phase::BrakesAgain);

    /// Which channel releases the brakes in which step; outside the test of the brake control none does.
    brakes_are_released_by_their_step ["HFS-BCT-007", "HFS-SBC-010"]:
        when |s| s.outputs.brake_a || s.outputs.brake_b
            => s.after.step.is_brake_control()
                && s.outputs.brake_a == (s.after.step != Phase::BrakeAOff)
                && s.outputs.brake_b == (s.after.step != Phase::BrakeBOff);

    /// -STO.A.G comes on after the chain was found closed, and the chain opens with it.
    chain_closes_and_opens ["HFS-NCC-001", "HFS-NCC-002"]:
        when |s| s.after.step != s.before.step && matches!(s.after.step, Phase::ChainOpens | Phase::ModulesOn)
            => s.inputs.chain == (s.after.step == Phase::ChainOpens);

    /// Both channels together make the power modules ready, and from there each alone makes them not ready.
    each_channel_takes_the_torque ["HFS-TEST-015", "HFS-TEST-020"]:
        when |s| matches!(s.before.step, Phase::ModulesOn | Phase::CcOff | Phase::ModulesAgain | Phase::McOff)
            && s.after.step != s.before.step && !matches!(s.after.step, Phase::Idle | Phase::Fault)
            => s.inputs.ready == matches!(s.before.step, Phase::ModulesOn | Phase::ModulesAgain);

    /// Where the torque is off in one channel only, the other one watches the position at standstill, and only then.
    other_channel_watches ["HFS-STO-003", "HFS-P-43"]:
        when |s| s.outputs.on_mc || s.outputs.on_cc || s.outputs.watch_mc || s.outputs.watch_cc
            => s.outputs.watch_mc == (s.outputs.on_mc && !s.outputs.on_cc)
                && s.outputs.watch_cc == (s.outputs.on_cc && !s.outputs.on_mc);

    /// A feedback that does not come in its time is a fault of the tested axes and of all others.
    late_feedback_is_a_fault ["HFS-TEST-012/a", "HFS-TEST-012/b", "HFS-TEST-020", "HFS-TEST-021", "HFS-BCT-003", "HFS-SS0-004"]:
        when |s| s.after.step == Phase::Fault && s.before.step != Phase::Fault
            => s.before.timer.count() == 1 && s.outputs.fault && s.outputs.others == Stop::Ss1F
                && s.outputs.tested == if s.before.step.is_brake_control() { Stop::Ss0 } else { Stop::Ss1F };

    /// Nothing else stops anything.
    no_stop_without_fault ["HFS-TEST-020"]:
        when |s| s.outputs.tested != Stop::None || s.outputs.others != Stop::None
            => s.outputs.fault && s.after.step == Phase::Fault;

    /// Every step ends in its time.
    steps_end_in_time ["HFS-TEST-020", "HFS-TEST-021"]:
        when |s| !s.before.timer.is_zero() && !s.inputs.power_on
            => s.after.step != s.before.step || s.after.timer < s.before.timer;

    /// An axis that leaves its place while the brakes are tested breaks the test off: a safe position is asked for, and the
    /// test begins anew.
    safe_position_is_asked_for ["HFS-BCT-004"]:
        when |s| s.before.step.is_brake_control() && s.inputs.moved && !s.inputs.power_on
            => s.outputs.ask_place && s.after.step == Phase::Idle && !s.outputs.brake_a && !s.outputs.brake_b
                && s.outputs.tested == Stop::None;

    /// It is asked for until the test begins with every axis in its place.
    position_is_asked_for_until_the_start ["HFS-BCT-004"]:
        when |s| s.before.ask && !s.inputs.power_on
            => s.outputs.ask_place != (s.inputs.start && !s.inputs.moved);

    /// At the end the control voltage is on, -STO.A.G is 1 and -STOS.A.G is 0, and it stays so until power-on.
    end_of_the_test ["HFS-TEST-010", "HFS-TEST-019"]:
        when |s| s.outputs.done || (s.before.step == Phase::Done && !s.inputs.power_on)
            => s.outputs.done && s.outputs.sto_a_g && !s.outputs.stos_a_g && !s.outputs.on_mc && !s.outputs.on_cc;

    /// The safe outputs read 0 before the test ends, unless SMP560 bit 12 leaves them out.
    outputs_read_zero ["HFS-TEST-023"]:
        when |s| s.after.step == Phase::Done && s.before.step != Phase::Done && !s.config.no_outputs
            => !s.inputs.outputs;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-TEST-002"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.step == s.after.step && s.outputs.ask_place == s.after.ask;
}
