//! SBH/SG selection, referencing, user agreement and gear stage.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::{agreement, gear, reference, selection};

use super::{Numbers, Peer, bit, cell, cycles, stage, truth, upto};

pub(super) struct Selection {
    pub(super) config: selection::Config,
    pub(super) t_vel: i32,
    pub(super) pos_max: i32,
    pub(super) next: selection::Next,
}

impl Peer for Selection {
    fn inputs(&self) -> &'static [&'static str] {
        &[
            "power_on",
            "sge_sbh_sg",
            "sge_sbh",
            "sg_select",
            "sbh_internal",
            "position",
        ]
    }

    fn outputs(&self) -> &'static [&'static str] {
        &[
            "mode",
            "sga_active",
            "sga_sbh_active",
            "sga_sg",
            "monitored",
            "speed_limit",
            "reference",
        ]
    }

    fn domains(&self) -> Vec<Domain> {
        vec![
            upto(5),
            upto(3),
            upto(3),
            upto(self.t_vel),
            upto(self.pos_max),
        ]
    }

    fn initial(&self, _: &dyn Fn(&str) -> i32) -> Vec<i32> {
        vec![0; 5]
    }

    fn step(&self, cells: &mut [i32], i: &[i32], outputs: &mut Numbers) {
        use selection::Mode::{Nsb, Sbh, SbhForced, SbhPend, Sg, SgDown};
        let modes = [Nsb, Sg, SgDown, SbhPend, Sbh, SbhForced];
        let state = selection::State {
            mode: modes[cells[0].clamp(0, 5) as usize],
            stage: stage(cells[1]),
            target: stage(cells[2]),
            timer: cycles(cells[3]),
            reference: Position(cells[4]),
        };
        let inputs = selection::Inputs {
            power_on: i[0] != 0,
            sge_sbh_sg: i[1] != 0,
            sge_sbh: i[2] != 0,
            sg_select: stage(i[3]),
            sbh_internal: i[4] != 0,
            position: Position(i[5]),
        };
        let (s, o) = (self.next)(state, &self.config, &inputs);
        let mode = |m| modes.iter().position(|a| *a == m).unwrap_or(0) as i32;
        cells[0] = mode(s.mode);
        cells[1] = i32::from(s.stage.index());
        cells[2] = i32::from(s.target.index());
        cells[3] = cell(s.timer);
        cells[4] = s.reference.0;
        let monitored = match o.monitored {
            selection::Monitored::Nothing => 0,
            selection::Monitored::Speed => 1,
            selection::Monitored::Standstill => 2,
        };
        outputs.extend([
            i64::from(mode(o.mode)),
            bit(o.sga_active),
            bit(o.sga_sbh_active),
            i64::from(o.sga_sg.index()),
            monitored,
            i64::from(o.limit.0),
            i64::from(o.reference.0),
        ]);
    }
}

pub(super) struct Reference {
    pub(super) config: reference::Config,
    pub(super) next: reference::Next,
}

impl Peer for Reference {
    fn inputs(&self) -> &'static [&'static str] {
        &[
            "power_on",
            "run_up",
            "referenced",
            "reference_lost",
            "parking",
            "agreed_1",
            "agreed_2",
        ]
    }

    fn outputs(&self) -> &'static [&'static str] {
        &[
            "axis",
            "nst_reference_reached",
            "safely_referenced",
            "compare_due",
        ]
    }

    fn domains(&self) -> Vec<Domain> {
        vec![upto(3), truth()]
    }

    fn initial(&self, _: &dyn Fn(&str) -> i32) -> Vec<i32> {
        vec![0, 0]
    }

    fn step(&self, cells: &mut [i32], i: &[i32], outputs: &mut Numbers) {
        use reference::AxisState::{NotRef, Off, Ref, SafeRef};
        let all = [Off, NotRef, Ref, SafeRef];
        let state = reference::State {
            axis: all[cells[0].clamp(0, 3) as usize],
            fresh: cells[1] != 0,
        };
        let inputs = reference::Inputs {
            power_on: i[0] != 0,
            run_up: i[1] != 0,
            referenced: i[2] != 0,
            reference_lost: i[3] != 0,
            parking: i[4] != 0,
            agreed_1: i[5] != 0,
            agreed_2: i[6] != 0,
        };
        let (s, o) = (self.next)(state, &self.config, &inputs);
        let ordinal = |a| all.iter().position(|x| *x == a).unwrap_or(0) as i32;
        cells[0] = ordinal(s.axis);
        cells[1] = i32::from(s.fresh);
        outputs.extend([
            i64::from(ordinal(o.axis)),
            bit(o.nst_reference_reached),
            bit(o.safely_referenced),
            bit(o.compare_due),
        ]);
    }
}

