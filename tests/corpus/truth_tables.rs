//! What the input signals of an axis select, and what its output signals show, as the truth tables of the manual have it.

use std::collections::BTreeSet;

use stillpoint_monitors::kernel::{Cycles, Position, Speed};
use stillpoint_monitors::sinumerik::gear::GearIndex;
use stillpoint_monitors::sinumerik::results::Field;
use stillpoint_monitors::sinumerik::selection::{
    Config, FactorIndex, Inputs, Monitor, Monitored, Stage,
};
use stillpoint_monitors::sinumerik::{limit_switch, selection};
use stillpoint_tests::root;
use toml::{Table, Value};

/// The rows of a truth table: the inputs, none where either level does, and what they mean.
fn rows(id: &str) -> Vec<(Vec<Option<bool>>, String)> {
    let path = root().join("spec/families/sinumerik-840d/signals.toml");
    let text = std::fs::read_to_string(&path).expect("the table is part of the repository");
    let table: Table = text.parse().expect("the table is TOML");
    let tables = table["truth_table"].as_array().expect("a list");
    let one = tables.iter().find(|t| t["id"].as_str() == Some(id));
    let rows = one.expect("the truth table")["rows"].as_array();
    let cell = |text: &str| match text {
        "x" => None,
        other => Some(other == "1"),
    };
    let row = |row: &Value| {
        let inputs = row["in"].as_str().expect("a text").split(',').map(cell);
        (
            inputs.collect(),
            row["out"].as_str().expect("a text").to_owned(),
        )
    };
    rows.expect("rows").iter().map(row).collect()
}

/// The meaning of a combination of levels: that of the one row it fits.
fn meaning<'a>(rows: &'a [(Vec<Option<bool>>, String)], levels: &[bool]) -> Option<&'a str> {
    let fits = |(cells, _): &&(Vec<Option<bool>>, String)| {
        let both = cells.iter().zip(levels);
        cells.len() == levels.len() && both.clone().all(|(c, l)| c.is_none_or(|c| c == *l))
    };
    let mut found = rows.iter().filter(fits);
    let (_, meaning) = found.next()?;
    assert!(found.next().is_none(), "{levels:?} stands twice");
    Some(meaning)
}

/// Limits that tell the stages apart.
fn config() -> Config {
    let limits = [Speed(10), Speed(20), Speed(30), Speed(40)];
    Config::new(true, Cycles::ZERO, limits).expect("plausible")
}

/// Both levels of each of `count` signals.
fn levels(count: usize) -> impl Iterator<Item = Vec<bool>> {
    (0..1 << count).map(move |bits: u32| (0..count).map(|k| bits >> k & 1 == 1).collect())
}

fn select(sge_sbh_sg: bool, sge_sbh: bool, sg_select: Stage) -> selection::Outputs {
    Monitor::new(config()).step(&Inputs {
        sge_sbh_sg,
        sge_sbh,
        sg_select,
        ..Inputs::default()
    })
}

/// S840D-SIGNAL-003: table 6-6.
#[test]
fn sbh_and_sg_are_selected_as_table_6_6_says() {
    let rows = rows("SBH_SG_SELECT");
    for signals in levels(2) {
        let expected = match select(signals[0], signals[1], Stage::Sg1).monitored {
            Monitored::Nothing => "SBH and SG deselected",
            Monitored::Standstill => "SBH selected",
            Monitored::Speed => "SG selected",
        };
        assert_eq!(meaning(&rows, &signals), Some(expected), "{signals:?}");
    }
}

/// S840D-SIGNAL-004: table 6-7.
#[test]
fn the_stage_is_selected_as_table_6_7_says() {
    let rows = rows("SG_SELECT");
    for bits in levels(2) {
        let outputs = select(false, true, Stage::from_bits(bits[0], bits[1]));
        let stage = format!("SG{}", outputs.limit.0 / 10);
        assert_eq!(meaning(&rows, &bits), Some(stage.as_str()), "{bits:?}");
    }
}

