//! A reader of AIGER files, ASCII and binary, as far as netlists are written.

use std::collections::BTreeMap;

/// What stands in a file. Literals are as there; variables are renumbered: inputs, latches, conjunctions.
#[derive(Debug, PartialEq, Eq)]
pub struct Read {
    /// Number of inputs.
    pub inputs: usize,
    /// Own literal, next, start value.
    pub latches: Vec<(u32, u32, Option<bool>)>,
    /// Literals.
    pub outputs: Vec<u32>,
    /// Literals.
    pub bad: Vec<u32>,
    /// Literals.
    pub constraints: Vec<u32>,
    /// Own literal and parts.
    pub ands: Vec<(u32, u32, u32)>,
    /// By place, as `l0`; empty for one that is not there.
    pub symbols: BTreeMap<String, String>,
}

/// Values of the variables.
pub struct Values(Vec<bool>);

impl Values {
    /// That of a literal.
    pub fn lit(&self, lit: u32) -> bool {
        self.0[(lit >> 1) as usize] != (lit & 1 == 1)
    }
}

struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn line(&mut self) -> &'a str {
        let end = (self.0.iter().position(|b| *b == b'\n')).unwrap_or(self.0.len());
        let line = std::str::from_utf8(&self.0[..end]).expect("text");
        self.0 = &self.0[(end + 1).min(self.0.len())..];
        line
    }

    fn numbers(&mut self) -> Vec<u32> {
        let line = self.line();
        line.split(' ')
            .map(|w| w.parse().unwrap_or_else(|e| panic!("`{line}`: {e}")))
            .collect()
    }

    fn difference(&mut self) -> u32 {
        let (mut value, mut shift) = (0, 0);
        loop {
            let byte = self.0[0];
            self.0 = &self.0[1..];
            value |= u32::from(byte & 0x7f) << shift;
            shift += 7;
            if byte & 0x80 == 0 {
                return value;
            }
        }
    }
}

impl Read {
    /// Reads a file.
    pub fn of(file: &[u8]) -> Self {
        let mut bytes = Bytes(file);
        let header: Vec<&str> = bytes.line().split(' ').collect();
        let binary = header[0] == "aig";
        assert!(binary || header[0] == "aag", "{header:?}");
        let count = |k: usize| -> usize { header[k].parse().expect("a number") };
        let (most, inputs, latches, outputs, ands) =
            (count(1), count(2), count(3), count(4), count(5));
        assert_eq!(most, inputs + latches + ands);
        let mut read = Read {
            inputs,
            latches: Vec::new(),
            outputs: Vec::new(),
            bad: Vec::new(),
            constraints: Vec::new(),
            ands: Vec::new(),
            symbols: BTreeMap::from([("i0".to_owned(), String::new())]),
        };
        if !binary {
            for k in 0..inputs {
                assert_eq!(bytes.numbers(), [2 * (k as u32 + 1)]);
            }
        }
        for k in 0..latches {
            let own = 2 * (inputs + k + 1) as u32;
            let mut list = bytes.numbers();
            if !binary {
                assert_eq!(list.remove(0), own);
            }
            let init = match list.get(1) {
                None | Some(0) => Some(false),
                Some(1) => Some(true),
                Some(other) => {
                    assert_eq!(*other, own);
                    None
                }
            };
            read.latches.push((own, list[0], init));
        }
        for (list, count) in [
            (&mut read.outputs, outputs),
            (&mut read.bad, count(6)),
            (&mut read.constraints, count(7)),
        ] {
            list.extend((0..count).map(|_| bytes.numbers()[0]));
        }
        for k in 0..ands {
            let own = 2 * (inputs + latches + k + 1) as u32;
            let (a, b) = if binary {
                let a = own - bytes.difference();
                (a, a - bytes.difference())
            } else {
                let list = bytes.numbers();
                assert_eq!(list[0], own);
                (list[1], list[2])
            };
            assert!(a < own && b <= a, "each after its parts");
            read.ands.push((own, a, b));
        }
        while !bytes.0.is_empty() {
            let line = bytes.line();
            if line == "c" {
                break;
            }
            let (place, name) = line.split_once(' ').expect("place and name");
            read.symbols.insert(place.to_owned(), name.to_owned());
        }
        read
    }

    /// Values of all variables, of those of inputs and latches.
    pub fn values(&self, leaves: &[bool]) -> Values {
        let mut values = Values(vec![false]);
        values.0.extend(leaves);
        for (_, a, b) in &self.ands {
            let both = values.lit(*a) && values.lit(*b);
            values.0.push(both);
        }
        values
    }
}
