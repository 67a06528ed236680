//! Arbitration of the stop requests of one channel: STOP A to E, their timers and end states (machine M1).
//!
//! Requests come from three sources: stops raised inside the channels (latched, also the copies received from the other
//! channel), stops requested by signals (not latched), and the test stop. The highest one is effective. STOP E, D and C
//! brake for their time and then end in the internal operating stop (SBH); STOP B brakes until standstill or until its
//! time is up and then becomes STOP A, which cancels the pulses.
//!
//! Recommended readings of the manual implemented here: A-02 STOPSI_4, A-16 SBR_UNTIL_END, A-25 RESET_AFTER_END, A-27,
//! A-37 SBHINT_STICKY, A-38 TIMER_EARLIEST.

use crate::kernel::{ConfigError, Cycles};

use crate::sinumerik::level::{ExternalStop, InternalStop, Level};

config! {
    /// Transition times of the stops, equal in both channels (S840D-STOP-085). 0 means at once.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_b: Cycles,
        t_c: Cycles,
        t_d: Cycles,
        t_e: Cycles,
    }
}

impl Config {
    /// The times from STOP B to A (`PULSE_DISABLE_DELAY`) and from STOP C, D, E to the operating stop
    /// (`STOP_SWITCH_TIME_C`, `_D`, `_E`).
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] when `t_b` or `t_c` is above [`Cycles::TEN_SECONDS`], `t_d` or `t_e` above
    /// [`Cycles::SIXTY_SECONDS`].
    pub fn new(t_b: Cycles, t_c: Cycles, t_d: Cycles, t_e: Cycles) -> Result<Self, ConfigError> {
        Ok(Self {
            t_b: t_b.at_most(Cycles::TEN_SECONDS)?,
            t_c: t_c.at_most(Cycles::TEN_SECONDS)?,
            t_d: t_d.at_most(Cycles::SIXTY_SECONDS)?,
            t_e: t_e.at_most(Cycles::SIXTY_SECONDS)?,
        })
    }

    /// The transition time of a level; zero for the levels without one.
    pub const fn time(&self, level: Level) -> Cycles {
        match level {
            Level::B => self.t_b,
            Level::C => self.t_c,
            Level::D => self.t_d,
            Level::E => self.t_e,
            Level::None | Level::F | Level::Test | Level::A => Cycles::ZERO,
        }
    }

    /// The longest time a braking phase of E, D or C can last.
    const fn longest_braking(&self) -> Cycles {
        let mut longest = self.t_c;
        if self.t_d.count() > longest.count() {
            longest = self.t_d;
        }
        if self.t_e.count() > longest.count() {
            longest = self.t_e;
        }
        longest
    }
}

fields! {
    /// What the effective stop is doing.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// No stop.
        #[default]
        Idle,
        /// STOP E, D or C brakes; its timer runs.
        Braking,
        /// STOP E, D or C has ended in the internal operating stop.
        SbhInt,
        /// STOP B brakes; its timer runs.
        BBraking,
        /// STOP A: the pulses are cancelled.
        PulsesOff,
        /// The test stop holds the pulses cancelled in this channel.
        Testing,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The latched internal stop.
        pub internal: InternalStop,
        /// The stop requested by this channel's signals in the last cycle; the other channel reads it.
        pub external: ExternalStop,
        /// The effective level.
        pub level: Level,
        /// What the effective stop is doing.
        pub phase: Phase,
        /// What is left of the transition time while a phase with a timer lasts, else 0.
        pub timer: Cycles,
    }
}

impl State {
    /// No stop.
    pub const INITIAL: Self = Self {
        internal: InternalStop::None,
        external: ExternalStop::None,
        level: Level::None,
        phase: Phase::Idle,
        timer: Cycles::ZERO,
    };

