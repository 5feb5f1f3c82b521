//! The report as a reader meets it: written by the command, opened in a real browser, and its
//! commands run.

use crate::common::{directory, listing, snapload};
use serde_json::Value;
use snapload::analysis::in_parallel;
use std::collections::HashMap;
use std::convert::Infallible;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;
use tempfile::TempDir;

/// Chromium, which the test command installs: the variant without windows, if it is installed.
const BROWSERS: [&str; 2] = ["chromium-headless-shell", "chromium"];

/// The report, written once for all tests.
static MADE: LazyLock<TempDir> = LazyLock::new(|| {
    let d = directory();
    let mut command = snapload(d.path());
    command.args(["reproduce", "--out", "chapter"]);
    command.assert().success();
    d
});

/// A file of the report.
fn place(name: &str) -> PathBuf {
    MADE.path().join("chapter").join(name)
}

fn read(name: &str) -> String {
    fs::read_to_string(place(name)).unwrap()
}

/// The page after a browser has loaded it, and the browser's messages.
fn opened(page: &Path, more: &[&str]) -> (String, String) {
    let profile = directory();
    let there = |name: &&str| Command::new(name).arg("--version").output().is_ok();
    let browser = BROWSERS.into_iter().find(there);
    let out = Command::new(browser.expect("chromium, which test.sh installs"))
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
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(more)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    (text(out.stdout), text(out.stderr))
}

#[test]
fn the_report_opens_with_every_figure() {
    let (dom, stderr) = opened(&place("report.html"), &["--dump-dom"]);
    assert!(
        !stderr.contains("CONSOLE") || !stderr.contains("Error"),
        "{stderr}"
    );
    // Self-contained: nothing is loaded from anywhere.
    assert!(!dom.contains("src=\"") && !dom.contains("<link") && !dom.contains("<script"));

    for number in 1..=45 {
        let id = format!("figure-6-{number}");
        let figure = figure(&dom, number);
        assert!(
            figure.contains("<svg") && figure.matches("<path").count() > 2,
            "{id} is empty"
        );
        assert!(figure.contains(&format!("Fig. 6.{number}. ")) && figure.contains("snapload"));
        let data = read(&format!("figures/{id}.csv"));
        assert!(data.lines().count() > 3, "{id} has no data");
        assert!(place(&format!("figures/{id}.svg")).is_file());
    }
    let files = listing(&place(""));
    let expected = [
        "claims.json",
        "figures",
        "report.html",
        "table-6-1.csv",
        "table-6-2.csv",
    ];
    assert_eq!(files, expected);
    for (table, rows) in [("table-6-1.csv", 2 * 35), ("table-6-2.csv", 16)] {
        // A reader of CSV refuses rows of another length than the header.
        let found = csv::Reader::from_reader(read(table).as_bytes())
            .into_records()
            .count();
        assert_eq!(found, rows, "{table}");
        for row in csv::Reader::from_reader(read(table).as_bytes()).records() {
            row.unwrap();
        }
    }
    let claims = claims();
    assert!(claims.len() >= 60, "{}", claims.len());
    for claim in &claims {
        let text = |key: &str| claim[key].as_str().unwrap();
        let verdicts = ["reproduced", "not reproduced", "mixed", "not decidable"];
        assert!(verdicts.contains(&text("verdict")));
        for key in ["id", "section", "claim", "evidence"] {
            assert!(!text(key).is_empty(), "{claim}");
        }
        assert!(dom.contains(&format!("id=\"claim-{}\"", text("id"))));
    }
    // Every link inside the page leads somewhere, and every file beside it is there.
    for target in dom.split("href=\"").skip(1).map(until_quote) {
        match target.strip_prefix('#') {
            Some(id) => assert!(dom.contains(&format!("id=\"{id}\"")), "no {id}"),
            None => assert!(place(target).is_file(), "no {target}"),
        }
    }
}

/// On a phone nothing is wider than the screen but the tables, which scroll by themselves.
#[test]
fn the_report_fits_a_phone() {
    let shot = MADE.path().join("shot.png");
    let option = format!("--screenshot={}", shot.display());
    let page = place("report.html");
    opened(&page, &["--window-size=400,3000", &option]);
    assert!(fs::metadata(&shot).unwrap().len() > 50_000);

    // A window is never narrower than 500 pixels, so the page is put into a frame.
    let frame = MADE.path().join("phone.html");
    let script = "const page = frames[0].document.documentElement; \
                  document.title = page.scrollWidth - page.clientWidth + ' too wide'";
    let html = format!(
        "<iframe src=\"chapter/report.html\" style=\"width:390px;height:800px;border:0\" \
         onload=\"{script}\"></iframe>"
    );
    fs::write(&frame, html).unwrap();
    let (dom, stderr) = opened(&frame, &["--allow-file-access-from-files", "--dump-dom"]);
    assert!(dom.contains("<title>0 too wide</title>"), "{dom}\n{stderr}");
}

fn claims() -> Vec<Value> {
    serde_json::from_str(&read("claims.json")).unwrap()
}

fn until_quote(text: &str) -> &str {
    text.split('"').next().unwrap()
}

