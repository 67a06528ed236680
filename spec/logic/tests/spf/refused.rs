//! What is refused: each with its place, what is wrong, and what to write instead.

use std::sync::Arc;

use stillpoint_lang::diag::{Diagnostics, position};
use stillpoint_logic::spf::{Mode, parse};

use super::rig::{compiled, interface};

/// Everything that is told of a program.
fn told(text: &str, errors: &Diagnostics) -> String {
    let mut said = String::new();
    for one in &errors.0 {
        assert_eq!(one.file, "safe.spf", "{one}");
        assert!(!one.help.is_empty(), "{one}");
        let span = one
            .span
            .clone()
            .unwrap_or_else(|| panic!("no place: {one}"));
        assert!(position(&one.source, span.start).is_some(), "{one}");
        let at = text.get(span).expect("in the text");
        let at = at.lines().next().unwrap_or_default();
        said += &format!(
            "{one}\n  at: {at}\n  label: {}\n  help: {}\n",
            one.label, one.help
        );
    }
    said
}

fn refused(blocks: &str) -> String {
    let text = format!("{blocks}\nM17\n");
    whole(&text)
}

fn whole(text: &str) -> String {
    match compiled(text, &interface()) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(errors) => told(text, &errors),
    }
}

/// The language, S840D-LANG-702, S840D-LANG-703, S840D-LANG-707, S840D-LANG-708, S840D-LANG-711. What is refused of relays: S840D-RELAY-009, S840D-RELAY-010, S840D-RELAY-011, S840D-RELAY-012, S840D-RELAY-016.
#[test]
fn errors_name_place_and_fix() {
    let cases = [
        (
            "C1: a byte is no truth value",
            refused("IDS=1 DO $A_OUTSE[1] = $A_DBB[4] AND $A_INSE[1]"),
        ),
        (
            "C1: numbers and timers",
            refused(
                "IDS=1 WHENEVER 1 DO $A_OUTSE[1] = NOT $AC_MARKER[1]\nIDS=2 EVERY $A_TIMERSI[1] DO $A_OUTSE[1] = 0",
            ),
        ),
        (
            "C2: order of truth values",
            refused("IDS=1 WHENEVER $A_INSE[1] > 0 DO $A_OUTSE[1] = 0"),
        ),
        (
            "C2: a truth value is 0 or 1",
            refused("IDS=1 WHENEVER $A_INSE[1] == 2 DO $A_OUTSE[1] = 0"),
        ),
        (
            "C2: two variables",
            refused(
                "IDS=1 WHENEVER $A_INSE[1] == $A_INSE[2] DO $A_OUTSE[1] = 0\nIDS=2 WHENEVER $A_DBB[1] > $A_DBB[2] DO $A_OUTSE[1] = 0",
            ),
        ),
        (
            "C2: two constants",
            refused("IDS=1 WHENEVER 1 == 1 DO $A_OUTSE[1] = 0"),
        ),
        (
            "C2: a byte and what it never is",
            refused(
                "IDS=1 WHENEVER $A_DBB[1] == 300 DO $A_OUTSE[1] = 0\nIDS=2 WHENEVER $A_DBB[1] > 1.5 DO $A_OUTSE[1] = 0\nIDS=3 WHENEVER $A_XFAULTSI == TRUE DO $A_OUTSE[1] = 0",
            ),
        ),
        (
            "C2: too long a time",
            refused("IDS=1 WHENEVER $A_TIMERSI[1] > 9000000 DO $A_OUTSE[1] = 0"),
        ),
        (
            "C3: types of assignments",
            refused(
                "IDS=1 DO $A_OUTSE[1] = 2 $A_OUTSE[2] = 1.0\nIDS=2 DO $A_TIMERSI[1] = $A_INSE[1]\nIDS=3 DO $AC_MARKER[1] = $A_INSE[1]\nIDS=4 DO $A_OUTSE[1] = $A_DBB[1]\nIDS=5 DO $A_TIMERSI[1] = $A_TIMERSI[2]",
            ),
        ),
        (
            "C4: an input is assigned",
            refused("IDS=1 DO $A_INSE[3] = 1\nIDS=2 DO $A_PLCSIIN[1] = 0"),
        ),
        (
            "C4: what is written only",
            refused("IDS=1 DO $A_OUTSE[1] = $AC_ESR_TRIGGER"),
        ),
        (
            "C5: ids",
            refused(
                "IDS=0 DO $A_OUTSE[1] = 1\nIDS=256 DO $A_OUTSE[1] = 1\nIDS=-1 DO $A_OUTSE[1] = 1\nIDS=1.5 DO $A_OUTSE[1] = 1\nIDS DO $A_OUTSE[1] = 1",
            ),
        ),
        (
            "C7: set-up in an action",
            refused("DEF INT S\nIDS=1 DO SIRELIN(1, S, \"$A_INSE[1]\")"),
        ),
        (
            "C7: call outside",
            refused("DEF INT S\nS = SIRELAY(1)\n$AC_MARKER[1] = SIRELAY(1)"),
        ),
        (
            "C7: which relay",
            refused("IDS=1 DO $AC_MARKER[1] = SIRELAY(5)\nDEF INT S\nSIRELTIME(0, S, 1.0)"),
        ),
        (
            "C7: pairs",
            refused(
                "DEF INT S\nSIRELOUT(1, S, \"$A_OUTSE[1]\", \"$A_OUTSE[2]\")\nSIRELTIME(1, S, 0.5)",
            ),
        ),
        (
            "C7: variables of a relay",
            refused(
                "DEF INT S\nSIRELIN(1, S, \"$A_PLCSIIN[1]\", \"S\", \"$A_INSE[1]\")\nSIRELOUT(1, S, \"$A_INSE[1]\")\nSIRELOUT(1, S)\nSIRELIN(1, X, \"$A_INSE[1]\")\nSIRELTIME(1, S, -0.5)",
            ),
        ),
        (
            "C7: twice",
            refused("DEF INT S\nSIRELTIME(1, S, 0.5)\nSIRELTIME(1, S, 0.5)"),
        ),
        (
            "C7: the status",
            refused("IDS=1 DO $A_OUTSE[1] = SIRELAY(1)\nIDS=2 DO $A_OUTSE[2] = NOT SIRELAY(1)"),
        ),
        (
            "C8: images of the PLC",
            refused("IDS=1 DO $A_OUTSE[1] = $A_INSEP[1]\nIDS=2 DO $A_OUTSID[1] = $A_OUTSIPD[1]"),
        ),
        ("C9: no end", whole("IDS=1 DO $A_OUTSE[1] = 1\n")),
        (
            "C9: blocks after the end",
            whole("IDS=1 DO $A_OUTSE[1] = 1 M17\nIDS=2 DO $A_OUTSE[2] = 1\n"),
        ),
        (
            "repeated ids",
            refused("IDS=08 DO $A_OUTSE[1] = 1\nIDS=8 DO $A_OUTSE[2] = 1\nID=8 DO $A_OUTSE[2] = 0"),
        ),
        (
            "PREC_REJECT",
            refused(
                "IDS=1 DO $A_OUTSE[1] = $A_TIMERSI[1] > 1.0 AND $A_INSE[1]\nIDS=2 WHENEVER NOT $A_INSE[1] == 0 DO $A_OUTSE[1] = 1\nIDS=3 WHENEVER $A_INSE[1] == 1 == 1 DO $A_OUTSE[1] = 1",
            ),
        ),
        (
            "indices",
            refused(
                "IDS=1 DO $A_OUTSE[65] = $A_INSE[0]\nIDS=2 DO $A_OUTSE = 1\nIDS=3 DO $A_OUTSE[X1] = $VA_DPE[1]\nIDS=4 DO $AC_ESR_TRIGGER[1] = 1",
            ),
        ),
        (
            "variables that do not exist",
            refused("IDS=1 DO $A_OUT[1] = $A_INST[1]\nIDS=2 DO $R1 = 1"),
        ),
        (
            "names",
            refused("DEFINE PUMP AS $A_OUTSE[1]\nIDS=1 DO PUMPE = 1\nIDS=2 DO PUMP = DOOR"),
        ),
        (
            "definitions",
            refused(
                "DEFINE A AS $A_OUTSE[1]\nDEFINE a AS $A_OUTSE[2]\nDEFINE AND AS $A_INSE[1]\nDEFINE B $A_INSE[1]\nDEFINE C AS\nDEFINE THIS_NAME_IS_LONGER_THAN_THE_LANGUAGE_HAS AS 1\nDEF INT A\nDEF WORD W",
            ),
        ),
        (
            "a definition below its use",
            refused("IDS=1 DO A = 1\nDEFINE A AS $A_OUTSE[1]"),
        ),
        (
            "DEF in actions",
            refused("DEF BOOL X\nIDS=1 DO X = 1 $A_OUTSE[1] = X"),
        ),
        (
            "a number is assigned",
            refused("DEFINE N AS 5\nIDS=1 DO N = 1"),
        ),
        (
            "== for =, = for ==",
            refused("IDS=1 DO $A_OUTSE[1] == 1\nIDS=2 EVERY $A_INSE[1] = 1 DO $A_OUTSE[1] = 1"),
        ),
        (
            "parts of an action",
            refused(
                "IDS=1 EVERY DO $A_OUTSE[1] = 1\nIDS=2 EVERY $A_INSE[1] $A_OUTSE[1] = 1\nIDS=3 DO\nIDS=4 DO $A_OUTSE[1] =\nIDS=5 DO $A_OUTSE[1] = ($A_INSE[1]\nIDS=6 DO $A_OUTSE[1] = $A_INSE[1])\nIDS=7 DO 5 = 1",
            ),
        ),
        (
            "what is no statement",
            refused("G01 X100\nIDDS=1 DO $A_OUTSE[1] = 1\n$A_OUTSE[1] = 1\nGOTOF END"),
        ),
        (
            "calculation",
            refused(
                "IDS=1 WHENEVER $A_DBB[1] + 1 == 2 DO $A_OUTSE[1] = 1\nIDS=2 DO $A_OUTSE[1] = $A_INSE[1] B_AND $A_INSE[2]",
            ),
        ),
        (
            "letters",
            refused(
                "IDS=1 DO $A_OUTSE[1] = 1 ü\nIDS=2 DO \\$A_OUTSE[1] = 1\nIDS=3 DO $ A_OUTSE[1] = 1\nMSG(\"open)\nIDS=4 DO $A_OUTSE[1] = 1x",
            ),
        ),
        (
            "numbers",
            refused("IDS=1 DO $A_TIMERSI[1] = 0.1234567\nIDS=2 DO $AC_MARKER[1] = 99999999999"),
        ),
        (
            "header",
            whole("IDS=1 DO $A_OUTSE[1] = 1\n%_N_SAFE_SPF\nM17\n"),
        ),
        ("header without a name", whole("% SAFE\nM17\n")),
        (
            "not explored: double words",
            refused("IDS=1 WHENEVER $A_MARKERSID[1] == 0 DO $A_OUTSE[1] = 1"),
        ),
        (
            "not explored: numbers far apart",
            refused("IDS=1 WHENEVER $AC_MARKER[1] == 1000000 DO $A_OUTSE[1] = 1"),
        ),
        (
            "not explored: relays under a condition, or twice",
            refused(
                "IDS=1 WHENEVER $A_INSE[1] DO $AC_MARKER[1] = SIRELAY(1)\nIDS=2 DO $AC_MARKER[1] = SIRELAY(2) $AC_MARKER[2] = SIRELAY(2)",
            ),
        ),
    ];
    let said: Vec<String> = cases
        .iter()
        .map(|(title, told)| format!("--- {title}\n{told}"))
        .collect();
    insta::assert_snapshot!(said.join("\n"));
}

