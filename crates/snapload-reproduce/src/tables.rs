//! Tables 6.1 and 6.2 as CSV.

use crate::study::{CriticalRow, Reading, Study};
use snapload::analysis::CriticalForce;
use snapload::{Stop, TABLE_6_1, Trajectory};

/// A reason to stop as the report writes it.
pub fn reason(stop: Stop) -> &'static str {
    match stop {
        Stop::Settled => "settled",
        Stop::RotationLimit => "rotation limit",
        Stop::UpperBound => "upper bound",
        Stop::SlidingStart => "sliding start",
        Stop::EndTime => "end of time",
        Stop::ImpactLimit => "impact limit",
    }
}

/// Impacts of a run, impulses passed into taut cables not among them.
pub fn impacts(run: &Trajectory) -> usize {
    run.impacts()
        .iter()
        .filter(|impact| impact.v_n > 0.0)
        .count()
}

/// The rows of Table 6.1 in its order, then the variants that it prints under other codes: series, code.
pub fn rows_6_1() -> Vec<(&'static str, &'static str)> {
    let printed = [
        ("a=b (square), as printed", "1911001000-559"),
        ("a=b (square), as printed", "1922001000-559"),
        ("a=b (square), as printed", "1933001000-559"),
        ("a>b (rectangle), as printed", "1911001000-559"),
        ("a>b (rectangle), as printed", "1921001000-559"),
        ("a>b (rectangle), as printed", "1931001000-559"),
    ];
    TABLE_6_1.into_iter().chain(printed).collect()
}

/// Table 6.1 with the outcome of every row, in both readings.
pub fn csv_6_1(study: &Study) -> String {
    let mut text =
        String::from("series,case,reading,end,t,impacts,rho1,rho2,rho3,y_max,theta_max\n");
    for (series, code) in rows_6_1() {
        let Some(case) = study.case(code) else {
            continue;
        };
        for reading in Reading::BOTH {
            let run = case.runs.of(reading);
            let n = run.norms();
            text.push_str(&format!(
                "{series},{code},{},{},{},{},{},{},{},{},{}\n",
                name(reading),
                reason(run.end().reason),
                run.end().t,
                impacts(run),
                n.rho1,
                n.rho2,
                n.rho3,
                n.y_max,
                n.theta_max
            ));
        }
    }
    text
}

fn name(reading: Reading) -> &'static str {
    match reading {
        Reading::Chapter => "sliding ends the run",
        Reading::SlidingOn => "sliding goes on",
    }
}

/// Whether the published critical force is among the amplitudes that exceed.
pub fn published_exceeds(row: &CriticalRow, computed: &CriticalForce) -> bool {
    let inside = |[from, to]: &[f64; 2]| (*from..=*to).contains(&row.published);
    computed.exceeding.iter().any(inside)
}

/// Intervals of amplitudes as text.
pub fn intervals(computed: &CriticalForce) -> String {
    let text = |[from, to]: &[f64; 2]| {
        if from == to {
            format!("{from}")
        } else {
            format!("{from}-{to}")
        }
    };
    let all: Vec<String> = computed.exceeding.iter().map(text).collect();
    all.join("; ")
}

/// The parts of the neighbours at which it is told from which amplitude on they exceed: name, part.
pub const LEVELS: [(&str, f64); 3] = [("p05", 0.05), ("p50", 0.5), ("p95", 0.95)];

/// The amplitude from which on such a part of the neighbours exceeds; nothing where none does.
fn probable(row: &CriticalRow, reading: Reading, level: f64) -> String {
    let passes = row.probable.of(reading).passes(level);
    passes.map_or(String::new(), |f_o| f_o.to_string())
}

/// Table 6.2, computed beside published, in both readings.
pub fn csv_6_2(study: &Study) -> String {
    let mut text = String::from(
        "r,shape,a,b,published,reading,computed,difference,published_exceeds,p05,p50,p95,decidable,exceeding\n",
    );
    for row in &study.critical {
        for reading in Reading::BOTH {
            let found = row.computed.of(reading);
            let first = found.first.map(|first| first.f_o);
            text.push_str(&format!(
                "{},{},{},{},{},{},{},{},{},{},{},{}\n",
                row.r,
                row.shape,
                row.size[0],
                row.size[1],
                row.published,
                name(reading),
                first.map_or(String::new(), |f| f.to_string()),
                first.map_or(String::new(), |f| format!("{:.2}", f - row.published)),
                published_exceeds(row, found),
                LEVELS
                    .map(|(_, level)| probable(row, reading, level))
                    .join(","),
                row.decidable(reading),
                intervals(found)
            ));
        }
    }
    text
}
