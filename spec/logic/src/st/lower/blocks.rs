//! Function blocks: their instances, the constant times that these are given, and their calls.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::declare::{Body, names_of, upper};
use super::{Entry, Instance, Lowering, MAX_NESTING, Role, Scope, Slot};
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{
    Arg, Expr, ExprKind, Init, Pou, SectionKind, Stmt, StmtKind, TypeKind, VarDecl,
};
use crate::st::term::{Term, Ty};
use stillpoint_lang::diag::nearest;

impl<'a> Lowering<'a> {
    /// An instance of a block, declared in `around`.
    pub(super) fn instance(
        &mut self,
        decl: &'a VarDecl,
        block: &'a Pou,
        standard: bool,
        around: &'a Pou,
        scope: &Scope<'a>,
    ) -> Checked<Entry<'a>> {
        let name = upper(&block.name.text);
        if self.nesting.contains(&name) {
            return Err(Fault::new(
                &decl.ty.span,
                format!("the block '{}' contains itself", block.name.text),
                "a block cannot be a part of itself",
            ));
        }
        self.works(&decl.name.span)?;
        if self.nesting.len() >= MAX_NESTING {
            return Err(too_deep(&decl.name.span));
        }
        let presets = self.presets(decl, block, around, scope)?;
        let prefix = format!("{}{}.", scope.prefix, decl.name.text);
        let outer = match standard {
            true => self.site.replace(decl.name.span.clone()),
            false => self.site.clone(),
        };
        self.nesting.push(name);
        let inner = self.declare(block, Body::Block { standard }, prefix, &presets);
        self.nesting.pop();
        self.site = outer;
        if let Some(Init::Fields(fields)) = &decl.init {
            for (field, value) in fields {
                self.begins(block, &inner, &presets, field, value, scope)?;
            }
        } else if decl.init.is_some() {
            return Err(Fault::new(
                &decl.name.span,
                "a function block has no single initial value",
                "write `name : TON := (PT := T#1s);`",
            ));
        }
        Ok(Entry::Block(Rc::new(Instance {
            name: format!("{}{}", scope.prefix, decl.name.text),
            pou: block,
            scope: inner,
        })))
    }

    /// A value that an input of an instance begins with.
    fn begins(
        &mut self,
        block: &Pou,
        inner: &Scope<'a>,
        presets: &BTreeMap<String, Term>,
        field: &crate::st::ast::Word,
        value: &Expr,
        scope: &Scope<'a>,
    ) -> Checked<()> {
        let key = upper(&field.text);
        if presets.contains_key(&key) {
            return Ok(());
        }
        match inner.names.get(&key) {
            Some(Entry::Variable(id)) if self.variables[*id].role == Role::BlockInput => {
                let term = self.fixed(value, scope, self.variables[*id].ty, "an initial value")?;
                self.variables[*id].init = term;
                Ok(())
            }
            _ => Err(no_parameter(block, &field.text, &field.span, false)),
        }
    }

    /// The inputs of type TIME without a range: their one value, from the declaration or the calls of the instance.
    fn presets(
        &mut self,
        decl: &'a VarDecl,
        block: &'a Pou,
        around: &'a Pou,
        scope: &Scope<'a>,
    ) -> Checked<BTreeMap<String, Term>> {
        let mut presets = BTreeMap::new();
        let inputs = block
            .sections
            .iter()
            .filter(|s| s.kind == SectionKind::Input);
        for input in inputs.flat_map(|s| &s.variables) {
            if !matches!(input.ty.kind, TypeKind::Time(None)) {
                continue;
            }
            let name = upper(&input.name.text);
            let mut given: Vec<&Expr> = Vec::new();
            if let Some(Init::Fields(fields)) = &decl.init {
                given.extend(
                    fields
                        .iter()
                        .filter(|(f, _)| upper(&f.text) == name)
                        .map(|(_, value)| value),
                );
            }
            find_arguments(&around.body, &upper(&decl.name.text), &name, &mut given);
            let mut known: Option<Term> = None;
            for value in given {
                let term = self.fixed(
                    value,
                    scope,
                    Ty::Time,
                    &format!("{} of a block", input.name.text),
                )?;
                match &known {
                    Some(other) if other.text != term.text => {
                        return Err(Fault::new(
                            &value.span,
                            format!(
                                "'{}' has two values for {}",
                                decl.name.text, input.name.text
                            ),
                            "the time of a block is the same in every call: use two blocks, and choose between their outputs",
                        ));
                    }
                    _ => known = Some(term),
                }
            }
            let Some(term) = known else {
                return Err(Fault::new(
                    &decl.name.span,
                    format!("'{}' is never given {}", decl.name.text, input.name.text),
                    format!(
                        "write it in the call: `{}({} := T#100ms, ...);`",
                        decl.name.text, input.name.text
                    ),
                ));
            };
            presets.insert(name, term);
        }
        Ok(presets)
    }

    /// `t1(IN := x, Q => y);`
    pub(super) fn call_block(
        &mut self,
        target: &Expr,
        args: &'a [Arg],
        span: &Span,
        scope: &Scope<'a>,
    ) -> Checked<()> {
        let instance = match &target.kind {
            ExprKind::Name(name) => match scope.names.get(&upper(name)) {
                Some(Entry::Block(instance)) => instance.clone(),
                Some(Entry::Failed) => return Err(silent(span)),
                Some(_) => {
                    return Err(Fault::new(
                        &target.span,
                        format!("'{name}' is no function block"),
                        "only an instance of a function block is called: declare `name : TON;` under VAR",
                    ));
                }
                None => return Err(self.unknown(name, &target.span, scope)),
            },
            _ => {
                return Err(Fault::new(
                    &target.span,
                    "a block inside a block is called by its own block only",
                    "call the outer block",
                ));
            }
        };
        let mut inputs = Vec::new();
        let mut outputs = Vec::new();
        for arg in args {
            let Some(name) = &arg.name else {
                return Err(Fault::new(
                    &arg.value.span,
                    "values for a block are given by name",
                    format!("write {}", parameters(instance.pou)),
                ));
            };
            let entry = instance.scope.names.get(&upper(&name.text));
            match entry {
                Some(Entry::Failed) => {}
                // A preset, which the instance has since its declaration.
                Some(Entry::Constant(_)) if !arg.out && is_input(instance.pou, &name.text) => {}
                Some(Entry::Variable(id))
                    if self.is_parameter(*id, instance.pou, &name.text, arg.out) =>
                {
                    match arg.out {
                        true => outputs.push((*id, &arg.value)),
                        false => {
                            let term =
                                self.expr(&arg.value, scope, Some(self.variables[*id].ty))?;
                            inputs.push((*id, term, &arg.value.span));
                        }
                    }
                }
                _ => return Err(no_parameter(instance.pou, &name.text, &name.span, arg.out)),
            }
        }
        for (id, term, span) in inputs {
            self.assign(id, term, span)?;
        }
        let standard = instance.scope.standard;
        let outer = match standard {
            true => self.site.replace(self.at(span)),
            false => self.site.clone(),
        };
        self.run_body(instance.pou, &instance.scope);
        self.site = outer;
        for (id, target) in outputs {
            let term = (*self.value(Slot::Variable(id))).clone();
            self.store(target, term, scope)?;
        }
        Ok(())
    }

    fn is_parameter(&self, id: usize, pou: &Pou, name: &str, out: bool) -> bool {
        match out {
            true => self.variables[id].role == Role::BlockOutput,
            false => self.variables[id].role == Role::BlockInput && is_input(pou, name),
        }
    }

    /// Runs a body of its own: its RETURN ends it alone.
    pub(super) fn run_body(&mut self, pou: &'a Pou, scope: &Scope<'a>) {
        let kept = [Slot::Return, Slot::Exit].map(|slot| (slot, self.env.remove(&slot)));
        let loops = std::mem::take(&mut self.loops);
        self.begin_temps(scope);
        self.body(&pou.body, scope);
        self.loops = loops;
        for (slot, value) in kept {
            match value {
                Some(value) => self.env.insert(slot, value),
                None => self.env.remove(&slot),
            };
        }
    }

    /// Variables that begin with their initial values in each run.
    pub(super) fn begin_temps(&mut self, scope: &Scope<'a>) {
        for entry in scope.names.values() {
            let Entry::Variable(id) = *entry else {
                continue;
            };
            if self.variables[id].role == Role::Temp {
                self.set(id, self.variables[id].init.clone());
            }
        }
    }

    /// `t1.Q`
    pub(super) fn member(
        &self,
        base: &Expr,
        member: &crate::st::ast::Word,
        scope: &Scope<'a>,
    ) -> Checked<Entry<'a>> {
        let instance = self.instance_of(base, scope)?;
        match instance.scope.names.get(&upper(&member.text)) {
            Some(Entry::Failed) => Err(silent(&member.span)),
            Some(entry @ Entry::Variable(id))
                if matches!(
                    self.variables[*id].role,
                    Role::BlockInput | Role::BlockOutput
                ) =>
            {
                Ok(entry.clone())
            }
            Some(entry @ Entry::Constant(_)) if is_input(instance.pou, &member.text) => {
                Ok(entry.clone())
            }
            _ => {
                let known: Vec<&str> = ports(instance.pou).map(|(name, _)| name).collect();
                let help = match nearest(&member.text, known.iter().copied()) {
                    Some(near) => format!("did you mean '{}.{near}'?", instance.name),
                    None => format!("{} has {}", instance.pou.name.text, known.join(", ")),
                };
                Err(Fault::new(
                    &member.span,
                    format!(
                        "'{}' has no input or output '{}'",
                        instance.name, member.text
                    ),
                    help,
                ))
            }
        }
    }

    fn instance_of(&self, base: &Expr, scope: &Scope<'a>) -> Checked<Rc<Instance<'a>>> {
        let (name, found) = match &base.kind {
            ExprKind::Name(name) => (name, scope.names.get(&upper(name)).cloned()),
            ExprKind::Member(_, member) => (&member.text, None),
            _ => unreachable_name(base)?,
        };
        match found {
            Some(Entry::Block(instance)) => Ok(instance),
            Some(Entry::Failed) => Err(silent(&base.span)),
            None if matches!(base.kind, ExprKind::Name(_)) => {
                Err(self.unknown(name, &base.span, scope))
            }
            _ => Err(Fault::new(
                &base.span,
                format!("'{name}' is no function block, and has no members"),
                "a dot stands after the name of a function block, as in `t1.Q`",
            )),
        }
    }

    /// A name that stands for nothing.
    pub(super) fn unknown(&self, name: &str, span: &Span, scope: &Scope<'a>) -> Fault {
        let signature = self.signature;
        let ports = [
            ("VAR_INPUT", &signature.inputs),
            ("VAR_OUTPUT", &signature.outputs),
        ];
        let mut ports = ports
            .into_iter()
            .flat_map(|(section, list)| list.iter().map(move |p| (section, p)));
        let port = ports.find(|(_, p)| p.name.eq_ignore_ascii_case(name));
        let help = match port {
            Some((section, port)) => format!(
                "declare it under {section}: `{} : {};`",
                port.name,
                signature.name(port.ty)
            ),
            None => {
                let values = signature
                    .enums
                    .iter()
                    .flat_map(|e| e.values.iter().map(String::as_str));
                let params = signature.params.iter().map(|p| p.name.as_str());
                let known = names_of(&scope.names).chain(values).chain(params);
                match nearest(name, known) {
                    Some(near) => match self.spelt(near, scope) {
                        Some(own) => format!("did you mean '{own}'?"),
                        None => format!("did you mean '{near}'?"),
                    },
                    None => "declare it under VAR: `name : BOOL;`".to_owned(),
                }
            }
        };
        Fault::new(span, format!("'{name}' is not declared"), help).label("not known")
    }

    /// A name of the scope as its declaration has it.
    fn spelt(&self, name: &str, scope: &Scope<'a>) -> Option<&str> {
        match scope.names.get(name)? {
            Entry::Variable(id) => self.variables[*id].name.strip_prefix(scope.prefix.as_str()),
            Entry::Input(term) => {
                let port = self.signature.inputs.iter().find(|p| p.name == term.text)?;
                Some(&port.name)
            }
            _ => None,
        }
    }
}

