//! The answers in a few lines of text.

use super::verdict::end_text;
use crate::physics::elastic::{ElasticLine, Pull, damping_ratio};
use crate::physics::equilibrium::Equilibrium;
use crate::physics::model::Scales;
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::periods::{NaturalPeriods, periods_text};
use crate::physics::snap::{SLOWEST_M_S, Snap};
use crate::physics::warning::Warning;
use crate::physics::wave::LinearWave;
use crate::runs::assess::Assessment;
use crate::runs::design::{Answer, Check};
use crate::runs::elastic_comparison::{ElasticComparison, Inextensible};
use crate::runs::outcome::Outcome;
use crate::runs::quantile::{quantile, slack_part};
use crate::runs::seas::{Lines, Seas};
use crate::runs::three_hours::NoDistribution;
use crate::runs::variations::{ByWave, VerdictNumbers};
use crate::structure::{Structure, Water};
use crate::text_layout::{count, decimals, digits, kilo, lay_out, rate_text, ratio, tenths};
use askama::Template;

/// The number of pulls and snaps that are listed; JSON has them all.
const LISTED: usize = 12;

#[derive(Template)]
#[template(path = "assess.txt")]
struct AssessText<'a> {
    name: &'a str,
    prepared: &'a ModelAtRest,
    structure: &'a Structure,
    rest: &'a Equilibrium,
    scales: &'a Scales,
    wave: Option<(&'a LinearWave, [f64; 3])>,
    periods: Option<&'a NaturalPeriods>,
    outcome: &'a Outcome,
    utilisations: Vec<Option<f64>>,
    end: &'static str,
    rebound: String,
    waves: Option<String>,
    checks: Vec<(Check, usize)>,
    neighbours: &'a usize,
    warnings: &'a [Warning],
    trust: String,
    verdict: String,
}

#[derive(Template)]
#[template(path = "seas.txt")]
struct SeasText<'a> {
    name: &'a str,
    structure: &'a Structure,
    seas: &'a Seas,
    /// The largest tension of each line, where it is known.
    largest_n: Vec<Option<f64>>,
    speeds_m_s: [f64; 3],
}

#[derive(Template)]
#[template(path = "elastic.txt")]
struct ElasticText<'a> {
    name: &'a str,
    comparison: &'a ElasticComparison,
    /// What ended it early.
    end: Option<&'static str>,
    /// What ended the run on inextensible lines early, and when \[s\].
    other_end: Option<(&'static str, f64)>,
    e: f64,
    zeta: f64,
    /// Spring rate, damping, part of the time slack, and peak of each line; and its part of the
    /// time slack if it is inextensible.
    lines: Vec<([f64; 4], Option<f64>)>,
    rows: Vec<String>,
    /// The number of snaps of inextensible lines.
    snaps: usize,
    /// The hardest of them by the complete estimate, the line's own mass included \[N\].
    hardest_n: Option<f64>,
    all: usize,
}

/// In how many neighbours a check has the answer of the run, unless in all.
fn agreeing_text(check: &Check, agreeing: &usize, neighbours: &usize) -> String {
    match check.answer {
        _ if agreeing == neighbours => String::new(),
        Answer::Open => {
            format!("; {agreeing} of {neighbours} neighbours have the answer of this run")
        }
        _ => format!(", in {agreeing} of {neighbours} neighbours"),
    }
}

impl Assessment {
    /// The answer in a few lines; `name` is that of the case.
    pub fn summary(&self, name: &str) -> String {
        let prepared = &self.prepared;
        lay_out(&AssessText {
            name,
            prepared,
            structure: &prepared.structure,
            rest: &prepared.rest,
            scales: &prepared.model.scales,
            wave: prepared.model.regular_wave(),
            periods: self.periods.as_ref(),
            outcome: &self.outcome,
            utilisations: self.utilisations(),
            end: end_text(self.outcome.stop),
            rebound: self.rebound_text(),
            waves: self.waves_text(),
            checks: self.checks(),
            neighbours: &self.neighbours.len(),
            warnings: &self.warnings,
            trust: self.trust_text(),
            verdict: self.verdict().words,
        })
    }

