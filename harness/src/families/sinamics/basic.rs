//! The Basic Functions of a channel, in their own cycle: selection, the pair of terminals, SS1, and their stops.

use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinamics::basic_stop::{self, Latched};
use stillpoint_monitors::sinamics::terminal_pair::Phase;
use stillpoint_monitors::sinamics::{basic_selection, ss1_basic, terminal_pair};

use super::channel::Shared;
use super::signals::{Flag, Read};
use super::values::Values;

/// The monitors.
pub(super) struct Basic {
    terminals: Option<terminal_pair::Monitor>,
    ss1: ss1_basic::Monitor,
    stop: basic_stop::Monitor,
}

/// What the terminals are to each other.
#[derive(Clone, Copy, Default)]
pub(super) struct Terminals {
    /// They differ for longer than p9650.
    pub fault: bool,
    /// They differ, or have just done so, for less.
    pub tolerated: bool,
}

/// What they tell: what is selected, SS1, the stop, and the terminals.
pub(super) type Told = (
    basic_selection::Outputs,
    ss1_basic::Outputs,
    basic_stop::Outputs,
    Terminals,
);

impl Basic {
    /// At POWER ON, or running.
    pub(super) fn new(values: &Values, running: bool) -> Self {
        let stop = basic_stop::State {
            selected: !running,
            ..basic_stop::State::INITIAL
        };
        Self {
            terminals: values.terminals.map(terminal_pair::Monitor::new),
            ss1: ss1_basic::Monitor::new(values.ss1_basic),
            stop: resumed!(basic_stop, values.basic_stop, stop),
        }
    }

    /// What is selected.
    fn selection(values: &Values, bits: &Read) -> basic_selection::Outputs {
        let immediate = values.ss1_basic.time == Cycles::ZERO;
        basic_selection::Monitor::new(values.selection).step(&basic_selection::Inputs {
            terminal: bits.is(Flag::Terminal),
            sto: bits.is(Flag::Sto),
            // SS1 of the Extended Functions is another one, and without p9652 there is none.
            ss1: bits.is(Flag::Ss1) || values.extended.is_some() || immediate,
        })
    }

    /// Something is selected.
    pub(super) fn selects(values: &Values, bits: &Read) -> bool {
        let selection = Self::selection(values, bits);
        selection.sto || selection.ss1
    }

    /// The cycles of the Basic Functions in one of the Extended ones; whether these keep the pulses off, whether the brake is defective, and
    /// whether no telegram comes.
    pub(super) fn step(
        &mut self,
        values: &Values,
        bits: &Read,
        other: &Shared,
        edge: bool,
        [held, defect, silent]: [bool; 3],
    ) -> Told {
        let general = bits.is(Flag::General);
        let selection = Self::selection(values, bits);
        let mut said = Default::default();
        for _ in 0..values.basic_cycles {
            let ss1 = self.ss1.step(&ss1_basic::Inputs {
                selected: selection.ss1,
                sto: selection.sto || self.stop.state().stop >= Latched::A,
            });
            let own = bits.is(Flag::Terminal);
            let mut told = Terminals::default();
            if let Some(terminals) = &mut self.terminals {
                let differed = terminals.state().phase == Phase::Skew;
                let said = terminals.step(&terminal_pair::Inputs {
                    power_on: false,
                    own,
                    other: other.terminal,
                    held,
                    acknowledge: general || edge,
                });
                told = Terminals {
                    // Terminals that agree again are no cause any more.
                    fault: said.fault && own != other.terminal,
                    // What came of the difference is told a cycle later.
                    tolerated: !said.fault && (differed || terminals.state().phase == Phase::Skew),
                };
            }
            let stop = self.stop.step(&basic_stop::Inputs {
                power_on: false,
                difference: told.fault || silent,
                fault: defect,
                locking: false,
                selected: selection.sto || selection.ss1 || other.selected,
                acknowledge: general,
                internal_event_ack: edge,
            });
            said = (selection, ss1, stop, told);
        }
        said
    }
}
