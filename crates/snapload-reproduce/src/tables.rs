//! Tables 6.1 and 6.2: the results of each row, and both as CSV.

use crate::critical_row::CriticalRow;
use crate::proved::Proved;
use crate::source::{Number, REPORT, amplitude, critical, decimals, probability, proof, run, scan};
use crate::study::{CaseRuns, Reading, Study};
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

/// The place of all intervals that exceed in the JSON of `snapload critical`.
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

/// The number of decimals shown for a proved time; all 25 are in the table beside the report.
const PROVED_PLACES: usize = 10;

/// The results of a run: reason, end, number of impacts, and norms. They are proved, and from the
/// run of many digits, if the run ends before a cable stays taut; otherwise they are those of
/// doubles, marked if they are past the horizon.
pub(crate) fn outcome(case: &CaseRuns, reading: Reading) -> Vec<Number> {
    match case.proved.of(reading) {
        Some(proved) => known(case, reading, proved),
        None => in_doubles(case, reading),
    }
}

fn known(case: &CaseRuns, reading: Reading, proved: &Proved) -> Vec<Number> {
    let (command, norms) = (proof(case.code, reading), case.exact.norms());
    // Snap velocities are the third value of each line.
    let velocities = ".impacts | map(.[2] | tonumber)";
    let early = ".impacts | map(select((.[1] | tonumber) <= 10) | .[2] | tonumber)";
    let mut numbers = vec![
        Number::word(proved.reason.label(), &command, ".end.reason"),
        Number::decimal(&proved.t, PROVED_PLACES, &command, ".end.t | tonumber"),
        Number::word(proved.impacts, &command, ".impacts | length"),
        Number::new(norms.rho1, 4, &command, format!("{velocities} | max")),
        Number::new(norms.rho2, 4, &command, format!("{early} | add")),
        Number::new(norms.rho3, 4, &command, format!("{velocities} | add")),
    ];
    // Values that are not in a certificate. If doubles give the same digits, their command is
    // shown.
    let doubles = case.runs.of(reading).run.norms();
    for (name, _, of) in &NORMS[3..] {
        let exact = Number::new(
            of(norms),
            4,
            REPORT,
            format!("table-6-1.csv: {name} of {}", case.code),
        );
        let key = format!(".norms.{name}");
        let doubles = Number::new(of(doubles), 4, &run(case.code, reading), key);
        numbers.push(if exact.shown == doubles.shown {
            doubles
        } else {
            exact
        });
    }
    numbers
}

fn in_doubles(case: &CaseRuns, reading: Reading) -> Vec<Number> {
    let (known, command) = (case.runs.of(reading), run(case.code, reading));
    let run = &known.run;
    // An impulse that is passed into a taut cable is not an impact.
    let impacts = run.impacts().iter().filter(|impact| impact.v_n > 0.0);
    let snaps = "[.impacts[] | select(.v_n > 0)] | length";
    let mut numbers = vec![
        Number::word(run.end().reason.label(), &command, ".end.reason"),
        Number::new(run.end().t, 4, &command, ".end.t"),
        Number::word(impacts.count(), &command, snaps),
    ];
    numbers.extend(NORMS.map(|(name, _, of)| {
        let key = format!(".norms.{name}");
        Number::new(of(run.norms()), 4, &command, key)
    }));
    match known.horizon {
        Some(_) => numbers.into_iter().map(Number::mark_past_horizon).collect(),
        None => numbers,
    }
}

/// The results of an entry of Table 6.2 in the chapter's reading: critical force and its difference
/// from the published one, whether the published one exceeds, all proved; the first amplitudes at
/// which parts of the neighbours exceed, the verdict, and all intervals in doubles.
pub(crate) fn critical_outcome(row: &CriticalRow) -> Vec<Number> {
    let published = row.published;
    let (made, neighbours) = (critical(row, Reading::Chapter), probability(row));
    let none = |shown: &str, command: &str, key: &str| Number {
        exact: String::new(),
        ..Number::word(shown, command, key)
    };
    let mut numbers = match row.first() {
        Some((first, _)) => {
            let command = amplitude(row, first);
            let less = format!(".case.f_o - {published}");
            vec![
                Number::new(first, 2, &command, ".case.f_o"),
                Number {
                    shown: signed(first - published),
                    ..Number::word(format!("{:.2}", first - published), &command, less)
                },
            ]
        }
        None => vec![none("none", &made, ".f_cr"), none("", &made, ".f_cr")],
    };
    numbers.push(match row.at_published() {
        Some(proved) => Number::word(
            proved.reason.label(),
            &amplitude(row, published),
            ".end.reason",
        ),
        None => none("open", &amplitude(row, published), ".end.reason"),
    });
    numbers.extend(
        [("p05", 0.05), ("p50", 0.5), ("p95", 0.95)].map(|(name, part)| {
            let key = format!(".passes.{name}");
            match row.probable.passes(part) {
                Some(f_o) => Number::new(f_o, 2, &neighbours, key),
                None => none("none", &neighbours, &key),
            }
        }),
    );
    let key = format!("table-6-2.csv: verdict of {}", shape(row));
    numbers.push(Number::word(row.verdict().label(), REPORT, key));
    let found = &row.computed.chapter;
    let exact = intervals(found, "-", "; ", |f_o| f_o.to_string());
    numbers.push(Number {
        shown: intervals(found, "–", ", ", |f_o| decimals(f_o, 2)),
        ..Number::word(exact, &made, EXCEEDING)
    });
    numbers
}

