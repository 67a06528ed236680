//! The example machine of chapter 10.3, its half in the NCK as it is printed, step by step: each test names the rows that it walks
//! through. An IPO cycle has 50 ms here, so that 5 s are not too many of them.

use stillpoint_logic::spf::Interface;

use super::rig::{Spl, interface, output};

const PRINTED: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../tests/machines/emergency-stop-840d.spf"
);

/// The printed program, once for each pair of bits that is watched.
struct Nck {
    parts: Vec<([&'static str; 2], Spl)>,
    /// Inputs that are 1.
    on: Vec<&'static str>,
    seen: Vec<(&'static str, bool)>,
}

const ESTOP: &str = "inse_1";
const DOOR: &str = "inse_2";
const ACK: &str = "inse_4";
const KEY: &str = "inse_5";
const TEST_A: &str = "inse_11";
const TEST_C: &str = "inse_12";
const TEST_D: &str = "inse_13";
/// The request of the PLC, a byte.
const REQUEST: &str = "dbb_4";

const NOT_HALT: &str = "MARKERSI[2]";
const QUIT_REQUEST: &str = "MARKERSI[3]";
const QUIT_MARKER: &str = "MARKERSI[4]";
const SPINDLE_A: &str = "OUTSI[1]";
const AXES_A: &str = "OUTSI[2]";
const STOP_C: &str = "OUTSI[3]";
const STOP_D: &str = "OUTSI[4]";
const K2: &str = "OUTSE[1]";

impl Nck {
    fn new(bits: &[[&'static str; 2]]) -> Self {
        let text = std::fs::read_to_string(PRINTED).expect("readable");
        let blocks = text.trim_end().strip_suffix("N1070 M17").expect("its end");
        let part = |pair: &[&'static str; 2]| {
            let wired = Interface {
                inputs: Vec::new(),
                outputs: vec![
                    ("p".to_owned(), output(pair[0])),
                    ("q".to_owned(), output(pair[1])),
                    ("n".to_owned(), output("AC_MARKER[1]")),
                ],
                ..interface()
            };
            (*pair, Spl::new(blocks, &wired, 50_000))
        };
        Self {
            parts: bits.iter().map(part).collect(),
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
            self.seen.clear();
            for (pair, spl) in &mut self.parts {
                let [p, q, _] = spl.step(&inputs);
                self.seen.extend([(pair[0], p == 1), (pair[1], q == 1)]);
            }
        }
        self
    }

    /// A cycle with an input that is 1 in it alone.
    fn pulse(&mut self, input: &'static str) -> &mut Self {
        self.set(input).run(1).clear(input)
    }

    /// A bit that is watched.
    fn is(&self, bit: &str) -> bool {
        let found = self.seen.iter().find(|(of, _)| *of == bit);
        found.unwrap_or_else(|| panic!("{bit} is not watched")).1
    }
}

/// S840D-EXAMPLE-701, S840D-EXAMPLE-702, S840D-EXAMPLE-703, S840D-EXAMPLE-704, S840D-EXAMPLE-705, S840D-EXAMPLE-707, S840D-TIMING-703/a.
#[test]
fn the_emergency_stop() {
    let mut nck = Nck::new(&[[NOT_HALT, STOP_C], [AXES_A, SPINDLE_A], [K2, STOP_D]]);
    let all = [NOT_HALT, STOP_C, K2, AXES_A, SPINDLE_A];
    let on = |nck: &Nck| all.map(|bit| nck.is(bit));
    nck.set(ESTOP).run(3);
    assert_eq!(on(&nck), [false; 5], "nothing before the acknowledgement");
    nck.pulse(ACK);
    assert_eq!(on(&nck), [true; 5]);
    nck.run(200);
    assert_eq!(on(&nck), [true; 5]);
    // The button is pressed: STOP C and the contactor at once, STOP A when more than 1 s and 5 s are over.
    nck.clear(ESTOP).run(1);
    assert_eq!(on(&nck), [false, false, false, true, true]);
    nck.pulse(ACK);
    assert!(!nck.is(NOT_HALT), "an acknowledgement while it is pressed");
    nck.run(19);
    assert!(nck.is(AXES_A), "1 s");
    nck.run(1);
    assert!(!nck.is(AXES_A) && nck.is(SPINDLE_A));
    nck.run(79);
    assert!(nck.is(SPINDLE_A), "5 s");
    nck.run(1);
    assert_eq!(on(&nck), [false; 5]);
    // Released in time, no STOP A comes; pressed again, its time begins again.
    nck.set(ESTOP).pulse(ACK);
    nck.clear(ESTOP).run(15).set(ESTOP).pulse(ACK);
    nck.run(100);
    assert_eq!(on(&nck), [true; 5]);
    nck.clear(ESTOP).run(21);
    assert!(nck.is(AXES_A), "not sooner than 1 s after the second one");
    nck.run(1);
    assert!(!nck.is(AXES_A));
}

/// S840D-EXAMPLE-702, S840D-EXAMPLE-703, S840D-EXAMPLE-704, S840D-EXAMPLE-706, S840D-EXAMPLE-709, S840D-EXAMPLE-710.
#[test]
fn tests_door_and_key() {
    let mut nck = Nck::new(&[
        [STOP_C, STOP_D],
        [AXES_A, SPINDLE_A],
        ["OUTSI[5]", "OUTSI[6]"],
    ]);
    nck.set(ESTOP).pulse(ACK);
    for k in 0..32_u32 {
        let inputs = [TEST_A, TEST_C, TEST_D, KEY, DOOR];
        let is = |n: usize| k >> n & 1 == 1;
        nck.on = vec![ESTOP];
        let on = inputs.iter().enumerate().filter(|(n, _)| is(*n));
        nck.on.extend(on.map(|(_, input)| *input));
        nck.run(1);
        assert_eq!([nck.is(AXES_A), nck.is(SPINDLE_A)], [!is(0); 2]);
        assert_eq!([nck.is(STOP_C), nck.is(STOP_D)], [!is(1), !is(2)]);
        assert_eq!(nck.is("OUTSI[5]"), is(3) || is(4), "SBH by key or door");
        assert_eq!(nck.is("OUTSI[6]"), is(4), "the stage by the door");
    }
}

/// S840D-TESTSTOP-712, S840D-TESTSTOP-714: for one cycle, and only after less than 0.4 s.
#[test]
fn the_acknowledgement_of_the_plc() {
    for cycles in 1..12 {
        let mut nck = Nck::new(&[[NOT_HALT, QUIT_MARKER], [QUIT_REQUEST, STOP_C]]);
        nck.set(ESTOP).pulse(ACK).run(5);
        nck.clear(ESTOP).run(cycles).set(ESTOP).run(30);
        assert!(!nck.is(NOT_HALT), "not by itself");
        nck.set(REQUEST).run(1);
        let accepted = 50 * cycles < 400;
        assert!(nck.is(QUIT_REQUEST));
        assert_eq!([nck.is(NOT_HALT), nck.is(QUIT_MARKER)], [accepted; 2]);
        nck.run(1);
        assert_eq!(
            [nck.is(NOT_HALT), nck.is(QUIT_MARKER)],
            [accepted, false],
            "for one cycle"
        );
        nck.clear(REQUEST).run(1);
        assert!(!nck.is(QUIT_REQUEST));
    }
}

/// S840D-EXAMPLE-730: a request of the PLC alone, after power-on. S840D-EXAMPLE-731: only the last interruption counts.
/// S840D-EXAMPLE-732: a held button. These are weaknesses of the printed program.
#[test]
fn what_else_acknowledges() {
    let mut nck = Nck::new(&[[NOT_HALT, QUIT_MARKER]]);
    nck.set(ESTOP).run(5).pulse(REQUEST);
    assert!(nck.is(NOT_HALT), "nobody has pressed anything");
    // Pressed for 5 s, and a bounce as it is released.
    nck.clear(ESTOP).run(100).set(ESTOP).run(1);
    nck.clear(ESTOP).run(1).set(ESTOP).run(1);
    assert!(!nck.is(NOT_HALT));
    nck.pulse(REQUEST);
    assert!(nck.is(NOT_HALT));
    nck.set(ACK).clear(ESTOP).run(50);
    assert!(!nck.is(NOT_HALT));
    nck.set(ESTOP).run(1);
    assert!(nck.is(NOT_HALT), "the button of the emergency stop decides");
}
