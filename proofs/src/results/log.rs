//! Reads what `cargo kani` prints, in its regular format: the terse one does not tell which solver has answered.

use std::collections::BTreeMap;

use super::{Answer, LIMIT_SECONDS, Verdict};

/// The answers in the log of a run, by harness. A harness that was begun and has no answer is left out.
pub fn answers(log: &str) -> BTreeMap<String, Answer> {
    let mut parts: BTreeMap<String, Vec<Answer>> = BTreeMap::new();
    let mut harness = None;
    let mut block = String::new();
    for line in log.lines().chain(["Checking harness end..."]) {
        let begins = line.strip_prefix("Checking harness ");
        let Some(path) = begins.and_then(|rest| rest.strip_suffix("...")) else {
            block.push_str(line);
            block.push('\n');
            continue;
        };
        if let Some((name, answer)) = harness.take().zip(answer(&block)) {
            parts.entry(name).or_default().push(answer);
        }
        // The last but one part of the path is the entry, the last one its part.
        let mut names = path.rsplit("::").skip(1);
        harness = names.next().map(str::to_owned);
        block.clear();
    }
    let joined = parts
        .into_iter()
        .map(|(name, parts)| (name, joined(&parts)));
    joined.collect()
}

/// The answer of an entry from those of its parts: it holds if all of them do and every cover was met.
fn joined(parts: &[Answer]) -> Answer {
    let sum = |number: fn(&Answer) -> u64| parts.iter().map(number).sum();
    // Every part of a contract lists all covers, and meets its own.
    let met = sum(|part| part.met);
    let covers = parts.iter().map(|part| part.covers).max().unwrap_or(0);
    let fails = parts
        .iter()
        .find(|part| matches!(part.verdict, Verdict::Fails(_)));
    let late = parts.iter().find(|part| part.verdict == Verdict::NoAnswer);
    Answer {
        verdict: match fails.or(late) {
            Some(part) => part.verdict.clone(),
            None if met < covers || covers == 0 => Verdict::Vacuous,
            None => Verdict::Holds,
        },
        seconds: parts.iter().map(|part| part.seconds).sum(),
        slowest: parts.iter().map(|part| part.seconds).fold(0.0, f64::max),
        parts: parts.len() as u64,
        checks: sum(|part| part.checks),
        met,
        covers,
        // The same for every part, since it is asked for once.
        solver: parts
            .first()
            .map_or_else(String::new, |part| part.solver.clone()),
    }
}

fn answer(block: &str) -> Option<Answer> {
    let line = |prefix: &str| block.lines().find_map(|line| line.strip_prefix(prefix));
    if line("CBMC timed out").is_some() {
        return Some(Answer {
            verdict: Verdict::NoAnswer,
            seconds: f64::from(LIMIT_SECONDS),
            slowest: f64::from(LIMIT_SECONDS),
            parts: 1,
            checks: 0,
            met: 0,
            covers: 0,
            solver: solver(block),
        });
    }
    let verdict = line("VERIFICATION:- ")?;
    let seconds = line("Verification Time: ")?.strip_suffix('s')?;
    let seconds = seconds.parse().ok()?;
    let (_, checks) = counts(block, " failed")?;
    let (met, covers) = counts(block, " cover properties satisfied").unwrap_or((0, 0));
    // Of an operation that CBMC does not know (an order of truth values is one) it takes any result.
    let ignored = line("warning: ignoring ");
    Some(Answer {
        verdict: if let Some(operation) = ignored {
            Verdict::Fails(format!("CBMC ignores {operation}"))
        } else if verdict != "SUCCESSFUL" {
            let check = line("Failed Checks: ").unwrap_or("no check named");
            Verdict::Fails(check.to_owned())
        } else {
            Verdict::Holds
        },
        seconds,
        slowest: seconds,
        parts: 1,
        checks,
        met,
        covers,
        solver: solver(block),
    })
}

/// The solver of `Solving with MiniSAT 2.2.1 with simplifier` and the like, in small letters. Nothing for an external one, which
/// CBMC does not name.
fn solver(block: &str) -> String {
    let named = block
        .lines()
        .find_map(|line| line.strip_prefix("Solving with "))
        .filter(|rest| !rest.starts_with("External"))
        .and_then(|rest| rest.split(' ').next());
    named.unwrap_or_default().to_lowercase()
}

/// The numbers of ` ** 2 of 5 failed` and the like.
fn counts(block: &str, what: &str) -> Option<(u64, u64)> {
    block.lines().find_map(|line| {
        let (some, rest) = line.strip_prefix(" ** ")?.split_once(" of ")?;
        let (all, rest) = rest.split_at_checked(rest.find(|c: char| !c.is_ascii_digit())?)?;
        rest.starts_with(what)
            .then(|| Some((some.parse().ok()?, all.parse().ok()?)))?
    })
}
