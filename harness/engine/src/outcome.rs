//! What exploring a table gives, and what was asked for.

use std::collections::BTreeMap;
use std::str::FromStr;

use stillpoint_lang::ir;
use stillpoint_model::{Judgement, Report, Trace, Verdict};

/// Which evaluator ran the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Evaluator {
    /// Rust generated at build time.
    Generated,
    /// The interpreter.
    Interpreter,
}

/// What exploring one table gave.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The explorer's report; its `properties` follow `bound.system.properties`, the `independent` ones included.
    pub report: Report,
    /// Who ran it.
    pub evaluator: Evaluator,
    /// The exploration of pairs of runs for each `independent` property, by property number.
    pub pairs: BTreeMap<usize, Pair>,
    /// By property number: how the report differs from what the property records; its verdict is `Violated` then.
    pub refuted: BTreeMap<usize, String>,
    /// How the exploration was reduced, if that was wanted.
    pub reduction: Option<Reduction>,
}

impl Outcome {
    /// What is known of a system that nobody has explored: nothing yet.
    pub fn nothing(system: &ir::System) -> Self {
        Outcome {
            report: Report {
                coverage: vec![0; system.rule_count()],
                ..Report::nothing()
            },
            evaluator: Evaluator::Generated,
            pairs: BTreeMap::new(),
            refuted: BTreeMap::new(),
            reduction: None,
        }
    }
}

/// The exploration of pairs of runs for one property.
#[derive(Debug, Clone)]
pub struct Pair {
    /// Pairs of states.
    pub states: u64,
    /// The second run of a counterexample; the judgement has the first.
    pub second: Option<Trace>,
}

/// Which reductions to use.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Reductions {
    /// Judge properties on slices of the system.
    pub slice: bool,
    /// Explore one state of each orbit under exchanges of identical instances.
    pub symmetry: bool,
    /// Store the values of a timer that merely counts down as intervals: the same exploration in less memory.
    pub timers: bool,
}

impl Reductions {
    /// All of them.
    pub const ALL: Reductions = Reductions {
        slice: true,
        symmetry: true,
        timers: true,
    };

    /// Whether less is explored, so that some of a report cannot be told.
    pub fn less(self) -> bool {
        self.slice || self.symmetry
    }
}

impl FromStr for Reductions {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut out = Reductions::default();
        for word in text.split(',').map(str::trim) {
            match word {
                "slice" => out.slice = true,
                "symmetry" => out.symmetry = true,
                "timers" => out.timers = true,
                "all" => out = Reductions::ALL,
                "none" if text.trim() == "none" => {}
                "none" => return Err("`none` stands alone".to_owned()),
                other => {
                    return Err(format!(
                        "there is no reduction `{other}`; write slice, symmetry, timers (several with commas), all or none"
                    ));
                }
            }
        }
        Ok(out)
    }
}

/// One exploration that took the place of the whole one.
#[derive(Debug, Clone)]
pub struct Explored {
    /// Labels of the properties judged in it.
    pub properties: Vec<String>,
    /// Whether it shows that no assignment leaves its range.
    pub faults: bool,
    /// State variables in it.
    pub variables: usize,
    /// Inputs in it.
    pub inputs: usize,
    /// Permutations under which states count as one; 1 where states were explored singly.
    pub permutations: usize,
    /// Whether all of it was explored.
    pub complete: bool,
    /// States found (orbits, where permutations were used).
    pub states: u64,
    /// Who ran it.
    pub evaluator: Evaluator,
    /// Wall time.
    pub seconds: f64,
}

/// How an exploration was reduced.
#[derive(Debug, Clone)]
pub struct Reduction {
    /// What was asked for.
    pub wanted: Reductions,
    /// The explorations made; empty if the whole system was explored.
    pub parts: Vec<Explored>,
    /// Properties that have the verdict of another one, whose image under an exchange of instances they are: (label, other).
    pub images: Vec<(String, String)>,
    /// Why the whole system was explored all the same.
    pub whole: Option<String>,
}

/// The judgement on a property that nothing is known about.
pub(crate) fn undecided(property: &ir::Property) -> Judgement {
    Judgement {
        id: label(property),
        verdict: Verdict::Inconclusive,
        length: None,
        bound: None,
        fastest: None,
        trace: None,
    }
}

/// Id of a property with the index of its copy.
pub fn label(property: &ir::Property) -> String {
    property
        .index
        .map_or(property.id.clone(), |i| format!("{}[{i}]", property.id))
}

/// A verdict as it stands in JSON.
pub fn verdict_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Holds => "holds",
        Verdict::Violated => "violated",
        Verdict::Vacuous => "vacuous",
        Verdict::Reached => "reached",
        Verdict::Unreachable => "unreachable",
        Verdict::Inconclusive => "inconclusive",
    }
}
