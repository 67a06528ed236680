//! The tables of one axis in a replay: system `axis_core` for each channel, in increments and cycles of the machine.

use std::collections::BTreeMap;
use std::path::Path;

use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_machine::Machine;
use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::channel;
use stillpoint_monitors::sinumerik::pair::{Inputs, Outputs, State};

use super::production::Produced;
use super::rig::side_of;
use crate::diff::peer::{self, Peer};
use crate::diff::product::{Product, Work};
use crate::recording::Value;

/// The tables count positions from 0: this one is their 0 increments.
const SHIFT: i64 = 500_000_000;
/// The greatest position of the tables.
const POS_MAX: i64 = 1_000_000_000;

/// The system of an axis with its parameters, and the monitor's side of the pairing, which names its ports.
pub(super) struct Basis {
    bound: Bound,
    peer: Box<dyn Peer>,
}

impl Basis {
    /// For the axis in place `k`; none if no run of it has such a system.
    ///
    /// # Errors
    /// A sentence: the parameters do not fit the tables.
    pub(super) fn new(
        machine: &Machine,
        k: usize,
        produced: &Produced,
    ) -> Result<Option<Self>, String> {
        let axis = &machine.axes[k].name;
        let mut runs = machine.runs.iter();
        let Some(run) = runs.find(|r| r.system == "axis_core" && r.axes.contains(axis)) else {
            return Ok(None);
        };
        let at = |e: String| format!("axis {axis}: {e}");
        let bound = bound(&run.file, produced).map_err(at)?;
        let peer = peer::peer("axis_core", &bound, None).map_err(at)?;
        Ok(peer.map(|peer| Self { bound, peer }))
    }
}

/// The tables of both channels.
pub(super) struct Tables<'a> {
    basis: Option<(&'a Bound, Product<'a>, Work)>,
    configuration: channel::Config,
    channels: [Channel; 2],
    cycles: u64,
}

/// The table of one channel.
#[derive(Default)]
struct Channel {
    /// Its state, while it steps with the channel.
    cells: Option<Vec<i32>>,
    /// What it says in this cycle, by name.
    said: BTreeMap<&'static str, i64>,
}

impl<'a> Tables<'a> {
    /// Tables at rest; none step without a system.
    ///
    /// # Errors
    /// A sentence: tables and monitors do not fit each other.
    pub(super) fn new(basis: Option<&'a Basis>, produced: &Produced) -> Result<Self, String> {
        let basis = match basis {
            Some(Basis { bound, peer }) => {
                let product = Product::new(bound, peer.as_ref())?;
                let work = product.new_work();
                Some((bound, product, work))
            }
            None => None,
        };
        Ok(Self {
            basis,
            configuration: *produced.configuration.channel(),
            channels: [Channel::default(), Channel::default()],
            cycles: 0,
        })
    }

    /// Cycles of both channels in which a table has stepped.
    pub(super) const fn cycles(&self) -> u64 {
        self.cycles
    }

    /// One cycle of both channels: the states of the monitors before and after it, what they saw and said.
    pub(super) fn step(
        &mut self,
        before: &State,
        after: &State,
        inputs: &Inputs,
        outputs: &Outputs,
    ) {
        let Some((bound, product, work)) = &mut self.basis else {
            return;
        };
        for (side, channel) in self.channels.iter_mut().enumerate() {
            let (local, own) = side_of(inputs, outputs, side);
            let (told, state) = match side {
                0 => (&before.from_drive, &after.nck.channel),
                _ => (&before.from_nck, &after.drive.channel),
            };
            let fed = feed(local, own, told);
            channel.said.clear();
            if !applies(local) {
                channel.cells = None;
                continue;
            }
            let fresh = channel.cells.is_none();
            if fresh && !starts(&self.configuration, local, &fed, state) {
                continue;
            }
            let mut cells = channel
                .cells
                .take()
                .unwrap_or_else(|| product.start(&mut |_| 0));
            let power_on = fresh || local.power_on;
            work.set_inputs(&numbers(bound, &fed, power_on));
            if product.step(work, &mut cells).is_ok() {
                channel.said = product.said(work).collect();
                channel.cells = Some(cells);
                self.cycles += 1;
            }
        }
    }

