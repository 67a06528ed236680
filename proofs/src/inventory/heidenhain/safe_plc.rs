//! Blocks of the safe PLC.

use crate::enumeration::Domain;

inventory! {
    [contract hfs_key_filter_contract on heidenhain::key_filter {
        property: "every clause of the filter's contract: one operating unit, stop keys pass, nothing is set",
        tries: "axes: 0 1 max; t_keys: 0..3 max",
        caveat: "the validity of a permissive is decided before",
    }]
    [contract hfs_axes_logic_contract on heidenhain::axes_logic {
        property: "every clause of the contract of the requests for NC axes: state, activation, feed, stop, program latch",
        domain: Domain { delays: &[1, 2], highest_speed: 0 },
        domain_text: "latch times of 1 and 2 cycles; every consistent state; keys in one part, events and parameters in another; SLS_2 and SOS",
        caveat: "the enumeration does not vary keys and events together, Kani does",
    }]
    [contract hfs_spindle_logic_contract on heidenhain::spindle_logic {
        property: "every clause of the contract of the requests for a spindle: state, activation, stop",
        tries: "",
        caveat: "that a permissive which is lost stops the spindle is the kernel's business",
    }]
    [contract hfs_magazine_logic_contract on heidenhain::magazine_logic {
        property: "every clause of the contract of the requests for a magazine: door, one key with its permissive, confirmation",
        tries: "keys: 0..3 max",
        caveat: "none",
    }]
    [contract hfs_safe_input_contract on heidenhain::safe_input {
        property: "every clause of the contract of a safe input: both contacts, inversion, missing input",
        tries: "",
        caveat: "forced dynamic sampling is elsewhere",
    }]
    [contract hfs_working_space_contract on heidenhain::working_space {
        property: "every clause of the working space's contract: all doors of the space, no other",
        tries: "doors closed: 0..255",
        caveat: "none",
    }]
    [contract hfs_control_voltage_contract on heidenhain::control_voltage {
        property: "every clause of the contract of the control voltage asked for: reset button first, copies of the keys",
        tries: "",
        caveat: "the edge that switches on is the kernel's business",
    }]
    [contract hfs_jog_increment_contract on heidenhain::jog_increment {
        property: "every clause of the jog increment's contract: one press, one increment; a lost condition stops",
        tries: "",
        caveat: "the length of the increment is watched by nobody in two channels",
    }]
    [contract hfs_general_fields_contract on heidenhain::general_fields {
        property: "every clause of the contract of the general fields: unknown numbers, what is taken over",
        tries: "som: 0..4 max; voltage drives chain keys brakes feed: 0..2 max",
        caveat: "numbers between are taken by Kani; the code only asks whether one is known",
    }]
    [contract hfs_program_check_contract on heidenhain::program_check {
        property: "every clause of the contract of the program's check: checksum, interface, messages",
        tries: "",
        caveat: "the checksum itself is outside",
    }]
    [contract hfs_availability_contract on heidenhain::availability {
        property: "every clause of the contract of the safety functions: the table of 6.1.6",
        tries: "",
        caveat: "that a function which is there works is shown elsewhere",
    }]
    [contract hfs_allowed_functions_contract on heidenhain::allowed_functions {
        property: "every clause of the contract of the functions that an open door forbids",
        tries: "",
        caveat: "that the machine obeys is outside",
    }]
    [contract hfs_f_limited_contract on heidenhain::f_limited {
        property: "every clause of F LIMITED's contract: limit of the mode, standstill in SOM_1",
        tries: "limits wanted: 0..3 max",
        caveat: "one channel: no safety function",
    }]
    [contract hfs_group_motion_contract on heidenhain::group_motion {
        property: "every clause of the contract of a group's motion",
        tries: "axes: 0..255",
        caveat: "how motion is measured is outside",
    }]
    [contract hfs_safe_output_contract on heidenhain::safe_output {
        property: "every clause of a safe output's contract: off without the enable, else as the program says",
        tries: "",
        caveat: "when the enable goes is the kernel's business",
    }]
}
