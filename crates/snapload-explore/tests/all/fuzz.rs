//! The server refuses every malformed request, and keeps running.

use crate::common::{Running, serve};
use snapload::KEYS;
use std::io::{Read, Write};
use std::net::Shutdown;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Numbers from a seed: SplitMix64 (Steele, Lea, Flood 2014).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn bytes(&mut self, most: usize) -> Vec<u8> {
        let length = self.below(most);
        (0..length).map(|_| self.next() as u8).collect()
    }

    /// Some bytes changed, put in, taken out, or written twice.
    fn mutated(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        for _ in 0..=self.below(6) {
            let at = self.below(bytes.len());
            match self.below(5) {
                0 => bytes[at] = self.next() as u8,
                1 => bytes[at] ^= 1 << self.below(8),
                2 => bytes.insert(at, self.next() as u8),
                3 => bytes.truncate(at + 1),
                _ => bytes.extend_from_within(at..),
            }
        }
        bytes
    }
}

/// The case of a structure, for a few seconds.
const STRUCTURE: &str = r#"{"name":"a.toml","text":"[body]\nmass=1000\ndisplaced_volume=2\nwidth=1\nposition=[0,-3]\n[[line]]\nanchor=[0,-10]\nfairlead=[0,-3.5]\nlength=6.4\n[site]\ndepth=10\n[wave]\nheight=1\nperiod=5\n[run]\nrestitution=0.5\nduration=5\n"}"#;

/// Panics of any thread, counted by the hook.
static PANICS: AtomicUsize = AtomicUsize::new(0);

/// The server still answers at once, and no thread panicked.
fn is_well(server: &Running) {
    let began = Instant::now();
    let schema = server.get("/api/schema");
    assert_eq!(schema.status, 200);
    assert_eq!(schema.json()["keys"].as_array().unwrap().len(), KEYS.len());
    assert!(
        began.elapsed() < Duration::from_secs(5),
        "{:?}",
        began.elapsed()
    );
    assert_eq!(PANICS.load(Ordering::Relaxed), 0);
}

fn is_no_failure(server: &Running, bytes: &[u8]) {
    if let Some(answer) = server.send(bytes) {
        let shown = String::from_utf8_lossy(&bytes[..bytes.len().min(300)]);
        assert!(answer.status < 500, "{}: {shown}", answer.status);
    }
}

/// A client that waits briefly, and closes the connection if no answer comes: many of its requests
/// are incomplete.
fn send_bytes(server: &Running, bytes: &[u8]) {
    let mut stream = server.connect();
    let _ = stream.write_all(bytes);
    let mut read = Vec::new();
    for patience in [30, 3000] {
        let patience = Some(Duration::from_millis(patience));
        stream.set_read_timeout(patience).unwrap();
        if stream.read_to_end(&mut read).is_ok() {
            break;
        }
        let _ = stream.shutdown(Shutdown::Write);
    }
    let status = read.get(9..12).map(String::from_utf8_lossy);
    let shown = String::from_utf8_lossy(bytes);
    assert!(
        !status.is_some_and(|status| status.starts_with('5')),
        "{shown}"
    );
}

#[test]
fn the_server_survives_whatever_comes_in() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        PANICS.fetch_add(1, Ordering::Relaxed);
        usual(panic);
    }));
    let server = serve();
    random_bytes(&server);
    is_well(&server);
    mutated_requests(&server);
    is_well(&server);
    values_of_every_kind(&server);
    is_well(&server);
    slow_and_half_closed(&server);
    is_well(&server);
}

fn random_bytes(server: &Running) {
    let mut numbers = Numbers(1);
    for _ in 0..200 {
        send_bytes(server, &numbers.bytes(2000));
    }
    send_bytes(server, &[b'a'; 200_000]);
    send_bytes(
        server,
        format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(100_000)).as_bytes(),
    );
    let many = "X: y\r\n".repeat(5000);
    send_bytes(server, format!("GET / HTTP/1.1\r\n{many}\r\n").as_bytes());
}

fn mutated_requests(server: &Running) {
    let kind = "Content-Type: application/json\r\n";
    let request = format!(
        r#"{{"case":{{"file":{STRUCTURE},"set":["wave.height=1.5"],"water":"wave"}},"window":[1,3]}}"#
    );
    let map = r#"{"values":{},"x":{"key":"f_o","low":0.1,"high":0.2,"count":2},"y":{"key":"e","low":0.5,"high":1,"count":2}}"#;
    let requests = [
        server.request("GET", "/", "", ""),
        server.request("GET", "/api/schema", "", ""),
        server.request(
            "POST",
            "/api/run",
            kind,
            r#"{"values":{"f_o":0.31},"ghost":1e-6,"samples":50}"#,
        ),
        server.request(
            "POST",
            "/api/instant",
            kind,
            r#"{"values":{"f_o":0.31},"t":1.5}"#,
        ),
        server.request("POST", "/api/map", kind, map),
        server.request(
            "POST",
            "/api/question/sensitivities",
            kind,
            r#"{"values":{"f_o":0.31},"options":{"impacts":2}}"#,
        ),
        server.request("POST", "/api/structure", kind, STRUCTURE),
        server.request("POST", "/api/structure/run", kind, &request),
        server.request("POST", "/api/structure/elastic", kind, &request),
        server.request(
            "POST",
            "/api/export/modes.csv",
            kind,
            r#"{"values":{"f_o":0.31}}"#,
        ),
    ];
    let mut numbers = Numbers(2);
    for round in 0..600 {
        let request = requests[round % requests.len()].as_bytes();
        // Changes anywhere, or in the body alone.
        let from = match numbers.below(2) {
            0 => 0,
            _ => request.windows(4).position(|w| w == b"\r\n\r\n").unwrap() + 3,
        };
        let mut bytes = request[..from].to_vec();
        bytes.extend(numbers.mutated(&request[from..]));
        send_bytes(server, &bytes);
    }
}

