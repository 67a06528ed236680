//! Which variable is what: an input of the machine, a further input, a variable of the table, or always 0.

use std::collections::{BTreeMap, HashSet};

use stillpoint_lang::diag::nearest;

use super::super::interface::Places;
use super::super::variable::{Access, Ty, Values};
use super::super::{Interface, Output, Program, Variable};
use crate::fault::{Fault, Span};
use crate::st::Signature;
use crate::st::signature::Port;
use crate::st::term;

/// What a variable is in the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Role {
    /// An input, of the machine or a further one: its name.
    Input(String),
    /// Written by the program: the name of the variable in the tree.
    State(String),
    /// Nobody writes it.
    Zero,
}

/// The variables of a program in its table.
pub(super) struct Wiring {
    pub roles: BTreeMap<Variable, Role>,
    /// The machine's interface with the further inputs.
    pub signature: Signature,
    /// The range of numbers of 32 bits: one beyond all they are compared with, on both sides.
    pub numbers: (i64, i64),
    /// Names that are taken, in upper case.
    taken: HashSet<String>,
}

/// More numbers than these are not explored.
const MOST: i64 = 4_096;

impl Wiring {
    /// Looks at the interface and the variables; what is wrong is told.
    pub fn new(
        program: &Program,
        interface: &Interface,
        constants: &[(i64, Span)],
        faults: &mut Vec<Fault>,
    ) -> Self {
        let signature = interface.signature.clone();
        let taken = signature
            .names()
            .into_iter()
            .map(|name| name.to_ascii_uppercase());
        let mut wiring = Self {
            roles: BTreeMap::new(),
            taken: taken.collect(),
            numbers: numbers(constants, faults),
            signature,
        };
        let places = program.places();
        wiring.inputs(interface, &places, faults);
        let given = |variable: &Variable| {
            let mut named = interface.inputs.iter();
            named
                .find(|(of, _)| of == variable)
                .map(|(_, port)| port.clone())
        };
        // Who takes a variable as an output takes nobody else to write it.
        let taken_out = |variable: &Variable| {
            interface.outputs.iter().any(
                |(_, output)| matches!(output, Output::Variable { variable: of, .. } if of == variable),
            )
        };
        for (variable, places) in &places {
            let first = places
                .read
                .clone()
                .or(places.written.clone())
                .unwrap_or(0..0);
            if variable.kind().values == Values::Bits {
                faults.push(Fault::new(
                    &first,
                    format!(
                        "`{}` is not explored: it has 2^32 values",
                        variable.written()
                    ),
                    format!(
                        "use the bits, such as `${}[1]`",
                        variable.kind().name.trim_end_matches('D')
                    ),
                ));
                continue;
            }
            let role = match (&places.written, given(variable)) {
                (Some(_), _) => Role::State(wiring.fresh(&variable.identifier())),
                (None, Some(port)) => Role::Input(port),
                (None, None) if variable.kind().own || taken_out(variable) => Role::Zero,
                (None, None) => Role::Input(wiring.added(program, variable)),
            };
            wiring.roles.insert(variable.clone(), role);
        }
        wiring.outputs(interface, faults);
        wiring
    }

    /// A name that nothing has yet.
    pub fn fresh(&mut self, base: &str) -> String {
        let mut name = base.to_owned();
        let mut number = 1;
        while !self.taken.insert(name.to_ascii_uppercase()) {
            number += 1;
            name = format!("{base}_{number}");
        }
        name
    }

    /// The values of a number.
    pub fn range(&self, variable: &Variable) -> (i64, i64) {
        match variable.kind().values {
            Values::Range(low, high) => (low, high),
            _ => self.numbers,
        }
    }

    /// A further input of the table.
    fn added(&mut self, program: &Program, variable: &Variable) -> String {
        let name = self.fresh(&variable.identifier());
        let (ty, (low, high)) = match variable.kind().ty {
            Ty::Int => {
                // One value beyond all that it is compared with stands for all of them.
                let (low, high) = self.range(variable);
                let own = matches!(variable.kind().values, Values::Range(..));
                let range = match program.compared(variable).filter(|_| own) {
                    Some((least, most)) => (low.max(least - 1), high.min(most + 1)),
                    None => (low, high),
                };
                (term::Ty::Int, range)
            }
            _ => (term::Ty::Bool, (0, 1)),
        };
        self.signature.inputs.push(Port {
            name: name.clone(),
            ty,
            low,
            high,
            added: Some(variable.to_string()),
            called: None,
        });
        name
    }

