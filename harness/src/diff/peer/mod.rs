//! The production monitors as peers of the tables: the same ports, in the numbers of the specification.

mod adapter;
mod axis;
mod cells;
mod channel;
mod checking;
mod monitoring;
mod numbers;
mod stops;

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::{ConfigError, Cycles, Speed};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_spec::bind::Bound;

use super::product::Values;
use adapter::Adapter;

/// Numbers in the order of a list of names.
pub type Numbers = Vec<i64>;

/// A production monitor with its configuration, driven and observed in the numbers of its table.
pub trait Peer: Send + Sync {
    /// Names of the inputs, as the table calls them.
    fn inputs(&self) -> &'static [&'static str];
    /// Names of the inputs that only the table has; they keep their least value.
    fn unused(&self) -> &'static [&'static str];
    /// The values input `k` can have at this interface; none where every value of the table's type is possible.
    fn allowed(&self, k: usize) -> Option<Values>;
    /// Names of the outputs; each is an output or a state variable of the table.
    fn outputs(&self) -> &'static [&'static str];
    /// Ranges of the cells of the state.
    fn domains(&self) -> Vec<Domain>;
    /// The initial cells; `table` gives the initial value of a table's state variable, for what is non-volatile.
    fn initial(&self, table: &dyn Fn(&str) -> i32) -> Vec<i32>;
    /// One step from and to cells, with the outputs.
    fn step(&self, cells: &mut [i32], inputs: &[i32], outputs: &mut Numbers);
}

/// The machines that have a monitor, each with the name of its module.
pub const MACHINES: [(&str, &str); 23] = [
    ("external", "external"),
    ("fault", "fault"),
    ("stop", "stop"),
    ("group", "group"),
    ("selection", "selection"),
    ("reference", "reference"),
    ("agreement", "agreement"),
    ("gear", "gear"),
    ("motion", "motion"),
    ("standstill", "standstill"),
    ("speed", "speed"),
    ("end_stop", "limit_switch"),
    ("ramp", "ramp"),
    ("threshold", "threshold"),
    ("cam", "cam"),
    ("results", "results"),
    ("test", "test_stop"),
    ("shutdown_test", "shutdown_test"),
    ("pulses", "pulses"),
    ("compare", "compare"),
    ("slip", "slip"),
    ("history", "history"),
    ("test_interval", "forced_check"),
];

/// The systems that have a monitor: several machines together.
pub const SYSTEMS: [(&str, &str); 1] = [("axis_core", "channel")];

/// Parameters of the tables with the only value for which a comparison means something: constants of the monitors (smaller
/// values only keep a system small), and a variant that a system leaves out.
pub const FIXED: [(&str, &str, i64); 2] =
    [("compare", "factor", 10), ("axis_core", "one_encoder", 0)];

/// Why there is no peer under some parameters.
enum Refusal {
    /// The monitor does not accept them.
    Monitor(ConfigError),
    /// The table is too small for what the monitor does.
    Table(&'static str),
}

impl From<ConfigError> for Refusal {
    fn from(error: ConfigError) -> Self {
        Self::Monitor(error)
    }
}

/// What comes of making a peer: none for a machine without a monitor, or why there is none under these parameters.
type Made = Result<Option<Adapter>, Refusal>;

/// An adapter, or why there is none under these parameters.
type Refusable = Result<Adapter, Refusal>;

/// The parameters of a machine or system.
struct Params<'a>(&'a Bound);

impl Params<'_> {
    /// A value; 0 for a name that the table does not have.
    fn value(&self, name: &str) -> i32 {
        let mut params = self.0.system.params.iter();
        let named = params.position(|p| p.var.name == name);
        named.map_or(0, |k| self.0.values[k])
    }

    fn is(&self, name: &str) -> bool {
        self.value(name) != 0
    }

    fn time(&self, name: &str) -> Cycles {
        numbers::cycles(self.value(name))
    }

    fn speed(&self, name: &str) -> Speed {
        numbers::speed(self.value(name))
    }
}

/// The monitor that implements `machine`, the name of a machine or system, under the parameters of `bound`, with `mutant` in
/// it if one is given. None if there is no such monitor.
///
/// # Errors
/// The monitor's own refusal of the parameters, or a table too small for it.
pub fn peer(
    machine: &str,
    bound: &Bound,
    mutant: Option<Mutant>,
) -> Result<Option<Box<dyn Peer>>, String> {
    let params = Params(bound);
    for make in [
        stops::make,
        axis::make,
        monitoring::make,
        checking::make,
        channel::make,
    ] {
        let made = make(machine, &params, mutant).map_err(|e| match e {
            Refusal::Monitor(e) => {
                format!("the monitor of `{machine}` refuses these parameters: {e:?}")
            }
            Refusal::Table(text) => format!("machine `{machine}`: {text}"),
        })?;
        if let Some(adapter) = made {
            return Ok(Some(Box::new(adapter)));
        }
    }
    Ok(None)
}
