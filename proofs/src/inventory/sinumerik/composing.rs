//! The harness of the composition.

use crate::enumeration::Domain;

inventory! {
    [contract [kani(stub(stillpoint_monitors::sinumerik::selection::Config::factor, crate::properties::sinumerik::units::no_factor), solver(minisat)) parts(5: first = 1, second = 2, third = 3, fourth = 4, fifth = 5)] channel_contract on sinumerik::channel {
        property: "every law of the channel: what a monitor requires is latched and acts in the same cycle, whatever else happens",
        domain: Domain { delays: &[0, 2], highest_speed: 0 },
        domain_text: "five parts: stops and faults; selection; ramp; tests and pulses; limit switches. Times 0 or 2 cycles, two positions; the states and inputs of the part in every combination, the others quiet",
        caveat: "the enumeration is complete within each part only; the whole product is drawn at random and is what Kani takes, but for the override (selection_override, units_factor), and with 16 values in the place of all positions, speeds and times: their full width is in the contracts of the monitors",
    }]
}
