//! An interpreter of programs, and random programs: what a program does statement by statement is what its table does.
//!
//! It shares the syntax tree with the translation and nothing else: it has values where that has names, and keeps the variables of a
//! program in a map from cycle to cycle.

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;

use crate::st::ast::{BinaryOp, Expr, ExprKind, File, Stmt, StmtKind, UnaryOp};
use crate::st::{Signature, compile, parse};

/// How a list of statements ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Normal,
    Exit,
    Return,
}

type Values = BTreeMap<String, i64>;

fn value(e: &Expr, values: &Values) -> i64 {
    match &e.kind {
        ExprKind::Bool(b) => i64::from(*b),
        ExprKind::Int(v) => *v,
        ExprKind::Name(name) => values[name],
        ExprKind::Unary(UnaryOp::Not, a) => 1 - value(a, values),
        ExprKind::Unary(UnaryOp::Neg, a) => -value(a, values),
        ExprKind::Binary(op, a, b) => {
            let (a, b) = (value(a, values), value(b, values));
            let truth = i64::from;
            match op {
                BinaryOp::Or => a | b,
                BinaryOp::Xor => a ^ b,
                BinaryOp::And => a & b,
                BinaryOp::Eq => truth(a == b),
                BinaryOp::Ne => truth(a != b),
                BinaryOp::Lt => truth(a < b),
                BinaryOp::Gt => truth(a > b),
                BinaryOp::Le => truth(a <= b),
                BinaryOp::Ge => truth(a >= b),
                BinaryOp::Add => a + b,
                BinaryOp::Sub => a - b,
                BinaryOp::Mul => a * b,
                BinaryOp::Div => a / b,
                BinaryOp::Mod => a % b,
            }
        }
        ExprKind::Call(name, args) => {
            let args: Vec<i64> = args.iter().map(|a| value(&a.value, values)).collect();
            match name.text.as_str() {
                "SEL" => args[if args[0] == 0 { 1 } else { 2 }],
                "MIN" => args[0].min(args[1]),
                "MAX" => args[0].max(args[1]),
                "LIMIT" => args[1].min(args[2]).max(args[0]),
                other => panic!("{other}"),
            }
        }
        other => panic!("{other:?}"),
    }
}

/// Runs statements; `None` where a value leaves the range of its variable, 0..7 for those named `x..`.
fn run(body: &[Stmt], values: &mut Values) -> Option<End> {
    for statement in body {
        let end = match &statement.kind {
            StmtKind::Assign(target, e) => {
                let ExprKind::Name(name) = &target.kind else {
                    panic!("{target:?}")
                };
                set(name, value(e, values), values)?;
                End::Normal
            }
            StmtKind::If(branches, rest) => {
                let taken = branches.iter().find(|(guard, _)| value(guard, values) != 0);
                run(taken.map_or(rest, |(_, body)| body), values)?
            }
            StmtKind::Case(selector, branches, rest) => {
                let chosen = value(selector, values);
                let taken = branches.iter().find(|(labels, _)| {
                    labels.iter().any(|label| {
                        let first = value(&label.first, values);
                        let last = label
                            .last
                            .as_ref()
                            .map_or(first, |last| value(last, values));
                        (first..=last).contains(&chosen)
                    })
                });
                run(taken.map_or(rest, |(_, body)| body), values)?
            }
            StmtKind::For(counted) => {
                let (mut k, to) = (value(&counted.from, values), value(&counted.to, values));
                let by = counted.by.as_ref().map_or(1, |by| value(by, values));
                let mut end = End::Normal;
                while end == End::Normal && if by > 0 { k <= to } else { k >= to } {
                    set(&counted.variable.text, k, values)?;
                    end = run(&counted.body, values)?;
                    k += by;
                }
                if end == End::Return {
                    End::Return
                } else {
                    End::Normal
                }
            }
            StmtKind::Return => End::Return,
            StmtKind::Exit => End::Exit,
            StmtKind::Call(..) => panic!("{statement:?}"),
        };
        if end != End::Normal {
            return Some(end);
        }
    }
    Some(End::Normal)
}

fn set(name: &str, value: i64, values: &mut Values) -> Option<()> {
    if name.starts_with('x') && !(0..=7).contains(&value) {
        return None;
    }
    values.insert(name.to_owned(), value);
    Some(())
}

