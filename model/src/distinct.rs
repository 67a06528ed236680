//! Interning: keys met over and over, each of them kept once, in memory in proportion to their number and not to the meetings.

/// Different keys.
pub(crate) struct Distinct<K> {
    keys: Vec<K>,
    /// The length at which those that stand there twice go.
    full: usize,
}

impl<K: Ord + Copy> Distinct<K> {
    const LEAST: usize = 4096;

    pub(crate) const fn new() -> Self {
        Distinct {
            keys: Vec::new(),
            full: Self::LEAST,
        }
    }

    #[inline]
    pub(crate) fn push(&mut self, key: K) {
        if self.keys.last() == Some(&key) {
            return;
        }
        self.keys.push(key);
        if self.keys.len() >= self.full {
            self.shrink();
            self.full = (2 * self.keys.len()).max(Self::LEAST);
        }
    }

    fn shrink(&mut self) {
        self.keys.sort_unstable();
        self.keys.dedup();
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> u64 {
        (self.keys.capacity() * size_of::<K>()) as u64
    }

    /// The keys in order, each once.
    pub(crate) fn sorted(mut self) -> Vec<K> {
        self.shrink();
        self.keys
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meetings_take_no_memory() {
        let mut few = Distinct::new();
        for n in 0..1_000_000u64 {
            few.push(n * 7919 % 1009);
        }
        assert!(few.bytes() <= 8 * 2 * Distinct::<u64>::LEAST as u64);
        assert_eq!(few.sorted(), (0..1009).collect::<Vec<_>>());
    }
}
