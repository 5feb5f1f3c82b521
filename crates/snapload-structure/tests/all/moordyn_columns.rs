//! Files that MoorDyn loads are read as it reads them: by the number and the order of their columns
//! and by its own words, whatever their headers say.

use snapload::Entries;
use snapload_structure::{STRUCTURE, Structure, moordyn};

const CYLINDER: &str = include_str!("../../../../docs/examples/cylinder.toml");

fn structure(sets: &[&str]) -> Structure {
    let mut entries = Entries::parse(&STRUCTURE, "case", CYLINDER).unwrap();
    sets.iter().for_each(|set| entries.set(set).unwrap());
    Structure::from_entries(&entries).unwrap()
}

fn written(sets: &[&str]) -> String {
    moordyn::write("case", &structure(sets), 1).unwrap()
}

/// A file with another text in place of one that it has.
fn with(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replace(from, to)
}

fn read(text: &str) -> (Structure, String) {
    let reading = moordyn::read("lines.txt", text).unwrap();
    let case = Structure::from_entries(&reading.entries).unwrap();
    (case, reading.notes.join("\n"))
}

fn refusal(text: &str) -> String {
    moordyn::read("lines.txt", text).unwrap_err().to_string()
}

/// In a row of POINTS of twelve columns MoorDyn takes the eighth to the tenth as a
/// force: such a force is refused and no drag, whatever its direction. Rows of nine
/// columns have drag in the eighth.
#[test]
fn forces_on_points_are_refused() {
    let file = written(&[]);
    let point = "2  Body1  1.061  0  -1.061  0  0  0  0\n";
    for (columns, name) in [
        ("0  0  -1e5  0  0", "Fz"),
        ("0  7  0  0  0", "Fy"),
        ("3  0  0  0  0", "Fx"),
        ("0  0  0  0.5  0", "CdA"),
        ("0  0  the  left  one", "Fz"),
    ] {
        let row = format!("2  Body1  1.061  0  -1.061  0  0  {columns}\n");
        let error = refusal(&with(&file, point, &row));
        let column = format!("point 2, {name} = ");
        assert!(error.contains(&column), "{columns}: {error}");
        let told = error.contains("body.constant_force");
        assert_eq!(told, name != "CdA", "{columns}: {error}");
    }
    let row = "2  Body1  1.061  0  -1.061  0  0  0  0  0  0  1\n";
    assert_eq!(read(&with(&file, point, row)).0, read(&file).0);
    let error = refusal(&with(&file, point, "2  Body1  1  0  -1  0  0  3  0\n"));
    assert!(error.contains("point 2, CdA = 3"), "{error}");
}

/// The header of a table is not read: old names of columns do not make it one of version 1. Its
/// types have nine columns, with which MoorDyn loads no file.
#[test]
fn versions_are_told_by_their_columns() {
    let file = written(&[]);
    for name in ["MassDenInAir", "MassDen"] {
        assert_eq!(read(&with(&file, "Mass/m", name)).0, read(&file).0);
    }
    let types = file.lines().filter(|line| line.starts_with("line1  "));
    let of_second: Vec<&str> = types.collect();
    let of_first = of_second[0].rsplit_once("  ").unwrap().0;
    let error = refusal(&with(&file, of_second[0], of_first));
    for words in ["line type line1", "columns = 9", "version 1 has nine"] {
        assert!(error.contains(words), "{words} in {error}");
    }
}

/// The words that MoorDyn has for a point, as the end of a line and as one that is moved.
#[test]
fn points_have_the_words_of_moordyn() {
    let file = written(&[]);
    for ends in ["P1  Point2", "c1  CON2", "point1  p2"] {
        let named = with(&file, "1  line1  1  2  6", &format!("1  line1  {ends}  6"));
        assert_eq!(read(&named).0, read(&file).0, "{ends}");
    }
    let error = refusal(&with(&file, "1  line1  1  2  6", "1  line1  1  Q2  6"));
    assert!(
        error.contains("AttachB = Q2") && !error.contains("rod"),
        "{error}"
    );
    let body = file.find("---------------------- BODIES").unwrap();
    let points = file.find("---------------------- POINTS").unwrap();
    let without_body = file[..body].to_owned() + &file[points..];
    for word in ["Fairlead", "CPLD", "Vessel"] {
        let coupled = without_body.replace("Body1", word);
        assert!(moordyn::read("lines.txt", &coupled).is_ok(), "{word}");
        // Beside a body such a point is not a free one.
        let error = refusal(&with(&file, "2  Body1", &format!("2  {word}")));
        assert!(
            error.contains(word) && !error.contains("free point"),
            "{error}"
        );
    }
}

