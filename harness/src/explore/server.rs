//! The page and its interface over HTTP, bound to loopback.

use std::io::Read;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::Arc;

use serde_json::{Value, json};
use tiny_http::{Header, Method, Request, Response, Server};

use super::{Explorer, api, view};

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The most bytes of a request's body.
const MOST_BODY: u64 = 1 << 20;
/// Requests answered at the same time; an exploration occupies one.
const THREADS: usize = 4;

/// The page is all that may be loaded; styles also stand in the diagram.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; \
                      img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

const HTML: &str = "text/html; charset=utf-8";
const JSON: &str = "application/json";

/// A server that listens already.
pub struct Listening {
    server: Arc<Server>,
    address: SocketAddr,
}

/// What came with a request and decides about it.
struct Asked<'a> {
    method: &'a Method,
    path: &'a str,
    host: Option<&'a str>,
    origin: Option<&'a str>,
    content_type: Option<&'a str>,
}

/// An answer.
struct Answer {
    status: u16,
    content_type: &'static str,
    body: String,
}

impl Answer {
    fn new(content_type: &'static str, body: impl Into<String>) -> Self {
        Self {
            status: 200,
            content_type,
            body: body.into(),
        }
    }

    fn refusal(status: u16, reason: &str) -> Self {
        Self {
            status,
            content_type: JSON,
            body: json!({ "error": reason }).to_string(),
        }
    }
}

impl Listening {
    /// Listens on 127.0.0.1; port 0 takes a free one.
    ///
    /// # Errors
    /// A port that is taken or not allowed, in a sentence.
    pub fn new(port: u16) -> Result<Self, String> {
        let wanted = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), port);
        let fail =
            |reason: &str| format!("cannot listen on {wanted}: {reason}; choose another --port");
        let server = Server::http(wanted).map_err(|e| fail(&e.to_string()))?;
        let address = server
            .server_addr()
            .to_ip()
            .ok_or_else(|| fail("it has no address"))?;
        Ok(Self {
            server: Arc::new(server),
            address,
        })
    }

    /// The address of the page.
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Answers requests until the process ends.
    pub fn serve(self, explorer: &Explorer) {
        let port = self.address.port();
        std::thread::scope(|scope| {
            for _ in 0..THREADS {
                let server = Arc::clone(&self.server);
                scope.spawn(move || {
                    for request in server.incoming_requests() {
                        answer(explorer, port, request);
                    }
                });
            }
        });
    }
}

fn answer(explorer: &Explorer, port: u16, mut request: Request) {
    let header = |name: &str| {
        let mut all = request.headers().iter();
        let found = all.find(|h| h.field.as_str().as_str().eq_ignore_ascii_case(name));
        found.map(|h| h.value.as_str().to_owned())
    };
    let (host, origin, kind) = (header("host"), header("origin"), header("content-type"));
    let (method, url) = (request.method().clone(), request.url().to_owned());
    let asked = Asked {
        method: &method,
        path: url.split(['?', '#']).next().unwrap_or_default(),
        host: host.as_deref(),
        origin: origin.as_deref(),
        content_type: kind.as_deref(),
    };
    let answer = match refused(&asked, port) {
        Some(answer) => answer,
        None => {
            let mut body = String::new();
            let mut reader = request.as_reader().take(MOST_BODY + 1);
            match reader.read_to_string(&mut body) {
                Err(e) => Answer::refusal(400, &format!("the request cannot be read: {e}")),
                Ok(_) if body.len() as u64 > MOST_BODY => {
                    Answer::refusal(413, &format!("a request has at most {MOST_BODY} bytes"))
                }
                Ok(_) => routed(explorer, &asked, &body),
            }
        }
    };
    let mut response = Response::from_string(answer.body)
        .with_status_code(answer.status)
        .with_chunked_threshold(usize::MAX);
    for (name, value) in [
        ("Content-Type", answer.content_type),
        ("Cache-Control", "no-store"),
        ("Content-Security-Policy", POLICY),
        ("X-Content-Type-Options", "nosniff"),
        ("Referrer-Policy", "no-referrer"),
        ("Cross-Origin-Resource-Policy", "same-origin"),
    ] {
        if let Ok(header) = Header::from_bytes(name, value) {
            response.add_header(header);
        }
    }
    // Whoever asked may have gone away meanwhile.
    let _ = request.respond(response);
}

/// Whether `authority` is a name of this host with our port: a page of somebody else may reach us under a name that it
/// resolves to loopback, but its requests carry that name.
fn ours(authority: &str, port: u16) -> bool {
    ["127.0.0.1", "localhost"]
        .iter()
        .any(|name| authority.eq_ignore_ascii_case(&format!("{name}:{port}")))
        || port == 80 && ["127.0.0.1", "localhost"].contains(&authority)
}

fn refused(asked: &Asked, port: u16) -> Option<Answer> {
    if !asked.host.is_some_and(|host| ours(host, port)) {
        return Some(Answer::refusal(
            403,
            "the page is to be opened under 127.0.0.1 or localhost, with its port",
        ));
    }
    let own = |origin: &str| {
        origin
            .strip_prefix("http://")
            .is_some_and(|o| ours(o, port))
    };
    if asked.origin.is_some_and(|origin| !own(origin)) {
        return Some(Answer::refusal(403, "a request of another page"));
    }
    let wanted = match asked.path {
        "/" | "/page.css" | "/page.js" | "/api/systems" => Method::Get,
        "/api/view" | "/api/run" | "/api/control" | "/api/diagram" | "/api/recording" => {
            Method::Post
        }
        _ => {
            return Some(Answer::refusal(404, "there is nothing under this address"));
        }
    };
    if *asked.method != wanted {
        return Some(Answer::refusal(
            405,
            &format!("this address takes {wanted}"),
        ));
    }
    let json = |kind: &str| kind.split(';').next().is_some_and(|k| k.trim() == JSON);
    if wanted == Method::Post && !asked.content_type.is_some_and(json) {
        return Some(Answer::refusal(
            415,
            "the content type is to be application/json",
        ));
    }
    None
}

fn routed(explorer: &Explorer, asked: &Asked, body: &str) -> Answer {
    let json = |found: Result<Value, api::Refusal>| match found {
        Ok(value) => Answer::new(JSON, value.to_string()),
        Err(refusal) => Answer::refusal(refusal.status, &refusal.reason),
    };
    match asked.path {
        "/" => Answer::new(HTML, PAGE),
        "/page.css" => Answer::new("text/css; charset=utf-8", STYLE),
        "/page.js" => Answer::new("text/javascript; charset=utf-8", SCRIPT),
        "/api/systems" => json(Ok(view::systems(explorer))),
        "/api/view" => json(api::view(explorer, body)),
        "/api/run" => json(api::run(explorer, body)),
        "/api/control" => json(api::control(explorer, body)),
        "/api/diagram" => match api::svg(explorer, body) {
            Ok(svg) => Answer::new("image/svg+xml", svg),
            Err(refusal) => Answer::refusal(refusal.status, &refusal.reason),
        },
        "/api/recording" => match api::recording(explorer, body) {
            Ok(lines) => Answer::new("application/x-ndjson", lines),
            Err(refusal) => Answer::refusal(refusal.status, &refusal.reason),
        },
        _ => Answer::refusal(404, "there is nothing under this address"),
    }
}
