//! Which part of a run the verdict judges, and what is reported if that part is empty or lacks the
//! largest loads.

use crate::verdicts::{source, structure};
use snapload::analysis::no_progress;
use snapload::{Limit, State, Stop};
use snapload_structure::note::{page, seas_page};
use snapload_structure::{
    Answer, Lines, ModelAtRest, VerdictKind, Warning, assess, compare_elastic, seas,
};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");

/// The text on one line, as its line breaks do not matter.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Waves of 12 m throw the body onto the floor before the judged part begins: no number on the
/// lines is reported, in words, in JSON or on the page.
#[test]
fn where_nothing_is_judged_no_numbers_are_reported() {
    let text = EXAMPLE.replace("height = 2\n", "height = 12\n");
    assert_ne!(text, EXAMPLE);
    let assessment = assess(structure(&text), 4, &no_progress).unwrap();
    assert!(assessment.outcome.end_s < 10.0 && assessment.outcome.is_unjudged());
    let text = flat(&assessment.summary("case"));
    for words in [
        "of which nothing is judged, as judging begins at 60 s",
        "kN at rest; nothing is judged; breaks at 1319 kN",
        "rebound nothing is judged",
        "4 turn over or touch the floor",
        "The mooring fails",
        "ended before 60 s, the start of the judged time",
    ] {
        assert!(text.contains(words), "{words} in {text}");
    }
    for words in [
        " 0 kN",
        "slack 100",
        "slack 0",
        "0 snaps",
        "0.00 m/s",
        "fastest snap",
    ] {
        assert!(!text.contains(words), "{words} in {text}");
    }
    let json = assessment.to_json("case");
    for line in json["lines"].as_array().unwrap() {
        for key in [
            "snaps",
            "fastest_snap_m_s",
            "peak_tension_n",
            "held_tension_n",
            "least_tension_n",
            "slack_fraction",
            "utilisation",
        ] {
            assert!(line[key].is_null(), "{key}: {line}");
        }
        assert!(line["rest_tension_n"].as_f64().unwrap() > 0.0);
    }
    assert!(json["by_restitution"][0]["fastest_snap_m_s"].is_null());
    assert!(json["trust"]["peak_tension_quantiles_n"].is_null());
    let note = flat(&page(source("case"), &assessment, None).unwrap());
    assert!(note.contains("nothing is judged</td>") && note.contains("before anything is judged"));
    assert!(!note.contains("No line snaps at 1 cm/s or more"));
    // There is no hardest snap for its plots to be around.
    assert!(note.contains("the end of the run, as no snap is judged"));
    assert!(!note.contains("around the hardest snap"));
}

/// The same for elastic lines, and for records.
#[test]
fn nothing_judged_is_reported_for_elastic_lines_and_records() {
    let text = EXAMPLE.replace("height = 2\n", "height = 12\n");
    let prepared = ModelAtRest::for_elastic_lines(structure(&text)).unwrap();
    let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    assert!(comparison.outcome.is_unjudged());
    let text = flat(&comparison.summary("case"));
    assert!(
        text.contains("kN at rest; nothing is judged line 2"),
        "{text}"
    );
    let line = &comparison.to_json("case")["lines"][0];
    assert!(line["slack_fraction"].is_null() && line["peak_n"].is_null());
    let high = SEA
        .replace("hs = 1.2", "hs = 9")
        .replace("[run]", "[run]\nduration = 300");
    let records = seas(structure(&high), 2, Lines::Inextensible, &no_progress).unwrap();
    assert_eq!(records.judged_s(), 0.0);
    let text = flat(&records.summary("case"));
    assert!(
        text.contains("judged nothing, as no record lasts longer than 60 s")
            && !text.contains("slack"),
        "{text}"
    );
    let json = records.to_json("case");
    assert!(
        json["snaps_in_three_hours"].is_null()
            && json["slack_fraction"].is_null()
            && json["fastest_m_s"][0].is_null()
    );
    assert!(seas_page(source("case"), &records).is_ok());
}