fn figure(page: &str, number: usize) -> &str {
    let start = page.find(&format!("id=\"figure-6-{number}\""));
    let start = start.unwrap_or_else(|| panic!("no figure {number}"));
    &page[start..start + page[start..].find("</figure>").unwrap()]
}

/// The text of a piece of HTML.
fn text_of(html: &str) -> String {
    let mut text = String::new();
    for part in html.split('<') {
        text.push_str(part.split_once('>').map_or(part, |(_, text)| text));
    }
    let named = [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&amp;", "&"),
    ];
    named
        .iter()
        .fold(text, |text, (name, c)| text.replace(name, c))
}

/// The commands of the page, in the order of their numbers.
fn commands(page: &str) -> Vec<String> {
    let items = page.split("<li id=\"command-").skip(1);
    let command = |item: &str| {
        let (_, html) = item.split_once('>').unwrap();
        text_of(&html[..html.find("</li>").unwrap()])
    };
    items.map(command).collect()
}

/// A number of the page: its text, the number of its command, and its place in that command's JSON.
struct Shown {
    text: String,
    command: usize,
    key: String,
}

fn numbers(page: &str) -> Vec<Shown> {
    let links = page.split("<a class=\"number\" href=\"#command-").skip(1);
    let number = |link: &str| {
        let (_, key) = link.split_once("data-key=\"").unwrap();
        let (_, html) = link.split_once('>').unwrap();
        Shown {
            text: text_of(html.split("</a>").next().unwrap()),
            command: until_quote(link).parse().unwrap(),
            key: text_of(until_quote(key)),
        }
    };
    links.map(number).collect()
}

/// The output of each command, line by line; all run side by side, in a directory of their own.
fn printed(commands: &[String]) -> Vec<Vec<Value>> {
    let program = assert_cmd::cargo::cargo_bin!("snapload");
    let mut path = program.parent().unwrap().as_os_str().to_owned();
    path.push(":");
    path.push(std::env::var_os("PATH").unwrap());
    let scratch = directory();
    let print = |k: usize| -> Result<Vec<Value>, Infallible> {
        let command = &commands[k];
        // This command writes the report itself, which exists already.
        if command.starts_with("snapload reproduce") {
            return Ok(Vec::new());
        }
        let mut shell = Command::new("sh");
        shell.args(["-c", command]).env("PATH", &path);
        let out = shell.current_dir(scratch.path()).output().unwrap();
        let stderr = String::from_utf8_lossy(&out.stderr);
        assert!(
            out.status.success() && stderr.is_empty(),
            "{command}: {stderr}"
        );
        let lines = String::from_utf8(out.stdout).unwrap();
        let json = lines.lines().filter(|line| line.starts_with('{'));
        Ok(json
            .map(|line| serde_json::from_str(line).unwrap())
            .collect())
    };
    in_parallel(commands.len(), print).unwrap()
}

/// Every command of the page runs, and prints the numbers that link to it.
#[test]
fn every_number_is_made_again_by_its_command() {
    let page = read("report.html");
    let commands = commands(&page);
    let printed = printed(&commands);
    let numbers = numbers(&page);
    assert!(numbers.len() > 500, "{}", numbers.len());
    for Shown { text, command, key } in &numbers {
        // The sign of a number past the horizon of its run.
        let text = text.trim_start_matches('~');
        let made = match key.split_once(": ") {
            Some(("claims.json", key)) => of_claims(key, text),
            Some((file, key)) => of_table(file, key, text),
            None => value(&printed[command - 1][0], key, text),
        };
        let command = &commands[command - 1];
        assert_eq!(text, made, "{command} → {key}");
    }
    for number in 27..=38 {
        curve_is_made_again(&page, number, &printed);
    }
}

