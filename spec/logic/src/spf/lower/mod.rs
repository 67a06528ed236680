//! From a program to the syntax tree of Structured Text, and through its translation to a table.
//!
//! A cycle of the tree is a cycle of the interpolation: the running timers are a cycle further, then each action in ascending
//! order of the ids is an IF. The edge memory of an action is set at its place.

mod relays;
mod timers;
mod tree;
mod wiring;

use std::collections::BTreeMap;

use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result};

use super::ast::{
    Action, Assign, Expr as Source, ExprKind as SourceKind, Logic, Relation, Trigger, Value,
};
use super::interface::Places;
use super::lex::MILLION;
use super::variable::{Ty, Values};
use super::{Interface, Output, Program, Variable};
use crate::Compiled;
use crate::fault::{Fault, Span};
use crate::st::ast::{
    BinaryOp, Expr, File, Language, Pou, Section, SectionKind, Stmt, TypeKind, VarDecl,
};
use crate::st::lower::lower;
use timers::{Timer, compared, comparison};
use tree::{assign, binary, bounds, call, name, not, number, only_if, truth, variable, word};
use wiring::{Role, Wiring};

impl Program {
    /// The table that takes the place of a machine.
    ///
    /// # Errors
    /// What cannot be explored, with its place; an interface that does not fit the machine or the program.
    pub fn compile(&self, interface: &Interface) -> Result<Compiled> {
        let told = |fault: Fault| {
            // What is wrong with the interface stands nowhere in the program.
            match fault.span {
                Span { start: 0, end: 0 } => {
                    Diagnostic::new(&self.file, &self.source, None, fault.message).help(fault.help)
                }
                _ => fault.told(&self.file, &self.source),
            }
        };
        let all = |faults: Vec<Fault>| Diagnostics(faults.into_iter().map(told).collect());
        let mut faults = self.unexplored();
        let wiring = Wiring::new(self, interface, &self.numbers(), &mut faults);
        if !faults.is_empty() {
            faults.sort_by_key(|fault| fault.span.start);
            return Err(all(faults));
        }
        let mut making = Making {
            program: self,
            interface,
            timers: BTreeMap::new(),
            wiring,
            kept: Vec::new(),
            temps: Vec::new(),
            instances: BTreeMap::new(),
        };
        making.timers = Timer::all(self, |base| making.wiring.fresh(base));
        let tree = making.file();
        lower(&self.file, &self.source, &tree, &making.wiring.signature).map_err(all)
    }

    /// The first name that the program defines for a variable.
    fn title(&self, variable: &Variable) -> Option<String> {
        let mut names = self.names.iter().filter(|name| name.variable == *variable);
        names.next().map(|name| name.name.clone())
    }

    /// Where a reader looks for a variable: its definition, else its first use.
    fn place(&self, variable: &Variable, places: &Places) -> Span {
        let defined = self.names.iter().find(|name| name.variable == *variable);
        let used = places.written.clone().or(places.read.clone());
        defined
            .map(|name| name.span.clone())
            .or(used)
            .unwrap_or(0..0)
    }

    /// What is right and not explored.
    fn unexplored(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        if self.fragment {
            faults.push(Fault::new(
                &(0..self.source.chars().next().map_or(0, char::len_utf8)),
                "this is a part of a program: it has neither header nor end code",
                "add `%_N_SAFE_SPF` before it and `M17` after it, and the definitions that it lacks",
            ));
        }
        relays::faults(self, &mut faults);
        faults
    }

    /// The numbers that variables of 32 bits are compared with or set to, with their places.
    fn numbers(&self) -> Vec<(i64, Span)> {
        let mut found = Vec::new();
        let compared = |e: &Source| matches!(&e.kind, SourceKind::Variable(v) if v.kind().values == Values::Compared);
        let constant = |e: &Source| match &e.kind {
            SourceKind::Number(n) => Some((n.millionths / MILLION, e.span.clone())),
            _ => None,
        };
        let mut look = |e: &Source| {
            e.each(&mut |part| {
                if let SourceKind::Compare(_, a, b) = &part.kind {
                    if compared(a) || compared(b) {
                        found.extend(constant(a).or(constant(b)));
                    }
                }
            });
        };
        let mut set = Vec::new();
        for action in &self.actions {
            action.condition.iter().for_each(&mut look);
            for one in &action.assigns {
                match &one.value {
                    Value::Expr(value) => {
                        look(value);
                        set.extend(constant(value).filter(|_| compared(&one.target)));
                    }
                    // The status of a relay.
                    Value::Relay(_) => set.push((7, one.span.clone())),
                }
            }
        }
        found.extend(set);
        found
    }
}

/// A tree that is being made.
struct Making<'p> {
    program: &'p Program,
    interface: &'p Interface,
    wiring: Wiring,
    timers: BTreeMap<Variable, Timer>,
    /// Variables that keep their values, and those that do not.
    kept: Vec<VarDecl>,
    temps: Vec<VarDecl>,
    /// The block of each relay, with the memories of Q1 and Q2.
    instances: BTreeMap<u8, relays::Instance>,
}

