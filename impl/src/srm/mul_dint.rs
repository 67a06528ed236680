//! LFMulDInt (FC213): operand1 * operand2 of two DInt, with an overflow flag instead of a wrong value.

pub use crate::contract::Stateless as State;
pub use crate::srm::dint::{Operands as Inputs, Outcome as Outputs};

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

monitor! { srm::mul_dint;
    /// The exact product where it is a DInt, else 0 with the flag.
    product_is_exact ["SRM-LFMATH-001", "SRM-P-73"]:
        when |s| s.before == State::INITIAL
            => s.outputs.is(s.inputs.operand1 as i64 * s.inputs.operand2 as i64);

    /// A result beside the flag is 0.
    overflow_gives_nothing ["SRM-LFMATH-001", "SRM-LFMATH-003", "SRM-P-73"]:
        when |s| s.outputs.overflow
            => s.outputs.result == 0;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let exact = inputs.operand1.checked_mul(inputs.operand2);
    (state, Outputs::of(exact))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mul(operand1: i32, operand2: i32) -> (i32, bool) {
        let (_, outputs) = next(State::INITIAL, &Config, &Inputs { operand1, operand2 });
        (outputs.result, outputs.overflow)
    }

    /// SRM-LFMATH-001, SRM-INTERP-008: 240000 mm/min times 10000 mm is no DInt.
    #[test]
    fn the_ends() {
        assert_eq!(mul(46_340, 46_340), (2_147_395_600, false));
        assert_eq!(mul(46_341, 46_341), (0, true));
        assert_eq!(mul(240_000, 10_000), (0, true));
        assert_eq!(mul(-2_147_483_648, 1), (-2_147_483_648, false));
        assert_eq!(mul(-2_147_483_648, -1), (0, true));
    }
}
