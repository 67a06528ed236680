//! Calls: of blocks of the file, which stand where they are called, and of blocks of the control.

use super::super::ast::{Actual, Block, Call, Param};
use super::super::known::{Kind, Known, known, signals_of_axis};
use super::super::operand::Area;
use super::Making;
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{BinaryOp, Expr, ExprKind, Stmt, TypeKind};
use crate::st::term;
use crate::tree::{binary, call_block, expr, name, time, truth, variable, word};

impl Making<'_> {
    /// The statements of a call.
    pub(super) fn call(&mut self, call: &Call, span: &Span) -> Checked<Vec<Stmt>> {
        let program = self.program;
        if let Some(unit) = program.unit(&call.block) {
            if let Some(param) = call.params.first() {
                return Err(Fault::new(
                    &param.span,
                    format!("{} has no parameters", call.block),
                    "a function of the file reads and writes bits of the PLC: leave the parameters out",
                ));
            }
            return Ok(self.block(unit));
        }
        let Some(known) = known(&call.block) else {
            let help = match &call.block {
                Block::Fc(_) | Block::Fb(_) => {
                    "add the block, or leave the call out if it writes nothing that the safe logic reads"
                }
                _ => "add the block, or give its number under SYMBOLS: `\"SI_RELAY\" : FB 10`",
            };
            return Err(Fault::new(
                &call.span,
                format!(
                    "{} does not stand in the file, and is no block of the control that is known here",
                    call.block
                ),
                help,
            ));
        };
        for param in &call.params {
            self.known_param(known, param)?;
        }
        self.calls += 1;
        match known.kind {
            Kind::Silent => Ok(Vec::new()),
            Kind::Relay => self.relay(call, span),
            Kind::BrakeTest => self.brake_test(call, span),
            Kind::Transfer => self.transfers(call, known, span),
            Kind::Free => {
                let start = self.flag(call, known.start, false, span)?;
                self.free(call, known, &start, span)
            }
        }
    }

    fn known_param(&self, known: &Known, param: &Param) -> Checked<()> {
        let text = param.name.text.to_uppercase();
        if known.has_output(&text) {
            return match param.value {
                Actual::Bit(bit) if bit.area == Area::Input => Err(Fault::new(
                    &param.span,
                    format!("{bit} is an input, and {} is written", param.name.text),
                    "use a marker or an output",
                )),
                Actual::Bit(_) | Actual::Cell(_) => Ok(()),
                _ => Err(Fault::new(
                    &param.span,
                    format!("{} is an output of the block", param.name.text),
                    "give it a bit, byte or word: `ready := M 211.2`",
                )),
            };
        }
        if known.has_input(&text) {
            return Ok(());
        }
        Err(Fault::new(
            &param.name.span,
            format!("{} has no parameter {}", known.number, param.name.text),
            format!("its parameters are {}", known.params()),
        ))
    }

    /// A parameter of type BOOL.
    fn flag(&self, call: &Call, name: &str, other: bool, span: &Span) -> Checked<Expr> {
        let Some(param) = given(call, name) else {
            return Ok(truth(other, span));
        };
        match param.value {
            Actual::Bit(bit) => Ok(self.bit(bit, &param.span)),
            Actual::Bool(value) => Ok(truth(value, &param.span)),
            Actual::Int(value @ (0 | 1)) => Ok(truth(value == 1, &param.span)),
            _ => Err(Fault::new(
                &param.span,
                format!("{} is a bit", param.name.text),
                "write `M 211.1`, TRUE or FALSE",
            )),
        }
    }

    /// What a block can give while it is started.
    fn free(
        &mut self,
        call: &Call,
        known: &Known,
        start: &Expr,
        span: &Span,
    ) -> Checked<Vec<Stmt>> {
        let mut made = Vec::new();
        for param in &call.params {
            let text = param.name.text.to_lowercase();
            let Actual::Bit(bit) = param.value else {
                continue;
            };
            if !known.has_output(&text.to_uppercase()) {
                continue;
            }
            let base = format!("{}_{}_{text}", known.number, self.calls)
                .replace(' ', "")
                .to_lowercase();
            let title = format!("{text} of {}", known.number);
            let port = self.wiring.added(&base, term::Ty::Bool, (0, 1), title);
            let value = binary(BinaryOp::And, start.clone(), name(&port, span), &param.span);
            made.extend(self.set_bit(bit, value, &param.span));
        }
        Ok(made)
    }

    /// FC21: what it transfers is read by the NCK alone; whether it fails is open.
    fn transfers(&mut self, call: &Call, known: &Known, span: &Span) -> Checked<Vec<Stmt>> {
        let enable = self.flag(call, "ENABLE", false, span)?;
        self.free(call, known, &enable, span)
    }

    /// FB10.
    fn relay(&mut self, call: &Call, span: &Span) -> Checked<Vec<Stmt>> {
        let block = self.wiring.fresh(&format!("fb10_{}", self.calls));
        let ty = TypeKind::Named("SI_RELAY".to_owned());
        self.kept.push(variable(&block, None, ty, None, span));
        let mut all = truth(true, span);
        for input in ["IN1", "IN2", "IN3"] {
            if given(call, input).is_some() {
                let value = self.flag(call, input, true, span)?;
                all = match all.kind {
                    ExprKind::Bool(true) => value,
                    _ => binary(BinaryOp::And, all, value, span),
                };
            }
        }
        let mut inputs = vec![
            ("E", all),
            ("Q1", self.flag(call, "QUIT1", false, span)?),
            ("Q2", self.flag(call, "QUIT2", false, span)?),
            ("FIRST", self.flag(call, "FIRSTRUN", false, span)?),
        ];
        for (port, param) in [
            ("T1", "TIMEVALUE1"),
            ("T2", "TIMEVALUE2"),
            ("T3", "TIMEVALUE3"),
        ] {
            inputs.push((port, time(duration(call, param)?, span)));
        }
        let mut made = vec![call_block(&block, inputs, span)];
        made.extend(self.results(call, &block, &["OUT0", "OUT1", "OUT2", "OUT3"]));
        if let Some(Param {
            value: Actual::Bit(bit),
            span,
            ..
        }) = given(call, "FIRSTRUN")
        {
            made.extend(self.set_bit(*bit, truth(false, span), span));
        }
        Ok(made)
    }

    /// FB11. Whether the axis is ready for a test, and what ends one before its time, is free.
    fn brake_test(&mut self, call: &Call, span: &Span) -> Checked<Vec<Stmt>> {
        let Some(signals) = signals_of_axis(call) else {
            return Err(Fault::new(
                &call.span,
                "the brake test names no axis".to_owned(),
                "write the number of an axis, from 1 to 31: `Axis := 3` (alarm 411101)",
            ));
        };
        let [plc, active, plus, minus, stop] = signals.map(|bit| self.bit(bit, &call.span));
        let mut inputs = vec![
            ("START", self.flag(call, "START", false, span)?),
            ("QUIT", self.flag(call, "QUIT", false, span)?),
            ("CLOSED", self.flag(call, "BCLOSED", false, span)?),
            ("PLC_AXIS", plc),
            ("ACTIVE", active),
            ("COMMAND", binary(BinaryOp::Or, plus, minus, span)),
            ("FIXED_STOP", stop),
        ];
        let number = self.calls;
        let mut free = |what: &str, title: &str| {
            let base = format!("fb11_{number}_{what}");
            let title = format!("{title} (FB 11)");
            name(
                self.wiring.added(&base, term::Ty::Bool, (0, 1), title),
                span,
            )
        };
        inputs.push(("READY", free("ready", "the axis is ready for a test")));
        inputs.push(("ABORTED", free("aborted", "the test ends before its time")));
        let mut longest = 0;
        for (port, param) in [
            ("T_ACTIVE", "TV_BTACTIV"),
            ("T_CLOSE", "TV_BCLOSE"),
            ("T_COMMAND", "TV_FEEDCOMMAND"),
            ("T_REACHED", "TV_FXSREACHED"),
            ("T_HOLD", "TV_FXSHOLD"),
        ] {
            let us = duration(call, param)?;
            if us == 0 {
                return Err(Fault::new(
                    &call.span,
                    format!("the brake test has no time {param}"),
                    format!("write `{param} := S5T#1S`"),
                ));
            }
            longest = longest.max(us);
            inputs.push((port, time(us, span)));
        }
        inputs.push(("T_MAX", time(longest, span)));
        let block = self.wiring.fresh(&format!("fb11_{number}"));
        let ty = TypeKind::Named("BRAKE_TEST".to_owned());
        self.kept.push(variable(&block, None, ty, None, span));
        let mut made = vec![call_block(&block, inputs, span)];
        let outputs = ["CLOSEBRAKE", "MOVEAXIS", "DONE", "ERROR"];
        made.extend(self.results(call, &block, &outputs));
        Ok(made)
    }

    /// The bits that a call gives to outputs of its block.
    fn results(&self, call: &Call, block: &str, outputs: &[&str]) -> Vec<Stmt> {
        let given = outputs.iter().filter_map(|output| {
            let Param { value, span, .. } = given(call, output)?;
            let Actual::Bit(bit) = value else { return None };
            let of = Box::new(name(block, span));
            let value = expr(ExprKind::Member(of, word(*output, span)), span);
            self.set_bit(*bit, value, span)
        });
        given.collect()
    }
}

/// A parameter of type TIME in microseconds; 0 where it is left out.
fn duration(call: &Call, name: &str) -> Checked<i64> {
    match given(call, name) {
        None => Ok(0),
        Some(Param {
            value: Actual::Time(us),
            ..
        }) => Ok(i64::try_from(*us).unwrap_or(i64::MAX)),
        Some(param) => Err(Fault::new(
            &param.span,
            format!("{} is a time", param.name.text),
            "write `T#1S500MS`",
        )),
    }
}

fn given<'c>(call: &'c Call, name: &str) -> Option<&'c Param> {
    let mut params = call.params.iter();
    params.find(|param| param.name.text.eq_ignore_ascii_case(name))
}
