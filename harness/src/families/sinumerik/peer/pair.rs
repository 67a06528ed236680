//! Both channels of an axis against the systems composed for them.
//!
//! The monitors of a channel are not called one by one here: it is the production pair itself that steps, with machine data
//! converted as in a machine. Its state is too large for cells, so each channel's state is a number in a [`Register`].

use std::sync::Arc;

use stillpoint_monitors::kernel::{Cycles, Position};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinumerik::alarm::Alarm;
use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::compare::list::CLASSES;
use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_monitors::sinumerik::mutant as wrong;
use stillpoint_monitors::sinumerik::pair;
use stillpoint_monitors::sinumerik::parameters::{
    Configuration, ControlModule, Encoders, Installation, Parameters,
};

use super::numbers::*;
use super::register::{NUMBERS, Register, Side};
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Numbers, Params, Refusal, one_of};

/// The systems of this topic.
pub(super) fn make(system: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    let (inputs, outputs, see, show): (_, _, See, Show) = match system {
        "pair_stops" => (STOPS, STOPS_SHOWN, see_stops, show_stops),
        "pair_reference" => (REFERENCE, REFERENCE_SHOWN, see_reference, show_reference),
        _ => return Ok(None),
    };
    let gates = Gates::new(p);
    let config = pair::Config::new(configuration(p)?);
    let next = one_of(pair::next as pair::Next, wrong::pair(), mutant);
    let sides = Arc::new(Register::new());
    // What never changes has had its value before, too.
    let sge = see(&gates, &vec![0; inputs.len()]).nck.sge;
    let number = |of: axis::State| sides.number(Side::of(axis::State { sge, ..of }));
    let first = Known {
        sides: [number(axis::State::INITIAL); 2],
        kept: [[0; 3]; 2],
    };
    let step = move |cells: &mut [i32], i: &[i32], o: &mut Numbers| {
        let known = Known::load(cells);
        let [nck, drive] = [0, 1].map(|k| {
            let mut side = sides.side(known.sides[k]);
            // Only before the first cycle is there anything kept beside the number.
            if known.kept[k] != [0; 3] {
                let [agreed, stored, standstill] = known.kept[k];
                let stored = (stored != 0).then_some(Position(standstill));
                side.state = axis::State {
                    sge,
                    ..axis::State::restored(agreed != 0, stored)
                };
                // What the channel tells in its first cycle is what was kept, too.
                side.told.agreed = agreed != 0;
            }
            side
        });
        let before = pair::State {
            nck: nck.state,
            drive: drive.state,
            from_nck: nck.told,
            from_drive: drive.told,
        };
        let (after, out) = next(before, &config, &see(&gates, i));
        show(&out, o);
        let known = Known {
            sides: [
                sides.number(Side {
                    state: after.nck,
                    told: after.from_nck,
                }),
                sides.number(Side {
                    state: after.drive,
                    told: after.from_drive,
                }),
            ],
            kept: [[0; 3]; 2],
        };
        cells
            .iter_mut()
            .zip(known.cells())
            .for_each(|(cell, value)| *cell = value);
    };
    let first = first.cells().collect();
    let mut adapter = Adapter::of(inputs.to_vec(), outputs.to_vec(), domains(p), first, step);
    if system == "pair_reference" {
        for (channel, [agreed, stored, standstill]) in KEPT.into_iter().enumerate() {
            let cell = 2 + 3 * channel;
            adapter = adapter
                .kept(cell, agreed)
                .kept(cell + 1, stored)
                .kept_where(cell + 2, standstill, stored);
        }
    }
    Ok(Some(adapter))
}

/// What is kept through power-off, by channel.
const KEPT: [[&str; 3]; 2] = [
    [
        "agreement[1].agreed",
        "history[1].stored",
        "history[1].standstill",
    ],
    [
        "agreement[2].agreed",
        "history[2].stored",
        "history[2].standstill",
    ],
];

fn domains(p: &Params) -> Vec<stillpoint_model::Domain> {
    let kept = || [truth(), truth(), upto(p.value("step"))];
    let sides = [upto(NUMBERS), upto(NUMBERS)];
    [&sides[..], &kept(), &kept()].concat()
}

/// The pair in cells: the number of each channel, and what it starts with.
#[derive(Clone, Copy)]
struct Known {
    sides: [i32; 2],
    kept: [[i32; 3]; 2],
}

impl Known {
    fn load(cells: &[i32]) -> Self {
        let cell = |k: usize| cells.get(k).copied().unwrap_or(0);
        Self {
            sides: [cell(0), cell(1)],
            kept: [[cell(2), cell(3), cell(4)], [cell(5), cell(6), cell(7)]],
        }
    }

