//! Alarms, codes of STOP F and the list of the comparison are those of the manual's tables (S840D-ALARM-501, S840D-ALARM-711,
//! S840D-ALARM-733, S840D-KDV-501, S840D-KDV-508, S840D-KDV-510, S840D-KDV-511, S840D-KDV-515).

use std::collections::BTreeMap;

use stillpoint_monitors::kernel::{Cycles, Distance, Percent, Position, Speed};
use stillpoint_monitors::sinumerik::alarm::{Alarm, Class, Entry, Reaction, Response};
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::compare::list::{
    ITEMS, Item, Kind, Parameters, Rule, Snapshot, Tolerance, differs,
};
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_tests::root;
use toml::{Table, Value};

/// The entries of a list in a file of the family, by their number.
fn table(file: &str, list: &str, key: &str) -> BTreeMap<i64, Table> {
    let path = root().join("spec/families/sinumerik-840d").join(file);
    let text = std::fs::read_to_string(&path).expect("the table is part of the repository");
    let parsed: Table = text.parse().expect("the table is TOML");
    let entries = parsed[list].as_array().expect("a list").iter();
    entries
        .map(|entry| {
            let entry = entry.as_table().expect("a table").clone();
            (entry[key].as_integer().expect("a number"), entry)
        })
        .collect()
}

fn text<'a>(entry: &'a Table, key: &str) -> &'a str {
    entry.get(key).and_then(Value::as_str).unwrap_or("")
}

/// Compares one alarm of one channel with its entry.
fn compare(entry: &Entry, listed: &Table, channel: &str) {
    let number = entry.number;
    assert_eq!(text(listed, "channel"), channel, "{number}");

    let keywords: Vec<&str> = entry.reactions.iter().map(|r| r.keyword()).collect();
    let reaction = listed["reaction"].as_array().expect("a list");
    let reaction: Vec<&str> = reaction.iter().filter_map(Value::as_str).collect();
    assert_eq!(keywords, reaction, "{number}");

    let acknowledgement = text(listed, "acknowledgement");
    let class = acknowledgement
        .split(|c: char| c != '-' && !c.is_ascii_lowercase())
        .next();
    assert_eq!(
        class,
        Some(entry.acknowledgement.class.keyword()),
        "{number}"
    );
    assert_eq!(
        entry.acknowledgement.escalates,
        acknowledgement.contains("power-on if"),
        "{number}"
    );

    let response = text(listed, "stop_response");
    match entry.response {
        Response::None => assert!(response.starts_with("none"), "{number}: {response}"),
        Response::Fixed(level) => {
            let stop = format!("STOP {}", letter(level));
            assert!(response.contains(&stop), "{number}: {response}");
            assert!(!response.contains("per MD"), "{number}: {response}");
        }
        Response::Configured => assert!(response.contains("per MD"), "{number}: {response}"),
    }
}

fn letter(level: Level) -> char {
    match level {
        Level::A => 'A',
        Level::B => 'B',
        Level::C => 'C',
        Level::D => 'D',
        Level::E => 'E',
        Level::F => 'F',
        Level::None | Level::Test => panic!("no stop of an alarm"),
    }
}

#[test]
fn every_alarm_is_the_listed_one() {
    let listed = table("alarms.toml", "alarm", "number");
    for alarm in Alarm::ALL {
        let nck = alarm.nck();
        let entry = &listed[&i64::from(nck.number)];
        compare(&nck, entry, "nck");
        let counterpart = text(entry, "counterpart");
        match alarm.drive() {
            Some(drive) => {
                let entry = &listed[&i64::from(drive.number)];
                compare(&drive, entry, "drive");
                // The invalid parameter has many counterparts in the drive; the one here names it.
                if alarm == Alarm::InvalidParameter {
                    assert!(text(entry, "counterpart").starts_with("27033"));
                } else {
                    assert_eq!(counterpart, drive.number.to_string());
                    assert_eq!(text(entry, "counterpart"), nck.number.to_string());
                }
            }
            None => assert_eq!(counterpart, "", "{alarm:?}"),
        }
    }
}

