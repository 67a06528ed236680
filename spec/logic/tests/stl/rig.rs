//! A machine with inputs and outputs, and the interpreter of the tables to run a program in its place.

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::Diagnostics;
use stillpoint_logic::Compiled;
use stillpoint_logic::st::Signature;
use stillpoint_logic::stl::{Bit, Interface, Output, parse};

use crate::common::Running;

/// Its inputs are `a`, `b`, `ob1`, `c` (BOOL) and `byte`; its outputs `p`, `q` (BOOL).
const SPL: &str = r#"
spec   = "test/spl"
title  = "A safe logic"
source = "none"

[machine.spl]
text      = "two outputs"
otherwise = "stay"

[machine.spl.input]
a    = "BOOL"
b    = "BOOL"
c    = "BOOL"
ob1  = "BOOL"
byte = "INT(0..255)"

[machine.spl.output]
p = "a OR c"
q = "b AND ob1 AND byte = 0"
"#;

/// The machine.
pub fn spec() -> Spec {
    Spec::from_text("spl.toml".as_ref(), Arc::from(SPL)).expect("the machine of the tests")
}

/// A bit by its name.
pub fn bit(text: &str) -> Bit {
    text.parse().unwrap_or_else(|e| panic!("{e}"))
}

/// An output that is a bit.
pub fn output(text: &str) -> Output {
    Output::Bit {
        bit: bit(text),
        inverted: false,
    }
}

/// `E 0.0`, `E 0.1`, `E 0.2` are `a`, `b`, `c`; `p`, `q` are `A 4.0`, `A 4.1`.
pub fn interface() -> Interface {
    let input = |text: &str, port: &str| (bit(text), port.to_owned());
    Interface {
        signature: Signature::of(&spec(), "spl").expect("a machine"),
        inputs: vec![input("E0.0", "a"), input("E0.1", "b"), input("E0.2", "c")],
        outputs: vec![
            ("p".to_owned(), output("A4.0")),
            ("q".to_owned(), output("A4.1")),
        ],
        scan: None,
    }
}

/// A program with its table.
pub fn compiled(text: &str, interface: &Interface) -> Result<Compiled, Diagnostics> {
    let source: Arc<str> = Arc::from(text);
    parse("safe.stl", &source)?.compile(interface)
}

/// A program that runs, with its state.
pub struct Plc(Running);

impl Plc {
    /// A program; a cycle has so many microseconds.
    pub fn new(text: &str, interface: &Interface, cycle: u64) -> Self {
        let source: Arc<str> = Arc::from(text);
        let compiled = compiled(text, interface).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let mut spec = spec();
        let name = toml::Spanned::new(0..0, "spl".to_owned());
        spec.replace("safe.stl", &source, &name, &compiled.machine)
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

    /// One cycle with these inputs, the others 0: `p`, `q`.
    pub fn step(&mut self, inputs: &[(&str, i32)]) -> [bool; 2] {
        let out = self.0.step(inputs, ["p", "q"]).expect("no fault");
        out.map(|value| value == 1)
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
