//! The tables of the families: every file that has a system holds completely, as it stands, but the exceptions.

use std::collections::BTreeSet;
use std::path::Path;

use stillpoint_engine::check::{Settings, check, exit_status, summarise};
use stillpoint_engine::subject::{self, Readings};
use stillpoint_tests::peer::has_system;
use stillpoint_tests::{exceptions, files_under_construction, specification_files};

/// What is wrong with a file.
fn wrong(path: &Path) -> Option<String> {
    let mut subject = subject::load(path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let checked = match check(&mut subject, &Settings::default(), &mut |_| Box::new(())) {
        Ok(checked) => checked,
        Err((title, e)) => return Some(format!("{title}: {e}")),
    };
    let summaries = summarise(&subject, &checked);
    if summaries.is_empty() {
        return Some("it states no property".to_owned());
    }
    let status = exit_status(&summaries, &checked);
    (status != 0).then(|| format!("{summaries:?}"))
}

/// Those of a family under construction among them: its tables hold before a machine file can name them.
///
/// Also among them, in `fields.toml` of heidenhain-fs: exactly one master CC (HFS-ARCH-002); what a changed parameter needs
/// (HFS-PARAM-009). In `interconnection.toml` of srm-fblocks, what has to be wired: the position without a reference
/// (SRM-REF-012), position and velocity that are not valid (SRM-POS-002, SRM-POSV-012).
#[test]
fn every_table_holds() {
    let left_out = exceptions("tables");
    let mut met = BTreeSet::new();
    let mut failed = Vec::new();
    let files = specification_files()
        .into_iter()
        .chain(files_under_construction());
    for path in files.filter(|p| has_system(p)) {
        let mut parts = path.iter().rev().map(|part| part.to_string_lossy());
        let (file, family) = (parts.next(), parts.next());
        let name = format!(
            "{}/{}",
            family.unwrap_or_default(),
            file.unwrap_or_default()
        );
        if left_out.contains(&name) {
            met.insert(name);
            continue;
        }
        let start = std::time::Instant::now();
        failed.extend(wrong(&path).map(|why| format!("{name}: {why}")));
        println!("{name}: {:.1} s", start.elapsed().as_secs_f64());
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    assert_eq!(met, left_out);
}
