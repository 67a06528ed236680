//! `check --engine`: properties judged by the proof engines of the model, without enumerating states.
//!
//! Each property becomes a question about a netlist (`question`), longer duties by a monitor (`monitor`); `decide` asks the engines. What
//! they have no form for is left to the explorer, or told to be open.

mod back;
mod decide;
mod every;
mod explored;
mod forever;
mod help;
mod judged;
mod linear;
mod monitor;
mod pairs;
mod question;
mod shown;
mod states;
mod text;

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use stillpoint_certify::proof::clause::Clause;
use stillpoint_engine::label;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Property;
use stillpoint_model::Verdict;
use stillpoint_model::proof::{Budget, Lit, Netlist, Problem, Run, Spent, States};

use crate::export::Unsupported;
use decide::{Decision, Depth, LIMITED, decide, until};
use help::helped;
use monitor::Duty;
use question::{Asked, Question, Stated};

pub use every::{Every, Span, Which};
pub use judged::{Choice, Engine, Judged, Measured, Proof, Settings};
pub use shown::Shown;
pub use text::{Told, exit_status, to_json};

/// Judges the properties of a system, then its ranges.
pub fn judge(bound: &Bound, settings: &Settings) -> Vec<Judged> {
    let mut judge = Judge::new(bound, settings);
    if settings.choice == Choice::Explorer {
        judge.explore(
            &(0..bound.system.properties.len()).collect::<Vec<_>>(),
            true,
        );
    } else {
        judge.prove(Asked::new(bound), &|property, settings| {
            pairs::judge(bound, property, settings)
        });
    }
    judge.out
}

/// Judges the properties of a system for all values of its parameters. The explorer, which takes one configuration at a time, is not
/// asked.
pub fn judge_every(every: &Every, settings: &Settings) -> Vec<Judged> {
    let mut judge = Judge::new(&every.bound, settings);
    judge.leave_to_explorer = false;
    judge.prove(Asked::every(every), &|property, settings| {
        pairs::judge_every(every, property, settings)
    });
    judge.out
}

/// One of the configurations: the parameters, by the places of their state variables, with their values.
///
/// # Errors
/// One sentence: there is none, or the system cannot be told.
pub fn one_of(every: &Every) -> Result<Vec<(usize, i64)>, String> {
    Ok(Asked::every(every).map_err(|why| why.0)?.configured())
}

/// The free parameters on which it depends whether the first property of a system is broken, or whether a value leaves its range if it
/// has none: places in [`System::params`](stillpoint_lang::ir::System::params).
pub fn deciding(every: &Every) -> Vec<usize> {
    let free = (0..every.bound.system.params.len()).filter(|k| every.place(*k).is_some());
    let Ok(asked) = Asked::every(every) else {
        return free.collect();
    };
    let translated = &asked.translated;
    let broken = match asked.questions.first() {
        Some(Question::Never { broken, .. }) => *broken,
        Some(_) => return free.collect(),
        None => translated.fault,
    };
    let problem = Problem::new(&translated.netlist, broken);
    let latches = problem.latches().iter();
    let seen = latches.filter_map(|latch| Some(translated.place(*latch)?.0));
    let seen: BTreeSet<usize> = seen.collect();
    free.filter(|k| every.place(*k).is_some_and(|place| seen.contains(&place)))
        .collect()
}

/// Whether no values of the parameters go together.
pub fn is_empty(every: &Every) -> bool {
    untold(every).as_deref() == Some(question::NOTHING)
}

/// Why the engines cannot be asked of a system, if they cannot.
pub fn untold(every: &Every) -> Option<String> {
    Asked::every(every).err().map(|why| why.0)
}

struct Judge<'a> {
    bound: &'a Bound,
    settings: &'a Settings,
    budget: Budget,
    /// When all of it ends.
    until: Option<Instant>,
    /// Whether properties without an engine are left to the explorer.
    leave_to_explorer: bool,
    /// Whether it is asked too if a value leaves its range.
    ranges: bool,
    /// Of the conditions that the netlist calls invariants those that a certificate does not know by itself.
    known: Vec<Clause>,
    /// Those of the whole system, where all properties are asked of them, with the number of questions that have used up their time.
    states: RefCell<Option<(States, u32)>>,
    out: Vec<Judged>,
}

impl<'a> Judge<'a> {
    fn new(bound: &'a Bound, settings: &'a Settings) -> Self {
        let budget = Budget {
            until: until(settings.time),
            interrupt: settings.interrupt.clone(),
        };
        Judge {
            bound,
            settings,
            until: budget.until,
            budget,
            leave_to_explorer: settings.choice == Choice::Auto,
            ranges: settings.ranges,
            known: Vec::new(),
            states: RefCell::new(None),
            out: Vec::new(),
        }
    }

    /// The time that is left.
    fn left(&self) -> Option<Duration> {
        let until = self.budget.until?;
        Some(until.saturating_duration_since(Instant::now()))
    }

    /// Begins with a property.
    fn begin(&mut self) -> Instant {
        let now = Instant::now();
        let own = self.settings.each.map(|each| now + each);
        self.budget.until = self.until.into_iter().chain(own).min();
        now
    }

