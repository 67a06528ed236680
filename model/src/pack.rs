//! State packing: every state has an exact index, the number of its values in mixed radix.

use crate::report::Error;
use crate::system::Domain;
use std::fmt::Debug;
use std::marker::PhantomData;

/// An index of states: a number in one half or two, the first one being the more significant.
pub(crate) trait Key: Copy + Ord + Debug + Send + Sync + 'static {
    /// How many halves it has.
    const HALVES: usize;
    fn of(halves: [u64; 2]) -> Self;
    fn halves(self) -> [u64; 2];
    /// The sum; differences of indices wrap.
    fn plus(self, other: Self) -> Self;
    /// The difference.
    fn minus(self, other: Self) -> Self;
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
    const HALVES: usize = 1;
    #[inline]
    fn of([key, _]: [u64; 2]) -> Self {
        key
    }
    #[inline]
    fn halves(self) -> [u64; 2] {
        [self, 0]
    }
    #[inline]
    fn plus(self, other: Self) -> Self {
        self.wrapping_add(other)
    }
    #[inline]
    fn minus(self, other: Self) -> Self {
        self.wrapping_sub(other)
    }
    #[inline]
    fn hash(self) -> u64 {
        mix(self.wrapping_add(0x9e37_79b9_7f4a_7c15))
    }
}

/// An index that needs more than 64 bits: some variables make up its first half, the others its second one.
#[cfg_attr(feature = "distributed", derive(serde::Serialize, serde::Deserialize))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Wide {
    first: u64,
    second: u64,
}

