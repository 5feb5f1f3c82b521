//! A study of one's own: how many of the force amplitudes up to 0.6 turn the body over, against
//! restitution.

use snapload::analysis::{Unfinished, no_progress, outcomes};
use snapload::{Case, Parameters};

fn main() -> Result<(), Unfinished> {
    let amplitudes: Vec<f64> = (1..=60).map(|k| f64::from(k) / 100.0).collect();
    let mut fractions = Vec::new();
    for e in [0.6, 0.7, 0.8, 0.9, 1.0] {
        let case = |f_o: &f64| {
            Case::new(Parameters {
                f_o: *f_o,
                e,
                ..Parameters::STANDARD
            })
        };
        let cases: Vec<Case> = amplitudes.iter().map(case).collect::<Result<_, _>>()?;
        // On all threads, and side by side in the lanes of the processor; nobody watches, and
        // nobody cancels.
        let outcomes = outcomes(&cases, &no_progress)?;
        let over = outcomes.iter().filter(|run| run.exceeds()).count();
        println!("e = {e}: {over} of {} exceed a limit", cases.len());
        fractions.push(over);
    }
    // A case that is run by itself comes to the same.
    let alone = Case::new(Parameters {
        f_o: 0.31,
        ..Parameters::STANDARD
    })?;
    assert!(alone.run().end().reason.exceeds());
    assert!(fractions.iter().any(|over| *over > 0));
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
