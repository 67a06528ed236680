//! The control states of all machines of a system, found in one pass through its reachable cycles.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use stillpoint_engine::table::{Generated, Interpreted};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{Ty, Var};
use stillpoint_model::{Choices, Domain, Error, Fault, Options, System, reachable};
use stillpoint_show::graph::{Edge, Graph, Node};

/// How many cycles are gone through at most, by the evaluator of the system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Budget {
    /// With the generated step.
    pub generated: u64,
    /// With the interpreter.
    pub interpreted: u64,
}

impl Budget {
    /// Every reachable cycle.
    pub const UNLIMITED: Self = Self {
        generated: u64::MAX,
        interpreted: u64::MAX,
    };
}

/// The control states of each machine of a system that has any: the name of the instance, and its states.
///
/// A control state is a combination of values of the machine's variables that have an enum as type; where these are too
/// many for a picture, each variable has a graph of its own, and the machine stands there several times. An edge names the
/// rules that lead from the one to the other in some reachable cycle, or stay there. Where one variable makes the state,
/// values that no run reaches are there too.
///
/// None where the system has more reachable cycles than the budget, counted by the combinations of the inputs that a cycle
/// reads. That does not depend on the machine it runs on, unless a limit of `options` ends the pass.
///
/// # Errors
/// A system that cannot be explored.
pub fn control_states(
    bound: &Bound,
    budget: Budget,
    options: &Options,
) -> Result<Option<Vec<(String, Graph)>>, Error> {
    let machines = machines(bound, &|_, var| matches!(var.ty, Ty::Enum(_)));
    graphs(bound, &machines, budget, options)
}

/// The control states of one instance, made of these of its variables; of all whose type is an enum where none are named.
///
/// None where there is no such instance or variable.
///
/// # Errors
/// As [`control_states`].
pub fn control_states_of(
    bound: &Bound,
    instance: &str,
    variables: Option<&[String]>,
    options: &Options,
) -> Result<Option<Graph>, Error> {
    let machines = machines(bound, &|name, var| {
        let own = var
            .name
            .strip_prefix(name)
            .and_then(|n| n.strip_prefix('.'));
        let chosen = match variables {
            Some(chosen) => own.is_some_and(|own| chosen.iter().any(|v| v == own)),
            None => matches!(var.ty, Ty::Enum(_)),
        };
        name == instance && chosen
    });
    let found = graphs(bound, &machines, Budget::UNLIMITED, options)?;
    Ok(found
        .and_then(|graphs| graphs.into_iter().next())
        .map(|(_, graph)| graph))
}

fn graphs(
    bound: &Bound,
    machines: &[Machine],
    budget: Budget,
    options: &Options,
) -> Result<Option<Vec<(String, Graph)>>, Error> {
    if machines.is_empty() {
        return Ok(Some(Vec::new()));
    }
    let seen = match Generated::find(bound) {
        Some(system) => pass(&system, machines, budget.generated, options)?,
        None => {
            let system = Interpreted::new(bound);
            pass(&system, machines, budget.interpreted, options)?
        }
    };
    Ok(seen.map(|seen| {
        machines
            .iter()
            .enumerate()
            .flat_map(|(m, machine)| {
                let graphs = machine.pictures(bound, m, &seen).into_iter();
                graphs.map(|graph| (machine.name.to_owned(), graph))
            })
            .collect()
    }))
}

/// States and arrows beyond which each variable is drawn by itself.
const MOST: (usize, usize) = (12, 36);

/// A machine with control states.
struct Machine<'a> {
    name: &'a str,
    /// The state variables that make the control state.
    cells: Vec<usize>,
    /// The numbers of its rules.
    rules: Range<usize>,
}

/// The machines with state variables that `chosen`, given the name of the instance and the variable, picks.
fn machines<'a>(bound: &'a Bound, chosen: &dyn Fn(&str, &Var) -> bool) -> Vec<Machine<'a>> {
    let mut first = 0;
    let mut out = Vec::new();
    for instance in &bound.system.instances {
        let rules = first..first + instance.rules.len();
        first = rules.end;
        let states = instance.states.start as usize..instance.states.end as usize;
        let picked = |k: &usize| chosen(&instance.name, &bound.system.states[*k].var);
        let cells: Vec<usize> = states.filter(picked).collect();
        if !cells.is_empty() {
            out.push(Machine {
                name: &instance.name,
                cells,
                rules,
            });
        }
    }
    out
}

/// What one machine did in a cycle: from which control state, to which, by which of its rules.
type Did = (Vec<i32>, Vec<i32>, Option<usize>);

/// What was seen of all machines, by their numbers.
#[derive(Default)]
struct Seen {
    initial: BTreeSet<(usize, Vec<i32>)>,
    did: BTreeSet<(usize, Did)>,
}

