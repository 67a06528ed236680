//! The conversion of machine data, compared with exact rational arithmetic, and its effect on the monitors.
//!
//! The formulas are the manual's, the rule of rounding is that of the monitors: limits, thresholds and tolerances of speed
//! down, delays up, intervals of repetition down, the slip tolerated up. What is enumerated and what is drawn stands at each
//! test. The drawn values are those around every kind of boundary (the exact whole increment or cycle, one step below and
//! above it, both ends of the range) and random ones, from a fixed seed.

mod positions;
mod speeds;
mod times;

use num_rational::Ratio;
use stillpoint_monitors::sinumerik::axis::Local;
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Pair};
use stillpoint_monitors::sinumerik::parameters::{Configuration, Parameters};

type Exact = Ratio<i128>;

fn exact(value: impl Into<i128>) -> Exact {
    Exact::from_integer(value.into())
}

/// The monitoring cycles that the drive holds (multiples of 31.25 us that are whole microseconds, 0.5 ms to 25 ms): all of them.
fn cycles() -> impl Iterator<Item = u32> {
    (500..=25_000).step_by(125)
}

/// The codes of the items of the comparison (lines 10514 to 11400): 1 to 3, 5 to 42, 44 to 85, 89; one is compared in a cycle.
const PASS: i128 = 3 + 38 + 42 + 1;

/// Pseudo-random numbers.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % bound
    }

    fn within(&mut self, min: u32, max: u32) -> u32 {
        min + u32::try_from(self.below(u64::from(max - min) + 1)).expect("within")
    }
}

fn axis(cycle_us: u32, rotary: bool) -> Parameters {
    Parameters {
        sysclock_cycle_time: cycle_us,
        safety_sysclock_time_ratio: 1,
        is_rot_ax: rotary,
        function_enable: 1,
        ..Parameters::default()
    }
}

fn converted(parameters: &Parameters) -> Configuration {
    parameters
        .validate()
        .unwrap_or_else(|e| panic!("{e}: {parameters:?}"))
}

/// The way of one cycle in increments at a speed in um/min or 0.001 rev/min: v * T, in mm and degrees.
fn way(thousandths: u32, cycle_us: u32, rotary: bool) -> Exact {
    let per_minute = Exact::new(thousandths.into(), 1_000);
    let minutes = Exact::new(cycle_us.into(), 60_000_000);
    let unit = if rotary { exact(360) } else { exact(1) };
    per_minute * minutes * unit * exact(1_000)
}

/// The pair of channels after power-on, with both signals "not selected".
fn pair(parameters: &Parameters) -> (Pair, Local) {
    let local = Local::idle();
    let mut pair = Pair::new(Config::new(converted(parameters)));
    let on = Local {
        power_on: true,
        ..local
    };
    let _ = pair.step(&Inputs::both(on));
    (pair, local)
}
