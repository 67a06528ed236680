//! Numbers over an and-inverter graph (bit-blasting): two's complement, the least bit first, wide enough for their range, so that
//! nothing wraps around.

use super::graph::{Graph, Lit};

/// A number: its bits from the least to that of the sign. A number that is never negative has FALSE there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word(Vec<Lit>);

/// Bits that hold a number with its sign.
fn width(value: i64) -> usize {
    let used = if value < 0 { !value } else { value };
    (64 - used.leading_zeros()) as usize + 1
}

impl Word {
    /// A number that is known.
    pub fn constant(value: i64) -> Word {
        Word(
            (0..width(value))
                .map(|k| Lit::constant(value >> k & 1 == 1))
                .collect(),
        )
    }

    /// A truth value as 0 or 1.
    pub fn truth(value: Lit) -> Word {
        Word(vec![value, Lit::FALSE])
    }

    /// Bits that a variable of this range needs.
    pub fn needed(lo: i64, hi: i64) -> usize {
        let all = width(lo).max(width(hi));
        if lo < 0 { all } else { all - 1 }
    }

    /// A variable of this range, of its bits.
    pub fn variable(bits: Vec<Lit>, lo: i64) -> Word {
        let mut bits = bits;
        if lo >= 0 {
            bits.push(Lit::FALSE);
        }
        Word(bits)
    }

    /// Its bits without a sign that is known.
    pub fn bits(&self) -> &[Lit] {
        match self.0.split_last() {
            Some((sign, rest)) if *sign == Lit::FALSE => rest,
            _ => &self.0,
        }
    }

    /// Bit `k`; beyond the sign, the sign.
    pub fn bit(&self, k: usize) -> Lit {
        self.0
            .get(k)
            .or(self.0.last())
            .copied()
            .unwrap_or(Lit::FALSE)
    }

    /// The same number, where `map` gives by node what its bits are.
    pub(super) fn placed(&self, map: &[Lit]) -> Word {
        let bits = self.0.iter();
        Word(
            bits.map(|lit| map[lit.node()].flipped(lit.negated()))
                .collect(),
        )
    }

    fn sign(&self) -> Lit {
        self.bit(usize::MAX)
    }

    /// The same number in the bits that its range needs: what is cut off is known to repeat the sign.
    #[must_use]
    pub fn within(&self, lo: i64, hi: i64) -> Word {
        let size = Word::needed(lo, hi);
        Word::variable((0..size).map(|k| self.bit(k)).collect(), lo)
    }

    fn pair(&self, other: &Word) -> usize {
        self.0.len().max(other.0.len())
    }

    /// Sum of both and a carry, in so many bits.
    fn sum(&self, graph: &mut Graph, other: &Word, carry: Lit, size: usize) -> Word {
        let mut carry = carry;
        let mut bits = Vec::with_capacity(size);
        for k in 0..size {
            let (a, b) = (self.bit(k), other.bit(k));
            let differ = graph.xor(a, b);
            bits.push(graph.xor(differ, carry));
            carry = graph.choice(differ, carry, a);
        }
        Word(bits)
    }

    fn opposite_bits(&self) -> Word {
        Word(self.0.iter().map(|bit| !*bit).collect())
    }

    /// Their sum.
    pub fn plus(&self, graph: &mut Graph, other: &Word) -> Word {
        let size = self.pair(other) + 1;
        self.sum(graph, other, Lit::FALSE, size)
    }

    /// Their difference.
    pub fn minus(&self, graph: &mut Graph, other: &Word) -> Word {
        let size = self.pair(other) + 1;
        self.sum(graph, &other.opposite_bits(), Lit::TRUE, size)
    }

    /// Its opposite.
    pub fn negative(&self, graph: &mut Graph) -> Word {
        Word::constant(0).minus(graph, self)
    }

    /// Where the condition holds `self`, else `other`.
    pub fn choice(&self, graph: &mut Graph, condition: Lit, other: &Word) -> Word {
        let size = self.pair(other);
        Word(
            (0..size)
                .map(|k| graph.choice(condition, self.bit(k), other.bit(k)))
                .collect(),
        )
    }

    /// Its distance from 0.
    fn magnitude(&self, graph: &mut Graph) -> Word {
        let negative = self.negative(graph);
        negative.choice(graph, self.sign(), self)
    }

    /// Their product.
    pub fn times(&self, graph: &mut Graph, other: &Word) -> Word {
        let size = self.0.len() + other.0.len();
        let mut total = Word::constant(0);
        for k in 0..size {
            // In two's complement, the product of the bits extended to its width, cut off there.
            let shifted = Word(
                (0..size)
                    .map(|n| match n.checked_sub(k) {
                        Some(from) => graph.and(self.bit(from), other.bit(k)),
                        None => Lit::FALSE,
                    })
                    .collect(),
            );
            total = total.sum(graph, &shifted, Lit::FALSE, size);
        }
        total
    }

