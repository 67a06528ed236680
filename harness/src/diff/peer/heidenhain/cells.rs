//! How the states of the monitors lie in cells.

use stillpoint_monitors::heidenhain::{
    axis_release, button, global_sto, group, judge, output_enable, som, startup, stop, switch_on,
};

use super::numbers::{self, *};
use crate::diff::peer::adapter::{Cells, cells};

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

/// The monitoring state, and a cell for each mode left in motion.
impl Cells for group::State {
    const COUNT: usize = 4;

    fn load(cells: &[i32]) -> Self {
        let cell = |k: usize| cells.get(k).copied().unwrap_or(0);
        Self {
            state: state(cell(0)),
            left: Left {
                sls_2: truthy(cell(1)),
                sls_3: truthy(cell(2)),
                sls_4: truthy(cell(3)),
            },
        }
    }

    fn store(self, cells: &mut [i32]) {
        let Left {
            sls_2,
            sls_3,
            sls_4,
        } = self.left;
        let own = [
            ordinal(&GroupState::ALL, self.state),
            i32::from(sls_2),
            i32::from(sls_3),
            i32::from(sls_4),
        ];
        for (cell, value) in cells.iter_mut().zip(own) {
            *cell = value;
        }
    }
}