#[test]
fn the_stop_alarms_are_titled_by_their_stop() {
    let listed = table("alarms.toml", "alarm", "number");
    for alarm in [
        Alarm::StopA,
        Alarm::StopB,
        Alarm::StopC,
        Alarm::StopD,
        Alarm::StopE,
    ] {
        let Response::Fixed(level) = alarm.nck().response else {
            panic!("{alarm:?} has a stop");
        };
        let title = format!("STOP {} activated", letter(level));
        assert_eq!(
            text(&listed[&i64::from(alarm.nck().number)], "title"),
            title
        );
        assert_eq!(alarm.nck().reactions.len() == 6, level >= Level::B);
        assert_eq!(
            alarm.nck().acknowledgement.class == Class::PowerOn,
            level >= Level::B
        );
    }
    // The keywords used are known to the table, each to at least one of these alarms.
    for reaction in Reaction::ALL {
        assert!(
            Alarm::ALL
                .iter()
                .any(|alarm| alarm.nck().reactions.contains(&reaction))
        );
    }
}

/// S840D-KDV-708, S840D-KDV-729/a. S840D-KDV-510 among them: the signals that are compared do not contain the selection of the gear ratio.
#[test]
fn every_code_is_a_listed_one_and_its_item_of_the_listed_kind() {
    let listed = table("stop-f-codes.toml", "code", "code");
    for number in 0..=u16::MAX {
        let Some(code) = Code::of(number) else {
            continue;
        };
        assert_eq!(code.number(), number);
        assert!(listed.contains_key(&i64::from(number)), "{number}");
    }
    for (number, entry) in &listed {
        let code = u16::try_from(*number).ok().and_then(Code::of);
        let item = code.and_then(Item::of);
        let expected = match text(entry, "kind") {
            "parameter" => Some((Kind::Static, Rule::Exact)),
            "actual-value" | "dynamic-limit" => Some((Kind::Dynamic, Rule::Tolerance)),
            "result-list" | "external-stop" | "sge" => Some((Kind::Dynamic, Rule::Exact)),
            _ => None,
        };
        assert_eq!(
            item.map(|item| (item.kind(), item.rule())),
            expected,
            "{number}"
        );
        if text(entry, "kind") == "sge" {
            assert!(!text(entry, "title").contains("ratio"), "{number}");
        }
        let with_tolerance = expected.is_some_and(|(_, rule)| rule == Rule::Tolerance);
        assert_eq!(
            with_tolerance,
            text(entry, "tolerance").contains("MD36942"),
            "{number}"
        );
        assert_eq!(
            code.is_some_and(Code::is_actual_value),
            with_tolerance,
            "{number}"
        );
    }
    let titled = [
        (Code::NONE, "no fault found in this channel"),
        (
            Code::RESULTS_1,
            "different state of SBH, SG or SE (result list 1)",
        ),
        (
            Code::RESULTS_2,
            "different state of SN or n<nx (result list 2)",
        ),
        (Code::POSITION, "safe actual values differ"),
        (
            Code::FUNCTION_ENABLE,
            "parameter mismatch 36901 SAFE_FUNCTION_ENABLE",
        ),
        (
            Code::STANDSTILL_TOLERANCE,
            "parameter mismatch 36930 SAFE_STANDSTILL_TOL",
        ),
        (Code::LIMITS, "upper limit SG1"),
        (Code::EXTERNAL_STOP, "active external stop request differs"),
        (Code::OVERRIDE, "SG correction factor SGEs differ"),
        (
            Code::FAULT_DELAY,
            "parameter mismatch 36955 SAFE_STOP_SWITCH_TIME_F",
        ),
        (Code::TOO_MANY_CHANGES, "too many SGE changes"),
        (Code::AGREEMENT_DIFFERS, "user agreement inconsistent"),
        (
            Code::AGREEMENT_POSITION,
            "reference comparison tolerance exceeded",
        ),
        (
            Code::AGREEMENT_PLAUSIBILITY,
            "user agreement plausibility violated",
        ),
        (
            Code::ALREADY_CANCELLED,
            "test stop impossible: pulses already cancelled",
        ),
        (Code::TEST_FAILED, "test stop: pulses not cancelled in time"),
        (
            Code::EXTERNAL_TEST_FAILED,
            "external test stop: pulses not cancelled in time",
        ),
    ];
    for (code, title) in titled {
        assert_eq!(text(&listed[&i64::from(code.number())], "title"), title);
    }
}

