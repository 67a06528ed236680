//! Syntax tree of expressions, effects and types. Spans are byte ranges within the parsed text.

use std::ops::Range;

/// Byte range within the parsed text.
pub type Span = Range<usize>;

/// An expression and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: Kind,
    /// Where it stands.
    pub span: Span,
}

/// The kinds of expressions.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// Integer literal.
    Int(i64),
    /// `TRUE` or `FALSE`.
    Bool(bool),
    /// `T#...` literal in microseconds.
    Time(u64),
    /// A bare name.
    Name(String),
    /// `Level#B`.
    Qualified(String, String),
    /// `base.member`.
    Member(Box<Expr>, String),
    /// `base[index]`.
    Index(Box<Expr>, Box<Expr>),
    /// `NAME(args)`: a built-in or declared function.
    Call(String, Vec<Expr>),
    /// `NOT x` or `-x`.
    Unary(UnaryOp, Box<Expr>),
    /// `a op b`.
    Binary(BinaryOp, Box<Expr>, Box<Expr>),
    /// `FORALL(j IN array, body)` and its kin.
    Quantified(Quantifier, String, String, Box<Expr>),
}

/// Unary operators.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnaryOp {
    /// Logical negation.
    Not,
    /// Arithmetic negation.
    Neg,
}

/// Binary operators.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    /// `OR`, right side only if the left one is FALSE.
    Or,
    /// `XOR`.
    Xor,
    /// `AND`, right side only if the left one is TRUE.
    And,
    /// `=`.
    Eq,
    /// `<>`.
    Ne,
    /// `<`.
    Lt,
    /// `>`.
    Gt,
    /// `<=`.
    Le,
    /// `>=`.
    Ge,
    /// `+`.
    Add,
    /// `-`.
    Sub,
    /// `*`.
    Mul,
    /// `/`, truncating.
    Div,
    /// `MOD`, sign of the dividend.
    Mod,
}

impl BinaryOp {
    /// As Structured Text writes it.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Or => "OR",
            Self::Xor => "XOR",
            Self::And => "AND",
            Self::Eq => "=",
            Self::Ne => "<>",
            Self::Lt => "<",
            Self::Gt => ">",
            Self::Le => "<=",
            Self::Ge => ">=",
            Self::Add => "+",
            Self::Sub => "-",
            Self::Mul => "*",
            Self::Div => "/",
            Self::Mod => "MOD",
        }
    }
}

/// Expansion over an instance array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantifier {
    /// Conjunction.
    ForAll,
    /// Disjunction.
    Exists,
    /// Largest value.
    Maximum,
}

/// A statement of an effect.
#[derive(Debug, Clone, PartialEq)]
pub enum Stmt {
    /// `target := value;` (the target is a name or an array element).
    Assign(Expr, Expr),
    /// `IF ... THEN ... ELSIF ... ELSE ... END_IF;`: branches in order, then the rest.
    If(Vec<(Expr, Vec<Stmt>)>, Vec<Stmt>),
}

/// A type as written.
#[derive(Debug, Clone, PartialEq)]
pub struct TypeExpr {
    /// What it is.
    pub kind: TypeKind,
    /// Where it stands.
    pub span: Span,
}

/// The kinds of types.
#[derive(Debug, Clone, PartialEq)]
pub enum TypeKind {
    /// `BOOL`.
    Bool,
    /// The name of an enum.
    Enum(String),
    /// `INT(lo..hi)`; without a range only as an argument of a function.
    Int(Option<(Box<Expr>, Box<Expr>)>),
    /// `TIME(lo..hi)`, in cycles.
    Time(Option<(Box<Expr>, Box<Expr>)>),
    /// `ARRAY[lo..hi] OF element`.
    Array(i64, i64, Box<TypeExpr>),
}
