//! The list of the cross comparison: what is compared, under which code, and how.
//!
//! Each channel fills one [`Snapshot`] of itself per cycle and hands it to the other. Gear stage signals are not compared
//! (S840D-KDV-510): an inconsistent stage shows in the positions. The comparison of the safe logic is another one and
//! independent of this (S840D-KDV-513).

use crate::kernel::{Cycles, Distance, Percent, Position, Speed};
use crate::sinumerik::code::Code;
use crate::sinumerik::level::ExternalStop;

/// Whether an item changes in operation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A parameter: compared in every pass.
    #[default]
    Static,
    /// A value of the operation: not compared while a signal changes.
    Dynamic,
}

/// When an item differs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Rule {
    /// Whenever the values are not equal.
    #[default]
    Exact,
    /// Only when the difference is greater than the tolerance; at the tolerance it is none (S840D-KDV-516).
    Tolerance,
}

/// One item of the list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Item {
    code: Code,
    kind: Kind,
    rule: Rule,
}

impl Item {
    /// The item with this code; `None` for the codes that are no items: 0 and those from 1000.
    pub const fn of(code: Code) -> Option<Self> {
        let (kind, rule) = match code.number() {
            1 | 2 | 58 | 82 => (Kind::Dynamic, Rule::Exact),
            3 | 44..=57 => (Kind::Dynamic, Rule::Tolerance),
            5..=42 | 59..=81 | 83..=85 | 89 => (Kind::Static, Rule::Exact),
            _ => return None,
        };
        Some(Self { code, kind, rule })
    }

    /// The code of STOP F where the item differs.
    pub const fn code(self) -> Code {
        self.code
    }

    /// Whether the item changes in operation.
    pub const fn kind(self) -> Kind {
        self.kind
    }

    /// When the item differs.
    pub const fn rule(self) -> Rule {
        self.rule
    }
}

/// The items whose codes are the numbers given; a number without item is a repetition of the first one.
const fn items<const N: usize>(ranges: &[(u16, u16)]) -> [Item; N] {
    let mut list = [Item {
        code: Code::RESULTS_1,
        kind: Kind::Dynamic,
        rule: Rule::Exact,
    }; N];
    let mut place = 0;
    let mut range = 0;
    while range < ranges.len() {
        let (mut number, last) = ranges[range];
        while number <= last && place < N {
            if let Some(code) = Code::of(number) {
                if let Some(item) = Item::of(code) {
                    list[place] = item;
                }
            }
            place += 1;
            number += 1;
        }
        range += 1;
    }
    list
}

/// The whole list, in the order of the codes (S840D-KDV-729/a).
pub static ITEMS: [Item; 84] = items(&[(1, 3), (5, 42), (44, 85), (89, 89)]);

/// One item of each class: both result lists, position, parameters, limits, external stop. The short list of models.
pub static CLASSES: [Item; 6] = items(&[(1, 1), (2, 2), (3, 3), (5, 5), (44, 44), (58, 58)]);

/// By how much actual values and the limits made of them may differ (S840D-KDV-706, S840D-SLIP-504).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tolerance {
    /// SAFE_POS_TOL.
    Position(Distance),
    /// With synchronisation of the actual values: the slip that SAFE_SLIP_VELO_TOL tolerates from one comparison of the
    /// positions, in which they are synchronised, to the next one.
    Slip(Distance),
}

impl Tolerance {
    /// The largest difference that is none.
    pub const fn distance(self) -> Distance {
        match self {
            Self::Position(distance) | Self::Slip(distance) => distance,
        }
    }
}

/// The limits made anew in every cycle, codes 44 to 57 in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits(pub [Position; 14]);

