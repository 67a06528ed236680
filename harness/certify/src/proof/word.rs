//! Whole numbers as bits: two's complement, the least bit first, as many as a number needs, so that nothing wraps around.

use super::gates::{Bit, Gates};

/// A number: its bits, the last one that of the sign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word(Vec<Bit>);

impl Word {
    /// Bits, of which the last one says that the number is below 0.
    pub fn new(mut bits: Vec<Bit>) -> Word {
        while bits.len() > 1 && bits[bits.len() - 1] == bits[bits.len() - 2] {
            bits.pop();
        }
        Word(bits)
    }

    /// A number that is known.
    pub fn constant(value: i64) -> Word {
        Word::new((0..64).map(|k| Bit::known(value >> k & 1 == 1)).collect())
    }

    /// 1 for TRUE, 0 for FALSE.
    pub fn truth(value: Bit) -> Word {
        Word::new(vec![value, Bit::FALSE])
    }

    /// Any number from `lo` to `hi`, and what says that it is one.
    pub fn between(gates: &mut Gates, lo: &Word, hi: &Word) -> (Word, Bit) {
        if lo == hi {
            return (lo.clone(), Bit::TRUE);
        }
        let mut bits: Vec<Bit> = (1..lo.0.len().max(hi.0.len()))
            .map(|_| gates.free())
            .collect();
        bits.push(match (lo.sign(), hi.sign()) {
            (Bit::FALSE, _) => Bit::FALSE,
            (_, Bit::TRUE) => Bit::TRUE,
            _ => gates.free(),
        });
        let word = Word::new(bits);
        let keeps = word.keeps(gates, lo, hi);
        (word, keeps)
    }

    /// Bit `k`; beyond the sign, the sign.
    pub fn bit(&self, k: usize) -> Bit {
        self.0.get(k).copied().unwrap_or_else(|| self.sign())
    }

    /// All bits.
    pub fn bits(&self) -> &[Bit] {
        &self.0
    }

    fn sign(&self) -> Bit {
        self.0.last().copied().unwrap_or(Bit::FALSE)
    }

    fn longer(&self, other: &Word) -> usize {
        self.0.len().max(other.0.len())
    }

    fn opposite(&self) -> Word {
        Word(self.0.iter().map(|bit| !*bit).collect())
    }

    /// The sum of both and a carry, in so many bits.
    fn add(&self, gates: &mut Gates, other: &Word, carry: Bit, size: usize) -> Word {
        let mut carry = carry;
        let mut sum = Vec::with_capacity(size);
        for k in 0..size {
            let (a, b) = (self.bit(k), other.bit(k));
            let differ = gates.xor(a, b);
            sum.push(gates.xor(differ, carry));
            carry = gates.choice(differ, carry, a);
        }
        Word::new(sum)
    }

    /// Their sum.
    pub fn plus(&self, gates: &mut Gates, other: &Word) -> Word {
        self.add(gates, other, Bit::FALSE, self.longer(other) + 1)
    }

    /// Their difference.
    pub fn minus(&self, gates: &mut Gates, other: &Word) -> Word {
        self.add(gates, &other.opposite(), Bit::TRUE, self.longer(other) + 1)
    }

    /// Its distance from 0.
    pub fn magnitude(&self, gates: &mut Gates) -> Word {
        let negative = Word::constant(0).minus(gates, self);
        negative.choice(gates, self.sign(), self)
    }

    /// Where the condition holds `self`, else `other`.
    pub fn choice(&self, gates: &mut Gates, condition: Bit, other: &Word) -> Word {
        let bits = 0..self.longer(other);
        Word::new(
            bits.map(|k| gates.choice(condition, self.bit(k), other.bit(k)))
                .collect(),
        )
    }

    /// Their product.
    pub fn times(&self, gates: &mut Gates, other: &Word) -> Word {
        let size = self.0.len() + other.0.len();
        let mut sum = Word::constant(0);
        for k in 0..other.0.len() {
            let row: Vec<Bit> = (0..size - k)
                .map(|n| gates.and(self.bit(n), other.bit(k)))
                .collect();
            let row = Word(vec![Bit::FALSE; k].into_iter().chain(row).collect());
            // The bit of the sign counts below 0.
            sum = match k + 1 == other.0.len() {
                true => sum.add(gates, &row.opposite(), Bit::TRUE, size),
                false => sum.add(gates, &row, Bit::FALSE, size),
            };
        }
        sum
    }

