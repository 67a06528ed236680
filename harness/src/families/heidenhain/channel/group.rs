//! The groups of a channel: the kernel of each, what the other groups make of it, and what the safe PLC asks of it.

use stillpoint_machine::Machine;
use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Stop};
use stillpoint_monitors::heidenhain::{agreement, axis_release, channel, gate, group, neighbour};

use super::{Before, Channel, unit};
use crate::families::heidenhain::names::Bit;
use crate::families::heidenhain::values;

/// The kernel of one group.
pub(super) struct Group {
    pub(super) kind: Kind,
    pub(super) axes: Vec<usize>,
    pub(super) kernel: channel::Monitor,
    pub(super) window: agreement::Monitor,
    /// The channels have differed for the whole window.
    pub(super) late: bool,
    pub(super) said: channel::Outputs,
    /// The code of `PP_AxGrpStopReq` in this cycle.
    pub(super) asked: u8,
    /// Why the stop in force is there.
    pub(super) cause: &'static str,
}

impl Group {
    /// Without torque, or at rest where the machine runs already.
    pub(super) fn new(
        kind: Kind,
        axes: Vec<usize>,
        config: channel::Config,
        running: bool,
    ) -> Self {
        let rest = match kind {
            _ if !running => GroupState::Sto,
            Kind::Spindle => GroupState::StoO,
            Kind::NcAxes | Kind::Auxiliary => GroupState::Sos,
        };
        let state = channel::State {
            group: group::State {
                state: rest,
                ..group::State::INITIAL
            },
            ..channel::State::INITIAL
        };
        Self {
            kind,
            axes,
            kernel: channel::Monitor::resume(config, state)
                .unwrap_or_else(|_| channel::Monitor::new(config)),
            window: agreement::Monitor::new(agreement::Config::PUBLISHED),
            late: false,
            said: channel::Outputs {
                // Nothing is known of the other channel in the first cycle of a machine that runs: the own request counts.
                taken: gate::Outputs {
                    request: if running {
                        GroupState::Auto
                    } else {
                        GroupState::Sto
                    },
                    ..gate::Outputs::default()
                },
                group: group::Outputs {
                    state: rest,
                    ..group::Outputs::default()
                },
                torque_off: rest != GroupState::Sos,
                ..channel::Outputs::default()
            },
            asked: 0,
            cause: "",
        }
    }
}

impl Channel {
    /// A cycle of a group.
    pub(super) fn step_group(
        &mut self,
        g: usize,
        machine: &Machine,
        before: &Before,
        main_switch: bool,
    ) {
        let group = &self.groups[g];
        let own = &before.groups[self.side];
        let peer = &before.groups[1 - self.side][g];
        let axes = || group.axes.iter().map(|k| &self.axes[*k].said);
        let found = axes().map(|said| said.demand).max_by_key(|(stop, _)| *stop);
        let (monitors, why) = found.unwrap_or((Stop::None, ""));
        let spread = self.spread(g, machine, own);
        let emergency = if self.read.is(Bit::Es) {
            Stop::None
        } else {
            Stop::Ss1
        };
        let voltage = self.said.voltage.demand;
        let late = group.late;
        let fields = self.fields(g);
        let listed_still = (0..self.groups.len())
            .filter(|other| values::lists(machine, g, *other))
            .all(|other| self.still(other));
        let inputs = channel::Inputs {
            main_switch,
            fields,
            peer: peer.taken,
            late,
            moving: axes().any(|said| said.moving),
            unit: unit(&self.read),
            gen_safe: self.read.is(Bit::GenSafe),
            untested: axes().any(|said| said.reference.untested),
            monitors,
            told: peer.tells,
            machine: spread.max(emergency).max(voltage),
            at_rest: group.said.group.may_move
                && axes().any(|said| said.release.stands)
                && axes().all(|said| said.release.mode == axis_release::Mode::Sos),
            listed_still,
            peer_off: peer.stop.torque_off,
            permit: self.read.is(Bit::Permit),
            voltage: self.said.voltage.sto_a_g,
            spindle_stop: false,
        };
        let asked = Stop::from_code(fields.stop_code).unwrap_or(Stop::None);
        let late = if inputs.late { Stop::Ss1 } else { Stop::None };
        let causes = [
            (emergency, "emergency stop"),
            (monitors, why),
            (voltage, "control voltage"),
            (late, "the channels differ"),
            (asked, "asked for by the safe PLC"),
            (spread, "stop of another group"),
            (peer.tells, "told by the other channel"),
        ];
        let group = &mut self.groups[g];
        group.asked = fields.stop_code;
        let was = group.said.stop.level;
        group.said = group.kernel.step(&inputs);
        let differ = group.said.differ;
        group.late = group.window.step(&agreement::Inputs { differ }).fault;
        let level = group.said.stop.level;
        if level != was {
            let first = causes.into_iter().find(|(stop, _)| *stop == level);
            group.cause = match first {
                _ if level == Stop::None => "",
                Some((_, words)) => words,
                None if group.said.demand == level => "mode, permissive or request",
                None => "the stop before has not ended in its time",
            };
        }
    }

    /// What the other groups make of one.
    fn spread(&self, own: usize, machine: &Machine, said: &[channel::Outputs]) -> Stop {
        let others = said.iter().enumerate().filter(|(g, _)| *g != own);
        let demands = others.map(|(g, other)| {
            let inputs = neighbour::Inputs {
                level: other.stop.level,
                phase: other.stop.phase,
                wide: other.stop.wide,
            };
            let listed = values::lists(machine, g, own);
            let demand = neighbour::Config::new(listed).map_or(Stop::Ss1F, |config| {
                neighbour::next(neighbour::State, &config, &inputs).1.demand
            });
            match other.stops_axes && self.groups[own].kind == Kind::NcAxes {
                true => demand.max(Stop::Ss2),
                false => demand,
            }
        });
        demands.fold(Stop::None, Stop::max)
    }

    /// Whether no axis of a group moves.
    fn still(&self, group: usize) -> bool {
        let mut axes = self.groups[group].axes.iter();
        axes.all(|k| !self.axes[*k].said.moving)
    }

    /// What the safe PLC asks for a group; a higher stop may be read beside it.
    fn fields(&self, group: usize) -> gate::Inputs {
        let Group { kind, axes, .. } = &self.groups[group];
        let role = match kind {
            Kind::NcAxes => 'a',
            Kind::Spindle => 's',
            Kind::Auxiliary => 't',
        };
        let field = |name: &str, first: GroupState| {
            let value = self.program.output(&format!("{name}_{role}"), first as i64);
            u8::try_from(value).unwrap_or(u8::MAX)
        };
        let asked = axes.iter().filter_map(|k| self.read.axes[*k].stop).max();
        let nothing = GroupState::Auto;
        gate::Inputs {
            state_code: field("request", GroupState::Sto),
            stop_code: field("stop", nothing).max(asked.unwrap_or(0)),
            som_code: self.said.som.som as u8,
            activate: field("activate", nothing) != 0,
            permissive: field("pb", nothing) != 0,
        }
    }
}
