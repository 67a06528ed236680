//! External stops, STOP F and the arbitration of stops.

use stillpoint_model::Domain;
use stillpoint_monitors::{external, fault, stop};

use super::{
    EXTERNAL, INTERNAL, Numbers, Peer, bit, cell, cycles, external_stop, internal, level, rank,
    truth, upto,
};

pub(super) struct External {
    pub(super) config: external::Config,
    pub(super) next: external::Next,
}

impl Peer for External {
    fn inputs(&self) -> &'static [&'static str] {
        &[
            "power_on",
            "reset",
            "spl_started",
            "sge_a",
            "sge_c",
            "sge_d",
            "sge_e",
            "spl_error",
        ]
    }

    fn outputs(&self) -> &'static [&'static str] {
        &["request", "selected", "spl_stop"]
    }

    fn domains(&self) -> Vec<Domain> {
        vec![truth(), truth()]
    }

    fn initial(&self, _: &dyn Fn(&str) -> i32) -> Vec<i32> {
        let s = external::State::INITIAL;
        vec![i32::from(s.started), i32::from(s.spl_latched)]
    }

    fn step(&self, cells: &mut [i32], i: &[i32], outputs: &mut Numbers) {
        let state = external::State {
            started: cells[0] != 0,
            spl_latched: cells[1] != 0,
        };
        let inputs = external::Inputs {
            power_on: i[0] != 0,
            reset: i[1] != 0,
            spl_started: i[2] != 0,
            sge_a: i[3] != 0,
            sge_c: i[4] != 0,
            sge_d: i[5] != 0,
            sge_e: i[6] != 0,
            spl_error: i[7] != 0,
        };
        let (s, o) = (self.next)(state, &self.config, &inputs);
        cells[0] = i32::from(s.started);
        cells[1] = i32::from(s.spl_latched);
        outputs.extend([
            rank(o.request.level()),
            rank(o.selected.level()),
            bit(o.spl_stop),
        ]);
    }
}

pub(super) struct Fault {
    pub(super) config: fault::Config,
    pub(super) t_f: i32,
    pub(super) next: fault::Next,
}

impl Peer for Fault {
    fn inputs(&self) -> &'static [&'static str] {
        &[
            "power_on",
            "reset",
            "discrepancy",
            "rx_fault",
            "monitoring",
            "cde_before",
            "ab_before",
        ]
    }

    fn outputs(&self) -> &'static [&'static str] {
        &["fault", "alarm", "stop_b", "bit1", "interlock"]
    }

    fn domains(&self) -> Vec<Domain> {
        vec![upto(3), upto(self.t_f)]
    }

    fn initial(&self, _: &dyn Fn(&str) -> i32) -> Vec<i32> {
        vec![0, 0]
    }

    fn step(&self, cells: &mut [i32], i: &[i32], outputs: &mut Numbers) {
        use fault::FaultState::{Delay, Expired, Latched, None};
        let all = [None, Latched, Delay, Expired];
        let state = fault::State {
            fault: all[cells[0].clamp(0, 3) as usize],
            timer: cycles(cells[1]),
        };
        let inputs = fault::Inputs {
            power_on: i[0] != 0,
            reset: i[1] != 0,
            discrepancy: i[2] != 0,
            rx_fault: i[3] != 0,
            monitoring: i[4] != 0,
            cde_before: i[5] != 0,
            ab_before: i[6] != 0,
        };
        let (s, o) = (self.next)(state, &self.config, &inputs);
        let ordinal = |f| all.iter().position(|a| *a == f).unwrap_or(0) as i32;
        cells[0] = ordinal(s.fault);
        cells[1] = cell(s.timer);
        outputs.extend([
            i64::from(ordinal(o.fault)),
            bit(o.alarm),
            bit(o.stop_b),
            bit(o.bit1),
            bit(o.interlock),
        ]);
    }
}

pub(super) struct Stop {
    pub(super) config: stop::Config,
    pub(super) longest: i32,
    pub(super) next: stop::Next,
}

impl Peer for Stop {
    fn inputs(&self) -> &'static [&'static str] {
        &[
            "power_on",
            "reset",
            "demand",
            "f_stop_b",
            "rx_internal",
            "external",
            "rx_external",
            "test",
            "standstill",
        ]
    }

    fn allowed(&self, k: usize) -> Option<&'static [i32]> {
        match k {
            2 | 4 => Some(INTERNAL),
            5 | 6 => Some(EXTERNAL),
            _ => None,
        }
    }

    fn outputs(&self) -> &'static [&'static str] {
        &[
            "level",
            "internal",
            "phase",
            "cancel_pulses",
            "n_set_zero",
            "path_brake",
            "esr",
            "sbh_internal",
            "sga_stop_ab",
            "sga_stop_c",
            "sga_stop_d",
            "sga_stop_e",
            "sbr_on",
            "sequence_over",
            "start_inhibit",
            "stopsi",
        ]
    }

    fn domains(&self) -> Vec<Domain> {
        vec![upto(7), upto(7), upto(7), upto(5), upto(self.longest)]
    }

    fn initial(&self, _: &dyn Fn(&str) -> i32) -> Vec<i32> {
        vec![0; 5]
    }

    fn step(&self, cells: &mut [i32], i: &[i32], outputs: &mut Numbers) {
        use stop::Phase::{BBraking, Braking, Idle, PulsesOff, SbhInt, Testing};
        let phases = [Idle, Braking, SbhInt, BBraking, PulsesOff, Testing];
        let state = stop::State {
            internal: internal(cells[0]),
            external: external_stop(cells[1]),
            level: level(cells[2]),
            phase: phases[cells[3].clamp(0, 5) as usize],
            timer: cycles(cells[4]),
        };
        let inputs = stop::Inputs {
            power_on: i[0] != 0,
            reset: i[1] != 0,
            demand: internal(i[2]),
            f_stop_b: i[3] != 0,
            rx_internal: internal(i[4]),
            external: external_stop(i[5]),
            rx_external: external_stop(i[6]),
            test: i[7] != 0,
            standstill: i[8] != 0,
        };
        let (s, o) = (self.next)(state, &self.config, &inputs);
        let phase = |p| phases.iter().position(|a| *a == p).unwrap_or(0) as i32;
        cells[0] = rank(s.internal.level()) as i32;
        cells[1] = rank(s.external.level()) as i32;
        cells[2] = rank(s.level) as i32;
        cells[3] = phase(s.phase);
        cells[4] = cell(s.timer);
        outputs.extend([
            rank(o.level),
            rank(o.internal.level()),
            i64::from(phase(o.phase)),
            bit(o.cancel_pulses),
            bit(o.n_set_zero),
            bit(o.path_brake),
            bit(o.esr),
            bit(o.sbh_internal),
            bit(o.sga_stop_ab),
            bit(o.sga_stop_c),
            bit(o.sga_stop_d),
            bit(o.sga_stop_e),
            bit(o.sbr_on),
            bit(o.ended),
            bit(o.start_inhibit),
            i64::from(o.stopsi),
        ]);
    }
}
