//! The values of a machine file in the units of the monitors, checked by them: increments, cycles, increments per cycle.

mod extended;
mod service;

use std::num::NonZeroU32;

use stillpoint_machine::{Axis, Machine, Settings};
use stillpoint_monitors::kernel::{Cycles, Distance, Position, Speed};
use stillpoint_monitors::sinamics::control_path::ControlPath;
use stillpoint_monitors::sinamics::types::Stop;
use stillpoint_monitors::sinamics::{
    acceptance_mode, acknowledgement, actual_value, basic_selection, basic_stop, brake_test,
    brake_test_request, communication, cross_check, drive_test, encoderless, gear, path_test,
    reference, safe_position, sam, sbc, sbr, sdi, setpoint_limit, slp, sls, sls_ramp, sos, ss1,
    ss1_basic, ss2, ssm, start_phase, sto, stop_arbiter, terminal_pair,
};

use self::service::MEASURING_US;
use crate::families::values::{Fit, cell, fit, nearest};

/// Functions of an axis in a machine file.
pub(super) const MOTION: &str = "motion monitoring";
pub(super) const SLP: &str = "SLP";
pub(super) const SDI: &str = "SDI";
pub(super) const SBC: &str = "SBC";
pub(super) const SBT: &str = "SBT";
pub(super) const SP: &str = "SP";
pub(super) const GEAR: &str = "gear";
pub(super) const SS2E: &str = "SS2E";
pub(super) const BY_TELEGRAM: &str = "SLS limit by telegram";

/// For so many cycles the results of the channels may differ: one hears of the other a cycle later.
const APART: Cycles = Cycles::new(3);

/// What the monitors of an axis run with.
#[derive(Clone)]
pub(super) struct Values {
    /// Cycles of the Basic Functions in one of p9500.
    pub basic_cycles: u32,
    pub selection: basic_selection::Config,
    pub terminals: Option<terminal_pair::Config>,
    pub ss1_basic: ss1_basic::Config,
    pub basic_stop: basic_stop::Config,
    pub sto: sto::Config,
    pub sbc: Option<sbc::Config>,
    pub communication: Option<communication::Config>,
    pub acknowledgement: acknowledgement::Config,
    pub path_test: Option<path_test::Config>,
    pub drive_test: Option<drive_test::Config>,
    pub brake_test: Option<brake_test::Config>,
    pub test_request: brake_test_request::Config,
    /// p10208 of both brakes, in cycles.
    pub test_ramps: [u32; 2],
    /// The greatest speed during the brake test, and the cycles in which the load is measured.
    pub slow: Speed,
    pub measuring: u32,
    pub extended: Option<Extended>,
}

/// The same for the Extended Functions.
#[derive(Clone)]
pub(super) struct Extended {
    /// None where p9558 is 0: the mode never begins.
    pub acceptance: Option<acceptance_mode::Config>,
    pub check: cross_check::Config,
    pub arbiter: stop_arbiter::Config,
    pub ss1: ss1::Config,
    /// None without encoder.
    pub ss2: Option<ss2::Config>,
    pub sos: sos::Config,
    pub sls: sls::Config,
    /// In its place where a ramp leads to a limit.
    pub sls_ramp: Option<sls_ramp::Config>,
    pub reference: Option<reference::Config>,
    pub gear: Option<gear::Config>,
    pub position: Option<safe_position::Config>,
    /// Without encoder.
    /// The last: a function without selection is monitored.
    pub bare: Option<(start_phase::Config, encoderless::Config, bool)>,
    /// SLS and SDI, positive and negative, are monitored without selection.
    pub unselected: [bool; 3],
    /// p9516.4: the stop of a failed encoder.
    pub encoder_stop: Stop,
    /// p9563 by level: its code.
    pub sls_codes: [i64; 4],
    /// Positive and negative.
    pub sdi: Option<[sdi::Config; 2]>,
    /// p9566: its code.
    pub sdi_code: i64,
    pub slp: Option<slp::Config>,
    /// p9562 by range: its code.
    pub slp_codes: [i64; 2],
    pub ssm: ssm::Config,
    pub braking: BrakingMonitor,
    pub actual: actual_value::Config,
    /// None with p9533 = 0: r9733 would leave nothing, so nobody has wired it.
    pub setpoint: Option<setpoint_limit::Config>,
    /// p9560.
    pub shutdown: Speed,
    /// p9531.
    pub limits: [Speed; 4],
}

