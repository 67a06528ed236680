//! Random runs of table and monitor at full width. A test, not a proof.
//!
//! A run is a sequence of moves, not of independent values: a signal changes and is held, a timer is waited out, one cycle
//! shorter or longer, a measured value stops one unit before or behind a limit, or jumps, RESET or power-on come for one
//! cycle. Each run has its own taste: moves and inputs that it likes, and others that it leaves alone. Where a family says what its
//! inputs are while nothing is wrong, one run of four begins so and likes few of them: what several things in order bring about comes in
//! such a run.

use super::product::{Product, Values, Work};

/// SplitMix64: small, and the same numbers on every machine.
pub struct Random(u64);

impl Random {
    /// The sequence of `seed`.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// An independent sequence for piece `number` of the work on subject `subject`.
    pub fn fork(seed: u64, subject: u64, number: u64) -> Self {
        let mut mixed = Self(seed);
        let mut mixed = Self(mixed.draw() ^ subject);
        Self(mixed.draw() ^ number)
    }

    /// The next 64 bits.
    pub fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in `0..n`.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.draw()) * n as u128) >> 64) as usize
    }

    /// One of these.
    fn of<'a, T>(&mut self, all: &'a [T]) -> Option<&'a T> {
        all.get(self.below(all.len()))
    }
}

/// Cycles of one run before both sides start anew.
pub const RUN: u64 = 400;

/// A run on which the sides part: the initial cells and the inputs of each cycle.
pub struct Divergence {
    /// Both initial states.
    pub start: Vec<i32>,
    /// The inputs of each cycle, the last one being the first that differs.
    pub cycles: Vec<Vec<i32>>,
}

/// What a run does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Move {
    /// One input takes another value.
    Change,
    /// Several inputs do in the same cycle.
    Together,
    /// An input takes another value for one cycle: an acknowledgement, power-on, a glitch.
    Pulse,
    /// A measured value stops one unit before or behind a limit, or at it.
    Approach,
    /// A measured value goes on by a small step.
    Creep,
    /// All is held until a timer has run out, or nearly.
    WaitOut,
    /// Every input goes back to where the run began.
    Calm,
}

const MOVES: [Move; 7] = [
    Move::Change,
    Move::Together,
    Move::Pulse,
    Move::Approach,
    Move::Creep,
    Move::WaitOut,
    Move::Calm,
];

/// A product that is driven by random runs; what it needs is made once.
pub struct Driver<'a> {
    product: &'a Product<'a>,
    work: Work,
    /// Inputs that can take more than one value.
    live: Vec<usize>,
    /// Those of them with a wide range: measured values.
    wide: Vec<usize>,
    /// What the inputs are while nothing is wrong; empty where nobody has said it of any.
    calm: Vec<i32>,
    /// Parameters that can be limits, and times.
    limits: Vec<i64>,
    cells: Vec<i32>,
    history: Vec<i32>,
}

/// The taste of one run.
struct Taste {
    moves: Vec<Move>,
    inputs: Vec<usize>,
    home: Vec<i32>,
}

impl<'a> Driver<'a> {
    /// A driver of this product; `calm`: values of inputs while nothing is wrong.
    pub fn new(product: &'a Product<'a>, calm: &[(&str, i32)]) -> Self {
        let count = |k: usize| product.values(k).count();
        let live: Vec<usize> = (0..product.inputs()).filter(|k| count(*k) > 1).collect();
        let wide = live
            .iter()
            .copied()
            .filter(|k| matches!(product.values(*k), Values::Range(..)) && count(*k) > 2);
        let mut limits: Vec<i64> = product.parameters().map(i64::from).collect();
        limits.sort_unstable();
        limits.dedup();
        Self {
            product,
            work: product.new_work(),
            wide: wide.collect(),
            live,
            calm: at_rest(product, calm),
            limits,
            cells: Vec::new(),
            history: Vec::new(),
        }
    }

    /// Drives both sides for one run of `length` cycles.
    pub fn run(&mut self, random: &mut Random, length: u64) -> Option<Divergence> {
        let product = self.product;
        let start = product.start(&mut |k| {
            let domain = stillpoint_model::System::domains(product)[k];
            let value = i64::from(domain.lo) + random.below(domain.size() as usize) as i64;
            i32::try_from(value).unwrap_or(domain.hi)
        });
        let taste = self.taste(random);
        let mut now = taste.home.clone();
        self.cells.clear();
        self.cells.extend_from_slice(&start);
        self.history.clear();
        let mut left = usize::try_from(length).unwrap_or(usize::MAX);
        while left > 0 {
            let (hold, back) = self.act(&taste, &mut now, random);
            let hold = hold.clamp(1, left);
            for _ in 0..hold {
                self.work.set_inputs(&now);
                self.history.extend_from_slice(&now);
                let failed = product.step(&mut self.work, &mut self.cells).is_err();
                if failed || !product.agree(&self.work) {
                    let cycles = self
                        .history
                        .chunks(now.len())
                        .map(<[i32]>::to_vec)
                        .collect();
                    return Some(shrink(product, Divergence { start, cycles }));
                }
            }
            left -= hold;
            if let Some((input, value)) = back {
                now[input] = value;
            }
        }
        None
    }

    fn taste(&self, random: &mut Random) -> Taste {
        let calm = !self.calm.is_empty() && random.below(4) == 0;
        // Two of three inputs, or one.
        let likes = if calm { 2 } else { 1 };
        let mut moves: Vec<Move> = MOVES.into_iter().filter(|_| random.below(3) > 0).collect();
        if moves.is_empty() {
            moves.push(Move::Change);
        }
        let mut inputs: Vec<usize> = self
            .live
            .iter()
            .copied()
            .filter(|_| random.below(3) >= likes)
            .collect();
        if inputs.is_empty() {
            inputs.clone_from(&self.live);
        }
        let any = |k: usize| any(self.product.values(k), random);
        let home = match calm {
            true => self.calm.clone(),
            false => (0..self.product.inputs()).map(any).collect(),
        };
        Taste {
            moves,
            inputs,
            home,
        }
    }

