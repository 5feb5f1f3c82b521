//! The report as one page of HTML that needs nothing else.

use crate::claims::{Claim, Verdict};
use crate::figures::{Figure, Row};
use crate::story::story;
use crate::study::{Reading, Study};
use crate::tables::{impacts, intervals, published_exceeds, reason, rows_6_1};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use snapload::Trajectory;

/// Readable on a phone, in print, in light and dark.
const STYLE: &str = include_str!("report.css");

/// The page.
pub fn page(study: &Study, figures: &[Row], claims: &[Claim]) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Chapter 6, reproduced" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                (introduction())
                (contents(figures))
                (table_6_1(study))
                (table_6_2(study))
                @for row in figures { (figure_row(row)) }
                (stories(study))
                (claims_table(claims))
            }
        }
    }
    .into_string()
}

fn introduction() -> Markup {
    html! {
        header {
            h1 { "Forced motions of a moored rigid body: chapter 6, reproduced" }
            p {
                "Every table and figure of chapter 6 of the 1999 thesis on snap loading of moored \
                 breakwaters, computed anew by snapload " (env!("CARGO_PKG_VERSION")) ". All quantities are \
                 nondimensional. Under each table and figure stands the command that computes it."
            }
            h2 { "Two readings" }
            p {
                "The chapter's own studies ended a run as soon as it began to slide with one cable taut \
                 (section 6.3.1); in truth the motion slides on. Everything below is computed both ways: \
                 “" (Reading::Chapter.words()) "” and “" (Reading::SlidingOn.words()) "”. Figures of single \
                 runs are drawn in the chapter's reading."
            }
            h2 { "How far to trust the numbers" }
            p {
                "The motion is chaotic. After 40 to 230 impacts double precision is exhausted, and what comes \
                 later (numbers of impacts, last digits of end times, some critical forces) is decided by \
                 rounding, here as in the thesis."
            }
        }
    }
}

fn contents(figures: &[Row]) -> Markup {
    html! {
        nav aria-label="Contents" {
            h2 { "Contents" }
            ul {
                li { a href="#table-6-1" { "Table 6.1" } }
                li { a href="#table-6-2" { "Table 6.2" } }
                @for row in figures {
                    li {
                        (row.title) ": "
                        @for figure in &row.figures {
                            a href={ "#" (figure.picture.name) } { (figure.number) } " "
                        }
                    }
                }
                li { a href="#stories" { "Sliding and rocking in words" } }
                li { a href="#claims" { "Every claim of the text, checked" } }
            }
        }
    }
}

fn table_6_1(study: &Study) -> Markup {
    html! {
        section id="table-6-1" {
            h2 { "Table 6.1: every row and its outcome" }
            div class="wide" {
                table {
                    thead {
                        tr {
                            th { "series" } th { "case" } th { "reading" } th { "end" } th { "t" } th { "impacts" }
                            th { "ρ₁" } th { "ρ₂" } th { "ρ₃" } th { "y_max" } th { "|θ|_max" }
                        }
                    }
                    tbody {
                        @for (series, code) in rows_6_1() {
                            @if let Some(case) = study.case(code) {
                                @for reading in Reading::BOTH {
                                    (outcome_row(series, code, reading, case.runs.of(reading)))
                                }
                            }
                        }
                    }
                }
            }
            p {
                "The table prints f_o = 0.5 in two series under codes that end in 359; the code decides (0.3), and the \
                 printed variants follow at the end. Each row: "
                code { "snapload run --case CODE" } ", with "
                code { "--set stop_when_sliding=true" } " for the chapter's reading. Data: "
                code { "table-6-1.csv" } "."
            }
        }
    }
}

fn outcome_row(series: &str, code: &str, reading: Reading, run: &Trajectory) -> Markup {
    let n = run.norms();
    let short = match reading {
        Reading::Chapter => "sliding ends",
        Reading::SlidingOn => "slides on",
    };
    html! {
        tr {
            td { (series) }
            td { code title={ "snapload run --case " (code) (reading.option()) } { (code) } }
            td { (short) }
            td { (reason(run.end().reason)) }
            td { (format!("{:.4}", run.end().t)) }
            td { (impacts(run)) }
            @for norm in [n.rho1, n.rho2, n.rho3, n.y_max, n.theta_max] {
                td { (format!("{norm:.4}")) }
            }
        }
    }
}

