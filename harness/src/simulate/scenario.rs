//! What a scenario asks for, resolved: cycles instead of times, increments instead of lengths, axes by their place.

use crate::plant::{ENCODERS, Fault, Load, Mechanics, Setpoint};
use crate::recording::Value;

/// A scenario for one machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scenario {
    /// What it shows.
    pub title: String,
    /// Cycles to run.
    pub cycles: u32,
    /// Running and safely referenced from the start, or not yet run up.
    pub running: bool,
    /// As in the acceptance test mode: the limit of the speed setpoint is off.
    pub acceptance_mode: bool,
    /// The axes, in the order of the machine.
    pub axes: Vec<Start>,
    /// What happens, by cycle; in one cycle in the order of the file's kinds.
    pub events: Vec<Event>,
    /// What has to come of it.
    pub expects: Vec<Expect>,
    /// Times that are no whole number of cycles, and what became of them.
    pub roundings: Vec<String>,
}

/// An axis at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Start {
    /// Where it is, in thousandths of an increment.
    pub position: i64,
    /// How it moves.
    pub mechanics: Mechanics,
}

/// Something that happens.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Event {
    /// When.
    pub cycle: u32,
    /// To which axes, by their place in the machine, or to which other owners of signals; none for what happens to a door.
    pub axes: Vec<usize>,
    /// In which channels.
    pub sides: [bool; 2],
    /// What.
    pub what: What,
}

/// What happens.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum What {
    /// A new setpoint: thousandths of an increment per cycle, and perhaps a target.
    Motion(Setpoint),
    /// The mode selects something else, by the place among the words of the family; none: nothing.
    Select(Option<usize>),
    /// Another pair of limit positions, by its place.
    Limits(usize),
    /// A door, by its place in the machine.
    Door {
        /// Which.
        door: usize,
        /// What of it.
        change: DoorChange,
    },
    /// An input keeps a value whatever else happens: the signal by its place among those of its owner.
    Force {
        /// Which input.
        input: usize,
        /// Its value; none: it is released again.
        value: Option<Value>,
    },
    /// A stop asked for by the safety logic, by its place; none: it is withdrawn.
    Stop(Option<usize>),
    /// Acknowledgement.
    Reset,
    /// Off and on again; run up so many cycles later.
    Power(u32),
    /// The user gives or withdraws the agreement.
    Agreement {
        /// Gives it.
        give: bool,
        /// With the key switch in position 3.
        key: bool,
    },
    /// Somebody moves the axis by hand, by so many thousandths of an increment, at once.
    Moved(i64),
    /// The axis is referenced where it is.
    Reference,
    /// An encoder or drive fault begins, or ends with [`Fault::None`].
    Fault {
        /// Which.
        fault: Fault,
        /// Of which encoders, by their places.
        encoders: [bool; ENCODERS],
    },
    /// A brake becomes weak, or sticks; or it is in order again.
    Brake {
        /// Which, by its place.
        brake: usize,
        /// Its torque in percent.
        torque: u32,
        /// It stays what it is.
        stuck: bool,
    },
    /// Another load on the rope.
    Load(Load),
}

/// What happens to a door.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DoorChange {
    /// Somebody asks for it, or no longer.
    Asked(bool),
    /// It is opened or closed.
    Open(bool),
}

/// What has to come of a scenario.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Expect {
    /// As the file puts it.
    pub text: String,
    /// What has to be the case in a cycle.
    pub condition: Condition,
    /// The first cycle that counts.
    pub after: u32,
    /// The last cycle that counts.
    pub by: u32,
    /// In none of the cycles, instead of in one of them.
    pub never: bool,
}

/// What can be the case in a cycle: of each signal, or of any where it must never be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Condition {
    /// The signals, by full name.
    pub names: Vec<String>,
    /// What they are.
    pub is: Is,
}

/// What a signal can be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Is {
    /// It has this value.
    Value(Value),
    /// It is a speed, and the axis stands or moves.
    Standing(bool),
    /// It is a list of alarms, with this one among them.
    Listing(String),
}

impl Is {
    /// Whether a value is this.
    pub fn fits(&self, value: &Value) -> bool {
        match (self, value) {
            (Self::Value(wanted), value) => wanted == value,
            (Self::Standing(stands), value) => (*value == Value::Int(0)) == *stands,
            (Self::Listing(alarm), Value::Text(all)) => all.split(' ').any(|a| a == alarm),
            (Self::Listing(_), _) => false,
        }
    }
}
