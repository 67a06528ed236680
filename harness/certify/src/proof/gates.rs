//! Functions of truth values as gates, and a gate as clauses.

use std::collections::HashMap;
use std::ops::Not;

/// The value of a gate, or its opposite. Its number is that of the gate, from 1 on, negative for the opposite; gate 1 is TRUE. In
/// clauses the numbers are those of the variables.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Bit(i32);

impl Bit {
    /// TRUE.
    pub const TRUE: Bit = Bit(1);
    /// FALSE.
    pub const FALSE: Bit = Bit(-1);

    /// A value that is known.
    pub fn known(value: bool) -> Bit {
        if value { Bit::TRUE } else { Bit::FALSE }
    }

    /// Its number.
    pub fn number(self) -> i32 {
        self.0
    }

    /// Itself, or its opposite.
    fn flipped(self, flip: bool) -> Bit {
        if flip { !self } else { self }
    }

    fn gate(self) -> usize {
        self.0.unsigned_abs() as usize - 1
    }
}

impl Not for Bit {
    type Output = Bit;

    fn not(self) -> Bit {
        Bit(-self.0)
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
enum Gate {
    True,
    /// Any value.
    Free,
    And(Bit, Bit),
    Xor(Bit, Bit),
    /// The second where the first holds, else the third.
    Choice(Bit, Bit, Bit),
}

impl Gate {
    fn parts(self) -> Vec<Bit> {
        match self {
            Gate::True | Gate::Free => Vec::new(),
            Gate::And(a, b) | Gate::Xor(a, b) => vec![a, b],
            Gate::Choice(c, a, b) => vec![c, a, b],
        }
    }

    /// What makes `own` its value.
    fn clauses(self, own: Bit, add: &mut impl FnMut(&[Bit])) {
        match self {
            Gate::True => add(&[own]),
            Gate::Free => {}
            Gate::And(a, b) => {
                add(&[!own, a]);
                add(&[!own, b]);
                add(&[own, !a, !b]);
            }
            Gate::Xor(a, b) => {
                add(&[!own, a, b]);
                add(&[!own, !a, !b]);
                add(&[own, !a, b]);
                add(&[own, a, !b]);
            }
            Gate::Choice(c, a, b) => {
                add(&[!c, !a, own]);
                add(&[!c, a, !own]);
                add(&[c, !b, own]);
                add(&[c, b, !own]);
                // These follow, and spare decisions about the condition.
                add(&[!a, !b, own]);
                add(&[a, b, !own]);
            }
        }
    }
}

/// Gates, each after its parts and each only once.
#[derive(Clone, Debug)]
pub struct Gates {
    gates: Vec<Gate>,
    known: HashMap<Gate, Bit>,
}

impl Default for Gates {
    fn default() -> Self {
        Gates {
            gates: vec![Gate::True],
            known: HashMap::new(),
        }
    }
}

impl Gates {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.gates.len()
    }

    fn add(&mut self, gate: Gate) -> Bit {
        if let Some(known) = self.known.get(&gate) {
            return *known;
        }
        self.gates.push(gate);
        let own = Bit(self.gates.len() as i32);
        if gate != Gate::Free {
            self.known.insert(gate, own);
        }
        own
    }

    /// A value of which nothing is known.
    pub fn free(&mut self) -> Bit {
        self.add(Gate::Free)
    }

    /// Both hold.
    pub fn and(&mut self, a: Bit, b: Bit) -> Bit {
        let (a, b) = (a.min(b), a.max(b));
        match (a, b) {
            (Bit::FALSE, _) | (_, Bit::FALSE) => Bit::FALSE,
            (Bit::TRUE, other) | (other, Bit::TRUE) => other,
            _ if a == b => a,
            _ if a == !b => Bit::FALSE,
            _ => self.add(Gate::And(a, b)),
        }
    }

    /// One of them holds.
    pub fn or(&mut self, a: Bit, b: Bit) -> Bit {
        !self.and(!a, !b)
    }

    /// They differ.
    pub fn xor(&mut self, a: Bit, b: Bit) -> Bit {
        let flip = (a.0 < 0) != (b.0 < 0);
        let (a, b) = (Bit(a.0.abs()), Bit(b.0.abs()));
        let (a, b) = (a.min(b), a.max(b));
        let differ = if a == b {
            Bit::FALSE
        } else if a == Bit::TRUE {
            !b
        } else {
            self.add(Gate::Xor(a, b))
        };
        differ.flipped(flip)
    }

    /// `a` where the condition holds, else `b`.
    pub fn choice(&mut self, condition: Bit, a: Bit, b: Bit) -> Bit {
        if condition.0 < 0 {
            return self.choice(!condition, b, a);
        }
        if condition == Bit::TRUE || a == b {
            return a;
        }
        if a == !b {
            return self.xor(condition, b);
        }
        if a == Bit::TRUE || a == condition {
            return self.or(condition, b);
        }
        if a == Bit::FALSE || a == !condition {
            return self.and(!condition, b);
        }
        if b == Bit::FALSE || b == condition {
            return self.and(condition, a);
        }
        if b == Bit::TRUE || b == !condition {
            return self.or(!condition, a);
        }
        let flip = a.0 < 0;
        let chosen = Gate::Choice(condition, a.flipped(flip), b.flipped(flip));
        self.add(chosen).flipped(flip)
    }

    /// All hold.
    pub fn all(&mut self, list: impl IntoIterator<Item = Bit>) -> Bit {
        list.into_iter().fold(Bit::TRUE, |a, b| self.and(a, b))
    }

    /// Some hold.
    pub fn any(&mut self, list: impl IntoIterator<Item = Bit>) -> Bit {
        list.into_iter().fold(Bit::FALSE, |a, b| self.or(a, b))
    }

    /// The gates that these values consist of, by place.
    fn below(&self, roots: impl IntoIterator<Item = Bit>) -> Vec<bool> {
        let mut seen = vec![false; self.gates.len()];
        let mut open: Vec<usize> = roots.into_iter().map(Bit::gate).collect();
        while let Some(gate) = open.pop() {
            if !std::mem::replace(&mut seen[gate], true) {
                open.extend(self.gates[gate].parts().into_iter().map(Bit::gate));
            }
        }
        seen
    }

    /// Whether one of the second values is among those of which nothing is known that the first ones depend on.
    pub fn depend(&self, roots: &[Bit], on: &[Vec<Bit>]) -> Vec<bool> {
        let seen = self.below(roots.iter().copied());
        let free = |bit: &Bit| self.gates[bit.gate()] == Gate::Free && seen[bit.gate()];
        on.iter().map(|list| list.iter().any(free)).collect()
    }

    /// Clauses that give every gate that these values consist of its value.
    pub fn clauses(&self, roots: impl IntoIterator<Item = Bit>, mut add: impl FnMut(&[Bit])) {
        // Gate 1 always, since a clause may have its number without being about it.
        let seen = self.below(roots.into_iter().chain([Bit::TRUE]));
        for (place, gate) in self.gates.iter().enumerate() {
            if seen[place] {
                gate.clauses(Bit(place as i32 + 1), &mut add);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The value of a gate under values of the free ones, which are gates 2 to 4.
    fn value(gates: &Gates, bit: Bit, free: u32) -> bool {
        let own = match gates.gates[bit.gate()] {
            Gate::True => true,
            Gate::Free => free >> (bit.gate() - 1) & 1 == 1,
            Gate::And(a, b) => value(gates, a, free) && value(gates, b, free),
            Gate::Xor(a, b) => value(gates, a, free) != value(gates, b, free),
            Gate::Choice(c, a, b) => match value(gates, c, free) {
                true => value(gates, a, free),
                false => value(gates, b, free),
            },
        };
        own != (bit.0 < 0)
    }

    /// Every gate over every three of some values has its truth table, and its clauses have it too.
    #[test]
    fn gates_and_their_clauses_are_the_functions_they_are_named_for() {
        let mut gates = Gates::default();
        let free = [(); 3].map(|()| gates.free());
        let all: Vec<Bit> = [Bit::TRUE].into_iter().chain(free).collect();
        let all: Vec<Bit> = all.iter().flat_map(|bit| [*bit, !*bit]).collect();
        for (k, a) in all.iter().enumerate() {
            for (n, b) in all.iter().enumerate() {
                let (a, b, c) = (*a, *b, all[(k + 3 * n) % all.len()]);
                for c in [c, a, b, !a, !b, all[2], all[5], all[6]] {
                    let (and, xor) = (gates.and(a, b), gates.xor(a, b));
                    let (or, choice) = (gates.or(a, b), gates.choice(c, a, b));
                    for values in 0..8 {
                        let of = |bit| value(&gates, bit, values);
                        let (x, y, z) = (of(a), of(b), of(c));
                        assert_eq!((of(and), of(or)), (x && y, x || y));
                        assert_eq!((of(xor), of(choice)), (x != y, if z { x } else { y }));
                    }
                }
            }
        }
        // The clauses hold with the right values, and with no other value of one gate.
        for values in 0..8 {
            for wrong in 0..gates.count() {
                if wrong > 0 && gates.gates[wrong] == Gate::Free {
                    continue;
                }
                for flip in [false, true] {
                    let of = |bit: Bit| {
                        let own = value(&gates, Bit(bit.0.abs()), values);
                        (own != (flip && bit.gate() == wrong)) == (bit.0 > 0)
                    };
                    let mut fine = true;
                    let root = Bit(wrong as i32 + 1);
                    gates.clauses([root], |clause| fine &= clause.iter().any(|bit| of(*bit)));
                    assert_eq!(fine, !flip, "gate {wrong}");
                }
            }
        }
    }
}
