//! The checks of the F master at run-up: machine data against themselves, and against what the PLC has of the F modules.
//!
//! An error is told under its alarm ([`Refusal::alarm`]); with one, no F communication starts before power-on
//! (input `refused` of [`f_master`](super::f_master)). Every error is told, as the control does: one mistake can raise several alarms.
//!
//! Readings: AMB-18 SUBSLOT_IN0_OUT01 (of an input module only sub-slot 0 can be used), AMB-19 FILTER_FF_IDENTITY and ASSIGN_MAX_8,
//! AMB-20 (the highest address of the master is FA7DH).

use super::assignment::Byte;
use super::f_master::LONGEST_PROFISAFE_CYCLE_US;
use super::net_data::{Connection, NO_FILTER, Row, Unfit};

/// The connections of each direction (S840D-PSPARAM-002).
pub const CONNECTIONS: usize = 16;

/// The bus segment of the DP connection on the side of the PLC, the only one (S840D-PSAFE-026).
pub const SEGMENT: u8 = 5;

/// The most net data bits of a module (S840D-PSAFE-009).
pub const MOST_BITS: u8 = 64;

/// The highest address of the F master (S840D-PSPARAM-001, AMB-20).
pub const HIGHEST_MASTER: u16 = 0xFA7D;

/// An address of a machine datum: hexadecimal 0s 0x aaaa (S840D-PSPARAM-001, S840D-PSPARAM-002).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address {
    /// The bus segment s.
    pub segment: u8,
    /// The sub-slot x.
    pub sub_slot: u8,
    /// The PROFIsafe address aaaa, 1 to FFFFH (S840D-PSAFE-009).
    pub station: u16,
}

impl Address {
    /// The fields of a machine datum.
    pub const fn decode(datum: u32) -> Self {
        Self {
            segment: (datum >> 24) as u8,
            sub_slot: (datum >> 16) as u8,
            station: datum as u16,
        }
    }

    /// The machine datum of the fields.
    pub const fn encode(self) -> u32 {
        (self.segment as u32) << 24 | (self.sub_slot as u32) << 16 | self.station as u32
    }
}

/// One index of the machine data of a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// MD10386 or MD10387.
    pub address: u32,
    /// MD13300 or MD13301.
    pub filter: u32,
    /// MD10388 or MD10389.
    pub assign: u32,
}

impl Slot {
    /// The default: not used.
    pub const UNUSED: Self = Self {
        address: 0,
        filter: NO_FILTER,
        assign: 0,
    };

    /// Whether anything is parameterised.
    const fn is_used(&self) -> bool {
        self.address != 0 || self.assign != 0
    }

    /// Filter and row.
    ///
    /// # Errors
    /// They do not fit.
    pub const fn connection(&self) -> Result<Connection, Unfit> {
        Connection::new(self.filter, self.assign)
    }

    /// 27206, 27207: what it uses is there in the module (S840D-PSAFE-031, S840D-PSAFE-032).
    fn within(&self, module: &Module, sub_slot: u8, datum: Datum, tell: &mut impl FnMut(Refusal)) {
        let first = 32 * u32::from(sub_slot);
        let bits = u32::from(module.bits);
        if first >= bits {
            tell(Refusal::SubSlot(datum));
        } else if let Ok(connection) = self.connection() {
            if first + u32::from(connection.highest()) >= bits {
                tell(Refusal::Bit(datum));
            }
        }
    }
}

/// The direction of a module, as the tables that hold its address say (S840D-PSAFE-044).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Only MD10386 has it.
    Input,
    /// Only MD10387 has it.
    Output,
    /// Both have it.
    Both,
}

/// What the configuration of the PLC says of an F module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Module {
    /// F_source_address: the F master that it belongs to.
    pub master: u16,
    /// F_target_address.
    pub address: u16,
    /// Its direction.
    pub direction: Direction,
    /// Its net data bits, at most 64 (S840D-PSAFE-009).
    pub bits: u8,
    /// Its F monitoring time in us: so long it waits for a new valid telegram (S840D-PSAFE-042).
    pub monitoring_us: u32,
    /// The parameter telegram of its slave can be interpreted (S840D-PSAFE-038).
    pub parameters_readable: bool,
    /// The CRC over its F parameters is right (S840D-PSAFE-041).
    pub crc_right: bool,
    /// The lengths of the telegram's CRC and of the telegram are those of the module (S840D-PSAFE-041).
    pub lengths_right: bool,
}

/// What the NCK sees of the DP master at run-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The DP master has a configuration in time (S840D-PSAFE-039).
    pub running: bool,
    /// The version of the interface in the NCK.
    pub nck_version: u16,
    /// The version of the interface in the PLC.
    pub plc_version: u16,
}

/// Which machine datum is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Datum {
    /// MD10385.
    Master,
    /// MD10386, MD13300 and MD10388 of this index.
    Input(u8),
    /// MD10387, MD13301 and MD10389 of this index.
    Output(u8),
}

