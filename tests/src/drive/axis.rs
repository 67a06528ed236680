//! The values of a drive that its answers depend on.

use stillpoint_machine::{self as machine, AxisKind, Machine, Settings};

/// The values of an axis that its answers depend on, in cycles, micrometres and micrometres per cycle.
pub(super) struct Axis {
    /// Cycles in which a telegram may be missing: `F_WD_Time`.
    pub watchdog: u32,
    /// Delay of SLS and SOS, p9551, and the times of SS1 and STOP F, p9556 and p9555.
    pub p9551: u32,
    pub p9556: u32,
    pub p9555: u32,
    /// None of a rotary axis.
    pub lengths: Option<Lengths>,
    /// STO or SS1 that is selected and deselected acknowledges.
    pub extended: bool,
}

pub(super) struct Lengths {
    /// Limits of SLS, and whether the telegram brings the first one.
    pub limits: [u64; 4],
    pub by_telegram: bool,
    /// The window of SOS, the tolerance of both encoders.
    pub window: u64,
    pub apart: u64,
    /// SSM without hysteresis: its limit.
    pub ssm: Option<u64>,
    /// SDI: the delay in cycles, and the tolerance.
    pub sdi: Option<(u32, u64)>,
    /// The ranges of SLP, lower and upper end.
    pub slp: Option<[[i64; 2]; 2]>,
}

impl Axis {
    pub(super) fn of(machine: &Machine, axis: &machine::Axis) -> Self {
        let cycle = machine.monitoring_cycle.unsigned_abs();
        let signed = |values: &Settings, name: &str, k: usize| {
            let cell = values.get(name).and_then(|value| value.cells.get(k));
            *cell.unwrap_or_else(|| panic!("{} has no {name}", axis.name))
        };
        let own = |name| signed(&axis.values, name, 0).unsigned_abs();
        let cycles = |name| own(name).div_ceil(cycle) as u32;
        // What runs a minute, in a cycle.
        let speed = |name, k| signed(&axis.values, name, k).unsigned_abs() * cycle / 60_000_000;
        let range = |k| ["p9535", "p9534"].map(|name| signed(&axis.values, name, k));
        let lengths = || Lengths {
            limits: [0, 1, 2, 3].map(|k| speed("p9531", k)),
            by_telegram: axis.has("SLS limit by telegram"),
            window: own("p9530"),
            apart: own("p9542"),
            ssm: (!axis.has("SSM hysteresis") && own("p9546") > 0).then(|| speed("p9546", 0)),
            sdi: axis.has("SDI").then(|| (cycles("p9565"), own("p9564"))),
            slp: axis.has("SLP").then(|| [range(0), range(1)]),
        };
        Self {
            watchdog: (signed(&machine.control, "F_WD_Time", 0).unsigned_abs() / cycle) as u32,
            p9551: cycles("p9551"),
            p9556: cycles("p9556"),
            p9555: cycles("p9555"),
            lengths: (axis.kind == AxisKind::Linear).then(lengths),
            extended: own("p9507_0") != 0,
        }
    }
}
