//! One channel of a drive: the Basic Functions in their cycle, the Extended ones in theirs, acknowledgement, and what the drive may do. And the
//! pair of them.

use stillpoint_monitors::kernel::{Cycles, Distance, Position, Speed};
use stillpoint_monitors::sinamics::basic_stop::{self, Latched};
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::{
    acknowledgement, acknowledgement_edge, basic_selection, communication, restart, sbc, ss1_basic,
    sto, terminal_pair,
};

use super::functions::{Functions, Results, Seen};
use super::messages::{Message, Messages};
use super::signals::{Flag, Number, Read};
use super::values::Values;

/// What a channel tells in a cycle.
#[derive(Clone, Copy, Default)]
pub(super) struct Said {
    pub position: i32,
    pub speed: Speed,
    pub stop: Stop,
    pub stop_f: bool,
    pub cause: &'static str,
    pub messages: Messages,
    pub sto: bool,
    pub ss1: bool,
    pub ss2: bool,
    pub sos: bool,
    pub sos_violated: bool,
    pub sos_reference: i32,
    pub sls: bool,
    pub sls_level: u8,
    pub sls_limit: Speed,
    pub sls_violated: bool,
    pub sdi: [bool; 2],
    pub slp: bool,
    pub slp_second: bool,
    pub ssm: bool,
    pub braking_limit: Speed,
    pub function: Function,
    pub pulses_off: bool,
    /// The drive brakes along OFF3.
    pub off3: bool,
    /// The control is to brake, or to hold the axis: SOS, SS1E, SS2E, STOP D and E.
    pub control_brakes: bool,
    /// The setpoint has no effect.
    pub inhibited: bool,
    pub torque: bool,
    /// r9733\[2\], and both directions.
    pub setpoint: Speed,
    pub directions: Option<[Speed; 2]>,
    pub brake_open: bool,
    /// What the safety telegram says counts.
    pub valid: bool,
    pub event: bool,
}

/// What a channel hears of the other one, a cycle later.
#[derive(Clone, Copy, Default)]
struct Shared {
    position: Position,
    terminal: bool,
    /// STO or SS1 of the Basic Functions is selected.
    selected: bool,
    results: Results,
    brake_on: bool,
}

struct Basic {
    selection: basic_selection::Monitor,
    terminals: Option<terminal_pair::Monitor>,
    ss1: ss1_basic::Monitor,
    stop: basic_stop::Monitor,
}

/// A channel.
struct Channel {
    basic: Basic,
    functions: Option<Functions>,
    communication: Option<communication::Monitor>,
    edge: acknowledgement_edge::Monitor,
    reselection: acknowledgement_edge::Monitor,
    acknowledgement: acknowledgement::Monitor,
    sto: sto::Monitor,
    sbc: Option<sbc::Monitor>,
    restart: restart::Monitor,
    /// The last safety telegram.
    received: Read,
    valid: bool,
    torque: bool,
    /// The Extended Functions keep the pulses off: terminals that differ are no fault.
    held: bool,
    brake_defect: bool,
    messages: Messages,
    /// None before the first cycle.
    before: Option<Position>,
    shared: Shared,
}

/// A monitor in a state; that of POWER ON where it does not fit the parameters, which does not come about.
macro_rules! resumed {
    ($module:ident, $config:expr, $state:expr) => {
        $module::Monitor::resume($config, $state).unwrap_or($module::Monitor::new($config))
    };
}

