//! Generates the Rust step function of a system: the second evaluator, at native speed.
//!
//! The text is plain Rust on fixed arrays, without allocation, so that it can also be called from proofs.

use std::fmt::Write;

use crate::ir::{BinaryOp, Node, Space, Stmt, System};

/// Rust source of a module item `pub struct <type_name>;` that implements `Table` for `system`.
pub fn rust(system: &System, type_name: &str) -> String {
    let mut out = String::new();
    let (s, i, l, m) = (
        system.states.len(),
        system.inputs.len(),
        system.lazies.len(),
        system.instances.len(),
    );
    let frame = format!("Frame<{s}, {i}, {l}, {m}>");
    let writes = "writing to a String cannot fail";
    writeln!(
        out,
        "/// `{name}`.\npub struct {type_name};\nimpl {type_name} {{",
        name = system.name
    )
    .expect(writes);
    for (k, lazy) in system.lazies.iter().enumerate() {
        writeln!(
            out,
            "// {name}\n#[inline]\nfn lazy_{k}<R: FnMut(usize) -> i32>(f: &mut {frame}, p: &[i32], r: &mut R) -> i64 {{\n\
             if f.lazies[{k}] == UNSET {{ let v = {value}; f.lazies[{k}] = v as i32; }}\ni64::from(f.lazies[{k}])\n}}",
            name = lazy.name,
            value = int(&lazy.value),
        )
        .expect(writes);
    }
    for (k, instance) in system.instances.iter().enumerate() {
        writeln!(
            out,
            "// {name}\n#[inline]\nfn step_{k}<R: FnMut(usize) -> i32>(f: &mut {frame}, p: &[i32], r: &mut R) -> Result<(), u32> {{",
            name = instance.name
        )
        .expect(writes);
        for (n, rule) in instance.rules.iter().enumerate() {
            writeln!(
                out,
                "// {}\nif {} {{ f.fired[{k}] = {};",
                rule.name,
                truth(&rule.when),
                n + 1
            )
            .expect(writes);
            statements(system, &rule.then, &mut out);
            writeln!(out, "return Ok(()); }}").expect(writes);
        }
        writeln!(out, "Ok(())\n}}").expect(writes);
    }
    writeln!(out, "}}\nimpl Table for {type_name} {{").expect(writes);
    writeln!(
        out,
        "const NAME: &'static str = {:?};\nconst FINGERPRINT: u64 = {};\ntype Frame = {frame};",
        system.name,
        system.fingerprint()
    )
    .expect(writes);
    writeln!(
        out,
        "#[inline]\nfn step<R: FnMut(usize) -> i32>(f: &mut {frame}, p: &[i32], r: &mut R) -> Result<(), u32> {{"
    )
    .expect(writes);
    for k in 0..m {
        writeln!(out, "Self::step_{k}(f, p, r)?;").expect(writes);
    }
    writeln!(out, "Ok(())\n}}").expect(writes);
    let atoms: Vec<String> = system.atoms.iter().map(truth).collect();
    chooser(&mut out, &frame, "atom", "bool", "false", &atoms);
    let observed: Vec<String> = system.observed.iter().map(int).collect();
    chooser(&mut out, &frame, "observe", "i64", "0", &observed);
    let lazies: Vec<String> = (0..l).map(|k| format!("Self::lazy_{k}(f, p, r)")).collect();
    chooser(&mut out, &frame, "lazy", "i64", "0", &lazies);
    out.push_str("}\n");
    out
}

fn chooser(out: &mut String, frame: &str, name: &str, ty: &str, other: &str, arms: &[String]) {
    let arms: String =
        arms.iter().enumerate().map(|(k, e)| format!("{k} => {{ {e} }}\n")).collect();
    out.push_str(&format!(
        "fn {name}<R: FnMut(usize) -> i32>(k: usize, f: &mut {frame}, p: &[i32], r: &mut R) -> {ty} {{\nmatch k {{\n{arms}_ => {other},\n}}\n}}\n"
    ));
}

