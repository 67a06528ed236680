//! The production monitors as peers of the tables: the same ports, in the numbers of the specification.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::{Cycles, ExternalStop, InternalStop, Level, Speed};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::{agreement, external, fault, gear, reference, selection, stop};
use stillpoint_spec::bind::Bound;

mod axis;
mod stops;

use axis::{Agreement, Gear, Reference, Selection};
use stops::{External, Fault, Stop};

/// Numbers in the order of a list of names.
pub type Numbers = Vec<i64>;

/// A production monitor with its configuration, driven and observed in the numbers of its table.
pub trait Peer: Sync {
    /// Names of the inputs, as the table calls them.
    fn inputs(&self) -> &'static [&'static str];
    /// The values input `k` can have at this interface; none where every value of the table's type is possible.
    fn allowed(&self, k: usize) -> Option<&'static [i32]> {
        let _ = k;
        None
    }
    /// Names of the outputs; each is an output or a state variable of the table.
    fn outputs(&self) -> &'static [&'static str];
    /// Ranges of the cells of the state.
    fn domains(&self) -> Vec<Domain>;
    /// The initial cells; `table` gives the initial value of a table's state variable, for what is non-volatile.
    fn initial(&self, table: &dyn Fn(&str) -> i32) -> Vec<i32>;
    /// One step from and to cells, with the outputs.
    fn step(&self, cells: &mut [i32], inputs: &[i32], outputs: &mut Numbers);
}

const INTERNAL: &[i32] = &[0, 2, 3, 4, 6, 7];
const EXTERNAL: &[i32] = &[0, 2, 3, 4, 7];

fn level(ordinal: i32) -> Level {
    match ordinal {
        1 => Level::F,
        2 => Level::E,
        3 => Level::D,
        4 => Level::C,
        5 => Level::Test,
        6 => Level::B,
        7 => Level::A,
        _ => Level::None,
    }
}

fn internal(ordinal: i32) -> InternalStop {
    InternalStop::from_level(level(ordinal)).unwrap_or(InternalStop::A)
}

fn external_stop(ordinal: i32) -> ExternalStop {
    ExternalStop::from_level(level(ordinal)).unwrap_or(ExternalStop::A)
}

fn rank(level: Level) -> i64 {
    i64::from(level.rank())
}

fn cycles(cell: i32) -> Cycles {
    Cycles::new(u32::try_from(cell).unwrap_or(0))
}

fn cell(cycles: Cycles) -> i32 {
    i32::try_from(cycles.count()).unwrap_or(i32::MAX)
}

fn stage(ordinal: i32) -> selection::Stage {
    selection::Stage::from_bits(ordinal & 2 != 0, ordinal & 1 != 0)
}

fn speed(value: i32) -> Speed {
    Speed(u32::try_from(value).unwrap_or(0))
}

fn bit(b: bool) -> i64 {
    i64::from(b)
}

fn truth() -> Domain {
    Domain { lo: 0, hi: 1 }
}

fn upto(hi: i32) -> Domain {
    Domain { lo: 0, hi }
}

/// Value of a parameter of an open machine.
fn param(bound: &Bound, name: &str) -> i32 {
    let named = bound.system.params.iter().position(|p| p.var.name == name);
    named.map_or(0, |k| bound.values[k])
}

/// Names of the machines that have a monitor.
pub const MACHINES: [&str; 7] = [
    "external",
    "fault",
    "stop",
    "selection",
    "reference",
    "agreement",
    "gear",
];

/// The monitor that implements `machine` under the parameters of `bound`, with `mutant` in it if one is given.
///
/// # Errors
/// The monitor's own refusal of the parameters.
pub fn peer(
    machine: &str,
    bound: &Bound,
    mutant: Option<Mutant>,
) -> Result<Option<Box<dyn Peer>>, String> {
    let refused = |e| format!("the monitor `{machine}` refuses these parameters: {e:?}");
    let p = |name: &str| param(bound, name);
    let time = |name: &str| cycles(p(name));
    Ok(Some(match machine {
        "external" => Box::new(External {
            config: external::Config::new(
                p("enable_ext") != 0,
                p("enable_e") != 0,
                p("spl_stop_e") != 0,
            )
            .map_err(refused)?,
            next: mutant.map_or(external::next as external::Next, Mutant::external),
        }) as Box<dyn Peer>,
        "fault" => Box::new(Fault {
            config: fault::Config::new(time("t_f")).map_err(refused)?,
            t_f: p("t_f"),
            next: mutant.map_or(fault::next as fault::Next, Mutant::fault),
        }),
        "stop" => Box::new(Stop {
            config: stop::Config::new(time("t_b"), time("t_c"), time("t_d"), time("t_e"))
                .map_err(refused)?,
            longest: p("t_b").max(p("t_c")).max(p("t_d")).max(p("t_e")),
            next: mutant.map_or(stop::next as stop::Next, Mutant::stop),
        }),
        "selection" => Box::new(Selection {
            config: selection::Config::new(
                p("enable") != 0,
                time("t_vel"),
                ["limit_1", "limit_2", "limit_3", "limit_4"].map(|n| speed(p(n))),
            )
            .map_err(refused)?,
            t_vel: p("t_vel"),
            pos_max: p("pos_max"),
            next: mutant.map_or(selection::next as selection::Next, Mutant::selection),
        }),
        "reference" => Box::new(Reference {
            config: reference::Config::new(true).map_err(refused)?,
            next: mutant.map_or(reference::next as reference::Next, Mutant::reference),
        }),
        "agreement" => Box::new(Agreement {
            config: agreement::Config::new(time("t_differ"), p("se_sn_enabled") != 0)
                .map_err(refused)?,
            t_differ: p("t_differ"),
            next: mutant.map_or(agreement::next as agreement::Next, Mutant::agreement),
        }),
        "gear" => Box::new(Gear {
            config: gear::Config::new(
                u8::try_from(p("gear_max")).unwrap_or(0),
                p("se_sn_enabled") != 0,
            )
            .map_err(refused)?,
            gear_max: p("gear_max"),
            next: mutant.map_or(gear::next as gear::Next, Mutant::gear),
        }),
        _ => return Ok(None),
    }))
}
