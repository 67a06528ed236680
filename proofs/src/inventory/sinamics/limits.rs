//! Limits of speed, direction and position.

use crate::enumeration::Domain;

inventory! {
    [contract [kani(solver(minisat), stub(stillpoint_monitors::sinamics::sls::setting::of_telegram, crate::arbitrary::sinamics::sls::any_of_telegram)) parts(6: first = 1, second = 2, third = 3, fourth = 4, fifth = 5, sixth = 6)] s120_sls_contract on sinamics::sls {
        property: "every clause of SLS: delay, four levels, lower and higher limits, telegram, without selection, stops",
        tries: "limits.0: 4; limits.1: 2; limits.2: 2 6; limits.3: 4; responses.0: 3 5; responses.1: 5 4; responses.2 responses.3: 4; delay: 0 1 3; left: 0..3; now.level: 0 1; now.limit: 0 2 4; next.level: 0 2; next.limit: 0..3; telegram: 0 16384 32767; speed: 0 2 4 5",
        few: [("limits", 0, 63)] in parts [5],
        caveat: "a few limits; others only under Kani and in samples; the quotient of the telegram is s120_sls_of_telegram",
    }]
    [run(5) [kani(solver(kissat))] s120_sls_of_telegram on sinamics::"sls" by limits::limit_of_the_telegram {
        property: "the limit of SLS1 that a telegram asks for is the exact part of p9531[0], rounded down, whatever both are",
        requirements: ["S120-SLS-009", "S120-PF-18"],
        covers: ["the whole limit", "a part that is rounded", "a limit that comes out as 0"],
        domain: Domain { delays: &[0], highest_speed: 0 },
        domain_text: "values 1 to 4 and 32767; limits 0 to 3 and the greatest, beside limits 0 to 6 and the greatest",
        bound: "one step from the initial state",
        caveat: "the exact part under Kani of limits of 10 bits",
    }]
    [contract [kani(solver(minisat), stub(stillpoint_monitors::sinamics::sls::setting::of_telegram, crate::arbitrary::sinamics::sls::any_of_telegram)) parts(19: telegram = 2, rest = 1 | 3 | 4 | 5 | 6 | 7 | 8 | 9 | 10 | 11 | 12 | 13 | 14 | 15 | 16 | 17 | 18 | 19)] s120_sls_ramp_contract on sinamics::sls_ramp {
        property: "every clause of SLS without encoder and with SBR: ramp, takeover, old limit, higher limit, telegram, stops",
        tries: "limits.0 limits.3: 4; limits.1: 2; limits.2: 6; responses.0: 4 5; responses.1: 5; responses.2 responses.3: 4; config.ramp.reference: 1 3; time: 1 2; delay: 2; resolution: 1; ramp.left: 0..2; ramp.ramp: 0 2 4 5; rest: 0 1; settling: 0..2; now.value.level: 0 1; now.value.limit: 2 4; next.value.level: 0 2; next.value.limit: 0 2; telegram: 0 16384; speed: 0..6",
        few: [("limits", 0, 63)] in parts [2],
        caveat: "a few limits and ramps; others only under Kani and in samples; the quotient of the telegram is s120_sls_of_telegram",
    }]
    [contract [kani(solver(kissat)) parts(7: first = 1, second = 2, third = 3, fourth = 4, fifth = 5, sixth = 6, seventh = 7)] s120_setpoint_limit_contract on sinamics::setpoint_limit {
        property: "every clause of the setpoint limit: part of SLS, blocked directions, acceptance test, STOP F",
        tries: "factor: 0 80 100; motor: 1 3 max; load: 1 2 max; limit: 0 1 5 1000 max",
        few: [("motor", 0, 7), ("load", 0, 7), ("limit", 0, 15)] in parts [1],
        caveat: "none",
    }]
    [contract s120_ssm_contract on sinamics::ssm {
        property: "every clause of SSM: limit, hysteresis, without pulses, what counts for STOP F",
        tries: "limit: 0 1 4 20 max; value: 0 1 3 15; speed: 0..5 19 20 max",
        caveat: "none",
    }]
    [contract s120_sdi_contract on sinamics::sdi {
        property: "every clause of SDI: delay, reference, wrong way, without selection, without pulses",
        tries: "delay: 0 1 3; tolerance: 0 2; response: 3 4 5; left: 0..3; from: -3 0 5; position: -3 0 2 3 5 7 8 ends",
        caveat: "none",
    }]
    [contract s120_slp_contract on sinamics::slp {
        property: "every clause of SLP: two ranges, reference, both meanings of active, retraction",
        tries: "first.lower: -2; first.upper: 3; second.lower: 0; second.upper: 5; position: -3 -2 0 3 4 5 6 ends",
        caveat: "none",
    }]
}
