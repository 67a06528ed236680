//! Machine files: the shipped one loads with exact values and runs, each bad one is refused with place and fix, and no
//! input makes the loader panic.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use proptest::prelude::*;
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_machine::{self as machine, AxisKind, Machine, Run};

/// The folder of the specification.
fn spec() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn families() -> PathBuf {
    spec().join("families")
}

fn bad_input() -> PathBuf {
    spec().join("../tests/bad-input")
}

fn milling() -> Machine {
    let path = spec().join("machines/milling-840d.toml");
    machine::load(&path, &families()).unwrap_or_else(|e| panic!("{e}"))
}

fn centre() -> Machine {
    let path = spec().join("machines/machining-centre-heidenhain.toml");
    machine::load(&path, &families()).unwrap_or_else(|e| panic!("{e}"))
}

fn cells(machine: &Machine, axis: &str, parameter: &str) -> Vec<i64> {
    let axis = machine
        .axes
        .iter()
        .find(|a| a.name == axis)
        .expect("the axis");
    axis.values[parameter].cells.clone()
}

#[test]
fn the_milling_machine_has_exact_values() {
    let machine = milling();
    assert_eq!(machine.name, "milling-840d");
    assert_eq!(machine.family, "sinumerik-840d");
    // 3 * 4 ms (S840D-TIMING-501)
    assert_eq!(machine.monitoring_cycle, 12_000);
    let names: Vec<&str> = machine.axes.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(names, ["X", "Y", "Z", "S"]);
    assert_eq!(machine.groups, [["X", "Y", "Z"]]);
    assert_eq!(machine.axes[0].kind, AxisKind::Linear);
    assert_eq!(machine.axes[3].kind, AxisKind::Rotary);

    // um, um/min, us; the choice by its number in the manual
    assert_eq!(cells(&machine, "X", "STANDSTILL_TOL"), [500]);
    assert_eq!(
        cells(&machine, "X", "VELO_LIMIT"),
        [2_000_000, 5_000_000, 10_000_000, 30_000_000]
    );
    assert_eq!(cells(&machine, "X", "VELO_SWITCH_DELAY"), [200_000]);
    assert_eq!(cells(&machine, "X", "VELO_STOP_REACTION"), [2, 3, 3, 3]);
    // mdeg, mdeg/min
    assert_eq!(cells(&machine, "S", "STANDSTILL_TOL"), [2_000]);
    assert_eq!(cells(&machine, "S", "VELO_LIMIT")[0], 50 * 360_000);
    // defaults of the manual: 0.1 mm, 0.1 s
    assert_eq!(cells(&machine, "X", "POS_TOL"), [100]);
    assert_eq!(cells(&machine, "S", "STOP_SWITCH_TIME_E"), [100_000]);
    assert!(!machine.axes[0].values["POS_TOL"].is_given());
    assert_eq!(
        machine.axes[0].values["POS_LIMIT_MINUS"].shown,
        ["-410 mm", "-410 mm"]
    );
    assert_eq!(machine.doors[0].values["test_interval"].shown, ["8 h"]);
}

fn run<'a>(machine: &'a Machine, system: &str, axis: &str) -> &'a Run {
    let mut runs = machine.runs.iter();
    let found = runs.find(|r| r.system == system && r.axes.iter().any(|a| a == axis));
    found.unwrap_or_else(|| panic!("no run of {system} for {axis}"))
}

#[test]
fn axes_alike_share_a_run_and_each_axis_has_all_of_them() {
    let machine = milling();
    for axis in ["X", "Y", "Z", "S"] {
        for system in ["stop", "stop_pair", "channel", "selection"] {
            run(&machine, system, axis);
        }
    }
    assert_eq!(run(&machine, "stop", "X").axes, ["X", "Y"]);
    assert_eq!(run(&machine, "stop_pair", "X").axes, ["X", "Y", "Z"]);
    assert_eq!(run(&machine, "stop_pair", "S").axes, ["S"]);
    assert_eq!(run(&machine, "referencing", "X").axes, ["X", "Y", "Z"]);
    assert_eq!(run(&machine, "stop_group", "X").axes, ["X", "Y", "Z"]);
    assert!(
        machine
            .runs
            .iter()
            .all(|r| r.system != "referencing" || !r.axes.contains(&"S".to_owned()))
    );
    // A guarantee asks about its door, too.
    assert!(
        machine.not_explored.is_empty(),
        "{:?}",
        machine.not_explored
    );
}

