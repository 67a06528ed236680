//! The chains for a terminal.

use std::fmt::Write as _;

use stillpoint_machine::Machine;

use super::{Judged, Proof, Result, basis, cycles, time};

/// Each chain with its summands, then its ends.
pub fn text(judged: &Judged, machine: &Machine) -> String {
    let mut out = format!(
        "{}: reaction times, in cycles of {}\n",
        machine.name,
        time(machine.monitoring_cycle.into())
    );
    let mut axis = "";
    for result in &judged.results {
        if result.chain.axis != axis {
            axis = &result.chain.axis;
            let _ = writeln!(out, "\nAxis {axis}");
        }
        chain(&mut out, judged, machine, result);
    }
    out.push('\n');
    for note in &judged.reactions.notes {
        crate::report::wrapped(&mut out, "  ", note);
    }
    out
}

fn chain(out: &mut String, judged: &Judged, machine: &Machine, result: &Result) {
    let chain = &result.chain;
    let dimensions = chain.kind.dimensions();
    let _ = writeln!(out, "\n  {}: {}", chain.name, chain.title);
    let mut stage = usize::MAX;
    for (step, proof) in chain.steps.iter().zip(&result.proofs) {
        if step.stage != stage {
            stage = step.stage;
            let title = judged.reactions.stages.get(stage);
            let _ = writeln!(out, "    {}", title.map_or("", String::as_str));
        }
        let (long, short) = match step.time {
            Some(us) => (time(us.into()), cycles(us.into(), machine.monitoring_cycle)),
            None => ("?".to_owned(), "?".to_owned()),
        };
        let head = format!(
            "    {long:>10} {short:>7}  {:<9} ",
            basis(step.basis, proof)
        );
        let mut text = step.text.clone();
        match (&step.property, proof) {
            (Some(claim), Proof::Proven(_)) => {
                let _ = write!(text, " [{}]", claim.id);
            }
            (Some(claim), Proof::Refuted(why) | Proof::Open(why)) => {
                let _ = write!(text, " [{}: {why}]", claim.id);
            }
            _ => {}
        }
        crate::report::wrapped(out, &head, &text);
    }
    let _ = writeln!(
        out,
        "    at {} ({}){}",
        result.speed(),
        result.speed_text,
        match result.motion.acceleration {
            0 => String::new(),
            a => format!(
                ", accelerating by {} until the stop works",
                dimensions.acceleration.show(a)
            ),
        }
    );
    for (outcome, end) in judged.reactions.outcomes.iter().zip(&result.ends) {
        let more = if end.open { ", and coasting" } else { "" };
        let _ = writeln!(
            out,
            "    = {:>8} {:>7}  {}: {}{more}",
            time(end.time),
            cycles(end.time, machine.monitoring_cycle),
            outcome.title,
            result.way(end),
        );
    }
}
