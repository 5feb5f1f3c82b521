//! What short records of a sea say of three hours: nothing where the motion still grows, or where
//! one line snaps and another only sometimes.

use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{
    Answer, Assessment, LineOutcome, Lines, NoDistribution, Seas, Structure, VerdictKind, assess,
    seas,
};

/// A cylinder of 217356 kg with its added mass that swings on one line of 4.6 m between its centre
/// and the floor: surge has a period of the waves, and rotation is free.
const PENDULUM: &str = "[body]\nshape = \"circle\"\nwidth = 3\ndisplaced_volume = 141.37\nmass = 72452\n\
    added_mass = 144904\nmoment_of_inertia = 163017\nposition = [0, -9]\n\
    [[line]]\nanchor = [0, -13.6]\nfairlead = [0, -9]\nlength = 4.6\ntype = \"studless chain\"\ndiameter = 0.038\n\
    [site]\ndepth = 30\n[sea]\nhs = 0.1\ntp = 7\n[run]\nrestitution = 0.5\nduration = 1000\n";

/// A heavier cylinder on a line that carries it, beside a strong one that is slack at rest.
const PAIR: &str = "[body]\nshape = \"circle\"\nwidth = 3\ndisplaced_volume = 141.37\nmass = 130000\n\
    added_mass = 144904\nmoment_of_inertia = 292500\nlinear_damping = 30000\nturning_damping = 100000\n\
    position = [0, -9]\n\
    [[line]]\nanchor = [0, -30]\nfairlead = [0, -9]\nlength = 21\ntype = \"studless chain\"\ndiameter = 0.038\n\
    breaking_load = 420000\n\
    [[line]]\nanchor = [-20, -9]\nfairlead = [0, -9]\nlength = 20.15\ntype = \"studless chain\"\ndiameter = 0.05\n\
    breaking_load = 1e9\n\
    [site]\ndepth = 30\n[sea]\nhs = 1.6\ntp = 7\n[run]\nrestitution = 0.5\nduration = 1000\n";

/// A case whose motion is stationary within a minute.
pub(crate) fn damped(text: &str) -> String {
    text.replace(
        "[body]\n",
        "[body]\nlinear_damping = 3e4\nturning_damping = 5e4\n",
    )
}

fn records(structure: Structure, count: u32, lines: Lines) -> Seas {
    seas(structure, count, lines, &no_progress).expect("records")
}

fn settling(seas: &Seas) -> Option<&str> {
    let mut warnings = seas.warnings.iter();
    let found = warnings.find(|warning| warning.rule == "settling");
    found.map(|warning| warning.message.as_str())
}

/// Without damping the variance of surge grows as long as the sea lasts. Records of 1000 s in which
/// no line breaks say nothing of three hours, in which one does.
#[test]
fn a_motion_that_grows_is_not_extrapolated() {
    for lines in [Lines::Inextensible, Lines::Elastic] {
        let short = records(structure(PENDULUM), 6, lines);
        assert_eq!(short.failing().count, 0);
        assert_eq!(
            short.peak_in_three_hours(),
            Err(NoDistribution::NotStationary)
        );
        assert_eq!(short.standing(), VerdictKind::Open);
        assert!(
            settling(&short).is_some_and(|text| text.contains("surge (7.4")),
            "{:?}",
            settling(&short)
        );
    }
    let long = PENDULUM.replace("duration = 1000", "duration = 10800");
    let long = records(structure(&long), 8, Lines::Inextensible);
    assert!(long.failing().count > 0);
    // These are records of three hours, with no extrapolation.
    assert_ne!(
        long.peak_in_three_hours(),
        Err(NoDistribution::NotStationary)
    );
    assert!(settling(&long).is_some_and(|text| text.contains("begins with a body at rest")));
}

/// With the damping b of surge its variance approaches its limit as 1 − exp(−b t/M), up to 5 %
/// after 3 M/b = 890 s. Records that are long beside that say what records of three hours say.
#[test]
fn a_damped_motion_is_extrapolated_once_it_is_stationary() {
    let damped = PENDULUM.replace("[[line]]", "linear_damping = 733\n[[line]]");
    let short = records(structure(&damped), 6, Lines::Inextensible);
    assert_eq!(
        short.peak_in_three_hours(),
        Err(NoDistribution::NotStationary)
    );
    assert!(
        settling(&short).is_some_and(|text| text.contains("only 890 s after")),
        "{:?}",
        settling(&short)
    );
    let of = |duration: f64, count: u32| {
        let text = damped.replace("duration = 1000", &format!("duration = {duration}"));
        let seas = records(structure(&text), count, Lines::Inextensible);
        assert_eq!(settling(&seas), None);
        seas.peak_in_three_hours().expect("a distribution").mean()
    };
    let (short, long) = (of(2700.0, 24), of(10_860.0, 24));
    let error = short.error.hypot(long.error);
    assert!(
        (short.value - long.value).abs() < 3.0 * error,
        "{short:?} {long:?}"
    );
    // Drag damps it, too.
    let drag = PENDULUM
        .replace("[[line]]", "drag_area = 60\n[[line]]")
        .replace("hs = 0.1", "hs = 1");
    assert_eq!(
        settling(&records(structure(&drag), 3, Lines::Inextensible)),
        None
    );
}

