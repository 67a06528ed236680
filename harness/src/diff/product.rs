//! The synchronous product of a table and its monitor: one system that drives both with the same inputs and compares them.

use stillpoint_engine::table;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::{LazyKind, Ty};
use stillpoint_model::{Choices, Domain, Fault, System, Trace};
use stillpoint_native::Table;
use stillpoint_show::diagram::{Diagram, Lane, Mark};

use super::peer::{Numbers, Peer};

/// What an output of the monitor is compared with.
#[derive(Clone, Copy)]
enum Source {
    State(usize),
    Lazy(usize),
}

/// The values an input can have at the interface of a monitor.
#[derive(Debug, Clone, Copy)]
pub enum Values {
    /// These.
    List(&'static [i32]),
    /// All from the first to the second.
    Range(i32, i32),
}

impl Values {
    /// How many there are.
    pub fn count(self) -> u64 {
        match self {
            Values::List(list) => list.len() as u64,
            Values::Range(lo, hi) => (i64::from(hi) - i64::from(lo) + 1).unsigned_abs(),
        }
    }

    /// Value number `k`, counted from 0; beyond the last one, the last.
    pub fn get(self, k: u64) -> i32 {
        match self {
            Values::List(list) => {
                let k = usize::try_from(k)
                    .unwrap_or(usize::MAX)
                    .min(list.len().saturating_sub(1));
                list.get(k).copied().unwrap_or(0)
            }
            Values::Range(lo, hi) => {
                let value = i64::from(lo).saturating_add(i64::try_from(k).unwrap_or(i64::MAX));
                i32::try_from(value).unwrap_or(hi).min(hi)
            }
        }
    }
}

/// Whether a port of a table has this name: alone for a machine on its own, with its instance for a system.
pub(super) fn is(port: &str, name: &str) -> bool {
    port == name || port.split_once('.').is_some_and(|(_, short)| short == name)
}

/// A table machine on its own, and its monitor.
pub struct Product<'a> {
    bound: &'a Bound,
    /// The generated step of the table, if there is one; else the interpreter runs it.
    table: Option<&'static Table>,
    peer: &'a dyn Peer,
    domains: Vec<Domain>,
    /// For each table input: its values at this interface.
    values: Vec<Values>,
    /// For each input of the monitor: the table input.
    feeds: Vec<usize>,
    compared: Vec<(Source, Ty)>,
}

/// The work area of a product.
#[derive(Clone)]
pub struct Work {
    frame: Frame,
    generated: Box<[i32]>,
    inputs: Vec<i32>,
    /// Those that the monitor has, in its order.
    fed: Vec<i32>,
    table: Numbers,
    monitor: Numbers,
}

