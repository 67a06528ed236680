//! Reads what a family explores: entries of `[[explore]]` and of `[[pattern.NAME.explore]]`.

use std::ops::{Range, RangeInclusive};

use indexmap::IndexMap;
use serde::Deserialize;
use toml::Spanned;

use super::family::{
    BEFORE, Binding, Explore, Formula, Known, MEMBERS, Rounding, Scope, Target, Wire,
};
use super::family_file::Check;

/// Bindings that several entries have in common, under a name: `[share.NAME]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ShareData {
    #[serde(default)]
    time: IndexMap<String, Spanned<String>>,
    #[serde(default)]
    param: IndexMap<String, Spanned<String>>,
    #[serde(default)]
    wire: IndexMap<String, Spanned<String>>,
}

/// The shared bindings of a file.
pub(super) type Shares = IndexMap<Spanned<String>, ShareData>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExploreData {
    /// The shared bindings that it has too. Its own ones stand before them, and those named first before the later ones.
    #[serde(default)]
    share: Vec<Spanned<String>>,
    file: String,
    system: String,
    each: Scope,
    when: Spanned<String>,
    text: String,
    #[serde(default)]
    time: IndexMap<String, Spanned<String>>,
    /// Times that no parameter gives, such as one that the manual fixes, to be rounded down.
    #[serde(default)]
    down: Vec<Spanned<String>>,
    #[serde(default)]
    param: IndexMap<String, Spanned<String>>,
    #[serde(default)]
    rank: IndexMap<Spanned<String>, Vec<String>>,
    members: Option<Members>,
    cycle: Option<Spanned<String>>,
    before: Option<Spanned<String>>,
    scan: Option<Spanned<String>>,
    travel: Option<Spanned<String>>,
    window: Option<Spanned<String>>,
    #[serde(default)]
    wire: IndexMap<String, Spanned<String>>,
    #[serde(default)]
    covers: IndexMap<Spanned<String>, Spanned<String>>,
    #[serde(default)]
    note: String,
    #[serde(default)]
    chosen: String,
}

/// For how many axes a system of a group is.
#[derive(Deserialize, Clone, Copy)]
#[serde(untagged)]
enum Members {
    Exactly(usize),
    Between(usize, usize),
}

impl From<Members> for RangeInclusive<usize> {
    fn from(members: Members) -> Self {
        match members {
            Members::Exactly(n) => n..=n,
            Members::Between(least, most) => least..=most,
        }
    }
}

impl ExploreData {
    /// Whether it takes what is shared under a name.
    pub fn takes(&self, name: &str) -> bool {
        self.share.iter().any(|taken| taken.get_ref() == name)
    }
}

impl Check {
    /// Binds what the entry shares with others.
    pub fn share(&mut self, explore: &mut ExploreData, shares: &Shares) {
        for name in std::mem::take(&mut explore.share) {
            let Some(share) = shares.get(&name) else {
                let known: Vec<&str> = shares.keys().map(|name| name.get_ref().as_str()).collect();
                let message = format!("nothing is shared as '{}'", name.get_ref());
                let help = format!("shared by this file: {}", known.join(", "));
                self.findings.add(name.span(), message, "", help);
                continue;
            };
            for (own, shared) in [
                (&mut explore.time, &share.time),
                (&mut explore.param, &share.param),
                (&mut explore.wire, &share.wire),
            ] {
                for (name, formula) in shared {
                    own.entry(name.clone()).or_insert_with(|| formula.clone());
                }
            }
        }
    }

    /// What the entries of a file say.
    pub fn explores(&mut self, list: Vec<ExploreData>, known: &Known) -> Vec<Explore> {
        let list = list.into_iter();
        list.filter_map(|data| self.explore(data, known)).collect()
    }

