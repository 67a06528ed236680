//! The language chapter of the book as tests: what each mistake is answered with.

use std::collections::BTreeMap;
use std::path::Path;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::Diagnostics;

use crate::common::{X, bound, load, machine};

/// What the first diagnostic of `marked` says, which must be at the place of the marker `@`; the marker is taken out of the text.
fn mistake(marked: &str) -> String {
    let at = marked
        .find('@')
        .unwrap_or_else(|| panic!("no mark in {marked}"));
    let text = format!("{}{}", &marked[..at], &marked[at + 1..]);
    assert!(!text.contains('@'), "two marks");
    let Err(Diagnostics(list)) = load(&text, &[]) else {
        panic!("accepted:\n{text}")
    };
    let first = &list[0];
    let line = text[..at].matches('\n').count() + 1;
    let column = text[..at].rsplit('\n').next().map_or(0, str::len) + 1;
    assert_eq!(
        first.position(),
        Some((line, column)),
        "wanted at the mark: {first}\n{marked}"
    );
    let marked = marked.lines().nth(line - 1).unwrap_or_default();
    format!("{marked}\n{first}\n  help: {}\n", first.help)
}

/// What is said about each mistake of a list, for a snapshot.
fn mistakes(list: impl IntoIterator<Item = String>) -> String {
    let said: Vec<String> = list.into_iter().map(|text| mistake(&text)).collect();
    said.join("\n")
}

#[test]
fn wrong_expressions() {
    let rule = |when: &str, then: &str| {
        let head = "[enum.Level]\nvalues = [\"LOW\", \"HIGH\"]\n[enum.Other]\nvalues = [\"LOW\", \"TOP\"]\n";
        let body = format!(
            "{X}l = {{ type = \"Level\", init = \"HIGH\" }}\na = {{ type = \"ARRAY[0..3] OF BOOL\", init = false }}\n[machine.m.input]\nin = \"INT(0..9)\"\n"
        );
        machine(head, &body, &[(when, then)], "\"m.in\"")
    };
    let list = [
        ("@y = 1", "x := 1;"),
        ("x = 1 AND @inn = 2", "x := 1;"),
        ("@x", "x := 1;"),
        ("@x = HIGH", "x := 1;"),
        ("l = @Level#MID", "x := 1;"),
        ("l = @Levle#LOW", "x := 1;"),
        ("ORD(@LOW) = 1", "x := 1;"),
        ("x / @in = 1", "x := 1;"),
        ("x MOD (@in - 3) = 1", "x := 1;"),
        ("a[@in]", "x := 1;"),
        ("a[@4]", "x := 1;"),
        ("@a", "x := 1;"),
        ("@PREV(x) = 1", "x := 1;"),
        ("@higher(x) = 1", "x := 1;"),
        ("@SEL(x = 1) = 1", "x := 1;"),
        ("x = 1 @x = 2", "x := 1;"),
        ("(x = 1@", "x := 1;"),
        ("x = 1 @? 2", "x := 1;"),
        ("x = @T#5parsec", "x := 1;"),
        ("x = @99999999999999999999", "x := 1;"),
        ("x = 1", "@y := 1;"),
        ("x = 1", "@in := 1;"),
        ("x = 1", "x := @10;"),
        ("x = 1", "x := @TRUE;"),
        ("x = 1", "x @= 1;"),
        ("x = 1", "IF x = 1 THEN x := 2;@"),
        ("x = 1", "@a := TRUE;"),
    ];
    insta::assert_snapshot!(mistakes(list.map(|(when, then)| rule(when, then))));
}