fn listing(text: &str) -> String {
    match parse("safe.spf", &Arc::from(text), Mode::Listing) {
        Ok(program) => panic!("accepted:\n{program}"),
        Err(errors) => told(text, &errors),
    }
}

/// Damage that no repair is known for is told in printed programs too.
#[test]
fn not_every_damage_is_repaired() {
    let cases = [
        (
            "names and variables that do not pair",
            listing("DEFINE A\nDEFINE B\n  AS $A_INSE[1]\nIDS=1 DO $A_OUTSE[1] = 1\nM17"),
        ),
        (
            "two names that a word could be",
            listing(
                "DEFINE STOP_1 AS $A_INSE[1]\nDEFINE STOP_2 AS $A_INSE[2]\nIDS=1 DO $A_OUTSE[1] = STOP\nM17",
            ),
        ),
        (
            "an expression that breaks off",
            listing("IDS=1 DO $A_OUTSE[1] = $A_INSE[1] AND\nM17"),
        ),
        (
            "a bracket too many",
            listing("IDS=1 DO $A_OUTSE[1] = $A_INSE[1])\nM17"),
        ),
        ("a fragment has no table", {
            let text = "IDS=1 DO OUT = IN_1";
            let program = parse("safe.spf", &Arc::from(text), Mode::Listing).expect("a part");
            told(
                text,
                &program
                    .compile(&interface())
                    .map(|_| ())
                    .expect_err("no table"),
            )
        }),
    ];
    let said: Vec<String> = cases
        .iter()
        .map(|(title, told)| format!("--- {title}\n{told}"))
        .collect();
    insta::assert_snapshot!(said.join("\n"));
}