/// A machine datum as the table of codes names it, and its alteration in the parameters of a channel.
type Alteration = (&'static str, fn(&mut Parameters));

const TWO: Cycles = Cycles::new(2);

/// Every machine datum that is compared; of the arrays every element.
const ALTERATIONS: &[Alteration] = &[
    ("SAFE_FUNCTION_ENABLE", |p| p.function_enable = 1),
    ("SAFE_VELO_LIMIT[0]", |p| p.velo_limit[0] = Speed(1)),
    ("SAFE_VELO_LIMIT[1]", |p| p.velo_limit[1] = Speed(1)),
    ("SAFE_VELO_LIMIT[2]", |p| p.velo_limit[2] = Speed(1)),
    ("SAFE_VELO_LIMIT[3]", |p| p.velo_limit[3] = Speed(1)),
    ("SAFE_STANDSTILL_TOL", |p| p.standstill_tol = Distance(1)),
    ("SAFE_POS_LIMIT_PLUS[0]", |p| {
        p.pos_limit_plus[0] = Position(1)
    }),
    ("SAFE_POS_LIMIT_PLUS[1]", |p| {
        p.pos_limit_plus[1] = Position(1)
    }),
    ("SAFE_POS_LIMIT_MINUS[0]", |p| {
        p.pos_limit_minus[0] = Position(1)
    }),
    ("SAFE_POS_LIMIT_MINUS[1]", |p| {
        p.pos_limit_minus[1] = Position(1)
    }),
    ("SAFE_CAM_POS_PLUS[0]", |p| p.cams[0].plus = Position(1)),
    ("SAFE_CAM_POS_PLUS[1]", |p| p.cams[1].plus = Position(1)),
    ("SAFE_CAM_POS_PLUS[2]", |p| p.cams[2].plus = Position(1)),
    ("SAFE_CAM_POS_PLUS[3]", |p| p.cams[3].plus = Position(1)),
    ("SAFE_CAM_POS_MINUS[0]", |p| p.cams[0].minus = Position(1)),
    ("SAFE_CAM_POS_MINUS[1]", |p| p.cams[1].minus = Position(1)),
    ("SAFE_CAM_POS_MINUS[2]", |p| p.cams[2].minus = Position(1)),
    ("SAFE_CAM_POS_MINUS[3]", |p| p.cams[3].minus = Position(1)),
    ("SAFE_CAM_TOL", |p| p.cam_tol = Distance(1)),
    ("SAFE_POS_TOL", |p| p.pos_tol = Distance(1)),
    ("SAFE_SLIP_VELO_TOL", |p| p.slip_velo_tol = Distance(1)),
    ("SAFE_REFP_POS_TOL", |p| p.refp_pos_tol = Distance(1)),
    ("SAFE_VELO_SWITCH_DELAY", |p| p.velo_switch_delay = TWO),
    ("SAFE_MODE_SWITCH_TIME", |p| p.mode_switch_time = TWO),
    ("SAFE_PULSE_DISABLE_DELAY", |p| p.pulse_disable_delay = TWO),
    ("SAFE_PULSE_DIS_CHECK_TIME", |p| {
        p.pulse_dis_check_time = TWO
    }),
    ("SAFE_STOP_SWITCH_TIME_C", |p| p.stop_switch_time[0] = TWO),
    ("SAFE_STOP_SWITCH_TIME_D", |p| p.stop_switch_time[1] = TWO),
    ("SAFE_STOP_SWITCH_TIME_E", |p| p.stop_switch_time[2] = TWO),
    ("SAFE_VELO_STOP_MODE", |p| p.velo_stop_mode = 1),
    ("SAFE_POS_STOP_MODE", |p| p.pos_stop_mode = 1),
    ("SAFE_STANDSTILL_VELO_TOL", |p| {
        p.standstill_velo_tol = Speed(1)
    }),
    ("SAFE_VELO_OVR_FACTOR[0]", |p| {
        p.velo_ovr_factor[0] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[1]", |p| {
        p.velo_ovr_factor[1] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[2]", |p| {
        p.velo_ovr_factor[2] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[3]", |p| {
        p.velo_ovr_factor[3] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[4]", |p| {
        p.velo_ovr_factor[4] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[5]", |p| {
        p.velo_ovr_factor[5] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[6]", |p| {
        p.velo_ovr_factor[6] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[7]", |p| {
        p.velo_ovr_factor[7] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[8]", |p| {
        p.velo_ovr_factor[8] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[9]", |p| {
        p.velo_ovr_factor[9] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[10]", |p| {
        p.velo_ovr_factor[10] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[11]", |p| {
        p.velo_ovr_factor[11] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[12]", |p| {
        p.velo_ovr_factor[12] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[13]", |p| {
        p.velo_ovr_factor[13] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[14]", |p| {
        p.velo_ovr_factor[14] = Percent::WHOLE
    }),
    ("SAFE_VELO_OVR_FACTOR[15]", |p| {
        p.velo_ovr_factor[15] = Percent::WHOLE
    }),
    ("SAFE_VELO_X", |p| p.velo_x = Speed(1)),
    ("SAFE_VELO_STOP_REACTION[0]", |p| {
        p.velo_stop_reaction[0] = 1
    }),
    ("SAFE_VELO_STOP_REACTION[1]", |p| {
        p.velo_stop_reaction[1] = 1
    }),
    ("SAFE_VELO_STOP_REACTION[2]", |p| {
        p.velo_stop_reaction[2] = 1
    }),
    ("SAFE_VELO_STOP_REACTION[3]", |p| {
        p.velo_stop_reaction[3] = 1
    }),
    ("SAFE_MODULO_RANGE", |p| p.modulo_range = Distance(1)),
    ("SAFE_STOP_VELO_TOL", |p| p.stop_velo_tol = Speed(1)),
    ("SAFE_ACCEPTANCE_TST_TIMEOUT", |p| {
        p.acceptance_tst_timeout = TWO
    }),
    ("SAFE_STOP_SWITCH_TIME_F", |p| p.stop_switch_time_f = TWO),
    ("SAFE_PULSE_DIS_TIME_BUSFAIL", |p| {
        p.pulse_dis_time_busfail = TWO
    }),
    ("SAFE_ENC_FREQ_LIMIT", |p| p.enc_freq_limit = 1),
];

/// S840D-PARAM-001, S840D-MDBUS-005, S840D-MDCHK-032/b, S840D-KDV-707, S840D-KDV-729/a. S840D-KDV-511 among them: the encoder limit frequency is compared.
#[test]
fn an_altered_machine_datum_is_seen_under_the_codes_that_name_it() {
    let listed = table("stop-f-codes.toml", "code", "code");
    let own = Snapshot::default();
    let mut named = 0;
    for (datum, alter) in ALTERATIONS {
        let mut other = own;
        alter(&mut other.parameters);
        let seen: Vec<i64> = ITEMS
            .into_iter()
            .filter(|item| differs(*item, &own, &other, Tolerance::Position(Distance(0))))
            .map(|item| item.code().number().into())
            .collect();
        let expected: Vec<i64> = listed
            .iter()
            .filter(|(_, entry)| text(entry, "kind") == "parameter")
            .filter(|(_, entry)| text(entry, "nck_md").contains(datum))
            .map(|(number, _)| *number)
            .collect();
        assert_eq!(seen, expected, "{datum}");
        named += seen.len();
    }
    // Every parameter code is met: once, or twice where it names two machine data.
    let parameters = listed
        .values()
        .filter(|entry| text(entry, "kind") == "parameter");
    let wanted: usize = parameters
        .map(|entry| text(entry, "nck_md").matches("SAFE_").count())
        .sum();
    assert_eq!(named, wanted);
}
