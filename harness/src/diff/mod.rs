//! `diff`: checks the production monitors against the tables, exhaustively or with random runs.

pub mod peer;
pub mod product;
pub mod random;

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde_json::{Value, json};
use stillpoint_model::{Error, Form, Options, Progress, Property, Verdict, explore};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_spec::Spec;
use stillpoint_spec::bind::Bound;

use crate::report::{grouped, params};
use crate::subject::Subject;
use crate::timing::Diagram;
use product::Product;
use random::Random;

/// A machine of the specification on its own under the parameters of one or more runs.
#[derive(Debug, Clone)]
pub struct Pairing {
    /// Machine.
    pub machine: String,
    /// The axes these parameters stand for.
    pub axes: Vec<String>,
    /// The machine with every input free.
    pub bound: Bound,
}

/// The result for one pairing.
#[derive(Debug)]
pub struct Compared {
    /// Machine.
    pub machine: String,
    /// The axes these parameters stand for.
    pub axes: Vec<String>,
    /// Parameters.
    pub params: Vec<(String, String)>,
    /// Reachable pairs of states; 0 for random runs.
    pub pairs: u64,
    /// Cycles in which both sides were compared.
    pub cycles: u128,
    /// Outputs compared.
    pub outputs: u128,
    /// Whether everything was explored; for random runs: whether all cycles were made.
    pub complete: bool,
    /// Where the sides part.
    pub divergence: Option<Diagram>,
}

