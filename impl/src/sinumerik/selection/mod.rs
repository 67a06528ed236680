//! Selection of the operating stop (SBH) and of the speed stage (SG1 to SG4) with its delays, in one channel (machine M3),
//! with the override of the limits of SG2 and SG4 (M4).
//!
//! A lower limit, and the operating stop, take effect after the delay t_vel, during which the old limit is monitored; a
//! higher or equal limit and de-selection act at once. The end of a STOP C, D or E forces the operating stop and makes the
//! signals ineffective (see [`crate::sinumerik::stop`]). The override signals change the limit of SG2 and SG4 only, by the same rules:
//! what counts is the effective limit of stage and factor.
//!
//! The forced operating stop begins in the cycle in which the braking ends (table 5-3: with t_C = 0 at once). The arbitration
//! steps after this machine, so its reference is the position of that cycle, and what is shown is completed by the channel
//! ([`crate::sinumerik::channel::Outputs::sbh_active`]).
//!
//! A position set anew by referencing is no motion: the window of a running operating stop is laid around the new position.
//! How far the axis stood from the old reference is lost with it; that happens once in a referencing at most.
//!
//! Recommended readings of the manual implemented here: A-05 (settled), A-14 SVSS_ON_IN_INT, A-39 REF_KEEP.

use crate::kernel::{Cycles, Position, Speed};

mod limits;

pub use limits::{Choice, Config, FactorIndex, Stage};

fields! {
    /// What is selected and monitored.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Mode {
        /// Non-safe operation: neither SBH nor SG.
        #[default]
        Nsb,
        /// The limit of a speed stage.
        Sg,
        /// The limit of the old stage; the delay to a lower one runs.
        SgDown,
        /// The limit of the old stage; the delay to SBH runs.
        SbhPend,
        /// Operating stop, selected by the signals.
        Sbh,
        /// Operating stop, forced by the end of a STOP C, D or E.
        SbhForced,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is selected and monitored.
        pub mode: Mode,
        /// The stage whose limit is monitored in `Sg`, `SgDown` and `SbhPend`, else SG1.
        pub stage: Stage,
        /// The override factor in force in `stage`, else 0.
        pub factor: FactorIndex,
        /// The stage to come in `SgDown`, else SG1.
        pub target: Stage,
        /// The override factor to come in `SgDown`, else 0.
        pub target_factor: FactorIndex,
        /// What is left of t_vel in `SgDown` and `SbhPend`, else 0.
        pub timer: Cycles,
        /// The position captured in `Sbh` and `SbhForced`, else 0.
        pub reference: Position,
    }
}

impl State {
    /// Nothing selected.
    pub const INITIAL: Self = Self {
        mode: Mode::Nsb,
        stage: Stage::Sg1,
        factor: FactorIndex::NONE,
        target: Stage::Sg1,
        target_factor: FactorIndex::NONE,
        timer: Cycles::ZERO,
        reference: Position(0),
    };

    const fn speed(choice: Choice) -> Self {
        Self {
            mode: Mode::Sg,
            stage: choice.stage,
            factor: choice.factor,
            ..Self::INITIAL
        }
    }

    /// What the monitored limit is chosen by, where a speed is monitored.
    pub const fn monitored(&self) -> Choice {
        Choice {
            stage: self.stage,
            factor: self.factor,
        }
    }

    /// What is to come in `SgDown`.
    pub const fn pending(&self) -> Choice {
        Choice {
            stage: self.target,
            factor: self.target_factor,
        }
    }

    const fn standstill(reference: Position) -> Self {
        Self {
            mode: Mode::Sbh,
            reference,
            ..Self::INITIAL
        }
    }

    const fn forced(reference: Position) -> Self {
        Self {
            mode: Mode::SbhForced,
            reference,
            ..Self::INITIAL
        }
    }