fn statements(system: &System, list: &[Stmt], out: &mut String) {
    for s in list {
        match s {
            Stmt::Assign { base, index, value, checked, site } => {
                let cell = match index {
                    None => base.to_string(),
                    Some((k, lo, len)) => {
                        format!("({base} + ({} - {lo}).clamp(0, {}) as usize)", int(k), len - 1)
                    }
                };
                out.push_str(&format!("{{ let k: usize = {cell}; let v = {};\n", int(value)));
                if *checked {
                    // Elements of an array share one range.
                    let var = &system.states[*base as usize].var;
                    out.push_str(&format!(
                        "if v < {} || v > {} {{ return Err({site}); }}\n",
                        int(&var.lo),
                        int(&var.hi)
                    ));
                }
                out.push_str("f.now[k] = v as i32; }\n");
            }
            Stmt::If(branches, rest) => {
                for (n, (guard, body)) in branches.iter().enumerate() {
                    let head = if n == 0 { "if" } else { "} else if" };
                    out.push_str(&format!("{head} {} {{\n", truth(guard)));
                    statements(system, body, out);
                }
                if !rest.is_empty() {
                    out.push_str("} else {\n");
                    statements(system, rest, out);
                }
                out.push_str("}\n");
            }
        }
    }
}

fn load(space: Space, cell: &str) -> String {
    match space {
        Space::Param => format!("i64::from(p[{cell}])"),
        Space::Before => format!("i64::from(f.before[{cell}])"),
        Space::Now => format!("i64::from(f.now[{cell}])"),
        Space::Input => format!("input(&mut f.inputs, {cell}, r)"),
    }
}

/// Whether the expression is naturally a Rust `bool`.
fn is_truth(node: &Node) -> bool {
    match node {
        Node::Not(_) => true,
        Node::Binary(op, ..) => !matches!(
            op,
            BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div | BinaryOp::Mod
        ),
        _ => false,
    }
}

fn truth(node: &Node) -> String {
    match node {
        Node::Const(v) => (*v != 0).to_string(),
        Node::Not(a) => format!("!({})", truth(a)),
        Node::Binary(BinaryOp::And, a, b) => format!("(({}) && ({}))", truth(a), truth(b)),
        Node::Binary(BinaryOp::Or, a, b) => format!("(({}) || ({}))", truth(a), truth(b)),
        Node::Binary(BinaryOp::Xor, a, b) => format!("(({}) ^ ({}))", truth(a), truth(b)),
        Node::Binary(op, a, b) if is_truth(node) => {
            let op = match op {
                BinaryOp::Eq => "==",
                BinaryOp::Ne => "!=",
                BinaryOp::Lt => "<",
                BinaryOp::Gt => ">",
                BinaryOp::Le => "<=",
                _ => ">=",
            };
            format!("(({}) {op} ({}))", int(a), int(b))
        }
        Node::Sel(g, a, b) => {
            format!("(if {} {{ {} }} else {{ {} }})", truth(g), truth(b), truth(a))
        }
        _ => format!("(({}) != 0)", int(node)),
    }
}

fn int(node: &Node) -> String {
    match node {
        Node::Const(v) => format!("{v}i64"),
        Node::Cell(space, k) => load(*space, &k.to_string()),
        Node::Lazy(k) => format!("Self::lazy_{k}(f, p, r)"),
        Node::Element { space, base, lo, len, index } => format!(
            "{{ let k: usize = {base} + ({} - {lo}).clamp(0, {}) as usize; {} }}",
            int(index),
            len - 1,
            load(*space, "k")
        ),
        Node::Neg(a) => format!("(-({}))", int(a)),
        Node::Abs(a) => format!("({}).abs()", int(a)),
        Node::Sel(g, a, b) => {
            format!("(if {} {{ {} }} else {{ {} }})", truth(g), int(b), int(a))
        }
        Node::Mux(k, values) => {
            let (last, first) = match values.split_last() {
                Some((last, first)) => (int(last), first),
                None => ("0i64".to_owned(), &[][..]),
            };
            let arms: String =
                first.iter().enumerate().map(|(n, v)| format!("{n} => {{ {} }} ", int(v))).collect();
            format!("(match {} {{ {arms}_ => {{ {last} }} }})", int(k))
        }
        Node::Min(values) => fold("min", values),
        Node::Max(values) => fold("max", values),
        Node::Binary(op, a, b) if !is_truth(node) => {
            let op = match op {
                BinaryOp::Add => "+",
                BinaryOp::Sub => "-",
                BinaryOp::Mul => "*",
                BinaryOp::Div => "/",
                _ => "%",
            };
            format!("(({}) {op} ({}))", int(a), int(b))
        }
        _ => format!("i64::from({})", truth(node)),
    }
}

fn fold(name: &str, values: &[Node]) -> String {
    let mut nodes = values.iter().map(int);
    let first = nodes.next().unwrap_or_else(|| "0i64".to_owned());
    nodes.fold(first, |acc, v| format!("{{ let a: i64 = {acc}; let b: i64 = {v}; Ord::{name}(a, b) }}"))
}
