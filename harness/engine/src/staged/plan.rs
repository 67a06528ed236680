//! Live variables between the steps of the instances: what has to be known before each of them, and what may be forgotten.

use std::collections::BTreeSet;
use std::sync::Arc;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::fold::folded;
use stillpoint_lang::ir::{Node, Space, Stmt, System};
use stillpoint_model::Condition;

use super::conditions;
use super::recall::{NONE, Places};

/// What a stage can leave to a later one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Cell {
    /// A state variable that was stepped.
    Now(usize),
    /// An input, if it was read.
    Input(usize),
    /// A named expression that was evaluated.
    Named(usize),
}

/// The step of one instance.
pub(super) struct Stage {
    /// State variables whose values before the cycle it may look at, its own among them.
    pub(super) reads: Vec<usize>,
    /// Its own state variables.
    pub(super) writes: Vec<usize>,
    /// Named expressions that are evaluated after its step, for later.
    pub(super) forced: Vec<Node>,
    /// Combinations of the inputs that it may read.
    pub(super) combinations: u64,
    /// The number of its first rule.
    pub(super) first_rule: usize,
    pub(super) places: Arc<Places>,
}

impl Places {
    /// Of these state variables and of what is kept before the stage.
    fn new(bound: &Bound, reads: &[usize], kept: &[Cell]) -> Self {
        let mut places = Places {
            before: vec![NONE; bound.states.len()],
            now: vec![NONE; bound.states.len()],
            inputs: vec![NONE; bound.inputs.len()],
            names: vec![NONE; bound.system.lazies.len()],
        };
        for (place, k) in (0..).zip(reads) {
            places.before[*k] = place;
            places.now[*k] = place;
        }
        for (place, cell) in (reads.len() as u32..).zip(kept) {
            match cell {
                Cell::Now(k) => places.now[*k] = place,
                Cell::Input(k) => places.inputs[*k] = place,
                Cell::Named(k) => places.names[*k] = place,
            }
        }
        places
    }
}

/// Where the end of the last stage tells whether a condition holds.
pub(super) enum Mark {
    Fixed(bool),
    At(usize),
}

pub(super) struct Plan {
    /// The system, with further named expressions for parts of the conditions.
    pub(super) bound: Bound,
    pub(super) stages: Vec<Stage>,
    /// What is kept before the first stage, and after each one.
    pub(super) boundaries: Vec<Vec<Cell>>,
    pub(super) marks: Vec<Mark>,
}

impl Plan {
    pub(super) fn new(bound: &Bound, conditions: &[Condition]) -> Option<Self> {
        let number = bound.system.instances.len();
        if number < 2 {
            return None;
        }
        // What the parameter values settle reads nothing any more: stages look at less.
        let mut bound = folded(bound);
        let mut order = Order::new(&bound.system);
        let results = conditions::add(&mut bound.system, &mut order, conditions);
        let system = &bound.system;
        let mut live: BTreeSet<Cell> = BTreeSet::new();
        live.extend(results.iter().filter_map(|node| match node {
            Node::Lazy(k) => Some(Cell::Named(*k as usize)),
            _ => None,
        }));
        let mut boundaries = vec![live.iter().copied().collect::<Vec<_>>()];
        let mut stages = Vec::new();
        for stage in (0..number).rev() {
            let instance = &system.instances[stage];
            let mut needs = Needs::new(system, &order, stage);
            let mut forced = Vec::new();
            for cell in &live {
                match cell {
                    Cell::Now(k) if order.owner[*k] == stage => {}
                    Cell::Named(k) if order.name(*k) == stage => {
                        forced.push(Node::Lazy(*k as u32));
                        needs.after.push(*k);
                    }
                    _ => _ = needs.cells.insert(*cell),
                }
            }
            needs.rules()?;
            needs.forced()?;
            let own = instance.states.clone().map(|k| k as usize);
            needs.reads.extend(own.clone());
            let sizes = needs.inputs.iter().map(|k| {
                let (lo, hi) = bound.inputs[*k];
                u64::from(hi.abs_diff(lo)) + 1
            });
            let combinations = sizes.into_iter().try_fold(1, u64::checked_mul)?;
            let earlier = system.instances[..stage].iter();
            let reads: Vec<usize> = needs.reads.into_iter().collect();
            live = needs.cells;
            let kept: Vec<Cell> = live.iter().copied().collect();
            stages.push(Stage {
                places: Arc::new(Places::new(&bound, &reads, &kept)),
                reads,
                writes: own.collect(),
                forced,
                combinations,
                first_rule: earlier.map(|i| i.rules.len()).sum(),
            });
            boundaries.push(kept);
        }
        stages.reverse();
        boundaries.reverse();
        let last = boundaries.last()?;
        let mark = |node: &Node| match node {
            Node::Lazy(k) => {
                let place = last
                    .iter()
                    .position(|cell| *cell == Cell::Named(*k as usize));
                place.map(Mark::At)
            }
            Node::Const(v) => Some(Mark::Fixed(*v != 0)),
            _ => None,
        };
        let marks = results.iter().map(mark).collect::<Option<Vec<_>>>()?;
        Some(Self {
            bound,
            stages,
            boundaries,
            marks,
        })
    }
}

