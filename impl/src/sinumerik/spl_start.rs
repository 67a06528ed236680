//! Start of the safe logic: from power-on to the release of the PLC-SPL (machine `spl_start`).
//!
//! The NCK-SPL is started by the PLC (FB4 assigns the interrupt, FC9 calls the program) or by PROG_EVENT at run-up. With it
//! the comparison of both channels starts; until then external STOP A is held on every axis ([`crate::sinumerik::external`], whose
//! input `spl_started` is [`Outputs::compared`]). The PLC-SPL may run once SAFE.SPF has been executed to its end.
//!
//! What has started is left by power-on only: mode change, NC stop and RESET are no inputs (S840D-SPLSTART-011).
//!
//! Reading B-01: SPLSTART_REFUSED.

config! {
    /// There is nothing to configure: machine data count as they are in a cycle, and come as inputs.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// What the axes have.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Axes {
        /// No axis has safety functions.
        #[default]
        Bare,
        /// Some have, but none has SBH/SG and external stops.
        Unfit,
        /// An axis has SBH/SG and external stops (S840D-SPL-005).
        Fit,
    }
}

fields! {
    /// What the start program of the PLC does in a cycle (S840D-SPLSTART-002).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Call {
        /// Nothing.
        #[default]
        None,
        /// It calls FB4.
        Assign,
        /// FB4 reports that it is done.
        Assigned,
        /// It calls FC9.
        Start,
        /// FC9 reports that it is done.
        Started,
        /// FC9 reports an error.
        Error,
    }
}

fields! {
    /// What SAFE.SPF does in a cycle (S840D-SPLSTART-004).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Program {
        /// Nothing that is seen.
        #[default]
        Runs,
        /// It reaches M02, M17 or M30.
        Ends,
        /// An error stops it before.
        Breaks,
    }
}

fields! {
    /// How far the start has come.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Stage {
        /// Not active.
        #[default]
        Off,
        /// The NCK waits for the PLC.
        Waiting,
        /// Both are cyclic.
        Cyclic,
        /// FB4 is processed.
        Assigning,
        /// FB4 is done.
        Ready,
        /// SAFE.SPF runs.
        Executing,
        /// It has reached its end.
        Executed,
        /// The PLC-SPL may run.
        Released,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How far the start has come.
        pub stage: Stage,
        /// It has failed at this stage.
        pub failed: bool,
        /// It was refused: alarm 27096.
        pub denied: bool,
        /// It was made via PROG_EVENT.
        pub by_event: bool,
        /// The comparison has been started.
        pub compared: bool,
        /// An interface was parameterised at power-on.
        pub parametrised: bool,
        /// The file existed at power-on.
        pub stored: bool,
        /// No axis had safety functions at power-on.
        pub bare: bool,
    }
}

impl State {
    /// Before the first power-on.
    pub const INITIAL: Self = Self {
        stage: Stage::Off,
        failed: false,
        denied: false,
        by_event: false,
        compared: false,
        parametrised: false,
        stored: false,
        bare: false,
    };

