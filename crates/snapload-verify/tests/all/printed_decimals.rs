//! What `verify` prints of a run with many digits is right in every decimal: the same run with
//! twice or four times the digits is exact beside it.

use crate::calibration::random_case;
use crate::common::exact;
use rayon::prelude::*;
use snapload::analysis::{Unfinished, no_progress};
use snapload::{
    CASE, Case, CaseError, Entries, Parameters, Precise, Real, Stop, Value, named_case,
};
use snapload_verify::{Verification, verify, verify_as_written};

/// Half a unit of the last place is the rounding of the printed number; the rest is for the errors
/// that the reserve of two digits leaves.
const MOST_UNITS: f64 = 0.75;

fn found(case: &Case, digits: u32) -> Verification {
    verify(case, digits, 1e-3, &no_progress).expect("a legal start")
}

fn case(parameters: Parameters) -> Case {
    Case::new(parameters).expect("a legal case")
}

fn point() -> Parameters {
    let entries = [("body", Value::from("point"))];
    Parameters::from_entries(entries).expect("a legal case")
}

fn decimals(text: &str) -> usize {
    text.split_once('.').map_or(0, |(_, places)| places.len())
}

/// The error of a printed number in units of its last place.
fn units(printed: &str, right: &str) -> f64 {
    let unit = exact::<16>(&format!("1e-{}", decimals(printed)));
    let error = exact::<16>(printed) - exact::<16>(right);
    (error / unit).to_f64().abs()
}

/// The largest error of all that is printed, in units of the last place, by a run with more digits.
fn worst(few: &Verification, many: &Verification) -> f64 {
    assert!(few.impacts.len() <= many.impacts.len());
    let mut pairs = Vec::new();
    for (few, many) in few.impacts.iter().zip(&many.impacts) {
        assert_eq!(few.cable, many.cable);
        pairs.push((&few.t, &many.t));
        pairs.push((&few.v_n, &many.v_n));
        pairs.push((&few.impulse, &many.impulse));
    }
    if let Some(t) = &few.t {
        let right = many.t.as_ref().expect("more digits know more");
        assert_eq!((few.end, few.impacts.len()), (many.end, many.impacts.len()));
        pairs.push((t, right));
    }
    assert!(pairs.iter().all(|(few, _)| decimals(few) > 0));
    let errors = pairs.iter().map(|(few, many)| units(few, many));
    errors.fold(0.0, f64::max)
}

fn decimals_are_right(case: &Case, digits: u32) -> Verification {
    let (few, many) = (found(case, 60), found(case, digits));
    let worst = worst(&few, &many);
    assert!(worst < MOST_UNITS, "{worst}: {:?}", case.parameters());
    few
}

/// Also where the comparison ends in taut motion, which goes on in the ordinary run.
#[test]
fn printed_decimals_are_right() {
    let rocking = named_case("rocking-example").expect("a built-in case");
    for parameters in [Parameters::STANDARD, rocking.parameters] {
        let few = decimals_are_right(&case(parameters), 150);
        // What is reported to be left is what is printed, with two digits in reserve.
        let last = decimals(few.t.as_ref().expect("digits for all of it"));
        let printed = few.impacts.iter().map(|impact| decimals(&impact.t));
        assert!(printed.min() >= Some(30) && last >= 30);
        let reserve = few.digits_left - last as f64;
        assert!((2.0..4.0).contains(&reserve), "{reserve}");
    }
}

#[test]
fn printed_decimals_are_right_in_cases_of_every_kind() {
    (0..16).into_par_iter().for_each(|index| {
        let max_impacts = 40;
        let short = Parameters {
            max_impacts,
            ..*random_case(index).parameters()
        };
        decimals_are_right(&case(short), 150);
    });
}

#[test]
#[ignore = "takes minutes"]
fn large_sample() {
    (0..240).into_par_iter().for_each(|index| {
        let short = Parameters {
            max_impacts: 250,
            ..*random_case(index).parameters()
        };
        decimals_are_right(&case(short), 150);
    });
}

/// Digits in front of the point are not decimals, and a speed is known worse than the state where
/// it is the difference of large ones.
#[test]
fn decimals_of_large_numbers_are_right() {
    let long = Parameters {
        r: 1000.0,
        e: 1.0,
        f_o: 0.0,
        y: 900.0,
        t_end: 1e5,
        max_impacts: 40,
        ..point()
    };
    let fast = Parameters {
        r: 1000.0,
        a: 900.0,
        b: 1000.0,
        inertia: Some(1e6),
        f_o: 0.0,
        y: 100.0,
        theta: 0.001,
        vtheta: 900.0,
        t_end: 1e5,
        max_impacts: 40,
        ..Parameters::STANDARD
    };
    for parameters in [long, fast] {
        let few = decimals_are_right(&case(parameters), 300);
        assert!(few.impacts.len() >= 3 && few.digits_left > 70.0);
    }
}

/// Neither impacts nor an end are stated that the digits do not reach; more digits do.
#[test]
fn what_is_lost_is_not_printed() {
    let waves = Parameters {
        e: 0.593,
        f_o: 10.68,
        nu: 0.95,
        omega: 110.7,
        y: 0.223,
        theta: 0.01,
        max_impacts: 400,
        ..Parameters::STANDARD
    };
    let (few, many) = (found(&case(waves), 60), found(&case(waves), 150));
    assert_eq!((few.end, &few.t, few.digits_left), (None, &None, 0.0));
    assert!((100..many.impacts.len()).contains(&few.impacts.len()));
    assert!(worst(&few, &many) < MOST_UNITS);
    assert!(few.differences.len() <= few.impacts.len());
    // Where the ordinary run is wrong is decided long before.
    assert!(few.first_wrong.is_some() && few.first_wrong == many.first_wrong);
    assert_eq!(many.end, Some(Stop::Settled));
}