#[test]
fn each_run_fits_its_system() {
    for machine in [milling(), centre()] {
        assert!(machine.runs.len() >= 10, "{} runs", machine.runs.len());
        for run in &machine.runs {
            let spec = machine.spec(run).unwrap_or_else(|e| panic!("{e}"));
            let system = spec
                .system(&run.system, u64::try_from(run.cycle).ok())
                .unwrap_or_else(|e| panic!("{e}"));
            let scaled = system.scaled;
            if let Err(error) = Bound::new(system, &run.params, &BTreeMap::new()) {
                panic!("{}: {error}", run.title);
            }
            let says = |text: &str| run.abstractions.iter().any(|t| t.text.starts_with(text));
            let told = says("times in steps of ");
            assert!(scaled || !told, "{}", run.title);
            // Or the family says which small times it has, whatever those of the machine are.
            assert!(told || says("times of ") || !scaled, "{}", run.title);
        }
    }
}

#[test]
fn the_machining_centre_is_explored_by_groups() {
    let machine = centre();
    // 3 ms (HFS-TIMING-001)
    assert_eq!(machine.monitoring_cycle, 3_000);
    let groups: Vec<&str> = machine
        .axis_groups
        .iter()
        .map(|g| g.name.as_str())
        .collect();
    assert_eq!(groups, ["NC", "S", "T"]);
    assert_eq!(machine.groups, [&["X", "Y", "Z"][..], &["S"], &["M"]]);
    let doors: Vec<Vec<&str>> = (machine.doors.iter())
        .map(|d| d.axes.iter().map(|a| a.get_ref().as_str()).collect())
        .collect();
    assert_eq!(doors, [&["X", "Y", "Z", "S"][..], &["M"]]);
    assert!(
        machine.not_explored.is_empty(),
        "{:?}",
        machine.not_explored
    );
    assert_eq!(
        machine.coverage(),
        [
            "Group NC: X, Y, Z.",
            "Group S: S.",
            "Group T: M.",
            "Logic splc is that of the machine file: the safe PLC program."
        ]
    );
    // The longest time of an axis of the group: 600 ms; the spindle has 2.3 s, rounded down to cycles of 3 ms.
    let channel = |axis: &str| run(&machine, "channel", axis).params["t_ss1"][0];
    assert_eq!((channel("Z"), channel("S")), (200, 766));
    let title = &run(&machine, "channel", "Z").title;
    assert_eq!(title, "stop reaction of a group in the CC, group NC");
    // The keylock is evaluated in the cycle of the PLC.
    let keylock = machine.runs.iter().find(|r| r.system == "keylock");
    assert_eq!(keylock.map(|r| r.cycle), Some(21_000));
    // X and Y are alike, Z is not.
    let limits = |axis: &str| run(&machine, "speed_limit", axis).axes.join(" ");
    assert_eq!(
        (limits("Y"), limits("Z")),
        ("X Y".to_owned(), "Z".to_owned())
    );
}

#[test]
fn a_logic_takes_the_place_of_that_of_the_tables() {
    let path = spec().join("../tests/machines/door-ignored.toml");
    let machine = machine::load(&path, &families()).unwrap_or_else(|e| panic!("{e}"));
    let run = machine
        .runs
        .iter()
        .find(|r| r.system == "logic")
        .expect("a run");
    let fingerprint = |spec: Spec| {
        let system = spec.system("logic", None).unwrap_or_else(|e| panic!("{e}"));
        let logic = system.instances.iter().find(|i| i.machine == "splc");
        (
            logic.expect("the instance").rules.len(),
            system.fingerprint(),
        )
    };
    let tables = fingerprint(Spec::load(&run.file).unwrap_or_else(|e| panic!("{e}")));
    let own = fingerprint(machine.spec(run).unwrap_or_else(|e| panic!("{e}")));
    assert!(
        tables.0 > 0 && own.0 == 0,
        "{} and {} rules",
        tables.0,
        own.0
    );
    assert_ne!(tables.1, own.1);
    // That of the machining centre is the example of the tables with other comments.
    let centre = centre();
    let same = fingerprint(centre.spec(run).unwrap_or_else(|e| panic!("{e}")));
    assert_eq!(same, tables);
}

