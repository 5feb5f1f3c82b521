//! The documents say what is.

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).expect(path)
}

/// Every file that the tree of ARCHITECTURE.md names is there, and every source of the library is
/// named.
#[test]
fn the_architecture_is_true() {
    let text = read("ARCHITECTURE.md");
    let tree = text.split("```").nth(1).expect("a tree");
    let mut folder = String::new();
    let mut named = Vec::new();
    for line in tree
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with("text"))
    {
        let name = line.split_whitespace().next().expect("a name");
        if name.ends_with('/') && !line.starts_with(' ') {
            folder = name.to_string();
            assert!(root().join(name).is_dir(), "{name}");
        } else if name.ends_with(".rs") {
            let path = format!("{folder}src/{name}");
            assert!(root().join(&path).is_file(), "{path}");
            named.push(name.to_string());
        } else if !line.starts_with(' ') {
            assert!(root().join(name).exists(), "{name}");
        }
    }
    for folder in ["", "analysis/", "analysis/trust/"] {
        let path = root().join("crates/snapload/src").join(folder);
        for entry in std::fs::read_dir(path).expect("sources") {
            let name = entry.expect("a file").file_name();
            let name = format!("{folder}{}", name.to_string_lossy());
            let is_folder = root().join("crates/snapload/src").join(&name).is_dir();
            let known = named.contains(&name) || is_folder;
            assert!(known, "ARCHITECTURE.md does not name {name}");
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

/// What the documents print of the standard case is what the program prints.
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

/// And of the structure that the manual works through.
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
