//! Cross comparison of the two channels, run by one channel (machine M9): one item of a list in every cycle.
//!
//! The monitor keeps the place in the list and the timers. What is compared is outside: [`State::due`] tells the item of
//! the coming cycle, [`list::differs`] compares it, and the result is an input. Static items (parameters) are always
//! compared. Dynamic items are skipped while a change of a signal may have reached one channel only: the change timer
//! t_chg, started anew by every change of an own signal, and the same timer of the other channel. A change timer of the
//! other channel that outlives the checking timer of 10 t_chg is itself a finding, code 1000.
//!
//! What follows from a finding is decided by [`crate::sinumerik::fault`]. A difference that lasts a whole pass is found; a shorter one
//! may be missed.

pub mod list;

use crate::fields::{Fields, Visitor};
use crate::kernel::{ConfigError, Cycles};
use crate::sinumerik::code::Code;
use list::{Item, Kind};

/// The checking timer is this many change timers.
pub const CHECKING_FACTOR: u32 = 10;

/// The comparison as configured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    t_chg: Cycles,
    first: Item,
    items: &'static [Item],
}

/// The list is no number: a visit keeps it.
impl Fields for Config {
    const ANY: Self = Self {
        t_chg: Cycles::ZERO,
        first: list::ITEMS[0],
        items: &list::ITEMS,
    };

    fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
        visitor.open(name);
        self.t_chg.visit("t_chg", visitor);
        visitor.close();
    }
}

impl Config {
    /// `t_chg`: the tolerance time for the change of signals (SAFE_MODE_SWITCH_TIME). `items`: the list, usually
    /// [`list::ITEMS`]; the same in both channels.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] when `t_chg` is above [`Cycles::TEN_SECONDS`], [`ConfigError::ListLength`] when the
    /// list is empty or longer than 256 items.
    pub fn new(t_chg: Cycles, items: &'static [Item]) -> Result<Self, ConfigError> {
        let t_chg = t_chg.at_most(Cycles::TEN_SECONDS)?;
        match items {
            [first, ..] if items.len() <= 256 => Ok(Self {
                t_chg,
                first: *first,
                items,
            }),
            _ => Err(ConfigError::ListLength),
        }
    }

    /// The tolerance time for the change of signals.
    pub const fn t_chg(&self) -> Cycles {
        self.t_chg
    }

    /// How many cycles one pass takes.
    pub const fn pass(&self) -> usize {
        self.items.len()
    }

    /// The time of the checking timer; in range, since t_chg is at most ten seconds.
    pub const fn checking_time(&self) -> Cycles {
        Cycles::new(self.t_chg.count().saturating_mul(CHECKING_FACTOR))
    }

    /// The item at a place of the list; the first one beyond its end.
    fn item(&self, place: u8) -> Item {
        self.items
            .get(usize::from(place))
            .copied()
            .unwrap_or(self.first)
    }

    /// The place after this one; the first after the last.
    const fn after(&self, place: u8) -> u8 {
        match place.checked_add(1) {
            Some(next) if (next as usize) < self.items.len() => next,
            _ => 0,
        }
    }

    /// Whether the constructor gives this configuration.
    pub fn accepted(&self) -> bool {
        Self::new(self.t_chg, self.items).is_ok_and(|made| made == *self)
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The place in the list, from 0, of the item that is compared in the coming cycle.
        pub item: u8,
        /// What is left of t_chg since the last change of an own signal.
        pub change_timer: Cycles,
        /// What is left of the checking timer while the change timer of the other channel runs; 0 otherwise.
        pub check_timer: Cycles,
        /// The change timer of the other channel runs.
        pub checking: bool,
    }
}

impl State {
    /// At the beginning of the list, no change.
    pub const INITIAL: Self = Self {
        item: 0,
        change_timer: Cycles::ZERO,
        check_timer: Cycles::ZERO,
        checking: false,
    };

