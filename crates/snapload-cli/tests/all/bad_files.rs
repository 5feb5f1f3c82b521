//! Case files with errors: each message names the line, and what is allowed or meant.

use crate::common::{directory, listing, snapload};
use predicates::str::is_empty;
use std::fs;

#[test]
fn bad_files_are_refused_with_the_line() {
    for (contents, texts) in [
        (
            &b"e = 0.5\n\nf_o = 2e9 # much\n"[..],
            &["bad.toml, line 3", "f_o = 2e9", "f_o <= 1000"][..],
        ),
        (
            b"e = 0.5\nomegga = 1\n",
            &["bad.toml, line 2", "\"omegga\"", "did you mean omega?"],
        ),
        (
            b"e = 0.5\n[theta]\nx = 1\n",
            &["bad.toml, line 2", "theta (a table)"],
        ),
        (b"[[omega]]\n", &["bad.toml, line 1", "omega (a list)"]),
        (b"e = \"0.5\"\n", &["e = \"0.5\"", "write e = 0.5"]),
        (b"e = nan\n", &["e = NaN"]),
        (b"e = -inf\n", &["e = -inf"]),
        (
            b"e = 0.5\ne = 0.6\n",
            &["bad.toml", "line 2, column 1", "the key e occurs twice"],
        ),
        (
            b"e = \n",
            &["bad.toml", "line 1, column 5", "e has no value"],
        ),
        (
            b"stop_when_settled = True\n",
            &["stop_when_settled = True has capital letters; write true"],
        ),
        (
            b"[run]\nr = 1.5\n",
            &["bad.toml, line 1", "leave out the line [run]"],
        ),
        (
            b"r = 1.5\n[vary]\ne = [0.1, 0.2]\n",
            &["bad.toml", "study", "snapload sweep bad.toml"],
        ),
        (b"h = 1.2\n", &["bad.toml, line 1", "derived"]),
        (
            b"a = 0.2\nr = 0.8\n",
            &["bad.toml, line 2", "r = 0.8", "|1 - a| = 0.8"],
        ),
        (b"e = 99999999999999999999\n", &["bad.toml", "line 1"]),
        (b"\xff\xfe\x00", &["bad.toml", "UTF-8"]),
        (b"\x89HDF\r\n", &["bad.toml", "netCDF", "snapload hydro"]),
    ] {
        let d = directory();
        fs::write(d.path().join("bad.toml"), contents).unwrap();
        let run = ["run", "bad.toml", "--out", "results"];
        let out = snapload(d.path())
            .args(run)
            .assert()
            .code(2)
            .stdout(is_empty());
        let message = String::from_utf8(out.get_output().stderr.clone()).unwrap();
        assert!(texts.iter().all(|text| message.contains(text)), "{message}");
        assert_eq!(listing(d.path()), ["bad.toml"]);
    }
}
