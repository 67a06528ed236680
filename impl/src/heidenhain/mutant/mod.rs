//! Deliberately wrong step functions: see [`crate::mutant`].

mod composing;
mod groups;
mod interface;
mod machine;
mod stops;

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
        /// A change between SOM_2 and SOM_3 in motion drops the old limit.
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
        /// The requests of the other channel are taken to be the own ones.
        ChannelAlone "channel-alone" => composing::channel_alone;
    }
}
