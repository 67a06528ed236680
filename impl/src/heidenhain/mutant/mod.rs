//! Deliberately wrong step functions: see [`crate::mutant`].

/// Declares step functions: each a wrong variant of the one of its monitor.
macro_rules! variants {
    ($($name:ident: $monitor:ident |$state:ident, $config:ident, $inputs:ident| $body:block)+) => {$(
        pub(super) fn $name(
            $state: $monitor::State,
            $config: &$monitor::Config,
            $inputs: &$monitor::Inputs,
        ) -> ($monitor::State, $monitor::Outputs) $body
    )+};
}

mod composing;
mod groups;
mod interface;
mod link;
mod machine;
mod safe_plc;
mod service;
mod stops;
mod testing;
mod watching;

mutants! { heidenhain:
    /// The take-over of requests with this mutant in it.
    fn gate {
        /// A request with an illegal field still activates.
        GateActivatesIllegal "gate-activates-illegal" => interface::gate_activates_illegal;
        /// A code that does not exist raises no stop.
        GateTrustsCodes "gate-trusts-codes" => interface::gate_trusts_codes;
        /// Restricted spindle operation is granted to a group without spindle.
        GateGrantsSpindleMode "gate-grants-spindle-mode" => interface::gate_grants_spindle_mode;
    }
    /// The joining of the requests with this mutant in it.
    fn both_channels {
        /// The request of channel A counts alone.
        BothChannelsTrustsA "both-channels-trusts-a" => interface::both_channels_trusts_a;
        /// A permissive of one channel is enough.
        BothChannelsOnePermissive "both-channels-one-permissive" => interface::both_channels_one_permissive;
    }
    /// The joining of the general fields with this mutant in it.
    fn both_fields {
        /// The mode is not compared.
        BothFieldsForgetsMode "both-fields-forgets-mode" => interface::both_fields_forgets_mode;
        /// The drives may be switched on by one channel.
        BothFieldsOneDrives "both-fields-one-drives" => interface::both_fields_one_drives;
    }
    /// The comparison of programs, run-time systems and outputs with this mutant in it.
    fn both_status {
        /// A program that is not executed in one channel is overlooked.
        BothStatusForgetsProgram "both-status-forgets-program" => interface::both_status_forgets_program;
        /// The outputs are not compared.
        BothStatusForgetsOutputs "both-status-forgets-outputs" => interface::both_status_forgets_outputs;
        /// Both run-time systems must ask for SS1F.
        BothStatusNeedsBoth "both-status-needs-both" => interface::both_status_needs_both;
    }
    /// The stop reaction with this mutant in it.
    fn stop {
        /// An SS1F that comes during the ramp loads the timer anew.
        StopReloadsTimer "stop-reloads-timer" => stops::stop_reloads_timer;
        /// An SS1D ends the braking along the contour.
        StopLeavesContour "stop-leaves-contour" => stops::stop_leaves_contour;
        /// The operator's edge restarts after SS1F as well.
        StopRestartsHard "stop-restarts-hard" => stops::stop_restarts_hard;
        /// Channel B takes the torque together with closing the brakes.
        StopDropsTheLoad "stop-drops-the-load" => stops::stop_drops_the_load;
    }
    /// What the other channel is told, with this mutant in it.
    fn report {
        /// A channel without torque tells of no further cause.
        ReportFallsSilent "report-falls-silent" => stops::report_falls_silent;
        /// A stop that has ended is told on and on.
        ReportNeverEnds "report-never-ends" => stops::report_never_ends;
    }
    /// What a stop makes of other groups, with this mutant in it.
    fn neighbour {
        /// An SS0 stays with its group.
        NeighbourKeepsSs0 "neighbour-keeps-ss0" => stops::neighbour_keeps_ss0;
        /// Every SS1 stops the machine.
        NeighbourEverySs1 "neighbour-every-ss1" => stops::neighbour_every_ss1;
    }
    /// The signal -STO.A.G with this mutant in it.
    fn global_sto {
        /// It falls with the SS0.
        GlobalStoAtOnce "global-sto-at-once" => stops::global_sto_at_once;
        /// There is no latest time.
        GlobalStoNeverLate "global-sto-never-late" => stops::global_sto_never_late;
    }
    /// The judgement with this mutant in it.
    fn judge {
        /// SOM_4 may follow SOM_2 directly.
        JudgeTrustsModeChanges "judge-trusts-mode-changes" => groups::judge_trusts_mode_changes;
        /// A turning spindle goes on without permissive as its door is opened.
        JudgeMissesTheOpenDoor "judge-misses-the-open-door" => groups::judge_misses_the_open_door;
        /// Standstill asked for in motion is no stop.
        JudgeMovingStandstill "judge-moving-standstill" => groups::judge_moving_standstill;
    }
    /// The monitoring state with this mutant in it.
    fn group {
        /// Closing the door activates.
        GroupDoorStarts "group-door-starts" => groups::group_door_starts;
        /// A change of the mode in motion drops the old limit.
        GroupLoosens "group-loosens" => groups::group_loosens;
        /// An SS1D makes STO of STO_O.
        GroupSoftLiftsSto "group-soft-lifts-sto" => groups::group_soft_lifts_sto;
    }
    /// The start-up protection with this mutant in it.
    fn startup {
        /// A permissive begins the count anew.
        StartupForgetsByPermissive "startup-forgets-by-permissive" => groups::startup_forgets_by_permissive;
        /// It responds only in the cycle in which the count ends.
        StartupLate "startup-late" => groups::startup_late;
    }
    /// The release of an axis with this mutant in it.
    fn axis_release {
        /// The enable that comes back breaks the braking off.
        AxisReleaseBreaksOff "axis-release-breaks-off" => groups::axis_release_breaks_off;
        /// Braking may last for ever.
        AxisReleaseWithoutEnd "axis-release-without-end" => groups::axis_release_without_end;
    }
    /// The selection of the mode with this mutant in it.
    fn som {
        /// A refused mode is taken one cycle later.
        SomOneCycleLock "som-one-cycle-lock" => machine::som_one_cycle_lock;
        /// The key of SOM_4 does not count beside another one.
        SomFirstKeyWins "som-first-key-wins" => machine::som_first_key_wins;
    }
    /// The permissive with this mutant in it.
    fn button {
        /// A button held at power-up counts.
        ButtonHeldAtPowerUp "button-held-at-power-up" => machine::button_held_at_power_up;
        /// One contact is enough.
        ButtonOneContact "button-one-contact" => machine::button_one_contact;
    }
    /// The control voltage with this mutant in it.
    fn switch_on {
        /// A control voltage that is on needs no edge.
        SwitchOnByLevel "switch-on-by-level" => machine::switch_on_by_level;
        /// A chain that stays open raises no stop.
        SwitchOnForgivesTheChain "switch-on-forgives-the-chain" => machine::switch_on_forgives_the_chain;
    }
    /// The permission of the outputs with this mutant in it.
    fn output_enable {
        /// Every SS1 takes it.
        OutputEnableAnySs1 "output-enable-any-ss1" => machine::output_enable_any_ss1;
        /// There is no deadline.
        OutputEnableNoDeadline "output-enable-no-deadline" => machine::output_enable_no_deadline;
    }
    /// The channel with this mutant in it.
    fn channel {
        /// A permission that is merely on restarts.
        ChannelPermitsByLevel "channel-permits-by-level" => composing::channel_permits_by_level;
        /// A stop that the other channel tells is not taken over.
        ChannelMissesTold "channel-misses-told" => composing::channel_misses_told;
        /// A cause that the other channel has told is told back to it.
        ChannelTellsBack "channel-tells-back" => composing::channel_tells_back;
        /// The requests of the other channel are taken to be the own ones.
        ChannelAlone "channel-alone" => composing::channel_alone;
    }
    /// The limited speed with this mutant in it.
    fn speed {
        /// One increment more than the limit plus 5 % is permitted.
        SpeedMarginTooWide "speed-margin-too-wide" => watching::speed_margin_too_wide;
        /// After a change of the mode in motion the new limit counts at once, also a higher one.
        SpeedHigherOfTwo "speed-higher-of-two" => watching::speed_higher_of_two;
        /// A limit that is not set is not shown.
        SpeedZeroIsNoFault "speed-zero-is-no-fault" => watching::speed_zero_is_no_fault;
    }
    /// The operating stop with this mutant in it.
    fn operating_stop {
        /// The reference follows the axis.
        OperatingStopFollows "operating-stop-follows" => watching::operating_stop_follows;
        /// A creeping axis is braked instead of losing its torque.
        OperatingStopBrakesCreeping "operating-stop-brakes-creeping" => watching::operating_stop_brakes_creeping;
        /// An axis as fast as the limit counts as standing.
        OperatingStopLimitStands "operating-stop-limit-stands" => watching::operating_stop_limit_stands;
    }
    /// The path of an SS2 with this mutant in it.
    fn stop_path {
        /// The path is limited with the door closed too.
        StopPathEveryDoor "stop-path-every-door" => watching::stop_path_every_door;
        /// The path counts from each cycle anew.
        StopPathRestarts "stop-path-restarts" => watching::stop_path_restarts;
    }
    /// The limited position with this mutant in it.
    fn position_limit {
        /// Driving further out does not lock the axis.
        PositionLimitNeverLocks "position-limit-never-locks" => watching::position_limit_never_locks;
        /// A locked axis is free again inside its limits.
        PositionLimitUnlocksInside "position-limit-unlocks-inside" => watching::position_limit_unlocks_inside;
        /// The way back is stopped like the way out.
        PositionLimitStopsTheWayBack "position-limit-stops-the-way-back" => watching::position_limit_stops_the_way_back;
        /// What the axis overruns while it is stopped locks it.
        PositionLimitLocksOverrun "position-limit-locks-overrun" => watching::position_limit_locks_overrun;
    }
    /// The two revolutions with this mutant in them.
    fn revolutions {
        /// What the spindle turns back adds up.
        RevolutionsAddUp "revolutions-add-up" => watching::revolutions_add_up;
        /// The angle is kept to the next restricted operation.
        RevolutionsNeverStartAnew "revolutions-never-start-anew" => watching::revolutions_never_start_anew;
    }
    /// The comparison of nominal and actual value with this mutant in it.
    fn comparison {
        /// Nothing is compared in the operating stop.
        ComparisonNotInStandstill "comparison-not-in-standstill" => watching::comparison_not_in_standstill;
        /// The positions of an axis without a group are compared.
        ComparisonOfEveryAxis "comparison-of-every-axis" => watching::comparison_of_every_axis;
        /// The window does not start again within the tolerance.
        ComparisonWindowAddsUp "comparison-window-adds-up" => watching::comparison_window_adds_up;
    }
    /// The dv/dt monitoring with this mutant in it.
    fn deceleration {
        /// There is no waiting time.
        DecelerationNoWait "deceleration-no-wait" => watching::deceleration_no_wait;
        /// A spindle that keeps its speed counts as braking.
        DecelerationConstantIsRight "deceleration-constant-is-right" => watching::deceleration_constant_is_right;
    }
    /// The number of moving axes with this mutant in it.
    fn axis_count {
        /// By handwheel several axes may move.
        AxisCountFreeHandwheel "axis-count-free-handwheel" => watching::axis_count_free_handwheel;
        /// Axes without a group count.
        AxisCountEveryAxis "axis-count-every-axis" => watching::axis_count_every_axis;
        /// Homing several axes is stopped with the door closed too.
        AxisCountClosedDoor "axis-count-closed-door" => watching::axis_count_closed_door;
    }
    /// The referencing with this mutant in it.
    fn reference {
        /// A saved position counts whether it was checked or not.
        ReferencePositionOnly "reference-position-only" => service::reference_position_only;
        /// The confirmation is accepted in SOM_1.
        ReferenceInSom1 "reference-in-som-1" => service::reference_in_som_1;
        /// The other channel is not asked.
        ReferenceOneChannel "reference-one-channel" => service::reference_one_channel;
        /// A cause for a check counts only if the axis was checked when the power went: a second power-on forgets it.
        ReferenceForgetsTheCause "reference-forgets-the-cause" => service::reference_forgets_the_cause;
    }
    /// The comparison of the channels with this mutant in it.
    fn agreement {
        /// The window is one cycle short.
        AgreementEarly "agreement-early" => service::agreement_early;
        /// The window is not whole again when the channels agree.
        AgreementAddsUp "agreement-adds-up" => service::agreement_adds_up;
        /// A difference of the flag "axis checked" is SS1 only.
        AgreementNeverFatal "agreement-never-fatal" => service::agreement_never_fatal;
    }
    /// The brake outputs with this mutant in them.
    fn brakes {
        /// In operation one request opens a shared output.
        BrakesAnyRequest "brakes-any-request" => service::brakes_any_request;
        /// In the test a shared output needs all requests.
        BrakesTestOverlooked "brakes-test-overlooked" => service::brakes_test_overlooked;
    }
    /// The tool holder with this mutant in it.
    fn tool_holder {
        /// The holder opens in the cycle in which torque off is asked for.
        ToolHolderAtOnce "tool-holder-at-once" => service::tool_holder_at_once;
        /// An open door counts as closed.
        ToolHolderDoorOverlooked "tool-holder-door-overlooked" => service::tool_holder_door_overlooked;
        /// Torque off is asked for while the spindle turns.
        ToolHolderCutsOffTurning "tool-holder-cuts-off-turning" => service::tool_holder_cuts_off_turning;
    }
    /// The acceptance with this mutant in it.
    fn acceptance {
        /// The list begins without the password.
        AcceptanceWithoutPassword "acceptance-without-password" => service::acceptance_without_password;
        /// One press confirms the whole list.
        AcceptanceOnePress "acceptance-one-press" => service::acceptance_one_press;
    }
    /// The telegrams between CCs with this mutant in them.
    fn cc_link {
        /// One faulty telegram more than allowed is tolerated.
        CcLinkOneTooMany "cc-link-one-too-many" => link::cc_link_one_too_many;
        /// While telegrams are faulty the drive is taken to be as it was.
        CcLinkTrustsTheLast "cc-link-trusts-the-last" => link::cc_link_trusts_the_last;
    }
    /// The self-test with this mutant in it.
    fn self_test {
        /// The test goes on with open doors.
        SelfTestDoorsOverlooked "self-test-doors-overlooked" => service::self_test_doors_overlooked;
        /// A brake that does not hold passes.
        SelfTestBadBrakePasses "self-test-bad-brake-passes" => service::self_test_bad_brake_passes;
        /// A passed test is good for ever.
        SelfTestNeverOverdue "self-test-never-overdue" => service::self_test_never_overdue;
    }
    /// The test of the cut-out channels with this mutant in it.
    fn cut_out {
        /// While the CC alone has no torque nobody watches.
        CutOutUnwatched "cut-out-unwatched" => testing::cut_out_unwatched;
        /// A power module that stays ready passes.
        CutOutPassesReady "cut-out-passes-ready" => testing::cut_out_passes_ready;
        /// An axis that moves does not break the brake test off.
        CutOutMovesOn "cut-out-moves-on" => testing::cut_out_moves_on;
    }
    /// The test of a holding brake with this mutant in it.
    fn holding_brake {
        /// A path too long passes when the current has risen.
        HoldingBrakeSlips "holding-brake-slips" => testing::holding_brake_slips;
        /// The drive lets go while the brake closes.
        HoldingBrakeLetsGo "holding-brake-lets-go" => testing::holding_brake_lets_go;
    }
    /// The forced dynamic sampling with this mutant in it.
    fn sampling {
        /// During a pulse neither channel sees an open contact.
        SamplingBlindInThePulse "sampling-blind-in-the-pulse" => service::sampling_blind_in_the_pulse;
        /// A short circuit of channel B is not found.
        SamplingBUntested "sampling-b-untested" => service::sampling_b_untested;
    }
    /// The status bits with this mutant in them.
    fn status_bits {
        /// The mask of the PLC also hides -N0.
        StatusBitsMaskTooWide "status-bits-mask-too-wide" => service::status_bits_mask_too_wide;
        /// The MC serves its watchdogs without DC-link voltage.
        StatusBitsMcServesOn "status-bits-mc-serves-on" => service::status_bits_mc_serves_on;
        /// -PF.BOARD of any participant switches the outputs of all of them off.
        StatusBitsBoardSwitchesAllOff "status-bits-board-switches-all-off" => service::status_bits_board_switches_all_off;
    }
    /// The checks of the kernel with this mutant in them.
    fn self_checks {
        /// A slow fan is not seen.
        SelfChecksFanOverlooked "self-checks-fan-overlooked" => service::self_checks_fan_overlooked;
        /// The request of the safe PLC's run-time system is SS1 only.
        SelfChecksRuntimeIsSs1 "self-checks-runtime-is-ss1" => service::self_checks_runtime_is_ss1;
    }
    /// The checks while booting with this mutant in them.
    fn start_checks {
        /// Any motor speed is plausible.
        StartChecksAnySpeed "start-checks-any-speed" => service::start_checks_any_speed;
        /// A refused control tries again by itself.
        StartChecksTriesAgain "start-checks-tries-again" => service::start_checks_tries_again;
    }
    /// The filter of the keys with this mutant in it.
    fn key_filter {
        /// A stop key of a unit that is not active is filtered.
        KeyFilterDropsStops "key-filter-drops-stops" => safe_plc::key_filter_drops_stops;
        /// The handwheel acts in every operating mode.
        KeyFilterTwoUnits "key-filter-two-units" => safe_plc::key_filter_two_units;
        /// The group signal is formed of what the filter lets through.
        KeyFilterGroupSignalLate "key-filter-group-signal-late" => safe_plc::key_filter_group_signal_late;
    }
    /// The requests for NC axes with this mutant in them.
    fn axes_logic {
        /// A key that is held while the door closes activates.
        AxesLogicHeldKeyStarts "axes-logic-held-key-starts" => safe_plc::axes_logic_held_key_starts;
        /// NC start counts as long as it is pressed, not from its edge.
        AxesLogicStartByLevel "axes-logic-start-by-level" => safe_plc::axes_logic_start_by_level;
        /// A program goes on without its permissive.
        AxesLogicForgetsThePermissive "axes-logic-forgets-the-permissive" => safe_plc::axes_logic_forgets_the_permissive;
        /// An open magazine door does not matter.
        AxesLogicMagazineDoorOverlooked "axes-logic-magazine-door-overlooked" => safe_plc::axes_logic_magazine_door_overlooked;
    }
    /// The requests for a spindle with this mutant in them.
    fn spindle_logic {
        /// A jog key that is released stops nothing.
        SpindleLogicJogRunsOn "spindle-logic-jog-runs-on" => safe_plc::spindle_logic_jog_runs_on;
        /// With the door open a start needs no permissive.
        SpindleLogicNoPermissive "spindle-logic-no-permissive" => safe_plc::spindle_logic_no_permissive;
        /// Restricted operation is granted in SOM_1 too.
        SpindleLogicRestrictedInSom1 "spindle-logic-restricted-in-som-1" => safe_plc::spindle_logic_restricted_in_som_1;
    }
    /// The requests for a magazine with this mutant in them.
    fn magazine_logic {
        /// A door that is opened in motion is an SS2.
        MagazineLogicDoorIsSs2 "magazine-logic-door-is-ss2" => safe_plc::magazine_logic_door_is_ss2;
        /// A change of the mode is overlooked.
        MagazineLogicModeOverlooked "magazine-logic-mode-overlooked" => safe_plc::magazine_logic_mode_overlooked;
        /// The confirmation outlasts the open door.
        MagazineLogicConfirmedForEver "magazine-logic-confirmed-for-ever" => safe_plc::magazine_logic_confirmed_for_ever;
        /// The permissive alone keeps it moving.
        MagazineLogicPermissiveIsEnough "magazine-logic-permissive-is-enough" => safe_plc::magazine_logic_permissive_is_enough;
    }
    /// A safe input with this mutant in it.
    fn safe_input {
        /// One contact is enough.
        SafeInputOneContact "safe-input-one-contact" => safe_plc::safe_input_one_contact;
    }
    /// The working space with this mutant in it.
    fn working_space {
        /// One closed door protects the space.
        WorkingSpaceOneDoor "working-space-one-door" => safe_plc::working_space_one_door;
    }
    /// The control voltage asked for with this mutant in it.
    fn control_voltage {
        /// One reset is good for ever.
        ControlVoltageOneReset "control-voltage-one-reset" => safe_plc::control_voltage_one_reset;
    }
    /// The jog increment with this mutant in it.
    fn jog_increment {
        /// A key that stays pressed begins the next increment.
        JogIncrementRepeats "jog-increment-repeats" => safe_plc::jog_increment_repeats;
        /// A lost condition takes the feed only.
        JogIncrementNoStop "jog-increment-no-stop" => safe_plc::jog_increment_no_stop;
    }
    /// The general fields with this mutant in them.
    fn general_fields {
        /// A marker of 2 counts as 1.
        GeneralFieldsAnyNumber "general-fields-any-number" => safe_plc::general_fields_any_number;
    }
    /// The check of a program with this mutant in it.
    fn program_check {
        /// A changed program runs on with a message.
        ProgramCheckMessageOnly "program-check-message-only" => safe_plc::program_check_message_only;
    }
    /// The table of the safety functions with this mutant in it.
    fn availability {
        /// Auxiliary axes have an operating stop in SOM_1.
        AvailabilityAuxiliaryStop "availability-auxiliary-stop" => safe_plc::availability_auxiliary_stop;
    }
    /// The functions with the door open with this mutant in them.
    fn allowed_functions {
        /// The chip conveyor needs no permissive.
        AllowedFunctionsConveyor "allowed-functions-conveyor" => safe_plc::allowed_functions_conveyor;
    }
    /// The soft key F LIMITED with this mutant in it.
    fn f_limited {
        /// In SOM_1 the limit of SOM_2 applies.
        FLimitedSom1Moves "f-limited-som-1-moves" => safe_plc::f_limited_som_1_moves;
    }
    /// The motion of a group with this mutant in it.
    fn group_motion {
        /// The first axis counts alone.
        GroupMotionFirstAxis "group-motion-first-axis" => safe_plc::group_motion_first_axis;
    }
    /// A safe output with this mutant in it.
    fn safe_output {
        /// The enable is not looked at.
        SafeOutputStaysOn "safe-output-stays-on" => safe_plc::safe_output_stays_on;
    }
}
