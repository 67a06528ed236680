//! What a program is told, what it must answer, and which names of the family it may use.

use stillpoint_lang::Spec;
use stillpoint_lang::diag::Result;
use stillpoint_lang::ir::{self, LazyKind, Node};
use stillpoint_lang::syntax::{ast::TypeKind, parse_type};

use crate::st::program::Output;
use crate::st::term::{Term, Ty};

/// The interface of a machine of the tables, which a program takes the place of.
#[derive(Debug, Clone)]
pub struct Signature {
    pub(crate) enums: Vec<Enum>,
    pub(crate) inputs: Vec<Port>,
    pub(crate) outputs: Vec<Port>,
    /// Parameters of the machine, and the options of readings, which are BOOL.
    pub(crate) params: Vec<Port>,
    /// What the outputs of the machine give, where the program has outputs by names of its own; else they have the same names.
    pub(crate) given: Option<Vec<(String, Output)>>,
    /// Whether times that nothing starts which the machine is told are inputs of the table.
    pub(crate) loose: bool,
}

#[derive(Debug, Clone)]
pub(crate) struct Enum {
    pub name: String,
    pub values: Vec<String>,
}

#[derive(Debug, Clone)]
pub(crate) struct Port {
    pub name: String,
    pub ty: Ty,
    pub low: i64,
    pub high: i64,
    /// Of an input that a program adds to those of the machine: its variable.
    pub added: Option<String>,
    /// Of an input that a program knows by another name: that one.
    pub called: Option<String>,
}

impl Port {
    /// Whether a program means it by this name; names have no case.
    pub fn is_called(&self, name: &str) -> bool {
        self.called
            .as_ref()
            .unwrap_or(&self.name)
            .eq_ignore_ascii_case(name)
    }

    /// Its value, where it can be read.
    pub fn term(&self, fixed: bool) -> Term {
        let mut term = Term::leaf(self.name.clone(), self.ty, self.low, self.high);
        term.fixed = fixed;
        term
    }
}

impl Signature {
    /// The interface of a machine of a specification.
    ///
    /// # Errors
    /// There is no such machine, or something is wrong with it.
    pub fn of(spec: &Spec, machine: &str) -> Result<Self> {
        let system = spec.open_machine(machine)?;
        let outline = spec.outline();
        let ports = outline.machines.into_iter().find(|m| m.name == machine);
        let (inputs, params) = ports.map_or_else(Default::default, |m| (m.inputs, m.params));
        let enums = system.enums.iter().map(|e| Enum {
            name: e.name.clone(),
            values: e.values.clone(),
        });
        let prefix = format!("{machine}.");
        let input = |port: &stillpoint_lang::outline::Port| {
            let full = format!("{prefix}{}", port.name);
            let var = system.inputs.iter().find(|v| v.name == full)?;
            Some(of_var(&port.name, &port.ty, var))
        };
        let param = |p: &ir::Param| {
            let written = params.iter().find(|port| port.name == p.var.name);
            (p.reading.is_some() || written.is_some())
                .then(|| of_var(&p.var.name, written.map_or("BOOL", |port| &port.ty), &p.var))
        };
        let output = |lazy: &ir::Lazy| {
            let name = lazy.name.strip_prefix(&prefix)?;
            (lazy.kind == LazyKind::Output).then(|| Port {
                name: name.to_owned(),
                ty: of_ir(lazy.ty, false),
                low: lazy.lo,
                high: lazy.hi,
                added: None,
                called: None,
            })
        };
        Ok(Self {
            enums: enums.collect(),
            inputs: inputs.iter().filter_map(input).collect(),
            outputs: system.lazies.iter().filter_map(output).collect(),
            params: system.params.iter().filter_map(param).collect(),
            given: None,
            loose: false,
        })
    }

    /// The same for a table that says less: a time of the program is whatever it may be in each cycle, unless an input of the machine has
    /// a say in it. What such a table can do includes all that the program does.
    #[must_use]
    pub fn loose(self) -> Self {
        Self {
            loose: true,
            ..self
        }
    }

    /// Names of the table that a program cannot give to anything else.
    pub(crate) fn names(&self) -> std::collections::HashSet<String> {
        let ports = self.inputs.iter().chain(&self.outputs).chain(&self.params);
        let values = self.enums.iter().flat_map(|e| e.values.iter().cloned());
        ports.map(|p| p.name.clone()).chain(values).collect()
    }

    /// The name of a type, as a program writes it.
    pub(crate) fn name(&self, ty: Ty) -> &str {
        match ty {
            Ty::Bool => "BOOL",
            Ty::Int => "INT",
            Ty::Time => "TIME",
            Ty::Enum(k) => self.enums.get(k).map_or("enum", |e| &e.name),
        }
    }

    /// The enum of this name, however it is written.
    pub(crate) fn enum_named(&self, name: &str) -> Option<usize> {
        self.enums
            .iter()
            .position(|e| e.name.eq_ignore_ascii_case(name))
    }

    /// A value of an enum.
    pub(crate) fn value(&self, of: usize, name: &str) -> Option<Term> {
        let found = self.enums.get(of)?;
        let ordinal = found
            .values
            .iter()
            .position(|v| v.eq_ignore_ascii_case(name))?;
        let text = format!("{}#{}", found.name, found.values[ordinal]);
        let ordinal = ordinal as i64;
        Some(Term::leaf(text, Ty::Enum(of), ordinal, ordinal).known())
    }
}

fn of_ir(ty: ir::Ty, time: bool) -> Ty {
    match ty {
        ir::Ty::Bool => Ty::Bool,
        ir::Ty::Int if time => Ty::Time,
        ir::Ty::Int => Ty::Int,
        ir::Ty::Enum(k) => Ty::Enum(k),
    }
}

fn of_var(name: &str, written: &str, var: &ir::Var) -> Port {
    let time = matches!(parse_type(written).map(|t| t.kind), Ok(TypeKind::Time(_)));
    let constant = |node: &Node, other: i64| match node {
        Node::Const(v) => *v,
        _ => other,
    };
    Port {
        name: name.to_owned(),
        ty: of_ir(var.ty, time),
        low: constant(&var.lo, i64::from(-i32::MAX)),
        high: constant(&var.hi, i64::from(i32::MAX)),
        added: None,
        called: None,
    }
}