    /// The numbers behind the verdict with less and with more restitution, in words.
    pub fn rebound_text(&self) -> String {
        let rows = self.by_restitution();
        let numbers: Vec<_> = rows.iter().map(|row| row.numbers).collect();
        let Some((what, values)) = compared(&numbers) else {
            return "nothing is judged with a lower or higher restitution either".to_owned();
        };
        let restitutions: Vec<_> = rows.iter().map(|row| ratio(&row.restitution)).collect();
        let [values, restitutions] = [values, restitutions].map(|all| all.join(", "));
        format!("{what} {values} with a restitution of {restitutions}")
    }

    /// The numbers behind the verdict in slightly other regular waves, in words; none where these
    /// are not run.
    pub fn waves_text(&self) -> Option<String> {
        let rows = self.by_wave();
        let own = *rows.first()?;
        let numbers: Vec<_> = rows.iter().map(|row| row.numbers).collect();
        let Some((what, values)) = compared(&numbers) else {
            return Some("nothing is judged in slightly other waves either".to_owned());
        };
        let group = |of: fn(&ByWave) -> f64, other: fn(&ByWave) -> f64| {
            let all = rows.iter().zip(&values);
            let mut all: Vec<_> = all.filter(|(row, _)| other(row) == other(&own)).collect();
            all.sort_by(|(a, _), (b, _)| of(a).total_cmp(&of(b)));
            let sizes: Vec<_> = all.iter().map(|(row, _)| of(row).to_string()).collect();
            let values: Vec<_> = all.iter().map(|(_, value)| value.as_str()).collect();
            (values.join(", "), sizes.join(", "))
        };
        let (by_height, heights) = group(|row| row.height_m, |row| row.period_s);
        let (by_period, periods) = group(|row| row.period_s, |row| row.height_m);
        Some(format!(
            "{what} {by_height} with a height of {heights} m; {by_period} with a period of {periods} s"
        ))
    }
}

/// What verdicts are compared by, and its value in each, in words; none where nothing is judged.
fn compared(numbers: &[VerdictNumbers]) -> Option<(&'static str, Vec<String>)> {
    // Without a stiffness a utilisation is known only where nothing snaps: rows that can be
    // compared show the speeds, which every judged run has.
    let mut judged = numbers.iter().filter(|of| of.fastest_snap_m_s.is_some());
    let by_tension = judged.all(|of| of.largest_utilisation.is_some());
    let what = match by_tension {
        true => "largest utilisation",
        false => "fastest snap (m/s)",
    };
    let value = |of: &VerdictNumbers| match by_tension {
        true => of.largest_utilisation,
        false => of.fastest_snap_m_s,
    };
    let in_words = |of: &VerdictNumbers| match value(of) {
        Some(value) if of.cut_short => format!("at least {}", ratio(&value)),
        Some(value) => ratio(&value),
        None => "not judged".to_owned(),
    };
    let known = numbers.iter().any(|of| value(of).is_some());
    known.then(|| (what, numbers.iter().map(in_words).collect()))
}

impl Seas {
    /// The answer in a few lines; `name` is that of the case.
    pub fn summary(&self, name: &str) -> String {
        let speeds = self.all_speeds_m_s();
        lay_out(&SeasText {
            name,
            structure: &self.prepared.structure,
            seas: self,
            largest_n: self.largest_of_lines_n(),
            speeds_m_s: [0.5, 0.99, 1.0].map(|part| quantile(&speeds, part).unwrap_or(0.0)),
        })
    }

    /// The tension at rest of a line that carries more there, as lines stretch, than the `largest`
    /// of the motion on inextensible lines \[N\].
    fn stretched_beyond(&self, line: &usize, largest: &f64) -> Option<f64> {
        let at_rest = self.prepared.rest.stretched_n(*line)?;
        (self.lines == Lines::Inextensible && at_rest > *largest).then_some(at_rest)
    }
}

