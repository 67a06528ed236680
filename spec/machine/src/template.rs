//! Texts of a family's data with values of the machine in them.
//!
//! `{axis}` a name of the subject; `{VELO_LIMIT[k]}` a parameter as its user writes it; `{stop}` the word that the data give a
//! named expression; `{CYCLES(STOP_SWITCH_TIME_C)}` any other expression as a number; `{2 * monitoring_cycle : time}` as a
//! value of a quantity.

use std::collections::BTreeMap;

use toml::Spanned;

use super::document::Findings;
use super::eval::names;
use super::family::Quantity;
use super::ground::{About, DataFile, Ground, read_names};
use stillpoint_lang::diag::{Result, nearest};
use stillpoint_lang::syntax::ast::{Expr, Kind};
use stillpoint_lang::syntax::parse_expr;

/// A text with places to be filled in.
#[derive(Debug)]
pub(super) struct Template {
    pieces: Vec<Piece>,
    span: super::Place,
}

#[derive(Debug)]
enum Piece {
    Text(String),
    Title(String),
    Word(Expr, Vec<String>),
    /// With the expression as it is written.
    Value(Expr, Option<Quantity>, String),
}

/// A text with plain places, filled in with what `place` gives for each.
///
/// # Errors
/// The first place that it does not know.
pub(super) fn filled(
    text: &str,
    mut place: impl FnMut(&str) -> Option<String>,
) -> std::result::Result<String, String> {
    let mut out = String::new();
    let mut rest = text;
    while let Some((plain, after)) = rest.split_once('{') {
        out.push_str(plain);
        let (name, tail) = after.split_once('}').unwrap_or((after, ""));
        out.push_str(&place(name).ok_or_else(|| name.to_owned())?);
        rest = tail;
    }
    out.push_str(rest);
    Ok(out)
}

/// What the texts of an entry may name.
pub(super) struct Words<'a> {
    /// What the entry is about.
    pub about: About,
    /// The names that expressions may read.
    pub known: &'a [String],
    /// Named expressions that are shown as words, the value being the index.
    pub words: &'a [(String, Vec<String>)],
}

impl Template {
    /// Parses a text. `None` leaves a finding.
    pub fn parse(
        text: Spanned<String>,
        words: &Words<'_>,
        findings: &mut Findings,
    ) -> Option<Self> {
        let span = text.span();
        let mut pieces = Vec::new();
        let mut rest = text.get_ref().as_str();
        while let Some((before, after)) = rest.split_once('{') {
            let Some((inside, tail)) = after.split_once('}') else {
                let help = "close the place to be filled in with '}'";
                findings.add(span, "'{' without '}'", "in this text", help);
                return None;
            };
            pieces.push(Piece::Text(before.to_owned()));
            match piece(inside.trim(), words) {
                Ok(piece) => pieces.push(piece),
                Err((message, help)) => {
                    findings.add(span, message, "in this text", help);
                    return None;
                }
            }
            rest = tail;
        }
        pieces.push(Piece::Text(rest.to_owned()));
        Some(Self { pieces, span })
    }

    /// The text for one subject.
    ///
    /// # Errors
    /// A value that does not exist for it, which is a fault of the family's data.
    pub fn fill(&self, file: &DataFile, ground: &Ground<'_>) -> Result<String> {
        self.filled(file, ground, false)
    }

    /// A text of lines `key = value` for one subject, in which the lines of a time end with a comment that gives the formula it
    /// was computed from.
    ///
    /// # Errors
    /// As [`Template::fill`].
    pub fn fill_lines(&self, file: &DataFile, ground: &Ground<'_>) -> Result<String> {
        self.filled(file, ground, true)
    }

    fn filled(&self, file: &DataFile, ground: &Ground<'_>, formulas: bool) -> Result<String> {
        let mut out = String::new();
        let mut formula: Option<&str> = None;
        for piece in &self.pieces {
            match piece {
                Piece::Text(text) => match (formula.take(), text.split_once('\n')) {
                    (Some(formula), Some((rest, below))) => {
                        out.push_str(&format!("{rest} # {formula}\n{below}"));
                    }
                    _ => out.push_str(text),
                },
                Piece::Title(name) => out.push_str(&ground.title(name).unwrap_or_default()),
                Piece::Word(expr, words) => {
                    let value = ground.eval(file, expr, self.span.clone())?;
                    let word = usize::try_from(value).ok().and_then(|k| words.get(k));
                    out.push_str(&word.map_or_else(|| value.to_string(), Clone::clone));
                }
                Piece::Value(expr, Some(quantity), text) => {
                    let is_time = formulas && matches!(quantity, Quantity::Time);
                    formula = is_time.then_some(text.as_str());
                    let value = ground.eval(file, expr, self.span.clone())?;
                    out.push_str(&ground.quantity(*quantity, value));
                }
                Piece::Value(expr, None, _) => {
                    let own = matches!(expr.kind, Kind::Name(_) | Kind::Index(_, _));
                    match ground.reads(expr).into_values().next().filter(|_| own) {
                        Some(shown) => out.push_str(&shown),
                        None => {
                            let value = ground.eval(file, expr, self.span.clone())?;
                            out.push_str(&value.to_string());
                        }
                    }
                }
            }
        }
        Ok(out)
    }

