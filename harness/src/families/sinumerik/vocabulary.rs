//! The signals of an axis and where they stand in the production monitors: those of [`crate::recording::vocabulary`], and
//! `SGE_...` and `SGA_...`, the signals of the family's data block.

use std::borrow::Cow;

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinumerik::axis::{Local, Outputs};
use stillpoint_monitors::sinumerik::interface::{BLOCK, Place, SGA, SGE, Sge};
use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop, Level};
use stillpoint_monitors::sinumerik::reference::AxisState;
use stillpoint_monitors::sinumerik::selection::{Mode, Monitored};
use stillpoint_monitors::sinumerik::stop::Phase;

use crate::families::Port;
use crate::recording::vocabulary::{POSITION, Unit, VELOCITY};
use crate::recording::{Allowed, Kind, Value};

/// The channels of an axis, in the order in which they are stored.
pub const CHANNELS: [&str; 2] = ["nck", "drive"];

/// Where an input of a channel stands.
#[derive(Clone, Copy)]
enum Slot {
    Signal(Place),
    Flag(Flag),
    Position(fn(&mut Local) -> &mut Position),
    Speed(fn(&mut Local) -> &mut Speed),
    Travelled,
}

/// An input of a channel.
#[derive(Clone, Copy)]
pub struct Input {
    /// Its name within the channel.
    pub name: &'static str,
    /// What its values are.
    pub kind: Kind,
    /// What a number counts; `increment` is 1 um or 0.001 degrees.
    pub unit: Unit,
    slot: Slot,
}

/// The place of a flag among the inputs.
type Flag = fn(&mut Local) -> &mut bool;

const FLAGS: &[(&str, Flag)] = &[
    ("power_on", |l| &mut l.power_on),
    ("run_up", |l| &mut l.run_up),
    ("reset", |l| &mut l.reset),
    ("spl_started", |l| &mut l.spl_started),
    ("spl_error", |l| &mut l.spl_error),
    ("pulses_cancelled", |l| &mut l.feedback),
    ("shutdown_test_select", |l| &mut l.shutdown_test_select),
    ("parking", |l| &mut l.parking),
    ("referenced", |l| &mut l.referenced),
    ("reference_lost", |l| &mut l.reference_lost),
    ("set_agreement", |l| &mut l.set_agreement),
    ("cancel_agreement", |l| &mut l.cancel_agreement),
    ("key", |l| &mut l.key),
    ("altered", |l| &mut l.altered),
];

/// Every input of a channel.
pub fn inputs() -> Vec<Input> {
    let signal = |place: &Place| Input {
        name: place.id,
        kind: Kind::Bool,
        unit: Unit::None,
        slot: Slot::Signal(*place),
    };
    let flag = |(name, slot): &(&'static str, Flag)| Input {
        name,
        kind: Kind::Bool,
        unit: Unit::None,
        slot: Slot::Flag(*slot),
    };
    let number = |name, unit, slot| Input {
        name,
        kind: Kind::Int,
        unit,
        slot,
    };
    let mut all: Vec<Input> = SGE
        .iter()
        .map(signal)
        .chain(FLAGS.iter().map(flag))
        .collect();
    all.extend([
        number(
            POSITION,
            Unit::Increment,
            Slot::Position(|l| &mut l.position),
        ),
        number(
            "reference_position",
            Unit::Increment,
            Slot::Position(|l| &mut l.refpos),
        ),
        number("travelled", Unit::Increment, Slot::Travelled),
        number(
            "encoder_speed",
            Unit::PulsesPerCycle,
            Slot::Speed(|l| &mut l.encoder_speed),
        ),
    ]);
    all
}

impl Input {
    /// Its value.
    pub fn get(&self, local: &Local) -> Value {
        let mut local = *local;
        match self.slot {
            Slot::Signal(place) => {
                let mut block = [0; BLOCK];
                write_sge(&local.sge, &mut block);
                Value::Bool(bit(&block, place))
            }
            Slot::Flag(flag) => Value::Bool(*flag(&mut local)),
            Slot::Position(position) => Value::Int(i64::from(position(&mut local).0)),
            Slot::Speed(speed) => Value::Int(i64::from(speed(&mut local).0)),
            Slot::Travelled => Value::Int(i64::from(local.travelled)),
        }
    }

