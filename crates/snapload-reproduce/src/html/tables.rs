//! Tables 6.1 and 6.2 on the page.

use super::commands::Commands;
use super::symbols;
use crate::source::{SNAPS, critical, decimals, probability, run};
use crate::study::{CaseRuns, CriticalRow, NEIGHBOURS, Reading, Study};
use crate::tables::{LEVELS, impacts, published_exceeds, reason, rows_6_1};
use maud::{Markup, html};
use snapload::analysis::CriticalForce;
use snapload::{Trajectory, anchor_height};

pub(super) fn table_6_1(study: &Study, commands: &mut Commands) -> Markup {
    let rows = rows_6_1();
    let series = rows.chunk_by(|(p, _), (q, _)| p == q);
    html! {
        section id="table-6-1" {
            h2 { "Table 6.1: every row and its outcome" }
            p {
                "All start at rest at x = 0, y = 0.1, θ = 0, with ν = 0.5. The table prints "
                (symbols("f_o")) " = 0.5 in two series under codes that end in 359; the code decides (0.3), and the \
                 printed variants follow at the end. h is computed from r and a (claim "
                a href="#claim-6.3-04" { "6.3-04" } " lists the two heights that are printed otherwise). Where a \
                 run never slides both readings are one. The line below the symbols tells where a number stands in \
                 what the command prints. Data: " a href="table-6-1.csv" { "table-6-1.csv" } "."
            }
            div class="wide" {
                table class="outcomes" {
                    (head_6_1())
                    @for series in series {
                        tbody {
                            @if let Some((name, _)) = series.first() {
                                tr { th colspan="18" scope="rowgroup" { "Series " (symbols(name)) } }
                            }
                            @for (_, code) in series {
                                @if let Some(case) = study.case(code) { (outcomes(case, commands)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn head_6_1() -> Markup {
    html! {
        thead {
            tr {
                @for name in ["case", "r", "h", "e", "a", "b", "f_o", "Ω", "sliding", "end", "t", "impacts",
                              "ρ₁", "ρ₂", "ρ₃", "y_max", "|θ|_max", "made by"] {
                    th { (symbols(name)) }
                }
            }
            tr class="keys" {
                th colspan="9" {}
                @for key in ["end.reason", "end.t", "impacts, v_n > 0", "norms.rho1", "norms.rho2", "norms.rho3",
                             "norms.y_max", "norms.theta_max"] {
                    th { code { (key) } }
                }
                th {}
            }
        }
    }
}

/// One line where both readings come to the same, else two.
fn outcomes(case: &CaseRuns, commands: &mut Commands) -> Markup {
    let [chapter, sliding_on] = Reading::BOTH;
    let same = case.runs.chapter.end() == case.runs.sliding_on.end()
        && case.runs.chapter.norms() == case.runs.sliding_on.norms();
    html! {
        @if same {
            (outcome(case, "none", &Reading::BOTH, commands))
        } @else {
            (outcome(case, "ends", &[chapter], commands))
            (outcome(case, "goes on", &[sliding_on], commands))
        }
    }
}

fn outcome(
    case: &CaseRuns,
    sliding: &str,
    readings: &[Reading],
    commands: &mut Commands,
) -> Markup {
    let p = &case.parameters;
    let reading = readings.first().copied().unwrap_or(Reading::Chapter);
    let made = run(case.code, reading);
    html! {
        tr {
            th scope="row" { (case.code) }
            td { (p.r) } td { (format!("{:.3}", anchor_height(p.r, p.a))) } td { (p.e) } td { (p.a) } td { (p.b) }
            td { (p.f_o) } td { (p.omega) } td { (sliding) }
            @for (shown, key) in cells(case.runs.of(reading)) {
                td { (commands.link(&shown, &made, key)) }
            }
            td { @for reading in readings { (commands.cite(&run(case.code, *reading))) " " } }
        }
    }
}

/// What a run comes to, each with its place in the JSON of `snapload run`.
fn cells(run: &Trajectory) -> [(String, &'static str); 8] {
    let (end, norms) = (run.end(), run.norms());
    [
        (reason(end.reason).to_owned(), ".end.reason"),
        (decimals(end.t, 4), ".end.t"),
        (impacts(run).to_string(), SNAPS),
        (decimals(norms.rho1, 4), ".norms.rho1"),
        (decimals(norms.rho2, 4), ".norms.rho2"),
        (decimals(norms.rho3, 4), ".norms.rho3"),
        (decimals(norms.y_max, 4), ".norms.y_max"),
        (decimals(norms.theta_max, 4), ".norms.theta_max"),
    ]
}

pub(super) fn table_6_2(study: &Study, commands: &mut Commands) -> Markup {
    html! {
        section id="table-6-2" {
            h2 { "Table 6.2: critical force, computed beside published" }
            p {
                "Standard conditions: e = 0.9, Ω = 0.9. The computed critical force is the smallest amplitude, in \
                 steps of 0.01, that exceeds the limits. Then follow: whether the published one exceeds them; from \
                 which amplitude on 5, 50 and 95 % of " (NEIGHBOURS) " neighbours exceed, whose start values differ \
                 by up to 1e−12; whether the published value could be decided at all, as neighbours agree at every \
                 amplitude up to it; and all amplitudes up to 1 that exceed. Data: " a href="table-6-2.csv" { "table-6-2.csv" } "."
            }
            div class="wide" {
                table {
                    thead {
                        tr {
                            @for name in ["shape", "r", "a", "b", "published f_cr", "sliding", "computed f_cr",
                                          "difference", "published exceeds", "5 %", "50 %", "95 %", "decidable",
                                          "all that exceed", "made by"] {
                                th { (symbols(name)) }
                            }
                        }
                        tr class="keys" {
                            th colspan="6" {}
                            th { code { "f_cr" } } th {} th {}
                            @for (name, _) in LEVELS { th { code { "passes." (name) } } }
                            th {} th { code { "exceeding" } } th {}
                        }
                    }
                    tbody {
                        @for row in &study.critical {
                            (critical_line(row, Reading::Chapter, commands))
                            (critical_line(row, Reading::SlidingOn, commands))
                        }
                    }
                }
            }
        }
    }
}

fn critical_line(row: &CriticalRow, reading: Reading, commands: &mut Commands) -> Markup {
    let found = row.computed.of(reading);
    let first = found.first.map(|first| first.f_o);
    let made = critical(row, reading);
    let published = row.published;
    let sliding = match reading {
        Reading::Chapter => "ends",
        Reading::SlidingOn => "goes on",
    };
    let exceeds = if published_exceeds(row, found) {
        "yes"
    } else {
        "no"
    };
    let crowd = probability(row, reading);
    let decidable = if row.decidable(reading) { "yes" } else { "no" };
    let agree = format!("all(.probability[]; .f_o > {published} or .part == 0 or .part == 1)");
    let within = format!("any(.exceeding[]; .[0] <= {published} and {published} <= .[1])");
    html! {
        tr {
            th scope="row" { (row.shape) }
            td { (row.r) } td { (row.size[0]) } td { (row.size[1]) }
            td { (decimals(published, 2)) } td { (sliding) }
            @if let Some(first) = first {
                td { (commands.link(&decimals(first, 2), &made, ".f_cr")) }
                td { (commands.link(&signed(first - published), &made, &format!(".f_cr - {published}"))) }
            } @else {
                td { (commands.link("none", &made, ".f_cr")) } td {}
            }
            td { (commands.link(exceeds, &made, &within)) }
            @for (name, level) in LEVELS {
                td { (commands.link(&passes(row, reading, level), &crowd, &format!(".passes.{name}"))) }
            }
            td { (commands.link(decidable, &crowd, &agree)) }
            td class="long" { (commands.link(&ranges(found), &made, ".exceeding")) }
            td { (commands.cite(&made)) " " (commands.cite(&crowd)) }
        }
    }
}

/// The amplitude from which on such a part of the neighbours exceeds.
fn passes(row: &CriticalRow, reading: Reading, level: f64) -> String {
    let passes = row.probable.of(reading).passes(level);
    passes.map_or("none".to_owned(), |f_o| decimals(f_o, 2))
}

/// A difference with its sign; none where it vanishes.
fn signed(difference: f64) -> String {
    match decimals(difference, 2).as_str() {
        "0.00" | "−0.00" => "0.00".to_owned(),
        text if text.starts_with('−') => text.to_owned(),
        text => format!("+{text}"),
    }
}

/// Intervals of amplitudes, to be read.
fn ranges(found: &CriticalForce) -> String {
    let range = |[from, to]: &[f64; 2]| match (decimals(*from, 2), decimals(*to, 2)) {
        (from, to) if from == to => from,
        (from, to) => format!("{from}–{to}"),
    };
    let all: Vec<String> = found.exceeding.iter().map(range).collect();
    all.join(", ")
}