    /// Each field has a meaning only in its modes; a pending lower stage is lower than the one it replaces.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let pending = matches!(self.mode, Mode::SgDown | Mode::SbhPend);
        let speed = pending || self.mode == Mode::Sg;
        let standstill = matches!(self.mode, Mode::Sbh | Mode::SbhForced);
        (config.enable || *self == Self::INITIAL)
            && pending != self.timer.is_zero()
            && self.timer <= config.t_vel
            && (speed || self.stage == Stage::Sg1)
            && config.choice(self.stage, self.factor) == self.monitored()
            && config.choice(self.target, self.target_factor) == self.pending()
            && (standstill || self.reference == Position(0))
            && if self.mode == Mode::SgDown {
                config.effective(self.pending()) < config.effective(self.monitored())
            } else {
                self.target == Stage::Sg1
            }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// SGE "SBH/SG de-selection": 1 selects neither.
        pub sge_sbh_sg: bool,
        /// SGE "SBH de-selection": 0 selects SBH, 1 selects SG.
        pub sge_sbh: bool,
        /// The stage selected by the signals.
        pub sg_select: Stage,
        /// The override factor selected by the signals.
        pub over: FactorIndex,
        /// A STOP C, D or E has ended in the operating stop (see [`crate::sinumerik::stop::Outputs::sbh_internal`]).
        pub sbh_internal: bool,
        /// The actual position.
        pub position: Position,
        /// The actual position of the cycle before, in which a STOP C, D or E that has just ended did so.
        pub ended_at: Position,
        /// From this cycle on the position counts from another zero: it has been set anew (see [`crate::sinumerik::motion`]).
        pub set_anew: bool,
    }
}

fields! {
    /// What is compared with what.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Monitored {
        /// Nothing.
        #[default]
        Nothing,
        /// The speed with the limit.
        Speed,
        /// The position with the reference.
        Standstill,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// What is selected and monitored.
        pub mode: Mode,
        /// SGA "SBH/SG active".
        pub sga_active: bool,
        /// SGA "SBH active".
        pub sga_sbh_active: bool,
        /// SGA "SG active bit 1, bit 0": the stage whose limit is monitored; SG1 where none is (S840D-SG-014).
        pub sga_sg: Stage,
        /// What is compared with what.
        pub monitored: Monitored,
        /// The effective limit where the speed is monitored, else 0.
        pub limit: Speed,
        /// The reference where the position is monitored, else 0.
        pub reference: Position,
        /// What the setpoints are to keep to already: what will be monitored once a delay that runs is over.
        pub goal: Monitored,
        /// The effective limit that will be monitored then, else 0.
        pub goal_limit: Speed,
    }
}

/// What the signals select.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Selected {
    Nothing,
    Standstill,
    Speed(Choice),
}

impl Inputs {
    /// The stage and factor the signals choose, if they select a speed.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn choice(&self, config: &Config) -> Choice {
        config.choice(self.sg_select, self.over)
    }

    /// Table 5-22 of the manual.
    const fn selected(&self, config: &Config) -> Selected {
        match (self.sge_sbh_sg, self.sge_sbh) {
            (true, _) => Selected::Nothing,
            (false, false) => Selected::Standstill,
            (false, true) => Selected::Speed(self.choice(config)),
        }
    }
}

impl Mode {
    /// Whether the limit of a stage is monitored.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn watches_speed(self) -> bool {
        matches!(self, Self::Sg | Self::SgDown | Self::SbhPend)
    }
}

