//! The page and its interface over HTTP, bound to loopback.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};

use serde_json::{Value, json};

use super::http::{self, Answer, Head, Refused, Site};
use super::{Walks, api, view};

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The page is all that may be loaded; styles also stand in the diagram.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; \
                      img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

const HTML: &str = "text/html; charset=utf-8";
const JSON: &str = "application/json";

const HEADERS: [(&str, &str); 5] = [
    ("Cache-Control", "no-store"),
    ("Content-Security-Policy", POLICY),
    ("X-Content-Type-Options", "nosniff"),
    ("Referrer-Policy", "no-referrer"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
];

/// A server that listens already.
pub struct Listening {
    listener: TcpListener,
    address: SocketAddr,
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
        let wanted = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let fail =
            |e: std::io::Error| format!("cannot listen on {wanted}: {e}; choose another --port");
        let listener = TcpListener::bind(wanted).map_err(fail)?;
        let address = listener.local_addr().map_err(fail)?;
        Ok(Self { listener, address })
    }

    /// The address of the page.
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Answers requests until the process ends.
    pub fn serve(self, walks: &Walks) {
        let port = self.address.port();
        http::serve(&self.listener, &Pages { walks, port });
    }
}

/// The page and its interface.
struct Pages<'a> {
    walks: &'a Walks,
    port: u16,
}

impl Site for Pages<'_> {
    fn refuse(&self, head: &Head) -> Option<Answer> {
        refused(head, self.port)
    }

    fn answer(&self, head: &Head, body: &str) -> Answer {
        routed(self.walks, head, body)
    }

    fn refusal(&self, refused: &Refused) -> Answer {
        Answer::refusal(refused.status, &refused.reason)
    }

    fn headers(&self) -> &[(&'static str, &'static str)] {
        &HEADERS
    }
}

/// Whether `authority` is a name of this host with our port: a page of somebody else may reach us under a name that it
/// resolves to loopback, but its requests carry that name.
fn ours(authority: &str, port: u16) -> bool {
    ["127.0.0.1", "localhost"]
        .iter()
        .any(|name| authority.eq_ignore_ascii_case(&format!("{name}:{port}")))
        || port == 80 && ["127.0.0.1", "localhost"].contains(&authority)
}

fn refused(asked: &Head, port: u16) -> Option<Answer> {
    if !asked.host.as_deref().is_some_and(|host| ours(host, port)) {
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
    if asked.origin.as_deref().is_some_and(|origin| !own(origin)) {
        return Some(Answer::refusal(403, "a request of another page"));
    }
    let wanted = match asked.path.as_str() {
        "/" | "/page.css" | "/page.js" | "/api/systems" => "GET",
        "/api/view" | "/api/run" | "/api/control" | "/api/diagram" | "/api/recording" => "POST",
        _ => {
            return Some(Answer::refusal(404, "there is nothing under this address"));
        }
    };
    if asked.method != wanted {
        return Some(Answer::refusal(
            405,
            &format!("this address takes {wanted}"),
        ));
    }
    let json = |kind: &str| kind.split(';').next().is_some_and(|k| k.trim() == JSON);
    if wanted == "POST" && !asked.content_type.as_deref().is_some_and(json) {
        return Some(Answer::refusal(
            415,
            "the content type is to be application/json",
        ));
    }
    None
}

fn routed(walks: &Walks, asked: &Head, body: &str) -> Answer {
    let json = |found: Result<Value, api::Refusal>| match found {
        Ok(value) => Answer::new(JSON, value.to_string()),
        Err(refusal) => Answer::refusal(refusal.status, &refusal.reason),
    };
    match asked.path.as_str() {
        "/" => Answer::new(HTML, PAGE),
        "/page.css" => Answer::new("text/css; charset=utf-8", STYLE),
        "/page.js" => Answer::new("text/javascript; charset=utf-8", SCRIPT),
        "/api/systems" => json(Ok(view::systems(walks))),
        "/api/view" => json(api::view(walks, body)),
        "/api/run" => json(api::run(walks, body)),
        "/api/control" => json(api::control(walks, body)),
        "/api/diagram" => match api::svg(walks, body) {
            Ok(svg) => Answer::new("image/svg+xml", svg),
            Err(refusal) => Answer::refusal(refusal.status, &refusal.reason),
        },
        "/api/recording" => match api::recording(walks, body) {
            Ok(lines) => Answer::new("application/x-ndjson", lines),
            Err(refusal) => Answer::refusal(refusal.status, &refusal.reason),
        },
        _ => Answer::refusal(404, "there is nothing under this address"),
    }
}
