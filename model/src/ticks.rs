//! The states of a system with a timer that merely counts down: for each state of everything else the ticks of the timer
//! that were reached, as intervals. A timer that runs down from its start leaves one interval, however long it is.

use crate::checkpoint::{In, Out};
use crate::crew::Crew;
use crate::pack::Key;
use crate::set::{SHARDS, Shard};
use crate::store::{PIECE, Store};
use std::collections::BTreeMap;
use std::io;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// States a worker gathers for one shard before it takes the shard's lock.
const BATCH: usize = 64;

/// Ticks from the first to the second, none if the first is greater.
type Ticks = [u32; 2];

/// Some states: the rests, and for each the ticks reached; most rests have one interval.
struct Part {
    rests: Shard<u64>,
    ticks: Vec<Ticks>,
    /// Further intervals of some rests, by place: neither overlapping nor adjacent to any other one of the rest.
    more: BTreeMap<u32, Vec<Ticks>>,
}

impl Part {
    /// True if the state is new.
    fn insert(&mut self, rest: u64, tick: u32, bytes: &AtomicU64) -> bool {
        let Some((place, new)) = self.rests.insert(rest, bytes) else {
            // No place is left; more memory than any machine has is asked for, so that the search ends.
            bytes.store(u64::MAX / 4, Ordering::Relaxed);
            return false;
        };
        if new {
            let before = self.ticks.capacity();
            if self.ticks.len() == before {
                self.ticks.reserve_exact(before / 8 + 16);
                let more = (self.ticks.capacity() - before) * size_of::<Ticks>();
                bytes.fetch_add(more as u64, Ordering::Relaxed);
            }
            self.ticks.push([tick, tick]);
            return true;
        }
        let own = &mut self.ticks[place as usize];
        let more = self.more.get_mut(&place);
        let mut all = std::iter::once(own).chain(more.into_iter().flatten());
        if all.any(|[from, to]| (*from..=*to).contains(&tick)) {
            return false;
        }
        self.add(place, tick, bytes);
        true
    }

    /// Adds a tick that is in no interval.
    fn add(&mut self, place: u32, tick: u32, bytes: &AtomicU64) {
        let own = &mut self.ticks[place as usize];
        if own[0] > own[1] {
            *own = [tick, tick];
        } else if tick.checked_add(1) == Some(own[0]) {
            own[0] = tick;
        } else if own[1].checked_add(1) == Some(tick) {
            own[1] = tick;
        } else {
            self.more.entry(place).or_default().push([tick, tick]);
            bytes.fetch_add(2 * size_of::<Ticks>() as u64, Ordering::Relaxed);
        }
        self.join(place);
    }

    /// Makes one interval of adjacent ones.
    fn join(&mut self, place: u32) {
        let Some(more) = self.more.get_mut(&place) else {
            return;
        };
        let own = &mut self.ticks[place as usize];
        more.push(*own);
        more.sort_unstable();
        let mut joined: Vec<Ticks> = Vec::with_capacity(more.len());
        for ticks in more.iter().filter(|[from, to]| from <= to) {
            match joined.last_mut() {
                Some(last) if last[1].checked_add(1) == Some(ticks[0]) => last[1] = ticks[1],
                _ => joined.push(*ticks),
            }
        }
        // The longest one stands with the rest: it is looked at first.
        let longest = joined.iter().max_by_key(|[from, to]| to - from).copied();
        *own = longest.unwrap_or([1, 0]);
        joined.retain(|ticks| Some(*ticks) != longest);
        *more = joined;
        if more.is_empty() {
            self.more.remove(&place);
        }
    }

    /// Takes out a state.
    fn remove(&mut self, rest: u64, tick: u32, bytes: &AtomicU64) {
        let Some((place, false)) = self.rests.insert(rest, bytes) else {
            return;
        };
        let more = self.more.entry(place).or_default();
        more.push(self.ticks[place as usize]);
        self.ticks[place as usize] = [1, 0];
        let mut parts = Vec::new();
        for [from, to] in more.drain(..) {
            if (from..=to).contains(&tick) {
                // Ticks are below 2^32 - 1, see `Ticked::new`.
                parts.extend(
                    [[from, tick.wrapping_sub(1)], [tick + 1, to]]
                        .into_iter()
                        .filter(|[a, b]| a <= b && *b != u32::MAX),
                );
            } else {
                parts.push([from, to]);
            }
        }
        *more = parts;
        self.join(place);
    }
}

