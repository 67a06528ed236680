//! A system as a Promela model for SPIN.
//!
//! One process makes one cycle as one `atomic` sequence, from state vector to state vector. Where there are many, inputs
//! are chosen where the cycle first needs them, so that SPIN does not enumerate what decides nothing. Everything that
//! is no state of the system has its least value between two cycles, and the process always stands at the same place
//! there. So the states SPIN stores are the reachable states of the system, and one more where the initial state is
//! chosen: the state before that choice ([`Promela::extra_states`]).
//!
//! A value that leaves its range and a broken `always` or `never` property are failed assertions. A cycle with a range
//! fault has no successor: when SPIN is told to go on (`pan -A`), it leaves the state as it was.

use std::collections::BTreeSet;
use std::fmt::Write;

use stillpoint_spec::bind::{Bound, Bounds};
use stillpoint_spec::ir::{BinaryOp, Form, Node, Space, Stmt, Ty, Var};

use super::Unsupported;
use super::fold::{Folded, size};
use super::known::{Known, Status, read_anywhere, without_inputs};
use super::names::Names;

/// Operands of at most so many nodes may be written twice.
const SMALL: usize = 3;
/// With at most so many combinations of inputs all are chosen at once and the rest of the cycle is one step: SPIN's stack,
/// whose depth counts each statement, stays short. With more of them it is worth to choose only what is needed.
const FEW: u128 = 64;
/// Name of the variable for a combination of inputs.
const COMBINATION: &str = "inputs";
/// Ranges of at most so many values are written out as alternatives.
const ALTERNATIVES: i64 = 16;

/// A Promela model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Promela {
    /// The text.
    pub text: String,
    /// States that SPIN stores beside the reachable states of the system: 1 where the initial state is chosen, else 0.
    pub extra_states: u64,
}

/// The model of a system with its parameter values. `title` stands at its top.
///
/// # Errors
/// A system with values that need more than 32 bits.
pub fn promela(bound: &Bound, title: &str) -> Result<Promela, Unsupported> {
    let folded = Folded::new(bound)?;
    let shared = Shared::new(&folded);
    // What the cycle uses is known after it was generated once; the second time it is generated with that knowledge.
    let first = Emitter::cycle(&shared, Used::default());
    let second = Emitter::cycle(&shared, first.found);
    let extra_states = u64::from(bound.initial.iter().zip(&bound.states).any(|(v, (lo, hi))| v.is_none() && lo < hi));
    let mut text = String::new();
    header(&mut text, &folded, title, extra_states);
    declarations(&mut text, &shared, &second.found);
    text.push_str("active proctype system() {\n");
    initial(&mut text, &shared);
    text.push_str("\tdo\n\t:: atomic {\n");
    text.push_str(&second.out);
    text.push_str("\t}\n\tod\n}\n");
    Ok(Promela { text, extra_states })
}

/// What all of the generation reads.
struct Shared<'a> {
    folded: &'a Folded<'a>,
    states: Vec<String>,
    before: Vec<String>,
    inputs: Vec<String>,
    chosen: Vec<String>,
    lazies: Vec<String>,
    evaluated: Vec<String>,
    /// The instance each state cell belongs to.
    owner: Vec<usize>,
    without_inputs: Vec<bool>,
    /// Whether a value can leave its range.
    faults: bool,
}

impl<'a> Shared<'a> {
    fn new(folded: &'a Folded<'a>) -> Self {
        let system = &folded.bound.system;
        let mut names = Names::default();
        let mut give = |prefix: &str, list: &mut dyn Iterator<Item = &str>| -> Vec<String> {
            list.map(|n| names.give(prefix, n)).collect()
        };
        let states = || system.states.iter().map(|s| s.var.name.as_str());
        let inputs = || system.inputs.iter().map(|v| v.name.as_str());
        let lazies = || system.lazies.iter().map(|l| l.name.as_str());
        let mut owner = vec![0; system.states.len()];
        for (k, instance) in system.instances.iter().enumerate() {
            for cell in instance.states.clone() {
                owner[cell as usize] = k;
            }
        }
        Self {
            states: give("s_", &mut states()),
            before: give("before_", &mut states()),
            inputs: give("in_", &mut inputs()),
            chosen: give("chosen_", &mut inputs()),
            lazies: give("v_", &mut lazies()),
            evaluated: give("has_", &mut lazies()),
            owner,
            without_inputs: without_inputs(folded),
            faults: folded.rules.iter().flatten().any(|(_, rule)| checked(&rule.then)),
            folded,
        }
    }
}

