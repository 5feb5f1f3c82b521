//! The answers in a few lines of text, each with a label.

use super::{Floating, Report, UNDAMPED};
use crate::coefficients::FREEDOMS;
use crate::digits::kilo;
use crate::linear::{Mode, Natural, Peak};
use crate::memory::{BlockQuality, EntryQuality};
use std::f64::consts::PI;

/// A body counts as balanced if it floats within this many metres of its position in the file.
const BALANCED: f64 = 0.01;

impl Report {
    /// Labels with their words, the most important first.
    pub fn summary(&self) -> Vec<(String, String)> {
        let mut rows = Vec::new();
        let mut say = |label: &str, words: String| rows.push((label.to_owned(), words));
        let hydro = &self.reading.hydro;
        let [low, high] = hydro.range_rad_s();
        let depth = match hydro.water.depth_m.is_finite() {
            true => format!("{} m deep", hydro.water.depth_m),
            false => "deep".to_owned(),
        };
        say(
            "file",
            format!(
                "{}, {} frequencies from {low:.3} to {high:.3} rad/s, {} direction{}; water of {} \
                 kg/m³, {depth}; reference point ({}, {}) m",
                self.reading.format,
                hydro.omega_rad_s.len(),
                hydro.excitation.len(),
                if hydro.excitation.len() == 1 { "" } else { "s" },
                hydro.water.density_kg_m3,
                hydro.reference_m[0],
                hydro.reference_m[1],
            ),
        );
        say("memory", self.memory_words());
        match &self.floating {
            Ok(floating) => floating.say(&mut say),
            Err(error) => say("omitted", format!("periods and response: {error}")),
        }
        for warning in &self.warnings {
            say("warning", format!("{}: {}", warning.what, warning.words));
        }
        rows
    }

    /// How the memory was made and how well it fits.
    pub fn memory_words(&self) -> String {
        let fit = &self.fit;
        let worst =
            |of: fn(&EntryQuality) -> f64| 100.0 * fit.entries.iter().map(of).fold(0.0, f64::max);
        let furthest = EntryQuality::worst(&fit.entries).map_or(String::new(), EntryQuality::name);
        if fit.memory.terms.is_empty() {
            return "none, as the body makes no waves".to_owned();
        }
        let how = match fit.blocks.as_slice() {
            [] => "given".to_owned(),
            blocks => {
                let block = |block: &BlockQuality| {
                    let names = block.freedoms.iter().map(|i| FREEDOMS[*i]);
                    let names = names.collect::<Vec<_>>().join(" and ");
                    format!("{} pairs of poles for {names}", block.pairs)
                };
                blocks.iter().map(block).collect::<Vec<_>>().join(", ")
            }
        };
        let damped = fit.blocks.iter().any(|block| block.damped);
        format!(
            "{how}, {} states; differs from the file by at most {:.2} % (root mean square; {furthest}), from K(t) \
             by at most {:.2} % (root mean square) and at no instant by more than {:.1} % of its largest value; {}",
            fit.memory.states(),
            worst(|entry| entry.rms),
            worst(|entry| entry.kernel_rms),
            worst(|entry| entry.worst_kernel),
            if damped { "damping added" } else { "passive" },
        )
    }
}

impl Floating {
    /// The responses to waves from either side.
    fn say_responses(&self, say: &mut impl FnMut(&str, String)) {
        // A mirror-symmetric body responds alike to waves from either side.
        let mut told: Vec<(String, Vec<&str>)> = Vec::new();
        for (index, [response, _]) in self.responses.iter().enumerate() {
            let to = if response.direction > 0.0 {
                "+x"
            } else {
                "−x"
            };
            let words = largest(&self.largest(index));
            match told.iter_mut().find(|(known, _)| *known == words) {
                Some((_, directions)) => directions.push(to),
                None => told.push((words, vec![to])),
            }
        }
        for (words, directions) in told {
            let to = directions.join(" and ");
            say("response", format!("waves to {to}, largest: {words}"));
        }
    }

    /// The rest of weight, buoyancy and constant forces at the file's position, in words.
    fn balance_words(&self) -> Option<String> {
        let body = &self.body;
        let lift = body.constant_force[1];
        let lift = (lift.abs() > BALANCED * body.stiffness[(1, 1)].abs()).then(|| {
            let way = if lift > 0.0 { "lift" } else { "weight" };
            format!("{} kN of {way}", kilo(&lift.abs(), 1))
        });
        let size = body.constant_force[2].abs();
        let moment = self.unbalanced_pitch();
        let moment = moment.map(|_| format!("a moment of {} kN m", kilo(&size, 1)));
        let pitches = ", and their fairleads decide the pitch";
        let (left, pitches) = match (lift, moment) {
            (Some(lift), Some(moment)) => (format!("{lift} and {moment} are"), pitches),
            (Some(lift), None) => (format!("{lift} are"), pitches),
            (None, Some(moment)) => (format!("{moment} is"), ""),
            (None, None) => return None,
        };
        Some(format!(
            "{left} not balanced: lines must hold the body{pitches}; periods and responses are those of a \
             body held upright at the reference point"
        ))
    }

