//! The outcomes of runs and of ensembles of runs.

use snapload::analysis::{
    CriticalForce, Ensemble, ExceedanceCurve, ForceScan, Uncertainty, Unfinished, no_progress,
};
use snapload::{Case, CaseError, Lanes, Outcome, Parameters, Stop, named_case};

/// Every number of an outcome is that of the full run.
#[test]
fn an_outcome_summarises_its_run() -> Result<(), CaseError> {
    for code in ["sliding-example", "rocking-example", "1910001000-359"] {
        let case = Case::new(named_case(code)?.parameters)?;
        let (outcome, run) = (Outcome::of(&case), case.run());
        assert_eq!((outcome.end, outcome.norms), (*run.end(), *run.norms()));
        let snaps: Vec<_> = run.impacts().iter().filter(|i| i.v_n > 0.0).collect();
        let by_cable =
            std::array::from_fn(|k| snaps.iter().filter(|i| i.cable == k).count() as u64);
        assert_eq!(outcome.impacts, by_cable);
        let first = snaps.first().map(|i| (i.t, i.cable, i.v_n));
        assert_eq!(outcome.first.map(|f| (f.t, f.cable, f.v_n)), first);
        for (mode, time) in [
            ("slack", outcome.slack()),
            ("sliding", outcome.sliding),
            ("rocking", outcome.rocking),
        ] {
            let of_mode = run.modes().iter().filter(|i| i.taut.mode().name() == mode);
            let sum: f64 = of_mode.map(|i| i.t_end - i.t_start).sum();
            assert!((sum - time).abs() < 1e-9, "{code}: {mode} {sum} {time}");
        }
    }
    Ok(())
}

#[test]
fn the_standard_case_exceeds_at_0_31_and_settles_at_0_4() -> Result<(), Unfinished> {
    let found = CriticalForce::scan(&Parameters::STANDARD, ForceScan::default(), &no_progress)?;
    let first = found.first.map(|first| (first.f_o, first.reason));
    assert_eq!(first, Some((0.31, Stop::RotationLimit)));
    let inside = |f_o: f64| {
        found
            .exceeding
            .iter()
            .any(|[a, b]| (*a..=*b).contains(&f_o))
    };
    assert!(inside(0.31) && inside(0.5) && !inside(0.4) && !inside(0.3));
    Ok(())
}

/// With an uncertain start some neighbours exceed below the critical force of the case itself: the
/// amplitudes at which they disagree are uncertain, and so is that force.
#[test]
fn neighbours_of_an_ensemble_decide_what_is_uncertain() -> Result<(), Unfinished> {
    let (standard, scan) = (&Parameters::STANDARD, ForceScan::new(0.01, 0.4)?);
    let mut uncertainty = Uncertainty::default();
    uncertainty.set("y", 1e-2)?;
    let curve = ExceedanceCurve::scan(standard, scan, &uncertainty, 50, 1, &no_progress)?;
    let (found, alone) = (
        curve.critical_force(),
        CriticalForce::scan(standard, scan, &no_progress)?,
    );
    assert_eq!(
        (found.first, &found.exceeding),
        (alone.first, &alone.exceeding)
    );
    for point in &curve.points {
        let disagree = point
            .share
            .is_some_and(|share| (1..50).contains(&share.count));
        let mut uncertain = found.uncertain.iter();
        let listed = uncertain.any(|[from, to]| (*from..=*to).contains(&point.f_o));
        assert!(listed || !disagree, "{}", point.f_o);
    }
    let below = |[from, _]: &[f64; 2]| found.first.is_some_and(|first| *from < first.f_o);
    assert!(found.uncertain.iter().any(below) && !found.certain);
    Ok(())
}

#[test]
fn none_may_exceed() -> Result<(), Unfinished> {
    let calm = Parameters {
        e: 0.0,
        a: 0.5,
        inertia: Some(0.25),
        ..Parameters::STANDARD
    };
    let found = CriticalForce::scan(&calm, ForceScan::new(0.01, 0.02)?, &no_progress)?;
    assert_eq!((found.first, found.exceeding), (None, vec![]));
    Ok(())
}

