//! The instructions of a program, with their places.

use super::operand::{Bit, Cell};
use crate::fault::Span;

/// A name as it is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Word {
    pub text: String,
    pub span: Span,
}

/// A block of code, or the bare instructions of a file without blocks.
#[derive(Debug, Clone)]
pub(crate) struct Unit {
    pub block: Block,
    /// Its name in the file.
    pub name: Word,
    pub body: Vec<Instruction>,
    /// The end of its last instruction.
    pub end: usize,
}

/// Which block something is.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Block {
    /// `OB 1`
    Ob(u16),
    /// `FC 96`
    Fc(u16),
    /// `FB 10`
    Fb(u16),
    /// By a symbol that stands for none of them, in upper case.
    Symbol(String),
    /// The file has no blocks.
    Bare,
}

impl std::fmt::Display for Block {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Block::Ob(n) => write!(f, "OB {n}"),
            Block::Fc(n) => write!(f, "FC {n}"),
            Block::Fb(n) => write!(f, "FB {n}"),
            Block::Symbol(name) => write!(f, "\"{name}\""),
            Block::Bare => f.write_str("the program"),
        }
    }
}

/// One instruction.
#[derive(Debug, Clone)]
pub(crate) struct Instruction {
    pub label: Option<Word>,
    pub op: Op,
    pub span: Span,
}

/// How a check is combined with the result so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Logic {
    And,
    Or,
    Xor,
}

/// What a check looks at.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Source {
    Bit(Bit),
    Timer(u16),
}

/// What is set or reset.
pub(crate) type Target = Source;

/// The five ways to start a timer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TimerKind {
    /// SI, SP: a pulse as long as the result is 1, at most so long.
    Pulse,
    /// SV, SE: a pulse of this length.
    ExtendedPulse,
    /// SE, SD: on so long after the result has become 1, while it is 1.
    OnDelay,
    /// SS: on so long after the result has become 1, until it is reset.
    RetentiveOnDelay,
    /// SA, SF: on while the result is 1, and so long after it.
    OffDelay,
}

/// What is loaded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Value {
    Int(i64),
    /// In microseconds.
    Time(u64),
    Cell(Cell),
}

/// Comparison of accumulator 2 with accumulator 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Relation {
    Equal,
    Unequal,
    Greater,
    Less,
    GreaterEqual,
    LessEqual,
}

/// What an instruction does.
#[derive(Debug, Clone)]
pub(crate) enum Op {
    Check {
        logic: Logic,
        not: bool,
        of: Source,
    },
    /// `U(`
    Open {
        logic: Logic,
        not: bool,
    },
    /// `)`
    Close,
    /// `O` without operand: the AND before it and the AND after it are combined by OR.
    OrBlock,
    Assign(Bit),
    Set(Target),
    Reset(Target),
    Edge {
        falling: bool,
        memory: Bit,
    },
    Not,
    SetResult,
    ClearResult,
    Load(Value),
    Transfer(Cell),
    Compare(Relation),
    Start(TimerKind, u16),
    Jump {
        /// On a result of 1 or of 0; none: always.
        when: Option<bool>,
        to: Word,
    },
    /// The end of the block: always, or where the result is 1.
    End {
        conditional: bool,
    },
    Call(Call),
    Nothing,
}

/// A call of a block.
#[derive(Debug, Clone)]
pub(crate) struct Call {
    pub block: Block,
    /// Only where the result is 1.
    pub conditional: bool,
    pub params: Vec<Param>,
    /// The name of the block in the text.
    pub span: Span,
}

/// `Start := M 211.1`
#[derive(Debug, Clone)]
pub(crate) struct Param {
    pub name: Word,
    pub value: Actual,
    pub span: Span,
}

/// What is given for a parameter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Actual {
    Bit(Bit),
    Cell(Cell),
    Bool(bool),
    Int(i64),
    Time(u64),
    /// A timer, a pointer, a decimal number: nothing that the logic depends on.
    Other,
    /// `P#M 194.0 BYTE 1`
    Byte(Cell),
}
