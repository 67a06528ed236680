//! The cycles of a system, made by the interpreter: all of those a state has, and those of a given run.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;

use crate::cells::{Cells, Layout};
use crate::format::Run;
use crate::later::Later;
use crate::memo::{Memo, Watched};
use crate::states::Radix;

/// The effects with which an enumeration has gone on from the same cells.
#[derive(Debug, Default)]
struct Followed {
    /// How often it was started, and when each effect was last added.
    starts: u64,
    added: Vec<u64>,
}

impl Followed {
    /// The cells are others now.
    fn start(&mut self) {
        self.starts += 1;
    }

    /// Adds an effect; whether it is new.
    fn add(&mut self, effect: usize) -> bool {
        if self.added.len() <= effect {
            self.added.resize(effect + 1, 0);
        }
        std::mem::replace(&mut self.added[effect], self.starts) != self.starts
    }
}

/// The steps of the instances on one side, then the atoms and the observed expressions.
struct Parts<'a> {
    bound: &'a Bound,
    side: usize,
    steps: Vec<Memo>,
    atoms: Vec<Memo>,
    observed: Vec<Memo>,
    /// What matters after each step.
    later: Vec<Later>,
    /// For each step the effects with which the enumeration has gone on since the steps before it.
    followed: Vec<Followed>,
}

impl<'a> Parts<'a> {
    /// What matters after the steps are the state, and what `last` has in it.
    fn new(bound: &'a Bound, layout: &Layout, side: usize, mut last: Later) -> Self {
        (0..bound.states.len()).for_each(|k| last.cell(layout.now(k)));
        let mut later = Vec::new();
        for instance in bound.system.instances.iter().rev() {
            later.push(last.clone());
            for rule in &instance.rules {
                last.node(&rule.when, layout);
                let mut node = |node| last.node(node, layout);
                rule.then.iter().for_each(|s| s.expressions(&mut node));
            }
        }
        later.reverse();
        let memos = |count| (0..count).map(|_| Memo::new()).collect();
        Self {
            bound,
            side,
            steps: memos(bound.system.instances.len()),
            atoms: memos(bound.system.atoms.len()),
            observed: memos(bound.system.observed.len()),
            followed: later.iter().map(|_| Followed::default()).collect(),
            later,
        }
    }

    /// The enumeration begins, for other cells.
    fn start(&mut self) {
        self.followed.iter_mut().take(1).for_each(Followed::start);
    }

    /// The steps of the instances from instance `from` on, which are the parts of the enumeration from `part` on. None if they have
    /// the effect of others: what would come now has been there.
    fn step(&mut self, cells: &mut Cells, part: usize, from: usize) -> Option<Result<(), u32>> {
        for k in from..self.steps.len() {
            cells.begin(part + k);
            let run = |m: &mut Watched| self.bound.step_over(k, m).map(|()| 0);
            let later = Some(&self.later[k]);
            let (step, number) = self.steps[k].effect(cells, self.side, later, run);
            if number.is_some_and(|number| !self.followed[k].add(number)) {
                return None;
            }
            if let Err(site) = step.result {
                return Some(Err(site));
            }
            for (cell, digit) in &step.writes {
                cells.write(self.side, *cell, *digit);
            }
            if let Some(next) = self.followed.get_mut(k + 1) {
                next.start();
            }
        }
        Some(Ok(()))
    }

    /// Atom `k` after the step. It has this value whenever it is asked for, so named expressions need not be kept.
    fn atom(&mut self, cells: &mut Cells, k: usize) -> bool {
        let bound = self.bound;
        let run = |m: &mut Watched| Ok(bound.value_over(&bound.system.atoms[k], m));
        let (value, _) = self.atoms[k].effect(cells, self.side, None, run);
        value.result != Ok(0)
    }

    /// Observed expression `k` after the step.
    fn observed(&mut self, cells: &mut Cells, k: usize) -> Result<i64, u32> {
        let bound = self.bound;
        let run = |m: &mut Watched| Ok(bound.value_over(&bound.system.observed[k], m));
        let (value, _) = self.observed[k].effect(cells, self.side, None, run);
        value.result
    }
}

