//! Runs of STOP F.

use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinumerik::fault::{Config, FaultState, Inputs, State};

use super::Subject;
use crate::draw;
use crate::source::{Source, Verdict};

/// STOP F with an active function requests STOP B after exactly t_F cycles, whatever RESET, de-selection and STOP C, D, E
/// do in the meantime.
///
/// Cover 0: a delay runs, cover 1: RESET arrives in it.
pub fn delay_leads_to_stop_b<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let t_f = source.any_in(0, 2);
    let Ok(config) = Config::new(Cycles::new(t_f)) else {
        return Verdict::Discarded;
    };
    let found = Inputs {
        discrepancy: true,
        monitoring: true,
        ..Inputs::default()
    };
    let (mut state, mut outputs) = subject.fault(State::INITIAL, &config, &found);
    let mut cycles = 0;
    let mut reset = false;
    while !outputs.stop_b {
        if cycles == t_f {
            return Verdict::Broken("stop_b_within_t_f");
        }
        cycles += 1;
        let inputs = Inputs {
            power_on: false,
            ..draw::any(source)
        };
        reset |= inputs.reset;
        (state, outputs) = subject.fault(state, &config, &inputs);
    }
    source.cover(0, t_f > 1);
    source.cover(1, reset);
    if cycles == t_f && state.fault == FaultState::Expired {
        Verdict::Held
    } else {
        Verdict::Broken("stop_b_not_before_t_f")
    }
}
