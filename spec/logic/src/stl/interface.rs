//! What a program has to do with the machine whose place its table takes.

use std::collections::BTreeMap;

use super::ast::{Actual, Logic, Op, Source};
use super::known::{Kind, known, signals_of_axis};
use super::operand::{Area, Cell};
use super::{Bit, Program, line_of};
use crate::fault::Span;
use crate::st::Signature;

/// How the bits of a program are wired to a machine of the tables.
#[derive(Debug, Clone)]
pub struct Interface {
    /// The machine that the table of the program takes the place of.
    pub signature: Signature,
    /// Bits that are inputs of the machine: each with the name of the input. A bit that the program does not read may be named. For a bit
    /// that the program only copies from an input, such as `INSEP[1]`, that input is meant.
    pub inputs: Vec<(Bit, String)>,
    /// All outputs of the machine: each by its name, with what it gives.
    pub outputs: Vec<(String, Output)>,
    /// An input of type BOOL of the machine: the program runs only in cycles in which it is TRUE; in the others all its values stay, and
    /// its timers go on.
    pub scan: Option<String>,
}

/// What an output of the machine gives.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Output {
    /// Always the same.
    Constant(bool),
    /// A bit that the program may write; one that it never writes is 0.
    Bit {
        /// Which one.
        bit: Bit,
        /// Whether the output is TRUE where the bit is 0.
        inverted: bool,
    },
}

/// A bit of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Used {
    /// Which one.
    pub bit: Bit,
    /// What the symbol table calls it.
    pub name: Option<String>,
    /// Whether an instruction or a block reads it.
    pub reads: bool,
    /// Whether one writes it.
    pub writes: bool,
    /// The line that uses it first, from 1.
    pub line: usize,
}

/// Reading and writing of one bit, with the first place of each.
#[derive(Debug, Clone, Default)]
pub(super) struct Places {
    pub read: Option<Span>,
    pub written: Option<Span>,
}

impl Places {
    /// Where it is met first.
    pub fn first(&self) -> Span {
        let both = [&self.read, &self.written].into_iter().flatten();
        both.min_by_key(|span| span.start).cloned().unwrap_or(0..0)
    }
}

/// Everything that the instructions of a file name.
#[derive(Debug, Clone, Default)]
pub(super) struct Uses {
    pub bits: BTreeMap<Bit, Places>,
    pub cells: BTreeMap<Cell, Places>,
}

impl Uses {
    fn bit(&mut self, bit: Bit, span: &Span, writes: bool) {
        let places = self.bits.entry(bit).or_default();
        let place = match writes {
            true => &mut places.written,
            false => &mut places.read,
        };
        place.get_or_insert_with(|| span.clone());
    }

    fn cell(&mut self, cell: Cell, span: &Span, writes: bool) {
        let places = self.cells.entry(cell).or_default();
        let place = match writes {
            true => &mut places.written,
            false => &mut places.read,
        };
        place.get_or_insert_with(|| span.clone());
    }
}

impl Program {
    /// The bits that it reads or writes, in their order.
    #[must_use]
    pub fn bits(&self) -> Vec<Used> {
        let all = self.uses().bits.into_iter().map(|(bit, places)| Used {
            bit,
            name: self.names.get(&bit).cloned(),
            reads: places.read.is_some(),
            writes: places.written.is_some(),
            line: line_of(&self.source, places.first().start),
        });
        all.collect()
    }

    /// Whether an instruction or a block writes the bit, by itself or with its byte.
    pub fn gives(&self, bit: Bit) -> bool {
        let uses = self.uses();
        let mut cells = uses.cells.iter();
        let own = uses
            .bits
            .get(&bit)
            .is_some_and(|places| places.written.is_some());
        own || cells.any(|(cell, places)| places.written.is_some() && bit.lies_in(*cell))
    }

    /// Where each bit and byte is read and written first.
    pub(super) fn uses(&self) -> Uses {
        let mut uses = Uses::default();
        for instruction in self.units.iter().flat_map(|unit| &unit.body) {
            let span = &instruction.span;
            match &instruction.op {
                Op::Check {
                    of: Source::Bit(bit),
                    ..
                } => uses.bit(*bit, span, false),
                Op::Assign(bit) | Op::Set(Source::Bit(bit)) | Op::Reset(Source::Bit(bit)) => {
                    uses.bit(*bit, span, true);
                }
                Op::Edge { memory, .. } => {
                    uses.bit(*memory, span, true);
                    uses.bit(*memory, span, false);
                }
                Op::Load(super::ast::Value::Cell(cell)) => uses.cell(*cell, span, false),
                Op::Transfer(cell) => uses.cell(*cell, span, true),
                Op::Call(call) => {
                    let Some(known) = known(&call.block) else {
                        continue;
                    };
                    if known.kind == Kind::BrakeTest {
                        for bit in signals_of_axis(call).into_iter().flatten() {
                            uses.bit(bit, &call.span, false);
                        }
                    }
                    for param in &call.params {
                        let name = param.name.text.to_uppercase();
                        let writes = known.has_output(&name);
                        match param.value {
                            Actual::Bit(bit) => {
                                uses.bit(bit, &param.span, writes);
                                if known.kind == Kind::Relay && name == "FIRSTRUN" {
                                    uses.bit(bit, &param.span, false);
                                }
                            }
                            Actual::Byte(cell) if !writes => uses.cell(cell, &param.span, false),
                            _ => {}
                        }
                    }
                }
                _ => {}
            }
        }
        uses
    }

    /// The input that the program copies to a bit, and nothing else does: `U E 76.0`, `= INSEP[1]`.
    pub(super) fn terminal(&self, of: Bit) -> Option<Bit> {
        let mut found = None;
        for unit in &self.units {
            for (at, instruction) in unit.body.iter().enumerate() {
                let writes = match &instruction.op {
                    Op::Assign(bit) | Op::Set(Source::Bit(bit)) | Op::Reset(Source::Bit(bit)) => {
                        *bit == of
                    }
                    Op::Edge { memory, .. } => *memory == of,
                    Op::Transfer(cell) => of.lies_in(*cell),
                    Op::Call(call) => call.params.iter().any(|p| {
                        p.value == Actual::Bit(of)
                            && known(&call.block)
                                .is_none_or(|k| k.has_output(&p.name.text.to_uppercase()))
                    }),
                    _ => false,
                };
                if !writes {
                    continue;
                }
                let copied = matches!(instruction.op, Op::Assign(_))
                    .then(|| copied(&unit.body[..at]))
                    .flatten();
                match (copied, found) {
                    (Some(from), None) => found = Some(from),
                    _ => return None,
                }
            }
        }
        found
    }
}

/// The input that the result of these instructions is, if it is one alone.
fn copied(before: &[super::ast::Instruction]) -> Option<Bit> {
    let (last, rest) = before.split_last()?;
    match &last.op {
        // Further assignments of the same result.
        Op::Assign(_) => copied(rest),
        Op::Check {
            logic: Logic::And | Logic::Or,
            not: false,
            of: Source::Bit(bit),
        } if bit.area == Area::Input => {
            let begins = match rest.last().map(|instruction| &instruction.op) {
                None => true,
                Some(op) => matches!(
                    op,
                    Op::Assign(_)
                        | Op::Set(_)
                        | Op::Reset(_)
                        | Op::SetResult
                        | Op::ClearResult
                        | Op::Start(..)
                        | Op::Jump { .. }
                        | Op::Call(_)
                        | Op::End { .. }
                ),
            };
            (begins && last.label.is_none()).then_some(*bit)
        }
        _ => None,
    }
}