monitor! { sinumerik::selection;
    /// The end of a STOP C, D or E forces the operating stop, whatever the signals select.
    ended_stop_forces_standstill ["S840D-P-07", "S840D-STOP-080"]:
        when |s| s.inputs.sbh_internal && s.config.enable
            => s.after.mode == Mode::SbhForced && s.outputs.monitored == Monitored::Standstill;

    /// While forced nothing changes, whatever the signals select: neither the function nor its reference.
    forced_standstill_ignores_signals ["S840D-P-07", "S840D-P-46", "S840D-SBH-006", "S840D-STOP-080"]:
        when |s| s.inputs.sbh_internal && !s.inputs.power_on && s.before.mode == Mode::SbhForced && s.config.enable
            && !s.inputs.set_anew
            => s.after == s.before;

    /// The reference of the operating stop is the position at its activation.
    reference_is_captured_on_activation ["S840D-SBH-001", "S840D-SBH-003", "S840D-STOP-080", "S840D-MDTIM-005"]:
        when |s| s.after.mode == Mode::Sbh
            && (s.inputs.power_on || (s.after.mode != s.before.mode && s.before.mode != Mode::SbhForced))
            => s.after.reference == s.inputs.position;

    /// The forced operating stop is activated where the braking has ended: in the cycle before.
    forced_standstill_is_where_the_stop_ended ["S840D-STOP-031", "S840D-STOP-080", "S840D-SBH-001"]:
        when |s| s.after.mode == Mode::SbhForced && !s.inputs.set_anew
            && (s.inputs.power_on || s.before.mode != Mode::SbhForced)
            => s.after.reference == s.inputs.ended_at;

    /// When the forced operating stop ends the signals decide at once: nothing, the operating stop, or the chosen stage.
    signals_decide_after_the_forced_standstill ["S840D-EXT-013/d", "S840D-STOP-080", "S840D-SBH-006"]:
        when |s| s.before.mode == Mode::SbhForced && !s.inputs.sbh_internal && !s.inputs.power_on && s.config.enable
            => s.after.mode == match s.inputs.selected(&s.config) {
                Selected::Nothing => Mode::Nsb,
                Selected::Standstill => Mode::Sbh,
                Selected::Speed(_) => Mode::Sg,
            };

    /// With a position set anew the operating stop goes on around the new one: nothing has moved.
    setting_anew_moves_the_window ["S840D-REF-002", "S840D-REF-003", "S840D-GEAR-506", "S840D-SBH-001"]:
        when |s| s.inputs.set_anew && (s.after.mode == Mode::Sbh || s.after.mode == Mode::SbhForced)
            => s.after.reference == s.inputs.position;

    /// Acknowledgement into the selected operating stop keeps the reference: no creeping by repeated acknowledgement.
    reference_is_kept_on_acknowledgement ["S840D-P-07", "S840D-STOP-080"]:
        when |s| (s.before.mode == Mode::SbhForced || s.before.mode == Mode::Sbh) && s.after.mode == Mode::Sbh
            && !s.inputs.power_on && !s.inputs.set_anew
            => s.after.reference == s.before.reference;

    /// De-selection acts at once in every mode but the forced operating stop.
    deselection_acts_at_once ["S840D-SBH-006", "S840D-SBH-010", "S840D-SBH-011", "S840D-SG-005", "S840D-MDTIM-003",
        "S840D-SIGNAL-003"]:
        when |s| s.inputs.sge_sbh_sg && !s.inputs.sbh_internal
            => s.after == State::INITIAL && s.outputs.monitored == Monitored::Nothing;

    /// A limit at least as high as the monitored one takes effect in the same cycle.
    higher_limit_acts_at_once ["S840D-P-09", "S840D-SBH-010", "S840D-SG-003", "S840D-OVR-003", "S840D-MDTIM-002",
        "S840D-MDTIM-006"]:
        when |s| s.before.mode.watches_speed() && !s.inputs.power_on && !s.inputs.sbh_internal
            && !s.inputs.sge_sbh_sg && s.inputs.sge_sbh
            && s.config.effective(s.inputs.choice(&s.config)) >= s.config.effective(s.before.monitored())
            && !(s.before.mode == Mode::Sg && s.inputs.choice(&s.config) == s.before.monitored())
            => s.after == State::speed(s.inputs.choice(&s.config));

    /// A lower limit newly selected starts the whole delay; the old limit stays in force, unless the delay is 0.
    lower_limit_waits ["S840D-P-08", "S840D-SBH-010", "S840D-SG-004", "S840D-OVR-003", "S840D-PARAM-011",
        "S840D-MDTIM-004", "S840D-MDTIM-001", "S840D-MDTIM-018"]:
        when |s| s.before.mode.watches_speed() && !s.inputs.power_on && !s.inputs.sbh_internal
            && !s.inputs.sge_sbh_sg && s.inputs.sge_sbh
            && s.config.effective(s.inputs.choice(&s.config)) < s.config.effective(s.before.monitored())
            && !(s.before.mode == Mode::SgDown && s.inputs.choice(&s.config) == s.before.pending())
            => if s.config.t_vel.is_zero() {
                s.after == State::speed(s.inputs.choice(&s.config))
            } else {
                s.after.mode == Mode::SgDown && s.after.monitored() == s.before.monitored()
                    && s.after.pending() == s.inputs.choice(&s.config) && s.after.timer == s.config.t_vel
            };

    /// The same lower limit selected on: the delay runs to its end, then the new limit is in force, not before.
    lower_limit_comes_in_time ["S840D-P-08", "S840D-SG-004", "S840D-MDTIM-005", "S840D-MDTIM-018"]:
        when |s| s.before.mode == Mode::SgDown && !s.inputs.power_on && !s.inputs.sbh_internal
            && !s.inputs.sge_sbh_sg && s.inputs.sge_sbh && s.inputs.choice(&s.config) == s.before.pending()
            => if s.before.timer > Cycles::new(1) {
                s.after == State { timer: s.before.timer.tick(), ..s.before }
            } else {
                s.after == State::speed(s.before.pending())
            };

    /// The operating stop selected from a speed stage starts the whole delay; the old limit stays in force.
    standstill_waits ["S840D-SBH-003", "S840D-SBH-010", "S840D-MDTIM-004", "S840D-MDTIM-001", "S840D-MDTIM-018"]:
        when |s| (s.before.mode == Mode::Sg || s.before.mode == Mode::SgDown) && !s.inputs.power_on
            && !s.inputs.sbh_internal && !s.inputs.sge_sbh_sg && !s.inputs.sge_sbh
            => if s.config.t_vel.is_zero() {
                s.after.mode == Mode::Sbh
            } else {
                s.after.mode == Mode::SbhPend && s.after.monitored() == s.before.monitored()
                    && s.after.timer == s.config.t_vel
            };

    /// The operating stop selected on: the delay runs to its end, then the position is monitored, not before.
    standstill_comes_in_time ["S840D-SBH-003", "S840D-MDTIM-005", "S840D-MDTIM-018"]:
        when |s| s.before.mode == Mode::SbhPend && !s.inputs.power_on && !s.inputs.sbh_internal
            && !s.inputs.sge_sbh_sg && !s.inputs.sge_sbh
            => if s.before.timer > Cycles::new(1) {
                s.after == State { timer: s.before.timer.tick(), ..s.before }
            } else {
                s.after.mode == Mode::Sbh
            };

    /// Without a speed stage before, the selection acts at once.
    selection_without_speed_acts_at_once ["S840D-SBH-002/b", "S840D-SBH-002/c", "S840D-SBH-004", "S840D-SBH-006",
        "S840D-SG-005", "S840D-MDTIM-017", "S840D-INTERACT-704", "S840D-SIGNAL-003", "S840D-SIGNAL-004"]:
        when |s| s.config.enable && !s.inputs.sbh_internal && !s.inputs.sge_sbh_sg
            && (s.inputs.power_on || !s.before.mode.watches_speed())
            => if s.inputs.sge_sbh {
                s.after == State::speed(s.inputs.choice(&s.config))
            } else {
                s.after.mode == Mode::Sbh
            };

    /// The limit compared is that of the stage, in SG2 and SG4 reduced by the factor in force and rounded down to the next
    /// whole increment.
    factor_reduces_the_limit ["S840D-OVR-001", "S840D-OVR-002", "S840D-PARAM-011", "S840D-SG-001", "S840D-SIGNAL-007"]:
        when |s| s.outputs.monitored == Monitored::Speed
            => {
                let exact = u64::from(s.config.limit(s.after.stage).0)
                    * u64::from(s.config.factor(s.after.monitored()).get());
                let hundredths = u64::from(s.outputs.limit.0) * 100;
                hundredths <= exact && exact < hundredths + 100
            };

    /// In SG1 and SG3, and without override, no factor is in force and the limit is that of the stage.
    no_factor_in_sg1_and_sg3 ["S840D-P-31", "S840D-OVR-001"]:
        when |s| s.outputs.monitored == Monitored::Speed
            && (s.config.factors.is_none() || matches!(s.after.stage, Stage::Sg1 | Stage::Sg3))
            => s.after.factor == FactorIndex::NONE && s.outputs.limit == s.config.limit(s.after.stage);

    /// The signals to the user show what is monitored, not what is selected.
    feedback_shows_what_is_monitored ["S840D-P-53", "S840D-SBH-007", "S840D-SG-009", "S840D-SG-014", "S840D-SIGNAL-017",
        "S840D-SIGNAL-016"]:
        when |s| s.after.mode != Mode::Nsb
            => s.outputs.sga_active
                && s.outputs.sga_sbh_active == (s.outputs.monitored == Monitored::Standstill)
                && (s.outputs.monitored == Monitored::Speed) == s.after.mode.watches_speed()
                && s.outputs.sga_sg == s.after.stage
                && s.outputs.limit == if s.after.mode.watches_speed() {
                    s.config.effective(s.after.monitored())
                } else {
                    Speed(0)
                };

    /// With nothing selected nothing is monitored and every signal is 0.
    nothing_selected_nothing_monitored ["S840D-SG-012", "S840D-SBH-002/a", "S840D-SIGNAL-017"]:
        when |s| s.after.mode == Mode::Nsb
            => !s.outputs.sga_active && !s.outputs.sga_sbh_active && s.outputs.monitored == Monitored::Nothing;

    /// The setpoints are to keep to what the mode leads to, from the cycle on in which the signals change.
    goal_is_where_the_delay_leads ["S840D-INTERACT-702", "S840D-INTERACT-704", "S840D-INTERACT-705", "S840D-INTERACT-707"]:
        when |s| s.before.invariant(&s.config)
            => (s.outputs.goal, s.outputs.goal_limit) == match s.after.mode {
                Mode::Nsb => (Monitored::Nothing, Speed(0)),
                Mode::Sg => (Monitored::Speed, s.config.effective(s.after.monitored())),
                Mode::SgDown => (Monitored::Speed, s.config.effective(s.after.pending())),
                Mode::SbhPend | Mode::Sbh | Mode::SbhForced => (Monitored::Standstill, Speed(0)),
            };

    /// Where SBH and SG are not enabled nothing is ever selected.
    disabled_is_off ["S840D-SG-012"]:
        when |s| !s.config.enable
            => s.after == State::INITIAL;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-SG-009"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.mode == s.after.mode && s.outputs.reference == s.after.reference;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let after = if !config.enable {
        State::INITIAL
    } else if inputs.sbh_internal {
        let kept = before.mode == Mode::SbhForced;
        State::forced(match (inputs.set_anew, kept) {
            (true, _) => inputs.position,
            (false, true) => before.reference,
            (false, false) => inputs.ended_at,
        })
    } else {
        select(before, config, inputs)
    };
    (after, outputs(after, config, goal(config, inputs)))
}

