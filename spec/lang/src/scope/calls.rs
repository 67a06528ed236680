//! Built-in functions, declared functions and quantifiers.

use std::collections::HashMap;

use super::{BUILTINS, Meaning, Scope, Tense, Typed};
use crate::diag::{Diagnostic, nearest};
use crate::ir::{BinaryOp, Node, Space, Ty};
use crate::syntax::ast::{Expr, Quantifier, TypeKind};

impl Scope<'_> {
    pub(super) fn call(&mut self, name: &str, args: &[Expr], e: &Expr, hint: Option<Ty>) -> Typed {
        let arity = |n: &str, ok: bool, me: &Self| -> Result<(), Diagnostic> {
            if ok {
                return Ok(());
            }
            Err(me
                .error(&e.span, format!("{name} has {} arguments", args.len()))
                .help(format!("it takes {n}")))
        };
        match name {
            "PREV" => {
                arity("one expression", args.len() == 1, self)?;
                if matches!(self.tense, Tense::Start | Tense::None) {
                    return Err(self
                        .error(&e.span, "PREV has no meaning here")
                        .help("guards and lets already read the start of the cycle"));
                }
                let before = std::mem::replace(&mut self.tense, Tense::Start);
                let out = self.resolve(&args[0], hint);
                self.tense = before;
                let (ty, node) = out?;
                if reads_cycle(&node) {
                    return Err(self
                        .error(&args[0].span, "PREV is offered for state only")
                        .help("inputs and outputs of the cycle before are gone; keep them in a state variable"));
                }
                Ok((ty, node))
            }
            "SEL" => {
                arity(
                    "(condition, value if FALSE, value if TRUE)",
                    args.len() == 3,
                    self,
                )?;
                let g = self.expect(&args[0], Ty::Bool)?;
                let (ty, mut values) = self.alike(&args[1..], hint)?;
                let (yes, no) = (values.pop(), values.pop());
                let boxed = |n: Option<Node>| Box::new(n.unwrap_or(Node::Const(0)));
                Ok((ty, Node::Sel(Box::new(g), boxed(no), boxed(yes))))
            }
            "MUX" => {
                arity("(selector from 0, values ...)", args.len() >= 3, self)?;
                let k = self.index_node(&args[0], 0, (args.len() - 1) as u32)?;
                let (ty, values) = self.alike(&args[1..], hint)?;
                Ok((ty, Node::Mux(Box::new(k), values)))
            }
            "MIN" | "MAX" => {
                arity("two or more values", args.len() >= 2, self)?;
                let (ty, values) = self.alike(args, hint)?;
                if ty == Ty::Bool {
                    return Err(self
                        .error(&e.span, "truth values have no order")
                        .help("use AND or OR"));
                }
                let node = if name == "MIN" {
                    Node::Min(values)
                } else {
                    Node::Max(values)
                };
                Ok((ty, node))
            }
            "LIMIT" => {
                arity("(least, value, greatest)", args.len() == 3, self)?;
                let (ty, mut v) = self.alike(args, hint)?;
                let hi = v.pop().unwrap_or(Node::Const(0));
                let x = v.pop().unwrap_or(Node::Const(0));
                Ok((
                    ty,
                    Node::Max(vec![
                        v.pop().unwrap_or(Node::Const(0)),
                        Node::Min(vec![x, hi]),
                    ]),
                ))
            }
            "ABS" => {
                arity("one number", args.len() == 1, self)?;
                let node = self.expect(&args[0], Ty::Int)?;
                self.int(Node::Abs(Box::new(node)), e)
            }
            "ORD" => {
                arity("one enum value", args.len() == 1, self)?;
                let (ty, node) = self.resolve(&args[0], None)?;
                if matches!(ty, Ty::Enum(_)) {
                    Ok((Ty::Int, node))
                } else {
                    Err(self
                        .error(&args[0].span, "ORD needs an enum value")
                        .help("leave ORD out"))
                }
            }
            _ => self.user_call(name, args, e),
        }
    }

    fn user_call(&mut self, name: &str, args: &[Expr], e: &Expr) -> Typed {
        let Some(function) = self.spec.functions.get(name) else {
            let known = BUILTINS
                .iter()
                .copied()
                .chain(self.spec.functions.keys().map(String::as_str));
            let help = nearest(name, known).map_or("declare it under [function]".to_owned(), |n| {
                format!("did you mean `{n}`?")
            });
            return Err(self
                .error(&e.span, format!("there is no function `{name}`"))
                .help(help));
        };
        let def = &function.def;
        if args.len() != def.args.len() {
            return Err(self
                .error(&e.span, format!("`{name}` has {} arguments", args.len()))
                .help(format!("it takes {}", def.args.len())));
        }
        if self.calls.iter().any(|c| c == name) {
            return Err(self
                .error(&e.span, format!("function `{name}` calls itself"))
                .help("functions are not recursive"));
        }
        let mut names = HashMap::new();
        for (decl, arg) in def.args.iter().zip(args) {
            let (arg_name, ty) = self.spec.decl(function.file, decl)?;
            let want = match &ty.kind {
                TypeKind::Bool => Ty::Bool,
                TypeKind::Int(_) | TypeKind::Time(_) => Ty::Int,
                TypeKind::Enum(n) if self.spec.enums.contains_key(n) => {
                    Ty::Enum(self.spec.enums.get_index_of(n).unwrap_or(0))
                }
                _ => {
                    return Err(self
                        .spec
                        .error(
                            function.file,
                            decl.span(),
                            "this type cannot be an argument",
                        )
                        .help("use BOOL, INT, TIME or a declared enum"));
                }
            };
            names.insert(arg_name, Meaning::Value(want, self.expect(arg, want)?));
        }
        let body = self.spec.expr(function.file, &def.value)?;
        let mut calls = self.calls.clone();
        calls.push(name.to_owned());
        let (members, arrays) = (HashMap::new(), HashMap::new());
        let mut inner = Scope {
            spec: self.spec,
            file: function.file,
            text: &def.value,
            names: &names,
            members: &members,
            arrays: &arrays,
            index: Vec::new(),
            options: self.options,
            ranges: self.ranges,
            tense: Tense::None,
            cycle_us: self.cycle_us,
            calls,
            left: self.left.clone(),
        };
        let out = inner.resolve(&body, None);
        self.left.set(inner.left.get());
        out
    }

    pub(super) fn quantified(
        &mut self,
        q: Quantifier,
        var: &str,
        array: &str,
        body: &Expr,
        e: &Expr,
        hint: Option<Ty>,
    ) -> Typed {
        let Some(count) = self.arrays.get(array).copied() else {
            return Err(self
                .error(&e.span, format!("`{array}` is not an array of instances"))
                .help("quantify over an instance with `count`"));
        };
        let mut typed = Vec::new();
        for k in 1..=count {
            self.index.push((var.to_owned(), k));
            let one = match q {
                Quantifier::Maximum => self.resolve(body, hint),
                _ => self.expect(body, Ty::Bool).map(|n| (Ty::Bool, n)),
            };
            self.index.pop();
            typed.push(one?);
        }
        let ty = typed.first().map_or(Ty::Bool, |t| t.0);
        let mut nodes = typed.into_iter().map(|t| t.1);
        let first = nodes.next().unwrap_or(Node::Const(0));
        let join = |op| move |a: Node, b: Node| Node::Binary(op, Box::new(a), Box::new(b));
        let node = match q {
            Quantifier::ForAll => nodes.fold(first, join(BinaryOp::And)),
            Quantifier::Exists => nodes.fold(first, join(BinaryOp::Or)),
            Quantifier::Maximum => Node::Max(std::iter::once(first).chain(nodes).collect()),
        };
        Ok((ty, node))
    }
}

/// Whether the value belongs to the cycle (inputs, lets, outputs, state after) and not to its start.
fn reads_cycle(node: &Node) -> bool {
    let mut found = false;
    node.visit(&mut |n| {
        found |= match n {
            Node::Cell(space, _) | Node::Element { space, .. } => {
                matches!(space, Space::Input | Space::Now)
            }
            Node::Lazy(_) => true,
            _ => false,
        };
    });
    found
}
