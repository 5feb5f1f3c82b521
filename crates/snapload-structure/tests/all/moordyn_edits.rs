//! Files that were written for MoorDyn, then changed in their tables, and read: the case is that
//! which MoorDyn computes.

use snapload::Entries;
use snapload_structure::{STRUCTURE, Structure, moordyn};

const CYLINDER: &str = include_str!("../../../../docs/examples/cylinder.toml");
/// A body whose added mass has three values, which is put below its position.
const STARTED: [&str; 3] = [
    "body.added_mass=[150000, 140000, 9000]",
    "run.start=[0.1, -3.9]",
    "run.duration=7.3",
];

fn written(sets: &[&str]) -> String {
    let mut entries = Entries::parse(&STRUCTURE, "case", CYLINDER).unwrap();
    sets.iter().for_each(|set| entries.set(set).unwrap());
    moordyn::write("case", &Structure::from_entries(&entries).unwrap(), 1).unwrap()
}

fn read(text: &str) -> (Structure, Vec<String>) {
    let reading = moordyn::read("lines.txt", text).unwrap();
    let case = Structure::from_entries(&reading.entries).unwrap();
    (case, reading.notes)
}

/// The row of a section with this number of an object or name of an option.
fn row<'a>(text: &'a str, section: &str, name: &str) -> &'a str {
    let header = format!("- {section} -");
    let below = text.split_once(&header).unwrap().1.lines().skip(1);
    let mut rows = below.take_while(|line| !line.starts_with("---"));
    let named = |line: &&str| line.split_whitespace().take(2).any(|word| word == name);
    rows.find(named).unwrap()
}

/// A file with another word in a column of a row.
fn with(text: &str, (section, name): (&str, &str), column: usize, word: &str) -> String {
    let old = row(text, section, name);
    let mut words: Vec<&str> = old.split_whitespace().collect();
    assert_ne!(words[column], word);
    words[column] = word;
    text.replacen(old, &words.join("  "), 1)
}

/// The tables without what `write` computes from the rest for MoorDyn's sake: diameters by which
/// lines weigh nothing, the damper of the restitution and the time step.
fn tables(text: &str) -> Vec<Vec<String>> {
    let rows = text.lines().skip_while(|line| !line.contains("LINE TYPES"));
    let cells = |line: &str| -> Vec<String> {
        let words = line.split_whitespace().map(str::to_owned);
        match line.starts_with("line") {
            true => words
                .take(4)
                .enumerate()
                .filter(|(i, _)| *i != 1)
                .map(|(_, w)| w)
                .collect(),
            false => words.collect(),
        }
    };
    rows.filter(|line| !line.contains("dtM"))
        .map(cells)
        .collect()
}

/// Whether two cells are the same up to rounding of their numbers.
fn same(a: &str, b: &str) -> bool {
    let numbers =
        |cell: &str| -> Option<Vec<f64>> { cell.split('|').map(|n| n.parse().ok()).collect() };
    match (numbers(a), numbers(b)) {
        (Some(a), Some(b)) if a.len() == b.len() => a
            .iter()
            .zip(&b)
            .all(|(a, b)| (a - b).abs() < 1e-9 * (1.0 + a.abs())),
        _ => a == b,
    }
}

const BODY: (&str, &str) = ("BODIES", "1");

