//! The cycles of a system, made by the interpreter: all of those a state has, and those of a given run.

use stillpoint_spec::bind::{Bound, Bounds};
use stillpoint_spec::eval::{Frame, UNSET};
use stillpoint_spec::ir::{Node, Space};

use crate::format::Run;
use crate::states::Radix;

/// Goes through the values of the inputs that are read, the last one read turning fastest. An input that nobody reads
/// has any value; it is not enumerated.
#[derive(Debug, Default)]
struct Odometer {
    reads: Vec<(usize, i32)>,
    at: usize,
}

impl Odometer {
    /// The value of input `k`, which is read in the same order again as long as the values before it are the same.
    fn read(&mut self, k: usize, least: i32) -> i32 {
        if self.at == self.reads.len() {
            self.reads.push((k, least));
        }
        self.at += 1;
        self.reads[self.at - 1].1
    }

    /// Like `read`, for inputs that may be asked for twice.
    fn again(&mut self, k: usize, least: i32) -> i32 {
        match self.reads[..self.at].iter().find(|(known, _)| *known == k) {
            Some((_, value)) => *value,
            None => self.read(k, least),
        }
    }

    /// Sets the next combination; false when there is none.
    fn advance(&mut self, greatest: impl Fn(usize) -> i32) -> bool {
        self.at = 0;
        while let Some((k, value)) = self.reads.pop() {
            if value < greatest(k) {
                self.reads.push((k, value + 1));
                return true;
            }
        }
        false
    }

    fn clear(&mut self) {
        self.reads.clear();
        self.at = 0;
    }
}

/// A frame as it was at the start of an instance's step.
#[derive(Debug, Default)]
struct Mark {
    /// The inputs read until then.
    reads: usize,
    now: Vec<i32>,
    inputs: Vec<i32>,
    lazies: Vec<i32>,
}

/// Steps that differ in the last input read: what lies before the instance that reads it is not made again.
#[derive(Debug, Default)]
struct Steps {
    /// One for each instance whose step was begun, and others left over.
    marks: Vec<Mark>,
    begun: usize,
}

impl Steps {
    /// The next step is one from another state, or with other inputs from the first one on.
    fn clear(&mut self) {
        self.begun = 0;
    }

    /// The step from `state` with the inputs that `read` takes from the odometer.
    fn step(
        &mut self,
        bound: &Bound,
        (frame, state): (&mut Frame, &[i32]),
        odometer: &mut Odometer,
        read: impl Fn(&mut Odometer, usize) -> i32,
    ) -> Result<(), u32> {
        let changed = odometer.reads.len().saturating_sub(1);
        let same = |mark: &Mark| mark.reads <= changed;
        let from = self.marks[..self.begun].iter().rposition(same);
        match from.map(|k| &self.marks[k]) {
            Some(mark) => {
                frame.now.copy_from_slice(&mark.now);
                frame.inputs.copy_from_slice(&mark.inputs);
                frame.lazies.copy_from_slice(&mark.lazies);
                odometer.at = mark.reads;
            }
            None => frame.start(state),
        }
        for k in from.unwrap_or(0)..bound.system.instances.len() {
            if self.marks.len() == k {
                self.marks.push(Mark::default());
            }
            let mark = &mut self.marks[k];
            mark.reads = odometer.at;
            mark.now.clone_from(&frame.now);
            mark.inputs.clone_from(&frame.inputs);
            mark.lazies.clone_from(&frame.lazies);
            self.begun = k + 1;
            bound.step_instance(k, frame, &mut |input| read(odometer, input))?;
        }
        Ok(())
    }
}

/// A set of variables of a cycle: state after it, inputs, named expressions as the step has left them. Those whose numbers
/// agree in the last 7 bits are in it together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct View {
    now: u128,
    inputs: u128,
    lazies: u128,
}

impl View {
    /// What the value of these atoms can depend on, besides the state before the cycle.
    pub fn of(bound: &Bound, atoms: impl IntoIterator<Item = usize>) -> Self {
        let mut view = Self::default();
        for atom in atoms {
            view.add(bound, &bound.system.atoms[atom]);
        }
        view
    }

