//! Which system of a file is meant.

use stillpoint_engine::subject::{Subject, Task};

/// The task whose system has the name `wanted`: in full, or what stands after its last `/`. Where one system runs for
/// several sets of axes, `NAME:AXIS` names the run of an axis. A number counts the runs from 1, as `check` does. Without
/// `wanted` the file must have one system only.
///
/// # Errors
/// A sentence that lists the names there are.
pub fn select<'a>(subject: &'a Subject, wanted: Option<&str>) -> Result<&'a Task, String> {
    let number = wanted.and_then(|w| w.parse::<usize>().ok());
    let matches: Vec<&Task> = match wanted {
        Some(_) if number.is_some() => {
            let at = number.and_then(|n| n.checked_sub(1));
            at.and_then(|at| subject.tasks.get(at))
                .into_iter()
                .collect()
        }
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

/// The names of all systems of a file, for [`select`]; where even an axis does not tell two apart, by number from 1.
pub fn system_names(subject: &Subject) -> Vec<String> {
    let tasks: Vec<&Task> = subject.tasks.iter().collect();
    let names = named(&tasks);
    let unique = |name: &String| names.iter().filter(|n| *n == name).count() == 1;
    let numbered = |(k, name): (usize, &String)| match unique(name) {
        true => name.clone(),
        false => (k + 1).to_string(),
    };
    names.iter().enumerate().map(numbered).collect()
}

/// The names of tasks, with an axis where the name alone is not enough.
fn list(tasks: &[&Task]) -> String {
    named(tasks).join(", ")
}

fn named(tasks: &[&Task]) -> Vec<String> {
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
    tasks.iter().map(|t| name(t)).collect()
}
