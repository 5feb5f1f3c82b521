//! What is said of many records of a sea: distributions, probabilities, and what is not known.

use crate::sea_extrapolation::damped;
use crate::verdicts::{source, structure};
use snapload::Stop;
use snapload::analysis::no_progress;
use snapload_structure::{
    Assessment, Lines, NoDistribution, Seas, Structure, VerdictKind, Water, assess, note, seas,
};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");

/// The example on one line above its centre, with two guys of chain that are slack at rest, as they
/// are 0.4 m longer than the distance from (∓6, -10) to (0, -3.5).
fn guyed(duration: f64, seed: u64) -> Structure {
    let guy = |x: f64| line(x, -3.5, 8.846 + 0.4);
    let (body, rest) = SEA.split_once("[[line]]").unwrap();
    let rest = &rest[rest.find("[site]").unwrap()..];
    let body = body.replace(
        "[body]",
        "[body]\nturning_damping = 5e4\nlinear_damping = 3e4",
    );
    let rest = rest.replace("hs = 1.2", &format!("hs = 0.3\nseed = {seed}"));
    let lines = line(0.0, -5.0, 5.0) + &guy(-6.0) + &guy(6.0);
    structure(&format!("{body}{lines}{rest}\nduration = {duration}\n"))
}

/// A line of chain from the floor at x to the middle of the body at z.
fn line(x: f64, z: f64, length: f64) -> String {
    format!(
        "[[line]]\nanchor = [{x}, -10]\nfairlead = [0, {z}]\nlength = {length}\n\
         type = \"studless chain\"\ndiameter = 0.038\n"
    )
}

/// Records of the sea of the example, with these significant height, duration and further keys of
/// `[run]`.
fn records(hs: f64, duration: f64, run: &str, count: u32) -> Seas {
    let text = SEA
        .replace("[run]", &format!("[run]\nduration = {duration}\n{run}"))
        .replace("hs = 1.2", &format!("hs = {hs}"));
    seas_of(structure(&text), count)
}

fn seas_of(structure: Structure, count: u32) -> Seas {
    seas(structure, count, Lines::Inextensible, &no_progress).unwrap()
}

/// The single run of one record.
fn alone(seas: &Seas, seed: u64) -> Assessment {
    let mut structure: Structure = seas.prepared.structure.clone();
    let Water::Sea(sea) = &mut structure.water else {
        panic!("a sea");
    };
    sea.seed = seed;
    Assessment::single_run(structure, &no_progress).unwrap()
}

/// Records with snaps and without them have two distributions, and one fit to both is refused.
#[test]
fn records_with_and_without_snaps_have_no_common_distribution() {
    let text = SEA
        .replace("[run]", "[run]\nduration = 240")
        .replace("hs = 1.2", "hs = 0.35");
    let result = seas(structure(&text), 12, Lines::Inextensible, &no_progress).unwrap();
    let still = result
        .speeds_m_s()
        .iter()
        .filter(|speed| **speed == Some(0.0))
        .count();
    assert!((1..12).contains(&still), "{still}");
    assert!(result.peak_in_three_hours().is_err() && result.speed_in_three_hours().is_err());
    let words = result.words();
    assert!(
        words.contains(&format!("as in {still} of 12 records no line snaps")),
        "{words}"
    );
    assert!(result.summary("case").contains("no distribution, as in"));
}

/// Short records without snaps say nothing of three hours in which a line may snap: their fit would
/// expect the largest tension near 850 kN, and in three hours the first record of the same sea
/// snaps.
#[test]
fn records_without_snaps_are_not_extrapolated_to_snaps() {
    let short = records(0.15, 1260.0, "transient = 60", 6);
    assert!(
        short
            .records
            .iter()
            .all(|record| record.outcome.snaps() == 0)
    );
    assert_eq!(short.peak_in_three_hours(), Err(NoDistribution::MaySnap(1)));
    assert_eq!(short.standing(), VerdictKind::Open);
    let words = short.words();
    assert!(
        words.contains("within three hours it may go slack and snap"),
        "{words}"
    );
    let long = records(0.15, 10_860.0, "transient = 60", 1);
    assert!(long.records[0].outcome.largest_n() > 1.1e6);
}

