//! The cells of a cycle, and all combinations of the inputs that it reads, by backtracking.

use stillpoint_lang::bind::Bound;

use crate::states::Radix;

/// How cells are numbered: the state before, the state now, the inputs, the named expressions. The value of a cell is kept as a
/// digit. That of a state variable counts from its least value on; for inputs and named expressions 0 means that they have no value
/// yet, 1 is the least one.
#[derive(Debug)]
pub(crate) struct Layout {
    /// For each cell the value of digit 0, and the greatest value.
    ranges: Vec<(i32, i32)>,
    states: usize,
    inputs: usize,
}

impl Layout {
    fn new(bound: &Bound) -> Self {
        // The least number of 32 bits is no variable's value: there is room below.
        let below = |(lo, hi): (i32, i32)| (lo.max(i32::MIN + 1) - 1, hi);
        let cut = |v: i64| v.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32;
        let named = bound.system.lazies.iter().map(|l| (cut(l.lo), cut(l.hi)));
        let inputs = bound.inputs.iter().copied();
        let states = bound.states.iter().chain(&bound.states).copied();
        Self {
            ranges: states.chain(inputs.chain(named).map(below)).collect(),
            states: bound.states.len(),
            inputs: bound.inputs.len(),
        }
    }

    /// The number of cells.
    fn len(&self) -> usize {
        self.ranges.len()
    }

    /// The greatest digit of a cell.
    pub(crate) fn greatest(&self, cell: usize) -> u32 {
        let (lo, hi) = self.ranges[cell];
        hi.abs_diff(lo)
    }

    pub(crate) fn before(&self, k: usize) -> usize {
        k
    }

    pub(crate) fn now(&self, k: usize) -> usize {
        self.states + k
    }

    pub(crate) fn input(&self, k: usize) -> usize {
        2 * self.states + k
    }

    pub(crate) fn named(&self, k: usize) -> usize {
        2 * self.states + self.inputs + k
    }

    /// The input that is kept in a cell.
    pub(crate) fn input_in(&self, cell: usize) -> Option<usize> {
        cell.checked_sub(2 * self.states)
            .filter(|k| *k < self.inputs)
    }

    pub(crate) fn value(&self, cell: usize, digit: u32) -> i32 {
        self.ranges[cell].0.wrapping_add_unsigned(digit)
    }

    /// # Panics
    /// If the loader was wrong about the range of an assignment that needs no check, or of a named expression.
    pub(crate) fn digit(&self, cell: usize, value: i32) -> u32 {
        let (lo, hi) = self.ranges[cell];
        assert!((lo..=hi).contains(&value), "a value is outside its range");
        value.abs_diff(lo)
    }
}

/// An input whose value was chosen.
#[derive(Clone, Copy, Debug)]
struct Choice {
    place: usize,
    /// What has to be made again with another value, and the length of the trail when it began.
    stage: Stage,
}

/// A part of an enumeration, and the length of the trail when it began.
type Stage = (usize, usize);

/// The cells of one cycle, or of two side by side. Those of the second one stand behind those of the first.
///
/// An input has no value until it is read, and then its least one; the last one read turns fastest. An input that nobody reads has
/// any value: it is not enumerated.
#[derive(Debug)]
pub(crate) struct Cells {
    pub(crate) layout: Layout,
    radix: Radix,
    /// The digit of each cell.
    digits: Vec<u32>,
    /// By how much a digit of each cell raises the number of the state now.
    weights: Vec<u128>,
    /// That number, on each side.
    numbers: Vec<u128>,
    /// Cells of the first side with their sets of marks, and the digits that they had when these were last asked for.
    marks: Vec<(usize, u128, u32)>,
    /// Whether that was after the same start.
    asked: bool,
    /// Where other digits were written, and the digits before.
    trail: Vec<(usize, u32)>,
    choices: Vec<Choice>,
    stage: Stage,
    /// Inputs that may differ between the sides.
    apart: Vec<bool>,
    state: Vec<i32>,
}

impl Cells {
    /// The cells of one side or two.
    pub(crate) fn new(bound: &Bound, radix: &Radix, sides: usize) -> Self {
        let layout = Layout::new(bound);
        let mut weights = vec![0; layout.len()];
        for (k, weight) in radix.weights().into_iter().enumerate() {
            weights[layout.now(k)] = weight;
        }
        Self {
            radix: radix.clone(),
            digits: vec![0; sides * layout.len()],
            weights: weights.repeat(sides),
            numbers: vec![0; sides],
            marks: Vec::new(),
            asked: false,
            trail: Vec::new(),
            choices: Vec::new(),
            stage: (0, 0),
            apart: vec![false; bound.inputs.len()],
            state: vec![0; bound.states.len()],
            layout,
        }
    }

