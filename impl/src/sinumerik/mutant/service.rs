//! Wrong variants of the functions of service and diagnosis.

use crate::kernel::{Cycles, Percent};
use crate::sinumerik::acceptance_mode::Group;
use crate::sinumerik::alarm::Class;
use crate::sinumerik::brake_test::BrakeStep;
use crate::sinumerik::{
    acceptance_alarm, acceptance_mode, alarm_display, alarm_life, brake_control, brake_load,
    brake_test, brake_torque, esr_trigger, sge_difference,
};

variants! { sinumerik::acceptance_mode:
    /// The tested response ends the mode: its RESET would come too late.
    "acceptance-mode-ends-with-pulses" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.jog &= inputs.pulses;
        acceptance_mode::transition(state, config, &inputs)
    }

    /// A step whose time is over has its mode again.
    "acceptance-mode-begins-again" |mut state, config, inputs| {
        state.spent = false;
        acceptance_mode::transition(state, config, inputs)
    }

    /// One channel alone is enough for group 1.
    "acceptance-mode-alone" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.other_permits = true;
        acceptance_mode::transition(state, config, &inputs)
    }

    /// The mode lets the axis move in spite of its own stop.
    "acceptance-mode-own-stop" |state, config, inputs| {
        let (after, mut outputs) = acceptance_mode::transition(state, config, inputs);
        outputs.inhibit &= after.mode != Group::One;
        (after, outputs)
    }

    /// The setpoint limit is off in group 2 too.
    "acceptance-mode-setpoint" |state, config, inputs| {
        let (after, mut outputs) = acceptance_mode::transition(state, config, inputs);
        if after.mode == Group::Two {
            outputs.percent = Percent::new(0).unwrap_or(outputs.percent);
        }
        (after, outputs)
    }

    /// A difference of the channels counts from its second cycle.
    "acceptance-mode-differs-late" |state, config, inputs| {
        let (mut after, outputs) = acceptance_mode::transition(state, config, inputs);
        if !state.unlike {
            after.unlike = false;
            after.differed = Cycles::ZERO;
        }
        (after, outputs)
    }
}

variants! { sinumerik::acceptance_alarm:
    /// RESET acknowledges while the stop still brakes.
    "acceptance-alarm-while-braking" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.over = true;
        acceptance_alarm::transition(state, config, &inputs)
    }

    /// Every alarm that needs power-on is relaxed.
    "acceptance-alarm-every" |mut state, config, inputs| {
        if inputs.active && inputs.reset {
            state.kept = false;
        }
        acceptance_alarm::transition(state, config, inputs)
    }
}

variants! { sinumerik::alarm_life:
    /// RESET clears an alarm with which a STOP B came.
    "alarm-life-never-escalates" |mut state, config, inputs| {
        state.escalated = false;
        let mut inputs = *inputs;
        inputs.stop_ab = false;
        alarm_life::transition(state, config, &inputs)
    }

    /// In the acceptance test mode RESET clears every alarm that needs power-on.
    "alarm-life-relaxes-all" |state, config, inputs| {
        let tested = alarm_life::Config::new(Class::PowerOn, false, true);
        let relaxes = inputs.relaxed && *config == alarm_life::Config::new(Class::PowerOn, false, false);
        alarm_life::transition(state, if relaxes { &tested } else { config }, inputs)
    }

    /// NC-START clears what only the cancel key does.
    "alarm-life-nc-start" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.cancel |= inputs.nc_start;
        alarm_life::transition(state, config, &inputs)
    }
}

variants! { sinumerik::alarm_display:
    /// A follow-on alarm that is cleared is taken from the log too.
    "alarm-display-log-cleared" |state, config, inputs| {
        let (mut after, outputs) = alarm_display::transition(state, config, inputs);
        after.logged &= after.shown;
        (after, outputs)
    }

    /// The acceptance test phase suppresses like ever.
    "alarm-display-phase-suppresses" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.phase = false;
        alarm_display::transition(state, config, &inputs)
    }

    /// Priorities hold on every level.
    "alarm-display-always-priorities" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.priority && !inputs.phase {
            inputs.level = alarm_display::SuppressLevel::OncePriorities;
        }
        alarm_display::transition(state, config, &inputs)
    }
}