/// Why the F communication does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// 27200: the PROFIsafe cycle is longer than 25 ms (S840D-PSAFE-025).
    CycleTooLong,
    /// 27201: the bus segment is not 5 (S840D-PSAFE-026).
    Segment(Datum),
    /// 27202: the PROFIsafe address is 0 (S840D-PSAFE-027).
    Address(Datum),
    /// 27203: the row of variables is wrong (S840D-PSAFE-028).
    Assignment(Datum),
    /// 27204: a variable has two places (S840D-PSAFE-010, S840D-PSAFE-029).
    Double(Datum),
    /// 27205: filter and row have different numbers (S840D-PSAFE-030).
    Number(Datum),
    /// 27206: a bit outside the net data of the module (S840D-PSAFE-031).
    Bit(Datum),
    /// 27207: the module has no such sub-slot, or it cannot be used (S840D-PSAFE-032).
    SubSlot(Datum),
    /// 27220: the machine data have another number of modules than belong to the master in the PLC (S840D-PSAFE-033).
    Count {
        /// In the machine data.
        nck: u8,
        /// In the PLC.
        plc: u8,
    },
    /// 27221: the PLC has no module with the address (S840D-PSAFE-034).
    UnknownToPlc(Datum),
    /// 27222: the machine data have no module with this address (S840D-PSAFE-035).
    UnknownToNck(u16),
    /// 27223: the module has another direction (S840D-PSAFE-036).
    OtherDirection(u16),
    /// 27224: two modules have this address (S840D-PSAFE-037).
    SharedAddress(u16),
    /// 27225: the parameter telegram of the slave cannot be interpreted (S840D-PSAFE-038).
    Slave(u16),
    /// 27240: the DP master has not run up in time (S840D-PSAFE-039).
    MasterNotRunning,
    /// 27241: the versions of the interface differ (S840D-PSAFE-040).
    Version,
    /// 27242: an F parameter of the module is wrong, or its monitoring time shorter than the PROFIsafe cycle (S840D-PSAFE-041,
    /// S840D-PSAFE-042).
    Parameter(u16),
}

impl Refusal {
    /// The number of the alarm.
    pub const fn alarm(self) -> u32 {
        match self {
            Self::CycleTooLong => 27200,
            Self::Segment(_) => 27201,
            Self::Address(_) => 27202,
            Self::Assignment(_) => 27203,
            Self::Double(_) => 27204,
            Self::Number(_) => 27205,
            Self::Bit(_) => 27206,
            Self::SubSlot(_) => 27207,
            Self::Count { .. } => 27220,
            Self::UnknownToPlc(_) => 27221,
            Self::UnknownToNck(_) => 27222,
            Self::OtherDirection(_) => 27223,
            Self::SharedAddress(_) => 27224,
            Self::Slave(_) => 27225,
            Self::MasterNotRunning => 27240,
            Self::Version => 27241,
            Self::Parameter(_) => 27242,
        }
    }
}

impl core::fmt::Display for Refusal {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "alarm {}: {self:?}", self.alarm())
    }
}

impl core::error::Error for Refusal {}

/// The machine data of the F master.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    /// The interpolator cycle in us.
    pub interpolator_us: u32,
    /// MD10098.
    pub ratio: u8,
    /// MD10385.
    pub master: u32,
    /// The connections of inputs.
    pub inputs: [Slot; CONNECTIONS],
    /// The connections of outputs.
    pub outputs: [Slot; CONNECTIONS],
    /// MD10390: the bytes of inputs outside of PROFIsafe.
    pub input_bytes: [u32; 8],
    /// MD10392: the bytes of outputs outside of PROFIsafe.
    pub output_bytes: [u32; 8],
}

/// All variables of MD10390 or MD10392; an entry that is no coding has none, and is refused elsewhere.
fn bytes_variables(bytes: &[u32; 8]) -> u64 {
    let each = bytes.iter().zip(0..);
    each.fold(0, |all, (datum, index)| {
        all | Byte::decode(*datum).map_or(0, |byte| byte.variables(index))
    })
}

impl Setup {
    /// The defaults: no F module.
    pub const EMPTY: Self = Self {
        interpolator_us: 16_000,
        ratio: 1,
        master: 0,
        inputs: [Slot::UNUSED; CONNECTIONS],
        outputs: [Slot::UNUSED; CONNECTIONS],
        input_bytes: [0; 8],
        output_bytes: [0; 8],
    };

    /// The PROFIsafe cycle in us (S840D-PSAFE-011, S840D-PSAFE-713).
    pub const fn cycle_us(&self) -> u64 {
        self.interpolator_us as u64 * self.ratio as u64
    }

    /// The connections with what they are called.
    fn slots(&self) -> impl Iterator<Item = (Datum, &Slot)> {
        let inputs = (0..).map(Datum::Input).zip(&self.inputs);
        let outputs = (0..).map(Datum::Output).zip(&self.outputs);
        inputs.chain(outputs).filter(|(_, slot)| slot.is_used())
    }