    fn add(&mut self, bound: &Bound, node: &Node) {
        node.visit(&mut |node| match node {
            Node::Cell(space, k) => self.cell(*space, *k),
            Node::Element {
                space, base, len, ..
            } => (*base..base + len).for_each(|k| self.cell(*space, k)),
            // Where the step has not evaluated it, it is evaluated now.
            Node::Lazy(k) => {
                self.lazies |= bit(*k as usize);
                self.add(bound, &bound.system.lazies[*k as usize].value);
            }
            _ => {}
        });
    }

    fn cell(&mut self, space: Space, k: u32) {
        match space {
            Space::Now => self.now |= bit(k as usize),
            Space::Input => self.inputs |= bit(k as usize),
            Space::Before | Space::Param => {}
        }
    }

    /// Whether the sets have a variable in common.
    pub fn meets(self, other: Self) -> bool {
        self.now & other.now | self.inputs & other.inputs | self.lazies & other.lazies != 0
    }
}

fn bit(k: usize) -> u128 {
    1 << (k % 128)
}

/// Brings a copy up to date; the set of the places that differed.
fn update(copy: &mut [i32], from: &[i32]) -> u128 {
    let mut changed = 0;
    for (k, (old, new)) in copy.iter_mut().zip(from).enumerate() {
        if old != new {
            *old = *new;
            changed |= bit(k);
        }
    }
    changed
}

/// The cycles of one state after the other.
pub struct Cycle<'a> {
    bound: &'a Bound,
    frame: Frame,
    steps: Steps,
    step: Odometer,
    extra: Odometer,
    /// The state after the step, the inputs and the named expressions as the step has left them.
    now: Vec<i32>,
    inputs: Vec<i32>,
    lazies: Vec<i32>,
    changed: Option<View>,
}

impl<'a> Cycle<'a> {
    /// Work area for `bound`.
    pub fn new(bound: &'a Bound) -> Self {
        Self {
            bound,
            frame: Frame::new(bound),
            steps: Steps::default(),
            step: Odometer::default(),
            extra: Odometer::default(),
            now: vec![UNSET; bound.states.len()],
            inputs: vec![UNSET; bound.inputs.len()],
            lazies: vec![UNSET; bound.system.lazies.len()],
            changed: None,
        }
    }

    /// Makes every cycle from `state`; `visit` is told whether the step succeeded, or at which site it left a range.
    ///
    /// # Errors
    /// The first one of `visit`, which ends the enumeration.
    pub fn each<E>(
        &mut self,
        state: &[i32],
        mut visit: impl FnMut(&mut Self, Result<(), u32>) -> Result<(), E>,
    ) -> Result<(), E> {
        let inputs: &[Bounds] = &self.bound.inputs;
        self.step.clear();
        self.steps.clear();
        let mut first = true;
        loop {
            let from = (&mut self.frame, state);
            let read = |odometer: &mut Odometer, k: usize| odometer.read(k, inputs[k].0);
            let made = self.steps.step(self.bound, from, &mut self.step, read);
            if made.is_ok() {
                let changed = View {
                    now: update(&mut self.now, &self.frame.now),
                    inputs: update(&mut self.inputs, &self.frame.inputs),
                    lazies: update(&mut self.lazies, &self.frame.lazies),
                };
                self.changed = (!std::mem::take(&mut first)).then_some(changed);
            }
            visit(self, made)?;
            if !self.step.advance(|k| inputs[k].1) {
                return Ok(());
            }
        }
    }

    /// In what this cycle differs from the last one without a range fault before it, which started in the same state; none if
    /// there is none.
    pub fn changed(&self) -> Option<View> {
        self.changed
    }

    /// Whether `judge` is true for every combination of the inputs that it reads and the step did not.
    pub fn all(&mut self, mut judge: impl FnMut(&mut Self) -> bool) -> bool {
        self.extra.clear();
        loop {
            let fine = judge(self);
            // The next combination, and the next property, must not see what this one read.
            for (k, _) in &self.extra.reads {
                self.frame.inputs[*k] = UNSET;
            }
            if !self.extra.reads.is_empty() {
                self.frame.lazies.copy_from_slice(&self.lazies);
            }
            if !fine || !self.extra.advance(|k| self.bound.inputs[k].1) {
                return fine;
            }
        }
    }

