//! The tables as functions of bits against the interpreter: on walks at random through every shipped system, with the parameters of the
//! file, and with parameters that are bits themselves. A test, no proof.

mod shipped;

use std::collections::BTreeMap;

use shipped::{Random, side_by_side, subjects};
use stillpoint_certify::proof::format::Free;
use stillpoint_certify::proof::gates::Bit;
use stillpoint_certify::proof::rup::Clauses;
use stillpoint_certify::proof::symbolic::Symbolic;
use stillpoint_certify::proof::word::Word;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;

/// Cycles of a walk.
const CYCLES: usize = 6;

/// What says that a word has this value: literals of those of its bits that are not known. None if known ones differ.
fn has(word: &Word, value: i32) -> Option<Vec<i32>> {
    let mut literals = Vec::new();
    for k in 0..64 {
        let set = i64::from(value) >> k & 1 == 1;
        match word.bit(k) {
            Bit::TRUE if set => {}
            Bit::FALSE if !set => {}
            Bit::TRUE | Bit::FALSE => return None,
            bit if set => literals.push(bit.number()),
            bit => literals.push(-bit.number()),
        }
    }
    Some(literals)
}

/// A system over gates with one value that tells whether a cycle is what is expected.
struct Compared<'a> {
    symbolic: Symbolic<'a>,
    clauses: Clauses,
    before: Vec<Word>,
    start: Vec<Word>,
    inputs: Vec<Word>,
    /// By state variable, then for each atom and the fault, what is expected: the same bits as the value has.
    expected: Vec<Word>,
    /// Whether the cycle differs from that.
    differs: Bit,
    /// Whether the fault differs.
    fault_differs: Bit,
    /// Whether the ranges are kept.
    given: Bit,
    starts: Bit,
}

impl<'a> Compared<'a> {
    fn new(bound: &'a Bound, every: &[(String, (i64, i64))]) -> Result<Self, String> {
        let free = Free {
            every: every.to_vec(),
            ..Free::default()
        };
        let mut symbolic = Symbolic::new(bound, &free)?;
        let (start, starts) = symbolic.start()?;
        let (before, ranges) = symbolic.any_state();
        let (mut cycle, inputs_given) = symbolic.cycle(before.clone())?;
        let mut values = cycle.now.clone();
        for k in 0..bound.system.atoms.len() {
            values.push(Word::truth(symbolic.atom(k, &mut cycle)?));
        }
        values.push(Word::truth(cycle.fault));
        let gates = &mut symbolic.gates;
        let mut differ = Vec::new();
        let mut expected = Vec::new();
        for value in &values {
            let own = Word::new((0..34).map(|_| gates.free()).collect());
            let same = own.equals(gates, value);
            differ.push(!same);
            expected.push(own);
        }
        let fault_differs = differ.pop().expect("the fault");
        let differs = gates.any(differ);
        let given = gates.all([&symbolic.given[..], &ranges, &inputs_given].concat());
        let starts = gates.all([&symbolic.given[..], &starts].concat());
        let mut clauses = Clauses::new(gates.count());
        let roots = [differs, fault_differs, given, starts];
        let roots = roots
            .into_iter()
            .chain(start.iter().flat_map(Word::bits).copied());
        gates.clauses(roots, |clause| {
            let numbers: Vec<i32> = clause.iter().map(|bit| bit.number()).collect();
            clauses.add(&numbers);
        });
        Ok(Compared {
            clauses,
            before,
            start,
            inputs: cycle.inputs,
            expected,
            differs,
            fault_differs,
            given,
            starts,
            symbolic,
        })
    }

