//! The study that a command line asks for: a case, what varies, and how.
use crate::case_input::{CaseArgs, add_case_defaults};
use crate::failure::Failure;
use crate::interrupt::print_error_line;
use crate::option_values::whole_number;
use snapload::DefaultValue::{Count, Derived, Flag};
use snapload::analysis::SEED;
use snapload::{
    CASE_KEYS, CaseError, Entries, Heading, KEYS, Key, Kind, Schema, Table, Value, key_named,
    parse_value,
};
use snapload_study::{Axis, List, Plan, RANDOM, RandomRange, Study};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The keys of a study file besides those of a case.
#[rustfmt::skip] // one row a key
const STUDY_KEYS: &[Key] = &[
    Key::new("case", "", Kind::Text, Derived("the standard case"), "built-in case to begin with"),
    Key::new("random", "", RANDOM.kind, Derived("a grid"), "number of random points in the box of the ranges"),
    Key::new("seed", "", SEED.kind, Count(0), "seed of the random points"),
    Key::new("list", "", Kind::Text, Derived("none"), "file with one row per case, in the folder of the study file"),
    Key::new("list_sha256", "", Kind::Text, Derived("any"), "checksum of that file, as sha256sum prints it"),
    Key::new("trust", "", Kind::Flag, Flag(true), "whether to compute how far each run can be trusted"),
];

/// A study file: the keys of a case, those of the study itself, and what varies.
static STUDY: Schema = Schema {
    tables: &[
        CASE_KEYS,
        Table::new("study", Heading::None, "which cases", STUDY_KEYS),
        Table {
            unchecked: true,
            ..Table::new("vary", Heading::Optional, "what varies", KEYS)
        },
    ],
    example: "f_o=0.5",
    form: "one `key = value` per line, and below the line [vary] the keys that vary",
};

/// Which study, as given on the command line.
#[derive(clap::Args)]
#[command(mut_arg("file", |arg| arg.value_name("STUDY.toml").help(
    "Study or case file in TOML: the keys of a case, and under [vary] the keys that vary"
)))]
pub(crate) struct StudyArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// Vary a key over first:last:n or over a list v1,v2,...; may be repeated, the first key varies
    /// slowest
    #[arg(long, value_name = "KEY=VALUES", allow_hyphen_values = true)]
    vary: Vec<String>,
    /// Run N Sobol points in the box of the ranges instead of a grid
    #[arg(long, value_name = "N", value_parser = whole_number::<u64>(RANDOM))]
    random: Option<u64>,
    /// Seed of the random points, by default 0
    #[arg(long, value_name = "S", value_parser = whole_number::<u64>(SEED))]
    seed: Option<u64>,
    /// Read the cases from a CSV or Parquet file, with one row per case and one column per key
    #[arg(long, value_name = "FILE", conflicts_with_all = ["vary", "random", "seed"])]
    list: Option<PathBuf>,
    /// Leave out how far each run can be trusted; computing it makes a study
    /// take two to three times as long
    #[arg(long)]
    no_trust: bool,
}

impl StudyArgs {
    /// Reads and checks the study.
    pub(crate) fn read(&self) -> Result<Study, Failure> {
        let (_, mut entries) = self.case.entries(&STUDY)?;
        if let Some(code) = entries.table("study", 0).get::<String>("case")? {
            let place = entries.place("case").unwrap_or_default().to_owned();
            add_case_defaults(&mut entries, &code).map_err(|error| error.at(place))?;
        }
        let options = StudyOptions::of_file(self.case.file(), &entries)?.overridden_by(self)?;
        let trust = options.trust;
        let base = entries
            .values("case")
            .map(|(key, value)| (key.to_owned(), value));
        Ok(Study::new(base, options.plan()?, trust)?)
    }
}

/// What is to vary, before it is checked.
struct StudyOptions {
    vary: Vec<(String, Varied)>,
    random: Option<u64>,
    seed: u64,
    list: Option<PathBuf>,
    sha256: Option<String>,
    trust: bool,
}

/// The values of one key, before they are checked.
enum Varied {
    /// `first:last`, or `first:last:n`.
    Range(String),
    Listed(Vec<Value>),
}

impl Varied {
    fn of(value: Value) -> Self {
        match value {
            Value::Text(text) if text.contains(':') => Self::Range(text),
            Value::List(values) => Self::Listed(values),
            value => Self::Listed(vec![value]),
        }
    }
}

impl StudyOptions {
    fn of_file(file: Option<&Path>, entries: &Entries) -> Result<Self, Failure> {
        let study = entries.table("study", 0);
        let vary = entries.values("vary");
        let beside = file.and_then(Path::parent).unwrap_or(Path::new(""));
        Ok(Self {
            vary: vary
                .map(|(key, value)| (key.to_owned(), Varied::of(value)))
                .collect(),
            random: study.get("random")?,
            seed: study.need("seed")?,
            list: study.get::<String>("list")?.map(|name| beside.join(name)),
            sha256: study.get("list_sha256")?,
            trust: study.need("trust")?,
        })
    }

