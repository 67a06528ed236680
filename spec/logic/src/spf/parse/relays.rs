//! Safety relays: their set-up outside the actions, and their call.

use super::super::ast::{Expr, ExprKind};
use super::super::lex::{MILLION, Token, decimal};
use super::super::names::Meaning;
use super::super::variable::Variable;
use super::Parser;
use crate::fault::{Checked, Fault, Span};

/// A set-up: its name, how it is written, how many values it takes, and which variables these are: S840D-RELAY-009, S840D-RELAY-010,
/// S840D-RELAY-011, S840D-RELAY-012, S840D-RELAY-016.
struct Setup {
    usage: &'static str,
    least: usize,
    most: usize,
    allowed: &'static [&'static str],
}

/// What the inputs of a relay are connected to (S840D-RELAY-009).
const INPUTS: Setup = Setup {
    usage: "write `SIRELIN(1, STATUS, \"Q1\", \"Q2\", \"E1\")`; \"E2\", \"E3\" may follow",
    least: 3,
    most: 5,
    allowed: &["MARKERSI", "INSE", "INSI", "OUTSE", "OUTSI"],
};

/// What its outputs are connected to; each delayed one has a time (S840D-RELAY-010, S840D-RELAY-016).
const OUTPUTS: Setup = Setup {
    usage: "write `SIRELOUT(1, STATUS, \"A0\")`; \"A1\", \"A2\", \"A3\" may follow",
    least: 1,
    most: 4,
    allowed: &["MARKERSI", "OUTSE", "OUTSI", "PLCSIOUT"],
};

/// Its times; each but the first has a delayed output (S840D-RELAY-011, S840D-RELAY-016).
const TIMES: Setup = Setup {
    usage: "write `SIRELTIME(1, STATUS, 0.5)`: TM1 in seconds; TI1, TI2, TI3 may follow",
    least: 1,
    most: 4,
    allowed: &[],
};

/// The longest time of a relay, in microseconds: 24 days.
const LONGEST: i64 = 24 * 86_400 * MILLION;

impl Parser<'_, '_> {
    /// One set-up of a relay, outside the actions. A value that the control would only tell in its status is refused, and so is a
    /// delayed output without its time: at the later of both (S840D-RELAY-009, S840D-RELAY-010, S840D-RELAY-011, S840D-RELAY-016).
    pub(super) fn relay(&mut self) -> Checked<()> {
        let word = self.upper();
        let start = self.span().start;
        self.at += 1;
        let setup = match word.as_str() {
            "SIRELIN" => &INPUTS,
            "SIRELOUT" => &OUTPUTS,
            _ => &TIMES,
        };
        self.expect("(", setup.usage)?;
        let number = self.relay_number()?;
        self.expect(",", setup.usage)?;
        self.status(setup.usage)?;
        let (mut variables, mut times) = (Vec::new(), Vec::new());
        while self.sym(",") {
            match setup.allowed {
                [] => times.push(self.time()?),
                allowed => variables.push(self.connected(allowed, setup.usage)?),
            }
        }
        self.expect(")", setup.usage)?;
        let span = self.since(start);
        let count = variables.len() + times.len();
        if count < setup.least || count > setup.most {
            return Err(Fault::new(
                &span,
                format!("{word} has {count} values here"),
                setup.usage,
            ));
        }
        let line = |span: &Span| super::super::line_of(self.reader.source, span.start);
        let relay = self.reader.relays.entry(number).or_default();
        let place = match word.as_str() {
            "SIRELIN" => relay
                .inputs
                .replace((variables, span.clone()))
                .map(|(_, span)| span),
            "SIRELOUT" => relay
                .outputs
                .replace((variables, span.clone()))
                .map(|(_, span)| span),
            _ => relay
                .times
                .replace((times, span.clone()))
                .map(|(_, span)| span),
        };
        if let Some(first) = place {
            return Err(Fault::new(
                &span,
                format!(
                    "the relay {number} has its {word} at line {} already",
                    line(&first)
                ),
                "set each relay up once",
            ));
        }
        if let (Some((outputs, at)), Some((times, times_at))) = (&relay.outputs, &relay.times) {
            if outputs.len() != times.len() {
                let later = if at.start > times_at.start {
                    at
                } else {
                    times_at
                };
                return Err(Fault::new(
                    later,
                    format!(
                        "the relay {number} has {} delayed outputs and {} times for them",
                        outputs.len() - 1,
                        times.len() - 1
                    ),
                    "A1 goes with TI1, A2 with TI2, A3 with TI3: give both or neither",
                ));
            }
        }
        Ok(())
    }

