//! An interpreter of the safe logic, and random programs: what a program does action by action is what its table does.
//!
//! It shares the parsed program with the translation and nothing else: it has values where that has names, and times in microseconds
//! where that counts cycles.

mod random;

use std::collections::BTreeMap;

use super::ast::{Action, Expr, ExprKind, Logic, Relation, Trigger, Value};
use super::lex::MILLION;
use super::{Program, Readings, Variable};

/// A timer: its time in microseconds, and whether it runs.
#[derive(Debug, Clone, Copy)]
struct Timer {
    time: i64,
    runs: bool,
}

/// A relay, with its times in microseconds.
#[derive(Debug, Clone, Default)]
struct Relay {
    q: [bool; 2],
    e: bool,
    a0: bool,
    armed: bool,
    first: bool,
    t4: i64,
    t4i: i64,
    /// How long A0 has been FALSE since it fell; none before that and while it is TRUE.
    off: Option<i64>,
}

fn is_timer(e: &Expr) -> bool {
    matches!(&e.kind, ExprKind::Variable(of) if of.is_timer())
}

/// A program that runs.
struct Machine<'p> {
    program: &'p Program,
    readings: Readings,
    /// The time of a cycle, in microseconds.
    cycle: i64,
    values: BTreeMap<Variable, i64>,
    timers: BTreeMap<Variable, Timer>,
    relays: BTreeMap<u8, Relay>,
    /// For each action: the condition before, for EVERY; whether it has fired, for WHEN and FROM.
    memory: BTreeMap<u8, bool>,
}

impl<'p> Machine<'p> {
    fn new(program: &'p Program, readings: Readings, cycle: i64) -> Self {
        Self {
            program,
            readings,
            cycle,
            values: BTreeMap::new(),
            timers: BTreeMap::new(),
            relays: BTreeMap::new(),
            memory: BTreeMap::new(),
        }
    }

    /// One cycle with these inputs.
    fn cycle(&mut self, inputs: &[(Variable, i64)]) {
        self.values.extend(inputs.iter().cloned());
        for timer in self.timers.values_mut().filter(|timer| timer.runs) {
            timer.time += self.cycle;
        }
        // By their ids, whatever order the reader left them in.
        let mut actions: Vec<&Action> = self.program.actions.iter().collect();
        actions.sort_by_key(|action| action.id);
        for action in actions {
            let holds = action.condition.as_ref().is_none_or(|c| self.value(c) != 0);
            let begin = action.trigger == Trigger::Every && self.readings.first_sample_is_no_edge;
            let memory = self.memory.entry(action.id).or_insert(begin);
            let fires = match action.trigger {
                Trigger::Always | Trigger::Whenever => holds,
                Trigger::Every => holds && !std::mem::replace(memory, holds),
                Trigger::When => holds && !std::mem::replace(memory, *memory || holds),
                Trigger::From => {
                    *memory |= holds;
                    *memory
                }
            };
            if action.trigger == Trigger::Every {
                *memory = holds;
            }
            if !fires {
                continue;
            }
            for one in &action.assigns {
                let ExprKind::Variable(target) = &one.target.kind else {
                    panic!("{:?}", one.target)
                };
                let value = match &one.value {
                    Value::Expr(value) => self.scaled(value, target.is_timer()),
                    Value::Relay(number) => self.relay(*number),
                };
                self.set(target, value);
            }
        }
    }

    fn set(&mut self, target: &Variable, value: i64) {
        if !target.is_timer() {
            self.values.insert(target.clone(), value);
        } else if value < 0 {
            if let Some(timer) = self.timers.get_mut(target) {
                timer.runs = false;
            }
        } else {
            self.timers.insert(
                target.clone(),
                Timer {
                    time: value,
                    runs: true,
                },
            );
        }
    }

