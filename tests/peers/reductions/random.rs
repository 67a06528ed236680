//! Random small systems: arrays of one machine beside another one, all forms of properties. A test, no proof.

use std::fmt::Write;

use stillpoint_engine::Reductions;

use super::{SLICE, SYMMETRY, compare, full, reduced, systems};
use crate::stages::{has_stages, same, staged};

/// Systems compared.
const SYSTEMS: u64 = 600;

/// A linear congruential generator: the same systems in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }

    fn pick(&mut self, list: &[&str]) -> String {
        list[self.below(list.len() as u64) as usize].to_owned()
    }

    /// A truth-valued expression over an axis; `names` are (variable, greatest value).
    fn condition(&mut self, names: &[(&str, u64)], depth: u64) -> String {
        if depth > 0 && self.below(2) == 0 {
            let (a, b) = (
                self.condition(names, depth - 1),
                self.condition(names, depth - 1),
            );
            let op = self.pick(&["AND", "OR"]);
            return format!("({a}) {op} ({b})");
        }
        let (name, most) = names[self.below(names.len() as u64) as usize];
        let op = self.pick(&["=", "<>", "<", ">="]);
        format!("{name} {op} {}", self.below(most + 1))
    }

    fn effect(&mut self, targets: &[(&str, u64)], names: &[(&str, u64)]) -> String {
        let mut out = String::new();
        for _ in 0..=self.below(2) {
            let (target, most) = targets[self.below(targets.len() as u64) as usize];
            let value = match self.below(6) {
                0 => format!("MIN({target} + 1, {most})"),
                1 => format!("MAX({target} - 1, 0)"),
                2 => {
                    let (name, _) = names[self.below(names.len() as u64) as usize];
                    format!("MIN({name}, {most})")
                }
                // Now and then a value that can leave its range.
                3 if self.below(12) == 0 => format!("{target} + 1"),
                _ => self.below(most + 1).to_string(),
            };
            let assign = format!("{target} := {value};");
            if self.below(3) == 0 {
                let guard = self.condition(names, 0);
                let other = self.condition(names, 0);
                let _ = match self.below(2) {
                    0 => write!(out, "IF {guard} THEN {assign} END_IF; "),
                    _ => write!(
                        out,
                        "IF {guard} THEN {} := 0; ELSIF {other} THEN {assign} END_IF; ",
                        targets[0].0
                    ),
                };
            } else {
                let _ = write!(out, "{assign} ");
            }
        }
        out
    }

    fn rules(
        &mut self,
        machine: &str,
        targets: &[(&str, u64)],
        names: &[(&str, u64)],
        own: &str,
    ) -> String {
        let mut out = String::new();
        for k in 0..=self.below(3) + 1 {
            let mut when = self.condition(names, 1);
            if self.below(2) == 0 && !own.is_empty() {
                when = format!("{own} AND ({when})");
            }
            let then = self.effect(targets, names);
            let _ = write!(
                out,
                "[[machine.{machine}.rule]]\nname = \"r{k}\"\nnote = \"n\"\nwhen = \"{when}\"\nthen = \"{then}\"\n"
            );
        }
        out
    }

    /// A property; an `even` one treats all axes alike.
    fn property(&mut self, id: usize, axes: u64, even: bool) -> String {
        let named = |i: &str| {
            vec![
                (format!("axis[{i}].x"), 2),
                (format!("PREV(axis[{i}].y)"), 1),
                (format!("axis[{i}].y"), 1),
                (format!("axis[{i}].up"), 3),
            ]
        };
        let choose = match (self.below(4), even) {
            (2, true) => 3,
            (choose, _) => choose,
        };
        let atom = |r: &mut Random| {
            let mut names = match choose {
                0 | 1 => named("i"),
                2 => named(&(r.below(axes) + 1).to_string()),
                _ => {
                    let quantifier = r.pick(&["FORALL", "EXISTS"]);
                    let inner = named("j");
                    let list: Vec<(&str, u64)> =
                        inner.iter().map(|(n, m)| (n.as_str(), *m)).collect();
                    let condition = r.condition(&list, 1);
                    return format!("{quantifier}(j IN axis, {condition})");
                }
            };
            if r.below(4) == 0 {
                names.push(("plant.z".to_owned(), 2));
            }
            let list: Vec<(&str, u64)> = names.iter().map(|(n, m)| (n.as_str(), *m)).collect();
            r.condition(&list, 1)
        };
        let (a, b, c) = (atom(self), atom(self), atom(self));
        // Copies for each axis of what follows an axis over cycles stand in the way of orbits.
        let form = match (self.below(9), even) {
            (7, true) => 8,
            (k, true) if choose < 2 => [0, 1, 2, 8][k as usize % 4],
            (k, _) => k,
        };
        let form = match form {
            0 => format!("always = \"{a}\""),
            1 => format!("when = \"{a}\"\nthen = \"{b}\""),
            2 => format!("never = \"{a}\""),
            3 => format!(
                "when = \"{a}\"\nleads_to = \"{b}\"\nwithin = \"{}\"",
                self.below(5)
            ),
            4 => format!("when = \"{a}\"\nleads_to = \"{b}\"\nfair = [\"{c}\"]"),
            5 => format!("when = \"{a}\"\nholds = \"{b}\"\nunless = \"{c}\""),
            6 => format!("can_always_reach = \"{a}\""),
            7 => {
                let axis = self.below(axes) + 1;
                let input = self.pick(&["axis[1].go", "plant.v", "axis[2].go"]);
                format!("observe = [\"axis[{axis}].x\"]\nof = [\"{input}\"]")
            }
            _ => format!("reachable = \"{a}\""),
        };
        format!("[[system.s.property]]\nid = \"P{id}\"\ntext = \"p\"\n{form}\n")
    }
}

