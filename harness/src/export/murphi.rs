//! A system as a Murphi model, for rumur.
//!
//! The states of the model are those of the system, each cycle is one firing of the rule `cycle`: one for each state and
//! each combination of the inputs that the step reads. A rule for each property judges the cycle and changes nothing, so that
//! all states are visited whatever the verdicts are, if rumur is told to go on after errors. Each property is one message.
//!
//! A rule ends with the first assertion that fails in it: two properties in one rule would hide one another.

use std::fmt::Write;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{BinaryOp, Var};

use super::Unsupported;
use super::about::{about, not_carried};
use super::circuit::{Circuit, Claim, Id, Op, Sort};
use super::folded::Folded;
use super::syntax::{Syntax, usual};
use super::writer::{Naming, Writer, meaning, statement};

/// What rumur says of a cycle in which a value leaves its range.
pub const RANGE: &str = "range: a value leaves its range";

/// The model of a system with its parameter values. `title` stands at its top.
///
/// # Errors
/// A system with values that need more than 32 bits.
pub fn murphi(bound: &Bound, title: &str) -> Result<String, Unsupported> {
    let folded = Folded::new(bound)?;
    let circuit = Circuit::new(&folded)?;
    let mut writer = Writer::new(&circuit, Murphi, Naming::Sparing);
    let mut out = String::new();
    header(&mut out, &circuit, title);
    variables(&mut out, &writer);
    initial(&mut out, &writer);
    cycle(&mut out, &mut writer);
    judge(&mut out, &writer);
    Ok(out)
}

struct Murphi;

impl Syntax for Murphi {
    fn truth(&self, value: bool) -> &'static str {
        if value { "true" } else { "false" }
    }

    fn not(&self, a: &str) -> String {
        format!("!{a}")
    }

    fn binary(&self, op: BinaryOp, a: &str, b: &str) -> String {
        format!("({a} {} {b})", usual(op))
    }

    fn choice(&self, condition: &str, a: &str, b: &str) -> String {
        format!("({condition} ? {a} : {b})")
    }
}

fn header(out: &mut String, circuit: &Circuit, title: &str) {
    let mut lines = about(circuit.bound, title);
    lines.extend([
        String::new(),
        "Run: rumur --deadlock-detection off --value-type int32_t --pack-state off --output FILE.c FILE".to_owned(),
        "     gcc -O3 -mcx16 -pthread -o verifier FILE.c && ./verifier".to_owned(),
        "With --max-errors N, N large, it goes on after errors; \"states\" is then the number of reachable states."
            .to_owned(),
    ]);
    lines.extend(not_carried(&circuit.left_out()));
    for line in lines {
        let _ = writeln!(out, "{}", format!("-- {line}").trim_end());
    }
}

fn type_of(var: &Var, (lo, hi): (i32, i32)) -> String {
    match var.ty {
        stillpoint_lang::ir::Ty::Bool => "boolean".to_owned(),
        _ => format!("{lo}..{hi}"),
    }
}

fn variables(out: &mut String, writer: &Writer<Murphi>) {
    let circuit = writer.circuit;
    let bound = circuit.bound;
    out.push_str("\nvar\n");
    for k in circuit.variables() {
        let var = &bound.system.states[k].var;
        let _ = writeln!(
            out,
            "  {}: {}; -- {}",
            writer.states[k],
            type_of(var, bound.states[k]),
            meaning(circuit, var)
        );
    }
}

/// Opens a ruleset over inputs or state variables; the answer is what closes it.
fn ruleset(out: &mut String, list: &[(&str, String)]) -> &'static str {
    if list.is_empty() {
        return "";
    }
    let list: Vec<String> = list.iter().map(|(n, ty)| format!("{n}: {ty}")).collect();
    let _ = writeln!(out, "ruleset {} do", list.join("; "));
    "endruleset;\n"
}