/// Numbers that look random and are the same in each run (xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % n
    }

    fn of<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len() as u64) as usize]
    }

    fn truth(&mut self, depth: u32) -> String {
        match self.below(if depth == 0 { 3 } else { 9 }) {
            0 | 1 => self.of(&["a", "b", "u", "v", "p"]).to_owned(),
            2 => self.of(&["TRUE", "FALSE", "a", "v"]).to_owned(),
            3 => format!("NOT {}", self.truth(0)),
            4..=6 => {
                let op = self.of(&["AND", "OR", "XOR", "=", "<>", "&"]);
                format!("({} {op} {})", self.truth(depth - 1), self.truth(depth - 1))
            }
            7 => {
                let op = self.of(&["=", "<>", "<", ">", "<=", ">="]);
                format!(
                    "({} {op} {})",
                    self.number(depth - 1),
                    self.number(depth - 1)
                )
            }
            _ => format!(
                "SEL({}, {}, {})",
                self.truth(depth - 1),
                self.truth(depth - 1),
                self.truth(depth - 1)
            ),
        }
    }

    fn number(&mut self, depth: u32) -> String {
        match self.below(if depth == 0 { 3 } else { 8 }) {
            0 | 1 => self.of(&["n", "x", "x2", "xm"]).to_owned(),
            2 => self.below(8).to_string(),
            3 | 4 => {
                let op = self.of(&["+", "-", "*"]);
                format!("({} {op} {})", self.number(depth - 1), self.number(0))
            }
            5 => format!(
                "({} {} {})",
                self.number(depth - 1),
                self.of(&["/", "MOD"]),
                1 + self.below(4)
            ),
            6 => format!(
                "{}({}, {})",
                self.of(&["MIN", "MAX"]),
                self.number(depth - 1),
                self.number(0)
            ),
            _ => format!(
                "SEL({}, {}, {})",
                self.truth(depth - 1),
                self.number(depth - 1),
                self.number(0)
            ),
        }
    }

    fn statements(&mut self, depth: u32, in_loop: bool) -> String {
        let count = 1 + self.below(4);
        (0..count).map(|_| self.statement(depth, in_loop)).collect()
    }

    fn statement(&mut self, depth: u32, in_loop: bool) -> String {
        match self.below(if depth == 0 { 4 } else { 9 }) {
            0 | 1 => format!("{} := {};\n", self.of(&["u", "v", "p", "q"]), self.truth(2)),
            2 => format!(
                "{} := LIMIT(0, {}, 7);\n",
                self.of(&["x", "x2", "xm"]),
                self.number(2)
            ),
            3 => format!("{} := {};\n", self.of(&["x", "x2", "xm"]), self.number(1)),
            4 | 5 => {
                let other = match self.below(3) {
                    0 => String::new(),
                    1 => format!("ELSE {}", self.statements(depth - 1, in_loop)),
                    _ => format!(
                        "ELSIF {} THEN {}",
                        self.truth(1),
                        self.statements(depth - 1, in_loop)
                    ),
                };
                format!(
                    "IF {} THEN {}{other}END_IF;\n",
                    self.truth(2),
                    self.statements(depth - 1, in_loop)
                )
            }
            6 => format!(
                "CASE {} OF 0, 5: {} 2..4: {} ELSE {} END_CASE;\n",
                self.of(&["n", "x", "x2"]),
                self.statements(depth - 1, in_loop),
                self.statements(depth - 1, in_loop),
                self.statements(depth - 1, in_loop)
            ),
            7 if !in_loop => {
                let bounds = self.of(&["0 TO 2", "3 TO 1 BY -1", "1 TO 5 BY 3", "2 TO 1"]);
                format!(
                    "FOR xi := {bounds} DO {} END_FOR;\n",
                    self.statements(depth - 1, true)
                )
            }
            _ => {
                let word = if in_loop {
                    self.of(&["EXIT", "RETURN"])
                } else {
                    "RETURN"
                };
                format!("IF {} THEN {word}; END_IF;\n", self.truth(1))
            }
        }
    }
}

const PLC: &str = r#"
spec = "test/peer"
title = "t"
[machine.plc]
text = "t"
otherwise = "stay"
[machine.plc.input]
a = "BOOL"
b = "BOOL"
n = "INT(0..7)"
[machine.plc.output]
p = "a"
q = "b"
xm = "n"
"#;

