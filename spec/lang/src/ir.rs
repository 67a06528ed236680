//! A system after name resolution: flat cells, typed expressions, rules in the order they step.

use std::ops::Range;

pub use crate::syntax::ast::BinaryOp;

/// Type of a scalar value. Times are integers of cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ty {
    /// Truth value, stored as 0 or 1.
    Bool,
    /// Index into [`System::enums`]; stored as the ordinal of the value.
    Enum(usize),
    /// Integer.
    Int,
}

/// A group of cells an expression can index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Space {
    /// Parameters.
    Param,
    /// State at the start of the cycle.
    Before,
    /// State as it is now: changed by the rules that have run.
    Now,
    /// Inputs.
    Input,
}

/// A typed expression over cells.
#[derive(Debug, Clone, PartialEq, Hash)]
pub enum Node {
    /// Literal.
    Const(i64),
    /// One cell of a space.
    Cell(Space, u32),
    /// A named expression, evaluated once a cycle when first needed: index into [`System::lazies`].
    Lazy(u32),
    /// Array element: `len` cells from `base`, the first one has index `lo`.
    Element {
        /// Where the cells are.
        space: Space,
        /// First cell.
        base: u32,
        /// Index of the first cell.
        lo: i64,
        /// Number of cells.
        len: u32,
        /// Which one.
        index: Box<Node>,
    },
    /// Logical negation.
    Not(Box<Node>),
    /// Arithmetic negation.
    Neg(Box<Node>),
    /// Operator with two operands; AND and OR decide early.
    Binary(BinaryOp, Box<Node>, Box<Node>),
    /// Condition, value if FALSE, value if TRUE.
    Sel(Box<Node>, Box<Node>, Box<Node>),
    /// Selector from 0, values.
    Mux(Box<Node>, Vec<Node>),
    /// Smallest value.
    Min(Vec<Node>),
    /// Largest value.
    Max(Vec<Node>),
    /// Absolute value.
    Abs(Box<Node>),
}

impl Node {
    /// The direct parts of an expression.
    pub fn children(&self) -> Vec<&Node> {
        match self {
            Node::Const(_) | Node::Cell(..) | Node::Lazy(_) => Vec::new(),
            Node::Element { index, .. } => vec![index],
            Node::Not(a) | Node::Neg(a) | Node::Abs(a) => vec![a],
            Node::Binary(_, a, b) => vec![a, b],
            Node::Sel(g, a, b) => vec![g, a, b],
            Node::Mux(k, v) => std::iter::once(k.as_ref()).chain(v).collect(),
            Node::Min(v) | Node::Max(v) => v.iter().collect(),
        }
    }

    /// The same expression with each direct part replaced.
    pub fn map(&self, f: &mut impl FnMut(&Node) -> Node) -> Node {
        self.placed(&mut |space, k| (space, k), f)
    }

    /// The same expression with its own cell, or the first one of its array, in another place, and each direct part replaced.
    pub fn placed(
        &self,
        place: &mut impl FnMut(Space, u32) -> (Space, u32),
        f: &mut impl FnMut(&Node) -> Node,
    ) -> Node {
        let mut boxed = |n: &Node| Box::new(f(n));
        match self {
            Node::Const(_) | Node::Lazy(_) => self.clone(),
            Node::Cell(space, k) => {
                let (space, k) = place(*space, *k);
                Node::Cell(space, k)
            }
            Node::Element {
                space,
                base,
                lo,
                len,
                index,
            } => {
                let (space, base) = place(*space, *base);
                Node::Element {
                    space,
                    base,
                    lo: *lo,
                    len: *len,
                    index: boxed(index),
                }
            }
            Node::Not(a) => Node::Not(boxed(a)),
            Node::Neg(a) => Node::Neg(boxed(a)),
            Node::Abs(a) => Node::Abs(boxed(a)),
            Node::Binary(op, a, b) => Node::Binary(*op, boxed(a), boxed(b)),
            Node::Sel(g, a, b) => Node::Sel(boxed(g), boxed(a), boxed(b)),
            Node::Mux(k, v) => Node::Mux(boxed(k), v.iter().map(f).collect()),
            Node::Min(v) => Node::Min(v.iter().map(f).collect()),
            Node::Max(v) => Node::Max(v.iter().map(f).collect()),
        }
    }

