//! How the states of the monitors lie in cells.

use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::{
    agreement, cam, channel, compare, external, fault, forced_check, gear, history, motion,
    path_test, pulses, ramp, reference, selection, slip, stop,
};

use super::numbers::*;
use crate::diff::peer::adapter::{Cells, cells, put, take};

cells! {
    external::State, 2 {
        started = truthy, i32::from;
        spl_latched = truthy, i32::from;
    }
    fault::State, 2 {
        fault = |c| value(&FAULTS, c), |f| ordinal(&FAULTS, f);
        timer = cycles, cell;
    }
    stop::State, 5 {
        internal = internal, |s: stillpoint_monitors::sinumerik::level::InternalStop| rank(s.level()) as i32;
        external = external_stop, |s: stillpoint_monitors::sinumerik::level::ExternalStop| rank(s.level()) as i32;
        level = level, |l| rank(l) as i32;
        phase = |c| value(&STOPS, c), |p| ordinal(&STOPS, p);
        timer = cycles, cell;
    }
    selection::State, 7 {
        mode = |c| value(&MODES, c), |m| ordinal(&MODES, m);
        stage = stage, |s: selection::Stage| i32::from(s.index());
        factor = factor, |f: selection::FactorIndex| i32::from(f.get());
        target = stage, |s: selection::Stage| i32::from(s.index());
        target_factor = factor, |f: selection::FactorIndex| i32::from(f.get());
        timer = cycles, cell;
        reference = Position, position;
    }
    reference::State, 2 {
        axis = |c| value(&AXES, c), |a| ordinal(&AXES, a);
        fresh = truthy, i32::from;
    }
    agreement::State, 2 {
        agreed = truthy, i32::from;
        timer = cycles, cell;
    }
    gear::State, 2 {
        stage = |c| gear::GearIndex::new(small(c)).unwrap_or_default(), |g: gear::GearIndex| i32::from(g.get());
        known = truthy, i32::from;
    }
    motion::State, 3 {
        last = Position, position;
        known = truthy, i32::from;
        speed = speed, increments;
    }
    ramp::State, 1 {
        lowest = speed, increments;
    }
    cam::State, 1 {
        own = truthy, i32::from;
    }
    path_test::State, 3 {
        phase = |c| value(&TESTS, c), |p| ordinal(&TESTS, p);
        timer = cycles, cell;
        selected = truthy, i32::from;
    }
    pulses::State, 2 {
        phase = |c| value(&PULSES, c), |p| ordinal(&PULSES, p);
        timer = cycles, cell;
    }
    compare::State, 4 {
        item = small, i32::from;
        change_timer = cycles, cell;
        check_timer = cycles, cell;
        checking = truthy, i32::from;
    }
    slip::State, 1 {
        offset = i64::from, |offset: i64| i32::try_from(offset).unwrap_or(if offset < 0 { i32::MIN } else { i32::MAX });
    }
    history::State, 2 {
        stored = truthy, i32::from;
        standstill = Position, position;
    }
    forced_check::State, 2 {
        drive = cycles, cell;
        nck = cycles, cell;
    }
}

impl Cells for channel::State {
    const COUNT: usize = external::State::COUNT
        + motion::State::COUNT
        + path_test::State::COUNT
        + selection::State::COUNT
        + ramp::State::COUNT
        + fault::State::COUNT
        + stop::State::COUNT
        + pulses::State::COUNT;

    fn load(cells: &[i32]) -> Self {
        let mut rest = cells;
        Self {
            external: take(&mut rest),
            motion: take(&mut rest),
            test: take(&mut rest),
            selection: take(&mut rest),
            ramp: take(&mut rest),
            fault: take(&mut rest),
            stop: take(&mut rest),
            pulses: take(&mut rest),
        }
    }

    fn store(self, cells: &mut [i32]) {
        let rest = put(self.external, cells);
        let rest = put(self.motion, rest);
        let rest = put(self.test, rest);
        let rest = put(self.selection, rest);
        let rest = put(self.ramp, rest);
        let rest = put(self.fault, rest);
        let rest = put(self.stop, rest);
        put(self.pulses, rest);
    }
}