    /// What a stage has behind it, and what it cannot have.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        let stage = self.stage;
        (stage == Stage::Off || (self.parametrised && self.stored))
            && (stage < Stage::Executing || self.compared)
            && (!self.compared || stage >= Stage::Assigning)
            && (!self.by_event || stage >= Stage::Executing)
            && (!self.denied || (self.bare && (stage == Stage::Cyclic || stage == Stage::Ready)))
            && (!self.failed
                || (stage >= Stage::Cyclic
                    && stage != Stage::Assigning
                    && stage < Stage::Released
                    && !self.denied))
    }

    /// The status word DB18.DBW136 by the bits of its table (S840D-SPLSTART-015).
    fn status(&self, protected: bool) -> u16 {
        let stage = self.stage;
        let by_plc = !self.by_event;
        let started = stage >= Stage::Executing;
        let bits = [
            self.parametrised,
            self.stored,
            stage >= Stage::Waiting,
            stage >= Stage::Cyclic,
            stage >= Stage::Assigning && by_plc,
            stage >= Stage::Ready && by_plc,
            started && by_plc,
            stage == Stage::Released && by_plc,
            self.by_event,
            self.compared,
            self.compared,
            started,
            started && protected,
            stage >= Stage::Executed,
        ];
        let mut status = 0;
        for (bit, place) in bits.into_iter().zip(0..16_u32) {
            status |= u16::from(bit) << place;
        }
        status
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of the control.
        pub power_on: bool,
        /// An SPL interface is parameterised (S840D-SPL-006).
        pub parameters: bool,
        /// The program is stored under its name (S840D-SPLSTART-010).
        pub file: bool,
        /// What the axes have.
        pub axes: Axes,
        /// Commissioning of the NCK-SPL is completed.
        pub protected_n: bool,
        /// That of the PLC-SPL is.
        pub protected_p: bool,
        /// The PLC has run up.
        pub plc_up: bool,
        /// What the PLC does.
        pub call: Call,
        /// PROG_EVENT.SPF calls the program at run-up (S840D-SPLSTART-005).
        pub event: bool,
        /// It is called in upper case (S840D-SPLSTART-010).
        pub upper: bool,
        /// MD 11602 is 7 (S840D-SPLSTART-001).
        pub mask: bool,
        /// MD 11604 is 1 (S840D-SPLSTART-001).
        pub level: bool,
        /// An alarm is pending (S840D-SPLSTART-001).
        pub blocked: bool,
        /// The program is not the one of the last run-up ([`crate::sinumerik::spl_file`]).
        pub refused: bool,
        /// What SAFE.SPF does.
        pub program: Program,
    }
}

impl Inputs {
    const fn protected_somewhere(&self) -> bool {
        self.protected_n || self.protected_p
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// DB18.DBW136: bit 0 to 13 (S840D-SPLSTART-015).
        pub status: u16,
        /// The PLC-SPL may run.
        pub plc_spl: bool,
        /// Alarm 27097 is raised in this cycle.
        pub alarm_27097: bool,
    }
}

