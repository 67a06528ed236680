//! One axis of a simulation: its mechanics, its encoders, what its two channels see, and the monitors.

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::group::{self, Reaction};
use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Outputs, Pair, State};
use stillpoint_monitors::sinumerik::parameters::Parameters;
use stillpoint_monitors::sinumerik::selection::Monitored;

use super::door::Seen;
use super::plant::{Drive, Plant, Setpoint};
use super::scenario::{ExternalLetter, Fault, Scenario, Selection, Start};
use crate::production::Produced;
use crate::recording::{Value, vocabulary};

/// An axis with its monitors.
pub(super) struct Axis {
    pub plant: Plant,
    pub parameters: Parameters,
    pub pair: Pair,
    pub inputs: Inputs,
    pub outputs: Outputs,
    /// What the mode selects, whatever the doors say.
    pub selected: Selection,
    pub second_limits: bool,
    /// The stop that the safety logic asks for, in each channel.
    pub external: [Option<ExternalLetter>; 2],
    /// What is wrong in each channel, and the position when it began.
    pub faults: [(Fault, i32); 2],
    /// What the encoder of each channel has slipped, in thousandths of an increment.
    slipped: [i64; 2],
    /// Inputs that keep a value: place in the vocabulary, channel, value.
    pub forced: Vec<(usize, usize, bool)>,
    /// The cycle from which drive and control have run up; none before power-on.
    pub run_up_at: Option<u32>,
    pub referenced: bool,
    /// The reference point, and where the axis was at power-on.
    pub refpos: i32,
    pub powered_at: i32,
    pub group: group::Config,
    /// The limits of the speed stages.
    limits: [Speed; 4],
    /// The limit of the speed setpoint is in force.
    setpoint_limited: bool,
    /// The last reaction to the stop of another axis.
    pub reaction: Reaction,
    pub drive: Drive,
}

/// What happens in one cycle only.
#[derive(Clone, Copy, Default)]
pub(super) struct Pulse {
    pub power_on: bool,
    pub reset: bool,
    pub give: bool,
    pub withdraw: bool,
    pub key: bool,
}

/// What the safe logic selects.
#[derive(Clone, Copy)]
pub(super) struct Logic {
    pub selection: Selection,
    /// The test stop, by channel.
    pub test: [bool; 2],
}

impl Axis {
    pub fn new(produced: &Produced, start: &Start, scenario: &Scenario) -> Self {
        let running = scenario.running;
        let config = Config::new(produced.configuration);
        let position = increments(start.position);
        // A machine that was in order when it was switched off: agreement given, standstill position stored.
        let kept = match running {
            true => axis::State::restored(true, Some(Position(position))),
            false => axis::State::restored(false, None),
        };
        let state = State::restored(kept, kept);
        // The state just made is consistent; an initial one would be, too.
        let pair = Pair::resume(config, state).unwrap_or_else(|_| Pair::new(config));
        Self {
            plant: Plant::new(start.mechanics, start.position),
            parameters: produced.parameters,
            pair,
            inputs: Inputs::default(),
            outputs: Outputs::default(),
            selected: Selection::Nothing,
            second_limits: false,
            external: [None; 2],
            faults: [(Fault::None, 0); 2],
            slipped: [0; 2],
            forced: Vec::new(),
            run_up_at: running.then_some(0),
            referenced: running,
            refpos: position,
            powered_at: position,
            group: *produced.configuration.group(),
            limits: produced.configuration.words().velo_limit,
            setpoint_limited: !scenario.acceptance_mode,
            reaction: Reaction::Unaffected,
            drive: Drive::Coast,
        }
    }

    /// The position in increments.
    pub fn position(&self) -> i32 {
        increments(self.plant.position)
    }

    /// The position that the encoder of a channel measures.
    fn measured(&self, side: usize) -> i32 {
        increments(self.plant.position + self.slipped[side])
    }

    /// The stricter one of two selections: the operating stop, else the stage with the lower limit.
    pub fn stricter(&self, a: Selection, b: Selection) -> Selection {
        let strength = |selection| match selection {
            Selection::Nothing => (2, 0),
            Selection::Standstill => (0, 0),
            Selection::Stage(k) => (
                1,
                self.parameters
                    .velo_limit
                    .get(usize::from(k))
                    .copied()
                    .unwrap_or(0),
            ),
        };
        if strength(b) < strength(a) { b } else { a }
    }

    /// What both channels see in this cycle.
    pub fn see(&mut self, cycle: u32, logic: Logic, pulse: Pulse, inputs: &[vocabulary::Input]) {
        for side in 0..2 {
            if let Fault::Slip(by) = self.faults[side].0 {
                self.slipped[side] += by;
            }
            let mut local = self.local(cycle, logic, pulse, side);
            for (input, channel, value) in &self.forced {
                if *channel == side {
                    // Forced inputs are flags: the scenario has been checked.
                    let _ = inputs[*input].set(&mut local, &Value::Bool(*value));
                }
            }
            *side_of(&mut self.inputs, side) = local;
        }
    }

