//! The numbers of the README's table are those that the commands beside them give. They are generated: with `NUMBERS=write` in the
//! environment the tests write what they would otherwise compare.

use std::path::PathBuf;

use serde_json::Value;
use stillpoint_harness::report::grouped;

use crate::common::{root, stillpoint};

/// A row of the table: where it stands in the text, and its command without the name of the program.
struct Row {
    line: usize,
    command: String,
}

fn readme() -> PathBuf {
    root().join("README.md")
}

/// The rows with a command of `stillpoint` that answers as JSON.
fn rows(text: &str) -> Vec<Row> {
    let table = text
        .lines()
        .enumerate()
        .skip_while(|(_, line)| !line.starts_with("## Numbers"));
    let table = table
        .skip(1)
        .take_while(|(_, line)| !line.starts_with("## "));
    let rows = table.filter_map(|(line, row)| {
        let command = row
            .rsplit('|')
            .nth(1)?
            .split('`')
            .nth(1)?
            .strip_prefix("stillpoint ")?;
        Some(Row {
            line,
            command: command.to_owned(),
        })
    });
    rows.collect()
}

/// What JSON calls that which a number counts, by the words behind it.
fn counted(said: &Value, words: &str) -> Option<u64> {
    let number = |key: &str| said[key].as_u64();
    let first = words.split([',', '|']).next().unwrap_or_default().trim();
    match first {
        "states" | "transitions" | "cycles" | "pairs" => number(first),
        "properties" => said["properties"].as_array().map(|all| all.len() as u64),
        "pairs of states" => number("pairs"),
        "outputs compared" => number("outputs_compared"),
        _ => None,
    }
}

/// The line with the numbers that the answer has, and how many they are; the command's own cell is left alone.
fn renewed(line: &str, said: &Value) -> (String, usize) {
    let end = line
        .trim_end_matches(['|', ' '])
        .rfind('|')
        .unwrap_or(line.len());
    let (text, command) = line.split_at(end);
    let mut out = String::new();
    let mut rest = text;
    let mut count = 0;
    while let Some(at) = rest.find(|c: char| c.is_ascii_digit()) {
        out.push_str(&rest[..at]);
        let number = &rest[at..];
        // A space belongs to the number where a digit follows it.
        let bytes = number.as_bytes();
        let is_digit = |k: usize| bytes.get(k).is_some_and(u8::is_ascii_digit);
        let belongs = |k: usize| is_digit(k) || (bytes.get(k) == Some(&b' ') && is_digit(k + 1));
        let length = (0..).find(|&k| !belongs(k));
        let (number, behind) = number.split_at(length.expect("a number ends"));
        match counted(said, behind) {
            Some(now) => {
                out.push_str(&grouped(u128::from(now)));
                count += 1;
            }
            None => out.push_str(number),
        }
        rest = behind;
    }
    (out + rest + command, count)
}

/// Runs the commands of the rows that are chosen, and compares or writes their lines. The answer is the number of counts.
fn compare(chosen: impl Fn(&str) -> bool) -> usize {
    let text = std::fs::read_to_string(readme()).expect("the README");
    let mut count = 0;
    for row in rows(&text).iter().filter(|row| chosen(&row.command)) {
        let arguments: Vec<&str> = row.command.split_whitespace().chain(["--json"]).collect();
        let output = stillpoint(&arguments);
        let said: Value = serde_json::from_slice(&output.stdout)
            .unwrap_or_else(|e| panic!("{}: {e}", row.command));
        let line = text.lines().nth(row.line).expect("a line");
        let (now, numbers) = renewed(line, &said);
        assert!(
            numbers > 0,
            "no number of `{}` is known: {line}",
            row.command
        );
        count += numbers;
        if std::env::var_os("NUMBERS").is_some_and(|mode| mode == "write") {
            // Read again: another test may have written its own lines.
            let written = std::fs::read_to_string(readme())
                .expect("the README")
                .replace(line, &now);
            std::fs::write(readme(), written).expect("written");
        } else {
            assert_eq!(line, now, "run this test again with NUMBERS=write");
        }
    }
    count
}

/// Those that a test of its own compares, or that take minutes.
fn takes_long(command: &str) -> bool {
    command.starts_with("check spec/machines/") || command.starts_with("diff ")
}

#[test]
fn quick_numbers_are_those_of_their_commands() {
    let count = compare(|command| !takes_long(command));
    assert!(count >= 5, "{count} numbers");
}

#[test]
#[ignore = "deep: the checks of whole machines, the exhaustive comparison, 100 million random cycles"]
fn long_numbers_are_those_of_their_commands() {
    let count = compare(takes_long);
    assert!(count >= 10, "{count} numbers");
}

#[test]
fn a_wrong_number_is_noticed() {
    let said = serde_json::json!({ "states": 1_234_567, "transitions": 89, "properties": [1, 2], "complete": true });
    let line = "| yardstick 2 | 1 234 566 states, 88 transitions, 2 properties | `stillpoint check two-3.toml` |";
    let (now, count) = renewed(line, &said);
    assert_eq!(count, 3);
    assert_eq!(
        now,
        "| yardstick 2 | 1 234 567 states, 89 transitions, 2 properties | `stillpoint check two-3.toml` |"
    );
    assert_eq!(renewed(&now, &said).0, now);
}
