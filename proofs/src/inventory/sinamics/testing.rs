//! Tests of the switch-off paths.

inventory! {
    [contract s120_drive_test_contract on sinamics::drive_test {
        property: "every clause of the test stop of the drive: begin, pass, failure, abort, what is due",
        tries: "interval: 1 3 max; longest: 1 2 max; state.left: 0..3 max; pulses_left: 0..2 max",
        caveat: "none",
    }]
    [contract s120_path_test_contract on sinamics::path_test {
        property: "every clause of the path test of the Basic Functions: when it runs, interval, terminals",
        tries: "interval: 1 3 max; left: 0..3 max",
        caveat: "none",
    }]
}
