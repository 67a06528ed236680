//! The values of referencing, of the tests, and of a drive without encoder.

use stillpoint_monitors::kernel::{Cycles, Distance, Speed};
use stillpoint_monitors::sinamics::{
    brake_test, brake_test_request, drive_test, encoderless, reference, safe_position, start_phase,
};

use super::{Reader, SBT, brake, brake_cycles};
use crate::families::values::{Fit, cell, fit};

/// 2 s for the user agreement, 5 s to switch on without encoder, 11 s for an external brake, 2 min of increased tolerance, in us.
const AGREEMENT_US: u32 = 2_000_000;
const RESTART_US: u32 = 5_000_000;
const EXTERNAL_US: u32 = 11_000_000;
pub(super) const TOLERANT_US: u32 = 120_000_000;
/// For so long an axis stands until the brake test knows its load: the manual has no time for it.
pub(super) const MEASURING_US: i64 = 100_000;

impl Reader<'_> {
    pub(super) fn reference(&self) -> Fit<reference::Config> {
        let window = self.within(AGREEMENT_US);
        let config = reference::Config::new(window, self.distance("p9544"), Default::default());
        fit("p9544", config)
    }

    pub(super) fn transferred(&self) -> Fit<safe_position::Config> {
        // A scale that the monitor does not have is refused by it, as 0 is.
        let scale = u16::try_from(self.cell("p9574")).unwrap_or(0);
        let short = self.cell("p60022") == 901;
        let absolute = self.axis.has("absolute position");
        fit(
            "p9574",
            safe_position::Config::new(true, absolute, short, scale),
        )
    }

    pub(super) fn bare(
        &self,
        unselected: bool,
    ) -> Fit<(start_phase::Config, encoderless::Config, bool)> {
        let start = start_phase::Config::new(self.time("p9586"));
        let window = self.within(RESTART_US);
        let ssm = self.speed("p9546", 0) > Speed(0) && !self.is("p9509_0");
        let sdi = !self.is("p9509_8");
        let restart = encoderless::Config::new(window, window, ssm, sdi, unselected);
        Ok((fit("p9586", start)?, fit("the 5 s", restart)?, unselected))
    }

    pub(super) fn drive_test(&self) -> Fit<drive_test::Config> {
        let (interval, longest) = (self.time("p9559"), self.time("p9557"));
        let config = drive_test::Config::new(interval, longest, self.is("p9507_6"));
        fit("p9557 and p9559", config)
    }

    /// The brake test by the test stop, of brake 1 where it is the motor's (S120-SBT-015).
    pub(super) fn test_request(&self, extended: bool) -> brake_test_request::Config {
        brake_test_request::Config {
            by_test_stop: extended
                && self.axis.has(SBT)
                && self.cell("p10203") == 2
                && brake(self.axis, 0) == brake_test::Kind::Motor,
            // The file has no p10218, of which the manual does not say which number is which sign.
            negative: false,
            automatic: brake_test_request::SbtAuto::default(),
        }
    }

    pub(super) fn brake_test(&self) -> Fit<brake_test::Config> {
        let of_brake = |k: usize| {
            let sequence = |time, tolerance| brake_test::Sequence {
                duration: self.cycles_of(time, k),
                tolerance: Distance(
                    u32::try_from(cell(&self.axis.values, tolerance, k)).unwrap_or(u32::MAX),
                ),
            };
            brake_test::Brake {
                kind: brake(self.axis, k),
                ramp: self.cycles_of("p10208", k),
                first: sequence("p10211", "p10212"),
                second: sequence("p10221", "p10222"),
            }
        };
        // The file has no p1216: the brake opens as fast as it closes. By then its winding has no current for a cycle.
        let moves = Cycles::new(brake_cycles(self.machine, self.axis) + 1);
        let external = self.within(EXTERNAL_US);
        let config = brake_test::Config::new(of_brake(0), of_brake(1), external, moves, moves);
        fit("p10208 to p10222", config)
    }
}
