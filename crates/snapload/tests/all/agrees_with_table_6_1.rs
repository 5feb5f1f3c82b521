//! The built-in cases against Table 6.1 as printed, misprints included, and against their own
//! codes.
use snapload::{NamedCase, Parameters, Value, named_case, named_cases, table_6_1};

const PRINTED: &str = include_str!("../data/table_6_1.csv");
/// The columns after series and code; h is derived, the rest are keys.
const COLUMNS: [&str; 13] = [
    "r", "h", "e", "a", "b", "x", "vx", "y", "vy", "theta", "vtheta", "f_o", "nu",
];

/// Decodes the code of a case: the value that each of its places stands for.
fn read_code(code: &str) -> Vec<(&'static str, f64)> {
    let (body, forcing) = code.split_once('-').unwrap();
    let tenths = |c: char| f64::from(c.to_digit(10).unwrap()) / 10.0;
    let names = ["r", "e", "a", "b", "x", "vx", "y", "vy", "theta", "vtheta"];
    let mut values: Vec<(&str, f64)> = Vec::new();
    assert_eq!(body.len(), names.len());
    for (name, c) in names.into_iter().zip(body.chars()) {
        values.push(match (name, c) {
            ("r", '1') => ("r", 1.5),
            ("r", '2') => ("r", 2.5),
            ("e", '1') => ("e", 1.0),
            _ => (name, tenths(c)),
        });
    }
    let mut places = forcing.chars();
    values.push(("f_o", tenths(places.next().unwrap())));
    values.push(("nu", tenths(places.next().unwrap())));
    let omega = match places.as_str() {
        "5" => 0.5,
        "75" => 0.75,
        "9" => 0.9,
        "15" => 1.5,
        "20" => 2.0,
        other => panic!("omega {other}"),
    };
    values.push(("omega", omega));
    values
}

fn number(p: &Parameters, key: &str) -> f64 {
    match p.get(key) {
        Some(Value::Number(number)) => number,
        other => panic!("{key} = {other:?}"),
    }
}

fn is_code(case: &NamedCase) -> bool {
    case.code.contains('-') && !case.code.ends_with("example")
}

#[test]
fn every_code_encodes_its_parameters() {
    let codes: Vec<NamedCase> = named_cases().filter(is_code).collect();
    assert_eq!(codes.len(), 27);
    for case in codes {
        for (key, value) in read_code(case.code) {
            assert_eq!(number(&case.parameters, key), value, "{}: {key}", case.code);
        }
    }
}

#[test]
fn every_printed_row_agrees_but_for_the_known_slips() {
    let rows: Vec<Vec<&str>> = PRINTED
        .lines()
        .skip(1)
        .map(|l| l.split(',').collect())
        .collect();
    assert_eq!(rows.len(), table_6_1().count());
    let mut slips = Vec::new();
    for (row, (series, code)) in rows.iter().zip(table_6_1()) {
        assert_eq!((row[0], row[1]), (series, code));
        let p = named_case(code).unwrap().parameters;
        let h = (p.r * p.r - (1.0 - p.a) * (1.0 - p.a)).sqrt();
        let columns = COLUMNS.into_iter().chain(["omega"]);
        for (key, printed) in columns.zip(&row[2..]) {
            let printed: f64 = printed.parse().unwrap();
            let agrees = match key {
                "h" => (h - printed).abs() < 6e-4,
                key => number(&p, key) == printed,
            };
            if !agrees {
                slips.push((series, code, key, printed));
            }
        }
    }
    let misprint = |series, code, key, printed| (series, code, key, printed);
    assert_eq!(
        slips,
        [
            misprint("r", "1921001000-359", "h", 1.200), // a = 0.2 gives 1.269
            misprint("a=b (square)", "1911001000-359", "f_o", 0.5), // six rows print 0.5 under codes of 0.3
            misprint("a=b (square)", "1922001000-359", "f_o", 0.5),
            misprint("a=b (square)", "1933001000-359", "f_o", 0.5),
            misprint("a>b (rectangle)", "1911001000-359", "f_o", 0.5),
            misprint("a>b (rectangle)", "1921001000-359", "f_o", 0.5),
            misprint("a>b (rectangle)", "1931001000-359", "f_o", 0.5),
            misprint("Ω", "1910001000-3515", "h", 2.332), // r = 1.5 gives 1.200
        ]
    );
}

#[test]
fn rows_printed_with_another_force_exist_under_the_code_of_that_force() {
    for (_, code) in table_6_1().filter(|(series, _)| series.starts_with("a")) {
        let (printed, coded) = (code.replace("-359", "-559"), code);
        let printed = named_case(&printed).unwrap().parameters;
        let coded = named_case(coded).unwrap().parameters;
        assert_eq!(printed, Parameters { f_o: 0.5, ..coded });
    }
}

#[test]
fn the_examples_go_on_when_settled() {
    let standard = named_case("1910001000-359").unwrap().parameters;
    assert_eq!(standard, Parameters::STANDARD);
    for (code, f_o) in [("sliding-example", 0.27), ("rocking-example", 0.1)] {
        let case = named_case(code).unwrap().parameters;
        assert_eq!(
            case,
            Parameters {
                f_o,
                stop_when_settled: false,
                ..standard
            }
        );
    }
}

#[test]
fn entries_give_the_parameters_back_and_follow_a_change_of_size() {
    for case in named_cases() {
        assert_eq!(
            Parameters::from_entries(case.entries()).unwrap(),
            case.parameters
        );
        let larger = case
            .entries()
            .into_iter()
            .chain([("a", Value::Number(0.4))]);
        let larger = Parameters::from_entries(larger).unwrap();
        assert_eq!(
            larger.inertia,
            snapload::natural_inertia(0.4, case.parameters.b)
        );
    }
}

#[test]
fn unknown_codes_get_the_nearest() {
    let error = named_case("1910001000-35").unwrap_err().to_string();
    assert!(
        error.contains("\"1910001000-35\"") && error.contains("1910001000-359"),
        "{error}"
    );
    let error = named_case("1910001000-2759").unwrap_err().to_string();
    assert!(error.contains("sliding-example"), "{error}");
    assert!(named_case("").is_err());
}
