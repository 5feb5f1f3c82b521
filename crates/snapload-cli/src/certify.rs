//! `snapload certify`: a run as a theorem, proved and written down, and checked again.
use crate::bar::Bar;
use crate::case_input::{CaseArgs, read_up_to};
use crate::failure::{Failure, print};
use crate::json::{Json, JsonArgs};
use crate::pending_outputs::PendingOutputs;
use serde::Serialize;
use snapload::analysis::Progress;
use snapload::{Entries, Parameters};
use snapload_certificate::{
    Cancelled, Certification, Decimal, Ended, ExactCase, NUMBERS, Reason, Verdict, certify,
    check_with,
};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

const EXAMPLES: &str = "\
The decimals in which the case is written are taken as exact. The motion is enclosed from impact to impact in
numbers of many digits. This proves that each impact exists, that it is the next one and in which cable, and how
the run ends. Only proved results are written, and each number is rounded to nearest at its last digit. The proof
covers slack flight, impacts and stops. Where a cable stays taut, the proof ends; with --taut it continues through
sliding and rocking.

Examples:
  snapload certify
      the standard case: 290 impacts, proved
  snapload certify --case 1922001000-359 --out square.cert
      a built-in case, with its certificate in a file
  snapload certify --taut --case sliding-example --set t_end=10
      through sliding, an accumulation of snaps next to a taut cable, and rocking
  snapload certify --set v_stick=1e-9 --json - | jq .end
      the certificate as JSON, for another program
  snapload certify --check square.cert
      check a certificate, using only the case that it contains

Exit status: 0 proved to the end or, without --taut, to where a cable stays taut; 1 not proved that far (nothing
is written unless --partial is given); 2 bad input. With --check: 0 proved; 1 refused; 2 undecided or proved in
part; 3 no certificate.";

/// The size of the largest certificate: each of ten million impacts takes less than a hundred
/// bytes.
const LARGEST: u64 = 1 << 30;

/// Which case, and where the certificate goes; or which certificate to check.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    /// Write the certificate to a file
    #[arg(long, value_name = "FILE.cert")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgs,
    /// Continue the proof where a cable stays taut; each unit of time of such
    /// motion takes some tenths of a second
    #[arg(long, conflicts_with = "check")]
    taut: bool,
    /// Write the certificate also if the proof did not reach the end
    #[arg(long)]
    partial: bool,
    /// Check a certificate instead of proving a run
    #[arg(long, value_name = "FILE.cert", conflicts_with_all = ["out", "partial", "set", "case", "file"])]
    check: Option<PathBuf>,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.check {
        Some(path) => run_check(args, path),
        None => run_certify(args),
    }
}

fn run_certify(args: &Args) -> Result<(), Failure> {
    let input = args.case.read()?;
    let case = exact(input.case.parameters(), &input.entries)?;
    let mut pending = PendingOutputs::default();
    let out = Json::open(&mut pending, args.out.as_deref())?;
    let json = args.json.open(&mut pending)?;
    let begun = Instant::now();
    let bar = Bar::new();
    let t_end = input.case.parameters().t_end;
    let mut report = reporter(&bar, "proving");
    let proof = certify(&case, args.taut, &mut |t| report(t, t_end));
    drop(report);
    drop(bar);
    let proof =
        proof.map_err(|Cancelled| Failure::Interrupted("nothing was written".to_owned()))?;
    let proof = proof.map_err(Failure::BadInput)?;
    let words = in_words(&proof, begun.elapsed().as_secs_f64());
    let is_proved = matches!(proof.end, Ended::Proved(_));
    if !is_proved && !args.partial {
        return Err(Failure::Failed(words));
    }
    // Both files appear complete, and together.
    out.add_to(&mut pending, &proof)?;
    json.add_to(&mut pending, &proof)?;
    let files = pending.commit()?;
    if !(out.print(&proof)? | json.print(&proof)?) {
        let mut text = words + "\n";
        if proof.end == Ended::Proved(Reason::Sticks) {
            text += "The motion continues with a taut cable; --taut proves that part, too\n";
        }
        for path in &files {
            let _ = writeln!(text, "Written   {}", path.display());
        }
        print(&text)?;
    }
    if is_proved {
        Ok(())
    } else {
        Err(Failure::ExitStatus(1))
    }
}

