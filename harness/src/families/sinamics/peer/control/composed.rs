//! Monitors that do what several machines of the tables do together.

use stillpoint_monitors::kernel::{ConfigError, Cycles};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::{
    acknowledgement, acknowledgement_edge, communication, stop_arbiter,
};

use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::cells::{load, store, stored};
use crate::diff::peer::numbers::{bit, ordinal, truth, upto, value};
use crate::diff::peer::{Made, Params, Refusable, chosen};
use crate::diff::slices::Slice;

/// The systems, each with the module of its monitor.
pub(super) const SYSTEMS: &[(&str, &str)] = &[
    ("arbiter", "stop_arbiter"),
    ("drive", "acknowledgement"),
    ("supervised", "communication"),
];

/// Everything that the arbiter hears.
const ARBITER: &[&str] = &[
    "power_on", "ack", "running", "demand", "differs", "printed", "sdi_slp", "slow", "ramp",
    "window",
];

/// All inputs of each system move: they are few. A filter is explored without a time and with one.
pub(super) const SLICES: &[Slice] = &[
    Slice {
        system: "debounce",
        params: &[("t_filter", 0)],
        free: &["raw"],
    },
    Slice {
        system: "debounce",
        params: &[("t_filter", 2)],
        free: &["raw"],
    },
    Slice {
        system: "arbiter",
        params: &[],
        free: ARBITER,
    },
    // The drive is braked from outside; a time of STOP F with the hysteresis of SSM.
    Slice {
        system: "arbiter",
        params: &[("ss1e", 1), ("t_b", 3), ("t_f", 2), ("hysteresis", 1)],
        free: ARBITER,
    },
    // Each stop has a time; by itself STOP E of the system has none.
    Slice {
        system: "arbiter",
        params: &[("t_e", 2)],
        free: ARBITER,
    },
    // Everything at once.
    Slice {
        system: "arbiter",
        params: &[("t_b", 0), ("t_c", 0), ("t_d", 0), ("t_e", 0), ("t_f", 0)],
        free: ARBITER,
    },
    Slice {
        system: "drive",
        params: &[],
        free: &[
            "power_on",
            "by_fdi",
            "by_telegram",
            "selected",
            "cause_1",
            "cause_2",
        ],
    },
    Slice {
        system: "supervised",
        params: &[],
        free: &["power_on", "ack", "arrived", "disturbed", "low_code"],
    },
];

/// The monitor of a system.
pub(super) fn make(system: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match system {
        "arbiter" => arbiter(p, mutant)?,
        "drive" => drive(mutant),
        "supervised" => supervised(p, mutant)?,
        _ => return Ok(None),
    }))
}

