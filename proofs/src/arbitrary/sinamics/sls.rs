//! The limit of SLS that a telegram asks for in the place of itself, for Kani.

use stillpoint_monitors::kernel::Speed;

/// `setting::of_telegram` as what its quotient is: any part of the limit of level 1, and the exact one of a limit below 256. So nothing
/// is divided; that the monitor takes the exact one of wider limits as well is the property `s120_sls_of_telegram`.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn any_of_telegram(value: i16, first: Speed) -> Option<Speed> {
    if value < 1 {
        return None;
    }
    let limit = Speed(kani::any());
    kani::assume(limit <= first);
    if first.0 <= u32::from(u8::MAX) {
        let exact = u32::from(first.0 as u8) * u32::from(value as u16);
        let taken = u32::from(limit.0 as u8) * 32_767;
        kani::assume(taken <= exact && exact < taken + 32_767);
    }
    Some(limit)
}
