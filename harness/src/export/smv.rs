//! A system as an SMV model, for nuXmv and NuSMV.
//!
//! The inputs are variables without an assignment: any value in every cycle. So a state of the model is a state of the
//! system together with the inputs of the cycle that begins there, and a property of single cycles is an invariant. A
//! cycle with a range fault leaves the state as it is; that there is none is an invariant of its own.
//!
//! A `reachable` property is the invariant that what it names is never seen, which is to be found false. (`EF` would have to
//! hold in every initial state, with every value of the inputs there, where one run is all that is asked for.)

use std::fmt::Write;

use stillpoint_lang::bind::{Bound, Bounds};
use stillpoint_lang::ir::{BinaryOp, Ty, Var};

use super::Unsupported;
use super::about::{about, not_carried};
use super::circuit::{Circuit, Op};
use super::folded::Folded;
use super::syntax::{Syntax, usual};
use super::writer::{Naming, Writer, meaning, statement};

/// The model of a system with its parameter values. `title` stands at its top.
///
/// # Errors
/// A system with values that need more than 32 bits.
pub fn smv(bound: &Bound, title: &str) -> Result<String, Unsupported> {
    let folded = Folded::new(bound)?;
    let circuit = Circuit::new(&folded)?;
    let mut writer = Writer::new(&circuit, Smv, Naming::Readable);
    let mut out = String::new();
    header(&mut out, &circuit, title);
    out.push_str("\nMODULE main\n");
    variables(&mut out, &writer);
    definitions(&mut out, &writer);
    assignments(&mut out, &writer);
    specifications(&mut out, &mut writer);
    Ok(out)
}

struct Smv;

impl Syntax for Smv {
    fn truth(&self, value: bool) -> &'static str {
        if value { "TRUE" } else { "FALSE" }
    }

    fn not(&self, a: &str) -> String {
        format!("!{a}")
    }

    fn binary(&self, op: BinaryOp, a: &str, b: &str) -> String {
        // Quotient and remainder are those of C.
        let symbol = match op {
            BinaryOp::Mod => "mod",
            _ => usual(op),
        };
        format!("({a} {symbol} {b})")
    }

    fn choice(&self, condition: &str, a: &str, b: &str) -> String {
        format!("({condition} ? {a} : {b})")
    }
}

fn header(out: &mut String, circuit: &Circuit, title: &str) {
    let mut lines = about(circuit.bound, title);
    lines.push(String::new());
    lines.push("Run: nuXmv FILE (NuSMV FILE)".to_owned());
    if !circuit.goals.is_empty() {
        lines.push("To be found false: the invariants never_...".to_owned());
    }
    lines.extend(not_carried(&circuit.left_out()));
    for line in lines {
        let _ = writeln!(out, "{}", format!("-- {line}").trim_end());
    }
}

fn type_of(var: &Var, (lo, hi): Bounds) -> String {
    match var.ty {
        Ty::Bool => "boolean".to_owned(),
        _ => format!("{lo}..{hi}"),
    }
}

fn variables(out: &mut String, writer: &Writer<Smv>) {
    let circuit = writer.circuit;
    let bound = circuit.bound;
    let mut lines = String::new();
    let mut declare = |name: &str, var: &Var, bounds: Bounds| {
        let ty = type_of(var, bounds);
        let _ = writeln!(lines, "  {name} : {ty}; -- {}", meaning(circuit, var));
    };
    for k in circuit.variables() {
        declare(
            &writer.states[k],
            &bound.system.states[k].var,
            bound.states[k],
        );
    }
    for k in writer.read(&circuit.roots()) {
        declare(&writer.inputs[k], &bound.system.inputs[k], bound.inputs[k]);
    }
    if !lines.is_empty() {
        let _ = write!(out, "VAR\n{lines}");
    }
}

fn definitions(out: &mut String, writer: &Writer<Smv>) {
    let definitions = writer.definitions(&writer.circuit.roots());
    if !definitions.is_empty() {
        out.push_str("DEFINE\n");
    }
    for (id, name) in definitions {
        let remark = writer.remark(id);
        let gap = if remark.is_empty() { "" } else { " -- " };
        let _ = writeln!(out, "  {name} := {};{gap}{remark}", writer.value(id));
    }
}

fn assignments(out: &mut String, writer: &Writer<Smv>) {
    let circuit = writer.circuit;
    let bound = circuit.bound;
    if circuit.variables().next().is_some() {
        out.push_str("ASSIGN\n");
    }
    for k in circuit.variables() {
        let name = &writer.states[k];
        if let Some(v) = bound.initial[k] {
            let value = writer.constant(&bound.system.states[k].var, v);
            let _ = writeln!(out, "  init({name}) := {value};");
        }
        let next = writer.show(circuit.next[k]);
        let next = match circuit.fault {
            Some(fault) if circuit.terms.op(circuit.next[k]) != Op::State(k) => {
                writer.syntax.choice(&writer.show(fault), name, &next)
            }
            _ => next,
        };
        let _ = writeln!(out, "  next({name}) := {next};");
    }
}

fn specifications(out: &mut String, writer: &mut Writer<Smv>) {
    let circuit = writer.circuit;
    if let Some(fault) = circuit.fault {
        let holds = writer.syntax.not(&writer.show(fault));
        let name = writer.another("p_", "range");
        let _ = writeln!(
            out,
            "-- no value leaves its range\nINVARSPEC NAME {name} := {holds};"
        );
    }
    for claim in &circuit.claims {
        let name = writer.another("p_", &claim.id());
        let text = writer.show(claim.term);
        let _ = writeln!(
            out,
            "-- {}\nINVARSPEC NAME {name} := {text};",
            statement(claim)
        );
    }
    for goal in &circuit.goals {
        let name = writer.another("never_", &goal.id());
        let text = writer.syntax.not(&writer.show(goal.term));
        let _ = writeln!(
            out,
            "-- {}\n-- To be found false: its counterexample is the witness.\nINVARSPEC NAME {name} := {text};",
            statement(goal)
        );
    }
}
