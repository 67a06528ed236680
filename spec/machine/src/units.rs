//! Physical values: text with a unit to an exact integer in base units, and back.
//!
//! | dimension | base unit | why |
//! |---|---|---|
//! | length | 1 um | resolution of the drive channel |
//! | angle | 1 mdeg | resolution of the drive channel |
//! | grid | 10 nm | grid of a linear scale: the drive has hundredths of a micrometre |
//! | pitch | 1 um/rev | mm per revolution with three decimals |
//! | speed | 1 um/min | mm/min with three decimals |
//! | rotation | 1 mdeg/min | 1 rev/min = 360000, 1 deg/s = 60000: all units exact |
//! | acceleration | 1 um/s2, 1 mdeg/s2 | mm/s2 and deg/s2 with three decimals |
//! | time | 1 us | the clock cycles are multiples of 31.25 us or coarser |
//! | percent, frequency, count | 1 %, 1 Hz, 1 | whole numbers by definition of the parameters |
//!
//! No floating point is involved. A value that is not a whole number of base units is refused, never rounded.

use std::fmt;

/// What a number measures; fixes the units it may be written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Path of a linear axis, base unit 1 um.
    Length,
    /// Distance of the lines of a linear scale, base unit 10 nm.
    Grid,
    /// Path of a linear axis in a revolution of its spindle, base unit 1 um/rev.
    Pitch,
    /// Angle of a rotary axis or spindle, base unit 1 mdeg.
    Angle,
    /// Speed of a linear axis, base unit 1 um/min.
    Speed,
    /// Speed of a rotary axis or spindle, base unit 1 mdeg/min.
    Rotation,
    /// Acceleration of a linear axis, base unit 1 um/s2.
    Acceleration,
    /// Acceleration of a rotary axis or spindle, base unit 1 mdeg/s2.
    AngularAcceleration,
    /// Time, base unit 1 us.
    Time,
    /// Whole percent.
    Percent,
    /// Frequency, base unit 1 Hz.
    Frequency,
    /// A plain whole number.
    Count,
}

/// Why a text is no value of a dimension.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum UnitError {
    /// No number at the start of the text.
    NoNumber,
    /// A number without a unit where one is needed.
    NoUnit,
    /// The unit does not belong to the dimension.
    WrongUnit(String),
    /// Not a whole number of base units.
    TooFine,
    /// Does not fit 64 bits.
    TooLarge,
}

impl Dimension {
    /// The units the dimension is written in, with their size in base units. The first one is the usual one.
    pub fn units(self) -> &'static [(&'static str, i64)] {
        match self {
            Self::Length => &[("mm", 1_000), ("um", 1), ("inch", 25_400)],
            Self::Grid => &[("mm", 100_000), ("um", 100)],
            Self::Pitch => &[("mm/rev", 1_000), ("um/rev", 1), ("inch/rev", 25_400)],
            Self::Angle => &[("deg", 1_000), ("mdeg", 1)],
            Self::Speed => &[
                ("mm/min", 1_000),
                ("m/min", 1_000_000),
                ("mm/s", 60_000),
                ("inch/min", 25_400),
            ],
            Self::Rotation => &[
                ("rev/min", 360_000),
                ("rpm", 360_000),
                ("1/min", 360_000),
                ("deg/min", 1_000),
                ("deg/s", 60_000),
            ],
            Self::Acceleration => &[("mm/s2", 1_000), ("m/s2", 1_000_000), ("um/s2", 1)],
            Self::AngularAcceleration => &[("deg/s2", 1_000), ("rev/s2", 360_000), ("mdeg/s2", 1)],
            Self::Time => &[
                ("ms", 1_000),
                ("s", 1_000_000),
                ("us", 1),
                ("min", 60_000_000),
                ("h", 3_600_000_000),
            ],
            Self::Percent => &[("%", 1)],
            Self::Frequency => &[("kHz", 1_000), ("Hz", 1)],
            Self::Count => &[],
        }
    }

    /// With article, for messages: `a length`.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Length => "a length",
            Self::Grid => "a grid distance",
            Self::Pitch => "a pitch",
            Self::Angle => "an angle",
            Self::Speed => "a speed of a linear axis",
            Self::Rotation => "a speed of a rotary axis or spindle",
            Self::Acceleration => "an acceleration of a linear axis",
            Self::AngularAcceleration => "an acceleration of a rotary axis or spindle",
            Self::Time => "a time",
            Self::Percent => "a percentage",
            Self::Frequency => "a frequency",
            Self::Count => "a whole number",
        }
    }

    /// The names of the units for messages: `mm, um or inch`.
    pub fn unit_list(self) -> String {
        let names: Vec<&str> = self.units().iter().map(|(n, _)| *n).collect();
        alternatives(&names)
    }

    /// The value as the user would write it, exact: `0.5 mm`.
    pub fn show(self, value: i64) -> String {
        let (unit, size) = self.unit_for(value);
        if unit.is_empty() {
            return value.to_string();
        }
        format!("{} {unit}", decimal(value, size))
    }

    /// The unit a value reads best in.
    fn unit_for(self, value: i64) -> (&'static str, i64) {
        let size = value.unsigned_abs();
        match self {
            Self::Time if size != 0 && size % 3_600_000_000 == 0 => ("h", 3_600_000_000),
            Self::Time if size == 0 || size >= 1_000_000 => ("s", 1_000_000),
            Self::Time if size < 1_000 => ("us", 1),
            // Thirds and the like of a revolution have no finite decimal.
            Self::Rotation if size % 360 != 0 => ("deg/min", 1_000),
            Self::Frequency if size < 1_000 => ("Hz", 1),
            _ => self.units().first().copied().unwrap_or(("", 1)),
        }
    }
}