#[test]
fn times_become_cycles_and_never_shorter() {
    let machine = milling();
    // exact: 300 ms = 25 cycles of 12 ms, 400 ms = 33.3 cycles
    let stop = run(&machine, "stop", "X");
    assert_eq!(stop.params["t_b"], [25]);
    assert_eq!(stop.params["t_d"], [34]);
    assert_eq!(stop.params["enable_e"], [1]);
    let rounded = "times rounded up to cycles of 12 ms: t_d = 34 cycles, t_f = 9 cycles";
    assert!(
        stop.abstractions.iter().any(|t| t.text == rounded),
        "{:?}",
        stop.abstractions
    );
    // scaled: the longest, 600 ms = 50 cycles, takes two steps of 25 cycles
    let pair = run(&machine, "stop_pair", "X");
    let steps = ["t_b", "t_c", "t_d", "t_e", "t_f"].map(|t| pair.params[t][0]);
    assert_eq!(steps, [1, 1, 2, 2, 1]);
    assert!(pair.abstractions.iter().any(|t| {
        t.text
            .starts_with("times in steps of 25 cycles of 12 ms, rounded up: t_b 25 cycles = 1")
    }));
    assert_eq!(run(&machine, "stop_pair", "S").params["enable_e"], [0]);
    // limits by their order
    let selection = run(&machine, "selection", "S");
    let limits = ["limit_1", "limit_2", "limit_3", "limit_4"].map(|l| selection.params[l][0]);
    assert_eq!(limits, [0, 1, 2, 3]);
}

/// Loads a text as a machine file.
fn load(text: &str) -> stillpoint_lang::diag::Result<Machine> {
    machine::load_bytes(Path::new("m.toml"), text.as_bytes().to_vec(), &families())
}

#[test]
fn zero_stays_zero_and_equal_limits_share_a_rank() {
    let machine = load(
        "family = \"sinumerik-840d\"\n[axis.X]\nkind = \"linear\"\nfunctions = [\"SBH/SG\"]\nPULSE_DISABLE_DELAY = \"0 s\"\n\
         STOP_SWITCH_TIME_E = \"10 s\"\nVELO_LIMIT = [\"4 m/min\", \"1 m/min\", \"4000 mm/min\", \"2 m/min\"]\n",
    )
    .unwrap_or_else(|e| panic!("{e}"));
    let pair = run(&machine, "stop_pair", "X");
    assert_eq!(
        ["t_b", "t_c", "t_e", "t_f"].map(|t| pair.params[t][0]),
        [0, 1, 2, 0]
    );
    let selection = run(&machine, "selection", "X");
    let limits = ["limit_1", "limit_2", "limit_3", "limit_4"].map(|l| selection.params[l][0]);
    assert_eq!(limits, [2, 0, 2, 1]);
}

#[test]
fn coupling_follows_the_stop_group() {
    let axis = |name: &str, more: &str| {
        format!("[axis.{name}]\nkind = \"linear\"\nfunctions = [\"SBH/SG\"]\n{more}\n")
    };
    let groups = |axes: &[String]| {
        let text = format!("family = \"sinumerik-840d\"\n{}", axes.concat());
        load(&text).unwrap_or_else(|e| panic!("{e}")).groups
    };
    let alone = "IPO_STOP_GROUP = \"interpolating axes\"";
    let with = |other: &str| format!("{alone}\ninterpolates_with = [\"{other}\"]");
    assert!(groups(&[axis("A", alone), axis("B", alone)]).is_empty());
    // One direction is enough, and it passes on.
    let chain = [
        axis("A", &with("C")),
        axis("B", alone),
        axis("C", alone),
        axis("D", &with("C")),
    ];
    assert_eq!(groups(&chain), [["A", "C", "D"]]);
    // The default, group 0: a stop acts on the whole channel.
    assert_eq!(
        groups(&[axis("A", alone), axis("B", ""), axis("C", alone)]),
        [["A", "B", "C"]]
    );
}

