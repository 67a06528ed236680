//! One axis in one channel: everything that one of the two monitoring channels does for an axis in a cycle.
//!
//! The channel of the monitors ([`crate::sinumerik::channel`]) with the cams, the gear stage, the user agreement and referencing, the
//! cross comparison with the other channel, the synchronisation of the actual values, both tests of the shutdown paths and
//! their interval, and the alarms. Order of the cycle:
//!
//! ```text
//! gear -> history -> agreement -> reference -> comparison, synchronisation -> shutdown_test -> channel -> cams -> results
//! ```
//!
//! The two channels are independent (S840D-ARCH-501): a channel sees its own inputs ([`Local`]) and what the other channel
//! has told one cycle ago ([`Exchange`]), nothing else. [`crate::sinumerik::pair`] steps two of them against each other.
//!
//! Decisions of this module, where the manual leaves them open:
//!
//! * The comparison works on what both channels told in the cycle before, so that both values are of the same instant.
//! * Result list 2 is compared with tolerance: around a cam, the ends of the modulo range and n_x the channels may see
//!   different states (S840D-SN-005, S840D-NX-001).
//! * The beginning and the end of the operating stop that a STOP C, D or E forces count for the comparison like a change of a
//!   signal: the channels reach it one cycle apart when one of them was told the stop, so t_chg must pass before result
//!   list 1 is compared again. It is no signal that changes too often, so without t_chg nothing is told (code 1000); and what
//!   power-on ends is no change.
//! * A change of the gear stage suspends nothing: the actual values are compared during the changeover (S840D-GEAR-504).
//! * RESET is joint: both channels take it only while neither brakes and both have latched the same stop and both or none a
//!   fault. A stop is thus acknowledged in both or in none, and no channel latches a stop anew that the other one still
//!   tells (S840D-P-45); except where a STOP A by signal or a test has come over the stop in one of them: it keeps the stop and
//!   tells it again. Stops and faults spread in one cycle, so the condition is met soon.
//! * The position is stored in every cycle after one with the operating stop, and with enabled limit switches or cams
//!   cyclically, but only while the axis is referenced: an earlier position is not a safe one (S840D-REF-009, A-23
//!   SAVE_EVERY_SBH).
//! * A failed test of a shutdown path raises its code (1009, 1010) as alarm beside STOP A; STOP F, which would follow too, has
//!   no effect beneath STOP A.
//!
//! Bound on the work of a cycle: every monitor steps once, the cam eight times; one item of the comparison list is
//! compared. The only loops run over the eight cams and the fields of the result lists.

mod cycle;
mod laws;
mod told;

use crate::kernel::{Position, Speed};
use crate::sinumerik::alarm::Alarms;
use crate::sinumerik::code::Code;
use crate::sinumerik::interface::{Sga, Sge};
use crate::sinumerik::parameters::Configuration;
use crate::sinumerik::{
    agreement, cam, channel, compare, forced_check, gear, history, reference, shutdown_test, slip,
};

pub(crate) use cycle::transition;
pub use laws::*;
pub use told::{Exchange, TestResult, Told};

/// Which of the two channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Side {
    /// The channel of the control.
    #[default]
    Nck,
    /// The channel of the drive.
    Drive,
}

/// The parameters of an axis in one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    side: Side,
    monitors: Configuration,
}

impl Config {
    /// `side`: the channel; the test of the external shutdown exists in the NCK only. `monitors`: from
    /// [`crate::sinumerik::parameters::Parameters::validate`], the same for both channels.
    pub const fn new(side: Side, monitors: Configuration) -> Self {
        Self { side, monitors }
    }

    /// The channel.
    pub const fn side(&self) -> Side {
        self.side
    }

    /// The configurations of the monitors.
    pub const fn monitors(&self) -> &Configuration {
        &self.monitors
    }
}

/// The state between two cycles. `agreement.agreed` and `history` are non-volatile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// The monitors.
    pub channel: channel::State,
    /// The cams SN1+, SN1-, SN2+ to SN4-.
    pub cams: [cam::State; 8],
    /// Gear stage.
    pub gear: gear::State,
    /// User agreement.
    pub agreement: agreement::State,
    /// Referencing.
    pub reference: reference::State,
    /// Stored position.
    pub history: history::State,
    /// Synchronisation of the actual values.
    pub slip: slip::State,
    /// Place in the list of the comparison.
    pub compare: compare::State,
    /// Test of the external shutdown; idle in the drive.
    pub shutdown_test: shutdown_test::State,
    /// How long the tests of the shutdown paths count.
    pub forced_check: forced_check::State,
    /// What was told about the monitoring in the last cycle.
    pub told: Told,
    /// The input signals of the last cycle.
    pub sge: Sge,
}

/// The state of an axis in one channel is small.
const _: () = assert!(size_of::<State>() < 512);

impl State {
    /// Switched off, as delivered.
    pub const INITIAL: Self = Self::restored(false, None);

