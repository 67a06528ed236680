//! A specification as it is written, for readers: machines with their ports, rules and outputs in the words of the files.

use crate::property::texts;
use crate::schema::{self, Scalar};
use crate::spec::Spec;

/// Everything that a specification and the files it includes define, in the order they are read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Outline {
    /// Enums.
    pub enums: Vec<Enum>,
    /// Functions.
    pub functions: Vec<Function>,
    /// Readings.
    pub readings: Vec<Reading>,
    /// Machines.
    pub machines: Vec<Machine>,
    /// Systems of the file itself.
    pub systems: Vec<System>,
}

/// An enum.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Enum {
    /// Name.
    pub name: String,
    /// What it is; may be empty.
    pub text: String,
    /// Values in rising order.
    pub values: Vec<String>,
}

/// A function that expressions may call.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Function {
    /// Name.
    pub name: String,
    /// What it computes; may be empty.
    pub text: String,
    /// Arguments with their types.
    pub args: Vec<String>,
    /// Its value.
    pub value: String,
}

/// An ambiguity and its options.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reading {
    /// Id, such as `A-25`.
    pub id: String,
    /// What is ambiguous.
    pub text: String,
    /// Names of the options, the recommended one first.
    pub options: Vec<String>,
    /// Remarks; may be empty.
    pub note: String,
}

/// A machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Machine {
    /// Name.
    pub name: String,
    /// The name of the specification it stands in: `sinumerik-840d/stop`.
    pub spec: String,
    /// What it is.
    pub text: String,
    /// Whether its rules are ordered on purpose: the first that matches wins.
    pub ordered: bool,
    /// Whether what no rule covers stays as it is on purpose.
    pub stays: bool,
    /// Parameters.
    pub params: Vec<Port>,
    /// Inputs.
    pub inputs: Vec<Port>,
    /// State variables.
    pub states: Vec<Port>,
    /// Named expressions.
    pub lets: Vec<Named>,
    /// Rules, in order.
    pub rules: Vec<Rule>,
    /// Outputs.
    pub outputs: Vec<Named>,
}

/// A parameter, input or state variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Port {
    /// Name.
    pub name: String,
    /// Type, as written.
    pub ty: String,
    /// Default of a parameter, initial value of a state variable.
    pub value: Option<String>,
    /// What it is; may be empty.
    pub text: String,
    /// Requirement ids.
    pub ids: Vec<String>,
}

/// A named expression or an output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Named {
    /// Name.
    pub name: String,
    /// The expression, as written.
    pub value: String,
    /// What it is; may be empty.
    pub text: String,
    /// Requirement ids.
    pub ids: Vec<String>,
}

/// A rule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rule {
    /// Name.
    pub name: String,
    /// Guard.
    pub when: String,
    /// Effect.
    pub then: String,
    /// Why it stands there; may be empty.
    pub note: String,
    /// Requirement ids.
    pub ids: Vec<String>,
}

/// A system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct System {
    /// Name.
    pub name: String,
    /// What it is.
    pub text: String,
    /// What it leaves out; may be empty.
    pub note: String,
    /// Whether a machine file's times are scaled down for it.
    pub scaled: bool,
    /// Its instances: name and machine.
    pub instances: Vec<(String, String)>,
    /// Its properties.
    pub properties: Vec<Property>,
}

/// A property.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Property {
    /// Id.
    pub id: String,
    /// In plain words.
    pub text: String,
    /// Remarks; may be empty.
    pub note: String,
    /// Requirement ids.
    pub req: Vec<String>,
    /// `fault` or `reaction`, for the tables of a report.
    pub topic: Option<String>,
    /// Its expressions: the key, such as `leads_to`, and the text.
    pub written: Vec<(String, String)>,
    /// The greatest number of cycles allowed, as written.
    pub within: Option<String>,
    /// The greatest number of cycles that occurs.
    pub exactly: Option<String>,
    /// The least number of cycles that occurs.
    pub fastest: Option<String>,
}

