//! Slices: what each clause of the dependency analysis keeps, what it lets go, and that a slice makes the cycles of the whole.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::{Space, Stmt};
use stillpoint_lang::slice::{Slice, Slicer};

use crate::common::{bound, machine};

const STATE: &str = "[machine.m.state]\nx = { type = \"INT(0..3)\", init = 0 }\ny = { type = \"INT(0..3)\", init = 0 }\n\
    lock = { type = \"BOOL\", init = false }\nother = { type = \"INT(0..3)\", init = 0 }\na = { type = \"ARRAY[0..2] OF INT(0..3)\", init = 0 }\n\
    k = { type = \"INT(0..2)\", init = 0 }\n[machine.m.input]\ngo = \"BOOL\"\nturn = \"BOOL\"\nv = \"INT(0..3)\"\nidle = \"BOOL\"\n";
const FREE: &str = "\"m.go\", \"m.turn\", \"m.v\", \"m.idle\"";

/// A system of one machine with these rules and the claim `always`.
fn system(rules: &[(&str, &str)], extra: &str, always: &str) -> Bound {
    let mut text = machine("", &format!("{STATE}{extra}"), rules, FREE);
    text.push_str(&format!(
        "[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"{always}\"\n"
    ));
    bound(&text)
}

/// The names of a slice's state variables and inputs, without `m.`.
fn names(slice: &Slice) -> (Vec<&str>, Vec<&str>) {
    let system = &slice.bound.system;
    (
        system.states.iter().map(|s| &s.var.name[2..]).collect(),
        system.inputs.iter().map(|v| &v.name[2..]).collect(),
    )
}

/// The slice for the first property, after a comparison with the whole system along random runs: state, atoms, faults.
fn slice(whole: &Bound) -> Slice {
    let slicer = Slicer::new(whole);
    let slice = slicer.slice(&slicer.property(0), &[0]);
    compare(whole, &slice);
    slice
}

fn compare(whole: &Bound, slice: &Slice) {
    let mut seed = 1_u64;
    let mut random = |n: u64| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % n
    };
    let start = |b: &Bound| -> Vec<i32> {
        b.initial
            .iter()
            .zip(&b.states)
            .map(|(v, r)| v.unwrap_or(r.0))
            .collect()
    };
    let (mut state, mut part) = (start(whole), start(&slice.bound));
    let (mut frame, mut small) = (Frame::new(whole), Frame::new(&slice.bound));
    for cycle in 0..3_000 {
        let inputs: Vec<i32> = whole
            .inputs
            .iter()
            .map(|(lo, hi)| lo + random((hi - lo + 1) as u64) as i32)
            .collect();
        frame.start(&state);
        let made = whole.step(&mut frame, &mut |k| inputs[k]);
        small.start(&part);
        let mut read = |k: usize| inputs[slice.inputs[k] as usize];
        let own = slice.bound.step(&mut small, &mut read);
        if made.is_err() {
            // The claim of a slice is about cycles that have a successor.
            (state, part) = (start(whole), start(&slice.bound));
            continue;
        }
        assert_eq!(own, Ok(()), "cycle {cycle}");
        for (k, old) in slice.states.iter().enumerate() {
            assert_eq!(
                small.now[k], frame.now[*old as usize],
                "cycle {cycle}: {}",
                slice.bound.system.states[k].var.name
            );
        }
        for (k, old) in slice.atoms.iter().enumerate() {
            assert_eq!(
                slice.bound.atom(k, &mut small, &mut read),
                whole.atom(*old as usize, &mut frame, &mut |k| inputs[k]),
                "cycle {cycle}: atom {old}"
            );
        }
        state.copy_from_slice(&frame.now);
        part.copy_from_slice(&small.now);
    }
}

/// What moves `lock` and `k`, and everything nobody asks for.
const NOISE: [(&str, &str); 2] = [
    ("turn", "lock := NOT lock; k := (k + 1) MOD 3; y := v;"),
    ("idle", "other := v;"),
];

