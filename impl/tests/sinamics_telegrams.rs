//! The bits of the telegrams against the printed tables, and frames of any bytes.

use stillpoint_monitors::fields::{Fields, get, walk};
use stillpoint_monitors::sinamics::telegram::channel::{
    InfoWord1, InfoWord2, InfoWord3, RequestWord1, RequestWord3,
};
use stillpoint_monitors::sinamics::telegram::control::{ControlWord1, ControlWord2};
use stillpoint_monitors::sinamics::telegram::diagnosis::{StatusSignals, control_signals};
use stillpoint_monitors::sinamics::telegram::frame::{FrameError, Received, Sent, Telegram};
use stillpoint_monitors::sinamics::telegram::status::{StatusWord1, StatusWord2};
use stillpoint_monitors::sinamics::telegram::values::LARGEST_XIST32;

/// Table 5-7, by byte and bit.
const S_STW1: &str = "0.0 sto, 0.1 ss1, 0.2 ss2, 0.3 sos, 0.4 sls, 0.6 slp, 0.7 internal_event_ack, 1.1 sls_level_0, \
    1.2 sls_level_1, 1.4 sdi_positive, 1.5 sdi_negative";

/// Table 5-9, as far as it is printed, with table 5-5 and the section on gearbox switchover.
const S_STW2: &str =
    "2.3 slp_area_2, 3.0 gear_0, 3.1 gear_1, 3.2 gear_2, 3.3 gear_tolerance, 3.4 ss2e";

/// Table 5-8.
const S_ZSW1: &str = "0.0 sto_active, 0.1 ss1_active, 0.2 ss2_active, 0.3 sos_active, 0.4 sls_active, 0.6 slp_active, \
    0.7 internal_event, 1.1 sls_level_0, 1.2 sls_level_1, 1.3 sos_selected, 1.4 sdi_positive_active, \
    1.5 sdi_negative_active, 1.7 ssm";

/// Table 5-10.
const S_ZSW2: &str = "0.0 sto_active, 0.1 ss1_active, 0.2 ss2_active, 0.3 sos_active, 0.4 sls_active, 0.6 slp_active, \
    0.7 internal_event, 1.1 sls_level_0, 1.2 sls_level_1, 1.4 sdi_positive_active, 1.5 sdi_negative_active, 1.7 ssm, \
    2.3 slp_area_2, 2.6 position_valid, 2.7 safely_referenced, 3.0 input_0, 3.1 input_1, 3.2 input_2, 3.4 ss2e_active, \
    3.5 sos_selected, 3.6 slp_upper_maintained, 3.7 slp_lower_maintained";

/// r9734.
const S_ZSW1B: &str = "0.0 sto_active, 0.1 ss1_active, 0.2 ss2_active, 0.3 sos_active, 0.4 sls_active, 0.5 sos_selected, \
    0.6 sls_selected, 0.7 internal_event, 1.1 sls_level_0, 1.2 sls_level_1, 1.4 sdi_positive_selected, \
    1.5 sdi_negative_selected, 1.6 esr_requested, 1.7 message_effective";

/// r9743.
const S_ZSW2B: &str = "0.4 slp_area_2, 0.7 slp_selected_and_agreed, 1.0 sdi_positive_selected, 1.1 sdi_negative_selected, \
    1.4 test_stop_active, 1.5 test_stop_required";

/// r10234.
const S_ZSW3B: &str = "0.0 brake_test_selected, 0.1 internal_setpoint, 0.2 brake_2, 0.3 brake_test_active, \
    0.4 brake_test_passed, 0.5 brake_test_completed, 0.6 close_external_brake, 0.7 negative_load, 1.3 ss2e_active, \
    1.6 slp_acceptance_test, 1.7 acceptance_mode";

/// r10251.
const S_STW1B: &str = "1.0 test_stop";

/// r10231.
const S_STW3B: &str = "0.0 select_brake_test, 0.1 start_brake_test, 0.2 brake_2, 0.3 negative_direction, 0.4 sequence_2, \
    0.5 external_brake_closed";

