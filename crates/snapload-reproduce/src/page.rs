//! The report as one self-contained page of HTML: the text of `data/page.html`, with the computed
//! values that it names in braces.

mod rows;

use crate::ReportError;
use crate::claims::{Claim, FEW, MANY, ROUNDING, Verdict};
use crate::critical_row::{CriticalRow, NEIGHBOURS};
use crate::example_steps::{self, steps};
use crate::figures::{Figure, Row};
use crate::sentences::{Chapter, Kind};
use crate::source::{Number, REPORT, decimals};
use crate::study::{CaseRuns, Study};
use crate::tables::END_TIMES;
use maud::{Markup, PreEscaped, html};

/// The symbols that plain text writes with an underscore, with their typeset form.
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

const VERDICTS: [Verdict; 4] = [
    Verdict::Reproduced,
    Verdict::Mixed,
    Verdict::NotReproduced,
    Verdict::NotDecidable,
];

/// Plain text with its symbols typeset.
fn symbols(text: &str) -> Markup {
    let escaped = html! { (text) }.into_string();
    let set = |text: String, (plain, marked): &(&str, &str)| text.replace(plain, marked);
    PreEscaped(SYMBOLS.iter().fold(escaped, set))
}

/// The page.
pub(crate) fn page(
    study: &Study,
    figures: &[Row<Figure>],
    claims: &[Claim],
) -> Result<String, ReportError> {
    let mut page = Page {
        study,
        figures,
        claims,
        chapter: Chapter::read(claims)?,
        commands: Vec::new(),
    };
    let mut text = String::new();
    for line in include_str!("../data/page.html").lines().map(str::trim) {
        // A line break between words is a space, between tags it is nothing.
        let between_tags = text.ends_with('>') && line.starts_with(['<', '{']);
        if !text.is_empty() && !between_tags {
            text.push(' ');
        }
        for (k, part) in line.split(['{', '}']).enumerate() {
            if k % 2 == 0 {
                text.push_str(part);
            } else {
                text.push_str(&page.computed(part)?.into_string());
            }
        }
    }
    Ok(text)
}

/// The data of the page, and the commands that it has mentioned so far.
struct Page<'a> {
    study: &'a Study,
    figures: &'a [Row<Figure>],
    claims: &'a [Claim],
    chapter: Chapter,
    commands: Vec<String>,
}