impl Channel {
    /// At POWER ON, or as after many cycles in which nothing happened and the drive was on.
    fn new(values: &Values, running: bool, read: &Read) -> Self {
        let edge = || match running {
            true => resumed!(
                acknowledgement_edge,
                acknowledgement_edge::Config,
                acknowledgement_edge::State {
                    phase: acknowledgement_edge::Phase::Idle
                }
            ),
            false => acknowledgement_edge::Monitor::new(acknowledgement_edge::Config),
        };
        let communication = |config: communication::Config| match running {
            true => {
                let mut monitor = communication::Monitor::new(config);
                // The telegram before.
                let _ = monitor.step(&communication::Inputs {
                    telegram: true,
                    ..Default::default()
                });
                monitor
            }
            false => communication::Monitor::new(config),
        };
        Self {
            basic: Basic {
                selection: basic_selection::Monitor::new(values.selection),
                terminals: values.terminals.map(terminal_pair::Monitor::new),
                ss1: ss1_basic::Monitor::new(values.ss1_basic),
                stop: resumed!(
                    basic_stop,
                    values.basic_stop,
                    basic_stop::State {
                        selected: !running,
                        ..basic_stop::State::INITIAL
                    }
                ),
            },
            functions: values.extended.as_ref().map(Functions::new),
            communication: values.communication.map(communication),
            edge: edge(),
            reselection: edge(),
            acknowledgement: acknowledgement::Monitor::new(values.acknowledgement),
            sto: resumed!(
                sto,
                values.sto,
                sto::State {
                    started: running,
                    selected_held: false,
                }
            ),
            sbc: values
                .sbc
                .map(|config| resumed!(sbc, config, sbc::State { on: running })),
            restart: match running {
                true => resumed!(
                    restart,
                    restart::Config,
                    restart::State {
                        phase: restart::Phase::Run,
                        last: true,
                    }
                ),
                false => restart::Monitor::new(restart::Config),
            },
            received: match running {
                true => *read,
                false => Read::default(),
            },
            valid: running,
            torque: running,
            held: false,
            brake_defect: false,
            messages: Messages::default(),
            before: None,
            shared: Shared {
                position: Position(read.of(Number::Position)),
                terminal: read.is(Flag::Terminal),
                brake_on: running && values.sbc.is_some(),
                ..Shared::default()
            },
        }
    }

    /// The bits that count: of the last telegram, or substitute values.
    fn bits(&mut self, read: &Read, acknowledge: bool) -> (Read, Stop) {
        let Some(communication) = &mut self.communication else {
            self.valid = true;
            return (*read, Stop::None);
        };
        if read.is(Flag::Telegram) {
            self.received = *read;
        }
        let told = self.functions.as_ref().map(Functions::told);
        let said = communication.step(&communication::Inputs {
            power_on: false,
            telegram: read.is(Flag::Telegram) && read.is(Flag::PoweredUp),
            disturbed: false,
            undelayed: told.is_some_and(|told| told.undelayed),
            acknowledge,
        });
        self.valid = said.valid;
        let bits = match said.valid {
            true => read.with_bits_of(&self.received),
            false => read.with_bits_of(&Read::default()),
        };
        (bits, said.request)
    }