/// The first records of a sea never tell more than all of them: where all leave the
/// verdict open, so does one, unless a line breaks in it. Nor do records tell more if
/// tensions of snaps are not known.
#[test]
fn fewer_records_do_not_make_a_sea_safe() {
    let mut few = records(0.15, 1260.0, "transient = 60", 4);
    for count in (1..=4).rev() {
        few.records.truncate(count);
        assert_eq!(few.standing(), VerdictKind::Open, "{count}");
        let mut without = few.clone();
        for line in &mut without.prepared.structure.lines {
            line.stiffness_n = None;
        }
        let reason = NoDistribution::TensionsUnknown;
        assert_eq!(without.peak_in_three_hours(), Err(reason));
        assert_eq!(without.standing(), VerdictKind::Open, "{count}");
        // What is open is told with its reason, once, in the text as in JSON.
        let open = "Whether a line breaks within three hours is open, as";
        let reason = if count < 3 {
            "too few: run more"
        } else {
            "it may go slack and snap"
        };
        for seas in [&few, &without] {
            assert_eq!(seas.to_json("case")["standing"], "open");
            let words = seas.words();
            assert_eq!(words.matches(open).count(), 1, "{words}");
            assert_eq!(words.matches(reason).count(), 1, "{words}");
        }
    }
    let reached = few.largest_n().unwrap()[0].unwrap();
    for line in &mut few.prepared.structure.lines {
        line.breaking_load_n = Some(0.999 * reached);
    }
    assert_eq!(few.to_json("case")["standing"], "breaks");
    assert!(!few.words().contains("is open"));
}

/// Records of 80 minutes in all do not show that a line stays below a load in three hours
/// that is one per cent above the largest of them: that is exceeded sooner. Each line is
/// compared with its own breaking load.
#[test]
fn a_sea_is_open_in_which_a_tension_above_the_breaking_load_is_expected() {
    let text = damped(SEA)
        .replace("[run]", "[run]\nduration = 300")
        .replace("hs = 1.2", "hs = 2.5");
    let mut seas = seas_of(structure(&text), 20);
    let mut with_loads = |margins: [f64; 2]| {
        for (index, margin) in margins.into_iter().enumerate() {
            let lines = seas.records.iter().map(|r| &r.outcome.lines[index]);
            let largest = lines.filter_map(|line| line.largest_n());
            let load = margin * largest.fold(0.0, f64::max);
            seas.prepared.structure.lines[index].breaking_load_n = Some(load);
        }
        assert_eq!(seas.failing().count + seas.failing().unknown, 0);
        assert!(seas.peak_in_three_hours().is_ok());
        seas.clone()
    };
    for margins in [[1.01, 1.01], [1.01, 100.0], [100.0, 1.01]] {
        let seas = with_loads(margins);
        assert_eq!(seas.standing(), VerdictKind::Open);
        let words = seas.words();
        assert!(
            words.contains("Whether a line breaks within three hours is open: the largest ratio"),
            "{words}"
        );
    }
    let strong = with_loads([100.0; 2]);
    assert_eq!(strong.standing(), VerdictKind::Holds);
    assert!(!strong.words().contains("open"));
    let firm = "By Gumbel distributions of its tensions in the records each line holds in nine of ten seas";
    assert!(strong.words().contains(firm), "{}", strong.words());
    let json = strong.to_json("case");
    assert_eq!(
        [
            &json["sea"]["first_seed"],
            &json["sea"]["significant_height_m"]
        ],
        [1.0, 2.5]
    );
    assert_eq!([&json["duration_s"], &json["transient_s"]], [300.0, 60.0]);
    // Guys that never become taut do not have to bear what the line between them bears.
    let mut guys = guyed(960.0, 1);
    for line in &mut guys.lines[1..] {
        line.length_m += 6.0;
        line.breaking_load_n = Some(1e5);
    }
    let seas = seas_of(guys, 6);
    assert!(seas.peak_in_three_hours().unwrap().mean().value > 1e5);
    assert_eq!(seas.standing(), VerdictKind::Holds);
}