    /// Gives it a value. False: the value is not one of its kind, or outside its range (see [`Input::range`]).
    #[must_use]
    pub fn set(&self, local: &mut Local, value: &Value) -> bool {
        match (self.slot, value) {
            (Slot::Signal(place), Value::Bool(b)) => {
                let mut block = [0; BLOCK];
                write_sge(&local.sge, &mut block);
                put(&mut block, place, *b);
                local.sge = Sge::read(&block);
            }
            (Slot::Flag(flag), Value::Bool(b)) => *flag(local) = *b,
            (Slot::Position(position), Value::Int(n)) => match i32::try_from(*n) {
                Ok(n) => *position(local) = Position(n),
                Err(_) => return false,
            },
            (Slot::Speed(speed), Value::Int(n)) => match u32::try_from(*n) {
                Ok(n) => *speed(local) = Speed(n),
                Err(_) => return false,
            },
            (Slot::Travelled, Value::Int(n)) => match i32::try_from(*n) {
                Ok(n) => local.travelled = n,
                Err(_) => return false,
            },
            _ => return false,
        }
        true
    }

    /// It, as a signal of the channel.
    pub const fn port(&self) -> Port {
        Port {
            name: self.name,
            kind: self.kind,
            unit: self.unit,
            allowed: match self.kind {
                Kind::Int => {
                    let (least, most) = self.range();
                    Allowed::Between(least, most)
                }
                Kind::Bool | Kind::Text => Allowed::All,
            },
        }
    }

    /// The least and the greatest value of a number.
    pub const fn range(&self) -> (i64, i64) {
        match self.slot {
            Slot::Speed(_) => (0, u32::MAX as i64),
            _ => (i32::MIN as i64, i32::MAX as i64),
        }
    }
}

fn write_sge(sge: &Sge, block: &mut [u8; BLOCK]) {
    sge.write(block);
}

fn bit(block: &[u8; BLOCK], place: Place) -> bool {
    block
        .get(usize::from(place.byte))
        .is_some_and(|byte| byte >> place.bit & 1 == 1)
}

fn put(block: &mut [u8; BLOCK], place: Place, value: bool) {
    if let Some(byte) = block.get_mut(usize::from(place.byte)) {
        *byte = *byte & !(1 << place.bit) | u8::from(value) << place.bit;
    }
}

/// An output of a channel.
#[derive(Clone, Copy)]
pub struct Output {
    /// Its name within the channel.
    pub name: &'static str,
    /// What its values are.
    pub kind: Kind,
    /// What a number counts.
    pub unit: Unit,
    source: Source,
}