#[test]
fn wrong_declarations() {
    let state = |line: &str| machine("", &format!("{X}{line}\n"), &[("x = 0", "x := 1;")], "");
    let list = [
        "y = { type = \"@Stop\", init = 0 }",
        "y = { type = \"@INT\", init = 0 }",
        "y = { type = \"@INT(3..1)\", init = 3 }",
        "y = { type = \"@INT(0..3000000000)\", init = 3 }",
        "y = { type = \"INT(0..3)\", init = @7 }",
        "@y = { type = \"INT(0..3)\" }",
        "y = { type = \"INT(0..3)\", init = \"@x\" }",
        "y = { type = \"INT(0..3)\", @inti = 0 }",
        "AND = { type = @\"BOOL\", init = false }",
        "y = { type = \"BOOL\", init = false }\n[machine.m.let]\n@y = \"TRUE\"",
        "[machine.m.param]\n@p = \"BOOL\"",
        "[machine.m.param]\np = { type = \"INT(1..3)\", default = @9 }",
        "[machine.m.param]\np = { type = \"ARRAY[1..3] OF INT(1..3)\", default = @[1, 2] }",
        "[machine.m.param]\np = { type = \"ARRAY[1..2] OF INT(1..3)\", default = @[1, 4] }",
        "[machine.m.param]\np = { type = \"INT(1..3)\", default = @[1, 2] }",
    ];
    insta::assert_snapshot!("wrong_states", mistakes(list.map(state)));
    let head = |head: &str, when: &str| machine(head, X, &[(when, "x := 1;")], "");
    insta::assert_snapshot!(
        "wrong_heads",
        mistakes([
            head(
                "[function.f]\nargs = [\"v : INT\"]\nvalue = \"g(v)\"\n[function.g]\nargs = [\"v : INT\"]\nvalue = \"@f(v)\"\n",
                "f(x) = 1",
            ),
            head("use = [@\"nowhere.toml\"]", "x = 1"),
            head(
                "[reading.A-1]\ntext = \"?\"\noptions = [\"ONE\", @\"ONE\"]\n",
                "ONE",
            ),
            head("[@machien.x]\ntext = \"x\"", "x = 1"),
            head("[machine.m]\ntext = \"m\"", "x = 1").replacen(
                "\n[machine.m]\ntext = \"m\"\norder",
                "\n[machine.@m]\ntext = \"m\"\norder",
                1,
            ),
        ])
    );
}

#[test]
fn wrong_systems() {
    let system = |tail: &str| {
        format!(
            "spec = \"t\"\n[machine.m]\ntext = \"m\"\n[machine.m.param]\np = {{ type = \"INT(0..3)\", default = 1 }}\n[machine.m.input]\na = \"INT(0..3)\"\n[machine.m.state]\nx = {{ type = \"INT(0..3)\", init = 0 }}\n[[machine.m.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"TRUE\"\nthen = \"x := MIN(a, p);\"\n{tail}"
        )
    };
    let head = "[system.s]\ntext = \"s\"\n[system.s.instance]\nm = { machine = \"m\" }\n";
    let two = "ONE\ntext = \"s\"\n[system.s.instance]\nm = { machine = \"m\", count = 2 }\n"
        .replace("ONE", "[system.s]");
    let pair = "ONE\ntext = \"s\"\n[system.s.instance]\nm = { machine = \"m\", count = 2 }\n"
        .replace("ONE", "[system.@s]");
    let list = [
        head.replace("[system.s]", "[system.@s]"),
        format!("{head}[system.s.wire]\n\"m.a\" = \"1\"\n[system.s.free]\nports = [@\"m.a\"]\n"),
        format!("{head}[system.s.wire]\n@\"m.b\" = \"1\"\n[system.s.free]\nports = [\"m.a\"]\n"),
        format!("{head}[system.s.wire]\n\"m.a\" = \"@4\"\n"),
        format!("{head}[system.s.wire]\n\"m.a\" = \"@n.x\"\n"),
        format!("{pair}[system.s.wire]\n\"m[i].a\" = \"m[3 - i].x\"\n"),
        format!("{pair}[system.s.wire]\n\"m[i].a\" = \"m[3 - i].a\"\n"),
        format!("{two}[system.s.wire]\n\"m[i].a\" = \"PREV(m[@i + 1].x)\"\n"),
        head.replace("\"m\" }", "@\"n\" }"),
        head.replace("\"m\" }", "\"m\", count = @0 }"),
        head.replace("\"m\" }", "\"m\", param = { @q = 1 } }"),
        head.replace("text = \"s\"\n", "text = \"s\"\ncycle = @\"12 mm\"\n"),
        format!(
            "{head}[system.s.free]\nports = [\"m.a\"]\n[system.s.unreached]\n@\"m.q\" = \"never\"\n"
        ),
        format!(
            "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = @\"P\"\ntext = \"p\"\nwhen = \"m.x = 1\"\n"
        ),
        format!(
            "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\ntopic = @\"speed\"\nalways = \"m.x = 1\"\n"
        ),
        format!(
            "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\ntopic = @\"reaction\"\nalways = \"m.x = 1\"\n"
        ),
        format!(
            "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = @\"P\"\ntext = \"p\"\nwhen = \"m.x = 1\"\nleads_to = \"m.x = 0\"\nexactly = 3\n"
        ),
        format!(
            "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nwhen = \"m.x = 1\"\nleads_to = \"m.x = 0\"\nwithin = 3\nfastest = \"@0 - 1\"\n"
        ),
        format!(
            "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"@m.y = 1\"\n"
        ),
        format!(
            "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"PREV(@m.a) = 1\"\n"
        ),
    ];
    insta::assert_snapshot!(mistakes(list.map(|tail| system(&tail))));
}

