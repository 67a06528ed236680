//! Random programs with random inputs, in their tables and in the interpreter.

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::LazyKind;

use super::super::{Interface, Mode, Output, Program, Readings, Variable, parse};
use super::Machine;
use crate::st::Signature;

/// Numbers that look random and are the same in each run (xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % n
    }

    fn of<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len() as u64) as usize]
    }

    fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    fn truth(&mut self) -> &'static str {
        self.of(&[
            "A",
            "A",
            "$A_INSE[2]",
            "$A_INSI[3]",
            "$A_PLCSIIN[1]",
            "$VA_DPE[X1]",
            "$A_OUTSE[1]",
            "$A_OUTSE[2]",
            "$A_OUTSI[7]",
            "$A_MARKERSI[1]",
            "$A_MARKERSI[1]",
            "$A_MARKERSI[2]",
            "M3",
            "$A_MARKERSI[4]",
            "TRUE",
            "$A_PLCSIOUT[5]",
        ])
    }

    fn compare(&mut self) -> String {
        let order = self.of(&["==", "<>", ">", "<", ">=", "<="]);
        match self.below(6) {
            0..=2 => {
                // Whole cycles of some and not of others.
                let limit = self.of(&[
                    "0.01", "0.02", "0.0305", "0.004", "0.0", "0.012", "-1.0", "1",
                ]);
                let timer = self.of(&["$A_TIMERSI[1]", "$A_TIMERSI[1]", "T2"]);
                match self.one_in(4) {
                    true => format!("({limit} {order} {timer})"),
                    false => format!("({timer} {order} {limit})"),
                }
            }
            3 => format!(
                "($A_DBB[{}] {order} {})",
                self.of(&["4", "5"]),
                self.below(6)
            ),
            4 => {
                let of = self.of(&["$AC_MARKER[1]", "$AC_MARKER[2]", "$A_STOPESI"]);
                format!("({of} {order} {})", self.of(&["0", "2", "5", "-3"]))
            }
            _ => format!("({} {order} {})", "$A_XFAULTSI", self.below(4)),
        }
    }

    fn expr(&mut self, depth: u32) -> String {
        match self.below(if depth == 0 { 2 } else { 7 }) {
            0 => self.truth().to_owned(),
            1 if self.one_in(2) => self.compare(),
            1 => {
                let order = self.of(&["==", "<>"]);
                let with = self.of(&["0", "1", "TRUE", "FALSE"]);
                format!("({} {order} {with})", self.of(&["A", "M3", "$A_OUTSI[7]"]))
            }
            2 => format!("NOT {}", self.truth()),
            3 => format!("NOT ({})", self.expr(depth - 1)),
            _ => {
                let word = self.of(&["AND", "OR", "XOR"]);
                format!(
                    "({}) {word} ({})",
                    self.expr(depth - 1),
                    self.expr(depth - 1)
                )
            }
        }
    }

    fn assign(&mut self) -> String {
        match self.below(8) {
            0 | 1 => {
                let timer = self.of(&["$A_TIMERSI[1]", "T2"]);
                format!(
                    "{timer} = {}",
                    self.of(&["0", "0.0", "0", "-1", "0.005", "-1.0", "1"])
                )
            }
            2 => {
                let value = self.of(&[
                    "0",
                    "2",
                    "5",
                    "-3",
                    "$A_DBB[4]",
                    "$AC_MARKER[2]",
                    "$A_DBB[5]",
                ]);
                format!("$AC_MARKER[1] = {value}")
            }
            _ => {
                let target = self.of(&[
                    "$A_OUTSE[1]",
                    "$A_OUTSE[2]",
                    "$A_OUTSI[7]",
                    "$A_MARKERSI[1]",
                    "$A_MARKERSI[1]",
                    "$A_MARKERSI[2]",
                    "M3",
                ]);
                match self.one_in(3) {
                    true => format!("{target} = {}", self.below(2)),
                    false => format!("{target} = {}", self.expr(2)),
                }
            }
        }
    }

    fn program(&mut self) -> String {
        let mut text = "%_N_SAFE_SPF\nDEFINE A AS $A_INSE[1]\nDEFINE M3 AS $A_MARKERSI[3]\n\
                        DEFINE T2 AS $A_TIMERSI[2]\nDEF INT S\n"
            .to_owned();
        let relay = self.one_in(3);
        if relay {
            let more = self.of(&["", ", \"A\"", ", \"A\", \"$A_INSI[3]\""]);
            text += &format!("SIRELIN(2, S, \"$A_INSE[2]\", \"M3\", \"$A_PLCSIIN\"{more})\n")
                .replace("$A_PLCSIIN", "$A_INSI[9]");
            let (outputs, times) = match self.below(3) {
                0 => ("", ""),
                1 => (", \"$A_MARKERSI[6]\"", ", 0.012"),
                _ => (", \"$A_MARKERSI[6]\", \"$A_OUTSE[2]\"", ", 0.0, 0.021"),
            };
            text += &format!("SIRELOUT(2, S, \"$A_OUTSI[7]\"{outputs})\n");
            if !self.one_in(8) {
                text += &format!("SIRELTIME(2, S, {}{times})\n", self.of(&["0.02", "0.0155"]));
            }
        }
        let mut ids: Vec<u64> = Vec::new();
        for _ in 0..2 + self.below(8) {
            let id = 1 + self.below(255);
            if ids.contains(&id) {
                continue;
            }
            ids.push(id);
            let trigger = self.of(&["", "WHENEVER", "EVERY", "EVERY", "EVERY", "WHEN", "FROM"]);
            let condition = match trigger {
                "" => String::new(),
                _ => self.expr(2),
            };
            let count = 1 + self.below(3);
            let assigns: Vec<String> = (0..count).map(|_| self.assign()).collect();
            text += &format!("IDS={id} {trigger} {condition} DO {}\n", assigns.join(" "));
        }
        if relay {
            let id = (1..=255).find(|id| !ids.contains(id)).unwrap_or(1);
            text += &format!("IDS={id} DO $AC_MARKER[1] = SIRELAY(2)\n");
        }
        text + "M17\n"
    }
}

