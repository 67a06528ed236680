//! Numbers for readers.

/// A value with so many decimals at most; zeros at the end are left out, and so is the sign of nothing.
pub(crate) fn trimmed(value: f64, decimals: usize) -> String {
    let fixed = format!("{value:.decimals$}");
    let short = if fixed.contains('.') {
        fixed.trim_end_matches('0').trim_end_matches('.')
    } else {
        fixed.as_str()
    };
    if short == "-0" {
        "0".to_owned()
    } else {
        short.to_owned()
    }
}

/// Microseconds in milliseconds: `12 ms`, `0.5 ms`.
pub(crate) fn millis(us: u64) -> String {
    let decimals = format!("{:03}", us % 1000);
    let decimals = decimals.trim_end_matches('0');
    let point = if decimals.is_empty() { "" } else { "." };
    format!("{}{point}{decimals} ms", us / 1000)
}

/// Round values from `low` to `high`, three to six of them, with the decimals they need.
pub(crate) fn ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let span = high - low;
    if !span.is_finite() || span <= 0.0 {
        return Vec::new();
    }
    let power = 10f64.powf((span / 3.0).log10().floor());
    let steps = [1.0, 2.0, 2.5, 5.0, 10.0].map(|m| m * power);
    let step = steps
        .into_iter()
        .rev()
        .find(|s| span / s >= 2.0)
        .unwrap_or(power);
    let decimals = (0..6)
        .find(|d| {
            let scaled = step * 10f64.powi(*d);
            (scaled - scaled.round()).abs() < 1e-6 * scaled
        })
        .unwrap_or(6) as usize;
    let first = (low / step).ceil();
    (0..10)
        .map(|k| (first + f64::from(k)) * step)
        .take_while(|v| *v <= high + 1e-9 * span)
        .map(|v| (v, trimmed(v, decimals)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_as_needed() {
        assert_eq!(trimmed(1.50, 3), "1.5");
        assert_eq!(trimmed(-0.0001, 2), "0");
        assert_eq!(trimmed(100.0, 0), "100");
        assert_eq!(millis(12_000), "12 ms");
        assert_eq!(millis(12_500), "12.5 ms");
    }

    #[test]
    fn ticks_are_round() {
        let told = |low, high| -> Vec<String> {
            ticks(low, high).into_iter().map(|(_, name)| name).collect()
        };
        assert_eq!(told(0.0, 1000.0), ["0", "500", "1000"]);
        assert_eq!(told(-0.3, 0.7), ["0", "0.5"]);
        assert!(told(1.0, 1.0).is_empty());
    }
}
