//! Transition systems over an and-inverter graph: latches with their start and next values, inputs, and what is known of both.

use super::graph::{Graph, Lit, Node, value};
use super::word::Word;

/// A bit of the state.
#[derive(Clone, Debug)]
pub struct Latch {
    /// Its name.
    pub name: String,
    /// Its variable.
    pub lit: Lit,
    /// Its value at the start; none for any that the conditions on the start permit.
    pub init: Option<bool>,
    /// What it becomes in a cycle.
    pub next: Lit,
}

/// A bit that the environment chooses anew in each cycle.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// Its variable.
    pub lit: Lit,
}

/// A transition system. Whatever state satisfies the conditions and whatever the inputs, the latches have a next value.
///
/// What is required of variables with nothing in common must be satisfiable apart from each other: the engines leave out the
/// requirements on variables on which a property does not depend.
#[derive(Clone, Debug, Default)]
pub struct Netlist {
    /// All functions.
    pub graph: Graph,
    /// The state.
    pub latches: Vec<Latch>,
    /// The inputs.
    pub inputs: Vec<Input>,
    /// Conditions on the latches at the start, beside their start values.
    pub start: Vec<Lit>,
    /// Conditions on the latches that hold in every reachable state: they must follow from themselves and from the start.
    pub invariants: Vec<Lit>,
    /// Conditions on the inputs of each cycle.
    pub assumed: Vec<Lit>,
}

impl Netlist {
    /// A new latch, whose next value is itself until it is given another one.
    pub fn latch(&mut self, name: String, init: Option<bool>) -> Lit {
        let lit = self.graph.leaf();
        self.latches.push(Latch {
            name,
            lit,
            init,
            next: lit,
        });
        lit
    }

    /// That a number over the latches falls in a cycle, and that it rises.
    pub fn moves(&mut self, number: &Word) -> [Lit; 2] {
        let then = number.placed(&moved(self, self.graph.size()));
        let graph = &mut self.graph;
        [then.less(graph, number), number.less(graph, &then)]
    }

    /// A new input.
    pub fn input(&mut self, name: String) -> Lit {
        let lit = self.graph.leaf();
        self.inputs.push(Input { name, lit });
        lit
    }
}

/// A run from a start state: the values of those latches and inputs that matter, by their places in the netlist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// Latches at the start.
    pub start: Vec<Option<bool>>,
    /// Inputs of each cycle.
    pub cycles: Vec<Vec<Option<bool>>>,
}

/// A question: is there a run that ends in a cycle with `bad`? Of the netlist it has only what `bad` depends on, over any number
/// of cycles: its cone of influence.
pub struct Problem<'a> {
    pub(super) netlist: &'a Netlist,
    /// What is looked for.
    pub(super) bad: Lit,
    /// Places of the latches in the cone.
    pub(super) latches: Vec<usize>,
    /// Places of the inputs in the cone.
    pub(super) inputs: Vec<usize>,
    pub(super) start: Vec<Lit>,
    pub(super) invariants: Vec<Lit>,
    pub(super) assumed: Vec<Lit>,
    /// The nodes of the cone, each after its parts.
    pub(super) nodes: Vec<usize>,
}

impl<'a> Problem<'a> {
    /// Whether a cycle with `bad` can be reached.
    pub fn new(netlist: &'a Netlist, bad: Lit) -> Self {
        Problem::with(netlist, bad, &[])
    }

    /// The same of a cone that has these functions too.
    pub fn with(netlist: &'a Netlist, bad: Lit, also: &[Lit]) -> Self {
        let graph = &netlist.graph;
        let mut seen = graph.below(also.iter().copied().chain([bad, Lit::FALSE]));
        let conditions: Vec<(Lit, Vec<usize>)> = [
            &netlist.start[..],
            &netlist.invariants[..],
            &netlist.assumed[..],
        ]
        .concat()
        .into_iter()
        .map(|lit| (lit, support(graph, lit)))
        .collect();
        let mut followed = vec![false; netlist.latches.len()];
        let mut joined = vec![false; conditions.len()];
        loop {
            let mut roots = Vec::new();
            for (latch, followed) in netlist.latches.iter().zip(&mut followed) {
                if seen[latch.lit.node()] && !*followed {
                    *followed = true;
                    roots.push(latch.next);
                }
            }
            for ((lit, support), joined) in conditions.iter().zip(&mut joined) {
                if !*joined && support.iter().any(|node| seen[*node]) {
                    *joined = true;
                    roots.push(*lit);
                }
            }
            if roots.is_empty() {
                break;
            }
            graph.mark(roots, &mut seen);
        }
        let inside = |list: &[Lit]| -> Vec<Lit> {
            let kept = list.iter().filter(|lit| match lit.known() {
                Some(value) => !value,
                None => seen[lit.node()] && support(graph, **lit).iter().all(|node| seen[*node]),
            });
            kept.copied().collect()
        };
        Problem {
            netlist,
            bad,
            latches: places(netlist.latches.iter().map(|l| l.lit), &seen),
            inputs: places(netlist.inputs.iter().map(|i| i.lit), &seen),
            start: inside(&netlist.start),
            invariants: inside(&netlist.invariants),
            assumed: inside(&netlist.assumed),
            nodes: (0..graph.size()).filter(|node| seen[*node]).collect(),
        }
    }

    /// The latches of the cone, by their places.
    pub fn latches(&self) -> &[usize] {
        &self.latches
    }

