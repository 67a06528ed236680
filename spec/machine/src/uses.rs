//! One parameter of a family as its users call it, and what reads it: rules, warnings, guarantees, explored systems, safety functions.

use std::path::Path;

use serde::Deserialize;
use stillpoint_lang::diag::Result;
use stillpoint_lang::syntax::ast::Expr;

use super::data::Datum;
use super::family::{Binding, Explore, Family, Rule};
use super::ground::{DataFile, read_names};
use super::guarantee::Pattern;
use super::{family_file, warnings};

/// What reads a parameter.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Uses {
    /// The safety functions whose page of the book shows it.
    pub functions: Vec<String>,
    /// Rules of plausibility: what must not be, and what to do.
    pub rules: Vec<(String, String)>,
    /// Warnings: name, and what is unusual.
    pub warnings: Vec<(String, String)>,
    /// The patterns of guarantees whose answer it decides.
    pub patterns: Vec<String>,
    /// Systems that are explored whatever a file guarantees: `stop (axis.toml)`, and what each shows.
    pub systems: Vec<(String, String)>,
}

/// `pages.toml` of a family, as far as it tells which parameters belong to a safety function.
#[derive(Deserialize)]
struct Pages {
    page: Vec<Page>,
}

#[derive(Debug, Deserialize)]
struct Page {
    title: String,
    parameters: Vec<String>,
}

/// The data of a family that read its parameters.
#[derive(Debug)]
pub struct Readers {
    family: Family,
    warnings: Vec<warnings::Known>,
    pages: Vec<Page>,
}

impl Readers {
    /// Those of the family in `folder`.
    ///
    /// # Errors
    /// The files of the family are wrong.
    pub fn load(folder: &Path) -> Result<Self> {
        const FILE: &str = "pages.toml";
        let family = family_file::load(folder)?;
        let pages = match stillpoint_lang::files::is_file(&folder.join(FILE)) {
            true => {
                DataFile::read(folder, FILE, "pages")?
                    .parse::<Pages>()?
                    .page
            }
            false => Vec::new(),
        };
        Ok(Self {
            family,
            warnings: warnings::catalogue(folder)?,
            pages,
        })
    }

    /// What reads the parameter of this name.
    pub fn of(&self, name: &str) -> Uses {
        let family = &self.family;
        let reads = |names: Vec<String>| family.resolved(names).contains(name);
        let ruled = |rule: &&Rule| reads(read_names(&rule.when.expr));
        let explored =
            |e: &&Explore| reads(of_system(e, &read_names)) || reads(of_wires(e).collect());
        let decides = |pattern: &Pattern| {
            pattern.explore.iter().any(|e| explored(&e)) || pattern.rules.iter().any(|r| ruled(&r))
        };
        let rules = family.rules.iter().filter(ruled);
        let patterns = family.patterns.iter().filter(|(_, p)| decides(p));
        let systems = family.explore.iter().filter(explored);
        let known = self.warnings.iter();
        let known = known.filter(|w| w.reads.iter().any(|n| n == name));
        let pages = self.pages.iter();
        let pages = pages.filter(|p| p.parameters.iter().any(|n| n == name));
        Uses {
            functions: pages.map(|p| p.title.clone()).collect(),
            rules: rules.map(|r| (r.text.clone(), r.fix.clone())).collect(),
            warnings: known.map(|w| (w.id.clone(), w.text.clone())).collect(),
            patterns: patterns.map(|(name, _)| name.clone()).collect(),
            systems: systems
                .map(|e| (format!("{} ({})", e.system, e.file), e.text.clone()))
                .collect(),
        }
    }
}

/// The signals that a program in an explored system is connected to.
pub(super) fn of_wires(explore: &Explore) -> impl Iterator<Item = String> + '_ {
    explore.wires.iter().map(|wire| wire.name.clone())
}

/// The names that an explored system reads, those of each expression by `read`.
pub(super) fn of_system(explore: &Explore, read: &dyn Fn(&Expr) -> Vec<String>) -> Vec<String> {
    let mut names = read(&explore.when.expr);
    let times = explore.cycle.iter().chain(&explore.before);
    let ways = explore.travel.iter().chain(&explore.window);
    let times = times.chain(&explore.scan).chain(ways);
    names.extend(times.flat_map(|f| read(&f.expr)));
    for binding in &explore.params {
        match binding {
            Binding::Value(_, formula) | Binding::Time(_, formula, _) => {
                names.extend(read(&formula.expr))
            }
            Binding::Rank(list, _) => names.push(list.clone()),
        }
    }
    names
}

impl Datum {
    /// Whether a user may call it so: `STANDSTILL_TOL`, `VELO_LIMIT[2]`, `MD36930`, `36930`, `1330`, `$MA_SAFE_STANDSTILL_TOL`,
    /// `SMP525.x`, `525`; a parameter that stands for one bit also by the name of all of them, `SMP560`.
    pub fn is_called(&self, word: &str) -> bool {
        let word = word.trim().to_uppercase();
        let word = word.split('[').next().unwrap_or_default();
        let word = word.strip_suffix(".X").unwrap_or(word);
        let short = word.strip_prefix("SAFE_").unwrap_or(word);
        let names = self.names();
        !word.is_empty() && names.iter().any(|name| name == word || name == short)
    }