impl Page<'_> {
    /// The content for a name in braces.
    fn computed(&mut self, name: &str) -> Result<Markup, ReportError> {
        let found = self.word(name).or_else(|| self.block(name));
        found.ok_or_else(|| ReportError::Missing(format!("“{name}”")))
    }

    /// A number or a word within a sentence.
    fn word(&mut self, name: &str) -> Option<Markup> {
        let rows = &self.study.critical;
        let differences = || {
            let first = rows
                .iter()
                .filter_map(|row| Some(row.first()?.0 - row.published));
            first.map(f64::abs)
        };
        let exceeds = |row: &&CriticalRow| {
            row.at_published()
                .is_some_and(|proved| proved.reason.exceeds())
        };
        let of_verdict = |verdict| {
            rows.iter()
                .filter(move |row| row.verdict() == verdict)
                .count()
        };
        let count = match name {
            "version" => return Some(html! { (env!("CARGO_PKG_VERSION")) }),
            "report" => return Some(html! { (REPORT) }),
            "horizons" => return Some(html! { (self.horizons()) }),
            "starts" => return Some(html! { (FEW) " or " (MANY) }),
            "rounding" => return Some(html! { (format!("{ROUNDING:e}").replace('-', "−")) }),
            "worst end" => return Some(html! { (decimals(self.worst_end(), 2)) }),
            "miscounted" => self.miscounted(),
            "runs" => self.study.cases.len(),
            "statements" => self.claims.len(),
            "published" => rows.len(),
            "equal" => differences().filter(|d| *d < 0.005).count(),
            "close" => differences().filter(|d| *d < 0.035).count(),
            "exceeding" => rows.iter().filter(exceeds).count(),
            "entries reproduced" => of_verdict(Verdict::Reproduced),
            "entries not reproduced" => of_verdict(Verdict::NotReproduced),
            "entries open" => of_verdict(Verdict::NotDecidable),
            "neighbours" => NEIGHBOURS as usize,
            "sentences" => self.chapter.count(|_| true),
            "sentences claimed" => self.chapter.count(|kind| matches!(kind, Kind::Claims(_))),
            "sentences defining" => self.chapter.count(|kind| matches!(kind, Kind::Definition)),
            "sentences unchecked" => self
                .chapter
                .count(|kind| matches!(kind, Kind::NotCheckable(_))),
            symbol if SYMBOLS.iter().any(|(plain, _)| *plain == symbol) => {
                return Some(symbols(symbol));
            }
            words => {
                // The number of claims with a verdict.
                let verdict = VERDICTS
                    .into_iter()
                    .find(|verdict| verdict.label() == words)?;
                let claims = self.claims.iter().filter(|claim| claim.verdict == verdict);
                let key = format!("claims.json: map(select(.verdict == \"{words}\")) | length");
                return Some(self.link(&Number::word(claims.count(), REPORT, key)));
            }
        };
        Some(html! { (count) })
    }

    /// The numbers of impacts after which the runs of Table 6.1 are past their horizons in doubles.
    fn horizons(&self) -> String {
        let cases = self.study.cases.iter();
        let horizons = cases.filter_map(|case| case.runs.chapter.first_unknown);
        let horizons: Vec<usize> = horizons.collect();
        match (horizons.iter().min(), horizons.iter().max()) {
            (Some(least), Some(most)) => format!("{least} to {most}"),
            _ => "no".to_owned(),
        }
    }

    /// The largest error of the end of a run in doubles, where it is proved.
    fn worst_end(&self) -> f64 {
        let cases = self.study.cases.iter();
        let off = cases.filter_map(|case| {
            let proved = case.proved.chapter?;
            Some((case.runs.chapter.run.end().t - proved.time()).abs())
        });
        off.fold(0.0, f64::max)
    }

    /// The number of runs whose number of impacts in doubles differs from the proved one.
    fn miscounted(&self) -> usize {
        let cases = self.study.cases.iter();
        let differs = |case: &&CaseRuns| {
            let impacts = case.runs.chapter.run.impacts().iter();
            let snaps = impacts.filter(|impact| impact.v_n > 0.0).count();
            case.proved
                .chapter
                .is_some_and(|proved| proved.impacts != snaps)
        };
        cases.filter(differs).count()
    }

    /// A block of the page.
    fn block(&mut self, name: &str) -> Option<Markup> {
        let (study, figures, claims) = (self.study, self.figures, self.claims);
        Some(match name {
            "style" => PreEscaped(include_str!("../data/report.css").to_owned()),
            "contents of figures" => html! {
                @for row in figures {
                    li {
                        (row.title) ": "
                        @for Figure { number, picture, .. } in &row.figures {
                            a href={ "#" (picture.name) } { "Fig. " (number) } " "
                        }
                    }
                }
            },
            "contents of claims" => html! {
                @for (section, _) in sections(claims) { a href={ "#claims-" (section) } { (section) } " " }
            },
            "rows of 6.1" => self.table_6_1(),
            "rows of 6.2" => html! {
                @for row in &study.critical { (self.critical(row)) }
            },
            "heads of conventions" => html! {
                @for t_end in END_TIMES { th { "t ≤ " (t_end) } }
            },
            "rows of conventions" => html! {
                @for row in &study.critical { (self.conventions(row)) }
                (rows::agreement(study))
            },
            "sentences table" => self.sentences(),
            "figures" => html! {
                @for Row { title, columns, figures } in figures {
                    section {
                        h2 { (title) }
                        div class={ "figures of-" (columns) } {
                            @for figure in figures { (self.figure(figure)) }
                        }
                    }
                }
            },
            "story of sliding" => self.example_steps("sliding-example"),
            "story of rocking" => self.example_steps("rocking-example"),
            "claims" => html! {
                @for (section, claims) in sections(claims) {
                    tbody id={ "claims-" (section) } {
                        tr { th colspan="4" scope="rowgroup" { "Section " (section) } }
                        @for claim in claims { (self.claim(claim)) }
                    }
                }
            },
            "commands" => html! {
                @for (k, text) in self.commands.iter().enumerate() {
                    li id={ "command-" (k + 1) } { (command(text)) }
                }
            },
            _ => return None,
        })
    }

    /// The number of a command in the list at the end, which is in the order of mention.
    fn place(&mut self, command: &str) -> usize {
        let known = self.commands.iter().position(|text| text == command);
        1 + known.unwrap_or_else(|| {
            self.commands.push(command.to_owned());
            self.commands.len() - 1
        })
    }

    /// A number as a link to the command that reproduces it.
    fn link(&mut self, number: &Number) -> Markup {
        let Number { command, key, .. } = number;
        let place = self.place(command);
        html! {
            a.number href={ "#command-" (place) } title={ (command) " → " (key) } data-key=(key) { (number.shown) }
        }
    }

    /// A reference such as \[12\], which is also visible on paper.
    fn cite(&mut self, command: &str) -> Markup {
        let place = self.place(command);
        html! { a.cite href={ "#command-" (place) } title=(command) { "[" (place) "]" } }
    }

    fn figure(&mut self, figure: &Figure) -> Markup {
        let (picture, about) = (&figure.picture, &figure.about);
        let data = format!("figures/{}.csv", picture.name);
        html! {
            figure id=(picture.name) {
                div.drawing { (PreEscaped(picture.svg())) }
                figcaption {
                    b { "Fig. " (figure.number) ". " } (symbols(&about.caption))
                    @for (k, (name, number)) in about.numbers.iter().enumerate() {
                        @if k > 0 { "," }
                        " " (name) (self.link(number))
                    }
                    @if !about.numbers.is_empty() { "." }
                    @for source in &about.sources {
                        div.source {
                            (self.cite(&source.command)) " "
                            @if !source.part.is_empty() { (source.part) ": " }
                            (command(&source.command)) " → " code { (source.place) }
                        }
                    }
                    div.source { "Data: " a href=(data) { (data) } }
                }
            }
        }
    }

    fn example_steps(&mut self, code: &str) -> Markup {
        let made = example_steps::proof(code);
        html! {
            ol {
                @for (begins, what) in steps(code) {
                    li {
                        @match &begins {
                            Some(t) => { "t = " (self.link(t)) }
                            None => { "t = 0" }
                        }
                        ": " (what) "."
                    }
                }
            }
            div.source { (self.cite(&made)) " " (command(&made)) " → " code { ".impacts" } }
        }
    }

    fn claim(&mut self, claim: &Claim) -> Markup {
        let id = claim.id;
        let class = match claim.verdict {
            Verdict::Reproduced => "yes",
            Verdict::NotReproduced => "no",
            Verdict::Mixed => "mixed",
            Verdict::NotDecidable => "open",
        };
        let key = format!("claims.json: .[] | select(.id == \"{id}\").evidence");
        html! {
            tr id={ "claim-" (id) } {
                td { a.number href={ "#claim-" (id) } { (id) } }
                td class="long" { (symbols(claim.claim)) }
                td { span class={ "verdict " (class) } { (claim.verdict.label()) } }
                td class="long" {
                    (self.link(&Number::word(&claim.evidence, REPORT, key))) " " (self.cite(REPORT))
                    @if !claim.judged.is_empty() { br; span.judged { (symbols(&claim.judged)) } }
                    @if !claim.remark.is_empty() { br; i { (symbols(&claim.remark)) } }
                }
            }
        }
    }
}

/// The sections in their order, with their claims.
fn sections(claims: &[Claim]) -> impl Iterator<Item = (&str, &[Claim])> {
    let sections = claims.chunk_by(|p, q| p.section == q.section);
    sections.map(|claims| (claims[0].section, claims))
}

/// A command that may be broken at its spaces only, never after a hyphen.
fn command(text: &str) -> Markup {
    html! {
        code.command {
            @for (k, word) in text.split(' ').enumerate() {
                @if k > 0 { " " }
                span { (word) }
            }
        }
    }
}
