//! Windows of two keys that can not be.
use crate::common::{directory, snapload};
use predicates::str::contains;

/// Cells whose cables are too short are an error in both directions of a key, and options that
/// would have no effect are refused. The omega of the case has none where the window has others.
#[test]
fn a_window_that_can_not_be_is_refused() {
    let basin = |args: &str| {
        let d = directory();
        let mut command = snapload(d.path());
        command.arg("basin").args(args.split_whitespace()).assert()
    };
    let short = "r = 0.5 is not allowed; allowed: r > |1 - a| = 0.9 (a = 0.1)";
    for (args, why) in [
        ("--vary r=0.5:2:2 --vary a=0.9:0.1:2", short),
        ("--vary r=2:0.5:2 --vary a=0.9:0.1:2", short),
        ("--vary r=2:0.5:2 --vary a=0.1:0.9:2", short),
        (
            "--transient 5 --vary x=-0.1:0.1:3 --vary y=0.1:0.2:2",
            "--transient only with --kind attractor",
        ),
        (
            "--kind attractor --vary t_end=1:5:2 --vary y=0.1:0.2:2",
            "a key on which attractors depend",
        ),
    ] {
        basin(args).code(2).stderr(contains(why));
    }
    let still =
        "--kind attractor --set body=point --set omega=0 --vary omega=1:2:2 --vary y=0.1:0.4:2";
    basin(still).success().stdout(contains("4 of 4 cells"));
}
