//! The reports on structures that inextensible lines do not describe, or whose values are probably
//! mistakes.

use crate::softness::side_by_side;
use snapload::analysis::no_progress;
use snapload_structure::note::Source;
use snapload_structure::{
    Lines, ModelAtRest, Structure, VerdictKind, Water, assess, compare_elastic, seas,
};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");

/// The source that a page of the tests names.
pub(crate) fn source(name: &str) -> Source<'_> {
    Source {
        name,
        command: "",
        sha256: None,
    }
}

pub(crate) fn structure(text: &str) -> Structure {
    Structure::parse("case", text).unwrap()
}

/// Lines of polyester rope in place of chain, strong enough to bear the load at rest.
fn soft(text: &str) -> String {
    text.replace("studless chain", "polyester")
        .replace("diameter = 0.038", "diameter = 0.04\nbreaking_load = 5e5")
}

fn rules(text: &str) -> Vec<&'static str> {
    let assessment = assess(structure(text), 0, &no_progress).unwrap();
    assessment.warnings.iter().map(|w| w.rule).collect()
}

#[test]
fn soft_lines_leave_the_verdict_open() {
    let calm = EXAMPLE.replace("height = 2\n", "height = 0.5\n");
    let stiff = assess(structure(&calm), 2, &no_progress).unwrap();
    assert_eq!(stiff.verdict().standing, VerdictKind::Holds);
    let soft = soft(EXAMPLE);
    let open = assess(structure(&soft), 2, &no_progress).unwrap();
    let rule = open.warnings.iter().find(|w| w.rule == "instant snap");
    assert_eq!(rule.unwrap().decided_by, Some("snapload elastic"));
    let verdict = open.verdict();
    assert_eq!(verdict.standing, VerdictKind::Open);
    assert!(
        verdict.words.contains("snapload elastic decides"),
        "{}",
        verdict.words
    );
    assert!(!verdict.words.contains("No line breaks") && !verdict.words.contains("would break"));
}

#[test]
fn a_sea_has_the_warnings_of_a_wave() {
    let text = soft(SEA).replace("[run]", "[run]\nduration = 300");
    let result = seas(structure(&text), 3, Lines::Inextensible, &no_progress).unwrap();
    // The rule of the phase needs a single motion, and a short one has its own rule.
    let mut assessed = assess(structure(&text), 0, &no_progress).unwrap().warnings;
    assessed.retain(|w| w.rule != "phase" && w.rule != "short run");
    let of_sea = result.warnings.iter();
    let of_sea = of_sea.filter(|w| w.rule != "short records" && w.rule != "settling");
    assert!(assessed.iter().eq(of_sea) && result.is_open());
    assert!(result.warnings.iter().any(|w| w.rule == "short records"));
    let words = result.words();
    assert!(words.contains("snapload seas --elastic decides"), "{words}");
    assert!(!words.contains("probability"), "{words}");
    assert!(!words.contains("The largest tension"), "{words}");
    assert!(result.summary("case").contains("warning"));
    let json = result.to_json("case");
    assert_eq!(json["warnings"][0]["rule"], result.warnings[0].rule);
}

/// If the largest tension of a record is a held one and not that of a snap, it is counted, too.
#[test]
fn what_a_line_holds_is_among_the_largest() {
    let text = SEA.replace("[run]", "[run]\nduration = 600");
    let result = seas(structure(&text), 4, Lines::Inextensible, &no_progress).unwrap();
    let largest = result.largest_n().unwrap();
    for (record, largest) in result.records.iter().zip(largest) {
        let lines = &record.outcome.lines;
        let each = lines
            .iter()
            .map(|l| l.largest_taut_n.max(l.peak_n.unwrap_or(0.0)));
        assert_eq!(Some(each.fold(0.0, f64::max)), largest);
        assert!(largest.unwrap() >= record.outcome.peak_n().unwrap_or(0.0));
    }
    // Without waves that make lines slack there is no snap, and all tensions are held.
    let calm = crate::sea_extrapolation::damped(&text).replace("hs = 1.2", "hs = 0.03");
    let calm = seas(structure(&calm), 10, Lines::Inextensible, &no_progress).unwrap();
    let held = calm.largest_n().unwrap();
    let rest = calm
        .prepared
        .rest
        .tension_n
        .iter()
        .fold(0.0_f64, |a, b| a.max(*b));
    assert!(
        calm.records
            .iter()
            .all(|record| record.outcome.snaps() == 0)
    );
    assert!(
        held.iter().all(|largest| largest.unwrap() >= rest),
        "{held:?} {rest}"
    );
    assert!(calm.peak_in_three_hours().is_ok());
}

