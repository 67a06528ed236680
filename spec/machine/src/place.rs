//! Where in the machine file a value stands that an entry of a family's data points at.

use super::eval::eval;
use super::ground::Ground;
use super::{Place, Setting, Shown};
use stillpoint_lang::syntax::ast::{Expr, Kind};

/// Words that an entry may point at beside parameters.
pub(super) const WORDS: [&str; 3] = ["functions", "axes", "pair"];

/// A value that is pointed at.
#[derive(Debug)]
pub(super) struct Pointed {
    /// The parameter with its value; none for what is no parameter.
    pub shown: Option<Shown>,
    /// Where the file gives it; none: it does not.
    pub place: Option<Place>,
}

impl Ground<'_> {
    /// What `at` points at: a parameter, one value of a list such as `VELO_LIMIT[k]`, or one of [`WORDS`].
    pub fn point(&self, at: &Expr) -> Pointed {
        let (name, index) = match &at.kind {
            Kind::Name(name) => (name.as_str(), None),
            Kind::Index(base, index) => match &base.kind {
                Kind::Name(name) => (name.as_str(), eval(index, &self.values, 1).ok()),
                _ => ("", None),
            },
            _ => ("", None),
        };
        let word = match name {
            "functions" => self.axis.and_then(|a| a.functions_place.clone()),
            "axes" => self.listed(),
            "pair" => self.axis.and_then(|a| Some(a.pair.as_ref()?.span())),
            _ => None,
        };
        let (shown, place) = self.parameter(name, index).unzip();
        Pointed {
            shown,
            place: word.or(place.flatten()),
        }
    }

    /// The place of what the entry is about.
    pub fn place(&self) -> Place {
        if let Some(guarantee) = self.guarantee {
            return guarantee.place.clone();
        }
        let own = match (self.axis, self.door) {
            (Some(axis), None) => Some(axis.place.clone()),
            (None, Some(door)) => Some(door.place.clone()),
            (Some(_), Some(_)) => self.listed(),
            (None, None) => self.group.map(|g| g.place.clone()),
        };
        own.unwrap_or_else(|| self.machine.place.clone())
    }

    /// Where the list of axes or groups of the guarantee, door or group stands; of a guarantee or door and an axis the name in it.
    fn listed(&self) -> Option<Place> {
        let list = match (self.guarantee, self.door, self.group) {
            (Some(guarantee), ..) => &guarantee.axes,
            (None, Some(door), _) => &door.axes,
            (None, None, Some(group)) => &group.axes,
            (None, None, None) => return None,
        };
        let own = |name: &&toml::Spanned<String>| {
            let among = self.door.is_some() || self.guarantee.is_some();
            let axis = self.axis.filter(|_| among);
            axis.is_none_or(|a| a.name == *name.get_ref())
        };
        list.iter().find(own).map(toml::Spanned::span)
    }

    /// A parameter, or one of its values; without an axis that of the first axis that gives it, with the values of all.
    fn parameter(&self, name: &str, index: Option<i64>) -> Option<(Shown, Option<Place>)> {
        let family = &self.machine.basis.family;
        let pattern = self.guarantee.and_then(|g| family.patterns.get(&g.pattern));
        let argument = pattern.and_then(|pattern| pattern.arguments.get(name));
        let param = argument.or_else(|| family.parameter(name))?;
        let cell = usize::try_from(index.unwrap_or(0)).ok()?;
        let own: Option<&Setting> = self.settings().find_map(|s| s.get(name));
        let members = self.members().filter_map(|a| a.values.get(name));
        let all: Vec<&Setting> = match own {
            Some(setting) => vec![setting],
            None => members.collect(),
        };
        let value = match (index, own) {
            (None, Some(setting)) if setting.shown.len() > 1 => {
                format!("[{}]", setting.shown.join(", ").replace('"', ""))
            }
            _ => self.shown(name, cell)?,
        };
        let written = match index {
            Some(k) => format!("{name}[{k}]"),
            None => name.to_owned(),
        };
        let place = all.iter().find_map(|s| s.places.get(cell).cloned());
        let shown = Shown {
            name: written,
            manual: param.manual.clone(),
            text: param.text.clone(),
            value,
            given: place.is_some(),
        };
        Some((shown, place))
    }
}
