//! How the states of the monitors lie in cells.

use stillpoint_monitors::heidenhain::{
    axis_release, button, global_sto, group, judge, output_enable, som, startup, stop, switch_on,
};

use super::numbers::{self, *};
use crate::diff::peer::adapter::cells;

cells! {
    stop::State, 5 {
        level = numbers::stop, |s| ordinal(&Stop::ALL, s);
        phase = phase, |p| ordinal(&Phase::ALL, p);
        timer = cycles, cell;
        brake = cycles, cell;
        wide = truthy, i32::from;
    }
    judge::State, 2 {
        modes = |c| value(&judge::Modes::ALL, c), |m| ordinal(&judge::Modes::ALL, m);
        place = |c| value(&judge::Place::ALL, c), |p| ordinal(&judge::Place::ALL, p);
    }
    group::State, 2 {
        state = state, |s| ordinal(&GroupState::ALL, s);
        left = left, bits;
    }
    startup::State, 1 {
        timer = cycles, cell;
    }
    axis_release::State, 2 {
        mode = |c| value(&axis_release::Mode::ALL, c), |m| ordinal(&axis_release::Mode::ALL, m);
        timer = cycles, cell;
    }
    som::State, 3 {
        som = |c| value(&Som::ALL, c), |s| ordinal(&Som::ALL, s);
        last = |c| value(&Som::ALL, c), |s| ordinal(&Som::ALL, s);
        refused = truthy, i32::from;
    }
    button::State, 2 {
        button = |c| value(&button::Button::ALL, c), |b| ordinal(&button::Button::ALL, b);
        timer = cycles, cell;
    }
    switch_on::State, 3 {
        voltage = |c| value(&switch_on::Voltage::ALL, c), |v| ordinal(&switch_on::Voltage::ALL, v);
        timer = cycles, cell;
        seen = truthy, i32::from;
    }
    global_sto::State, 2 {
        on = truthy, i32::from;
        timer = cycles, cell;
    }
    output_enable::State, 2 {
        enabled = truthy, i32::from;
        timer = cycles, cell;
    }
}

/// The modes left in motion from the bits of a cell.
fn left(bits: i32) -> Left {
    let has = |bit: i32| bits & (1 << bit) != 0;
    Left {
        sls_2: has(0),
        sls_3: has(1),
        sls_4: has(2),
    }
}

fn bits(left: Left) -> i32 {
    i32::from(left.sls_2) | i32::from(left.sls_3) << 1 | i32::from(left.sls_4) << 2
}
