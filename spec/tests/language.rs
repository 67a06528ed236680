//! The language chapter of the book as tests: what each construct means, and what each mistake is answered with.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use stillpoint_spec::Spec;
use stillpoint_spec::bind::Bound;
use stillpoint_spec::diag::Diagnostics;
use stillpoint_spec::eval::Frame;

/// Loads, resolves, binds and analyses the system `s` of a text, as a check does.
fn load(text: &str, readings: &[(&str, &str)]) -> Result<Bound, Diagnostics> {
    let source: Arc<str> = text.into();
    let spec = Spec::from_text(Path::new("t.toml"), source)?;
    let system = spec.system("s", None)?;
    let readings = readings
        .iter()
        .map(|(a, b)| ((*a).to_owned(), (*b).to_owned()))
        .collect();
    let bound = Bound::new(system, &BTreeMap::new(), &readings).expect("the defaults fit");
    spec.analyse(&bound)?;
    Ok(bound)
}

fn bound(text: &str) -> Bound {
    load(text, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// A machine `m` with one instance `m`: `body` declares, `rules` are (guard, effect) in priority order.
fn machine(head: &str, body: &str, rules: &[(&str, &str)], free: &str) -> String {
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

/// One cycle: the frame, and the inputs that were read, by name.
fn cycle(bound: &Bound, before: &[i32], inputs: &[(&str, i32)]) -> (Frame, BTreeSet<String>) {
    let mut frame = Frame::new(bound);
    frame.start(before);
    let mut read = BTreeSet::new();
    bound
        .step(&mut frame, &mut |k| {
            let name = &bound.system.inputs[k].name;
            read.insert(name.clone());
            inputs
                .iter()
                .find(|(n, _)| n == name)
                .unwrap_or_else(|| panic!("{name} was read"))
                .1
        })
        .unwrap_or_else(|site| panic!("fault at {}", bound.system.sites[site as usize].name));
    (frame, read)
}

/// The value of an expression over the state `x : INT(-9..9)`, `e : Level` and the parameter `p : INT(1..3)`.
fn value(expression: &str, x: i32) -> i64 {
    let head = "[enum.Level]\nvalues = [\"LOW\", \"MID\", \"HIGH\"]\n[function.twice]\nargs = [\"v : INT\"]\nvalue = \"v + v\"\n";
    let body = format!(
        "[machine.m.param]\np = {{ type = \"INT(1..3)\", default = 2 }}\n[machine.m.state]\nx = {{ type = \"INT(-9..9)\", init = 0 }}\ne = {{ type = \"Level\", init = \"MID\" }}\n[machine.m.output]\nv = \"{expression}\"\n"
    );
    let b = bound(&machine(head, &body, &[("FALSE", "x := 0;")], ""));
    let (mut frame, _) = cycle(&b, &[x, 1], &[]);
    let k = b
        .system
        .lazies
        .iter()
        .position(|l| l.name == "m.v")
        .expect("the output");
    b.lazy(k, &mut frame, &mut |_| panic!("no input is read"))
}

#[test]
fn operators_bind_and_round_as_written() {
    for (expression, x, wanted) in [
        ("2 + 3 * 4 - 1", 0, 13),
        ("8 - 3 - 2", 0, 3),
        ("-x", -4, 4),
        // `/` truncates to zero, MOD has the dividend's sign.
        ("x / 2", -7, -3),
        ("x / 2", 7, 3),
        ("x / -2", 7, -3),
        ("x MOD 3", -7, -1),
        ("x MOD 3", 7, 1),
        ("x MOD -3", 7, 1),
        ("MIN(x, 2, -1)", 0, -1),
        ("MAX(x, 2, -1)", 0, 2),
        ("LIMIT(-2, x, 3)", 9, 3),
        ("LIMIT(-2, x, 3)", -9, -2),
        ("LIMIT(-2, x, 3)", 1, 1),
        ("ABS(x)", -9, 9),
        ("SEL(x > 0, 10, 20)", 1, 20),
        ("SEL(x > 0, 10, 20)", 0, 10),
        ("MUX(ORD(e), 5, 6, 7)", 0, 6),
        ("ORD(e)", 0, 1),
        ("ORD(MAX(e, HIGH))", 0, 2),
        ("twice(x) + p", 3, 8),
        ("SEL(e > LOW AND e < Level#HIGH, 0, 1)", 0, 1),
        ("SEL(x = 1 OR x = 2 AND FALSE, 0, 1)", 1, 1),
        ("SEL(NOT (x = 1) XOR TRUE, 0, 1)", 1, 1),
        // 12 ms cycles, rounded up.
        ("T#12ms", 0, 1),
        ("T#13ms", 0, 2),
        ("T#1s", 0, 84),
        ("T#0ms", 0, 0),
        ("x (* a comment *) + 1 // and another", 4, 5),
    ] {
        assert_eq!(value(expression, x), wanted, "{expression} at x = {x}");
    }
}

#[test]
fn the_first_rule_that_matches_wins() {
    let body = "[machine.m.input]\na = \"BOOL\"\n[machine.m.state]\nx = { type = \"INT(0..9)\", init = 0 }\n";
    let rules = [("a", "x := 1;"), ("TRUE", "x := 2;"), ("a", "x := 3;")];
    let b = bound(&machine("", body, &rules, "\"m.a\""));
    let (frame, _) = cycle(&b, &[0], &[("m.a", 1)]);
    assert_eq!((frame.now[0], frame.fired[0]), (1, 1));
    let (frame, _) = cycle(&b, &[0], &[("m.a", 0)]);
    assert_eq!((frame.now[0], frame.fired[0]), (2, 2));
}

#[test]
fn effects_run_in_order_and_lets_keep_the_start() {
    let body = "[machine.m.state]\nx = { type = \"INT(0..9)\", init = 0 }\ny = { type = \"INT(0..9)\", init = 0 }\nz = { type = \"INT(0..9)\", init = 0 }\n[machine.m.let]\nold = \"x\"\n[machine.m.output]\nnow = \"x\"\nbefore = \"PREV(x)\"\n";
    let then = "x := 4; y := x; z := old; IF x = 3 THEN z := 9; ELSIF x = 4 THEN y := y + 1; ELSE y := 0; END_IF;";
    let b = bound(&machine("", body, &[("x < 4", then)], ""));
    let (mut frame, _) = cycle(&b, &[3, 0, 0], &[]);
    assert_eq!(frame.now, [4, 5, 3]);
    let lazy = |name: &str| {
        b.system
            .lazies
            .iter()
            .position(|l| l.name == name)
            .expect("it")
    };
    assert_eq!(
        b.lazy(lazy("m.now"), &mut frame, &mut |_| 0),
        4,
        "outputs see the state after the step"
    );
    assert_eq!(b.lazy(lazy("m.before"), &mut frame, &mut |_| 0), 3);
    // No rule matches: everything stays.
    let (frame, _) = cycle(&b, &[4, 1, 2], &[]);
    assert_eq!((frame.now, frame.fired), (vec![4, 1, 2], vec![0]));
}

#[test]
fn only_inputs_that_decide_are_read() {
    let inputs = "[machine.m.input]\na = \"BOOL\"\nb = \"BOOL\"\nc = \"BOOL\"\n[machine.m.state]\nx = { type = \"BOOL\", init = false }\n";
    let names = |list: &[&str]| {
        list.iter()
            .map(|n| format!("m.{n}"))
            .collect::<BTreeSet<_>>()
    };
    for (guard, a, wanted) in [
        ("a AND b", 0, &["a"][..]),
        ("a AND b", 1, &["a", "b"]),
        ("a OR b", 1, &["a"]),
        ("a OR b", 0, &["a", "b"]),
        ("SEL(a, b, c)", 0, &["a", "b"]),
        ("SEL(a, b, c)", 1, &["a", "c"]),
        ("MUX(SEL(a, 0, 1), b, c)", 1, &["a", "c"]),
        ("a XOR b", 1, &["a", "b"]),
        ("x AND b", 0, &[]),
    ] {
        let text = machine(
            "",
            inputs,
            &[(guard, "x := TRUE;")],
            "\"m.a\", \"m.b\", \"m.c\"",
        );
        let (_, read) = cycle(&bound(&text), &[0], &[("m.a", a), ("m.b", 0), ("m.c", 0)]);
        assert_eq!(read, names(wanted), "{guard} with a = {a}");
    }
    // A guard that matches ends the search: what later guards would read is not read.
    let text = machine(
        "",
        inputs,
        &[("a", "x := TRUE;"), ("b", "x := c;")],
        "\"m.a\", \"m.b\", \"m.c\"",
    );
    let (_, read) = cycle(&bound(&text), &[0], &[("m.a", 1)]);
    assert_eq!(read, names(&["a"]));
}

#[test]
fn initial_values_and_arrays() {
    let body = "[machine.m.param]\nn = { type = \"INT(1..3)\", default = 3 }\n[machine.m.input]\nk = \"INT(0..2)\"\n[machine.m.state]\na = { type = \"ARRAY[0..2] OF INT(0..9)\", init = \"n + 1\" }\nany = { type = \"INT(2..5)\", init = \"ANY\" }\n";
    let b = bound(&machine(
        "",
        body,
        &[("TRUE", "a[k] := any; a[0] := a[k] + 1;")],
        "\"m.k\"",
    ));
    assert_eq!(b.initial, [Some(4), Some(4), Some(4), None]);
    assert_eq!(b.states, [(0, 9), (0, 9), (0, 9), (2, 5)]);
    let (frame, _) = cycle(&b, &[4, 4, 4, 5], &[("m.k", 2)]);
    assert_eq!(frame.now, [6, 4, 5, 5]);
}

#[test]
fn a_reading_is_a_constant_of_its_option() {
    let head = "[reading.A-1]\ntext = \"?\"\noptions = [\"FIRST\", \"SECOND\"]\n";
    let body = "[machine.m.state]\nx = { type = \"INT(0..9)\", init = 0 }\n";
    let text = machine(
        head,
        body,
        &[("FIRST", "x := 1;"), ("SECOND", "x := 2;")],
        "",
    );
    let (frame, _) = cycle(&bound(&text), &[0], &[]);
    assert_eq!(frame.now, [1], "the first option is the recommended one");
    let b = load(&text, &[("A-1", "SECOND")]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(cycle(&b, &[0], &[]).0.now, [2]);
    assert_eq!(b.readings(), [("A-1".to_owned(), "SECOND".to_owned())]);
}

/// Three instances of a counter that takes the value of the one before it in the cycle before.
fn chain(property: &str) -> String {
    format!(
        "spec = \"t\"\n[machine.c]\ntext = \"c\"\n[machine.c.input]\nv = \"INT(0..9)\"\n[machine.c.state]\nx = {{ type = \"INT(0..9)\", init = 0 }}\n[[machine.c.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"TRUE\"\nthen = \"x := v;\"\n[machine.c.output]\no = \"MIN(x + 1, 9)\"\n[system.s]\ntext = \"s\"\n[system.s.instance]\nc = {{ machine = \"c\", count = 3 }}\nd = {{ machine = \"c\" }}\n[system.s.wire]\n\"c[i].v\" = \"PREV(c[1 + i MOD 3].x)\"\n\"d.v\" = \"c[3].o\"\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"{property}\"\n"
    )
}

#[test]
fn wires_copies_and_quantifiers() {
    let b = bound(&chain("c[i].x < 9"));
    assert_eq!(b.system.properties.len(), 3, "one copy for each index");
    let names: Vec<&str> = b.system.instances.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["c[1]", "c[2]", "c[3]", "d"]);
    // PREV reads the start of the cycle, an output the end of the step: so d sees what c[3] took in this cycle.
    let (frame, _) = cycle(&b, &[1, 2, 3, 0], &[]);
    assert_eq!(frame.now, [2, 3, 1, 2]);
    for (property, wanted) in [
        ("FORALL(j IN c, c[j].x > 0)", true),
        ("FORALL(j IN c, c[j].x > 1)", false),
        ("EXISTS(j IN c, c[j].x = 3)", true),
        ("EXISTS(j IN c, c[j].x = 4)", false),
        ("MAXIMUM(j IN c, c[j].x) = 3", true),
        ("MAXIMUM(j IN c, PREV(c[j].x)) + j0 = 3", false),
    ] {
        let property = property.replace("j0", "1");
        let b = bound(&chain(&property));
        let (mut frame, _) = cycle(&b, &[1, 2, 3, 0], &[]);
        assert_eq!(b.atom(0, &mut frame, &mut |_| 0), wanted, "{property}");
    }
}

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

const X: &str = "[machine.m.state]\nx = { type = \"INT(0..9)\", init = 0 }\n";

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

#[test]
fn a_value_that_may_leave_its_range_is_checked_in_each_step() {
    let b = bound(&machine("", X, &[("TRUE", "x := x + 1;")], ""));
    assert_eq!(cycle(&b, &[8], &[]).0.now, [9]);
    let mut frame = Frame::new(&b);
    frame.start(&[9]);
    let site = b
        .step(&mut frame, &mut |_| 0)
        .expect_err("10 is outside 0..9");
    assert_eq!(b.system.sites[site as usize].name, "m.r0: x");
}
