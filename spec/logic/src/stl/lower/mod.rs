//! From a program to the syntax tree of Structured Text, and through its translation to a table.
//!
//! A cycle of the tree is a cycle of the PLC, OB1 with everything that it calls. Blocks stand where they are called.

mod calls;
mod flow;
mod numbers;
mod timers;
mod unit;
mod wiring;

use std::collections::BTreeMap;

use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result};

use super::ast::{Block, Op, Unit};
use super::interface::{Interface, Output, Uses};
use super::operand::Cell;
use super::{Bit, Program};
use crate::Compiled;
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{Expr, File, Language, Pou, Section, SectionKind, Stmt, TypeKind, VarDecl};
use crate::st::lower::lower;
use crate::tree::{assign, bounds, name, not, number, only_if, truth, variable, word};
use timers::Timer;
use wiring::{Role, Wiring};

/// Blocks within one another.
const MOST_CALLS: usize = 16;

/// Instructions that are run, with those of called blocks counted each time.
const MOST_WORK: usize = 40_000;

/// More faults than these help nobody.
const MAX_FAULTS: usize = 40;

impl Program {
    /// The table that takes the place of a machine.
    ///
    /// # Errors
    /// What has no meaning, with its place; an interface that does not fit the machine or the program.
    pub fn compile(&self, interface: &Interface) -> Result<Compiled> {
        let told = |fault: Fault| match fault.span {
            // What is wrong with the interface stands nowhere in the program.
            Span { start: 0, end: 0 } => {
                Diagnostic::new(&self.file, &self.source, None, fault.message).help(fault.help)
            }
            _ => fault.told(&self.file, &self.source),
        };
        let all = |mut faults: Vec<Fault>| {
            faults.sort_by_key(|fault| fault.span.start);
            faults.dedup();
            faults.truncate(MAX_FAULTS);
            Diagnostics(faults.into_iter().map(told).collect())
        };
        let mut faults = Vec::new();
        let mut uses = self.uses();
        // A bit that nothing names may be written with its byte.
        for (_, output) in &interface.outputs {
            if let Output::Bit { bit, .. } = output {
                let mut cells = uses.cells.iter();
                if cells.any(|(cell, places)| places.written.is_some() && bit.lies_in(*cell)) {
                    uses.bits.entry(*bit).or_default();
                }
            }
        }
        let wiring = Wiring::new(self, interface, &uses, &mut faults);
        let mut making = Making {
            program: self,
            interface,
            uses,
            wiring,
            timers: BTreeMap::new(),
            kept: Vec::new(),
            temps: Vec::new(),
            faults,
            calling: Vec::new(),
            work: 0,
            calls: 0,
        };
        let tree = making.file();
        match making.faults.is_empty() {
            true => lower(&self.file, &self.source, &tree, &making.wiring.signature).map_err(all),
            false => Err(all(making.faults)),
        }
    }

    fn unit(&self, block: &Block) -> Option<&Unit> {
        self.units.iter().find(|unit| unit.block == *block)
    }

    /// What runs in each cycle.
    fn main(&self) -> Checked<&Unit> {
        let organization = |unit: &&Unit| matches!(unit.block, Block::Ob(_));
        for unit in self.units.iter().filter(organization) {
            if !matches!(unit.block, Block::Ob(1 | 40 | 100)) {
                return Err(Fault::new(
                    &unit.name.span,
                    format!("{} is not run", unit.block),
                    "the safe logic runs in OB 1, or in OB 40; OB 100 prepares it",
                ));
            }
        }
        match (self.unit(&Block::Ob(1)), self.unit(&Block::Ob(40))) {
            (Some(_), Some(second)) => {
                return Err(Fault::new(
                    &second.name.span,
                    "OB 1 and OB 40 both stand there: one interrupts the other",
                    "leave the one in that the safe logic runs in; what the other one writes is then an input",
                ));
            }
            (Some(main), None) | (None, Some(main)) => return Ok(main),
            (None, None) => {}
        }
        let called = |block: &Block| {
            let all = self.units.iter().flat_map(|unit| &unit.body);
            all.filter_map(|instruction| match &instruction.op {
                Op::Call(call) => Some(&call.block),
                _ => None,
            })
            .any(|called| called == block)
        };
        let free = |unit: &&Unit| !organization(unit) && !called(&unit.block);
        let mut roots = self.units.iter().filter(free);
        match (roots.next(), roots.next()) {
            (Some(main), None) => Ok(main),
            (Some(_), Some(second)) => Err(Fault::new(
                &second.name.span,
                "nothing says in which order the blocks run",
                "add `ORGANIZATION_BLOCK OB 1` with a CALL of each",
            )),
            _ => Err(Fault::new(
                &self
                    .units
                    .first()
                    .map_or(0..0, |unit| unit.name.span.clone()),
                "nothing says which block runs in each cycle",
                "add `ORGANIZATION_BLOCK OB 1` with a CALL of it",
            )),
        }
    }
}

/// A tree that is being made.
struct Making<'p> {
    program: &'p Program,
    interface: &'p Interface,
    uses: Uses,
    wiring: Wiring,
    timers: BTreeMap<u16, Timer>,
    /// Variables that keep their values, and those that do not.
    kept: Vec<VarDecl>,
    temps: Vec<VarDecl>,
    faults: Vec<Fault>,
    /// Blocks around.
    calling: Vec<Block>,
    work: usize,
    /// Calls of blocks of the control so far.
    calls: usize,
}

impl<'p> Making<'p> {
    fn fault(&mut self, fault: Fault) {
        if self.faults.len() < 4 * MAX_FAULTS {
            self.faults.push(fault);
        }
    }

