//! Addresses, times, numbers and names of blocks.

use super::super::ast::Block;
use super::super::lex::Kind;
use super::super::operand::{Area, Bit, Cell, MOST_BYTES, SPL, area};
use super::super::words::Dialect;
use super::Parser;
use crate::fault::{Checked, Fault, Span};

/// What an instruction is about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Operand {
    Bit(Bit),
    Cell(Cell),
    Timer(u16),
    Int(i64),
    /// In microseconds; whether it is a time of a timer (S5T).
    Time(u64, bool),
    Bool(bool),
    Block(Block),
    /// A data block.
    Data(u16),
    /// `P#M 194.0 BYTE 1`
    Pointer(Option<Cell>),
    /// A number with a fraction.
    Real,
}

const FORMS: &str =
    "write E 76.0, A 48.2, M 211.0, DB31.DBX 22.1, OUTSIP[3], MB 194, T 20, S5T#1S or a number";

/// Letters and the number after them.
fn split(word: &str) -> (&str, &str) {
    let end = word
        .find(|c: char| c.is_ascii_digit())
        .unwrap_or(word.len());
    word.split_at(end)
}

impl Parser<'_> {
    /// What stands here.
    pub(super) fn operand(&mut self) -> Checked<Operand> {
        let start = self.span();
        match self.peek().clone() {
            Kind::Quoted(name) => self.symbol(&name, &start),
            Kind::Sign("-" | "+") => {
                let minus = self.is_sign("-");
                self.next();
                match self.operand()? {
                    Operand::Int(n) => Ok(Operand::Int(if minus { -n } else { n })),
                    Operand::Real => Ok(Operand::Real),
                    _ => Err(Fault::new(
                        &start,
                        "a sign stands before a number only",
                        FORMS,
                    )),
                }
            }
            Kind::Sign("$") => {
                self.next();
                self.operand()
            }
            Kind::Word(word) => self.of_word(&word.to_uppercase(), &start),
            _ => Err(self.unexpected("an address or a value is missing here", FORMS)),
        }
    }

    fn of_word(&mut self, word: &str, start: &Span) -> Checked<Operand> {
        if matches!(self.ahead(1), Kind::Sign("#")) {
            return self.constant(word);
        }
        let (letters, digits) = split(word);
        self.next();
        match letters {
            "" => self.number(word, start),
            "TRUE" | "FALSE" => Ok(Operand::Bool(letters == "TRUE")),
            "FC" | "OB" | "FB" | "SFC" | "SFB" => {
                let n = self.counted(digits, letters, 0, u16::MAX)?;
                Ok(Operand::Block(match letters {
                    "FC" => Block::Fc(n),
                    "OB" => Block::Ob(n),
                    "FB" => Block::Fb(n),
                    _ => Block::Symbol(format!("{letters} {n}")),
                }))
            }
            "T" => Ok(Operand::Timer(self.counted(digits, "timer", 0, 511)?)),
            "Z" | "C" => Err(Fault::new(start, "counters are not read", FORMS)),
            "DB" => {
                let block = self.counted(digits, "data block", 1, 16_000)?;
                match self.take_sign(".") {
                    true => self.in_data_block(block, start),
                    false => Ok(Operand::Data(block)),
                }
            }
            "DBX" | "DBB" | "DBW" | "DBD" => match self.data_block {
                Some(block) => self.of_data(letters, digits, block, start),
                None => Err(Fault::new(
                    start,
                    "no data block is open here",
                    "write the data block with the address, `DB31.DBX 22.1`, or open it before: `AUF DB 31` (OPN)",
                )),
            },
            "DIX" | "DIB" | "DIW" | "DID" | "LB" | "LW" | "LD" | "PEB" | "PEW" | "PAB" | "PAW"
            | "PIB" | "PIW" | "PQB" | "PQW" => {
                Err(Fault::new(start, format!("`{letters}` is not read"), FORMS))
            }
            _ if SPL
                .iter()
                .any(|(name, ..)| *name == letters.trim_start_matches("A_")) =>
            {
                self.of_spl(letters.trim_start_matches("A_"), start)
            }
            // `A_INSEP`
            "A_" => Err(Fault::new(
                start,
                format!("there is no variable `{word}`"),
                FORMS,
            )),
            _ => self.of_area(letters, digits, start),
        }
    }

    /// `E 76.0`, `MB 194`
    fn of_area(&mut self, letters: &str, digits: &str, start: &Span) -> Checked<Operand> {
        let wrong = || Fault::new(start, format!("`{letters}{digits}` is no address"), FORMS);
        let mut parts = letters.chars();
        let letter = parts.next().map(String::from).unwrap_or_default();
        let at = area(&letter).ok_or_else(wrong)?;
        let width = match parts.as_str() {
            "" => 0,
            "B" => 1,
            "W" => 2,
            "D" => 4,
            _ => return Err(wrong()),
        };
        let shows = match letter.as_str() {
            "E" | "A" => Some(Dialect::German),
            "I" | "Q" => Some(Dialect::English),
            _ => None,
        };
        if let Some(dialect) = shows {
            let letters = start.start..start.start + letters.len();
            self.shows(dialect, &letters)?;
        }
        self.address(at, width, digits, start)
    }

    /// What follows `DB31.`
    fn in_data_block(&mut self, block: u16, start: &Span) -> Checked<Operand> {
        let Some(word) = self.word() else {
            return Err(self.unexpected(
                "an address in the data block is missing",
                "write `DB31.DBX 22.1`",
            ));
        };
        let (letters, digits) = split(&word);
        self.next();
        let digits = digits.to_owned();
        self.of_data(letters, &digits, block, start)
    }

    fn of_data(
        &mut self,
        letters: &str,
        digits: &str,
        block: u16,
        start: &Span,
    ) -> Checked<Operand> {
        let width = match letters {
            "DBX" => 0,
            "DBB" => 1,
            "DBW" => 2,
            "DBD" => 4,
            _ => {
                return Err(Fault::new(
                    start,
                    format!("`{letters}` is no address in a data block"),
                    "write DBX for a bit, DBB for a byte, DBW for a word",
                ));
            }
        };
        self.address(Area::Data(block), width, digits, start)
    }

    fn address(&mut self, area: Area, width: u8, digits: &str, start: &Span) -> Checked<Operand> {
        let byte = self.counted(digits, "byte", 0, MOST_BYTES)?;
        if width > 0 {
            return Ok(Operand::Cell(Cell { area, byte, width }));
        }
        if !self.take_sign(".") {
            let text = self
                .source
                .get(start.start..self.before().end)
                .unwrap_or_default();
            return Err(Fault::new(
                &(start.start..self.before().end),
                format!("`{text}` has no bit"),
                format!("write `{text}.0` to `{text}.7`"),
            ));
        }
        let bit = self.counted("", "bit", 0, 7)? as u8;
        Ok(Operand::Bit(Bit { area, byte, bit }))
    }

    /// `OUTSIP[3]`
    fn of_spl(&mut self, name: &str, start: &Span) -> Checked<Operand> {
        self.expect_sign("[", "write `OUTSIP[3]`")?;
        let number = self.counted("", "variable", 1, 64)?;
        self.expect_sign("]", "write `OUTSIP[3]`")?;
        let bit = Bit::spl(name, number).ok_or_else(|| {
            let message = format!("there is no {name}[{number}]");
            Fault::new(
                start,
                message,
                "PLCSIOUT and PLCSIIN have 32 bits, the others 64",
            )
        })?;
        Ok(Operand::Bit(bit))
    }

    /// A number of a range: what the word before ends with, else the word here.
    fn counted(&mut self, digits: &str, what: &str, low: u16, high: u16) -> Checked<u16> {
        let span = match digits.is_empty() {
            true => self.span(),
            false => self.before(),
        };
        let text = match digits.is_empty() {
            true => match self.peek() {
                Kind::Word(word) => word.clone(),
                _ => String::new(),
            },
            false => digits.to_owned(),
        };
        let range = format!("{low} to {high}");
        if text.is_empty() || !text.bytes().all(|b| b.is_ascii_digit()) {
            return Err(Fault::new(
                &span,
                format!("the number of the {what} is missing"),
                format!("write a number, {range}"),
            ));
        }
        if digits.is_empty() {
            self.next();
        }
        match text.parse::<u16>() {
            Ok(number) if (low..=high).contains(&number) => Ok(number),
            _ => Err(Fault::new(
                &span,
                format!("there is no {what} {text}"),
                format!("its number is {range}"),
            )),
        }
    }

    /// `5`, `-5.0e+3`
    fn number(&mut self, word: &str, start: &Span) -> Checked<Operand> {
        if self.is_sign(".") {
            self.next();
            let fraction = self.word().unwrap_or_default();
            self.next();
            if fraction.ends_with('E') && (self.take_sign("+") || self.take_sign("-")) {
                self.next();
            }
            return Ok(Operand::Real);
        }
        match word.parse::<i64>() {
            Ok(number) if number <= i64::from(u32::MAX) => Ok(Operand::Int(number)),
            _ => Err(Fault::new(start, format!("`{word}` is no number"), FORMS)),
        }
    }

    /// `S5T#1S`, `T#1S500MS`, `B#16#4`, `2#101`, `L#5`, `P#M 194.0 BYTE 1`
    fn constant(&mut self, prefix: &str) -> Checked<Operand> {
        let start = self.span();
        self.next();
        self.next();
        match prefix {
            "P" => return self.pointer(&start),
            "S5T" | "S5TIME" | "T" | "TIME" => {
                let text = self.word().unwrap_or_default();
                self.next();
                let span = start.start..self.before().end;
                let us = duration(&text).ok_or_else(|| {
                    let message = format!("`{}` is no time", self.source.get(span.clone()).unwrap_or_default());
                    Fault::new(&span, message, "write hours, minutes, seconds and milliseconds: S5T#2H40M, S5T#1S, S5T#120MS")
                })?;
                let timer = prefix.starts_with('S');
                if timer {
                    representable(us, &span)?;
                }
                return Ok(Operand::Time(us, timer));
            }
            _ => {}
        }
        let base = match prefix {
            "B" | "W" | "DW" => {
                let base = self.word().unwrap_or_default();
                self.next();
                self.expect_sign("#", "write `B#16#4`")?;
                base
            }
            other => other.to_owned(),
        };
        let digits = self.word().unwrap_or_default();
        self.next();
        let radix = match base.as_str() {
            "16" => 16,
            "2" => 2,
            "L" => 10,
            _ => {
                let span = start.start..self.before().end;
                return Err(Fault::new(
                    &span,
                    format!("`{prefix}#` is no constant"),
                    FORMS,
                ));
            }
        };
        let digits = digits.replace('_', "");
        match i64::from_str_radix(&digits, radix) {
            Ok(number) if (0..=i64::from(u32::MAX)).contains(&number) => Ok(Operand::Int(number)),
            _ => {
                let span = start.start..self.before().end;
                let message = format!("`{digits}` is no number of base {radix}");
                Err(Fault::new(&span, message, "write `B#16#4` or `W#16#1`"))
            }
        }
    }

    /// What follows `P#`: only a byte of the markers is looked at.
    fn pointer(&mut self, start: &Span) -> Checked<Operand> {
        let of = self.operand()?;
        let is_byte = self.take_word("BYTE");
        let count = if is_byte { self.word() } else { None };
        if is_byte {
            self.next();
        }
        match of {
            Operand::Bit(Bit { area, byte, bit: 0 }) => {
                let one = count.as_deref() == Some("1");
                let cell = Cell {
                    area,
                    byte,
                    width: 1,
                };
                Ok(Operand::Pointer(one.then_some(cell)))
            }
            _ => Err(Fault::new(
                &(start.start..self.before().end),
                "a pointer names the first bit of what it points to",
                "write `P#M 194.0 BYTE 1`",
            )),
        }
    }
}

