//! `snapload elastic`: one structure on lines that stretch, beside the same on lines that do not.
use crate::assess::{StructureArgs, told};
use crate::failure::{Failure, print};
use crate::json::{Json, room_of};
use crate::stage::Stage;
use serde_json::{Value, json};
use snapload::Impact;
use snapload_structure::{
    ElasticRun, Prepared, Pull, Snap, SnapLaw, Spring, damping_ratio, run_elastic, springs,
};
use std::fmt::Write as _;
use std::io;
use std::path::PathBuf;
use std::time::Instant;

const EXAMPLES: &str = "\
Examples:
  snapload elastic docs/examples/cylinder.toml --set run.duration=12
      each pull of each line with its peak tension, and the snaps of inextensible lines beside them
  snapload elastic cylinder.toml --set run.duration=12 --stiffer 100
      lines a hundred times as stiff: towards those that do not stretch
  snapload elastic cylinder.toml --set run.duration=12 --out motion.csv --every 0.01
      place, rotation and tensions every hundredth of a second
  snapload elastic cylinder.toml --set run.duration=12 --json - | jq .pulls
      everything as JSON, for the next program

Each line needs a stiffness: stiffness, spring_rate, or type and diameter. The model: docs/elastic.md.";

/// So many pulls and snaps are listed; JSON has them all.
const LISTED: usize = 12;

/// Which structure, how stiff, and where the answer goes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: StructureArgs,
    /// Lines so many times as stiff as they are
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, value_parser = times)]
    stiffer: f64,
    /// Write the motion as CSV: time, place, rotation and the tension of each line
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Time between two rows of the CSV, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = seconds)]
    every: f64,
    /// Write the answer as JSON to a file; - is standard output, which then gets nothing else
    #[arg(long, value_name = "FILE|-")]
    json: Option<PathBuf>,
}

fn times(text: &str) -> Result<f64, String> {
    within(text, 1e-6, 1e9)
}

fn seconds(text: &str) -> Result<f64, String> {
    within(text, 1e-6, 1e6)
}

fn within(text: &str, low: f64, high: f64) -> Result<f64, String> {
    let number = text.parse::<f64>().ok();
    number
        .filter(|number| (low..=high).contains(number))
        .ok_or_else(|| format!("allowed: a number from {low:e} to {high:e}"))
}

/// The same case in both ways.
struct Both {
    prepared: Prepared,
    stiffer: f64,
    springs: Vec<Spring>,
    elastic: ElasticRun,
    elastic_took_s: f64,
    snaps: Vec<Snap>,
    slack: Vec<f64>,
    inextensible_took_s: f64,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (name, structure) = args.input.read()?;
    let mut stage = Stage::default();
    let json = Json::open(&mut stage, args.json.as_deref())?;
    let out = match &args.out {
        None => None,
        Some(path) => Some((room_of(&mut stage, path)?, path)),
    };
    let prepared =
        Prepared::new(structure).map_err(|e| Failure::BadInput(format!("{name}: {e}")))?;
    let every = match out {
        Some(_) => args.every,
        None => f64::INFINITY,
    };
    let both = compute(prepared, args.stiffer, every)
        .map_err(|e| Failure::BadInput(format!("{name}: {e}")))?;
    if let Some((room, path)) = out {
        stage.write(room, path.clone(), |out| table(&both, out))?;
    }
    match json.write(stage, &report(&name, &both))? {
        Some(written) => print(&summary(&name, &both, &written)),
        None => Ok(()),
    }
}

fn compute(prepared: Prepared, stiffer: f64, every_s: f64) -> Result<Both, snapload::CaseError> {
    let springs = springs(&prepared, stiffer)?;
    let clock = Instant::now();
    let elastic = run_elastic(&prepared, &springs, every_s, || false)?;
    let elastic_took_s = clock.elapsed().as_secs_f64();
    let clock = Instant::now();
    let (snaps, slack) = inextensible(&prepared);
    Ok(Both {
        prepared,
        stiffer,
        springs,
        elastic,
        elastic_took_s,
        snaps,
        slack,
        inextensible_took_s: clock.elapsed().as_secs_f64(),
    })
}

/// The snaps of lines that do not stretch, and the part of the time in which each is slack.
fn inextensible(prepared: &Prepared) -> (Vec<Snap>, Vec<f64>) {
    let law = SnapLaw::new(&prepared.structure, &prepared.rest, &prepared.model);
    let mut snaps = Vec::new();
    let mut slack = vec![0.0; prepared.structure.lines.len()];
    // A start that can not be was refused when the structure was prepared.
    let Ok(mut simulation) = prepared.begin(1.0) else {
        return (snaps, slack);
    };
    while let Some(step) = simulation.step() {
        for (line, slack) in slack.iter_mut().enumerate() {
            if !step.taut.contains(line) {
                *slack += step.t_end - step.t_start;
            }
        }
        let impacts: Vec<Impact> = step.impacts().collect();
        let held = simulation.tensions_at_end(&step);
        let held = |line: usize| step.taut.contains(line).then(|| held[line]);
        let found = law.snaps(simulation.system(), &impacts, held);
        snaps.extend(
            found
                .into_iter()
                .filter(|snap| snap.counts() && !snap.is_jolt),
        );
    }
    let end = simulation.time().max(f64::MIN_POSITIVE);
    (snaps, slack.into_iter().map(|time| time / end).collect())
}