    /// The braking ramp is in force: until STOP B or C ends, also in the operating stop (A-16 SBR_UNTIL_END).
    pub const fn sbr_on(&self) -> bool {
        matches!(self.phase, Phase::BBraking) || matches!(self.level, Level::C)
    }

    /// Level, phase and timer belong together; no request is above the effective level.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let phase_fits = match self.level {
            Level::None => matches!(self.phase, Phase::Idle),
            Level::F => false,
            Level::E | Level::D | Level::C => matches!(self.phase, Phase::Braking | Phase::SbhInt),
            Level::Test => matches!(self.phase, Phase::Testing),
            // Only the own latch holds a STOP B: there is no external one.
            Level::B => matches!(self.phase, Phase::BBraking) && self.internal == InternalStop::B,
            Level::A => matches!(self.phase, Phase::PulsesOff),
        };
        let timer_fits = match self.phase {
            Phase::Braking => !self.timer.is_zero() && self.timer <= config.longest_braking(),
            Phase::BBraking => !self.timer.is_zero() && self.timer <= config.t_b,
            Phase::Idle | Phase::SbhInt | Phase::PulsesOff | Phase::Testing => self.timer.is_zero(),
        };
        phase_fits
            && timer_fits
            && self.internal.level() <= self.level
            && self.external.level() <= self.level
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control: the only acknowledgement of STOP A and B.
        pub power_on: bool,
        /// NC-RESET. The pair of channels gives it to both in the same cycle.
        pub reset: bool,
        /// The highest stop that this channel's own monitors request now.
        pub demand: InternalStop,
        /// STOP F has run out its delay: STOP B is requested (see [`crate::sinumerik::fault`]).
        pub f_stop_b: bool,
        /// The latched internal stop of the other channel as received.
        pub rx_internal: InternalStop,
        /// The stop requested by this channel's signals (see [`crate::sinumerik::external`]).
        pub external: ExternalStop,
        /// The stop requested by the other channel's signals as received.
        pub rx_external: ExternalStop,
        /// The test of the shutdown path is running in this channel.
        pub test: bool,
        /// The actual speed is below STANDSTILL_VELO_TOL.
        pub standstill: bool,
        /// A STOP F is present (see [`crate::sinumerik::fault`]); shown only.
        pub fault: bool,
        /// The test of the external shutdown runs (see [`crate::sinumerik::shutdown_test`]); shown only.
        pub external_test: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The effective level.
        pub level: Level,
        /// The latched internal stop, sent to the other channel.
        pub internal: InternalStop,
        /// What the effective stop is doing.
        pub phase: Phase,
        /// Cancel the pulses (S840D-STOP-010).
        pub cancel_pulses: bool,
        /// Speed setpoint 0, braking at the current limit (S840D-STOP-020, -030).
        pub n_set_zero: bool,
        /// Braking along the path (S840D-STOP-040).
        pub path_brake: bool,
        /// Extended stop and retract (S840D-STOP-050).
        pub esr: bool,
        /// The internal operating stop is required from the selection (S840D-STOP-080).
        pub sbh_internal: bool,
        /// SGA "STOP A/B is active" (S840D-STOP-014).
        pub sga_stop_ab: bool,
        /// SGA "STOP C is active" (S840D-STOP-032).
        pub sga_stop_c: bool,
        /// SGA "STOP D is active" (S840D-STOP-041).
        pub sga_stop_d: bool,
        /// SGA "STOP E is active" (S840D-STOP-052).
        pub sga_stop_e: bool,
        /// The braking ramp is monitored.
        pub sbr_on: bool,
        /// No braking of a STOP E, D or C is under way.
        pub ended: bool,
        /// A restart is prevented (S840D-STOP-083).
        pub start_inhibit: bool,
        /// The stop as `$VA_STOPSI` shows it: -1 none, 0 A, 1 B, 2 C, 3 D, 4 E, 5 F, 10 test, 11 test of the external shutdown
        /// (S840D-STOP-053/a).
        pub stopsi: i8,
    }
}