/// The specification of a random system.
pub(crate) fn text(seed: u64) -> String {
    let r = &mut Random(seed);
    let axes = 2 + r.below(2);
    let axis: &[(&str, u64)] = &[
        ("x", 2),
        ("y", 1),
        ("seen", 2),
        ("go", 1),
        ("p", 1),
        ("both", 3),
    ];
    let plant: &[(&str, u64)] = &[("z", 2), ("v", 2)];
    let mut out = String::from("spec = \"t\"\n");
    let init = r.pick(&["0", "0", "\"ANY\""]);
    let _ = write!(
        out,
        "[machine.axis]\ntext = \"a\"\norder = \"priority\"\notherwise = \"stay\"\n[machine.axis.param]\np = {{ type = \"INT(0..1)\", default = 0 }}\n\
         [machine.axis.state]\nx = {{ type = \"INT(0..2)\", init = 0 }}\ny = {{ type = \"INT(0..1)\", init = {init} }}\n\
         [machine.axis.input]\ngo = \"INT(0..1)\"\nseen = \"INT(0..2)\"\nmine = \"BOOL\"\n\
         [machine.axis.let]\nboth = \"x + go\"\n[machine.axis.output]\nup = \"x + y\"\n"
    );
    out += &r.rules("axis", &[("x", 2), ("y", 1)], axis, "mine");
    out += "[machine.plant]\ntext = \"b\"\norder = \"priority\"\notherwise = \"stay\"\n[machine.plant.state]\nz = { type = \"INT(0..2)\", init = 0 }\n\
            [machine.plant.input]\nv = \"INT(0..2)\"\n";
    out += &r.rules("plant", &[("z", 2)], plant, "");
    let turn = r.pick(&["chosen = i", "chosen = i", "TRUE"]);
    let after = if axes == 2 {
        "PREV(axis[3 - i].x)"
    } else {
        "PREV(axis[i].x)"
    };
    let seen = match r.below(6) {
        0 => "plant.z".to_owned(),
        1 => "MAXIMUM(j IN axis, PREV(axis[j].x))".to_owned(),
        2 => after.to_owned(),
        3 => "PREV(axis[1].x)".to_owned(),
        4 => "MIN(common, PREV(axis[i].x))".to_owned(),
        _ => "common".to_owned(),
    };
    // Now and then one axis differs.
    let param = match r.below(4) {
        0 => "param = { p = \"i - 1\" }",
        _ => "param = { p = \"0\" }",
    };
    let _ = write!(
        out,
        "[system.s]\ntext = \"s\"\n[system.s.input]\nchosen = \"INT(1..{axes})\"\ncommon = \"INT(0..2)\"\n\
         [system.s.instance]\nplant = {{ machine = \"plant\" }}\naxis = {{ machine = \"axis\", count = {axes}, {param} }}\n\
         [system.s.wire]\n\"axis[i].mine\" = \"{turn}\"\n\"axis[i].seen\" = \"{seen}\"\n[system.s.free]\nports = [\"plant.v\", \"axis[i].go\"]\n"
    );
    if axes == 3 && param.contains("i - 1") {
        // The range of p has two values only.
        out = out.replace("p = \"i - 1\"", "p = \"MIN(i - 1, 1)\"");
    }
    let even = r.below(2) == 0;
    for k in 0..5 {
        out += &r.property(k, axes, even);
    }
    out
}

#[test]
fn random_systems_have_the_same_verdicts() {
    let (mut systems_seen, mut faulty) = (0, 0);
    // For each reduction: systems whose exploration it changed, states with and without it there.
    let mut told = [(0_u64, 0_u64, 0_u64); 3];
    for seed in 0..SYSTEMS {
        let text = text(seed);
        for bound in systems(&text) {
            systems_seen += 1;
            let whole = full(&bound, true);
            faulty += u64::from(!whole.report.faults.is_empty());
            assert!(has_stages(&bound), "seed {seed}");
            same(
                &whole,
                &staged(&bound, false),
                &format!("stages, seed {seed}:\n{text}"),
            );
            for (slot, how) in told.iter_mut().zip([SLICE, SYMMETRY, Reductions::ALL]) {
                let part = reduced(&bound, true, how);
                compare(
                    &bound,
                    &whole,
                    &part,
                    &format!("{how:?}, seed {seed}:\n{text}"),
                );
                let reduction = part.reduction.as_ref().expect("it was asked for");
                if reduction.whole.is_none() {
                    slot.0 += 1;
                    slot.1 += part.report.states;
                    slot.2 += whole.report.states;
                }
            }
        }
    }
    println!("{systems_seen} systems, {faulty} with a fault");
    for (name, (changed, part, whole)) in ["slice", "symmetry", "both"].iter().zip(told) {
        println!("{name}: {changed} systems reduced, {part} states in place of {whole}");
        assert!(
            changed > SYSTEMS / 20 && part < whole,
            "{name} did something"
        );
    }
    assert!(faulty > 0 && faulty < systems_seen);
}
