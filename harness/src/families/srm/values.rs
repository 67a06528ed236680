//! The values of a machine file as the parameters of the blocks: mm, mm/min, ms.

use stillpoint_machine::{Axis, Machine, Settings};
use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::srm::interpolation::Curve;
use stillpoint_monitors::srm::{
    brake_test, endzone, load_calibration, load_monitor, safe_pos, sbr_monitor, slp_monitor,
};

use crate::families::values::cell;

/// The functions of an axis in a machine file, each a block.
pub(super) const SLP: &str = "SLP";
pub(super) const END_ZONE: &str = "end zone";
pub(super) const RAMP: &str = "ramp";
pub(super) const BRAKE_TEST: &str = "brake test";
pub(super) const LOAD: &str = "load";

/// The drive may take so long to report its selection, and to ask for the brake: times that the manual does not give (AMB-46).
const MONITORING_MS: i64 = 2_000;

/// A number of the blocks; the ranges of the family hold no other.
fn dint(value: i64) -> i32 {
    i32::try_from(value).unwrap_or(i32::MAX)
}

/// A time, length or velocity: the base units are thousandths.
fn whole(values: &Settings, name: &str) -> i32 {
    dint(cell(values, name, 0) / 1_000)
}

fn plain(values: &Settings, name: &str) -> i32 {
    dint(cell(values, name, 0))
}

/// A bit string of a block.
fn word(values: &Settings, name: &str) -> u16 {
    u16::try_from(cell(values, name, 0)).unwrap_or(u16::MAX)
}

/// T_SAMPLE, ms.
pub(super) fn t_sample(machine: &Machine) -> i32 {
    whole(&machine.control, "T_SAMPLE").max(1)
}

/// The places of CALL_ORDER.
pub(super) fn call_order(machine: &Machine) -> [i64; 6] {
    [0, 1, 2, 3, 4, 5].map(|k| cell(&machine.control, "CALL_ORDER", k))
}

/// A time in calls, rounded up.
fn calls(ms: i64, t_sample: i32) -> Cycles {
    let calls = ms
        .unsigned_abs()
        .div_ceil(u64::from(t_sample.unsigned_abs()));
    Cycles::new(u32::try_from(calls).unwrap_or(u32::MAX))
}

/// How many calls a parameter lasts, rounded up.
fn lasts(values: &Settings, name: &str, t_sample: i32) -> Cycles {
    calls(cell(values, name, 0) / 1_000, t_sample)
}

/// F_SAFE_POS.
pub(super) fn safe_pos(axis: &Axis, t_sample: i32) -> safe_pos::Config {
    let mm = |name| whole(&axis.values, name);
    safe_pos::Config {
        t_sample,
        pos_config: plain(&axis.values, "POS_CONFIG") != 0,
        possi_t_sample: mm("POSSI_T_SAMPLE"),
        pos_min: mm("POS_MIN"),
        pos_max: mm("POS_MAX"),
        pos_disc_window: mm("POS_DISC_WINDOW"),
        pos2_disc_window: mm("POS2_DISC_WINDOW"),
        possi_disc_window: mm("POSSI_DISC_WINDOW"),
        pos_startup_tol: mm("POS_STARTUP_TOL"),
        v_standstill: mm("V_STANDSTILL"),
        v_max: mm("V_MAX"),
        v_disc_window: mm("V_DISC_WINDOW"),
        v_sync_intervall: mm("V_SYNC_INTERVALL"),
        pos_reference: mm("POS_REFERENCE"),
        count_margin: Cycles::new(1),
        sync_pos2: safe_pos::SyncPos2::Keep,
        count_watch: safe_pos::CountWatch::Watch,
        err_react: Default::default(),
    }
}

/// F_SLP_MONITOR.
pub(super) fn slp(axis: &Axis) -> slp_monitor::Config {
    let mm = |name| whole(&axis.values, name);
    slp_monitor::Config {
        x_negative: mm("X_NEGATIVE"),
        x_positive: mm("X_POSITIVE"),
        vmax_release: mm("VMAX_RELEASE"),
        err_react: Default::default(),
    }
}

/// F_ENDZONE.
pub(super) fn endzone(axis: &Axis) -> endzone::Config {
    let point = |k| {
        let [x, v] = ["EZ_X", "EZ_V"].map(|name| dint(cell(&axis.values, name, k) / 1_000));
        (x, v)
    };
    let points: Vec<(i32, i32)> = (0..17).map(point).collect();
    endzone::Config {
        vmax_release: whole(&axis.values, "EZ_VMAX_RELEASE"),
        interpolation: Curve::of(&points),
        vinv_retract: endzone::VinvRetract::Stop,
        ez_dir: endzone::EzDir::Expire,
        err_react: Default::default(),
    }
}