/// A tension before the judged part would break a line that holds from then on: it is reported as a
/// part of the breaking load, and the verdict is open, in words, in JSON and in the colour of the
/// page. If the beginning is judged, the line breaks.
#[test]
fn a_line_that_breaks_before_it_is_judged_leaves_the_verdict_open() {
    let assessment = assess(structure(EXAMPLE), 2, &no_progress).unwrap();
    let early = assessment.snaps.iter().filter(|snap| snap.t_s < 60.0);
    let hardest = early
        .filter_map(|snap| snap.utilisation)
        .fold(0.0, f64::max);
    assert!(hardest > 2.0);
    let verdict = assessment.verdict();
    assert_eq!(verdict.standing, VerdictKind::Open);
    for words in [
        "In the judged time no line breaks".to_owned(),
        format!("kN, {hardest:.2} of its breaking load. It would break there"),
        "run.transient = 0".to_owned(),
    ] {
        assert!(
            verdict.words.contains(&words),
            "{words} in {}",
            verdict.words
        );
    }
    assert!(!verdict.words.contains("inextensible lines"));
    assert_eq!(assessment.to_json("case")["verdict"]["standing"], "open");
    let note = page(source("case"), &assessment, None).unwrap();
    assert!(note.contains("class=\"verdict open\"") && !note.contains("class=\"verdict holds\""));
    let all = EXAMPLE.replace("[run]", "[run]\ntransient = 0");
    let all = assess(structure(&all), 0, &no_progress).unwrap();
    assert_eq!(all.verdict().standing, VerdictKind::Breaks);
    // The same is reported of elastic lines.
    let short = EXAMPLE.replace("[run]", "[run]\nduration = 12");
    let prepared = ModelAtRest::for_elastic_lines(structure(&short)).unwrap();
    let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    let verdict = comparison.verdict();
    assert_eq!(verdict.standing, VerdictKind::Open);
    assert!(
        verdict.words.contains("1.83 of its breaking load"),
        "{}",
        verdict.words
    );
    assert!(verdict.words.contains("snapload seas --elastic"));
    // If it would not break the line, the line holds, and the tension before the judged part is
    // reported.
    let strong = EXAMPLE.replace("diameter = 0.038", "diameter = 0.038\nbreaking_load = 4e6");
    let strong = assess(structure(&strong), 0, &no_progress)
        .unwrap()
        .verdict();
    assert_eq!(strong.standing, VerdictKind::Holds);
    assert!(
        strong.words.contains("0.77 of its breaking load."),
        "{}",
        strong.words
    );
    assert!(!strong.words.contains("It would break"));
}

/// The report on a sea says in how many records a line breaks only before the judged part. If
/// records are judged from their first second, a line breaks in a record exactly if it breaks
/// before the later judged part or within it.
#[test]
fn records_report_what_breaks_before_they_are_judged() {
    for lines in [Lines::Inextensible, Lines::Elastic] {
        let judged_from = |seconds: u32| {
            let run = format!("[run]\nduration = 120\ntransient = {seconds}");
            let sea = SEA.replace("[run]", &run);
            let load = "diameter = 0.038\nbreaking_load = 3e6";
            let structure = structure(&sea.replace("diameter = 0.038", load));
            seas(structure, 8, lines, &no_progress).unwrap()
        };
        let [all, late] = [0, 80].map(judged_from);
        assert_eq!(all.breaking_only_early(), 0);
        let structure = &all.prepared.structure;
        let mut early_alone = 0;
        for (all, late) in all.records.iter().zip(&late.records) {
            let breaks = |outcome: &snapload_structure::Outcome| {
                let parts = outcome.utilisations(structure).into_iter().flatten();
                parts.fold(0.0, f64::max) >= 1.0
            };
            let early = late.outcome.breaks_early(structure);
            assert_eq!(
                breaks(&all.outcome),
                early || breaks(&late.outcome),
                "{lines:?}, seed {}",
                late.seed
            );
            early_alone += usize::from(early && !breaks(&late.outcome));
        }
        assert!(early_alone > 0, "{lines:?}");
        assert_eq!(late.breaking_only_early(), early_alone);
        let words =
            format!("In {early_alone} of the other records a line would break in the first 80 s");
        assert!(flat(&late.words()).contains(&words), "{}", late.words());
        assert_eq!(
            late.to_json("case")["breaking_only_before_judged"],
            early_alone
        );
        assert!(!all.words().contains("not judged"));
    }
}

/// A body that swings far from where the wave is evaluated is warned of by one run, by lines that
/// stretch, and by records, in the same words.
#[test]
fn far_swings_are_warned_of_by_every_answer() {
    let swinging = "[body]\nshape = \"circle\"\nwidth = 1\ndisplaced_volume = 0.785398\nmass = 100\n\
                    position = [0, -3]\nturning_damping = 300\n[[line]]\nanchor = [0, -10]\n\
                    fairlead = [0, -3]\nlength = 7\ntype = \"nylon\"\ndiameter = 0.02\nstiffness = 1e8\n\
                    breaking_load = 5e4\n[site]\ndepth = 10\n[sea]\nhs = 0.6\ntp = 6\n\
                    [run]\nrestitution = 1\nduration = 200\n\
                    transient = 100\n";
    let has_phase_warning =
        |warnings: &[Warning]| warnings.iter().any(|warning| warning.rule == "phase");
    let assessment = assess(structure(swinging), 0, &no_progress).unwrap();
    assert!(has_phase_warning(&assessment.warnings));
    for lines in [Lines::Inextensible, Lines::Elastic] {
        let records = seas(structure(swinging), 2, lines, &no_progress).unwrap();
        assert!(has_phase_warning(&records.warnings), "{lines:?}");
    }
    let prepared = ModelAtRest::for_elastic_lines(structure(swinging)).unwrap();
    let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    assert!(has_phase_warning(&comparison.warnings()));
    // In a calm sea there is no such warning.
    let calm = swinging.replace("hs = 0.6", "hs = 0.02");
    for lines in [Lines::Inextensible, Lines::Elastic] {
        let records = seas(structure(&calm), 2, lines, &no_progress).unwrap();
        assert!(!has_phase_warning(&records.warnings), "{lines:?}");
    }
}

