//! Actual values, and drives without encoder.

inventory! {
    [contract s120_reference_contract on sinamics::reference {
        property: "every clause of safe referencing: declaration, agreement of both channels, place after POWER ON, losses",
        tries: "window: 1 3 max; tolerance: 0 2 max; left: 0..3; stored: 0 5 min; position: 0 2 3 5 7 8 ends",
        caveat: "none",
    }]
    [contract [kani(solver(kissat))] s120_safe_position_contract on sinamics::safe_position {
        property: "every clause of SP: scaled mean, STOP F beyond 16 bits, mean, validity, counter",
        tries: "scale: 1 3 1000 max; state.cycle: 0 7 max; first: -29999 -1..2 32767 32768 98304 ends; second: -29999 -1..2 32767 32768 98304 ends",
        few: [("scale", 0, 15)],
        caveat: "none",
    }]
    [contract [kani(solver(kissat))] s120_actual_value_contract on sinamics::actual_value {
        property: "every clause of the comparison of actual values: tolerance, slip, gear stage, alignment, the same in both channels",
        tries: "config.position: 0 10 max; slip: 0 4 max; factor: 1 3 max; aligned: 0 3 -10 4294967295 -4294967295; own: -3 0 4 5 10 11 13 31 ends; other: 0 1 ends",
        few: [("factor", 0, 15)],
        caveat: "none",
    }]
    [contract s120_gear_contract on sinamics::gear {
        property: "every clause of the gear stages: change, increased tolerance and its time, synchronisation",
        tries: "longest: 1 3 max; left: 0..3 max",
        caveat: "none",
    }]
    [contract s120_encoderless_contract on sinamics::encoderless {
        property: "every clause of a drive without encoder: internal STO, window, start without selection, current",
        tries: "window: 1 3; config.current: 1 2; left: 0..3",
        caveat: "none",
    }]
    [contract s120_start_phase_contract on sinamics::start_phase {
        property: "every clause of the start phase without encoder: p9586 after the pulses, what is told of the actual value",
        tries: "delay: 0 1 3 1200000; left: 0..3 1200000",
        caveat: "none",
    }]
    [contract s120_data_set_contract on sinamics::data_set {
        property: "every clause of the change of the data set: other encoder data are a STOP A until POWER ON",
        tries: "",
        caveat: "none",
    }]
}
