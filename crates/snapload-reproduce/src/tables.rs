//! Tables 6.1 and 6.2: what each row comes to, and both as CSV.

use crate::proved::Proved;
use crate::source::{Number, critical, decimals, probability, proof, run};
use crate::study::{CaseRuns, CriticalRow, Reading, Study};
use snapload::analysis::CriticalForce;
use snapload::{Norms, table_6_1};

/// A norm of a run: name, symbol, value.
type Norm = (&'static str, &'static str, fn(&Norms) -> f64);
pub(crate) const NORMS: [Norm; 5] = [
    ("rho1", "*ρ*₁", |norms| norms.rho1),
    ("rho2", "*ρ*₂", |norms| norms.rho2),
    ("rho3", "*ρ*₃", |norms| norms.rho3),
    ("y_max", "*y*", |norms| norms.y_max),
    ("theta_max", "|*θ*|", |norms| norms.theta_max),
];

/// Where `snapload critical` tells all intervals that exceed.
pub(crate) const EXCEEDING: &str = ".exceeding";

/// The rows of Table 6.1 in its order, then the variants that it prints under other codes: series,
/// code.
pub(crate) fn rows_6_1() -> Vec<(&'static str, &'static str)> {
    let printed = [
        ("a=b (square), as printed", "1911001000-559"),
        ("a=b (square), as printed", "1922001000-559"),
        ("a=b (square), as printed", "1933001000-559"),
        ("a>b (rectangle), as printed", "1911001000-559"),
        ("a>b (rectangle), as printed", "1921001000-559"),
        ("a>b (rectangle), as printed", "1931001000-559"),
    ];
    table_6_1().chain(printed).collect()
}

/// The decimals of a time that is proved; all 25 stand in the table beside the report.
const PROVED_PLACES: usize = 10;

/// What a run comes to: reason, end, number of impacts, as they are proved where they are, and norms.
pub(crate) fn outcome(case: &CaseRuns, reading: Reading) -> Vec<Number> {
    let (run, command) = (case.runs.of(reading), run(case.code, reading));
    let mut numbers = match case.proved.of(reading) {
        Some(proved) => proved_end(proved, &proof(case.code, reading)),
        None => {
            // An impulse passed into a taut cable is no impact.
            let impacts = run.impacts().iter().filter(|impact| impact.v_n > 0.0);
            let snaps = "[.impacts[] | select(.v_n > 0)] | length";
            vec![
                Number::word(run.end().reason.words(), &command, ".end.reason"),
                Number::new(run.end().t, 4, &command, ".end.t"),
                Number::word(impacts.count(), &command, snaps),
            ]
        }
    };
    numbers.extend(NORMS.iter().map(|(name, _, of)| {
        let key = format!(".norms.{name}");
        Number::new(of(run.norms()), 4, &command, key)
    }));
    numbers
}

fn proved_end(proved: &Proved, command: &str) -> Vec<Number> {
    vec![
        Number::word(proved.reason.words(), command, ".end.reason"),
        Number::decimal(&proved.t, PROVED_PLACES, command, ".end.t | tonumber"),
        Number::word(proved.impacts, command, ".impacts | length"),
    ]
}

