//! What the processes of a cluster say to process 0 and it to them, beside the states: one line of JSON each.

use serde::{Deserialize, Serialize};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// A longer line is no frame.
const LONGEST: u64 = 1 << 20;

/// How long a process may be silent. Each one says something every [`BEAT`].
pub(super) const SILENCE: Duration = Duration::from_secs(30);

/// How often a process says that it is there.
pub(super) const BEAT: Duration = Duration::from_secs(1);

#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Frame {
    /// A process wants to take part. `subject` names what it is going to explore, `port` is where it takes states.
    Hello {
        version: String,
        subject: u64,
        port: u16,
    },
    /// All processes are there. The addresses are those of process 1 and up.
    Welcome {
        process: usize,
        threads: usize,
        addresses: Vec<String>,
    },
    /// An exploration begins.
    Run {
        number: u64,
        fingerprint: u64,
        milliseconds: Option<u64>,
    },
    /// Still there.
    Beat,
    /// The sender cannot go on, and why.
    Failed(String),
    /// No exploration follows.
    End,
}

pub(super) fn send(stream: &mut TcpStream, frame: &Frame) -> std::io::Result<()> {
    let mut line = serde_json::to_vec(frame)?;
    line.push(b'\n');
    stream.write_all(&line)
}

/// The next frame; none at the end of the connection.
pub(super) fn receive(reader: &mut BufReader<TcpStream>) -> std::io::Result<Option<Frame>> {
    let mut line = Vec::new();
    if reader.take(LONGEST).read_until(b'\n', &mut line)? == 0 {
        return Ok(None);
    }
    Ok(Some(serde_json::from_slice(&line)?))
}
