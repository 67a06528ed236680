//! The example machine of chapter 10.3, its half in the PLC as it is printed, step by step: each test names the rows that it walks
//! through. A cycle of the PLC is long here, 100 ms or a second, so that eight
//! hours are not too many of them.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_logic::st::Signature;
use stillpoint_logic::stl::{Bit, Interface, Output, parse};

use crate::common::Running;

/// A machine with ten outputs.
const SPL: &str = r#"
spec   = "test/spl"
title  = "A safe logic"
source = "none"

[machine.spl]
text      = "outputs"
otherwise = "stay"

[machine.spl.output]
o0 = "FALSE"
o1 = "FALSE"
o2 = "FALSE"
o3 = "FALSE"
o4 = "FALSE"
o5 = "FALSE"
o6 = "FALSE"
o7 = "FALSE"
o8 = "FALSE"
o9 = "FALSE"
"#;

const OUTPUTS: [&str; 10] = ["o0", "o1", "o2", "o3", "o4", "o5", "o6", "o7", "o8", "o9"];

/// The printed program, with what it is told and the bits that are watched.
struct Printed {
    running: Running,
    bits: Vec<&'static str>,
    /// Inputs that are 1.
    on: Vec<&'static str>,
    seen: Vec<bool>,
}

impl Printed {
    /// A cycle has so many milliseconds.
    fn new(name: &str, bits: &[&'static str], cycle: u64) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../tests/corpus/sinumerik-840d/stl")
            .join(format!("{name}.stl"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
        let source: Arc<str> = Arc::from(text.as_str());
        let mut spec = Spec::from_text("spl.toml".as_ref(), Arc::from(SPL)).expect("a machine");
        let output = |k: usize| match bits.get(k) {
            Some(text) => Output::Bit {
                bit: text.parse::<Bit>().unwrap_or_else(|e| panic!("{e}")),
                inverted: false,
            },
            None => Output::Constant(false),
        };
        let named = OUTPUTS.iter().enumerate();
        let interface = Interface {
            signature: Signature::of(&spec, "spl").expect("a machine"),
            inputs: Vec::new(),
            outputs: named
                .map(|(k, port)| ((*port).to_owned(), output(k)))
                .collect(),
            scan: None,
        };
        let compiled = parse(name, &source)
            .and_then(|program| program.compile(&interface))
            .unwrap_or_else(|e| panic!("{e}"));
        let place = toml::Spanned::new(0..0, "spl".to_owned());
        spec.replace(name, &source, &place, &compiled.machine)
            .unwrap_or_else(|e| panic!("{e}"));
        let system = spec.open_machine("spl").unwrap_or_else(|e| panic!("{e}"));
        let length = |us: u64| vec![us.div_ceil(cycle * 1_000) as i64];
        let times = compiled.durations.iter();
        let params: BTreeMap<String, Vec<i64>> = times
            .map(|(name, us)| (name.clone(), length(*us)))
            .collect();
        let bound = Bound::new(system, &params, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"));
        Self {
            running: Running::new(bound),
            bits: bits.to_vec(),
            on: Vec::new(),
            seen: Vec::new(),
        }
    }

    fn set(&mut self, input: &'static str) -> &mut Self {
        self.on.push(input);
        self
    }

    fn clear(&mut self, input: &str) -> &mut Self {
        self.on.retain(|on| *on != input);
        self
    }

    /// So many cycles with these inputs.
    fn run(&mut self, cycles: usize) -> &mut Self {
        let inputs: Vec<(&str, i32)> = self.on.iter().map(|name| (*name, 1)).collect();
        for _ in 0..cycles {
            let out = self.running.step(&inputs, OUTPUTS).expect("no fault");
            self.seen = out.iter().map(|value| *value == 1).collect();
        }
        self
    }

    /// A bit that is watched.
    fn is(&self, bit: &str) -> bool {
        let at = self.bits.iter().position(|of| *of == bit);
        self.seen[at.unwrap_or_else(|| panic!("{bit} is not watched"))]
    }

    /// A cycle with an input that is 1 in it alone.
    fn pulse(&mut self, input: &'static str) -> &mut Self {
        self.set(input).run(1).clear(input)
    }
}

const ESTOP: &str = "input_76_0";
const DOOR: &str = "input_76_1";
const ACK: &str = "input_76_3";
const DROPPED: &str = "input_76_4";
const KEY: &str = "input_76_5";
const RESET: &str = "input_3_7";

/// S840D-EXAMPLE-701, S840D-EXAMPLE-702, S840D-EXAMPLE-703, S840D-EXAMPLE-704, S840D-EXAMPLE-705, S840D-EXAMPLE-707, S840D-TIMING-703/b.
#[test]
fn the_emergency_stop() {
    let bits = [
        "MARKERSIP[2]",
        "OUTSIP[3]",
        "OUTSIP[2]",
        "OUTSIP[1]",
        "A48.2",
        "DB31.DBX32.3",
        "DB33.DBX32.2",
    ];
    let mut plc = Printed::new("emergency-stop", &bits, 100);
    let all = |plc: &Printed| bits.map(|bit| plc.is(bit));
    plc.set(ESTOP).run(3);
    assert_eq!(all(&plc), [false; 7], "nothing before the acknowledgement");
    plc.pulse(ACK);
    assert_eq!(all(&plc), [true; 7]);
    plc.run(100);
    assert_eq!(all(&plc), [true; 7]);
    // The button is pressed: STOP C and the contactor at once, STOP A of the axes after 1 s, of the spindle after 5 s.
    plc.clear(ESTOP).run(1);
    assert_eq!(all(&plc), [false, false, true, true, false, false, true]);
    plc.pulse(ACK);
    assert!(
        !plc.is("MARKERSIP[2]"),
        "an acknowledgement while it is pressed"
    );
    plc.run(8);
    assert!(plc.is("OUTSIP[2]"), "0.9 s");
    plc.run(1);
    assert!(!plc.is("OUTSIP[2]"), "1 s");
    plc.run(39);
    assert!(plc.is("OUTSIP[1]"), "4.9 s");
    plc.run(1);
    assert_eq!(all(&plc), [false; 7], "5 s");
    // Released in time, no STOP A comes; pressed again, its time begins again.
    plc.set(ESTOP).pulse(ACK);
    plc.clear(ESTOP).run(9).set(ESTOP).pulse(ACK);
    plc.run(50);
    assert_eq!(all(&plc), [true; 7]);
    plc.clear(ESTOP).run(10);
    assert!(
        plc.is("OUTSIP[2]"),
        "not sooner than 1 s after the second one"
    );
    plc.run(1);
    assert!(!plc.is("OUTSIP[2]"));
}

/// S840D-EXAMPLE-706, S840D-EXAMPLE-709, S840D-EXAMPLE-710, S840D-EXAMPLE-713.
#[test]
fn what_follows_the_inputs() {
    let bits = [
        "OUTSIP[5]",
        "OUTSIP[6]",
        "OUTSIP[4]",
        "INSEP[7]",
        "OUTSEP[3]",
        "INSIP[1]",
        "OUTSIP[9]",
        "INSEP[8]",
        "OUTSEP[4]",
    ];
    let mut plc = Printed::new("emergency-stop", &bits, 100);
    for k in 0..64_u32 {
        let inputs = [
            KEY,
            DOOR,
            "m_216_1",
            "m_218_7",
            "db31_dbx108_2",
            "db32_dbx108_2",
        ];
        plc.on.clear();
        let is = |n: usize| k >> n & 1 == 1;
        let on = inputs.iter().enumerate().filter(|(n, _)| is(*n));
        plc.on.extend(on.map(|(_, input)| *input));
        plc.run(1);
        assert_eq!(
            plc.is("OUTSIP[5]"),
            is(0) || is(1),
            "SBH de-selected by key or door"
        );
        assert_eq!(plc.is("OUTSIP[6]"), is(1), "the stage by the door");
        assert_eq!(
            plc.is("OUTSIP[4]"),
            !is(2) && !is(3),
            "STOP D by its test or by the feedback"
        );
        let cancelled = is(4) && is(5);
        assert_eq!([plc.is("INSEP[7]"), plc.is("OUTSIP[9]")], [cancelled; 2]);
        assert_eq!([plc.is("OUTSEP[3]"), plc.is("INSIP[1]")], [!cancelled; 2]);
        assert!(
            !plc.is("INSEP[8]") && plc.is("OUTSEP[4]"),
            "the spindle has a bit of its own"
        );
    }
}

const STOPPED: [&str; 3] = ["db31_dbx110_5", "db32_dbx110_5", "db33_dbx110_5"];

/// All three axes say so in the cycles that follow.
fn axes(plc: &mut Printed, of: &[&'static str; 3]) {
    plc.on.retain(|on| !on.contains("dbx111"));
    plc.on.extend(of);
}

/// The forced checking from its start to the test of the inputs and outputs.
fn up_to_phase_3(plc: &mut Printed) {
    plc.set(ESTOP).set(DOOR).run(1).pulse(ACK);
    // 8 hours, three times 2 h 40 min, less a moment.
    plc.run(3 * 9_600 - 10);
    plc.on.extend(STOPPED);
    plc.clear(DOOR).run(5);
    assert!(!plc.is("M211.0"), "not before 8 hours");
    plc.run(20);
    assert!(plc.is("M211.0") && plc.is("M211.1"));
    plc.pulse("fc60_1_ready");
    plc.pulse("fc60_2_ready");
    plc.run(1);
    assert!(!plc.is("M211.1"));
    let d = ["db31_dbx111_6", "db32_dbx111_6", "db33_dbx111_6"];
    let c = ["db31_dbx111_5", "db32_dbx111_5", "db33_dbx111_5"];
    let a = ["db31_dbx111_4", "db32_dbx111_4", "db33_dbx111_4"];
    for (stop, request) in [(d, "M216.1"), (c, "M216.2"), (a, "M216.3")] {
        plc.run(3);
        assert!(plc.is(request), "{request} waits for its stop on all axes");
        axes(plc, &stop);
        plc.run(1);
        assert!(!plc.is(request), "{request}");
    }
    axes(plc, &["", "", ""]);
    plc.run(1);
    for stop in [d, c, a] {
        axes(plc, &stop);
        plc.run(1);
    }
    axes(plc, &["", "", ""]);
    plc.run(1);
}

const WATCHED: [&str; 10] = [
    "M211.0",
    "M211.1",
    "M216.1",
    "M216.2",
    "M216.3",
    "A48.1",
    "MARKERSIP[5]",
    "M218.7",
    "M218.1",
    "M218.0",
];

/// S840D-TESTSTOP-701, S840D-TESTSTOP-702, S840D-TESTSTOP-703, S840D-TESTSTOP-705, S840D-TESTSTOP-708, S840D-TESTSTOP-709,
/// S840D-TESTSTOP-711, S840D-TESTSTOP-713.
#[test]
fn the_forced_checking() {
    let mut plc = Printed::new("forced-checking", &WATCHED, 1_000);
    up_to_phase_3(&mut plc);
    assert!(
        plc.is("M218.0") && !plc.is("A48.1"),
        "the supply of the button is off"
    );
    // Without its supply the button reads 0; the contactors drop out.
    plc.clear(ESTOP).set(DROPPED).run(1);
    assert!(plc.is("A48.1") && plc.is("M218.1") && !plc.is("M218.7"));
    plc.set(ESTOP).run(1);
    assert!(plc.is("MARKERSIP[5]"), "the acknowledgement of the PLC");
    plc.run(6);
    assert!(
        !plc.is("MARKERSIP[5]") && !plc.is("M211.0"),
        "the eight hours begin again"
    );
}

/// S840D-TESTSTOP-709, S840D-TESTSTOP-710.
#[test]
fn a_contactor_that_does_not_drop_out() {
    let mut plc = Printed::new("forced-checking", &WATCHED, 1_000);
    up_to_phase_3(&mut plc);
    plc.clear(ESTOP).run(4);
    assert!(
        plc.is("M218.7") && plc.is("A48.1"),
        "STOP D, and the supply is back"
    );
    plc.set(ESTOP).run(50);
    assert!(plc.is("M218.7"), "nothing but RESET ends it");
    plc.pulse(RESET);
    assert!(
        plc.is("M218.7"),
        "not before the contactors have dropped out"
    );
    plc.set(DROPPED).pulse(RESET);
    assert!(!plc.is("M218.7") && plc.is("M218.1"));
}

/// S840D-TESTSTOP-715, S840D-TESTSTOP-719, S840D-TESTSTOP-721: as printed, the eight hours do not begin again.
#[test]
fn an_emergency_stop_within_the_test_of_the_inputs() {
    let mut plc = Printed::new("forced-checking", &WATCHED, 1_000);
    up_to_phase_3(&mut plc);
    plc.clear(ESTOP).set(DROPPED).run(1);
    assert!(plc.is("M218.1"));
    // The contactors close again, and the acknowledgement waits without an end.
    plc.set(ESTOP).clear(DROPPED).run(100);
    assert!(plc.is("M218.1") && !plc.is("MARKERSIP[5]"));
    // The button is pressed.
    plc.clear(ESTOP).run(3);
    assert!(!plc.is("M218.1"), "the test is aborted");
    plc.set(ESTOP).set(DROPPED).pulse(ACK);
    plc.run(3 * 9_600 + 100);
    assert!(
        plc.is("M211.0") && !plc.is("M211.1"),
        "nor does any other test"
    );
}

/// S840D-TESTSTOP-707: the sequence waits at its step.
#[test]
fn an_emergency_stop_within_the_test_of_the_stops() {
    let mut plc = Printed::new("forced-checking", &WATCHED, 1_000);
    plc.set(ESTOP).run(1).pulse(ACK);
    plc.on.extend(STOPPED);
    plc.run(3 * 9_600 + 10);
    plc.pulse("fc60_1_ready").pulse("fc60_2_ready").run(2);
    assert!(plc.is("M216.1"));
    plc.clear(ESTOP).run(30).set(ESTOP).pulse(ACK);
    assert!(plc.is("M216.1"));
    axes(
        &mut plc,
        &["db31_dbx111_6", "db32_dbx111_6", "db33_dbx111_6"],
    );
    plc.run(1);
    assert!(plc.is("M216.2"));
}

/// S840D-EXAMPLE-723: STOP A and STOP D are de-selected for good, STOP C while the light barrier is free.
#[test]
fn the_light_barrier() {
    let bits = [
        "OUTSIP[1]",
        "DB31.DBX32.2",
        "DB33.DBX32.4",
        "DB31.DBX32.3",
        "DB33.DBX32.3",
    ];
    let mut plc = Printed::new("light-barrier", &bits, 100);
    plc.run(1);
    assert_eq!(
        bits.map(|bit| plc.is(bit)),
        [true, true, true, false, false]
    );
    plc.set("input_32_0").run(1);
    assert_eq!(bits.map(|bit| plc.is(bit)), [true; 5]);
}

/// S840D-BRAKE-715: what releases the brake, and what only the output of the PLC has beside it; S840D-BRAKE-716: the speed controller
/// decides.
#[test]
fn the_brake() {
    let bits = ["INSIP[1]", "OUTSEP[1]", "A2.0"];
    let inputs = [
        "db31_dbx111_4",
        "db31_dbx108_2",
        "db31_dbx93_7",
        "db31_dbx61_6",
        "markersip_1",
        "db31_dbx61_5",
        "db10_dbx104_7",
    ];
    let mut plc = Printed::new("brake", &bits, 100);
    let mut released = 0;
    for k in 0..128_u32 {
        let is = |n: usize| k >> n & 1 == 1;
        let on = inputs.iter().enumerate().filter(|(n, _)| is(*n));
        plc.on = on.map(|(_, input)| *input).collect();
        plc.run(1);
        let compared = !is(0) && !is(1) && is(2) && is(3) && is(4);
        assert_eq!(plc.is("INSIP[1]"), is(0));
        assert_eq!(plc.is("OUTSEP[1]"), compared, "{:?}", plc.on);
        assert_eq!(plc.is("A2.0"), compared && is(5) && is(6), "{:?}", plc.on);
        released += usize::from(compared);
    }
    assert_eq!(released, 4);
}
