//! From what a program has computed to the table: what an output or a fault needs, and no more.

use std::collections::BTreeSet;

use stillpoint_lang::Written;
use toml::Spanned;

use super::{Entry, Lowering, Role, Scope, Slot, Variable};
use crate::fault::Span;
use crate::st::program::Output;
use crate::st::term::{Term, Ty, Use};
use crate::{Compiled, Input, SCAN};

/// A duration has at most so many cycles: none is shorter than a microsecond.
pub(super) fn most_cycles(us: u64) -> i64 {
    i64::try_from(us).unwrap_or(i64::MAX).min(1_000_000_000)
}

fn text(span: &Span, text: impl Into<String>) -> Spanned<String> {
    Spanned::new(span.clone(), text.into())
}

/// What an output of the machine gives.
#[derive(Clone, Copy)]
enum Given {
    Constant(bool),
    Variable { id: usize, inverted: bool },
}

impl Given {
    fn variable(self) -> Option<usize> {
        match self {
            Self::Constant(_) => None,
            Self::Variable { id, .. } => Some(id),
        }
    }
}

impl<'a> Lowering<'a> {
    pub(super) fn emit(mut self, scope: &Scope<'a>) -> Compiled {
        let outputs = self.outputs(scope);
        // What a rule or an output reads is the state after the cycle; names keep what it was before it.
        let slots: Vec<usize> = (0..self.variables.len()).collect();
        for id in slots {
            if let Some(term) = self.env.get(&Slot::Variable(id)).cloned() {
                let settled = self.settled(id, (*term).clone());
                self.set(id, settled);
            }
        }
        for id in outputs.iter().filter_map(|(_, given)| given.variable()) {
            let settled = self.settled(id, (*self.value(Slot::Variable(id))).clone());
            self.set(id, settled);
        }
        let needed = self.needed(&outputs);
        let loose = self.loose(&needed);
        let mut machine = Written::new(format!(
            "{}: program {}",
            self.file, self.tree.program.name.text
        ));
        let durations = self.parameters(&needed, &mut machine);
        let inputs = self.added(&needed, &mut machine);
        for (id, variable) in self.variables.iter().enumerate() {
            if needed.contains(&Use::State(id)) {
                self.state(variable, loose.contains(&id), &mut machine);
            }
        }
        for (k, one) in self.lets.iter().enumerate() {
            if needed.contains(&Use::Let(k)) {
                let value = text(&one.span, one.term.text.clone());
                machine.add_let(text(&one.span, one.name.clone()), value, &one.text);
            }
        }
        let span = &self.tree.program.name.span;
        let then = self.rule(&needed, &loose);
        if !then.is_empty() {
            let note = format!(
                "program {} of {}, once in each cycle",
                self.tree.program.name.text, self.file
            );
            machine.add_rule(text(span, "cycle"), text(span, then), &note);
        }
        for (name, given) in &outputs {
            let (span, value) = match *given {
                Given::Constant(value) => (span, Term::bool(value)),
                Given::Variable { id, inverted } => {
                    let value = (*self.value(Slot::Variable(id))).clone();
                    let value = if inverted { value.not() } else { value };
                    (&self.variables[id].span, value)
                }
            };
            machine.add_output(text(span, name.clone()), text(span, value.text), "");
        }
        Compiled {
            name: self.tree.program.name.text.clone(),
            machine,
            durations,
            inputs,
            loose: loose
                .iter()
                .map(|id| self.variables[*id].name.clone())
                .collect(),
        }
    }

    /// The times that nothing starts which the machine is told, where the signature wants them as inputs.
    fn loose(&self, needed: &BTreeSet<Use>) -> BTreeSet<usize> {
        let times = self.variables.iter().enumerate();
        let times = times.filter(|(id, variable)| {
            let state = Use::State(*id);
            variable.ty == Ty::Time && needed.contains(&state)
        });
        let checked = |id: usize| self.checks.iter().any(|check| check.variable == id);
        let told = |one: &Use| match one {
            Use::Input(k) => {
                let port = &self.signature.inputs[*k];
                port.added.is_none() && port.name != SCAN
            }
            _ => false,
        };
        let free = |id: usize| !checked(id) && !self.read_by(vec![Use::State(id)]).iter().any(told);
        times
            .map(|(id, _)| id)
            .filter(|id| self.signature.loose && free(*id))
            .collect()
    }

    /// The inputs that the program adds to those of the machine.
    fn added(&self, needed: &BTreeSet<Use>, machine: &mut Written) -> Vec<Input> {
        let span = &self.tree.program.name.span;
        let mut inputs = Vec::new();
        for (k, port) in self.signature.inputs.iter().enumerate() {
            let Some(variable) = &port.added else {
                continue;
            };
            if !needed.contains(&Use::Input(k)) {
                continue;
            }
            let ty = match port.ty {
                Ty::Int => format!("INT({}..{})", port.low, port.high),
                other => self.signature.name(other).to_owned(),
            };
            machine.add_input(
                text(span, port.name.clone()),
                text(span, ty.clone()),
                variable,
            );
            inputs.push(Input {
                name: port.name.clone(),
                ty,
                variable: variable.clone(),
            });
        }
        inputs
    }

    /// The outputs of the machine by the names that it has for them: of the same name, or what the interface says.
    fn outputs(&self, scope: &Scope<'a>) -> Vec<(String, Given)> {
        let named = |name: &str, inverted| match scope.names.get(&super::declare::upper(name)) {
            Some(Entry::Variable(id)) => Some(Given::Variable { id: *id, inverted }),
            _ => None,
        };
        match &self.signature.given {
            None => (self.signature.outputs.iter())
                .filter_map(|port| Some((port.name.clone(), named(&port.name, false)?)))
                .collect(),
            Some(given) => (given.iter())
                .filter_map(|(port, output)| {
                    let given = match output {
                        Output::Constant(value) => Given::Constant(*value),
                        Output::Variable { variable, inverted } => named(variable, *inverted)?,
                    };
                    Some((port.clone(), given))
                })
                .collect(),
        }
    }

