//! What the book prints is what happens: its commands are run and compared, its files are tried.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{Folder, root};

fn page(name: &str) -> String {
    let path = root().join("docs/src").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The fenced blocks of a language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    let after = page.split(fence.as_str()).skip(1);
    after.filter_map(|rest| rest.split("```").next()).collect()
}

/// A command as it is printed, and what it is said to answer.
struct Session {
    command: String,
    answer: Vec<String>,
}

fn sessions(page: &str) -> Vec<Session> {
    let mut out: Vec<Session> = Vec::new();
    for line in blocks(page, "console").iter().flat_map(|b| b.lines()) {
        match (line.strip_prefix("$ "), out.last_mut()) {
            (Some(command), _) => {
                let command = command.split(" # ").next().unwrap_or(command);
                out.push(Session {
                    command: command.trim().to_owned(),
                    answer: Vec::new(),
                });
            }
            (None, Some(last)) => last.answer.push(line.trim_end().to_owned()),
            (None, None) => panic!("an answer without a command: {line}"),
        }
    }
    out
}

/// Runs the binary; its status, and all it says.
fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_stillpoint"))
        .args(arguments)
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .output()
        .expect("the binary runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let all = text(&output.stdout) + &text(&output.stderr);
    (output.status.code(), all)
}

/// Whether lines are as printed: `...` alone stands for any lines, at the end of a line for its rest.
fn matches(printed: &[String], said: &[&str]) -> bool {
    match (printed.split_first(), said.split_first()) {
        (None, rest) => rest.is_none(),
        (Some((any, printed)), _) if any.trim() == "..." => {
            (0..=said.len()).any(|n| matches(printed, &said[n..]))
        }
        (Some(_), None) => false,
        (Some((line, printed)), Some((now, said))) => {
            let same = match line.strip_suffix("...") {
                Some(beginning) => now.starts_with(beginning.trim_end()),
                None => line == now.trim_end(),
            };
            same && matches(printed, said)
        }
    }
}

/// Runs the commands of `stillpoint` on a page that `chosen` picks, and compares what they say. The answer is their number.
fn replay(sessions: &[Session], folder: &Path, chosen: impl Fn(&str) -> bool) -> usize {
    let mut count = 0;
    let mut status = None;
    for session in sessions {
        if session.command == "echo $?" {
            let printed = session.answer.first().and_then(|n| n.parse::<i32>().ok());
            assert_eq!(status.flatten(), printed, "echo $?");
            status = None;
            continue;
        }
        let Some(arguments) = session.command.strip_prefix("stillpoint ") else {
            continue;
        };
        if !chosen(arguments) {
            status = None;
            continue;
        }
        let arguments: Vec<&str> = arguments.split_whitespace().collect();
        let (code, said) = run(folder, &arguments);
        status = Some(code);
        let said: Vec<&str> = said.lines().collect();
        // What nobody has printed is not compared; an answer that is cut need not begin at the first line.
        if !session.answer.is_empty() {
            let good = matches(&session.answer, &said)
                || matches(
                    &[vec!["...".to_owned()], session.answer.clone()].concat(),
                    &said,
                )
                || matches(
                    &[session.answer.clone(), vec![String::new()]].concat(),
                    &said,
                );
            assert!(good, "{}:\n{}", session.command, said.join("\n"));
        }
        count += 1;
    }
    count
}

#[test]
fn the_tutorial_says_what_happens() {
    let tutorial = page("tutorial.md");
    let sessions = sessions(&tutorial);
    // The milling machine is checked by a test of its own, with these figures; see `tests/corpus/machines.rs`.
    let quick = |command: &str| {
        !command.contains("barrier.toml") && !command.starts_with("check spec/machines/")
    };
    let run = replay(&sessions, &root(), quick);
    assert!(run >= 3, "{run} commands");
}

