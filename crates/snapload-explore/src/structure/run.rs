//! `/api/structure/run`: a structure as by `snapload assess`, with everything that the page draws.
use super::Latest;
use super::motion::Columns;
use super::opened::{Case, CaseRequest, Opened};
use super::snaps::Snaps;
use crate::refusal::Refusal;
use crate::work::Allowance;
use serde::{Deserialize, Serialize};
use serde_json::{Value as JsonValue, json};
use snapload::analysis::{Progress, Unfinished};
use snapload_structure::{Assessment, DEFAULT_NEIGHBOURS, Outline, Structure, Water, note};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The time budget of a run while the page waits for a picture.
const BUDGET: Duration = Duration::from_secs(2);
/// The time budget of a whole record, and of its neighbours.
const LONG_BUDGET: Duration = Duration::from_secs(60);
/// The beginning of a longer record that is shown first \[s\].
const PREVIEW_S: f64 = 300.0;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    case: CaseRequest,
    /// Whether to run all of a long record, and not its beginning alone.
    #[serde(default)]
    whole: bool,
    /// Whether to run neighbours, too, and other restitutions.
    #[serde(default)]
    neighbours: bool,
    /// The time interval that is shown \[s\]; by default that about the hardest snap.
    #[serde(default)]
    window: Option<[f64; 2]>,
    /// Whether to report the progress, line by line.
    #[serde(default)]
    pub(crate) progress: bool,
}

/// The answer, as JSON.
pub(crate) fn answer(
    request: &Request,
    start: Option<&Opened>,
    latest: &Latest,
    allowance: &Allowance,
) -> Result<Vec<u8>, Refusal> {
    let began = Instant::now();
    if let Some([from, to]) = request
        .window
        .filter(|[from, to]| !(0.0 <= *from && from < to))
    {
        let message = format!(
            "window = [{from}, {to}] is not allowed; allowed: two times, 0 <= from < to, or null"
        );
        return Err(Refusal::values(message));
    }
    let case = request.case.read(start)?;
    let mut wanted_run = RunRequest::alone(&case, request.whole);
    if request.neighbours {
        wanted_run.neighbours = true;
        wanted_run.time = LONG_BUDGET;
    }
    let assessment = assessed(&request.case, &case, wanted_run, latest, allowance)?;
    let answer = Answer::new(&case, &assessment, request.window, began);
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}

/// The requested run of a case.
#[derive(Clone, Copy)]
pub(super) struct RunRequest {
    /// The beginning of a long record only.
    pub(super) preview: bool,
    /// Also its neighbours, other restitutions and slightly other waves.
    pub(super) neighbours: bool,
    /// Its time budget.
    pub(super) time: Duration,
}

impl RunRequest {
    /// A run without neighbours, of all of a long record or of its beginning alone.
    pub(super) fn alone(case: &Case, whole: bool) -> Self {
        let long =
            case.structure.duration_s > PREVIEW_S && matches!(case.structure.water, Water::Sea(_));
        Self {
            preview: long && !whole,
            neighbours: false,
            time: if whole { LONG_BUDGET } else { BUDGET },
        }
    }
}

/// The requested run, which is not repeated if it was requested before. Where the whole of a record
/// is known, it is the answer in place of its beginning.
pub(super) fn assessed(
    case_request: &CaseRequest,
    case: &Case,
    wanted_run: RunRequest,
    latest: &Latest,
    allowance: &Allowance,
) -> Result<Arc<Assessment>, Refusal> {
    let kept = &latest.assessment;
    let allowance = allowance.within(wanted_run.time);
    let on_progress = |progress: Progress| allowance.check(progress);
    let refuse = |unfinished| too_long(case, "assess", wanted_run.time, unfinished);
    let alone = |preview: bool| format!("{} {preview}", case_request.fingerprint());
    let beside = |preview: bool| format!("{} beside its neighbours", alone(preview));
    let whole = || kept.get(&beside(false)).or_else(|| kept.get(&alone(false)));
    let fingerprint = alone(wanted_run.preview);
    let with_neighbours = beside(wanted_run.preview);
    if let Some(found) = kept.get(&with_neighbours) {
        return Ok(found);
    }
    if let Some(found) = whole().filter(|_| wanted_run.preview && !wanted_run.neighbours) {
        return Ok(found);
    }
    let structure = match wanted_run.preview {
        true => beginning(&case.structure),
        false => case.structure.clone(),
    };
    let single = kept
        .of(&fingerprint, || {
            Assessment::single_run(structure, &on_progress)
        })
        .map_err(refuse)?;
    if !wanted_run.neighbours {
        return Ok(single);
    }
    let single = Arc::unwrap_or_clone(single);
    kept.of(&with_neighbours, || {
        single.with_neighbours(DEFAULT_NEIGHBOURS, &on_progress)
    })
    .map_err(refuse)
}

/// The first minutes of a record.
fn beginning(structure: &Structure) -> Structure {
    Structure {
        duration_s: PREVIEW_S,
        transient_s: structure.transient_s.min(PREVIEW_S / 2.0),
        ..structure.clone()
    }
}