/// A time in microseconds.
fn duration(text: &str) -> Option<u64> {
    let mut rest = text;
    let (mut total, mut last) = (0u64, u64::MAX);
    while !rest.is_empty() {
        rest = rest.trim_start_matches('_');
        let digits = rest.find(|c: char| !c.is_ascii_digit())?;
        let number: u64 = rest.get(..digits)?.parse().ok()?;
        let unit = rest.get(digits..)?;
        let end = unit
            .find(|c: char| c.is_ascii_digit() || c == '_')
            .unwrap_or(unit.len());
        let length = match unit.get(..end)? {
            "D" => 86_400_000_000,
            "H" => 3_600_000_000,
            "M" => 60_000_000,
            "S" => 1_000_000,
            "MS" => 1_000,
            _ => return None,
        };
        if length >= last {
            return None;
        }
        last = length;
        total = total.checked_add(number.checked_mul(length)?)?;
        rest = unit.get(end..)?;
    }
    (last < u64::MAX && total <= 24 * 86_400_000_000).then_some(total)
}

/// A timer counts up to 999 steps of 10 ms, 100 ms, 1 s or 10 s.
fn representable(us: u64, span: &Span) -> Checked<()> {
    let fits = |base: u64| us % base == 0 && us / base <= 999;
    if us > 0
        && [10_000, 100_000, 1_000_000, 10_000_000]
            .into_iter()
            .any(fits)
    {
        return Ok(());
    }
    Err(Fault::new(
        span,
        "a timer cannot have this time: it counts 1 to 999 steps of 10 ms, 100 ms, 1 s or 10 s",
        "choose a time of that form; the control would round it down",
    ))
}