/// A line that is slack at rest has no tension to lose, and snaps where it becomes taut: the short
/// records lack that, and in three hours a record of the same sea breaks a line.
#[test]
fn records_in_which_a_slack_line_stays_slack_are_not_extrapolated_to_snaps() {
    let short = seas_of(guyed(960.0, 1), 6);
    for outcome in short.records.iter().map(|record| &record.outcome) {
        assert!(outcome.lines[1..].iter().all(|l| l.slack_fraction == 1.0));
        assert!(outcome.lines[0].least_n.unwrap() > 0.9 * short.prepared.rest.tension_n[0]);
    }
    let reason = NoDistribution::MayBecomeTaut(2);
    assert_eq!(short.peak_in_three_hours(), Err(reason));
    assert_eq!(short.standing(), VerdictKind::Open);
    let words = short.words();
    assert!(words.contains("may become taut and snap"), "{words}");
    assert_eq!(seas_of(guyed(10_800.0, 3), 1).failing().count, 1);
}

/// The part of its slack that a line uses up is that of the distances from its anchor along the
/// motion, and 1 where an elastic line pulls.
#[test]
fn the_slack_that_is_used_up_is_a_part_of_a_distance() {
    let run = Assessment::single_run(guyed(300.0, 1), &no_progress).unwrap();
    let times: Vec<f64> = (0..=24_000).map(|k| 60.0 + f64::from(k) * 0.01).collect();
    let motion = run.motion_at(&times).unwrap();
    // The fairlead is the centre of the body at rest.
    let lacks = |[x, z]: [f64; 2], anchor: f64| 9.246 - (x - anchor).hypot(z + 10.0);
    for (line, anchor) in [(1, -6.0), (2, 6.0)] {
        let lacking = motion.iter().map(|at| lacks(at.place_m, anchor));
        let used = 1.0 - lacking.fold(f64::INFINITY, f64::min) / lacks([0.0, -3.5], anchor);
        let found = run.outcome.lines[line].slack_used.unwrap();
        assert!((found / used - 1.0).abs() < 0.01, "{found} {used}");
    }
    assert_eq!(run.outcome.lines[0].slack_used, None);
    let mut rough = guyed(300.0, 1);
    let Water::Sea(sea) = &mut rough.water else {
        panic!("a sea");
    };
    sea.significant_height_m = 1.2;
    let elastic = seas(rough, 1, Lines::Elastic, &no_progress).unwrap();
    let lines = &elastic.records[0].outcome.lines;
    assert_eq!(lines[0].slack_used, None);
    for line in &lines[1..] {
        let pulls = line.largest_taut_n > 0.0;
        assert_eq!(line.slack_used.unwrap() >= 1.0, pulls);
    }
    assert!(lines[1..].iter().any(|line| line.largest_taut_n > 0.0));
}

