//! A system as AIGER, for bit-level checkers.
//!
//! One step is one cycle, each bit of a variable an input or a latch with its name in the table of symbols. Each `always` or `never`
//! property is one `bad`, a `reachable` one an output. A cycle with a range fault leaves the state as it is and is a `bad` of its own.

use stillpoint_lang::bind::Bound;
use stillpoint_model::proof::Lit;
use stillpoint_model::proof::aiger::{Marks, aiger as write};

use super::Unsupported;
use super::about::{about, not_carried};
use super::btor2::RANGE;
use super::netlist::Translated;

/// The model of a system with its parameter values, as ASCII text or in the binary form. `title` stands in its comment. With `only`,
/// the one property with this id (or [`RANGE`]) is its only `bad`.
///
/// # Errors
/// A system with values that need more than 32 bits; an id that names no `always` or `never` property.
pub fn aiger(
    bound: &Bound,
    title: &str,
    only: Option<&str>,
    binary: bool,
) -> Result<Vec<u8>, Unsupported> {
    let translated = Translated::new(bound)?;
    let mut bad = translated.broken.clone();
    if translated.fault != Lit::FALSE {
        bad.insert(0, (RANGE.to_owned(), translated.fault));
    }
    let mut outputs = translated.shown.clone();
    if let Some(id) = only {
        let known: Vec<&str> = bad.iter().map(|(id, _)| id.as_str()).collect();
        if !known.contains(&id) {
            return Err(Unsupported(format!(
                "there is no `always` or `never` property `{id}`; there are {}",
                known.join(", ")
            )));
        }
        bad.retain(|(known, _)| known == id);
        outputs.clear();
    }
    let mut comment = about(bound, title);
    comment.extend(not_carried(&translated.left_out));
    let one_word = |list: Vec<(String, Lit)>| {
        let list = list.into_iter();
        list.map(|(id, lit)| (id.split_whitespace().collect::<Vec<_>>().join("_"), lit))
            .collect()
    };
    let marks = Marks {
        bad: one_word(bad),
        outputs: one_word(outputs),
        comment,
    };
    Ok(write(&translated.netlist, &marks, binary))
}