fn pass<S: System>(
    system: &S,
    machines: &[Machine],
    budget: u64,
    options: &Options,
) -> Result<Option<Seen>, Error> {
    let watched = Watched {
        system,
        machines,
        budget,
        cycles: AtomicU64::new(0),
        seen: Mutex::default(),
    };
    let complete = reachable(&watched, options, &mut |_| ())?;
    let within = watched.cycles.into_inner() <= budget;
    let seen = watched.seen.into_inner().ok();
    Ok(seen.filter(|_| complete && within))
}

/// A system that notes what its machines do.
struct Watched<'a, S> {
    system: &'a S,
    machines: &'a [Machine<'a>],
    budget: u64,
    cycles: AtomicU64,
    seen: Mutex<Seen>,
}

/// The work area of the system, with what this thread has noted of each machine.
#[derive(Clone)]
struct Noted<W> {
    work: W,
    did: Vec<HashSet<Did>>,
    last: Vec<Option<Did>>,
    /// The state whose cycles are made, and whether the budget was spent before the first of them.
    state: Vec<i32>,
    over: bool,
}

impl<S: System> Watched<'_, S> {
    fn note(&self, noted: &mut Noted<S::Work>, before: &[i32], after: &[i32]) {
        let mut fired: Vec<Option<usize>> = vec![None; self.machines.len()];
        self.system.fired(&noted.work, &mut |rule| {
            for (machine, fired) in self.machines.iter().zip(&mut fired) {
                if machine.rules.contains(&rule) {
                    *fired = Some(rule);
                }
            }
        });
        for (m, (machine, fired)) in self.machines.iter().zip(fired).enumerate() {
            let again = noted.last[m].as_ref().is_some_and(|(from, to, rule)| {
                *rule == fired && machine.is(from, before) && machine.is(to, after)
            });
            if again {
                continue;
            }
            let did = (machine.of(before), machine.of(after), fired);
            if noted.did[m].insert(did.clone()) {
                if let Ok(mut seen) = self.seen.lock() {
                    seen.did.insert((m, did.clone()));
                }
            }
            noted.last[m] = Some(did);
        }
    }
}

impl<S: System> System for Watched<'_, S> {
    type Work = Noted<S::Work>;

    fn work(&self) -> Self::Work {
        Noted {
            work: self.system.work(),
            did: vec![HashSet::new(); self.machines.len()],
            last: vec![None; self.machines.len()],
            state: Vec::new(),
            over: false,
        }
    }

    fn domains(&self) -> &[Domain] {
        self.system.domains()
    }

    fn combinations(&self) -> u128 {
        self.system.combinations()
    }

    fn initial<C: Choices>(&self, work: &mut Self::Work, choices: &mut C, state: &mut [i32]) {
        self.system.initial(&mut work.work, choices, state);
        if let Ok(mut seen) = self.seen.lock() {
            let states = self.machines.iter().map(|machine| machine.of(state));
            seen.initial.extend(states.enumerate());
        }
    }

    fn next<C: Choices>(
        &self,
        work: &mut Self::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        let over = self.cycles.fetch_add(1, Ordering::Relaxed) >= self.budget;
        if work.state != before {
            work.state.clear();
            work.state.extend_from_slice(before);
            work.over = over;
        }
        if work.over {
            // What is found from here on is thrown away, and without choices the pass ends soon. The cycles of a state that
            // was begun are all made, since each has to ask for as much as the one before it.
            after.copy_from_slice(before);
            return Ok(());
        }
        self.system.next(&mut work.work, before, choices, after)?;
        if !self.system.discarded(&work.work) {
            self.note(work, before, after);
        }
        Ok(())
    }

    fn atom<C: Choices>(
        &self,
        work: &mut Self::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        self.system.atom(&mut work.work, atom, choices)
    }

    fn discarded(&self, work: &Self::Work) -> bool {
        !work.over && self.system.discarded(&work.work)
    }
}

