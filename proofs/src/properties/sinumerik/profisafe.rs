//! The net data of F modules: which bit is which variable of the safe logic, against its definition.

use stillpoint_monitors::sinumerik::net_data::{
    Connection, NO_FILTER, Row, Unfit, WIDEST, of_words,
};

use super::Subject;
use crate::source::{Source, Verdict};

/// A connection with what it was made of: the lowest variable and the bits that are used, in ascending order.
struct Drawn {
    connection: Connection,
    low: u32,
    places: [u32; WIDEST as usize],
    count: usize,
    bits: u32,
}

/// Any filter that a connection can have, and any row that fits it; cover 0: without a filter, cover 1: with a filter that has gaps.
fn connection<S: Source>(source: &mut S) -> Result<Drawn, Verdict> {
    let (places, count, without) = if source.enumerates() {
        places_of(source)
    } else {
        any_places(source)
    };
    if count == 0 {
        return Err(Verdict::Discarded);
    }
    let mut bits = 0;
    for (k, place) in places.iter().enumerate() {
        if k < count {
            bits |= 1_u32 << (place & 31);
        }
    }
    let low = 1 + source.any_u32(2, 64 - count as u32);
    let filter = if without { NO_FILTER } else { bits };
    let row = Row::between(low, low + count as u32 - 1);
    let Ok(connection) = row.and_then(|row| Connection::of(filter, row)) else {
        // That it fits is counted by net_data_row.
        return Err(Verdict::Discarded);
    };
    source.cover(0, without);
    source.cover(1, bits & (bits >> 1) == 0 && count > 1);
    Ok(Drawn {
        connection,
        low,
        places,
        count,
        bits,
    })
}

/// The bits of a narrow filter or, in the place of the last one, the first bits of none; how many; whether there is no filter.
fn places_of<S: Source>(source: &mut S) -> ([u32; WIDEST as usize], usize, bool) {
    let filter = source.any_u32(40, NO_FILTER);
    let mut places = [0; WIDEST as usize];
    if filter == NO_FILTER {
        for (k, place) in places.iter_mut().enumerate() {
            *place = k as u32;
        }
        return (places, source.any_in(1, 8) as usize, true);
    }
    let mut count = 0;
    for bit in 0..32 {
        if filter >> bit & 1 == 1 && count < places.len() {
            places[count] = bit;
            count += 1;
        }
    }
    (places, count, false)
}

/// Up to eight bits, each anywhere above the one before it.
fn any_places<S: Source>(source: &mut S) -> ([u32; WIDEST as usize], usize, bool) {
    let count = source.any_in(1, 8) as usize;
    let without = source.any_bool();
    let mut places = [0; WIDEST as usize];
    let mut next = 0;
    for (k, place) in places.iter_mut().enumerate() {
        if without {
            *place = k as u32;
        } else if k < count {
            *place = source.any_in(next, 32 - (count - k) as u32);
            next = *place + 1;
        }
    }
    (places, count, without)
}

/// The datum of a row, 00aaabbb, is its ends; every number that is none is refused.
///
/// A filter fits it if it chooses as many bits as it has variables.
///
/// Cover 0: a row of eight; cover 1: a number that is no row.
pub fn row_is_its_ends<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let low = source.any_in(0, 999);
    let high = source.any_u32(70, u32::MAX / 1000 - 1);
    let fits = low > 0 && low <= high && high <= 64 && high - low < 8;
    let row = Row::new(high * 1000 + low);
    source.cover(0, fits && high - low == 7);
    source.cover(1, !fits);
    let held = match row {
        Ok(row) => {
            let up_to = |variable: u32| u64::MAX.checked_shr(64 - variable).unwrap_or(0);
            let filter = source.any_u32(7, NO_FILTER);
            let fit = filter == NO_FILTER || filter.count_ones() == high - low + 1;
            fits && row.variables() == up_to(high) & !up_to(low - 1)
                && Connection::of(filter, row).is_ok() == fit
        }
        Err(unfit) => !fits && unfit == Unfit::Row,
    };
    if held {
        Verdict::Held
    } else {
        Verdict::Broken("row_is_its_ends")
    }
}

/// From the module: the used bits are, in their order, the variables of the row; the others go nowhere; nothing else is written.
pub fn taken_in_order<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let drawn = match connection(source) {
        Ok(drawn) => drawn,
        Err(verdict) => return verdict,
    };
    let net = source.any_u32(3, u32::MAX);
    let taken = drawn.connection.take(net);
    let row = ((1_u64 << drawn.count) - 1) << (drawn.low - 1);
    if taken & !row != 0 {
        return Verdict::Broken("only_its_row_is_written");
    }
    let k = source.any_in(0, WIDEST.into()) as usize;
    if k >= drawn.count {
        let bit = source.any_in(0, 31);
        let used = drawn.bits >> bit & 1 == 1;
        source.cover(2, !used);
        return match drawn.connection.variable(bit as u8) {
            Some(_) if !used => Verdict::Broken("unused_bits_go_nowhere"),
            None if used => Verdict::Broken("used_bits_are_variables"),
            _ => Verdict::Held,
        };
    }
    let (bit, variable) = (drawn.places[k & 7] & 31, drawn.low + k as u32);
    if drawn.connection.variable(bit as u8) != Some(variable as u8)
        || taken >> (variable - 1) & 1 != u64::from(net >> bit & 1)
    {
        return Verdict::Broken("bits_are_packed_in_order");
    }
    Verdict::Held
}

/// To the module: a bit that is used is its variable where both channels have it; every other bit is 0.
pub fn given_in_order<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let drawn = match connection(source) {
        Ok(drawn) => drawn,
        Err(verdict) => return verdict,
    };
    let low = source.any_u32(1, u32::MAX);
    let high = source.any_u32(0, u32::MAX);
    let (outse, outsep) = (
        of_words([low, high]),
        of_words([source.any_u32(1, u32::MAX), high]),
    );
    let given = drawn.connection.give(outse, outsep);
    if given & !drawn.bits != 0 {
        return Verdict::Broken("unused_bits_are_zero");
    }
    let k = source.any_in(0, u32::from(WIDEST) - 1) as usize;
    if k >= drawn.count {
        return Verdict::Held;
    }
    let (bit, place) = (drawn.places[k & 7] & 31, drawn.low + k as u32 - 1);
    let expected = outse & outsep & 1 << place != 0;
    source.cover(2, expected);
    if (given >> bit & 1 == 1) == expected {
        Verdict::Held
    } else {
        Verdict::Broken("variables_are_spread_in_order")
    }
}

/// What is given to a module and taken from it again is what it was, and the other way round.
pub fn there_and_back<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let drawn = match connection(source) {
        Ok(drawn) => drawn,
        Err(verdict) => return verdict,
    };
    let net = source.any_u32(8, u32::MAX);
    let variables = of_words([source.any_u32(8, u32::MAX), source.any_u32(0, u32::MAX)]);
    let connection = drawn.connection;
    let back = connection.take(connection.give(variables, variables));
    if back != variables & connection.row().variables() {
        return Verdict::Broken("variables_come_back");
    }
    let taken = connection.take(net);
    if connection.give(taken, taken) != net & drawn.bits {
        return Verdict::Broken("bits_come_back");
    }
    Verdict::Held
}