#[test]
fn too_few_records_are_not_too_few_snaps() {
    let text = SEA.replace("[run]", "[run]\nduration = 300");
    let words = seas(structure(&text), 2, Lines::Inextensible, &no_progress)
        .unwrap()
        .words();
    assert!(words.contains("2 records are too few"), "{words}");
}

#[test]
fn implausible_values_cause_warnings() {
    let geometric = [
        "proportions",
        "fairleads",
        "long lines",
        "lines in the body",
    ];
    assert!(!rules(EXAMPLE).iter().any(|rule| geometric.contains(rule)));
    // A decimal point in the wrong place: a body of 3 mm, which is then twenty thousand kilometres
    // long.
    let thin = EXAMPLE.replace("width = 3 ", "width = 0.003 ");
    let violated = rules(&thin);
    assert!(
        violated.contains(&"proportions") && violated.contains(&"fairleads"),
        "{violated:?}"
    );
    let long = EXAMPLE.replacen("length = 6", "length = 60", 1);
    assert!(rules(&long).contains(&"long lines"));
    // From the fairlead's other end of the diameter the line crosses the body.
    let across = EXAMPLE.replacen("[1.061, -4.561]", "[-1.061, -2.439]", 1);
    let across = across.replacen("length = 6", "length = 9", 1);
    assert!(rules(&across).contains(&"lines in the body"));
}

#[test]
fn a_run_that_ends_at_once_is_reported() {
    let text = EXAMPLE.replace("[run]", "[run]\nmax_snaps = 1");
    let verdict = assess(structure(&text), 0, &no_progress).unwrap().verdict();
    assert!(
        verdict.words.contains("ended before 60 s"),
        "{}",
        verdict.words
    );
}

/// Lines as springs decide a verdict that inextensible ones leave open; the records are the same
/// seas.
#[test]
fn a_sea_on_lines_that_stretch_decides() {
    let text = soft(SEA).replace("[run]", "[run]\nduration = 300");
    let result = seas(structure(&text), 3, Lines::Elastic, &no_progress).unwrap();
    assert!(!result.is_open());
    let one = &result.records[1];
    let mut alone = structure(&text);
    if let Water::Sea(sea) = &mut alone.water {
        sea.seed = one.seed;
    }
    let prepared = ModelAtRest::new(alone).unwrap();
    let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    for (line, peak) in comparison.elastic.peaks_n.iter().enumerate() {
        assert_eq!(one.outcome.lines[line].largest_n(), Some(*peak));
    }
    let [crests, troughs] = result.crests_and_troughs_n();
    let largest = result.largest_n().unwrap().into_iter().flatten();
    let largest = largest.fold(0.0, f64::max);
    assert!(crests.len() == troughs.len() && crests.len() > 20);
    assert!(*crests.last().unwrap() <= largest && troughs[0] >= 0.0);
}

/// If a line is slack in most troughs, this is reported, and not that the troughs are above zero.
#[test]
fn slack_troughs_are_reported_as_slack() {
    let text = |height: &str| {
        let text = SEA.replace("[run]", "[run]\nduration = 600");
        let text = text.replace("hs = 1.2", &format!("hs = {height}"));
        let result = seas(structure(&text), 3, Lines::Inextensible, &no_progress).unwrap();
        let [_, troughs] = result.crests_and_troughs_n();
        let slack = troughs.iter().filter(|trough| **trough == 0.0).count();
        let part = slack as f64 / troughs.len() as f64;
        let json = result.to_json("case");
        assert_eq!(json["troughs_n"]["slack_part"], part);
        let words = result
            .summary("case")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        (part, words)
    };
    let (part, words) = text("1.2");
    assert!(part > 0.5, "{part}");
    let slack = format!("troughs slack (0 kN) in {:.1} %", 100.0 * part);
    assert!(
        words.contains(&slack) && !words.contains("above 0 kN"),
        "{words}"
    );
    // Low waves leave no line slack.
    let (part, words) = text("0.05");
    assert_eq!(part, 0.0);
    assert!(
        words.contains("troughs half below") && !words.contains("(0 kN)"),
        "{words}"
    );
}

