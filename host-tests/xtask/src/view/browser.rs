//! Chromium without a window, by its own protocol over a pipe.

use super::CHROMIUM;
use crate::steps::{Failure, Outcome};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

/// How long an answer may take.
const PATIENCE: Duration = Duration::from_secs(30);
/// The browser reads commands from the third file and writes to the fourth: those of this program's pipes.
const PIPES: &str = "exec 3<&0 4>&1 1>&2 0</dev/null; exec \"$0\" \"$@\"";
/// What ends a message.
const END: u8 = 0;

/// A browser with one page. It ends with this.
pub struct Browser {
    child: Child,
    commands: ChildStdin,
    messages: Receiver<Value>,
    last: u64,
    session: Option<String>,
    /// What was told without being asked for, in its order.
    events: Vec<Value>,
    _profile: TempDir,
}

impl Browser {
    /// Starts a browser and opens an empty page.
    pub fn start() -> Outcome<Self> {
        let failed = |e: std::io::Error| Failure::new(format!("{CHROMIUM}: {e}"));
        let profile = tempfile::tempdir().map_err(failed)?;
        let mut command = Command::new("sh");
        command.args(["-c", PIPES, CHROMIUM, "--headless=new", "--remote-debugging-pipe", "--disable-gpu"]);
        // It runs the repository's own page alone, often where it has no sandbox: in a container, as root.
        command.args(["--no-sandbox", "--no-first-run", "--disable-background-networking"]);
        // Its two cameras are test patterns that may be looked at.
        command.args(["--use-fake-device-for-media-stream=device-count=2", "--use-fake-ui-for-media-stream"]);
        command.arg(format!("--user-data-dir={}", profile.path().display()));
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().map_err(failed)?;
        let (Some(commands), Some(answers)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(Failure::new(format!("{CHROMIUM}: has no pipes")));
        };
        let (tell, messages) = channel();
        thread::spawn(move || {
            for message in BufReader::new(answers).split(END).map_while(Result::ok) {
                let parsed = serde_json::from_slice::<Value>(&message);
                if parsed.is_ok_and(|message| tell.send(message).is_err()) {
                    break;
                }
            }
        });
        let events = Vec::new();
        let mut browser =
            Self { child, commands, messages, last: 0, session: None, events, _profile: profile };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }))?;
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", attach)?;
        browser.session = session["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Network", "DOM"] {
            browser.call(&format!("{domain}.enable"), json!({}))?;
        }
        Ok(browser)
    }

    /// Calls a method of the protocol; its result.
    pub fn call(&mut self, method: &str, params: Value) -> Outcome<Value> {
        self.last += 1;
        let mut message = json!({ "id": self.last, "method": method, "params": params });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let failed = |e: &dyn std::fmt::Display| Failure::new(format!("{CHROMIUM}: {method}: {e}"));
        let mut bytes = message.to_string().into_bytes();
        bytes.push(END);
        self.commands.write_all(&bytes).and_then(|()| self.commands.flush()).map_err(|e| failed(&e))?;
        loop {
            let mut message = self.messages.recv_timeout(PATIENCE).map_err(|e| failed(&e))?;
            if message["id"] != self.last {
                self.events.push(message);
            } else if message["error"].is_null() {
                return Ok(message["result"].take());
            } else {
                return Err(failed(&message["error"]));
            }
        }
    }

    /// Opens a place and waits until it is loaded.
    pub fn open(&mut self, url: &str) -> Outcome {
        self.events("Page.loadEventFired");
        let answer = self.call("Page.navigate", json!({ "url": url }))?;
        if let Some(error) = answer["errorText"].as_str() {
            return Err(Failure::new(format!("{url}: {error}")));
        }
        for _ in 0..PATIENCE.as_millis() / 10 {
            // What was told meanwhile comes with the next answer.
            self.value("document.readyState")?;
            if !self.events("Page.loadEventFired").is_empty() {
                return Ok(());
            }
            thread::sleep(Duration::from_millis(10));
        }
        Err(Failure::new(format!("{url}: does not load")))
    }

    /// The value of an expression in the page, which may be a promise; what it throws is a failure.
    pub fn value(&mut self, expression: &str) -> Outcome<Value> {
        let params = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let mut result = self.call("Runtime.evaluate", params)?;
        let thrown = &result["exceptionDetails"];
        if thrown.is_null() {
            return Ok(result["result"]["value"].take());
        }
        let said = thrown["exception"]["description"].as_str().unwrap_or("an exception");
        Err(Failure::new(format!("{expression}: {said}")))
    }

    /// What was told of a kind since it was last asked for.
    pub fn events(&mut self, method: &str) -> Vec<Value> {
        let (told, rest) =
            std::mem::take(&mut self.events).into_iter().partition(|event| event["method"] == method);
        self.events = rest;
        told
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // One that is gone already needs no more.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