#[test]
fn cases_that_overlap_or_are_missing() {
    let text = |order: &str, rules: &[(&str, &str)]| {
        machine("", X, rules, "").replace("order = \"priority\"\notherwise = \"stay\"\n", order)
    };
    let gap = text("", &[("x < 4", "x := 1;"), ("x > 4", "x := 2;")])
        .replace("[machine.m]", "[machine.@m]");
    let both = [("x < 5", "x := 1;"), ("x > 3", "x := 2;")];
    let overlap = text("", &both).replace("name = \"r1\"", "name = @\"r1\"");
    insta::assert_snapshot!(mistakes([
        gap,
        overlap,
        text("order = @\"sorted\"\n", &both),
        text("otherwise = @\"go\"\n", &[("x < 5", "x := 1;")]),
    ]));
    // Allowed: the same effect, or an order given on purpose.
    bound(&text("", &[("x < 5", "x := 1;"), ("x > 3", "x := 1;")]));
    bound(&text("order = \"priority\"\n", &both));
    // A dead rule is told, with its number.
    let dead = machine("", X, &[("x >= 0", "x := 1;"), ("x = 3", "x := 2;")], "");
    let spec = Spec::from_text(Path::new("t.toml"), dead.into()).unwrap_or_else(|e| panic!("{e}"));
    let b = Bound::new(
        spec.system("s", None).unwrap_or_else(|e| panic!("{e}")),
        &BTreeMap::new(),
        &BTreeMap::new(),
    );
    assert_eq!(
        spec.analyse(
            &b.expect("bound"),
            &stillpoint_lang::analysis::Known::default()
        )
        .unwrap_or_else(|e| panic!("{e}"))
        .dead,
        [1]
    );
}

#[test]
fn a_requirement_stands_once_in_a_list() {
    let text = |ids: &str, req: &str| {
        format!(
            "spec = \"s\"\n[machine.m]\ntext = \"m\"\n[machine.m.state]\nx = {{ type = \"BOOL\", init = false }}\n\
             [[machine.m.rule]]\nname = \"r\"\nid = {ids}\nwhen = \"TRUE\"\nthen = \"x := TRUE;\"\n\
             [system.s]\ntext = \"s\"\n[system.s.instance]\nm = {{ machine = \"m\" }}\n\
             [[system.s.property]]\nid = \"P\"\ntext = \"p\"\nreq = {req}\nalways = \"m.x\"\n"
        )
    };
    let (one, twice) = ("[\"F-A-001\"]", "@[\"F-A-001\", \"F-A-002\", \"F-A-001\"]");
    for text in [text(twice, one), text(one, twice)] {
        let said = mistake(&text);
        assert!(said.contains("F-A-001 stands twice in this list"), "{said}");
    }
    assert!(load(&text(one, one), &[]).is_ok());
}
