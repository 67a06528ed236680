//! Small systems with a known answer: what each reduction does and where it must not.

use std::time::Duration;

use stillpoint_engine::{Reduction, Reductions, reduce};
use stillpoint_harness::export::promela;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::slice::Slicer;
use stillpoint_lang::symmetry::symmetries;
use stillpoint_model::Verdict;

use super::{SLICE, SYMMETRY, TIMERS, compare, full, options, reduced, systems};

/// `count` axes that count to 3 when it is their turn and fall back when all others are at 0.
fn axes(count: u32, turn: &str, system: &str, properties: &str) -> Bound {
    let text = format!(
        "spec = \"t\"\n[machine.axis]\ntext = \"a\"\norder = \"priority\"\notherwise = \"stay\"\n\
         [machine.axis.param]\ntop = {{ type = \"INT(1..3)\", default = 3 }}\n\
         [machine.axis.state]\nn = {{ type = \"INT(0..3)\", init = 0 }}\n\
         [machine.axis.input]\nmine = \"BOOL\"\nreset = \"BOOL\"\nothers = \"INT(0..9)\"\n\
         [[machine.axis.rule]]\nname = \"up\"\nnote = \"n\"\nwhen = \"mine AND n < top\"\nthen = \"n := n + 1;\"\n\
         [[machine.axis.rule]]\nname = \"down\"\nnote = \"n\"\nwhen = \"reset AND n > 0 AND others = 0\"\nthen = \"n := 0;\"\n\
         [system.s]\ntext = \"s\"\n{system}[system.s.input]\nchosen = \"INT(1..{count})\"\nreset = \"BOOL\"\n\
         [system.s.wire]\n\"axis[i].mine\" = \"{turn}\"\n\"axis[i].reset\" = \"reset\"\n\
         \"axis[i].others\" = \"MAXIMUM(j IN axis, SEL(PREV(axis[j].n) > PREV(axis[i].n), 0, PREV(axis[j].n)))\"\n{properties}"
    );
    let mut all = systems(&text);
    assert_eq!(all.len(), 1);
    all.remove(0)
}

fn instances(count: u32) -> String {
    format!("[system.s.instance]\naxis = {{ machine = \"axis\", count = {count} }}\n")
}

fn property(id: &str, form: &str) -> String {
    format!("[[system.s.property]]\nid = \"{id}\"\ntext = \"p\"\n{form}\n")
}

fn reduction(outcome: &stillpoint_engine::Outcome) -> &Reduction {
    outcome.reduction.as_ref().expect("it was asked for")
}

#[test]
fn an_input_that_selects_an_axis_changes_its_values_with_the_axes() {
    let claim = property("P", "always = \"axis[i].n + 1 <= 4\"");
    for count in [2, 3, 4] {
        let bound = axes(count, "chosen = i", &instances(count), &claim);
        let (whole, part) = (full(&bound, true), reduced(&bound, true, SYMMETRY));
        compare(&bound, &whole, &part, "axes");
        let told = reduction(&part);
        let factorial: usize = (1..=count as usize).product();
        assert_eq!(told.parts[0].permutations, factorial);
        // Multisets of the four values of n.
        let orbits = [0, 4, 10, 20, 35][count as usize];
        assert_eq!(part.report.states, orbits, "{count} axes");
        assert_eq!(whole.report.states, 4_u64.pow(count));
        assert_eq!(told.images.len(), count as usize - 1);
    }
}

#[test]
fn what_distinguishes_the_axes_is_no_symmetry() {
    let claim = property("P", "never = \"axis[1].n = 3 AND axis[2].n = 2\"");
    let found = |turn: &str, system: &str| {
        let bound = axes(2, turn, system, &claim);
        let (whole, part) = (full(&bound, true), reduced(&bound, true, SYMMETRY));
        compare(&bound, &whole, &part, turn);
        symmetries(Slicer::new(&bound).whole()).len()
    };
    assert_eq!(found("chosen = i", &instances(2)), 1);
    assert_eq!(
        found("chosen >= i", &instances(2)),
        0,
        "values in another use"
    );
    assert_eq!(found("chosen = 1", &instances(2)), 1, "both at once");
    // Sums do not depend on the order of their terms, nor on parentheses.
    let sum = property("P", "never = \"axis[1].n + axis[2].n + axis[3].n = 9\"");
    let bound = axes(3, "chosen = i", &instances(3), &sum);
    let part = reduced(&bound, true, SYMMETRY);
    compare(&bound, &full(&bound, true), &part, "sum");
    assert_eq!(reduction(&part).parts[0].permutations, 6);
    assert_eq!(
        found("chosen = i OR reset AND chosen = 2", &instances(2)),
        0
    );
    assert_eq!(
        found("PREV(axis[1].n) < 2", &instances(2)),
        0,
        "one reads the other"
    );
    let own = "[system.s.instance]\naxis = { machine = \"axis\", count = 2, param = { top = \"4 - i\" } }\n";
    assert_eq!(found("chosen = i", own), 0, "parameter values");
    let same =
        "[system.s.instance]\naxis = { machine = \"axis\", count = 2, param = { top = \"2\" } }\n";
    assert_eq!(found("chosen = i", same), 1);
}