    /// Starts with the states of these numbers, one for each side.
    pub(crate) fn start(&mut self, bound: &Bound, states: &[u128]) {
        self.digits.fill(0);
        for (side, number) in states.iter().enumerate() {
            self.radix.state(*number, &mut self.state);
            for (k, (value, (lo, _))) in self.state.iter().zip(&bound.states).enumerate() {
                for cell in [self.layout.before(k), self.layout.now(k)] {
                    self.digits[side * self.layout.len() + cell] = value.abs_diff(*lo);
                }
            }
        }
        self.numbers.copy_from_slice(states);
        self.trail.clear();
        self.choices.clear();
        self.asked = false;
    }

    /// The number of the state now.
    pub(crate) fn number(&self, side: usize) -> u128 {
        self.numbers[side]
    }

    /// The digit of a cell on one side. An input without a value gets one: that of the other side, or else its least one.
    pub(crate) fn read(&mut self, side: usize, cell: usize) -> u32 {
        let place = side * self.layout.len() + cell;
        let digit = self.digits[place];
        if digit > 0 {
            return digit;
        }
        let Some(input) = self.layout.input_in(cell) else {
            return 0;
        };
        if self.numbers.len() == 2 && !self.apart[input] {
            let other = self.digits[(1 - side) * self.layout.len() + cell];
            if other > 0 {
                self.write(side, cell, other);
                return other;
            }
        }
        self.set(place, 1);
        let stage = self.stage;
        self.choices.push(Choice { place, stage });
        1
    }

    /// The digit of an input on one side, 0 if it was not read.
    pub(crate) fn input(&self, side: usize, input: usize) -> u32 {
        self.digits[side * self.layout.len() + self.layout.input(input)]
    }

    /// Gives a cell on one side a digit.
    pub(crate) fn write(&mut self, side: usize, cell: usize, digit: u32) {
        let place = side * self.layout.len() + cell;
        if self.digits[place] != digit {
            self.trail.push((place, self.digits[place]));
            self.set(place, digit);
        }
    }

    fn set(&mut self, place: usize, digit: u32) {
        let old = std::mem::replace(&mut self.digits[place], digit);
        let side = usize::from(place >= self.layout.len());
        let more = u128::from(digit).wrapping_sub(u128::from(old));
        let number = self.numbers[side].wrapping_add(more.wrapping_mul(self.weights[place]));
        self.numbers[side] = number;
    }

    /// The choices from now on belong to this part of the enumeration.
    pub(crate) fn begin(&mut self, part: usize) {
        self.stage = (part, self.trail.len());
    }

    /// How many choices there are.
    pub(crate) fn choices(&self) -> usize {
        self.choices.len()
    }

    /// Sets the next combination of the choices beyond the first `kept`, and tells the part that has to be made again. If there
    /// is none, these choices are forgotten.
    pub(crate) fn advance(&mut self, kept: usize) -> Option<usize> {
        while self.choices.len() > kept {
            let Choice { place, stage } = self.choices[self.choices.len() - 1];
            while self.trail.len() > stage.1 {
                if let Some((place, digit)) = self.trail.pop() {
                    self.set(place, digit);
                }
            }
            let digit = self.digits[place];
            if digit < self.layout.greatest(place % self.layout.len()) {
                self.set(place, digit + 1);
                return Some(stage.0);
            }
            self.set(place, 0);
            self.choices.pop();
        }
        None
    }

    /// Forgets the choices beyond the first `kept`.
    pub(crate) fn forget(&mut self, kept: usize) {
        while self.choices.len() > kept {
            if let Some(choice) = self.choices.pop() {
                self.set(choice.place, 0);
            }
        }
    }

    /// Which inputs may differ between the sides.
    pub(crate) fn keep_apart(&mut self, inputs: &[usize]) {
        self.apart.fill(false);
        inputs.iter().for_each(|k| self.apart[*k] = true);
    }

    /// Gives marks to the chosen cells of the first side.
    pub(crate) fn mark(&mut self, chosen: &[bool], marks: u128) {
        // The state before stays as it is.
        for cell in (self.layout.now(0)..chosen.len()).filter(|cell| chosen[*cell]) {
            match self.marks.iter_mut().find(|(known, ..)| *known == cell) {
                Some((_, all, _)) => *all |= marks,
                None => self.marks.push((cell, marks, 0)),
            }
        }
    }

    /// The marks of the cells that differ from those when this was last asked; all for the first time after the start.
    pub(crate) fn marked(&mut self) -> u128 {
        let mut marked = 0;
        for (cell, marks, last) in &mut self.marks {
            let digit = self.digits[*cell];
            if std::mem::replace(last, digit) != digit {
                marked |= *marks;
            }
        }
        match std::mem::replace(&mut self.asked, true) {
            true => marked,
            false => u128::MAX,
        }
    }
}
