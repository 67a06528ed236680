//! As much of HTTP/1.1 as a local page needs, every part of it bounded: the heads and bodies of requests, the time that a
//! peer takes, the number of connections. One request a connection.
//!
//! A request that could be read in two ways is refused: a header that decides about it twice, a body without a length, a
//! target that is no path. The head is parsed by `httparse`.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The most bytes of a request's head, and the most header lines in it.
pub const MOST_HEAD: usize = 16 << 10;
const MOST_HEADERS: usize = 64;
/// The most bytes of a request's body.
pub const MOST_BODY: usize = 1 << 20;
/// The most connections at a time. One more takes the place of the oldest one that is not being answered.
pub const MOST_CONNECTIONS: usize = 32;
/// Answers made at a time.
const ANSWERS: usize = 4;
/// The time for a request to arrive, for its answer to be taken, and for the peer to close after it.
const ARRIVE: Duration = Duration::from_secs(10);
const TAKE: Duration = Duration::from_secs(10);
const CLOSE: Duration = Duration::from_secs(1);
/// The most bytes read after an answer, from a peer that goes on sending.
const MOST_AFTER: usize = 8 << 20;

/// What came with a request and decides about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Head {
    /// GET, POST and so on.
    pub method: String,
    /// The path without the query.
    pub path: String,
    /// The host and port it is meant for.
    pub host: Option<String>,
    /// The page it comes from.
    pub origin: Option<String>,
    /// The kind of its body.
    pub content_type: Option<String>,
    length: usize,
    continues: bool,
}

/// An answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// Such as 200.
    pub status: u16,
    /// Such as text/html.
    pub content_type: &'static str,
    /// What it says.
    pub body: String,
}

/// Why a request is not answered: a status, and a reason to show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refused {
    /// Such as 400.
    pub status: u16,
    /// A sentence.
    pub reason: String,
}

fn refused<T>(status: u16, reason: impl Into<String>) -> Result<T, Refused> {
    let reason = reason.into();
    Err(Refused { status, reason })
}

impl Head {
    /// The head at the start of `bytes`, and its length; none if it is not whole yet.
    ///
    /// # Errors
    /// A head that is none, too long, or can be read in two ways.
    pub fn parse(bytes: &[u8]) -> Result<Option<(Self, usize)>, Refused> {
        let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
        let mut request = httparse::Request::new(&mut headers);
        let end = match request.parse(bytes) {
            Ok(httparse::Status::Complete(end)) if end <= MOST_HEAD => end,
            Ok(httparse::Status::Partial) if bytes.len() < MOST_HEAD => return Ok(None),
            Ok(_) | Err(httparse::Error::TooManyHeaders) => {
                return refused(
                    431,
                    format!("a head has at most {MOST_HEAD} bytes and {MOST_HEADERS} lines"),
                );
            }
            Err(e) => return refused(400, format!("the request cannot be read: {e}")),
        };
        let one = |name: &str| {
            let mut all = request
                .headers
                .iter()
                .filter(|h| h.name.eq_ignore_ascii_case(name));
            let Some(first) = all.next() else {
                return Ok(None);
            };
            if all.next().is_some() {
                return refused(400, format!("the header {name} stands there twice"));
            }
            match std::str::from_utf8(first.value) {
                Ok(text) => Ok(Some(text.trim().to_owned())),
                Err(_) => refused(400, format!("the header {name} is no text")),
            }
        };
        if one("transfer-encoding")?.is_some() {
            return refused(411, "a body is sent whole, with its length");
        }
        let length = match one("content-length")? {
            None => 0,
            Some(digits) if !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()) => {
                // What does not fit the number is too long as well.
                digits.parse::<usize>().unwrap_or(usize::MAX)
            }
            Some(_) => return refused(400, "the length of the body is no number"),
        };
        let target = request.path.unwrap_or_default();
        if !target.starts_with('/') {
            return refused(400, "the target of a request is a path");
        }
        let head = Head {
            method: request.method.unwrap_or_default().to_owned(),
            path: target
                .split(['?', '#'])
                .next()
                .unwrap_or_default()
                .to_owned(),
            host: one("host")?,
            origin: one("origin")?,
            content_type: one("content-type")?,
            length,
            continues: one("expect")?.is_some_and(|e| e.eq_ignore_ascii_case("100-continue")),
        };
        Ok(Some((head, end)))
    }
}

/// A stream under a time for all of what is done with it.
struct Timed<'a> {
    stream: &'a TcpStream,
    until: Instant,
}

impl<'a> Timed<'a> {
    fn new(stream: &'a TcpStream, time: Duration) -> Self {
        let until = Instant::now() + time;
        Timed { stream, until }
    }

    fn left(&self) -> io::Result<Duration> {
        let left = self.until.saturating_duration_since(Instant::now());
        // A timeout of nothing would mean none.
        match left > Duration::from_millis(1) {
            true => Ok(left),
            false => Err(io::ErrorKind::TimedOut.into()),
        }
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(Some(self.left()?))?;
        self.stream.read(buffer)
    }
}

