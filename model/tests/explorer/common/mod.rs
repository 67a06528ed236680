//! What several tests share: systems given by explicit tables, and the replay of traces.

pub mod large;
pub mod naive;
pub mod shown;
pub mod yardstick;

use stillpoint_model::{Choices, Domain, Fault, Replay, System, Trace};

/// Inputs of a [`Table`]: sizes of inputs 0, 1, 2.
pub type Sizes = [u32; 3];

/// A system given by tables over (state, input 0, input 1, input 2). It reads inputs on demand: a state tells which of
/// inputs 0 and 1 its step reads, an atom which inputs it depends on.
#[derive(Clone, Debug)]
pub struct Table {
    pub states: usize,
    pub sizes: Sizes,
    pub initial: Vec<usize>,
    /// Whether the step of a state depends on inputs 0 and 1.
    pub reads: Vec<[bool; 2]>,
    /// By state, input 0, input 1 (0 where not read): the next state, or the code of a fault.
    pub next: Vec<Result<usize, u32>>,
    /// For each atom: which inputs it depends on, and its value by state and inputs (0 where not read).
    pub atoms: Vec<([bool; 3], Vec<bool>)>,
    pub domains: Vec<Domain>,
    /// The variable whose values may be stored as intervals.
    pub timer: Option<usize>,
}

/// The state before, and the state after.
#[derive(Clone, Copy, Default)]
pub struct Frame {
    before: usize,
    after: usize,
}

/// Constant variables that widen the index space: none for a bitmap, one for 64-bit, three for 128-bit keys.
pub fn padding(count: usize) -> Vec<Domain> {
    vec![
        Domain {
            lo: i32::MIN,
            hi: i32::MAX
        };
        count
    ]
}

impl Table {
    pub fn index(&self, state: usize, inputs: [u32; 3]) -> usize {
        let mut index = state;
        for (size, value) in self.sizes.iter().zip(inputs) {
            index = index * *size as usize + value as usize;
        }
        index
    }

    pub fn cells(&self) -> usize {
        self.states * self.sizes.iter().product::<u32>() as usize
    }

    fn write(&self, number: usize, state: &mut [i32]) {
        state.fill(77);
        state[0] = (number / 3) as i32 - 1;
        state[1] = (number % 3) as i32;
    }

    pub fn number(state: &[i32]) -> usize {
        (state[0] + 1) as usize * 3 + state[1] as usize
    }

    pub fn basic(states: usize, sizes: Sizes, padding: Vec<Domain>) -> Self {
        let own = [
            Domain {
                lo: -1,
                hi: (states as i32 - 1) / 3 - 1,
            },
            Domain { lo: 0, hi: 2 },
        ];
        let mut table = Table {
            states,
            sizes,
            initial: vec![0],
            reads: vec![[true; 2]; states],
            next: Vec::new(),
            atoms: Vec::new(),
            domains: own.into_iter().chain(padding).collect(),
            timer: None,
        };
        table.next = vec![Ok(0); table.cells()];
        table
    }

    /// The system of a labelled graph: input 0 chooses among the edges of a state, which are pairs (target, atoms).
    pub fn graph(edges: &[&[(usize, &[usize])]], atoms: usize) -> Self {
        let most = edges.iter().map(|e| e.len()).max().unwrap_or(1) as u32;
        let mut table = Table::basic(edges.len(), [most, 1, 1], Vec::new());
        table.atoms = vec![([true, false, false], vec![false; table.cells()]); atoms];
        for (state, edges) in edges.iter().enumerate() {
            for choice in 0..most {
                let (to, marks) = edges[(choice as usize).min(edges.len() - 1)];
                let index = table.index(state, [choice, 0, 0]);
                table.next[index] = Ok(to);
                for mark in marks {
                    table.atoms[*mark].1[index] = true;
                }
            }
        }
        table
    }
}

impl System for Table {
    type Work = Frame;

