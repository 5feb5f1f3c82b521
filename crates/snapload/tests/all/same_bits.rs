//! The same case gives the same bits, whichever other cases are computed with it and on however
//! many threads.

use snapload::analysis::{
    Cancelled, Certainty, Counter, CriticalForce, Ensemble, ExceedanceCurve, ForceScan, OnProgress,
    Progress, Uncertainty, Unfinished, no_progress, outcome, outcomes, record, trusted_run,
};
use snapload::{
    Case, CaseError, Lanes, Outcome, Parameters, Playback, Simulation, TautSet, Trajectory, Value,
    named_case,
};
use std::ops::ControlFlow::{Break, Continue};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// A number that changes with any bit of any impact (FNV-1a over the bits of t, v_n and the state
/// after).
fn fingerprint(mut simulation: Simulation) -> (u64, u64) {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    while let Some(step) = simulation.step() {
        for impact in step.impacts() {
            let state = impact.after.components();
            for number in [impact.t, impact.v_n].into_iter().chain(state) {
                for byte in number.to_bits().to_le_bytes() {
                    hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
                }
            }
        }
    }
    (simulation.time().to_bits(), hash)
}

/// Time of the end and fingerprint of named cases: what every machine must compute.
///
/// They may change only where arithmetic is changed on purpose, and then the change log says so: in
/// a chaotic motion another last bit leads to another motion. If the test fails, it prints the new
/// values.
const HELD: [(&str, u64, u64); 5] = [
    (
        "1910001000-359",
        0x401c_fc34_0260_6de4,
        0x18bd_aa8b_95d7_7a5f,
    ),
    (
        "2911001000-359",
        0x4034_a940_4662_daad,
        0x97b4_ade0_2bb8_a935,
    ),
    (
        "1510001000-359",
        0x3fec_c832_c994_2c9f,
        0x4dbc_a77d_b0f5_4b8b,
    ),
    (
        "1922001000-359",
        0x4027_b4d2_020a_ae1d,
        0x4346_58f7_318a_b11b,
    ),
    (
        "1930001000-359",
        0x4037_ae2f_7895_8889,
        0xb70b_4355_f0b2_3198,
    ),
];

#[test]
fn named_cases_have_the_bits_they_had() {
    let found = HELD.map(|(code, ..)| {
        let named = named_case(code).expect("a named case");
        let case = Parameters::from_entries(named.entries()).and_then(Case::new);
        let (t, hash) = fingerprint(case.expect("a legal case").simulation());
        (code, t, hash)
    });
    let listed: String = found
        .iter()
        .map(|(code, t, hash)| format!("    (\"{code}\", {t:#018x}, {hash:#018x}),\n"))
        .collect();
    assert_eq!(found, HELD, "found\n{listed}");
}

/// Several hundred cases of all kinds: shapes, restitutions, forces, stops, point masses, starts at
/// speed.
fn varied() -> Vec<Case> {
    let cases = (0..600_u32).filter_map(|k| {
        let x = f64::from(k);
        let wild = |factor: f64| (x * factor).sin();
        let standard = Parameters::STANDARD;
        let mut p = Parameters {
            f_o: 0.5 * wild(1.3).abs(),
            nu: wild(0.7),
            omega: [0.9, 0.0, 2.0, 14.0, 1.1][k as usize % 5],
            e: [0.9, 0.5, 0.97, 0.0, 0.8, 1.0][k as usize % 6],
            a: 0.3 * wild(2.1).abs(),
            b: [0.0, 0.1, 0.2][k as usize % 3],
            r: 1.5 + 0.5 * wild(0.9).abs(),
            inertia: Some(0.01 + 0.05 * wild(0.5).abs()),
            x: 0.1 * wild(3.1),
            y: 0.2 + 0.1 * wild(1.9),
            theta: 0.3 * wild(2.7),
            vx: 0.5 * wild(0.4),
            vtheta: 2.0 * wild(4.4),
            t_end: [0.7, 5.0, 12.0, 40.0][k as usize % 4],
            stop_when_settled: k % 7 != 0,
            stop_when_sliding: k % 11 == 0,
            max_impacts: if k % 13 == 0 { 40 } else { 5000 },
            ..standard
        };
        if k % 9 == 0 {
            let entries = [
                ("body", Value::Text("point".into())),
                ("f_o", Value::Number(p.f_o)),
            ];
            p = Parameters::from_entries(entries).ok()?;
        }
        if k % 4 == 0 {
            p = Parameters {
                f_o: 0.001 * x,
                ..standard
            };
        }
        Case::new(p).ok()
    });
    cases.collect()
}