/// Neighbouring numbers may be for three hours, for all records or for one: each line says which.
#[test]
fn every_line_of_a_sea_names_what_it_is_of() {
    let text = crate::sea_extrapolation::damped(SEA).replace("hs = 1.2", "hs = 2.5");
    let text = text.replace("[run]", "[run]\nduration = 600");
    let result = seas(structure(&text), 10, Lines::Inextensible, &no_progress).unwrap();
    let summary = result.summary("case");
    let mut rows: Vec<String> = Vec::new();
    for line in summary.lines() {
        match line.strip_prefix("            ") {
            Some(more) => *rows.last_mut().unwrap() += &format!(" {more}"),
            None => rows.push(line.trim().to_owned()),
        }
    }
    let row = |label: &str| {
        let found = rows.iter().find(|row| row.starts_with(label));
        found.unwrap_or_else(|| panic!("{label} in {summary}"))
    };
    let judged = "in all 10 records from 60 s on";
    assert!(row("line 1").contains("of the whole time, the mean over the records; at most"));
    assert!(row("snaps").contains("in three hours, the mean over the records; in all 10"));
    assert!(row("snaps").contains(judged) && row("waves").contains(judged));
    assert!(row("fastest").contains("in three hours"));
    assert!(
        row("verdict").contains("of 10 records of 600 s"),
        "{summary}"
    );
    let calm = text.replace("hs = 2.5", "hs = 0.05");
    let calm = seas(structure(&calm), 1, Lines::Inextensible, &no_progress).unwrap();
    let text = calm.summary("case");
    assert!(
        text.contains("none of 1 cm/s or more in the one record from 60 s on"),
        "{text}"
    );
}

/// The run with the case's own restitution is listed among those with lower and higher ones.
#[test]
fn the_restitution_is_varied() {
    let text = EXAMPLE.replace("[run]", "[run]\nduration = 120");
    let assessment = assess(structure(&text), 0, &no_progress).unwrap();
    let rows = assessment.by_restitution();
    let es: Vec<f64> = rows.iter().map(|row| row.restitution).collect();
    assert_eq!(es, [0.3, 0.5, 0.7]);
    let alone = text.replace("restitution = 0.5", "restitution = 0.7");
    let alone = assess(structure(&alone), 0, &no_progress).unwrap();
    let fastest_m_s = rows[2].numbers.fastest_snap_m_s;
    assert_eq!(fastest_m_s, Some(alone.outcome.speed_m_s()));
    let rigid = text.replace("restitution = 0.5", "restitution = 1");
    let rigid = assess(structure(&rigid), 0, &no_progress).unwrap();
    assert_eq!(rigid.by_restitution().len(), 2);
}