    fn file(&mut self) -> File {
        let program = self.program;
        let nowhere = 0..0;
        self.states();
        self.find_timers();
        let mut body = Vec::new();
        match program.main() {
            Ok(main) => {
                if let Some(first) = program.unit(&Block::Ob(100)) {
                    let started = self.wiring.fresh("started");
                    let init = Some(truth(false, &nowhere));
                    let decl = variable(&started, None, TypeKind::Bool, init, &first.name.span);
                    self.kept.push(decl);
                    let mut once = self.block(first);
                    once.push(assign(
                        &started,
                        truth(true, &first.name.span),
                        &first.name.span,
                    ));
                    body.push(only_if(not(name(&started, &first.name.span)), once));
                }
                body.extend(self.block(main));
            }
            Err(fault) => self.fault(fault),
        }
        if let Some(scan) = &self.interface.scan {
            body = vec![only_if(name(scan, &nowhere), body)];
        }
        let (outputs, given) = self.outputs();
        body.extend(given);
        let kept: Vec<VarDecl> = (self.timers.values().flat_map(Timer::declared))
            .chain(std::mem::take(&mut self.kept))
            .collect();
        let section = |kind, variables| Section { kind, variables };
        let sections = vec![
            section(SectionKind::Input, self.inputs()),
            section(SectionKind::Output, outputs),
            section(SectionKind::Local, kept),
            section(SectionKind::Temp, std::mem::take(&mut self.temps)),
        ];
        let main = program.main().map_or(0..0, |unit| unit.name.span.clone());
        File {
            language: Language::StatementList,
            program: Pou {
                name: word(program.name(), &main),
                result: None,
                sections,
                body,
            },
            blocks: Vec::new(),
            functions: Vec::new(),
        }
    }

    /// The inputs of the machine that are wired, and the further ones.
    fn inputs(&self) -> Vec<VarDecl> {
        let nowhere = 0..0;
        let ports = self.wiring.signature.inputs.iter();
        let roles = || self.wiring.bits.values().chain(self.wiring.cells.values());
        let used = ports.filter(|port| {
            let wired = Role::Input(port.name.clone());
            port.added.is_some()
                || self.interface.scan.as_ref() == Some(&port.name)
                || roles().any(|role| *role == wired)
        });
        used.map(|port| {
            let ty = match port.ty {
                crate::st::term::Ty::Int => TypeKind::Int("INT".to_owned(), None),
                _ => TypeKind::Bool,
            };
            variable(&port.name, None, ty, None, &nowhere)
        })
        .collect()
    }

    /// What the program writes keeps its value, and begins with 0.
    fn states(&mut self) {
        let program = self.program;
        for (bit, role) in &self.wiring.bits {
            let Role::State(text) = role else { continue };
            let span = self
                .uses
                .bits
                .get(bit)
                .map_or(0..0, super::interface::Places::first);
            let init = Some(truth(false, &span));
            let title = Some(program.title(*bit));
            self.kept
                .push(variable(text, title, TypeKind::Bool, init, &span));
        }
        for (cell, role) in &self.wiring.cells {
            let Role::State(text) = role else { continue };
            let span = self
                .uses
                .cells
                .get(cell)
                .map_or(0..0, super::interface::Places::first);
            let range = bounds(
                number(0, &span),
                number(cell.most().min(i64::from(i32::MAX)), &span),
            );
            let ty = TypeKind::Int("INT".to_owned(), range);
            let title = Some(cell.to_string());
            self.kept
                .push(variable(text, title, ty, Some(number(0, &span)), &span));
        }
    }

    /// The outputs of the machine, given after each cycle from what the program wrote.
    fn outputs(&self) -> (Vec<VarDecl>, Vec<Stmt>) {
        let (mut declared, mut given) = (Vec::new(), Vec::new());
        for (port, output) in &self.interface.outputs {
            let (value, span) = match output {
                Output::Constant(value) => (truth(*value, &(0..0)), 0..0),
                Output::Bit { bit, inverted } => {
                    let places = self.uses.bits.get(bit).cloned().unwrap_or_default();
                    let span = places.written.clone().unwrap_or_else(|| places.first());
                    let value = self.bit(*bit, &span);
                    (if *inverted { not(value) } else { value }, span)
                }
            };
            declared.push(variable(
                port,
                None,
                TypeKind::Bool,
                Some(truth(false, &span)),
                &span,
            ));
            given.push(assign(port, value, &span));
        }
        (declared, given)
    }

    /// The value of a bit.
    fn bit(&self, bit: Bit, span: &Span) -> Expr {
        match self.wiring.bits.get(&bit) {
            Some(Role::Input(text) | Role::State(text)) => name(text, span),
            Some(Role::Zero) | None => truth(false, span),
        }
    }

    /// The value of a byte or word.
    fn cell(&self, cell: Cell, span: &Span) -> Expr {
        match self.wiring.cells.get(&cell) {
            Some(Role::Input(text) | Role::State(text)) => name(text, span),
            Some(Role::Zero) | None => number(0, span),
        }
    }

    fn set_bit(&self, bit: Bit, value: Expr, span: &Span) -> Option<Stmt> {
        match self.wiring.bits.get(&bit) {
            Some(Role::State(text)) => Some(assign(text, value, span)),
            _ => None,
        }
    }

    /// A variable that begins each cycle with FALSE.
    fn temp(&mut self, base: &str, ty: TypeKind, span: &Span) -> String {
        let text = self.wiring.fresh(base);
        let init = match ty {
            TypeKind::Bool => truth(false, span),
            _ => number(0, span),
        };
        self.temps.push(variable(&text, None, ty, Some(init), span));
        text
    }
}