monitor! { sinumerik::stop;
    /// A latched STOP B or A never falls without power-on, whatever RESET and the signals do.
    b_and_a_stay_latched ["S840D-P-03", "S840D-STOP-012", "S840D-STOP-024", "S840D-ACK-003", "S840D-SIGNAL-010"]:
        when |s| s.before.internal >= InternalStop::B && !s.inputs.power_on
            => s.after.internal >= s.before.internal;

    /// A latched STOP A cancels the pulses, in the cycle it is latched and until power-on.
    latched_a_cancels_pulses ["S840D-SH-002/a", "S840D-P-01", "S840D-STOP-010", "S840D-STOP-012", "S840D-PARAM-504",
        "S840D-SIGNAL-011"]:
        when |s| s.after.internal == InternalStop::A
            || (s.before.internal == InternalStop::A && !s.inputs.power_on)
            => s.after.internal == InternalStop::A && s.after.level == Level::A && s.outputs.cancel_pulses;

    /// No signal ends an internal stop: without RESET and power-on the latch never falls.
    only_acknowledgement_lowers_the_latch ["S840D-EXT-013/e", "S840D-P-42", "S840D-STOP-004", "S840D-STOP-005", "S840D-STOP-083"]:
        when |s| s.before.internal != InternalStop::None && !s.inputs.power_on && !s.inputs.reset
            => s.after.internal >= s.before.internal;

    /// RESET does not acknowledge before the stop has ended in the operating stop.
    reset_waits_for_the_end ["S840D-P-02", "S840D-P-43", "S840D-ACK-001", "S840D-ACK-004"]:
        when |s| s.inputs.reset && !s.inputs.power_on && s.before.phase != Phase::SbhInt
            => s.after.internal >= s.before.internal;

    /// RESET in the operating stop acknowledges STOP C, D and E, unless it is demanded again.
    reset_acknowledges_an_ended_stop ["S840D-P-34", "S840D-ACK-001", "S840D-ACK-002", "S840D-STOP-032", "S840D-STOP-041",
        "S840D-STOP-052", "S840D-RETRACT-702"]:
        when |s| s.inputs.reset && !s.inputs.power_on && s.before.phase == Phase::SbhInt && !s.inputs.f_stop_b
            && s.before.internal != InternalStop::None && s.inputs.rx_internal <= InternalStop::C
            => s.after.internal == s.inputs.demand
                || (s.inputs.demand == InternalStop::B && s.after.internal == InternalStop::A);

    /// The effective level falls only by power-on, by RESET, or because a request by signal or a test has ended.
    level_falls_only_for_a_reason ["S840D-P-02", "S840D-STOP-004"]:
        when |s| s.after.level < s.before.level
            => s.inputs.power_on || s.inputs.reset || s.before.level > s.before.internal.level();

    /// Every request of the cycle is met: the latch rises at least to each internal request.
    every_internal_request_is_latched ["S840D-P-20", "S840D-STOP-007", "S840D-STOP-097", "S840D-STOP-025", "S840D-EXT-009",
        "S840D-SIGNAL-011", "S840D-ALARM-730", "S840D-ALARM-731"]:
        when |s| s.inputs.demand != InternalStop::None || s.inputs.f_stop_b
            || s.inputs.rx_internal >= InternalStop::B
            => s.after.internal >= s.inputs.demand
                && (!s.inputs.f_stop_b || s.after.internal >= InternalStop::B)
                && (s.inputs.power_on || s.inputs.rx_internal < InternalStop::B
                    || s.after.internal >= s.inputs.rx_internal);

    /// A received STOP C, D or E is latched, except in a cycle of power-on or RESET.
    received_stop_is_latched ["S840D-STOP-007", "S840D-STOP-090", "S840D-STOP-067"]:
        when |s| s.inputs.rx_internal != InternalStop::None && !s.inputs.power_on && !s.inputs.reset
            => s.after.internal >= s.inputs.rx_internal;

    /// The latch rises only to what was requested: a demanded or received stop, B by STOP F, and A as the end of B.
    latch_rises_only_on_request ["S840D-STOP-001", "S840D-STOP-013", "S840D-STOP-090", "S840D-STOP-025"]:
        when |s| s.after.internal > s.before.internal
            => s.after.internal == s.inputs.demand || s.after.internal == s.inputs.rx_internal
                || (s.after.internal == InternalStop::B && s.inputs.f_stop_b)
                || (s.after.internal == InternalStop::A
                    && (s.before.phase == Phase::BBraking
                        || ((s.config.t_b.is_zero() || s.inputs.standstill) && (s.before.internal == InternalStop::B || s.inputs.f_stop_b
                            || s.inputs.demand == InternalStop::B || s.inputs.rx_internal == InternalStop::B))));

    /// STOP B is not cut short: while its time runs and the axis moves, only a request for A makes it STOP A.
    stop_b_is_not_cut_short ["S840D-STOP-020", "S840D-STOP-022", "S840D-MDTIM-014/a"]:
        when |s| s.before.phase == Phase::BBraking && !s.inputs.power_on && !s.inputs.standstill
            && s.before.timer > Cycles::new(1)
            => s.after.internal == InternalStop::B || s.inputs.demand == InternalStop::A
                || s.inputs.rx_internal == InternalStop::A;

    /// The effective level is the highest of the latch, both channels' requests by signal and the test.
    level_is_the_highest_request ["S840D-P-38", "S840D-STOP-003", "S840D-EXT-005", "S840D-EXT-013/a", "S840D-EXT-013/b",
        "S840D-EXT-013/c", "S840D-SIGNAL-011", "S840D-SIGNAL-012", "S840D-SIGNAL-013", "S840D-SIGNAL-014/a",
        "S840D-SIGNAL-026"]:
        when |s| !s.inputs.power_on
            => s.after.level == s.after.internal.level().max(s.inputs.external.level())
                .max(s.inputs.rx_external.level()).max(if s.inputs.test { Level::Test } else { Level::None });

    /// Power-on acknowledges everything; what this channel demands in the same cycle is latched anew.
    power_on_acknowledges ["S840D-ACK-001", "S840D-STOP-012"]:
        when |s| s.inputs.power_on && !s.inputs.f_stop_b
            => s.after.internal == s.inputs.demand
                || (s.inputs.demand == InternalStop::B && s.after.internal == InternalStop::A);

    /// In the cycle of power-on nothing received counts.
    power_on_ignores_the_other_channel ["S840D-ACK-001"]:
        when |s| s.inputs.power_on
            => s.after.level == s.after.internal.level().max(s.inputs.external.level())
                .max(if s.inputs.test { Level::Test } else { Level::None });

    /// STOP B ends: each cycle it is still braking its timer is lower; it began with at most t_B. So A follows within t_B.
    stop_b_ends_in_time ["S840D-STOP-013/c", "S840D-P-05", "S840D-STOP-021", "S840D-STOP-022", "S840D-STOP-023",
        "S840D-MDTIM-014/a",
        "S840D-ALARM-716", "S840D-ALARM-730"]:
        when |s| s.before.phase == Phase::BBraking && !s.inputs.power_on
            => s.after.level == Level::A
                || (s.after.phase == Phase::BBraking && s.after.timer < s.before.timer && !s.inputs.standstill);

    /// On an axis that stands STOP B is STOP A at once, also in the cycle in which it becomes effective.
    standing_axis_loses_its_pulses_at_once ["S840D-STOP-021", "S840D-STOP-023", "S840D-P-05", "S840D-MDTIM-014/a",
        "S840D-ALARM-716", "S840D-ALARM-730"]:
        when |s| s.inputs.standstill && s.after.internal >= InternalStop::B
            => s.after.internal == InternalStop::A
                || (s.after.level == Level::A && s.outputs.cancel_pulses);

    /// STOP B that becomes effective runs its full time, unless that is zero: then it is STOP A at once.
    stop_b_starts_its_timer ["S840D-STOP-020", "S840D-STOP-023", "S840D-STOP-097", "S840D-MDTIM-014/a"]:
        when |s| s.after.phase == Phase::BBraking && (s.before.phase != Phase::BBraking || s.inputs.power_on)
            => s.after.timer == s.config.t_b;

    /// Braking of a STOP E, D or C ends: each cycle its timer is lower, also when a higher one of them supersedes it.
    braking_ends_in_time ["S840D-P-06", "S840D-STOP-031", "S840D-STOP-091", "S840D-SIGNAL-012", "S840D-SIGNAL-013",
        "S840D-SIGNAL-014/a", "S840D-MDTIM-010", "S840D-MDTIM-011", "S840D-MDTIM-012"]:
        when |s| s.before.phase == Phase::Braking && s.after.phase == Phase::Braking && !s.inputs.power_on
            => s.after.timer < s.before.timer;

    /// While STOP E, D or C brakes, a repeated or lower request changes no timer; a higher one may only shorten it.
    repeated_request_restarts_no_timer ["S840D-STOP-004", "S840D-STOP-091", "S840D-SG-011"]:
        when |s| s.before.phase == Phase::Braking && s.after.level.ends_in_standstill() && !s.inputs.power_on
            => if s.after.level > s.before.level {
                s.after.timer == s.before.timer.tick().min(s.config.time(s.after.level))
            } else {
                s.after.timer == s.before.timer.tick()
            };

    /// A STOP E, D or C that becomes effective from another level starts its own time.
    braking_starts_its_timer ["S840D-P-06", "S840D-STOP-030", "S840D-STOP-040", "S840D-STOP-050", "S840D-EXT-010",
        "S840D-EXT-011", "S840D-EXT-012", "S840D-SIGNAL-012", "S840D-SIGNAL-013", "S840D-SIGNAL-014/a", "S840D-MDTIM-010",
        "S840D-MDTIM-011", "S840D-MDTIM-012"]:
        when |s| s.after.level.ends_in_standstill()
            && (s.inputs.power_on || !s.before.level.ends_in_standstill())
            => s.after.timer == s.config.time(s.after.level);

    /// The internal operating stop stays while a STOP E, D or C lasts, also when a higher one of them comes.
    operating_stop_is_kept ["S840D-P-46", "S840D-STOP-080", "S840D-STOP-092", "S840D-ALARM-732"]:
        when |s| s.before.phase == Phase::SbhInt && s.after.level.ends_in_standstill() && !s.inputs.power_on
            => s.after.phase == Phase::SbhInt && s.outputs.sbh_internal;

    /// The actions are those of the effective level alone.
    actions_belong_to_the_level ["S840D-P-38", "S840D-STOP-098", "S840D-STOP-014", "S840D-STOP-032", "S840D-STOP-041",
        "S840D-STOP-052", "S840D-EXT-007", "S840D-TEST-023", "S840D-SIGNAL-011", "S840D-SIGNAL-012", "S840D-SIGNAL-013",
        "S840D-SIGNAL-014/a", "S840D-SIGNAL-016", "S840D-SIGNAL-024"]:
        when |s| s.after.level != Level::None
            => s.outputs.cancel_pulses == (s.after.level == Level::A || s.after.level == Level::Test)
                && s.outputs.path_brake == (s.after.level == Level::D && s.after.phase == Phase::Braking)
                && s.outputs.esr == (s.after.level == Level::E && s.after.phase == Phase::Braking)
                && s.outputs.sga_stop_ab == (s.after.level >= Level::B)
                && s.outputs.sga_stop_c == (s.after.level == Level::C)
                && s.outputs.sga_stop_d == (s.after.level == Level::D)
                && s.outputs.sga_stop_e == (s.after.level == Level::E);

    /// Setpoint 0 while STOP B or C brakes; the braking ramp is watched in STOP B and as long as STOP C lasts.
    current_limit_braking_and_its_ramp ["S840D-STOP-020", "S840D-STOP-030", "S840D-EXT-010", "S840D-EXT-011",
        "S840D-SBR-005", "S840D-SIGNAL-012", "S840D-ALARM-716"]:
        when |s| s.outputs.n_set_zero || s.outputs.sbr_on || s.after.level == Level::B || s.after.level == Level::C
            => s.outputs.sbr_on == matches!(s.after.level, Level::B | Level::C)
                && s.outputs.n_set_zero == (s.outputs.sbr_on && s.after.phase != Phase::SbhInt);

    /// The system variable shows the number of the effective stop.
    stopsi_shows_the_level ["S840D-STOP-053/a", "S840D-SIGNAL-020/a"]:
        when |s| s.after.level != Level::None
            => matches!(
                (s.outputs.stopsi, s.after.level),
                (0, Level::A) | (1, Level::B) | (2, Level::C) | (3, Level::D) | (4, Level::E) | (10, Level::Test)
            );

    /// Without an effective stop the variable shows the test of the external shutdown, else STOP F, the lowest of all.
    stopsi_shows_test_and_fault ["S840D-STOP-053/b", "S840D-STOP-053/c", "S840D-SIGNAL-020/a"]:
        when |s| s.after.level == Level::None
            => s.outputs.stopsi == match (s.inputs.external_test, s.inputs.fault) {
                (true, _) => 11,
                (false, true) => 5,
                (false, false) => -1,
            };

    /// The operating stop is required, and the braking said to be over, exactly in their phases.
    phases_are_shown ["S840D-STOP-080", "S840D-STOP-086", "S840D-EXT-018", "S840D-MDTIM-010", "S840D-MDTIM-011",
        "S840D-MDTIM-012"]:
        when |s| s.after.level.ends_in_standstill()
            => s.outputs.sbh_internal == (s.after.phase == Phase::SbhInt)
                && s.outputs.ended == (s.after.phase == Phase::SbhInt)
                && s.outputs.ended != (s.after.phase == Phase::Braking);

    /// Without a stop there is no action.
    no_stop_no_action ["S840D-P-38"]:
        when |s| s.after.level == Level::None
            => !(s.outputs.cancel_pulses || s.outputs.n_set_zero || s.outputs.path_brake || s.outputs.esr
                || s.outputs.sbh_internal || s.outputs.sbr_on || s.outputs.sga_stop_ab || s.outputs.sga_stop_c
                || s.outputs.sga_stop_d || s.outputs.sga_stop_e) && s.outputs.ended;

    /// The restart is prevented exactly while an internal stop is latched.
    restart_is_prevented ["S840D-P-42", "S840D-P-43", "S840D-STOP-083", "S840D-EXT-008", "S840D-STOP-032",
        "S840D-STOP-041", "S840D-STOP-052", "S840D-SIGNAL-026"]:
        when |s| s.after.internal != InternalStop::None || !s.outputs.start_inhibit
            => s.outputs.start_inhibit == (s.after.internal != InternalStop::None);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-STOP-003"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.level == s.after.level
                && s.outputs.internal == s.after.internal && s.outputs.phase == s.after.phase
                && s.after.external == s.inputs.external;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let acknowledges = inputs.reset
        && before.phase == Phase::SbhInt
        && before.internal != InternalStop::None
        && before.internal <= InternalStop::C;
    let kept = if acknowledges {
        InternalStop::None
    } else {
        before.internal
    };

    // The sender of a STOP C, D or E is acknowledged by the same RESET: taking its old request would latch it for ever.
    let ignored = inputs.power_on || (acknowledges && inputs.rx_internal <= InternalStop::C);
    let rx_internal = if ignored {
        InternalStop::None
    } else {
        inputs.rx_internal
    };
    let rx_external = if inputs.power_on {
        ExternalStop::None
    } else {
        inputs.rx_external
    };
    let by_fault = if inputs.f_stop_b {
        InternalStop::B
    } else {
        InternalStop::None
    };

    let internal = kept.max(inputs.demand).max(rx_internal).max(by_fault);
    let test = if inputs.test {
        Level::Test
    } else {
        Level::None
    };
    let level = internal
        .level()
        .max(inputs.external.level())
        .max(rx_external.level())
        .max(test);
    let after = settle(before, config, inputs, internal, level);
    (after, outputs(after, inputs))
}

