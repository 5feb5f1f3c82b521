//! A floating body whose lines hold it where linear hydrostatics do not hold.

use snapload::analysis::no_progress;
use snapload_structure::{
    Assessment, Lines, ModelAtRest, Structure, VerdictKind, assess, compare_elastic, seas,
};

/// A box of 4 m x 2 m x 20 m and 80 t with a draft of 1.2 m on two
/// vertical lines from z = `anchor`.
fn moored(anchor: f64, fairlead: f64, length: f64, rest: &str) -> Structure {
    let line = |x: f64| {
        format!(
            "[[line]]\nanchor = [{x}, {anchor}]\nfairlead = [{x}, {fairlead}]\nlength = {length}\n\
             stiffness = 5e8\nbreaking_load = 5e5\n"
        )
    };
    let text = format!(
        "[body]\nshape = \"rectangle\"\nwidth = 4\nheight = 2\ndisplaced_volume = 96\nmass = 80000\n\
         position = [0, -0.2]\n[float]\ndamping = [5000, 30000, 50000]\n{}{}[site]\ndepth = 10\n{rest}",
        line(2.0),
        line(-2.0)
    );
    Structure::parse("box", &text).unwrap()
}

const STILL: &str = "[run]\nrestitution = 0.3\nduration = 60\n";

/// Wholly under water the box lifts its 160 m³ of water less its 80 t, 823.8 kN, and above the
/// water it weighs 784.5 kN: what C33 z gives beyond that is told as impossible, and no line is
/// said to break or to hold, neither an inextensible nor an elastic one.
#[test]
fn buoyancy_beyond_the_whole_body_leaves_the_verdict_open() {
    let submerged_kn: f64 = (160.0 * 1025.0 - 80_000.0) * 9.806_65e-3;
    let weight_kn: f64 = 80_000.0 * 9.806_65e-3;
    for (structure, beyond, possible_kn) in [
        (
            moored(-10.0, -1.2, 7.0, STILL),
            "the whole deck is 1.00 m under",
            submerged_kn,
        ),
        (
            moored(6.0, 0.8, 3.0, STILL),
            "the whole body is 1.00 m above",
            weight_kn,
        ),
    ] {
        let answer = assess(structure.clone(), 0, &no_progress).unwrap();
        let verdict = answer.verdict();
        assert_eq!(verdict.standing, VerdictKind::Open, "{}", verdict.words);
        assert!(
            verdict.words.contains("(see hydrostatics)"),
            "{}",
            verdict.words
        );
        assert!(!verdict.words.contains("decides"), "{}", verdict.words);
        let found = answer.warnings.iter().find(|w| w.rule == "hydrostatics");
        let message = &found.expect("a warning").message;
        assert!(message.contains(beyond), "{message}");
        let most = format!("no more than {possible_kn:.0} kN are possible");
        assert!(message.contains(&most), "{message}");

        let prepared = ModelAtRest::for_elastic_lines(structure).unwrap();
        let elastic = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
        let verdict = elastic.verdict();
        assert_eq!(verdict.standing, VerdictKind::Open, "{}", verdict.words);
        assert!(!verdict.words.contains("inextensible"), "{}", verdict.words);
        assert!(elastic.warnings().iter().any(|w| w.rule == "hydrostatics"));
    }
}

/// With its deck above water the same box holds or breaks as before.
#[test]
fn a_box_with_its_deck_above_water_has_a_firm_verdict() {
    let answer = assess(moored(-10.0, -1.2, 8.1, STILL), 0, &no_progress).unwrap();
    assert_eq!(answer.verdict().standing, VerdictKind::Holds);
    assert!(answer.warnings.iter().all(|w| w.rule != "hydrostatics"));
}

/// Held with its deck 0.2 m above the still water, the box is wholly under the crests of a long
/// wave of 0.6 m, where its lines pull most, and not under those of one of 0.3 m. Where slack lines
/// break in snaps at other times, they break.
#[test]
fn a_deck_under_the_crests_leaves_the_verdict_open() {
    for (length, height, warns, standing) in [
        (8.2, 0.6, true, VerdictKind::Open),
        (8.2, 0.3, false, VerdictKind::Holds),
        (8.5, 2.4, true, VerdictKind::Breaks),
    ] {
        let water = format!(
            "[wave]\nheight = {height}\nperiod = 9\n[run]\nrestitution = 0.3\nduration = 180\n"
        );
        let answer = assess(moored(-10.0, -1.2, length, &water), 0, &no_progress).unwrap();
        let warned = answer.warnings.iter().any(|w| w.rule == "hydrostatics");
        assert_eq!(warned, warns, "{:?}", answer.warnings);
        let verdict = answer.verdict();
        assert_eq!(verdict.standing, standing, "{}", verdict.words);
    }
    let sea = "[sea]\nhs = 0.5\ntp = 9\n[run]\nrestitution = 0.3\nduration = 100\n";
    let structure = moored(-10.0, -1.2, 8.2, sea);
    let records = seas(structure, 1, Lines::Elastic, &no_progress).unwrap();
    assert_eq!(records.standing(), VerdictKind::Open);
    assert!(
        !records.words().contains("inextensible"),
        "{}",
        records.words()
    );
}

