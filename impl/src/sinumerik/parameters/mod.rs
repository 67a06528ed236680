//! The machine data of one axis as the user writes them, checked and converted into the configurations of the monitors.
//!
//! [`Parameters`] holds the values in integers (see [`Unit`]); its default is the manual's. [`Parameters::validate`] is
//! the only way to a [`Configuration`], so that a monitor of an axis never runs on values that the manual refuses. Both
//! channels get the same values: the range of a datum is the smaller one of the two channels, and the limits of alarm
//! 27033 for linear axes hold (S840D-PARAM-501 and following).

mod configuration;
mod datum;
mod error;
mod plausibility;

pub use configuration::Configuration;
pub use datum::{Datum, Permitted, Unit};
pub use error::{ParameterError, Rule};

use crate::kernel::ConfigError;
use crate::units::{Axis, ModuloRange};
use datum::Elements;

/// How many encoders measure the axis (S840D-ARCH-503/a).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoders {
    /// One, read by both channels.
    #[default]
    One,
    /// Two, one for each channel.
    Two,
}

/// The control module of the drive, as far as it limits the machine data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ControlModule {
    /// Standard 2 or Performance 1: encoders up to 300 kHz, no internal pulse cancellation (S840D-FREQ-003).
    #[default]
    Basic,
    /// Performance 2, High Standard or High Performance.
    High,
}

/// What the monitors must know of the axis beside its machine data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Installation {
    /// The encoders of the axis.
    pub encoders: Encoders,
    /// The control module of its drive.
    pub module: ControlModule,
    /// The pulses are cancelled over the drive bus (bit 30 of MD36986).
    pub internal_cancellation: bool,
    /// Output "enable pulses externally" and input "test stop external shutdown" are assigned (MD36984, MD36979).
    pub external_path: bool,
    /// The highest gear index with a real ratio, 0 to 7; 0 for an axis without selector gearbox (S840D-GEAR-501).
    pub gear_max: u8,
    /// How long a test of the shutdown paths counts, in us: a monitoring cycle to eight hours (S840D-TEST-001/a).
    pub test_interval: u64,
}

impl Installation {
    /// Eight hours in us.
    pub const EIGHT_HOURS: u64 = 28_800_000_000;
}

impl Default for Installation {
    /// One encoder, a basic module with direct pulse cancellation, no gearbox, a test every eight hours.
    fn default() -> Self {
        Self {
            encoders: Encoders::One,
            module: ControlModule::Basic,
            internal_cancellation: false,
            external_path: false,
            gear_max: 0,
            test_interval: Self::EIGHT_HOURS,
        }
    }
}