    /// What the table of a channel says in this cycle to a signal of the recording; none where it says nothing to it.
    pub(super) fn output(&self, side: usize, signal: &str) -> Option<Value> {
        let said = &self.channels[side].said;
        let get = |name: &str| said.get(name).copied();
        let flag = |name: &str| get(name).map(|v| Value::Bool(v != 0));
        let name = |list: &[&'static str], name: &str| {
            let k = usize::try_from(get(name)?).ok()?;
            list.get(k).map(|text| Value::Text((*text).into()))
        };
        match signal {
            "stop" => match (get("stop.level")?, get("fault.fault")?) {
                (0, 1..) => Some(Value::Text("F".into())),
                _ => name(&LEVELS, "stop.level"),
            },
            "stop_internal" => name(&LEVELS, "stop.internal"),
            "stop_phase" => name(&PHASES, "stop.phase"),
            "mode" => name(&MODES, "selection.mode"),
            "SGA_STOP_AB" => flag("stop.sga_stop_ab"),
            "SGA_STOP_C" => flag("stop.sga_stop_c"),
            "SGA_STOP_D" => flag("stop.sga_stop_d"),
            "SGA_STOP_E" => flag("stop.sga_stop_e"),
            "SGA_SVSS_STATUS" => flag("selection.sga_active"),
            "SGA_SS_STATUS" => flag("selection.sga_sbh_active"),
            "SGA_VELO_X" => flag("threshold.below"),
            "SGA_VELO_STATUS_0" => get("selection.sga_sg").map(|v| Value::Bool(v & 1 != 0)),
            "SGA_VELO_STATUS_1" => get("selection.sga_sg").map(|v| Value::Bool(v & 2 != 0)),
            "Safety.SLS.Limit" => get("selection.speed_limit").map(Value::Int),
            "standstill_reference" => {
                let reference = get("selection.reference")?;
                // Where nothing is monitored both sides say 0, which is not shifted.
                let monitored = get("selection.monitored")? == 2;
                Some(Value::Int(if monitored { reference - SHIFT } else { 0 }))
            }
            _ => None,
        }
    }
}

/// The names of the recording in the order of the tables' enumerations.
const LEVELS: [&str; 8] = ["NONE", "F", "E", "D", "C", "TEST", "B", "A"];
const PHASES: [&str; 6] = [
    "IDLE",
    "BRAKING",
    "SBH_INT",
    "B_BRAKING",
    "PULSES_OFF",
    "TESTING",
];
const MODES: [&str; 6] = ["NSB", "SG", "SG_DOWN", "SBH_PEND", "SBH", "SBH_FORCED"];

/// Whether the system describes what a channel does in this cycle. It leaves out the time before run-up, parking, errors of
/// the safe logic and the test of the external shutdown, and positions far away.
fn applies(local: &Local) -> bool {
    let position = i64::from(local.position.0) + SHIFT;
    local.run_up
        && local.spl_started
        && !local.spl_error
        && !local.parking
        && !local.shutdown_test_select
        && (0..=POS_MAX).contains(&position)
}

/// Whether the table can begin here: the channel is in the state in which power-on in this cycle would leave it.
fn starts(
    config: &channel::Config,
    local: &Local,
    fed: &channel::Inputs,
    after: &channel::State,
) -> bool {
    if local.power_on {
        return true;
    }
    let inputs = channel::Inputs {
        power_on: true,
        ..*fed
    };
    channel::next(channel::State::INITIAL, config, &inputs).0 == *after
}

/// What a channel of the monitors got in this cycle.
fn feed(local: &Local, out: &axis::Outputs, told: &axis::Exchange) -> channel::Inputs {
    let sge = &local.sge;
    // What a test of the shutdown paths has found is no finding of the comparison.
    let compared = !out.compare.code.is_none() || out.agreement.code.number() != 0;
    channel::Inputs {
        power_on: local.power_on,
        run_up: local.run_up,
        reset: out.reset_taken,
        spl_started: local.spl_started,
        spl_error: local.spl_error,
        sge_a: sge.stop_a_off,
        sge_c: sge.stop_c_off,
        sge_d: sge.stop_d_off,
        sge_e: sge.stop_e_off,
        sge_sbh_sg: sge.sbh_sg_off,
        sge_sbh: sge.sbh_off,
        sg_select: stillpoint_monitors::sinumerik::selection::Stage::from_bits(sge.sg_1, sge.sg_0),
        over: stillpoint_monitors::sinumerik::selection::FactorIndex::from_bits(
            sge.override_3,
            sge.override_2,
            sge.override_1,
            sge.override_0,
        ),
        se_active: out.agreement.se_active,
        se_select: sge.se,
        position: local.position,
        encoder_speed: local.encoder_speed,
        parking: local.parking,
        set_anew: out.reference.compare_due,
        test_select: sge.test_stop,
        feedback: local.feedback,
        discrepancy: compared,
        rx_fault: told.fault,
        rx_internal: told.internal,
        rx_external: told.external,
        ..channel::Inputs::default()
    }
}

