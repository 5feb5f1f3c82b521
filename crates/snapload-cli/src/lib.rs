//! The command line of snapload: reads a case, runs it, and prints or writes the results.
//!
//! It is a library, so that the program `snapload` and the one in the Python package are the same:
//! [`command`].

#[cfg(feature = "structure")]
mod assess;
mod bar;
mod basin;
mod basin_picture;
mod branch;
mod case_input;
mod cases;
mod certify;
mod completions;
mod critical;
mod curve;
#[cfg(feature = "structure")]
mod decay;
mod diagram;
#[cfg(feature = "structure")]
mod elastic;
#[cfg(feature = "explore")]
mod explore;
mod failure;
mod help;
#[cfg(feature = "structure")]
mod hydro;
#[cfg(feature = "structure")]
mod hydro_input;
mod interrupt;
mod json;
mod keys;
mod merge;
#[cfg(feature = "structure")]
mod moordyn;
mod option_values;
mod orbit;
mod orbit_columns;
mod orbit_picture;
mod orbit_search;
mod outputs;
mod pending_outputs;
mod pictures;
mod question;
#[cfg(feature = "reproduce")]
mod reproduce;
mod run;
#[cfg(feature = "structure")]
mod seas;
mod section;
mod standard_output;
#[cfg(feature = "structure")]
mod structure_input;
mod study_csv;
mod study_input;
mod study_picture;
mod study_summary;
mod sweep;
mod table;
mod uncertainty;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use snapload::CASE_KEYS;
use std::borrow::Cow;
use std::ffi::OsString;
use std::sync::OnceLock;

/// Bodies on cables that go slack and snap taut: motion, impacts, tensions.
#[derive(Parser)]
#[command(name = "snapload", version, arg_required_else_help = true, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

const EXAMPLES: &str = "\
Examples:
  snapload run                                 the standard case
  snapload run --set f_o=0.5                   the same with a stronger force
  snapload run --case 2910001000-359           a built-in case (list: snapload cases)
  snapload run mooring.toml --out results      a case of your own, with tables and pictures
  snapload verify                              the standard case, compared with a run in 76 digits
  snapload critical --over e=0.5:1:11          critical force against the restitution e
  snapload sweep --vary f_o=0.01:0.6:60 --vary omega=0.4:2.4:51 --out map.parquet
                                               a map of 3060 cases
  snapload assess cylinder.toml --out note.html
                                               a structure in waves (SI units): do its lines break?
  snapload hydro pontoon.nc --out pontoon.html
                                               a floating body: memory, natural periods, response
  snapload explore                             the standard case on an animated page in the browser

Exit status: 0 done, 1 failed, 2 bad input, 130 interrupted.";

#[derive(Subcommand)]
enum Verb {
    /// Run one case
    Run(run::Args),
    /// Find the critical force (the smallest amplitude that exceeds a limit) and all others that do
    Critical(critical::Args),
    /// A verb for each question about one case.
    #[command(flatten)]
    Question(question::Args),
    /// Prove a run impact by impact and write a certificate of the result, or check a certificate
    Certify(certify::Args),
    /// Run a study over a grid, random points or a list of cases, and write one row per case
    Sweep(sweep::Args),
    /// Join the parts of a study that was computed on several machines
    Merge(merge::Args),
    /// Find periodic orbits, their Floquet multipliers, and whether they are possible motions
    Orbit(orbit::Args),
    /// Continue a periodic orbit in one key, and locate bifurcations, grazes and limits
    Branch(branch::Args),
    /// Continue a fold, period doubling, Neimark-Sacker point or graze in two keys
    Curve(curve::Args),
    /// Sample a long motion once per forcing period, and compute its Lyapunov exponents
    Section(section::Args),
    /// Compute a bifurcation diagram: the attractor as one key changes
    Diagram(diagram::Args),
    /// Compute which starts in a window of two keys stay below the limits (safe basin)
    Basin(basin::Args),
    /// Compute how the safe part of a window of two keys shrinks as a third key changes
    Erosion(basin::ErosionArgs),
    /// Reproduce the tables, figures and claims of chapter 6 of the thesis as one report
    #[cfg(feature = "reproduce")]
    Reproduce(reproduce::Args),
    /// Assess a structure in SI units: do its lines go slack, snap or break?
    #[cfg(feature = "structure")]
    Assess(assess::Args),
    /// Run a structure in many records of an irregular sea: distributions of snaps and tensions
    #[cfg(feature = "structure")]
    Seas(seas::Args),
    /// Run a structure with elastic lines, and compare it with inextensible lines
    #[cfg(feature = "structure")]
    Elastic(elastic::Args),
    /// Analyse the hydrodynamics of a floating body: memory, natural periods, response to waves
    #[cfg(feature = "structure")]
    Hydro(hydro::Args),
    /// Simulate a free-decay test of a floating body: periods and damping of its oscillations
    #[cfg(feature = "structure")]
    Decay(decay::Args),
    /// Convert a MoorDyn file to a structure's case, or a case to a MoorDyn file
    #[cfg(feature = "structure")]
    Moordyn(moordyn::Args),
    /// Open a page in the browser that animates a run and has a slider for every key
    #[cfg(feature = "explore")]
    Explore(explore::Args),
    /// List the built-in cases
    Cases,
    /// Explain the keys of a case: meaning, default and allowed values
    Keys,
    /// Print a completion script for a shell
    Completions(completions::Args),
}

