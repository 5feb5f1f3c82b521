//! `/api/export/NAME`: the files that `snapload run --out` writes, with the same bytes.
use crate::refusal::Refusal;
use crate::request;
use crate::run::follow;
use crate::work::Allowance;
use serde::Deserialize;
use snapload::analysis::{Progress, Uncertainty, Unfinished};
use snapload::{Case, Sampling};
use snapload_figures::{FigureError, PNG_SCALE, RunPlot, RunPlots};
use snapload_report::{
    Report, RunWithHorizon, RunWithTrust, case_file, case_in_words, shell_line, tables, write_json,
};
use std::time::Duration;

/// The time budget of a run's neighbours.
const BUDGET: Duration = Duration::from_secs(20);
/// The message if that is used up.
const TOO_SLOW: &str = "the neighbours of this run take longer than the page waits";
/// The most impacts in a table; larger tables are left to the command line.
const MOST_WRITTEN: usize = 100_000;
/// The same for a picture: a path that covers the whole plane takes minutes to draw.
const MOST_DRAWN: usize = 10_000;
/// The seed that the command uses for neighbours by default.
pub(crate) const SEED: u64 = 1;

/// A file that can be requested.
#[derive(Clone, Copy)]
pub(crate) enum File {
    Case,
    Impacts,
    Modes,
    Motion,
    Run,
    Svg(RunPlot),
    Png(RunPlot),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    #[serde(default)]
    values: request::Values,
    /// Accepted as in `/api/run`; it has no effect on a file.
    #[serde(default, rename = "ghost")]
    _ghost: serde::de::IgnoredAny,
    #[serde(default, rename = "samples")]
    _samples: serde::de::IgnoredAny,
}

impl File {
    /// The file of a name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let plot = |stem: &str| RunPlot::ALL.into_iter().find(|plot| plot.name() == stem);
        match name {
            "case.toml" => Some(Self::Case),
            "impacts.csv" => Some(Self::Impacts),
            "modes.csv" => Some(Self::Modes),
            "motion.csv" => Some(Self::Motion),
            "run.json" => Some(Self::Run),
            name => match name.rsplit_once('.')? {
                (stem, "svg") => plot(stem).map(Self::Svg),
                (stem, "png") => plot(stem).map(Self::Png),
                _ => None,
            },
        }
    }

    /// Its media type.
    pub(crate) fn content_type(self) -> &'static str {
        match self {
            Self::Case => "application/toml",
            Self::Impacts | Self::Modes | Self::Motion => "text/csv; charset=utf-8",
            Self::Run => "application/json",
            Self::Svg(_) => "image/svg+xml",
            Self::Png(_) => "image/png",
        }
    }

    /// Its contents, for the case of a request.
    pub(crate) fn write(self, request: Request, allowance: &Allowance) -> Result<Vec<u8>, Refusal> {
        let case = request::case(request.values)?;
        if matches!(self, Self::Case) {
            return Ok(case_file(case.parameters()).into_bytes());
        }
        let followed = follow(&case, allowance)?;
        let impacts = followed.run.impacts().len();
        let most = match self {
            Self::Svg(_) | Self::Png(_) => MOST_DRAWN,
            _ => MOST_WRITTEN,
        };
        if impacts > most {
            let why = format!("this run has {impacts} impacts, too many for the page");
            return Err(for_the_command(&case, &why));
        }
        let mut bytes = Vec::new();
        match self {
            Self::Run | Self::Impacts => self.fill_trusted(&case, allowance, &mut bytes)?,
            file => file.fill(&case, &followed, &mut bytes)?,
        }
        Ok(bytes)
    }

    fn fill(
        self,
        case: &Case,
        followed: &RunWithHorizon,
        out: &mut Vec<u8>,
    ) -> Result<(), Refusal> {
        let run = &followed.run;
        let written = match self {
            Self::Modes => tables::modes(run, out),
            Self::Motion => tables::motion(run, Sampling::thousand(run.end().t), out),
            Self::Svg(plot) | Self::Png(plot) => {
                out.extend(picture(self, plot, case, followed).map_err(Refusal::failed)?);
                Ok(())
            }
            Self::Case | Self::Impacts | Self::Run => Ok(()),
        };
        written.map_err(Refusal::failed)
    }

    /// Adds the digits and the ends of neighbours, which describe the time past the horizon, too.
    fn fill_trusted(
        self,
        case: &Case,
        allowance: &Allowance,
        out: &mut Vec<u8>,
    ) -> Result<(), Refusal> {
        let allowance = allowance.within(BUDGET);
        let on_progress = |progress: Progress| allowance.check(progress);
        let refuse = |unfinished| match unfinished {
            Unfinished::Case(error) => error.into(),
            Unfinished::Cancelled(_) => for_the_command(case, TOO_SLOW),
        };
        let run =
            RunWithTrust::run_alone(case, Uncertainty::default(), &on_progress).map_err(refuse)?;
        if matches!(self, Self::Impacts) {
            let written = tables::impacts(&run.run, run.trust.digits(), out);
            return written.map_err(Refusal::failed);
        }
        let run = run.completed(case, None, SEED, &on_progress);
        let run = run.map_err(refuse)?;
        let report = Report::new(case.parameters(), &run, None, &on_progress);
        write_json(&report, out).map_err(Refusal::failed)
    }
}

fn picture(
    file: File,
    plot: RunPlot,
    case: &Case,
    followed: &RunWithHorizon,
) -> Result<Vec<u8>, FigureError> {
    let horizon = followed.horizon.map(|horizon| horizon.t);
    let plots = RunPlots::new(&followed.run).with_horizon(horizon);
    let title = case_in_words("standard case", case.parameters());
    let picture = plots.picture(plot, &title)?;
    match file {
        File::Png(_) => picture.png(PNG_SCALE),
        _ => Ok(picture.svg().as_bytes().to_vec()),
    }
}

fn for_the_command(case: &Case, why: &str) -> Refusal {
    let command = shell_line(case.parameters());
    Refusal::values(format!("{why}\nhint: {command} --out results"))
}
