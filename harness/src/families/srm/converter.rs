//! The drive of an axis: it brakes along its ramp, takes the torque away, and tests the brakes by the words of the telegram.
//!
//! A simple one, not SINAMICS: an SS1 brakes, then the brakes close, then the torque is gone; an STO takes it at once. The setpoint obeys the
//! limit and the locked directions that the wiring tells. What a drive monitors by itself is not simulated.

use stillpoint_machine::{Axis as MachineAxis, Machine};
use stillpoint_monitors::srm::brake_test::{self, Control};

use super::blocks::{Said, Stop};
use super::signals::{Flag, Number, Read};
use super::values::{self, BRAKE_TEST};
use crate::plant::{Actuation, Axis, Setpoint};

/// The duration of a sequence, ms, and how far the axis may be moved by it, nm: those of the screen form in figure 3-10. The torque is
/// built up before it, for as long.
const TEST_MS: u32 = 1_000;
const TEST_WAY: i64 = 1_000_000;

/// The setpoint keeps to so much of the limit of the velocity, in percent.
const SETPOINT_PERCENT: i64 = 95;

/// What the drive does with its torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Follows,
    /// An SS1 brakes.
    Brakes,
    /// It stands; its brakes close for so many cycles more.
    Closes(u32),
    Off,
}

/// Where the test of the brakes is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Test {
    #[default]
    None,
    Selected,
    /// The brake is to close.
    Closes,
    /// The drive presses, for so many cycles more.
    Presses(u32),
    /// The brake is to open.
    Opens,
    Finished,
}

/// The drive of an axis.
pub(super) struct Converter {
    /// What tests the brakes; none: the axis has none of its own.
    brakes: Option<brake_test::Config>,
    t_sample: u32,
    phase: Phase,
    test: Test,
    /// SBT_START in the cycle before.
    started: bool,
    /// What the sequence tests, from where, and what came of it.
    control: Control,
    from: i64,
    held: bool,
    /// No cycle has passed.
    first: bool,
    /// An SS1 is active.
    ss1: bool,
}

impl Converter {
    pub(super) fn new(machine: &Machine, axis: &MachineAxis) -> Self {
        let t_sample = values::t_sample(machine);
        let brakes = axis
            .has(BRAKE_TEST)
            .then(|| values::brake_test(axis, t_sample));
        Self {
            brakes,
            t_sample: t_sample.unsigned_abs(),
            phase: Phase::Off,
            test: Test::None,
            started: false,
            control: Control::default(),
            from: 0,
            held: false,
            first: true,
            ss1: false,
        }
    }

    /// It runs, its brakes are open.
    pub(super) fn running(mut self) -> Self {
        self.phase = Phase::Follows;
        self
    }

    /// What the program reads of the drive and of the brakes.
    pub(super) fn told(&self, axis: &Axis, read: Read) -> Read {
        let [first, second] = axis.brakes.map(|brake| brake.closed);
        read.flags(&[
            (Flag::Ss1Active, self.ss1),
            (Flag::FdbackDrive, self.opens()),
            (Flag::FdbackBr1, first),
            (Flag::FdbackBr2, second),
        ])
        .numbers(&[(Number::StatusWord, self.word())])
    }

    /// S_ZSW3B (table 3-19).
    fn word(&self) -> i64 {
        let presses = matches!(self.test, Test::Presses(_));
        let finished = self.test == Test::Finished;
        let bits = [
            self.test != Test::None,
            presses,
            self.control.br_select,
            presses,
            finished && self.held,
            finished,
            self.test == Test::Closes && self.external() || presses && self.external(),
            presses && self.control.torque_dir,
        ];
        let places = bits.iter().enumerate();
        places.map(|(place, bit)| i64::from(*bit) << place).sum()
    }

    /// The brake that is tested is an external one.
    fn external(&self) -> bool {
        let config = self.brakes.as_ref();
        config.is_none_or(|config| config.external(self.control.br_select))
    }

    /// Its brakes are to be open in normal operation.
    const fn opens(&self) -> bool {
        matches!(self.phase, Phase::Follows | Phase::Brakes)
    }

