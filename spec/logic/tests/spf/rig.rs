//! A machine with inputs and outputs of every type, and the interpreter of the tables to run a program in its place.

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::Diagnostics;
use stillpoint_logic::Compiled;
use stillpoint_logic::spf::{Interface, Mode, Output, Readings, Variable, parse};
use stillpoint_logic::st::Signature;

use crate::common::Running;

/// Its inputs are `a`, `b`, `ipo` (BOOL), `byte` (INT 0..255), `colour`; its outputs `p`, `q` (BOOL), `n` (INT -9..255).
const SPL: &str = r#"
spec   = "test/spl"
title  = "A safe logic"
source = "none"

[enum.Colour]
values = ["RED", "GREEN"]

[machine.spl]
text      = "outputs of the types that a program can have"
otherwise = "stay"

[machine.spl.input]
a      = "BOOL"
b      = "BOOL"
ipo    = "BOOL"
byte   = "INT(0..255)"
colour = "Colour"

[machine.spl.output]
p = "a AND colour = RED"
q = "b AND ipo"
n = "SEL(a, byte - 9, byte)"
"#;

/// The machine.
pub fn spec() -> Spec {
    Spec::from_text("spl.toml".as_ref(), Arc::from(SPL)).expect("the machine of the tests")
}

/// A variable by its name.
pub fn variable(text: &str) -> Variable {
    text.parse().unwrap_or_else(|e| panic!("{e}"))
}

/// An output that is a variable.
pub fn output(text: &str) -> Output {
    Output::Variable {
        variable: variable(text),
        inverted: false,
    }
}

/// `$A_INSE[1]` and `[2]` are `a` and `b`, `$A_DBB[1]` is `byte`; `p`, `q`, `n` are `$A_OUTSE[1]`, `[2]`, `$AC_MARKER[1]`.
pub fn interface() -> Interface {
    let input = |text: &str, port: &str| (variable(text), port.to_owned());
    let given = |port: &str, text: &str| (port.to_owned(), output(text));
    Interface {
        signature: Signature::of(&spec(), "spl").expect("a machine"),
        inputs: vec![
            input("INSE[1]", "a"),
            input("INSE[2]", "b"),
            input("DBB[1]", "byte"),
        ],
        outputs: vec![
            given("p", "OUTSE[1]"),
            given("q", "OUTSE[2]"),
            given("n", "AC_MARKER[1]"),
        ],
        scan: None,
        readings: Readings::default(),
    }
}

/// A program with its table.
pub fn compiled(text: &str, interface: &Interface) -> Result<Compiled, Diagnostics> {
    let source: Arc<str> = Arc::from(text);
    parse("safe.spf", &source, Mode::Strict)?.compile(interface)
}

/// A program that runs, with its state.
pub struct Spl(Running);

impl Spl {
    /// A program of these blocks, to which the end code is added; a cycle has so many microseconds.
    pub fn new(blocks: &str, interface: &Interface, cycle: u64) -> Self {
        let text = format!("{blocks}\nM17\n");
        let source: Arc<str> = Arc::from(text.as_str());
        let compiled = compiled(&text, interface).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let mut spec = spec();
        let name = toml::Spanned::new(0..0, "spl".to_owned());
        spec.replace("safe.spf", &source, &name, &compiled.machine)
            .unwrap_or_else(|e| panic!("{e}"));
        let system = spec
            .open_machine("spl")
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        let length = |us: u64| i64::try_from(us.div_ceil(cycle)).expect("short");
        let params: BTreeMap<String, Vec<i64>> = (compiled.durations.iter())
            .map(|(name, us)| (name.clone(), vec![length(*us)]))
            .collect();
        let bound = Bound::new(system, &params, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"));
        Self(Running::new(bound))
    }

    /// Back to the start.
    pub fn restart(&mut self) {
        self.0.restart();
    }

    /// How many cells of state it has.
    pub fn cells(&self) -> usize {
        self.0.cells()
    }

    /// One cycle with these inputs, the others 0: `p`, `q`, `n`.
    pub fn step(&mut self, inputs: &[(&str, i32)]) -> [i64; 3] {
        self.0.step(inputs, ["p", "q", "n"]).expect("no fault")
    }
}

/// Every sequence of `length` values below `base`.
pub fn sequences(base: usize, length: u32) -> impl Iterator<Item = Vec<usize>> {
    (0..base.pow(length)).map(move |mut number| {
        (0..length)
            .map(|_| {
                let value = number % base;
                number /= base;
                value
            })
            .collect()
    })
}
