//! `diff`, the differential check, a refinement check by product construction: checks the production monitors against the tables, exhaustively, with random runs, or both against a recording.

pub mod bytes;
pub mod compact;
pub mod pairing;
pub mod peer;
pub mod product;
pub mod random;
pub mod slices;

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use serde_json::{Value, json};
use stillpoint_model::{Error, Form, Options, Progress, Property, Until, Verdict, explore};
use stillpoint_show::diagram::Diagram;

use crate::report::{grouped, params};
use compact::Compact;
pub use pairing::{Pairing, pairings};
use product::Product;
use random::{Driver, Random};
use stillpoint_monitors::mutant::Mutant;

/// The result for one pairing.
#[derive(Debug)]
pub struct Compared {
    /// Machine.
    pub machine: String,
    /// The axes these parameters stand for.
    pub axes: Vec<String>,
    /// Parameters.
    pub params: Vec<(String, String)>,
    /// Inputs that kept one value.
    pub held: Vec<(String, i32)>,
    /// Inputs that had some of their values.
    pub narrowed: Vec<String>,
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
    Input(#[from] stillpoint_lang::diag::Diagnostics),
    /// The two sides do not fit each other.
    #[error("{0}")]
    Sides(String),
    /// The product cannot be explored.
    #[error("{0}: {1}")]
    Explore(String, Error),
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
    let mut product = Product::new(&pairing.bound, peer.as_ref()).map_err(DiffError::Sides)?;
    let narrowed = product.narrow();
    for (input, value) in &pairing.held {
        product.hold(input, *value).map_err(DiffError::Sides)?;
    }
    let claim = [Property {
        id: pairing.machine.clone(),
        form: Form::Always {
            when: None,
            then: Product::AGREE,
        },
    }];
    // Once the sides have parted they wander through pairs that mean nothing.
    let options = Options {
        until: Until::Decided,
        witnesses: false,
        ..options.clone()
    };
    let report = match Compact::needed(&product) {
        Some(compact) => explore(&compact, &claim, &options, progress),
        None => explore(&product, &claim, &options, progress),
    };
    let report = report.map_err(|e| DiffError::Explore(pairing.machine.clone(), e))?;
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
        held: pairing.held.clone(),
        narrowed,
        pairs: report.states,
        cycles: report.transitions,
        outputs: report.transitions * product.outputs() as u128,
        complete: report.complete,
        divergence,
    })
}

/// Runs of one batch: with one set of parameters.
const BATCH: u64 = 16;

/// Random runs of about `cycles` cycles in all, at full width: besides the parameters of the machine file also random ones.
/// The pairings share the cycles; `threads` (0 for all processors) share the work. The result depends on the seed alone.
/// `progress` is told, from any thread, how many cycles of how many are done.
///
/// # Errors
/// Sides that do not fit each other.
pub fn sample(
    pairings: &[Pairing],
    mutant: Option<Mutant>,
    cycles: u64,
    seed: u64,
    threads: usize,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<Vec<Compared>, DiffError> {
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        given => given,
    };
    let share = cycles.div_ceil(pairings.len().max(1) as u64);
    let batches = share.div_ceil(BATCH * random::RUN);
    let jobs: Vec<(usize, u64)> = (0..pairings.len())
        .flat_map(|k| (0..batches).map(move |n| (k, n)))
        .collect();
    // The first batch of each pairing that found something: later ones need not run, and do not count.
    let found: Vec<AtomicU64> = pairings.iter().map(|_| AtomicU64::new(u64::MAX)).collect();
    let next = AtomicUsize::new(0);
    let made = AtomicU64::new(0);
    let worker = || -> Result<Vec<Batch>, DiffError> {
        let mut done = Vec::new();
        while let Some(&(pairing, number)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            if found[pairing].load(Ordering::Relaxed) < number {
                continue;
            }
            let left = share - number * BATCH * random::RUN;
            let mut random = Random::fork(seed, pairing as u64, number);
            let result = batch(&pairings[pairing], mutant, left, &mut random)?;
            if result.divergence.is_some() {
                found[pairing].fetch_min(number, Ordering::Relaxed);
            }
            let cycles = left.min(BATCH * random::RUN);
            let before = made.fetch_add(cycles, Ordering::Relaxed);
            progress(before + cycles, share * pairings.len() as u64);
            done.push((pairing, number, result));
        }
        Ok(done)
    };
    let mut results = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        let mut all = Vec::new();
        for handle in handles {
            let done = handle
                .join()
                .map_err(|_| DiffError::Sides("a worker thread has failed".to_owned()))?;
            all.extend(done?);
        }
        Ok::<_, DiffError>(all)
    })?;
    results.sort_by_key(|(pairing, number, _)| (*pairing, *number));
    let mut out: Vec<Compared> = pairings.iter().map(Compared::nothing).collect();
    for (pairing, number, result) in results {
        if number <= found[pairing].load(Ordering::Relaxed) {
            out[pairing].add(result);
        }
    }
    Ok(out)
}