variants! { sinumerik::brake_test:
    /// Whether the brake holds is looked at when the holding time ends, not throughout.
    "brake-test-looks-at-the-end" |state, config, inputs| {
        let mut inputs = *inputs;
        let last = state.waited.count() + 1 >= config.time(BrakeStep::Hold).count();
        inputs.fixed_stop |= state.step == BrakeStep::Hold && !last;
        inputs.active |= state.step == BrakeStep::Hold && !last;
        brake_test::transition(state, config, &inputs)
    }

    /// A Start that stays begins the next test when the fault is acknowledged.
    "brake-test-restarts" |mut state, config, inputs| {
        state.held &= state.step != BrakeStep::Idle;
        brake_test::transition(state, config, inputs)
    }

    /// The axis is pressed against a brake that has not said that it is closed.
    "brake-test-open-brake" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.closed = true;
        brake_test::transition(state, config, &inputs)
    }

    /// A test that the NC does not end is passed all the same.
    "brake-test-stays-selected" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.active &= state.step != BrakeStep::Release;
        brake_test::transition(state, config, &inputs)
    }

    /// An axis that runs out of its window before the fixed stop is only too slow.
    "brake-test-window-unheard" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.active |= matches!(state.step, BrakeStep::Close | BrakeStep::Move | BrakeStep::Reach);
        brake_test::transition(state, config, &inputs)
    }
}

variants! { sinumerik::brake_torque:
    /// The load is not taken from what the drive gives.
    "brake-torque-without-load" |state, config, inputs| {
        let (mut after, outputs) = brake_torque::transition(state, config, inputs);
        if inputs.measure && !outputs.unattainable {
            after.lower += i32::from(inputs.measured);
        }
        (after, outputs)
    }

    /// Limits that do not hold the axis are not found.
    "brake-torque-unchecked" |state, config, inputs| {
        let (after, mut outputs) = brake_torque::transition(state, config, inputs);
        outputs.unattainable = false;
        (after, outputs)
    }

    /// Either direction will do for any load.
    "brake-torque-direction-free" |state, config, inputs| {
        let (mut after, outputs) = brake_torque::transition(state, config, inputs);
        after.along &= !inputs.measure;
        (after, outputs)
    }
}

variants! { sinumerik::brake_load:
    /// The position is watched only once the axis stands against the brake.
    "brake-load-window-late" |state, config, inputs| {
        let mut inputs = *inputs;
        if !state.reached {
            inputs.position = state.begun;
        }
        brake_load::transition(state, config, &inputs)
    }

    /// The window follows the axis.
    "brake-load-window-follows" |state, config, inputs| {
        let (mut after, outputs) = brake_load::transition(state, config, inputs);
        if after.active {
            after.begun = inputs.position;
        }
        (after, outputs)
    }

    /// A contour deviation alone counts as the fixed stop.
    "brake-load-without-torque" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.at_limit = true;
        brake_load::transition(state, config, &inputs)
    }

    /// A test that was aborted begins again while it is still selected.
    "brake-load-begins-again" |mut state, config, inputs| {
        state.held &= state.active;
        brake_load::transition(state, config, inputs)
    }
}

variants! { sinumerik::brake_control:
    /// The speed controller is not looked at.
    "brake-control-speed-controller" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.speed_control = true;
        brake_control::transition(state, config, &inputs)
    }

    /// The PLC alone releases the brake.
    "brake-control-one-channel" |state, config, inputs| {
        let (after, mut outputs) = brake_control::transition(state, config, inputs);
        outputs.released = outputs.plc;
        (after, outputs)
    }
}

variants! { sinumerik::sge_difference:
    /// A difference is told at once.
    "sge-difference-at-once" |state, config, inputs| {
        let (after, mut outputs) = sge_difference::transition(state, config, inputs);
        outputs.alarm = inputs.own != inputs.other;
        (after, outputs)
    }

    /// Differences add up over cycles in which the channels agree.
    "sge-difference-adds-up" |state, config, inputs| {
        let (mut after, outputs) = sge_difference::transition(state, config, inputs);
        if inputs.own == inputs.other && !inputs.power_on {
            after = state;
        }
        (after, outputs)
    }
}

variants! { sinumerik::esr_trigger:
    /// An actual-value fault alone does not trigger.
    "esr-trigger-actual-value" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.actual_value = false;
        esr_trigger::transition(state, config, &inputs)
    }
}
