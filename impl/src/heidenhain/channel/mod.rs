//! One channel for one axis group: everything its kernel does in a cycle, in the order of the manual's response.
//!
//! Take-over of the requests and joining with those of the other channel; start-up protection and judgement with the
//! monitoring state valid at the start of the cycle; all causes of the cycle together; the stop; the monitoring state
//! (HFS-STOP-009). The monitors of single axes (speed, standstill, paths, comparison, feed enable) step before it and hand in
//! what they demand.
//!
//! The permission to switch the drives on is remembered from its edge until the control voltage is on: the contacts of the
//! chain may take 200 ms longer than the key is pressed. An edge counts only after torque off, while nothing of rank SS1 is
//! asked for.

use crate::heidenhain::types::{GroupState, Kind, Phase, Som, Stop, Unit};
use crate::heidenhain::{both_channels, gate, group, judge, report, startup, stop};
use crate::kernel::{ConfigError, Cycles};

mod laws;

pub use laws::*;

config! {
    /// The configurations of the monitors.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        gate: gate::Config,
        both: both_channels::Config,
        startup: startup::Config,
        judge: judge::Config,
        stop: stop::Config,
        report: report::Config,
        group: group::Config,
    }
    accepted |config| {
        let Config { gate, both, startup, judge, stop, report, group } = config;
        let parts = gate.accepted() && both.accepted() && startup.accepted() && judge.accepted();
        parts && stop.accepted() && report.accepted() && group.accepted()
            && gate.kind() == group.kind() && judge.kind() == group.kind()
    }
}

impl Config {
    /// `kind`: what the group consists of. `som_4`: SMP560 bit 0. `stop`: the times and the channel. `t_idle`: the time of the
    /// start-up protection.
    ///
    /// # Errors
    /// Those of [`startup::Config::new`].
    pub fn new(
        kind: Kind,
        som_4: bool,
        stop: stop::Config,
        t_idle: Cycles,
    ) -> Result<Self, ConfigError> {
        Ok(Self {
            gate: gate::Config::new(kind)?,
            both: both_channels::Config::new()?,
            startup: startup::Config::new(t_idle)?,
            judge: judge::Config::new(kind, som_4)?,
            stop,
            report: report::Config::new()?,
            group: group::Config::new(kind)?,
        })
    }

    /// What the group consists of.
    pub const fn kind(&self) -> Kind {
        self.gate.kind()
    }

    /// The times of the stops.
    pub const fn stop(&self) -> &stop::Config {
        &self.stop
    }

    /// The start-up protection.
    pub const fn startup(&self) -> &startup::Config {
        &self.startup
    }

    /// The monitoring state.
    pub const fn group(&self) -> &group::Config {
        &self.group
    }
}

fields! {
    /// The states of the monitors, and what is known of the drive permission.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// Start-up protection.
        pub startup: startup::State,
        /// Judgement.
        pub judge: judge::State,
        /// Stop.
        pub stop: stop::State,
        /// Monitoring state.
        pub group: group::State,
        /// `PP_AxGrpPermitDrvOn` in the cycle before.
        pub permitted: bool,
        /// Its edge has come since torque off, and nothing has spoilt it.
        pub fresh: bool,
    }
}

impl State {
    /// Torque off; a permission that is already on gives no edge.
    pub const INITIAL: Self = Self {
        startup: startup::State::INITIAL,
        judge: judge::State::INITIAL,
        stop: stop::State::INITIAL,
        group: group::State::INITIAL,
        permitted: true,
        fresh: false,
    };

    /// Every monitor is consistent; what the stop has switched off is off; an edge is kept in torque off only.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let off = matches!(self.group.state, GroupState::Sto | GroupState::StoO);
        self.startup.invariant(&config.startup)
            && self.judge.invariant(&config.judge)
            && self.stop.invariant(&config.stop)
            && self.group.invariant(&config.group)
            && (self.stop.phase != Phase::TorqueOff || off)
            && (!self.fresh || off)
    }
}

impl Default for State {
    fn default() -> Self {
        Self::INITIAL
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub main_switch: bool,
        /// The fields that this channel's safe PLC has set.
        pub fields: gate::Inputs,
        /// What the other channel has taken over ([`Outputs::taken`] of it).
        pub peer: gate::Outputs,
        /// The channels have differed for longer than the window.
        pub late: bool,
        /// An axis of the group moves (`NN_AxGrpInMotion`).
        pub moving: bool,
        /// The machine operating mode.
        pub unit: Unit,
        /// `NN_GenSafe`: the self-test has passed and is not overdue.
        pub gen_safe: bool,
        /// An axis that is not checked moves with the door open outside the reference mode.
        pub untested: bool,
        /// The highest stop that the monitors of this channel demand for the group; an SS1 among them concerns the machine.
        pub monitors: Stop,
        /// What the other channel tells of the group ([`Outputs::tells`] of it).
        pub told: Stop,
        /// The highest of what the other groups make of this one ([`crate::heidenhain::neighbour`]), and the emergency stop.
        pub machine: Stop,
        /// The last axis has come to rest after it lost its feed enable.
        pub at_rest: bool,
        /// The groups that SMP610 lists for this one stand still, or none is listed.
        pub listed_still: bool,
        /// The other channel has reported torque off.
        pub peer_off: bool,
        /// `PP_AxGrpPermitDrvOn`: the drives of the group may be switched on.
        pub permit: bool,
        /// -STO.A.G is on: control voltage, with the contact chain closed before.
        pub voltage: bool,
        /// The SS2 came from the spindle-stop key, and SMP549 asks for SOS.
        pub spindle_stop: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// What was taken over from this channel's safe PLC, for the other channel.
        pub taken: gate::Outputs,
        /// The channels differ in what they were asked for.
        pub differ: bool,
        /// The mode that this channel's safe PLC has selected.
        pub som: Som,
        /// The highest cause of the cycle.
        pub demand: Stop,
        /// SS2 of the axis groups of the working space.
        pub stops_axes: bool,
        /// The stop of the group.
        pub stop: stop::Outputs,
        /// What the other channel is told: the stop that runs, and the causes that this channel finds.
        pub tells: Stop,
        /// The monitoring state of the group.
        pub group: group::Outputs,
        /// The group has no torque in this channel: a stop has taken it, or its state is STO or STO_O.
        pub torque_off: bool,
        /// Its brakes are closed by this channel.
        pub brake_closed: bool,
    }
}

