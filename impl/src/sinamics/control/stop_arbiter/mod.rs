//! Arbitration of the stop responses of one drive with Extended Functions: STOP A to E with their timers, STOP F beside them.
//!
//! The highest stop is latched until it is acknowledged. What the drive does is the higher of the stop and of the active
//! safety function by table 9-3: a stop that the function covers is latched, but the function's ramp and timer go on. STOP F
//! has no reaction; when its time is up while something is monitored, it is STOP B.
//!
//! A covered STOP B still becomes STOP A when its time is up, so that its end never depends on the function. Where a covered stop
//! is uncovered before, its own reaction begins.
//!
//! Readings: AC-04 GUARD_ANY_MONITOR, AC-06, AC-18, AC-23 F_PARALLEL, AC-26 PEND_BLOCKS_RUN, AF-29 STOPB_TIMER.

use crate::kernel::{ConfigError, Cycles};

use crate::sinamics::level::{Function, Stop};

config! {
    /// Times in monitoring cycles (p9500). 0 means at once.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) t_b: Cycles,
        pub(crate) t_c: Cycles,
        pub(crate) t_d: Cycles,
        pub(crate) t_e: Cycles,
        pub(crate) t_f: Cycles,
        pub(crate) external: bool,
        pub(crate) hysteresis: bool,
    }
}

impl Config {
    /// The times of STOP B to A (p9556), of STOP C, D and E to SOS (p9552, p9553, p9554), of STOP F to B (p9555); whether SS1 is
    /// braked externally (p9507.3); whether SSM has a hysteresis (p9501.16), which makes it a monitored function
    /// (S120-STOP-508, S120-STOP-506).
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] when one is above [`LONGEST`].
    pub fn new(
        t_b: Cycles,
        t_c: Cycles,
        t_d: Cycles,
        t_e: Cycles,
        t_f: Cycles,
        external: bool,
        hysteresis: bool,
    ) -> Result<Self, ConfigError> {
        Ok(Self {
            t_b: t_b.at_most(LONGEST)?,
            t_c: t_c.at_most(LONGEST)?,
            t_d: t_d.at_most(LONGEST)?,
            t_e: t_e.at_most(LONGEST)?,
            t_f: t_f.at_most(LONGEST)?,
            external,
            hysteresis,
        })
    }

    /// The time after which the reaction of a stop ends; zero for those that have none.
    pub const fn time(&self, stop: Stop) -> Cycles {
        match stop {
            Stop::B => self.t_b,
            Stop::C => self.t_c,
            Stop::D => self.t_d,
            Stop::E => self.t_e,
            Stop::None | Stop::A | Stop::Locked => Cycles::ZERO,
        }
    }
}

/// The longest time: ten minutes in the shortest monitoring cycle of 0.5 ms, above what the functions' delays can be set to.
pub const LONGEST: Cycles = Cycles::new(1_200_000);

fields! {
    /// What becomes of the latched stop.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// No stop.
        #[default]
        Idle,
        /// The active safety function does what the stop asks for, or more.
        Covered,
        /// STOP B to E is being carried out; its timer runs.
        Running,
        /// STOP C, D or E has ended in standstill (SOS).
        Holding,
        /// STOP A: pulses off.
        PulsesOff,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The latched stop.
        pub stop: Stop,
        /// What becomes of it.
        pub phase: Phase,
        /// What is left of its time while it is carried out, and of that of a covered STOP B; else 0.
        pub timer: Cycles,
        /// STOP F is latched.
        pub fault: bool,
        /// What is left until STOP F is STOP B; 0 when its time is up.
        pub fault_timer: Cycles,
    }
}

impl State {
    /// No stop.
    pub const INITIAL: Self = Self {
        stop: Stop::None,
        phase: Phase::Idle,
        timer: Cycles::ZERO,
        fault: false,
        fault_timer: Cycles::ZERO,
    };

