//! What the overflow-checked operations on DInt have in common: operands, and an outcome that says whether it is one. No step.

fields! {
    /// The operands of an operation.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Operands {
        /// Operand 1.
        pub operand1: i32,
        /// Operand 2.
        pub operand2: i32,
    }
}

fields! {
    /// The outcome of an operation.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outcome {
        /// The exact result, 0 where there is none.
        pub result: i32,
        /// The exact result is no DInt: all that these functions tell of an error (SRM-DIAG-002).
        pub overflow: bool,
    }
}

impl Outcome {
    /// The outcome of an operation whose exact result is this one, or no DInt.
    pub const fn of(exact: Option<i32>) -> Self {
        match exact {
            Some(result) => Self {
                result,
                overflow: false,
            },
            None => Self {
                result: 0,
                overflow: true,
            },
        }
    }

    /// It is what an operation with this exact result must give.
    pub const fn is(self, exact: i64) -> bool {
        if exact < i32::MIN as i64 || exact > i32::MAX as i64 {
            self.overflow && self.result == 0
        } else {
            !self.overflow && self.result as i64 == exact
        }
    }
}
