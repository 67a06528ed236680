//! Exported BTOR2 against the interpreter: a sampling test, no proof. It needs no other tool.
//!
//! For every system of every shipped specification and of the must-fail set, cycles from random states with random inputs:
//! the state after the cycle, each bad signal and each output must be what the interpreter says.

use stillpoint_harness::export::btor2::{RANGE, btor2};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::{Form, Property};
use stillpoint_tests::btor2::{Model, Values, Variable, bits};
use stillpoint_tests::peer::{Folder, has_system, load};
use stillpoint_tests::random::Random;
use stillpoint_tests::{files, specification_files};

/// Cycles for each system.
const CYCLES: usize = 2000;

/// What the sample has met.
#[derive(Default)]
struct Met {
    cycles: usize,
    faults: usize,
    bad: usize,
    seen: usize,
}

fn name(property: &Property) -> String {
    let index = property.index.map_or(String::new(), |i| format!("[{i}]"));
    format!("{}{index}", property.id)
}

/// Compares a model with its system.
struct Comparison<'a> {
    bound: &'a Bound,
    model: Model,
    /// Places of the model's state variables and inputs among those of the system.
    states: Vec<usize>,
    inputs: Vec<usize>,
    values: Values,
    frame: Frame,
}

impl<'a> Comparison<'a> {
    fn new(bound: &'a Bound) -> Self {
        let text =
            btor2(bound, "sample", None).unwrap_or_else(|e| panic!("{}: {e}", bound.system.name));
        let model = Model::read(&text).unwrap_or_else(|e| panic!("{}: {e}", bound.system.name));
        let system = &bound.system;
        let place = |names: &[&str], variables: &[Variable]| -> Vec<usize> {
            let place = |v: &Variable| names.iter().position(|n| *n == v.symbol);
            let places = variables
                .iter()
                .map(|v| place(v).expect("a variable of the system"));
            places.collect()
        };
        let names: Vec<&str> = (system.states.iter().map(|s| s.var.name.as_str())).collect();
        let states = place(&names, &model.states);
        let names: Vec<&str> = system.inputs.iter().map(|v| v.name.as_str()).collect();
        let inputs = place(&names, &model.inputs);
        let comparison = Self {
            bound,
            model,
            states,
            inputs,
            values: Values::default(),
            frame: Frame::new(bound),
        };
        comparison.start_values();
        comparison
    }

    fn start_values(&self) {
        for (variable, k) in self.model.states.iter().zip(&self.states) {
            let wanted = self.bound.initial[*k].map(|v| bits(i64::from(v), variable.width));
            assert_eq!(self.model.initial(variable), wanted, "{}", variable.symbol);
        }
        let varying = self.bound.states.iter().filter(|(lo, hi)| lo < hi).count();
        assert_eq!(self.model.states.len(), varying, "each state variable once");
    }

    /// One cycle; the answer is the state after it, none after a range fault.
    fn cycle(&mut self, before: &[i32], inputs: &[i32], met: &mut Met) -> Option<Vec<i32>> {
        let bound = self.bound;
        let system = &bound.system;
        let mut values = std::mem::take(&mut self.values);
        let encode = |list: &[Variable], places: &[usize], cells: &[i32]| -> Vec<u64> {
            let places = list.iter().zip(places);
            places
                .map(|(v, k)| bits(i64::from(cells[*k]), v.width))
                .collect()
        };
        let states = encode(&self.model.states, &self.states, before);
        let chosen = encode(&self.model.inputs, &self.inputs, inputs);
        self.model.evaluate(&mut values, &states, &chosen);
        let what = || format!("{}: state {before:?}, inputs {inputs:?}", system.name);
        assert!(self.model.allowed(&values), "constraints: {}", what());
        self.frame.start(before);
        let done = bound.step(&mut self.frame, &mut |k| inputs[k]);
        let fault = done.is_err();
        let after = if fault { before } else { &self.frame.now[..] }.to_vec();
        for (variable, k) in self.model.states.iter().zip(&self.states) {
            let wanted = bits(i64::from(after[*k]), variable.width);
            let next = self.model.next(&values, variable);
            assert_eq!(next, Some(wanted), "next {}: {}", variable.symbol, what());
        }
        let mut bad = Vec::new();
        let mut seen = Vec::new();
        if self.model.bad.iter().any(|(symbol, _)| symbol == RANGE) {
            bad.push((RANGE.to_owned(), fault));
        } else {
            assert!(!fault, "a fault that the model does not know: {}", what());
        }
        let frame = &mut self.frame;
        let mut atom = |k: usize| bound.atom(k, frame, &mut |k| inputs[k]);
        for property in &system.properties {
            match property.form {
                Form::Always { when, then } => {
                    let broken = !fault && when.is_none_or(&mut atom) && !atom(then);
                    bad.push((name(property), broken));
                }
                Form::Reachable { goal } => seen.push((name(property), !fault && atom(goal))),
                _ => {}
            }
        }
        let signals = |list: &[(String, usize)]| -> Vec<(String, bool)> {
            let signal = |(symbol, node): &(String, usize)| {
                (symbol.clone(), self.model.signal(&values, *node))
            };
            list.iter().map(signal).collect()
        };
        assert_eq!(signals(&self.model.bad), bad, "bad: {}", what());
        assert_eq!(signals(&self.model.outputs), seen, "outputs: {}", what());
        met.cycles += 1;
        met.faults += usize::from(fault);
        met.bad += bad.iter().filter(|b| b.1).count();
        met.seen += seen.iter().filter(|s| s.1).count();
        self.values = values;
        (!fault).then_some(after)
    }

