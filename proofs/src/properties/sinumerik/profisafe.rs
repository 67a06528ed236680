//! The net data of F modules: which bit is which variable of the safe logic, against its definition.

use stillpoint_monitors::sinumerik::net_data::{Connection, NO_FILTER, of_words};

use super::Subject;
use crate::source::{Source, Verdict};

/// A connection with the numbers that it was made of: lowest variable, number of variables, and the bits that are used.
struct Drawn {
    connection: Connection,
    low: u32,
    count: u32,
    bits: u32,
}

/// Any filter that a connection can have, and any row that fits it; cover 0: without a filter, cover 1: with a filter that has gaps.
fn connection<S: Source>(source: &mut S) -> Result<Drawn, Verdict> {
    let filter = if source.enumerates() {
        source.any_u32(40, NO_FILTER)
    } else if source.any_bool() {
        NO_FILTER
    } else {
        // Up to eight bits, each anywhere.
        let mut bits = 0;
        for _ in 0..source.any_in(1, 8) {
            bits |= 1 << source.any_in(0, 31);
        }
        bits
    };
    let count = if filter == NO_FILTER {
        source.any_in(1, 8)
    } else {
        filter.count_ones()
    };
    if count == 0 {
        return Err(Verdict::Discarded);
    }
    let low = 1 + source.any_u32(2, 64 - count);
    let Ok(connection) = Connection::new(filter, (low + count - 1) * 1000 + low) else {
        return Err(Verdict::Broken("what_fits_is_accepted"));
    };
    let bits = if filter == NO_FILTER {
        (1 << count) - 1
    } else {
        filter
    };
    source.cover(0, filter == NO_FILTER);
    source.cover(1, bits & (bits >> 1) == 0 && count > 1);
    Ok(Drawn {
        connection,
        low,
        count,
        bits,
    })
}

/// From the module: a bit that is used is the variable with as many used ones below it; the others go nowhere; nothing else is
/// written.
pub fn taken_in_order<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let drawn = match connection(source) {
        Ok(drawn) => drawn,
        Err(verdict) => return verdict,
    };
    let net = source.any_u32(3, u32::MAX);
    let bit = source.any_in(0, 31);
    let taken = drawn.connection.take(net);
    let row = ((1_u64 << drawn.count) - 1) << (drawn.low - 1);
    if taken & !row != 0 {
        return Verdict::Broken("only_its_row_is_written");
    }
    let used = drawn.bits >> bit & 1 == 1;
    source.cover(2, !used);
    if !used {
        return match drawn.connection.variable(bit as u8) {
            None => Verdict::Held,
            Some(_) => Verdict::Broken("unused_bits_go_nowhere"),
        };
    }
    let below = (drawn.bits & ((1_u32 << bit) - 1)).count_ones();
    let variable = drawn.low + below;
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
    let bit = source.any_in(0, 31);
    let given = drawn.connection.give(outse, outsep);
    let used = drawn.bits >> bit & 1 == 1;
    source.cover(2, !used);
    let below = (drawn.bits & ((1_u32 << bit) - 1)).count_ones();
    let place = drawn.low + below - 1;
    let expected = used && outse >> place & outsep >> place & 1 == 1;
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
