//! The commands that each ask one question about one case: all questions of the report crate.
use crate::bar::Bar;
use crate::case_input::CaseArgs;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::option_values::key_value;
use crate::outputs::Outputs;
use clap::{Arg, ArgAction, ArgMatches, Args as _, Command, Error, FromArgMatches, Subcommand};
use snapload::analysis::{Progress, Unfinished};
use snapload::{CaseError, DefaultValue, Key, Kind, Value};
use snapload_report::{QUESTIONS, Question, question};
use std::fmt::Write;

/// Which question, of which case, with which options.
pub(crate) struct Args {
    question: &'static Question,
    case: CaseArgs,
    options: Vec<(&'static str, Value)>,
    json: JsonArgs,
}

impl Subcommand for Args {
    fn augment_subcommands(command: Command) -> Command {
        command.subcommands(QUESTIONS.iter().map(verb))
    }

    fn augment_subcommands_for_update(command: Command) -> Command {
        Self::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        question(name).is_some()
    }
}

impl FromArgMatches for Args {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let subcommand = matches.subcommand();
        let subcommand = subcommand.and_then(|(name, matches)| Some((question(name)?, matches)));
        let missing = || Error::new(clap::error::ErrorKind::MissingSubcommand);
        let (question, matches) = subcommand.ok_or_else(missing)?;
        let options = question.options.iter();
        let options = options.filter_map(|key| Some((key.name, given(key, matches)?)));
        Ok(Self {
            question,
            case: CaseArgs::from_arg_matches(matches)?,
            options: options.collect(),
            json: JsonArgs::from_arg_matches(matches)?,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The subcommand of a question.
fn verb(question: &'static Question) -> Command {
    let command = CaseArgs::augment_args(Command::new(question.name));
    let command = command.args(question.options.iter().map(option));
    JsonArgs::augment_args(command)
        .about(question.asks)
        .after_help(question.help)
}

/// An option from its description.
fn option(key: &'static Key) -> Arg {
    let mut help: String = key.meaning.to_owned();
    if let Some(first) = help.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    if let Some(unit) = key.own_unit() {
        let _ = write!(help, " [{unit}]");
    }
    let option = Arg::new(key.name).long(key.name.replace('_', "-"));
    if key.kind == Kind::Flag {
        return option.help(help).action(ArgAction::SetTrue);
    }
    let option = option
        .value_name(key.symbol)
        .value_parser(key_value(key))
        .required(key.default == DefaultValue::Required);
    match key.default.value() {
        Some(Value::Text(word)) => option.help(help).default_value(word),
        Some(value) => option.help(help).default_value(value.to_string()),
        None => option.help(format!("{help} ({})", key.default_words())),
    }
}

/// The value of an option on a command line, or its default.
fn given(key: &Key, matches: &ArgMatches) -> Option<Value> {
    match key.kind {
        Kind::Flag => Some(matches.get_flag(key.name).into()),
        _ => matches.get_one::<Value>(key.name).cloned(),
    }
}

/// Asks the question.
pub(crate) fn run(args: Args) -> Result<(), Failure> {
    let Args {
        question,
        case,
        options,
        json,
    } = args;
    let input = case.read()?;
    let outputs = Outputs::open(&json)?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let answer = question.ask(&input.case, &input.entries, options, &on_progress);
    let answer = answer.map_err(|why| match why {
        Unfinished::Case(error) => as_written(question, error).into(),
        cancelled => Failure::from(cancelled),
    })?;
    drop(bar);
    let texts = answer.about(&input.name, &input.case, &input.entries);
    outputs.finish(&texts.answer, texts.words)
}

/// An error that names an option, with the option in the notation of the command line.
fn as_written(question: &Question, mut error: CaseError) -> CaseError {
    if question.option(&error.key).is_ok() {
        error.key = format!("--{}", error.key.replace('_', "-"));
    }
    error
}
