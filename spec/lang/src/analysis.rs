//! Static analysis of the rules under given parameter values: uncovered cases, overlaps, rules that cannot fire.
//!
//! The guards' variables (state, ports, nothing else) are enumerated on demand: only what a guard really reads.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use crate::bind::Bound;
use crate::diag::{Diagnostic, Diagnostics, Result};
use crate::eval::{Cells, Driven, Frame, UNSET, value};
use crate::ir::{Lazy, LazyKind, Node, Space, Stmt, Ty};
use crate::spec::Spec;

/// Evaluations after which the analysis of one machine gives up and says so.
const BUDGET: u64 = 250_000;

/// What the analysis found.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Analysis {
    /// Numbers (over the whole system) of rules that no state and input can make fire under these parameters.
    pub dead: Vec<usize>,
    /// Instances whose guards read too much to be enumerated.
    pub skipped: Vec<String>,
}

impl Spec {
    /// Analyses the rules of `bound`, which must come from this specification; `known` may be of others.
    ///
    /// # Errors
    /// Uncovered cases of machines without `otherwise = "stay"`, overlaps in `exclusive` machines, bad keys.
    pub fn analyse(&self, bound: &Bound, known: &Known) -> Result<Analysis> {
        let mut out = Analysis::default();
        let mut errors: Vec<Diagnostic> = Vec::new();
        let mut first = 0;
        for (k, instance) in bound.system.instances.iter().enumerate() {
            let located = &self.machines[&instance.machine];
            let machine = &located.def;
            let exclusive = match machine.order.as_ref().map(|t| (t, t.get_ref().as_str())) {
                None | Some((_, "exclusive")) => true,
                Some((_, "priority")) => false,
                Some((t, other)) => {
                    errors.push(
                        self.error(located.file, t.span(), format!("`order` cannot be `{other}`"))
                            .help("use \"exclusive\" (overlap is an error) or \"priority\" (the first rule wins)"),
                    );
                    true
                }
            };
            let stays = match machine
                .otherwise
                .as_ref()
                .map(|t| (t, t.get_ref().as_str()))
            {
                None => false,
                Some((_, "stay")) => true,
                Some((t, other)) => {
                    errors.push(
                        self.error(
                            located.file,
                            t.span(),
                            format!("`otherwise` cannot be `{other}`"),
                        )
                        .help("use \"stay\", or leave it out"),
                    );
                    true
                }
            };
            let (guards, reading) = Guards::of(bound, k, exclusive, stays);
            match known.of(guards).found() {
                None => out.skipped.push(instance.name.clone()),
                Some(found) => {
                    let dead = found.fires.iter().enumerate().filter(|(_, hit)| !**hit);
                    out.dead.extend(dead.map(|(n, _)| first + n));
                    if let (Some(case), false) = (&found.uncovered, stays) {
                        let case = reading.show(case);
                        errors.push(
                            self.error(
                                located.file,
                                located.span.clone(),
                                format!("machine `{}` has no rule for {case}", instance.machine),
                            )
                            .label("this machine")
                            .help("add a rule, or `otherwise = \"stay\"` if nothing shall happen"),
                        );
                    }
                    if let Some((a, b, case)) = &found.overlap {
                        let name = |n: usize| machine.rule[n].name.get_ref().clone();
                        let (a, b, case) = (*a, *b, reading.show(case));
                        errors.push(
                            self.error(
                                located.file,
                                machine.rule[b].name.span(),
                                format!("rules `{}` and `{}` both match {case}, with different effects", name(a), name(b)),
                            )
                            .label("second rule")
                            .help("make the guards exclude each other, or write order = \"priority\" if the first shall win"),
                        );
                    }
                }
            }
            first += instance.rules.len();
        }
        // Instances of one machine repeat its findings.
        errors.dedup_by_key(|e| (e.file.clone(), e.message.clone()));
        if errors.is_empty() {
            Ok(out)
        } else {
            Err(Diagnostics(errors))
        }
    }
}

/// What the guards of instances were found to do, so that those which are alike, such as the same machine in several axes, are examined once.
#[derive(Debug, Default)]
pub struct Known(Mutex<Vec<Arc<Examined>>>);

#[derive(Debug)]
struct Examined {
    guards: Guards,
    found: OnceLock<Option<Found>>,
}

impl Known {
    fn of(&self, guards: Guards) -> Arc<Examined> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(one) = known.iter().find(|one| one.guards == guards) {
            return one.clone();
        }
        let found = OnceLock::new();
        let new = Arc::new(Examined { guards, found });
        known.push(new.clone());
        new
    }
}

impl Examined {
    fn found(&self) -> &Option<Found> {
        self.found.get_or_init(|| self.guards.examine())
    }
}

