//! Programs whose signals the values of the machine file connect, axis by axis: SAFE.SPF and statement lists with numbered ones, Structured Text
//! with names of its own.

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::Spec;
use stillpoint_lang::diag::{Diagnostic, Result};
use stillpoint_logic::st::{self, Signature};
use stillpoint_logic::{Compiled, SCAN};
use stillpoint_logic::{spf, stl};
use toml::Spanned;

use super::Wiring;
use super::family::{Explore, Family, Half, Wire};
use super::guarantee::Asked;
use super::logic::Logic;

/// A program that stands beside the machine file.
#[derive(Clone)]
pub(super) struct Wired {
    /// The machine of the tables whose place it takes.
    pub name: Spanned<String>,
    pub program: Program,
    pub file: String,
    pub source: Arc<str>,
}

/// A program in one of these languages.
#[derive(Clone)]
pub(super) enum Program {
    /// The half of the NCK.
    Spf(spf::Program),
    /// The half of the PLC.
    Stl(stl::Program),
    /// The program of an F-CPU.
    St(st::Program),
}

/// The times of programs: name, and length in microseconds.
#[derive(Default)]
pub(super) struct Times {
    /// Counted in the scans of the program.
    pub scanned: Vec<(String, u64)>,
    /// Counted in cycles of the system.
    pub running: Vec<(String, u64)>,
}

/// The ports of a machine, by type for inputs.
#[derive(Default)]
struct Ports {
    inputs: Vec<(String, bool)>,
    outputs: Vec<String>,
}

impl Ports {
    fn of(spec: &Spec, machine: &str) -> Option<Self> {
        let mut machines = spec.outline().machines.into_iter();
        let found = machines.find(|m| m.name == machine)?;
        let inputs = found.inputs.into_iter();
        Some(Self {
            inputs: inputs.map(|port| (port.name, port.ty == "BOOL")).collect(),
            outputs: found.outputs.into_iter().map(|port| port.name).collect(),
        })
    }

    /// Whether the machine is told something through this port.
    fn is_told(&self, port: &str) -> bool {
        self.inputs.iter().any(|(input, _)| input == port)
    }
}

impl Wired {
    /// Reads SAFE.SPF.
    ///
    /// # Errors
    /// Everything wrong in it, each with its place.
    pub fn spf(name: Spanned<String>, file: String, source: Arc<str>) -> Result<Self> {
        Ok(Self {
            program: Program::Spf(spf::parse(&file, &source, spf::Mode::Strict)?),
            name,
            file,
            source,
        })
    }

    /// Reads a statement list.
    ///
    /// # Errors
    /// Everything wrong in its form, each with its place.
    pub fn stl(name: Spanned<String>, file: String, source: Arc<str>) -> Result<Self> {
        Ok(Self {
            program: Program::Stl(stl::parse(&file, &source)?),
            name,
            file,
            source,
        })
    }

    /// Reads a program in Structured Text with names of its own.
    ///
    /// # Errors
    /// What is wrong in its form, with its place.
    pub fn st(name: Spanned<String>, file: String, source: Arc<str>) -> Result<Self> {
        Ok(Self {
            program: Program::St(st::Program::read(&file, &source)?),
            name,
            file,
            source,
        })
    }

    /// Whether the specification has the machine whose place it takes.
    pub fn takes_part(&self, spec: &Spec) -> bool {
        Ports::of(spec, self.name.get_ref()).is_some()
    }

    /// Whether the program is told something through this port of the machine.
    pub fn is_told(&self, spec: &Spec, port: &str) -> bool {
        Ports::of(spec, self.name.get_ref()).is_some_and(|ports| ports.is_told(port))
    }

    /// The table that it is with these signals; a loose one says less, see [`Signature::loose`].
    ///
    /// # Errors
    /// It cannot be explored.
    pub fn compiled(&self, spec: &Spec, wiring: &Wiring, loose: bool) -> Result<Compiled> {
        let mut signature = Signature::of(spec, self.name.get_ref())?;
        if loose {
            signature = signature.loose();
        }
        let ports = Ports::of(spec, self.name.get_ref()).unwrap_or_default();
        match &self.program {
            Program::Spf(program) => program.compile(&of_nck(&ports, signature, wiring)),
            Program::Stl(program) => program.compile(&self.of_plc(&ports, signature, wiring)?),
            Program::St(program) => program.compile(&of_named(&ports, signature, wiring)),
        }
    }

