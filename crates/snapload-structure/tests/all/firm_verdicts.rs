//! A verdict on a sea is no firmer than what its records tell.

use crate::sea_extrapolation::damped;
use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{
    Answer, Assessment, Gumbel, Lines, ModelAtRest, NoDistribution, Seas, VerdictKind, assess,
    compare_elastic, seas,
};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");
/// So many times three hours are enough without a distribution.
const ENOUGH: i32 = 36;

/// The sea of the example with these keys of `[sea]` and `[run]`, on lines of this strength \[N\].
fn sea_text(sea: &str, run: &str, load: f64) -> String {
    SEA.replace("hs = 1.2\n", sea)
        .replace("[run]\n", &format!("[run]\n{run}"))
        .replace("[[line]]\n", &format!("[[line]]\nbreaking_load = {load}\n"))
}

fn records(text: &str, count: u32, lines: Lines) -> Seas {
    seas(structure(text), count, lines, &no_progress).unwrap()
}

fn alone(text: &str) -> Assessment {
    Assessment::single_run(structure(text), &no_progress).unwrap()
}

/// One of two records of a sea has the larger tension, each with the same probability: that no line
/// breaks in the first says nothing firm of the second, however long they are. In the same
/// way the fifth of five records has the largest tension of all in one of five seas, and lines that
/// just bear four records break in more than a tenth of them.
#[test]
fn records_of_three_hours_do_not_hold_by_themselves() {
    let text = sea_text("hs = 1.2\n", "duration = 10860\n", 1e9);
    let mut four = records(&text, 4, Lines::Inextensible);
    assert_eq!(four.standing(), VerdictKind::Holds);
    let largest = four.largest_n().unwrap().into_iter().flatten();
    let load = 1.0001 * largest.fold(0.0, f64::max);
    for line in &mut four.prepared.structure.lines {
        line.breaking_load_n = Some(load);
    }
    assert_eq!(four.failing().count, 0);
    assert!(four.peak_in_three_hours().unwrap().quantile(0.9).value > load);
    assert_eq!(four.standing(), VerdictKind::Open);
    let words = four.words();
    assert!(words.contains("In 0 of 4 records"), "{words}");
    assert!(words.contains("Run more or longer records"), "{words}");
    four.records.truncate(1);
    assert_eq!(four.peak_in_three_hours(), Err(NoDistribution::TooFew(1)));
    assert_eq!(four.standing(), VerdictKind::Open);
}

/// The largest tension of six hours is not less than that of three. Where it may reach a line's
/// breaking load in one of ten records of six hours, that is open, and else no line breaks in
/// three; how much less three hours have is not said.
#[test]
fn records_of_six_hours_are_taken_as_no_less_than_three() {
    let text = sea_text("hs = 1.2\n", "duration = 10860\n", 1e9);
    let mut four = records(&text, 4, Lines::Inextensible);
    four.prepared.structure.duration_s = 60.0 + 21_600.0;
    assert_eq!(four.standing(), VerdictKind::Holds, "{}", four.words());
    let largest = |of: &Seas, line: usize| -> Vec<f64> {
        let records = of.records.iter();
        records
            .map(|record| record.outcome.lines[line].largest_n().unwrap())
            .collect()
    };
    let may_reach_n = Gumbel::fit(&largest(&four, 0)).unwrap().at_most(0.9);
    for (part, standing) in [(1.001, VerdictKind::Holds), (0.999, VerdictKind::Open)] {
        four.prepared.structure.lines[0].breaking_load_n = Some(part * may_reach_n);
        assert_eq!(four.failing().count, 0);
        assert_eq!(four.standing(), standing, "{part}");
    }
    let too_long = Err(NoDistribution::TooLong);
    assert_eq!(four.peak_in_three_hours(), too_long);
    let words = four.words();
    let why = "as each record judges more than three hours";
    assert!(words.contains(why), "{words}");
    let open = "Whether a line breaks within three hours is open, as no distribution is given.";
    assert!(words.contains(open), "{words}");
}

/// Without a distribution, as lines snap in some records only, the judged time decides: with a
/// probability of a tenth in three hours, 36 times three hours are without a break with a
/// probability of less than 2.5 %, and 35 with one of more.
#[test]
fn a_sea_of_a_hundred_hours_holds_without_a_distribution() {
    assert!(0.9_f64.powi(ENOUGH) < 0.025 && 0.9_f64.powi(ENOUGH - 1) > 0.025);
    let text = sea_text("hs = 0.35\n", "duration = 240\n", 1e9);
    let mut twelve = records(&text, 12, Lines::Inextensible);
    let without = twelve.peak_in_three_hours().unwrap_err();
    assert!(matches!(without, NoDistribution::SomeWithoutSnaps(_, 12)));
    let enough_s = f64::from(ENOUGH) * 10_800.0 / 12.0;
    for (judged_s, standing) in [
        (180.0, VerdictKind::Open),
        (enough_s - 1.0, VerdictKind::Open),
        (enough_s + 1.0, VerdictKind::Holds),
    ] {
        twelve.prepared.structure.duration_s = 60.0 + judged_s;
        assert_eq!(twelve.standing(), standing, "{judged_s}");
    }
    let words = twelve.words();
    let firm = "As the records judge 36 times three hours or more, the lines hold in nine of ten";
    assert!(words.contains(firm), "{words}");
}