/// If nothing snaps, in a run and its neighbours, one sentence says so and no tension of snaps is
/// reported.
#[test]
fn without_snaps_no_tension_of_snaps_is_reported() {
    let calm = EXAMPLE.replace("height = 2\n", "height = 0.1\n");
    for (count, words) in [
        (1, "No line snaps in the one neighbour in waves"),
        (3, "No line snaps in any of the 3 neighbours in waves"),
        (12, "No line snaps in any of the 12 neighbours in waves"),
    ] {
        let assessment = assess(structure(&calm), count, &no_progress).unwrap();
        let text = flat(&assessment.trust_text());
        assert!(text.contains(words), "{text}");
        assert_eq!(text.matches("neighbour").count(), 1, "{text}");
        assert!(!text.contains("0 kN"), "{text}");
    }
    let prepared = ModelAtRest::for_elastic_lines(structure(&calm)).unwrap();
    let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    assert!(
        !comparison.verdict().words.contains("0.00 m/s"),
        "{}",
        comparison.verdict().words
    );
}

/// A snap has a single tension: the table with the elastic lines says what its numbers leave
/// out, and gives the same tension as the assessment.
#[test]
fn the_hardest_snap_is_reported_alike_in_the_comparison() {
    let short = EXAMPLE.replace("[run]", "[run]\nduration = 12");
    let assessment = assess(structure(&short), 0, &no_progress).unwrap();
    let peaks = assessment.snaps.iter().filter_map(|snap| snap.peak_n);
    let hardest = peaks.fold(0.0, f64::max) / 1e3;
    let prepared = ModelAtRest::for_elastic_lines(structure(&short)).unwrap();
    let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    let text = flat(&comparison.summary("case"));
    let words = format!(
        "snapload assess includes the line's own mass: the largest tension in a snap is then {hardest:.0} kN"
    );
    assert!(text.contains(&words), "{words} in {text}");
    let snap = &comparison.to_json("case")["inextensible"]["snaps"][0];
    let of = |key: &str| snap[key].as_f64().unwrap();
    assert!(of("peak_n") > of("energy_peak_n"));
    let manual = include_str!("../../../../docs/structures.md");
    assert!(manual.contains(&format!("about {hardest:.0} kN where the chain breaks")));
}

/// Every column of the table of pulls has its unit, stands above its numbers, and is explained.
#[test]
fn the_columns_of_pulls_are_explained() {
    let short = EXAMPLE.replace("[run]", "[run]\nduration = 12");
    let prepared = ModelAtRest::for_elastic_lines(structure(&short)).unwrap();
    let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    let summary = comparison.summary("case");
    let mut rows = summary
        .lines()
        .skip_while(|row| !row.starts_with("  line  from s"));
    let (names, first) = (rows.next().unwrap(), rows.next().unwrap());
    // Numbers are aligned with the ends of the names of their columns.
    for name in ["line", "from s", "to s", "m/s", "kN", "back m/s"] {
        let end = names.find(name).unwrap() + name.len();
        let cell = first[..end].split_whitespace().last().unwrap();
        assert!(
            cell.parse::<f64>().is_ok(),
            "{name}: {cell} in\n{names}\n{first}"
        );
        assert!(first[end..].starts_with(' '), "{name} in\n{names}\n{first}");
    }
    let text = flat(&summary);
    for column in [
        "from, to: its start and end",
        "kN: its largest tension",
        "back: speed at which the line shortens",
    ] {
        assert!(text.contains(column), "{column} in {text}");
    }
}

