//! Rules between the machine data of one axis (alarm 27033 and the run-up checks of the drive).

use super::{CAMS, ControlModule, Encoders, Function, ParameterError, Parameters, Rule};

/// The first rule that the machine data break. Ranges have been checked before.
pub(super) fn check(p: &Parameters) -> Result<(), ParameterError> {
    cycle(p)?;
    functions(p)?;
    limits(p)?;
    cams(p)?;
    hardware(p)
}

fn require(
    holds: bool,
    number: u32,
    index: usize,
    value: i64,
    rule: Rule,
) -> Result<(), ParameterError> {
    if holds {
        Ok(())
    } else {
        Err(ParameterError::Implausible {
            number,
            index,
            value,
            rule,
        })
    }
}

fn cycle(p: &Parameters) -> Result<(), ParameterError> {
    let cycle = p.monitoring_cycle_us();
    let ratio = i64::from(p.safety_sysclock_time_ratio);
    require(cycle <= 25_000, 10090, 0, ratio, Rule::CycleTooLong)?;
    require(
        // No panic for a divisor of zero, which the range excludes.
        p.safety_sysclock_time_ratio
            .checked_rem(p.posctrl_sysclock_time_ratio)
            == Some(0),
        10090,
        0,
        ratio,
        Rule::CycleNoMultiple,
    )?;
    // 31.25 us are 125 / 4 us.
    let held = cycle >= 500 && (4 * cycle) % 125 == 0;
    require(held, 10090, 0, ratio, Rule::CycleNotInDrive)
}

fn functions(p: &Parameters) -> Result<(), ParameterError> {
    let word = p.function_enable;
    let check = |holds, rule| require(holds, 36901, 0, i64::from(word), rule);
    let enabled = |function| p.enabled(function);
    check(word & 0b100 == 0, Rule::ReservedBit)?;
    check(word == 0 || enabled(Function::SbhSg), Rule::WithoutSbhSg)?;
    check(
        !enabled(Function::StopE) || enabled(Function::ExternalStops),
        Rule::StopEWithoutExternalStops,
    )?;
    check(
        p.spl_stop_mode != 4
            || word == 0
            || (enabled(Function::StopE) && enabled(Function::ExternalStops)),
        Rule::SplStopENotEnabled,
    )?;
    check(
        !(enabled(Function::SlipSync) && p.se_sn_enabled()),
        Rule::SlipWithPosition,
    )?;
    check(
        !enabled(Function::SlipSync) || p.installation.encoders == Encoders::Two,
        Rule::SlipWithOneEncoder,
    )?;
    check(
        !enabled(Function::CamSync) || word & CAMS != 0,
        Rule::CamSyncWithoutCam,
    )
}

fn limits(p: &Parameters) -> Result<(), ParameterError> {
    for (index, (plus, minus)) in p.pos_limit_plus.iter().zip(&p.pos_limit_minus).enumerate() {
        require(
            plus > minus,
            36934,
            index,
            i64::from(*plus),
            Rule::LimitsInterchanged,
        )?;
    }
    Ok(())
}

fn cams(p: &Parameters) -> Result<(), ParameterError> {
    require(
        p.modulo_range % 360_000 == 0,
        36905,
        0,
        i64::from(p.modulo_range),
        Rule::ModuloNoMultiple,
    )?;
    let range = p.modulo_range()?;
    if !range.folds() {
        return Ok(());
    }
    let (lower, upper) = (range.lower().0, range.upper().0);
    let tolerance = i64::from(p.pos_tol);
    let hysteresis = if p.enabled(Function::CamSync) {
        i64::from(p.cam_tol)
    } else {
        0
    };
    for cam in (0..8).filter(|cam| p.cam_enabled(*cam)) {
        let position = i64::from(p.cam_position(cam));
        let number = if cam % 2 == 0 { 36936 } else { 36937 };
        require(
            // The lower modulo value is the last position before the range, as the worked example has it (S840D-SN-010).
            i64::from(lower) - 1 + tolerance <= position
                && position < i64::from(upper) - tolerance - hysteresis,
            number,
            usize::from(cam / 2),
            position,
            Rule::CamOutsideModulo,
        )?;
    }
    Ok(())
}

fn hardware(p: &Parameters) -> Result<(), ParameterError> {
    let high = p.installation.module == ControlModule::High;
    require(
        high || p.enc_freq_limit <= 300_000,
        36926,
        0,
        i64::from(p.enc_freq_limit),
        Rule::FrequencyTooHigh,
    )?;
    let internal = p.installation.internal_cancellation;
    let bit_30 = 0x4000_0000;
    require(
        !internal || high,
        36986,
        0,
        bit_30,
        Rule::InternalNotAvailable,
    )?;
    require(
        !internal || p.installation.external_path,
        36986,
        0,
        bit_30,
        Rule::InternalWithoutExternal,
    )
}