/// A number of the JSON, written as the page writes it.
fn value(json: &Value, key: &str, shown: &str) -> String {
    let exceeding =
        || -> Vec<[f64; 2]> { serde_json::from_value(json["exceeding"].clone()).unwrap() };
    if key.starts_with('[') {
        let impacts = json["impacts"].as_array().unwrap().iter();
        return impacts
            .filter(|i| i["v_n"].as_f64() > Some(0.0))
            .count()
            .to_string();
    }
    if key == ".exceeding" {
        let range = |[p, q]: &[f64; 2]| {
            if p == q {
                format!("{p:.2}")
            } else {
                format!("{p:.2}–{q:.2}")
            }
        };
        return exceeding().iter().map(range).collect::<Vec<_>>().join(", ");
    }
    let places = shown
        .split_once('.')
        .map_or(0, |(_, decimals)| decimals.len());
    if key.starts_with(".impacts | map") {
        let until = if key.contains("<= 10") {
            10.0
        } else {
            f64::INFINITY
        };
        let number = |value: &Value| value.as_str().unwrap().parse::<f64>().unwrap();
        let lines = json["impacts"].as_array().unwrap().iter();
        let early = lines.filter(|line| number(&line[1]) <= until);
        let velocities = early.map(|line| number(&line[2]));
        let norm = match key.rsplit(' ').next() {
            Some("max") => velocities.fold(0.0, f64::max),
            _ => velocities.sum(),
        };
        return format!("{norm:.places$}");
    }
    let pointer = |path: &str| {
        let pointer = path.replace(['.', '['], "/").replace(']', "");
        json.pointer(&pointer).unwrap_or_else(|| panic!("no {key}"))
    };
    if let Some((path, then)) = key.split_once(" | ") {
        let place = pointer(path);
        return match then {
            "length" => place.as_array().unwrap().len().to_string(),
            // A time that is proved, of which the page shows the first decimals, rounded.
            _ => {
                let text = place.as_str().unwrap();
                assert!(text.split_once('.').unwrap().1.len() > places, "{text}");
                format!("{:.places$}", text.parse::<f64>().unwrap())
            }
        };
    }
    let (path, less) = key.split_once(" - ").unwrap_or((key, "0"));
    let found = pointer(path);
    // Certificates write numbers as strings.
    let number = found.as_f64().or_else(|| found.as_str()?.parse().ok());
    match (number, found) {
        (Some(number), _) => {
            let number = number - less.parse::<f64>().unwrap();
            let text = format!("{number:.places$}").replace('-', "−");
            match key.contains(" - ") {
                true if text.trim_start_matches('−') == "0.00" => "0.00".to_owned(),
                true if number > 0.0 => format!("+{text}"),
                _ => text,
            }
        }
        (None, Value::String(word)) => word.replace('_', " "),
        (None, _) => "none".to_owned(),
    }
}

/// A number of a table beside the page: `y_max of CODE`, or `verdict of r = 1.5, 0.1 x 0`.
fn of_table(file: &str, key: &str, shown: &str) -> String {
    let table = read(file);
    let mut rows = table
        .lines()
        .map(|row| row.split(',').collect::<Vec<&str>>());
    let head = rows.next().unwrap();
    let column = |name: &str| head.iter().position(|known| *known == name).unwrap();
    let (name, row) = key.split_once(" of ").unwrap();
    let is_row = |cells: &Vec<&str>| match row.strip_prefix("r = ") {
        Some(shape) => {
            let own = format!(
                "{}, {} x {}",
                cells[0],
                cells[column("a")],
                cells[column("b")]
            );
            own == shape
        }
        None => cells[column("case")] == row && cells[column("reading")] == "sliding ends the run",
    };
    let cell = rows.find(is_row).unwrap()[column(name)].to_owned();
    match (cell.parse::<f64>(), shown.split_once('.')) {
        (Ok(number), Some((_, decimals))) => format!("{number:.0$}", decimals.len()),
        _ => cell,
    }
}

/// The evidence of a claim, without the remark that follows it on the page, or the number of claims
/// with a verdict.
fn of_claims(key: &str, shown: &str) -> String {
    let quoted = key.split('"').nth(1).unwrap();
    let claims = claims();
    if key.ends_with("length") {
        let of_verdict = claims.iter().filter(|claim| claim["verdict"] == quoted);
        return of_verdict.count().to_string();
    }
    let claim = claims.iter().find(|claim| claim["id"] == quoted).unwrap();
    let evidence = claim["evidence"].as_str().unwrap();
    evidence.get(..shown.len()).unwrap_or(evidence).to_owned()
}

/// The points of a curve or a figure of norms are those that its two commands print; parsing the
/// JSON may change the last bit of a number.
fn curve_is_made_again(page: &str, number: usize, printed: &[Vec<Value>]) {
    let keys: &[&str] = match number {
        27..=30 => &["/f_cr"],
        31 | 35 => &["/norms/theta_max"],
        32 | 36 => &["/norms/y_max"],
        33 | 37 => &["/norms/rho1", "/norms/rho2"],
        _ => &["/norms/rho3"],
    };
    let mut own: HashMap<&str, usize> = HashMap::new();
    let cites = figure(page, number)
        .split("<a class=\"cite\" href=\"#command-")
        .skip(1);
    for (reading, cite) in ["sliding ends", "sliding goes"].into_iter().zip(cites) {
        own.insert(reading, until_quote(cite).parse().unwrap());
    }
    assert_eq!(own.len(), 2);
    let data = read(&format!("figures/figure-6-{number}.csv"));
    for (reading, command) in own {
        let rows = data
            .lines()
            .filter(|row| row.contains(reading) || row.contains("both"));
        let mut drawn: Vec<f64> = rows
            .map(|row| row.rsplit(',').next().unwrap().parse().unwrap())
            .collect();
        let lines = printed[command - 1].iter();
        let values = lines.flat_map(|line| keys.iter().map(|key| line.pointer(key).unwrap()));
        let mut made: Vec<f64> = values.filter_map(Value::as_f64).collect();
        drawn.sort_by(f64::total_cmp);
        made.sort_by(f64::total_cmp);
        assert_eq!(drawn.len(), made.len(), "Fig. 6.{number}, {reading}");
        for (drawn, made) in drawn.iter().zip(&made) {
            assert!(
                (drawn - made).abs() <= 1e-15 * drawn.abs(),
                "Fig. 6.{number}, {reading}: {drawn} {made}"
            );
        }
    }
}
