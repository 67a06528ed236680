//! Generates the Rust step function of a system: the second evaluator, at native speed.
//!
//! The text is plain Rust on fixed arrays, without allocation, so that it can also be called from proofs.

use crate::ir::{BinaryOp, Node, Space, Stmt, System};

/// Rust source of a struct `type_name` with the functions of `system`, and of the constant `table_name` that lists them.
///
/// The functions are generic over the reader of inputs, so that a proof can call them with its own; the constant holds
/// them for a reader known only at run time.
pub fn rust(system: &System, type_name: &str, table_name: &str) -> String {
    let layout = Layout::of(system);
    let head = "<R: FnMut(usize) -> i32 + ?Sized>";
    let args = format!(
        "f: &mut [i32; {}], p: &[i32; {}], r: &mut R",
        layout.cells,
        system.params.len()
    );
    let mut out = format!(
        "/// `{}`.\npub struct {type_name};\nimpl {type_name} {{\n",
        system.name
    );
    for (k, lazy) in system.lazies.iter().enumerate() {
        let cell = layout.lazies + k;
        out.push_str(&format!(
            "// {}\nfn lazy_{k}{head}({args}) -> i64 {{\n\
             if f[{cell}] == UNSET {{ let v = {}; f[{cell}] = v as i32; }}\ni64::from(f[{cell}])\n}}\n",
            lazy.name,
            layout.int(&lazy.value),
        ));
    }
    for (k, instance) in system.instances.iter().enumerate() {
        let result = "Result<(), u32>";
        out.push_str(&format!(
            "// {}\nfn step_{k}{head}({args}) -> {result} {{\n",
            instance.name
        ));
        for (n, rule) in instance.rules.iter().enumerate() {
            let cell = layout.fired + k;
            out.push_str(&format!(
                "// {}\nif {} {{ f[{cell}] = {};\n",
                rule.name,
                layout.truth(&rule.when),
                n + 1
            ));
            layout.statements(system, &rule.then, &mut out);
            out.push_str("return Ok(()); }\n");
        }
        out.push_str("Ok(())\n}\n");
    }
    let steps: String = (0..system.instances.len())
        .map(|k| format!("Self::step_{k}(f, p, r)?;\n"))
        .collect();
    let (states, end) = (system.states.len(), layout.fired);
    out.push_str(&format!(
        "/// Starts a cycle in `before` and makes its step.\n///\n/// # Errors\n/// The assignment whose value left its range.\n\
         pub fn step{head}(before: &[i32; {states}], {args}) -> Result<(), u32> {{\n\
         for k in 0..{states} {{ f[k] = before[k]; f[{states} + k] = before[k]; }}\n\
         for k in {inputs}..{end} {{ f[k] = UNSET; }}\nfor k in {end}..{cells} {{ f[k] = 0; }}\n{steps}Ok(())\n}}\n",
        inputs = layout.inputs,
        cells = layout.cells,
    ));
    let atoms = system.atoms.iter().map(|n| layout.truth(n)).collect();
    chooser(
        &mut out,
        "Truth of an atom",
        &format!("atom{head}(k: usize, {args}) -> bool"),
        "false",
        atoms,
    );
    let observed = system.observed.iter().map(|n| layout.int(n)).collect();
    chooser(
        &mut out,
        "An observed expression",
        &format!("observe{head}(k: usize, {args}) -> i64"),
        "0",
        observed,
    );
    let lazies = (0..system.lazies.len())
        .map(|k| format!("Self::lazy_{k}(f, p, r)"))
        .collect();
    chooser(
        &mut out,
        "A named expression",
        &format!("lazy{head}(k: usize, {args}) -> i64"),
        "0",
        lazies,
    );
    out.push_str(&format!(
        "}}\nconst {table_name}: Table = Table {{\n\
         name: {name:?}, fingerprint: {fingerprint}, cells: {cells}, states: {states}, inputs: {inputs}, lazies: {lazies}, fired: {fired},\n\
         step: |b, f, p, r| {{ let (f, p) = fixed(f, p)?; {type_name}::step(b.try_into().or(Err(WRONG_FRAME))?, f, p, r) }},\n\
         atom: |k, f, p, r| {{ let (f, p) = fixed(f, p)?; Ok({type_name}::atom(k, f, p, r)) }},\n\
         observe: |k, f, p, r| {{ let (f, p) = fixed(f, p)?; Ok({type_name}::observe(k, f, p, r)) }},\n\
         lazy: |k, f, p, r| {{ let (f, p) = fixed(f, p)?; Ok({type_name}::lazy(k, f, p, r)) }},\n}};\n",
        name = system.name,
        fingerprint = system.fingerprint(),
        cells = layout.cells,
        states = system.states.len(),
        inputs = system.inputs.len(),
        lazies = system.lazies.len(),
        fired = system.instances.len(),
    ));
    out
}

fn chooser(out: &mut String, text: &str, signature: &str, other: &str, arms: Vec<String>) {
    let arms: String = arms
        .iter()
        .enumerate()
        .map(|(k, e)| format!("{k} => {{ {e} }}\n"))
        .collect();
    out.push_str(&format!(
        "/// {text} in the cycle just made.\npub fn {signature} {{\nmatch k {{\n{arms}_ => {other},\n}}\n}}\n"
    ));
}

/// Where the cells of a cycle stand in the frame: state now, state before, inputs, named expressions, fired rules.
struct Layout {
    before: usize,
    inputs: usize,
    lazies: usize,
    fired: usize,
    cells: usize,
}