/// Deep and long programs are refused, or read in a moment: nothing exhausts the stack or the memory.
#[test]
fn long_and_deep_programs_end() {
    let one = |expr: &str| refused(&format!("IDS=1 DO $A_OUTSE[1] = {expr}"));
    one(&"(".repeat(100_000));
    one(&format!("{}$A_INSE[1]", "NOT ".repeat(100_000)));
    one(&format!("$A_INSE[1]{}", " AND $A_INSE[1]".repeat(10_000)));
    one(&format!(
        "{}$A_INSE[1]{}",
        "NOT (".repeat(1_000),
        ")".repeat(1_000)
    ));
    refused(&"IDS=1 DO nothing = 1\n".repeat(10_000));
    listing(&"(".repeat(100_000));
    listing(&format!("IDS=1 DO {}", "A B C D ".repeat(10_000)));
    whole(&"x".repeat(1 << 20));
    // As many actions as there are ids, each with many assignments, are translated in a moment.
    let many: String = (1..=255)
        .map(|id| {
            format!(
                "IDS={id} EVERY $A_INSE[1] XOR $A_MARKERSI[{}] DO {}\n",
                id % 64 + 1,
                "$A_OUTSE[1] = NOT $A_OUTSE[1] ".repeat(9)
            )
        })
        .collect();
    assert!(compiled(&format!("{many}M17\n"), &interface()).is_ok());
}
