//! `snapload explore`: what it prints, how it ends, and that its files are those of `snapload run`.

use crate::common::{directory, listing, snapload};
use predicates::str::contains;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// The program, serving.
struct Serving {
    child: Child,
    /// Its address: host and port.
    host: String,
}

impl Serving {
    fn of(directory: &Path, args: &[&str]) -> Self {
        let mut child = Command::new(assert_cmd::cargo::cargo_bin!("snapload"))
            .current_dir(directory)
            .args(["explore", "--no-browser"])
            .args(args)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.as_mut().unwrap());
        out.read_line(&mut line).unwrap();
        let host = line
            .strip_prefix("http://")
            .and_then(|rest| rest.strip_suffix("/\n"));
        let host = host.unwrap_or_else(|| panic!("{line}")).to_owned();
        Self { child, host }
    }

    fn ask(&self, method: &str, path: &str, body: &str) -> (String, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        // With HTTP/1.0 the body ends with the connection.
        let head = format!(
            "{method} {path} HTTP/1.0\r\nHost: {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
            self.host,
            body.len()
        );
        stream.write_all(head.as_bytes()).unwrap();
        let mut read = Vec::new();
        stream.read_to_end(&mut read).unwrap();
        let at = read
            .windows(4)
            .position(|window| window == b"\r\n\r\n")
            .unwrap();
        let head = String::from_utf8(read[..at].to_vec()).unwrap();
        (head, read[at + 4..].to_vec())
    }

    fn file(&self, name: &str, values: &str) -> Vec<u8> {
        let body = format!("{{\"values\":{values}}}");
        let (head, body) = self.ask("POST", &format!("/api/export/{name}"), &body);
        assert!(head.starts_with("HTTP/1.0 200"), "{head}");
        assert!(
            head.contains(&format!("attachment; filename=\"{name}\"")),
            "{head}"
        );
        body
    }
}

impl Drop for Serving {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn every_file_has_the_bytes_of_the_command() {
    let d = directory();
    let serving = Serving::of(d.path(), &[]);
    for (values, set) in [
        ("{}", vec![]),
        (
            "{\"f_o\":0.1,\"a\":0.2,\"b\":0.1,\"stop_when_settled\":false,\"t_end\":20}",
            vec![
                "f_o=0.1",
                "a=0.2",
                "b=0.1",
                "stop_when_settled=false",
                "t_end=20",
            ],
        ),
    ] {
        let sets: Vec<&str> = set.iter().flat_map(|set| ["--set", set]).collect();
        snapload(d.path())
            .args(["run", "--out", "results"])
            .args(&sets)
            .assert()
            .success();
        let results = d.path().join("results");
        let names = listing(&results);
        assert_eq!(names.len(), 14, "{names:?}");
        for name in names {
            let expected = fs::read(results.join(&name)).unwrap();
            assert!(
                serving.file(&name, values) == expected,
                "{name} of {values} differs"
            );
        }
    }
}

#[test]
fn a_saved_case_runs_as_it_did() {
    let d = directory();
    let serving = Serving::of(d.path(), &[]);
    let values = "{\"f_o\":0.31,\"body\":\"point\",\"y\":0.2,\"stop_when_sliding\":true}";
    fs::write(
        d.path().join("mine.toml"),
        serving.file("case.toml", values),
    )
    .unwrap();
    snapload(d.path())
        .args(["run", "mine.toml", "--out", "results"])
        .assert()
        .success();
    let impacts = fs::read(d.path().join("results/impacts.csv")).unwrap();
    assert!(serving.file("impacts.csv", values) == impacts);
}

#[test]
fn the_page_begins_with_the_requested_case() {
    let d = directory();
    fs::write(d.path().join("mine.toml"), "a = 0.2\nf_o = 0.4\n").unwrap();
    for (args, start) in [
        (
            vec![],
            "\"start\":{\"name\":\"the standard case\",\"values\":{}}",
        ),
        (
            vec!["mine.toml", "--set", "e=0.7"],
            "\"start\":{\"name\":\"mine.toml: e = 0.7, a = 0.2, inertia = 0.04, f_o = 0.4\",\
             \"values\":{\"a\":0.2,\"e\":0.7,\"f_o\":0.4}}",
        ),
        (
            vec!["--case", "1920001000-359"],
            "\"start\":{\"name\":\"1920001000-359\",\"values\":{\"a\":0.2}}",
        ),
    ] {
        let serving = Serving::of(d.path(), &args);
        let (_, schema) = serving.ask("GET", "/api/schema", "");
        let schema = String::from_utf8(schema).unwrap();
        assert!(schema.contains(start), "{schema}");
        let (head, page) = serving.ask("GET", "/", "");
        assert!(head.starts_with("HTTP/1.0 200") && page.starts_with(b"<!doctype html>"));
    }
}

#[test]
fn it_listens_on_the_loopback_address_alone() {
    let d = directory();
    let serving = Serving::of(d.path(), &[]);
    let (host, port) = serving.host.split_once(':').unwrap();
    assert_eq!(host, "127.0.0.1");
    // The server does not listen on another loopback address, nor on that of IPv6.
    assert!(TcpStream::connect(format!("127.0.0.2:{port}")).is_err());
    assert!(TcpStream::connect(format!("[::1]:{port}")).is_err());
}

#[test]
fn an_interruption_is_how_it_ends() {
    let d = directory();
    for signal in ["-INT", "-TERM"] {
        let mut serving = Serving::of(d.path(), &[]);
        let id = serving.child.id().to_string();
        // An open connection does not keep the program from ending.
        let _open = TcpStream::connect(&serving.host).unwrap();
        let killed = Command::new("kill").args([signal, &id]).status().unwrap();
        assert!(killed.success());
        assert_eq!(serving.child.wait().unwrap().code(), Some(0));
    }
}

#[test]
fn what_can_not_be_explored_is_refused() {
    let d = directory();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let refuse = |args: &[&str], words: &'static str| {
        let mut command = snapload(d.path());
        let refused = command.args(["explore", "--no-browser"]).args(args);
        refused.assert().code(2).stderr(contains(words));
    };
    refuse(
        &["--port", &port],
        "in use\nhint: choose another port, or leave --port out",
    );
    refuse(&["--port", "70000"], "--port");
    refuse(
        &["--set", "e=2"],
        "e = 2 is not allowed; allowed: a number, 0 <= e <= 1",
    );
    refuse(&["nothing.toml"], "nothing.toml: there is no such file");
    fs::write(d.path().join("cylinder.toml"), "[body]\nmass = 1000.0\n").unwrap();
    // A structure is refused with the same message as by `assess`.
    refuse(&["cylinder.toml"], "site.depth (left out) is not allowed");
}