fn unreachable_name<T>(base: &Expr) -> Checked<T> {
    Err(Fault::new(
        &base.span,
        "a name is needed before the dot",
        "write `t1.Q`",
    ))
}

pub(super) fn too_deep(span: &Span) -> Fault {
    Fault::new(
        span,
        format!("blocks and functions lie more than {MAX_NESTING} deep within one another"),
        "call them one after the other",
    )
}

/// What follows from a fault that has been told.
pub(super) fn silent(span: &Span) -> Fault {
    Fault::new(span, "", "")
}

/// Inputs and outputs of a block, in their order.
fn ports(pou: &Pou) -> impl Iterator<Item = (&str, bool)> {
    let sections = pou.sections.iter();
    sections
        .filter(|s| matches!(s.kind, SectionKind::Input | SectionKind::Output))
        .flat_map(|s| {
            s.variables
                .iter()
                .map(|v| (v.name.text.as_str(), s.kind == SectionKind::Output))
        })
}

fn is_input(pou: &Pou, name: &str) -> bool {
    ports(pou).any(|(port, out)| !out && port.eq_ignore_ascii_case(name))
}

fn parameters(pou: &Pou) -> String {
    let list: Vec<String> = ports(pou)
        .map(|(name, out)| match out {
            true => format!("{name} => variable"),
            false => format!("{name} := value"),
        })
        .collect();
    list.join(", ")
}

