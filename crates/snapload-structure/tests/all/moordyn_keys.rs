//! What a case keeps when it is written for MoorDyn and read again.

use crate::manual::values;
use crate::moordyn::the_same;
use snapload::Entries;
use snapload_structure::{STRUCTURE, Structure, moordyn};

/// With any value of any key, a case is read back unchanged, if it is written at all.
#[test]
fn no_key_is_lost() {
    let wave = include_str!("../../../../docs/examples/cylinder.toml");
    let sea = include_str!("../../../../docs/examples/cylinder-sea.toml");
    for table in STRUCTURE.tables {
        let (text, path) = match table.name {
            "sea" => (sea, "sea"),
            "line" => (wave, "line.1"),
            name => (wave, name),
        };
        for key in table.keys {
            for value in values(key.kind) {
                let set = format!("{path}.{}={value}", key.name);
                let mut entries = Entries::parse(&STRUCTURE, "case", text).unwrap();
                entries.set(&set).unwrap();
                let Ok(given) = Structure::from_entries(&entries) else {
                    continue;
                };
                let Ok(written) = moordyn::write("case", &given, 20) else {
                    continue;
                };
                println!("{set}");
                let reading = moordyn::read("case", &written).unwrap();
                the_same(&given, &Structure::from_entries(&reading.entries).unwrap());
            }
        }
    }
}

/// A key that the front matter has twice is refused, with its name.
#[test]
fn a_key_that_is_given_twice_is_refused() {
    let wave = include_str!("../../../../docs/examples/cylinder.toml");
    let entries = Entries::parse(&STRUCTURE, "case", wave).unwrap();
    let written = moordyn::write("case", &Structure::from_entries(&entries).unwrap(), 1).unwrap();
    let line = written
        .lines()
        .find(|line| line.contains("snapload: wave.height"))
        .unwrap();
    let twice = written.replace(line, &format!("{line}\nsnapload: wave.height = 3"));
    let refused = moordyn::read("case", &twice).err().unwrap().to_string();
    assert!(
        refused.contains("wave.height = 3") && refused.contains("the file has two"),
        "{refused}"
    );
}