    /// The netlist.
    pub fn netlist(&self) -> &'a Netlist {
        self.netlist
    }

    /// What is looked for.
    pub fn bad(&self) -> Lit {
        self.bad
    }

    pub(super) fn graph(&self) -> &'a Graph {
        &self.netlist.graph
    }

    /// The nodes of the cone over another graph, where the latches and inputs of the cone are these.
    pub(super) fn copy(&self, graph: &mut Graph, state: &[Lit], inputs: &[Lit]) -> Vec<Lit> {
        let original = self.graph();
        let mut map = vec![Lit::FALSE; original.size()];
        for (latch, lit) in self.cone().zip(state) {
            map[latch.lit.node()] = *lit;
        }
        for (place, lit) in self.inputs.iter().zip(inputs) {
            map[self.netlist.inputs[*place].lit.node()] = *lit;
        }
        for node in &self.nodes {
            if let Node::And(a, b) = original.node(*node) {
                let a = map[a.node()].flipped(a.negated());
                let b = map[b.node()].flipped(b.negated());
                map[*node] = graph.and(a, b);
            }
        }
        map
    }

    /// The latches of the cone.
    pub(super) fn cone(&self) -> impl Iterator<Item = &'a Latch> + '_ {
        let netlist = self.netlist;
        self.latches.iter().map(move |k| &netlist.latches[*k])
    }

    /// What holds at the start, start values included, beside the invariants.
    pub(super) fn begin(&self) -> impl Iterator<Item = Lit> + '_ {
        let fixed = self.cone();
        let fixed = fixed.filter_map(|latch| Some(latch.lit.flipped(!latch.init?)));
        self.start.iter().copied().chain(fixed)
    }

    /// Numbers of latches, inputs and conjunctions in the cone.
    pub fn size(&self) -> (usize, usize, usize) {
        let and = |node: &&usize| matches!(self.graph().node(**node), Node::And(..));
        (
            self.latches.len(),
            self.inputs.len(),
            self.nodes.iter().filter(and).count(),
        )
    }

    /// Whether a run is one of the netlist and ends in a cycle with `bad`.
    pub fn shows(&self, run: &Run) -> bool {
        self.play(run, |_| {})
    }

    /// The same; `each` is told the values of all nodes in each cycle.
    pub fn play(&self, run: &Run, mut each: impl FnMut(&[bool])) -> bool {
        let netlist = self.netlist;
        let holds = |values: &[bool], list: &[Lit]| list.iter().all(|lit| value(values, *lit));
        let mut state: Vec<bool> = (netlist.latches.iter().zip(&run.start))
            .map(|(latch, given)| given.or(latch.init).unwrap_or(false))
            .collect();
        let right = |place: &usize| {
            let init = netlist.latches[*place].init;
            init.is_none_or(|init| state[*place] == init)
        };
        if !self.latches.iter().all(right) {
            return false;
        }
        for (number, cycle) in run.cycles.iter().enumerate() {
            let mut leaves = vec![false; netlist.graph.size()];
            for (latch, value) in netlist.latches.iter().zip(&state) {
                leaves[latch.lit.node()] = *value;
            }
            for (input, value) in netlist.inputs.iter().zip(cycle) {
                leaves[input.lit.node()] = value.unwrap_or(false);
            }
            let values = netlist.graph.values(|node| leaves[node]);
            let begins = number > 0 || holds(&values, &self.start);
            if !begins || !holds(&values, &self.invariants) || !holds(&values, &self.assumed) {
                return false;
            }
            each(&values);
            if number + 1 == run.cycles.len() {
                return value(&values, self.bad);
            }
            state = (netlist.latches.iter())
                .map(|latch| value(&values, latch.next))
                .collect();
        }
        false
    }
}

/// By node of a graph of this size, what a latch becomes in a cycle; all else stays.
pub(super) fn moved(netlist: &Netlist, size: usize) -> Vec<Lit> {
    let mut map: Vec<Lit> = (0..size).map(Lit::of).collect();
    for latch in &netlist.latches {
        map[latch.lit.node()] = latch.next;
    }
    map
}

/// Conditions on the latches over the state after the cycle, in a graph that has grown from that of the netlist.
pub(super) fn after(graph: &mut Graph, netlist: &Netlist, conditions: &[Lit]) -> Vec<Lit> {
    let mut map = moved(netlist, graph.size());
    let needed = graph.below(conditions.iter().copied());
    for node in 0..needed.len() {
        if !needed[node] {
            continue;
        }
        if let Node::And(a, b) = graph.node(node) {
            let a = map[a.node()].flipped(a.negated());
            let b = map[b.node()].flipped(b.negated());
            map[node] = graph.and(a, b);
        }
    }
    let moved = conditions.iter();
    moved
        .map(|lit| map[lit.node()].flipped(lit.negated()))
        .collect()
}

/// The variables that a function depends on.
fn support(graph: &Graph, lit: Lit) -> Vec<usize> {
    let below = graph.below([lit]);
    (0..below.len())
        .filter(|node| below[*node] && graph.node(*node) == Node::Leaf)
        .collect()
}

fn places(variables: impl Iterator<Item = Lit>, seen: &[bool]) -> Vec<usize> {
    variables
        .enumerate()
        .filter(|(_, lit)| seen[lit.node()])
        .map(|(k, _)| k)
        .collect()
}
