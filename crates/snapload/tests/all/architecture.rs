//! The source uses files and crates only in the order that ARCHITECTURE.md gives.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("a file of the repository")
}

/// The levels of the line of ARCHITECTURE.md that begins with `first`: a name may use only the
/// names of the levels before its own.
fn levels(first: &str) -> BTreeMap<String, usize> {
    let text = read(&workspace().join("ARCHITECTURE.md"));
    let line = text
        .lines()
        .find(|line| line.starts_with(first) && line.contains("->"));
    let line = line.expect("arrows in ARCHITECTURE.md");
    let mut levels = BTreeMap::new();
    for (level, names) in line.split("->").enumerate() {
        for name in names.split(',') {
            levels.insert(name.trim().to_owned(), level);
        }
    }
    levels
}

/// The source files below a folder, with their paths seen from it.
fn sources(folder: &Path) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let name = path.strip_prefix(folder).expect("below it");
                found.push((name.to_string_lossy().replace('\\', "/"), read(&path)));
            }
        }
    }
    found.sort();
    found
}

/// The code of a file: without comments, and without the tests at its end.
fn code(text: &str) -> String {
    let kept = text.lines().take_while(|line| *line != "#[cfg(test)]");
    let kept = kept.filter(|line| !line.trim_start().starts_with("//"));
    kept.collect::<Vec<_>>().join("\n")
}

/// Every path that begins with `root`, with the braces of `use` spelt out.
fn paths(code: &str, root: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices(root) {
        let before = code[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':') {
            continue;
        }
        read_paths(
            &mut Vec::new(),
            &mut code[at + root.len()..].chars().peekable(),
            &mut found,
        );
    }
    found
}

/// Reads one path, or the list of them in braces, up to where it ends.
fn read_paths(
    prefix: &mut Vec<String>,
    rest: &mut std::iter::Peekable<std::str::Chars>,
    found: &mut Vec<Vec<String>>,
) {
    let depth = prefix.len();
    let mut word = String::new();
    while let Some(&c) = rest.peek() {
        match c {
            _ if c.is_alphanumeric() || c == '_' => word.push(c),
            ':' => {
                if !word.is_empty() {
                    prefix.push(std::mem::take(&mut word));
                }
            }
            '{' => {
                rest.next();
                while rest.peek().is_some_and(|c| *c != '}') {
                    read_paths(prefix, rest, found);
                    while rest.peek().is_some_and(|c| *c == ',' || c.is_whitespace()) {
                        rest.next();
                    }
                }
                rest.next();
                prefix.truncate(depth);
                return;
            }
            _ if c.is_whitespace() && word.is_empty() => {}
            _ => break,
        }
        rest.next();
    }
    if !word.is_empty() {
        prefix.push(word);
    }
    if prefix.len() > depth {
        found.push(prefix.clone());
    } else if rest.peek().is_some_and(|c| *c != '}' && *c != ',') {
        rest.next();
    }
    prefix.truncate(depth);
}

/// The items that a crate's root re-exports: the name of each, and its path.
fn reexports(root: &str) -> BTreeMap<String, Vec<String>> {
    let mut names = BTreeMap::new();
    for path in paths(&code(root), "pub use ") {
        if let Some(name) = path.last() {
            names.insert(name.clone(), path.clone());
        }
    }
    names
}

/// Which files of a crate each of its files uses. A folder within a room, or within a crate without
/// rooms, counts as one file.
fn uses(folder: &Path, depth: usize) -> BTreeMap<String, BTreeSet<String>> {
    let files = sources(folder);
    let place = |name: &str| {
        let parts: Vec<&str> = name.trim_end_matches(".rs").split('/').collect();
        let inner = parts.iter().take(depth).filter(|part| **part != "mod");
        inner.copied().collect::<Vec<_>>().join("/")
    };
    let root = files
        .iter()
        .find(|(name, _)| name == "lib.rs" || name == "main.rs");
    let outside = root.map_or_else(BTreeMap::new, |(_, text)| reexports(text));
    let places: BTreeSet<String> = files.iter().map(|(name, _)| place(name)).collect();
    let mut uses = BTreeMap::<String, BTreeSet<String>>::new();
    for (name, text) in &files {
        let from = place(name);
        if ["lib", "main"].contains(&from.as_str()) {
            continue;
        }
        let inside = from.rsplit_once('/').map(|(room, _)| room.to_owned());
        let mut all = paths(&code(text), "crate::");
        // `super` is a file of the same folder, if that folder is not counted as one file.
        if name.split('/').count() <= depth {
            for path in paths(&code(text), "super::") {
                all.push(inside.iter().cloned().chain(path).collect());
            }
        }
        for path in all {
            let path = outside
                .get(&path[0])
                .filter(|_| path.len() == 1)
                .unwrap_or(&path);
            let to = (1..=depth.min(path.len()))
                .rev()
                .map(|n| path[..n].join("/"));
            if let Some(to) = to.into_iter().find(|to| places.contains(to))
                && to != from
            {
                uses.entry(from.clone()).or_default().insert(to);
            }
        }
    }
    uses
}

