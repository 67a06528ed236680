//! The machine in a simulation: each axis with its monitors, what its two channels see, and the safe logic of the doors.

use stillpoint_machine::{Door as Guard, Machine};
use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::channel;
use stillpoint_monitors::sinumerik::group::{self, Reaction};
use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Outputs, Pair, State};
use stillpoint_monitors::sinumerik::parameters::Parameters;
use stillpoint_monitors::sinumerik::selection::Monitored;

use super::door::{Logic as DoorLogic, Seen};
use super::production::{self, Produced};
use super::{WORDS, vocabulary};
use crate::families::{Monitors, Now, Start};
use crate::plant::{Actuation, Axis, increments};
use crate::recording::Value;

/// What the safety logic selects.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Selection {
    /// Neither operating stop nor speed stage.
    Nothing,
    /// The operating stop.
    Standstill,
    /// A speed stage, 0 to 3 for SG1 to SG4.
    Stage(u8),
}

/// What the mode selects, by the place of its word.
fn selected(axis: &Axis) -> Selection {
    match axis.selected {
        None => Selection::Nothing,
        Some(0) => Selection::Standstill,
        Some(k) => Selection::Stage(u8::try_from(k - 1).unwrap_or(3)),
    }
}

/// What monitors the axes behind a door while it is open.
fn opened(door: &Guard) -> Selection {
    let code = door.values.get("open");
    let code = code.and_then(|v| v.cells.first().copied());
    match code.and_then(|code| u8::try_from(code).ok()) {
        Some(stage @ 1..=4) => Selection::Stage(stage - 1),
        _ => Selection::Standstill,
    }
}

/// What the safe logic selects.
#[derive(Clone, Copy)]
struct Logic {
    selection: Selection,
    /// The test stop, by channel.
    test: [bool; 2],
}

/// The monitors of the machine.
pub(super) struct Simulated<'a> {
    machine: &'a Machine,
    axes: Vec<Pairs>,
    doors: Vec<DoorLogic>,
    /// The doors that could be opened in this cycle.
    released: Vec<bool>,
    inputs: Vec<vocabulary::Input>,
    outputs: Vec<vocabulary::Output>,
    /// The limit of the speed setpoint is in force.
    setpoint_limited: bool,
}

impl<'a> Simulated<'a> {
    pub(super) fn new(machine: &'a Machine, axes: &[Axis], start: &Start) -> Result<Self, String> {
        let produced = production::axes(machine)?;
        let axes = produced.iter().zip(axes);
        Ok(Self {
            machine,
            axes: axes
                .map(|(produced, axis)| Pairs::new(produced, axis, start.running))
                .collect(),
            doors: vec![DoorLogic::default(); machine.doors.len()],
            released: vec![false; machine.doors.len()],
            inputs: vocabulary::inputs(),
            outputs: vocabulary::outputs(),
            setpoint_limited: !start.acceptance_mode,
        })
    }

    /// What the safe logic selects for an axis: the strictest of its mode and of the doors in front of it, and the tests of
    /// its shutdown paths.
    fn logic(&self, k: usize, now: &Now<'_>) -> Logic {
        let name = &self.machine.axes[k].name;
        let mut logic = Logic {
            selection: selected(&now.axes[k]),
            test: [false; 2],
        };
        let doors = self.machine.doors.iter().zip(&self.doors).zip(now.doors);
        for ((guard, state), door) in doors.filter(|((guard, _), _)| guard.has(name)) {
            if state.selects(door) {
                logic.selection = self.axes[k].stricter(logic.selection, opened(guard));
            }
            if let Some(side) = state.tests() {
                logic.test[side] = true;
            }
        }
        logic
    }

    /// The logic of the doors reads what the monitors have told.
    fn step_doors(&mut self, now: &Now<'_>) {
        let guards = self.machine.doors.iter().zip(now.doors);
        for ((guard, door), state) in guards.zip(&mut self.doors) {
            let axes = self.machine.axes.iter().zip(&self.axes);
            let behind = axes.filter(|(known, _)| guard.has(&known.name));
            let seen: Vec<Seen> = behind.map(|(_, axis)| axis.seen(opened(guard))).collect();
            state.step(door, &seen);
        }
    }

    /// What the stops of the other axes do to one, as the stop groups of these say.
    fn reaction(&self, k: usize) -> Reaction {
        let machine = self.machine;
        let together = |a: usize, b: usize| {
            let has = |a: usize, b: usize| {
                machine.axes[a]
                    .interpolates_with
                    .iter()
                    .any(|n| *n.get_ref() == machine.axes[b].name)
            };
            has(a, b) || has(b, a)
        };
        let others = (0..self.axes.len()).filter(|other| *other != k);
        let acts: Vec<Reaction> = others
            .map(|other| self.axes[other].acts(together(other, k)))
            .collect();
        group::worst(&acts)
    }
}

