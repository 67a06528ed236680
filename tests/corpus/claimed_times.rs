//! The time that a guarantee of a SINAMICS S120 prints: it has every summand of Tables 8-1 to 8-9 of its control path, and it is the least that is kept.
//!
//! The summands are added up here by hand, from the column "a fault is present".

use stillpoint_engine::check::Settings;
use stillpoint_harness::guarantees::answers;
use stillpoint_machine::{self as machine, families};
use stillpoint_model::Verdict;
use stillpoint_tests::guarantees::decided;
use stillpoint_tests::root;

/// p9500, in milliseconds.
const CYCLE: u64 = 12;

/// A drive and the door in front of it. Values differ from each other and from their defaults, so that a summand that is missing shows.
struct Drive {
    name: &'static str,
    /// From where it is selected: what `[control]` says of that, and what the axis does.
    path: (&'static str, &'static str),
    /// What else the axis has.
    axis: &'static [&'static str],
    door: &'static str,
    /// From the contact of the door to the torque, in milliseconds.
    summands: &'static [u64],
}

const SIGNAL: u64 = 50;
const F_WD_TIME: u64 = 150;
/// t_E with p9651 = 60 ms or p10017 = 60 ms, and p0799 = 4 ms.
const FILTERED: u64 = 65;
const P10017: u64 = 60;
/// SLS is violated while the drive starts: with p9587 and p9586.
const AT_START: u64 = 9 * CYCLE / 2 + 4 + 190 + 170 + 32;

const TERMINALS: (&str, &str) = ("", "p9601 = \"1\"\np9651 = \"60 ms\"");
const BASIC_BUS: (&str, &str) = (
    "F_WD_Time = \"150 ms\"",
    "p9601 = \"8\"\np9610 = 100\np9810 = 100\np9611 = \"30\"\np60022 = \"30\"",
);
const BASIC_TM54F: (&str, &str) = (
    "inputs = \"TM54F\"\np10000 = \"4 ms\"\np10017 = \"60 ms\"",
    "p9601 = \"40\"\np10011 = 1",
);
const BUS: (&str, &str) = (
    "F_WD_Time = \"150 ms\"",
    "p9601 = \"C\"\np9610 = 100\np9810 = 100\np9611 = \"31\"\np60022 = \"31\"",
);
const TM54F: (&str, &str) = (
    "inputs = \"TM54F\"\np10006 = 10\np10017 = \"60 ms\"",
    "p9601 = \"4\"\np10011 = 1",
);
const F_DI: (&str, &str) = ("inputs = \"CU310-2\"\np10017 = \"60 ms\"", "p9601 = \"4\"");