    /// The inputs that the interface names are right.
    fn inputs(
        &self,
        interface: &Interface,
        places: &BTreeMap<Variable, Places>,
        faults: &mut Vec<Fault>,
    ) {
        let mut seen = HashSet::new();
        for (variable, port) in &interface.inputs {
            let wrong = |message: String, help: &str| unplaced(message, help.to_owned());
            let kind = variable.kind();
            if !seen.insert(variable) {
                let message = format!("{variable} is wired to two inputs");
                faults.push(wrong(message, "wire each variable once"));
            } else if places.get(variable).is_some_and(|p| p.written.is_some()) {
                let message =
                    format!("{variable} is wired to the input '{port}', and the program writes it");
                faults.push(wrong(
                    message,
                    "an input is a variable that the program only reads",
                ));
            } else if kind.access == Access::Write
                || kind.ty == Ty::Real
                || kind.values == Values::Bits
            {
                let message = format!("{variable} cannot be wired to the input '{port}'");
                faults.push(wrong(
                    message,
                    "wire variables of type BOOL and INT that can be read",
                ));
            } else {
                let ty = if kind.ty == Ty::Int {
                    term::Ty::Int
                } else {
                    term::Ty::Bool
                };
                faults.extend(self.port(port, ty, &variable.to_string()));
            }
        }
        if let Some(scan) = &interface.scan {
            faults.extend(self.port(scan, term::Ty::Bool, "the scan"));
        }
    }

    /// An input of the machine has this name and type.
    fn port(&self, name: &str, ty: term::Ty, what: &str) -> Option<Fault> {
        let ports = &self.signature.inputs;
        match ports.iter().find(|port| port.name == name) {
            Some(port) if port.ty == ty => None,
            Some(port) => Some(unplaced(
                format!(
                    "{what} is {}, and the input '{name}' is {}",
                    self.signature.name(ty),
                    self.signature.name(port.ty)
                ),
                "wire it to an input of its type".to_owned(),
            )),
            None => Some(unplaced(
                format!("{what} is wired to '{name}', and the machine has no such input"),
                known(name, ports),
            )),
        }
    }

    /// Each output of the machine is given once, and from something that a program gives.
    fn outputs(&self, interface: &Interface, faults: &mut Vec<Fault>) {
        let ports = &self.signature.outputs;
        let mut seen = HashSet::new();
        for (name, output) in &interface.outputs {
            let Some(port) = ports.iter().find(|port| port.name == *name) else {
                let message = format!("the machine has no output '{name}'");
                faults.push(unplaced(message, known(name, ports)));
                continue;
            };
            if !seen.insert(name) {
                let message = format!("the output '{name}' is given twice");
                faults.push(unplaced(message, "give each output once".to_owned()));
            }
            let (ty, what) = match output {
                Output::Constant(_) => (term::Ty::Bool, "a constant".to_owned()),
                Output::Variable { variable, inverted } => {
                    let kind = variable.kind();
                    let is_input = kind.access == Access::Read
                        || matches!(self.roles.get(variable), Some(Role::Input(_)));
                    if is_input || kind.ty == Ty::Real || kind.values == Values::Bits {
                        faults.push(unplaced(
                            format!("the output '{name}' cannot be given {variable}"),
                            "give it a variable of type BOOL or INT that the program may write, such as OUTSE[1]"
                                .to_owned(),
                        ));
                        continue;
                    }
                    let number = kind.ty == Ty::Int && !inverted;
                    (
                        if number {
                            term::Ty::Int
                        } else {
                            term::Ty::Bool
                        },
                        variable.to_string(),
                    )
                }
            };
            if port.ty != ty {
                faults.push(unplaced(
                    format!(
                        "{what} is {}, and the output '{name}' is {}",
                        self.signature.name(ty),
                        self.signature.name(port.ty)
                    ),
                    "give it something of its type".to_owned(),
                ));
            }
        }
        let missing: Vec<&str> = (ports.iter().map(|port| port.name.as_str()))
            .filter(|name| !interface.outputs.iter().any(|(given, _)| given == name))
            .collect();
        if !missing.is_empty() {
            faults.push(unplaced(
                format!("nothing gives the outputs {}", missing.join(", ")),
                "give each output of the machine a variable, TRUE or FALSE".to_owned(),
            ));
        }
    }
}

fn known(name: &str, ports: &[Port]) -> String {
    let names = || ports.iter().map(|port| port.name.as_str());
    match nearest(name, names()) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("it has {}", names().collect::<Vec<_>>().join(", ")),
    }
}

/// What is wrong with the interface has no place in the program.
fn unplaced(message: String, help: String) -> Fault {
    Fault::new(&(0..0), message, help)
}

/// Numbers of 32 bits are told apart by comparisons only: the range holds all constants, and one value beyond them on both sides.
fn numbers(constants: &[(i64, Span)], faults: &mut Vec<Fault>) -> (i64, i64) {
    let least = constants
        .iter()
        .map(|(value, _)| *value)
        .min()
        .unwrap_or(0)
        .min(0);
    let most = constants.iter().max_by_key(|(value, _)| *value);
    let (low, high) = (least - 1, most.map_or(0, |(value, _)| *value).max(0) + 1);
    let limit = i64::from(i32::MAX);
    if let Some((_, span)) = most.filter(|_| high - low > MOST) {
        faults.push(Fault::new(
            span,
            format!(
                "the numbers of the program lie in {}..{}: too many to explore",
                low + 1,
                high - 1
            ),
            format!("choose numbers that lie closer together: at most {MOST} values"),
        ));
        return (-1, 1);
    }
    (low.max(-limit), high.min(limit))
}
