//! How long the response to a sea takes to become stationary.
//!
//! An oscillator of frequency ω and damping ratio ζ that is at rest when noise begins has reached
//! about the part 1 − exp(−2ζωt) of its variance after the time t (T. K. Caughey and H. J. Stumpf,
//! *J. Appl. Mech.* 28 (1961) 563). Without damping its variance grows in proportion to the time,
//! as long as the waves have its frequency: then no record shows the largest tension of a longer
//! one.
//!
//! The small motions about the place of rest are taken as such oscillators. The energy that is lost
//! in snaps is left out, as a motion may grow without a snap.

use super::elastic::elastic_lines;
use super::model_at_rest::ModelAtRest;
use super::periods::{NaturalMode, modes_on_inextensible_lines, modes_with_elastic_lines};
use super::sea::Spectrum;
use super::warning::{Warning, warning_if};
use crate::structure::Water;
use crate::text_layout::digits;
use snapload_hydro::{FREEDOMS, Mode, Natural};

/// The variance is stationary after so many times 1/(2ζω), up to exp(−3), 5 %.
const SETTLED_AFTER: f64 = 3.0;
/// Waves have no moment about the centre of a submerged body: a motion that is rotation except for
/// this part of its energy is not excited by them.
const ROTATION: f64 = 1e-6;

/// The motion that becomes stationary last.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Settling {
    /// How long that takes from the start of the waves, infinite without damping \[s\].
    pub(crate) time_s: f64,
    period_s: f64,
    motion: String,
}

impl Settling {
    /// Of a structure in a sea, on elastic lines or not; none if no small motion has a frequency of
    /// the waves.
    pub(crate) fn of(prepared: &ModelAtRest, elastic: bool) -> Option<Self> {
        let structure = &prepared.structure;
        let Water::Sea(sea) = structure.water else {
            return None;
        };
        let [low, high] = Spectrum::new(&sea).band_rad_s();
        let excited = |motion: &Self| {
            let omega = std::f64::consts::TAU / motion.period_s;
            (low..=high).contains(&omega)
        };
        let waves = structure.has_waves().then(|| motions(prepared, elastic));
        let all = waves.into_iter().flatten().filter(excited);
        all.max_by(|a, b| a.time_s.total_cmp(&b.time_s))
    }

    fn new(period_s: f64, energy_decay_1_s: f64, motion: String) -> Self {
        Self {
            time_s: SETTLED_AFTER / energy_decay_1_s.max(0.0),
            period_s,
            motion,
        }
    }

    /// The warning that the motion is not stationary in the larger part of a record.
    pub(crate) fn warning(&self, prepared: &ModelAtRest) -> Option<Warning> {
        let structure = &prepared.structure;
        let is = 2.0 * self.stationary_s(prepared) < structure.judged_s();
        let motion = format!("{} ({} s)", self.motion, digits(&self.period_s, 3));
        let grows = match self.time_s.is_finite() {
            true => format!(
                "{motion} has its full size only {:.0} s after the waves begin, which have its period",
                self.time_s
            ),
            false => format!(
                "{motion} is not damped, and the waves have its period, so that it may grow for as long as a sea lasts"
            ),
        };
        let holds = match structure.judges_three_hours() {
            true => "what is said of three hours is of a sea that begins with a body at rest. Give",
            false => {
                "records of less than three hours do not show the largest tension of three. Run longer ones \
                 (run.duration), or give"
            }
        };
        let key = match structure.afloat {
            Some(_) => "float.damping",
            None => "body.linear_damping, body.turning_damping or body.drag_area",
        };
        let words = format!("{grows}: {holds} its damping ({key})");
        warning_if(is, "settling", [0.0; 2], &words)
    }

    /// The stationary part of a record's judged time \[s\].
    pub(crate) fn stationary_s(&self, prepared: &ModelAtRest) -> f64 {
        let structure = &prepared.structure;
        structure.duration_s - structure.transient_s.max(self.time_s)
    }
}

/// The small motions that waves excite.
fn motions(prepared: &ModelAtRest, elastic: bool) -> Vec<Settling> {
    let afloat = |(natural, mode): &(Natural, Mode)| {
        let motion = FREEDOMS[natural.freedom].to_owned();
        Settling::new(natural.period_s, -2.0 * mode.eigenvalue.re, motion)
    };
    let submerged = |mode: NaturalMode| {
        let period_s = mode.period_s.filter(|_| mode.translation > ROTATION)?;
        Some(Settling::new(period_s, mode.energy_decay_1_s, mode.motion))
    };
    match (prepared.structure.afloat.is_some(), elastic) {
        (true, false) => prepared.modes_on_taut_lines.iter().map(afloat).collect(),
        (true, true) => prepared
            .modes_on_damped_lines()
            .iter()
            .map(afloat)
            .collect(),
        (false, false) => {
            let modes = modes_on_inextensible_lines(prepared);
            modes.into_iter().filter_map(submerged).collect()
        }
        (false, true) => {
            let lines = elastic_lines(prepared, 1.0).unwrap_or_default();
            let modes = modes_with_elastic_lines(prepared, &lines);
            modes.into_iter().filter_map(submerged).collect()
        }
    }
}
