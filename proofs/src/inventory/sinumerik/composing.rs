//! The harness of the composition.

use crate::enumeration::Domain;

inventory! {
    [contract [kani(stub(stillpoint_monitors::kernel::Speed::reduced, crate::kani_source::reduced_small)) parts(15: first = 1, second = 2, third = 3, fourth = 4, fifth = 5, sixth = 6, seventh = 7, eighth = 8, ninth = 9, tenth = 10, eleventh = 11, twelfth = 12, thirteenth = 13, fourteenth = 14, fifteenth = 15)] channel_contract on sinumerik::channel {
        property: "every law of the channel: what a monitor requires is latched and acts in the same cycle, whatever else happens",
        domain: Domain { delays: &[0, 2], highest_speed: 0 },
        domain_text: "five parts: stops and faults; selection; ramp; tests and pulses; limit switches. Times 0 or 2 cycles, two positions; the states and inputs of the part in every combination, the others quiet",
        caveat: "the enumeration is complete within each part only; the whole product is drawn at random and is what Kani takes, but for the override (selection_override, units_factor), and with 16 values in the place of all positions, speeds and times: their full width is in the contracts of the monitors",
    }]
}