fn no_parameter(pou: &Pou, name: &str, span: &Span, out: bool) -> Fault {
    let what = if out { "output" } else { "input" };
    Fault::new(
        span,
        format!("{} has no {what} '{name}'", pou.name.text),
        format!("it takes {}", parameters(pou)),
    )
    .label(format!("no such {what}"))
}

/// The values that calls of an instance give to one of its inputs.
fn find_arguments<'e>(body: &'e [Stmt], instance: &str, input: &str, found: &mut Vec<&'e Expr>) {
    for statement in body {
        match &statement.kind {
            StmtKind::Call(target, args) => {
                if matches!(&target.kind, ExprKind::Name(name) if upper(name) == instance) {
                    let named = |arg: &&Arg| {
                        !arg.out && arg.name.as_ref().is_some_and(|n| upper(&n.text) == input)
                    };
                    found.extend(args.iter().filter(named).map(|arg| &arg.value));
                }
            }
            StmtKind::If(branches, rest) => {
                branches
                    .iter()
                    .for_each(|(_, body)| find_arguments(body, instance, input, found));
                find_arguments(rest, instance, input, found);
            }
            StmtKind::Case(_, branches, rest) => {
                branches
                    .iter()
                    .for_each(|(_, body)| find_arguments(body, instance, input, found));
                find_arguments(rest, instance, input, found);
            }
            StmtKind::For(counted) => find_arguments(&counted.body, instance, input, found),
            StmtKind::Assign(..) | StmtKind::Return | StmtKind::Exit => {}
        }
    }
}
