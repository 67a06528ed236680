//! A block: its instructions one after the other. What a jump leaves out stands under a condition.

use std::collections::BTreeMap;

use super::super::ast::{Block, Instruction, Op, Source, TimerKind, Unit, Value};
use super::flow::Flow;
use super::numbers::Accumulator;
use super::timers::Timer;
use super::{MOST_CALLS, MOST_WORK, Making};
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{BinaryOp, Expr, ExprKind, Stmt, TypeKind};
use crate::tree::{assign, binary, name, not, only_if, truth};

/// A block that is being run.
pub(super) struct Run<'u> {
    unit: &'u Unit,
    pub flow: Flow,
    /// Accumulators 1 and 2, where it is known what they hold.
    pub accumulators: [Option<Accumulator>; 2],
    /// What has been made, and what has been made since the last label or jump.
    done: Vec<Stmt>,
    pub segment: Vec<Stmt>,
    /// The labels that a jump leads to, each with the variable that says whether it was taken.
    pending: BTreeMap<String, String>,
}

/// The label that stands for the end of a block.
const END: &str = "";

impl Run<'_> {
    /// What was made since the last label or jump happens unless one of the jumps before it was taken.
    fn flush(&mut self) {
        let segment = std::mem::take(&mut self.segment);
        let Some(first) = segment.first() else { return };
        let span = first.span.clone();
        let jumped = self.pending.values().map(|taken| name(taken, &span));
        let jumped = jumped.reduce(|a, b| binary(BinaryOp::Or, a, b, &span));
        match jumped {
            None => self.done.extend(segment),
            Some(jumped) => self.done.push(only_if(not(jumped), segment)),
        }
    }

    fn forget(&mut self) {
        self.flow.forget();
        self.accumulators = [None, None];
    }
}

fn is_settled(value: &Expr) -> bool {
    matches!(&value.kind, ExprKind::Bool(_))
        || matches!(&value.kind, ExprKind::Name(text) if text.starts_with("rlo"))
}

