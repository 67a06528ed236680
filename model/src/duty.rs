//! A system together with the duty of a weak until: a product with the automaton of its obligation.

use crate::choices::Odometer;
use crate::parts::Component;
use crate::process::{Any, AnyProcess, Origin, Process, Source};
use crate::property::{Eval, Form};
use crate::report::Trace;
use crate::stages::{Condition, Stages};
use crate::system::{Choices, Domain, Fault};

/// The input that decides whether the duty of this `when` is the one followed.
const FOLLOW: u32 = u32::MAX;

/// The system with one more variable: whether the duty that is followed is pending. At a cycle with `when` the
/// environment chooses to follow its duty or not, so that every duty is followed on some run. Atom 0: the cycle does
/// not violate the duty followed.
pub(crate) struct Duty<'a> {
    system: Any<'a>,
    form: &'a Form,
    domains: Vec<Domain>,
}

impl<'a> Duty<'a> {
    pub(crate) fn new(system: Any<'a>, form: &'a Form) -> Self {
        let mut domains = system.domains().to_vec();
        domains.push(Domain { lo: 0, hi: 1 });
        Duty {
            system,
            form,
            domains,
        }
    }

    /// The run of the system itself.
    pub(crate) fn strip(&self, mut trace: Trace) -> Trace {
        for step in &mut trace.steps {
            step.retain(|(input, _)| *input != FOLLOW);
        }
        trace
    }
}

/// A process of the system, and whether the cycle violates the duty.
pub(crate) struct DutyProcess<'a> {
    inner: AnyProcess<'a>,
    form: &'a Form,
    violated: bool,
    saved: bool,
}

impl Source for Duty<'_> {
    fn process(&self) -> AnyProcess<'_> {
        Box::new(DutyProcess {
            inner: self.system.process(),
            form: self.form,
            violated: false,
            saved: false,
        })
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        self.system.combinations().wrapping_mul(2)
    }

    fn rules(&self) -> usize {
        0
    }

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

impl Process for DutyProcess<'_> {
    fn initial(&mut self, choices: &mut Odometer, state: &mut [i32]) {
        if let Some((duty, inner)) = state.split_last_mut() {
            self.inner.initial(choices, inner);
            *duty = 0;
        }
    }

    fn next(
        &mut self,
        before: &[i32],
        choices: &mut Odometer,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        self.violated = false;
        let (Some((pending, inner)), Some((duty, rest))) =
            (before.split_last(), after.split_last_mut())
        else {
            return Ok(());
        };
        self.inner.next(inner, choices, rest)?;
        *duty = 0;
        if self.inner.discarded() {
            return Ok(());
        }
        let Form::Unless {
            when,
            holds,
            unless,
        } = self.form
        else {
            return Ok(());
        };
        let mut eval = Eval {
            process: &mut self.inner,
            choices,
            fault: |_| (),
        };
        if *pending == 1 || (eval.atom(*when) && eval.choices.choose(FOLLOW, 2) == 1) {
            let sign = eval.duty(*holds, *unless);
            *duty = i32::from(sign.pending);
            self.violated = sign.bad;
        }
        Ok(())
    }

    fn atom(&mut self, _: usize, _: &mut Odometer) -> Result<bool, Fault> {
        Ok(!self.violated)
    }

    fn count(&self, _: u64, _: &mut [u64]) {}

    fn discarded(&self) -> bool {
        self.inner.discarded()
    }

    fn save(&mut self) {
        self.inner.save();
        self.saved = self.violated;
    }

    fn restore(&mut self) {
        self.inner.restore();
        self.violated = self.saved;
    }
}
