//! The values of a machine file in the units of the monitors, checked by them.

use stillpoint_machine::{Axis, Group, Machine, Settings};
use stillpoint_monitors::heidenhain::types::Kind;
use stillpoint_monitors::heidenhain::{
    axis_release, channel, comparison, deceleration, operating_stop, output_enable, parameters,
    position_limit, reference, speed, stop, stop_path,
};
use stillpoint_monitors::kernel::{Cycles, Distance, Percent, Speed};

use crate::families::values::{Fit, fit};

/// The two channels.
pub(super) const CC: usize = 1;

/// What the monitors of one axis run with, by channel where it differs.
pub(super) struct AxisConfig {
    pub release: axis_release::Config,
    pub speed: [speed::Config; 2],
    pub standstill: operating_stop::Config,
    pub path: stop_path::Config,
    pub position: Option<position_limit::Config>,
    pub comparison: comparison::Config,
    pub deceleration: deceleration::Config,
    pub reference: reference::Config,
    /// The speed from which on it does not stand.
    pub still: Speed,
    /// How far it may be from a saved position or from its mark.
    pub near: Distance,
    /// The place of its mark.
    pub mark: i32,
}

fn cell(values: &Settings, name: &str) -> i64 {
    crate::families::values::cell(values, name, 0)
}

/// A value divided by the size of a step of its parameter; the machine file has none that is finer.
fn steps(values: &Settings, name: &str, step: i64) -> u32 {
    u32::try_from(cell(values, name) / step).unwrap_or(u32::MAX)
}

/// What the monitors of an axis run with.
pub(super) fn axis(machine: &Machine, axis: &Axis) -> Fit<AxisConfig> {
    of_axis(&machine.control, axis).map_err(|error| format!("axis {}: {error}", axis.name))
}

fn of_axis(control: &Settings, axis: &Axis) -> Fit<AxisConfig> {
    let own = &axis.values;
    let time = |name| fit(name, parameters::stop_time(steps(own, name, 1_000)));
    let window = |values, name| fit(name, parameters::window(steps(values, name, 1_000)));
    let percent = |name| {
        let value = u8::try_from(cell(own, name)).unwrap_or(u8::MAX);
        fit(name, Percent::new(value))
    };
    let limits = limits(control, axis)?;
    let by_channel = |cc| fit("the speed limits", speed::Config::new(limits, cc));
    let still = match axis.spindle {
        true => parameters::SPINDLE_STILL,
        false => parameters::AXIS_STILL,
    };
    let none = Distance(u32::MAX);
    let (standstill, path, tolerance, near) = match axis.spindle {
        true => (none, none, none, none),
        false => (
            fit(
                "SMP545",
                parameters::standstill_path(steps(own, "SMP545", 1)),
            )?,
            // From um to tenths.
            fit(
                "SMP550",
                parameters::stop_path(steps(own, "SMP550", 1) * 10),
            )?,
            fit("SMP641", parameters::deviation(steps(own, "SMP641", 1)))?,
            fit("SMP642", parameters::deviation(steps(own, "SMP642", 1)))?,
        ),
    };
    let place = |name| {
        let tenths = i32::try_from(cell(own, name) * 10).unwrap_or(i32::MAX);
        fit(name, parameters::absolute(tenths))
    };
    let linear = !axis.spindle && cell(own, "MP100") == 0;
    let position = match linear {
        true => {
            let limits = position_limit::Config::new(place("SMP670")?, place("SMP650")?);
            Some(fit("SMP650 and SMP670", limits)?)
        }
        false => None,
    };
    let (deviates, within, brakes) = match axis.spindle {
        true => ("SMP631", "SMP633", Cycles::new(2)),
        false => ("SMP630", "SMP632", time("SMP530")?),
    };
    let ends = if axis.spindle { "SMP528" } else { "SMP527" };
    let off = cell(control, "SMP560_11") != 0;
    let compared = comparison::Config::new(
        axis.spindle,
        tolerance,
        percent(deviates)?,
        window(own, within)?,
    );
    Ok(AxisConfig {
        release: fit(ends, axis_release::Config::new(time(ends)?))?,
        speed: [by_channel(false)?, by_channel(true)?],
        standstill: fit("SMP545", operating_stop::Config::new(standstill, still))?,
        path: fit("SMP550", stop_path::Config::new(path))?,
        position,
        comparison: fit(within, compared)?,
        deceleration: fit(
            "SMP530",
            deceleration::Config::new(axis.spindle, brakes, off),
        )?,
        reference: fit("SMP600", reference::Config::new(!axis.spindle))?,
        still,
        near,
        mark: place("SMP646").map_or(0, |mark| mark.0),
    })
}

