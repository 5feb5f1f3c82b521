//! The claims on the page, section by section.

use super::commands::Commands;
use super::symbols;
use crate::claims::{Claim, Verdict};
use crate::section_of;
use crate::source::REPORT;
use maud::{Markup, html};

/// How many claims came to a verdict, and where `claims.json` tells it.
pub(super) fn count(claims: &[Claim], verdict: Verdict, commands: &mut Commands) -> Markup {
    let of_verdict = claims.iter().filter(|claim| claim.verdict == verdict);
    let key = format!(
        "claims.json: map(select(.verdict == \"{}\")) | length",
        verdict.words()
    );
    commands.link(&of_verdict.count().to_string(), REPORT, &key)
}

/// The sections in their order, as the ids name them.
pub(super) fn sections(claims: &[Claim]) -> Vec<&'static str> {
    let mut sections: Vec<&'static str> = claims.iter().map(section_of).collect();
    sections.dedup();
    sections
}

pub(super) fn table(claims: &[Claim], commands: &mut Commands) -> Markup {
    html! {
        section id="claims" {
            h2 { "Every claim of the text, checked" }
            p {
                (claims.len()) " statements, in our words. No verdict is typed in: each comes out of the \
                 computation whose figures stand beside it, by the chapter's reading. Reproduced: "
                (count(claims, Verdict::Reproduced, commands)) ", not reproduced: "
                (count(claims, Verdict::NotReproduced, commands))
                ", not decidable (starts that differ by 1e-12 disagree): "
                (count(claims, Verdict::NotDecidable, commands))
                ". Evidence is computed with the report; in " a href="claims.json" { "claims.json" }
                " it stands under the claim's id."
            }
            div class="wide" {
                table class="claims" {
                    thead { tr { th { "id" } th { "claim" } th { "verdict" } th { "evidence" } } }
                    @for section in sections(claims) {
                        tbody id={ "claims-" (section) } {
                            tr { th colspan="4" scope="rowgroup" { "Section " (section) } }
                            @for claim in claims.iter().filter(|claim| section_of(claim) == section) {
                                (line(claim, commands))
                            }
                        }
                    }
                }
            }
        }
    }
}

fn line(claim: &Claim, commands: &mut Commands) -> Markup {
    let verdict = match claim.verdict {
        Verdict::Reproduced => "yes",
        Verdict::NotReproduced => "no",
        Verdict::NotDecidable => "open",
    };
    let key = format!(
        "claims.json: .[] | select(.id == \"{}\").evidence",
        claim.id
    );
    html! {
        tr id={ "claim-" (claim.id) } {
            td { a.number href={ "#claim-" (claim.id) } { (claim.id) } }
            td class="long" { (symbols(claim.claim)) }
            td { span class={ "verdict " (verdict) } { (claim.verdict.words()) } }
            td class="long" {
                (commands.link(&claim.evidence, REPORT, &key)) " " (commands.cite(REPORT))
                @if !claim.remark.is_empty() { br; i { (symbols(&claim.remark)) } }
            }
        }
    }
}
