//! Position and speed: the monitors, the override of the limits, the conversions to increments.

use crate::enumeration::Domain;
use crate::inventory::NARROW;

inventory! {
    [contract motion_contract on sinumerik::motion {
        property: "every clause of the actual position's contract: speed as a distance, first position, parking",
        tries: "last position: -3..3 ends; speed: ends",
        caveat: "the encoder itself is outside",
    }]
    [contract standstill_contract on sinumerik::standstill {
        property: "every clause of the operating stop's window: STOP B beyond it, none inside, the side shown",
        tries: "tol: 0..3 100000; position reference: -5..5 ends",
        caveat: "none",
    }]
    [contract [kani(solver(kissat))] speed_contract on sinumerik::speed {
        property: "every clause of the speed limit's contract: configured stop, encoder limit",
        tries: "encoder_max.value: ends; speed: 0..2 max; limit encoder_speed: 0 1 max",
        caveat: "none",
    }]
    [contract [kani(solver(kissat), stub(stillpoint_monitors::kernel::Speed::reduced, crate::kani_source::reduced_small))] setpoint_contract on sinumerik::setpoint {
        property: "every clause of the setpoint limit's contract: the lower of both channels, nothing without selection",
        tries: "percent: 0 1 99 100; nck_limit drive_limit: 0..2 max",
        caveat: "Kani takes limits below a factor of at most 15; units_factor shows that a wide one is reduced exactly",
    }]
    [contract limit_switch_contract on sinumerik::limit_switch {
        property: "every clause of the limit switches' contract: selected pair, agreement, configured stop",
        tries: "plus minus: -1..1 ends; position: -2..2 ends",
        caveat: "whether the position is right is the agreement's business",
    }]
    [contract ramp_contract on sinumerik::ramp {
        property: "every clause of the braking ramp's contract: start, fall and end of the limit, STOP A",
        tries: "velo_x tol: 0..2 max; lowest: 0..4 max; speed: 0..6 max",
        caveat: "how long the ramp is on comes from the arbitration",
    }]
    [contract threshold_contract on sinumerik::threshold {
        property: "every clause of the threshold's contract",
        tries: "velo_x speed: 0..5 max",
        caveat: "none",
    }]
    [contract [kani(stub(stillpoint_monitors::units::ModuloRange::folded, crate::kani_source::folded_in_range))] cam_contract on sinumerik::cam {
        property: "every clause of a cam's contract: side, hysteresis, modulo range, synchronisation",
        tries: "config.cam: -1..1 ends; tol: 0..2 max; range: -2..2 ends; position: -5..5 ends",
        caveat: "the signal is safe only together with \"axis safely referenced\"; Kani takes positions in the modulo range, units_folding folds the others into it",
    }]
    [contract [kani(unwind(10))] results_contract on sinumerik::results {
        property: "every clause of the result lists' contract: a field for each function, none hidden",
        domain: NARROW,
        domain_text: "every result; every pattern of the first two cams with the others off, and all on",
        caveat: "n_x by the magnitude of the speed: both of its fields change together",
    }]
    [run(4) watching_initial_states on sinumerik::"the watching monitors" by watching::watching_initial_states {
        property: "the initial states of the monitors of position and speed satisfy their invariants: the base of the induction",
        requirements: ["S840D-ARCH-504"],
        covers: ["an accepted configuration"],
        domain: NARROW,
        domain_text: "every configuration of the contracts above",
        bound: "none",
        caveat: "none",
    }]
    [run(6) [kani(solver(kissat)) parts(5: first = 1, second = 2, third = 3, fourth = 4, never = 5)] ramp_braking on sinumerik::"ramp, stop" by watching::braking_ramp {
        property: "in one braking the limit never rises, stays once frozen, and a faster axis has its pulses cancelled at once",
        requirements: ["S840D-P-10", "S840D-P-11", "S840D-SBR-001", "S840D-SBR-002", "S840D-SBR-003", "S840D-SBR-009",
            "S840D-SBR-010"],
        covers: ["the axis becomes too fast", "the limit is frozen and stays", "STOP C becomes STOP B"],
        domain: NARROW,
        domain_text: "n_x 0 to 2, tolerance 0 or 1, speeds 0 to 4, and 32 bits, in every cycle; STOP B at once, later or never",
        bound: "four cycles of braking; longer ones follow from the contract (limit_never_rises, lowest_limit_is_kept)",
        caveat: "the stop in the cycle of the violation, exchange and inputs outside",
    }]
    [run(6) cam_pair on sinumerik::"cam, two channels" by watching::synchronised_cams_agree {
        property: "at rest a synchronised cam shows the same in both channels two cycles later, wherever each sees the axis",
        requirements: ["S840D-P-32", "S840D-SN-006", "S840D-SN-007", "S840D-SN-015"],
        covers: ["the channels see different sides", "both show 1", "a signal changes on the way"],
        domain: NARROW,
        domain_text: "cams -1 to 1, positions -4 to 4, and the ends of 32 bits; every state before",
        bound: "exchange in one cycle; three cycles",
        caveat: "without modulo range, which the contract treats",
    }]
    [run(6) cam_hysteresis on sinumerik::"cam" by watching::hysteresis_does_not_flicker {
        property: "to and fro inside the hysteresis the signal does not change",
        requirements: ["S840D-SN-006", "S840D-SN-008"],
        covers: ["signal 1", "signal 0"],
        domain: NARROW,
        domain_text: "tolerance 1 to 3, every position inside the hysteresis in each of four cycles",
        bound: "four cycles, tolerance at most 3; the rest follows from the contract (hysteresis_keeps)",
        caveat: "reading A-40 HYST_UP",
    }]
    [run(18) [kani(solver(kissat), stub(stillpoint_monitors::kernel::Speed::reduced, crate::kani_source::reduced_small))] selection_override on sinumerik::"selection" by watching::override_means_nothing_in_sg1_and_sg3 {
        property: "with SG1 or SG3 selected two runs that differ in the override signals only are the same",
        requirements: ["S840D-P-31", "S840D-OVR-001"],
        covers: ["the signals differ where an override exists"],
        domain: Domain { delays: &[0, 2], highest_speed: 1 },
        domain_text: "t_vel 0 or 2 cycles; limits 0 or 1; factors 1 or 100 %; override 0 or 15; every consistent state and input",
        bound: "one step from any consistent state; inductive",
        caveat: "Kani takes limits below a factor of at most 15; the code compares limits, and units_factor shows that a wide one is reduced exactly",
    }]
    [run(6) monitors_stop on sinumerik::"motion, selection, standstill, speed, limit_switch, stop" by watching::violation_stops_in_the_same_cycle {
        property: "window left, stage exceeded or limit switch passed: the configured stop is effective in the same cycle, else none is",
        requirements: ["S840D-P-04", "S840D-P-47", "S840D-P-49", "S840D-TIMING-505", "S840D-TIMING-506", "S840D-TIMING-507"],
        covers: ["operating stop left", "stage exceeded", "limit switch passed"],
        domain: NARROW,
        domain_text: "positions -1 to 1, then -4 to 4, and the ends of 32 bits; every stage, stop and pair; another stop latched or not",
        bound: "two cycles from power-on, one set of limits",
        caveat: "the end of the stop is the arbitration's contract",
    }]
    [run(12) results_bits on sinumerik::"results" by watching::result_bits_keep_every_field {
        property: "the bits of the result lists hold every field at its place",
        requirements: ["S840D-KDV-515"],
        covers: ["list 1 not empty", "list 2 not empty"],
        domain: NARROW,
        domain_text: "list 1 complete; list 2 with its eighth cam and n_x free",
        bound: "none",
        caveat: "none",
    }]
    [run(4) [kani(solver(kissat)) parts(2: linear = 1, rotary = 2)] units_speed on sinumerik::"units" by units::speed_rounds_down {
        property: "a speed limit in increments per cycle is the exact one rounded down",
        requirements: ["S840D-TIMING-512", "S840D-KDV-711", "S840D-SG-001"],
        covers: ["rounded", "exact"],
        domain: NARROW,
        domain_text: "both kinds of axis; 0 to 40 mm/min or rev/min in steps of 0.2, and 4 million; cycles 24.988 to 25 ms and 1 us",
        bound: "none",
        caveat: "Kani takes speeds of 13 bits of a linear axis and of 9 bits of a rotary one, in steps of 0.2, and every cycle",
    }]
    [run(4) [kani(solver(kissat)) parts(2: linear = 1, rotary = 2)] speed_movement on sinumerik::"units, motion, speed" by units::movement_is_compared_exactly {
        property: "a movement in one cycle violates the stage exactly if it is more than the exact limit times the cycle",
        requirements: ["S840D-TIMING-512", "S840D-SG-001", "S840D-KDV-711"],
        covers: ["a violation", "the largest movement permitted"],
        domain: NARROW,
        domain_text: "0 to 24 mm/min or rev/min, and 60000; cycles 24.992 to 25 ms and 1 us; movements around the limit and large ones",
        bound: "none",
        caveat: "whole increments: the encoder rounds to less than one; Kani takes limits of 11 bits of a linear axis and of 6 bits of a rotary one, with every cycle and every movement",
    }]
    [run(4) [kani(solver(kissat))] units_factor on sinumerik::"units, selection" by units::factor_rounds_down {
        property: "an override or setpoint factor rounds a limit down",
        requirements: ["S840D-OVR-001", "S840D-PARAM-011", "S840D-PARAM-012"],
        covers: ["rounded"],
        domain: NARROW,
        domain_text: "limits 0 to 120 and 32 bits; every factor",
        bound: "none",
        caveat: "none",
    }]
    [run(4) [kani(solver(kissat))] units_limits on sinumerik::"units" by units::limits_round_inwards {
        property: "tolerances and upper limits are rounded down, lower limits up",
        requirements: ["S840D-SBH-001", "S840D-SE-001", "S840D-SN-002"],
        covers: ["a broken increment below zero"],
        domain: NARROW,
        domain_text: "-3 to 3 increments in thousandths, and the ends of 32 bits",
        bound: "32 bits of thousandths",
        caveat: "Kani takes 16 bits of thousandths",
    }]
    [run(4) [kani(solver(kissat), stub(i64::checked_rem_euclid, crate::properties::sinumerik::units::by_definition::rem_euclid))] units_folding on sinumerik::"units, cam" by units::folding_keeps_the_position {
        property: "a folded position is in the modulo range, a whole number of ranges away",
        requirements: ["S840D-SN-011", "S840D-PARAM-014"],
        covers: ["folded down", "folded up", "no range"],
        domain: NARROW,
        domain_text: "ranges -3 to 3, positions -9 to 9, and the ends of 32 bits",
        bound: "none",
        caveat: "Kani takes the remainder by its definition",
    }]
    [run(4) [kani(solver(kissat), stub(stillpoint_monitors::sinumerik::encoder::greatest_common_divisor, crate::properties::sinumerik::units::no_common_divisor), stub(i64::checked_div_euclid, crate::properties::sinumerik::units::by_definition::div_euclid))] encoder_position on sinumerik::"encoder" by units::encoder_position_rounds_down {
        property: "the position of a rotary encoder is the exact one rounded down, in both directions",
        requirements: ["S840D-ENC-006", "S840D-ARCH-503/b"],
        covers: ["reversed, below zero, rounded"],
        domain: NARROW,
        domain_text: "small pulses, gear ratios and pitches, and the largest; counts -6 to 6 and the ends of 32 bits",
        bound: "ratios of 32 bits in lowest terms; others are refused",
        caveat: "Kani takes the quotient by its definition, encoders, gears and pitches of 3 or 4 bits and counts of 10, and leaves out the reduction to lowest terms",
    }]
    [run(4) [kani(solver(kissat), stub(stillpoint_monitors::sinumerik::encoder::greatest_common_divisor, crate::properties::sinumerik::units::no_common_divisor), stub(stillpoint_monitors::sinumerik::encoder::quotient, crate::properties::sinumerik::units::by_definition::quotient))] encoder_speed on sinumerik::"encoder" by units::encoder_speed_rounds_down {
        property: "the highest speed under the encoder limit frequency is the exact one rounded down, at load and encoder",
        requirements: ["S840D-FREQ-001", "S840D-FREQ-002", "S840D-FREQ-003"],
        covers: ["an extended limit frequency"],
        domain: NARROW,
        domain_text: "300 kHz to 300.003 kHz and 420 kHz; cycles 24.998 to 25 ms and 1 us; small encoders and gears, and the largest",
        bound: "results of 32 bits; others are refused",
        caveat: "Kani takes the quotient by its definition, encoders, gears and pitches of 2 or 3 bits, cycles to 32 us and 300 to 300.063 kHz, and leaves out the reduction to lowest terms",
    }]
}
