//! Declarations: parameters, inputs, state; the units of an instance array.

use std::collections::HashMap;

use super::{Builder, CELL, Names, One, Unit};
use crate::diag::nearest;
use crate::ir::{Node, Param, Space, State, Ty, Var};
use crate::schema::{self, Scalar, Text};
use crate::scope::{Meaning, Tense};
use crate::syntax::ast::{self, Kind, TypeKind};

impl Builder<'_> {
    /// A scalar given where an expression is meant.
    pub(super) fn scalar_expr(
        &self,
        file: usize,
        value: &toml::Spanned<Scalar>,
    ) -> One<(ast::Expr, Text)> {
        let (written, quoted) = match value.get_ref() {
            Scalar::Bool(b) => (if *b { "TRUE" } else { "FALSE" }.to_owned(), false),
            Scalar::Int(v) => (v.to_string(), false),
            Scalar::Text(t) => (t.clone(), true),
        };
        let text = toml::Spanned::new(value.span(), written);
        let mut e = self.spec.expr(file, &text)?;
        if !quoted {
            e.span = 0..0;
        }
        Ok((e, text))
    }

    pub(super) fn constant(
        &self,
        file: usize,
        value: &toml::Spanned<Scalar>,
        want: Ty,
        names: &Names,
    ) -> One<Node> {
        let (e, text) = self.scalar_expr(file, value)?;
        self.machine_scope(file, &text, names, Tense::None)
            .expect(&e, want)
    }

    /// The cells of a declaration: one, or those of an array with its lower index bound.
    pub(super) fn variables(
        &self,
        file: usize,
        full: &str,
        written: &str,
        port: &schema::Port,
        names: &Names,
    ) -> One<(Vec<Var>, Option<i64>)> {
        let ty = self.spec.type_of(file, &port.ty)?;
        if crate::syntax::is_keyword(written) || written.is_empty() {
            return Err(self
                .spec
                .error(
                    file,
                    port.ty.span(),
                    format!("`{written}` cannot be a name"),
                )
                .help("names start with a letter and are not keywords"));
        }
        let (element, array) = match &ty.kind {
            TypeKind::Array(lo, hi, element) => (element.as_ref(), Some((*lo, *hi))),
            _ => (&ty, None),
        };
        let mut scope = self.machine_scope(file, &port.ty, names, Tense::None);
        let (ty, lo, hi) = match &element.kind {
            TypeKind::Bool => (Ty::Bool, Node::Const(0), Node::Const(1)),
            TypeKind::Enum(name) => match self.spec.enums.get_full(name) {
                Some((k, _, e)) => {
                    let top = e.def.values.len() as i64 - 1;
                    (Ty::Enum(k), Node::Const(0), Node::Const(top))
                }
                None => {
                    let known = self.spec.enums.keys().map(String::as_str);
                    let help = nearest(name, known.chain(["BOOL", "INT", "TIME"]))
                        .map_or("declare it under [enum]".to_owned(), |n| {
                            format!("did you mean `{n}`?")
                        });
                    return Err(scope
                        .error(&element.span, format!("there is no type `{name}`"))
                        .help(help));
                }
            },
            TypeKind::Int(Some((lo, hi))) | TypeKind::Time(Some((lo, hi))) => {
                let (a, b) = (scope.expect(lo, Ty::Int)?, scope.expect(hi, Ty::Int)?);
                let (least, most) = (scope.ranges.of(&a), scope.ranges.of(&b));
                if least.0 < CELL.0 || most.1 > CELL.1 {
                    return Err(scope
                        .error(
                            &element.span,
                            format!("range {}..{} does not fit 32 bits", least.0, most.1),
                        )
                        .help("use a range within -2147483647..2147483647"));
                }
                if least.0 > most.1 {
                    return Err(scope
                        .error(
                            &element.span,
                            format!("range {}..{} is empty", least.0, most.1),
                        )
                        .help("the lower bound comes first"));
                }
                (Ty::Int, a, b)
            }
            _ => {
                return Err(scope
                    .error(&element.span, "a variable needs a range")
                    .help("write INT(0..7) or TIME(0..100)"));
            }
        };
        let var = |name: String| Var {
            name,
            ty,
            lo: lo.clone(),
            hi: hi.clone(),
            text: port.text.clone(),
            ids: port.id.clone(),
        };
        Ok(match array {
            None => (vec![var(full.to_owned())], None),
            Some((first, last)) => (
                (first..=last)
                    .map(|k| var(format!("{full}[{k}]")))
                    .collect(),
                Some(first),
            ),
        })
    }

    pub(super) fn declare_param(
        &mut self,
        file: usize,
        name: &Text,
        port: &schema::Port,
        names: &Names,
    ) -> One<Meaning> {
        let (vars, array) = self.variables(file, name.get_ref(), name.get_ref(), port, names)?;
        let Some(default) = &port.default else {
            return Err(self
                .spec
                .error(
                    file,
                    name.span(),
                    format!("parameter `{}` has no default", name.get_ref()),
                )
                .help("add `default = ...` so that the file can be checked on its own"));
        };
        let base = self.sys.params.len() as u32;
        let (ty, len) = (vars[0].ty, vars.len() as u32);
        let one = |value: Scalar| {
            let value = toml::Spanned::new(default.span(), value);
            self.constant(file, &value, ty, names)
        };
        let values = match default.get_ref() {
            schema::Default::All(value) => vec![one(value.clone())?; vars.len()],
            schema::Default::Each(numbers) => {
                let numbers = numbers.iter().map(|n| one(Scalar::Int(*n)));
                numbers.collect::<One<Vec<Node>>>()?
            }
        };
        if values.len() != vars.len() {
            let (given, cells) = (values.len(), vars.len());
            let message = format!("{given} defaults for {cells} cells");
            return Err(self
                .spec
                .error(file, default.span(), message)
                .help("write one number for all cells, or one for each"));
        }
        let (lo, hi) = (
            self.ranges().of(&vars[0].lo).0,
            self.ranges().of(&vars[0].hi).1,
        );
        for value in &values {
            let range = self.ranges().of(value);
            if range.1 < lo || range.0 > hi {
                return Err(self
                    .spec
                    .error(
                        file,
                        default.span(),
                        format!("default {} is outside {lo}..{hi}", range.0),
                    )
                    .help(format!("give `{}` a default of its type", name.get_ref())));
            }
        }
        for (var, default) in vars.into_iter().zip(values) {
            self.sys.params.push(Param {
                var,
                default,
                reading: None,
            });
        }
        Ok(match array {
            None => Meaning::Value(ty, Node::Cell(Space::Param, base)),
            Some(first) => Meaning::Array(ty, Space::Param, base, first, len),
        })
    }

    pub(super) fn add_inputs(&mut self, vars: Vec<Var>, array: Option<i64>) -> Meaning {
        let base = self.sys.inputs.len() as u32;
        let (ty, len) = (vars[0].ty, vars.len() as u32);
        self.sys.inputs.extend(vars);
        match array {
            None => Meaning::Value(ty, Node::Cell(Space::Input, base)),
            Some(first) => Meaning::Array(ty, Space::Input, base, first, len),
        }
    }

    /// Makes the units of an instance (array): parameters and state.
    pub(super) fn expand(&mut self, name: &Text, def: &schema::Instance, units: &mut Vec<Unit>) {
        let Some(machine) = self.spec.machines.get(def.machine.get_ref()) else {
            let known = self.spec.machines();
            let help = nearest(def.machine.get_ref(), known)
                .map_or("declare it under [machine]".to_owned(), |n| {
                    format!("did you mean `{n}`?")
                });
            self.errors.push(
                self.spec
                    .error(
                        self.file,
                        def.machine.span(),
                        format!("there is no machine `{}`", def.machine.get_ref()),
                    )
                    .help(help),
            );
            return;
        };
        let base = name.get_ref();
        let count = def.count.as_ref().map(|c| *c.get_ref());
        if let (Some(count), Some(written)) = (count, &def.count) {
            if !(1..=64).contains(&count) {
                self.errors.push(
                    self.spec
                        .error(
                            self.file,
                            written.span(),
                            format!("count {count} is not possible"),
                        )
                        .help("1 to 64 instances"),
                );
                return;
            }
            self.arrays.insert(base.clone(), count);
        }
        for key in def.param.keys() {
            if !machine.def.param.contains_key(key) {
                let known = machine.def.param.keys().map(|k| k.get_ref().as_str());
                let help = nearest(key.get_ref(), known)
                    .map_or("its machine has no such parameter".to_owned(), |n| {
                        format!("did you mean `{n}`?")
                    });
                self.errors.push(
                    self.spec
                        .error(
                            self.file,
                            key.span(),
                            format!(
                                "machine `{}` has no parameter `{}`",
                                def.machine.get_ref(),
                                key.get_ref()
                            ),
                        )
                        .help(help),
                );
            }
        }
        for index in 1..=count.unwrap_or(1) {
            let full = if count.is_some() {
                format!("{base}[{index}]")
            } else {
                base.clone()
            };
            let mut unit = Unit {
                name: full,
                machine: def.machine.get_ref().clone(),
                index: count.map(|_| index),
                names: HashMap::new(),
                inner: HashMap::new(),
                wires: Vec::new(),
                rules: Vec::new(),
                states: 0..0,
            };
            for (param, port) in &machine.def.param {
                let meaning = self.bind_param(machine.file, param, &port.0, def, &unit);
                if let Some(meaning) = self.note(meaning) {
                    unit.names.insert(param.get_ref().clone(), meaning);
                }
            }
            let first = self.sys.states.len() as u32;
            for (state, port) in &machine.def.state {
                let made = self.add_state(machine.file, state, &port.0, &unit, units.len());
                if let Some(meaning) = self.note(made) {
                    if unit
                        .names
                        .insert(state.get_ref().clone(), meaning)
                        .is_some()
                    {
                        self.twice(machine.file, state);
                    }
                }
            }
            unit.states = first..self.sys.states.len() as u32;
            units.push(unit);
        }
    }

    pub(super) fn twice(&mut self, file: usize, name: &Text) {
        self.errors.push(
            self.spec
                .error(
                    file,
                    name.span(),
                    format!("`{}` is declared twice in this machine", name.get_ref()),
                )
                .help("parameters, inputs, state, lets and outputs share one name space"),
        );
    }

    pub(super) fn bind_param(
        &mut self,
        file: usize,
        param: &Text,
        port: &schema::Port,
        def: &schema::Instance,
        unit: &Unit,
    ) -> One<Meaning> {
        let given = def
            .param
            .iter()
            .find(|(k, _)| k.get_ref() == param.get_ref());
        if let Some((_, value)) = given {
            let (vars, _) =
                self.variables(file, param.get_ref(), param.get_ref(), port, &unit.names)?;
            let (e, text) = self.scalar_expr(self.file, value)?;
            if let Kind::Name(n) = &e.kind {
                if let Some(m @ Meaning::Array(..)) = self.names.get(n) {
                    return Ok(m.clone());
                }
            }
            let mut scope = self.system_scope(&text, unit.index);
            scope.tense = Tense::None;
            let node = scope.expect(&e, vars[0].ty)?;
            return Ok(Meaning::Value(vars[0].ty, node));
        }
        if let Some(meaning) = self.names.get(param.get_ref()) {
            let (vars, array) =
                self.variables(file, param.get_ref(), param.get_ref(), port, &unit.names)?;
            let same = match meaning {
                Meaning::Value(ty, _) => *ty == vars[0].ty && array.is_none(),
                Meaning::Array(ty, Space::Param, _, first, len) => {
                    *ty == vars[0].ty && array == Some(*first) && vars.len() == *len as usize
                }
                _ => false,
            };
            if !same {
                return Err(self
                    .spec
                    .error(
                        file,
                        param.span(),
                        format!(
                            "parameter `{}` has another type than the system's",
                            param.get_ref()
                        ),
                    )
                    .help("bind it in the instance: `param = { name = \"...\" }`"));
            }
            return Ok(meaning.clone());
        }
        let meaning = self.declare_param(file, param, port, &unit.names)?;
        self.names.insert(param.get_ref().clone(), meaning.clone());
        Ok(meaning)
    }

    pub(super) fn add_state(
        &mut self,
        file: usize,
        name: &Text,
        port: &schema::Port,
        unit: &Unit,
        owner: usize,
    ) -> One<Meaning> {
        let full = format!("{}.{}", unit.name, name.get_ref());
        let (vars, array) = self.variables(file, &full, name.get_ref(), port, &unit.names)?;
        let ty = vars[0].ty;
        let Some(written) = &port.init else {
            return Err(self
                .spec
                .error(
                    file,
                    name.span(),
                    format!("state `{}` has no initial value", name.get_ref()),
                )
                .help("add `init = ...`, or `init = \"ANY\"` for every value"));
        };
        let any = matches!(written.get_ref(), Scalar::Text(t) if t == "ANY");
        let init = if any {
            None
        } else {
            Some(self.constant(file, written, ty, &unit.names)?)
        };
        if let Some(init) = &init {
            let (a, b) = (
                self.ranges().of(init),
                (
                    self.ranges().of(&vars[0].lo).0,
                    self.ranges().of(&vars[0].hi).1,
                ),
            );
            if a.1 < b.0 || a.0 > b.1 {
                return Err(self
                    .spec
                    .error(
                        file,
                        written.span(),
                        format!("initial value {} is outside {}..{}", a.0, b.0, b.1),
                    )
                    .help("choose a value of the type"));
            }
        }
        let base = self.sys.states.len() as u32;
        let len = vars.len() as u32;
        for var in vars {
            self.sys.states.push(State {
                var,
                init: init.clone(),
            });
            self.state_owner.push(owner);
        }
        Ok(Meaning::State(ty, base, array.map(|first| (first, len))))
    }
}
