//! What is refused: each with its place, what is wrong, and what to write instead.

use stillpoint_lang::diag::{Diagnostics, position};

use super::rig::{compiled, interface};

/// Everything that is told of a program.
fn told(text: &str, errors: &Diagnostics) -> String {
    let mut said = String::new();
    for one in &errors.0 {
        assert_eq!(one.file, "safe.stl", "{one}");
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

fn refused(text: &str) -> String {
    match compiled(text, &interface()) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(errors) => told(text, &errors),
    }
}

#[test]
fn errors_name_place_and_fix() {
    let cases = [
        ("signs", "U E 0.0\n= A 4.0 ?"),
        ("a symbol without end", "U \"SPL.X\n"),
        ("nothing", ""),
        (
            "no instruction",
            "UU E 0.0\nFOO M 1.0\n: 5\nSPZ M001\nZV Z 1\nLOOP M001\nUW W#16#1\nSAVE",
        ),
        (
            "both languages",
            "U E 0.0\nAN I 0.1\n= Q 4.0\nSPB M001\nSD T 1\nM001: NOP 0",
        ),
        ("SE alone", "O M 1.0\nL S5T#1S\nSE T 1"),
        (
            "addresses",
            "U E 0\nU E 0.8\nU EB 0\nU M 9000.0\nU DB31.DBY 1.0\nU DBX 1.0\nU L 0.0\nU INSEP[65]\nU FOO[1]\nU FOO\nU 5\nU",
        ),
        (
            "symbols",
            "SYMBOLS\n\"SPL\".X : MARKERSIP[1]\n\"SPL\".X : MARKERSIP[2]\nY : M 1.0\n\"Z\" M 1.0\n\"W\" : M 1.0 M 1.1\nEND_SYMBOLS\nU \"SPL\".Y\nU \"Test\"\n= A 4.0",
        ),
        (
            "an open symbol table",
            "SYMBOLS\n\"SPL\".X : MARKERSIP[1]\n",
        ),
        (
            "times",
            "U E 0.0\nL S5T#1\nL S5T#1X\nL S5T#1MS\nL S5T#3H\nL S5T#1S1H\nL T#1S\nL S5T#0S",
        ),
        (
            "constants",
            "L B#16#G\nL W#8#7\nL 99999999999\nL X#1\nL - M 1.0",
        ),
        (
            "inputs are not written",
            "U E 0.0\n= E 0.1\nS E 0.1\nR E 3.7\nL 0\nT EB 1\nFP E 0.1\n= T 1\nS T 1",
        ),
        ("no result", "= A 4.0\nS A 4.0"),
        (
            "no result behind a label",
            "U E 0.0\nSPB M001\nU E 0.1\nM001: = A 4.0",
        ),
        (
            "no result behind a call",
            "ORGANIZATION_BLOCK OB 1\nU E 0.0\n= A 4.0\nCALL FC 1\n= A 4.1\nEND_ORGANIZATION_BLOCK\nFUNCTION FC 1 : VOID\nNOP 0\nEND_FUNCTION",
        ),
        (
            "checks that lead to nothing",
            "U E 0.0\nSET\n= A 4.0\nU E 0.1\nSPA M001\nM001: NOP 0",
        ),
        ("brackets", "U E 0.0\nU(\nU E 0.1\n= A 4.0"),
        ("empty brackets", "U(\n)\n)\n= A 4.0"),
        (
            "too many brackets",
            "U(\nU(\nU(\nU(\nU(\nU(\nU(\nU(\nU E 0.0\n)\n)\n)\n)\n)\n)\n)\n)\n= A 4.0",
        ),
        (
            "O without anything",
            "O\nU E 0.0\n= A 4.0\nU E 0.0\nO\n= A 4.0",
        ),
        (
            "timers",
            "U T 1\n= A 4.0\nU E 0.0\nSE T 2\nU E 0.0\nL S5T#1S\nSE T 3\nU E 0.1\nL S5T#2S\nSE T 3\nU E 0.0\nL S5T#1S\nSA T 4\nR T 4\nL S5T#1S\nSE M 1.0",
        ),
        (
            "jumps",
            "M001: NOP 0\nU E 0.0\nSPB M001\nSPA M002\nSPB\nM003: NOP 0\nM003: NOP 0",
        ),
        (
            "a label at the end",
            "FUNCTION FC 1 : VOID\nU E 0.0\n= A 4.0\nM001:\nEND_FUNCTION",
        ),
        (
            "numbers",
            "T MB 1\nL 300\nT MB 1\nL -1\nT MB 2\nL MW 4\nT MB 3\nL MD 8\nL S5T#1S\nT MB 5\nL 1\n==I\n==R\nL M 1.0\nT M 1.0",
        ),
        (
            "a comparison within a string",
            "L MB 1\nL 2\nU E 0.0\n==I\n= A 4.0",
        ),
        (
            "a byte and its bits",
            "L MB 1\nL 2\n==I\n= A 4.0\nU E 0.0\n= M 1.3",
        ),
        (
            "a byte that is no constant",
            "U E 0.0\n= M 1.3\nU M 1.3\n= A 4.0\nL MB 5\nT MB 1",
        ),
        (
            "bytes that overlap",
            "L MB 1\nT MB 2\nL 5\nT MW 0\nL MW 0\nL 1\n==I\n= A 4.0",
        ),
        ("a free word", "L MW 0\nL 1\n==I\n= A 4.0"),
        ("more on a line", "U E 0.0 U E 0.1\n= A 4.0"),
        (
            "blocks that are not read",
            "DATA_BLOCK DB 1\nSTRUCT\nEND_STRUCT\nEND_DATA_BLOCK\nFUNCTION_BLOCK FB 1\nEND_FUNCTION_BLOCK\nTYPE UDT 1\nEND_TYPE\nFUNCTION FC 1 : VOID\nNOP 0\nEND_FUNCTION",
        ),
        (
            "blocks",
            "FUNCTION M 1.0 : VOID\nEND_FUNCTION\nFUNCTION FC 1 : INT\nNOP 0\nEND_FUNCTION\nFUNCTION FC 1 : VOID\nVAR_TEMP\nx : BOOL;\nEND_VAR\nNOP 0\nFUNCTION FC 3 : VOID\nU E 0.0",
        ),
        (
            "which block runs",
            "FUNCTION FC 1 : VOID\nNOP 0\nEND_FUNCTION\nFUNCTION FC 2 : VOID\nNOP 0\nEND_FUNCTION",
        ),
        (
            "a block that calls itself",
            "FUNCTION FC 1 : VOID\nCALL FC 2\nEND_FUNCTION\nFUNCTION FC 2 : VOID\nCALL FC 1\nEND_FUNCTION",
        ),
        (
            "both cycles",
            "ORGANIZATION_BLOCK OB 1\nNOP 0\nEND_ORGANIZATION_BLOCK\nORGANIZATION_BLOCK OB 40\nNOP 0\nEND_ORGANIZATION_BLOCK",
        ),
        (
            "another organization block",
            "ORGANIZATION_BLOCK OB 35\nNOP 0\nEND_ORGANIZATION_BLOCK",
        ),
        (
            "calls",
            "CALL FC 50\nCALL FB 7, DB 3\nCALL \"ANY\"\nCALL M 1.0\nCALL FB 10, M 1.0",
        ),
        (
            "parameters",
            "CALL FC 60 (\nstart := M 1.0,\nredy := M 1.1,\nready := 5,\nerror := E 0.1)",
        ),
        ("parameters without end", "CALL FC 60 (\nstart := M 1.0,\n"),
        (
            "parameters of the relay",
            "CALL FB 10, DB 80 (In1 := 7, TimeValue1 := 5, Out0 := A 4.0)",
        ),
        (
            "parameters of an own block",
            "ORGANIZATION_BLOCK OB 1\nCALL FC 1 (x := M 1.0)\nEND_ORGANIZATION_BLOCK\nFUNCTION FC 1 : VOID\nNOP 0\nEND_FUNCTION",
        ),
        (
            "a timer of a block that is called twice",
            "ORGANIZATION_BLOCK OB 1\nCALL FC 1\nCALL FC 1\nEND_ORGANIZATION_BLOCK\nFUNCTION FC 1 : VOID\nU E 0.0\nL S5T#1S\nSE T 1\nEND_FUNCTION",
        ),
    ];
    let said: Vec<String> = cases
        .iter()
        .map(|(title, text)| format!("--- {title}\n{}", refused(text)))
        .collect();
    insta::assert_snapshot!(said.join("\n"));
}

/// Deep and long programs are refused, or read in a moment: nothing exhausts the stack or the memory.
#[test]
fn long_and_deep_programs_end() {
    let long = "U E 0.0\n".repeat(15_000);
    assert!(compiled(&format!("{long}= A 4.0"), &interface()).is_ok());
    refused(&format!("{}= A 4.0", "U E 0.0\n".repeat(30_000)));
    refused(&"U(\n".repeat(10_000));
    refused(&"X".repeat(600_000));
    let jumps: String = (0..200).map(|k| format!("U E 0.0\nSPB L{k}\n")).collect();
    let labels: String = (0..200).map(|k| format!("L{k}: NOP 0\n")).collect();
    assert!(compiled(&format!("{jumps}SET\n= A 4.0\n{labels}"), &interface()).is_ok());
    // Blocks that double.
    let blocks: String = (1..20)
        .map(|k| {
            format!(
                "FUNCTION FC {k} : VOID\nCALL FC {0}\nCALL FC {0}\nEND_FUNCTION\n",
                k + 1
            )
        })
        .collect();
    refused(&format!(
        "{blocks}FUNCTION FC 20 : VOID\nSET\n= A 4.0\nEND_FUNCTION"
    ));
    let nots = "NOT\n".repeat(10_000);
    assert!(compiled(&format!("U E 0.0\n{nots}= A 4.0"), &interface()).is_ok());
}
