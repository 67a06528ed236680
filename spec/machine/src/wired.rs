//! Programs with numbered signals, SAFE.SPF: what they are connected to follows from the values of the machine file, axis by axis.

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::diag::Result;
use stillpoint_logic::Compiled;
use stillpoint_logic::spf::{self, Interface, Mode, Output, Program, Readings};
use stillpoint_logic::st::Signature;
use toml::Spanned;

use super::Wiring;
use super::family::{Explore, Family};
use super::guarantee::Asked;
use super::logic::Logic;

/// The port of the tables that tells a program when it is scanned.
const SCAN: &str = "scan";

/// A program that stands beside the machine file.
#[derive(Clone)]
pub(super) struct Wired {
    /// The machine of the tables whose place it takes.
    pub name: Spanned<String>,
    pub program: Program,
    pub file: String,
    pub source: Arc<str>,
    /// The interface of that machine, and its inputs by name.
    signature: Signature,
    inputs: Vec<String>,
    outputs: Vec<String>,
    /// The inputs of type BOOL.
    bools: Vec<String>,
}

impl Wired {
    /// Reads a program that takes the place of a machine of `spec`.
    ///
    /// # Errors
    /// Everything wrong in it, each with its place.
    pub fn read(
        name: Spanned<String>,
        file: String,
        source: Arc<str>,
        spec: &Spec,
    ) -> Result<Self> {
        let mut machines = spec.outline().machines.into_iter();
        let machine = machines.find(|m| m.name == *name.get_ref());
        let (inputs, outputs) = machine.map_or_else(Default::default, |m| (m.inputs, m.outputs));
        let bools = inputs.iter().filter(|port| port.ty == "BOOL");
        Ok(Self {
            program: spf::parse(&file, &source, Mode::Strict)?,
            signature: Signature::of(spec, name.get_ref())?,
            bools: bools.map(|port| port.name.clone()).collect(),
            inputs: inputs.into_iter().map(|port| port.name).collect(),
            outputs: outputs.into_iter().map(|port| port.name).collect(),
            name,
            file,
            source,
        })
    }

    /// Whether the program is told something through this port.
    pub fn is_told(&self, port: &str) -> bool {
        self.inputs.iter().any(|input| input == port)
    }

    /// The table that it is with these signals.
    ///
    /// # Errors
    /// It cannot be explored.
    pub fn compiled(&self, wiring: &Wiring) -> Result<Compiled> {
        self.program.compile(&self.interface(wiring))
    }

    /// Its signals by all their names, `INSE[3]` and those that it defines: the variable, and whether the program gives it.
    pub fn signals(&self) -> BTreeMap<String, (String, bool)> {
        let mut all = BTreeMap::new();
        for used in self.program.variables() {
            let variable = used.variable.to_string();
            for name in used.names.iter().chain([&variable]) {
                all.insert(name.clone(), (variable.clone(), used.writes));
            }
        }
        all
    }

    fn is_bool(&self, input: &str) -> bool {
        self.bools.iter().any(|port| port == input)
    }

    /// The signals at the ports of the machine that it stands for, where nothing but these signals is looked at: what the program
    /// gives at its outputs, what it is told at its inputs. None: there are more of them than ports.
    pub fn shown(&self, signals: &[(String, bool)]) -> Option<Wiring> {
        let mut wiring = Wiring::new();
        let (inputs, mut outputs) = (self.inputs.iter(), self.outputs.iter());
        // Signals are of type BOOL; the scan is told by another port.
        let mut inputs = inputs.filter(|port| *port != SCAN && self.is_bool(port));
        for (variable, given) in signals {
            let port = match given {
                true => outputs.next()?,
                false => inputs.next()?,
            };
            wiring.insert(port.clone(), variable.clone());
        }
        wiring.extend(outputs.map(|port| (port.clone(), "TRUE".to_owned())));
        Some(wiring)
    }

    fn interface(&self, wiring: &Wiring) -> Interface {
        let mut interface = Interface {
            signature: self.signature.clone(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            scan: Some(SCAN.to_owned()),
            readings: Readings::default(),
        };
        for (port, signal) in wiring {
            let plain = signal.strip_prefix("NOT ").unwrap_or(signal);
            let variable = plain.parse().ok();
            match variable {
                Some(variable) if self.is_told(port) => {
                    interface.inputs.push((variable, port.clone()));
                }
                Some(variable) => {
                    let inverted = plain != signal;
                    let output = Output::Variable { variable, inverted };
                    interface.outputs.push((port.clone(), output));
                }
                None => {
                    let output = Output::Constant(signal == "TRUE");
                    interface.outputs.push((port.clone(), output));
                }
            }
        }
        interface
    }
}

/// The signals of the program by the ports of what it replaces, from the values of the machine file.
///
/// # Errors
/// A port through which the program is told something is connected to nothing.
pub(super) fn wiring(
    family: &Family,
    explore: &Explore,
    asked: &Asked<'_>,
    logic: &Logic,
) -> Result<Wiring> {
    let mut wiring = Wiring::new();
    for wire in &explore.wires {
        let (port, name) = (&wire.port, &wire.name);
        let cells = asked.values.get(name).map_or(&[][..], Vec::as_slice);
        let code = cells.get(wire.index).copied().unwrap_or(0);
        if code == 0 && wire.optional {
            continue;
        }
        if code == 0 && logic.is_told(port) {
            let guarantee = asked.guarantee;
            let message = format!(
                "guarantee {}: the program is not told of it: {name} names no signal",
                guarantee.name
            );
            let place = Some(guarantee.place.clone());
            let help = match &guarantee.door {
                Some(door) => format!("write {name} = \"INSE[1]\" or the like under [door.{door}]"),
                None => format!(
                    "write {name} = \"INSE[1]\" or the like under [guarantee.{}]",
                    guarantee.name
                ),
            };
            let found = logic.fault(place, message).label("this guarantee");
            return Err(found.help(help).into());
        }
        wiring.insert(port.clone(), family.known.signals.show(code));
    }
    Ok(wiring)
}
