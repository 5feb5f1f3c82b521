//! What stands before the tables: what this is, what came of it, how to read it, contents.

use super::claims::{count, sections};
use super::commands::Commands;
use super::symbols;
use crate::claims::{Claim, Verdict};
use crate::figures::Row;
use crate::source::REPORT;
use crate::study::{Reading, Study};
use crate::tables::published_exceeds;
use maud::{Markup, html};

pub(super) fn introduction(study: &Study, claims: &[Claim], commands: &mut Commands) -> Markup {
    html! {
        header {
            h1 { "Forced motions of a moored rigid body: chapter 6, reproduced" }
            p {
                "Every table and figure of chapter 6 of the 1999 thesis on snap loading of moored \
                 breakwaters, computed anew by snapload " (env!("CARGO_PKG_VERSION")) ", and every statement of its \
                 text checked. This page: " code { (REPORT) } ". Every computed number is a link to the command \
                 that makes it again; " a href="#commands" { "all commands" } " stand at the end."
            }
            (results(study, claims, commands))
            h2 { "Two readings" }
            p {
                "The chapter's own studies ended a run as soon as it began to slide with one cable taut \
                 (section 6.3.1); in truth the motion slides on. Everything below is computed both ways: \
                 “" (Reading::Chapter.words()) "” and “" (Reading::SlidingOn.words()) "”. Figures of single \
                 runs are drawn in the chapter's reading."
            }
            h2 { "How far to trust the numbers" }
            p {
                "The motion is chaotic. After 40 to 230 impacts double precision is exhausted (" code { "snapload run" }
                " says where, for each run), and what comes \
                 later (numbers of impacts, last digits of end times, some critical forces) is decided by \
                 rounding, here as in the thesis. The program does its arithmetic in the same order everywhere, so \
                 its commands give these very digits on any machine; another program would not."
            }
            (notation())
        }
    }
}

fn results(study: &Study, claims: &[Claim], commands: &mut Commands) -> Markup {
    let differences = || {
        let rows = study.critical.iter();
        rows.filter_map(|row| Some((row.computed.chapter.first?.f_o - row.published).abs()))
    };
    let within = |limit: f64| differences().filter(|d| *d < limit + 0.005).count();
    let exceed = study.critical.iter();
    let exceed = exceed.filter(|row| published_exceeds(row, &row.computed.chapter));
    let rows = study.critical.iter();
    let decidable = rows.filter(|row| row.decidable(Reading::Chapter)).count();
    html! {
        h2 { "What came of it" }
        ul {
            li {
                a href="#claims" { "Claims" } ": of " (claims.len()) " statements "
                (count(claims, Verdict::Reproduced, commands)) " are reproduced, "
                (count(claims, Verdict::NotReproduced, commands)) " are not, and "
                (count(claims, Verdict::NotDecidable, commands)) " can not be decided in double precision."
            }
            li {
                a href="#table-6-2" { "Table 6.2" } ": of " (study.critical.len()) " published critical forces "
                (within(0.0)) " come out to the last digit and " (within(0.03)) " within 0.03, in the chapter's \
                 reading; " (exceed.count()) " of the published amplitudes do exceed the limits, as the first or as \
                 a later one. " (decidable) " of them could be decided at all in double precision: for the others \
                 neighbours disagree at an amplitude at or below the published one."
            }
            li {
                "Figures: all of 6.1 to 6.38, 6.43 and 6.45 are computed, 6.39 to 6.42 and 6.44 are drawn from \
                 states of such runs. The chapter's own figures were not at hand, only their captions and the text: \
                 axes, scales and marks follow these."
            }
        }
    }
}

fn notation() -> Markup {
    let terms = [
        (
            "Units",
            "All quantities are nondimensional: length by half the distance L between the anchors, mass by the \
             body's m, force by its net buoyancy F, time by T = √(mL/F). Angles are in radians.",
        ),
        (
            "Picture",
            "It is upside down, as in the chapter: the sea floor is at the top, and the net buoyancy pulls \
             towards −y. (x, y) is the body's centre, θ its rotation; at x = y = θ = 0 both cables are taut.",
        ),
        (
            "Body and cables",
            "a and b are half width and half height (b = 0 is the circle), r is the length of both cables, \
             h = √(r² − (1 − a)²) the height of the anchors less b. Cable 1 is the right one (chapter: g₁ = 0), \
             cable 2 the left one (g₂ = 0); e is the restitution of a snap.",
        ),
        ("Forcing", "f_x = f_o cos Ωt and f_y = ν f_o sin Ωt."),
        (
            "Results",
            "v_n⁻ is the normal velocity just before a snap; ρ₁ is the largest, ρ₂ their sum up to t = 10, ρ₃ \
             their sum; y_max and |θ|_max are taken over the whole motion. The limits are |θ| = π/2 and the level \
             of the anchors; f_cr is the smallest force amplitude that exceeds one.",
        ),
    ];
    html! {
        h2 { "Notation" }
        dl {
            @for (term, meaning) in terms {
                dt { (term) }
                dd { (symbols(meaning)) }
            }
        }
    }
}

pub(super) fn contents(figures: &[Row], claims: &[Claim]) -> Markup {
    html! {
        nav aria-label="Contents" {
            h2 { "Contents" }
            ul {
                li { a href="#table-6-1" { "Table 6.1: every row and its outcome" } }
                li { a href="#table-6-2" { "Table 6.2: critical force" } }
                @for row in figures {
                    li {
                        (row.title) ": "
                        @for figure in &row.figures {
                            a href={ "#" (figure.picture.name) } { "Fig. " (figure.number) } " "
                        }
                    }
                }
                li { a href="#stories" { "Sliding and rocking in words" } }
                li {
                    a href="#claims" { "Every claim of the text, checked" } ", by section: "
                    @for section in sections(claims) { a href={ "#claims-" (section) } { (section) } " " }
                }
                li { a href="#commands" { "The commands" } }
            }
        }
    }
}