impl Monitors for Simulated<'_> {
    fn step(&mut self, now: Now<'_>) {
        if now.axes.iter().any(|axis| axis.pulse.power_on) {
            self.doors.iter_mut().for_each(DoorLogic::power_on);
        }
        for k in 0..self.axes.len() {
            let logic = self.logic(k, &now);
            let monitored = &mut self.axes[k];
            for side in 0..2 {
                let mut local = monitored.local(&now.axes[k], now.cycle, logic, side);
                let forced = now.forced.iter();
                for forced in forced.filter(|f| f.owner == k && f.side == side) {
                    // The scenario has been checked.
                    let _ = self.inputs[forced.input].set(&mut local, &forced.value);
                }
                *side_of(&mut monitored.inputs, side) = local;
            }
            monitored.outputs = monitored.pair.step(&monitored.inputs);
        }
        for k in 0..self.axes.len() {
            let reaction = self.reaction(k);
            self.axes[k].obeyed(&mut now.axes[k], reaction, self.setpoint_limited);
        }
        self.released = self.doors.iter().map(DoorLogic::released).collect();
        self.step_doors(&now);
    }

    fn released(&self, door: usize) -> bool {
        self.released[door]
    }

    fn told(&self, owner: usize, side: usize) -> Vec<Value> {
        let Pairs {
            inputs, outputs, ..
        } = &self.axes[owner];
        let (local, said) = match side {
            0 => (&inputs.nck, &outputs.nck),
            _ => (&inputs.drive, &outputs.drive),
        };
        let read = self.inputs.iter().map(|input| input.get(local));
        let written = self.outputs.iter();
        read.chain(written.map(|output| output.get(side, local, said)))
            .collect()
    }
}

/// The monitors of an axis.
struct Pairs {
    parameters: Parameters,
    pair: Pair,
    inputs: Inputs,
    outputs: Outputs,
    group: group::Config,
    /// The limits of the speed stages.
    limits: [Speed; 4],
}

impl Pairs {
    fn new(produced: &Produced, axis: &Axis, running: bool) -> Self {
        let config = Config::new(produced.configuration);
        let position = increments(axis.plant.position);
        // A machine that was in order when it was switched off: agreement given, standstill position stored.
        let kept = match running {
            true => axis::State::restored(true, Some(Position(position))),
            false => axis::State::restored(false, None),
        };
        let state = State::restored(kept, kept);
        Self {
            parameters: produced.parameters,
            // The state just made is consistent; an initial one would be, too.
            pair: Pair::resume(config, state).unwrap_or_else(|_| Pair::new(config)),
            inputs: Inputs::default(),
            outputs: Outputs::default(),
            group: *produced.configuration.group(),
            limits: produced.configuration.words().velo_limit,
        }
    }

    /// The stricter one of two selections: the operating stop, else the stage with the lower limit.
    fn stricter(&self, a: Selection, b: Selection) -> Selection {
        let limits = &self.parameters.velo_limit;
        let strength = |selection| match selection {
            Selection::Nothing => (2, 0),
            Selection::Standstill => (0, 0),
            Selection::Stage(k) => (1, limits.get(usize::from(k)).copied().unwrap_or(0)),
        };
        if strength(b) < strength(a) { b } else { a }
    }

    /// What a channel sees in this cycle.
    fn local(&self, axis: &Axis, cycle: u32, logic: Logic, side: usize) -> Local {
        let run_up = axis.run_up(cycle);
        let pulse = axis.pulse;
        let reference = increments(axis.reference);
        Local {
            power_on: pulse.power_on,
            run_up,
            reset: pulse.reset,
            spl_started: run_up,
            sge: signals(axis, logic, side),
            feedback: axis.drive == Actuation::Coast,
            position: Position(increments(axis.shown(side))),
            encoder_speed: self.encoder_speed(axis),
            referenced: axis.referenced && !pulse.power_on,
            refpos: Position(reference),
            travelled: reference.saturating_sub(increments(axis.powered_at)),
            set_agreement: pulse.give,
            cancel_agreement: pulse.withdraw,
            key: pulse.key,
            ..Local::default()
        }
    }

