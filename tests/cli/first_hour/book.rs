//! What the book says to a new user, against what is so.

use stillpoint_harness::families::FAMILIES;

use crate::common::root;

fn read(path: &str) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The families of the workspace whose folder has this file, in the order of their names.
fn families_with(file: &str) -> Vec<String> {
    let entries = std::fs::read_dir(root().join("spec/families")).expect("the folder");
    let folders = entries.map(|e| e.expect("an entry").path());
    let with = folders.filter(|f| f.join("family.toml").is_file() && f.join(file).is_file());
    let mut names: Vec<String> = with
        .filter_map(|f| Some(f.file_name()?.to_str()?.to_owned()))
        .collect();
    names.sort();
    names
}

/// Limits and README say the same of what exists for which family, which is what the families' folders hold.
#[test]
fn limits_and_readme_agree_with_the_families() {
    let both = families_with("acceptance.toml");
    let chains = families_with("reaction-chain.toml");
    let (both_again, alone): (Vec<_>, Vec<_>) =
        chains.into_iter().partition(|family| both.contains(family));
    assert_eq!(both, both_again);
    let list: Vec<String> = both.iter().map(|f| format!("`{f}`")).collect();
    let alone: Vec<String> = alone.iter().map(|f| format!("`{f}`")).collect();
    let limits = read("docs/src/limits.md");
    let words = limits.split_whitespace().collect::<Vec<_>>().join(" ");
    let sentence = format!(
        "Reaction chains and acceptance protocols exist for {}",
        list.join(" and ")
    );
    assert!(words.contains(&sentence), "limits.md lacks: {sentence}");
    let sentence = format!("Reaction chains alone exist for {}", alone.join(" and "));
    assert_eq!(
        words.contains(&sentence),
        !alone.is_empty(),
        "limits.md: {sentence}"
    );
    let simulated: Vec<String> = FAMILIES
        .iter()
        .filter(|family| family.drive.is_some())
        .map(|family| format!("`{}`", family.name))
        .collect();
    let sentence = format!("simulation for {}", simulated.join(" and "));
    assert!(words.contains(&sentence), "limits.md lacks: {sentence}");
    let readme = read("README.md");
    let row = readme
        .lines()
        .find(|l| l.starts_with("| `heidenhain-fs` |"))
        .expect("its row");
    assert!(
        row.contains("reaction chains, acceptance protocols, simulation of the whole machine"),
        "{row}"
    );
}

/// The code that the page on embedding shows is the one that is compiled and run: a code host shows the page as it is written.
#[test]
fn the_embedding_page_shows_the_code_that_is_tested() {
    let source = read("impl/tests/embedding.rs");
    let code = source
        .split("// ANCHOR: controller\n")
        .nth(1)
        .expect("the mark");
    let code = code
        .split("// ANCHOR_END: controller")
        .next()
        .expect("its end");
    let page = read("docs/src/embedding.md");
    assert!(
        page.contains(&format!("```rust,ignore\n{code}```\n")),
        "docs/src/embedding.md shows other code"
    );
    assert!(
        !page.contains("{{#include"),
        "an include is invisible on a code host"
    );
}

/// Every parameter and function of each family stands on its page, which is linked.
#[test]
fn every_parameter_has_its_place_in_the_book() {
    let summary = read("docs/src/SUMMARY.md");
    for family in families_with("pages.toml") {
        let page = read(&format!("docs/src/functions/{family}/machine-file.md"));
        assert!(
            summary.contains(&format!("(functions/{family}/machine-file.md)")),
            "{family}"
        );
        let data = stillpoint_machine::data::load(&root().join("spec/families").join(&family));
        let data = data.unwrap_or_else(|e| panic!("{e}"));
        assert!(data.parameters.len() > 10, "{family}");
        for parameter in &data.parameters {
            assert!(
                page.contains(&format!("| `{}` |", parameter.name)),
                "{family}: {}",
                parameter.name
            );
        }
        for function in &data.functions {
            assert!(
                page.contains(&format!("`\"{}\"`", function.name)),
                "{family}: {}",
                function.name
            );
        }
    }
}
