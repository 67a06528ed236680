//! What was configured: the values of a machine file, or the parameters of a specification.

use stillpoint_engine::subject::Subject;
use stillpoint_machine::{AxisKind, Machine, Shown};
use stillpoint_show::document::{Block, Inline};

use super::document::{code, paragraph, section, table, words};

/// The values of a machine with their units; nothing for a specification, whose parameters stand at its explorations.
pub(super) fn blocks(subject: &Subject) -> Vec<Block> {
    let Some(machine) = &subject.machine else {
        return Vec::new();
    };
    let mut out = vec![paragraph(format!(
        "{}, family {}; one monitoring cycle is {} ms.",
        machine.family_title,
        machine.family,
        millis(machine.monitoring_cycle)
    ))];
    out.push(Block::List(coverage(machine)));
    if !machine.control.is_empty() {
        out.push(section(
            "Control",
            "control",
            settings(&machine.control_shown()),
        ));
    }
    for (n, axis) in machine.axes.iter().enumerate() {
        let kind = match axis.kind {
            AxisKind::Linear => "linear axis",
            AxisKind::Rotary => "rotary axis",
        };
        let title = match axis.title.as_str() {
            "" => format!("Axis {}", axis.name),
            title => format!("Axis {}: {title}", axis.name),
        };
        let functions = match axis.functions.is_empty() {
            // What monitors an axis of a group follows from the group.
            true if !machine.axis_groups.is_empty() => String::new(),
            true => "; enabled: no safety function".to_owned(),
            false => format!("; enabled: {}", axis.functions.join(", ")),
        };
        let mut inside = vec![paragraph(format!("A {kind}{functions}."))];
        inside.extend(settings(&machine.axis_shown(axis)));
        out.push(section(&title, &format!("axis-{}", n + 1), inside));
    }
    for (n, group) in machine.axis_groups.iter().enumerate() {
        let title = match group.title.as_str() {
            "" => format!("Axis group {}", group.name),
            title => format!("Axis group {}: {title}", group.name),
        };
        let axes: Vec<&str> = group.axes.iter().map(|a| a.get_ref().as_str()).collect();
        let mut inside = vec![paragraph(format!("Its axes: {}.", axes.join(", ")))];
        inside.extend(settings(&machine.group_shown(group)));
        out.push(section(&title, &format!("group-{}", n + 1), inside));
    }
    for (n, door) in machine.doors.iter().enumerate() {
        let title = match door.title.as_str() {
            "" => format!("Guard door {}", door.name),
            title => format!("Guard door {}: {title}", door.name),
        };
        let axes: Vec<&str> = door.axes.iter().map(|a| a.get_ref().as_str()).collect();
        let mut inside = vec![paragraph(format!("Within reach: {}.", axes.join(", ")))];
        inside.extend(settings(&machine.door_shown(door)));
        out.push(section(&title, &format!("door-{}", n + 1), inside));
    }
    out
}

/// What is explored together, apart, or not at all.
fn coverage(machine: &Machine) -> Vec<Vec<Inline>> {
    let mut out: Vec<Vec<Inline>> = machine.coverage().into_iter().map(words).collect();
    for item in &machine.not_explored {
        out.push(vec![
            Inline::Strong("Not explored: ".to_owned()),
            Inline::Text(item.clone()),
        ]);
    }
    out
}

/// Values that the file gives, and those it leaves to the family's default folded away.
fn settings(values: &[Shown]) -> Vec<Block> {
    let rows = |given: bool| -> Vec<Vec<Vec<Inline>>> {
        let chosen = values.iter().filter(|v| v.given == given);
        chosen
            .map(|v| vec![code(&v.name), words(&v.value), words(&v.text)])
            .collect()
    };
    let mut out = Vec::new();
    let (given, defaults) = (rows(true), rows(false));
    if !given.is_empty() {
        out.push(table(&["parameter", "value", "what it is"], given));
    }
    if !defaults.is_empty() {
        out.push(Block::Details {
            summary: words(format!(
                "{} parameters have the default of the manual",
                defaults.len()
            )),
            blocks: vec![table(&["parameter", "default", "what it is"], defaults)],
        });
    }
    out
}

/// Microseconds in milliseconds, with the decimals that are needed.
fn millis(us: i64) -> String {
    let text = format!("{}.{:03}", us / 1000, us % 1000);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