    /// A cycle, by what the program tells. `limited`: the setpoint obeys the limit of the velocity.
    pub(super) fn step(&mut self, said: &Said, axis: &mut Axis, run_up: bool, limited: bool) {
        let logic = &said.told.logic;
        let stop = if run_up { said.stop } else { Stop::Sto };
        self.ss1 = run_up && said.called && !logic.run;
        let stands = axis.plant.stands();
        let closing = self.closing();
        self.phase = match (stop, self.phase) {
            (Stop::None, _) => Phase::Follows,
            (Stop::Sto, _) | (_, Phase::Off) => Phase::Off,
            (Stop::Ss1, Phase::Brakes) if stands => Phase::Closes(closing),
            (Stop::Ss1, Phase::Follows | Phase::Brakes) => Phase::Brakes,
            (Stop::Ss1, Phase::Closes(0)) => Phase::Off,
            (Stop::Ss1, Phase::Closes(left)) => Phase::Closes(left - 1),
        };
        self.step_test(said, axis);
        self.step_brakes(said, axis);
        let asked = match (self.phase, self.test) {
            (Phase::Off, _) => Actuation::Coast,
            (Phase::Closes(_), _) => Actuation::CurrentLimit,
            (Phase::Brakes, _) => Actuation::Path,
            (Phase::Follows, Test::None) => Actuation::Follow,
            (Phase::Follows, Test::Presses(_)) => Actuation::BrakeTest,
            (Phase::Follows, _) => Actuation::CurrentLimit,
        };
        let wanted = axis.plant.setpoint;
        let towards = match wanted.target {
            Some(target) => target - axis.plant.position,
            None => wanted.speed,
        };
        let locked = towards > 0 && !logic.sdi_positive || towards < 0 && !logic.sdi_negative;
        if locked {
            axis.plant.setpoint = Setpoint::default();
        }
        // From mm/min to nm per cycle, less what keeps it below the limit as it is measured.
        let limit = i64::from(logic.sls_limit) * 1_000_000 * i64::from(self.t_sample) / 60_000;
        let limit = limit * SETPOINT_PERCENT / 100;
        axis.plant.limit = limited.then_some(limit);
        axis.obey(asked, false);
        self.first = false;
    }

    /// A sequence, in cycles.
    fn duration(&self) -> u32 {
        TEST_MS.div_ceil(self.t_sample)
    }

    /// For so many cycles the brakes close.
    fn closing(&self) -> u32 {
        let Some(config) = &self.brakes else {
            return 0;
        };
        let there = [false, true].into_iter().filter(|k| config.tests(*k));
        let times = there.map(|second| config.travel(second, true).count());
        times.max().unwrap_or(0)
    }

    fn step_test(&mut self, said: &Said, axis: &mut Axis) {
        let control = said.told.brake.stw;
        if !control.select || self.brakes.is_none() {
            self.test = Test::None;
            self.started = false;
            self.control = Control::default();
            return;
        }
        let closed = axis.brakes[usize::from(self.control.br_select)].closed;
        // An external brake is what the block says it is; its own the drive knows.
        let closed = match self.external() {
            true => control.fdback_br,
            false => closed,
        };
        let position = axis.plant.position;
        let begins = control.start && !self.started;
        self.test = match self.test {
            Test::None => Test::Selected,
            Test::Selected | Test::Finished if begins => {
                self.control = control;
                self.from = position;
                self.held = false;
                Test::Closes
            }
            Test::Closes if closed => Test::Presses(2 * self.duration()),
            Test::Presses(left) => {
                self.held = (position - self.from).abs() <= TEST_WAY;
                match left {
                    1.. if self.held => Test::Presses(left - 1),
                    _ => Test::Opens,
                }
            }
            Test::Opens if !closed => Test::Finished,
            other => other,
        };
        self.started = control.start;
        let built_up = match self.test {
            Test::Presses(left) => (2 * self.duration() - left).min(self.duration()),
            _ => 0,
        };
        let torque = axis.plant.braking() * i64::from(built_up) / i64::from(self.duration());
        axis.plant.press = if self.control.torque_dir {
            -torque
        } else {
            torque
        };
    }

    fn step_brakes(&self, said: &Said, axis: &mut Axis) {
        let Some(config) = &self.brakes else {
            return;
        };
        let told = &said.told.brake;
        let tests = matches!(self.test, Test::Closes | Test::Presses(_)) && !self.external();
        let external = [told.open_br_1, told.open_br_2];
        let braking = axis.plant.braking();
        let mut held = 0;
        for (k, brake) in axis.brakes.iter_mut().enumerate() {
            let second = k == 1;
            if !config.tests(second) {
                continue;
            }
            let open = match config.external(second) {
                // OPEN_BR_x AND no STO, at the output (SRM-INTEG-007).
                true => external[k] && said.told.logic.torque,
                false => self.opens() && !(tests && self.control.br_select == second),
            };
            // Half of the time that the block gives it: it is in order.
            let time = match self.first {
                true => 0,
                false => config.travel(second, !open).count() / 2,
            };
            brake.ask(!open, time);
            held += brake.holds(braking);
        }
        axis.plant.held = Some(held);
    }
}
