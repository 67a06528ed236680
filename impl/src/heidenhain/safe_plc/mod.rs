//! Reference blocks for the program of a safe PLC (SPLC): a milling machine with a working space for NC axes and spindle and a
//! tool magazine behind a door of its own (HFS-GRP-002, HFS-GRP-006).
//!
//! The blocks are monitors like the others, one call for one cycle of the safe PLC: 21 ms fixed in the channel of the CC, the
//! cycle of the PLC (MP7602) in that of the MC (HFS-SPLC-003). This module wires those that make the requests of the three
//! groups, in the order of the manual: group signal of the keys, filter, groups. Doors, keylock and permissive buttons are
//! evaluated before, by [`working_space`], [`som`](crate::heidenhain::som) and [`button`](crate::heidenhain::button).
//!
//! The same program runs in both channels, each on its own inputs; what they ask for is compared by the kernel, and the
//! stricter counts ([`both_channels`](crate::heidenhain::both_channels)).

pub mod allowed_functions;
pub mod availability;
pub mod axes_logic;
pub mod control_voltage;
pub mod f_limited;
pub mod general_fields;
pub mod group_motion;
pub mod jog_increment;
pub mod key_filter;
pub mod magazine_logic;
pub mod program_check;
pub mod safe_input;
pub mod safe_output;
pub mod spindle_logic;
pub mod working_space;

use self::key_filter::Keys;
use crate::contract::Stateless;
use crate::heidenhain::types::{GroupState, Som, Unit};
use crate::kernel::{ConfigError, Cycles, DurationTooLong};
use core::num::NonZeroU32;

/// The cycle of the safe PLC in the channel of the CC, in milliseconds: fixed (HFS-SPLC-003). That in the channel of the MC is
/// the cycle of the PLC (MP7602), and the two do not run at the same clock.
pub const CC_CYCLE_MS: u32 = 21;

/// How long the axes stand before the program latch falls: 1 s (HFS-API-013), in cycles of a safe PLC of `cycle_ms`
/// milliseconds, rounded up: [`CC_CYCLE_MS`] or MP7602 (HFS-SPLC-003).
///
/// # Errors
/// [`DurationTooLong`] for a cycle of more than 4 294 967 ms, which no control has.
pub const fn one_second(cycle_ms: NonZeroU32) -> Result<Cycles, DurationTooLong> {
    match cycle_ms.checked_mul(MICROSECONDS) {
        Some(cycle) => Cycles::from_millis_up(1000, cycle),
        None => Err(DurationTooLong),
    }
}

/// Microseconds in a millisecond.
const MICROSECONDS: NonZeroU32 = match NonZeroU32::new(1000) {
    Some(thousand) => thousand,
    None => NonZeroU32::MIN,
};

/// The permissive that counts in a working space: that of the unit in use, and none while both doors are open (HFS-PB-004,
/// HFS-API-026).
pub(crate) fn permissive(unit: Unit, panel: bool, wheel: bool, both_doors_open: bool) -> bool {
    let one = if unit == Unit::Handwheel {
        wheel
    } else {
        panel
    };
    one && !both_doors_open
}

/// The position of an axis for a safety function of the program: `NN_AxPosition` in 0.0001 mm or 0.0001 degrees, reference
/// system, and none unless `NN_AxSafe` says that it is reliable (HFS-API-034).
pub const fn position(ax_safe: bool, actual: i32) -> Option<i32> {
    if ax_safe { Some(actual) } else { None }
}

fields! {
    /// The configurations of the blocks.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        axes: axes_logic::Config,
    }
}

impl Config {
    /// The parameters of [`axes_logic::Config::new`]; the other blocks have none.
    ///
    /// # Errors
    /// Those of [`axes_logic::Config::new`].
    pub fn new(t_clear: Cycles, hold: bool, manual: bool) -> Result<Self, ConfigError> {
        Ok(Self {
            axes: axes_logic::Config::new(t_clear, hold, manual)?,
        })
    }
}

fields! {
    /// The states of the blocks.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// NC axes.
        pub axes: axes_logic::State,
        /// Spindle.
        pub spindle: spindle_logic::State,
        /// Magazine.
        pub magazine: magazine_logic::State,
    }
}

