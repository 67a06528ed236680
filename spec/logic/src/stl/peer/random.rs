//! Random programs with random inputs, in their tables and in the interpreter.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::LazyKind;

use super::super::{Bit, Interface, Output, Program, parse};
use super::Machine;
use crate::st::Signature;

/// Numbers that look random and are the same in each run (xorshift).
struct Random(u64);

/// What a program may still use.
struct Room {
    english: bool,
    timers: Vec<u16>,
    labels: u32,
    /// Bits that keep the result for an edge.
    edges: u32,
    relay: bool,
}

impl Room {
    /// The word of the program's language.
    fn word(&self, german: &'static str, english: &'static str) -> &'static str {
        if self.english { english } else { german }
    }
}

const KINDS: [(&str, &str); 5] = [
    ("SI", "SP"),
    ("SV", "SE"),
    ("SE", "SD"),
    ("SS", "SS"),
    ("SA", "SF"),
];

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

    fn input(&mut self, room: &Room) -> String {
        let letter = room.word("E", "I");
        format!("{letter} {}", self.of(&["0.0", "0.1", "1.0", "1.7"]))
    }

    fn state(&mut self, room: &Room) -> String {
        match self.below(7) {
            0 => format!("{} 4.0", room.word("A", "Q")),
            1 => "\"SPL\".OUT".to_owned(),
            2 => "MARKERSIP[1]".to_owned(),
            3 => "DB31.DBX 22.1".to_owned(),
            4 => "M 3.5".to_owned(),
            _ => format!("M 2.{}", self.below(4)),
        }
    }

    fn source(&mut self, room: &Room) -> String {
        match self.below(5) {
            0 | 1 => self.input(room),
            2 => format!("T {}", 1 + self.below(4)),
            _ => self.state(room),
        }
    }

    /// A string of checks.
    fn checks(&mut self, room: &mut Room, depth: u32, out: &mut String) {
        let count = 1 + self.below(4);
        for k in 0..count {
            let word = match self.below(7) {
                0 | 1 => room.word("U", "A"),
                2 => room.word("UN", "AN"),
                3 => "O",
                4 => "ON",
                5 => "X",
                _ => "XN",
            };
            match self.below(9) {
                0 if depth > 0 => {
                    let _ = writeln!(out, "{word}(");
                    self.checks(room, depth - 1, out);
                    out.push_str(")\n");
                }
                1 if k > 0 => {
                    out.push_str("O\n");
                    let and = room.word("U", "A");
                    let source = self.source(room);
                    let _ = writeln!(out, "{and} {source}");
                }
                2 if depth < 2 => {
                    let open = room.word("U(", "A(");
                    let relation = self.of(&["==", "<>", ">", "<", ">=", "<="]);
                    let (a, b) = (self.of(&["MB 8", "MB 9", "2", "MW 20"]), self.below(4));
                    let _ = writeln!(out, "{open}\nL {a}\nL {b}\n{relation}I\n)");
                }
                _ => {
                    let source = self.source(room);
                    let _ = writeln!(out, "{word} {source}");
                }
            }
            if self.one_in(12) {
                out.push_str("NOT\n");
            }
            if self.one_in(12) {
                room.edges += 1;
                let word = self.of(&["FP", "FN"]);
                let _ = writeln!(out, "{word} M 50.{}", room.edges % 8);
            }
        }
    }

    /// What uses the result.
    fn consumers(&mut self, room: &mut Room, out: &mut String) {
        for _ in 0..1 + self.below(3) {
            match self.below(8) {
                0 | 1 => {
                    let to = self.state(room);
                    let _ = writeln!(out, "S {to}");
                }
                2 | 3 => {
                    let to = self.state(room);
                    let _ = writeln!(out, "R {to}");
                }
                4 if !room.timers.is_empty() => {
                    let number = room.timers.remove(0);
                    // T 4 alone is an off-delay, which nothing resets.
                    let kind = if number == 4 {
                        4
                    } else {
                        self.below(4) as usize
                    };
                    let word = room.word(KINDS[kind].0, KINDS[kind].1);
                    let time = self.of(&["S5T#10MS", "S5T#20MS", "S5T#30MS", "S5T#50MS"]);
                    let _ = writeln!(out, "L {time}\n{word} T {number}");
                }
                5 => {
                    let _ = writeln!(out, "R T {}", 1 + self.below(3));
                }
                6 => out.push_str("NOT\n"),
                _ => {
                    let to = self.state(room);
                    let _ = writeln!(out, "= {to}");
                }
            }
        }
    }

    fn block(&mut self, room: &mut Room, depth: u32, out: &mut String) {
        match self.below(10) {
            0 if depth > 0 => {
                room.labels += 1;
                let label = format!("L{}", room.labels);
                self.checks(room, 1, out);
                let jump = match self.below(4) {
                    0 => room.word("SPBN", "JCN"),
                    _ => room.word("SPB", "JC"),
                };
                let _ = writeln!(out, "{jump} {label}");
                if self.one_in(4) {
                    // Who has not jumped has a result of 1.
                    let to = self.state(room);
                    let _ = writeln!(out, "= {to}");
                }
                for _ in 0..1 + self.below(3) {
                    self.block(room, depth - 1, out);
                }
                if self.one_in(4) {
                    room.labels += 1;
                    let over = format!("L{}", room.labels);
                    let _ = writeln!(out, "{} {over}\n{label}: NOP 0", room.word("SPA", "JU"));
                    self.block(room, depth - 1, out);
                    let _ = writeln!(out, "{over}: NOP 1");
                } else {
                    let _ = writeln!(out, "{label}:");
                    self.block(room, 0, out);
                }
            }
            1 => {
                let value = self.of(&["0", "1", "3", "MB 9", "MB 8"]);
                let to = self.of(&["MB 8", "MB 9"]);
                let _ = writeln!(out, "L {value}\nT {to}");
            }
            2 => {
                let _ = writeln!(
                    out,
                    "L {}\nT {}",
                    self.below(4),
                    self.of(&["MB 2", "MW 2", "MW 20"])
                );
            }
            3 => {
                out.push_str(self.of(&["SET\n", "CLR\n"]));
                self.consumers(room, out);
            }
            4 if room.relay => {
                room.relay = false;
                let letter = room.word("E", "I");
                let _ = writeln!(
                    out,
                    "CALL FB 10, DB 80 (\n In1 := {letter} 0.0,\n Quit1 := {letter} 0.1, // button\n Quit2 := M 2.1,\n TimeValue1 := T#25MS,\n Out0 := \"SPL\".OUT,\n Out1 := M 2.2,\n FirstRun := M 60.0)"
                );
            }
            _ => {
                self.checks(room, 2, out);
                self.consumers(room, out);
            }
        }
    }

    fn program(&mut self) -> String {
        let mut room = Room {
            english: self.one_in(3),
            timers: vec![1, 2, 3, 4],
            labels: 0,
            edges: 0,
            relay: self.one_in(3),
        };
        let mut text = "SYMBOLS\n\"SPL\".OUT : OUTSIP[3]\nEND_SYMBOLS\n".to_owned();
        text += "ORGANIZATION_BLOCK OB 100\nSET\nS M 60.0\nS M 2.3\nL 3\nT MB 9\nEND_ORGANIZATION_BLOCK\n";
        let mut called = String::new();
        for _ in 0..1 + self.below(3) {
            self.block(&mut room, 1, &mut called);
        }
        if self.one_in(2) {
            let and = room.word("U", "A");
            let source = self.input(&room);
            let end = room.word("BEB", "BEC");
            called += &format!("{and} {source}\n{end}\n");
            self.block(&mut room, 0, &mut called);
        }
        text += &format!(
            "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\nTITLE =a part\n{called}END_FUNCTION\nORGANIZATION_BLOCK OB 1\n"
        );
        for _ in 0..2 + self.below(5) {
            self.block(&mut room, 2, &mut text);
        }
        match self.below(3) {
            0 => text += "CALL FC 1\n",
            1 => {
                let and = room.word("U", "A");
                let source = self.input(&room);
                text += &format!("{and} {source}\nCC FC 1\n");
            }
            _ => {}
        }
        // Whatever has not been started yet.
        while !room.timers.is_empty() {
            let number = room.timers.remove(0);
            let (and, word) = (room.word("U", "A"), room.word(KINDS[2].0, KINDS[2].1));
            let word = if number == 4 {
                room.word("SA", "SF")
            } else {
                word
            };
            text += &format!("{and} M 2.0\nL S5T#20MS\n{word} T {number}\n");
        }
        text + "END_ORGANIZATION_BLOCK\n"
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
ob1 = "BOOL"
[machine.spl.output]
p = "a"
q = "b AND ob1"
r = "a"
s = "b"
t = "b"
"#;

fn bit(text: &str) -> Bit {
    text.parse().unwrap_or_else(|e| panic!("{e}"))
}

fn interface(spec: &Spec, scan: bool) -> Interface {
    let signature = Signature::of(spec, "spl").unwrap_or_else(|e| panic!("{e}"));
    let out = |text: &str, inverted| Output::Bit {
        bit: bit(text),
        inverted,
    };
    Interface {
        signature,
        inputs: vec![(bit("E0.0"), "a".to_owned()), (bit("E0.1"), "b".to_owned())],
        outputs: vec![
            ("p".to_owned(), out("A4.0", false)),
            ("q".to_owned(), out("OUTSI[3]", true)),
            ("r".to_owned(), out("M2.1", false)),
            ("s".to_owned(), out("M2.2", false)),
            ("t".to_owned(), out("DB31.DBX22.1", false)),
        ],
        scan: scan.then(|| "ob1".to_owned()),
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
    let mut random = Random(0x0571_5EED);
    let (mut programs, mut relays, mut timed, mut lively, mut refused) = (0, 0, 0, 0, 0);
    let mut total = Tried::default();
    while programs < 1_500 {
        let text = random.program();
        let source: Arc<str> = Arc::from(text.as_str());
        let program = parse("x.stl", &source).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let scan = random.one_in(3);
        let interface = interface(&spec, scan);
        let compiled = match program.compile(&interface) {
            Ok(compiled) => compiled,
            Err(e) => {
                // A label or a call leaves a result unknown, or a string of checks without use.
                let told = e.to_string();
                let known = [
                    "result of the logic",
                    "lead to nothing",
                    "are used, and it is given",
                    "as a number",
                    "share bytes",
                    "gives it one",
                ];
                assert!(known.iter().any(|k| told.contains(k)), "{told}\n{text}");
                refused += 1;
                assert!(refused < 4_000, "{told}\n{text}");
                continue;
            }
        };
        let mut own = spec.clone();
        let name = toml::Spanned::new(0..0, "spl".to_owned());
        own.replace("x.stl", &source, &name, &compiled.machine)
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        let system = own
            .open_machine("spl")
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        // The time of a cycle: times are whole cycles of some.
        let cycle = [2_000, 3_000, 5_000, 7_000, 10_000, 12_000][random.below(6) as usize];
        let params: BTreeMap<String, Vec<i64>> = (compiled.durations.iter())
            .map(|(name, us)| (name.clone(), vec![(us.div_ceil(cycle)) as i64]))
            .collect();
        let bound =
            Bound::new(system, &params, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let tried = both(&bound, &program, &interface, cycle as i64, &mut random);
        programs += 1;
        relays += u32::from(text.contains("FB 10"));
        timed += u32::from(!compiled.durations.is_empty());
        lively += u32::from(tried.changes > 10);
        total.cycles += tried.cycles;
        total.changes += tried.changes;
    }
    println!(
        "{programs} programs, {refused} refused, {relays} with a relay, {timed} with times, {lively} lively; {} cycles, {} changes",
        total.cycles, total.changes
    );
    assert!(
        relays > 200 && timed > 700 && lively > 500,
        "{relays} {timed} {lively}"
    );
    assert!(total.changes > 20_000, "{} changes", total.changes);
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
    let mut tried = Tried::default();
    let inputs = ["E0.0", "E0.1", "E1.0", "E1.7"].map(bit);
    for _ in 0..4 {
        let (mut state, mut frame) = (first.clone(), Frame::new(bound));
        let mut machine = Machine::new(program);
        let mut before: Option<Vec<i64>> = None;
        let mut levels = [false; 4];
        for at in 0..40 {
            // Levels that stay for a while.
            for level in &mut levels {
                *level = *level != random.one_in(4);
            }
            let runs = !random.one_in(3);
            let scanned = interface.scan.is_none() || runs;
            if scanned {
                for (input, level) in inputs.iter().zip(levels) {
                    machine.set(*input, level);
                }
                machine.cycle();
            }
            machine.now += cycle;
            frame.start(&state);
            let mut read = |k: usize| {
                let var = &bound.system.inputs[k];
                let name = var.name.strip_prefix("spl.").unwrap_or_default();
                match name {
                    "ob1" => i32::from(runs),
                    "a" => i32::from(levels[0]),
                    "b" => i32::from(levels[1]),
                    other => {
                        let found = inputs.iter().position(|i| i.identifier() == other);
                        // What nothing writes is 0 on both sides.
                        found.map_or(0, |found| i32::from(levels[found]))
                    }
                }
            };
            let stepped = bound.step(&mut frame, &mut read);
            assert!(stepped.is_ok(), "cycle {at} of\n{}", program.source);
            let mut outputs = Vec::new();
            for (k, lazy) in bound.system.lazies.iter().enumerate() {
                let name = lazy.name.strip_prefix("spl.").unwrap_or_default();
                let given = interface.outputs.iter().find(|(port, _)| port == name);
                let (LazyKind::Output, Some((_, Output::Bit { bit, inverted }))) =
                    (lazy.kind, given)
                else {
                    continue;
                };
                let is = bound.lazy(k, &mut frame, &mut read);
                let value = i64::from(machine.bit(*bit) != *inverted);
                assert_eq!(
                    is, value,
                    "{name} in cycle {at} of {cycle} µs\n{}",
                    program.source
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