impl Making<'_> {
    fn file(&mut self) -> File {
        let program = self.program;
        self.states();
        let mut body: Vec<Stmt> = self.timers.values().filter_map(Timer::tick).collect();
        for action in &program.actions {
            body.extend(self.action(action));
        }
        let nowhere = 0..0;
        if let Some(scan) = &self.interface.scan {
            body = vec![only_if(name(scan, &nowhere), body)];
        }
        let (outputs, given) = self.outputs();
        body.extend(given);
        let section = |kind, variables| Section { kind, variables };
        let sections = vec![
            section(SectionKind::Input, self.inputs()),
            section(SectionKind::Output, outputs),
            section(SectionKind::Local, std::mem::take(&mut self.kept)),
            section(SectionKind::Temp, std::mem::take(&mut self.temps)),
        ];
        File {
            language: Language::SafeLogic,
            program: Pou {
                name: word(&program.name, &nowhere),
                result: None,
                sections,
                body,
            },
            blocks: Vec::new(),
            functions: Vec::new(),
        }
    }

    /// All inputs of the machine, and the further ones.
    fn inputs(&self) -> Vec<VarDecl> {
        let nowhere = 0..0;
        let ports = self.wiring.signature.inputs.iter();
        let used = ports.filter(|port| {
            let wired = Role::Input(port.name.clone());
            self.interface.scan.as_ref() == Some(&port.name)
                || self.wiring.roles.values().any(|role| *role == wired)
        });
        used.map(|port| {
            let ty = match port.ty {
                crate::st::term::Ty::Int => TypeKind::Int("INT".to_owned(), None),
                _ => TypeKind::Bool,
            };
            variable(&port.name, None, ty, None, &nowhere)
        })
        .collect()
    }

    /// What the program writes keeps its value, and begins with 0.
    fn states(&mut self) {
        let program = self.program;
        for (variable, places) in program.places() {
            let Some(Role::State(identifier)) = self.wiring.roles.get(&variable) else {
                continue;
            };
            let span = program.place(&variable, &places);
            let title = program
                .title(&variable)
                .or_else(|| Some(variable.to_string()));
            let decl = match variable.kind().ty {
                Ty::Real => continue,
                Ty::Int => {
                    let (low, high) = self.wiring.range(&variable);
                    let range = bounds(number(low, &span), number(high, &span));
                    let ty = TypeKind::Int("INT".to_owned(), range);
                    tree::variable(identifier, title, ty, Some(number(0, &span)), &span)
                }
                _ => {
                    let init = Some(truth(false, &span));
                    tree::variable(identifier, title, TypeKind::Bool, init, &span)
                }
            };
            self.kept.push(decl);
        }
        let large = self.interface.readings.timers_begin_large;
        self.kept
            .extend(self.timers.values().flat_map(|timer| timer.declared(large)));
        relays::declare(self);
    }

    /// The outputs of the machine, given after each cycle from what the program wrote.
    fn outputs(&self) -> (Vec<VarDecl>, Vec<Stmt>) {
        let (mut declared, mut given) = (Vec::new(), Vec::new());
        let all = self.program.places();
        for (port, output) in &self.interface.outputs {
            let mut span = 0..0;
            let mut ty = TypeKind::Bool;
            let value = match output {
                Output::Constant(value) => truth(*value, &span),
                Output::Variable { variable, inverted } => {
                    if let Some(places) = all.get(variable) {
                        span = self.program.place(variable, places);
                    }
                    let value = self.variable(variable, &span);
                    if variable.kind().ty == Ty::Int {
                        ty = TypeKind::Int("INT".to_owned(), None);
                    }
                    if *inverted { not(value) } else { value }
                }
            };
            // A number begins with 0, which the range of the output may not hold: it is given in each cycle.
            let init = match ty {
                TypeKind::Bool => truth(false, &span),
                _ => number(0, &span),
            };
            declared.push(variable(port, None, ty, Some(init), &span));
            given.push(assign(port, value, &span));
        }
        (declared, given)
    }

    /// The value of a variable.
    fn variable(&self, variable: &Variable, span: &Span) -> Expr {
        match self.wiring.roles.get(variable) {
            Some(Role::Input(text) | Role::State(text)) => name(text, span),
            Some(Role::Zero) | None if variable.kind().ty == Ty::Int => number(0, span),
            Some(Role::Zero) | None => truth(false, span),
        }
    }

    fn action(&mut self, action: &Action) -> Vec<Stmt> {
        let base = if action.modal { "id" } else { "ids" };
        let mut body: Vec<Stmt> = Vec::new();
        for one in &action.assigns {
            body.extend(self.assign(one));
        }
        let Some(condition) = &action.condition else {
            return body;
        };
        let span = &condition.span;
        let value = self.truth(condition);
        let memory = |me: &mut Self, what: &str, kept: bool, init: bool| {
            let text = me.wiring.fresh(&format!("{base}_{}_{what}", action.id));
            let init = Some(truth(init, span));
            let decl = variable(&text, None, TypeKind::Bool, init, &action.id_span);
            if kept { &mut me.kept } else { &mut me.temps }.push(decl);
            text
        };
        match action.trigger {
            Trigger::Always => body,
            Trigger::Whenever => vec![only_if(value, body)],
            Trigger::Every => {
                // The condition is looked at once, before anything is written.
                let now = memory(self, "now", false, false);
                let first = self.interface.readings.first_sample_is_no_edge;
                let was = memory(self, "was", true, first);
                let rises = not(name(&was, span));
                let rises = binary(BinaryOp::And, name(&now, span), rises, span);
                vec![
                    assign(&now, value, span),
                    only_if(rises, body),
                    assign(&was, name(&now, span), span),
                ]
            }
            Trigger::When => {
                let done = memory(self, "done", true, false);
                let open = not(name(&done, span));
                let fires = binary(BinaryOp::And, open, value, span);
                body.insert(0, assign(&done, truth(true, span), span));
                vec![only_if(fires, body)]
            }
            Trigger::From => {
                let on = memory(self, "on", true, false);
                let latched = binary(BinaryOp::Or, name(&on, span), value, span);
                vec![assign(&on, latched, span), only_if(name(&on, span), body)]
            }
        }
    }

    fn assign(&mut self, one: &Assign) -> Vec<Stmt> {
        let SourceKind::Variable(target) = &one.target.kind else {
            return Vec::new();
        };
        let value = match &one.value {
            Value::Relay(number) => return relays::call(self, *number, target, &one.span),
            Value::Expr(value) => value,
        };
        if let (Some(timer), SourceKind::Number(to)) = (self.timers.get(target), &value.kind) {
            return timer.set(to.millionths, &one.span);
        }
        let Some(Role::State(text)) = self.wiring.roles.get(target).cloned() else {
            return Vec::new();
        };
        let value = match target.kind().ty {
            Ty::Int => self.number(value, target),
            _ => self.truth(value),
        };
        vec![assign(&text, value, &one.span)]
    }

    /// A number for a variable, which holds it up to one beyond all that it is compared with.
    fn number(&self, value: &Source, target: &Variable) -> Expr {
        let span = &value.span;
        match &value.kind {
            SourceKind::Number(n) => number(n.millionths / MILLION, span),
            SourceKind::Variable(of) => {
                let (low, high) = self.wiring.range(target);
                let value = self.variable(of, span);
                call(
                    "LIMIT",
                    vec![number(low, span), value, number(high, span)],
                    span,
                )
            }
            _ => number(0, span),
        }
    }

    /// A truth value.
    fn truth(&self, e: &Source) -> Expr {
        let span = &e.span;
        match &e.kind {
            SourceKind::Bool(value) => truth(*value, span),
            SourceKind::Number(n) => truth(n.millionths != 0, span),
            SourceKind::Variable(of) => self.variable(of, span),
            // A fragment has no table.
            SourceKind::Unknown(_) => truth(false, span),
            SourceKind::Not(inner) => not(self.truth(inner)),
            SourceKind::Logic(op, a, b) => {
                let op = match op {
                    Logic::And => BinaryOp::And,
                    Logic::Or => BinaryOp::Or,
                    Logic::Xor => BinaryOp::Xor,
                };
                binary(op, self.truth(a), self.truth(b), span)
            }
            SourceKind::Compare(relation, a, b) => self.compare(e, *relation, a, b),
        }
    }

    fn compare(&self, e: &Source, relation: Relation, a: &Source, b: &Source) -> Expr {
        let span = &e.span;
        if let Some((timer, relation, limit)) = comparison(e) {
            return match self.timers.get(timer) {
                Some(timer) => timer.compare(relation, limit, span),
                None => truth(self.never_set(relation, limit), span),
            };
        }
        let literal = |e: &Source| matches!(e.kind, SourceKind::Number(_) | SourceKind::Bool(_));
        let (value, with, relation) = match literal(a) {
            true => (b, a, relation.turned()),
            false => (a, b, relation),
        };
        let (SourceKind::Variable(of), true) = (&value.kind, value.ty() == Ty::Int) else {
            let value = self.truth(value);
            let one = !matches!(&with.kind, SourceKind::Bool(false))
                && !matches!(&with.kind, SourceKind::Number(n) if n.millionths == 0);
            let same = one == (relation == Relation::Equal);
            return if same { value } else { not(value) };
        };
        let op = match relation {
            Relation::Equal => BinaryOp::Eq,
            Relation::Unequal => BinaryOp::Ne,
            Relation::Greater => BinaryOp::Gt,
            Relation::Less => BinaryOp::Lt,
            Relation::GreaterEqual => BinaryOp::Ge,
            Relation::LessEqual => BinaryOp::Le,
        };
        let limit = match &with.kind {
            SourceKind::Number(n) => n.millionths / MILLION,
            _ => 0,
        };
        binary(op, self.variable(of, span), number(limit, span), span)
    }

    /// What a comparison with a timer says that is never set: it stays at 0, or above everything.
    fn never_set(&self, relation: Relation, limit: i64) -> bool {
        let value = match self.interface.readings.timers_begin_large {
            true => i64::MAX,
            false => 0,
        };
        compared(relation, value, limit)
    }
}
