//! Symmetries of a system (automorphisms): exchanges of two instances of an array that change nothing.
//!
//! A [`Symmetry`] renames instances, their cells, inputs and, for an input that only says which instance is meant, its
//! values. [`symmetries`] guesses such renamings from the names (`axis[1]` against `axis[2]`) and **checks** each: applied
//! to every rule, named expression, range and initial value it must give the system itself, up to the order of the operands
//! of commutative operators. A wrong guess is refused; so what is found is an automorphism of the transition system.
//!
//! The instances of a system step one after the other. Within a cycle an instance sees of another one only the state after
//! its step, and only of one that has stepped before: that is checked too. So the renamed order of the instances makes the
//! same cycle.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::bind::Bound;
use crate::ir::{BinaryOp, Form, Node, Property, Space, Stmt};

mod learn;

/// A renaming that maps the system onto itself. It undoes itself when applied twice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Symmetry {
    /// For each state variable the one that takes its place.
    pub states: Vec<u32>,
    /// For each input the one that takes its place.
    pub inputs: Vec<u32>,
    /// For inputs whose values change too: (value, new value), for those values that do.
    pub values: Vec<BTreeMap<i64, i64>>,
    lazies: Vec<u32>,
}

/// A property as a text that two properties share exactly if they claim the same, up to the order of commutative operands;
/// none if the renaming cannot be applied to it.
pub fn claim(bound: &Bound, property: &Property, under: Option<&Symmetry>) -> Option<String> {
    let names = Names { under };
    let system = &bound.system;
    let mut out = String::new();
    let mut atom = |name: &str, k: usize| -> Option<()> {
        let _ = write!(out, "{name} {};", names.text(&system.atoms[k])?);
        Some(())
    };
    match &property.form {
        Form::Always { when, then } => {
            if let Some(when) = when {
                atom("when", *when)?;
            }
            atom("then", *then)?;
        }
        Form::LeadsTo {
            when,
            goal,
            within,
            fair,
            assuming,
        } => {
            atom("when", *when)?;
            atom("leads to", *goal)?;
            if let Some(k) = assuming {
                atom("assuming", *k)?;
            }
            let fair: Option<Vec<String>> =
                fair.iter().map(|k| names.text(&system.atoms[*k])).collect();
            let mut fair = fair?;
            fair.sort();
            let within = within.as_ref().map(|n| bound.constant(n));
            let _ = write!(out, "fair {fair:?} within {within:?}");
        }
        Form::Unless {
            when,
            holds,
            unless,
        } => {
            atom("when", *when)?;
            atom("holds", *holds)?;
            atom("unless", *unless)?;
        }
        Form::CanAlwaysReach { goal, using } => {
            if let Some(k) = using {
                atom("using", *k)?;
            }
            atom("can always reach", *goal)?;
        }
        Form::Reachable { goal } => atom("reachable", *goal)?,
        Form::Independent {
            observe,
            of,
            condition,
        } => {
            if let Some(k) = condition {
                atom("while", *k)?;
            }
            let observed: Option<Vec<String>> = observe
                .iter()
                .map(|k| names.text(&system.observed[*k]))
                .collect();
            let mut of: Vec<u32> = of.iter().map(|k| names.input(*k as u32)).collect();
            of.sort_unstable();
            let _ = write!(out, "observe {:?} of {of:?}", observed?);
        }
    }
    Some(out)
}

/// Exchanges of two instances that map the system onto itself; `bound` has its parameter values in its expressions
/// (see [`crate::slice::Slicer::whole`]). Together they generate a group. Those that follow from the ones before them
/// by exchanging through a third instance are left out.
pub fn symmetries(bound: &Bound) -> Vec<Symmetry> {
    if !steps_in_order(bound) {
        return Vec::new();
    }
    let arrays = arrays(bound.system.instances.iter().map(|i| i.name.as_str()));
    let inputs = arrays_of_inputs(bound);
    let mut out = Vec::new();
    // Instances of one array that are known to be exchangeable have the same least representative.
    let mut done: BTreeMap<(String, i64), i64> = BTreeMap::new();
    for (base, indices) in &arrays {
        for (a, &i) in indices.iter().enumerate() {
            for &j in &indices[a + 1..] {
                let least = |k: i64| done.get(&(base.clone(), k)).copied().unwrap_or(k);
                if least(i) == least(j) {
                    continue;
                }
                let Some((found, bases)) = exchange(bound, base, &arrays, &inputs, (i, j)) else {
                    continue;
                };
                for base in bases {
                    let least = |k: i64| done.get(&(base.clone(), k)).copied().unwrap_or(k);
                    let (to, from) = (least(i).min(least(j)), least(i).max(least(j)));
                    let all = arrays.get(&base).into_iter().flatten();
                    let moved: Vec<i64> = all.copied().filter(|k| least(*k) == from).collect();
                    for k in moved {
                        done.insert((base.clone(), k), to);
                    }
                }
                out.push(found);
            }
        }
    }
    out
}

