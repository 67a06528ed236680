//! Resolved expressions and effects as Structured Text.
//!
//! As in a property, a state variable is its value after the step and `PREV(x)` the one before.

use stillpoint_lang::ir::{BinaryOp, Node, Space, Stmt, System, Ty};

use super::types::{type_of, variable};

/// An expression as text.
pub fn expression(system: &System, node: &Node) -> String {
    Printer { system }.show(node, None, 0)
}

/// An effect as text.
pub fn effect(system: &System, list: &[Stmt]) -> String {
    let printer = Printer { system };
    let mut out = String::new();
    printer.statements(list, &mut out);
    out.trim_end().to_owned()
}

struct Printer<'a> {
    system: &'a System,
}

/// Binding strength of an operator; 0 binds least.
fn strength(op: BinaryOp) -> u8 {
    match op {
        BinaryOp::Or | BinaryOp::Xor => 1,
        BinaryOp::And => 2,
        BinaryOp::Eq | BinaryOp::Ne => 3,
        BinaryOp::Lt | BinaryOp::Gt | BinaryOp::Le | BinaryOp::Ge => 4,
        BinaryOp::Add | BinaryOp::Sub => 5,
        BinaryOp::Mul | BinaryOp::Div | BinaryOp::Mod => 6,
    }
}

impl Printer<'_> {
    fn type_of(&self, node: &Node) -> Option<Ty> {
        type_of(self.system, node)
    }

    fn cell(&self, space: Space, k: u32) -> Option<(&str, Ty)> {
        variable(self.system, space, k).map(|v| (v.name.as_str(), v.ty))
    }

    fn name(&self, space: Space, name: &str) -> String {
        if space == Space::Before {
            format!("PREV({name})")
        } else {
            name.to_owned()
        }
    }

    fn call(&self, name: &str, values: &[&Node], ty: Option<Ty>) -> String {
        let list: Vec<String> = values.iter().map(|n| self.show(n, ty, 0)).collect();
        format!("{name}({})", list.join(", "))
    }

    /// The text; in parentheses if it binds less than `around`. `ty` is what the surroundings say of a literal.
    fn show(&self, node: &Node, ty: Option<Ty>, around: u8) -> String {
        let ty = self.type_of(node).or(ty);
        match node {
            Node::Const(v) => ty.map_or_else(|| v.to_string(), |ty| self.system.show(ty, *v)),
            Node::Cell(space, k) => {
                let name = self.cell(*space, *k).map_or("?", |(n, _)| n);
                self.name(*space, name)
            }
            Node::Lazy(k) => self
                .system
                .lazies
                .get(*k as usize)
                .map_or("?".to_owned(), |l| l.name.clone()),
            Node::Element {
                space, base, index, ..
            } => {
                let name = self.cell(*space, *base).map_or("?", |(n, _)| n);
                let array = name.rsplit_once('[').map_or(name, |(array, _)| array);
                self.name(*space, &format!("{array}[{}]", self.show(index, None, 0)))
            }
            Node::Not(a) => format!("NOT {}", self.show(a, Some(Ty::Bool), 8)),
            Node::Neg(a) => format!("-{}", self.show(a, None, 8)),
            Node::Abs(a) => self.call("ABS", &[a], None),
            Node::Binary(op, a, b) => {
                let s = strength(*op);
                let both = match s {
                    1 | 2 => Some(Ty::Bool),
                    3 | 4 => self.type_of(a).or_else(|| self.type_of(b)),
                    _ => None,
                };
                let text = format!(
                    "{} {} {}",
                    self.show(a, both, s),
                    op.symbol(),
                    self.show(b, both, s + 1)
                );
                if s < around {
                    format!("({text})")
                } else {
                    text
                }
            }
            Node::Sel(g, a, b) => {
                let (g, a, b) = (
                    self.show(g, Some(Ty::Bool), 0),
                    self.show(a, ty, 0),
                    self.show(b, ty, 0),
                );
                format!("SEL({g}, {a}, {b})")
            }
            Node::Mux(k, values) => {
                let list: Vec<String> = std::iter::once(self.show(k, None, 0))
                    .chain(values.iter().map(|v| self.show(v, ty, 0)))
                    .collect();
                format!("MUX({})", list.join(", "))
            }
            Node::Min(values) => self.call("MIN", &values.iter().collect::<Vec<_>>(), ty),
            Node::Max(values) => self.call("MAX", &values.iter().collect::<Vec<_>>(), ty),
        }
    }

    fn statements(&self, list: &[Stmt], out: &mut String) {
        for statement in list {
            match statement {
                Stmt::Assign {
                    base, index, value, ..
                } => {
                    let (name, ty) = self.cell(Space::Now, *base).unwrap_or(("?", Ty::Int));
                    let target = match index {
                        None => name.to_owned(),
                        Some((k, ..)) => {
                            let array = name.rsplit_once('[').map_or(name, |(array, _)| array);
                            format!("{array}[{}]", self.show(k, None, 0))
                        }
                    };
                    out.push_str(&format!("{target} := {}; ", self.show(value, Some(ty), 0)));
                }
                Stmt::If(branches, rest) => {
                    for (n, (guard, body)) in branches.iter().enumerate() {
                        let head = if n == 0 { "IF" } else { "ELSIF" };
                        out.push_str(&format!(
                            "{head} {} THEN ",
                            self.show(guard, Some(Ty::Bool), 0)
                        ));
                        self.statements(body, out);
                    }
                    if !rest.is_empty() {
                        out.push_str("ELSE ");
                        self.statements(rest, out);
                    }
                    out.push_str("END_IF; ");
                }
            }
        }
    }
}
