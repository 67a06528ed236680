//! The cycles of a system for the walk that collects what a certificate needs. They are made by the generated code where there
//! is one: what they show is confirmed by the checker's own, or there is no certificate.

use stillpoint_model::{Choices, System};

/// One input read: its number, the number of its values, its value above the least.
type Read = (u32, u32, u32);

/// The inputs read in a cycle, in the order of their reading; the last one turns fastest.
#[derive(Default)]
struct Reads {
    list: Vec<Read>,
    at: usize,
    /// Numbers read in this cycle, modulo 64: a quick negative answer to "was it read already".
    seen: u64,
}

impl Choices for Reads {
    #[inline]
    fn choose(&mut self, input: u32, size: u32) -> u32 {
        let bit = 1 << (input & 63);
        if self.seen & bit != 0 {
            if let Some((.., value)) = self.list[..self.at].iter().find(|r| r.0 == input) {
                return *value;
            }
        }
        self.seen |= bit;
        if self.at == self.list.len() {
            self.list.push((input, size, 0));
        }
        self.at += 1;
        self.list[self.at - 1].2
    }
}

impl Reads {
    fn begin(&mut self, (at, seen): (usize, u64)) {
        (self.at, self.seen) = (at, seen);
    }

    /// The next combination of what was read beyond the first `from` reads; false if there is none, and they are forgotten.
    fn advance(&mut self, from: usize) -> bool {
        while self.list.len() > from {
            let last = self.list.len() - 1;
            let (_, size, value) = &mut self.list[last];
            *value += 1;
            if *value < *size {
                return true;
            }
            self.list.truncate(last);
        }
        false
    }
}

/// The cycles of one state after the other.
pub(super) struct Cycle<'a, S: System> {
    system: &'a S,
    work: S::Work,
    kept: S::Work,
    after: Vec<i32>,
    reads: Reads,
    /// What the step has read: how many, and the quick marks.
    mark: (usize, u64),
}

impl<'a, S: System> Cycle<'a, S> {
    pub(super) fn new(system: &'a S) -> Self {
        Self {
            system,
            work: system.work(),
            kept: system.work(),
            after: vec![0; system.domains().len()],
            reads: Reads::default(),
            mark: (0, 0),
        }
    }

    /// Makes every cycle from `state`; `visit` is told whether the step succeeded, or at which site it left a range.
    ///
    /// # Errors
    /// The first one of `visit`, which ends the enumeration.
    pub(super) fn each<E>(
        &mut self,
        state: &[i32],
        mut visit: impl FnMut(&mut Self, Result<(), u32>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.reads.list.clear();
        loop {
            self.reads.begin((0, 0));
            let made = self
                .system
                .next(&mut self.work, state, &mut self.reads, &mut self.after);
            self.mark = (self.reads.at, self.reads.seen);
            if self.system.atoms_read() {
                self.kept.clone_from(&self.work);
            }
            visit(self, made.map_err(|fault| fault.code))?;
            if !self.reads.advance(0) {
                return Ok(());
            }
        }
    }

    /// Whether `judge` is true for every combination of the inputs that it reads and the step did not.
    pub(super) fn all(&mut self, mut judge: impl FnMut(&mut Self) -> bool) -> bool {
        loop {
            self.reads.begin(self.mark);
            let fine = judge(self);
            if self.reads.at > self.mark.0 {
                // The next combination, and the next property, must not see what this one read.
                self.work.clone_from(&self.kept);
            }
            if !fine {
                self.reads.list.truncate(self.mark.0);
            }
            if !fine || !self.reads.advance(self.mark.0) {
                self.reads.begin(self.mark);
                return fine;
            }
        }
    }

    /// Atom `k` in this cycle, under the present combination of inputs.
    pub(super) fn atom(&mut self, k: usize) -> bool {
        let value = self.system.atom(&mut self.work, k, &mut self.reads);
        // An atom that meets a fault counts as FALSE; the checker says what it makes of it.
        value.unwrap_or(false)
    }

    /// The state after the cycle.
    pub(super) fn after(&self) -> &[i32] {
        &self.after
    }

    /// The inputs read so far, in the order of their numbers.
    pub(super) fn inputs(&self) -> Vec<(u32, u32)> {
        let read = self.reads.list[..self.reads.at].iter();
        let mut inputs: Vec<_> = read.map(|(input, _, value)| (*input, *value)).collect();
        inputs.sort_unstable();
        inputs
    }
}