/// All bits of an outcome, so that −0 and 0 differ.
fn bits(outcome: &Outcome) -> Vec<u64> {
    let (end, norms) = (&outcome.end, &outcome.norms);
    let limit = end.t_limit.map_or(0, f64::to_bits);
    let numbers = [
        norms.rho1,
        norms.rho2,
        norms.rho3,
        norms.y_max,
        norms.theta_max,
        end.t,
        outcome.sliding,
        outcome.rocking,
    ];
    let first = outcome.first.map_or([0.0; 2], |first| [first.t, first.v_n]);
    let numbers = numbers
        .into_iter()
        .chain(first)
        .chain(end.state.components());
    numbers
        .map(f64::to_bits)
        .chain(outcome.impacts)
        .chain([limit, end.reason as u64])
        .collect()
}

#[test]
fn every_width_of_lanes_has_the_bits_of_one_run_by_itself() {
    let cases = varied();
    assert!(cases.len() > 400, "{}", cases.len());
    let alone: Vec<Outcome> = cases.iter().map(Outcome::of).collect();
    for lanes in Lanes::available() {
        let (beside, usage) = lanes.outcomes(&cases);
        assert_eq!(beside.len(), alone.len());
        for (k, (beside, alone)) in beside.iter().zip(&alone).enumerate() {
            assert_eq!(bits(beside), bits(alone), "{lanes:?}, case {k}");
        }
        assert!(usage.bounces > 20_000, "{lanes:?}: {usage:?}");
    }
    assert_eq!(outcomes(&cases, &no_progress), Ok(alone));
}

#[test]
fn threads_do_not_matter() {
    let cases: Vec<Case> = (0..3).flat_map(|_| varied()).collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("threads");
        pool.install(|| outcomes(&cases, &no_progress).expect("nobody cancels"))
    };
    let one: Vec<_> = on(1).iter().map(bits).collect();
    for threads in [2, 5] {
        assert_eq!(on(threads).iter().map(bits).collect::<Vec<_>>(), one);
    }
}

/// Trust is computed in lanes, too: the horizons are those of runs followed one by one, and the
/// outcomes are those of runs whose trust is not computed.
#[test]
fn trust_in_lanes_is_that_of_one_run_by_itself() {
    let cases = varied();
    let counter = Counter::new("running", 0, 0, &no_progress);
    let alone: Vec<Certainty> = cases.iter().map(Certainty::of).collect();
    let certain = alone.iter().filter(|one| one.decides_the_end()).count();
    assert!(certain > 100 && alone.len() - certain > 100, "{certain}");
    for lanes in Lanes::available() {
        let together = Certainty::with_outcomes(lanes, cases.iter().cloned(), &counter)
            .expect("not cancelled");
        let (outcomes, certainties): (Vec<_>, Vec<_>) = together.into_iter().unzip();
        assert_eq!(certainties, alone, "{lanes:?}");
        assert_eq!(outcomes, lanes.outcomes(&cases).0, "{lanes:?}");
    }
}

#[test]
fn few_cases_fill_no_lanes() {
    let cases = varied();
    for count in [0, 1, 3, 9] {
        for lanes in Lanes::available() {
            let (outcomes, _) = lanes.outcomes(&cases[..count]);
            let alone: Vec<Outcome> = cases[..count].iter().map(Outcome::of).collect();
            assert_eq!(outcomes, alone);
        }
    }
}

