//! What is refused: each with its place, what is wrong, and what to write instead.

use stillpoint_lang::diag::position;

use super::rig::{load, whole};

/// Everything that is told of a program.
fn told(program: &str) -> String {
    let Err(errors) = load(program) else {
        panic!("accepted:\n{program}");
    };
    let mut said = String::new();
    for one in &errors.0 {
        assert_eq!(one.file, "plc.st", "{one}");
        assert!(!one.help.is_empty(), "{one}");
        let span = one.span.clone().expect("a place");
        assert!(position(&one.source, span.start).is_some(), "{one}");
        let text = one.source.get(span).expect("in the text");
        let text = text.lines().next().unwrap_or_default();
        said += &format!(
            "{one}\n  at: {text}\n  label: {}\n  help: {}\n",
            one.label, one.help
        );
    }
    said
}

#[test]
fn errors_name_place_and_fix() {
    let cases = [
        ("an output is missing", "PROGRAM x VAR_OUTPUT p : BOOL; stop : Stop; END_VAR END_PROGRAM".to_owned()),
        ("an output is unknown", whole("VAR_OUTPUT out : BOOL; END_VAR", "")),
        ("an input is unknown", whole("VAR_INPUT door : BOOL; modes : Mode; END_VAR", "")),
        ("an input has another type", "PROGRAM x VAR_INPUT n : BOOL; END_VAR VAR_OUTPUT p, q : BOOL; m : INT; stop : Stop; END_VAR END_PROGRAM".to_owned()),
        ("names that are not declared", whole("VAR counter : INT (0..3); END_VAR", "countr := 1;\np := start;\nq := SS3 = stop;")),
        (
            "an output is never assigned",
            "PROGRAM x VAR_OUTPUT p, q : BOOL; m : INT; stop : Stop; END_VAR q := p; p := TRUE; stop := SS1; END_PROGRAM".to_owned(),
        ),
        ("an output that is not declared, and one that is", "PROGRAM x VAR_OUTPUT p, q : BOOL; stop : Stop; END_VAR m := 1; END_PROGRAM".to_owned()),
        ("an input that is not declared", "PROGRAM x VAR_OUTPUT p, q : BOOL; m : INT; stop : Stop; END_VAR p := b; END_PROGRAM".to_owned()),
        ("wrong types", whole("", "p := n;\nm := a;\nstop := AUTO;\nq := a AND n;\nq := n = mode;\np := a < b;\nm := n + T#1s;\nstop := 1;")),
        ("WHILE", whole("", "WHILE a DO p := TRUE; END_WHILE;")),
        ("REPEAT", whole("", "m := 1;\nREPEAT m := 0; UNTIL a END_REPEAT;")),
        ("END_IF is missing", whole("", "IF a THEN\n  p := TRUE;\nELSE\n  IF b THEN p := FALSE; END_IF;\nq := a;")),
        ("END_VAR is missing", "PROGRAM x\nVAR\n  y : BOOL;\ny := TRUE;\nEND_PROGRAM".to_owned()),
        ("`;` is missing", whole("", "p := a\nq := b;")),
        ("= for :=", whole("", "p = a;")),
        ("an input is assigned", whole("VAR CONSTANT K : INT := 3; END_VAR VAR t : TON; END_VAR", "a := TRUE;\nK := 4;\nt.Q := TRUE;\nt(PT := T#1s);")),
        ("parameters of a block", whole("VAR t : TON; u : TON; END_VAR", "t(CLK := a, PT := T#1s);\nt(a, T#1s);\nt(IN := a, ET => p);\np := t.X;\np := t;\nu(IN := a);\np := t(IN := a);")),
        ("the time of a block", whole("VAR t : TON; END_VAR VAR x : TIME (T#0s..T#1s); END_VAR", "t(IN := a, PT := x);")),
        ("two times of a block", whole("VAR t : TON; END_VAR", "IF a THEN t(IN := b, PT := T#1s); ELSE t(IN := b, PT := T#2s); END_IF;")),
        ("no range", whole("VAR x : INT; y : TIME; z : INT (1..5); END_VAR", "x := 1;")),
        ("types that are not taken", whole("VAR x : REAL; END_VAR", "")),
        ("a type that does not exist", whole("VAR x : Boolean; t : TONN; END_VAR", "")),
        ("ARRAY", whole("VAR x : ARRAY [0..3] OF BOOL; END_VAR", "")),
        ("a value outside the range", whole("VAR x : INT (0..3); END_VAR", "x := 4;\nx := n + 4;")),
        ("a divisor of 0", whole("", "m := 7 / n;\nm := n MOD (n - 3);")),
        ("MUX", whole("", "m := MUX(n, 1, 2, 3);\nm := SEL(a, 1);\nm := SQRT(n);")),
        ("CASE", whole("", "CASE n OF 1: p := a; 1..2: p := b; 9: p := c; END_CASE;\nCASE a OF TRUE: p := b; END_CASE;")),
        ("FOR", whole("VAR i : INT (0..3); END_VAR", "FOR i := 0 TO n DO p := a; END_FOR;\nFOR i := 0 TO 3 BY 0 DO p := a; END_FOR;\nFOR i := 0 TO 3 DO i := 2; END_FOR;\nFOR i := 0 TO 4 DO p := a; END_FOR;\nEXIT;")),
        ("recursion", format!("FUNCTION f : BOOL VAR_INPUT x : BOOL; END_VAR f := f(x); END_FUNCTION\nFUNCTION_BLOCK B VAR b : B; END_VAR END_FUNCTION_BLOCK\n{}", whole("VAR y : B; END_VAR", "p := f(a);"))),
        ("sections that are not taken", whole("VAR_IN_OUT x : BOOL; END_VAR", "")),
        ("addresses", whole("VAR x AT %IX0.0 : BOOL; END_VAR", "")),
        ("RETAIN", whole("VAR RETAIN x : BOOL; END_VAR", "")),
        ("twice", whole("VAR x : BOOL; X : BOOL; END_VAR", "")),
        ("decimal numbers", whole("", "m := 1.5;")),
        ("no program", "FUNCTION f : BOOL END_FUNCTION".to_owned()),
        ("an open comment", "PROGRAM x (* ... END_PROGRAM".to_owned()),
    ];
    let said: Vec<String> = cases
        .iter()
        .map(|(title, program)| format!("--- {title}\n{}", told(program)))
        .collect();
    insta::assert_snapshot!(said.join("\n"));
}

