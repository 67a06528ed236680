//! "Does not depend on": pairs of runs that differ in some inputs only.
//!
//! Both runs are one system ([`stillpoint_lang::twice`]) where that makes their cycles cheap: its instances are stages. Of that system
//! there may be more runs than the claim is about; what it breaks is looked for again among the pairs themselves
//! ([`stillpoint_model::Twin`]).

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir;
use stillpoint_lang::twice::{Twice, twice};
use stillpoint_model::{
    Cluster, Error, Form, Options, Property, Report, System, Trace, Twin, Verdict, Way, explore,
};

use crate::explore::search;
use crate::keep::beside;
use crate::outcome::{Pair, label};
use crate::table::{Interpreted, properties};

/// With fewer combinations of inputs the cycles of both runs are made one by one, by generated code.
const MANY: u128 = 1 << 10;

/// A property about pairs of runs.
pub struct Claim<'a> {
    /// The system of each run.
    pub bound: &'a Bound,
    /// The property, of the form [`ir::Form::Independent`]; there are no pairs for another one.
    pub property: &'a ir::Property,
    /// How to explore.
    pub options: &'a Options,
}

impl Claim<'_> {
    /// Explores all such pairs of runs of `system`; a counterexample's first run stays in the judgement.
    pub(crate) fn explore<S: System>(
        &self,
        system: &S,
        cluster: Option<&Cluster>,
    ) -> Result<(Report, Pair), Error> {
        // What processes share, and what is kept for later, belongs to the pairs themselves.
        let alone = cluster.is_none() && self.options.checkpoint.is_none();
        let alone = alone && self.options.way != Way::Single;
        let both = twice(self.bound, self.property);
        if let Some(both) = both.filter(|both| alone && both.bound.combinations() >= MANY) {
            let found = self.explore_twice(&both)?;
            let mut judged = found.0.properties.iter();
            if judged.all(|judgement| judgement.verdict != Verdict::Violated) {
                return Ok(found);
            }
        }
        self.explore_pairs(system, cluster)
    }

    /// Explores both runs as one system. What holds holds of all pairs; what is broken need not be.
    ///
    /// # Errors
    /// A system that cannot be explored at all.
    pub fn explore_twice(&self, both: &Twice) -> Result<(Report, Pair), Error> {
        let listed = properties(&both.bound).into_iter();
        let listed: Vec<Property> = listed.map(|(_, property)| property).collect();
        let system = Interpreted::new(&both.bound);
        let report = explore(&system, &listed, self.options, &mut ())?;
        Ok(parted(report, |trace| self.runs(both, trace)))
    }

    /// The two runs of one of both.
    fn runs(&self, both: &Twice, trace: &Trace) -> [Trace; 2] {
        let inputs = both.inputs as u32;
        let step = |step: &Vec<(u32, u32)>, second: bool| {
            let own = step.iter().copied().filter(|(k, _)| *k < inputs);
            let mut own: Vec<(u32, u32)> = own.collect();
            for (k, value) in step.iter().filter(|(k, _)| second && *k >= inputs) {
                let input = both.differ[(*k - inputs) as usize] as u32;
                own.retain(|(k, _)| *k != input);
                own.push((input, *value));
            }
            own
        };
        [false, true].map(|second| Trace {
            steps: trace.steps.iter().map(|s| step(s, second)).collect(),
            ..trace.clone()
        })
    }

    /// Explores the pairs themselves.
    ///
    /// # Errors
    /// A system that cannot be explored at all; a process that is gone.
    pub fn explore_pairs<S: System>(
        &self,
        system: &S,
        cluster: Option<&Cluster>,
    ) -> Result<(Report, Pair), Error> {
        let (mut inputs, mut observed, mut during) = (Vec::new(), Vec::new(), None);
        if let ir::Form::Independent {
            observe,
            of,
            condition,
        } = &self.property.form
        {
            let size = |k: &usize| {
                let (lo, hi) = self.bound.inputs[*k];
                let size = u32::try_from(i64::from(hi) - i64::from(lo) + 1);
                (*k as u32, size.unwrap_or(u32::MAX))
            };
            inputs = of.iter().map(size).collect();
            (observed, during) = (observe.clone(), *condition);
        }
        let twin = Twin::new(system, inputs, during, observed);
        let id = label(self.property);
        let kept = self.options.checkpoint.as_ref();
        let options = Options {
            checkpoint: kept.map(|c| beside(c, &id)),
            ..self.options.clone()
        };
        let form = Form::Always {
            when: Some(Twin::<S>::BOTH),
            then: Twin::<S>::AGREE,
        };
        let report = search(&twin, &[Property { id, form }], &options, &mut (), cluster)?;
        Ok(parted(report, |trace| twin.split(trace)))
    }
}

/// A report whose run is the first one of a pair, and the second one beside it.
fn parted(mut report: Report, runs: impl Fn(&Trace) -> [Trace; 2]) -> (Report, Pair) {
    let mut pair = Pair {
        states: report.states,
        second: None,
    };
    for judgement in &mut report.properties {
        if let Some(trace) = judgement.trace.take() {
            let [first, second] = runs(&trace);
            pair.second = Some(second);
            judgement.trace = Some(first);
        }
    }
    (report, pair)
}