impl Key for Wide {
    const HALVES: usize = 2;
    #[inline]
    fn of([first, second]: [u64; 2]) -> Self {
        Wide { first, second }
    }
    #[inline]
    fn halves(self) -> [u64; 2] {
        [self.first, self.second]
    }
    #[inline]
    fn plus(self, other: Self) -> Self {
        Wide {
            first: self.first.wrapping_add(other.first),
            second: self.second.wrapping_add(other.second),
        }
    }
    #[inline]
    fn minus(self, other: Self) -> Self {
        Wide {
            first: self.first.wrapping_sub(other.first),
            second: self.second.wrapping_sub(other.second),
        }
    }
    #[inline]
    fn hash(self) -> u64 {
        mix(self.second ^ mix(self.first.wrapping_add(0x9e37_79b9_7f4a_7c15)))
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Digit {
    lo: i32,
    size: u64,
    stride: u64,
    half: usize,
}

impl Digit {
    /// The place of a value in its domain; the size or more if it lies outside: a domain has at most 2^32 values, so that
    /// a value below `lo` wraps to a number from there on.
    #[inline]
    fn offset(&self, value: i32) -> u64 {
        u64::from((value as u32).wrapping_sub(self.lo as u32))
    }

    /// The value with the lowest digit of what is left of an index, which is taken off.
    #[inline]
    fn take(&self, rest: &mut u64) -> i32 {
        let offset = *rest % self.size;
        *rest /= self.size;
        (i64::from(self.lo) + offset as i64) as i32
    }
}

/// Where the values of a variable stand in an index.
pub(crate) struct Place {
    pub(crate) half: usize,
    pub(crate) stride: u64,
    pub(crate) size: u64,
    /// No variable of more than one value is more significant.
    pub(crate) top: bool,
}

/// The state of an index, and what was left of the index at each of its digits, from the least significant one on.
pub(crate) struct Opened {
    pub(crate) state: Vec<i32>,
    rests: Vec<Option<u64>>,
}

/// Packs the values of one list of domains; in each half the first variable is the most significant.
#[derive(Clone, Debug)]
pub(crate) struct Packer<K> {
    digits: Vec<Digit>,
    /// The variables from the least significant one on.
    order: Vec<usize>,
    key: PhantomData<K>,
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

/// For each variable the half of the index that has its digit. Two halves get about as many values each, so that many
/// states share a half.
fn halves(domains: &[Domain], whole: u128, number: usize) -> Option<Vec<usize>> {
    let most = 1u128 << 64;
    let mut first = 1u128;
    let mut best = (whole, if number == 1 { domains.len() } else { 0 });
    for (count, domain) in domains.iter().enumerate().filter(|_| number > 1) {
        first *= u128::from(domain.size());
        best = best.min((first.max(whole / first), count + 1));
    }
    let (larger, cut) = best;
    if larger <= most {
        return Some((0..domains.len()).map(|v| usize::from(v >= cut)).collect());
    }
    // No cut gives two halves that fit; picking may.
    let mut spaces = [1u128; 2];
    let mut picked = Vec::with_capacity(domains.len());
    for domain in domains {
        let size = u128::from(domain.size());
        let half = (0..number).find(|half| spaces[*half] * size <= most)?;
        spaces[half] *= size;
        picked.push(half);
    }
    Some(picked)
}

impl<K: Key> Packer<K> {
    /// Fails if an index does not fit `K`.
    pub(crate) fn new(domains: &[Domain]) -> Result<Self, Error> {
        Self::with_least(domains, None)
    }

    /// With a variable that is less significant than all others.
    pub(crate) fn with_least(domains: &[Domain], least: Option<usize>) -> Result<Self, Error> {
        let whole = space(domains)?;
        let halves = halves(domains, whole, K::HALVES).ok_or(Error::SpaceTooLarge)?;
        let others = (0..domains.len()).rev().filter(|v| Some(*v) != least);
        let order: Vec<usize> = least.into_iter().chain(others).collect();
        let mut strides = [1u64; 2];
        let mut digits = vec![Digit::default(); domains.len()];
        for variable in &order {
            let (domain, half) = (domains[*variable], halves[*variable]);
            let (size, stride) = (domain.size(), strides[half]);
            digits[*variable] = Digit {
                lo: domain.lo,
                size,
                stride,
                half,
            };
            // After the first variable of a half nothing uses the stride, which may be 2^64 then.
            strides[half] = stride.wrapping_mul(size);
        }
        Ok(Packer {
            digits,
            order,
            key: PhantomData,
        })
    }

    /// The index of a state; None if a value is outside its domain.
    #[inline]
    pub(crate) fn pack(&self, state: &[i32]) -> Option<K> {
        let mut key = [0u64; 2];
        let mut inside = state.len() == self.digits.len();
        for (digit, value) in self.digits.iter().zip(state) {
            let offset = digit.offset(*value);
            inside &= offset < digit.size;
            let half = if K::HALVES == 1 { 0 } else { digit.half & 1 };
            key[half] = key[half].wrapping_add(digit.stride.wrapping_mul(offset));
        }
        if inside { Some(K::of(key)) } else { None }
    }

    /// Where the values of a variable stand in an index.
    pub(crate) fn place(&self, variable: usize) -> Option<Place> {
        let digit = self.digits.get(variable)?;
        let above = |other: &Digit| other.half == digit.half && other.stride > digit.stride;
        Some(Place {
            half: digit.half,
            stride: digit.stride,
            size: digit.size,
            top: !self.digits.iter().any(above),
        })
    }

    /// What the given variables contribute to the index of a state; none if a value is outside its domain.
    pub(crate) fn share(&self, variables: &[usize], state: &[i32]) -> Option<K> {
        let mut key = [0u64; 2];
        for variable in variables {
            let (digit, value) = (self.digits.get(*variable)?, state.get(*variable)?);
            let offset = digit.offset(*value);
            if offset >= digit.size {
                return None;
            }
            key[digit.half] = key[digit.half].wrapping_add(digit.stride.wrapping_mul(offset));
        }
        Some(K::of(key))
    }

    /// The state of an index.
    #[inline]
    pub(crate) fn unpack(&self, key: K, state: &mut [i32]) {
        let mut rest = key.halves();
        for variable in &self.order {
            let digit = &self.digits[*variable];
            let half = if K::HALVES == 1 { 0 } else { digit.half & 1 };
            state[*variable] = digit.take(&mut rest[half]);
        }
    }

    /// The state of an index, from the one opened before, with the variables whose values are others: of an index near to that one most
    /// digits are the same.
    #[inline]
    pub(crate) fn open(&self, key: K, opened: &mut Opened, mut changed: impl FnMut(usize)) {
        let mut rest = key.halves();
        let mut same = [false; 2];
        for (variable, before) in self.order.iter().zip(&mut opened.rests) {
            let digit = &self.digits[*variable];
            let half = if K::HALVES == 1 { 0 } else { digit.half & 1 };
            if same[half] {
                continue;
            }
            if *before == Some(rest[half]) {
                // So are all digits above it.
                same[half] = true;
                if same[..K::HALVES].iter().all(|same| *same) {
                    return;
                }
                continue;
            }
            *before = Some(rest[half]);
            let value = digit.take(&mut rest[half]);
            if std::mem::replace(&mut opened.state[*variable], value) != value {
                changed(*variable);
            }
        }
    }

    /// For [`Packer::open`].
    pub(crate) fn opened(&self) -> Opened {
        Opened {
            state: vec![0; self.digits.len()],
            rests: vec![None; self.digits.len()],
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

    const FULL: Domain = Domain {
        lo: i32::MIN,
        hi: i32::MAX,
    };

    fn packer<K: Key>(domains: &[Domain]) -> Packer<K> {
        Packer::new(domains).unwrap()
    }

    #[test]
    fn indices_are_dense_and_exact() {
        let domains = [
            Domain { lo: -3, hi: 4 },
            Domain { lo: 7, hi: 7 },
            Domain { lo: 0, hi: 2 },
        ];
        assert_eq!(space(&domains), Ok(24));
        let (narrow, wide) = (packer::<u64>(&domains), packer::<Wide>(&domains));
        for key in 0..24 {
            assert_eq!(narrow.pack(&narrow.state(key)), Some(key));
            // The first variable has 8 values, the others 3.
            let same = Wide::of([key / 3, key % 3]);
            assert_eq!(wide.pack(&narrow.state(key)), Some(same));
            assert_eq!(wide.state(same), narrow.state(key));
        }
        assert_eq!(narrow.pack(&[-3, 7, 0]), Some(0));
        assert_eq!(narrow.pack(&[-3, 7, 1]), Some(1));
        assert_eq!(narrow.pack(&[4, 7, 2]), Some(23));
        for outside in [[-4, 7, 0], [5, 7, 0], [0, 8, 0], [0, 7, 3], [0, 6, 0]] {
            assert_eq!(narrow.pack(&outside), None);
            assert_eq!(wide.pack(&outside), None);
        }
    }

    #[test]
    fn an_index_is_opened_from_any_other() {
        let domains = [1, 5, 3, 7, 1, 4].map(|hi| Domain { lo: -1, hi });
        let space = space(&domains).unwrap() as u64;
        let (narrow, wide) = (packer::<u64>(&domains), packer::<Wide>(&domains));
        let (mut one, mut two) = (narrow.opened(), wide.opened());
        let far = (0..2000).map(|n: u64| n * 7919 % space);
        for key in (0..space).chain(far) {
            let old = one.state.clone();
            let mut changed = [false; 6];
            narrow.open(key, &mut one, |variable| changed[variable] = true);
            assert_eq!(one.state, narrow.state(key));
            let differs = |v: usize| old[v] != one.state[v];
            assert!((0..6).all(|v| changed[v] == differs(v)));
            let same = wide.pack(&one.state).unwrap();
            wide.open(same, &mut two, |_| ());
            assert_eq!(two.state, one.state);
        }
    }

    #[test]
    fn shares_add_up_and_their_differences_move_a_state() {
        let domains = [Domain { lo: -3, hi: 4 }, Domain { lo: 0, hi: 2 }, FULL];
        let packer = packer::<u64>(&domains);
        let (before, after) = ([1, 2, -5], [-2, 0, 77]);
        let parts = |state: &[i32; 3]| {
            let share = |variables: &[usize]| packer.share(variables, state).unwrap();
            (share(&[0, 2]), share(&[1]))
        };
        let (old, new) = (parts(&before), parts(&after));
        let key = packer.pack(&before).unwrap();
        assert_eq!(old.0.plus(old.1), key);
        let moved = key.plus(new.0.minus(old.0)).plus(new.1.minus(old.1));
        assert_eq!(Some(moved), packer.pack(&after));
        assert_eq!(packer.share(&[1], &[0, 3, 0]), None);
    }

    #[test]
    fn a_variable_can_be_the_least_significant_one() {
        let domains = [
            Domain { lo: -3, hi: 4 },
            Domain { lo: 5, hi: 9 },
            Domain { lo: 0, hi: 2 },
        ];
        let packer = Packer::<u64>::with_least(&domains, Some(1)).unwrap();
        assert_eq!(packer.pack(&[-3, 6, 0]), Some(1));
        assert_eq!(packer.pack(&[-3, 5, 1]), Some(5));
        assert_eq!(packer.pack(&[-2, 5, 0]), Some(15));
        for key in 0..120 {
            assert_eq!(packer.pack(&packer.state(key)), Some(key));
        }
    }

    #[test]
    fn two_halves_have_about_as_many_values() {
        let of = |sizes: &[i32]| -> Vec<Domain> {
            let domain = |size: &i32| Domain {
                lo: 0,
                hi: size - 1,
            };
            sizes.iter().map(domain).collect()
        };
        let cut = |sizes: &[i32]| {
            let domains = of(sizes);
            halves(&domains, space(&domains).unwrap(), 2)
        };
        assert_eq!(cut(&[10, 10, 10, 10]), Some(vec![0, 0, 1, 1]));
        assert_eq!(cut(&[1000, 2, 2, 2]), Some(vec![0, 1, 1, 1]));
        assert_eq!(cut(&[2, 2, 1000]), Some(vec![0, 0, 1]));
        assert_eq!(cut(&[1]), Some(vec![1]));
        let bits = |bits: &[u32]| -> Vec<i32> { bits.iter().map(|b| 1 << b).collect() };
        assert_eq!(cut(&bits(&[30, 30, 8, 30, 26])), Some(vec![0, 0, 1, 1, 1]));
        // No cut fits, but picking does, or nothing does.
        let odd = bits(&[20, 30, 30, 30, 14]);
        assert_eq!(cut(&odd), Some(vec![0, 0, 1, 1, 0]));
        let state = [5, 1 << 29, 77, 1 << 27, 99];
        let wide = packer::<Wide>(&of(&odd));
        assert_eq!(wide.state(wide.pack(&state).unwrap()), state);
        assert_eq!(cut(&bits(&[30, 30, 8, 30, 28])), None);
    }

    #[test]
    fn wide_spaces() {
        let ends = [i32::MIN, -1, 0, i32::MAX];
        let three = packer::<Wide>(&[FULL; 3]);
        let states: Vec<[i32; 3]> = (0..64)
            .map(|n| [ends[n / 16], ends[n / 4 % 4], ends[n % 4]])
            .collect();
        let keys: Vec<Wide> = states.iter().map(|s| three.pack(s).unwrap()).collect();
        assert!(keys.windows(2).all(|pair| pair[0] < pair[1]));
        for (state, key) in states.iter().zip(keys) {
            assert_eq!(three.state(key), state);
        }
        assert!(Packer::<u64>::new(&[FULL; 3]).is_err());
        assert!(Packer::<Wide>::new(&[FULL; 4]).is_err());
        assert_eq!(space(&[FULL; 4]), Err(Error::SpaceTooLarge));
        assert_eq!(
            space(&[FULL, Domain { lo: 1, hi: 0 }]),
            Err(Error::EmptyDomain { variable: 1 })
        );
    }
}
