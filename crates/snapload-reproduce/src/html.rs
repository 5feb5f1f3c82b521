//! The report as one page of HTML that needs nothing else.

mod claims;
mod commands;
mod front;
mod tables;

use crate::claims::Claim;
use crate::figures::{Figure, Row};
use crate::source;
use crate::story::story;
use crate::study::{Reading, Study};
use commands::{Commands, command};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use snapload::Trajectory;

/// Readable on a phone, in print, in light and dark.
const STYLE: &str = include_str!("report.css");

/// The page.
pub fn page(study: &Study, figures: &[Row], claims: &[Claim]) -> String {
    let mut commands = Commands::default();
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
                (front::introduction(study, claims, &mut commands))
                (front::contents(figures, claims))
                (tables::table_6_1(study, &mut commands))
                (tables::table_6_2(study, &mut commands))
                @for row in figures { (figure_row(row, &mut commands)) }
                (stories(study, &mut commands))
                (claims::table(claims, &mut commands))
                (commands.list())
            }
        }
    }
    .into_string()
}

/// The symbols that plain text writes with an underscore, or with the digit after a letter.
const SYMBOLS: [(&str, &str); 8] = [
    ("|θ|_max", "|<i>θ</i>|<sub>max</sub>"),
    ("f_cr", "<i>f</i><sub>cr</sub>"),
    ("f_o", "<i>f</i><sub>o</sub>"),
    ("f_x", "<i>f</i><sub>x</sub>"),
    ("f_y", "<i>f</i><sub>y</sub>"),
    ("v_n", "<i>v</i><sub>n</sub>"),
    ("y_max", "<i>y</i><sub>max</sub>"),
    ("I_c", "<i>I</i><sub>c</sub>"),
];

/// Plain text with its symbols set as such.
fn symbols(text: &str) -> Markup {
    let escaped = html! { (text) }.into_string();
    let set = |text: String, (plain, marked): &(&str, &str)| text.replace(plain, marked);
    PreEscaped(SYMBOLS.iter().fold(escaped, set))
}

fn figure_row(row: &Row, commands: &mut Commands) -> Markup {
    html! {
        section {
            h2 { (row.title) }
            div class={ "figures of-" (row.columns) } {
                @for figure in &row.figures { (one(figure, commands)) }
            }
        }
    }
}

fn one(figure: &Figure, commands: &mut Commands) -> Markup {
    let data = format!("figures/{}.csv", figure.picture.name);
    html! {
        figure id=(figure.picture.name) {
            (PreEscaped(figure.picture.svg()))
            figcaption {
                b { "Fig. " (figure.number) ". " } (symbols(&figure.caption))
                @for (k, number) in figure.numbers.iter().enumerate() {
                    @if k > 0 { "," }
                    " " (commands.number(number))
                }
                @if !figure.numbers.is_empty() { "." }
                @for source in &figure.sources {
                    div.source {
                        (commands.cite(&source.command)) " "
                        @if !source.what.is_empty() { (source.what) ": " }
                        (command(&source.command)) " → " code { (source.place) }
                    }
                }
                div.source { "Data: " a href=(data) { (data) } }
            }
        }
    }
}

fn stories(study: &Study, commands: &mut Commands) -> Markup {
    html! {
        section id="stories" {
            h2 { "Sliding and rocking in words" }
            (told(
                ["The sliding example (eq. 6.57)", "sliding-example", "6.5.1.2"],
                &study.sliding,
                "The chapter tells that the body begins to slide with the left cable taut, slides down until both \
                 cables are taut, is thrown back up the boundary and goes on sliding, up and down; that it then turns \
                 about the point where the taut cable is fastened until both are taut and it rocks; and that it later \
                 slides once more before it settles.",
                commands,
            ))
            (told(
                ["The rocking example (eq. 6.69)", "rocking-example", "6.5.2.2"],
                &study.rocking,
                "The chapter tells that the motion dies down until the body can no longer leave the boundaries, and \
                 that from then on it rocks with both cables taut, driven by the horizontal force, and never comes off.",
                commands,
            ))
        }
    }
}

fn told(
    [title, code, section]: [&str; 3],
    run: &Trajectory,
    theirs: &str,
    commands: &mut Commands,
) -> Markup {
    let made = source::run(code, Reading::SlidingOn);
    html! {
        h3 { (title) }
        div class="beside" {
            div {
                h4 { "The chapter" }
                p { (theirs) }
                p { "Point by point: the claims of section " a href={ "#claims-" (section) } { (section) } "." }
            }
            div {
                h4 { "The log of the run, stretches under 0.02 told together" }
                ol {
                    @for step in story(run) {
                        @let key = format!(".modes[{}].t_start", step.mode);
                        li {
                            "t = " (commands.link(&source::decimals(step.t, 4), &made, &key)) ": " (step.what) "."
                        }
                    }
                }
                div.source { (commands.cite(&made)) " " (command(&made)) " → " code { ".modes, .impacts" } }
            }
        }
    }
}
