//! Properties of infinite runs: response under fairness.

use crate::choices::Odometer;
use crate::cursor::Leaf;
use crate::explore::{Decision, Evidence, Tail, sign_test};
use crate::graph::{Components, Edge, Graph, Mark, Rules, Walker};
use crate::model::Model;
use crate::pack::Key;
use crate::process::{Any, Process};
use crate::property::Form;
use crate::report::Verdict;
use crate::response::Response;
use crate::set::Set;
use crate::stages::Condition;
use crate::trace::Request;
use std::collections::{HashMap, VecDeque};
use std::sync::Arc;

/// The pending cycles of a response, and the components in which a fair run can stay forever.
struct Pending<K> {
    graph: Graph<K>,
    components: Components,
    /// For each component: its inner edges satisfy every fairness condition.
    fair: Vec<bool>,
    /// For each component: a fair one can be reached.
    bad: Vec<bool>,
    all: u32,
}

/// Judges a response without a bound: it is violated by a run that stays forever in cycles without `goal`, with
/// `assuming` in each of them and every fairness condition in infinitely many. Such a run ends up in one strongly
/// connected component of these cycles, and a component allows one if its inner edges satisfy every condition.
pub(crate) fn fair<'a, K: Key>(
    model: &'a Model<'a, Any<'a>, K>,
    form: &'a Form,
    response: Response,
    fair: &'a [usize],
    pending: &Set<K>,
    witness: Evidence<'a, K>,
    held: u64,
) -> Decision<'a, K> {
    let Response { goal, assuming, .. } = response;
    let label = move |process: &mut dyn Process, choices: &mut Odometer, _: K| {
        let mut eval = model.eval(process, choices);
        if eval.atom(goal) || !eval.given(assuming) {
            return Mark::Outside;
        }
        Mark::Edge(fair.iter().enumerate().fold(0, |mask, (bit, atom)| {
            mask | u32::from(eval.atom(*atom)) << bit
        }))
    };
    let waits = assuming.iter().map(|atom| (*atom, true));
    let waits: Condition = waits.chain([(goal, false)]).collect();
    let met = fair.iter().map(|atom| vec![(*atom, true)]);
    let rules = Rules {
        rule: &label,
        mark: &|marks, _| match marks & 1 {
            0 => Mark::Outside,
            _ => Mark::Edge((marks >> 1) as u32),
        },
    };
    let conditions: Vec<Condition> = [waits].into_iter().chain(met).collect();
    let (mut walkers, seeds) = (Walker::all(model, &conditions), pending.sorted());
    let graph = Graph::build(model, &seeds, &rules, &mut walkers, held, u64::MAX);
    let Some(graph) = graph else {
        return Verdict::Inconclusive.into();
    };
    let all = (1u32 << fair.len()) - 1;
    let found = Pending::new(graph, all);
    if (0..found.graph.seeds).all(|seed| !found.is_bad(seed)) {
        return Decision {
            verdict: Verdict::Holds,
            bound: None,
            fastest: None,
            evidence: witness,
        };
    }
    let shared = Arc::new(found);
    let other = Arc::clone(&shared);
    let test = sign_test(form, move |sign, after| {
        sign.pending
            && other
                .graph
                .number(after)
                .is_some_and(|node| other.is_bad(node))
    });
    let tail: Tail<K> = Box::new(move |end| {
        let mut cursor = model.retracing();
        let (edges, start) = shared.lasso(shared.graph.number(end)?)?;
        let mut steps = Vec::new();
        for (from, edge) in edges {
            let target = shared.graph.key(edge.to);
            let (choices, _) = cursor.first(
                &model.packer,
                shared.graph.key(from),
                |process, choices, leaf| {
                    leaf == Leaf::To(target)
                        && label(&mut **process, choices, target) == Mark::Edge(edge.label)
                },
            )?;
            steps.push(choices);
        }
        Some((steps, Some(start)))
    });
    let request = Request {
        at: None,
        test,
        state: None,
    };
    Decision {
        verdict: Verdict::Violated,
        bound: None,
        fastest: None,
        evidence: Evidence::Run(request, Some(tail)),
    }
}

impl<K: Key> Pending<K> {
    fn new(graph: Graph<K>, all: u32) -> Self {
        let components = graph.components(|_| true);
        let mut labels = vec![0; components.cyclic.len()];
        for node in 0..graph.nodes() {
            let component = components.of[node as usize];
            for edge in graph
                .edges(node)
                .iter()
                .filter(|e| components.of[e.to as usize] == component)
            {
                labels[component as usize] |= edge.label;
            }
        }
        let fair: Vec<bool> = components
            .cyclic
            .iter()
            .zip(labels)
            .map(|(c, label)| *c && label == all)
            .collect();
        let bad = components.reaching(
            &graph,
            |_| true,
            |node| fair[components.of[node as usize] as usize],
        );
        Pending {
            graph,
            components,
            fair,
            bad,
            all,
        }
    }

    fn component(&self, node: u32) -> usize {
        self.components.of[node as usize] as usize
    }

    fn is_bad(&self, node: u32) -> bool {
        self.bad[self.component(node)]
    }

    /// From a bad node to the nearest fair component and around in it, meeting every fairness condition.
    fn lasso(&self, start: u32) -> Option<(Vec<(u32, Edge)>, usize)> {
        let fair = |node: u32| self.fair[self.component(node)];
        let mut path = match fair(start) {
            true => Vec::new(),
            false => self.walk(start, |_| true, |edge| fair(edge.to))?,
        };
        let prefix = path.len();
        let entry = path.last().map_or(start, |(_, edge)| edge.to);
        let inside = |edge: Edge| self.component(edge.to) == self.component(entry);
        let (mut at, mut met) = (entry, 0);
        while met != self.all {
            path.extend(self.walk(at, inside, |edge| edge.label & !met != 0)?);
            met = path[prefix..]
                .iter()
                .fold(0, |met, (_, edge)| met | edge.label);
            at = path.last()?.1.to;
        }
        if at != entry || path.len() == prefix {
            path.extend(self.walk(at, inside, |edge| edge.to == entry)?);
        }
        Some((path, prefix))
    }

    /// A shortest path of allowed edges, one at least, whose last edge passes.
    fn walk(
        &self,
        from: u32,
        allowed: impl Fn(Edge) -> bool,
        pass: impl Fn(Edge) -> bool,
    ) -> Option<Vec<(u32, Edge)>> {
        let mut came: HashMap<u32, Option<(u32, Edge)>> = HashMap::from([(from, None)]);
        let mut queue = VecDeque::from([from]);
        while let Some(node) = queue.pop_front() {
            for edge in self
                .graph
                .edges(node)
                .iter()
                .copied()
                .filter(|e| allowed(*e))
            {
                if pass(edge) {
                    let mut path = vec![(node, edge)];
                    let mut back = node;
                    while let Some(Some(step)) = came.get(&back) {
                        path.push(*step);
                        back = step.0;
                    }
                    path.reverse();
                    return Some(path);
                }
                came.entry(edge.to).or_insert_with(|| {
                    queue.push_back(edge.to);
                    Some((node, edge))
                });
            }
        }
        None
    }
}
