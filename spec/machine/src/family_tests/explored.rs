//! What `[[explore]]` may not say.

use std::sync::Arc;

use serde::Deserialize;

use crate::explore_file::ExploreData;
use crate::ground::DataFile;

#[derive(Deserialize)]
struct File {
    explore: Vec<ExploreData>,
}

/// What is wrong with an entry that has these lines, and the text in question.
fn mistakes(lines: &str) -> Vec<(String, String)> {
    let entry = "[[explore]]\nfile = \"axis.toml\"\nsystem = \"stop\"\ntext = \"\"\nwhen = \"enabled_SBH_SG\"\n";
    let file = DataFile {
        file: "family.toml".to_owned(),
        source: Arc::from(format!("{entry}{lines}\n")),
    };
    let data: File = file.parse().unwrap_or_else(|e| panic!("{e}"));
    let mut check = file.check();
    check.explores(data.explore, &super::family("sinumerik-840d").known);
    let found = check.findings.into_diagnostics().0;
    let found = found.into_iter().map(|one| {
        assert!(!one.help.is_empty(), "{one:?}");
        let place = one.span.map(|span| one.source[span].to_owned());
        (one.message, place.unwrap_or_default())
    });
    found.collect()
}

#[test]
fn a_group_has_members() {
    let of = |lines: &str| mistakes(&format!("each = \"group\"\n{lines}"));
    let wrong = |message: &str, place: &str| vec![(message.to_owned(), place.to_owned())];
    assert_eq!(of("members = 3"), []);
    assert_eq!(of("members = [2, 12]\nparam = { n = \"members\" }"), []);
    let when = "\"enabled_SBH_SG\"";
    assert_eq!(of(""), wrong("how many axes has the system?", when));
    for members in ["0", "1", "[1, 3]", "[4, 3]"] {
        let found = of(&format!("members = {members}"));
        assert_eq!(found, wrong("a group of how many axes?", when), "{members}");
    }
    let axis = mistakes("each = \"axis\"\nmembers = 3");
    assert_eq!(axis, wrong("a group of how many axes?", when));
}

#[test]
fn only_members_have_cells_of_their_own() {
    let time = "time = { \"t[]\" = \"PULSE_DISABLE_DELAY\" }";
    let param = "param = { \"p[]\" = \"IPO_STOP_GROUP\" }";
    for (lines, name, formula) in [
        (time, "t[]", "\"PULSE_DISABLE_DELAY\""),
        (param, "p[]", "\"IPO_STOP_GROUP\""),
    ] {
        assert_eq!(
            mistakes(&format!("each = \"group\"\nmembers = 3\n{lines}")),
            []
        );
        let told = format!("'{name}' has a cell for each member, and there are none");
        let found = mistakes(&format!("each = \"axis\"\n{lines}"));
        assert_eq!(found, [(told, formula.to_owned())]);
    }
    let found = mistakes("each = \"axis\"\nparam = { n = \"members\" }");
    assert_eq!(found.len(), 1, "{found:?}");
}