/// The shape of a row and its cables, as in the report.
fn shape(row: &CriticalRow) -> String {
    format!("r = {}, {} x {}", row.r, row.size[0], row.size[1])
}

/// Possible end times of runs, on which the critical force depends.
pub(crate) const END_TIMES: [f64; 4] = [18.0, 25.0, 50.0, 100.0];

/// The critical force of a row by convention: in the chapter's reading with each end time, proved;
/// if sliding continues, and if only the two limits end a run, in doubles.
pub(crate) fn by_convention(row: &CriticalRow) -> Vec<Number> {
    let none = |command: &str| Number::word("none", command, ".f_cr");
    let mut numbers: Vec<Number> = END_TIMES
        .into_iter()
        .map(|t_end| match row.first_by(t_end) {
            Some((f_o, _)) => Number::new(f_o, 2, &amplitude(row, f_o), ".case.f_o"),
            None => {
                let key = format!("table-6-2.csv: t_end_{t_end} of {}", shape(row));
                Number::word("none", REPORT, key)
            }
        })
        .collect();
    let sliding_on = critical(row, Reading::SlidingOn);
    let alone = format!(
        "{} --set stop_when_settled=false --json -",
        scan(row, Reading::SlidingOn)
    );
    let firsts = [
        (
            sliding_on,
            row.computed.sliding_on.first.map(|first| first.f_o),
        ),
        (alone, row.limits_alone.map(|(f_o, _)| f_o)),
    ];
    numbers.extend(firsts.map(|(command, first)| match first {
        Some(f_o) => Number::new(f_o, 2, &command, ".f_cr"),
        None => none(&command),
    }));
    numbers
}

/// A difference with its sign; without one if it is zero.
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
    let header = "series,case,reading,known_to,end,t,impacts,rho1,rho2,rho3,y_max,theta_max";
    let rows = rows_6_1().into_iter().flat_map(|(series, code)| {
        let case = study.case(code).into_iter();
        case.flat_map(move |case| {
            Reading::BOTH.map(|reading| {
                let words = reading.either("sliding ends the run", "sliding goes on");
                let known = match (case.proved.of(reading), case.runs.of(reading).horizon) {
                    (None, Some(t)) => t.to_string(),
                    _ => "end".to_owned(),
                };
                cells(&[series, code, words, &known], &outcome(case, reading))
            })
        })
    });
    table(header, rows)
}

/// Table 6.2, with computed and published values, and by convention.
pub(crate) fn csv_6_2(study: &Study) -> String {
    let header = "r,shape,a,b,published,proved,difference,published_ends,p05,p50,p95,verdict,exceeding_in_doubles,\
                  t_end_18,t_end_25,t_end_50,t_end_100,sliding_on,limits_alone";
    let rows = study.critical.iter().map(|row| {
        let [r, a, b, published] =
            [row.r, row.size[0], row.size[1], row.published].map(|number| number.to_string());
        let numbers = [critical_outcome(row), by_convention(row)].concat();
        cells(&[&r, row.shape, &a, &b, &published], &numbers)
    });
    table(header, rows)
}

fn cells(head: &[&str], numbers: &[Number]) -> String {
    let exact = numbers.iter().map(|number| number.exact.as_str());
    // Some names of series contain a comma; none contains a quote.
    let quoted = |cell: &str| match cell.contains(',') {
        true => format!("\"{cell}\""),
        false => cell.to_owned(),
    };
    let cells: Vec<String> = head.iter().copied().chain(exact).map(quoted).collect();
    cells.join(",")
}

fn table(header: &str, rows: impl Iterator<Item = String>) -> String {
    let lines = std::iter::once(header.to_owned()).chain(rows);
    lines.map(|line| line + "\n").collect()
}
