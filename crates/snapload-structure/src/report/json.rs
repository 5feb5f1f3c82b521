//! The answers as JSON: SI units, each unit in the name of its key.

use super::verdict::end_text;
use crate::physics::elastic::damping_ratio;
use crate::physics::equilibrium::Equilibrium;
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::snap::Snap;
use crate::physics::waterline::Waterline;
use crate::runs::assess::Assessment;
use crate::runs::design::Check;
use crate::runs::elastic_comparison::ElasticComparison;
use crate::runs::gumbel::Gumbel;
use crate::runs::outcome::Outcome;
use crate::runs::quantile::{quantile, slack_part};
use crate::runs::seas::Seas;
use crate::structure::{Structure, Water};
use serde_json::{Value, json};
use snapload::Stop;
use snapload_hydro::{FREEDOMS, Mode, Natural};

/// The moving mass, and the source of values that the case does not give.
fn body(structure: &Structure) -> Value {
    let (body, added) = (&structure.body, &structure.body.added_mass);
    json!({
        "mass_kg": body.mass_kg,
        "moment_of_inertia_kg_m2": body.moment_of_inertia_kg_m2,
        "added_mass_kg": [added.surge_kg, added.heave_kg],
        "added_inertia_kg_m2": added.pitch_kg_m2,
        "added_mass_by_default": structure.added_mass_source(),
    })
}

/// Natural periods of a floating body, and its extreme positions; none for a submerged one.
fn afloat(prepared: &ModelAtRest, seen: Option<&Waterline>) -> Option<Value> {
    let afloat = prepared.structure.afloat.as_ref()?;
    let motion = |(natural, mode): (&Natural, &Mode)| {
        json!({
            "freedom": FREEDOMS[natural.freedom],
            "undamped_period_s": natural.period_s,
            "period_s": mode.period_s,
            "damping_ratio": mode.damping_ratio,
        })
    };
    let free = afloat.report.floating.as_ref().ok()?;
    let free = free.natural.iter().zip(&free.modes).map(motion);
    let held = prepared
        .modes_on_taut_lines
        .iter()
        .map(|(natural, mode)| motion((natural, mode)));
    let stretched = prepared.modes_on_elastic_lines();
    Some(json!({
        "file": afloat.report.name,
        "memory_states": afloat.report.fit.memory.states(),
        "without_lines": free.collect::<Vec<_>>(),
        "held": held.collect::<Vec<_>>(),
        "stretched": stretched.iter().map(|(natural, mode)| motion((natural, mode))).collect::<Vec<_>>(),
        "waterline": seen,
    }))
}

/// The results of a line that exist only for judged time; null without it.
const JUDGED: [&str; 4] = [
    "snaps",
    "fastest_snap_m_s",
    "held_tension_n",
    "slack_fraction",
];

/// The results of a line.
fn judged(outcome: &Outcome, line: usize) -> Value {
    let mut row = json!(outcome.lines[line]);
    if outcome.is_unjudged() {
        JUDGED.iter().for_each(|key| row[*key] = Value::Null);
    }
    row
}

/// Checks, each with the number of neighbours that have the answer of the run itself.
fn check_rows(checks: Vec<(Check, usize)>) -> Vec<Value> {
    let row = |(check, agreeing): (Check, usize)| {
        let mut row = json!(check);
        row["words"] = json!(check.criterion.words());
        row["answer_in_words"] = json!(check.answer.words());
        row["neighbours_agreeing"] = json!(agreeing);
        row
    };
    checks.into_iter().map(row).collect()
}