    /// The number of its parts, itself included.
    pub fn size(&self) -> usize {
        let mut size = 0;
        self.visit(&mut |_| size += 1);
        size
    }

    /// The cells of a space that it may read itself, without its parts.
    pub fn cells(&self, of: Space) -> Range<u32> {
        match self {
            Node::Cell(space, k) if *space == of => *k..*k + 1,
            Node::Element {
                space, base, len, ..
            } if *space == of => *base..*base + *len,
            _ => 0..0,
        }
    }

    /// Visits this expression and all its parts.
    pub fn visit<'a>(&'a self, f: &mut impl FnMut(&'a Node)) {
        f(self);
        for child in self.children() {
            child.visit(f);
        }
    }
}

/// A cell: parameter, state variable or input.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Var {
    /// Full name, e.g. `stop[1].level` or `limit[0]`.
    pub name: String,
    /// Type.
    pub ty: Ty,
    /// Least value, over parameters.
    pub lo: Node,
    /// Greatest value, over parameters.
    pub hi: Node,
    /// Description from the file.
    pub text: String,
    /// Requirement ids.
    pub ids: Vec<String>,
}

impl Var {
    /// The name without the index, which all elements of an array share.
    pub fn array(&self) -> &str {
        self.name.split('[').next().unwrap_or_default()
    }
}

/// A parameter of the system.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Param {
    /// Name, type and range.
    pub var: Var,
    /// Value where nothing else is given, over earlier parameters.
    pub default: Node,
    /// For an option of a reading: the reading's id.
    pub reading: Option<String>,
}

/// A state variable.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct State {
    /// Name, type and range.
    pub var: Var,
    /// Initial value over parameters; none means any value of the range.
    pub init: Option<Node>,
}

/// What a named expression is, for reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LazyKind {
    /// `let` of a machine.
    Let,
    /// Output of a machine.
    Output,
    /// Expression wired to an input port.
    Wire,
}

/// A named expression.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Lazy {
    /// Full name.
    pub name: String,
    /// What it is.
    pub kind: LazyKind,
    /// Type.
    pub ty: Ty,
    /// Its value.
    pub value: Node,
    /// Least possible value.
    pub lo: i64,
    /// Greatest possible value.
    pub hi: i64,
    /// Requirement ids.
    pub ids: Vec<String>,
    /// Description from the file.
    pub text: String,
}

/// A statement of an effect.
#[derive(Debug, Clone, PartialEq, Hash)]
pub enum Stmt {
    /// Assigns to a state cell; a value outside the range is fault `site`.
    Assign {
        /// First cell of the target.
        base: u32,
        /// Index into an array: (expression, index of the first cell, number of cells).
        index: Option<(Node, i64, u32)>,
        /// New value.
        value: Node,
        /// Whether the value can leave the range, so that every step must check it.
        checked: bool,
        /// Index into [`System::sites`].
        site: u32,
    },
    /// Branches in order, then the rest.
    If(Vec<(Node, Vec<Stmt>)>, Vec<Stmt>),
}

impl Stmt {
    /// Visits each expression of the statement and of those inside it (not the parts of the expressions).
    pub fn expressions<'a>(&'a self, f: &mut impl FnMut(&'a Node)) {
        match self {
            Stmt::Assign { index, value, .. } => {
                if let Some((k, ..)) = index {
                    f(k);
                }
                f(value);
            }
            Stmt::If(branches, rest) => {
                for (guard, body) in branches {
                    f(guard);
                    body.iter().for_each(|s| s.expressions(f));
                }
                rest.iter().for_each(|s| s.expressions(f));
            }
        }
    }
}

/// A place where a value can leave its range.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Site {
    /// `machine.rule: variable`.
    pub name: String,
}

/// A rule.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Rule {
    /// Full name, `instance.rule`.
    pub name: String,
    /// Requirement ids.
    pub ids: Vec<String>,
    /// Why it stands there.
    pub note: String,
    /// Guard.
    pub when: Node,
    /// Effect.
    pub then: Vec<Stmt>,
}