    fn entry(&self, id: String, text: &str) -> Judged {
        Judged {
            id,
            text: text.to_owned(),
            verdict: Verdict::Inconclusive,
            length: None,
            engine: None,
            proof: None,
            shown: None,
            trace: None,
            reason: None,
            seconds: 0.0,
        }
    }

    /// `of_both` judges a property about two runs.
    fn prove(
        &mut self,
        asked: Result<Asked, Unsupported>,
        of_both: &dyn Fn(&Property, &Settings) -> Option<Judged>,
    ) {
        let asked = match asked {
            Ok(asked) => asked,
            Err(why) => return self.unsupported(&why.0),
        };
        let bdd = self.settings.choice == Choice::Bdd;
        // Of all configurations at once there are too many.
        let sets = bdd || self.leave_to_explorer;
        if bdd {
            self.begin();
            self.begin_states(&asked);
        }
        let mut left = Vec::new();
        // What may take long comes last, so that a limit leaves less open.
        let mut order: Vec<usize> = (0..asked.questions.len()).collect();
        order.sort_by_key(|k| match asked.questions[*k] {
            Question::Twice => 2,
            Question::Never { duty: Some(_), .. } | Question::Way { .. } | Question::Forever(_) => {
                1
            }
            _ => 0,
        });
        let mut told = BTreeMap::new();
        for k in order {
            let (property, question) = (&self.bound.system.properties[k], &asked.questions[k]);
            let begin = self.begin();
            let mut entry = self.entry(label(property), &property.text);
            match question {
                Question::Twice => {
                    let settings = Settings {
                        time: self.left(),
                        ..self.settings.clone()
                    };
                    match of_both(property, &settings) {
                        Some(both) if matches!(both.verdict, Verdict::Holds | Verdict::Vacuous) => {
                            (entry.verdict, entry.engine) = (both.verdict, both.engine);
                            (entry.length, entry.proof) = (both.length, both.proof);
                            entry.shown = both.shown;
                        }
                        // There may be more pairs of runs than it is about: one that breaks it shows nothing.
                        other => {
                            let why = other.and_then(|both| both.reason);
                            entry.reason =
                                Some(why.unwrap_or("independence is about two runs".to_owned()));
                            left.push(k);
                        }
                    }
                }
                Question::Way { goal, using, end } => {
                    let decided = (!bdd && self.ways(&asked, &mut entry, (*goal, *using, *end)))
                        || (sets && self.recovers(&asked, &mut entry, (*using, *end)));
                    if !decided {
                        left.push(k);
                    }
                }
                Question::Forever(response) => {
                    let decided = (!bdd && self.forever(&asked, &mut entry, response))
                        || (sets && self.comes(&asked, &mut entry, response));
                    if !decided {
                        left.push(k);
                    }
                }
                Question::None(why) => {
                    entry.reason = Some((*why).to_owned());
                    left.push(k);
                }
                Question::Seen(goal) => self.seen(&asked, &mut entry, *goal),
                Question::Never {
                    broken,
                    duty,
                    first,
                    stated,
                } => {
                    let broken = (*broken, duty.as_ref());
                    self.never(&asked, &mut entry, broken, *first, stated);
                }
            }
            // A set of states has no certificate.
            entry.shown = entry.shown.filter(|_| entry.engine != Some(Engine::Bdd));
            entry.seconds = begin.elapsed().as_secs_f64();
            told.insert(k, entry);
        }
        left.sort_unstable();
        self.out.extend(told.into_values());
        if self.ranges && asked.translated.fault != Lit::FALSE {
            let begin = self.begin();
            let mut entry = self.range();
            self.never(
                &asked,
                &mut entry,
                (asked.translated.fault, None),
                None,
                &[],
            );
            entry.seconds = begin.elapsed().as_secs_f64();
            self.out.push(entry);
        }
        if bdd && self.ranges {
            let begin = self.begin();
            let mut entry = self.entry("states".to_owned(), "the reachable states are known");
            self.count_states(&mut entry);
            entry.seconds = begin.elapsed().as_secs_f64();
            self.out.push(entry);
        }
        self.budget.until = self.until;
        if self.leave_to_explorer && !left.is_empty() {
            self.explore(&left, false);
        }
    }

    /// A system that is no netlist.
    fn unsupported(&mut self, why: &str) {
        let all: Vec<usize> = (0..self.bound.system.properties.len()).collect();
        if self.leave_to_explorer {
            return self.explore(&all, true);
        }
        for property in &self.bound.system.properties {
            let mut entry = self.entry(label(property), &property.text);
            entry.reason = Some(why.to_owned());
            self.out.push(entry);
        }
        if self.ranges {
            let mut entry = self.range();
            entry.reason = Some(why.to_owned());
            self.out.push(entry);
        }
    }

    fn range(&self) -> Judged {
        self.entry(
            "range".to_owned(),
            "no assignment leaves the range of its variable",
        )
    }

    fn decide(&self, asked: &Asked, target: Lit) -> Decision {
        self.ask(&asked.translated.netlist, target)
    }

