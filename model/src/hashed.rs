//! The states of a sparse space, in an exact hash set; the frontier is the end of its lists.

use crate::checkpoint::{In, Out};
use crate::crew::Crew;
use crate::pack::{Key, Wide};
use crate::set::{Batch, SHARDS, Set};
use crate::store::{PIECE, Store};
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};

/// How a key is stored in 64 bits.
pub(crate) trait Code: Sync + Sized {
    type Key: Key;
    /// What a worker remembers of the coding.
    type Memory: Send;
    fn new() -> Self;
    fn memory(&self) -> Self::Memory;
    /// None if there are more keys than can be coded.
    fn encode(&self, memory: &mut Self::Memory, key: Self::Key) -> Option<u64>;
    fn decode(&self, code: u64) -> Self::Key;
    fn bytes(&self) -> u64;
    /// What a checkpoint calls a storage of such codes.
    const NAME: &'static str;
    /// Writes what decoding needs.
    fn save(&self, out: &mut Out) -> io::Result<()>;
    /// Reads it.
    fn load(&mut self, input: &mut In) -> io::Result<()>;
}

/// A key of 64 bits is its own code.
pub(crate) struct Plain;

impl Code for Plain {
    type Key = u64;
    type Memory = ();
    fn new() -> Self {
        Plain
    }
    fn memory(&self) {}
    #[inline]
    fn encode(&self, _: &mut (), key: u64) -> Option<u64> {
        Some(key)
    }
    #[inline]
    fn decode(&self, code: u64) -> u64 {
        code
    }
    fn bytes(&self) -> u64 {
        0
    }
    const NAME: &'static str = "a hash set of 64-bit indices";
    fn save(&self, _: &mut Out) -> io::Result<()> {
        Ok(())
    }
    fn load(&mut self, _: &mut In) -> io::Result<()> {
        Ok(())
    }
}

/// The halves of a wide key, each of which gets a number: many states share a half.
pub(crate) struct Halves([Set<u64>; 2]);

/// What a worker remembers: for some halves their numbers.
pub(crate) struct Memory([Vec<(u64, u32)>; 2]);

/// Entries of such a memory.
const REMEMBERED: usize = 1 << 12;
/// No number: places and shards do not make it up.
const NONE: u32 = u32::MAX;

impl Halves {
    fn number(&self, memory: &mut Memory, half: usize, value: u64) -> Option<u64> {
        let entry = &mut memory.0[half][value.hash() as usize % REMEMBERED];
        if entry.1 == NONE || entry.0 != value {
            let (shard, place, _) = self.0[half].add(value)?;
            *entry = (value, place * SHARDS as u32 + shard as u32);
        }
        Some(u64::from(entry.1))
    }

    fn value(&self, half: usize, number: u32) -> u64 {
        let (shard, place) = (number as usize % SHARDS, number as usize / SHARDS);
        self.0[half].shard(shard).keys[place]
    }
}

impl Code for Halves {
    type Key = Wide;
    type Memory = Memory;

    fn new() -> Self {
        Halves([Set::new(), Set::new()])
    }

    fn memory(&self) -> Memory {
        let empty = || vec![(0, NONE); REMEMBERED];
        Memory([empty(), empty()])
    }

    #[inline]
    fn encode(&self, memory: &mut Memory, key: Wide) -> Option<u64> {
        let [first, second] = key.halves();
        let first = self.number(memory, 0, first)?;
        Some(first << 32 | self.number(memory, 1, second)?)
    }

    #[inline]
    fn decode(&self, code: u64) -> Wide {
        Wide::of([
            self.value(0, (code >> 32) as u32),
            self.value(1, code as u32),
        ])
    }

    fn bytes(&self) -> u64 {
        self.0.iter().map(Set::bytes).sum()
    }

    const NAME: &'static str = "a hash set of 128-bit indices";

    fn save(&self, out: &mut Out) -> io::Result<()> {
        self.0.iter().try_for_each(|set| set.save(out))
    }

    fn load(&mut self, input: &mut In) -> io::Result<()> {
        self.0.iter_mut().try_for_each(|set| set.load(input))
    }
}

/// States in a hash set of their codes. In the list of each shard stand the states explored, then the frontier, then what
/// the level being explored has found.
pub(crate) struct Hashed<C> {
    code: C,
    set: Set<u64>,
    /// By shard: where the frontier starts and ends.
    from: Vec<usize>,
    to: Vec<usize>,
    /// Pieces of the frontier: shard, first place.
    pieces: Vec<(usize, usize)>,
    /// The frontier, where it is arranged: the codes of states that are alike in their first half, or in the first variables, stand
    /// together.
    arranged: Option<Vec<u64>>,
    full: AtomicBool,
}

/// What a worker found in a level and has not yet added, and what it remembers of the coding.
pub(crate) struct HashedLocal<M> {
    batch: Batch<u64>,
    memory: M,
    /// Codes that came last, each in the slot of its hash: most states come several times in a row of states, and what is found here
    /// need not be looked for in memory that all threads write to.
    recent: Vec<u64>,
}

/// Slots for such codes, as many as stay in a cache, and what stands in an empty one. That code is looked for in the set.
const RECENT: usize = 1 << 13;
const EMPTY: u64 = u64::MAX;

impl<C: Code> Hashed<C> {
    pub(crate) fn new() -> Self {
        Hashed {
            code: C::new(),
            set: Set::new(),
            from: vec![0; SHARDS],
            to: vec![0; SHARDS],
            pieces: Vec::new(),
            arranged: None,
            full: AtomicBool::new(false),
        }
    }

