//! What is tried about one system: its properties for every value of the parameters, for fewer values, and under conditions on them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::Instant;

use stillpoint_certify::format::Verdict as Shows;
use stillpoint_certify::proof::format::System as Certificate;
use stillpoint_engine::label;
use stillpoint_engine::subject::Subject;
use stillpoint_engine::theorems::{Failing, OfSystem, Proved, RANGE};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::condition::Condition;
use stillpoint_model::proof::Budget;
use stillpoint_model::{Interrupt, Verdict};

use super::certificates::certified;
use super::conditions::Search;
use super::wider::wider;
use super::{Failed, Proving, prints};
use crate::proof::{
    Engine, Every, Judged, Proof, Settings, Shown, Span, Which, deciding, judge_every, untold,
};

/// Where the numbers of a system grow too large to be told, its parameters have at most so many values.
const NARROWER: [i64; 3] = [1 << 16, 1 << 12, 1 << 8];

/// What is open for all values is tried for fewer of them, one after the other: of each parameter with more than so many values so many.
const FEWER: [(i64, i64); 3] = [(1 << 20, 16), (256, 256), (16, 16)];

/// What is known of a system, with its certificates.
pub(super) type Own = (OfSystem, Vec<Certificate>);

/// The theorems about the one system of a subject, whose file has this place in the family's folder.
pub(super) fn of_system(
    subject: &Subject,
    file: &Path,
    known: Option<&Own>,
    proving: &Proving,
    told: &mut dyn FnMut(&str),
) -> Result<Own, Failed> {
    let bound = &subject.tasks[0].bound;
    let own = OfSystem {
        file: file.to_string_lossy().into_owned(),
        readings: bound.readings().into_iter().collect(),
        proved: Vec::new(),
        open: prints(&bound.system),
    };
    let all = |of: &OfSystem| -> BTreeMap<String, String> {
        let proved = of.proved.iter().flat_map(|proved| &proved.holds);
        let all = proved.chain(&of.open);
        all.map(|(key, value)| (key.clone(), value.clone()))
            .collect()
    };
    let same = |known: &OfSystem| known.readings == own.readings && all(known) == own.open;
    let known = known.filter(|known| same(&known.0)).cloned();
    let own = match known {
        Some(known) if !proving.open => return Ok(known),
        Some(known) => wider(bound, known, proving, told)?,
        None => (own, Vec::new()),
    };
    let mut attempt = Attempt {
        bound,
        own,
        proving,
        searched: BTreeSet::new(),
        told,
    };
    attempt.widest()?;
    for (many, few) in FEWER {
        let few = windows(bound, many, few);
        if !few.is_empty() && attempt.own.0.open.keys().any(|name| name != RANGE) {
            attempt.of(&few)?;
        }
    }
    Ok(attempt.own)
}

/// Parameters with more than `many` values, and `few` of these: the nearest to zero.
fn windows(bound: &Bound, many: i64, few: i64) -> BTreeMap<String, (i64, i64)> {
    let params = bound.system.params.iter();
    let params = params.filter(|p| p.reading.is_none());
    let few = params.filter_map(|param| {
        let (lo, hi) = (bound.constant(&param.var.lo), bound.constant(&param.var.hi));
        (hi - lo >= many).then(|| {
            let first = (-few / 2).clamp(lo, hi - few + 1);
            (param.var.array().to_owned(), (first, first + few - 1))
        })
    });
    few.collect()
}

/// All parameters of a system, each `within` its range there or over the whole documented one.
pub fn ranges(bound: &Bound, within: &BTreeMap<String, (i64, i64)>) -> Which {
    let params = bound.system.params.iter();
    let params = params.filter(|param| param.reading.is_none());
    let spans = params.map(|param| {
        let name = param.var.array().to_owned();
        let values = within.get(&name).copied();
        Span { name, values }
    });
    Which::Named(spans.collect())
}

pub(super) struct Attempt<'a> {
    pub(super) bound: &'a Bound,
    pub(super) own: Own,
    pub(super) proving: &'a Proving,
    /// Properties for which conditions were searched.
    pub(super) searched: BTreeSet<String>,
    pub(super) told: &'a mut dyn FnMut(&str),
}

