//! The requests that the server refuses, and the messages.

use crate::common::{Running, serve};
use serde_json::{Value, json};

#[test]
fn values_are_refused_in_the_words_of_the_command() {
    let server = serve();
    for (values, words) in [
        (
            json!({ "e": 1.5 }),
            "e = 1.5 is not allowed; allowed: a number, 0 <= e <= 1",
        ),
        (
            json!({ "omgea": 1 }),
            "there is no key \"omgea\" (omgea = 1); did you mean omega?",
        ),
        (json!({ "f_o": "abc" }), "f_o = \"abc\" is not allowed"),
        (json!({ "f_o": "0,5" }), "hint: write f_o = 0.5"),
        (json!({ "f_o": [0.5] }), "f_o (a list) is not allowed"),
        (
            json!({ "f_o": { "low": 1 } }),
            "f_o (a table) is not allowed",
        ),
        (json!({ "nothing": null }), "there is no key \"nothing\""),
        (
            json!({ "max_impacts": 1.5 }),
            "max_impacts = 1.5 is not allowed",
        ),
        (json!({ "y": -0.5 }), "within reach of both cables"),
        (json!({ "a": 0 }), "inertia (left out) is not allowed"),
    ] {
        for path in ["/api/run", "/api/export/case.toml"] {
            let answer = server.post(path, &json!({ "values": values }));
            assert_eq!(answer.status, 422, "{values}");
            assert!(answer.error().contains(words), "{}", answer.error());
        }
    }
}

