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

mod cycle;
mod value;

use std::collections::BTreeSet;
use std::fmt::Write;

use stillpoint_lang::bind::{Bound, Bounds};
use stillpoint_lang::ir::{Form, Stmt, Ty, Var};

use super::Unsupported;
use super::folded::Folded;
use super::known::{Known, without_inputs};
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
    let extra_states = u64::from(
        bound
            .initial
            .iter()
            .zip(&bound.states)
            .any(|(v, (lo, hi))| v.is_none() && lo < hi),
    );
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
            faults: folded
                .rules
                .iter()
                .flatten()
                .any(|(_, rule)| checked(&rule.then)),
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
    text.replace("*/", "* /")
        .replace("/*", "/ *")
        .replace('\n', " ")
}

fn header(out: &mut String, folded: &Folded, title: &str, extra_states: u64) {
    let bound = folded.bound;
    let system = &bound.system;
    let _ = writeln!(out, "/* {}", comment(title));
    let _ = writeln!(
        out,
        " * System {}, generated by stillpoint export.",
        comment(&system.name)
    );
    for (param, value) in system.params.iter().zip(&bound.values) {
        if param.reading.is_none() {
            let value = system.show(param.var.ty, i64::from(*value));
            let _ = writeln!(out, " * with {} = {value}", comment(&param.var.name));
        }
    }
    for (id, option) in bound.readings() {
        let _ = writeln!(out, " * reading {} = {}", comment(&id), comment(&option));
    }
    out.push_str(
        " *\n * Run: spin -a FILE && gcc -O3 -DSAFETY -DNOREDUCE -o pan pan.c && ./pan -m1000000\n",
    );
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
        let _ = writeln!(
            out,
            " * Not part of this model, since they do not speak of single cycles: {list}"
        );
    }
    out.push_str(" */\n\n");
}

fn declare(out: &mut String, range: (i64, i64), start: i64, name: &str, remark: &str) {
    let start = if start == 0 {
        String::new()
    } else {
        format!(" = {start}")
    };
    let remark = if remark.is_empty() {
        String::new()
    } else {
        format!(" /* {} */", comment(remark))
    };
    let _ = writeln!(out, "{} {name}{start};{remark}", type_of(range));
}

fn meaning(folded: &Folded, var: &Var) -> String {
    match var.ty {
        Ty::Enum(e) => folded.bound.system.enums.get(e).map_or(String::new(), |e| {
            let values: Vec<String> = e
                .values
                .iter()
                .enumerate()
                .map(|(n, v)| format!("{n} {v}"))
                .collect();
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
        declare(
            out,
            wide(bound.states[k]),
            start,
            &shared.states[k],
            &meaning(folded, &state.var),
        );
    }
    out.push_str("\n/* Of one cycle; between two cycles each has its least value. */\n");
    for k in used.inputs.iter().copied() {
        let range = wide(bound.inputs[k]);
        declare(
            out,
            range,
            range.0,
            &shared.inputs[k],
            &meaning(folded, &bound.system.inputs[k]),
        );
    }
    if used.combination {
        declare(out, (0, 255), 0, COMBINATION, "the inputs as one number");
    }
    for k in used.chosen.iter().copied() {
        declare(out, (0, 1), 0, &shared.chosen[k], "");
    }
    for k in used.lazies.iter().copied() {
        let range = folded.ranges[k];
        declare(
            out,
            range,
            range.0,
            &shared.lazies[k],
            &bound.system.lazies[k].name,
        );
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