/// The guards of one instance, with state, wired ports and elements of parameters turned into inputs of an enumeration, which are numbered
/// anew: alike in each instance and system whose guards read alike.
#[derive(Debug, PartialEq)]
struct Guards {
    whens: Vec<Node>,
    /// The values of the lets.
    lets: Vec<Node>,
    ranges: Vec<(i32, i32)>,
    /// For each rule the first one with the same effect.
    effects: Vec<usize>,
    exclusive: bool,
    stays: bool,
}

/// The inputs that an evaluation read, with their values.
type Case = Vec<(usize, i32)>;

#[derive(Debug)]
struct Found {
    fires: Vec<bool>,
    uncovered: Option<Case>,
    overlap: Option<(usize, usize, Case)>,
}

impl Guards {
    fn of(bound: &Bound, k: usize, exclusive: bool, stays: bool) -> (Self, Reading<'_>) {
        let rules = &bound.system.instances[k].rules;
        let mut reading = Reading {
            bound,
            cells: BTreeSet::new(),
            lets: BTreeSet::new(),
        };
        for rule in rules {
            reading.gather(&rule.when);
        }
        let effects: Vec<Vec<Stmt>> = rules
            .iter()
            .map(|r| r.then.iter().map(without_site).collect())
            .collect();
        let first = |e: &Vec<Stmt>| effects.iter().position(|other| other == e);
        let lazies = reading
            .lets
            .iter()
            .map(|k| &bound.system.lazies[*k as usize]);
        let guards = Self {
            whens: rules.iter().map(|r| reading.free(&r.when)).collect(),
            lets: lazies.map(|l| reading.free(&l.value)).collect(),
            ranges: reading.cells.iter().map(|c| reading.about(*c).2).collect(),
            effects: effects.iter().filter_map(first).collect(),
            exclusive,
            stays,
        };
        (guards, reading)
    }

    fn examine(&self) -> Option<Found> {
        let mut found = Found {
            fires: vec![false; self.whens.len()],
            uncovered: None,
            overlap: None,
        };
        let lazies: Vec<Lazy> = self.lets.iter().map(unnamed).collect();
        let cells = Cells {
            params: &[],
            lazies: &lazies,
        };
        let mut frame = Frame::empty();
        frame.inputs = vec![UNSET; self.ranges.len()];
        frame.lazies = vec![UNSET; self.lets.len()];
        // The reads of the present evaluation.
        let mut reads: Case = Vec::new();
        for _ in 0..BUDGET {
            frame.inputs.fill(UNSET);
            frame.lazies.fill(UNSET);
            let mut at = 0;
            let mut read = |k: usize| {
                if at == reads.len() {
                    reads.push((k, self.ranges[k].0));
                }
                at += 1;
                reads[at - 1].1
            };
            let mut hit = None;
            for (n, when) in self.whens.iter().enumerate() {
                if hit.is_some() && !self.exclusive {
                    break;
                }
                let memory = &mut Driven {
                    frame: &mut frame,
                    read: &mut read,
                };
                if value(when, cells, memory) == 0 {
                    continue;
                }
                match hit {
                    None => hit = Some(n),
                    Some(a) if self.effects[a] != self.effects[n] && found.overlap.is_none() => {
                        found.overlap = Some((a, n, case(&frame)));
                    }
                    Some(_) => {}
                }
            }
            match hit {
                Some(n) => found.fires[n] = true,
                None if found.uncovered.is_none() => found.uncovered = Some(case(&frame)),
                None => {}
            }
            // Where the first rule wins and no rule is needed, there is nothing more to find.
            if !self.exclusive
                && (self.stays || found.uncovered.is_some())
                && found.fires.iter().all(|f| *f)
            {
                return Some(found);
            }
            reads.truncate(at);
            loop {
                match reads.last_mut() {
                    None => return Some(found),
                    Some((k, v)) if *v < self.ranges[*k].1 => {
                        *v += 1;
                        break;
                    }
                    Some(_) => {
                        reads.pop();
                    }
                }
            }
        }
        None
    }
}

/// What was read so far, in the order of the variables.
fn case(frame: &Frame) -> Case {
    let set = frame.inputs.iter().copied().enumerate();
    set.filter(|(_, v)| *v != UNSET).collect()
}

fn unnamed(value: &Node) -> Lazy {
    Lazy {
        name: String::new(),
        kind: LazyKind::Let,
        ty: Ty::Int,
        value: value.clone(),
        lo: i64::from(i32::MIN),
        hi: i64::from(i32::MAX),
        ids: Vec::new(),
        text: String::new(),
    }
}

