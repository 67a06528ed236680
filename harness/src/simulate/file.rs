//! A scenario file as it is written: tables and texts with their places, nothing resolved yet.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use crate::recording::Value;

/// A text with its place.
pub(super) type Text = Spanned<String>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    pub title: Option<String>,
    pub duration: Text,
    pub start: Option<Text>,
    #[serde(default)]
    pub acceptance_mode: bool,
    #[serde(default)]
    pub axis: BTreeMap<Text, Axis>,
    #[serde(default)]
    pub motion: Vec<Motion>,
    #[serde(default)]
    pub select: Vec<Select>,
    #[serde(default)]
    pub door: Vec<Door>,
    #[serde(default)]
    pub signal: Vec<Signal>,
    #[serde(default)]
    pub stop: Vec<Stop>,
    #[serde(default)]
    pub reset: Vec<Reset>,
    #[serde(default)]
    pub power: Vec<Power>,
    #[serde(default)]
    pub agreement: Vec<Agreement>,
    #[serde(default)]
    pub reference: Vec<Reference>,
    #[serde(default)]
    pub moved: Vec<Moved>,
    #[serde(default)]
    pub fault: Vec<Fault>,
    #[serde(default)]
    pub brake: Vec<Brake>,
    #[serde(default)]
    pub load: Vec<Load>,
    #[serde(default)]
    pub expect: Vec<Expect>,
}

/// What the machine file does not say of an axis: its mechanics.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct Axis {
    pub position: Option<Text>,
    pub acceleration: Option<Text>,
    pub braking: Option<Text>,
    pub path_braking: Option<Text>,
    pub friction: Option<Text>,
    pub sag: Option<Text>,
    pub brake_time: Option<Text>,
    pub dead_time: Option<Text>,
    pub following: Option<Text>,
}

/// One name or several; a text may name several, too: `"X, Y"`.
#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum Names {
    One(String),
    Many(Vec<String>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Motion {
    pub at: Text,
    pub axis: Option<Spanned<Names>>,
    pub speed: Text,
    pub to: Option<Text>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Select {
    pub at: Text,
    pub axis: Option<Spanned<Names>>,
    pub function: Option<Text>,
    pub limits: Option<Text>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Door {
    pub at: Text,
    pub door: Text,
    pub ask: Option<bool>,
    pub open: Option<bool>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Signal {
    pub at: Text,
    pub until: Option<Text>,
    pub axis: Option<Spanned<Names>>,
    pub channel: Option<Text>,
    pub signal: Text,
    pub value: Spanned<Scalar>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Stop {
    pub at: Text,
    pub axis: Option<Spanned<Names>>,
    pub channel: Option<Text>,
    pub stop: Text,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Reset {
    pub at: Text,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Power {
    pub at: Text,
    pub run_up: Option<Text>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Agreement {
    pub at: Text,
    pub axis: Option<Spanned<Names>>,
    pub give: bool,
    #[serde(default = "yes")]
    pub key: bool,
}

fn yes() -> bool {
    true
}

/// Somebody moves an axis by hand.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Moved {
    pub at: Text,
    pub axis: Spanned<Names>,
    pub by: Text,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Reference {
    pub at: Text,
    pub axis: Option<Spanned<Names>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Fault {
    pub at: Text,
    pub until: Option<Text>,
    pub axis: Spanned<Names>,
    pub channel: Option<Text>,
    pub encoder: Option<Text>,
    pub kind: Text,
    pub offset: Option<Text>,
    pub speed: Option<Text>,
    pub signal: Option<Text>,
    pub value: Option<Spanned<Scalar>>,
}

/// What becomes of a brake: without a key it is in order again.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Brake {
    pub at: Text,
    pub axis: Spanned<Names>,
    pub brake: Spanned<i64>,
    pub torque: Option<Text>,
    #[serde(default)]
    pub stuck: bool,
}

/// Another load on the rope.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Load {
    pub at: Text,
    pub axis: Spanned<Names>,
    pub load: Spanned<i64>,
    pub rests: Option<Text>,
}

#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum Scalar {
    Bool(bool),
    Int(i64),
    Text(String),
}

impl Scalar {
    /// The value of a signal.
    pub(super) fn value(&self) -> Value {
        match self {
            Self::Bool(b) => Value::Bool(*b),
            Self::Int(n) => Value::Int(*n),
            Self::Text(text) => Value::Text(text.clone().into()),
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Expect {
    pub axis: Option<Spanned<Names>>,
    pub channel: Option<Text>,
    pub stop: Option<Text>,
    pub standstill: Option<Spanned<bool>>,
    pub alarm: Option<Text>,
    pub signal: Option<Text>,
    pub value: Option<Spanned<Scalar>>,
    pub after: Option<Text>,
    pub by: Option<Text>,
    #[serde(default)]
    pub never: bool,
}
