//! Properties and their images under exchanges of instances.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Form;
use stillpoint_lang::symmetry::{Symmetry, claim, symmetries};
use stillpoint_model::{Group, Judgement, Permutation, Verdict};

/// The symmetries of a system, and what they make of its properties.
pub(super) struct Images {
    group: Group,
    generators: Vec<Permutation>,
    /// For each generator and each property the property that is its image, if it is stated.
    next: Vec<Vec<Option<usize>>>,
    /// For each property the first one of its orbit, and the permutation that leads from there to it.
    representative: Vec<(usize, Permutation)>,
}

impl Images {
    /// Of `bound`, which has its parameter values in its expressions; without symmetries if these are not wanted.
    pub(super) fn new(bound: &Bound, wanted: bool) -> Self {
        let (states, inputs) = (bound.states.len(), bound.inputs.len());
        let found = if wanted {
            symmetries(bound)
        } else {
            Vec::new()
        };
        let all: Vec<Permutation> = found.iter().map(|s| permutation(bound, s)).collect();
        let group = Group::new(states, inputs, &all);
        let generators: Vec<Permutation> =
            group.generators().iter().map(|k| all[*k].clone()).collect();
        let properties = &bound.system.properties;
        let claims: Vec<Option<String>> =
            properties.iter().map(|p| claim(bound, p, None)).collect();
        let image = |s: &Symmetry, k: usize| {
            let claimed = claim(bound, &properties[k], Some(s))?;
            claims.iter().position(|c| c.as_ref() == Some(&claimed))
        };
        let next: Vec<Vec<Option<usize>>> = group
            .generators()
            .iter()
            .map(|g| {
                (0..properties.len())
                    .map(|k| image(&found[*g], k))
                    .collect()
            })
            .collect();
        let mut images = Self {
            group,
            generators,
            next,
            representative: Vec::new(),
        };
        let mut representative: Vec<Option<(usize, Permutation)>> = vec![None; properties.len()];
        for k in 0..properties.len() {
            if representative[k].is_none() {
                for (member, way) in images.orbit(k, states, inputs) {
                    representative[member].get_or_insert((k, way));
                }
            }
        }
        images.representative = representative.into_iter().flatten().collect();
        images
    }

    pub(super) fn group(&self) -> &Group {
        &self.group
    }

    /// The property that stands for property `k`, and the permutation that leads from there to `k`.
    pub(super) fn representative(&self, k: usize) -> (usize, &Permutation) {
        let (representative, way) = &self.representative[k];
        (*representative, way)
    }

    /// The stated images of a property, itself first, with the permutations that lead to them.
    fn orbit(&self, k: usize, states: usize, inputs: usize) -> Vec<(usize, Permutation)> {
        let mut out = vec![(k, Permutation::identity(states, inputs))];
        let mut at = 0;
        while at < out.len() {
            for (generator, next) in self.generators.iter().zip(&self.next) {
                if let Some(image) = next[out[at].0] {
                    if !out.iter().any(|(k, _)| *k == image) {
                        let way = out[at].1.then(generator);
                        out.push((image, way));
                    }
                }
            }
            at += 1;
        }
        out
    }

    /// Whether orbits of states keep the verdict on property `k`: nothing changes it, or it speaks of single cycles and all its
    /// images are stated.
    pub(super) fn safe(&self, bound: &Bound, k: usize) -> bool {
        match &bound.system.properties[k].form {
            Form::Always { .. } | Form::Reachable { .. } => self
                .orbit(k, bound.states.len(), bound.inputs.len())
                .iter()
                .all(|(member, _)| self.next.iter().all(|next| next[*member].is_some())),
            // Two runs are explored side by side, state by state.
            Form::Independent { .. } => true,
            _ => self.next.iter().all(|next| next[k] == Some(k)),
        }
    }

    /// Judges the orbits of properties about single cycles together: what was found for one of them was found for all.
    pub(super) fn combine(&self, bound: &Bound, judged: &mut [Judgement]) {
        let found = judged.to_vec();
        for (k, property) in bound.system.properties.iter().enumerate() {
            if !matches!(property.form, Form::Always { .. } | Form::Reachable { .. }) {
                continue;
            }
            let orbit = self.orbit(k, bound.states.len(), bound.inputs.len());
            let best = orbit.iter().min_by_key(|(member, _)| {
                let judged = &found[*member];
                (
                    rank(judged.verdict),
                    judged.length.unwrap_or(u64::MAX),
                    *member,
                )
            });
            if let Some((member, way)) = best {
                let back = way.inverse();
                judged[k] = Judgement {
                    id: judged[k].id.clone(),
                    trace: found[*member].trace.as_ref().map(|t| back.trace(t)),
                    ..found[*member].clone()
                };
            }
        }
    }
}

/// A run shows more than its absence.
fn rank(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Violated | Verdict::Reached => 0,
        Verdict::Inconclusive => 1,
        Verdict::Holds => 2,
        Verdict::Vacuous | Verdict::Unreachable => 3,
    }
}

/// In the explorer's terms: values count from the least.
fn permutation(bound: &Bound, symmetry: &Symmetry) -> Permutation {
    let values = symmetry.values.iter().zip(&bound.inputs);
    let counted = |lo: i32, v: i64| u32::try_from(v - i64::from(lo)).unwrap_or(0);
    Permutation {
        states: symmetry.states.clone(),
        inputs: symmetry.inputs.clone(),
        values: values
            .map(|(map, (lo, _))| {
                map.iter()
                    .map(|(from, to)| (counted(*lo, *from), counted(*lo, *to)))
                    .collect()
            })
            .collect(),
    }
}