/// Two lines side by side, one of them 5 mm shorter, share the load as two springs do: s₁ = s₂ + δ
/// and k₁ s₁ + k₂ s₂ = F. With inextensible lines the shorter one would carry all of it.
#[test]
fn the_stretch_of_lines_shares_the_load_at_rest() {
    let text = side_by_side([15.0, 15.005], "");
    let assessment = assess(structure(&text), 0, &no_progress).unwrap();
    let rest = &assessment.prepared.rest;
    let force = assessment.prepared.structure.net_buoyancy_n();
    let by_stiffness = rest.by_stiffness.as_ref().unwrap();
    let rigid = &by_stiffness.inextensible_n;
    assert!((rigid[0] - force).abs() < 1e-6 * force && rigid[1] == 0.0);
    let (k1, k2) = (3e6 / 15.0, 3e6 / 15.005);
    let second = (force - k1 * 0.005) / (k1 + k2);
    let known = [k1 * (second + 0.005), k2 * second];
    for (found, known) in rest.tension_n.iter().zip(known) {
        assert!((found - known).abs() < 1e-7 * force, "{found} {known}");
    }
    // Straight above the anchor, as high as the longer line is with its stretch.
    let known = -20.0 + 15.005 + second;
    assert!(
        (by_stiffness.place_m[1] - known).abs() < 1e-9,
        "{:?} {known}",
        by_stiffness.place_m
    );
    // The position of rest does not depend on the restitution.
    let dead = text.replace("restitution = 0.5", "restitution = 0");
    let dead = assess(structure(&dead), 0, &no_progress).unwrap();
    assert_eq!(dead.prepared.rest, *rest);
    assert!(dead.periods.unwrap().elastic.is_some());
    let warning = assessment
        .warnings
        .iter()
        .find(|w| w.rule == "shared loads")
        .unwrap();
    assert!(
        warning
            .message
            .contains(&format!("would carry {:.2}/0 kN", force / 1e3)),
        "{}",
        warning.message
    );
    assert_eq!(assessment.verdict().standing, VerdictKind::Open);
    // Lines of equal length share evenly in either model, and there is no warning.
    let even = text.replace("15.005", "15");
    let even = assess(structure(&even), 0, &no_progress).unwrap();
    assert!(even.prepared.rest.by_stiffness.is_none());
}

/// A verdict that no line breaks does not stand if a line breaks in a neighbour: the breaking load
/// is put between the largest tension of the run and that of its neighbours.
#[test]
fn a_line_that_breaks_in_a_neighbour_leaves_the_verdict_open() {
    let text = SEA.replace("[run]", "[run]\nduration = 1500");
    let assess = |load: f64| {
        let text = text.replace("[[line]]", &format!("[[line]]\nbreaking_load = {load}"));
        assess(structure(&text), 12, &no_progress).unwrap()
    };
    let strong = assess(1e9);
    assert!(!strong.verdict().words.contains("neighbours"));
    let largest = |outcome: &snapload_structure::Outcome| outcome.largest_n();
    let ours = largest(&strong.outcome);
    let others: Vec<f64> = strong.neighbours.iter().map(largest).collect();
    let above = others.iter().copied().fold(0.0, f64::max);
    assert!(above > 1.001 * ours, "{ours} {above}");
    let load = 0.5 * (ours + above);
    let verdict = assess(load).verdict();
    let count = others.iter().filter(|tension| **tension >= load).count();
    assert_eq!(verdict.standing, VerdictKind::Open);
    let sentence = format!("In {count} of 12 neighbours a line would break");
    assert!(verdict.words.contains(&sentence), "{}", verdict.words);
    assert!(!verdict.words.contains("is 1.00"), "{}", verdict.words);
}

/// Elastic lines on which a body would rest above the water are refused, as inextensible ones are.
#[test]
fn elastic_lines_hold_the_body_under_water() {
    let weak = SEA.replace("[[line]]", "[[line]]\nstiffness = 1e5\nbreaking_load = 1e6");
    let result = seas(structure(&weak), 2, Lines::Elastic, &no_progress);
    let message = result.map(|_| ()).unwrap_err().to_string();
    assert!(
        message.contains("its top is") && message.contains("line.length"),
        "{message}"
    );
}

/// The weight of lines is compared with the buoyancy, by hand: 2 lines of 6 m and 1500 kg/m.
#[test]
fn lines_whose_weight_matters_are_warned_of() {
    let text = EXAMPLE.replace("[[line]]", "[[line]]\nmass_per_length = 1500");
    assert!(!rules(EXAMPLE).contains(&"light lines"));
    let assessment = assess(structure(&text), 0, &no_progress).unwrap();
    let warning = assessment.warnings.iter().find(|w| w.rule == "light lines");
    let mass = 2.0 * 6.0 * 1500.0;
    let of_mass = 100.0 * mass / (72452.0 + 144904.0);
    let of_buoyancy = 100.0 * mass / (1025.0 * 141.37 - 72452.0);
    let message = &warning.unwrap().message;
    for part in [format!("{of_mass:.2} %"), format!("{of_buoyancy:.0} %")] {
        assert!(message.contains(&part), "{message}");
    }
}

