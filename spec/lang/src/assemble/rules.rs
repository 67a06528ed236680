//! Lets, outputs and rules; warnings about what nothing reads.

use super::{Builder, CELL, One, Unit};
use crate::diag::nearest;
use crate::ir::{Form, Lazy, LazyKind, Node, Rule, Site, Space, Stmt, Ty};
use crate::schema::Text;
use crate::scope::{Meaning, Tense};
use crate::syntax::ast::{self, Kind};

impl Builder<'_> {
    /// Lets and outputs.
    pub(super) fn expressions(&mut self, owner: usize, unit: &mut Unit) {
        let machine = &self.spec.machines[&unit.machine];
        unit.inner.clone_from(&unit.names);
        let lets = machine.def.lets.iter().map(|x| (x, LazyKind::Let));
        let outputs = machine.def.output.iter().map(|x| (x, LazyKind::Output));
        for ((name, def), kind) in lets.chain(outputs) {
            let tense = if kind == LazyKind::Let {
                Tense::Start
            } else {
                Tense::Now
            };
            let made = (|| {
                let e = self.spec.expr(machine.file, &def.0.value)?;
                let mut scope = self.machine_scope(machine.file, &def.0.value, &unit.names, tense);
                let (ty, node) = scope.resolve(&e, None)?;
                let (lo, hi) = scope.ranges.of(&node);
                let (lo, hi) = match ty {
                    Ty::Int => (lo, hi),
                    Ty::Bool => (0, 1),
                    Ty::Enum(k) => (0, self.spec.enums[k].def.values.len() as i128 - 1),
                };
                if lo < CELL.0 || hi > CELL.1 {
                    return Err(scope
                        .error(
                            &e.span,
                            format!("`{}` can be {lo}..{hi}, more than 32 bits", name.get_ref()),
                        )
                        .help("narrow the operands, or use LIMIT"));
                }
                Ok((ty, node, lo as i64, hi as i64))
            })();
            let Some((ty, value, lo, hi)) = self.note(made) else {
                let array = unit.name.split('[').next().unwrap_or_default();
                self.failed.push((array.to_owned(), name.get_ref().clone()));
                continue;
            };
            let index = self.sys.lazies.len() as u32;
            self.sys.lazies.push(Lazy {
                name: format!("{}.{}", unit.name, name.get_ref()),
                kind,
                ty,
                value,
                lo,
                hi,
                ids: def.0.id.clone(),
                text: def.0.text.clone(),
            });
            self.lazy_owner.push(Some(owner));
            let meaning = Meaning::Value(ty, Node::Lazy(index));
            if kind == LazyKind::Let {
                unit.inner.insert(name.get_ref().clone(), meaning.clone());
            }
            if unit.names.insert(name.get_ref().clone(), meaning).is_some() {
                self.twice(machine.file, name);
            }
        }
        self.members.insert(unit.name.clone(), unit.names.clone());
    }

    pub(super) fn rules(&mut self, unit: &mut Unit) {
        let machine = &self.spec.machines[&unit.machine];
        for rule in &machine.def.rule {
            let name = format!("{}.{}", unit.name, rule.name.get_ref());
            if rule.id.is_empty() && rule.note.is_empty() {
                self.errors.push(
                    self.spec
                        .error(
                            machine.file,
                            rule.name.span(),
                            format!("rule `{}` names no requirement", rule.name.get_ref()),
                        )
                        .help("add `id = [...]`, or a `note` that says why it has none"),
                );
            }
            let when = (|| {
                let e = self.spec.expr(machine.file, &rule.when)?;
                self.machine_scope(machine.file, &rule.when, &unit.inner, Tense::Start)
                    .expect(&e, Ty::Bool)
            })();
            let when = self.note(when);
            let statements = self.spec.effect(machine.file, &rule.then);
            let Some(statements) = self.note(statements) else {
                continue;
            };
            let mut then = Vec::new();
            for statement in &statements {
                let made = self.statement(machine.file, &rule.then, statement, unit, &name);
                if let Some(made) = self.note(made) {
                    then.push(made);
                }
            }
            if let Some(when) = when {
                unit.rules.push(Rule {
                    name,
                    ids: rule.id.clone(),
                    note: rule.note.clone(),
                    when,
                    then,
                });
            }
        }
    }

    pub(super) fn statement(
        &mut self,
        file: usize,
        text: &Text,
        s: &ast::Stmt,
        unit: &Unit,
        rule: &str,
    ) -> One<Stmt> {
        match s {
            ast::Stmt::If(branches, rest) => {
                let mut out = Vec::new();
                for (guard, body) in branches {
                    let g = self
                        .machine_scope(file, text, &unit.inner, Tense::Now)
                        .expect(guard, Ty::Bool)?;
                    out.push((g, self.body(file, text, body, unit, rule)?));
                }
                Ok(Stmt::If(out, self.body(file, text, rest, unit, rule)?))
            }
            ast::Stmt::Assign(target, value) => {
                let mut scope = self.machine_scope(file, text, &unit.inner, Tense::Now);
                let (name_expr, index) = match &target.kind {
                    Kind::Index(base, index) => (base.as_ref(), Some(index.as_ref())),
                    _ => (target, None),
                };
                let Kind::Name(name) = &name_expr.kind else {
                    return Err(scope
                        .error(&target.span, "this cannot be assigned")
                        .help("assign to a state variable"));
                };
                let (ty, base, array) = match unit.inner.get(name) {
                    Some(Meaning::State(ty, base, array)) => (*ty, *base, *array),
                    Some(_) => {
                        return Err(scope
                            .error(&target.span, format!("`{name}` is not a state variable"))
                            .help("only state can be assigned; declare it under `state`"));
                    }
                    None => {
                        let help = nearest(name, unit.inner.keys().map(String::as_str))
                            .map_or("declare it under `state`".to_owned(), |n| {
                                format!("did you mean `{n}`?")
                            });
                        return Err(scope
                            .error(&target.span, format!("`{name}` is not known here"))
                            .help(help));
                    }
                };
                let index = match (index, array) {
                    (Some(i), Some((lo, len))) => Some((scope.index_node(i, lo, len)?, lo, len)),
                    (None, None) => None,
                    (Some(_), None) => {
                        return Err(scope
                            .error(&target.span, format!("`{name}` is not an array"))
                            .help("leave out the index"));
                    }
                    (None, Some(_)) => {
                        return Err(scope
                            .error(&target.span, format!("`{name}` is an array"))
                            .help("assign to its elements"));
                    }
                };
                let node = scope.expect(value, ty)?;
                let (a, b) = scope.ranges.of(&node);
                let var = &self.sys.states[base as usize].var;
                // The range that surely lies within the variable's for every parameter value.
                let sure = (scope.ranges.of(&var.lo).1, scope.ranges.of(&var.hi).0);
                let most = (scope.ranges.of(&var.lo).0, scope.ranges.of(&var.hi).1);
                if ty == Ty::Int && (b < most.0 || a > most.1) {
                    return Err(scope
                        .error(
                            &value.span,
                            format!(
                                "the value is {a}..{b}, `{name}` holds {}..{}",
                                most.0, most.1
                            ),
                        )
                        .help("widen the variable's range, or limit the value"));
                }
                let checked =
                    ty == Ty::Int && (a < sure.0 || b > sure.1) && node != var.hi && node != var.lo;
                let site = self.sys.sites.len() as u32;
                self.sys.sites.push(Site {
                    name: format!("{rule}: {name}"),
                });
                Ok(Stmt::Assign {
                    base,
                    index,
                    value: node,
                    checked,
                    site,
                })
            }
        }
    }

    pub(super) fn body(
        &mut self,
        file: usize,
        text: &Text,
        list: &[ast::Stmt],
        unit: &Unit,
        rule: &str,
    ) -> One<Vec<Stmt>> {
        list.iter()
            .map(|s| self.statement(file, text, s, unit, rule))
            .collect()
    }

    /// Warnings: inputs and named expressions that nothing reads.
    pub(super) fn unused(&mut self) {
        let mut inputs = vec![false; self.sys.inputs.len()];
        let mut lazies = vec![false; self.sys.lazies.len()];
        self.sys.nodes(&mut |n| match n {
            Node::Cell(Space::Input, k) => inputs[*k as usize] = true,
            Node::Element {
                space: Space::Input,
                base,
                len,
                ..
            } => {
                inputs[*base as usize..(*base + *len) as usize].fill(true);
            }
            Node::Lazy(k) => lazies[*k as usize] = true,
            _ => {}
        });
        for p in &self.sys.properties {
            if let Form::Independent { of, .. } = &p.form {
                of.iter().for_each(|k| inputs[*k] = true);
            }
        }
        for (input, read) in self.sys.inputs.iter().zip(inputs) {
            if !read {
                self.sys
                    .warnings
                    .push(format!("input `{}` is never read", input.name));
            }
        }
        for (lazy, read) in self.sys.lazies.iter().zip(lazies) {
            let what = match lazy.kind {
                LazyKind::Let => "let",
                LazyKind::Wire => "input",
                LazyKind::Output => continue, // an output is for the reader of reports too
            };
            if !read {
                self.sys
                    .warnings
                    .push(format!("{what} `{}` is never read", lazy.name));
            }
        }
    }
}