type Arrays = BTreeMap<String, Vec<i64>>;

/// `base[i]` at the start of a name: base, index, what follows.
fn indexed(name: &str) -> Option<(&str, i64, &str)> {
    let (base, rest) = name.split_once('[')?;
    let (index, rest) = rest.split_once(']')?;
    (!base.contains('.')).then_some(())?;
    Some((base, index.parse().ok()?, rest))
}

fn arrays<'n>(names: impl Iterator<Item = &'n str>) -> Arrays {
    let mut out = Arrays::new();
    for (base, index, _) in names.filter_map(indexed) {
        out.entry(base.to_owned()).or_default().push(index);
    }
    out
}

/// Input arrays of the system itself, not the free ports of instance arrays.
fn arrays_of_inputs(bound: &Bound) -> Arrays {
    let names = bound.system.inputs.iter().map(|v| v.name.as_str());
    arrays(names.filter(|n| indexed(n).is_some_and(|(.., rest)| rest.is_empty())))
}

/// The first guess that is an automorphism, with the instance arrays it exchanges: index i against j in every array that has
/// both, with or without the input arrays; then in the array `base` alone.
fn exchange(
    bound: &Bound,
    base: &str,
    arrays: &Arrays,
    inputs: &Arrays,
    (i, j): (i64, i64),
) -> Option<(Symmetry, Vec<String>)> {
    let both = |all: &Arrays| -> Vec<String> {
        let has = all.iter().filter(|(_, k)| k.contains(&i) && k.contains(&j));
        has.map(|(base, _)| base.clone()).collect()
    };
    let (every, extra) = (both(arrays), both(inputs));
    let alone = vec![base.to_owned()];
    for instances in [&every, &alone] {
        for extra in [extra.as_slice(), &[]] {
            let bases: Vec<&str> = instances.iter().chain(extra).map(String::as_str).collect();
            let Some(mut guess) = renamed(bound, &bases, (i, j)) else {
                continue;
            };
            learn::values(bound, &mut guess);
            if guess.holds(bound) {
                return Some((guess, instances.clone()));
            }
        }
    }
    None
}

/// The renaming of every cell and named expression by its name; none if a name has no counterpart.
fn renamed(bound: &Bound, bases: &[&str], (i, j): (i64, i64)) -> Option<Symmetry> {
    let system = &bound.system;
    let swapped = |name: &str| match indexed(name) {
        Some((base, k, rest)) if bases.contains(&base) && (k == i || k == j) => {
            format!("{base}[{}]{rest}", if k == i { j } else { i })
        }
        _ => name.to_owned(),
    };
    let places = |names: &[&str]| -> Option<Vec<u32>> {
        let numbers: BTreeMap<&str, u32> = names.iter().copied().zip(0..).collect();
        // Two things of one name could not be told apart.
        (numbers.len() == names.len()).then_some(())?;
        let place = |name: &&str| numbers.get(swapped(name).as_str()).copied();
        names.iter().map(place).collect()
    };
    let states: Vec<&str> = system.states.iter().map(|s| s.var.name.as_str()).collect();
    let inputs: Vec<&str> = system.inputs.iter().map(|v| v.name.as_str()).collect();
    let lazies: Vec<&str> = system.lazies.iter().map(|l| l.name.as_str()).collect();
    Some(Symmetry {
        states: places(&states)?,
        inputs: places(&inputs)?,
        values: vec![BTreeMap::new(); inputs.len()],
        lazies: places(&lazies)?,
    })
}