/// `a`, `a or b`, `a, b or c`.
pub(crate) fn alternatives(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [head @ .., last] => format!("{} or {last}", head.join(", ")),
    }
}

/// `"a"`, `"a" or "b"`, `"a", "b" or "c"`: names may have commas and spaces in them.
pub(crate) fn quoted(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|n| format!("\"{n}\"")).collect();
    alternatives(&names.iter().map(String::as_str).collect::<Vec<_>>())
}

/// `value / size` as a decimal. Exact for the pairs that [`Dimension::unit_for`] chooses: at most nine decimals are needed.
fn decimal(value: i64, size: i64) -> String {
    let sign = if value < 0 { "-" } else { "" };
    let (value, size) = (i128::from(value).abs(), i128::from(size));
    let fraction = (value % size) * 1_000_000_000 / size;
    let text = format!("{sign}{}.{fraction:09}", value / size);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoNumber => f.write_str("no number"),
            Self::NoUnit => f.write_str("no unit"),
            Self::WrongUnit(unit) => write!(f, "unit '{unit}'"),
            Self::TooFine => f.write_str("finer than the resolution"),
            Self::TooLarge => f.write_str("too large"),
        }
    }
}

impl std::error::Error for UnitError {}

/// Reads `2.5 mm` as a value of `dimension`, in base units, exactly. Space between number and unit is free.
///
/// # Errors
/// See [`UnitError`].
pub fn parse(text: &str, dimension: Dimension) -> Result<i64, UnitError> {
    let text = text.trim();
    let end = text
        .char_indices()
        .find(|(k, c)| !(c.is_ascii_digit() || *c == '.' || (*k == 0 && matches!(c, '+' | '-'))))
        .map_or(text.len(), |(k, _)| k);
    let (number, unit) = text.split_at(end);
    let (digits, decimals) = digits(number)?;
    let unit = unit.trim();
    let size = if dimension.units().is_empty() && unit.is_empty() {
        1
    } else if unit.is_empty() {
        return Err(UnitError::NoUnit);
    } else {
        dimension
            .units()
            .iter()
            .find(|(name, _)| *name == unit)
            .map(|(_, size)| *size)
            .ok_or_else(|| UnitError::WrongUnit(unit.to_owned()))?
    };
    let scaled = digits
        .checked_mul(i128::from(size))
        .ok_or(UnitError::TooLarge)?;
    let divisor = 10_i128.checked_pow(decimals).ok_or(UnitError::TooFine)?;
    if scaled % divisor != 0 {
        return Err(UnitError::TooFine);
    }
    i64::try_from(scaled / divisor).map_err(|_| UnitError::TooLarge)
}