impl Write for Timed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(Some(self.left()?))?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// What a server answers.
pub trait Site: Sync {
    /// Refuses a request for what its head says, before anything of its body is read.
    fn refuse(&self, head: &Head) -> Option<Answer>;
    /// Answers a request.
    fn answer(&self, head: &Head, body: &str) -> Answer;
    /// Tells why a request is not answered.
    fn refusal(&self, refused: &Refused) -> Answer;
    /// Header lines of every answer: name and value.
    fn headers(&self) -> &[(&'static str, &'static str)];
}

/// A connection that is open.
struct Open {
    number: u64,
    stream: TcpStream,
    /// Its answer is being made.
    busy: bool,
}

/// The connections, and how many answers are being made.
#[derive(Default)]
struct Office {
    open: Mutex<Vec<Open>>,
    /// Threads that have not ended, also those whose connection has been given to another one.
    threads: AtomicUsize,
    answering: Mutex<usize>,
    free: Condvar,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Office {
    /// Takes a connection in, in the place of the oldest one that waits for its peer if there is no other; false if all are
    /// being answered.
    fn admit(&self, number: u64, stream: &TcpStream) -> bool {
        let Ok(stream) = stream.try_clone() else {
            return false;
        };
        let mut open = lock(&self.open);
        if open.len() >= MOST_CONNECTIONS {
            let Some(oldest) = open.iter().position(|o| !o.busy) else {
                return false;
            };
            // Its thread sees the end of the stream.
            let _ = open.remove(oldest).stream.shutdown(Shutdown::Both);
        }
        open.push(Open {
            number,
            stream,
            busy: false,
        });
        true
    }

    fn busy(&self, number: u64, busy: bool) {
        if let Some(own) = lock(&self.open).iter_mut().find(|o| o.number == number) {
            own.busy = busy;
        }
    }

    /// Makes an answer, as soon as not too many others are being made.
    fn work<T>(&self, number: u64, work: impl FnOnce() -> T) -> T {
        struct Turn<'a>(&'a Office, u64);
        impl Drop for Turn<'_> {
            fn drop(&mut self) {
                *lock(&self.0.answering) -= 1;
                self.0.free.notify_one();
                self.0.busy(self.1, false);
            }
        }
        self.busy(number, true);
        let mut answering = lock(&self.answering);
        while *answering >= ANSWERS {
            answering = self
                .free
                .wait(answering)
                .unwrap_or_else(PoisonError::into_inner);
        }
        *answering += 1;
        drop(answering);
        let _turn = Turn(self, number);
        work()
    }
}

/// Takes a connection off the list, whatever becomes of its thread.
struct Leave<'a>(&'a Office, u64);