impl<'a> Product<'a> {
    /// The product of `bound`, one machine on its own, and its monitor.
    ///
    /// # Errors
    /// A port or output that only one side has: a sentence.
    pub fn new(bound: &'a Bound, peer: &'a dyn Peer) -> Result<Self, String> {
        let system = &bound.system;
        let mut feeds = Vec::new();
        for name in peer.inputs() {
            let found = system.inputs.iter().position(|i| is(&i.name, name));
            feeds
                .push(found.ok_or_else(|| format!("table {} has no input `{name}`", system.name))?);
        }
        let unknown = system.inputs.iter().enumerate().find(|(k, input)| {
            !feeds.contains(k) && !peer.unused().iter().any(|(name, _)| is(&input.name, name))
        });
        if let Some((_, input)) = unknown {
            return Err(format!(
                "table {}: the monitor has no input `{}`",
                system.name, input.name
            ));
        }
        let mut values = Vec::new();
        for (k, (lo, hi)) in bound.inputs.iter().enumerate() {
            let port = feeds.iter().position(|f| *f == k);
            values.push(match port {
                // An input that the monitor does not have keeps its least value, where its readings are not the recommended
                // ones, or the one that the monitor's parameters give it.
                None => {
                    let name = &system.inputs[k].name;
                    let kept = peer.unused().iter().find(|(n, _)| is(name, n));
                    let value = kept.and_then(|(_, value)| *value).unwrap_or(*lo);
                    Values::Range(value, value)
                }
                Some(port) => match peer.allowed(port) {
                    Some(values) => values,
                    None => Values::Range(*lo, *hi),
                },
            });
        }
        let mut compared = Vec::new();
        for name in peer.outputs() {
            let state = system.states.iter().position(|s| is(&s.var.name, name));
            let lazy = || {
                system
                    .lazies
                    .iter()
                    .position(|l| l.kind == LazyKind::Output && is(&l.name, name))
            };
            compared.push(match (state, lazy()) {
                (Some(k), _) => (Source::State(k), system.states[k].var.ty),
                (None, Some(k)) => (Source::Lazy(k), system.lazies[k].ty),
                (None, None) => {
                    return Err(format!("table {} has no output `{name}`", system.name));
                }
            });
        }
        let mut domains: Vec<Domain> = bound
            .states
            .iter()
            .map(|(lo, hi)| Domain { lo: *lo, hi: *hi })
            .collect();
        domains.extend(peer.domains());
        let table = table::find(bound);
        Ok(Self {
            bound,
            table,
            peer,
            domains,
            values,
            feeds,
            compared,
        })
    }

    /// Holds an input at one value.
    ///
    /// # Errors
    /// There is no such input: a sentence.
    pub fn hold(&mut self, input: &str, value: i32) -> Result<(), String> {
        let system = &self.bound.system;
        let found = system.inputs.iter().position(|i| is(&i.name, input));
        let k = found.ok_or_else(|| format!("table {} has no input `{input}`", system.name))?;
        self.values[k] = Values::Range(value, value);
        Ok(())
    }

    /// Leaves wide inputs the values that an exploration tries; the names of those inputs.
    pub fn narrow(&mut self) -> Vec<String> {
        let mut narrowed = Vec::new();
        for (port, k) in self.feeds.iter().enumerate() {
            if let Some(values) = self.peer.explored(port) {
                self.values[*k] = values;
                narrowed.push(self.bound.system.inputs[*k].name.clone());
            }
        }
        narrowed
    }

    /// The names of the table's state variables: its cells stand first.
    pub fn table_cells(&self) -> Vec<&str> {
        let states = self.bound.system.states.iter();
        states.map(|s| s.var.name.as_str()).collect()
    }

    /// Number of outputs compared in each cycle.
    pub fn outputs(&self) -> usize {
        self.compared.len()
    }

    /// Atom: table and monitor agree on every output.
    pub const AGREE: usize = 0;

    /// Steps both sides with the inputs in `work`; `cells` holds both states.
    pub fn step(&self, work: &mut Work, cells: &mut [i32]) -> Result<(), Fault> {
        let n = self.bound.states.len();
        work.table.clear();
        match self.table {
            Some(table) => self.generated(table, work, &mut cells[..n])?,
            None => self.interpreted(work, &mut cells[..n])?,
        }
        work.fed.clear();
        work.fed.extend(self.feeds.iter().map(|k| work.inputs[*k]));
        work.monitor.clear();
        self.peer
            .step(&mut cells[n..], &work.fed, &mut work.monitor);
        Ok(())
    }

    fn generated(&self, table: &Table, work: &mut Work, cells: &mut [i32]) -> Result<(), Fault> {
        let (frame, params) = (&mut work.generated[..], &self.bound.values[..]);
        let inputs = &work.inputs;
        let mut read = |k: usize| inputs[k];
        let fault = |code| Fault { code };
        (table.step)(cells, frame, params, &mut read).map_err(fault)?;
        cells.copy_from_slice(&frame[..table.states]);
        for (source, _) in &self.compared {
            work.table.push(match source {
                Source::State(k) => i64::from(cells[*k]),
                Source::Lazy(k) => (table.lazy)(*k, frame, params, &mut read).map_err(fault)?,
            });
        }
        Ok(())
    }