    /// The state after power-on with what is kept through power-off: the agreement and the stored position.
    pub const fn restored(agreed: bool, standstill: Option<Position>) -> Self {
        Self {
            channel: channel::State::INITIAL,
            cams: [cam::State::INITIAL; 8],
            gear: gear::State::INITIAL,
            agreement: agreement::State::restored(agreed),
            reference: reference::State::INITIAL,
            history: history::State::restored(standstill),
            slip: slip::State::INITIAL,
            compare: compare::State::INITIAL,
            shutdown_test: shutdown_test::State::INITIAL,
            forced_check: forced_check::State::INITIAL,
            told: Told::INITIAL,
            sge: Sge::read(&[0; crate::sinumerik::interface::BLOCK]),
        }
    }

    /// The state of every monitor is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let monitors = &config.monitors;
        self.channel.invariant(&monitors.channel)
            && self
                .cams
                .iter()
                .zip(&monitors.cams)
                .all(|(state, config)| state.invariant(config))
            && self.gear.invariant(&monitors.gear)
            && self.agreement.invariant(&monitors.agreement)
            && self.reference.invariant(&monitors.reference)
            && self.history.invariant(&monitors.history)
            && match &monitors.slip {
                Some(slip) => self.slip.invariant(slip),
                None => self.slip == slip::State::INITIAL,
            }
            && self.compare.invariant(&monitors.compare)
            && self.shutdown_test.invariant(&monitors.shutdown_test)
            && (config.side == Side::Nck || self.shutdown_test == shutdown_test::State::INITIAL)
            && self.forced_check.invariant(&monitors.forced_check)
    }
}

/// What this channel itself sees in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Local {
    /// Power-on of drive and control.
    pub power_on: bool,
    /// Drive and control have run up.
    pub run_up: bool,
    /// NC-RESET.
    pub reset: bool,
    /// The cross comparison of the safe logic has been started.
    pub spl_started: bool,
    /// An error of the safe logic or of PROFIsafe is present.
    pub spl_error: bool,
    /// The input signals of the axis.
    pub sge: Sge,
    /// SGE "status pulses cancelled": 1 is cancelled.
    pub feedback: bool,
    /// SGE "test stop external shutdown" (NCK only), of this axis or of any other one of the same output
    /// ([`crate::sinumerik::shutdown_group::selected`]): 1 selects the test.
    pub shutdown_test_select: bool,
    /// The position read in this cycle.
    pub position: Position,
    /// The speed at the encoder in pulses per cycle, for its limit frequency; ignored with two encoders.
    pub encoder_speed: Speed,
    /// Parking is selected.
    pub parking: bool,
    /// The reference approach is correctly done, or the absolute position is transferred: from the cycle in which a
    /// "not referenced" axis sees it, `position` counts from the new zero.
    pub referenced: bool,
    /// A new reference approach, or the reference is lost.
    pub reference_lost: bool,
    /// The reference position, or the power-on position of an absolute encoder.
    pub refpos: Position,
    /// The signed distance travelled from power-on to the reference point; 0 with an absolute encoder.
    pub travelled: i32,
    /// The user gives the agreement.
    pub set_agreement: bool,
    /// The user withdraws the agreement.
    pub cancel_agreement: bool,
    /// Key switch in position 3, or the password has been entered.
    pub key: bool,
    /// The machine data of the agreement have been altered by hand.
    pub altered: bool,
}

impl Local {
    /// An axis in operation of which nothing is asked: run up, the safe logic started, neither SBH nor SG selected, no stop
    /// requested, at position 0.
    pub fn idle() -> Self {
        Self {
            run_up: true,
            spl_started: true,
            sge: Sge {
                sbh_sg_off: true,
                sbh_off: true,
                ..Sge::UNUSED
            },
            ..Self::default()
        }
    }
}

/// The inputs of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// What this channel sees itself.
    pub local: Local,
    /// What the other channel told at the end of its last cycle.
    pub other: Exchange,
}

/// The outputs of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// What is told to the other channel, which reads it in its next cycle.
    pub exchange: Exchange,
    /// The output signals of the axis; "status pulses cancelled" repeats the feedback.
    pub sga: Sga,
    /// The monitors.
    pub channel: channel::Outputs,
    /// Gear stage.
    pub gear: gear::Outputs,
    /// User agreement.
    pub agreement: agreement::Outputs,
    /// Referencing.
    pub reference: reference::Outputs,
    /// Comparison with the other channel.
    pub compare: compare::Outputs,
    /// The position after the synchronisation of the actual values; the measured one without.
    pub position: Position,
    /// Test of the external shutdown; in the drive always idle.
    pub shutdown_test: shutdown_test::Outputs,
    /// Forced checking.
    pub forced_check: forced_check::Outputs,
    /// The code of STOP F found in this cycle; 0 without finding.
    pub code: Code,
    /// RESET was taken in this cycle.
    pub reset_taken: bool,
    /// The alarms whose cause is present in this cycle.
    pub alarms: Alarms,
}
