//! The Chrome DevTools Protocol over a pipe: JSON documents, each ended by a zero byte.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::process::{ChildStdin, ChildStdout};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// No answer takes this long; a browser that hangs fails the test instead of holding it.
const PATIENCE: Duration = Duration::from_secs(60);

/// Both directions, and the events that came in meanwhile.
pub struct Pipe {
    to: ChildStdin,
    from: Receiver<Value>,
    events: Vec<Value>,
    last_id: u64,
}

impl Pipe {
    pub fn new(to: ChildStdin, from: ChildStdout) -> Self {
        let (sender, receiver) = channel();
        std::thread::spawn(move || {
            let mut from = BufReader::new(from);
            let mut message = Vec::new();
            while from.read_until(0, &mut message).is_ok_and(|read| read > 0) {
                message.pop();
                let read = serde_json::from_slice(&message).ok();
                if read.is_some_and(|value| sender.send(value).is_err()) {
                    return;
                }
                message.clear();
            }
        });
        Self { to, from: receiver, events: Vec::new(), last_id: 0 }
    }

    /// Calls a method and waits for what it gives; `session` is empty for the browser itself.
    pub fn call(&mut self, session: &str, method: &str, params: Value) -> Value {
        let id = self.send(session, method, params);
        loop {
            let message = self.next(method);
            if message["id"] == id {
                assert!(message["error"].is_null(), "{method}: {}", message["error"]);
                return message["result"].clone();
            }
            self.take(message);
        }
    }

    /// Waits for an event of a session, or takes it from those that came in already.
    pub fn wait(&mut self, session: &str, method: &str) {
        let is_it = |event: &Value| event["method"] == method && event["sessionId"] == session;
        while !self.events.iter().any(is_it) {
            let message = self.next(method);
            self.take(message);
        }
    }

    /// The events of a session so far.
    pub fn events(&self, session: &str) -> impl Iterator<Item = &Value> {
        self.events.iter().filter(move |event| event["sessionId"] == session)
    }

    fn send(&mut self, session: &str, method: &str, params: Value) -> u64 {
        self.last_id += 1;
        let mut message = json!({ "id": self.last_id, "method": method, "params": params });
        if !session.is_empty() {
            message["sessionId"] = session.into();
        }
        let mut bytes = serde_json::to_vec(&message).unwrap();
        bytes.push(0);
        self.to.write_all(&bytes).unwrap_or_else(|error| panic!("{method}: Chromium is gone: {error}"));
        self.last_id
    }

    fn next(&mut self, method: &str) -> Value {
        self.from.recv_timeout(PATIENCE).unwrap_or_else(|error| panic!("{method}: nothing from Chromium: {error}"))
    }

    /// Keeps an event; a dialog is also dismissed, or the page would stand still.
    fn take(&mut self, message: Value) {
        if message["method"] == "Page.javascriptDialogOpening" {
            let session = message["sessionId"].as_str().unwrap_or_default().to_owned();
            self.send(&session, "Page.handleJavaScriptDialog", json!({ "accept": false }));
        }
        if message["method"].is_string() {
            self.events.push(message);
        }
    }
}