/// A lane whose run has stopped takes the next run at once: hardly any of the places for bounces
/// stay empty.
#[test]
fn lanes_are_kept_full() {
    let cases: Vec<Case> = (0..1000)
        .map(|k| {
            let f_o = 0.01 + 0.3 * f64::from(k) / 999.0;
            Case::new(Parameters {
                f_o,
                ..Parameters::STANDARD
            })
        })
        .collect::<Result<_, _>>()
        .expect("legal");
    for lanes in Lanes::available() {
        let usage = lanes.outcomes(&cases).1;
        let used = usage.bounces as f64 / (usage.rounds * usage.width as u64) as f64;
        assert!(used > 0.9, "{lanes:?}: {used}");
    }
}

/// Runs that stop before their first flight take no lane, however many there are of them.
#[test]
fn runs_that_stop_at_once_are_no_burden() {
    let case = Case::new(Parameters {
        t_end: 1e-6,
        ..Parameters::STANDARD
    });
    let cases = vec![case.expect("legal"); 50_000];
    let (outcomes, usage) = Lanes::best().outcomes(&cases);
    assert_eq!((outcomes.len(), usage.bounces), (50_000, 0));
}

/// Cancellable work gives the same result if it is not cancelled, and none if it is.
#[test]
fn work_that_may_be_ended_is_the_same_or_nothing() -> Result<(), Unfinished> {
    let case = Case::new(named_case("1910001000-459")?.parameters)?;
    let run = case.run();
    let whole = Trajectory::record_while(case.simulation(), |_, _| Continue(()));
    let whole = whole.expect("a run that was not ended");
    assert_eq!((whole.impacts(), whole.end()), (run.impacts(), run.end()));
    let whole = record(case.simulation(), &no_progress, |_, _| {})?;
    assert_eq!((whole.impacts(), whole.end()), (run.impacts(), run.end()));
    assert_eq!(outcome(&case, &no_progress), Ok(Outcome::of(&case)));
    let ensemble = Ensemble::about(&case, &Uncertainty::default(), 20, 1);
    assert_eq!(ensemble.tally(&no_progress)?.members(), 20);

    let half = run.end().t / 2.0;
    let until = |t: f64| if t < half { Continue(()) } else { Break(()) };
    let mut reached = 0.0;
    let ended = Trajectory::record_while(case.simulation(), |simulation, _| {
        assert!(reached < half, "went on after it was ended");
        reached = simulation.time();
        until(reached)
    });
    assert!(ended.is_none() && reached >= half);
    assert_eq!(
        Outcome::of_while(&case, |simulation| until(simulation.time())),
        None
    );
    let members = AtomicU64::new(0);
    let tally = ensemble.tally(&|progress: Progress| {
        assert_eq!((progress.doing, progress.of), ("neighbours", 20.0));
        match members.fetch_add(1, Ordering::Relaxed) {
            0..5 => Continue(()),
            _ => Break(()),
        }
    });
    assert!(matches!(tally, Err(Unfinished::Cancelled(_))));
    Ok(())
}

/// All long work reports its progress, which only grows, and ends when it is cancelled.
#[test]
fn all_long_work_reports_progress_and_can_be_cancelled() -> Result<(), Unfinished> {
    let long = Parameters {
        f_o: 0.1,
        t_end: 60.0,
        stop_when_settled: false,
        ..Parameters::STANDARD
    };
    let case = Case::new(long)?;
    let exact = Uncertainty::default();
    let scan = ForceScan::new(0.1, 0.3)?;
    type Work<'a> = &'a dyn Fn(OnProgress) -> Result<(), Unfinished>;
    let works: [(&str, Work); 5] = [
        ("outcome", &|on| Ok(outcome(&case, on).map(drop)?)),
        ("outcomes", &|on| {
            Ok(outcomes(&vec![case.clone(); 3], on).map(drop)?)
        }),
        ("trusted_run", &|on| {
            trusted_run(&case, &exact, on).map(drop)
        }),
        ("critical", &|on| {
            CriticalForce::scan(&long, scan, on).map(drop)
        }),
        ("exceedance", &|on| {
            ExceedanceCurve::scan(&long, scan, &exact, 3, 1, on).map(drop)
        }),
    ];
    for (name, work) in works {
        let reports = Mutex::new(Vec::new());
        work(&|progress: Progress| {
            assert!((0.0..=progress.of).contains(&progress.done), "{name}");
            let mut reports = reports.lock().expect("no panic");
            reports.push((progress.doing.to_owned(), progress.done));
            Continue(())
        })?;
        let reports = reports.into_inner().expect("no panic");
        assert!(!reports.is_empty(), "{name} reports nothing");
        let grows = |pair: &[(String, f64)]| pair[0].0 != pair[1].0 || pair[0].1 <= pair[1].1;
        assert!(reports.windows(2).all(grows), "{name}: {reports:?}");
        let cancelled = work(&|_: Progress| Break(()));
        assert!(
            matches!(cancelled, Err(Unfinished::Cancelled(Cancelled { .. }))),
            "{name}"
        );
    }
    Ok(())
}