impl ElasticComparison {
    /// Spring rate \[N/m\] and damping \[N s/m\] of an elastic line.
    pub fn si(&self, elastic_line: &ElasticLine) -> [f64; 2] {
        let scales = &self.prepared.model.scales;
        let unit = scales.force_n / scales.length_m;
        [
            elastic_line.rate * unit,
            elastic_line.damping * unit * scales.time_s,
        ]
    }

    /// The answer in a few lines, with the first pulls and snaps side by side; `name` is that of
    /// the case.
    pub fn summary(&self, name: &str) -> String {
        let pulls = &self.elastic.pulls;
        let other = self.inextensible.as_ref();
        let snaps = other.map_or(&[][..], |other| &other.snaps[..]);
        let row = |row: usize| {
            let left = pulls.get(row).map_or(String::new(), pull_text);
            let right = snaps.get(row).map_or(String::new(), snap_text);
            format!("{left:<47}{right}")
        };
        let all = pulls.len().max(snaps.len());
        let elastic_lines = self.elastic_lines.iter().enumerate();
        let lines = elastic_lines.map(|(line, elastic_line)| {
            let [rate, damping] = self.si(elastic_line);
            let (slack, peak) = (
                self.elastic.slack_fraction(line),
                self.elastic.peaks_n[line],
            );
            let unstretched = other.map(|other| other.slack_fraction[line]);
            ([rate, damping, slack, peak], unstretched)
        });
        let e = self.prepared.structure.restitution;
        lay_out(&ElasticText {
            name,
            comparison: self,
            end: self.elastic.stop.map(end_text),
            other_end: other
                .and_then(Inextensible::ended_early)
                .map(|(stop, end_s)| (end_text(stop), end_s)),
            e,
            zeta: damping_ratio(e),
            lines: lines.collect(),
            snaps: snaps.len(),
            hardest_n: snaps.iter().filter_map(|snap| snap.peak_n).reduce(f64::max),
            rows: (0..all.min(LISTED)).map(row).collect(),
            all,
        })
    }
}

/// The position and rotation of a body at rest.
fn rest_text(rest: &Equilibrium) -> String {
    let [x, z] = rest.place_m.map(|coordinate| decimals(&coordinate, 3));
    if !rest.rests {
        return format!(
            "not known, as no line holds the body in surge, and at the surge of its start it would not float without \
             tension; starts at x = {x} m, z = {z} m"
        );
    }
    let turned = decimals(&rest.theta_rad.to_degrees(), 2);
    let either = match rest.either_side {
        true => " or as far to the other side, where the lines carry one another's loads",
        false => "",
    };
    format!("x = {x} m, z = {z} m, turned by {turned} degrees{either}")
}

/// The troughs of all waves of tension: how many of them are slack, and the lowest of the others.
fn troughs_text(sorted_n: &[f64]) -> String {
    let slack = slack_part(sorted_n);
    let mut parts = Vec::new();
    if slack > 0.0 {
        parts.push(format!("slack (0 kN) in {:.1} %", 100.0 * slack));
    }
    let quantiles = [(0.5, "half below"), (0.01, "99 % above")];
    for (value, what) in quantiles.map(|(part, what)| (quantile(sorted_n, part), what)) {
        // Slack troughs are reported already.
        if let Some(value) = value.filter(|value| *value > 0.0) {
            parts.push(format!("{what} {} kN", kilo(&value, 0)));
        }
    }
    parts.join(", ")
}

fn pull_text(pull: &Pull) -> String {
    let rebound = pull
        .rebound_m_s
        .map_or("-".to_owned(), |speed| digits(&speed, 2));
    format!(
        // A blank before each column, so that long numbers do not run together.
        "  {:>4} {:>7.3} {:>7.3} {:>7} {:>7} {rebound:>9}",
        pull.line + 1,
        pull.from_s,
        pull.to_s,
        decimals(&pull.speed_m_s, 3),
        kilo(&pull.peak_n, 0)
    )
}

fn snap_text(snap: &Snap) -> String {
    let peak = snap
        .energy_peak_n
        .map_or("-".to_owned(), |peak| kilo(&peak, 0));
    format!(
        "{:>6} {:>7.3} {:>7.3} {peak:>7}",
        snap.line + 1,
        snap.t_s,
        snap.speed_m_s
    )
}