#[derive(Clone, Copy)]
enum Source {
    Signal(Place),
    Flag(fn(&Outputs) -> bool),
    Number(fn(&Outputs) -> i64),
    /// Reads the local inputs too: which function is selected, and whether by a signal.
    Name(fn(&Local, &Outputs) -> &'static str),
    Alarms,
}

/// Every output of a channel.
pub fn outputs() -> Vec<Output> {
    let new = |name, kind, unit, source| Output {
        name,
        kind,
        unit,
        source,
    };
    let name = |text, source| new(text, Kind::Text, Unit::None, Source::Name(source));
    let flag = |text, source| new(text, Kind::Bool, Unit::None, Source::Flag(source));
    let number = |text, unit, source| new(text, Kind::Int, unit, Source::Number(source));
    let mut all = vec![
        name("stop", |_, o| stop(o)),
        name("stop_internal", |_, o| {
            level(o.channel.stop.internal.level())
        }),
        name("stop_external", |_, o| {
            level(o.channel.external.request.level())
        }),
        name("stop_phase", |_, o| phase(o.channel.stop.phase)),
        name("Safety.STO.SelectionState", |_, o| {
            selected_stop(o, Level::A)
        }),
        name("Safety.STO.ActivationState", |_, o| {
            match o.channel.stop.cancel_pulses {
                true => "POWER_REMOVED",
                false => "NONE",
            }
        }),
        name("Safety.SS1.SelectionState", |_, o| {
            selected_stop(o, Level::B)
        }),
        name("Safety.SS1.ActivationState", |_, o| {
            match o.channel.stop.phase {
                Phase::BBraking if o.channel.ramp.violated => "SS1_ACTIVE_FAULTED",
                Phase::BBraking => "SS1_ACTIVE",
                _ => "NONE",
            }
        }),
        name("Safety.SS2.SelectionState", |_, o| {
            selected_stop(o, Level::C)
        }),
        name("Safety.SS2.ActivationState", |_, o| {
            match o.channel.stop.phase {
                Phase::Braking | Phase::SbhInt if o.channel.ramp.violated => "SS2_ACTIVE_FAULTED",
                Phase::Braking | Phase::SbhInt => "SS2_ACTIVE",
                _ => "NONE",
            }
        }),
        name("Safety.SOS.SelectionState", |l, o| {
            match o.channel.selection.mode {
                Mode::SbhForced => "SELECTED_INTERN",
                Mode::Sbh | Mode::SbhPend => "SELECTED",
                _ if !l.sge.sbh_sg_off && !l.sge.sbh_off => "SELECTED",
                _ => "NONE",
            }
        }),
        name("Safety.SOS.ActivationState", |_, o| {
            match (o.channel.selection.monitored, o.channel.standstill.violated) {
                (Monitored::Standstill, true) => "SOS_ACTIVE_FAULTED",
                (Monitored::Standstill, false) => "SOS_ACTIVE",
                _ => "NONE",
            }
        }),
        name("Safety.SLS.SelectionState", selected_stage),
        name("Safety.SLS.ActivationState", |_, o| {
            match (o.channel.selection.monitored, o.channel.speed.violated) {
                (Monitored::Speed, true) => "SLS_ACTIVE_FAULTED",
                (Monitored::Speed, false) => "SLS_ACTIVE",
                _ => "NONE",
            }
        }),
        number("Safety.SLS.Limit", Unit::IncrementPerCycle, |o| {
            i64::from(o.channel.selection.limit.0)
        }),
        name("Safety.SLP.SelectionState", |l, o| {
            match (o.channel.limit_switch.watched, l.sge.se) {
                (false, _) => "NONE",
                (true, false) => "SELECTED_LIMIT_1",
                (true, true) => "SELECTED_LIMIT_2",
            }
        }),
        name("Safety.SLP.ActivationState", |_, o| {
            let switch = &o.channel.limit_switch;
            match (switch.watched, switch.upper || switch.lower) {
                (true, true) => "SLP_ACTIVE_FAULTED",
                (true, false) => "SLP_ACTIVE",
                (false, _) => "NONE",
            }
        }),
        number(VELOCITY, Unit::IncrementPerCycle, |o| {
            i64::from(o.channel.motion.speed.0)
        }),
        number("standstill_reference", Unit::Increment, |o| {
            i64::from(o.channel.selection.reference.0)
        }),
        name("mode", |_, o| mode(o.channel.selection.mode)),
        name("axis_state", |_, o| axis_state(o.reference.axis)),
        flag("user_agreement", |o| o.agreement.agreed),
        flag("fault", |o| o.channel.fault.interlock),
        number("fault_code", Unit::None, |o| i64::from(o.code.number())),
        flag("start_inhibit", |o| o.channel.start_inhibit),
        flag("enable_pulses", |o| o.channel.pulses.enable),
        flag("enable_pulses_external", |o| {
            o.channel.pulses.enable_external
        }),
        flag("test_due", |o| o.forced_check.due),
        flag("reset_taken", |o| o.reset_taken),
        new("alarms", Kind::Text, Unit::None, Source::Alarms),
    ];
    let signal = |place: &Place| new(place.id, Kind::Bool, Unit::None, Source::Signal(*place));
    all.extend(SGA.iter().map(signal));
    all
}

impl Output {
    /// It, as a signal of the channel.
    pub const fn port(&self) -> Port {
        Port {
            name: self.name,
            kind: self.kind,
            unit: self.unit,
            allowed: Allowed::All,
        }
    }