    /// Options of the command line replace those of the file.
    fn overridden_by(mut self, args: &StudyArgs) -> Result<Self, Failure> {
        for text in &args.vary {
            let (key, varied) = of_text(text)?;
            match self.vary.iter_mut().find(|(known, _)| *known == key) {
                // A second --vary of a key is an error, which the plan reports; the file's is
                // replaced.
                Some(known) if args.vary.iter().filter(|t| key_of(t) == key).count() == 1 => {
                    known.1 = varied;
                }
                _ => self.vary.push((key, varied)),
            }
        }
        self.random = args.random.or(self.random);
        if let (Some(seed), None) = (args.seed, self.random) {
            return Err(Failure::BadInput(format!(
                "--seed {seed} selects random points, and there are none; add --random N, or leave it out"
            )));
        }
        self.seed = args.seed.unwrap_or(self.seed);
        if let Some(list) = &args.list {
            self.list = Some(list.clone());
            self.sha256 = None;
        }
        self.trust &= !args.no_trust;
        Ok(self)
    }

    fn plan(self) -> Result<Plan, Failure> {
        if let Some(path) = self.list {
            if !self.vary.is_empty() || self.random.is_some() {
                return Err(Failure::bad_input(
                    "a list of cases already determines what varies; leave out the list, or the other keys that vary",
                ));
            }
            let list = List::open(&path)?;
            return match self.sha256 {
                Some(sum) if sum != list.sha256() => Err(Failure::BadInput(format!(
                    "{}: not the list of the study, whose list_sha256 is {sum}",
                    path.display()
                ))),
                _ => Ok(Plan::List(list)),
            };
        }
        let vary = self.vary.into_iter();
        if let Some(count) = self.random {
            let ranges = vary.map(|(key, varied)| side(&key, varied));
            let ranges = ranges.collect::<Result<_, _>>()?;
            return Ok(Plan::random(ranges, count, self.seed)?);
        }
        let axes = vary.map(|(key, varied)| axis(&key, varied));
        Ok(Plan::grid(axes.collect::<Result<_, _>>()?)?)
    }
}

/// The axes of a study from its description; none if it is not a grid.
pub(crate) fn axes_of(description: &str) -> Option<Vec<Axis>> {
    let entries = Entries::parse(&STUDY, "", description).ok()?;
    let is_given = |key: &str| entries.table("study", 0).given(key).is_some();
    if is_given("random") || is_given("list") || entries.count("vary") == 0 {
        return None;
    }
    let axes = entries
        .values("vary")
        .map(|(key, value)| axis(key, Varied::of(value)).ok());
    axes.collect()
}

fn key_of(text: &str) -> &str {
    text.split_once('=').map_or(text, |(key, _)| key).trim()
}

/// `KEY=first:last:n` or `KEY=v1,v2,...`.
fn of_text(text: &str) -> Result<(String, Varied), Failure> {
    let Some((key, values)) = text.split_once('=') else {
        return Err(Failure::BadInput(format!(
            "--vary {text:?}: no values; write --vary KEY=first:last:n, such as --vary f_o=0.01:0.6:60, \
             or --vary KEY=v1,v2,..."
        )));
    };
    let (key, values) = (key.trim(), values.trim());
    if values.contains(':') {
        return Ok((key.to_owned(), Varied::Range(values.to_owned())));
    }
    let refuse = |shown: Cow<'static, str>| match key_named(key) {
        Ok(known) => known.refuse(key, shown),
        Err(unknown) => unknown,
    };
    warn_of_comma(key, values);
    let values = values.split(',');
    let values = values.map(|value| parse_value(value.trim()).map_err(refuse));
    let values = values.collect::<Result<_, CaseError>>();
    Ok((
        key.to_owned(),
        Varied::Listed(values.map_err(|error| error.at("--vary"))?),
    ))
}

/// Warns that `f_o=0,3` is two values, which may not be meant.
fn warn_of_comma(key: &str, values: &str) {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let number = key_named(key).is_ok_and(|key| matches!(key.kind, Kind::Number { .. }));
    let Some((whole, fraction)) = values.split_once(',').filter(|_| number) else {
        return;
    };
    if digits(whole.trim_start_matches(['+', '-'])) && digits(fraction) {
        print_error_line(&format!(
            "--vary {key}={values} is two values, {whole} and {fraction}; if one was meant, write a point: \
             {key}={whole}.{fraction}"
        ));
    }
}

fn axis(key: &str, varied: Varied) -> Result<Axis, Failure> {
    Ok(match varied {
        Varied::Listed(values) => Axis::listed(key, values)?,
        Varied::Range(text) => Axis::written(key, &text)?,
    })
}

fn side(key: &str, varied: Varied) -> Result<RandomRange, Failure> {
    RandomRange::is_possible(key)?;
    match varied {
        Varied::Range(text) => Ok(RandomRange::written(key, &text)?),
        Varied::Listed(_) => Err(Failure::BadInput(format!(
            "{key}: random points are drawn from a range; write {key}=low:high"
        ))),
    }
}