/// Whichever cell was changed, the case is written with the tables of the file: what the front
/// matter says otherwise does not count. A change is noted where the front matter has the value,
/// too, with both.
#[test]
fn a_case_has_the_tables_of_its_file() {
    let plain = written(&[]);
    let started = written(&STARTED);
    for (text, of, column, word, notes) in [
        (
            &plain,
            BODY,
            4,
            "-4.5",
            &[
                "body.position = [0, -3.5]",
                "line.1.fairlead = [1.061, -4.561]",
                "line.2",
            ][..],
        ),
        (&plain, BODY, 8, "70000", &[]),
        (&plain, BODY, 10, "160000", &[]),
        (&plain, BODY, 11, "150", &[]),
        (&plain, BODY, 12, "4|0", &[]),
        (&plain, BODY, 13, "0.9", &[]),
        (
            &plain,
            ("POINTS", "4"),
            2,
            "-1.3",
            &["line.2.fairlead = [-1.061, -4.561]"],
        ),
        (
            &plain,
            ("POINTS", "4"),
            4,
            "-1.0610001",
            &["line.2.fairlead = [-1.061, -4.561]"],
        ),
        (&plain, ("POINTS", "1"), 2, "3.6", &[]),
        (&plain, ("LINES", "2"), 4, "6.01", &[]),
        (&plain, ("LINE TYPES", "line2"), 2, "30", &[]),
        (&plain, ("LINE TYPES", "line2"), 3, "1e8", &[]),
        (&plain, ("OPTIONS", "WtrDpth"), 0, "10.5", &[]),
        (&plain, ("OPTIONS", "rho"), 0, "1000", &[]),
        (&plain, ("OPTIONS", "g"), 0, "9.81", &[]),
        (&started, BODY, 4, "-3.95", &["run.start = [0.1, -3.9]"]),
        (&started, BODY, 2, "0", &["run.start = [0.1, -3.9]"]),
        (
            &started,
            BODY,
            10,
            "200000",
            &["body.added_mass = [", "body.moment_of_inertia = 163017"],
        ),
        (&started, BODY, 11, "150", &["body.added_mass = ["]),
        (&started, BODY, 13, "0.9|0.9|1.1", &["body.added_mass = ["]),
        (&started, BODY, 13, "0.9", &["body.added_mass = ["]),
        (
            &started,
            ("POINTS", "2"),
            4,
            "-1.3",
            &["line.1.fairlead = [1.061, -4.561]"],
        ),
        (
            &started,
            ("OPTIONS", "rho"),
            0,
            "1000",
            &["body.added_mass = ["],
        ),
    ] {
        let file = with(text, of, column, word);
        let (case, given_notes) = read(&file);
        let again = moordyn::write("case", &case, 1).unwrap();
        let (expected, again) = (tables(&file), tables(&again));
        assert_eq!(expected.len(), again.len());
        for (a, b) in expected.iter().zip(&again) {
            assert!(
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
                "{of:?} {word}: {a:?} {b:?}"
            );
        }
        // A density or mass other than that of the line's diameter is another note.
        let overruled: Vec<&String> = given_notes
            .iter()
            .filter(|note| note.contains("front matter"))
            .collect();
        assert_eq!(overruled.len(), notes.len(), "{of:?} {word}: {overruled:?}");
        for (note, says) in overruled.iter().zip(notes) {
            assert!(
                note.contains(says) && note.contains("the tables have"),
                "{note}"
            );
        }
    }
}

/// What the tables do not have stays as it is when they are changed.
#[test]
fn changed_tables_leave_the_rest() {
    let before = read(&written(&STARTED)).0;
    let (after, notes) = read(&with(&written(&STARTED), BODY, 4, "-3.95"));
    assert_eq!(after.start_m, Some([0.1, -3.95]));
    assert!(
        notes[0].ends_with("the tables have [0.1, -3.95]."),
        "{notes:?}"
    );
    // The fairleads are drawn with the body at its position, to which they did not move.
    assert_eq!(after.lines, before.lines);
    let inertia = |case: &Structure| (case.body.moment_of_inertia_kg_m2, case.body.added_mass);
    assert_eq!(inertia(&after), inertia(&before));
    assert_eq!(
        (after.water, after.body.position_m),
        (before.water, before.body.position_m)
    );

    let (after, _) = read(&with(&written(&STARTED), BODY, 13, "0.9|0.9|1.1"));
    assert_eq!(after.body.added_mass.pitch_kg_m2, 9000.0);
    assert_eq!(
        after.body.moment_of_inertia_kg_m2,
        before.body.moment_of_inertia_kg_m2
    );

    let (after, _) = read(&with(&written(&[]), BODY, 4, "-4.5"));
    assert_eq!(after.body.position_m, [0.0, -4.5]);
    assert!((after.lines[0].fairlead_m[1] + 4.5 + 1.061).abs() < 1e-12);
    assert_eq!(
        after.lines[0].breaking_load_n,
        before.lines[0].breaking_load_n
    );
    assert_eq!(after.water, before.water);
}

/// A table that another program has written with fewer digits, twelve here, was not changed.
#[test]
fn rounding_of_the_tables_is_no_change() {
    let sets = [
        "body.position=[0.1, -3.7]",
        "body.added_mass=[150000, 140000, 9000]",
    ];
    let text = written(&sets);
    let before = read(&text).0;
    let rounded = |line: &str| -> String {
        let number = |part: &str| match part.parse::<f64>() {
            Ok(n) => format!("{n:.11e}"),
            Err(_) => part.to_owned(),
        };
        let cell = |cell: &str| cell.split('|').map(number).collect::<Vec<_>>().join("|");
        line.split_whitespace()
            .map(cell)
            .collect::<Vec<_>>()
            .join("  ")
            + "\n"
    };
    let changed: String = text
        .lines()
        .map(
            |line| match line.starts_with("1  Free") || line.contains("Body1") {
                // The numbers of objects and the name stay.
                true => {
                    let (id, rest) = line.split_once("  ").unwrap();
                    format!("{id}  {}", rounded(rest))
                }
                false => format!("{line}\n"),
            },
        )
        .collect();
    assert_ne!(changed, text);
    let (after, notes) = read(&changed);
    assert_eq!(notes, Vec::<String>::new());
    assert_eq!(after.body.position_m, before.body.position_m);
    assert_eq!(after.body.added_mass, before.body.added_mass);
    assert_eq!(after.lines, before.lines);
}