    /// The names that its expressions read.
    pub fn reads(&self) -> Vec<String> {
        self.expressions().flat_map(read_names).collect()
    }

    /// The parameters that its expressions read, with their values.
    pub fn values(&self, ground: &Ground<'_>) -> BTreeMap<String, String> {
        self.expressions().flat_map(|e| ground.reads(e)).collect()
    }

    fn expressions(&self) -> impl Iterator<Item = &Expr> {
        self.pieces.iter().filter_map(|piece| match piece {
            Piece::Word(expr, _) | Piece::Value(expr, ..) => Some(expr),
            Piece::Text(_) | Piece::Title(_) => None,
        })
    }
}

/// A place to be filled in, or why it cannot be: message and help.
fn piece(inside: &str, words: &Words<'_>) -> std::result::Result<Piece, (String, String)> {
    if words.about.titles().contains(&inside) {
        return Ok(Piece::Title(inside.to_owned()));
    }
    let (text, quantity) = match inside.rsplit_once(':') {
        Some((text, name)) => (text.trim(), Some(quantity(name.trim())?)),
        None => (inside, None),
    };
    let expr = parse_expr(text).map_err(|e| (e.message, e.help))?;
    let mut unknown = None;
    names(&expr, &mut |name| {
        if !words.known.iter().any(|k| k == name) {
            unknown.get_or_insert(name.to_owned());
        }
    });
    if let Some(name) = unknown {
        let help = match nearest(&name, words.known.iter().map(String::as_str)) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!("names here: {}", words.about.titles().join(", ")),
        };
        return Err((format!("unknown name '{name}'"), help));
    }
    if let (Kind::Name(name), None) = (&expr.kind, quantity) {
        if let Some((_, list)) = words.words.iter().find(|(known, _)| known == name) {
            return Ok(Piece::Word(expr, list.clone()));
        }
    }
    Ok(Piece::Value(expr, quantity, text.to_owned()))
}

fn quantity(name: &str) -> std::result::Result<Quantity, (String, String)> {
    match name {
        "time" => Ok(Quantity::Time),
        "length" => Ok(Quantity::Length),
        "speed" => Ok(Quantity::Speed),
        _ => Err((
            format!("unknown quantity '{name}'"),
            "write time, length or speed".to_owned(),
        )),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{families, load};

    fn fill(text: &str) -> std::result::Result<String, String> {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = path.join("../machines/milling-840d.toml");
        let machine = load(&path, &families(&path)).map_err(|e| e.to_string())?;
        let file = DataFile {
            file: "test".to_owned(),
            source: Arc::from(text),
        };
        let known = About::Axis.known(&machine.basis.family);
        let words = [(
            "enabled_SE".to_owned(),
            vec!["no SE".to_owned(), "SE".to_owned()],
        )];
        let words = Words {
            about: About::Axis,
            known: &known,
            words: &words,
        };
        let mut check = file.check();
        let spanned = Spanned::new(0..text.len(), text.to_owned());
        let template = Template::parse(spanned, &words, &mut check.findings);
        let Some(template) = template else {
            return Err(check.findings.into_diagnostics().to_string());
        };
        let grounds = super::super::ground::grounds(&machine, About::Axis);
        let mut ground = grounds.into_iter().next().ok_or("no axis")?;
        ground.count_to(1);
        template.fill(&file, &ground).map_err(|e| e.to_string())
    }

    #[test]
    fn places_are_filled_in() {
        for (text, filled) in [
            ("plain", "plain"),
            ("{axis} with {partners}", "X with Y, Z"),
            (
                "SG{n}: {VELO_LIMIT[k]}, {VELO_STOP_REACTION[k]}",
                "SG2: 5000 mm/min, STOP D",
            ),
            ("{CYCLES(STOP_SWITCH_TIME_F)} cycles", "9 cycles"),
            ("{2 * monitoring_cycle : time}", "24 ms"),
            ("{STANDSTILL_TOL + 1 : length}", "0.501 mm"),
            ("{enabled_SE}", "SE"),
        ] {
            assert_eq!(fill(text).as_deref(), Ok(filled), "{text}");
        }
    }

    #[test]
    fn what_cannot_be_filled_in_is_an_error() {
        for text in [
            "{axis",
            "{AXIS}",
            "{door}",
            "{VELO_LIMIT[9]}",
            "{monitoring_cycle : colour}",
            "{1 +}",
            "{1 / 0}",
        ] {
            assert!(fill(text).is_err(), "{text}");
        }
    }
}