/// The callback that shows how far a proof is. Where it begins again with more bits, the bar does.
fn reporter<'a>(
    bar: &'a Bar,
    doing: &'static str,
) -> impl FnMut(f64, f64) -> ControlFlow<()> + use<'a> {
    let (mut attempt, mut latest) = (1, 0.0);
    move |t, t_end| {
        // Two events at one instant may come in either order.
        if t < 0.99 * latest {
            attempt += 1;
        }
        latest = t;
        let words = match attempt {
            1 => doing.to_owned(),
            _ => format!("{doing} with more bits, attempt {attempt}"),
        };
        bar.show(Progress::new(&words, t, t_end))
    }
}

/// The case as decimals: keys whose values were typed keep their decimals.
pub(crate) fn exact(parameters: &Parameters, entries: &Entries) -> Result<ExactCase, Failure> {
    exact_but(parameters, entries, "")
}

/// The same if one key has another value than was typed.
pub(crate) fn exact_but(
    parameters: &Parameters,
    entries: &Entries,
    changed: &str,
) -> Result<ExactCase, Failure> {
    let written = |key: &str| entries.written(key).filter(|_| key != changed);
    for key in NUMBERS.into_iter().chain(["inertia"]) {
        if let Some(text) = written(key).filter(|text| Decimal::typed(text).is_none()) {
            return Err(Failure::BadInput(format!(
                "{key} = {text}: a proof needs a decimal of at most 399 characters and a power of \
                 ten within 400, such as 0.25 or 1e-6"
            )));
        }
    }
    let typed = |key: &str| written(key).and_then(Decimal::typed);
    ExactCase::of(parameters, typed).map_err(Failure::BadInput)
}

fn in_words(proof: &Certification, seconds: f64) -> String {
    let (impacts, bits) = (proof.impacts, proof.bits);
    let s = if impacts == 1 { "" } else { "s" };
    match &proof.end {
        Ended::Proved(Reason::Sticks) => format!(
            "proved up to t = {}, where a cable sticks: {impacts} impact{s} ({bits} bits, {seconds:.1} s)",
            proof.t
        ),
        Ended::Proved(reason) => {
            let reason = reason.name().replace('_', " ");
            format!(
                "proved: {impacts} impact{s}, {reason} at t = {} ({bits} bits, {seconds:.1} s)",
                proof.t
            )
        }
        Ended::Undecided { what, t } => format!(
            "proved up to t = {}, {impacts} impact{s}, then undecided: {what}, after t = {t}",
            proof.t
        ),
    }
}

/// A verdict in the form of its JSON.
#[derive(Serialize)]
struct Row<'a> {
    verdict: &'a str,
    impacts: Option<usize>,
    bits: Option<usize>,
    why: Option<&'a str>,
}

fn run_check(args: &Args, path: &Path) -> Result<(), Failure> {
    let mut pending = PendingOutputs::default();
    let json = args.json.open(&mut pending)?;
    let begun = Instant::now();
    let shown = path.display().to_string();
    let bar = Bar::new();
    let verdict = match read_up_to(path, LARGEST, "larger than 1 GiB") {
        Ok(text) => check_with(&text, &mut reporter(&bar, "checking")),
        Err(Failure::BadInput(why)) => {
            // The words below name the file, too.
            let why = why.strip_prefix(&format!("{shown}: ")).unwrap_or(&why);
            Verdict::Malformed(why.to_owned())
        }
        Err(other) => return Err(other),
    };
    drop(bar);
    let seconds = begun.elapsed().as_secs_f64();
    let (word, impacts, bits, why) = match &verdict {
        Verdict::Proved { impacts, bits, .. } => ("proved", Some(*impacts), Some(*bits), None),
        Verdict::ProvedInPart { impacts, bits } => {
            ("proved in part", Some(*impacts), Some(*bits), None)
        }
        Verdict::Refused(why) => ("refused", None, None, Some(why.as_str())),
        Verdict::Undecided(why) => ("undecided", None, None, Some(why.as_str())),
        Verdict::Malformed(why) => ("no certificate", None, None, Some(why.as_str())),
    };
    let row = Row {
        verdict: word,
        impacts,
        bits,
        why,
    };
    if json.write(pending, &row)?.is_some() {
        let mut words = match (impacts, bits) {
            (Some(impacts), Some(bits)) => {
                format!("{word}: {impacts} impacts ({bits} bits, {seconds:.1} s)")
            }
            _ => format!("{word}: {shown}: {}", why.unwrap_or_default()),
        };
        if let Verdict::Proved { reason, t, .. } = &verdict {
            let _ = write!(words, ", {} at t = {t}", reason.name().replace('_', " "));
        }
        print(&(words + "\n"))?;
    }
    match verdict.status() {
        0 => Ok(()),
        status => Err(Failure::ExitStatus(status)),
    }
}
