//! The rows of a study as CSV: the same values as those of the Parquet file beside it.
#![cfg(unix)]

use crate::common::{directory, listing};
use crate::sweep::{SHORT, bytes, merge, sweep};
use predicates::str::contains;
use snapload_study::{Values, columns_of_files, read_rows};
use std::fs;
use std::path::Path;

/// The lines of a file without quotes, in cells; the first one has the names.
fn cells(file: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(file).unwrap();
    let cells = |line: &str| line.split(',').map(str::to_owned).collect();
    text.lines().map(cells).collect()
}

/// The values of a column, as cells that are read back are compared with them.
fn values(file: &Path, name: &str) -> Vec<Option<String>> {
    fn texts<T>(list: Vec<Option<T>>, text: impl Fn(T) -> String) -> Vec<Option<String>> {
        list.into_iter().map(|value| value.map(&text)).collect()
    }
    let mut all = Vec::new();
    read_rows(file, name, 0..u64::MAX, |values| {
        all.extend(match values {
            Values::Numbers(list) => texts(list, |number: f64| format!("{:x}", number.to_bits())),
            Values::Counts(list) => texts(list, |count| count.to_string()),
            Values::Flags(list) => texts(list, |flag| flag.to_string()),
            Values::Words(list) => texts(list, |word| word.into_owned()),
        });
    })
    .unwrap();
    all
}

/// A legal study, of which some cells are empty: where no trust ends, there is no horizon.
#[test]
fn the_csv_has_the_values_of_the_parquet_file() {
    let d = directory();
    sweep(d.path(), &SHORT, "a.csv")
        .success()
        .stdout(contains("Written   a.parquet\n          a.csv\n"));
    assert_eq!(listing(d.path()), ["a.csv", "a.parquet"]);
    let rows = cells(&d.path().join("a.csv"));
    assert_eq!(rows.len(), 11);
    let columns = columns_of_files();
    assert_eq!(
        rows[0],
        columns.iter().map(|(name, _)| *name).collect::<Vec<_>>()
    );
    let mut empty = 0;
    for (place, (name, kind)) in columns.into_iter().enumerate() {
        let expected = values(&d.path().join("a.parquet"), name);
        assert_eq!(expected.len(), 10);
        for (row, value) in rows[1..].iter().zip(expected) {
            let cell = &row[place];
            empty += usize::from(value.is_none());
            let read = match (cell.parse::<f64>(), kind) {
                (Ok(number), snapload_study::ColumnType::Numbers) => {
                    format!("{:x}", number.to_bits())
                }
                _ => cell.clone(),
            };
            assert_eq!(read, value.unwrap_or_default(), "{name}");
        }
    }
    assert!(empty > 0);
}

/// With --resume a complete study is accepted, and whatever is missing of its files is written.
#[test]
fn a_study_is_resumed_up_to_its_csv() {
    let d = directory();
    sweep(d.path(), &SHORT, "a.csv").success();
    let expected = bytes(d.path(), "a.csv");
    sweep(d.path(), &SHORT, "a.csv")
        .code(2)
        .stderr(contains("a.csv exists already; choose another --out"));
    let resume = [&SHORT[..], &["--resume"]].concat();
    sweep(d.path(), &resume, "a.csv").success();
    fs::remove_file(d.path().join("a.csv")).unwrap();
    sweep(d.path(), &resume, "a.csv").success();
    assert!(bytes(d.path(), "a.csv") == expected);
    fs::write(d.path().join("a.csv"), "mine\n").unwrap();
    sweep(d.path(), &resume, "a.csv").code(2).stderr(contains(
        "a.csv exists already and is not the CSV of this study",
    ));
    assert_eq!(bytes(d.path(), "a.csv"), b"mine\n");
}

/// A disk that has room for the Parquet file, but not for the CSV, which takes more.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_keeps_the_rows() {
    let d = directory();
    let many = [
        "--set",
        "t_end=0.1",
        "--no-trust",
        "--vary",
        "f_o=0.1:0.6:4000",
    ];
    sweep(d.path(), &many, "whole.csv").success();
    let size = bytes(d.path(), "whole.parquet").len();
    assert!(bytes(d.path(), "whole.csv").len() > 2 * size);
    let script = format!(
        "trap '' XFSZ; ulimit -f {}; exec {} sweep {} --out full.csv",
        size / 512 + 64,
        assert_cmd::cargo::cargo_bin!("snapload").display(),
        many.join(" ")
    );
    let mut shell = std::process::Command::new("sh");
    let run = shell.args(["-c", &script]).current_dir(d.path()).output();
    let done = run.unwrap();
    let stderr = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(1), "{stderr}");
    let told = stderr.contains("can not write full.csv: File too large");
    assert!(
        told && stderr.contains("--out full.csv --resume"),
        "{stderr}"
    );
    let whole = ["full.parquet", "whole.csv", "whole.parquet"];
    assert_eq!(listing(d.path()), whole);
    sweep(d.path(), &[&many[..], &["--resume"]].concat(), "full.csv").success();
    assert!(bytes(d.path(), "full.csv") == bytes(d.path(), "whole.csv"));
}

#[test]
fn parts_and_complete_files_become_csv() {
    let d = directory();
    sweep(d.path(), &SHORT, "one.csv").success();
    for part in ["1/2", "2/2"] {
        let out = format!("part-{}.parquet", &part[..1]);
        sweep(d.path(), &[&SHORT[..], &["--shard", part]].concat(), &out).success();
    }
    let merge = |parts: &[&str], out: &str| merge(d.path(), parts, out);
    merge(&["part-2.parquet", "part-1.parquet"], "two.csv").success();
    for ending in ["csv", "parquet"] {
        let [one, two] = ["one", "two"].map(|name| bytes(d.path(), &format!("{name}.{ending}")));
        assert!(one == two, "{ending}");
    }
    // The file itself is not merged into another one of its name, and a part is not the whole.
    fs::remove_file(d.path().join("two.csv")).unwrap();
    merge(&["two.parquet"], "two.csv").success();
    assert!(bytes(d.path(), "one.csv") == bytes(d.path(), "two.csv"));
    assert!(bytes(d.path(), "one.parquet") == bytes(d.path(), "two.parquet"));
    merge(&["part-1.parquet"], "part-1.csv")
        .code(2)
        .stderr(contains("are in none of the files"));
    merge(&["part-1.parquet", "part-2.parquet"], "one.CSV")
        .code(2)
        .stderr(contains("one.parquet exists already"));
}