/// Phase and timer of the level that is effective now, and the change from STOP B to A.
fn settle(
    before: State,
    config: &Config,
    inputs: &Inputs,
    internal: InternalStop,
    level: Level,
) -> State {
    let to = |phase, timer| State {
        internal,
        external: inputs.external,
        level,
        phase,
        timer,
    };
    match level {
        Level::None | Level::F => to(Phase::Idle, Cycles::ZERO),
        Level::E | Level::D | Level::C => {
            let left = braking_time_left(before, config, level);
            if left.is_zero() {
                to(Phase::SbhInt, Cycles::ZERO)
            } else {
                to(Phase::Braking, left)
            }
        }
        Level::Test => to(Phase::Testing, Cycles::ZERO),
        Level::B => {
            // Also in the cycle it begins: an axis that stands has nothing to brake.
            let left = if inputs.standstill {
                Cycles::ZERO
            } else if before.phase == Phase::BBraking {
                before.timer.tick()
            } else {
                config.t_b
            };
            if left.is_zero() {
                State {
                    internal: InternalStop::A,
                    level: Level::A,
                    ..to(Phase::PulsesOff, Cycles::ZERO)
                }
            } else {
                to(Phase::BBraking, left)
            }
        }
        Level::A => to(Phase::PulsesOff, Cycles::ZERO),
    }
}

