//! The law of an elastic line: a spring and a damper in parallel that can only pull.

use crate::physics::model_at_rest::ModelAtRest;
use crate::structure::LineSi;
use snapload::CaseError;

/// For a smaller restitution the damper would dominate the line.
pub(crate) const LEAST_RESTITUTION: f64 = 0.01;

/// A line as spring and damper, in the engine's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticLine {
    /// k \[F/L\].
    pub rate: f64,
    /// c \[F T/L\].
    pub damping: f64,
}

impl ElasticLine {
    /// The force of spring and damper at the elongation δ = |P − A| − r:
    ///
    /// ```text
    /// T = k δ + c δ̇,    with which the line pulls while δ > 0 and T > 0
    /// ```
    ///
    /// The linear dashpot of T. Schwager and T. Pöschel, *Granular Matter* 9 (2007) 465, which
    /// releases when the force returns to zero; with a damper that is before the elongation does.
    pub fn force(&self, elongation: f64, rate: f64) -> f64 {
        self.rate * elongation + self.damping * rate
    }
}

/// The damping ratio ζ = c/(2 sqrt(k m)) of a spring and damper from which a mass rebounds with e
/// times its speed, if it is released when the force returns to zero:
///
/// ```text
/// e = exp(−2ζ arccos ζ/sqrt(1 − ζ²)),    with arcosh and ζ² − 1 beyond ζ = 1
/// ```
///
/// (Schwager and Pöschel, eq. 17 and 18, in which β/ω₀ is ζ).
pub fn damping_ratio(restitution: f64) -> f64 {
    if restitution >= 1.0 {
        return 0.0;
    }
    let rebound = |ratio: f64| {
        let root = (1.0 - ratio * ratio).abs().sqrt();
        let angle = if ratio < 1.0 {
            ratio.acos()
        } else {
            ratio.acosh()
        };
        // Towards ζ = 1 the angle over the root goes to 1.
        let quotient = if root < 1e-6 { 1.0 } else { angle / root };
        (-2.0 * ratio * quotient).exp()
    };
    let (mut low, mut high) = (0.0, 1.0);
    while rebound(high) > restitution && high < 1e9 {
        high *= 2.0;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if rebound(middle) > restitution {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// The lines of a structure as springs, `stiffer` times as stiff as they are, with dampers that
/// give its restitution for the mass that each line stops, where the structure rests on
/// inextensible lines.
///
/// # Errors
/// A [`CaseError`] if a line has no stiffness, or the restitution is too small.
pub fn elastic_lines(prepared: &ModelAtRest, stiffer: f64) -> Result<Vec<ElasticLine>, CaseError> {
    let restitution = prepared.structure.restitution;
    if restitution < LEAST_RESTITUTION {
        let shown = restitution;
        let allowed = format!("{LEAST_RESTITUTION} or more for elastic lines");
        return Err(CaseError::value("run.restitution", shown, allowed).with_hint(
            "with a lower one the damper's force at the start of a pull is many times the largest of the spring",
        ));
    }
    let ratio = damping_ratio(restitution);
    let damped = |(line, elastic_line): (usize, ElasticLine)| {
        let damping = 2.0 * ratio * (elastic_line.rate * prepared.mass_stopped(line)).sqrt();
        ElasticLine {
            damping,
            ..elastic_line
        }
    };
    let elastic_lines = undamped(prepared, stiffer)?.into_iter();
    Ok(elastic_lines.enumerate().map(damped).collect())
}

impl ModelAtRest {
    /// The mass that a line stops: the effective mass along it, of which strands of one line have
    /// their parts by stiffness, as each bears that part of the load. In the engine's units.
    pub(in crate::physics) fn mass_stopped(&self, line: usize) -> f64 {
        let lines = &self.structure.lines;
        let own = &lines[line];
        let others = lines.iter().enumerate().filter(|(other, _)| *other != line);
        let strands = others.filter(|(_, other)| own.is_strand_with(other));
        let times_own = strands
            .filter_map(|(_, other)| Some(other.spring_rate_n_m()? / own.spring_rate_n_m()?));
        self.mass_along(line) / (1.0 + times_own.sum::<f64>())
    }

    /// The effective mass M/w of the body along a line at rest, in the engine's units.
    fn mass_along(&self, line: usize) -> f64 {
        let (rest, system) = (&self.rest, &self.model.system);
        let (at, cable) = (
            self.model.at_rest(rest.place_m, rest.theta_rad),
            &system.cables[line],
        );
        // The normal is the span divided by the line's length, and shorter than 1 if the line is
        // slack.
        let [x, y] = cable.span(&at).components();
        let along = x.hypot(y) / cable.length();
        along * along / system.body.inverse_effective_mass(&cable.normal(&at))
    }
}

/// The same without dampers, which have no effect on a body at rest.
///
/// # Errors
/// A [`CaseError`] if a line has no stiffness.
pub(in crate::physics) fn undamped(
    prepared: &ModelAtRest,
    stiffer: f64,
) -> Result<Vec<ElasticLine>, CaseError> {
    let scales = &prepared.model.scales;
    let unit = scales.force_n / scales.length_m;
    let elastic_line = |(number, line): (usize, &LineSi)| {
        let rate = line.spring_rate_n_m().ok_or_else(|| {
            let key = format!("line.{number}.stiffness");
            let allowed = "a stiffness, which an elastic line needs";
            CaseError::value(&key, "(left out)", allowed)
                .with_hint("give stiffness (EA in N), spring_rate, or a type and diameter")
        })?;
        Ok(ElasticLine {
            rate: rate * stiffer / unit,
            damping: 0.0,
        })
    };
    (1..)
        .zip(&prepared.structure.lines)
        .map(elastic_line)
        .collect()
}