/// Of records that are cut short it is known that they fail if a line breaks before they end, and
/// otherwise nothing; a probability needs to know of all.
#[test]
fn records_that_end_early_have_no_probability() {
    let strong = records(1.2, 900.0, "max_snaps = 300", 4);
    let cut_short = |seas: &Seas| {
        seas.records
            .iter()
            .all(|r| r.outcome.stop == Stop::ImpactLimit)
    };
    assert!(cut_short(&strong));
    let all = strong.largest_n().unwrap().into_iter().flatten();
    let most = all.fold(0.0, f64::max);
    let with_load = |load: f64| {
        let mut seas = strong.clone();
        for line in &mut seas.prepared.structure.lines {
            line.breaking_load_n = Some(load);
        }
        seas
    };
    let (weak, strong) = (with_load(0.999 * most), with_load(1e9));
    assert_eq!(strong.standing(), VerdictKind::Unknown);
    assert_eq!((strong.failing().count, strong.failing().unknown), (0, 4));
    assert_eq!(weak.standing(), VerdictKind::Breaks);
    assert!(weak.failing().count > 0);
    for seas in [&strong, &weak] {
        assert!(seas.probability().is_none() || seas.failing().unknown == 0);
        let words = seas.words();
        assert_eq!(
            words.contains("probability"),
            seas.probability().is_some(),
            "{words}"
        );
        assert_eq!(
            words.contains("not known in"),
            seas.failing().unknown > 0,
            "{words}"
        );
        let json = seas.to_json("case");
        assert_eq!(json["probability"].is_null(), seas.probability().is_none());
        let page = note::seas_page(source("case"), seas).unwrap();
        assert!(!page.contains("verdict holds"), "{words}");
    }
    assert!(
        strong
            .words()
            .contains("in 4 of 4 records, as they ended before their time.")
    );
}

/// Longer records answer only where they ended early: if a breaking load is not known either, both
/// reasons are told.
#[test]
fn every_reason_why_records_are_not_known_is_told() {
    let mut seas = records(1.2, 900.0, "max_snaps = 300", 3);
    seas.prepared.structure.lines[0].breaking_load_n = Some(1e9);
    seas.prepared.structure.lines[1].breaking_load_n = None;
    let lacking = "a tension or a breaking load is not known: give each line type";
    let both = format!("in 3 of 3 records, as 3 of them ended before their time, and {lacking}");
    assert!(seas.words().contains(&both), "{}", seas.words());
    seas.records[0].outcome.stop = Stop::EndTime;
    let both = format!("in 3 of 3 records, as 2 of them ended before their time, and {lacking}");
    assert!(seas.words().contains(&both), "{}", seas.words());
    seas.records.truncate(1);
    let one = format!("in 1 of 1 record, as {lacking}");
    assert!(seas.words().contains(&one), "{}", seas.words());
    seas.records[0].outcome.stop = Stop::ImpactLimit;
    let both = format!("in 1 of 1 record, as it ended before its time, and {lacking}");
    assert!(seas.words().contains(&both), "{}", seas.words());
}

/// A line that breaks is told although the breaking load of another one is not known.
#[test]
fn a_line_that_breaks_fails_the_record_whatever_the_others_do() {
    let mut seas = records(1.2, 900.0, "", 3);
    let largest = |line: usize| {
        let records = seas
            .records
            .iter()
            .map(|record| &record.outcome.lines[line]);
        records
            .filter_map(|line| line.largest_n())
            .fold(0.0, f64::max)
    };
    let load = 0.999 * largest(0);
    seas.prepared.structure.lines[0].breaking_load_n = Some(load);
    seas.prepared.structure.lines[1].breaking_load_n = None;
    let failing = seas.failing();
    assert!(failing.count >= 1 && failing.count + failing.unknown == 3);
    let words = seas.words();
    let sentence = format!("In {} of 3 records a line would break", failing.count);
    assert!(words.contains(&sentence), "{words}");
    assert!(words.contains("breaking load is not known"), "{words}");
}

