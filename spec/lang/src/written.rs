//! A machine as it is written: read from TOML, or made by a translator of another language.

use serde::Deserialize;
use toml::Spanned;

use crate::schema::{Default, Machine, Map, Output, Port, Rule, Scalar, Short, Text};

/// A machine as it is written: of the right form, not yet looked at.
///
/// Each text has a byte range, that of what it was made from: errors in it are told there.
#[derive(Clone, Deserialize)]
#[serde(transparent)]
pub struct Written(Machine);

impl Written {
    /// A machine without anything in it; what no rule covers stays as it is.
    pub fn new(text: impl Into<String>) -> Self {
        Self(Machine {
            text: text.into(),
            order: Some(Spanned::new(0..0, "priority".to_owned())),
            otherwise: Some(Spanned::new(0..0, "stay".to_owned())),
            param: Map::new(),
            input: Map::new(),
            state: Map::new(),
            lets: Map::new(),
            rule: Vec::new(),
            output: Map::new(),
            note: String::new(),
        })
    }

    pub(crate) const fn def(&self) -> &Machine {
        &self.0
    }

    /// The names of its outputs.
    pub fn outputs(&self) -> impl Iterator<Item = &Spanned<String>> {
        self.0.output.keys()
    }

    /// Adds a parameter with its type and default.
    pub fn add_param(&mut self, name: Text, ty: Text, default: i64, text: &str) {
        let default = Spanned::new(name.span(), Default::All(Scalar::Int(default)));
        let port = port(ty, Some(default), None, text);
        self.0.param.insert(name, Short(port));
    }

    /// Adds an input with its type.
    pub fn add_input(&mut self, name: Text, ty: Text, text: &str) {
        let port = port(ty, None, None, text);
        self.0.input.insert(name, Short(port));
    }

    /// Adds a state variable with its type and initial value.
    pub fn add_state(&mut self, name: Text, ty: Text, init: Text, text: &str) {
        let init = Spanned::new(init.span(), Scalar::Text(init.into_inner()));
        let port = port(ty, None, Some(init), text);
        self.0.state.insert(name, Short(port));
    }

    /// Adds a named expression.
    pub fn add_let(&mut self, name: Text, value: Text, text: &str) {
        self.0.lets.insert(name, Short(output(value, text)));
    }

    /// Adds an output.
    pub fn add_output(&mut self, name: Text, value: Text, text: &str) {
        self.0.output.insert(name, Short(output(value, text)));
    }

    /// Adds a rule that fires whenever none before it does; `note` says why it names no requirement.
    pub fn add_rule(&mut self, name: Text, then: Text, note: &str) {
        self.0.rule.push(Rule {
            when: Spanned::new(name.span(), "TRUE".to_owned()),
            name,
            id: Vec::new(),
            then,
            note: note.to_owned(),
        });
    }
}

fn port(
    ty: Text,
    default: Option<Spanned<Default>>,
    init: Option<Spanned<Scalar>>,
    text: &str,
) -> Port {
    Port {
        ty,
        default,
        init,
        text: text.to_owned(),
        id: Vec::new(),
    }
}

fn output(value: Text, text: &str) -> Output {
    Output {
        value,
        id: Vec::new(),
        text: text.to_owned(),
    }
}
