//! The control states of a machine as a picture: which there are, which are reached, and by which rules.

use std::collections::{BTreeMap, BTreeSet};

use petgraph::graph::NodeIndex;
use stillpoint_model::table::{Generated, Interpreted};
use stillpoint_model::{
    Choices, ControlGraph, Domain, Error, Fault, Options, System, control_graph,
};
use stillpoint_show::graph::{Edge, Graph, Node};
use stillpoint_spec::bind::Bound;
use stillpoint_spec::ir::{Instance, Ty};

/// The control states of one instance in the reachable states of its system: combinations of values of its variables with
/// an enum as type. An edge names the rules that lead from the one to the other in some reachable cycle, or stay. Where one variable makes the state, values that are never reached are there too, pale.
///
/// None for an instance without such a variable.
///
/// # Errors
/// A system that cannot be explored.
pub fn control(bound: &Bound, instance: usize, options: &Options) -> Result<Option<Graph>, Error> {
    let Some(of) = bound.system.instances.get(instance) else {
        return Ok(None);
    };
    let cells: Vec<usize> = (of.states.start as usize..of.states.end as usize)
        .filter(|k| matches!(bound.system.states[*k].var.ty, Ty::Enum(_)))
        .collect();
    if cells.is_empty() {
        return Ok(None);
    }
    let found = match Generated::find(bound) {
        Some(generated) => explored(&generated, bound, instance, &cells, options)?,
        None => explored(&Interpreted::new(bound), bound, instance, &cells, options)?,
    };
    Ok(Some(picture(bound, of, &cells, &found)))
}

/// Control states, each with the rule that led to it last.
type Found = ControlGraph<(Vec<i32>, i32)>;

fn explored<S: System>(
    system: &S,
    bound: &Bound,
    instance: usize,
    cells: &[usize],
    options: &Options,
) -> Result<Found, Error> {
    let before = &bound.system.instances[..instance];
    let first: usize = before.iter().map(|i| i.rules.len()).sum();
    let system = Last::new(system, first, bound.system.instances[instance].rules.len());
    control_graph(&system, options, |state| {
        let values = cells.iter().map(|k| state[*k]).collect();
        (values, state.last().copied().unwrap_or(0))
    })
}

/// A system whose state also tells which rule of one machine fired last.
struct Last<'a, S> {
    system: &'a S,
    domains: Vec<Domain>,
    first: usize,
    rules: usize,
}

impl<'a, S: System> Last<'a, S> {
    fn new(system: &'a S, first: usize, rules: usize) -> Self {
        let mut domains = system.domains().to_vec();
        domains.push(Domain {
            lo: 0,
            hi: i32::try_from(rules).unwrap_or(i32::MAX),
        });
        Self {
            system,
            domains,
            first,
            rules,
        }
    }
}

impl<S: System> System for Last<'_, S> {
    type Work = S::Work;

    fn work(&self) -> S::Work {
        self.system.work()
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        self.system.combinations()
    }

    fn initial<C: Choices>(&self, work: &mut S::Work, choices: &mut C, state: &mut [i32]) {
        if let Some((last, inner)) = state.split_last_mut() {
            self.system.initial(work, choices, inner);
            *last = 0;
        }
    }

    fn next<C: Choices>(
        &self,
        work: &mut S::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        let (Some((_, inner)), Some((last, next))) = (before.split_last(), after.split_last_mut())
        else {
            return Err(Fault::OUT_OF_DOMAIN);
        };
        self.system.next(work, inner, choices, next)?;
        *last = 0;
        self.system.fired(work, &mut |rule| {
            if let Some(own) = rule.checked_sub(self.first).filter(|r| *r < self.rules) {
                *last = i32::try_from(own + 1).unwrap_or(0);
            }
        });
        Ok(())
    }

    fn atom<C: Choices>(
        &self,
        work: &mut S::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        self.system.atom(work, atom, choices)
    }

    fn discarded(&self, work: &S::Work) -> bool {
        self.system.discarded(work)
    }
}

fn picture(bound: &Bound, of: &Instance, cells: &[usize], found: &Found) -> Graph {
    let system = &bound.system;
    let values = |node: NodeIndex| &found.graph[node].0;
    let reached: BTreeSet<&Vec<i32>> = found.graph.node_indices().map(values).collect();
    let initial: BTreeSet<&Vec<i32>> = found.initial.iter().map(|n| values(*n)).collect();
    let mut all: BTreeSet<Vec<i32>> = reached.iter().map(|v| (*v).clone()).collect();
    if let [cell] = cells {
        let (lo, hi) = bound.states[*cell];
        all.extend((lo..=hi).map(|v| vec![v]));
    }
    // By what one control state leads to another, and what stays.
    let mut ways: BTreeMap<(&Vec<i32>, &Vec<i32>), BTreeSet<i32>> = BTreeMap::new();
    for edge in found.graph.edge_indices() {
        if let Some((from, to)) = found.graph.edge_endpoints(edge) {
            let rule = found.graph[to].1;
            ways.entry((values(from), values(to)))
                .or_default()
                .insert(rule);
        }
    }
    let named = |rules: &BTreeSet<i32>| -> Vec<String> {
        let name = |rule: &i32| {
            let rule = usize::try_from(rule - 1).ok().and_then(|k| of.rules.get(k));
            let full = rule.map_or("no rule", |r| r.name.as_str());
            full.rsplit('.').next().unwrap_or(full).to_owned()
        };
        rules.iter().map(name).collect()
    };
    let order: BTreeMap<&Vec<i32>, usize> = all.iter().enumerate().map(|(n, v)| (v, n)).collect();
    let nodes = all.iter().map(|state| {
        let shown: Vec<String> = cells
            .iter()
            .zip(state)
            .map(|(k, v)| system.show(system.states[*k].var.ty, i64::from(*v)))
            .collect();
        Node {
            label: shown.join("\n"),
            note: String::new(),
            reached: reached.contains(state),
            initial: initial.contains(state),
        }
    });
    let edges = ways.iter().filter_map(|((from, to), rules)| {
        Some(Edge {
            from: *order.get(*from)?,
            to: *order.get(*to)?,
            labels: named(rules),
        })
    });
    let variables: Vec<&str> = cells
        .iter()
        .map(|k| system.states[*k].var.name.as_str())
        .collect();
    let limits = if found.complete {
        ""
    } else {
        " (incomplete: a limit was reached)"
    };
    Graph {
        title: format!("{}{limits}", variables.join(", ")),
        nodes: nodes.collect(),
        edges: edges.collect(),
    }
}
