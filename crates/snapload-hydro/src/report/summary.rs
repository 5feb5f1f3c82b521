//! The answers in a few lines of text, each with a label.

use super::{Floating, Report, ZERO_DAMPING};
use crate::coefficients::FREEDOMS;
use crate::digits::{digits, kilo};
use crate::linear::{BALANCED_ANGLE, LARGE_PITCH, Mode, Natural, Peak};
use crate::memory::{BlockQuality, EntryQuality};
use std::f64::consts::PI;

/// A body counts as balanced if it floats within this many metres of its position in the file.
const BALANCED_HEAVE_M: f64 = 0.01;

impl Report {
    /// Rows of a label and a text, the most important first.
    pub fn summary(&self) -> Vec<(String, String)> {
        let mut rows = Vec::new();
        let mut push_row = |label: &str, message: String| rows.push((label.to_owned(), message));
        let hydro = &self.reading.hydro;
        let [low, high] = hydro.range_rad_s();
        let depth = match hydro.water.depth_m.is_finite() {
            true => format!("{} m deep", hydro.water.depth_m),
            false => "deep".to_owned(),
        };
        push_row(
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
        push_row("memory", self.memory_summary());
        match &self.floating {
            Ok(floating) => floating.push_rows(&mut push_row),
            Err(error) => push_row("omitted", format!("periods and response: {error}")),
        }
        for warning in &self.warnings {
            push_row("warning", format!("{}: {}", warning.what, warning.message));
        }
        rows
    }

    /// How the memory was made and how well it fits.
    pub fn memory_summary(&self) -> String {
        let fit = &self.fit;
        let worst =
            |of: fn(&EntryQuality) -> f64| 100.0 * fit.entries.iter().map(of).fold(0.0, f64::max);
        let furthest = EntryQuality::worst(&fit.entries).map_or(String::new(), EntryQuality::name);
        if fit.memory.terms.is_empty() && fit.entries.is_empty() {
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
        let omega_max = self.reading.hydro.range_rad_s()[1];
        let passive = if fit.blocks.is_empty() && fit.memory.not_passive(omega_max).is_some() {
            "not passive"
        } else if fit.memory.damping.amax() > 0.0 {
            "damping added"
        } else {
            "passive"
        };
        format!(
            "{how}, {} states; differs from the file by at most {:.2} % (root mean square; {furthest}), from K(t) \
             by at most {:.2} % (root mean square) and at no instant by more than {:.1} % of its largest value; {passive}",
            fit.memory.states(),
            worst(|entry| entry.rms),
            worst(|entry| entry.kernel_rms),
            worst(|entry| entry.worst_kernel),
        )
    }
}

impl Floating {
    /// The responses to waves from either side.
    fn push_response_rows(&self, push_row: &mut impl FnMut(&str, String)) {
        // A mirror-symmetric body responds alike to waves from either side.
        let mut rows: Vec<(String, Vec<&str>)> = Vec::new();
        for (index, [response, _]) in self.responses.iter().enumerate() {
            let to = if response.direction > 0.0 {
                "+x"
            } else {
                "−x"
            };
            let omega = &self.fine[index][0].omega_rad_s;
            let message = largest(&self.largest(index), [omega.first(), omega.last()]);
            match rows.iter_mut().find(|(known, _)| *known == message) {
                Some((_, directions)) => directions.push(to),
                None => rows.push((message, vec![to])),
            }
        }
        for (message, directions) in rows {
            let to = directions.join(" and ");
            push_row("response", format!("waves to {to}, largest: {message}"));
        }
    }

    /// The rest of weight, buoyancy and constant forces at the file's position, as text.
    fn balance_summary(&self) -> Option<String> {
        let body = &self.body;
        let lift = body.constant_force[1];
        let rise = lift / body.stiffness[(1, 1)].abs();
        let lift = (rise.abs() > BALANCED_HEAVE_M).then(|| {
            let way = if lift > 0.0 { "lift" } else { "weight" };
            format!("{} kN of {way}", kilo(&lift.abs(), 1))
        });
        let moment = body.constant_force[2];
        let moment = (moment.abs() > BALANCED_ANGLE * body.stiffness[(2, 2)].abs())
            .then(|| format!("a moment of {} kN m", kilo(&moment, 1)));
        let left = match (lift, moment) {
            (Some(lift), Some(moment)) => format!("{lift} and {moment} are"),
            (Some(lift), None) => format!("{lift} are"),
            (None, Some(moment)) => {
                let pitch = body.unbalanced_pitch().map(f64::to_degrees);
                let balanced = match pitch {
                    Some(pitch) if pitch.abs() > LARGE_PITCH => format!(
                        "not balanced within {LARGE_PITCH}° of pitch, where hydrostatics are linear"
                    ),
                    Some(pitch) => format!("balanced at {pitch:.1}° of pitch"),
                    None => "not balanced: lines must hold the body".to_owned(),
                };
                return Some(format!(
                    "{moment} is {balanced}; periods and responses are those of the upright body"
                ));
            }
            (None, None) => return None,
        };
        let way = if rise > 0.0 { "higher" } else { "lower" };
        Some(format!(
            "{left} not balanced: lines must hold the body, and their fairleads decide the pitch; periods and \
             responses are those without lines, upright and {:.2} m {way}, by the file's coefficients and for \
             vertical sides",
            rise.abs()
        ))
    }

    fn push_rows(&self, push_row: &mut impl FnMut(&str, String)) {
        let body = &self.body;
        push_row(
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
        if let Some(message) = self.balance_summary() {
            push_row("balance", message);
        }
        push_row("periods", periods_summary(&self.natural, &self.modes));
        self.push_response_rows(push_row);
        if let Some((rest, natural, modes)) = &self.rest {
            let tensions = rest.tension_n.iter().map(|t| kilo(t, 2));
            let message = format!(
                "surge {:.4} m, heave {:.4} m, pitch {:.3}°; tensions {} kN",
                plain(rest.q[0], 1e-4),
                plain(rest.q[1], 1e-4),
                plain(rest.q[2].to_degrees(), 1e-3),
                tensions.collect::<Vec<_>>().join(", "),
            );
            push_row("rest", message);
            push_row("held", held_summary(natural, modes));
        }
    }
}

/// Replaces a value below half a unit of the last printed place by zero, so that no "-0" is
/// printed.
pub(super) fn plain(value: f64, unit: f64) -> f64 {
    if value.abs() < 0.5 * unit { 0.0 } else { value }
}

/// The largest response of each degree of freedom, and its frequency; for narrow peaks the damping
/// on which they depend. One at either end of the frequencies may be larger beyond it.
fn largest(peaks: &[(Peak, Option<f64>); 3], [lowest, highest]: [Option<&f64>; 2]) -> String {
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
        let omega = Some(&peak.omega_rad_s);
        let end = match (omega == lowest, omega == highest) {
            (true, _) => " (the lowest frequency)",
            (_, true) => " (the highest frequency)",
            _ => "",
        };
        format!("{} {size} at {:.2} s{end}", FREEDOMS[i], period(peak))
    };
    let mut message = (0..3).map(of).collect::<Vec<_>>().join(", ");
    let narrow = (0..3).filter_map(|i| Some((i, peaks[i].1?)));
    let narrow: Vec<(usize, f64)> = narrow.collect();
    if let Some((_, ratio)) = narrow.iter().find(|(_, ratio)| *ratio > ZERO_DAMPING) {
        let names: Vec<&str> = narrow.iter().map(|(i, _)| FREEDOMS[*i]).collect();
        message += &format!(
            ". The peak of {} is so narrow that it is only as accurate as the damping, {:.2} % of critical",
            names.join(" and "),
            100.0 * ratio
        );
    }
    message
}

/// A positive number with three digits, which is its accuracy.
fn three_digits(value: f64) -> String {
    let before = value.max(1e-9).log10().floor() as i32;
    format!("{value:.*}", (2 - before).clamp(0, 9) as usize)
}

/// The same of a body on its taut lines, as text: three independent ones leave it no motion.
pub fn held_summary(natural: &[Natural], modes: &[Mode]) -> String {
    match natural.is_empty() {
        true => "none, as the taut lines allow no motion".to_owned(),
        false => periods_summary(natural, modes),
    }
}

/// Natural periods with their damping, as text.
pub fn periods_summary(natural: &[Natural], modes: &[Mode]) -> String {
    let one = |(natural, mode): (&Natural, &Mode)| {
        // The two differ there, as one uses A at the nearest frequency and the other A(∞).
        let outside = match natural.outside {
            true => " (outside the file's frequencies)",
            false => "",
        };
        let damped = match mode.is_overdamped() {
            true => "overdamped with damping".to_owned(),
            false => format!(
                "{} s with {:.2} % of critical damping",
                digits(&mode.period_s, 3),
                plain(100.0 * mode.damping_ratio, 1e-2)
            ),
        };
        let name = FREEDOMS[natural.freedom];
        format!(
            "{name} {} s undamped, {damped}{outside}",
            digits(&natural.period_s, 3)
        )
    };
    let all: Vec<String> = natural.iter().zip(modes).map(one).collect();
    match all.is_empty() {
        true => "none: the body has no restoring stiffness".to_owned(),
        false => all.join("; "),
    }
}
