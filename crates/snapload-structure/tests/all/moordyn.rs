//! Cases for and from MoorDyn.

use proptest::prelude::*;
use snapload::Entries;
use snapload_structure::{STRUCTURE, Structure, moordyn};

const CYLINDER: &str = include_str!("../../../../docs/examples/cylinder.toml");

/// A cylinder on two lines as a person would write it after MoorDyn's manual.
const BY_HAND: &str = "\
--------------------- MoorDyn Input File ------------------------------------
A cylinder between two anchors, in the plane y = 2
----------------------- LINE TYPES ------------------------------------------
TypeName   Diam    Mass/m     EA         BA/-zeta    EI         Cd     Ca     CdAx    CaAx
(name)     (m)     (kg/m)     (N)        (N-s/-)     (N-m^2)    (-)    (-)    (-)     (-)
rope       0.06    3.0        4.0e6      -0.8        0          1.6    1.0    0.1     0.0
poly       0.06    3.0        2e6|8e6    1e3|1e4     0          1.6    1.0    0.1     0.0

---------------------------- BODIES -----------------------------------------------------
ID   Attachment  X0     Y0    Z0    r0      p0     y0     Mass   CG*   I*             Volume  CdA*   Ca
(#)  (-)         (m)    (m)   (m)   (deg)   (deg)  (deg)  (kg)   (m)   (kg-m^2)       (m^3)   (m^2)  (-)
1    free        10.0   2.0   -5    0       0      0      500    0     90|120|80      0.9     0.8|0  1.0
---------------------- POINT PROPERTIES --------------------------------
ID    Type      X       Y       Z       Mass   Volume  CdA    Ca
(#)   (-)       (m)     (m)     (m)     (kg)   (mˆ3)   (m^2)  (-)
1     Fixed     4       2       -20.0   0      0       0      0
2     Fixed     16      2       -20.0   0      0       0      0    ! the right one
3     Body1     -0.4    0.0     -0.3    0      0       0      0
4     Body1     0.4     0.0     -0.3    0      0       0      0
---------------------- LINES ----------------------------------------
ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#)   (name)     (#)      (#)       (m)       (-)     (-)
1     rope       1        3         16.0      20      -
2     poly       4        2         16.0      20      p
---------------------- OPTIONS -----------------------------------------
2             writeLog      Write a log file
0.002         dtM           time step to use in mooring integration (s)
1020.0        WtrDnsty      water density (kg/m^3)
20            WtrDpth       water depth (m)
------------------------- need this line --------------------------------------
";

fn structure(text: &str, sets: &[&str]) -> Structure {
    let mut entries = Entries::parse(&STRUCTURE, "case", text).unwrap();
    for set in sets {
        entries.set(set).unwrap();
    }
    Structure::from_entries(&entries).unwrap()
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * (1.0 + a.abs())
}

pub fn the_same(a: &Structure, b: &Structure) {
    // Numbers that pass through a product or a sum are equal up to rounding, all others exactly; a
    // line's name is that of a catalogue, which MoorDyn does not have.
    let mut b = b.clone();
    let (own, other) = (a.body.added_mass, b.body.added_mass);
    for (own, other) in [
        (own.surge_kg, other.surge_kg),
        (own.heave_kg, other.heave_kg),
        (own.pitch_kg_m2, other.pitch_kg_m2),
    ] {
        assert!(near(own, other), "{own} {other}");
    }
    // Values that were defaults are given explicitly in a written file.
    b.body.added_mass = own;
    b.transient_is_given = a.transient_is_given;
    for (own, other) in a.lines.iter().zip(&mut b.lines) {
        assert_eq!(other.name, "");
        other.name.clone_from(&own.name);
    }
    assert_eq!(*a, b);
}

#[test]
fn what_is_written_is_read_as_it_was() {
    let rectangle = [
        "body.shape=rectangle",
        "body.height=2.5",
        "body.added_mass=150000",
        "body.drag_area=4",
        "body.linear_damping=100.5",
        "body.turning_damping=33",
        "line.2.length=6.125",
        "run.start=[0.1, -3.9]",
        "run.duration=7.3",
        "wave.direction=-x",
    ];
    let sea = include_str!("../../../../docs/examples/cylinder-sea.toml");
    for (text, sets) in [
        (CYLINDER, &[][..]),
        (CYLINDER, &rectangle),
        (sea, &[]),
        (sea, &["sea.spectrum=pierson-moskowitz"]),
    ] {
        let before = structure(text, sets);
        for segments in [1, 20] {
            let written = moordyn::write("case.toml", &before, segments).unwrap();
            let reading = moordyn::read("lines.txt", &written).unwrap();
            assert_eq!(reading.notes, Vec::<String>::new());
            assert_eq!(reading.entries.missing(), Vec::<String>::new());
            the_same(&before, &Structure::from_entries(&reading.entries).unwrap());
            // The same by way of the file.
            the_same(&before, &structure(&reading.entries.to_toml(), &[]));
        }
    }
}

/// The numbers of a written file are those of MoorDyn's definitions: a line of one segment pulls
/// with EA (l − l0)/l0 + BA l̇/l0, so BA is c l0, and it weighs nothing in the water.
#[test]
fn a_line_of_one_segment_is_the_spring() {
    let case = structure(CYLINDER, &["run.restitution=0.3"]);
    let written = moordyn::write("case", &case, 1).unwrap();
    let row = written
        .lines()
        .find(|line| line.starts_with("line1 "))
        .unwrap();
    let numbers: Vec<f64> = row
        .split_whitespace()
        .skip(1)
        .map(|w| w.parse().unwrap())
        .collect();
    let (diameter, mass, stiffness, damping) = (numbers[0], numbers[1], numbers[2], numbers[3]);
    let weight = mass - 1025.0 * std::f64::consts::PI / 4.0 * diameter * diameter;
    assert!(weight.abs() < 1e-12 * mass);
    assert_eq!(mass, 19.9e3 * 0.038 * 0.038);
    assert_eq!(stiffness, 0.854e11 * 0.038 * 0.038);
    // The line of 6 m runs from (3.593, -10) to (1.061, -4.561), past the centre by s; w = 1 +
    // s²/(I/M).
    let mass = 72452.0 + 144904.0;
    let arm = 1.061 * (10.0 - 4.561) / 6.0 - 1.061 * (3.593 - 1.061) / 6.0;
    let effective = mass / (1.0 + arm * arm / (163017.0 / mass));
    let critical = 2.0 * (stiffness / 6.0 * effective).sqrt();
    let zeta = snapload_structure::damping_ratio(0.3);
    assert!(
        (damping / 6.0 / (zeta * critical) - 1.0).abs() < 1e-3,
        "{damping}"
    );
}

#[test]
fn a_file_by_hand_is_read() {
    let mut reading = moordyn::read("lines.txt", BY_HAND).unwrap();
    assert_eq!(reading.entries.missing(), ["body.width", "run.restitution"]);
    let notes = reading.notes.join("\n");
    assert!(
        notes.contains("weighs") && notes.contains("the second, dynamic one"),
        "{notes}"
    );
    let of_rope = "Type rope: Cd = 1.6, Ca = 1.0, CdAx = 0.1 left out: lines have no bending";
    for left_out in [of_rope, "Type poly: BA = 1e3|1e4 was left out"] {
        assert!(notes.contains(left_out), "{left_out} {notes}");
    }
    assert_eq!(reading.notes.len(), 7, "{notes}");
    for set in ["body.width=1", "run.restitution=0.4"] {
        reading.entries.set(set).unwrap();
    }
    let case = Structure::from_entries(&reading.entries).unwrap();
    let body = &case.body;
    assert_eq!((body.mass_kg, body.displaced_volume_m3), (500.0, 0.9));
    assert_eq!(
        (body.moment_of_inertia_kg_m2, body.drag_area_m2),
        (120.0, 0.8)
    );
    assert_eq!(body.position_m, [10.0, -5.0]);
    assert!(near(body.added_mass.surge_kg, 918.0) && near(body.added_mass.heave_kg, 918.0));
    let [left, right] = &case.lines[..] else {
        unreachable!("two lines were written")
    };
    assert_eq!(
        (left.anchor_m, left.fairlead_m),
        ([4.0, -20.0], [9.6, -5.3])
    );
    // Written from the body to the anchor, which is the same line.
    assert_eq!(
        (right.anchor_m, right.fairlead_m),
        ([16.0, -20.0], [10.4, -5.3])
    );
    assert_eq!(
        (left.stiffness_n, right.stiffness_n),
        (Some(4e6), Some(8e6))
    );
    assert_eq!(case.site.depth_m, 20.0);
    assert_eq!(
        (case.site.water_density_kg_m3, case.site.gravity_m_s2),
        (1020.0, 9.806_65)
    );
}

/// Points that another program moves: the user has to describe the body.
#[test]
fn coupled_points_are_those_of_a_body_to_be_given() {
    let without: String = BY_HAND
        .lines()
        .filter(|line| {
            !line.contains("BODIES")
                && !line.starts_with("1    free")
                && !line.contains("X0")
                && !line.contains("(deg)")
        })
        .map(|line| line.replace("Body1     -0.4    0.0     -0.3", "Coupled 9.6 2 -5.3"))
        .map(|line| line.replace("Body1     0.4     0.0     -0.3", "Vessel 10.4 2 -5.3") + "\n")
        .collect();
    let mut reading = moordyn::read("lines.txt", &without).unwrap();
    let missing = [
        "body.mass",
        "body.displaced_volume",
        "body.width",
        "body.position",
        "run.restitution",
    ];
    assert_eq!(reading.entries.missing(), missing);
    for set in [
        "body.mass=500",
        "body.displaced_volume=0.9",
        "body.width=1",
        "body.position=[10, -5]",
        "run.restitution=0.4",
    ] {
        reading.entries.set(set).unwrap();
    }
    let case = Structure::from_entries(&reading.entries).unwrap();
    assert_eq!(case.lines[0].fairlead_m, [9.6, -5.3]);
}

#[test]
fn what_is_not_planar_or_not_supported_is_reported() {
    for (from, to, says) in [
        (
            "2     Fixed     16      2  ",
            "2     Fixed     16      7  ",
            &["line 17: point 2, Y = 7", "y = 2", "turn the file"][..],
        ),
        (
            "2     poly       4        2 ",
            "2     poly       1        2 ",
            &["line 24: line 2", "1 and 2", "both are on the ground"],
        ),
        (
            "2     poly       4        2 ",
            "2     poly       3        4 ",
            &["both are on the body"],
        ),
        (
            "2     poly ",
            "2     pole ",
            &["line 24: line 2, LineType = pole", "rope, poly"],
        ),
        (
            "2     poly       4 ",
            "2     poly       R1A ",
            &["line 2, AttachA = R1A", "end of a rod"],
        ),
        (
            "4     Body1 ",
            "4     Body2 ",
            &["line 19: point 4, Attachment = Body2", "Fixed or Body1"],
        ),
        (
            "4     Body1 ",
            "4     Free ",
            &["point 4, Attachment = Free", "a clump"],
        ),
        (
            "POINT PROPERTIES",
            "things",
            &["lines.txt: section POINTS (missing)"],
        ),
        ("- LINES -", "- strings -", &["section LINES (missing)"]),
        ("LINE TYPES", "ropes", &["section LINE TYPES (missing)"]),
        (
            "1    free ",
            "1    pinned ",
            &["line 12: body 1, Attachment = pinned", "Free or Coupled"],
        ),
        (
            "500    0     90",
            "500    0|0|-2     90",
            &[
                "body 1, CG = 0|0|-2",
                "subtract CG from the z of its points",
            ],
        ),
        (
            "-5    0       0      0 ",
            "-5    0       4      0 ",
            &["body 1, p0 = 4", "upright"],
        ),
        (
            "0.9     0.8|0  1.0",
            "0.9     0.8|0  1|2",
            &["body 1, Ca = 1|2", "Cax|Cay|Caz"],
        ),
        (
            "500    0 ",
            "many    0 ",
            &["line 12: body 1, Mass = many is not allowed; allowed: a number"],
        ),
        (
            "rope       0.06    3.0        4.0e6",
            "rope       0.06    3.0        -4e6",
            &["line 23", "line.1.stiffness = -4000000"],
        ),
        (
            "16.0      20      -",
            "",
            &["line 23: line 1, UnstrLen (missing)", "column 5"],
        ),
        (
            "AttachA  AttachB  UnstrLen  NumSegs",
            "UnstrLen  NumSegs  NodeAnch  NodeFair",
            &["NodeAnch", "version 1"],
        ),
        (
            "20            WtrDpth ",
            "floor.txt     WtrDpth ",
            &["line 29: option floor.txt, WtrDpth"],
        ),
        (
            "4     Body1     0.4     0.0     -0.3    0 ",
            "4     Body1     0.4     0.0     -0.3    7 ",
            &["point 4, Mass = 7"],
        ),
        (
            "A cylinder between",
            "snapload: body.wdith = 3",
            &["line 2: ", "did you mean width?"],
        ),
    ] {
        let text = BY_HAND.replacen(from, to, 1);
        assert_ne!(text, BY_HAND, "{from}");
        let error = moordyn::read("lines.txt", &text).expect_err(to).to_string();
        for says in says {
            assert!(error.contains(says), "{to}: {error}");
        }
    }
    let second = "1    free        30.0   2.0   -5    0       0      0      500    0     90|120|80      0.9     0.8|0  1.0\n----- POINT";
    let two = BY_HAND.replacen("---------------------- POINT", second, 1);
    let error = moordyn::read("lines.txt", &two)
        .expect_err("two")
        .to_string();
    assert!(
        error.contains("line 13") && error.contains("moors one body"),
        "{error}"
    );
    let rods = BY_HAND.replacen(
        "---------------------- POINT",
        "---- RODS ----\na\nb\n1 can Body1 0 0 0 0 0 1 2 -\n---- POINT",
        1,
    );
    let error = moordyn::read("lines.txt", &rods)
        .expect_err("rods")
        .to_string();
    assert!(
        error.contains("line 16: rod 1, RODS") && error.contains("to those of the body"),
        "{error}"
    );
}

#[test]
fn a_case_that_moordyn_can_not_have_is_refused() {
    let bare: String = CYLINDER
        .lines()
        .filter(|line| !line.starts_with("type") && !line.starts_with("diameter"))
        .map(|line| format!("{line}\n"))
        .collect();
    for (sets, says) in [
        (&[][..], "line.1.stiffness"),
        (&["line.stiffness=1e8"], "line.1.mass_per_length"),
    ] {
        let error = moordyn::write("case", &structure(&bare, sets), 1)
            .expect_err(says)
            .to_string();
        assert!(
            error.contains(says) && error.contains("diameter"),
            "{error}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Lines cut short, doubled, left out or with words exchanged are read, or refused with a
    /// message.
    #[test]
    fn mangled_files_are_read_or_refused(
        changes in prop::collection::vec((0usize..40, 0u8..5, 0usize..100, "[-0-9a-zA-Z|.#é°\"]{0,9}"), 1..6),
        written in any::<bool>(),
    ) {
        let own = moordyn::write("case", &structure(CYLINDER, &[]), 3).unwrap();
        let text = if written { own.as_str() } else { BY_HAND };
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for (line, what, at, word) in changes {
            let index = line % lines.len();
            let old = lines[index].clone();
            let cut: Vec<&str> = old.split_whitespace().collect();
            match what {
                0 => lines[index] = old.chars().take(at).collect(),
                1 => lines.insert(index, old),
                2 if lines.len() > 1 => drop(lines.remove(index)),
                _ if cut.is_empty() => lines[index] = word,
                _ => {
                    let place = at % cut.len();
                    let mut cut: Vec<String> = cut.into_iter().map(str::to_owned).collect();
                    cut[place] = word;
                    lines[index] = cut.join(" ");
                }
            }
        }
        match moordyn::read("lines.txt", &lines.join("\n")) {
            Err(error) => prop_assert!(error.to_string().starts_with("lines.txt"), "{}", error),
            Ok(reading) => {
                // A case that is read can be written and read again, or is refused with a message.
                let again = Entries::parse(&STRUCTURE, "again", &reading.entries.to_toml());
                prop_assert!(again.is_ok(), "{:?}", again.err());
                if let Err(error) = Structure::from_entries(&reading.entries) {
                    prop_assert!(!error.to_string().is_empty());
                }
            }
        }
    }

    #[test]
    fn anything_is_read_or_refused(text in any::<String>()) {
        if let Err(error) = moordyn::read("lines.txt", &text) {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}

/// Texts that resemble other values are read back as texts, with characters that would end a text.
#[test]
fn texts_of_a_project_come_back() {
    let sets = [
        "project.date=\"2026-11-23\"",
        "project.name=\"true\"",
        "project.client='Port of \"X\"'",
    ];
    let written = structure(CYLINDER, &sets);
    let text = moordyn::write("case", &written, 1).unwrap();
    let toml = moordyn::read("case", &text).unwrap().entries.to_toml();
    let project = Structure::parse("case", &toml).unwrap().project;
    assert_eq!(project.date, "2026-11-23");
    assert_eq!([project.name, project.client], ["true", "Port of \"X\""]);
}
