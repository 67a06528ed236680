//! A program as it was understood: one block a line, names resolved, everything in parentheses. It is itself a program.

use std::fmt;

use super::ast::{Action, Expr, ExprKind, Trigger, Value};
use super::lex::decimal;
use super::{Program, Variable};

impl fmt::Display for Expr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let inner = |e: &Expr| match e.kind {
            ExprKind::Not(_) | ExprKind::Logic(..) | ExprKind::Compare(..) => format!("({e})"),
            _ => e.to_string(),
        };
        match &self.kind {
            ExprKind::Bool(true) => f.write_str("TRUE"),
            ExprKind::Bool(false) => f.write_str("FALSE"),
            ExprKind::Number(number) => f.write_str(&decimal(number.millionths, number.real)),
            ExprKind::Variable(variable) => f.write_str(&variable.written()),
            ExprKind::Unknown(name) => f.write_str(name),
            ExprKind::Not(a) => write!(f, "NOT {}", inner(a)),
            ExprKind::Logic(word, a, b) => {
                write!(f, "{} {} {}", inner(a), word.word(), inner(b))
            }
            ExprKind::Compare(relation, a, b) => {
                write!(f, "{} {} {}", inner(a), relation.symbol(), inner(b))
            }
        }
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", if self.modal { "ID" } else { "IDS" }, self.id)?;
        let trigger = match self.trigger {
            Trigger::Always => "",
            Trigger::Whenever => "WHENEVER",
            Trigger::Every => "EVERY",
            Trigger::When => "WHEN",
            Trigger::From => "FROM",
        };
        if let Some(condition) = &self.condition {
            write!(f, " {trigger} {condition}")?;
        }
        f.write_str(" DO")?;
        for assign in &self.assigns {
            write!(f, " {} = ", assign.target)?;
            match &assign.value {
                Value::Expr(expr) => match expr.kind {
                    ExprKind::Compare(..) => write!(f, "({expr})")?,
                    _ => write!(f, "{expr}")?,
                },
                Value::Relay(number) => write!(f, "SIRELAY({number})")?,
            }
        }
        Ok(())
    }
}

impl fmt::Display for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.relays.is_empty() {
            writeln!(f, "DEF INT STATUS")?;
        }
        for (number, relay) in &self.relays {
            let quoted = |list: &[Expr]| {
                let list: Vec<String> = list.iter().map(|e| format!("\"{e}\"")).collect();
                list.join(", ")
            };
            if let Some((list, _)) = &relay.inputs {
                writeln!(f, "SIRELIN({number}, STATUS, {})", quoted(list))?;
            }
            if let Some((list, _)) = &relay.outputs {
                writeln!(f, "SIRELOUT({number}, STATUS, {})", quoted(list))?;
            }
            if let Some((times, _)) = &relay.times {
                let list: Vec<String> = times.iter().map(|us| decimal(*us, true)).collect();
                writeln!(f, "SIRELTIME({number}, STATUS, {})", list.join(", "))?;
            }
        }
        for action in &self.actions {
            writeln!(f, "{action}")?;
        }
        if !self.fragment {
            writeln!(f, "M17")?;
        }
        Ok(())
    }
}

impl Variable {
    /// Whether it is a timer.
    pub(super) fn is_timer(&self) -> bool {
        self.is("TIMERSI")
    }
}
