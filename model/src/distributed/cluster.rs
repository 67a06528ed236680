//! The processes that explore together: how they find each other, and how each learns that another one is gone.

use super::frame::{BEAT, Frame, SILENCE, receive, send};
use super::health::Health;
use std::io::BufReader;
use std::net::{SocketAddr, TcpListener, TcpStream, ToSocketAddrs};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// How often something that is waited for is looked at.
pub(super) const GLANCE: Duration = Duration::from_millis(5);

/// Why processes cannot explore together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ClusterError(pub(super) String);

impl From<std::io::Error> for ClusterError {
    fn from(error: std::io::Error) -> Self {
        ClusterError(error.to_string())
    }
}

/// One process among several that explore the same systems in the same order, each with its share of the states.
///
/// Process 0 has a connection to each other one, for orders and signs of life; an end of the connection, or 30 s of
/// silence, is a failure of the exploration. States go directly from process to process. There is no protection
/// against hostile peers: use it among machines that trust each other.
#[derive(Debug)]
pub struct Cluster {
    process: usize,
    processes: usize,
    threads: usize,
    /// Where the processes take states.
    pub(super) addresses: Vec<SocketAddr>,
    /// Where this one does.
    pub(super) listener: TcpListener,
    pub(super) health: Arc<Health>,
    /// At process 0 those to the others in their order, else the one to process 0.
    controls: Vec<Arc<Mutex<TcpStream>>>,
    orders: Mutex<Receiver<Frame>>,
    /// This process leaves.
    closing: Arc<AtomicBool>,
    /// Another one has left in good order.
    left: Arc<AtomicBool>,
    runs: AtomicU64,
    sent: AtomicU64,
    /// Its end stops the signs of life.
    beating: Option<Sender<()>>,
}

/// An exploration as process 0 has announced it.
pub(super) struct Order {
    pub(super) number: u64,
    pub(super) time: Option<Duration>,
}

impl Cluster {
    /// Becomes process 0 of `processes` (at least 1) with `threads` worker threads in each: waits until all others have
    /// joined at the listener's address. `subject` is a number for what is to be explored; who joins with another one is
    /// refused. `alive` is asked now and then; its error ends the waiting.
    ///
    /// # Errors
    /// The network's, or that of `alive`.
    pub fn gather(
        listener: TcpListener,
        processes: usize,
        threads: usize,
        subject: u64,
        alive: &mut dyn FnMut() -> Result<(), String>,
    ) -> Result<Cluster, ClusterError> {
        let mut joined: Vec<(Talk, SocketAddr)> = Vec::new();
        let mut beat = Instant::now();
        listener.set_nonblocking(true)?;
        while joined.len() + 1 < processes {
            alive().map_err(ClusterError)?;
            if beat.elapsed() >= BEAT {
                beat = Instant::now();
                // Who has gone again meanwhile makes room for another one.
                joined.retain_mut(|(talk, _)| send(&mut talk.stream, &Frame::Beat).is_ok());
            }
            match listener.accept() {
                Ok((stream, from)) => joined.extend(greet(stream, from, subject)),
                Err(e) if e.kind() == std::io::ErrorKind::WouldBlock => thread::sleep(GLANCE),
                Err(e) => return Err(e.into()),
            }
        }
        let texts: Vec<String> = joined.iter().map(|(_, a)| a.to_string()).collect();
        let mut addresses = vec![listener.local_addr()?];
        let mut talks = Vec::new();
        for (number, (mut talk, address)) in joined.into_iter().enumerate() {
            let welcome = Frame::Welcome {
                process: number + 1,
                threads,
                addresses: texts.clone(),
            };
            send(&mut talk.stream, &welcome)?;
            addresses.push(address);
            talks.push(talk);
        }
        Cluster::start(0, threads, addresses, listener, talks)
    }

    /// Joins the process 0 that listens at an address (`HOST:PORT`), trying for the given time to reach it.
    ///
    /// # Errors
    /// The network's, or process 0's reason not to take this one.
    pub fn join(address: &str, subject: u64, patience: Duration) -> Result<Cluster, ClusterError> {
        let (mut stream, host) = reach(address, patience)?;
        stream.set_read_timeout(Some(SILENCE))?;
        let listener = TcpListener::bind((stream.local_addr()?.ip(), 0))?;
        listener.set_nonblocking(true)?;
        let hello = Frame::Hello {
            version: VERSION.to_owned(),
            subject,
            port: listener.local_addr()?.port(),
        };
        send(&mut stream, &hello)?;
        let mut reader = BufReader::new(stream.try_clone()?);
        loop {
            match receive(&mut reader) {
                Ok(Some(Frame::Beat)) => (),
                Ok(Some(Frame::Welcome {
                    process,
                    threads,
                    addresses,
                })) => {
                    let mut all = vec![host];
                    for text in addresses {
                        let address = text.parse().map_err(|e| {
                            ClusterError(format!("{address} names the address `{text}`: {e}"))
                        })?;
                        all.push(address);
                    }
                    // The reader may hold the first order already.
                    let talk = Talk { stream, reader };
                    return Cluster::start(process, threads, all, listener, vec![talk]);
                }
                Ok(Some(Frame::Failed(reason))) => return Err(ClusterError(reason)),
                Ok(_) => {
                    return Err(ClusterError(format!(
                        "the process at {address} does not take this one"
                    )));
                }
                Err(e) => {
                    return Err(ClusterError(format!(
                        "no answer from the process at {address}: {e}"
                    )));
                }
            }
        }
    }

