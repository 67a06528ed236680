//! The set of states found and the frontier of the level being explored.

use crate::bitmap::{Bitmap, place};
use crate::checkpoint::{In, Out};
use crate::crew::Crew;
use crate::pack::Key;
use std::io;
use std::sync::atomic::Ordering;

/// A set of states that grows level by level. `visit` runs in all workers at once, the rest between levels.
pub(crate) trait Store: Sync {
    type Key: Key;
    /// What one worker collects during a level.
    type Local: Send;
    fn local(&self) -> Self::Local;
    /// Adds a state; if it is new it becomes part of the next frontier.
    fn visit(&self, local: &mut Self::Local, key: Self::Key);
    /// Adds what a worker still has of its own, as the level is over for it.
    fn settle(&self, _: &mut Self::Local) {}
    /// Ends the level: what the workers found is the frontier now. Gives its size.
    fn advance(&mut self, locals: Vec<&mut Self::Local>) -> u64;
    /// Forgets what the workers found in a level that was not explored to its end. Gives how many states that were.
    fn undo(&mut self, locals: Vec<&mut Self::Local>) -> u64;
    /// What a checkpoint calls this storage.
    const NAME: &'static str;
    /// Writes the states and the frontier.
    fn save(&self, out: &mut Out) -> io::Result<()>;
    /// Reads them into an empty store.
    fn load(&mut self, input: &mut In) -> io::Result<()>;
    /// Brings the frontier in an order in which states next to each other are much alike, where it has none: what is known of one
    /// helps with the next.
    fn arrange(&mut self, _: &Crew) {}
    /// The frontier in pieces, to be shared out.
    fn pieces(&self) -> usize;
    fn each(&self, piece: usize, visit: impl FnMut(Self::Key));
    /// The number of states in the frontier.
    fn size(&self) -> u64;
    /// All states that are held, which should be so many; those found later stand behind those found before, as far as that is known.
    fn all(&self, states: usize) -> Vec<Self::Key>;
    /// Bytes held.
    fn bytes(&self) -> u64;
    /// Empties the set.
    fn clear(&mut self);

    /// The frontier in ascending order.
    fn frontier(&self) -> Vec<Self::Key> {
        let mut keys = Vec::new();
        for piece in 0..self.pieces() {
            self.each(piece, |key| keys.push(key));
        }
        keys.sort_unstable();
        keys
    }
}

/// States of a list handed out at once.
pub(crate) const PIECE: usize = 64;
/// Bitmap words handed out at once.
const WORDS: usize = 64;

/// A bitmap with one bit an index, and a list of the frontier. Where a level has more states than such a list may hold,
/// a second bitmap carries the frontier. With both, a state is (visited, wave):
/// 00 not found, 10 explored, 01 in the present frontier, 11 in the next one.
pub(crate) struct Dense {
    visited: Bitmap,
    wave: Bitmap,
    /// The frontier is in the wave bitmap, else in the list.
    in_wave: bool,
    list: Vec<u64>,
    /// States in the frontier.
    size: u64,
    /// The longest list of one worker.
    most: usize,
    peak: u64,
}

/// What a worker found in a level.
pub(crate) struct DenseLocal {
    found: Vec<u64>,
    count: u64,
    spilled: bool,
}

impl Dense {
    /// The bytes needed for `space` indices at most: two bits each, and the page tables.
    pub(crate) fn need(space: u128) -> u128 {
        space / 4 + space / 4096 + 65536
    }

    /// States of the list handed out at once: few where there are few, so that each worker gets some; many where there are
    /// many, so that two workers seldom write to neighbouring words.
    fn piece(&self) -> usize {
        (self.list.len() / 16).clamp(1, 1024)
    }

    pub(crate) fn new(space: u64, threads: usize) -> Self {
        let words = usize::try_from(space.div_ceil(64)).unwrap_or(usize::MAX);
        Dense {
            visited: Bitmap::new(words),
            wave: Bitmap::new(words),
            in_wave: false,
            list: Vec::new(),
            size: 0,
            // Lists of 64-bit indices that together take at most a quarter bit an index.
            most: (words / 4 / threads.max(1)).max(4096),
            peak: 0,
        }
    }
}

impl Store for Dense {
    type Key = u64;
    type Local = DenseLocal;

    fn local(&self) -> DenseLocal {
        DenseLocal {
            found: Vec::new(),
            count: 0,
            spilled: false,
        }
    }

