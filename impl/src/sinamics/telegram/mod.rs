//! Telegrams of PROFIsafe (30, 31, 901, 902) and of the Safety Info and Control Channel (700, 701), bit by bit; the words of the
//! diagnosis with the same bits.
//!
//! | module | what |
//! | --- | --- |
//! | [`control`] | S_STW1, S_STW2: what the F host selects |
//! | [`status`] | S_ZSW1, S_ZSW2: what the drive tells it |
//! | [`channel`] | S_ZSW1B to S_ZSW3B, S_STW1B, S_STW3B: not safety-related; no bit of them selects or deselects a function (S120-SIC-511) |
//! | [`diagnosis`] | r9720 to r9722, r9772, r9773 |
//! | [`values`] | numbers in telegrams, scaled |
//! | [`frame`] | whole telegrams as bytes |
//!
//! A field of a word is the level of its bit; the manual's byte b, bit i is bit 8 b + i. Reserved bits are sent as 0 and not read.

/// Declares a word: its fields with their bits, `encode` and `decode`.
macro_rules! word {
    ($(#[doc = $about:literal])+ $name:ident($raw:ident) {$(
        $(#[doc = $text:literal])+ $bit:literal $field:ident,
    )+}) => {
        fields! {
            $(#[doc = $about])+
            #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
            pub struct $name {$(
                $(#[doc = $text])+
                pub $field: bool,
            )+}
        }

        impl $name {
            /// The bits that are not reserved.
            #[allow(clippy::identity_op)]
            pub const USED: $raw = 0 $(| 1 << $bit)+;

            /// The word with these bits; reserved ones are 0.
            #[allow(clippy::identity_op)]
            pub const fn encode(self) -> $raw {
                0 $(| (self.$field as $raw) << $bit)+
            }

            /// The bits of a word; reserved ones are not read.
            pub const fn decode(word: $raw) -> Self {
                Self {$(
                    $field: (word >> $bit) & 1 == 1,
                )+}
            }
        }
    };
}

pub mod channel;
pub mod control;
pub mod diagnosis;
pub mod frame;
pub mod status;
pub mod values;