    fn start(
        process: usize,
        threads: usize,
        addresses: Vec<SocketAddr>,
        listener: TcpListener,
        talks: Vec<Talk>,
    ) -> Result<Cluster, ClusterError> {
        let health = Arc::new(Health::default());
        let closing = Arc::new(AtomicBool::new(false));
        let left = Arc::new(AtomicBool::new(false));
        let (tell, orders) = mpsc::channel();
        let mut controls = Vec::new();
        for (number, Talk { stream, reader }) in talks.into_iter().enumerate() {
            let peer = if process == 0 { number + 1 } else { 0 };
            stream.set_nonblocking(false)?;
            stream.set_read_timeout(Some(SILENCE))?;
            stream.set_write_timeout(Some(SILENCE))?;
            let ear = Ear {
                peer,
                reader,
                tell: tell.clone(),
                health: Arc::clone(&health),
                closing: Arc::clone(&closing),
                left: Arc::clone(&left),
            };
            thread::Builder::new()
                .name(format!("listens to process {peer}"))
                .spawn(|| ear.listen())?;
            controls.push(Arc::new(Mutex::new(stream)));
        }
        let (beating, stop) = mpsc::channel();
        let beaten = controls.clone();
        thread::Builder::new()
            .name("signs of life".to_owned())
            .spawn(move || {
                while stop.recv_timeout(BEAT) == Err(RecvTimeoutError::Timeout) {
                    for control in &beaten {
                        // A peer that cannot be told is noticed by the one who listens to it.
                        let _ = tell_peer(control, &Frame::Beat);
                    }
                }
            })?;
        Ok(Cluster {
            process,
            processes: addresses.len(),
            threads,
            addresses,
            listener,
            health,
            controls,
            orders: Mutex::new(orders),
            closing,
            left,
            runs: AtomicU64::new(0),
            sent: AtomicU64::new(0),
            beating: Some(beating),
        })
    }

    /// The number of this process. Process 0 makes the report.
    pub fn process(&self) -> usize {
        self.process
    }

    /// The number of processes.
    pub fn processes(&self) -> usize {
        self.processes
    }

    /// Worker threads in each process.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// At process 0 the number of states that workers have sent to workers of any process so far; 0 elsewhere.
    pub fn sent(&self) -> u64 {
        self.sent.load(Ordering::Relaxed)
    }

    pub(super) fn note_sent(&self, states: u64) {
        self.sent.fetch_add(states, Ordering::Relaxed);
    }

    /// Tells those who listen to this process why it cannot go on, if it cannot.
    pub(super) fn tell_failure(&self) {
        if let Some(reason) = self.health.reason() {
            let failed = Frame::Failed(reason);
            for control in &self.controls {
                // Who cannot be told notices by itself.
                let _ = tell_peer(control, &failed);
            }
        }
    }

    /// Fails if a process is gone, or has no part in an exploration that begins.
    pub(super) fn check(&self) -> Result<(), String> {
        self.health.check()?;
        match self.left.load(Ordering::Acquire) {
            true => Err("another process has ended its work already".to_owned()),
            false => Ok(()),
        }
    }

