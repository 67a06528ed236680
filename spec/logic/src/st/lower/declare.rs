//! Declarations: the variables of a program, block or function, with their types, ranges and initial values.

use std::collections::BTreeMap;

use super::{Entry, Lowering, Names, Role, Scope, Slot, Variable};
use crate::fault::{Checked, Fault};
use crate::st::ast::{Bounds, Init, Language, Pou, SectionKind, TypeKind, TypeRef, VarDecl, Word};
use crate::st::term::{Term, Ty, Use};
use stillpoint_lang::diag::nearest;

/// What kind of body the variables belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Body {
    Program,
    Block { standard: bool },
    Function,
}

/// A type that was looked up.
pub(super) enum Shape<'a> {
    Value(Ty, Option<(Term, Term)>),
    Clock(Term, Term),
    Kept(Term, Term),
    Block(&'a Pou, bool),
}

impl<'a> Lowering<'a> {
    /// The names of the program, which has exactly the outputs of the signature.
    pub(super) fn program(&mut self, pou: &'a Pou) -> Scope<'a> {
        let scope = self.declare(pou, Body::Program, String::new(), &BTreeMap::new());
        let signature = self.signature;
        if signature.given.is_some() {
            return scope;
        }
        let missing: Vec<String> = (signature.outputs.iter())
            .filter(|port| !matches!(scope.names.get(&upper(&port.name)), Some(Entry::Variable(id)) if self.variables[*id].role == Role::Output)
                && !matches!(scope.names.get(&upper(&port.name)), Some(Entry::Failed)))
            .map(|port| format!("{} : {}", port.name, signature.name(port.ty)))
            .collect();
        if !missing.is_empty() {
            self.fault(
                Fault::new(
                    &pou.name.span,
                    format!(
                        "program '{}' lacks outputs that the safety kernel reads",
                        pou.name.text
                    ),
                    format!(
                        "declare them under VAR_OUTPUT and assign them: {};",
                        missing.join("; ")
                    ),
                )
                .label("not all outputs"),
            );
        }
        scope
    }

    /// An output that nothing assigns is a mistake.
    pub(super) fn unassigned(&mut self, scope: &Scope<'a>) {
        let outputs = scope.names.values().filter_map(|entry| match entry {
            Entry::Variable(id) if self.variables[*id].role == Role::Output => Some(*id),
            _ => None,
        });
        let silent = outputs.filter(|id| !self.env.contains_key(&Slot::Variable(*id)));
        for id in silent.collect::<Vec<usize>>() {
            let Variable {
                name, span, init, ..
            } = &self.variables[id];
            let fault = Fault::new(
                span,
                format!("the output '{name}' is never assigned"),
                format!(
                    "assign it; if it is always the same: `{name} := {};`",
                    init.text
                ),
            );
            self.fault(fault);
        }
    }

    /// Declares everything of a body. `presets` are the constant times of an instance.
    pub(super) fn declare(
        &mut self,
        pou: &'a Pou,
        body: Body,
        prefix: String,
        presets: &BTreeMap<String, Term>,
    ) -> Scope<'a> {
        let mut scope = Scope {
            names: presets
                .iter()
                .map(|(name, term)| (name.clone(), Entry::Constant(term.clone())))
                .collect(),
            prefix,
            standard: body == Body::Block { standard: true },
        };
        let mut instances = Vec::new();
        for section in &pou.sections {
            for decl in &section.variables {
                let name = upper(&decl.name.text);
                if presets.contains_key(&name) {
                    continue;
                }
                if scope.names.contains_key(&name) {
                    self.fault(Fault::new(
                        &decl.name.span,
                        format!("'{}' is declared twice", decl.name.text),
                        "names differ by more than upper and lower case; choose another one",
                    ));
                    continue;
                }
                let made = self.variable(section.kind, decl, body, &scope);
                let entry = match self.note(made) {
                    // Blocks come last: their constants may stand below them.
                    Some(Declared::Instance(block, standard)) => {
                        instances.push((decl, block, standard));
                        continue;
                    }
                    Some(Declared::Entry(entry)) => entry,
                    None => Entry::Failed,
                };
                scope.names.insert(name, entry);
            }
        }
        for (decl, block, standard) in instances {
            let made = self.instance(decl, block, standard, pou, &scope);
            let entry = self.note(made).unwrap_or(Entry::Failed);
            scope.names.insert(upper(&decl.name.text), entry);
        }
        scope
    }