    /// Makes one move: how many cycles it is held, and which input goes back after that.
    fn act(
        &self,
        taste: &Taste,
        now: &mut [i32],
        random: &mut Random,
    ) -> (usize, Option<(usize, i32)>) {
        let Some(&input) = random.of(&taste.inputs) else {
            return (usize::MAX, None);
        };
        let measured = random.of(&self.wide).copied().unwrap_or(input);
        match random.of(&taste.moves).copied().unwrap_or(Move::Change) {
            Move::Change => now[input] = any(self.product.values(input), random),
            Move::Together => {
                for input in &taste.inputs {
                    if random.below(2) == 0 {
                        now[*input] = any(self.product.values(*input), random);
                    }
                }
            }
            Move::Pulse => {
                let before = now[input];
                now[input] = any(self.product.values(input), random);
                return (1, Some((input, before)));
            }
            Move::Approach => now[measured] = self.near_a_limit(measured, now, random),
            Move::Creep => {
                let step = random.below(7) as i64 - 3;
                now[measured] = clamped(
                    self.product.values(measured),
                    i64::from(now[measured]) + step,
                );
            }
            Move::WaitOut => {
                let time = random.of(&self.limits).copied().unwrap_or(1);
                let cycles = time.clamp(0, RUN as i64) as usize + random.below(3);
                return (cycles, None);
            }
            Move::Calm => now.copy_from_slice(&taste.home),
        }
        let hold = match random.below(4) {
            0 => 2 + random.below(14),
            1 => 2,
            _ => 1,
        };
        (hold, None)
    }

    /// A limit, or the sum of two, away from 0, from where the value is or from where another one is; or a unit beside that.
    fn near_a_limit(&self, input: usize, now: &[i32], random: &mut Random) -> i32 {
        let mut limit = || random.of(&self.limits).copied().unwrap_or(0);
        let (one, two) = (limit(), limit());
        let from = match random.below(4) {
            0 => 0,
            1 => i64::from(now[input]),
            _ => random.of(&self.wide).map_or(0, |k| i64::from(now[*k])),
        };
        let away = match random.below(6) {
            0 => 0,
            1 | 2 => one,
            3 => -one,
            4 => one + two,
            _ => one - two,
        };
        let beside = random.below(3) as i64 - 1;
        clamped(self.product.values(input), from + away + beside)
    }
}

/// The inputs while nothing is wrong: those named by their values, the others as near to 0 as they can be. Empty where none is named.
fn at_rest(product: &Product, calm: &[(&str, i32)]) -> Vec<i32> {
    let named = |k: usize| product.named(k, calm);
    if !(0..product.inputs()).any(|k| named(k).is_some()) {
        return Vec::new();
    }
    let rest = |k: usize| clamped(product.values(k), i64::from(named(k).unwrap_or(0)));
    (0..product.inputs()).map(rest).collect()
}

/// The nearest value of a range; of a list, one of it.
fn clamped(values: Values, value: i64) -> i32 {
    match values {
        Values::Range(lo, hi) => {
            i32::try_from(value.clamp(i64::from(lo), i64::from(hi))).unwrap_or(hi)
        }
        Values::List(_) => values.get(value.unsigned_abs() % values.count().max(1)),
    }
}

/// A value of the range: of a wide one often an end, or the neighbour of an end.
fn any(values: Values, random: &mut Random) -> i32 {
    let count = values.count();
    let last = count - 1;
    if count <= 16 {
        return values.get(random.draw() % count);
    }
    match random.below(8) {
        0 => values.get(0),
        1 => values.get(1),
        2 => values.get(last - 1),
        3 => values.get(last),
        _ => values.get(random.draw() % count),
    }
}
/// The cycle (from 0) in which the sides part, if they do.
fn parts(product: &Product, start: &[i32], cycles: &[Vec<i32>]) -> Option<usize> {
    let mut work = product.new_work();
    let mut cells = start.to_vec();
    for (n, inputs) in cycles.iter().enumerate() {
        work.set_inputs(inputs);
        if product.step(&mut work, &mut cells).is_err() || !product.agree(&work) {
            return Some(n);
        }
    }
    None
}

/// Leaves out cycles and calms inputs as long as the sides still part.
pub fn shrink(product: &Product, found: Divergence) -> Divergence {
    let mut best = found;
    let mut chunk = best.cycles.len();
    while chunk > 0 {
        let mut at = 0;
        while at < best.cycles.len() {
            let mut fewer = best.cycles.clone();
            fewer.drain(at..(at + chunk).min(fewer.len()));
            match parts(product, &best.start, &fewer) {
                Some(n) => {
                    fewer.truncate(n + 1);
                    best.cycles = fewer;
                }
                None => at += chunk,
            }
        }
        chunk /= 2;
    }
    for n in 0..best.cycles.len() {
        for k in 0..best.cycles[n].len() {
            let calm = if n > 0 {
                best.cycles[n - 1][k]
            } else {
                product.values(k).get(0)
            };
            if best.cycles[n][k] != calm {
                let mut other = best.cycles.clone();
                other[n][k] = calm;
                if parts(product, &best.start, &other) == Some(other.len() - 1) {
                    best.cycles = other;
                }
            }
        }
    }
    best
}