/// What is asked for in this cycle, without any delay.
fn goal(config: &Config, inputs: &Inputs) -> Selected {
    if !config.enable {
        Selected::Nothing
    } else if inputs.sbh_internal {
        Selected::Standstill
    } else {
        inputs.selected(config)
    }
}

/// The next state where the signals decide.
fn select(before: State, config: &Config, inputs: &Inputs) -> State {
    match (inputs.selected(config), before.mode) {
        (Selected::Nothing, _) => State::INITIAL,

        (Selected::Standstill, Mode::Nsb) => State::standstill(inputs.position),
        // Acknowledged into the selected operating stop: the reference stays (A-39 REF_KEEP).
        (Selected::Standstill, Mode::Sbh | Mode::SbhForced) => {
            State::standstill(if inputs.set_anew {
                inputs.position
            } else {
                before.reference
            })
        }
        (Selected::Standstill, Mode::Sg | Mode::SgDown) => {
            standstill_after(config.t_vel, before.monitored(), inputs)
        }
        (Selected::Standstill, Mode::SbhPend) => {
            standstill_after(before.timer.tick(), before.monitored(), inputs)
        }

        (Selected::Speed(new), Mode::Nsb | Mode::Sbh | Mode::SbhForced) => State::speed(new),
        (Selected::Speed(new), Mode::Sg | Mode::SgDown | Mode::SbhPend) => {
            let old = before.monitored();
            if config.effective(new) >= config.effective(old) {
                State::speed(new)
            } else if before.mode == Mode::SgDown && new == before.pending() {
                speed_after(before.timer.tick(), old, new)
            } else {
                speed_after(config.t_vel, old, new)
            }
        }
    }
}

