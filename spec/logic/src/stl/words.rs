//! The mnemonics of the instructions, which are German or English: SE is an on-delay in one and a pulse in the other.

use super::ast::TimerKind;

/// The language of the mnemonics and of the letters for inputs and outputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dialect {
    German,
    English,
}

impl Dialect {
    pub const fn name(self) -> &'static str {
        match self {
            Dialect::German => "German",
            Dialect::English => "English",
        }
    }
}

/// What a mnemonic stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mnemonic {
    And,
    AndNot,
    Or,
    OrNot,
    Xor,
    XorNot,
    Set,
    Reset,
    Rising,
    Falling,
    Not,
    SetResult,
    ClearResult,
    Load,
    Transfer,
    Start(TimerKind),
    Jump(Option<bool>),
    End { conditional: bool },
    Call,
    ConditionalCall,
    Nothing,
    OpenBlock,
}

use Mnemonic as M;

/// German, English, meaning.
pub(super) const WORDS: [(&str, &str, Mnemonic); 30] = [
    ("U", "A", M::And),
    ("UN", "AN", M::AndNot),
    ("O", "O", M::Or),
    ("ON", "ON", M::OrNot),
    ("X", "X", M::Xor),
    ("XN", "XN", M::XorNot),
    ("S", "S", M::Set),
    ("R", "R", M::Reset),
    ("FP", "FP", M::Rising),
    ("FN", "FN", M::Falling),
    ("NOT", "NOT", M::Not),
    ("SET", "SET", M::SetResult),
    ("CLR", "CLR", M::ClearResult),
    ("L", "L", M::Load),
    ("T", "T", M::Transfer),
    ("SI", "SP", M::Start(TimerKind::Pulse)),
    ("SV", "SE", M::Start(TimerKind::ExtendedPulse)),
    ("SE", "SD", M::Start(TimerKind::OnDelay)),
    ("SS", "SS", M::Start(TimerKind::RetentiveOnDelay)),
    ("SA", "SF", M::Start(TimerKind::OffDelay)),
    ("SPA", "JU", M::Jump(None)),
    ("SPB", "JC", M::Jump(Some(true))),
    ("SPBN", "JCN", M::Jump(Some(false))),
    ("BEA", "BEU", M::End { conditional: false }),
    ("BEB", "BEC", M::End { conditional: true }),
    ("BE", "BE", M::End { conditional: false }),
    ("CALL", "CALL", M::Call),
    ("CC", "CC", M::ConditionalCall),
    ("NOP", "NOP", M::Nothing),
    ("AUF", "OPN", M::OpenBlock),
];

/// Instructions that are known and not taken, with the reason.
const OTHERS: [(&[&str], &str); 7] = [
    (
        &["LOOP"],
        "nothing says that the loop ends: write its steps one after the other",
    ),
    (
        &[
            "SPL", "JL", "SPO", "JO", "SPS", "JOS", "SPZ", "JZ", "SPN", "JN", "SPP", "JP", "SPM",
            "JM", "SPMZ", "JMZ", "SPPZ", "JPZ", "SPU", "JUO", "SPBB", "JCB", "SPBNB", "JNB",
            "SPBI", "JBI", "SPBIN", "JNBI",
        ],
        "a jump depends on the result of the logic only: compare, and use SPB (JC) or SPBN (JCN)",
    ),
    (
        &["ZV", "CU", "ZR", "CD"],
        "counters are not read: the steps of a safe program are bits",
    ),
    (
        &["LC", "FR"],
        "the time of a timer and its release are not read: check the timer with U (A)",
    ),
    (
        &[
            "UW", "AW", "OW", "XOW", "UD", "AD", "OD", "XOD", "INC", "DEC", "TAK", "PUSH", "POP",
            "SLW", "SRW", "SLD", "SRD", "INVI", "NEGI", "ITD", "DTR",
        ],
        "a safe program combines bits; there is no calculation with words",
    ),
    (
        &[
            "SAVE", "MCRA", "MCRD", "CLR1", "LAR1", "LAR2", "TAR1", "TAR2", "TDB", "CDB", "TAD",
            "CAD",
        ],
        "registers, indirect addresses and the master control relay hide which bit is meant",
    ),
    (&["BLD"], "it is for programming devices only: leave it out"),
];

/// The meaning of a word in each language; none: it is no instruction there.
pub(super) fn mnemonic(word: &str) -> [Option<Mnemonic>; 2] {
    let find = |german: bool| {
        let of = |(g, e, _): &&(&str, &str, Mnemonic)| if german { *g == word } else { *e == word };
        WORDS.iter().find(of).map(|(_, _, meaning)| *meaning)
    };
    // UC without parameters is a CALL.
    match word {
        "UC" => [Some(M::Call); 2],
        _ => [find(true), find(false)],
    }
}

/// Why a known instruction is not taken.
pub(super) fn refused(word: &str) -> Option<&'static str> {
    let found = OTHERS.iter().find(|(words, _)| words.contains(&word));
    found.map(|(_, why)| *why)
}

/// All words, for suggestions.
pub(super) fn all() -> impl Iterator<Item = &'static str> {
    WORDS.iter().flat_map(|(g, e, _)| [*g, *e])
}
