//! The statements of a cycle.

use std::collections::BTreeSet;
use std::fmt::Write;

use stillpoint_lang::ir::{BinaryOp, Form, Node, Stmt};

use super::{COMBINATION, Emitter, FEW, SMALL, Shared, Used, comment, scratch, wide};
use crate::export::known::{Known, Status, read_anywhere};

impl<'a> Emitter<'a> {
    pub(super) fn cycle(shared: &'a Shared<'a>, used: Used) -> Self {
        let folded = shared.folded;
        let mut e = Emitter {
            shared,
            used,
            found: Used::default(),
            out: String::new(),
            depth: 2,
            known: Known::nothing(folded),
            labels: Vec::new(),
            labelled: false,
            inside: false,
            at: (0, false),
            scratch: 0,
        };
        e.found.before = if shared.faults {
            (0..shared.states.len()).collect()
        } else {
            BTreeSet::new()
        };
        if folded.bound.combinations() <= FEW {
            e.all_inputs();
        }
        e.copies();
        for (k, instance) in folded.bound.system.instances.iter().enumerate() {
            e.at = (k, false);
            e.line(&format!(
                "/* {}: {} */",
                comment(&instance.name),
                comment(&instance.machine)
            ));
            e.rules(k);
        }
        e.at = (folded.bound.system.instances.len(), false);
        if shared.faults {
            let end = e.label();
            e.line("assert(!fault);");
            e.line("if :: fault ->");
            e.restore();
            e.line(&format!("goto l{end} :: else fi;"));
            e.meet(end);
            e.properties();
            e.place(end, true);
        } else {
            e.properties();
        }
        e.reset();
        if e.inside {
            e.depth -= 1;
            e.line("}");
        }
        e
    }

    pub(super) fn line(&mut self, text: &str) {
        if text.starts_with("d_step") && std::mem::take(&mut self.labelled) {
            // SPIN takes a jump to a d_step for one into it.
            self.line("skip;");
        }
        self.labelled &= text.starts_with("/*");
        for _ in 0..self.depth {
            self.out.push('\t');
        }
        self.out.push_str(text);
        self.out.push('\n');
    }

    /// Statements that choose nothing, as one step.
    pub(super) fn step(&mut self, lines: &[String]) {
        match lines {
            [] => {}
            [one] => self.line(one),
            _ if self.inside => lines.iter().for_each(|l| self.line(l)),
            _ => {
                self.line("d_step {");
                self.depth += 1;
                lines.iter().for_each(|l| self.line(l));
                self.depth -= 1;
                self.line("}");
            }
        }
    }

    /// Two ways, of which the first is taken where the condition holds.
    pub(super) fn branch(
        &mut self,
        condition: &str,
        then: impl FnOnce(&mut Self),
        other: impl FnOnce(&mut Self),
    ) {
        self.line("if");
        let before = self.known.clone();
        self.way(condition, then);
        let after = std::mem::replace(&mut self.known, before);
        self.way("else", other);
        self.known.join(&after);
        self.line("fi;");
    }

    pub(super) fn way(&mut self, guard: &str, way: impl FnOnce(&mut Self)) {
        self.depth += 1;
        let start = self.out.len();
        way(self);
        let body = self.out.split_off(start);
        self.depth -= 1;
        self.line(&format!(
            ":: {guard}{}",
            if body.is_empty() { "" } else { " ->" }
        ));
        self.out.push_str(&body);
    }

    /// A label that jumps may name before it is placed.
    pub(super) fn label(&mut self) -> usize {
        self.labels.push(None);
        self.labels.len() - 1
    }

    /// Notes that a way from here leads to a label.
    pub(super) fn meet(&mut self, label: usize) {
        match &mut self.labels[label] {
            Some(known) => known.join(&self.known),
            none => *none = Some(self.known.clone()),
        }
    }

    /// The place of a label. `falls` says whether what stands before it also leads here.
    pub(super) fn place(&mut self, label: usize, falls: bool) {
        let Some(known) = self.labels[label].take() else {
            return;
        };
        if falls {
            self.known.join(&known);
        } else {
            self.known = known;
        }
        let _ = writeln!(self.out, "\tl{label}:");
        self.labelled = true;
    }

    /// Goes to a label if `node` is `truth`; what the value needs is chosen on the way, and only that.
    pub(super) fn jump(&mut self, node: &Node, truth: bool, label: usize) {
        match node {
            Node::Not(a) => self.jump(a, !truth, label),
            Node::Binary(op @ (BinaryOp::And | BinaryOp::Or), a, b)
                if !self.known.satisfies(node) =>
            {
                // The value of the left side with which the right one is not looked at.
                let decides = *op == BinaryOp::Or;
                if decides == truth {
                    self.jump(a, truth, label);
                    self.jump(b, truth, label);
                } else {
                    let decided = self.label();
                    self.jump(a, decides, decided);
                    self.jump(b, truth, label);
                    self.place(decided, true);
                }
            }
            _ => {
                self.need(node);
                let condition = if truth {
                    self.value(node)
                } else {
                    self.value(&negated(node))
                };
                self.line(&format!("if :: {condition} -> goto l{label} :: else fi;"));
                self.meet(label);
            }
        }
    }

