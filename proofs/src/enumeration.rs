//! The engine that tries every choice.
//!
//! An odometer: the choices of a run are its digits, each with the range it was asked for. The next run repeats the digits
//! up to the last one that can still rise. A choice that a run does not make costs nothing.

use stillpoint_monitors::kernel::{Cycles, Position, Speed};

use crate::source::{Source, Verdict};

/// The wide values an enumeration tries; narrow values it tries all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Domain {
    /// The delays tried as parameters, in cycles.
    pub delays: &'static [u32],
    /// The highest speed tried; the lowest is 0.
    pub highest_speed: u32,
}

/// The result of an enumeration.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Runs inside the domain of the property, each a different case.
    pub cases: u64,
    /// Runs outside the domain.
    pub discarded: u64,
    /// How often each cover was met, in the order of the harness's list.
    pub covers: Vec<u64>,
    /// The first broken law, with the digits that lead to it; the enumeration stops there.
    pub broken: Option<(&'static str, Vec<u32>)>,
}

impl Count {
    /// Whether no law was broken and every one of the covers was met.
    pub fn proves(&self) -> bool {
        self.broken.is_none() && self.cases > 0 && self.covers.iter().all(|met| *met > 0)
    }
}

struct Digit {
    value: u32,
    highest: u32,
}

/// The odometer as a source.
pub struct Odometer {
    digits: Vec<Digit>,
    next: usize,
    domain: Domain,
    covers: Vec<u64>,
    part: u32,
}

impl Odometer {
    /// The part of the domain that the run is in; 0 where there are none.
    pub fn part(&self) -> u32 {
        self.part
    }

    /// A choice from 0 to `highest`.
    #[inline]
    fn choose(&mut self, highest: u32) -> u32 {
        let position = self.next;
        self.next += 1;
        if let Some(digit) = self.digits.get(position) {
            digit.value
        } else {
            self.digits.push(Digit { value: 0, highest });
            0
        }
    }

    /// Moves on to the next run; `false` when all have been made.
    fn advance(&mut self) -> bool {
        self.digits.truncate(self.next);
        self.next = 0;
        while let Some(last) = self.digits.last_mut() {
            if last.value < last.highest {
                last.value += 1;
                return true;
            }
            self.digits.pop();
        }
        false
    }
}

impl Source for Odometer {
    #[inline]
    fn any_in(&mut self, low: u32, high: u32) -> u32 {
        low + self.choose(high.saturating_sub(low))
    }

    fn any_delay(&mut self, longest: Cycles) -> Cycles {
        let delays = self.domain.delays;
        let index = self.choose((delays.len() as u32).saturating_sub(1));
        let delay = delays.get(index as usize).copied().unwrap_or(0);
        Cycles::new(delay.min(longest.count()))
    }

    fn any_cycles(&mut self, longest: Cycles) -> Cycles {
        Cycles::new(self.choose(longest.count()))
    }

    fn any_position(&mut self) -> Position {
        // Two positions tell "the same" from "another one", which is all the monitors compare.
        Position(if self.choose(1) == 0 { 0 } else { -7 })
    }

    fn any_speed(&mut self) -> Speed {
        Speed(self.choose(self.domain.highest_speed))
    }

    fn any_i32(&mut self, reach: u32) -> i32 {
        let reach = reach.min(i32::MAX as u32 / 2);
        match self.choose(2 * reach + 2) {
            0 => i32::MIN,
            1 => i32::MAX,
            // 2 to 2 * reach + 2.
            digit => digit as i32 - 2 - reach as i32,
        }
    }

    fn any_u32(&mut self, reach: u32, highest: u32) -> u32 {
        if reach >= highest {
            return self.choose(highest);
        }
        let digit = self.choose(reach + 1);
        if digit > reach { highest } else { digit }
    }

    fn any_whole(&mut self, low: i64, high: i64) -> i64 {
        low + i64::from(self.choose(u32::try_from(high - low).unwrap_or(u32::MAX)))
    }

    #[inline]
    fn enumerates(&self) -> bool {
        true
    }

    fn any_part(&mut self, parts: u32) -> u32 {
        self.part = 1 + self.choose(parts.saturating_sub(1));
        self.part
    }

    #[inline]
    fn cover(&mut self, index: usize, met: bool) {
        if let Some(count) = self.covers.get_mut(index) {
            *count += u64::from(met);
        }
    }
}

/// Runs the property for every choice, or until it breaks.
///
/// `covers` is the number of covers of the harness.
pub fn enumerate(
    domain: Domain,
    covers: usize,
    mut property: impl FnMut(&mut Odometer) -> Verdict,
) -> Count {
    let mut source = Odometer {
        digits: Vec::new(),
        next: 0,
        domain,
        covers: vec![0; covers],
        part: 0,
    };
    let mut cases = 0;
    let mut discarded = 0;
    let mut broken = None;
    loop {
        match property(&mut source) {
            Verdict::Held => cases += 1,
            Verdict::Discarded => discarded += 1,
            Verdict::Broken(law) => {
                cases += 1;
                broken = Some((
                    law,
                    source
                        .digits
                        .iter()
                        .take(source.next)
                        .map(|digit| digit.value)
                        .collect(),
                ));
                break;
            }
        }
        if !source.advance() {
            break;
        }
    }
    Count {
        cases,
        discarded,
        covers: source.covers,
        broken,
    }
}
