//! A program with names of its own, such as that of an F-CPU: the machine file says which of its inputs and outputs are connected to what.

use std::collections::HashSet;
use std::sync::Arc;

use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result};

use super::ast::{Expr, ExprKind, File, SectionKind, TypeKind, UnaryOp, VarDecl};
use super::signature::{Port, Signature};
use super::term::Ty;
use crate::Compiled;
use crate::fault::{Checked, Fault};

/// A program that was read; nothing is known yet of what it is connected to.
#[derive(Clone)]
pub struct Program {
    file: String,
    source: Arc<str>,
    tree: File,
}

/// How the variables of a program are connected to a machine of the tables.
#[derive(Debug, Clone)]
pub struct Interface {
    /// The machine that the program takes the place of; its ports here are of type BOOL.
    pub signature: Signature,
    /// Inputs of the program, each with the input of the machine that it is. Any other input is free.
    pub inputs: Vec<(String, String)>,
    /// All outputs of the machine: each by its name, with what it gives.
    pub outputs: Vec<(String, Output)>,
}

/// What an output of the machine gives.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Output {
    /// Always the same.
    Constant(bool),
    /// An output of the program.
    Variable {
        /// Its name.
        variable: String,
        /// Whether the output of the machine is TRUE where it is FALSE.
        inverted: bool,
    },
}

/// An input or output of a program that is of type BOOL, and so can be connected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signal {
    /// As the program declares it.
    pub name: String,
    /// Whether the program gives it.
    pub given: bool,
}

impl Program {
    /// Reads a program; `file` names it in errors and in the texts of the table.
    ///
    /// # Errors
    /// An error of form, or an input that cannot be free.
    pub fn read(file: &str, source: &Arc<str>) -> Result<Self> {
        let tree = super::read(file, source)?;
        let program = Self {
            file: file.to_owned(),
            source: source.clone(),
            tree,
        };
        let wrong = program.declared(SectionKind::Input);
        let wrong = wrong.filter_map(|decl| values(decl).err());
        let wrong: Vec<Diagnostic> = wrong.map(|f| f.told(file, source)).collect();
        match wrong.is_empty() {
            true => Ok(program),
            false => Err(Diagnostics(wrong)),
        }
    }

    fn declared(&self, kind: SectionKind) -> impl Iterator<Item = &VarDecl> {
        let sections = self.tree.program.sections.iter();
        let sections = sections.filter(move |section| section.kind == kind);
        sections.flat_map(|section| &section.variables)
    }

    /// What can be connected, in the order of the program.
    pub fn signals(&self) -> Vec<Signal> {
        let of = |kind, given| {
            let all = self.declared(kind);
            let all = all.filter(|decl| matches!(decl.ty.kind, TypeKind::Bool));
            all.map(move |decl| Signal {
                name: decl.name.text.clone(),
                given,
            })
        };
        of(SectionKind::Input, false)
            .chain(of(SectionKind::Output, true))
            .collect()
    }

    /// The table that takes the place of a machine.
    ///
    /// # Errors
    /// Everything that is wrong in the program, with its place; an interface that does not fit.
    pub fn compile(&self, interface: &Interface) -> Result<Compiled> {
        let unplaced = |message: String| {
            let fault = Diagnostic::new(&self.file, &self.source, None, message);
            Diagnostics::from(fault.help("connect inputs and outputs of the program, each once"))
        };
        let signals = self.signals();
        let has = |name: &str, given| {
            let mut all = signals.iter();
            all.any(|s| s.given == given && s.name.eq_ignore_ascii_case(name))
        };
        let mut signature = interface.signature.clone();
        let mut taken = signature.names();
        let ports = std::mem::take(&mut signature.inputs);
        let mut connected = HashSet::new();
        for (variable, port) in &interface.inputs {
            let found = ports.iter().find(|known| known.name == *port);
            let Some(found) = found.filter(|port| port.ty == Ty::Bool && has(variable, false))
            else {
                return Err(unplaced(format!(
                    "'{variable}' cannot be the input '{port}'"
                )));
            };
            if !connected.insert(variable.to_ascii_uppercase()) {
                return Err(unplaced(format!("'{variable}' is connected to two inputs")));
            }
            signature.inputs.push(Port {
                called: Some(variable.clone()),
                ..found.clone()
            });
        }
        for decl in self.declared(SectionKind::Input) {
            let variable = &decl.name.text;
            if connected.contains(&variable.to_ascii_uppercase()) {
                continue;
            }
            let (ty, (low, high)) = values(decl).map_err(|f| f.told(&self.file, &self.source))?;
            let mut name = format!("in_{}", variable.to_ascii_lowercase());
            while !taken.insert(name.clone()) {
                name.push('_');
            }
            signature.inputs.push(Port {
                name,
                ty,
                low,
                high,
                added: Some(variable.clone()),
                called: Some(variable.clone()),
            });
        }
        for port in &signature.outputs {
            let mut given = interface.outputs.iter();
            let given = given.find(|(name, _)| *name == port.name);
            let fits = given.is_some_and(|(_, output)| match output {
                Output::Constant(_) => port.ty == Ty::Bool,
                Output::Variable { variable, .. } => port.ty == Ty::Bool && has(variable, true),
            });
            if !fits {
                let message = format!("nothing of the program gives the output '{}'", port.name);
                return Err(unplaced(message));
            }
        }
        signature.given = Some(interface.outputs.clone());
        super::lowered(&self.file, &self.source, &self.tree, &signature)
    }
}

