//! What concerns the whole machine: modes, permissives, control voltage, outputs.

use stillpoint_monitors::heidenhain::types::{Som, Stop};
use stillpoint_monitors::heidenhain::{button, output_enable, som, switch_on};
use stillpoint_monitors::kernel::Cycles;

use crate::source::Source;

/// Any step of the selection of the mode.
pub fn som<S: Source>(source: &mut S) -> Option<(som::State, som::Config, som::Inputs)> {
    let config = som::Config::new(source.any_bool()).ok()?;
    let state = som::State {
        som: source.any_of(&Som::ALL),
        last: source.any_of(&Som::ALL),
        refused: source.any_bool(),
    };
    let inputs = som::Inputs {
        power_on: source.any_bool(),
        key_2: source.any_bool(),
        key_3: source.any_bool(),
        key_4: source.any_bool(),
        deselected: source.any_bool(),
    };
    state.invariant(&config).then_some((state, config, inputs))
}

/// Any step of a permissive.
pub fn button<S: Source>(
    source: &mut S,
) -> Option<(button::State, button::Config, button::Inputs)> {
    use button::Button;
    let config = button::Config::new(source.any_delay(button::Config::LONGEST)).ok()?;
    let button = source.any_of(&Button::ALL);
    let timer = if button == Button::Valid {
        source.any_cycles(config.t_max())
    } else {
        Cycles::ZERO
    };
    let state = button::State { button, timer };
    let inputs = button::Inputs {
        power_on: source.any_bool(),
        contact_a: source.any_bool(),
        contact_b: source.any_bool(),
        unit_changes: source.any_bool(),
    };
    state.invariant(&config).then_some((state, config, inputs))
}

/// Any step of the control voltage.
pub fn switch_on<S: Source>(
    source: &mut S,
) -> Option<(switch_on::State, switch_on::Config, switch_on::Inputs)> {
    use switch_on::Voltage;
    let config = switch_on::Config::new(source.any_delay(switch_on::Config::LONGEST)).ok()?;
    let voltage = source.any_of(&Voltage::ALL);
    let timer = if voltage == Voltage::ChainCheck {
        source.any_cycles(config.t_chain())
    } else {
        Cycles::ZERO
    };
    let state = switch_on::State {
        voltage,
        timer,
        seen: source.any_bool(),
    };
    let inputs = switch_on::Inputs {
        cvo: source.any_bool(),
        chain: source.any_bool(),
        t_brk: source.any_bool(),
        dropped: source.any_bool(),
        may_on: source.any_bool(),
        testing: source.any_bool(),
        spindle_rests: source.any_bool(),
    };
    state.invariant(&config).then_some((state, config, inputs))
}

/// Any step of the permission of the outputs.
pub fn output_enable<S: Source>(
    source: &mut S,
) -> Option<(
    output_enable::State,
    output_enable::Config,
    output_enable::Inputs,
)> {
    let config =
        output_enable::Config::new(source.any_delay(output_enable::Config::LONGEST)).ok()?;
    let enabled = source.any_bool();
    let timer = if enabled {
        source.any_cycles(config.t_off())
    } else {
        Cycles::ZERO
    };
    let inputs = output_enable::Inputs {
        ready: source.any_bool(),
        stop: source.any_of(&Stop::ALL),
        emergency: source.any_bool(),
        still: source.any_bool(),
    };
    Some((output_enable::State { enabled, timer }, config, inputs))
}