    fn interpreted(&self, work: &mut Work, cells: &mut [i32]) -> Result<(), Fault> {
        let inputs = &work.inputs;
        let mut read = |k: usize| inputs[k];
        work.frame.start(cells);
        self.bound
            .step(&mut work.frame, &mut read)
            .map_err(|code| Fault { code })?;
        cells.copy_from_slice(&work.frame.now);
        for (source, _) in &self.compared {
            work.table.push(match source {
                Source::State(k) => i64::from(cells[*k]),
                Source::Lazy(k) => self.bound.lazy(*k, &mut work.frame, &mut read),
            });
        }
        Ok(())
    }

    /// What the table said in the last step, by the names of the monitor's outputs.
    pub(crate) fn said<'w>(&'w self, work: &'w Work) -> impl Iterator<Item = (&'static str, i64)> {
        self.peer
            .outputs()
            .iter()
            .copied()
            .zip(work.table.iter().copied())
    }

    /// A work area, also for runs that are not explored.
    pub fn new_work(&self) -> Work {
        Work {
            frame: Frame::new(self.bound),
            generated: vec![0; self.table.map_or(0, |t| t.cells)].into_boxed_slice(),
            inputs: self.bound.inputs.iter().map(|(lo, _)| *lo).collect(),
            fed: Vec::new(),
            table: Numbers::new(),
            monitor: Numbers::new(),
        }
    }

    /// Number of inputs of the table.
    pub fn inputs(&self) -> usize {
        self.values.len()
    }

    /// The values of the parameters, readings aside.
    pub fn parameters(&self) -> impl Iterator<Item = i32> + '_ {
        let all = self.bound.system.params.iter().zip(&self.bound.values);
        all.filter(|(p, _)| p.reading.is_none()).map(|(_, v)| *v)
    }

    /// The value of input `k` in a list of names.
    pub fn named(&self, k: usize, list: &[(&str, i32)]) -> Option<i32> {
        let input = &self.bound.system.inputs[k].name;
        let found = list.iter().find(|(name, _)| is(input, name));
        found.map(|(_, value)| *value)
    }

    /// The values input `k` of the table can have.
    pub fn values(&self, k: usize) -> Values {
        self.values[k]
    }

    /// Both initial states; `any` gives a state variable of the table that may start with any value.
    pub fn start(&self, any: &mut dyn FnMut(usize) -> i32) -> Vec<i32> {
        let table: Vec<i32> = self
            .bound
            .initial
            .iter()
            .enumerate()
            .map(|(k, v)| v.unwrap_or_else(|| any(k)))
            .collect();
        let named = |name: &str| {
            let states = &self.bound.system.states;
            let k = states.iter().position(|s| is(&s.var.name, name));
            k.map_or(0, |k| table[k])
        };
        let own = self.peer.initial(&named);
        [table, own].concat()
    }

    /// Whether the outputs of the last step agree.
    pub fn agree(&self, work: &Work) -> bool {
        work.table == work.monitor
    }

    /// Input vectors of an explored run: the initial state and the inputs of each cycle.
    pub fn inputs_of(&self, trace: &Trace) -> (Vec<i32>, Vec<Vec<i32>>) {
        let chosen = |step: &[(u32, u32)], k: usize| {
            step.iter()
                .find(|(i, _)| *i as usize == k)
                .map_or(0, |(_, v)| *v)
        };
        let start = self.start(&mut |k| self.bound.states[k].0 + chosen(&trace.initial, k) as i32);
        let cycles = trace
            .steps
            .iter()
            .map(|step| {
                (0..self.values.len())
                    .map(|k| self.values[k].get(u64::from(chosen(step, k))))
                    .collect()
            })
            .collect();
        (start, cycles)
    }

    /// Both sides of a run as one diagram, marked where they part.
    pub fn diagram(&self, start: &[i32], cycles: &[Vec<i32>]) -> Diagram {
        let system = &self.bound.system;
        let mut lanes: Vec<Lane> = Vec::new();
        for (k, input) in system.inputs.iter().enumerate() {
            if self.feeds.contains(&k) {
                let values = cycles
                    .iter()
                    .map(|c| Some(system.show(input.ty, i64::from(c[k]))));
                lanes.push(Lane {
                    group: "inputs".to_owned(),
                    name: input
                        .name
                        .split_once('.')
                        .map_or(input.name.clone(), |(_, n)| n.to_owned()),
                    level: input.ty == Ty::Bool,
                    values: std::iter::once(None).chain(values).collect(),
                });
            }
        }
        let lane = |group: &str, name: &str, ty: Ty| Lane {
            group: group.to_owned(),
            name: name.to_owned(),
            level: ty == Ty::Bool,
            values: vec![None],
        };
        let names = self.peer.outputs();
        let sides = |group: &str| -> Vec<Lane> {
            names
                .iter()
                .zip(&self.compared)
                .map(|(n, (_, ty))| lane(group, n, *ty))
                .collect()
        };
        let (mut table, mut monitor) = (sides("specification"), sides("monitor"));
        let mut marks = Vec::new();
        let mut work = self.new_work();
        let mut cells = start.to_vec();
        for (n, inputs) in cycles.iter().enumerate() {
            work.inputs.copy_from_slice(inputs);
            if self.step(&mut work, &mut cells).is_err() {
                break;
            }
            for k in 0..names.len() {
                let ty = self.compared[k].1;
                table[k].values.push(Some(system.show(ty, work.table[k])));
                monitor[k]
                    .values
                    .push(Some(system.show(ty, work.monitor[k])));
                if work.table[k] != work.monitor[k] {
                    let (a, b) = (
                        system.show(ty, work.table[k]),
                        system.show(ty, work.monitor[k]),
                    );
                    marks.push(Mark {
                        column: n + 1,
                        text: format!("{}: specification {a}, monitor {b}", names[k]),
                        fault: true,
                    });
                }
            }
        }
        // Outputs that never differ and never change say nothing about the divergence.
        for (a, b) in table.into_iter().zip(monitor) {
            let quiet = a.values == b.values && a.values.iter().skip(1).all(|v| *v == a.values[1]);
            if !quiet {
                lanes.push(a);
                lanes.push(b);
            }
        }
        lanes.sort_by_key(|l| {
            ["inputs", "specification", "monitor"]
                .iter()
                .position(|g| *g == l.group)
        });
        Diagram {
            lanes,
            columns: cycles.len() + 1,
            marks,
            ..Diagram::default()
        }
    }
}