    /// The value under a name, where it reads state itself.
    fn settled(&mut self, id: usize, term: Term) -> Term {
        if !term.uses.iter().any(|u| matches!(u, Use::State(_))) {
            return term;
        }
        let (name, span) = (
            self.variables[id].name.clone(),
            self.variables[id].span.clone(),
        );
        let fresh = self.fresh(&format!("{name}_kept"));
        let leaf = Term::leaf(fresh.clone(), term.ty, term.low, term.high)
            .reading(Use::Let(self.lets.len()));
        self.lets.push(super::Let {
            name: fresh,
            term,
            span,
            text: format!("{name} as it was in the cycle before"),
        });
        leaf
    }

    /// Everything that an output reads, at once or over the cycles, and every check.
    fn needed(&self, outputs: &[(String, Given)]) -> BTreeSet<Use> {
        let mut open: Vec<Use> = Vec::new();
        for id in outputs.iter().filter_map(|(_, given)| given.variable()) {
            open.extend(&self.value(Slot::Variable(id)).uses);
        }
        for check in &self.checks {
            open.extend(check.path.uses.iter().chain(&check.value.uses));
            open.push(Use::State(check.variable));
        }
        self.read_by(open)
    }

    /// All of this, and what that reads in its turn.
    fn read_by(&self, mut open: Vec<Use>) -> BTreeSet<Use> {
        let mut needed = BTreeSet::new();
        while let Some(one) = open.pop() {
            if !needed.insert(one) {
                continue;
            }
            match one {
                Use::Let(k) => open.extend(&self.lets[k].term.uses),
                Use::State(id) => {
                    let variable = &self.variables[id];
                    open.extend(&variable.init.uses);
                    if let Some((low, high)) = &variable.bounds {
                        open.extend(low.uses.iter().chain(&high.uses));
                    }
                    if let Some(term) = self.env.get(&Slot::Variable(id)) {
                        open.extend(&term.uses);
                    }
                }
                Use::Duration(_) | Use::Input(_) => {}
            }
        }
        needed
    }

    fn parameters(&self, needed: &BTreeSet<Use>, machine: &mut Written) -> Vec<(String, u64)> {
        let span = &self.tree.program.name.span;
        let mut durations = Vec::new();
        for (us, name) in &self.durations {
            if needed.contains(&Use::Duration(*us)) {
                let ty = text(span, format!("TIME(0..{})", most_cycles(*us)));
                // In cycles of a millisecond, where nothing else is said.
                let default = i64::try_from(us.div_ceil(1000))
                    .unwrap_or(i64::MAX)
                    .min(most_cycles(*us));
                machine.add_param(
                    text(span, name.clone()),
                    ty,
                    default,
                    "a time of the program",
                );
                durations.push((name.clone(), *us));
            }
        }
        durations
    }

    fn state(&self, variable: &Variable, loose: bool, machine: &mut Written) {
        let range = |name: &str| match &variable.bounds {
            Some((low, high)) => format!("{name}({}..{})", low.text, high.text),
            None => name.to_owned(),
        };
        let ty = match variable.ty {
            Ty::Bool => "BOOL".to_owned(),
            Ty::Int => range("INT"),
            Ty::Time => range("TIME"),
            Ty::Enum(_) => self.signature.name(variable.ty).to_owned(),
        };
        let span = &variable.span;
        let line = self.line(span);
        if loose {
            let title = format!("line {line}: {}, at any time", variable.name);
            machine.add_input(text(span, variable.table.clone()), text(span, ty), &title);
            return;
        }
        machine.add_state(
            text(span, variable.table.clone()),
            text(span, ty),
            text(span, variable.init.text.clone()),
            &format!("line {line}: {}", variable.name),
        );
    }

    /// The checks in their order, then the state after the cycle.
    fn rule(&self, needed: &BTreeSet<Use>, loose: &BTreeSet<usize>) -> String {
        let mut then = String::new();
        for check in &self.checks {
            let (table, value) = (&self.variables[check.variable].table, &check.value.text);
            then += &match check.path.is(true) {
                true => format!("{table} := {value};\n"),
                false => format!("IF {} THEN {table} := {value}; END_IF;\n", check.path.text),
            };
        }
        let checked: BTreeSet<usize> = self.checks.iter().map(|c| c.variable).collect();
        let read = self.read(needed);
        for (id, variable) in self.variables.iter().enumerate() {
            if !needed.contains(&Use::State(id)) || loose.contains(&id) {
                continue;
            }
            // What the program never assigns stays; what no cycle reads of the one before is no state.
            let value = match self.env.get(&Slot::Variable(id)) {
                Some(term) if read.contains(&id) && variable.role != Role::Temp => {
                    term.text.clone()
                }
                None if !checked.contains(&id) => continue,
                _ => variable.init.text.clone(),
            };
            then += &format!("{} := {value};\n", variable.table);
        }
        then
    }

    /// The variables whose value of the cycle before is read by something that is needed.
    fn read(&self, needed: &BTreeSet<Use>) -> BTreeSet<usize> {
        let lets = self.lets.iter().enumerate();
        let lets = lets.filter(|(k, _)| needed.contains(&Use::Let(*k)));
        let uses = lets.flat_map(|(_, one)| &one.term.uses);
        uses.filter_map(|u| match u {
            Use::State(id) => Some(*id),
            Use::Let(_) | Use::Duration(_) | Use::Input(_) => None,
        })
        .collect()
    }
}