    /// Compares a walk of the interpreter in a configuration of the system.
    fn walk(&mut self, bound: &Bound, random: &mut Random, faults: &mut usize) {
        let name = &bound.system.name;
        let params = self.symbolic.params.iter().zip(&bound.values);
        let params: Option<Vec<Vec<i32>>> = params.map(|(word, v)| has(word, *v)).collect();
        let params = params.expect("the values of the parameters").concat();
        let any = |(init, range): (&Option<i32>, &(i32, i32))| {
            init.unwrap_or_else(|| random.value(*range))
        };
        let mut state: Vec<i32> = bound.initial.iter().zip(&bound.states).map(any).collect();
        // Start values that are any are assumed, the others must follow.
        let (mut start, mut follow) = (params.clone(), vec![self.starts.number()]);
        for ((word, value), init) in self.start.iter().zip(&state).zip(&bound.initial) {
            let literals = has(word, *value).unwrap_or_else(|| panic!("{name}: start {value}"));
            match init {
                None => start.extend(literals),
                Some(_) => follow.extend(literals),
            }
        }
        assert!(!self.clauses.refutes(&start), "{name}: start");
        for literal in follow {
            let opposite = [&start[..], &[-literal]].concat();
            assert!(self.clauses.refutes(&opposite), "{name}: start");
        }
        for _ in 0..CYCLES {
            let inputs = random.inputs(bound);
            let mut frame = Frame::new(bound);
            frame.start(&state);
            let made = bound.step(&mut frame, &mut |k| inputs[k]);
            let mut assumed = params.clone();
            let cells = self.before.iter().zip(&state);
            for (word, value) in cells.chain(self.inputs.iter().zip(&inputs)) {
                assumed.extend(has(word, *value).unwrap_or_else(|| panic!("{name}: {value}")));
            }
            let mut wanted = frame.now.clone();
            for k in 0..bound.system.atoms.len() {
                let value = match made {
                    Ok(()) => i32::from(bound.atom(k, &mut frame, &mut |i| inputs[i])),
                    Err(_) => 0,
                };
                wanted.push(value);
            }
            wanted.push(i32::from(made.is_err()));
            for (word, value) in self.expected.iter().zip(&wanted) {
                assumed.extend(has(word, *value).expect("free bits"));
            }
            assert!(!self.clauses.refutes(&assumed), "{name}");
            for right in [self.given, !self.fault_differs, !self.differs] {
                // After a fault nothing is said of what the state would be.
                if right != !self.differs || made.is_ok() {
                    let opposite = [&assumed[..], &[-right.number()]].concat();
                    assert!(
                        self.clauses.refutes(&opposite),
                        "{name}: {right:?} {state:?} {inputs:?}"
                    );
                }
            }
            match made {
                Ok(()) => state = frame.now,
                Err(_) => *faults += 1,
            }
        }
    }
}

/// Compares every so many-th system from one on: systems, those not told, those with free parameters, cycles with a fault.
fn share(bounds: &[&Bound], from: usize, step: usize) -> [usize; 4] {
    let [mut systems, mut untold, mut free, mut faults] = [0; 4];
    for (k, bound) in bounds.iter().enumerate().skip(from).step_by(step) {
        let mut random = Random(0x9e37_79b9_7f4a_7c15 + k as u64);
        match Compared::new(bound, &[]) {
            Ok(mut compared) => {
                systems += 1;
                compared.walk(bound, &mut random, &mut faults);
            }
            Err(what) => {
                println!("{}: {what}", bound.system.name);
                untold += 1;
            }
        }
        free += usize::from(configurations(bound, &mut random, &mut faults));
    }
    [systems, untold, free, faults]
}

#[test]
fn cycles_over_bits_are_those_of_the_interpreter() {
    let subjects = subjects();
    let mut seen = std::collections::BTreeSet::new();
    let mut bounds: Vec<&Bound> = subjects.iter().flat_map(|s| &s.bounds).collect();
    bounds.retain(|bound| seen.insert((bound.system.fingerprint(), bound.values.clone())));
    let [systems, untold, free, faults] = side_by_side(|from, step| share(&bounds, from, step));
    println!(
        "{systems} systems, {untold} not told, {free} with free parameters, {faults} cycles with a fault"
    );
    assert!(
        systems > 60 && untold * 20 < systems && free > 20,
        "{systems} {untold} {free}"
    );
}

/// The same with values of parameters drawn from a part of their ranges; whether there was a configuration.
fn configurations(bound: &Bound, random: &mut Random, faults: &mut usize) -> bool {
    let own = || {
        let params = bound.system.params.iter().zip(&bound.values);
        params.filter(|(p, _)| p.reading.is_none())
    };
    let mut every: Vec<(String, (i64, i64))> = Vec::new();
    for (param, value) in own() {
        let value = i64::from(*value);
        every.push((param.var.name.clone(), (value - 2, value + 3)));
    }
    let Ok(mut compared) = Compared::new(bound, &every) else {
        return false;
    };
    if every.is_empty() {
        return false;
    }
    let readings = bound.readings().into_iter().collect();
    let mut found = false;
    for _ in 0..4 {
        let mut values: BTreeMap<String, Vec<i64>> = BTreeMap::new();
        for ((param, _), (_, (lo, hi))) in own().zip(&every) {
            let name = param.var.name.split('[').next().unwrap_or_default();
            let drawn = lo + random.below((hi - lo + 1) as u64) as i64;
            let drawn = if random.below(3) == 0 { drawn } else { lo + 2 };
            values.entry(name.to_owned()).or_default().push(drawn);
        }
        if let Ok(one) = Bound::new(bound.system.clone(), &values, &readings) {
            compared.walk(&one, random, faults);
            found = true;
        }
    }
    found
}
