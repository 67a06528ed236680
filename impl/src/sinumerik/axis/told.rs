//! What one channel tells the other: the only way from one to the other (S840D-ARCH-501).

use crate::kernel::{Position, Speed};
use crate::sinumerik::code::Code;
use crate::sinumerik::compare::list::{self, Item, Limits, Snapshot};
use crate::sinumerik::level::{ExternalStop, InternalStop};
use crate::sinumerik::parameters::Configuration;
use crate::sinumerik::selection::FactorIndex;

/// The result of a test of the shutdown path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TestResult {
    /// No test has ended in the cycle.
    #[default]
    None,
    /// The path has been tested.
    Passed,
    /// A test has failed.
    Failed,
}

/// What one channel tells the other at the end of a cycle; the other one reads it in its next cycle.
///
/// Of the stops only those that arose in the telling channel are told, never one that it was told itself: two channels
/// would hold each other's stops for ever (S840D-STOP-090). The test stop is never told (S840D-STOP-007).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exchange {
    /// The latched internal stop (stop request pass-through).
    pub internal: InternalStop,
    /// The stop requested by the own signals (stop request pass-through).
    pub external: ExternalStop,
    /// STOP F is present (stop request pass-through).
    pub fault: bool,
    /// A STOP C, D or E brakes; RESET must wait in both channels.
    pub braking: bool,
    /// The user agreement.
    pub agreed: bool,
    /// The actual value was set anew in this cycle: the axis was referenced, or parking has ended. Both channels synchronise.
    pub set: bool,
    /// The agreement is one to a referenced position whose comparison with the history is over in this channel.
    pub confirmed: bool,
    /// An own input signal has changed within t_chg, or the forced operating stop has begun or ended (cross comparison); never
    /// with t_chg = 0.
    pub changing: bool,
    /// The own results of the cams (cam synchronisation).
    pub cams: [bool; 8],
    /// A test of the shutdown path of this channel has ended (forced checking).
    pub test: TestResult,
    /// The actual speed, for the tolerance of the comparison of n < n_x.
    pub speed: Speed,
    /// What is compared (cross comparison, synchronisation of the actual values).
    pub snapshot: Snapshot,
}

/// The changing part of a [`Snapshot`], kept for the comparison in the next cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Told {
    /// Result list 1.
    pub results_1: u16,
    /// Result list 2.
    pub results_2: u32,
    /// The safe position, corrected where the actual values are synchronised.
    pub position: Position,
    /// The actual speed.
    pub speed: Speed,
    /// The reference of the operating stop, corrected as the position was when it was captured.
    pub reference: Position,
    /// The external stop request, that of the other channel included; none while the external shutdown is tested, since the
    /// drive must have none then (S840D-TEST-019/a).
    pub external: ExternalStop,
    /// The override factor selected; none where the override is not enabled.
    pub over: FactorIndex,
    /// The forced operating stop began or ended in the cycle: for the comparison like a change of a signal.
    pub turned: bool,
    /// The actual value was set anew in the cycle: the axis was referenced, or parking has ended.
    pub set: bool,
}

impl Told {
    /// Nothing monitored.
    pub const INITIAL: Self = Self {
        results_1: 0,
        results_2: 0,
        position: Position(0),
        speed: Speed(0),
        reference: Position(0),
        external: ExternalStop::None,
        over: FactorIndex::NONE,
        turned: false,
        set: false,
    };

    /// The whole snapshot, with the limits of the cycle and the parameters (S840D-TIMING-512, S840D-KDV-508).
    pub fn snapshot(&self, config: &Configuration) -> Snapshot {
        let words = &config.words;
        Snapshot {
            results_1: self.results_1,
            results_2: self.results_2,
            position: self.position,
            limits: Limits::new(
                self.position,
                words.velo_limit,
                self.reference,
                words.standstill_tol,
                words.velo_x,
                words.pos_tol,
            ),
            external: self.external,
            correction: (self.over != FactorIndex::NONE).then(|| self.over.get()),
            parameters: *words,
        }
    }
}

/// Whether an item differs between what this channel and the other one told in the last cycle.
///
/// Result list 2 is compared with the tolerances of its monitors: around a cam, and around n_x, the channels may see
/// different states (S840D-SN-005, S840D-SN-006, S840D-NX-001), with slip at speeds that differ by as much as is tolerated
/// (S840D-NX-002, S840D-SLIP-505/f); around the end of the modulo range, where one channel may
/// have been folded and the other not, every cam. Their positions are compared there as everywhere (code 3).
pub(super) fn differs(item: Item, own: &Told, other: &Exchange, config: &Configuration) -> bool {
    if item.code() == Code::RESULTS_2 {
        let tolerated = tolerated(own.position, own.speed, config)
            | tolerated(other.snapshot.position, other.speed, config);
        (own.results_2 ^ other.snapshot.results_2) & !tolerated != 0
    } else {
        list::differs(
            item,
            &own.snapshot(config),
            &other.snapshot,
            config.tolerance,
        )
    }
}

/// The bits of result list 2 that may differ at this position and speed.
fn tolerated(position: Position, speed: Speed, config: &Configuration) -> u32 {
    const CAMS: u32 = 0xFFFF;
    const N_X: u32 = 0xF_0000;
    let tolerance = config.tolerance.distance();
    let mut bits = 0;
    for (place, cam) in (0_u32..).zip(&config.cams) {
        if cam.tolerates(position) {
            bits |= 0b11 << (2 * place);
        }
    }
    let range = config.modulo;
    let folded = range.folded(position);
    // Of two channels on the two sides of the end, one has just been folded to the lower one.
    if range.folds() && folded.distance(range.lower()) <= tolerance {
        bits |= CAMS;
    }
    if speed.0.abs_diff(config.words.velo_x.0) <= config.speed_tolerance.0 {
        bits |= N_X;
    }
    bits
}
