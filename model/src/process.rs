//! A system as one thread runs it. The search is compiled for each system; everything after it works on a system behind
//! a pointer, so that a new system costs little compile time.

use crate::choices::Odometer;
use crate::system::{Domain, Fault, System};

/// A system and a work area. The methods are those of [`System`] with the choices of an odometer.
pub(crate) trait Process: Send {
    fn initial(&mut self, choices: &mut Odometer, state: &mut [i32]);
    fn next(
        &mut self,
        before: &[i32],
        choices: &mut Odometer,
        after: &mut [i32],
    ) -> Result<(), Fault>;
    fn atom(&mut self, atom: usize, choices: &mut Odometer) -> Result<bool, Fault>;
    /// Adds `weight` to the count of each rule that fired.
    fn count(&self, weight: u64, coverage: &mut [u64]);
    fn discarded(&self) -> bool;
}

/// Where processes come from.
pub(crate) trait Origin: Sync {
    type Process: Process;
    fn process(&self) -> Self::Process;
    fn domains(&self) -> &[Domain];
    fn combinations(&self) -> u128;
    fn rules(&self) -> usize;
}

/// A process of a system of a known type.
pub(crate) struct Direct<'s, S: System> {
    system: &'s S,
    work: S::Work,
}

impl<S: System> Process for Direct<'_, S> {
    #[inline]
    fn initial(&mut self, choices: &mut Odometer, state: &mut [i32]) {
        self.system.initial(&mut self.work, choices, state);
    }

    #[inline]
    fn next(
        &mut self,
        before: &[i32],
        choices: &mut Odometer,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        self.system.next(&mut self.work, before, choices, after)
    }

    #[inline]
    fn atom(&mut self, atom: usize, choices: &mut Odometer) -> Result<bool, Fault> {
        self.system.atom(&mut self.work, atom, choices)
    }

    #[inline]
    fn count(&self, weight: u64, coverage: &mut [u64]) {
        self.system.fired(&self.work, &mut |rule| {
            if let Some(count) = coverage.get_mut(rule) {
                *count = count.saturating_add(weight);
            }
        });
    }

    #[inline]
    fn discarded(&self) -> bool {
        self.system.discarded(&self.work)
    }
}

/// A system of a known type.
pub(crate) struct Own<'s, S>(pub(crate) &'s S);

impl<'s, S: System> Origin for Own<'s, S> {
    type Process = Direct<'s, S>;

    fn process(&self) -> Direct<'s, S> {
        Direct {
            system: self.0,
            work: self.0.work(),
        }
    }

    fn domains(&self) -> &[Domain] {
        self.0.domains()
    }

    fn combinations(&self) -> u128 {
        self.0.combinations()
    }

    fn rules(&self) -> usize {
        self.0.rules()
    }
}

/// A process of a system behind a pointer.
pub(crate) type AnyProcess<'s> = Box<dyn Process + 's>;

impl Process for AnyProcess<'_> {
    fn initial(&mut self, choices: &mut Odometer, state: &mut [i32]) {
        (**self).initial(choices, state);
    }

    fn next(
        &mut self,
        before: &[i32],
        choices: &mut Odometer,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        (**self).next(before, choices, after)
    }

    fn atom(&mut self, atom: usize, choices: &mut Odometer) -> Result<bool, Fault> {
        (**self).atom(atom, choices)
    }

    fn count(&self, weight: u64, coverage: &mut [u64]) {
        (**self).count(weight, coverage);
    }

    fn discarded(&self) -> bool {
        (**self).discarded()
    }
}

/// A system that can be put behind a pointer: any.
trait Source: Sync {
    fn process(&self) -> AnyProcess<'_>;
    fn domains(&self) -> &[Domain];
    fn combinations(&self) -> u128;
    fn rules(&self) -> usize;
}

impl<S: System> Source for S {
    fn process(&self) -> AnyProcess<'_> {
        Box::new(Own(self).process())
    }

    fn domains(&self) -> &[Domain] {
        System::domains(self)
    }

    fn combinations(&self) -> u128 {
        System::combinations(self)
    }

    fn rules(&self) -> usize {
        System::rules(self)
    }
}

/// A system behind a pointer.
#[derive(Clone, Copy)]
pub(crate) struct Any<'s>(&'s dyn Source);

impl<'s> Any<'s> {
    pub(crate) fn new<S: System>(system: &'s S) -> Self {
        Any(system)
    }
}

impl<'s> Origin for Any<'s> {
    type Process = AnyProcess<'s>;

    fn process(&self) -> AnyProcess<'s> {
        self.0.process()
    }

    fn domains(&self) -> &[Domain] {
        self.0.domains()
    }

    fn combinations(&self) -> u128 {
        self.0.combinations()
    }

    fn rules(&self) -> usize {
        self.0.rules()
    }
}