const SPL: &str = r#"
spec = "test/peer"
title = "t"
[machine.spl]
text = "t"
otherwise = "stay"
[machine.spl.input]
a = "BOOL"
b = "BOOL"
byte = "INT(0..7)"
ipo = "BOOL"
[machine.spl.output]
p = "a"
q = "b AND ipo"
r = "a"
s = "b"
n = "SEL(a, byte - 9, 999)"
"#;

fn variable(text: &str) -> Variable {
    text.parse().unwrap_or_else(|e| panic!("{e}"))
}

fn interface(spec: &Spec, scan: bool, readings: Readings) -> Interface {
    let signature = Signature::of(spec, "spl").unwrap_or_else(|e| panic!("{e}"));
    let out = |text: &str, inverted| Output::Variable {
        variable: variable(text),
        inverted,
    };
    Interface {
        signature,
        inputs: vec![
            (variable("INSE[1]"), "a".to_owned()),
            (variable("INSE[2]"), "b".to_owned()),
            (variable("DBB[4]"), "byte".to_owned()),
        ],
        outputs: vec![
            ("p".to_owned(), out("OUTSE[1]", false)),
            ("q".to_owned(), out("OUTSE[2]", true)),
            ("r".to_owned(), out("OUTSI[7]", false)),
            ("s".to_owned(), out("MARKERSI[1]", false)),
            ("n".to_owned(), out("AC_MARKER[1]", false)),
        ],
        scan: scan.then(|| "ipo".to_owned()),
        readings,
    }
}

/// What became of one program.
#[derive(Default)]
struct Tried {
    cycles: u32,
    /// Cycles in which an output changed.
    changes: u32,
}

#[test]
fn random_programs_do_what_their_tables_do() {
    let spec =
        Spec::from_text("peer.toml".as_ref(), Arc::from(SPL)).unwrap_or_else(|e| panic!("{e}"));
    let mut random = Random(0x5AFE_5EED);
    let (mut programs, mut relays, mut timed, mut lively) = (0, 0, 0, 0);
    let mut total = Tried::default();
    while programs < 1_500 {
        let text = random.program();
        let source: Arc<str> = Arc::from(text.as_str());
        let program =
            parse("safe.spf", &source, Mode::Strict).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let readings = Readings {
            first_sample_is_no_edge: random.one_in(4),
            timers_begin_large: random.one_in(4),
            relay_acknowledged_by_level: random.one_in(4),
        };
        let scan = random.one_in(3);
        let interface = interface(&spec, scan, readings);
        let compiled = program
            .compile(&interface)
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        let mut own = spec.clone();
        let name = toml::Spanned::new(0..0, "spl".to_owned());
        own.replace("safe.spf", &source, &name, &compiled.machine)
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        let system = own
            .open_machine("spl")
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        // The time of a cycle: limits are whole cycles of some.
        let cycle = [1_000, 2_000, 3_000, 5_000, 7_000, 10_000][random.below(6) as usize];
        let params: BTreeMap<String, Vec<i64>> = (compiled.durations.iter())
            .map(|(name, us)| (name.clone(), vec![(us.div_ceil(cycle)) as i64]))
            .collect();
        let prefixed = system.params.iter().filter_map(|p| {
            let short = p.var.name.strip_prefix("spl.").unwrap_or(&p.var.name);
            Some((p.var.name.clone(), params.get(short)?.clone()))
        });
        let prefixed: BTreeMap<String, Vec<i64>> = prefixed.collect();
        assert_eq!(prefixed.len(), params.len(), "{params:?}");
        let bound = Bound::new(system, &prefixed, &BTreeMap::new())
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        let tried = both(&bound, &program, &interface, cycle as i64, &mut random);
        programs += 1;
        relays += u32::from(text.contains("SIRELAY"));
        timed += u32::from(!compiled.durations.is_empty());
        lively += u32::from(tried.changes > 10);
        total.cycles += tried.cycles;
        total.changes += tried.changes;
    }
    println!(
        "{programs} programs, {relays} with a relay, {timed} with times, {lively} lively; {} cycles, {} changes",
        total.cycles, total.changes
    );
    assert!(
        relays > 300 && timed > 700 && lively > 500,
        "{relays} {timed} {lively}"
    );
    assert!(total.changes > 30_000, "{} changes", total.changes);
}