    /// Stop, phase and timers belong together.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let phase_fits = match self.phase {
            Phase::Idle => self.stop == Stop::None,
            Phase::Covered => self.stop != Stop::None && self.stop <= Stop::B,
            Phase::Running => self.stop != Stop::None && self.stop <= Stop::B,
            Phase::Holding => self.stop.ends_in_standstill(),
            Phase::PulsesOff => self.stop.cancels_pulses(),
        };
        let timed =
            self.phase == Phase::Running || (self.phase == Phase::Covered && self.stop == Stop::B);
        phase_fits
            && self.timer <= config.time(self.stop)
            && self.timer.is_zero() != timed
            && self.fault_timer <= config.t_f
            && (self.fault || self.fault_timer.is_zero())
            && (self.stop < Stop::B || self.fault_timer.is_zero())
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON: acknowledges everything.
        pub power_on: bool,
        /// The highest stop that a monitor requests now.
        pub request: Stop,
        /// The highest stop whose cause persists; of no effect unless something is acknowledged: what is selected and violated is not
        /// released (S120-SDI-004, S120-SDI-009).
        pub remaining: Stop,
        /// A cross-check finds a difference now (S120-STOP-505), also while SOS is active (S120-SOS-006).
        pub difference: bool,
        /// The safety function that decides.
        pub function: Function,
        /// The actual speed is below the shutdown speed p9560.
        pub standstill: bool,
        /// An effective acknowledgement.
        pub acknowledge: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The latched stop.
        pub stop: Stop,
        /// STOP F is latched.
        pub fault: bool,
        /// Pulses off, brake closed (S120-STOP-500).
        pub pulses_off: bool,
        /// Braking along the OFF3 ramp (S120-STOP-501, S120-STOP-502).
        pub off3: bool,
        /// The setpoint has no effect (S120-ACK-508).
        pub setpoint_zero: bool,
        /// SAM or SBR is in force.
        pub ramp_watched: bool,
        /// SOS is required.
        pub sos: bool,
        /// Extended stop and retract is requested: S_ZSW1B bit 14.
        pub esr: bool,
        /// The stop of which the message "STOP x initiated" is entered in this cycle (S120-STOP-522).
        pub initiated: Stop,
        /// No torque before an acknowledgement, once it is gone (S120-STOP-525).
        pub blocks_run: bool,
    }
}