    fn ask(&self, netlist: &Netlist, target: Lit) -> Decision {
        let (choice, depth) = (self.settings.choice, Depth(self.settings.depth));
        if choice == Choice::Bdd {
            return self.reached(netlist, target);
        }
        decide(netlist, target, choice, depth, &self.budget)
    }

    /// The same with help, where it is about a duty; also what was known beforehand.
    fn decide_duty(
        &self,
        asked: &Asked,
        target: Lit,
        duty: Option<&Duty>,
    ) -> (Decision, Vec<Clause>) {
        let known = duty.map(Duty::keeps).into_iter();
        let known: Vec<Clause> = known.chain(self.known.iter().cloned()).collect();
        let help = match (duty, self.settings.choice) {
            (Some(duty), Choice::Auto | Choice::Pdr | Choice::Induction) => {
                helped(asked, duty, &self.budget)
            }
            _ => Ok(None),
        };
        match help {
            Ok(Some(help)) => (
                self.ask(&help.netlist, target),
                [known, help.sentences].concat(),
            ),
            Ok(None) => (self.decide(asked, target), known),
            Err(Spent) => (Decision::Open(LIMITED.to_owned()), known),
        }
    }

    fn engine(&self, proof: &Proof) -> Engine {
        match (proof, self.settings.choice) {
            (Proof::Induction(..), _) | (Proof::Nothing, Choice::Induction) => Engine::Induction,
            (Proof::Nothing, Choice::Bmc) => Engine::Bmc,
            (_, Choice::Bdd) => Engine::Bdd,
            _ => Engine::Pdr,
        }
    }

    /// A run was found: by which engine, its length, the run itself.
    fn found(&self, asked: &Asked, entry: &mut Judged, run: &Run) {
        entry.engine = Some(match self.settings.choice {
            Choice::Induction => Engine::Induction,
            Choice::Bdd => Engine::Bdd,
            // The shortest run is always one that bounded model checking has looked for.
            _ => Engine::Bmc,
        });
        entry.length = Some(run.cycles.len() as u64);
        let trace = asked.trace(run);
        entry.reason = asked.configuration(&trace);
        entry.trace = Some(trace);
    }

    fn seen(&self, asked: &Asked, entry: &mut Judged, goal: Lit) {
        match self.decide(asked, goal) {
            Decision::Seen(run) => {
                entry.verdict = Verdict::Reached;
                self.found(asked, entry, &run);
            }
            Decision::Never(proof) => {
                entry.verdict = Verdict::Unreachable;
                entry.engine = Some(self.engine(&proof));
                entry.shown = Some(asked.shown(&asked.translated.netlist, &proof, Vec::new()));
                entry.proof = Some(proof);
            }
            Decision::Open(why) => entry.reason = Some(why),
        }
    }

    /// What is never broken holds if it is put to the test at all.
    fn first(&self, asked: &Asked, entry: &mut Judged, first: Lit) {
        match self.decide(asked, first) {
            Decision::Seen(run) => {
                entry.verdict = Verdict::Holds;
                entry.length = Some(run.cycles.len() as u64);
                entry.trace = Some(asked.trace(&run));
            }
            Decision::Never(proof) => {
                entry.verdict = Verdict::Vacuous;
                entry.engine = Some(self.engine(&proof));
                let netlist = &asked.translated.netlist;
                entry.shown = Some(asked.shown(netlist, &proof, self.known.clone()));
                entry.proof = Some(proof);
            }
            Decision::Open(why) => {
                entry.reason = Some(format!("it is not broken, but may say nothing: {why}"));
            }
        }
    }

    fn never(
        &self,
        asked: &Asked,
        entry: &mut Judged,
        (broken, duty): (Lit, Option<&Duty>),
        first: Option<Lit>,
        stated: &[Stated],
    ) {
        let (decision, known) = self.decide_duty(asked, broken, duty);
        let proof = match decision {
            Decision::Seen(run) => {
                entry.verdict = Verdict::Violated;
                return self.found(asked, entry, &run);
            }
            Decision::Open(why) => {
                entry.reason = Some(why);
                return;
            }
            Decision::Never(proof) => proof,
        };
        entry.engine = Some(self.engine(&proof));
        entry.shown = Some(asked.shown(&asked.translated.netlist, &proof, known));
        entry.proof = Some(proof);
        match first {
            Some(first) => self.first(asked, entry, first),
            None => entry.verdict = Verdict::Holds,
        }
        if entry.verdict != Verdict::Holds {
            return;
        }
        for fact in stated {
            let right = match self.decide_duty(asked, fact.what, fact.duty.as_ref()).0 {
                Decision::Seen(_) => fact.seen,
                Decision::Never(_) => !fact.seen,
                Decision::Open(why) => {
                    entry.verdict = Verdict::Inconclusive;
                    entry.reason = Some(format!("what is recorded of its bound is open: {why}"));
                    return;
                }
            };
            if !right {
                entry.verdict = Verdict::Violated;
                entry.length = None;
                entry.trace = None;
                entry.reason = Some(fact.otherwise.clone());
                return;
            }
        }
    }
}