    /// One cycle.
    fn step(&mut self, values: &Values, read: &Read, other: &Shared) -> Said {
        if read.is(Flag::PowerOn) {
            *self = Self::new(values, false, read);
        }
        let position = Position(read.of(Number::Position));
        let Distance(speed) = self
            .before
            .map_or(Distance(0), |before| position.distance(before));
        let speed = Speed(speed);
        self.before = Some(position);
        let level = match self.communication {
            Some(_) if !read.is(Flag::Telegram) => self.received.is(Flag::Ack),
            _ => read.is(Flag::Ack),
        };
        let edge = self.edge.step(&acknowledgement_edge::Inputs {
            power_on: false,
            valid: self.valid,
            stable: true,
            level,
        });
        let edge = edge.acknowledge;
        let (bits, communication) = self.bits(read, edge);
        let (selection, ss1, basic, terminals_differ) = self.basic(values, &bits, other, edge);
        let ss1_selected = values.extended.is_some() && !bits.is(Flag::Ss1);
        let any = selection.sto || selection.ss1 || ss1_selected;
        let reselected = self.reselection.step(&acknowledgement_edge::Inputs {
            power_on: false,
            valid: self.valid,
            stable: true,
            level: any,
        });
        let seen = Seen {
            position,
            speed,
            sto: selection.sto,
            ss1: ss1_selected,
            basic_ss1: ss1.active && !ss1.sto,
            basic_sto: ss1.sto,
            drive_on: self.torque,
            communication,
            positions: [self.shared.position, other.position],
            results: [self.shared.results, other.results],
        };
        let mut messages = Messages::default()
            .with(Message::BasicF, terminals_differ)
            .with(Message::Brake, self.brake_defect);
        let raised = self.functions.as_mut().map(|f| f.watch(&bits, &seen));
        let cause = raised.is_some_and(|r| r.request != Stop::None || r.difference);
        let acknowledged = self.acknowledgement.step(&acknowledgement::Inputs {
            power_on: false,
            input_edge: false,
            profisafe_edge: edge,
            reselected: reselected.acknowledge,
            message: cause,
            cause,
            module_cause: false,
            standard: read.is(Flag::General),
        });
        let told = match (&mut self.functions, &raised) {
            (Some(functions), Some(raised)) => {
                *functions.arbitrate(&bits, &seen, raised, acknowledged.acknowledge)
            }
            _ => Default::default(),
        };
        let arbiter = &told.arbiter;
        messages = messages
            .and(told.messages)
            .with(Message::BasicA, basic.stop >= Latched::A);
        let stop_a = arbiter.stop >= Stop::A || basic.pulses_off;
        let sto = self.sto.step(&sto::Inputs {
            powered_up: read.is(Flag::PoweredUp),
            selected: selection.sto,
            ss1_ended: ss1.sto || told.ss1.sto,
            stop_a,
            ..Default::default()
        });
        let brake = self.brake(read, &sto, other);
        let restart = self.restart.step(&restart::Inputs {
            power_on: false,
            sto: sto.pulses_off,
            latched: arbiter.blocks_run || basic.entered,
            on: read.is(Flag::On),
            enabled: read.is(Flag::PoweredUp),
        });
        self.torque = restart.torque && !sto.pulses_off;
        self.held = arbiter.stop >= Stop::A || told.ss1.sto;
        // A message stays until it is acknowledged.
        let mut kept = Messages::default();
        if acknowledged.event {
            kept = kept.and(self.messages.of(false));
        }
        if basic.entered {
            kept = kept.and(self.messages.of(true));
        }
        self.messages = kept.and(messages);
        self.shared = Shared {
            position,
            terminal: read.is(Flag::Terminal),
            selected: selection.sto || selection.ss1,
            results: told.results,
            brake_on: brake.on,
        };
        let basic_stop = match basic.stop {
            Latched::None | Latched::F => Stop::None,
            Latched::A => Stop::A,
            Latched::Locked => Stop::Locked,
        };
        let directions = told.setpoint.map(|s| [s.positive, s.negative]);
        Said {
            position: position.0,
            speed,
            stop: arbiter.stop.max(basic_stop),
            stop_f: arbiter.fault || basic.stop == Latched::F,
            cause: match basic.stop {
                Latched::None => told.cause,
                _ if self.messages.has(Message::Brake) => "the brake does not follow",
                _ => "the terminals differ",
            },
            messages: self.messages,
            sto: sto.shown,
            ss1: told.ss1.active || ss1.active || arbiter.stop == Stop::B,
            ss2: told.ss2.ss2_active || arbiter.stop == Stop::C && arbiter.off3,
            sos: told.sos.active,
            sos_violated: told.sos.violated,
            sos_reference: told.sos_reference.0,
            sls: told.sls.active,
            sls_level: told.sls.level.index(),
            sls_limit: told.sls.limit,
            sls_violated: told.sls.violated,
            sdi: told.sdi.map(|s| s.active),
            slp: told.slp.active,
            slp_second: told.slp_second,
            ssm: told.ssm.below,
            braking_limit: told.braking_limit,
            function: told.function,
            pulses_off: sto.pulses_off,
            off3: arbiter.off3 || told.ss1.off3 || told.ss2.off3 || ss1.off3,
            control_brakes: told.sos.selected
                || arbiter.sos
                || told.ss2.ss2e_active
                || matches!(arbiter.stop, Stop::D | Stop::E)
                || told.ss1.active
                || ss1.active,
            inhibited: arbiter.setpoint_zero || told.ss2.inhibited,
            torque: self.torque,
            setpoint: told.setpoint.map_or(Speed(u32::MAX), |s| s.absolute),
            directions,
            brake_open: brake.open,
            valid: self.valid,
            event: acknowledged.event,
        }
    }

