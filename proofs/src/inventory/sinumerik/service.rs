//! The harnesses of the functions of service and diagnosis.

inventory! {
    [contract acceptance_mode_contract on sinumerik::acceptance_mode {
        property: "every clause of the acceptance test mode's contract: conditions of the entry, ends, relaxations, comparison",
        tries: "t_test t_differ: 1 3; lasted differed: 0 2; setpoint_percent: 80",
        caveat: "that the mode ends with the phase and with the selection of its step is not printed",
    }]
    [contract acceptance_alarm_contract on sinumerik::acceptance_alarm {
        property: "every clause of the contract of the acknowledgement in the acceptance test mode: RESET, three pairs, nothing else",
        tries: "",
        caveat: "that a stop must have come to its end before is not printed",
    }]
    [contract alarm_life_contract on sinumerik::alarm_life {
        property: "every clause of an alarm's contract: cause, class of acknowledgement, power-on after a STOP A or B",
        tries: "",
        caveat: "what raises an alarm is the business of the monitors",
    }]
    [contract alarm_display_contract on sinumerik::alarm_display {
        property: "every clause of the display's contract: suppression by level, priorities, log, acceptance test phase",
        tries: "",
        caveat: "which alarm hides which is a list, compared with the printed one by a test",
    }]
    [contract brake_test_contract on sinumerik::brake_test {
        property: "every clause of the contract of the brake test's sequence: order, times, faults, a brake that stays closed",
        tries: "tv_active tv_close tv_command tv_reached tv_hold: 1 2; waited: 0 1; fault: 0..11",
        caveat: "the brake after a fault is reading AX-10; the internal fault 10 does not occur",
    }]
    [contract brake_torque_contract on sinumerik::brake_torque {
        property: "every clause of the contract of the brake test's torque: what the brake bears, limits, refusal, direction",
        tries: "required: 0..6 8000; weight: 0..2 1000; motor_max: 0 2 4 max; deviation: 0 1 50; measured: -2..6 ends; lower upper: 0 7",
        caveat: "the torque is measured outside; that the required torque must be above it is the printed remedy",
    }]
    [contract brake_load_contract on sinumerik::brake_load {
        property: "every clause of the contract of the brake test in the NC: conditions, window from the start, fixed stop, messages",
        tries: "window: 1; threshold: 1; position: -1 1; begun: 0 1; deviation: 1 2",
        caveat: "a test in the wrong direction is told and goes on, as printed",
    }]
    [contract brake_control_contract on sinumerik::brake_control {
        property: "every clause of the contract of the brake's control: either channel closes, what is compared",
        tries: "",
        caveat: "contactors and feedback are outside",
    }]
    [contract sge_difference_contract on sinumerik::sge_difference {
        property: "every clause of the contract of alarm 27004: told after the tolerance, no sooner, forgotten in between",
        tries: "t_chg: 0..2 4; lasted: 0..4",
        caveat: "none",
    }]
    [contract esr_trigger_contract on sinumerik::esr_trigger {
        property: "every clause of the contract of the retraction's trigger: each cause, the release",
        tries: "",
        caveat: "the retraction itself is the control's",
    }]
}