impl Drop for Leave<'_> {
    fn drop(&mut self) {
        lock(&self.0.open).retain(|o| o.number != self.1);
        self.0.threads.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Answers the requests to `listener` until the process ends.
pub fn serve(listener: &TcpListener, site: &impl Site) {
    let office = Arc::new(Office::default());
    thread::scope(|scope| {
        for number in 0.. {
            let Ok((stream, _)) = listener.accept() else {
                // Too many files open, or a peer that has gone: no reason to end, nor to turn in a circle.
                thread::sleep(Duration::from_millis(50));
                continue;
            };
            // Those whose connection was closed to make room end soon.
            while office.threads.load(Ordering::SeqCst) >= MOST_CONNECTIONS + ANSWERS {
                thread::sleep(Duration::from_millis(1));
            }
            if !office.admit(number, &stream) {
                continue;
            }
            office.threads.fetch_add(1, Ordering::SeqCst);
            let own = Arc::clone(&office);
            let work = move || {
                let _leave = Leave(&own, number);
                // Whoever asked may have gone away meanwhile.
                let _ = converse(&stream, site, &own, number);
            };
            if thread::Builder::new().spawn_scoped(scope, work).is_err() {
                drop(Leave(&office, number));
            }
        }
    });
}

/// One request and its answer.
fn converse(stream: &TcpStream, site: &impl Site, office: &Office, number: u64) -> io::Result<()> {
    let mut arriving = Timed::new(stream, ARRIVE);
    let received = receive(&mut arriving, site)?;
    let (answer, silent) = match received {
        None => return Ok(()),
        Some(Received::Answered(answer, silent)) => (answer, silent),
        Some(Received::Asked(head, body)) => {
            let silent = head.method == "HEAD";
            (office.work(number, || site.answer(&head, &body)), silent)
        }
    };
    let mut text = format!("HTTP/1.1 {} {}\r\n", answer.status, phrase(answer.status));
    let own = [
        ("Content-Type", answer.content_type.to_owned()),
        ("Content-Length", answer.body.len().to_string()),
        ("Connection", "close".to_owned()),
    ];
    for (name, value) in &own {
        text.push_str(&format!("{name}: {value}\r\n"));
    }
    for (name, value) in site.headers() {
        text.push_str(&format!("{name}: {value}\r\n"));
    }
    text.push_str("\r\n");
    if !silent {
        text.push_str(&answer.body);
    }
    Timed::new(stream, TAKE).write_all(text.as_bytes())?;
    // A connection that is closed with something unread is reset, and the answer may be lost.
    stream.shutdown(Shutdown::Write)?;
    let mut rest = Timed::new(stream, CLOSE);
    let (mut buffer, mut read) = ([0; 8192], 0);
    while read < MOST_AFTER {
        match rest.read(&mut buffer)? {
            0 => break,
            more => read += more,
        }
    }
    Ok(())
}

enum Received {
    /// A request as it should be.
    Asked(Head, String),
    /// One that has its answer without its body; true if that answer has no body either.
    Answered(Answer, bool),
}

/// Reads a request; none if the peer has not sent any.
fn receive(stream: &mut Timed, site: &impl Site) -> io::Result<Option<Received>> {
    let refuse = |refused: Refused| Ok(Some(Received::Answered(site.refusal(&refused), false)));
    let mut bytes = Vec::new();
    let mut buffer = [0; 4096];
    let (head, end) = loop {
        match Head::parse(&bytes) {
            Ok(Some(found)) => break found,
            Ok(None) => (),
            Err(refused) => return refuse(refused),
        }
        match stream.read(&mut buffer)? {
            0 => return Ok(None),
            more => bytes.extend_from_slice(&buffer[..more]),
        }
    };
    if let Some(answer) = site.refuse(&head) {
        let silent = head.method == "HEAD";
        return Ok(Some(Received::Answered(answer, silent)));
    }
    if head.length > MOST_BODY {
        return refuse(Refused {
            status: 413,
            reason: format!("a request has at most {MOST_BODY} bytes"),
        });
    }
    let mut body = bytes.split_off(end);
    if head.continues && body.len() < head.length {
        stream.write_all(b"HTTP/1.1 100 Continue\r\n\r\n")?;
    }
    while body.len() < head.length {
        match stream.read(&mut buffer)? {
            0 => {
                return refuse(Refused {
                    status: 400,
                    reason: "the request ends before its body does".to_owned(),
                });
            }
            more => body.extend_from_slice(&buffer[..more]),
        }
    }
    // One request a connection: what follows is not looked at.
    body.truncate(head.length);
    match String::from_utf8(body) {
        Ok(body) => Ok(Some(Received::Asked(head, body))),
        Err(_) => refuse(Refused {
            status: 400,
            reason: "the request cannot be read: its body is no text".to_owned(),
        }),
    }
}

fn phrase(status: u16) -> &'static str {
    match status {
        200 => "OK",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        409 => "Conflict",
        411 => "Length Required",
        413 => "Content Too Large",
        415 => "Unsupported Media Type",
        431 => "Request Header Fields Too Large",
        _ => "Answer",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn status(text: &str) -> u16 {
        match Head::parse(text.as_bytes()) {
            Ok(Some(_)) => 200,
            Ok(None) => 0,
            Err(refused) => refused.status,
        }
    }

    #[test]
    fn a_head_is_read_in_one_way_or_refused() {
        let get = "GET /a?b HTTP/1.1\r\nHost: x\r\n";
        assert_eq!(status(get), 0);
        assert_eq!(status(&format!("{get}\r\n")), 200);
        let (head, end) = Head::parse(b"GET /a?b HTTP/1.1\r\nHOST: x:1 \r\n\r\nrest")
            .ok()
            .flatten()
            .expect("whole");
        assert_eq!(
            (head.path.as_str(), head.host.as_deref()),
            ("/a", Some("x:1"))
        );
        assert_eq!(end, 33);
        for (line, expected) in [
            ("Host: y", 400),
            ("host: x", 400),
            ("Content-Length: 1\r\nContent-Length: 1", 400),
            ("Content-Length: +1", 400),
            ("Content-Length: -1", 400),
            ("Content-Length: 1, 1", 400),
            ("Content-Length:", 400),
            ("Content-Length: 99999999999999999999999999", 200),
            ("Transfer-Encoding: chunked", 411),
            ("Origin: a\r\nOrigin: a", 400),
            ("Content-Type: a\r\ncontent-type: b", 400),
            ("no header", 400),
            ("a : b", 400),
            (" folded", 400),
            ("X: \0", 400),
        ] {
            assert_eq!(status(&format!("{get}{line}\r\n\r\n")), expected, "{line}");
        }
        for (first, expected) in [
            ("GET http://x/ HTTP/1.1", 400),
            ("CONNECT x:1 HTTP/1.1", 400),
            ("GET / HTTP/2.0", 400),
            ("GET /", 400),
            ("\u{16}\u{3}\u{1}", 400),
        ] {
            assert_eq!(status(&format!("{first}\r\n\r\n")), expected, "{first}");
        }
        let long = format!("{get}X: {}", "x".repeat(MOST_HEAD));
        assert_eq!(status(&long), 431);
        let many: String = (0..=MOST_HEADERS).map(|n| format!("X{n}: 1\r\n")).collect();
        assert_eq!(status(&format!("{get}{many}\r\n")), 431);
    }
}