monitor! { sinumerik::spl_start;
    /// The PLC-SPL is released only in a cycle in which SAFE.SPF ends, or after it has; a start via PROG_EVENT alone is not enough.
    release_after_the_end ["S840D-SPLSTART-003", "S840D-SPLSTART-004", "S840D-SPLSTART-016", "S840D-SPLSTART-006"]:
        when |s| s.outputs.plc_spl && s.before.stage < Stage::Executed
            => s.before.stage == Stage::Executing && s.inputs.program == Program::Ends && !s.before.failed && !s.inputs.power_on;

    /// On the path of the PLC it also takes the report of FC9.
    release_after_the_report ["S840D-SPLSTART-003", "S840D-SPLSTART-002"]:
        when |s| s.outputs.plc_spl && s.before.stage != Stage::Released && !s.after.by_event
            => s.inputs.call == Call::Started;

    /// What is released stays released until power-on.
    released_until_power_on ["S840D-SPLSTART-011"]:
        when |s| s.before.stage == Stage::Released && !s.inputs.power_on
            => s.outputs.plc_spl && s.after == s.before;

    /// So does the comparison run.
    compared_until_power_on ["S840D-SPLKDV-015", "S840D-SPLSTART-011"]:
        when |s| s.before.compared && !s.inputs.power_on
            => s.after.compared;

    /// The comparison starts with the NCK-SPL and with nothing else, in both channels.
    comparison_starts_with_the_program ["S840D-SPLKDV-015", "S840D-SPL-014"]:
        when |s| !s.before.compared && s.after.compared
            => s.after.stage == Stage::Executing && s.outputs.status >> 9 & 3 == 3
                && (s.before.stage == Stage::Ready && s.inputs.call == Call::Start
                    || s.before.stage == Stage::Cyclic && s.inputs.event);

    /// An ASUB needs its machine data and no alarm.
    asub_needs_its_data ["S840D-SPLSTART-001"]:
        when |s| s.before.stage == Stage::Ready && s.inputs.call == Call::Start && !s.inputs.power_on
            && (!s.inputs.mask || !s.inputs.level || s.inputs.blocked)
            => s.after.stage == Stage::Ready && (s.after.failed || s.after.denied);

    /// PROG_EVENT needs MD 11602 only.
    event_needs_the_mask ["S840D-SPLSTART-005", "S840D-SPLSTART-006"]:
        when |s| s.before.stage == Stage::Cyclic && !s.before.failed && !s.before.denied && s.inputs.event && s.inputs.upper
            && !s.inputs.refused && !s.before.bare && !s.inputs.power_on
            => (s.after.stage == Stage::Executing && s.after.by_event && s.outputs.status >> 8 & 1 == 1) == s.inputs.mask;

    /// A protected logic without an axis that has safety functions is refused until power-on.
    protected_needs_an_axis ["S840D-SPLSTART-009", "S840D-ALARM-726"]:
        when |s| s.before.bare && s.inputs.protected_somewhere() && !s.before.compared && !s.inputs.power_on
            => !s.after.compared && (!s.before.denied || s.after.denied);

    /// Without such an axis it starts in the commissioning state of both channels.
    commissioning_needs_no_axis ["S840D-SPLSTART-008"]:
        when |s| s.before.bare && s.before.stage == Stage::Ready && !s.before.failed && !s.before.denied
            && s.inputs.call == Call::Start && s.inputs.upper && s.inputs.mask && s.inputs.level && !s.inputs.blocked
            && !s.inputs.refused && !s.inputs.protected_somewhere() && !s.inputs.power_on
            => s.after.compared && s.after.stage == Stage::Executing;

    /// A call in lower case is no start.
    name_in_upper_case ["S840D-SPLSTART-010"]:
        when |s| s.outputs.alarm_27097
            => !s.inputs.upper && s.after.failed && s.after.stage == s.before.stage;

    /// Without an interface, without the file or with unfit axes nothing starts.
    start_needs_what_it_is_for ["S840D-SPLSTART-018", "S840D-SPL-005", "S840D-SPL-006"]:
        when |s| s.inputs.power_on
            => (s.after.stage == Stage::Waiting) == (s.inputs.parameters && s.inputs.file && s.inputs.axes != Axes::Unfit)
                && s.after.stage <= Stage::Waiting && !s.after.compared && !s.after.failed && !s.after.denied;

    /// Off stays off.
    off_until_power_on ["S840D-SPLSTART-018"]:
        when |s| s.before.stage == Stage::Off && !s.inputs.power_on
            => s.after == s.before && !s.outputs.plc_spl;

    /// A program that breaks off, or an error of FC9, is a start that has failed; the end bit stays 0.
    incomplete_program_fails ["S840D-SPLSTART-004", "S840D-SPLSTART-017"]:
        when |s| s.before.stage == Stage::Executing && s.inputs.program == Program::Breaks && !s.inputs.power_on
            && s.inputs.call != Call::Assign
            => s.after.failed && s.outputs.status >> 13 == 0;

    /// A failed start is repeated by a new call of FB4 only.
    new_call_after_failure ["S840D-SPLSTART-017"]:
        when |s| s.before.failed && !s.inputs.power_on
            => s.after.failed != (s.inputs.call == Call::Assign)
                && s.after.stage == if s.inputs.call == Call::Assign { Stage::Assigning } else { s.before.stage };

    /// A program that is not the one of the last run-up is not started.
    changed_program_does_not_start ["S840D-SPLPROT-009"]:
        when |s| s.inputs.refused && s.before.stage < Stage::Executing && !s.inputs.power_on
            => s.after.stage < Stage::Executing;

    /// The stages of the PLC follow each other.
    stages_in_order ["S840D-SPLSTART-002", "S840D-SPLSTART-015"]:
        when |s| s.after.stage > s.before.stage && s.before.stage >= Stage::Assigning
            => s.before.stage != Stage::Assigning || (s.after.stage == Stage::Ready && s.inputs.call == Call::Assigned);

    /// The step keeps the invariant and shows its state; bits 14 and 15 are not assigned.
    state_stays_consistent ["S840D-SPLSTART-015"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.plc_spl == (s.after.stage == Stage::Released)
                && s.outputs.status == s.after.status(s.inputs.protected_n && s.inputs.protected_p)
                && s.outputs.status >> 14 == 0;
}

/// An attempt to start the program.
struct Attempt {
    by_event: bool,
    allowed: bool,
}

fn attempt(state: &State, inputs: &Inputs) -> Option<Attempt> {
    if state.failed || state.denied {
        return None;
    }
    match (state.stage, inputs.call, inputs.event) {
        (Stage::Ready, Call::Start, _) => Some(Attempt {
            by_event: false,
            allowed: inputs.mask && inputs.level && !inputs.blocked && !inputs.refused,
        }),
        (Stage::Cyclic, _, true) => Some(Attempt {
            by_event: true,
            allowed: inputs.mask && !inputs.refused,
        }),
        _ => None,
    }
}

fn at_power_on(inputs: &Inputs) -> State {
    let fit = inputs.parameters && inputs.file && inputs.axes != Axes::Unfit;
    State {
        stage: if fit { Stage::Waiting } else { Stage::Off },
        parametrised: inputs.parameters,
        stored: inputs.file,
        bare: inputs.axes == Axes::Bare,
        ..State::INITIAL
    }
}

fn attempted(state: State, inputs: &Inputs, attempt: &Attempt) -> State {
    if !inputs.upper || !attempt.allowed {
        State {
            failed: true,
            ..state
        }
    } else if state.bare && inputs.protected_somewhere() {
        State {
            denied: true,
            ..state
        }
    } else {
        State {
            stage: Stage::Executing,
            by_event: attempt.by_event,
            compared: true,
            ..state
        }
    }
}

fn going_on(state: State, inputs: &Inputs) -> State {
    let at = |stage| State { stage, ..state };
    let failed = State {
        failed: true,
        ..state
    };
    let again = State {
        stage: Stage::Assigning,
        failed: false,
        by_event: false,
        ..state
    };
    let assign = inputs.call == Call::Assign && !state.denied;
    if state.failed {
        return if assign { again } else { state };
    }
    match (state.stage, inputs.call) {
        (Stage::Waiting, _) if inputs.plc_up => at(Stage::Cyclic),
        (Stage::Cyclic, _) if assign => again,
        (Stage::Assigning, Call::Assigned) => at(Stage::Ready),
        (Stage::Ready, Call::Error) if !state.denied => failed,
        (Stage::Executing, _) if inputs.program == Program::Breaks => failed,
        (Stage::Executing, Call::Error) if !state.by_event => failed,
        (Stage::Executing, call) if inputs.program == Program::Ends => {
            if state.by_event || call == Call::Started {
                at(Stage::Released)
            } else {
                at(Stage::Executed)
            }
        }
        (Stage::Executed, Call::Started) => at(Stage::Released),
        (Stage::Executed, Call::Error) => failed,
        _ => state,
    }
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let tried = attempt(&state, inputs).filter(|_| !inputs.power_on);
    let after = match &tried {
        _ if inputs.power_on => at_power_on(inputs),
        Some(attempt) => attempted(state, inputs, attempt),
        None => going_on(state, inputs),
    };
    let outputs = Outputs {
        status: after.status(inputs.protected_n && inputs.protected_p),
        plc_spl: after.stage == Stage::Released,
        alarm_27097: tried.is_some() && !inputs.upper,
    };
    (after, outputs)
}
