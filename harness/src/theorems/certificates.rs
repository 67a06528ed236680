//! The certificates of the theorems: for each an inductive invariant, and a run that shows that it says something.
//!
//! What a solver needs to refute the opposite is found anew whenever they are checked, and each of its steps is confirmed by the checker:
//! it would be nearly all of the file.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;

use stillpoint_certify::format::Verdict;
use stillpoint_certify::proof::check::confirm;
use stillpoint_certify::proof::clause::written;
use stillpoint_certify::proof::format::{Claim, Free, Proof, RANGE, System, theorems_text};
use stillpoint_certify::proof::read::read_theorems;
use stillpoint_certify::proof::symbolic::Symbolic;
use stillpoint_certify::proof::target::Target;
use stillpoint_engine::label;
use stillpoint_engine::theorems::{Failing, OfSystem, Proved, fingerprint, tables};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::condition::Condition;
use stillpoint_lang::ir::{Form, Property};
use stillpoint_lang::twice::twice;
use stillpoint_model::proof::Budget;

use super::ranges;
use crate::certificate::proofs::{Unwritten, Writer, spans, with_lemmas};
use crate::proof::{Every, Judged, deciding};

/// The file in a family's folder.
pub const FILE: &str = "theorems.cert";

/// A proof of which an obligation takes more lemmas is not accepted: whoever wants to can check all of them in minutes.
const MOST: usize = 20_000;

/// The certificates of a family: by the name of a system one for each entry of its [`OfSystem::proved`].
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Certificates {
    /// By the name of the system.
    pub systems: BTreeMap<String, Vec<System>>,
}

impl Certificates {
    /// Reads the certificates of the family in `folder`; none if it has no such file.
    ///
    /// # Errors
    /// One sentence: a file that cannot be read, or was altered.
    pub fn load(folder: &Path) -> Result<Self, String> {
        let path = folder.join(FILE);
        let bytes = match std::fs::read(&path) {
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Self::default()),
            read => read.map_err(|e| format!("{} cannot be read: {e}", path.display()))?,
        };
        let list = read_theorems(&bytes).map_err(|e| {
            format!(
                "{}: {e}; take it away, and `stillpoint theorems {} --prove` writes it anew",
                path.display(),
                folder.display()
            )
        })?;
        let mut all = Self::default();
        for system in list {
            let own = all.systems.entry(system.name.clone()).or_default();
            own.push(system);
        }
        Ok(all)
    }

    /// The file.
    pub fn text(&self) -> String {
        let all: Vec<System> = self.systems.values().flatten().cloned().collect();
        theorems_text(&all)
    }
}

/// What the proofs of a system show, confirmed. Those are left out that nobody would want to check.
///
/// # Errors
/// One sentence: a proof that the checker does not confirm.
pub(super) fn certified(
    bound: &Bound,
    every: &Every,
    judged: &[&Judged],
    budget: &Budget,
) -> Result<System, String> {
    let mut writer = Writer::new(bound, Some(every), MOST, budget)?;
    for one in judged {
        let mut properties = bound.system.properties.iter();
        let property = properties.find(|property| label(property) == one.id);
        let claim = writer.claim(one.id.clone(), property, one)?;
        writer.system.claims.extend(claim);
    }
    let system = writer.system;
    confirm(bound, &system).map_err(|what| format!("{}: {what}", bound.system.name))?;
    Ok(system)
}

/// What the certificates of a system show.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Confirmed {
    /// Theorems that are confirmed.
    pub confirmed: usize,
    /// Properties that are confirmed to fail for some values.
    pub fails: usize,
    /// Theorems and failures that belong to other tables, ranges or readings, and are none of today.
    pub other: usize,
    /// Clauses of all invariants.
    pub clauses: usize,
    /// Lemmas of all refutations.
    pub lemmas: usize,
}

/// Checks the certificates of what is proved about a system.
///
/// # Errors
/// One sentence: what is not shown.
pub fn check(
    bound: &Bound,
    known: &OfSystem,
    certificates: &[System],
    budget: &Budget,
) -> Result<Confirmed, String> {
    let mut all = Confirmed::default();
    if bound.readings().into_iter().collect::<BTreeMap<_, _>>() != known.readings {
        all.other = known
            .proved
            .iter()
            .map(|proved| proved.found().count())
            .sum();
        return Ok(all);
    }
    if known.proved.len() != certificates.len() {
        return Err(format!(
            "there are {} certificates for the theorems over {} ranges",
            certificates.len(),
            known.proved.len()
        ));
    }
    for (proved, certificate) in known.proved.iter().zip(certificates) {
        one(bound, (known, proved), certificate, budget, &mut all)?;
    }
    Ok(all)
}

