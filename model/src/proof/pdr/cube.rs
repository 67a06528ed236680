//! Cubes: sets of states given by the values of some latches.

/// The value of a latch of the cone, by the latch's number there.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Fixed(u32);

impl Fixed {
    pub(super) fn new(latch: usize, value: bool) -> Self {
        Fixed((latch as u32) << 1 | u32::from(value))
    }

    pub(super) fn latch(self) -> usize {
        (self.0 >> 1) as usize
    }

    pub(super) fn value(self) -> bool {
        self.0 & 1 == 1
    }
}

/// The states in which each of these latches has this value, in the order of the latches.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Cube(Vec<Fixed>);

impl Cube {
    pub(super) fn new(mut list: Vec<Fixed>) -> Self {
        list.sort_unstable();
        Cube(list)
    }

    pub(super) fn list(&self) -> &[Fixed] {
        &self.0
    }

    pub(super) fn has(&self, fixed: Fixed) -> bool {
        self.0.binary_search(&fixed).is_ok()
    }

    /// Without one of its values.
    pub(super) fn without(&self, fixed: Fixed) -> Cube {
        Cube(self.0.iter().copied().filter(|f| *f != fixed).collect())
    }

    /// Those of its values for which `keep` says so.
    pub(super) fn only(&self, mut keep: impl FnMut(Fixed) -> bool) -> Cube {
        Cube(self.0.iter().copied().filter(|f| keep(*f)).collect())
    }

    /// Whether every state of `other` is one of its own.
    pub(super) fn covers(&self, other: &Cube) -> bool {
        if self.0.len() > other.0.len() {
            return false;
        }
        let mut rest = other.0.iter();
        self.0
            .iter()
            .all(|fixed| rest.by_ref().find(|f| *f >= fixed) == Some(fixed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fewer_values_cover_more_states() {
        let cube = |list: &[(usize, bool)]| {
            Cube::new(list.iter().map(|(k, v)| Fixed::new(*k, *v)).collect())
        };
        let whole = cube(&[(3, true), (1, false), (7, true)]);
        assert!(whole.covers(&whole) && cube(&[]).covers(&whole));
        assert!(cube(&[(1, false), (7, true)]).covers(&whole));
        assert!(!cube(&[(1, true)]).covers(&whole));
        assert!(!cube(&[(1, false), (2, true)]).covers(&whole));
        assert!(!whole.covers(&whole.without(Fixed::new(1, false))));
    }
}
