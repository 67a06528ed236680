//! Properties as questions to the engines: what must not be seen, or must be seen, in one cycle.

use stillpoint_certify::proof::clause::written;
use stillpoint_engine::label;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{Form, Property, Ty};
use stillpoint_model::Trace;
use stillpoint_model::proof::{Bounded, Budget, Lit, Problem, Run};

use super::every::{Every, begins};
use super::linear::Linear;
use super::monitor::{self, Cycles, Duty, Forever};
use crate::export::{Translated, Unsupported};

/// Longer bounds have no monitor: its counter would outgrow what the engines decide.
const LONGEST: i64 = 1 << 20;

/// A number with a range of at least so many values may be a timer.
const COUNTS: i64 = 4;

/// What is told of a system without a configuration.
pub(super) const NOTHING: &str = "no values of its parameters go together";

fn nothing() -> Unsupported {
    Unsupported(NOTHING.to_owned())
}

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
    /// What must stay possible, what holds on the way, and both.
    Way { goal: Lit, using: Lit, end: Lit },
    /// A response without a bound.
    Forever(Forever),
    /// It is about two runs.
    Twice,
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
    /// Parameters that are part of the state: places of their state variables.
    pub parameters: &'a [usize],
    /// The number of latches that are no monitor's: the first ones.
    pub latches: usize,
    /// The number of state variables that are neither parameters nor bounds over them: the first ones.
    pub own: usize,
    /// By property the state variable that has its bound, if there is such.
    bounds: Vec<Option<usize>>,
    /// By property what its bound is made of.
    about: Vec<Linear>,
    /// With conditions on the parameters: by latch the start of a run in one of the configurations.
    such: Vec<Option<bool>>,
}

impl<'a> Asked<'a> {
    pub(super) fn new(bound: &'a Bound) -> Result<Self, Unsupported> {
        let translated = Translated::new(bound)?;
        let mut asked = Asked {
            latches: translated.netlist.latches.len(),
            translated,
            questions: Vec::new(),
            parameters: &[],
            own: bound.states.len(),
            bounds: vec![None; bound.system.properties.len()],
            about: vec![Linear::default(); bound.system.properties.len()],
            such: Vec::new(),
        };
        asked.ask();
        Ok(asked)
    }

    /// The same for all values of some parameters.
    pub(super) fn every(every: &'a Every) -> Result<Self, Unsupported> {
        let translated = Translated::new(&every.bound)?;
        let mut asked = Asked {
            latches: translated.netlist.latches.len(),
            translated,
            questions: Vec::new(),
            parameters: &every.parameters,
            own: every.own,
            bounds: every.within.clone(),
            about: every.about.clone(),
            such: Vec::new(),
        };
        let (always, start) = (
            asked.conditions(&every.always)?,
            asked.conditions(&every.start)?,
        );
        let assumed = asked.conditions(&every.assumed)?;
        let netlist = &mut asked.translated.netlist;
        netlist.start.extend(always.iter().chain(&start));
        netlist.invariants.extend(always);
        netlist.assumed.extend(assumed);
        if !every.conditions.is_empty() {
            let begin = Problem::with(netlist, Lit::TRUE, &netlist.start);
            let run = Bounded::new(&begin, &Budget::default()).within(1);
            let run = run.ok().flatten();
            asked.such = run.map(|run| run.start).ok_or_else(nothing)?;
        }
        asked.ask();
        Ok(asked)
    }

    /// A run as one of the system. Parameters that it does not depend on have values that satisfy the conditions too.
    pub(super) fn trace(&self, run: &Run) -> Trace {
        let mut run = run.clone();
        for (own, such) in run.start.iter_mut().zip(&self.such) {
            *own = own.or(*such);
        }
        self.translated.trace(&run)
    }

    /// One of the configurations, by the places of the parameters' state variables.
    pub(super) fn configured(&self) -> Vec<(usize, i64)> {
        let run = Run {
            start: vec![None; self.translated.netlist.latches.len()],
            cycles: Vec::new(),
        };
        let trace = self.trace(&run);
        let value = |k: &usize| (*k, begins(self.translated.bound, &trace, *k));
        self.parameters.iter().map(value).collect()
    }