fn checked(list: &[Stmt]) -> bool {
    list.iter().any(|s| match s {
        Stmt::Assign { checked, .. } => *checked,
        Stmt::If(branches, rest) => branches.iter().any(|(_, body)| checked(body)) || checked(rest),
    })
}

/// Which variables the cycle needs.
#[derive(Debug, Default)]
struct Used {
    /// States that guards, values and properties read.
    read: BTreeSet<usize>,
    before: BTreeSet<usize>,
    inputs: BTreeSet<usize>,
    chosen: BTreeSet<usize>,
    lazies: BTreeSet<usize>,
    evaluated: BTreeSet<usize>,
    scratch: usize,
    combination: bool,
}

fn type_of((lo, hi): (i64, i64)) -> &'static str {
    match (lo, hi) {
        (0.., ..=1) => "bit",
        (0.., ..=255) => "byte",
        (-32768.., ..=32767) => "short",
        _ => "int",
    }
}

fn wide((lo, hi): Bounds) -> (i64, i64) {
    (i64::from(lo), i64::from(hi))
}

/// Text that cannot end a comment.
fn comment(text: &str) -> String {
    text.replace("*/", "* /").replace("/*", "/ *").replace('\n', " ")
}

fn header(out: &mut String, folded: &Folded, title: &str, extra_states: u64) {
    let bound = folded.bound;
    let system = &bound.system;
    let _ = writeln!(out, "/* {}", comment(title));
    let _ = writeln!(out, " * System {}, generated by stillpoint export.", comment(&system.name));
    for (param, value) in system.params.iter().zip(&bound.values) {
        if param.reading.is_none() {
            let value = system.show(param.var.ty, i64::from(*value));
            let _ = writeln!(out, " * with {} = {value}", comment(&param.var.name));
        }
    }
    for (id, option) in bound.readings() {
        let _ = writeln!(out, " * reading {} = {}", comment(&id), comment(&option));
    }
    out.push_str(" *\n * Run: spin -a FILE && gcc -O3 -DSAFETY -DNOREDUCE -o pan pan.c && ./pan -m1000000\n");
    if extra_states == 0 {
        out.push_str(" * \"states, stored\" is the number of reachable states of the system.\n");
    } else {
        out.push_str(
            " * \"states, stored\" is the number of reachable states of the system plus 1: the state before the initial\n \
             * state is chosen.\n",
        );
    }
    let elsewhere: Vec<&str> = system
        .properties
        .iter()
        .filter(|p| !matches!(p.form, Form::Always { .. }))
        .map(|p| p.id.as_str())
        .collect();
    if !elsewhere.is_empty() {
        let list = comment(&elsewhere.join(", "));
        let _ = writeln!(out, " * Not part of this model, since they do not speak of single cycles: {list}");
    }
    out.push_str(" */\n\n");
}

fn declare(out: &mut String, range: (i64, i64), start: i64, name: &str, remark: &str) {
    let start = if start == 0 { String::new() } else { format!(" = {start}") };
    let remark = if remark.is_empty() { String::new() } else { format!(" /* {} */", comment(remark)) };
    let _ = writeln!(out, "{} {name}{start};{remark}", type_of(range));
}

fn meaning(folded: &Folded, var: &Var) -> String {
    match var.ty {
        Ty::Enum(e) => folded.bound.system.enums.get(e).map_or(String::new(), |e| {
            let values: Vec<String> = e.values.iter().enumerate().map(|(n, v)| format!("{n} {v}")).collect();
            format!("{}: {}", var.name, values.join(", "))
        }),
        _ if var.text.is_empty() => var.name.clone(),
        _ => format!("{}: {}", var.name, var.text),
    }
}