    /// Atom `k` in this cycle, under the present combination of inputs.
    pub fn atom(&mut self, k: usize) -> bool {
        let (inputs, extra) = (&self.bound.inputs, &mut self.extra);
        self.bound
            .atom(k, &mut self.frame, &mut |i| extra.read(i, inputs[i].0))
    }

    /// The state after the cycle.
    pub fn after(&self) -> &[i32] {
        &self.frame.now
    }

    /// The inputs read so far, as a step of a [`Run`].
    pub fn inputs(&self) -> Vec<(u32, u32)> {
        let read = self.frame.inputs.iter().zip(&self.bound.inputs).enumerate();
        read.filter(|(_, (value, _))| **value != UNSET)
            .map(|(k, (value, (lo, _)))| (k as u32, value.abs_diff(*lo)))
            .collect()
    }
}

/// What two runs side by side must not do: the parts of a property "does not depend on".
#[derive(Clone, Copy, Debug)]
pub struct Pairing<'a> {
    /// Observed expressions.
    pub observe: &'a [usize],
    /// Inputs that may differ, in cycles with the condition in both runs.
    pub of: &'a [usize],
    /// The condition; none: always.
    pub condition: Option<usize>,
}

/// The cycles of two runs side by side.
pub struct PairCycle<'a> {
    bound: &'a Bound,
    pairing: Pairing<'a>,
    frames: [Frame; 2],
    steps: [Steps; 2],
    inputs: Odometer,
}

impl<'a> PairCycle<'a> {
    /// Work area for pairs of runs of `bound`.
    pub fn new(bound: &'a Bound, pairing: Pairing<'a>) -> Self {
        Self {
            bound,
            pairing,
            frames: [Frame::new(bound), Frame::new(bound)],
            steps: Default::default(),
            inputs: Odometer::default(),
        }
    }

    /// Makes every pair of cycles that may stand side by side from the states `before`. `visit` gets the states after them, and
    /// whether the observed expressions agree (where the condition does not hold in both, they need not). A pair in
    /// which one step leaves a range does not go on.
    ///
    /// # Errors
    /// The first one of `visit`, which ends the enumeration.
    pub fn each<E>(
        &mut self,
        before: [&[i32]; 2],
        mut visit: impl FnMut([&[i32]; 2], bool) -> Result<(), E>,
    ) -> Result<(), E> {
        let bounds = &self.bound.inputs;
        let of = |k: usize| bounds[k % bounds.len()];
        self.inputs.clear();
        self.steps.iter_mut().for_each(Steps::clear);
        loop {
            if let Some(agree) = self.pair(before) {
                visit([&self.frames[0].now, &self.frames[1].now], agree)?;
            }
            if !self.inputs.advance(|k| of(k).1) {
                return Ok(());
            }
        }
    }

    /// One pair of cycles; none if there is no such pair.
    fn pair(&mut self, before: [&[i32]; 2]) -> Option<bool> {
        let Pairing {
            observe,
            of,
            condition,
        } = self.pairing;
        let (bound, odometer) = (self.bound, &mut self.inputs);
        let [first, second] = &mut self.frames;
        let [steps, others] = &mut self.steps;
        let own = |odometer: &mut Odometer, k: usize| odometer.again(k, bound.inputs[k].0);
        let changed = odometer.reads.len().saturating_sub(1);
        let made = steps.step(bound, (first, before[0]), odometer, own);
        if others.marks.first().is_none_or(|mark| mark.reads > changed) {
            others.clear();
        }
        made.ok()?;
        let mut both = condition.is_none_or(|c| bound.atom(c, first, &mut |k| own(odometer, k)));
        // A listed input has a number of its own in the second run, where it may differ.
        let free = both;
        let other = |odometer: &mut Odometer, k: usize| {
            let number = k + bound.inputs.len() * usize::from(free && of.contains(&k));
            odometer.again(number, bound.inputs[k].0)
        };
        let made = others.step(bound, (second, before[1]), odometer, other);
        made.ok()?;
        both = both && condition.is_none_or(|c| bound.atom(c, second, &mut |k| other(odometer, k)));
        if !both {
            let read = |f: &Frame, k: usize| Some(f.inputs[k]).filter(|v| *v != UNSET);
            let differ = |k: &usize| match (read(first, *k), read(second, *k)) {
                (Some(a), Some(b)) => a != b,
                // What one run does not read may be taken to be the same in both.
                _ => false,
            };
            return (!of.iter().any(differ)).then_some(true);
        }
        let mut agree = true;
        for k in observe {
            let number = |i: usize| i + bound.inputs.len() * usize::from(of.contains(&i));
            let left = bound.observe(*k, first, &mut |i| odometer.again(i, bound.inputs[i].0));
            let right = bound.observe(*k, second, &mut |i| {
                odometer.again(number(i), bound.inputs[i].0)
            });
            agree &= left == right;
        }
        Some(agree)
    }
}

