//! The monitors of position and speed.

use stillpoint_monitors::kernel::{Distance, Position};
use stillpoint_monitors::sinumerik::{cam, results};
use stillpoint_monitors::units::ModuloRange;

use crate::draw::any;
use crate::source::Source;

/// Any position; the enumeration takes those near 0 and the ends of the range.
fn position<S: Source>(source: &mut S, reach: u32) -> Position {
    Position(source.any_i32(reach))
}

/// Any cam.
pub fn cam_config<S: Source>(source: &mut S) -> Option<cam::Config> {
    let range = if source.any_bool() {
        ModuloRange::new(position(source, 2), position(source, 2)).ok()?
    } else {
        ModuloRange::LINEAR
    };
    cam::Config::new(
        source.any_bool(),
        position(source, 1),
        Distance(source.any_u32(2, u32::MAX)),
        source.any_bool(),
        range,
        Distance(source.any_u32(1, u32::MAX)),
    )
    .ok()
}

/// Eight truth values; the enumeration takes every pair for the first two, the others equal.
fn eight<S: Source>(source: &mut S) -> [bool; 8] {
    let bits = source.any_u32(3, 255);
    std::array::from_fn(|place| (bits >> place) & 1 == 1)
}

/// Any step of the result lists. By hand, since every pattern of the cams with every other input is too many to enumerate.
pub fn results<S: Source>(
    source: &mut S,
) -> Option<(results::State, results::Config, results::Inputs)> {
    let config = results::Config::new(eight(source), source.any_bool(), source.any_bool()).ok()?;
    let inputs = results::Inputs {
        monitored: any(source),
        stage: any(source),
        speed_violated: source.any_bool(),
        standstill_upper: source.any_bool(),
        standstill_lower: source.any_bool(),
        se_watched: source.any_bool(),
        se_select: source.any_bool(),
        se_upper: source.any_bool(),
        se_lower: source.any_bool(),
        cams: eight(source),
        below: source.any_bool(),
    };
    Some((results::State, config, inputs))
}