    fn say(&self, say: &mut impl FnMut(&str, String)) {
        let body = &self.body;
        say(
            "body",
            format!(
                "{} t, centre of gravity ({}, {}) m, moment of inertia {} t m² about it; stiffness {} kN/m in \
                 heave, {} kN m in pitch about the reference point",
                kilo(&body.mass_kg, 4),
                body.centre_m[0],
                body.centre_m[1],
                kilo(&body.inertia_about_centre_kg_m2(), 4),
                kilo(&body.stiffness[(1, 1)], 4),
                kilo(&body.stiffness[(2, 2)], 4),
            ),
        );
        if let Some(words) = self.balance_words() {
            say("balance", words);
        }
        say("periods", periods_in_words(&self.natural, &self.modes));
        self.say_responses(say);
        if let Some((rest, natural, modes)) = &self.rest {
            let tensions = rest.tension_n.iter().map(|t| kilo(t, 2));
            let words = format!(
                "surge {:.4} m, heave {:.4} m, pitch {:.3}°; tensions {} kN",
                plain(rest.q[0], 1e-4),
                plain(rest.q[1], 1e-4),
                plain(rest.q[2].to_degrees(), 1e-3),
                tensions.collect::<Vec<_>>().join(", "),
            );
            say("rest", words);
            if !natural.is_empty() {
                say("held", periods_in_words(natural, modes));
            }
        }
    }
}

/// Replaces a value below half a unit of the last printed place by zero, so that no "-0" is
/// printed.
pub(super) fn plain(value: f64, unit: f64) -> f64 {
    if value.abs() < 0.5 * unit { 0.0 } else { value }
}

/// The largest response of each degree of freedom, and its frequency; for narrow peaks the damping
/// on which they depend.
fn largest(peaks: &[(Peak, Option<f64>); 3]) -> String {
    let period = |peak: &Peak| 2.0 * PI / peak.omega_rad_s;
    let of = |i: usize| {
        let peak = &peaks[i].0;
        let (size, unit) = match i {
            2 => (peak.amplitude.to_degrees(), "°/m"),
            _ => (peak.amplitude, "m/m"),
        };
        let size = match size.is_finite() {
            true => format!("{} {unit}", three_digits(size)),
            false => "unbounded (no damping)".to_owned(),
        };
        format!("{} {size} at {:.2} s", FREEDOMS[i], period(peak))
    };
    let mut words = (0..3).map(of).collect::<Vec<_>>().join(", ");
    let narrow = (0..3).filter_map(|i| Some((i, peaks[i].1?)));
    let narrow: Vec<(usize, f64)> = narrow.collect();
    if let Some((_, ratio)) = narrow.iter().find(|(_, ratio)| *ratio > UNDAMPED) {
        let names: Vec<&str> = narrow.iter().map(|(i, _)| FREEDOMS[*i]).collect();
        words += &format!(
            ". The peak of {} is so narrow that it is only as accurate as the damping, {:.2} % of critical",
            names.join(" and "),
            100.0 * ratio
        );
    }
    words
}

/// A positive number with three digits, which is its accuracy.
fn three_digits(value: f64) -> String {
    let before = value.max(1e-9).log10().floor() as i32;
    format!("{value:.*}", (2 - before).clamp(0, 9) as usize)
}

/// Natural periods with their damping, in words.
pub fn periods_in_words(natural: &[Natural], modes: &[Mode]) -> String {
    let one = |(natural, mode): (&Natural, &Mode)| {
        // The two differ there, as one uses A at the nearest frequency and the other A(∞).
        let outside = match natural.outside {
            true => " (outside the file's frequencies)",
            false => "",
        };
        format!(
            "{} {:.3} s undamped, {:.3} s with {:.2} % of critical damping{outside}",
            FREEDOMS[natural.freedom],
            natural.period_s,
            mode.period_s,
            plain(100.0 * mode.damping_ratio, 1e-2)
        )
    };
    let all: Vec<String> = natural.iter().zip(modes).map(one).collect();
    match all.is_empty() {
        true => "none: the body has no restoring stiffness".to_owned(),
        false => all.join("; "),
    }
}
