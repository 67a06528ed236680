//! The axes of a machine file on the production monitors: machine data in the units of the monitors, checked by them.

use stillpoint_machine::{Axis, AxisKind, Machine};
use stillpoint_monitors::sinumerik::parameters::{
    Configuration, ControlModule, Encoders, Installation, Parameters,
};

/// The enable bits of the functions, by their names in a machine file (MD36901 / MD1301).
pub const FUNCTIONS: [(&str, u32); 15] = [
    ("SBH/SG", 0),
    ("SE", 1),
    ("slip sync", 3),
    ("STOP E", 4),
    ("override", 5),
    ("external stops", 6),
    ("cam sync", 7),
    ("SN1+", 8),
    ("SN1-", 9),
    ("SN2+", 10),
    ("SN2-", 11),
    ("SN3+", 12),
    ("SN3-", 13),
    ("SN4+", 14),
    ("SN4-", 15),
];

/// An axis for the monitors.
#[derive(Debug, Clone)]
pub struct Produced {
    /// Its name.
    pub name: String,
    /// Its machine data.
    pub parameters: Parameters,
    /// What both channels run with.
    pub configuration: Configuration,
}

/// The axes of a machine, in the order of the file.
///
/// # Errors
/// A sentence: the monitors refuse a value.
pub fn axes(machine: &Machine) -> Result<Vec<Produced>, String> {
    machine
        .axes
        .iter()
        .map(|axis| produce(machine, axis))
        .collect()
}

fn produce(machine: &Machine, axis: &Axis) -> Result<Produced, String> {
    let values = Values { machine, axis };
    let parameters = values.parameters().map_err(|name| {
        format!(
            "axis {}: the value of {name} does not fit the monitors",
            axis.name
        )
    })?;
    let configuration = parameters.validate().map_err(|error| {
        format!(
            "axis {}: the monitors refuse this configuration: {error}",
            axis.name
        )
    })?;
    Ok(Produced {
        name: axis.name.clone(),
        parameters,
        configuration,
    })
}

struct Values<'a> {
    machine: &'a Machine,
    axis: &'a Axis,
}

/// A value, or the name of the parameter whose value does not fit.
type Fit<T> = Result<T, &'static str>;