/// The operating stop when `left` is over, the old limit until then.
fn standstill_after(left: Cycles, old: Choice, inputs: &Inputs) -> State {
    if left.is_zero() {
        State::standstill(inputs.position)
    } else {
        State {
            mode: Mode::SbhPend,
            timer: left,
            ..State::speed(old)
        }
    }
}

/// The new limit when `left` is over, the old one until then.
fn speed_after(left: Cycles, old: Choice, new: Choice) -> State {
    if left.is_zero() {
        State::speed(new)
    } else {
        State {
            mode: Mode::SgDown,
            target: new.stage,
            target_factor: new.factor,
            timer: left,
            ..State::speed(old)
        }
    }
}

fn outputs(state: State, config: &Config, goal: Selected) -> Outputs {
    let monitored = match state.mode {
        Mode::Nsb => Monitored::Nothing,
        Mode::Sg | Mode::SgDown | Mode::SbhPend => Monitored::Speed,
        Mode::Sbh | Mode::SbhForced => Monitored::Standstill,
    };
    Outputs {
        mode: state.mode,
        sga_active: monitored != Monitored::Nothing,
        sga_sbh_active: monitored == Monitored::Standstill,
        sga_sg: state.stage,
        monitored,
        limit: if monitored == Monitored::Speed {
            config.effective(state.monitored())
        } else {
            Speed(0)
        },
        reference: state.reference,
        goal: match goal {
            Selected::Nothing => Monitored::Nothing,
            Selected::Standstill => Monitored::Standstill,
            Selected::Speed(_) => Monitored::Speed,
        },
        goal_limit: match goal {
            Selected::Speed(choice) => config.effective(choice),
            Selected::Nothing | Selected::Standstill => Speed(0),
        },
    }
}