/// The front matter of a line belongs to the row with its number: to no other if that is removed,
/// and not to a row that has become another line's.
#[test]
fn rows_of_lines_keep_their_own_keys() {
    let sets = [
        "line.1.breaking_load=1e6",
        "line.2.breaking_load=2e6",
        "line.2.length=6.02",
    ];
    let text = written(&sets);
    let (first, second) = (row(&text, "LINES", "line1"), row(&text, "LINES", "line2"));
    let notes_of = |notes: &[String], says: &[&str]| {
        assert_eq!(notes.len(), says.len(), "{notes:?}");
        for (note, says) in notes.iter().zip(says) {
            assert!(note.contains(says), "{note}");
        }
    };
    let loads = |text: &str| {
        let reading = moordyn::read("lines.txt", text).unwrap();
        let (case, notes) = (reading.entries, reading.notes);
        let load = |i| case.table("line", i).get("breaking_load").unwrap();
        let loads: Vec<Option<f64>> = (0..case.count("line")).map(load).collect();
        (loads, notes)
    };

    let (left, notes) = loads(&text.replace(&format!("{first}\n"), ""));
    assert_eq!(left, [Some(2e6)]);
    let gone = "left out: the tables have no line 1";
    notes_of(&notes, &[gone, gone]);

    let swapped = text.replace(&format!("{first}\n{second}"), &format!("{second}\n{first}"));
    let (left, notes) = loads(&swapped);
    assert_eq!(left, [Some(2e6), Some(1e6)]);
    notes_of(&notes, &[]);

    // The second line is numbered anew, and has neither the fairlead nor the rope of the first.
    let renumbered = text
        .replace(&format!("{first}\n"), "")
        .replace(second, &second.replacen('2', "1", 1));
    let (left, notes) = loads(&renumbered);
    assert_eq!(left, [None]);
    let gone = "left out: the tables have no line 2";
    notes_of(
        &notes,
        &[
            gone,
            gone,
            "line.1.fairlead",
            "line 1 is of type line2, not line1",
        ],
    );

    // A third line of the first one's type.
    let more = format!("{second}\n3  line1  1  4  6.5  1  -");
    let (left, notes) = loads(&text.replace(second, &more));
    assert_eq!(left, [Some(1e6), Some(2e6), None]);
    notes_of(&notes, &[]);
}

/// What a case can not represent is noted in a written file, too, and a number is that of one line.
#[test]
fn edits_that_a_case_can_not_have_are_reported() {
    let text = written(&[]);
    let kind = row(&text, "LINE TYPES", "line1");
    let mut words: Vec<&str> = kind.split_whitespace().collect();
    words[5..7].copy_from_slice(&["5000", "1.2"]);
    let (_, notes) = read(&text.replace(kind, &words.join("  ")));
    let note =
        "Type line1: EI = 5000, Cd = 1.2 left out: lines have no bending, drag or added mass.";
    assert_eq!(notes, [note]);

    let second = row(&text, "LINES", "line2");
    let twice = text.replace(second, &second.replacen('2', "1", 1));
    let error = moordyn::read("lines.txt", &twice).unwrap_err().to_string();
    assert!(
        error.contains("ID") && error.contains("no other line has"),
        "{error}"
    );

    // A type is named by lines.
    let twice = text.replace(kind, &format!("{kind}\n{kind}"));
    let error = moordyn::read("lines.txt", &twice).unwrap_err().to_string();
    assert!(
        error.contains("TypeName = line1") && error.contains("no other type has"),
        "{error}"
    );
}

/// A line that is added to a body which starts elsewhere is attached where the tables have it.
#[test]
fn an_added_line_is_drawn_with_the_body_at_its_position() {
    let text = written(&STARTED);
    let (second, point) = (row(&text, "LINES", "line2"), row(&text, "POINTS", "4"));
    let more = format!("{second}\n3  line1  1  5  6.5  1  -");
    let text = text.replace(
        point,
        &format!("{point}\n5  Body1  0.5  0  -1.25  0  0  0  0"),
    );
    let (case, notes) = read(&text.replace(second, &more));
    assert_eq!(case.lines[2].fairlead_m, [0.5, -4.75]);
    assert_eq!(notes, Vec::<String>::new());
}

/// In a file by hand the front matter gives what the tables leave out, and nothing else.
#[test]
fn the_front_matter_gives_what_is_left_out() {
    let text = written(&[]);
    let plain: String = text
        .lines()
        .filter(|line| !line.contains("fairlead") && !line.contains("  g  "))
        .map(|line| match line.contains("body.width") {
            true => format!("{line}\nsnapload: site.gravity = 9.8\nsnapload: site.depth = 12\n"),
            false => format!("{line}\n"),
        })
        .collect();
    let (case, notes) = read(&plain);
    // MoorDyn's gravity is a default that the file does not have.
    assert_eq!((case.site.gravity_m_s2, case.site.depth_m), (9.8, 10.0));
    assert_eq!(
        notes,
        ["site.depth = 12 of the front matter was overruled: the tables have 10."]
    );
}
