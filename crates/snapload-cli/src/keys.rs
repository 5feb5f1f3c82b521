//! `snapload keys`: the schema of a case, for reading.
use crate::failure::{Failure, print};
use snapload::KEYS;
use std::fmt::Write;

const FOOTER: &str = "
Units: lengths in L (half the distance between the anchors), m the mass of the body, F its net
buoyancy, T = sqrt(m L / F). h = sqrt(r^2 - (1 - a)^2) is derived and never given.
In a file one `key = value` a line; on the command line --set key=value.
";

/// Prints it.
pub(crate) fn run() -> Result<(), Failure> {
    let mut text = String::new();
    for key in KEYS {
        let unit = match key.unit {
            "" | "1" => String::new(),
            unit => format!(" [{unit}]"),
        };
        let _ = writeln!(text, "{:<18} {}{unit}", key.name, key.meaning);
        let _ = writeln!(text, "{:<18}   default {}", "", key.default_words());
        let _ = writeln!(text, "{:<18}   allowed {}", "", key.allowed());
    }
    text.push_str(FOOTER);
    print(&text)
}
