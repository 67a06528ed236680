//! The language chapter of the book as tests: what each mistake is answered with.

use std::collections::BTreeMap;
use std::path::Path;

use stillpoint_spec::Spec;
use stillpoint_spec::bind::Bound;
use stillpoint_spec::diag::Diagnostics;

mod common;
use common::{X, bound, load, machine};

/// `message` must be the first diagnostic of `text`, at the place of the marker `@`, which is taken out of the text.
/// Otherwise tells what came instead.
fn mistake(marked: &str, message: &str, help: &str) -> Option<String> {
    let at = marked
        .find('@')
        .unwrap_or_else(|| panic!("no mark in {marked}"));
    let text = format!("{}{}", &marked[..at], &marked[at + 1..]);
    assert!(!text.contains('@'), "two marks");
    let Err(Diagnostics(list)) = load(&text, &[]) else {
        panic!("accepted, not `{message}`:\n{text}")
    };
    let first = &list[0];
    let line = text[..at].matches('\n').count() + 1;
    let column = text[..at].rsplit('\n').next().map_or(0, str::len) + 1;
    let right = first.message.contains(message)
        && first.help.contains(help)
        && first.position() == Some((line, column))
        && first
            .to_string()
            .starts_with(&format!("t.toml:{line}:{column}: "));
    let help = if help.is_empty() { "any help" } else { help };
    (!right).then(|| {
        format!(
            "wanted {line}:{column}: {message}\n  help: {help}\ngot {first}\n  help: {}\n",
            first.help
        )
    })
}

/// All mistakes of a list are answered as they should be.
fn mistakes(list: impl IntoIterator<Item = (String, &'static str, &'static str)>) {
    let wrong: Vec<String> = list
        .into_iter()
        .filter_map(|(text, message, help)| mistake(&text, message, help))
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
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
        ("@y = 1", "x := 1;", "`y` is not known here", ""),
        (
            "x = 1 AND @inn = 2",
            "x := 1;",
            "`inn` is not known here",
            "did you mean `in`?",
        ),
        (
            "@x",
            "x := 1;",
            "a value of type BOOL is needed, this is INT",
            "compare it",
        ),
        (
            "@x = HIGH",
            "x := 1;",
            "INT and Level cannot be compared",
            "ORD",
        ),
        (
            "l = @Level#MID",
            "x := 1;",
            "enum `Level` has no value `MID`",
            "its values are LOW, HIGH",
        ),
        (
            "l = @Levle#LOW",
            "x := 1;",
            "there is no enum `Levle`",
            "did you mean `Level`?",
        ),
        (
            "ORD(@LOW) = 1",
            "x := 1;",
            "`LOW` is a value of more than one enum",
            "`Level#LOW`",
        ),
        (
            "x / @in = 1",
            "x := 1;",
            "the divisor can be 0 (its range is 0..9)",
            "MAX(x, 1)",
        ),
        (
            "x MOD (@in - 3) = 1",
            "x := 1;",
            "the divisor can be 0 (its range is -3..6)",
            "",
        ),
        (
            "a[@in]",
            "x := 1;",
            "index can be 0..9, the array has 0..3",
            "LIMIT",
        ),
        (
            "a[@4]",
            "x := 1;",
            "index can be 4..4, the array has 0..3",
            "LIMIT",
        ),
        (
            "@a",
            "x := 1;",
            "this is an array, not one value",
            "name[index]",
        ),
        (
            "@PREV(x) = 1",
            "x := 1;",
            "PREV has no meaning here",
            "start of the cycle",
        ),
        (
            "@higher(x) = 1",
            "x := 1;",
            "there is no function `higher`",
            "",
        ),
        (
            "@SEL(x = 1) = 1",
            "x := 1;",
            "SEL has 1 arguments",
            "value if FALSE",
        ),
        (
            "x = 1 @x = 2",
            "x := 1;",
            "`x` is not expected here",
            "operator",
        ),
        (
            "(x = 1@",
            "x := 1;",
            "expected `)`, found the end of the text",
            "write `)`",
        ),
        (
            "x = 1 @? 2",
            "x := 1;",
            "character `?` has no meaning here",
            "Structured Text",
        ),
        (
            "x = @T#5parsec",
            "x := 1;",
            "has an unknown unit",
            "T#100ms",
        ),
        (
            "x = @99999999999999999999",
            "x := 1;",
            "is too large",
            "below",
        ),
        ("x = 1", "@y := 1;", "`y` is not known here", ""),
        (
            "x = 1",
            "@in := 1;",
            "`in` is not a state variable",
            "under `state`",
        ),
        (
            "x = 1",
            "x := @10;",
            "the value is 10..10, `x` holds 0..9",
            "widen",
        ),
        (
            "x = 1",
            "x := @TRUE;",
            "a value of type INT is needed, this is BOOL",
            "SEL",
        ),
        ("x = 1", "x @= 1;", "expected `:=`", ""),
        ("x = 1", "IF x = 1 THEN x := 2;@", "expected", ""),
        ("x = 1", "@a := TRUE;", "`a` is an array", "elements"),
    ];
    mistakes(list.map(|(when, then, message, help)| (rule(when, then), message, help)));
}

