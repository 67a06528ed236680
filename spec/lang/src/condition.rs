//! Conditions on parameters, of one comparison each: `enabled = TRUE`, `kind <> SPINDLE`, `t_c <= t_d`.

use std::fmt;

use crate::ir::{BinaryOp, Node, Space, System, Ty};

/// A comparison of a parameter with a value or another parameter of its type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Condition {
    /// The parameter: its place in [`System::params`].
    pub left: usize,
    /// What must hold between the two.
    pub relation: Relation,
    /// What it is compared with.
    pub right: Right,
}

/// Why a condition cannot be read: one sentence that says what could stand there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unread {
    /// The system has no such parameter or value.
    Unknown(String),
    /// It makes no sense.
    Wrong(String),
}

impl fmt::Display for Unread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Unread::Unknown(why) | Unread::Wrong(why)) = self;
        f.write_str(why)
    }
}

/// What must hold between two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Relation {
    /// `=`
    Equal,
    /// `<>`
    Unequal,
    /// `<`
    Less,
    /// `<=`
    Most,
    /// `>`
    More,
    /// `>=`
    Least,
}

/// What a parameter is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Right {
    /// A value, as the number of the cell.
    Value(i64),
    /// Another parameter, by its place.
    Parameter(usize),
}

const RELATIONS: [(Relation, &str, BinaryOp); 6] = [
    (Relation::Equal, "=", BinaryOp::Eq),
    (Relation::Unequal, "<>", BinaryOp::Ne),
    (Relation::Less, "<", BinaryOp::Lt),
    (Relation::Most, "<=", BinaryOp::Le),
    (Relation::More, ">", BinaryOp::Gt),
    (Relation::Least, ">=", BinaryOp::Ge),
];

impl Relation {
    fn row(self) -> (Relation, &'static str, BinaryOp) {
        let row = RELATIONS.iter().find(|row| row.0 == self);
        row.copied().unwrap_or(RELATIONS[0])
    }
}

impl fmt::Display for Relation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.row().1)
    }
}

impl Condition {
    /// Reads a condition on the parameters of a system; between its parts stands space.
    ///
    /// # Errors
    /// What of it makes no sense, and what could stand there.
    pub fn read(system: &System, text: &str) -> Result<Self, Unread> {
        let [left, relation, right] = text.split_whitespace().collect::<Vec<_>>()[..] else {
            return Err(Unread::Wrong(format!(
                "`{text}` is no condition: write one comparison with space around its operator, as `t_c <= t_d`"
            )));
        };
        let row = RELATIONS.iter().find(|row| row.1 == relation);
        let relation = row.map(|row| row.0).ok_or_else(|| {
            Unread::Wrong(format!(
                "`{relation}` in `{text}` compares nothing: it is one of = <> < <= > >=, with space around it"
            ))
        })?;
        let place = |name: &str| {
            let mut params = system.params.iter();
            params.position(|p| p.reading.is_none() && written(&p.var.name) == name)
        };
        let left = place(left).ok_or_else(|| {
            Unread::Unknown(format!(
                "`{left}` in `{text}` is no parameter of {}: `check -v` lists them",
                system.name
            ))
        })?;
        let ty = system.params[left].var.ty;
        let right = match place(right) {
            Some(other) if system.params[other].var.ty == ty => Right::Parameter(other),
            Some(_) => {
                let why = format!("`{text}` compares values of different types");
                return Err(Unread::Wrong(why));
            }
            // Another system may have it.
            None => Right::Value(value(system, ty, right).ok_or_else(|| {
                Unread::Unknown(format!(
                    "`{right}` in `{text}` is neither a parameter of {} nor {}",
                    system.name,
                    values(system, ty)
                ))
            })?),
        };
        let ordered = !matches!(relation, Relation::Equal | Relation::Unequal);
        if ordered && ty != Ty::Int {
            return Err(Unread::Wrong(format!(
                "`{text}` orders values without an order: use = or <>"
            )));
        }
        Ok(Condition {
            left,
            relation,
            right,
        })
    }

    /// The condition as [`Condition::read`] reads it.
    pub fn text(&self, system: &System) -> String {
        let name =
            |k: usize| (system.params.get(k)).map_or(String::new(), |p| written(&p.var.name));
        let ty = system.params.get(self.left).map_or(Ty::Int, |p| p.var.ty);
        let right = match self.right {
            Right::Value(value) => system.show(ty, value),
            Right::Parameter(other) => name(other),
        };
        format!("{} {} {right}", name(self.left), self.relation)
    }