/// A current U damps motions along it by ρ C_d A |U|, twice the drag over U, as much as the linear
/// damping that needs 890 s, above. It leans the line by little, and the waves are small beside it.
#[test]
fn drag_in_a_current_damps_as_much_as_linear_damping() {
    let text = PENDULUM
        .replace("[[line]]", "drag_area = 0.7151\n[[line]]")
        .replace("[site]", "[site]\ncurrent = 1");
    for lines in [Lines::Inextensible, Lines::Elastic] {
        let short = records(structure(&text), 3, lines);
        let words = settling(&short).expect("a warning");
        let time = words
            .split("only ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next());
        let time_s: f64 = time.and_then(|time| time.parse().ok()).expect("a time");
        assert!((time_s / 890.0 - 1.0).abs() < 0.01, "{words}");
    }
}

/// The snaps of one line say nothing of those of another. Line 2 snaps in every record. Line 1,
/// which breaks in a quarter of all seas of three hours, only settles after them, at less than 1
/// cm/s and just above twice its tension at rest.
#[test]
fn each_line_is_extrapolated_by_itself() {
    let pair = records(structure(PAIR), 5, Lines::Inextensible);
    let outcomes = || pair.records.iter().map(|record| &record.outcome);
    let snapping = |line: usize| outcomes().filter(|one| one.lines[line].snaps > 0).count();
    let twice_n = 2.0 * pair.prepared.rest.tension_n[0];
    let settles = |line: &LineOutcome| line.snaps_at_all && line.largest_n() < Some(1.03 * twice_n);
    assert!(outcomes().all(|one| settles(&one.lines[0])));
    assert_eq!([snapping(0), snapping(1)], [0, 5]);
    assert_eq!(pair.failing().count, 0);
    assert_eq!(pair.standing(), VerdictKind::Open);
    let words = pair.words();
    let why = "is open, as line 1 does not snap at 1 cm/s or more in the records, but";
    assert!(words.contains(why), "{words}");
    let long = PAIR
        .replace("duration = 1000", "duration = 10870")
        .replace("hs = 1.6", "hs = 1.6\nseed = 100000");
    let long = records(structure(&long), 20, Lines::Inextensible);
    assert!((1..12).contains(&long.failing().count));
    assert!(long.largest_of_lines_n()[0] > Some(420e3));
}

/// A line may snap in every record of seven times three hours and not in each three hours: of such
/// records the fastest snap in three hours, which would be extrapolated downwards, is not given.
#[test]
fn longer_records_have_no_distribution_in_three_hours() {
    let mut pair = records(structure(PAIR), 4, Lines::Inextensible);
    assert!(pair.speed_in_three_hours().is_ok());
    pair.prepared.structure.duration_s = 76_368.0;
    let reason = NoDistribution::TooLong;
    assert_eq!(pair.speed_in_three_hours(), Err(reason));
    let words = reason.to_string();
    assert!(
        pair.summary("case")
            .replace('\n', " ")
            .contains("fastest   no distribution")
    );
    assert!(pair.to_json("case")["fastest_snap_in_three_hours_m_s"].is_null());
    assert!(words.contains("records of three hours have one"), "{words}");
}

/// Where a line snaps whose stiffness is not known, neither is the largest tension of its record.
#[test]
fn a_tension_that_is_not_known_is_not_that_of_the_other_lines() {
    let sea = PAIR.replace("hs = 1.6", "hs = 3");
    let known = records(structure(&sea), 1, Lines::Inextensible);
    let chain = "type = \"studless chain\"\ndiameter = 0.05\n";
    let unknown = records(structure(&sea.replace(chain, "")), 1, Lines::Inextensible);
    let [known, unknown] = [&known, &unknown].map(|seas| &seas.records[0].outcome);
    assert_eq!(known.snaps(), unknown.snaps());
    assert!(unknown.lines[1].snaps > 0);
    assert_eq!(known.known_largest_n(), Some(known.largest_n()));
    assert_eq!(known.known_peak_n(), known.peak_n());
    assert!(unknown.peak_n().is_some());
    assert_eq!(
        [unknown.known_largest_n(), unknown.known_peak_n()],
        [None; 2]
    );
}

/// One record passes no check, whichever command runs it.
#[test]
fn one_record_passes_no_check() {
    let text = format!("{PENDULUM}[design]\nleast_share = 0.1\nforce_share = 0.9\n");
    let alone: Assessment = assess(structure(&text), 0, &no_progress).expect("an assessment");
    let alone: Vec<Answer> = alone
        .checks()
        .iter()
        .map(|(check, _)| check.answer)
        .collect();
    assert_eq!(alone, [Answer::Unknown; 2]);
    let answers = |count: u32| {
        let seas = records(structure(&text), count, Lines::Inextensible);
        let checks = seas.checks();
        checks
            .iter()
            .map(|check| check.worst.answer)
            .collect::<Vec<_>>()
    };
    assert_eq!(answers(1), alone);
    assert_eq!(answers(2), [Answer::Passes; 2]);
}