impl Machine<'_> {
    fn of(&self, state: &[i32]) -> Vec<i32> {
        self.cells.iter().map(|k| state[*k]).collect()
    }

    fn is(&self, control: &[i32], state: &[i32]) -> bool {
        self.cells.iter().zip(control).all(|(k, v)| state[*k] == *v)
    }

    /// The states of machine number `m` as one graph, or as one for each variable.
    fn pictures(&self, bound: &Bound, m: usize, seen: &Seen) -> Vec<Graph> {
        let all: Vec<usize> = (0..self.cells.len()).collect();
        let whole = self.picture(bound, &all, m, seen);
        let arrows = whole.edges.iter().filter(|e| e.from != e.to).count();
        if whole.nodes.len() <= MOST.0 && arrows <= MOST.1 || all.len() == 1 {
            return vec![whole];
        }
        all.iter()
            .map(|k| self.picture(bound, &[*k], m, seen))
            .collect()
    }

    /// The states of machine number `m` as some of its variables, by their places in `cells`, show them.
    fn picture(&self, bound: &Bound, shown: &[usize], m: usize, seen: &Seen) -> Graph {
        let system = &bound.system;
        let cells: Vec<usize> = shown.iter().map(|k| self.cells[*k]).collect();
        let part = |control: &[i32]| -> Vec<i32> { shown.iter().map(|k| control[*k]).collect() };
        let own: BTreeSet<Did> = seen
            .did
            .iter()
            .filter(|(k, _)| *k == m)
            .map(|(_, (from, to, rule))| (part(from), part(to), *rule))
            .collect();
        let initial: BTreeSet<Vec<i32>> = seen
            .initial
            .iter()
            .filter(|(k, _)| *k == m)
            .map(|(_, control)| part(control))
            .collect();
        let mut reached: BTreeSet<&Vec<i32>> = own.iter().flat_map(|(a, b, _)| [a, b]).collect();
        reached.extend(&initial);
        let mut all: BTreeSet<Vec<i32>> = reached.iter().map(|v| (*v).clone()).collect();
        if let [cell] = cells.as_slice() {
            let (lo, hi) = bound.states[*cell];
            all.extend((lo..=hi).map(|v| vec![v]));
        }
        let numbers: BTreeMap<&Vec<i32>, usize> = all.iter().zip(0..).collect();
        let mut ways: BTreeMap<(usize, usize), Vec<String>> = BTreeMap::new();
        for (from, to, rule) in &own {
            let rule = rule.and_then(|k| system.rules().nth(k));
            let name = rule.map_or("no rule", |r| r.name.rsplit('.').next().unwrap_or(&r.name));
            if let (Some(from), Some(to)) = (numbers.get(from), numbers.get(to)) {
                ways.entry((*from, *to)).or_default().push(name.to_owned());
            }
        }
        let label = |control: &Vec<i32>| -> String {
            let values = cells.iter().zip(control).map(|(k, v)| {
                let ty = system.states[*k].var.ty;
                system.show(ty, i64::from(*v))
            });
            values.collect::<Vec<_>>().join("\n")
        };
        let variables = cells.iter();
        let variables: Vec<&str> = variables
            .map(|k| system.states[*k].var.name.as_str())
            .collect();
        Graph {
            title: variables.join(", "),
            nodes: all
                .iter()
                .map(|control| Node {
                    label: label(control),
                    note: String::new(),
                    reached: reached.contains(control),
                    initial: initial.contains(control),
                })
                .collect(),
            edges: ways
                .into_iter()
                .map(|((from, to), labels)| Edge { from, to, labels })
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use stillpoint_engine::subject::{Readings, load};

    fn states(budget: u64, threads: usize) -> Option<Vec<(String, Graph)>> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let file = root.join("tests/must-fail/lower-stop-displaces-higher.toml");
        let subject = load(&file, &Readings::new()).expect("the file");
        let budget = Budget {
            generated: budget,
            interpreted: budget,
        };
        let mut options = Options::default();
        options.limits.threads = threads;
        control_states(&subject.tasks[0].bound, budget, &options).expect("explored")
    }

    #[test]
    fn every_way_has_its_rules() {
        let found = states(1000, 1).expect("within the budget");
        assert_eq!(Some(&found), states(1000, 2).as_ref());
        let [(name, graph)] = found.as_slice() else {
            panic!("{found:?}");
        };
        assert_eq!(name, "stop");
        let initial: Vec<&str> = graph
            .nodes
            .iter()
            .filter(|n| n.initial)
            .map(|n| n.label.as_str())
            .collect();
        assert_eq!(initial, ["NONE"]);
        assert!(graph.nodes.iter().all(|n| n.reached), "{graph:?}");
        // Each state leads to the five stops, and where it can be acknowledged to none.
        assert_eq!(graph.edges.len(), 4 * 6 + 2 * 5);
        assert!(graph.edges.iter().all(|e| !e.labels.is_empty()));
    }

    #[test]
    fn a_budget_ends_the_pass() {
        // Six demands in each of six states; without one, four of them read the acknowledgement.
        let cycles = 6 * 6 + 4;
        assert!(states(cycles, 1).is_some());
        for budget in [0, 1, 7, cycles - 1] {
            assert_eq!(states(budget, 1), None, "{budget}");
            assert_eq!(states(budget, 2), None, "{budget}");
        }
    }
}