/// Why a comparison could not be made.
#[derive(Debug, thiserror::Error)]
pub enum DiffError {
    /// The input is wrong.
    #[error(transparent)]
    Input(#[from] stillpoint_spec::diag::Diagnostics),
    /// The two sides do not fit each other.
    #[error("{0}")]
    Sides(String),
    /// The product cannot be explored.
    #[error("{0}: {1}")]
    Explore(String, Error),
}

/// Every machine with a monitor that the subject's runs use, once for each set of parameters.
///
/// # Errors
/// A specification that does not load.
pub fn pairings(subject: &Subject) -> Result<Vec<Pairing>, DiffError> {
    let mut out: Vec<Pairing> = Vec::new();
    let mut specs: BTreeMap<PathBuf, Spec> = BTreeMap::new();
    for (k, task) in subject.tasks.iter().enumerate() {
        let file = match &subject.machine {
            Some(machine) => machine.runs[k].file.clone(),
            None => subject.path.clone(),
        };
        if !specs.contains_key(&file) {
            specs.insert(file.clone(), Spec::load(&file)?);
        }
        let spec = &specs[&file];
        for name in peer::MACHINES {
            if !task
                .bound
                .system
                .instances
                .iter()
                .any(|i| i.machine == name)
            {
                continue;
            }
            let system = spec.open_machine(name)?;
            let mut given: BTreeMap<String, Vec<i64>> = BTreeMap::new();
            for param in system.params.iter().filter(|p| p.reading.is_none()) {
                let same = task
                    .bound
                    .system
                    .params
                    .iter()
                    .position(|p| p.var.name == param.var.name);
                if let Some(k) = same {
                    given.insert(
                        param.var.name.clone(),
                        vec![i64::from(task.bound.values[k])],
                    );
                }
            }
            let bound = Bound::new(system, &given, &BTreeMap::new())
                .map_err(|e| DiffError::Sides(format!("{name}: {e}")))?;
            let known = out
                .iter_mut()
                .find(|p| p.machine == name && p.bound.values == bound.values);
            match known {
                Some(pairing) => {
                    for axis in &task.axes {
                        if !pairing.axes.contains(axis) {
                            pairing.axes.push(axis.clone());
                        }
                    }
                }
                None => out.push(Pairing {
                    machine: name.to_owned(),
                    axes: task.axes.clone(),
                    bound,
                }),
            }
        }
    }
    Ok(out)
}

fn monitor(pairing: &Pairing, mutant: Option<Mutant>) -> Result<Box<dyn peer::Peer>, DiffError> {
    peer::peer(&pairing.machine, &pairing.bound, mutant)
        .map_err(DiffError::Sides)?
        .ok_or_else(|| DiffError::Sides(format!("machine `{}` has no monitor", pairing.machine)))
}

/// Explores the product of table and monitor: every reachable pair, every input of the interface.
///
/// # Errors
/// Sides that do not fit each other.
pub fn exhaustive(
    pairing: &Pairing,
    mutant: Option<Mutant>,
    options: &Options,
    progress: &mut dyn Progress,
) -> Result<Compared, DiffError> {
    let peer = monitor(pairing, mutant)?;
    let product = Product::new(&pairing.bound, peer.as_ref()).map_err(DiffError::Sides)?;
    let claim = [Property {
        id: pairing.machine.clone(),
        form: Form::Always {
            when: None,
            then: Product::AGREE,
        },
    }];
    // Once the sides have parted they wander through pairs that mean nothing.
    let options = Options {
        stop_when_decided: true,
        witnesses: false,
        ..options.clone()
    };
    let report = explore(&product, &claim, &options, progress)
        .map_err(|e| DiffError::Explore(pairing.machine.clone(), e))?;
    let judged = &report.properties[0];
    let divergence = match (
        &judged.trace,
        report.faults.first().and_then(|f| f.trace.as_ref()),
    ) {
        (Some(trace), _) if judged.verdict == Verdict::Violated => Some(trace),
        (_, fault) => fault,
    }
    .map(|trace| {
        let (start, cycles) = product.inputs_of(trace);
        product.diagram(&start, &cycles)
    });
    Ok(Compared {
        machine: pairing.machine.clone(),
        axes: pairing.axes.clone(),
        params: params(&pairing.bound),
        pairs: report.states,
        cycles: report.transitions,
        outputs: report.transitions * product.outputs() as u128,
        complete: report.complete,
        divergence,
    })
}

/// Random runs of `cycles` cycles in all, at full width: besides the parameters of the machine file also random ones.
///
/// # Errors
/// Sides that do not fit each other.
pub fn sample(
    pairing: &Pairing,
    mutant: Option<Mutant>,
    cycles: u64,
    random: &mut Random,
) -> Result<Compared, DiffError> {
    let mut out = Compared {
        machine: pairing.machine.clone(),
        axes: pairing.axes.clone(),
        params: params(&pairing.bound),
        pairs: 0,
        cycles: 0,
        outputs: 0,
        complete: true,
        divergence: None,
    };
    let mut left = cycles;
    while left > 0 && out.divergence.is_none() {
        // Every second batch runs with other parameters.
        let varied = if random.below(2) == 0 {
            None
        } else {
            vary(pairing, random)
        };
        let pairing = varied.as_ref().unwrap_or(pairing);
        let peer = monitor(pairing, mutant)?;
        let product = Product::new(&pairing.bound, peer.as_ref()).map_err(DiffError::Sides)?;
        for _ in 0..64 {
            let length = left.min(random::RUN);
            if length == 0 {
                break;
            }
            let found = random::run(&product, pairing.bound.inputs.len(), random, length);
            left -= length;
            out.cycles += u128::from(length);
            out.outputs += u128::from(length) * product.outputs() as u128;
            if let Some(found) = found {
                out.divergence = Some(product.diagram(&found.start, &found.cycles));
                out.params = params(&pairing.bound);
                break;
            }
        }
    }
    Ok(out)
}

/// The same machine with random parameters: small times so that they expire within a run, else any value of the range.
fn vary(pairing: &Pairing, random: &mut Random) -> Option<Pairing> {
    let system = &pairing.bound.system;
    let mut given: BTreeMap<String, Vec<i64>> = BTreeMap::new();
    for param in system.params.iter().filter(|p| p.reading.is_none()) {
        let lo = pairing.bound.constant(&param.var.lo);
        let hi = pairing.bound.constant(&param.var.hi);
        let small = param.var.name.starts_with("t_") && random.below(8) > 0;
        let hi = if small { hi.min(lo + 12) } else { hi };
        let value = match random.below(4) {
            0 => lo,
            1 if !small => hi,
            _ => lo + random.below((hi - lo + 1) as usize) as i64,
        };
        given.insert(param.var.name.clone(), vec![value]);
    }
    let bound = Bound::new(system.clone(), &given, &BTreeMap::new()).ok()?;
    // What the monitor refuses at construction needs no comparison.
    peer::peer(&pairing.machine, &bound, None).ok()?;
    Some(Pairing {
        machine: pairing.machine.clone(),
        axes: pairing.axes.clone(),
        bound,
    })
}

/// The report for readers.
pub fn text(compared: &[Compared], what: &str) -> String {
    let mut out = String::new();
    let divergences = compared.iter().filter(|c| c.divergence.is_some()).count();
    let sum = |f: &dyn Fn(&Compared) -> u128| grouped(compared.iter().map(f).sum());
    out.push_str(&match divergences {
        0 if compared.iter().all(|c| c.complete) => format!("NO DIVERGENCE ({what})\n"),
        0 => format!("INCONCLUSIVE: a limit was reached first ({what})\n"),
        n => format!("{n} DIVERGENCES ({what})\n"),
    });
    out.push_str(&format!(
        "{} pairs of states, {} cycles, {} outputs compared\n\n",
        sum(&|c| u128::from(c.pairs)),
        sum(&|c| c.cycles),
        sum(&|c| c.outputs),
    ));
    for c in compared {
        let params: Vec<String> = c.params.iter().map(|(n, v)| format!("{n} = {v}")).collect();
        let axes = if c.axes.is_empty() {
            String::new()
        } else {
            format!(" of {}", c.axes.join(", "))
        };
        out.push_str(&format!("{}{axes}: {}\n", c.machine, params.join(", ")));
        out.push_str(&format!(
            "  {} pairs, {} cycles, {} outputs{}\n",
            grouped(u128::from(c.pairs)),
            grouped(c.cycles),
            grouped(c.outputs),
            if c.complete { "" } else { ", not complete" },
        ));
        if let Some(diagram) = &c.divergence {
            let run = if c.pairs > 0 {
                "shortest run"
            } else {
                "run, shrunk"
            };
            out.push_str(&format!("  DIVERGENCE, {run}:\n"));
            out.push_str(&diagram.text());
        }
    }
    out
}

/// The report as JSON.
pub fn to_json(compared: &[Compared], seed: Option<u64>) -> Value {
    let number = |n: u128| u64::try_from(n).unwrap_or(u64::MAX);
    json!({
        "pairs": compared.iter().map(|c| c.pairs).sum::<u64>(),
        "cycles": number(compared.iter().map(|c| c.cycles).sum()),
        "outputs_compared": number(compared.iter().map(|c| c.outputs).sum()),
        "divergences": compared.iter().filter(|c| c.divergence.is_some()).count(),
        "complete": compared.iter().all(|c| c.complete),
        "seed": seed,
        "machines": compared.iter().map(|c| json!({
            "machine": c.machine, "axes": c.axes,
            "parameters": c.params.iter().cloned().collect::<BTreeMap<_, _>>(),
            "pairs": c.pairs, "cycles": number(c.cycles), "outputs_compared": number(c.outputs),
            "complete": c.complete, "diagram": c.divergence.as_ref().map(Diagram::text),
        })).collect::<Vec<_>>(),
    })
}