/// States as intervals of ticks, the frontier in a list.
pub(crate) struct Ticked {
    /// The number of ticks; the timer is the least significant variable.
    size: u64,
    parts: Vec<Mutex<Part>>,
    bytes: AtomicU64,
    list: Vec<u64>,
    lists: AtomicU64,
}

/// What a worker found in a level, and what it has not yet added.
pub(crate) struct TickedLocal {
    batch: Vec<Vec<u64>>,
    found: Vec<u64>,
}

impl Ticked {
    /// For a timer with so many values.
    pub(crate) fn new(size: u32) -> Self {
        let part = || Part {
            rests: Shard::new(),
            ticks: Vec::new(),
            more: BTreeMap::new(),
        };
        Ticked {
            size: u64::from(size.max(1)),
            parts: (0..SHARDS).map(|_| Mutex::new(part())).collect(),
            bytes: AtomicU64::new(0),
            list: Vec::new(),
            lists: AtomicU64::new(0),
        }
    }

    fn part(&self, shard: usize) -> MutexGuard<'_, Part> {
        self.parts[shard]
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// The rest, and the tick: below the size, which has 32 bits.
    #[inline]
    fn split(&self, key: u64) -> (u64, u32) {
        (key / self.size, (key % self.size) as u32)
    }

    fn flush(&self, shard: usize, keys: &mut Vec<u64>, found: &mut Vec<u64>) {
        let mut part = self.part(shard);
        let before = found.capacity();
        for key in keys.drain(..) {
            let (rest, tick) = self.split(key);
            if part.insert(rest, tick, &self.bytes) {
                found.push(key);
            }
        }
        let more = (found.capacity() - before) * size_of::<u64>();
        self.lists.fetch_add(more as u64, Ordering::Relaxed);
    }
}

impl Store for Ticked {
    type Key = u64;
    type Local = TickedLocal;
    const NAME: &'static str = "intervals of ticks";

    fn local(&self) -> TickedLocal {
        TickedLocal {
            batch: (0..SHARDS).map(|_| Vec::new()).collect(),
            found: Vec::new(),
        }
    }

    #[inline]
    fn visit(&self, local: &mut TickedLocal, key: u64) {
        let shard = self.split(key).0.hash() as usize % SHARDS;
        let TickedLocal { batch, found } = local;
        batch[shard].push(key);
        if batch[shard].len() >= BATCH {
            self.flush(shard, &mut batch[shard], found);
        }
    }

    fn settle(&self, TickedLocal { batch, found }: &mut TickedLocal) {
        for (shard, keys) in batch.iter_mut().enumerate().filter(|(_, k)| !k.is_empty()) {
            self.flush(shard, keys, found);
        }
    }

    fn advance(&mut self, locals: Vec<&mut TickedLocal>) -> u64 {
        self.list = Vec::new();
        for local in locals {
            self.settle(local);
            self.list.append(&mut std::mem::take(&mut local.found));
        }
        let bytes = self.list.capacity() * size_of::<u64>();
        self.lists = AtomicU64::new(bytes as u64);
        self.list.len() as u64
    }

    fn undo(&mut self, locals: Vec<&mut TickedLocal>) -> u64 {
        let mut count = 0;
        for TickedLocal { batch, found } in locals {
            batch.iter_mut().for_each(Vec::clear);
            for key in found.drain(..) {
                let (rest, tick) = self.split(key);
                let shard = rest.hash() as usize % SHARDS;
                self.part(shard).remove(rest, tick, &self.bytes);
                count += 1;
            }
        }
        count
    }

