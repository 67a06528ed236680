//! Telegrams.

use crate::inventory::NARROW;

inventory! {
    [run(34) s120_words_16 on sinamics::"telegram" by telegram::narrow_word_is_its_bits {
        property: "each word of 16 bits: decoding and encoding are inverse, reserved bits are sent as 0 and not read",
        requirements: ["S120-PSAFE-508", "S120-PSAFE-510", "S120-PSAFE-512", "S120-SIC-503", "S120-SIC-504", "S120-SIC-505",
            "S120-SIC-507", "S120-SIC-508", "S120-DIAG-502"],
        covers: ["a word with reserved bits", "a word without"],
        domain: NARROW,
        domain_text: "S_STW1, S_ZSW1, S_ZSW1B, S_ZSW2B, S_ZSW3B, S_STW1B, S_STW3B, r9721; all 65536 values of each",
        bound: "none",
        caveat: "none",
    }]
    [run(34) s120_words_32 on sinamics::"telegram" by telegram::wide_word_is_its_bits {
        property: "each word of 32 bits: decoding and encoding are inverse, reserved bits are sent as 0 and not read",
        requirements: ["S120-PSAFE-508", "S120-PSAFE-510", "S120-PSAFE-512", "S120-PSAFE-513", "S120-DIAG-501", "S120-DIAG-503"],
        covers: ["a word with reserved bits", "a word without"],
        domain: NARROW,
        domain_text: "S_STW2, S_ZSW2, r9722, r9772, r9773; all values of one half, with five of the other",
        bound: "none",
        caveat: "each bit is coded by itself, so that halves are enough; Kani takes whole words",
    }]
    [run(34) s120_basic_words on sinamics::"telegram" by telegram::basic_functions_see_three_bits {
        property: "Basic Functions see STO, SS1 and the acknowledgement, and tell STO, SS1 and the internal event; nothing else",
        requirements: ["S120-PSAFE-509", "S120-PSAFE-526"],
        covers: ["a word with other bits", "a word of zeros"],
        domain: NARROW,
        domain_text: "S_STW1, S_STW2, S_ZSW1, S_ZSW2; all values of the lower half, with five of the upper one",
        bound: "none",
        caveat: "none",
    }]
    [run(34) [kani() parts(3: first = 1, second = 2, third = 3)] s120_frames on sinamics::"telegram" by telegram::frames_are_their_bytes {
        property: "each telegram of each direction: what is encoded is decoded, bytes that are decoded are encoded the same but for reserved bits, other lengths and positions are refused",
        requirements: ["S120-PSAFE-500", "S120-PSAFE-501", "S120-PSAFE-517", "S120-PSAFE-518", "S120-SIC-500", "S120-SIC-501"],
        covers: ["a telegram that is received", "one that is sent", "another length", "a position outside its range"],
        domain: NARROW,
        domain_text: "all telegrams; lengths 0 to 13; bytes all the same, and one other anywhere: 0, 1, 127, 128, 255",
        bound: "none",
        caveat: "other bytes only under Kani, a third of the telegrams of both directions each part, and in samples",
    }]
    [run(34) s120_status_of_signals on sinamics::"telegram" by telegram::status_word_qualifies {
        property: "S_ZSW2 is r9722, but SLP is active only where it is safely referenced, and the internal event has the other polarity",
        requirements: ["S120-PSAFE-515", "S120-PSAFE-512", "S120-DIAG-501", "S120-PSAFE-525", "S120-PC-08"],
        covers: ["an internal event", "SLP without a reference"],
        domain: NARROW,
        domain_text: "all values of one half of r9722, with five of the other; of F-DI and p10050 the 64 pairs, each with some of the words",
        bound: "none",
        caveat: "none",
    }]
}