/// One record has the same verdict from each command: open unless a line breaks in it, whether
/// seconds or an hour of it are judged; a short one is warned of.
#[test]
fn one_record_has_one_verdict() {
    for (duration, load, standing) in [
        (30, 1e9, VerdictKind::Open),
        (120, 1e9, VerdictKind::Open),
        (1000, 1e9, VerdictKind::Open),
        (1000, 1e5, VerdictKind::Breaks),
    ] {
        let text = sea_text("hs = 1.2\n", &format!("duration = {duration}\n"), load);
        let (run, one) = (alone(&text), records(&text, 1, Lines::Inextensible));
        let verdict = run.verdict();
        assert_eq!(verdict.standing, standing, "{duration}: {}", verdict.words);
        assert_eq!(one.standing(), standing, "{duration}: {}", one.words());
        let is_short = run.warnings.iter().any(|w| w.rule == "short run");
        assert_eq!(
            is_short,
            one.warnings.iter().any(|w| w.rule == "short records")
        );
        assert_eq!(is_short, duration < 960);
        let told = "others have higher loads, so the verdict is open: snapload seas runs more";
        assert_eq!(verdict.words.contains(told), standing == VerdictKind::Open);

        let one = records(&text, 1, Lines::Elastic);
        let prepared = ModelAtRest::for_elastic_lines(structure(&text)).unwrap();
        let elastic = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
        assert_eq!(elastic.verdict().standing, one.standing(), "{duration}");
    }
}

/// A sea of no height is still water, which has no other records.
#[test]
fn still_water_holds_by_one_record() {
    let text = sea_text("hs = 0\n", "duration = 30\n", 1e9);
    assert_eq!(alone(&text).verdict().standing, VerdictKind::Holds);
    let one = records(&text, 1, Lines::Inextensible);
    assert_eq!(one.standing(), VerdictKind::Holds);
}

/// One record of a sea is open anyway; a regular wave is so by its neighbours alone.
#[test]
fn neighbours_open_what_a_run_holds() {
    let design =
        "[design]\npretension_factor = 1\nenvironment_factor = 1\nstrength_factor = 1\n[run]";
    let calm = EXAMPLE
        .replace("height = 2\n", "height = 0.5\n")
        .replace("[run]", design);
    let mut calm = assess(structure(&calm), 12, &no_progress).unwrap();
    assert_eq!(calm.verdict().standing, VerdictKind::Holds);
    assert!(
        calm.checks()
            .iter()
            .all(|(check, n)| check.answer == Answer::Passes && *n == 12)
    );
    calm.neighbours[0].lines[0].peak_n = Some(1e9);
    let verdict = calm.verdict();
    assert_eq!(verdict.standing, VerdictKind::Open);
    let sentence = "In 1 of 12 neighbours a line would break or the mooring fail, so the verdict";
    assert!(verdict.words.contains(sentence), "{}", verdict.words);
    let (check, agreeing) = calm.checks()[0].clone();
    assert_eq!((check.answer, agreeing), (Answer::Open, 11));
    assert_eq!(calm.checks()[1].0.answer, Answer::Passes);
}

/// N sinusoids of sqrt(2 m0/N) reach sqrt(2 N m0) at most, which for N = 10 is 4.5 standard
/// deviations of the surface; records of so few decide nothing, with neither model of the lines,
/// whether a line breaks in them or not.
#[test]
fn a_sea_of_few_sinusoids_decides_nothing() {
    let rule = "few components";
    for load in [1e9, 1e5] {
        let text = |count: usize| {
            let sea = format!("hs = 1.2\ncomponents = {count}\n");
            damped(&sea_text(&sea, "duration = 1000\n", load))
        };
        for lines in [Lines::Inextensible, Lines::Elastic] {
            let few = records(&text(99), 4, lines);
            assert_eq!(few.standing(), VerdictKind::Open, "{}", few.words());
            assert_eq!(few.probability(), None);
            assert!(
                few.words().contains("As computed the largest"),
                "{}",
                few.words()
            );
            assert!(few.warnings.iter().any(|warning| warning.rule == rule));
            let enough = records(&text(100), 4, lines);
            assert_ne!(enough.standing(), VerdictKind::Open, "{}", enough.words());
            assert!(!enough.warnings.iter().any(|warning| warning.rule == rule));
        }
        let run = alone(&text(10));
        let verdict = run.verdict();
        assert_eq!(verdict.standing, VerdictKind::Open, "{}", verdict.words);
        assert!(
            verdict.words.contains("(see few components)"),
            "{}",
            verdict.words
        );
    }
}

/// The record of every seed can be looked at alone, so none follows the last seed that a case may
/// have, 2^32 - 1.
#[test]
fn no_record_has_a_seed_that_a_case_may_not_have() {
    let last = |count: u32| {
        let text = sea_text("hs = 1.2\nseed = 4294967295\n", "duration = 0.5\n", 1e9);
        seas(structure(&text), count, Lines::Inextensible, &no_progress)
    };
    let words = last(1).unwrap().words();
    assert!(
        words.contains("In 0 of 1 record of 0.5 s a line"),
        "{words}"
    );
    let error = last(2).unwrap_err().to_string();
    assert!(
        error.contains("sea.seed") && error.contains("at most 4294967294"),
        "{error}"
    );
}