    fn local(&self, cycle: u32, logic: Logic, pulse: Pulse, side: usize) -> Local {
        let position = match self.faults[side] {
            (Fault::Freeze, at) => at,
            (Fault::Offset(by), _) => self.measured(side).saturating_add(by),
            (Fault::None | Fault::NoBraking | Fault::Slip(_), _) => self.measured(side),
        };
        let run_up = self.run_up_at.is_some_and(|at| cycle >= at);
        Local {
            power_on: pulse.power_on,
            run_up,
            reset: pulse.reset,
            spl_started: run_up,
            sge: self.signals(logic, side),
            feedback: self.drive == Drive::Coast,
            position: Position(position),
            encoder_speed: self.encoder_speed(),
            referenced: self.referenced && !pulse.power_on,
            refpos: Position(self.refpos),
            travelled: self.refpos.saturating_sub(self.powered_at),
            set_agreement: pulse.give,
            cancel_agreement: pulse.withdraw,
            key: pulse.key,
            ..Local::default()
        }
    }

    fn signals(&self, logic: Logic, side: usize) -> Sge {
        let selection = logic.selection;
        let stage = match selection {
            Selection::Stage(k) => k,
            _ => 0,
        };
        let off = |letter| self.external[side] != Some(letter);
        Sge {
            sbh_sg_off: selection == Selection::Nothing,
            sbh_off: selection != Selection::Standstill,
            sg_0: stage & 1 != 0,
            sg_1: stage & 2 != 0,
            se: self.second_limits,
            test_stop: logic.test[side],
            stop_a_off: off(ExternalLetter::A),
            stop_c_off: off(ExternalLetter::C),
            stop_d_off: off(ExternalLetter::D),
            stop_e_off: off(ExternalLetter::E),
            ..Sge::UNUSED
        }
    }

    /// The speed at the encoder in pulses per cycle, rounded down, in gear stage 1.
    fn encoder_speed(&self) -> Speed {
        let p = &self.parameters;
        let thousandths = self.plant.speed.unsigned_abs();
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

    /// One cycle of the monitors.
    pub fn step(&mut self) {
        self.outputs = self.pair.step(&self.inputs);
    }

    /// The higher one of the effective stops of both channels.
    pub fn level(&self) -> Level {
        self.outputs
            .nck
            .channel
            .stop
            .level
            .max(self.outputs.drive.channel.stop.level)
    }

    /// What the stop of this axis does to another one.
    pub fn acts(&self, interpolates: bool) -> Reaction {
        let (nck, drive) = (
            &self.outputs.nck.channel.stop,
            &self.outputs.drive.channel.stop,
        );
        let inputs = group::Inputs {
            level: self.level(),
            internal: nck.internal.max(drive.internal),
            interpolates,
            esr: false,
        };
        group::next(group::State::INITIAL, &self.group, &inputs)
            .1
            .reaction
    }

    /// The drive obeys the monitors of both channels and the reaction to the stops of other axes. What is commanded ends with
    /// the first stop: the program has to be started again.
    pub fn obey(&mut self) {
        let channels = [&self.outputs.nck.channel, &self.outputs.drive.channel];
        let any = |test: &dyn Fn(&stillpoint_monitors::sinumerik::channel::Outputs) -> bool| {
            channels.iter().any(|channel| test(channel))
        };
        let off = |c: &stillpoint_monitors::sinumerik::channel::Outputs| {
            !c.pulses.enable || !c.pulses.enable_external || c.stop.cancel_pulses
        };
        let own = if any(&off) {
            Drive::Coast
        } else if any(&|c| c.stop.n_set_zero || matches!(c.stop.level, Level::C | Level::B)) {
            Drive::CurrentLimit
        } else if any(&|c| matches!(c.stop.level, Level::D | Level::E)) {
            Drive::Path
        } else {
            Drive::Follow
        };
        let other = match self.reaction {
            Reaction::Unaffected => Drive::Follow,
            Reaction::Esr | Reaction::Ramp | Reaction::Path => Drive::Path,
            Reaction::CurrentLimit | Reaction::FastStop => Drive::CurrentLimit,
        };
        let mut drive = own.max(other);
        let deaf = self
            .faults
            .iter()
            .any(|(fault, _)| *fault == Fault::NoBraking);
        if deaf && drive != Drive::Coast {
            drive = Drive::Follow;
        } else if drive != Drive::Follow || (self.plant.stands() && any(&|c| c.start_inhibit)) {
            self.plant.setpoint = Setpoint::default();
        }
        // A help of the control for its user, in one channel only.
        let speed = &self.outputs.nck.channel.speed;
        let limited = self.setpoint_limited && speed.setpoint_limited;
        self.plant.limit = limited.then(|| i64::from(speed.setpoint_limit.0) * 1_000);
        self.drive = drive;
    }

    /// What the logic of a door sees of this axis, where the open door asks for `open`.
    pub fn seen(&self, open: Selection) -> Seen {
        let channels = [&self.outputs.nck, &self.outputs.drive];
        let most = match open {
            Selection::Stage(k) => self.limits.get(usize::from(k)),
            _ => None,
        };
        let monitored = |o: &&stillpoint_monitors::sinumerik::axis::Outputs| {
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

/// Thousandths of an increment in whole increments, rounded down.
pub(super) fn increments(thousandths: i64) -> i32 {
    let whole = thousandths.div_euclid(1_000);
    i32::try_from(whole).unwrap_or(if whole < 0 { i32::MIN } else { i32::MAX })
}

fn side_of(inputs: &mut Inputs, side: usize) -> &mut Local {
    match side {
        0 => &mut inputs.nck,
        _ => &mut inputs.drive,
    }
}