monitor! { sinamics::stop_arbiter;
    /// STOP A takes the pulses away in the cycle in which it is latched, and until it is acknowledged.
    stop_a_takes_the_pulses_at_once ["S120-STOP-500", "S120-STOP-510", "S120-PC-02"]:
        when |s| s.after.stop.cancels_pulses() || s.outputs.pulses_off
            => s.outputs.pulses_off && s.after.phase == Phase::PulsesOff && s.after.stop >= Stop::A;

    /// Every request is latched, whatever function is active and whatever is acknowledged in the same cycle.
    every_request_is_latched ["S120-STOP-509", "S120-STOP-511", "S120-STOP-521", "S120-ACK-500"]:
        when |s| s.inputs.request != Stop::None
            => s.after.stop >= s.inputs.request;

    /// The level falls only by an acknowledgement whose cause is gone, or by POWER ON.
    level_falls_only_by_acknowledgement ["S120-PC-01", "S120-PC-10", "S120-STOP-501", "S120-STOP-525", "S120-STOP-517"]:
        when |s| s.after.stop < s.before.stop
            => s.inputs.power_on
                || (s.inputs.acknowledge && s.before.phase != Phase::Running && s.before.stop != Stop::Locked && s.inputs.remaining < s.before.stop
                    && s.after.stop >= s.inputs.remaining);

    /// A stop that may not be acknowledged stays until POWER ON.
    locked_stop_stays ["S120-PC-01", "S120-ACK-506"]:
        when |s| s.before.stop == Stop::Locked && !s.inputs.power_on
            => s.after.stop == Stop::Locked && s.outputs.pulses_off;

    /// An acknowledgement clears what has no cause any more, and whose reaction has come to its end.
    acknowledgement_clears ["S120-ACK-503", "S120-STOP-509"]:
        when |s| s.inputs.acknowledge && !s.inputs.power_on && s.before.stop != Stop::Locked
            && s.before.phase != Phase::Running
            && s.inputs.remaining == Stop::None && s.inputs.request == Stop::None && !s.inputs.difference
            => s.after == State::INITIAL && !s.outputs.blocks_run;

    /// The level rises only to what is requested, to B by STOP F, and to A as the end of B.
    level_rises_only_on_request ["S120-STOP-505", "S120-STOP-509", "S120-STOP-520"]:
        when |s| s.after.stop > s.before.stop
            => s.after.stop == s.inputs.request
                || (s.after.stop == Stop::B && s.before.fault && !s.inputs.power_on)
                || (s.after.stop == Stop::B && s.inputs.difference && s.config.t_f.is_zero())
                || (s.after.stop == Stop::A && (s.before.stop == Stop::B || s.inputs.request == Stop::B || s.before.fault
                    || s.inputs.difference));

    /// STOP B ends: in each cycle less of its time is left, whether it is carried out or covered; at the end it is STOP A.
    stop_b_ends_in_time ["S120-PC-03", "S120-STOP-501", "S120-STOP-508", "S120-STOP-520"]:
        when |s| s.before.stop == Stop::B && !s.inputs.power_on
            && (!s.inputs.acknowledge || s.before.phase == Phase::Running)
            => s.after.stop >= Stop::A || (s.after.stop == Stop::B && s.after.timer < s.before.timer);

    /// STOP B is not cut short: before its time is up only standstill ends it, or a request for STOP A.
    stop_b_is_not_cut_short ["S120-STOP-501", "S120-STOP-524"]:
        when |s| s.before.stop == Stop::B && s.before.timer > Cycles::new(1) && !s.inputs.power_on
            && (!s.inputs.acknowledge || s.before.phase == Phase::Running) && s.inputs.request <= Stop::B && (s.config.external || !s.inputs.standstill)
            => s.after.stop == Stop::B;

    /// STOP B of a drive that stands is STOP A at once, unless SS1 is braked externally: then the time alone counts.
    standstill_ends_stop_b ["S120-STOP-501"]:
        when |s| s.after.stop == Stop::B && s.after.phase == Phase::Running
            => s.config.external || !s.inputs.standstill;

    /// STOP C, D and E end in SOS after their time; the speed does not shorten it.
    braking_ends_in_sos ["S120-PC-04", "S120-PC-05", "S120-STOP-502", "S120-STOP-503", "S120-STOP-504", "S120-STOP-508"]:
        when |s| s.before.phase == Phase::Running && s.before.stop.ends_in_standstill() && s.after.stop == s.before.stop
            && !s.inputs.power_on && !s.inputs.function.displaces(s.before.stop)
            => if s.before.timer > Cycles::new(1) {
                s.after.phase == Phase::Running && s.after.timer == s.before.timer.tick()
            } else {
                s.after.phase == Phase::Holding && s.outputs.sos
            };

    /// Standstill that was reached is kept as long as a stop that ends in it.
    standstill_is_kept ["S120-STOP-514", "S120-STOP-516", "S120-PC-32"]:
        when |s| s.before.phase == Phase::Holding && s.after.stop.ends_in_standstill() && !s.inputs.power_on
            && !s.inputs.acknowledge
            => s.after.phase == Phase::Holding && s.outputs.sos;

    /// A request of a class that the running stop has, or of a lower one, neither restarts nor shortens anything.
    equal_requests_restart_nothing ["S120-PC-07", "S120-STOP-524", "S120-STOP-509"]:
        when |s| s.before.phase == Phase::Running && s.inputs.request <= s.before.stop && s.after.stop == s.before.stop
            && !s.inputs.power_on && s.after.phase == Phase::Running
            => s.after.timer == s.before.timer.tick() && s.outputs.initiated == Stop::None;

    /// A stop that the active function covers changes nothing of what the drive does.
    covered_stop_leaves_the_function ["S120-PC-30", "S120-STOP-511", "S120-STOP-512", "S120-STOP-513", "S120-STOP-514",
        "S120-STOP-526"]:
        when |s| s.after.phase == Phase::Covered
            => !s.outputs.pulses_off && !s.outputs.off3 && !s.outputs.sos && !s.outputs.esr
                && s.inputs.function.covers(s.after.stop);

    /// A request that the active function covers is latched, and the function goes on; in standstill it stands.
    covered_request_is_covered ["S120-PC-30", "S120-STOP-511", "S120-STOP-512", "S120-STOP-513", "S120-STOP-514"]:
        when |s| s.inputs.request > s.before.stop && s.inputs.function.covers(s.inputs.request)
            && s.after.stop == s.inputs.request && s.inputs.request <= Stop::B
            => s.after.phase == Phase::Covered || s.after.phase == Phase::Holding;

    /// Where the function does not cover it, a request for more than what is latched begins its own reaction with its whole time;
    /// STOP C, D and E stand at once where they have none, or where standstill is reached in this cycle.
    uncovered_request_begins ["S120-PC-30", "S120-STOP-515", "S120-STOP-513", "S120-STOP-517"]:
        when |s| s.inputs.request > s.before.stop && !s.inputs.function.covers(s.inputs.request)
            && !(s.before.phase == Phase::Holding && s.inputs.request <= Stop::C)
            && s.after.stop == s.inputs.request && s.inputs.request <= Stop::B
            => (s.after.phase == Phase::Running && s.after.timer == s.config.time(s.inputs.request))
                || (s.after.phase == Phase::Holding && (s.config.time(s.inputs.request).is_zero()
                    || (s.before.stop.ends_in_standstill() && s.before.timer <= Cycles::new(1))));

    /// A function of a higher class takes the place of a running stop, which stays latched.
    function_displaces_a_lower_stop ["S120-STOP-517", "S120-STOP-510", "S120-STOP-525"]:
        when |s| s.before.phase == Phase::Running && s.inputs.function.displaces(s.before.stop) && !s.inputs.power_on
            && s.after.stop == s.before.stop
            => s.after.phase == Phase::Covered;

    /// STOP F whose time is up while something is monitored, or C, D or E is latched, is STOP B; with SS1, STO, B or A it is not.
    fault_follows_up ["S120-PC-06", "S120-STOP-505", "S120-STOP-506", "S120-STOP-513", "S120-STOP-514", "S120-STOP-515",
        "S120-STOP-523"]:
        when |s| s.before.fault && s.before.fault_timer <= Cycles::new(1) && !s.inputs.power_on && !s.inputs.acknowledge
            && !s.inputs.function.ends_without_pulses()
            => s.after.stop >= Stop::B
                || !(s.inputs.function.follows_up() || s.config.hysteresis || s.before.stop.ends_in_standstill());

    /// STOP F on its own has no effect but its message.
    fault_alone_does_nothing ["S120-PC-06", "S120-STOP-505", "S120-STOP-506"]:
        when |s| s.after.fault && s.after.stop == Stop::None
            => !s.outputs.pulses_off && !s.outputs.off3 && !s.outputs.setpoint_zero && !s.outputs.sos && s.outputs.fault;

    /// The time of STOP F goes on beside C, D and E, and is not begun again; STO, SS1, STOP B and A end it.
    fault_time_goes_on ["S120-STOP-523", "S120-STOP-512"]:
        when |s| s.before.fault && !s.inputs.power_on && !s.inputs.acknowledge
            => s.after.fault && (s.after.fault_timer == s.before.fault_timer.tick()
                || (s.after.fault_timer.is_zero() && (s.after.stop >= Stop::B || s.inputs.function.ends_without_pulses())));

    /// A difference is latched as STOP F.
    difference_is_latched ["S120-STOP-505"]:
        when |s| s.inputs.difference
            => s.after.fault;

    /// STOP C and B brake along the ramp, which is watched; D and E do not brake. With external braking of SS1 STOP B neither.
    actions_belong_to_the_stop ["S120-STOP-501", "S120-STOP-502", "S120-STOP-503", "S120-STOP-504", "S120-ACK-508", "S120-PC-32"]:
        when |s| s.after.phase == Phase::Running
            => s.outputs.off3 == (s.after.stop == Stop::C || (s.after.stop == Stop::B && !s.config.external))
                && s.outputs.ramp_watched == s.outputs.off3 && s.outputs.setpoint_zero == s.outputs.off3
                && s.outputs.esr == (s.after.stop == Stop::E) && !s.outputs.sos && !s.outputs.pulses_off;

    /// The setpoint stays without effect until STOP C is acknowledged, also while a function covers it; and so with what is above it.
    setpoint_waits_for_the_acknowledgement ["S120-ACK-508"]:
        when |s| s.after.stop >= Stop::C
            => s.outputs.setpoint_zero != (s.after.stop == Stop::B && s.config.external)
                && (s.after.phase != Phase::Holding || (s.outputs.sos && !s.outputs.off3));

    /// A latched stop or STOP F blocks the next start.
    latched_stop_blocks ["S120-STOP-525", "S120-PC-20"]:
        when |s| s.after.stop != Stop::None || s.after.fault
            => s.outputs.blocks_run;

    /// A message is entered exactly when the level rises.
    message_when_the_level_rises ["S120-STOP-522", "S120-STOP-521"]:
        when |s| s.outputs.initiated != Stop::None || (s.after.stop > s.before.stop && !s.inputs.power_on)
            => s.outputs.initiated == s.after.stop && (s.after.stop > s.before.stop || s.inputs.power_on);

    /// POWER ON acknowledges; what is requested in that cycle is latched anew.
    power_on_begins_anew ["S120-ACK-500"]:
        when |s| s.inputs.power_on && !s.inputs.difference
            => !s.after.fault && (s.after.stop == s.inputs.request
                || (s.inputs.request == Stop::B && s.after.stop == Stop::A));

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S120-STOP-509"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.stop == s.after.stop && s.outputs.fault == s.after.fault;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let mut after = acknowledged(before, config, inputs);
    after = advanced(after, config, inputs, before);
    if inputs.request > after.stop {
        after = requested(after, config, inputs.request, inputs.function);
    }
    if followed_up(&mut after, before, config, inputs) && after.stop < Stop::B {
        after = requested(after, config, Stop::B, inputs.function);
    }
    let ended = after.stop == Stop::B
        && (after.timer.is_zero()
            || (after.phase == Phase::Running && inputs.standstill && !config.external));
    if ended {
        after.stop = Stop::A;
        after.phase = Phase::PulsesOff;
        after.timer = Cycles::ZERO;
    }
    let initiated = if after.stop > before.stop {
        after.stop
    } else {
        Stop::None
    };
    if after.stop >= Stop::B || inputs.function.ends_without_pulses() {
        after.fault_timer = Cycles::ZERO;
    }
    (after, outputs(&after, config, initiated))
}