/// An instance of a machine, in the order of stepping.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Instance {
    /// Name, with index for arrays.
    pub name: String,
    /// Name of the machine.
    pub machine: String,
    /// Ordered rules.
    pub rules: Vec<Rule>,
    /// Its state cells.
    pub states: std::ops::Range<u32>,
}

/// The form of a property; numbers are indices into [`System::atoms`], of `observe` into [`System::observed`].
#[derive(Debug, Clone, PartialEq, Hash)]
pub enum Form {
    /// Holds in each cycle (in which `when` holds).
    Always {
        /// Premise.
        when: Option<usize>,
        /// Claim.
        then: usize,
    },
    /// After `when`, `goal` comes; `within` cycles (over parameters) if given, else under fairness.
    LeadsTo {
        /// Trigger.
        when: usize,
        /// Goal.
        goal: usize,
        /// Bound in cycles.
        within: Option<Node>,
        /// Hold infinitely often.
        fair: Vec<usize>,
        /// Holds in each cycle after the trigger.
        assuming: Option<usize>,
    },
    /// From `when` on `holds`, until `unless`.
    Unless {
        /// Trigger.
        when: usize,
        /// Duty.
        holds: usize,
        /// End of the duty.
        unless: usize,
    },
    /// From each reachable state the goal can be reached.
    CanAlwaysReach {
        /// Goal.
        goal: usize,
        /// Which cycles may be used.
        using: Option<usize>,
    },
    /// A witness exists.
    Reachable {
        /// What must be seen.
        goal: usize,
    },
    /// Observations do not depend on inputs.
    Independent {
        /// Observed expressions.
        observe: Vec<usize>,
        /// Inputs that may differ.
        of: Vec<usize>,
        /// In which cycles.
        condition: Option<usize>,
    },
}

impl Form {
    /// The atoms of a form and the expressions it observes.
    pub fn expressions(&self) -> (Vec<usize>, Vec<usize>) {
        match self {
            Form::Always { when, then } => (when.iter().chain([then]).copied().collect(), vec![]),
            Form::LeadsTo {
                when,
                goal,
                fair,
                assuming,
                ..
            } => {
                let all = [when, goal].into_iter().chain(fair).chain(assuming);
                (all.copied().collect(), vec![])
            }
            Form::Unless {
                when,
                holds,
                unless,
            } => (vec![*when, *holds, *unless], vec![]),
            Form::CanAlwaysReach { goal, using } => {
                (using.iter().chain([goal]).copied().collect(), vec![])
            }
            Form::Reachable { goal } => (vec![*goal], vec![]),
            // The inputs that may differ matter only where an observed expression depends on them.
            Form::Independent {
                observe, condition, ..
            } => (condition.iter().copied().collect(), observe.clone()),
        }
    }
}

/// In which table of a report a property stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Topic {
    /// What becomes of a single fault.
    Fault,
    /// How long a reaction takes.
    Reaction,
}

/// What the report on a bounded response is to show, over parameters: stated, so that a change fails the check.
#[derive(Debug, Clone, Default, PartialEq, Hash)]
pub struct Stated {
    /// The least bound that holds, in cycles.
    pub exactly: Option<Node>,
    /// The fastest reaction, in cycles.
    pub fastest: Option<Node>,
}

/// A property of a system.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Property {
    /// Id as in the file; copies over an index variable share it.
    pub id: String,
    /// Value of the index variable, for a copy.
    pub index: Option<i64>,
    /// In plain words.
    pub text: String,
    /// Remarks.
    pub note: String,
    /// Requirement ids.
    pub req: Vec<String>,
    /// The table of the report in which it stands.
    pub topic: Option<Topic>,
    /// Form.
    pub form: Form,
    /// What its report is to show.
    pub stated: Stated,
    /// The expressions as written, for reports: (key, text).
    pub written: Vec<(String, String)>,
}

/// An enum.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Enum {
    /// Name.
    pub name: String,
    /// Description.
    pub text: String,
    /// Values in rising order.
    pub values: Vec<String>,
}