fn initial(out: &mut String, writer: &Writer<Murphi>) {
    let circuit = writer.circuit;
    let bound = circuit.bound;
    let mut any = Vec::new();
    let mut lines = String::new();
    for k in circuit.variables() {
        let var = &bound.system.states[k].var;
        let name = &writer.states[k];
        match bound.initial[k] {
            Some(v) => {
                let _ = writeln!(lines, "  {name} := {};", writer.constant(var, v));
            }
            None => {
                let first = format!("any_{name}");
                let _ = writeln!(lines, "  {name} := {first};");
                any.push((first, type_of(var, bound.states[k])));
            }
        }
    }
    out.push('\n');
    let any: Vec<(&str, String)> = any.iter().map(|(n, t)| (n.as_str(), t.clone())).collect();
    let end = ruleset(out, &any);
    let _ = write!(
        out,
        "startstate \"initial\"\nbegin\n{lines}endstartstate;\n{end}"
    );
}

fn inputs<'a>(writer: &'a Writer<Murphi>, roots: &[Id]) -> Vec<(&'a str, String)> {
    let bound = writer.circuit.bound;
    let read = writer.read(roots).into_iter();
    read.map(|k| {
        (
            writer.inputs[k].as_str(),
            type_of(&bound.system.inputs[k], bound.inputs[k]),
        )
    })
    .collect()
}

/// The head of a rule and the values of the terms it names.
fn open(out: &mut String, writer: &Writer<Murphi>, name: &str, roots: &[Id], more: &str) {
    let definitions = writer.definitions(roots);
    let _ = writeln!(out, "rule \"{name}\"");
    if !definitions.is_empty() || !more.is_empty() {
        out.push_str("var\n");
    }
    for (id, name) in &definitions {
        let ty = match writer.circuit.terms.sort(*id) {
            Sort::Truth => "boolean".to_owned(),
            Sort::Number(lo, hi) => format!("{lo}..{hi}"),
        };
        let _ = writeln!(out, "  {name}: {ty};");
    }
    let _ = writeln!(out, "{more}begin");
    for (id, name) in definitions {
        let remark = writer.remark(id);
        let remark = if remark.is_empty() {
            remark
        } else {
            format!(" -- {remark}")
        };
        let _ = writeln!(out, "  {name} := {};{remark}", writer.value(id));
    }
}

fn cycle(out: &mut String, writer: &mut Writer<Murphi>) {
    let circuit = writer.circuit;
    let changed: Vec<usize> = circuit
        .variables()
        .filter(|k| circuit.terms.op(circuit.next[*k]) != Op::State(*k))
        .collect();
    // A variable that takes the value of another takes the one from before the assignments.
    let mut declared = String::new();
    let mut kept = String::new();
    let mut assigned = String::new();
    for k in changed.iter().copied() {
        let target = &writer.states[k].clone();
        let value = writer.show(circuit.next[k]);
        let value = if matches!(circuit.terms.op(circuit.next[k]), Op::State(_)) {
            let name = writer.another("next_", &circuit.bound.system.states[k].var.name);
            let ty = type_of(&circuit.bound.system.states[k].var, circuit.bound.states[k]);
            let _ = writeln!(declared, "  {name}: {ty};");
            let _ = writeln!(kept, "  {name} := {value};");
            name
        } else {
            value
        };
        let _ = writeln!(assigned, "  {target} := {value};");
    }
    let roots: Vec<Id> = (changed.iter().map(|k| circuit.next[*k]))
        .chain(circuit.fault)
        .collect();
    out.push('\n');
    let end = ruleset(out, &inputs(writer, &roots));
    open(out, writer, "cycle", &roots, &declared);
    if let Some(fault) = circuit.fault {
        let fault = writer.show(fault);
        let _ = writeln!(out, "  if {fault} then error \"{RANGE}\"; endif;");
    }
    let _ = write!(out, "{kept}{assigned}endrule;\n{end}");
}

fn judge(out: &mut String, writer: &Writer<Murphi>) {
    let circuit = writer.circuit;
    let mut say = |word: &str, claim: &Claim| {
        let quoted = |text: String| text.replace('\\', "/").replace('"', "'");
        let roots = [claim.term];
        out.push('\n');
        let end = ruleset(out, &inputs(writer, &roots));
        open(
            out,
            writer,
            &quoted(format!("judge {}", claim.id())),
            &roots,
            "",
        );
        let message = quoted(statement(claim));
        let _ = writeln!(out, "  {word} {} \"{message}\";", writer.show(claim.term));
        let _ = write!(out, "endrule;\n{end}");
    };
    circuit.claims.iter().for_each(|c| say("assert", c));
    circuit.goals.iter().for_each(|c| say("cover", c));
}