/// Values that JSON can hold, and some that it can not.
const VALUES: [&str; 34] = [
    "0",
    "-0",
    "-0.0",
    "1",
    "-1",
    "0.1",
    "1e-300",
    "5e-324",
    "-1e-9",
    "1e3",
    "1e6",
    "1e308",
    "-1e308",
    "1e309",
    "-1e999",
    "9223372036854775807",
    "18446744073709551615",
    "99999999999999999999999999",
    "0.1e-400",
    "NaN",
    "Infinity",
    "0x10",
    "null",
    "true",
    "false",
    "\"\"",
    "\"point\"",
    "\"\\u0000\"",
    "\"\\ud800\"",
    "[]",
    "[[[[1]]]]",
    "{}",
    "{\"a\":{}}",
    "",
];

fn values_of_every_kind(server: &Running) {
    let kind = "Content-Type: application/json\r\n";
    for key in KEYS {
        for value in VALUES {
            // A short run, unless the key under test is the end itself.
            let end = if key.name == "t_end" {
                ""
            } else {
                ",\"t_end\":1"
            };
            let body = format!(
                "{{\"samples\":2,\"values\":{{\"{}\":{value}{end}}}}}",
                key.name
            );
            let request = server.request("POST", "/api/run", kind, &body);
            let status = server.send(request.as_bytes()).unwrap().status;
            assert!([200, 400, 422].contains(&status), "{status}: {body}");
        }
    }
    for value in VALUES {
        for field in ["low", "high", "count"] {
            let fields = ["low", "high", "count"].map(|name| match name == field {
                true => format!("\"{name}\":{value}"),
                false => format!("\"{name}\":1"),
            });
            let y = "{\"key\":\"e\",\"low\":0,\"high\":1,\"count\":2}";
            let x = format!("{{\"key\":\"f_o\",{}}}", fields.join(","));
            let body = format!("{{\"values\":{{\"t_end\":1}},\"x\":{x},\"y\":{y}}}");
            is_no_failure(
                server,
                server.request("POST", "/api/map", kind, &body).as_bytes(),
            );
        }
        for field in ["values", "ghost", "samples", "x"] {
            let body = format!("{{\"{field}\":{value}}}");
            is_no_failure(
                server,
                server.request("POST", "/api/run", kind, &body).as_bytes(),
            );
        }
    }
    for body in [
        &b"\0\0\0\0"[..],
        b"\xff\xfe{}",
        b"{\"values\":{\"f_o\xff\":1}}",
        b"{\"\0\":1}",
    ] {
        let mut request = format!(
            "POST /api/run HTTP/1.0\r\nHost: 127.0.0.1:{}\r\n{kind}Content-Length: {}\r\n\r\n",
            server.port,
            body.len()
        )
        .into_bytes();
        request.extend(body);
        assert_eq!(server.send(&request).unwrap().status, 400);
    }
}

fn slow_and_half_closed(server: &Running) {
    let kind = "Content-Type: application/json\r\n";
    let request = server.request("POST", "/api/run", kind, "{\"values\":{}}");
    // Requests that stop at every possible place.
    let unfinished: Vec<_> = (0..50)
        .map(|k| {
            let mut stream = server.connect();
            let some = request.len() * k / 50;
            stream.write_all(&request.as_bytes()[..some]).unwrap();
            stream
        })
        .collect();
    is_well(server);
    drop(unfinished);
    // Byte by byte.
    let mut stream = server.connect();
    for byte in request.as_bytes() {
        stream.write_all(&[*byte]).unwrap();
    }
    let mut read = String::new();
    stream.read_to_string(&mut read).unwrap();
    assert!(read.starts_with("HTTP/1.0 200"), "{read}");
    // Clients that close at once after a request, that send no more, or that never read.
    let silent: Vec<_> = (0..40)
        .map(|k| {
            let mut stream = server.connect();
            stream.write_all(request.as_bytes()).unwrap();
            match k % 3 {
                0 => stream.shutdown(Shutdown::Write).unwrap(),
                1 => stream.shutdown(Shutdown::Both).unwrap(),
                _ => {}
            }
            stream
        })
        .collect();
    is_well(server);
    drop(silent);
}
