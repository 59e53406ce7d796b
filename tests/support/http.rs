//! A served store, and a client that speaks plain HTTP/1.1, so that requests can be sent which no browser would send.

use super::store::Store;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};

/// `furrow browse`, until it is dropped.
pub struct Served {
    child: Child,
    pub url: String,
    pub port: u16,
}

impl Served {
    pub fn start(store: &Store) -> Self {
        let mut child =
            store.furrow("browse --json").into_command().stdout(Stdio::piped()).spawn().expect("furrow starts");
        let mut printed = String::new();
        let mut stdout = BufReader::new(child.stdout.take().unwrap());
        let address: Value = loop {
            assert!(stdout.read_line(&mut printed).unwrap() > 0, "furrow browse ended: {printed}");
            if let Ok(address) = serde_json::from_str(&printed) {
                break address;
            }
        };
        let port = address["port"].as_u64().unwrap() as u16;
        Self { child, url: address["url"].as_str().unwrap().to_owned(), port }
    }

    /// Asks for a path as a browser would.
    pub fn get(&self, path: &str) -> Reply {
        self.send(&format!("GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n\r\n", self.port))
    }

    /// A page that must be there.
    pub fn page(&self, path: &str) -> String {
        let reply = self.get(path);
        assert_eq!(reply.status, 200, "{path}: {}", reply.text());
        reply.text()
    }

    /// A JSON document that must be there.
    pub fn json(&self, path: &str) -> Value {
        serde_json::from_str(&self.page(path)).unwrap()
    }

    /// Sends a request as it is.
    pub fn send(&self, request: &str) -> Reply {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).unwrap();
        let head = bytes.windows(4).position(|four| four == b"\r\n\r\n").expect("a head");
        let lines = String::from_utf8(bytes[..head].to_vec()).unwrap();
        let status = lines.split(' ').nth(1).unwrap().parse().unwrap();
        Reply { status, head: lines.to_ascii_lowercase(), body: bytes[head + 4..].to_vec() }
    }

    /// Sends the signal of Ctrl-C and waits: the exit code.
    pub fn interrupt(mut self) -> Option<i32> {
        let id = self.child.id().to_string();
        assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
        self.child.wait().unwrap().code()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What came back.
pub struct Reply {
    pub status: u16,
    /// Status line and headers, in small letters.
    pub head: String,
    pub body: Vec<u8>,
}

impl Reply {
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }
}