/// The arbiter and STOP F beside it. SAM, SBR and the window of SOS are monitors of their own, which act while the arbiter asks for
/// them; a cause that persists asks again.
fn arbiter(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let [b, c, d, e, f] = ["t_b", "t_c", "t_d", "t_e", "t_f"].map(|name| p.time(name));
    let config = stop_arbiter::Config::new(b, c, d, e, f, p.is("ss1e"), p.is("hysteresis"))?;
    let external = p.is("ss1e");
    let next = chosen::<stop_arbiter::Monitor>(mutant);
    let longest = ["t_b", "t_c", "t_d", "t_e"].map(|name| p.value(name));
    let longest = longest.into_iter().fold(0, i32::max);
    Ok(Adapter::of(
        ARBITER.to_vec(),
        vec![
            "arb.stop",
            "arb.phase",
            "arb.timer",
            "arb.pulses_off",
            "arb.brake",
            "arb.inhibited",
            "arb.sos",
            "arb.esr",
            "arb.initiated",
            "arb.blocks",
            "f.latched",
        ],
        vec![
            upto(6),
            upto(4),
            upto(longest),
            truth(),
            upto(p.value("t_f")),
        ],
        stored(stop_arbiter::State::INITIAL),
        move |cells, i, o| {
            let state: stop_arbiter::State = load(cells);
            let power_on = i[0] != 0;
            let (ramp, window) = (i[8] != 0, i[9] != 0);
            let braking = match state.stop {
                Stop::C => true,
                Stop::B => !external,
                _ => false,
            };
            let watched = match state.phase {
                stop_arbiter::Phase::Running if ramp && braking && !power_on => Stop::A,
                stop_arbiter::Phase::Holding if window && !power_on => Stop::B,
                _ => Stop::None,
            };
            let request = watched.max(value(&Stop::ALL, i[3]));
            let function = match i[2] {
                0 if i[5] != 0 || i[6] != 0 => Function::Watching,
                0 => Function::None,
                1 => Function::Ss2e,
                2 => Function::Sos,
                3 => Function::Ss2,
                4 => Function::Ss1,
                _ => Function::Sto,
            };
            let inputs = stop_arbiter::Inputs {
                power_on,
                request,
                remaining: request,
                difference: i[4] != 0,
                function,
                standstill: i[7] != 0,
                acknowledge: i[1] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            store(after, cells);
            o.extend([
                i64::from(ordinal(&Stop::ALL, out.stop)),
                i64::from(ordinal(&stop_arbiter::Phase::ALL, after.phase)),
                i64::from(after.timer.count()),
                bit(out.pulses_off),
                bit(out.off3),
                bit(out.setpoint_zero),
                bit(out.sos),
                bit(out.esr),
                i64::from(ordinal(&Stop::ALL, out.initiated)),
                bit(out.blocks_run),
                bit(out.fault),
            ]);
        },
    ))
}

/// The acknowledgement of a drive with any p9601 and p9507.0, and the edge of a selection that is deselected.
fn drive(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<acknowledgement::Monitor>(mutant);
    let edge = chosen::<acknowledgement_edge::Monitor>(None);
    let initial = [
        vec![0, 0],
        stored(acknowledgement_edge::State::INITIAL),
        stored(acknowledgement::State::INITIAL),
    ];
    Adapter::of(
        vec![
            "power_on",
            "by_fdi",
            "by_telegram",
            "selected",
            "cause_1",
            "cause_2",
        ],
        vec![
            "extended.edge",
            "configured.ack",
            "event.internal_event",
            "event.r9722_7",
            "event.s_zsw_7",
            "event.s_zsw1b_7",
        ],
        vec![upto(3), truth(), upto(2), truth(), upto(2)],
        initial.concat(),
        move |cells, i, o| {
            let power_on = i[0] != 0;
            let selection = acknowledgement_edge::Inputs {
                power_on,
                valid: true,
                stable: true,
                level: i[3] != 0,
            };
            let before = load(&cells[2..3]);
            let (selected, fallen) = edge(before, &acknowledgement_edge::Config, &selection);
            // By F-DI, by PROFIsafe, without selection, without selection but with the terminals.
            let config = acknowledgement::Config::new(
                cells[0] == 0,
                cells[0] == 1,
                cells[0] != 2 && cells[1] != 0,
            );
            // The first cause is over with its message, the second one lasts.
            let inputs = acknowledgement::Inputs {
                power_on,
                input_edge: i[1] != 0,
                profisafe_edge: i[2] != 0,
                reselected: fallen.acknowledge,
                message: i[4] != 0 || i[5] != 0,
                cause: i[5] != 0,
                ..acknowledgement::Inputs::default()
            };
            let (after, out) = next(load(&cells[3..]), &config, &inputs);
            store(selected, &mut cells[2..3]);
            store(after, &mut cells[3..]);
            o.extend([
                i64::from(cells[2]),
                bit(out.acknowledge),
                bit(out.event),
                bit(out.no_event),
                bit(out.event),
                bit(out.event),
            ]);
        },
    )
    .kept(0, "configured.control")
    .kept(1, "configured.extended")
}

/// The supervision of a path and the reaction to its failure, with or without ESR.
fn supervised(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let (watchdog, esr) = (p.time("t_wd"), p.time("t_esr"));
    let config = move |cells: &[i32]| {
        let esr = if cells[2] == 0 { Cycles::ZERO } else { esr };
        communication::Config::new(watchdog, esr, cells[0] != 0, cells[1] != 0)
    };
    config(&[0; 3])?;
    let next = chosen::<communication::Monitor>(mutant);
    Ok(Adapter::of(
        vec!["power_on", "ack", "arrived", "disturbed", "low_code"],
        vec![
            "link.valid",
            "link.age",
            "link.failed",
            "failure.demand",
            "failure.retract",
        ],
        vec![
            truth(),
            truth(),
            truth(),
            upto(3),
            upto(p.value("t_wd")),
            upto(p.value("t_esr")),
        ],
        [vec![0; 3], stored(communication::State::INITIAL)].concat(),
        move |cells, i, o| {
            let Ok::<_, ConfigError>(config) = config(cells) else {
                return;
            };
            let inputs = communication::Inputs {
                power_on: i[0] != 0,
                telegram: i[2] != 0,
                disturbed: i[3] != 0,
                undelayed: i[4] != 0,
                acknowledge: i[1] != 0,
            };
            let (after, out) = next(load(&cells[3..]), &config, &inputs);
            store(after, &mut cells[3..]);
            let age = watchdog.count().saturating_sub(after.watch.count());
            o.extend([
                bit(out.valid),
                i64::from(age),
                bit(out.fault),
                i64::from(ordinal(&Stop::ALL, out.request)),
                bit(out.esr),
            ]);
        },
    )
    .kept(0, "path.profisafe")
    .kept(1, "failure.stop_b")
    .kept(2, "failure.esr"))
}