impl Work {
    /// Sets the inputs of the next step.
    pub fn set_inputs(&mut self, inputs: &[i32]) {
        self.inputs.copy_from_slice(inputs);
    }
}

impl System for Product<'_> {
    type Work = Work;

    fn work(&self) -> Work {
        self.new_work()
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        self.values.iter().map(|v| u128::from(v.count())).product()
    }

    fn initial<C: Choices>(&self, _: &mut Work, choices: &mut C, state: &mut [i32]) {
        let cells = self.start(&mut |k| {
            let (lo, hi) = self.bound.states[k];
            lo + choices.choose(k as u32, (hi - lo + 1) as u32) as i32
        });
        state.copy_from_slice(&cells);
    }

    fn next<C: Choices>(
        &self,
        work: &mut Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        for (k, values) in self.values.iter().enumerate() {
            let count = u32::try_from(values.count()).unwrap_or(u32::MAX);
            let pick = if count > 1 {
                choices.choose(k as u32, count)
            } else {
                0
            };
            work.inputs[k] = values.get(u64::from(pick));
        }
        after.copy_from_slice(before);
        self.step(work, after)
    }

    fn atom<C: Choices>(&self, work: &mut Work, _: usize, _: &mut C) -> Result<bool, Fault> {
        Ok(self.agree(work))
    }

    fn atoms_read(&self) -> bool {
        false
    }
}