/// Neighbours that agree to the digits shown have one peak, not a range of equal ends.
#[test]
fn equal_peaks_of_neighbours_are_one_number() {
    for count in [2, 12] {
        let assessment = assess(structure(EXAMPLE), count, &no_progress).unwrap();
        let peaks = assessment.neighbours.iter().map(|n| n.peak_n().unwrap());
        let all: Vec<String> = peaks.map(|peak| format!("{:.0}", peak / 1e3)).collect();
        assert!(all.iter().all(|peak| *peak == all[0]), "{all:?}");
        let words = assessment.trust_text();
        assert!(words.contains(&format!("{} kN", all[0])), "{words}");
        assert!(!words.contains(&format!("{} to", all[0])), "{words}");
    }
}

/// Lines so soft that the body rises out of the water on them are not computed as inextensible
/// without a word, in waves or without: the lines of the example carry 392 kN at rest, which is a
/// stretch of 2.35 m at 1 MN, and the body's top is 2 m below the water.
#[test]
fn lines_on_which_the_body_does_not_rest_leave_the_verdict_open() {
    let soft = EXAMPLE.replace("[[line]]", "[[line]]\nstiffness = 1e6\nbreaking_load = 1e9");
    let slow = soft.replace("height = 2\nperiod = 6", "height = 0.5\nperiod = 40");
    let (still, _) = soft.split_once("[wave]").unwrap();
    let still = format!("{still}[run]\nrestitution = 0.5\nduration = 20\n");
    for text in [&slow, &still] {
        let assessment = assess(structure(text), 0, &no_progress).unwrap();
        let verdict = assessment.verdict();
        assert_eq!(verdict.standing, VerdictKind::Open);
        assert!(
            verdict.words.contains("see rest on elastic lines"),
            "{}",
            verdict.words
        );
        // The command that would decide refuses the case.
        assert!(!verdict.words.contains("decides"), "{}", verdict.words);
        let prepared = ModelAtRest::new(structure(text)).unwrap();
        let decided = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress);
        assert!(decided.is_err());
    }
    let stiff = soft.replace("stiffness = 1e6", "stiffness = 1e9");
    assert!(!rules(&stiff).contains(&"rest on elastic lines"));
}

/// In still water a snap on soft lines lasts as long as in waves.
#[test]
fn soft_lines_are_soft_in_still_water_too() {
    let start = "[run]\nrestitution = 0.5\nduration = 20\nstart = [0.6, -4.2]\n";
    let in_still_water = |text: &str| text.split_once("[wave]").unwrap().0.to_owned() + start;
    let assessment = assess(structure(&in_still_water(&soft(EXAMPLE))), 0, &no_progress).unwrap();
    let warning = assessment
        .warnings
        .iter()
        .find(|w| w.rule == "instant snap");
    assert_eq!(warning.unwrap().decided_by, Some("snapload elastic"));
    assert_eq!(assessment.verdict().standing, VerdictKind::Open);
    assert!(!rules(&in_still_water(EXAMPLE)).contains(&"instant snap"));
}

/// Elastic lines have a restitution of 0.01 or more: a verdict that leaves the answer to them
/// says so where the case has less.
#[test]
fn a_verdict_names_the_restitution_that_elastic_lines_need() {
    for (restitution, needs) in [("0.0", true), ("0.3", false)] {
        let text =
            soft(EXAMPLE).replace("restitution = 0.5", &format!("restitution = {restitution}"));
        let words = assess(structure(&text), 0, &no_progress)
            .unwrap()
            .verdict()
            .words;
        assert!(words.contains("snapload elastic decides"), "{words}");
        assert_eq!(
            words.contains("decides, with a run.restitution of 0.01 or more."),
            needs,
            "{words}"
        );
    }
}