impl Assessment {
    /// All results; `name` is that of the case.
    pub fn to_json(&self, name: &str) -> Value {
        let structure = &self.prepared.structure;
        let (rest, groups) = (&self.prepared.rest, &self.prepared.model.groups);
        let utilisations = self.utilisations();
        let line = |index: usize| {
            let line = &structure.lines[index];
            let mut row = judged(&self.outcome, index);
            row["line"] = json!(index + 1);
            row["name"] = json!(line.name);
            row["length_m"] = json!(line.length_m);
            row["stiffness_n"] = json!(line.stiffness_n);
            row["mass_per_length_kg_m"] = json!(line.mass_per_length_kg_m);
            row["breaking_load_n"] = json!(line.breaking_load_n);
            row["rest_tension_n"] = json!(rest.known_tensions_n()[index]);
            row["utilisation"] = json!(utilisations[index]);
            // The ratio of strength to load; infinite, and so null, if nothing pulls.
            row["safety_factor"] = json!(utilisations[index].map(f64::recip));
            row
        };
        let group = |index: usize| groups.wave.map(|wave| wave[index]);
        json!({
            "case": name,
            "verdict": self.verdict(),
            "trust": {
                "words": self.trust_text(),
                "horizon_s": self.horizon_s(),
                "neighbours": self.neighbours.len(),
                "peak_tension_quantiles_n": self.spread(),
            },
            "by_restitution": self.by_restitution(),
            "by_wave": self.by_wave(),
            "checks": check_rows(self.checks()),
            "warnings": self.warnings,
            "rest": position_of_rest(rest),
            "body": body(structure),
            "afloat": afloat(&self.prepared, self.outcome.waterline.as_ref()),
            "natural_periods": self.periods,
            "units": self.prepared.model.scales,
            "groups": {
                "r": groups.r, "a": groups.a, "b": groups.b, "inertia": groups.inertia,
                "f_o": group(0), "nu": group(1), "omega": group(2),
            },
            "end": { "t_s": self.outcome.end_s, "reason": end_text(self.outcome.stop) },
            "lines": (0..structure.lines.len()).map(line).collect::<Vec<_>>(),
            "snaps": self.snaps.iter().filter(|snap| snap.counts()).collect::<Vec<_>>(),
            "neighbour_peaks_n": self.neighbours.iter().map(Outcome::peak_n).collect::<Vec<_>>(),
        })
    }
}

/// The position of rest; null where none is known.
fn position_of_rest(rest: &Equilibrium) -> Value {
    let known = |number: f64| rest.rests.then_some(number);
    let by_stiffness = rest.by_stiffness.as_ref();
    json!({
        "x_m": known(rest.place_m[0]), "z_m": known(rest.place_m[1]),
        "theta_rad": known(rest.theta_rad),
        "indeterminate": rest.indeterminate,
        "unstretched_tension_n": by_stiffness.map(|by_stiffness| &by_stiffness.inextensible_n),
        "stretched_m": by_stiffness.map(|by_stiffness| by_stiffness.place_m),
    })
}

impl Seas {
    /// All results; `name` is that of the case.
    pub fn to_json(&self, name: &str) -> Value {
        let gumbel = |fit: Gumbel| {
            json!({
                "location": fit.location + fit.scale * fit.log_times, "scale": fit.scale,
                "records": fit.count, "mean": fit.mean(), "median": fit.quantile(0.5),
                "quantile_90": fit.quantile(0.9),
            })
        };
        let [crests, troughs] = self.crests_and_troughs_n();
        let crests_known = self.crests_known();
        let quantiles = |sorted: &[f64]| {
            let at = |part| quantile(sorted, part);
            json!({
                "waves": sorted.len(), "quantile_1": at(0.01), "median": at(0.5), "quantile_99": at(0.99),
                "largest": sorted.last(), "smallest": sorted.first(),
            })
        };
        let mut troughs_row = quantiles(&troughs);
        troughs_row["slack_part"] = json!((!troughs.is_empty()).then(|| slack_part(&troughs)));
        json!({
            "case": name,
            "body": body(&self.prepared.structure),
            "afloat": afloat(&self.prepared, None),
            "lines": self.lines,
            "sea": match self.prepared.structure.water {
                Water::Sea(sea) => Some(json!({
                    "significant_height_m": sea.significant_height_m,
                    "peak_period_s": sea.peak_period_s, "components": sea.components,
                    "first_seed": sea.seed,
                })),
                _ => None,
            },
            "duration_s": self.prepared.structure.duration_s,
            "transient_s": self.prepared.structure.transient_s,
            "records": self.records.len(),
            "standing": self.standing(),
            "words": self.words(),
            "peak_tension_in_three_hours_n": self.peak_in_three_hours().ok().map(gumbel),
            "fastest_snap_in_three_hours_m_s": self.speed_in_three_hours().ok().map(gumbel),
            "probability": self.probability().map(|share| json!({
                "failing": share.count, "of": share.of, "part": share.part(),
                "interval_95": share.interval(),
            })),
            "breaking_only_before_judged": self.breaking_only_early(),
            "snaps_in_three_hours": (self.judged_s() > 0.0).then(|| self.snaps_in_three_hours()),
            "slack_fraction": (self.judged_s() > 0.0).then(|| self.slack_fractions()),
            "largest_tension_of_lines_n": self.largest_of_lines_n(),
            "warnings": self.warnings,
            "checks": self.checks(),
            "crests_n": crests_known.then(|| quantiles(&crests)),
            "troughs_n": troughs_row,
            "largest_tensions_n": self.largest_n(),
            "peaks_n": self.records.iter().map(|record| record.outcome.known_peak_n()).collect::<Vec<_>>(),
            "fastest_m_s": self.speeds_m_s(),
        })
    }
}

