//! The system variables of the language: type, index, and who may write them.

use std::fmt;
use std::str::FromStr;

use stillpoint_lang::diag::nearest;

/// The type of a variable, and of an expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ty {
    Bool,
    Int,
    /// A time in seconds; only timers have it.
    Real,
    /// That of a name which a fragment uses and does not define: it fits everywhere.
    Unknown,
}

impl Ty {
    pub const fn name(self) -> &'static str {
        match self {
            Ty::Bool => "BOOL",
            Ty::Int => "INT",
            Ty::Real => "REAL",
            Ty::Unknown => "not known",
        }
    }
}

/// What stands in the brackets after the name of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Indexing {
    /// Numbers, both ends included.
    Numbers(u16, u16),
    Axis,
    None,
}

/// What a program may do with a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Access {
    Read,
    Write,
    Both,
}

/// Which values a whole number can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Values {
    /// Of BOOL and REAL: what their type says.
    OfType,
    Range(i64, i64),
    /// 32 bits: only the comparisons of the program tell them apart.
    Compared,
    /// A double word of bits, which has other names for each of them.
    Bits,
}

/// A system variable without its index.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    /// As a program writes it, without `$`: `A_INSE`.
    pub name: &'static str,
    /// As this crate names it: `INSE`.
    pub short: &'static str,
    pub ty: Ty,
    pub index: Indexing,
    pub access: Access,
    pub values: Values,
    /// Whether only the program itself writes it: what it never writes stays 0.
    pub own: bool,
}

const fn kind(
    name: &'static str,
    short: &'static str,
    ty: Ty,
    index: Indexing,
    access: Access,
    values: Values,
    own: bool,
) -> Kind {
    Kind {
        name,
        short,
        ty,
        index,
        access,
        values,
        own,
    }
}

use Access::{Both, Read, Write};
use Indexing::{Axis, Numbers};
use Ty::{Bool, Int, Real};
use Values::{Bits, Compared, OfType, Range};

/// The table of section 5 of the language: everything that a program may name.
pub(crate) const KINDS: [Kind; 24] = [
    kind("A_INSE", "INSE", Bool, Numbers(1, 64), Read, OfType, false),
    kind("A_OUTSE", "OUTSE", Bool, Numbers(1, 64), Both, OfType, true),
    kind("A_INSI", "INSI", Bool, Numbers(1, 64), Read, OfType, false),
    kind("A_OUTSI", "OUTSI", Bool, Numbers(1, 64), Both, OfType, true),
    kind(
        "A_MARKERSI",
        "MARKERSI",
        Bool,
        Numbers(1, 64),
        Both,
        OfType,
        true,
    ),
    kind("A_INSED", "INSED", Int, Numbers(1, 2), Read, Bits, false),
    kind("A_OUTSED", "OUTSED", Int, Numbers(1, 2), Both, Bits, true),
    kind("A_INSID", "INSID", Int, Numbers(1, 2), Read, Bits, false),
    kind("A_OUTSID", "OUTSID", Int, Numbers(1, 2), Both, Bits, true),
    kind(
        "A_MARKERSID",
        "MARKERSID",
        Int,
        Numbers(1, 2),
        Both,
        Bits,
        true,
    ),
    kind(
        "A_TIMERSI",
        "TIMERSI",
        Real,
        Numbers(1, 16),
        Both,
        OfType,
        true,
    ),
    kind(
        "A_DBB",
        "DBB",
        Int,
        Numbers(0, 1023),
        Read,
        Range(0, 255),
        false,
    ),
    kind(
        "A_PLCSIOUT",
        "PLCSIOUT",
        Bool,
        Numbers(1, 32),
        Both,
        OfType,
        false,
    ),
    kind(
        "A_PLCSIIN",
        "PLCSIIN",
        Bool,
        Numbers(1, 32),
        Read,
        OfType,
        false,
    ),
    kind(
        "A_STATSID",
        "STATSID",
        Int,
        Indexing::None,
        Read,
        Compared,
        false,
    ),
    kind(
        "A_LEVELSID",
        "LEVELSID",
        Int,
        Indexing::None,
        Read,
        Compared,
        false,
    ),
    kind("A_CMDSI", "CMDSI", Bool, Numbers(1, 1), Both, OfType, true),
    kind(
        "AC_MARKER",
        "AC_MARKER",
        Int,
        Numbers(0, 999),
        Both,
        Compared,
        false,
    ),
    kind("VA_DPE", "VA_DPE", Bool, Axis, Read, OfType, false),
    kind(
        "A_STOPESI",
        "STOPESI",
        Int,
        Indexing::None,
        Read,
        Compared,
        false,
    ),
    kind(
        "A_XFAULTSI",
        "XFAULTSI",
        Int,
        Indexing::None,
        Read,
        Range(0, 3),
        false,
    ),
    kind(
        "AC_ESR_TRIGGER",
        "AC_ESR_TRIGGER",
        Bool,
        Indexing::None,
        Write,
        OfType,
        true,
    ),
    kind("VA_STOPSI", "VA_STOPSI", Int, Axis, Read, Compared, false),
    kind(
        "VA_XFAULTSI",
        "VA_XFAULTSI",
        Int,
        Axis,
        Read,
        Range(0, 3),
        false,
    ),
];