/// What monitors braking, by p9506.
#[derive(Clone)]
pub(super) enum BrakingMonitor {
    Sam(sam::Config),
    Sbr(sbr::Config),
}

/// p9500 in us.
pub(super) fn cycle_us(machine: &Machine) -> u32 {
    u32::try_from(machine.monitoring_cycle).unwrap_or(1).max(1)
}

/// Whether p9601 enables something; the choices of the family are those of the manual.
pub(super) fn enables(axis: &Axis, path: fn(ControlPath) -> bool) -> bool {
    let code = u32::try_from(cell(&axis.values, "p9601", 0)).unwrap_or(0);
    ControlPath::new(code).is_ok_and(path)
}

/// Its Extended Functions are enabled.
pub(super) fn extended(axis: &Axis) -> bool {
    enables(axis, ControlPath::extended) && axis.has(MOTION)
}

/// It has an encoder: p9506 is even.
pub(super) fn encoder(axis: &Axis) -> bool {
    cell(&axis.values, "p9506", 0) % 2 == 0
}

/// SLP is enabled.
pub(super) fn slp(axis: &Axis) -> bool {
    extended(axis) && axis.has(SLP)
}

/// Something asks for the reference: SLP, or the transfer of an absolute position.
pub(super) fn referenced(axis: &Axis) -> bool {
    slp(axis) || extended(axis) && axis.has(SP) && axis.has("absolute position")
}

/// A TM54F selects its functions.
pub(super) fn tm54f(axis: &Axis) -> bool {
    let path = enables(axis, ControlPath::inputs) && !enables(axis, ControlPath::profisafe);
    path && cell(&axis.values, "p10011", 0) > 0
}

/// The kind of a brake: p10202.
fn brake(axis: &Axis, place: usize) -> brake_test::Kind {
    match cell(&axis.values, "p10202", place) {
        1 => brake_test::Kind::Motor,
        2 => brake_test::Kind::External,
        _ => brake_test::Kind::None,
    }
}

/// One of its brakes is an external one that is tested.
pub(super) fn external_brake(axis: &Axis) -> bool {
    axis.has(SBT)
        && [0, 1]
            .iter()
            .any(|k| brake(axis, *k) == brake_test::Kind::External)
}

/// Something selects its functions bit by bit: PROFIsafe or F-DIs.
pub(super) fn bits(axis: &Axis) -> bool {
    enables(axis, ControlPath::profisafe) || enables(axis, ControlPath::inputs)
}

/// What the monitors of every axis run with.
pub(super) fn axes(machine: &Machine) -> Fit<Vec<Values>> {
    let of_axis = |axis: &Axis| {
        let reader = Reader { machine, axis };
        reader
            .all()
            .map_err(|error| format!("axis {}: {error}", axis.name))
    };
    machine.axes.iter().map(of_axis).collect()
}

/// The brake closes or opens in so many cycles: p1217.
pub(super) fn brake_cycles(machine: &Machine, axis: &Axis) -> u32 {
    let us = u32::try_from(cell(&axis.values, "p1217", 0)).unwrap_or(0);
    us.div_ceil(cycle_us(machine))
}

/// Cycles from the contact of a door to the input of the drive.
pub(super) fn door_cycles(machine: &Machine, door: &Settings) -> u32 {
    let us = u32::try_from(cell(door, "signal", 0)).unwrap_or(0);
    us.div_ceil(cycle_us(machine))
}

/// The fastest limit of SLS, from which the OFF3 ramp brakes in p1135: base units per minute.
pub(super) fn fastest(axis: &Axis) -> i64 {
    let levels = 0..4;
    let speeds = levels.map(|k| cell(&axis.values, "p9531", k));
    speeds.max().unwrap_or(0)
}

struct Reader<'a> {
    machine: &'a Machine,
    axis: &'a Axis,
}