    /// A value; times in microseconds.
    fn value(&self, e: &Expr) -> i64 {
        match &e.kind {
            ExprKind::Bool(value) => i64::from(*value),
            ExprKind::Number(number) => number.millionths / MILLION,
            ExprKind::Variable(of) if of.is_timer() => {
                let large = self.readings.timers_begin_large && !self.timers.contains_key(of);
                match large {
                    true => i64::MAX,
                    false => self.timers.get(of).map_or(0, |timer| timer.time),
                }
            }
            ExprKind::Variable(of) => self.values.get(of).copied().unwrap_or(0),
            ExprKind::Unknown(name) => panic!("{name}"),
            ExprKind::Not(a) => 1 - self.value(a),
            ExprKind::Logic(word, a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                match word {
                    Logic::And => a & b,
                    Logic::Or => a | b,
                    Logic::Xor => a ^ b,
                }
            }
            ExprKind::Compare(relation, a, b) => {
                let timed = [a, b].into_iter().any(|e| is_timer(e));
                let (a, b) = (self.scaled(a, timed), self.scaled(b, timed));
                i64::from(match relation {
                    Relation::Equal => a == b,
                    Relation::Unequal => a != b,
                    Relation::Greater => a > b,
                    Relation::Less => a < b,
                    Relation::GreaterEqual => a >= b,
                    Relation::LessEqual => a <= b,
                })
            }
        }
    }

    /// A value beside a timer, whose seconds are counted in microseconds, or beside anything else.
    fn scaled(&self, e: &Expr, timed: bool) -> i64 {
        match &e.kind {
            ExprKind::Number(number) if timed => number.millionths,
            _ => self.value(e),
        }
    }

    /// One step of a relay: the table of the requirements, line by line.
    fn relay(&mut self, number: u8) -> i64 {
        let set_up = self
            .program
            .relays
            .get(&number)
            .cloned()
            .unwrap_or_default();
        let status = [
            set_up.inputs.is_some(),
            set_up.outputs.is_some(),
            set_up.times.is_some(),
        ];
        let status: i64 = (0..3).filter(|k| !status[*k]).map(|k| 1 << k).sum();
        let outputs = set_up.outputs.map_or_else(Vec::new, |(list, _)| list);
        let mut given = vec![false; outputs.len()];
        if let (0, Some((inputs, _)), Some((times, _))) = (status, set_up.inputs, set_up.times) {
            let is: Vec<bool> = inputs.iter().map(|e| self.value(e) != 0).collect();
            let begin = Relay {
                q: [self.readings.first_sample_is_no_edge; 2],
                ..Relay::default()
            };
            let relay = self.relays.entry(number).or_insert(begin);
            let e = is[2..].iter().all(|input| *input);
            let level = self.readings.relay_acknowledged_by_level;
            let ack = [0, 1].map(|k| is[k] && (level || !relay.q[k]));
            if relay.e && !e {
                relay.first = relay.a0;
                relay.t4 = 0;
            }
            relay.off = relay.off.map(|off| off + self.cycle);
            if !e {
                relay.t4 += self.cycle;
                if relay.a0 {
                    relay.off = Some(0);
                }
                relay.a0 = false;
            }
            if e && !relay.e {
                relay.t4i = if relay.first {
                    relay.t4
                } else {
                    relay.t4i.max(relay.t4)
                };
            }
            if e && !relay.a0 && ack[0] {
                relay.a0 = true;
                relay.armed = true;
            }
            if e && !relay.a0 && relay.armed && ack[1] && relay.t4i < times[0] {
                relay.a0 = true;
            }
            if relay.a0 {
                relay.off = None;
            }
            relay.e = e;
            relay.q = [is[0], is[1]];
            for (k, output) in given.iter_mut().enumerate() {
                let delayed = k > 0 && relay.off.is_some_and(|off| off < times[k]);
                *output = relay.a0 || delayed;
            }
        }
        for (output, value) in outputs.iter().zip(given) {
            if let ExprKind::Variable(target) = &output.kind {
                self.values.insert(target.clone(), i64::from(value));
            }
        }
        status
    }
}
