//! The page of many records of a sea.

use super::{assumptions, figure, inputs_of, plots, whole};
use crate::gumbel::Estimate;
use crate::seas::Seas;
use maud::{Markup, html};
use snapload_figures::FigureError;

/// The page. `command` is the command line that makes it again.
///
/// # Errors
/// A [`FigureError`] if a plot can not be drawn.
pub fn seas_page(name: &str, command: &str, seas: &Seas) -> Result<String, FigureError> {
    let plots = plots::of_seas(seas)?;
    let failing = seas.failing();
    let class = match failing {
        None => "open",
        Some(share) if share.count > 0 => "fails",
        Some(_) => "holds",
    };
    let body = html! {
        header {
            h1 { "Sea note: " (name) }
            p class={ "verdict " (class) } { (seas.words()) }
        }
        (expected(seas))
        section { h2 { "Distributions" } div.figures { @for (plot, words) in &plots { (figure(plot, words)) } } }
        (lines(seas))
        (inputs_of(&seas.prepared.structure))
        (assumptions(&seas.prepared.structure))
    };
    Ok(whole(&format!("Sea note: {name}"), command, &body))
}

fn expected(seas: &Seas) -> Markup {
    let cell = |estimate: Estimate, unit: f64, digits: usize| {
        format!(
            "{:.digits$} ± {:.digits$}",
            estimate.value / unit,
            estimate.error / unit
        )
    };
    let rows = [
        ("Largest tension, kN", seas.peak_in_three_hours(), 1e3, 0),
        ("Fastest snap, m/s", seas.speed_in_three_hours(), 1.0, 3),
    ];
    html! {
        section {
            h2 { "The hardest snap in three hours" }
            div.wide { table {
                thead { tr { th {} th { "expected" } th { "50 % stay below" } th { "90 % stay below" } th { "99 % stay below" } } }
                tbody { @for (label, fit, unit, digits) in &rows { tr {
                    td { (label) }
                    @if let Some(fit) = fit {
                        td { (cell(fit.mean(), *unit, *digits)) }
                        @for p in [0.5, 0.9, 0.99] { td { (cell(fit.quantile(p), *unit, *digits)) } }
                    } @else { td { "not known" } td {} td {} td {} }
                } } }
            } }
            p.small {
                "From " (seas.records.len()) " records of " (format!("{:.0}", seas.prepared.structure.duration_s)) " s, a Gumbel \
                 distribution fitted by L-moments; ± is one standard error of the fit, which more records make smaller."
            }
        }
    }
}

fn lines(seas: &Seas) -> Markup {
    let structure = &seas.prepared.structure;
    html! {
        section {
            h2 { "Lines" }
            div.wide { table {
                thead { tr { th { "line" } th { "what" } th { "at rest" br; "kN" } th { "slack" br; "% of time" } th { "breaks at" br; "kN" } } }
                tbody { @for (index, line) in structure.lines.iter().enumerate() { tr {
                    td { (index + 1) } td { (if line.name.is_empty() { "own values" } else { &line.name }) }
                    td { (format!("{:.0}", seas.prepared.rest.tension_n[index] / 1e3)) }
                    td { (format!("{:.2}", 100.0 * seas.slack_fraction(index))) }
                    td { (line.breaking_load_n.map_or("not known".to_owned(), |load| format!("{:.0}", load / 1e3))) }
                } } }
            } }
            p.small { (format!("{:.0}", seas.snaps_in_three_hours())) " snaps of 1 cm/s or more in three hours, of all lines together." }
        }
    }
}
