//! Where the signals of an axis come from and go to: the data block of the drive channel, the terminals of the NCK.
//!
//! Every axis has its signals twice, once in each channel, over different ways (S840D-IO-001). The drive channel reads and
//! writes the axis's data block DB31 and following ([`Sge::read`], [`Sga::write`]); the NCK reads an input as its machine
//! datum assigns it ([`Input`]) and ANDs the outputs of several axes ([`and`]), the cams among them (S840D-SN-012). A signal that is not supplied has its
//! fail-safe level 0 (S840D-ARCH-504, S840D-IO-002): the default of [`Sge`] and [`Sga`].

/// Bytes of the data block up to the last one used here.
pub const BLOCK: usize = 112;

/// The place of a signal in the data block of an axis, where the program of the PLC supplies it or reads it (S840D-SPL-004).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The signal as the specification names it.
    pub id: &'static str,
    /// The byte, 0 to 111.
    pub byte: u8,
    /// The bit, 0 to 7.
    pub bit: u8,
}

macro_rules! signals {
    ($(#[doc = $text:literal])+ $name:ident, $places:ident, $list:literal {
        $($(#[doc = $meaning:literal])+ $field:ident = $id:literal at $byte:literal $bit:literal;)+
    }) => {
        $(#[doc = $text])+
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name {
            $($(#[doc = $meaning])+ pub $field: bool,)+
        }

        #[doc = $list]
        pub const $places: &[Place] = &[$(Place { id: $id, byte: $byte, bit: $bit }),+];

        impl $name {
            /// The signals as they stand in a data block (S840D-IO-007).
            pub const fn read(block: &[u8; BLOCK]) -> Self {
                Self { $($field: block[$byte] >> $bit & 1 == 1),+ }
            }

            /// Writes the signals into a data block; all other bits keep their value (S840D-IO-007).
            pub const fn write(&self, block: &mut [u8; BLOCK]) {
                $(block[$byte] = block[$byte] & !(1 << $bit) | (self.$field as u8) << $bit;)+
            }
        }
    };
}

signals! {
    /// Input signals of an axis in the drive channel (S840D-IO-001, S840D-SIGNAL-001). 0 is the fail-safe level of the de-selecting ones.
    Sge, SGE, "Places of [`Sge`], in the order of its fields (S840D-IO-007)." {
        /// SBH/SG de-selection.
        sbh_sg_off = "SGE_SVSS_DISABLE" at 22 0;
        /// SBH de-selection.
        sbh_off = "SGE_SS_DISABLE" at 22 1;
        /// SG selection, bit 0.
        sg_0 = "SGE_VELO_SELECT_0" at 22 3;
        /// SG selection, bit 1.
        sg_1 = "SGE_VELO_SELECT_1" at 22 4;
        /// Gear ratio selection, bit 0.
        gear_0 = "SGE_GEAR_SELECT_0" at 23 0;
        /// Gear ratio selection, bit 1.
        gear_1 = "SGE_GEAR_SELECT_1" at 23 1;
        /// Gear ratio selection, bit 2.
        gear_2 = "SGE_GEAR_SELECT_2" at 23 2;
        /// SE selection: 0 SE1, 1 SE2.
        se = "SGE_POS_SELECT" at 23 4;
        /// Test stop selection: 1 selects.
        test_stop = "SGE_STOP_REQUEST" at 23 7;
        /// De-select external STOP A.
        stop_a_off = "SGE_EXT_STOP_A" at 32 2;
        /// De-select external STOP C.
        stop_c_off = "SGE_EXT_STOP_C" at 32 3;
        /// De-select external STOP D.
        stop_d_off = "SGE_EXT_STOP_D" at 32 4;
        /// De-select external STOP E.
        stop_e_off = "SGE_EXT_STOP_E" at 32 5;
        /// SG override, bit 0.
        override_0 = "SGE_OVR_0" at 33 4;
        /// SG override, bit 1.
        override_1 = "SGE_OVR_1" at 33 5;
        /// SG override, bit 2.
        override_2 = "SGE_OVR_2" at 33 6;
        /// SG override, bit 3.
        override_3 = "SGE_OVR_3" at 33 7;
    }
}

signals! {
    /// Output signals of an axis in the drive channel (S840D-IO-001, S840D-SN-012, S840D-SIGNAL-002, S840D-SIGNAL-016, S840D-SIGNAL-024, S840D-CAM-703). Of the cams the manual gives two orders; this is the one of its table
    /// 6-5, [`Sga::with_cams_exchanged`] makes the other one.
    Sga, SGA, "Places of [`Sga`], in the order of its fields (S840D-IO-007)." {
        /// SBH/SG active.
        sbh_sg_active = "SGA_SVSS_STATUS" at 108 0;
        /// Status pulses cancelled.
        pulses_cancelled = "SGA_PULSE_STATUS" at 108 2;
        /// Axis safely referenced.
        safely_referenced = "SGA_REFP_STATUS" at 108 7;
        /// SN1+.
        sn_1_plus = "SGA_SN1_PLUS" at 109 0;
        /// SN1-.
        sn_1_minus = "SGA_SN1_MINUS" at 109 1;
        /// SN2+.
        sn_2_plus = "SGA_SN2_PLUS" at 109 2;
        /// SN2-.
        sn_2_minus = "SGA_SN2_MINUS" at 109 3;
        /// SN3+.
        sn_3_plus = "SGA_SN3_PLUS" at 109 4;
        /// SN3-.
        sn_3_minus = "SGA_SN3_MINUS" at 109 5;
        /// SN4+.
        sn_4_plus = "SGA_SN4_PLUS" at 109 6;
        /// SN4-.
        sn_4_minus = "SGA_SN4_MINUS" at 109 7;
        /// SBH active.
        sbh_active = "SGA_SS_STATUS" at 110 1;
        /// SG active, bit 0.
        sg_active_0 = "SGA_VELO_STATUS_0" at 110 3;
        /// SG active, bit 1.
        sg_active_1 = "SGA_VELO_STATUS_1" at 110 4;
        /// n < n_x.
        below_n_x = "SGA_VELO_X" at 110 5;
        /// STOP A or B is active.
        stop_ab = "SGA_STOP_AB" at 111 4;
        /// STOP C is active.
        stop_c = "SGA_STOP_C" at 111 5;
        /// STOP D is active.
        stop_d = "SGA_STOP_D" at 111 6;
        /// STOP E is active.
        stop_e = "SGA_STOP_E" at 111 7;
    }
}

impl Sge {
    /// An axis that uses none of its signals: 0, except that external stops are not requested (S840D-IO-002, S840D-EXT-004, S840D-SIGNAL-023, S840D-SIGNAL-027/a).
    pub const UNUSED: Self = Self {
        stop_a_off: true,
        stop_c_off: true,
        stop_d_off: true,
        stop_e_off: true,
        ..Self::read(&[0; BLOCK])
    };
}

impl Sga {
    /// The same signals for a control that has each minus cam before its plus cam, as the application example of the manual
    /// does (S840D-IO-007). Which order holds has to be tried at the machine.
    pub const fn with_cams_exchanged(self) -> Self {
        Self {
            sn_1_plus: self.sn_1_minus,
            sn_1_minus: self.sn_1_plus,
            sn_2_plus: self.sn_2_minus,
            sn_2_minus: self.sn_2_plus,
            sn_3_plus: self.sn_3_minus,
            sn_3_minus: self.sn_3_plus,
            sn_4_plus: self.sn_4_minus,
            sn_4_minus: self.sn_4_plus,
            ..self
        }
    }
}

/// The assignment of an input signal of the NCK channel by its machine datum (MD36970 to MD36979). One input may feed the
/// same signal of several axes (S840D-IO-004, S840D-SPL-003): each axis has its own assignment of it. What is named may be a terminal or
/// a signal of the safe logic, also one that the logic makes of an output of the axis itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Input(u32);

impl Input {
    const INVERTED: u32 = 0x8000_0000;

    /// Not assigned, constant 0: the default of the manual (S840D-IO-002).
    pub const ZERO: Self = Self(0);

    /// Not assigned, constant 1: an unused external stop (S840D-EXT-004).
    pub const ONE: Self = Self(Self::INVERTED);

    /// The assignment that a machine datum holds. Whether its terminal exists is not judged here.
    pub const fn new(machine_datum: u32) -> Self {
        Self(machine_datum)
    }

    /// Whether a terminal or a bit of the safe logic is named.
    pub const fn is_assigned(self) -> bool {
        self.0 & !Self::INVERTED != 0
    }

    /// The signal, from the level of the terminal: inverted by bit 31 (S840D-IO-005); without terminal the constant.
    pub const fn signal(self, terminal: bool) -> bool {
        (terminal && self.is_assigned()) != (self.0 & Self::INVERTED != 0)
    }
}

fields! {
    /// One output signal of an axis on its way to an NCK output.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Contribution {
        /// The signal.
        pub signal: bool,
        /// Bit 31 of its machine datum: invert before the AND.
        pub inverted: bool,
    }
}

/// The level of an NCK output to which the signals of several axes are assigned: each inverted if so assigned, then
/// ANDed (S840D-IO-004, S840D-SPL-003). So a test of the external shutdown asked for at one axis cancels the pulses of every axis on the
/// output (S840D-TEST-018). An output without signals is 0, the fail-safe level.
pub fn and(contributions: &[Contribution]) -> bool {
    !contributions.is_empty() && contributions.iter().all(|c| c.signal != c.inverted)
}
