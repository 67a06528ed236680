//! Leaving a range and coming back: what F_SLP_MONITOR and F_ENDZONE do alike. No step of its own.
//!
//! The side is the limit that was violated last. Its motion toward the limit stays locked until the axis is inside again and that is
//! acknowledged; a retraction is asked for by an edge at RELEASE and ends with its level (AMB-24 to AMB-27, AMB-70).

use crate::srm::common::latch;

fields! {
    /// Where an axis is with its range.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Normal: no limit has been violated, or all is acknowledged.
        #[default]
        Normal,
        /// Stopped below the lower limit.
        FaultLower,
        /// Stopped above the upper limit.
        FaultUpper,
        /// Retraction from below the lower limit.
        RetractLower,
        /// Retraction from above the upper limit.
        RetractUpper,
        /// Retraction from below, suspended while the velocity is invalid.
        SuspendLower,
        /// Retraction from above, suspended while the velocity is invalid.
        SuspendUpper,
        /// RELEASE inside the range: F_ENDZONE only.
        Inside,
    }
}

impl Phase {
    /// The lower limit was violated last.
    pub const fn lower(self) -> bool {
        matches!(
            self,
            Self::FaultLower | Self::RetractLower | Self::SuspendLower
        )
    }

    /// The upper limit was violated last.
    pub const fn upper(self) -> bool {
        matches!(
            self,
            Self::FaultUpper | Self::RetractUpper | Self::SuspendUpper
        )
    }

    /// A retraction from outside goes on.
    pub const fn retracts(self) -> bool {
        matches!(self, Self::RetractLower | Self::RetractUpper)
    }

    /// A retraction waits for a valid velocity.
    pub const fn suspended(self) -> bool {
        matches!(self, Self::SuspendLower | Self::SuspendUpper)
    }

    /// RELEASE was accepted and is held.
    pub const fn released(self) -> bool {
        self.retracts() || self.suspended() || matches!(self, Self::Inside)
    }
}

fields! {
    /// The outputs of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// SLS limit, mm/min.
        pub sls_threshold: i32,
        /// The velocity keeps the limit.
        pub sls_ok: bool,
        /// The position keeps the lower limit, or retracts: 0 from a violation until it is acknowledged (SRM-SLP-025).
        pub x_negative_ok: bool,
        /// The position keeps the upper limit, or retracts, in the same way (SRM-SLP-025).
        pub x_positive_ok: bool,
        /// Motion in the negative direction is permitted.
        pub move_negative_ok: bool,
        /// Motion in the positive direction is permitted.
        pub move_positive_ok: bool,
        /// Something can be acknowledged.
        pub ack_req: bool,
        /// A fault is latched or a parameter is wrong.
        pub error: bool,
        /// The diagnostic word.
        pub diag: u16,
    }
}

impl Outputs {
    /// Every enable is given.
    pub const fn all_enabled(&self) -> bool {
        self.sls_ok
            && self.x_negative_ok
            && self.x_positive_ok
            && self.move_negative_ok
            && self.move_positive_ok
    }
}

/// What a call tells the machine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Given {
    /// The position is below the lower limit, or the limits are crossed; never with an invalid position.
    pub below: bool,
    /// The position is above the upper limit, or the limits are crossed; never with an invalid position.
    pub above: bool,
    /// The limits are crossed.
    pub crossed: bool,
    pub pos_valid: bool,
    pub v_valid: bool,
    pub release: bool,
    /// RELEASE has become 1.
    pub release_edge: bool,
    /// ACK has become 1.
    pub acknowledged: bool,
    /// RELEASE counts inside the range.
    pub inside: bool,
}

/// The machine with the latches of both limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Range {
    pub phase: Phase,
    pub low: bool,
    pub high: bool,
}

impl Range {
    /// One call. An invalid position is neither below nor above: what is latched may then be acknowledged wherever the axis is.
    pub(crate) const fn next(self, given: &Given) -> Self {
        let low = latch(self.low, given.below, given.acknowledged, true);
        let high = latch(self.high, given.above, given.acknowledged, true);
        let phase = self.phase;
        let (stopped, other) = if phase.lower() {
            (
                Phase::FaultLower,
                if high {
                    Phase::FaultUpper
                } else {
                    Phase::Normal
                },
            )
        } else {
            (
                Phase::FaultUpper,
                if low {
                    Phase::FaultLower
                } else {
                    Phase::Normal
                },
            )
        };
        let outside = phase.lower() || phase.upper();
        let own_cleared = phase.lower() && self.low && !low || phase.upper() && self.high && !high;
        let ends = !given.release && phase.released();
        let starts = given.release_edge && given.pos_valid;
        let phase = if given.crossed || given.below && !phase.lower() {
            Phase::FaultLower
        } else if given.above && !phase.upper() {
            Phase::FaultUpper
        } else if own_cleared {
            other
        } else if ends {
            if outside { stopped } else { Phase::Normal }
        } else {
            match phase {
                Phase::RetractLower | Phase::SuspendLower if !given.v_valid => Phase::SuspendLower,
                Phase::RetractUpper | Phase::SuspendUpper if !given.v_valid => Phase::SuspendUpper,
                Phase::RetractLower | Phase::SuspendLower => Phase::RetractLower,
                Phase::RetractUpper | Phase::SuspendUpper => Phase::RetractUpper,
                Phase::FaultLower if starts && given.v_valid => Phase::RetractLower,
                Phase::FaultUpper if starts && given.v_valid => Phase::RetractUpper,
                Phase::Normal if starts && given.inside => Phase::Inside,
                same => same,
            }
        };
        Self { phase, low, high }
    }

    /// A side is one only while its limit is latched.
    pub(crate) const fn consistent(self) -> bool {
        (!self.phase.lower() || self.low)
            && (!self.phase.upper() || self.high)
            && (self.phase.lower() || self.phase.upper() || !self.low && !self.high)
    }

    /// Something latched may be acknowledged now.
    pub(crate) const fn acknowledgeable(self, given: &Given) -> bool {
        self.low && !given.below || self.high && !given.above
    }
}