impl Limits {
    /// The limits of one cycle, whether or not the functions are selected (S840D-TIMING-512, S840D-KDV-709,
    /// S840D-KDV-710). Saturating.
    ///
    /// `position`: the safe position. `stages`: SG1 to SG4, `threshold`: n_x, each as a way per cycle. `reference`: the
    /// position at the activation of the operating stop, `window`: its tolerance. `tolerance`: SAFE_POS_TOL.
    pub const fn new(
        position: Position,
        stages: [Speed; 4],
        reference: Position,
        window: Distance,
        threshold: Speed,
        tolerance: Distance,
    ) -> Self {
        let at = position.0;
        let far = threshold.0.saturating_add(tolerance.0);
        let [one, two, three, four] = stages;
        Self([
            Position(at.saturating_add_unsigned(one.0)),
            Position(at.saturating_sub_unsigned(one.0)),
            Position(at.saturating_add_unsigned(two.0)),
            Position(at.saturating_sub_unsigned(two.0)),
            Position(at.saturating_add_unsigned(three.0)),
            Position(at.saturating_sub_unsigned(three.0)),
            Position(at.saturating_add_unsigned(four.0)),
            Position(at.saturating_sub_unsigned(four.0)),
            Position(reference.0.saturating_add_unsigned(window.0)),
            Position(reference.0.saturating_sub_unsigned(window.0)),
            Position(at.saturating_add_unsigned(far)),
            Position(at.saturating_add_unsigned(threshold.0)),
            Position(at.saturating_sub_unsigned(threshold.0)),
            Position(at.saturating_sub_unsigned(far)),
        ])
    }
}

/// One pair of cams and of its plus and minus cam.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CamPair {
    /// SAFE_CAM_POS_PLUS.
    pub plus: Position,
    /// SAFE_CAM_POS_MINUS.
    pub minus: Position,
}

/// The parameters of one channel, as they act in it (codes 5 to 42, 59 to 81, 83 to 85 and 89; S840D-KDV-707).
///
/// Names and meaning are those of the machine data, in the units of the monitors. A parameter that is not
/// used stays 0 in both channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Parameters {
    /// SAFE_FUNCTION_ENABLE, code 5.
    pub function_enable: u32,
    /// SAFE_VELO_LIMIT of SG1 to SG4, codes 6 to 9.
    pub velo_limit: [Speed; 4],
    /// SAFE_STANDSTILL_TOL, code 10.
    pub standstill_tol: Distance,
    /// SAFE_POS_LIMIT_PLUS of SE1 and SE2, codes 11 and 13.
    pub pos_limit_plus: [Position; 2],
    /// SAFE_POS_LIMIT_MINUS of SE1 and SE2, codes 12 and 14.
    pub pos_limit_minus: [Position; 2],
    /// SAFE_CAM_POS_PLUS and SAFE_CAM_POS_MINUS, codes 15 to 30: each with and without `cam_tol`.
    pub cams: [CamPair; 4],
    /// SAFE_CAM_TOL, in the codes 15, 17 to 29.
    pub cam_tol: Distance,
    /// SAFE_POS_TOL, code 31.
    pub pos_tol: Distance,
    /// SAFE_SLIP_VELO_TOL, as the difference that it tolerates, code 31.
    pub slip_velo_tol: Distance,
    /// SAFE_REFP_POS_TOL, code 32.
    pub refp_pos_tol: Distance,
    /// SAFE_VELO_SWITCH_DELAY, code 33.
    pub velo_switch_delay: Cycles,
    /// SAFE_MODE_SWITCH_TIME, code 34.
    pub mode_switch_time: Cycles,
    /// SAFE_PULSE_DISABLE_DELAY, code 35.
    pub pulse_disable_delay: Cycles,
    /// SAFE_PULSE_DIS_CHECK_TIME, code 36.
    pub pulse_dis_check_time: Cycles,
    /// SAFE_STOP_SWITCH_TIME_C, D and E, codes 37 to 39.
    pub stop_switch_time: [Cycles; 3],
    /// SAFE_VELO_STOP_MODE, code 40.
    pub velo_stop_mode: u8,
    /// SAFE_POS_STOP_MODE, code 41.
    pub pos_stop_mode: u8,
    /// SAFE_STANDSTILL_VELO_TOL, code 42.
    pub standstill_velo_tol: Speed,
    /// SAFE_VELO_OVR_FACTOR, codes 59 to 74.
    pub velo_ovr_factor: [Percent; 16],
    /// SAFE_VELO_X, code 75.
    pub velo_x: Speed,
    /// SAFE_VELO_STOP_REACTION of SG1 to SG4, codes 76 to 79.
    pub velo_stop_reaction: [u8; 4],
    /// SAFE_MODULO_RANGE, code 80.
    pub modulo_range: Distance,
    /// SAFE_STOP_VELO_TOL, code 81.
    pub stop_velo_tol: Speed,
    /// SAFE_ACCEPTANCE_TST_TIMEOUT, code 83.
    pub acceptance_tst_timeout: Cycles,
    /// SAFE_STOP_SWITCH_TIME_F, code 84.
    pub stop_switch_time_f: Cycles,
    /// SAFE_PULSE_DIS_TIME_BUSFAIL, code 85.
    pub pulse_dis_time_busfail: Cycles,
    /// SAFE_ENC_FREQ_LIMIT in hertz, code 89 (S840D-KDV-511).
    pub enc_freq_limit: u32,
}