    /// Begins the next exploration in all processes. What process 0 says about the time left holds for all.
    pub(super) fn begin(
        &self,
        fingerprint: u64,
        time: Option<Duration>,
    ) -> Result<Order, ClusterError> {
        self.check().map_err(ClusterError)?;
        let number = self.runs.fetch_add(1, Ordering::Relaxed);
        if self.process == 0 {
            let run = Frame::Run {
                number,
                fingerprint,
                milliseconds: time.map(|t| u64::try_from(t.as_millis()).unwrap_or(u64::MAX)),
            };
            for control in &self.controls {
                tell_peer(control, &run)?;
            }
            return Ok(Order { number, time });
        }
        let orders = self.orders.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            match orders.recv_timeout(GLANCE) {
                Ok(Frame::Run {
                    number: given,
                    fingerprint: theirs,
                    milliseconds,
                }) => {
                    if (given, theirs) != (number, fingerprint) {
                        let reason = format!("process {} explores another system", self.process);
                        self.health.fail(reason.clone());
                        self.tell_failure();
                        return Err(ClusterError(reason));
                    }
                    let time = milliseconds.map(Duration::from_millis);
                    return Ok(Order { number, time });
                }
                Ok(_) | Err(RecvTimeoutError::Disconnected) => {
                    self.health.check().map_err(ClusterError)?;
                    return Err(ClusterError("process 0 has ended its work".to_owned()));
                }
                Err(RecvTimeoutError::Timeout) => self.health.check().map_err(ClusterError)?,
            }
        }
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        self.closing.store(true, Ordering::Release);
        drop(self.beating.take());
        self.tell_failure();
        let ends = !self.health.failed();
        for control in &self.controls {
            if ends {
                let _ = tell_peer(control, &Frame::End);
            }
            let stream = control.lock().unwrap_or_else(PoisonError::into_inner);
            let _ = stream.shutdown(std::net::Shutdown::Write);
        }
    }
}

/// A connection for orders. What has been read and not yet heard is in the reader.
struct Talk {
    stream: TcpStream,
    reader: BufReader<TcpStream>,
}

/// Hears what one process says.
struct Ear {
    peer: usize,
    reader: BufReader<TcpStream>,
    tell: Sender<Frame>,
    health: Arc<Health>,
    closing: Arc<AtomicBool>,
    left: Arc<AtomicBool>,
}

impl Ear {
    fn listen(mut self) {
        loop {
            match receive(&mut self.reader) {
                Ok(Some(Frame::Beat)) => (),
                Ok(Some(Frame::Failed(reason))) => {
                    return self.lost(&format!("process {} gave up: {reason}", self.peer));
                }
                Ok(Some(frame)) => {
                    let end = matches!(frame, Frame::End);
                    let _ = self.tell.send(frame);
                    if end {
                        // What the connection does now is no failure.
                        return self.left.store(true, Ordering::Release);
                    }
                }
                Ok(None) => return self.lost(&gone(self.peer)),
                Err(e) if silent(&e) => {
                    let seconds = SILENCE.as_secs();
                    return self.lost(&format!(
                        "process {} has not been heard of for {seconds} s",
                        self.peer
                    ));
                }
                Err(_) => return self.lost(&gone(self.peer)),
            }
        }
    }

    fn lost(&self, reason: &str) {
        if !self.closing.load(Ordering::Acquire) {
            self.health.fail(reason.to_owned());
        }
    }
}

/// What is said about a process whose connection has ended.
pub(super) fn gone(process: usize) -> String {
    format!("process {process} has ended or cannot be reached any more")
}

fn silent(error: &std::io::Error) -> bool {
    use std::io::ErrorKind::{TimedOut, WouldBlock};
    matches!(error.kind(), WouldBlock | TimedOut)
}

fn tell_peer(control: &Mutex<TcpStream>, frame: &Frame) -> std::io::Result<()> {
    send(
        &mut control.lock().unwrap_or_else(PoisonError::into_inner),
        frame,
    )
}

/// Hears what a new connection wants; none for one that is no process of this exploration.
fn greet(mut stream: TcpStream, from: SocketAddr, subject: u64) -> Option<(Talk, SocketAddr)> {
    stream.set_nonblocking(false).ok()?;
    stream.set_nodelay(true).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(5))).ok()?;
    let mut reader = BufReader::new(stream.try_clone().ok()?);
    let Ok(Some(Frame::Hello {
        version,
        subject: theirs,
        port,
    })) = receive(&mut reader)
    else {
        return None;
    };
    let reason = if version != VERSION {
        format!("process 0 has version {VERSION}, this one {version}")
    } else if theirs != subject {
        "process 0 explores other systems: give the same file, the same contents and the same options".to_owned()
    } else {
        let address = SocketAddr::new(from.ip(), port);
        return Some((Talk { stream, reader }, address));
    };
    let _ = send(&mut stream, &Frame::Failed(reason));
    None
}

/// A connection to an address, and that address.
fn reach(address: &str, patience: Duration) -> Result<(TcpStream, SocketAddr), ClusterError> {
    let start = Instant::now();
    loop {
        let mut reason = "it names no address".to_owned();
        let resolved = address
            .to_socket_addrs()
            .map_err(|e| ClusterError(format!("`{address}` is no address HOST:PORT: {e}")))?;
        for candidate in resolved {
            match TcpStream::connect_timeout(&candidate, SILENCE) {
                Ok(stream) => {
                    stream.set_nodelay(true)?;
                    return Ok((stream, candidate));
                }
                Err(e) => reason = e.to_string(),
            }
        }
        if start.elapsed() >= patience {
            return Err(ClusterError(format!("cannot reach {address}: {reason}")));
        }
        thread::sleep(Duration::from_millis(200));
    }
}