    fn work(&self) -> Frame {
        Frame::default()
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn timer(&self) -> Option<usize> {
        self.timer
    }

    fn combinations(&self) -> u128 {
        self.sizes.iter().map(|s| u128::from(*s)).product()
    }

    fn initial<C: Choices>(&self, _: &mut Frame, c: &mut C, state: &mut [i32]) {
        let chosen = c.choose(9, self.initial.len() as u32) as usize;
        self.write(self.initial[chosen], state);
    }

    fn next<C: Choices>(
        &self,
        w: &mut Frame,
        before: &[i32],
        c: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        w.before = Self::number(before);
        let mut inputs = [0; 3];
        let [first, second] = self.reads[w.before];
        if first {
            inputs[0] = c.choose(0, self.sizes[0]);
        }
        if second {
            inputs[1] = c.choose(1, self.sizes[1]);
        }
        w.after = self.next[self.index(w.before, inputs)].map_err(|code| Fault { code })?;
        self.write(w.after, after);
        Ok(())
    }

    fn atom<C: Choices>(&self, w: &mut Frame, atom: usize, c: &mut C) -> Result<bool, Fault> {
        let mut inputs = [0; 3];
        for input in [2, 0, 1] {
            if self.atoms[atom].0[input] {
                inputs[input] = c.choose(input as u32, self.sizes[input]);
            }
        }
        Ok(self.atoms[atom].1[self.index(w.before, inputs)])
    }

    /// Rule s fires in every cycle from state s.
    fn rules(&self) -> usize {
        self.states
    }

    fn fired(&self, w: &Frame, each: &mut impl FnMut(usize)) {
        each(w.before);
    }

    fn observe<C: Choices>(
        &self,
        w: &mut Frame,
        expression: usize,
        c: &mut C,
    ) -> Result<i64, Fault> {
        self.atom(w, expression, c).map(i64::from)
    }
}

/// A replayed cycle: states before and after (none after a fault), and the values of the first `atoms` atoms.
pub struct Cycle {
    pub before: Vec<i32>,
    pub after: Result<Vec<i32>, Fault>,
    pub atoms: Vec<bool>,
}

pub fn replay<S: System>(system: &S, trace: &Trace, atoms: usize) -> Vec<Cycle> {
    let mut work = system.work();
    let mut state = vec![0; system.domains().len()];
    system.initial(&mut work, &mut Replay::new(&trace.initial), &mut state);
    let mut cycles = Vec::new();
    for step in &trace.steps {
        let mut choices = Replay::new(step);
        let mut after = state.clone();
        let result = system.next(&mut work, &state, &mut choices, &mut after);
        let values = match result {
            Ok(()) => (0..atoms)
                .map(|a| system.atom(&mut work, a, &mut choices).unwrap())
                .collect(),
            Err(_) => Vec::new(),
        };
        cycles.push(Cycle {
            before: state,
            after: result.map(|()| after.clone()),
            atoms: values,
        });
        state = after;
    }
    cycles
}

/// A small generator of pseudo-random numbers (splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let a = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let b = (a ^ (a >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        b ^ (b >> 31)
    }

    pub fn below(&mut self, size: usize) -> usize {
        (self.next() % size as u64) as usize
    }

    pub fn percent(&mut self, chance: usize) -> bool {
        self.below(100) < chance
    }
}

/// A random system with `atoms` atoms.
pub fn random_table(seed: u64, atoms: usize, padding: Vec<Domain>) -> Table {
    let mut random = Random(seed);
    let states = 1 + random.below(10);
    let sizes = [
        1 + random.below(3) as u32,
        1 + random.below(3) as u32,
        1 + random.below(2) as u32,
    ];
    let mut table = Table::basic(states, sizes, padding);
    table.initial = (0..1 + random.below(3))
        .map(|_| random.below(states))
        .collect();
    let faults = if random.percent(20) { 6 } else { 0 };
    // Mostly local moves make long paths.
    let local = random.percent(50);
    for cell in table.next.iter_mut() {
        *cell = Ok(random.below(states));
        if random.percent(faults) {
            *cell = Err(random.below(3) as u32);
        }
    }
    if local {
        let per_state = table.cells() / states;
        for (index, cell) in table.next.iter_mut().enumerate() {
            if cell.is_ok() && random.percent(80) {
                *cell = Ok((index / per_state + random.below(2)) % states);
            }
        }
    }
    for reads in &mut table.reads {
        *reads = [random.percent(70), random.percent(60)];
    }
    for _ in 0..atoms {
        let chance = [5, 20, 50, 80, 95][random.below(5)];
        let depends = [random.percent(50), random.percent(40), random.percent(40)];
        let values = (0..table.cells()).map(|_| random.percent(chance)).collect();
        table.atoms.push((depends, values));
    }
    table
}