#[test]
fn instances_out_of_order_are_no_symmetry() {
    // `late[i]` sees what `axis[i]` has just done. Where it stepped first, renaming would not give the same cycle.
    let text = "spec = \"t\"\n[machine.axis]\ntext = \"a\"\norder = \"priority\"\notherwise = \"stay\"\n[machine.axis.input]\ngo = \"BOOL\"\n\
        [machine.axis.state]\nn = { type = \"INT(0..1)\", init = 0 }\n[[machine.axis.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"go\"\nthen = \"n := 1 - n;\"\n\
        [system.s]\ntext = \"s\"\n[system.s.instance]\naxis = { machine = \"axis\", count = 2 }\nlate = { machine = \"axis\", count = 2 }\n\
        [system.s.wire]\n\"late[i].go\" = \"axis[i].n = 1\"\n[system.s.free]\nports = [\"axis[i].go\"]\n";
    let mut bound = systems(text).remove(0);
    assert_eq!(symmetries(&bound).len(), 1);
    bound.system.instances.reverse();
    assert_eq!(symmetries(&bound).len(), 0);
}

#[test]
fn forms_that_follow_single_axes_are_explored_state_by_state() {
    let invariant = property(
        "ALL",
        "when = \"EXISTS(j IN axis, axis[j].n = 3)\"\nleads_to = \"FORALL(j IN axis, axis[j].n = 0)\"\nfair = [\"reset\"]",
    );
    let single = property(
        "ONE",
        "when = \"axis[i].n = 3\"\nleads_to = \"axis[i].n = 0\"\nwithin = \"9\"",
    );
    let bound = axes(3, "chosen = i", &instances(3), &invariant);
    let part = reduced(&bound, true, Reductions::ALL);
    compare(&bound, &full(&bound, true), &part, "invariant");
    assert_eq!(reduction(&part).parts[0].permutations, 6);
    assert_eq!(part.report.properties[0].verdict, Verdict::Violated);
    assert!(
        part.report.properties[0]
            .trace
            .as_ref()
            .is_some_and(|t| t.loop_start.is_some())
    );
    let bound = axes(
        3,
        "chosen = i",
        &instances(3),
        &format!("{invariant}{single}"),
    );
    let part = reduced(&bound, true, Reductions::ALL);
    compare(&bound, &full(&bound, true), &part, "single");
    // No orbits: and ONE depends on all axes, so nothing is left out.
    assert!(reduction(&part).whole.is_some());
    // Beside an idle machine there is; and one copy of ONE speaks for all three.
    let idle = "[machine.idle]\ntext = \"b\"\norder = \"priority\"\notherwise = \"stay\"\n[machine.idle.input]\ngo = \"BOOL\"\n\
        [machine.idle.state]\nb = { type = \"BOOL\", init = false }\n[[machine.idle.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"go\"\nthen = \"b := NOT b;\"\n";
    let more = "idle = { machine = \"idle\" }\n[system.s.free]\nports = [\"idle.go\"]\n";
    let system = format!("{idle}{}{more}", instances(3));
    let bound = axes(3, "chosen = i", &system, &format!("{invariant}{single}"));
    let part = reduced(&bound, true, Reductions::ALL);
    compare(&bound, &full(&bound, true), &part, "beside another one");
    let told = reduction(&part);
    let judged = told
        .parts
        .iter()
        .find(|p| p.properties.contains(&"ALL".to_owned()));
    assert!(judged.is_some_and(|p| p.permutations == 1 && p.variables == 3));
    assert_eq!(told.images.len(), 2);
    assert_eq!(part.report.properties.len(), 4);
}

#[test]
fn a_claim_about_one_axis_alone_has_no_orbit() {
    let claim = property("P", "never = \"axis[2].n = 3\"");
    let bound = axes(2, "chosen = i", &instances(2), &claim);
    let part = reduced(&bound, true, SYMMETRY);
    compare(&bound, &full(&bound, true), &part, "one");
    assert!(reduction(&part).whole.is_some());
    let both = property("Q", "never = \"axis[1].n = 3\"");
    let bound = axes(2, "chosen = i", &instances(2), &format!("{claim}{both}"));
    let part = reduced(&bound, true, SYMMETRY);
    compare(&bound, &full(&bound, true), &part, "both");
    assert_eq!(reduction(&part).parts[0].permutations, 2);
}

