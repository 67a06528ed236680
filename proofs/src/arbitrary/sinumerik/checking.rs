//! The monitors that check the monitoring: comparison, and what the runs of synchronisation and history share.

use stillpoint_monitors::kernel::{Cycles, Distance, Position};
use stillpoint_monitors::sinumerik::compare::list::{CLASSES, ITEMS, Item};
use stillpoint_monitors::sinumerik::{compare, slip};

use crate::source::Source;

/// Any tolerance; the enumeration takes 0 to 3 and the greatest.
pub fn tolerance<S: Source>(source: &mut S) -> Distance {
    Distance(source.any_u32(3, u32::MAX))
}

/// Any position; the enumeration takes -`reach` to `reach` and both ends of the range.
pub fn position_near<S: Source>(source: &mut S, reach: u32) -> Position {
    Position(source.any_i32(reach))
}

/// The longest list that is accepted.
const LONGEST: usize = 256;

/// All items again and again. A step reads one item; with the lists of this that begin anywhere in the first round, every item
/// stands at every place of lists of every length.
static ROUNDS: [Item; ITEMS.len() + LONGEST] = {
    let mut all = [ITEMS[0]; ITEMS.len() + LONGEST];
    let mut place = 0;
    while place < all.len() {
        all[place] = ITEMS[place % ITEMS.len()];
        place += 1;
    }
    all
};

/// A list of any length; the enumeration takes a short one, the list of models and the whole one.
pub fn items<S: Source>(source: &mut S) -> &'static [Item] {
    if !source.enumerates() {
        let first = source.any_in(0, ITEMS.len() as u32 - 1) as usize;
        let length = source.any_in(1, LONGEST as u32) as usize;
        return ROUNDS.get(first..first + length).unwrap_or(&ITEMS);
    }
    match source.any_in(0, 2) {
        0 => CLASSES.get(..1).unwrap_or(&CLASSES),
        1 => &CLASSES,
        _ => &ITEMS,
    }
}

/// Any step of the comparison. By hand, since the list is no number, and place and checking timer depend on it.
pub fn compare<S: Source>(
    source: &mut S,
) -> Option<(compare::State, compare::Config, compare::Inputs)> {
    let t_chg = source.any_delay(Cycles::TEN_SECONDS);
    let config = compare::Config::new(t_chg, items(source)).ok()?;
    let last = u32::try_from(config.pass()).ok()?.saturating_sub(1);
    let checking = source.any_bool();
    let check_timer = if checking {
        source.any_cycles(config.checking_time())
    } else {
        Cycles::ZERO
    };
    let state = compare::State {
        item: u8::try_from(source.any_in(0, last)).ok()?,
        change_timer: source.any_cycles(t_chg),
        check_timer,
        checking,
    };
    state.invariant(&config).then(|| {
        let inputs = compare::Inputs {
            power_on: source.any_bool(),
            change: source.any_bool(),
            other_changing: source.any_bool(),
            differs: source.any_bool(),
        };
        (state, config, inputs)
    })
}

/// Any accepted configuration of the synchronisation.
pub fn slip_config<S: Source>(source: &mut S) -> Option<slip::Config> {
    let (dead, tol) = (tolerance(source), tolerance(source));
    slip::Config::new(dead, tol, source.any_bool(), source.any_bool()).ok()
}
