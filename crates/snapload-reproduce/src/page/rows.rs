//! The rows of the page's tables.

use super::{Page, symbols};
use crate::critical_row::CriticalRow;
use crate::sentences::Kind;
use crate::source::{critical, decimals, probability, run};
use crate::study::{CaseRuns, Reading, Study};
use crate::tables::{END_TIMES, EXCEEDING, by_convention, critical_outcome, outcome, rows_6_1};
use maud::{Markup, html};
use snapload::anchor_height;

impl Page<'_> {
    pub(super) fn table_6_1(&mut self) -> Markup {
        let study = self.study;
        let [chapter, sliding_on] = Reading::BOTH;
        let same = |case: &CaseRuns| {
            let [ends, with_sliding] = Reading::BOTH.map(|reading| &case.runs.of(reading).run);
            ends.end() == with_sliding.end() && ends.norms() == with_sliding.norms()
        };
        html! {
            @for series in rows_6_1().chunk_by(|(p, _), (q, _)| p == q) {
                tbody {
                    tr { th colspan="19" scope="rowgroup" { "Series " (symbols(series[0].0)) } }
                    @for case in series.iter().filter_map(|(_, code)| study.case(code)) {
                        // One line if both readings have the same result, else two.
                        @if same(case) {
                            (self.outcome(case, "none", &Reading::BOTH))
                        } @else {
                            (self.outcome(case, "ends", &[chapter]))
                            (self.outcome(case, "goes on", &[sliding_on]))
                        }
                    }
                }
            }
        }
    }

    pub(super) fn outcome(
        &mut self,
        case: &CaseRuns,
        sliding: &str,
        readings: &[Reading],
    ) -> Markup {
        let p = &case.parameters;
        html! {
            tr {
                th scope="row" { (case.code) }
                td.given { (p.r) } td.given { (decimals(anchor_height(p.r, p.a), 3)) } td.given { (p.e) }
                td.given { (p.a) } td.given { (p.b) } td.given { (p.f_o) } td.given { (p.omega) }
                td { (sliding) }
                @for number in outcome(case, readings[0]) { td { (self.link(&number)) } }
                td { (known_to(case, readings[0])) }
                td { @for reading in readings { (self.cite(&run(case.code, *reading))) " " } }
            }
        }
    }

    pub(super) fn critical(&mut self, row: &CriticalRow) -> Markup {
        html! {
            tr {
                th scope="row" { (row.shape) }
                td { (row.r) } td { (row.size[0]) } td { (row.size[1]) }
                td { (decimals(row.published, 2)) }
                @for number in critical_outcome(row) {
                    td class=[(number.key == EXCEEDING).then_some("long")] {
                        @if !number.shown.is_empty() { (self.link(&number)) }
                    }
                }
                td { (self.cite(&critical(row, Reading::Chapter))) " " (self.cite(&probability(row))) }
            }
        }
    }

    pub(super) fn conventions(&mut self, row: &CriticalRow) -> Markup {
        html! {
            tr {
                th scope="row" { (row.shape) }
                td { (row.r) } td { (row.size[0]) } td { (row.size[1]) }
                td { (decimals(row.published, 2)) }
                @for number in by_convention(row) { td { (self.link(&number)) } }
            }
        }
    }

    pub(super) fn sentences(&self) -> Markup {
        html! {
            @for section in &self.chapter.sections {
                tbody {
                    tr { th colspan="3" scope="rowgroup" { "Section " (section.name) } }
                    @for (k, sentence) in section.sentences.iter().enumerate() {
                        tr {
                            td { (k + 1) }
                            td class="long" { "“" (symbols(&sentence.begins)) " …”" }
                            td class="long" {
                                @match &sentence.kind {
                                    Kind::Claims(ids) => {
                                        @for id in ids { a href={ "#claim-" (id) } { (id) } " " }
                                    }
                                    Kind::Definition => { "no claim: a convention, a description or a reference" }
                                    Kind::NotCheckable(why) => { "not checkable: " (why) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// The end of the known part of a row's numbers.
fn known_to(case: &CaseRuns, reading: Reading) -> String {
    match (case.proved.of(reading), case.runs.of(reading).horizon) {
        (None, Some(t)) => format!("t = {}", decimals(t, 2)),
        _ => "the end".to_owned(),
    }
}

/// The number of published values that each convention reproduces.
pub(super) fn agreement(study: &Study) -> Markup {
    let rows = study.critical.iter();
    let mut counts = vec![0; END_TIMES.len() + 2];
    for row in rows {
        let published = decimals(row.published, 2);
        for (count, number) in counts.iter_mut().zip(by_convention(row)) {
            *count += usize::from(number.shown == published);
        }
    }
    html! {
        tr {
            th scope="row" { "equal" }
            td colspan="4" { "to the published" }
            @for count in counts { td { (count) } }
        }
    }
}
