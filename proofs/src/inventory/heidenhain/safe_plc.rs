//! Blocks of the safe PLC.

use crate::enumeration::Domain;
use crate::inventory::NARROW;

inventory! {
    [contract hfs_key_filter_contract on heidenhain::key_filter {
        property: "every clause of the filter's contract: one operating unit, stop keys pass, nothing is set",
        domain: NARROW,
        domain_text: "complete, but for the axes of a direction key: none, the first and all of the units, five sets of the magazine",
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
        domain: NARROW,
        domain_text: "complete: every consistent state and input",
        caveat: "that a permissive which is lost stops the spindle is the kernel's business",
    }]
    [contract hfs_magazine_logic_contract on heidenhain::magazine_logic {
        property: "every clause of the contract of the requests for a magazine: door, one key with its permissive, confirmation",
        domain: NARROW,
        domain_text: "complete, but for the keys: five sets",
        caveat: "none",
    }]
}
