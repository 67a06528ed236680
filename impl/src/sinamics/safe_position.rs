//! Safe position (SP): the position that a drive transfers, in 16 and in 32 bits, with its validity; and the speed that the safety
//! program of the control makes of it.
//!
//! The numbers are those of r9708: one increment is 1 um or 0.001 degrees. A step is one cycle of the safety functions.

use crate::kernel::{ConfigError, Position};

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(super) enabled: bool,
        pub(super) absolute: bool,
        pub(super) short: bool,
        pub(super) scale: u16,
    }
}

impl Config {
    /// `enabled`: p9501.25. `absolute`: p9501.2, the position counts only while the axis is safely referenced. `short`: the
    /// telegram is 901, the one with S_XIST16. `scale`: p9574, at least 1.
    ///
    /// # Errors
    /// [`ConfigError::FactorOutOfRange`] for a scale of 0.
    pub const fn new(
        enabled: bool,
        absolute: bool,
        short: bool,
        scale: u16,
    ) -> Result<Self, ConfigError> {
        if scale == 0 {
            return Err(ConfigError::FactorOutOfRange);
        }
        Ok(Self {
            enabled,
            absolute,
            short,
            scale,
        })
    }
}

/// The modulo range p9505 of a rotary axis in degrees is one: 0, which switches it off, or 360 degrees times a power of two; with SLP
/// it must be 0 (S120-SP-007, A01794).
pub const fn modulo_fits(degrees: u32, slp: bool) -> bool {
    degrees == 0 || !slp && degrees % 720 == 0 && (degrees / 360).is_power_of_two()
}

/// The speed that the control makes of two transfers, in units of position per second, exact but for the division: the way by the
/// cycles between them, counted modulo 65536, each of `cycle_us` microseconds. None where the counter stands still: the speed
/// before then stays (S120-SP-006).
pub const fn speed(old: (i32, u16), new: (i32, u16), cycle_us: u16) -> Option<i64> {
    let cycles = new.1.wrapping_sub(old.1);
    if cycles == 0 || cycle_us == 0 {
        return None;
    }
    let way = new.0 as i64 - old.0 as i64;
    Some(way * 1_000_000 / (cycles as i64 * cycle_us as i64))
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// S_CYCLE_COUNT modulo 65536; the telegram shows the same 16 bits with a sign, as -32768 to 32767.
        pub cycle: u16,
    }
}

impl State {
    /// The counter begins at 0.
    pub const INITIAL: Self = Self { cycle: 0 };

    /// Every count is one.
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// r9708\[0\]: the position of the first channel.
        pub first: Position,
        /// r9708\[1\]: the position of the second channel.
        pub second: Position,
        /// The position is valid (r9722.22).
        pub valid: bool,
        /// The axis is safely referenced (r9722.23).
        pub referenced: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The transferred words are valid.
        pub valid: bool,
        /// S_XIST16: the mean in units of p9574, toward zero; 0 where it does not fit, or is not sent.
        pub short: i16,
        /// S_XIST32: the mean, toward zero.
        pub long: i32,
        /// S_CYCLE_COUNT.
        pub cycle: u16,
        /// The position does not fit the 16 bits in which it is sent: C01711 with value 7001, STOP F.
        pub too_wide: bool,
    }
}

/// The sum of both positions.
fn sum(inputs: &Inputs) -> i64 {
    i64::from(inputs.first.0) + i64::from(inputs.second.0)
}

