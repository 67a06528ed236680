//! The safe PLC program of the machine in one channel: that of the machine file, else the example of the family, run by the
//! interpreter of the tables.

use std::collections::BTreeMap;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::LazyKind;
use stillpoint_machine::Machine;
use stillpoint_monitors::heidenhain::safe_plc::CC_CYCLE_MS;

use super::values::CC;

/// The system of the tables that holds the program.
const SYSTEM: &str = "logic";

/// The program of a channel, and how far it is.
pub(super) struct Program {
    bound: Bound,
    frame: Frame,
    state: Vec<i32>,
    /// Cycles of 3 ms in one of its own, and those that are left of it.
    period: u32,
    left: u32,
    /// The last value of each output.
    said: BTreeMap<String, i64>,
}

impl Program {
    /// The program of a machine in a channel, in its own cycle: that of the PLC (MP7602) in the MC, 21 ms in the CC.
    pub(super) fn new(machine: &Machine, side: usize) -> Result<Self, String> {
        let mut runs = machine.runs.iter();
        let run = runs
            .find(|run| run.system == SYSTEM)
            .ok_or("the family has no program of a safe PLC")?;
        let cycle = match side {
            CC => i64::from(CC_CYCLE_MS) * 1_000,
            _ => run.cycle,
        };
        let cycle_us = u64::try_from(cycle).unwrap_or(1).max(1);
        let mut params = run.params.clone();
        // One second, and the times of the program itself: in its own cycles, however the run scales them.
        let second = ("t_clear".to_owned(), 1_000_000);
        for (name, us) in std::iter::once(&second).chain(machine.logic_times()) {
            if let Some(time) = params.get_mut(name) {
                *time = vec![i64::try_from(us.div_ceil(cycle_us)).unwrap_or(1)];
            }
        }
        let spec = machine.spec(run).map_err(|e| e.to_string())?;
        let system = spec
            .system(SYSTEM, Some(cycle_us))
            .map_err(|e| e.to_string())?;
        let bound = Bound::new(system, &params, &BTreeMap::new()).map_err(|e| e.to_string())?;
        let mut program = Self {
            frame: Frame::new(&bound),
            state: Vec::new(),
            period: u32::try_from(cycle / machine.monitoring_cycle.max(1))
                .unwrap_or(1)
                .max(1),
            left: 0,
            said: BTreeMap::new(),
            bound,
        };
        program.power_on();
        Ok(program)
    }

    /// Off and on.
    pub(super) fn power_on(&mut self) {
        let states = self.bound.system.states.iter();
        let first = states.map(|state| {
            let value = state.init.as_ref().map(|init| self.bound.constant(init));
            i32::try_from(value.unwrap_or(0)).unwrap_or(0)
        });
        self.state = first.collect();
        self.left = 0;
        self.said.clear();
    }

    /// Whether a cycle of the program ends with this one of the kernel.
    pub(super) const fn is_due(&self) -> bool {
        self.left == 0
    }

    /// One cycle of the kernel. At the end of a cycle of the program it has new outputs; `seen` gives it the value of an
    /// input.
    pub(super) fn step(&mut self, seen: &dyn Fn(&str) -> i64) {
        if self.left > 0 {
            self.left -= 1;
            return;
        }
        self.left = self.period - 1;
        let system = &self.bound.system;
        self.frame.start(&self.state);
        let given = |name: &str| {
            let short = name.strip_prefix("splc.").or(name.strip_prefix("som."));
            let value = short.map(seen);
            value.and_then(|value| i32::try_from(value).ok())
        };
        // What a port of the program or of the keylock is given counts in place of what the system wires it to.
        for (lazy, cell) in system.lazies.iter().zip(&mut self.frame.lazies) {
            if let (LazyKind::Wire, Some(value)) = (lazy.kind, given(&lazy.name)) {
                *cell = value;
            }
        }
        let mut read = |k: usize| given(&system.inputs[k].name).unwrap_or(0);
        // A program whose value leaves its range asks for nothing new: `check` finds it.
        if self.bound.step(&mut self.frame, &mut read).is_err() {
            return;
        }
        for (k, lazy) in system.lazies.iter().enumerate() {
            let output = lazy.name.strip_prefix("splc.");
            if let (LazyKind::Output, Some(name)) = (lazy.kind, output) {
                let value = self.bound.lazy(k, &mut self.frame, &mut read);
                self.said.insert(name.to_owned(), value);
            }
        }
        self.state.copy_from_slice(&self.frame.now);
    }

    /// The last value of an output; 0 before the first cycle.
    pub(super) fn output(&self, name: &str, first: i64) -> i64 {
        self.said.get(name).copied().unwrap_or(first)
    }
}