/// Whether each instance sees of another one only what has been decided before in the cycle.
fn steps_in_order(bound: &Bound) -> bool {
    let system = &bound.system;
    for (place, instance) in system.instances.iter().enumerate() {
        let mut seen = vec![false; system.lazies.len()];
        let mut waiting: Vec<&Node> = Vec::new();
        for rule in &instance.rules {
            waiting.push(&rule.when);
            for statement in &rule.then {
                statement.expressions(&mut |n| waiting.push(n));
            }
        }
        let mut fine = true;
        while let Some(node) = waiting.pop() {
            node.visit(&mut |n| match n {
                Node::Lazy(k) => {
                    let new = !std::mem::replace(&mut seen[*k as usize], true);
                    waiting.extend(new.then(|| &system.lazies[*k as usize].value));
                }
                Node::Cell(Space::Now, cell)
                | Node::Element {
                    space: Space::Now,
                    base: cell,
                    ..
                } => {
                    let mut owners = system.instances.iter().take(place + 1);
                    fine &= owners.any(|i| i.states.contains(cell));
                }
                _ => {}
            });
        }
        if !fine {
            return false;
        }
    }
    true
}

impl Symmetry {
    /// Whether it maps the system onto itself.
    fn holds(&self, bound: &Bound) -> bool {
        self.maps_cells(bound) && self.maps_expressions(bound) == Some(true)
    }

    fn maps_cells(&self, bound: &Bound) -> bool {
        let twice = |map: &[u32]| {
            let mut all = map.iter().enumerate();
            all.all(|(k, to)| map[*to as usize] as usize == k)
        };
        let states = (0..bound.states.len()).all(|k| {
            let to = self.states[k] as usize;
            bound.states[k] == bound.states[to] && bound.initial[k] == bound.initial[to]
        });
        let inputs = (0..bound.inputs.len()).all(|k| {
            let to = self.inputs[k] as usize;
            let (lo, hi) = (i64::from(bound.inputs[k].0), i64::from(bound.inputs[k].1));
            let values = &self.values[k];
            bound.inputs[k] == bound.inputs[to]
                && *values == self.values[to]
                && values.iter().all(|(from, to)| {
                    (lo..=hi).contains(from) && values.get(to).is_some_and(|back| back == from)
                })
        });
        states && inputs && twice(&self.states) && twice(&self.inputs) && twice(&self.lazies)
    }

    fn maps_expressions(&self, bound: &Bound) -> Option<bool> {
        let system = &bound.system;
        let here = Names { under: None };
        let there = Names { under: Some(self) };
        for (k, lazy) in system.lazies.iter().enumerate() {
            let image = &system.lazies[self.lazies[k] as usize].value;
            if there.text(&lazy.value)? != here.text(image)? {
                return Some(false);
            }
        }
        for instance in &system.instances {
            let (Some(first), Some(last)) =
                (instance.states.clone().min(), instance.states.clone().max())
            else {
                // Without state its rules assign nothing.
                continue;
            };
            let ends = [self.states[first as usize], self.states[last as usize]];
            let image = system
                .instances
                .iter()
                .find(|i| ends.iter().all(|cell| i.states.contains(cell)))?;
            if image.states.len() != instance.states.len()
                || image.rules.len() != instance.rules.len()
            {
                return Some(false);
            }
            for (rule, counterpart) in instance.rules.iter().zip(&image.rules) {
                if there.text(&rule.when)? != here.text(&counterpart.when)?
                    || there.statements(&rule.then)? != here.statements(&counterpart.then)?
                {
                    return Some(false);
                }
            }
        }
        Some(true)
    }
}

/// Writes expressions in a form that does not depend on the order of commutative operands, renamed on the way.
struct Names<'a> {
    under: Option<&'a Symmetry>,
}