/// After which stage what is known.
pub(super) struct Order {
    /// The instance of each state variable.
    pub(super) owner: Vec<usize>,
    /// The first stage that reads an input; the last one if none does.
    inputs: Vec<usize>,
    /// The first stage that looks at a state variable as it was before the cycle.
    before: Vec<usize>,
    /// For each named expression the stage after which it can be evaluated.
    names: Vec<usize>,
}

impl Order {
    fn new(system: &System) -> Self {
        let mut owner = vec![0; system.states.len()];
        for (k, instance) in system.instances.iter().enumerate() {
            for cell in instance.states.clone() {
                owner[cell as usize] = k;
            }
        }
        let mut inputs = vec![system.instances.len() - 1; system.inputs.len()];
        let mut before = owner.clone();
        for (k, instance) in system.instances.iter().enumerate() {
            let mut seen = vec![false; system.lazies.len()];
            for rule in &instance.rules {
                let mut each = |node: &Node| {
                    cells_of(node, system, &mut seen, &mut |space, cell| {
                        let first = match space {
                            Space::Input => &mut inputs[cell],
                            Space::Before => &mut before[cell],
                            Space::Now | Space::Param => return,
                        };
                        *first = k.min(*first);
                    });
                };
                each(&rule.when);
                rule.then.iter().for_each(|s| s.expressions(&mut each));
            }
        }
        let mut order = Self {
            owner,
            inputs,
            before,
            names: Vec::new(),
        };
        let mut names = vec![None; system.lazies.len()];
        for k in 0..names.len() {
            order.find(system, k, &mut names);
        }
        order.names = names.into_iter().map(|n| n.unwrap_or(0)).collect();
        order
    }

    fn find(&self, system: &System, k: usize, names: &mut Vec<Option<usize>>) -> usize {
        if let Some(known) = names[k] {
            return known;
        }
        let mut last = 0;
        system.lazies[k].value.visit(&mut |node| {
            last = last.max(match node {
                Node::Lazy(inner) => self.find(system, *inner as usize, names),
                _ => self.own(node),
            });
        });
        names[k] = Some(last);
        last
    }

    /// For a cell itself.
    fn own(&self, node: &Node) -> usize {
        let (space, range) = match node {
            Node::Cell(space, k) => (*space, *k as usize..*k as usize + 1),
            Node::Element {
                space, base, len, ..
            } => (*space, *base as usize..(*base + *len) as usize),
            _ => return 0,
        };
        let of = match space {
            Space::Param => return 0,
            Space::Before => &self.before,
            Space::Now => &self.owner,
            Space::Input => &self.inputs,
        };
        of[range].iter().copied().max().unwrap_or(0)
    }

    /// The stage after which an expression can be evaluated without reading more than would be read anyway.
    pub(super) fn of(&self, node: &Node) -> usize {
        let mut last = 0;
        node.visit(&mut |node| {
            last = last.max(match node {
                Node::Lazy(k) => self.name(*k as usize),
                _ => self.own(node),
            });
        });
        last
    }

    /// The same for a named expression.
    pub(super) fn name(&self, k: usize) -> usize {
        self.names[k]
    }

    /// A further named expression.
    pub(super) fn push(&mut self, stage: usize) {
        self.names.push(stage);
    }
}

