//! Values of options, whose errors are reported like those of keys.

use clap::builder::ValueParser;
use clap::error::{ContextKind, ContextValue};
use clap::{Arg, Command};
use snapload::{CaseError, Key, Kind, Value, parse_value};
use std::error::Error;
use std::num::ParseFloatError;

/// Reads a whole number that an option may be.
pub(crate) fn whole_number<T>(option: Key) -> ValueParser
where
    T: TryFrom<u64> + Clone + Send + Sync + 'static,
{
    ValueParser::from(move |text: &str| {
        let number = text.trim().parse::<u64>().ok();
        let number = number.filter(|number| option.takes_count(*number));
        let number = number.and_then(|number| T::try_from(number).ok());
        number.ok_or_else(|| allowed(&option.refuse(option.name, text)))
    })
}

/// Reads a number that an option may be.
#[cfg(feature = "structure")]
pub(crate) fn number(option: Key) -> ValueParser {
    ValueParser::from(move |text: &str| {
        let number = text.trim().parse::<f64>().ok();
        let number = number.filter(|number| option.check(option.name, &(*number).into()).is_ok());
        number.ok_or_else(|| allowed(&option.refuse(option.name, text)))
    })
}

/// What is allowed, as [`refusal`] looks for it.
fn allowed(error: &CaseError) -> String {
    format!("allowed: {}", error.allowed)
}

/// Reads the value of an option that is described as a key.
pub(crate) fn key_value(key: &'static Key) -> ValueParser {
    ValueParser::from(move |text: &str| {
        let number = text.trim();
        let value = match key.kind {
            Kind::Number(_) => number.parse().ok().map(Value::Number),
            Kind::Count(..) => number.parse().ok().map(Value::Integer),
            Kind::Choice(_) | Kind::Text => Some(Value::from(text)),
            Kind::Flag | Kind::Pair(_) | Kind::PerFreedom(_) | Kind::Triple(_) => {
                parse_value(text).ok()
            }
        };
        let checked = match value {
            Some(value) => key.check(key.name, &value).map(|()| value),
            None => Err(key.refuse(key.name, text)),
        };
        checked.map_err(|error| allowed(&error))
    })
}

/// The error of an option's value, with its name, the value, and what is allowed; none if the
/// parser does not say what is allowed.
pub(crate) fn refusal(error: &clap::Error) -> Option<String> {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let option = text(ContextKind::InvalidArg)?.split_whitespace().next()?;
    let value = text(ContextKind::InvalidValue)?;
    let source = error.source()?;
    let allowed = match source.to_string() {
        message if message.starts_with("allowed: ") => message,
        _ if source.is::<ParseFloatError>() => "allowed: a number".to_owned(),
        _ => return None,
    };
    Some(format!("{option} = {value} is not allowed; {allowed}"))
}

/// The same command, all options of which accept negative numbers as values, if only to report that
/// they are not allowed.
pub(crate) fn with_negative_numbers(command: Command) -> Command {
    let option = |arg: Arg| match arg.is_positional() || !arg.get_action().takes_values() {
        true => arg,
        false => arg.allow_negative_numbers(true),
    };
    command
        .mut_args(option)
        .mut_subcommands(with_negative_numbers)
}
