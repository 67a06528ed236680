//! The language chapter of the book as tests: what each construct means.

use std::collections::BTreeSet;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;

use crate::common::{X, bound, load, machine};

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

/// `a` reads an input of `b`, and that one reads what `c` does in this cycle: `c` steps first, whatever the order of the file.
#[test]
fn instances_step_in_data_flow_order_through_wires_of_inputs() {
    let text = "spec = \"t\"\n[machine.m]\ntext = \"m\"\n[machine.m.input]\nv = \"INT(0..9)\"\n[machine.m.state]\nx = { type = \"INT(0..9)\", init = 0 }\n[[machine.m.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"TRUE\"\nthen = \"x := v;\"\n[system.s]\ntext = \"s\"\n[system.s.instance]\na = { machine = \"m\" }\nb = { machine = \"m\" }\nc = { machine = \"m\" }\n[system.s.wire]\n\"a.v\" = \"b.v\"\n\"b.v\" = \"c.x\"\n[system.s.free]\nports = [\"c.v\"]\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"a.x = c.x\"\n";
    let b = bound(text);
    let (frame, _) = cycle(&b, &[0, 0, 0], &[("c.v", 7)]);
    assert_eq!(frame.now, [7, 7, 7]);
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
fn the_default_of_an_array_is_one_or_a_list() {
    let of = |default: &str| {
        let body = format!(
            "[machine.m.param]\np = {{ type = \"ARRAY[1..3] OF INT(0..9)\", default = {default} }}\n[machine.m.state]\nx = {{ type = \"INT(0..9)\", init = 0 }}\n"
        );
        bound(&machine("", &body, &[("TRUE", "x := p[2];")], "")).values
    };
    assert_eq!(of("4"), [4, 4, 4]);
    assert_eq!(of("[4, 0, 9]"), [4, 0, 9]);
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
