//! LFAddDInt (FC211): operand1 + operand2 of two DInt, with an overflow flag instead of a wrong value.

pub use crate::contract::Stateless as State;
pub use crate::srm::dint::{Operands as Inputs, Outcome as Outputs};

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

monitor! { srm::add_dint;
    /// The exact sum where it is a DInt, else 0 with the flag.
    sum_is_exact ["SRM-LFMATH-001", "SRM-P-73"]:
        when |s| s.before == State::INITIAL
            => s.outputs.is(s.inputs.operand1 as i64 + s.inputs.operand2 as i64);

    /// A result beside the flag is 0.
    overflow_gives_nothing ["SRM-LFMATH-001", "SRM-LFMATH-003", "SRM-P-73"]:
        when |s| s.outputs.overflow
            => s.outputs.result == 0;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let exact = inputs.operand1.checked_add(inputs.operand2);
    (state, Outputs::of(exact))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn add(operand1: i32, operand2: i32) -> (i32, bool) {
        let (_, outputs) = next(State::INITIAL, &Config, &Inputs { operand1, operand2 });
        (outputs.result, outputs.overflow)
    }

    /// SRM-LFMATH-001: the ends of DInt are -2147483648 and 2147483647.
    #[test]
    fn the_ends() {
        assert_eq!(add(2_147_483_646, 1), (2_147_483_647, false));
        assert_eq!(add(2_147_483_647, 1), (0, true));
        assert_eq!(add(-2_147_483_648, -1), (0, true));
        assert_eq!(add(-2_147_483_648, 2_147_483_647), (-1, false));
    }
}