/// The cells that an expression may read.
fn cells_of(node: &Node, system: &System, seen: &mut [bool], each: &mut impl FnMut(Space, usize)) {
    let mut names = Vec::new();
    node.visit(&mut |node| match node {
        Node::Cell(space, k) => each(*space, *k as usize),
        Node::Element {
            space, base, len, ..
        } => (*base..*base + *len).for_each(|k| each(*space, k as usize)),
        Node::Lazy(k) => names.push(*k as usize),
        _ => {}
    });
    for k in names {
        if !std::mem::replace(&mut seen[k], true) {
            cells_of(&system.lazies[k].value, system, seen, each);
        }
    }
}

/// What one stage needs.
struct Needs<'a> {
    system: &'a System,
    order: &'a Order,
    stage: usize,
    /// What has to be kept before it.
    cells: BTreeSet<Cell>,
    reads: BTreeSet<usize>,
    inputs: BTreeSet<usize>,
    /// Names evaluated after the step.
    after: Vec<usize>,
}

impl<'a> Needs<'a> {
    fn new(system: &'a System, order: &'a Order, stage: usize) -> Self {
        Self {
            system,
            order,
            stage,
            cells: BTreeSet::new(),
            reads: BTreeSet::new(),
            inputs: BTreeSet::new(),
            after: Vec::new(),
        }
    }

    fn rules(&mut self) -> Option<()> {
        let system = self.system;
        let mut seen = vec![false; system.lazies.len()];
        for rule in &system.instances[self.stage].rules {
            self.node(&rule.when, false, &mut seen)?;
            rule.then
                .iter()
                .try_for_each(|s| self.statement(s, &mut seen))?;
        }
        Some(())
    }

    fn statement(&mut self, statement: &Stmt, seen: &mut [bool]) -> Option<()> {
        let mut fine = Some(());
        statement.expressions(&mut |node| {
            fine = fine.and_then(|()| self.node(node, false, seen));
        });
        fine
    }

    fn forced(&mut self) -> Option<()> {
        let mut seen = vec![false; self.system.lazies.len()];
        for k in std::mem::take(&mut self.after) {
            self.named(k, true, &mut seen)?;
        }
        Some(())
    }

    /// The name is evaluated here. `after`: after the step, where the variables of the instance have their new values.
    fn named(&mut self, k: usize, after: bool, seen: &mut [bool]) -> Option<()> {
        match std::mem::replace(&mut seen[k], true) {
            true => Some(()),
            false => {
                let value = &self.system.lazies[k].value;
                self.value(value, after, seen)
            }
        }
    }

    /// The value of a name. What it names must not change afterwards, or the name could have two values in one cycle.
    fn value(&mut self, node: &Node, after: bool, seen: &mut [bool]) -> Option<()> {
        let last = self.stage + usize::from(after);
        let mut fine = true;
        node.visit(&mut |node| {
            let range = match node {
                Node::Cell(Space::Now, k) => *k as usize..*k as usize + 1,
                Node::Element {
                    space: Space::Now,
                    base,
                    len,
                    ..
                } => *base as usize..(*base + *len) as usize,
                _ => return,
            };
            fine &= self.order.owner[range].iter().all(|owner| *owner < last);
        });
        match fine {
            true => self.node(node, after, seen),
            false => None,
        }
    }

    fn node(&mut self, node: &Node, after: bool, seen: &mut [bool]) -> Option<()> {
        let mut names = Vec::new();
        let mut cells = Vec::new();
        node.visit(&mut |node| match node {
            Node::Cell(space, k) => cells.push((*space, *k as usize..*k as usize + 1)),
            Node::Element {
                space, base, len, ..
            } => cells.push((*space, *base as usize..(*base + *len) as usize)),
            Node::Lazy(k) => names.push(*k as usize),
            _ => {}
        });
        for (space, range) in cells {
            for k in range {
                match space {
                    Space::Param => {}
                    Space::Before => _ = self.reads.insert(k),
                    Space::Now if self.order.owner[k] < self.stage => {
                        self.cells.insert(Cell::Now(k));
                    }
                    Space::Now => _ = self.reads.insert(k),
                    Space::Input => {
                        self.inputs.insert(k);
                        self.cells.insert(Cell::Input(k));
                    }
                }
            }
        }
        for k in names {
            match self.order.name(k) < self.stage {
                // It was evaluated before.
                true => _ = self.cells.insert(Cell::Named(k)),
                false => self.named(k, after, seen)?,
            }
        }
        Some(())
    }
}