/// A row a look.
fn table(both: &Both, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let lines = both.springs.len();
    let tensions = (1..=lines).map(|line| format!("tension_{line}_n"));
    let names = ["t_s", "x_m", "z_m", "theta_rad"].map(str::to_owned);
    table.write_record(names.into_iter().chain(tensions))?;
    for look in &both.elastic.looks {
        let state = &look.state;
        let [x, z] = both.prepared.model.scales.to_si([state.x, state.y]);
        let place = [look.t_s, x, z, 0.0 - state.theta];
        let row = place.iter().chain(&look.tension_n);
        table.write_record(row.map(f64::to_string))?;
    }
    table.flush()
}

fn report(name: &str, both: &Both) -> Value {
    let Both {
        prepared, elastic, ..
    } = both;
    let structure = &prepared.structure;
    let scales = &prepared.model.scales;
    let unit = scales.force_n / scales.length_m;
    let peaks = elastic.peaks_n(structure);
    let lines = both.springs.iter().enumerate().map(|(index, spring)| {
        json!({
            "line": index + 1,
            "spring_rate_n_m": spring.rate * unit,
            "damping_n_s_m": spring.damping * unit * scales.time_s,
            "slack_fraction": elastic.slack_fraction(index),
            "peak_n": peaks[index],
            "breaking_load_n": structure.lines[index].breaking_load_n,
        })
    });
    let pulls = elastic.pulls.iter().map(|pull| {
        json!({
            "line": pull.line + 1, "from_s": pull.from_s, "to_s": pull.to_s, "speed_m_s": pull.speed_m_s,
            "peak_n": pull.peak_n, "peak_s": pull.peak_s, "rebound_m_s": pull.rebound_m_s,
        })
    });
    let snaps = both.snaps.iter().map(|snap| {
        json!({
            "line": snap.line + 1, "t_s": snap.t_s, "speed_m_s": snap.speed_m_s, "energy_peak_n": snap.energy_peak_n,
        })
    });
    json!({
        "case": name,
        "stiffer": both.stiffer,
        "restitution": structure.restitution,
        "damping_ratio": damping_ratio(structure.restitution),
        "end_s": elastic.end_s,
        "took_s": both.elastic_took_s,
        "lines": lines.collect::<Vec<_>>(),
        "pulls": pulls.collect::<Vec<_>>(),
        "inextensible": {
            "snaps": snaps.collect::<Vec<_>>(),
            "slack_fraction": both.slack,
            "took_s": both.inextensible_took_s,
        },
    })
}

fn summary(name: &str, both: &Both, written: &[PathBuf]) -> String {
    let Both {
        prepared, elastic, ..
    } = both;
    let structure = &prepared.structure;
    let scales = &prepared.model.scales;
    let unit = scales.force_n / scales.length_m / 1e3;
    let peaks = elastic.peaks_n(structure);
    let mut text = String::new();
    for (index, spring) in both.springs.iter().enumerate() {
        let mut words = format!(
            "k = {:.0} kN/m, c = {:.1} kN s/m; slack {:.1} % of the time ({:.1} % if it did not stretch); at most {:.0} kN",
            spring.rate * unit,
            spring.damping * unit * scales.time_s,
            100.0 * elastic.slack_fraction(index),
            100.0 * both.slack[index],
            peaks[index] / 1e3
        );
        if let Some(load) = structure.lines[index].breaking_load_n {
            let _ = write!(
                words,
                ", {:.2} of the {:.0} kN it breaks at",
                peaks[index] / load,
                load / 1e3
            );
        }
        text += &told(&format!("line {}", index + 1), &words);
    }
    text += "\n  pulls of the lines that stretch          snaps of lines that do not\n";
    text += "  line    from      to     m/s      kN  back   line       s     m/s  kN (energy)\n";
    let rows = elastic.pulls.len().max(both.snaps.len());
    for row in 0..rows.min(LISTED) {
        let left = elastic.pulls.get(row).map_or(String::new(), pull_words);
        let right = both.snaps.get(row).map_or(String::new(), snap_words);
        let _ = writeln!(text, "{left:<43}{right}");
    }
    if rows > LISTED {
        let _ = writeln!(
            text,
            "  ... {} pulls and {} snaps of {} m/s or more in all; --json has every one",
            elastic.pulls.len(),
            both.snaps.len(),
            snapload_structure::SLOWEST_M_S
        );
    }
    for path in written {
        text += &told("written", &path.display().to_string());
    }
    let stiffer = match both.stiffer {
        1.0 => "as stiff as they are".to_owned(),
        times => format!("{times} times as stiff as they are"),
    };
    let e = structure.restitution;
    format!(
        "{name}: {} lines {stiffer}, dampers for e = {e} (zeta = {:.3}), {} s computed in {:.3} s\n{text}",
        structure.lines.len(),
        damping_ratio(e),
        (elastic.end_s * 1e3).round() / 1e3,
        both.elastic_took_s
    )
}

fn pull_words(pull: &Pull) -> String {
    let rebound = match pull.rebound_m_s {
        Some(speed) => format!("{speed:.2}"),
        None => "-".to_owned(),
    };
    format!(
        "  {:>4}{:>8.3}{:>8.3}{:>8.3}{:>8.0}{rebound:>6}",
        pull.line + 1,
        pull.from_s,
        pull.to_s,
        pull.speed_m_s,
        pull.peak_n / 1e3
    )
}

fn snap_words(snap: &Snap) -> String {
    let peak = snap
        .energy_peak_n
        .map_or("-".to_owned(), |peak| format!("{:.0}", peak / 1e3));
    format!(
        "{:>6}{:>8.3}{:>8.3}{peak:>8}",
        snap.line + 1,
        snap.t_s,
        snap.speed_m_s
    )
}