/// The arguments of the command line after the name of the program.
static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// The command line that is executed, from the name of the program on.
fn given_words() -> Vec<Cow<'static, str>> {
    let words = WORDS.get().into_iter().flatten();
    let words = words.map(|word| word.to_string_lossy());
    std::iter::once("snapload".into()).chain(words).collect()
}

/// Executes a command line, whose first word is the name of the program, and returns the exit
/// status. It acts for the whole process: it handles Ctrl-C, and may end the process itself.
pub fn command(line: impl IntoIterator<Item = OsString>) -> u8 {
    interrupt::install();
    let line: Vec<OsString> = line.into_iter().collect();
    let words = WORDS.get_or_init(|| line.iter().skip(1).cloned().collect());
    let name = OsString::from("snapload");
    let line = std::iter::once(&name).chain(words);
    let command = help::flowing(option_values::with_negative_numbers(Cli::command()));
    let matches = command.try_get_matches_from(line);
    let cli = matches.and_then(|matches| Cli::from_arg_matches(&matches));
    let cli = cli.unwrap_or_else(|error| refuse(error));
    let result = match cli.verb {
        Verb::Run(args) => run::run(&args),
        Verb::Critical(args) => critical::run(&args),
        Verb::Question(args) => question::run(args),
        Verb::Certify(args) => certify::run(&args),
        Verb::Sweep(args) => sweep::run(&args),
        Verb::Merge(args) => merge::run(&args),
        Verb::Orbit(args) => orbit::run(&args),
        Verb::Branch(args) => branch::run(&args),
        Verb::Curve(args) => curve::run(&args),
        Verb::Section(args) => section::run(&args),
        Verb::Diagram(args) => diagram::run(&args),
        Verb::Basin(args) => basin::run(&args),
        Verb::Erosion(args) => basin::run_erosion(&args),
        #[cfg(feature = "reproduce")]
        Verb::Reproduce(args) => reproduce::run(&args),
        #[cfg(feature = "structure")]
        Verb::Assess(args) => assess::run(&args),
        #[cfg(feature = "structure")]
        Verb::Seas(args) => seas::run(&args),
        #[cfg(feature = "structure")]
        Verb::Elastic(args) => elastic::run(&args),
        #[cfg(feature = "structure")]
        Verb::Hydro(args) => hydro::run(&args),
        #[cfg(feature = "structure")]
        Verb::Decay(args) => decay::run(&args),
        #[cfg(feature = "structure")]
        Verb::Moordyn(args) => moordyn::run(&args),
        #[cfg(feature = "explore")]
        Verb::Explore(args) => explore::run(&args),
        Verb::Cases => cases::run(),
        Verb::Keys => keys::run(),
        Verb::Completions(args) => completions::run(&args),
    };
    failure::exit_status(result)
}

/// Ends with the error of the command line. A value that is not allowed is reported like that of a
/// key; if a key is used as an option, the message says how keys are set.
fn refuse(mut error: clap::Error) -> ! {
    if error.kind() == ErrorKind::ValueValidation
        && let Some(message) = option_values::refusal(&error)
    {
        let status = failure::exit_status(Err(failure::Failure::BadInput(message)));
        std::process::exit(i32::from(status));
    }
    if error.kind() == ErrorKind::InvalidValue
        && let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg)
        && option.starts_with("--json")
    {
        let tip = "write --json - for standard output, or --json FILE";
        let tips = ContextValue::StyledStrs(vec![tip.into()]);
        error.insert(ContextKind::Suggested, tips);
    }
    if error.kind() == ErrorKind::UnknownArgument
        && error.get(ContextKind::SuggestedArg).is_none()
        && let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg)
        && let Some(key) = CASE_KEYS.nearest(option.trim_start_matches('-'))
    {
        let tip = format!("set a key of the case with --set {key}=VALUE");
        let tips = ContextValue::StyledStrs(vec![tip.into()]);
        error.insert(ContextKind::Suggested, tips);
    }
    if error.exit_code() != 0 {
        error.exit()
    }
    // Help and version are output, which may not be possible to write.
    let printed = standard_output::standard_output().map(drop);
    let printed = printed.and_then(|()| error.print());
    let printed = printed.map_err(|error| failure::Failure::write("standard output", &error));
    std::process::exit(i32::from(failure::exit_status(printed)))
}
