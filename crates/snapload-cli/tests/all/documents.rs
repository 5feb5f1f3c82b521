//! The documents agree with the source and with the program's output.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).expect(path)
}

/// Every file that the tree of ARCHITECTURE.md names exists, and the tree names every source file
/// of the crates; those of a folder may have one line together, and so have the sections of the
/// chapter.
#[test]
fn the_architecture_is_true() {
    let text = read("ARCHITECTURE.md");
    let tree = text.split("```").nth(1).expect("a tree");
    let mut folder = String::new();
    let (mut named, mut together_named) = (Vec::new(), Vec::new());
    for line in tree
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with("text"))
    {
        let name = line.split_whitespace().next().expect("a name");
        if name.ends_with('/') && !line.starts_with(' ') {
            folder = name.to_string();
            assert!(root().join(name).is_dir(), "{name}");
        } else if let Some(together) = name.strip_suffix("/*.rs") {
            together_named.push(root().join(&folder).join("src").join(together));
        } else if name.ends_with(".rs") {
            named.push(root().join(&folder).join("src").join(name));
        } else if !line.starts_with(' ') {
            assert!(root().join(name).exists(), "{name}");
        }
    }
    for path in &named {
        assert!(path.is_file(), "{}", path.display());
    }
    let crates = std::fs::read_dir(root().join("crates")).expect("crates");
    let crates = crates.map(|entry| entry.expect("a crate").path().join("src"));
    let mut folders: Vec<PathBuf> = crates.collect();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("sources") {
            let path = entry.expect("a file").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let together = path
                    .parent()
                    .is_some_and(|folder| together_named.iter().any(|named| named == folder));
                let chapter = path.to_string_lossy().contains("/section_");
                let known = named.contains(&path) || together || chapter;
                assert!(known, "ARCHITECTURE.md does not name {}", path.display());
            }
        }
    }
}

/// Links between the documents lead somewhere.
#[test]
fn links_lead_somewhere() {
    let documents = [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "docs/README.md",
    ];
    let pages = std::fs::read_dir(root().join("docs")).expect("docs");
    let pages = pages.filter_map(|page| {
        let name = page.ok()?.file_name().to_string_lossy().into_owned();
        name.ends_with(".md").then(|| format!("docs/{name}"))
    });
    for document in documents.map(str::to_owned).into_iter().chain(pages) {
        let text = read(&document);
        let folder = root().join(&document);
        let folder = folder.parent().expect("a folder");
        for target in text
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
        {
            if !target.starts_with("http") {
                let file = target.split('#').next().unwrap_or_default();
                assert!(folder.join(file).exists(), "{document} links to {target}");
            }
        }
    }
}

/// The output of the standard case that the documents print is that of the program.
#[test]
fn the_printed_output_is_the_programs() {
    let mut program = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("snapload"));
    let output = program.arg("run").output().expect("a run").stdout;
    let output = String::from_utf8(output).expect("text");
    for document in ["README.md", "docs/start.md"] {
        assert!(
            read(document).contains(&output),
            "{document} prints something else than\n{output}"
        );
    }
}

/// The same for the coefficients of the manual's floating body.
#[test]
fn the_printed_hydrodynamics_are_the_programs() {
    let mut program = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("snapload"));
    let output = program
        .current_dir(root())
        .args(["hydro", "docs/examples/pontoon.nc"])
        .output()
        .expect("a run")
        .stdout;
    let output = String::from_utf8(output).expect("text");
    assert!(
        read("docs/hydrodynamics.md").contains(&output),
        "docs/hydrodynamics.md prints something else than\n{output}"
    );
}

/// The same for the floating pontoon.
#[test]
fn the_printed_pontoon_is_the_programs() {
    for command in [
        "hydro docs/examples/pontoon-10m.nc --mass 80000 --centre 0,-0.2 --inertia 133000 \
         --damping 0,0,50000",
        "assess docs/examples/pontoon.toml --set run.duration=600 --neighbours 10",
    ] {
        let mut program = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("snapload"));
        let program = program.current_dir(root()).args(command.split_whitespace());
        let output = program.output().expect("a run").stdout;
        let output = String::from_utf8(output).expect("text");
        assert!(
            read("docs/pontoon.md").contains(&output),
            "docs/pontoon.md prints something else than\n{output}"
        );
    }
    let case = read("docs/examples/pontoon.toml");
    assert!(read("docs/pontoon.md").contains(case.trim_end()));
}