/// The causes that this channel finds outside the group's own requests.
fn found(inputs: &Inputs) -> Stop {
    inputs.monitors.max(inputs.machine)
}

/// Those, and what the other channel tells.
fn causes(inputs: &Inputs) -> Stop {
    found(inputs).max(inputs.told)
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.main_switch {
        State::INITIAL
    } else {
        state
    };
    let (_, taken) = gate::next(gate::State::INITIAL, &config.gate, &inputs.fields);
    let joined = join(config, inputs, taken);
    let (startup, protection) = startup::next(
        before.startup,
        &config.startup,
        &startup::Inputs {
            limited: before.group.state.is_limited(),
            moving: inputs.moving,
            unit: inputs.unit,
            permissive: joined.held,
        },
    );
    let (judge, judged) = judge::next(
        before.judge,
        &config.judge,
        &judge::Inputs {
            main_switch: inputs.main_switch,
            request: joined.request,
            stop_request: joined.stop,
            bad_code: false,
            state: before.group.state,
            moving: inputs.moving,
            unit: inputs.unit,
            permissive: joined.held,
            idle: protection.idle,
            gen_safe: inputs.gen_safe,
            untested: inputs.untested,
        },
    );
    let demand = judged.demand.max(causes(inputs));
    let fresh = fresh(before, inputs, demand);
    let restart = fresh && inputs.voltage;
    let (stop, stopped) = stop::next(
        before.stop,
        &config.stop,
        &stop::Inputs {
            main_switch: inputs.main_switch,
            demand,
            wide_cause: judged.asks_ss1
                || inputs.late
                || inputs.monitors >= Stop::Ss1
                || inputs.machine >= Stop::Ss1,
            still: !inputs.moving,
            listed_still: inputs.listed_still,
            peer_off: inputs.peer_off,
            restart,
        },
    );
    let (group, grouped) = group::next(
        before.group,
        &config.group,
        &group::Inputs {
            main_switch: inputs.main_switch,
            request: joined.request,
            activate: joined.starts,
            moving: inputs.moving,
            gen_safe: inputs.gen_safe,
            demand,
            phase: stop.phase,
            soft: stopped.keeps_enable,
            ss2_ended: stopped.ss2_ended || (inputs.at_rest && !inputs.moving),
            switch_on: restart,
            spindle_stop: inputs.spindle_stop,
        },
    );
    let (_, report) = report::next(
        report::State::INITIAL,
        &config.report,
        &report::Inputs {
            level: stop.level,
            phase: stop.phase,
            found: judged.demand.max(found(inputs)),
        },
    );
    let off = matches!(group.state, GroupState::Sto | GroupState::StoO);
    let after = State {
        startup,
        judge,
        stop,
        group,
        permitted: inputs.permit,
        fresh: fresh && off && !restart,
    };
    let outputs = Outputs {
        taken,
        differ: joined.differ,
        som: taken.som,
        demand,
        stops_axes: judged.stops_axes,
        stop: stopped,
        tells: report.told,
        group: grouped,
        torque_off: stopped.torque_off || off,
        brake_closed: stopped.brake_closed || off,
    };
    (after, outputs)
}

/// What both channels were asked for, with this one's fields in its own place.
fn join(config: &Config, inputs: &Inputs, own: gate::Outputs) -> both_channels::Outputs {
    let (mc, cc) = if config.stop.is_cc() {
        (inputs.peer, own)
    } else {
        (own, inputs.peer)
    };
    let inputs = both_channels::Inputs {
        request_mc: mc.request,
        request_cc: cc.request,
        stop_mc: mc.stop,
        stop_cc: cc.stop,
        starts_mc: mc.starts,
        starts_cc: cc.starts,
        held_mc: mc.held,
        held_cc: cc.held,
        late: inputs.late,
    };
    let (_, joined) = both_channels::next(both_channels::State::INITIAL, &config.both, &inputs);
    joined
}

/// An edge of the drive permission has come since the group has lost its torque, and no cause of rank SS1 is there.
fn fresh(before: State, inputs: &Inputs, demand: Stop) -> bool {
    let off = matches!(before.group.state, GroupState::Sto | GroupState::StoO)
        && matches!(before.stop.phase, Phase::Run | Phase::TorqueOff);
    let edge = inputs.permit && !before.permitted;
    off && demand < Stop::Ss1D && (before.fresh || edge)
}