/// The type and the values of an input of the program that nothing is connected to.
fn values(decl: &VarDecl) -> Checked<(Ty, (i64, i64))> {
    let range = match &decl.ty.kind {
        TypeKind::Bool => return Ok((Ty::Bool, (0, 1))),
        TypeKind::Int(_, Some(bounds)) => (number(&bounds.0), number(&bounds.1)),
        _ => (None, None),
    };
    match range {
        (Some(low), Some(high)) if low <= high => Ok((Ty::Int, (low, high))),
        _ => Err(Fault::new(
            &decl.ty.span,
            format!("every value of the input '{}' is explored", decl.name.text),
            format!(
                "declare it as BOOL, or with the numbers of its range: `{} : INT (0..7);`",
                decl.name.text
            ),
        )
        .label("neither BOOL nor INT with a range")),
    }
}

/// A number as it is written.
fn number(written: &Expr) -> Option<i64> {
    match &written.kind {
        ExprKind::Int(value) => Some(*value),
        ExprKind::Unary(UnaryOp::Neg, of) => number(of).map(|value| -value),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stillpoint_lang::Spec;

    const TABLES: &str = r#"
spec   = "t/t"
title  = "t"
source = "t"

[machine.cpu]
text      = "t"
otherwise = "stay"

[machine.cpu.input]
door  = "BOOL"
reset = "BOOL"

[machine.cpu.output]
sto = "door"
ss1 = "reset"

[system.s]
text  = "t"
cycle = "1 ms"

[system.s.instance]
cpu = { machine = "cpu" }

[system.s.free]
ports = ["cpu.*"]
"#;

    fn compiled(source: &str, inputs: &[(&str, &str)], sto: Output) -> Result<String> {
        let mut spec =
            Spec::from_text(std::path::Path::new("t.toml"), TABLES.into()).expect("right");
        let signature = Signature::of(&spec, "cpu")?;
        let owned = |(a, b): &(&str, &str)| ((*a).to_owned(), (*b).to_owned());
        let interface = Interface {
            signature,
            inputs: inputs.iter().map(owned).collect(),
            outputs: vec![
                ("sto".to_owned(), sto),
                ("ss1".to_owned(), Output::Constant(true)),
            ],
        };
        let source: Arc<str> = source.into();
        let table = Program::read("p.st", &source)?.compile(&interface)?;
        let name = toml::Spanned::new(0..0, "cpu".to_owned());
        spec.replace("p.st", &source, &name, &table.machine)?;
        let system = spec.system("s", None)?;
        let names: Vec<&str> = system.inputs.iter().map(|i| i.name.as_str()).collect();
        Ok(names.join(" "))
    }

    const PROGRAM: &str = "PROGRAM p VAR_INPUT contact, door : BOOL; mode : INT (0..2); END_VAR VAR_OUTPUT Q : BOOL; n : INT (0..3); END_VAR
        Q := contact AND NOT (door AND mode = 2); IF NOT Q THEN RETURN; END_IF; n := mode; END_PROGRAM";

    fn variable(name: &str) -> Output {
        Output::Variable {
            variable: name.to_owned(),
            inverted: true,
        }
    }

    /// A port is known by the name of the program alone, and what else the program reads is free.
    #[test]
    fn names_are_those_of_the_program() {
        let inputs = compiled(PROGRAM, &[("CONTACT", "door")], variable("q")).expect("right");
        assert_eq!(inputs, "cpu.in_door cpu.in_mode cpu.door cpu.reset");
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let told = |inputs: &[(&str, &str)], sto| {
            let told = compiled(PROGRAM, inputs, sto).expect_err("wrong");
            told.0
                .first()
                .map(|d| d.message.clone())
                .unwrap_or_default()
        };
        for (inputs, sto, message) in [
            (
                &[("q", "door")][..],
                variable("q"),
                "'q' cannot be the input 'door'",
            ),
            (
                &[("mode", "door")],
                variable("q"),
                "'mode' cannot be the input 'door'",
            ),
            (
                &[("door", "lid")],
                variable("q"),
                "'door' cannot be the input 'lid'",
            ),
            (
                &[("door", "door"), ("Door", "reset")],
                variable("q"),
                "'Door' is connected to two inputs",
            ),
            (
                &[],
                variable("n"),
                "nothing of the program gives the output 'sto'",
            ),
            (
                &[],
                variable("door"),
                "nothing of the program gives the output 'sto'",
            ),
        ] {
            assert_eq!(told(inputs, sto), message);
        }
        let free = "PROGRAM p VAR_INPUT t : TIME; END_VAR VAR_OUTPUT q : BOOL; END_VAR q := TRUE; END_PROGRAM";
        let told = compiled(free, &[], variable("q")).expect_err("wrong");
        assert!(
            told.to_string()
                .contains("every value of the input 't' is explored"),
            "{told}"
        );
    }
}
