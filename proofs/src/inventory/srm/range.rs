//! The monitors of the range.

inventory! {
    [contract srm_slp_monitor_contract on srm::slp_monitor {
        property: "every clause of F_SLP_MONITOR: limits, retraction, suspension, acknowledgement, reports",
        tries: "x_negative: -1 2; x_positive: 0 3; vmax_release: 0 1 5; safe_pos: -2..4; safe_v: 0 1 2 5 6 -6",
        caveat: "none",
    }]
    [contract [kani(unwind(18), stub(stillpoint_monitors::srm::interpolation::Curve::limit, crate::arbitrary::srm::any_limit), stub(stillpoint_monitors::srm::interpolation::Curve::ascends, crate::arbitrary::srm::any_ascent)) parts(2: first = 1, second = 2)] srm_endzone_contract on srm::endzone {
        property: "every clause of F_ENDZONE: limits, envelope of the approached end, retraction, invalid signals, reports",
        tries: "vmax_release: 3 9; x.0 v.0: 0; x.1: 2; v.1: 2; config.interpolation.x x_16: 4; config.interpolation.v v_16: 6; err_react: 0; overflowed: 0; place: 0 1; threshold: 4; state.ack_held: 0; safe_pos: -1 1 4 -2147483648; safe_v: 0 3 7; x_negative: 0 2; x_positive: 1 5",
        caveat: "Kani takes any function of the distance for the envelope, with parameters that have nothing to do with it; other envelopes, limits and velocities of the enumeration only in samples",
    }]
    [total [kani(unwind(18))] srm_slp_monitor_total on srm::slp_monitor { caveat: "none" }]
    [total [kani(unwind(18))] srm_endzone_total on srm::endzone { caveat: "none" }]
}