fn one(
    bound: &Bound,
    (known, proved): (&OfSystem, &Proved),
    certificate: &System,
    budget: &Budget,
    all: &mut Confirmed,
) -> Result<(), String> {
    let conditions = proved.conditions.iter();
    let conditions: Option<Vec<Condition>> = conditions
        .map(|text| Condition::read(&bound.system, text).ok())
        .collect();
    let which = ranges(bound, &proved.within);
    let every = conditions.and_then(|list| Every::such(bound, &which, &list).ok());
    let Some(every) = every.filter(|every| every.text() == proved.every) else {
        all.other += proved.found().count();
        return Ok(());
    };
    if certificate.free.every != spans(&every) || certificate.free.conditions != proved.conditions {
        return Err("its certificate is about other values of the parameters".to_owned());
    }
    let symbolic = Symbolic::new(bound, &certificate.free)?;
    let tables = tables(&bound.system);
    let mut whole = System {
        claims: Vec::new(),
        ..certificate.clone()
    };
    for (id, print) in &proved.holds {
        let mut properties = bound.system.properties.iter();
        let property = properties.find(|property| label(property) == *id);
        let today = property.is_some() || id == RANGE;
        if !today || fingerprint(&tables, &bound.system, property) != *print {
            all.other += 1;
            continue;
        }
        let mut claims = certificate.claims.iter();
        let claim = claims.find(|claim| claim.id == *id && claim.verdict == Verdict::Holds);
        let claim = claim.ok_or_else(|| format!("{id}: its certificate is missing"))?;
        let bare = claim.proof.clone().unwrap_or_default();
        let proof = lemmas_of(&symbolic, &certificate.free, property, bare, budget)
            .map_err(|w| format!("{id}: {w}"))?;
        all.clauses += proof.invariant.len();
        all.lemmas += proof.lemmas.iter().map(|l| l.list.len()).sum::<usize>();
        whole.claims.push(Claim {
            proof: Some(proof),
            ..claim.clone()
        });
    }
    for (id, failing) in &proved.fails {
        let property = bound.system.properties.iter().find(|p| label(p) == *id);
        let others = known.proved.iter().filter_map(|other| other.holds.get(id));
        let print = fingerprint(&tables, &bound.system, property);
        if !others.chain(known.open.get(id)).any(|own| *own == print) {
            all.other += 1;
            continue;
        }
        let claim = failure((bound, proved), certificate, id, failing);
        let none = || format!("{id}: no run shows that it fails with these values");
        whole.claims.push(claim.ok_or_else(none)?);
    }
    confirm(bound, &whole)?;
    let holds = |claim: &&Claim| claim.verdict == Verdict::Holds;
    let confirmed = whole.claims.iter().filter(holds).count();
    all.confirmed += confirmed;
    all.fails += whole.claims.len() - confirmed;
    Ok(())
}

/// The claim that a property fails, if its run is that which is told, with all values that matter.
fn failure(
    (bound, proved): (&Bound, &Proved),
    certificate: &System,
    id: &String,
    told: &Failing,
) -> Option<Claim> {
    let mut only = bound.clone();
    only.system.properties.retain(|p| label(p) == *id);
    let every = Every::new(&only, &ranges(&only, &proved.within)).ok()?;
    let name = |k: usize| &bound.system.params[k].var.name;
    if !deciding(&every)
        .into_iter()
        .all(|k| told.with.contains_key(name(k)))
    {
        return None;
    }
    let mut claims = certificate.claims.iter();
    let claim = claims.find(|claim| claim.id == *id && claim.verdict == Verdict::Violated)?;
    let run = claim.run.as_ref()?;
    let value = |(name, value): (&String, &String)| {
        let mut params = bound.system.params.iter().map(|param| &param.var);
        let var = params.find(|var| var.name == *name);
        let own = run.with.iter().find(|(own, _)| *own == written(name));
        own.zip(var)
            .is_some_and(|((_, own), var)| bound.system.show(var.ty, *own) == *value)
    };
    let same = run.cycles.len() as u64 == told.cycles && told.with.iter().all(value);
    same.then(|| claim.clone())
}

/// The proof that a property holds, or all assignments fit, with its lemmas.
fn lemmas_of(
    symbolic: &Symbolic,
    free: &Free,
    property: Option<&Property>,
    bare: Proof,
    budget: &Budget,
) -> Result<Proof, String> {
    let whole = |symbolic: &Symbolic, form: Option<&Form>| {
        let target = form.map_or(Some(Target::Range), |f| Target::of(f, Verdict::Holds));
        let target = target.ok_or("this form has no proof")?;
        with_lemmas(symbolic, target, bare, usize::MAX, budget).map_err(|why| match why {
            Unwritten::Spent => "ended from outside".to_owned(),
            Unwritten::Untold(what) => what,
            Unwritten::Wrong => "its certificate does not show it".to_owned(),
        })
    };
    let of_both = |p: &&Property| matches!(p.form, Form::Independent { .. });
    match property.filter(of_both) {
        None => whole(symbolic, property.map(|p| &p.form)),
        Some(property) => {
            let both = twice(symbolic.bound, property).ok_or("two runs of it are no system")?;
            let symbolic = Symbolic::new(&both.bound, free)?;
            whole(&symbolic, Some(&both.bound.system.properties[0].form))
        }
    }
}