/// What MoorDyn computes and a case has not is noted: the vibration that vortices cause, and an
/// uneven added mass that turns with the body.
#[test]
fn what_a_case_has_not_is_noted() {
    let file = written(&[]);
    let row = file
        .lines()
        .find(|line| line.starts_with("line1  "))
        .unwrap();
    for (columns, noted) in [
        ("  1.1", true),
        ("  1.1  0.08  0.18", true),
        ("  0  0.08  0.18", false),
    ] {
        let (_, notes) = read(&with(&file, row, &format!("{row}{columns}")));
        let words = "Type line1: Cl = 1.1 was left out: lines have no vortex-induced vibration.";
        assert_eq!(notes.contains(words), noted, "{columns}: {notes}");
    }
    let turns = "MoorDyn turns its uneven added mass with it";
    assert!(!file.contains(turns));
    let uneven = written(&["body.added_mass=[72000, 217000, 5e4]"]);
    assert!(uneven.contains(turns));
    // The case that was written has nothing to note.
    let turns = "MoorDyn turns it with the body";
    assert!(!read(&uneven).1.contains(turns));
    let kept = uneven
        .lines()
        .filter(|line| !line.starts_with("snapload: run"));
    let tables: String = kept.map(|line| line.to_owned() + "\n").collect();
    let notes = moordyn::read("lines.txt", &tables)
        .unwrap()
        .notes
        .join("\n");
    assert!(notes.contains(turns), "{notes}");
}

/// Without the option MoorDyn computes with the standard acceleration of free
/// fall, which is that of a case, too.
#[test]
fn gravity_is_the_standard_one_if_it_is_left_out() {
    let file = written(&[]);
    let without: String = file
        .lines()
        .filter(|line| !line.contains("gravity (m/s^2)"))
        .map(|line| line.to_owned() + "\n")
        .collect();
    assert_ne!(without, file);
    let (case, _) = read(&without);
    assert_eq!(case.site.gravity_m_s2, 9.80665);
    assert_eq!(case, read(&file).0);
}

/// Three hyphens begin a section wherever they stand: no text of a case may contain
/// them, and all of them come back.
#[test]
fn hyphens_in_texts_begin_no_section() {
    let texts = [
        "project.name=\"Marina --- mooring LINES\"",
        "project.date=\"2026 ----- 05\"",
        "project.client='a \\--- \"b\" -- c-'",
    ];
    let plain = written(&[]);
    let headers = |text: &str| text.matches("---").count();
    for name in [
        "case",
        "c---LINES.toml",
        "c-----LINES.toml",
        "c---------- POINTS",
    ] {
        let case = structure(&texts);
        let text = moordyn::write(name, &case, 1).unwrap();
        assert_eq!(headers(&text), headers(&plain), "{text}");
        assert_eq!(read(&text).0.project, case.project);
    }
}

/// The damper of the restitution is that of lines of one segment: those of several do not need a
/// restitution that it could have.
#[test]
fn lines_of_several_segments_need_no_damper() {
    let case = structure(&["run.restitution=0"]);
    assert!(moordyn::write("case", &case, 1).is_err());
    let (back, _) = read(&moordyn::write("case", &case, 20).unwrap());
    assert_eq!(back.restitution, 0.0);
}

/// With `TmaxIC` 0, under either of its names, the motion begins where a file puts the body, also in
/// a file that `write` has not made. Without it the body begins at rest.
#[test]
fn a_motion_begins_where_the_file_puts_the_body() {
    let let_go = written(&["run.start=[0.3, -4.2]", "wave.height=0"]);
    let of_others: Vec<&str> = let_go
        .lines()
        .filter(|line| !line.starts_with("snapload:"))
        .collect();
    let file = of_others.join("\n");
    assert!(file.contains("TmaxIC"), "{file}");
    for name in ["TmaxIC", "ICTmax"] {
        let entries = moordyn::read("lines.txt", &with(&file, "TmaxIC", name))
            .unwrap()
            .entries;
        let start = entries.table("run", 0).given("start").expect("a start");
        assert_eq!(start.to_string(), "[0.3, -4.2]");
    }
    let at_rest = with(&file, "0  TmaxIC", "60  TmaxIC");
    let entries = moordyn::read("lines.txt", &at_rest).unwrap().entries;
    assert!(entries.table("run", 0).given("start").is_none());
}

/// Options that concern MoorDyn's computation are left out in silence, and all others with a note.
#[test]
fn options_that_are_left_out_are_named() {
    let file = written(&[]);
    let option = file
        .lines()
        .find(|line| line.contains("WtrDpth"))
        .expect("an option");
    let among = |more: &str| read(&with(&file, option, &format!("{option}\n{more}"))).1;
    for known in ["0.001  dtM", "rk4  tScheme", "1.0  CV", "3e6  kBot"] {
        assert_eq!(among(known), read(&file).1, "{known}");
    }
    for (more, note) in [
        ("2  Wings", "Wings = 2 was left out: it is not known here."),
        (
            "start.txt  ICfile",
            "ICfile = start.txt was left out: give a start as run.start.",
        ),
        (
            "1  Currents",
            "Currents = 1 was left out: give a current as site.current.",
        ),
    ] {
        let notes = among(more);
        assert!(notes.contains(note), "{notes}");
    }
}

/// The file names the loads that it has for snapload alone.
#[test]
fn loads_that_only_snapload_computes_are_named() {
    let calm = written(&["wave.height=0", "body.linear_damping=0"]);
    assert!(!calm.contains("computes without"), "{calm}");
    let loaded = [
        "body.constant_force=[1e3, 0]",
        "body.drag_area=60",
        "site.current=0.5",
    ];
    let loaded = written(&loaded);
    let words = "MoorDyn computes without waves, body.constant_force, site.current: for snapload";
    assert!(loaded.contains(words), "{loaded}");
}