fn limits(control: &Settings, axis: &Axis) -> Fit<speed::Limits> {
    let own = &axis.values;
    if axis.spindle {
        // From mdeg/min.
        let limit = |values, name| {
            fit(
                name,
                parameters::spindle_limit(steps(values, name, 360_000)),
            )
        };
        return Ok(speed::Limits {
            som_2: limit(control, "SMP591")?,
            som_3: limit(control, "SMP541")?,
            som_4: limit(own, "SMP551")?,
            restricted: parameters::RESTRICTED_SPEED,
        });
    }
    // From um/min or mdeg/min.
    let limit = |name, most| fit(name, parameters::axis_limit(steps(own, name, 1_000), most));
    Ok(speed::Limits {
        som_2: limit("SMP590", 2_000)?,
        som_3: limit("SMP540", 5_000)?,
        som_4: limit("SMP552", 5_000)?,
        restricted: Speed(0),
    })
}

/// The position of an axis, in tenths of an increment, that is next to `tenths` between its limit positions, where it has any.
pub(super) fn within(axis: &Axis, tenths: i64) -> i64 {
    if axis.spindle || cell(&axis.values, "MP100") != 0 {
        return tenths;
    }
    let end = |name| cell(&axis.values, name) * 10;
    tenths.max(end("SMP670")).min(end("SMP650"))
}

/// The axes of a group, by their places.
pub(super) fn members(machine: &Machine, group: &Group) -> Vec<usize> {
    let axes = machine.axes.iter().enumerate();
    let own = axes.filter(|(_, axis)| group.axes.iter().any(|a| *a.get_ref() == axis.name));
    own.map(|(k, _)| k).collect()
}

/// What a group consists of.
pub(super) fn kind(machine: &Machine, group: &Group) -> Kind {
    let mut axes = members(machine, group)
        .into_iter()
        .map(|k| &machine.axes[k]);
    match axes.next() {
        Some(axis) if axis.spindle => Kind::Spindle,
        Some(axis) if cell(&axis.values, "MP100") == 2 => Kind::Auxiliary,
        _ => Kind::NcAxes,
    }
}

/// What the monitors of a group run with, by channel: the longest times of its axes.
pub(super) fn group(machine: &Machine, group: &Group) -> Fit<[channel::Config; 2]> {
    let longest = |axis_name: &str, spindle_name: &str| {
        let axes = members(machine, group)
            .into_iter()
            .map(|k| &machine.axes[k]);
        let times = axes.map(|axis| {
            let name = if axis.spindle {
                spindle_name
            } else {
                axis_name
            };
            steps(&axis.values, name, 1_000)
        });
        times.max().unwrap_or(0)
    };
    let t_ss1 = fit("SMP525", parameters::stop_time(longest("SMP525", "SMP526")))?;
    let t_ss2 = fit("SMP527", parameters::stop_time(longest("SMP527", "SMP528")))?;
    let t_brake = fit(
        "MP2308",
        parameters::brake_time(longest("MP2308", "MP2308")),
    )?;
    let kind = kind(machine, group);
    let som_4 = som_4(machine);
    let channel = |cc| {
        let times = fit("SMP525", stop::Config::new(cc, t_ss1, t_ss2, t_brake))?;
        // 3 s, as the manual fixes it.
        fit(
            "SMP525",
            channel::Config::new(kind, som_4, times, Cycles::new(1_000)),
        )
    };
    Ok([channel(false)?, channel(true)?])
}

/// SOM_4 is enabled.
pub(super) fn som_4(machine: &Machine) -> bool {
    cell(&machine.control, "SMP560_0") != 0
}

/// The permission for the safe outputs.
pub(super) fn outputs(machine: &Machine) -> Fit<output_enable::Config> {
    let seconds = steps(&machine.control, "SMP2172", 1_000_000);
    let seconds = u8::try_from(seconds).unwrap_or(u8::MAX);
    fit("SMP2172", output_enable::Config::from_smp2172(seconds))
}

/// Whether SMP610 of one group lists another one.
pub(super) fn lists(machine: &Machine, group: usize, other: usize) -> bool {
    let listed = cell(&machine.axis_groups[group].values, "SMP610");
    listed >> other & 1 == 1
}

/// Whether a door leads to the magazine.
pub(super) fn of_magazine(machine: &Machine, door: usize) -> bool {
    cell(&machine.doors[door].values, "space") == 1
}