/// S840D-SIGNAL-005: table 6-8.
#[test]
fn the_gear_stage_is_selected_as_table_6_8_says() {
    let rows = rows("GEAR_SELECT");
    for bits in levels(3) {
        let stage = GearIndex::from_bits(bits[0], bits[1], bits[2]).get() + 1;
        let row = meaning(&rows, &bits).expect("every combination stands there");
        let number = row.trim_start_matches("stage ").split(' ').next();
        assert_eq!(number, Some(stage.to_string().as_str()), "{bits:?}");
    }
}

/// S840D-SIGNAL-006: level 0 selects SE1, level 1 SE2.
#[test]
fn the_pair_of_limit_positions_is_selected_by_its_signal() {
    let rows = rows("SE_SELECT");
    let ends = |positions: [i32; 2]| positions.map(Position);
    let config =
        limit_switch::Config::new(true, ends([10, 20]), ends([-10, -20]), 2).expect("plausible");
    for select in [false, true] {
        let last = (0..30).take_while(|position| {
            let inputs = limit_switch::Inputs {
                active: true,
                select,
                position: Position(*position),
            };
            !limit_switch::Monitor::new(config).step(&inputs).upper
        });
        let pair = format!("SE{}", last.count() / 10);
        assert_eq!(meaning(&rows, &[select]), Some(pair.as_str()));
    }
}

/// S840D-SIGNAL-007: the four bits give the selections 0 to 15, bit 3 the highest.
#[test]
fn the_override_is_selected_by_its_four_bits() {
    for (number, bits) in (0_u8..).zip(levels(4)) {
        let index = FactorIndex::from_bits(bits[3], bits[2], bits[1], bits[0]);
        assert_eq!(index.get(), number);
    }
}

/// S840D-SIGNAL-017, S840D-SIGNAL-016: table 6-9. Whatever is selected, the four signals together are one of its rows, that of
/// what is monitored, and each of its rows is met.
#[test]
fn what_is_monitored_is_shown_as_table_6_9_says() {
    let rows = rows("SG_ACTIVE");
    let limits = [Speed(10), Speed(20), Speed(30), Speed(40)];
    let config = Config::new(true, Cycles::new(2), limits).expect("plausible");
    let mut met = BTreeSet::new();
    let every: Vec<Inputs> = levels(5)
        .map(|l| Inputs {
            sge_sbh_sg: l[0],
            sge_sbh: l[1],
            sg_select: Stage::from_bits(l[2], l[3]),
            sbh_internal: l[4],
            ..Inputs::default()
        })
        .collect();
    for first in &every {
        for second in &every {
            for third in &every {
                let mut monitor = Monitor::new(config);
                let _ = (monitor.step(first), monitor.step(second));
                let out = monitor.step(third);
                let stage = out.sga_sg.index();
                let shown = [
                    stage & 2 == 2,
                    stage & 1 == 1,
                    out.sga_active,
                    out.sga_sbh_active,
                ];
                let expected = match out.monitored {
                    Monitored::Nothing => "neither SBH nor SG active".to_owned(),
                    Monitored::Standstill => "SBH active".to_owned(),
                    Monitored::Speed => format!("SG{} limit active", out.limit.0 / 10),
                };
                assert_eq!(meaning(&rows, &shown), Some(expected.as_str()));
                met.insert(expected);
            }
        }
    }
    assert_eq!(met.len(), rows.len(), "{met:?}");
}

/// S840D-PARAM-029: the two bits of a function in the result lists.
#[test]
fn a_result_has_the_two_bits_of_the_lists() {
    let rows = rows("RESULT_LIST_STATE");
    for (field, expected) in [
        (Field::NotSelected, "function not selected"),
        (Field::Within, "selected, no error"),
        (Field::Below, "selected, lower limit violated"),
        (Field::Above, "selected, upper limit violated"),
    ] {
        let bits = field.bits();
        assert_eq!(
            meaning(&rows, &[bits & 2 == 2, bits & 1 == 1]),
            Some(expected)
        );
    }
}
