//! A system as one thread runs it. The explorer works on a system behind a pointer, so that a further system costs hardly any
//! compile time: a call for each cycle and each atom, while a cycle reads its inputs without one.

use crate::choices::Odometer;
use crate::parts::Component;
use crate::stages::{Condition, Stages};
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
    /// Keeps the work area as it is after a step, for [`Process::restore`].
    fn save(&mut self);
    /// Makes the work area again what it was at the last `save`.
    fn restore(&mut self);
}

/// Calls `each` for every combination of the inputs that it reads beyond what the step has read. So what several
/// observers of one cycle read adds up, where one enumeration for all of them would multiply. The work area must have
/// been saved after the step; it is the saved one again at the end.
#[inline]
pub(crate) fn beyond<P: Process + ?Sized>(
    process: &mut P,
    choices: &mut Odometer,
    mut each: impl FnMut(&mut P, &mut Odometer),
) {
    let mark = choices.mark();
    loop {
        each(process, choices);
        // Without a further input the work area is still right: what it holds besides follows from the inputs read.
        if choices.is_beyond(mark) {
            process.restore();
        }
        if !choices.advance_beyond(mark) {
            return;
        }
    }
}

/// Where processes come from.
pub(crate) trait Origin: Sync {
    type Process: Process;
    fn process(&self) -> Self::Process;
    fn domains(&self) -> &[Domain];
    fn combinations(&self) -> u128;
    fn rules(&self) -> usize;
    fn components(&self) -> Vec<Component<'_>> {
        Vec::new()
    }
    fn timer(&self) -> Option<usize> {
        None
    }
    fn stages(&self, _: &[Condition]) -> Option<Box<dyn Stages + '_>> {
        None
    }
}

/// A process of a system of a known type.
pub(crate) struct Direct<'s, S: System> {
    system: &'s S,
    work: S::Work,
    saved: S::Work,
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

    #[inline]
    fn save(&mut self) {
        if self.system.atoms_read() {
            self.saved.clone_from(&self.work);
        }
    }

    #[inline]
    fn restore(&mut self) {
        self.work.clone_from(&self.saved);
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

    fn save(&mut self) {
        (**self).save();
    }

    fn restore(&mut self) {
        (**self).restore();
    }
}

/// A system that can be put behind a pointer: any.
pub(crate) trait Source: Sync {
    fn process(&self) -> AnyProcess<'_>;
    fn domains(&self) -> &[Domain];
    fn combinations(&self) -> u128;
    fn rules(&self) -> usize;
    fn components(&self) -> Vec<Component<'_>>;
    fn timer(&self) -> Option<usize>;
    fn stages(&self, conditions: &[Condition]) -> Option<Box<dyn Stages + '_>>;
}

impl<S: System> Source for S {
    fn process(&self) -> AnyProcess<'_> {
        Box::new(Direct {
            system: self,
            work: self.work(),
            saved: self.work(),
        })
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

    fn components(&self) -> Vec<Component<'_>> {
        System::components(self)
    }

    fn timer(&self) -> Option<usize> {
        System::timer(self)
    }

    fn stages(&self, conditions: &[Condition]) -> Option<Box<dyn Stages + '_>> {
        System::stages(self, conditions)
    }
}

/// A system behind a pointer.
#[derive(Clone, Copy)]
pub(crate) struct Any<'s>(&'s dyn Source);

impl<'s> Any<'s> {
    pub(crate) fn new<S: System>(system: &'s S) -> Self {
        Any(system)
    }

    pub(crate) fn of(source: &'s dyn Source) -> Self {
        Any(source)
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

    fn components(&self) -> Vec<Component<'_>> {
        self.0.components()
    }

    fn timer(&self) -> Option<usize> {
        self.0.timer()
    }

    fn stages(&self, conditions: &[Condition]) -> Option<Box<dyn Stages + '_>> {
        self.0.stages(conditions)
    }
}