    fn save(&self, out: &mut Out) -> io::Result<()> {
        for shard in 0..SHARDS {
            let part = self.part(shard);
            out.numbers(&part.rests.keys)?;
            let number = |[from, to]: &Ticks| u64::from(*from) << 32 | u64::from(*to);
            out.numbers(&part.ticks.iter().map(number).collect::<Vec<_>>())?;
            out.number(part.more.len() as u64)?;
            for (place, more) in &part.more {
                out.number(u64::from(*place))?;
                out.numbers(&more.iter().map(number).collect::<Vec<_>>())?;
            }
        }
        out.numbers(&self.list)
    }

    fn load(&mut self, input: &mut In) -> io::Result<()> {
        let ticks = |number: u64| [(number >> 32) as u32, number as u32];
        for shard in 0..SHARDS {
            let mut part = self.part(shard);
            for rest in input.numbers()? {
                part.rests.insert(rest, &self.bytes);
            }
            part.ticks = input.numbers()?.into_iter().map(ticks).collect();
            for _ in 0..input.count()? {
                let place = input.number()? as u32;
                let more = input.numbers()?.into_iter().map(ticks).collect();
                part.more.insert(place, more);
            }
            if part.ticks.len() != part.rests.keys.len() {
                return Err(io::ErrorKind::InvalidData.into());
            }
        }
        self.list = input.numbers()?;
        Ok(())
    }

    fn arrange(&mut self, crew: &Crew) {
        crew.sort(&mut self.list);
    }

    fn pieces(&self) -> usize {
        self.list.len().div_ceil(PIECE)
    }

    fn size(&self) -> u64 {
        self.list.len() as u64
    }

    #[inline]
    fn each(&self, piece: usize, mut visit: impl FnMut(u64)) {
        let end = self.list.len().min((piece + 1) * PIECE);
        for key in &self.list[piece * PIECE..end] {
            visit(*key);
        }
    }

    fn all(&self, states: usize) -> Vec<u64> {
        let mut all = Vec::with_capacity(states);
        for shard in 0..SHARDS {
            let part = self.part(shard);
            let none = Vec::new();
            for ((place, rest), own) in (0..).zip(&part.rests.keys).zip(&part.ticks) {
                let more = part.more.get(&place).unwrap_or(&none);
                for [from, to] in std::iter::once(own).chain(more) {
                    all.extend((*from..=*to).map(|tick| rest * self.size + u64::from(tick)));
                }
            }
        }
        all
    }

    fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed) + self.lists.load(Ordering::Relaxed)
    }

    fn clear(&mut self) {
        *self = Ticked::new(self.size as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn intervals_are_the_set_of_the_ticks_put_in() {
        let ticked = Ticked::new(100);
        let mut known = BTreeSet::new();
        let mut seed = 1u64;
        let mut random = |below: u64| {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 33) % below
        };
        for _ in 0..20_000 {
            let (rest, tick) = (random(5), random(100) as u32);
            let mut part = ticked.part(0);
            if random(3) > 0 {
                let new = part.insert(rest, tick, &ticked.bytes);
                assert_eq!(new, known.insert((rest, tick)));
            } else if known.remove(&(rest, tick)) {
                part.remove(rest, tick, &ticked.bytes);
            }
            for (place, rest) in part.rests.keys.iter().enumerate() {
                let more = part.more.get(&(place as u32));
                let all = std::iter::once(&part.ticks[place]).chain(more.into_iter().flatten());
                let mut ticks: Vec<Ticks> = all.copied().filter(|[a, b]| a <= b).collect();
                ticks.sort_unstable();
                assert!(ticks.windows(2).all(|w| w[0][1] + 1 < w[1][0]), "{ticks:?}");
                let told = ticks.iter().flat_map(|[a, b]| *a..=*b).map(|t| (*rest, t));
                let known = known.iter().copied().filter(|(r, _)| r == rest);
                assert!(told.eq(known));
            }
        }
    }

    #[test]
    fn a_countdown_takes_one_interval() {
        let ticked = Ticked::new(501);
        let mut part = ticked.part(0);
        for tick in (0..501).rev() {
            assert!(part.insert(7, tick, &ticked.bytes));
        }
        assert_eq!((&part.ticks[..], part.more.len()), (&[[0, 500]][..], 0));
    }
}