fn table_6_2(study: &Study) -> Markup {
    html! {
        section id="table-6-2" {
            h2 { "Table 6.2: critical force, computed beside published" }
            div class="wide" {
                table {
                    thead {
                        tr {
                            th { "r" } th { "shape" } th { "a" } th { "b" } th { "published" } th { "reading" }
                            th { "computed" } th { "difference" } th { "published exceeds" } th { "all that exceed up to 1" }
                        }
                    }
                    tbody {
                        @for row in &study.critical {
                            @for reading in Reading::BOTH {
                                @let found = row.computed.of(reading);
                                @let first = found.first.map(|first| first.f_o);
                                tr {
                                    td { (row.r) } td { (row.shape) } td { (row.size[0]) } td { (row.size[1]) }
                                    td { (format!("{:.2}", row.published)) }
                                    td { (if reading == Reading::Chapter { "sliding ends" } else { "slides on" }) }
                                    td { (first.map_or("none".to_owned(), |f| format!("{f:.2}"))) }
                                    td { (first.map_or(String::new(), |f| format!("{:+.2}", f - row.published))) }
                                    td { (if published_exceeds(row, found) { "yes" } else { "no" }) }
                                    td class="long" { (intervals(found)) }
                                }
                            }
                        }
                    }
                }
            }
            p {
                "Each row: " code { "snapload critical --set r=R --set a=A --set b=B" } ", with "
                code { "--set stop_when_sliding=true" } " for the chapter's reading. Data: " code { "table-6-2.csv" } "."
            }
        }
    }
}

fn figure_row(row: &Row) -> Markup {
    html! {
        section {
            h2 { (row.title) }
            div class="figures" {
                @for figure in &row.figures { (one(figure)) }
            }
        }
    }
}

fn one(figure: &Figure) -> Markup {
    html! {
        figure id=(figure.picture.name) {
            (PreEscaped(figure.picture.svg()))
            figcaption {
                b { "Fig. " (figure.number) ". " } (figure.caption) " "
                code { (figure.command) } " Data: " code { "figures/" (figure.picture.name) ".csv" }
            }
        }
    }
}

fn stories(study: &Study) -> Markup {
    html! {
        section id="stories" {
            h2 { "Sliding and rocking in words" }
            (told(
                "The sliding example (eq. 6.57)",
                "sliding-example",
                &study.sliding,
                "The chapter tells that the body begins to slide with the left cable taut, slides down until both \
                 cables are taut, is thrown back up the boundary and goes on sliding, up and down; that it then turns \
                 about the point where the taut cable is fastened until both are taut and it rocks; and that it later \
                 slides once more before it settles.",
            ))
            (told(
                "The rocking example (eq. 6.69)",
                "rocking-example",
                &study.rocking,
                "The chapter tells that the motion dies down until the body can no longer leave the boundaries, and \
                 that from then on it rocks with both cables taut, driven by the horizontal force, and never comes off.",
            ))
        }
    }
}

fn told(title: &str, code: &str, run: &Trajectory, theirs: &str) -> Markup {
    html! {
        h3 { (title) }
        div class="beside" {
            div { h4 { "The chapter" } p { (theirs) } }
            div {
                h4 { "The log" }
                ol {
                    @for (t, what) in story(run) {
                        li { "t = " (format!("{t:.3}")) ": " (what) "." }
                    }
                }
                p { code { "snapload run --case " (code) } }
            }
        }
    }
}

fn claims_table(claims: &[Claim]) -> Markup {
    let count = |verdict| {
        claims
            .iter()
            .filter(|claim| claim.verdict == verdict)
            .count()
    };
    html! {
        section id="claims" {
            h2 { "Every claim of the text, checked" }
            p {
                (claims.len()) " statements, in our words. No verdict is typed in: each comes out of the \
                 computation whose figures stand beside it, by the chapter's reading. Reproduced: "
                (count(Verdict::Reproduced)) ", not reproduced: " (count(Verdict::NotReproduced))
                ", not decidable (starts that differ by 1e-12 disagree): " (count(Verdict::NotDecidable))
                ". Data: " code { "claims.json" } ", made again by " code { "snapload reproduce" } "."
            }
            div class="wide" {
                table {
                    thead { tr { th { "id" } th { "claim" } th { "verdict" } th { "evidence" } } }
                    tbody {
                        @for claim in claims {
                            tr id={ "claim-" (claim.id) } {
                                td { (claim.id) }
                                td class="long" { (claim.claim) }
                                td { (claim.verdict.words()) }
                                td class="long" {
                                    (claim.evidence)
                                    @if !claim.remark.is_empty() { br; i { (claim.remark) } }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
