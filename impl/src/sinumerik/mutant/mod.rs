//! Deliberately wrong step functions: see [`crate::mutant`].

mod axis;
mod checking;
mod composing;
mod pair;
mod stops;
mod watching;

mutants! { sinumerik:
    /// The arbitration with this mutant in it.
    fn stop {
        /// STOP B never becomes STOP A by its timer, only by standstill.
        StopBNoTimerExit "stop-b-no-timer-exit" => stops::stop_b_no_timer_exit;
        /// STOP B on an axis that stands waits a cycle before it becomes STOP A.
        StopBOnStandingAxis "stop-b-on-standing-axis" => stops::stop_b_on_standing_axis;
        /// `$VA_STOPSI` shows neither STOP F nor the test of the external shutdown.
        StopWithoutFAndTest "stop-without-f-and-test" => stops::stop_without_f_and_test;
        /// A lower stop displaces a higher latched one.
        StopLowerDisplaces "stop-lower-displaces" => stops::stop_lower_displaces;
        /// RESET acknowledges a STOP C, D or E already while it brakes.
        StopResetWhileBraking "stop-reset-while-braking" => stops::stop_reset_while_braking;
        /// A rise to a higher stop in the operating stop starts a new braking phase.
        StopReleasesStandstill "stop-releases-standstill" => stops::stop_releases_standstill;
    }
    /// The external stops with this mutant in them.
    fn external {
        /// The signals count before the comparison of the safe logic has been started.
        ExternalBeforeStart "external-before-start" => stops::external_before_start;
        /// STOP D comes before STOP C.
        ExternalWrongPriority "external-wrong-priority" => stops::external_wrong_priority;
    }
    /// STOP F with this mutant in it.
    fn fault {
        /// RESET aborts the delay from STOP F to STOP B.
        FaultDelayAborted "fault-delay-aborted" => stops::fault_delay_aborted;
        /// A STOP C, D or E keeps STOP B from following also when it comes during the delay.
        FaultDelayHeldByStop "fault-delay-held-by-stop" => stops::fault_delay_held_by_stop;
    }
    /// The effect on other axes with this mutant in it.
    fn group {
        /// With setting 1 an external stop acts on the interpolating axes like an internal one.
        GroupExternalReaches "group-external-reaches" => stops::group_external_reaches;
    }
    /// The selection with this mutant in it.
    fn selection {
        /// The delay to a lower limit or to the operating stop is one cycle short.
        SelectionDelayShort "selection-delay-short" => axis::selection_delay_short;
        /// The forced operating stop follows the de-selection signal.
        SelectionForcedDeselects "selection-forced-deselects" => axis::selection_forced_deselects;
        /// A lower override factor takes effect at once.
        SelectionFactorAtOnce "selection-factor-at-once" => axis::selection_factor_at_once;
        /// The override signals make SG3 the stage SG4.
        SelectionOverrideInSg3 "selection-override-in-sg3" => axis::selection_override_in_sg3;
        /// The reference of the operating stop is captured anew in every cycle.
        SelectionReferenceCreeps "selection-reference-creeps" => axis::selection_reference_creeps;
        /// The forced operating stop takes its reference a cycle after the braking has ended.
        SelectionForcedLate "selection-forced-late" => axis::selection_forced_late;
        /// The window of the operating stop stays where it is when referencing sets the position anew.
        SelectionWindowStays "selection-window-stays" => axis::selection_window_stays;
    }
    /// The referencing with this mutant in it.
    fn reference {
        /// One agreement of the two is enough for the safe reference.
        ReferenceOneAgreement "reference-one-agreement" => axis::reference_one_agreement;
        /// "Safely referenced" outlives the agreement by a cycle.
        ReferenceLateReset "reference-late-reset" => axis::reference_late_reset;
        /// The agreement is told as confirmed before it has been compared with the history.
        ReferenceTellsUncompared "reference-tells-uncompared" => axis::reference_tells_uncompared;
    }
    /// The agreement with this mutant in it.
    fn agreement {
        /// The agreement is kept when the gear stage changes.
        AgreementKeptAfterGear "agreement-kept-after-gear" => axis::agreement_kept_after_gear;
        /// The agreement is kept when the comparison with the history fails.
        AgreementNoHistory "agreement-no-history" => axis::agreement_no_history;
        /// The agreement is given without the key.
        AgreementWithoutKey "agreement-without-key" => axis::agreement_without_key;
    }
    /// The gear stage with this mutant in it.
    fn gear {
        /// A change of the gear stage to stage 1 is overlooked.
        GearChangeOverlooked "gear-change-overlooked" => axis::gear_change_overlooked;
    }
    /// The test of the shutdown path with this mutant in it.
    fn test_stop {
        /// Feedback in the cycle in which t_chk ends still counts.
        TestStopLateFeedback "test-stop-late-feedback" => checking::test_stop_late_feedback;
        /// The test passes without feedback.
        TestStopWithoutFeedback "test-stop-without-feedback" => checking::test_stop_without_feedback;
    }
    /// The test of the external shutdown with this mutant in it.
    fn shutdown_test {
        /// A failed test raises no stop.
        ShutdownTestSilent "shutdown-test-silent" => checking::shutdown_test_silent;
    }
    /// The pulse cancellation with this mutant in it.
    fn pulses {
        /// A failed internal cancellation does not take the external enable away.
        PulsesNoFallback "pulses-no-fallback" => checking::pulses_no_fallback;
        /// The pulses are enabled before the run-up is complete.
        PulsesBeforeRunUp "pulses-before-run-up" => checking::pulses_before_run_up;
    }
    /// The comparison with this mutant in it.
    fn compare {
        /// Static items are not compared either while a signal changes.
        CompareStaticSuspended "compare-static-suspended" => checking::compare_static_suspended;
        /// The checking timer starts anew instead of ending.
        CompareCheckingRestarts "compare-checking-restarts" => checking::compare_checking_restarts;
        /// A change of a signal begins the list anew.
        CompareSkipsAfterChange "compare-skips-after-change" => checking::compare_skips_after_change;
    }
    /// The synchronisation with this mutant in it.
    fn slip {
        /// Each channel corrects the whole difference.
        SlipWholeDifference "slip-whole-difference" => checking::slip_whole_difference;
    }
    /// The history with this mutant in it.
    fn history {
        /// A difference equal to the tolerance fails.
        HistoryAtTolerance "history-at-tolerance" => checking::history_at_tolerance;
        /// The reference position overwrites the stored one before they are compared.
        HistoryOvertaken "history-overtaken" => checking::history_overtaken;
    }
    /// The forced checking with this mutant in it.
    fn forced_check {
        /// The test of one path is enough.
        ForcedCheckOnePath "forced-check-one-path" => checking::forced_check_one_path;
    }
    /// The actual position with this mutant in it.
    fn motion {
        /// The way made while parked counts as speed.
        MotionParkingOverlooked "motion-parking-overlooked" => watching::motion_parking_overlooked;
        /// Only motion in the positive direction has a speed.
        MotionOneDirection "motion-one-direction" => watching::motion_one_direction;
        /// A position set anew by referencing counts as motion.
        MotionReferenceCounts "motion-reference-counts" => watching::motion_reference_counts;
        /// A position set anew by referencing takes a moving axis for one that stands.
        MotionReferenceStops "motion-reference-stops" => watching::motion_reference_stops;
    }
    /// The window of the operating stop with this mutant in it.
    fn standstill {
        /// The lower limit of the window is not watched.
        StandstillOneSide "standstill-one-side" => watching::standstill_one_side;
    }
    /// The limit of the speed with this mutant in it.
    fn speed {
        /// One increment more than the limit is permitted.
        SpeedLimitLoose "speed-limit-loose" => watching::speed_limit_loose;
        /// The encoder limit is not watched in the operating stop.
        SpeedEncoderOverlooked "speed-encoder-overlooked" => watching::speed_encoder_overlooked;
    }
    /// The limit switches with this mutant in them.
    fn limit_switch {
        /// The pair that is not selected is watched.
        LimitSwitchOtherPair "limit-switch-other-pair" => watching::limit_switch_other_pair;
        /// The limit switches act without agreement.
        LimitSwitchWithoutAgreement "limit-switch-without-agreement" => watching::limit_switch_without_agreement;
    }
    /// The braking ramp with this mutant in it.
    fn ramp {
        /// The limit follows the speed up again.
        RampLimitRises "ramp-limit-rises" => watching::ramp_limit_rises;
        /// A violation demands STOP B only.
        RampDemandsStopB "ramp-demands-stop-b" => watching::ramp_demands_stop_b;
    }
    /// The threshold with this mutant in it.
    fn threshold {
        /// At the threshold the axis counts as below it.
        ThresholdIncluded "threshold-included" => watching::threshold_included;
    }
    /// The cams with this mutant in them.
    fn cam {
        /// A synchronised cam has no hysteresis.
        CamWithoutHysteresis "cam-without-hysteresis" => watching::cam_without_hysteresis;
        /// A synchronised cam does not ask the other channel.
        CamAlone "cam-alone" => watching::cam_alone;
    }
    /// The result lists with this mutant in them.
    fn results {
        /// A position beyond the minus end is not shown.
        ResultsHideLowerEnd "results-hide-lower-end" => watching::results_hide_lower_end;
        /// SG1 is shown as selected whatever stage is in force.
        ResultsShowSg1 "results-show-sg1" => watching::results_show_sg1;
    }
    /// The channel with this mutant in it.
    fn channel {
        /// The braking ramp watches nothing.
        ChannelRampUnwired "channel-ramp-unwired" => composing::channel_ramp_unwired;
        /// The end of a STOP C, D or E does not force the operating stop.
        ChannelForcedStopUnwired "channel-forced-stop-unwired" => composing::channel_forced_stop_unwired;
        /// The pulses are cancelled one cycle after their stop.
        ChannelPulsesLate "channel-pulses-late" => composing::channel_pulses_late;
        /// The operating stop that a stop ends in is shown a cycle late.
        ChannelStandstillShownLate "channel-standstill-shown-late" => composing::channel_standstill_shown_late;
        /// `$VA_STOPSI` hides STOP F and the test of the external shutdown.
        ChannelStopsiHidesFault "channel-stopsi-hides-fault" => composing::channel_stopsi_hides_fault;
        /// Referencing is not told to the monitors: the new position counts as motion.
        ChannelReferenceOverlooked "channel-reference-overlooked" => composing::channel_reference_overlooked;
        /// A STOP C, D or E of the same cycle keeps STOP F from starting its delay.
        ChannelFaultSeesTheNewStop "channel-fault-sees-the-new-stop" => composing::channel_fault_sees_the_new_stop;
    }
    /// The two channels with this mutant between them.
    fn pair {
        /// The drive is told a latched stop of the NCK a cycle late.
        PairStopLate "pair-stop-late" => pair::stop_late;
        /// The NCK is told an external stop of the drive a cycle late.
        PairRequestLate "pair-request-late" => pair::request_late;
        /// A channel passes on an external stop that it was told itself.
        PairRequestPassedBack "pair-request-passed-back" => pair::request_passed_back;
        /// The drive reads its own external stop instead of that of the NCK.
        PairOwnRequestRead "pair-own-request-read" => pair::own_request_read;
        /// The test stop of the NCK is passed on as an external stop.
        PairTestPassedOn "pair-test-passed-on" => pair::test_passed_on;
        /// The NCK is not told a STOP F of the drive.
        PairFaultNotTold "pair-fault-not-told" => pair::fault_not_told;
        /// The drive is told a STOP F of the NCK a cycle late.
        PairFaultLate "pair-fault-late" => pair::fault_late;
        /// The NCK takes RESET while the drive brakes.
        PairResetWhileOtherBrakes "pair-reset-while-other-brakes" => pair::reset_while_other_brakes;
        /// The NCK is told the agreement of the drive a cycle late.
        PairAgreementStale "pair-agreement-stale" => pair::agreement_stale;
        /// The drive reads its own agreement instead of that of the NCK.
        PairOwnAgreementRead "pair-own-agreement-read" => pair::own_agreement_read;
        /// The drive does not compare its position with the history.
        PairHistoryNotComparedInDrive "pair-history-not-compared-in-drive" => pair::history_not_compared_in_drive;
        /// The drive is not told that signals of the NCK change.
        PairChangeNotTold "pair-change-not-told" => pair::change_not_told;
        /// The drive compares result lists that are a cycle apart.
        PairListsApart "pair-lists-apart" => pair::lists_apart;
        /// The NCK does not hear of a test of the drive.
        PairTestResultLost "pair-test-result-lost" => pair::test_result_lost;
        /// The NCK is told nothing but what is compared.
        PairNothingTold "pair-nothing-told" => pair::nothing_told;
    }
}
