//! How a language writes expressions.

use stillpoint_lang::ir::BinaryOp;

/// The operators of a language. Operands come as text that binds as tightly as any, and so must go the result.
///
/// Quotients are truncated and remainders have the sign of the dividend, as in IEC 61131-3; a language that means something
/// else by its operators must write that.
pub trait Syntax {
    /// TRUE and FALSE.
    fn truth(&self, value: bool) -> &'static str;

    /// A number.
    fn number(&self, value: i64) -> String {
        if value < 0 {
            format!("({value})")
        } else {
            value.to_string()
        }
    }

    /// Logical negation.
    fn not(&self, a: &str) -> String;

    /// Arithmetic negation.
    fn negative(&self, a: &str) -> String {
        format!("(-{a})")
    }

    /// Two operands. XOR, `=` and `<>` also come with truth values.
    fn binary(&self, op: BinaryOp, a: &str, b: &str) -> String;

    /// `a` where the condition holds, else `b`.
    fn choice(&self, condition: &str, a: &str, b: &str) -> String;
}

/// The operators as most languages have them.
pub fn usual(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::And => "&",
        BinaryOp::Or => "|",
        BinaryOp::Xor | BinaryOp::Ne => "!=",
        BinaryOp::Eq => "=",
        BinaryOp::Lt => "<",
        BinaryOp::Gt => ">",
        BinaryOp::Le => "<=",
        BinaryOp::Ge => ">=",
        BinaryOp::Add => "+",
        BinaryOp::Sub => "-",
        BinaryOp::Mul => "*",
        BinaryOp::Div => "/",
        BinaryOp::Mod => "%",
    }
}
