//! Recursive-descent parser with precedence climbing.

use super::ast::{BinaryOp, Expr, Kind, Quantifier, Span, Stmt, TypeExpr, TypeKind, UnaryOp};
use super::lex::{Token, tokens};

/// A text that is not of the language, with the place and the fix.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SyntaxError {
    /// Byte range within the parsed text.
    pub span: Span,
    /// What is wrong.
    pub message: String,
    /// What to write instead.
    pub help: String,
}

impl SyntaxError {
    pub(super) fn new(span: Span, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            span,
            message: message.into(),
            help: help.into(),
        }
    }
}

type Parsed<T> = Result<T, SyntaxError>;

/// Words that cannot be names.
pub(crate) const KEYWORDS: [&str; 21] = [
    "AND", "OR", "XOR", "NOT", "MOD", "TRUE", "FALSE", "IF", "THEN", "ELSIF", "ELSE", "END_IF",
    "BOOL", "INT", "TIME", "ARRAY", "OF", "FORALL", "EXISTS", "MAXIMUM", "IN",
];

/// Deeper nesting is refused, so that no text can exhaust the stack.
const MAX_DEPTH: usize = 60;

/// Longer texts are refused for the same reason: chains of operators nest to the left.
const MAX_TOKENS: usize = 2000;

struct Parser {
    tokens: Vec<(Token, Span)>,
    at: usize,
    depth: usize,
}

/// Parses one expression; the whole text must be used.
pub fn parse_expr(text: &str) -> Parsed<Expr> {
    whole(text, Parser::expr)
}

/// Parses the statements of an effect; the last `;` may be left out.
pub fn parse_effect(text: &str) -> Parsed<Vec<Stmt>> {
    whole(text, |p| p.statements(&[]))
}

/// Parses a type such as `INT(0..7)`.
pub fn parse_type(text: &str) -> Parsed<TypeExpr> {
    whole(text, Parser::type_expr)
}

/// Parses `name : type`, the argument of a function.
pub fn parse_decl(text: &str) -> Parsed<(String, TypeExpr)> {
    whole(text, |p| {
        let name = p.name()?;
        p.expect(":")?;
        Ok((name, p.type_expr()?))
    })
}

fn whole<T>(text: &str, read: impl FnOnce(&mut Parser) -> Parsed<T>) -> Parsed<T> {
    let tokens = tokens(text)?;
    if tokens.len() > MAX_TOKENS {
        return Err(SyntaxError::new(
            tokens[MAX_TOKENS].1.clone(),
            "text is too long",
            "name parts of it with `let`, or split the rule",
        ));
    }
    let mut parser = Parser {
        tokens,
        at: 0,
        depth: 0,
    };
    let out = read(&mut parser)?;
    match parser.peek() {
        Token::End => Ok(out),
        other => Err(SyntaxError::new(
            parser.span(),
            format!("{} is not expected here", other.describe()),
            "an operator such as AND, OR, =, + is missing before it, or a bracket is not balanced",
        )),
    }
}

impl Parser {
    fn peek(&self) -> &Token {
        // The list ends with `End`, and `bump` never moves past it.
        &self.tokens[self.at.min(self.tokens.len() - 1)].0
    }

    fn span(&self) -> Span {
        self.tokens[self.at.min(self.tokens.len() - 1)].1.clone()
    }

    fn bump(&mut self) -> (Token, Span) {
        let one = self.tokens[self.at.min(self.tokens.len() - 1)].clone();
        self.at += 1;
        one
    }

    fn sym(&mut self, sym: &str) -> bool {
        let hit = matches!(self.peek(), Token::Sym(s) if *s == sym);
        if hit {
            self.at += 1;
        }
        hit
    }

    fn word(&mut self, word: &str) -> bool {
        let hit = matches!(self.peek(), Token::Word(w) if w == word);
        if hit {
            self.at += 1;
        }
        hit
    }

    fn fail<T>(&self, wanted: &str) -> Parsed<T> {
        Err(SyntaxError::new(
            self.span(),
            format!("expected {wanted}, found {}", self.peek().describe()),
            format!("write {wanted} here"),
        ))
    }

