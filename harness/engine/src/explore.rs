//! Explores a table: generated step function where there is one, else the interpreter; two runs for `independent`.

use std::collections::BTreeMap;
use std::time::Instant;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir;
use stillpoint_model::{
    Cluster, Error, Judgement, Limits, Options, Progress, Property, Report, System, explore,
    explore_together,
};

use crate::outcome::{Evaluator, Outcome, Pair, undecided};
use crate::pairs::Claim;
use crate::stated;
use crate::table::{Generated, Interpreted, properties};

/// Explores `bound` and judges all its properties; `interpret` forces the interpreter.
///
/// # Errors
/// A system that cannot be explored at all.
pub fn run(
    bound: &Bound,
    options: &Options,
    interpret: bool,
    progress: &mut dyn Progress,
) -> Result<Outcome, Error> {
    run_together(bound, options, interpret, progress, None)
}

/// Like [`run`], together with the other processes of a cluster; only process 0 gets an outcome that says something.
///
/// # Errors
/// A system that cannot be explored at all; a process that is gone.
pub fn run_together(
    bound: &Bound,
    options: &Options,
    interpret: bool,
    progress: &mut dyn Progress,
    cluster: Option<&Cluster>,
) -> Result<Outcome, Error> {
    let generated = if interpret {
        None
    } else {
        Generated::find(bound)
    };
    let (mut found, evaluator) = match generated {
        Some(system) => (
            judge(&system, &system, bound, options, progress, cluster)?,
            Evaluator::Generated,
        ),
        None => {
            let system = Interpreted::new(bound);
            (
                judge(&system, &system, bound, options, progress, cluster)?,
                Evaluator::Interpreter,
            )
        }
    };
    let refuted = stated::judge(bound, &mut found.report.properties);
    Ok(Outcome {
        report: found.report,
        evaluator,
        pairs: found.pairs,
        refuted,
        reduction: None,
    })
}

/// A report on all properties of a table, before it is compared with what they record.
pub(crate) struct Judged {
    pub(crate) report: Report,
    pub(crate) pairs: BTreeMap<usize, Pair>,
}

/// Explores the table `bound` as `system`, and pairs of runs of it as `paired`.
pub(crate) fn judge<S: System, P: System>(
    system: &S,
    paired: &P,
    bound: &Bound,
    options: &Options,
    progress: &mut dyn Progress,
    cluster: Option<&Cluster>,
) -> Result<Judged, Error> {
    let start = Instant::now();
    let listed = properties(bound);
    let single: Vec<Property> = listed.iter().map(|(_, p)| p.clone()).collect();
    let mut report = search(system, &single, options, progress, cluster)?;
    let mut judged: Vec<Option<Judgement>> = vec![None; bound.system.properties.len()];
    for ((k, _), judgement) in listed.iter().zip(std::mem::take(&mut report.properties)) {
        judged[*k] = Some(judgement);
    }
    let mut pairs = BTreeMap::new();
    for (k, property) in bound.system.properties.iter().enumerate() {
        if !matches!(property.form, ir::Form::Independent { .. }) {
            continue;
        }
        // One time limit for all of them.
        let limits = Limits {
            time: options
                .limits
                .time
                .map(|t| t.saturating_sub(start.elapsed())),
            ..options.limits
        };
        let options = &Options {
            limits,
            ..options.clone()
        };
        let claim = Claim {
            bound,
            property,
            options,
        };
        let (outcome, pair) = claim.explore(paired, cluster)?;
        report.complete &= outcome.complete;
        report.resumable &= outcome.resumable;
        report.seconds += outcome.seconds;
        judged[k] = outcome.properties.into_iter().next();
        pairs.insert(k, pair);
    }
    report.properties = judged
        .into_iter()
        .zip(&bound.system.properties)
        .map(|(j, p)| j.unwrap_or_else(|| undecided(p)))
        .collect();
    Ok(Judged { report, pairs })
}

/// Explores alone, or together with others.
pub(crate) fn search<S: System>(
    system: &S,
    properties: &[Property],
    options: &Options,
    progress: &mut dyn Progress,
    cluster: Option<&Cluster>,
) -> Result<Report, Error> {
    match cluster {
        None => explore(system, properties, options, progress),
        Some(cluster) => explore_together(system, properties, options, progress, cluster),
    }
}
