//! What statements mean, by cases worked by hand.

use super::rig::{Plc, whole};

/// The cycles of a program: inputs, and what is expected of `p`, `q`, `m`, `stop`.
type Cycle<'a> = (&'a [(&'a str, i32)], [i64; 4]);

fn runs(variables: &str, statements: &str, cycles: &[Cycle]) {
    let program = whole(variables, statements);
    let mut plc = Plc::new(&program);
    for (k, (inputs, expected)) in cycles.iter().enumerate() {
        assert_eq!(plc.step(inputs), Some(*expected), "cycle {k} of\n{program}");
    }
}

#[test]
fn statements_run_in_their_order() {
    runs(
        "VAR x, y : INT (0..7); END_VAR",
        "x := n; y := x; x := 3; m := y; p := x = 3; q := y = x;",
        &[(&[("n", 5)], [1, 0, 5, 0]), (&[("n", 3)], [1, 1, 3, 0])],
    );
}

#[test]
fn what_is_read_before_it_is_assigned_is_of_the_cycle_before() {
    runs(
        "VAR x : INT (0..7) := 2; END_VAR",
        "m := x; x := n; q := p; p := a;",
        &[
            (&[("n", 5), ("a", 1)], [1, 0, 2, 0]),
            (&[("n", 6)], [0, 1, 5, 0]),
            (&[], [0, 0, 6, 0]),
        ],
    );
    // Also what only one branch assigns.
    runs(
        "VAR x : INT (0..7); END_VAR",
        "IF a THEN x := n; END_IF; m := x;",
        &[
            (&[("n", 5)], [0, 0, 0, 0]),
            (&[("n", 5), ("a", 1)], [0, 0, 5, 0]),
            (&[], [0, 0, 5, 0]),
        ],
    );
}

#[test]
fn if_takes_the_first_branch_that_holds() {
    let text = "IF a THEN m := 1; ELSIF b THEN m := 2; IF c THEN q := TRUE; END_IF; ELSE m := 3; p := TRUE; END_IF;
                IF NOT a THEN p := p OR c; END_IF;";
    runs(
        "",
        &format!("p := FALSE; q := FALSE; {text}"),
        &[
            (&[("a", 1), ("b", 1)], [0, 0, 1, 0]),
            (&[("b", 1)], [0, 0, 2, 0]),
            (&[("b", 1), ("c", 1)], [1, 1, 2, 0]),
            (&[], [1, 0, 3, 0]),
        ],
    );
}

#[test]
fn case_has_values_ranges_and_else() {
    runs(
        "",
        "CASE n OF 0: m := 7; 1, 3..4: m := 1; 6: m := 6; p := a; ELSE m := 0; END_CASE;
         CASE mode OF AUTO: stop := NONE; Mode#MANUAL, SETUP: stop := Stop#SS1; END_CASE;",
        &[
            (&[("n", 0)], [0, 0, 7, 0]),
            (&[("n", 3), ("mode", 1)], [0, 0, 1, 2]),
            (&[("n", 4), ("mode", 2)], [0, 0, 1, 2]),
            (&[("n", 2)], [0, 0, 0, 0]),
            (&[("n", 6), ("a", 1)], [1, 0, 6, 0]),
            (&[("n", 5)], [1, 0, 0, 0]),
        ],
    );
}

#[test]
fn for_counts_both_ends_and_exit_leaves_it() {
    let variables = "VAR i, sum : INT (0..99); END_VAR VAR CONSTANT TOP : INT := 4; END_VAR";
    runs(
        variables,
        "sum := 0; FOR i := 1 TO TOP DO sum := MIN(sum + i, 99); END_FOR; p := sum = 10; q := i = 4; m := n;",
        &[(&[], [1, 1, 0, 0])],
    );
    runs(
        variables,
        "sum := 0; FOR i := 6 TO 0 BY -2 DO IF i = n THEN EXIT; END_IF; sum := MIN(sum + 1, 99); END_FOR; m := LIMIT(0, sum, 7);",
        &[
            (&[("n", 6)], [0, 0, 0, 0]),
            (&[("n", 2)], [0, 0, 2, 0]),
            (&[("n", 1)], [0, 0, 4, 0]),
        ],
    );
    // No round at all.
    runs(
        variables,
        "m := 2; FOR i := 3 TO 1 DO m := 5; END_FOR;",
        &[(&[], [0, 0, 2, 0])],
    );
}

#[test]
fn return_ends_the_body_that_it_stands_in() {
    runs(
        "",
        "m := 1; IF a THEN RETURN; END_IF; m := 2; IF b THEN m := 3; RETURN; END_IF; p := TRUE;",
        &[
            (&[("a", 1)], [0, 0, 1, 0]),
            (&[("b", 1)], [0, 0, 3, 0]),
            (&[], [1, 0, 2, 0]),
        ],
    );
    let block = "FUNCTION_BLOCK HOLD VAR_INPUT x : BOOL; END_VAR VAR_OUTPUT y : BOOL; END_VAR
                 IF NOT x THEN RETURN; END_IF; y := TRUE; END_FUNCTION_BLOCK\n";
    let program = whole("VAR h : HOLD; END_VAR", "h(x := a); p := h.y; q := TRUE;");
    let mut plc = Plc::new(&format!("{block}{program}"));
    assert_eq!(plc.step(&[]), Some([0, 1, 0, 0]));
    assert_eq!(plc.step(&[("a", 1)]), Some([1, 1, 0, 0]));
    assert_eq!(plc.step(&[]), Some([1, 1, 0, 0]));
}

#[test]
fn operators_bind_as_in_the_standard() {
    // NOT before all; AND before XOR before OR; comparisons before AND.
    runs(
        "",
        "p := a OR b XOR b AND c; q := NOT a = b; m := 1 + 2 * 3 - 7 MOD 4 / 2;",
        &[
            (&[("a", 1), ("b", 1), ("c", 1)], [1, 0, 6, 0]),
            (&[("b", 1), ("c", 1)], [0, 1, 6, 0]),
            (&[("b", 1)], [1, 1, 6, 0]),
        ],
    );
    runs(
        "",
        "p := NOT (a OR b) AND n > 2 & n <= 16#4; q := a <> b; m := SEL(a, MUX(n / 3, 5, 6, 7), ABS(n - 7)); stop := SEL(c, SS2, SS1);",
        &[
            (&[("n", 4)], [1, 0, 6, 1]),
            (&[("n", 5), ("a", 1), ("c", 1)], [0, 1, 2, 2]),
            (&[("n", 7)], [0, 0, 7, 1]),
        ],
    );
}

#[test]
fn functions_and_blocks_of_the_program_have_their_own_variables() {
    let own = "FUNCTION both : BOOL VAR_INPUT x, y : BOOL; END_VAR VAR p : BOOL; END_VAR p := x; both := p AND y; END_FUNCTION
               FUNCTION_BLOCK COUNT VAR_INPUT up : BOOL; END_VAR VAR_OUTPUT value : INT (0..7); END_VAR VAR edge : R_TRIG; END_VAR
               edge(CLK := up); IF edge.Q AND value < 7 THEN value := value + 1; END_IF; END_FUNCTION_BLOCK\n";
    let program = whole(
        "VAR one, two : COUNT; END_VAR",
        "p := both(a, b); q := both(y := c, x := both(a, b)); one(up := a); two(up := b, value => m); stop := SEL(one.value = 2, NONE, SS2);",
    );
    let mut plc = Plc::new(&format!("{own}{program}"));
    assert_eq!(plc.step(&[("a", 1), ("b", 1)]), Some([1, 0, 1, 0]));
    assert_eq!(plc.step(&[("b", 1), ("c", 1)]), Some([0, 0, 1, 0]));
    assert_eq!(plc.step(&[("a", 1), ("c", 1)]), Some([0, 0, 1, 1]));
    assert_eq!(
        plc.step(&[("a", 1), ("b", 1), ("c", 1)]),
        Some([1, 1, 2, 1])
    );
}

#[test]
fn inputs_of_a_block_keep_their_value() {
    runs(
        "VAR x : SR; END_VAR",
        "IF b THEN x(S1 := a); ELSE x(); END_IF; p := x.Q1; q := x.S1;",
        &[
            (&[("a", 1)], [0, 0, 0, 0]),
            (&[("a", 1), ("b", 1)], [1, 1, 0, 0]),
            (&[], [1, 1, 0, 0]),
            (&[("b", 1)], [1, 0, 0, 0]),
        ],
    );
}

#[test]
fn names_have_no_case_and_parameters_are_read() {
    runs(
        "VAR Count : TIME (T#0s..t_max); END_VAR",
        "if A then COUNT := MIN(count + CYCLE, T_Max); else count := T#0s; end_if; p := count = t_max; q := It_Is;",
        &[
            (&[("a", 1)], [0, 1, 0, 0]),
            (&[("a", 1)], [0, 1, 0, 0]),
            (&[("a", 1)], [0, 1, 0, 0]),
            (&[("a", 1)], [1, 1, 0, 0]),
            (&[], [0, 1, 0, 0]),
        ],
    );
}

#[test]
fn a_value_outside_its_range_is_a_fault() {
    let program = whole(
        "VAR x : INT (0..3); END_VAR",
        "IF a THEN x := x + 1; END_IF; IF b THEN x := 0; END_IF; m := x;",
    );
    let mut plc = Plc::new(&program);
    for k in 1..=3 {
        assert_eq!(plc.step(&[("a", 1)]), Some([0, 0, k, 0]));
    }
    assert_eq!(plc.step(&[("a", 1)]), None);
    // Also where the value is replaced in the same cycle.
    assert_eq!(plc.step(&[("a", 1), ("b", 1)]), None);
    assert_eq!(plc.step(&[("b", 1)]), Some([0, 0, 0, 0]));
    // A variable that is checked and not kept needs no state of more than one value.
    let mut plc = Plc::new(&whole("VAR x : INT (0..3); END_VAR", "x := n; m := x;"));
    assert_eq!(plc.step(&[("n", 3)]), Some([0, 0, 3, 0]));
    assert_eq!(plc.step(&[("n", 4)]), None);
}

#[test]
fn what_nothing_reads_is_no_state() {
    let text = "x := a; y := x; t(IN := a, PT := T#4ms); u := NOT u; p := y; q := FALSE; m := 0; stop := SS1;";
    let plc = Plc::new(&whole("VAR x, y, u : BOOL; t : TON; END_VAR", text));
    assert_eq!(plc.cells(), 0);
}
