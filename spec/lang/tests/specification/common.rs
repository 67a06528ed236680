//! What the tests of the language share: loading a text, a machine with given rules.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::Diagnostics;

/// Loads, resolves, binds and analyses the system `s` of a text, as a check does.
pub fn load(text: &str, readings: &[(&str, &str)]) -> Result<Bound, Diagnostics> {
    let source: Arc<str> = text.into();
    let spec = Spec::from_text(Path::new("t.toml"), source)?;
    let system = spec.system("s", None)?;
    let readings = readings
        .iter()
        .map(|(a, b)| ((*a).to_owned(), (*b).to_owned()))
        .collect();
    let bound = Bound::new(system, &BTreeMap::new(), &readings).expect("the defaults fit");
    spec.analyse(&bound, &stillpoint_lang::analysis::Known::default())?;
    Ok(bound)
}

pub fn bound(text: &str) -> Bound {
    load(text, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// A machine `m` with one instance `m`: `body` declares, `rules` are (guard, effect) in priority order.
pub fn machine(head: &str, body: &str, rules: &[(&str, &str)], free: &str) -> String {
    let mut text = format!(
        "spec = \"t\"\n{head}\n[machine.m]\ntext = \"m\"\norder = \"priority\"\notherwise = \"stay\"\n{body}\n"
    );
    for (k, (when, then)) in rules.iter().enumerate() {
        text.push_str(&format!(
            "[[machine.m.rule]]\nname = \"r{k}\"\nnote = \"n\"\nwhen = \"{when}\"\nthen = \"{then}\"\n"
        ));
    }
    text.push_str("[system.s]\ntext = \"s\"\ncycle = \"12 ms\"\n[system.s.instance]\nm = { machine = \"m\" }\n");
    text.push_str(&format!("[system.s.free]\nports = [{free}]\n"));
    text
}

/// The state of the machines of these tests.
pub const X: &str = "[machine.m.state]\nx = { type = \"INT(0..9)\", init = 0 }\n";
