//! The TOML shape of a specification file, with the place of every text.

use indexmap::IndexMap;
use serde::Deserialize;
use serde::de::{self, MapAccess, Visitor, value::MapAccessDeserializer};
use std::fmt;
use std::marker::PhantomData;
use toml::Spanned;

pub(crate) type Text = Spanned<String>;
pub(crate) type Map<T> = IndexMap<Text, T>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct File {
    pub spec: Text,
    #[serde(default)]
    pub title: String,
    #[serde(default)]
    pub source: String,
    #[serde(default, rename = "use")]
    pub uses: Vec<Text>,
    #[serde(default, rename = "enum")]
    pub enums: Map<Enum>,
    #[serde(default)]
    pub function: Map<Function>,
    #[serde(default)]
    pub reading: Map<Reading>,
    #[serde(default)]
    pub machine: Map<Machine>,
    #[serde(default)]
    pub system: Map<System>,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Enum {
    #[serde(default)]
    pub text: String,
    pub values: Vec<Text>,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Function {
    #[serde(default)]
    #[allow(dead_code)] // a comment for readers of the file
    pub text: String,
    #[serde(default)]
    pub args: Vec<Text>,
    pub value: Text,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Reading {
    pub text: String,
    pub options: Vec<Text>,
    #[serde(default)]
    pub note: String,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Machine {
    pub text: String,
    pub order: Option<Text>,
    pub otherwise: Option<Text>,
    #[serde(default)]
    pub param: Map<Short<Port>>,
    #[serde(default)]
    pub input: Map<Short<Port>>,
    #[serde(default)]
    pub state: Map<Short<Port>>,
    #[serde(default, rename = "let")]
    pub lets: Map<Short<Output>>,
    #[serde(default)]
    pub rule: Vec<Rule>,
    #[serde(default)]
    pub output: Map<Short<Output>>,
    #[serde(default)]
    #[allow(dead_code)]
    pub note: String,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Port {
    #[serde(rename = "type")]
    pub ty: Text,
    pub default: Option<Spanned<Default>>,
    pub init: Option<Spanned<Scalar>>,
    #[serde(default)]
    pub text: String,
    #[serde(default, deserialize_with = "crate::catalogue::once")]
    pub id: Vec<String>,
}

/// The default of a parameter; that of an array for all its cells, or a number for each.
#[derive(Deserialize, Clone, Debug)]
#[serde(untagged)]
pub(crate) enum Default {
    All(Scalar),
    Each(Vec<i64>),
}

/// A number, truth value or text where an expression is meant.
#[derive(Deserialize, Clone, Debug)]
#[serde(untagged)]
pub(crate) enum Scalar {
    Bool(bool),
    Int(i64),
    Text(String),
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Output {
    pub value: Text,
    #[serde(default, deserialize_with = "crate::catalogue::once")]
    pub id: Vec<String>,
    #[serde(default)]
    pub text: String,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rule {
    pub name: Text,
    #[serde(default, deserialize_with = "crate::catalogue::once")]
    pub id: Vec<String>,
    pub when: Text,
    pub then: Text,
    #[serde(default)]
    pub note: String,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct System {
    pub text: String,
    pub cycle: Option<Text>,
    pub timers: Option<Text>,
    #[serde(default)]
    pub note: String,
    #[serde(default)]
    pub param: Map<Short<Port>>,
    #[serde(default)]
    pub input: Map<Short<Port>>,
    #[serde(default)]
    pub instance: Map<Instance>,
    #[serde(default)]
    pub wire: Map<Text>,
    #[serde(default)]
    pub free: Free,
    #[serde(default)]
    pub unreached: Map<String>,
    #[serde(default)]
    pub property: Vec<Property>,
}

#[derive(Deserialize, Clone, Default)]
#[serde(deny_unknown_fields)]
pub(crate) struct Free {
    #[serde(default)]
    pub ports: Vec<Text>,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Instance {
    pub machine: Text,
    pub count: Option<Spanned<i64>>,
    #[serde(default)]
    pub param: Map<Spanned<Scalar>>,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub(crate) struct Property {
    pub id: Text,
    pub text: String,
    #[serde(default)]
    pub note: String,
    #[serde(default, deserialize_with = "crate::catalogue::once")]
    pub req: Vec<String>,
    pub topic: Option<Text>,
    pub always: Option<Text>,
    pub never: Option<Text>,
    pub when: Option<Text>,
    pub then: Option<Text>,
    pub leads_to: Option<Text>,
    pub within: Option<Spanned<Scalar>>,
    pub exactly: Option<Spanned<Scalar>>,
    pub fastest: Option<Spanned<Scalar>>,
    #[serde(default)]
    pub fair: Vec<Text>,
    pub assuming: Option<Text>,
    pub holds: Option<Text>,
    pub unless: Option<Text>,
    pub can_always_reach: Option<Text>,
    pub using: Option<Text>,
    pub reachable: Option<Text>,
    #[serde(default)]
    pub observe: Vec<Text>,
    #[serde(default)]
    pub of: Vec<Text>,
    #[serde(rename = "while")]
    pub while_: Option<Text>,
}

/// Either the long form (a table) or its main text alone.
#[derive(Clone)]
pub(crate) struct Short<T>(pub T);

/// What a short form stands for.
pub(crate) trait FromText {
    fn from_text(text: Text) -> Self;
}

impl FromText for Port {
    fn from_text(ty: Text) -> Self {
        Port {
            ty,
            default: None,
            init: None,
            text: String::new(),
            id: Vec::new(),
        }
    }
}

impl FromText for Output {
    fn from_text(value: Text) -> Self {
        Output {
            value,
            id: Vec::new(),
            text: String::new(),
        }
    }
}

impl<'de, T: Deserialize<'de> + FromText> Deserialize<'de> for Short<T> {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let either = Spanned::<Either<T>>::deserialize(deserializer)?;
        let span = either.span();
        Ok(Short(match either.into_inner() {
            Either::Short(text) => T::from_text(Spanned::new(span, text)),
            Either::Long(long) => long,
        }))
    }
}

enum Either<T> {
    Short(String),
    Long(T),
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Either<T> {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct V<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for V<T> {
            type Value = Either<T>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a text or a table")
            }
            fn visit_str<E: de::Error>(self, v: &str) -> Result<Self::Value, E> {
                Ok(Either::Short(v.to_owned()))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(Either::Long)
            }
        }
        deserializer.deserialize_any(V(PhantomData))
    }
}
