//! Monitors with an error in them: Kani must find each. `cargo kani --features mutants --harness broken` succeeds if and only if
//! every one of these harnesses fails by a clause of the contract. The number is the place among the wrong variants of the monitor.

use crate::kani_source::Symbolic;

macro_rules! broken {
    ($($(#[doc = $error:literal])+ $id:ident: $family:ident::$monitor:ident $place:literal)+) => {$(
        $(#[doc = $error])+
        #[kani::proof]
        #[kani::should_panic]
        fn $id() {
            use stillpoint_monitors::$family::$monitor::{Monitor, Step, assert_clauses};
            let mut source = Symbolic::default();
            if let Some((before, config, inputs)) = crate::draw::step::<Monitor, _>(&mut source) {
                let wrong = stillpoint_monitors::$family::mutant::$monitor()[$place];
                let (after, outputs) = (wrong.next)(before, &config, &inputs);
                assert_clauses(Step { before, config, inputs, after, outputs }, 1, 1);
            }
        }
    )+};
}

broken! {
    /// STOP B never becomes STOP A by its timer, only by standstill.
    stop_b_without_its_timer: sinumerik::stop 0
    /// RESET aborts the delay from STOP F to STOP B.
    fault_delay_aborted: sinumerik::fault 0
    /// Feedback in the cycle in which t_chk ends still counts.
    test_with_late_feedback: sinumerik::test_stop 0
    /// SOM_4 may follow SOM_2 directly.
    mode_change_is_trusted: heidenhain::judge 0
    /// What a spindle turns back adds up.
    revolutions_add_up: heidenhain::revolutions 0
}