    /// There are four relays; another number is alarm 20149 of the control (S840D-RELAY-012).
    fn relay_number(&mut self) -> Checked<u8> {
        let span = self.span();
        match *self.peek() {
            Token::Number(number, false) if (1..=4).contains(&(number / MILLION)) => {
                self.at += 1;
                Ok((number / MILLION) as u8)
            }
            _ => Err(Fault::new(
                &span,
                format!("there is no relay {}: alarm 20149", self.peek().describe()),
                "relays are 1..4",
            )),
        }
    }

    /// The variable that takes the answer of a set-up. The answer is looked at by nothing: what it would tell is refused here.
    fn status(&mut self, usage: &str) -> Checked<()> {
        let span = self.span();
        let Token::Word(name) = self.peek().clone() else {
            return self.wanted("the variable for the status", usage);
        };
        self.at += 1;
        match self.known(&name, &span)?.meaning {
            Meaning::Local | Meaning::Undefined => Ok(()),
            Meaning::Variable(variable) if variable.is("AC_MARKER") => Ok(()),
            _ => Err(Fault::new(
                &span,
                format!("'{name}' cannot take the status"),
                format!("declare it: `DEF INT {name}`"),
            )),
        }
    }

    /// A variable in quotation marks, by its name or its own.
    fn connected(&mut self, allowed: &[&str], usage: &str) -> Checked<Expr> {
        let span = self.span();
        let Token::Text(text) = self.peek().clone() else {
            return self.wanted("a variable in quotation marks", usage);
        };
        self.at += 1;
        let text = text.trim();
        let kind = if text.starts_with('$') {
            let made: Result<Variable, String> = text.parse();
            ExprKind::Variable(made.map_err(|message| Fault::new(&span, message, usage))?)
        } else {
            match self.known(text, &span)?.meaning {
                Meaning::Variable(variable) => ExprKind::Variable(variable),
                Meaning::Undefined => ExprKind::Unknown(text.to_owned()),
                Meaning::Number(..) | Meaning::Local => {
                    return Err(Fault::new(
                        &span,
                        format!("'{text}' is no system variable"),
                        usage,
                    ));
                }
            }
        };
        if let ExprKind::Variable(variable) = &kind {
            if !allowed.iter().any(|short| variable.is(short)) {
                let list: Vec<String> = allowed.iter().map(|short| format!("$A_{short}")).collect();
                return Err(Fault::new(
                    &span,
                    format!("a relay cannot have `{}` here", variable.written()),
                    format!("allowed are {}", list.join(", ")),
                ));
            }
        }
        Ok(Expr { kind, span })
    }

    fn time(&mut self) -> Checked<i64> {
        let span = self.span();
        let number = self.number()?;
        match (0..=LONGEST).contains(&number.millionths) {
            true => Ok(number.millionths),
            false => Err(Fault::new(
                &span,
                format!(
                    "`{}` is no time of a relay",
                    decimal(number.millionths, number.real)
                ),
                "write seconds, 0 or more, at most 24 days: 0.5",
            )),
        }
    }

    /// `SIRELAY(1)`
    pub(super) fn relay_call(&mut self) -> Checked<u8> {
        const HELP: &str = "write `status = SIRELAY(1)`";
        self.at += 1;
        self.expect("(", HELP)?;
        let number = self.relay_number()?;
        self.expect(")", HELP)?;
        Ok(number)
    }
}