    /// Chooses all inputs at once, as one number, and begins the step that makes the rest of the cycle.
    pub(super) fn all_inputs(&mut self) {
        let shared = self.shared;
        let bounds = &shared.folded.bound.inputs;
        let read: Vec<usize> = read_anywhere(shared.folded).into_iter().collect();
        let count = read
            .iter()
            .map(|k| i64::from(bounds[*k].1) - i64::from(bounds[*k].0) + 1)
            .product::<i64>();
        if count > 1 {
            let list: Vec<String> = (0..count)
                .map(|n| format!(":: {COMBINATION} = {n}"))
                .collect();
            self.line("/* any combination of the inputs */");
            self.line(&format!("if {} fi;", list.join(" ")));
            self.found.combination = true;
        }
        self.line("d_step {");
        self.depth += 1;
        self.inside = true;
        let mut weight = 1;
        for k in read {
            let (lo, hi) = wide(bounds[k]);
            let size = hi - lo + 1;
            let digit = match (weight, weight * size == count) {
                (1, true) => COMBINATION.to_owned(),
                (1, false) => format!("{COMBINATION} % {size}"),
                (_, true) => format!("{COMBINATION} / {weight}"),
                (_, false) => format!("{COMBINATION} / {weight} % {size}"),
            };
            let text = if lo == 0 {
                digit
            } else {
                format!("{lo} + {digit}")
            };
            self.line(&format!("{} = {text};", shared.inputs[k]));
            self.found.inputs.insert(k);
            self.known.inputs[k] = Status::Yes;
            weight *= size;
        }
    }

    /// The states at the start of the cycle, where something reads them after a rule has changed them.
    pub(super) fn copies(&mut self) {
        let copy = |k: &usize| format!("{} = {};", self.shared.before[*k], self.shared.states[*k]);
        let mut lines: Vec<String> = self.used.before.iter().map(copy).collect();
        // SPIN leaves variables that nothing reads out of its state vector, and two states would be one.
        for (k, name) in self.shared.states.iter().enumerate() {
            if !self.used.read.contains(&k) && !self.used.before.contains(&k) {
                lines.push(format!("{name} = {name};"));
            }
        }
        self.step(&lines);
    }

    pub(super) fn restore(&mut self) {
        let back = |k: &usize| format!("{} = {};", self.shared.states[*k], self.shared.before[*k]);
        let lines: Vec<String> = self.used.before.iter().map(back).collect();
        self.step(&lines);
    }

    /// Everything that is no state gets its least value again.
    pub(super) fn reset(&mut self) {
        let (shared, used) = (self.shared, &self.used);
        let bound = shared.folded.bound;
        let mut lines = Vec::new();
        let mut set = |name: &str, value: i64| lines.push(format!("{name} = {value};"));
        used.inputs
            .iter()
            .for_each(|k| set(&shared.inputs[*k], i64::from(bound.inputs[*k].0)));
        used.chosen.iter().for_each(|k| set(&shared.chosen[*k], 0));
        used.lazies
            .iter()
            .for_each(|k| set(&shared.lazies[*k], shared.folded.ranges[*k].0));
        used.evaluated
            .iter()
            .for_each(|k| set(&shared.evaluated[*k], 0));
        used.before
            .iter()
            .for_each(|k| set(&shared.before[*k], i64::from(bound.states[*k].0)));
        (0..used.scratch).for_each(|k| set(&scratch(k), 0));
        if used.combination {
            set(COMBINATION, 0);
        }
        if shared.faults {
            set("fault", 0);
        }
        self.line("/* nothing of the cycle is kept but the state */");
        if lines.is_empty() {
            lines.push("skip;".to_owned());
        }
        self.step(&lines);
    }

    /// The rules of an instance: the first whose guard holds fires.
    pub(super) fn rules(&mut self, instance: usize) {
        let shared = self.shared;
        let done = self.label();
        let mut falls = true;
        for (place, rule) in &shared.folded.rules[instance] {
            let written = &shared.folded.bound.system.instances[instance].rules[*place];
            let ids = if written.ids.is_empty() {
                String::new()
            } else {
                format!(" ({})", written.ids.join(", "))
            };
            self.line(&format!(
                "/* {}{} */",
                comment(&written.name),
                comment(&ids)
            ));
            if matches!(rule.when, Node::Const(_)) {
                // The last rule that is looked at.
                self.effect(&rule.then);
                break;
            }
            let next = self.label();
            self.jump(&rule.when, false, next);
            self.effect(&rule.then);
            self.line(&format!("goto l{done};"));
            self.meet(done);
            falls = self.labels[next].is_some();
            self.place(next, false);
        }
        self.place(done, falls);
    }

