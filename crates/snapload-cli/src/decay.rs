//! `snapload decay`: a floating body let go in still water.
use crate::bar::Bar;
use crate::failure::Failure;
use crate::hydro_input::{HydroArgs, triple};
use crate::json::JsonArgs;
use crate::outputs::Outputs;
use serde::Serialize;
use snapload::Sampling;
use snapload::analysis::Progress;
use snapload_hydro::digits::{digits, in_full, tenths};
use snapload_hydro::{
    Body, Decay, FREEDOMS, Fit, HydroError, Swing, Warning, decay, far_from_the_file, large_motion,
    rest_without_tension, swings,
};
use snapload_structure::labelled_row;
use snapload_study::in_digits_with_fraction;
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;
use std::path::PathBuf;

const EXAMPLES: &str = include_str!("../help/decay.txt").trim_ascii_end();
/// A displacement below this from the position of the file is none \[m, rad\].
const SMALL: f64 = 1e-3;
/// The furthest release \[m\].
const FURTHEST: f64 = 1000.0;
/// The number of swings that are printed.
const MOST_SWINGS: usize = 8;

/// Which file, from where, for how long.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: HydroArgs,
    /// Initial displacement: surge and heave in m, pitch in rad
    #[arg(long, value_name = "Q1,Q3,Q5", value_parser = triple, allow_hyphen_values = true, default_value = "0,1,0")]
    from: [f64; 3],
    /// Duration of the simulated motion in s
    #[arg(long, value_name = "NUMBER", default_value_t = 40.0)]
    duration: f64,
    /// Time between rows of the table in s
    #[arg(long, value_name = "NUMBER", default_value_t = 0.05)]
    step: f64,
    /// Write the motion as a table (CSV)
    #[arg(long, value_name = "DECAY.csv")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgs,
}

#[derive(Serialize)]
struct Answer<'a> {
    file: String,
    from: [f64; 3],
    t_s: &'a [f64],
    surge_m: Vec<f64>,
    heave_m: Vec<f64>,
    pitch_rad: Vec<f64>,
    swings: Vec<SwingRow>,
    warnings: Vec<&'a Warning>,
}

#[derive(Serialize)]
struct SwingRow {
    freedom: &'static str,
    from_s: f64,
    amplitude: f64,
    period_s: f64,
    damping_ratio: f64,
}

/// Does it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut outputs = Outputs::open(&args.json)?;
    let out = outputs.file("--out", args.out.as_deref(), &["csv"])?;
    let name = args.input.name();
    let bad = |error| Failure::bad_input(error).with_prefix(&name);
    let report = args.input.report(Vec::new(), None)?;
    let floating = report
        .floating
        .as_ref()
        .map_err(|error| bad(error.clone()))?;
    let from = args.from;
    check_release(from)?;
    let body = floating.body.afloat();
    let motion = released(args, &body, &report.fit).map_err(bad)?;
    if let Some(out) = out {
        outputs.write(out, |out| out.write_all(table(&motion).as_bytes()))?;
    }
    let mut text = format!("{name}\n");
    let mut rows = Vec::new();
    for (freedom, called) in FREEDOMS.iter().enumerate().filter(|(i, _)| from[*i] != 0.0) {
        let swings = swings(&motion, freedom);
        text += &swing_table(called, &swings, freedom, (&motion, args.duration));
        rows.extend(swings.into_iter().map(|swing| SwingRow {
            freedom: called,
            from_s: swing.from_s,
            amplitude: swing.amplitude,
            period_s: swing.period_s,
            damping_ratio: swing.damping_ratio,
        }));
    }
    let hydro = &report.reading.hydro;
    let afloat = rest_without_tension(hydro, &body, &[], 0.0);
    let afloat: Option<[f64; 3]> = afloat.map(|(q, _)| q.into());
    if let Some(note) = measured_from(afloat) {
        text += &labelled_row("measured", &note);
    }
    if rows.iter().any(|row| row.damping_ratio < 0.0) {
        text += &labelled_row("mixed", NEGATIVE_DAMPING_NOTE);
    }
    let [_, heave, pitch] = from;
    let far = afloat.and_then(|q| far_from_the_file(hydro, &body, q, "floats without lines"));
    let large = large_motion(hydro, &body, [heave, pitch], "the release");
    let warnings: Vec<&Warning> = report.warnings.iter().chain(&far).chain(&large).collect();
    for warning in &warnings {
        text += &labelled_row("warning", &format!("{}: {}", warning.what, warning.message));
    }
    let of = |i: usize| motion.q.iter().map(|q| q[i]).collect();
    let answer = Answer {
        file: name.clone(),
        from: args.from,
        t_s: &motion.t_s,
        surge_m: of(0),
        heave_m: of(1),
        pitch_rad: of(2),
        swings: rows,
        warnings,
    };
    outputs.finish_with_text(&answer, text)
}

