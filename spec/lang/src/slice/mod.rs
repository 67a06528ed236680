//! Slices of a system by cones of influence: for each property, only what can influence its verdict.
//!
//! A *slice* is a smaller system over some of the state variables and inputs. Its cells are closed under influence: what
//! decides the next value of a variable of the slice is in the slice. So, as long as no assignment outside the slice
//! leaves its range, each cycle of the whole system is, seen through the slice, a cycle of the slice, and the other way
//! round each cycle of the slice is that of the whole system with any values for what is outside. A property that speaks
//! of the slice only has the same verdict in both, with runs of the same lengths.
//!
//! What keeps something in a slice:
//!
//! * an expression needs the cells and named expressions it reads, and these what they are made of; an array element
//!   with a computed index needs the whole array;
//! * a state variable needs every assignment to it in its machine: the value, the index, the guards of the `IF`s around it
//!   with those of the branches before, and, since the first rule that matches wins, the guards of the rule and of all
//!   rules before it;
//! * the claim that no assignment leaves its range needs the targets of all assignments that must be checked.

mod cone;
mod cut;
mod folded;

pub use cone::Cone;

use crate::bind::Bound;
use crate::ir::Stmt;
use cone::Reach;
use cut::Cut;

/// Finds cones in a system and cuts slices out of it.
#[derive(Debug, Clone)]
pub struct Slicer {
    whole: Bound,
}

/// A part of a system that is a system itself.
#[derive(Debug, Clone)]
pub struct Slice {
    /// The system, with its parameter values put into the expressions. Places of faults keep their numbers.
    pub bound: Bound,
    /// For each of its state variables the number in the whole system.
    pub states: Vec<u32>,
    /// For each of its inputs the number in the whole system.
    pub inputs: Vec<u32>,
    /// For each of its atoms the number in the whole system.
    pub atoms: Vec<u32>,
    /// For each of its observed expressions the number in the whole system.
    pub observed: Vec<u32>,
    /// For each of its properties the number in the whole system.
    pub properties: Vec<usize>,
}

impl Slice {
    /// Whether it has every cell and every expression of `whole`, so that all have the numbers they have there.
    pub fn is_whole(&self, whole: &Bound) -> bool {
        let system = &whole.system;
        self.states.len() == system.states.len()
            && self.inputs.len() == system.inputs.len()
            && self.atoms.len() == system.atoms.len()
            && self.observed.len() == system.observed.len()
    }
}

impl Slicer {
    /// Prepares a system: puts the parameter values into it, so that what they exclude influences nothing.
    pub fn new(bound: &Bound) -> Self {
        Self {
            whole: folded::folded(bound),
        }
    }

    /// The whole system with its parameter values in every expression. State variables, inputs, named expressions, atoms
    /// and properties have the numbers they had before; rules that cannot fire are gone.
    pub fn whole(&self) -> &Bound {
        &self.whole
    }

    /// What decides the verdict on property `k`, if nothing leaves its range.
    pub fn property(&self, k: usize) -> Cone {
        let system = &self.whole.system;
        Reach::new(system).property(&system.properties[k]).close()
    }

    /// What decides whether an assignment leaves its range; none if no assignment can.
    pub fn faults(&self) -> Option<Cone> {
        let any = |list: &[Stmt]| list.iter().any(checks);
        self.whole
            .system
            .rules()
            .any(|r| any(&r.then))
            .then(|| Reach::new(&self.whole.system).faults().close())
    }

    /// The cone of everything.
    pub fn all(&self) -> Cone {
        let system = &self.whole.system;
        Cone {
            states: vec![true; system.states.len()],
            inputs: vec![true; system.inputs.len()],
            lazies: vec![true; system.lazies.len()],
        }
    }

    /// The slice of a cone with these properties, whose own cones must lie within it.
    pub fn slice(&self, cone: &Cone, properties: &[usize]) -> Slice {
        Cut::new(&self.whole, cone).slice(properties)
    }
}

fn checks(statement: &Stmt) -> bool {
    match statement {
        Stmt::Assign { checked, .. } => *checked,
        Stmt::If(branches, rest) => branches
            .iter()
            .flat_map(|(_, body)| body)
            .chain(rest)
            .any(checks),
    }
}
