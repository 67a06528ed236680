//! One channel of a drive: the Basic Functions in their cycle, the Extended ones in theirs, acknowledgement, and what the drive may do. And the
//! pair of them.

use stillpoint_monitors::kernel::{Distance, Position, Speed};
use stillpoint_monitors::sinamics::basic_stop::Latched;
use stillpoint_monitors::sinamics::cross_check::Results;
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::{acknowledgement, acknowledgement_edge, restart, sbc, sto};

use super::bare::{self, Bare};
use super::basic::Basic;
use super::functions::{Functions, Seen};
use super::link::{self, Link};
use super::messages::{Message, Messages};
use super::said::Said;
use super::service::{self, Service};
use super::signals::{Flag, Number, Read};
use super::values::Values;

/// What a channel hears of the other one, a cycle later.
#[derive(Clone, Copy, Default)]
pub(super) struct Shared {
    position: Position,
    pub terminal: bool,
    /// STO or SS1 of the Basic Functions is selected.
    pub selected: bool,
    results: Results,
    brake_on: bool,
    /// The user agreement.
    agrees: bool,
    /// The reaction of a stop runs.
    reacts: bool,
    /// Its switch-off path has suppressed the pulses.
    path_off: bool,
}

/// A channel.
struct Channel {
    /// This is channel 2.
    second: bool,
    basic: Basic,
    functions: Option<Functions>,
    bare: Option<Bare>,
    service: Service,
    link: Link,
    edge: acknowledgement_edge::Monitor,
    reselection: acknowledgement_edge::Monitor,
    acknowledgement: acknowledgement::Monitor,
    sto: sto::Monitor,
    sbc: Option<sbc::Monitor>,
    restart: restart::Monitor,
    torque: bool,
    /// The Extended Functions keep the pulses off: terminals that differ are no fault.
    held: bool,
    brake_defect: bool,
    /// A stop of the Basic Functions has come of the communication.
    silent: bool,
    /// The pulses were to be suppressed in the cycle before, and the switch-off path of this channel has not done it.
    path_error: bool,
    messages: Messages,
    /// The value of C01711.
    value: u16,
    /// None before the first cycle.
    before: Option<Position>,
    shared: Shared,
}

impl Channel {
    /// At POWER ON, or as after many cycles in which nothing happened and the drive was on.
    fn new(values: &Values, running: bool, second: bool, read: &Read) -> Self {
        let position = Position(read.of(Number::Position));
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
        Self {
            second,
            basic: Basic::new(values, running),
            functions: (values.extended.as_ref())
                .map(|config| Functions::new(config, running.then_some(read))),
            bare: (values.extended.as_ref())
                .and_then(|config| config.bare)
                .map(|config| Bare::new(config, running, position)),
            service: Service::new(values, running),
            link: Link::new(values, running, read),
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
            torque: running,
            held: false,
            brake_defect: false,
            silent: false,
            path_error: false,
            messages: Messages::default(),
            value: 0,
            before: None,
            shared: Shared {
                position,
                terminal: read.is(Flag::Terminal),
                brake_on: running && values.sbc.is_some(),
                ..Shared::default()
            },
        }
    }

    /// POWER ON: what the other channel hears of it is new, too.
    fn power(&mut self, values: &Values, read: &Read) {
        if read.is(Flag::PowerOn) {
            let kept = self.functions.as_ref().map(Functions::again);
            *self = Self::new(values, false, self.second, read);
            self.functions = kept;
        }
    }