fn declarations(out: &mut String, shared: &Shared, used: &Used) {
    let folded = shared.folded;
    let bound = folded.bound;
    out.push_str("/* the state */\n");
    for (k, state) in bound.system.states.iter().enumerate() {
        let start = i64::from(bound.initial[k].unwrap_or(bound.states[k].0));
        declare(out, wide(bound.states[k]), start, &shared.states[k], &meaning(folded, &state.var));
    }
    out.push_str("\n/* Of one cycle; between two cycles each has its least value. */\n");
    for k in used.inputs.iter().copied() {
        let range = wide(bound.inputs[k]);
        declare(out, range, range.0, &shared.inputs[k], &meaning(folded, &bound.system.inputs[k]));
    }
    if used.combination {
        declare(out, (0, 255), 0, COMBINATION, "the inputs as one number");
    }
    for k in used.chosen.iter().copied() {
        declare(out, (0, 1), 0, &shared.chosen[k], "");
    }
    for k in used.lazies.iter().copied() {
        let range = folded.ranges[k];
        declare(out, range, range.0, &shared.lazies[k], &bound.system.lazies[k].name);
    }
    for k in used.evaluated.iter().copied() {
        declare(out, (0, 1), 0, &shared.evaluated[k], "");
    }
    for k in used.before.iter().copied() {
        let range = wide(bound.states[k]);
        declare(out, range, range.0, &shared.before[k], "");
    }
    for k in 0..used.scratch {
        declare(out, (i64::MIN, i64::MAX), 0, &scratch(k), "");
    }
    if shared.faults {
        declare(out, (0, 1), 0, "fault", "a value has left its range");
    }
    out.push('\n');
}

fn scratch(k: usize) -> String {
    format!("x{k}")
}

fn initial(out: &mut String, shared: &Shared) {
    let bound = shared.folded.bound;
    let mut lines = String::new();
    for (k, value) in bound.initial.iter().enumerate() {
        if value.is_none() && bound.states[k].0 < bound.states[k].1 {
            choose(&mut lines, "\t\t", &shared.states[k], wide(bound.states[k]));
        }
    }
    if !lines.is_empty() {
        let _ = writeln!(out, "\tatomic {{\n\t\t/* any initial state */\n{lines}\t}}");
    }
}

fn choose(out: &mut String, indent: &str, name: &str, (lo, hi): (i64, i64)) {
    if hi - lo < ALTERNATIVES {
        let list: Vec<String> = (lo..=hi).map(|v| format!(":: {name} = {v}")).collect();
        let _ = writeln!(out, "{indent}if {} fi;", list.join(" "));
    } else {
        let _ = writeln!(out, "{indent}select ({name} : {lo} .. {hi});");
    }
}

/// Generates the statements of a cycle.
struct Emitter<'a> {
    shared: &'a Shared<'a>,
    /// What an earlier generation found to be needed.
    used: Used,
    /// What this one finds.
    found: Used,
    out: String,
    depth: usize,
    known: Known,
    /// What is known on the ways that lead to each label, of those not yet placed.
    labels: Vec<Option<Known>>,
    /// Whether a label stands right before.
    labelled: bool,
    /// Whether all of the rest is inside one `d_step`.
    inside: bool,
    /// The instance that steps, and whether its effect has begun.
    at: (usize, bool),
    scratch: usize,
}

