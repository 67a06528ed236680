//! Asks what is known for fewer values than are documented again for as many as can be told.

use std::collections::BTreeMap;

use stillpoint_certify::proof::format::System as Certificate;
use stillpoint_engine::theorems::{OfSystem, Proved};
use stillpoint_lang::bind::Bound;

use super::attempt::{Attempt, Own};
use super::{Failed, Proving};

/// What is known of a system, with what holds for more values than were known before in the place of that.
pub(super) fn wider(
    bound: &Bound,
    known: Own,
    proving: &Proving,
    told: &mut dyn FnMut(&str),
) -> Result<Own, Failed> {
    let (mut own, mut certificates) = known;
    // What fails for some values was asked for all of them.
    let fails = |label: &String| own.proved.iter().any(|p| p.fails.contains_key(label));
    let few = own.proved.iter().filter(|p| for_fewer(p));
    let few = few
        .flat_map(|p| &p.holds)
        .filter(|(label, _)| !fails(label));
    let open: BTreeMap<String, String> = few
        .map(|(label, print)| (label.clone(), print.clone()))
        .collect();
    if open.is_empty() {
        return Ok((own, certificates));
    }
    let asked = OfSystem {
        open: open.clone(),
        proved: Vec::new(),
        ..own.clone()
    };
    let mut attempt = Attempt {
        bound,
        own: (asked, Vec::new()),
        proving,
        // No conditions are looked for: without them it holds for some values.
        searched: open.into_keys().collect(),
        told,
    };
    attempt.widest()?;
    let (found, shown) = attempt.own;
    for (mut proved, mut certificate) in found.proved.into_iter().zip(shown) {
        let more = |label: &String| {
            let mut old = own.proved.iter().filter(|p| for_fewer(p));
            old.any(|old| old.holds.contains_key(label) && is_more(&proved.within, &old.within))
        };
        let news: Vec<String> = proved.holds.keys().filter(|l| more(l)).cloned().collect();
        proved.fails.clear();
        keep(&mut proved, &mut certificate, |label| news.contains(label));
        if proved.holds.is_empty() {
            continue;
        }
        for (old, certificate) in own.proved.iter_mut().zip(&mut certificates) {
            if for_fewer(old) {
                keep(old, certificate, |label| !news.contains(label));
            }
        }
        own.proved.insert(0, proved);
        certificates.insert(0, certificate);
    }
    let all = own.proved.into_iter().zip(certificates);
    (own.proved, certificates) = all.filter(|(p, _)| p.found().next().is_some()).unzip();
    Ok((own, certificates))
}

/// Whether something was found for fewer values than there are, and without a condition on them.
fn for_fewer(proved: &Proved) -> bool {
    !proved.within.is_empty() && proved.conditions.is_empty()
}

/// Ranges of some parameters; of the others the whole documented range is meant.
pub type Ranges = BTreeMap<String, (i64, i64)>;

/// Whether these are all the values of the others, and more.
pub fn is_more(these: &Ranges, others: &Ranges) -> bool {
    let mut ranges = these.iter();
    let all = ranges.all(|(name, (lo, hi))| {
        let other = others.get(name);
        other.is_some_and(|(least, most)| lo <= least && most <= hi)
    });
    all && these != others
}

/// Keeps what is wanted of what holds, and of its certificate.
fn keep(proved: &mut Proved, certificate: &mut Certificate, wanted: impl Fn(&String) -> bool) {
    proved.holds.retain(|label, _| wanted(label));
    let claims = &mut certificate.claims;
    claims.retain(|c| proved.holds.contains_key(&c.id) || proved.fails.contains_key(&c.id));
}
