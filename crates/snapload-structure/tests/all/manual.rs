//! The manual's tables are those of the schema.

use crate::implausible::PONTOON;
use proptest::prelude::*;
use snapload::analysis::no_progress;
use snapload::{Bounds, DefaultValue, Entries, Kind};
use snapload_structure::note::inputs;
use snapload_structure::{ModelAtRest, STRUCTURE, Structure, assess};
use std::path::Path;

/// The keys that a file gives.
fn read(text: &str) -> Entries {
    Entries::parse(&STRUCTURE, "case", text).expect("a case")
}

/// The keys as the manual prints them.
fn table() -> String {
    let tables: Vec<String> = STRUCTURE
        .tables
        .iter()
        .map(|table| table.markdown())
        .collect();
    tables.join("\n") + "\n"
}

#[test]
fn the_manual_has_the_keys_of_the_schema() {
    let manual = include_str!("../../../../docs/structures.md");
    let (_, rest) = manual
        .split_once("<!-- keys -->\n")
        .expect("the beginning of the keys");
    let (printed, _) = rest.split_once("<!-- /keys -->").expect("their end");
    assert!(
        printed == table(),
        "docs/structures.md should have\n{}",
        table()
    );
}

/// Without a required key a case is refused in words that name it.
#[test]
fn what_is_required_can_not_be_left_out() {
    let example = include_str!("../../../../docs/examples/cylinder.toml");
    let mut required = 0;
    for table in STRUCTURE
        .tables
        .iter()
        .filter(|table| !matches!(table.name, "sea" | "float"))
    {
        for key in table
            .keys
            .iter()
            .filter(|key| key.default == DefaultValue::Required)
        {
            required += 1;
            let without: String = example
                .lines()
                .filter(|line| !line.starts_with(&format!("{} =", key.name)))
                .map(|line| format!("{line}\n"))
                .collect();
            let error = Structure::parse("case", &without)
                .expect_err(key.name)
                .to_string();
            assert!(
                error.contains(key.name) && error.contains("left out"),
                "{error}"
            );
        }
    }
    assert_eq!(required, 11);
}

/// A value that a key may have, for `--set`.
pub fn values(kind: Kind) -> Vec<String> {
    match kind {
        Kind::Number(Bounds { low, high, .. }) => {
            let part = |of: f64| format!("{}", low + of * (high.min(low.abs() + 20.0) - low));
            vec![part(0.13), part(0.37)]
        }
        Kind::Pair(_) => vec!["[0.25, -3.25]".to_owned()],
        Kind::Triple(_) => vec!["[5e4, 9e4, 2e5]".to_owned()],
        Kind::PerFreedom(_) => vec!["7e4".to_owned(), "[5e4, 9e4, 2e5]".to_owned()],
        Kind::Count(low, high) => vec![(low + (high - low) / 3).to_string()],
        Kind::Flag => vec!["true".to_owned(), "false".to_owned()],
        Kind::Choice(words) => words.iter().map(|word| format!("{word:?}")).collect(),
        Kind::Text => vec!["\"other\"".to_owned()],
    }
}

/// A note has these tables at its head, under its checks, and with the floating body; and
/// `max_snaps` if that ended the run.
const TOLD_ELSEWHERE: [&str; 3] = ["project", "design", "float"];