    /// The words that users have for it, in capitals.
    fn names(&self) -> Vec<String> {
        let own = self.name.to_uppercase();
        let mut names = vec![own.clone()];
        if let Some((all, bit)) = own.rsplit_once('_') {
            if bit.bytes().all(|b| b.is_ascii_digit()) {
                names.extend([format!("{all}.{bit}"), format!("{all} BIT {bit}")]);
                names.push(all.to_owned());
            }
        } else {
            names.extend(number(&own));
        }
        let mut series = "";
        let printed = self.manual.split(['/', ' ']);
        for printed in printed.filter(|w| !w.is_empty() && *w != "bit") {
            let printed = printed.strip_suffix(".x").unwrap_or(printed);
            if printed.bytes().all(|b| b.is_ascii_digit()) {
                // A further number of the same series: MD36930/1330. The number of a bit is none.
                if !series.is_empty() {
                    names.extend([printed.to_owned(), format!("{series}{printed}")]);
                }
                continue;
            }
            if let Some(digits) = number(printed).filter(|_| printed.starts_with("MD")) {
                series = "MD";
                names.push(digits);
            }
            names.push(printed.to_uppercase());
            // The name in the other channel begins otherwise.
            if let Some((_, rest)) = printed.strip_prefix('$').and_then(|p| p.split_once('_')) {
                names.extend([rest.to_uppercase(), format!("$MD_{rest}")]);
            }
        }
        names
    }
}

/// The digits at the end of a name that has letters in front of them only.
fn number(name: &str) -> Option<String> {
    let digits = name.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let all = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
    (all && digits.len() < name.len()).then(|| digits.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn called(family: &str, word: &str) -> Vec<String> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../families");
        let data = crate::data::load(&folder.join(family)).expect("a family");
        let found = data.parameters.into_iter().filter(|d| d.is_called(word));
        found.map(|d| d.name).collect()
    }

    #[test]
    fn a_parameter_is_found_as_its_users_call_it() {
        for word in [
            "STANDSTILL_TOL",
            "standstill_tol",
            "SAFE_STANDSTILL_TOL",
            "$MA_SAFE_STANDSTILL_TOL",
            "$MD_SAFE_STANDSTILL_TOL",
            "MD36930",
            "md1330",
            "36930",
            "1330",
            "STANDSTILL_TOL[0]",
        ] {
            assert_eq!(called("sinumerik-840d", word), ["STANDSTILL_TOL"], "{word}");
        }
        for word in ["SAFE_SPL_STOP_MODE", "10097", "$MN_SAFE_SPL_STOP_MODE"] {
            assert_eq!(
                called("sinumerik-840d", word),
                ["SAFE_SPL_STOP_MODE"],
                "{word}"
            );
        }
        for word in ["SMP525", "SMP525.x", "smp525.X", "525"] {
            assert_eq!(called("heidenhain-fs", word), ["SMP525"], "{word}");
        }
        for word in ["SMP560_3", "SMP560.3", "SMP560 bit 3"] {
            assert_eq!(called("heidenhain-fs", word), ["SMP560_3"], "{word}");
        }
        assert_eq!(called("heidenhain-fs", "SMP560").len(), 13);
        assert_eq!(called("heidenhain-fs", "7602"), ["MP7602"]);
        for word in ["", "bit", "0", "SMP", "TOL", "MD"] {
            assert!(called("heidenhain-fs", word).is_empty(), "{word}");
            assert!(called("sinumerik-840d", word).is_empty(), "{word}");
        }
    }

    #[test]
    fn what_reads_a_parameter_is_told_through_named_expressions_too() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../families");
        let readers = |family: &str| Readers::load(&folder.join(family)).expect("a family");
        let of = |family: &str, name: &str| readers(family).of(name);
        let time = of("heidenhain-fs", "SMP525");
        let reads = |list: &[(String, String)], word: &str| list.iter().any(|(a, _)| a == word);
        assert!(reads(&time.warnings, "ss1-longer-than-ss2"), "{time:?}");
        assert!(reads(&time.systems, "axes (group.toml)"), "{time:?}");
        assert!(!time.functions.is_empty() && !time.rules.is_empty());
        let window = of("sinumerik-840d", "STANDSTILL_TOL");
        assert!(
            reads(&window.warnings, "standstill-window-wide"),
            "{window:?}"
        );
        let decides = |uses: &Uses, name: &str| uses.patterns.iter().any(|p| p == name);
        assert!(decides(&window, "door_speed"), "{window:?}");
        let slip = of("sinumerik-840d", "SLIP_VELO_TOL");
        assert!(decides(&slip, "door_speed"), "{slip:?}");
        let alarm = of("sinumerik-840d", "PARK_ALARM_SUPPRESS");
        assert!(alarm.systems.is_empty(), "{alarm:?}");
        assert_eq!(of("sinumerik-840d", "NO_SUCH"), Uses::default());
    }
}