    fn cells(self) -> impl Iterator<Item = i32> {
        let kept = self.kept.into_iter().flatten();
        self.sides.into_iter().chain(kept)
    }
}

/// What may happen, by the parameters of the systems that say so.
struct Gates {
    starts: bool,
    switched: bool,
    stops: bool,
    selects: bool,
    moves: bool,
    tested: bool,
    approves: bool,
    leaves: bool,
    shifts: bool,
    gears: bool,
    step: i32,
}

impl Gates {
    fn new(p: &Params) -> Self {
        Self {
            starts: p.is("starts"),
            switched: p.is("switched"),
            stops: p.is("stops"),
            selects: p.is("selects"),
            moves: p.is("moves"),
            tested: p.is("tested"),
            approves: p.is("approves"),
            leaves: p.is("leaves"),
            shifts: p.is("shifts"),
            gears: p.is("gears") && p.value("gear_max") > 0,
            step: p.value("step"),
        }
    }
}

/// From the inputs of a system to what the channels see.
type See = fn(&Gates, &[i32]) -> pair::Inputs;

/// The outputs of both channels in the order of the names.
type Show = fn(&pair::Outputs, &mut Numbers);

const STOPS: &[&str] = &[
    "power_on",
    "reset",
    "spl_started",
    "spl_error",
    "shutdown",
    "seen[1].a",
    "seen[1].c",
    "seen[1].sbh_sg",
    "seen[1].sbh",
    "seen[1].sg2",
    "seen[1].test",
    "seen[1].away",
    "seen[1].feedback",
    "seen[2].a",
    "seen[2].c",
    "seen[2].sbh_sg",
    "seen[2].sbh",
    "seen[2].sg2",
    "seen[2].test",
    "seen[2].away",
    "seen[2].feedback",
];

fn see_stops(gates: &Gates, i: &[i32]) -> pair::Inputs {
    let channel = |i: &[i32], first: usize| {
        let c = &i[first..];
        Local {
            power_on: i[0] != 0,
            reset: i[1] != 0,
            run_up: true,
            spl_started: !gates.starts || i[2] != 0,
            spl_error: gates.starts && i[3] != 0,
            shutdown_test_select: gates.switched && i[4] != 0,
            feedback: gates.tested && c[7] != 0,
            position: Position(if gates.moves && c[6] != 0 {
                gates.step
            } else {
                0
            }),
            sge: Sge {
                stop_a_off: !gates.stops || c[0] != 0,
                stop_c_off: !gates.stops || c[1] != 0,
                sbh_sg_off: gates.selects && c[2] != 0,
                sbh_off: !gates.selects || c[3] != 0,
                sg_0: gates.selects && c[4] != 0,
                test_stop: gates.tested && c[5] != 0,
                ..Sge::UNUSED
            },
            ..Local::default()
        }
    };
    pair::Inputs {
        nck: channel(i, 5),
        drive: channel(i, 13),
    }
}

const REFERENCE: &[&str] = &[
    "power_on",
    "reset",
    "key",
    "seen[1].sbh_sg",
    "seen[1].sbh",
    "seen[1].sg2",
    "seen[1].away",
    "user[1].set",
    "user[1].cancel",
    "user[1].home",
    "user[1].lost",
    "user[1].park",
    "user[1].slid",
    "user[1].gear",
    "seen[2].sbh_sg",
    "seen[2].sbh",
    "seen[2].sg2",
    "seen[2].away",
    "user[2].set",
    "user[2].cancel",
    "user[2].home",
    "user[2].lost",
    "user[2].park",
    "user[2].slid",
    "user[2].gear",
];

fn see_reference(gates: &Gates, i: &[i32]) -> pair::Inputs {
    let channel = |i: &[i32], first: usize| {
        let c = &i[first..];
        Local {
            power_on: i[0] != 0,
            reset: i[1] != 0,
            key: i[2] != 0,
            run_up: true,
            spl_started: true,
            position: Position(if gates.moves && c[3] != 0 {
                gates.step
            } else {
                0
            }),
            set_agreement: gates.approves && c[4] != 0,
            cancel_agreement: gates.approves && c[5] != 0,
            referenced: c[6] != 0,
            reference_lost: gates.leaves && c[7] != 0,
            parking: gates.leaves && c[8] != 0,
            refpos: Position(if gates.shifts && c[9] != 0 {
                gates.step
            } else {
                0
            }),
            sge: Sge {
                sbh_sg_off: gates.selects && c[0] != 0,
                sbh_off: !gates.selects || c[1] != 0,
                sg_0: gates.selects && c[2] != 0,
                gear_0: gates.gears && c[10] != 0,
                ..Sge::UNUSED
            },
            ..Local::default()
        }
    };
    pair::Inputs {
        nck: channel(i, 3),
        drive: channel(i, 14),
    }
}