/// The digits of a decimal number as an integer with sign, and how many of them stand behind the point.
fn digits(number: &str) -> Result<(i128, u32), UnitError> {
    let (negative, plain) = match number.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, number.strip_prefix('+').unwrap_or(number)),
    };
    let (whole, fraction) = plain.split_once('.').unwrap_or((plain, "0"));
    if whole.is_empty() || fraction.is_empty() || fraction.contains('.') {
        return Err(UnitError::NoNumber);
    }
    let fraction = fraction.trim_end_matches('0');
    let all = format!("{whole}{fraction}");
    if all.trim_start_matches('0').len() > 30 {
        return Err(UnitError::TooLarge);
    }
    let value: i128 = all.parse().map_err(|_| UnitError::NoNumber)?;
    let decimals = u32::try_from(fraction.len()).map_err(|_| UnitError::TooFine)?;
    Ok((if negative { -value } else { value }, decimals))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversions_are_exact() {
        for (text, dimension, value) in [
            ("2 mm", Dimension::Length, 2_000),
            ("0.001 mm", Dimension::Length, 1),
            ("-7um", Dimension::Length, -7),
            ("1 inch", Dimension::Length, 25_400),
            ("2000 mm/min", Dimension::Speed, 2_000_000),
            ("1.5 m/min", Dimension::Speed, 1_500_000),
            ("10 mm/s", Dimension::Speed, 600_000),
            ("300 rev/min", Dimension::Rotation, 108_000_000),
            ("0.1 rev/min", Dimension::Rotation, 36_000),
            ("300 rpm", Dimension::Rotation, 108_000_000),
            ("300 1/min", Dimension::Rotation, 108_000_000),
            ("1 deg/s", Dimension::Rotation, 60_000),
            ("10 deg", Dimension::Angle, 10_000),
            ("0.1 s", Dimension::Time, 100_000),
            ("4 ms", Dimension::Time, 4_000),
            ("8 h", Dimension::Time, 28_800_000_000),
            ("80 %", Dimension::Percent, 80),
            ("300 kHz", Dimension::Frequency, 300_000),
            ("7", Dimension::Count, 7),
        ] {
            assert_eq!(parse(text, dimension), Ok(value), "{text}");
        }
    }

    #[test]
    fn refused_texts_say_why() {
        let length = |text| parse(text, Dimension::Length);
        assert_eq!(length("fast"), Err(UnitError::NoNumber));
        assert_eq!(length(""), Err(UnitError::NoNumber));
        assert_eq!(length("1.2.3 mm"), Err(UnitError::NoNumber));
        assert_eq!(length(".5 mm"), Err(UnitError::NoNumber));
        assert_eq!(length("2"), Err(UnitError::NoUnit));
        assert_eq!(length("2 s"), Err(UnitError::WrongUnit("s".into())));
        assert_eq!(length("2 MM"), Err(UnitError::WrongUnit("MM".into())));
        assert_eq!(length("0.0001 mm"), Err(UnitError::TooFine));
        assert_eq!(length("0.0005 inch"), Err(UnitError::TooFine));
        assert_eq!(parse("31.25 us", Dimension::Time), Err(UnitError::TooFine));
        assert_eq!(parse("12.5 %", Dimension::Percent), Err(UnitError::TooFine));
        assert_eq!(length("9223372036854775808 um"), Err(UnitError::TooLarge));
        assert_eq!(
            length("99999999999999999999999999999999999999 mm"),
            Err(UnitError::TooLarge)
        );
        assert_eq!(
            length("0.00000000000000000000000000000000000000000001 mm"),
            Err(UnitError::TooFine)
        );
        assert_eq!(
            length("9223372036854775807 um"),
            Ok(9_223_372_036_854_775_807)
        );
        assert_eq!(length("-9223372036854775808 um"), Ok(i64::MIN));
    }

    #[test]
    fn what_is_shown_reads_back() {
        let all = [
            Dimension::Length,
            Dimension::Angle,
            Dimension::Speed,
            Dimension::Rotation,
            Dimension::Acceleration,
            Dimension::AngularAcceleration,
            Dimension::Time,
            Dimension::Percent,
            Dimension::Frequency,
            Dimension::Count,
        ];
        let values = [
            0,
            1,
            -1,
            7,
            359,
            360,
            999,
            1_000,
            1_001,
            36_000,
            100_000,
            999_999,
            1_000_001,
            28_800_000_000,
            i64::MAX,
            i64::MIN,
        ];
        for dimension in all {
            for value in values {
                let text = dimension.show(value);
                assert_eq!(parse(&text, dimension), Ok(value), "{text}");
            }
        }
        assert_eq!(Dimension::Length.show(500), "0.5 mm");
        assert_eq!(Dimension::Time.show(100_000), "100 ms");
        assert_eq!(Dimension::Time.show(10_000_000), "10 s");
        assert_eq!(Dimension::Rotation.show(36_000), "0.1 rev/min");
        assert_eq!(Dimension::Rotation.show(1), "0.001 deg/min");
    }
}