/// What an acknowledgement leaves.
fn acknowledged(mut state: State, config: &Config, inputs: &Inputs) -> State {
    if !inputs.acknowledge || inputs.power_on {
        return state;
    }
    if !inputs.difference {
        state.fault = false;
        state.fault_timer = Cycles::ZERO;
    }
    if state.phase == Phase::Running {
        // SS1 cannot be interrupted (4.2.4), nor can the stops that correspond to it and to SS2.
        return state;
    }
    let left = inputs.remaining.max(inputs.request);
    // While the cause of STOP F persists, what may have followed it stays.
    let follow_up = inputs.difference && state.stop >= Stop::B;
    if state.stop == Stop::Locked || left >= state.stop || follow_up {
        return state;
    }
    let held = state.phase == Phase::Holding;
    state.stop = Stop::None;
    state.phase = Phase::Idle;
    state.timer = Cycles::ZERO;
    if inputs.remaining == Stop::None {
        state
    } else if held && inputs.remaining.ends_in_standstill() {
        state.stop = inputs.remaining;
        state.phase = Phase::Holding;
        state
    } else {
        requested(state, config, inputs.remaining, inputs.function)
    }
}

/// The stop a cycle later: its time, and whether the function still covers it.
fn advanced(mut state: State, config: &Config, inputs: &Inputs, before: State) -> State {
    if state.stop != before.stop {
        // Begun in this cycle by an acknowledgement.
        return state;
    }
    match state.phase {
        Phase::Idle | Phase::Holding | Phase::PulsesOff => state,
        Phase::Running if inputs.function.displaces(state.stop) => {
            state.phase = Phase::Covered;
            state.timer = if state.stop == Stop::B {
                state.timer.tick()
            } else {
                Cycles::ZERO
            };
            state
        }
        Phase::Running => {
            state.timer = state.timer.tick();
            if state.timer.is_zero() && state.stop.ends_in_standstill() {
                state.phase = Phase::Holding;
            }
            state
        }
        Phase::Covered if state.stop == Stop::B => {
            state.timer = state.timer.tick();
            if !inputs.function.covers(Stop::B) {
                state.phase = Phase::Running;
            }
            state
        }
        Phase::Covered => begun(state, config, state.stop, inputs.function),
    }
}