/// A cycle among the files, if there is one.
fn cycle(uses: &BTreeMap<String, BTreeSet<String>>) -> Option<Vec<String>> {
    fn visit(
        at: &str,
        uses: &BTreeMap<String, BTreeSet<String>>,
        path_so_far: &mut Vec<String>,
        done: &mut BTreeSet<String>,
    ) -> Option<Vec<String>> {
        if let Some(start) = path_so_far.iter().position(|place| place == at) {
            return Some(path_so_far[start..].to_vec());
        }
        if !done.insert(at.to_owned()) {
            return None;
        }
        path_so_far.push(at.to_owned());
        let found = uses
            .get(at)
            .into_iter()
            .flatten()
            .find_map(|next| visit(next, uses, path_so_far, done));
        path_so_far.pop();
        found
    }
    let mut done = BTreeSet::new();
    uses.keys()
        .find_map(|at| visit(at, uses, &mut Vec::new(), &mut done))
}

#[test]
fn rooms_of_the_library_use_only_those_before_them() {
    let order = levels("arithmetic");
    let mut violations = Vec::new();
    for (name, text) in sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src")) {
        let Some((room, _)) = name.split_once('/') else {
            continue;
        };
        let own = order
            .get(room)
            .unwrap_or_else(|| panic!("no room {room} in ARCHITECTURE.md"));
        for path in paths(&code(&text), "crate::") {
            match order.get(&path[0]) {
                Some(level) if level < own || path[0] == room => {}
                _ => violations.push(format!("{name} uses {}", path.join("::"))),
            }
        }
    }
    assert!(
        violations.is_empty(),
        "against the arrows:\n{}",
        violations.join("\n")
    );
}

#[test]
fn crates_use_only_those_before_them() {
    let order = levels("library");
    let called = |package: &str| match package.strip_prefix("snapload-") {
        Some(name) => name.to_owned(),
        None => "library".to_owned(),
    };
    let mut violations = Vec::new();
    let mut manifests = vec![workspace().join("python/Cargo.toml")];
    for entry in fs::read_dir(workspace().join("crates")).expect("the crates") {
        manifests.push(entry.expect("a crate").path().join("Cargo.toml"));
    }
    for manifest in manifests {
        let text = read(&manifest);
        let line = text.lines().find_map(|line| line.strip_prefix("name = "));
        let own = called(line.expect("a name").trim_matches('"'));
        let level = order
            .get(&own)
            .unwrap_or_else(|| panic!("no crate {own} in ARCHITECTURE.md"));
        let ours = text
            .lines()
            .filter_map(|line| line.split(['.', ' ']).next());
        let used = ours.filter(|word| word.starts_with("snapload")).map(called);
        // A crate depends on itself only for its tests.
        for used in used.filter(|used| *used != own) {
            if order.get(&used).is_none_or(|other| other >= level) {
                violations.push(format!("{own} uses {used}"));
            }
        }
    }
    assert!(
        violations.is_empty(),
        "against the arrows:\n{}",
        violations.join("\n")
    );
}

#[test]
fn no_files_use_each_other_in_a_cycle() {
    let mut cycles = Vec::new();
    let mut folders = vec![(workspace().join("python/src"), 1)];
    for entry in fs::read_dir(workspace().join("crates")).expect("the crates") {
        let path = entry.expect("a crate").path();
        let depth = if path.ends_with("snapload") { 2 } else { 1 };
        folders.push((path.join("src"), depth));
    }
    for (folder, depth) in folders {
        if let Some(found) = cycle(&uses(&folder, depth)) {
            cycles.push(format!("{}: {}", folder.display(), found.join(" -> ")));
        }
    }
    assert!(cycles.is_empty(), "cycles:\n{}", cycles.join("\n"));
}

#[test]
fn paths_are_read_from_the_source() {
    let text = "use crate::a::{b, c::{d, e}};\n// crate::not::this\nlet x = crate::f::g(1);\n\
                pub use crate::h;\n#[cfg(test)]\nmod tests { use crate::tests_only::x; }";
    let found: Vec<String> = paths(&code(text), "crate::")
        .iter()
        .map(|path| path.join("::"))
        .collect();
    assert_eq!(found, ["a::b", "a::c::d", "a::c::e", "f::g", "h"]);
    let uses = BTreeMap::from([
        ("a".to_owned(), BTreeSet::from(["b".to_owned()])),
        ("b".to_owned(), BTreeSet::from(["c".to_owned()])),
        ("c".to_owned(), BTreeSet::from(["b".to_owned()])),
    ]);
    assert_eq!(
        cycle(&uses).map(|found| found.join(" ")),
        Some("b c".to_owned())
    );
}

/// A file of tests that its `main.rs` does not name is not compiled, and no test in it is run.
#[test]
fn every_test_file_is_compiled() {
    for krate in fs::read_dir(workspace().join("crates")).expect("the crates") {
        let folder = krate.expect("a crate").path().join("tests/all");
        if !folder.is_dir() {
            continue;
        }
        let main = read(&folder.join("main.rs"));
        for (name, _) in sources(&folder) {
            let module = name.trim_end_matches(".rs");
            if module != "main" && !module.contains('/') {
                let line = format!("mod {module};");
                let named = main.lines().any(|declared| declared.trim() == line);
                assert!(named, "{} has no line {line}", folder.display());
            }
        }
    }
}