/// Asserts that each of these is refused, with its status, key and message.
fn refuse(path: &str, cases: impl IntoIterator<Item = (Value, u16, Value, &'static str)>) {
    let server = serve();
    for (body, status, key, words) in cases {
        let answer = server.post(path, &body);
        assert_eq!(answer.status, status, "{body}");
        assert_eq!(answer.json()["key"], key, "{body}");
        assert!(answer.error().contains(words), "{}", answer.error());
    }
}

#[test]
fn runs_that_request_too_much_are_refused() {
    let samples = "2 <= samples <= 20000";
    refuse(
        "/api/run",
        [
            (json!({ "samples": 1 }), 422, json!("samples"), samples),
            (
                json!({ "samples": 1_000_000 }),
                422,
                json!("samples"),
                samples,
            ),
            (
                json!({ "ghost": 1 }),
                422,
                json!("ghost"),
                "0 < ghost <= 0.1",
            ),
            (
                json!({ "ghost": -1e-6 }),
                422,
                json!("ghost"),
                "0 < ghost <= 0.1",
            ),
            (
                json!({ "values": { "e": 2 } }),
                422,
                json!("e"),
                "0 <= e <= 1",
            ),
            (
                json!({ "value": {} }),
                400,
                Value::Null,
                "unknown field `value`",
            ),
            (json!([]), 400, Value::Null, "the request"),
        ],
    );
    refuse(
        "/api/export/nothing.csv",
        [(json!({}), 404, Value::Null, "nothing")],
    );
    refuse(
        "/api/export/trajectory.pdf",
        [(json!({}), 404, Value::Null, "nothing")],
    );
}

#[test]
fn maps_that_request_too_much_are_refused() {
    let axis =
        |key: &str, count: i64| json!({ "key": key, "low": 0.1, "high": 0.2, "count": count });
    let map = |x: Value, y: Value| json!({ "values": {}, "x": x, "y": y });
    let [x, y] = ["x", "y"].map(|key| json!(key));
    for path in ["/api/map", "/api/basin"] {
        refuse(
            path,
            [
                (
                    map(axis("f_o", 201), axis("e", 2)),
                    422,
                    x.clone(),
                    "x: count = 201 is not allowed",
                ),
                (
                    map(axis("f_o", 2), axis("e", 0)),
                    422,
                    y.clone(),
                    "y: count = 0 is not allowed",
                ),
                (
                    map(axis("f_o", 2), axis("f_o", 2)),
                    422,
                    Value::Null,
                    "x and y are both f_o",
                ),
                (
                    map(axis("f_o", 2), axis("body", 2)),
                    422,
                    y.clone(),
                    "y: body is not a real number",
                ),
                (
                    map(axis("f_o", 2), axis("fo", 2)),
                    422,
                    y.clone(),
                    "did you mean f_o",
                ),
                (
                    map(axis("f_o", -1), axis("e", 2)),
                    400,
                    Value::Null,
                    "the request",
                ),
            ],
        );
    }
}

#[test]
fn a_picture_of_very_many_impacts_is_left_to_the_command() {
    let server = serve();
    let bounces =
        json!({ "values": { "body": "point", "e": 1, "f_o": 0, "y": 1e-4, "t_end": 200 } });
    assert_eq!(server.post("/api/export/impacts.csv", &bounces).status, 200);
    let answer = server.post("/api/export/energy.svg", &bounces);
    assert_eq!(answer.status, 422);
    let words = answer.error();
    for part in [
        "14142 impacts",
        "snapload run --set e=1",
        "--set body=point --out results",
    ] {
        assert!(words.contains(part), "{words}");
    }
}

/// Sends one request and returns the status.
fn status(server: &Running, request: &str) -> u16 {
    server.send(request.as_bytes()).unwrap().status
}

#[test]
fn only_our_own_page_is_answered() {
    let server = serve();
    let port = server.port;
    let with_host =
        |host: &str| format!("GET /api/schema HTTP/1.1\r\nConnection: close\r\n{host}\r\n");
    for (host, wanted) in [
        (format!("Host: 127.0.0.1:{port}\r\n"), 200),
        (format!("Host: localhost:{port}\r\n"), 200),
        // The name of another site that resolves to this server.
        (format!("Host: evil.example:{port}\r\n"), 421),
        ("Host: evil.example\r\n".to_owned(), 421),
        (format!("Host: 127.0.0.1:{}\r\n", port ^ 1), 421),
        ("Host: 127.0.0.1\r\n".to_owned(), 421),
        (format!("Host: 127.0.0.1:{port}.evil.example\r\n"), 421),
        (format!("Host: evil.example@127.0.0.1:{port}\r\n"), 421),
        (
            format!("Host: 127.0.0.1:{port}\r\nHost: evil.example\r\n"),
            421,
        ),
        (String::new(), 421),
    ] {
        assert_eq!(status(&server, &with_host(&host)), wanted, "{host}");
    }
    let absolute = format!("GET http://evil.example/ HTTP/1.0\r\nHost: 127.0.0.1:{port}\r\n\r\n");
    assert_eq!(status(&server, &absolute), 421);
    for (origin, wanted) in [
        (format!("http://127.0.0.1:{port}"), 200),
        (format!("http://localhost:{port}"), 200),
        ("http://evil.example".to_owned(), 403),
        ("null".to_owned(), 403),
        (format!("https://127.0.0.1:{port}"), 403),
        (format!("http://127.0.0.1:{}", port ^ 1), 403),
        (String::new(), 403),
    ] {
        let lines = format!("Origin: {origin}\r\nContent-Type: application/json\r\n");
        let request = server.request("POST", "/api/run", &lines, "{}");
        assert_eq!(status(&server, &request), wanted, "{origin}");
    }
}

#[test]
fn bodies_that_are_no_json_or_too_large_are_refused() {
    let server = serve();
    for kind in [
        "",
        "Content-Type: text/plain\r\n",
        "Content-Type: application/jsonx\r\n",
    ] {
        let request = server.request("POST", "/api/run", kind, "{}");
        assert_eq!(status(&server, &request), 415, "{kind}");
    }
    let kind = "Content-Type: application/json; charset=utf-8\r\n";
    assert_eq!(
        status(&server, &server.request("POST", "/api/run", kind, "{}")),
        200
    );
    let large = format!("{{\"values\":{{\"body\":\"{}\"}}}}", "x".repeat(65 << 10));
    let refused = server.post_text("/api/run", &large);
    assert_eq!(refused.status, 413);
    let message = String::from_utf8_lossy(&refused.body);
    assert!(message.contains("more than 64 KiB"), "{message}");
    // The same without announcing its length.
    let chunked = format!(
        "POST /api/run HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\nTransfer-Encoding: chunked\r\n{kind}\r\n\
         {:x}\r\n{large}\r\n0\r\n\r\n",
        server.port,
        large.len()
    );
    assert_eq!(status(&server, &chunked), 413);
    for body in [
        "",
        "{",
        "nonsense",
        "{\"values\":{\"f_o\":1e999}}",
        "{\"values\":{\"f_o\":NaN}}",
        "{} {}",
    ] {
        assert_eq!(server.post_text("/api/run", body).status, 400, "{body}");
    }
    let deep = "[".repeat(10_000);
    assert_eq!(
        server
            .post_text("/api/run", &format!("{{\"values\":{{\"x\":{deep}"))
            .status,
        400
    );
}

#[test]
fn wrong_paths_and_methods_are_refused() {
    let server = serve();
    for (method, path, wanted) in [
        ("GET", "/api/run", 405),
        ("POST", "/api/schema", 405),
        ("DELETE", "/api/schema", 405),
        ("PUT", "/", 405),
        ("OPTIONS", "/api/run", 405),
        ("TRACE", "/", 405),
        ("GET", "/api", 404),
        ("GET", "/api/nothing", 404),
        ("GET", "/nothing.html", 404),
        ("HEAD", "/", 200),
    ] {
        let request = server.request(method, path, "", "");
        assert_eq!(status(&server, &request), wanted, "{method} {path}");
    }
    assert!(
        server
            .get("/nothing")
            .error()
            .contains("nothing at this path")
    );
}