/// The axes of a group of any number up to twelve are judged together, each with its own times; what is beyond is told.
#[test]
fn groups_of_every_size_have_a_product() {
    let name = |k: usize| char::from(b'A' + u8::try_from(k).expect("few axes"));
    let of = |size: usize| {
        let axes = (0..size).map(|k| {
            // The last one has a setting of its own, and moves with the first.
            let more = match k + 1 == size {
                true => "IPO_STOP_GROUP = \"interpolating axes\"\ninterpolates_with = [\"A\"]",
                false => "",
            };
            format!(
                "[axis.{}]\nkind = \"linear\"\nfunctions = [\"SBH/SG\"]\nSTOP_SWITCH_TIME_D = \"{} ms\"\n{more}\n",
                name(k),
                12 * (k + 1)
            )
        });
        let text = format!("family = \"sinumerik-840d\"\n{}", axes.collect::<String>());
        load(&text).unwrap_or_else(|e| panic!("{e}"))
    };
    for size in 2..=12 {
        let machine = of(size);
        let products = machine.products().expect("products");
        let [run] = &products[..] else {
            panic!("{size} axes: {} products", products.len());
        };
        let names: Vec<String> = (0..size).map(|k| name(k).to_string()).collect();
        assert_eq!(run.axes, names);
        assert_eq!(run.params["axes"], [i64::try_from(size).expect("few")]);
        let own = |k: usize| i64::from(k + 1 == size);
        let first = |cells: Vec<i64>| -> Vec<i64> {
            let first = cells.first().copied().unwrap_or_default();
            cells
                .into_iter()
                .chain(std::iter::repeat(first))
                .take(12)
                .collect()
        };
        assert_eq!(run.params["ipo"], first((0..size).map(own).collect()));
        let cycles = (1..=size).map(|k| i64::try_from(k).expect("few"));
        assert_eq!(run.params["t_d"], first(cycles.collect()));
        assert!(
            run.abstractions
                .iter()
                .all(|one| !one.text.contains("steps of"))
        );
        let alike = format!("t_b[1..{size}] = 9 cycles");
        assert!(run.abstractions.iter().any(|one| one.text.contains(&alike)));
        let spec = machine.spec(run).unwrap_or_else(|e| panic!("{e}"));
        let system = spec.system(&run.system, u64::try_from(run.cycle).ok());
        let system = system.unwrap_or_else(|e| panic!("{e}"));
        Bound::new(system, &run.params, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"));
        assert!(
            !machine
                .not_explored
                .iter()
                .any(|text| text.starts_with("group"))
        );
    }
    let machine = of(13);
    assert!(machine.products().expect("products").is_empty());
    let told = "there is no system for 13 together";
    assert!(machine.not_explored.iter().any(|text| text.ends_with(told)));
}

/// Each function is selected for each axis alone, whatever the others have; nothing else, such as an operating mode, takes
/// part in the selection: there is no key for it (S840D-ARCH-502).
#[test]
fn functions_are_selected_for_each_axis_alone() {
    let load = |text: &str| {
        let text = format!("family = \"sinumerik-840d\"\n{text}");
        machine::load_bytes(Path::new("example.toml"), text.into_bytes(), &families())
    };
    for function in ["SE", "override", "external stops", "SN1+", "SN4-"] {
        let text = format!(
            "axis.X = {{ kind = \"linear\", functions = [\"SBH/SG\", \"{function}\"] }}\naxis.Y.kind = \"linear\"\n\
             axis.Z = {{ kind = \"linear\", functions = [\"SBH/SG\"] }}\n"
        );
        let machine = load(&text).unwrap_or_else(|e| panic!("{e}"));
        let of = |k: usize| machine.axes[k].functions.clone();
        assert_eq!(of(0), ["SBH/SG", function]);
        assert!(of(1).is_empty());
        assert_eq!(of(2), ["SBH/SG"]);
    }
    for key in ["mode", "operating_mode", "OPERATING_MODE"] {
        let text = format!(
            "axis.X = {{ kind = \"linear\", functions = [\"SBH/SG\"], {key} = \"JOG\" }}\n"
        );
        let error = load(&text).expect_err("no such key").to_string();
        assert!(error.contains("unknown key"), "{error}");
    }
}

/// What the loader says about a file of the folder of bad input, the folder's name left out.
fn refusal(path: &Path) -> String {
    let error = match machine::load(path, &families()) {
        Ok(_) => panic!("{} was accepted", path.display()),
        Err(error) => error,
    };
    for one in &error.0 {
        assert!(!one.message.is_empty() && !one.help.is_empty(), "{one:?}");
        assert!(
            one.span.as_ref().is_none_or(|s| s.end <= one.source.len()),
            "{one:?}"
        );
    }
    let folder = format!("{}/", bad_input().display());
    error.to_string().replace(&folder, "")
}

#[test]
fn bad_files_are_refused_with_place_and_fix() {
    let mut got = String::new();
    let mut files: Vec<PathBuf> = fs::read_dir(bad_input())
        .expect("the folder of bad input")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    for path in &files {
        got.push_str(&refusal(path));
        got.push('\n');
    }
    // `stillpoint trace` reads from this snapshot which requirements are kept by a refusal.
    insta::assert_snapshot!("bad_input", got);
}

/// S120-SBT-002, S120-TIMING-001: the fix that a refusal names is taken.
#[test]
fn refused_files_are_accepted_with_their_fix() {
    for (file, wrong, right) in [
        (
            "s120-brake-test-of-another-motor.toml",
            "r0108_12 = true",
            "r0108_12 = true\np10204 = \"linear\"",
        ),
        (
            "s120-acquisition-too-fast.toml",
            "p9511 = \"1 ms\"",
            "p9511 = \"2 ms\"",
        ),
        (
            "s120-acquisition-without-encoder.toml",
            "p9511 = \"1 ms\"",
            "p9511 = \"125 us\"",
        ),
    ] {
        let text = fs::read_to_string(bad_input().join(file)).expect("a file of the folder");
        assert!(text.contains(wrong), "{file}");
        load(&text.replace(wrong, right)).unwrap_or_else(|e| panic!("{file}: {e}"));
    }
}

#[test]
fn what_is_no_file_is_refused() {
    let folder = refusal(&bad_input());
    assert!(
        folder.contains("this is a directory, not a machine file\n  help: name one file in it"),
        "{folder}"
    );
    let none = refusal(&bad_input().join("no-such-file.toml"));
    assert!(
        none.contains("cannot read this machine file: no such file"),
        "{none}"
    );
    #[cfg(unix)]
    {
        let device = refusal(Path::new("/dev/null"));
        assert!(
            device.contains("this is a device or pipe, not a machine file"),
            "{device}"
        );
    }
}

#[test]
fn a_specification_file_is_named_as_one() {
    let error = load("spec = \"x\"\n")
        .expect_err("no machine file")
        .to_string();
    assert!(
        error.starts_with("m.toml:1:8: this is a specification file"),
        "{error}"
    );
}

/// Every word and value of the milling file that a mutation may put elsewhere.
fn fragments() -> Vec<&'static str> {
    vec![
        "[axis.X]",
        "[axis]",
        "[[axis]]",
        "[control]",
        "[door.front]",
        "kind",
        "=",
        "\"",
        "'",
        "\"2 mm\"",
        "-1",
        "1e9",
        "9223372036854775808",
        "[",
        "]",
        "{",
        "}",
        "\n",
        "#",
        "\u{0}",
        "\u{feff}",
        "\u{fffd}",
        "ä",
        "true",
        "1979-05-27",
        "\"STOP E\"",
        "functions",
        "SAFETY_SYSCLOCK_TIME_RATIO = 50",
        "0x",
        "...",
        "\"1000000000000000000000000 mm\"",
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Arbitrary bytes are refused or read, never a panic.
    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        _ = machine::load_bytes(Path::new("m.toml"), bytes, &families());
    }

    /// The milling file with pieces cut out, put in and bytes changed.
    #[test]
    fn mutated_machine(
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..40, prop::sample::select(fragments()), any::<Option<u8>>()), 1..6)
    ) {
        let mut bytes = include_bytes!("../../machines/milling-840d.toml").to_vec();
        for (place, length, fragment, byte) in edits {
            let start = place.index(bytes.len().max(1)).min(bytes.len());
            let end = (start + length).min(bytes.len());
            match byte {
                Some(byte) => bytes[start..end].iter_mut().for_each(|b| *b = byte),
                None => _ = bytes.splice(start..end, fragment.bytes()),
            }
        }
        if let Err(errors) = machine::load_bytes(Path::new("m.toml"), bytes, &families()) {
            prop_assert!(!errors.0.is_empty());
            for one in errors.0 {
                prop_assert!(one.span.as_ref().is_none_or(|s| s.start <= s.end && s.end <= one.source.len()), "{:?}", one.span);
                // The place must be one that can be shown.
                prop_assert!(one.span.is_none() || one.position().is_some());
            }
        }
    }

    /// Nesting of any depth is refused without exhausting the stack.
    #[test]
    fn nesting(depth in 1_usize..20_000, open in prop::sample::select(vec!["[", "{a=", "[{a="])) {
        let text = format!("family = \"sinumerik-840d\"\naxis = {}", open.repeat(depth));
        prop_assert!(load(&text).is_err());
    }

    /// A value that is shown reads back as itself, in every dimension.
    #[test]
    fn shown_values_read_back(value in any::<i64>()) {
        use stillpoint_machine::units::{Dimension, parse};
        for dimension in [
            Dimension::Length, Dimension::Angle, Dimension::Speed, Dimension::Rotation, Dimension::Time,
            Dimension::Percent, Dimension::Frequency, Dimension::Count,
        ] {
            prop_assert_eq!(parse(&dimension.show(value), dimension), Ok(value));
        }
    }
}
