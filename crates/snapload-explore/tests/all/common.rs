//! Shared by the tests of the server: a running server, and a minimal client.
use serde_json::{Value, json};
use snapload::{Entries, Parameters};
use snapload_explore::{Opened, Server, Start, Stop};
use snapload_structure::STRUCTURE;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::thread::JoinHandle;
use std::time::Duration;

/// A server on a free port, which ends with the test.
pub(crate) struct Running {
    pub(crate) port: u16,
    stop: Stop,
    thread: Option<JoinHandle<()>>,
}

/// Starts one that begins with the standard case.
pub(crate) fn serve() -> Running {
    run(|server| server)
}

/// Starts one that begins with the case of a structure.
pub(crate) fn serve_structure(name: &str, text: &str) -> Running {
    serve_changed_structure(name, text, &[])
}

/// The same with changes by `--set`.
pub(crate) fn serve_changed_structure(name: &str, text: &str, changes: &[&str]) -> Running {
    let mut entries = Entries::parse(&STRUCTURE, name, text).unwrap();
    changes.iter().for_each(|set| entries.set(set).unwrap());
    let opened = Opened {
        name: name.to_owned(),
        entries,
        changes: changes.iter().map(|&change| change.to_owned()).collect(),
        folder: None,
    };
    run(|server| server.opening(opened))
}

fn run(with: impl FnOnce(Server) -> Server) -> Running {
    let start = Start {
        name: "the standard case".to_owned(),
        parameters: Parameters::STANDARD,
    };
    let server = with(Server::bind(0, start).unwrap());
    let address = server.address();
    let port = address.trim_end_matches('/').rsplit(':').next().unwrap();
    Running {
        port: port.parse().unwrap(),
        stop: server.stop(),
        thread: Some(std::thread::spawn(move || server.serve().unwrap())),
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.now();
        if let Some(thread) = self.thread.take() {
            let ended = thread.join();
            assert!(std::thread::panicking() || ended.is_ok());
        }
    }
}

/// An answer of the server.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) head: String,
    pub(crate) body: Vec<u8>,
}

impl Answer {
    /// The body as JSON.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap()
    }

    /// What a refusal says.
    pub(crate) fn error(&self) -> String {
        self.json()["message"].as_str().unwrap().to_owned()
    }
}

impl Running {
    /// A connection to it.
    pub(crate) fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect((Ipv4Addr::LOCALHOST, self.port)).unwrap();
        let patience = Some(Duration::from_secs(30));
        stream.set_read_timeout(patience).unwrap();
        stream.set_write_timeout(patience).unwrap();
        stream
    }

    /// The text of a request, with the header lines given beside the necessary ones.
    pub(crate) fn request(&self, method: &str, path: &str, lines: &str, body: &str) -> String {
        // HTTP/1.0, whose bodies simply end with the connection.
        format!(
            "{method} {path} HTTP/1.0\r\nHost: 127.0.0.1:{}\r\nContent-Length: {}\r\n{lines}\r\n{body}",
            self.port,
            body.len()
        )
    }

    /// Sends bytes and reads the answer; none if there is no valid one.
    pub(crate) fn send(&self, bytes: &[u8]) -> Option<Answer> {
        let mut stream = self.connect();
        // The server may refuse before it has read all.
        let _ = stream.write_all(bytes);
        let mut read = Vec::new();
        let _ = stream.read_to_end(&mut read);
        let at = read.windows(4).position(|window| window == b"\r\n\r\n")?;
        let head = String::from_utf8(read[..at].to_vec()).unwrap();
        Some(Answer {
            status: head.split(' ').nth(1)?.parse().ok()?,
            head: head.to_lowercase(),
            body: read[at + 4..].to_vec(),
        })
    }

    /// Asks for a path.
    pub(crate) fn get(&self, path: &str) -> Answer {
        let request = self.request("GET", path, "", "");
        self.send(request.as_bytes()).unwrap()
    }

    /// Posts a body that is said to be JSON.
    pub(crate) fn post_text(&self, path: &str, body: &str) -> Answer {
        let kind = "Content-Type: application/json\r\n";
        let request = self.request("POST", path, kind, body);
        self.send(request.as_bytes()).unwrap()
    }

    /// Posts JSON.
    pub(crate) fn post(&self, path: &str, body: &Value) -> Answer {
        self.post_text(path, &body.to_string())
    }

    /// A run of some values.
    pub(crate) fn run(&self, values: Value) -> Value {
        let answer = self.post("/api/run", &json!({ "values": values }));
        assert_eq!(answer.status, 200, "{values}: {}", answer.error());
        answer.json()
    }
}