/// Declares the struct and, from the same list, what is permitted: the two cannot drift apart.
macro_rules! machine_data {
    ($(
        $(#[$doc:meta])+
        $number:literal $name:literal $field:ident: $type:ty = $default:expr,
            $permitted:expr, $unit:ident $(, linear up to $linear:expr)?;
    )+) => {
        /// The machine data of one axis, and those of the control that its monitoring reads. Lengths in um (rotary axes:
        /// 0.001 degrees), speeds in um/min (0.001 rev/min), times in us.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct Parameters {
            /// What is no machine datum.
            pub installation: Installation,
            $($(#[$doc])+ pub $field: $type,)+
        }

        impl Default for Parameters {
            /// The manual's default of every datum: no function is enabled.
            fn default() -> Self {
                Self { installation: Installation::default(), $($field: $default,)+ }
            }
        }

        /// Every machine datum of [`Parameters`], by number.
        pub const DATA: &[Datum] = &[$(
            Datum {
                number: $number,
                name: $name,
                unit: Unit::$unit,
                permitted: $permitted,
                linear_max: machine_data!(@linear $($linear)?),
                count: <$type as Elements>::COUNT,
                value: |parameters, index| parameters.$field.element(index),
            }
        ),+];
    };
    (@linear) => { None };
    (@linear $linear:expr) => { Some($linear) };
}

use Permitted::{Range, Values};

/// Places where position limits and cams may lie, in um or 0.001 degrees.
const POSITIONS: Permitted = Range(-2_147_000_000, 2_147_000_000);
/// Delays up to ten seconds, in ms.
const TEN_SECONDS: Permitted = Range(0, 10_000_000);
/// Delays up to a minute, in ms.
const ONE_MINUTE: Permitted = Range(0, 60_000_000);

machine_data! {
    /// Basic system clock in us (S840D-TIMING-501).
    10050 "SYSCLOCK_CYCLE_TIME" sysclock_cycle_time: u32 = 4_000, Range(125, 31_000), Microseconds;

    /// Position-control cycle in basic system clocks (S840D-TIMING-502).
    10060 "POSCTRL_SYSCLOCK_TIME_RATIO" posctrl_sysclock_time_ratio: u32 = 1, Range(1, 31), Number;

    /// Delay from a failure of the drive bus to pulse cancellation (S840D-BUSFAIL-701, S840D-MDBUS-001).
    10089 "SAFE_PULSE_DIS_TIME_BUSFAIL" pulse_dis_time_busfail: u32 = 0, Range(0, 800_000), Microseconds;

    /// Monitoring cycle T_SI in basic system clocks (S840D-TIMING-501, S840D-PARAM-003).
    10090 "SAFETY_SYSCLOCK_TIME_RATIO" safety_sysclock_time_ratio: u32 = 3, Range(1, 50), Number;

    /// Stop after an error of the safe logic: 3 STOP D, 4 STOP E (S840D-PARAM-505).
    10097 "SAFE_SPL_STOP_MODE" spl_stop_mode: u8 = 3, Values(&[3, 4]), Choice;

    /// Enabled functions, one bit each; see [`Parameters::enabled`] (S840D-PARAM-501, S840D-PARAM-005).
    36901 "SAFE_FUNCTION_ENABLE" function_enable: u32 = 0, Range(0, 0xFFFB), Bits;

    /// Rotary axis or spindle.
    36902 "SAFE_IS_ROT_AX" is_rot_ax: bool = false, Range(0, 1), Choice;

    /// Range of the actual value in which the cams of a rotary axis lie, in 0.001 degrees; 0: 2048 revolutions in each
    /// direction (S840D-SN-010).
    36905 "SAFE_MODULO_RANGE" modulo_range: u32 = 0, Range(0, 737_280_000), Angle;

    /// Linear scale instead of a rotary encoder (S840D-PARAM-006).
    36916 "SAFE_ENC_IS_LINEAR" enc_is_linear: bool = false, Range(0, 1), Choice;

    /// Grid spacing of a linear scale in nm (S840D-PARAM-006).
    36917 "SAFE_ENC_GRID_POINT_DIST" enc_grid_point_dist: u32 = 10_000, Range(10, 8_000_000), Grid;

    /// Pulses per revolution of a rotary encoder (S840D-PARAM-006).
    36918 "SAFE_ENC_RESOL" enc_resol: u32 = 2_048, Range(1, 100_000), Number;

    /// Pitch of the leadscrew in um per revolution (S840D-PARAM-006).
    36920 "SAFE_ENC_GEAR_PITCH" enc_gear_pitch: u32 = 10_000, Range(100, 8_388_000), Pitch;

    /// Gear stages 1 to 8: revolutions of the load (S840D-PARAM-007).
    36921 "SAFE_ENC_GEAR_DENOM" enc_gear_denom: [u32; 8] = [1; 8], Range(1, 8_388_607), Number;

    /// Gear stages 1 to 8: revolutions of the encoder (S840D-PARAM-007).
    36922 "SAFE_ENC_GEAR_NUMERA" enc_gear_numera: [u32; 8] = [1; 8], Range(1, 8_388_607), Number;

    /// Direction of the safe actual value: -1 reversed, 0 and 1 not (S840D-PARAM-006).
    36925 "SAFE_ENC_POLARITY" enc_polarity: i8 = 1, Values(&[-1, 0, 1]), Choice;

    /// Encoder frequency in Hz above which its amplitude is not monitored (S840D-PARAM-008, S840D-FREQ-003).
    36926 "SAFE_ENC_FREQ_LIMIT" enc_freq_limit: u32 = 300_000, Range(300_000, 420_000), Hertz;

    /// Position window of the safe operating stop (S840D-PARAM-009, S840D-SBH-001).
    36930 "SAFE_STANDSTILL_TOL" standstill_tol: u32 = 1_000, Range(1, 100_000), Length;

    /// Limits SG1 to SG4 (S840D-PARAM-010, S840D-SG-001).
    36931 "SAFE_VELO_LIMIT" velo_limit: [u32; 4] = [2_000_000; 4], Range(0, 1_000_000_000), Speed;

    /// Override factors of SG2 and SG4, selections 0 to 15 (S840D-PARAM-011, S840D-PARAM-740).
    36932 "SAFE_VELO_OVR_FACTOR" velo_ovr_factor: [u8; 16] = [100; 16], Range(1, 100), Percent;

    /// Setpoint limit as a part of the SG limit; 0: off (S840D-PARAM-012).
    36933 "SAFE_DES_VELO_LIMIT" des_velo_limit: u8 = 0, Range(0, 100), Percent;

    /// Upper limits of SE1 and SE2 (S840D-PARAM-013).
    36934 "SAFE_POS_LIMIT_PLUS" pos_limit_plus: [i32; 2] = [100_000_000; 2], POSITIONS, Length;

    /// Lower limits of SE1 and SE2 (S840D-PARAM-013).
    36935 "SAFE_POS_LIMIT_MINUS" pos_limit_minus: [i32; 2] = [-100_000_000; 2], POSITIONS, Length;

    /// Positions of the cams SN1+ to SN4+ (S840D-PARAM-014).
    36936 "SAFE_CAM_POS_PLUS" cam_pos_plus: [i32; 4] = [10_000; 4], POSITIONS, Length;

    /// Positions of the cams SN1- to SN4- (S840D-PARAM-014).
    36937 "SAFE_CAM_POS_MINUS" cam_pos_minus: [i32; 4] = [-10_000; 4], POSITIONS, Length;

    /// Distance within which the channels may see a cam differently (S840D-PARAM-014).
    36940 "SAFE_CAM_TOL" cam_tol: u32 = 100, Range(1, 10_000), Length;

    /// Tolerance of the comparison of the actual positions (S840D-PARAM-015, S840D-PARAM-715).
    36942 "SAFE_POS_TOL" pos_tol: u32 = 100, Range(1, 360_000), Length, linear up to 10_000;

    /// Tolerance between the position after referencing and the stored one (S840D-PARAM-016, S840D-PARAM-716).
    36944 "SAFE_REFP_POS_TOL" refp_pos_tol: u32 = 10, Range(0, 36_000), Length, linear up to 1_000;

    /// Threshold of the signal n<n_x; 0: off (S840D-PARAM-017, S840D-PARAM-728).
    36946 "SAFE_VELO_X" velo_x: u32 = 20_000, Range(0, 1_000_000), Speed, linear up to 1_000_000;

    /// Tolerance of the safe braking ramp (S840D-PARAM-018, S840D-PARAM-727).
    36948 "SAFE_STOP_VELO_TOL" stop_velo_tol: u32 = 300_000, Range(0, 20_000_000), Speed, linear up to 20_000_000;

    /// Speed difference tolerated between motor and load (S840D-SLIP-501, S840D-PARAM-729).
    36949 "SAFE_SLIP_VELO_TOL" slip_velo_tol: u32 = 6_000, Range(0, 1_000_000), Speed, linear up to 1_000_000;

    /// t_chg: tolerance time of the comparison after a change of an input signal (S840D-PARAM-019).
    36950 "SAFE_MODE_SWITCH_TIME" mode_switch_time: u32 = 500_000, TEN_SECONDS, Microseconds;

    /// t_vel: delay to a lower speed limit or to the safe operating stop (S840D-PARAM-020).
    36951 "SAFE_VELO_SWITCH_DELAY" velo_switch_delay: u32 = 100_000, ONE_MINUTE, Microseconds;

    /// t_C: from STOP C to the safe operating stop (S840D-PARAM-021).
    36952 "SAFE_STOP_SWITCH_TIME_C" stop_switch_time_c: u32 = 100_000, TEN_SECONDS, Microseconds;

    /// t_D: from STOP D to the safe operating stop (S840D-PARAM-021).
    36953 "SAFE_STOP_SWITCH_TIME_D" stop_switch_time_d: u32 = 100_000, ONE_MINUTE, Microseconds;

    /// t_E: from STOP E to the safe operating stop (S840D-PARAM-021).
    36954 "SAFE_STOP_SWITCH_TIME_E" stop_switch_time_e: u32 = 100_000, ONE_MINUTE, Microseconds;

    /// t_F: from STOP F to STOP B (S840D-PARAM-021); the NCK's default, which is copied to the drive.
    36955 "SAFE_STOP_SWITCH_TIME_F" stop_switch_time_f: u32 = 0, ONE_MINUTE, Microseconds;

    /// t_B: longest time from STOP B to STOP A (S840D-PARAM-021).
    36956 "SAFE_PULSE_DISABLE_DELAY" pulse_disable_delay: u32 = 100_000, TEN_SECONDS, Microseconds;

    /// t_chk: time for the feedback that the pulses are cancelled (S840D-PARAM-022).
    36957 "SAFE_PULSE_DIS_CHECK_TIME" pulse_dis_check_time: u32 = 100_000, TEN_SECONDS, Microseconds;

    /// Time limit of an acceptance test (S840D-PARAM-023/e); compared only.
    36958 "SAFE_ACCEPTANCE_TST_TIMEOUT" acceptance_tst_timeout: u32 = 40_000_000, Range(5_000_000, 100_000_000), Microseconds;

    /// Speed below which STOP B cancels the pulses before t_B has passed (S840D-PARAM-024, S840D-PARAM-726).
    36960 "SAFE_STANDSTILL_VELO_TOL" standstill_velo_tol: u32 = 0, Range(0, 1_000_000), Speed, linear up to 1_000_000;

    /// Stop when a speed limit is exceeded: 0 to 4 STOP A to E, 5 per stage, 10 to 14 as 0 to 4 with delayed reaction to a
    /// failure of the drive bus (S840D-PARAM-025, S840D-PARAM-735, S840D-STOP-087).
    36961 "SAFE_VELO_STOP_MODE" velo_stop_mode: u8 = 5, Values(&[0, 1, 2, 3, 4, 5, 10, 11, 12, 13, 14]), Choice;

    /// Stop when a safe limit position is passed: 2 to 4 STOP C to E (S840D-PARAM-026, S840D-STOP-087).
    36962 "SAFE_POS_STOP_MODE" pos_stop_mode: u8 = 2, Values(&[2, 3, 4]), Choice;

    /// Stop of the stages SG1 to SG4 with `velo_stop_mode` 5: 0 to 4 STOP A to E, 10 to 14 with delayed reaction to a
    /// failure of the drive bus (S840D-PARAM-025, S840D-PARAM-735, S840D-STOP-087).
    36963 "SAFE_VELO_STOP_REACTION" velo_stop_reaction: [u8; 4] = [2; 4], Values(&[0, 1, 2, 3, 4, 10, 11, 12, 13, 14]), Choice;

    /// Which other axes a stop of this axis acts on: 0 all of the channel, 1 those interpolating with it (S840D-PARAM-028,
    /// S840D-STOP-082).
    36964 "SAFE_IPO_STOP_GROUP" ipo_stop_group: u8 = 0, Values(&[0, 1]), Choice;

    /// No message 27000 / 300950 while parking is selected (S840D-REF-016).
    36965 "SAFE_PARK_ALARM_SUPPRESS" park_alarm_suppress: bool = false, Range(0, 1), Choice;
}

/// A function of the enable word: bit number and meaning of MD36901 / MD1301 (T-10; S840D-PARAM-501, S840D-PARAM-005).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Function {
    /// Safe operating stop and safely-reduced speed.
    SbhSg = 0,
    /// Safe software limit switches.
    Se = 1,
    /// Actual-value synchronisation of two encoders with slip.
    SlipSync = 3,
    /// External STOP E.
    StopE = 4,
    /// Override of the limits SG2 and SG4.
    Override = 5,
    /// External stops.
    ExternalStops = 6,
    /// Synchronisation of the cam signals of both channels.
    CamSync = 7,
}

/// Bits 8 to 15 of the enable word: the cams SN1+, SN1-, SN2+, ... SN4-.
const CAMS: u32 = 0xFF00;

impl Parameters {
    /// Whether a function is enabled.
    pub const fn enabled(&self, function: Function) -> bool {
        self.function_enable & (1 << function as u8) != 0
    }

    /// Whether a cam is enabled: 0 for SN1+, 1 for SN1-, 2 for SN2+ and so on to 7 for SN4-; false beyond.
    pub const fn cam_enabled(&self, cam: u8) -> bool {
        cam < 8 && self.function_enable & (1 << (8 + cam)) != 0
    }

    /// Whether limit switches or a cam are enabled, so that the safe position matters (S840D-REF-013).
    pub const fn se_sn_enabled(&self) -> bool {
        self.enabled(Function::Se) || self.function_enable & CAMS != 0
    }

    /// The position of a cam in the order of [`Parameters::cam_enabled`].
    pub(crate) fn cam_position(&self, cam: u8) -> i32 {
        let positions = if cam % 2 == 0 {
            &self.cam_pos_plus
        } else {
            &self.cam_pos_minus
        };
        positions.get(usize::from(cam / 2)).copied().unwrap_or(0)
    }

    /// Linear or rotary.
    pub const fn axis(&self) -> Axis {
        if self.is_rot_ax {
            Axis::Rotary
        } else {
            Axis::Linear
        }
    }

    /// The range in which the cams of the axis lie; none on a linear axis.
    fn modulo_range(&self) -> Result<ModuloRange, ConfigError> {
        match self.axis() {
            Axis::Linear => Ok(ModuloRange::LINEAR),
            Axis::Rotary => ModuloRange::from_degrees(self.modulo_range / 1000),
        }
    }

    /// The monitoring cycle T_SI in us (S840D-TIMING-501).
    pub const fn monitoring_cycle_us(&self) -> u64 {
        self.sysclock_cycle_time as u64 * self.safety_sysclock_time_ratio as u64
    }

    /// Checks every value and the plausibility of their combination, and converts them for the monitors.
    ///
    /// Limits, thresholds and tolerances are rounded down to whole increments, the interval of the tests and the time from a
    /// failure of the drive bus to the pulse cancellation down to whole cycles: by these a monitor never permits more than
    /// the machine datum. Two things it rounds up, so that what the machine datum names is granted whole: any other delay,
    /// by less than a cycle, during which the old state is tolerated that much longer; and the slip tolerated, by the dead band and less than an increment in a pass of the comparison (see `Clock::slip`).
    ///
    /// # Errors
    /// [`ParameterError`] with the machine datum, its value and what is permitted, the first found: ranges by number
    /// first, then the rules of alarm 27033.
    pub fn validate(&self) -> Result<Configuration, ParameterError> {
        for datum in DATA {
            let permitted = datum.permitted_on(self.axis());
            for index in 0..datum.count {
                let value = (datum.value)(self, index);
                if !permitted.contains(value) {
                    return Err(ParameterError::NotPermitted {
                        datum,
                        index,
                        value,
                        permitted,
                        axis: self.axis(),
                    });
                }
            }
        }
        plausibility::check(self)?;
        Configuration::convert(self)
    }
}