/// The outputs of a system: those of each channel, by machine and name, then those that the channels share.
macro_rules! shown {
    ($names:ident $show:ident { $($machine:literal $port:literal => $value:expr;)+ } { $($single:literal => $other:expr;)* }) => {
        const $names: &[&str] = &[
            $(concat!($machine, "[1].", $port),)+
            $(concat!($machine, "[2].", $port),)+
            $($single,)*
        ];

        fn $show(out: &pair::Outputs, numbers: &mut Numbers) {
            for channel in [&out.nck, &out.drive] {
                $(numbers.push(of(channel, $value));)+
            }
            $(numbers.push(of(out, $other));)*
        }
    };
}

/// The value of an output.
fn of<O, V: Into<i64>>(out: &O, value: fn(&O) -> V) -> i64 {
    value(out).into()
}

/// What both systems show.
macro_rules! both {
    ($names:ident $show:ident { $($more:tt)* } { $($single:tt)* }) => {
        shown! { $names $show {
            "stop" "level" => |o: &axis::Outputs| rank(o.channel.stop.level);
            "stop" "internal" => |o: &axis::Outputs| rank(o.channel.stop.internal.level());
            "stop" "phase" => |o: &axis::Outputs| o.channel.stop.phase as i32;
            "stop" "cancel_pulses" => |o: &axis::Outputs| o.channel.stop.cancel_pulses;
            "stop" "n_set_zero" => |o: &axis::Outputs| o.channel.stop.n_set_zero;
            "stop" "path_brake" => |o: &axis::Outputs| o.channel.stop.path_brake;
            "stop" "sga_stop_ab" => |o: &axis::Outputs| o.sga.stop_ab;
            "stop" "sga_stop_c" => |o: &axis::Outputs| o.sga.stop_c;
            "stop" "sga_stop_d" => |o: &axis::Outputs| o.sga.stop_d;
            "stop" "sga_stop_e" => |o: &axis::Outputs| o.sga.stop_e;
            "stop" "stopsi" => |o: &axis::Outputs| o.channel.stop.stopsi;
            "stop" "start_inhibit" => |o: &axis::Outputs| o.channel.stop.start_inhibit;
            "fault" "fault" => |o: &axis::Outputs| o.channel.fault.fault as i32;
            "fault" "bit1" => |o: &axis::Outputs| o.channel.fault.bit1;
            "fault" "interlock" => |o: &axis::Outputs| o.channel.fault.interlock;
            "selection" "mode" => |o: &axis::Outputs| o.channel.selection.mode as i32;
            "shown" "sga_active" => |o: &axis::Outputs| o.sga.sbh_sg_active;
            "shown" "sga_sbh_active" => |o: &axis::Outputs| o.sga.sbh_active;
            "shown" "sga_sg" => |o: &axis::Outputs| i64::from(o.sga.sg_active_1) * 2 + i64::from(o.sga.sg_active_0);
            "selection" "speed_limit" => |o: &axis::Outputs| o.channel.selection.limit.0;
            "selection" "reference" => |o: &axis::Outputs| o.channel.selection.reference.0;
            "threshold" "below" => |o: &axis::Outputs| o.sga.below_n_x;
            "standstill" "violated" => |o: &axis::Outputs| o.alarms.contains(Alarm::Standstill);
            "speed" "violated" => |o: &axis::Outputs| o.alarms.contains(Alarm::SpeedLimit);
            "ramp" "violated" => |o: &axis::Outputs| o.alarms.contains(Alarm::BrakingRamp);
            "compare" "discrepancy" => |o: &axis::Outputs| o.compare.discrepancy;
            "compare" "code" => |o: &axis::Outputs| o.compare.code.number();
            "compare" "suspended" => |o: &axis::Outputs| o.compare.suspended;
            "messages" "raised" => |o: &axis::Outputs| raised(o);
            "messages" "difference" => |o: &axis::Outputs| o.alarms.contains(Alarm::CrossComparison);
            "messages" "parameter" => |o: &axis::Outputs| o.alarms.code().number();
            "messages" "code" => |o: &axis::Outputs| o.code.number();
            $($more)*
        } {
            "joint.taken" => |o: &pair::Outputs| o.nck.reset_taken;
            "joint.taken" => |o: &pair::Outputs| o.drive.reset_taken;
            $($single)*
        } }
    };
}

