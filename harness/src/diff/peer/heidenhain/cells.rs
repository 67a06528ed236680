//! How the states of the monitors lie in cells.

use stillpoint_monitors::heidenhain::{
    axis_release, button, group, judge, output_enable, som, startup, stop, switch_on,
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
        both = truthy, i32::from;
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
    output_enable::State, 2 {
        enabled = truthy, i32::from;
        timer = cycles, cell;
    }
}