impl<'a> Emitter<'a> {
    fn cycle(shared: &'a Shared<'a>, used: Used) -> Self {
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
        e.found.before = if shared.faults { (0..shared.states.len()).collect() } else { BTreeSet::new() };
        if folded.bound.combinations() <= FEW {
            e.all_inputs();
        }
        e.copies();
        for (k, instance) in folded.bound.system.instances.iter().enumerate() {
            e.at = (k, false);
            e.line(&format!("/* {}: {} */", comment(&instance.name), comment(&instance.machine)));
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

    fn line(&mut self, text: &str) {
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
    fn step(&mut self, lines: &[String]) {
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
    fn branch(&mut self, condition: &str, then: impl FnOnce(&mut Self), other: impl FnOnce(&mut Self)) {
        self.line("if");
        let before = self.known.clone();
        self.way(condition, then);
        let after = std::mem::replace(&mut self.known, before);
        self.way("else", other);
        self.known.join(&after);
        self.line("fi;");
    }

    fn way(&mut self, guard: &str, way: impl FnOnce(&mut Self)) {
        self.depth += 1;
        let start = self.out.len();
        way(self);
        let body = self.out.split_off(start);
        self.depth -= 1;
        self.line(&format!(":: {guard}{}", if body.is_empty() { "" } else { " ->" }));
        self.out.push_str(&body);
    }

    /// A label that jumps may name before it is placed.
    fn label(&mut self) -> usize {
        self.labels.push(None);
        self.labels.len() - 1
    }

    /// Notes that a way from here leads to a label.
    fn meet(&mut self, label: usize) {
        match &mut self.labels[label] {
            Some(known) => known.join(&self.known),
            none => *none = Some(self.known.clone()),
        }
    }

    /// The place of a label. `falls` says whether what stands before it also leads here.
    fn place(&mut self, label: usize, falls: bool) {
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
    fn jump(&mut self, node: &Node, truth: bool, label: usize) {
        match node {
            Node::Not(a) => self.jump(a, !truth, label),
            Node::Binary(op @ (BinaryOp::And | BinaryOp::Or), a, b) if !self.known.satisfies(node) => {
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
                let condition = if truth { self.value(node) } else { self.value(&negated(node)) };
                self.line(&format!("if :: {condition} -> goto l{label} :: else fi;"));
                self.meet(label);
            }
        }
    }

    /// Chooses all inputs at once, as one number, and begins the step that makes the rest of the cycle.
    fn all_inputs(&mut self) {
        let shared = self.shared;
        let bounds = &shared.folded.bound.inputs;
        let read: Vec<usize> = read_anywhere(shared.folded).into_iter().collect();
        let count = read.iter().map(|k| i64::from(bounds[*k].1) - i64::from(bounds[*k].0) + 1).product::<i64>();
        if count > 1 {
            let list: Vec<String> = (0..count).map(|n| format!(":: {COMBINATION} = {n}")).collect();
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
            let text = if lo == 0 { digit } else { format!("{lo} + {digit}") };
            self.line(&format!("{} = {text};", shared.inputs[k]));
            self.found.inputs.insert(k);
            self.known.inputs[k] = Status::Yes;
            weight *= size;
        }
    }

    /// The states at the start of the cycle, where something reads them after a rule has changed them.
    fn copies(&mut self) {
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

    fn restore(&mut self) {
        let back = |k: &usize| format!("{} = {};", self.shared.states[*k], self.shared.before[*k]);
        let lines: Vec<String> = self.used.before.iter().map(back).collect();
        self.step(&lines);
    }

    /// Everything that is no state gets its least value again.
    fn reset(&mut self) {
        let (shared, used) = (self.shared, &self.used);
        let bound = shared.folded.bound;
        let mut lines = Vec::new();
        let mut set = |name: &str, value: i64| lines.push(format!("{name} = {value};"));
        used.inputs.iter().for_each(|k| set(&shared.inputs[*k], i64::from(bound.inputs[*k].0)));
        used.chosen.iter().for_each(|k| set(&shared.chosen[*k], 0));
        used.lazies.iter().for_each(|k| set(&shared.lazies[*k], shared.folded.ranges[*k].0));
        used.evaluated.iter().for_each(|k| set(&shared.evaluated[*k], 0));
        used.before.iter().for_each(|k| set(&shared.before[*k], i64::from(bound.states[*k].0)));
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
    fn rules(&mut self, instance: usize) {
        let shared = self.shared;
        let done = self.label();
        let mut falls = true;
        for (place, rule) in &shared.folded.rules[instance] {
            let written = &shared.folded.bound.system.instances[instance].rules[*place];
            let ids = if written.ids.is_empty() { String::new() } else { format!(" ({})", written.ids.join(", ")) };
            self.line(&format!("/* {}{} */", comment(&written.name), comment(&ids)));
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

    fn effect(&mut self, list: &[Stmt]) {
        self.at.1 = true;
        let mut ready = true;
        list.iter().for_each(|s| s.expressions(&mut |n| ready &= self.known.satisfies(n)));
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

    fn statements(&mut self, list: &[Stmt]) {
        for statement in list {
            match statement {
                Stmt::Assign { base, index, value, checked, .. } => {
                    self.assign(*base as usize, index.as_ref(), value, *checked);
                }
                Stmt::If(branches, rest) => self.choice(branches, rest),
            }
        }
    }

    fn choice(&mut self, branches: &[(Node, Vec<Stmt>)], rest: &[Stmt]) {
        let Some(((guard, body), others)) = branches.split_first() else {
            return self.statements(rest);
        };
        self.need(guard);
        let condition = self.value(guard);
        self.branch(&condition, |e| e.statements(body), |e| e.choice(others, rest));
    }

    fn assign(&mut self, base: usize, index: Option<&(Node, i64, u32)>, value: &Node, checked: bool) {
        let shared = self.shared;
        if let Some((k, ..)) = index {
            self.need(k);
        }
        self.need(value);
        self.scratch = 0;
        let mut text = self.text(value);
        let place = index.map(|(k, lo, len)| (self.small(k), *lo, *len as usize));
        let several = place.is_some() || checked;
        if several && size(value) > SMALL {
            text = self.keep(&text);
        }
        let write = |e: &mut Self| match &place {
            None => e.line(&format!("{} = {text};", shared.states[base])),
            Some((k, lo, len)) => {
                e.line("if");
                for n in 0..*len {
                    e.line(&format!(":: {k} == {} -> {} = {text};", lo + n as i64, shared.states[base + n]));
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
    fn properties(&mut self) {
        let shared = self.shared;
        for property in &shared.folded.bound.system.properties {
            let Form::Always { when, then } = &property.form else {
                continue;
            };
            let index = property.index.map_or(String::new(), |i| format!("[{i}]"));
            self.line(&format!("/* {}{index}: {} */", comment(&property.id), comment(&property.text)));
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

    /// Chooses the inputs and evaluates the named expressions that the value of `node` needs.
    fn need(&mut self, node: &Node) {
        if self.known.satisfies(node) {
            return;
        }
        match node {
            Node::Cell(Space::Input, k) => self.read(*k as usize),
            Node::Lazy(k) => self.evaluate(*k as usize),
            Node::Element { space, base, len, index, .. } => {
                self.need(index);
                if *space == Space::Input {
                    (*base..base + len).for_each(|k| self.read(k as usize));
                }
            }
            Node::Binary(op @ (BinaryOp::And | BinaryOp::Or), a, b) => {
                self.need(a);
                if self.known.satisfies(b) {
                    return;
                }
                let condition = self.value(a);
                match op {
                    BinaryOp::And => self.branch(&condition, |e| e.need(b), |_| ()),
                    _ => self.branch(&condition, |_| (), |e| e.need(b)),
                }
            }
            Node::Sel(g, a, b) => {
                self.need(g);
                if !self.known.satisfies(a) || !self.known.satisfies(b) {
                    let condition = self.value(g);
                    self.branch(&condition, |e| e.need(b), |e| e.need(a));
                }
            }
            Node::Mux(k, values) => {
                self.need(k);
                self.need_of(k, 0, values);
            }
            _ => node.children().into_iter().for_each(|n| self.need(n)),
        }
    }

    /// What the chosen one of `values` needs, of which the first has number `first`.
    fn need_of(&mut self, selector: &Node, first: usize, values: &[Node]) {
        match values {
            [] => {}
            [last] => self.need(last),
            [_, ..] if values.iter().all(|v| self.known.satisfies(v)) => {}
            [value, rest @ ..] => {
                let k = self.value(selector);
                let condition = format!("({k} == {first})");
                self.branch(&condition, |e| e.need(value), |e| e.need_of(selector, first + 1, rest));
            }
        }
    }

    fn read(&mut self, k: usize) {
        let shared = self.shared;
        let flagged = self.used.chosen.contains(&k);
        self.found.inputs.insert(k);
        let any = |e: &mut Self| {
            choose(&mut e.out, &"\t".repeat(e.depth), &shared.inputs[k], wide(shared.folded.bound.inputs[k]));
            if flagged {
                e.line(&format!("{} = 1;", shared.chosen[k]));
            }
        };
        match self.known.inputs[k] {
            Status::Yes => {}
            Status::No => any(self),
            Status::Maybe => {
                self.found.chosen.insert(k);
                self.branch(&shared.chosen[k], |_| (), any);
            }
        }
        self.known.inputs[k] = Status::Yes;
    }

    fn evaluate(&mut self, k: usize) {
        let shared = self.shared;
        let node = &shared.folded.lazies[k];
        let flagged = self.used.evaluated.contains(&k);
        self.found.lazies.insert(k);
        let compute = |e: &mut Self| {
            e.need(node);
            let text = e.value(node);
            e.line(&format!("{} = {text};", shared.lazies[k]));
            if flagged {
                e.line(&format!("{} = 1;", shared.evaluated[k]));
            }
        };
        let status = self.known.lazies[k];
        // Evaluating again what needs no choice is shorter than asking.
        if status == Status::No || shared.without_inputs[k] || self.known.satisfies(node) {
            compute(self);
        } else {
            self.found.evaluated.insert(k);
            self.branch(&shared.evaluated[k], |_| (), compute);
        }
        self.known.lazies[k] = Status::Yes;
    }

    /// The text of an expression, which must be satisfied. Scratch variables of earlier ones are free again.
    fn value(&mut self, node: &Node) -> String {
        self.scratch = 0;
        self.text(node)
    }

    /// A scratch variable with a value.
    fn keep(&mut self, text: &str) -> String {
        let name = scratch(self.scratch);
        self.scratch += 1;
        self.found.scratch = self.found.scratch.max(self.scratch);
        self.line(&format!("{name} = {text};"));
        name
    }

    /// The text of an expression that will stand several times.
    fn small(&mut self, node: &Node) -> String {
        let text = self.text(node);
        if size(node) <= SMALL && !matches!(node, Node::Min(_) | Node::Max(_)) { text } else { self.keep(&text) }
    }

    /// What is evaluated without being needed has a value too: every variable always holds one of its range.
    fn text(&mut self, node: &Node) -> String {
        match node {
            Node::Const(v) if *v < 0 => format!("({v})"),
            Node::Const(v) => v.to_string(),
            Node::Cell(space, k) => self.cell(*space, *k as usize),
            Node::Lazy(k) => {
                self.found.lazies.insert(*k as usize);
                self.shared.lazies[*k as usize].clone()
            }
            Node::Element { space, base, lo, len, index } => {
                let k = self.small(index);
                let cells: Vec<String> =
                    (*base..base + len).map(|cell| self.cell(*space, cell as usize)).collect();
                pick(&k, *lo, cells)
            }
            Node::Not(a) => format!("!({})", self.text(a)),
            Node::Neg(a) => format!("(-({}))", self.text(a)),
            Node::Abs(a) => {
                let a = self.small(a);
                format!("({a} < 0 -> -({a}) : {a})")
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.text(a), self.text(b));
                format!("({a} {} {b})", operator(*op))
            }
            Node::Sel(g, a, b) => {
                let (g, a, b) = (self.text(g), self.text(a), self.text(b));
                format!("({g} -> {b} : {a})")
            }
            Node::Mux(k, values) => {
                let k = self.small(k);
                let values = values.iter().map(|v| self.text(v)).collect();
                pick(&k, 0, values)
            }
            Node::Min(values) => self.extreme("<", values),
            Node::Max(values) => self.extreme(">", values),
        }
    }

    fn extreme(&mut self, order: &str, values: &[Node]) -> String {
        let Some((first, rest)) = values.split_first() else {
            return "0".to_owned();
        };
        let mut best = if rest.is_empty() { self.text(first) } else { self.small(first) };
        for (n, value) in rest.iter().enumerate() {
            let other = self.small(value);
            let text = format!("({best} {order} {other} -> {best} : {other})");
            best = if n + 1 < rest.len() { self.keep(&text) } else { text };
        }
        best
    }

    fn cell(&mut self, space: Space, k: usize) -> String {
        let shared = self.shared;
        if matches!(space, Space::Before | Space::Now) {
            self.found.read.insert(k);
        }
        match space {
            // Folded where the index is constant.
            Space::Param => shared.folded.bound.values[k].to_string(),
            Space::Now => shared.states[k].clone(),
            Space::Before => {
                let (instance, begun) = self.at;
                let owner = shared.owner[k];
                if owner < instance || (owner == instance && begun) {
                    self.found.before.insert(k);
                    shared.before[k].clone()
                } else {
                    shared.states[k].clone()
                }
            }
            Space::Input => {
                self.found.inputs.insert(k);
                shared.inputs[k].clone()
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

/// The one of `values` whose number is `k`; the first has number `first`, the last stands for all others.
fn pick(k: &str, first: i64, mut values: Vec<String>) -> String {
    let Some(mut text) = values.pop() else {
        return "0".to_owned();
    };
    for (n, value) in values.iter().enumerate().rev() {
        text = format!("({k} == {} -> {value} : {text})", first + n as i64);
    }
    text
}

fn operator(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::And => "&&",
        BinaryOp::Or => "||",
        BinaryOp::Xor | BinaryOp::Ne => "!=",
        BinaryOp::Eq => "==",
        BinaryOp::Lt => "<",
        BinaryOp::Gt => ">",
        BinaryOp::Le => "<=",
        BinaryOp::Ge => ">=",
        BinaryOp::Add => "+",
        BinaryOp::Sub => "-",
        BinaryOp::Mul => "*",
        BinaryOp::Div => "/",
        BinaryOp::Mod => "%",
    }
}