#[test]
fn the_barrier_of_the_tutorial_is_broken_and_repaired() {
    let tutorial = page("tutorial.md");
    let barrier = blocks(&tutorial, "toml")
        .into_iter()
        .find(|b| b.contains("tutorial/barrier"))
        .expect("the barrier");
    let folder = Folder::new("barrier");
    folder.write("barrier.toml", barrier);
    let sessions: Vec<Session> = sessions(&tutorial)
        .into_iter()
        .filter(|s| s.command.contains("barrier.toml"))
        .collect();
    assert_eq!(sessions.len(), 2);
    assert_eq!(replay(&sessions[..1], &folder.0, |_| true), 1);
    // The mistake of the second one: a letter for a digit.
    folder.write(
        "barrier.toml",
        &barrier.replace("TIME(1..50)", "TIME(1..5O)"),
    );
    assert_eq!(replay(&sessions[1..], &folder.0, |_| true), 1);
    let good = barrier.replace(
        "when = \"drive = STANDS AND restart\"",
        "when = \"drive = STANDS AND restart AND clear\"",
    );
    assert_ne!(good, barrier);
    folder.write("barrier.toml", &good);
    let (status, said) = run(&folder.0, &["check", "barrier.toml"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.starts_with("tutorial/barrier: ALL PROPERTIES HOLD"),
        "{said}"
    );
}

#[test]
fn the_family_of_the_book_works() {
    let text = page("adding-a-family.md");
    let folder = Folder::new("family");
    let mut files = 0;
    for block in blocks(&text, "toml") {
        let path = block.strip_prefix("# ").and_then(|b| b.split(':').next());
        folder.write(path.expect("a path in the first line"), block);
        files += 1;
    }
    assert_eq!(files, 3);
    assert_eq!(replay(&sessions(&text), &folder.0, |_| true), 1);
    let (status, said) = run(&folder.0, &["check", "spec/families/demo/limiter.toml"]);
    assert_eq!(status, Some(0), "{said}");
    let machine =
        std::fs::read_to_string(folder.0.join("spec/machines/press.toml")).expect("a file");
    folder.write(
        "spec/machines/press.toml",
        &machine.replace("50 ms", "5 ms"),
    );
    let (status, said) = run(&folder.0, &["check", "spec/machines/press.toml"]);
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("make STOP_TIME at least twice the CYCLE"),
        "{said}"
    );
}

#[test]
fn commands_of_the_book_exist() {
    let mut names: Vec<PathBuf> = vec![root().join("README.md")];
    let listed = std::fs::read_dir(root().join("docs/src")).expect("the book");
    names.extend(
        listed
            .map(|e| e.expect("an entry").path())
            .filter(|p| p.extension().is_some_and(|e| e == "md")),
    );
    let mut known: Vec<String> = Vec::new();
    for name in names {
        let text = std::fs::read_to_string(&name).expect("UTF-8");
        for session in blocks(&text, "console").iter().flat_map(|b| b.lines()) {
            let Some(rest) = session.strip_prefix("$ stillpoint ") else {
                continue;
            };
            let command = rest
                .split_whitespace()
                .next()
                .unwrap_or_default()
                .to_owned();
            let (status, help) = run(&root(), &[command.as_str(), "--help"]);
            assert_eq!(status, Some(0), "{}: stillpoint {rest}", name.display());
            let options = rest.split(" # ").next().unwrap_or(rest).split_whitespace();
            for option in options.filter(|w| w.starts_with("--")) {
                let word = option.split('=').next().unwrap_or(option);
                assert!(
                    help.contains(word),
                    "{}: stillpoint {rest}: {word}",
                    name.display()
                );
            }
            known.push(command);
        }
    }
    assert!(known.len() > 20, "{}", known.len());
}

#[test]
fn a_wrong_answer_is_noticed() {
    let lines = |text: &str| -> Vec<String> { text.lines().map(str::to_owned).collect() };
    assert!(matches(
        &lines("a\n...\nd ..."),
        &["a", "b", "c", "d and more"]
    ));
    assert!(matches(&lines("a\n..."), &["a"]));
    assert!(!matches(&lines("a\nb"), &["a", "c"]));
    assert!(!matches(&lines("a\n...\nd"), &["a", "b", "c"]));
    assert!(!matches(&lines("a"), &["a", "b"]));
}