/// The same for the pontoon on elastic lines, except for the computing time.
#[test]
fn the_printed_pulls_are_the_programs() {
    let mut program = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("snapload"));
    let output = program
        .current_dir(root())
        .args([
            "elastic",
            "docs/examples/cylinder.toml",
            "--set",
            "run.duration=12",
        ])
        .output()
        .expect("a run")
        .stdout;
    let output = String::from_utf8(output).expect("text");
    let (head, rows) = output.split_once('\n').expect("rows");
    let (before, _) = head.split_once("computed twice in").expect("a time");
    let manual = read("docs/elastic.md");
    assert!(
        manual.contains(before) && manual.contains(rows),
        "docs/elastic.md prints something else than\n{output}"
    );
}

/// The same for the structure that the manual assesses.
#[test]
fn the_printed_assessment_is_the_programs() {
    let mut program = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("snapload"));
    let output = program
        .current_dir(root())
        .args(["assess", "docs/examples/cylinder.toml"])
        .output()
        .expect("a run")
        .stdout;
    let output = String::from_utf8(output).expect("text");
    assert!(
        read("docs/structures.md").contains(&output),
        "docs/structures.md prints something else than\n{output}"
    );
}

/// The same for the records of its sea.
#[test]
fn the_printed_records_are_the_programs() {
    let command = "seas docs/examples/cylinder-sea.toml --seeds 8";
    let mut program = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("snapload"));
    let program = program.current_dir(root()).args(command.split_whitespace());
    let output = program.output().expect("a run").stdout;
    let output = String::from_utf8(output).expect("text");
    assert!(
        read("docs/structures.md").contains(&format!("$ snapload {command}\n{output}")),
        "docs/structures.md prints something else than\n{output}"
    );
}

/// The keys of an answer, at any depth.
fn keys_of(answer: &serde_json::Value, keys: &mut BTreeSet<String>) {
    match answer {
        serde_json::Value::Object(entries) => {
            for (key, value) in entries {
                keys.insert(key.clone());
                keys_of(value, keys);
            }
        }
        serde_json::Value::Array(values) => values.iter().for_each(|value| keys_of(value, keys)),
        _ => {}
    }
}

/// The manual describes each key of the answers about structures and floating bodies.
#[test]
fn every_key_of_the_json_is_described() {
    let manual = read("docs/json.md");
    let cylinder = "docs/examples/cylinder.toml";
    let short = ["--set", "run.duration=60"];
    let design = ["--set", "design.least_share=0.1"];
    let lines = ["--line", "6,-10,2,-1.2,9.6", "--line=-6,-10,-2,-1.2,9.6"];
    let sea = ["docs/examples/cylinder-sea.toml", "--seeds", "10"];
    let afloat = ["assess", "docs/examples/pontoon.toml", "--neighbours", "0"];
    let pontoon = "docs/examples/pontoon-10m.nc";
    let commands: [Vec<&str>; 6] = [
        [
            &["assess", cylinder, "--neighbours", "2"][..],
            &short,
            &design,
        ]
        .concat(),
        [&afloat[..], &short].concat(),
        [&["elastic", cylinder][..], &short, &design].concat(),
        [
            &["seas"][..],
            &sea,
            &["--set", "run.duration=1200"],
            &design,
        ]
        .concat(),
        [
            &[
                "hydro", pontoon, "--hs", "1", "--tp", "6", "--mass", "80000",
            ][..],
            &lines,
        ]
        .concat(),
        vec!["decay", pontoon],
    ];
    for command in commands {
        let mut program = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("snapload"));
        let done = program
            .current_dir(root())
            .args(&command)
            .args(["--json", "-"]);
        let answer = serde_json::from_slice(&done.output().expect("a run").stdout).expect("JSON");
        let mut keys = BTreeSet::new();
        keys_of(&answer, &mut keys);
        assert!(keys.len() > 8, "{command:?}");
        for key in keys {
            assert!(manual.contains(&format!("`{key}`")), "{command:?}: {key}");
        }
    }
}
