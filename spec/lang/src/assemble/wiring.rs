//! Ports, wires, and the order in which instances step.

use std::collections::{HashMap, HashSet};

use super::{Builder, Unit};
use crate::diag::{Result, nearest};
use crate::ir::{Lazy, LazyKind, Node, Space};
use crate::schema::{self, Text};
use crate::scope::Meaning;

impl Builder<'_> {
    /// Ports by full name, from `[wire]` and `[free]`: the key, or none for a free port, and its place.
    pub(super) fn wiring(
        &mut self,
        def: &schema::System,
        units: &[Unit],
    ) -> HashMap<String, (Option<usize>, Text)> {
        let mut out: HashMap<String, (Option<usize>, Text)> = HashMap::new();
        let wires = def.wire.keys().enumerate().map(|(k, key)| (Some(k), key));
        let (rest, free): (Vec<&Text>, Vec<&Text>) =
            (def.free.ports.iter()).partition(|key| key.get_ref().ends_with(".*"));
        let free = free.into_iter().map(|key| (None, key));
        for (wire, key) in wires.chain(free) {
            let mut hits = 0;
            for unit in units {
                let indexed = unit
                    .name
                    .rsplit_once('[')
                    .map(|(base, _)| format!("{base}[i]"));
                let written = key.get_ref().replace(' ', "");
                let port = [Some(unit.name.clone()), indexed]
                    .into_iter()
                    .flatten()
                    .find_map(|n| written.strip_prefix(&format!("{n}.")).map(str::to_owned));
                let Some(port) = port else { continue };
                let machine = &self.spec.machines[&unit.machine].def;
                if !machine.input.keys().any(|k| *k.get_ref() == port) {
                    continue;
                }
                hits += 1;
                let full = format!("{}.{port}", unit.name);
                if out.insert(full.clone(), (wire, key.clone())).is_some() {
                    self.errors.push(
                        self.spec
                            .error(
                                self.file,
                                key.span(),
                                format!("port `{full}` is bound twice"),
                            )
                            .help("wire it once, or declare it free, not both"),
                    );
                }
            }
            if hits == 0 {
                let ports: Vec<String> = units
                    .iter()
                    .flat_map(|u| {
                        let machine = &self.spec.machines[&u.machine].def;
                        machine
                            .input
                            .keys()
                            .map(move |k| format!("{}.{}", u.name, k.get_ref()))
                    })
                    .collect();
                let help = nearest(key.get_ref(), ports.iter().map(String::as_str)).map_or(
                    "write `instance.port` or `instance[i].port`".to_owned(),
                    |n| format!("did you mean `{n}`?"),
                );
                self.errors.push(
                    self.spec
                        .error(
                            self.file,
                            key.span(),
                            format!("`{}` is not an input port", key.get_ref()),
                        )
                        .help(help),
                );
            }
        }
        self.rest(&rest, units, &mut out);
        out
    }

    /// `instance.*`: whatever no wire names is free there.
    fn rest(
        &mut self,
        rest: &[&Text],
        units: &[Unit],
        out: &mut HashMap<String, (Option<usize>, Text)>,
    ) {
        for key in rest {
            let named = key.get_ref().strip_suffix(".*").unwrap_or_default();
            let Some(unit) = units.iter().find(|u| u.name == named) else {
                let known: Vec<&str> = units.iter().map(|u| u.name.as_str()).collect();
                let help = nearest(named, known.iter().copied()).map_or_else(
                    || format!("instances: {}", known.join(", ")),
                    |n| format!("did you mean `{n}.*`?"),
                );
                let message = format!("`{named}` is not an instance");
                self.errors
                    .push(self.spec.error(self.file, key.span(), message).help(help));
                continue;
            };
            let machine = &self.spec.machines[&unit.machine].def;
            for port in machine.input.keys() {
                let full = format!("{}.{}", unit.name, port.get_ref());
                out.entry(full).or_insert_with(|| (None, (*key).clone()));
            }
        }
    }

    /// Gives every input port a meaning: a free input, or a reserved named expression.
    pub(super) fn ports(
        &mut self,
        _owner: usize,
        unit: &mut Unit,
        def: &schema::System,
        wires: &HashMap<String, (Option<usize>, Text)>,
    ) {
        let machine = &self.spec.machines[&unit.machine];
        for (port, declared) in &machine.def.input {
            let full = format!("{}.{}", unit.name, port.get_ref());
            let made = self.variables(
                machine.file,
                &full,
                port.get_ref(),
                &declared.0,
                &unit.names,
            );
            let Some((vars, array)) = self.note(made) else {
                continue;
            };
            let meaning = match wires.get(&full) {
                None => {
                    self.errors.push(
                        self.spec
                            .error(
                                self.file,
                                self.spec
                                    .systems
                                    .get(self.sys.name.rsplit('/').next().unwrap_or(""))
                                    .map_or(0..0, |s| s.span.clone()),
                                format!("port `{full}` is not wired"),
                            )
                            .help("wire it under [system.NAME.wire], or list it under free.ports"),
                    );
                    continue;
                }
                Some((None, _)) => self.add_inputs(vars, array),
                Some((Some(_), key)) if array.is_some() => {
                    self.errors.push(
                        self.spec
                            .error(self.file, key.span(), "an array port cannot be wired")
                            .help("make it free, or use scalar ports"),
                    );
                    continue;
                }
                Some((Some(k), _)) => {
                    let (lo, hi) = (
                        self.ranges().of(&vars[0].lo).0,
                        self.ranges().of(&vars[0].hi).1,
                    );
                    let lazy = self.sys.lazies.len();
                    self.sys.lazies.push(Lazy {
                        name: full.clone(),
                        kind: LazyKind::Wire,
                        ty: vars[0].ty,
                        value: Node::Const(0),
                        lo: lo as i64,
                        hi: hi as i64,
                        ids: Vec::new(),
                        text: String::new(),
                    });
                    self.lazy_owner.push(None);
                    let written = def.wire.get_index(*k).map(|(key, _)| key.get_ref().clone());
                    unit.wires
                        .push((lazy as u32, written.unwrap_or_default(), *k));
                    Meaning::Value(vars[0].ty, Node::Lazy(lazy as u32))
                }
            };
            if unit.names.insert(port.get_ref().clone(), meaning).is_some() {
                self.twice(machine.file, port);
            }
        }
    }

    /// Fills in the wired expressions of a unit.
    pub(super) fn connect(
        &mut self,
        unit: &Unit,
        def: &schema::System,
        _wires: &HashMap<String, (Option<usize>, Text)>,
    ) {
        for (lazy, _, k) in &unit.wires {
            let Some((_, text)) = def.wire.get_index(*k) else {
                continue;
            };
            let (ty, lo, hi, port) = {
                let l = &self.sys.lazies[*lazy as usize];
                (l.ty, i128::from(l.lo), i128::from(l.hi), l.name.clone())
            };
            let made = (|| {
                let e = self.spec.expr(self.file, text)?;
                let mut scope = self.system_scope(text, unit.index);
                let node = scope.expect(&e, ty)?;
                let (a, b) = scope.ranges.of(&node);
                if a < lo || b > hi {
                    return Err(scope
                        .error(
                            &e.span,
                            format!("the wire can be {a}..{b}, port `{port}` takes {lo}..{hi}"),
                        )
                        .help("widen the port, or use LIMIT"));
                }
                Ok(node)
            })();
            if let Some(node) = self.note(made) {
                self.sys.lazies[*lazy as usize].value = node;
            }
        }
    }

    /// The units whose step must come before that of unit `own`: those whose outputs or new state its wires read, also by way
    /// of inputs of other units. A wire that reads itself makes the unit wait for itself, which has no order.
    pub(super) fn providers(&self, own: usize, unit: &Unit) -> Vec<usize> {
        let mut out = Vec::new();
        for (wire, _, _) in &unit.wires {
            let mut seen = HashSet::new();
            let mut open = vec![*wire];
            while let Some(lazy) = open.pop() {
                let Some(read) = self.sys.lazies.get(lazy as usize) else {
                    continue;
                };
                read.value.visit(&mut |n| match n {
                    Node::Cell(Space::Now, k)
                    | Node::Element {
                        space: Space::Now,
                        base: k,
                        ..
                    } => {
                        out.extend(self.state_owner.get(*k as usize).copied());
                    }
                    Node::Lazy(k) => match self.lazy_owner.get(*k as usize).copied().flatten() {
                        Some(owner) => out.push(owner),
                        None if k == wire => out.push(own),
                        None if seen.insert(*k) => open.push(*k),
                        None => {}
                    },
                    _ => {}
                });
            }
        }
        out
    }

    /// Data-flow order: providers first, else the order of the file.
    pub(super) fn order(&self, units: &[Unit], needs: &[Vec<usize>]) -> Result<Vec<usize>> {
        let mut done = vec![false; units.len()];
        let mut order = Vec::new();
        while order.len() < units.len() {
            let next = (0..units.len()).find(|k| !done[*k] && needs[*k].iter().all(|n| done[*n]));
            let Some(k) = next else {
                let stuck: Vec<&str> = (0..units.len())
                    .filter(|k| !done[*k])
                    .map(|k| units[k].name.as_str())
                    .collect();
                let span = self
                    .spec
                    .systems
                    .get(self.sys.name.rsplit('/').next().unwrap_or(""))
                    .map_or(0..0, |s| s.span.clone());
                return Err(self
                    .spec
                    .error(
                        self.file,
                        span,
                        format!("combinational loop between {}", stuck.join(", ")),
                    )
                    .help("break it with PREV(...) in one of the wires")
                    .into());
            };
            done[k] = true;
            order.push(k);
        }
        Ok(order)
    }
}
