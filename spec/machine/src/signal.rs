//! Safe signals: numbered ones, by the names that programs have for them and by the coding of the machine data, and those that a program
//! declares.

use indexmap::IndexMap;
use serde::Deserialize;

/// Inverted: bit 31 of the coding.
const INVERTED: i64 = 0x8000_0000;

/// The machine datum of a coding: what an output of an axis feeds is coded as what an input is fed from, and bit 32 tells them apart.
pub(super) const fn datum(code: i64) -> i64 {
    code & 0xFFFF_FFFF
}

/// A word of signals.
const WORD: i64 = 32;

/// Signals of one name, `OUTSI[1]` to `OUTSI[64]`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Bits {
    /// How many there are, from 1.
    #[serde(default)]
    count: i64,
    /// They are bits of so many bytes, `M0.0` to `M255.7`; they have no machine datum, and their coding is a number of the project.
    #[serde(default)]
    bytes: i64,
    /// They are what the program of the machine file declares: whether its outputs, else its inputs.
    program: Option<bool>,
    /// They are what comes from outside of the control, as what a program declares as its inputs is: contacts, keys, devices.
    #[serde(default)]
    input: bool,
    #[serde(skip)]
    declared: Vec<String>,
    /// Their machine datum without word and bit (`i s mm xx nn`: of `xx` and `nn`), with bit 32 for what outputs of axes feed.
    code: i64,
}

/// The numbered signals of a family, by name.
#[derive(Debug, Clone, Default)]
pub(super) struct Signals(pub IndexMap<String, Bits>);

impl Signals {
    /// Each signal of this name with its coding, where wished also inverted.
    pub fn named(&self, name: &str, inverted: bool) -> Option<Vec<(String, i64)>> {
        let bits = self.0.get(name)?;
        let plain = (0..bits.count).map(|k| {
            let (word, bit) = (k / WORD + 1, k % WORD + 1);
            let code = bits.code + 0x100 * word + bit;
            (format!("{name}[{}]", k + 1), code)
        });
        let of_bytes = (0..8 * bits.bytes).map(|k| {
            let (byte, bit) = (k / 8, k % 8);
            (format!("{name}{byte}.{bit}"), bits.code + k + 1)
        });
        let declared = (1..).zip(&bits.declared);
        let declared = declared.map(|(k, name)| (name.clone(), bits.code + k));
        let plain: Vec<_> = plain.chain(of_bytes).chain(declared).collect();
        let turned = plain.iter().filter(|_| inverted);
        let turned = turned.map(|(name, code)| (format!("NOT {name}"), code + INVERTED));
        Some(plain.iter().cloned().chain(turned).collect())
    }

    /// Whether some of them are what a program declares.
    pub fn are_declared(&self) -> bool {
        self.0.values().any(|bits| bits.program.is_some())
    }

    /// Learns what the program of the machine file declares: each name, and whether it is an output.
    pub fn declare(&mut self, program: &[(String, bool)]) {
        for bits in self.0.values_mut() {
            let of = program
                .iter()
                .filter(|(_, given)| bits.program == Some(*given));
            bits.declared.extend(of.map(|(name, _)| name.clone()));
        }
    }

    /// Whether a signal of a program, `INSE[3]` or a name that it declares, comes from outside.
    pub fn is_input(&self, signal: &str) -> bool {
        let base = signal.split_once('[').map(|(base, _)| base);
        let numbered = base.and_then(|base| self.0.get(base));
        let mut declared = self.0.values().filter(|bits| bits.program == Some(false));
        numbered.is_some_and(|bits| bits.input)
            || declared.any(|bits| bits.declared.iter().any(|name| name == signal))
    }

    /// The names, for messages.
    pub fn names(&self) -> String {
        let names: Vec<&str> = self.0.keys().map(String::as_str).collect();
        names.join(", ")
    }

    /// A coding as programs write the signal: `OUTSI[3]`, `NOT INSE[1]`, `FALSE` for 0, `TRUE` for what is fixed at 1.
    pub fn show(&self, code: i64) -> String {
        if code == 0 || code == INVERTED {
            return if code == 0 { "FALSE" } else { "TRUE" }.to_owned();
        }
        let all = self.0.keys().filter_map(|name| self.named(name, true));
        let found = all.flatten().find(|(_, known)| *known == code);
        found.map_or_else(|| format!("{code:08X}H"), |(name, _)| name)
    }
}

/// A machine datum as it is written: `04010103H`.
pub(super) fn coded(text: &str) -> Option<i64> {
    let digits = text.strip_suffix(['H', 'h'])?;
    let all = digits.len() <= 8 && digits.bytes().all(|b| b.is_ascii_hexdigit());
    all.then(|| i64::from_str_radix(digits, 16).ok()).flatten()
}

/// Names, with those of one list told by its ends: `"0", "OUTSI[1]" to "OUTSI[64]"`.
pub(super) fn ranges(names: &[&str]) -> String {
    let base = |name: &str| {
        let bits = name.split_once('.').filter(|(of, _)| of.len() > 1);
        let bits = bits.map(|(of, _)| of.trim_end_matches(|c: char| c.is_ascii_digit()));
        let base = name.split_once('[').map(|(base, _)| base).or(bits);
        base.map(str::to_owned)
    };
    let mut told: Vec<String> = Vec::new();
    for list in names.chunk_by(|a, b| base(a).is_some() && base(a) == base(b)) {
        told.push(match list {
            [first, .., last] => format!("\"{first}\" to \"{last}\""),
            [one] => format!("\"{one}\""),
            [] => continue,
        });
    }
    told.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signals() -> Signals {
        let bits = |code| Bits {
            count: 64,
            bytes: 0,
            program: None,
            input: false,
            declared: Vec::new(),
            code,
        };
        let list = [("OUTSI", 0x0401_0000), ("INSE", 0x0402_0000)];
        Signals(
            list.map(|(name, code)| (name.to_owned(), bits(code)))
                .into(),
        )
    }

    /// The two examples of the manual (lines before MD 36970), and the greatest values that it permits.
    #[test]
    fn codings_are_those_of_the_manual() {
        let signals = signals();
        for (code, name) in [
            (0x0401_0101, "OUTSI[1]"),
            (0x0401_0204, "OUTSI[36]"),
            (0x8402_0220, "NOT INSE[64]"),
            (0, "FALSE"),
            (0x8000_0000, "TRUE"),
            (0x0401_0301, "04010301H"),
        ] {
            assert_eq!(signals.show(code), name);
        }
        assert_eq!(coded("84020220H"), Some(0x8402_0220));
        for wrong in ["84020220", "184020220H", "0401010GH", "H1", "+4010101H"] {
            assert_eq!(coded(wrong), None, "{wrong}");
        }
        assert_eq!(coded("H"), None);
    }

    #[test]
    fn lists_are_told_by_their_ends() {
        let list = signals().named("OUTSI", true).expect("known");
        let names: Vec<&str> = ["0"]
            .into_iter()
            .chain(list.iter().map(|(n, _)| n.as_str()))
            .collect();
        let told = "\"0\", \"OUTSI[1]\" to \"OUTSI[64]\", \"NOT OUTSI[1]\" to \"NOT OUTSI[64]\"";
        assert_eq!(ranges(&names), told);
        assert!(signals().named("MARKERSI", false).is_none());
    }
}