/// The refusal of work that failed or did not end within its time; `verb` names
/// the command that has no limit.
pub(super) fn too_long(case: &Case, verb: &str, time: Duration, unfinished: Unfinished) -> Refusal {
    match unfinished {
        Unfinished::Case(error) => error.into(),
        Unfinished::Cancelled(_) => Refusal::values(format!(
            "this takes more than {} s, the limit of the page\nhint: lower run.duration, or use the command line: {}",
            time.as_secs(),
            case.command(verb)
        )),
    }
}

#[derive(Serialize)]
struct Answer {
    /// As by `snapload assess --json`, without its lists of snaps and neighbours.
    assessment: JsonValue,
    /// The summary that it prints.
    summary: String,
    /// Its verdict in a word.
    standing: &'static str,
    /// The numbers behind it with other restitutions, if those are run.
    rebound: Option<String>,
    /// The same in slightly other regular waves.
    nearby_waves: Option<String>,
    /// Whether this is the beginning of a longer record, and the length of that \[s\].
    preview: bool,
    lasts_s: f64,
    transient_s: f64,
    geometry: JsonValue,
    /// The waves as sinusoids: amplitude \[m\], ω \[rad/s\], wave number \[1/m\] along +x, phase
    /// \[rad\].
    waves: Vec<[f64; 4]>,
    snaps: Snaps,
    modes: Modes,
    window: [f64; 2],
    motion: Columns,
    shell: String,
    python: String,
    took_ms: f64,
}

/// The taut lines and the times from which on they are taut \[s\], within the interval that is
/// shown; counted from 1.
#[derive(Serialize)]
struct Modes {
    t_start: Vec<f64>,
    taut: Vec<Vec<usize>>,
}

impl Answer {
    fn new(case: &Case, assessment: &Assessment, window: Option<[f64; 2]>, began: Instant) -> Self {
        let (prepared, name) = (&assessment.prepared, &case.opened.name);
        let end = assessment.outcome.end_s;
        let window = window.filter(|[from, _]| *from < end);
        let window = window.unwrap_or_else(|| note::window(assessment));
        // Rounded to the millisecond, as in links, and not to an instant.
        let [from, to] = [window[0], window[1].min(end)].map(|t| (t * 1e3).round() / 1e3);
        let window = [from, to.max(from + 1e-3)];
        let mut json = assessment.to_json(name);
        if let Some(json) = json.as_object_mut() {
            json.remove("snaps");
            json.remove("neighbour_peaks_n");
        }
        let heading = case.structure.heading;
        let wave = |wave: &snapload_structure::LinearWave| {
            let k = heading * wave.wave_number_1_m;
            [wave.amplitude_m, wave.omega_rad_s, k, wave.phase_rad]
        };
        Self {
            assessment: json,
            summary: assessment.summary(name),
            standing: assessment.verdict().standing.words(),
            rebound: (!assessment.restitutions.is_empty()).then(|| assessment.rebound_text()),
            nearby_waves: assessment.waves_text(),
            preview: prepared.structure.duration_s < case.structure.duration_s,
            lasts_s: case.structure.duration_s,
            transient_s: prepared.structure.transient_s,
            geometry: geometry(assessment),
            waves: prepared.model.waves.iter().map(wave).collect(),
            snaps: Snaps::of(assessment, window),
            modes: Modes::of(assessment, window),
            motion: Columns::of(&assessment.run, &prepared.model.scales, window),
            window,
            shell: case.command("assess"),
            python: case.python(),
            took_ms: 1e3 * began.elapsed().as_secs_f64(),
        }
    }
}

/// The geometry to draw, in metres.
fn geometry(assessment: &Assessment) -> JsonValue {
    let structure = &assessment.prepared.structure;
    let body = &structure.body;
    let lines = structure.lines.iter().map(|line| {
        let arm = [0, 1].map(|i| line.fairlead_m[i] - body.position_m[i]);
        json!({ "anchor": line.anchor_m, "arm": arm, "length": line.length_m })
    });
    json!({
        "outline": match body.outline {
            Outline::Circle => "circle",
            Outline::Rectangle => "rectangle",
        },
        "width": body.width_m,
        "height": body.height_m,
        "floats": structure.afloat.is_some(),
        "depth": structure.site.depth_m,
        "rest": assessment.prepared.rest.place_m,
        "position": body.position_m,
        "lines": lines.collect::<Vec<_>>(),
    })
}

impl Modes {
    fn of(assessment: &Assessment, [from, to]: [f64; 2]) -> Self {
        let unit = assessment.prepared.model.scales.time_s;
        let modes = assessment.run.modes().iter();
        let within = modes.filter(|mode| mode.t_end * unit >= from && mode.t_start * unit <= to);
        let (t_start, taut) = within
            .map(|mode| {
                let lines = mode.taut.iter().map(|line| line + 1);
                (mode.t_start * unit, lines.collect())
            })
            .unzip();
        Self { t_start, taut }
    }
}
