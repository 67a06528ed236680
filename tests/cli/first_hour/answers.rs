//! What `check` answers about a machine whose values leave much of the tables unused.

use std::sync::LazyLock;

use serde_json::Value;

use super::{SMALLEST, away, elsewhere};
use crate::common::{copied, status, stderr, stdout, stillpoint};

/// The one witness that four equal speed limits exclude.
const WITNESS: &str = "S840D-P-36-WITNESS";

/// What `check` answers about the smallest machine, away from the sources.
struct Answers {
    json: Value,
    text: String,
    html: String,
    /// With all details.
    verbose: String,
}

/// The answers, asked for once.
static ANSWERS: LazyLock<Answers> = LazyLock::new(|| {
    let folder = elsewhere("answers");
    let file = folder.write("smallest.toml", SMALLEST);
    let said = |more: &[&str]| {
        let output = away(&folder, &[&["check", &file], more].concat());
        assert_eq!(status(&output), 0, "{more:?}: {}", stderr(&output));
        stdout(&output)
    };
    let page = folder.file("report.html");
    let text = said(&["--html", &page]);
    Answers {
        json: serde_json::from_str(&said(&["--json"])).expect("JSON"),
        html: std::fs::read_to_string(&page).expect("written"),
        verbose: said(&["-v"]),
        text,
    }
});

/// Every safe speed limit of the smallest machine has the family's default, so that no stage is lower than another: what only
/// different limits can show is excluded by the values, and nothing is violated.
#[test]
fn a_witness_that_the_values_exclude_is_no_violation() {
    let Answers {
        json, text, html, ..
    } = &*ANSWERS;
    let all = json["properties"].as_array().expect("properties");
    let unreachable: Vec<&Value> = all
        .iter()
        .filter(|p| p["verdict"] == "unreachable")
        .collect();
    assert_eq!(unreachable.len(), 1, "{unreachable:?}");
    assert_eq!(unreachable[0]["id"], WITNESS);
    assert_eq!(unreachable[0]["excluded"], true);
    let runs = json["runs"].as_array().expect("runs").iter();
    let mut judged = runs.flat_map(|r| r["properties"].as_array().expect("properties"));
    let one = judged.find(|p| p["id"] == WITNESS && !p["excluded"].is_null());
    let by = one.expect("the reason")["excluded"]["by"].clone();
    let names: Vec<&str> = by
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|d| d["parameter"].as_str())
        .collect();
    assert!(
        !names.is_empty() && names.iter().all(|n| n.starts_with("limit_")),
        "{by}"
    );
    assert!(by[0]["from"] == "VELO_LIMIT", "{by}");

    let head = text.lines().next().expect("a line");
    assert_eq!(
        head,
        "smallest: NO GUARANTEE IS ASKED, the properties of its family hold"
    );
    assert!(text.contains("1 excluded by your values"), "{text}");
    let row = text.lines().find(|l| l.contains(WITNESS)).expect("its row");
    assert!(row.trim_start().starts_with("excluded "), "{row}");
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("(excluded by your values: VELO_LIMIT (limit_"),
        "{words}"
    );

    assert!(html.contains(">excluded<") && html.contains("excluded by your values: VELO_LIMIT"));
    assert!(!html.contains(">unreachable<"));
}

/// The same machine on tables in which nothing can show the witness, with no values whatever: that is an error of the tables.
#[test]
fn a_witness_that_exists_with_no_values_is_missing() {
    let machine = "spec/machines/milling-840d.toml";
    let goal = "lost_sbh.dead AND NOT lost_sg.dead AND selection[2].mode = SBH_PEND";
    let never = "lost_sbh.dead AND NOT lost_sbh.dead AND selection[2].mode = SBH_PEND";
    let change = [("spec/families/sinumerik-840d/monitoring.toml", goal, never)];
    let copy = copied(
        "missing-witness",
        machine,
        "spec/families/sinumerik-840d",
        &change,
    );
    std::fs::write(&copy, SMALLEST).expect("written");
    let output = stillpoint(&["check", &copy, "--json"]);
    assert_eq!(status(&output), 1);
    let json: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let all = json["properties"].as_array().expect("properties").iter();
    let bad: Vec<&Value> = all.filter(|p| p["verdict"] == "unreachable").collect();
    assert_eq!(bad.len(), 1, "{bad:?}");
    assert_eq!(
        (&bad[0]["id"], &bad[0]["excluded"]),
        (&WITNESS.into(), &false.into())
    );
    let text = stdout(&stillpoint(&["check", &copy]));
    assert!(
        text.starts_with("milling-840d: VIOLATED: a witness that must exist does not\n"),
        "{text}"
    );
    assert!(text.contains(&format!("MISSING  {WITNESS}  ")), "{text}");
    // The family by itself, without a machine.
    let tables = copy.replace(
        "machines/milling-840d.toml",
        "families/sinumerik-840d/monitoring.toml",
    );
    assert_eq!(status(&stillpoint(&["check", &tables, "--json"])), 1);
}

/// Rules that a machine leaves unused are a note on the tables.
#[test]
fn unused_rules_are_told_on_demand_only() {
    let Answers {
        json,
        text,
        verbose,
        ..
    } = &*ANSWERS;
    assert!(
        !text.contains("FINDING") && !text.contains("rules not fired"),
        "{text}"
    );
    assert!(
        verbose.contains("rules not fired: fault.delay") && !verbose.contains("FINDING"),
        "{verbose}"
    );
    let runs = json["runs"].as_array().expect("runs").iter();
    let mut unfired = runs.flat_map(|r| r["unfired"].as_array().expect("a list"));
    assert!(unfired.any(|u| u["rule"] == "fault.delay" && u["reason"] == "unexplained"));
}

/// `validate` says in one line that the values are plausible; what follows is about values that nobody chose.
#[test]
fn validate_prints_a_line_and_the_rest_on_demand() {
    let folder = elsewhere("validate");
    let file = folder.write("smallest.toml", SMALLEST);
    let short = away(&folder, &["validate", &file]);
    assert_eq!(status(&short), 0, "{}", stderr(&short));
    let said = stdout(&short);
    let mut lines = said.lines();
    let first = lines.next().expect("a line");
    assert!(first.starts_with("smallest: plausible; axes X; "), "{said}");
    let second = lines.next().expect("a line");
    assert!(second.starts_with("These values: "), "{said}");
    let blocks = lines.filter(|l| l.starts_with("  ")).count();
    assert!(
        blocks > 5 && said.contains("[axis-behind-no-door]"),
        "{said}"
    );
    let long = stdout(&away(&folder, &["validate", &file, "-v"]));
    assert!(
        long.lines().count() > 20 && long.contains("  to explore: stops of one channel, axis X")
    );
}