/// Replays a run; an input that a step does not list has its least value.
pub struct Player<'a> {
    bound: &'a Bound,
    run: &'a Run,
    at: usize,
    /// The state before the next step.
    pub state: Vec<i32>,
    /// Values of all inputs in the step just made.
    pub inputs: Vec<i32>,
    frame: Frame,
}

impl<'a> Player<'a> {
    /// Starts a run.
    ///
    /// # Errors
    /// It does not start in an initial state.
    pub fn new(bound: &'a Bound, radix: &Radix, run: &'a Run) -> Result<Self, String> {
        let mut state = vec![0; bound.states.len()];
        let starts = radix.state(run.initial, &mut state)
            && (state.iter().zip(&bound.initial)).all(|(v, init)| init.is_none_or(|i| i == *v));
        if !starts {
            return Err("its run does not start in an initial state".to_owned());
        }
        Ok(Self {
            bound,
            run,
            at: 0,
            state,
            inputs: Vec::new(),
            frame: Frame::new(bound),
        })
    }

    /// Makes the next step: none at the end of the run, else whether this was the last one.
    ///
    /// # Errors
    /// An input that does not exist or has no such value; a step that leaves a range before the end of the run.
    pub fn step(&mut self) -> Result<Option<bool>, String> {
        match self.attempt()? {
            Some(Ok(last)) => Ok(Some(last)),
            Some(Err(_)) => Err("its run meets a range fault".to_owned()),
            None => Ok(None),
        }
    }

    /// Like [`Player::step`], and tells the site of a range fault.
    ///
    /// # Errors
    /// An input that does not exist or has no such value.
    pub fn attempt(&mut self) -> Result<Option<Result<bool, u32>>, String> {
        let Some(step) = self.run.steps.get(self.at) else {
            return Ok(None);
        };
        self.at += 1;
        self.inputs = self.bound.inputs.iter().map(|(lo, _)| *lo).collect();
        for (k, value) in step {
            let (k, bounds) = (*k as usize, self.bound.inputs.get(*k as usize));
            let value = bounds
                .and_then(|(lo, hi)| lo.checked_add_unsigned(*value).filter(|v| v <= hi))
                .ok_or("its run gives an input a value that it cannot have")?;
            self.inputs[k] = value;
        }
        let inputs = &self.inputs;
        self.frame.start(&self.state);
        let made = self.bound.step(&mut self.frame, &mut |k| inputs[k]);
        self.state.copy_from_slice(&self.frame.now);
        Ok(Some(made.map(|()| self.at == self.run.steps.len())))
    }

    /// Atom `k` in the cycle just made.
    pub fn atom(&mut self, k: usize) -> bool {
        let inputs = &self.inputs;
        self.bound.atom(k, &mut self.frame, &mut |i| inputs[i])
    }

    /// Observed expression `k` in the cycle just made.
    pub fn observe(&mut self, k: usize) -> i64 {
        let inputs = &self.inputs;
        self.bound.observe(k, &mut self.frame, &mut |i| inputs[i])
    }
}