/// The inputs as numbers, in the order of the table.
fn numbers(bound: &Bound, fed: &channel::Inputs, power_on: bool) -> Vec<i32> {
    let value = |name: &str| -> i32 {
        match name {
            "power_on" => i32::from(power_on),
            "reset" => i32::from(fed.reset),
            "a" => i32::from(fed.sge_a),
            "c" => i32::from(fed.sge_c),
            "d" => i32::from(fed.sge_d),
            "e" => i32::from(fed.sge_e),
            "sge_sbh_sg" => i32::from(fed.sge_sbh_sg),
            "sge_sbh" => i32::from(fed.sge_sbh),
            "sg_select" => i32::from(fed.sg_select.index()),
            "over" => i32::from(fed.over.get()),
            "se_active" => i32::from(fed.se_active),
            "se_select" => i32::from(fed.se_select),
            "position" => i32::try_from(i64::from(fed.position.0) + SHIFT).unwrap_or(0),
            "test_select" => i32::from(fed.test_select),
            "feedback" => i32::from(fed.feedback),
            "discrepancy" => i32::from(fed.discrepancy),
            // Power-on forgets what was told.
            "rx_fault" => i32::from(fed.rx_fault),
            "rx_internal" => i32::from(fed.rx_internal.level().rank()),
            "rx_external" => i32::from(fed.rx_external.level().rank()),
            "set_anew" => i32::from(fed.set_anew),
            _ => 0,
        }
    };
    let inputs = bound.system.inputs.iter().zip(&bound.inputs);
    inputs
        .map(|(input, (lo, hi))| {
            let short = input
                .name
                .split_once('.')
                .map_or(input.name.as_str(), |(_, n)| n);
            value(short).clamp(*lo, *hi)
        })
        .collect()
}

/// The system with the parameters of the axis, in increments and cycles.
fn bound(file: &Path, produced: &Produced) -> Result<Bound, String> {
    let spec = Spec::load(file).map_err(|e| e.to_string())?;
    let system = spec.system("axis_core", None).map_err(|e| e.to_string())?;
    let (p, words) = (&produced.parameters, produced.configuration.words());
    use stillpoint_monitors::sinumerik::parameters::Function;
    let is = |function| i64::from(p.enabled(function));
    let mut given: BTreeMap<String, Vec<i64>> = BTreeMap::new();
    let mut set = |name: &str, value: i64| {
        given.insert(name.to_owned(), vec![value]);
    };
    let shifted =
        |value: i32| (i64::from(value) + SHIFT).clamp(i64::from(-i32::MAX), i64::from(i32::MAX));
    let speed = |limit: u32| i64::from(limit).min(i64::from(i32::MAX));
    for (name, value) in [
        ("pos_max", POS_MAX),
        ("v_max", POS_MAX),
        ("stages", 4),
        ("enable", is(Function::SbhSg)),
        ("enable_ext", is(Function::ExternalStops)),
        ("enable_e", is(Function::StopE)),
        ("spl_stop_e", i64::from(p.spl_stop_mode == 4)),
        ("use_c", 1),
        ("use_d", 1),
        ("override", is(Function::Override)),
        ("over_max", 15),
        ("se", is(Function::Se)),
        ("sn", i64::from((0..8).any(|cam| p.cam_enabled(cam)))),
        ("se_mode", i64::from(p.pos_stop_mode)),
        ("sbh_tol", i64::from(p.standstill_tol)),
        ("ramp_tol", speed(words.stop_velo_tol.0)),
        ("velo_x", speed(words.velo_x.0)),
        ("velo_tol", speed(words.standstill_velo_tol.0)),
        ("sg_mode", i64::from(p.velo_stop_mode % 10)),
        ("internal", i64::from(p.installation.internal_cancellation)),
        ("tested", 1),
        ("peer", 1),
        ("one_encoder", 0),
        ("t_b", i64::from(words.pulse_disable_delay.count())),
        ("t_c", i64::from(words.stop_switch_time[0].count())),
        ("t_d", i64::from(words.stop_switch_time[1].count())),
        ("t_e", i64::from(words.stop_switch_time[2].count())),
        ("t_f", i64::from(words.stop_switch_time_f.count())),
        ("t_vel", i64::from(words.velo_switch_delay.count())),
        ("t_chk", i64::from(words.pulse_dis_check_time.count())),
    ] {
        set(name, value);
    }
    for k in 0..4 {
        set(&format!("limit_{}", k + 1), speed(words.velo_limit[k].0));
        set(
            &format!("reaction_{}", k + 1),
            i64::from(p.velo_stop_reaction[k] % 10),
        );
    }
    for k in 0..2 {
        set(&format!("plus_{}", k + 1), shifted(p.pos_limit_plus[k]));
        set(&format!("minus_{}", k + 1), shifted(p.pos_limit_minus[k]));
    }
    for (k, factor) in p.velo_ovr_factor.iter().enumerate() {
        set(&format!("f_{k}"), i64::from(*factor));
    }
    Bound::new(system, &given, &BTreeMap::new()).map_err(|e| e.to_string())
}