#[test]
fn guards_of_earlier_rules_count_and_those_of_later_ones_do_not() {
    let rules = [
        ("lock", "other := 1;"),
        ("go", "x := v;"),
        ("turn", "lock := TRUE;"),
        ("idle", "lock := FALSE; other := 2;"),
    ];
    let found = slice(&system(&rules[..2], "", "m.x < 3"));
    // `lock` never changes here, but a slice does not know reachable states.
    assert_eq!(names(&found), (vec!["x", "lock"], vec!["go", "v"]));
    let found = slice(&system(&rules, "", "m.x < 3"));
    assert_eq!(
        names(&found),
        (vec!["x", "lock"], vec!["go", "turn", "v", "idle"])
    );
    assert!(found.bound.system.instances[0].rules[0].then.is_empty());
    // The rules after the last one that assigns are gone.
    let late = [("go", "x := v;"), ("lock", "other := 1;")];
    let found = slice(&system(&late, "", "m.x < 3"));
    assert_eq!(names(&found), (vec!["x"], vec!["go", "v"]));
    assert_eq!(found.bound.system.instances[0].rules.len(), 1);
}

#[test]
fn conditions_around_an_assignment_count_with_those_of_the_branches_before() {
    let with = |effect: &str| {
        let mut rules = vec![("go", effect)];
        rules.extend(NOISE);
        slice(&system(&rules, "", "m.x < 3"))
    };
    let found = with("IF lock THEN x := 1; END_IF;");
    assert_eq!(names(&found), (vec!["x", "lock"], vec!["go", "turn"]));
    let found = with(
        "IF lock THEN other := 1; ELSIF v = 2 THEN x := 1; ELSIF y = 1 THEN other := 2; END_IF;",
    );
    assert_eq!(names(&found), (vec!["x", "lock"], vec!["go", "turn", "v"]));
    let Stmt::If(branches, rest) = &found.bound.system.instances[0].rules[0].then[0] else {
        panic!("the effect is an IF");
    };
    assert_eq!((branches.len(), rest.len()), (2, 0));
    let found = with("IF lock THEN other := 1; ELSE x := v; END_IF;");
    assert_eq!(names(&found), (vec!["x", "lock"], vec!["go", "turn", "v"]));
    let found = with("IF lock THEN other := 1; END_IF; x := v;");
    assert_eq!(names(&found), (vec!["x"], vec!["go", "v"]));
}

#[test]
fn what_an_effect_has_just_assigned_counts() {
    let mut rules = vec![("go", "y := v; x := y; y := 0;")];
    rules.extend(NOISE);
    let found = slice(&system(&rules, "", "m.x < 3"));
    assert_eq!(names(&found), (vec!["x", "y"], vec!["go", "turn", "v"]));
}

#[test]
fn named_expressions_count_with_all_they_read() {
    let lets = "[machine.m.let]\nfree = \"NOT lock\"\nready = \"free AND go\"\nunused = \"other = 3\"\n[machine.m.output]\nshown = \"y + 1\"\n";
    let mut rules = vec![("ready", "x := v;")];
    rules.extend(NOISE);
    let found = slice(&system(&rules, lets, "m.x < 3"));
    assert_eq!(names(&found), (vec!["x", "lock"], vec!["go", "turn", "v"]));
    assert_eq!(found.bound.system.lazies.len(), 2);
    let found = slice(&system(&NOISE, lets, "m.shown < 4"));
    assert_eq!(names(&found), (vec!["y"], vec!["turn", "v"]));
}

#[test]
fn a_computed_index_needs_the_whole_array_and_itself() {
    let mut rules = vec![("go", "a[k] := v;")];
    rules.extend(NOISE);
    let found = slice(&system(&rules, "", "m.a[1] < 3"));
    assert_eq!(
        names(&found),
        (vec!["a[0]", "a[1]", "a[2]", "k"], vec!["go", "turn", "v"])
    );
    let mut rules = vec![("go", "a[2] := v; a[0] := 1; x := a[k];")];
    rules.extend(NOISE);
    let found = slice(&system(&rules, "", "m.x < 3"));
    assert_eq!(
        names(&found),
        (
            vec!["x", "a[0]", "a[1]", "a[2]", "k"],
            vec!["go", "turn", "v"]
        )
    );
    // Constant indices name single cells.
    let mut rules = vec![("go", "a[2] := v; a[0] := y;")];
    rules.extend(NOISE);
    let found = slice(&system(&rules, "", "m.a[2] < 3"));
    assert_eq!(names(&found), (vec!["a[2]"], vec!["go", "v"]));
}

