//! The safe PLC program.

use stillpoint_monitors::heidenhain::program_check;

use crate::source::Source;

/// Any step of the check of the program.
pub fn program_check<S: Source>(
    source: &mut S,
) -> Option<(
    program_check::State,
    program_check::Config,
    program_check::Inputs,
)> {
    let config = program_check::Config::new(source.any_bool()).ok()?;
    let state = program_check::State {
        good: source.any_bool(),
    };
    let inputs = program_check::Inputs {
        translated: source.any_bool(),
        crc_equal: source.any_bool(),
        version_equal: source.any_bool(),
    };
    Some((state, config, inputs))
}
