//! Peers that do not keep to the rules: the server goes on answering, and what it holds stays bounded.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use super::api::FILE;
use super::served::Served;

/// Connects and sends these bytes; the stream, with a time for what comes back.
fn send(served: &Served, bytes: &[u8]) -> TcpStream {
    let mut stream = TcpStream::connect(served.host()).expect("it listens");
    stream
        .set_read_timeout(Some(Duration::from_secs(20)))
        .expect("a timeout");
    // The other side may have had enough before the end.
    let _ = stream.write_all(bytes);
    stream
}

/// The status of the answer; 0 if the connection is closed without one.
fn status(mut stream: TcpStream) -> u16 {
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    let answer = String::from_utf8_lossy(&answer);
    let status = answer.split(' ').nth(1).and_then(|s| s.parse().ok());
    status.unwrap_or(0)
}

fn is_there(served: &Served) {
    let start = Instant::now();
    assert_eq!(served.get("/").status, 200);
    assert!(start.elapsed() < Duration::from_secs(5));
}

#[test]
fn no_request_ends_the_server() {
    let served = Served::start(&[FILE]);
    let own = format!("Host: {}", served.host());
    let post = format!("POST /api/view HTTP/1.1\r\n{own}\r\nContent-Type: application/json\r\n");
    let foreign =
        "POST /api/view HTTP/1.1\r\nHost: attacker.example\r\nContent-Type: application/json\r\n";
    let get = format!("GET / HTTP/1.1\r\n{own}\r\n");
    let long = "x".repeat(1 << 20);
    for (bytes, expected) in [
        // Lengths that no memory holds, from pages of our own and of others.
        (
            format!("{post}Content-Length: 18446744073709551615\r\n\r\n"),
            413,
        ),
        (
            format!("{post}Content-Length: 9223372036854775807\r\n\r\n"),
            413,
        ),
        (
            format!("{post}Content-Length: 999999999999999999999999\r\n\r\n"),
            413,
        ),
        (
            format!("{foreign}Content-Length: 18446744073709551615\r\n\r\n"),
            403,
        ),
        (
            format!("{foreign}Content-Length: 4611686018427387904\r\n\r\n"),
            403,
        ),
        (
            format!("{get}Content-Length: 18446744073709551615\r\n\r\n"),
            413,
        ),
        (format!("{post}Content-Length: -1\r\n\r\n"), 400),
        (format!("{post}Content-Length: 0x10\r\n\r\n"), 400),
        (
            format!("{post}Content-Length: 2\r\nContent-Length: 3\r\n\r\n{{}}"),
            400,
        ),
        (
            format!("{post}Transfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n"),
            411,
        ),
        (
            format!("{post}Transfer-Encoding: chunked\r\nContent-Length: 2\r\n\r\n{{}}"),
            411,
        ),
        // Headers that decide, twice.
        (format!("{get}Host: attacker.example\r\n\r\n"), 400),
        (
            format!("GET / HTTP/1.1\r\nHost: attacker.example\r\n{own}\r\n\r\n"),
            400,
        ),
        (
            format!(
                "{get}Origin: http://{}\r\nOrigin: http://x\r\n\r\n",
                served.host()
            ),
            400,
        ),
        (
            format!("{post}Content-Type: text/plain\r\nContent-Length: 2\r\n\r\n{{}}"),
            400,
        ),
        (
            format!("GET http://attacker.example/ HTTP/1.1\r\n{own}\r\n\r\n"),
            400,
        ),
        // What is no request, or too much of one.
        (format!("GET /{long} HTTP/1.1\r\n{own}\r\n\r\n"), 431),
        (format!("{get}X: {long}\r\n\r\n"), 431),
        (format!("{get}{}\r\n", "X: 1\r\n".repeat(1000)), 431),
        (long.clone(), 431),
        ("\0".repeat(100), 400),
        ("\u{16}\u{3}\u{1}\u{2}".to_owned(), 400),
        (format!("GET / HTTP/9.9\r\n{own}\r\n\r\n"), 400),
        (format!("HEAD / HTTP/1.1\r\n{own}\r\n\r\n"), 405),
        (format!("GET /%00 HTTP/1.1\r\n{own}\r\n\r\n"), 404),
        // A second request behind the first one is not looked at.
        (
            format!("{get}\r\nGET /api/systems HTTP/1.1\r\n{own}\r\n\r\n"),
            200,
        ),
    ] {
        let found = status(send(&served, bytes.as_bytes()));
        let shown: String = bytes.chars().take(160).collect();
        assert_eq!(found, expected, "{shown:?}");
    }
    is_there(&served);
    // Whoever goes away in the middle is no loss.
    for bytes in [
        String::new(),
        get.clone(),
        format!("{post}Content-Length: 1000\r\n\r\n{{"),
        format!("{get}\r\n"),
    ] {
        drop(send(&served, bytes.as_bytes()));
    }
    let cut = send(
        &served,
        format!("{post}Content-Length: 10\r\n\r\n{{").as_bytes(),
    );
    cut.shutdown(std::net::Shutdown::Write).expect("shut down");
    assert_eq!(status(cut), 400);
    is_there(&served);
}

#[test]
fn connections_that_say_nothing_do_not_pile_up() {
    let served = Served::start(&[FILE]);
    let before = served.resources();
    let half = format!("GET / HTTP/1.1\r\nHost: {}\r\n", served.host());
    let mut open = Vec::new();
    for n in 0..300 {
        // Nothing at all, half a head, half a body in turn.
        let bytes = match n % 3 {
            0 => String::new(),
            1 => half.clone(),
            _ => format!(
                "POST /api/view {}Content-Type: application/json\r\nContent-Length: 9\r\n\r\n{{",
                half.trim_start_matches("GET / ")
            ),
        };
        open.push(send(&served, bytes.as_bytes()));
    }
    // All of them are still there on our side, and one that has something to say is answered.
    is_there(&served);
    let (files, threads) = served.resources();
    // A socket for the thread that reads it, and one for whoever ends it.
    assert!(files < before.0 + 80, "{files} files, {} before", before.0);
    assert!(
        threads < before.1 + 40,
        "{threads} threads, {} before",
        before.1
    );
    drop(open);
}

#[test]
fn a_peer_that_takes_its_time_is_cut_off() {
    let served = Served::start(&[FILE]);
    let start = Instant::now();
    let mut slow = send(&served, b"GET / HTTP/1.1\r\n");
    let mut closed = false;
    // One byte at a time: each of them arrives in time, the whole does not.
    for _ in 0..60 {
        std::thread::sleep(Duration::from_millis(250));
        if slow.write_all(b"X").is_err() {
            closed = true;
            break;
        }
    }
    assert!(closed, "still open after {:?}", start.elapsed());
    is_there(&served);
}
