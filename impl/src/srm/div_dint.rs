//! LFDivDInt (FC214): operand1 / operand2 of two DInt, with an overflow flag instead of a wrong value.
//!
//! The manual does not say how a quotient is rounded nor what a division by 0 gives. AMB-36: truncated toward zero; a division by
//! 0 has no result and tells an overflow (SRM-LFMATH-002).

pub use crate::contract::Stateless as State;
pub use crate::srm::dint::{Operands as Inputs, Outcome as Outputs};

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

/// What truncation toward zero leaves: less than the divisor, with the sign of the dividend.
fn remainder_of_truncation(inputs: &Inputs, outputs: &Outputs) -> bool {
    let (a, b) = (inputs.operand1 as i64, inputs.operand2 as i64);
    let left = a - outputs.result as i64 * b;
    left.abs() < b.abs() && (left == 0 || (left < 0) == (a < 0))
}

monitor! { srm::div_dint;
    /// The quotient toward zero: what is left is less than the divisor and has the sign of the dividend.
    quotient_is_truncated ["SRM-LFMATH-001", "SRM-LFMATH-002", "SRM-P-73"]:
        when |s| !s.outputs.overflow
            => remainder_of_truncation(&s.inputs, &s.outputs);

    /// Only a division by 0 and the one quotient above the greatest DInt overflow.
    overflow_is_the_exception ["SRM-LFMATH-001", "SRM-LFMATH-002", "SRM-P-73"]:
        when |s| s.before == State::INITIAL
            => s.outputs.overflow
                == (s.inputs.operand2 == 0 || s.inputs.operand1 == i32::MIN && s.inputs.operand2 == -1);

    /// A result beside the flag is 0.
    overflow_gives_nothing ["SRM-LFMATH-001", "SRM-LFMATH-003", "SRM-P-73"]:
        when |s| s.outputs.overflow
            => s.outputs.result == 0;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let exact = inputs.operand1.checked_div(inputs.operand2);
    (state, Outputs::of(exact))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn div(operand1: i32, operand2: i32) -> (i32, bool) {
        let (_, outputs) = next(State::INITIAL, &Config, &Inputs { operand1, operand2 });
        (outputs.result, outputs.overflow)
    }

    /// SRM-LFMATH-002.
    #[test]
    fn truncation_and_overflow() {
        assert_eq!(div(7, 2), (3, false));
        assert_eq!(div(-7, 2), (-3, false));
        assert_eq!(div(7, -2), (-3, false));
        assert_eq!(div(1, 0), (0, true));
        assert_eq!(div(0, 0), (0, true));
        assert_eq!(div(-2_147_483_648, -1), (0, true));
        assert_eq!(div(-2_147_483_648, 1), (-2_147_483_648, false));
    }
}
