//! The machine of the stories: an axis with every function that its kind permits, a clock, the signals of both channels.

use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Outputs, Pair, State};
use stillpoint_monitors::sinumerik::parameters::Parameters;
use stillpoint_monitors::sinumerik::reference::AxisState;

/// Enable word: SBH/SG, SE, STOP E, override, external stops, cam synchronisation, SN1+.
pub const ENABLED: u32 = 0b1_1111_0011;

/// A linear axis in cycles of 12 ms: all stop times and t_vel 100 ms = 9 cycles, t_chg 500 ms = 42 cycles, t_chk 9 cycles,
/// SG1 2000 mm/min = 400 um a cycle, window of the operating stop 1 mm, SE1 at 100 m, cam at 10 mm with 0.1 mm hysteresis.
pub fn parameters() -> Parameters {
    Parameters {
        function_enable: ENABLED,
        stop_switch_time_f: 100_000,
        ..Parameters::default()
    }
}

/// The pair with its clock. Cycle 0 is power-on; the field `inputs` is what the next cycle sees.
pub struct Machine {
    pair: Pair,
    /// The number of the next cycle.
    pub cycle: u32,
    /// What the channels see.
    pub inputs: Inputs,
}

impl Machine {
    /// A machine after power-on (cycle 0), with what was kept through power-off.
    pub fn powered(parameters: &Parameters, agreed: bool, standstill: Option<i32>) -> Self {
        Self::with(
            &Config::new(parameters.validate().expect("plausible")),
            agreed,
            standstill,
        )
    }

    /// The same with a configuration.
    pub fn with(config: &Config, agreed: bool, standstill: Option<i32>) -> Self {
        let axis = axis::State::restored(agreed, standstill.map(Position));
        let pair = Pair::resume(*config, State::restored(axis, axis)).expect("consistent");
        let mut machine = Self {
            pair,
            cycle: 0,
            inputs: Inputs::both(Local::idle()),
        };
        let _ = machine.once(|local| local.power_on = true);
        machine
    }

    /// Changes what both channels see from now on.
    pub fn both(&mut self, change: impl Fn(&mut Local)) -> &mut Self {
        change(&mut self.inputs.nck);
        change(&mut self.inputs.drive);
        self
    }

    /// One cycle.
    pub fn step(&mut self) -> Outputs {
        self.cycle += 1;
        self.pair.step(&self.inputs)
    }

    /// One cycle in which both channels see something once.
    pub fn once(&mut self, change: impl Fn(&mut Local)) -> Outputs {
        let before = self.inputs;
        self.both(change);
        let outputs = self.step();
        self.inputs = before;
        outputs
    }

    /// The outputs of cycle `cycle`, after all cycles before it.
    pub fn at(&mut self, cycle: u32) -> Outputs {
        assert!(cycle >= self.cycle, "cycle {cycle} is over");
        while self.cycle < cycle {
            let _ = self.step();
        }
        self.step()
    }

    /// The first cycle up to `last` in which `seen` holds.
    pub fn first(&mut self, last: u32, seen: impl Fn(&Outputs) -> bool) -> Option<u32> {
        while self.cycle <= last {
            let cycle = self.cycle;
            if seen(&self.step()) {
                return Some(cycle);
            }
        }
        None
    }

    /// The state of both channels.
    pub fn state(&self) -> &State {
        self.pair.state()
    }
}

/// The effective levels of both channels.
pub fn levels(outputs: &Outputs) -> (Level, Level) {
    (
        outputs.nck.channel.stop.level,
        outputs.drive.channel.stop.level,
    )
}

/// The same level in both channels.
pub fn both(level: Level) -> (Level, Level) {
    (level, level)
}

/// The axis is referenced at a position.
pub fn reference(local: &mut Local, refpos: i32) {
    local.referenced = true;
    local.refpos = Position(refpos);
    local.position = Position(refpos);
}

/// The axis is at a position.
pub fn move_to(position: i32) -> impl Fn(&mut Local) {
    move |local| local.position = Position(position)
}

/// An axis that is safely referenced from cycle 3 on, with agreement, standing at `position`: in cycle 1 it is referenced, in
/// cycle 2 each channel compares, in cycle 3 each knows that the other one has.
pub fn referenced(parameters: &Parameters, position: i32) -> Machine {
    let mut machine = Machine::powered(parameters, true, Some(position));
    machine.both(|local| reference(local, position));
    assert_eq!(machine.step().nck.reference.axis, AxisState::Ref);
    let outputs = machine.step();
    assert!(!outputs.nck.sga.safely_referenced && !outputs.drive.sga.safely_referenced);
    let outputs = machine.step();
    assert!(outputs.nck.sga.safely_referenced && outputs.drive.sga.safely_referenced);
    machine
}