impl Reader<'_> {
    fn cell(&self, name: &str) -> i64 {
        cell(&self.axis.values, name, 0)
    }

    fn is(&self, name: &str) -> bool {
        self.cell(name) != 0
    }

    /// A time in cycles of so many us, rounded up.
    fn cycles(us: i64, cycle: u32) -> Cycles {
        let count = us.unsigned_abs().div_ceil(u64::from(cycle.max(1)));
        Cycles::new(u32::try_from(count).unwrap_or(u32::MAX))
    }

    /// A time in cycles of p9500.
    fn time(&self, name: &str) -> Cycles {
        Self::cycles(self.cell(name), cycle_us(self.machine))
    }

    fn cycles_of(&self, name: &str, place: usize) -> Cycles {
        let us = cell(&self.axis.values, name, place);
        Self::cycles(us, cycle_us(self.machine))
    }

    /// A speed in increments per cycle, rounded down.
    fn speed(&self, name: &str, place: usize) -> Speed {
        self.speed_of(cell(&self.axis.values, name, place))
    }

    fn speed_of(&self, per_minute: i64) -> Speed {
        let per_minute = i128::from(per_minute);
        let product = per_minute * i128::from(cycle_us(self.machine)) / 60_000_000;
        Speed(u32::try_from(product).unwrap_or(u32::MAX))
    }

    /// A time that must not be exceeded, in cycles: rounded down.
    fn within(&self, us: u32) -> Cycles {
        Cycles::new(us / cycle_us(self.machine))
    }

    fn distance(&self, name: &str) -> Distance {
        Distance(u32::try_from(self.cell(name)).unwrap_or(u32::MAX))
    }

    fn position(&self, name: &str, place: usize) -> Position {
        Position(nearest(cell(&self.axis.values, name, place)))
    }

    fn stop(&self, name: &str, place: usize) -> Fit<Stop> {
        let code = u8::try_from(cell(&self.axis.values, name, place)).unwrap_or(u8::MAX);
        Stop::from_code(code).ok_or_else(|| format!("{name} is no stop"))
    }

    fn all(&self) -> Fit<Values> {
        let control = &self.machine.control;
        let p9500 = cycle_us(self.machine);
        let r9780 = u32::try_from(cell(control, "r9780", 0)).unwrap_or(1).max(1);
        let basic_cycles = (p9500 / r9780).max(1);
        let basic = |name| Self::cycles(self.cell(name), p9500 / basic_cycles);
        let delayed = !basic("p9652").is_zero();
        let extended = extended(self.axis);
        let bits = bits(self.axis);
        let profisafe = enables(self.axis, ControlPath::profisafe);
        let by_terminals = enables(self.axis, ControlPath::terminals);
        let millis = |us: i64| u32::try_from(us / 1_000).unwrap_or(u32::MAX);
        let communication = || {
            let esr = match self.axis.has("ESR") {
                true => millis(self.cell("p9580")),
                false => 0,
            };
            let watchdog = millis(cell(control, "F_WD_Time", 0));
            let cycle = NonZeroU32::new(p9500).unwrap_or(NonZeroU32::MIN);
            let stop_b = self.is("p9612");
            let config = match profisafe {
                true => communication::Config::from_millis(watchdog, esr, true, stop_b, cycle),
                // DRIVE-CLiQ is cyclic: a telegram that does not come is a failure in its cycle.
                false => communication::Config::new(
                    Cycles::new(1),
                    self.within(esr * 1_000),
                    false,
                    stop_b,
                ),
            };
            fit("F_WD_Time and p9580", config)
        };
        // Terminals may always be apart for the cycle after which one channel hears of the other.
        let tolerance = basic("p9650").max(Cycles::new(basic_cycles));
        Ok(Values {
            basic_cycles,
            selection: basic_selection::Config::new(by_terminals, bits, delayed),
            terminals: match by_terminals {
                true => Some(fit("p9650", terminal_pair::Config::new(tolerance))?),
                false => None,
            },
            ss1_basic: ss1_basic::Config {
                time: basic("p9652"),
                external: self.is("p9653"),
            },
            basic_stop: fit("p9658", basic_stop::Config::new(basic("p9658")))?,
            sto: sto::Config { valve: false },
            sbc: self.axis.has(SBC).then_some(sbc::Config { enabled: true }),
            communication: match profisafe || tm54f(self.axis) {
                true => Some(communication()?),
                false => None,
            },
            acknowledgement: acknowledgement::Config::new(false, bits, self.is("p9507_0")),
            path_test: path_test::Config::new(self.time("p9659")).ok(),
            drive_test: match extended {
                true => Some(self.drive_test()?),
                false => None,
            },
            test_request: self.test_request(extended),
            brake_test: match extended && self.axis.has(SBT) {
                true => Some(self.brake_test()?),
                false => None,
            },
            test_ramps: [0, 1].map(|k| self.cycles_of("p10208", k).count()),
            // 1 % of p1082, for which the fastest limit stands.
            slow: Speed(self.speed_of(fastest(self.axis)).0 / 100),
            measuring: Self::cycles(MEASURING_US, p9500).count(),
            extended: match extended {
                true => Some(self.extended()?),
                false => None,
            },
        })
    }
}