/// A model in a basin, 2 kg and 4 l on two lines.
const MODEL: &str = "
[body]
width = 0.1
displaced_volume = 0.004
mass = 2
position = [0, -0.12]
[[line]]
anchor = [0.12, -0.3]
fairlead = [0.04, -0.15]
length = 0.17
stiffness = 2000
breaking_load = 50
[[line]]
anchor = [-0.12, -0.3]
fairlead = [-0.04, -0.15]
length = 0.17
stiffness = 2000
breaking_load = 50
[site]
depth = 0.3
water_density = 1000
gravity = 9.81
[wave]
height = 0.04
period = 0.85
[run]
restitution = 0.5
duration = 12
[design]
least_share = 0
";

/// A small body's numbers keep their digits: lines at an angle of cos 15/17 carry 2 kg g/2 17/15.
#[test]
fn a_small_body_is_printed_with_enough_digits() {
    let assessment = assess(structure(MODEL), 0, &no_progress).unwrap();
    let text = flat(&assessment.summary("model"));
    let rest_n = 0.5 * 2.0 * 9.81 * 17.0 / 15.0;
    for words in [
        format!("{:.4} kN at rest", rest_n / 1e3),
        "net buoyancy 0.0196 kN".to_owned(),
        "breaks at 0.0500 kN".to_owned(),
        "0.00200 t".to_owned(),
    ] {
        assert!(text.contains(&words), "{words} in {text}");
    }
    assert!(!text.contains(" 0 kN at"), "{text}");
    let page = page(source("model"), &assessment, None).unwrap();
    assert!(page.contains("breaking load 0.0500 kN") && page.contains("EA 0.00200 MN"));
}

/// The verdict tells of slack where its checks look for it, in the time that is judged.
#[test]
fn slack_before_anything_is_judged_is_reported_as_such() {
    let prepared = ModelAtRest::for_elastic_lines(structure(MODEL)).unwrap();
    let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    assert!(
        comparison
            .checks()
            .iter()
            .all(|(check, _)| check.answer == Answer::Passes)
    );
    let words = flat(&comparison.verdict().words);
    assert!(
        words.contains("No line goes slack except in the first 6 s, which are not judged."),
        "{words}"
    );
}

/// A body on two vertical tendons that the waves press onto the floor: on elastic lines, too, the
/// run ends where its lower edge reaches the floor, before any sample below it.
#[test]
fn a_run_on_elastic_lines_ends_where_the_body_touches_the_floor() {
    let line = |x: f64| {
        format!(
            "[[line]]\nanchor = [{x}, -20]\nfairlead = [{x}, -17]\nlength = 3\nstiffness = 1.2e9\n\
             breaking_load = 1e7\nmass_per_length = 30\n"
        )
    };
    let text = format!(
        "[body]\nshape = \"rectangle\"\nwidth = 4\nheight = 3\ndisplaced_volume = 240\nmass = 150000\n\
         added_mass = [150000, 150000, 300000]\nmoment_of_inertia = 400000\nposition = [0, -18.2]\n\
         linear_damping = 30000\n{}{}[site]\ndepth = 20\n[wave]\nheight = 1.85\nperiod = 8\n[run]\n\
         restitution = 0.5\nduration = 60\n",
        line(2.0),
        line(-2.0)
    );
    let prepared = ModelAtRest::new(structure(&text)).unwrap();
    let comparison = compare_elastic(prepared, 1.0, 0.01, &no_progress).unwrap();
    let run = &comparison.elastic;
    assert_eq!(run.stop, Some(Stop::UpperBound));
    let model = &comparison.elastic_case.model;
    let below = |state: &State| {
        let reached = Limit::UpperBound.quantity(&model.system, state);
        reached - model.rules.limits.of(Limit::UpperBound).unwrap()
    };
    assert!(run.samples.len() > 1000);
    let deepest = run.samples.iter().map(|sample| below(&sample.state));
    assert!(deepest.fold(f64::MIN, f64::max) < 1e-9);
    assert!(below(&run.end).abs() < 1e-9, "{}", below(&run.end));
    assert_eq!(comparison.verdict().standing, VerdictKind::Exceeds);
}

/// Where nothing was computed there is no motion: a run that stopped early does not stand still
/// after its end.
#[test]
fn motion_is_only_within_the_run() {
    let text = EXAMPLE.replace("height = 2\n", "height = 3\n");
    let found = assess(structure(&text), 0, &no_progress).unwrap();
    let (given, end) = (found.prepared.structure.duration_s, found.outcome.end_s);
    assert!(end < given, "{end}");
    assert_eq!(found.motion_at(&[0.0, end]).unwrap().len(), 2);
    for outside in [-1.0, end * (1.0 + 1e-9), given, f64::NAN] {
        let error = found.motion_at(&[0.0, outside]).unwrap_err();
        assert_eq!((&*error.key, error.value), ("times", outside.to_string()));
        assert!(
            error.allowed.contains(&format!("{end} s")),
            "{}",
            error.allowed
        );
    }
}
