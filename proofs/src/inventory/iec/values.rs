//! The monitors of a value.

inventory! {
    [contract iec_window_contract on iec::window {
        property: "every clause of SSR, SLT, STR, SLA and SAR: delay, range, tolerance, validity, acknowledgement",
        tries: "lower: -1 0 min; upper: -1..1 max; delay: 0 1 3 max; tolerance: 0 1 2 max; left: 0..3 max; outside: 0..2 max; value: -2..2 ends",
        caveat: "none",
    }]
    [contract iec_acceleration_contract on iec::acceleration {
        property: "every clause of the acceleration: exact, valid with both speeds",
        tries: "last speed: -3..3 ends",
        caveat: "none",
    }]
    [contract iec_temperature_contract on iec::temperature {
        property: "every clause of SMT: limit, sensor, warning, hysteresis, acknowledgement",
        tries: "limit warning: -1 2 3 ends; hysteresis: 0..2 max; temperature: -2..4 ends",
        caveat: "none",
    }]
}
