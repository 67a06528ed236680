//! Stops, monitoring states, kinds of group and operating modes: what the monitors of the family speak of.
//!
//! The interface to the safe PLC holds most of them as double words with named constants (`splcapimarker.def`), of which the
//! manual prints the names only. The codes here number them in the order of the lists `ALL`; an embedding translates.

fields! {
    /// A stop of an axis group, in rising priority (HFS-STOP-001, HFS-STOP-003).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Stop {
        /// No stop.
        #[default]
        None,
        /// Braking along the contour, then standstill under control (stop category 2).
        Ss2,
        /// An SS1 that waits until other axis groups stand still.
        Ss1D,
        /// Braking along the emergency ramp, then torque off (stop category 1).
        Ss1,
        /// An SS1 of the whole machine on a fatal fault: only the main switch allows a restart.
        Ss1F,
        /// Torque off at once (stop category 0); never requested by the safe PLC (HFS-SS0-002).
        Ss0,
    }
}

impl Stop {
    /// The stop that a code of `PP_AxGrpStopReq` asks for, 0 to 4: none, SS2, SS1D, SS1, SS1F. No other code exists, and
    /// none for SS0 (HFS-API-018).
    pub const fn from_code(code: u8) -> Option<Self> {
        match code {
            0 => Some(Self::None),
            1 => Some(Self::Ss2),
            2 => Some(Self::Ss1D),
            3 => Some(Self::Ss1),
            4 => Some(Self::Ss1F),
            _ => None,
        }
    }

    /// The higher of two stops.
    #[must_use]
    pub const fn max(self, other: Self) -> Self {
        if self as u8 >= other as u8 {
            self
        } else {
            other
        }
    }
}

fields! {
    /// What the stop of a group is doing.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// No stop.
        #[default]
        Run,
        /// An SS2 waits for the groups of SMP610.
        Ss2Wait,
        /// An SS2 brakes along the contour.
        Ss2Brake,
        /// An SS1D waits for the groups of SMP610.
        Ss1DWait,
        /// Braking along the emergency ramp.
        EmergencyBrake,
        /// The drives stand, the brakes close before the torque goes (channel B).
        BrakeCloses,
        /// Torque off until a restart.
        TorqueOff,
    }
}

fields! {
    /// The monitoring state of an axis group (`PP_AxGrpStateReq`, `NN_AxGrpState`), in rising protection (HFS-STOP-006/a).
    ///
    /// SLS_2, SLS_3 and SLS_4 are limits of their own, which do not compare (see [`GroupState::strictness`]). The list puts the
    /// mode for everybody before those for the qualified: where one of two must be taken, it is SLS_2 before SLS_3 before SLS_4.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum GroupState {
        /// Doors closed: the speeds of the machine.
        Auto,
        /// Limited speed of SOM_4.
        Sls4,
        /// Limited speed of SOM_3.
        Sls3,
        /// Limited speed of SOM_2.
        Sls2,
        /// Restricted operation of a spindle: 50 rpm and two revolutions.
        SlsS,
        /// Safe operating stop: standstill under control.
        Sos,
        /// Torque off in operation: left with `PP_AxGrpActivate`.
        StoO,
        /// Torque off: left with a permission to switch the drives on only.
        #[default]
        Sto,
    }
}

impl GroupState {
    /// The state of a code of `PP_AxGrpStateReq`, 0 to 7 in rising protection; no other code exists.
    pub const fn from_code(code: u8) -> Option<Self> {
        match code {
            0 => Some(Self::Auto),
            1 => Some(Self::Sls4),
            2 => Some(Self::Sls3),
            3 => Some(Self::Sls2),
            4 => Some(Self::SlsS),
            5 => Some(Self::Sos),
            6 => Some(Self::StoO),
            7 => Some(Self::Sto),
            _ => None,
        }
    }

    /// The code of the state.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// Whether motion is permitted: the doors are closed, or the speed is limited.
    pub const fn is_released(self) -> bool {
        matches!(
            self,
            Self::Auto | Self::Sls4 | Self::Sls3 | Self::Sls2 | Self::SlsS
        )
    }