/// r9722, by bit.
const R9722: &str = "0.0 sto_active, 0.1 ss1_active, 0.2 ss2_active, 0.3 sos_active, 0.4 sls_active, 0.6 slp_active, \
    0.7 no_internal_event, 1.1 sls_level_0, 1.2 sls_level_1, 1.4 sdi_positive_active, 1.5 sdi_negative_active, 1.7 ssm, \
    2.3 slp_area_2, 2.6 position_valid, 2.7 safely_referenced, 3.4 ss2e_active, 3.6 slp_upper_maintained, \
    3.7 slp_lower_maintained";

/// The names of the bits that are 1.
fn names<T: Fields>(word: T) -> Vec<&'static str> {
    let mut names = Vec::new();
    walk::<T>("", |path, _| {
        names.push(path.last().copied().unwrap_or_default())
    });
    let mut levels = Vec::new();
    get(word, |level| levels.push(level != 0));
    let pairs = names.into_iter().zip(levels);
    pairs
        .filter(|(_, level)| *level)
        .map(|(name, _)| name)
        .collect()
}

/// Each printed bit alone is the field of its name, and each other bit is none.
fn agrees(printed: &[&str], bits: u32, decoded: impl Fn(u32) -> Vec<&'static str>) {
    let mut expected = vec![None; bits as usize];
    for entry in printed.iter().flat_map(|table| table.split(", ")) {
        let (place, name) = entry.trim().split_once(' ').expect("a place and a name");
        let (byte, bit) = place.split_once('.').expect("byte and bit");
        let [byte, bit] = [byte, bit].map(|number| number.parse::<usize>().expect("a number"));
        assert_eq!(expected[8 * byte + bit].replace(name), None, "{place}");
    }
    for (bit, name) in expected.into_iter().enumerate() {
        assert_eq!(decoded(1 << bit), Vec::from_iter(name), "bit {bit}");
    }
}

/// S120-PSAFE-508, S120-PSAFE-510, S120-PSAFE-512, S120-PSAFE-513, S120-SIC-503, S120-SIC-504, S120-SIC-505, S120-SIC-507,
/// S120-SIC-508, S120-DIAG-501, S120-TESTSTOP-516, S120-ACCEPT-503, S120-SDI-006, S120-SLP-006: each bit of the printed tables.
#[test]
fn the_printed_bits() {
    agrees(&[S_STW1], 16, |word| {
        names(ControlWord1::decode(word as u16))
    });
    agrees(&[S_STW1, S_STW2], 32, |word| {
        names(ControlWord2::decode(word))
    });
    agrees(&[S_ZSW1], 16, |word| {
        names(StatusWord1::decode(word as u16))
    });
    agrees(&[S_ZSW2], 32, |word| names(StatusWord2::decode(word)));
    agrees(&[S_ZSW1B], 16, |word| names(InfoWord1::decode(word as u16)));
    agrees(&[S_ZSW2B], 16, |word| names(InfoWord2::decode(word as u16)));
    agrees(&[S_ZSW3B], 16, |word| names(InfoWord3::decode(word as u16)));
    agrees(&[S_STW1B], 16, |word| {
        names(RequestWord1::decode(word as u16))
    });
    agrees(&[S_STW3B], 16, |word| {
        names(RequestWord3::decode(word as u16))
    });
    agrees(&[R9722], 32, |word| names(StatusSignals::decode(word)));
}

/// r9720, by bit, as far as it is printed.
const R9720: [(u32, &str); 15] = [
    (0, "sto"),
    (1, "ss1"),
    (2, "ss2"),
    (3, "sos"),
    (4, "sls"),
    (6, "slp"),
    (9, "sls_level_0"),
    (10, "sls_level_1"),
    (12, "sdi_positive"),
    (13, "sdi_negative"),
    (19, "slp_area_2"),
    (24, "gear_0"),
    (25, "gear_1"),
    (26, "gear_2"),
    (27, "gear_tolerance"),
];

