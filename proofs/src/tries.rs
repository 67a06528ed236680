//! What the enumeration tries for the numbers of a monitor.
//!
//! Truth values, choices and narrow numbers are tried whole. What is tried for a wide one is said by a list such as
//! `"path still: 0..2 max; begin: -4..4 ends"`: names, then values: numbers, ranges, `min` and `max` of its type, `ends` for
//! both. A name stands for every number below it (`limits` for `config.limits.0`); where two monitors' parts have the
//! same name, the part says which is meant (`state.timer`). The first list with the name counts.

use stillpoint_monitors::contract::Contract;
use stillpoint_monitors::fields::{Fields, Kind, Visitor, walk};

use crate::draw::Case;
use crate::source::Source;

/// A number with at most so many values is tried whole.
const NARROW: i64 = 8;

/// How often random numbers are tried that make no configuration, or no state.
const ATTEMPTS: usize = 50;

/// The values of each number, in the order of a visit.
pub type Values = Vec<Vec<i64>>;

/// The values that are tried for the numbers of a monitor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tries {
    /// Of the configuration.
    pub config: Values,
    /// Of the state.
    pub state: Values,
    /// Of the inputs.
    pub inputs: Values,
}

/// One list: names and the words for their values.
struct List<'a> {
    names: Vec<&'a str>,
    words: Vec<&'a str>,
    used: bool,
}

impl List<'_> {
    /// Its values for a number from `low` to `high`, ascending.
    fn values(&self, (low, high): (i64, i64)) -> Result<Vec<i64>, String> {
        let mut values = Vec::new();
        for word in &self.words {
            match word.split_once("..") {
                Some((from, to)) => values.extend(number(from)?..=number(to)?),
                None if *word == "min" => values.push(low),
                None if *word == "max" => values.push(high),
                None if *word == "ends" => values.extend([low, high]),
                None => values.push(number(word)?),
            }
        }
        values.retain(|value| (low..=high).contains(value));
        values.sort_unstable();
        values.dedup();
        Ok(values)
    }
}

fn number(word: &str) -> Result<i64, String> {
    word.parse()
        .map_err(|_| format!("`{word}` is no number, range, `min`, `max` or `ends`"))
}

/// Whether `name`, some names joined by dots, stands in `path` as it is.
pub(crate) fn names(path: &[&str], name: &str) -> bool {
    let parts: Vec<&str> = name.split('.').collect();
    path.windows(parts.len()).any(|window| window == parts)
}

impl Tries {
    /// The values for the numbers of `M`.
    ///
    /// # Errors
    /// A number of which no list speaks, a list of which no number is, a word that says no value: one line each.
    pub fn of<M: Contract>(text: &str) -> Result<Self, String> {
        let list = |(names, words)| List {
            names,
            words,
            used: false,
        };
        let mut lists: Vec<List> = lists_of(text).into_iter().map(list).collect();
        let mut errors = Vec::new();
        let tries = Self {
            config: values_of::<M::Config>("config", &mut lists, &mut errors),
            state: values_of::<M::State>("state", &mut lists, &mut errors),
            inputs: values_of::<M::Inputs>("inputs", &mut lists, &mut errors),
        };
        let unused = lists.iter().filter(|list| !list.used);
        errors.extend(unused.map(|list| format!("no number is called {}", list.names.join(", "))));
        if errors.is_empty() {
            Ok(tries)
        } else {
            Err(errors.join("\n"))
        }
    }

    /// A step of these numbers; none where they make none. A random one is tried again, the configuration first.
    pub fn step<M: Contract, S: Source>(&self, source: &mut S) -> Option<Case<M>> {
        let attempts = if source.enumerates() { 1 } else { ATTEMPTS };
        let mut configs = (0..attempts).map(|_| chosen(&self.config, source));
        let config = configs.find(M::accepted)?;
        let mut states = (0..attempts).map(|_| chosen(&self.state, source));
        let state = states.find(|state| M::invariant(state, &config))?;
        Some((state, config, chosen(&self.inputs, source)))
    }
}

/// The values of the numbers of one part of a step.
fn values_of<T: Fields>(
    part: &'static str,
    lists: &mut [List],
    errors: &mut Vec<String>,
) -> Values {
    let mut found = Vec::new();
    walk::<T>(part, |path, kind| {
        let (low, high) = kind.ends();
        let own = (lists.iter_mut()).find(|list| list.names.iter().any(|n| names(path, n)));
        let values = match own {
            Some(list) => {
                list.used = true;
                list.values((low, high))
            }
            None => match kind {
                Kind::Choice(variants) => Ok(variants.iter().map(|(_, number)| *number).collect()),
                _ if high.saturating_sub(low) < NARROW => Ok((low..=high).collect()),
                _ => Err("no list says what is tried".to_owned()),
            },
        };
        match values {
            Ok(values) if !values.is_empty() => found.push(values),
            Ok(_) => errors.push(format!("{}: no value", path.join("."))),
            Err(what) => errors.push(format!("{}: {what}", path.join("."))),
        }
    });
    found
}

/// The lists of a text: names and words.
fn lists_of(text: &str) -> Vec<(Vec<&str>, Vec<&str>)> {
    let lists = text.split(';').filter(|list| !list.trim().is_empty());
    lists
        .map(|list| {
            let (names, words) = list.split_once(':').unwrap_or((list, ""));
            (
                names.split_whitespace().collect(),
                words.split_whitespace().collect(),
            )
        })
        .collect()
}

/// The lists in words.
pub fn in_words(text: &str) -> String {
    let word = |word: &str| match word.split_once("..") {
        Some((from, to)) => format!("{from} to {to}"),
        None => match word {
            "min" => "the least".to_owned(),
            "max" => "the greatest".to_owned(),
            "ends" => "the ends of its type".to_owned(),
            number => number.to_owned(),
        },
    };
    let lists = lists_of(text).into_iter().map(|(names, words)| {
        let words: Vec<String> = words.into_iter().map(word).collect();
        format!("{} {}", names.join(", "), words.join(", "))
    });
    let lists: Vec<String> = lists.collect();
    if lists.is_empty() {
        "complete".to_owned()
    } else {
        format!("{}; all else whole", lists.join("; "))
    }
}

/// Chooses each number that it is shown among its values. Where the source does not try one after the other, also any other
/// value.
struct Chooser<'a, S> {
    values: &'a [Vec<i64>],
    source: &'a mut S,
    absent: bool,
}

impl<S: Source> Visitor for Chooser<'_, S> {
    fn number(&mut self, _: &'static str, kind: Kind, value: i64) -> i64 {
        let Some((own, rest)) = self.values.split_first() else {
            return value;
        };
        self.values = rest;
        if self.absent {
            return value;
        }
        let (low, high) = kind.ends();
        let whole = own.len() as i64 > high.saturating_sub(low);
        if !self.source.enumerates() && !whole && self.source.any_bool() {
            return self.source.any_whole(low, high);
        }
        let place = self.source.any_in(0, own.len() as u32 - 1);
        own[place as usize]
    }

    fn absent(&mut self) {
        self.absent = true;
    }

    fn present(&mut self) {
        self.absent = false;
    }
}

fn chosen<T: Fields>(values: &[Vec<i64>], source: &mut impl Source) -> T {
    let mut value = T::ANY;
    value.visit(
        "",
        &mut Chooser {
            values,
            source,
            absent: false,
        },
    );
    value
}
