//! What the machine file guarantees, as a part of the protocol: the verdicts of the check, and what is to be measured.

use std::path::Path;

use serde_json::Value;
use stillpoint_engine::check::{Settings, check};
use stillpoint_engine::subject::{self, Readings};
use stillpoint_lang::diag::Diagnostics;
use stillpoint_machine::{Machine, Run};
use stillpoint_model::Verdict;
use stillpoint_show::document::{Block, Inline};

use crate::guarantees::answers;
use crate::report;

/// The answers to the guarantees of a machine.
#[derive(Debug)]
pub struct Decided {
    /// Each of them holds.
    pub hold: bool,
    blocks: Vec<Block>,
    /// As in the report of the check.
    pub json: Vec<Value>,
}

/// Why there are none.
#[derive(Debug)]
pub enum Undecided {
    /// Something is wrong with the input.
    Input(Diagnostics),
    /// An exploration failed: one sentence.
    Other(String),
}

/// Explores what decides the guarantees of a machine, and nothing else.
///
/// # Errors
/// [`Undecided`].
pub fn decide(path: &Path, machine: &Machine) -> Result<Decided, Undecided> {
    let runs: Vec<Run> = (machine.runs.iter())
        .filter(|run| run.guarantee.is_some())
        .cloned()
        .collect();
    let mut subject = subject::of_runs(path, machine.clone(), &runs, &Readings::new())
        .map_err(Undecided::Input)?;
    let checked = check(&mut subject, &Settings::default(), &mut |_| Box::new(()))
        .map_err(|(title, e)| Undecided::Other(format!("{title}: {e}")))?;
    let all = answers(&subject, &checked);
    Ok(Decided {
        hold: all.iter().all(|answer| answer.verdict == Verdict::Holds),
        blocks: match all.is_empty() {
            true => Vec::new(),
            false => report::guaranteed(&subject, &checked),
        },
        json: report::guarantees(&subject, &checked),
    })
}

/// What is guaranteed, with a place for what was measured; the verdicts where they were asked for.
pub(super) fn section(machine: &Machine, decided: Option<&Decided>) -> Option<Block> {
    let rows = machine.guarantees.iter().map(|guarantee| {
        vec![
            vec![Inline::Code(guarantee.name.clone())],
            vec![Inline::text(&guarantee.text)],
            vec![Inline::Blank(10)],
            vec![Inline::Blank(5)],
        ]
    });
    let heads = ["Guarantee", "In plain words", "Measured", "OK"];
    let mut blocks = vec![Block::Paragraph(vec![Inline::text(match decided {
        Some(_) => {
            "What was explored of each guarantee stands below. It is computed from the values of this configuration and, where there is one, from its program; whether wiring, drives and mechanics are as assumed is measured on the machine."
        }
        None => {
            "Whether these values and this program keep the guarantees is told by stillpoint check, and here with --guarantees; whether wiring, drives and mechanics are as assumed is measured on the machine."
        }
    })])];
    blocks.push(Block::table(&heads, rows));
    blocks.extend(decided.iter().flat_map(|d| d.blocks.clone()));
    (!machine.guarantees.is_empty()).then(|| Block::Section {
        title: "What this machine guarantees".to_owned(),
        anchor: "guarantees".to_owned(),
        blocks,
    })
}