/// The ends of the range, mm.
pub(super) fn ends(axis: &Axis) -> [i32; 2] {
    ["X_NEGATIVE", "X_POSITIVE"].map(|name| whole(&axis.values, name))
}

/// F_SBR_MONITOR.
pub(super) fn ramp(axis: &Axis, t_sample: i32) -> sbr_monitor::Config {
    let number = |name| whole(&axis.values, name);
    sbr_monitor::Config {
        t_sample,
        t_ramp: number("SBR_T_RAMP"),
        v_max: number("SBR_V_MAX"),
        v_stop_monitoring: number("SBR_V_STOP_MONITORING"),
        maxtol_v: number("SBR_MAXTOL_V"),
        maxtol_pos: number("SBR_MAXTOL_POS"),
        sbr_pos: sbr_monitor::SbrPos::Cum,
        sbr_retrig: sbr_monitor::SbrRetrig::Ignore,
        err_react: Default::default(),
    }
}

/// The deceleration of that ramp, um/s2; none where it has no time.
pub(super) fn ramp_rate(axis: &Axis) -> Option<i64> {
    let [speed, time] = ["SBR_V_MAX", "SBR_T_RAMP"].map(|name| cell(&axis.values, name, 0));
    // um/min and us.
    let rate = i128::from(speed) * 1_000_000 / 60 / i128::from((time > 0).then_some(time)?);
    i64::try_from(rate).ok().filter(|rate| *rate > 0)
}

/// F_BRAKE_TEST.
pub(super) fn brake_test(axis: &Axis, t_sample: i32) -> brake_test::Config {
    let values = &axis.values;
    let number = |name| whole(values, name);
    brake_test::Config {
        t_interval: lasts(values, "BT_T_INTERVAL", t_sample),
        t_sample,
        sequence_br_1: word(values, "BT_SEQUENCE_BR_1"),
        t_open_br_1: number("BT_T_OPEN_BR_1"),
        t_close_br_1: number("BT_T_CLOSE_BR_1"),
        sequence_br_2: word(values, "BT_SEQUENCE_BR_2"),
        t_open_br_2: number("BT_T_OPEN_BR_2"),
        t_close_br_2: number("BT_T_CLOSE_BR_2"),
        pos_tolerance: number("BT_POS_TOLERANCE"),
        vmax_release: number("BT_VMAX_RELEASE"),
        t_mon_sel: calls(MONITORING_MS, t_sample),
        t_mon_req: calls(MONITORING_MS, t_sample),
        unproven: brake_test::Unproven::Restricted,
        sbt_fresh: brake_test::SbtFresh::Fresh,
        err_react: Default::default(),
    }
}

/// F_LOAD_MONITOR: its monitoring.
pub(super) fn load(axis: &Axis, t_sample: i32) -> load_monitor::Config {
    let share = |name| plain(&axis.values, name);
    load_monitor::Config {
        maxtol_load: share("LOAD_MAXTOL_LOAD"),
        maxload_dyn: share("LOAD_MAXLOAD_DYN"),
        maxload_stat: share("LOAD_MAXLOAD_STAT"),
        minload: share("LOAD_MINLOAD"),
        vmax_release: whole(&axis.values, "LOAD_VMAX_RELEASE"),
        cal_value: share("LOAD_CAL_VALUE"),
        maxtol_cal: share("LOAD_MAXTOL_CAL"),
        t_sample,
        t_test: whole(&axis.values, "LOAD_T_TEST"),
        t_settle: whole(&axis.values, "LOAD_T_SETTLE"),
        err_react: Default::default(),
    }
}

/// F_LOAD_MONITOR: the test of the measurement.
pub(super) fn calibration(axis: &Axis, t_sample: i32) -> load_calibration::Config {
    let load = load(axis, t_sample);
    load_calibration::Config {
        t_interval: lasts(&axis.values, "LOAD_T_INTERVAL", t_sample),
        t_sample,
        t_test: load.t_test,
        t_settle: load.t_settle,
        cal_value: load.cal_value,
        maxtol_cal: load.maxtol_cal,
        cal_mode: plain(&axis.values, "LOAD_CAL_MODE") != 0,
        wrong_elsewhere: load.parameter_bits() != 0,
    }
}
