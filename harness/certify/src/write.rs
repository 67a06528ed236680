//! Writes certificates. Nothing that is confirmed rests on this module.

use std::io::{self, Write};

use sha2::{Digest, Sha256};

use crate::format::{Body, Header, MAGIC, Run, VERSION};

/// Writes a certificate.
///
/// # Errors
/// As of writing; a header that is no TOML.
pub fn write(out: &mut dyn Write, header: &Header, bodies: &[Body]) -> io::Result<()> {
    let text = toml::to_string(header).map_err(io::Error::other)?;
    let mut out = Hashed {
        out,
        hash: Sha256::new(),
    };
    write!(out, "{MAGIC} {VERSION} {}\n{text}", text.len())?;
    for body in bodies {
        self::body(&mut out, body)?;
    }
    let checksum = out.hash.finalize();
    out.out.write_all(&checksum)
}

struct Hashed<'a> {
    out: &'a mut dyn Write,
    hash: Sha256,
}

impl Write for Hashed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.hash.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

fn body(out: &mut impl Write, body: &Body) -> io::Result<()> {
    ascending(out, &body.states)?;
    for proof in &body.proofs {
        number(out, proof.runs.len() as u128)?;
        for one in &proof.runs {
            run(out, one)?;
        }
        number(out, u128::from(!proof.map.is_empty()))?;
        for same in proof.map.chunk_by(|a, b| a == b) {
            number(out, same.len() as u128)?;
            number(out, u128::from(same[0]))?;
        }
        ascending(out, &proof.pairs)?;
    }
    body.faults.iter().try_for_each(|one| run(out, one))
}

fn run(out: &mut impl Write, run: &Run) -> io::Result<()> {
    number(out, run.initial)?;
    number(out, run.repeats.map_or(0, |k| k as u128 + 1))?;
    number(out, run.steps.len() as u128)?;
    for step in &run.steps {
        number(out, step.len() as u128)?;
        for (input, value) in step {
            number(out, u128::from(*input))?;
            number(out, u128::from(*value))?;
        }
    }
    Ok(())
}

/// Numbers in ascending order. (Other lists make a file that is rejected.)
fn ascending(out: &mut impl Write, list: &[u128]) -> io::Result<()> {
    number(out, list.len() as u128)?;
    let mut next = 0_u128;
    for value in list {
        number(out, value.wrapping_sub(next))?;
        next = value.wrapping_add(1);
    }
    Ok(())
}

fn number(out: &mut impl Write, mut value: u128) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(1);
    while value > 0x7f {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    out.write_all(&bytes)
}
