//! The connections on which states go from process to process, made anew for each exploration.

use super::cluster::{Cluster, GLANCE, gone};
use super::frame::SILENCE;
use super::health::Health;
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};
use timely::communication::allocator::zero_copy::stream::Stream;

/// The first word on a connection, so that a stray one is not taken for a process.
const MAGIC: u64 = u64::from_be_bytes(*b"stillpt1");

/// One end of a connection, as the communication threads of the dataflow see it. They take a broken connection for a
/// reason to panic. So a break is noted here, what is written after it is dropped, and who reads waits forever: the
/// workers see what has been noted and give up, and the threads end with the process.
pub(super) struct Link {
    stream: TcpStream,
    peer: usize,
    health: Arc<Health>,
    /// Workers of this process that may still send something. Without any the peers may end their connections.
    sending: Arc<AtomicUsize>,
}

impl Link {
    fn lost(&self) {
        self.health.fail(gone(self.peer));
    }
}

impl Read for Link {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            match self.stream.read(buffer) {
                Err(e) if e.kind() == io::ErrorKind::Interrupted => (),
                Ok(0) | Err(_) if self.sending.load(Ordering::Acquire) > 0 => {
                    self.lost();
                    loop {
                        thread::park();
                    }
                }
                result => return result,
            }
        }
    }
}

impl Write for Link {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        loop {
            match self.stream.write(bytes) {
                Err(e) if e.kind() == io::ErrorKind::Interrupted => (),
                Err(_) => {
                    self.lost();
                    return Ok(bytes.len());
                }
                written => return written,
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Stream for Link {
    fn try_clone(&self) -> io::Result<Self> {
        Ok(Link {
            stream: self.stream.try_clone()?,
            peer: self.peer,
            health: Arc::clone(&self.health),
            sending: Arc::clone(&self.sending),
        })
    }

    fn set_nonblocking(&self, nonblocking: bool) -> io::Result<()> {
        self.stream.set_nonblocking(nonblocking)
    }

    fn shutdown(&self, how: Shutdown) -> io::Result<()> {
        // A connection that is broken already needs no end.
        let _ = self.stream.shutdown(how);
        Ok(())
    }
}

/// Connects this process with each other one for exploration `number`; none stands at its own place.
pub(super) fn connect(
    cluster: &Cluster,
    number: u64,
    sending: &Arc<AtomicUsize>,
) -> Result<Vec<Option<Link>>, String> {
    let own = cluster.process();
    let mut streams: Vec<Option<TcpStream>> = (0..cluster.processes()).map(|_| None).collect();
    // Each process calls those before it and is called by those after it. Process 0 calls nobody, so all get through.
    for (peer, place) in streams.iter_mut().enumerate().take(own) {
        let called = call(cluster, peer, number)
            .map_err(|e| format!("process {own} cannot connect to process {peer}: {e}"));
        *place = Some(called?);
    }
    let start = Instant::now();
    while let Some(missing) = (own + 1..streams.len()).find(|peer| streams[*peer].is_none()) {
        cluster.check()?;
        match cluster.listener.accept() {
            Ok((stream, _)) => {
                if let Some((peer, stream)) = answer(stream, number) {
                    if let Some(place @ None) = streams.get_mut(peer) {
                        *place = Some(stream);
                    }
                }
            }
            Err(e) if e.kind() == io::ErrorKind::WouldBlock => thread::sleep(GLANCE),
            Err(e) => return Err(e.to_string()),
        }
        if start.elapsed() > 2 * SILENCE {
            return Err(format!(
                "process {missing} has not connected to process {own}"
            ));
        }
    }
    Ok(streams
        .into_iter()
        .enumerate()
        .map(|(peer, stream)| {
            stream.map(|stream| Link {
                stream,
                peer,
                health: Arc::clone(&cluster.health),
                sending: Arc::clone(sending),
            })
        })
        .collect())
}

fn call(cluster: &Cluster, peer: usize, number: u64) -> io::Result<TcpStream> {
    let mut stream = TcpStream::connect_timeout(&cluster.addresses[peer], SILENCE)?;
    stream.set_nodelay(true)?;
    for word in [MAGIC, number, cluster.process() as u64] {
        stream.write_all(&word.to_be_bytes())?;
    }
    stream.set_read_timeout(Some(2 * SILENCE))?;
    let accepted = word(&mut stream)?;
    if accepted != MAGIC {
        return Err(io::Error::other("no process of this exploration is there"));
    }
    stream.set_read_timeout(None)?;
    Ok(stream)
}

/// Which process calls, if it is one and calls for this exploration.
fn answer(mut stream: TcpStream, number: u64) -> Option<(usize, TcpStream)> {
    stream.set_nonblocking(false).ok()?;
    stream.set_nodelay(true).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(5))).ok()?;
    if word(&mut stream).ok()? != MAGIC || word(&mut stream).ok()? != number {
        return None;
    }
    let peer = usize::try_from(word(&mut stream).ok()?).ok()?;
    stream.write_all(&MAGIC.to_be_bytes()).ok()?;
    stream.set_read_timeout(None).ok()?;
    Some((peer, stream))
}

fn word(stream: &mut TcpStream) -> io::Result<u64> {
    let mut bytes = [0; 8];
    stream.read_exact(&mut bytes)?;
    Ok(u64::from_be_bytes(bytes))
}
