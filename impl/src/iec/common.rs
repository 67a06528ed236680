//! What the functions have in common: values, edges, latched demands. No step.

use crate::kernel::ConfigError;

fields! {
    /// A speed, a torque, a force or an acceleration with its sign: wide enough for every difference of two numbers of 32 bits, and
    /// for every magnitude of 32 bits with either sign.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub struct Value(i64) in -4_294_967_295..=4_294_967_295;
}

impl Value {
    /// Nothing.
    pub const ZERO: Self = Self(0);

    /// The value with this number.
    ///
    /// # Errors
    /// [`ConfigError::ValueTooLarge`] when its magnitude needs more than 32 bits.
    pub const fn new(number: i64) -> Result<Self, ConfigError> {
        if number.unsigned_abs() <= u32::MAX as u64 {
            Ok(Self(number))
        } else {
            Err(ConfigError::ValueTooLarge)
        }
    }

    /// A measured value.
    pub const fn measured(number: i32) -> Self {
        Self(number as i64)
    }

    /// `minuend` less `subtrahend`, exactly: the magnitude of a difference of two numbers of 32 bits has 32 bits.
    pub const fn difference(minuend: i32, subtrahend: i32) -> Self {
        Self(minuend as i64 - subtrahend as i64)
    }

    /// A limit of a magnitude, as the upper end of its range.
    pub const fn positive(magnitude: u32) -> Self {
        Self(magnitude as i64)
    }

    /// A limit of a magnitude, as the lower end of its range.
    pub const fn negative(magnitude: u32) -> Self {
        Self(-(magnitude as i64))
    }

    /// Its number.
    pub const fn get(self) -> i64 {
        self.0
    }
}

/// Whether a signal has become 1 since the cycle before. The memories start at 1, so that one that is 1 when the power returns is no
/// edge (IEC-MON-007).
pub(crate) const fn rises(now: bool, before: bool) -> bool {
    now && !before
}

/// What a demand is after a cycle: a violation raises it in the same cycle, whoever acknowledges; an edge of the acknowledgement ends
/// it where the function is ready for that.
pub(crate) const fn latch(held: bool, violated: bool, edge: bool, ready: bool) -> bool {
    violated || held && !(edge && ready)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// IEC-ACC-001: the widest differences are values, nothing wider is.
    #[test]
    fn every_difference_is_a_value() {
        let widest = i64::from(u32::MAX);
        assert_eq!(Value::difference(i32::MAX, i32::MIN).get(), widest);
        assert_eq!(Value::difference(i32::MIN, i32::MAX).get(), -widest);
        assert_eq!(Value::new(widest), Ok(Value::positive(u32::MAX)));
        assert_eq!(Value::new(-widest), Ok(Value::negative(u32::MAX)));
        for number in [widest + 1, -widest - 1, i64::MIN, i64::MAX] {
            assert_eq!(Value::new(number), Err(ConfigError::ValueTooLarge));
        }
    }
}
