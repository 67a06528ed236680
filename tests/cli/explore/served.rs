//! The running command, and requests to it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use serde_json::{Value, json};

/// The command, which ends with the value.
pub struct Served {
    child: Child,
    /// The address of the page, `http://127.0.0.1:PORT/`.
    pub url: String,
}

/// An answer.
pub struct Answer {
    pub status: u16,
    /// Header lines.
    pub head: String,
    pub body: String,
}

impl Served {
    /// Starts the command in the root of the workspace.
    pub fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_stillpoint"))
            .arg("explore")
            .args(arguments)
            .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."))
            .env("NO_COLOR", "1")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the binary runs");
        let mut line = String::new();
        let out = child.stdout.take().expect("a pipe");
        BufReader::new(out)
            .read_line(&mut line)
            .expect("a line with the address");
        let url = line.trim_end().to_owned();
        let served = Self { child, url };
        assert!(
            served.url.starts_with("http://127.0.0.1:"),
            "{:?}",
            served.url
        );
        served
    }

    /// The files that the command has open, and its threads.
    pub fn resources(&self) -> (usize, usize) {
        let count = |what: &str| {
            let folder = format!("/proc/{}/{what}", self.child.id());
            std::fs::read_dir(folder).expect("a process").count()
        };
        (count("fd"), count("task"))
    }

    /// Host name and port.
    pub fn host(&self) -> &str {
        self.url.trim_start_matches("http://").trim_end_matches('/')
    }

    /// Sends these lines as the head of a request, and a body.
    pub fn raw(&self, head: &[&str], body: &[u8]) -> Answer {
        let mut stream = TcpStream::connect(self.host()).expect("it listens");
        let mut sent = head.join("\r\n").into_bytes();
        sent.extend(b"\r\nConnection: close\r\n\r\n");
        sent.extend(body);
        // A refused request may be answered before it was read to its end.
        let _ = stream.write_all(&sent);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8(answer).expect("UTF-8");
        let (head, body) = answer.split_once("\r\n\r\n").unwrap_or((&answer, ""));
        let status = head.split(' ').nth(1).and_then(|s| s.parse().ok());
        Answer {
            status: status.unwrap_or_else(|| panic!("no status in {head:?}")),
            head: head.to_owned(),
            body: body.to_owned(),
        }
    }

    pub fn get(&self, path: &str) -> Answer {
        let host = format!("Host: {}", self.host());
        self.raw(&[&format!("GET {path} HTTP/1.1"), &host], b"")
    }

    pub fn post(&self, path: &str, body: &str) -> Answer {
        let lines = [
            format!("POST {path} HTTP/1.1"),
            format!("Host: {}", self.host()),
            "Content-Type: application/json".to_owned(),
            format!("Content-Length: {}", body.len()),
        ];
        let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
        self.raw(&lines, body.as_bytes())
    }

    /// A good answer as JSON.
    pub fn json(&self, answer: &Answer) -> Value {
        assert_eq!(answer.status, 200, "{}", answer.body);
        serde_json::from_str(&answer.body).unwrap_or_else(|e| panic!("{e}: {}", answer.body))
    }

    pub fn systems(&self) -> Value {
        self.json(&self.get("/api/systems"))
    }

    /// The body of a request about the first system.
    pub fn about(&self, more: Value) -> String {
        let systems = self.systems();
        let mut body = json!({
            "system": systems["systems"][0]["name"], "hash": systems["systems"][0]["hash"],
        });
        let fields = more.as_object().expect("an object");
        for (key, value) in fields {
            body[key] = value.clone();
        }
        body.to_string()
    }

    /// What a walk through the first system shows.
    pub fn view(&self, more: Value) -> Value {
        self.json(&self.post("/api/view", &self.about(more)))
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