    /// Makes the states from `from` to `to` the frontier and gives their number.
    fn set_frontier(&mut self, from: Vec<usize>, to: Vec<usize>) -> u64 {
        self.pieces.clear();
        self.arranged = None;
        let mut count = 0;
        for (shard, (from, to)) in from.iter().zip(&to).enumerate() {
            let starts = (*from..*to).step_by(PIECE);
            self.pieces.extend(starts.map(|start| (shard, start)));
            count += (to - from) as u64;
        }
        (self.from, self.to) = (from, to);
        count
    }
}

impl<C: Code> Store for Hashed<C> {
    type Key = C::Key;
    type Local = HashedLocal<C::Memory>;

    fn local(&self) -> Self::Local {
        HashedLocal {
            batch: Batch::new(),
            memory: self.code.memory(),
            recent: vec![EMPTY; RECENT],
        }
    }

    #[inline]
    fn visit(&self, local: &mut Self::Local, key: C::Key) {
        match self.code.encode(&mut local.memory, key) {
            Some(code) => {
                // The lower bits choose a shard, and the upper ones its slot.
                let recent = &mut local.recent[(code.hash() >> 20) as usize % RECENT];
                if *recent != code || code == EMPTY {
                    *recent = code;
                    self.set.insert(&mut local.batch, code);
                }
            }
            None => self.full.store(true, Ordering::Relaxed),
        }
    }

    fn settle(&self, local: &mut Self::Local) {
        self.set.flush(&mut local.batch);
    }

    fn advance(&mut self, locals: Vec<&mut Self::Local>) -> u64 {
        locals.into_iter().for_each(|local| self.settle(local));
        let (from, to) = (std::mem::take(&mut self.to), self.set.counts());
        self.set_frontier(from, to)
    }

    fn undo(&mut self, locals: Vec<&mut Self::Local>) -> u64 {
        for local in locals {
            local.batch.clear();
            local.recent.fill(EMPTY);
        }
        let mut count = 0;
        for (shard, to) in self.to.iter().enumerate() {
            let mut table = self.set.shard(shard);
            count += (table.keys.len() - to) as u64;
            table.truncate(*to);
        }
        count
    }

    const NAME: &'static str = C::NAME;

    fn save(&self, out: &mut Out) -> io::Result<()> {
        self.code.save(out)?;
        self.set.save(out)?;
        self.from.iter().try_for_each(|n| out.number(*n as u64))
    }

    fn load(&mut self, input: &mut In) -> io::Result<()> {
        self.code.load(input)?;
        self.set.load(input)?;
        let mut from = Vec::with_capacity(SHARDS);
        for _ in 0..SHARDS {
            from.push(input.place()?);
        }
        let to = self.set.counts();
        if from.iter().zip(&to).any(|(from, to)| from > to) {
            return Err(io::ErrorKind::InvalidData.into());
        }
        self.set_frontier(from, to);
        Ok(())
    }

    fn arrange(&mut self, crew: &Crew) {
        let mut codes = Vec::with_capacity(self.size() as usize);
        for (shard, (from, to)) in self.from.iter().zip(&self.to).enumerate() {
            codes.extend_from_slice(&self.set.shard(shard).keys[*from..*to]);
        }
        crew.sort(&mut codes);
        self.arranged = Some(codes);
    }

    fn pieces(&self) -> usize {
        match &self.arranged {
            Some(codes) => codes.len().div_ceil(PIECE),
            None => self.pieces.len(),
        }
    }

    fn size(&self) -> u64 {
        let pairs = self.from.iter().zip(&self.to);
        pairs.map(|(from, to)| (to - from) as u64).sum()
    }

    #[inline]
    fn each(&self, piece: usize, mut visit: impl FnMut(C::Key)) {
        if let Some(codes) = &self.arranged {
            let codes = &codes[piece * PIECE..codes.len().min((piece + 1) * PIECE)];
            codes.iter().for_each(|code| visit(self.code.decode(*code)));
            return;
        }
        let (shard, start) = self.pieces[piece];
        let end = self.to[shard].min(start + PIECE);
        let mut codes = [0; PIECE];
        let codes = &mut codes[..end - start];
        codes.copy_from_slice(&self.set.shard(shard).keys[start..end]);
        for code in codes {
            visit(self.code.decode(*code));
        }
    }

    fn all(&self, states: usize) -> Vec<C::Key> {
        let shards: Vec<_> = (0..SHARDS).map(|shard| self.set.shard(shard)).collect();
        let most = shards.iter().map(|shard| shard.keys.len()).max();
        // The states of a level are spread over the shards, so that the same place was taken at about the same time in each.
        let codes =
            (0..most.unwrap_or(0)).flat_map(|at| shards.iter().filter_map(move |s| s.keys.get(at)));
        let mut all = Vec::with_capacity(states);
        all.extend(codes.map(|code| self.code.decode(*code)));
        all
    }

    fn bytes(&self) -> u64 {
        match self.full.load(Ordering::Relaxed) {
            false => {
                let arranged = self.arranged.as_ref().map_or(0, |codes| 8 * codes.len());
                self.set.bytes() + self.code.bytes() + arranged as u64
            }
            true => u64::MAX / 4,
        }
    }

    fn clear(&mut self) {
        *self = Hashed::new();
    }
}