    /// One cycle.
    fn step(&mut self, values: &Values, read: &Read, other: &Shared) -> Said {
        let power_on = read.is(Flag::PowerOn);
        let position = Position(read.of(Number::Position));
        let Distance(speed) = self
            .before
            .map_or(Distance(0), |before| position.distance(before));
        let speed = Speed(speed);
        self.before = Some(position);
        let sent = self.link.sent(read);
        let edge = |edge: &mut acknowledgement_edge::Monitor, level| {
            let said = edge.step(&acknowledgement_edge::Inputs {
                power_on: false,
                valid: self.link.valid(),
                stable: true,
                level,
            });
            said.acknowledge
        };
        let selected = Basic::selects(values, &sent);
        let ss1 = values.extended.is_some() && !sent.is(Flag::Ss1);
        let reselected = edge(&mut self.reselection, selected || ss1);
        let edge = edge(&mut self.edge, sent.is(Flag::Ack));
        let edges = acknowledgement::Inputs {
            profisafe_edge: edge,
            reselected,
            standard: read.is(Flag::General),
            ..Default::default()
        };
        let acknowledges = edges.acknowledge(&values.acknowledgement);
        let told = self.functions.as_ref().map(Functions::told);
        let (bits, communication) = self.link.bits(
            values,
            sent,
            &link::Seen {
                fresh: read.is(Flag::Telegram),
                torque: self.torque,
                undelayed: told.is_some_and(|told| told.undelayed),
                acknowledge: acknowledges,
            },
        );
        // The Extended Functions have a stop of their own for it; without them it is F01611 (5.5.1).
        let silent = communication.fault && !communication.valid && values.extended.is_none();
        let (held, defect) = (self.held, self.brake_defect);
        let (selection, ss1, basic, terminals) =
            (self.basic).step(values, &bits, other, edge, [held, defect, silent]);
        let ss1_selected = values.extended.is_some() && !bits.is(Flag::Ss1);
        let any = selection.sto || selection.ss1 || ss1_selected;
        let switches = matches!(
            self.restart.state().phase,
            restart::Phase::Ready | restart::Phase::Run
        );
        let (bare, position, speed) = match (&mut self.bare, &values.extended) {
            (Some(bare), Some(extended)) => bare.step(
                &bits,
                &bare::Seen {
                    position,
                    sto: selection.sto || ss1.sto,
                    pulses: self.torque,
                    // An ON of a drive that is inhibited from switching on is none (4.1.1).
                    on: read.is(Flag::On) && switches,
                    shutdown: extended.shutdown,
                },
            ),
            _ => (bare::Told::default(), position, speed),
        };
        // Without an encoder, while the start phase lasts, and with one that has failed the speed may be any.
        let encoder_fault = read.is(Flag::EncoderFault);
        let unknown = encoder_fault || self.bare.is_some() && self.torque && !bare.known;
        let own = self.shared.results;
        let mut heard = other.results;
        if acknowledges {
            // A stop that one channel alone has latched is a difference by itself, and nothing could ever acknowledge it.
            (heard.stop, heard.sos) = (own.stop, own.sos);
        }
        let seen = Seen {
            position,
            speed,
            sto: selection.sto,
            ss1: ss1_selected,
            basic_ss1: ss1.active && !ss1.sto,
            basic_sto: ss1.sto,
            drive_on: self.torque,
            unknown,
            tolerated: terminals.tolerated,
            encoder_fault,
            communication: communication.request,
            positions: [self.shared.position, other.position],
            results: [own, heard],
            other_agrees: other.agrees,
            second: self.second,
            wrong: bare.wrong,
            acknowledges,
        };
        let mut messages = Messages::default()
            .with(Message::BasicF, terminals.fault || silent)
            .with(Message::Brake, self.brake_defect)
            .with(Message::Crosscheck, bare.no_current);
        let raised = self.functions.as_mut().map(|f| f.watch(&bits, &seen));
        let cause = raised.is_some_and(|r| r.request != Stop::None || r.difference);
        // The message of a stop stays as long as the stop, which comes to its end in both channels first.
        let reacts = self.reacts() || other.reacts;
        let acknowledged = self.acknowledgement.step(&acknowledgement::Inputs {
            message: cause || bare.no_current || raised.is_some_and(|r| r.notice),
            cause: cause || reacts,
            ..edges
        });
        let told = match (&mut self.functions, &raised) {
            (Some(functions), Some(raised)) => {
                *functions.arbitrate(&bits, &seen, raised, acknowledged.acknowledge && !reacts)
            }
            _ => Default::default(),
        };
        let arbiter = &told.arbiter;
        messages = messages
            .and(told.messages)
            .with(Message::BasicA, basic.stop >= Latched::A);
        let stop_a = arbiter.stop >= Stop::A || basic.pulses_off;
        let ss1_ended = ss1.sto || told.ss1.sto;
        let off = selection.sto || ss1_ended || stop_a;
        let functions = matches!(
            told.function,
            Function::Ss1 | Function::Ss2 | Function::Ss2e | Function::Sos
        );
        let service = self.service.step(
            values,
            read,
            &service::Seen {
                power_on,
                position,
                speed,
                selected: any,
                off: off || bare.internal,
                stops: arbiter.stop != Stop::None || ss1.active || functions || basic.entered,
                held: self.held,
                pulses: self.torque,
                paths_off: [self.shared.path_off, other.path_off],
                path_error: self.path_error,
                valid: self.link.valid(),
            },
        );
        messages = messages.with(Message::BrakeTestInterrupted, service.brake.interrupted);
        let sto = self.sto.step(&sto::Inputs {
            powered_up: read.is(Flag::PoweredUp),
            selected: selection.sto,
            ss1_ended,
            stop_a,
            test_stop: service.tests,
            internal: bare.internal,
            ..Default::default()
        });
        let brake = self.brake(read, &sto, other, !service.brake.close_motor);
        // Without selection ON itself ends the suppression (4.2.9.3): it inhibits nothing from switching on.
        let unselected = self.bare.as_ref().is_some_and(Bare::unselected);
        let inhibits = off || service.tests || bare.internal && !unselected;
        // OFF1 brakes: the pulses go off when the axis stands.
        let off1 = self.torque && !read.is(Flag::On) && (unknown || speed != Speed(0));
        let restart = self.restart.step(&restart::Inputs {
            power_on: false,
            sto: inhibits || !self.sto.state().started,
            latched: arbiter.blocks_run || basic.entered,
            on: read.is(Flag::On) || off1,
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
        // Those of the brake test too, once it is deselected.
        if !edge || read.is(Flag::BrakeTest) {
            kept = kept.and(self.messages.of_brake_test());
        }
        self.messages = kept
            .and(messages)
            .with(Message::TestStop, service.due)
            .with(Message::PathTest, service.path_due);
        let value = match bare.no_current {
            true => 1_041,
            false => raised.map_or(0, |r| r.value),
        };
        self.value = match self.messages.has(Message::Crosscheck) {
            true if value == 0 => self.value,
            true => value,
            false => 0,
        };
        self.shared = Shared {
            position,
            terminal: read.is(Flag::Terminal),
            selected: selection.sto || selection.ss1,
            results: told.results,
            brake_on: brake.on,
            agrees: read.is(Flag::Agrees),
            path_off: sto.pulses_off && !read.is(Flag::PathFault),
            reacts: self.reacts(),
        };
        self.silent = silent || self.silent && basic.stop != Latched::None;
        self.path_error = sto.pulses_off && read.is(Flag::PathFault);
        let basic_stop = match basic.stop {
            Latched::None | Latched::F => Stop::None,
            Latched::A => Stop::A,
            Latched::Locked => Stop::Locked,
        };
        // An internal STOP D is told as SS2E, and D and E as a selection of SOS: the control has to brake (4.5.2, 9.3).
        let ss2e = told.ss2.ss2e_active || arbiter.stop == Stop::D;
        let sos_selected = told.sos.selected || matches!(arbiter.stop, Stop::D | Stop::E);
        // In the acceptance test mode the setpoint acts again once the axis stands in SOS.
        let moves = told.mode.setpoint_enabled && arbiter.stop <= Stop::C;
        let directions = told.setpoint.map(|s| [s.positive, s.negative]);
        Said {
            position: position.0,
            speed,
            stop: arbiter.stop.max(basic_stop),
            stop_f: arbiter.fault || basic.stop == Latched::F,
            cause: match basic.stop {
                Latched::None => told.cause,
                _ if self.messages.has(Message::Brake) => "the brake does not follow",
                _ if self.silent => "no valid telegram",
                _ => "the terminals differ",
            },
            messages: self.messages,
            sto: sto.shown,
            ss1: told.ss1.active || ss1.active || arbiter.stop == Stop::B,
            ss2: told.ss2.ss2_active || arbiter.stop == Stop::C && arbiter.off3,
            ss2e,
            sos: told.sos.active,
            sos_selected,
            sos_violated: told.sos.violated,
            sos_reference: told.sos_reference.0,
            sls: told.sls.active,
            sls_level: told.sls.level.index(),
            sls_limit: told.sls.limit,
            sls_violated: told.sls.violated,
            sdi: told.sdi.map(|s| s.active),
            slp: told.slp.active,
            slp_second: told.slp_second,
            slp_kept: told.slp_kept,
            reference: told.reference,
            gear: told.gear,
            transferred: told.transferred,
            ssm: told.ssm.below,
            braking_limit: told.braking_limit,
            function: told.function,
            pulses_off: self.shared.path_off,
            esr: communication.esr || arbiter.esr,
            off3: arbiter.off3 || told.ss1.off3 || told.ss2.off3 || ss1.off3,
            control_brakes: (sos_selected || arbiter.sos || ss2e) && !moves
                || told.ss1.active
                || ss1.active
                || off1
                || service.brake.own_setpoint,
            inhibited: (arbiter.setpoint_zero || told.ss2.inhibited) && !moves,
            torque: self.torque,
            setpoint: told.setpoint.map_or(Speed(u32::MAX), |s| s.absolute),
            directions,
            brake_open: brake.open,
            valid: self.link.valid(),
            event: acknowledged.event || basic.entered,
            value: self.value,
            bare,
            service,
        }
    }

    /// Whether the reaction of a stop runs.
    fn reacts(&self) -> bool {
        self.functions.as_ref().is_some_and(|f| f.reacts())
    }

    /// The brake: open while there is torque and no test closes it, and both channels say so.
    fn brake(
        &mut self,
        read: &Read,
        sto: &sto::Outputs,
        other: &Shared,
        open: bool,
    ) -> sbc::Outputs {
        let Some(sbc) = &mut self.sbc else {
            return sbc::Outputs::default();
        };
        let open = open && self.torque;
        let on = !sto.pulses_off && open;
        let said = sbc.step(&sbc::Inputs {
            sto: sto.pulses_off,
            fault: false,
            other_fault: false,
            open,
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
            channels: [0, 1].map(|side| Channel::new(values, running, side == 1, &read[side])),
            values: values.clone(),
        }
    }

    /// One cycle.
    pub(super) fn step(&mut self, read: &[Read; 2]) -> [Said; 2] {
        for (channel, read) in self.channels.iter_mut().zip(read) {
            channel.power(&self.values, read);
        }
        let [first, second] = [0, 1].map(|side| self.channels[side].shared);
        let others = [second, first];
        [0, 1].map(|side| {
            let channel = &mut self.channels[side];
            channel.step(&self.values, &read[side], &others[side])
        })
    }
}
