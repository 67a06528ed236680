//! Whole machines as one product each, which no explorer can enumerate, by the proof engines.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

use stillpoint_harness::proof::{Choice, Every, Judged, Settings, Span, Which, judge, judge_every};
use stillpoint_lang::eval::Frame;
use stillpoint_model::Verdict;
use stillpoint_monitors::sinumerik::group::{self, Reach, Reaction};
use stillpoint_monitors::sinumerik::level::{InternalStop, Level};
use stillpoint_tests::peer::{Folder, load};
use stillpoint_tests::random::Random;
use stillpoint_tests::root;

const MACHINE: &str = "spec/families/heidenhain-fs/products/machine.toml";
const AXES: &str = "spec/families/sinumerik-840d/products/axes.toml";

/// Changes of the axes of a channel between them, each with the property that finds it.
const BROKEN_AXES: [(&str, &str, &str); 6] = [
    // How far a stop reaches is asked of the axis that it reaches.
    (
        "ipo[j]), ipo[j], path",
        "ipo[i]), ipo[i], path",
        "S840D-STOP-082-CHANNEL",
    ),
    // Of two axes only the second one looks at the other.
    (
        "SEL(j = i, reaction_to",
        "SEL(j >= i, reaction_to",
        "S840D-STOP-082-CHANNEL",
    ),
    // Who interpolates is asked of the stopped axis alone.
    (
        "path[i].interpolates AND path[j].interpolates, esr",
        "path[j].interpolates, esr",
        "S840D-STOP-082-ALONE",
    ),
    // Nobody ever interpolates.
    (
        "path[i].interpolates AND path[j].interpolates, esr",
        "FALSE, esr",
        "S840D-STOP-082-STRONGEST",
    ),
    // An axis reacts to itself.
    (
        "SEL(j = i, reaction_to",
        "SEL(FALSE, reaction_to",
        "S840D-EXT-016",
    ),
    // A stop D of the path is one of the ramp.
    (
        "reaction_to(acting(PREV(stop[j].level), PREV(stop[j].internal), ipo[j]), ipo[j], path",
        "reaction_to(acting(PREV(stop[j].level), PREV(stop[j].internal), ipo[j]), 1, path",
        "S840D-STOP-082-D",
    ),
];

/// Changes of the machining centre between its parts, each with the property that finds it.
const BROKEN: [(&str, &str, &str); 7] = [
    // The spindle does not wait for the axes.
    (
        "\"i <> 2 OR NOT drive[1].moving\"",
        "\"TRUE\"",
        "HFS-SS1D-001",
    ),
    // The axes are not stopped with it.
    (
        "SEL(i = 1 AND judge[2].stops_axes, NONE, SS2), ",
        "",
        "HFS-MODE-011",
    ),
    // An SS1F stays in its group.
    (
        "SEL(EXISTS(j IN stop, j <> i AND PREV(stop[j].level) >= SS1F), NONE, SS1F), ",
        "",
        "HFS-SS1-001[1]",
    ),
    // It becomes an SS1 there, which needs no main switch.
    (
        ">= SS1F), NONE, SS1F), ",
        ">= SS1F), NONE, SS1), ",
        "HFS-SS1-001[1]",
    ),
    // The kernel reads the permissive of the magazine for the spindle.
    (
        "\"MUX(i - 1, splc.pb_a, splc.pb_s, splc.pb_t)\"",
        "\"MUX(i - 1, splc.pb_a, splc.pb_t, splc.pb_s)\"",
        "HFS-MODE-011",
    ),
    // The logic looks at the wrong door.
    (
        "\"splc.t_open\"          = \"t_open\"",
        "\"splc.t_open\"          = \"door_open\"",
        "HFS-P-09-START[3]",
    ),
    // What is activated is the group beside.
    (
        "\"MUX(i - 1, splc.activate_a, splc.activate_s, splc.activate_t)\"",
        "\"MUX(i - 1, splc.activate_s, splc.activate_a, splc.activate_t)\"",
        "HFS-P-09-START[2]",
    ),
];

fn settings() -> Settings {
    Settings {
        choice: Choice::Pdr,
        depth: 0,
        time: None,
        each: Some(Duration::from_secs(120)),
        memory: None,
        ..Settings::default()
    }
}

fn products() -> Vec<PathBuf> {
    [MACHINE, AXES].map(|file| root().join(file)).to_vec()
}

fn all_hold(judged: &[Judged], file: &Path) {
    assert!(judged.len() > 5, "{}", file.display());
    for one in judged {
        let reason = one.reason.as_deref().unwrap_or_default();
        let good = matches!(one.verdict, Verdict::Holds | Verdict::Reached);
        assert!(
            good,
            "{}: {}: {:?}, {reason}",
            file.display(),
            one.id,
            one.verdict
        );
    }
}

#[test]
fn every_product_is_among_them() {
    let families = std::fs::read_dir(root().join("spec/families")).expect("families");
    let folders = families.map(|family| family.expect("a family").path().join("products"));
    let found = folders.filter(|folder| folder.is_dir());
    let mut found: Vec<PathBuf> = found
        .flat_map(|folder| std::fs::read_dir(folder).expect("products"))
        .map(|file| file.expect("a product").path())
        .collect();
    found.sort();
    assert_eq!(found, products());
}