#[test]
fn faults_are_a_claim_of_their_own() {
    let mut rules = vec![("go", "x := v;"), ("lock", "other := other + v;")];
    rules.extend(NOISE);
    let whole = system(&rules, "", "m.x < 3");
    let found = slice(&whole);
    assert_eq!(names(&found), (vec!["x"], vec!["go", "v"]));
    let slicer = Slicer::new(&whole);
    let cone = slicer.faults().expect("an assignment is checked");
    let faults = slicer.slice(&cone, &[]);
    assert_eq!(
        names(&faults),
        (vec!["lock", "other"], vec!["go", "turn", "v", "idle"])
    );
    // The whole system's own place of the fault.
    let mut frame = Frame::new(&faults.bound);
    frame.start(&[1, 3]);
    let site = faults.bound.step(&mut frame, &mut |k| i32::from(k == 2));
    assert_eq!(
        site.map_err(|s| whole.system.sites[s as usize].name.as_str()),
        Err("m.r1: other")
    );
    // Where every value fits there is nothing to show.
    assert_eq!(Slicer::new(&system(&NOISE, "", "m.x < 3")).faults(), None);
}

#[test]
fn parameter_values_settle_dependencies() {
    let parameter = "[machine.m.param]\nmode = { type = \"INT(0..2)\", default = 1 }\nlimit = { type = \"INT(0..9)\", default = 3 }\n";
    let mut rules = vec![
        ("mode = 2", "x := y;"),
        ("go AND (mode = 1 OR lock)", "x := MIN(v + mode, limit);"),
    ];
    rules.extend(NOISE);
    let whole = system(&rules, parameter, "m.x < 4");
    let found = slice(&whole);
    assert_eq!(names(&found), (vec!["x"], vec!["go", "v"]));
    // Over all parameters `limit` may be 9, too much for x; over this one nothing needs a check.
    let checked = |b: &Bound| {
        b.system
            .rules()
            .flat_map(|r| &r.then)
            .filter(|s| matches!(s, Stmt::Assign { checked: true, .. }))
            .count()
    };
    assert_eq!(
        (checked(&whole), checked(Slicer::new(&whole).whole())),
        (1, 0)
    );
    let mut parameters = 0;
    found.bound.system.nodes(&mut |n| {
        parameters += usize::from(matches!(
            n,
            stillpoint_lang::ir::Node::Cell(Space::Param, _)
        ));
    });
    assert_eq!(parameters, 0);
}

#[test]
fn independent_machines_come_apart() {
    let text = "spec = \"t\"\n[machine.m]\ntext = \"m\"\norder = \"priority\"\notherwise = \"stay\"\n[machine.m.input]\ngo = \"BOOL\"\n\
        [machine.m.state]\nx = { type = \"INT(0..3)\", init = 0 }\n[[machine.m.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"go\"\nthen = \"x := (x + 1) MOD 4;\"\n\
        [system.s]\ntext = \"s\"\n[system.s.instance]\nm = { machine = \"m\", count = 3 }\n[system.s.free]\nports = [\"m[i].go\"]\n\
        [[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"m[i].x < 4\"\n\
        [[system.s.property]]\nid = \"Q\"\ntext = \"q\"\nalways = \"m[1].x <= 3 OR m[3].x = 0\"\n";
    let whole = bound(text);
    let slicer = Slicer::new(&whole);
    for k in 0..3 {
        let cone = slicer.property(k);
        assert_eq!((cone.states(), cone.inputs()), (1, 1));
        let slice = slicer.slice(&cone, &[k]);
        assert_eq!(slice.bound.system.instances.len(), 1);
        assert_eq!(slice.states, [k as u32]);
        compare(&whole, &slice);
    }
    let (first, joined) = (slicer.property(0), slicer.property(3));
    assert_eq!(joined.states(), 2);
    assert!(joined.contains(&first) && !first.contains(&joined));
    assert!(slicer.all().contains(&joined));
    compare(&whole, &slicer.slice(&joined, &[0, 3]));
}