impl Attempt<'_> {
    /// Tries all values; where the system cannot be told with them, as many as it can be told with.
    pub(super) fn widest(&mut self) -> Result<(), Failed> {
        let narrower = NARROWER.iter().map(|n| windows(self.bound, *n, *n));
        let all = std::iter::once(BTreeMap::new()).chain(narrower);
        for within in all.collect::<Vec<_>>() {
            if self.own.0.open.is_empty() || self.of(&within)? {
                break;
            }
        }
        Ok(())
    }

    /// A system with those of its properties that are wanted.
    fn only(&self, wanted: impl Fn(&String) -> bool) -> Bound {
        let mut bound = self.bound.clone();
        bound.system.properties.retain(|p| wanted(&label(p)));
        bound
    }

    /// Tries what is open for every value of the parameters, some of them `within` these ranges: whether the system can be told with them.
    fn of(&mut self, within: &BTreeMap<String, (i64, i64)>) -> Result<bool, Failed> {
        let bound = self.only(|name| self.own.0.open.contains_key(name));
        let which = ranges(&bound, within);
        let every = match Every::new(&bound, &which) {
            Ok(every) => every,
            Err(why) => {
                (self.told)(&format!("{}: {why}", bound.system.name));
                return Ok(false);
            }
        };
        if untold(&every).is_some() {
            return Ok(false);
        }
        let start = Instant::now();
        let settings = Settings {
            each: Some(self.proving.each),
            ranges: self.own.0.open.contains_key(RANGE),
            interrupt: self.proving.interrupt.clone(),
            ..Settings::default()
        };
        let mut judged = judge_every(&every, &settings);
        self.ended()?;
        // A system whose assignments all fit has no such fault.
        if settings.ranges && !judged.iter().any(|one| one.id == RANGE) {
            judged.push(fits());
        }
        judged.retain(|one| self.own.0.open.contains_key(&one.id));
        let seconds = start.elapsed().as_secs_f64();
        self.keep(&every, within, &judged, seconds)?;
        self.conditions(&every, within, &judged)?;
        Ok(true)
    }

    /// Searches conditions for what does not hold for all values.
    fn conditions(
        &mut self,
        every: &Every,
        within: &BTreeMap<String, (i64, i64)>,
        judged: &[Judged],
    ) -> Result<(), Failed> {
        let which = ranges(self.bound, within);
        let mut found: BTreeMap<Vec<Condition>, Vec<Judged>> = BTreeMap::new();
        for one in judged {
            let broken = one.trace.as_ref();
            let broken = broken.filter(|_| one.verdict == Verdict::Violated);
            let Some(trace) = broken.filter(|_| self.searched.insert(one.id.clone())) else {
                continue;
            };
            let bound = self.only(|name| *name == one.id);
            let search = Search {
                bound: &bound,
                which: &which,
                each: self.proving.each,
                interrupt: self.proving.interrupt.clone(),
            };
            if let Some((mut conditions, judged)) = search.find(every.configuration(trace))? {
                conditions.sort_unstable();
                found.entry(conditions).or_default().push(judged);
            }
        }
        for (conditions, judged) in found {
            let bound = self.only(|name| judged.iter().any(|one| one.id == *name));
            let every = Every::such(&bound, &which, &conditions).map_err(Failed::Other)?;
            let seconds = judged.iter().map(|one| one.seconds).sum();
            self.keep(&every, within, &judged, seconds)?;
        }
        Ok(())
    }

    /// What of a configuration breaks a property.
    fn failing(&self, one: &Judged, within: &BTreeMap<String, (i64, i64)>) -> Option<Failing> {
        let bound = self.only(|name| *name == one.id);
        let every = Every::new(&bound, &ranges(&bound, within)).ok()?;
        let values = every.configuration(one.trace.as_ref()?);
        let named = |k: usize| {
            let var = &bound.system.params[k].var;
            (var.name.clone(), bound.system.show(var.ty, values[k]))
        };
        Some(Failing {
            cycles: one.length?,
            with: deciding(&every).into_iter().map(named).collect(),
        })
    }

    fn ended(&self) -> Result<(), Failed> {
        let interrupt = self.proving.interrupt.as_ref();
        match interrupt.is_some_and(Interrupt::is_raised) {
            true => Err(Failed::Ended),
            false => Ok(()),
        }
    }

    /// Keeps what holds and what fails, each with its certificate.
    fn keep(
        &mut self,
        every: &Every,
        within: &BTreeMap<String, (i64, i64)>,
        judged: &[Judged],
        seconds: f64,
    ) -> Result<(), Failed> {
        let system = &self.bound.system;
        let mut proved = Proved {
            every: every.text(),
            within: within.clone(),
            conditions: every.conditions.iter().map(|c| c.text(system)).collect(),
            seconds: (seconds * 10.0).round() / 10.0,
            ..Proved::default()
        };
        let known = |id: &String| self.own.0.proved.iter().any(|p| p.fails.contains_key(id));
        let news = |one: &&Judged| match one.verdict {
            Verdict::Holds => true,
            Verdict::Violated => one.trace.is_some() && !known(&one.id),
            _ => false,
        };
        let news: Vec<&Judged> = judged.iter().filter(news).collect();
        let budget = Budget {
            until: None,
            interrupt: self.proving.interrupt.clone(),
        };
        let certificate = certified(self.bound, every, &news, &budget).map_err(Failed::Other)?;
        self.ended()?;
        for claim in &certificate.claims {
            if claim.verdict == Shows::Holds {
                proved.holds.extend(self.own.0.open.remove_entry(&claim.id));
                continue;
            }
            let one = news.iter().find(|one| one.id == claim.id);
            let failing = one.and_then(|one| self.failing(one, within));
            proved
                .fails
                .insert(claim.id.clone(), failing.unwrap_or_default());
        }
        let under = match &proved.conditions[..] {
            [] => String::new(),
            conditions => format!(" where {}", conditions.join(", ")),
        };
        (self.told)(&format!(
            "{}: {} of {}, {} fail, for {}{under}; {:.1} s",
            system.name,
            proved.holds.len(),
            judged.len(),
            proved.fails.len(),
            proved.every,
            proved.seconds
        ));
        if !proved.holds.is_empty() || !proved.fails.is_empty() {
            self.own.0.proved.push(proved);
            self.own.1.push(certificate);
        }
        Ok(())
    }
}

/// That all assignments fit, whatever happens.
pub(super) fn fits() -> Judged {
    Judged {
        id: RANGE.to_owned(),
        text: String::new(),
        verdict: Verdict::Holds,
        length: None,
        engine: Some(Engine::Pdr),
        proof: Some(Proof::Nothing),
        shown: Some(Shown::default()),
        trace: None,
        reason: None,
        seconds: 0.0,
    }
}