/// No key is ignored: with another value that is accepted the structure is another, and so are the
/// inputs that a note lists. Those that need other keys are refused without them.
#[test]
fn every_key_makes_a_difference() {
    let wave = include_str!("../../../../docs/examples/cylinder.toml");
    let sea = include_str!("../../../../docs/examples/cylinder-sea.toml");
    let afloat = include_str!("../../../../docs/examples/pontoon.toml");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/examples");
    let structure = |entries: &Entries| Structure::from_entries_beside(entries, &folder);
    let with_structure = |text| (text, structure(&read(text)).expect("an example"));
    let [wave, sea, afloat, pontoon] = [wave, sea, afloat, PONTOON].map(with_structure);
    for table in STRUCTURE.tables {
        let path = match table.name {
            "line" => "line.1",
            name => name,
        };
        for key in table.keys {
            let key_path = format!("{path}.{}", key.name);
            let elsewhere = TOLD_ELSEWHERE.contains(&table.name) || key.name == "max_snaps";
            // These need other keys, without which they are refused.
            let is_refused = ["float", "design"].contains(&table.name)
                || ["shape", "current"].contains(&key.name);
            // Some keys are of a body that floats, and some of one that does not.
            let texts = match table.name {
                "float" => vec![&afloat],
                "sea" => vec![&sea],
                _ => vec![&wave, &pontoon],
            };
            let (mut differs, mut shown) = (false, elsewhere);
            let tried = texts.into_iter().flat_map(|(text, before)| {
                let own = read(text).table(table.name, 0).given(key.name).cloned();
                let near = own.and_then(|own| Some(format!("{}", 1.01 * own.number()?)));
                let values = values(key.kind).into_iter().chain(near);
                values.map(move |value| (text, before, value))
            });
            for (text, before, value) in tried {
                let mut entries = read(text);
                let set = entries.set(&format!("{key_path}={value}"));
                set.expect("a value of its kind");
                let Ok(after) = structure(&entries) else {
                    (differs, shown) = (differs || is_refused, shown || is_refused);
                    continue;
                };
                differs |= after != *before;
                shown |= inputs(&after) != inputs(before);
                if differs && shown {
                    break;
                }
            }
            assert!(differs, "{key_path}");
            assert!(shown, "inputs.html is without {key_path}");
        }
    }
}

#[test]
fn errors_name_the_line_the_key_and_what_to_do() {
    let example = include_str!("../../../../docs/examples/cylinder.toml");
    let refusal = |from: &str, to: &str| -> String {
        let text = example.replacen(from, to, 1);
        assert_ne!(text, example);
        Structure::parse("case.toml", &text)
            .expect_err(to)
            .to_string()
    };
    let typo = refusal("mass = 72452", "mas = 72452");
    assert!(
        typo.starts_with("case.toml, line ") && typo.contains("did you mean mass?"),
        "{typo}"
    );
    let table = refusal("[site]", "[stie]");
    assert!(table.contains("did you mean site?"), "{table}");
    let twice = refusal("[site]", "[body]");
    assert!(
        twice.contains("[body] occurs twice; write all its keys below one"),
        "{twice}"
    );
    let many = refusal("[body]", "[[body]]");
    assert!(
        many.contains("body (an array of tables, in double brackets) is not allowed"),
        "{many}"
    );
    let lines = refusal("[[line]]", "[line]");
    assert!(lines.contains("[[line]]"), "{lines}");
    let mut entries = read(example);
    let above = entries.set("height=2").expect_err("no table").to_string();
    assert!(
        above.contains("hint: write body.height or wave.height"),
        "{above}"
    );
    let below = refusal("depth = 10", "depth = 10\nrestitution = 0.5");
    assert!(
        below.contains("hint: restitution is a key of [run]; write it below that line"),
        "{below}"
    );
    let kind = refusal("depth = 10", "depth = \"ten\"");
    assert!(
        kind.contains(
            "site.depth = \"ten\" is not allowed; allowed: a number in m, 0 < depth <= 12000"
        ),
        "{kind}"
    );
    let word = refusal("studless chain", "studles chain");
    assert!(
        word.contains("line.1.type") && word.contains("\"studless chain\""),
        "{word}"
    );
    let heavy = refusal("mass = 72452", "mass = 172452");
    assert!(
        heavy.contains("body.mass = 172452") && heavy.contains("sinks"),
        "{heavy}"
    );
    let short = refusal("length = 6", "length = 5");
    assert!(
        short.contains("line.1.length = 5") && short.contains("5.999 m"),
        "{short}"
    );
    let above = refusal("position = [0, -3.5]", "position = [0, 3.5]");
    assert!(above.contains("z < 0"), "{above}");
    let comparison = format!("{example}[sea]\nhs = 2\ntp = 6\n");
    let comparison = Structure::parse("case.toml", &comparison)
        .expect_err("both")
        .to_string();
    assert!(
        comparison.contains("one of [wave] and [sea]"),
        "{comparison}"
    );
}

