//! The plant model, what is simulated of a machine: its axes with their encoders, and what its user has done to them. No family of drives is
//! known here.

mod hoist;
mod motion;

pub use hoist::{Brake, Load};
pub use motion::{Actuation, Mechanics, Plant, Setpoint};

/// How many encoders an axis may have.
pub const ENCODERS: usize = 3;

/// What is wrong with an encoder or with the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fault {
    /// Nothing.
    #[default]
    None,
    /// The position that it shows stays what it was.
    Freeze,
    /// Its telegram stands: the position, and the counter by which its reader tells its age.
    Telegram,
    /// The position that it shows is too large by that many thousandths of an increment.
    Offset(i64),
    /// It slips: so many thousandths of an increment more in each cycle. What it has slipped stays.
    Slip(i64),
    /// The drive goes on following its setpoint, whatever stop is in force, as long as it has torque.
    NoBraking,
}

/// What happens to an axis in one cycle only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Pulse {
    /// Power-on.
    pub power_on: bool,
    /// Acknowledgement.
    pub reset: bool,
    /// The user gives the agreement.
    pub give: bool,
    /// The user withdraws it.
    pub withdraw: bool,
    /// With the key switch.
    pub key: bool,
    /// The axis is referenced.
    pub reference: bool,
}

/// A guard door.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Door {
    /// It is open, whether it was released or not.
    pub open: bool,
    /// Somebody asks for it.
    pub asked: bool,
}

/// An axis. Positions are thousandths of an increment: nm, or millionths of a degree.
#[derive(Debug, Clone)]
pub struct Axis {
    /// How it moves.
    pub plant: Plant,
    /// What moves it in this cycle.
    pub drive: Actuation,
    /// What the mode selects, whatever the doors say, by its place among the words of the family.
    pub selected: Option<usize>,
    /// The pair of limit positions selected, by its place.
    pub limits: usize,
    /// The stop asked for from outside in each channel, by its place.
    pub asked: [Option<usize>; 2],
    /// What is wrong with each encoder, and the position when it began. Where the channels have the encoders, in their order.
    pub faults: [(Fault, i64); ENCODERS],
    /// What each encoder has slipped.
    slipped: [i64; ENCODERS],
    /// Its brakes, where the family has any.
    pub brakes: [Brake; 2],
    /// What hangs on its rope.
    pub load: Load,
    /// The cycle from which drive and control have run up; none before power-on.
    pub run_up_at: Option<u32>,
    /// It is referenced.
    pub referenced: bool,
    /// The reference point.
    pub reference: i64,
    /// Where it was at power-on.
    pub powered_at: i64,
    /// What happens in this cycle only.
    pub pulse: Pulse,
}

impl Axis {
    /// An axis at rest, running and referenced or not.
    pub fn new(mechanics: Mechanics, position: i64, running: bool) -> Self {
        Self {
            plant: Plant::new(mechanics, position),
            drive: Actuation::Coast,
            selected: None,
            limits: 0,
            asked: [None; 2],
            faults: [(Fault::None, 0); ENCODERS],
            slipped: [0; ENCODERS],
            brakes: [Brake::default(); 2],
            load: Load::default(),
            run_up_at: running.then_some(0),
            referenced: running,
            reference: position,
            powered_at: position,
            pulse: Pulse::default(),
        }
    }

    /// The encoders slip on.
    pub fn slip(&mut self) {
        for (slipped, (fault, _)) in self.slipped.iter_mut().zip(&self.faults) {
            if let Fault::Slip(by) = fault {
                *slipped += by;
            }
        }
    }

    /// The position that an encoder shows.
    pub fn shown(&self, encoder: usize) -> i64 {
        let measured = self.plant.position + self.slipped[encoder];
        match self.faults[encoder] {
            (Fault::Freeze | Fault::Telegram, at) => at,
            (Fault::Offset(by), _) => measured.saturating_add(by),
            (Fault::None | Fault::NoBraking | Fault::Slip(_), _) => measured,
        }
    }

    /// Whether drive and control have run up.
    pub fn run_up(&self, cycle: u32) -> bool {
        self.run_up_at.is_some_and(|at| cycle >= at)
    }

    /// The drive does what it is asked for. What is commanded ends with the first stop, or where an axis that stands may not
    /// start: the program has to be started again.
    pub fn obey(&mut self, asked: Actuation, may_not_start: bool) {
        let deaf = self
            .faults
            .iter()
            .any(|(fault, _)| *fault == Fault::NoBraking);
        self.drive = asked;
        if deaf && asked != Actuation::Coast {
            self.drive = Actuation::Follow;
        } else if asked != Actuation::Follow || (self.plant.stands() && may_not_start) {
            self.plant.setpoint = Setpoint::default();
        }
    }
}

/// Thousandths of an increment in whole increments, rounded down.
pub fn increments(thousandths: i64) -> i32 {
    let whole = thousandths.div_euclid(1_000);
    i32::try_from(whole).unwrap_or(if whole < 0 { i32::MIN } else { i32::MAX })
}