const NOTHING_ELSE: &str = "functions = []";
const SS1: &str = "p9652 = \"300 ms\"";
const BRAKE: &str = "functions = [\"SBC\"]\np1215 = true\np1217 = \"70 ms\"";
const MONITORED: &str = "\
functions = [\"motion monitoring\"]
p9556 = \"210 ms\"
p9551 = \"110 ms\"
p9552 = \"130 ms\"
p9560 = \"50 mm/min\"
p9531 = [\"2000 mm/min\", \"5000 mm/min\", \"9000 mm/min\", \"9000 mm/min\"]";
const ENCODERLESS: &str = "\
p9506 = \"no encoder, SAM\"
p9511 = \"125 us\"
p9586 = \"170 ms\"
p9587 = \"190 ms\"
p9563 = [\"STOP B\", \"STOP B\", \"STOP B\", \"STOP B\"]";

const DRIVES: [Drive; 12] = [
    Drive {
        name: "Table 8-1, SS1",
        path: TERMINALS,
        axis: &[NOTHING_ELSE, SS1],
        door: "SS1",
        summands: &[SIGNAL, 4 * 4 + 2 + FILTERED, 300],
    },
    Drive {
        name: "Table 8-1, STO",
        path: TERMINALS,
        axis: &[NOTHING_ELSE],
        door: "STO",
        summands: &[SIGNAL, 4 * 4 + 2 + FILTERED],
    },
    Drive {
        name: "Table 8-1, SBC",
        path: TERMINALS,
        axis: &[BRAKE, SS1],
        door: "SS1",
        summands: &[SIGNAL, 8 * 4 + FILTERED, 300, 70],
    },
    Drive {
        name: "Table 8-2, SS1",
        path: BASIC_BUS,
        axis: &[NOTHING_ELSE, SS1],
        door: "SS1",
        summands: &[SIGNAL, F_WD_TIME, 5 * 4 + 2 + 4, 300],
    },
    Drive {
        name: "Table 8-3, SS1",
        path: BASIC_TM54F,
        axis: &[NOTHING_ELSE, SS1],
        door: "SS1",
        summands: &[SIGNAL, 3 * 4 + P10017 + 4, 300],
    },
    Drive {
        name: "Table 8-4, SS1",
        path: BUS,
        axis: &[MONITORED],
        door: "SS1",
        summands: &[SIGNAL, F_WD_TIME, 5 * CYCLE + 2 * 4 + 4, 210],
    },
    Drive {
        name: "Table 8-4, SLS and SOS",
        path: BUS,
        axis: &[MONITORED],
        door: "SLS1",
        // SLS is there after p9551, its STOP C ends in SOS, whose STOP B ends without torque; t_ACT = 1 ms.
        summands: &[
            SIGNAL,
            F_WD_TIME,
            5 * CYCLE + 2 * 4 + 4,
            110,
            7 * CYCLE / 2 + 2 + 1,
            130,
            3 * CYCLE + 2 + 1,
            210,
        ],
    },
    Drive {
        name: "Table 8-5, SS1",
        path: TM54F,
        axis: &[MONITORED],
        door: "SS1",
        summands: &[SIGNAL, 4 * CYCLE + 2 * 4 + P10017 + 1, 210],
    },
    Drive {
        name: "Table 8-6, SS1",
        path: F_DI,
        axis: &[MONITORED],
        door: "SS1",
        summands: &[SIGNAL, 4 * CYCLE + 2 * 4 + FILTERED, 210],
    },
    Drive {
        name: "Table 8-7, SLS in the start phase",
        path: BUS,
        axis: &[MONITORED, ENCODERLESS],
        door: "SLS1",
        summands: &[SIGNAL, F_WD_TIME, 5 * CYCLE + 2 * 4 + 4, 110, AT_START, 210],
    },
    Drive {
        name: "Table 8-8, SLS in the start phase",
        path: F_DI,
        axis: &[MONITORED, ENCODERLESS],
        door: "SLS1",
        summands: &[SIGNAL, 4 * CYCLE + 2 * 4 + FILTERED, 110, AT_START, 210],
    },
    Drive {
        name: "Table 8-9, SLS in the start phase",
        path: TM54F,
        axis: &[MONITORED, ENCODERLESS],
        door: "SLS1",
        summands: &[SIGNAL, 4 * CYCLE + 2 * 4 + P10017 + 1, 110, AT_START, 210],
    },
];

impl Drive {
    fn file(&self, signal: u64, within: u64) -> String {
        let ((control, selected), door) = (self.path, self.door);
        let axis = self.axis.join("\n");
        format!(
            "family = \"sinamics-s120\"\nname = \"drive\"\n[control]\np9500 = \"{CYCLE} ms\"\nr9780 = \"4 ms\"\n{control}\n\
             [axis.X]\nkind = \"linear\"\n{selected}\n{axis}\np9507_0 = true\np9659 = \"9000 h\"\np1135 = \"100 ms\"\n\
             [door.front]\naxes = [\"X\"]\nopen = \"{door}\"\nsignal = \"{signal} ms\"\n\
             [guarantee.door]\npattern = \"door_speed\"\ndoor = \"front\"\naxes = [\"X\"]\nspeed = \"2000 mm/min\"\n\
             within = \"{within} ms\"\n"
        )
    }

    /// The verdict on the guarantee with this time, and the time that it prints, in milliseconds.
    fn answer(&self, within: u64) -> (Verdict, Option<u64>) {
        self.answer_with(SIGNAL, within)
    }

    fn answer_with(&self, signal: u64, within: u64) -> (Verdict, Option<u64>) {
        let path = root().join("spec/machines/drive.toml");
        let text = self.file(signal, within);
        let machine = machine::load_bytes(&path, text.into_bytes(), &families(&path))
            .unwrap_or_else(|e| panic!("{}: {e}", self.name));
        let (subject, checked) = decided(&path, machine, &["door"], &Settings::default());
        let answers = answers(&subject, &checked);
        let [answer] = answers.as_slice() else {
            panic!("{}: one guarantee", self.name);
        };
        let bound = answer.runs.iter().filter_map(|run| run.bound).max();
        (answer.verdict, bound.map(|us| us.div_ceil(1000)))
    }
}

#[test]
fn the_printed_time_has_every_summand_of_its_control_path() {
    for drive in &DRIVES {
        let sum: u64 = drive.summands.iter().sum();
        let (verdict, bound) = drive.answer(10_000);
        assert_eq!(verdict, Verdict::Holds, "{}", drive.name);
        let bound = bound.expect("a time");
        // Each time is rounded up to whole cycles, and the contact opens at any moment of one.
        let most = sum + CYCLE * drive.summands.len() as u64;
        assert!(
            (sum..=most).contains(&bound),
            "{}: {bound} ms, the tables say {sum} ms",
            drive.name
        );
    }
}

#[test]
fn the_printed_time_is_the_least_that_is_kept() {
    for drive in &DRIVES {
        let (_, bound) = drive.answer(10_000);
        let bound = bound.expect("a time");
        assert_eq!(
            drive.answer(bound),
            (Verdict::Holds, Some(bound)),
            "{}",
            drive.name
        );
        assert_eq!(
            drive.answer(bound - 1).0,
            Verdict::Violated,
            "{}: {bound} ms",
            drive.name
        );
    }
}

/// With STO over terminals and no time for the signal the model needs no cycle at all: the response time alone has to count.
#[test]
fn a_time_below_the_response_time_alone_is_violated() {
    let [_, sto, ..] = &DRIVES;
    assert_eq!(sto.name, "Table 8-1, STO");
    let response = 4 * 4 + 2 + FILTERED;
    assert_eq!(sto.answer_with(0, response + CYCLE).0, Verdict::Vacuous);
    assert_eq!(sto.answer_with(0, response - 1).0, Verdict::Violated);
}