impl Parameters {
    /// What is compared under the code of a static item: two words, the second one 0 but for code 31, which stands for two
    /// machine data. `None` for the other codes.
    pub fn words(&self, code: Code) -> Option<[i64; 2]> {
        let number = usize::from(code.number());
        let word = match number {
            5 => self.function_enable.into(),
            6..=9 => self.velo_limit.get(number - 6)?.0.into(),
            10 => self.standstill_tol.0.into(),
            11 | 13 => self.pos_limit_plus.get((number - 11) / 2)?.0.into(),
            12 | 14 => self.pos_limit_minus.get((number - 12) / 2)?.0.into(),
            15..=30 => self.cam_word(number - 15)?,
            31 => return Some([self.pos_tol.0.into(), self.slip_velo_tol.0.into()]),
            32 => self.refp_pos_tol.0.into(),
            33 => self.velo_switch_delay.count().into(),
            34 => self.mode_switch_time.count().into(),
            35 => self.pulse_disable_delay.count().into(),
            36 => self.pulse_dis_check_time.count().into(),
            37..=39 => self.stop_switch_time.get(number - 37)?.count().into(),
            40 => self.velo_stop_mode.into(),
            41 => self.pos_stop_mode.into(),
            42 => self.standstill_velo_tol.0.into(),
            59..=74 => self.velo_ovr_factor.get(number - 59)?.get().into(),
            75 => self.velo_x.0.into(),
            76..=79 => (*self.velo_stop_reaction.get(number - 76)?).into(),
            80 => self.modulo_range.0.into(),
            81 => self.stop_velo_tol.0.into(),
            83 => self.acceptance_tst_timeout.count().into(),
            84 => self.stop_switch_time_f.count().into(),
            85 => self.pulse_dis_time_busfail.count().into(),
            89 => self.enc_freq_limit.into(),
            _ => return None,
        };
        Some([word, 0])
    }

    /// The word of the cam codes, counted from code 15: for each pair plus with tolerance, plus, minus with tolerance, minus.
    fn cam_word(&self, place: usize) -> Option<i64> {
        let pair = self.cams.get(place / 4)?;
        let cam = if place % 4 < 2 { pair.plus } else { pair.minus };
        let tolerance = if place % 2 == 0 { self.cam_tol.0 } else { 0 };
        Some(i64::from(cam.0) + i64::from(tolerance))
    }
}

/// What one channel shows the other, one cycle later.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Snapshot {
    /// Result list 1, two bits for each of SBH, SE and SG (S840D-KDV-515); code 1.
    pub results_1: u16,
    /// Result list 2, two bits for each cam and for n_x (S840D-KDV-515); code 2.
    pub results_2: u32,
    /// The safe position, with synchronisation the corrected one; code 3.
    pub position: Position,
    /// The limits made in this cycle, codes 44 to 57.
    pub limits: Limits,
    /// The external stop request: the higher one of the own signals and of what the other channel passed through; code
    /// 58 (S840D-KDV-713).
    pub external: ExternalStop,
    /// The index of the selected correction factor, 0 to 15; `None` where the correction does not act; code 82
    /// (S840D-KDV-714).
    pub correction: Option<u8>,
    /// The parameters, codes 5 to 42, 59 to 81, 83 to 85 and 89.
    pub parameters: Parameters,
}