/// The state after a request above the latched stop.
fn requested(mut state: State, config: &Config, request: Stop, function: Function) -> State {
    let held = state.phase == Phase::Holding;
    state.stop = request;
    if held && request.ends_in_standstill() {
        // Standstill is the end of each of them.
        return state;
    }
    begun(state, config, request, function)
}

/// The reaction of a stop begins, unless the function covers it.
fn begun(mut state: State, config: &Config, stop: Stop, function: Function) -> State {
    state.timer = Cycles::ZERO;
    state.phase = if stop.cancels_pulses() {
        Phase::PulsesOff
    } else if function == Function::Sos && stop.ends_in_standstill() {
        Phase::Holding
    } else if function.covers(stop) {
        if stop == Stop::B {
            state.timer = config.t_b;
        }
        Phase::Covered
    } else {
        state.timer = config.time(stop);
        if state.timer.is_zero() && stop.ends_in_standstill() {
            Phase::Holding
        } else {
            Phase::Running
        }
    };
    state
}

/// Advances STOP F: whether it is followed by STOP B now.
fn followed_up(after: &mut State, before: State, config: &Config, inputs: &Inputs) -> bool {
    if after.fault {
        after.fault_timer = after.fault_timer.tick();
    } else if inputs.difference {
        after.fault = true;
        after.fault_timer = config.t_f;
    }
    let monitored = inputs.function.follows_up()
        || config.hysteresis
        || before.stop.ends_in_standstill()
        || after.stop.ends_in_standstill();
    after.fault
        && after.fault_timer.is_zero()
        && monitored
        && !inputs.function.ends_without_pulses()
}

fn outputs(state: &State, config: &Config, initiated: Stop) -> Outputs {
    let running = state.phase == Phase::Running;
    let off3 = running && (state.stop == Stop::C || (state.stop == Stop::B && !config.external));
    let sos = state.phase == Phase::Holding;
    Outputs {
        stop: state.stop,
        fault: state.fault,
        pulses_off: state.phase == Phase::PulsesOff,
        off3,
        setpoint_zero: state.stop >= Stop::C && !(state.stop == Stop::B && config.external),
        ramp_watched: off3,
        sos,
        esr: state.stop == Stop::E && (running || sos),
        initiated,
        blocks_run: state.stop != Stop::None || state.fault,
    }
}

#[cfg(test)]
mod tests;
