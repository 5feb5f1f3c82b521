//! The time at which judging begins: it is within a step of the motion, and needs no waves.

use crate::verdicts::{source, structure};
use snapload::analysis::no_progress;
use snapload_structure::note::page;
use snapload_structure::{Outcome, VerdictKind, assess};
use std::f64::consts::FRAC_PI_2;

const GRAVITY: f64 = 10.0;
const DENSITY: f64 = 1000.0;
const VOLUME_M3: f64 = 140.0;
const MASS_KG: f64 = 120_000.0;
const ADDED_KG: f64 = 145_000.0;
const LENGTH_M: f64 = 6.5;
const ANCHOR_Z_M: f64 = -10.0;

/// A body held down by one line at its centre in still water: a pendulum, let go at an
/// angle from the vertical, so that
///
/// ```text
/// T = W (3 cos θ − 2 cos θ_0),    sin(θ/2) = k sin φ,    k = sin(θ_0/2),
/// t = sqrt(m L/W) (K + ∫_0^φ dψ/sqrt(1 − k² sin² ψ)),    φ from −π/2 on
/// ```
struct Pendulum {
    angle_rad: f64,
}

impl Pendulum {
    const LIFT_N: f64 = GRAVITY * (DENSITY * VOLUME_M3 - MASS_KG);

    fn k(&self) -> f64 {
        (0.5 * self.angle_rad).sin()
    }

    /// When it reaches φ, by Simpson's rule \[s\].
    fn time_s(&self, phi: f64) -> f64 {
        let panels = 2000;
        let width = (phi + FRAC_PI_2) / f64::from(panels);
        let at = |i: i32| {
            let psi = -FRAC_PI_2 + f64::from(i) * width;
            let weight = if i == 0 || i == panels {
                1.0
            } else {
                f64::from(2 + 2 * (i % 2))
            };
            weight / (1.0 - (self.k() * psi.sin()).powi(2)).sqrt()
        };
        let scale = ((MASS_KG + ADDED_KG) * LENGTH_M / Self::LIFT_N).sqrt();
        scale * width / 3.0 * (0..=panels).map(at).sum::<f64>()
    }

    /// The tension at φ \[N\].
    fn tension_n(&self, phi: f64) -> f64 {
        let cosine = 1.0 - 2.0 * (self.k() * phi.sin()).powi(2);
        Self::LIFT_N * (3.0 * cosine - 2.0 * self.angle_rad.cos())
    }

    /// The case whose run goes up to a φ and is judged from another on.
    fn case(&self, [from, to]: [f64; 2]) -> String {
        let x = LENGTH_M * self.angle_rad.sin();
        let z = ANCHOR_Z_M + LENGTH_M * self.angle_rad.cos() - 1e-12;
        format!(
            "[body]\nshape = \"circle\"\nwidth = 3\ndisplaced_volume = {VOLUME_M3}\n\
             mass = {MASS_KG}\nadded_mass = {ADDED_KG}\nmoment_of_inertia = 163000\n\
             position = [0, -3.5]\n[[line]]\nanchor = [0, {ANCHOR_Z_M}]\nfairlead = [0, -3.5]\n\
             length = {LENGTH_M}\nstiffness = 1e8\n[site]\ndepth = 10\nwater_density = {DENSITY}\n\
             gravity = {GRAVITY}\n[run]\nrestitution = 0\nstart = [{x}, {z}]\n\
             transient = {}\nduration = {}\n",
            self.time_s(from),
            self.time_s(to)
        )
    }

    fn outcome(&self, judged: [f64; 2]) -> Outcome {
        let case = structure(&self.case(judged));
        assess(case, 0, &no_progress).unwrap().outcome
    }
}

/// A step of a taut motion lasts for a large part of its period. Of one in which judging begins,
/// the tensions after that are judged, and those before it are not.
#[test]
fn only_the_judged_part_of_a_step_counts() {
    let pendulum = Pendulum { angle_rad: 0.5 };
    let near = |value: f64, known: f64| {
        assert!((value - known).abs() < 1e-5 * known, "{value} for {known}");
    };
    // The tension rises up to φ = 0 and falls from there on.
    for k in -6..=13 {
        let [from, to] = [0.1 * f64::from(k), 1.4];
        let outcome = pendulum.outcome([from, to]);
        let line = &outcome.lines[0];
        near(line.largest_taut_n, pendulum.tension_n(from.max(0.0)));
        near(line.early_n, pendulum.tension_n(from.min(0.0)));
        near(line.least_n.unwrap(), pendulum.tension_n(to));
        // Up to the lowest point the least tension is that at the beginning.
        let line = &pendulum.outcome([from.min(-0.1), 0.0]).lines[0];
        near(line.least_n.unwrap(), pendulum.tension_n(from.min(-0.1)));
    }
}

/// What is said of a run that begins with waves is not said in still water, which waves of no
/// height are, too: they do not begin, and there are no neighbours in them.
#[test]
fn still_water_has_no_waves_that_begin() {
    let pendulum = Pendulum { angle_rad: 0.5 };
    let still = pendulum
        .case([1.0, 1.4])
        .replace("stiffness", "breaking_load = 2.2e5\nstiffness");
    for waves in ["", "[wave]\nheight = 0\nperiod = 4\n"] {
        let text = format!("{still}{waves}");
        let assessment = assess(structure(&text), 12, &no_progress).unwrap();
        // The largest tension is that of φ = 0, before it is judged.
        let most = pendulum.tension_n(0.0) / 2.2e5;
        assert!(most > 1.0 && pendulum.tension_n(1.0) < 2.2e5);
        let verdict = assessment.verdict();
        assert_eq!(verdict.standing, VerdictKind::Open);
        for words in ["s are not judged. In them line 1", "run.transient = 0"] {
            assert!(verdict.words.contains(words), "{}", verdict.words);
        }
        let note = page(source("case"), &assessment, None).unwrap();
        for words in [assessment.summary("case"), note] {
            assert!(!words.contains("waves begin") && !words.contains("neighbours in waves"));
            assert!(!words.contains("snapload seas") && !words.contains("period of the waves"));
        }
    }
}
