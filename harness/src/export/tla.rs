//! A system as a TLA+ module with the configurations for TLC.
//!
//! A step of the module is one cycle with any inputs. A property of single cycles is an invariant: in this state the claim
//! holds for all inputs. A cycle with a range fault is no step; that there is none is an invariant of its own. A
//! `reachable` property is the invariant that what it names is never seen, which TLC is to find violated.
//!
//! TLC ends with the first invariant that fails, and with -continue it judges no other one in the same state. So each
//! property has a configuration of its own: whatever the others are, its verdict comes out.

use std::fmt::Write;

use stillpoint_lang::bind::{Bound, Bounds};
use stillpoint_lang::ir::{BinaryOp, Ty, Var};

use super::Unsupported;
use super::about::{about, not_carried};
use super::circuit::{Circuit, Claim, Id};
use super::folded::Folded;
use super::syntax::{Syntax, usual};
use super::writer::{Naming, Writer, meaning, statement};

/// A module and its configurations.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tla {
    /// The module; its file must bear its name.
    pub module: String,
    /// The configuration with all that must hold.
    pub config: String,
    /// For each property the name of its invariant, and the configuration with this one alone.
    pub single: Vec<(String, String)>,
}

/// The module `name` of a system with its parameter values. `title` stands at its top.
///
/// # Errors
/// A system with values that need more than 32 bits; a name that is none in TLA+.
pub fn tla(bound: &Bound, title: &str, name: &str) -> Result<Tla, Unsupported> {
    if !is_name(name) {
        return Err(Unsupported(format!(
            "`{name}` cannot be the name of a TLA+ module, and a module must have that of its file: name the file with \
             letters, digits and underscores, a letter among them, for example `model.tla`"
        )));
    }
    let folded = Folded::new(bound)?;
    let circuit = Circuit::new(&folded)?;
    let mut writer = Writer::new(&circuit, Plus, Naming::Readable);
    let mut module = format!("---- MODULE {name} ----\n");
    header(&mut module, &circuit, title);
    module.push_str("EXTENDS Integers\n");
    declarations(&mut module, &writer);
    arithmetic(&mut module);
    initial(&mut module, &writer);
    next(&mut module, &writer);
    let (config, single) = invariants(&mut module, &mut writer);
    module.push_str("====\n");
    Ok(Tla {
        module,
        config,
        single,
    })
}

/// Whether TLA+ takes a text for a name.
fn is_name(name: &str) -> bool {
    name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && name.chars().any(|c| c.is_ascii_alphabetic())
        && !name.starts_with("WF_")
        && !name.starts_with("SF_")
}

/// The variable of a system without any, which TLC does not run: its one state. No name of the tables has this form.
const ONLY: &str = "only__state";

struct Plus;

impl Syntax for Plus {
    fn truth(&self, value: bool) -> &'static str {
        if value { "TRUE" } else { "FALSE" }
    }

    fn not(&self, a: &str) -> String {
        format!("(~{a})")
    }

    fn binary(&self, op: BinaryOp, a: &str, b: &str) -> String {
        let symbol = match op {
            // The language's own operators round down.
            BinaryOp::Div => return format!("Quotient({a}, {b})"),
            BinaryOp::Mod => return format!("Remainder({a}, {b})"),
            BinaryOp::And => "/\\",
            BinaryOp::Or => "\\/",
            BinaryOp::Xor | BinaryOp::Ne => "#",
            _ => usual(op),
        };
        format!("({a} {symbol} {b})")
    }

    fn choice(&self, condition: &str, a: &str, b: &str) -> String {
        format!("(IF {condition} THEN {a} ELSE {b})")
    }
}

fn header(out: &mut String, circuit: &Circuit, title: &str) {
    let mut lines = about(circuit.bound, title);
    lines.push(String::new());
    lines.push("Run: java -cp tla2tools.jar tlc2.TLC -deadlock FILE".to_owned());
    lines.push("One property: the same with -config MODULE.PROPERTY.cfg; those of never_... are to be found violated.".to_owned());
    lines.extend(not_carried(&circuit.left_out()));
    for line in lines {
        let _ = writeln!(out, "{}", format!("\\* {line}").trim_end());
    }
}

fn set(var: &Var, (lo, hi): Bounds) -> String {
    match var.ty {
        Ty::Bool => "BOOLEAN".to_owned(),
        _ => format!(
            "{}..{}",
            Plus.number(i64::from(lo)),
            Plus.number(i64::from(hi))
        ),
    }
}

fn declarations(out: &mut String, writer: &Writer<Plus>) {
    let circuit = writer.circuit;
    let names: Vec<&str> = circuit
        .variables()
        .map(|k| writer.states[k].as_str())
        .collect();
    if names.is_empty() {
        let _ = writeln!(out, "VARIABLES\n  {ONLY}\n\nstate == <<{ONLY}>>");
        return;
    }
    out.push_str("VARIABLES\n");
    for (n, k) in circuit.variables().enumerate() {
        let comma = if n + 1 < names.len() { "," } else { "" };
        let remark = meaning(circuit, &circuit.bound.system.states[k].var);
        let _ = writeln!(out, "  {}{comma} \\* {remark}", writer.states[k]);
    }
    let _ = writeln!(out, "\nstate == <<{}>>", names.join(", "));
}