/// A run that stops at the impact limit leaves open whether it would have exceeded: such amplitudes
/// are listed by themselves, and nothing above or about them is certain. Some of them do exceed
/// without that limit.
#[test]
fn runs_that_are_cut_short_decide_nothing() -> Result<(), Unfinished> {
    let scan = ForceScan::new(0.01, 0.6)?;
    let whole = CriticalForce::scan(&Parameters::STANDARD, scan, &no_progress)?;
    let within = |intervals: &[[f64; 2]], f_o: f64| {
        let mut intervals = intervals.iter();
        intervals.any(|[from, to]| (*from..=*to).contains(&f_o))
    };
    for max_impacts in [5, 11] {
        let few = Parameters {
            max_impacts,
            ..Parameters::STANDARD
        };
        let found = CriticalForce::scan(&few, scan, &no_progress)?;
        assert!(!found.certain, "{max_impacts}: {found:?}");
        for f_o in scan.amplitudes() {
            let [exceeds, cut] =
                [&found.exceeding, &found.cut_short].map(|intervals| within(intervals, f_o));
            assert!(!(exceeds && cut), "{max_impacts} {f_o}");
            assert!(
                exceeds || cut || !within(&whole.exceeding, f_o),
                "{max_impacts} {f_o}"
            );
        }
    }
    assert!(whole.cut_short.is_empty());
    let few = Parameters {
        max_impacts: 5,
        ..Parameters::STANDARD
    };
    let uncertainty = Uncertainty::default();
    let curve = ExceedanceCurve::scan(&few, scan, &uncertainty, 4, 1, &no_progress)?;
    for point in &curve.points {
        let cut_short = point.end.reason.cuts_short();
        assert_eq!(point.interval() == [0.0, 1.0], cut_short, "{}", point.f_o);
    }
    Ok(())
}

/// A run that settles after 300 impacts is not cut short by a limit of 301, but most of its
/// neighbours are: it is not known how many of them exceed, and nothing is certain.
#[test]
fn neighbours_that_are_cut_short_may_exceed() -> Result<(), Unfinished> {
    let own = Parameters {
        f_o: 0.3,
        max_impacts: 301,
        ..Parameters::STANDARD
    };
    let uncertainty = Uncertainty::default();
    assert_eq!(Case::new(own)?.run().end().reason, Stop::Settled);
    let scan = ForceScan::new(0.3, 0.3)?;
    let curve = ExceedanceCurve::scan(&own, scan, &uncertainty, 50, 1, &no_progress)?;
    let [point] = curve.points[..] else {
        panic!("{curve:?}");
    };
    let members = Ensemble::about(&Case::new(own)?, &uncertainty, 50, 1);
    let ends = (0..50).map(|k| Ok(members.member(k)?.run().end().reason));
    let ends: Vec<Stop> = ends.collect::<Result<_, CaseError>>()?;
    let cut_short = ends.iter().filter(|end| end.cuts_short()).count();
    assert!(cut_short > 0 && point.members_cut_short == cut_short);
    let exceed = ends.iter().filter(|end| end.exceeds()).count();
    let [low, high] = point.interval();
    assert!(low <= exceed as f64 / 50.0);
    assert!(high >= (exceed + cut_short) as f64 / 50.0);
    let found = curve.critical_force();
    assert!(!found.certain && found.uncertain == [[0.3, 0.3]]);
    Ok(())
}

/// Only 200 members are run if they end in the same way, and all members otherwise.
#[test]
fn as_many_members_are_run_as_tell() -> Result<(), Unfinished> {
    let case = Case::new(Parameters {
        t_end: 1.0,
        ..Parameters::STANDARD
    })?;
    let alike = Ensemble::about(&case, &Uncertainty::of_start(1e-6), 1000, 1);
    let tally = alike.tally_until_clear(&no_progress)?;
    assert_eq!(tally.members(), 200);
    assert!(tally.shares()[0].1.interval()[0] < 0.97);
    let few = Ensemble::about(&case, &Uncertainty::of_start(1e-6), 100, 1);
    assert_eq!(
        few.tally_until_clear(&no_progress)?,
        few.tally(&no_progress)?
    );
    let undecided = Case::new(Parameters {
        f_o: 0.5,
        ..Parameters::STANDARD
    })?;
    let mut uncertainty = Uncertainty::default();
    uncertainty.set("e", 0.02)?;
    let uncertain = Ensemble::about(&undecided, &uncertainty, 210, 1);
    let tally = uncertain.tally(&no_progress)?;
    assert!(tally.shares().len() > 1, "one that ends in several ways");
    assert_eq!(uncertain.tally_until_clear(&no_progress)?, tally);
    Ok(())
}

