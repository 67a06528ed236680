//! In the place of `evaluate` of a monitor, for Kani: of the clauses only those of the part that a harness is.
//!
//! `assert_clauses` asserts and covers every `parts`-th clause, but asks `evaluate` for all of them, so that each part had all of them in
//! its formula: of F_BRAKE_TEST none had an answer in 60 s, and takes 10 s without the clauses of the others. A harness names the one
//! of its monitor as a stub; the clauses that it leaves out are those that it does not assert.

use core::sync::atomic::{AtomicU32, Ordering};

use stillpoint_monitors::contract::{Clause, Evaluation, Step};

static PART: AtomicU32 = AtomicU32::new(1);
static PARTS: AtomicU32 = AtomicU32::new(1);

/// Says which part the harness is, from 1, and of how many.
pub(crate) fn choose(part: u32, parts: u32) {
    PART.store(part, Ordering::Relaxed);
    PARTS.store(parts, Ordering::Relaxed);
}

/// The clauses of the part on one step; what is said of the others is not read.
fn evaluate<S: Copy, C: Copy, I: Copy, O: Copy>(
    step: Step<S, C, I, O>,
    clauses: &[Clause<S, C, I, O>],
) -> Evaluation {
    let mut result = Evaluation {
        premises: 0,
        held: 0,
    };
    let parts = PARTS.load(Ordering::Relaxed) as usize;
    let mut place = PART.load(Ordering::Relaxed) as usize - 1;
    while place < clauses.len() {
        let clause = &clauses[place];
        result.premises |= u64::from((clause.premise)(step)) << place;
        result.held |= u64::from((clause.holds)(step)) << place;
        place += parts;
    }
    result
}

macro_rules! own_clauses {
    ($($family:ident: $($monitor:ident)+;)+) => {$(
        pub(crate) mod $family {$(
            #[allow(dead_code, reason = "named by an attribute of Kani only")]
            pub(crate) fn $monitor(
                step: stillpoint_monitors::$family::$monitor::Step,
            ) -> stillpoint_monitors::contract::Evaluation {
                super::evaluate(step, stillpoint_monitors::$family::$monitor::CLAUSES)
            }
        )+}
    )+};
}

own_clauses! {
    sinumerik: channel;
    heidenhain: channel;
    sinamics: message_buffer sbr sls;
    srm: brake_test endzone interpolation load_calibration load_monitor safe_pos sbr_monitor;
}
