//! Whole numbers as options: what is refused is told as what is wrong with a key is.
use clap::builder::ValueParser;
use clap::error::{ContextKind, ContextValue};
use std::error::Error;
use std::fmt::Display;
use std::str::FromStr;

/// Reads a whole number from `low` to `high`.
pub(crate) fn whole<T>(low: T, high: T) -> ValueParser
where
    T: FromStr + PartialOrd + Display + Copy + Send + Sync + 'static,
{
    ValueParser::from(move |text: &str| {
        let number = text.trim().parse::<T>().ok();
        number
            .filter(|number| (low..=high).contains(number))
            .ok_or_else(|| format!("allowed: a whole number from {low} to {high}"))
    })
}

/// What is wrong with the value of an option, with its name, the value, and what is allowed; none
/// where the parser does not say what is.
pub(crate) fn refusal(error: &clap::Error) -> Option<String> {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let option = text(ContextKind::InvalidArg)?.split_whitespace().next()?;
    let value = text(ContextKind::InvalidValue)?;
    let allowed = match error.source()?.to_string() {
        said if said.starts_with("allowed: ") => said,
        said if said == "invalid float literal" => "allowed: a number".to_owned(),
        said if said == "invalid digit found in string" => {
            "allowed: a whole number, not below 0".to_owned()
        }
        _ => return None,
    };
    Some(format!("{option} = {value} is not allowed; {allowed}"))
}