#[test]
fn members_are_within_the_doubt_and_do_not_depend_on_their_number() -> Result<(), CaseError> {
    let case = Case::new(Parameters::STANDARD)?;
    let mut uncertainty = Uncertainty::default();
    uncertainty.set("f_o", 0.02)?;
    uncertainty.set("a", 0.001)?;
    let many = Ensemble::about(&case, &uncertainty, 100, 7);
    let few = Ensemble::about(&case, &uncertainty, 3, 7);
    for index in 0..100 {
        let member = *many.member(index)?.parameters();
        assert!((member.f_o - 0.3).abs() <= 0.02 && member.f_o != 0.3);
        assert_eq!(member.inertia, Some(member.a * member.a));
        assert_eq!((member.x, member.y), (0.0, 0.1));
        assert_eq!(member, *few.member(index)?.parameters());
    }
    let other = Ensemble::about(&case, &uncertainty, 100, 8);
    assert_ne!(other.member(0)?.parameters(), many.member(0)?.parameters());
    Ok(())
}

#[test]
fn an_uncertainty_without_legal_neighbours_is_named() -> Result<(), CaseError> {
    let case = Case::new(Parameters::STANDARD)?;
    let refusal = |uncertainty: &Uncertainty| {
        let ensemble = Ensemble::about(&case, uncertainty, 5, 1);
        let error = ensemble.member(0).map(|_| ()).unwrap_err();
        (error.key, error.value, error.allowed)
    };
    let (key, value, allowed) = refusal(&Uncertainty::of_start(1e9));
    assert_eq!((key.as_str(), value.as_str()), ("uncertainty", "1e9"));
    assert!(allowed.starts_with("a smaller one"), "{allowed}");
    let mut some = Uncertainty::default();
    some.set("y", 1e9)?;
    some.set("f_o", 0.5)?;
    assert_eq!(refusal(&some).1, "y=1e9, f_o=0.5");
    Ok(())
}

/// The start is on the boundary of a cable: half of the ensemble is out of reach, and is drawn
/// again.
#[test]
fn illegal_neighbours_are_drawn_again() -> Result<(), Unfinished> {
    let case = Case::new(Parameters {
        y: 0.0,
        ..Parameters::STANDARD
    })?;
    let ensemble = Ensemble::about(&case, &Uncertainty::of_start(1e-3), 50, 1);
    let tally = ensemble.tally(&no_progress)?;
    assert_eq!(tally.members(), 50);
    let total: usize = tally.shares().iter().map(|(_, share)| share.count).sum();
    assert_eq!(total, 50);
    Ok(())
}

/// Runs that rock extend their series together. Tall bodies are among them, whose cables' equations
/// are nearly the same, runs whose cables snap again in between, and those that end at different
/// times.
#[test]
fn runs_that_rock_together_have_the_bits_of_runs_by_themselves() {
    let shapes = [(0.25, 0.1), (0.03, 1.0), (0.1, 0.5)];
    let cases: Vec<Case> = (0..300_u32)
        .filter_map(|k| {
            let x = f64::from(k);
            let (a, b) = shapes[k as usize % 3];
            Case::new(Parameters {
                f_o: 0.4 * (x * 1.3).sin().abs(),
                omega: 0.4 + 2.0 * (x * 0.7).sin().abs(),
                e: [0.0, 0.3, 0.8][(k / 3) as usize % 3],
                a,
                b,
                t_end: [30.0, 45.0, 60.0][(k / 9) as usize % 3],
                stop_when_settled: false,
                ..Parameters::STANDARD
            })
            .ok()
        })
        .collect();
    let alone: Vec<Outcome> = cases.iter().map(Outcome::of).collect();
    let rocked = |shape: (f64, f64)| {
        let both = cases.iter().zip(&alone);
        let of_shape = both.filter(|(case, _)| (case.parameters().a, case.parameters().b) == shape);
        of_shape.filter(|(_, run)| run.rocking > 1.0).count()
    };
    let counts = shapes.map(rocked);
    assert!(counts.iter().all(|&count| count > 10), "{counts:?}");
    for lanes in Lanes::available() {
        let (beside, _) = lanes.outcomes(&cases);
        for (k, (beside, alone)) in beside.iter().zip(&alone).enumerate() {
            let same = format!("{beside:?}") == format!("{alone:?}");
            assert!(same, "{lanes:?}, case {k}");
        }
    }
}

/// Runs begin as others end, also where all of them rock from the start on: a study can be
/// interrupted, and its memory does not grow with the number of its cases.
#[test]
fn few_runs_are_in_progress_at_any_time() -> Result<(), CaseError> {
    let case = Case::new(Parameters {
        x: 0.0,
        y: 0.0,
        a: 0.5,
        f_o: 0.05,
        t_end: 3.0,
        stop_when_settled: false,
        ..Parameters::STANDARD
    })?;
    assert!(Outcome::of(&case).rocking > 2.0);
    for lanes in Lanes::available() {
        let [most, places] = lanes.most_at_a_time(&case, 200);
        assert!(most <= places, "{lanes:?}: {most}");
    }
    Ok(())
}
