//! One value of a parameter as written: text with a unit, number, Boolean or name of a choice, to base units.

use toml::de::DeValue;

use super::AxisKind;
use super::document::kind_of;
use super::family::{Param, Quantity};
use super::signal;
use super::units::{self, Dimension, UnitError};
use stillpoint_lang::diag::nearest;

/// A value as TOML gives it.
#[derive(Debug, PartialEq)]
pub(super) enum Raw {
    Text(String),
    /// A whole number as written.
    Integer(String),
    Bool(bool),
    /// Anything else, with its kind for messages.
    Other(&'static str),
}

/// Why a value is refused.
#[derive(Debug, PartialEq)]
pub(super) struct Refusal {
    pub message: String,
    pub label: String,
    pub help: String,
}

impl From<&DeValue<'_>> for Raw {
    fn from(value: &DeValue<'_>) -> Self {
        match value {
            DeValue::String(text) => Self::Text(text.to_string()),
            DeValue::Integer(n) => i64::from_str_radix(n.as_str(), n.radix()).map_or_else(
                |_| Self::Integer(n.to_string()),
                |n| Self::Integer(n.to_string()),
            ),
            DeValue::Boolean(b) => Self::Bool(*b),
            other => Self::Other(kind_of(other)),
        }
    }
}

impl From<&toml::Value> for Raw {
    fn from(value: &toml::Value) -> Self {
        match value {
            toml::Value::String(text) => Self::Text(text.clone()),
            toml::Value::Integer(n) => Self::Integer(n.to_string()),
            toml::Value::Boolean(b) => Self::Bool(*b),
            _ => Self::Other("another kind of value"),
        }
    }
}

impl Raw {
    /// As it stands in the file, for messages.
    fn written(&self) -> String {
        match self {
            Self::Text(text) => format!("\"{text}\""),
            Self::Integer(n) => n.clone(),
            Self::Bool(b) => b.to_string(),
            Self::Other(kind) => (*kind).to_owned(),
        }
    }
}

/// The value in base units; the range is not looked at.
pub(super) fn number(raw: &Raw, param: &Param, kind: AxisKind) -> Result<i64, Refusal> {
    match (param.quantity, raw) {
        (Quantity::Choice | Quantity::Signal, _) => choice(raw, param),
        (Quantity::Bool, Raw::Bool(b)) => Ok(i64::from(*b)),
        (Quantity::Bool, _) => Err(Refusal {
            message: format!("true or false is needed; got {}", raw.written()),
            label: "neither true nor false".to_owned(),
            help: "write true or false, without quotes".to_owned(),
        }),
        (quantity, _) => {
            let dimension = quantity.dimension(kind);
            physical(raw, dimension).map_err(|e| refuse(raw, param, kind, &e))
        }
    }
}

/// The value in base units, within the range of the parameter.
pub(super) fn number_in_range(raw: &Raw, param: &Param, kind: AxisKind) -> Result<i64, Refusal> {
    let value = number(raw, param, kind)?;
    let limits = param.limits(kind);
    let (least, greatest) = (param.show(limits.min, kind), param.show(limits.max, kind));
    let message = if value < 0 && limits.min == 0 && param.quantity == Quantity::Time {
        format!("a time cannot be negative; got {}", raw.written())
    } else if value < limits.min {
        format!("{} is below the least value {least}", raw.written())
    } else if value > limits.max {
        format!("{} is above the greatest value {greatest}", raw.written())
    } else if value % param.step != 0 {
        return Err(Refusal {
            message: format!("{} is finer than the control takes", raw.written()),
            label: format!(
                "a whole number of steps of {}",
                param.show(param.step, kind)
            ),
            help: allowed(param, kind),
        });
    } else {
        return Ok(value);
    };
    Err(Refusal {
        message,
        label: format!("allowed: {least} to {greatest}"),
        help: allowed(param, kind),
    })
}

/// `allowed: 0 s to 10 s (MD36956/1356 $MA_SAFE_PULSE_DISABLE_DELAY)`.
fn allowed(param: &Param, kind: AxisKind) -> String {
    let limits = param.limits(kind);
    let range = format!(
        "allowed: {} to {}",
        param.show(limits.min, kind),
        param.show(limits.max, kind)
    );
    if param.manual.is_empty() {
        range
    } else {
        format!("{range} ({})", param.manual)
    }
}

fn physical(raw: &Raw, dimension: Dimension) -> Result<i64, UnitError> {
    match raw {
        Raw::Text(text) if dimension != Dimension::Count => units::parse(text, dimension),
        Raw::Integer(text) => units::parse(text, dimension),
        Raw::Text(_) | Raw::Bool(_) | Raw::Other(_) => Err(UnitError::NoNumber),
    }
}

fn refuse(raw: &Raw, param: &Param, kind: AxisKind, error: &UnitError) -> Refusal {
    let dimension = param.quantity.dimension(kind);
    let (noun, units) = (dimension.noun(), dimension.unit_list());
    let (message, label) = match error {
        UnitError::NoNumber if dimension == Dimension::Count => (
            format!("a whole number is needed; got {}", raw.written()),
            "not a whole number".to_owned(),
        ),
        UnitError::NoNumber => (
            format!(
                "{noun} is needed, a number with {units}; got {}",
                raw.written()
            ),
            "not a number with a unit".to_owned(),
        ),
        UnitError::NoUnit => (
            format!("{noun} needs {units}; {} has no unit", raw.written()),
            "the unit is missing".to_owned(),
        ),
        UnitError::WrongUnit(unit) => (
            format!("{noun} needs {units}; got '{unit}'"),
            "wrong unit".to_owned(),
        ),
        UnitError::TooFine => (
            format!(
                "{} is finer than the resolution {}",
                raw.written(),
                dimension.show(1)
            ),
            "not a whole number of steps".to_owned(),
        ),
        UnitError::TooLarge => (
            format!("{} is too large", raw.written()),
            "too large".to_owned(),
        ),
    };
    let example = match dimension {
        Dimension::Count => format!("write {}", param.limits(kind).default),
        _ => format!(
            "write for example \"{}\"",
            param.show(param.limits(kind).default, kind)
        ),
    };
    Refusal {
        message,
        label,
        help: format!("{example}; {}", allowed(param, kind)),
    }
}

fn choice(raw: &Raw, param: &Param) -> Result<i64, Refusal> {
    let names: Vec<&str> = param
        .choices
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    let Raw::Text(text) = raw else {
        return Err(Refusal {
            message: format!("one of the names is needed; got {}", raw.written()),
            label: "not a name".to_owned(),
            help: format!("write {}", param.names()),
        });
    };
    let coded = (param.quantity == Quantity::Signal)
        .then(|| signal::coded(text))
        .flatten();
    let mut all = param.choices.iter();
    let found = all.find(|(name, code)| name == text || Some(signal::datum(*code)) == coded);
    found.map(|(_, code)| *code).ok_or_else(|| Refusal {
        message: format!("\"{text}\" is not one of the values"),
        label: "no such value".to_owned(),
        help: match nearest(text, names.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"? Allowed: {}", param.names()),
            None => format!("allowed: {}", param.names()),
        },
    })
}