/// What guards read of a system, numbered from 0: its inputs, then state, wired ports, elements of parameters.
struct Reading<'a> {
    bound: &'a Bound,
    cells: BTreeSet<u32>,
    lets: BTreeSet<u32>,
}

impl<'a> Reading<'a> {
    /// The first state, wired port and parameter.
    fn starts(&self) -> [u32; 3] {
        let state = self.bound.system.inputs.len() as u32;
        let wire = state + self.bound.system.states.len() as u32;
        [state, wire, wire + self.bound.system.lazies.len() as u32]
    }

    fn number(&self, space: Space, k: u32) -> u32 {
        let [state, _, param] = self.starts();
        match space {
            Space::Input => k,
            Space::Before | Space::Now => state + k,
            Space::Param => param + k,
        }
    }

    fn is_let(&self, k: u32) -> bool {
        self.bound.system.lazies[k as usize].kind == LazyKind::Let
    }

    /// Name, type and range of a variable.
    fn about(&self, cell: u32) -> (&'a str, Ty, (i32, i32)) {
        let system = &self.bound.system;
        let [state, wire, param] = self.starts();
        let clip = |v: i64| v.clamp(i64::from(i32::MIN) + 1, i64::from(i32::MAX)) as i32;
        if cell < state {
            let k = cell as usize;
            (
                &system.inputs[k].name,
                system.inputs[k].ty,
                self.bound.inputs[k],
            )
        } else if cell < wire {
            let k = (cell - state) as usize;
            let var = &system.states[k].var;
            (&var.name, var.ty, self.bound.states[k])
        } else if cell < param {
            let l = &system.lazies[(cell - wire) as usize];
            (&l.name, l.ty, (clip(l.lo), clip(l.hi)))
        } else {
            let k = (cell - param) as usize;
            // Never shown: a case names what varies.
            let value = self.bound.values[k];
            ("", Ty::Int, (value, value))
        }
    }

    fn gather(&mut self, node: &Node) {
        match node {
            Node::Cell(Space::Param, _) => {}
            Node::Cell(space, k) => {
                self.cells.insert(self.number(*space, *k));
            }
            Node::Lazy(k) if self.is_let(*k) => {
                // Known, and all that it reads.
                if !self.lets.insert(*k) {
                    return;
                }
                let bound = self.bound;
                self.gather(&bound.system.lazies[*k as usize].value);
            }
            Node::Lazy(k) => {
                let [_, wire, _] = self.starts();
                self.cells.insert(wire + k);
            }
            Node::Element {
                space, base, len, ..
            } => {
                let first = self.number(*space, *base);
                self.cells.extend(first..first + len);
            }
            _ => {}
        }
        for child in node.children() {
            self.gather(child);
        }
    }

    /// State, wired ports and elements of parameters become inputs, parameters their values.
    fn free(&self, node: &Node) -> Node {
        let anew = |cell: u32| self.cells.range(..cell).count() as u32;
        let mut place = |space, k| (Space::Input, anew(self.number(space, k)));
        match node {
            Node::Cell(Space::Param, k) => Node::Const(i64::from(self.bound.values[*k as usize])),
            Node::Lazy(k) if self.is_let(*k) => Node::Lazy(self.lets.range(..k).count() as u32),
            Node::Lazy(k) => {
                let [_, wire, _] = self.starts();
                Node::Cell(Space::Input, anew(wire + k))
            }
            other => other.placed(&mut place, &mut |child| self.free(child)),
        }
    }

    /// A case in words.
    fn show(&self, case: &Case) -> String {
        let cells: Vec<u32> = self.cells.iter().copied().collect();
        let [_, _, param] = self.starts();
        let parts: Vec<String> = case
            .iter()
            .filter(|(k, _)| cells[*k] < param)
            .map(|(k, v)| {
                let (name, ty, _) = self.about(cells[*k]);
                let short = name.rsplit('.').next().unwrap_or(name);
                format!("{short} = {}", self.bound.system.show(ty, i64::from(*v)))
            })
            .collect();
        if parts.is_empty() {
            "any case".to_owned()
        } else {
            parts.join(", ")
        }
    }
}

/// A statement without the number of its place, to compare effects.
fn without_site(s: &Stmt) -> Stmt {
    match s {
        Stmt::Assign {
            base,
            index,
            value,
            checked,
            ..
        } => Stmt::Assign {
            base: *base,
            index: index.clone(),
            value: value.clone(),
            checked: *checked,
            site: 0,
        },
        Stmt::If(branches, rest) => Stmt::If(
            branches
                .iter()
                .map(|(g, body)| (g.clone(), body.iter().map(without_site).collect()))
                .collect(),
            rest.iter().map(without_site).collect(),
        ),
    }
}
