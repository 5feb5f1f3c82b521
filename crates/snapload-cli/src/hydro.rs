//! `snapload hydro`: a look at the coefficients of a floating body.
use crate::failure::Failure;
use crate::hydro_input::{HydroArgs, line, triple};
use crate::json::JsonArgs;
use crate::option_values::number;
use crate::outputs::Outputs;
use serde::Serialize;
use snapload::{Key, Kind};
use snapload_hydro::digits::digits;
use snapload_hydro::{FREEDOMS, Line, Report, Warning, large_motion, page};
use snapload_report::shell_command;
use snapload_structure::{IrregularSea, Spectrum, SpectrumShape, labelled_row};
use std::f64::consts::PI;
use std::path::PathBuf;

/// What a sea may be.
const HS: Key = Key::option("hs", Kind::positive(100.0));
const TP: Key = Key::option("tp", Kind::number(0.1, 100.0));
const GAMMA: Key = Key::option("gamma", Kind::number(1.0, 20.0));
/// The response in a sea is that of this part of its energy or more.
const LEAST_COVERED: f64 = 0.005;

const EXAMPLES: &str = include_str!("../help/hydro.txt").trim_ascii_end();

/// Which file, on which lines, in which sea, and where the answer goes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: HydroArgs,
    /// A line: anchor, fairlead relative to the reference point, and length, in m; may be repeated
    #[arg(long, value_name = "AX,AZ,FX,FZ,LENGTH", value_parser = line, allow_hyphen_values = true)]
    line: Vec<Line>,
    /// Constant load in addition to weight and buoyancy, such as current, in N, N, N m
    #[arg(long, value_name = "F1,F3,F5", value_parser = triple, allow_hyphen_values = true)]
    force: Option<[f64; 3]>,
    /// Significant wave height of an irregular sea in m
    #[arg(long, value_name = "NUMBER", value_parser = number(HS), requires = "tp")]
    hs: Option<f64>,
    /// Peak period of that sea in s
    #[arg(long, value_name = "NUMBER", value_parser = number(TP), requires = "hs")]
    tp: Option<f64>,
    /// Peak enhancement factor of the JONSWAP spectrum; 1 gives Pierson-Moskowitz
    #[arg(long, value_name = "NUMBER", value_parser = number(GAMMA), default_value_t = 3.3, requires = "hs")]
    gamma: f64,
    /// Write the results as one self-contained HTML page with plots
    #[arg(long, value_name = "PAGE.html")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgs,
}

/// The root mean square of each freedom in a sea.
#[derive(Serialize)]
struct SeaRow {
    direction: f64,
    hs_m: f64,
    tp_s: f64,
    rms: [f64; 3],
    covered: f64,
}

#[derive(Serialize)]
struct Answer<'a> {
    #[serde(flatten)]
    report: snapload_hydro::Json<'a>,
    sea: Vec<SeaRow>,
}

/// Does it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut outputs = Outputs::open(&args.json)?;
    let out = outputs.file("--out", args.out.as_deref(), &["html"])?;
    let mut report = args.input.report(args.line.clone(), args.force)?;
    let sea = args.sea(&report)?;
    let large = large_motion_in(&sea, &report);
    report.warnings.extend(large);
    let further = sea.iter().map(|row| ("sea".to_owned(), row.text()));
    let further: Vec<(String, String)> = further.collect();
    if let Some(out) = out {
        let words = crate::given_words();
        let command = shell_command(words.iter().map(|word| &**word));
        let page = page(&report, &further, &command)
            .map_err(|error| Failure::Failed(format!("can not draw the page: {error}")))?;
        outputs.write(out, |out| out.write_all(page.as_bytes()))?;
    }
    let mut text = format!("{}\n", report.name);
    let summary = report.summary();
    let (told_first, warnings): (Vec<_>, Vec<_>) = summary
        .into_iter()
        .partition(|(label, _)| label != "warning");
    for (label, words) in &told_first {
        text += &labelled_row(label, words);
    }
    for (label, words) in further.iter().chain(&warnings) {
        text += &labelled_row(label, words);
    }
    let answer = Answer {
        report: report.to_json(),
        sea,
    };
    outputs.finish_with_text(&answer, text)
}

impl Args {
    fn sea(&self, report: &Report) -> Result<Vec<SeaRow>, Failure> {
        let (Some(hs), Some(tp)) = (self.hs, self.tp) else {
            return Ok(Vec::new());
        };
        let spectrum = Spectrum::new(&IrregularSea {
            significant_height_m: hs,
            peak_period_s: tp,
            shape: match self.gamma == 1.0 {
                true => SpectrumShape::PiersonMoskowitz,
                false => SpectrumShape::Jonswap(self.gamma),
            },
            components: 1,
            seed: 0,
        });
        let [low, high] = spectrum.band_rad_s();
        let density = |omega: f64| match (low..=high).contains(&omega) {
            true => spectrum.density(omega),
            false => 0.0,
        };
        let Ok(floating) = &report.floating else {
            return Ok(Vec::new());
        };
        let row = |responses: &[snapload_hydro::Response; 2]| {
            let (rms, covered) = responses[0].in_a_sea(density);
            SeaRow {
                direction: responses[0].direction,
                hs_m: hs,
                tp_s: tp,
                rms,
                covered,
            }
        };
        // There may be a narrow resonance between the file's frequencies.
        let rows: Vec<SeaRow> = floating.fine.iter().map(row).collect();
        let [first, last] = report.reading.hydro.range_rad_s();
        match rows.iter().all(|row| row.covered >= LEAST_COVERED) {
            true => Ok(rows),
            false => Err(Failure::BadInput(format!(
                "--tp = {tp} is not allowed; allowed: the peak period of a sea with some of its energy at \
                 the file's periods, {} to {} s; this one has less than half a per cent of it there",
                digits(&(2.0 * PI / last), 2),
                digits(&(2.0 * PI / first), 2)
            ))),
        }
    }
}

/// The highest of a thousand Rayleigh-distributed amplitudes, about those of three hours, is near
/// this many root mean squares: sqrt(2 ln 1000).
const HIGHEST: f64 = 3.72;

/// The warnings that the highest motion of three hours is not small, in the direction of the sea in
/// which it is larger.
fn large_motion_in(sea: &[SeaRow], report: &Report) -> Vec<Warning> {
    let Ok(floating) = &report.floating else {
        return Vec::new();
    };
    let highest = |i: usize| {
        sea.iter()
            .map(|row| HIGHEST * row.rms[i])
            .fold(0.0, f64::max)
    };
    let motion = format!(
        "the highest motion of three hours in this sea, about {HIGHEST} root mean squares,"
    );
    let amplitudes = [highest(1), highest(2)];
    large_motion(&report.reading.hydro, &floating.body, amplitudes, &motion)
}

impl SeaRow {
    fn text(&self) -> String {
        let to = if self.direction > 0.0 { "+x" } else { "−x" };
        let [surge, heave, pitch] = self.rms;
        let part = match self.covered < 0.99 {
            true => format!(
                "; the file's frequencies cover only {:.0} % of the sea's energy",
                100.0 * self.covered
            ),
            false => String::new(),
        };
        format!(
            "Hs {} m, Tp {} s to {to}, root mean squares without lines: {} {surge:.3} m, {} {heave:.3} \
             m, {} {:.2}°{part}",
            self.hs_m,
            self.tp_s,
            FREEDOMS[0],
            FREEDOMS[1],
            FREEDOMS[2],
            pitch.to_degrees(),
        )
    }
}