    pub(super) fn effect(&mut self, list: &[Stmt]) {
        self.at.1 = true;
        let mut ready = true;
        list.iter()
            .for_each(|s| s.expressions(&mut |n| ready &= self.known.satisfies(n)));
        let several = list.len() > 1 || matches!(list, [Stmt::If(..)]);
        if ready && several && !self.inside {
            self.line("d_step {");
            self.depth += 1;
            self.statements(list);
            self.depth -= 1;
            self.line("}");
        } else {
            self.statements(list);
        }
        self.at.1 = false;
    }

    pub(super) fn statements(&mut self, list: &[Stmt]) {
        for statement in list {
            match statement {
                Stmt::Assign {
                    base,
                    index,
                    value,
                    checked,
                    ..
                } => {
                    self.assign(*base as usize, index.as_ref(), value, *checked);
                }
                Stmt::If(branches, rest) => self.choice(branches, rest),
            }
        }
    }

    pub(super) fn choice(&mut self, branches: &[(Node, Vec<Stmt>)], rest: &[Stmt]) {
        let Some(((guard, body), others)) = branches.split_first() else {
            return self.statements(rest);
        };
        self.need(guard);
        let condition = self.value(guard);
        self.branch(
            &condition,
            |e| e.statements(body),
            |e| e.choice(others, rest),
        );
    }

    pub(super) fn assign(
        &mut self,
        base: usize,
        index: Option<&(Node, i64, u32)>,
        value: &Node,
        checked: bool,
    ) {
        let shared = self.shared;
        if let Some((k, ..)) = index {
            self.need(k);
        }
        self.need(value);
        self.scratch = 0;
        let mut text = self.text(value);
        let place = index.map(|(k, lo, len)| (self.small(k), *lo, *len as usize));
        let several = place.is_some() || checked;
        if several && value.size() > SMALL {
            text = self.keep(&text);
        }
        let write = |e: &mut Self| match &place {
            None => e.line(&format!("{} = {text};", shared.states[base])),
            Some((k, lo, len)) => {
                e.line("if");
                for n in 0..*len {
                    e.line(&format!(
                        ":: {k} == {} -> {} = {text};",
                        lo + n as i64,
                        shared.states[base + n]
                    ));
                }
                e.line(":: else");
                e.line("fi;");
            }
        };
        if checked {
            let (lo, hi) = shared.folded.bound.states[base];
            let outside = format!("({text} < {lo} || {text} > {hi})");
            self.branch(&outside, |e| e.line("fault = 1;"), write);
        } else {
            write(self);
        }
    }

    /// The properties that speak of single cycles.
    pub(super) fn properties(&mut self) {
        let shared = self.shared;
        for property in &shared.folded.bound.system.properties {
            let Form::Always { when, then } = &property.form else {
                continue;
            };
            let index = property.index.map_or(String::new(), |i| format!("[{i}]"));
            self.line(&format!(
                "/* {}{index}: {} */",
                comment(&property.id),
                comment(&property.text)
            ));
            let claim = &shared.folded.atoms[*then];
            let check = |e: &mut Self| {
                e.need(claim);
                let text = e.value(claim);
                e.line(&format!("assert({text});"));
            };
            match when.map(|k| &shared.folded.atoms[k]) {
                None | Some(Node::Const(1)) => check(self),
                Some(when) => {
                    let next = self.label();
                    self.jump(when, false, next);
                    check(self);
                    self.place(next, true);
                }
            }
        }
    }
}

/// The opposite of a truth value.
fn negated(node: &Node) -> Node {
    let (op, a, b) = match node {
        Node::Binary(BinaryOp::Eq, a, b) => (BinaryOp::Ne, a, b),
        Node::Binary(BinaryOp::Ne, a, b) => (BinaryOp::Eq, a, b),
        Node::Binary(BinaryOp::Lt, a, b) => (BinaryOp::Ge, a, b),
        Node::Binary(BinaryOp::Ge, a, b) => (BinaryOp::Lt, a, b),
        Node::Binary(BinaryOp::Gt, a, b) => (BinaryOp::Le, a, b),
        Node::Binary(BinaryOp::Le, a, b) => (BinaryOp::Gt, a, b),
        _ => return Node::Not(Box::new(node.clone())),
    };
    Node::Binary(op, a.clone(), b.clone())
}
