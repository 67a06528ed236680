//! Static analysis of the rules under given parameter values: uncovered cases, overlaps, rules that cannot fire.
//!
//! The guards' variables (state, ports, nothing else) are enumerated on demand: only what a guard really reads.

use crate::bind::Bound;
use crate::diag::{Diagnostic, Diagnostics, Result};
use crate::eval::{Cells, Driven, Frame, UNSET, value};
use crate::ir::{Lazy, LazyKind, Node, Space, Stmt};
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
    /// Analyses the rules of `bound`, which must come from this specification.
    ///
    /// # Errors
    /// Uncovered cases of machines without `otherwise = "stay"`, overlaps in `exclusive` machines, bad keys.
    pub fn analyse(&self, bound: &Bound) -> Result<Analysis> {
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
            let found = Guards::new(bound, k).examine(exclusive, stays);
            match found {
                None => out.skipped.push(instance.name.clone()),
                Some(found) => {
                    let dead = found.fires.iter().enumerate().filter(|(_, hit)| !**hit);
                    out.dead.extend(dead.map(|(n, _)| first + n));
                    if let (Some(case), false) = (found.uncovered, stays) {
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
                    if let Some((a, b, case)) = found.overlap {
                        let name = |n: usize| machine.rule[n].name.get_ref().clone();
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

/// The guards of one instance, with state and wired ports turned into inputs of an enumeration.
struct Guards<'a> {
    bound: &'a Bound,
    whens: Vec<Node>,
    effects: Vec<Vec<Stmt>>,
    lazies: Vec<Lazy>,
    names: Vec<(String, crate::ir::Ty, i32, i32)>,
}

struct Found {
    fires: Vec<bool>,
    uncovered: Option<String>,
    overlap: Option<(usize, usize, String)>,
}

impl<'a> Guards<'a> {
    fn new(bound: &'a Bound, k: usize) -> Self {
        let system = &bound.system;
        let mut names = Vec::new();
        let cells = system.inputs.iter().zip(&bound.inputs);
        names.extend(cells.map(|(v, (lo, hi))| (v.name.clone(), v.ty, *lo, *hi)));
        let state = names.len() as u32;
        let cells = system.states.iter().zip(&bound.states);
        names.extend(cells.map(|(s, (lo, hi))| (s.var.name.clone(), s.var.ty, *lo, *hi)));
        let wire = names.len() as u32;
        names.extend(system.lazies.iter().map(|l| {
            let clip = |v: i64| v.clamp(i64::from(i32::MIN) + 1, i64::from(i32::MAX)) as i32;
            (l.name.clone(), l.ty, clip(l.lo), clip(l.hi))
        }));
        let free = |node: &Node| free(node, state, wire, &system.lazies);
        let rules = &system.instances[k].rules;
        let lazies = system
            .lazies
            .iter()
            .map(|l| Lazy {
                value: free(&l.value),
                ..l.clone()
            })
            .collect();
        Self {
            bound,
            whens: rules.iter().map(|r| free(&r.when)).collect(),
            effects: rules
                .iter()
                .map(|r| r.then.iter().map(without_site).collect())
                .collect(),
            lazies,
            names,
        }
    }

    fn examine(&self, exclusive: bool, stays: bool) -> Option<Found> {
        let mut found = Found {
            fires: vec![false; self.whens.len()],
            uncovered: None,
            overlap: None,
        };
        let cells = Cells {
            params: &self.bound.values,
            lazies: &self.lazies,
        };
        let mut frame = Frame::empty();
        frame.inputs = vec![UNSET; self.names.len()];
        frame.lazies = vec![UNSET; self.lazies.len()];
        // The reads of the present evaluation: (variable, value).
        let mut reads: Vec<(usize, i32)> = Vec::new();
        for _ in 0..BUDGET {
            frame.inputs.fill(UNSET);
            frame.lazies.fill(UNSET);
            let mut at = 0;
            let mut read = |k: usize| {
                if at == reads.len() {
                    reads.push((k, self.names[k].2));
                }
                at += 1;
                reads[at - 1].1
            };
            let mut hit = None;
            for (n, when) in self.whens.iter().enumerate() {
                if hit.is_some() && !exclusive {
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
                        let case = self.case(&frame);
                        found.overlap = Some((a, n, case));
                    }
                    Some(_) => {}
                }
            }
            match hit {
                Some(n) => found.fires[n] = true,
                None if found.uncovered.is_none() => found.uncovered = Some(self.case(&frame)),
                None => {}
            }
            // Where the first rule wins and no rule is needed, there is nothing more to find.
            if !exclusive && (stays || found.uncovered.is_some()) && found.fires.iter().all(|f| *f)
            {
                return Some(found);
            }
            reads.truncate(at);
            loop {
                match reads.last_mut() {
                    None => return Some(found),
                    Some((k, v)) if *v < self.names[*k].3 => {
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

    fn case(&self, frame: &Frame) -> String {
        let set = frame
            .inputs
            .iter()
            .zip(&self.names)
            .filter(|(v, _)| **v != UNSET);
        let parts: Vec<String> = set
            .map(|(v, (name, ty, ..))| {
                let short = name.rsplit('.').next().unwrap_or(name);
                format!("{short} = {}", self.bound.system.show(*ty, i64::from(*v)))
            })
            .collect();
        if parts.is_empty() {
            "any case".to_owned()
        } else {
            parts.join(", ")
        }
    }
}

/// State and wired ports become inputs, numbered from `state` and `wire`.
fn free(node: &Node, state: u32, wire: u32, lazies: &[Lazy]) -> Node {
    match node {
        Node::Cell(Space::Before | Space::Now, k) => Node::Cell(Space::Input, state + k),
        Node::Lazy(k) if lazies[*k as usize].kind != LazyKind::Let => {
            Node::Cell(Space::Input, wire + k)
        }
        Node::Element {
            space: Space::Before | Space::Now,
            base,
            lo,
            len,
            index,
        } => Node::Element {
            space: Space::Input,
            base: state + base,
            lo: *lo,
            len: *len,
            index: Box::new(free(index, state, wire, lazies)),
        },
        other => other.map(&mut |child| free(child, state, wire, lazies)),
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
