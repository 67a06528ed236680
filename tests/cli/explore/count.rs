//! A specification with what the others do not have: a value that leaves its range, several initial states, an input that
//! only a property reads, and texts that look like markup.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::chromium::{Page, available};
use super::served::Served;

const SPEC: &str = r#"
spec   = "count"
title  = "A count <b>that</b> leaves its range"

[machine.count]
text      = "counts"
order     = "priority"
otherwise = "stay"

[machine.count.input]
go = "BOOL"
by = "INT(1..100)"

[machine.count.state]
n     = { type = "INT(0..3)", init = 0 }
start = { type = "BOOL", init = "ANY" }

[[machine.count.rule]]
name = "up"
when = "go AND start"
then = "n := n + 1;"
note = "no end </script> is seen"

[system.count]
text = "one count"

[system.count.instance]
count = { machine = "count" }

[system.count.free]
ports = ["count.go", "count.by"]

[[system.count.property]]
id     = "SMALL"
text   = "the count stays small <img src=x onerror=alert(1)>"
always = "count.n < 2 OR count.by < 50"
"#;

/// The file, which goes away with the value.
struct File(PathBuf);

impl File {
    fn new(name: &str) -> Self {
        let file = format!("count-{name}-{}.toml", std::process::id());
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(file);
        std::fs::write(&path, SPEC).expect("written");
        Self(path)
    }

    fn serve(&self) -> Served {
        Served::start(&[self.0.to_str().expect("UTF-8")])
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn an_input_that_only_a_property_reads_decides_when_it_is_held() {
    let file = File::new("held");
    let served = file.serve();
    let small = |view: &Value| {
        let property = &view["properties"][0];
        (
            property["standing"].clone(),
            property["broken"].clone(),
            property["says"][0]["open"].clone(),
        )
    };
    let view = served.view(json!({ "path": "1.1*2" }));
    assert_eq!(
        small(&view),
        (json!("open"), Value::Null, json!(["count.by"]))
    );
    // 50 is the distance 49 from the least value; before the second cycle the count is 1.
    let view = served.view(json!({ "path": "1.1", "held": "1=49" }));
    let classes = view["next"]["classes"].as_array().expect("classes");
    let breaks: Vec<(&Value, &Value)> = classes
        .iter()
        .map(|c| (&c["choice"], &c["broken"]))
        .collect();
    assert_eq!(
        breaks,
        [
            (&json!("0!1=49"), &json!([])),
            (&json!("1!1=49"), &json!(["SMALL"]))
        ]
    );
    let view = served.view(json!({ "path": "1.1.1!1=49" }));
    assert_eq!(small(&view), (json!("broken"), json!(2), Value::Null));
    let run = served.about(json!({ "property": "SMALL" }));
    let run = served.json(&served.post("/api/run", &run));
    assert_eq!(run["path"], "1.1.1!1=49");
}

#[test]
fn a_walk_ends_with_a_fault_and_begins_with_a_choice() {
    let file = File::new("fault");
    let served = file.serve();
    let initials = served.view(json!({ "path": "0" }))["initials"].clone();
    assert_eq!(
        initials["states"],
        json!([
            { "choice": "0", "values": [["count.start", "FALSE"]] },
            { "choice": "1", "values": [["count.start", "TRUE"]] },
        ])
    );
    let view = served.view(json!({ "path": "1.1*3" }));
    assert_eq!(
        view["next"]["classes"][1]["fault"],
        "count.up: n leaves its range"
    );
    let view = served.view(json!({ "path": "1.1*4" }));
    assert_eq!(view["fault"], "count.up: n leaves its range");
    assert_eq!(view["next"], Value::Null);
    assert_eq!(view["machines"][0]["states"][0]["value"], Value::Null);
    let beyond = served.post("/api/view", &served.about(json!({ "path": "1.1*5" })));
    assert_eq!(beyond.status, 400);
    assert!(
        beyond.body.contains("no cycle after the fault"),
        "{}",
        beyond.body
    );
}

#[test]
fn texts_of_the_file_are_shown_as_texts() {
    if !available() {
        return;
    }
    let file = File::new("texts");
    let served = file.serve();
    let mut page = Page::open("texts", 1280, 900);
    page.visit(&served.url);
    page.wait("document.body.dataset.ready === '0@0'");
    page.value("(() => { const s = document.getElementById('initial'); s.value = '1'; s.dispatchEvent(new Event('change')); })()");
    page.wait("document.body.dataset.ready === '1@0'");
    for path in ["1.1@1", "1.1*2@2", "1.1*3@3", "1.1*4@4"] {
        page.press("2");
        page.wait(&format!("document.body.dataset.ready === '{path}'"));
    }
    let text = page.text("document.body.innerText");
    for expected in [
        "<img src=x onerror=alert(1)>",
        "count.up: n leaves its range",
        "There is no next cycle after a fault.",
    ] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    assert_eq!(
        page.value("document.images.length + document.querySelectorAll('b').length"),
        0
    );
    assert_eq!(page.value("document.scripts.length"), 1);
    assert_eq!(page.errors, Vec::<String>::new());
}