    /// Whether the speed is limited because a door is open: the limits of SOM_2 to SOM_4 or of restricted operation.
    pub const fn is_limited(self) -> bool {
        matches!(self, Self::Sls4 | Self::Sls3 | Self::Sls2 | Self::SlsS)
    }

    /// The one of two that comes later in [`GroupState::ALL`]: the stricter one.
    #[must_use]
    pub const fn stricter(self, other: Self) -> Self {
        if self as u8 >= other as u8 {
            self
        } else {
            other
        }
    }

    /// How strict the state is: STO > STO_O > SOS > SLS_S > SLS_2, SLS_3, SLS_4 > AUTO.
    pub const fn strictness(self) -> u8 {
        match self {
            Self::Auto => 0,
            Self::Sls4 | Self::Sls3 | Self::Sls2 => 1,
            Self::SlsS => 2,
            Self::Sos => 3,
            Self::StoO => 4,
            Self::Sto => 5,
        }
    }
}

fields! {
    /// The modes that a moving group has left for another one with limited speed: their limits apply beside that of the mode in
    /// force, until the group stands (HFS-AXG-018).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Left {
        /// The limit of SLS_2 applies.
        pub sls_2: bool,
        /// The limit of SLS_3 applies.
        pub sls_3: bool,
        /// The limit of SLS_4 applies.
        pub sls_4: bool,
    }
}

impl Left {
    /// None of them.
    pub const NONE: Self = Self {
        sls_2: false,
        sls_3: false,
        sls_4: false,
    };

    /// These, and the state that is left now.
    #[must_use]
    pub const fn and(self, state: GroupState) -> Self {
        Self {
            sls_2: self.sls_2 || matches!(state, GroupState::Sls2),
            sls_3: self.sls_3 || matches!(state, GroupState::Sls3),
            sls_4: self.sls_4 || matches!(state, GroupState::Sls4),
        }
    }

    /// Whether no limit is left over.
    pub const fn is_none(self) -> bool {
        !(self.sls_2 || self.sls_3 || self.sls_4)
    }

    /// Whether the limit of a state is among them.
    pub const fn has(self, state: GroupState) -> bool {
        match state {
            GroupState::Sls2 => self.sls_2,
            GroupState::Sls3 => self.sls_3,
            GroupState::Sls4 => self.sls_4,
            _ => false,
        }
    }
}

fields! {
    /// What an axis group consists of (MP100): all its axes are of one kind and in one working space (HFS-GRP-001).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Kind {
        /// NC axes.
        #[default]
        NcAxes,
        /// Spindles.
        Spindle,
        /// Auxiliary axes, such as those of a tool magazine.
        Auxiliary,
    }
}

fields! {
    /// A safe operating mode (`PP_GenSOM`).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Som {
        /// Automatic operation: no motion with the door open.
        #[default]
        Som1,
        /// Set-up.
        Som2,
        /// Manual intervention.
        Som3,
        /// Advanced intervention, where it is enabled (SMP560 bit 0).
        Som4,
    }
}

impl Som {
    /// The mode of a code of `PP_GenSOM`, 0 to 3; no other code exists.
    pub const fn from_code(code: u8) -> Option<Self> {
        match code {
            0 => Some(Self::Som1),
            1 => Some(Self::Som2),
            2 => Some(Self::Som3),
            3 => Some(Self::Som4),
            _ => None,
        }
    }
}

fields! {
    /// The machine operating mode as the kernel knows it (module 9144, mode 10).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Unit {
        /// By hand at the operating panel.
        #[default]
        Panel,
        /// Program run or positioning with MDI, at the operating panel.
        Program,
        /// By handwheel.
        Handwheel,
        /// Homing and testing of axes.
        Reference,
    }
}

impl Unit {
    /// Whether it is operated at the panel: by hand or by program.
    pub const fn at_panel(self) -> bool {
        matches!(self, Self::Panel | Self::Program)
    }
}