#[test]
fn random_programs_do_what_their_tables_do() {
    let spec =
        Spec::from_text("peer.toml".as_ref(), Arc::from(PLC)).unwrap_or_else(|e| panic!("{e}"));
    let signature = Signature::of(&spec, "plc").unwrap_or_else(|e| panic!("{e}"));
    let (mut random, mut cycles, mut faults, mut accepted) = (Random(0x5EED), 0, 0, 0);
    for _ in 0..1_500 {
        let program = format!(
            "PROGRAM t VAR_INPUT a, b : BOOL; n : INT; END_VAR VAR_OUTPUT p, q : BOOL; xm : INT (0..7); END_VAR\n\
             VAR u : BOOL; v : BOOL := TRUE; x : INT (0..7) := 3; x2, xi : INT (0..7); END_VAR\n\
             q := q; p := p; xm := xm;\n{}END_PROGRAM\n",
            (0..4)
                .map(|_| random.statement(3, false))
                .collect::<String>()
        );
        let source: Arc<str> = Arc::from(program.as_str());
        // A value that never fits, or a label that never matches, is refused: as far as the translation knows ranges, rightly.
        let Ok(compiled) = compile("t.st", &source, &signature) else {
            continue;
        };
        accepted += 1;
        let mut own = spec.clone();
        let name = toml::Spanned::new(0..0, "plc".to_owned());
        own.replace("t.st", &source, &name, &compiled.machine)
            .unwrap_or_else(|e| panic!("{e}"));
        let system = own
            .open_machine("plc")
            .unwrap_or_else(|e| panic!("{e}\n{program}"));
        let bound = Bound::new(system, &BTreeMap::new(), &BTreeMap::new())
            .unwrap_or_else(|e| panic!("{e}"));
        let tree: File = parse::parse(&source).unwrap_or_else(|e| panic!("{e:?}"));
        for _ in 0..6 {
            let ends = both(&bound, &tree, &mut random, &program);
            cycles += ends.0;
            faults += u32::from(ends.1);
        }
    }
    println!("{accepted} programs, {cycles} cycles, {faults} runs to a fault");
    assert!(
        accepted > 700 && cycles > 20_000 && faults > 300,
        "{accepted} {cycles} {faults}"
    );
}

/// Runs both side by side; the answer is the number of cycles, and whether a value left its range.
fn both(bound: &Bound, tree: &File, random: &mut Random, program: &str) -> (u32, bool) {
    let states = bound.system.states.iter();
    let mut state: Vec<i32> = states
        .map(|s| {
            s.init
                .as_ref()
                .map_or(0, |init| bound.constant(init) as i32)
        })
        .collect();
    let first = [
        ("u", 0),
        ("v", 1),
        ("x", 3),
        ("x2", 0),
        ("xi", 0),
        ("p", 0),
        ("q", 0),
        ("xm", 0),
    ];
    let mut values: Values = first.map(|(name, value)| (name.to_owned(), value)).into();
    let mut frame = Frame::new(bound);
    for cycle in 0..12 {
        let inputs = [
            ("a", random.below(2)),
            ("b", random.below(2)),
            ("n", random.below(8)),
        ];
        values.extend(inputs.map(|(name, value)| (name.to_owned(), value as i64)));
        let expected = run(&tree.program.body, &mut values);
        frame.start(&state);
        let mut read = |k: usize| {
            let name = bound.system.inputs[k]
                .name
                .strip_prefix("plc.")
                .unwrap_or_default();
            inputs
                .iter()
                .find(|(input, _)| *input == name)
                .map_or(0, |(_, value)| *value as i32)
        };
        let stepped = bound.step(&mut frame, &mut read);
        assert_eq!(
            stepped.is_ok(),
            expected.is_some(),
            "cycle {cycle} of\n{program}"
        );
        if expected.is_none() {
            return (cycle, true);
        }
        for (k, lazy) in bound.system.lazies.iter().enumerate() {
            let name = lazy.name.strip_prefix("plc.").unwrap_or_default();
            if let (stillpoint_lang::ir::LazyKind::Output, Some(expected)) =
                (lazy.kind, values.get(name))
            {
                let is = bound.lazy(k, &mut frame, &mut read);
                assert_eq!(is, *expected, "{name} in cycle {cycle} of\n{program}");
            }
        }
        state.copy_from_slice(&frame.now);
    }
    (12, false)
}