monitor! { sinamics::safe_position;
    /// The short word is the mean divided by p9574, toward zero.
    short_word_is_the_scaled_mean ["S120-SP-005"]:
        when |s| s.config.enabled && s.config.short && !s.outputs.too_wide
            => {
                let scaled = i64::from(s.outputs.short) * 2 * i64::from(s.config.scale);
                let rest = sum(&s.inputs) - scaled;
                rest.abs() < 2 * i64::from(s.config.scale) && (rest == 0 || (rest > 0) == (sum(&s.inputs) > 0))
            };

    /// Beyond 32767 to either side it is STOP F, and no wrapped word.
    wide_position_is_stop_f ["S120-SP-005"]:
        when |s| s.config.enabled && s.config.short
            && sum(&s.inputs).abs() >= 32_768 * 2 * i64::from(s.config.scale)
            => s.outputs.too_wide && s.outputs.short == 0;

    /// Within them it is none.
    fitting_position_is_no_stop ["S120-SP-005"]:
        when |s| sum(&s.inputs).abs() < 32_768 * 2 * i64::from(s.config.scale)
            => !s.outputs.too_wide;

    /// A telegram without the short word transfers none, and no position is too wide for it.
    no_short_word_is_never_too_wide ["S120-SP-005"]:
        when |s| !s.config.short
            => !s.outputs.too_wide && s.outputs.short == 0;

    /// The long word is the mean itself, between both positions.
    long_word_is_the_mean ["S120-SP-004"]:
        when |s| s.config.enabled
            => (i64::from(s.outputs.long) * 2 - sum(&s.inputs)).abs() <= 1
                && i64::from(s.outputs.long).abs() * 2 <= sum(&s.inputs).abs();

    /// A relative position is valid with its signal, an absolute one only beside a safe reference.
    validity_wants_the_reference ["S120-SP-003", "S120-PF-21"]:
        when |s| s.config.enabled
            => s.outputs.valid == (s.inputs.valid && (!s.config.absolute || s.inputs.referenced));

    /// The counter counts cycles, modulo 65536.
    counter_counts ["S120-SP-006"]:
        when |s| s.config.enabled
            => s.outputs.cycle == s.after.cycle && s.after.cycle == s.before.cycle.wrapping_add(1);

    /// Without p9501.25 nothing is transferred, and nothing stops.
    disabled_transfers_nothing ["S120-SP-001"]:
        when |s| !s.config.enabled
            => s.outputs == Outputs::default();

    /// The state stays consistent.
    state_stays_consistent ["S120-SP-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = State {
        cycle: state.cycle.wrapping_add(1),
    };
    if !config.enabled {
        return (after, Outputs::default());
    }
    let sum = sum(inputs);
    let short = if config.short {
        sum / (2 * i64::from(config.scale.max(1)))
    } else {
        0
    };
    let too_wide = short.abs() > i64::from(i16::MAX);
    let outputs = Outputs {
        valid: inputs.valid && (!config.absolute || inputs.referenced),
        short: if too_wide { 0 } else { short as i16 },
        // The mean of two numbers of 32 bits is one.
        long: (sum / 2) as i32,
        cycle: after.cycle,
        too_wide,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn position(first: i32, second: i32, scale: u16) -> Outputs {
        sent(true, first, second, scale)
    }

    fn sent(short: bool, first: i32, second: i32, scale: u16) -> Outputs {
        let mut monitor = Monitor::new(Config::new(true, false, short, scale).expect("accepted"));
        monitor.step(&Inputs {
            first: Position(first),
            second: Position(second),
            ..Inputs::default()
        })
    }

    /// S120-SP-005, S120-SP-004: -29999 um in units of 1000 um are -29; +-737280000 are transferred in 32 bits.
    #[test]
    fn words_of_a_position() {
        assert_eq!(position(-29_999, -29_999, 1000).short, -29);
        assert_eq!(position(32_767_999, 32_767_999, 1000).short, 32_767);
        assert!(position(32_768_000, 32_768_000, 1000).too_wide);
        // Lines 3616 and 3627: the range of 16 bits is a matter of telegram 901 alone.
        assert!(!sent(false, 32_768_000, 32_768_000, 1000).too_wide);
        for end in [737_280_000, -737_280_000] {
            assert_eq!(position(end, end, 1000).long, end);
        }
    }

    /// S120-SP-006: the counter wraps, and one that stands still has no speed.
    #[test]
    fn speed_from_two_transfers() {
        assert_eq!(speed((0, 65_535), (12, 1), 12_000), Some(500));
        assert_eq!(speed((12, 1), (0, 3), 12_000), Some(-500));
        assert_eq!(speed((0, 7), (12, 7), 12_000), None);
    }

    /// S120-SP-007: 0, 720, 1440, ...; with SLP only 0.
    #[test]
    fn modulo_ranges() {
        for (degrees, fits) in [
            (0, true),
            (360, false),
            (720, true),
            (1080, false),
            (1440, true),
            (2160, false),
        ] {
            assert_eq!(modulo_fits(degrees, false), fits, "{degrees}");
            assert_eq!(modulo_fits(degrees, true), degrees == 0);
        }
    }
}
