//! Draws that are written by hand leave nothing out but what this table says: see `complete`.

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

/// What the draw of a harness leaves out, with the rows of the table but the one of this place.
fn found(entry: &inventory::Entry, without: Option<usize>) -> Option<Found> {
    let rows = TIED.iter().enumerate();
    let rows =
        rows.filter(|(place, (id, ..))| *id == entry.id && without.is_none_or(|row| row != *place));
    let tied: Vec<Tied> = rows
        .flat_map(|(_, (_, parts, name, _))| parts.iter().map(move |part| (*part, *name)))
        .collect();
    Some((entry.by_hand?)(&tied))
}

#[test]
fn draws_by_hand_leave_out_only_what_the_table_says() {
    let mut wrong = Vec::new();
    for entry in inventory::all() {
        let Some(found) = found(entry, None) else {
            continue;
        };
        println!("{}: {} combinations are steps", entry.id, found.steps);
        if found.steps < 100 {
            wrong.push(format!(
                "{}: only {} combinations are steps",
                entry.id, found.steps
            ));
        }
        if found.missed > 0 {
            wrong.push(format!(
                "{}: {} of {} steps are never drawn: {}",
                entry.id, found.missed, found.steps, found.example
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_row_of_the_table_is_needed() {
    for (place, (id, parts, name, _)) in TIED.iter().enumerate() {
        let entry = inventory::all().find(|entry| entry.id == *id);
        let found = entry.and_then(|entry| found(entry, Some(place)));
        let found = found.unwrap_or_else(|| panic!("{id} has no draw by hand"));
        assert!(
            found.missed > 0,
            "{id}, parts {parts:?}: {name} leaves nothing out"
        );
    }
}
