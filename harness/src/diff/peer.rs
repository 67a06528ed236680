//! The production monitors as peers of the tables: the same ports, in the numbers of the specification.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::{Cycles, ExternalStop, InternalStop, Level, Position, Speed};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::{agreement, external, fault, gear, reference, selection, stop};
use stillpoint_spec::bind::Bound;

/// Numbers in the order of a list of names.
pub type Numbers = Vec<i64>;

/// A production monitor with its configuration, driven and observed in the numbers of its table.
pub trait Peer: Sync {
    /// Names of the inputs, as the table calls them.
    fn inputs(&self) -> &'static [&'static str];
    /// The values input `k` can have at this interface; none where every value of the table's type is possible.
    fn allowed(&self, k: usize) -> Option<&'static [i32]> {
        let _ = k;
        None
    }
    /// Names of the outputs; each is an output or a state variable of the table.
    fn outputs(&self) -> &'static [&'static str];
    /// Ranges of the cells of the state.
    fn domains(&self) -> Vec<Domain>;
    /// The initial cells; `table` gives the initial value of a table's state variable, for what is non-volatile.
    fn initial(&self, table: &dyn Fn(&str) -> i32) -> Vec<i32>;
    /// One step from and to cells, with the outputs.
    fn step(&self, cells: &mut [i32], inputs: &[i32], outputs: &mut Numbers);
}

const INTERNAL: &[i32] = &[0, 2, 3, 4, 6, 7];
const EXTERNAL: &[i32] = &[0, 2, 3, 4, 7];

fn level(ordinal: i32) -> Level {
    match ordinal {
        1 => Level::F,
        2 => Level::E,
        3 => Level::D,
        4 => Level::C,
        5 => Level::Test,
        6 => Level::B,
        7 => Level::A,
        _ => Level::None,
    }
}

fn internal(ordinal: i32) -> InternalStop {
    InternalStop::from_level(level(ordinal)).unwrap_or(InternalStop::A)
}

fn external_stop(ordinal: i32) -> ExternalStop {
    ExternalStop::from_level(level(ordinal)).unwrap_or(ExternalStop::A)
}

fn rank(level: Level) -> i64 {
    i64::from(level.rank())
}

fn cycles(cell: i32) -> Cycles {
    Cycles::new(u32::try_from(cell).unwrap_or(0))
}

fn cell(cycles: Cycles) -> i32 {
    i32::try_from(cycles.count()).unwrap_or(i32::MAX)
}

fn stage(ordinal: i32) -> selection::Stage {
    selection::Stage::from_bits(ordinal & 2 != 0, ordinal & 1 != 0)
}

fn speed(value: i32) -> Speed {
    Speed(u32::try_from(value).unwrap_or(0))
}

fn bit(b: bool) -> i64 {
    i64::from(b)
}

fn truth() -> Domain {
    Domain { lo: 0, hi: 1 }
}

fn upto(hi: i32) -> Domain {
    Domain { lo: 0, hi }
}

/// Value of a parameter of an open machine.
fn param(bound: &Bound, name: &str) -> i32 {
    let named = bound.system.params.iter().position(|p| p.var.name == name);
    named.map_or(0, |k| bound.values[k])
}

/// Names of the machines that have a monitor.
pub const MACHINES: [&str; 7] = [
    "external",
    "fault",
    "stop",
    "selection",
    "reference",
    "agreement",
    "gear",
];

/// The monitor that implements `machine` under the parameters of `bound`, with `mutant` in it if one is given.
///
/// # Errors
/// The monitor's own refusal of the parameters.
pub fn peer(
    machine: &str,
    bound: &Bound,
    mutant: Option<Mutant>,
) -> Result<Option<Box<dyn Peer>>, String> {
    let refused = |e| format!("the monitor `{machine}` refuses these parameters: {e:?}");
    let p = |name: &str| param(bound, name);
    let time = |name: &str| cycles(p(name));
    Ok(Some(match machine {
        "external" => Box::new(External {
            config: external::Config::new(
                p("enable_ext") != 0,
                p("enable_e") != 0,
                p("spl_stop_e") != 0,
            )
            .map_err(refused)?,
            next: mutant.map_or(external::next as external::Next, Mutant::external),
        }) as Box<dyn Peer>,
        "fault" => Box::new(Fault {
            config: fault::Config::new(time("t_f")).map_err(refused)?,
            t_f: p("t_f"),
            next: mutant.map_or(fault::next as fault::Next, Mutant::fault),
        }),
        "stop" => Box::new(Stop {
            config: stop::Config::new(time("t_b"), time("t_c"), time("t_d"), time("t_e"))
                .map_err(refused)?,
            longest: p("t_b").max(p("t_c")).max(p("t_d")).max(p("t_e")),
            next: mutant.map_or(stop::next as stop::Next, Mutant::stop),
        }),
        "selection" => Box::new(Selection {
            config: selection::Config::new(
                p("enable") != 0,
                time("t_vel"),
                ["limit_1", "limit_2", "limit_3", "limit_4"].map(|n| speed(p(n))),
            )
            .map_err(refused)?,
            t_vel: p("t_vel"),
            pos_max: p("pos_max"),
            next: mutant.map_or(selection::next as selection::Next, Mutant::selection),
        }),
        "reference" => Box::new(Reference {
            config: reference::Config::new(true).map_err(refused)?,
            next: mutant.map_or(reference::next as reference::Next, Mutant::reference),
        }),
        "agreement" => Box::new(Agreement {
            config: agreement::Config::new(time("t_differ"), p("se_sn_enabled") != 0)
                .map_err(refused)?,
            t_differ: p("t_differ"),
            next: mutant.map_or(agreement::next as agreement::Next, Mutant::agreement),
        }),
        "gear" => Box::new(Gear {
            config: gear::Config::new(
                u8::try_from(p("gear_max")).unwrap_or(0),
                p("se_sn_enabled") != 0,
            )
            .map_err(refused)?,
            gear_max: p("gear_max"),
            next: mutant.map_or(gear::next as gear::Next, Mutant::gear),
        }),
        _ => return Ok(None),
    }))
}

struct External {
    config: external::Config,
    next: external::Next,
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

struct Fault {
    config: fault::Config,
    t_f: i32,
    next: fault::Next,
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

struct Stop {
    config: stop::Config,
    longest: i32,
    next: stop::Next,
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

struct Selection {
    config: selection::Config,
    t_vel: i32,
    pos_max: i32,
    next: selection::Next,
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

struct Reference {
    config: reference::Config,
    next: reference::Next,
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

struct Agreement {
    config: agreement::Config,
    t_differ: i32,
    next: agreement::Next,
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

struct Gear {
    config: gear::Config,
    gear_max: i32,
    next: gear::Next,
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