/// The motion, with a bar while it is computed.
fn released(args: &Args, body: &Body, fit: &Fit) -> Result<Decay, HydroError> {
    let times = [args.duration, args.step];
    let bar = Bar::new();
    let on_progress = |part: f64| {
        let _ = bar.show(Progress::new("decaying", part, 1.0));
    };
    let (memory, inf) = (&fit.memory, &fit.added_mass_inf);
    let mut motion = decay(body, memory, inf, args.from, times, &on_progress)?;
    // The rows are at the decimals that one writes: at 0.3, not at three times the double 0.1.
    if let Ok(sampling) = Sampling::every(args.step, args.duration) {
        for (row, t_s) in motion.t_s.iter_mut().zip(sampling.times()) {
            *row = t_s;
        }
    }
    Ok(motion)
}

/// A body that is released where it rests does not swing, and one that is
/// turned over does not swing back.
fn check_release(from: [f64; 3]) -> Result<(), Failure> {
    let [surge, heave, pitch] = from;
    let near = [surge, heave].iter().all(|way| way.abs() <= FURTHEST);
    if from != [0.0; 3] && near && pitch.abs() < FRAC_PI_2 {
        return Ok(());
    }
    Err(Failure::bad_input(format!(
        "--from = {} is not allowed; allowed: three finite numbers, not all of them 0, such as 0,1,0, with at \
         most {FURTHEST} m of surge and heave and less than π/2 rad of pitch",
        from.map(|q| in_full(&q)).join(",")
    )))
}

/// The note if a swing is larger than the one before.
const NEGATIVE_DAMPING_NOTE: &str = "a damping below zero, of one of these swings or of a later one (--json), occurs in a freedom in \
                                     which motions of several periods are added; snapload hydro gives the damping of each motion";

/// From where displacements are measured, if not from the position of the file: the motion is
/// linear about the position in which the body floats without lines.
fn measured_from(afloat: Option<[f64; 3]>) -> Option<String> {
    match afloat {
        Some(q) if q[1].abs() < SMALL && q[2].abs() < SMALL => None,
        Some(q) => Some(format!(
            "from where the body floats without lines: {} m of heave and {:.2}° of pitch from the position of the \
             file",
            digits(&q[1], 3),
            q[2].to_degrees()
        )),
        None => {
            Some("from the position of the file; forces not balanced there are left out".to_owned())
        }
    }
}

/// The swings of a freedom as a small table below its name.
fn swing_table(
    called: &str,
    swings: &[Swing],
    freedom: usize,
    (motion, duration_s): (&Decay, f64),
) -> String {
    if swings.is_empty() {
        let end = tenths(&duration_s);
        let none = format!(
            "no whole swing within {end} s; those below a thousandth of the first are left out"
        );
        return labelled_row(called, &none);
    }
    let unit = ["m", "m", "rad"][freedom];
    // A swing begins at every turning point; those of one side are printed.
    let side = || swings.iter().step_by(2);
    let few = match side().count() > MOST_SWINGS {
        true => format!("the first {MOST_SWINGS} "),
        false => String::new(),
    };
    let about = match motion.comes_back[freedom] {
        true => "",
        false => " about its final position (no stiffness brings it back to 0)",
    };
    let what =
        format!("{few}swings{about}, each from one turn to the next on the side of the release");
    let mut text = labelled_row(called, &what);
    let amplitude = format!("amplitude {unit}");
    let _ = writeln!(
        text,
        "            {:>8}{amplitude:>15}{:>10}{:>26}",
        "from s", "period s", "damping, % of critical"
    );
    for swing in side().take(MOST_SWINGS) {
        let _ = writeln!(
            text,
            "            {:>8.2}{:>15}{:>10.3}{:>26.2}",
            swing.from_s,
            digits(&swing.amplitude, 4),
            swing.period_s,
            100.0 * swing.damping_ratio
        );
    }
    text
}

fn table(motion: &Decay) -> String {
    let mut text = "t_s,surge_m,heave_m,pitch_rad\n".to_owned();
    for (t, q) in motion.t_s.iter().zip(&motion.q) {
        let row = [*t, q[0], q[1], q[2]].map(in_digits_with_fraction);
        let _ = writeln!(text, "{}", row.join(","));
    }
    text
}
