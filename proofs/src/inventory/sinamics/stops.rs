//! The stops.

inventory! {
    [contract s120_sto_contract on sinamics::sto {
        property: "every clause of STO: each cause in the same cycle, power-up, parking, short-circuit of the armature, deselection",
        tries: "",
        caveat: "none",
    }]
    [contract s120_ss1_basic_contract on sinamics::ss1_basic {
        property: "every clause of the Basic SS1: its time, never restarted nor cancelled, STO at its end and at once",
        tries: "time: 0 1 3 max; left: 0..3 max",
        caveat: "none",
    }]
    [contract s120_ss1_contract on sinamics::ss1 {
        property: "every clause of the Extended SS1 and STOP B: braking, monitor, shutdown speed, time, external stop, STOP A",
        tries: "time: 0 1 3 max; shutdown: 0 5 max; left: 0..3 max; speed: 0 4 5 6 max",
        caveat: "none",
    }]
    [contract s120_ss2_contract on sinamics::ss2 {
        property: "every clause of SS2, SS2E and STOP C to E: their times, takeover, operating stop, setpoint, status",
        tries: "time_c: 1 3 max; time_d time_e: 1 3; left: 0..3 max",
        caveat: "none",
    }]
    [contract s120_sos_contract on sinamics::sos {
        property: "every clause of SOS: delay, reference, tolerance, STOP B, end",
        tries: "delay: 0 1 3 max; tolerance: 0 2 max; left: 0..3 max; reference: 0 5 min; position: 0 2 3 5 7 8 ends",
        caveat: "none",
    }]
}
