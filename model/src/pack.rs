//! State packing: every state has an exact index, the number of its values in mixed radix.

use crate::report::Error;
use crate::system::Domain;
use std::fmt::Debug;

/// An index of states. Its greatest value is never an index, so that a table can use it for "empty".
pub(crate) trait Key: Copy + Ord + Debug + Send + Sync + 'static {
    const ZERO: Self;
    const EMPTY: Self;
    /// None if the value does not fit.
    fn of(value: u128) -> Option<Self>;
    fn add_digit(self, stride: Self, digit: u64) -> Self;
    fn split(self, size: u64) -> (Self, u64);
    /// A mixed 64-bit hash.
    fn hash(self) -> u64;
}

#[inline]
fn mix(value: u64) -> u64 {
    let a = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let b = (a ^ (a >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    b ^ (b >> 31)
}

impl Key for u64 {
    const ZERO: Self = 0;
    const EMPTY: Self = u64::MAX;
    fn of(value: u128) -> Option<Self> {
        u64::try_from(value).ok()
    }
    #[inline]
    fn add_digit(self, stride: Self, digit: u64) -> Self {
        self.wrapping_add(stride.wrapping_mul(digit))
    }
    #[inline]
    fn split(self, size: u64) -> (Self, u64) {
        (self / size, self % size)
    }
    #[inline]
    fn hash(self) -> u64 {
        mix(self.wrapping_add(0x9e37_79b9_7f4a_7c15))
    }
}

impl Key for u128 {
    const ZERO: Self = 0;
    const EMPTY: Self = u128::MAX;
    fn of(value: u128) -> Option<Self> {
        Some(value)
    }
    #[inline]
    fn add_digit(self, stride: Self, digit: u64) -> Self {
        self.wrapping_add(stride.wrapping_mul(u128::from(digit)))
    }
    #[inline]
    fn split(self, size: u64) -> (Self, u64) {
        let size = u128::from(size);
        // The remainder is below `size`, which fits 64 bits.
        (self / size, (self % size) as u64)
    }
    #[inline]
    fn hash(self) -> u64 {
        mix((self as u64) ^ mix((self >> 64) as u64))
    }
}

#[derive(Clone, Copy, Debug)]
struct Digit<K> {
    lo: i32,
    size: u64,
    stride: K,
}

/// Packs the values of one list of domains; the first variable is the most significant.
#[derive(Clone, Debug)]
pub(crate) struct Packer<K> {
    digits: Vec<Digit<K>>,
}

/// The number of indices of a list of domains.
pub(crate) fn space(domains: &[Domain]) -> Result<u128, Error> {
    let mut space: u128 = 1;
    for (variable, domain) in domains.iter().enumerate() {
        if domain.size() == 0 {
            return Err(Error::EmptyDomain { variable });
        }
        space = space
            .checked_mul(u128::from(domain.size()))
            .ok_or(Error::SpaceTooLarge)?;
    }
    Ok(space)
}

impl<K: Key> Packer<K> {
    /// Fails if an index does not fit `K`.
    pub(crate) fn new(domains: &[Domain]) -> Result<Self, Error> {
        // With the number of indices itself representable, the greatest value is not an index.
        K::of(space(domains)?).ok_or(Error::SpaceTooLarge)?;
        let mut stride: u128 = 1;
        let mut digits = Vec::with_capacity(domains.len());
        for domain in domains.iter().rev() {
            let size = domain.size();
            digits.push(Digit {
                lo: domain.lo,
                size,
                stride: K::of(stride).ok_or(Error::SpaceTooLarge)?,
            });
            stride *= u128::from(size);
        }
        digits.reverse();
        Ok(Packer { digits })
    }

    /// The index of a state; None if a value is outside its domain.
    #[inline]
    pub(crate) fn pack(&self, state: &[i32]) -> Option<K> {
        let mut key = K::ZERO;
        let mut inside = state.len() == self.digits.len();
        for (digit, value) in self.digits.iter().zip(state) {
            // A value below `lo` wraps to a number from `size` on: a domain has at most 2^32 values.
            let offset = u64::from((*value as u32).wrapping_sub(digit.lo as u32));
            inside &= offset < digit.size;
            key = key.add_digit(digit.stride, offset);
        }
        if inside { Some(key) } else { None }
    }

    /// The state of an index.
    #[inline]
    pub(crate) fn unpack(&self, key: K, state: &mut [i32]) {
        let mut rest = key;
        for (digit, value) in self.digits.iter().zip(state.iter_mut()).rev() {
            let (quotient, offset) = rest.split(digit.size);
            rest = quotient;
            *value = (i64::from(digit.lo) + offset as i64) as i32;
        }
    }

    /// The state of an index, as a new vector.
    pub(crate) fn state(&self, key: K) -> Vec<i32> {
        let mut state = vec![0; self.digits.len()];
        self.unpack(key, &mut state);
        state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn round_trip<K: Key>(domains: &[Domain], keys: impl Iterator<Item = u128>) {
        let packer = Packer::<K>::new(domains).unwrap();
        for wide in keys {
            let key = K::of(wide).unwrap();
            assert_eq!(packer.pack(&packer.state(key)), Some(key));
        }
    }

    #[test]
    fn indices_are_dense_and_exact() {
        let domains = [
            Domain { lo: -3, hi: 4 },
            Domain { lo: 7, hi: 7 },
            Domain { lo: 0, hi: 2 },
        ];
        assert_eq!(space(&domains), Ok(24));
        round_trip::<u64>(&domains, 0..24);
        round_trip::<u128>(&domains, 0..24);
        let packer = Packer::<u64>::new(&domains).unwrap();
        assert_eq!(packer.pack(&[-3, 7, 0]), Some(0));
        assert_eq!(packer.pack(&[-3, 7, 1]), Some(1));
        assert_eq!(packer.pack(&[4, 7, 2]), Some(23));
        for outside in [[-4, 7, 0], [5, 7, 0], [0, 8, 0], [0, 7, 3], [0, 6, 0]] {
            assert_eq!(packer.pack(&outside), None);
        }
    }

    #[test]
    fn wide_spaces() {
        let full = Domain {
            lo: i32::MIN,
            hi: i32::MAX,
        };
        round_trip::<u128>(
            &[full, full, full],
            [0, 1, 1 << 95, (1 << 96) - 1].into_iter(),
        );
        assert!(Packer::<u64>::new(&[full, full]).is_err());
        assert_eq!(space(&[full; 4]), Err(Error::SpaceTooLarge));
        assert_eq!(
            space(&[full, Domain { lo: 1, hi: 0 }]),
            Err(Error::EmptyDomain { variable: 1 })
        );
    }
}
