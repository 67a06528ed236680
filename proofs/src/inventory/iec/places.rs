//! The monitors of a position.

inventory! {
    [contract iec_cam_contract on iec::cam {
        property: "every clause of SCA: range, hysteresis, validity",
        tries: "lower upper: -2 0 3 ends; hysteresis: 0..2 max; position: -5..6 ends",
        caveat: "positions of a line",
    }]
    [contract iec_increment_contract on iec::increment {
        property: "every clause of SLI: rest, start, increment, time, acknowledgement",
        tries: "increment: 0 2 4 max; window: 0 2 max; time: 1 2 max; from: 0 2 min; left: 0..2 max; position: -3..7 ends",
        caveat: "none",
    }]
}
