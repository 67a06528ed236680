//! Clauses of an invariant, as a certificate writes them: `!X.on/0 X.left<=@rest+1` says that `X.on` is FALSE or `X.left` is at most
//! one more than the cycles left.

use std::fmt;

pub use stillpoint_lang::condition::written;

/// One of its literals holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clause(pub Vec<Literal>);

/// What can be said of numbers: state variables, free parameters, and those of the duty (see [`super::question`]).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Literal {
    /// `NAME/BIT`: a bit of the number in two's complement is set. `!` before it: it is not.
    Bit {
        /// The number.
        name: String,
        /// Which bit; 0 is the least one.
        bit: usize,
        /// Whether it is set.
        set: bool,
    },
    /// `NAME=VALUE` or `NAME!=VALUE`.
    Is {
        /// The number.
        name: String,
        /// The value.
        value: i64,
        /// Whether it has it.
        equal: bool,
    },
    /// `NAME<=OTHER`, `NAME<=OTHER+SHIFT`, `NAME<=OTHER-SHIFT`, or `NAME<=VALUE`; several names with `+` between stand for their sum.
    Most {
        /// The numbers, one at least.
        sum: Vec<String>,
        /// What their sum is compared with; none for 0.
        most: Vec<String>,
        /// What is added to that.
        shift: i64,
    },
}

impl Literal {
    /// Reads one.
    pub fn read(text: &str) -> Option<Literal> {
        if let Some((sum, rest)) = text.split_once("<=") {
            let sum = names(sum)?;
            if let Ok(shift) = rest.parse() {
                let most = Vec::new();
                return Some(Literal::Most { sum, most, shift });
            }
            let at = rest.rfind(['+', '-']).unwrap_or(rest.len());
            let (most, shift) = match rest[at..].parse() {
                Ok(shift) => (&rest[..at], shift),
                Err(_) => (rest, 0),
            };
            let most = names(most)?;
            return Some(Literal::Most { sum, most, shift });
        }
        if let Some((name, value)) = text.split_once('=') {
            let (name, equal) = match name.strip_suffix('!') {
                Some(name) => (name, false),
                None => (name, true),
            };
            let (name, value) = (name.to_owned(), value.parse().ok()?);
            return Some(Literal::Is { name, value, equal });
        }
        let (name, set) = match text.strip_prefix('!') {
            Some(name) => (name, false),
            None => (text, true),
        };
        let (name, bit) = name.rsplit_once('/')?;
        let (name, bit) = (name.to_owned(), bit.parse().ok()?);
        Some(Literal::Bit { name, bit, set })
    }
}

/// The names of a sum; none if one of them is empty.
fn names(sum: &str) -> Option<Vec<String>> {
    let names = sum
        .split('+')
        .map(|name| (!name.is_empty()).then(|| name.to_owned()));
    names.collect()
}

impl fmt::Display for Literal {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Literal::Bit { name, bit, set } => {
                write!(out, "{}{name}/{bit}", if *set { "" } else { "!" })
            }
            Literal::Is { name, value, equal } => {
                write!(out, "{name}{}{value}", if *equal { "=" } else { "!=" })
            }
            Literal::Most { sum, most, shift } => {
                write!(out, "{}<={}", sum.join("+"), most.join("+"))?;
                match (most.is_empty(), shift) {
                    (true, _) => write!(out, "{shift}"),
                    (false, 0) => Ok(()),
                    (false, _) => write!(out, "{shift:+}"),
                }
            }
        }
    }
}

impl Clause {
    /// Reads one from the words of a line.
    pub fn read<'a>(words: impl Iterator<Item = &'a str>) -> Option<Clause> {
        words.map(Literal::read).collect::<Option<_>>().map(Clause)
    }
}

impl fmt::Display for Clause {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let literals: Vec<String> = self.0.iter().map(Literal::to_string).collect();
        out.write_str(&literals.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_is_written_again() {
        let line = "!X.on/0 limit[0]/12 a=-3 a!=0 a.t<=b a.t<=@rest+1 a.t<=t_b-20 @rest<=59 a<=-1 a+b+b<=@rest+c-2 a<=b+c a+b<=0";
        let clause = Clause::read(line.split(' ')).expect("clause");
        assert_eq!((clause.to_string().as_str(), clause.0.len()), (line, 12));
        for wrong in [
            "X.on", "X.on/x", "X.on/-1", "a=", "a=b", "a<=b+", "a<=", "+a<=b", "<=b", "a<=b++1", "",
        ] {
            assert_eq!(Literal::read(wrong), None, "{wrong}");
        }
    }
}
