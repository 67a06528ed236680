//! Properties as questions to the engines: what must not be seen, or must be seen, in one cycle.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{Form, Property};
use stillpoint_model::proof::Lit;

use super::monitor::{self, Duty};
use crate::export::{Translated, Unsupported};

/// Longer bounds have no monitor: its counter would outgrow what the engines decide.
const LONGEST: i64 = 1 << 20;

/// What is asked about one property.
pub(super) enum Question {
    /// What breaks it, and what must be seen for it to say something.
    Never {
        broken: Lit,
        /// Of a bounded response.
        duty: Option<Duty>,
        first: Option<Lit>,
        stated: Vec<Stated>,
    },
    /// What shows it.
    Seen(Lit),
    /// No engine here has an answer, and why.
    None(&'static str),
}

/// What a property states of its bound, as what must not be seen or must be seen.
pub(super) struct Stated {
    pub seen: bool,
    pub what: Lit,
    pub duty: Option<Duty>,
    /// What it says, if it is not so.
    pub otherwise: String,
}

/// A system, and what is asked about its properties and about ranges.
pub(super) struct Asked<'a> {
    pub translated: Translated<'a>,
    /// As the properties of the system.
    pub questions: Vec<Question>,
}

impl<'a> Asked<'a> {
    pub(super) fn new(bound: &'a Bound) -> Result<Self, Unsupported> {
        let mut asked = Asked {
            translated: Translated::new(bound)?,
            questions: Vec::new(),
        };
        for property in &bound.system.properties {
            let question = asked.question(property).unwrap_or(Question::None(
                "an expression of it cannot be told in one cycle",
            ));
            asked.questions.push(question);
        }
        Ok(asked)
    }

    fn atom(&self, k: usize) -> Option<Lit> {
        self.translated.atoms.get(k).copied().flatten()
    }

    fn question(&mut self, property: &Property) -> Option<Question> {
        let fault = self.translated.fault;
        let graph = |asked: &mut Self, list: &[Lit]| {
            asked.translated.netlist.graph.all(list.iter().copied())
        };
        Some(match &property.form {
            Form::Always { when, then } => {
                let then = self.atom(*then)?;
                let first = match when {
                    Some(when) => Some(self.atom(*when)?),
                    None => None,
                };
                let when = first.unwrap_or(Lit::TRUE);
                Question::Never {
                    broken: graph(self, &[!fault, when, !then]),
                    duty: None,
                    first: first.map(|first| graph(self, &[!fault, first])),
                    stated: Vec::new(),
                }
            }
            Form::Reachable { goal } => {
                let goal = self.atom(*goal)?;
                Question::Seen(graph(self, &[!fault, goal]))
            }
            Form::Unless {
                when,
                holds,
                unless,
            } => {
                let (when, holds) = (self.atom(*when)?, self.atom(*holds)?);
                let unless = self.atom(*unless)?;
                let netlist = &mut self.translated.netlist;
                Question::Never {
                    broken: monitor::until(netlist, fault, (when, holds, unless)),
                    duty: None,
                    first: Some(graph(self, &[!fault, when])),
                    stated: Vec::new(),
                }
            }
            Form::LeadsTo {
                when,
                goal,
                within: Some(within),
                ..
            } => {
                let bound = self.translated.bound;
                let within = bound.constant(within).max(0);
                if within > LONGEST {
                    return Some(Question::None("its bound is too long to be counted"));
                }
                let pair = (self.atom(*when)?, self.atom(*goal)?);
                let netlist = &mut self.translated.netlist;
                let (broken, duty) = monitor::within(netlist, fault, pair, within);
                let stated = self.stated(property, pair, within, (broken, &duty));
                Question::Never {
                    broken,
                    duty: Some(duty),
                    first: Some(graph(self, &[!fault, pair.0])),
                    stated,
                }
            }
            Form::LeadsTo { .. } => {
                Question::None("a response without a bound is about runs without an end")
            }
            Form::CanAlwaysReach { .. } => {
                Question::None("what can always be reached is not decided by the worst run")
            }
            Form::Independent { .. } => Question::None("independence is about two runs"),
        })
    }

    /// What a bounded response states of the least bound and the fastest reaction.
    fn stated(
        &mut self,
        property: &Property,
        pair: (Lit, Lit),
        within: i64,
        own: (Lit, &Duty),
    ) -> Vec<Stated> {
        let bound = self.translated.bound;
        let fault = self.translated.fault;
        let netlist = &mut self.translated.netlist;
        let mut list = Vec::new();
        if let Some(exactly) = &property.stated.exactly {
            let least = bound.constant(exactly).max(0);
            let (what, duty) = match least == within {
                true => (own.0, own.1.clone()),
                false => monitor::within(netlist, fault, pair, least),
            };
            let otherwise = format!("the least bound recorded is {least} cycles, the one found ");
            list.push(Stated {
                seen: false,
                what,
                duty: Some(duty),
                otherwise: format!("{otherwise}is longer"),
            });
            if least > 0 {
                list.push(Stated {
                    seen: true,
                    what: monitor::within(netlist, fault, pair, least - 1).0,
                    duty: None,
                    otherwise: format!("{otherwise}is shorter"),
                });
            }
        }
        if let Some(fastest) = &property.stated.fastest {
            let fastest = bound.constant(fastest).max(0);
            let (early, right) = monitor::fastest(netlist, fault, pair, fastest);
            let otherwise =
                format!("the fastest reaction recorded is {fastest} cycles, the one found ");
            list.push(Stated {
                seen: false,
                what: early,
                duty: None,
                otherwise: format!("{otherwise}is shorter"),
            });
            list.push(Stated {
                seen: true,
                what: right,
                duty: None,
                otherwise: format!("{otherwise}is longer, or there is none"),
            });
        }
        list
    }
}
