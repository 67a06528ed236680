//! A guarantee in the words of the machine file: an expression over the signals of its safe logic, and what must be true then.

use std::collections::BTreeMap;

use stillpoint_lang::Spec;
use stillpoint_lang::diag::{Diagnostics, Result};

use super::Place;
use super::logic::Logic;

/// What a machine file asks of its safe logic, as it is written there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Own {
    /// The name of the guarantee.
    pub name: String,
    /// What is looked at.
    pub when: Stated,
    /// What must be true then.
    pub then: Stated,
}

/// An expression and its place in the machine file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stated {
    /// As it is written.
    pub text: String,
    /// Where.
    pub place: Place,
}

/// What is asked of a system in place of its own properties.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Asks {
    /// In the words of the file.
    pub own: Own,
    /// How many cycles later it must be true at the latest; none: in the same cycle.
    pub within: Option<i64>,
}

/// Puts the question to a system; `names` are what the signals are called there.
///
/// # Errors
/// An expression is none over these signals: told at its place in the machine file.
pub(super) fn ask(
    spec: &mut Spec,
    system: &str,
    asks: &Asks,
    names: &BTreeMap<String, String>,
    logic: &Logic,
) -> Result<()> {
    let Asks { own, within } = asks;
    let (when, then) = (named(&own.when.text, names), named(&own.then.text, names));
    // Each alone, so that what is wrong has its place.
    for (text, stated) in [(&when, &own.when), (&then, &own.then)] {
        spec.ask(system, &own.name, text, text, None);
        if let Err(Diagnostics(list)) = spec.system(system, None) {
            let what = list.first().map_or(String::new(), |d| d.message.clone());
            let message = format!("guarantee {}: {what}", own.name);
            let known: Vec<&str> = names.keys().map(String::as_str).collect();
            let found = logic.fault(Some(stated.place.clone()), message);
            let help = format!("signals of the safe logic: {}", known.join(", "));
            return Err(found.label("in this expression").help(help).into());
        }
    }
    spec.ask(system, &own.name, &when, &then, *within);
    Ok(())
}

/// The signals that a question names, each once.
pub(super) fn used(own: &Own, signals: &BTreeMap<String, (String, bool)>) -> Vec<(String, bool)> {
    let mut found: Vec<(String, bool)> = Vec::new();
    for stated in [&own.when, &own.then] {
        let mut note = |word: &str| {
            let signal = signals.get(word)?;
            if !found.contains(signal) {
                found.push(signal.clone());
            }
            Some(word.to_owned())
        };
        let _ = rewritten(&stated.text, &mut note);
    }
    found
}

/// An expression with the names of the system: `NOT INSE[1] AND $A_OUTSI[3]` is `NOT spl.contact AND spl.sge_a`.
fn named(text: &str, names: &BTreeMap<String, String>) -> String {
    rewritten(text, &mut |word| names.get(word).cloned())
}

/// An expression in which each word with its index, `OUTSI[3]`, with its bit, `M211.0`, or alone is replaced by what `find` gives for it.
fn rewritten(text: &str, find: &mut impl FnMut(&str) -> Option<String>) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '$';
        if !is_word(first) {
            out.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        }
        let until = |stops: &dyn Fn(char) -> bool| rest.find(stops).unwrap_or(rest.len());
        let end = until(&|c| !is_word(c));
        let dotted = until(&|c| !is_word(c) && c != '.');
        let index = rest[end..].strip_prefix('[').and_then(|t| t.find(']'));
        let whole = index.map_or(end, |k| end + k + 2);
        let found = [whole, dotted, end].into_iter().find_map(|to| {
            let word = &rest[..to];
            let name = find(word.strip_prefix("$A_").unwrap_or(word))?;
            Some((name, to))
        });
        let (name, to) = found.unwrap_or_else(|| (rest[..end].to_owned(), end));
        out.push_str(&name);
        rest = &rest[to..];
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_have_the_names_of_the_table() {
        let pairs = [
            ("INSE[1]", "spl.inse_1"),
            ("DOOR", "spl.inse_1"),
            ("OUTSI[12]", "spl.outsi_12"),
            ("A85.0", "plc.output_85_0"),
            ("DB33.DBX111.4", "plc.db33_dbx111_4"),
        ];
        let names = pairs.map(|(a, b)| (a.to_owned(), b.to_owned())).into();
        let of = |text: &str| named(text, &names);
        assert_eq!(
            of("NOT INSE[1] AND $A_OUTSI[12]"),
            "NOT spl.inse_1 AND spl.outsi_12"
        );
        assert_eq!(of("(DOOR)OR DOOR_2"), "(spl.inse_1)OR DOOR_2");
        assert_eq!(
            of("PREV(OUTSI[12]) = OUTSI[1]"),
            "PREV(spl.outsi_12) = OUTSI[1]"
        );
        assert_eq!(
            of("NOT A85.0 OR DB33.DBX111.4 OR A85.1"),
            "NOT plc.output_85_0 OR plc.db33_dbx111_4 OR A85.1"
        );
        assert_eq!(of("ä = 1"), "ä = 1");
    }
}
