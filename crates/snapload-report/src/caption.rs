//! What a case is called above its results: its name, and how it differs from the standard one.

use crate::digits::digits;
use snapload::{CASE, Entries, Parameters, Value};
use snapload_certificate::Decimal;

/// The name of the case, and how it differs from the standard one. Values that were given have all
/// their digits, so that two cases with one caption are the same case; an inertia that follows from
/// the size is rounded.
pub fn case_in_words(name: &str, parameters: &Parameters) -> String {
    case_as_written(name, parameters, &Entries::new(&CASE))
}

/// The same without some keys, which have other values in what it is the title of.
pub fn case_without(varied: &[&str], name: &str, parameters: &Parameters) -> String {
    let entries = Entries::new(&CASE);
    caption(name, parameters, &entries, |key| varied.contains(&key))
}

/// The same for an answer about the numbers as they were written, in `entries`: one that is not the
/// shortest decimal of its double is repeated with all its digits.
pub fn case_as_written(name: &str, parameters: &Parameters, entries: &Entries) -> String {
    caption(name, parameters, entries, |_| false)
}

fn caption(
    name: &str,
    parameters: &Parameters,
    entries: &Entries,
    is_varied: impl Fn(&str) -> bool,
) -> String {
    let differing: Vec<String> = parameters
        .entries()
        .filter(|(key, _)| !is_varied(key))
        .filter_map(|(key, value)| {
            let follows = key == "inertia" && parameters.inertia_follows();
            // The inertia of the size follows from decimals, and is not the shortest one of its
            // double.
            let written = match follows {
                true => entries.written(key),
                false => written_otherwise(entries, key, value.as_ref()),
            };
            if written.is_none() && value == Parameters::STANDARD.get(key) {
                return None;
            }
            let text = match (value?, written) {
                (_, Some(written)) => written.to_owned(),
                (Value::Number(number), None) if follows => digits(number),
                (given, None) => given.to_string(),
            };
            Some(format!("{key} = {text}"))
        })
        .collect();
    if differing.is_empty() {
        return match name {
            "standard case" => "the standard case (1910001000-359)".to_owned(),
            name => format!("{name}: the standard case"),
        };
    }
    let join = if name == "standard case" {
        " with"
    } else {
        ":"
    };
    format!("{name}{join} {}", differing.join(", "))
}

/// The digits in which the value of a key was written, where they are another decimal than the
/// shortest one of its double.
fn written_otherwise<'a>(
    entries: &'a Entries,
    key: &str,
    value: Option<&Value>,
) -> Option<&'a str> {
    let written = entries.written(key)?;
    let shortest = value?.to_string();
    (Decimal::typed(written) != Decimal::typed(&shortest)).then_some(written)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two doubles, however near, have two captions; an inertia of the size is no value of its own.
    #[test]
    fn a_caption_tells_values_apart() {
        let f_o = 0.3_f64.next_up();
        let parameters = Parameters {
            f_o,
            a: 0.3,
            inertia: snapload::natural_inertia(0.3, 0.0),
            ..Parameters::STANDARD
        };
        let caption = case_in_words("standard case", &parameters);
        assert_eq!(
            caption,
            "standard case with a = 0.3, inertia = 0.09, f_o = 0.30000000000000004"
        );
        let mut entries = Entries::new(&CASE);
        entries.set("f_o=0.30000000000000002").expect("a number");
        let caption = case_as_written("standard case", &parameters, &entries);
        assert!(caption.ends_with("f_o = 0.30000000000000002"), "{caption}");
    }

    /// The title of a picture has no value of a key that is on one of its axes.
    #[test]
    fn a_caption_leaves_out_what_is_varied() {
        let parameters = Parameters {
            f_o: 0.6,
            omega: 3.1,
            ..Parameters::STANDARD
        };
        for (varied, caption) in [
            (&["f_o"][..], "standard case with omega = 3.1"),
            (&["e"], "standard case with f_o = 0.6, omega = 3.1"),
            (&["f_o", "omega"], "the standard case (1910001000-359)"),
        ] {
            assert_eq!(case_without(varied, "standard case", &parameters), caption);
        }
    }

    /// A number that is the standard one as a double, but not as it was written, is no standard
    /// case; zeros at its end and powers of ten change nothing.
    #[test]
    fn a_caption_tells_decimals_of_one_double_apart() {
        let caption = |f_o: &str| {
            let mut entries = Entries::new(&CASE);
            entries.set(&format!("f_o={f_o}")).expect("a number");
            case_as_written("standard case", &Parameters::STANDARD, &entries)
        };
        let standard = "the standard case (1910001000-359)";
        for text in [
            "0.3000000000000000000",
            "+0.300000000000000000",
            "3.0000000000000000000e-1",
            "30000000000000000000e-20",
        ] {
            assert_eq!(caption(text), standard, "{text}");
        }
        for text in ["0.30000000000000001", "3.00000000000000000001e-1"] {
            assert_eq!(caption(text), format!("standard case with f_o = {text}"));
        }
    }

    /// Doubles from 8 to 16 are 2^-49 = 1.8e-15 apart, so that sixteen digits do not tell all from
    /// each other: 9.000000000000001 and 9.000000000000002 are both 9 + 2^-49.
    #[test]
    fn a_caption_tells_short_decimals_of_one_double_apart() {
        let texts = ["9.000000000000001", "9.000000000000002"];
        for text in texts {
            let omega: f64 = text.parse().expect("a number");
            assert_eq!(omega, 9.0 + 2_f64.powi(-49));
            let mut entries = Entries::new(&CASE);
            entries.set(&format!("omega={text}")).expect("a number");
            let parameters = Parameters {
                omega,
                ..Parameters::STANDARD
            };
            let caption = case_as_written("standard case", &parameters, &entries);
            assert_eq!(caption, format!("standard case with omega = {text}"));
        }
    }

    /// The inertia of a size of 0.1 is 0.01, whose double is not that of 0.1 * 0.1.
    #[test]
    fn a_caption_tells_an_inertia_that_was_written_from_that_of_the_size() {
        let text = "0.010000000000000002";
        assert_eq!(text.parse(), Ok(0.1 * 0.1));
        let mut entries = Entries::new(&CASE);
        entries.set(&format!("inertia={text}")).expect("a number");
        let caption = case_as_written("standard case", &Parameters::STANDARD, &entries);
        assert_eq!(caption, format!("standard case with inertia = {text}"));
    }
}