    /// The condition as an expression of parameters.
    pub fn node(&self) -> Node {
        let cell = |k: usize| Box::new(Node::Cell(Space::Param, k as u32));
        let right = match self.right {
            Right::Value(value) => Box::new(Node::Const(value)),
            Right::Parameter(other) => cell(other),
        };
        Node::Binary(self.relation.row().2, cell(self.left), right)
    }

    /// Whether it holds, where each parameter has the value that `value` tells.
    pub fn holds(&self, value: impl Fn(usize) -> i64) -> bool {
        let left = value(self.left);
        let right = match self.right {
            Right::Value(value) => value,
            Right::Parameter(other) => value(other),
        };
        match self.relation {
            Relation::Equal => left == right,
            Relation::Unequal => left != right,
            Relation::Less => left < right,
            Relation::Most => left <= right,
            Relation::More => left > right,
            Relation::Least => left >= right,
        }
    }
}

/// A name without space, as it stands in conditions and certificates.
pub fn written(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join("_")
}

fn value(system: &System, ty: Ty, text: &str) -> Option<i64> {
    match ty {
        Ty::Int => text.parse().ok(),
        Ty::Bool => ["FALSE", "TRUE"]
            .iter()
            .position(|v| *v == text)
            .map(|v| v as i64),
        Ty::Enum(e) => {
            let mut values = system.enums.get(e)?.values.iter();
            values.position(|v| v == text).map(|v| v as i64)
        }
    }
}

/// What can stand for a value of a type.
fn values(system: &System, ty: Ty) -> String {
    match ty {
        Ty::Int => "a whole number, times in cycles".to_owned(),
        Ty::Bool => "TRUE or FALSE".to_owned(),
        Ty::Enum(e) => {
            let values = system.enums.get(e).map(|e| e.values.join(", "));
            format!("one of {}", values.unwrap_or_default())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bind::Bound;
    use crate::ir::{Enum, Param, Var};

    fn system() -> System {
        let param = |name: &str, ty| Param {
            var: Var {
                name: name.to_owned(),
                ty,
                lo: Node::Const(0),
                hi: Node::Const(9),
                text: String::new(),
                ids: Vec::new(),
            },
            default: Node::Const(0),
            reading: None,
        };
        System {
            name: "s/s".to_owned(),
            enums: vec![Enum {
                name: "KIND".to_owned(),
                text: String::new(),
                values: vec!["AXES".to_owned(), "SPINDLE".to_owned()],
            }],
            params: vec![
                param("a", Ty::Int),
                param("b", Ty::Int),
                param("on", Ty::Bool),
                param("kind", Ty::Enum(0)),
            ],
            ..System::default()
        }
    }

    #[test]
    fn what_is_written_is_read_as_it_was() {
        let system = system();
        for text in [
            "a <= b",
            "a < b",
            "b >= 3",
            "a > -1",
            "a = b",
            "on = TRUE",
            "on <> FALSE",
            "kind <> SPINDLE",
        ] {
            let condition = Condition::read(&system, text).expect(text);
            assert_eq!(condition.text(&system), text);
        }
    }

    #[test]
    fn the_expression_holds_where_the_condition_does() {
        let system = system();
        for (relation, text, _) in RELATIONS {
            for right in ["b", "1"] {
                let condition = Condition::read(&system, &format!("a {text} {right}")).expect(text);
                assert_eq!(condition.relation, relation);
                for (a, b) in [(0, 1), (1, 1), (2, 1), (1, 0)] {
                    let values = [a, b, 0, 0];
                    let bound = Bound {
                        system: system.clone(),
                        values: values.to_vec(),
                        states: Vec::new(),
                        inputs: Vec::new(),
                        initial: Vec::new(),
                    };
                    let holds = condition.holds(|k| i64::from(values[k]));
                    assert_eq!(
                        bound.constant(&condition.node()) != 0,
                        holds,
                        "{text} {right} {a} {b}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_makes_no_sense_is_told() {
        let system = system();
        for (text, part) in [
            ("a<=b", "space around its operator"),
            ("a == b", "one of = <> < <= > >="),
            ("c < a", "`c` in `c < a` is no parameter of s/s"),
            ("a < on", "different types"),
            ("a < many", "a whole number"),
            ("on = 1", "TRUE or FALSE"),
            ("kind = DOOR", "one of AXES, SPINDLE"),
            ("kind < SPINDLE", "use = or <>"),
        ] {
            let told = Condition::read(&system, text).expect_err(text).to_string();
            assert!(told.contains(part), "{told}");
        }
    }
}