both! { STOPS_SHOWN show_stops {
    "external" "request" => |o: &axis::Outputs| rank(o.channel.external.request.level());
    "test" "active" => |o: &axis::Outputs| o.alarms.contains(Alarm::TestStop);
    "test" "code" => |o: &axis::Outputs| o.channel.test.code.number();
    "interval" "due" => |o: &axis::Outputs| o.forced_check.due;
    "interval" "tested" => |o: &axis::Outputs| o.forced_check.tested;
} {
    "external_test.active" => |o: &pair::Outputs| o.nck.alarms.contains(Alarm::ExternalTest);
    "external_test.enable_external" => |o: &pair::Outputs| o.nck.shutdown_test.enable_external;
    "external_test.code" => |o: &pair::Outputs| o.nck.shutdown_test.code.number();
} }

both! { REFERENCE_SHOWN show_reference {
    "gear" "changed" => |o: &axis::Outputs| o.gear.changed;
    "agreement" "agreed" => |o: &axis::Outputs| o.agreement.agreed;
    "agreement" "code" => |o: &axis::Outputs| o.agreement.code.number();
    "agreement" "se_active" => |o: &axis::Outputs| o.agreement.se_active;
    "reference" "axis" => |o: &axis::Outputs| o.reference.axis as i32;
    "reference" "nst_reference_reached" => |o: &axis::Outputs| o.reference.nst_reference_reached;
    "reference" "safely_referenced" => |o: &axis::Outputs| o.sga.safely_referenced;
    "reference" "message" => |o: &axis::Outputs| o.alarms.contains(Alarm::NotSafelyReferenced);
    "messages" "beyond_limit" => |o: &axis::Outputs| o.alarms.contains(Alarm::EndStop);
    "messages" "apart" => |o: &axis::Outputs| o.alarms.contains(Alarm::StaticDifference);
} {} }

/// The stop whose alarm is raised in the cycle.
fn raised(out: &axis::Outputs) -> i64 {
    let alarms = [
        (Alarm::StopA, Level::A),
        (Alarm::StopB, Level::B),
        (Alarm::StopC, Level::C),
        (Alarm::StopD, Level::D),
        (Alarm::StopE, Level::E),
    ];
    let found = alarms.iter().find(|(alarm, _)| out.alarms.contains(*alarm));
    found.map_or(0, |(_, level)| rank(*level))
}

/// A monitoring cycle of 12 ms: one increment a cycle is 5 mm/min.
const CYCLE_US: u32 = 12_000;
const UM_PER_MINUTE: u32 = 5_000;

/// The machine data that mean what the parameters of the systems say.
fn configuration(p: &Params) -> Result<Configuration, Refusal> {
    let whole = |name: &str| u32::try_from(p.value(name)).unwrap_or(0);
    let time = |name: &str| whole(name).saturating_mul(CYCLE_US);
    let speed = |name: &str| whole(name).saturating_mul(UM_PER_MINUTE);
    let choice = |name: &str| small(p.value(name));
    let function = |enabled: bool, bit: u32| u32::from(enabled) << bit;
    let plain = Parameters {
        installation: Installation {
            encoders: Encoders::Two,
            module: ControlModule::High,
            external_path: true,
            gear_max: choice("gear_max"),
            test_interval: match u64::from(whole("interval")) {
                0 => Installation::EIGHT_HOURS,
                interval => interval * u64::from(CYCLE_US),
            },
            ..Installation::default()
        },
        function_enable: 1 | function(p.is("se"), 1) | function(p.is("enable_ext"), 6),
        standstill_tol: whole("sbh_tol"),
        velo_limit: ["limit_1", "limit_2", "limit_3", "limit_4"].map(speed),
        pos_tol: whole("pos_tol"),
        refp_pos_tol: whole("refp_tol"),
        velo_x: speed("velo_x"),
        stop_velo_tol: speed("ramp_tol"),
        mode_switch_time: time("t_chg"),
        velo_switch_delay: time("t_vel"),
        stop_switch_time_c: time("t_c"),
        stop_switch_time_d: time("t_d"),
        stop_switch_time_e: time("t_e"),
        stop_switch_time_f: time("t_f"),
        pulse_disable_delay: time("t_b"),
        pulse_dis_check_time: time("t_chk"),
        standstill_velo_tol: speed("velo_tol"),
        velo_stop_mode: choice("sg_mode"),
        velo_stop_reaction: ["reaction_1", "reaction_2", "reaction_3", "reaction_4"].map(choice),
        ..Parameters::default()
    };
    let data = if p.is("se") {
        Parameters {
            pos_limit_plus: [p.value("plus_1"); 2],
            pos_limit_minus: [p.value("minus_1"); 2],
            pos_stop_mode: choice("se_mode"),
            ..plain
        }
    } else {
        plain
    };
    let refused = Refusal::Table("the manual does not permit these machine data");
    let valid = data.validate().map_err(|_| refused)?;
    let t_differ = Cycles::new(whole("t_differ").max(1));
    Ok(valid.shortened(&CLASSES, t_differ)?)
}
