//! Values of options: sizes, durations, readings.

use std::collections::BTreeSet;
use std::time::Duration;

use stillpoint_engine::subject::Readings;

/// `64MiB`, `2G`, `1000000` in bytes.
pub fn size(text: &str) -> Result<u64, String> {
    let wrong = || format!("`{text}` is not a size; write for example 512MiB or 2GiB");
    let at = text
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(text.len());
    let number: u64 = text[..at].parse().map_err(|_| wrong())?;
    let shift = match text[at..]
        .trim()
        .to_ascii_lowercase()
        .trim_end_matches('b')
        .trim_end_matches('i')
    {
        "" => 0,
        "k" => 10,
        "m" => 20,
        "g" => 30,
        "t" => 40,
        _ => return Err(wrong()),
    };
    number
        .checked_shl(shift)
        .filter(|n| n >> shift == number && *n > 0)
        .ok_or_else(wrong)
}

/// `90s`, `5m`, `2h`, `500ms`.
pub fn duration(text: &str) -> Result<Duration, String> {
    let wrong = || format!("`{text}` is not a duration; write for example 90s, 5m or 500ms");
    let at = text
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(text.len());
    let number: u64 = text[..at].parse().map_err(|_| wrong())?;
    let milliseconds = match text[at..].trim() {
        "ms" => Some(number),
        "" | "s" => number.checked_mul(1000),
        "m" | "min" => number.checked_mul(60_000),
        "h" => number.checked_mul(3_600_000),
        _ => None,
    };
    milliseconds.map(Duration::from_millis).ok_or_else(wrong)
}

/// What `--readings` asks for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ReadingsChoice {
    /// Compare all options of all readings.
    pub all: bool,
    /// Options chosen by id.
    pub chosen: Readings,
}

/// `all`, or `ID=OPTION` pairs.
pub fn readings(given: &[String]) -> Result<ReadingsChoice, String> {
    let mut out = ReadingsChoice::default();
    for item in given.iter().flat_map(|g| g.split(',')) {
        match item.split_once('=') {
            Some((id, option)) if !id.is_empty() && !option.is_empty() => {
                out.chosen.insert(id.to_owned(), option.to_owned());
            }
            None if item == "all" => out.all = true,
            _ => {
                return Err(format!(
                    "`{item}` is not a reading; write `all` or ID=OPTION, e.g. A-25=RESET_AT_ONCE"
                ));
            }
        }
    }
    Ok(out)
}

/// Ids that no system knows.
pub fn unknown<'a>(chosen: &'a Readings, known: &BTreeSet<String>) -> Option<&'a str> {
    chosen
        .keys()
        .map(String::as_str)
        .find(|id| !known.contains(*id))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_durations() {
        assert_eq!(size("64MiB"), Ok(64 << 20));
        assert_eq!(size("2G"), Ok(2 << 30));
        assert_eq!(size("7"), Ok(7));
        assert!(
            size("MiB").is_err()
                && size("-1").is_err()
                && size("99999999999T").is_err()
                && size("0").is_err()
        );
        assert_eq!(duration("90s"), Ok(Duration::from_secs(90)));
        assert_eq!(duration("500ms"), Ok(Duration::from_millis(500)));
        assert!(duration("5 fortnights").is_err() && duration("-5s").is_err());
    }
}