/// A record that ends before the judged time has no largest tension, and it is not one without
/// snaps.
#[test]
fn records_that_end_before_the_judged_time_are_left_out() {
    let seas = records(3.0, 600.0, "", 6);
    let unjudged = |record: &&snapload_structure::SeaOutcome| record.outcome.end_s < 60.0;
    let early: Vec<_> = seas.records.iter().filter(unjudged).collect();
    assert!(!early.is_empty());
    for record in &early {
        let run = alone(&seas, record.seed);
        assert!(run.snaps.iter().any(|snap| snap.counts()));
    }
    let unknown = seas
        .largest_n()
        .unwrap()
        .into_iter()
        .filter(Option::is_none);
    assert_eq!(unknown.count(), early.len());
    let summary = seas.summary("case");
    assert!(!summary.contains("no line snaps"), "{summary}");
    let judged = format!("in the {} of 6 records", 6 - early.len());
    assert!(summary.contains(&judged), "{summary}");
    let exceeding = seas
        .records
        .iter()
        .filter(|r| r.outcome.stop.exceeds())
        .count();
    let reason = NoDistribution::Exceeds(exceeding, 6);
    assert_eq!(seas.peak_in_three_hours(), Err(reason));
    assert!(summary.contains(&format!("no distribution, as in {exceeding} of 6 records")));
}

/// A line that would break only before the judged time leaves the verdict open, as in one run.
#[test]
fn a_sea_in_which_a_line_breaks_early_is_open() {
    let mut seas = records(1.2, 400.0, "", 1);
    let lines = &seas.records[0].outcome.lines;
    let early = lines.iter().map(|line| line.early_n).fold(0.0, f64::max);
    let judged = lines
        .iter()
        .filter_map(|line| line.largest_n())
        .fold(0.0, f64::max);
    assert!(early > judged);
    for line in &mut seas.prepared.structure.lines {
        line.breaking_load_n = Some(0.5 * (early + judged));
    }
    assert_eq!(seas.standing(), VerdictKind::Open);
    assert_eq!(alone(&seas, 1).verdict().standing, VerdictKind::Open);
    let page = note::seas_page(source("case"), &seas).unwrap();
    assert!(page.contains("verdict open") && page.contains("so the verdict is open"));
}

/// What neighbours and other restitutions would change is said of every verdict: of one that is
/// open because of the beginning, and of one that a line breaks.
#[test]
fn neighbours_that_answer_otherwise_are_counted() {
    let mut assessment = assess(structure(EXAMPLE), 12, &no_progress).unwrap();
    assert_eq!(assessment.verdict().standing, VerdictKind::Open);
    let load = assessment.prepared.structure.lines[0]
        .breaking_load_n
        .unwrap();
    for neighbour in &mut assessment.neighbours[..3] {
        neighbour.lines[0].peak_n = Some(1.01 * load);
    }
    let words = assessment.verdict().words;
    assert!(
        words.contains("In 3 of 12 neighbours a line would break"),
        "{words}"
    );
    assessment.outcome.lines[0].peak_n = Some(1.01 * load);
    let verdict = assessment.verdict();
    assert_eq!(verdict.standing, VerdictKind::Breaks);
    let words = verdict.words;
    assert!(
        words.contains("In 9 of 12 neighbours no line breaks"),
        "{words}"
    );
    assert!(
        words.contains("With a restitution of 0.30 or 0.70 no line would break"),
        "{words}"
    );
}

/// A check that passes up to the end of a run that ended early is not known to pass.
#[test]
fn a_run_that_ends_early_passes_no_check() {
    let design =
        "[design]\npretension_factor = 1.2\nenvironment_factor = 1.5\nstrength_factor = 0.95\n";
    let text = format!("{EXAMPLE}\ntransient = 5\nmax_snaps = 300\n{design}");
    let text = text.replace("[[line]]", "[[line]]\nbreaking_load = 1e9");
    let assessment = assess(structure(&text), 0, &no_progress).unwrap();
    assert_eq!(assessment.outcome.stop, Stop::ImpactLimit);
    let json = assessment.to_json("case");
    let checks = json["checks"].as_array().unwrap();
    assert!(!checks.is_empty() && checks.iter().all(|check| check["answer"] == "unknown"));
    let summary = assessment.summary("case");
    let words = summary.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("not known, as the run ended early"),
        "{summary}"
    );
}