impl Making<'_> {
    /// The statements of a block.
    pub(super) fn block(&mut self, unit: &Unit) -> Vec<Stmt> {
        if self.calling.contains(&unit.block) || self.calling.len() >= MOST_CALLS {
            let message = format!(
                "{} calls itself, or too many blocks stand within one another",
                unit.block
            );
            self.fault(Fault::new(
                &unit.name.span,
                message,
                "call each block from outside of it, at most 16 within one another",
            ));
            return Vec::new();
        }
        self.calling.push(unit.block.clone());
        let mut run = Run {
            unit,
            flow: Flow::default(),
            accumulators: [None, None],
            done: Vec::new(),
            segment: Vec::new(),
            pending: BTreeMap::new(),
        };
        for (at, instruction) in unit.body.iter().enumerate() {
            self.work += 1;
            if self.work > MOST_WORK {
                if self.work == MOST_WORK + 1 {
                    let message =
                        format!("a cycle of the program has more than {MOST_WORK} instructions");
                    self.fault(Fault::new(
                        &instruction.span,
                        message,
                        "call its blocks less often",
                    ));
                }
                break;
            }
            if let Err(fault) = self.instruction(&mut run, at, instruction) {
                self.fault(fault);
                run.forget();
            }
        }
        if let Err(fault) = run.flow.no_brackets() {
            self.fault(fault);
        }
        run.flush();
        self.calling.pop();
        run.done
    }

    fn instruction(
        &mut self,
        run: &mut Run<'_>,
        at: usize,
        instruction: &Instruction,
    ) -> Checked<()> {
        let span = &instruction.span;
        if let Some(label) = &instruction.label {
            let key = label.text.to_uppercase();
            let earlier = &run.unit.body[..at];
            let twice = earlier
                .iter()
                .filter_map(|i| i.label.as_ref())
                .any(|l| l.text.to_uppercase() == key);
            if twice {
                let message = format!("the label {} stands there twice", label.text);
                self.fault(Fault::new(
                    &label.span,
                    message,
                    "give one of them another name",
                ));
            }
            run.flow.at_rest(&label.span, "a label")?;
            run.flush();
            run.pending.remove(&key);
            run.forget();
        }
        match &instruction.op {
            Op::Check {
                logic,
                not: inverted,
                of,
            } => {
                let value = self.source(of, span)?;
                let value = if *inverted { not(value) } else { value };
                run.flow.check(*logic, value, span);
                if run.flow.is_long() {
                    self.settle(run, span);
                }
            }
            Op::Open { logic, not } => run.flow.open(*logic, *not, span)?,
            Op::Close => run.flow.close(span)?,
            Op::OrBlock => run.flow.or_block(span)?,
            Op::Not => {
                let result = run.flow.so_far(span)?;
                run.flow.result = Some(not(result));
                run.flow.grows();
                if run.flow.is_long() {
                    self.settle(run, span);
                }
            }
            Op::SetResult | Op::ClearResult => {
                run.flow.at_rest(span, "this")?;
                run.flow.result = Some(truth(matches!(instruction.op, Op::SetResult), span));
                run.flow.from = span.start;
            }
            Op::Assign(bit) => {
                let result = self.result(run, span)?;
                let whole = run.flow.from..span.end;
                let made = self.set_bit(*bit, result, &whole);
                run.segment.extend(made);
            }
            Op::Set(Source::Bit(bit)) | Op::Reset(Source::Bit(bit)) => {
                let result = self.result(run, span)?;
                let value = truth(matches!(instruction.op, Op::Set(_)), span);
                let whole = run.flow.from..span.end;
                let made = self.set_bit(*bit, value, &whole);
                run.segment
                    .extend(made.map(|made| only_if(result, vec![made])));
            }
            Op::Set(Source::Timer(_)) => {}
            Op::Reset(Source::Timer(timer)) => {
                let result = self.result(run, span)?;
                let timer = self.timer(*timer, span)?;
                let made = timer.reset(result, span).ok_or_else(|| {
                    Fault::new(
                        span,
                        "an off-delay is not reset here: what it shows while its input is 1 is not said in one way",
                        "leave the reset out, or start the timer as a delay (SE, SD) and invert it",
                    )
                })?;
                run.segment.push(made);
            }
            Op::Edge { falling, memory } => self.edge(run, *falling, *memory, span)?,
            Op::Load(value) => self.load(run, value, span),
            Op::Transfer(cell) => self.transfer(run, *cell, span)?,
            Op::Compare(relation) => self.compare(run, *relation, span)?,
            Op::Start(_, number) => {
                let result = self.result(run, span)?;
                if !matches!(run.accumulators[0], Some(Accumulator::Time)) {
                    return Err(Fault::new(
                        span,
                        "no time is loaded for this timer",
                        "load it before: `L S5T#1S`",
                    ));
                }
                let timer = self.timer(*number, span)?;
                let whole = run.flow.from..span.end;
                run.segment.extend(timer.start(&result, &whole));
            }
            Op::Jump { when, to } => {
                let key = to.text.to_uppercase();
                let label = |i: &&Instruction| {
                    i.label
                        .as_ref()
                        .is_some_and(|l| l.text.to_uppercase() == key)
                };
                if !run.unit.body[at + 1..].iter().any(|i| label(&i)) {
                    let back = run.unit.body[..=at].iter().any(|i| label(&i));
                    let (message, help) = match back {
                        true => (
                            format!("this jumps back to {}", to.text),
                            "a loop may have no end: jump forward only",
                        ),
                        false => (
                            format!("there is no label {}", to.text),
                            "write it before an instruction of this block: `M001: NOP 0`",
                        ),
                    };
                    return Err(Fault::new(&to.span, message, help));
                }
                self.jump(run, *when, &key, span)?;
            }
            Op::End { conditional } => self.jump(run, conditional.then_some(true), END, span)?,
            Op::Call(call) => {
                let result = match call.conditional {
                    true => Some(self.result(run, span)?),
                    false => {
                        run.flow.at_rest(span, "a call")?;
                        None
                    }
                };
                let made = self.call(call, span)?;
                match result {
                    Some(result) => run.segment.push(only_if(result, made)),
                    None => run.segment.extend(made),
                }
                run.forget();
            }
            Op::Nothing => {}
        }
        Ok(())
    }

    /// The result, in a variable of its own, so that nothing that is written later changes it.
    fn result(&mut self, run: &mut Run<'_>, span: &Span) -> Checked<Expr> {
        let result = run.flow.taken(span)?;
        if is_settled(&result) {
            return Ok(result);
        }
        let whole = run.flow.from..span.end;
        let text = self.temp("rlo", TypeKind::Bool, &whole);
        run.segment.push(assign(&text, result, &whole));
        let value = name(&text, &whole);
        run.flow.result = Some(value.clone());
        Ok(value)
    }

    /// All values that wait are put into variables: something is written within a string of checks.
    pub(super) fn settle(&mut self, run: &mut Run<'_>, span: &Span) {
        let whole = run.flow.from..span.end;
        let mut made = Vec::new();
        for value in run.flow.values() {
            if is_settled(value) {
                continue;
            }
            let text = self.temp("rlo", TypeKind::Bool, &whole);
            made.push(assign(&text, value.clone(), &whole));
            *value = name(&text, &whole);
        }
        run.segment.extend(made);
    }

    fn source(&mut self, of: &Source, span: &Span) -> Checked<Expr> {
        match of {
            Source::Bit(bit) => Ok(self.bit(*bit, span)),
            Source::Timer(number) => Ok(self.timer(*number, span)?.is_on(span)),
        }
    }

    fn edge(
        &mut self,
        run: &mut Run<'_>,
        falling: bool,
        memory: super::Bit,
        span: &Span,
    ) -> Checked<()> {
        run.flow.so_far(span)?;
        self.settle(run, span);
        let result = run.flow.so_far(span)?;
        let was = self.bit(memory, span);
        let (now, before) = match falling {
            true => (not(result.clone()), was),
            false => (result.clone(), not(was)),
        };
        let whole = run.flow.from..span.end;
        let text = self.temp("rlo", TypeKind::Bool, &whole);
        run.segment.push(assign(
            &text,
            binary(BinaryOp::And, now, before, &whole),
            &whole,
        ));
        let made = self.set_bit(memory, result, span);
        run.segment.extend(made);
        run.flow.result = Some(name(&text, &whole));
        // A check behind it is combined with the edge.
        run.flow.begun = true;
        Ok(())
    }

    fn jump(
        &mut self,
        run: &mut Run<'_>,
        when: Option<bool>,
        to: &str,
        span: &Span,
    ) -> Checked<()> {
        let taken = match when {
            None => {
                run.flow.at_rest(span, "a jump")?;
                truth(true, span)
            }
            Some(on) => {
                let result = self.result(run, span)?;
                if on { result } else { not(result) }
            }
        };
        let flag = match run.pending.get(to) {
            Some(flag) => flag.clone(),
            None => self.temp("jump", TypeKind::Bool, span),
        };
        // A jump to the same place may have been taken before.
        let taken = match run.pending.contains_key(to) {
            true => binary(BinaryOp::Or, name(&flag, span), taken, span),
            false => taken,
        };
        run.segment.push(assign(
            &flag,
            taken,
            &(run.flow.from.min(span.start)..span.end),
        ));
        run.flush();
        run.pending.insert(to.to_owned(), flag);
        match when {
            // Who has not jumped has a result of 1.
            Some(_) => {
                run.flow.forget();
                run.flow.result = Some(truth(true, span));
                run.flow.from = span.start;
            }
            None => run.forget(),
        }
        Ok(())
    }

    fn timer(&self, number: u16, span: &Span) -> Checked<Timer> {
        self.timers.get(&number).cloned().ok_or_else(|| {
            Fault::new(
                span,
                format!("T {number} is never started"),
                format!("start it with its time: `L S5T#1S`, `SE T {number}` (SD)"),
            )
        })
    }

    /// The timers that are started, each in one place.
    pub(super) fn find_timers(&mut self) {
        let program = self.program;
        let mut found: Vec<(u16, TimerKind, u64, Span)> = Vec::new();
        for unit in &program.units {
            let mut loaded = None;
            for instruction in &unit.body {
                match &instruction.op {
                    Op::Load(Value::Time(us)) => loaded = Some(*us),
                    Op::Load(_) => loaded = None,
                    Op::Start(kind, number) => {
                        let us = loaded.unwrap_or(1);
                        let same = found.iter().find(|(known, ..)| known == number);
                        if let Some((_, _, _, first)) = same {
                            let line = super::super::line_of(&program.source, first.start);
                            let message = format!(
                                "T {number} is started in two places, first in line {line}"
                            );
                            self.fault(Fault::new(
                                &instruction.span,
                                message,
                                "give each of them a timer of its own",
                            ));
                        } else {
                            found.push((*number, *kind, us, instruction.span.clone()));
                        }
                    }
                    _ => {}
                }
            }
            if unit.block != Block::Bare {
                self.started_once(unit);
            }
        }
        for (number, kind, us, span) in found {
            let timer = Timer::new(number, kind, us, &span, |base| self.wiring.fresh(base));
            self.timers.insert(number, timer);
        }
    }

    /// A block that starts a timer is called in one place.
    fn started_once(&mut self, unit: &Unit) {
        let starts = unit.body.iter().any(|i| matches!(i.op, Op::Start(..)));
        let all = self.program.units.iter().flat_map(|unit| &unit.body);
        let mut calls = all.filter_map(|i| match &i.op {
            Op::Call(call) if call.block == unit.block => Some(&call.span),
            _ => None,
        });
        let second = calls.nth(1).cloned();
        if let (true, Some(span)) = (starts, second) {
            let message = format!("{} starts a timer, and is called in two places", unit.block);
            self.fault(Fault::new(&span, message, "call it once in a cycle"));
        }
    }
}