/// Deep and long programs are refused, or read in a moment: nothing exhausts the stack or the memory.
#[test]
fn long_and_deep_programs_end() {
    let deep = "(".repeat(100_000);
    told(&whole("", &format!("p := {deep}")));
    told(&whole("", &format!("p := {}a;", "NOT ".repeat(100_000))));
    told(&whole("", &"IF a THEN ".repeat(10_000)));
    told(&whole("", &format!("p := a{};", " OR b".repeat(10_000))));
    let loops = "FOR i := 0 TO 7 DO ".repeat(8);
    let ends = "END_FOR; ".repeat(8);
    told(&whole(
        "VAR i : INT (0..7); END_VAR",
        &format!("{loops} p := a; {ends}"),
    ));
    let loops: String = (0..7).map(|k| format!("FOR i{k} := 0 TO 9 DO ")).collect();
    let names: Vec<String> = (0..7).map(|k| format!("i{k}")).collect();
    let variables = format!("VAR {} : INT (0..9); x : BOOL; END_VAR", names.join(", "));
    told(&whole(
        &variables,
        &format!("{loops} x := x XOR a; {} p := x;", "END_FOR; ".repeat(7)),
    ));
    // Nor do parts of an expression whose type is sought.
    let inner = format!("{}n{}", "MIN(1, MAX(".repeat(15), ", 2))".repeat(15));
    assert!(load(&whole("", &format!("m := LIMIT(0, {inner}, 7);"))).is_ok());
    told(&whole(
        "",
        &format!("p := {}bad{};", "(".repeat(30), " = a)".repeat(30)),
    ));
    told(&whole(
        "",
        &"IF a THEN p := b; RETURN; END_IF;\n".repeat(1_000),
    ));
    told(&whole(
        "",
        &format!(
            "IF a THEN p := b; {} END_IF;",
            "ELSIF b THEN p := c; ".repeat(1_000)
        ),
    ));
    let blocks: String = (0..60)
        .map(|k| {
            format!(
                "FUNCTION_BLOCK B{k} VAR x, y, z : B{}; END_VAR x(); END_FUNCTION_BLOCK\n",
                k + 1
            )
        })
        .collect();
    told(&format!(
        "{blocks} FUNCTION_BLOCK B60 END_FUNCTION_BLOCK {}",
        whole("VAR b : B0; END_VAR", "b();")
    ));
    let calls: String = (0..25).map(|k| format!("FUNCTION f{k} : BOOL VAR_INPUT x : BOOL; END_VAR f{k} := f{0}(x) XOR f{0}(NOT x); END_FUNCTION\n", k + 1)).collect();
    told(&format!(
        "{calls} FUNCTION f25 : BOOL VAR_INPUT x : BOOL; END_VAR f25 := x; END_FUNCTION {}",
        whole("", "p := f0(a);")
    ));
    told(&whole("", &"p := nothing;\n".repeat(30_000)));
    // Values that are merged again and again do not double.
    let many: String = (0..500)
        .map(|_| "IF a THEN p := q; ELSE q := p XOR b; END_IF;\n")
        .collect();
    assert!(load(&whole("", &many)).is_ok());
}
