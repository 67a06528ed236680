//! The cycle of a system as a circuit: what each state variable becomes, and what each property says, as functions of the
//! state and the inputs.
//!
//! Nothing is left of the order of the rules: the first rule whose guard holds is a chain of choices, an effect is the
//! value it leaves. Every term has a value whatever the state and the inputs are, so that it does not matter which ones a
//! tool looks at: the language rules out divisors that can be 0 and indices that can leave their array, for all values of
//! the variables.

mod build;
mod expression;
mod term;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{Form, Property};

pub use term::{Id, Op, Sort, Terms};

use super::Unsupported;
use super::folded::Folded;

/// A property of single cycles, or a witness, as a term.
pub struct Claim<'a> {
    /// The property.
    pub property: &'a Property,
    /// The claim, or for a witness what is to be seen.
    pub term: Id,
}

impl Claim<'_> {
    /// Id of the property, with the number of its copy.
    pub fn id(&self) -> String {
        let index = self
            .property
            .index
            .map_or(String::new(), |i| format!("[{i}]"));
        format!("{}{index}", self.property.id)
    }
}

/// The cycle of a system.
pub struct Circuit<'a> {
    /// The system with its parameters put in.
    pub bound: &'a Bound,
    /// All terms; each comes after those it consists of.
    pub terms: Terms,
    /// Each state variable at the start of the cycle; a constant if it has one value only.
    pub now: Vec<Id>,
    /// What each state variable becomes in a cycle without a range fault.
    pub next: Vec<Id>,
    /// Whether a value leaves its range, if one can at all: such a cycle has no successor and is judged by no property.
    pub fault: Option<Id>,
    /// The `always` and `never` properties. Each must hold in every cycle without a range fault.
    pub claims: Vec<Claim<'a>>,
    /// The `reachable` properties. Each must hold in some cycle without a range fault.
    pub goals: Vec<Claim<'a>>,
    /// The atoms of the properties, where all are asked for; none for one that cannot be a term.
    pub atoms: Vec<Option<Id>>,
}

impl<'a> Circuit<'a> {
    /// The circuit of a system.
    ///
    /// # Errors
    /// Values that need more than 32 bits.
    pub fn new(folded: &Folded<'a>) -> Result<Self, Unsupported> {
        build::circuit(folded, false)
    }

    /// The circuit with the atoms of all properties.
    ///
    /// # Errors
    /// As [`Circuit::new`].
    pub fn whole(folded: &Folded<'a>) -> Result<Self, Unsupported> {
        build::circuit(folded, true)
    }

    /// The state variables that have more than one value.
    pub fn variables(&self) -> impl Iterator<Item = usize> {
        let states = &self.bound.states;
        (0..states.len()).filter(|k| states[*k].0 < states[*k].1)
    }

    /// The term of a state variable at the start of the cycle.
    pub fn state(&self, k: usize) -> Id {
        self.now[k]
    }

    /// Everything that is computed: next state, fault, claims and goals.
    pub fn roots(&self) -> Vec<Id> {
        let claims = self.claims.iter().chain(&self.goals);
        let next = self.next.iter().copied();
        next.chain(self.fault)
            .chain(claims.map(|c| c.term))
            .collect()
    }

    /// The properties that are neither claims nor goals, by id.
    pub fn left_out(&self) -> Vec<&'a str> {
        let properties = &self.bound.system.properties;
        let mut ids: Vec<&str> = properties
            .iter()
            .filter(|p| !matches!(p.form, Form::Always { .. } | Form::Reachable { .. }))
            .map(|p| p.id.as_str())
            .collect();
        ids.dedup();
        ids
    }
}
