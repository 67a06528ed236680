//! The wiring between the blocks and the drive, as `spec/families/srm-fblocks/interconnection.toml` has it.

use stillpoint_monitors::srm::common::{UNLIMITED, bit};
use stillpoint_monitors::srm::min_max;

use super::blocks::{Stop, Told};
use super::signals::{Flag, Read};

/// What the wiring tells the drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Logic {
    /// No SS1 is asked for.
    pub run: bool,
    /// No STO is asked for.
    pub torque: bool,
    pub sdi_positive: bool,
    pub sdi_negative: bool,
    /// mm/min.
    pub sls_limit: i32,
}

/// The wiring: the machine `wiring` of the tables.
pub(super) fn logic(told: &Told, read: &Read) -> Logic {
    let Told {
        pos,
        range,
        ramp,
        brake,
        load,
        ..
    } = told;
    let known = pos.pos_valid && (pos.referenced || read.is(Flag::ToReference)) && pos.v_valid;
    let loads = load.stat_load_ok && load.dyn_load_ok && load.min_load_ok;
    let run = known
        && range.x_negative_ok
        && range.x_positive_ok
        && told.keeps_limits()
        && loads
        && read.asked == Stop::None;
    let limit = min_max::Monitor::new(min_max::Config).step(&min_max::Inputs {
        in1: range.sls_threshold,
        in2: brake.sls_threshold,
        in3: load.sls_threshold,
        in4: UNLIMITED,
        in5: UNLIMITED,
        in6: UNLIMITED,
        in7: UNLIMITED,
        in8: UNLIMITED,
        mode: false,
    });
    Logic {
        run,
        torque: ramp.sbr_ok && read.asked != Stop::Sto,
        sdi_positive: range.move_positive_ok && load.move_positive_ok && brake.release_dir,
        sdi_negative: range.move_negative_ok && load.move_negative_ok,
        sls_limit: limit.q,
    }
}

/// Why the drive is stopped: the first reason of the list.
pub(super) fn cause(told: &Told, read: &Read) -> &'static str {
    let Told {
        pos,
        range,
        ramp,
        brake,
        load,
        ..
    } = told;
    let reasons = [
        (!ramp.sbr_ok, "does not brake along its ramp"),
        (read.asked != Stop::None, "asked for"),
        (bit(pos.diag, 9), "encoder fault"),
        (bit(pos.diag, 8), "POS1 and POSSI have gone apart"),
        (
            bit(pos.diag, 3) || bit(pos.diag, 4),
            "position out of its range",
        ),
        (bit(pos.diag, 5), "faster than V_MAX"),
        (
            bit(pos.diag, 6),
            "drift of the encoders, or their counter stands",
        ),
        (!pos.pos_valid || !pos.v_valid, "no safe position"),
        (
            !pos.referenced && !read.is(Flag::ToReference),
            "not referenced",
        ),
        (!range.x_negative_ok, "lower end of the range passed"),
        (!range.x_positive_ok, "upper end of the range passed"),
        (bit(range.diag, 9), "too fast before the end of the range"),
        (!range.sls_ok, "retraction too fast"),
        (!brake.sls_ok, "too fast without a passed brake test"),
        (!load.min_load_ok, "slack rope"),
        (!load.stat_load_ok || !load.dyn_load_ok, "overload"),
        (!load.sls_ok, "too fast with this load"),
    ];
    let first = reasons.into_iter().find(|(is, _)| *is);
    first.map_or("a block of it has not been called", |(_, text)| text)
}
