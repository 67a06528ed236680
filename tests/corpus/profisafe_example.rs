//! The PROFIsafe example of the manual (chapter 10.6): its printed program does what its function table (table 10-2) says.
//!
//! Two places of the manual contradict the table. The program gives the number 23 to two actions, so that the first one, which switches
//! motor M1, is replaced and never runs; the program of the PLC has 25 for the second. And case 5 of the table has motor M1 powered up
//! after an emergency stop, where both programs switch it off; the programs are followed.

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::LazyKind;
use stillpoint_logic::spf::{Interface, Mode, Output, Readings, parse};
use stillpoint_logic::st::Signature;
use stillpoint_tests::root;

/// A cycle of the safe logic in microseconds: TI1 of 1.5 s is five of them.
const CYCLE: u64 = 300_000;

/// The inputs, 1: emergency stop not pressed, door closed and interlocked, agreement button pressed, drives on pressed.
const INPUTS: [(&str, &str); 7] = [
    ("stop", "INSE[1]"),
    ("door", "INSE[2]"),
    ("agree", "INSE[3]"),
    ("drives", "INSE[4]"),
    ("test_a", "PLCSIOUT[1]"),
    ("test_c", "PLCSIOUT[2]"),
    ("test_d", "PLCSIOUT[3]"),
];

/// The outputs: de-selections, the bit of the speed stage, valve units, supply, motors.
const OUTPUTS: [(&str, &str); 11] = [
    ("sbh_off", "OUTSI[1]"),
    ("sg_1", "OUTSI[2]"),
    ("a_off", "OUTSI[3]"),
    ("c_off", "OUTSI[4]"),
    ("d_off", "OUTSI[5]"),
    ("v1", "OUTSE[1]"),
    ("v2", "OUTSE[3]"),
    ("v3", "OUTSE[5]"),
    ("supply", "OUTSE[7]"),
    ("m1", "OUTSE[8]"),
    ("m2", "OUTSE[9]"),
];

/// A machine with the ports of the program.
fn empty() -> String {
    let mut text = String::from(
        "spec = \"example/profisafe\"\ntitle = \"x\"\nsource = \"x\"\n[machine.spl]\ntext = \"x\"\notherwise = \"stay\"\n[machine.spl.input]\n",
    );
    for (name, _) in INPUTS {
        text += &format!("{name} = \"BOOL\"\n");
    }
    text += "[machine.spl.output]\n";
    for (name, _) in OUTPUTS {
        text += &format!("{name} = \"FALSE\"\n");
    }
    text
}

/// The program of the manual with one text in the place of another.
fn program(from: &str, to: &str) -> Bound {
    let path = root().join("tests/corpus/sinumerik-840d/safe-spf/profisafe.spf");
    let printed = std::fs::read_to_string(path).expect("there");
    assert!(printed.contains(from));
    let source: Arc<str> = Arc::from(printed.replace(from, to));
    let mut spec = Spec::from_text("spl.toml".as_ref(), Arc::from(empty())).expect("a machine");
    let variable = |text: &str| text.parse().unwrap_or_else(|e| panic!("{e}"));
    let interface = Interface {
        signature: Signature::of(&spec, "spl").expect("a machine"),
        inputs: INPUTS
            .map(|(port, name)| (variable(name), port.to_owned()))
            .into(),
        outputs: OUTPUTS
            .map(|(port, name)| {
                let output = Output::Variable {
                    variable: variable(name),
                    inverted: false,
                };
                (port.to_owned(), output)
            })
            .into(),
        scan: None,
        readings: Readings {
            first_sample_is_no_edge: true,
            ..Readings::default()
        },
    };
    let compiled = parse("profisafe.spf", &source, Mode::Listing)
        .and_then(|program| program.compile(&interface))
        .unwrap_or_else(|e| panic!("{e}"));
    let name = toml::Spanned::new(0..0, "spl".to_owned());
    spec.replace("profisafe.spf", &source, &name, &compiled.machine)
        .unwrap_or_else(|e| panic!("{e}"));
    let system = spec.open_machine("spl").unwrap_or_else(|e| panic!("{e}"));
    let cycles = |us: &u64| i64::try_from(us.div_ceil(CYCLE)).expect("short");
    let times = compiled.durations.iter();
    let params: BTreeMap<_, _> = times
        .map(|(name, us)| (name.clone(), vec![cycles(us)]))
        .collect();
    Bound::new(system, &params, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"))
}

/// The program as the manual means it.
fn corrected() -> Bound {
    program("N960 IDS=23", "N960 IDS=25")
}

/// A machine that runs the program.
struct Run<'a> {
    bound: &'a Bound,
    frame: Frame,
    state: Vec<i32>,
}

impl<'a> Run<'a> {
    fn new(bound: &'a Bound) -> Self {
        let states = bound.system.states.iter();
        Self {
            bound,
            frame: Frame::new(bound),
            state: states
                .map(|s| s.init.as_ref().map_or(0, |e| bound.constant(e) as i32))
                .collect(),
        }
    }

    /// A cycle in which the named inputs are 1: the names of the outputs that are 1.
    fn cycle(&mut self, inputs: &[&str]) -> Vec<&'static str> {
        self.frame.start(&self.state);
        let bound = self.bound;
        let mut read = |k: usize| {
            let name = bound.system.inputs[k].name.rsplit('.').next();
            i32::from(name.is_some_and(|name| inputs.contains(&name)))
        };
        bound.step(&mut self.frame, &mut read).expect("no fault");
        let mut on = Vec::new();
        for (name, _) in OUTPUTS {
            let lazies = bound.system.lazies.iter();
            let place = lazies.enumerate().find(|(_, l)| {
                l.kind == LazyKind::Output && l.name.rsplit('.').next() == Some(name)
            });
            let (k, _) = place.expect("an output");
            if bound.lazy(k, &mut self.frame, &mut read) != 0 {
                on.push(name);
            }
        }
        self.state = self.frame.now.clone();
        on
    }

    /// The outputs once nothing changes.
    fn settled(&mut self, inputs: &[&str]) -> Vec<&'static str> {
        for _ in 0..10 {
            self.cycle(inputs);
        }
        self.cycle(inputs)
    }
}