/// Of two lines of one run the first one pulls most while the deck is above the waves, the
/// second one under them. A line is said to break by a reliable tension alone, and by how
/// much: the second one not at all with a breaking load between its two tensions, and by
/// 1/0.8 with 0.8 of the reliable one.
#[test]
fn a_line_does_not_break_by_a_tension_under_the_waves() {
    let water = "[wave]\nheight = 1.5\nperiod = 9\n[run]\nrestitution = 0.3\nduration = 180\n";
    let mut answer = assess(moored(-10.0, -1.2, 8.5, water), 0, &no_progress).unwrap();
    let [first, second] = [0, 1].map(|line| {
        let of_line = &answer.outcome.lines[line];
        [of_line.reliable_n, of_line.largest_n().unwrap()]
    });
    assert!(first[1] == first[0] && second[1] > 1.2 * second[0]);
    let one = "One line would break (in brackets the ratio of estimated tension to breaking load): \
               line 1 (1.25, in a snap).";
    let both = "line 1 (1.25, in a snap), line 2 (1.25, while linear hydrostatics hold).";
    for (second_n, told) in [
        (0.5 * (second[0] + second[1]), one),
        (0.8 * second[0], both),
    ] {
        let lines = &mut answer.prepared.structure.lines;
        lines[0].breaking_load_n = Some(0.8 * first[0]);
        lines[1].breaking_load_n = Some(second_n);
        let verdict = answer.verdict();
        assert_eq!(verdict.standing, VerdictKind::Breaks);
        assert!(verdict.words.contains(told), "{}", verdict.words);
    }
}

/// Of many records those are said to fail that fail alone, and those that are open alone are open:
/// there is no probability, and the distribution is one of tensions as computed.
#[test]
fn records_fail_as_each_of_them_does_alone() {
    let sea = |seed: u64| {
        let sea = format!("[sea]\nhs = 1.9\ntp = 9\nseed = {seed}\n");
        let run = "[run]\nrestitution = 0.3\nduration = 150\n";
        let mut structure = moored(-10.0, -1.2, 8.55, &(sea + run));
        for line in &mut structure.lines {
            line.breaking_load_n = Some(3e6);
        }
        structure
    };
    let alone = |seed: u64| assess(sea(seed), 0, &no_progress).unwrap();
    let all: Vec<Assessment> = (1..=5).map(alone).collect();
    let breaks = |one: &&Assessment| one.verdict().standing == VerdictKind::Breaks;
    let breaking = all.iter().filter(breaks).count();
    // One record of a sea in which no line breaks is open, too, but not by a rule.
    let by_a_rule = |one: &&Assessment| one.warnings.iter().any(|warning| warning.leaves_open);
    let open = all.iter().filter(by_a_rule).count();
    assert!(breaking > 0 && open > 0 && breaking + open < 5);
    let records = seas(sea(1), 5, Lines::Inextensible, &no_progress).unwrap();
    assert_eq!(records.standing(), VerdictKind::Breaks);
    assert_eq!(records.probability(), None);
    let words = records.words();
    for told in [
        format!("In {breaking} of 5 records a line would break or the mooring fail."),
        format!(
            "That is open in {open} more, as their tensions are not reliable (see hydrostatics)."
        ),
        "As computed the largest tension in three hours is expected".to_owned(),
    ] {
        assert!(words.contains(&told), "{words}");
    }
    assert!(!words.contains("is not known"), "{words}");
}

/// The added mass of a textbook is that of deep water: 0.2 m over the floor of 1.4 m, less than
/// half the height of the box, is warned of, and 8.8 m over one of 10 m is not.
#[test]
fn a_floor_close_under_a_floating_body_is_warned_of() {
    let warned = |depth: f64| {
        let line = |x: f64| {
            format!(
                "[[line]]\nanchor = [{}, -{depth}]\nfairlead = [{x}, -1.2]\nlength = 12\nstiffness = 5e8\n\
                 breaking_load = 5e5\n",
                2.5 * x
            )
        };
        let text = format!(
            "[body]\nshape = \"rectangle\"\nwidth = 4\nheight = 2\ndisplaced_volume = 96\nmass = 98400\n\
             position = [0, -0.2]\n[float]\n{}{}[site]\ndepth = {depth}\n[run]\nrestitution = 0.3\n\
             duration = 1\nstart = [0, -0.2]\n",
            line(2.0),
            line(-2.0)
        );
        let structure = Structure::parse("box", &text).unwrap();
        let answer = assess(structure, 0, &no_progress).unwrap();
        let found = answer.warnings.into_iter().find(|w| w.rule == "floor");
        found.map(|warning| warning.message)
    };
    let message = warned(1.4).expect("a warning");
    assert!(message.contains("0.20 m above the floor"), "{message}");
    assert_eq!(warned(10.0), None);
}