/// S120-DIAG-500, S120-SDI-006, S120-SLP-006: the printed bits of r9720 are the levels of the selections, 1 where they are
/// deselected; the acknowledgement is none of them.
#[test]
fn the_printed_control_signals() {
    for (bit, name) in R9720 {
        let word = ControlWord2::decode(1 << bit);
        assert_eq!(names(word), [name], "bit {bit}");
        assert_eq!(control_signals(word), 1 << bit, "{name}");
    }
    assert_eq!(control_signals(ControlWord2::decode(1 << 7)), 0);
}

/// S120-SIC-511: no bit of the Safety Control Channel has the name of one that selects a function over PROFIsafe.
#[test]
fn the_control_channel_selects_no_function() {
    let selects = names(ControlWord2::decode(u32::MAX));
    let word1 = names(RequestWord1::decode(u16::MAX));
    let word3 = names(RequestWord3::decode(u16::MAX));
    assert_eq!((word1.len(), word3.len()), (1, 6));
    for name in word1.iter().chain(&word3) {
        assert!(!selects.contains(name), "{name}");
    }
}

/// S120-REF-007: a position has the printed range of +-737280000, 2048 revolutions in thousandths of a degree; what is safely
/// referenced is r9722.23.
#[test]
fn the_printed_range_of_the_position() {
    assert_eq!(LARGEST_XIST32, 2048 * 360_000);
    for (position, accepted) in [
        (737_280_000, true),
        (-737_280_000, true),
        (737_280_001, false),
        (-737_280_001, false),
    ] {
        let mut bytes = vec![0; Sent::length(Telegram::T902) - 4];
        bytes.extend(i32::to_be_bytes(position));
        let found = Sent::decode(Telegram::T902, &bytes);
        assert_eq!(found.is_ok(), accepted, "{position}: {found:?}");
    }
    assert_eq!(names(StatusSignals::decode(1 << 23)), ["safely_referenced"]);
}

/// S120-PSAFE-500, S120-PSAFE-501, S120-SIC-500, S120-SIC-501: the words of each telegram, as they are printed.
#[test]
fn the_printed_lengths() {
    let words = [(1, 1), (2, 2), (0, 3), (2, 5), (3, 5), (3, 6)];
    for (telegram, (received, sent)) in Telegram::ALL.into_iter().zip(words) {
        assert_eq!(Received::length(telegram), 2 * received, "{telegram:?}");
        assert_eq!(Sent::length(telegram), 2 * sent, "{telegram:?}");
    }
}

/// S120-SLS-009, S120-PSAFE-510: level and stage of a frame as it comes; level 00 is SLS1.
#[test]
fn a_frame_by_hand() {
    // STO, SS1, SS2, SOS, SLP and both SDI deselected, SLS level 3, stage 5, SS2E deselected; half the limit.
    let bytes = [0b0100_1111, 0b0011_0100, 0, 0b0001_0101, 0x40, 0x00];
    let Ok(Received::Limited(word, limit)) = Received::decode(Telegram::T901, &bytes) else {
        panic!("a telegram 901");
    };
    assert!(word.sto && word.ss1 && word.sos && !word.sls && word.ss2e);
    assert_eq!((word.sls_level(), word.gear_stage(), limit), (3, 5, 0x4000));
    assert_eq!(ControlWord2::default().sls_level(), 1);
}

/// Numbers that look random and are the same in every run (xorshift).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }
}