/// Whether the item differs between the snapshot of this channel and the one of the other.
///
/// With synchronisation of the actual values the position item is better compared by [`crate::sinumerik::slip`], which sees the
/// difference before it is corrected.
pub fn differs(item: Item, own: &Snapshot, other: &Snapshot, tolerance: Tolerance) -> bool {
    match item.code.number() {
        1 => own.results_1 != other.results_1,
        2 => own.results_2 != other.results_2,
        3 => beyond(own.position, other.position, tolerance),
        number @ 44..=57 => {
            let place = usize::from(number - 44);
            match (own.limits.0.get(place), other.limits.0.get(place)) {
                (Some(own), Some(other)) => beyond(*own, *other, tolerance),
                _ => true,
            }
        }
        58 => own.external != other.external,
        82 => own.correction != other.correction,
        _ => own.parameters.words(item.code) != other.parameters.words(item.code),
    }
}

/// Whether the positions are further apart than the tolerance.
pub const fn beyond(own: Position, other: Position, tolerance: Tolerance) -> bool {
    own.distance(other).0 > tolerance.distance().0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn item(number: u16) -> Item {
        Code::of(number)
            .and_then(Item::of)
            .expect("the code of an item")
    }

    #[test]
    fn the_list_has_every_item_once_in_order() {
        for pair in ITEMS.windows(2) {
            assert!(pair[0].code() < pair[1].code());
        }
        let known = (0..2000)
            .filter_map(Code::of)
            .filter_map(Item::of)
            .collect::<Vec<_>>();
        assert_eq!(ITEMS.as_slice(), known);
        let classes = CLASSES.map(|item| item.code().number());
        assert_eq!(classes, [1, 2, 3, 5, 44, 58]);
        assert!(CLASSES.iter().all(|item| ITEMS.contains(item)));
    }

    #[test]
    fn every_static_item_has_its_word_and_no_other() {
        for item in ITEMS {
            let words = Parameters::default().words(item.code());
            assert_eq!(words.is_some(), item.kind() == Kind::Static);
        }
    }

    /// S840D-KDV-713, S840D-KDV-714.
    #[test]
    fn operating_values_are_seen_under_their_codes() {
        let own = Snapshot::default();
        let seen = |other: &Snapshot| {
            let differing = ITEMS
                .into_iter()
                .filter(|item| differs(*item, &own, other, Tolerance::Position(Distance(10))));
            differing
                .map(|item| item.code().number())
                .collect::<Vec<_>>()
        };
        let other = |alter: fn(&mut Snapshot)| {
            let mut other = own;
            alter(&mut other);
            seen(&other)
        };
        assert_eq!(other(|s| s.results_1 = 1), [1]);
        assert_eq!(other(|s| s.results_2 = 1 << 20), [2]);
        assert_eq!(other(|s| s.external = ExternalStop::E), [58]);
        assert_eq!(other(|s| s.correction = Some(0)), [82]);
        assert_eq!(other(|s| s.position = Position(10)), []);
        assert_eq!(other(|s| s.position = Position(-11)), [3]);
        for place in 0..14 {
            let mut one = own;
            one.limits.0[place] = Position(11);
            assert_eq!(seen(&one), [44 + place as u16]);
        }
        assert!(!differs(
            item(3),
            &own,
            &Snapshot {
                position: Position(i32::MIN),
                ..own
            },
            Tolerance::Slip(Distance(1 << 31))
        ));
    }

    #[test]
    fn the_limits_follow_the_position_and_hold_at_the_ends() {
        let stages = [Speed(1), Speed(2), Speed(3), Speed(400)];
        let limits = Limits::new(
            Position(100),
            stages,
            Position(-50),
            Distance(5),
            Speed(7),
            Distance(20),
        );
        let values = limits.0.map(|limit| limit.0);
        let expected = [
            101, 99, 102, 98, 103, 97, 500, -300, -45, -55, 127, 107, 93, 73,
        ];
        assert_eq!(values, expected);
        let fast = [Speed(u32::MAX); 4];
        let ends = Limits::new(
            Position(i32::MAX),
            fast,
            Position(i32::MIN),
            Distance(u32::MAX),
            Speed(u32::MAX),
            Distance(u32::MAX),
        );
        assert_eq!(ends.0[0], Position(i32::MAX));
        assert_eq!(ends.0[9], Position(i32::MIN));
    }
}
