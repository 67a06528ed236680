//! Clauses, and what follows from them by unit propagation: a lemma is accepted if its opposite leads to a contradiction that way
//! (reverse unit propagation, RUP). Each clause is watched at two of its literals.

/// Clauses with what is known from them alone.
#[derive(Default)]
pub struct Clauses {
    /// One after the other, the two that are watched first in each.
    literals: Vec<i32>,
    /// By literal the clauses that watch it: where they begin and their length.
    watched: Vec<Vec<(u32, u32)>>,
    /// By literal: 1 if it holds, -1 if its opposite does.
    values: Vec<i8>,
    /// What holds, in the order in which it was found.
    trail: Vec<i32>,
    /// How much of the trail was looked at.
    done: usize,
    /// Nothing satisfies all clauses.
    refuted: bool,
}

fn place(literal: i32) -> usize {
    (literal.unsigned_abs() as usize) * 2 + usize::from(literal < 0)
}

impl Clauses {
    /// None yet, over the variables 1 to `variables`.
    pub fn new(variables: usize) -> Self {
        Clauses {
            watched: vec![Vec::new(); 2 * variables + 2],
            values: vec![0; 2 * variables + 2],
            ..Clauses::default()
        }
    }

    /// Whether this is a literal of one of its variables.
    pub fn knows(&self, literal: i32) -> bool {
        literal != 0 && place(literal) < self.values.len()
    }

    fn value(&self, literal: i32) -> i8 {
        self.values[place(literal)]
    }

    fn set(&mut self, literal: i32) {
        self.values[place(literal)] = 1;
        self.values[place(-literal)] = -1;
        self.trail.push(literal);
    }

    /// Adds a clause that is given.
    pub fn add(&mut self, clause: &[i32]) {
        let mut own = clause.to_vec();
        own.sort_unstable();
        own.dedup();
        // What is FALSE now is so for good: nothing is assumed.
        own.retain(|literal| self.value(*literal) >= 0);
        if own
            .iter()
            .any(|l| self.value(*l) > 0 || own.binary_search(&-l).is_ok())
        {
            return;
        }
        match own[..] {
            [] => self.refuted = true,
            [one] => {
                self.set(one);
                self.refuted |= !self.propagate();
            }
            [first, second, ..] => {
                let clause = (self.literals.len() as u32, own.len() as u32);
                self.literals.extend(own);
                self.watched[place(first)].push(clause);
                self.watched[place(second)].push(clause);
            }
        }
    }

    /// Adds a clause if it follows by unit propagation; whether it does.
    pub fn lemma(&mut self, clause: &[i32]) -> bool {
        let opposite: Vec<i32> = clause.iter().map(|literal| -literal).collect();
        let follows = self.refutes(&opposite);
        if follows {
            self.add(clause);
        }
        follows
    }

    /// Whether unit propagation shows that these literals do not hold together.
    pub fn refutes(&mut self, assumed: &[i32]) -> bool {
        if self.refuted {
            return true;
        }
        let known = self.trail.len();
        let mut refuted = false;
        for literal in assumed {
            match self.value(*literal) {
                0 => self.set(*literal),
                1 => {}
                _ => refuted = true,
            }
        }
        let refuted = refuted || !self.propagate();
        for literal in self.trail.split_off(known) {
            self.values[place(literal)] = 0;
            self.values[place(-literal)] = 0;
        }
        self.done = known;
        refuted
    }

    /// Finds what follows; false if a clause is violated.
    fn propagate(&mut self) -> bool {
        while let Some(literal) = self.trail.get(self.done).copied() {
            self.done += 1;
            let mut list = std::mem::take(&mut self.watched[place(-literal)]);
            let mut fine = true;
            list.retain(|clause| {
                !fine || {
                    let kept = self.look(-literal, *clause);
                    fine = kept != Some(false);
                    kept.is_some()
                }
            });
            self.watched[place(-literal)].append(&mut list);
            if !fine {
                return false;
            }
        }
        true
    }

    /// A clause whose watched literal has become FALSE. None if it watches another one now; else whether it can still hold.
    fn look(&mut self, gone: i32, (start, length): (u32, u32)) -> Option<bool> {
        let start = start as usize;
        if self.literals[start] == gone {
            self.literals.swap(start, start + 1);
        }
        let other = self.literals[start];
        if self.value(other) > 0 {
            return Some(true);
        }
        for k in start + 2..start + length as usize {
            if self.value(self.literals[k]) >= 0 {
                self.literals.swap(start + 1, k);
                let new = self.literals[start + 1];
                self.watched[place(new)].push((start as u32, length));
                return None;
            }
        }
        if self.value(other) < 0 {
            return Some(false);
        }
        self.set(other);
        Some(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Clauses of up to three literals over four variables, drawn at random: what is accepted follows in every valuation, and what
    /// propagation by hand finds is found.
    #[test]
    fn what_is_accepted_follows_and_what_propagates_is_found() {
        let mut seed = 0x2545_f491_4f6c_dd1d_u64;
        let mut draw = |below: u64| {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            seed % below
        };
        let (mut accepted, mut refused) = (0, 0);
        for _ in 0..4000 {
            let mut clause = || -> Vec<i32> {
                let literals = 0..=draw(3);
                literals
                    .map(|_| (draw(4) as i32 + 1) * if draw(2) == 0 { 1 } else { -1 })
                    .collect()
            };
            let given: Vec<Vec<i32>> = (0..7).map(|_| clause()).collect();
            let wanted = clause();
            let mut clauses = Clauses::new(4);
            given.iter().for_each(|c| clauses.add(c));
            let own = clauses.lemma(&wanted);
            assert_eq!(own, by_hand(&given, &wanted), "{given:?} {wanted:?}");
            let holds = |values: u32, clause: &Vec<i32>| {
                let one = |l: &i32| (values >> (l.abs() - 1) & 1 == 1) == (*l > 0);
                clause.iter().any(one)
            };
            let follows = (0..16)
                .filter(|values| given.iter().all(|c| holds(*values, c)))
                .all(|values| holds(values, &wanted));
            assert!(!own || follows);
            // Nothing is left of what was assumed, and what was accepted is known.
            assert_eq!(clauses.lemma(&wanted), own);
            accepted += u32::from(own);
            refused += u32::from(follows && !own);
        }
        assert!(accepted > 500 && refused > 0, "{accepted} {refused}");
    }

    fn by_hand(given: &[Vec<i32>], wanted: &[i32]) -> bool {
        let mut known: Vec<i32> = wanted.iter().map(|l| -l).collect();
        loop {
            if known.iter().any(|l| known.contains(&-l)) {
                return true;
            }
            let before = known.len();
            for clause in given {
                let mut left: Vec<i32> = (clause.iter().copied())
                    .filter(|l| !known.contains(&-l))
                    .collect();
                left.dedup();
                left.sort_unstable();
                left.dedup();
                match left[..] {
                    [] => return true,
                    [one] if !known.contains(&one) => known.push(one),
                    _ => {}
                }
            }
            if known.len() == before {
                return false;
            }
        }
    }
}