pub(super) struct Agreement {
    pub(super) config: agreement::Config,
    pub(super) t_differ: i32,
    pub(super) next: agreement::Next,
}

impl Peer for Agreement {
    fn inputs(&self) -> &'static [&'static str] {
        &[
            "power_on",
            "set",
            "cancel",
            "key",
            "axis_ref",
            "compare_due",
            "history_ok",
            "stored",
            "gear_changed",
            "altered",
            "other_agreed",
        ]
    }

    fn outputs(&self) -> &'static [&'static str] {
        &["agreed", "code", "withdrawn", "se_active"]
    }

    fn domains(&self) -> Vec<Domain> {
        vec![truth(), upto(self.t_differ)]
    }

    fn initial(&self, table: &dyn Fn(&str) -> i32) -> Vec<i32> {
        let state = agreement::State::restored(table("agreed") != 0);
        vec![i32::from(state.agreed), cell(state.timer)]
    }

    fn step(&self, cells: &mut [i32], i: &[i32], outputs: &mut Numbers) {
        let state = agreement::State {
            agreed: cells[0] != 0,
            timer: cycles(cells[1]),
        };
        let inputs = agreement::Inputs {
            power_on: i[0] != 0,
            set: i[1] != 0,
            cancel: i[2] != 0,
            key: i[3] != 0,
            axis_ref: i[4] != 0,
            compare_due: i[5] != 0,
            history_ok: i[6] != 0,
            stored: i[7] != 0,
            gear_changed: i[8] != 0,
            altered: i[9] != 0,
            other_agreed: i[10] != 0,
        };
        let (s, o) = (self.next)(state, &self.config, &inputs);
        cells[0] = i32::from(s.agreed);
        cells[1] = cell(s.timer);
        outputs.extend([
            bit(o.agreed),
            i64::from(o.code.number()),
            bit(o.withdrawn),
            bit(o.se_active),
        ]);
    }
}

pub(super) struct Gear {
    pub(super) config: gear::Config,
    pub(super) gear_max: i32,
    pub(super) next: gear::Next,
}

impl Peer for Gear {
    fn inputs(&self) -> &'static [&'static str] {
        &["power_on", "index"]
    }

    fn outputs(&self) -> &'static [&'static str] {
        &["stage", "changed"]
    }

    fn domains(&self) -> Vec<Domain> {
        vec![upto(self.gear_max), truth()]
    }

    fn initial(&self, _: &dyn Fn(&str) -> i32) -> Vec<i32> {
        vec![0, 0]
    }

    fn step(&self, cells: &mut [i32], i: &[i32], outputs: &mut Numbers) {
        let index = |v: i32| {
            u8::try_from(v)
                .ok()
                .and_then(gear::GearIndex::new)
                .unwrap_or_default()
        };
        let state = gear::State {
            stage: index(cells[0]),
            known: cells[1] != 0,
        };
        let inputs = gear::Inputs {
            power_on: i[0] != 0,
            index: index(i[1]),
        };
        let (s, o) = (self.next)(state, &self.config, &inputs);
        cells[0] = i32::from(s.stage.get());
        cells[1] = i32::from(s.known);
        outputs.extend([i64::from(o.stage.get()), bit(o.changed)]);
    }
}
