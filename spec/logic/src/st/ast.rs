//! The syntax tree of a program.

pub(crate) use stillpoint_lang::syntax::ast::{BinaryOp, UnaryOp};

use crate::fault::Span;

/// A name as it is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Word {
    pub text: String,
    pub span: Span,
}

/// A file: one program, with the functions and function blocks that it uses.
#[derive(Debug, Clone)]
pub(crate) struct File {
    /// The language that it was written in.
    pub language: Language,
    pub program: Pou,
    pub blocks: Vec<Pou>,
    pub functions: Vec<Pou>,
}

/// The languages whose programs have this tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Language {
    StructuredText,
    /// The safe logic of SAFE.SPF, whose timers compare strictly.
    SafeLogic,
    /// Statement lists of STEP 7: their timers are clocks of the program.
    StatementList,
}

/// A program organisation unit: PROGRAM, FUNCTION_BLOCK or FUNCTION.
#[derive(Debug, Clone)]
pub(crate) struct Pou {
    pub name: Word,
    /// What a function returns.
    pub result: Option<TypeRef>,
    pub sections: Vec<Section>,
    pub body: Vec<Stmt>,
}

/// Variables declared together.
#[derive(Debug, Clone)]
pub(crate) struct Section {
    pub kind: SectionKind,
    pub variables: Vec<VarDecl>,
}

/// What the variables of a section are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SectionKind {
    Input,
    Output,
    /// They keep their values.
    Local,
    /// They begin each run with their initial values.
    Temp,
    Constant,
}

/// One variable.
#[derive(Debug, Clone)]
pub(crate) struct VarDecl {
    pub name: Word,
    pub ty: TypeRef,
    pub init: Option<Init>,
    /// What a reader knows it by, where that is not its name.
    pub title: Option<String>,
}

/// What stands after `:=` in a declaration.
#[derive(Debug, Clone)]
pub(crate) enum Init {
    Value(Expr),
    /// `(PT := T#1s)`: initial values of the inputs of a function block.
    Fields(Vec<(Word, Expr)>),
}

/// A type as written.
#[derive(Debug, Clone)]
pub(crate) struct TypeRef {
    pub kind: TypeKind,
    pub span: Span,
}

/// A range as written, both ends included.
pub(crate) type Bounds = Option<Box<(Expr, Expr)>>;

/// The kinds of types.
#[derive(Debug, Clone)]
pub(crate) enum TypeKind {
    Bool,
    /// An integer type by its name.
    Int(String, Bounds),
    Time(Bounds),
    /// A time that counts by itself, in standard blocks only.
    Clock(Bounds),
    /// A time whose program keeps it in its range.
    Kept(Bounds),
    /// An enum or a function block.
    Named(String),
}

/// An expression.
#[derive(Debug, Clone)]
pub(crate) struct Expr {
    pub kind: ExprKind,
    pub span: Span,
}

/// The kinds of expressions.
#[derive(Debug, Clone)]
pub(crate) enum ExprKind {
    Bool(bool),
    Int(i64),
    /// In microseconds.
    Time(u64),
    Name(String),
    /// `Som#SOM_1`, `INT#5`.
    Typed(Word, Box<Expr>),
    /// `t1.Q`
    Member(Box<Expr>, Word),
    Call(Word, Vec<Arg>),
    Unary(UnaryOp, Box<Expr>),
    Binary(BinaryOp, Box<Expr>, Box<Expr>),
}

/// An argument of a call.
#[derive(Debug, Clone)]
pub(crate) struct Arg {
    pub name: Option<Word>,
    /// `Q => y`, not `IN := x`.
    pub out: bool,
    pub value: Expr,
}

/// A statement.
#[derive(Debug, Clone)]
pub(crate) struct Stmt {
    pub kind: StmtKind,
    pub span: Span,
}

/// A condition with what is done where it holds; its place is that of the condition.
pub(crate) type Branch = (Expr, Vec<Stmt>);

/// The kinds of statements.
#[derive(Debug, Clone)]
pub(crate) enum StmtKind {
    Assign(Expr, Expr),
    /// A call of an instance of a function block.
    Call(Expr, Vec<Arg>),
    If(Vec<Branch>, Vec<Stmt>),
    Case(Expr, Vec<(Vec<Label>, Vec<Stmt>)>, Vec<Stmt>),
    For(Box<For>),
    Return,
    Exit,
}

/// One value of a CASE, or a range of them.
#[derive(Debug, Clone)]
pub(crate) struct Label {
    pub first: Expr,
    pub last: Option<Expr>,
}

/// A counted loop.
#[derive(Debug, Clone)]
pub(crate) struct For {
    pub variable: Word,
    pub from: Expr,
    pub to: Expr,
    pub by: Option<Expr>,
    pub body: Vec<Stmt>,
}
