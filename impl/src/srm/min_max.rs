//! F_MIN_MAX (FC206): the least or the greatest of eight DInt, such as the most restrictive SLS limit.
//!
//! All inputs have to be connected; fewer signals are connected several times, since an open input is 0 (SRM-MINMAX-001).

pub use crate::contract::Stateless as State;

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The inputs of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Operand 1.
        pub in1: i32,
        /// Operand 2.
        pub in2: i32,
        /// Operand 3.
        pub in3: i32,
        /// Operand 4.
        pub in4: i32,
        /// Operand 5.
        pub in5: i32,
        /// Operand 6.
        pub in6: i32,
        /// Operand 7.
        pub in7: i32,
        /// Operand 8.
        pub in8: i32,
        /// 1: the greatest, 0: the least.
        pub mode: bool,
    }
}

impl Inputs {
    /// The operands in their order.
    pub const fn operands(&self) -> [i32; 8] {
        [
            self.in1, self.in2, self.in3, self.in4, self.in5, self.in6, self.in7, self.in8,
        ]
    }
}

fields! {
    /// The output of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The operand that was looked for.
        pub q: i32,
    }
}

monitor! { srm::min_max;
    /// What comes out has gone in.
    q_is_an_operand ["SRM-MINMAX-001", "SRM-P-72"]:
        when |s| s.before == State::INITIAL
            => s.inputs.operands().contains(&s.outputs.q);

    /// With MODE = 0 no operand is less: the most restrictive of the limits.
    least_of_all ["SRM-MINMAX-001", "SRM-MINMAX-002", "SRM-INTEG-002", "SRM-P-72"]:
        when |s| !s.inputs.mode
            => s.inputs.operands().iter().all(|operand| s.outputs.q <= *operand);

    /// With MODE = 1 no operand is greater.
    greatest_of_all ["SRM-MINMAX-001", "SRM-P-72"]:
        when |s| s.inputs.mode
            => s.inputs.operands().iter().all(|operand| s.outputs.q >= *operand);
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let chosen = |a: i32, b: i32| if inputs.mode { a.max(b) } else { a.min(b) };
    let rest = inputs.operands();
    let q = rest.into_iter().fold(inputs.in1, chosen);
    (state, Outputs { q })
}
