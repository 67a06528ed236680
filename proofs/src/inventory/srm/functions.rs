//! The functions without a state.

inventory! {
    [contract srm_add_dint_contract on srm::add_dint {
        property: "every clause of LFAddDInt: the exact sum, or 0 with the flag",
        tries: "operand1 operand2: -2147483648 -2147483647 -2..2 2147483646 2147483647 1073741824 -1073741824 -1073741825",
        caveat: "none",
    }]
    [contract srm_sub_dint_contract on srm::sub_dint {
        property: "every clause of LFSubDInt: the exact difference, or 0 with the flag",
        tries: "operand1 operand2: -2147483648 -2147483647 -2..2 2147483646 2147483647 1073741824 -1073741824 -1073741825",
        caveat: "none",
    }]
    [contract [kani(solver(kissat))] srm_mul_dint_contract on srm::mul_dint {
        property: "every clause of LFMulDInt: the exact product, or 0 with the flag",
        tries: "operand1 operand2: -2147483648 -2147483647 -3..3 2147483646 2147483647 1073741824 -1073741824 46340 46341 -46341 65536 32768 -65536",
        few: [("operand2", -128, 127)],
        caveat: "none",
    }]
    [contract [kani(solver(kissat))] srm_div_dint_contract on srm::div_dint {
        property: "every clause of LFDivDInt: the quotient toward zero, or 0 with the flag",
        tries: "operand1 operand2: -2147483648 -2147483647 -9..9 2147483646 2147483647 46340",
        few: [("operand2", -128, 127)],
        caveat: "none",
    }]
    [contract srm_min_max_contract on srm::min_max {
        property: "every clause of F_MIN_MAX: one of the operands, the least or the greatest",
        tries: "in1 in8: -2 0 1 ends; in2 in3 in4 in5 in6 in7: -1 0 5",
        caveat: "none",
    }]
    [contract [kani(solver(kissat), unwind(18), stub(stillpoint_monitors::srm::interpolation::between, crate::arbitrary::srm::few_lines), stub(stillpoint_monitors::srm::interpolation::near_the_line, crate::arbitrary::srm::few_near_lines), stub(stillpoint_monitors::srm::interpolation::segments_fit, crate::arbitrary::srm::few_segments)) parts(8: ascent = 1, error = 2, point = 3, lowest = 4, line = 5, outside = 6, highest = 7, cause = 8)] srm_interpolation_contract on srm::interpolation {
        property: "every clause of F_INTERPOLATION: points, lines, ends, errors",
        tries: "x.0: 0 2; v.0: 0 -5; x.1: 0 2 5; v.1: -7 10 2147483647; x.2: 2 5 12; v.2: -7 10; x.3: 5 12; v.3: 30 5; x: 12; v: 40; x_16: 12 14; v_16: 35 40; x_actual: -1..15 ends",
        caveat: "the other points are the last one; Kani takes a line between two points of 4 bits, all else at full width, and leaves out overflows of a line",
    }]
    [total srm_add_dint_total on srm::add_dint { caveat: "none" }]
    [total srm_sub_dint_total on srm::sub_dint { caveat: "none" }]
    [total srm_mul_dint_total on srm::mul_dint { caveat: "none" }]
    [total srm_div_dint_total on srm::div_dint { caveat: "none" }]
    [total [kani(unwind(18))] srm_min_max_total on srm::min_max { caveat: "none" }]
    [total [kani(unwind(18))] srm_interpolation_total on srm::interpolation { caveat: "none" }]
}
