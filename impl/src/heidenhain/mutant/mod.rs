//! Deliberately wrong step functions: see [`crate::mutant`].

mod interface;

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
}
