//! The report as a reader meets it: written by the command, opened in a real browser.
#![allow(clippy::unwrap_used, clippy::panic)]
mod common;

use common::{directory, listing, snapload};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Debian's Chromium, which the test command installs.
const BROWSER: &str = "chromium";

/// The page after its scripts, had it any, and what the browser complained of.
fn opened(page: &Path, profile: &Path, more: &[&str]) -> (String, String) {
    let out = Command::new(BROWSER)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--enable-logging=stderr",
        ])
        .arg(format!("--user-data-dir={}", profile.display()))
        .args(more)
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("chromium, which test.sh installs");
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    (text(out.stdout), text(out.stderr))
}

#[test]
fn the_report_opens_with_every_figure() {
    let d = directory();
    snapload(d.path())
        .args(["reproduce", "--out", "chapter"])
        .assert()
        .success();
    let page = d.path().join("chapter/report.html");
    let (dom, said) = opened(&page, &d.path().join("profile"), &["--dump-dom"]);
    assert!(
        !said.contains("CONSOLE") || !said.contains("Error"),
        "{said}"
    );
    // Self-contained: nothing is loaded from anywhere.
    assert!(!dom.contains("src=\"http") && !dom.contains("<link") && !dom.contains("<script"));

    let numbers = 1..=45;
    for number in numbers {
        let id = format!("figure-6-{number}");
        let start = dom
            .find(&format!("id=\"{id}\""))
            .unwrap_or_else(|| panic!("no {id}"));
        let figure = &dom[start..start + dom[start..].find("</figure>").unwrap()];
        assert!(
            figure.contains("<svg") && figure.matches("<path").count() > 2,
            "{id} is empty"
        );
        assert!(figure.contains(&format!("Fig. 6.{number}. ")) && figure.contains("snapload "));
        let data = fs::read_to_string(d.path().join(format!("chapter/figures/{id}.csv"))).unwrap();
        assert!(data.lines().count() > 3, "{id} has no data");
        assert!(d.path().join(format!("chapter/figures/{id}.svg")).is_file());
    }
    let files = listing(&d.path().join("chapter"));
    assert_eq!(
        files,
        [
            "claims.json",
            "figures",
            "report.html",
            "table-6-1.csv",
            "table-6-2.csv"
        ]
    );
    let claims = fs::read_to_string(d.path().join("chapter/claims.json")).unwrap();
    let claims: serde_json::Value = serde_json::from_str(&claims).unwrap();
    let claims = claims.as_array().unwrap();
    assert!(claims.len() >= 60, "{}", claims.len());
    for claim in claims {
        let text = |key: &str| claim[key].as_str().unwrap();
        assert!(["reproduced", "not reproduced", "not decidable"].contains(&text("verdict")));
        for key in ["id", "section", "claim", "evidence"] {
            assert!(!text(key).is_empty(), "{claim}");
        }
        assert!(dom.contains(&format!("id=\"claim-{}\"", text("id"))));
    }
    for table in ["table-6-1.csv", "table-6-2.csv"] {
        let text = fs::read_to_string(d.path().join("chapter").join(table)).unwrap();
        assert!(text.lines().count() > 30, "{table}");
    }
}

/// On a phone nothing is wider than the screen but the tables, which scroll by themselves.
#[test]
fn a_screenshot_is_not_blank() {
    let d = directory();
    snapload(d.path())
        .args(["reproduce", "--out", "chapter"])
        .assert()
        .success();
    let shot = d.path().join("shot.png");
    let option = format!("--screenshot={}", shot.display());
    let page = d.path().join("chapter/report.html");
    opened(
        &page,
        &d.path().join("profile"),
        &["--window-size=400,3000", &option],
    );
    assert!(fs::metadata(&shot).unwrap().len() > 50_000);
}
