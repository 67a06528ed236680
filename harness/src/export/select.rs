//! Which system of a file is meant.

use crate::subject::{Subject, Task};

/// The task whose system has the name `wanted`: in full, or what stands after its last `/`. Where one system runs for
/// several sets of axes, `NAME:AXIS` names the run of an axis. Without `wanted` the file must have one system only.
///
/// # Errors
/// A sentence that lists the names there are.
pub fn select<'a>(subject: &'a Subject, wanted: Option<&str>) -> Result<&'a Task, String> {
    let matches: Vec<&Task> = match wanted {
        None => subject.tasks.iter().collect(),
        Some(wanted) => {
            let (name, axis) = wanted
                .split_once(':')
                .map_or((wanted, None), |(n, a)| (n, Some(a)));
            let named = |t: &&Task| {
                let full = t.bound.system.name.as_str();
                full == name || short(full) == name
            };
            let on = |t: &&Task| axis.is_none_or(|a| t.axes.iter().any(|x| x == a));
            subject.tasks.iter().filter(named).filter(on).collect()
        }
    };
    match matches.as_slice() {
        [one] => Ok(one),
        [] => Err(format!(
            "there is no system `{}` in this file; it has {}",
            wanted.unwrap_or_default(),
            list(&subject.tasks.iter().collect::<Vec<_>>())
        )),
        several => Err(format!(
            "say which system is meant with --system: {}",
            list(several)
        )),
    }
}

fn short(name: &str) -> &str {
    name.rsplit_once('/').map_or(name, |(_, last)| last)
}

/// The names of tasks, with an axis where the name alone is not enough.
fn list(tasks: &[&Task]) -> String {
    let name = |t: &Task| {
        let name = short(&t.bound.system.name).to_owned();
        let shared = tasks
            .iter()
            .filter(|o| o.bound.system.name == t.bound.system.name)
            .count()
            > 1;
        match t.axes.first() {
            Some(axis) if shared => format!("{name}:{axis}"),
            _ => name,
        }
    };
    tasks.iter().map(|t| name(t)).collect::<Vec<_>>().join(", ")
}
