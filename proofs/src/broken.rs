//! Monitors with an error in them: Kani must find each. `cargo kani --features mutants --harness broken` (with
//! `STILLPOINT_KANI=broken`, so that no other one is compiled) succeeds if and only if
//! every one of these harnesses fails by a clause of the contract. The first number is the place among the wrong variants of the
//! monitor. A contract that is divided is asserted as its harness does it: by the part that holds the broken clause, so that
//! a part is seen to find what is wrong in its clauses.

use crate::kani_source::Symbolic;

macro_rules! broken {
    ($($(#[$how:meta])+ $id:ident: $family:ident::$monitor:ident $place:literal, part $part:literal of $parts:literal)+) => {$(
        $(#[$how])+
        #[kani::proof]
        #[kani::should_panic]
        fn $id() {
            use stillpoint_monitors::$family::$monitor::{Monitor, Step, assert_clauses};
            let mut source = Symbolic::default();
            if let Some((before, config, inputs)) = crate::draw::step::<Monitor, _>(&mut source, &[]) {
                let wrong = stillpoint_monitors::$family::mutant::$monitor()[$place];
                let (after, outputs) = (wrong.next)(before, &config, &inputs);
                assert_clauses(Step { before, config, inputs, after, outputs }, &[$part], $parts);
            }
        }
    )+};
}

broken! {
    /// STOP B never becomes STOP A by its timer, only by standstill.
    stop_b_without_its_timer: sinumerik::stop 0, part 1 of 1
    /// RESET aborts the delay from STOP F to STOP B.
    fault_delay_aborted: sinumerik::fault 0, part 1 of 1
    /// Feedback in the cycle in which t_chk ends still counts.
    test_with_late_feedback: sinumerik::test_stop 0, part 1 of 1
    /// A position beyond the minus end is not shown.
    #[kani::unwind(10)]
    lower_end_hidden: sinumerik::results 0, part 1 of 1
    /// An SS1F that comes during the ramp loads the timer anew.
    rise_reloads_the_timer: heidenhain::stop 0, part 1 of 1
    /// SOM_4 may follow SOM_2 directly.
    mode_change_is_trusted: heidenhain::judge 0, part 1 of 1
    /// Closing the door activates.
    door_starts_the_group: heidenhain::group 0, part 1 of 1
    /// Driving further out does not lock the axis.
    way_out_never_locks: heidenhain::position_limit 0, part 1 of 1
    /// What a spindle turns back adds up.
    revolutions_add_up: heidenhain::revolutions 0, part 1 of 1
    /// A stop that the other channel tells is not taken over.
    told_stop_is_missed: heidenhain::channel 1, part 1 of 6
    /// The shutdown speed itself ends SS1.
    shutdown_speed_ends_the_stop: sinamics::ss1 0, part 1 of 1
    /// A limit is violated 1 mm later.
    limit_is_violated_late: srm::slp_monitor 0, part 1 of 1
}