impl Names<'_> {
    fn state(&self, k: u32) -> u32 {
        self.under.map_or(k, |s| s.states[k as usize])
    }

    fn input(&self, k: u32) -> u32 {
        self.under.map_or(k, |s| s.inputs[k as usize])
    }

    /// None if the expression uses an input with renamed values otherwise than to compare it with a constant, or an array whose elements
    /// do not stay together.
    fn text(&self, node: &Node) -> Option<String> {
        Some(match node {
            Node::Const(v) => v.to_string(),
            Node::Cell(space, k) => self.cells(*space, *k, 1)?,
            Node::Lazy(k) => format!("l{}", self.under.map_or(*k, |s| s.lazies[*k as usize])),
            Node::Element {
                space,
                base,
                lo,
                len,
                index,
            } => {
                let cells = self.cells(*space, *base, *len)?;
                format!("{cells}+{len}[{}-{lo}]", self.text(index)?)
            }
            Node::Binary(op, a, b) => self.binary(*op, a, b)?,
            Node::Not(a) => format!("not({})", self.text(a)?),
            Node::Neg(a) => format!("neg({})", self.text(a)?),
            Node::Abs(a) => format!("abs({})", self.text(a)?),
            Node::Sel(g, a, b) => self.call("sel", &[g, a, b], false)?,
            Node::Mux(k, values) => {
                let all: Vec<&Node> = std::iter::once(k.as_ref()).chain(values).collect();
                self.call("mux", &all, false)?
            }
            Node::Min(values) => self.call("min", &values.iter().collect::<Vec<_>>(), true)?,
            Node::Max(values) => self.call("max", &values.iter().collect::<Vec<_>>(), true)?,
        })
    }

    fn cells(&self, space: Space, base: u32, len: u32) -> Option<String> {
        let place = |k: u32| match space {
            Space::Param => k,
            Space::Before | Space::Now => self.state(k),
            Space::Input => self.input(k),
        };
        let first = place(base);
        (0..len)
            .all(|k| place(base + k) == first + k)
            .then_some(())?;
        if let (Space::Input, Some(under)) = (space, self.under) {
            let mut cells = base..base + len;
            cells
                .all(|k| under.values[k as usize].is_empty())
                .then_some(())?;
        }
        Some(format!("{space:?}{first}"))
    }

    fn call(&self, name: &str, parts: &[&Node], commutes: bool) -> Option<String> {
        let texts: Option<Vec<String>> = parts.iter().map(|n| self.text(n)).collect();
        let mut texts = texts?;
        if commutes {
            texts.sort();
        }
        Some(format!("{name}({})", texts.join(",")))
    }

    fn binary(&self, op: BinaryOp, a: &Node, b: &Node) -> Option<String> {
        use BinaryOp::{Add, And, Eq, Ge, Gt, Le, Lt, Mul, Ne, Or, Xor};
        if let (Eq | Ne, Some((input, value))) = (op, selection(a, b)) {
            let value = self.under.map_or(value, |s| {
                let renamed = s.values[input as usize].get(&value);
                renamed.copied().unwrap_or(value)
            });
            return Some(format!("{op:?}(input{}={value})", self.input(input)));
        }
        match op {
            // The same operator below itself: one list of operands.
            And | Or | Add => {
                let mut parts = Vec::new();
                flat(op, a, &mut parts);
                flat(op, b, &mut parts);
                self.call(&format!("{op:?}"), &parts, true)
            }
            Xor | Eq | Ne | Mul => self.call(&format!("{op:?}"), &[a, b], true),
            Gt => self.call(&format!("{Lt:?}"), &[b, a], false),
            Ge => self.call(&format!("{Le:?}"), &[b, a], false),
            _ => self.call(&format!("{op:?}"), &[a, b], false),
        }
    }

    fn statements(&self, list: &[Stmt]) -> Option<String> {
        let mut out = String::new();
        for statement in list {
            match statement {
                Stmt::Assign {
                    base,
                    index,
                    value,
                    checked,
                    ..
                } => {
                    let len = index.as_ref().map_or(1, |(_, _, len)| *len);
                    out.push_str(&self.cells(Space::Now, *base, len)?);
                    if let Some((k, lo, len)) = index {
                        let _ = write!(out, "+{len}[{}-{lo}]", self.text(k)?);
                    }
                    let _ = write!(out, ":={} {checked};", self.text(value)?);
                }
                Stmt::If(branches, rest) => {
                    for (guard, body) in branches {
                        let _ = write!(out, "if {}", self.text(guard)?);
                        let _ = write!(out, "{{{}}}", self.statements(body)?);
                    }
                    let _ = write!(out, "else{{{}}}", self.statements(rest)?);
                }
            }
        }
        Some(out)
    }
}

/// An input and the constant it is compared with.
fn selection(a: &Node, b: &Node) -> Option<(u32, i64)> {
    match (a, b) {
        (Node::Cell(Space::Input, k), Node::Const(v))
        | (Node::Const(v), Node::Cell(Space::Input, k)) => Some((*k, *v)),
        _ => None,
    }
}

fn flat<'n>(op: BinaryOp, node: &'n Node, out: &mut Vec<&'n Node>) {
    match node {
        Node::Binary(same, a, b) if *same == op => {
            flat(op, a, out);
            flat(op, b, out);
        }
        other => out.push(other),
    }
}