/// What is left of the braking time under STOP E, D or C; zero means the operating stop.
fn braking_time_left(before: State, config: &Config, level: Level) -> Cycles {
    let own = config.time(level);
    match before.phase {
        Phase::SbhInt => Cycles::ZERO,
        // The first expiry counts: a higher stop may shorten the way to the operating stop, never lengthen it.
        Phase::Braking if level > before.level => before.timer.tick().min(own),
        Phase::Braking => before.timer.tick(),
        Phase::Idle | Phase::BBraking | Phase::PulsesOff | Phase::Testing => own,
    }
}

fn outputs(state: State, inputs: &Inputs) -> Outputs {
    let level = state.level;
    let braking = state.phase == Phase::Braking;
    let b_braking = state.phase == Phase::BBraking;
    Outputs {
        level,
        internal: state.internal,
        phase: state.phase,
        cancel_pulses: level == Level::A || level == Level::Test,
        n_set_zero: b_braking || (level == Level::C && braking),
        path_brake: level == Level::D && braking,
        esr: level == Level::E && braking,
        sbh_internal: state.phase == Phase::SbhInt,
        sga_stop_ab: level >= Level::B,
        sga_stop_c: level == Level::C,
        sga_stop_d: level == Level::D,
        sga_stop_e: level == Level::E,
        sbr_on: state.sbr_on(),
        ended: !braking,
        start_inhibit: state.internal != InternalStop::None,
        stopsi: match level {
            Level::None | Level::F if inputs.external_test => 11,
            Level::None | Level::F if inputs.fault => 5,
            Level::None | Level::F => -1,
            Level::A => 0,
            Level::B => 1,
            Level::C => 2,
            Level::D => 3,
            Level::E => 4,
            Level::Test => 10,
        },
    }
}