/// A reading and its options, the recommended one first.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Reading {
    /// Id, e.g. `A-25`.
    pub id: String,
    /// What is ambiguous.
    pub text: String,
    /// Names of the options.
    pub options: Vec<String>,
    /// Remarks.
    pub note: String,
}

/// A resolved system.
#[derive(Debug, Clone, Default, PartialEq, Hash)]
pub struct System {
    /// `specification/system`.
    pub name: String,
    /// Description.
    pub text: String,
    /// Remarks.
    pub note: String,
    /// Cycle time in microseconds, used for `T#` literals.
    pub cycle_us: u64,
    /// Whether a machine file scales the times of this system down.
    pub scaled: bool,
    /// Enums that occur.
    pub enums: Vec<Enum>,
    /// Readings whose options occur.
    pub readings: Vec<Reading>,
    /// Parameters, the options of the readings last.
    pub params: Vec<Param>,
    /// State variables.
    pub states: Vec<State>,
    /// Inputs read from the environment.
    pub inputs: Vec<Var>,
    /// Named expressions.
    pub lazies: Vec<Lazy>,
    /// Instances in the order they step.
    pub instances: Vec<Instance>,
    /// Places of possible range faults.
    pub sites: Vec<Site>,
    /// Truth-valued expressions of the properties.
    pub atoms: Vec<Node>,
    /// Observed expressions of `independent` properties.
    pub observed: Vec<Node>,
    /// Properties.
    pub properties: Vec<Property>,
    /// Rules whose not being reached is explained: (full name or machine's name, reason).
    pub unreached: Vec<(String, String)>,
    /// Warnings of the static analysis.
    pub warnings: Vec<String>,
}

impl System {
    /// Number of rules over all instances.
    pub fn rule_count(&self) -> usize {
        self.instances.iter().map(|i| i.rules.len()).sum()
    }

    /// All rules in the order of their numbers.
    pub fn rules(&self) -> impl Iterator<Item = &Rule> {
        self.instances.iter().flat_map(|i| i.rules.iter())
    }

    /// Visits each node of each expression: guards, effects, named expressions, atoms, observations.
    pub fn nodes<'a>(&'a self, f: &mut impl FnMut(&'a Node)) {
        for rule in self.rules() {
            rule.when.visit(f);
            rule.then
                .iter()
                .for_each(|s| s.expressions(&mut |n| n.visit(f)));
        }
        self.lazies.iter().for_each(|l| l.value.visit(f));
        self.atoms
            .iter()
            .chain(&self.observed)
            .for_each(|n| n.visit(f));
    }

    /// A value of a cell as a reader wants to see it: the enum's name, TRUE/FALSE, or the number.
    pub fn show(&self, ty: Ty, value: i64) -> String {
        match ty {
            Ty::Bool => if value != 0 { "TRUE" } else { "FALSE" }.to_owned(),
            Ty::Enum(e) => usize::try_from(value)
                .ok()
                .and_then(|v| self.enums.get(e)?.values.get(v).cloned())
                .unwrap_or_else(|| value.to_string()),
            Ty::Int => value.to_string(),
        }
    }

    /// Fingerprint of everything that decides behaviour (not of texts): equal for equal tables.
    pub fn fingerprint(&self) -> u64 {
        let rules: Vec<_> = self.rules().map(|r| (&r.when, &r.then)).collect();
        let vars: Vec<_> = self.params.iter().map(|p| &p.var).collect();
        let ranges: Vec<_> = vars
            .into_iter()
            .chain(self.states.iter().map(|s| &s.var))
            .chain(&self.inputs)
            .map(|v| (&v.name, v.ty, &v.lo, &v.hi))
            .collect();
        let lazies: Vec<_> = self.lazies.iter().map(|l| (&l.name, &l.value)).collect();
        let text = format!(
            "{rules:?}{ranges:?}{lazies:?}{:?}{:?}",
            self.atoms, self.observed
        );
        // FNV-1a, 64 bits.
        text.bytes().fold(0xcbf2_9ce4_8422_2325, |h, b| {
            (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3)
        })
    }
}