#[test]
fn set_changes_one_line_or_all() {
    let example = include_str!("../../../../docs/examples/cylinder.toml");
    let mut entries = read(example);
    entries.set("line.2.length=6.5").unwrap();
    entries.set("line.diameter = 0.05").unwrap();
    entries.set("line.1.type=nylon").unwrap();
    entries.set("body.position=[0, -3.6]").unwrap();
    let structure = Structure::from_entries(&entries).unwrap();
    assert_eq!(
        (structure.lines[0].length_m, structure.lines[1].length_m),
        (6.0, 6.5)
    );
    assert_eq!(structure.lines[0].name, "nylon, 50 mm");
    assert_eq!(structure.lines[1].name, "studless chain R3, 50 mm");
    assert_eq!(structure.body.position_m, [0.0, -3.6]);
    for (bad, says) in [
        ("line.3.length=6", "from 1 to 2"),
        ("wave.hight=2", "did you mean height?"),
        ("wave.height", "TABLE.KEY=VALUE"),
        ("wave.height=", "(nothing)"),
        ("line.restitution=0.5", "hint: write run.restitution"),
        ("line.1.restitution=0.5", "hint: write run.restitution"),
        ("design=5", "design.pretension_factor"),
    ] {
        let error = entries.set(bad).expect_err(bad).to_string();
        assert!(error.contains(says), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Any text is either read or refused with a message, and a structure that is read has a
    /// position of rest or is refused.
    #[test]
    fn anything_is_read_or_refused(text in any::<String>(), broken in "(\\[?\\[[a-z]{1,5}\\]?\\]|[a-z]{1,6} = [-0-9.e\\[\\]\"]{0,5}|\n){0,12}") {
        for text in [text, broken] {
            if let Err(error) = Structure::parse("case", &text) {
                prop_assert!(!error.to_string().is_empty());
            }
        }
    }

    #[test]
    fn extreme_numbers_are_computed_or_refused(
        key in prop::sample::select(vec![
            "body.mass", "body.displaced_volume", "body.width", "body.added_mass", "body.moment_of_inertia",
            "line.1.length", "line.length", "site.depth", "wave.height", "wave.period", "line.1.spring_rate",
        ]),
        value in prop_oneof![Just(1e-300), Just(1e-9), Just(0.3), Just(20.0), Just(1e4), Just(1e5), Just(1e12), 0.1..1e6],
    ) {
        let mut entries = read(include_str!("../../../../docs/examples/cylinder.toml"));
        if entries.set(&format!("{key}={value:e}")).is_ok()
            && let Ok(structure) = Structure::from_entries(&entries)
            && let Ok(prepared) = ModelAtRest::new(structure)
        {
            prop_assert!(prepared.rest.place_m.iter().all(|x| x.is_finite()));
            prop_assert!(prepared.rest.tension_n.iter().all(|tension| tension.is_finite() && *tension >= 0.0));
        }
    }
}

/// Whatever the least value of a key, a report has no infinite number and none of hundreds of
/// digits; what is smaller is refused.
#[test]
fn the_least_values_leave_a_report_readable() {
    let example = include_str!("../../../../docs/examples/cylinder.toml");
    let with = |key: &str, value: &str| {
        let mut entries = read(example);
        entries.set(&format!("{key}={value}")).map(|()| entries)
    };
    for (key, least) in [
        ("line.breaking_load", "1e-6"),
        ("line.stiffness", "1e-6"),
        ("line.diameter", "1e-5"),
        ("body.width", "1e-4"),
    ] {
        let entries = with(key, least).expect("a value");
        let structure = Structure::from_entries(&entries).expect("a structure");
        let assessment = assess(structure, 0, &no_progress).expect("an assessment");
        let summary = assessment.summary("case");
        let mut words = summary.split_whitespace();
        let long = words.find(|word| word.len() > 25 || word.starts_with("inf,"));
        assert_eq!(long, None, "{key}: {summary}");
        let smaller = with(key, "1e-300").expect_err("a refusal").to_string();
        assert!(smaller.contains(&format!("{least} <= ")), "{smaller}");
    }
}