impl Values<'_> {
    fn cells(&self, name: &'static str) -> &[i64] {
        let of = |settings: &'_ stillpoint_machine::Settings| settings.contains_key(name);
        let settings = match of(&self.axis.values) {
            true => &self.axis.values,
            false => &self.machine.control,
        };
        settings.get(name).map_or(&[], |setting| &setting.cells)
    }

    fn cell(&self, name: &'static str) -> Fit<i64> {
        self.cells(name).first().copied().ok_or(name)
    }

    fn array<T: TryFrom<i64> + Copy + Default, const N: usize>(
        &self,
        name: &'static str,
        scale: impl Fn(i64) -> i64,
    ) -> Fit<[T; N]> {
        let mut out = [T::default(); N];
        let cells = self.cells(name);
        for (k, place) in out.iter_mut().enumerate() {
            let cell = cells.get(k).ok_or(name)?;
            *place = T::try_from(scale(*cell)).map_err(|_| name)?;
        }
        Ok(out)
    }

    fn plain<T: TryFrom<i64>>(&self, name: &'static str) -> Fit<T> {
        T::try_from(self.cell(name)?).map_err(|_| name)
    }

    /// From the base unit of speeds, um/min or mdeg/min, to um/min or 0.001 rev/min, rounded down: a limit never permits
    /// more. Exact for a value in rev/min with three decimals; one that is written in deg/s may lose what is less than an
    /// increment in a cycle.
    fn speed_scale(&self) -> impl Fn(i64) -> i64 + use<> {
        let per_unit = self.speed_unit();
        move |value| value.div_euclid(per_unit)
    }

    const fn speed_unit(&self) -> i64 {
        match self.axis.kind {
            AxisKind::Linear => 1,
            AxisKind::Rotary => 360,
        }
    }

    fn speed(&self, name: &'static str) -> Fit<u32> {
        u32::try_from(self.speed_scale()(self.cell(name)?)).map_err(|_| name)
    }

    /// A tolerated speed, rounded up: what the machine datum names is tolerated.
    fn speed_up(&self, name: &'static str) -> Fit<u32> {
        let (value, per_unit) = (self.cell(name)?, self.speed_unit());
        let up = value.div_euclid(per_unit) + i64::from(value.rem_euclid(per_unit) != 0);
        u32::try_from(up).map_err(|_| name)
    }

    fn is(&self, name: &'static str) -> bool {
        self.cell(name).is_ok_and(|value| value != 0)
    }

    fn enable_word(&self) -> u32 {
        FUNCTIONS
            .iter()
            .filter(|(name, _)| self.axis.has(name))
            .map(|(_, bit)| 1 << bit)
            .sum()
    }

    /// The shortest interval of the doors in front of the axis, in us.
    fn test_interval(&self) -> u64 {
        let doors = self.machine.doors.iter();
        let behind = doors.filter(|d| d.axes.iter().any(|a| *a.get_ref() == self.axis.name));
        let intervals =
            behind.filter_map(|d| d.values.get("test_interval")?.cells.first().copied());
        let least = intervals.min().and_then(|us| u64::try_from(us).ok());
        least.unwrap_or(Installation::EIGHT_HOURS)
    }

    fn installation(&self) -> Installation {
        let high = self.cell("CONTROL_MODULE").is_ok_and(|module| module >= 3);
        let ratios = |name| self.cells(name).iter().skip(1).any(|n| *n != 1);
        let gearbox = ratios("ENC_GEAR_DENOM") || ratios("ENC_GEAR_NUMERA");
        Installation {
            encoders: match self.is("LOAD_ENCODER") {
                true => Encoders::Two,
                false => Encoders::One,
            },
            module: match high {
                true => ControlModule::High,
                false => ControlModule::Basic,
            },
            internal_cancellation: self.is("INTERNAL_PULSE_CANCELLATION"),
            external_path: self.is("EXT_PULSE_ENABLE_ASSIGNED")
                && self.is("EXT_PULSE_TEST_ASSIGNED"),
            gear_max: if gearbox { 7 } else { 0 },
            test_interval: self.test_interval(),
        }
    }

    fn parameters(&self) -> Fit<Parameters> {
        let same = |value| value;
        Ok(Parameters {
            installation: self.installation(),
            sysclock_cycle_time: self.plain("SYSCLOCK_CYCLE_TIME")?,
            posctrl_sysclock_time_ratio: self.plain("POSCTRL_SYSCLOCK_TIME_RATIO")?,
            safety_sysclock_time_ratio: self.plain("SAFETY_SYSCLOCK_TIME_RATIO")?,
            spl_stop_mode: self.plain("SAFE_SPL_STOP_MODE")?,
            pulse_dis_time_busfail: self.plain("SAFE_PULSE_DIS_TIME_BUSFAIL")?,
            function_enable: self.enable_word(),
            is_rot_ax: self.axis.kind == AxisKind::Rotary,
            modulo_range: self.plain("MODULO_RANGE")?,
            enc_is_linear: self.is("ENC_IS_LINEAR"),
            // From 10 nm to 1 nm.
            enc_grid_point_dist: u32::try_from(
                self.cell("ENC_GRID_POINT_DIST")?.saturating_mul(10),
            )
            .map_err(|_| "ENC_GRID_POINT_DIST")?,
            enc_resol: self.plain("ENC_RESOL")?,
            enc_gear_pitch: self.plain("ENC_GEAR_PITCH")?,
            enc_gear_denom: self.array("ENC_GEAR_DENOM", same)?,
            enc_gear_numera: self.array("ENC_GEAR_NUMERA", same)?,
            enc_polarity: self.plain("ENC_POLARITY")?,
            enc_freq_limit: self.plain("ENC_FREQ_LIMIT")?,
            standstill_tol: self.plain("STANDSTILL_TOL")?,
            velo_limit: self.array("VELO_LIMIT", self.speed_scale())?,
            velo_ovr_factor: self.array("VELO_OVR_FACTOR", same)?,
            des_velo_limit: self.plain("DES_VELO_LIMIT")?,
            pos_limit_plus: self.array("POS_LIMIT_PLUS", same)?,
            pos_limit_minus: self.array("POS_LIMIT_MINUS", same)?,
            cam_pos_plus: self.array("CAM_POS_PLUS", same)?,
            cam_pos_minus: self.array("CAM_POS_MINUS", same)?,
            cam_tol: self.plain("CAM_TOL")?,
            pos_tol: self.plain("POS_TOL")?,
            refp_pos_tol: self.plain("REFP_POS_TOL")?,
            velo_x: self.speed("VELO_X")?,
            stop_velo_tol: self.speed("STOP_VELO_TOL")?,
            slip_velo_tol: self.speed_up("SLIP_VELO_TOL")?,
            mode_switch_time: self.plain("MODE_SWITCH_TIME")?,
            velo_switch_delay: self.plain("VELO_SWITCH_DELAY")?,
            stop_switch_time_c: self.plain("STOP_SWITCH_TIME_C")?,
            stop_switch_time_d: self.plain("STOP_SWITCH_TIME_D")?,
            stop_switch_time_e: self.plain("STOP_SWITCH_TIME_E")?,
            stop_switch_time_f: self.plain("STOP_SWITCH_TIME_F")?,
            pulse_disable_delay: self.plain("PULSE_DISABLE_DELAY")?,
            pulse_dis_check_time: self.plain("PULSE_DIS_CHECK_TIME")?,
            standstill_velo_tol: self.speed("STANDSTILL_VELO_TOL")?,
            velo_stop_mode: self.plain("VELO_STOP_MODE")?,
            pos_stop_mode: self.plain("POS_STOP_MODE")?,
            velo_stop_reaction: self.array("VELO_STOP_REACTION", same)?,
            ipo_stop_group: self.plain("IPO_STOP_GROUP")?,
            park_alarm_suppress: self.is("PARK_ALARM_SUPPRESS"),
            ..Parameters::default()
        })
    }
}