/// The cycles of one state after the other.
pub struct Cycle<'a> {
    parts: Parts<'a>,
    cells: Cells,
}

impl<'a> Cycle<'a> {
    /// Work area for `bound`. Each list of atoms has a mark: a set of bits.
    pub fn new(bound: &'a Bound, radix: &Radix, atoms: &[(u128, Vec<usize>)]) -> Self {
        let mut cells = Cells::new(bound, radix, 1);
        let mut last = Later::new(bound, &cells.layout);
        for (mark, atoms) in atoms {
            let mut these = Later::new(bound, &cells.layout);
            for atom in atoms {
                last.node(&bound.system.atoms[*atom], &cells.layout);
                these.node(&bound.system.atoms[*atom], &cells.layout);
            }
            cells.mark(&these.all(|_| false), *mark);
        }
        Self {
            parts: Parts::new(bound, &cells.layout, 0, last),
            cells,
        }
    }

    /// Makes every cycle from the state of this number; `visit` is told whether the step succeeded, or at which site it left a
    /// range.
    ///
    /// # Errors
    /// The first one of `visit`, which ends the enumeration.
    pub fn each<E>(
        &mut self,
        state: u128,
        mut visit: impl FnMut(&mut Self, Result<(), u32>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.cells.start(self.parts.bound, &[state]);
        self.parts.start();
        let mut from = Some(0);
        while let Some(k) = from {
            if let Some(made) = self.parts.step(&mut self.cells, 0, k) {
                visit(self, made)?;
            }
            from = self.cells.advance(0);
        }
        Ok(())
    }

    /// The marks of the cells in which this cycle differs from the one in which this was last asked, among those from the same state;
    /// all if there is none.
    pub fn marked(&mut self) -> u128 {
        self.cells.marked()
    }

    /// Whether `judge` is true for every combination of the inputs that it reads and the step did not.
    pub fn all(&mut self, mut judge: impl FnMut(&mut Self) -> bool) -> bool {
        let kept = self.cells.choices();
        self.cells.begin(0);
        loop {
            let fine = judge(self);
            if !fine {
                self.cells.forget(kept);
            }
            // The next property must not see what this one read.
            if self.cells.advance(kept).is_none() {
                return fine;
            }
        }
    }

    /// Atom `k` in this cycle, under the present combination of inputs.
    pub fn atom(&mut self, k: usize) -> bool {
        self.parts.atom(&mut self.cells, k)
    }

    /// The number of the state after the cycle.
    pub fn after(&self) -> u128 {
        self.cells.number(0)
    }

    /// The inputs read so far, as a step of a [`Run`].
    pub fn inputs(&self) -> Vec<(u32, u32)> {
        let digits = (0..self.parts.bound.inputs.len()).map(|k| self.cells.input(0, k));
        (digits.enumerate())
            .filter_map(|(k, digit)| Some((k as u32, digit.checked_sub(1)?)))
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
    pairing: Pairing<'a>,
    one: Parts<'a>,
    other: Parts<'a>,
    cells: Cells,
    /// Whether the condition holds in the first run.
    free: bool,
}

impl<'a> PairCycle<'a> {
    /// Work area for pairs of runs of `bound`.
    pub fn new(bound: &'a Bound, radix: &Radix, pairing: Pairing<'a>) -> Self {
        let cells = Cells::new(bound, radix, 2);
        let mut last = Later::new(bound, &cells.layout);
        let condition = pairing.condition.iter().map(|c| &bound.system.atoms[*c]);
        let observed = pairing.observe.iter().map(|k| &bound.system.observed[*k]);
        condition
            .chain(observed)
            .for_each(|node| last.node(node, &cells.layout));
        let mut first = last.clone();
        // The second step may read any input that the first one has read; at the end the listed ones are compared.
        (0..bound.inputs.len()).for_each(|k| first.cell(cells.layout.input(k)));
        (pairing.of.iter()).for_each(|k| last.cell(cells.layout.input(*k)));
        // What the second step has named may still have to be evaluated in the first run, with the inputs that they share.
        let all = last.all(|_| false);
        let inputs = (0..bound.inputs.len()).map(|k| cells.layout.input(k));
        inputs.filter(|k| all[*k]).for_each(|k| last.cell(k));
        Self {
            pairing,
            one: Parts::new(bound, &cells.layout, 0, first),
            other: Parts::new(bound, &cells.layout, 1, last),
            cells,
            free: true,
        }
    }

    /// Makes every pair of cycles that may stand side by side from the states of these numbers. `visit` gets the numbers of the
    /// states after them, and whether the observed expressions agree (where the condition does not hold in both, they need not). A
    /// pair in which one step leaves a range does not go on.
    ///
    /// # Errors
    /// The first one of `visit`, which ends the enumeration.
    pub fn each<E>(
        &mut self,
        before: [u128; 2],
        mut visit: impl FnMut([u128; 2], bool) -> Result<(), E>,
    ) -> Result<(), E> {
        self.cells.start(self.one.bound, &before);
        self.one.start();
        let mut from = Some(0);
        while let Some(part) = from {
            if let Some(agree) = self.pair(part) {
                visit([self.cells.number(0), self.cells.number(1)], agree)?;
            }
            from = self.cells.advance(0);
        }
        Ok(())
    }

    /// One pair of cycles, made from a part on; none if there is no such pair. The parts are the first step, its condition, the
    /// second step, and what comes then.
    fn pair(&mut self, part: usize) -> Option<bool> {
        let Pairing {
            observe,
            of,
            condition,
        } = self.pairing;
        let (one, other, cells) = (&mut self.one, &mut self.other, &mut self.cells);
        let steps = one.steps.len();
        if part < steps {
            one.step(cells, 0, part)?.ok()?;
        }
        if part <= steps {
            cells.begin(steps);
            self.free = condition.is_none_or(|c| one.atom(cells, c));
            // Only where the condition holds a listed input has a value of its own in the second run.
            cells.keep_apart(if self.free { of } else { &[] });
            other.start();
        }
        let second = part.saturating_sub(steps + 1);
        other.step(cells, steps + 1, second)?.ok()?;
        cells.begin(2 * steps + 1);
        let both = self.free && condition.is_none_or(|c| other.atom(cells, c));
        if !both {
            // What one run does not read may be taken to be the same in both.
            let differ = |k: &usize| {
                let (one, other) = (cells.input(0, *k), cells.input(1, *k));
                one > 0 && other > 0 && one != other
            };
            return (!of.iter().any(differ)).then_some(true);
        }
        let mut agree = true;
        for k in observe {
            agree &= one.observed(cells, *k) == other.observed(cells, *k);
        }
        Some(agree)
    }
}

const NO_START: &str = "its run does not start in an initial state";

/// Replays a run; an input that a step does not list has its least value.
pub struct Player<'a> {
    bound: &'a Bound,
    steps: &'a [Vec<(u32, u32)>],
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
        match radix.state(run.initial, &mut state) {
            true => Self::begin(bound, state, &run.steps),
            false => Err(NO_START.to_owned()),
        }
    }

    /// Starts in a state; of each step the inputs with their values above the least.
    ///
    /// # Errors
    /// It is no initial state.
    pub fn begin(
        bound: &'a Bound,
        state: Vec<i32>,
        steps: &'a [Vec<(u32, u32)>],
    ) -> Result<Self, String> {
        let cells = state.iter().zip(&bound.initial).zip(&bound.states);
        let starts = |(value, init): (i32, Option<i32>), (lo, hi): (i32, i32)| {
            (lo..=hi).contains(&value) && init.is_none_or(|i| i == value)
        };
        if !cells
            .into_iter()
            .all(|((v, init), range)| starts((*v, *init), *range))
        {
            return Err(NO_START.to_owned());
        }
        Ok(Self {
            bound,
            steps,
            at: 0,
            state,
            inputs: Vec::new(),
            frame: Frame::new(bound),
        })
    }

    /// How many steps the run has.
    pub(crate) fn steps(&self) -> usize {
        self.steps.len()
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
        let Some(step) = self.steps.get(self.at) else {
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
        Ok(Some(made.map(|()| self.at == self.steps.len())))
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
