//! The study that a command line asks for: a case, what varies, and how.
use crate::case_input::{CaseArgs, Given, from_toml, parse_value};
use crate::failure::Failure;
use snapload::{Value, key_named};
use snapload_study::{Axis, List, Plan, Side, Study};
use std::path::{Path, PathBuf};

/// What a study file says beside the keys of a case.
const ASIDE: [&str; 7] = [
    "case",
    "vary",
    "random",
    "seed",
    "list",
    "list_sha256",
    "trust",
];

/// Which study, as given on the command line.
#[derive(clap::Args)]
#[command(mut_arg("file", |arg| arg.value_name("STUDY.toml").help(
    "Study or case file in TOML: keys of a case, and what varies under [vary]"
)))]
pub(crate) struct StudyArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// Let a key vary: first:last:n values, or a list v1,v2,...; repeated, the first one varies slowest
    #[arg(long, value_name = "KEY=VALUES", allow_hyphen_values = true)]
    vary: Vec<String>,
    /// Sobol points in the box of the ranges instead of a grid
    #[arg(long, value_name = "N")]
    random: Option<u64>,
    /// Which random points
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Cases from a CSV or Parquet file: a row a case, a column a key
    #[arg(long, value_name = "FILE", conflicts_with_all = ["vary", "random", "seed"])]
    list: Option<PathBuf>,
    /// Leave out how far each run can be trusted, which takes nine tenths of the time
    #[arg(long)]
    no_trust: bool,
}

impl StudyArgs {
    /// Reads and checks the study.
    pub(crate) fn read(&self) -> Result<Study, Failure> {
        let Given { entries, aside, .. } = self.case.given(&ASIDE)?;
        let file = self.case.file();
        let asked = Asked::of_file(file, &aside)
            .map_err(|failure| failure.with_prefix(&shown(file)))?
            .changed_by(self)?;
        let trust = asked.trust;
        let base = entries.into_iter().map(|entry| (entry.key, entry.value));
        Ok(Study::new(base, asked.plan()?, trust)?)
    }
}

fn shown(file: Option<&Path>) -> String {
    file.map(|path| path.display().to_string())
        .unwrap_or_default()
}

/// What is to vary, before it is checked.
struct Asked {
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

impl Asked {
    fn of_file(file: Option<&Path>, aside: &toml::Table) -> Result<Self, Failure> {
        let whole = |value: &toml::Value| value.as_integer().and_then(|n| u64::try_from(n).ok());
        let random = read(aside, "random", "a whole number, 0 or more", whole)?;
        let seed = read(aside, "seed", "a whole number, 0 or more", whole)?;
        let text = |value: &toml::Value| value.as_str().map(str::to_owned);
        let list = read(aside, "list", "a text in quotes", text)?;
        let sha256 = read(aside, "list_sha256", "a text in quotes", text)?;
        let trust = read(aside, "trust", "true or false", toml::Value::as_bool)?;
        let lines = "a table [vary] with lines KEY = \"first:last:n\"";
        let vary = read(aside, "vary", lines, |value| value.as_table().cloned())?;
        let vary = vary.into_iter().flatten().map(|(key, value)| {
            let varied = of_toml(&key, value).map_err(|failure| failure.with_prefix("[vary]"))?;
            Ok((key, varied))
        });
        let beside = file.and_then(Path::parent).unwrap_or(Path::new(""));
        Ok(Self {
            vary: vary.collect::<Result<_, Failure>>()?,
            random,
            seed: seed.unwrap_or(0),
            list: list.map(|name| beside.join(name)),
            sha256,
            trust: trust.unwrap_or(true),
        })
    }

    /// The command line has the last word.
    fn changed_by(mut self, args: &StudyArgs) -> Result<Self, Failure> {
        for text in &args.vary {
            let (key, varied) = of_text(text)?;
            match self.vary.iter_mut().find(|(known, _)| *known == key) {
                // A second --vary of a key is a slip, which the plan reports; the file's is replaced.
                Some(known) if args.vary.iter().filter(|t| key_of(t) == key).count() == 1 => {
                    known.1 = varied;
                }
                _ => self.vary.push((key, varied)),
            }
        }
        self.random = args.random.or(self.random);
        if let (Some(seed), None) = (args.seed, self.random) {
            return Err(Failure::BadInput(format!(
                "--seed {seed} says which random points, and there are none; add --random N, or leave it out"
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
                    "a list of cases says itself what varies; leave out either the list or what varies beside it",
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
            let sides = vary.map(|(key, varied)| side(&key, varied));
            let sides = sides.collect::<Result<_, _>>()?;
            return Ok(Plan::random(sides, count, self.seed)?);
        }
        let axes = vary.map(|(key, varied)| axis(&key, varied));
        Ok(Plan::grid(axes.collect::<Result<_, _>>()?)?)
    }
}

/// What a study file says under a name; `wanted` tells what it may say there.
fn read<T>(
    aside: &toml::Table,
    name: &str,
    wanted: &str,
    of: impl Fn(&toml::Value) -> Option<T>,
) -> Result<Option<T>, Failure> {
    let refuse = |value: &toml::Value| {
        Failure::BadInput(format!(
            "{name} = {value} is not allowed; allowed: {wanted}"
        ))
    };
    let value = aside.get(name);
    value
        .map(|value| of(value).ok_or_else(|| refuse(value)))
        .transpose()
}

/// The axes of a study that a file describes; none if it is no grid.
pub(crate) fn axes_of(description: &str) -> Option<Vec<Axis>> {
    let mut table: toml::Table = description.parse().ok()?;
    if table.contains_key("random") || table.contains_key("list") {
        return None;
    }
    let toml::Value::Table(vary) = table.remove("vary")? else {
        return None;
    };
    vary.into_iter()
        .map(|(key, value)| axis(&key, of_toml(&key, value).ok()?).ok())
        .collect()
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
    let values = values
        .split(',')
        .map(|value| parse_value(key, value.trim()));
    let values = values.collect::<Result<_, _>>();
    let values = values.map_err(|error| Failure::BadInput(format!("--vary: {error}")))?;
    Ok((key.to_owned(), Varied::Listed(values)))
}

fn of_toml(key: &str, value: toml::Value) -> Result<Varied, Failure> {
    let values = match value {
        toml::Value::String(text) if text.contains(':') => return Ok(Varied::Range(text)),
        toml::Value::Array(values) => values,
        other => vec![other],
    };
    let values = values.iter().map(|value| from_toml(key, value));
    let values = values.collect::<Result<_, _>>();
    Ok(Varied::Listed(values.map_err(Failure::bad_input)?))
}

fn axis(key: &str, varied: Varied) -> Result<Axis, Failure> {
    Ok(match varied {
        Varied::Listed(values) => Axis::listed(key, values)?,
        Varied::Range(text) => Axis::written(key, &text)?,
    })
}

fn side(key: &str, varied: Varied) -> Result<Side, Failure> {
    key_named(key).map_err(Failure::bad_input)?;
    match varied {
        Varied::Range(text) => Ok(Side::written(key, &text)?),
        Varied::Listed(_) => Err(Failure::BadInput(format!(
            "{key}: random points are drawn from a range; write {key}=low:high"
        ))),
    }
}