impl ElasticComparison {
    /// All results; `name` is that of the case.
    pub fn to_json(&self, name: &str) -> Value {
        let structure = &self.prepared.structure;
        let elastic_lines = self.elastic_lines.iter().enumerate();
        let lines = elastic_lines.map(|(index, elastic_line)| {
            let [rate, damping] = self.si(elastic_line);
            let judged = !self.outcome.is_unjudged();
            json!({
                "line": index + 1,
                "spring_rate_n_m": rate,
                "damping_n_s_m": damping,
                "slack_fraction": judged.then(|| self.elastic.slack_fraction(index)),
                "peak_n": judged.then(|| self.elastic.peaks_n[index]),
                "peak_in_shorter_steps_n": judged.then(|| self.repeated.outcome.lines[index].largest_taut_n),
                "rest_tension_n": self.elastic_case.rest.tension_n[index],
                "breaking_load_n": structure.lines[index].breaking_load_n,
            })
        });
        let inextensible = self.inextensible.as_ref().map(|other| {
            let snap = |snap: &Snap| {
                json!({
                    "line": snap.line + 1, "t_s": snap.t_s, "speed_m_s": snap.speed_m_s,
                    "energy_peak_n": snap.energy_peak_n, "peak_n": snap.peak_n,
                })
            };
            json!({
                "snaps": other.snaps.iter().map(snap).collect::<Vec<_>>(),
                "slack_fraction": other.slack_fraction,
                "end": { "t_s": other.end_s, "reason": end_text(other.stop) },
                "took_s": other.took_s,
            })
        });
        json!({
            "case": name,
            "body": body(structure),
            "verdict": self.verdict(),
            "stiffer": self.stiffer,
            "restitution": structure.restitution,
            "damping_ratio": damping_ratio(structure.restitution),
            "end": {
                "t_s": self.elastic.end_s,
                "reason": end_text(self.elastic.stop.unwrap_or(Stop::EndTime)),
            },
            "rest": {
                "x_m": self.elastic_case.rest.place_m[0], "z_m": self.elastic_case.rest.place_m[1],
                "theta_rad": self.elastic_case.rest.theta_rad,
            },
            "warnings": self.warnings(),
            "end_s": self.elastic.end_s,
            "trust": {
                "words": self.trust_text(),
                "horizon_s": self.repeated.horizon_s,
                "neighbours": self.neighbours.len(),
                "peak_tension_quantiles_n": self.spread(),
                "end_in_shorter_steps": {
                    "t_s": self.repeated.outcome.end_s,
                    "reason": end_text(self.repeated.outcome.stop),
                },
            },
            "took_s": self.elastic_took_s,
            "lines": lines.collect::<Vec<_>>(),
            "pulls": self.elastic.pulls,
            "inextensible": inextensible,
            "checks": check_rows(self.checks()),
            "neighbour_peaks_n": self.neighbours.iter().map(Outcome::known_largest_n).collect::<Vec<_>>(),
        })
    }
}