    /// What one entry of `[[explore]]` says.
    fn explore(&mut self, data: ExploreData, known: &Known) -> Option<Explore> {
        if data.each == Scope::Control {
            let help = "write each = \"axis\", \"group\", \"door\" or \"machine\"";
            let message = "no systems are explored for the control alone";
            self.findings.add(data.when.span(), message, "", help);
        }
        let members: Option<RangeInclusive<usize>> = data.members.map(Into::into);
        let of_group = data.each == Scope::Group;
        if of_group && members.is_none() && !known.groups {
            let help = "write members = 3, or declare the parameters of a group";
            let message = "how many axes has the system?";
            self.findings.add(data.when.span(), message, "", help);
        }
        if members
            .as_ref()
            .is_some_and(|m| !of_group || m.is_empty() || *m.start() < 2)
        {
            let help = "write members = 3 or members = [2, 12], with each = \"group\"";
            let message = "a group of how many axes?";
            self.findings.add(data.when.span(), message, "", help);
        }
        let roundings = |formula: &Formula| known.roundings(formula);
        let known = known.of_explored(data.each, members.is_some());
        let mut optional = |text: Option<Spanned<String>>| match text {
            Some(text) => self.formula(text, known).map(Some),
            None => Some(None),
        };
        let cycle = optional(data.cycle)?;
        let before = optional(data.before)?;
        let scan = optional(data.scan)?;
        let travel = optional(data.travel)?;
        let window = optional(data.window)?;
        let mut wires = Vec::new();
        for (port, text) in data.wire {
            let written = text.get_ref();
            let (written, optional) = match written.strip_suffix('?') {
                Some(name) => (name, true),
                None => (written.as_str(), false),
            };
            let (name, index) = match written.strip_suffix(']').and_then(|t| t.split_once('[')) {
                Some((name, index)) => (name, index.parse().ok()),
                None => (written, Some(0)),
            };
            match index.filter(|_| known.iter().any(|k| k == name)) {
                Some(index) => wires.push(Wire {
                    port,
                    name: name.to_owned(),
                    index,
                    optional,
                }),
                None => {
                    let help = "name a parameter that is a signal, with [0] for the first of a list, and ? where it may be none";
                    let message = format!("'{written}' is no parameter here");
                    self.findings.add(text.span(), message, "", help);
                }
            }
        }
        let mut covers = Vec::new();
        for (name, text) in data.covers {
            if !self.faults.contains(name.get_ref()) {
                let message = format!("there is no fault '{}'", name.get_ref());
                let help = format!("faults of this file: {}", self.faults.join(", "));
                self.findings.add(name.span(), message, "", help);
            }
            covers.push((name.into_inner(), self.formula(text, known)?));
        }
        let mut params = Vec::new();
        let mut of_param = known.to_vec();
        of_param.extend(before.iter().map(|_| BEFORE.to_owned()));
        of_param.extend(members.iter().map(|_| MEMBERS.to_owned()));
        for (name, text) in data.param {
            let target = self.target(&name, members.is_some(), text.span());
            params.push(Binding::Value(target, self.formula(text, &of_param)?));
        }
        for name in &data.down {
            if !data.time.contains_key(name.get_ref()) {
                let message = format!("'{}' is no time here", name.get_ref());
                let help = "name one of the keys of time";
                self.findings.add(name.span(), message, "", help);
            }
        }
        for (name, text) in data.time {
            let span = text.span();
            let formula = self.formula(text, known)?;
            let down = data.down.iter().any(|d| *d.get_ref() == name);
            let rounding = match roundings(&formula).as_slice() {
                [] if down => Rounding::Down,
                [] => Rounding::Up,
                [own] if down && *own != Rounding::Down => {
                    let message = "the parameter has a rounding of its own";
                    self.findings.add(span, message, "", "leave it out of down");
                    return None;
                }
                [one] => *one,
                _ => {
                    let message = "one of these times is rounded up to whole cycles, another down";
                    let help = "write it under param, with CYCLES(...) for up and / monitoring_cycle for down";
                    self.findings.add(span, message, "", help);
                    return None;
                }
            };
            let target = self.target(&name, members.is_some(), span);
            params.push(Binding::Time(target, formula, rounding));
        }
        for (list, names) in data.rank {
            if !known.contains(list.get_ref()) {
                let message = format!("unknown name '{}'", list.get_ref());
                self.findings
                    .add(list.span(), message, "", "name a list of values");
            }
            params.push(Binding::Rank(list.into_inner(), names));
        }
        Some(Explore {
            file: data.file,
            system: data.system,
            each: data.each,
            when: self.formula(data.when, known)?,
            text: data.text,
            note: data.note,
            chosen: data.chosen,
            members,
            cycle,
            before,
            scan,
            travel,
            window,
            wires,
            covers,
            params,
        })
    }

    /// The parameter of a key: `name`, or `name[]` with a cell for each member.
    fn target(&mut self, key: &str, of_members: bool, span: Range<usize>) -> Target {
        let array = key.strip_suffix("[]");
        if array.is_some() && !of_members {
            let help = "leave [] out, or say how many members the group has: members = 3";
            let message = format!("'{key}' has a cell for each member, and there are none");
            self.findings.add(span, message, "", help);
        }
        Target {
            name: array.unwrap_or(key).to_owned(),
            each: array.is_some(),
        }
    }
}
