//! Programs of a safe PLC in Structured Text beside a machine file: a wrong one is refused with its place, a changed one is seen.

use crate::common::{Folder, command, root, session, status, stderr, stdout};

/// The machining centre in a folder of its own, with a text of its program replaced.
fn centre(name: &str, from: &str, to: &str) -> Folder {
    let folder = Folder::new(name);
    let text = |file: &str| {
        std::fs::read_to_string(root().join("tests/machines").join(file)).expect("readable")
    };
    let program = text("machining-centre-st.st");
    assert!(program.contains(from), "{from}");
    folder.write("machining-centre-st.st", &program.replacen(from, to, 1));
    folder.write("machine.toml", &text("machining-centre-st.toml"));
    folder
}

#[test]
fn bad_programs_are_refused_with_place_and_fix() {
    let mut said = String::new();
    for (title, from, to) in [
        ("an output is missing", "  request_t : State;", " "),
        (
            "a name is unknown",
            "moves := state_a <= SLS_S",
            "moves := state_b <= SLS_S",
        ),
        ("a type is wrong", "pb_t := pb_magazine;", "pb_t := unit;"),
        (
            "WHILE",
            "IF stood = t_clear THEN program_runs := FALSE; END_IF;",
            "WHILE stood = t_clear DO program_runs := FALSE; END_WHILE;",
        ),
        (
            "END_IF is missing",
            "  feed_a := TRUE;\n  stop_a := Stop#NONE;\nEND_IF;",
            "  feed_a := TRUE;\n  stop_a := Stop#NONE;",
        ),
        (
            "an input is assigned",
            "pb_s := pb;",
            "gen_safe := TRUE; pb_s := pb;",
        ),
        (
            "a parameter of a block is unknown",
            "axes(open := door_open, key :=",
            "axes(opened := door_open, key :=",
        ),
        (
            "a number without range",
            "  confirmed  : BOOL; ",
            "  confirmed  : BOOL; count : INT; ",
        ),
        (
            "two mistakes",
            "pb_t := pb_magazine;",
            "pb_t := 1; pb_u := pb;",
        ),
    ] {
        let folder = centre("bad-program", from, to);
        let mut first = String::new();
        for arguments in [["check", "machine.toml"], ["validate", "machine.toml"]] {
            let output = command(&arguments)
                .current_dir(&folder.0)
                .output()
                .expect("it runs");
            assert_eq!(status(&output), 2, "{title}: {}", stderr(&output));
            assert!(stdout(&output).is_empty(), "{title}");
            let told = stderr(&output);
            assert!(
                told.contains("machining-centre-st.st:") && told.contains("help: "),
                "{title}: {told}"
            );
            if first.is_empty() {
                said.push_str(&format!("--- {title}\n{}", session(&arguments, &output)));
                first = told;
            } else {
                assert_eq!(told, first);
            }
        }
    }
    insta::assert_snapshot!(said);
}

#[test]
fn a_right_program_is_plausible() {
    let folder = centre("right-program", "", "");
    let output = command(&["validate", "machine.toml"])
        .current_dir(&folder.0)
        .output()
        .expect("it runs");
    assert_eq!(status(&output), 0, "{}", stderr(&output));
}
