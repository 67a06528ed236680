//! The monitors of position and speed.

use stillpoint_monitors::kernel::{Distance, Position, Speed};
use stillpoint_monitors::sinumerik::selection::{Monitored, Stage};
use stillpoint_monitors::sinumerik::{
    cam, limit_switch, motion, ramp, results, speed, standstill, threshold,
};
use stillpoint_monitors::units::ModuloRange;

use crate::source::Source;

/// Any position; the enumeration takes those near 0 and the ends of the range.
fn position<S: Source>(source: &mut S, reach: u32) -> Position {
    Position(source.any_i32(reach))
}

/// Any speed; the enumeration takes low ones and the highest.
fn velocity<S: Source>(source: &mut S, reach: u32) -> Speed {
    Speed(source.any_u32(reach, u32::MAX))
}

fn monitored<S: Source>(source: &mut S) -> Monitored {
    source.any_of(&[Monitored::Nothing, Monitored::Speed, Monitored::Standstill])
}

/// Any step of the actual position.
pub fn motion<S: Source>(
    source: &mut S,
) -> Option<(motion::State, motion::Config, motion::Inputs)> {
    let known = source.any_bool();
    let state = motion::State {
        last: position(source, 3),
        known,
        speed: if known {
            Speed(source.any_u32(0, u32::MAX))
        } else {
            Speed(0)
        },
    };
    let inputs = motion::Inputs {
        power_on: source.any_bool(),
        position: position(source, 3),
        parking: source.any_bool(),
        set_anew: source.any_bool(),
    };
    Some((state, motion::Config, inputs))
}

/// Any step of the window of the operating stop.
pub fn standstill<S: Source>(
    source: &mut S,
) -> Option<(standstill::State, standstill::Config, standstill::Inputs)> {
    let tol = Distance(source.any_u32(3, standstill::Config::LARGEST.0));
    let config = standstill::Config::new(tol).ok()?;
    let inputs = standstill::Inputs {
        monitored: monitored(source),
        position: position(source, 5),
        reference: position(source, 5),
    };
    Some((standstill::State, config, inputs))
}

/// Any step of the limit of the speed.
pub fn speed<S: Source>(source: &mut S) -> Option<(speed::State, speed::Config, speed::Inputs)> {
    let stop_mode = source.any_in(0, 15) as u8;
    let mut reactions = [0; 4];
    if stop_mode == 5 {
        for reaction in &mut reactions {
            *reaction = source.any_u32(2, 14) as u8;
        }
    }
    let encoder_max = source.any_bool().then(|| velocity(source, 0));
    let setpoint = if source.any_bool() {
        100 - source.any_u32(1, 100) as u8
    } else {
        0
    };
    let config = speed::Config::new(stop_mode, reactions, encoder_max, setpoint).ok()?;
    let inputs = speed::Inputs {
        monitored: monitored(source),
        speed: velocity(source, 2),
        limit: velocity(source, 1),
        stage: source.any_of(&Stage::ALL),
        encoder_speed: velocity(source, 1),
    };
    Some((speed::State, config, inputs))
}

/// Any step of the limit switches.
pub fn limit_switch<S: Source>(
    source: &mut S,
) -> Option<(
    limit_switch::State,
    limit_switch::Config,
    limit_switch::Inputs,
)> {
    let enabled = source.any_bool();
    let plus = [position(source, 1), position(source, 1)];
    let minus = [position(source, 1), position(source, 1)];
    let stop_mode = source.any_in(1, 5) as u8;
    let config = limit_switch::Config::new(enabled, plus, minus, stop_mode).ok()?;
    let inputs = limit_switch::Inputs {
        active: source.any_bool(),
        select: source.any_bool(),
        position: position(source, 2),
    };
    Some((limit_switch::State, config, inputs))
}

/// Any step of the braking ramp.
pub fn ramp<S: Source>(source: &mut S) -> Option<(ramp::State, ramp::Config, ramp::Inputs)> {
    let config = ramp::Config::new(velocity(source, 2), velocity(source, 2)).ok()?;
    let state = ramp::State {
        lowest: velocity(source, 4),
    };
    let inputs = ramp::Inputs {
        power_on: source.any_bool(),
        on: source.any_bool(),
        speed: velocity(source, 6),
    };
    Some((state, config, inputs))
}

/// Any step of the threshold.
pub fn threshold<S: Source>(
    source: &mut S,
) -> Option<(threshold::State, threshold::Config, threshold::Inputs)> {
    let config = threshold::Config::new(velocity(source, 5)).ok()?;
    let inputs = threshold::Inputs {
        speed: velocity(source, 5),
    };
    Some((threshold::State, config, inputs))
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

/// Any step of a cam.
pub fn cam<S: Source>(source: &mut S) -> Option<(cam::State, cam::Config, cam::Inputs)> {
    let config = cam_config(source)?;
    let state = cam::State {
        own: source.any_bool(),
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = cam::Inputs {
        power_on: source.any_bool(),
        position: position(source, 5),
        other: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Eight truth values; the enumeration takes every pair for the first two, the others equal.
fn eight<S: Source>(source: &mut S) -> [bool; 8] {
    let bits = source.any_u32(3, 255);
    std::array::from_fn(|place| (bits >> place) & 1 == 1)
}

/// Any step of the result lists.
pub fn results<S: Source>(
    source: &mut S,
) -> Option<(results::State, results::Config, results::Inputs)> {
    let config = results::Config::new(eight(source), source.any_bool(), source.any_bool()).ok()?;
    let inputs = results::Inputs {
        monitored: monitored(source),
        stage: source.any_of(&Stage::ALL),
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