/// A piece of the work: pairing, number, result.
type Batch = (usize, u64, Compared);

/// A batch of runs with one set of parameters, at most `left` cycles.
fn batch(
    pairing: &Pairing,
    mutant: Option<Mutant>,
    left: u64,
    random: &mut Random,
) -> Result<Compared, DiffError> {
    // Three of four batches run with other parameters.
    let varied = match random.below(4) {
        0 => None,
        _ => pairing::vary(pairing, random),
    };
    let pairing = varied.as_ref().unwrap_or(pairing);
    let peer = monitor(pairing, mutant)?;
    let product = Product::new(&pairing.bound, peer.as_ref()).map_err(DiffError::Sides)?;
    let family = crate::families::of_table(&pairing.bound.system.name);
    let calm = family.map_or(&[][..], |family| family.peers.calm);
    let mut driver = Driver::new(&product, calm);
    let mut out = Compared::nothing(pairing);
    for run in 0..BATCH {
        let length = left.saturating_sub(run * random::RUN).min(random::RUN);
        if length == 0 {
            break;
        }
        let found = driver.run(random, length);
        out.cycles += u128::from(length);
        out.outputs += u128::from(length) * product.outputs() as u128;
        if let Some(found) = found {
            out.divergence = Some(product.diagram(&found.start, &found.cycles));
            break;
        }
    }
    Ok(out)
}

impl Compared {
    fn nothing(pairing: &Pairing) -> Self {
        Compared {
            machine: pairing.machine.clone(),
            axes: pairing.axes.clone(),
            params: params(&pairing.bound),
            held: Vec::new(),
            narrowed: Vec::new(),
            pairs: 0,
            cycles: 0,
            outputs: 0,
            complete: true,
            divergence: None,
        }
    }

    /// Adds a batch; where it found something, its parameters are the ones to tell.
    fn add(&mut self, batch: Compared) {
        self.cycles += batch.cycles;
        self.outputs += batch.outputs;
        if batch.divergence.is_some() {
            self.params = batch.params;
            self.divergence = batch.divergence;
        }
    }
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
        if !c.held.is_empty() {
            let held: Vec<String> = c.held.iter().map(|(n, v)| format!("{n} = {v}")).collect();
            out.push_str(&format!("  inputs held: {}\n", held.join(", ")));
        }
        if !c.narrowed.is_empty() {
            let names = c.narrowed.join(", ");
            out.push_str(&format!(
                "  inputs of which some values were tried: {names}\n"
            ));
        }
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
            "held": c.held.iter().cloned().collect::<BTreeMap<_, _>>(), "narrowed": c.narrowed,
            "parameters": c.params.iter().cloned().collect::<BTreeMap<_, _>>(),
            "pairs": c.pairs, "cycles": number(c.cycles), "outputs_compared": number(c.outputs),
            "complete": c.complete, "diagram": c.divergence.as_ref().map(Diagram::text),
        })).collect::<Vec<_>>(),
    })
}
