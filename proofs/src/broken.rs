//! Monitors with an error in them: Kani must find each. `cargo kani --features mutants --harness broken` succeeds if and only if
//! every one of these harnesses fails by a clause of the contract.

use crate::kani_source::Symbolic;

macro_rules! broken {
    ($($(#[doc = $error:literal])+ $id:ident: $family:ident::$monitor:ident $mutant:ident)+) => {$(
        $(#[doc = $error])+
        #[kani::proof]
        #[kani::should_panic]
        fn $id() {
            use stillpoint_monitors::$family::{$monitor::{Step, assert_clauses}, mutant::Mutant};
            let mut source = Symbolic::default();
            if let Some((before, config, inputs)) = crate::arbitrary::$family::$monitor(&mut source) {
                kani::assume(before.invariant(&config));
                let (after, outputs) = (Mutant::$mutant.$monitor())(before, &config, &inputs);
                assert_clauses(Step { before, config, inputs, after, outputs }, 1, 1);
            }
        }
    )+};
}

broken! {
    /// STOP B never becomes STOP A by its timer, only by standstill.
    stop_b_without_its_timer: sinumerik::stop StopBNoTimerExit
    /// RESET aborts the delay from STOP F to STOP B.
    fault_delay_aborted: sinumerik::fault FaultDelayAborted
    /// Feedback in the cycle in which t_chk ends still counts.
    test_with_late_feedback: sinumerik::test_stop TestStopLateFeedback
    /// SOM_4 may follow SOM_2 directly.
    mode_change_is_trusted: heidenhain::judge JudgeTrustsModeChanges
    /// What a spindle turns back adds up.
    revolutions_add_up: heidenhain::revolutions RevolutionsAddUp
}
