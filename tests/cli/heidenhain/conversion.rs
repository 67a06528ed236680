//! What a value of the machine file becomes in the tables and in the monitors: one rule of rounding, compared with exact fractions.

use std::path::Path;

use stillpoint_machine::{self as machine, Machine};
use stillpoint_monitors::heidenhain::parameters as monitors;
use stillpoint_monitors::kernel::{ConfigError, Cycles, Speed};

/// Where a parameter goes.
struct Datum {
    /// In the machine file, with its unit there.
    name: &'static str,
    unit: &'static str,
    /// The values that a plausible machine of the test can have, of the printed range.
    range: (u32, u32),
    /// The system and its parameter.
    table: (&'static str, &'static str),
    monitor: fn(u32) -> Result<u32, ConfigError>,
    /// The exact value is the entered one times the first, divided by the second number.
    factor: (u64, u64),
    up: bool,
}

fn time(result: Result<Cycles, ConfigError>) -> Result<u32, ConfigError> {
    result.map(Cycles::count)
}

fn speed(result: Result<Speed, ConfigError>) -> Result<u32, ConfigError> {
    result.map(|speed| speed.0)
}

const fn datum(
    name: &'static str,
    range: (u32, u32),
    table: (&'static str, &'static str),
    monitor: fn(u32) -> Result<u32, ConfigError>,
) -> Datum {
    Datum {
        name,
        unit: "ms",
        range,
        table,
        monitor,
        factor: (1, 3),
        up: false,
    }
}

/// Of an axis whose other times leave room for the SS1 (`SMP525 > MP2308 + 120 ms`, `SMP530 < SMP525`).
const STOPPED: [Datum; 6] = [
    datum("SMP525", (121, 10_000), ("channel_a", "t_ss1"), |v| {
        time(monitors::stop_time(v))
    }),
    datum("SMP527", (0, 10_000), ("channel_a", "t_ss2"), |v| {
        time(monitors::stop_time(v))
    }),
    datum("SMP632", (3, 60_000), ("axis_values", "window"), |v| {
        time(monitors::window(v))
    }),
    Datum {
        unit: "mm/min",
        factor: (1, 2),
        ..datum("SMP590", (1, 2_000), ("speed_limit", "limit_2"), |v| {
            speed(monitors::axis_limit(v, 2_000))
        })
    },
    Datum {
        unit: "mm/min",
        factor: (1, 2),
        ..datum("SMP540", (1, 5_000), ("speed_limit", "limit_3"), |v| {
            speed(monitors::axis_limit(v, 5_000))
        })
    },
    Datum {
        unit: "mm/min",
        factor: (1, 2),
        ..datum("SMP552", (1, 5_000), ("speed_limit", "limit_4"), |v| {
            speed(monitors::axis_limit(v, 5_000))
        })
    },
];

/// Of an axis whose SMP525 is the longest.
const BRAKED: [Datum; 2] = [
    Datum {
        up: true,
        ..datum("MP2308", (0, 9_879), ("channel", "t_brake"), |v| {
            time(monitors::brake_time(v))
        })
    },
    datum("SMP530", (0, 9_999), ("axis_braking", "wait"), |v| {
        time(monitors::stop_time(v))
    }),
];

/// Of a spindle.
const TURNED: [Datum; 4] = [
    datum("SMP526", (321, 10_000), ("channel_a", "t_ss1"), |v| {
        time(monitors::stop_time(v))
    }),
    datum("SMP528", (0, 10_000), ("channel_a", "t_ss2"), |v| {
        time(monitors::stop_time(v))
    }),
    datum("SMP633", (3, 60_000), ("spindle_values", "window"), |v| {
        time(monitors::window(v))
    }),
    Datum {
        unit: "rev/min",
        // The table has whole revolutions a minute, the monitor 180 increments for each.
        factor: (1, 1),
        ..datum("SMP551", (1, 6_000), ("speed_limit", "limit_4"), |v| {
            speed(monitors::spindle_limit(v)).map(|i| i / 180)
        })
    },
];