    /// The Basic Functions, in their own cycle.
    fn basic(
        &mut self,
        values: &Values,
        bits: &Read,
        other: &Shared,
        edge: bool,
    ) -> (
        basic_selection::Outputs,
        ss1_basic::Outputs,
        basic_stop::Outputs,
        bool,
    ) {
        let basic = &mut self.basic;
        let immediate = values.ss1_basic.time == Cycles::ZERO;
        let general = bits.is(Flag::General);
        let mut said = Default::default();
        for _ in 0..values.basic_cycles {
            let selection = basic.selection.step(&basic_selection::Inputs {
                terminal: bits.is(Flag::Terminal),
                sto: bits.is(Flag::Sto),
                // SS1 of the Extended Functions is another one, and without p9652 there is none.
                ss1: bits.is(Flag::Ss1) || values.extended.is_some() || immediate,
            });
            let ss1 = basic.ss1.step(&ss1_basic::Inputs {
                selected: selection.ss1,
                sto: selection.sto || basic.stop.state().stop >= Latched::A,
            });
            let own = bits.is(Flag::Terminal);
            let differ = basic.terminals.as_mut().is_some_and(|terminals| {
                let said = terminals.step(&terminal_pair::Inputs {
                    power_on: false,
                    own,
                    other: other.terminal,
                    held: self.held,
                    acknowledge: general || edge,
                });
                // Terminals that agree again are no cause any more.
                said.fault && own != other.terminal
            });
            let stop = basic.stop.step(&basic_stop::Inputs {
                power_on: false,
                difference: differ,
                fault: self.brake_defect,
                locking: false,
                selected: selection.sto || selection.ss1 || other.selected,
                acknowledge: general,
                internal_event_ack: edge,
            });
            said = (selection, ss1, stop, differ);
        }
        said
    }

    /// The brake: open while there is torque, and both channels say so.
    fn brake(&mut self, read: &Read, sto: &sto::Outputs, other: &Shared) -> sbc::Outputs {
        let Some(sbc) = &mut self.sbc else {
            return sbc::Outputs::default();
        };
        let on = !sto.pulses_off && self.torque;
        let said = sbc.step(&sbc::Inputs {
            sto: sto.pulses_off,
            fault: false,
            other_fault: false,
            open: self.torque,
            other_on: other.brake_on,
            feedback: on != read.is(Flag::BrakeFault),
        });
        self.brake_defect = said.defect;
        said
    }
}

/// Both channels of a drive. Each hears of the other one what it told in the cycle before.
pub(super) struct Pair {
    values: Values,
    channels: [Channel; 2],
}

impl Pair {
    /// At POWER ON, or running.
    pub(super) fn new(values: &Values, running: bool, read: &[Read; 2]) -> Self {
        Self {
            channels: [0, 1].map(|side| Channel::new(values, running, &read[side])),
            values: values.clone(),
        }
    }

    /// One cycle.
    pub(super) fn step(&mut self, read: &[Read; 2]) -> [Said; 2] {
        let [first, second] = [0, 1].map(|side| self.channels[side].shared);
        let others = [second, first];
        [0, 1].map(|side| {
            let channel = &mut self.channels[side];
            channel.step(&self.values, &read[side], &others[side])
        })
    }
}
