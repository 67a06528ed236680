//! Numbers in telegrams, scaled.

use crate::kernel::ConfigError;

/// The greatest number of S_SLS_LIMIT_A: 100 % of p9531\[0\] (S120-SLS-009).
pub const FULL_LIMIT: u16 = 32_767;

/// The limit of SLS level 1 that S_SLS_LIMIT_A asks for, in the unit of `highest`, p9531\[0\]; rounded down. `None` for a number that is
/// none: the response of level 1 and C01711 with value 1041 (S120-SLS-009).
pub const fn sls_limit(number: u16, highest: u32) -> Option<u32> {
    if number == 0 || number > FULL_LIMIT {
        return None;
    }
    // At most the highest itself.
    Some((highest as u64 * number as u64 / FULL_LIMIT as u64) as u32)
}

/// S_SLS_LIMIT_A_ACTIVE: the number of the active limit, rounded down, so that the host never is told a lower limit as a higher one
/// (S120-PSAFE-517). `None` where `highest` is 0 or the limit above it.
pub const fn sls_limit_active(limit: u32, highest: u32) -> Option<u16> {
    if highest == 0 || limit > highest {
        return None;
    }
    Some((limit as u64 * FULL_LIMIT as u64 / highest as u64) as u16)
}

/// S_V_LIMIT_B: the setpoint limit r9733\[2\] in parts of p2000, which is 4000 0000 hex; rounded toward 0, so that no limit becomes wider
/// (S120-SIC-506). Both in the same unit; `reference` is p2000.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] for a reference of 0, [`ConfigError::ValueTooLarge`] where 32 bits do not hold the result: from
/// twice p2000 on.
pub const fn v_limit(limit: i32, reference: u32) -> Result<i32, ConfigError> {
    if reference == 0 {
        return Err(ConfigError::ValueOutOfRange);
    }
    // 31 bits times 30 bits fit 64.
    let value = ((limit as i64) << 30) / reference as i64;
    if value < i32::MIN as i64 || value > i32::MAX as i64 {
        return Err(ConfigError::ValueTooLarge);
    }
    Ok(value as i32)
}

/// S_CYCLE_COUNT one cycle later: behind 32767 comes -32768 (S120-PSAFE-518).
pub const fn next_cycle(count: i16) -> i16 {
    count.wrapping_add(1)
}

/// The cycles between two counts, for less than 65536 of them (S120-PSAFE-518).
pub const fn cycles_between(earlier: i16, later: i16) -> u16 {
    later.wrapping_sub(earlier) as u16
}

/// The greatest magnitude of S_XIST16; beyond it STOP F and C01711 with value 7001 (S120-SP-005).
pub const LARGEST_XIST16: i16 = 32_767;

/// The greatest magnitude of S_XIST32, in micrometres or thousandths of a degree (S120-SP-004).
pub const LARGEST_XIST32: i32 = 737_280_000;

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-SIC-506: 4000 0000 hex is the speed in p2000.
    #[test]
    fn the_printed_scale_of_the_setpoint_limit() {
        assert_eq!(v_limit(3_000, 3_000), Ok(0x4000_0000));
        assert_eq!(v_limit(-1_500, 3_000), Ok(-0x2000_0000));
        assert_eq!(v_limit(1, 3), Ok(0x1555_5555));
        assert_eq!(v_limit(6_000, 3_000), Err(ConfigError::ValueTooLarge));
        assert_eq!(v_limit(-6_000, 3_000), Ok(i32::MIN));
        assert_eq!(v_limit(1, 0), Err(ConfigError::ValueOutOfRange));
    }

    /// S120-SLS-009, S120-PSAFE-517: 32767 is 100 %; 0 and negative numbers are none.
    #[test]
    fn the_printed_scale_of_the_sls_limit() {
        assert_eq!(sls_limit(32_767, 2_000), Some(2_000));
        assert_eq!(sls_limit(1, 2_000), Some(0));
        assert_eq!(sls_limit(16_384, 32_767), Some(16_384));
        assert_eq!(
            [0, 32_768, u16::MAX].map(|n| sls_limit(n, 2_000)),
            [None; 3]
        );
        assert_eq!(sls_limit_active(2_000, 2_000), Some(32_767));
        assert_eq!(sls_limit_active(2_001, 2_000), None);
    }

    /// S120-PSAFE-518.
    #[test]
    fn the_counter_of_the_cycles_wraps() {
        assert_eq!(next_cycle(i16::MAX), i16::MIN);
        assert_eq!(cycles_between(32_760, -32_760), 16);
    }
}