    /// Tells what is wrong in the machine data by themselves: alarms 27200 to 27205 and 27207 (S840D-PSAFE-025 to S840D-PSAFE-030,
    /// S840D-PSAFE-032). Without an F module there is nothing to check.
    pub fn check(&self, tell: &mut impl FnMut(Refusal)) {
        if self.slots().next().is_none() && self.master == 0 {
            return;
        }
        if self.cycle_us() > LONGEST_PROFISAFE_CYCLE_US as u64 {
            tell(Refusal::CycleTooLong);
        }
        let master = core::iter::once((Datum::Master, self.master));
        let slots = self.slots().map(|(datum, slot)| (datum, slot.address));
        for (datum, address) in master.chain(slots) {
            let Address {
                segment,
                sub_slot,
                station,
            } = Address::decode(address);
            // A datum that is missing altogether has no address.
            if segment != SEGMENT && address != 0 {
                tell(Refusal::Segment(datum));
            }
            if station == 0 || (datum == Datum::Master && station > HIGHEST_MASTER) {
                tell(Refusal::Address(datum));
            }
            if sub_slot > u8::from(matches!(datum, Datum::Output(_))) {
                tell(Refusal::SubSlot(datum));
            }
        }
        for (datum, slot) in self.slots() {
            match slot.connection() {
                Ok(_) => {}
                Err(Unfit::Row) => tell(Refusal::Assignment(datum)),
                Err(Unfit::Number) => tell(Refusal::Number(datum)),
            }
        }
        self.shared(tell);
    }

    /// 27204: no variable has two places, in PROFIsafe or beside it (S840D-PSAFE-010, S840D-PSAFE-029).
    fn shared(&self, tell: &mut impl FnMut(Refusal)) {
        let mut inputs = bytes_variables(&self.input_bytes);
        let mut outputs = bytes_variables(&self.output_bytes);
        for (datum, slot) in self.slots() {
            let all = match datum {
                Datum::Output(_) => &mut outputs,
                _ => &mut inputs,
            };
            let own = Row::new(slot.assign).map_or(0, Row::variables);
            if *all & own != 0 {
                tell(Refusal::Double(datum));
            }
            *all |= own;
        }
    }

    /// The direction of the module with this address (S840D-PSAFE-044): none where no table has it.
    pub fn direction(&self, address: u16) -> Option<Direction> {
        let has = |slots: &[Slot]| {
            let mut used = slots.iter().filter(|slot| slot.is_used());
            used.any(|slot| Address::decode(slot.address).station == address)
        };
        match (has(&self.inputs), has(&self.outputs)) {
            (true, true) => Some(Direction::Both),
            (true, false) => Some(Direction::Input),
            (false, true) => Some(Direction::Output),
            (false, false) => None,
        }
    }

    /// How many modules the tables have, each address once (S840D-PSAFE-033).
    fn modules(&self) -> u8 {
        let mut count = 0;
        for (place, (_, slot)) in self.slots().enumerate() {
            let station = Address::decode(slot.address).station;
            let mut before = self.slots().take(place);
            let known = before.any(|(_, other)| Address::decode(other.address).station == station);
            count += u8::from(!known);
        }
        count
    }

    /// Tells how the machine data and the configuration of the PLC differ: alarms 27206, 27207 and 27220 to 27242 (S840D-PSAFE-031 to
    /// S840D-PSAFE-042). Modules of another F master are left out: communication is attempted only with those that have this
    /// one's address (S840D-PSPARAM-001).
    pub fn compare(&self, link: &Link, modules: &[Module], tell: &mut impl FnMut(Refusal)) {
        if self.slots().next().is_none() {
            return;
        }
        if !link.running {
            return tell(Refusal::MasterNotRunning);
        }
        if link.nck_version != link.plc_version {
            return tell(Refusal::Version);
        }
        let master = Address::decode(self.master).station;
        let own = || modules.iter().filter(move |module| module.master == master);
        for (datum, slot) in self.slots() {
            let Address {
                sub_slot, station, ..
            } = Address::decode(slot.address);
            match own().find(|module| module.address == station) {
                None => tell(Refusal::UnknownToPlc(datum)),
                Some(module) => slot.within(module, sub_slot, datum, tell),
            }
        }
        let nck = self.modules();
        let plc = own().fold(0_u8, |count, _| count.saturating_add(1));
        if nck != plc {
            tell(Refusal::Count { nck, plc });
        }
        for (place, module) in own().enumerate() {
            let address = module.address;
            match self.direction(address) {
                None => tell(Refusal::UnknownToNck(address)),
                Some(direction) if direction != module.direction => {
                    tell(Refusal::OtherDirection(address));
                }
                Some(_) => {}
            }
            if own().take(place).any(|other| other.address == address) {
                tell(Refusal::SharedAddress(address));
            }
            if !module.parameters_readable {
                tell(Refusal::Slave(address));
            }
            let short = u64::from(module.monitoring_us) < self.cycle_us();
            if short || !module.crc_right || !module.lengths_right || module.bits > MOST_BITS {
                tell(Refusal::Parameter(address));
            }
        }
    }

    /// Whether nothing is wrong: the F communication may start (S840D-PSAFE-025, S840D-PSAFE-033).
    pub fn is_accepted(&self, link: &Link, modules: &[Module]) -> bool {
        let mut accepted = true;
        self.check(&mut |_| accepted = false);
        self.compare(link, modules, &mut |_| accepted = false);
        accepted
    }
}
