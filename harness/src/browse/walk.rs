//! A walk along a path: which choices were read, which states were passed.

use stillpoint_engine::table::Interpreted;
use stillpoint_engine::{Cycle, replay};
use stillpoint_lang::bind::Bound;
use stillpoint_model::{Choices, Replay, System, Trace};

use super::path::{Choice, Path};

/// A path walked.
#[derive(Debug, Clone)]
pub struct Walk {
    /// The path as short as it can be written.
    pub path: Path,
    /// The initial state and the state after each cycle. After a cycle that met a fault there is none.
    pub states: Vec<Vec<i32>>,
    /// The cycles.
    pub cycles: Vec<Cycle>,
    /// The place (in `system.sites`) of the fault that the last cycle met.
    pub fault: Option<u32>,
}

/// Answers in the order of the questions, and remembers them.
struct InOrder<'a> {
    values: &'a [u32],
    read: Vec<(u32, u32)>,
    beyond: Option<(u32, u32, u32)>,
}

impl<'a> InOrder<'a> {
    fn new(values: &'a [u32]) -> Self {
        Self {
            values,
            read: Vec::new(),
            beyond: None,
        }
    }
}

impl Choices for InOrder<'_> {
    fn choose(&mut self, input: u32, size: u32) -> u32 {
        if let Some((_, value)) = self.read.iter().find(|(i, _)| *i == input) {
            return *value;
        }
        let mut value = self.values.get(self.read.len()).copied().unwrap_or(0);
        if value >= size {
            self.beyond = self.beyond.or(Some((input, value, size)));
            value = 0;
        }
        self.read.push((input, value));
        value
    }
}

/// Answers from a step made before, and remembers the order of the questions.
struct Retaken<'a> {
    replay: Replay<'a>,
    read: Vec<(u32, u32)>,
}

impl<'a> Retaken<'a> {
    fn new(step: &'a [(u32, u32)]) -> Self {
        Self {
            replay: Replay::new(step),
            read: Vec::new(),
        }
    }
}

impl Choices for Retaken<'_> {
    fn choose(&mut self, input: u32, size: u32) -> u32 {
        if let Some((_, value)) = self.read.iter().find(|(i, _)| *i == input) {
            return *value;
        }
        let value = self.replay.choose(input, size);
        self.read.push((input, value));
        value
    }
}

/// Walks along a path.
///
/// # Errors
/// A sentence about the part of the path that this system does not have.
pub fn walk(bound: &Bound, path: &Path) -> Result<Walk, String> {
    let system = Interpreted::new(bound);
    let mut work = system.work();
    let mut state = vec![0; bound.states.len()];
    let mut trace = Trace::default();
    let mut kept = Path::default();

    let mut choices = InOrder::new(&path.initial.values);
    system.initial(&mut work, &mut choices, &mut state);
    kept.initial = checked(bound, 0, &path.initial, &choices)?;
    if !kept.initial.also.is_empty() {
        return Err("part 0 of the path: the initial state has no further choices".to_owned());
    }
    trace.initial = choices.read;

    let mut states = vec![state.clone()];
    let mut fault = None;
    for (number, step) in path.steps.iter().enumerate() {
        if fault.is_some() {
            return Err(format!(
                "part {} of the path: there is no cycle after the fault in the one before it",
                number + 1
            ));
        }
        let mut choices = InOrder::new(&step.values);
        let mut after = state.clone();
        let done = system.next(&mut work, &state, &mut choices, &mut after);
        let step = checked(bound, number + 1, step, &choices)?;
        let mut read = choices.read;
        read.extend(&step.also);
        trace.steps.push(read);
        kept.steps.push(step);
        match done {
            Ok(()) => {
                state = after;
                states.push(state.clone());
            }
            Err(met) => fault = Some(met.code),
        }
    }
    Ok(Walk {
        cycles: replay(bound, &trace),
        path: kept,
        states,
        fault,
    })
}

/// The choice as it is kept, if it fits what was read.
fn checked(
    bound: &Bound,
    number: usize,
    choice: &Choice,
    choices: &InOrder,
) -> Result<Choice, String> {
    let wrong = |what: String| Err(format!("part {number} of the path: {what}"));
    // The initial state chooses values of state variables, a cycle those of inputs.
    let name = |k: u32| {
        let input = bound.system.inputs.get(k as usize).map(|v| &v.name);
        let state = bound.system.states.get(k as usize).map(|s| &s.var.name);
        let name = if number == 0 { state } else { input };
        name.cloned().unwrap_or_default()
    };
    if let Some((k, value, size)) = choices.beyond {
        return wrong(format!(
            "value {value} of `{}`; it has the values 0 to {}",
            name(k),
            size.saturating_sub(1)
        ));
    }
    let (given, read) = (choice.values.len(), choices.read.len());
    if given > read {
        return wrong(format!("{given} choices are given, {read} are read"));
    }
    let mut also: Vec<(u32, u32)> = Vec::new();
    for (k, value) in &choice.also {
        let Some(size) = size(bound, *k) else {
            return wrong(format!("there is no input number {k}"));
        };
        if *value >= size {
            return wrong(format!(
                "value {value} of `{}`; it has the values 0 to {}",
                name(*k),
                size.saturating_sub(1)
            ));
        }
        let known = choices.read.iter().chain(&also).find(|(i, _)| i == k);
        match known {
            Some((_, other)) if other != value => {
                return wrong(format!("`{}` has two values", name(*k)));
            }
            Some(_) => {}
            None => also.push((*k, *value)),
        }
    }
    also.sort_unstable();
    let values = choices.read.iter().map(|(_, value)| *value).collect();
    Ok(Choice::new(values, also))
}

/// The number of values of an input; none if there is no such input.
pub(super) fn size(bound: &Bound, input: u32) -> Option<u32> {
    let (lo, hi) = bound.inputs.get(input as usize)?;
    u32::try_from(i64::from(*hi) - i64::from(*lo) + 1).ok()
}

/// The choice that makes the cycle from `state` in which the inputs have these values.
pub(super) fn choice(system: &Interpreted, state: &[i32], step: &[(u32, u32)]) -> Choice {
    follow(system, &mut state.to_vec(), step).0
}

/// Makes the cycle in which the inputs have these values: its choice, and whether there is a state after it.
fn follow(system: &Interpreted, state: &mut Vec<i32>, step: &[(u32, u32)]) -> (Choice, bool) {
    let mut choices = Retaken::new(step);
    let mut after = state.clone();
    let done = system.next(&mut system.work(), state, &mut choices, &mut after);
    let read = choices.read;
    let unread = |(input, _): &&(u32, u32)| !read.iter().any(|(i, _)| i == input);
    let mut also: Vec<_> = step.iter().filter(unread).copied().collect();
    also.sort_unstable();
    let values = read.iter().map(|(_, value)| *value).collect();
    if done.is_ok() {
        *state = after;
    }
    (Choice::new(values, also), done.is_ok())
}

/// The path of a run that the explorer has found.
pub fn path_of(bound: &Bound, trace: &Trace) -> Path {
    let system = Interpreted::new(bound);
    let mut state = vec![0; bound.states.len()];
    let mut choices = Retaken::new(&trace.initial);
    system.initial(&mut system.work(), &mut choices, &mut state);
    let values = choices.read.iter().map(|(_, value)| *value).collect();
    let mut path = Path {
        initial: Choice::new(values, Vec::new()),
        steps: Vec::new(),
    };
    for step in &trace.steps {
        let (choice, goes_on) = follow(&system, &mut state, step);
        path.steps.push(choice);
        if !goes_on {
            break;
        }
    }
    path
}