impl Spec {
    /// The specification as it is written. Nothing is resolved: what is wrong in an expression is found by
    /// [`Spec::system`].
    pub fn outline(&self) -> Outline {
        Outline {
            enums: (self.enums.iter())
                .map(|(name, e)| Enum {
                    name: name.clone(),
                    text: e.def.text.clone(),
                    values: plain(&e.def.values),
                })
                .collect(),
            functions: (self.functions.iter())
                .map(|(name, f)| Function {
                    name: name.clone(),
                    text: f.def.text.clone(),
                    args: plain(&f.def.args),
                    value: f.def.value.get_ref().clone(),
                })
                .collect(),
            readings: (self.readings.iter())
                .map(|(id, r)| Reading {
                    id: id.clone(),
                    text: r.def.text.clone(),
                    options: plain(&r.def.options),
                    note: r.def.note.clone(),
                })
                .collect(),
            machines: (self.machines.iter())
                .map(|(name, m)| machine(name, &self.sources[m.file].spec, &m.def))
                .collect(),
            systems: (self.systems.iter())
                .map(|(name, s)| system(name, &s.def))
                .collect(),
        }
    }
}

fn plain(texts: &[schema::Text]) -> Vec<String> {
    texts.iter().map(|t| t.get_ref().clone()).collect()
}

fn scalar(value: &Scalar) -> String {
    match value {
        Scalar::Bool(true) => "TRUE".to_owned(),
        Scalar::Bool(false) => "FALSE".to_owned(),
        Scalar::Int(number) => number.to_string(),
        Scalar::Text(text) => text.clone(),
    }
}

fn machine(name: &str, spec: &str, def: &schema::Machine) -> Machine {
    Machine {
        name: name.to_owned(),
        spec: spec.to_owned(),
        text: def.text.clone(),
        ordered: def.order.is_some(),
        stays: def.otherwise.is_some(),
        params: ports(&def.param),
        inputs: ports(&def.input),
        states: ports(&def.state),
        lets: named(&def.lets),
        rules: (def.rule.iter())
            .map(|r| Rule {
                name: r.name.get_ref().clone(),
                when: r.when.get_ref().clone(),
                then: r.then.get_ref().clone(),
                note: r.note.clone(),
                ids: r.id.clone(),
            })
            .collect(),
        outputs: named(&def.output),
    }
}

/// A default as it is written.
fn default(value: &schema::Default) -> String {
    match value {
        schema::Default::All(value) => scalar(value),
        schema::Default::Each(numbers) => {
            let numbers: Vec<String> = numbers.iter().map(i64::to_string).collect();
            numbers.join(", ")
        }
    }
}

fn ports(of: &schema::Map<schema::Short<schema::Port>>) -> Vec<Port> {
    let value = |port: &schema::Port| match &port.default {
        Some(value) => Some(default(value.get_ref())),
        None => port.init.as_ref().map(|value| scalar(value.get_ref())),
    };
    let port = |(name, port): (&schema::Text, &schema::Short<schema::Port>)| Port {
        name: name.get_ref().clone(),
        ty: port.0.ty.get_ref().clone(),
        value: value(&port.0),
        text: port.0.text.clone(),
        ids: port.0.id.clone(),
    };
    of.iter().map(port).collect()
}

fn named(of: &schema::Map<schema::Short<schema::Output>>) -> Vec<Named> {
    let one = |(name, def): (&schema::Text, &schema::Short<schema::Output>)| Named {
        name: name.get_ref().clone(),
        value: def.0.value.get_ref().clone(),
        text: def.0.text.clone(),
        ids: def.0.id.clone(),
    };
    of.iter().map(one).collect()
}

fn system(name: &str, def: &schema::System) -> System {
    let bound = |value: &Option<toml::Spanned<Scalar>>| value.as_ref().map(|v| scalar(v.get_ref()));
    let property = |def: &schema::Property| Property {
        id: def.id.get_ref().clone(),
        text: def.text.clone(),
        note: def.note.clone(),
        req: def.req.clone(),
        topic: def.topic.as_ref().map(|t| t.get_ref().clone()),
        written: (texts(def).into_iter())
            .map(|(key, text)| (key.to_owned(), text.get_ref().clone()))
            .collect(),
        within: bound(&def.within),
        exactly: bound(&def.exactly),
        fastest: bound(&def.fastest),
    };
    System {
        name: name.to_owned(),
        text: def.text.clone(),
        note: def.note.clone(),
        scaled: def.timers.as_ref().is_some_and(|t| t.get_ref() == "scaled"),
        instances: (def.instance.iter())
            .map(|(name, i)| (name.get_ref().clone(), i.machine.get_ref().clone()))
            .collect(),
        properties: def.property.iter().map(property).collect(),
    }
}