    fn expect(&mut self, sym: &str) -> Parsed<()> {
        if self.sym(sym) {
            Ok(())
        } else {
            self.fail(&format!("`{sym}`"))
        }
    }

    fn expect_word(&mut self, word: &str) -> Parsed<()> {
        if self.word(word) {
            Ok(())
        } else {
            self.fail(&format!("`{word}`"))
        }
    }

    fn name(&mut self) -> Parsed<String> {
        match self.peek() {
            Token::Word(w) if !KEYWORDS.contains(&w.as_str()) => {
                let name = w.clone();
                self.at += 1;
                Ok(name)
            }
            Token::Word(w) if w.as_str() == "IF" => Err(SyntaxError::new(
                self.span(),
                "IF is a statement; here an expression is needed",
                "write SEL(condition, value if FALSE, value if TRUE)",
            )),
            _ => self.fail("a name"),
        }
    }

    fn expr(&mut self) -> Parsed<Expr> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(SyntaxError::new(
                self.span(),
                "expression is nested too deeply",
                "name parts of it with `let`",
            ));
        }
        let out = self.binary(1);
        self.depth -= 1;
        out
    }

    fn operator(&self) -> Option<(BinaryOp, u8)> {
        Some(match self.peek() {
            Token::Word(w) => match w.as_str() {
                "OR" => (BinaryOp::Or, 1),
                "XOR" => (BinaryOp::Xor, 1),
                "AND" => (BinaryOp::And, 2),
                "MOD" => (BinaryOp::Mod, 6),
                _ => return None,
            },
            Token::Sym(s) => match *s {
                "&" => (BinaryOp::And, 2),
                "=" => (BinaryOp::Eq, 3),
                "<>" => (BinaryOp::Ne, 3),
                "<" => (BinaryOp::Lt, 4),
                ">" => (BinaryOp::Gt, 4),
                "<=" => (BinaryOp::Le, 4),
                ">=" => (BinaryOp::Ge, 4),
                "+" => (BinaryOp::Add, 5),
                "-" => (BinaryOp::Sub, 5),
                "*" => (BinaryOp::Mul, 6),
                "/" => (BinaryOp::Div, 6),
                _ => return None,
            },
            _ => return None,
        })
    }

    fn binary(&mut self, least: u8) -> Parsed<Expr> {
        let mut left = self.unary()?;
        while let Some((op, strength)) = self.operator() {
            if strength < least {
                break;
            }
            self.bump();
            let right = self.binary(strength + 1)?;
            let span = left.span.start..right.span.end;
            left = Expr {
                kind: Kind::Binary(op, Box::new(left), Box::new(right)),
                span,
            };
        }
        Ok(left)
    }

    fn unary(&mut self) -> Parsed<Expr> {
        let start = self.span().start;
        let op = if self.word("NOT") {
            UnaryOp::Not
        } else if self.sym("-") {
            UnaryOp::Neg
        } else {
            return self.postfix();
        };
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return self.fail("a shorter expression (too many nested operators)");
        }
        let inner = self.unary()?;
        self.depth -= 1;
        let span = start..inner.span.end;
        Ok(Expr {
            kind: Kind::Unary(op, Box::new(inner)),
            span,
        })
    }

    fn postfix(&mut self) -> Parsed<Expr> {
        let mut base = self.primary()?;
        loop {
            let start = base.span.start;
            if self.sym("[") {
                let index = self.expr()?;
                let end = self.span().end;
                self.expect("]")?;
                base = Expr {
                    kind: Kind::Index(Box::new(base), Box::new(index)),
                    span: start..end,
                };
            } else if self.sym(".") {
                let end = self.span().end;
                let member = self.name()?;
                base = Expr {
                    kind: Kind::Member(Box::new(base), member),
                    span: start..end,
                };
            } else {
                return Ok(base);
            }
        }
    }

    fn primary(&mut self) -> Parsed<Expr> {
        let start = self.span().start;
        let kind = match self.peek().clone() {
            Token::Int(v) => {
                self.bump();
                Kind::Int(v)
            }
            Token::Time(us) => {
                self.bump();
                Kind::Time(us)
            }
            Token::Sym("(") => {
                self.bump();
                let inner = self.expr()?;
                self.expect(")")?;
                return Ok(inner);
            }
            Token::Word(w) => match w.as_str() {
                "TRUE" | "FALSE" => {
                    self.bump();
                    Kind::Bool(w == "TRUE")
                }
                "FORALL" => self.quantified(Quantifier::ForAll)?,
                "EXISTS" => self.quantified(Quantifier::Exists)?,
                "MAXIMUM" => self.quantified(Quantifier::Maximum)?,
                _ => {
                    let name = self.name()?;
                    if self.sym("#") {
                        Kind::Qualified(name, self.name()?)
                    } else if self.sym("(") {
                        Kind::Call(name, self.arguments()?)
                    } else {
                        Kind::Name(name)
                    }
                }
            },
            _ => return self.fail("a value"),
        };
        let end = self.tokens[self.at - 1].1.end;
        Ok(Expr {
            kind,
            span: start..end,
        })
    }

    fn arguments(&mut self) -> Parsed<Vec<Expr>> {
        let mut args = Vec::new();
        if self.sym(")") {
            return Ok(args);
        }
        loop {
            args.push(self.expr()?);
            if self.sym(")") {
                return Ok(args);
            }
            self.expect(",")?;
        }
    }

    fn quantified(&mut self, quantifier: Quantifier) -> Parsed<Kind> {
        self.bump();
        self.expect("(")?;
        let var = self.name()?;
        self.expect_word("IN")?;
        let array = self.name()?;
        self.expect(",")?;
        let body = self.expr()?;
        self.expect(")")?;
        Ok(Kind::Quantified(quantifier, var, array, Box::new(body)))
    }

    fn statements(&mut self, ends: &[&str]) -> Parsed<Vec<Stmt>> {
        let mut out = Vec::new();
        loop {
            while self.sym(";") {}
            let done = match self.peek() {
                Token::End => true,
                Token::Word(w) => ends.contains(&w.as_str()),
                _ => false,
            };
            if done {
                return Ok(out);
            }
            self.depth += 1;
            if self.depth > MAX_DEPTH {
                return self.fail("fewer nested IF statements");
            }
            out.push(self.statement()?);
            self.depth -= 1;
            let done = match self.peek() {
                Token::End => true,
                Token::Word(w) => ends.contains(&w.as_str()),
                _ => false,
            };
            if !done {
                self.expect(";")?;
            }
        }
    }

    fn statement(&mut self) -> Parsed<Stmt> {
        if self.word("IF") {
            let mut branches = Vec::new();
            let mut rest = Vec::new();
            let guard = self.expr()?;
            self.expect_word("THEN")?;
            branches.push((guard, self.statements(&["ELSIF", "ELSE", "END_IF"])?));
            loop {
                if self.word("ELSIF") {
                    let guard = self.expr()?;
                    self.expect_word("THEN")?;
                    branches.push((guard, self.statements(&["ELSIF", "ELSE", "END_IF"])?));
                } else if self.word("ELSE") {
                    rest = self.statements(&["END_IF"])?;
                } else {
                    self.expect_word("END_IF")?;
                    return Ok(Stmt::If(branches, rest));
                }
            }
        }
        let target = self.postfix()?;
        self.expect(":=")?;
        Ok(Stmt::Assign(target, self.expr()?))
    }

    fn type_expr(&mut self) -> Parsed<TypeExpr> {
        let start = self.span().start;
        let kind = if self.word("BOOL") {
            TypeKind::Bool
        } else if self.word("INT") {
            TypeKind::Int(self.range()?)
        } else if self.word("TIME") {
            TypeKind::Time(self.range()?)
        } else if self.word("ARRAY") {
            self.expect("[")?;
            let lo = self.bound()?;
            self.expect("..")?;
            let hi = self.bound()?;
            let span = start..self.span().end;
            self.expect("]")?;
            self.expect_word("OF")?;
            if hi < lo || hi - lo >= 4096 {
                return Err(SyntaxError::new(
                    span,
                    format!("array bounds {lo}..{hi} are not usable"),
                    "the lower bound comes first, and an array has at most 4096 elements",
                ));
            }
            let element = self.type_expr()?;
            if matches!(element.kind, TypeKind::Array(..)) {
                return Err(SyntaxError::new(
                    element.span,
                    "an array of arrays is not offered",
                    "use one array, or several variables",
                ));
            }
            TypeKind::Array(lo, hi, Box::new(element))
        } else {
            match self.name() {
                Ok(name) => TypeKind::Enum(name),
                Err(_) => {
                    return self.fail(
                        "a type: BOOL, INT(lo..hi), TIME(lo..hi), ARRAY[lo..hi] OF ..., or an enum",
                    );
                }
            }
        };
        let end = self.tokens[self.at - 1].1.end;
        Ok(TypeExpr {
            kind,
            span: start..end,
        })
    }

    fn bound(&mut self) -> Parsed<i64> {
        let minus = self.sym("-");
        match self.bump() {
            (Token::Int(v), _) if v <= i64::from(i32::MAX) => Ok(if minus { -v } else { v }),
            (other, span) => Err(SyntaxError::new(
                span,
                format!("array bound {} is not a number", other.describe()),
                "write a literal number",
            )),
        }
    }

    fn range(&mut self) -> Parsed<Option<(Box<Expr>, Box<Expr>)>> {
        if !self.sym("(") {
            return Ok(None);
        }
        let lo = self.expr()?;
        self.expect("..")?;
        let hi = self.expr()?;
        self.expect(")")?;
        Ok(Some((Box::new(lo), Box::new(hi))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(text: &str) -> String {
        fn show(e: &Expr) -> String {
            match &e.kind {
                Kind::Int(v) => v.to_string(),
                Kind::Bool(b) => b.to_string(),
                Kind::Time(us) => format!("{us}us"),
                Kind::Name(n) => n.clone(),
                Kind::Qualified(a, b) => format!("{a}#{b}"),
                Kind::Member(a, m) => format!("{}.{m}", show(a)),
                Kind::Index(a, i) => format!("{}[{}]", show(a), show(i)),
                Kind::Call(n, args) => {
                    format!(
                        "{n}({})",
                        args.iter().map(show).collect::<Vec<_>>().join(",")
                    )
                }
                Kind::Unary(op, a) => format!("({op:?} {})", show(a)),
                Kind::Binary(op, a, b) => format!("({op:?} {} {})", show(a), show(b)),
                Kind::Quantified(q, v, a, b) => format!("{q:?}({v} {a} {})", show(b)),
            }
        }
        show(&parse_expr(text).unwrap())
    }

    #[test]
    fn precedence_follows_iec_61131_3() {
        assert_eq!(
            shape("a OR b AND NOT c = d + 1 * 2"),
            "(Or a (And b (Eq (Not c) (Add d (Mul 1 2)))))"
        );
        assert_eq!(shape("a - b - c"), "(Sub (Sub a b) c)");
        assert_eq!(
            shape("stop[3 - i].level >= Level#B"),
            "(Ge stop[(Sub 3 i)].level Level#B)"
        );
        assert_eq!(shape("a < b = c"), "(Eq (Lt a b) c)");
    }

    #[test]
    fn times_are_exact() {
        assert_eq!(shape("T#1s500ms"), "1500000us");
        assert_eq!(shape("T#0.5ms"), "500us");
        assert!(parse_expr("T#0.0005ms").is_err());
        assert!(parse_expr("T#5").is_err());
    }

    #[test]
    fn errors_name_the_place() {
        let e = parse_expr("a AND (b OR").unwrap_err();
        assert_eq!(e.span, 11..11);
        let e = parse_expr("a b").unwrap_err();
        assert_eq!(e.span, 2..3);
        assert!(parse_effect("x := 1 y := 2").is_err());
        assert!(parse_expr(&"(".repeat(10_000)).is_err());
        assert!(parse_expr(&"NOT ".repeat(10_000)).is_err());
    }

    #[test]
    fn effects_and_types() {
        assert_eq!(
            parse_effect("x := 1; IF a THEN y := 2; ELSE z := 3; END_IF;")
                .unwrap()
                .len(),
            2
        );
        assert!(matches!(
            parse_type("ARRAY[0..3] OF INT(0..9)").unwrap().kind,
            TypeKind::Array(0, 3, _)
        ));
    }
}
