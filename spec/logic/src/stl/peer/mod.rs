//! An interpreter of statement lists, and random programs: what a program does instruction by instruction is what its table does.
//!
//! It shares the parsed program with the translation and nothing else: it has bytes of memory where that has names, an instruction
//! counter where that has conditions, and times in microseconds where that counts cycles.

mod random;

use std::collections::BTreeMap;

use super::ast::{
    Actual, Block, Call, Instruction, Logic, Op, Relation, Source, TimerKind, Unit, Value,
};
use super::operand::{Area, Cell};
use super::{Bit, Program};

/// A string of checks: what is combined by OR already, and the AND that is being formed.
#[derive(Debug, Clone, Default)]
struct Checks {
    sum: Option<bool>,
    product: Option<bool>,
}

impl Checks {
    fn value(&self) -> bool {
        self.sum.unwrap_or(false) || self.product.unwrap_or(false)
    }

    fn check(&mut self, logic: Logic, value: bool) {
        let Some(product) = self.product else {
            self.product = Some(value);
            return;
        };
        self.product = Some(match logic {
            Logic::And => product && value,
            Logic::Or => self.value() || value,
            Logic::Xor => self.value() != value,
        });
        if logic != Logic::And {
            self.sum = None;
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct Timer {
    kind: TimerKind,
    length: i64,
    /// The result at its last start.
    was: bool,
    /// When it began to run, if it has not been stopped since.
    since: Option<i64>,
}

impl Timer {
    fn start(&mut self, result: bool, now: i64) {
        let (rises, falls) = (result && !self.was, !result && self.was);
        match self.kind {
            TimerKind::Pulse | TimerKind::OnDelay => {
                if rises {
                    self.since = Some(now);
                }
                if !result {
                    self.since = None;
                }
            }
            TimerKind::ExtendedPulse | TimerKind::RetentiveOnDelay => {
                if rises {
                    self.since = Some(now);
                }
            }
            TimerKind::OffDelay => {
                if result {
                    self.since = None;
                } else if falls {
                    self.since = Some(now);
                }
            }
        }
        self.was = result;
    }

    fn is_on(&self, now: i64) -> bool {
        let over = self.since.map(|since| now - since >= self.length);
        match self.kind {
            TimerKind::Pulse | TimerKind::ExtendedPulse => over == Some(false),
            TimerKind::OnDelay | TimerKind::RetentiveOnDelay => over == Some(true),
            TimerKind::OffDelay => self.was || over == Some(false),
        }
    }
}

/// FB10, with its times in microseconds.
#[derive(Debug, Clone, Default)]
struct Relay {
    called: bool,
    q: [bool; 2],
    on: bool,
    armed: bool,
    /// When its first output has fallen.
    fell: Option<i64>,
}

/// A program that runs.
struct Machine<'p> {
    program: &'p Program,
    /// Since the start, in microseconds.
    now: i64,
    memory: BTreeMap<(Area, u16), u8>,
    timers: BTreeMap<u16, Timer>,
    /// By the place of the call.
    relays: BTreeMap<usize, Relay>,
    started: bool,
}

impl<'p> Machine<'p> {
    fn new(program: &'p Program) -> Self {
        Self {
            program,
            now: 0,
            memory: BTreeMap::new(),
            timers: BTreeMap::new(),
            relays: BTreeMap::new(),
            started: false,
        }
    }

    fn bit(&self, bit: Bit) -> bool {
        let byte = self.memory.get(&(bit.area, bit.byte)).copied().unwrap_or(0);
        byte >> bit.bit & 1 == 1
    }

    fn set(&mut self, bit: Bit, value: bool) {
        let byte = self.memory.entry((bit.area, bit.byte)).or_insert(0);
        *byte = *byte & !(1 << bit.bit) | u8::from(value) << bit.bit;
    }

    fn cell(&self, cell: Cell) -> i64 {
        let bytes = (0..u16::from(cell.width)).map(|k| (cell.area, cell.byte + k));
        bytes.fold(0, |all, at| {
            all * 256 + i64::from(self.memory.get(&at).copied().unwrap_or(0))
        })
    }

    fn set_cell(&mut self, cell: Cell, value: i64) {
        for k in 0..u16::from(cell.width) {
            let behind = u16::from(cell.width) - 1 - k;
            let byte = (value >> (8 * behind) & 255) as u8;
            self.memory.insert((cell.area, cell.byte + k), byte);
        }
    }

    /// One run of OB1.
    fn cycle(&mut self) {
        let find = |block: &Block| self.program.units.iter().find(|u| u.block == *block);
        let (first, main) = (find(&Block::Ob(100)), find(&Block::Ob(1)));
        let main = main.or(self.program.units.first()).expect("a block");
        if let (false, Some(first)) = (self.started, first) {
            self.unit(first);
        }
        self.started = true;
        self.unit(main);
    }

    fn unit(&mut self, unit: &'p Unit) {
        let mut at = 0;
        let mut checks = vec![Checks::default()];
        // The result after the last check, and whether the next check begins a string.
        let (mut result, mut fresh) = (false, true);
        let mut brackets: Vec<(Logic, bool, bool)> = Vec::new();
        let mut accumulators = [0i64; 2];
        while let Some(instruction) = unit.body.get(at) {
            at += 1;
            let end = matches!(
                &instruction.op,
                Op::Check { .. } | Op::Close | Op::Compare(_)
            );
            match &instruction.op {
                Op::Check { logic, not, of } => {
                    let value = match of {
                        Source::Bit(bit) => self.bit(*bit),
                        Source::Timer(n) => self.timers.get(n).is_some_and(|t| t.is_on(self.now)),
                    };
                    let top = checks.last_mut().expect("one");
                    if fresh && brackets.is_empty() && top.sum.is_none() {
                        *top = Checks::default();
                    }
                    top.check(*logic, value != *not);
                    fresh = false;
                }
                Op::Open { logic, not } => {
                    if fresh && brackets.is_empty() && checks[0].sum.is_none() {
                        checks[0] = Checks::default();
                    }
                    brackets.push((*logic, *not, fresh));
                    checks.push(Checks::default());
                    fresh = true;
                }
                Op::Close => {
                    let inner = checks.pop().expect("open").value();
                    let (logic, not, _) = brackets.pop().expect("open");
                    checks.last_mut().expect("one").check(logic, inner != not);
                    fresh = false;
                }
                Op::OrBlock => {
                    let top = checks.last_mut().expect("one");
                    *top = Checks {
                        sum: Some(top.value()),
                        product: None,
                    };
                }
                Op::Compare(relation) => {
                    let [one, two] = accumulators;
                    let value = match relation {
                        Relation::Equal => two == one,
                        Relation::Unequal => two != one,
                        Relation::Greater => two > one,
                        Relation::Less => two < one,
                        Relation::GreaterEqual => two >= one,
                        Relation::LessEqual => two <= one,
                    };
                    let top = checks.last_mut().expect("one");
                    if fresh && brackets.is_empty() && top.sum.is_none() {
                        *top = Checks::default();
                    }
                    top.check(Logic::And, value);
                    fresh = false;
                }
                Op::Not => {
                    let top = checks.last_mut().expect("one");
                    *top = Checks {
                        sum: None,
                        product: Some(!top.value()),
                    };
                    result = top.value();
                }
                Op::SetResult | Op::ClearResult => {
                    result = matches!(instruction.op, Op::SetResult);
                    checks[0] = Checks {
                        sum: None,
                        product: Some(result),
                    };
                    fresh = true;
                }
                Op::Edge { falling, memory } => {
                    let top = checks.last_mut().expect("one");
                    let now = top.value();
                    let was = self.bit(*memory);
                    self.set(*memory, now);
                    let edge = if *falling { !now && was } else { now && !was };
                    checks.last_mut().expect("one").sum = None;
                    checks.last_mut().expect("one").product = Some(edge);
                    result = edge;
                    fresh = false;
                }
                Op::Load(value) => {
                    accumulators[1] = accumulators[0];
                    accumulators[0] = match value {
                        Value::Int(n) => *n,
                        Value::Time(us) => *us as i64,
                        Value::Cell(cell) => self.cell(*cell),
                    };
                }
                Op::Transfer(cell) => self.set_cell(*cell, accumulators[0]),
                Op::Assign(bit) => {
                    self.set(*bit, result);
                    fresh = true;
                }
                Op::Set(target) | Op::Reset(target) => {
                    let sets = matches!(instruction.op, Op::Set(_));
                    match target {
                        Source::Bit(bit) if result => self.set(*bit, sets),
                        Source::Timer(n) if result => {
                            if let Some(timer) = self.timers.get_mut(n) {
                                timer.since = None;
                            }
                        }
                        _ => {}
                    }
                    fresh = true;
                }
                Op::Start(kind, n) => {
                    let timer = Timer {
                        kind: *kind,
                        length: accumulators[0],
                        was: false,
                        since: None,
                    };
                    let now = self.now;
                    self.timers.entry(*n).or_insert(timer).start(result, now);
                    fresh = true;
                }
                Op::Jump { when, to } => {
                    fresh = true;
                    if when.is_none_or(|on| on == result) {
                        let label = |i: &Instruction| {
                            i.label
                                .as_ref()
                                .is_some_and(|l| l.text.eq_ignore_ascii_case(&to.text))
                        };
                        at = unit.body.iter().position(label).expect("a label");
                    } else {
                        result = true;
                        checks[0] = Checks {
                            sum: None,
                            product: Some(true),
                        };
                    }
                }
                Op::End { conditional } => {
                    if !conditional || result {
                        return;
                    }
                    result = true;
                    fresh = true;
                    checks[0] = Checks {
                        sum: None,
                        product: Some(true),
                    };
                }
                Op::Call(call) => {
                    if !call.conditional || result {
                        self.call(call);
                    }
                    fresh = true;
                }
                Op::Nothing => {}
            }
            if end && brackets.is_empty() {
                result = checks[0].value();
            }
            if fresh && brackets.is_empty() && !matches!(instruction.op, Op::OrBlock) {
                checks[0].sum = None;
                checks[0].product = Some(result);
            }
            if matches!(instruction.op, Op::OrBlock) {
                fresh = true;
            }
        }
    }

    fn call(&mut self, call: &Call) {
        if let Some(unit) = self.program.units.iter().find(|u| u.block == call.block) {
            return self.unit(unit);
        }
        let bit = |name: &str| {
            let param = call.params.iter().find(|p| p.name.text == name)?;
            match param.value {
                Actual::Bit(bit) => Some(bit),
                _ => None,
            }
        };
        let time = |name: &str| {
            let param = call.params.iter().find(|p| p.name.text == name);
            param.map_or(0, |p| match p.value {
                Actual::Time(us) => us as i64,
                _ => 0,
            })
        };
        let is = |name: &str, other: bool| bit(name).map_or(other, |bit| self.bit(bit));
        let e = ["In1", "In2", "In3"].iter().all(|name| is(name, true));
        let q = ["Quit1", "Quit2"].map(|name| is(name, false));
        let first = is("FirstRun", false);
        let mut relay = self.relays.remove(&call.span.start).unwrap_or_default();
        if !relay.called {
            relay.called = true;
            relay.q = [true, true];
        }
        if first {
            relay = Relay {
                called: true,
                q,
                ..Relay::default()
            };
        }
        let rises = [0, 1].map(|k| q[k] && !relay.q[k]);
        relay.q = q;
        if !e {
            if relay.on {
                relay.fell = Some(self.now);
            }
            relay.on = false;
        } else if rises[0] || (relay.armed && rises[1]) {
            relay.armed |= rises[0];
            relay.on = true;
            relay.fell = None;
        }
        for (k, name) in ["Out0", "Out1", "Out2", "Out3"].iter().enumerate() {
            let length = if k == 0 {
                0
            } else {
                time(&format!("TimeValue{k}"))
            };
            let delayed = relay.fell.is_some_and(|fell| self.now - fell < length);
            if let Some(bit) = bit(name) {
                self.set(bit, relay.on || delayed);
            }
        }
        if let Some(bit) = bit("FirstRun") {
            self.set(bit, false);
        }
        self.relays.insert(call.span.start, relay);
    }
}