    /// Its value, of channel `side` (an index into [`CHANNELS`]).
    pub fn get(&self, side: usize, local: &Local, outputs: &Outputs) -> Value {
        match self.source {
            Source::Signal(place) => {
                let mut block = [0; BLOCK];
                outputs.sga.write(&mut block);
                Value::Bool(bit(&block, place))
            }
            Source::Flag(flag) => Value::Bool(flag(outputs)),
            Source::Number(number) => Value::Int(number(outputs)),
            Source::Name(name) => Value::Text(Cow::Borrowed(name(local, outputs))),
            Source::Alarms => {
                let number = |alarm: stillpoint_monitors::sinumerik::alarm::Alarm| match side {
                    0 => Some(alarm.nck().number),
                    _ => alarm.drive().map(|entry| entry.number),
                };
                let all: Vec<String> = outputs
                    .alarms
                    .iter()
                    .filter_map(number)
                    .map(|n| n.to_string())
                    .collect();
                Value::Text(Cow::Owned(all.join(" ")))
            }
        }
    }
}

/// The name of a level.
pub const fn level(level: Level) -> &'static str {
    match level {
        Level::None => "NONE",
        Level::F => "F",
        Level::E => "E",
        Level::D => "D",
        Level::C => "C",
        Level::Test => "TEST",
        Level::B => "B",
        Level::A => "A",
    }
}

/// The effective stop; STOP F where no other one is.
fn stop(outputs: &Outputs) -> &'static str {
    match outputs.channel.stop.level {
        Level::None if outputs.channel.fault.interlock => "F",
        other => level(other),
    }
}

/// Whether a stop of this kind (STOP C stands for D and E) is in force, and who has asked for it.
fn selected_stop(outputs: &Outputs, kind: Level) -> &'static str {
    let stop = &outputs.channel.stop;
    let same = match kind {
        Level::C => matches!(stop.level, Level::C | Level::D | Level::E),
        other => stop.level == other,
    };
    match same {
        false => "NONE",
        true if stop.internal.level() == stop.level => "SELECTED_INTERN",
        true => "SELECTED_EXTERN",
    }
}

/// The stage in force, or the one selected while a higher one is still in force.
fn selected_stage(local: &Local, outputs: &Outputs) -> &'static str {
    const STAGES: [&str; 4] = [
        "SELECTED_LIMIT_1",
        "SELECTED_LIMIT_2",
        "SELECTED_LIMIT_3",
        "SELECTED_LIMIT_4",
    ];
    let sge = &local.sge;
    if sge.sbh_sg_off || !sge.sbh_off || outputs.channel.selection.mode == Mode::Nsb {
        return "NONE";
    }
    STAGES[usize::from(sge.sg_1) * 2 + usize::from(sge.sg_0)]
}

const fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Idle => "IDLE",
        Phase::Braking => "BRAKING",
        Phase::SbhInt => "SBH_INT",
        Phase::BBraking => "B_BRAKING",
        Phase::PulsesOff => "PULSES_OFF",
        Phase::Testing => "TESTING",
    }
}

const fn mode(mode: Mode) -> &'static str {
    match mode {
        Mode::Nsb => "NSB",
        Mode::Sg => "SG",
        Mode::SgDown => "SG_DOWN",
        Mode::SbhPend => "SBH_PEND",
        Mode::Sbh => "SBH",
        Mode::SbhForced => "SBH_FORCED",
    }
}

const fn axis_state(state: AxisState) -> &'static str {
    match state {
        AxisState::Off => "OFF",
        AxisState::NotRef => "NOT_REF",
        AxisState::Ref => "REF",
        AxisState::SafeRef => "SAFE_REF",
    }
}

/// The level of a name, as recorded under `stop_internal`.
pub fn internal_stop(name: &str) -> Option<InternalStop> {
    Level::ALL
        .into_iter()
        .find(|l| level(*l) == name)
        .and_then(InternalStop::from_level)
}

/// The level of a name, as recorded under `stop_external`.
pub fn external_stop(name: &str) -> Option<ExternalStop> {
    Level::ALL
        .into_iter()
        .find(|l| level(*l) == name)
        .and_then(ExternalStop::from_level)
}
