//! The answer of `snapload assess` as JSON: SI units, each in the name of its key.
use serde_json::{Value, json};
use snapload_structure::{Assessment, Outcome, Snap, Standing, end_words};

/// All of it.
pub(crate) fn report(name: &str, assessment: &Assessment) -> Value {
    let prepared = &assessment.prepared;
    let (structure, rest) = (&prepared.structure, &prepared.rest);
    let (scales, groups) = (&prepared.model.scales, &prepared.model.groups);
    let verdict = assessment.verdict();
    let lines: Vec<Value> = structure
        .lines
        .iter()
        .enumerate()
        .map(|(index, line)| {
            let outcome = &assessment.outcome.lines[index];
            json!({
                "line": index + 1,
                "name": line.name,
                "length_m": line.length_m,
                "stiffness_n": line.stiffness_n,
                "mass_per_length_kg_m": line.mass_per_length_kg_m,
                "breaking_load_n": line.breaking_load_n,
                "rest_tension_n": rest.tension_n[index],
                "held_tension_n": outcome.held_n,
                "slack_fraction": outcome.slack_fraction,
                "snaps": outcome.snaps,
                "fastest_snap_m_s": outcome.speed_m_s,
                "peak_tension_n": outcome.peak_n,
                "utilisation": assessment.outcome.utilisations(structure)[index],
            })
        })
        .collect();
    json!({
        "case": name,
        "verdict": { "standing": standing(verdict.standing), "words": verdict.words },
        "trust": {
            "words": assessment.trust_words(),
            "horizon_s": assessment.horizon_s(),
            "neighbours": assessment.neighbours.len(),
            "peak_tension_quantiles_n": assessment.spread(),
        },
        "warnings": assessment.warnings.iter().map(|w| json!({ "rule": w.rule, "message": w.message })).collect::<Vec<_>>(),
        "rest": { "x_m": rest.place_m[0], "z_m": rest.place_m[1], "theta_rad": rest.theta_rad, "indeterminate": rest.indeterminate },
        "units": { "length_m": scales.length_m, "mass_kg": scales.mass_kg, "force_n": scales.force_n, "time_s": scales.time_s },
        "groups": {
            "r": groups.r, "a": groups.a, "b": groups.b, "inertia": groups.inertia,
            "f_o": groups.wave.map(|g| g[0]), "nu": groups.wave.map(|g| g[1]), "omega": groups.wave.map(|g| g[2]),
        },
        "end": { "t_s": assessment.outcome.end_s, "reason": end_words(assessment.outcome.stop) },
        "lines": lines,
        "snaps": assessment.snaps.iter().filter(|snap| snap.counts()).map(snap).collect::<Vec<_>>(),
        "neighbour_peaks_n": assessment.neighbours.iter().map(Outcome::peak_n).collect::<Vec<_>>(),
    })
}

fn snap(snap: &Snap) -> Value {
    json!({
        "t_s": snap.t_s,
        "line": snap.line + 1,
        "jolt": snap.is_jolt,
        "speed_m_s": snap.speed_m_s,
        "impulse_n_s": snap.impulse_n_s,
        "energy_lost_j": snap.energy_lost_j,
        "effective_mass_kg": snap.effective_mass_kg,
        "effective_speed_m_s": snap.effective_speed_m_s,
        "energy_peak_n": snap.energy_peak_n,
        "front_n": snap.front_n,
        "peak_n": snap.peak_n,
        "utilisation": snap.utilisation,
    })
}

fn standing(standing: Standing) -> &'static str {
    match standing {
        Standing::Holds => "holds",
        Standing::Breaks => "breaks",
        Standing::Exceeds => "exceeds",
        Standing::Unknown => "unknown",
    }
}