/// The value of the parameter at step `k` of `steps` through its range, both ends included.
fn value(datum: &Datum, k: u32, steps: u32) -> u32 {
    let (low, high) = datum.range;
    let far = u64::from(high - low) * u64::from(k.min(steps)) / u64::from(steps);
    low + u32::try_from(far).expect("in the range")
}

fn load(text: String) -> Machine {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    machine::load_bytes(
        Path::new("conversion.toml"),
        text.into_bytes(),
        &root.join("spec/families"),
    )
    .unwrap_or_else(|e| panic!("{e}"))
}

/// HFS-PARAM-010: the cycles and limits that are explored for a machine are those with which its monitors run, and both are the
/// exact value, rounded to the side of the earlier reaction.
#[test]
fn machine_file_tables_and_monitors_round_alike() {
    const STEPS: u32 = 400;
    let kinds: [(&str, &str, &[Datum]); 3] = [
        (
            "kind = \"linear\"\nSMP650 = \"9 mm\"",
            "MP2308 = \"0 s\"\nSMP530 = \"0 s\"",
            &STOPPED,
        ),
        (
            "kind = \"linear\"\nSMP650 = \"9 mm\"",
            "SMP525 = \"10 s\"",
            &BRAKED,
        ),
        ("kind = \"spindle\"", "", &TURNED),
    ];
    let mut compared = 0;
    let mut k = 0;
    while k <= STEPS {
        // Groups 0 to 7 of one axis each, and a spindle among them.
        let mut text = "family = \"heidenhain-fs\"\n".to_owned();
        let mut axes = Vec::new();
        for (kind, (head, fixed, data)) in kinds.iter().enumerate() {
            let many = if kind == 2 { 2 } else { 3 };
            for n in 0..many {
                let name = format!("{}{n}", ["A", "B", "S"][kind]);
                text += &format!(
                    "[group.G{name}]\naxes = [\"{name}\"]\n[axis.{name}]\n{head}\n{fixed}\n"
                );
                for datum in *data {
                    let v = value(datum, k + n, STEPS);
                    text += &format!("{} = \"{v} {}\"\n", datum.name, datum.unit);
                    axes.push((name.clone(), datum, v));
                }
            }
        }
        let machine = load(text);
        for (axis, datum, v) in axes {
            let (system, param) = datum.table;
            let found = machine
                .runs
                .iter()
                .find(|r| r.system == system && r.axes.contains(&axis));
            let run = found.unwrap_or_else(|| panic!("{system} is not explored for {axis}"));
            let (numerator, denominator) = datum.factor;
            let product = u64::from(v) * numerator;
            let exact = if datum.up {
                product.div_ceil(denominator)
            } else {
                product / denominator
            };
            let exact = i64::try_from(exact).expect("small");
            let what = format!("{} = {v} {}", datum.name, datum.unit);
            assert_eq!(run.params[param], [exact], "{what}: table");
            let monitor = (datum.monitor)(v).unwrap_or_else(|e| panic!("{what}: {e:?}"));
            assert_eq!(i64::from(monitor), exact, "{what}: monitor");
            compared += 1;
        }
        k += 2;
    }
    assert!(compared > 6_000, "{compared} values");
}

/// The monitors alone, over the whole range of each parameter and just outside it.
#[test]
fn monitors_round_exact_fractions_over_the_whole_range() {
    for datum in STOPPED.iter().chain(&BRAKED).chain(&TURNED) {
        let (numerator, denominator) = datum.factor;
        for v in datum.range.0..=datum.range.1 {
            let product = u64::from(v) * numerator;
            let exact = if datum.up {
                product.div_ceil(denominator)
            } else {
                product / denominator
            };
            let monitor = (datum.monitor)(v).map(u64::from);
            assert_eq!(monitor, Ok(exact), "{} = {v} {}", datum.name, datum.unit);
        }
        assert!((datum.monitor)(60_001).is_err(), "{}", datum.name);
    }
}