#[test]
fn a_reachable_fault_sends_everything_to_the_whole_system() {
    let text = "spec = \"t\"\n[machine.m]\ntext = \"m\"\norder = \"priority\"\notherwise = \"stay\"\n[machine.m.input]\ngo = \"BOOL\"\nlift = \"BOOL\"\n\
        [machine.m.state]\nx = { type = \"INT(0..3)\", init = 0 }\ny = { type = \"INT(0..2)\", init = 0 }\n\
        [[machine.m.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"go\"\nthen = \"x := (x + 1) MOD 4; y := y + 1;\"\n\
        [[machine.m.rule]]\nname = \"back\"\nnote = \"n\"\nwhen = \"lift\"\nthen = \"y := 0;\"\n\
        [system.s]\ntext = \"s\"\n[system.s.instance]\nm = { machine = \"m\" }\n[system.s.free]\nports = [\"m.go\", \"m.lift\"]\n\
        [[system.s.property]]\nid = \"P\"\ntext = \"p\"\nwhen = \"m.x = 3\"\nleads_to = \"m.x = 0\"\nfair = [\"m.go\"]\n";
    let bound = systems(text).remove(0);
    let (whole, part) = (full(&bound, true), reduced(&bound, true, SLICE));
    compare(&bound, &whole, &part, "fault");
    assert_eq!(whole.report.faults.len(), 1);
    assert!(
        reduction(&part)
            .whole
            .as_ref()
            .is_some_and(|w| w.contains("range"))
    );
    // Without it, x alone decides, and that y stays in its range is shown apart.
    let bound = systems(&text.replace("y := y + 1", "y := SEL(y > 1, y + 1, 0)")).remove(0);
    let (whole, part) = (full(&bound, true), reduced(&bound, true, SLICE));
    compare(&bound, &whole, &part, "no fault");
    let parts = &reduction(&part).parts;
    assert!(parts.iter().any(|p| p.faults));
}

#[test]
fn nothing_is_said_where_the_absence_of_faults_was_not_shown() {
    // A counter of 30 bits that must be checked, beside a small property.
    let text = "spec = \"t\"\n[machine.m]\ntext = \"m\"\norder = \"priority\"\notherwise = \"stay\"\n[machine.m.input]\ngo = \"BOOL\"\n\
        [machine.m.state]\nx = { type = \"INT(0..3)\", init = 0 }\ny = { type = \"INT(0..1000000000)\", init = 0 }\n\
        [[machine.m.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"go\"\nthen = \"x := (x + 1) MOD 4; IF y < 1000000000 THEN y := y + 1; END_IF;\"\n\
        [system.s]\ntext = \"s\"\n[system.s.instance]\nm = { machine = \"m\" }\n[system.s.free]\nports = [\"m.go\"]\n\
        [[system.s.property]]\nid = \"HOLDS\"\ntext = \"p\"\nalways = \"m.x < 4\"\n\
        [[system.s.property]]\nid = \"FAILS\"\ntext = \"p\"\nalways = \"m.x < 3\"\n";
    let bound = systems(text).remove(0);
    let mut options = options();
    options.limits.time = Some(Duration::from_millis(300));
    let part = reduce::run(&bound, &options, true, SLICE, &mut ()).expect("it runs");
    assert!(!part.report.complete);
    let verdicts: Vec<Verdict> = part.report.properties.iter().map(|p| p.verdict).collect();
    assert_eq!(verdicts, [Verdict::Inconclusive, Verdict::Violated]);
}

#[test]
fn each_reduction_can_be_switched_off() {
    let claims = property("P", "always = \"axis[i].n < 4\"");
    let bound = axes(2, "chosen = i", &instances(2), &claims);
    assert!(
        reduced(&bound, true, Reductions::default())
            .reduction
            .is_none()
    );
    let parse = |text: &str| text.parse::<Reductions>();
    assert_eq!(parse("slice"), Ok(SLICE));
    assert_eq!(parse("symmetry"), Ok(SYMMETRY));
    let both = Reductions {
        timers: false,
        ..Reductions::ALL
    };
    assert_eq!(parse("slice, symmetry"), Ok(both));
    assert_eq!(parse("timers"), Ok(TIMERS));
    assert_eq!(parse("all"), Ok(Reductions::ALL));
    assert_eq!(parse("none"), Ok(Reductions::default()));
    assert!(parse("none,slice").is_err_and(|e| e.contains("alone")));
    assert!(parse("slices").is_err_and(|e| e.contains("slices")));
}

#[test]
fn a_slice_can_be_exported() {
    let claims = property("P", "always = \"axis[1].n < 4\"");
    let bound = axes(2, "chosen = i", &instances(2), &claims);
    let slicer = Slicer::new(&bound);
    let slice = slicer.slice(&slicer.property(0), &[0]);
    let model = promela::promela(&slice.bound, "a slice").expect("within 32 bits");
    assert!(model.text.contains("assert"));
}
