//! One drive alone at its F host: safety telegrams as bytes in, safety telegrams as bytes out. Both channels decode what comes, each for
//! itself, and the drive tells what both of them say.

use stillpoint_machine::{Axis, Machine};
use stillpoint_monitors::sinamics::telegram::control::ControlWord2;
use stillpoint_monitors::sinamics::telegram::frame::{Frame, Positioned, Received, Sent, Telegram};
use stillpoint_monitors::sinamics::telegram::status::{StatusWord1, StatusWord2};
use stillpoint_monitors::sinamics::telegram::values::sls_limit_active;

use super::channel::Pair;
use super::said::Said;
use super::signals::{self, Flag, Input, Number, Read};
use super::values::{self, Values};
use crate::families::values::cell;

/// What a drive reads in a cycle beside its telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Around {
    /// The position of each channel, in increments.
    pub positions: [i32; 2],
    /// ON/OFF1.
    pub on: bool,
}

/// A drive, running.
pub struct OnBus {
    telegram: Telegram,
    values: Values,
    inputs: Vec<Input>,
    /// p9531\[0\] in increments per cycle.
    highest: u32,
    pair: Option<Pair>,
    said: [Said; 2],
}

impl OnBus {
    /// An axis of a machine.
    ///
    /// # Errors
    /// It is not controlled by PROFIsafe, or the monitors refuse a value.
    pub fn new(machine: &Machine, axis: usize) -> Result<Self, String> {
        let known: &Axis = machine.axes.get(axis).ok_or("there is no such axis")?;
        let number = cell(&known.values, "p9611", 0);
        let telegram = Telegram::ALL
            .into_iter()
            .find(|telegram| *telegram as i64 == number)
            .ok_or("the axis has no safety telegram")?;
        let values = values::axes(machine)?
            .into_iter()
            .nth(axis)
            .ok_or("the axis has no monitors")?;
        let extended = values.extended.as_ref();
        Ok(Self {
            telegram,
            inputs: signals::inputs(known),
            highest: extended.map_or(0, |extended| extended.limits[0].0),
            values,
            pair: None,
            said: Default::default(),
        })
    }

    /// Its telegram.
    pub const fn telegram(&self) -> Telegram {
        self.telegram
    }

    /// One cycle: what has come from the host, if anything has, and what the drive answers.
    pub fn step(&mut self, received: Option<&[u8]>, around: Around) -> Frame {
        let received = received.and_then(|bytes| Received::decode(self.telegram, bytes).ok());
        let both = around.positions.map(|position| {
            let read = match &received {
                Some(received) => selected(received, position),
                None => Read::at_rest(position).flags(&[(Flag::Telegram, false)]),
            };
            read.flags(&[(Flag::On, around.on)]).only(&self.inputs)
        });
        let pair = self
            .pair
            .get_or_insert_with(|| Pair::new(&self.values, true, &both));
        self.said = pair.step(&both);
        self.answer().encode()
    }

    /// What both channels say.
    fn answer(&self) -> Sent {
        let said = &self.said;
        let both = |test: fn(&Said) -> bool| said.iter().all(test);
        let one = |test: fn(&Said) -> bool| said.iter().any(test);
        let level = said[0].sls_level;
        let word = StatusWord2 {
            sto_active: both(|s| s.sto),
            ss1_active: both(|s| s.ss1),
            ss2_active: both(|s| s.ss2),
            sos_active: both(|s| s.sos),
            sls_active: both(|s| s.sls),
            slp_active: both(|s| s.slp && s.reference.safe),
            internal_event: one(|s| s.event),
            sls_level_0: level & 1 != 0,
            sls_level_1: level & 2 != 0,
            sdi_positive_active: both(|s| s.sdi[0]),
            sdi_negative_active: both(|s| s.sdi[1]),
            ssm: both(|s| s.ssm),
            slp_area_2: both(|s| s.slp_second),
            position_valid: both(|s| s.transferred.valid),
            safely_referenced: both(|s| s.reference.safe),
            ss2e_active: both(|s| s.ss2e),
            sos_selected: one(|s| s.sos_selected),
            slp_upper_maintained: both(|s| s.slp_kept[0]),
            slp_lower_maintained: both(|s| s.slp_kept[1]),
            ..StatusWord2::decode(0)
        };
        let word = match self.values.extended {
            Some(_) => word,
            None => word.basic(),
        };
        let told = Positioned {
            word,
            limit: sls_limit_active(said[0].sls_limit.0, self.highest).unwrap_or(0),
            cycle: said[0].transferred.cycle as i16,
        };
        match self.telegram {
            Telegram::T901 => Sent::T901(told, said[0].transferred.short),
            Telegram::T902 => Sent::T902(told, said[0].transferred.long),
            Telegram::T31 => Sent::T31(word),
            _ => Sent::T30(shortened(word)),
        }
    }
}

/// The bits that S_ZSW1 has as well.
const fn shortened(word: StatusWord2) -> StatusWord1 {
    StatusWord1 {
        sto_active: word.sto_active,
        ss1_active: word.ss1_active,
        ss2_active: word.ss2_active,
        sos_active: word.sos_active,
        sls_active: word.sls_active,
        slp_active: word.slp_active,
        internal_event: word.internal_event,
        sls_level_0: word.sls_level_0,
        sls_level_1: word.sls_level_1,
        sos_selected: word.sos_selected,
        sdi_positive_active: word.sdi_positive_active,
        sdi_negative_active: word.sdi_negative_active,
        ssm: word.ssm,
    }
}

/// What a telegram selects.
fn selected(received: &Received, position: i32) -> Read {
    let at_rest = Read::at_rest(position);
    let word = match received {
        // The bits of S_STW1 stand in S_STW2 where they stand in it; what it does not have is not selected.
        Received::T30(word) => ControlWord2 {
            ss2e: true,
            ..ControlWord2::decode(word.encode().into())
        },
        Received::T31(word) | Received::Limited(word, _) => *word,
        Received::Nothing | Received::T701(..) => return at_rest,
    };
    let read = at_rest
        .flags(&[
            (Flag::Sto, word.sto),
            (Flag::Ss1, word.ss1),
            (Flag::Ss2, word.ss2),
            (Flag::Sos, word.sos),
            (Flag::Sls, word.sls),
            (Flag::Slp, word.slp),
            (Flag::Ack, word.internal_event_ack),
            (Flag::SdiPositive, word.sdi_positive),
            (Flag::SdiNegative, word.sdi_negative),
            (Flag::SlpRange, word.slp_area_2),
            (Flag::GearTolerance, word.gear_tolerance),
            (Flag::Ss2e, word.ss2e),
        ])
        .number(Number::Level, i32::from(word.sls_level()) - 1)
        .number(Number::Stage, word.gear_stage().into());
    match received {
        // A number with its highest bit is no limit, as a negative one is none.
        Received::Limited(_, limit) => read.number(Number::Limit, i32::from(*limit as i16)),
        _ => read,
    }
}