impl Layout {
    fn of(system: &System) -> Self {
        let before = system.states.len();
        let inputs = 2 * before;
        let lazies = inputs + system.inputs.len();
        let fired = lazies + system.lazies.len();
        Self {
            before,
            inputs,
            lazies,
            fired,
            cells: fired + system.instances.len(),
        }
    }

    fn statements(&self, system: &System, list: &[Stmt], out: &mut String) {
        for s in list {
            match s {
                Stmt::Assign {
                    base,
                    index,
                    value,
                    checked,
                    site,
                } => {
                    let cell = match index {
                        None => base.to_string(),
                        Some((k, lo, len)) => {
                            format!(
                                "({base} + ({} - {lo}).clamp(0, {}) as usize)",
                                self.int(k),
                                len - 1
                            )
                        }
                    };
                    out.push_str(&format!(
                        "{{ let k: usize = {cell}; let v = {};\n",
                        self.int(value)
                    ));
                    if *checked {
                        // Elements of an array share one range.
                        let var = &system.states[*base as usize].var;
                        out.push_str(&format!(
                            "if v < {} || v > {} {{ return Err({site}); }}\n",
                            self.int(&var.lo),
                            self.int(&var.hi)
                        ));
                    }
                    out.push_str("f[k] = v as i32; }\n");
                }
                Stmt::If(branches, rest) => {
                    for (n, (guard, body)) in branches.iter().enumerate() {
                        let head = if n == 0 { "if" } else { "} else if" };
                        out.push_str(&format!("{head} {} {{\n", self.truth(guard)));
                        self.statements(system, body, out);
                    }
                    if !rest.is_empty() {
                        out.push_str("} else {\n");
                        self.statements(system, rest, out);
                    }
                    out.push_str("}\n");
                }
            }
        }
    }

    fn load(&self, space: Space, cell: &str) -> String {
        match space {
            Space::Param => format!("i64::from(p[{cell}])"),
            Space::Now => format!("i64::from(f[{cell}])"),
            Space::Before => format!("i64::from(f[{} + {cell}])", self.before),
            Space::Input => format!("input(f, {}, {cell}, r)", self.inputs),
        }
    }

    fn truth(&self, node: &Node) -> String {
        match node {
            Node::Const(v) => (*v != 0).to_string(),
            Node::Not(a) => format!("!({})", self.truth(a)),
            Node::Binary(BinaryOp::And, a, b) => {
                format!("(({}) && ({}))", self.truth(a), self.truth(b))
            }
            Node::Binary(BinaryOp::Or, a, b) => {
                format!("(({}) || ({}))", self.truth(a), self.truth(b))
            }
            Node::Binary(BinaryOp::Xor, a, b) => {
                format!("(({}) ^ ({}))", self.truth(a), self.truth(b))
            }
            Node::Binary(op, a, b) if is_truth(node) => {
                let op = match op {
                    BinaryOp::Eq => "==",
                    BinaryOp::Ne => "!=",
                    BinaryOp::Lt => "<",
                    BinaryOp::Gt => ">",
                    BinaryOp::Le => "<=",
                    _ => ">=",
                };
                format!("(({}) {op} ({}))", self.int(a), self.int(b))
            }
            Node::Sel(g, a, b) => {
                format!(
                    "(if {} {{ {} }} else {{ {} }})",
                    self.truth(g),
                    self.truth(b),
                    self.truth(a)
                )
            }
            _ => format!("(({}) != 0)", self.int(node)),
        }
    }

    fn int(&self, node: &Node) -> String {
        match node {
            Node::Const(v) => format!("{v}i64"),
            Node::Cell(space, k) => self.load(*space, &k.to_string()),
            Node::Lazy(k) => format!("Self::lazy_{k}(f, p, r)"),
            Node::Element {
                space,
                base,
                lo,
                len,
                index,
            } => format!(
                "{{ let k: usize = {base} + ({} - {lo}).clamp(0, {}) as usize; {} }}",
                self.int(index),
                len - 1,
                self.load(*space, "k")
            ),
            Node::Neg(a) => format!("(-({}))", self.int(a)),
            Node::Abs(a) => format!("({}).abs()", self.int(a)),
            Node::Sel(g, a, b) => {
                format!(
                    "(if {} {{ {} }} else {{ {} }})",
                    self.truth(g),
                    self.int(b),
                    self.int(a)
                )
            }
            Node::Mux(k, values) => {
                let (last, first) = match values.split_last() {
                    Some((last, first)) => (self.int(last), first),
                    None => ("0i64".to_owned(), &[][..]),
                };
                let arms: String = first
                    .iter()
                    .enumerate()
                    .map(|(n, v)| format!("{n} => {{ {} }} ", self.int(v)))
                    .collect();
                format!("(match {} {{ {arms}_ => {{ {last} }} }})", self.int(k))
            }
            Node::Min(values) => self.nested("min", values),
            Node::Max(values) => self.nested("max", values),
            Node::Binary(op, a, b) if !is_truth(node) => {
                let op = match op {
                    BinaryOp::Add => "+",
                    BinaryOp::Sub => "-",
                    BinaryOp::Mul => "*",
                    BinaryOp::Div => "/",
                    _ => "%",
                };
                format!("(({}) {op} ({}))", self.int(a), self.int(b))
            }
            _ => format!("i64::from({})", self.truth(node)),
        }
    }

    fn nested(&self, name: &str, values: &[Node]) -> String {
        let mut nodes = values.iter().map(|n| self.int(n));
        let first = nodes.next().unwrap_or_else(|| "0i64".to_owned());
        nodes.fold(first, |acc, v| {
            format!("{{ let a: i64 = {acc}; let b: i64 = {v}; Ord::{name}(a, b) }}")
        })
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
