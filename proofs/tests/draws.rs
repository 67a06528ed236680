//! Draws that are written by hand leave nothing out but what this table says: see `complete`.

use rayon::prelude::*;
use stillpoint_proofs::complete::{Found, Tied};
use stillpoint_proofs::inventory;

/// Numbers whose values depend on each other in the enumeration: harness, parts (0 in a domain without parts), names, why.
const TIED: &[(&str, &[u32], &str, &str)] = &[
    (
        "hfs_speed_contract",
        &[0],
        "limits inputs.state left inputs.speed",
        "speeds around the limit in force",
    ),
    (
        "selection_contract",
        &[0],
        "factors",
        "two factors: what is chosen at index 0 and what elsewhere",
    ),
    (
        "results_contract",
        &[0],
        "config.cams",
        "every pattern of the first two cams, or all on",
    ),
    (
        "results_contract",
        &[0],
        "inputs.cams",
        "every pattern of the first two cams, or all on",
    ),
    (
        "channel_contract",
        &[1, 2, 3, 4, 5],
        "config",
        "all times are equal",
    ),
    (
        "channel_contract",
        &[2, 4, 5],
        "state.stop",
        "a stop at its beginning or at its end",
    ),
    (
        "hfs_channel_contract",
        &[1],
        "left",
        "the limits of all other modes, or of none",
    ),
    (
        "hfs_channel_contract",
        &[1, 3],
        "peer",
        "a channel that could not read a field lets nothing start",
    ),
];

/// The rows of the table for a harness but the one of this place.
fn rows(id: &str, without: Option<usize>) -> Vec<Tied<'static>> {
    let rows = TIED.iter().enumerate();
    let rows = rows.filter(|(place, row)| row.0 == id && without != Some(*place));
    rows.flat_map(|(_, (_, parts, name, _))| parts.iter().map(move |part| (*part, *name)))
        .collect()
}

/// What is wrong with the draw of a harness or with its rows: they say what it leaves out, and each of them is needed.
fn wrong(entry: &inventory::Entry) -> Vec<String> {
    let Some(by_hand) = entry.by_hand else {
        return Vec::new();
    };
    let own = || (TIED.iter().enumerate()).filter(|(_, row)| row.0 == entry.id);
    let lists: Vec<_> = std::iter::once(None)
        .chain(own().map(|(place, _)| Some(place)))
        .map(|without| rows(entry.id, without))
        .collect();
    let mut found = by_hand(&lists).into_iter();
    let Found {
        steps,
        missed,
        example,
    } = found.next().unwrap_or_default();
    let id = entry.id;
    let mut wrong = Vec::new();
    if steps < 100 {
        wrong.push(format!("{id}: only {steps} combinations are steps"));
    }
    if missed > 0 {
        wrong.push(format!(
            "{id}: {missed} of {steps} steps are never drawn: {example}"
        ));
    }
    for ((_, row), found) in own().zip(found) {
        if found.missed == 0 {
            wrong.push(format!(
                "{id}, parts {:?}: {} leaves nothing out",
                row.1, row.2
            ));
        }
    }
    wrong
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn draws_by_hand_leave_out_what_the_table_says_and_nothing_else() {
        let entries: Vec<_> = inventory::all().collect();
        let unknown = (TIED.iter())
            .filter(|row| {
                !(entries.iter()).any(|entry| entry.id == row.0 && entry.by_hand.is_some())
            })
            .map(|row| format!("{} has no draw by hand", row.0));
        let wrong: Vec<String> = (entries.par_iter())
            .flat_map_iter(|entry| wrong(entry))
            .chain(unknown.collect::<Vec<_>>())
            .collect();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}
