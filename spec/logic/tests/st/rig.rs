//! A safe PLC with a few inputs and outputs, and the interpreter of the tables to run a program in it.

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::Diagnostics;
use stillpoint_logic::st::{Signature, compile};

use crate::common::Running;

/// Its inputs are `a`, `b`, `c` (BOOL), `n` (INT 0..7), `mode`; its outputs `p`, `q` (BOOL), `m` (INT -9..99), `stop`.
const PLC: &str = r#"
spec   = "test/plc"
title  = "A safe PLC"
source = "none"

[enum.Mode]
values = ["AUTO", "MANUAL", "SETUP"]

[enum.Stop]
values = ["NONE", "SS2", "SS1"]

[reading.R-1]
text    = "whether it is so"
options = ["IT_IS", "IT_IS_NOT"]

[machine.plc]
text      = "outputs of the types that a program can have"
otherwise = "stay"

[machine.plc.param]
t_max = { type = "TIME(1..100)", default = 4 }

[machine.plc.input]
a    = "BOOL"
b    = "BOOL"
c    = "BOOL"
n    = "INT(0..7)"
mode = "Mode"

[machine.plc.output]
p    = "a AND IT_IS"
q    = "b AND c AND t_max > 1"
m    = "SEL(mode = AUTO, n - 9, 92 + n)"
stop = "SEL(a, NONE, SS1)"
"#;

/// A program that runs, with its state.
pub struct Plc(Running);

/// The program as it is read, or what is wrong with it.
pub fn load(program: &str) -> Result<Bound, Diagnostics> {
    let source: Arc<str> = Arc::from(program);
    let mut spec = Spec::from_text("plc.toml".as_ref(), Arc::from(PLC))?;
    let signature = Signature::of(&spec, "plc")?;
    let compiled = compile("plc.st", &source, &signature)?;
    let name = toml::Spanned::new(0..0, "plc".to_owned());
    spec.replace("plc.st", &source, &name, &compiled.machine)?;
    let system = spec.open_machine("plc")?;
    Ok(Bound::new(system, &BTreeMap::new(), &BTreeMap::new()).expect("parameters have defaults"))
}

/// A whole program of these variables and statements; outputs that it does not assign keep their first value.
pub fn whole(variables: &str, statements: &str) -> String {
    let outputs = ["p", "q", "m", "stop"].into_iter();
    let silent = outputs.filter(|o| {
        ![format!("{o} :="), format!("=> {o}")]
            .iter()
            .any(|text| statements.contains(text))
    });
    let kept: String = silent.map(|o| format!("{o} := {o}; ")).collect();
    format!(
        "PROGRAM test\n\
         VAR_INPUT a, b, c : BOOL; n : INT (0..7); mode : Mode; END_VAR\n\
         VAR_OUTPUT p, q : BOOL; m : INT (0..7); stop : Stop; END_VAR\n\
         {variables}\n{kept}\n{statements}\nEND_PROGRAM\n"
    )
}

impl Plc {
    /// A program at its start; a cycle is a millisecond.
    pub fn new(program: &str) -> Self {
        let bound = load(program).unwrap_or_else(|e| panic!("{e}\n{program}"));
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

    /// One cycle with these inputs: `p`, `q`, `m`, `stop`. `None` where a value left its range.
    pub fn step(&mut self, inputs: &[(&str, i32)]) -> Option<[i64; 4]> {
        self.0.step(inputs, ["p", "q", "m", "stop"])
    }
}