    /// Whether an instruction writes this signal, `DB31.DBX22.1` or `OUTSI[3]`.
    pub fn gives(&self, signal: &str) -> bool {
        match &self.program {
            Program::Stl(program) => signal.parse().is_ok_and(|bit| program.gives(bit)),
            Program::Spf(_) | Program::St(_) => {
                self.signals().get(signal).is_some_and(|(_, given)| *given)
            }
        }
    }

    /// Its signals by all their names, `INSE[3]`, `M211.0` and those that it defines: the variable, and whether the program gives it.
    pub fn signals(&self) -> BTreeMap<String, (String, bool)> {
        let mut all = BTreeMap::new();
        let mut add = |names: Vec<String>, variable: String, given: bool| {
            for name in names.into_iter().chain([variable.clone()]) {
                all.insert(name, (variable.clone(), given));
            }
        };
        match &self.program {
            Program::Spf(program) => {
                for used in program.variables() {
                    add(used.names.clone(), used.variable.to_string(), used.writes);
                }
            }
            Program::Stl(program) => {
                for used in program.bits() {
                    // `"SPL".NOT_HALT` is `SPL.NOT_HALT` in an expression.
                    let name = used.name.map(|name| name.replace('"', ""));
                    add(Vec::from_iter(name), used.bit.to_string(), used.writes);
                }
            }
            Program::St(program) => {
                for signal in program.signals() {
                    add(Vec::new(), signal.name, signal.given);
                }
            }
        }
        all
    }

    /// The signals at the ports of the machine that it stands for, where nothing but these signals is looked at: what the program
    /// gives at its outputs, what it is told at its inputs. None: there are more of them than ports.
    pub fn shown(&self, spec: &Spec, signals: &[(String, bool)]) -> Option<Wiring> {
        let mut wiring = Wiring::new();
        let ports = Ports::of(spec, self.name.get_ref())?;
        let (inputs, mut outputs) = (ports.inputs.iter(), ports.outputs.iter());
        // Signals are of type BOOL; the scan is told by another port.
        let mut inputs = inputs.filter(|(port, is_bool)| port != SCAN && *is_bool);
        for (variable, given) in signals {
            let port = match given {
                true => outputs.next()?,
                false => &inputs.next()?.0,
            };
            wiring.insert(port.clone(), variable.clone());
        }
        wiring.extend(outputs.map(|port| (port.clone(), "TRUE".to_owned())));
        Some(wiring)
    }

    fn of_plc(
        &self,
        ports: &Ports,
        signature: Signature,
        wiring: &Wiring,
    ) -> Result<stl::Interface> {
        let mut interface = stl::Interface {
            signature,
            inputs: Vec::new(),
            outputs: Vec::new(),
            scan: Some(SCAN.to_owned()),
        };
        for (port, signal) in wiring {
            let (plain, inverted) = plain(signal);
            if matches!(plain, "TRUE" | "FALSE") {
                let output = stl::Output::Constant(signal == "TRUE");
                interface.outputs.push((port.clone(), output));
                continue;
            }
            let bit = plain.parse().map_err(|why: String| {
                let fault = Diagnostic::new(&self.file, &self.source, None, why);
                fault.help("name a signal that the half of the PLC has too")
            })?;
            match ports.is_told(port) {
                true => interface.inputs.push((bit, port.clone())),
                false => {
                    let output = stl::Output::Bit { bit, inverted };
                    interface.outputs.push((port.clone(), output));
                }
            }
        }
        Ok(interface)
    }
}

/// A signal without what inverts it, and whether it is inverted.
fn plain(signal: &str) -> (&str, bool) {
    let plain = signal.strip_prefix("NOT ");
    (plain.unwrap_or(signal), plain.is_some())
}

/// How a program with names of its own is connected to the ports of the machine that it stands for.
fn of_named(ports: &Ports, signature: Signature, wiring: &Wiring) -> st::Interface {
    let (told, given): (Vec<_>, Vec<_>) = wiring.iter().partition(|(port, _)| ports.is_told(port));
    let told = told.into_iter();
    let given = given.into_iter().map(|(port, signal)| {
        let (plain, inverted) = plain(signal);
        let output = match plain {
            "TRUE" | "FALSE" => st::Output::Constant(plain == "TRUE"),
            _ => st::Output::Variable {
                variable: plain.to_owned(),
                inverted,
            },
        };
        (port.clone(), output)
    });
    st::Interface {
        signature,
        inputs: told
            .map(|(port, signal)| (signal.clone(), port.clone()))
            .collect(),
        outputs: given.collect(),
    }
}