    /// Cycles in runs: most go on from where the last one ended, so that what is only met after a while is met; others begin
    /// anywhere in the ranges, also where no run from the start comes.
    fn sample(&mut self, random: &mut Random, met: &mut Met) {
        let bound = self.bound;
        let mut state: Option<Vec<i32>> = None;
        for _ in 0..CYCLES {
            let before = match state.take() {
                Some(after) if random.within((0, 15)) > 0 => after,
                _ => {
                    let start = random.within((0, 1)) == 0;
                    let ranges = bound.states.iter().zip(&bound.initial);
                    ranges
                        .map(|(range, initial)| match initial {
                            Some(v) if start => *v,
                            _ => random.within(*range),
                        })
                        .collect()
                }
            };
            let inputs: Vec<i32> = bound.inputs.iter().map(|r| random.within(*r)).collect();
            state = self.cycle(&before, &inputs, met);
        }
    }
}

#[test]
fn sampled_cycles_agree_with_the_interpreter() {
    let mut met = Met::default();
    let mut systems = 0;
    let must_fail = files("tests/must-fail", "toml");
    for path in specification_files().into_iter().chain(must_fail) {
        if !has_system(&path) {
            continue;
        }
        for task in &load(&path).tasks {
            Comparison::new(&task.bound).sample(&mut Random::new(1), &mut met);
            systems += 1;
        }
    }
    eprintln!(
        "{systems} systems, {} cycles, {} with a bad signal, {} with a witness",
        met.cycles, met.bad, met.seen
    );
    assert!(
        met.bad > 0 && met.seen > 0,
        "the sample meets both values of the signals"
    );
}

#[test]
fn all_operators_and_faults_agree_with_the_interpreter() {
    let text = r#"
spec  = "test/btor2"
title = "every operator, also with negative operands, and values that leave their range"
[machine.m]
text = "arithmetic"
otherwise = "stay"
order = "priority"
[machine.m.input]
go = "BOOL"
a = "INT(-9..7)"
b = "INT(2..5)"
at = "INT(0..2)"
[machine.m.state]
count = { type = "INT(0..5)", init = 1 }
low = { type = "INT(-70..70)", init = "ANY" }
flag = { type = "BOOL", init = "ANY" }
cells = { type = "ARRAY[0..2] OF INT(-3..3)", init = 0 }
[[machine.m.rule]]
name = "divide"
note = "test"
when = "go XOR flag"
then = "low := a / b * b + a MOD b; flag := a MOD -b = 0; cells[at] := a / -3; count := count + at;"
[[machine.m.rule]]
name = "choose"
note = "test"
when = "a >= low OR NOT flag"
then = "low := -MIN(a, -b, low / 2) * MAX(at - 1, cells[at]); IF cells[MIN(count, 2)] < 0 THEN count := ABS(a) - 1; ELSIF go THEN count := MUX(at, count, 2, cells[0] + 3); END_IF; flag := SEL(go, flag, a <> b);"
[system.s]
text = "one"
[system.s.instance]
m = { machine = "m" }
[system.s.free]
ports = ["m.go", "m.a", "m.b", "m.at"]
[[system.s.property]]
id = "sum"
text = "the parts make the whole"
always = "m.a / m.b * m.b + m.a MOD m.b = m.a"
[[system.s.property]]
id = "seldom"
text = "broken now and then"
never = "m.low MOD 7 = -3"
[[system.s.property]]
id = "seen"
text = "seen now and then"
reachable = "m.low < -5 AND m.count = PREV(m.count)"
"#;
    let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), "btor2");
    folder.write("operators.toml", text);
    let subject = load(&folder.file("operators.toml"));
    let mut met = Met::default();
    let mut random = Random::new(7);
    let mut comparison = Comparison::new(&subject.tasks[0].bound);
    for _ in 0..20 {
        comparison.sample(&mut random, &mut met);
    }
    assert!(
        met.faults > 100 && met.faults < met.cycles / 2,
        "faults: {}",
        met.faults
    );
    assert!(
        met.bad > 100 && met.seen > 100,
        "bad {}, seen {}",
        met.bad,
        met.seen
    );
}