    /// The configuration of a run, where parameters are part of the state.
    pub(super) fn configuration(&self, trace: &Trace) -> Option<String> {
        let bound = self.translated.bound;
        let value = |k: &usize| {
            let var = &bound.system.states[*k].var;
            let value = bound.system.show(var.ty, begins(bound, trace, *k));
            format!("{} = {value}", var.name)
        };
        let list: Vec<String> = self.parameters.iter().map(value).collect();
        (!list.is_empty()).then(|| format!("with {}", list.join(", ")))
    }

    fn conditions(&self, list: &[usize]) -> Result<Vec<Lit>, Unsupported> {
        let told = |k: &usize| {
            let lit = self.atom(*k).filter(|lit| *lit != Lit::FALSE);
            lit.ok_or_else(nothing)
        };
        list.iter().map(told).collect()
    }

    /// The name of a state variable, a parameter or a bound in a certificate.
    pub(super) fn name(&self, variable: usize) -> String {
        let system = &self.translated.bound.system;
        match self.bounds.iter().position(|k| *k == Some(variable)) {
            Some(property) => format!("@within:{}", label(&system.properties[property])),
            None => written(&system.states[variable].var.name),
        }
    }

    /// State variables that count, by their places: while one of them falls the others may change.
    pub(super) fn numbers(&self) -> Vec<usize> {
        let bound = self.translated.bound;
        let counts = |k: &usize| {
            let (lo, hi) = bound.states[*k];
            bound.system.states[*k].var.ty == Ty::Int && i64::from(hi) - i64::from(lo) >= COUNTS
        };
        (0..self.own).filter(counts).collect()
    }

    /// Asks about all properties.
    fn ask(&mut self) {
        let bound = self.translated.bound;
        for (k, property) in bound.system.properties.iter().enumerate() {
            let question = self.question(k, property);
            self.questions.push(question.unwrap_or(Question::None(
                "an expression of it cannot be told in one cycle",
            )));
        }
    }

    fn atom(&self, k: usize) -> Option<Lit> {
        self.translated.atoms.get(k).copied().flatten()
    }

    /// The same of a condition; without one everything satisfies it.
    fn given(&self, condition: Option<usize>) -> Option<Lit> {
        condition.map_or(Some(Lit::TRUE), |k| self.atom(k))
    }

    fn question(&mut self, number: usize, property: &Property) -> Option<Question> {
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
                let within = match self.bounds[number] {
                    Some(k) => {
                        let (word, (_, most)) = self.translated.variable(k);
                        let about = self.about[number].clone();
                        Cycles { word, most, about }
                    }
                    None => Cycles::constant(self.translated.bound.constant(within).max(0)),
                };
                if within.most > LONGEST {
                    return Some(Question::None("its bound is too long to be counted"));
                }
                let pair = (self.atom(*when)?, self.atom(*goal)?);
                let netlist = &mut self.translated.netlist;
                let (broken, duty) = monitor::within(netlist, fault, pair, &within);
                let stated = self.stated(property, pair, within.most, (broken, &duty));
                Question::Never {
                    broken,
                    duty: Some(duty),
                    first: Some(graph(self, &[!fault, pair.0])),
                    stated,
                }
            }
            Form::LeadsTo {
                when,
                goal,
                within: None,
                fair,
                assuming,
            } => {
                let fair: Option<Vec<Lit>> = fair.iter().map(|k| self.atom(*k)).collect();
                let assuming = self.given(*assuming)?;
                let when = self.atom(*when)?;
                Question::Forever(Forever {
                    first: graph(self, &[!fault, when]),
                    when,
                    goal: self.atom(*goal)?,
                    assuming,
                    fair: fair?,
                })
            }
            Form::CanAlwaysReach { goal, using } => {
                let goal = self.atom(*goal)?;
                let using = self.given(*using)?;
                let using = graph(self, &[!fault, using]);
                let end = graph(self, &[using, goal]);
                Question::Way { goal, using, end }
            }
            Form::Independent { .. } => Question::Twice,
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
                false => monitor::within(netlist, fault, pair, &Cycles::constant(least)),
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
                    what: monitor::within(netlist, fault, pair, &Cycles::constant(least - 1)).0,
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