/// What a row of Table 6.2 comes to: critical force, its difference from the published one, whether
/// that exceeds, from which amplitudes on parts of the neighbours exceed, whether they decide, all
/// intervals.
pub(crate) fn critical_outcome(row: &CriticalRow, reading: Reading) -> Vec<Number> {
    let (found, published) = (row.computed.of(reading), row.published);
    let (made, neighbours) = (critical(row, reading), probability(row, reading));
    let none = |shown: &str, command: &str, key: &str| Number {
        exact: String::new(),
        ..Number::word(shown, command, key)
    };
    let less = format!(".f_cr - {published}");
    let mut numbers = match found.first.map(|first| first.f_o) {
        Some(first) => vec![
            Number::new(first, 2, &made, ".f_cr"),
            Number {
                shown: signed(first - published),
                ..Number::word(format!("{:.2}", first - published), &made, less)
            },
        ],
        None => vec![none("none", &made, ".f_cr"), none("", &made, &less)],
    };
    let within = format!("any(.exceeding[]; .[0] <= {published} and {published} <= .[1])");
    let exceeds = published_exceeds(row, found);
    numbers.push(Number::answer(exceeds, &made, within));
    numbers.extend(
        [("p05", 0.05), ("p50", 0.5), ("p95", 0.95)].map(|(name, part)| {
            let key = format!(".passes.{name}");
            match row.probable.of(reading).passes(part) {
                Some(f_o) => Number::new(f_o, 2, &neighbours, key),
                None => none("none", &neighbours, &key),
            }
        }),
    );
    let agree = format!("all(.probability[]; .f_o > {published} or .part == 0 or .part == 1)");
    numbers.push(Number::answer(row.decidable(reading), &neighbours, agree));
    let exact = intervals(found, "-", "; ", |f_o| f_o.to_string());
    numbers.push(Number {
        shown: intervals(found, "–", ", ", |f_o| decimals(f_o, 2)),
        ..Number::word(exact, &made, EXCEEDING)
    });
    numbers
}

/// Whether the published critical force is among the amplitudes that exceed.
pub(crate) fn published_exceeds(row: &CriticalRow, computed: &CriticalForce) -> bool {
    let inside = |[from, to]: &[f64; 2]| (*from..=*to).contains(&row.published);
    computed.exceeding.iter().any(inside)
}

/// A difference with its sign; none where it vanishes.
fn signed(difference: f64) -> String {
    match format!("{difference:+.2}").as_str() {
        "+0.00" | "-0.00" => "0.00".to_owned(),
        text => text.replace('-', "−"),
    }
}

/// Intervals of amplitudes as text.
fn intervals(found: &CriticalForce, to: &str, and: &str, text: impl Fn(f64) -> String) -> String {
    let interval = |ends: &[f64; 2]| match ends.map(&text) {
        [first, last] if first == last => first,
        [first, last] => format!("{first}{to}{last}"),
    };
    let all: Vec<String> = found.exceeding.iter().map(interval).collect();
    all.join(and)
}

/// Table 6.1 with the outcome of every row, in both readings.
pub(crate) fn csv_6_1(study: &Study) -> String {
    let header = "series,case,reading,end,t,impacts,rho1,rho2,rho3,y_max,theta_max";
    let rows = rows_6_1().into_iter().flat_map(|(series, code)| {
        let case = study.case(code).into_iter();
        case.flat_map(move |case| {
            Reading::BOTH.map(|reading| line(&[series, code], reading, &outcome(case, reading)))
        })
    });
    table(header, rows)
}

/// Table 6.2, computed beside published, in both readings.
pub(crate) fn csv_6_2(study: &Study) -> String {
    let header = "r,shape,a,b,published,reading,computed,difference,published_exceeds,p05,p50,p95,\
                  decidable,exceeding";
    let rows = study.critical.iter().flat_map(|row| {
        let [r, a, b, published] =
            [row.r, row.size[0], row.size[1], row.published].map(|number| number.to_string());
        Reading::BOTH.map(|reading| {
            line(
                &[&r, row.shape, &a, &b, &published],
                reading,
                &critical_outcome(row, reading),
            )
        })
    });
    table(header, rows)
}

fn line(head: &[&str], reading: Reading, numbers: &[Number]) -> String {
    let words = reading.either("sliding ends the run", "sliding goes on");
    let exact = numbers.iter().map(|number| number.exact.as_str());
    let cells: Vec<&str> = head.iter().copied().chain([words]).chain(exact).collect();
    cells.join(",")
}

fn table(header: &str, rows: impl Iterator<Item = String>) -> String {
    let lines = std::iter::once(header.to_owned()).chain(rows);
    lines.map(|line| line + "\n").collect()
}