/// The least and the greatest number that the program writes beside one of 32 bits, with 0.
fn constants(program: &Program) -> (i64, i64) {
    let text = program.to_string();
    let words: Vec<&str> = text.split([' ', '(', ')', '\n']).collect();
    let long = |word: &str| word.starts_with("$AC_MARKER") || word.starts_with("$A_STOPESI");
    let beside = words.windows(3).filter(|w| long(w[0])).map(|w| w[2]);
    let numbers = beside.filter_map(|word| match word {
        "SIRELAY" => Some(7),
        word => word.parse().ok(),
    });
    let all: Vec<i64> = numbers.chain([0]).collect();
    (
        all.iter().min().copied().unwrap_or(0),
        all.iter().max().copied().unwrap_or(0),
    )
}

/// Runs both side by side, from the beginning a few times.
fn both(
    bound: &Bound,
    program: &Program,
    interface: &Interface,
    cycle: i64,
    random: &mut Random,
) -> Tried {
    let states = bound.system.states.iter();
    let first: Vec<i32> = states
        .map(|s| {
            s.init
                .as_ref()
                .map_or(0, |init| bound.constant(init) as i32)
        })
        .collect();
    let (least, most) = constants(program);
    let mut tried = Tried::default();
    let free = [
        "INSI[3]",
        "INSI[9]",
        "PLCSIIN[1]",
        "VA_DPE[X1]",
        "DBB[5]",
        "AC_MARKER[2]",
        "STOPESI",
        "XFAULTSI",
        "PLCSIOUT[5]",
    ];
    for _ in 0..4 {
        let (mut state, mut frame) = (first.clone(), Frame::new(bound));
        let mut machine = Machine::new(program, interface.readings, cycle);
        let mut before: Option<Vec<i64>> = None;
        let (mut a, mut b) = (0, 0);
        for at in 0..40 {
            // Levels that stay for a while.
            a = if random.one_in(4) { 1 - a } else { a };
            b = if random.one_in(3) { 1 - b } else { b };
            let runs = !random.one_in(3);
            let mut inputs = vec![
                ("a", variable("INSE[1]"), a),
                ("b", variable("INSE[2]"), b),
                ("byte", variable("DBB[4]"), random.below(8) as i64),
            ];
            for text in free {
                let of = variable(text);
                let value = match text {
                    "DBB[5]" => random.below(8) as i64,
                    "XFAULTSI" => random.below(4) as i64,
                    // Far more than a program compares with: the table has one value for all of them.
                    "AC_MARKER[2]" | "STOPESI" => {
                        [-1_000, -3, -1, 0, 1, 2, 3, 5, 1_000][random.below(9) as usize]
                    }
                    _ => random.below(2) as i64,
                };
                inputs.push((text, of, value));
            }
            let scanned = interface.scan.is_none() || runs;
            if scanned {
                let given: Vec<(Variable, i64)> = inputs
                    .iter()
                    .map(|(_, of, value)| (of.clone(), *value))
                    .collect();
                machine.cycle(&given);
            }
            frame.start(&state);
            let mut read = |k: usize| {
                let var = &bound.system.inputs[k];
                let name = var.name.strip_prefix("spl.").unwrap_or_default();
                if name == "ipo" {
                    return i32::from(runs);
                }
                let found = inputs
                    .iter()
                    .find(|(port, of, _)| *port == name || of.identifier() == name);
                let value = found.map_or(0, |(_, _, value)| *value);
                let (low, high) = (bound.constant(&var.lo), bound.constant(&var.hi));
                value.clamp(low, high) as i32
            };
            let stepped = bound.step(&mut frame, &mut read);
            assert!(stepped.is_ok(), "cycle {at} of\n{}", program.source);
            let mut outputs = Vec::new();
            for (k, lazy) in bound.system.lazies.iter().enumerate() {
                let name = lazy.name.strip_prefix("spl.").unwrap_or_default();
                let given = interface.outputs.iter().find(|(port, _)| port == name);
                let (LazyKind::Output, Some((_, Output::Variable { variable, inverted }))) =
                    (lazy.kind, given)
                else {
                    continue;
                };
                let is = bound.lazy(k, &mut frame, &mut read);
                let value = machine.values.get(variable).copied().unwrap_or(0);
                let expected = match (*inverted, variable.is("AC_MARKER")) {
                    (true, _) => 1 - value,
                    // One beyond all constants stands for everything beyond.
                    (_, true) => value.clamp(least - 1, most + 1),
                    _ => value,
                };
                assert_eq!(
                    is, expected,
                    "{name} in cycle {at} of {cycle} µs, {:?}\n{}",
                    interface.readings, program.source
                );
                outputs.push(is);
            }
            tried.cycles += 1;
            tried.changes += u32::from(before.as_ref().is_some_and(|before| *before != outputs));
            before = Some(outputs);
            state.copy_from_slice(&frame.now);
        }
    }
    tried
}