    /// The speed at the encoder in pulses per cycle, rounded down, in gear stage 1.
    fn encoder_speed(&self, axis: &Axis) -> Speed {
        let p = &self.parameters;
        let thousandths = axis.plant.speed.unsigned_abs();
        let first = |list: &[u32; 8]| u128::from(list[0]);
        let (pulses, length) = match (p.enc_is_linear, p.is_rot_ax) {
            (true, _) => (1, u128::from(p.enc_grid_point_dist)),
            (false, rotary) => {
                let turn = if rotary {
                    360_000
                } else {
                    u128::from(p.enc_gear_pitch)
                };
                let pulses = u128::from(p.enc_resol) * first(&p.enc_gear_numera);
                (pulses, turn * first(&p.enc_gear_denom) * 1_000)
            }
        };
        let speed = u128::from(thousandths) * pulses / length.max(1);
        Speed(u32::try_from(speed).unwrap_or(u32::MAX))
    }

    /// What the stop of this axis does to another one.
    fn acts(&self, interpolates: bool) -> Reaction {
        let nck = &self.outputs.nck.channel.stop;
        let drive = &self.outputs.drive.channel.stop;
        let inputs = group::Inputs {
            level: nck.level.max(drive.level),
            internal: nck.internal.max(drive.internal),
            interpolates,
            esr: false,
        };
        group::next(group::State::INITIAL, &self.group, &inputs)
            .1
            .reaction
    }

    /// The drive obeys the monitors of both channels and the reaction to the stops of other axes.
    fn obeyed(&self, axis: &mut Axis, reaction: Reaction, setpoint_limited: bool) {
        let channels = [&self.outputs.nck.channel, &self.outputs.drive.channel];
        let any = |test: &dyn Fn(&channel::Outputs) -> bool| channels.iter().any(|c| test(c));
        let off = |c: &channel::Outputs| {
            !c.pulses.enable || !c.pulses.enable_external || c.stop.cancel_pulses
        };
        let own = if any(&off) {
            Actuation::Coast
        } else if any(&|c| c.stop.n_set_zero || matches!(c.stop.level, Level::C | Level::B)) {
            Actuation::CurrentLimit
        } else if any(&|c| matches!(c.stop.level, Level::D | Level::E)) {
            Actuation::Path
        } else {
            Actuation::Follow
        };
        let other = match reaction {
            Reaction::Unaffected => Actuation::Follow,
            Reaction::Esr | Reaction::Ramp | Reaction::Path => Actuation::Path,
            Reaction::CurrentLimit | Reaction::FastStop => Actuation::CurrentLimit,
        };
        axis.obey(own.max(other), any(&|c| c.start_inhibit));
        // A help of the control for its user, in one channel only.
        let setpoint = &self.outputs.setpoint;
        let limited = setpoint_limited && setpoint.limited;
        axis.plant.limit = limited.then(|| i64::from(setpoint.limit.0) * 1_000);
    }

    /// What the logic of a door sees of this axis, where the open door asks for `open`.
    fn seen(&self, open: Selection) -> Seen {
        let channels = [&self.outputs.nck, &self.outputs.drive];
        let most = match open {
            Selection::Stage(k) => self.limits.get(usize::from(k)),
            _ => None,
        };
        let monitored = |o: &&axis::Outputs| {
            let selection = &o.channel.selection;
            match selection.monitored {
                Monitored::Standstill => true,
                Monitored::Speed => most.is_some_and(|most| selection.limit <= *most),
                Monitored::Nothing => false,
            }
        };
        Seen {
            monitored: channels.iter().all(monitored),
            stands: channels.iter().all(|o| o.channel.motion.speed.0 == 0),
            due: channels.iter().any(|o| o.forced_check.due),
            cancelled: channels.iter().any(|o| o.sga.pulses_cancelled),
            testing: channels.map(|o| o.channel.test.active),
        }
    }
}

/// The signals of a channel: what the logic selects, and the stop that is asked for.
fn signals(axis: &Axis, logic: Logic, side: usize) -> Sge {
    let selection = logic.selection;
    let stage = match selection {
        Selection::Stage(k) => k,
        _ => 0,
    };
    let asked = axis.asked[side].and_then(|k| WORDS.asked.get(k));
    let off = |letter: &str| asked.is_none_or(|(name, _)| *name != letter);
    Sge {
        sbh_sg_off: selection == Selection::Nothing,
        sbh_off: selection != Selection::Standstill,
        sg_0: stage & 1 != 0,
        sg_1: stage & 2 != 0,
        se: axis.limits == 1,
        test_stop: logic.test[side],
        stop_a_off: off("A"),
        stop_c_off: off("C"),
        stop_d_off: off("D"),
        stop_e_off: off("E"),
        ..Sge::UNUSED
    }
}

fn side_of(inputs: &mut Inputs, side: usize) -> &mut Local {
    match side {
        0 => &mut inputs.nck,
        _ => &mut inputs.drive,
    }
}
