//! Which bit is what in the table: an input of the machine, a further input, a variable, or always 0.

use std::collections::{BTreeMap, HashSet};

use stillpoint_lang::diag::nearest;

use super::super::interface::{Interface, Output, Places, Uses};
use super::super::operand::{Area, Cell};
use super::super::{Bit, Program};
use crate::fault::{Fault, Span};
use crate::st::Signature;
use crate::st::signature::Port;
use crate::st::term;

/// What a bit or byte is in the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Role {
    /// An input, of the machine or a further one: its name.
    Input(String),
    /// Written by the program: the name of the variable in the tree.
    State(String),
    /// Nobody writes it.
    Zero,
}

/// The bits and bytes of a program in its table.
pub(super) struct Wiring {
    pub bits: BTreeMap<Bit, Role>,
    pub cells: BTreeMap<Cell, Role>,
    /// The machine's interface with the further inputs.
    pub signature: Signature,
    /// Names that are taken, in upper case.
    taken: HashSet<String>,
}

impl Wiring {
    /// Looks at the interface and at what the program names; what is wrong is told.
    pub fn new(
        program: &Program,
        interface: &Interface,
        uses: &Uses,
        faults: &mut Vec<Fault>,
    ) -> Self {
        let signature = interface.signature.clone();
        let names = signature.names().into_iter();
        let mut wiring = Self {
            bits: BTreeMap::new(),
            cells: BTreeMap::new(),
            taken: names.map(|name| name.to_ascii_uppercase()).collect(),
            signature,
        };
        faults.extend(overlaps(uses));
        let wired = wiring.inputs(program, interface, uses, faults);
        let taken_out = |bit: &Bit| {
            let mut outputs = interface.outputs.iter();
            outputs.any(|(_, o)| matches!(o, Output::Bit { bit: of, .. } if of == bit))
        };
        // What is written through a byte with a constant is written bit by bit.
        let through = |bit: &Bit| {
            let mut cells = uses.cells.iter();
            cells.any(|(cell, places)| places.written.is_some() && bit.lies_in(*cell))
        };
        for (bit, places) in &uses.bits {
            let role = match (places.written.is_some() || through(bit), wired.get(bit)) {
                (true, _) => Role::State(wiring.fresh(&bit.identifier())),
                (false, Some(port)) => Role::Input(port.clone()),
                (false, None) if taken_out(bit) => Role::Zero,
                (false, None) => Role::Input(wiring.added(
                    &bit.identifier(),
                    term::Ty::Bool,
                    (0, 1),
                    program.title(*bit),
                )),
            };
            wiring.bits.insert(*bit, role);
        }
        for (cell, places) in &uses.cells {
            if bits_of(uses, *cell).next().is_some() {
                continue;
            }
            let role = match places.written {
                Some(_) => Role::State(wiring.fresh(&cell.identifier())),
                None => {
                    if cell.width > 1 {
                        faults.push(Fault::new(
                            &places.first(),
                            format!(
                                "{cell} has 65,536 values, and nothing in the program gives it one"
                            ),
                            "use the bits or the byte that is meant",
                        ));
                    }
                    let range = (0, cell.most().min(255));
                    let name = cell.identifier();
                    Role::Input(wiring.added(&name, term::Ty::Int, range, cell.to_string()))
                }
            };
            wiring.cells.insert(*cell, role);
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

    /// A further input of the table.
    pub fn added(
        &mut self,
        base: &str,
        ty: term::Ty,
        (low, high): (i64, i64),
        title: String,
    ) -> String {
        let name = self.fresh(base);
        self.signature.inputs.push(Port {
            name: name.clone(),
            ty,
            low,
            high,
            added: Some(title),
            called: None,
        });
        name
    }

    /// The bits that are inputs of the machine, each with the name of the input.
    fn inputs(
        &self,
        program: &Program,
        interface: &Interface,
        uses: &Uses,
        faults: &mut Vec<Fault>,
    ) -> BTreeMap<Bit, String> {
        let mut wired: BTreeMap<Bit, String> = BTreeMap::new();
        for (bit, port) in &interface.inputs {
            let places = uses.bits.get(bit).cloned().unwrap_or_default();
            let from = match places.written {
                None => Some(*bit),
                Some(_) => program.terminal(*bit),
            };
            let Some(from) = from else {
                faults.push(Fault::new(
                    &places.written.unwrap_or(0..0),
                    format!("{bit} is the input '{port}', and the program gives it another value than that of one input"),
                    "copy one input to it, in one place: `U E 76.0` (A I 76.0), `= INSEP[1]`",
                ));
                continue;
            };
            if wired
                .insert(from, port.clone())
                .is_some_and(|before| before != *port)
            {
                let message = format!("{from} is wired to two inputs");
                faults.push(unplaced(message, "wire each bit once".to_owned()));
            }
            faults.extend(self.port(port, &bit.to_string()));
        }
        if let Some(scan) = &interface.scan {
            faults.extend(self.port(scan, "the scan"));
        }
        wired
    }

    /// An input of the machine has this name, and is BOOL.
    fn port(&self, name: &str, what: &str) -> Option<Fault> {
        let ports = &self.signature.inputs;
        match ports.iter().find(|port| port.name == name) {
            Some(port) if port.ty == term::Ty::Bool => None,
            Some(port) => Some(unplaced(
                format!(
                    "{what} is BOOL, and the input '{name}' is {}",
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
            if port.ty != term::Ty::Bool {
                let message = format!(
                    "a bit is BOOL, and the output '{name}' is {}",
                    self.signature.name(port.ty)
                );
                faults.push(unplaced(
                    message,
                    "give it something of its type".to_owned(),
                ));
            }
            if let Output::Bit { bit, .. } = output {
                let is_input = matches!(self.bits.get(bit), Some(Role::Input(_)));
                if is_input || bit.area == Area::Input {
                    faults.push(unplaced(
                        format!("the output '{name}' cannot be given {bit}"),
                        "give it a bit that the program writes, such as OUTSEP[1]".to_owned(),
                    ));
                }
            }
        }
        let missing: Vec<&str> = (ports.iter().map(|port| port.name.as_str()))
            .filter(|name| !interface.outputs.iter().any(|(given, _)| given == name))
            .collect();
        if !missing.is_empty() {
            faults.push(unplaced(
                format!("nothing gives the outputs {}", missing.join(", ")),
                "give each output of the machine a bit, TRUE or FALSE".to_owned(),
            ));
        }
    }
}

/// The bits of these bytes that the program names.
pub(super) fn bits_of(uses: &Uses, cell: Cell) -> impl Iterator<Item = Bit> {
    let bits = uses.bits.keys().copied();
    bits.filter(move |bit| bit.lies_in(cell))
}

/// Bytes that are read where their bits are used too, and bytes that overlap: who writes which bit would not be told.
fn overlaps(uses: &Uses) -> Vec<Fault> {
    let mut faults = Vec::new();
    let cells: Vec<(&Cell, &Places)> = uses.cells.iter().collect();
    for (k, (cell, places)) in cells.iter().enumerate() {
        let read: Option<&Span> = places.read.as_ref();
        if let (Some(span), Some(bit)) = (read, bits_of(uses, **cell).next()) {
            faults.push(Fault::new(
                span,
                format!("{cell} is loaded as a number, and {bit} in it is used as a bit"),
                "use the bits, or another byte for the number",
            ));
        }
        for (other, _) in cells.iter().skip(k + 1) {
            if cell.overlaps(**other)
                && (bits_of(uses, **cell).next().is_none()
                    || bits_of(uses, **other).next().is_none())
            {
                faults.push(Fault::new(
                    &places.first(),
                    format!("{cell} and {other} share bytes"),
                    "use one of them, or other addresses",
                ));
            }
        }
    }
    faults
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