    /// Quotient cut off towards 0, and the remainder with the sign of the dividend. A divisor of 0 gives some numbers.
    pub fn divided(&self, graph: &mut Graph, other: &Word) -> (Word, Word) {
        let (dividend, divisor) = (self.magnitude(graph), other.magnitude(graph));
        let mut quotient = vec![Lit::FALSE; dividend.0.len()];
        let mut rest = Word::constant(0);
        for k in (0..dividend.0.len()).rev() {
            let mut bits = vec![dividend.bit(k)];
            bits.extend(&rest.0);
            bits.truncate(divisor.0.len() + 1);
            rest = Word::variable(bits, 0);
            let fits = !rest.less(graph, &divisor);
            let less = rest.minus(graph, &divisor);
            rest = less.choice(graph, fits, &rest);
            quotient[k] = fits;
        }
        let quotient = Word::variable(quotient, 0);
        let differ = graph.xor(self.sign(), other.sign());
        let (opposite, negative) = (quotient.negative(graph), rest.negative(graph));
        (
            opposite.choice(graph, differ, &quotient),
            negative.choice(graph, self.sign(), &rest),
        )
    }

    /// Whether both are the same.
    pub fn equals(&self, graph: &mut Graph, other: &Word) -> Lit {
        let size = self.pair(other);
        (0..size).fold(Lit::TRUE, |all, k| {
            let same = graph.same(self.bit(k), other.bit(k));
            graph.and(all, same)
        })
    }

    /// Whether it is less.
    pub fn less(&self, graph: &mut Graph, other: &Word) -> Lit {
        let size = self.pair(other);
        // From the least bit: the highest one that differs decides. At the sign it is the other way round.
        let mut less = Lit::FALSE;
        for k in 0..size {
            let (mut a, mut b) = (self.bit(k), other.bit(k));
            if k + 1 == size {
                (a, b) = (b, a);
            }
            let here = graph.and(!a, b);
            let differ = graph.xor(a, b);
            let below = graph.and(!differ, less);
            less = graph.or(here, below);
        }
        less
    }

    /// Whether a variable of this range, whose bits can hold more, keeps to it.
    pub fn keeps(&self, graph: &mut Graph, lo: i64, hi: i64) -> Lit {
        let (lo, hi) = (Word::constant(lo), Word::constant(hi));
        let (below, above) = (self.less(graph, &lo), hi.less(graph, self));
        graph.and(!below, !above)
    }
}

/// The number that bits stand for, of a variable whose least value is `lo`.
pub fn number(bits: impl IntoIterator<Item = bool>, lo: i64) -> i64 {
    let mut total: i64 = 0;
    let mut size = 0;
    let mut last = false;
    for bit in bits {
        total |= i64::from(bit) << size;
        size += 1;
        last = bit;
    }
    if lo < 0 && last {
        total - (1 << size)
    } else {
        total
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::proof::graph::value;

    /// A variable of this range.
    fn variable(graph: &mut Graph, lo: i64, hi: i64) -> Word {
        let bits = (0..Word::needed(lo, hi)).map(|_| graph.leaf()).collect();
        Word::variable(bits, lo)
    }

    fn read(values: &[bool], word: &Word) -> i64 {
        number(word.0.iter().map(|bit| value(values, *bit)), -1)
    }

    #[test]
    fn arithmetic_is_that_of_integers_on_every_pair() {
        for (range, other) in [
            ((-9, 7), (-5, 6)),
            ((0, 12), (0, 5)),
            ((-4, -1), (0, 9)),
            ((3, 3), (-1, 1)),
        ] {
            let mut graph = Graph::default();
            let a = variable(&mut graph, range.0, range.1);
            let b = variable(&mut graph, other.0, other.1);
            let plus = a.plus(&mut graph, &b);
            let minus = a.minus(&mut graph, &b);
            let times = a.times(&mut graph, &b);
            let (div, rem) = a.divided(&mut graph, &b);
            let negative = a.negative(&mut graph);
            let (less, equal) = (a.less(&mut graph, &b), a.equals(&mut graph, &b));
            let keeps = a.keeps(&mut graph, range.0, range.1);
            let fit = plus.within(range.0 + other.0, range.1 + other.1);
            for x in range.0..=range.1 {
                for y in other.0..=other.1 {
                    let mut bits = Vec::new();
                    for (word, v) in [(&a, x), (&b, y)] {
                        bits.extend((0..word.bits().len()).map(|k| v >> k & 1 == 1));
                    }
                    let values = graph.values(|node| bits[node - 1]);
                    assert_eq!(read(&values, &a), x);
                    assert_eq!(read(&values, &plus), x + y);
                    assert_eq!(read(&values, &fit), x + y);
                    assert_eq!(read(&values, &minus), x - y);
                    assert_eq!(read(&values, &times), x * y);
                    assert_eq!(read(&values, &negative), -x);
                    assert_eq!(value(&values, less), x < y);
                    assert_eq!(value(&values, equal), x == y);
                    assert!(value(&values, keeps));
                    if y != 0 {
                        assert_eq!((read(&values, &div), read(&values, &rem)), (x / y, x % y));
                    }
                }
            }
        }
    }

    #[test]
    fn a_range_is_kept_by_its_own_numbers_alone() {
        let mut graph = Graph::default();
        let word = variable(&mut graph, -3, 5);
        let keeps = word.keeps(&mut graph, -3, 5);
        for v in -8..8_i64 {
            let values = graph.values(|node| v >> (node - 1) & 1 == 1);
            assert_eq!(value(&values, keeps), (-3..=5).contains(&v), "{v}");
        }
    }
}