    fn variable(
        &mut self,
        kind: SectionKind,
        decl: &'a VarDecl,
        body: Body,
        scope: &Scope<'a>,
    ) -> Checked<Declared<'a>> {
        if kind == SectionKind::Constant {
            return self.constant(decl, scope).map(Declared::Entry);
        }
        let (ty, bounds, clock) = match self.shape(&decl.ty, scope)? {
            Shape::Block(block, standard)
                if kind == SectionKind::Local && body != Body::Function =>
            {
                return Ok(Declared::Instance(block, standard));
            }
            Shape::Block(..) => {
                return Err(Fault::new(
                    &decl.ty.span,
                    "a function block cannot stand in this section",
                    "declare it under VAR ... END_VAR of the program or of a function block",
                ));
            }
            Shape::Clock(low, high) => (Ty::Time, Some((low, high)), true),
            Shape::Kept(low, high) => (Ty::Time, Some((low, high)), false),
            Shape::Value(ty, bounds) => (ty, bounds, false),
        };
        let name = &decl.name.text;
        if body == Body::Program && kind == SectionKind::Input {
            return self.input(decl, ty, bounds.as_ref()).map(Declared::Entry);
        }
        let role = match (kind, body) {
            (_, Body::Function) | (SectionKind::Temp, _) => Role::Temp,
            _ if clock => Role::Clock,
            (SectionKind::Input, _) => Role::BlockInput,
            (SectionKind::Output, Body::Program) => Role::Output,
            (SectionKind::Output, _) => Role::BlockOutput,
            (_, Body::Block { standard: true }) => Role::Standard,
            _ if matches!(decl.ty.kind, TypeKind::Kept(_)) => Role::Standard,
            _ => Role::Local,
        };
        let declared = bounds.clone();
        let bounds = match role {
            Role::Output => self.output(decl, ty, bounds.clone())?,
            Role::Temp => bounds,
            _ if matches!(ty, Ty::Int | Ty::Time) && bounds.is_none() => {
                return Err(no_range(&decl.ty));
            }
            _ => bounds,
        };
        let init = match &decl.init {
            Some(Init::Value(init)) => self.fixed(init, scope, ty, "an initial value")?,
            Some(Init::Fields(_)) => {
                return Err(Fault::new(
                    &decl.ty.span,
                    "only a function block has initial values for its inputs",
                    "write one value after `:=`",
                ));
            }
            None => self.initial(decl, ty, declared.as_ref())?,
        };
        if let Some((low, high)) = &bounds {
            if init.high < low.low || init.low > high.high {
                return Err(Fault::new(
                    &decl.name.span,
                    format!(
                        "'{name}' begins with {}, which its range {}..{} does not hold",
                        init.text, low.text, high.text
                    ),
                    "choose a value of the range",
                ));
            }
        }
        let full = format!("{}{name}", scope.prefix);
        let base = match role {
            Role::Output => format!("{full}_before"),
            _ => full.clone(),
        };
        let table = self.fresh(&base);
        self.variables.push(Variable {
            name: decl.title.clone().unwrap_or(full),
            table,
            ty,
            bounds,
            init,
            role,
            span: decl.name.span.clone(),
        });
        Ok(Declared::Entry(Entry::Variable(self.variables.len() - 1)))
    }

    fn constant(&mut self, decl: &VarDecl, scope: &Scope<'a>) -> Checked<Entry<'a>> {
        let Shape::Value(ty, bounds) = self.shape(&decl.ty, scope)? else {
            return Err(Fault::new(
                &decl.ty.span,
                "a function block is no constant",
                "declare it under VAR ... END_VAR",
            ));
        };
        let Some(Init::Value(init)) = &decl.init else {
            return Err(Fault::new(
                &decl.name.span,
                format!("the constant '{}' has no value", decl.name.text),
                "write `name : type := value;`",
            ));
        };
        let term = self.fixed(init, scope, ty, "a constant")?;
        if let Some((low, high)) = bounds {
            if term.low < low.low || term.high > high.high {
                return Err(Fault::new(
                    &init.span,
                    format!("{} is outside {}..{}", term.text, low.text, high.text),
                    "choose a value of the range",
                ));
            }
        }
        Ok(Entry::Constant(term))
    }

    /// An input of the program is one of the signature, with its type.
    fn input(&self, decl: &VarDecl, ty: Ty, bounds: Option<&(Term, Term)>) -> Checked<Entry<'a>> {
        let signature = self.signature;
        let port = self.port(&signature.inputs, &decl.name, "input", "VAR_INPUT")?;
        self.same_type(decl, ty, port.ty)?;
        if bounds.is_some_and(|(low, high)| low.high > port.low || high.low < port.high) {
            return Err(Fault::new(
                &decl.ty.span,
                format!(
                    "the input '{}' can be {}..{}",
                    decl.name.text, port.low, port.high
                ),
                "declare it with this range, or without one",
            ));
        }
        if decl.init.is_some() {
            return Err(Fault::new(
                &decl.name.span,
                format!("the input '{}' has an initial value", decl.name.text),
                "leave it out: what an input is in each cycle comes from the machine",
            ));
        }
        let index = signature.inputs.iter().position(|p| p.name == port.name);
        let read = Use::Input(index.unwrap_or_default());
        Ok(Entry::Input(port.term(false).reading(read)))
    }

    /// An output of the program is one of the signature, with its type; it has the range of its declaration, else the signature's.
    fn output(
        &self,
        decl: &VarDecl,
        ty: Ty,
        declared: Option<(Term, Term)>,
    ) -> Checked<Option<(Term, Term)>> {
        if self.signature.given.is_some() {
            return match (ty, declared) {
                (Ty::Int | Ty::Time, None) => Err(no_range(&decl.ty)),
                (_, declared) => Ok(declared),
            };
        }
        let port = self.port(&self.signature.outputs, &decl.name, "output", "VAR_OUTPUT")?;
        self.same_type(decl, ty, port.ty)?;
        let number = |value| Term::number(value, ty);
        let whole =
            || matches!(ty, Ty::Int | Ty::Time).then(|| (number(port.low), number(port.high)));
        Ok(declared.or_else(whole))
    }

    fn port(
        &self,
        ports: &'a [crate::st::signature::Port],
        name: &Word,
        what: &str,
        section: &str,
    ) -> Checked<&'a crate::st::signature::Port> {
        if let Some(port) = ports.iter().find(|p| p.is_called(&name.text)) {
            return Ok(port);
        }
        let known = || ports.iter().map(|p| p.name.as_str());
        let help = match nearest(&name.text, known()) {
            Some(near) => {
                format!("did you mean '{near}'? What is only used inside belongs under VAR")
            }
            None => format!(
                "under {section} stand only: {}. What is only used inside belongs under VAR",
                known().collect::<Vec<_>>().join(", ")
            ),
        };
        Err(Fault::new(
            &name.span,
            format!("the safe PLC has no {what} '{}'", name.text),
            help,
        )
        .label(format!("no such {what}")))
    }

    fn same_type(&self, decl: &VarDecl, is: Ty, wanted: Ty) -> Checked<()> {
        if is == wanted {
            return Ok(());
        }
        let wanted = self.signature.name(wanted);
        Err(Fault::new(
            &decl.ty.span,
            format!(
                "'{}' is of type {wanted}, not {}",
                decl.name.text,
                self.signature.name(is)
            ),
            format!("write `{} : {wanted};`", decl.name.text),
        )
        .label("another type"))
    }

    /// What a variable begins with where nothing is said: FALSE, 0, the first value.
    fn initial(&self, decl: &VarDecl, ty: Ty, bounds: Option<&(Term, Term)>) -> Checked<Term> {
        match ty {
            Ty::Bool => Ok(Term::bool(false)),
            Ty::Enum(of) => {
                let first = self.signature.enums[of].values.first();
                let value = first.and_then(|name| self.signature.value(of, name));
                Ok(value.unwrap_or_else(|| Term::number(0, ty)))
            }
            Ty::Int | Ty::Time => match bounds {
                Some((low, high)) if low.low > 0 || high.high < 0 || low.low < 0 => {
                    Err(Fault::new(
                        &decl.name.span,
                        format!(
                            "with what does '{}' begin? Its range does not start at 0",
                            decl.name.text
                        ),
                        "write the initial value: `name : INT (1..5) := 1;`",
                    ))
                }
                _ => Ok(Term::number(0, ty)),
            },
        }
    }

    /// What a type names.
    pub(super) fn shape(&mut self, ty: &TypeRef, scope: &Scope<'a>) -> Checked<Shape<'a>> {
        let shape = match &ty.kind {
            TypeKind::Bool => Shape::Value(Ty::Bool, None),
            TypeKind::Int(_, bounds) => Shape::Value(Ty::Int, self.bounds(bounds, scope, Ty::Int)?),
            TypeKind::Time(bounds) => Shape::Value(Ty::Time, self.bounds(bounds, scope, Ty::Time)?),
            TypeKind::Named(name) => {
                if let Some(of) = self.signature.enum_named(name) {
                    return Ok(Shape::Value(Ty::Enum(of), None));
                }
                let same = |pou: &&Pou| pou.name.text.eq_ignore_ascii_case(name);
                if let Some(own) = self.tree.blocks.iter().find(same) {
                    return Ok(Shape::Block(own, false));
                }
                if let Some(block) = self.standard().iter().find(same) {
                    return Ok(Shape::Block(block, true));
                }
                return Err(self.no_type(name, ty));
            }
            TypeKind::Clock(bounds)
                if scope.standard || self.tree.language == Language::StatementList =>
            {
                match self.bounds(bounds, scope, Ty::Time)? {
                    Some((low, high)) => Shape::Clock(low, high),
                    None => return Err(no_range(ty)),
                }
            }
            TypeKind::Kept(bounds) => match self.bounds(bounds, scope, Ty::Time)? {
                Some((low, high)) => Shape::Kept(low, high),
                None => return Err(no_range(ty)),
            },
            TypeKind::Clock(_) => return Err(self.no_type("CLOCK", ty)),
        };
        Ok(shape)
    }

    fn no_type(&self, name: &str, ty: &TypeRef) -> Fault {
        let enums = self.signature.enums.iter().map(|e| e.name.as_str());
        let pous = self.tree.blocks.iter().chain(self.standard());
        let known = ["BOOL", "INT", "TIME"].into_iter();
        let known: Vec<&str> = known
            .chain(enums)
            .chain(pous.map(|p| p.name.text.as_str()))
            .collect();
        let help = match nearest(name, known.iter().copied()) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!("types are {}", known.join(", ")),
        };
        Fault::new(&ty.span, format!("there is no type '{name}'"), help)
    }

    fn bounds(
        &mut self,
        bounds: &Bounds,
        scope: &Scope<'a>,
        ty: Ty,
    ) -> Checked<Option<(Term, Term)>> {
        let Some(written) = bounds else {
            return Ok(None);
        };
        let low = self.fixed(&written.0, scope, ty, "the end of a range")?;
        let high = self.fixed(&written.1, scope, ty, "the end of a range")?;
        if low.low > high.high {
            let span = written.0.span.start..written.1.span.end;
            return Err(Fault::new(
                &span,
                format!("the range {}..{} is empty", low.text, high.text),
                "the smaller value comes first",
            ));
        }
        Ok(Some((low, high)))
    }
}

pub(super) enum Declared<'a> {
    Entry(Entry<'a>),
    Instance(&'a Pou, bool),
}

fn no_range(ty: &TypeRef) -> Fault {
    let (name, example) = match ty.kind {
        TypeKind::Int(ref name, _) => (name.as_str(), format!("{name} (0..7)")),
        _ => ("TIME", "TIME (T#0s..T#5s)".to_owned()),
    };
    Fault::new(
        &ty.span,
        format!("{name} without a range has too many values to explore"),
        format!(
            "say which it can have: `{example}`; a value outside it is then a fault that is found"
        ),
    )
    .label("needs a range")
}

/// Names have no case.
pub(super) fn upper(name: &str) -> String {
    name.to_ascii_uppercase()
}

/// The names near to one that is not known.
pub(super) fn names_of<'n>(names: &'n Names<'_>) -> impl Iterator<Item = &'n str> {
    names.keys().map(String::as_str)
}
