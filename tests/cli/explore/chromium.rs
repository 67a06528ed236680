//! A headless Chromium, driven over its DevTools protocol through two pipes.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// How long the page may take for anything.
const PATIENCE: Duration = Duration::from_secs(60);

/// The names of the browser, in the order of preference.
const NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

fn program() -> Option<&'static str> {
    let runs = |name: &&str| Command::new(name).arg("--version").output().is_ok();
    NAMES.into_iter().find(runs)
}

/// Whether Chromium is there. Who has none sees that the test was skipped; where the environment has `CI`, it fails then.
pub fn available() -> bool {
    if program().is_some() {
        return true;
    }
    let message = "SKIPPED: chromium is not installed";
    assert!(std::env::var_os("CI").is_none(), "{message}");
    eprintln!("{message}");
    false
}

/// A browser with one page.
pub struct Page {
    browser: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    profile: std::path::PathBuf,
    session: String,
    sent: u64,
    /// Messages of the page's scripts that tell of an error.
    pub errors: Vec<String>,
}

impl Page {
    /// Opens an empty page of this size.
    pub fn open(name: &str, width: u32, height: u32) -> Self {
        let profile = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"))
            .join(format!("chromium-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&profile);
        // Chromium reads commands from descriptor 3 and answers on 4: the pipes that are made as 0 and 1.
        let mut browser = Command::new("sh")
            .args([
                "-c",
                "exec \"$@\" 3<&0 4>&1 0</dev/null 1>/dev/null",
                "sh",
                program().expect("a browser"),
            ])
            .args([
                "--headless",
                "--remote-debugging-pipe",
                "--no-sandbox",
                "--disable-gpu",
                "--hide-scrollbars",
                "--disable-quic",
                "--disable-dev-shm-usage",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
                "--no-first-run",
            ])
            .arg(format!("--user-data-dir={}", profile.display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("a shell");
        let to = browser.stdin.take().expect("a pipe");
        let from = BufReader::new(browser.stdout.take().expect("a pipe"));
        let mut page = Self {
            browser,
            to,
            from,
            profile,
            session: String::new(),
            sent: 0,
            errors: Vec::new(),
        };
        let target = page.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attached = page.call(
            "Target.attachToTarget",
            json!({ "targetId": target["targetId"], "flatten": true }),
        );
        page.session = attached["sessionId"]
            .as_str()
            .expect("a session")
            .to_owned();
        page.call("Page.enable", json!({}));
        page.call("Runtime.enable", json!({}));
        page.size(width, height, "light");
        page
    }

    /// The size of the window in pixels, and the colours the user prefers.
    pub fn size(&mut self, width: u32, height: u32, colours: &str) {
        self.call(
            "Emulation.setDeviceMetricsOverride",
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false }),
        );
        let feature = json!({ "name": "prefers-color-scheme", "value": colours });
        self.call(
            "Emulation.setEmulatedMedia",
            json!({ "features": [feature] }),
        );
    }

    /// Calls a method of the protocol.
    pub fn call(&mut self, method: &str, params: Value) -> Value {
        self.sent += 1;
        let id = self.sent;
        let mut message = json!({ "id": id, "method": method, "params": params });
        if !self.session.is_empty() {
            message["sessionId"] = json!(self.session);
        }
        let mut bytes = message.to_string().into_bytes();
        bytes.push(0);
        self.to.write_all(&bytes).expect("the browser runs");
        self.to.flush().expect("the browser runs");
        loop {
            let mut line = Vec::new();
            let n = self.from.read_until(0, &mut line).expect("readable");
            assert!(n > 0, "the browser has ended during {method}");
            line.pop();
            let told: Value = serde_json::from_slice(&line).expect("JSON");
            if told["method"] == "Runtime.exceptionThrown" {
                self.errors.push(told["params"].to_string());
            }
            if told["id"] == id {
                assert!(told.get("error").is_none(), "{method}: {told}");
                return told["result"].clone();
            }
        }
    }

    /// The value of an expression of JavaScript.
    pub fn value(&mut self, expression: &str) -> Value {
        let result = self.call(
            "Runtime.evaluate",
            json!({ "expression": expression, "returnByValue": true }),
        );
        assert!(
            result.get("exceptionDetails").is_none(),
            "{expression}: {result}"
        );
        result["result"]["value"].clone()
    }

    /// The same as text.
    pub fn text(&mut self, expression: &str) -> String {
        match self.value(expression) {
            Value::String(text) => text,
            other => other.to_string(),
        }
    }

    /// Waits until an expression is TRUE.
    pub fn wait(&mut self, expression: &str) {
        let begin = Instant::now();
        while self.value(expression) != true {
            if begin.elapsed() > PATIENCE {
                let seen = self.text("document.body ? document.body.innerText : ''");
                panic!(
                    "in vain waited for {expression}; errors {:?}; the page:\n{seen}",
                    self.errors
                );
            }
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Loads an address anew.
    pub fn visit(&mut self, url: &str) {
        self.call("Page.navigate", json!({ "url": "about:blank" }));
        self.wait("location.href === 'about:blank'");
        self.call("Page.navigate", json!({ "url": url }));
        self.wait("document.readyState === 'complete'");
    }

    /// Presses a key that the browser calls by this name.
    pub fn press(&mut self, key: &str) {
        let mut down = json!({ "type": "keyDown", "key": key });
        if key == "Escape" {
            // A dialogue is closed by the key's number.
            down["windowsVirtualKeyCode"] = json!(27);
        }
        if key.chars().count() == 1 {
            down["text"] = json!(key);
        }
        self.call("Input.dispatchKeyEvent", down);
        self.call(
            "Input.dispatchKeyEvent",
            json!({ "type": "keyUp", "key": key }),
        );
    }

    /// Clicks on the middle of the first element that a selector finds.
    pub fn click(&mut self, selector: &str) {
        let place = format!(
            "(() => {{ const e = document.querySelector({selector:?}); e.scrollIntoView({{ block: 'center' }});
               const r = e.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; }})()"
        );
        let place = self.value(&place);
        for kind in ["mousePressed", "mouseReleased"] {
            self.call(
                "Input.dispatchMouseEvent",
                json!({ "type": kind, "x": place[0], "y": place[1], "button": "left", "clickCount": 1 }),
            );
        }
    }

    /// A picture of the whole page, into the folder that `STILLPOINT_SHOTS` names, if it does.
    pub fn shot(&mut self, name: &str) {
        let Some(folder) = std::env::var_os("STILLPOINT_SHOTS") else {
            return;
        };
        let taken = self.call(
            "Page.captureScreenshot",
            json!({ "format": "png", "captureBeyondViewport": true }),
        );
        let data = taken["data"].as_str().expect("a picture");
        let path = std::path::Path::new(&folder).join(format!("{name}.png.base64"));
        std::fs::write(path, data).expect("written");
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        // Its helpers end with it when it finds its pipe closed; the one that was started is ended for sure.
        let _ = self
            .to
            .write_all(b"{\"id\":0,\"method\":\"Browser.close\"}\0");
        let _ = self.to.flush();
        let begin = Instant::now();
        while matches!(self.browser.try_wait(), Ok(None))
            && begin.elapsed() < Duration::from_secs(5)
        {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.browser.kill();
        let _ = self.browser.wait();
        let _ = std::fs::remove_dir_all(&self.profile);
    }
}
