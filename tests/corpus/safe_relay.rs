//! The safety relay stands in three places: as a table, as a production monitor, and in the programs of the safe logic. The first two
//! are compared by `diff`; here a program with one relay is compared with the monitor.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::LazyKind;
use stillpoint_logic::spf::{Interface, Mode, Output, Readings, parse};
use stillpoint_logic::st::Signature;
use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinumerik::relay::{Config, Inputs, Monitor, State};
use stillpoint_tests::root;

/// A cycle of the safe logic in microseconds.
const CYCLE: u64 = 10_000;

/// A relay with TM1 of 3 cycles, TI1 to TI3 of 0, 1 and 3.
const PROGRAM: &str = r#"DEF INT S
SIRELIN(1, S, "$A_INSE[1]", "$A_MARKERSI[1]", "$A_INSE[3]", "$A_INSE[4]", "$A_INSE[5]")
SIRELOUT(1, S, "$A_OUTSE[1]", "$A_OUTSE[2]", "$A_OUTSE[3]", "$A_OUTSE[4]")
SIRELTIME(1, S, 0.03, 0.0, 0.01, 0.03)
IDS=1 DO $A_MARKERSI[1] = $A_INSE[2]
IDS=2 DO $AC_MARKER[1] = SIRELAY(1)
M17
"#;

/// The program in the place of the relay of the tables.
fn program(readings: Readings) -> Bound {
    let path = root().join("spec/families/sinumerik-840d/relay.toml");
    let mut spec = Spec::load(&path).unwrap_or_else(|e| panic!("{e}"));
    let ports = ["q1", "q2", "e1", "e2", "e3"].into_iter().zip(1..);
    let outputs = ["a0", "a1", "a2", "a3"].into_iter().zip(1..);
    let variable = |text: String| text.parse().unwrap_or_else(|e| panic!("{e}"));
    let interface = Interface {
        signature: Signature::of(&spec, "relay").expect("a machine"),
        inputs: ports
            .map(|(port, k)| (variable(format!("INSE[{k}]")), port.to_owned()))
            .collect(),
        outputs: outputs
            .map(|(port, k)| {
                let variable = variable(format!("OUTSE[{k}]"));
                let inverted = false;
                (port.to_owned(), Output::Variable { variable, inverted })
            })
            .collect(),
        scan: None,
        readings,
    };
    let source: Arc<str> = Arc::from(PROGRAM);
    let compiled = parse("safe.spf", &source, Mode::Strict)
        .and_then(|program| program.compile(&interface))
        .unwrap_or_else(|e| panic!("{e}"));
    let name = toml::Spanned::new(0..0, "relay".to_owned());
    spec.replace("safe.spf", &source, &name, &compiled.machine)
        .unwrap_or_else(|e| panic!("{e}"));
    let system = spec.open_machine("relay").unwrap_or_else(|e| panic!("{e}"));
    let cycles = |us: &u64| i64::try_from(us.div_ceil(CYCLE)).expect("short");
    let times = compiled.durations.iter();
    let params: BTreeMap<_, _> = times
        .map(|(name, us)| (name.clone(), vec![cycles(us)]))
        .collect();
    Bound::new(system, &params, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"))
}

/// One cycle of the program: its next state and A0 to A3.
fn scanned(
    bound: &Bound,
    frame: &mut Frame,
    state: &[i32],
    inputs: &[(&str, bool)],
) -> (Vec<i32>, [bool; 4]) {
    frame.start(state);
    let mut read = |k: usize| {
        let name = bound.system.inputs[k].name.rsplit('.').next();
        let found = inputs.iter().find(|(input, _)| name == Some(input));
        found.map_or(0, |(_, is)| i32::from(*is))
    };
    bound.step(frame, &mut read).expect("no fault");
    let mut shown = [false; 4];
    for (k, lazy) in bound.system.lazies.iter().enumerate() {
        let name = lazy.name.rsplit('.').next();
        let place = ["a0", "a1", "a2", "a3"]
            .iter()
            .position(|a| name == Some(a));
        if let (LazyKind::Output, Some(place)) = (lazy.kind, place) {
            shown[place] = bound.lazy(k, frame, &mut read) != 0;
        }
    }
    (frame.now.clone(), shown)
}

/// How many pairs of states program and monitor can be in together, over every input of every one of them.
///
/// # Errors
/// They differ.
fn together(readings: Readings) -> Result<usize, String> {
    let bound = program(readings);
    let mut frame = Frame::new(&bound);
    let cycles = Cycles::new;
    let config = Config::new(cycles(3), cycles(0), cycles(1), cycles(3)).expect("short");
    let states = bound.system.states.iter();
    let first: Vec<i32> = states
        .map(|s| s.init.as_ref().map_or(0, |e| bound.constant(e) as i32))
        .collect();
    let key = |state: &Vec<i32>, monitor: &State| (state.clone(), format!("{monitor:?}"));
    let mut known = BTreeSet::from([key(&first, &State::INITIAL)]);
    let mut open = VecDeque::from([(first, State::INITIAL)]);
    let mut shown = BTreeSet::new();
    while let Some((state, monitor)) = open.pop_front() {
        for bits in 0..32 {
            let is = |k: u32| bits >> k & 1 == 1;
            let inputs = Inputs {
                power_on: false,
                q1: is(0),
                q2: is(1),
                e1: is(2),
                e2: is(3),
                e3: is(4),
            };
            let given = ["q1", "q2", "e1", "e2", "e3"]
                .into_iter()
                .zip((0..).map(is));
            let given: Vec<(&str, bool)> = given.collect();
            let (next, program) = scanned(&bound, &mut frame, &state, &given);
            let mut relay = Monitor::resume(config, monitor).expect("a consistent state");
            let outputs = relay.step(&inputs);
            let expected = [outputs.a0, outputs.a1, outputs.a2, outputs.a3];
            if program != expected {
                return Err(format!(
                    "{program:?} and {expected:?}: {monitor:?} {inputs:?}"
                ));
            }
            shown.insert(program);
            if known.insert(key(&next, &relay.state())) {
                open.push_back((next, relay.state()));
            }
        }
    }
    // Nothing on; all on; the delays of A2 and A3, of A3 alone.
    assert_eq!(shown.len(), 4, "{shown:?}");
    Ok(known.len())
}

/// S840D-RELAY-001, S840D-RELAY-002, S840D-RELAY-003, S840D-RELAY-004, S840D-RELAY-005, S840D-RELAY-006, S840D-RELAY-015,
/// S840D-RELAY-017, S840D-RELAY-018.
#[test]
fn a_relay_of_the_safe_logic_does_what_the_monitor_does() {
    let readings = Readings {
        first_sample_is_no_edge: true,
        ..Readings::default()
    };
    let states = together(readings).unwrap_or_else(|e| panic!("{e}"));
    assert!(states > 50, "{states} states");
    // The other readings are another relay: a button that is pressed since before the run-up, and one that is held.
    together(Readings::default()).expect_err("an edge in the first cycle");
    let relay_acknowledged_by_level = true;
    together(Readings {
        relay_acknowledged_by_level,
        ..readings
    })
    .expect_err("an acknowledgement by level");
}