/// Acknowledged, door closed.
fn running(bound: &Bound) -> Run<'_> {
    let mut run = Run::new(bound);
    run.settled(&["stop", "door"]);
    run.cycle(&["stop", "door", "drives"]);
    run
}

/// The selected stage: SG1 to SG4 by the two bits, of which the example uses one.
const SG3: &str = "sg_1";

/// Table 10-2, cases 1 to 3: S840D-PSAFE-707, S840D-PSAFE-708, S840D-PSAFE-709, S840D-PSAFE-714, S840D-PSAFE-715,
/// S840D-PSAFE-717.
#[test]
fn without_emergency_stop_door_and_agreement_decide() {
    let bound = corrected();
    let mut run = running(&bound);
    let stops_off = ["a_off", "c_off", "d_off"];
    let expect = |more: &[&'static str]| {
        let mut all: Vec<&str> = OUTPUTS.iter().map(|(name, _)| *name).collect();
        all.retain(|name| stops_off.contains(name) || more.contains(name));
        all
    };
    for agree in [&[][..], &["agree"]] {
        let closed = run.settled(&[&["stop", "door"], agree].concat());
        let case_1 = expect(&["sbh_off", SG3, "v1", "v2", "v3", "supply", "m1", "m2"]);
        assert_eq!(closed, case_1, "{agree:?}");
    }
    assert_eq!(run.settled(&["stop"]), expect(&["m1"]));
    let case_3 = expect(&["sbh_off", "v1", "v3", "m1"]);
    assert_eq!(run.settled(&["stop", "agree"]), case_3);
}

/// Table 10-2, cases 4 and 5: S840D-PSAFE-706, S840D-PSAFE-707, S840D-PSAFE-717. STOP A follows after 1.5 s.
#[test]
fn emergency_stop_is_stop_c_or_d_and_switches_off() {
    let bound = corrected();
    for (door, stop, other) in [(false, "c_off", "d_off"), (true, "d_off", "c_off")] {
        let mut run = running(&bound);
        let with = |inputs: &[&'static str]| {
            let mut all = inputs.to_vec();
            all.extend(door.then_some("door"));
            all
        };
        run.settled(&with(&["stop"]));
        let at_once = run.cycle(&with(&[]));
        assert!(!at_once.contains(&stop), "{at_once:?}");
        assert!(
            at_once.contains(&other) && at_once.contains(&"a_off"),
            "{at_once:?}"
        );
        for off in ["v1", "v2", "v3", "supply", "m1", "m2"] {
            assert!(!at_once.contains(&off), "{off}");
        }
        // TI1 of 1.5 s: five cycles of 0.3 s, of which the one above is the first.
        for cycle in 2..=5 {
            assert!(run.cycle(&with(&[])).contains(&"a_off"), "cycle {cycle}");
        }
        assert!(!run.cycle(&with(&[])).contains(&"a_off"));
        // Released, it stays; the button acknowledges.
        let released = run.settled(&with(&["stop"]));
        assert!(!released.contains(&stop) && !released.contains(&"m1"));
        let acknowledged = run.cycle(&with(&["stop", "drives"]));
        assert!(acknowledged.contains(&stop) && acknowledged.contains(&"m1"));
    }
}

/// S840D-PSAFE-706: after a run-up nothing is released before the button, also one that is held since before.
#[test]
fn run_up_wants_the_button() {
    let bound = corrected();
    let mut run = Run::new(&bound);
    let held = run.settled(&["stop", "door", "drives"]);
    assert!(
        !held.contains(&"m1") && !held.contains(&"a_off"),
        "{held:?}"
    );
    run.cycle(&["stop", "door"]);
    assert!(run.cycle(&["stop", "door", "drives"]).contains(&"m1"));
}

/// S840D-PSAFE-707: each external stop can be tested by itself.
#[test]
fn tests_request_their_stop() {
    let bound = corrected();
    let mut run = running(&bound);
    let all = run.settled(&["stop", "door"]);
    for (test, stop) in [
        ("test_a", "a_off"),
        ("test_c", "c_off"),
        ("test_d", "d_off"),
    ] {
        let tested = run.settled(&["stop", "door", test]);
        let mut without = all.clone();
        without.retain(|name| *name != stop);
        assert_eq!(tested, without);
    }
}

/// S840D-PSAFE-719: a weakness of the example. Closing the door alone opens the valves, switches the supply on and releases group 2.
#[test]
fn closing_the_door_switches_on() {
    let bound = corrected();
    let mut run = running(&bound);
    let open = run.settled(&["stop"]);
    assert!(!open.contains(&"m2") && !open.contains(&"v2"));
    let closed = run.cycle(&["stop", "door"]);
    for on in ["v1", "v2", "v3", "supply", "m2", "sbh_off"] {
        assert!(closed.contains(&on), "{on}");
    }
}

/// S840D-PSAFE-711: as it is printed, the program has one number for two actions, and motor M1 is never switched on.
#[test]
fn the_repeated_number_loses_motor_1() {
    let bound = program("N960 IDS=23", "N960 IDS=23");
    let mut run = running(&bound);
    let on = run.settled(&["stop", "door"]);
    assert!(on.contains(&"m2") && !on.contains(&"m1"), "{on:?}");
}
