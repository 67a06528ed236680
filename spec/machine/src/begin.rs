//! A machine file to begin with: the parts that a family has for it, filled in with the axes and doors of a machine.

use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::ground::DataFile;
use super::template::filled;
use stillpoint_lang::diag::Result;

/// The file of the parts in the folder of a family.
const FILE: &str = "new.toml";

/// What the machine consists of, by name.
#[derive(Debug, Clone, Default)]
pub struct Wanted {
    /// The machine.
    pub name: String,
    /// Linear axes.
    pub linear: Vec<String>,
    /// Rotary axes.
    pub rotary: Vec<String>,
    /// Spindles.
    pub spindles: Vec<String>,
    /// Guard doors; all axes are behind each.
    pub doors: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    part: Vec<Part>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Part {
    each: Each,
    #[serde(default)]
    needs: Vec<Kind>,
    text: Spanned<String>,
}

/// For what a part is written.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Each {
    Machine,
    Linear,
    Rotary,
    Spindle,
    Door,
}

impl Each {
    /// Whether the part is one of the axes that are called so.
    fn are(&self, word: &str) -> bool {
        match self {
            Self::Rotary => word == "rotary axes",
            Self::Spindle => word == "spindles",
            Self::Machine | Self::Linear | Self::Door => false,
        }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Linear,
    Rotary,
    Axes,
    Spindle,
}

/// Whether the family in `folder` has parts for a new machine file.
pub fn has(folder: &Path) -> bool {
    stillpoint_lang::files::is_file(&folder.join(FILE))
}

/// The text of a machine file with the axes and doors that are wanted.
///
/// # Errors
/// The parts of the family are wrong.
pub fn written(folder: &Path, wanted: &Wanted) -> Result<String> {
    let file = DataFile::read(folder, FILE, "parts of a machine file")?;
    let parts: File = file.parse()?;
    let mut check = file.check();
    let mut out = String::new();
    for (word, names, option) in [
        ("rotary axes", &wanted.rotary, "--rotary"),
        ("spindles", &wanted.spindles, "--spindles"),
    ] {
        let written = parts.part.iter().any(|part| part.each.are(word));
        if !written && !names.is_empty() {
            let message = format!("a machine of this family has no {word}");
            let help = format!("leave {option} out");
            check.findings.add(None, message, "", help);
        }
    }
    for part in parts.part {
        if !part.needs.iter().all(|kind| wanted.has(kind)) {
            continue;
        }
        let subjects = match part.each {
            Each::Machine => std::slice::from_ref(&wanted.name),
            Each::Linear => &wanted.linear,
            Each::Rotary => &wanted.rotary,
            Each::Spindle => &wanted.spindles,
            Each::Door => &wanted.doors,
        };
        for subject in subjects {
            let place = |name: &str| wanted.place(name, subject, &out);
            match filled(part.text.get_ref(), place) {
                Ok(text) => out.push_str(&text),
                Err(place) => {
                    let message = format!("nothing is called '{place}' here");
                    check.findings.add(
                        part.text.span(),
                        message,
                        "",
                        "see the head of the file for what can be filled in",
                    );
                }
            }
        }
    }
    check.findings.finish(out)
}

impl Wanted {
    /// What keeps a name from standing in a machine file.
    ///
    /// # Errors
    /// The name, and what is wrong with it.
    pub fn check(&self) -> std::result::Result<(), String> {
        let axes: Vec<&String> = (self.linear.iter())
            .chain(&self.rotary)
            .chain(&self.spindles)
            .collect();
        let doors: Vec<&String> = self.doors.iter().collect();
        for (what, names) in [
            ("an axis", axes),
            ("a door", doors),
            ("the machine", vec![&self.name]),
        ] {
            for (n, name) in names.iter().enumerate() {
                let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
                if name.is_empty() || !name.chars().all(plain) {
                    return Err(format!(
                        "'{name}' cannot be the name of {what}: it may have letters, digits, _ and -"
                    ));
                }
                if names.iter().take(n).any(|known| known == name) {
                    return Err(format!(
                        "two are named '{name}': give {what} a name of its own"
                    ));
                }
            }
        }
        Ok(())
    }

    fn has(&self, kind: &Kind) -> bool {
        match kind {
            Kind::Linear => !self.linear.is_empty(),
            Kind::Rotary => !self.rotary.is_empty(),
            Kind::Axes => !self.linear.is_empty() || !self.rotary.is_empty(),
            Kind::Spindle => !self.spindles.is_empty(),
        }
    }

    fn place(&self, place: &str, subject: &str, before: &str) -> Option<String> {
        let all = || self.linear.iter().chain(&self.rotary).chain(&self.spindles);
        let quoted = |names: &mut dyn Iterator<Item = &String>| {
            let names: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
            names.join(", ")
        };
        Some(match place {
            "name" => self.name.clone(),
            "axis" | "door" => subject.to_owned(),
            // From 1: what each axis has of its own.
            "number" => {
                let before = all().take_while(|name| *name != subject);
                (before.count() + 1).to_string()
            }
            "plain" => all().cloned().collect::<Vec<_>>().join(", "),
            "others" => {
                let axes = self.linear.iter().chain(&self.rotary);
                quoted(&mut axes.filter(|name| *name != subject))
            }
            "linear" => quoted(&mut self.linear.iter()),
            "rotary" => quoted(&mut self.rotary.iter()),
            "axes" => quoted(&mut self.linear.iter().chain(&self.rotary)),
            "spindle" => quoted(&mut self.spindles.iter()),
            "all" => quoted(&mut all()),
            "groups" => quoted(&mut groups(before).iter()),
            _ => return None,
        })
    }
}

/// The groups that the text declares so far.
fn groups(text: &str) -> Vec<String> {
    let heads = text.lines().filter_map(|line| line.strip_prefix("[group."));
    heads
        .filter_map(|head| Some(head.strip_suffix(']')?.to_owned()))
        .collect()
}