    #[inline]
    fn visit(&self, local: &mut DenseLocal, key: u64) {
        let (word, bit) = place(key);
        if self.visited.load(word, Ordering::Relaxed) & bit != 0 {
            return;
        }
        // In the present frontier: the wave bit stands alone.
        if self.in_wave && self.wave.load(word, Ordering::Relaxed) & bit != 0 {
            return;
        }
        if self.visited.set(word, bit, Ordering::Relaxed) & bit != 0 {
            return;
        }
        local.count += 1;
        if local.spilled {
            // Release: who sees the wave bit sees the visited bit too, and does not take the state for a present one.
            self.wave.set(word, bit, Ordering::Release);
            return;
        }
        local.found.push(key);
        if local.found.len() >= self.most {
            local.spilled = true;
            for key in std::mem::take(&mut local.found) {
                let (word, bit) = place(key);
                self.wave.set(word, bit, Ordering::Release);
            }
        }
    }

    fn advance(&mut self, locals: Vec<&mut DenseLocal>) -> u64 {
        let lists = self.list.capacity() + locals.iter().map(|l| l.found.capacity()).sum::<usize>();
        self.peak = self.peak.max(8 * lists as u64);
        let count = locals.iter().map(|l| l.count).sum();
        let spilled = locals.iter().any(|l| l.spilled);
        if spilled || self.in_wave {
            self.visited.change(&mut self.wave, |visited, wave| {
                (*visited, *wave) = (*visited ^ *wave, *visited & *wave);
            });
        }
        self.list.clear();
        self.in_wave = spilled;
        for local in locals {
            if spilled {
                for key in local.found.drain(..) {
                    let (word, bit) = place(key);
                    self.visited.clear(word, bit);
                    self.wave.set(word, bit, Ordering::Relaxed);
                }
            } else {
                self.list.append(&mut local.found);
            }
            local.count = 0;
            local.spilled = false;
        }
        self.size = count;
        count
    }

    fn undo(&mut self, locals: Vec<&mut DenseLocal>) -> u64 {
        let count = locals.iter().map(|l| l.count).sum();
        if locals.iter().any(|l| l.spilled) {
            // Both bits: found in this level.
            self.visited.change(&mut self.wave, |visited, wave| {
                let next = *visited & *wave;
                (*visited, *wave) = (*visited & !next, *wave & !next);
            });
        }
        for local in locals {
            for key in local.found.drain(..) {
                let (word, bit) = place(key);
                self.visited.clear(word, bit);
            }
            local.count = 0;
            local.spilled = false;
        }
        count
    }

    const NAME: &'static str = "a bitmap";

    fn save(&self, out: &mut Out) -> io::Result<()> {
        self.visited.write(out)?;
        self.wave.write(out)?;
        out.number(u64::from(self.in_wave))?;
        out.number(self.size)?;
        out.numbers(&self.list)
    }

    fn load(&mut self, input: &mut In) -> io::Result<()> {
        self.visited.read(input)?;
        self.wave.read(input)?;
        self.in_wave = input.number()? != 0;
        self.size = input.number()?;
        self.list = input.numbers()?;
        Ok(())
    }

    fn arrange(&mut self, crew: &Crew) {
        crew.sort(&mut self.list);
    }

    fn pieces(&self) -> usize {
        if self.in_wave {
            self.visited.words().div_ceil(WORDS)
        } else {
            self.list.len().div_ceil(self.piece())
        }
    }

    fn size(&self) -> u64 {
        self.size
    }

    #[inline]
    fn each(&self, piece: usize, mut visit: impl FnMut(u64)) {
        if !self.in_wave {
            let size = self.piece();
            let end = self.list.len().min((piece + 1) * size);
            for key in &self.list[piece * size..end] {
                visit(*key);
            }
            return;
        }
        for word in piece * WORDS..self.visited.words().min((piece + 1) * WORDS) {
            let next = self.wave.load(word, Ordering::Acquire);
            let mut present = next & !self.visited.load(word, Ordering::Relaxed);
            while present != 0 {
                visit((word as u64) << 6 | u64::from(present.trailing_zeros()));
                present &= present - 1;
            }
        }
    }

    fn all(&self, states: usize) -> Vec<u64> {
        let mut all = Vec::with_capacity(states);
        self.visited.each(|key| all.push(key));
        all
    }

    fn bytes(&self) -> u64 {
        self.visited.bytes() + self.wave.bytes() + self.peak
    }

    fn clear(&mut self) {
        let words = self.visited.words();
        self.visited = Bitmap::new(words);
        self.wave = Bitmap::new(words);
        self.list = Vec::new();
        self.in_wave = false;
    }
}