    /// The place is in the list, the timers run for at most their time, the checking timer only while it is needed.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        (self.item as usize) < config.items.len()
            && self.change_timer <= config.t_chg
            && self.check_timer <= config.checking_time()
            && self.check_timer.is_zero() != (self.checking && !config.t_chg.is_zero())
    }

    /// The item that the coming cycle compares: with power-on in that cycle the first one.
    pub fn due(&self, config: &Config, power_on: bool) -> Item {
        config.item(if power_on { 0 } else { self.item })
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control: the list begins anew, no timer runs.
        pub power_on: bool,
        /// A safety-related input signal of this channel has changed in this cycle.
        pub change: bool,
        /// The change timer of the other channel ran after its last cycle.
        pub other_changing: bool,
        /// The item that is due ([`State::due`]) differs between the channels.
        pub differs: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The channels differ: STOP F.
        pub discrepancy: bool,
        /// The code of the finding; that of the item comes before 1000. 0 without finding.
        pub code: Code,
        /// The change timer of this channel runs: the other channel must be told.
        pub changing: bool,
        /// Dynamic items are not compared in this cycle.
        pub suspended: bool,
    }
}

monitor! { sinumerik::compare;
    /// A difference of a static item is a finding, whatever timer runs.
    static_difference_is_found ["S840D-STOP-002/f", "S840D-P-26", "S840D-P-27", "S840D-KDV-501", "S840D-KDV-502",
        "S840D-KDV-508", "S840D-KDV-707", "S840D-PARAM-001"]:
        when |s| s.inputs.differs && s.before.due(&s.config, s.inputs.power_on).kind() == Kind::Static
            => s.outputs.discrepancy && s.outputs.code == s.before.due(&s.config, s.inputs.power_on).code();

    /// A difference of a dynamic item is a finding while no change timer runs.
    dynamic_difference_is_found ["S840D-P-26", "S840D-KDV-505/a", "S840D-KDV-509", "S840D-KDV-512", "S840D-KDV-515",
        "S840D-KDV-704", "S840D-KDV-705", "S840D-KDV-706", "S840D-KDV-709", "S840D-KDV-710", "S840D-KDV-713",
        "S840D-KDV-714", "S840D-TEST-019/b", "S840D-GEAR-503", "S840D-GEAR-504", "S840D-GEAR-702", "S840D-GEAR-704"]:
        when |s| s.inputs.differs && s.before.due(&s.config, s.inputs.power_on).kind() == Kind::Dynamic
            && !s.outputs.suspended
            => s.outputs.discrepancy && s.outputs.code == s.before.due(&s.config, s.inputs.power_on).code();

    /// While a change timer runs no dynamic item is a finding.
    change_suspends_dynamic_items ["S840D-P-27", "S840D-KDV-506", "S840D-KDV-716", "S840D-MDTIM-008", "S840D-MDTIM-007"]:
        when |s| (s.outputs.changing || s.inputs.other_changing)
            && s.before.due(&s.config, s.inputs.power_on).kind() == Kind::Dynamic
            => s.outputs.suspended && (!s.outputs.discrepancy || s.outputs.code == Code::TOO_MANY_CHANGES);

    /// Nothing else suspends the comparison.
    suspended_by_changes_only ["S840D-KDV-506"]:
        when |s| !s.outputs.changing && !s.inputs.other_changing
            => !s.outputs.suspended;

    /// Without a difference the only finding is code 1000, and without any finding there is no code.
    agreement_is_no_finding ["S840D-P-33", "S840D-KDV-516"]:
        when |s| !s.inputs.differs || !s.outputs.discrepancy
            => if s.outputs.discrepancy { s.outputs.code == Code::TOO_MANY_CHANGES } else { s.outputs.code.is_none() };

    /// The next item of the list is due in the next cycle, the first after the last, whatever happens.
    list_is_worked_off ["S840D-P-26", "S840D-KDV-504", "S840D-KDV-701", "S840D-TIMING-503", "S840D-PARAM-004"]:
        when |s| !s.inputs.power_on
            => s.after.item == if usize::from(s.before.item) + 1 == s.config.pass() { 0 }
                else { s.before.item.saturating_add(1) };

    /// A change of an own signal starts the whole change timer anew.
    change_starts_the_timer ["S840D-KDV-506", "S840D-KDV-507", "S840D-KDV-715", "S840D-EXT-006", "S840D-OVR-004",
        "S840D-MDTIM-007"]:
        when |s| s.inputs.change
            => s.after.change_timer == s.config.t_chg() && s.outputs.changing != s.config.t_chg().is_zero();

    /// Without a change the change timer runs down, so that the suspension ends.
    suspension_ends ["S840D-P-26", "S840D-KDV-506"]:
        when |s| !s.inputs.change && !s.inputs.power_on
            => s.after.change_timer == s.before.change_timer.tick()
                && s.outputs.changing != s.after.change_timer.is_zero();

    /// The first cycle of the other channel's change timer starts the whole checking timer.
    checking_starts_its_timer ["S840D-KDV-507", "S840D-KDV-715", "S840D-MDTIM-007"]:
        when |s| s.inputs.other_changing && (!s.before.checking || s.inputs.power_on)
            => s.after.checking && s.after.check_timer == s.config.checking_time();

    /// While the other channel's change timer runs on, further changes do not restart the checking timer.
    checking_runs_once ["S840D-P-50", "S840D-KDV-507", "S840D-KDV-715", "S840D-MDTIM-007"]:
        when |s| s.inputs.other_changing && s.before.checking && !s.inputs.power_on && s.before.check_timer.count() > 1
            => s.after.check_timer == s.before.check_timer.tick() && s.outputs.code != Code::TOO_MANY_CHANGES;

    /// A change timer of the other channel that outlives the checking timer is a finding; the checking begins anew.
    lasting_change_is_found ["S840D-P-50", "S840D-KDV-507", "S840D-KDV-715", "S840D-OVR-004", "S840D-MDTIM-007"]:
        when |s| s.inputs.other_changing && s.before.checking && !s.inputs.power_on && s.before.check_timer.count() == 1
            => s.outputs.discrepancy && (s.inputs.differs || s.outputs.code == Code::TOO_MANY_CHANGES)
                && s.after.check_timer == s.config.checking_time();

    /// Code 1000 means just that: no other cause raises it.
    code_1000_needs_a_lasting_change ["S840D-P-50", "S840D-KDV-507"]:
        when |s| s.outputs.code == Code::TOO_MANY_CHANGES
            => s.inputs.other_changing && (s.config.t_chg().is_zero()
                || s.before.checking && !s.inputs.power_on && s.before.check_timer.count() == 1);

    /// The end of the other channel's change timer ends the checking.
    checking_ends_with_the_change ["S840D-KDV-507", "S840D-KDV-715", "S840D-KDV-731"]:
        when |s| !s.inputs.other_changing
            => !s.after.checking && s.after.check_timer.is_zero() && s.outputs.code != Code::TOO_MANY_CHANGES;

    /// Power-on begins the list anew and stops the timers.
    power_on_begins_anew ["S840D-KDV-504"]:
        when |s| s.inputs.power_on
            => s.after.item == if s.config.pass() == 1 { 0 } else { 1 }
                && (s.inputs.change || s.after.change_timer.is_zero());

    /// The step keeps the invariant; STOP F cannot be switched off here.
    state_stays_consistent ["S840D-KDV-503"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.discrepancy != s.outputs.code.is_none();
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let change_timer = if inputs.change {
        config.t_chg
    } else {
        before.change_timer.tick()
    };
    let changing = !change_timer.is_zero();
    let suspended = changing || inputs.other_changing;
    let (check_timer, outlived) = check(before, config, inputs.other_changing);
    let due = config.item(before.item);
    let code = if inputs.differs && (due.kind() == Kind::Static || !suspended) {
        due.code()
    } else if outlived {
        Code::TOO_MANY_CHANGES
    } else {
        Code::NONE
    };
    let after = State {
        item: config.after(before.item),
        change_timer,
        check_timer,
        checking: inputs.other_changing,
    };
    let outputs = Outputs {
        discrepancy: !code.is_none(),
        code,
        changing,
        suspended,
    };
    (after, outputs)
}

/// The checking timer after this cycle, and whether the change timer of the other channel has outlived it.
fn check(before: State, config: &Config, other_changing: bool) -> (Cycles, bool) {
    let time = config.checking_time();
    if !other_changing {
        (Cycles::ZERO, false)
    } else if !before.checking {
        (time, time.is_zero())
    } else {
        let left = before.check_timer.tick();
        if left.is_zero() {
            (time, true)
        } else {
            (left, false)
        }
    }
}