/// Division as in IEC 61131-3: the quotient is truncated, the remainder has the sign of the dividend.
fn arithmetic(out: &mut String) {
    out.push_str(
        "\nMagnitude(a) == IF a < 0 THEN (-a) ELSE a\n\
         Quotient(a, b) ==\n  LET q == Magnitude(a) \\div Magnitude(b)\n  IN IF (a < 0) = (b < 0) THEN q ELSE (-q)\n\
         Remainder(a, b) == a - (b * Quotient(a, b))\n",
    );
}

fn initial(out: &mut String, writer: &Writer<Plus>) {
    let bound = writer.circuit.bound;
    out.push_str("\nInit ==\n");
    let mut types = String::new();
    let mut any = false;
    for k in writer.circuit.variables() {
        any = true;
        let var = &bound.system.states[k].var;
        let name = &writer.states[k];
        let set = set(var, bound.states[k]);
        let _ = match bound.initial[k] {
            Some(v) => writeln!(out, "  /\\ {name} = {}", writer.constant(var, v)),
            None => writeln!(out, "  /\\ {name} \\in {set}"),
        };
        let _ = writeln!(types, "  /\\ {name} \\in {set}");
    }
    if !any {
        let _ = writeln!(out, "  {ONLY} = 0");
        let _ = writeln!(types, "  {ONLY} = 0");
    }
    let _ = write!(out, "\nTypes ==\n{types}");
}

/// Quantifies over the inputs that `roots` depend on and gives the terms their names.
fn over(out: &mut String, writer: &Writer<Plus>, quantifier: &str, roots: &[Id]) {
    let bound = writer.circuit.bound;
    for k in writer.read(roots) {
        let set = set(&bound.system.inputs[k], bound.inputs[k]);
        let _ = writeln!(out, "  {quantifier} {} \\in {set} :", writer.inputs[k]);
    }
    let definitions = writer.definitions(roots);
    for (n, (id, name)) in definitions.iter().enumerate() {
        let head = if n == 0 { "  LET " } else { "      " };
        let remark = writer.remark(*id);
        let gap = if remark.is_empty() { "" } else { " \\* " };
        let _ = writeln!(out, "{head}{name} == {}{gap}{remark}", writer.value(*id));
    }
    if !definitions.is_empty() {
        out.push_str("  IN\n");
    }
}

fn next(out: &mut String, writer: &Writer<Plus>) {
    let circuit = writer.circuit;
    let variables: Vec<usize> = circuit.variables().collect();
    let roots: Vec<Id> = (variables.iter().map(|k| circuit.next[*k]))
        .chain(circuit.fault)
        .collect();
    out.push_str("\nNext ==\n");
    over(out, writer, "\\E", &roots);
    if let Some(fault) = circuit.fault {
        let _ = writeln!(out, "    /\\ {}", Plus.not(&writer.show(fault)));
    }
    for k in &variables {
        let _ = writeln!(
            out,
            "    /\\ {}' = {}",
            writer.states[*k],
            writer.show(circuit.next[*k])
        );
    }
    if variables.is_empty() {
        let _ = writeln!(out, "    /\\ {ONLY}' = {ONLY}");
    }
    out.push_str("\nSpec == Init /\\ [][Next]_state\n");
}

/// The invariants; the answer is the configuration that names those that must hold, and one for each.
fn invariants(out: &mut String, writer: &mut Writer<Plus>) -> (String, Vec<(String, String)>) {
    let circuit = writer.circuit;
    const SPEC: &str = "SPECIFICATION Spec\n";
    let mut config = format!("{SPEC}INVARIANT Types\n");
    let mut single = Vec::new();
    let mut alone = |name: &str, remark: &str| {
        single.push((name.to_owned(), format!("{SPEC}{remark}INVARIANT {name}\n")));
    };
    let mut add =
        |writer: &mut Writer<Plus>, prefix: &str, id: &str, remark: &str, term: Id, truth| {
            let name = writer.another(prefix, id);
            let _ = writeln!(out, "\n\\* {remark}\n{name} ==");
            over(out, writer, "\\A", &[term]);
            let text = writer.show(term);
            let text = if truth { text } else { Plus.not(&text) };
            let _ = writeln!(out, "    {text}");
            name
        };
    if let Some(fault) = circuit.fault {
        let name = add(
            writer,
            "p_",
            "range",
            "no value leaves its range",
            fault,
            false,
        );
        let _ = writeln!(config, "INVARIANT {name}");
        alone(&name, "");
    }
    let holds = |c: &Claim| statement(c);
    for claim in &circuit.claims {
        let name = add(writer, "p_", &claim.id(), &holds(claim), claim.term, true);
        let _ = writeln!(config, "INVARIANT {name}");
        alone(&name, "");
    }
    for goal in &circuit.goals {
        let name = add(writer, "never_", &goal.id(), &holds(goal), goal.term, false);
        alone(
            &name,
            "\\* To be found violated: its error trace is the witness.\n",
        );
    }
    (config, single)
}
