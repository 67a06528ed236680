//! Every format for every shipped specification, machine and must-fail file; the structure of the formats that no tool here
//! reads.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use stillpoint_engine::subject::Task;
use stillpoint_harness::export::smv::smv;
use stillpoint_harness::export::tla::tla;
use stillpoint_harness::export::{btor2, json, murphi, promela};
use stillpoint_tests::peer::{has_system, load};
use stillpoint_tests::{files, specification_files};

/// Each system of the shipped specifications, machines and must-fail files.
fn tasks() -> Vec<Task> {
    let mut paths: Vec<PathBuf> = specification_files();
    paths.retain(|p| has_system(p));
    paths.extend(files("spec/machines", "toml"));
    paths.extend(files("tests/must-fail", "toml"));
    let tasks: Vec<Task> = paths.iter().flat_map(|p| load(p).tasks).collect();
    assert!(tasks.len() > 50, "{} systems only", tasks.len());
    tasks
}

/// The names in a text without its comments.
fn names(text: &str) -> impl Iterator<Item = &str> {
    let word = |c: char| !(c.is_ascii_alphanumeric() || c == '_');
    text.split(word)
        .filter(|w| w.starts_with(|c: char| c.is_ascii_alphabetic()))
}

fn without_comments(text: &str, mark: &str) -> String {
    let lines = text
        .lines()
        .map(|l| l.split(mark).next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

fn balanced(text: &str) -> bool {
    let mut depth = 0;
    for c in text.chars() {
        depth += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        if depth < 0 {
            return false;
        }
    }
    depth == 0
}

#[test]
fn every_format_is_there_for_every_system() {
    for task in tasks() {
        let name = &task.bound.system.name;
        let fail =
            |format: &str, e: &dyn std::fmt::Display| -> ! { panic!("{name}, {format}: {e}") };
        let (bound, title) = (&task.bound, &task.title);
        let texts = [
            promela::promela(bound, title)
                .unwrap_or_else(|e| fail("promela", &e))
                .text,
            murphi::murphi(bound, title).unwrap_or_else(|e| fail("murphi", &e)),
            smv(bound, title).unwrap_or_else(|e| fail("smv", &e)),
            btor2::btor2(bound, title, None).unwrap_or_else(|e| fail("btor2", &e)),
            tla(bound, title, "model")
                .unwrap_or_else(|e| fail("tla", &e))
                .module,
            json::json(bound).to_string(),
        ];
        for text in texts {
            assert!(text.contains(name.as_str()), "{name} stands at the top");
        }
    }
}

#[test]
fn smv_declares_and_assigns_each_variable_once() {
    for task in tasks() {
        let system = &task.bound.system.name;
        let text = smv(&task.bound, &task.title).unwrap_or_else(|e| panic!("{system}: {e}"));
        let text = without_comments(&text, "--");
        assert!(balanced(&text), "{system}: parentheses");
        let mut declared = BTreeSet::new();
        let mut assigned: BTreeMap<&str, usize> = BTreeMap::new();
        let mut section = "";
        for line in text.lines() {
            if !line.starts_with(' ') {
                section = line.split(' ').next().unwrap_or_default();
            }
            let Some((head, _)) = line.split_once(if section == "VAR" { " : " } else { " := " })
            else {
                continue;
            };
            match section {
                "VAR" | "DEFINE" => assert!(declared.insert(head.trim()), "{system}: {head} twice"),
                "ASSIGN" => *assigned.entry(head.trim()).or_default() += 1,
                "INVARSPEC" | "CTLSPEC" => {
                    let name = head.rsplit(' ').next().unwrap_or_default();
                    assert!(declared.insert(name), "{system}: {name} twice");
                }
                other => panic!("{system}: {other}"),
            }
        }
        for name in declared.iter().filter(|n| n.starts_with("s_")) {
            let count = |kind: &str| assigned.get(format!("{kind}({name})").as_str()).copied();
            assert_eq!(count("next"), Some(1), "{system}: next({name})");
            assert!(count("init").unwrap_or(0) <= 1, "{system}: init({name})");
        }
        let known = [
            "MODULE",
            "main",
            "VAR",
            "DEFINE",
            "ASSIGN",
            "INVARSPEC",
            "CTLSPEC",
            "NAME",
            "EF",
            "TRUE",
            "FALSE",
            "boolean",
            "init",
            "next",
            "mod",
        ];
        for name in names(&text) {
            assert!(
                declared.contains(name) || known.contains(&name),
                "{system}: {name}"
            );
        }
    }
}

#[test]
fn tla_declares_each_name_and_primes_each_variable_once() {
    for task in tasks() {
        let system = &task.bound.system.name;
        let made =
            tla(&task.bound, &task.title, "model").unwrap_or_else(|e| panic!("{system}: {e}"));
        let text = without_comments(&made.module, "\\*");
        assert!(balanced(&text), "{system}: parentheses");
        assert!(
            text.starts_with("---- MODULE model ----\n") && text.ends_with("====\n")
                || text.ends_with("====")
        );
        // Operators, and inside each its bound variables and local definitions.
        let known = [
            "MODULE",
            "model",
            "EXTENDS",
            "Integers",
            "VARIABLES",
            "LET",
            "IN",
            "IF",
            "THEN",
            "ELSE",
            "TRUE",
            "FALSE",
            "BOOLEAN",
            "in",
            "div",
            "E",
            "A",
        ];
        let mut global: BTreeSet<String> = known.iter().map(ToString::to_string).collect();
        let mut variables = BTreeSet::new();
        let mut local: BTreeSet<String> = BTreeSet::new();
        let mut primed = Vec::new();
        let mut in_variables = false;
        for line in text.lines() {
            let top = line.starts_with(|c: char| c.is_ascii_alphabetic());
            in_variables = line == "VARIABLES" || (in_variables && !top && !line.is_empty());
            if in_variables {
                variables.extend(
                    names(line)
                        .filter(|n| *n != "VARIABLES")
                        .map(ToOwned::to_owned),
                );
                global.extend(variables.iter().cloned());
                continue;
            }
            let defines = line
                .split_once(" == ")
                .map(|(h, _)| h)
                .or(line.strip_suffix(" =="));
            let mut head = defines
                .map(|h| h.trim().trim_start_matches("LET ").trim())
                .unwrap_or_default();
            if top {
                local.clear();
                let mut parts = names(head);
                let operator = parts.next().unwrap_or_default().to_owned();
                local.extend(parts.map(ToOwned::to_owned));
                assert!(
                    defines.is_none() || global.insert(operator.clone()),
                    "{system}: {operator} twice"
                );
                head = "";
            }
            if let Some(bound) = line
                .trim()
                .strip_prefix("\\E ")
                .or(line.trim().strip_prefix("\\A "))
            {
                head = bound.split(' ').next().unwrap_or_default();
            }
            for name in names(line).filter(|n| *n != head) {
                assert!(
                    local.contains(name) || global.contains(name),
                    "{system}: {name} in {line}"
                );
            }
            if !head.is_empty() {
                assert!(
                    !global.contains(head) && local.insert(head.to_owned()),
                    "{system}: {head} twice"
                );
            }
            if let Some((name, _)) = line.split_once("' = ") {
                primed.push(names(name).last().unwrap_or_default().to_owned());
            }
        }
        primed.sort();
        assert_eq!(
            primed,
            variables.into_iter().collect::<Vec<_>>(),
            "{system}: successors"
        );
        for name in made
            .config
            .lines()
            .filter_map(|l| l.split("INVARIANT ").nth(1))
        {
            assert!(
                global.contains(name),
                "{system}: the configuration names {name}"
            );
        }
    }
}
