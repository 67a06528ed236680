//! The words of PROFIsafe: what the bits of the tables select and tell, against the words of the monitors' crate.

use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinamics::telegram::control::{ControlWord1, ControlWord2};
use stillpoint_monitors::sinamics::telegram::diagnosis::StatusSignals;
use stillpoint_monitors::sinamics::telegram::status::StatusWord2;
use stillpoint_monitors::sinamics::telegram::values::next_cycle;

use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::numbers::{bit, truth};
use crate::diff::peer::{Made, Params, Refusal};
use stillpoint_model::Domain;

/// The machines of the words.
pub(super) const MACHINES: &[(&str, &str)] = &[
    ("control_word", "telegram"),
    ("control_word_2", "telegram"),
    ("status_word", "telegram"),
    ("cycle_count", "telegram"),
];

/// The words of a machine; they have no wrong variants.
pub(super) fn make(machine: &str, p: &Params, _: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "control_word" => control_word(),
        "control_word_2" => control_word_2(),
        "status_word" => status_word(),
        "cycle_count" => {
            if p.value("top") != i32::from(i16::MAX) {
                return Err(Refusal::Table("the cycle count has 16 bits"));
            }
            cycle_count()
        }
        _ => return Ok(None),
    }))
}

const BITS: [&str; 32] = [
    "bit[0]", "bit[1]", "bit[2]", "bit[3]", "bit[4]", "bit[5]", "bit[6]", "bit[7]", "bit[8]",
    "bit[9]", "bit[10]", "bit[11]", "bit[12]", "bit[13]", "bit[14]", "bit[15]", "bit[16]",
    "bit[17]", "bit[18]", "bit[19]", "bit[20]", "bit[21]", "bit[22]", "bit[23]", "bit[24]",
    "bit[25]", "bit[26]", "bit[27]", "bit[28]", "bit[29]", "bit[30]", "bit[31]",
];

/// The word of these bits, the first of which has this number.
fn word(bits: &[i32], first: usize) -> u32 {
    let bits = bits.iter().enumerate();
    bits.fold(0, |word, (k, bit)| {
        word | u32::from(*bit != 0) << (k + first)
    })
}

/// The 16 bits of S_STW1, which S_STW2 has too. With Basic Functions all others have no effect: what they would select does not
/// exist.
fn control_word() -> Adapter {
    Adapter::of(
        BITS[..16].to_vec(),
        vec![
            "sto",
            "ss1",
            "ss2",
            "sos",
            "sls",
            "slp",
            "event_ack",
            "level",
            "sdi_pos",
            "sdi_neg",
        ],
        vec![truth()],
        vec![0],
        move |cells, i, o| {
            let extended = cells[0] != 0;
            let raw = word(i, 0);
            let (short, long) = (ControlWord1::decode(raw as u16), ControlWord2::decode(raw));
            let (short, long) = match extended {
                true => (short, long),
                false => (short.basic(), long.basic()),
            };
            // Both words say the same, else nothing that the table says.
            let same =
                short.encode() == long.encode() as u16 && short.sls_level() == long.sls_level();
            let selected = |deselects: bool| bit(extended && !deselects);
            o.extend([
                bit(!short.sto && same),
                bit(!long.ss1),
                selected(short.ss2),
                selected(long.sos),
                selected(short.sls),
                selected(long.slp),
                bit(short.internal_event_ack),
                i64::from(short.sls_level()),
                selected(short.sdi_positive),
                selected(long.sdi_negative),
            ]);
        },
    )
    .kept(0, "extended")
}

/// Bytes 2 and 3 of S_STW2.
fn control_word_2() -> Adapter {
    let step = move |_: &mut [i32], i: &[i32], o: &mut Vec<i64>| {
        let word = ControlWord2::decode(word(i, 16));
        o.extend([
            1 + bit(word.slp_area_2),
            i64::from(word.gear_stage()),
            bit(word.gear_tolerance),
            bit(!word.ss2e),
        ]);
    };
    let outputs = vec!["slp_range", "stage", "tolerance", "ss2e"];
    Adapter::of(BITS[16..].to_vec(), outputs, Vec::new(), Vec::new(), step)
}

/// S_ZSW2 from the signals of the diagnosis.
fn status_word() -> Adapter {
    Adapter::of(
        vec![
            "sto_active",
            "ss1_active",
            "sls_active",
            "slp_active",
            "referenced",
            "internal_event",
            "slow",
            "range_2",
            "fdi",
        ],
        vec![
            "bit_0", "bit_1", "bit_4", "bit_6", "bit_7", "bit_15", "bit_19", "bit_24",
        ],
        vec![truth(); 2],
        vec![0; 2],
        move |cells, i, o| {
            let is = |k: usize| i[k] != 0;
            let signals = StatusSignals {
                sto_active: is(0),
                ss1_active: is(1),
                sls_active: is(2),
                slp_active: is(3),
                safely_referenced: is(4),
                no_internal_event: !is(5),
                ssm: is(6),
                slp_area_2: is(7),
                ..StatusSignals::decode(0)
            };
            let word = signals.status_word(false);
            let word = word.with_inputs(u8::from(is(8)), u8::from(cells[1] != 0));
            let word = match cells[0] {
                0 => word.basic(),
                _ => word,
            };
            let word: u32 = StatusWord2::encode(word);
            o.extend([0, 1, 4, 6, 7, 15, 19, 24].map(|place| i64::from(word >> place & 1)));
        },
    )
    .kept(0, "extended")
    .kept(1, "transfer")
}

/// S_CYCLE_COUNT, and when the host may use it.
fn cycle_count() -> Adapter {
    let whole = Domain {
        lo: i32::from(i16::MIN),
        hi: i32::from(i16::MAX),
    };
    Adapter::of(
        vec![
            "valid_position",
            "referenced",
            "sp",
            "level_1",
            "limit_by_telegram",
        ],
        vec!["count", "valid"],
        vec![whole],
        vec![0],
        move |cells, i, o| {
            cells[0] = i32::from(next_cycle(cells[0] as i16));
            let word = StatusWord2 {
                position_valid: i[0] != 0 && i[2] != 0,
                safely_referenced: i[1] != 0,
                ..StatusWord2::decode(0)
            };
            o.extend([i64::from(cells[0]), bit(word.position_is_absolute())]);
        },
    )
}
