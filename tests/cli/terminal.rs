//! What a terminal is shown and a pipe is not, completions and manual pages.

use std::process::{Command, Output};

use crate::common::root;

const GOOD: &str = "tests/certified/forms.toml";
const BAD: &str = "tests/must-fail/stop-b-without-timer.toml";
const ESCAPE: char = '\u{1b}';

/// A command in the root of the workspace that finds none of the variables that decide about colour.
fn command(program: &str) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root()).env("TERM", "xterm-256color");
    for variable in [
        "NO_COLOR",
        "CLICOLOR",
        "CLICOLOR_FORCE",
        "FORCE_COLOR",
        "COLORTERM",
        "CI",
    ] {
        command.env_remove(variable);
    }
    command
}

/// Runs the binary with pipes.
fn piped(arguments: &[&str], variables: &[(&str, &str)]) -> Output {
    command(env!("CARGO_BIN_EXE_stillpoint"))
        .args(arguments)
        .envs(variables.iter().copied())
        .output()
        .expect("the binary runs")
}

/// Runs the binary on a terminal, by `script` of util-linux; none where there is no such program.
fn on_terminal(arguments: &[&str], variables: &[(&str, &str)]) -> Option<String> {
    let line = format!(
        "'{}' {}",
        env!("CARGO_BIN_EXE_stillpoint"),
        arguments.join(" ")
    );
    let run = command("script")
        .args(["-q", "-e", "-c", &line, "/dev/null"])
        .envs(variables.iter().copied())
        .output();
    match run {
        Ok(output) => Some(String::from_utf8(output.stdout).expect("UTF-8")),
        Err(e) => {
            assert!(
                std::env::var_os("CI").is_none(),
                "script (util-linux) is missing: {e}"
            );
            println!("SKIPPED: script (util-linux) is not installed");
            None
        }
    }
}

fn text(output: &Output) -> String {
    format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    )
}

#[test]
fn a_pipe_sees_no_escape_sequence() {
    let commands: &[&[&str]] = &[
        &["check", GOOD],
        &["check", BAD],
        &["validate", "tests/bad-input/wrong-unit.toml"],
        &["check", "no-such-file.toml"],
        &["--help"],
        &["check", "--nonsense"],
        &["man"],
    ];
    for arguments in commands {
        let seen = text(&piped(arguments, &[]));
        assert!(
            !seen.is_empty() && !seen.contains(ESCAPE),
            "{arguments:?}: {seen:?}"
        );
    }
}

#[test]
fn a_terminal_sees_verdicts_and_errors_in_colour() {
    let cases: [(&[&str], &str); 4] = [
        (&["check", BAD], "\u{1b}[1m\u{1b}[31mVIOLATED\u{1b}[0m"),
        (&["check", BAD], "\u{1b}[1m\u{1b}[31mviolated\u{1b}[0m"),
        (
            &["check", "no-such-file.toml", "--readings", "?"],
            "\u{1b}[1m\u{1b}[31merror:\u{1b}[0m",
        ),
        (
            &["validate", "tests/bad-input/wrong-unit.toml"],
            "\u{1b}[31m",
        ),
    ];
    for (arguments, word) in cases {
        let Some(seen) = on_terminal(arguments, &[]) else {
            return;
        };
        assert!(seen.contains(word), "{arguments:?}: {seen:?}");
    }
}

#[test]
fn the_user_decides_about_colour() {
    for off in [("NO_COLOR", "1"), ("CLICOLOR", "0"), ("TERM", "dumb")] {
        for arguments in [
            ["check", BAD],
            ["validate", "tests/bad-input/wrong-unit.toml"],
        ] {
            let Some(seen) = on_terminal(&arguments, &[off]) else {
                return;
            };
            // The line of progress moves the cursor; no sequence may set a colour (`ESC [ ... m`).
            let coloured = seen.split(ESCAPE).skip(1).any(|rest| {
                rest.trim_start_matches(|c: char| c == '[' || c == ';' || c.is_ascii_digit())
                    .starts_with('m')
            });
            assert!(!coloured, "{off:?} {arguments:?}: {seen:?}");
        }
    }
    let forced = text(&piped(&["check", BAD], &[("CLICOLOR_FORCE", "1")]));
    assert!(forced.contains("\u{1b}[31mVIOLATED"), "{forced:?}");
}

/// The subcommands, as the help lists them.
pub fn subcommands(help: &str) -> Vec<String> {
    let list = help.split("Commands:").nth(1).expect("a list of commands");
    let list = list.split("\n\n").next().expect("a list");
    let names = list.lines().filter_map(|l| l.strip_prefix("  "));
    let names = names.filter(|l| !l.starts_with(' '));
    let first = names.filter_map(|l| l.split_whitespace().next());
    first.filter(|n| *n != "help").map(str::to_owned).collect()
}

#[test]
fn every_command_has_an_example_a_manual_page_and_completions() {
    let folder = std::env::temp_dir().join(format!("stillpoint-man-{}", std::process::id()));
    let written = piped(&["man", "--output", &folder.display().to_string()], &[]);
    assert!(written.status.success(), "{}", text(&written));
    let commands = subcommands(&text(&piped(&["--help"], &[])));
    assert!(commands.len() > 7, "{commands:?}");
    let completions: Vec<String> = ["bash", "zsh", "fish", "elvish", "powershell"]
        .iter()
        .map(|shell| text(&piped(&["completions", shell], &[])))
        .collect();
    for name in &commands {
        let help = text(&piped(&[name, "--help"], &[]));
        let example = help.split("Example").nth(1).unwrap_or_default();
        assert!(example.contains(&format!("stillpoint {name}")), "{help}");
        let page = folder.join(format!("stillpoint-{name}.1"));
        let page = std::fs::read_to_string(&page).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(
            page.contains(".SH SYNOPSIS") && page.contains("stillpoint"),
            "{page}"
        );
        assert!(
            completions.iter().all(|c| c.contains(name.as_str())),
            "{name}"
        );
    }
    assert!(folder.join("stillpoint.1").is_file());
    let again = text(&piped(&["man"], &[]));
    let first = std::fs::read_to_string(folder.join("stillpoint.1")).expect("the page");
    assert_eq!(again, first);
    std::fs::remove_dir_all(&folder).expect("removed");
}

#[test]
fn a_folder_that_cannot_be_written_is_told() {
    let output = piped(&["man", "--output", "Cargo.toml/here"], &[]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        text(&output).starts_with("error: Cargo.toml/here cannot be written"),
        "{}",
        text(&output)
    );
}