    /// Quotient cut off towards 0, and the rest with the sign of the dividend. Where the divisor is 0 they have some values.
    pub fn divided(&self, gates: &mut Gates, other: &Word) -> (Word, Word) {
        let (dividend, divisor) = (self.magnitude(gates), other.magnitude(gates));
        let (mut quotient, mut rest) = (vec![Bit::FALSE; dividend.0.len() + 1], Word::constant(0));
        for k in (0..dividend.0.len()).rev() {
            let bits = [dividend.bit(k)].into_iter().chain(rest.0.iter().copied());
            rest = Word::new(bits.collect());
            let fits = !rest.less(gates, &divisor);
            let less = rest.minus(gates, &divisor);
            rest = less.choice(gates, fits, &rest);
            quotient[k] = fits;
        }
        let quotient = Word::new(quotient);
        let differ = gates.xor(self.sign(), other.sign());
        let zero = Word::constant(0);
        let (opposite, negative) = (zero.minus(gates, &quotient), zero.minus(gates, &rest));
        (
            opposite.choice(gates, differ, &quotient),
            negative.choice(gates, self.sign(), &rest),
        )
    }

    /// Both are the same.
    pub fn equals(&self, gates: &mut Gates, other: &Word) -> Bit {
        let differ: Vec<Bit> = (0..self.longer(other))
            .map(|k| gates.xor(self.bit(k), other.bit(k)))
            .collect();
        !gates.any(differ)
    }

    /// It is not 0.
    pub fn is_true(&self, gates: &mut Gates) -> Bit {
        gates.any(self.0.iter().copied())
    }

    /// It is less.
    pub fn less(&self, gates: &mut Gates, other: &Word) -> Bit {
        // From the least bit on: the highest one that differs decides; at the sign the other way round.
        let last = self.longer(other) - 1;
        let mut less = Bit::FALSE;
        for k in 0..=last {
            let (a, b) = (self.bit(k), other.bit(k));
            let differ = gates.xor(a, b);
            less = gates.choice(differ, if k == last { a } else { b }, less);
        }
        less
    }

    /// It is from `lo` to `hi`.
    pub fn keeps(&self, gates: &mut Gates, lo: &Word, hi: &Word) -> Bit {
        let (below, above) = (self.less(gates, lo), hi.less(gates, self));
        gates.and(!below, !above)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of a word all of whose bits are known.
    fn number(word: &Word) -> i64 {
        let bit = |k: usize| match word.bit(k) {
            Bit::TRUE => 1,
            Bit::FALSE => 0,
            other => panic!("{other:?} is not known"),
        };
        (0..63).map(|k| bit(k) << k).sum::<i64>() + (bit(63) << 62).wrapping_mul(-2)
    }

    /// Of words all of whose bits are known every result is known: it is that of integers.
    #[test]
    fn arithmetic_is_that_of_integers_on_every_pair() {
        let mut gates = Gates::default();
        for x in -20..=20_i64 {
            let a = Word::constant(x);
            assert_eq!((number(&a), number(&a.magnitude(&mut gates))), (x, x.abs()));
            assert_eq!(a.is_true(&mut gates), Bit::known(x != 0));
            for y in -20..=20_i64 {
                let (b, gates) = (Word::constant(y), &mut gates);
                assert_eq!(number(&a.plus(gates, &b)), x + y);
                assert_eq!(number(&a.minus(gates, &b)), x - y);
                assert_eq!(number(&a.times(gates, &b)), x * y);
                assert_eq!(number(&a.choice(gates, Bit::FALSE, &b)), y);
                assert_eq!(a.less(gates, &b), Bit::known(x < y));
                assert_eq!(a.equals(gates, &b), Bit::known(x == y));
                assert_eq!(
                    a.keeps(gates, &b, &Word::constant(9)),
                    Bit::known(y <= x && x <= 9)
                );
                if y != 0 {
                    let (quotient, rest) = a.divided(gates, &b);
                    assert_eq!(
                        (number(&quotient), number(&rest)),
                        (x / y, x % y),
                        "{x} / {y}"
                    );
                }
            }
        }
    }

    /// A number of a range has bits for all of it.
    #[test]
    fn a_number_of_a_range_can_be_every_number_of_it() {
        for lo in -9..9_i64 {
            for hi in lo..9 {
                let mut gates = Gates::default();
                let (low, high) = (Word::constant(lo), Word::constant(hi));
                let (word, _) = Word::between(&mut gates, &low, &high);
                for value in lo..=hi {
                    let known = Word::constant(value);
                    for k in 0..8 {
                        let (bit, right) = (word.bit(k), known.bit(k));
                        assert!(bit == right || ![Bit::TRUE, Bit::FALSE].contains(&bit));
                        // Bits beyond the word repeat its sign, and so must those of the number.
                        assert!(k < word.bits().len() || right == known.bit(word.bits().len() - 1));
                    }
                }
            }
        }
    }
}