/// The same case gives the same bits, whether or not its motion is sampled on the way.
#[test]
fn nothing_depends_on_sampling() {
    for f_o in [0.1, 0.27, 0.3, 0.5] {
        let p = Parameters {
            f_o,
            stop_when_settled: false,
            t_end: 15.0,
            ..Parameters::STANDARD
        };
        let case = Case::new(p).expect("legal");
        let first = case.run();
        for k in 0..1000 {
            first.at(f64::from(k) * 0.015);
        }
        let second = case.run();
        assert_eq!(first.impacts(), second.impacts());
        assert_eq!(first.end(), second.end());
        assert_eq!(first.norms(), second.norms());
        let mut stepped = case.simulation();
        while stepped.step().is_some() {}
        assert_eq!(*stepped.state(), first.end().state);
        assert_eq!(
            stepped.taut() == TautSet::SLACK,
            first.modes().last().is_some_and(|m| m.taut.is_empty())
        );
    }
}

/// Expansions that were not kept are computed again with the same bits, in whatever order times are
/// asked for.
#[test]
fn a_motion_is_the_same_however_little_of_it_is_kept() -> Result<(), CaseError> {
    let long = Parameters {
        stop_when_settled: false,
        omega: 30.0,
        t_end: 40.0,
        ..Parameters::STANDARD
    };
    let cases = ["sliding-example", "rocking-example"].map(named_case);
    let [sliding, rocking] = cases;
    for parameters in [sliding?.parameters, rocking?.parameters, long] {
        let run = Case::new(parameters)?.run();
        let starts = run.clone().keep_links(usize::MAX);
        for most in [0, 1, 7] {
            let mut thin = run.clone();
            let (kept, all) = (thin.keep_links(most).len(), starts.len());
            assert!(kept + 20 < all, "{kept} of {all}");
            let (mut whole, mut playback) = (Playback::new(&run), Playback::new(&thin));
            let mut times: Vec<f64> = starts.iter().copied().step_by(5).collect();
            times.extend((0..50).map(|k| run.end().t * f64::from(k * 37 % 50) / 49.0));
            times.extend([-1.0, f64::INFINITY]);
            for t in times {
                assert_eq!(playback.at(t), whole.at(t), "{t} with {most}");
            }
        }
    }
    Ok(())
}

/// Products and sums fused by an instruction or by a function: flights, impacts, sliding and
/// rocking have the same bits.
#[test]
fn both_compilations_give_the_same_bits() {
    let mut modes = [0; 3];
    for f_o in [0.1, 0.27, 0.3] {
        let case = Case::new(Parameters {
            f_o,
            t_end: 12.0,
            stop_when_settled: false,
            ..Parameters::STANDARD
        });
        let mut fused = case.expect("a legal case").simulation();
        let mut plain = fused.clone();
        let bits = |simulation: &Simulation| simulation.state().components().map(f64::to_bits);
        while let Some(step) = fused.step() {
            modes[step.taut.len()] += 1;
            assert!(plain.step_plain().is_some());
            assert_eq!(fused.time().to_bits(), plain.time().to_bits());
            assert_eq!(bits(&fused), bits(&plain));
        }
        assert_eq!(fused.stop(), plain.stop());
    }
    assert!(modes.iter().all(|steps| *steps > 0), "{modes:?}");
}