/// How SAFE.SPF is connected to the ports of the machine that it stands for.
fn of_nck(ports: &Ports, signature: Signature, wiring: &Wiring) -> spf::Interface {
    let mut interface = spf::Interface {
        signature,
        inputs: Vec::new(),
        outputs: Vec::new(),
        scan: Some(SCAN.to_owned()),
        readings: spf::Readings::default(),
    };
    for (port, signal) in wiring {
        let (plain, inverted) = plain(signal);
        match plain.parse().ok() {
            Some(variable) if ports.is_told(port) => {
                interface.inputs.push((variable, port.clone()));
            }
            Some(variable) => {
                let output = spf::Output::Variable { variable, inverted };
                interface.outputs.push((port.clone(), output));
            }
            None => {
                let output = spf::Output::Constant(signal == "TRUE");
                interface.outputs.push((port.clone(), output));
            }
        }
    }
    interface
}

/// The signals of the program by the ports of what it replaces, from the values of the machine file.
///
/// # Errors
/// A port through which the program is told something is connected to nothing, or the half of the PLC gives an axis nothing.
pub(super) fn wiring(
    family: &Family,
    explore: &Explore,
    asked: &Asked<'_>,
    logic: &Logic,
    spec: &Spec,
    half: Option<&Half>,
) -> Result<Wiring> {
    let mut wiring = Wiring::new();
    for wire in &explore.wires {
        let (port, name) = (&wire.port, &wire.name);
        let cells = asked.values.get(name).map_or(&[][..], Vec::as_slice);
        let code = cells.get(wire.index).copied().unwrap_or(0);
        if code == 0 && wire.optional {
            continue;
        }
        let told = logic.is_told(spec, port);
        if code == 0 && told {
            let guarantee = asked.guarantee;
            let message = format!(
                "guarantee {}: the program is not told of it: {name} names no signal",
                guarantee.name
            );
            let place = Some(guarantee.place.clone());
            let example = logic.example();
            let help = match &guarantee.door {
                Some(door) if family.door.contains_key(name) => {
                    format!("write {name} = \"{example}\" or the like under [door.{door}]")
                }
                _ => format!(
                    "write {name} = \"{example}\" or the like under [guarantee.{}]",
                    guarantee.name
                ),
            };
            let found = logic.fault(place, message).label("this guarantee");
            return Err(found.help(help).into());
        }
        let mut signal = family.known.signals.show(code);
        if let Some(half) = half.filter(|_| !told) {
            signal = given(half, wire, asked, logic, signal)?;
        }
        wiring.insert(port.clone(), signal);
    }
    Ok(wiring)
}

/// The signal of the half in the PLC for one that the half in the NCK has by a parameter: the bit of the axis, where the program gives
/// it, else the image of the same signal; what is fixed there is fixed here.
///
/// # Errors
/// The program gives neither: what it holds could not be told from what it leaves alone.
fn given(
    half: &Half,
    wire: &Wire,
    asked: &Asked<'_>,
    logic: &Logic,
    signal: String,
) -> Result<String> {
    let Wire { name, index, .. } = wire;
    let mut keys = [name.clone(), format!("{name}[{index}]")].into_iter();
    let bit = keys.find_map(|key| half.bits.get(&key));
    let number = asked
        .values
        .get(&half.number)
        .and_then(|cells| cells.first());
    let number = number.copied().filter(|n| *n > 0).unwrap_or(asked.number);
    let bit = bit.map(|bit| format!("DB{}.{bit}", half.block + number));
    let (image, _) = plain(&signal);
    let known = |signal: &str| matches!(signal, "TRUE" | "FALSE") || logic.gives(signal);
    match bit {
        Some(bit) if logic.gives(&bit) => Ok(bit),
        _ if known(image) => Ok(signal),
        bit => {
            let guarantee = asked.guarantee;
            let ways: Vec<&str> = bit.iter().map(String::as_str).chain([image]).collect();
            let message = format!(
                "guarantee {}: the half of the safe logic in the PLC gives axis {} nothing for {name}: no instruction writes {}",
                guarantee.name,
                asked.axis,
                ways.join(" or ")
            );
            let place = Some(guarantee.place.clone());
            let found = logic
                .fault(place, message)
                .label("holds after a fault that takes the other half");
            let help = format!(
                "let the program write {}, or leave `after` out of the guarantee",
                ways[0]
            );
            Err(found.help(help).into())
        }
    }
}