#[test]
fn wrong_declarations() {
    let state = |line: &str| machine("", &format!("{X}{line}\n"), &[("x = 0", "x := 1;")], "");
    let list = [
        (
            "y = { type = \"@Stop\", init = 0 }",
            "there is no type `Stop`",
            "",
        ),
        (
            "y = { type = \"@INT\", init = 0 }",
            "a variable needs a range",
            "INT(0..7)",
        ),
        (
            "y = { type = \"@INT(3..1)\", init = 3 }",
            "range 3..1 is empty",
            "lower bound",
        ),
        (
            "y = { type = \"@INT(0..3000000000)\", init = 3 }",
            "does not fit 32 bits",
            "",
        ),
        (
            "y = { type = \"INT(0..3)\", init = @7 }",
            "initial value 7 is outside 0..3",
            "a value of the type",
        ),
        (
            "@y = { type = \"INT(0..3)\" }",
            "state `y` has no initial value",
            "ANY",
        ),
        (
            "y = { type = \"INT(0..3)\", init = \"@x\" }",
            "state is not constant",
            "numbers and parameters",
        ),
        (
            "y = { type = \"INT(0..3)\", @inti = 0 }",
            "unknown field `inti`",
            "check the spelling",
        ),
        (
            "AND = { type = @\"BOOL\", init = false }",
            "`AND` cannot be a name",
            "keywords",
        ),
        (
            "y = { type = \"BOOL\", init = false }\n[machine.m.let]\n@y = \"TRUE\"",
            "`y` is declared twice",
            "one name space",
        ),
        (
            "[machine.m.param]\n@p = \"BOOL\"",
            "parameter `p` has no default",
            "default",
        ),
        (
            "[machine.m.param]\np = { type = \"INT(1..3)\", default = @9 }",
            "default 9 is outside 1..3",
            "",
        ),
    ];
    mistakes(list.map(|(line, message, help)| (state(line), message, help)));
    let head = |head: &str, when: &str| machine(head, X, &[(when, "x := 1;")], "");
    mistakes([
        (
            head(
                "[function.f]\nargs = [\"v : INT\"]\nvalue = \"g(v)\"\n[function.g]\nargs = [\"v : INT\"]\nvalue = \"@f(v)\"\n",
                "f(x) = 1",
            ),
            "function `f` calls itself",
            "not recursive",
        ),
        (
            head("use = [@\"nowhere.toml\"]", "x = 1"),
            "no such file",
            "relative to this one",
        ),
        (
            head(
                "[reading.A-1]\ntext = \"?\"\noptions = [\"ONE\", @\"ONE\"]\n",
                "ONE",
            ),
            "option `ONE` stands twice",
            "unique",
        ),
        (
            head("[@machien.x]\ntext = \"x\"", "x = 1"),
            "unknown field `machien`",
            "check the spelling",
        ),
        (
            head("[machine.m]\ntext = \"m\"", "x = 1").replacen(
                "\n[machine.m]\ntext = \"m\"\norder",
                "\n[machine.@m]\ntext = \"m\"\norder",
                1,
            ),
            "duplicate key",
            "",
        ),
    ]);
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
        (
            head.replace("[system.s]", "[system.@s]"),
            "port `m.a` is not wired",
            "free.ports",
        ),
        (
            format!(
                "{head}[system.s.wire]\n\"m.a\" = \"1\"\n[system.s.free]\nports = [@\"m.a\"]\n"
            ),
            "port `m.a` is bound twice",
            "not both",
        ),
        (
            format!(
                "{head}[system.s.wire]\n@\"m.b\" = \"1\"\n[system.s.free]\nports = [\"m.a\"]\n"
            ),
            "`m.b` is not an input port",
            "did you mean `m.a`?",
        ),
        (
            format!("{head}[system.s.wire]\n\"m.a\" = \"@4\"\n"),
            "the wire can be 4..4, port `m.a` takes 0..3",
            "LIMIT",
        ),
        (
            format!("{head}[system.s.wire]\n\"m.a\" = \"@n.x\"\n"),
            "`n` is not known here",
            "",
        ),
        (
            format!("{pair}[system.s.wire]\n\"m[i].a\" = \"m[3 - i].x\"\n"),
            "combinational loop between m[1], m[2]",
            "PREV",
        ),
        (
            format!("{pair}[system.s.wire]\n\"m[i].a\" = \"m[3 - i].a\"\n"),
            "combinational loop between m[1], m[2]",
            "PREV",
        ),
        (
            format!("{two}[system.s.wire]\n\"m[i].a\" = \"PREV(m[@i + 1].x)\"\n"),
            "index 3 is outside 1..2",
            "2 instances",
        ),
        (
            head.replace("\"m\" }", "@\"n\" }"),
            "there is no machine `n`",
            "",
        ),
        (
            head.replace("\"m\" }", "\"m\", count = @0 }"),
            "count 0 is not possible",
            "1 to 64",
        ),
        (
            head.replace("\"m\" }", "\"m\", param = { @q = 1 } }"),
            "machine `m` has no parameter `q`",
            "",
        ),
        (
            head.replace("text = \"s\"\n", "text = \"s\"\ncycle = @\"12 mm\"\n"),
            "`12 mm` is not a cycle time",
            "12 ms",
        ),
        (
            format!(
                "{head}[system.s.free]\nports = [\"m.a\"]\n[system.s.unreached]\n@\"m.q\" = \"never\"\n"
            ),
            "there is no rule `m.q`",
            "instance.rule",
        ),
        (
            format!(
                "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = @\"P\"\ntext = \"p\"\nwhen = \"m.x = 1\"\n"
            ),
            "property `P` has no form with the keys when",
            "leads_to",
        ),
        (
            format!(
                "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\ntopic = @\"speed\"\nalways = \"m.x = 1\"\n"
            ),
            "`speed` is no topic",
            "fault or reaction",
        ),
        (
            format!(
                "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\ntopic = @\"reaction\"\nalways = \"m.x = 1\"\n"
            ),
            "a reaction time needs a bounded response",
            "within",
        ),
        (
            format!(
                "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = @\"P\"\ntext = \"p\"\nwhen = \"m.x = 1\"\nleads_to = \"m.x = 0\"\nexactly = 3\n"
            ),
            "belong to a response with `within`",
            "add `within`",
        ),
        (
            format!(
                "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nwhen = \"m.x = 1\"\nleads_to = \"m.x = 0\"\nwithin = 3\nfastest = \"@0 - 1\"\n"
            ),
            "the bound can be -1..-1 cycles",
            "0 or more",
        ),
        (
            format!(
                "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"@m.y = 1\"\n"
            ),
            "`m` has nothing named `y`",
            "",
        ),
        (
            format!(
                "{head}[system.s.free]\nports = [\"m.a\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"PREV(@m.a) = 1\"\n"
            ),
            "PREV is offered for state only",
            "state variable",
        ),
    ];
    mistakes(list.map(|(tail, message, help)| (system(&tail), message, help)));
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
    let message = "rules `r0` and `r1` both match x = 4, with different effects";
    mistakes([
        (gap, "machine `m` has no rule for x = 4", "otherwise"),
        (overlap, message, "order = \"priority\""),
        (
            text("order = @\"sorted\"\n", &both),
            "`order` cannot be `sorted`",
            "exclusive",
        ),
        (
            text("otherwise = @\"go\"\n", &[("x < 5", "x := 1;")]),
            "`otherwise` cannot be `go`",
            "stay",
        ),
    ]);
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
        spec.analyse(&b.expect("bound"))
            .unwrap_or_else(|e| panic!("{e}"))
            .dead,
        [1]
    );
}