impl State {
    /// As after power-up.
    pub const INITIAL: Self = Self {
        axes: axes_logic::State::INITIAL,
        spindle: spindle_logic::State::INITIAL,
        magazine: magazine_logic::State::INITIAL,
    };
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Doors, operating mode and keys, unfiltered.
        pub keys: key_filter::Inputs,
        /// The safe operating mode.
        pub som: Som,
        /// It has changed in this cycle.
        pub som_changed: bool,
        /// The PLC asks for restricted spindle operation.
        pub restricted: bool,
        /// The tool holder is open, or is about to be: no torque.
        pub holder_open: bool,
        /// `NN_AxGrpState` of the axes.
        pub axes_state: GroupState,
        /// `NN_AxGrpInMotion` of the magazine.
        pub magazine_moving: bool,
        /// `NN_GenSafe`.
        pub gen_safe: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The keys as everybody else sees them, and `PP_GenMKG`.
        pub keys: key_filter::Outputs,
        /// Requests for the NC axes.
        pub axes: axes_logic::Outputs,
        /// Requests for the spindle.
        pub spindle: spindle_logic::Outputs,
        /// Requests for the magazine.
        pub magazine: magazine_logic::Outputs,
    }
}

/// The step functions of the blocks: the production ones, or others in a test of the tests.
#[derive(Clone, Copy, Debug)]
pub struct Blocks {
    /// Filter.
    pub filter: key_filter::Next,
    /// NC axes.
    pub axes: axes_logic::Next,
    /// Spindle.
    pub spindle: spindle_logic::Next,
    /// Magazine.
    pub magazine: magazine_logic::Next,
}

impl Blocks {
    /// The production blocks.
    pub const PRODUCTION: Self = Self {
        filter: key_filter::next,
        axes: axes_logic::next,
        spindle: spindle_logic::next,
        magazine: magazine_logic::next,
    };

    /// One cycle of the program: the states after it and the outputs.
    pub fn next(&self, state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
        let raw = &inputs.keys;
        let (_, keys) = (self.filter)(Stateless, &key_filter::Config, raw);
        let (axes, for_axes) = (self.axes)(state.axes, &config.axes, &axes_inputs(inputs, &keys));
        let (spindle, for_spindle) = (self.spindle)(
            state.spindle,
            &spindle_logic::Config,
            &spindle_inputs(inputs, &keys),
        );
        let (magazine, for_magazine) = (self.magazine)(
            state.magazine,
            &magazine_logic::Config,
            &magazine_logic::Inputs {
                t_open: raw.t_open,
                permissive: keys.t_permissive,
                keys: keys.t_keys,
                confirm: raw.confirm,
                som_changed: inputs.som_changed,
                moving: inputs.magazine_moving,
                gen_safe: inputs.gen_safe,
            },
        );
        let after = State {
            axes,
            spindle,
            magazine,
        };
        let outputs = Outputs {
            keys,
            axes: for_axes,
            spindle: for_spindle,
            magazine: for_magazine,
        };
        (after, outputs)
    }
}

/// One cycle of the program with the production blocks. Each keeps its own contract; the outputs of one group depend on no
/// state of another.
pub fn next(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    Blocks::PRODUCTION.next(state, config, inputs)
}

/// What concerns the axes.
fn axes_inputs(inputs: &Inputs, keys: &key_filter::Outputs) -> axes_logic::Inputs {
    let raw = &inputs.keys;
    let start_held = either(raw.panel, raw.wheel, |k| k.nc_start);
    axes_logic::Inputs {
        door_open: raw.door_open,
        t_open: raw.t_open,
        som: inputs.som,
        som_changed: inputs.som_changed,
        unit: raw.unit,
        panel: keys.panel.permissive,
        wheel: keys.wheel.permissive,
        keys: keys.panel.axes,
        nc_start: either(keys.panel, keys.wheel, |k| k.nc_start),
        start_held,
        key_held: start_held || raw.panel.axes != 0 || raw.wheel.permissive,
        stop: keys.stop,
        state: inputs.axes_state,
        gen_safe: inputs.gen_safe,
    }
}

/// What concerns the spindle.
fn spindle_inputs(inputs: &Inputs, keys: &key_filter::Outputs) -> spindle_logic::Inputs {
    let raw = &inputs.keys;
    let start_held = either(raw.panel, raw.wheel, |k| k.spindle_start);
    let jog_held = either(raw.panel, raw.wheel, |k| k.jog);
    let nc_start = either(raw.panel, raw.wheel, |k| k.nc_start);
    spindle_logic::Inputs {
        door_open: raw.door_open,
        t_open: raw.t_open,
        som: inputs.som,
        som_changed: inputs.som_changed,
        unit: raw.unit,
        panel: keys.panel.permissive,
        wheel: keys.wheel.permissive,
        jog: either(keys.panel, keys.wheel, |k| k.jog),
        jog_held,
        spindle_start: either(keys.panel, keys.wheel, |k| k.spindle_start),
        start_held,
        key_held: start_held || jog_held || nc_start || raw.wheel.permissive,
        stop: keys.stop,
        restricted: inputs.restricted,
        holder_open: inputs.holder_open,
        gen_safe: inputs.gen_safe,
    }
}

/// Whether a key of one of the units is pressed.
fn either(panel: Keys, wheel: Keys, key: impl Fn(Keys) -> bool) -> bool {
    key(panel) || key(wheel)
}