/// Bytes of any length are refused, or decoded to what gives the same bytes but for reserved bits.
fn fuzz(frames: u32) {
    let mut numbers = Numbers(0x5eed_0120);
    let (mut accepted, mut refused) = (0_u32, 0_u32);
    for _ in 0..frames {
        let choice = numbers.next();
        let telegram = Telegram::ALL[(choice % 6) as usize];
        let sent = choice & 64 != 0;
        let right = if sent {
            Sent::length(telegram)
        } else {
            Received::length(telegram)
        };
        // Every fourth frame has any length.
        let length = if choice & 0x300 == 0 {
            (choice >> 16) as usize % 20
        } else {
            right
        };
        let random = [numbers.next(), numbers.next(), numbers.next()].map(u64::to_le_bytes);
        let mut bytes = random.concat();
        bytes.truncate(length);
        let again = if sent {
            Sent::decode(telegram, &bytes).map(|told| {
                assert_eq!(Sent::decode(telegram, told.encode().bytes()), Ok(told));
                told.encode()
            })
        } else {
            Received::decode(telegram, &bytes).map(|told| {
                assert_eq!(Received::decode(telegram, told.encode().bytes()), Ok(told));
                told.encode()
            })
        };
        match again {
            Ok(frame) => {
                accepted += 1;
                assert_eq!(length, right);
                let used = mask(telegram, sent);
                let kept = bytes.iter().zip(used).map(|(byte, used)| byte & used);
                assert!(
                    frame.bytes().iter().copied().eq(kept),
                    "{telegram:?} {bytes:?}"
                );
            }
            Err(FrameError::Length { expected, found }) => {
                refused += 1;
                assert_eq!((expected, found), (right, length));
                assert_ne!(length, right);
            }
            Err(FrameError::Position(position)) => {
                refused += 1;
                assert!(sent && matches!(telegram, Telegram::T901 | Telegram::T902));
                assert!(position == -32_768 || position.unsigned_abs() > 737_280_000);
            }
        }
    }
    assert!(
        accepted > frames / 2 && refused > frames / 20,
        "{accepted} {refused}"
    );
}

/// The bits of a frame that are not reserved, from the printed tables.
fn mask(telegram: Telegram, sent: bool) -> Vec<u8> {
    const S_STW1: [u8; 2] = [0xdf, 0x36];
    const S_STW2: [u8; 4] = [0xdf, 0x36, 0x08, 0x1f];
    const S_ZSW1: [u8; 2] = [0xdf, 0xbe];
    const S_ZSW2: [u8; 4] = [0xdf, 0xb6, 0xc8, 0xf7];
    // Words of PROFIdrive: the higher byte first.
    const S_ZSW1B: [u8; 2] = [0xf6, 0xff];
    const S_ZSW2B: [u8; 2] = [0x33, 0x90];
    const S_ZSW3B: [u8; 2] = [0xc8, 0xff];
    const S_STW1B: [u8; 2] = [0x01, 0x00];
    const S_STW3B: [u8; 2] = [0x00, 0x3f];
    const NUMBER: [u8; 8] = [0xff; 8];
    match (telegram, sent) {
        (Telegram::T30, false) => S_STW1.to_vec(),
        (Telegram::T31, false) => S_STW2.to_vec(),
        (Telegram::T901 | Telegram::T902, false) => [&S_STW2[..], &NUMBER[..2]].concat(),
        (Telegram::T700, false) => Vec::new(),
        (Telegram::T701, false) => [S_STW1B, S_STW3B].concat(),
        (Telegram::T30, true) => S_ZSW1.to_vec(),
        (Telegram::T31, true) => S_ZSW2.to_vec(),
        (Telegram::T901, true) => [&S_ZSW2[..], &NUMBER[..6]].concat(),
        (Telegram::T902, true) => [&S_ZSW2[..], &NUMBER].concat(),
        (Telegram::T700, true) => [&S_ZSW1B[..], &NUMBER[..4]].concat(),
        (Telegram::T701, true) => [&S_ZSW1B[..], &S_ZSW2B, &NUMBER[..4], &S_ZSW3B].concat(),
    }
}

/// S120-PSAFE-501, S120-SIC-500, S120-SIC-501.
#[test]
fn frames_of_any_bytes() {
    fuzz(100_000);
}

/// The same with ten million frames.
#[test]
#[ignore = "deep: some seconds"]
fn ten_million_frames_of_any_bytes() {
    fuzz(10_000_000);
}
