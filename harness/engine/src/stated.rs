//! Bounds that a specification states (`exactly`, `fastest`), against those found: a change of one fails the check, as a regression
//! test would.

use std::collections::BTreeMap;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Node;
use stillpoint_model::{Judgement, Verdict};

/// Compares what the properties state with their judgements, which stand in the same order. Where they differ the
/// verdict becomes `Violated`; the answer says why, by property number.
///
/// A verdict that found no bound to compare, vacuous or inconclusive, stays.
pub fn judge(bound: &Bound, judgements: &mut [Judgement]) -> BTreeMap<usize, String> {
    let mut refuted = BTreeMap::new();
    let both = bound.system.properties.iter().zip(judgements);
    for (number, (property, judged)) in both.enumerate() {
        if !matches!(judged.verdict, Verdict::Holds | Verdict::Violated) {
            continue;
        }
        let stated = &property.stated;
        let reasons: Vec<String> = [
            ("least bound", &stated.exactly, judged.bound),
            ("fastest reaction", &stated.fastest, judged.fastest),
        ]
        .into_iter()
        .filter_map(|(what, node, found)| differs(bound, what, node.as_ref()?, found))
        .collect();
        if reasons.is_empty() {
            continue;
        }
        if judged.verdict == Verdict::Holds {
            // The length is that of a witness: no run shows a bound.
            judged.length = None;
        }
        judged.verdict = Verdict::Violated;
        refuted.insert(number, reasons.join("; "));
    }
    refuted
}

fn differs(bound: &Bound, what: &str, node: &Node, found: Option<u64>) -> Option<String> {
    let stated = bound.constant(node);
    let found = match found {
        Some(found) if i64::try_from(found) == Ok(stated) => return None,
        Some(found) => format!("found is {found}"),
        None => "found is none".to_owned(),
    };
    Some(format!(
        "the {what} recorded is {stated} cycles, the one {found}"
    ))
}