/// The place of a variable among those of its kind.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Place {
    None,
    Number(u16),
    Axis(String),
}

/// A system variable of the safe logic, such as `$A_INSE[3]`. It is shown without what all of them have in common:
/// `INSE[3]`, `DBB[4]`, `VA_DPE[X1]`, `STOPESI`; and read from this form, and from that of the programs.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Variable {
    short: &'static str,
    place: Place,
}

impl Variable {
    /// The kind that it is of.
    pub(crate) fn kind(&self) -> &'static Kind {
        KINDS
            .iter()
            .find(|kind| kind.short == self.short)
            .unwrap_or(&KINDS[0])
    }

    /// A variable with an index, or what is wrong with it: the message and the fix.
    pub(crate) fn new(name: &str, index: Option<&str>) -> Result<Self, (String, String)> {
        let Some(kind) = named(name) else {
            return Err(no_such(name));
        };
        let written = || format!("`${}`", kind.name);
        let place = match (kind.index, index) {
            (Indexing::None, None) => Place::None,
            (Indexing::None, Some(index)) => {
                return Err((
                    format!("{} has no index, this is `[{index}]`", written()),
                    format!("write {}", written()),
                ));
            }
            (Indexing::Numbers(low, high), index) => {
                let example = format!("write a number, {low}..{high}: `${}[{low}]`", kind.name);
                let Some(index) = index else {
                    return Err((format!("{} needs an index", written()), example));
                };
                match index.parse() {
                    Ok(number) if (low..=high).contains(&number) => Place::Number(number),
                    _ => {
                        return Err((
                            format!("there is no `${}[{index}]`", kind.name),
                            format!("its index is a number, {low}..{high}"),
                        ));
                    }
                }
            }
            (Indexing::Axis, Some(index)) if is_name(index) => {
                Place::Axis(index.to_ascii_uppercase())
            }
            (Indexing::Axis, _) => {
                return Err((
                    format!("{} needs the name of an axis", written()),
                    format!("write `${}[X1]`", kind.name),
                ));
            }
        };
        Ok(Self {
            short: kind.short,
            place,
        })
    }

    pub(crate) fn is(&self, short: &str) -> bool {
        self.short == short
    }

    /// A name for tables: `inse_3`, `va_dpe_x1`.
    pub(crate) fn identifier(&self) -> String {
        let short = self.short.to_ascii_lowercase();
        match &self.place {
            Place::None => short,
            Place::Number(index) => format!("{short}_{index}"),
            Place::Axis(axis) => format!("{short}_{}", axis.to_ascii_lowercase()),
        }
    }

    /// As a program writes it: `$A_INSE[3]`.
    #[must_use]
    pub fn written(&self) -> String {
        let name = self.kind().name;
        match &self.place {
            Place::None => format!("${name}"),
            Place::Number(index) => format!("${name}[{index}]"),
            Place::Axis(axis) => format!("${name}[{axis}]"),
        }
    }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.place {
            Place::None => f.write_str(self.short),
            Place::Number(index) => write!(f, "{}[{index}]", self.short),
            Place::Axis(axis) => write!(f, "{}[{axis}]", self.short),
        }
    }
}

impl fmt::Debug for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for Variable {
    type Err = String;

    /// # Errors
    /// What is wrong with the name or the index, and what may stand there.
    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let (name, index) = match text.split_once('[') {
            None => (text, None),
            Some((name, rest)) => match rest.strip_suffix(']') {
                Some(index) => (name, Some(index.trim())),
                None => {
                    return Err(format!(
                        "`{text}`: the bracket is not closed; write INSE[3]"
                    ));
                }
            },
        };
        Self::new(name.trim().trim_start_matches('$'), index)
            .map_err(|(message, help)| format!("{message}; {help}"))
    }
}

/// Whether a text has the form of a name.
pub(crate) fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

fn named(name: &str) -> Option<&'static Kind> {
    KINDS
        .iter()
        .find(|kind| kind.name.eq_ignore_ascii_case(name) || kind.short.eq_ignore_ascii_case(name))
}

/// A name that no variable has: check C8, or a mistake.
fn no_such(name: &str) -> (String, String) {
    let upper = name.to_ascii_uppercase();
    let images = ["INSE", "OUTSE", "INSI", "OUTSI", "MARKERSI"];
    let image = images.iter().find_map(|kind| {
        let rest = upper.trim_start_matches("A_").strip_prefix(kind)?;
        matches!(rest, "P" | "PD").then_some(*kind)
    });
    if let Some(kind) = image {
        return (
            format!("`${name}` is the image of the PLC's variable"),
            format!(
                "it is read before commissioning is complete only, afterwards it is alarm 17210: write `$A_{kind}[...]`"
            ),
        );
    }
    let known = || KINDS.iter().map(|kind| kind.name);
    let shorts = KINDS.iter().map(|kind| kind.short);
    let short = nearest(&upper, shorts).and_then(named);
    let help = match nearest(&upper, known()).or(short.map(|kind| kind.name)) {
        Some(near) => format!("did you mean `${near}`?"),
        None => {
            let list: Vec<String> = known().map(|name| format!("${name}")).collect();
            format!("variables are {}", list.join(", "))
        }
    };
    (format!("there is no system variable `${name}`"), help)
}