/// Before impacts accumulate, errors of 76 digits decide the order of the cables although the time
/// is still known: there the speed can no longer be told from zero.
#[test]
fn no_impact_is_printed_that_may_not_occur() {
    let parameters = Parameters {
        max_impacts: 400,
        ..*random_case(266).parameters()
    };
    let few = decimals_are_right(&case(parameters), 150);
    assert!(few.t.is_none() && few.impacts.len() > 300);
}

/// A body that hardly reaches the upper bound, half a unit above it: the time is v - √(v² - 1). It
/// changes with the height of the start by 1/√(v² - 1), which is 7·10⁵, and so loses six digits.
#[test]
fn digits_that_are_lost_after_the_last_impact_count() {
    let thrown = Parameters {
        r: 1.25,
        f_o: 0.0,
        y: 0.25,
        vy: 1.000000000001,
        ..point()
    };
    let few = decimals_are_right(&case(thrown), 300);
    assert_eq!((few.end, few.impacts.len()), (Some(Stop::UpperBound), 0));
    let v = Precise::<16>::from_decimal(thrown.vy);
    let t = v - (v * v - 1.0).sqrt();
    let stated = few.t.expect("digits for all of it");
    assert!(units(&stated, &t.to_decimals(300)) < MOST_UNITS);
    let lost = 76.0 - few.digits_left;
    assert!((5.0..8.0).contains(&lost), "{lost}");
}

/// The run of keys that are given as text.
fn written(settings: &[&str]) -> Result<Verification, CaseError> {
    let mut entries = Entries::new(&CASE);
    settings.iter().try_for_each(|text| entries.set(text))?;
    let case = Case::from_entries(entries.values("case"))?;
    verify_as_written(&case, &entries, 60, 1e-3, &no_progress).map_err(|why| match why {
        Unfinished::Case(error) => error,
        Unfinished::Cancelled(_) => unreachable!("nothing cancels it"),
    })
}

/// A body that is thrown up reaches the upper bound after v - √(v² - 1): with all the digits of v,
/// of which a double keeps 17.
#[test]
fn numbers_count_as_they_were_written() -> Result<(), CaseError> {
    let v = "1.25000000000000000000000000000123456789";
    let vy = format!("vy={v}");
    let thrown = written(&["body=point", "r=1.25", "f_o=0", "y=0.25", &vy])?;
    assert_eq!(thrown.end, Some(Stop::UpperBound));
    let v = exact::<16>(v);
    let t = (v - (v * v - 1.0).sqrt()).to_decimals(300);
    let stated = thrown.t.expect("digits for all of it");
    assert!(units(&stated, &t) < MOST_UNITS, "{stated}");
    Ok(())
}

/// Without a wave the body comes unturned to the first impact, whatever its inertia I, and 1/S is
/// linear in 1/I for the impulse S. A written I counts even where its double is that of the size.
#[test]
fn a_written_inertia_does_not_follow_the_size() -> Result<(), CaseError> {
    let impulse = |inertia: &str| -> Result<_, CaseError> {
        let found = written(&[
            "f_o=0",
            "x=0.1",
            "max_impacts=1",
            &format!("inertia={inertia}"),
        ])?;
        Ok(found.impacts[0].impulse.clone())
    };
    let natural = "0.010000000000000002";
    assert_eq!(natural.parse(), Ok(0.1 * 0.1));
    let inverse = |text: &str| Precise::ONE / exact::<16>(text);
    let [low, high] = [impulse("0.005")?, impulse("0.02")?].map(|text| inverse(&text));
    let part = (inverse(natural) - inverse("0.02")) / (inverse("0.005") - inverse("0.02"));
    let right = Precise::ONE / (high + (low - high) * part);
    assert!(units(&impulse(natural)?, &right.to_decimals(300)) < 10.0);
    Ok(())
}

#[test]
fn a_number_that_is_too_long_is_refused() {
    let text = format!("0.3{}", "0".repeat(400));
    let refused = written(&[&format!("f_o={text}")]).expect_err("too long");
    let words = refused.to_string();
    assert!(
        words.contains("a decimal of at most 399 characters"),
        "{words}"
    );
}

/// Without force and restitution the start of the neighbour differs: its numbers, too, have 76
/// digits only.
#[test]
fn digits_are_measured_without_force_and_restitution() {
    let falling = Parameters {
        e: 0.0,
        f_o: 0.0,
        x: 0.1,
        y: 0.5,
        ..Parameters::STANDARD
    };
    let few = decimals_are_right(&case(falling), 300);
    assert_eq!(few.impacts.len(), 1);
    assert!(
        (70.0..76.0).contains(&few.digits_left),
        "{}",
        few.digits_left
    );
}

/// Both cables of a symmetric motion snap at one instant, with any number of digits.
#[test]
fn a_symmetric_motion_keeps_its_digits() {
    let symmetric = Parameters {
        f_o: 0.0,
        max_impacts: 60,
        ..Parameters::STANDARD
    };
    let few = decimals_are_right(&case(symmetric), 150);
    assert!(few.digits_left > 70.0 && few.impacts.len() > 50);
}