#[test]
fn a_whole_machine_keeps_what_its_parts_keep() {
    for file in products() {
        for task in &load(&file).tasks {
            all_hold(&judge(&task.bound, &settings()), &file);
        }
    }
}

#[test]
fn an_error_between_the_parts_of_a_machine_is_found() {
    are_found(MACHINE, &BROKEN);
}

#[test]
fn an_error_between_the_axes_of_a_channel_is_found() {
    are_found(AXES, &BROKEN_AXES);
}

fn are_found(file: &str, changes: &[(&str, &str, &str)]) {
    let product = root().join(file);
    let text = std::fs::read_to_string(&product).expect("the product");
    let family = product.ancestors().nth(2).expect("its family");
    let used = format!("\"{}/", family.display());
    let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), &used.replace(['/', '"'], "-"));
    for (from, to, breaks) in changes {
        assert!(text.contains(from), "{from}");
        let broken = text.replace(from, to).replace("\"../", &used);
        folder.write("broken.toml", &broken);
        let judged = judge(
            &load(&folder.file("broken.toml")).tasks[0].bound,
            &settings(),
        );
        let broken: Vec<&str> = (judged.iter())
            .filter(|one| one.verdict == Verdict::Violated)
            .map(|one| one.id.as_str())
            .collect();
        assert!(broken.contains(breaks), "{from}: {broken:?}");
    }
}

/// What the stops of all axes do to one is what the monitor says of each pair of them, the strongest of it.
#[test]
fn the_axes_of_a_channel_react_as_the_monitor_says() {
    let bound = &load(&root().join(AXES)).tasks[0].bound;
    let system = &bound.system;
    let state = |name: String| {
        let found = system
            .states
            .iter()
            .position(|state| state.var.name == name);
        found.unwrap_or_else(|| panic!("no {name}"))
    };
    let told = |name: String| {
        let found = system.lazies.iter().position(|lazy| lazy.name == name);
        found.unwrap_or_else(|| panic!("no {name}"))
    };
    let param = |name: String| {
        let found = system
            .params
            .iter()
            .position(|param| param.var.name == name);
        bound.values[found.unwrap_or_else(|| panic!("no {name}"))]
    };
    let of = |ordinal: i32| Level::ALL[usize::try_from(ordinal).expect("a level")];
    let axes = 1..=12;
    let mut random = Random::new(7);
    let mut frame = Frame::new(bound);
    let mut met = BTreeSet::new();
    for _ in 0..20_000 {
        let ranges = bound.states.iter();
        let mut before: Vec<i32> = ranges.map(|range| random.within(*range)).collect();
        for k in axes.clone() {
            // Most axes have no stop at all, or hardly another one would ever be the strongest.
            let level = match random.within((0, 3)) {
                0 => of(random.within((0, 7))),
                _ => Level::None,
            };
            let internal = match InternalStop::from_level(level) {
                Some(_) if random.within((0, 1)) == 0 => level,
                _ => Level::None,
            };
            before[state(format!("stop[{k}].level"))] = level as i32;
            before[state(format!("stop[{k}].internal"))] = internal as i32;
        }
        let inputs: Vec<i32> = bound.inputs.iter().map(|r| random.within(*r)).collect();
        let mut read = |k: usize| inputs[k];
        frame.start(&before);
        if bound.step(&mut frame, &mut read).is_err() {
            continue;
        }
        let mut value = |name: String| bound.lazy(told(name), &mut frame, &mut read);
        let path: Vec<bool> = (axes.clone())
            .map(|k| value(format!("path[{k}].interpolates")) != 0)
            .collect();
        for k in axes.clone() {
            let others = axes.clone().filter(|j| *j != k).map(|j| {
                let level = of(before[state(format!("stop[{j}].level"))]);
                let internal = of(before[state(format!("stop[{j}].internal"))]);
                let reach = match param(format!("ipo[{j}]")) {
                    0 => Reach::Channel,
                    _ => Reach::Interpolating,
                };
                let inputs = group::Inputs {
                    level,
                    internal: InternalStop::from_level(internal).expect("an internal stop"),
                    interpolates: path[j - 1] && path[k - 1],
                    esr: true,
                };
                let config = group::Config::new(reach);
                group::next(group::State::INITIAL, &config, &inputs)
                    .1
                    .reaction
            });
            let worst = group::worst(&others.collect::<Vec<_>>());
            assert_eq!(
                value(format!("axis[{k}].reaction")),
                worst as i64,
                "axis {k}: {before:?}"
            );
            met.insert(worst);
        }
    }
    assert_eq!(met.len(), Reaction::ALL.len(), "{met:?}");
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn it_keeps_it_in_every_configuration() {
        every(MACHINE, &Which::All);
    }

    /// With the default times: for all of them most properties are theorems, but not S840D-STOP-082-D.
    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn axes_of_every_number_and_setting_keep_it() {
        let named = ["axes", "ipo", "esr"].map(|name| Span {
            name: name.to_owned(),
            values: None,
        });
        every(AXES, &Which::Named(named.to_vec()));
    }

    fn every(file: &str, which: &Which) {
        let file = root().join(file);
        for task in &load(&file).tasks {
            let every = Every::new(&task.bound, which).expect("free parameters");
            all_hold(&judge_every(&every, &settings()), &file);
        }
    }
}
