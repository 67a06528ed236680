//! What is explored together.

use stillpoint_lang::ir::Form;
use stillpoint_lang::slice::{Cone, Slicer};

use super::Reductions;
use super::images::Images;

/// The reachable states of a slice grow more slowly than its index space; this exponent stands for that. With 1/2, two
/// slices of one size are explored together as long as their union is at most four times as large.
const GROWTH: f64 = 0.5;

/// Properties explored together.
pub(super) struct Share {
    pub(super) cone: Cone,
    pub(super) properties: Vec<usize>,
    /// It shows that no assignment leaves its range.
    pub(super) faults: bool,
    /// The step of the whole system may run it: outside it nothing can leave its range.
    pub(super) narrow: bool,
}

/// The explorations to make, the smallest first, so that a limit leaves most verdicts; or why the whole system is explored.
///
/// Each property that stands for its images has its cone, the absence of faults too. Two cones become one where exploring their
/// union is estimated to be no more work than exploring both: so nested cones are always explored together, and
/// slices that have nothing in common never, unless they are tiny.
pub(super) fn plan(
    slicer: &Slicer,
    images: &Images,
    reductions: Reductions,
) -> Result<Vec<Share>, &'static str> {
    let system = &slicer.whole().system;
    if !reductions.slice && images.group().is_trivial() {
        return Err("no two instances can be exchanged");
    }
    let faults = slicer.faults();
    let judged = (0..system.properties.len()).filter(|k| images.representative(*k).0 == *k);
    let mut shares: Vec<Share> = judged
        .map(|k| Share {
            cone: slicer.property(k),
            properties: vec![k],
            faults: false,
            narrow: false,
        })
        .collect();
    if let Some(cone) = &faults {
        shares.push(Share {
            cone: cone.clone(),
            properties: Vec::new(),
            faults: true,
            narrow: false,
        });
    }
    if shares.is_empty() && images.group().is_trivial() {
        return Err("no property is stated and no assignment can leave its range");
    }
    // Without a claim the orbits are counted all the same.
    if !reductions.slice || shares.is_empty() {
        let cone = slicer.all();
        let properties = shares.iter().flat_map(|s| s.properties.clone()).collect();
        return Ok(vec![Share {
            cone,
            properties,
            faults: faults.is_some(),
            narrow: true,
        }]);
    }
    merge(slicer, &mut shares);
    let sum: f64 = shares.iter().map(|s| work(slicer, &s.cone)).sum();
    let all = work(slicer, &slicer.all());
    if sum >= all && images.group().is_trivial() {
        return Err("the slices together would be no less work");
    }
    for share in &mut shares {
        share.narrow = faults.as_ref().is_none_or(|f| share.cone.contains(f));
        share.properties.sort_unstable();
    }
    shares.sort_by(|a, b| work(slicer, &a.cone).total_cmp(&work(slicer, &b.cone)));
    Ok(shares)
}

fn merge(slicer: &Slicer, shares: &mut Vec<Share>) {
    let mut costs: Vec<f64> = shares.iter().map(|s| work(slicer, &s.cone)).collect();
    loop {
        // The pair that gains most.
        let mut best: Option<(f64, usize, usize, Cone)> = None;
        for a in 0..shares.len() {
            for b in a + 1..shares.len() {
                let join = shares[a].cone.join(&shares[b].cone);
                let gain = costs[a] + costs[b] - work(slicer, &join);
                if gain >= 0.0 && best.as_ref().is_none_or(|(most, ..)| gain > *most) {
                    best = Some((gain, a, b, join));
                }
            }
        }
        let Some((_, a, b, join)) = best else { return };
        let second = shares.remove(b);
        costs.remove(b);
        costs[a] = work(slicer, &join);
        let first = &mut shares[a];
        first.cone = join;
        first.properties.extend(second.properties);
        first.faults |= second.faults;
    }
}

/// An estimate, without a unit: the cells' index space times the input combinations, damped.
fn work(slicer: &Slicer, cone: &Cone) -> f64 {
    let whole = slicer.whole();
    let size = |(lo, hi): &(i32, i32)| f64::from(*hi) - f64::from(*lo) + 1.0;
    let states = whole.states.iter().enumerate();
    let inputs = whole.inputs.iter().enumerate();
    let states = states.filter(|(k, _)| cone.has_state(*k));
    let inputs = inputs.filter(|(k, _)| cone.has_input(*k));
    let bits: f64 = states.chain(inputs).map(|(_, r)| size(r).log2()).sum();
    (bits * GROWTH).exp2()
}

/// The properties of a share and, of those that speak of single cycles, the images whose cones lie within it too; rising.
pub(super) fn mates(slicer: &Slicer, images: &Images, share: &Share) -> Vec<usize> {
    let system = &slicer.whole().system;
    let single = |form: &Form| matches!(form, Form::Always { .. } | Form::Reachable { .. });
    (0..system.properties.len())
        .filter(|k| {
            let (representative, _) = images.representative(*k);
            share.properties.contains(k)
                || (single(&system.properties[*k].form)
                    && share.properties.contains(&representative)
                    && share.cone.contains(&slicer.property(*k)))
        })
        .collect()
}
